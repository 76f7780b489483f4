#!/usr/bin/env python3
"""Measures flaunay's interpolators beside SciPy's, end to end, and compares their answers.

    python bench/interpolation.py [--points 100000] [--queries 100000] [--runs 5] [--json RECORD.json]

End to end is from points, values and queries to results: triangulation, gradients and location included. All take turns;
the first run of each is not counted. Processor times are those of all threads. Queries come in random order, and as a
grid, in which each one is near the one before, as SciPy's search for triangles likes it. Run it with the installed module
and SciPy.
"""

import argparse
import json
import platform
import statistics
import subprocess
import sys
import time

import numpy as np
import scipy
import scipy.interpolate

import flaunay

METHODS = {
    "linear": (flaunay.LinearInterpolator, scipy.interpolate.LinearNDInterpolator, 20),
    "clough-tocher": (
        flaunay.CloughTocherInterpolator,
        scipy.interpolate.CloughTocher2DInterpolator,
        10,
    ),
    "nearest": (flaunay.NearestInterpolator, scipy.interpolate.NearestNDInterpolator, None),
}


def queries_of(kind, count, rng):
    if kind == "random":
        return rng.random((count, 2))
    side = int(np.sqrt(count))
    x, y = np.meshgrid(np.linspace(0.01, 0.99, side), np.linspace(0.01, 0.99, side))
    return np.stack([x, y], axis=-1).reshape(-1, 2)


def timed(work):
    begin, processor = time.perf_counter(), time.process_time()
    result = work()
    return result, time.perf_counter() - begin, time.process_time() - processor


def commit():
    command = ["git", "describe", "--always", "--dirty"]
    return subprocess.run(command, capture_output=True, text=True).stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--queries", type=int, default=100_000)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--json", help="write the record here")
    given = parser.parse_args()
    rng = np.random.default_rng(1)
    points = rng.random((given.points, 2))
    values = np.sin(7 * points[:, 0]) * np.cos(5 * points[:, 1])
    rows = []
    for kind in ["random", "grid"]:
        queries = queries_of(kind, given.queries, rng)
        walls, processors, answers = {}, {}, {}
        for run in range(given.runs + 1):
            for method, classes in METHODS.items():
                for name, interpolator in zip(["flaunay", "scipy"], classes):
                    result, wall, processor = timed(lambda: interpolator(points, values)(queries))
                    answers[method, name] = result
                    if run > 0:
                        walls.setdefault((method, name), []).append(wall)
                        processors.setdefault((method, name), []).append(processor)
        for method, (_, _, target) in METHODS.items():
            ours, scipys = answers[method, "flaunay"], answers[method, "scipy"]
            both = ~np.isnan(ours) & ~np.isnan(scipys)
            row = {"method": method, "queries": kind}
            for name in ["flaunay", "scipy"]:
                row[f"{name}_seconds_median"] = statistics.median(walls[method, name])
                row[f"{name}_processor_seconds_median"] = statistics.median(
                    processors[method, name]
                )
            row["times_as_fast"] = row["scipy_seconds_median"] / row["flaunay_seconds_median"]
            row["processor_times_as_fast"] = (
                row["scipy_processor_seconds_median"] / row["flaunay_processor_seconds_median"]
            )
            row["target"] = target
            row["largest_difference"] = float(np.abs(ours - scipys)[both].max())
            row["outside_of_one_only"] = int((np.isnan(ours) != np.isnan(scipys)).sum())
            rows.append(row)
            print(
                f"{method:14} {kind:7} {row['flaunay_seconds_median']:8.4f} s beside "
                f"{row['scipy_seconds_median']:8.4f} s: {row['times_as_fast']:6.1f} times as fast "
                f"({row['processor_times_as_fast']:.1f} in processor time), "
                f"largest difference {row['largest_difference']:.2g}"
            )
    record = {
        "command": " ".join(["bench/interpolation.py", *sys.argv[1:]]),
        "commit": commit(),
        "device": flaunay.triangulate(points).statistics["device"],
        "machine": platform.machine(),
        "driver": f"native kernels; Python {platform.python_version()}, NumPy {np.__version__}, "
        f"SciPy {scipy.__version__}",
        "points": given.points,
        "queries": given.queries,
        "runs": given.runs,
        "results": rows,
    }
    if given.json:
        with open(given.json, "w") as file:
            json.dump(record, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main()
