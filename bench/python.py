#!/usr/bin/env python3
"""Times flaunay's Python package beside SciPy, Matplotlib and the package triangle on points uniform in a square.

    bench/python.py                                      prints a table in Markdown
    bench/python.py --json bench/results/python-host-2-cores.json
    bench/python.py --largest 100000 --runs 9

Each run is one call in this process that makes triangles and neighbours from an array of points. Rounds take all
packages in turn, so that a change of the machine's speed meets all of them. Times are medians: of the clock, and of CPU
time, which counts all threads and is the fairer number if other programs use the machine. A package whose last size
suggests more than --patience seconds for the next one is left out from there on. What is not installed is left out:

    pip install scipy matplotlib triangle
"""

import importlib

import beside
import numpy as np

import flaunay

SMALLEST = 100
# Work grows a little faster than the number of points.
GROWTH = 12
# How each package makes neighbours of points.
CALLS = {
    "flaunay": lambda points: flaunay.Delaunay(points, device=ARGUMENTS.device).neighbors,
    "scipy": lambda points: importlib.import_module("scipy.spatial").Delaunay(points).neighbors,
    "matplotlib": lambda points: importlib.import_module("matplotlib.tri")
    .Triangulation(*points.T)
    .neighbors,
    # n for neighbours.
    "triangle": lambda points: importlib.import_module("triangle").triangulate(
        {"vertices": points}, "n"
    )["neighbors"],
}


def measured(n, packages):
    """Fewer runs where one takes long; each has points of its own."""
    runs = max(1, min(ARGUMENTS.runs, 3_000_000 // n))
    random = np.random.default_rng(n)
    sets = [random.random((n, 2)) for _ in range(runs)]
    calls = {name: lambda name=name, own=iter(sets): CALLS[name](next(own)) for name in packages}
    times = beside.rounds(calls, runs)
    return [{"package": name, "n": n, "runs": runs, **times[name]} for name in packages]


def all_measured():
    packages = [name for name in CALLS if name in beside.versions(CALLS)]
    for name in packages:  # imports, and what is set up once
        CALLS[name](np.random.default_rng(0).random((1000, 2)))
    n = SMALLEST
    while n <= ARGUMENTS.largest and packages:
        rows = measured(n, packages)
        yield rows
        packages = [
            row["package"] for row in rows if GROWTH * row["cpu_median"] <= ARGUMENTS.patience
        ]
        n *= 10


def print_times(by_size):
    """CPU and wall milliseconds."""
    names = [row["package"] for row in by_size[0]]
    lines = []
    for rows in by_size:
        cells = dict.fromkeys(names, "–")
        for row in rows:
            cpu, wall = (beside.milliseconds(row[f"{clock}_median"]) for clock in ("cpu", "wall"))
            cells[row["package"]] = f"{cpu} ({wall})"
        lines.append([f"{rows[0]['n']:,}", *cells.values()])
    beside.print_table(["points", *names], lines)


if __name__ == "__main__":
    ARGUMENTS = beside.parsed(
        __doc__,
        9,
        {
            "largest": (10_000_000, "most points"),
            "patience": (60.0, "most seconds for a run"),
        },
    )
    BY_SIZE = list(all_measured())
    print_times(BY_SIZE)
    WHAT = "triangles and neighbours of points uniform in a square, seconds per call"
    beside.write(ARGUMENTS, WHAT, CALLS, [row for rows in BY_SIZE for row in rows])
