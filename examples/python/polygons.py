#!/usr/bin/env python3
"""Fills a map with lakes and some letters with triangles, in one call each: polygons.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

import flaunay

Points = npt.NDArray[np.float64]
Rings = list[Points]

BOX = (0.0, 0.0, 16.0, 10.0)


def winding_border(start: Points, end: Points, random: np.random.Generator) -> Points:
    """A border that winds from one point to another: each midpoint is moved aside, five times."""
    path = np.array([start, end])
    for _ in range(5):
        step = np.diff(path, axis=0)
        aside = np.stack([-step[:, 1], step[:, 0]], axis=1)
        middle = (path[:-1] + path[1:]) / 2 + random.uniform(-0.15, 0.15, (len(step), 1)) * aside
        path = np.insert(path, np.arange(1, len(path)), middle, axis=0)
    return path


def lake(random: np.random.Generator) -> Points:
    """A shore with some bays around the origin."""
    angles = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    bays = np.sin(random.integers(2, 5) * angles + random.uniform(0, 6))
    radii = 0.3 + 0.08 * bays + random.uniform(-0.02, 0.02, 40)
    return np.asarray(radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1))


def countries(random: np.random.Generator) -> list[Rings]:
    """Voronoi cells with winding borders, which neighbours share, and a lake in some."""
    seeds = flaunay.relax(random.random((60, 2)) * BOX[2:], BOX, iterations=2)
    borders: dict[tuple[float, ...], Points] = {}
    found: list[Rings] = []
    for seed, cell in zip(seeds, flaunay.voronoi_polygons(seeds, BOX)):
        corners = np.asarray(cell)
        if np.isin(corners, BOX).any():
            continue  # sea
        ring = []
        for start, end in zip(corners, np.roll(corners, -1, axis=0)):
            backwards = tuple(start) > tuple(end)
            a, b = (end, start) if backwards else (start, end)
            border = borders.setdefault((*a, *b), winding_border(a, b, random))
            ring.append(border[:0:-1] if backwards else border[:-1])
        lakes = [seed + lake(random)] if random.random() < 0.4 else []
        found.append([np.concatenate(ring), *lakes])
    return found


def letters(text: str) -> list[Rings]:
    """The outlines of letters, each of which has a ring for each of its curves."""
    font = FontProperties(family="serif", weight="bold")
    found: list[Rings] = []
    x = 0.0
    for letter in text:
        outline = TextPath((x, 0), letter, size=10, prop=font)
        found.append([np.asarray(ring) for ring in outline.to_polygons()])
        x = outline.get_extents().x1 + 0.5
    return found


def draw(axes: Axes, mesh: flaunay.PolygonTriangulation, colours: str, title: str) -> None:
    """Triangles, in the colour of their polygon."""
    axes.tripcolor(
        mesh.to_matplotlib(), mesh.polygon_of * 7 % 10, cmap=colours, vmin=-3, vmax=12, zorder=0
    )
    mesh.plot(axes, color="white", linewidth=0.35, constraint_color="#222", constraint_linewidth=1)
    axes.set_aspect("equal")
    axes.margins(0.01)
    axes.set_axis_off()
    axes.set_title(f"{title}: {len(mesh.triangles):,} triangles", fontsize=11)


def main(path: str = "polygons.png") -> None:
    figure, (above, below) = plt.subplots(
        2, figsize=(6.5, 6), layout="constrained", height_ratios=[10, 3.6]
    )
    world = flaunay.polygons(countries(np.random.default_rng(8)), map=True)
    draw(above, world, "summer", "one map of countries with common borders, and lakes")
    draw(below, flaunay.polygons(letters("flaunay&8"), fill_rule="winding"), "autumn", "letters")
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
