"""A program that does one thing again and again, and is asked for batches of it over standard input."""

import contextlib
import dataclasses
import os
import subprocess
import tempfile


class Unavailable(Exception):
    """A contender could not start; the text says why."""


class Failed(Exception):
    """A contender stopped while it was asked, or answered no numbers."""


@dataclasses.dataclass(frozen=True)
class Contender:
    """What to start, and how the report calls it."""

    label: str
    command: tuple[str, ...]
    environment: tuple[tuple[str, str], ...] = ()


@dataclasses.dataclass(frozen=True)
class Seconds:
    """What a batch took, for each of its repetitions."""

    cpu: float
    wall: float


class Running:
    """A contender that has been started and is ready."""

    def __init__(self, contender):
        self.label = contender.label
        # A file and no pipe: one that nobody reads from is full some day, and the contender would wait for ever.
        self.complaints = tempfile.TemporaryFile("w+", errors="replace")
        self.process = subprocess.Popen(
            contender.command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.complaints,
            text=True,
            env={**os.environ, **dict(contender.environment)},
        )
        line = self.process.stdout.readline()
        if not line.startswith("ready "):
            self.process.communicate()
            raise Unavailable(f"{contender.label}: {self.last_words()}")
        self.description = line.removeprefix("ready ").strip()

    def ask(self, line):
        try:
            self.process.stdin.write(f"{line}\n")
            self.process.stdin.flush()
            answer = self.process.stdout.readline()
        except BrokenPipeError:
            answer = ""
        if not answer:
            self.process.wait()
            raise Failed(f"{self.label} stopped: {self.last_words()}")
        try:
            return [float(word) for word in answer.split()]
        except ValueError:
            raise Failed(f"{self.label} answered {answer.strip()!r}, expected numbers") from None

    def last_words(self):
        """The last line that it wrote to standard error."""
        self.complaints.seek(0)
        lines = self.complaints.read().strip().splitlines()
        return lines[-1] if lines else "it stopped without a word"

    def batch(self, repetitions):
        cpu, wall = self.ask(repetitions)
        return Seconds(cpu / repetitions, wall / repetitions)

    def stop(self):
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.complaints.close()
