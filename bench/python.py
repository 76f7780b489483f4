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

from __future__ import annotations

import argparse
import datetime
import importlib.metadata
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import time
from typing import Any, Callable

import numpy as np

import flaunay

Points = np.ndarray
Call = Callable[[Points], Any]

SOURCE = pathlib.Path(__file__).resolve().parent.parent
SMALLEST = 100
# Work grows a little faster than the number of points.
GROWTH = 12


def flaunay_call(points: Points) -> Any:
    return flaunay.Delaunay(points, device=ARGUMENTS.device).neighbors


def scipy_call(points: Points) -> Any:
    import scipy.spatial

    return scipy.spatial.Delaunay(points).neighbors


def matplotlib_call(points: Points) -> Any:
    import matplotlib.tri

    return matplotlib.tri.Triangulation(*points.T).neighbors


def triangle_call(points: Points) -> Any:
    import triangle

    # n for neighbours.
    return triangle.triangulate({"vertices": points}, "n")["neighbors"]


CALLS: dict[str, Call] = {
    "flaunay": flaunay_call,
    "scipy": scipy_call,
    "matplotlib": matplotlib_call,
    "triangle": triangle_call,
}


def versions() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for package in ("numpy", *CALLS):
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            pass
    return {**found, "flaunay": flaunay.__version__}


def timed(call: Call, points: Points) -> tuple[float, float]:
    """Seconds of the clock and of the CPU."""
    wall, cpu = time.perf_counter(), time.process_time()
    call(points)
    return time.perf_counter() - wall, time.process_time() - cpu


def runs_of(n: int, most: int) -> int:
    """Fewer where a run takes long."""
    return max(1, min(most, 3_000_000 // n))


def measured(n: int, calls: dict[str, Call]) -> list[dict[str, Any]]:
    runs = runs_of(n, ARGUMENTS.runs)
    random = np.random.default_rng(n)
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in calls}
    for _ in range(runs):
        points = random.random((n, 2))
        for name, call in calls.items():
            times[name].append(timed(call, points))
    return [
        {
            "package": name,
            "n": n,
            "runs": runs,
            "wall_median": statistics.median(wall for wall, _ in of_package),
            "cpu_median": statistics.median(cpu for _, cpu in of_package),
            "wall_min": min(wall for wall, _ in of_package),
            "cpu_min": min(cpu for _, cpu in of_package),
        }
        for name, of_package in times.items()
    ]


def all_measured() -> list[dict[str, Any]]:
    calls = {name: call for name, call in CALLS.items() if name in versions()}
    for call in calls.values():  # imports, and what is set up once
        call(np.random.default_rng(0).random((1000, 2)))
    rows: list[dict[str, Any]] = []
    n = SMALLEST
    while n <= ARGUMENTS.largest and calls:
        rows += measured(n, calls)
        slow = {
            row["package"]
            for row in rows
            if row["n"] == n and GROWTH * row["cpu_median"] > ARGUMENTS.patience
        }
        calls = {name: call for name, call in calls.items() if name not in slow}
        n *= 10
    return rows


def milliseconds(seconds: float) -> str:
    value = 1000 * seconds
    return f"{value:.2g}" if value < 10 else f"{value:,.0f}"


def table(rows: list[dict[str, Any]]) -> str:
    """CPU and wall milliseconds in Markdown."""
    names = list(dict.fromkeys(row["package"] for row in rows))
    lines = ["| points | " + " | ".join(names) + " |", "|---:|" + "---:|" * len(names)]
    for n in dict.fromkeys(row["n"] for row in rows):
        cells = {
            row[
                "package"
            ]: f"{milliseconds(row['cpu_median'])} ({milliseconds(row['wall_median'])})"
            for row in rows
            if row["n"] == n
        }
        lines.append(f"| {n:,} | " + " | ".join(cells.get(name, "–") for name in names) + " |")
    return "\n".join(lines)


def commit() -> str:
    git = ["git", "-C", str(SOURCE)]
    head = subprocess.run([*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    changed = subprocess.run([*git, "status", "--porcelain"], capture_output=True, text=True)
    return head.stdout.strip() + ("-changed" if changed.stdout.strip() else "")


def processor() -> str:
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        return next(
            line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")
        )
    except (OSError, StopIteration):
        return platform.processor()


def record(
    what: str, script: str, device: str, found: dict[str, str], rows: list[dict[str, Any]]
) -> dict[str, Any]:
    """A record of a script in this folder."""
    return {
        "what": what,
        "device": device,
        "host": f"{processor()}, {os.cpu_count()} hardware threads",
        "load": list(os.getloadavg()),
        "versions": found,
        "commit": commit(),
        "command": " ".join([f"bench/{script}", *sys.argv[1:]]),
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "results": rows,
    }


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--largest", type=int, default=10_000_000, help="most points")
    parser.add_argument("--runs", type=int, default=9, help="rounds for small sets")
    parser.add_argument("--patience", type=float, default=60, help="most seconds for a run")
    parser.add_argument("--device", default="host", help="of flaunay")
    parser.add_argument("--json", type=pathlib.Path, help="where to write a record")
    return parser.parse_args()


if __name__ == "__main__":
    ARGUMENTS = parsed()
    ROWS = all_measured()
    print(table(ROWS))
    if ARGUMENTS.json:
        WHAT = "triangles and neighbours of points uniform in a square, seconds per call"
        RECORD = record(WHAT, "python.py", ARGUMENTS.device, versions(), ROWS)
        ARGUMENTS.json.write_text(json.dumps(RECORD, indent=1) + "\n")
