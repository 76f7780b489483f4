#!/usr/bin/env python3
"""Draws a photograph with dots of one size, by weighted Voronoi stippling (Secord 2002): stippling.py [PICTURE.png]

Lloyd's method with a weight for each pixel: every dot moves to the centre of mass of the pixels that are nearest to it.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.cbook
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt

import flaunay

DOTS = 16_000
ROUNDS = 20


def photograph() -> npt.NDArray[np.float64]:
    """Grace Hopper, as Matplotlib ships her, as darkness from 0 to 1."""
    path = matplotlib.cbook.get_sample_data("grace_hopper.jpg", asfileobj=False)
    brightness = plt.imread(str(path)) / 255 @ [0.299, 0.587, 0.114]
    # Each pixel as four, so that the smallest cells have enough of them.
    darkness: npt.NDArray[np.float64] = 1 - brightness[:470, 60:470]
    return darkness.repeat(2, axis=0).repeat(2, axis=1)


def stipple(
    weights: npt.NDArray[np.float64], random: np.random.Generator
) -> npt.NDArray[np.float64]:
    """Places for dots, as many per area as the pixels weigh."""
    height, width = weights.shape
    column, row = np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5)
    pixels = np.stack([column, row], axis=-1).reshape(-1, 2)
    mass = weights.ravel()
    dots: npt.NDArray[np.float64] = pixels[random.choice(len(pixels), DOTS, p=mass / mass.sum())]
    dots = dots + random.uniform(-0.5, 0.5, dots.shape)
    return flaunay.relax(dots, (0, 0, width, height), ROUNDS, density=weights)


def main(path: str = "stippling.png") -> None:
    weights = 0.01 + np.minimum(photograph(), 0.85) ** 3
    height, width = weights.shape
    dots = stipple(weights, np.random.default_rng(5))

    figure, axes = plt.subplots(figsize=(6, 6 * height / width))
    axes.plot(*dots.T, ".", color="black", markersize=3.2, markeredgewidth=0)
    axes.set(xlim=(0, width), ylim=(0, height), position=[0, 0, 1, 1])
    axes.set_axis_off()
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
