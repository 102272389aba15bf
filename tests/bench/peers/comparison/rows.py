"""What is compared with what."""

import dataclasses
import math
import subprocess

from . import limits, states
from .contender import Contender

# Ratios of CPU time to the fastest of the peers that this engine is to stay below: a mesh solve by nodes a side and level
# of SIMD, a whole step of Table I by state, a whole step of a million discs.
MESH_TARGETS = {512: {"avx2": 0.75, "avx512": 0.5}, 2048: {"avx2": 0.55, "avx512": 0.4}}
STEP_TARGETS = {"uniform": 0.30, "collapsed": 0.50}
LARGE_TARGET = 2.0
# Largest over smallest cost of a disc, whatever their number, that this engine is to stay below.
SWEEP_TARGET = 1.5
# Time on the wall with one thread over that with two that this engine is to reach.
THREADS_TARGET = 1.7

# Plans are sought the longest on meshes up to this.
LARGEST_PATIENT_MESH = 1024
SKINS = ("2", "2.5", "3")
SWEEP_SKIN = "2.5"
LARGE_COUNT = 1_000_000
# Spacing of the mesh for many discs, R0, as near as a power of two comes to it: 2048 nodes a side for a million.
LARGE_SPACING = 4.9
# Steps in a batch: so many that lists of neighbours of discs spread evenly are made several times in it.
STEPS = 50


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Contenders for one job."""

    name: str
    title: str
    contenders: tuple[Contender, ...]
    rounds: int
    # Of the job in a batch; none to make a batch take a certain time.
    repetitions: int | None = None
    # The unit of the report, and how many of it are in a second.
    unit: str = "ms"
    units: float = 1e3
    # Beginning of the labels of those whose fastest is the reference.
    reference: str = ""
    # Ratio to the reference to stay below, by label.
    targets: dict[str, float] = dataclasses.field(default_factory=dict)
    # Whether contenders can be asked for values of their result.
    comparable: bool = False


class Rows:
    """Every comparison on this machine, quick or full; `built` is the folder of what was built."""

    def __init__(self, here, built, quick):
        self.peers, self.here, self.quick = built / "peers", here, quick
        self.timer = str(built / "release" / "meniscus-timer")
        self.program = str(built / "release" / "meniscus")
        self.python = str(self.peers / "python" / "bin" / "python")
        self.solvers = subprocess.run(
            [self.timer, "solvers"], check=True, capture_output=True, text=True
        ).stdout.split()
        self.fftw = [path.name.removeprefix("fftw-") for path in sorted(self.peers.glob("fftw-*"))]
        self.state_files = {}

    def state(self, name):
        """The file of a state: uniform, collapsed, or a number of discs at random."""
        if name not in self.state_files:
            if name == "collapsed":
                positions = states.collapsed()
            elif name == "uniform":
                positions = states.uniform(states.TABLE_1_COUNT, states.TABLE_1_BOX)
            else:
                positions = states.uniform(name, states.box_of(name))
            self.state_files[name] = str(states.write(self.peers / f"state-{name}.csv", positions))
        return self.state_files[name]

    def environment_of_script(self):
        """With the FFTW built here, which is faster than that in pyFFTW's wheel."""
        library = self.peers / "fftw" / "avx2" / "lib" / "libfftw3f.so.3"
        return (("LD_PRELOAD", str(library)), ("PAPER_SCRIPT_WISDOM", str(self.peers / "wisdom-script")))

    def script(self, job, *arguments):
        command = (self.python, str(self.here / "contenders" / "paper_script.py"), job, *arguments)
        return Contender("script, numba and pyFFTW", command, self.environment_of_script())

    def lammps(self, count, skin, label):
        path = str(self.here / "contenders" / "lammps_peer.py")
        command = (self.python, path, self.state(count), repr(states.box_of(count)), skin)
        libraries = (("LD_LIBRARY_PATH", str(self.peers / "python" / "lib")), ("OMP_NUM_THREADS", "1"))
        return Contender(label, command, libraries)

    def step(self, label, engine, state, *overrides, threads=1):
        start = ("start.kind=file", f"start.path={self.state(state)}")
        return Contender(label, (self.timer, "step", engine, str(threads), *start, *overrides))

    def large_step(self, label, count, threads=1):
        """The whole step of discs spread evenly. What is chosen freely suits a collapse too, which none of these does."""
        box = states.box_of(count)
        system = (f"system.particles={count}", f"system.box={box!r}", "force.accuracy=1e-3")
        grid = 2 ** round(math.log2(box / LARGE_SPACING))
        scheme = (f"mesh.grid={grid}", "mesh.assignment=order-5")
        return self.step(label, "host", count, *system, *scheme, threads=threads)

    def mesh(self, grid):
        patience = "patient" if grid <= LARGEST_PATIENT_MESH else "measure"
        ours = [Contender(f"meniscus {solver}", (self.timer, "mesh", solver, str(grid))) for solver in self.solvers]
        fftw = [
            Contender(
                f"FFTW {library}, {way} back",
                (str(self.peers / f"fftw-{library}"), str(grid), way, patience, str(self.peers / f"wisdom-{library}")),
            )
            for library in self.fftw
            for way in ("two", "one")
        ]
        rustfft = Contender("RustFFT", (self.timer, "realfft", str(grid)))
        return Comparison(
            name=f"mesh-{grid}",
            title=f"Mesh solve, {grid} nodes a side",
            contenders=(*ours, *fftw, rustfft),
            rounds=9 if self.quick else 31,
            reference="FFTW",
            targets={f"meniscus {solver}": target for solver, target in MESH_TARGETS.get(grid, {}).items()},
            comparable=True,
        )

    def meshes(self):
        return [self.mesh(grid) for grid in (256, 512, 1024, 2048, 4096) if not (self.quick and grid == 4096)]

    def whole_step(self, state):
        ours = [
            self.step("meniscus, accuracy 1e-3", "host", state, "force.accuracy=1e-3"),
            self.step("meniscus, accuracy 1e-4", "host", state, "force.accuracy=1e-4"),
            self.step("meniscus, the paper's mesh", "host", state, "force.method=pm"),
            self.step("meniscus core, accuracy 1e-3", "core", state, "force.accuracy=1e-3"),
        ]
        return Comparison(
            name=f"step-{state}",
            title=f"Whole step of Table I, {state}",
            contenders=(*ours, self.script("step", self.state(state))),
            rounds=11 if self.quick else 41,
            repetitions=STEPS,
            reference="script",
            targets={ours[0].label: STEP_TARGETS[state]},
        )

    def whole_steps(self):
        return [self.whole_step(state) for state in STEP_TARGETS]

    def large(self):
        """A million discs: this engine's whole step against the repulsion alone of LAMMPS."""
        ours = self.large_step("meniscus", LARGE_COUNT)
        skins = [self.lammps(LARGE_COUNT, skin, f"LAMMPS, repulsion alone, skin {skin} R0") for skin in SKINS]
        return Comparison(
            name="large",
            title=f"{LARGE_COUNT} discs, mesh 2048",
            contenders=(ours, *skins),
            rounds=3 if self.quick else 7,
            repetitions=STEPS,
            unit="ns per disc",
            units=1e9 / LARGE_COUNT,
            reference="LAMMPS",
            targets={ours.label: LARGE_TARGET},
        )

    def counts(self):
        return (10_000, 30_000, 100_000) if self.quick else (10_000, 30_000, 100_000, 300_000, 1_000_000)

    def sweep(self):
        """This engine and LAMMPS for every number of discs, all in one comparison."""
        contenders = [
            contender
            for count in self.counts()
            for contender in (
                self.large_step(f"meniscus {count}", count),
                self.lammps(count, SWEEP_SKIN, f"LAMMPS {count}"),
            )
        ]
        rounds = 5 if self.quick else 7
        return Comparison("sweep", "Cost of a disc", tuple(contenders), rounds, STEPS, unit="ns")

    def threads(self):
        contenders = [
            self.large_step(f"{threads} thread{'s' * (threads > 1)}", LARGE_COUNT, threads=threads) for threads in (1, 2)
        ]
        rounds, steps = (3, STEPS // 2) if self.quick else (7, STEPS)
        return Comparison("threads", "Two threads", tuple(contenders), rounds, steps)

    def limits(self):
        program = str(self.peers / "limits")
        flags = cpu_flags()
        arithmetic = [
            Contender(f"{what} {level}", (program, what, level))
            for what in ("adds", "mixed")
            for level, flag in (("sse2", "sse2"), ("avx2", "avx2"), ("avx512", "avx512f"))
            if flag in flags
        ]
        memory = [
            Contender("L2", (program, "copy", str(limits.L2_KILOBYTES))),
            Contender("L3", (program, "copy", str(limits.L3_KILOBYTES))),
            Contender("memory", (program, "triad", str(limits.MEMORY_KILOBYTES))),
        ]
        rounds = 9 if self.quick else 21
        return Comparison("limits", "The machine's limits", (*arithmetic, *memory), rounds)


def cpu_flags():
    """The CPU's flags, as Linux says."""
    with open("/proc/cpuinfo") as lines:
        return next(line for line in lines if line.startswith("flags")).split(":")[1].split()
