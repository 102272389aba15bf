"""The paper's simulation as a physicist would write it in Python who wants it fast: numba and pyFFTW.

Particle-mesh force with triangular shaped clouds (Eqs. 18 to 21), WCA repulsion from cells (Eq. 15), Ermak's step with
uniform noise (Eqs. 16 and 17). Lengths in R0, energies in kBT, times in R0^2/D. The mesh is binary32, plans are searched
for patiently and kept, every loop over discs or modes is compiled, no array is made during a run.

    paper_script.py step POSITIONS           times steps, batch by batch
    paper_script.py forces POSITIONS OUT     writes the forces, one row a disc
"""

import ctypes
import os
import pathlib
import sys

import numba
import numpy as np
import pyfftw
from batches import serve

BOX = 500.0
GRID = 512
CAPILLARY_STRENGTH = 0.89
CAPILLARY_LENGTH = 270.0
CONTACT = 2.0
CUTOFF = 2.0 * 2.0 ** (1.0 / 6.0)
MAX_STEP = 0.001
MAX_DISPLACEMENT = 0.25
# Cells along a side, a little wider than the repulsion reaches.
CELLS = int(BOX / CUTOFF)

compiled = numba.njit(fastmath=True, cache=True)


def influence_function():
    """2 pi V0 / (k^2 + kappa^2) as the paper's mesh sees k, with the scale of a density and of the transforms."""
    spacing = BOX / GRID
    sines = 2.0 / spacing * np.sin(np.pi * np.arange(GRID) / GRID)
    squared = sines[:, None] ** 2 + sines[None, : GRID // 2 + 1] ** 2
    influence = 2.0 * np.pi * CAPILLARY_STRENGTH / (squared + CAPILLARY_LENGTH**-2) / BOX**2
    influence[0, 0] = 0.0
    return influence.astype(np.float32)


def wave_numbers():
    """2 pi l / L for every index, zero at Nyquist, so that the field is real."""
    numbers = 2.0 * np.pi * np.fft.fftfreq(GRID, BOX / GRID)
    numbers[GRID // 2] = 0.0
    return numbers.astype(np.float32)


@compiled
def node_and_weights(coordinate):
    """The node to the left of the nearest one, and the weights of three nodes (triangular shaped cloud)."""
    scaled = coordinate * (GRID / BOX)
    nearest = int(scaled + 0.5)
    offset = np.float32(scaled - nearest)
    half = np.float32(0.5)
    left = half * (half - offset) * (half - offset)
    right = half * (half + offset) * (half + offset)
    return nearest + GRID - 1, left, np.float32(1.0) - left - right, right


@compiled
def deposit(x, y, density):
    density[:] = np.float32(0.0)
    for i in range(x.size):
        first_x, x0, x1, x2 = node_and_weights(x[i])
        first_y, y0, y1, y2 = node_and_weights(y[i])
        column0, column1, column2 = first_y % GRID, (first_y + 1) % GRID, (first_y + 2) % GRID
        for offset, weight in ((0, x0), (1, x1), (2, x2)):
            row = (first_x + offset) % GRID
            density[row, column0] += weight * y0
            density[row, column1] += weight * y1
            density[row, column2] += weight * y2


@compiled
def multiply(density, influence, numbers, force, line):
    """The spectrum of F_x + i F_y with F = i k U, attraction; at -k, U is conjugate and k negative.

    The row at -k goes through `line`, so that the first loop is vectorised.
    """
    for l in range(GRID):
        along_x = numbers[l]
        row, values, factors = force[l], density[l], influence[l]
        for m in range(GRID // 2 + 1):
            along_y = numbers[m]
            real, imaginary = factors[m] * values[m].real, factors[m] * values[m].imag
            row[m] = complex(-along_x * imaginary - along_y * real, along_x * real - along_y * imaginary)
            line[m] = complex(along_y * real - along_x * imaginary, -along_x * real - along_y * imaginary)
        opposite = force[GRID - l if l > 0 else 0]
        for m in range(1, GRID // 2):
            opposite[GRID - m] = line[m]


@compiled
def gather(x, y, field, force):
    for i in range(x.size):
        first_x, x0, x1, x2 = node_and_weights(x[i])
        first_y, y0, y1, y2 = node_and_weights(y[i])
        column0, column1, column2 = first_y % GRID, (first_y + 1) % GRID, (first_y + 2) % GRID
        total = np.complex64(0.0)
        for offset, weight in ((0, x0), (1, x1), (2, x2)):
            row = (first_x + offset) % GRID
            total += weight * (y0 * field[row, column0] + y1 * field[row, column1] + y2 * field[row, column2])
        force[0, i] = total.real
        force[1, i] = total.imag


@compiled
def sort_into_cells(x, y, cell_of, ends, sorted_ids):
    """Discs in the order of their cells; cell c holds those from ends[c] to ends[c + 1]."""
    ends[:] = 0
    for i in range(x.size):
        cell = int(x[i] * (CELLS / BOX)) * CELLS + int(y[i] * (CELLS / BOX))
        cell_of[i] = cell
        ends[cell] += 1
    total = 0
    for cell in range(ends.size):
        total += ends[cell]
        ends[cell] = total
    for i in range(x.size):
        ends[cell_of[i]] -= 1
        sorted_ids[ends[cell_of[i]]] = i


@compiled
def repel(x, y, i, j, force):
    separation_x = x[i] - x[j]
    separation_y = y[i] - y[j]
    separation_x -= BOX * (separation_x > 0.5 * BOX) - BOX * (separation_x < -0.5 * BOX)
    separation_y -= BOX * (separation_y > 0.5 * BOX) - BOX * (separation_y < -0.5 * BOX)
    squared = separation_x * separation_x + separation_y * separation_y
    if squared < CUTOFF * CUTOFF:
        inverse = CONTACT * CONTACT / squared
        sixth = inverse * inverse * inverse
        factor = 24.0 * (2.0 * sixth * sixth - sixth) / squared
        force[0, i] += factor * separation_x
        force[1, i] += factor * separation_y
        force[0, j] -= factor * separation_x
        force[1, j] -= factor * separation_y


@compiled
def add_repulsion(x, y, ends, sorted_ids, force):
    """Every pair once: with those after it in its own cell, and with half of the cells around."""
    for slot in range(x.size):
        i = sorted_ids[slot]
        cell_x, cell_y = int(x[i] * (CELLS / BOX)), int(y[i] * (CELLS / BOX))
        above = cell_y + 1 if cell_y + 1 < CELLS else 0
        below = cell_y - 1 if cell_y > 0 else CELLS - 1
        right = cell_x + 1 if cell_x + 1 < CELLS else 0
        for other in range(slot + 1, ends[cell_x * CELLS + cell_y + 1]):
            repel(x, y, i, sorted_ids[other], force)
        for cell in (
            cell_x * CELLS + above,
            right * CELLS + below,
            right * CELLS + cell_y,
            right * CELLS + above,
        ):
            for other in range(ends[cell], ends[cell + 1]):
                repel(x, y, i, sorted_ids[other], force)


@compiled
def into_box(coordinate):
    if coordinate < 0.0:
        coordinate += BOX
    if coordinate >= BOX:
        coordinate -= BOX
    return coordinate


@compiled
def move(x, y, force, kicks):
    """The step rule and Ermak's step; `kicks` are uniform in [0, 1)."""
    largest = 0.0
    for i in range(x.size):
        largest = max(largest, force[0, i] * force[0, i] + force[1, i] * force[1, i])
    step = min(MAX_STEP, MAX_DISPLACEMENT / np.sqrt(largest)) if largest > 0.0 else MAX_STEP
    width = np.sqrt(24.0 * step)
    for i in range(x.size):
        x[i] = into_box(x[i] + force[0, i] * step + width * (kicks[0, i] - 0.5))
        y[i] = into_box(y[i] + force[1, i] * step + width * (kicks[1, i] - 0.5))


@compiled
def find_forces(x, y, field, cell_of, ends, sorted_ids, force):
    gather(x, y, field, force)
    sort_into_cells(x, y, cell_of, ends, sorted_ids)
    add_repulsion(x, y, ends, sorted_ids, force)


@compiled
def find_forces_and_move(x, y, field, cell_of, ends, sorted_ids, force, kicks):
    find_forces(x, y, field, cell_of, ends, sorted_ids, force)
    move(x, y, force, kicks)


class Simulation:
    """Discs, mesh and plans."""

    def __init__(self, positions):
        self.x, self.y = np.ascontiguousarray(positions.T)
        self.density = pyfftw.zeros_aligned((GRID, GRID), np.float32)
        self.spectrum = pyfftw.zeros_aligned((GRID, GRID // 2 + 1), np.complex64)
        self.force_spectrum = pyfftw.zeros_aligned((GRID, GRID), np.complex64)
        self.field = pyfftw.zeros_aligned((GRID, GRID), np.complex64)
        plan = {"axes": (0, 1), "flags": ("FFTW_PATIENT", "FFTW_DESTROY_INPUT"), "threads": 1}
        self.forward = pyfftw.FFTW(self.density, self.spectrum, direction="FFTW_FORWARD", **plan)
        self.back = pyfftw.FFTW(self.force_spectrum, self.field, direction="FFTW_BACKWARD", **plan)
        tables = (influence_function(), wave_numbers())
        line = np.empty(GRID // 2 + 1, np.complex64)
        self.product = (self.spectrum, *tables, self.force_spectrum, line)
        count = self.x.size
        cells = (np.empty(count, np.int32), np.empty(CELLS * CELLS + 1, np.int32), np.empty(count, np.int32))
        self.force = np.empty((2, count))
        self.arguments = (self.x, self.y, self.field, *cells, self.force)
        self.random = np.random.Generator(np.random.SFC64(1))
        self.kicks = np.empty((2, count), np.float32)

    def solve(self):
        deposit(self.x, self.y, self.density)
        self.forward.execute()
        multiply(*self.product)
        self.back.execute()

    def step(self):
        self.solve()
        self.random.random(out=self.kicks, dtype=np.float32)
        find_forces_and_move(*self.arguments, self.kicks)

    def steps(self, count):
        for _ in range(count):
            self.step()

    def forces(self):
        self.solve()
        find_forces(*self.arguments)
        return self.force.T


def version_of_fftw():
    """Of the library that is called, which may have been put before that of pyFFTW's wheel."""
    program = ctypes.CDLL(None)
    return ctypes.c_char_p(ctypes.addressof(ctypes.c_char.in_dll(program, "fftwf_version"))).value.decode()


def main():
    job, path, *out = sys.argv[1:]
    positions = np.loadtxt(path, delimiter=",", skiprows=1, usecols=(1, 2))
    wisdom = pathlib.Path(os.environ["PAPER_SCRIPT_WISDOM"])
    if wisdom.exists():
        pyfftw.import_wisdom((b"", wisdom.read_bytes(), b""))
    simulation = Simulation(positions)
    wisdom.write_bytes(pyfftw.export_wisdom()[1])
    if job == "forces":
        np.savetxt(out[0], simulation.forces(), delimiter=",")
    else:
        simulation.steps(2)
        serve(f"pyFFTW {pyfftw.__version__} with {version_of_fftw()}", simulation.steps)


main()
