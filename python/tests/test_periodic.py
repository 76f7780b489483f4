"""Points on a torus, beside SciPy's triangulation of nine copies."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import scipy.spatial

import flaunay

PERIOD = (2.0, 3.0)


def test_triangles_are_scipys_of_nine_copies(random):
    points = random.uniform(0, PERIOD, (400, 2))
    tri = flaunay.periodic(points, PERIOD)
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    copies = (tri.places + (steps * PERIOD)[:, None]).reshape(-1, 2)
    all_of = scipy.spatial.Delaunay(copies).simplices
    of_point, of_copy = all_of % 400, steps[all_of // 400]
    # Those whose corner of the smallest index is in the middle.
    rows = np.arange(len(all_of))
    first = of_point.argmin(axis=1)
    chosen = (of_copy[rows, first] == 0).all(axis=1)
    expected = {
        frozenset((int(v), *map(int, step)) for v, step in zip(corners, offsets))
        for corners, offsets in zip(of_point[chosen], of_copy[chosen])
    }
    found = {
        frozenset((int(v), *map(int, step)) for v, step in zip(corners, offsets))
        for corners, offsets in zip(tri.simplices, tri.corner_offsets)
    }
    assert found == expected and tri.nsimplex == 800
    assert repr(tri) == "<flaunay.PeriodicDelaunay: 400 points, 800 triangles>"


def test_cells_are_those_of_the_voronoi_diagram(random):
    points = random.uniform(0, PERIOD, (300, 2))
    tri = flaunay.periodic(points, PERIOD)
    copies = (points + (np.indices((3, 3)).reshape(2, 9).T * PERIOD)[:, None]).reshape(-1, 2)
    cells = flaunay.Voronoi(copies).clipped((-9, -9, 19, 19))
    np.testing.assert_allclose(tri.cell_areas, cells.areas[4 * 300 : 5 * 300], rtol=1e-9)
    assert tri.cell_areas.sum() == pytest.approx(6, abs=1e-12)
    edges = tri.corners[:, 1:] - tri.corners[:, :1]
    assert (np.abs(edges) < 1).all()


def test_points_are_taken_into_the_period(random):
    points = random.integers(0, 1 << 20, (500, 2)) / (1 << 19)
    shifted = points + random.integers(-5, 6, (500, 2)) * 2.0
    one, other = flaunay.periodic(points, (2, 2)), flaunay.periodic(shifted, (2, 2))
    np.testing.assert_array_equal(one.places, points % 2)
    np.testing.assert_array_equal(one.places, other.places)
    np.testing.assert_array_equal(one.simplices, other.simplices)
    np.testing.assert_array_equal(one.corner_offsets, pickle.loads(pickle.dumps(other)).corner_offsets)


def test_sets(random):
    parts = [random.uniform(0, 1, (n, 2)) for n in (200, 150)]
    tri = flaunay.periodic(np.concatenate(parts), (1, 1), [0, 200, 350])
    alone = flaunay.periodic(parts[1], (1, 1))
    np.testing.assert_array_equal(tri.simplices[tri.simplex_offsets[1] :] - 200, alone.simplices)
    np.testing.assert_array_equal(tri.cell_areas[200:], alone.cell_areas)


def test_errors_say_what_is_wrong():
    with pytest.raises(flaunay.InputError, match="empty circle"):
        flaunay.periodic([[0.5, 0.5]], (1, 1))
    with pytest.raises(flaunay.InputError, match="point 0 is not finite"):
        flaunay.periodic([[np.inf, 0.5]], (1, 1))
    with pytest.raises(flaunay.UsageError, match="the period 0 x 1"):
        flaunay.periodic([[0.5, 0.5]], (0, 1))
    with pytest.raises(flaunay.UsageError, match="two lengths"):
        flaunay.periodic([[0.5, 0.5]], [1])
    with pytest.raises(flaunay.UsageError, match=r"\(n, 2\)"):
        flaunay.periodic([1, 2, 3], (1, 1))
