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

import flaunay

AIRPORTS = Path(__file__).resolve().parents[2] / "tests" / "data" / "airports.txt"
EARTH_RADIUS = 6371.0  # kilometres


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


def draw(axes: Axes, tri: flaunay.SphericalDelaunay, longitude: float, latitude: float) -> None:
    """One half of the globe."""
    view = seen_from(longitude, latitude)
    vertices, points = tri.voronoi.vertices @ view.T, tri.xyz @ view.T
    radii = np.sqrt(tri.voronoi.areas / np.pi) * EARTH_RADIUS
    cells, colours = [], []
    for region, radius in zip(tri.voronoi.regions, radii):
        corners = vertices[region]
        if len(corners) and (corners[:, 2] > 0).any():
            # What is behind the rim is moved to it.
            flat = corners[:, :2].copy()
            behind = corners[:, 2] < 0
            flat[behind] /= np.linalg.norm(flat[behind], axis=1)[:, None]
            cells.append(flat)
            colours.append(np.log10(radius))
    axes.add_patch(plt.Circle((0, 0), 1, color="midnightblue"))
    axes.add_collection(
        PolyCollection(cells, array=np.array(colours), cmap="viridis_r", edgecolors="white", linewidths=0.3)
    )
    front = points[points[:, 2] > 0]
    axes.plot(front[:, 0], front[:, 1], ".", color="crimson", markersize=1.2)
    axes.set(xlim=(-1.02, 1.02), ylim=(-1.02, 1.02), aspect="equal")
    axes.axis("off")


def main(path: str = "globe.png") -> None:
    tri = flaunay.spherical(np.loadtxt(AIRPORTS))
    figure, axes = plt.subplots(1, 2, figsize=(10, 5))
    draw(axes[0], tri, 10, 30)
    draw(axes[1], tri, -140, -20)
    figure.subplots_adjust(left=0, right=1, bottom=0, top=1, wspace=0)
    figure.savefig(path, dpi=110)
    areas = tri.voronoi.areas * EARTH_RADIUS**2
    largest = int(areas.argmax())
    print(f"{tri.npoints} airports; the largest cell, of {areas[largest]:.3g} square kilometres, at")
    print(*tri.points[largest])


if __name__ == "__main__":
    main(*sys.argv[1:])
