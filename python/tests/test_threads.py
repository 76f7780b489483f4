"""Threads take turns on a device, and the interpreter's lock is free meanwhile."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import flaunay


def test_two_threads_get_the_right_results(random):
    inputs = [random.random((n, 2)) for n in (10, 3000, 200, 20000, 1, 700)] * 4
    expected = [flaunay.triangulate(points).triangles for points in inputs]
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(flaunay.triangulate, inputs))
    for result, triangles in zip(results, expected):
        assert np.array_equal(result.triangles, triangles)


def test_two_threads_that_make_a_triangulator_at_the_same_time(random, monkeypatch):
    from flaunay import _triangulators

    monkeypatch.setattr(_triangulators, "_by_name", {})
    points = random.random((100, 2))
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(flaunay.triangulate, [points] * 2))
    assert np.array_equal(results[0].triangles, results[1].triangles)
    assert len(_triangulators._by_name) == 1


def longest_pause_during(work):
    """The longest time for which another thread stood still, as a share of the work's."""
    done = threading.Event()
    ticking = threading.Event()
    ticks = []

    def tick():
        last = time.perf_counter()
        while not done.is_set():
            now = time.perf_counter()
            ticks.append((now - last, last))
            last = now
            ticking.set()

    ticker = threading.Thread(target=tick)
    ticker.start()
    ticking.wait()
    begin = time.perf_counter()
    work()
    end = time.perf_counter()
    done.set()
    ticker.join()
    assert sum(begin < at < end for _, at in ticks) > 0
    return max(pause for pause, _ in ticks) / (end - begin)


def test_another_thread_counts_meanwhile(random):
    points = random.random((500000, 2))
    flaunay.triangulate(points)
    # With the lock held, the other thread would stand still from begin to end. A busy machine makes threads wait too,
    # hence more than one try.
    pauses = []
    for _ in range(3):
        pauses.append(longest_pause_during(lambda: flaunay.triangulate(points)))
        if pauses[-1] < 0.5:
            return
    raise AssertionError(pauses)


def test_a_locator_is_made_while_another_is(random, monkeypatch):
    from flaunay import _calls

    make = _calls.Locator
    begun, other_is_done = threading.Event(), threading.Event()

    def wait_with_the_large_one(triangulator, mesh):
        if len(mesh.points) == 1000:
            begun.set()
            assert other_is_done.wait(60)
        return make(triangulator, mesh)

    monkeypatch.setattr(_calls, "Locator", wait_with_the_large_one)
    large, small = (flaunay.Delaunay(random.random((n, 2))) for n in (1000, 10))
    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(large.nearest, large.points)
        assert begun.wait(60)
        second = pool.submit(small.nearest, small.points)
        try:
            assert np.array_equal(second.result(30), np.arange(10))
        finally:
            other_is_done.set()
        assert np.array_equal(first.result(60), np.arange(1000))


def test_two_threads_make_one_locator(random, monkeypatch):
    from flaunay import _calls

    make = _calls.Locator
    made = []

    def make_slowly(*arguments):
        made.append(arguments)
        time.sleep(0.2)
        return make(*arguments)

    monkeypatch.setattr(_calls, "Locator", make_slowly)
    tri = flaunay.Delaunay(random.random((100, 2)))
    with ThreadPoolExecutor(2) as pool:
        for found in pool.map(tri.nearest, [tri.points] * 2):
            assert np.array_equal(found, np.arange(100))
    assert len(made) == 1


def test_queries_take_no_lock_once_there_is_a_locator(random):
    tri = flaunay.Delaunay(random.random((100, 2)))
    tri.nearest(tri.points)
    with ThreadPoolExecutor(1) as pool, tri._kept_locator._lock:
        assert np.array_equal(pool.submit(tri.nearest, tri.points).result(30), np.arange(100))
