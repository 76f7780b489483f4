#!/usr/bin/env python3
"""Times flaunay.polygons beside loops over other packages, on polygons with two holes each.

    bench/polygons.py                                      prints a table in Markdown
    bench/polygons.py --polygons 10000 --points 100 --runs 7 --json bench/results/python-polygons-2-cores.json

Each package gets the polygons in the form that it takes, made before the clock starts. Rounds take all packages in
turn, so that a change of the machine's speed meets all of them. Times are medians: of the clock, and of CPU time, which
counts all threads and is the fairer number if other programs use the machine. mapbox_earcut's triangles are not
Delaunay. What is not installed is left out:

    pip install shapely triangle mapbox_earcut
"""

import importlib

import beside
import numpy as np

import flaunay

# Each hole has this part of a polygon's points.
HOLE = 0.2
CENTRES = ((-0.35, 0.0), (0.35, 0.0))


def ring(random, corners, least, most):
    """A ring around the origin, which cannot cross itself."""
    angles = (np.arange(corners) + random.uniform(0, 0.9, corners)) * (2 * np.pi / corners)
    radii = random.uniform(least, most, (corners, 1))
    return radii * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def made(count, points):
    """The rings of polygons in a row."""
    random = np.random.default_rng(count)
    hole = round(HOLE * points)
    outer = points - hole * len(CENTRES)
    return [
        [ring(random, outer, 0.75, 1) + (3 * k, 0)]
        + [ring(random, hole, 0.1, 0.2) + (3 * k + x, y) for x, y in CENTRES]
        for k in range(count)
    ]


def offsets(parts):
    return np.cumsum([0] + [len(part) for part in parts])


def flaunay_arrays(polygons):
    rings = [ring for polygon in polygons for ring in polygon]
    arrays = np.concatenate(rings), offsets(rings), offsets(polygons)
    return lambda: flaunay.polygons(*arrays, device=ARGUMENTS.device).triangles


def as_shapely(polygons):
    shapely = importlib.import_module("shapely")
    return shapely, np.array([shapely.Polygon(outer, holes) for outer, *holes in polygons])


def flaunay_shapely(polygons):
    _, geometries = as_shapely(polygons)
    return lambda: flaunay.polygons(geometries, device=ARGUMENTS.device).triangles


def shapely_call(polygons):
    shapely, geometries = as_shapely(polygons)
    return lambda: shapely.constrained_delaunay_triangles(geometries)


def triangle_call(polygons):
    triangulate = importlib.import_module("triangle").triangulate
    inputs = []
    for polygon in polygons:
        first = offsets(polygon)
        places = [np.arange(a, b) for a, b in zip(first, first[1:])]
        segments = [np.stack([place, np.roll(place, -1)], axis=1) for place in places]
        holes = [hole.mean(axis=0) for hole in polygon[1:]]
        vertices = np.concatenate(polygon)
        inputs.append({"vertices": vertices, "segments": np.concatenate(segments), "holes": holes})
    return lambda: [triangulate(one, "p")["triangles"] for one in inputs]


def earcut_call(polygons):
    triangulate = importlib.import_module("mapbox_earcut").triangulate_float64
    inputs = [(np.concatenate(one), offsets(one)[1:].astype(np.uint32)) for one in polygons]
    return lambda: [triangulate(*one) for one in inputs]


# By what it takes; the package that it needs.
CALLS = {
    "flaunay.polygons, arrays": ("flaunay", flaunay_arrays),
    "flaunay.polygons, geometries of Shapely": ("shapely", flaunay_shapely),
    "shapely.constrained_delaunay_triangles": ("shapely", shapely_call),
    "triangle.triangulate, a loop": ("triangle", triangle_call),
    "mapbox_earcut, a loop": ("mapbox_earcut", earcut_call),
}


def measured():
    polygons = made(ARGUMENTS.polygons, ARGUMENTS.points)
    packages = [package for package, _ in CALLS.values()]
    installed = beside.versions(packages)
    calls = {
        name: make(polygons) for name, (package, make) in CALLS.items() if package in installed
    }
    beside.rounds(calls, 1)  # the first sets up things once
    keys = {name: getattr(ARGUMENTS, name) for name in ("polygons", "points", "runs")}
    times = beside.rounds(calls, ARGUMENTS.runs)
    return packages, [{"call": name, **keys, **of_call} for name, of_call in times.items()]


if __name__ == "__main__":
    ARGUMENTS = beside.parsed(
        __doc__, 7, {"polygons": (10_000, "how many"), "points": (100, "points of each")}
    )
    PACKAGES, ROWS = measured()
    beside.print_table(
        ["call", "CPU time in ms", "by the clock"],
        [
            [
                f"`{row['call']}`",
                *(beside.milliseconds(row[f"{clock}_median"]) for clock in ("cpu", "wall")),
            ]
            for row in ROWS
        ],
    )
    WHAT = "triangles of polygons with two holes each, seconds per call"
    beside.write(ARGUMENTS, WHAT, PACKAGES, ROWS)
