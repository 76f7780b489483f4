#!/usr/bin/env python3
"""Times flaunay's Python package beside others, and prints a table in Markdown.

    bench/python.py points          triangles and neighbours of points uniform in a square
    bench/python.py polygons        triangles of polygons with two holes each
    bench/python.py interpolation   interpolators, from points, values and queries to results
    bench/python.py queries         few queries at a time, and griddata as a whole
    bench/python.py updates         points added to an incremental triangulation, in one call
    bench/python.py points --json bench/results/python-host-2-cores.json --runs 9

All packages take turns, so that a change of the machine's speed meets all of them; the first round is not counted.
Times are medians: of CPU time, which counts all threads and is the fairer number if other programs use the machine, and
in brackets of the clock. A package that would take more than --patience seconds for ten times as many points is left
out from there on. mapbox_earcut's triangles are not Delaunay. What is not installed is left out:

    pip install scipy matplotlib triangle shapely mapbox_earcut
"""
import argparse
import datetime
import importlib
import importlib.metadata
import json
import os
import pathlib
import platform
import re
import statistics
import subprocess
import sys
import time

# SciPy factors a 2 by 2 matrix per triangle by OpenBLAS, whose threads only wait for each other: on a machine that is
# busy, for seconds.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402

import flaunay  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def versions():
    """Of the packages that are installed."""
    found = {"python": platform.python_version(), "flaunay": flaunay.__version__}
    for package in ("numpy", "scipy", "matplotlib", "triangle", "shapely", "mapbox_earcut"):
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            pass
    return found


def installed(calls):
    """The calls whose packages are installed; names begin with the package's."""
    return {name: call for name, call in calls.items() if re.split(r"\W", name)[0] in versions()}


def function(path):
    """scipy.spatial.Delaunay, say."""
    module, name = path.rsplit(".", 1)
    return getattr(importlib.import_module(module), name)


# ---- Experiments. Each yields what its rows are about and calls by name, and is sent the measured rows by name.


def points(arguments):
    calls = {
        "flaunay.Delaunay": lambda xy: flaunay.Delaunay(xy, device=arguments.device).neighbors,
        "scipy.spatial.Delaunay": lambda xy: function("scipy.spatial.Delaunay")(xy).neighbors,
        "matplotlib.tri.Triangulation": lambda xy: function("matplotlib.tri.Triangulation")(*xy.T).neighbors,
        # n for neighbours.
        "triangle.triangulate": lambda xy: function("triangle.triangulate")({"vertices": xy}, "n")["neighbors"],
    }
    random, n, calls = np.random.default_rng(1), 100, installed(calls)
    while n <= (arguments.points or 10_000_000) and calls:
        # Each call has points of its own.
        rows = yield {"n": n}, {name: lambda call=call: call(random.random((n, 2))) for name, call in calls.items()}
        # Work grows a little faster than the number of points.
        calls = {name: call for name, call in calls.items() if 12 * rows[name]["cpu_median"] <= arguments.patience}
        n *= 10


def ring(random, corners, least, most):
    """A ring around the origin, which cannot cross itself."""
    angles = (np.arange(corners) + random.uniform(0, 0.9, corners)) * (2 * np.pi / corners)
    radii = random.uniform(least, most, (corners, 1))
    return radii * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def offsets(parts):
    return np.cumsum([0] + [len(part) for part in parts])


def for_triangle(polygon):
    first = offsets(polygon)
    places = [np.arange(a, b) for a, b in zip(first, first[1:])]
    segments = [np.stack([place, np.roll(place, -1)], axis=1) for place in places]
    return {"vertices": np.concatenate(polygon), "segments": np.concatenate(segments),
            "holes": [hole.mean(axis=0) for hole in polygon[1:]]}


def polygons(arguments):
    """Each package gets the polygons in the form that it takes, made before the clock starts."""
    random = np.random.default_rng(arguments.polygons)
    hole = round(0.2 * arguments.polygon_points)
    rows = [[ring(random, arguments.polygon_points - 2 * hole, 0.75, 1) + (3 * k, 0),
             ring(random, hole, 0.1, 0.2) + (3 * k - 0.35, 0), ring(random, hole, 0.1, 0.2) + (3 * k + 0.35, 0)]
            for k in range(arguments.polygons)]
    rings = [ring for polygon in rows for ring in polygon]
    arrays = np.concatenate(rings), offsets(rings), offsets(rows)

    def of_shapely(call):
        geometries = np.array([function("shapely.Polygon")(outer, holes) for outer, *holes in rows])
        return lambda: call(geometries)

    def in_a_loop(path, inputs):
        call = function(path)
        return lambda: [call(*one) for one in inputs]

    make = installed({
        "flaunay.polygons, arrays": lambda: lambda: flaunay.polygons(*arrays, device=arguments.device).triangles,
        "shapely geometries, by flaunay.polygons": lambda: of_shapely(
            lambda all_of_them: flaunay.polygons(all_of_them, device=arguments.device).triangles),
        "shapely.constrained_delaunay_triangles": lambda: of_shapely(
            function("shapely.constrained_delaunay_triangles")),
        "triangle.triangulate, a loop": lambda: in_a_loop(
            "triangle.triangulate", [(for_triangle(polygon), "p") for polygon in rows]),
        "mapbox_earcut, a loop": lambda: in_a_loop(
            "mapbox_earcut.triangulate_float64",
            [(np.concatenate(one), offsets(one)[1:].astype(np.uint32)) for one in rows]),
    })
    yield ({"polygons": arguments.polygons, "points": arguments.polygon_points},
           {name: call() for name, call in make.items()})


def interpolation(arguments):
    random = np.random.default_rng(1)
    count = arguments.points or 100_000
    xy = random.random((count, 2))
    values = np.sin(7 * xy[:, 0]) * np.cos(5 * xy[:, 1])
    # In random order, and as a grid, in which each is near the one before, as SciPy's search for triangles likes it.
    line = np.linspace(0.01, 0.99, int(np.sqrt(count)))
    queries = {"random": random.random((count, 2)), "grid": np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)}
    for kind, places in queries.items():
        for name in ("Linear{}Interpolator", "CloughTocher{}Interpolator", "Nearest{}Interpolator"):
            ours = getattr(flaunay, name.format(""))
            theirs = "scipy.interpolate." + name.format("2D" if "Clough" in name else "ND")
            answers = {}
            rows = yield {"method": name.format(""), "queries": kind, "n": count}, installed({
                "flaunay": lambda: answers.update(ours=ours(xy, values, device=arguments.device)(places)),
                "scipy": lambda: answers.update(theirs=function(theirs)(xy, values)(places))})
            if "scipy" in rows:
                difference = np.abs(answers["ours"] - answers["theirs"])
                rows["scipy"]["largest_difference"] = float(np.nanmax(difference))
                outside = np.isnan(answers["ours"]) != np.isnan(answers["theirs"])
                rows["scipy"]["outside_of_one_only"] = int(outside.sum())


def queries(arguments):
    """Calls on triangulations and interpolators that are there; those of griddata make them, too."""
    random = np.random.default_rng(1)
    for n in (100, 1000, arguments.points or 100_000):
        xy = random.random((n, 2))
        values, device = np.sin(7 * xy[:, 0]) * np.cos(5 * xy[:, 1]), arguments.device
        mine, theirs = flaunay.Delaunay(xy, device=device), function("scipy.spatial.Delaunay")(xy)
        tree = function("scipy.spatial.cKDTree")(xy)
        pairs = {"find_simplex": (mine.find_simplex, theirs.find_simplex), "nearest": (mine.nearest, tree.query),
                 "nearest, k=8": (lambda at: mine.nearest(at, k=8), lambda at: tree.query(at, k=8))}
        for name, path, of in (("Linear", "LinearND", theirs), ("CloughTocher", "CloughTocher2D", theirs),
                               ("Nearest", "NearestND", xy)):
            pairs[name] = (getattr(flaunay, f"{name}Interpolator")(mine, values),
                           function(f"scipy.interpolate.{path}Interpolator")(of, values))
        for method in ("nearest", "linear", "cubic"):
            pairs[f"griddata, {method}"] = (
                lambda at, method=method: flaunay.griddata(xy, values, at, method, device=device),
                lambda at, method=method: function("scipy.interpolate.griddata")(xy, values, at, method))
        for m in (1, 10, 100, 1000):
            places = random.random((m, 2))
            for name, both in pairs.items():
                if name.startswith("griddata") and n > 10_000 and m in (10, 100):
                    continue  # its time is that of triangulation
                # Enough of them for the clock.
                times = max(1, 1000 // (m + n if name.startswith("griddata") else m))
                yield ({"what": name, "n": n, "queries": m, "times": times},
                       {package: lambda call=call: [call(places) for _ in range(times)]
                        for package, call in zip(("flaunay", "scipy"), both)})


def updates(arguments):
    """SciPy's add_points makes all arrays; flaunay's leaves them until they are asked for."""
    random, n = np.random.default_rng(1), arguments.points or 1_000_000
    xy = random.random((n, 2))
    mine = flaunay.Delaunay(xy, incremental=True, device=arguments.device)
    theirs = function("scipy.spatial.Delaunay")(xy, incremental=True)
    for added in (1, 100, 10_000):
        def new():
            return random.random((added, 2))
        yield {"n": n, "added": added}, {
            "flaunay, add_points": lambda: mine.add_points(new()),
            "flaunay, add_points and neighbors": lambda: (mine.add_points(new()), mine.neighbors),
            "flaunay, anew": lambda: flaunay.Delaunay(np.concatenate([xy, new()]), device=arguments.device),
            "scipy, add_points": lambda: theirs.add_points(new())}


EXPERIMENTS = {"points": points, "polygons": polygons, "interpolation": interpolation, "queries": queries,
               "updates": updates}


# ---- Measuring and records


def measured(keys, calls, runs):
    """A row for each call: medians and minima of the clock and of CPU time, of one of its `times`."""
    times, each = {name: [] for name in calls}, keys.get("times", 1)
    for _ in range(1 + runs):
        for name, call in calls.items():
            wall, cpu = time.perf_counter(), time.process_time()
            call()
            times[name].append(((time.perf_counter() - wall) / each, (time.process_time() - cpu) / each))
    return {name: {"call": name, **keys, "runs": runs,
                   **{f"{clock}_{what}": reduce(values)
                      for what, reduce in (("median", statistics.median), ("min", min))
                      for clock, values in zip(("wall", "cpu"), zip(*of_call[1:]))}}
            for name, of_call in times.items()}


def milliseconds(seconds):
    value = 1000 * seconds
    return f"{value:.2g}" if value < 10 else f"{value:,.0f}"


def measure(experiment, runs):
    """All rows; prints them as a table with a column for each call."""
    rows, names = None, []
    while True:
        try:
            keys, calls = experiment.send(rows)
        except StopIteration:
            return
        rows = measured(keys, calls, max(1, min(runs, 3_000_000 // keys.get("n", 1))))
        yield from rows.values()
        if not names:
            names = list(calls)
            print("| | " + " | ".join(names) + " |\n|---|" + "---:|" * len(names))
        cells = [f"{milliseconds(rows[name]['cpu_median'])} ({milliseconds(rows[name]['wall_median'])})"
                 if name in rows else "–" for name in names]
        print("| " + " | ".join([", ".join(f"{key} {value}" for key, value in keys.items()), *cells]) + " |")


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    return next((line.split(": ", 1)[1] for line in lines if line.startswith("model name")), platform.processor())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiment", choices=EXPERIMENTS)
    for name, default, text in (
            ("runs", 7, "counted rounds, fewer where one takes long"), ("points", 0, "0: the experiment's own number"),
            ("patience", 60.0, "most seconds for a run"), ("polygons", 10_000, "how many"),
            ("polygon-points", 100, "points of each polygon"), ("device", "host", "of flaunay")):
        parser.add_argument(f"--{name}", type=type(default), default=default, help=text)
    parser.add_argument("--json", type=pathlib.Path, help="where to write a record")
    arguments = parser.parse_args()
    rows = list(measure(EXPERIMENTS[arguments.experiment](arguments), arguments.runs))
    if arguments.json:
        commit = subprocess.check_output(["git", "describe", "--always", "--dirty"], cwd=SOURCE, text=True).strip()
        record = {"what": arguments.experiment, "device": arguments.device,
                  "host": f"{processor()}, {os.cpu_count()} hardware threads", "load": list(os.getloadavg()),
                  "versions": versions(), "commit": commit, "command": " ".join(["bench/python.py", *sys.argv[1:]]),
                  "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), "results": rows}
        arguments.json.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
