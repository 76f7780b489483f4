#!/usr/bin/env python3
"""Draws a foam in a box that repeats itself, by Lloyd's method: foam.py PICTURE.png"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.collections import PolyCollection

import flaunay

Doubles = npt.NDArray[np.float64]
PERIOD = (3.0, 2.0)


def cells_of(tri: flaunay.PeriodicDelaunay) -> list[Doubles]:
    """The corners of each point's Voronoi cell, around its place, counter-clockwise."""
    first = tri.corners[:, 0]
    (ax, ay), (bx, by) = (tri.corners[:, 1:] - first[:, None]).transpose(1, 2, 0)
    a, b, twice = ax**2 + ay**2, bx**2 + by**2, 2 * (ax * by - ay * bx)
    centres = first + np.stack([by * a - ay * b, ax * b - bx * a], axis=1) / twice[:, None]
    # As each corner of a triangle sees its centre, if it is in its place.
    seen = centres[:, None] - tri.corner_offsets * np.array(tri.period)
    points = tri.simplices.ravel()
    steps = (seen - tri.places[tri.simplices]).reshape(-1, 2)
    order = np.lexsort([np.arctan2(steps[:, 1], steps[:, 0]), points])
    ends = np.searchsorted(points[order], np.arange(1, tri.npoints))
    return np.split(seen.reshape(-1, 2)[order], ends)


def centroid(polygon: Doubles) -> Doubles:
    x, y = (polygon - polygon[0]).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    sums = [((c + np.roll(c, -1)) * cross).sum() for c in (x, y)]
    return np.asarray(polygon[0] + np.array(sums) / (3 * cross.sum()))


def main(path: str) -> None:
    points = np.random.default_rng(5).uniform(0, PERIOD, (500, 2))
    for _ in range(6):
        points = np.array([centroid(cell) for cell in cells_of(flaunay.periodic(points, PERIOD))])
    tri = flaunay.periodic(points, PERIOD)
    cells = cells_of(tri)
    sides = np.array([len(cell) for cell in cells])
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]) * PERIOD
    figure, axes = plt.subplots(figsize=(9, 6))
    axes.add_collection(
        PolyCollection(
            [cell + step for step in steps for cell in cells],
            array=np.tile(sides, len(steps)),
            cmap="RdYlBu",
            clim=(3.5, 8.5),
            edgecolors="dimgrey",
            linewidths=1.2,
        )
    )
    axes.set(xlim=(0, PERIOD[0]), ylim=(0, PERIOD[1]), aspect="equal")
    axes.axis("off")
    figure.subplots_adjust(left=0, right=1, bottom=0, top=1)
    figure.savefig(path, dpi=110)
    print(f"{tri.npoints} cells with {sides.mean():.0f} sides each on average; areas sum to")
    print(round(float(tri.cell_areas.sum()), 9))


if __name__ == "__main__":
    main(sys.argv[1])
