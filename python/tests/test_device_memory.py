"""From pyopencl arrays to pyopencl arrays: triangulate_device, periodic_device, spherical_device."""

import gc
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import copy_behind_a_gate, is_only_held_here, run_python

import flaunay

cl = pytest.importorskip("pyopencl")
cl_array = pytest.importorskip("pyopencl.array")

ALL = {"neighbors": True, "halfedges": True, "hull": True, "representatives": True}
OUT_OF_ORDER = cl.command_queue_properties.OUT_OF_ORDER_EXEC_MODE_ENABLE


def check_equal(result, expected):
    """The arrays of two triangulations, byte by byte."""
    host = result.get()
    for name in "triangles", "neighbors", "halfedges", "hull", "representatives":
        mine, other = getattr(host, name), getattr(expected, name)
        assert mine.dtype == np.int32 and mine.shape == other.shape, name
        assert np.array_equal(mine, other), name
    assert np.array_equal(host.triangle_offsets, expected.triangle_offsets)
    assert np.array_equal(host.hull_offsets, expected.hull_offsets)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("n", [0, 1, 3, 1000])
def test_the_results_are_those_of_triangulate(random, queue, dtype, n):
    points = random.random((n, 2)).astype(dtype)
    result = flaunay.triangulate_device(cl_array.to_device(queue, points), **ALL)
    assert isinstance(result, flaunay.DeviceTriangulation) and result.event is not None
    check_equal(result, flaunay.triangulate(points, halfedges=True))
    assert result == result


def test_a_result_is_short_in_print(random, queue):
    result = flaunay.triangulate_device(cl_array.to_device(queue, random.random((100, 2))))
    sizes = f"100 points, {result.triangle_offsets[-1]} triangles, {result.hull_offsets[-1]} hull vertices"
    assert repr(result) == f"<flaunay.DeviceTriangulation: {sizes}>"


@pytest.mark.parametrize("wait_for", [[None], 3, ["event"], [[]], cl.enqueue_marker])
def test_what_is_no_event_to_wait_for(random, queue, wait_for):
    points = cl_array.to_device(queue, random.random((100, 2)))
    given = wait_for(queue) if callable(wait_for) else wait_for  # one event is no sequence
    with pytest.raises(TypeError, match="wait_for must be a sequence of pyopencl.Event"):
        flaunay.triangulate_device(points, wait_for=given)


def test_what_is_not_asked_for_is_none(random, queue):
    result = flaunay.triangulate_device(cl_array.to_device(queue, random.random((100, 2))))
    assert result.triangles.shape == (int(result.triangle_offsets[-1]), 3)
    for name in ALL:
        assert getattr(result, name) is None
    with pytest.raises(flaunay.UsageError, match="hull and representatives"):
        result.get()


def test_buffers_and_views(random, queue):
    points = random.random((1000, 2))
    flags = cl.mem_flags.READ_ONLY | cl.mem_flags.COPY_HOST_PTR
    buffer = cl.Buffer(queue.context, flags, hostbuf=points)
    by_buffer = cl_array.Array(queue, (1000, 2), np.float64, data=buffer)
    array = cl_array.to_device(queue, points)
    floats = cl_array.to_device(queue, points.astype(np.float32))
    within = cl_array.to_device(queue, points.ravel()[:401])[1:].reshape(200, 2)
    with pytest.raises(
        flaunay.UsageError, match="8 bytes after.*no multiple of a point's 16 bytes"
    ):
        flaunay.triangulate_device(within)
    for given in by_buffer, array[17:900], floats[17:900], within.copy():
        expected = flaunay.triangulate(given.get(), halfedges=True)
        check_equal(flaunay.triangulate_device(given, **ALL), expected)
    fortran = cl_array.to_device(queue, np.asfortranarray(np.zeros((9, 2))))
    wide = cl_array.to_device(queue, np.zeros((9, 3)))[:, :2]
    for given in array[::2], array[::-1], wide, fortran:
        with pytest.raises(flaunay.UsageError, match="contiguous"):
            flaunay.triangulate_device(given)


SIZES = [3, 0, 1, 50, 2, 0, 7, 200]
OFFSETS = np.concatenate([[0], np.cumsum(SIZES)]).astype(np.int32)


@pytest.mark.parametrize("where", ["host", "device", "view on the device"])
def test_many_sets(random, queue, where):
    points = random.random((OFFSETS[-1], 2))
    offsets = OFFSETS
    if where == "device":
        offsets = cl_array.to_device(queue, OFFSETS)
    elif where == "view on the device":
        offsets = cl_array.to_device(queue, np.concatenate([np.int32([5, 5, 5]), OFFSETS]))[3:]
    array = cl_array.to_device(queue, np.concatenate([random.random((9, 2)), points]))[9:]
    result = flaunay.triangulate_device(array, offsets=offsets, **ALL)
    check_equal(result, flaunay.triangulate(points, offsets=OFFSETS, halfedges=True))


def test_wrong_offsets_and_points(queue):
    points = cl_array.zeros(queue, (4, 2), np.float64)
    for offsets in [0, 3], cl_array.to_device(queue, np.int32([0, 3])):
        with pytest.raises(flaunay.UsageError, match="end with 3, but there are 4"):
            flaunay.triangulate_device(points, offsets=offsets)
    for offsets in np.int64([0, 4]), np.int32([[0, 4]]), np.float32([0, 4]):
        with pytest.raises(flaunay.UsageError, match="int32 in one dimension"):
            flaunay.triangulate_device(points, offsets=cl_array.to_device(queue, offsets))
    for points in np.zeros((4, 3)), np.zeros(4), np.zeros((2, 2, 2)):
        with pytest.raises(flaunay.UsageError, match="shape"):
            flaunay.triangulate_device(cl_array.to_device(queue, points))
    for dtype in np.int32, np.complex64, np.int64:
        with pytest.raises(flaunay.UsageError, match="float64 or float32"):
            flaunay.triangulate_device(cl_array.to_device(queue, np.zeros((4, 2), dtype)))
    for points in np.zeros((4, 2)), [[0, 1]], None, cl.Buffer(queue.context, 0, 64):
        with pytest.raises(TypeError, match="pyopencl.array.Array"):
            flaunay.triangulate_device(points, queue=queue)
    points = np.zeros((1000, 2))
    points[345, 1] = np.inf
    with pytest.raises(flaunay.InputError, match="point 345 is not finite"):
        flaunay.triangulate_device(cl_array.to_device(queue, points))


def test_queues(random, context, queue):
    points = random.random((1000, 2))
    array, expected = cl_array.to_device(queue, points), flaunay.triangulate(points, halfedges=True)
    with pytest.raises(flaunay.UsageError, match="another context"):
        flaunay.triangulate_device(array, queue=cl.CommandQueue(cl.Context(context.devices)))
    with pytest.raises(TypeError, match="CommandQueue"):
        flaunay.triangulate_device(array, queue=context)
    queue.finish()
    lonely = array.with_queue(None)
    with pytest.raises(flaunay.UsageError, match="no queue"):
        flaunay.triangulate_device(lonely)
    for properties in 0, OUT_OF_ORDER:
        other = cl.CommandQueue(context, properties=properties)
        for given in array, lonely:
            check_equal(flaunay.triangulate_device(given, queue=other, **ALL), expected)


@pytest.mark.parametrize("told", ["by wait_for", "by the array's events"])
def test_it_waits_for_what_it_is_told_to(random, queue, told):
    points = random.random((3000, 2))
    array = cl_array.zeros(queue, (3000, 2), np.float64)
    queue.finish()
    copied = copy_behind_a_gate(array, points)
    if told == "by wait_for":
        result = flaunay.triangulate_device(array, queue=queue, wait_for=[copied], **ALL)
    else:
        array.add_event(copied)
        result = flaunay.triangulate_device(array, queue=queue, **ALL)
    check_equal(result, flaunay.triangulate(points, halfedges=True))


def test_arrays_know_the_event_that_they_are_there_after(random, queue):
    points = cl_array.to_device(queue, random.random((100, 2)))
    result = flaunay.triangulate_device(points, **ALL)
    for array in points, result.triangles, *(getattr(result, name) for name in ALL):
        assert result.event in array.events
    queue.finish()
    assert is_only_held_here(result.event)


def test_kernels_work_on_results_that_outlive_what_they_came_from(random, queue):
    program = cl.Program(
        queue.context,
        "kernel void count(global const int* triangles, global int* degrees) {"
        "  atomic_inc(degrees + triangles[get_global_id(0)]);"
        "}",
    ).build()
    points = random.random((1000, 2))
    triangles = flaunay.triangulate_device(cl_array.to_device(queue, points)).triangles
    for _ in range(3):
        flaunay.triangulate_device(cl_array.to_device(queue, random.random((1000, 2))))
    gc.collect()
    degrees = cl_array.zeros(queue, 1000, np.int32)
    program.count(queue, (triangles.size,), None, triangles.data, degrees.data)
    expected = flaunay.triangulate(points).triangles
    assert np.array_equal(degrees.get(), np.bincount(expected.ravel(), minlength=1000))
    assert np.array_equal((triangles[5:10] + 1).get(), expected[5:10] + 1)
    references = triangles.base_data.get_info(cl.mem_info.REFERENCE_COUNT)
    assert references == 1, "the array alone holds the buffer"


def test_threads_with_queues_of_their_own(random, context):
    inputs = [random.random((n, 2)) for n in (10, 3000, 200, 1, 700)]

    def work(points):
        queue = cl.CommandQueue(context)
        return flaunay.triangulate_device(cl_array.to_device(queue, points), **ALL).get()

    with ThreadPoolExecutor(2) as pool:
        for points, result in zip(inputs, pool.map(work, inputs)):
            assert np.array_equal(result.triangles, flaunay.triangulate(points).triangles)


def test_a_context_is_forgotten_while_its_queue_waits_for_a_thread():
    # In a process of its own, since a deadlock would not end. More contexts come than are kept.
    run_python("""
        import threading

        import numpy as np
        import pyopencl as cl
        import pyopencl.array

        import flaunay
        from flaunay import _triangulators

        points = np.array([[0, 0], [4, 0], [0, 4.0]])


        def triangulate(**parts):
            queue = cl.CommandQueue(cl.create_some_context(interactive=False))
            array = cl.array.to_device(queue, points)
            result = flaunay.triangulate_device(array, **parts)
            assert result.triangles.get().tolist() == [[0, 1, 2]]
            return queue, array, result


        queue, array, result = triangulate(neighbors=True, hull=True, representatives=True)
        locator = result.locator()
        others = [triangulate() for _ in range(_triangulators._MOST_CONTEXTS - 1)]
        gate = cl.UserEvent(queue.context)
        cl.enqueue_marker(queue, wait_for=[gate])
        queue.flush()


        def open_gate():
            # Neither the interpreter's lock nor that of the triangulators may be held.
            flaunay.triangulate_device(others[-1][1])
            gate.set_status(cl.command_execution_status.COMPLETE)


        threading.Timer(1, open_gate).start()
        triangulate()
        assert len(_triangulators._by_handles) == _triangulators._MOST_CONTEXTS
        queue.finish()
        # A locator outlives the place of its context among them.
        assert locator.nearest(array).get().tolist() == [0, 1, 2]
    """)


# ---- Other surfaces


def check_surface(result, expected, *names):
    for name in ("places", "simplices", "neighbors", "representatives", *names):
        mine, other = getattr(result, name).get(), getattr(expected, name)
        assert mine.dtype == other.dtype and np.array_equal(mine, other), name
    assert np.array_equal(result.simplex_offsets, expected.simplex_offsets)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("period", [(0.7, 2), (1, None), (0.7, 2, 0.3)])
@pytest.mark.parametrize("offsets", [None, [0, 1, 1, 300, 1000]])
def test_points_on_a_torus_or_a_cylinder(random, queue, dtype, period, offsets):
    points = (random.random((1000, 2)) * 3).astype(dtype)
    given = cl_array.to_device(queue, points)
    found = flaunay.periodic_device(given, period, offsets=offsets)
    expected = flaunay.periodic(points, period, offsets)
    check_surface(found, expected, "corner_offsets")
    assert found.period == expected.period and given.events
    sizes = f"1000 points, {expected.nsimplex} triangles"
    assert repr(found) == f"<flaunay.DevicePeriodic: {sizes}>"


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("offsets", [None, [0, 7, 7, 30, 50]])
def test_points_on_a_sphere(random, queue, dtype, offsets):
    degrees = np.column_stack([random.uniform(-180, 180, 60), random.uniform(-90, 90, 60)])
    degrees[30, 1] = -90
    for points in degrees.astype(dtype), random.normal(size=(60, 3)).astype(dtype):
        found = flaunay.spherical_device(cl_array.to_device(queue, points)[10:], offsets=offsets)
        expected = flaunay.spherical(points[10:], offsets)
        check_surface(found, expected)
        sizes = f"50 points, {expected.nsimplex} triangles"
        assert repr(found) == f"<flaunay.DeviceSpherical: {sizes}>"


def test_surfaces_without_points_and_wrong_input(random, queue):
    none = cl_array.zeros(queue, (0, 2), np.float64)
    check_surface(flaunay.periodic_device(none, (1, 1)), flaunay.periodic(none.get(), (1, 1)))
    check_surface(flaunay.spherical_device(none), flaunay.spherical(none.get()))
    points = random.random((20, 2))
    given = cl_array.to_device(queue, points)
    for period in (0, 1), (1, -1), (None, None), (np.nan, 1), (1, 1, 1, 1):
        with pytest.raises(flaunay.UsageError, match="period"):
            flaunay.periodic_device(given, period)
    with pytest.raises(TypeError, match="points must be a pyopencl.array.Array"):
        flaunay.periodic_device(points, (1, 1), queue)
    points[7, 1] = np.inf
    with pytest.raises(flaunay.InputError, match="point 7 is not finite"):
        flaunay.periodic_device(cl_array.to_device(queue, points), (1, 1))
    with pytest.raises(flaunay.UsageError, match=r"\(n, 2\) or \(n, 3\)"):
        flaunay.spherical_device(cl_array.zeros(queue, (3, 4), np.float64))
    with pytest.raises(flaunay.InputError, match="point 0 is the vector 0"):
        flaunay.spherical_device(cl_array.zeros(queue, (3, 3), np.float64))
    with pytest.raises(TypeError, match="pyopencl.array.Array"):
        flaunay.spherical_device(np.zeros((3, 3)))
