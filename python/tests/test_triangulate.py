"""flaunay.triangulate: types, layouts, sets and modes."""

import gc
from fractions import Fraction

import numpy as np
import pytest
from conftest import as_set, check_neighbors

import flaunay

MODES = [mode["name"] for mode in flaunay.modes()]


@pytest.mark.parametrize(
    "dtype",
    [
        np.float64,
        np.float32,
        np.float16,
        np.longdouble,
        ">f8",
        ">f4",
        np.int8,
        np.uint16,
        np.int32,
        np.int64,
        np.uint64,
        bool,
    ],
)
def test_every_real_type(random, dtype):
    points = random.integers(0, 2 if dtype is bool else 100, (200, 2)).astype(dtype)
    mesh = flaunay.triangulate(points)
    expected = flaunay.triangulate(points.astype(np.float64))
    assert np.array_equal(mesh.triangles, expected.triangles)
    assert np.array_equal(mesh.representatives, expected.representatives)


def test_float32_is_not_rounded_nor_widened(random):
    points = random.random((1000, 2)).astype(np.float32)
    single, double = flaunay.triangulate(points), flaunay.triangulate(points.astype(np.float64))
    assert np.array_equal(single.triangles, double.triangles)
    assert flaunay.Delaunay(points).points.dtype == np.float32


@pytest.mark.parametrize(
    "dtype, value",
    [(np.int64, 2**53 + 1), (np.uint64, 2**64 - 1), (np.longdouble, np.longdouble(1) + 2.0**-60)],
)
def test_numbers_that_are_no_double_are_an_error_with_their_place(dtype, value):
    points = np.zeros((4, 2), dtype)
    points[2, 1] = value
    with pytest.raises(flaunay.UsageError, match=r"points\[2, 1\] = .* is not a float64"):
        flaunay.triangulate(points)


def layouts(points):
    spread = np.full((2 * len(points), 5), np.nan)
    spread[::2, 1:4:2] = points
    yield "every other row and column", spread[::2, 1:4:2]
    yield "Fortran order", np.asfortranarray(points)
    yield "backwards", points[::-1].copy()[::-1]
    yield "mirrored columns", points[:, ::-1].copy()[:, ::-1]
    yield "a list", points.tolist()
    read_only = points.copy()
    read_only.flags.writeable = False
    yield "read only", read_only
    memory = np.zeros(points.nbytes + 1, np.uint8)
    unaligned = memory[1:].view(points.dtype).reshape(points.shape)
    unaligned[:] = points
    assert not unaligned.flags.aligned
    yield "unaligned", unaligned
    yield "a subclass", points.view(np.matrix)


def test_every_layout(random):
    points = random.random((100, 2))
    expected = flaunay.triangulate(points)
    for name, given in layouts(points):
        assert np.array_equal(flaunay.triangulate(given).triangles, expected.triangles), name


def test_all_results(random):
    points = random.random((500, 2))
    mesh = flaunay.triangulate(points, halfedges=True)
    assert isinstance(mesh, flaunay.Triangulation)
    m = len(mesh.triangles)
    check_neighbors(mesh.triangles, mesh.neighbors)
    assert mesh.halfedges.shape == (3 * m,) and mesh.halfedges.dtype == np.int32
    back = mesh.halfedges >= 0
    assert np.array_equal(mesh.halfedges[mesh.halfedges[back]], np.flatnonzero(back))
    # Halfedge 3 t + k begins at corner k, and so ends where the one that goes back begins.
    begins = mesh.triangles.ravel()
    ends = mesh.triangles[:, [1, 2, 0]].ravel()
    assert np.array_equal(begins[mesh.halfedges[back]], ends[back])
    assert mesh.triangle_offsets.tolist() == [0, m] and mesh.triangle_offsets.dtype == np.int64
    assert mesh.hull_offsets.tolist() == [0, len(mesh.hull)]
    assert mesh.representatives.tolist() == list(range(500))
    assert mesh.statistics["points"] == 500 and mesh.statistics["triangles"] == m
    assert set(mesh.statistics["phases"]) and mesh.statistics["device"]


def test_what_is_not_asked_for_is_none(random):
    mesh = flaunay.triangulate(random.random((10, 2)), neighbors=False)
    assert mesh.neighbors is None and mesh.halfedges is None and mesh.areas is None


def exact_areas(points, triangles):
    """The nearest floats: Python rounds a quotient of integers correctly."""
    exact = [[Fraction(float(x)) for x in point] for point in points]
    areas = []
    for a, b, c in ([exact[i] for i in row] for row in triangles):
        areas.append(((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2)
    return [float(area) for area in areas]


@pytest.mark.parametrize("scale", [1, 1e-150, 1e150, 3e-161])
def test_areas_are_rounded_correctly(random, scale):
    points = np.concatenate([random.random((200, 2)), random.integers(0, 9, (100, 2)) / 8]) * scale
    mesh = flaunay.triangulate(points, areas=True)
    assert mesh.areas.dtype == np.float64
    expected = exact_areas(points, mesh.triangles)
    assert mesh.areas.tolist() == expected
    tri = flaunay.Delaunay(points)
    assert tri.areas.tolist() == exact_areas(points, tri.simplices)
    out = np.empty(2 * len(points))
    written = flaunay.triangulate(points, areas=True, out={"areas": out})
    assert written.areas.base is out and written.areas.tolist() == expected
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * scale
    crossing = flaunay.triangulate(square, segments=[[0, 2], [1, 3]], crossings="split")
    assert crossing.areas.tolist() == exact_areas(crossing.points, crossing.triangles)
    assert len(crossing.areas) == 4


def test_results_are_plain_arrays_that_keep_their_memory(random):
    points = random.random((2000, 2))
    triangles = flaunay.triangulate(points).triangles
    before = triangles.copy()
    for _ in range(5):
        flaunay.triangulate(random.random((2000, 2)))
    gc.collect()
    assert np.array_equal(triangles, before)
    assert (
        type(triangles) is np.ndarray and triangles.flags.writeable and triangles.flags.c_contiguous
    )
    triangles[0] = 7


def test_the_same_input_gives_the_same_bytes(random):
    points = random.random((3000, 2))
    first, second = (flaunay.triangulate(points, halfedges=True) for _ in range(2))
    for name in "triangles", "neighbors", "halfedges", "hull", "representatives":
        assert np.array_equal(getattr(first, name), getattr(second, name)), name


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_every_mode_gives_the_same_triangles(random, mode, dtype):
    points = random.random((400, 2)).astype(dtype)
    expected = flaunay.triangulate(points)
    mesh = flaunay.triangulate(points, mode=mode, halfedges=True, areas=True)
    assert mesh.areas.tolist() == exact_areas(points, mesh.triangles)
    assert as_set(mesh.triangles) == as_set(expected.triangles)
    assert np.array_equal(mesh.hull, expected.hull)
    check_neighbors(mesh.triangles, mesh.neighbors)


@pytest.mark.parametrize("mode", MODES)
def test_many_sets(random, mode):
    sizes = [3, 0, 1, 50, 2, 0, 7, 200]
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    points = random.random((offsets[-1], 2))
    mesh = flaunay.triangulate(points, offsets=offsets, mode=mode)
    assert len(mesh.triangle_offsets) == len(mesh.hull_offsets) == len(offsets)
    for s in range(len(sizes)):
        alone = flaunay.triangulate(points[offsets[s] : offsets[s + 1]])
        triangles = mesh.triangles[mesh.triangle_offsets[s] : mesh.triangle_offsets[s + 1]]
        hull = mesh.hull[mesh.hull_offsets[s] : mesh.hull_offsets[s + 1]]
        assert as_set(triangles - offsets[s]) == as_set(alone.triangles)
        assert np.array_equal(hull - offsets[s], alone.hull)


@pytest.mark.parametrize("offsets", [[0, 5, 10], (0, 5, 10), range(0, 11, 5), np.uint8([0, 5, 10])])
def test_offsets_of_any_integer_type(random, offsets):
    mesh = flaunay.triangulate(random.random((10, 2)), offsets=offsets)
    assert len(mesh.triangle_offsets) == 3


def test_no_sets_at_all():
    mesh = flaunay.triangulate(np.empty((0, 2)), offsets=[0])
    assert mesh.triangle_offsets.tolist() == [0] and mesh.triangles.shape == (0, 3)


def test_coordinates_of_every_magnitude(random):
    points = random.random((200, 2))
    expected = flaunay.triangulate(points).triangles
    for exponent in -900, -300, 300, 900:
        assert np.array_equal(flaunay.triangulate(points * 2.0**exponent).triangles, expected)


def test_a_device_by_number_and_by_name(random):
    points = random.random((20, 2))
    usable = [(k, device) for k, device in enumerate(flaunay.devices()) if device["fp64"]]
    for k, device in usable:
        mesh = flaunay.triangulate(points, device=f"#{k}")
        assert mesh.statistics["device"] == device["name"]
    assert flaunay.triangulate(points, device=usable[0][1]["name"]).statistics["points"] == 20


def test_the_version():
    assert flaunay.__version__.count(".") == 2


def test_results_are_short_in_print(random):
    points = random.random((100000, 2))
    mesh = flaunay.triangulate(points)
    hull, triangles = len(mesh.hull), len(mesh.triangles)
    sizes = f"100000 points, {triangles} triangles, {hull} hull vertices"
    assert repr(mesh) == f"<flaunay.Triangulation: {sizes}>"
    assert repr(flaunay.Delaunay(points)) == f"<flaunay.Delaunay: {sizes}>"
    assert (
        repr(flaunay.Voronoi(points)) == f"<flaunay.Voronoi: 100000 points, {triangles} vertices>"
    )
    two = flaunay.triangulate([[0, 0], [1, 0], [0, 1], [5, 5]], offsets=[0, 3, 4])
    assert repr(two) == "<flaunay.Triangulation: 4 points, 1 triangle, 4 hull vertices, 2 sets>"


def test_results_are_equal_to_themselves_alone():
    mesh, other = (flaunay.triangulate([[0, 0], [1, 0], [0, 1]]) for _ in range(2))
    assert mesh == mesh and mesh != other and len({mesh, other}) == 2
