"""flaunay.spherical_device: from pyopencl arrays to pyopencl arrays."""

import numpy as np
import pytest

import flaunay

cl = pytest.importorskip("pyopencl")
cl_array = pytest.importorskip("pyopencl.array")


@pytest.fixture(scope="module")
def queue():
    return cl.CommandQueue(cl.create_some_context(interactive=False))


def degrees(random, n):
    return np.column_stack([random.uniform(-180, 180, n), random.uniform(-90, 90, n)])


def check_equal(result, expected):
    for name in "places", "simplices", "neighbors", "representatives":
        mine, other = getattr(result, name).get(), getattr(expected, name)
        assert mine.dtype == other.dtype and np.array_equal(mine, other), name
    assert np.array_equal(result.simplex_offsets, expected.simplex_offsets)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("n", [0, 1, 3, 1000])
def test_the_results_are_those_of_spherical(random, queue, dtype, n):
    for points in degrees(random, n).astype(dtype), random.normal(size=(n, 3)).astype(dtype):
        check_equal(
            flaunay.spherical_device(cl_array.to_device(queue, points)), flaunay.spherical(points)
        )


def test_sets_and_the_pole(random, queue):
    points = degrees(random, 50)
    for latitude in points[20, 1], -90:
        points[20, 1] = latitude
        offsets = [0, 7, 7, 30, 50]
        result = flaunay.spherical_device(cl_array.to_device(queue, points), offsets=offsets)
        check_equal(result, flaunay.spherical(points, offsets))


def test_views_and_print(random, queue):
    points = cl_array.to_device(queue, random.normal(size=(30, 3)))
    result = flaunay.spherical_device(points[10:])
    check_equal(result, flaunay.spherical(points.get()[10:]))
    assert repr(result) == "<flaunay.DeviceSpherical: 20 points, 36 triangles>"


def test_what_is_wrong_is_named(queue):
    with pytest.raises(flaunay.UsageError, match=r"\(n, 2\) or \(n, 3\)"):
        flaunay.spherical_device(cl_array.zeros(queue, (3, 4), np.float64))
    with pytest.raises(flaunay.InputError, match="point 0 is the vector 0"):
        flaunay.spherical_device(cl_array.zeros(queue, (3, 3), np.float64))
    with pytest.raises(TypeError, match="pyopencl.array.Array"):
        flaunay.spherical_device(np.zeros((3, 3)))
