"""The report as one picture."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from .report import by_label, costs, reference_of  # noqa: E402

GREY = "0.55"
OTHERS = {"RustFFT": "tab:orange", "meniscus core": "tab:gray"}
ENGINES = {
    "meniscus avx512": "tab:red",
    "meniscus avx2": "tab:purple",
    "meniscus sse2": "tab:blue",
    "meniscus portable": "tab:cyan",
}


def draw_meshes(axes, meshes):
    """Time over that of the fastest FFTW against the size of the mesh."""
    for label, colour in {**ENGINES, **OTHERS}.items():
        points = [
            (comparison.name.removeprefix("mesh-"), by_label(results)[label].ratio_of_medians(fastest))
            for comparison, results in meshes
            if label in by_label(results) and (fastest := reference_of(comparison, results))
        ]
        if points:
            axes.plot(*zip(*points), marker="o", color=colour, label=label)
    axes.axhline(1.0, color=GREY, linestyle="--", linewidth=1)
    axes.text(0.02, 1.03, "FFTW", color=GREY, transform=axes.get_yaxis_transform())
    axes.set(title="Mesh solve", xlabel="nodes a side", ylabel="CPU time / FFTW's", yscale="log")
    ticks = [0.25, 0.5, 1, 2, 4, 8]
    axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.legend(frameon=False, fontsize=8)


def draw_steps(axes, steps):
    """CPU time of a step by contender, a bar for each state."""
    height = 0.8 / len(steps)
    for place, (comparison, results) in enumerate(steps):
        where = [row + place * height for row in range(len(results))]
        times = [result.median * 1e3 for result in results]
        axes.barh(where, times, height, label=comparison.name.removeprefix("step-"), color=("tab:red", "0.7")[place])
        for row, value in zip(where, times):
            axes.text(value, row, f" {value:.2f}", va="center", fontsize=8)
    labels = [result.label for result in steps[0][1]]
    axes.set_yticks([row + 0.5 * height for row in range(len(labels))], labels, fontsize=8)
    axes.invert_yaxis()
    axes.margins(x=0.15)
    axes.set(title="Step of Table I", xlabel="CPU time, ms")
    axes.legend(frameon=False, fontsize=8)


def draw_sweep(axes, sweep, counts):
    """Cost of a disc against the number of discs."""
    _, results = sweep
    for kind, label, colour in (
        ("meniscus", "meniscus", "tab:red"),
        ("LAMMPS", "LAMMPS, repulsion alone", "tab:gray"),
    ):
        points = [point for point in zip(counts, costs(kind, counts, results)) if point[1] is not None]
        if points:
            axes.plot(*zip(*points), marker="o", color=colour, label=label)
    axes.set(title="Cost of a disc", xlabel="discs", ylabel="CPU time per disc and step, ns", xscale="log")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, fontsize=8)


def draw(path, meshes, steps, sweep, counts):
    """A panel for each of meshes, steps and sweep that was measured."""
    panels = []
    if meshes:
        panels.append(lambda axes: draw_meshes(axes, meshes))
    if steps:
        panels.append(lambda axes: draw_steps(axes, steps))
    if sweep:
        panels.append(lambda axes: draw_sweep(axes, sweep[0], counts))
    if not panels:
        return
    figure, axes = plt.subplots(1, len(panels), figsize=(5 * len(panels), 4.5), layout="constrained", squeeze=False)
    for panel, each in zip(panels, axes[0]):
        panel(each)
        each.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=120)
