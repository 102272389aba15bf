"""What the machine can do at most, and what the mesh solve asks of it."""

import math
import pathlib

# The SIMD level of the arithmetic behind each mesh solver.
LEVEL_OF_SOLVER = {"avx512": "avx512", "avx2": "avx2", "sse2": "sse2", "portable": "sse2"}
L2_KILOBYTES = 512
L3_KILOBYTES = 8192
MEMORY_KILOBYTES = 262144


def arithmetic(grid):
    """Sums and products of one mesh solve on `grid` nodes a side.

    A radix-2 transform of M points has M/2 log2 M butterflies of 4 sums, and M/2 (log2 M - 2) + 1 products of complex
    numbers, of 4 products and 2 sums: the first of each group needs none. There are 3 M + 1 transforms: M/2 of pairs of
    columns, M/2 + 1 of rows, M of rows and M of columns on the way back. A mode costs 6 products and 4 sums, parting the
    spectra of a pair of columns 4 sums for two of them.
    """
    stages = int(math.log2(grid))
    lines = 3 * grid + 1
    complex_products = grid * (stages - 2) // 2 + 1
    modes = (grid // 2 + 1) * grid
    sums = lines * (2 * grid * stages + 2 * complex_products) + 6 * modes
    products = lines * 4 * complex_products + 6 * modes
    return sums, products


def traffic(grid):
    """Bytes that one mesh solve has to read and write in its three passes, each over all of the field, and the bytes it works on.

    Columns: read the nodes, write half a field; rows: read that and the influence table, write a field; columns back: read
    and write a field.
    """
    nodes, field, table = 4 * grid**2, 8 * grid**2, grid**2
    return nodes + field // 2 + field // 2 + table + field + 2 * field, nodes + field + table


def cache_bytes(level):
    """Size of this CPU's cache of that level, as Linux says."""
    for index in pathlib.Path("/sys/devices/system/cpu/cpu0/cache").glob("index*"):
        if (index / "level").read_text().strip() == str(level) and (index / "type").read_text().strip() != "Instruction":
            return int((index / "size").read_text().strip().removesuffix("K")) * 1024
    return 0


def memory_kind(bytes_worked_on):
    """Which of the measured memory rates such a working set sees."""
    if bytes_worked_on <= cache_bytes(2):
        return "L2"
    return "L3" if bytes_worked_on <= cache_bytes(3) else "memory"
