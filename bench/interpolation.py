#!/usr/bin/env python3
"""Measures flaunay's interpolators beside SciPy's, end to end, and compares their answers.

    python bench/interpolation.py [--points 100000] [--queries 100000] [--runs 5] [--json RECORD.json]

End to end is from points, values and queries to results: triangulation, gradients and location included. All take turns;
the first run of each is not counted. Processor times are those of all threads. Queries come in random order, and as a
grid, in which each one is near the one before, as SciPy's search for triangles likes it. Run it with the installed module
and SciPy.
"""

import os

# SciPy factors a 2 by 2 matrix per triangle by OpenBLAS, whose threads only wait for each other: on a machine that is
# busy, for seconds.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import beside  # noqa: E402
import numpy as np  # noqa: E402
from scipy import interpolate  # noqa: E402

import flaunay  # noqa: E402

# Flaunay's, SciPy's, and how many times as fast it should be.
METHODS = {
    "linear": (flaunay.LinearInterpolator, interpolate.LinearNDInterpolator, 20),
    "clough-tocher": (flaunay.CloughTocherInterpolator, interpolate.CloughTocher2DInterpolator, 10),
    "nearest": (flaunay.NearestInterpolator, interpolate.NearestNDInterpolator, None),
}


def queries_of(kind, count, random):
    if kind == "random":
        return random.random((count, 2))
    line = np.linspace(0.01, 0.99, int(np.sqrt(count)))
    return np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)


def measured(kind, points, values, queries):
    answers = {}

    def call(method, name, interpolator):
        options = {"device": ARGUMENTS.device} if name == "flaunay" else {}
        answers[method, name] = interpolator(points, values, **options)(queries)

    calls = {
        (method, name): lambda one=(method, name, interpolator): call(*one)
        for method, (ours, scipys, _) in METHODS.items()
        for name, interpolator in (("flaunay", ours), ("scipy", scipys))
    }
    beside.rounds(calls, 1)
    times = beside.rounds(calls, ARGUMENTS.runs)
    for method, (_, _, target) in METHODS.items():
        row = {"method": method, "queries": kind}
        for name in ("flaunay", "scipy"):
            row[f"{name}_seconds_median"] = times[method, name]["wall_median"]
            row[f"{name}_processor_seconds_median"] = times[method, name]["cpu_median"]
        for key, clock in (("times_as_fast", ""), ("processor_times_as_fast", "processor_")):
            row[key] = row[f"scipy_{clock}seconds_median"] / row[f"flaunay_{clock}seconds_median"]
        ours, scipys = answers[method, "flaunay"], answers[method, "scipy"]
        row["target"] = target
        row["largest_difference"] = float(np.nanmax(np.abs(ours - scipys)))
        row["outside_of_one_only"] = int((np.isnan(ours) != np.isnan(scipys)).sum())
        print(
            f"{method:14} {kind:7} {row['flaunay_seconds_median']:8.4f} s beside "
            f"{row['scipy_seconds_median']:8.4f} s: {row['times_as_fast']:6.1f} times as fast "
            f"({row['processor_times_as_fast']:.1f} in processor time), "
            f"largest difference {row['largest_difference']:.2g}"
        )
        yield row


if __name__ == "__main__":
    ARGUMENTS = beside.parsed(
        __doc__, 5, {"points": (100_000, "how many"), "queries": (100_000, "how many")}
    )
    RANDOM = np.random.default_rng(1)
    POINTS = RANDOM.random((ARGUMENTS.points, 2))
    VALUES = np.sin(7 * POINTS[:, 0]) * np.cos(5 * POINTS[:, 1])
    ROWS = []
    for KIND in ("random", "grid"):
        ROWS += measured(KIND, POINTS, VALUES, queries_of(KIND, ARGUMENTS.queries, RANDOM))
    beside.write(
        ARGUMENTS,
        "interpolation from points, values and queries to results",
        ["scipy"],
        ROWS,
        **{key: getattr(ARGUMENTS, key) for key in ("points", "queries", "runs")},
    )
