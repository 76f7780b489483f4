"""Triangulations and diagrams handed to SciPy, and what SciPy computes of them."""

import pickle
import sys

import numpy as np
import pytest
import scipy.spatial
from conftest import as_set

import flaunay


@pytest.fixture
def points(random):
    return random.random((300, 2))


@pytest.fixture
def queries(random):
    return random.random((400, 2)) * 1.2 - 0.1


def rows(simplices):
    """The order of rows by their corners."""
    return np.lexsort(np.sort(simplices).T)


def test_it_is_a_triangulation_of_scipys(points):
    tri = flaunay.Delaunay(points)
    made, theirs = tri.to_scipy(), scipy.spatial.Delaunay(points)
    assert type(made) is scipy.spatial.Delaunay
    assert vars(made).keys() >= vars(theirs).keys()
    for name, value in vars(theirs).items():
        mine = getattr(made, name)
        assert type(mine) is type(value) or name == "_transform", name
        if isinstance(value, np.ndarray):
            assert mine.dtype == value.dtype and mine.shape == value.shape, name
            assert mine.flags.writeable and mine.flags.c_contiguous
    assert as_set(made.simplices) == as_set(theirs.simplices)
    assert np.array_equal(made.vertex_to_simplex, tri.vertex_to_simplex)
    assert as_set(made.convex_hull) == as_set(theirs.convex_hull)
    indptr, indices = made.vertex_neighbor_vertices
    assert np.array_equal(indptr, tri.vertex_neighbor_vertices[0]) and len(indices) == indptr[-1]


def test_what_is_lifted_is_as_in_scipy(points, queries):
    mine, theirs = flaunay.Delaunay(points), scipy.spatial.Delaunay(points)
    assert mine.paraboloid_scale == pytest.approx(theirs.paraboloid_scale, rel=1e-12)
    assert mine.paraboloid_shift == pytest.approx(theirs.paraboloid_shift, rel=1e-12)
    order, other = rows(mine.simplices), rows(theirs.simplices)
    np.testing.assert_allclose(mine.equations[order], theirs.equations[other], atol=1e-10)
    np.testing.assert_allclose(mine.lift_points(queries), theirs.lift_points(queries), rtol=1e-12)
    at = queries.reshape(20, 20, 2)
    distances = mine.plane_distance(at)
    assert distances.shape == theirs.plane_distance(at).shape
    np.testing.assert_allclose(
        distances[..., order], theirs.plane_distance(at)[..., other], atol=1e-10
    )
    assert mine.good.dtype == theirs.good.dtype and np.array_equal(mine.good, theirs.good)


def test_transforms_of_thin_triangles_are_nan():
    points = np.array([[0, 0], [1, 1e-14], [2, 0], [1, 1.0]])
    tri = flaunay.Delaunay(points)
    thin = np.isnan(tri.transform).all(axis=(1, 2))
    assert as_set(tri.simplices[thin]) == {(0, 1, 2)}
    assert np.isfinite(tri.transform[~thin]).all()
    assert tri.find_simplex([1.0, 0.5e-14]) == np.flatnonzero(thin)[0]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("scale", [1e-200, 1e200])
def test_where_floating_point_has_no_planes(points, scale):
    tri = flaunay.Delaunay(points * scale)
    assert tri.transform.shape == (tri.nsimplex, 3, 2) and tri.equations.shape == (tri.nsimplex, 4)
    found = tri.find_simplex(points * scale)
    assert np.array_equal(found, tri.vertex_to_simplex)


@pytest.mark.parametrize("points", [np.empty((0, 2)), [[1.0, 2.0]], [[1.0, 1.0], [3.0, 3.0]]])
def test_without_simplices(points):
    tri = flaunay.Delaunay(points)
    assert tri.transform.shape == (0, 3, 2) and tri.equations.shape == (0, 4)
    assert tri.good.shape == (0,) and tri.plane_distance(np.zeros((5, 2))).shape == (5, 0)
    assert tri.lift_points([[1.0, 2.0]]).shape == (1, 3)
    assert tri.find_simplex([0.0, 0.0], tol=1.0) == -1
    with pytest.raises(flaunay.UsageError, match="without simplices"):
        tri.to_scipy()


def test_scipy_finds_simplices_in_it(points, queries):
    tri = flaunay.Delaunay(points)
    made = tri.to_scipy()
    expected = tri.find_simplex(queries)
    for copy in made, pickle.loads(pickle.dumps(made)):
        assert np.array_equal(copy.find_simplex(queries), expected)
        assert np.array_equal(copy.find_simplex(queries, bruteforce=True), expected)
        assert np.array_equal(scipy.spatial.tsearch(copy, queries), expected)


def test_float32_and_duplicates(points, queries):
    tri = flaunay.Delaunay(np.concatenate([points, points[:7]]).astype(np.float32))
    made = tri.to_scipy()
    assert made.points.dtype == np.float64 and len(made.coplanar) == 7
    assert np.array_equal(made.find_simplex(queries), tri.find_simplex(queries))


def test_it_does_not_share_its_arrays(points):
    tri = flaunay.Delaunay(points)
    made = tri.to_scipy()
    before = tri.simplices.copy()
    made.simplices.sort()
    made.points[:] = 0
    made.transform[:] = 0
    assert np.array_equal(tri.simplices, before) and np.array_equal(tri.points, points)
    assert tri.transform.any()


def test_it_ends_as_others_do(points):
    made = flaunay.Delaunay(points).to_scipy()
    made.close()
    with pytest.raises(RuntimeError):
        made.add_points(points)
    del made


def test_scipy_draws_it(points):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    tri = flaunay.Delaunay(points)
    for drawn in tri, tri.to_scipy():
        figure = scipy.spatial.delaunay_plot_2d(drawn)
        figure.canvas.draw()
        plt.close(figure)
    for merge in False, True:
        figure = scipy.spatial.voronoi_plot_2d(flaunay.Voronoi(points, merge=merge))
        figure.canvas.draw()
        plt.close(figure)


def test_without_scipy(points, monkeypatch):
    tri = flaunay.Delaunay(points)
    monkeypatch.setitem(sys.modules, "scipy.spatial", None)
    with pytest.raises(ImportError, match="to_scipy needs SciPy"):
        tri.to_scipy()
