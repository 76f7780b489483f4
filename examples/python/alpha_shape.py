#!/usr/bin/env python3
"""Finds the outline of scattered points with alpha shapes of three radii: alpha_shape.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import TextPath

import flaunay


def points_in_text(text: str, spacing: float) -> npt.NDArray[np.float64]:
    """Points of a jittered grid that lie in the letters."""
    outline = TextPath((0, 0), text, size=100, prop=FontProperties(family="serif", weight="bold"))
    low, high = outline.get_extents().get_points()
    grid = np.stack(np.meshgrid(*(np.arange(a, b, spacing) for a, b in zip(low, high))), axis=-1)
    points = grid.reshape(-1, 2)
    points = points + np.random.default_rng(3).uniform(-0.35, 0.35, points.shape) * spacing
    # Letters are polygons and their holes: a point is inside if it is in an odd number of them.
    polygons = [Path(polygon) for polygon in outline.to_polygons()]
    times_inside = np.sum([polygon.contains_points(points) for polygon in polygons], axis=0)
    return np.asarray(points[times_inside % 2 == 1])


def main(path: str = "alpha_shape.png") -> None:
    tri = flaunay.Delaunay(points_in_text("a&g", spacing=2.2))

    figure, panels = plt.subplots(3, figsize=(6.5, 8.4), layout="constrained")
    for axes, alpha in zip(panels, (np.inf, 3.2, 1.4)):
        shape = flaunay.alpha_shape(tri, alpha)
        axes.plot(*tri.points.T, ".", color="#d94801", markersize=1.5)
        shape.plot(axes, facecolor="#9ecae1", edgecolor="#2171b5", alpha=0.8, linewidth=0.9)
        parts = len(shape.polygons())
        holes = len(shape.rings()) - parts
        axes.set_title(f"radius {alpha:g}: parts {parts}, holes {holes}", fontsize=11)
        axes.set_aspect("equal")
        axes.set_axis_off()
    figure.suptitle("alpha shapes (blue) of points (orange)")
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
