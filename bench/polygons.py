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

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import json
import pathlib
import statistics
import time
from typing import Any, Callable

import numpy as np
from python import milliseconds, record

import flaunay

# Each hole has this part of a polygon's points.
HOLE = 0.2
CENTRES = ((-0.35, 0.0), (0.35, 0.0))


def ring(random: np.random.Generator, corners: int, least: float, most: float) -> np.ndarray:
    """A ring around the origin, which cannot cross itself."""
    angles = (np.arange(corners) + random.uniform(0, 0.9, corners)) * (2 * np.pi / corners)
    radii = random.uniform(least, most, (corners, 1))
    return radii * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def made(count: int, points: int) -> list[list[np.ndarray]]:
    """The rings of polygons in a row."""
    random = np.random.default_rng(count)
    hole = round(HOLE * points)
    outer = points - hole * len(CENTRES)
    return [
        [ring(random, outer, 0.75, 1) + (3 * k, 0)]
        + [ring(random, hole, 0.1, 0.2) + (3 * k + x, y) for x, y in CENTRES]
        for k in range(count)
    ]


def flaunay_arrays(polygons: list[list[np.ndarray]]) -> Callable[[], Any]:
    rings = [ring for polygon in polygons for ring in polygon]
    coordinates = np.concatenate(rings)
    ring_offsets = np.cumsum([0] + [len(ring) for ring in rings])
    offsets = np.cumsum([0] + [len(polygon) for polygon in polygons])
    device = ARGUMENTS.device
    return lambda: flaunay.polygons(coordinates, ring_offsets, offsets, device=device).triangles


def as_shapely(polygons: list[list[np.ndarray]]) -> Any:
    import shapely

    return np.array([shapely.Polygon(outer, holes) for outer, *holes in polygons])


def flaunay_shapely(polygons: list[list[np.ndarray]]) -> Callable[[], Any]:
    geometries = as_shapely(polygons)
    return lambda: flaunay.polygons(geometries, device=ARGUMENTS.device).triangles


def shapely_call(polygons: list[list[np.ndarray]]) -> Callable[[], Any]:
    shapely = importlib.import_module("shapely")
    geometries = as_shapely(polygons)
    return lambda: shapely.constrained_delaunay_triangles(geometries)


def triangle_call(polygons: list[list[np.ndarray]]) -> Callable[[], Any]:
    triangulate = importlib.import_module("triangle").triangulate
    inputs = []
    for polygon in polygons:
        first = np.cumsum([0] + [len(ring) for ring in polygon])
        places = [np.arange(a, b) for a, b in zip(first, first[1:])]
        segments = [np.stack([place, np.roll(place, -1)], axis=1) for place in places]
        inputs.append(
            {
                "vertices": np.concatenate(polygon),
                "segments": np.concatenate(segments),
                "holes": [hole.mean(axis=0) for hole in polygon[1:]],
            }
        )
    return lambda: [triangulate(given, "p")["triangles"] for given in inputs]


def earcut_call(polygons: list[list[np.ndarray]]) -> Callable[[], Any]:
    triangulate = importlib.import_module("mapbox_earcut").triangulate_float64
    inputs = [
        (np.concatenate(polygon), np.cumsum([len(ring) for ring in polygon], dtype=np.uint32))
        for polygon in polygons
    ]
    return lambda: [triangulate(*given) for given in inputs]


# By what it takes; the package that it needs.
CALLS: dict[str, tuple[str, Callable[[list[list[np.ndarray]]], Callable[[], Any]]]] = {
    "flaunay.polygons, arrays": ("flaunay", flaunay_arrays),
    "flaunay.polygons, geometries of Shapely": ("shapely", flaunay_shapely),
    "shapely.constrained_delaunay_triangles": ("shapely", shapely_call),
    "triangle.triangulate, a loop": ("triangle", triangle_call),
    "mapbox_earcut, a loop": ("mapbox_earcut", earcut_call),
}


def is_installed(package: str) -> bool:
    try:
        importlib.import_module(package)
    except ImportError:
        return False
    return True


def versions() -> dict[str, str]:
    packages = dict.fromkeys(["numpy", *(package for package, _ in CALLS.values())])
    return {
        package: (
            flaunay.__version__ if package == "flaunay" else importlib.metadata.version(package)
        )
        for package in packages
        if is_installed(package)
    }


def measured() -> list[dict[str, Any]]:
    polygons = made(ARGUMENTS.polygons, ARGUMENTS.points)
    calls = {
        name: make(polygons) for name, (package, make) in CALLS.items() if is_installed(package)
    }
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in calls}
    for run in range(ARGUMENTS.runs + 1):
        for name, call in calls.items():
            wall, cpu = time.perf_counter(), time.process_time()
            call()
            if run > 0:  # the first sets up things once
                times[name].append((time.perf_counter() - wall, time.process_time() - cpu))
    return [
        {
            "call": name,
            "polygons": ARGUMENTS.polygons,
            "points": ARGUMENTS.points,
            "runs": ARGUMENTS.runs,
            "wall_median": statistics.median(wall for wall, _ in of_call),
            "cpu_median": statistics.median(cpu for _, cpu in of_call),
            "wall_min": min(wall for wall, _ in of_call),
            "cpu_min": min(cpu for _, cpu in of_call),
        }
        for name, of_call in times.items()
    ]


def table(rows: list[dict[str, Any]]) -> str:
    """CPU and wall milliseconds in Markdown."""
    lines = ["| call | CPU time in ms | by the clock |", "|---|---:|---:|"]
    for row in rows:
        cpu, wall = milliseconds(row["cpu_median"]), milliseconds(row["wall_median"])
        lines.append(f"| `{row['call']}` | {cpu} | {wall} |")
    return "\n".join(lines)


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--polygons", type=int, default=10_000, help="how many")
    parser.add_argument("--points", type=int, default=100, help="points of each")
    parser.add_argument("--runs", type=int, default=7, help="rounds")
    parser.add_argument("--device", default="host", help="of flaunay")
    parser.add_argument("--json", type=pathlib.Path, help="where to write a record")
    return parser.parse_args()


if __name__ == "__main__":
    ARGUMENTS = parsed()
    ROWS = measured()
    print(table(ROWS))
    if ARGUMENTS.json:
        WHAT = "triangles of polygons with two holes each, seconds per call"
        RECORD = record(WHAT, "polygons.py", ARGUMENTS.device, versions(), ROWS)
        ARGUMENTS.json.write_text(json.dumps(RECORD, indent=1) + "\n")
