"""Minkowski functionals of a trajectory against scikit-image and contourpy.

In: an archive of NumPy's and the table `minkowski.csv` of the same run. The density is made anew, from SciPy's quadratic
B-splines. Neither program knows of periodic boxes, so that each measures 1, 2 and 3 boxes beside each other: what
grows with the square of their number belongs to the inside.
"""

import csv
import math
from collections import Counter

import contourpy
import numpy
import skimage.measure
from scipy.interpolate import BSpline

UNITS = 2.0**32
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


def compare(archive_path, table_path, spacing):
    """Compares every row of the table; the number of comparisons with each program and the largest difference.

    Raises AssertionError where they differ.
    """
    with numpy.load(archive_path) as archive:
        side, steps, positions = float(archive["box"]), list(archive["step"]), archive["position_bits"]
    grid = max(3, round(side / spacing))
    cell = side / grid
    compared, largest = Counter(), 0.0

    def same(program, row, column, found, tolerance):
        nonlocal largest
        expected = float(row[column])
        difference = abs(found - expected) / (1 + abs(expected))
        where = f"step {row['step']}, threshold {row['threshold']}"
        assert difference <= tolerance, f"{where}: {column} {expected}, by {program} {found}"
        compared[program] += 1
        largest = max(largest, difference)

    def shape(row, kind, area, length, euler):
        column = kind + "shape"
        if round(euler) == 0 or area == 0:
            assert row[column] == "", f"step {row['step']}: {column} {row[column]} of a domain that has none"
        else:
            same("formula", row, column, length**2 / (4 * math.pi * area * euler), CONTOUR)

    with open(table_path, newline="") as table:
        rows = [row for row in csv.DictReader(table) if int(row["step"]) in steps]
    assert rows, f"{table_path}: no row of a frame"
    units = (cell**2, cell, 1)
    for row in rows:
        values = density(positions[steps.index(int(row["step"]))], side, grid)
        threshold = float(row["threshold"]) * CLOSE_PACKING
        area, length, euler = pixels_by_scikit_image(values, threshold) * units
        same("scikit-image", row, "pixel_area", area, PIXEL)
        same("scikit-image", row, "pixel_length", length, PIXEL)
        same("scikit-image", row, "pixel_euler", euler, 0)
        shape(row, "pixel_", area, length, euler)
        area, length, euler = contours_by_contourpy(values, threshold) * units
        same("contourpy", row, "area", area, CONTOUR)
        same("contourpy", row, "length", length, CONTOUR)
        same("contourpy", row, "euler", euler, 0)
        shape(row, "", area, length, euler)
        if saddles(values, threshold) == 0:
            same("scikit-image", row, "length", contours_by_scikit_image(values, threshold) * cell, CONTOUR)
    return compared, largest
