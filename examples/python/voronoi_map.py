#!/usr/bin/env python3
"""A map of Voronoi cells, clipped to a box and coloured by their areas: voronoi_map.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm

import flaunay

Doubles = npt.NDArray[np.float64]

WIDTH, HEIGHT = 3.0, 2.0
TOWNS = 9
HOUSES = 2500


def houses() -> Doubles:
    """Towns of different sizes, roads between them, and farms."""
    random = np.random.default_rng(11)
    towns = random.uniform((0.25, 0.25), (WIDTH - 0.25, HEIGHT - 0.25), (TOWNS, 2))
    sizes = random.dirichlet(np.full(TOWNS, 1.5))
    town = random.choice(TOWNS, HOUSES, p=sizes)
    distance = 0.5 * np.sqrt(sizes[town]) * random.gamma(1.4, 0.5, HOUSES)
    angle = random.uniform(0, 2 * np.pi, HOUSES)
    in_towns = towns[town] + (distance * np.stack([np.cos(angle), np.sin(angle)])).T
    graph = flaunay.Delaunay(towns)
    roads = towns[graph.edges[random.choice(len(graph.edges), HOUSES // 6)]]
    along = random.random((HOUSES // 6, 1))
    beside = along * roads[:, 0] + (1 - along) * roads[:, 1]
    beside += random.normal(0, 0.012, beside.shape)
    farms = random.uniform((0, 0), (WIDTH, HEIGHT), (HOUSES // 5, 2))
    points = np.concatenate([in_towns, beside, farms])
    inside = ((points > 0) & (points < (WIDTH, HEIGHT))).all(axis=1)
    return np.asarray(points[inside])


def main(path: str = "voronoi_map.png") -> None:
    points = houses()
    cells = flaunay.Voronoi(points).clipped((0, 0, WIDTH, HEIGHT))

    figure, axes = plt.subplots(figsize=(7.5, 5.7), layout="constrained")
    map_of_cells = PolyCollection(
        cells.polygons(),
        array=cells.areas,
        norm=LogNorm(5e-5, 3e-2),
        cmap="YlGnBu_r",
        edgecolor="white",
        linewidth=0.3,
    )
    axes.add_collection(map_of_cells)
    axes.plot(*points.T, ".", color="black", markersize=0.6)
    axes.set(xlim=(0, WIDTH), ylim=(0, HEIGHT), aspect="equal")
    axes.set_axis_off()
    bar = figure.colorbar(map_of_cells, location="bottom", shrink=0.6, aspect=40, pad=0.02)
    bar.set_label(f"area of each of {len(points):,} cells")
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
