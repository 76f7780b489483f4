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


def test_nearest_of_several_is_the_first_by_coordinates():
    tri = flaunay.Delaunay([[2, 0], [0, 0], [0, 2], [2, 2], [0, 0]])
    assert tri.nearest([1, 1]) == 1


@pytest.mark.parametrize("most, wanted_calls", [(1 << 26, 1), (5000, 3), (1, 24)])
def test_columns_are_interpolated_together(
    points, queries, random, monkeypatch, most, wanted_calls
):
    values = random.random((len(points), 4, 6))
    values[::50] = np.nan
    tri = flaunay.Delaunay(points)
    expected = [tri.interpolate(column, queries) for column in values.reshape(-1, 24).T]
    calls = []
    ask = flaunay._calls.Locator.interpolate
    monkeypatch.setattr(flaunay._queries, "_MOST_NUMBERS", most)
    monkeypatch.setattr(
        flaunay._calls.Locator, "interpolate", lambda *all: calls.append(1) or ask(*all)
    )
    found = tri.interpolate(values, queries)
    assert found.tobytes() == np.stack(expected, axis=1).tobytes()
    assert len(calls) == wanted_calls
    queries[::70] = np.inf
    assert np.isnan(tri.interpolate(values, queries)[::70]).all()


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


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_queries_that_are_not_finite_are_nowhere(points, queries, bad):
    tri, theirs = flaunay.Delaunay(points), scipy.spatial.Delaunay(points)
    expected = tri.find_simplex(queries), tri.nearest(queries)
    wrong = np.arange(len(queries)) % 7 == 3
    given = queries.copy()
    given[wrong, np.arange(wrong.sum()) % 2] = bad
    assert (theirs.find_simplex(given)[wrong] == -1).all()
    for found, other in zip((tri.find_simplex(given), tri.nearest(given)), expected):
        assert found.dtype == np.int32
        assert (found[wrong] == -1).all() and np.array_equal(found[~wrong], other[~wrong])
    for values in points[:, 0], points:
        other = scipy.interpolate.LinearNDInterpolator(theirs, values)(given)
        np.testing.assert_allclose(tri.interpolate(values, given), other, rtol=1e-10, atol=1e-12)
    assert tri.find_simplex([bad, 0.5]) == tri.nearest([bad, bad]) == -1
    assert np.isnan(tri.interpolate(points[:, 0], [bad, 0.5]))
    assert tri.find_simplex([bad, 0.5], tol=0.1) == -1


def test_magnitudes_that_are_too_different_are_no_less_an_error(points):
    tri = flaunay.Delaunay([[0, 0], [1e200, 0], [0, 1e200]])
    for ask in tri.find_simplex, tri.nearest:
        with pytest.raises(flaunay.InputError, match="query 1 is too fine"):
            ask([[np.nan, 1], [1e-200, 0]])


def test_tolerance(points, queries):
    tri, theirs = flaunay.Delaunay(points), scipy.spatial.Delaunay(points)
    exact = tri.find_simplex(queries)
    assert np.array_equal(exact, tri.find_simplex(queries, True))
    assert np.array_equal(tri.find_simplex(queries, tol=0), exact)
    # A little beyond the edges of the hull.
    start, end = points[tri.convex_hull].transpose(1, 0, 2)
    outwards = (end - start)[:, ::-1] * [1, -1] * 1e-7
    near = (start + end) / 2 + outwards
    assert (tri.find_simplex(near) == -1).all()
    found = tri.find_simplex(near, tol=1e-3)
    assert np.array_equal(
        tri.simplices[found], tri.simplices[tri.find_simplex(near - 2 * outwards)]
    )
    assert np.array_equal(
        np.sort(tri.simplices[found]),
        np.sort(theirs.simplices[theirs.find_simplex(near, tol=1e-3)]),
    )
    assert (tri.find_simplex(near, tol=1e-12) == -1).all()
    for tol in 1e-9, 1e-2:
        mine, other = tri.find_simplex(queries, tol=tol), theirs.find_simplex(queries, tol=tol)
        assert np.array_equal(mine[exact >= 0], exact[exact >= 0])
        # SciPy ends at another simplex at times.
        assert np.mean((mine < 0) == (other < 0)) > 0.99
    for tol in -1e-9, np.nan:
        with pytest.raises(flaunay.UsageError, match="tol must be 0 or more"):
            tri.find_simplex(queries, tol=tol)


def test_results_in_the_callers_arrays(points, queries):
    tri = flaunay.Delaunay(points)
    xi = queries.reshape(20, 25, 2)
    for ask, dtype, shape in (
        (tri.find_simplex, np.int32, (20, 25)),
        (tri.nearest, np.int32, (20, 25)),
        (lambda xi, out=None: tri.interpolate(points, xi, out=out), np.float64, (20, 25, 2)),
    ):
        out = np.empty(shape, dtype)
        assert ask(xi, out=out) is out and np.array_equal(out, ask(xi), equal_nan=True)
        every_other = np.zeros((40, *shape[1:]), dtype)
        ask(xi, out=every_other[::2])
        assert np.array_equal(every_other[::2], out, equal_nan=True) and not every_other[1::2].any()
        read_only = out.copy()
        read_only.flags.writeable = False
        for bad, message in (
            (np.empty(500, dtype), "out must be .* of shape"),
            (np.empty(shape, np.int64), "not int64"),
            (read_only, "out is read-only"),
            ([0], "out must be an array"),
        ):
            with pytest.raises(flaunay.UsageError, match=message):
                ask(xi, out=bad)


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
        assert other._kept_locator._lock is not tri._kept_locator._lock


@pytest.mark.parametrize("index", [-2, 800, 10**9, -(2**31), 2**31 - 1])
@pytest.mark.parametrize("name", ["simplices", "neighbors", "hull", "representatives"])
def test_queries_where_indices_were_changed(points, queries, name, index):
    tri = flaunay.Delaunay(points)
    setattr(tri, name, np.full_like(getattr(tri, name), index))
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


def test_several_nearest_points(points, queries):
    tri, tree = flaunay.Delaunay(points), scipy.spatial.cKDTree(points)
    for k in (1, 4, 401):
        distances, found = tri.nearest(queries, k=k, return_distances=True)
        expected, indices = tree.query(queries, k=range(1, k + 1))
        assert found.dtype == np.int32 and np.array_equal(found, np.where(indices < 400, indices, -1))
        np.testing.assert_allclose(distances, expected, rtol=1e-14, atol=0)
        assert np.array_equal(found, tri.nearest(queries, k=k))
    alone = tri.nearest(queries)
    assert alone.dtype == np.int32 and np.array_equal(tri.nearest(queries, k=1)[:, 0], alone)


def test_a_bound_of_distances(points, queries):
    tri = flaunay.Delaunay(points)
    distances, found = tri.nearest(queries, k=5, return_distances=True)
    near, at = tri.nearest(queries, k=5, distance_upper_bound=0.05, return_distances=True)
    assert np.array_equal(at, np.where(distances <= 0.05, found, -1))
    assert np.array_equal(near, np.where(distances <= 0.05, distances, np.inf))
    alone = tri.nearest(queries, distance_upper_bound=0.05)
    assert np.array_equal(alone, at[:, 0]) and (alone < 0).any() and (alone >= 0).any()


def test_several_nearest_points_of_any_shape(points, queries):
    tri = flaunay.Delaunay(points)
    found = tri.nearest(queries, k=3)
    out = np.empty((5, 100, 3), np.int32)
    assert tri.nearest(queries.reshape(5, 100, 2), out, k=3) is out
    assert np.array_equal(out.reshape(-1, 3), found)
    distance, index = tri.nearest(queries[0], return_distances=True)
    assert distance.shape == index.shape == () and index == found[0, 0]
    bad = queries.copy()
    bad[3, 1] = np.nan
    distances, with_bad = tri.nearest(bad, k=3, return_distances=True)
    found[3] = -1
    assert np.array_equal(with_bad, found) and np.isinf(distances[3]).all()
    for other in (pickle.loads(pickle.dumps(tri)), copy.deepcopy(tri)):
        assert np.array_equal(other.nearest(queries, k=3), tri.nearest(queries, k=3))
    assert flaunay.Delaunay(np.empty((0, 2))).nearest([1, 1], k=2).tolist() == [-1, -1]


def test_nearest_points_after_changes(points, queries):
    tri = flaunay.Delaunay(points, incremental=True)
    before = tri.nearest(queries, k=4)
    tri.remove_points([0, 7])
    tri.add_points(points[:1] + 0.01)
    rest = np.concatenate([np.setdiff1d(np.arange(400), [0, 7]), [400]])
    after = tri.nearest(queries, k=4)
    others = flaunay.Delaunay(tri.points[rest]).nearest(queries, k=4)
    assert np.array_equal(after, rest[others]) and not np.array_equal(after, before)


@pytest.mark.parametrize(
    "options, message",
    [({"k": 0}, "k must be"), ({"distance_upper_bound": -1}, "distance_upper_bound")],
)
def test_wrong_options_of_nearest_points(points, options, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.Delaunay(points).nearest([0, 0], **options)
