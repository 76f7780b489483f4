#!/usr/bin/env python3
"""Terrain from scattered heights: linear, Clough-Tocher, natural neighbours: interpolation.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.cbook
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LightSource, Normalize

import flaunay

HEIGHTS = 4000
LOW, HIGH = 100, 1050  # of the colours, in metres
INTERPOLATORS = {
    "linear": flaunay.LinearInterpolator,
    "Clough-Tocher": flaunay.CloughTocherInterpolator,
    "natural neighbours": flaunay.NaturalNeighborInterpolator,
}


def terrain() -> npt.NDArray[np.float64]:
    """The hills at Jacksboro, Tennessee, which Matplotlib ships: metres on a grid."""
    path = matplotlib.cbook.get_sample_data("jacksboro_fault_dem.npz", asfileobj=False)
    with np.load(path) as data:
        return np.asarray(data["elevation"], np.float64)


def shaded(heights: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Colours by height, with light from the north-west."""
    light = LightSource(azdeg=315, altdeg=40)
    known = np.nan_to_num(heights, nan=float(np.nanmin(heights)))
    colours: npt.NDArray[np.float64] = light.shade(
        known, plt.get_cmap("gist_earth"), vert_exag=0.05, vmin=LOW, vmax=HIGH, blend_mode="soft"
    )
    colours[np.isnan(heights)] = 1
    return colours


def main(path: str = "interpolation.png") -> None:
    truth = terrain()
    height, width = truth.shape
    random = np.random.default_rng(2)
    # Distinct places of the grid, of which the heights are known.
    places = random.choice(truth.size, HEIGHTS, replace=False)
    points = np.stack(np.divmod(places, width), axis=1).astype(np.float64)
    values = truth.ravel()[places]
    grid = np.moveaxis(np.mgrid[:height, :width], 0, -1)

    figure, panels = plt.subplots(2, 2, figsize=(7, 7.2), layout="constrained")
    first, *others = panels.flat
    first.imshow(shaded(truth))
    first.plot(points[:, 1], points[:, 0], ".", color="black", markersize=0.8)
    first.set_title(f"terrain, {HEIGHTS:,} measured places")
    for axes, (name, interpolator) in zip(others, INTERPOLATORS.items()):
        surface = interpolator(points, values)(grid)
        error = np.sqrt(np.nanmean((surface - truth) ** 2))
        axes.imshow(shaded(surface))
        axes.set_title(f"{name}: RMS error {error:.1f} m")
    for axes in panels.flat:
        axes.set_axis_off()
    heights = ScalarMappable(Normalize(LOW, HIGH), "gist_earth")
    figure.colorbar(heights, ax=panels, location="bottom", shrink=0.6, aspect=40, label="height in metres")
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
