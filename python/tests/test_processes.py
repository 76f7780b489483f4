"""Calls on host arrays work in other processes, however they came about."""

import multiprocessing
import threading

import numpy as np
import pytest
from conftest import run_python

import flaunay


def everything_on_the_host(seed):
    """What calls on arrays in host memory return."""
    points = np.random.default_rng(seed).random((3000, 2))
    tri = flaunay.Delaunay(points)
    queries = points[:100] + 1e-3
    vor = flaunay.Voronoi(points)
    return [
        tri.simplices,
        tri.find_simplex(queries),
        tri.nearest(queries),
        tri.interpolate(points[:, 0], queries),
        vor.vertices,
        vor.cells,
        flaunay.triangulate(points.astype(np.float32), offsets=[0, 1000, 3000]).triangles,
        flaunay.triangulate(points, mode="dwyer").hull,
        flaunay.triangulate_chunks(points, triangles=True, chunk_points=1000).triangles,
    ]


def are_same(results, expected):
    return len(results) == len(expected) and all(
        np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in zip(results, expected)
    )


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_workers(method):
    expected = [everything_on_the_host(seed) for seed in range(3)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        results = pool.map_async(everything_on_the_host, range(3)).get(120)
    assert all(map(are_same, results, expected))


@pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")
def test_a_fork_while_another_thread_is_at_work():
    points = np.random.default_rng(1).random((50000, 2))
    expected = everything_on_the_host(1)
    done = threading.Event()

    def work():
        while not done.is_set():
            flaunay.triangulate(points)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        for _ in range(5):
            process = multiprocessing.get_context("fork").Process(
                target=check_and_exit, args=(expected,), daemon=True
            )
            process.start()
            process.join(60)
            assert process.exitcode == 0
    finally:
        done.set()
        thread.join()


def check_and_exit(expected):
    assert are_same(everything_on_the_host(1), expected)


# Prints what became of each call in a forked child of its own, and ends there.
FORKS = """
import os, signal, sys
import numpy as np
import flaunay

points = np.random.default_rng(1).random((300, 2))
tri = flaunay.Delaunay(points, device=sys.argv[1] or None) if sys.argv[1] != "none" else None
expected = flaunay.triangulate(points, mode="dwyer").hull
if tri is not None:
    tri.nearest(points)
calls = {
    "unnamed": lambda: flaunay.triangulate(points).hull,
    "host": lambda: flaunay.triangulate(points, device="host").hull,
    "dwyer": lambda: flaunay.triangulate(points, mode="dwyer").hull,
    "chunks": lambda: flaunay.triangulate_chunks(points, hull=True, chunk_points=100).hull,
    "voronoi": lambda: flaunay.Voronoi(points).delaunay.hull,
    "inherited": lambda: tri.hull[tri.nearest(points[tri.hull]) == tri.hull] if tri else expected,
    "named": lambda: flaunay.triangulate(points, device="#0").hull,
    "flattened": lambda: flaunay.triangulate(points, mode="flattened").hull,
    "chunks named": lambda: flaunay.triangulate_chunks(points, hull=True, devices="#0").hull,
    "devices": lambda: expected if flaunay.devices() else None,
}
for name, call in calls.items():
    child = os.fork()
    if child == 0:
        signal.alarm(100)
        try:
            ending = 0 if np.array_equal(call(), expected) else 1
        except flaunay.DeviceError as error:
            ending = 2 if "forked" in str(error) and "spawn" in str(error) else 3
        except BaseException:
            ending = 4
        os._exit(ending)
    print(name, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), sep=":")
"""
ON_DEVICES = {"named", "chunks named", "devices"}


@pytest.mark.parametrize(
    "device, fail",
    [("none", set()), ("host", set()), ("", ON_DEVICES), ("#0", ON_DEVICES | {"inherited"})],
)
def test_what_forked_children_can_do(device, fail):
    printed = run_python(FORKS, device, FLAUNAY_DEVICE="")
    endings = dict(line.rsplit(":", 1) for line in printed.splitlines())
    assert len(endings) == 10
    assert endings == {name: "2" if name in fail else "0" for name in endings}
