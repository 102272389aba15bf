"""Where the discs are: files of id,x,y (R0) that every contender reads. The same on every machine, from fixed seeds."""

import numba
import numpy as np

# Table I.
TABLE_1_BOX = 500.0
TABLE_1_COUNT = 2500
# Discs on an area of R0^2.
DENSITY = 0.01
# Between neighbours in the collapsed state, and how far a disc is from its lattice site along an axis at most, R0.
SPACING = 2.1
JITTER = 0.04
SMALLEST_DISTANCE = 2.0


@numba.njit(cache=True)
def place(proposals, box):
    """Those of the proposals that are no closer than 2 R0 to one taken before, until the array is through.

    Cells as wide as that distance hold at most four discs.
    """
    side = int(box / SMALLEST_DISTANCE)
    cells = np.full((side, side, 4), -1, np.int64)
    taken = np.empty(len(proposals), np.int64)
    count = 0
    for candidate in range(len(proposals)):
        x, y = proposals[candidate]
        column, row = int(x / box * side) % side, int(y / box * side) % side
        free = True
        for i in range(-1, 2):
            for j in range(-1, 2):
                for other in cells[(column + i) % side, (row + j) % side]:
                    if other >= 0:
                        apart_x = abs(x - proposals[other, 0])
                        apart_y = abs(y - proposals[other, 1])
                        apart_x = min(apart_x, box - apart_x)
                        apart_y = min(apart_y, box - apart_y)
                        if apart_x * apart_x + apart_y * apart_y < SMALLEST_DISTANCE * SMALLEST_DISTANCE:
                            free = False
        if free:
            for slot in range(4):
                if cells[column, row, slot] < 0:
                    cells[column, row, slot] = candidate
                    break
            taken[count] = candidate
            count += 1
    return taken[:count]


def uniform(count, box):
    """Discs at random, none overlapping another."""
    # One in sixteen is refused at this density.
    proposals = np.random.default_rng(1).random((int(count * 1.25) + 100, 2)) * box
    return proposals[place(proposals, box)[:count]]


def collapsed():
    """One dense hexagonal disc of all discs, in the middle of the box, with a little jitter."""
    column, row = np.mgrid[-60:61, -60:61].reshape(2, -1)
    lattice = SPACING * np.stack((column + 0.5 * (row % 2), row * np.sqrt(0.75)), axis=1)
    by_distance = np.argsort((lattice**2).sum(axis=1), kind="stable")
    jitter = np.random.default_rng(2).uniform(-JITTER, JITTER, (TABLE_1_COUNT, 2))
    return TABLE_1_BOX / 2 + lattice[by_distance[:TABLE_1_COUNT]] + jitter


def write(path, positions):
    """Writes them so that every digit that matters is there."""
    rows = (f"{id},{x!r},{y!r}\n" for id, (x, y) in enumerate(positions.tolist()))
    path.write_text("id,x,y\n" + "".join(rows))
    return path


def box_of(count):
    """Side of the box for so many discs, R0."""
    return float(np.sqrt(count / DENSITY))
