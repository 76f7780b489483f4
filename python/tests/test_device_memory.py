"""flaunay.triangulate_device: from pyopencl arrays to pyopencl arrays."""

import gc
import subprocess
import sys

import numpy as np
import pytest
from conftest import as_set

import flaunay

cl = pytest.importorskip("pyopencl")
cl_array = pytest.importorskip("pyopencl.array")

ALL = {"neighbors": True, "halfedges": True, "hull": True, "representatives": True}
OUT_OF_ORDER = cl.command_queue_properties.OUT_OF_ORDER_EXEC_MODE_ENABLE


@pytest.fixture(scope="module")
def context():
    return cl.create_some_context(interactive=False)


@pytest.fixture
def queue(context):
    return cl.CommandQueue(context)


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
@pytest.mark.parametrize("n", [1, 2, 3, 100, 5000])
def test_the_results_are_those_of_triangulate(random, queue, dtype, n):
    points = random.random((n, 2)).astype(dtype)
    result = flaunay.triangulate_device(cl_array.to_device(queue, points), **ALL)
    assert isinstance(result, flaunay.DeviceTriangulation)
    check_equal(result, flaunay.triangulate(points, halfedges=True))


def test_a_result_is_short_in_print(random, queue):
    result = flaunay.triangulate_device(cl_array.to_device(queue, random.random((100, 2))))
    sizes = f"100 points, {result.triangle_offsets[-1]} triangles, {result.hull_offsets[-1]} hull vertices"
    assert repr(result) == f"<flaunay.DeviceTriangulation: {sizes}>"
    assert result == result


@pytest.mark.parametrize("wait_for", [[None], 3, ["event"], [[]]])
def test_what_is_no_event_to_wait_for(random, queue, wait_for):
    points = cl_array.to_device(queue, random.random((100, 2)))
    with pytest.raises(TypeError, match="wait_for must be a sequence of pyopencl.Event"):
        flaunay.triangulate_device(points, wait_for=wait_for)


def test_one_event_is_no_sequence(random, queue):
    points = cl_array.to_device(queue, random.random((100, 2)))
    with pytest.raises(TypeError, match="wait_for must be a sequence of pyopencl.Event"):
        flaunay.triangulate_device(points, wait_for=cl.enqueue_marker(queue))


def test_no_points_at_all(queue):
    result = flaunay.triangulate_device(cl_array.zeros(queue, (0, 2), np.float64), **ALL)
    check_equal(result, flaunay.triangulate(np.empty((0, 2)), halfedges=True))
    assert result.event is not None


def test_points_without_triangles(queue):
    points = np.array([[0, 0], [1, 1], [2, 2], [1, 1.0]])
    result = flaunay.triangulate_device(cl_array.to_device(queue, points), **ALL)
    check_equal(result, flaunay.triangulate(points, halfedges=True))


def test_what_is_not_asked_for_is_none(random, queue):
    result = flaunay.triangulate_device(cl_array.to_device(queue, random.random((100, 2))))
    assert result.triangles.shape == (int(result.triangle_offsets[-1]), 3)
    for name in ALL:
        assert getattr(result, name) is None
    with pytest.raises(flaunay.UsageError, match="hull and representatives"):
        result.get()


def test_points_and_results_stay_on_the_device(random, queue):
    points = cl_array.to_device(queue, random.random((100000, 2)))
    flaunay.triangulate_device(points, **ALL)
    statistics = flaunay.triangulate_device(points, **ALL).statistics
    assert statistics["bytes_to_host"] < 100000
    assert statistics["bytes_to_device"] < 100000


def test_a_buffer_by_an_array_over_it(random, queue):
    points = random.random((50, 2))
    flags = cl.mem_flags.READ_ONLY | cl.mem_flags.COPY_HOST_PTR
    buffer = cl.Buffer(queue.context, flags, hostbuf=points)
    array = cl_array.Array(queue, (50, 2), np.float64, data=buffer)
    check_equal(
        flaunay.triangulate_device(array, **ALL), flaunay.triangulate(points, halfedges=True)
    )


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_views_that_begin_later(random, queue, dtype):
    points = random.random((1000, 2)).astype(dtype)
    array = cl_array.to_device(queue, points)
    check_equal(
        flaunay.triangulate_device(array[17:900], **ALL),
        flaunay.triangulate(points[17:900], halfedges=True),
    )


def test_views_that_begin_within_a_point(random, queue):
    points = random.random(401)
    view = cl_array.to_device(queue, points)[1:].reshape(200, 2)
    with pytest.raises(
        flaunay.UsageError, match="8 bytes after.*no multiple of a point's 16 bytes"
    ):
        flaunay.triangulate_device(view)
    check_equal(
        flaunay.triangulate_device(view.copy(), **ALL),
        flaunay.triangulate(points[1:].reshape(200, 2), halfedges=True),
    )


def test_arrays_that_are_not_contiguous(random, queue):
    array = cl_array.to_device(queue, random.random((100, 2)))
    for given in array[::2], array[::-1], cl_array.to_device(queue, np.zeros((9, 3)))[:, :2]:
        with pytest.raises(flaunay.UsageError, match="contiguous"):
            flaunay.triangulate_device(given)
    with pytest.raises(flaunay.UsageError, match="contiguous"):
        flaunay.triangulate_device(cl_array.to_device(queue, np.asfortranarray(np.zeros((9, 2)))))


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


@pytest.mark.parametrize("on_device", [False, True])
@pytest.mark.parametrize(
    "offsets, message",
    [
        ([0, 3], "end with 3, but there are 4"),
        ([1, 4], "begin with 0"),
        ([0, 3, 2, 4], "not decrease"),
        ([0, -1, 4], "not decrease"),
    ],
)
def test_offsets_that_are_none(queue, on_device, offsets, message):
    points = cl_array.zeros(queue, (4, 2), np.float64)
    given = cl_array.to_device(queue, np.int32(offsets)) if on_device else offsets
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.triangulate_device(points, offsets=given)


def test_offsets_of_a_wrong_type_or_shape(queue):
    points = cl_array.zeros(queue, (4, 2), np.float64)
    for offsets in np.int64([0, 4]), np.int32([[0, 4]]), np.float32([0, 4]):
        with pytest.raises(flaunay.UsageError, match="int32 in one dimension"):
            flaunay.triangulate_device(points, offsets=cl_array.to_device(queue, offsets))


def test_points_of_a_wrong_type_or_shape(queue):
    for points in np.zeros((4, 3)), np.zeros(4), np.zeros((2, 2, 2)):
        with pytest.raises(flaunay.UsageError, match="shape"):
            flaunay.triangulate_device(cl_array.to_device(queue, points))
    for dtype in np.int32, np.complex64, np.int64:
        with pytest.raises(flaunay.UsageError, match="float64 or float32"):
            flaunay.triangulate_device(cl_array.to_device(queue, np.zeros((4, 2), dtype)))
    for points in np.zeros((4, 2)), [[0, 1]], None, cl.Buffer(queue.context, 0, 64):
        with pytest.raises(TypeError, match="pyopencl.array.Array"):
            flaunay.triangulate_device(points, queue=queue)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_points_that_are_not_finite(queue, bad):
    points = np.zeros((1000, 2))
    points[345, 1] = bad
    with pytest.raises(flaunay.InputError, match="point 345 is not finite"):
        flaunay.triangulate_device(cl_array.to_device(queue, points))


def test_a_queue_of_another_context(random, queue):
    other = cl.CommandQueue(cl.Context(queue.context.devices))
    points = cl_array.to_device(queue, random.random((10, 2)))
    with pytest.raises(flaunay.UsageError, match="another context"):
        flaunay.triangulate_device(points, queue=other)
    with pytest.raises(TypeError, match="CommandQueue"):
        flaunay.triangulate_device(points, queue=queue.context)


def test_points_without_a_queue(random, queue):
    points = cl_array.to_device(queue, random.random((10, 2)))
    queue.finish()
    lonely = points.with_queue(None)
    with pytest.raises(flaunay.UsageError, match="no queue"):
        flaunay.triangulate_device(lonely)
    assert len(flaunay.triangulate_device(lonely, queue=queue).triangles.get()) > 0


def test_queues_out_of_order_and_others_of_the_context(random, context, queue):
    points = random.random((3000, 2))
    expected = flaunay.triangulate(points, halfedges=True)
    array = cl_array.to_device(queue, points)
    for properties in 0, OUT_OF_ORDER:
        other = cl.CommandQueue(context, properties=properties)
        result = flaunay.triangulate_device(array, queue=other, **ALL)
        check_equal(result, expected)


@pytest.mark.parametrize("told", ["by wait_for", "by the array's events"])
def test_it_waits_for_what_it_is_told_to(random, context, queue, told):
    points = random.random((3000, 2))
    array = cl_array.zeros(queue, (3000, 2), np.float64)
    queue.finish()
    other = cl.CommandQueue(context)
    gate = cl.UserEvent(context)
    copied = cl.enqueue_copy(other, array.data, points, is_blocking=False, wait_for=[gate])

    import threading

    opener = threading.Timer(0.3, lambda: gate.set_status(cl.command_execution_status.COMPLETE))
    opener.start()
    if told == "by wait_for":
        result = flaunay.triangulate_device(array, queue=queue, wait_for=[copied], **ALL)
    else:
        array.add_event(copied)
        result = flaunay.triangulate_device(array, queue=queue, **ALL)
    opener.join()
    check_equal(result, flaunay.triangulate(points, halfedges=True))


def test_arrays_know_the_event_that_they_are_there_after(random, queue):
    points = cl_array.to_device(queue, random.random((100, 2)))
    result = flaunay.triangulate_device(points, **ALL)
    for array in points, result.triangles, *(getattr(result, name) for name in ALL):
        assert result.event in array.events
    queue.finish()
    assert result.event.get_info(cl.event_info.REFERENCE_COUNT) == 1


def test_results_outlive_what_they_came_from(random, queue):
    points = random.random((1000, 2))
    triangles = flaunay.triangulate_device(cl_array.to_device(queue, points)).triangles
    for _ in range(3):
        flaunay.triangulate_device(cl_array.to_device(queue, random.random((1000, 2))))
    gc.collect()
    assert np.array_equal(triangles.get(), flaunay.triangulate(points).triangles)
    references = triangles.base_data.get_info(cl.mem_info.REFERENCE_COUNT)
    assert references == 1, "the array alone holds the buffer"


def test_results_can_be_worked_on_in_place(random, queue):
    points = random.random((1000, 2))
    result = flaunay.triangulate_device(cl_array.to_device(queue, points), hull=True)
    expected = flaunay.triangulate(points)
    assert int(cl_array.max(result.triangles).get()) == 999
    assert np.array_equal((result.triangles[5:10] + 1).get(), expected.triangles[5:10] + 1)
    assert result.hull.size == len(expected.hull)


def test_sums_by_a_kernel_on_the_results(random, queue):
    program = cl.Program(
        queue.context,
        "kernel void count(global const int* triangles, global int* degrees) {"
        "  atomic_inc(degrees + triangles[get_global_id(0)]);"
        "}",
    ).build()
    points = random.random((1000, 2))
    result = flaunay.triangulate_device(cl_array.to_device(queue, points))
    degrees = cl_array.zeros(queue, 1000, np.int32)
    program.count(queue, (result.triangles.size,), None, result.triangles.data, degrees.data)
    expected = np.bincount(flaunay.triangulate(points).triangles.ravel(), minlength=1000)
    assert np.array_equal(degrees.get(), expected)


def test_contexts_come_and_go(random):
    points = random.random((50, 2))
    expected = as_set(flaunay.triangulate(points).triangles)
    for _ in range(12):
        queue = cl.CommandQueue(cl.create_some_context(interactive=False))
        result = flaunay.triangulate_device(cl_array.to_device(queue, points))
        assert as_set(result.triangles.get()) == expected


def test_threads_with_queues_of_their_own(random, context):
    from concurrent.futures import ThreadPoolExecutor

    inputs = [random.random((n, 2)) for n in (10, 3000, 200, 1, 700)] * 3

    def work(points):
        queue = cl.CommandQueue(context)
        result = flaunay.triangulate_device(cl_array.to_device(queue, points), **ALL)
        return result.get()

    with ThreadPoolExecutor(2) as pool:
        for points, result in zip(inputs, pool.map(work, inputs)):
            assert np.array_equal(result.triangles, flaunay.triangulate(points).triangles)


def test_a_context_is_forgotten_while_its_queue_waits_for_a_thread():
    # In a process of its own, since a deadlock would not end.
    program = """if True:
        import threading

        import numpy as np
        import pyopencl as cl
        import pyopencl.array

        import flaunay
        from flaunay import _triangulators

        points = np.array([[0, 0], [4, 0], [0, 4.0]])


        def triangulate():
            queue = cl.CommandQueue(cl.create_some_context(interactive=False))
            array = cl.array.to_device(queue, points)
            result = flaunay.triangulate_device(array)
            assert result.triangles.get().tolist() == [[0, 1, 2]]
            return queue, array


        queue, array = triangulate()
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
    """
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("period", [(1, 1), (0.7, 2), (1, None)])
@pytest.mark.parametrize("offsets", [None, [0, 1, 1, 300, 2000]])
def test_points_on_a_torus_or_a_cylinder(random, queue, dtype, period, offsets):
    points = (random.random((2000, 2)) * 3).astype(dtype)
    given = cl_array.to_device(queue, points)
    found = flaunay.periodic_device(given, period, offsets=offsets)
    expected = flaunay.periodic(points, period, offsets)
    for name in "places", "simplices", "corner_offsets", "neighbors", "representatives":
        mine, other = getattr(found, name).get(), getattr(expected, name)
        assert mine.dtype == other.dtype and np.array_equal(mine, other), name
    assert found.period == expected.period
    assert np.array_equal(found.simplex_offsets, expected.simplex_offsets)
    sizes = f"2000 points, {expected.nsimplex} triangles"
    assert repr(found) == f"<flaunay.DevicePeriodic: {sizes}>"
    assert given.events


def test_a_torus_of_no_points_and_wrong_input(random, queue):
    none = flaunay.periodic_device(cl_array.zeros(queue, (0, 2), np.float64), (1, 1))
    assert none.simplices.shape == (0, 3) and none.places.shape == (0, 2)
    points = random.random((20, 2))
    given = cl_array.to_device(queue, points)
    for period in (0, 1), (1, -1), (None, None), (np.nan, 1), (1, 1, 1):
        with pytest.raises(flaunay.UsageError, match="period"):
            flaunay.periodic_device(given, period)
    with pytest.raises(TypeError, match="points must be a pyopencl.array.Array"):
        flaunay.periodic_device(points, (1, 1), queue)
    points[7, 1] = np.inf
    with pytest.raises(flaunay.InputError, match="point 7 is not finite"):
        flaunay.periodic_device(cl_array.to_device(queue, points), (1, 1))
