#!/usr/bin/env python3
"""Birds that fly as their neighbours do, in a triangulation that follows them: flock.py [PICTURE.png]

Each bird takes the mean direction of the birds that it has an edge to, and some noise. In a step, all birds move by a
twentieth of their distance. That changes so many triangles that all points are triangulated anew, in about the time of
a new triangulation. If few birds move, the triangulation is mended around them, which is faster: the last line tells.
"""

import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import flaunay

BIRDS = 3000
STEPS = 60
FEW = 30


def main(path: str = "flock.png") -> None:
    random = np.random.default_rng(4)
    points = random.random((BIRDS, 2))
    headings = np.exp(2j * np.pi * random.random(BIRDS))
    everyone = np.arange(BIRDS)
    tri = flaunay.Delaunay(points, incremental=True)
    moving, new, changed, anew = 0.0, 0.0, 0, 0
    for _ in range(STEPS):
        starts, neighbors = tri.vertex_neighbor_vertices
        # With itself, so that no sum is empty.
        sums = headings + np.add.reduceat(headings[neighbors], starts[:-1])
        headings = sums / abs(sums) * np.exp(0.3j * random.normal(size=BIRDS))
        points = points + 0.001 * np.stack([headings.real, headings.imag], axis=1)
        # At the sides of the square they turn.
        for k, turned in ((0, -headings.conj()), (1, headings.conj())):
            headings = np.where((points[:, k] < 0) | (points[:, k] > 1), turned, headings)
        points = np.clip(points, 0, 1)
        started = time.perf_counter()
        changes = tri.move_points(everyone, points)
        moved = time.perf_counter()
        flaunay.Delaunay(points)
        moving, new = moving + moved - started, new + time.perf_counter() - moved
        anew += changes.is_anew
    print(
        f"{BIRDS:,} birds, {STEPS} steps: {1e3 * moving / STEPS:.1f} ms for a move, "
        f"{1e3 * new / STEPS:.1f} ms for a new triangulation; {anew} steps were triangulated anew"
    )
    moving = 0.0
    for _ in range(STEPS):
        few = random.choice(BIRDS, FEW, replace=False)
        points[few] += 0.001 * np.stack([headings[few].real, headings[few].imag], axis=1)
        started = time.perf_counter()
        changes = tri.move_points(few, points[few])
        moving += time.perf_counter() - started
        changed += len(changes.made)
    print(
        f"{FEW} of them: {1e3 * moving / STEPS:.1f} ms for a move; "
        f"{changed / STEPS / tri.nsimplex:.1%} of the triangles change"
    )

    figure, axes = plt.subplots(figsize=(7, 7))
    tri.plot(axes, color="#dddddd", linewidth=0.4)
    arrows = (*points.T, headings.real, headings.imag)
    axes.quiver(*arrows, np.angle(headings), cmap="hsv", scale=60)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_position((0, 0, 1, 1))
    figure.savefig(path, dpi=70)


if __name__ == "__main__":
    main(*sys.argv[1:])
