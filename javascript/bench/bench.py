#!/usr/bin/env python3
"""Measures the processor's time of the package for JavaScript, of delaunator, and of the native library on one thread,
each in a process of its own.

    javascript/bench/bench.py DELAUNATOR [--build DIR] [-o FILE.json] [--quick]

DELAUNATOR: its index.js, with robust-predicates in a node_modules beside it. Needs build/javascript/package, which
scripts/javascript.sh makes, and the native command and library in DIR, build/release if not given.
"""

import argparse
import datetime
import json
import pathlib
import subprocess
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BENCH = REPOSITORY / "javascript/bench"
SIZES = [100, 1_000, 10_000, 100_000, 1_000_000]
DISTRIBUTIONS = ["uniform", "normal", "grid", "circle", "clusters"]
ONE_THREAD = ["taskset", "-c", "0"]


def output_of(command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))


def distributions(command):
    """Those that the command lists."""
    rows = output_of([command, "generate", "--help"]).partition("Distributions:\n")[2].splitlines()
    return [row.split()[0] for row in rows if row.strip()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("delaunator", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=REPOSITORY / "build/release")
    parser.add_argument("--quick", action="store_true", help="1,000 points alone")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    given = parser.parse_args()
    command = given.build / "flaunay"
    results = []
    with tempfile.TemporaryDirectory() as folder:
        points, native = pathlib.Path(folder) / "points.npy", pathlib.Path(folder) / "native"
        library = next(given.build.rglob("libflaunay.so")).parent
        output_of(["cc", "-O2", f"-I{REPOSITORY}/src/include", BENCH / "native.c", "-o", native, f"-L{library}",
                   "-lflaunay", f"-Wl,-rpath,{library.resolve()}"])
        implementations = {
            "flaunay": ["node", BENCH / "one.js", REPOSITORY / "build/javascript/package/node.js"],
            "delaunator": ["node", BENCH / "one.js", given.delaunator.resolve()],
            "native": [*ONE_THREAD, native],
        }
        rows = [] if given.quick else [(name, n) for n in SIZES for name in DISTRIBUTIONS]
        rows += [(name, 1_000) for name in distributions(command) if (name, 1_000) not in rows]
        for distribution, n in rows:
            output_of([command, "generate", distribution, n, "-o", points])
            row = {"distribution": distribution, "n": n}
            # In turn, and the fastest run of each, since other programs slow down this machine.
            for _ in range(5 if n <= 1_000 else 3 if n <= 100_000 else 1):
                for name, program in implementations.items():
                    run = json.loads(output_of([*program, points]))
                    if name not in row or run["seconds"] < row[name]["seconds"]:
                        row[name] = run
            seconds = {name: row[name]["seconds"] for name in implementations}
            row["over_delaunator"] = round(seconds["delaunator"] / seconds["flaunay"], 3)
            row["over_native"] = round(seconds["flaunay"] / seconds["native"], 3)
            results.append(row)
            print(f"{distribution:18} {n:8} {1e3 * seconds['flaunay']:10.3f} ms, delaunator "
                  f"{1e3 * seconds['delaunator']:10.3f} ms ({row['over_delaunator']:.2f} times), native "
                  f"{1e3 * seconds['native']:10.3f} ms ({row['over_native']:.2f})", flush=True)
            if given.output:
                record = {
                    "host": processor(),
                    "node": output_of(["node", "--version"]).strip(),
                    "commit": output_of(["git", "-C", REPOSITORY, "rev-parse", "--short", "HEAD"]).strip(),
                    "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
                    "results": results,
                }
                given.output.write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()
