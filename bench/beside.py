"""What the scripts that set flaunay's Python package beside others share: rounds, records, tables."""

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

import flaunay

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def parsed(doc, runs, options):
    """Arguments: the common ones, and options by name with their defaults and descriptions."""
    parser = argparse.ArgumentParser(
        description=doc, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for name, (default, text) in {**options, "runs": (runs, "rounds")}.items():
        parser.add_argument(f"--{name}", type=type(default), default=default, help=text)
    parser.add_argument("--device", default="host", help="of flaunay")
    parser.add_argument("--json", type=pathlib.Path, help="where to write a record")
    return parser.parse_args()


def versions(packages):
    """Of those that are installed."""
    found = {"python": platform.python_version()}
    for package in ("numpy", *packages):
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            pass
    return {**found, "flaunay": flaunay.__version__}


def rounds(calls, runs):
    """Makes all calls in turn. Medians and minima of the clock and of CPU time by name."""
    times = {name: [] for name in calls}
    for _ in range(runs):
        for name, call in calls.items():
            wall, cpu = time.perf_counter(), time.process_time()
            call()
            times[name].append((time.perf_counter() - wall, time.process_time() - cpu))
    return {
        name: {
            f"{clock}_{what}": reduce(values)
            for what, reduce in (("median", statistics.median), ("min", min))
            for clock, values in zip(("wall", "cpu"), zip(*of_call))
        }
        for name, of_call in times.items()
    }


def milliseconds(seconds):
    value = 1000 * seconds
    return f"{value:.2g}" if value < 10 else f"{value:,.0f}"


def print_table(header, rows):
    """In Markdown; all but the first column are numbers."""
    lines = [header, ["---"] + ["---:"] * (len(header) - 1), *rows]
    print("\n".join(f"| {' | '.join(line)} |" for line in lines))


def git(*words):
    return subprocess.run(
        ["git", "-C", SOURCE, *words], capture_output=True, text=True
    ).stdout.strip()


def processor():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(": ", 1)[1] for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor()


def write(arguments, what, packages, rows, **facts):
    """Writes the record, if one was asked for."""
    if not arguments.json:
        return
    record = {
        "what": what,
        "device": arguments.device,
        "host": f"{processor()}, {os.cpu_count()} hardware threads",
        "load": list(os.getloadavg()),
        "versions": versions(packages),
        "commit": git("rev-parse", "--short", "HEAD") + "-changed" * bool(git("status", "-s")),
        "command": " ".join([f"bench/{pathlib.Path(sys.argv[0]).name}", *sys.argv[1:]]),
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        **facts,
        "results": rows,
    }
    arguments.json.write_text(json.dumps(record, indent=1) + "\n")
