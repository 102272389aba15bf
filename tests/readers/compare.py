"""Trajectories of this program as gsd, freud, MDAnalysis, OVITO, ASE and NumPy read them.

What is right is said by `final.csv` and by NumPy's archive, whose positions are compared as whole numbers; every other
reader has to find the same frames, steps, boxes, positions and images. Prints a table; exit code 1 if anything differs.
"""

import argparse
import csv
import math
import random
import shutil
import subprocess
import sys
import warnings
from dataclasses import dataclass, field
from pathlib import Path

import ase.io
import freud
import gsd.hoomd
import MDAnalysis
import numpy
import ovito.io

warnings.filterwarnings("ignore")

UNITS = 2.0**32
# Readers in single precision: half a unit in the last place of a coordinate, and one of the box.
SINGLE = 1.2e-7
# Readers in double precision of text that has every digit.
DOUBLE = 1e-15
# Distance under which discs are neighbours, R0.
NEIGHBOUR_DISTANCE = 3.25

SMALL = """\
version = 1
seed = 7
[system]
particles = 60
box = 33.3
capillary_strength = 10
capillary_length = 30
strengths = [1, -1, 0.5]
[force]
method = "pm"
[mesh]
grid = 16
[time]
until = 0.5
[output]
trajectory = 0.05
snapshots = 0
"""


@dataclass
class Truth:
    """The frames of a trajectory."""

    side: float
    steps: list
    # As fractions of the box, 2⁻³².
    bits: list
    images: list
    logs: dict = field(default_factory=dict)

    def positions(self, frame):
        return self.bits[frame] * (self.side / UNITS)


class Differs(Exception):
    """What a reader found is not what was computed."""


def require(condition, what):
    if not condition:
        raise Differs(what)


def distance(found, expected, side):
    """The largest distance along an axis between images of positions, in boxes."""
    difference = numpy.abs(numpy.asarray(found, dtype=float)[:, :2] - expected) / side
    return float(numpy.max(numpy.minimum(difference, 1 - difference)))


class Check:
    """What a reader finds, frame by frame."""

    def __init__(self, truth, tolerance):
        self.truth, self.tolerance, self.frames, self.largest = truth, tolerance, 0, 0.0

    def frame(self, positions, side, step=None, images=None):
        number, truth = self.frames, self.truth
        require(number < len(truth.steps), f"more than {len(truth.steps)} frames")
        require(len(positions) == len(truth.bits[number]), f"frame {number}: {len(positions)} discs")
        largest = distance(positions, truth.positions(number), truth.side)
        require(largest <= self.tolerance, f"frame {number}: positions differ by {largest} boxes")
        require(abs(side / truth.side - 1) <= SINGLE, f"frame {number}: a box of {side}")
        require(step is None or step == truth.steps[number], f"frame {number}: step {step}")
        if images is not None:
            require((numpy.asarray(images)[:, :2] == truth.images[number]).all(), f"frame {number}: images")
        self.frames, self.largest = number + 1, max(self.largest, largest)

    def end(self):
        require(self.frames == len(self.truth.steps), f"{self.frames} of {len(self.truth.steps)} frames")
        return self.frames, self.largest


def with_numpy(path, truth):
    """The archive is the truth; its positions in R0 have to be those of its whole numbers."""
    check = Check(truth, DOUBLE)
    with numpy.load(path) as archive:
        require((archive["time"] == archive["time_units"] / 2.0**40).all(), "time")
        for number, positions in enumerate(archive["positions"]):
            check.frame(positions, float(archive["box"]), archive["step"][number], archive["images"][number])
    return check.end()


def with_gsd(path, truth):
    check = Check(truth, SINGLE)
    with gsd.hoomd.open(path, "r") as trajectory:
        for number, frame in enumerate(trajectory):
            frame.validate()
            configuration, particles = frame.configuration, frame.particles
            lengths = list(configuration.box)
            require(configuration.dimensions == 2 and lengths[0] == lengths[1] and lengths[2:] == [0] * 4, "box")
            require((particles.position >= -lengths[0] / 2).all(), "a position below the box")
            require((particles.position < lengths[0] / 2).all(), "a position at the edge of the box or above")
            require((particles.position[:, 2] == 0).all(), "z")
            require(particles.types == ["disc"] and (particles.typeid == 0).all(), "types")
            require((particles.diameter == 2).all(), "diameter")
            bits = frame.log["particles/position_bits"]
            require((bits == truth.bits[number]).all(), "exact positions")
            require(frame.log["meniscus/box"][0] == truth.side, "exact box")
            for name, values in truth.logs.items():
                logged = frame.log[name]
                require((logged == values[number]).all(), f"log {name}: {logged}, not {values[number]}")
            centred = particles.position.astype(float) + truth.side / 2
            check.frame(centred, lengths[0], configuration.step, particles.image)
    return check.end()


def neighbours(positions, side):
    """The number of ordered pairs closer than the distance of neighbours."""
    difference = positions[:, None] - positions[None]
    difference -= side * numpy.round(difference / side)
    return int(numpy.sum(numpy.sum(difference**2, axis=2) < NEIGHBOUR_DISTANCE**2)) - len(positions)


def with_freud(path, truth):
    check = Check(truth, SINGLE)
    with gsd.hoomd.open(path, "r") as trajectory:
        for number, frame in enumerate(trajectory):
            query = freud.locality.AABBQuery.from_system(frame)
            require(query.box.is2D, "a box of three dimensions")
            require(numpy.allclose(query.box.wrap(query.points), query.points, atol=1e-5), "wrapping")
            pairs = query.query(query.points, {"r_max": NEIGHBOUR_DISTANCE, "exclude_ii": True}).toNeighborList()
            require(len(pairs) == neighbours(truth.positions(number), truth.side), f"{len(pairs)} pairs")
            check.frame(query.points.astype(float) + truth.side / 2, query.box.Lx)
    return check.end()


def with_mdanalysis(path, truth, **formats):
    check = Check(truth, SINGLE)
    universe = MDAnalysis.Universe(str(path), **formats)
    shift = truth.side / 2 if path.suffix == ".gsd" else 0
    for timestep in universe.trajectory:
        positions = universe.atoms.positions.astype(float) + shift
        check.frame(positions, timestep.dimensions[0], timestep.data.get("step"))
    return check.end()


def with_ovito(path, truth):
    check = Check(truth, SINGLE if path.suffix == ".gsd" else DOUBLE)
    pipeline = ovito.io.import_file(str(path), sort_particles=True)
    for number in range(pipeline.source.num_frames):
        data = pipeline.compute(number)
        cell, particles = data.cell, data.particles
        origin = numpy.array(cell[:, 3])
        positions = numpy.array(particles.positions) - origin
        images = numpy.array(particles["Periodic Image"]) if "Periodic Image" in particles else None
        step = data.attributes.get("Timestep", data.attributes.get("step"))
        require(tuple(cell.pbc)[:2] == (True, True), "the box is not periodic")
        if path.suffix == ".gsd":
            require(cell.is2D, "a box of three dimensions")
            require((numpy.array(particles["position_bits"]) == truth.bits[number]).all(), "exact positions")
            for name in ("time", "max_force", "clusters"):
                require(name not in truth.logs or data.attributes[name] == truth.logs[name][number], name)
            if "particles/strength" in truth.logs:
                require((particles["strength"] == truth.logs["particles/strength"][number]).all(), "strength")
        check.frame(positions, cell[0, 0], step, images)
    return check.end()


def with_ase(path, truth, format):
    check = Check(truth, DOUBLE)
    for atoms in ase.io.read(path, ":", format=format):
        require(tuple(atoms.pbc)[:2] == (True, True), "the box is not periodic")
        check.frame(atoms.get_positions(), atoms.cell[0, 0], atoms.info.get("step"))
    return check.end()


def truth_of(archive):
    with numpy.load(archive) as arrays:
        logs = {name: arrays[name] for name in ("time", "time_over_jeans", "dt", "max_force", "clusters")}
        logs = {name: values for name, values in logs.items() if not (values != values).all()}
        strengths = arrays["strengths"]
        if not (strengths == 1).all():
            logs["particles/strength"] = strengths
        return Truth(
            float(arrays["box"]), list(arrays["step"]), list(arrays["position_bits"]), list(arrays["images"]), logs
        )


def edges(path):
    """A dump of discs at the edges and everywhere, which went around the box."""
    chance = random.Random(5)
    side, ends = 33.3, [0, 1, 2**31 - 1, 2**31, 2**31 + 1, 2**32 - 1]
    lines = []
    for frame in range(3):
        places = [(x, y) for x in ends for y in ends] + [
            (chance.getrandbits(32), chance.getrandbits(32)) for _ in range(30)
        ]
        lines += ["ITEM: TIMESTEP", 10 * frame + 2**40, "ITEM: NUMBER OF ATOMS", len(places)]
        lines += ["ITEM: BOX BOUNDS pp pp pp", f"0 {side}", f"0 {side}", "-0.5 0.5", "ITEM: ATOMS id type x y z ix iy iz"]
        for number, place in enumerate(places):
            x, y = (bits * (side / UNITS) for bits in place)
            around = chance.randint(-100, 100), chance.randint(-3, 3)
            lines.append(f"{number + 1} 1 {x!r} {y!r} 0 {around[0]} {around[1]} 0")
    path.write_text("".join(f"{line}\n" for line in lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--work", required=True, type=Path)
    arguments = parser.parse_args()
    work = arguments.work
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)

    def meniscus(*words):
        subprocess.run([arguments.program, *words], cwd=work, check=True, capture_output=True)

    (work / "small.toml").write_text(SMALL)
    edges(work / "edges.lammpstrj")
    files = {"a run": {}, "edges": {}}
    for word, ending in (("gsd", "gsd"), ("xyz", "xyz"), ("lammps", "lammpstrj"), ("npz", "npz")):
        meniscus("run", "small.toml", "--out", word, "--set", f"output.trajectory_format={word}")
        files["a run"][ending] = work / word / f"trajectory.{ending}"
        if ending != "lammpstrj":
            meniscus("convert", "edges.lammpstrj", f"edges.{ending}")
        files["edges"][ending] = work / f"edges.{ending}"

    failed = False
    print(f"{'reader':<12} {'format':<7} {'file':<6} {'frames':>6}  largest difference, boxes")
    for name, paths in files.items():
        truth = truth_of(paths["npz"])
        if name == "a run":
            rows = list(csv.DictReader((work / "npz/final.csv").open()))
            last = numpy.array([[float(row["x"]), float(row["y"])] for row in rows])
            assert (last == truth.positions(-1)).all(), "final.csv is not the last frame"
        dump = {"format": "LAMMPSDUMP", "topology_format": "LAMMPSDUMP", "atom_style": "id type x y z"}
        for reader, ending, read in (
            ("NumPy", "npz", with_numpy),
            ("gsd", "gsd", with_gsd),
            ("freud", "gsd", with_freud),
            ("MDAnalysis", "gsd", with_mdanalysis),
            ("MDAnalysis", "lammps", lambda path, truth: with_mdanalysis(path, truth, **dump)),
            ("OVITO", "gsd", with_ovito),
            ("OVITO", "xyz", with_ovito),
            ("OVITO", "lammps", with_ovito),
            ("ASE", "xyz", lambda path, truth: with_ase(path, truth, "extxyz")),
            ("ASE", "lammps", lambda path, truth: with_ase(path, truth, "lammps-dump-text")),
        ):
            path = paths[{"lammps": "lammpstrj"}.get(ending, ending)]
            try:
                frames, largest = read(path, truth)
                said = f"{frames:>6}  {largest:.1e}"
                assert math.isfinite(largest)
            except Exception as problem:  # Whatever a reader throws is a reason to fail.
                failed = True
                said = f"{'':>6}  DIFFERS: {type(problem).__name__}: {problem}"
            print(f"{reader:<12} {ending:<7} {name:<6} {said}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
