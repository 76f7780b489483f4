#!/usr/bin/env python3
"""Times CuPy's Delaunay triangulation (cupyx.scipy.spatial.Delaunay, which is gDel2D) of points in .npy files.

Two times, each from one device synchronisation to another, after a run that is not counted:
  device  from points in device memory to triangles and neighbours there
  host    from points in host memory to triangles and neighbours there: what flaunay-bench's times include
"""
import argparse
import json
import os
import statistics
import sys
import time

import cupy
import numpy
from cupyx.scipy.spatial import Delaunay


def seconds_of(action):
    """One run of it, and what it gave."""
    cupy.cuda.Device().synchronize()
    begin = time.perf_counter()
    result = action()
    cupy.cuda.Device().synchronize()
    return time.perf_counter() - begin, result


def on_device(points):
    mesh = Delaunay(points)
    return mesh.simplices, mesh.neighbors


def through_host(points):
    return tuple(cupy.asnumpy(array) for array in on_device(cupy.asarray(points)))


def measure(points, runs):
    """The row of one input, and the triangles."""
    on_the_device = cupy.asarray(points)
    row = {}
    for name, action in (("device", lambda: on_device(on_the_device)), ("host", lambda: through_host(points))):
        seconds_of(action)
        times = [seconds_of(action)[0] for _ in range(runs)]
        row[f"{name}_seconds_median"] = statistics.median(times)
        row[f"{name}_seconds_min"] = min(times)
        row[f"{name}_seconds_max"] = max(times)
    _, (triangles, _) = seconds_of(lambda: through_host(points))
    row["triangles"] = len(triangles)
    return row, triangles


def device_name():
    name = cupy.cuda.runtime.getDeviceProperties(cupy.cuda.Device().id)["name"]
    return name.decode() if isinstance(name, bytes) else str(name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("points", nargs="+", help=".npy, n x 2")
    parser.add_argument("--runs", type=int, default=5, help="counted runs of each")
    parser.add_argument("--json", required=True, help="write the times here")
    parser.add_argument("--triangles", help="write the triangles of each input into this folder")
    arguments = parser.parse_args()
    if arguments.triangles:
        os.makedirs(arguments.triangles, exist_ok=True)

    rows = []
    for path in arguments.points:
        name = os.path.splitext(os.path.basename(path))[0]
        points = numpy.load(path).astype(numpy.float64)
        row = {"input": name, "n": len(points)}
        try:
            times, triangles = measure(points, arguments.runs)
            row.update(times)
            if arguments.triangles:
                numpy.save(os.path.join(arguments.triangles, f"{name}.npy"), triangles.astype(numpy.int32))
            print(f"{name}: {row['device_seconds_median']:.5f} s on the device, "
                  f"{row['host_seconds_median']:.5f} s with transfers, {row['triangles']} triangles")
        except Exception as error:  # of CuPy, CUDA or the algorithm: all end this input alone
            row["error"] = f"{type(error).__name__}: {error}"
            print(f"{name}: {row['error']}", file=sys.stderr)
        rows.append(row)
        # Memory that one input leaves with CuPy would be missing for the next.
        cupy.get_default_memory_pool().free_all_blocks()

    record = {"measured": True, "cupy": cupy.__version__, "cuda": cupy.cuda.runtime.runtimeGetVersion(),
              "device": device_name(), "runs": arguments.runs, "results": rows}
    with open(arguments.json, "w", encoding="utf-8") as file:
        json.dump(record, file, indent=2)
        file.write("\n")


if __name__ == "__main__":
    main()
