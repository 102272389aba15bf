"""A program that does one thing again and again, and is asked for batches of it over standard input."""

import dataclasses
import os
import subprocess


class Unavailable(Exception):
    """A contender could not start; the text says why."""


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
        self.process = subprocess.Popen(
            contender.command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **dict(contender.environment)},
        )
        line = self.process.stdout.readline()
        if not line.startswith("ready "):
            reason = self.process.communicate()[1].strip().splitlines()
            raise Unavailable(f"{contender.label}: {reason[-1] if reason else 'it stopped without a word'}")
        self.description = line.removeprefix("ready ").strip()

    def ask(self, line):
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError(f"{self.label} stopped: {self.process.stderr.read().strip()}")
        return [float(word) for word in answer.split()]

    def batch(self, repetitions):
        cpu, wall = self.ask(repetitions)
        return Seconds(cpu / repetitions, wall / repetitions)

    def stop(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()
