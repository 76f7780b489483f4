#!/usr/bin/env python3
"""Draws the globe's airports, each with the land and sea that is nearest to it: globe.py [PICTURE.png]"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm

import flaunay

DATA = Path(__file__).resolve().parents[2] / "tests" / "data"
EARTH_RADIUS = 6371.0  # kilometres


def directions(places: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Points of the unit sphere at these degrees of longitude and latitude."""
    a, b = np.radians(places.T)
    return np.column_stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)])


def seen_from(longitude: float, latitude: float) -> npt.NDArray[np.float64]:
    """A rotation: to the right, up, and towards who looks at that place."""
    a, b = np.radians([longitude, latitude])
    return np.array(
        [
            [-np.sin(a), np.cos(a), 0],
            [-np.cos(a) * np.sin(b), -np.sin(a) * np.sin(b), np.cos(b)],
            [np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)],
        ]
    )


def draw(
    axes: Axes,
    tri: flaunay.SphericalDelaunay,
    coasts: npt.NDArray[np.float64],
    view: npt.NDArray[np.float64],
) -> PolyCollection:
    """One half of the globe: the cells that it shows."""
    vertices, points, coasts = tri.voronoi.vertices @ view.T, tri.xyz @ view.T, coasts @ view.T
    cells, areas = [], []
    for region, area in zip(tri.voronoi.regions, tri.voronoi.areas * EARTH_RADIUS**2):
        corners = vertices[region]
        if len(corners) and (corners[:, 2] > 0).any():
            # What is behind the rim is moved to it.
            flat = corners[:, :2].copy()
            behind = corners[:, 2] < 0
            flat[behind] /= np.linalg.norm(flat[behind], axis=1)[:, None]
            cells.append(flat)
            areas.append(area)
    shown = PolyCollection(
        cells, array=np.array(areas), norm=LogNorm(1e3, 1e7), cmap="YlGnBu", edgecolors="white", linewidths=0.4
    )
    axes.add_collection(shown)
    coasts = np.where(coasts[:, 2:] > 0, coasts, np.nan)
    axes.plot(coasts[:, 0], coasts[:, 1], color="black", linewidth=0.9)
    front = points[points[:, 2] > 0]
    axes.plot(front[:, 0], front[:, 1], ".", color="crimson", markersize=1.4)
    axes.add_patch(plt.Circle((0, 0), 1, fill=False, color="dimgrey"))
    axes.set(xlim=(-1.02, 1.02), ylim=(-1.02, 1.02), aspect="equal")
    axes.axis("off")
    return shown


def main(path: str = "globe.png") -> None:
    tri = flaunay.spherical(np.loadtxt(DATA / "airports.txt"))
    coasts = directions(np.loadtxt(DATA / "coastlines.txt"))
    figure, axes = plt.subplots(1, 2, figsize=(10, 5.7), layout="constrained")
    draw(axes[0], tri, coasts, seen_from(10, 30))
    shown = draw(axes[1], tri, coasts, seen_from(-140, -20))
    bar = figure.colorbar(shown, ax=axes, location="bottom", shrink=0.6, aspect=50, extend="both")
    bar.set_label("square kilometres of land and sea that are nearest to an airport (red)", fontsize=13)
    figure.savefig(path, dpi=110)
    areas = tri.voronoi.areas * EARTH_RADIUS**2
    largest = int(areas.argmax())
    print(f"{tri.npoints} airports; the largest cell, of {areas[largest]:.3g} square kilometres, at")
    print(*tri.points[largest])


if __name__ == "__main__":
    main(*sys.argv[1:])
