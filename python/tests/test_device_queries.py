"""Queries, interpolation, Voronoi diagrams and relaxation from pyopencl arrays to pyopencl arrays."""

import functools
import gc
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import copy_behind_a_gate, is_only_held_here, run_python

import flaunay

cl = pytest.importorskip("pyopencl")
cl_array = pytest.importorskip("pyopencl.array")

PARTS = {"neighbors": True, "hull": True, "representatives": True}
OUT_OF_ORDER = cl.command_queue_properties.OUT_OF_ORDER_EXEC_MODE_ENABLE
METHODS = {
    "linear": flaunay.LinearInterpolator,
    "nearest": flaunay.NearestInterpolator,
    "clough-tocher": flaunay.CloughTocherInterpolator,
    "sibson": flaunay.NaturalNeighborInterpolator,
    "laplace": functools.partial(flaunay.NaturalNeighborInterpolator, method="laplace"),
}
BOX = (0.1, 0.2, 0.8, 1.3)
TRIANGLE = [[0, 0], [2, 0.5], [0.5, 1]]


def same(array, expected):
    """Byte for byte, with type and shape."""
    mine = array.get() if isinstance(array, cl_array.Array) else array
    assert mine.dtype == expected.dtype and mine.shape == expected.shape
    # All NaN are equal: which one is written is not stated.
    return np.array_equal(mine, expected, equal_nan=mine.dtype.kind == "f")


def triangulated(queue, points, **given):
    return flaunay.triangulate_device(cl_array.to_device(queue, points), **PARTS, **given)


def queries_for(random, points, m=700):
    """Some at points and on edges, some outside of the hull."""
    middles = (points[: m // 4] + points[1 : m // 4 + 1]) / 2
    return np.concatenate([random.random((m, 2)) * 1.4 - 0.2, points[: m // 4], middles])


class Case:
    """Points that are partly on a grid and partly equal, with a locator on the device."""

    def __init__(self, random, queue, dtype=np.float64):
        self.points = random.random((800, 2)).astype(dtype)
        self.points[:100] = random.integers(0, 8, (100, 2)) / 8
        self.queries = queries_for(random, self.points).astype(dtype)
        self.values = random.random(len(self.points))
        self.tri = triangulated(queue, self.points)
        self.locator = self.tri.locator()
        self.device_queries = cl_array.to_device(queue, self.queries)
        self.device_values = cl_array.to_device(queue, self.values)
        self.host = flaunay.Delaunay(self.points)


@pytest.fixture
def case(random, queue):
    return Case(random, queue)


# ---- Locating


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_located_as_on_the_host(random, queue, dtype):
    case = Case(random, queue, dtype)
    found = case.locator.locate(case.device_queries)
    expected = case.host.find_simplex(case.queries).astype(np.int32)
    assert same(found, expected) and (expected < 0).any() and (expected > 0).any()
    near = case.locator.nearest(case.device_queries)
    assert same(near, case.host.nearest(case.queries).astype(np.int32))
    assert found.queue is queue and case.locator.npoints == 800
    assert repr(case.locator) == "<flaunay.DeviceLocator: 800 points>"


def test_no_queries_and_no_points(queue):
    none = cl_array.zeros(queue, (0, 2), np.float64)
    locator = triangulated(queue, np.array([[0, 0], [4, 0], [0, 4.0]])).locator()
    values = cl_array.zeros(queue, 3, np.float64)
    assert same(locator.locate(none), np.empty(0, np.int32))
    assert same(locator.nearest(none), np.empty(0, np.int32))
    assert same(locator.interpolate(values, none), np.empty(0))
    pairs = cl_array.zeros(queue, (3, 2), np.float64)
    assert same(locator.interpolate(pairs, none), np.empty((0, 2)))

    tri = triangulated(queue, np.empty((0, 2)))
    locator, queries = tri.locator(), cl_array.zeros(queue, (5, 2), np.float64)
    nothing = cl_array.zeros(queue, 0, np.float64)
    assert same(locator.locate(queries), np.full(5, -1, np.int32))
    assert same(locator.nearest(queries), np.full(5, -1, np.int32))
    for method in METHODS:
        assert same(locator.interpolate(nothing, queries, method, 7), np.full(5, 7.0))
    assert same(locator.gradients(nothing), np.empty((0, 2)))


def test_points_on_one_line(queue):
    points = np.array([[0, 0], [1, 1], [2, 2], [1, 1.0]])
    locator = triangulated(queue, points).locator()
    queries = cl_array.to_device(queue, points)
    assert locator.locate(queries).get().tolist() == [-1] * 4
    assert locator.nearest(queries).get().tolist() == [0, 1, 2, 1]


# ---- Interpolation


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("columns", [None, 1, 3])
def test_interpolated_as_on_the_host(random, case, queue, method, columns):
    shape = (800,) if columns is None else (800, columns)
    values = random.random(shape)
    given = cl_array.to_device(queue, values)
    host = METHODS[method](case.host, values)
    expected = host(case.queries)
    assert same(case.locator.interpolate(given, case.device_queries, method), expected)
    if method != "nearest":
        assert np.isnan(expected).any()
        filled = case.locator.interpolate(given, case.device_queries, method, fill_value=-3)
        assert same(filled, np.where(np.isnan(expected), -3, expected))


@pytest.mark.parametrize("columns", [None, 2])
def test_gradients_as_on_the_host(random, case, queue, columns):
    values = random.random((800,) if columns is None else (800, columns))
    given = cl_array.to_device(queue, values)
    host = flaunay.CloughTocherInterpolator(case.host, values)
    slopes = case.locator.gradients(given)
    assert same(slopes, host.grad) and np.isnan(host.grad).any()
    result = case.locator.interpolate(given, case.device_queries, "clough-tocher", gradients=slopes)
    assert same(result, host(case.queries))
    # Those that are given count, not those that would be estimated.
    flat = cl_array.zeros(queue, slopes.shape, np.float64)
    expected = flaunay.CloughTocherInterpolator(case.host, values, gradients=flat.get())
    result = case.locator.interpolate(given, case.device_queries, "clough-tocher", gradients=flat)
    assert same(result, expected(case.queries))
    assert not same(result, host(case.queries))
    coarse = flaunay.CloughTocherInterpolator(case.host, values, tol=0.1, maxiter=3)
    assert same(case.locator.gradients(given, tol=0.1, maxiter=3), coarse.grad)
    for wrong, message in ({"tol": np.nan}, "greater than 0"), ({"maxiter": 0}, "an integer from 1"):
        with pytest.raises(flaunay.UsageError, match=message):
            case.locator.gradients(given, **wrong)


def test_all_in_one_buffer(random, queue):
    """Values, gradients and queries are views of one array, as a simulation may have them."""
    points, values, slopes = random.random((50, 2)), random.random(50), random.random((50, 2))
    together = cl_array.to_device(queue, np.concatenate([points.ravel(), values, slopes.ravel()]))
    queries, given = together[:100].reshape(50, 2), together[100:150]
    locator = triangulated(queue, points).locator()
    result = locator.interpolate(
        given, queries, "clough-tocher", gradients=together[150:].reshape(50, 2)
    )
    assert same(result, values)
    assert same(locator.interpolate(together[:50], queries), points.ravel()[:50])
    expected = flaunay.CloughTocherInterpolator(points, values).grad
    assert same(locator.gradients(given), expected)


def test_views_of_values_wait_for_what_the_call_waits_for(random, queue):
    points, values = random.random((300, 2)), random.random(300)
    locator = triangulated(queue, points).locator()
    queries = cl_array.to_device(queue, points)
    given = cl_array.zeros(queue, 310, np.float64)
    queue.finish()
    written = copy_behind_a_gate(given, np.append(np.zeros(10), values))
    assert same(locator.interpolate(given[10:], queries, wait_for=[written]), values)


# ---- Several sets

SIZES = [3, 0, 1, 50, 2, 0, 7, 200]
OFFSETS = np.concatenate([[0], np.cumsum(SIZES)]).astype(np.int32)
QUERY_SIZES = [4, 2, 0, 30, 5, 1, 9, 100]
QUERY_OFFSETS = np.concatenate([[0], np.cumsum(QUERY_SIZES)]).astype(np.int32)


@pytest.mark.parametrize("on_device", [False, True])
def test_sets_of_queries_are_for_sets_of_points(random, queue, on_device):
    points, queries = random.random((OFFSETS[-1], 2)), random.random((QUERY_OFFSETS[-1], 2))
    values = random.random(len(points))
    tri = triangulated(queue, points, offsets=OFFSETS)
    locator = tri.locator()
    given, offsets = cl_array.to_device(queue, queries), QUERY_OFFSETS
    if on_device:
        offsets = cl_array.to_device(queue, QUERY_OFFSETS)
    numbers = cl_array.to_device(queue, values)
    triangles = locator.locate(given, offsets).get()
    near = locator.nearest(given, offsets=offsets).get()
    methods = ("linear", "sibson", "laplace")  # those of gradients have one tolerance for all sets
    between = {m: locator.interpolate(numbers, given, m, offsets=offsets).get() for m in methods}
    for s in range(len(SIZES)):
        mine, theirs = slice(*OFFSETS[s : s + 2]), slice(*QUERY_OFFSETS[s : s + 2])
        host = flaunay.Delaunay(points[mine])
        where, closest = host.find_simplex(queries[theirs]), host.nearest(queries[theirs])
        first = tri.triangle_offsets[s]
        assert np.array_equal(triangles[theirs], np.where(where < 0, -1, where + first)), s
        assert np.array_equal(near[theirs], np.where(closest < 0, -1, closest + OFFSETS[s])), s
        for method in methods:
            alone = METHODS[method](host, values[mine])(queries[theirs])
            assert same(between[method][theirs], alone), (s, method)


def test_another_number_of_sets(random, queue):
    locator = triangulated(queue, random.random((20, 2)), offsets=[0, 5, 20]).locator()
    queries = cl_array.to_device(queue, random.random((6, 2)))
    on_device = [cl_array.to_device(queue, wrong) for wrong in (np.int64([0, 3, 6]), np.int32([[0, 3, 6]]))]
    for offsets, message in [
        (None, "sets"),
        ([0, 6], "sets"),
        ([0, 1, 2, 6], "sets"),
        ([0, 3, 5], "end with 5, but there are 6"),
        (on_device[0], "int32 in one dimension"),
        (on_device[1], "int32 in one dimension"),
    ]:
        with pytest.raises(flaunay.UsageError, match=message):
            locator.locate(queries, offsets)


# ---- Errors


@pytest.mark.parametrize("missing", PARTS)
def test_parts_that_were_not_asked_for(random, queue, missing):
    points = cl_array.to_device(queue, random.random((10, 2)))
    tri = flaunay.triangulate_device(points, **{**PARTS, missing: False})
    for call in tri.locator, tri.voronoi, lambda: tri.clipped_voronoi(BOX):
        with pytest.raises(
            flaunay.UsageError, match=f"has no {missing}: ask triangulate_device for them"
        ):
            call()


def test_queries_of_a_wrong_type_or_shape(case, queue):
    def on_device(shape, dtype=np.float64):
        return cl_array.zeros(queue, shape, dtype)

    for ask in (
        case.locator.locate,
        case.locator.nearest,
        lambda queries, **given: case.locator.interpolate(case.device_values, queries, **given),
    ):
        for queries, message in [
            (on_device((4, 3)), "queries must have the shape"),
            (on_device(4), "queries must have the shape"),
            (on_device((4, 2), np.int32), "queries.*float64 or float32"),
            (case.device_queries[::2], "queries must be C-contiguous"),
        ]:
            with pytest.raises(flaunay.UsageError, match=message):
                ask(queries)
        for queries in case.queries, None, [[0, 1]]:
            with pytest.raises(TypeError, match="queries must be a pyopencl.array.Array"):
                ask(queries)
        with pytest.raises(TypeError, match="queue must be a pyopencl.CommandQueue"):
            ask(case.device_queries, queue=queue.context)
        with pytest.raises(TypeError, match="wait_for must be a sequence"):
            ask(case.device_queries, wait_for=3)


def test_queries_that_are_not_finite(case, queue):
    case.queries[345, 1] = np.nan
    queries = cl_array.to_device(queue, case.queries)
    for ask in case.locator.locate, case.locator.nearest:
        with pytest.raises(flaunay.InputError, match="query 345 is not finite"):
            ask(queries)
    assert case.locator.locate(case.device_queries).size == len(case.queries)


def test_values_of_a_wrong_type_or_shape(case, queue):
    shape = r"values must have the shape \(800,\) or \(800, k\), not"
    wrong = [(cl_array.zeros(queue, size, np.float64), shape) for size in ((799,), (800, 2, 2), (2, 800), (800, 0), ())]
    for dtype in np.float32, np.int32, np.complex128:
        wrong.append((cl_array.zeros(queue, 800, dtype), "values.*must be float64"))
    wrong.append((cl_array.zeros(queue, 1600, np.float64)[::2], "values must be C-contiguous"))
    wrong += [(values, "values must be a pyopencl") for values in (case.values, None, 3.0)]
    for ask in lambda values: case.locator.interpolate(values, case.device_queries), case.locator.gradients:
        for values, message in wrong:
            with pytest.raises((TypeError, flaunay.UsageError), match=message):
                ask(values)


def test_gradients_of_a_wrong_type_or_shape(case, queue):
    flat = cl_array.zeros(queue, (800, 2), np.float64)
    shape = r"gradients must have the shape \(800, 2\)"
    for gradients, method, message in [
        (cl_array.zeros(queue, (800,), np.float64), "clough-tocher", shape),
        (cl_array.zeros(queue, (800, 1, 2), np.float64), "clough-tocher", shape),
        (cl_array.zeros(queue, (799, 2), np.float64), "clough-tocher", shape),
        (cl_array.zeros(queue, (800, 2), np.float32), "clough-tocher", "gradients.*must be float64"),
        (flat.get(), "clough-tocher", "gradients must be a pyopencl"),
        (flat, "linear", "gradients are for the method 'clough-tocher'"),
        (None, "cubic", "there is no method.*clough-tocher"),
        (None, "", "there is no method"),
        (None, None, "there is no method"),
    ]:
        with pytest.raises((TypeError, flaunay.UsageError), match=message):
            case.locator.interpolate(case.device_values, case.device_queries, method, gradients=gradients)


def test_another_context(random, case, queue):
    other = cl.CommandQueue(cl.Context(queue.context.devices))
    for call in (
        lambda: case.locator.locate(case.device_queries, queue=other),
        lambda: case.locator.locate(cl_array.to_device(other, case.queries)),
        lambda: case.locator.nearest(cl_array.to_device(other, case.queries), queue=queue),
        lambda: case.locator.interpolate(
            cl_array.to_device(other, case.values), case.device_queries
        ),
        lambda: case.locator.gradients(cl_array.to_device(other, case.values), queue=queue),
        lambda: case.tri.locator(queue=other),
        lambda: case.tri.voronoi(queue=other),
        lambda: case.tri.clipped_voronoi(BOX, queue=other),
        lambda: flaunay.relax_device(case.tri.points, BOX, queue=other),
    ):
        with pytest.raises(flaunay.UsageError, match="another context"):
            call()
    # None of these harmed it.
    assert same(
        case.locator.locate(case.device_queries),
        case.host.find_simplex(case.queries).astype(np.int32),
    )


def test_arrays_without_a_queue(case, queue):
    queue.finish()
    lonely = case.device_queries.with_queue(None)
    with pytest.raises(flaunay.UsageError, match="queries have no queue of their own"):
        case.locator.locate(lonely)
    assert case.locator.locate(lonely, queue=queue).size == len(case.queries)
    with pytest.raises(flaunay.UsageError, match="values have no queue of their own"):
        case.locator.gradients(case.device_values.with_queue(None))


def test_a_closed_locator(case):
    answers = case.locator.locate(case.device_queries)
    case.locator.close()
    case.locator.close()
    for call in (
        lambda: case.locator.locate(case.device_queries),
        lambda: case.locator.nearest(case.device_queries),
        lambda: case.locator.interpolate(case.device_values, case.device_queries),
        lambda: case.locator.gradients(case.device_values),
    ):
        with pytest.raises(flaunay.UsageError, match="the locator is closed"):
            call()
    assert np.array_equal(answers.get(), case.host.find_simplex(case.queries))


@pytest.mark.parametrize("cls", METHODS.values())
def test_interpolators_of_host_memory_name_the_call(case, cls):
    hint = r"in the memory of an OpenCL device: call triangulate_device\(...\).locator\(\).interpolate"
    interpolator = cls(case.points, case.values)
    calls = [
        (lambda: interpolator(case.device_queries), f"xi are {hint}, or take xi.get"),
        (lambda: interpolator(case.device_values, case.device_values), f"xi are {hint}"),
        (lambda: cls(case.points, case.device_values), f"values are {hint}"),
        (lambda: cls(case.tri.points, case.values), "points are in.*call triangulate_device"),
        (lambda: flaunay.griddata(case.points, case.device_values, case.queries), f"values are {hint}"),
    ]
    if cls is flaunay.CloughTocherInterpolator:
        slopes = case.locator.gradients(case.device_values)
        calls.append((lambda: cls(case.points, case.values, gradients=slopes), f"gradients are {hint}"))
    for call, message in calls:
        with pytest.raises(flaunay.UsageError, match=message):
            call()


# ---- Queues, events and lifetimes


@pytest.mark.parametrize("properties", [0, OUT_OF_ORDER])
def test_other_queues_of_the_context(case, context, properties):
    others = [cl.CommandQueue(context, properties=properties) for _ in range(3)]
    tri = flaunay.triangulate_device(case.tri.points, queue=others[0], **PARTS)
    locator = tri.locator(queue=others[1])
    slopes = locator.gradients(case.device_values, queue=others[2])
    result = locator.interpolate(
        case.device_values, case.device_queries, "clough-tocher", gradients=slopes, queue=others[0]
    )
    assert result.queue is others[0] and slopes.queue is others[2]
    host = flaunay.CloughTocherInterpolator(case.host, case.values)
    assert same(result, host(case.queries)) and same(slopes, host.grad)
    dual = tri.voronoi(queue=others[2])
    assert dual.vertices.queue is others[2]
    assert same(dual.vertices, flaunay.Voronoi(case.points).vertices)
    relaxed = flaunay.relax_device(case.tri.points, BOX, 2, queue=others[1], wait_for=[])
    assert relaxed.queue is others[1] and same(relaxed, flaunay.relax(case.points, BOX, 2))


def test_it_waits_for_what_it_is_told_to(case, queue):
    queries = cl_array.zeros(queue, case.queries.shape, np.float64)
    expected = case.host.nearest(case.queries).astype(np.int32)
    # Queries are checked on the host, so the call does not return before.
    for by_events in False, True:
        queries.fill(0).finish()
        copied = copy_behind_a_gate(queries, case.queries)
        if by_events:
            queries.add_event(copied)
        result = case.locator.nearest(queries, wait_for=[] if by_events else [copied])
        assert same(result, expected)


def test_arrays_know_the_event(case, queue):
    queue.finish()
    result = case.locator.interpolate(case.device_values, case.device_queries)
    (event,) = result.events
    assert event in case.device_values.events and event in case.device_queries.events
    assert case.locator.event in case.tri.points.events
    dual = case.tri.voronoi()
    for array in dual.vertices, dual.cells, dual.cell_offsets, dual.unbounded, case.tri.triangles:
        assert dual.event in array.events
    queue.finish()
    assert is_only_held_here(event) and is_only_held_here(dual.event)


def test_answers_outlive_all_else_in_any_order(random, queue):
    points, values = random.random((500, 2)), random.random(500)
    queries = random.random((400, 2))
    host = flaunay.Delaunay(points)
    tri = triangulated(queue, points)
    locator = tri.locator()
    dual, cells = tri.voronoi(), tri.clipped_voronoi(BOX)
    del tri
    gc.collect()
    result = locator.interpolate(
        cl_array.to_device(queue, values), cl_array.to_device(queue, queries)
    )
    near = locator.nearest(cl_array.to_device(queue, queries))
    del locator
    vertices, areas = dual.vertices, cells.areas
    del dual, cells
    gc.collect()
    # What would take the place of freed memory.
    for _ in range(3):
        triangulated(queue, random.random((500, 2))).locator()
    assert same(result, flaunay.LinearInterpolator(host, values)(queries))
    assert same(near, host.nearest(queries).astype(np.int32))
    voronoi = flaunay.Voronoi(points)
    assert same(vertices, voronoi.vertices) and same(areas, voronoi.clipped(BOX).areas)
    for array in result, near, vertices, areas:
        references = array.base_data.get_info(cl.mem_info.REFERENCE_COUNT)
        assert references == 1, "the array alone holds the buffer"


def test_points_may_change_after_the_event_of_the_locator(random, case, queue):
    case.locator.event.wait()
    case.tri.points.fill(0)
    case.tri.triangles.fill(0).finish()
    expected = case.host.find_simplex(case.queries).astype(np.int32)
    assert same(case.locator.locate(case.device_queries), expected)


def test_threads_share_a_locator(case, context):
    def work(k):
        queries = cl_array.to_device(cl.CommandQueue(context), case.queries[k:])
        return case.locator.locate(queries).get()

    expected = case.host.find_simplex(case.queries)
    with ThreadPoolExecutor(3) as pool:
        for k, result in enumerate(pool.map(work, range(12))):
            assert np.array_equal(result, expected[k:])


PROGRAM = """
import gc
import os
import signal

import numpy as np
import pyopencl as cl
import pyopencl.array

import flaunay

queue = cl.CommandQueue(cl.create_some_context(interactive=False))
points = cl.array.to_device(queue, np.random.default_rng(1).random((3000, 2)))
tri = flaunay.triangulate_device(points, neighbors=True, hull=True, representatives=True)
locator = tri.locator()
near = locator.nearest(points)
"""


def test_a_process_ends_with_all_alive_and_work_in_flight():
    run_python(PROGRAM + "locator.cycle = [tri, locator]")
    run_python(PROGRAM + "for _ in range(5): near = locator.nearest(points)\ndel points, tri, queue, locator")


def test_a_forked_child_is_told():
    run_python(
        PROGRAM
        + """
queue.finish()
child = os.fork()
if child == 0:
    signal.alarm(100)
    told = 0
    for call in (
        lambda: locator.nearest(points),
        lambda: locator.gradients(points),
        tri.locator,
        tri.voronoi,
        lambda: tri.clipped_voronoi((0, 0, 1, 1)),
        lambda: flaunay.relax_device(points, (0, 0, 1, 1)),
    ):
        try:
            call()
        except flaunay.DeviceError as error:
            told += "forked" in str(error)
    locator.close()
    gc.collect()
    os._exit(0 if told == 6 else 1)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
assert locator.nearest(points).get().tolist() == list(range(3000))
"""
    )


# ---- Voronoi diagrams


def check_cells(cells, host):
    for name in "vertices", "offsets", "areas", "centroids", "bounds":
        assert same(getattr(cells, name), getattr(host, name)), name


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("n", [0, 3, 800])
def test_the_dual_and_clipped_cells_are_those_of_the_host(random, queue, dtype, n):
    points = random.random((n, 2)).astype(dtype)
    points[n // 2 :: 7] = points[: len(points[n // 2 :: 7])]
    tri, host = triangulated(queue, points), flaunay.Voronoi(points)
    dual = tri.voronoi()
    for name in "vertices", "cells", "cell_offsets":
        assert same(getattr(dual, name), getattr(host, name)), name
    assert same(dual.unbounded, host.unbounded.view(np.uint8))
    assert repr(dual).startswith("<flaunay.DeviceVoronoi: ")
    for bounds in BOX, TRIANGLE, TRIANGLE[::-1]:
        cells, clipped = tri.clipped_voronoi(bounds), host.clipped(bounds)
        check_cells(cells, clipped)
        check_cells(cells.get(), clipped)
        assert repr(cells) == repr(clipped).replace("Clipped", "DeviceClipped")


def test_duals_and_clipped_cells_of_sets(random, queue):
    points = random.random((OFFSETS[-1], 2))
    tri = triangulated(queue, points, offsets=OFFSETS)
    clipped, dual = tri.clipped_voronoi(BOX).get(), tri.voronoi()
    vertices, cells, offsets = dual.vertices.get(), dual.cells.get(), dual.cell_offsets.get()
    for s in range(len(SIZES)):
        mine = slice(*OFFSETS[s : s + 2])
        host = flaunay.Voronoi(points[mine])
        first, last = tri.triangle_offsets[s : s + 2]
        assert same(vertices[first:last], host.vertices)
        assert np.array_equal(cells[3 * first : 3 * last] - first, host.cells)
        own = offsets[OFFSETS[s] : OFFSETS[s + 1] + 1]
        assert np.array_equal(own - 3 * first, host.cell_offsets)
        alone = host.clipped(BOX)
        for i, polygon in enumerate(alone.polygons()):
            assert np.array_equal(clipped.polygon(OFFSETS[s] + i), polygon)
        assert same(clipped.areas[mine], alone.areas)


def test_bounds_that_are_none(random, queue):
    tri = triangulated(queue, random.random((10, 2)))
    for bounds, kind, message in [
        ((1, 0, 0, 1), flaunay.UsageError, "bounds must be xmin < xmax"),
        (tri.points, flaunay.UsageError, "bounds are in the memory of an OpenCL device"),
        ([[0, 0], [3, 3], [3, 0], [0, 3]], flaunay.InputError, "corner"),
    ]:
        for call in tri.clipped_voronoi, lambda bounds: flaunay.relax_device(tri.points, bounds):
            with pytest.raises(kind, match=message):
                call(bounds)


# ---- Relaxation


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("iterations", [0, 4])
def test_relaxed_as_on_the_host(random, queue, dtype, iterations):
    points = random.random((300, 2)).astype(dtype)
    given = cl_array.to_device(queue, points)
    relaxed = flaunay.relax_device(given, BOX, iterations)
    assert same(relaxed, flaunay.relax(points, BOX, iterations))
    assert same(given, points) and relaxed.queue is queue
    # Later parts of many iterations do not read it.
    assert given.events and (iterations > 1 or relaxed.events[0] in given.events)
    # And on from there.
    again = flaunay.relax_device(relaxed, BOX, 2)
    assert same(again, flaunay.relax(points, BOX, iterations + 2))


def test_relaxation_of_nothing_and_of_what_is_none(queue):
    none = cl_array.zeros(queue, (0, 2), np.float64)
    assert same(flaunay.relax_device(none, BOX, 3), np.empty((0, 2)))
    points = cl_array.zeros(queue, (4, 2), np.float64)
    for given, iterations, kind, message in [
        (points, -1, flaunay.UsageError, "iterations must be an integer from 0"),
        (points, 1.5, flaunay.UsageError, "iterations must be an integer from 0"),
        (points.get(), 1, TypeError, "points must be a pyopencl.array.Array"),
        (points.ravel(), 1, flaunay.UsageError, "shape"),
    ]:
        with pytest.raises(kind, match=message):
            flaunay.relax_device(given, BOX, iterations)


@pytest.mark.parametrize("is_map", [False, True])
def test_queries_in_constrained_triangulations(random, queue, is_map):
    points = np.concatenate([random.random((60, 2)), [[0.1, 0.1], [0.9, 0.2], [0.4, 0.8]]])
    ring = [[60, 61], [61, 62], [62, 60]]
    values, queries = random.random(63), random.random((200, 2))
    name = queue.device.name

    def answers(device):
        if is_map:
            mesh = flaunay.polygons([[points[60:]]], map=True, device=device)
        else:
            mesh = flaunay.triangulate(points, segments=ring, device=device)
        of_points = values[: len(mesh.points)]
        kinds = [kind(mesh, of_points) for kind in METHODS.values()]
        return mesh, [mesh.find_simplex(queries), *(kind(queries) for kind in kinds)]

    mesh, mine = answers(name)
    assert mesh._locator._triangulator is flaunay._triangulators.of_device(name)
    for one, expected in zip(mine, answers("host")[1]):
        assert same(one, expected)
