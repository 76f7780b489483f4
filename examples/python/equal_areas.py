#!/usr/bin/env python3
"""Gives cells of points the same area by weights, which is optimal transport: equal_areas.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from scipy.optimize import minimize

import flaunay

BOX = (-1.0, -1.0, 1.0, 1.0)
Doubles = npt.NDArray[np.float64]


def moments(points: Doubles, cells: flaunay.ClippedVoronoi) -> Doubles:
    """The integrals over the cells of the squared distance from their points."""
    sizes = np.diff(cells.offsets)
    owner = np.repeat(np.arange(len(points)), sizes)
    a = cells.vertices - points[owner]
    following = np.arange(len(a)) + 1
    following[cells.offsets[1:][sizes > 0] - 1] = cells.offsets[:-1][sizes > 0]
    b = a[following]
    areas = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    parts = areas / 6 * ((a * a).sum(axis=1) + (b * b).sum(axis=1) + (a * b).sum(axis=1))
    integrals: Doubles = np.bincount(owner, parts, len(points)).astype(np.float64)
    return integrals


def weights_for(points: Doubles, areas: Doubles) -> Doubles:
    """Weights whose power cells have these areas: the maximum of a concave function (Aurenhammer et al., 1998)."""

    def negative(weights: Doubles) -> tuple[float, Doubles]:
        cells = flaunay.weighted(points, weights).cells(BOX)
        cost = moments(points, cells).sum() - (weights * (cells.areas - areas)).sum()
        return -cost, cells.areas - areas

    found = minimize(
        negative, np.zeros(len(points)), jac=True, method="L-BFGS-B", options={"maxiter": 2000, "gtol": 1e-9}
    )
    weights: Doubles = found.x
    return weights


def draw(axes: Axes, points: Doubles, cells: flaunay.ClippedVoronoi, title: str) -> PolyCollection:
    shown = PolyCollection(
        cells.polygons(), array=cells.areas / cells.areas.mean(), cmap="viridis", edgecolors="white", linewidths=0.6
    )
    shown.set_clim(0, 3)
    axes.add_collection(shown)
    axes.plot(points[:, 0], points[:, 1], ".", color="crimson", markersize=2)
    axes.set(xlim=BOX[::2], ylim=BOX[1::2], aspect="equal", title=title)
    axes.axis("off")
    return shown


def main(path: str = "equal_areas.png") -> None:
    random = np.random.default_rng(3)
    angles, radii = random.uniform(0, 2 * np.pi, 400), random.uniform(0, 1, 400)
    points = np.column_stack([np.cos(angles), np.sin(angles)]) * radii[:, None] ** 1.2 * 0.95
    area = (BOX[2] - BOX[0]) * (BOX[3] - BOX[1])
    tri = flaunay.weighted(points, weights_for(points, np.full(400, area / 400)))
    figure, axes = plt.subplots(1, 2, figsize=(10, 6.1), layout="constrained")
    draw(axes[0], points, flaunay.Voronoi(points).clipped(BOX), "Voronoi cells")
    cells = tri.cells(BOX)
    shown = draw(axes[1], points, cells, "power cells of equal area")
    bar = figure.colorbar(shown, ax=axes, location="bottom", shrink=0.6, aspect=50, pad=0.03, extend="max")
    bar.set_label("area of a cell / mean area; points are red", fontsize=13)
    figure.savefig(path, dpi=110)
    print(f"{len(points)} cells of {cells.areas.min():.6f} to {cells.areas.max():.6f}, {len(tri.hidden)} hidden")


if __name__ == "__main__":
    main(*sys.argv[1:])
