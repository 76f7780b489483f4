"""Proofs of results, of all kinds of triangulations."""

import pickle

import flaunay
import numpy as np
import pytest

SQUARE = [[0, 0], [6, 0], [6, 6], [0, 6]]
FRAME = [*SQUARE, [2, 2], [4, 2], [4, 4], [2, 4]]
RINGS = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]]


def points(n=100):
    # Many are equal, and many cocircular.
    return np.random.default_rng(1).integers(0, 8, (n, 2))


RESULTS = {
    "segments": lambda: flaunay.triangulate(FRAME, RINGS, outside="holes", labels=True),
    "holes": lambda: flaunay.triangulate(FRAME, RINGS, [[3, 3]], halfedges=True),
    "sets": lambda: flaunay.triangulate(FRAME + FRAME, [[4, 6], [13, 15]], offsets=[0, 8, 16]),
    "split": lambda: flaunay.triangulate(FRAME, [[0, 2], [1, 3], [4, 2]], crossings="split"),
    "refined": lambda: flaunay.refine(FRAME, RINGS, min_angle=30, max_area=0.5, outside="holes"),
    "again": lambda: flaunay.refine(flaunay.refine(FRAME, RINGS), max_area=1),
    "points": lambda: flaunay.refine(points(), conforming=True),
    "polygons": lambda: flaunay.polygons([[SQUARE, FRAME[4:]], [SQUARE]], labels=True),
    "map": lambda: flaunay.polygons([[SQUARE], [FRAME[4:]]], map=True, max_area=1),
    "weighted": lambda: flaunay.weighted(points(), points()[:, 0]),
    "periodic": lambda: flaunay.periodic(points(), (8, 8)),
    "spherical": lambda: flaunay.spherical(10 * points()),
    "delaunay": lambda: flaunay.Delaunay(points()),
}


@pytest.mark.parametrize("kind", RESULTS)
def test_right_results_are_right(kind):
    assert RESULTS[kind]().verify() is None


@pytest.mark.parametrize("kind", ["segments", "refined", "polygons"])
def test_wrong_results_are_found(kind):
    result = pickle.loads(pickle.dumps(RESULTS[kind]()))
    result.verify()
    result.triangles[1] = result.triangles[0]
    with pytest.raises(flaunay.InternalError, match="triangle"):
        result.verify()


def test_triangulations_without_points():
    given = points()
    mesh = flaunay.triangulate(given, offsets=[0, 40, 40, 100], halfedges=True, areas=True)
    flaunay.verify(given, mesh, [0, 40, 40, 100])
    for array in ("triangles", "neighbors", "halfedges", "hull", "representatives", "areas"):
        wrong = pickle.loads(pickle.dumps(mesh))
        getattr(wrong, array).flat[3] += 1
        with pytest.raises((flaunay.InternalError, flaunay.UsageError)):
            flaunay.verify(given, wrong, [0, 40, 40, 100])
    for other in flaunay.Delaunay(given), flaunay.triangulate(given, segments=[[0, 1]]):
        with pytest.raises(flaunay.UsageError, match="take its method verify"):
            flaunay.verify(given, other)
    with pytest.raises(flaunay.UsageError, match="not ndarray"):
        flaunay.verify(given, mesh.triangles)
    with pytest.raises(flaunay.UsageError, match="has 3 sets, but there are 1"):
        flaunay.verify(given, mesh)
    with pytest.raises(flaunay.UsageError, match="has 100 points, but there are 99"):
        flaunay.verify(given[1:], mesh, [0, 40, 40, 99])


def test_points_that_were_removed_and_moved():
    tri = flaunay.Delaunay(points(), incremental=True)
    tri.remove_points([0, 5, 17])
    tri.move_points([7], [[3.5, 3.5]])
    tri.add_points([[9, 9], [9, 9]])
    tri.verify()
