#!/usr/bin/env python3
"""Attacks the command's chunks with files of all formats: random degenerate points, chunk sizes, numbers of devices and
widths of indices. What is written is compared with a run in memory: hulls and duplicates byte by byte, triangles with
their areas and neighbours as sets, since the order of rows depends on chunks; and between formats byte by byte.

    chunk_files.py FLAUNAY [--seconds N] [--seed S] [--mpi COMMAND]

COMMAND: such as "mpirun -n 3 build/release/flaunay-mpi", whose results are compared as well.
"""
import argparse
import io
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

import numpy as np


def write_las(path, integers):
    """Version 1.2, record format 0, with a scale of 2^-3 and an offset of 5."""
    n = len(integers)
    header = bytearray(227)
    header[:4] = b"LASF"
    header[24:26] = bytes([1, 2])
    struct.pack_into("<HII", header, 94, 227, 227, 0)
    struct.pack_into("<BHI", header, 104, 0, 20, n)
    struct.pack_into("<3d", header, 131, 0.125, 0.125, 0.125)
    struct.pack_into("<3d", header, 155, 5, 5, 5)
    records = np.zeros((n, 5), "<i4")
    records[:, :2] = integers
    path.write_bytes(bytes(header) + records.tobytes())


def random_integers(rng, n):
    kind = rng.integers(6)
    if kind == 0:
        return rng.integers(-(2**31) + 1, 2**31, (n, 2))
    if kind == 1:  # a grid with many equal points
        return rng.integers(0, max(2, int(n**0.5)), (n, 2))
    if kind == 2:  # clusters
        return rng.integers(-(10**8), 10**8, (7, 2))[rng.integers(0, 7, n)] + rng.integers(-50, 50, (n, 2))
    if kind == 3:  # nearly a line
        x = rng.integers(0, n, n)
        return np.stack([x, 2 * x + (rng.random(n) < 0.01)], 1)
    if kind == 4:  # a circle with points inside
        angle = rng.random(n) * 2 * np.pi
        radius = 10**9 * np.where(rng.random(n) < 0.3, 1, rng.random(n))
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1).astype(np.int64)
    return np.cumsum(rng.integers(-3, 4, (n, 2)), 0)  # a random walk


def write_all(folder, integers):
    points = integers * 0.125 + 5
    np.save(folder / "p.npy", points)
    points.astype("<f8").tofile(folder / "p.bin")
    write_las(folder / "p.las", integers)
    lines = [f"{x!r} {y!r}" for x, y in points.tolist()]
    (folder / "p.xy").write_text("\n".join(lines) + "\n")
    (folder / "p.csv").write_text("x,y\n" + "\n".join(line.replace(" ", ",") for line in lines) + "\n")
    numbered = [f"{len(lines)} 2 0 0"] + [f"{k} {line}" for k, line in enumerate(lines)]
    (folder / "p.node").write_text("\n".join(numbered) + "\n")


OUTPUTS = ("triangles", "neighbors", "hull", "duplicates", "areas")


def run(program, folder, name, arguments):
    """program: the command and its arguments before the subcommand."""
    out = {array: folder / f"{array}.npy" for array in OUTPUTS}
    command = [*program, "triangulate", folder / name, "--quiet", *arguments]
    for array, path in out.items():
        path.unlink(missing_ok=True)
        command += [f"--{array}", path]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        return done.returncode, done.stderr
    return 0, {array: path.read_bytes() for array, path in out.items()}


def rows(folder_bytes):
    """Each triangle with its area's bits and the corners of its neighbours, sorted."""
    t = np.load(io.BytesIO(folder_bytes["triangles"])).astype(np.int64)
    nb = np.load(io.BytesIO(folder_bytes["neighbors"])).astype(np.int64)
    areas = np.load(io.BytesIO(folder_bytes["areas"])).view(np.int64)
    if len(t) == 0:
        return t
    with_none = np.vstack([t, [[-1, -1, -1]]])
    full = np.hstack([t, areas[:, None], with_none[nb].reshape(len(t), 9)])
    return full[np.lexsort(full.T[::-1])]


def values(data):
    return np.load(io.BytesIO(data)).astype(np.int64)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("flaunay")
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mpi", type=str.split)
    options = parser.parse_args()
    end = time.monotonic() + options.seconds
    case = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        while case == 0 or time.monotonic() < end:
            rng = np.random.default_rng([options.seed, case])
            n = int(np.exp(rng.uniform(0, np.log(30000))))
            integers = random_integers(rng, n)
            write_all(folder, integers)
            width = ["auto", "32", "64"][rng.integers(3)]
            chunks = ["--chunk-points", str(int(rng.integers(max(1, n // 20), n + 2))), "--index", width]
            chunks += ["--device", ",".join(["host"] * int(rng.integers(1, 4)))]
            if rng.random() < 0.5:
                chunks += ["--memory", "256M", "--scratch", name]

            def fail(message):
                sys.exit(f"seed {options.seed}, case {case}: {n} points, {' '.join(chunks)}: {message}")

            code, whole = run([options.flaunay], folder, "p.npy", ["--device", "host"])
            if code != 0:
                fail(f"in memory: {whole}")

            def expect_same(name, found):
                for array in ("hull", "duplicates"):
                    if not np.array_equal(values(found[array]), values(whole[array])):
                        fail(f"{name}: another array of {array}")
                if not np.array_equal(rows(found), rows(whole)):
                    fail(f"{name}: other triangles or neighbours")

            for file in ("p.npy", "p.bin", "p.las") if options.mpi else ():
                size = ["--round-points", str(int(rng.integers(max(1, n // 20), n + 2)))]
                code, found = run(options.mpi, folder, file, size)
                if code != 0:
                    fail(f"{file} with MPI, {size}: {found}")
                expect_same(f"{file} with MPI, {size}", found)
            first = None
            for file in ("p.npy", "p.bin", "p.las", "p.xy", "p.csv", "p.node"):
                code, found = run([options.flaunay], folder, file, chunks)
                if code != 0:
                    fail(f"{file}: {found}")
                if first is None:
                    first = found
                    expect_same(file, found)
                elif found != first:
                    fail(f"{file}: other bytes than from p.npy")
            left = sorted(path.name for path in folder.iterdir())
            if any(entry.startswith(".") or entry.endswith(".partial") for entry in left):
                fail(f"left behind: {left}")
            case += 1
    print(f"{case} sets of points in 6 formats are the same in chunks as in memory (seed {options.seed})")


if __name__ == "__main__":
    main()
