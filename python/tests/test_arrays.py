"""Points, values and queries as other libraries have them, and results in the caller's arrays."""

import contextlib

import numpy as np
import pytest

import flaunay


@pytest.fixture
def points(random):
    return random.random((50, 2))


def same(given, points):
    """Whether the triangles of what is given are those of the points."""
    expected = flaunay.triangulate(points)
    tri = flaunay.Delaunay(given)
    assert np.array_equal(tri.points, points)
    return all(
        np.array_equal(found, expected.triangles)
        for found in (flaunay.triangulate(given).triangles, tri.simplices)
    )


class Exporter:
    """What an array of another library has, over an array of NumPy: DLPack alone, of any device."""

    def __init__(self, array, device=(1, 0)):
        self.array, self.device = array, device

    def __dlpack__(self, **keywords):
        return self.array.__dlpack__(**keywords)

    def __dlpack_device__(self):
        return self.device


@contextlib.contextmanager
def no_copy_of(points):
    """Fails if the library is given anything but the memory of the points."""
    with pytest.MonkeyPatch.context() as patch:
        seen = []
        triangulate = flaunay._calls.triangulate

        def watched(triangulator, given, *rest):
            seen.append(np.shares_memory(given, points))
            return triangulate(triangulator, given, *rest)

        patch.setattr(flaunay._calls, "triangulate", watched)
        yield
    assert seen and all(seen)


# ---- NumPy


def test_arrays_of_numpy(points, tmp_path):
    read_only = points.copy()
    read_only.flags.writeable = False
    assert same(read_only, points)
    assert same(np.asfortranarray(points), points)
    assert same(np.repeat(np.repeat(points, 3, axis=0), 2, axis=1)[::3, ::2], points)
    assert same(points[::-1], points[::-1].copy())
    assert same(points[:, ::-1].copy()[:, ::-1], points) and same(points.view(np.matrix), points)
    assert same(points.tolist(), points) and same(list(points), points)
    assert same(tuple(map(tuple, points)), points)
    np.save(tmp_path / "points.npy", points)
    mapped = np.load(tmp_path / "points.npy", mmap_mode="r")
    assert same(mapped, points)
    with no_copy_of(mapped):
        flaunay.triangulate(mapped)
    unaligned = np.zeros(points.nbytes + 1, np.uint8)[1:].view(np.float64).reshape(-1, 2)
    unaligned[:] = points
    assert same(unaligned, points)


@pytest.mark.parametrize("dtype", [">f8", "<f8", ">f4", "<f4", "f2"])
def test_floats_of_any_order_and_size(points, dtype):
    given = points.astype(dtype)
    assert same(given, given.astype(np.float64))
    size = np.dtype(dtype).itemsize
    expected = np.float32 if size == 4 else np.float64
    assert flaunay.Delaunay(given).points.dtype == expected


@pytest.mark.parametrize("dtype", ["i1", "u1", ">i2", "i4", "u4", "i8", ">u8", "?", "longdouble"])
def test_other_numbers(random, dtype):
    given = random.integers(0, 100, (50, 2)).astype(dtype)
    assert same(given, given.astype(np.float64))


def test_integers_are_exact_to_two_to_the_53(random):
    points = 2**53 - random.integers(0, 1000, (50, 2))
    assert same(points, points.astype(np.float64)) and same(points.tolist(), points)
    points[7, 1] = 2**53 + 1
    for given in points, points.tolist(), points.astype(np.uint64):
        with pytest.raises(
            flaunay.UsageError, match=r"points\[7, 1\] = 9007199254740993 .*rounded"
        ):
            flaunay.triangulate(given)
    for too_large in 2**64, 10**30:
        with pytest.raises(flaunay.UsageError, match="real numbers, not object"):
            flaunay.triangulate([[0, 0], [too_large, 1], [0, 1]])


def test_masked_arrays(points):
    masked = np.ma.masked_array(points, np.zeros_like(points, bool))
    assert same(masked, points) and same(np.ma.masked_array(points), points)
    masked[3, 1] = np.ma.masked
    with pytest.raises(
        flaunay.UsageError, match=r"points\[3, 1\] is masked: leave masked ones out"
    ):
        flaunay.Delaunay(masked)
    # As the message says.
    assert same(masked[~masked.mask.any(axis=1)], np.delete(points, 3, axis=0))
    tri = flaunay.Delaunay(points)
    with pytest.raises(flaunay.UsageError, match=r"values\[3\] is masked"):
        tri.interpolate(masked[:, 1], points)
    with pytest.raises(flaunay.UsageError, match=r"xi\[3, 1\] is masked"):
        tri.find_simplex(masked)


# ---- DLPack


def test_exporters_of_dlpack(points):
    with no_copy_of(points):
        assert np.array_equal(
            flaunay.triangulate(Exporter(points)).triangles, flaunay.triangulate(points).triangles
        )
    assert same(Exporter(points.astype(np.float32)), points.astype(np.float32))
    assert same(Exporter(np.asfortranarray(points)), points)


@pytest.mark.parametrize(
    "kind, name", [(2, "CUDA"), (4, "OpenCL"), (8, "Metal"), (10, "ROCm"), (99, "a device")]
)
def test_exporters_of_other_memory(points, kind, name):
    with pytest.raises(flaunay.UsageError, match=f"memory of .*{name}.*: copy them to the host"):
        flaunay.triangulate(Exporter(points, (kind, 0)))


def test_arrays_of_pyopencl(points):
    array = pytest.importorskip("pyopencl.array")
    cl = pytest.importorskip("pyopencl")
    with contextlib.ExitStack() as stack:
        try:
            queue = cl.CommandQueue(cl.create_some_context(interactive=False))
        except cl.Error:
            pytest.skip("there is no OpenCL device")
        given = array.to_device(queue, points)

        class Tagged(array.Array):
            """As other packages extend these arrays."""

        tagged = Tagged(queue, points.shape, points.dtype, data=given.data)
        for one in given, tagged:
            with pytest.raises(flaunay.UsageError, match="call triangulate_device"):
                flaunay.triangulate(one)
        assert flaunay.DynamicTriangulation(tagged).point_count == len(points)


def test_tensors_of_torch(points):
    torch = pytest.importorskip("torch")
    tensor = torch.from_numpy(points)
    assert same(tensor, points)
    with no_copy_of(points):
        flaunay.triangulate(tensor)
    with pytest.raises(flaunay.UsageError, match="requires grad"):
        flaunay.triangulate(tensor.clone().requires_grad_())


# ---- Tables


def test_frames_of_pandas(points):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(points, columns=["x", "y"])
    assert same(frame, points)
    with no_copy_of(points):
        flaunay.triangulate(pandas.DataFrame(points, copy=False))
    table = frame.assign(name="a", height=points.sum(axis=1))
    assert same(table[["x", "y"]], points)
    assert same(table[["x", "y"]].astype("float32"), points.astype(np.float32))
    assert same(table[["x", "y"]].astype("Float64"), points)
    tri = flaunay.Delaunay(table[["x", "y"]])
    assert np.array_equal(tri.interpolate(table.height, table[["x", "y"]]), table.height)
    for kind in "object", "string":
        with pytest.raises(flaunay.UsageError, match="points have the column 'name', which has no numbers"):
            flaunay.Delaunay(table.astype({"name": kind, "y": "Float64"}))
    missing = table[["x", "y"]].astype("Float64")
    missing.loc[4, "y"] = pandas.NA
    with pytest.raises(flaunay.InputError, match="point 4 is not finite"):
        flaunay.Delaunay(missing)


def test_frames_of_polars(points):
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame({"x": points[:, 0], "y": points[:, 1], "height": points.sum(axis=1)})
    assert same(frame.select("x", "y"), points)
    tri = flaunay.Delaunay(points)
    assert np.array_equal(tri.interpolate(frame["height"], points), points.sum(axis=1))
    with pytest.raises(flaunay.UsageError, match="the column 'name', which has no numbers"):
        flaunay.Delaunay(frame.with_columns(polars.lit("a").alias("name")))
    missing = polars.DataFrame({"x": [0.0, 1.0, None], "y": [0.0, 0.0, 1.0]})
    with pytest.raises(flaunay.InputError, match="point 2 is not finite"):
        flaunay.Delaunay(missing)
    if polars.__version__.startswith("0."):
        return  # polars.Array was another
    column = polars.Series(points, dtype=polars.Array(polars.Float64, 2))
    assert same(column, points)


def test_tables_and_columns_of_arrow(points):
    arrow = pytest.importorskip("pyarrow")
    flat = arrow.array(points.ravel())
    column = arrow.FixedSizeListArray.from_arrays(flat, 2)
    assert same(column, points)
    with no_copy_of(np.asarray(flat)):
        flaunay.triangulate(column)
    assert same(arrow.chunked_array([column[:20], column[20:]]), points)
    assert same(column[10:30], points[10:30])
    table = arrow.table({"x": points[:, 0], "y": points[:, 1], "height": points.sum(axis=1)})
    assert same(table.select(["x", "y"]), points)
    tri = flaunay.Delaunay(points)
    for heights in table["height"], table["height"].combine_chunks():
        assert np.array_equal(tri.interpolate(heights, points), points.sum(axis=1))
    with pytest.raises(flaunay.UsageError, match="the column 'name', which has no numbers"):
        flaunay.Delaunay(arrow.table({"x": points[:, 0], "name": ["a"] * 50}))
    # Columns that are no arrays for DLPack.
    tri = flaunay.Delaunay([[0, 0], [1, 0], [0, 1]])
    for kind in arrow.array, lambda numbers: arrow.chunked_array([numbers]):
        for numbers in [True, False, True], [1, None, 0]:
            assert tri.interpolate(kind(numbers), [[0, 0]]) == 1
        for others in [True, None, False], ["a", "b", "c"]:
            with pytest.raises(flaunay.UsageError, match="values must be real numbers, not object"):
                tri.interpolate(kind(others), [[0, 0]])
    for nulls in [[0.0, 1.0], None, [1.0, 1.0]], [[0.0, 1.0], [0.0, None], [1.0, 1.0]]:
        with pytest.raises(flaunay.UsageError, match="points have nulls"):
            flaunay.Delaunay(arrow.array(nulls, arrow.list_(arrow.float64(), 2)))


# ---- Results in the caller's arrays


def room_for(n):
    return {
        "triangles": np.full((2 * n, 3), -7, np.int32),
        "neighbors": np.full((2 * n, 3), -7, np.int32),
        "halfedges": np.full(6 * n, -7, np.int32),
        "hull": np.full(n, -7, np.int32),
        "representatives": np.full(n, -7, np.int32),
    }


@pytest.mark.parametrize("mode", ["blocks", "dwyer"])
def test_results_in_the_callers_arrays(points, mode):
    expected = flaunay.triangulate(points, halfedges=True, mode=mode)
    out = room_for(len(points))
    mesh = flaunay.triangulate(points, halfedges=True, mode=mode, out=out)
    for name, array in out.items():
        found = getattr(mesh, name)
        assert np.array_equal(found, getattr(expected, name)) and np.shares_memory(found, array)
        assert (array[len(found) :] == -7).all()
    # Some of them, not contiguous.
    hull = np.zeros(2 * len(points), np.int32)
    mesh = flaunay.triangulate(points, out={"hull": hull[::2]}, mode=mode)
    assert np.array_equal(hull[::2][: len(mesh.hull)], expected.hull)
    assert np.array_equal(mesh.triangles, expected.triangles)


def test_results_in_an_earlier_result(points, random):
    first = flaunay.triangulate(points)
    other = random.permutation(points)
    expected = flaunay.triangulate(other)
    again = flaunay.triangulate(other, out=first)
    assert np.shares_memory(again.triangles, first.triangles)
    assert np.array_equal(again.triangles, expected.triangles)


@pytest.mark.parametrize(
    "out, message",
    [
        (
            {"triangles": np.zeros((3, 3), np.int32)},
            r"out\['triangles'\] has 3 rows, but there are",
        ),
        ({"triangles": np.zeros((99, 3), np.int64)}, r"int32 of shape \(..., 3\), not int64"),
        ({"triangles": np.zeros(300, np.int32)}, r"int32 of shape \(..., 3\), not int32 of shape"),
        ({"hull": [0] * 99}, "must be an array of int32 .*, not list"),
        ({"hull": np.frombuffer(bytes(400), np.int32)}, "out.'hull'. is read-only"),
        ({"halfedges": np.zeros(600, np.int32)}, "out has halfedges, but halfedges=False"),
        ({"edges": np.zeros(600, np.int32)}, "out has 'edges'; there are triangles, neighbors"),
    ],
)
def test_arrays_that_results_cannot_be_written_to(points, out, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.triangulate(points, out=out)


def test_nothing_is_written_where_one_array_is_too_small(points):
    out = {**room_for(len(points)), "hull": np.zeros(2, np.int32)}
    with pytest.raises(flaunay.UsageError, match=r"out\['hull'\] has 2 rows"):
        flaunay.triangulate(points, halfedges=True, out=out)
    assert (out["triangles"] == -7).all()
