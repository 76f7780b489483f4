#!/usr/bin/env python3
"""A map of measured heights with a void: shaded hills and contours: terrain.py [PICTURE.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.cbook
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import LightSource, Normalize

import flaunay

MEASURED = 20_000
INTERVAL = 50
LOW, HIGH = 100, 1050  # of the colours, in metres


def scan() -> npt.NDArray[np.float64]:
    """x, y and z of the hills at Jacksboro, Tennessee, which Matplotlib ships, but for a lake."""
    path = matplotlib.cbook.get_sample_data("jacksboro_fault_dem.npz", asfileobj=False)
    with np.load(path) as data:
        heights = np.asarray(data["elevation"], np.float64)
    rows, columns = heights.shape
    random = np.random.default_rng(3)
    places = random.choice(heights.size, MEASURED, replace=False)
    y, x = np.divmod(places, columns)
    there = np.hypot(x - 290, y - 120) > 22
    points = np.stack([x, rows - y, heights.ravel()[places]], axis=1)
    return np.asarray(points[there], np.float64)


def main(path: str = "terrain.png") -> None:
    dem = flaunay.terrain(scan(), resolution=0.5, max_edge=15)
    xmin, ymin, xmax, ymax = dem.bounds
    known = np.nan_to_num(dem.raster, nan=float(np.nanmin(dem.raster)))
    light = LightSource(azdeg=315, altdeg=40)
    colours = light.shade(
        known, plt.get_cmap("gist_earth"), vert_exag=0.05, vmin=LOW, vmax=HIGH, blend_mode="soft"
    )
    colours[np.isnan(dem.raster)] = 1

    figure, axes = plt.subplots(figsize=(7, 7), layout="constrained")
    axes.imshow(colours, extent=(xmin, xmax, ymin, ymax))
    lines = dem.contours(INTERVAL)
    for thick, width in ((False, 0.3), (True, 0.9)):
        chosen = [line for height, line in lines if (height % (4 * INTERVAL) == 0) == thick]
        axes.add_collection(LineCollection(chosen, colors="#402010", linewidths=width))
    axes.set_axis_off()
    heights = ScalarMappable(Normalize(LOW, HIGH), "gist_earth")
    bar = figure.colorbar(heights, ax=axes, location="bottom", shrink=0.6, aspect=40, pad=0.02)
    bar.set_label(f"height in metres; contours every {INTERVAL}, thick every {4 * INTERVAL}; white: not measured")
    figure.savefig(path, dpi=100)


if __name__ == "__main__":
    main(*sys.argv[1:])
