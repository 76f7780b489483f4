#!/usr/bin/env python3
"""Draws a foam in a box that repeats itself, by Lloyd's method: foam.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import flaunay

PERIOD = (3.0, 2.0)


def main(path: str = "foam.png") -> None:
    points = np.random.default_rng(5).uniform(0, PERIOD, (500, 2))
    for _ in range(6):
        points = flaunay.periodic(points, PERIOD).cells.centroids
    tri = flaunay.periodic(points, PERIOD)
    cells = tri.cells.polygons()
    sides = np.array([len(cell) for cell in cells])
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]) * PERIOD
    figure, axes = plt.subplots(figsize=(9, 6.9), layout="constrained")
    foam = PolyCollection(
        [cell + step for step in steps for cell in cells],
        array=np.tile(sides, len(steps)),
        cmap=plt.get_cmap("RdYlBu", 5),
        clim=(3.5, 8.5),
        edgecolors="dimgrey",
        linewidths=1.2,
    )
    axes.add_collection(foam)
    axes.set(xlim=(0, PERIOD[0]), ylim=(0, PERIOD[1]), aspect="equal")
    axes.axis("off")
    bar = figure.colorbar(foam, location="bottom", ticks=range(4, 9), shrink=0.4, aspect=20, pad=0.02)
    bar.set_label("sides of a cell", fontsize=13)
    figure.savefig(path, dpi=110)
    print(f"{tri.npoints} cells with {sides.mean():.0f} sides each on average; areas sum to")
    print(round(float(tri.cells.areas.sum()), 9))


if __name__ == "__main__":
    main(*sys.argv[1:])
