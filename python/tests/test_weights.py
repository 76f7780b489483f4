"""Barycentric coordinates, and weights as sparse matrices."""

import conftest
import flaunay
import numpy as np
import pytest
from conftest import fractions, orient, ring


def exact(corners, q):
    a, b, c, q = fractions([*corners, q])
    return [float(orient(*three) / orient(a, b, c)) for three in ((q, b, c), (q, c, a), (q, a, b))]


def test_coordinates_are_those_of_fractions():
    rng = np.random.default_rng(0)
    grid = conftest.grid(6) + [5e5, 4e6]
    for points in (rng.random((60, 2)), grid, rng.random((60, 2)) * 1e-150, rng.random((60, 2)) * 1e150):
        interpolate = flaunay.LinearInterpolator(points, points[:, 0])
        low, high = points.min(axis=0), points.max(axis=0)
        middles = (points + np.roll(points, 1, axis=0)) / 2
        queries = np.concatenate([points, middles, low + rng.random((60, 2)) * (high - low)])
        triangles, coordinates = interpolate.barycentric(queries)
        assert np.array_equal(triangles, interpolate.tri.find_simplex(queries))
        for q, t, row in zip(queries.tolist(), triangles, coordinates):
            if t < 0:
                assert np.isnan(row).all()
            else:
                corners = interpolate.points[interpolate.tri.simplices[t]]
                assert row == pytest.approx(exact(corners.tolist(), q), abs=1e-9)
        # At points all is exact.
        assert sorted(set(coordinates[: len(points)].ravel().tolist())) == [0.0, 1.0]


def test_weights_times_values_interpolate():
    sparse = pytest.importorskip("scipy.sparse")
    rng = np.random.default_rng(1)
    points, queries = rng.random((200, 2)), rng.uniform(-0.1, 1.1, (30, 40, 2))
    interpolate = flaunay.LinearInterpolator(points, np.zeros(200), fill_value=0)
    weights = interpolate.weights(queries)
    assert sparse.issparse(weights) and weights.shape == (1200, 200)
    for _ in range(3):
        values = rng.random((200, 2))
        interpolate.values = values
        assert (weights @ values).reshape(30, 40, 2) == pytest.approx(interpolate(queries), abs=1e-12)
    sums = np.asarray(weights.sum(axis=1)).ravel()
    assert sums == pytest.approx((interpolate.tri.find_simplex(queries).ravel() >= 0).astype(float))
    assert interpolate.weights([[np.nan, 0], [9, 9]]).nnz == 0
    assert interpolate.weights(0.5, [0.25, 0.5]).shape == (2, 200)


def test_weights_in_constrained_triangulations_and_without_triangles():
    pytest.importorskip("scipy.sparse")
    corners = [[0, 0], [9, 0], [0, 9], [1, 1], [4, 1], [1, 4]]
    mesh = flaunay.triangulate(corners, segments=ring(3, 3), outside="holes")
    interpolate = flaunay.LinearInterpolator(mesh, mesh.points[:, 0])
    queries = [[2, 2], [5, 1], [1, 1]]
    found = interpolate.weights(queries) @ mesh.points
    assert found == pytest.approx(np.array([[0, 0], [5, 1], [1, 1]]))
    line = flaunay.LinearInterpolator([[0, 0], [1, 1]], [1, 2])
    assert line.weights([[0.5, 0.5]]).nnz == 0


def test_coordinates_in_very_slender_triangles_have_the_sum_one():
    rng = np.random.default_rng(0)
    inside = 0
    for _ in range(100):
        begin, along = rng.random(2), rng.random(2)
        corners = np.array([begin, begin + along, begin + along * rng.random()])
        corners[2] = np.nextafter(corners[2], rng.choice([-9, 9], 2))
        interpolate = flaunay.LinearInterpolator(corners, [0, 1, 2])
        queries = begin + along * rng.random((50, 1))
        queries = np.concatenate([queries, np.nextafter(queries, 9), np.nextafter(queries, -9)])
        triangles, coordinates = interpolate.barycentric(queries)
        inside += (triangles >= 0).sum()
        assert coordinates[triangles >= 0].sum(axis=1) == pytest.approx(1)
        assert (coordinates[triangles >= 0] >= 0).all()
    assert inside > 25


@pytest.mark.parametrize("method", ["sibson", "laplace"])
@pytest.mark.parametrize("is_constrained", [False, True])
def test_weights_of_natural_neighbours(method, is_constrained):
    sparse = pytest.importorskip("scipy.sparse")
    rng = np.random.default_rng(2)
    grid = conftest.grid(5) / 4
    points = np.concatenate([rng.random((100, 2)), grid, grid[:3]])
    queries = np.concatenate([points, rng.uniform(-0.1, 1.1, (200, 2)), [[np.nan, 0], [9, 9]]])
    segments = [[100, 124], [105, 119]]
    mesh = flaunay.triangulate(points, segments=segments, crossings="split") if is_constrained else points
    count = len(mesh.points) if is_constrained else len(mesh)
    interpolate = flaunay.NaturalNeighborInterpolator(mesh, np.zeros(count), method, fill_value=0)
    weights = interpolate.weights(queries)
    assert sparse.issparse(weights) and weights.shape == (len(queries), count)
    for _ in range(3):
        values = rng.random((count, 2))
        interpolate.values = values
        assert weights @ values == pytest.approx(interpolate(queries), abs=1e-12)
    sums = np.asarray(weights.sum(axis=1)).ravel()
    assert sums == pytest.approx((interpolate.tri.find_simplex(queries) >= 0).astype(float))
    assert weights.data.min() >= 0 and np.diff(weights.indptr).max() > 4
    assert interpolate.weights(0.5, [0.25, 0.5]).shape == (2, count)
