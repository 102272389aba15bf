"""The conversation with the comparison.

After a line `ready DESCRIPTION`, each number on a line of standard input is a batch of so many repetitions, answered with
the CPU time of this process and the time on the wall that it took, in seconds.
"""

import sys
import time


def serve(description, repeat):
    """Serves batches until standard input ends; `repeat(n)` does the work n times."""
    answer(f"ready {description}")
    for line in sys.stdin:
        cpu, wall = time.process_time(), time.perf_counter()
        repeat(int(line))
        answer(f"{time.process_time() - cpu:e} {time.perf_counter() - wall:e}")


def answer(line):
    print(line, flush=True)
