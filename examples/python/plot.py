#!/usr/bin/env python3
"""Triangulates random points and draws triangles, hull and spanning tree: plot.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

import flaunay


def main(path: str = "plot.png") -> None:
    random = np.random.default_rng(7)
    points = np.concatenate([random.normal(size=(250, 2)), random.uniform(-3, 3, size=(80, 2))])
    tri = flaunay.Delaunay(points)

    figure, axes = plt.subplots(figsize=(6.5, 6.8), layout="constrained")
    tri.plot(axes, color="#9ecae1", linewidth=0.8, label="Delaunay triangulation")
    gabriel = tri.points[tri.edges[tri.is_gabriel]]
    axes.add_collection(
        LineCollection(list(gabriel), color="#4292c6", linewidth=1, label="Gabriel graph")
    )
    tree = tri.points[tri.spanning_tree]
    axes.add_collection(
        LineCollection(list(tree), color="#d94801", linewidth=1.8, label="minimum spanning tree")
    )
    ring = points[np.append(tri.hull, tri.hull[0])]
    axes.plot(*ring.T, color="#08306b", linewidth=2, label="convex hull")
    axes.plot(*points.T, ".", color="black", markersize=3, label=f"{tri.npoints} points")
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 0), ncol=3, frameon=False)
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
