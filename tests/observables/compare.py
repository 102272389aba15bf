"""What this program measures in runs against what freud, NumPy and SciPy find in the same trajectories.

Three short runs are made: a gas that condenses, a cold collapse of rings, a patch at random. `meniscus analyze` makes
tables from their trajectories, which have to be, byte for byte, those that the runs wrote. Prints a table; exit code 1
if anything differs.
"""

import argparse
import csv
import math
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import freud
import numpy
from scipy.optimize import curve_fit

try:
    import minkowski
except ModuleNotFoundError:
    minkowski = None

UNITS = 2.0**32
# Distance under which discs are neighbours, R0, and their number from which on a disc is a core.
NEIGHBOUR_DISTANCE, CORE_NEIGHBOURS = 3.25, 3
# Waves a shell beyond which S is averaged over a selection.
WAVES_PER_SHELL = 100
# Sums in double precision; what a mode of a thousand discs loses to phases that are products of phases.
DOUBLE = 1e-9
# freud computes in single precision: phases k.r of up to 2 pi 28 are off by 1e-5, which S is less for being a mean; distances
# are off by two units in the last place of coordinates, and areas of bins, differences of squares, by 170 units.
SINGLE, BORDER, AREA = 5e-5, 3e-5, 1e-4
# The same minimum, from derivatives in closed form here and from differences there.
MINIMUM, ERROR = 1e-5, 1e-3
# Rings 7, 5 and 3 with the R_f that the paper holds, R0.
RINGS, SPACING, FINAL_RADII = 9, 19.29, {7: 18, 5: 13, 3: 8}

GAS = """\
version = 1
seed = 11
[system]
particles = 1000
box = 200
capillary_strength = 0.89
capillary_length = 20
[time]
until = 2
[output]
trajectory = 0.25
observables = 0.25
modes = 0.25
radial_distribution = 0.25
structure_factor = 0.25
minkowski = 0.25
minkowski_thresholds = [0.1, 0.14, 0.4]
"""
RINGS_RUN = ("fig-12", "--until=1", "--set=motion.max_step=0.05", "--set=output.trajectory=0.02", "--set=output.radii=0.02")
PATCH_RUN = ("fig-14", "--until=0.2", "--set=output.trajectory=0.05", "--set=output.radii=0.05")


class Differs(Exception):
    """What another program found is not what was measured."""


class Check:
    """How many values were compared, and by how much they differ at the most."""

    def __init__(self):
        self.compared, self.largest = 0, 0.0

    def same(self, what, found, expected, tolerance, scale=None):
        """`found` by this program, `expected` by another; differences are relative to `scale`."""
        difference = abs(found - expected) / (abs(expected) if scale is None else scale) if found != expected else 0.0
        if not difference <= tolerance:
            raise Differs(f"{what}: {found}, by the other program {expected}")
        self.compared, self.largest = self.compared + 1, max(self.largest, difference)


class Run:
    """A run's frames and tables."""

    def __init__(self, directory):
        self.directory = directory
        with numpy.load(directory / "trajectory.npz") as archive:
            self.side = float(archive["box"])
            self.steps = [int(step) for step in archive["step"]]
            self.bits = list(archive["position_bits"])
        self.unit = 2 * math.pi / self.side

    def positions(self, frame):
        return self.bits[frame] * (self.side / UNITS)

    def rows(self, series):
        """The rows of a table, frame by frame; every frame has to have some."""
        frames = defaultdict(list)
        with open(self.directory / f"{series}.csv", newline="") as table:
            for row in csv.DictReader(table):
                frames[int(row["step"])].append(row)
        if sorted(frames) != self.steps:
            raise Differs(f"{series}.csv has rows of steps {sorted(frames)}, the trajectory {self.steps}")
        return [frames[step] for step in self.steps]

    def freud(self, frame, height=None):
        """Box and points, between -L/2 and L/2; with a `height` in three dimensions."""
        flat = self.positions(frame) - self.side / 2
        box = freud.box.Box.square(self.side) if height is None else freud.box.Box(self.side, self.side, height)
        return box, numpy.column_stack([flat, numpy.zeros(len(flat))]).astype(numpy.float32)


def clusters(run, check):
    """freud connects whatever pairs it is given: those of neighbours, of which one is a core."""
    for frame, (row,) in enumerate(run.rows("observables")):
        box, points = run.freud(frame)
        query = freud.locality.AABBQuery(box, points)
        pairs = query.query(points, {"r_max": NEIGHBOUR_DISTANCE, "exclude_ii": True}).toNeighborList()
        core = pairs.neighbor_counts >= CORE_NEIGHBOURS
        pairs.filter(core[pairs.query_point_indices] | core[pairs.point_indices])
        found = freud.cluster.Cluster().compute((box, points), neighbors=pairs)
        sizes = numpy.bincount(found.cluster_idx)
        sizes = sizes[sizes > 1].astype(float)
        for column, expected in (
            ("clusters", len(sizes)),
            ("mean_cluster_size", sizes.mean() if len(sizes) else 0),
            ("mass_weighted_cluster_size", (sizes**2).sum() / sizes.sum() if len(sizes) else 0),
            ("largest_cluster", sizes.max(initial=0)),
        ):
            check.same(f"step {row['step']}, {column}", float(row[column]), expected, DOUBLE)


def bins(rows):
    """The borders of the bins of g."""
    return 2 * float(rows[0]["distance"]) * numpy.arange(len(rows) + 1)


def distances(run, frame):
    """Of all pairs, R0."""
    bits = run.bits[frame]
    first, second = numpy.triu_indices(len(bits), 1)
    return numpy.hypot(*((bits[first] - bits[second]).view(numpy.int32) * (run.side / UNITS)).T)


def pairs_expected(run, ends):
    """Of discs that know nothing of each other, in each bin."""
    count = len(run.bits[0])
    return count * (count - 1) / 2 * math.pi * numpy.diff(ends**2) / run.side**2


def radial_distribution_by_freud(run, check):
    """Where no pair is so near to the border of a bin that single precision may put it on the other side."""
    for frame, rows in enumerate(run.rows("radial_distribution")):
        ends = bins(rows)
        found = freud.density.RDF(len(rows), ends[-1], normalization_mode="finite_size").compute(run.freud(frame))
        nearest = numpy.sort(distances(run, frame))
        unsure = numpy.searchsorted(nearest, ends + BORDER) - numpy.searchsorted(nearest, ends - BORDER)
        unsure = (unsure[:-1] + unsure[1:]) / pairs_expected(run, ends)
        for row, expected, unsure in zip(rows, found.rdf, unsure, strict=True):
            what = f"step {row['step']}, g at {row['distance']}"
            found, expected = float(row["g"]), float(expected)
            if unsure == 0:
                check.same(what, found, expected, AREA, scale=1 + expected)
            elif not abs(found - expected) < unsure + AREA * (1 + expected):
                raise Differs(f"{what}: {found}, by the other program {expected}")


def radial_distribution_by_numpy(run, check):
    for frame, rows in enumerate(run.rows("radial_distribution")):
        ends = bins(rows)
        expected = numpy.histogram(distances(run, frame), bins=ends)[0] / pairs_expected(run, ends)
        for row, expected in zip(rows, expected, strict=True):
            check.same(f"step {row['step']}, g at {row['distance']}", float(row["g"]), expected, DOUBLE)


class Shells:
    """All waves whose |k|L/2pi rounds to 1 ... count, one of each pair k and -k."""

    def __init__(self, count):
        l, m = numpy.mgrid[0 : count + 1, -count - 1 : count + 2].reshape(2, -1)
        number = numpy.rint(numpy.hypot(l, m)).astype(int)
        kept = ((l > 0) | (m > 0)) & (number <= count)
        self.waves, self.number, self.count = numpy.column_stack([l, m])[kept], number[kept], count

    def means(self, values):
        """For the shells 1 ... count."""
        sums = numpy.bincount(self.number, values, minlength=self.count + 1)[1:]
        return sums / numpy.bincount(self.number, minlength=self.count + 1)[1:]

    def orders(self):
        return numpy.hypot(*self.waves.T)

    def amplitudes(self, bits):
        # Phases wrap as positions do.
        turns = (self.waves.astype(numpy.int64) @ bits.astype(numpy.int64).T) & 0xFFFFFFFF
        return numpy.abs(numpy.exp(-2j * math.pi * (turns / UNITS)).sum(axis=1))


def modes(run, check):
    tables = run.rows("modes")
    shells = Shells(len(tables[0]))
    initial = shells.amplitudes(run.bits[0])
    for rows, bits in zip(tables, run.bits):
        amplitudes = shells.amplitudes(bits)
        columns = {
            "wavenumber": run.unit * shells.means(shells.orders()),
            "amplitude": shells.means(amplitudes),
            "power": shells.means(amplitudes**2),
            "log_growth": shells.means(numpy.log(amplitudes / initial)),
        }
        for number, row in enumerate(rows):
            check.same("shell", int(row["shell"]), number + 1, 0)
            for column, expected in columns.items():
                scale = 1.0 if column == "log_growth" else None
                what = f"step {row['step']}, {column} of shell {row['shell']}"
                check.same(what, float(row[column]), expected[number], DOUBLE, scale)


def shells_of(rows, run):
    """The shells of rows of S, in rising order: a mean wavenumber is in its own."""
    return [round(float(row["wavenumber"]) / run.unit) for row in rows]


def structure_factor_by_freud(run, check):
    """Of shells that are averaged over all waves.

    freud takes the waves with no component below zero, so it is asked again after a reflection, and for the waves along the
    axes, which come twice. It knows boxes of three dimensions only: in a low one all waves that are not level are
    beyond the largest k.
    """
    tables = run.rows("structure_factor")
    last = max(number for number in range(1, len(tables[0])) if math.pi * number < WAVES_PER_SHELL - 10)
    narrow = 0.5 * math.pi / ((last + 1) * run.unit)
    direct = freud.diffraction.StaticStructureFactorDirect(
        bins=last, k_max=(last + 0.5) * run.unit, k_min=0.5 * run.unit, num_sampled_k_points=0
    )

    def mean(sides, places):
        places = numpy.column_stack([places, numpy.zeros((len(places), 3 - places.shape[1]))])
        return direct.compute((freud.box.Box(*sides), places.astype(numpy.float32))).S_k.astype(float)

    l, m = numpy.mgrid[0 : last + 1, 0 : last + 1].reshape(2, -1)
    count = numpy.bincount(numpy.rint(numpy.hypot(l, m)).astype(int))[1 : last + 1]
    for frame, rows in enumerate(tables):
        places = run.positions(frame) - run.side / 2
        flat, line = (run.side, run.side, narrow), (run.side, narrow, narrow)
        quadrants = mean(flat, places) + mean(flat, places * [-1, 1])
        axes = mean(line, places[:, :1]) + mean(line, places[:, 1:])
        expected = (count * quadrants - axes) / (2 * count - 2)
        for row, expected in zip(rows[:last], expected, strict=True):
            what = f"step {row['step']}, S at {row['wavenumber']}"
            check.same(what, float(row["structure_factor"]), expected, SINGLE)


def structure_factor_by_numpy(run, check):
    """All waves of all shells of the last frame; where only a selection was averaged, within its scatter."""
    rows = run.rows("structure_factor")[-1]
    shells = Shells(len(rows))
    powers = shells.amplitudes(run.bits[-1]) ** 2 / len(run.bits[-1])
    expected, counts = shells.means(powers), numpy.bincount(shells.number)[1:]
    if shells_of(rows, run) != list(range(1, len(rows) + 1)):
        raise Differs("the wavenumbers of S are not those of successive shells")
    scores = []
    for row, expected, count in zip(rows, expected, counts, strict=True):
        found = float(row["structure_factor"])
        if count <= WAVES_PER_SHELL:
            check.same(f"step {row['step']}, S at {row['wavenumber']}", found, expected, DOUBLE)
        else:
            # Powers are exponentially distributed; half of the waves are mirror images of the other half.
            scores.append((found / expected - 1) * math.sqrt(WAVES_PER_SHELL / (1 - WAVES_PER_SHELL / count)))
    spread = float(numpy.sqrt(numpy.mean(numpy.square(scores))))
    if not (spread < 1.5 and abs(numpy.mean(scores)) < 4 * spread / math.sqrt(len(scores))):
        raise Differs(f"selected waves: mean score {numpy.mean(scores)}, rms {spread}")


def from_middle(run, frame):
    along = (run.bits[frame] ^ numpy.uint32(2**31)).astype(numpy.uint32).view(numpy.int32)
    return numpy.hypot(*(along * (run.side / UNITS)).T)


def radii(run, check, groups):
    """`groups`: initial radius and members, by number."""
    for frame, rows in enumerate(run.rows("radii")):
        distances = from_middle(run, frame)
        check.same("groups", [int(row["group"]) for row in rows] == sorted(groups), True, 0)
        for row in rows:
            initial, members = groups[int(row["group"])]
            mine = distances[members]
            for column, expected in (("initial_radius", initial), ("radius", mine.mean()), ("spread", mine.std())):
                what = f"step {row['step']}, {column} of group {row['group']}"
                check.same(what, float(row[column]), expected, DOUBLE, scale=1.0)


def radii_of_rings(run, check):
    first = lambda ring: 1 + 5 * ring * (ring - 1)
    groups = {ring: (SPACING * ring, range(first(ring), first(ring + 1))) for ring in range(1, RINGS + 1)}
    radii(run, check, groups | {0: (0.0, [0])})


def radii_of_shells(run, check):
    numbers = (from_middle(run, 0) // 7.5).astype(int)
    radii(run, check, {int(n): (7.5 * (n + 0.5), numpy.flatnonzero(numbers == n)) for n in set(numbers)})


def collapse(run, check, fit_collapse):
    """Eq. 30, with each radius held and free."""
    samples = defaultdict(list)
    for rows in run.rows("radii"):
        for row in rows:
            samples[int(row["group"])].append((float(row["time_over_jeans"]), float(row["radius"])))
    for ring, final in FINAL_RADII.items():
        initial = SPACING * ring
        for held in ((initial, final), (None, final), (initial, None), (None, None)):
            words = [repr(radius) if radius is not None else "free" for radius in held]
            text = "".join(f"{time!r} {radius!r}\n" for time, radius in samples[ring])
            said = subprocess.run(
                [fit_collapse, "0.9", *words], input=text, text=True, check=True, capture_output=True
            ).stdout
            found = [float(word) for word in said.split()]
            times, values = numpy.array([sample for sample in samples[ring] if 0 < sample[0] < 0.9]).T

            def model(time, delay, *free):
                free = list(free)
                start, end = (radius if radius is not None else free.pop(0) for radius in held)
                return end + (start - end) * numpy.sqrt(numpy.maximum(1 - time / delay, 0))

            guess = [1.2] + [guess for guess, radius in zip((initial, final), held) if radius is None]
            best, covariance = curve_fit(model, times, values, guess, xtol=1e-12, ftol=1e-12, gtol=1e-12)
            errors = numpy.sqrt(numpy.diagonal(covariance))
            free = [0] + [2 * (place + 1) for place, radius in enumerate(held) if radius is None]
            what = f"ring {ring}, R_i {words[0]}, R_f {words[1]}"
            for place, value, error in zip(free, best, errors, strict=True):
                check.same(what, found[place], value, MINIMUM)
                check.same(f"{what}, error", found[place + 1], error, ERROR)
            for place in {2, 4} - set(free):
                check.same(f"{what}, held", found[place], held[place // 2 - 1], 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", required=True, type=Path)
    parser.add_argument("--work", required=True, type=Path)
    arguments = parser.parse_args()
    work = arguments.work
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)

    def meniscus(*words):
        subprocess.run([arguments.programs / "meniscus", *words], cwd=work, check=True, capture_output=True)

    (work / "gas.toml").write_text(GAS)
    usual = ("--set=output.trajectory_format=npz", "--set=output.snapshots=0")
    for name, words in (("gas", ("gas.toml",)), ("rings", RINGS_RUN), ("patch", PATCH_RUN)):
        meniscus("run", *words, "--out", name, *usual)
    gas, rings, patch = (Run(work / name) for name in ("gas", "rings", "patch"))

    # Each run writes these as often as frames.
    of_gas = ("observables", "minkowski", "modes", "radial_distribution", "structure_factor")
    analyses = (("gas", of_gas), ("rings", ("radii",)), ("patch", ("radii",)))
    for name, series in analyses:
        meniscus("analyze", name, "--out", f"{name}-analysis", "--series", ",".join(series))

    def analysed(check):
        for name, series in analyses:
            for one in series:
                found, expected = ((work / of / f"{one}.csv").read_bytes() for of in (f"{name}-analysis", name))
                check.same(f"{name}, analysis of {one}.csv", found == expected, True, 0)

    comparisons = [
        ("all tables", "analyze", analysed),
        ("clusters", "freud", lambda check: clusters(gas, check)),
        ("g(r)", "freud", lambda check: radial_distribution_by_freud(gas, check)),
        ("g(r)", "NumPy", lambda check: radial_distribution_by_numpy(gas, check)),
        ("S(k)", "freud", lambda check: structure_factor_by_freud(gas, check)),
        ("S(k)", "NumPy", lambda check: structure_factor_by_numpy(gas, check)),
        ("modes", "NumPy", lambda check: modes(gas, check)),
        ("radii, rings", "NumPy", lambda check: radii_of_rings(rings, check)),
        ("radii, shells", "NumPy", lambda check: radii_of_shells(patch, check)),
        ("fit of Eq. 30", "SciPy", lambda check: collapse(rings, check, arguments.programs / "fit_collapse")),
    ]
    if minkowski is not None:
        comparisons += [
            ("Minkowski, pixels", "scikit-image", lambda check: minkowski.pixels_scikit_image(gas, check)),
            ("Minkowski, contours", "contourpy", lambda check: minkowski.contours_contourpy(gas, check)),
            ("Minkowski, contours", "scikit-image", lambda check: minkowski.contours_scikit_image(gas, check)),
        ]
    failed = False
    print(f"{'observable':<20} {'by':<14} {'values':>6}  largest difference")
    for observable, program, compare in comparisons:
        check = Check()
        try:
            compare(check)
            said = f"{check.compared:>6}  {check.largest:.1e}"
        except Exception as problem:  # Whatever another program throws is a reason to fail.
            failed = True
            said = f"{'':>6}  DIFFERS: {type(problem).__name__}: {problem}"
        print(f"{observable:<20} {program:<14} {said}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
