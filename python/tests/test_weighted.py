"""Weighted points, beside Qhull's lower hull."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import scipy.spatial

import flaunay


def test_triangles_are_those_of_the_lower_hull(random):
    points, weights = random.random((500, 2)), random.random(500) / 200
    lifted = np.column_stack([points, (points**2).sum(axis=1) - weights])
    hull = scipy.spatial.ConvexHull(lifted)
    expected = {frozenset(map(int, t)) for t in hull.simplices[hull.equations[:, 2] < 0]}
    tri = flaunay.weighted(points, weights)
    assert {frozenset(map(int, t)) for t in tri.simplices} == expected
    assert 100 < len(tri.hidden) < 400
    assert set(tri.hidden) | set(tri.simplices.ravel()) == set(range(500))
    assert repr(tri) == (
        f"<flaunay.WeightedDelaunay: 500 points, {tri.nsimplex} triangles, {len(tri.hidden)} hidden>"
    )
    tri.verify()
    again = pickle.loads(pickle.dumps(tri))
    np.testing.assert_array_equal(again.simplices, tri.simplices)
    assert tri.hidden_by.shape == tri.hidden.shape and (tri.hidden_by < tri.nsimplex).all()


def test_cells_of_circles(random):
    tri = flaunay.weighted(random.random((300, 2)), random.random(300) / 100)
    cells = tri.cells((0, 0, 1, 1))
    assert isinstance(cells, flaunay.ClippedVoronoi)
    assert cells.areas.sum() == pytest.approx(1, abs=1e-12)
    assert (cells.areas[tri.hidden] == 0).all() and (cells.areas > 0).sum() > 100


def test_triangles_for_other_packages(random):
    tri = flaunay.weighted(random.random((50, 2)), random.random(50) / 20)
    assert len(tri.hidden) and len(tri.to_geojson()["features"]) == tri.nsimplex
    pytest.importorskip("matplotlib")
    np.testing.assert_array_equal(tri.to_matplotlib().triangles, tri.simplices)
    shapely = pytest.importorskip("shapely", minversion="2")
    total = shapely.area(tri.to_shapely()).sum()
    assert total == pytest.approx(shapely.MultiPoint(tri.points).convex_hull.area, abs=1e-12)


def test_sets(random):
    points, weights = random.random((90, 2)), random.random(90) / 10
    tri = flaunay.weighted(points, weights, [0, 40, 40, 90])
    assert tri.simplex_offsets.tolist()[1] == tri.simplex_offsets.tolist()[2]
    own = flaunay.weighted(points[40:], weights[40:])
    np.testing.assert_array_equal(tri.simplices[tri.simplex_offsets[2] :] - 40, own.simplices)
    assert len(tri.hidden_by) == len(tri.hidden)
    with pytest.raises(flaunay.UsageError, match="one set"):
        tri.cells((0, 0, 1, 1))


def test_errors():
    with pytest.raises(flaunay.UsageError, match=r"weights must have the shape \(3,\)"):
        flaunay.weighted(np.zeros((3, 2)), [1, 2])
    with pytest.raises(flaunay.UsageError, match="shape"):
        flaunay.weighted([1, 2], [1, 2])
    with pytest.raises(flaunay.InputError, match="point 1 has a weight that is not finite"):
        flaunay.weighted([[0, 0], [1, 1]], [1, np.inf])
    empty = flaunay.weighted(np.zeros((0, 2)), [])
    assert empty.nsimplex == 0
    assert flaunay.weighted([[0, 0]], [7]).cells((-1, -1, 1, 1)).areas.tolist() == [4]
