#!/usr/bin/env python3
"""Draws a million points as a map of their density: million_points.py [PICTURE.png]

A dot for each would only show where there are any. Here the density at each point is one over the area of the
triangles around it, and each pixel interpolates it: sharp where there are many points, smooth where there are few.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.colors import LogNorm

import flaunay

POINTS = 1_000_000
PIXELS = 900


def spiral_galaxy(n: int) -> npt.NDArray[np.float64]:
    """Stars of a disc, two spiral arms and a bulge."""
    random = np.random.default_rng(12)
    kind = random.choice(4, n, p=[0.25, 0.33, 0.27, 0.15])
    radius = np.where(kind == 3, random.exponential(0.12, n), random.gamma(2.2, 0.33, n))
    # Along an arm, the angle grows with the logarithm of the radius.
    angle = 3.2 * np.log(radius + 0.08) + np.pi * kind + random.normal(0, 0.26, n)
    angle = np.where((kind == 0) | (kind == 3), random.uniform(0, 2 * np.pi, n), angle)
    stars = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.asarray(stars + random.normal(0, 0.02, stars.shape))


def density(tri: flaunay.Delaunay) -> npt.NDArray[np.float64]:
    """Points per area at each point: three over the area of all triangles that have it."""
    a, b, c = (tri.points[tri.simplices[:, k]] for k in range(3))
    u, v = b - a, c - a
    areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    around = np.bincount(tri.simplices.ravel(), np.repeat(areas, 3), minlength=tri.npoints)
    return np.asarray(3 / around)


def main(path: str = "million_points.png") -> None:
    tri = flaunay.Delaunay(spiral_galaxy(POINTS))
    side = np.linspace(-2.1, 2.1, PIXELS)
    pixels = np.stack(np.meshgrid(side, side), axis=-1)
    picture = tri.interpolate(density(tri), pixels)

    figure, axes = plt.subplots(figsize=(7, 7))
    image = axes.imshow(
        picture, origin="lower", cmap="magma", norm=LogNorm(2e3, 3e6), extent=(-2.1, 2.1, -2.1, 2.1)
    )
    axes.set_title(f"{tri.npoints:,} points, {tri.nsimplex:,} triangles", color="white", y=0.94)
    axes.set_axis_off()
    axes.set_position((0, 0, 1, 1))
    scale = axes.inset_axes((0.3, 0.07, 0.4, 0.015))
    bar = figure.colorbar(image, cax=scale, orientation="horizontal")
    bar.set_label("points per unit of area", color="white")
    scale.tick_params(colors="white")
    figure.savefig(path, dpi=70)


if __name__ == "__main__":
    main(*sys.argv[1:])
