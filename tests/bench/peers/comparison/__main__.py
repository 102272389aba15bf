"""`python -m comparison --built DIR --out DIR [--quick]`; `run` calls it."""

import argparse
import pathlib
import sys

from . import agreement, machine, plot, report
from .contender import Failed
from .interleaved import measure
from .rows import Rows

HERE = pathlib.Path(__file__).resolve().parent.parent


def arguments():
    parser = argparse.ArgumentParser(prog="comparison")
    parser.add_argument("--built", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="")
    return parser.parse_args()


class Run:
    """What was measured, and the report in the making. `only` begins the names of what is wanted."""

    def __init__(self, only):
        self.only = only
        self.measured, self.text = [], []

    def wanted(self, comparisons):
        return [comparison for comparison in comparisons if comparison.name.startswith(self.only)]

    def measure(self, comparisons, write=report.of_comparison):
        """Measures those wanted and writes a section of each; a contender that is missing is named."""
        found = []
        for comparison in self.wanted(comparisons):
            print(f"{comparison.title} ...", file=sys.stderr)
            results, missing = measure(comparison)
            found.append((comparison, results))
            paragraphs = (f"Not available: {reason}." for reason in missing)
            self.section(comparison.title, write(comparison, results), *paragraphs)
        self.measured += found
        return found

    def section(self, title, *paragraphs):
        self.text.append("\n\n".join((f"## {title}", *paragraphs)))
        print("\n\n".join(paragraphs), end="\n\n")


def compare(rows, run):
    """Every comparison that is wanted; gives those that the picture shows."""
    limits = run.measure([rows.limits()], lambda _, results: report.of_rates(results))
    meshes = run.measure(rows.meshes())
    if limits and meshes:
        run.section("The mesh solve and the limits", report.of_limits(limits[0][1], meshes))

    steps = rows.whole_steps()
    if run.wanted(steps):
        found = ", ".join(f"{state} {agreement.of_forces(rows, state):.1e}" for state in ("uniform", "collapsed"))
        run.section(
            "Agreement",
            "The script's forces differ from this engine's with the paper's scheme by (rms over rms): "
            f"{found}; {agreement.TOLERANCE:.0e} is accepted.",
        )
    steps = run.measure(steps)
    run.measure([rows.large()])
    sweep = run.measure([rows.sweep()], lambda _, results: report.of_sweep(rows.counts(), results))
    run.measure([rows.threads()], lambda _, results: report.of_threads(results))
    return meshes, steps, sweep


def main():
    given = arguments()
    rows, run = Rows(HERE, given.built, given.quick), Run(given.only)
    facts = machine.facts(HERE)
    try:
        shown = compare(rows, run)
    except (agreement.Disagreement, Failed) as reason:
        sys.exit(f"comparison: {reason}")
    facts["load when it ended"] = machine.load()
    head = "\n".join(f"- {name}: {value}" for name, value in facts.items())
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / "report.md").write_text("\n\n".join(["# Comparison with peers", head, *run.text]) + "\n")
    report.write_batches(given.out / "report.csv", run.measured)
    plot.draw(given.out / "report.png", *shown, rows.counts())
    print(f"written: {given.out}/report.md, report.csv, report.png", file=sys.stderr)


main()
