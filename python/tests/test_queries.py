"""Queries in a triangulation, beside SciPy's and beside brute force."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scipy.interpolate
import scipy.spatial

import flaunay


@pytest.fixture
def points(random):
    return random.random((400, 2))


@pytest.fixture
def queries(random):
    return random.random((500, 2)) * 1.4 - 0.2


def test_find_simplex_finds_what_scipy_finds(points, queries):
    mine, theirs = flaunay.Delaunay(points), scipy.spatial.Delaunay(points)
    found, other = mine.find_simplex(queries), theirs.find_simplex(queries)
    assert found.dtype == other.dtype == np.int32
    assert np.array_equal(found < 0, other < 0) and (found < 0).any() and (found >= 0).any()
    inside = found >= 0
    assert np.array_equal(
        np.sort(mine.simplices[found[inside]]), np.sort(theirs.simplices[other[inside]])
    )


def test_the_example_of_scipys_documentation():
    tri = flaunay.Delaunay([[0, 0], [0, 1.1], [1, 0], [1, 1]])
    found = tri.find_simplex([(0.1, 0.2), (1.5, 0.5), (0.5, 1.05)])
    assert found[1] == -1
    assert set(tri.simplices[found[0]]) == {0, 2, 3} or set(tri.simplices[found[0]]) == {0, 1, 3}
    assert set(tri.simplices[found[2]]) == {0, 1, 3}


@pytest.mark.parametrize(
    "shape", [(2,), (1, 2), (0, 2), (5, 2), (3, 4, 2), (3, 0, 2), (2, 1, 3, 2)]
)
def test_any_leading_shape(points, random, shape):
    tri = flaunay.Delaunay(points)
    xi = random.random(shape)
    assert tri.find_simplex(xi).shape == tri.nearest(xi).shape == shape[:-1]
    assert tri.interpolate(points[:, 0], xi).shape == shape[:-1]
    assert scipy.spatial.Delaunay(points).find_simplex(xi).shape == shape[:-1]
    flat = tri.find_simplex(xi.reshape(-1, 2))
    assert np.array_equal(tri.find_simplex(xi).ravel(), flat)
    assert isinstance(tri.find_simplex(xi), np.ndarray)


def test_a_vertex_is_in_the_first_of_its_simplices(points):
    tri = flaunay.Delaunay(points)
    assert np.array_equal(tri.find_simplex(points), tri.vertex_to_simplex)


def test_nearest_is_the_nearest(points, queries):
    tri = flaunay.Delaunay(points)
    expected = scipy.spatial.cKDTree(points).query(queries)[1]
    found = tri.nearest(queries)
    assert found.dtype == np.int32 and np.array_equal(found, expected)


def test_nearest_of_several_is_the_first_by_coordinates():
    tri = flaunay.Delaunay([[2, 0], [0, 0], [0, 2], [2, 2], [0, 0]])
    assert tri.nearest([1, 1]) == 1


def test_interpolation_is_that_of_scipy(points, queries, random):
    values = random.random((len(points), 3))
    found = flaunay.Delaunay(points).interpolate(values, queries)
    expected = scipy.interpolate.LinearNDInterpolator(points, values)(queries)
    assert found.shape == expected.shape == (len(queries), 3) and found.dtype == np.float64
    np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12)


def test_interpolation_at_the_points_is_exact(points, random):
    values = random.random(len(points))
    assert np.array_equal(flaunay.Delaunay(points).interpolate(values, points), values)


def test_queries_of_every_type_and_layout(points, queries):
    tri = flaunay.Delaunay(points)
    expected = tri.find_simplex(queries)
    for given in queries.tolist(), np.asfortranarray(queries), np.repeat(queries, 2, axis=0)[::2]:
        assert np.array_equal(tri.find_simplex(given), expected)
    single = queries.astype(np.float32)
    assert np.array_equal(tri.find_simplex(single), tri.find_simplex(single.astype(float)))
    assert tri.find_simplex([[0, 0]]) == -1


def test_float32_triangulations(points, queries):
    single = flaunay.Delaunay(points.astype(np.float32))
    double = flaunay.Delaunay(points.astype(np.float32).astype(float))
    assert np.array_equal(single.find_simplex(queries), double.find_simplex(queries))
    assert np.array_equal(single.nearest(queries), double.nearest(queries))


@pytest.mark.parametrize(
    "points", [np.empty((0, 2)), [[1.0, 2.0]], [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]]
)
def test_triangulations_without_simplices(points):
    tri = flaunay.Delaunay(points)
    xi = [[1.0, 1.0], [5.0, 5.0]]
    assert tri.find_simplex(xi).tolist() == [-1, -1]
    assert np.isnan(tri.interpolate(np.ones(len(points)), xi)).all()
    n = len(points)
    assert tri.nearest(xi).tolist() == {0: [-1, -1], 1: [0, 0], 3: [0, 1]}[n]


@pytest.mark.parametrize("xi", [3.0, [1.0, 2.0, 3.0], [[1.0], [2.0]], []])
def test_queries_of_a_wrong_shape(points, xi):
    tri = flaunay.Delaunay(points)
    for ask in tri.find_simplex, tri.nearest, lambda xi: tri.interpolate(points[:, 0], xi):
        with pytest.raises(flaunay.UsageError, match="xi must have the shape"):
            ask(xi)


def test_queries_that_are_no_numbers(points):
    tri = flaunay.Delaunay(points)
    with pytest.raises(flaunay.UsageError, match="real numbers"):
        tri.find_simplex([["a", "b"]])
    for bad in np.nan, np.inf:
        for ask in tri.find_simplex, tri.nearest, lambda xi: tri.interpolate(points[:, 0], xi):
            with pytest.raises(flaunay.InputError, match="query 1 is not finite"):
                ask([[0, 0], [bad, 0]])


@pytest.mark.parametrize("values", [3.0, [], np.zeros(399), np.zeros((2, 400))])
def test_another_number_of_values_than_of_points(points, values):
    with pytest.raises(flaunay.UsageError, match=r"values must have the shape \(400, ...\)"):
        flaunay.Delaunay(points).interpolate(values, [0, 0])


@pytest.mark.parametrize(
    "copied", [lambda tri: pickle.loads(pickle.dumps(tri)), copy.copy, copy.deepcopy]
)
def test_queries_after_pickling_and_copying(points, queries, copied):
    tri = flaunay.Delaunay(points)
    before = copied(tri)
    expected = tri.find_simplex(queries)
    for other in before, copied(tri), copied(copied(tri)):
        assert np.array_equal(other.find_simplex(queries), expected)
        assert other._locator_lock is not tri._locator_lock


@pytest.mark.parametrize("index", [-2, 800, 10**9, -(2**31), 2**31 - 1])
@pytest.mark.parametrize("name", ["simplices", "neighbors", "hull", "representatives"])
def test_queries_where_indices_were_changed(points, queries, name, index):
    tri = flaunay.Delaunay(points)
    getattr(tri, name)[:] = index
    for ask in tri.find_simplex, tri.nearest, lambda xi: tri.interpolate(points[:, 0], xi):
        with pytest.raises(flaunay.UsageError, match=f"{name} .*{index} is none of the"):
            ask(queries)


def test_interpolation_where_points_were_replaced(points, queries):
    tri = flaunay.Delaunay(points)
    tri.nearest(queries)
    tri.points = points[:10]
    with pytest.raises(flaunay.UsageError, match="10 values for the 400"):
        tri.interpolate(np.ones(10), queries)


def test_queries_from_two_threads(points, queries):
    tri = flaunay.Delaunay(points)
    expected = flaunay.Delaunay(points).nearest(queries)
    with ThreadPoolExecutor(2) as pool:
        for found in pool.map(tri.nearest, [queries] * 8):
            assert np.array_equal(found, expected)


def test_many_triangulations_come_and_go(points, queries):
    for k in range(20):
        tri = flaunay.Delaunay(points[k:])
        assert (tri.nearest(points[k:]) == np.arange(len(points) - k)).all()
