"""Triangulations to which points are added, removed and moved."""

import copy
import multiprocessing
import pickle

import numpy as np
import pytest
from conftest import as_set, check_neighbors

import flaunay


@pytest.fixture
def points(random):
    return random.integers(0, 12, (60, 2)).astype(float)


def check_is_of(tri, places):
    """The triangulation is that of the points that there are. places: of all numbers, NaN for none."""
    there = np.flatnonzero(~np.isnan(places[:, 0]))
    expected = flaunay.Delaunay(places[there])
    assert np.array_equal(tri.points, places, equal_nan=True)
    assert (tri.npoints, tri.nsimplex) == (len(places), expected.nsimplex)
    assert as_set(tri.simplices) == as_set(there[expected.simplices])
    check_neighbors(tri.simplices, tri.neighbors)
    representatives = np.full(len(places), -1)
    representatives[there] = there[expected.representatives]
    assert np.array_equal(tri.representatives, representatives)
    for name in "hull", "convex_hull", "edges":
        assert np.array_equal(getattr(tri, name), there[getattr(expected, name)]), name
    assert np.array_equal(tri.coplanar[:, [0, 2]], there[expected.coplanar[:, [0, 2]]])
    for name in "min_bound", "max_bound":
        assert np.array_equal(getattr(tri, name), getattr(expected, name), equal_nan=True), name
    for name in "areas", "circumradii", "is_gabriel":
        assert sorted(getattr(tri, name)) == sorted(getattr(expected, name)), name
    assert np.isfinite(tri.transform).all() and tri.equations.shape == (tri.nsimplex, 4)
    queries = np.random.default_rng(2).random((50, 2)) * 14 - 1
    assert np.array_equal(tri.find_simplex(queries) < 0, expected.find_simplex(queries) < 0)
    nearest = expected.nearest(queries)
    assert np.array_equal(tri.nearest(queries), there[nearest] if len(there) else nearest)
    values = np.where(np.isnan(places), 99, places) @ [1, 2]
    np.testing.assert_array_equal(
        tri.interpolate(values, queries) > 0, expected.interpolate(values[there], queries) > 0
    )
    simplices = tri.vertex_to_simplex
    vertices = representatives[simplices >= 0]
    assert (tri.simplices[simplices[simplices >= 0]] == vertices[:, None]).any(axis=1).all()
    assert (simplices[np.isnan(places[:, 0])] == -1).all()


class Mirror:
    """The rows of a triangulation by what batches tell of them."""

    def __init__(self, tri):
        self.rows = {k: row for k, row in enumerate(tri.rows().triangles.tolist()) if row[0] >= 0}

    def follow(self, changes, tri):
        assert changes.seconds > 0 and set(changes.removed.tolist()) <= self.rows.keys()
        for row in changes.removed.tolist():
            del self.rows[row]
        made = dict(zip(changes.made.tolist(), changes.made_corners.tolist()))
        assert not made.keys() & self.rows.keys()
        self.rows.update(made)
        triangles, neighbors = tri.rows()
        used = np.flatnonzero(triangles[:, 0] >= 0)
        assert self.rows == dict(zip(used.tolist(), triangles[used].tolist()))
        assert as_set(triangles[used]) == as_set(tri.simplices)
        assert (neighbors[triangles < 0] == -1).all()


def test_batches(points, random):
    tri = flaunay.Delaunay(points[:20], incremental=True)
    mirror, places = Mirror(tri), points[:20]
    for batch in range(12):
        there = np.flatnonzero(~np.isnan(places[:, 0]))
        some = random.permutation(there)[: random.integers(1, 9)].astype(np.int32)
        new = random.integers(0, 12, (len(some), 2)).astype(float)
        if batch % 3 == 0:
            changes = tri.add_points(new)
            assert changes.first_point == len(places)
            places = np.concatenate([places, new])
        elif batch % 3 == 1:
            changes = tri.remove_points(some)
            places = places.copy()
            places[some] = np.nan
        else:
            changes = tri.move_points(some.tolist(), new)
            places = places.copy()
            places[some] = new
            assert np.array_equal(changes.representatives, tri.representatives[some])
        check_is_of(tri, places)
        mirror.follow(changes, tri)
    tri.remove_points(np.flatnonzero(~np.isnan(places[:, 0])))
    check_is_of(tri, np.full_like(places, np.nan))


def test_starting_anew_drops_what_was_removed(points):
    tri = flaunay.Delaunay(points[:20], incremental=True)
    tri.remove_points([3, 4])
    assert tri.add_points(points[20:], restart=True) is None
    check_is_of(tri, np.delete(points, [3, 4], axis=0))
    tri.add_points(points[:1].astype(np.float32))
    check_is_of(tri, np.concatenate([np.delete(points, [3, 4], axis=0), points[:1]]))


def test_what_is_closed_or_copied_stays_as_it_is(points):
    tri = flaunay.Delaunay(points[:20], incremental=True)
    tri.remove_points([7])
    places = tri.points
    copies = copy.copy(tri), copy.deepcopy(tri), pickle.loads(pickle.dumps(tri))
    tri.add_points(points[20:])
    check_is_of(tri, np.concatenate([places, points[20:]]))
    tri.close()
    check_is_of(tri, np.concatenate([places, points[20:]]))
    for one in copies:
        check_is_of(one, places)
        for change in (
            lambda: one.add_points(points),
            lambda: one.remove_points([0]),
            lambda: one.move_points([0], points[:1]),
            one.rows,
        ):
            with pytest.raises(flaunay.UsageError, match="not incremental, was closed"):
                change()


@pytest.mark.parametrize(
    "change, error, message",
    [
        (lambda tri: tri.add_points([[0, np.nan]]), flaunay.InputError, "point 0"),
        (lambda tri: tri.add_points([0, 1]), flaunay.UsageError, "two dimensions"),
        (lambda tri: tri.add_points([[1, 2, 3]]), flaunay.UsageError, "two-dimensional"),
        (lambda tri: tri.remove_points([60]), flaunay.InputError, "60, which does not exist"),
        (lambda tri: tri.remove_points([5]), flaunay.InputError, "5, which was removed"),
        (lambda tri: tri.remove_points([1, 1]), flaunay.InputError, "1, which is there twice"),
        (lambda tri: tri.remove_points([2**40]), flaunay.UsageError, "number of no point"),
        (lambda tri: tri.remove_points([[1, 2]]), flaunay.UsageError, "one dimension"),
        (lambda tri: tri.remove_points([0.5]), flaunay.UsageError, "integers"),
        (lambda tri: tri.move_points([1, 2], [[1, 2]]), flaunay.UsageError, "2 points"),
    ],
)
def test_bad_batches_change_nothing(points, change, error, message):
    tri = flaunay.Delaunay(points, incremental=True)
    tri.remove_points([5])
    before = tri.points
    with pytest.raises(error, match=message):
        change(tri)
    check_is_of(tri, before)


def test_other_modes_are_not_incremental(points):
    with pytest.raises(flaunay.UsageError, match="mode 'dwyer' cannot be incremental"):
        flaunay.Delaunay(points, incremental=True, mode="dwyer")


def test_segments(random):
    square = np.array([[0, 0], [8, 0], [8, 8], [0, 8.0]])
    tri = flaunay.DynamicTriangulation(square, segments=[[0, 1], [1, 3]], device="host")
    tri.insert([[4, 4], [2, 1]])
    tri.insert(random.random((20, 2)) * 8)
    edges, segments = tri.constraints()
    assert {frozenset(edge) for edge in edges.tolist()} == {
        frozenset(edge) for edge in ((0, 1), (1, 4), (4, 3))
    }
    assert sorted(segments.tolist()) == [0, 1, 1]
    expected = flaunay.triangulate(tri.points, segments=edges)
    assert as_set(tri.triangulation().triangles) == as_set(expected.triangles)
    with pytest.raises(flaunay.InputError, match="point 3 cannot be removed: it is on segment 1"):
        tri.remove([3])
    tri.move([5], [[3, 1]])
    assert tri.point_count == 26 and tri.points[5].tolist() == [3, 1]


def test_crossing_segments(points):
    square = np.array([[0, 0], [8, 0], [8, 8], [0, 8.0]])
    crossing = [[0, 2], [1, 3]]
    with pytest.raises(flaunay.InputError, match="cross"):
        flaunay.DynamicTriangulation(square, crossing)
    tri = flaunay.DynamicTriangulation(square, crossing, crossings="split")
    assert tri.insert([[1, 2]]).first_point == 5 and tri.points[4].tolist() == [4, 4]
    with pytest.raises(flaunay.UsageError, match="crossings must be"):
        flaunay.DynamicTriangulation(square, crossing, crossings="none")


def all_of(tri):
    return tri.points, tri.triangulation().representatives, *map(np.asarray, tri.constraints())


COPIES = [copy.copy, copy.deepcopy, lambda tri: pickle.loads(pickle.dumps(tri))]


@pytest.mark.parametrize("copied", COPIES)
def test_copies_change_on_their_own(random, copied):
    # The largest number and the first of two equal points are among those that are removed.
    points = np.concatenate([[[4, 4], [0, 0], [8, 0], [8, 8], [0, 8]], random.integers(0, 9, (40, 2))])
    segments = [[1, 2], [4, 2], [1, 3]]
    tri = flaunay.DynamicTriangulation(points, segments, crossings="split", device="host")
    tri.insert([[2, 0], [4, 4], [9, 9]])
    free = [k for k in np.flatnonzero(~np.isin(np.arange(tri.numbers), tri.constraints().edges)) if k > 4]
    tri.remove([free[3], free[7], tri.numbers - 1])
    for one in copied(tri), copied(copied(tri)):
        assert (one.numbers, one.point_count) == (tri.numbers, tri.point_count)
        for found, want in zip(all_of(one)[:2], all_of(tri)):
            assert np.array_equal(found, want, equal_nan=found.dtype.kind == "f")
        assert as_set(one.triangulation().triangles) == as_set(tri.triangulation().triangles)
        (edges, of), (own_edges, own_of) = tri.constraints(), one.constraints()
        assert dict(zip(map(tuple, own_edges.tolist()), own_of)) == dict(zip(map(tuple, edges.tolist()), of))
        with pytest.raises(flaunay.InputError, match=r"point 4 cannot be removed: it is on segment 1 \("):
            one.remove([4])
        with pytest.raises(flaunay.InputError, match=r"point 3 cannot be moved: it is on segment 2 \("):
            one.move([3], [[7, 7]])
        assert one.insert([[3, 5]]).first_point == tri.numbers
        one.move([free[0]], [[1, 6]])
        assert one.point_count == tri.point_count + 1
    assert tri.points.shape == (tri.numbers, 2)


def test_copies_of_few_points():
    for points, removed in ([], []), ([[0, 0]], [0]), ([[0, 0], [1, 1]], [0]), ([[0, 0], [0, 0]], [0]):
        tri = flaunay.DynamicTriangulation(np.reshape(points, (-1, 2)), device="host")
        tri.remove(np.array(removed, int))
        one = copy.copy(tri)
        for found, want in zip(all_of(one), all_of(tri)):
            assert np.array_equal(found, want, equal_nan=found.dtype.kind == "f")
        assert one.insert([[5, 5]]).first_point == len(points)


def test_copies_of_the_smallest_points():
    places = np.array([[1, 1], [0, 0], [3, 0], [3, 3], [0, 3]]) * 2.0**-1074
    tri = flaunay.DynamicTriangulation(places, [[2, 3]], device="host")
    tri.remove([0])
    one = copy.copy(tri)
    assert np.array_equal(one.points, tri.points, equal_nan=True)
    assert as_set(one.triangulation().triangles) == as_set(tri.triangulation().triangles)


def test_copies_of_large_points():
    far = np.finfo(np.float64).max
    tri = flaunay.DynamicTriangulation([[far, 0], [0, far], [-far, 0], [0, 0]], device="host")
    tri.remove([3])
    assert np.array_equal(copy.copy(tri).points, tri.points, equal_nan=True)
    tri.insert([[0, -far]])
    with pytest.raises(TypeError, match="cannot be copied: remove one"):
        copy.copy(tri)


def test_handles_of_the_library_say_that_they_cannot_be_copied(capfd):
    handle = flaunay._calls.PointTree(flaunay._triangulators.of_device("host"), np.zeros((1, 2)))
    for copied in COPIES:
        with pytest.raises(TypeError, match="PointTree cannot be copied or pickled"):
            copied(handle)
    type(handle).__new__(type(handle)).__del__()
    assert capfd.readouterr().err == ""


def test_points_in_device_memory(random, queue):
    cl_array = pytest.importorskip("pyopencl.array")
    points = random.random((300, 2))
    tri = flaunay.DynamicTriangulation(cl_array.to_device(queue, points[:200]))
    tri.insert(cl_array.to_device(queue, points.astype(np.float32))[200:])
    tri.insert(points[:1])
    given = np.concatenate([points[:200], points[200:].astype(np.float32), points[:1]])
    assert np.array_equal(tri.points, given)
    assert as_set(tri.triangulation().triangles) == as_set(flaunay.Delaunay(given).simplices)
    tri.remove([0, 7])
    on_device, rows = tri.rows_on_device(), tri.rows()
    assert np.array_equal(on_device.triangles.get(), rows.triangles)
    assert np.array_equal(on_device.neighbors.get(), rows.neighbors)
    assert np.array_equal(on_device.points.get(), tri.points, equal_nan=True)
    on_device.event.wait()
    with pytest.raises(flaunay.UsageError, match="made of points in host memory"):
        flaunay.DynamicTriangulation(points).rows_on_device()
    with pytest.raises(TypeError, match="cannot be copied or pickled: make another one"):
        copy.copy(tri)
    with pytest.raises(flaunay.UsageError, match="for points in host memory"):
        flaunay.DynamicTriangulation(cl_array.to_device(queue, points), segments=[[0, 1]])


def _use_in_child(tri, answers):
    try:
        tri.add_points([[1.0, 2.0]])
    except flaunay.UsageError as error:
        answers.put(str(error))


@pytest.mark.filterwarnings("ignore:This process.*multi-threaded:DeprecationWarning")
def test_it_is_that_of_its_process(points):
    tri = flaunay.Delaunay(points, incremental=True, device="host")
    fork = multiprocessing.get_context("fork")
    answers = fork.Queue()
    child = fork.Process(target=_use_in_child, args=(tri, answers), daemon=True)
    child.start()
    assert "process that was forked" in answers.get(timeout=60)
    child.join(60)
    assert child.exitcode == 0
    tri.add_points([[1.0, 2.0]])


def test_handed_over_to_scipy(points):
    tri = flaunay.Delaunay(points, incremental=True)
    tri.remove_points([int(tri.hull[0])])
    made = tri.to_scipy()
    queries = np.random.default_rng(3).random((50, 2)) * 12
    assert np.array_equal(made.find_simplex(queries), tri.find_simplex(queries))
