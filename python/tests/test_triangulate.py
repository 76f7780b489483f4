"""flaunay.triangulate: types, layouts, sets and modes."""

import gc

import numpy as np
import pytest
from conftest import areas, as_set, check_neighbors

import flaunay

MODES = [mode["name"] for mode in flaunay.modes()]


@pytest.mark.parametrize(
    "dtype, value",
    [(np.int64, 2**53 + 1), (np.uint64, 2**64 - 1), (np.longdouble, np.longdouble(1) + 2.0**-60)],
)
def test_numbers_that_are_no_double_are_an_error_with_their_place(dtype, value):
    points = np.zeros((4, 2), dtype)
    points[2, 1] = value
    with pytest.raises(flaunay.UsageError, match=r"points\[2, 1\] = .* is not a float64"):
        flaunay.triangulate(points)


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


def test_areas(random):
    points = random.integers(0, 9, (300, 2)) / 8
    mesh, tri = flaunay.triangulate(points, areas=True), flaunay.Delaunay(points)
    assert mesh.areas.dtype == np.float64
    # Of such numbers, the products are exact.
    assert np.array_equal(mesh.areas, areas(points, mesh.triangles) / 2)
    assert np.array_equal(tri.areas, areas(points, tri.simplices) / 2)
    out = np.empty(2 * len(points))
    written = flaunay.triangulate(points, areas=True, out={"areas": out})
    assert written.areas.base is out and np.array_equal(written.areas, mesh.areas)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    crossing = flaunay.triangulate(square, segments=[[0, 2], [1, 3]], crossings="split")
    assert crossing.areas.tolist() == [0.25] * 4


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


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_every_mode_gives_the_same_triangles(random, mode, dtype):
    points = random.random((400, 2)).astype(dtype)
    expected = flaunay.triangulate(points)
    mesh = flaunay.triangulate(points, mode=mode, halfedges=True, areas=True)
    assert mesh.areas.shape == (len(mesh.triangles),) and (mesh.areas > 0).all()
    assert as_set(mesh.triangles) == as_set(expected.triangles)
    assert np.array_equal(mesh.hull, expected.hull)
    check_neighbors(mesh.triangles, mesh.neighbors)


@pytest.mark.parametrize("mode", ["blocks", "dwyer"])
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
    none = flaunay.triangulate(np.empty((0, 2)), offsets=[0], mode=mode)
    assert none.triangle_offsets.tolist() == [0] and none.triangles.shape == (0, 3)


@pytest.mark.parametrize("offsets", [[0, 5, 10], (0, 5, 10), range(0, 11, 5), np.uint8([0, 5, 10])])
def test_offsets_of_any_integer_type(random, offsets):
    mesh = flaunay.triangulate(random.random((10, 2)), offsets=offsets)
    assert len(mesh.triangle_offsets) == 3


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
