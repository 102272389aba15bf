"""The report: tables in Markdown, and every batch as CSV."""

import csv
import statistics

from . import limits
from .rows import SWEEP_TARGET, THREADS_TARGET


def table(head, rows):
    """A Markdown table, its first column text and the others figures."""
    marks = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (head, marks, *rows))


def verdict(ratio, target, at_least=False):
    if target is None:
        return ""
    met = ratio >= target if at_least else ratio <= target
    return f"{'≥' if at_least else '≤'} {target:g} {'met' if met else '**missed**'}"


def reference_of(comparison, results):
    """The fastest of those that the others are compared with."""
    candidates = [result for result in results if result.label.startswith(comparison.reference)]
    return min(candidates, key=lambda result: result.median, default=None)


def of_comparison(comparison, results):
    """Times and ratios to the reference, with what was aimed at."""
    reference = reference_of(comparison, results)
    head = ["", f"median, {comparison.unit}", "quartiles", "ratio of medians", "median of ratios", "aim"]
    rows = []
    for result in results:
        low, middle, high = (comparison.units * value for value in result.quartiles())
        cells = [result.label, f"{middle:.3f}", f"{low:.3f} – {high:.3f}"]
        if reference is None:
            cells += ["", "", ""]
        else:
            ratio = result.ratio_of_medians(reference)
            aim = verdict(ratio, comparison.targets.get(result.label))
            cells += [f"{ratio:.2f}", f"{result.median_of_ratios(reference):.2f}", aim]
        rows.append(cells)
    text = table(head, rows)
    if reference is not None:
        text += f"\n\nRatios are to {reference.label}, the fastest of its kind ({reference.description})."
    return text


def by_label(results):
    return {result.label: result for result in results}


def costs(kind, counts, results):
    """Cost of a disc and step, ns, of one kind of engine for every number of discs; none where it is missing."""
    found = by_label(results)
    labels = {count: f"{kind} {count}" for count in counts}
    return [found[label].median / count * 1e9 if label in found else None for count, label in labels.items()]


def of_sweep(counts, results):
    """Cost of a disc and step against the number of discs."""
    rows = []
    for kind, target in (("meniscus", SWEEP_TARGET), ("LAMMPS", None)):
        values = costs(kind, counts, results)
        known = [value for value in values if value is not None]
        if known:
            spread = max(known) / min(known)
            cells = ["–" if value is None else f"{value:.1f}" for value in values]
            rows.append([kind, *cells, f"{spread:.2f}", verdict(spread, target)])
    head = ["ns per disc and step", *(f"{count:,}" for count in counts), "largest / smallest", "aim"]
    schemes = [f"- {result.label}: {result.description}" for result in results if result.label.startswith("meniscus")]
    return table(head, rows) + "\n\n" + "\n".join(schemes)


def of_threads(results):
    """Time on the wall with one thread over that with two."""
    if len(results) < 2:
        return "Not available."
    one, two = results
    gain = statistics.median(one.wall) / statistics.median(two.wall)
    rows = [[result.label, f"{statistics.median(result.wall) * 1e3:.1f}"] for result in results]
    text = table(["", "time on the wall, ms per step"], rows)
    return f"{text}\n\nGain {gain:.2f} ({verdict(gain, THREADS_TARGET, at_least=True)})."


def rates(results):
    """Operations or bytes per second by contender."""
    return {result.label: float(result.description) / result.median for result in results}


def of_rates(results):
    """The limits themselves."""
    rows = []
    for name, rate in rates(results).items():
        what, *level = name.split()
        kind = {"adds": "sums", "mixed": "sums and products, as many of each"}.get(what, f"bytes from and to {what}")
        rows.append([" ".join([kind, *level]), f"{rate / 1e9:.1f}"])
    return table(["binary32, one thread", "10⁹ per second"], rows)


def of_limits(limits_found, meshes):
    """How far from the limits the mesh solves of this engine are."""
    found = rates(limits_found)
    rows = []
    for comparison, results in meshes:
        grid = int(comparison.name.removeprefix("mesh-"))
        sums, products = limits.arithmetic(grid)
        moved, worked_on = limits.traffic(grid)
        kind = limits.memory_kind(worked_on)
        by_memory = moved / found[kind]
        for solver, level in limits.LEVEL_OF_SOLVER.items():
            result = by_label(results).get(f"meniscus {solver}")
            if result is None:
                continue
            by_sums = sums / found[f"adds {level}"]
            rows.append(
                [
                    f"{grid}, {solver}",
                    f"{sums / 1e6:.1f}",
                    f"{products / 1e6:.1f}",
                    f"{by_sums * 1e3:.3f}",
                    f"{moved / 1e6:.1f}",
                    f"{by_memory * 1e3:.3f} ({kind})",
                    f"{result.median * 1e3:.3f}",
                    f"{result.median / max(by_sums, by_memory):.2f}",
                ]
            )
    head = ["mesh solve", "sums, 10⁶", "products, 10⁶", "sums alone, ms", "moved, MB", "moving alone, ms", "measured, ms"]
    return table([*head, "measured / the longer of both"], rows)


def write_batches(path, measured):
    """Every batch of every contender."""
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["comparison", "contender", "description", "round", "repetitions", "cpu_s", "wall_s"])
        for comparison, results in measured:
            for result in results:
                for turn, (cpu, wall) in enumerate(zip(result.cpu, result.wall)):
                    batch = [turn, result.repetitions, f"{cpu:.6e}", f"{wall:.6e}"]
                    rows.writerow([comparison.name, result.label, result.description, *batch])
