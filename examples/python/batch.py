#!/usr/bin/env python3
"""Triangulates 64 sets of points in one call and draws them all at once: batch.py [PICTURE.png]

The sets are spirals as plants grow them, a seed after the other, each turned by an angle that differs from set to set.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import flaunay

ROWS, COLUMNS, SEEDS = 8, 8, 220


def main(path: str = "batch.png") -> None:
    # One row of the array for each set, all with the same number of points.
    golden_angle = np.pi * (3 - 5**0.5)
    turn = golden_angle * np.linspace(0.98, 1.02, ROWS * COLUMNS)[:, None]
    seed = np.arange(SEEDS)
    radius = np.sqrt((seed + 0.5) / SEEDS)
    sets = radius[:, None] * np.stack([np.cos(turn * seed), np.sin(turn * seed)], axis=-1)

    points = sets.reshape(-1, 2)
    offsets = np.arange(0, len(points) + 1, SEEDS)
    mesh = flaunay.triangulate(points, offsets=offsets)

    # Triangles have indices over all sets, so moving the points moves them.
    row, column = np.divmod(np.arange(ROWS * COLUMNS), COLUMNS)
    places = 2.15 * np.stack([column, -row], axis=1)
    triangles = (sets + places[:, None]).reshape(-1, 2)[mesh.triangles]
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    slimness = sides.max(axis=1) / sides.min(axis=1)

    figure, axes = plt.subplots(figsize=(7, 7.2), layout="constrained")
    drawn = axes.add_collection(
        PolyCollection(
            triangles,
            array=slimness,
            cmap="viridis_r",
            clim=(1, 3.5),
            edgecolor="white",
            linewidth=0.25,
        )
    )
    figure.colorbar(drawn, label="longest side / shortest side", shrink=0.5, extend="max")
    axes.margins(0.01)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(f"{ROWS * COLUMNS} sets in one call: {len(mesh.triangles):,} triangles")
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    main(*sys.argv[1:])
