#!/usr/bin/env python3
"""Times `flaunay terrain` from a scan on disk to a raster, and beside gdal_grid, and prints a table in Markdown.

    bench/terrain.py FOLDER --large 100000000 --json bench/results/terrain-host-2-cores.json

The scan is made up: points in strips as of an aircraft, one per square metre, on hills; it stays in FOLDER, 28 bytes a
point. The large one is read within --memory, its raster has a pixel per point. A million points are given to gdal_grid
(-a linear) as text, and to flaunay as text, too. CPU time counts all threads, and is the fairer number if other
programs use the machine.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import resource
import shutil
import struct
import subprocess
import sys
import time

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parent.parent
WEST, SOUTH = 500000, 5000000
RECORD = np.dtype([("at", "<i4", 3), ("intensity", "<u2"), ("returns", "u1"), ("class", "u1"), ("rest", "V12")])


def strips(n, count=20, most=1_000_000):
    """Centimetres of n points, strip after strip, in pieces."""
    random = np.random.default_rng(1)
    side = int(n**0.5)
    for strip in range(count):
        left = n * (strip + 1) // count - n * strip // count
        for first in range(0, left, most):
            size = min(most, left - first)
            x = (strip + random.random(size)) * side / count
            y = side * (first + np.arange(size) + random.random(size)) / left
            z = 200 + 80 * np.sin(x / 300) * np.cos(y / 410) + 20 * np.sin(x / 37 + y / 53)
            z += random.normal(0, 0.05, size)
            yield np.rint(100 * np.column_stack([x, y, z])).astype(np.int32)


def write_las(path, n):
    """LAS 1.2, point format 1."""
    side = int(n**0.5)
    header = bytearray(227)
    header[:4], header[24:26] = b"LASF", bytes([1, 2])
    struct.pack_into("<HII", header, 94, 227, 227, 0)
    struct.pack_into("<BHI", header, 104, 1, RECORD.itemsize, n)
    struct.pack_into("<6d", header, 131, 0.01, 0.01, 0.01, WEST, SOUTH, 0)
    struct.pack_into("<6d", header, 179, WEST + side, WEST, SOUTH + side, SOUTH, 500, 0)
    with open(path, "wb") as file:
        file.write(header)
        for at in strips(n):
            records = np.zeros(len(at), RECORD)
            records["at"], records["returns"], records["class"] = at, 9, 2
            file.write(records.tobytes())


def write_text(path, n):
    with open(path, "w", encoding="ascii") as file:
        file.write("x,y,z\n")
        for at in strips(n):
            np.savetxt(file, at / 100 + [WEST, SOUTH, 0], fmt="%.2f", delimiter=",")


def timed(name, n, pixels, command):
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    row = {"call": name, "n": n, "pixels": pixels, "wall": time.perf_counter() - begin,
           "cpu": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
           "largest_rss_kib": after.ru_maxrss}
    print(f"| {name} | {n:,} | {row['cpu']:.3g} | {row['wall']:.3g} | {n / row['wall'] / 1e6:.3g} |", flush=True)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--flaunay", default=SOURCE / "build/release/flaunay", help="the command, built with GDAL")
    parser.add_argument("--large", type=int, default=100_000_000, help="points of the large scan; 0: none")
    parser.add_argument("--memory", default="2G")
    parser.add_argument("--json", type=pathlib.Path, help="where to write a record")
    arguments = parser.parse_args()
    load, rows = list(os.getloadavg()), []
    to = arguments.folder / "dem.tif"
    print("| | points | CPU s | s | million points per s |\n|---|--:|--:|--:|--:|")

    # The large one first: the largest memory is that of all children so far.
    if n := arguments.large:
        scan = arguments.folder / f"scan-{n}.las"
        if not scan.exists():
            write_las(scan, n)
        rows.append(timed("flaunay terrain, .las to .tif", n, int(n**0.5) ** 2,
                          [arguments.flaunay, "terrain", scan, "-o", to, "--resolution", 1, "--memory",
                           arguments.memory, "--scratch", arguments.folder, "--quiet"]))
    n, side = 1_000_000, 1000
    text = arguments.folder / "scan.csv"
    write_text(text, n)
    layer = arguments.folder / "scan.vrt"
    layer.write_text(f"""<OGRVRTDataSource><OGRVRTLayer name="scan"><SrcDataSource>{text}</SrcDataSource>
<GeometryType>wkbPoint25D</GeometryType><GeometryField encoding="PointFromColumns" x="x" y="y" z="z"/>
</OGRVRTLayer></OGRVRTDataSource>""")
    rows.append(timed("flaunay terrain, text to .tif", n, side**2,
                      [arguments.flaunay, "terrain", text, "-o", to, "--resolution", 1, "--quiet"]))
    if shutil.which("gdal_grid"):
        rows.append(timed("gdal_grid -a linear, text to .tif", n, side**2,
                          ["gdal_grid", "-q", "-a", "linear:radius=0:nodata=-9999", "-txe", WEST, WEST + side,
                           "-tye", SOUTH + side, SOUTH, "-outsize", side, side, "-ot", "Float32", "-l", "scan", layer,
                           to]))
    if arguments.json:
        model = next(line for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if "model name" in line)
        gdal = subprocess.run(["gdalinfo", "--version"], capture_output=True, text=True, check=False).stdout.strip()
        commit = subprocess.check_output(["git", "describe", "--always", "--dirty"], cwd=SOURCE, text=True).strip()
        record = {"what": "a scan on disk to a raster, seconds per command", "device": "host",
                  "host": f"{model.split(': ')[1]}, {os.cpu_count()} hardware threads", "load": load,
                  "versions": {"python": platform.python_version(), "gdal": gdal}, "commit": commit,
                  "command": " ".join(["bench/terrain.py", "FOLDER", *sys.argv[2:]]),
                  "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), "results": rows}
        arguments.json.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
