"""Timing of contenders against each other: batches in turn, the order another in every round."""

import contextlib
import dataclasses
import statistics
import sys

from . import agreement
from .contender import Running, Unavailable

# A batch takes about so long, unless its number of repetitions is given.
BATCH_SECONDS = 0.02


@dataclasses.dataclass(frozen=True)
class Result:
    """One contender's batches in one comparison, in the order of rounds."""

    label: str
    description: str
    repetitions: int
    cpu: tuple[float, ...]
    wall: tuple[float, ...]

    def quartiles(self):
        """Lower quartile, median and upper quartile of the CPU time of one repetition, s."""
        return statistics.quantiles(self.cpu, n=4, method="inclusive")

    @property
    def median(self):
        return statistics.median(self.cpu)

    def ratio_of_medians(self, other):
        return self.median / other.median

    def median_of_ratios(self, other):
        """Of the ratios within each round, which saw the same machine."""
        return statistics.median(mine / its for mine, its in zip(self.cpu, other.cpu))


def start(contenders, stack):
    """Starts those that can be started; says which cannot."""
    running, missing = [], []
    for contender in contenders:
        try:
            running.append(Running(contender))
            stack.callback(running[-1].stop)
        except Unavailable as reason:
            print(f"  not available: {reason}", file=sys.stderr)
            missing.append(str(reason))
    return running, missing


def repetitions_of(running, given):
    """How many repetitions make a batch, after two to warm up."""
    running.batch(2)
    return given or max(1, round(BATCH_SECONDS / max(running.batch(1).cpu, 1e-6)))


def measure(comparison):
    """Times all contenders; gives their results and why some are missing."""
    with contextlib.ExitStack() as stack:
        running, missing = start(comparison.contenders, stack)
        if comparison.comparable:
            agreement.of_fields(running)
        batches = [repetitions_of(each, comparison.repetitions) for each in running]
        seconds = [[] for _ in running]
        for turn in range(comparison.rounds):
            for place in range(len(running)):
                which = (place + turn) % len(running)
                seconds[which].append(running[which].batch(batches[which]))
        results = [
            Result(each.label, each.description, batch, tuple(s.cpu for s in taken), tuple(s.wall for s in taken))
            for each, batch, taken in zip(running, batches, seconds)
        ]
    return results, missing
