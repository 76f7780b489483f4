"""flaunay.Delaunay beside scipy.spatial.Delaunay, and where it differs on purpose."""

import copy
import pickle

import numpy as np
import pytest
import scipy.spatial
from conftest import as_set, check_neighbors, grid

import flaunay

# The points of the examples in scipy.spatial.Delaunay's documentation.
FOUR = np.array([[0, 0], [0, 1.1], [1, 0], [1, 1]])


@pytest.mark.parametrize("n", [3, 4, 1000])
def test_the_triangles_are_those_of_scipy(random, n):
    points = random.random((n, 2))
    mine, theirs = flaunay.Delaunay(points), scipy.spatial.Delaunay(points)
    assert as_set(mine.simplices) == as_set(theirs.simplices)
    assert as_set(mine.convex_hull) == as_set(theirs.convex_hull)
    check_neighbors(mine.simplices, mine.neighbors)
    assert (mine.simplices[mine.vertex_to_simplex] == np.arange(n)[:, None]).any(axis=1).all()
    assert mine.nsimplex == theirs.nsimplex and mine.npoints == n and mine.ndim == theirs.ndim == 2
    assert np.array_equal(mine.min_bound, theirs.min_bound)
    assert np.array_equal(mine.max_bound, theirs.max_bound)


def test_types_and_shapes_are_those_of_scipy(random):
    points = random.random((100, 2))
    mine, theirs = flaunay.Delaunay(points), scipy.spatial.Delaunay(points)
    for name in "simplices", "neighbors", "convex_hull", "coplanar", "vertex_to_simplex":
        ours, other = getattr(mine, name), getattr(theirs, name)
        assert ours.dtype == other.dtype == np.int32, name
        assert ours.shape == other.shape, name
    assert mine.min_bound.shape == mine.max_bound.shape == (2,)


def test_the_hull_is_a_ring_of_edges_with_the_points_on_them():
    # 3 x 3 points: the hull has all but the one in the middle.
    tri = flaunay.Delaunay(grid(3))
    around = [0, 1, 2, 5, 8, 7, 6, 3]
    assert tri.hull.tolist() == around
    assert tri.convex_hull.tolist() == [list(ends) for ends in zip(around, [*around[1:], 0])]
    assert as_set(tri.convex_hull) == as_set(scipy.spatial.Delaunay(tri.points).convex_hull)


def test_many_duplicates(random):
    points = random.integers(0, 20, (2000, 2)).astype(float)
    tri = flaunay.Delaunay(points)
    _, first, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    assert np.array_equal(tri.representatives, first[inverse.ravel()])
    assert len(tri.coplanar) == 2000 - len(first)
    point, simplex, equal = tri.coplanar.T
    assert np.array_equal(points[point], points[equal])
    assert (tri.simplices[simplex] == equal[:, None]).any(axis=1).all()
    assert np.array_equal(tri.vertex_to_simplex[point], tri.vertex_to_simplex[equal])
    indptr, _ = tri.vertex_neighbor_vertices
    assert (np.diff(indptr)[point] == 0).all()


@pytest.mark.parametrize(
    "points, hull",
    [
        (np.empty((0, 2)), []),
        ([[3.0, 4.0]], [0]),
        ([[3.0, 4.0], [1.0, 5.0]], [1, 0]),
        ([[3.0, 4.0]] * 5, [0]),
        ([[2.0, 2.0], [0.0, 0.0], [1.0, 1.0], [0.0, 0.0]], [1, 2, 0]),
    ],
    ids=["none", "one", "two", "all equal", "on a line"],
)
def test_points_without_triangles_are_no_error(points, hull):
    with pytest.raises((scipy.spatial.QhullError, ValueError)):
        scipy.spatial.Delaunay(points)
    tri = flaunay.Delaunay(points)
    n = len(points)
    assert tri.simplices.shape == tri.neighbors.shape == (0, 3)
    assert tri.simplices.dtype == tri.neighbors.dtype == np.int32
    assert tri.hull.tolist() == hull
    assert tri.convex_hull.shape == (0, 2)
    assert tri.vertex_to_simplex.tolist() == [-1] * n
    assert tri.vertex_neighbor_vertices[0].tolist() == [0] * (n + 1)
    assert len(tri.coplanar) == n - len(hull)
    assert (tri.coplanar[:, 1] == -1).all()
    assert np.isnan(tri.min_bound).all() == (n == 0)


def test_points_are_a_copy(random):
    points = random.random((10, 2))
    tri = flaunay.Delaunay(points)
    before = points.copy()
    points[:] = 0
    assert np.array_equal(tri.points, before)


ARRAYS = (
    "points simplices neighbors hull representatives min_bound max_bound convex_hull coplanar "
    "vertex_to_simplex transform equations good"
).split()


def arrays_of(tri):
    return [getattr(tri, name) for name in ARRAYS] + list(tri.vertex_neighbor_vertices)


COPIES = {
    "the object": lambda tri: tri,
    "pickle": lambda tri: pickle.loads(pickle.dumps(tri)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
@pytest.mark.parametrize("points", [FOUR, FOUR[:2], FOUR[:0]], ids=["four", "two", "none"])
def test_arrays_are_read_only(points, copied):
    tri = flaunay.Delaunay(points)
    for other in copied(tri), (arrays_of(tri), copied(tri))[1]:
        for mine, array in zip(arrays_of(tri), arrays_of(other)):
            assert np.array_equal(mine, array, equal_nan=True)
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0
            with pytest.raises(ValueError, match="read-only"):
                array.sort()
            changed = array.copy()
            changed[...] = 0


def test_what_is_asked_of_qhull_and_changes_nothing(random):
    points = random.random((50, 2))
    expected = flaunay.Delaunay(points)
    for options in None, "", "Qbb Qc Qz Q12", "Qt Qx Pp Q1 Q15 Qs", "QJ", "QJ Pp", "QJ1e-9 Qbb":
        for tri in (
            flaunay.Delaunay(points, False, False, options),
            flaunay.Voronoi(points, qhull_options=options).delaunay,
        ):
            assert np.array_equal(tri.simplices, expected.simplices)
    assert expected.furthest_site is False


@pytest.mark.parametrize("make", [flaunay.Delaunay, flaunay.Voronoi])
@pytest.mark.parametrize(
    "given, message",
    [
        ({"furthest_site": True}, "furthest_site=True is not possible"),
        ({"qhull_options": "Qbb Qu"}, "Qu is furthest_site=True"),
        ({"qhull_options": "C-0.1"}, "option C-0.1 is not known"),
        ({"qhull_options": "QG4"}, "option QG4 is not known"),
    ],
)
def test_what_is_asked_of_qhull_and_is_not_possible(make, given, message):
    with pytest.raises(flaunay.UsageError, match=message):
        make(FOUR, **given)


def test_options_of_qhull_that_are_no_text():
    with pytest.raises(TypeError, match="qhull_options must be a string, not bytes"):
        flaunay.Delaunay(FOUR, qhull_options=b"Qbb")


@pytest.mark.parametrize(
    "points, message",
    [
        ([[0, 0], [1, 0], [0, 1], [1, 0]], "point 3 equals point 1"),
        ([[0, 0], [1, 1], [2, 2]], "points have no triangles"),
    ],
)
def test_joggled_input_where_a_point_is_no_vertex(points, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.Delaunay(points, qhull_options="QJ")


def test_points_cannot_be_added_as_in_scipy_without_incremental():
    for kind in flaunay.Delaunay, flaunay.Voronoi, scipy.spatial.Delaunay:
        closed = kind(FOUR, incremental=True)
        closed.close()
        for tri in kind(FOUR), closed:
            with pytest.raises(RuntimeError):
                tri.add_points([[3.0, 3.0]])


def test_closing_leaves_everything_usable(random):
    tri = flaunay.Delaunay(random.random((50, 2)))
    tri.close()
    expected = tri.find_simplex([0.5, 0.5])
    tri.close()
    tri.close()
    assert tri.find_simplex([0.5, 0.5]) == expected


def test_modes(random):
    points = random.random((300, 2))
    expected = as_set(flaunay.Delaunay(points).simplices)
    for mode in flaunay.modes():
        tri = flaunay.Delaunay(points, mode=mode["name"])
        assert as_set(tri.simplices) == expected
        assert np.array_equal(
            tri.simplices, flaunay.triangulate(points, mode=mode["name"]).triangles
        )
        assert len(flaunay.Voronoi(points, mode=mode["name"]).vertices) == len(expected)
    with pytest.raises(flaunay.UsageError, match="no mode 'fast'"):
        flaunay.Delaunay(points, mode="fast")


@pytest.mark.parametrize("index", [-1, 100, 10**9, -(2**31)])
@pytest.mark.parametrize(
    "name, attributes",
    [
        ("simplices", ["vertex_neighbor_vertices", "vertex_to_simplex", "coplanar"]),
        ("hull", ["vertex_neighbor_vertices"]),
        ("representatives", ["vertex_to_simplex", "coplanar"]),
    ],
)
def test_indices_that_were_changed_to_no_point(random, name, attributes, index):
    tri = flaunay.Delaunay(random.random((100, 2)))
    for place in slice(None), -1:
        changed = getattr(tri, name).copy()
        changed[place] = index
        setattr(tri, name, changed)
        for attribute in attributes:
            with pytest.raises(flaunay.UsageError, match=f"{name} .*{index} is none of the 100"):
                getattr(tri, attribute)


def test_indices_that_were_changed_to_other_points(random):
    tri = flaunay.Delaunay(random.random((100, 2)))
    for name in "simplices", "hull", "representatives":
        setattr(tri, name, np.full_like(getattr(tri, name), 99))
    starts, indices = tri.vertex_neighbor_vertices
    assert starts[99] == 0 and starts[100] == len(indices) and (indices == 99).all()
    assert (tri.vertex_to_simplex == 0).all()


def test_arrays_of_another_shape(random):
    tri = flaunay.Delaunay(random.random((100, 2)))
    tri.simplices, simplices = tri.simplices.ravel()[:-1], tri.simplices
    for attribute in "vertex_neighbor_vertices", "vertex_to_simplex", "coplanar":
        with pytest.raises(flaunay.UsageError, match="simplices must have the shape"):
            getattr(tri, attribute)
    tri.simplices, tri.representatives = simplices, tri.representatives[:-1]
    for attribute in "vertex_to_simplex", "coplanar":
        with pytest.raises(flaunay.UsageError, match="representatives must have the shape"):
            getattr(tri, attribute)
