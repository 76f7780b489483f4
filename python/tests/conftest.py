"""What the tests share."""

from __future__ import annotations

import doctest
import inspect
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from fractions import Fraction

import numpy as np
import pytest


def is_from(finder, module, found, original=doctest.DocTestFinder._from_module):
    """Public classes say that they are the package's own, and have their examples where their methods are."""
    if inspect.isclass(found) and found.__module__ == "flaunay":
        return any(
            getattr(method, "__globals__", None) is vars(module) for method in vars(found).values()
        )
    return original(finder, module, found)


doctest.DocTestFinder._from_module = is_from

# If a shell starts the tests in the background, they ignore Ctrl-C, and so does all that they start. Some wait for it.
signal.signal(signal.SIGINT, signal.default_int_handler)


def as_set(triangles):
    """Triangles without the order of rows, and each without that of its corners."""
    return {tuple(sorted(row)) for row in np.asarray(triangles).tolist()}


def areas(points, triangles):
    """Twice the triangles' areas, positive if counter-clockwise."""
    a, b, c = (np.asarray(points, np.float64)[triangles[:, k]] for k in range(3))
    return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])


def check_neighbors(triangles, neighbors):
    """neighbors[i, k] has the edge opposite to corner k of triangle i, the other way round."""
    assert neighbors.shape == triangles.shape
    edges = {}
    for t, row in enumerate(triangles.tolist()):
        for k in range(3):
            edges[row[(k + 1) % 3], row[(k + 2) % 3]] = (t, k)
    for (a, b), (t, k) in edges.items():
        assert neighbors[t, k] == edges.get((b, a), (-1, 0))[0]


def grid(*shape):
    """Points with whole coordinates, by rows."""
    sides = [np.arange(float(n)) for n in (shape if len(shape) == 2 else 2 * shape)]
    return np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)


def circle(n, radius=1.0, centre=(0, 0)):
    turns = np.arange(n) * 2 * np.pi / n
    return np.stack([np.cos(turns), np.sin(turns)], axis=1) * radius + centre


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


def ring(*sizes):
    """Segments of closed curves, of so many points each."""
    starts = np.cumsum((0, *sizes))
    return [[a + k, a + (k + 1) % n] for a, n in zip(starts, sizes) for k in range(n)]


def angles(points, triangles):
    """Of each triangle at its corners, in degrees."""
    corners = np.asarray(points)[triangles]
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    cross = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    return np.degrees(np.arctan2(cross, (ahead * back).sum(axis=2)))


def orient(a, b, c):
    """Twice the area of a triangle, of fractions or whole numbers."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def fractions(points):
    """Coordinates as numbers that are exact."""
    return [tuple(map(Fraction, point)) for point in np.asarray(points, float).tolist()]


def cross(a, b, c, d):
    """Whether two open segments cross in one point."""
    a, b, c, d = fractions([a, b, c, d])
    return orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0


def uncrossed(random, points, wanted):
    """Random segments of which no two cross."""
    chosen = []
    for _ in range(20 * wanted):
        a, b = random.choice(len(points), 2, replace=False)
        if not any(cross(points[a], points[b], points[c], points[d]) for c, d in chosen):
            chosen.append((a, b))
        if len(chosen) == wanted:
            break
    return np.array(chosen)


def run_python(text, *arguments, **environment):
    """What a program has printed that must succeed, in a process of its own."""
    run = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(text), *arguments],
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.fixture
def random():
    return np.random.default_rng(1)


# ---- pyopencl


@pytest.fixture(scope="session")
def context():
    """One for all tests, since each new one has its kernels compiled or loaded."""
    return pytest.importorskip("pyopencl").create_some_context(interactive=False)


@pytest.fixture
def queue(context):
    return pytest.importorskip("pyopencl").CommandQueue(context)


def copy_behind_a_gate(array, values):
    """The event of a copy to an array on a queue of its own, which begins a while after this call."""
    import pyopencl as cl

    gate = cl.UserEvent(array.context)
    copied = cl.enqueue_copy(
        cl.CommandQueue(array.context), array.base_data, values, is_blocking=False, wait_for=[gate]
    )
    complete = cl.command_execution_status.COMPLETE
    threading.Timer(0.2, lambda: gate.set_status(complete)).start()
    return copied


def is_only_held_here(event):
    """Whether nobody else holds an event that is complete. A driver's thread may do so for a moment longer."""
    import pyopencl as cl

    until = time.monotonic() + 10
    while event.get_info(cl.event_info.REFERENCE_COUNT) > 1 and time.monotonic() < until:
        time.sleep(0.01)
    return event.get_info(cl.event_info.REFERENCE_COUNT) == 1
