"""Points on a torus, beside SciPy's triangulation of nine copies."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import scipy.interpolate
import scipy.spatial

import flaunay

PERIOD = (2.0, 3.0)
ONE = [[0.5, 0.5]]


def test_triangles_and_cells(random):
    points = random.uniform(0, PERIOD, (300, 2))
    tri = flaunay.periodic(points, PERIOD)
    tri.verify()
    assert tri.nsimplex == 600 and tri.corners.shape == (600, 3, 2)
    assert repr(tri) == "<flaunay.PeriodicDelaunay: 300 points, 600 triangles>"
    steps = tri.corner_offsets * PERIOD
    np.testing.assert_allclose(tri.corners - tri.places[tri.simplices], steps, atol=1e-15)
    assert (np.abs(tri.corners[:, 1:] - tri.corners[:, :1]) < 1).all()
    # Of the plane, in the middle of nine copies.
    copies = (points + (np.indices((3, 3)).reshape(2, 9).T * PERIOD)[:, None]).reshape(-1, 2)
    cells = flaunay.Voronoi(copies).clipped((-9, -9, 19, 19))
    np.testing.assert_allclose(tri.cells.areas, cells.areas[4 * 300 : 5 * 300], rtol=1e-9)
    centroids = cells.centroids[4 * 300 : 5 * 300] - PERIOD
    np.testing.assert_allclose(tri.cells.centroids, centroids, atol=1e-9)
    assert len(tri.cells.polygons()) == 300 and tri.cells.bounds[2].tolist() == list(PERIOD)


def test_sheared_boxes(random):
    points = random.uniform(0, PERIOD, (300, 2))
    tri = flaunay.periodic(points, (*PERIOD, 4.75))
    tri.verify()
    assert tri.period == (2, 3, 0.75) and tri.nsimplex == 600
    vectors = np.array([[2, 0], [0.75, 3]])
    np.testing.assert_array_equal(tri.corners, tri.places[tri.simplices] + tri.corner_offsets @ vectors)
    assert (np.abs(tri.corners[:, 1:] - tri.corners[:, :1]) < 1).all()
    assert abs(tri.cells.areas.sum() - 6) < 1e-12
    moved = points + random.integers(-5, 6, (300, 2)) @ vectors
    np.testing.assert_allclose(flaunay.to_places(moved, tri.period), tri.places, atol=1e-13)
    np.testing.assert_array_equal(tri.nearest(moved), np.arange(300))
    again = pickle.loads(pickle.dumps(tri))
    np.testing.assert_array_equal(again.find_simplex(moved), tri.find_simplex(moved))
    assert flaunay.periodic(points, (*PERIOD, 4)).period == PERIOD
    chunks = flaunay.triangulate_chunks(
        points, triangles=True, corner_offsets=True, period=tri.period, chunk_points=50
    )
    assert chunks.period == tri.period
    np.testing.assert_array_equal(
        np.sort(np.hstack([chunks.triangles, chunks.corner_offsets.reshape(-1, 6)]), axis=0),
        np.sort(np.hstack([tri.simplices, tri.corner_offsets.reshape(-1, 6)]), axis=0),
    )
    with pytest.raises(flaunay.UsageError, match="no shear"):
        flaunay.periodic(points, (2, None, 1))
    with pytest.raises(flaunay.UsageError, match="perhaps a shear"):
        flaunay.periodic(points, (2, 3, 1, 1))


@pytest.mark.parametrize("period", [PERIOD, (*PERIOD, 0.75), (2, None)])
def test_weights(random, period):
    points, weights = random.uniform(0, PERIOD, (300, 2)), random.uniform(0, 0.1, 300)
    tri = flaunay.periodic(points, period, weights=weights)
    tri.verify()
    assert len(tri.hidden) > 10 and not np.isin(tri.hidden, tri.simplices).any()
    np.testing.assert_array_equal(tri.nearest(points), np.arange(300))
    again = pickle.loads(pickle.dumps(tri))
    np.testing.assert_array_equal(again.simplices, tri.simplices)
    middles = tri.corners.mean(axis=1)
    np.testing.assert_array_equal(tri.find_simplex(middles), np.arange(tri.nsimplex))
    values, visible = random.uniform(size=300), np.setdiff1d(np.arange(300), tri.hidden)
    np.testing.assert_allclose(tri.interpolate(values, middles), values[tri.simplices].mean(axis=1))
    assert np.isnan(tri.gradients(values)[tri.hidden]).all()
    for method in "linear", "clough-tocher":
        np.testing.assert_array_equal(tri.interpolate(values, points[visible], method), values[visible])
    for method in "nearest", "sibson":
        with pytest.raises(flaunay.UsageError, match="weights"):
            tri.interpolate(values, points, method)
    if period[1] is None:
        assert tri.nsimplex == 2 * (300 - len(tri.hidden)) - 2
        return
    assert tri.nsimplex == 2 * (300 - len(tri.hidden))
    assert abs(tri.cells.areas.sum() - 6) < 1e-12 and (tri.cells.areas[tri.hidden] == 0).all()
    equal = flaunay.periodic(points, period, weights=np.full(300, 0.5))
    np.testing.assert_array_equal(equal.simplices, flaunay.periodic(points, period).simplices)
    with pytest.raises(flaunay.UsageError, match=r"the shape \(300,\)"):
        flaunay.periodic(points, period, weights=weights[1:])


def test_one_point_has_two_triangles():
    tri = flaunay.periodic([[7.5, -1]], PERIOD)
    assert tri.simplices.tolist() == [[0, 0, 0], [0, 0, 0]]
    assert tri.cells.areas.tolist() == [6]
    assert tri.corners.tolist() == [
        [[1.5, 2], [3.5, 2], [3.5, 5]],
        [[1.5, 2], [3.5, 5], [1.5, 5]],
    ]


def test_points_are_taken_into_the_period(random):
    points = random.integers(0, 1 << 20, (500, 2)) / (1 << 19)
    shifted = points + random.integers(-5, 6, (500, 2)) * 2.0
    one, other = flaunay.periodic(points, (2, 2)), flaunay.periodic(shifted, (2, 2))
    np.testing.assert_array_equal(one.places, points % 2)
    np.testing.assert_array_equal(one.places, other.places)
    np.testing.assert_array_equal(one.simplices, other.simplices)
    np.testing.assert_array_equal(one.corner_offsets, pickle.loads(pickle.dumps(other)).corner_offsets)


def test_queries_are_those_of_nine_copies(random):
    points = random.uniform(0, PERIOD, (300, 2))
    values = random.uniform(0, 1, (300, 2))
    tri = flaunay.periodic(points, PERIOD)
    queries = random.uniform(-3, 9, (5, 100, 2))
    steps = np.indices((3, 3)).reshape(2, 9).T - 1
    copies = (tri.places + (steps * PERIOD)[:, None]).reshape(-1, 2)
    inside = queries % PERIOD
    np.testing.assert_array_equal(
        tri.nearest(queries), scipy.spatial.cKDTree(copies).query(inside)[1] % 300
    )
    expected = scipy.interpolate.LinearNDInterpolator(copies, np.tile(values, (9, 1)))(inside)
    np.testing.assert_allclose(tri.interpolate(values, queries), expected, rtol=1e-9)
    np.testing.assert_array_equal(tri.interpolate(values[:, 0], points), values[:, 0])
    centres = tri.corners.mean(axis=1) + [8, -9]
    np.testing.assert_array_equal(tri.find_simplex(centres), np.arange(600))
    again = pickle.loads(pickle.dumps(tri))
    np.testing.assert_array_equal(again.find_simplex(queries), tri.find_simplex(queries))


def test_cylinders(random):
    points = random.uniform(0, 1, (50, 2))
    for axis, period in enumerate([(1, None), (None, 1)]):
        tri = flaunay.periodic(points, period)
        assert tri.nsimplex == 98 and (tri.neighbors < 0).sum() == 2
        assert tri.period[1 - axis] == np.inf and tri.period[axis] == 1
        assert not tri.corner_offsets[..., 1 - axis].any() and tri.corner_offsets[..., axis].any()
    tri = flaunay.periodic(points, (1, None))
    assert tri.find_simplex([[0.5, 1.5], [0.5, -0.5]]).tolist() == [-1, -1]
    assert np.isnan(tri.interpolate(np.ones(50), [0.5, 1.5]))
    assert tri.interpolate(np.ones(50), [7.5, 0.5]) == 1
    assert tri.nearest([3.5, 9]) == tri.nearest([-8.5, 9])


def test_sets(random):
    parts = [random.uniform(0, 1, (n, 2)) for n in (200, 150)]
    tri = flaunay.periodic(np.concatenate(parts), (1, 1), [0, 200, 350])
    alone = flaunay.periodic(parts[1], (1, 1))
    np.testing.assert_array_equal(tri.simplices[tri.simplex_offsets[1] :] - 200, alone.simplices)
    np.testing.assert_array_equal(tri.cells.areas[200:], alone.cells.areas)
    queries, values = random.uniform(-2, 2, (30, 2)), random.normal(size=350)
    of_sets = [0, 20, 30]
    found, near = tri.find_simplex(queries, offsets=of_sets), tri.nearest(queries, offsets=of_sets)
    between = tri.interpolate(values, queries, "sibson", offsets=of_sets)
    for s, first in enumerate((0, 200)):
        alone, asked = flaunay.periodic(parts[s], (1, 1)), slice(of_sets[s], of_sets[s + 1])
        np.testing.assert_array_equal(found[asked] - tri.simplex_offsets[s], alone.find_simplex(queries[asked]))
        np.testing.assert_array_equal(near[asked] - first, alone.nearest(queries[asked]))
        own = values[first : first + len(parts[s])]
        np.testing.assert_array_equal(between[asked], alone.interpolate(own, queries[asked], "sibson"))
    with pytest.raises(flaunay.UsageError, match="one set alone"):
        alone.nearest(queries, k=2, offsets=[0, 30])


@pytest.mark.parametrize(
    "call, kind, message",
    [
        (lambda tri: tri.nearest([1, 2, 3]), flaunay.UsageError, r"xi must have the shape \(\.\.\., 2\)"),
        (lambda tri: tri.interpolate([1, 2], [0, 0]), flaunay.UsageError, "one row per point, 1"),
        (lambda tri: tri.find_simplex([[0, 0], [0, np.nan]]), flaunay.InputError, "query 1 is not finite"),
        (lambda tri: flaunay.periodic(ONE, (1, 1), [0, 0, 1]).nearest([0, 0]), flaunay.UsageError, "1 sets"),
        (lambda tri: flaunay.periodic(ONE, (1, 1), [0, 0, 1]).nearest([0, 0], k=2), flaunay.UsageError, "one set"),
        (lambda tri: flaunay.periodic(ONE, (1, None)).cells, flaunay.UsageError, "cells on a cylinder"),
        (lambda tri: flaunay.periodic([[np.inf, 0.5]], (1, 1)), flaunay.InputError, "point 0 is not finite"),
        (lambda tri: flaunay.periodic(ONE, (0, 1)), flaunay.UsageError, "the period 0 x 1"),
        (lambda tri: flaunay.periodic(ONE, [1]), flaunay.UsageError, "two lengths"),
        (lambda tri: flaunay.periodic([1, 2, 3], (1, 1)), flaunay.UsageError, r"\(n, 2\)"),
    ],
)
def test_errors_say_what_is_wrong(call, kind, message):
    with pytest.raises(kind, match=message):
        call(flaunay.periodic(ONE, (1, 1)))


@pytest.mark.parametrize("period", [(1, 1), (1, 2), (1, None), (None, 0.5)])
@pytest.mark.parametrize("n", [1, 2, 5, 300])
def test_several_nearest_points(period, n):
    # Few points have images that are nearer than others; many places are equal, or as far.
    random = np.random.default_rng(n)
    points = random.integers(-20, 20, (n, 2)) / 16
    queries = random.integers(-40, 40, (50, 2)) / 32
    tri = flaunay.periodic(points, period)
    distances, found = tri.nearest(queries, k=7, return_distances=True)
    steps = tri.places[None] - queries[:, None]
    for axis, length in enumerate(period):
        if length is not None:
            steps[..., axis] -= length * np.round(steps[..., axis] / length)
    expected = np.linalg.norm(steps, axis=-1)
    wanted = np.full((50, 7), np.inf)
    wanted[:, : min(n, 7)] = np.sort(expected, axis=1)[:, :7]
    assert np.array_equal(distances, wanted)
    assert (np.take_along_axis(expected, found.clip(0), 1) == wanted)[found >= 0].all()
    assert ((found < 0) == np.isinf(wanted)).all()
    assert all(len(set(row[row >= 0])) == min(n, 7) for row in found)
    near, bound = tri.nearest(queries[0], return_distances=True), wanted[0, 0]
    assert near == (bound, tri.representatives[near[1]])
    assert tri.nearest(queries, k=1)[:, 0].tolist() == tri.nearest(queries).tolist()
    assert (tri.nearest(queries, k=n, distance_upper_bound=0.25) >= 0).sum() == (expected <= 0.25).sum()


@pytest.mark.parametrize(
    "make", [lambda: flaunay.periodic(np.empty((0, 2)), (1, None)), lambda: flaunay.spherical(np.empty((0, 2)))]
)
def test_queries_of_no_points(make):
    tri, queries = make(), np.full((3, 2), 0.25)
    assert tri.find_simplex(queries).tolist() == tri.nearest(queries).tolist() == [-1] * 3
    assert tri.nearest(queries, k=2).tolist() == [[-1, -1]] * 3
    for shape in (0,), (0, 2), (0, 2, 4):
        values = tri.interpolate(np.empty(shape), queries)
        assert values.shape == (3, *shape[1:]) and np.isnan(values).all()


def test_natural_neighbors(random):
    points, queries = random.uniform(0, PERIOD, (200, 2)), random.uniform(-9, 9, (50, 2))
    tri = flaunay.periodic(points, PERIOD)
    copies = (points + ((np.indices((5, 5)).reshape(2, 25).T - 2) * PERIOD)[:, None]).reshape(-1, 2)
    values = random.uniform(size=(200, 3))
    for method in "sibson", "laplace":
        plane = flaunay.NaturalNeighborInterpolator(copies, np.tile(values, (25, 1)), method=method)
        expected = plane(queries % PERIOD)
        np.testing.assert_allclose(tri.interpolate(values, queries, method), expected, atol=1e-9)
        np.testing.assert_array_equal(tri.interpolate(values, points, method), values)
    np.testing.assert_array_equal(tri.interpolate(values, queries, "nearest"), values[tri.nearest(queries)])
    cylinder = flaunay.periodic(points, (2, None))
    np.testing.assert_array_equal(cylinder.interpolate(values, points, "sibson"), values)
    with pytest.raises(flaunay.InputError, match="wider than the shorter period"):
        flaunay.periodic(ONE, PERIOD).interpolate([1], queries, "laplace")
    for method in "cubic", 1:
        with pytest.raises(flaunay.UsageError, match="method"):
            tri.interpolate(values, queries, method)


@pytest.mark.parametrize("period", [PERIOD, (*PERIOD, 0.75)])
def test_clough_tocher(random, period):
    points, queries = random.uniform(0, PERIOD, (200, 2)), random.uniform(-9, 9, (50, 2))
    tri = flaunay.periodic(points, period)
    vectors = np.array([[2, 0], [(*period, 0)[2], 3]])
    steps = sorted((np.indices((7, 7)).reshape(2, 49).T - 3).tolist(), key=np.linalg.norm)
    copies = (tri.places + (steps @ vectors)[:, None]).reshape(-1, 2)
    values = random.uniform(size=(200, 3))
    plane = flaunay.CloughTocherInterpolator(copies, np.tile(values, (49, 1)))
    np.testing.assert_allclose(tri.gradients(values), plane.grad[:200], atol=1e-4)
    gradients = tri.gradients(values, tol=1e-12)
    expected = flaunay.CloughTocherInterpolator(copies, np.tile(values, (49, 1)), gradients=np.tile(gradients, (49, 1, 1)))
    found = tri.interpolate(values, queries, "clough-tocher", gradients=gradients)
    np.testing.assert_allclose(found, expected(flaunay.to_places(queries, period)), atol=1e-9)
    np.testing.assert_allclose(tri.interpolate(values, queries, "clough-tocher"), found, atol=1e-4)
    np.testing.assert_array_equal(tri.interpolate(values, points, "clough-tocher"), values)
    for slopes, method, message in [
        (gradients, "linear", "for the method"),
        (gradients[0], "clough-tocher", "one vector per value"),
        (np.ones((200, 3, 3)), "clough-tocher", "the shape"),
    ]:
        with pytest.raises(flaunay.UsageError, match=message):
            tri.interpolate(values, queries, method, gradients=slopes)
    with pytest.raises(flaunay.UsageError, match="tol"):
        tri.gradients(values, tol=0)


@pytest.mark.parametrize("period", [(1, 1), (2, 3), (1, 1, 0.3)])
@pytest.mark.parametrize("n", [1, 2, 5, 300])
@pytest.mark.parametrize("is_weighted", [False, True])
def test_neighborhoods_are_the_sides_of_cells(random, period, n, is_weighted):
    points = random.random((n, 2)) * 5
    weights = random.random(n) / (20 * n) if is_weighted else None
    tri = flaunay.periodic(points, period, weights=weights)
    assert len(tri.edges) == 3 * tri.nsimplex // 2
    assert (np.diff(tri.edges, axis=1) >= 0).all()
    assert tri.areas.sum() == pytest.approx(period[0] * period[1]) and (tri.areas > 0).all()
    first, second = tri.places[tri.edges].transpose(1, 0, 2)
    # An image of the other point: whole numbers of periods away.
    across, up, shear = [*tri.period, 0][:3]
    count = np.linalg.solve([[across, shear], [0, up]], (tri.edge_vectors - (second - first)).T)
    assert count == pytest.approx(count.round(), abs=1e-12)
    assert tri.edge_lengths == pytest.approx(np.linalg.norm(tri.edge_vectors, axis=1))
    indptr, indices, vectors, ridges = tri.neighborhoods()
    for i, cell in enumerate(tri.cells.polygons()):
        mine = slice(indptr[i], indptr[i + 1])
        lengths = np.linalg.norm(np.roll(cell, -1, axis=0) - cell, axis=1)
        assert sorted(ridges[mine][ridges[mine] > 1e-12]) == pytest.approx(sorted(lengths))
        angles = np.arctan2(*vectors[mine].T[::-1])
        assert (np.diff(angles) >= 0).all()
        # A cell's sides are its border.
        assert (vectors[mine] / np.hypot(*vectors[mine].T)[:, None]).T @ ridges[mine] == pytest.approx(0, abs=1e-12)
    assert np.bincount(indices, minlength=n) == pytest.approx(np.diff(indptr))


def test_edges_of_a_cylinder(random):
    tri = flaunay.periodic(random.random((50, 2)), (1, None))
    at_ends = tri.edge_simplices[:, 0] < 0
    assert at_ends.sum() == (tri.neighbors < 0).sum() == 2
    assert (np.isinf(tri.ridge_lengths) == at_ends).all()
    assert flaunay.periodic([[0.5, 0.5]], (1, None)).edges.shape == (0, 2)
