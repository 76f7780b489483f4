"""What cannot be done is an exception that says what is wrong."""

import os
import pathlib
import pickle

import numpy as np
import pytest
from conftest import run_python

import flaunay

FOUR = np.array([[0, 0], [4, 0], [4, 3], [0, 4.0]])
CALLS = [flaunay.triangulate, flaunay.Delaunay]


def test_the_classes():
    for kind in flaunay.UsageError, flaunay.InputError:
        assert issubclass(kind, flaunay.Error) and issubclass(kind, ValueError)
    for kind in flaunay.DeviceError, flaunay.InternalError:
        assert issubclass(kind, flaunay.Error) and not issubclass(kind, ValueError)
    assert issubclass(flaunay.Error, RuntimeError)


def test_they_can_be_pickled():
    error = pickle.loads(pickle.dumps(flaunay.DeviceError("gone", -5, "clFinish")))
    assert (str(error), error.code, error.call) == ("gone", -5, "clFinish")


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize(
    "points, message",
    [
        ([], "shape"),
        (3.0, "shape"),
        ([1.0, 2.0], "shape"),
        (np.zeros((2, 2, 2)), "shape"),
        (np.zeros((5, 3)), "two-dimensional, but have 3 coordinates"),
        (np.zeros((5, 1)), "two-dimensional, but have 1 coordinates"),
        (np.zeros((5, 2), complex), "complex128"),
        (np.zeros((5, 2), object), "object"),
        ([["a", "b"]], "real numbers"),
        (np.zeros((5, 2), "M8[s]"), "datetime64"),
        ([[1, 2], [None, 3]], "object"),
        (np.ma.masked_array(FOUR, FOUR > 3), "masked"),
    ],
)
def test_points_that_are_none(call, points, message):
    with pytest.raises(flaunay.UsageError, match=message) as raised:
        call(points)
    assert (raised.value.code, raised.value.call) == (0, "")


@pytest.mark.parametrize("given", [-1, 2**64, 2**64 + 5, 1.5, "3"])
def test_counts_that_are_none(given):
    box = [(0, 0), (4, 0), (4, 4), (0, 4)]
    calls = [
        lambda: flaunay.relax(FOUR, box, iterations=given),
        lambda: flaunay.Delaunay(FOUR).nearest(FOUR, k=given),
        lambda: flaunay.refine(FOUR, max_area=1, most_points=given),
        lambda: flaunay.refine(FOUR, max_area=1, most_rounds=given),
        lambda: flaunay.refine(FOUR, max_area=1, smoothing_steps=given),
        lambda: flaunay.CloughTocherInterpolator(FOUR, FOUR[:, 0], maxiter=given),
        lambda: flaunay.triangulate_chunks(FOUR, triangles=True, chunk_points=given),
    ]
    for call in calls:
        with pytest.raises(flaunay.UsageError, match="must be an integer from"):
            call()


def test_indices_beyond_int32():
    with pytest.raises(flaunay.UsageError, match="triangles must be int32: 4294967298"):
        flaunay.refine(FOUR, triangles=[[0, 1, 2**32 + 2]], max_area=1)


@pytest.mark.parametrize("call", CALLS)
def test_ragged_lists(call):
    with pytest.raises(flaunay.UsageError, match="points are no array of numbers"):
        call([[0, 1], [2]])
    with pytest.raises(flaunay.UsageError, match="offsets are no array of numbers"):
        flaunay.triangulate(FOUR, offsets=[[0], [1, 4]])


@pytest.mark.parametrize("call", [*CALLS, flaunay.Voronoi, flaunay.alpha_shape, flaunay.refine])
def test_coordinates_in_other_shapes(call):
    x, y = FOUR.T
    with pytest.raises(flaunay.UsageError, match=r"take numpy.column_stack\(\[x, y\]\)"):
        call(x, y)
    with pytest.raises(flaunay.UsageError, match="4 coordinates; if its rows are x and y, take points.T"):
        call(FOUR.T)
    for path in "points.csv", pathlib.Path("points.csv"), b"points.csv":
        with pytest.raises(flaunay.UsageError, match="not text or a path: .*points.csv.* by numpy.loadtxt"):
            call(path)


TRI = flaunay.Delaunay(FOUR)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: flaunay.periodic(FOUR, 10), "period must be two lengths, in x and y, .* not 10"),
        (lambda: flaunay.periodic(FOUR, "ab"), "period must be real numbers"),
        (lambda: flaunay.to_places(FOUR, (1, 2, 3, 4)), r"two lengths, .* not \(1, 2, 3, 4\)"),
        (lambda: flaunay.triangulate_chunks(FOUR, triangles=True, period=10), "two lengths"),
        (lambda: flaunay.periodic(FOUR.T, (1, 1)), "take points.T"),
        (lambda: flaunay.weighted(FOUR[:, 0], FOUR[:, 1]), "numpy.column_stack"),
        (lambda: TRI.raster(np.zeros(4), 5), r"rows and columns, such as \(200, 300\), not 5"),
        (lambda: TRI.raster(np.zeros(4), (5, 2.5)), r"rows and columns, .* not \(5, 2.5\)"),
        (lambda: TRI.raster(np.zeros(4), (1, 2, 3)), r"rows and columns, .* not \(1, 2, 3\)"),
        (lambda: flaunay.griddata(FOUR[:, 0], FOUR[:, 1], [1, 2, 3, 4], FOUR), "method must be 'linear'"),
        (lambda: TRI.find_simplex(*FOUR.T), r"\(4,\); if x and y are two arrays, take numpy.column_stack"),
        (lambda: TRI.nearest(np.zeros((2, 3))), r"not \(2, 3\); if its rows are x and y, take xi.T"),
        (lambda: flaunay.spherical([1, 2, 3, 4]), "numpy.column_stack"),
        (lambda: flaunay.Delaunay(map(list, FOUR)), r"not an object of map: take list\(points\)"),
        (lambda: flaunay.Delaunay(flaunay.Delaunay(FOUR)), "not an object of Delaunay: take its points"),
        (lambda: flaunay.griddata([1, 2, 3], [1, 2, 3], [1.5]), "numpy.interp and SciPy interpolate on a line"),
        (lambda: flaunay.griddata([[1], [2]], [1, 2], [1.5]), "numpy.interp"),
        (lambda: flaunay.LinearInterpolator(FOUR.T, [1, 2, 3, 4]), "take points.T"),
        (lambda: flaunay.triangulate(FOUR, "lines.shp"), "segments are numbers, not text or a path"),
    ],
)
def test_wrong_calls_get_the_sentence_that_helps(call, message):
    with pytest.raises(flaunay.UsageError, match=message):
        call()


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_points_that_are_not_finite(call, dtype, bad):
    points = np.zeros((1000, 2), dtype)
    points[[700, 123], [0, 1]] = bad
    with pytest.raises(flaunay.InputError, match="point 123 is not finite"):
        call(points)


def test_magnitudes_that_differ_too_much():
    with pytest.raises(flaunay.InputError, match="point 1 has x.*point 3 has y"):
        flaunay.triangulate([[0, 0], [1e200, 0], [0, 1], [1, 1e-200]])


@pytest.mark.parametrize(
    "offsets, message",
    [
        ([], "integers"),
        (np.empty(0, int), "one number"),
        ([0], "end with 0, but there are 4"),
        ([0, 3], "end with 3, but there are 4"),
        ([0, 5], "end with 5, but there are 4"),
        ([1, 4], "begin with 0"),
        ([0, 3, 2, 4], "not decrease"),
        ([0, -1, 4], "not decrease"),
        ([0.0, 4.0], "integers"),
        ([[0, 4]], "one dimension"),
        (4, "one dimension"),
        ("04", "not text"),
    ],
)
@pytest.mark.parametrize("mode", ["blocks", "dwyer"])
def test_offsets_that_are_none(offsets, message, mode):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.triangulate(FOUR, offsets=offsets, mode=mode)


def test_modes():
    with pytest.raises(flaunay.UsageError, match="no mode 'fast'; there are blocks, flattened"):
        flaunay.triangulate(FOUR, mode="fast")
    for mode in None, 3, ["dwyer"], b"dwyer":
        with pytest.raises(flaunay.UsageError, match="no mode .*; there are blocks, flattened"):
            flaunay.triangulate(FOUR, mode=mode)
    with pytest.raises(flaunay.UsageError, match="takes no device"):
        flaunay.triangulate(FOUR, mode="dwyer", device="#0")


@pytest.mark.parametrize("call", CALLS)
def test_unknown_devices(call):
    with pytest.raises(flaunay.DeviceError, match="no such device"):
        call(FOUR, device="no such device")
    with pytest.raises(flaunay.DeviceError, match="#99"):
        call(FOUR, device="#99")
    with pytest.raises(TypeError, match="device must be a string"):
        call(FOUR, device=0)


def test_a_device_that_is_unknown_to_the_environment(monkeypatch):
    monkeypatch.setenv("FLAUNAY_DEVICE", "no such device")
    with pytest.raises(flaunay.DeviceError, match="FLAUNAY_DEVICE"):
        flaunay.triangulate(FOUR)
    assert len(flaunay.triangulate(FOUR, device="#0").triangles) == 2


def test_a_device_without_fp64():
    library = os.environ.get("FLAUNAY_TEST_NO_FP64")
    if not library:
        pytest.skip("FLAUNAY_TEST_NO_FP64 does not name the library that hides fp64")
    assert os.path.exists(library)
    run_python(
        """
        import flaunay
        assert not any(device["fp64"] for device in flaunay.devices())
        assert all(device["fixed_point"] for device in flaunay.devices())
        points = [[0, 0], [1, 0], [0, 1]]
        assert len(flaunay.triangulate(points, mode="dwyer").triangles) == 1
        assert len(flaunay.triangulate(points).triangles) == 1
        mesh = flaunay.triangulate(points, device="#0")
        assert len(mesh.triangles) == 1
        assert mesh.statistics["note"] == ""
        assert mesh.statistics["device"] == flaunay.devices()[0]["name"]
        # The device takes coordinates whose bits span 62 binary places; the host takes more.
        mesh = flaunay.triangulate([*points, [2.0**80, 1]], device="#0")
        assert len(mesh.triangles) == 2
        assert mesh.statistics["device"] == "host"
        assert "fp64" in mesh.statistics["note"]
        assert len(flaunay.Voronoi(points, device="#0").vertices) == 1
        mesh = flaunay.triangulate(points, device="#0", mode="flattened")
        assert "fp64" in mesh.statistics["note"]
        """,
        # Python loads the module, and with it the loader of OpenCL, where a preloaded library does not look for it.
        LD_PRELOAD=f"{library} libOpenCL.so.1",
    )


def test_there_need_not_be_opencl(tmp_path):
    run_python(
        """
        import numpy as np
        import flaunay
        points = np.random.default_rng(1).random((20000, 2))
        mesh = flaunay.triangulate(points)
        assert len(mesh.triangles) > 39000 and mesh.statistics["device"] == "host"
        assert (flaunay.Delaunay(points).find_simplex(points[:100]) >= 0).all()
        assert len(flaunay.Voronoi(points).vertices) == len(mesh.triangles)
        for call in flaunay.devices, lambda: flaunay.triangulate(points, device="#0"):
            try:
                call()
            except flaunay.DeviceError as error:
                assert "no OpenCL platform" in str(error), error
            else:
                raise AssertionError("no error")
        """,
        OCL_ICD_VENDORS=str(tmp_path),
    )
