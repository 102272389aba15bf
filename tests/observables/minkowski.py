"""Minkowski functionals of a trajectory against scikit-image and contourpy.

In: a run of compare.py, and what keeps count of comparisons. The density is made anew, from SciPy's quadratic
B-splines. Neither program knows of periodic boxes, so that each measures 1, 2 and 3 boxes beside each other: what
grows with the square of their number belongs to the inside.
"""

import math

import contourpy
import numpy
import skimage.measure
from scipy.interpolate import BSpline

UNITS = 2.0**32
# Of the density's grid, R0: what output.minkowski_spacing is if nothing is said.
SPACING = 5.3
CLOSE_PACKING = 1 / (2 * math.sqrt(3))
# Areas and lengths are rounded in another order, and so is the density, which moves a contour by the more the flatter it is.
CONTOUR = 1e-10
# Pixels are counted.
PIXEL = 1e-12

CLOUD = BSpline.basis_element([-1.5, -0.5, 0.5, 1.5], extrapolate=False)


def density(bits, side, grid):
    """Number density on grid times grid nodes, the one of index 0 at the origin."""
    places = bits.astype(float) * (grid / UNITS)
    distance = places[:, :, None] - numpy.arange(grid)
    distance -= grid * numpy.rint(distance / grid)
    along_x, along_y = numpy.moveaxis(numpy.nan_to_num(CLOUD(distance)), 1, 0)
    return along_x.T @ along_y / (side / grid) ** 2


def of_one_box(measure):
    """The coefficient of boxes², of what `measure` finds in a square of 1, 2 and 3 boxes along a side."""
    one, two, three = (numpy.array(measure(boxes), dtype=float) for boxes in (1, 2, 3))
    return (three - 2 * two + one) / 2


def pixels_by_scikit_image(values, threshold):
    """Area, length and Euler number, in pixels."""

    def measure(boxes):
        image = numpy.tile(values > threshold, (boxes, boxes))
        # Crofton's formula with the two directions of the grid counts its sides times pi/4.
        sides = skimage.measure.perimeter_crofton(image, directions=2) * 4 / math.pi
        return image.sum(), sides, skimage.measure.euler_number(image, connectivity=2)

    return of_one_box(measure)


def length_of(line):
    return float(numpy.hypot(*numpy.diff(line, axis=0).T).sum())


def area_of(points):
    x, y = (points - points[0]).T
    return float(numpy.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2


def contours_by_contourpy(values, threshold):
    """Area, length and Euler number, in units of the spacing; saddles are decided by the mean of their corners."""

    def measure(boxes):
        field = numpy.pad(numpy.tile(values, (boxes, boxes)), ((0, 1), (0, 1)), mode="wrap")
        generator = contourpy.contour_generator(
            z=field, name="serial", line_type="Separate", fill_type="OuterOffset", corner_mask=False
        )
        polygons, offsets = generator.filled(threshold, float(field.max()) + 1)
        rings = [ring for points, ends in zip(polygons, offsets) for ring in numpy.split(points, ends[1:-1])]
        holes = sum(len(ends) - 2 for ends in offsets)
        length = sum(length_of(line) for line in generator.lines(threshold))
        return sum(map(area_of, rings)), length, len(polygons) - holes

    return of_one_box(measure)


def saddles(values, threshold):
    inside = values > threshold
    right, above = numpy.roll(inside, -1, 0), numpy.roll(inside, -1, 1)
    return int(((inside == numpy.roll(right, -1, 1)) & (right == above) & (inside != right)).sum())


def contours_by_scikit_image(values, threshold):
    """Length, in units of the spacing, where there are no saddles; it decides them in another way."""
    field = numpy.pad(values, ((0, 1), (0, 1)), mode="wrap")
    return sum(length_of(line) for line in skimage.measure.find_contours(field, threshold))


def levels(run):
    """For each row of `minkowski.csv` what it is, the row, the density, the threshold, and the units of M0, M1 and M2."""
    for frame, rows in enumerate(run.rows("minkowski")):
        grid = max(3, round(run.side / SPACING))
        cell = run.side / grid
        values = density(run.bits[frame], run.side, grid)
        for row in rows:
            what = f"step {row['step']}, threshold {row['threshold']}"
            yield what, row, values, float(row["threshold"]) * CLOSE_PACKING, (cell**2, cell, 1)


def functionals(check, what, row, kind, expected, tolerance):
    """Compares area, length, Euler number and shape factor in the columns of a kind."""
    area, length, euler = expected
    for column, value in (("area", area), ("length", length)):
        check.same(f"{what}, {kind}{column}", float(row[kind + column]), value, tolerance, scale=1 + value)
    check.same(f"{what}, {kind}euler", float(row[kind + "euler"]), euler, 0)
    if area == 0 or euler == 0:
        check.same(f"{what}, {kind}shape", row[kind + "shape"], "", 0)
    else:
        shape = length**2 / (4 * math.pi * area * euler)
        check.same(f"{what}, {kind}shape", float(row[kind + "shape"]), shape, tolerance, scale=1 + abs(shape))


def pixels_scikit_image(run, check):
    for what, row, values, threshold, units in levels(run):
        functionals(check, what, row, "pixel_", pixels_by_scikit_image(values, threshold) * units, PIXEL)


def contours_contourpy(run, check):
    for what, row, values, threshold, units in levels(run):
        functionals(check, what, row, "", contours_by_contourpy(values, threshold) * units, CONTOUR)


def contours_scikit_image(run, check):
    for what, row, values, threshold, (_, cell, _) in levels(run):
        if saddles(values, threshold) == 0:
            length = contours_by_scikit_image(values, threshold) * cell
            check.same(f"{what}, length", float(row["length"]), length, CONTOUR, scale=1 + length)
