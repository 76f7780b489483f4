#!/usr/bin/env python3
"""Triangulates random points and draws triangles, hull and Voronoi cells: plot.py PICTURE.png"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

import flaunay


def draw_cells(axes: matplotlib.axes.Axes, vor: flaunay.Voronoi) -> None:
    """The ridges between two vertices; those without end would leave the picture."""
    bounded = vor.ridge_vertices[:, 0] >= 0
    ridges = vor.vertices[vor.ridge_vertices[bounded]]
    axes.add_collection(
        LineCollection(list(ridges), colors="tab:green", linewidths=0.6, label="Voronoi cells")
    )


def main(path: str) -> None:
    random = np.random.default_rng(7)
    points = np.concatenate([random.normal(size=(150, 2)), random.uniform(-3, 3, size=(50, 2))])
    tri = flaunay.Delaunay(points)

    figure, axes = plt.subplots(figsize=(7, 7))
    x, y = points.T
    draw_cells(axes, flaunay.Voronoi(points))
    axes.triplot(
        x, y, tri.simplices, color="tab:blue", linewidth=0.7, label="Delaunay triangulation"
    )
    ring = np.append(tri.hull, tri.hull[0])
    axes.plot(x[ring], y[ring], color="tab:red", linewidth=2, label="convex hull")
    axes.plot(x, y, ".", color="black", markersize=4, label="points")
    axes.set_title(f"{tri.npoints} points, {tri.nsimplex} triangles")
    axes.set_aspect("equal")
    (left, bottom), (right, top) = tri.min_bound - 0.3, tri.max_bound + 0.3
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.05), ncol=4)
    figure.savefig(path, dpi=120, bbox_inches="tight")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} PICTURE.png")
    main(sys.argv[1])
