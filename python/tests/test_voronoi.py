"""flaunay.Voronoi beside scipy.spatial.Voronoi."""

import copy
import pickle
from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial
from conftest import grid

import flaunay
from flaunay import _calls


def place(voronoi, vertex):
    return None if vertex < 0 else tuple(np.round(voronoi.vertices[vertex], 6))


def ridges(voronoi):
    """For each pair of points the ends of the ridge between them."""
    pairs = np.sort(voronoi.ridge_points, axis=1).tolist()
    ends = np.asarray(voronoi.ridge_vertices).tolist()
    return {tuple(pair): {place(voronoi, v) for v in both} for pair, both in zip(pairs, ends)}


@pytest.fixture
def points(random):
    # Far enough from each other for circumcentres that are the same to six places.
    return grid(10) + random.uniform(-0.3, 0.3, (100, 2))


def test_the_ridges_are_those_of_scipy(points):
    mine, theirs = flaunay.Voronoi(points), scipy.spatial.Voronoi(points)
    assert mine.ridge_points.dtype == theirs.ridge_points.dtype
    assert len(mine.vertices) == len(theirs.vertices)
    assert ridges(mine) == ridges(theirs)


def test_of_a_triangulation(points):
    expected, tri = flaunay.Voronoi(points), flaunay.Delaunay(points)
    mine = flaunay.Voronoi(tri)
    assert mine.delaunay is tri
    np.testing.assert_array_equal(mine.cells, expected.cells)
    np.testing.assert_array_equal(mine.vertices, expected.vertices)
    # It stays as it is when the triangulation changes.
    living = flaunay.Delaunay(points, incremental=True)
    mine = flaunay.Voronoi(living)
    living.add_points([[5, 5]])
    assert mine.npoints == 100 and mine.ridge_dict == expected.ridge_dict
    with pytest.raises(flaunay.UsageError, match="not for a triangulation"):
        flaunay.Voronoi(tri, incremental=True)


def test_the_regions_are_those_of_scipy(points):
    mine, theirs = flaunay.Voronoi(points), scipy.spatial.Voronoi(points)

    def corners(voronoi, point):
        region = voronoi.regions[voronoi.point_region[point]]
        return -1 in region, {place(voronoi, v) for v in region}

    for point in range(len(points)):
        assert corners(mine, point) == corners(theirs, point)


def test_the_cell_of_a_duplicate_is_its_twins():
    vor = flaunay.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2.5], [2, 0]])
    assert vor.point_region.tolist() == [0, 1, 2, 3, 1]
    assert vor.regions[4] == []


@pytest.mark.parametrize(
    "points", [np.empty((0, 2)), [[1.0, 2.0]], [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]]
)
def test_points_without_triangles(points):
    vor = flaunay.Voronoi(points)
    n = len(points)
    assert vor.vertices.shape == (0, 2) and vor.ridge_points.shape == vor.ridge_vertices.shape == (
        0,
        2,
    )
    assert vor.regions == [[]] * n
    assert vor.point_region.tolist() == [-1] * n
    assert vor.unbounded.tolist() == [True] * n and vor.npoints == n


def test_grids_have_ridges_without_length():
    vor = flaunay.Voronoi(grid(4))
    assert len(vor.vertices) == 18
    assert len(np.unique(vor.vertices, axis=0)) == 9


def test_errors():
    with pytest.raises(flaunay.UsageError, match="shape"):
        flaunay.Voronoi([1.0, 2.0])
    with pytest.raises(flaunay.InputError, match="point 0 is not finite"):
        flaunay.Voronoi([[np.nan, 0.0]])


# ---- Merged vertices


def circle(count):
    """Points with integer coordinates on a circle of the radius 5 * 13 * 17."""
    pairs = [(x, y) for x in range(-1105, 1106) for y in [round((1105**2 - x * x) ** 0.5)]]
    ring = [(x, y) for x, y in pairs if x * x + y * y == 1105**2]
    return np.array((ring + [(x, -y) for x, y in ring if y])[:count], float)


ROTATED = np.array([[3.0, 4.0], [-4.0, 3.0]])

COCIRCULAR = {
    "grid": grid(20),
    "unequal steps": grid(20) / 19,
    "rotated": grid(20) @ ROTATED,
    "rotated, of 40 digits": (grid(20) + 2.0**35) @ ROTATED,
    "rotated, with large differences": grid(20) @ ROTATED * 12345679,
    "rotated, very small": grid(20) @ ROTATED * 2.0**-400,
    "rotated, very large": grid(20) @ ROTATED * 2.0**400,
    "circle": circle(1000),
    "two circles": np.concatenate([circle(1000), circle(1000) + [5000, 0]]),
    "duplicates": np.concatenate([grid(7), grid(7)[::3]]),
    "triangle": np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
}


def circumcircle(corners):
    """Its centre and squared radius, as fractions."""
    (ax, ay), (bx, by), (cx, cy) = [[Fraction(value) for value in row] for row in corners.tolist()]
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    b, c, d = bx * bx + by * by, cx * cx + cy * cy, 2 * (bx * cy - by * cx)
    x, y = (cy * b - by * c) / d, (bx * c - cx * b) / d
    return ax + x, ay + y, x * x + y * y


@pytest.mark.parametrize("points", COCIRCULAR.values(), ids=COCIRCULAR)
def test_vertices_are_merged_where_circumcircles_are_the_same(points):
    vor = flaunay.Voronoi(points, merge=True)
    circles = [circumcircle(points[row]) for row in vor.delaunay.simplices]
    first = {}
    numbers = [first.setdefault(key, len(first)) for key in circles]
    assert len(vor.vertices) == len(first)
    centres = np.array([[float(x), float(y)] for x, y, _ in first])
    np.testing.assert_allclose(vor.vertices, centres, rtol=1e-9, atol=1e-9 * np.abs(points).max())
    plain = flaunay.Voronoi(points)
    assert len(plain.vertices) == len(circles)
    # Each ridge that has a length, and no other.
    ends = [tuple(numbers[v] if v >= 0 else -1 for v in row) for row in plain.ridge_vertices]
    pairs = plain.ridge_points.tolist()
    expected = {tuple(pair): end for pair, end in zip(pairs, ends) if end[0] != end[1]}
    assert {pair: tuple(end) for pair, end in vor.ridge_dict.items()} == expected
    for region, unmerged in zip(vor.regions, plain.regions):
        kept = [numbers[v] if v >= 0 else -1 for v in unmerged]
        kept = [v for k, v in enumerate(kept) if v != kept[k - 1] or len(set(kept)) == 1]
        assert region == kept
    assert np.array_equal(vor.point_region, plain.point_region)


@pytest.mark.parametrize("n", [2, 3, 30])
def test_a_grid_has_as_many_vertices_as_in_scipy(n):
    vor = flaunay.Voronoi(grid(n), merge=True)
    theirs = scipy.spatial.Voronoi(grid(n))
    assert len(vor.vertices) == len(theirs.vertices) == (n - 1) ** 2
    assert len(vor.ridge_points) == len(theirs.ridge_points)
    assert ridges(vor) == ridges(theirs)


@pytest.mark.parametrize("scale", [1.0, 2.0**-400, 2.0**400])
def test_what_is_nearly_cocircular_is_not_merged(scale):
    square = np.array([[0.0, 0.0], [3.0, 4.0], [-4.0, 3.0], [-1.0, 7.0]])
    assert len(flaunay.Voronoi(square * scale, merge=True).vertices) == 1
    for corner in np.ndindex(2, 2):
        moved = square.copy()
        moved[1:3][corner] = np.nextafter(moved[1:3][corner], 9)
        assert len(flaunay.Voronoi(moved * scale, merge=True).vertices) == 2


def test_cocircularity_is_that_of_fractions(random):
    # Quadrilaterals on circles, of small and large integers and beyond, half of them moved a little.
    ring = circle(1000)
    # Each of two triangles, on both sides of an edge.
    first = 4 * np.arange(100, dtype=np.int32)
    triangles = np.stack([first + k for k in (0, 1, 2, 1, 0, 3)], axis=1).reshape(-1, 3)
    neighbors = np.full((200, 3), -1, np.int32)
    neighbors[:, 2] = np.arange(200) ^ 1
    for scale, digits in (
        (1, 0),
        (12345679, 0),
        (1, 45),
        (2.0**-277, 0),
        (2.0**-300, 0),
        (2.0**300, 45),
    ):
        quads = random.permuted(np.tile(np.arange(len(ring)), (100, 1)), axis=1)[:, :4]
        points = (ring[quads] + (2.0**digits if digits else 0)) * scale
        moved = points[::2, 3]
        moved[...] = np.where(moved == 0, 2.0**-40 * scale, np.nextafter(moved, np.inf))
        expected = []
        for a, b, c, d in points:
            rows = [[Fraction(v) for v in row] for row in (a, b, c, d)]
            (ax, ay), (bx, by), (cx, cy) = [(x - rows[3][0], y - rows[3][1]) for x, y in rows[:3]]
            determinant = (
                (ax * ax + ay * ay) * (bx * cy - cx * by)
                + (bx * bx + by * by) * (cx * ay - ax * cy)
                + (cx * cx + cy * cy) * (ax * by - bx * ay)
            )
            expected.append(determinant == 0)
        found = _calls.same_circles(points.reshape(-1, 2), triangles, neighbors).reshape(-1, 2)
        assert (found[:, 0] == 2 * np.arange(100)).all()
        assert (found[:, 0] == found[:, 1]).tolist() == expected and 50 <= sum(expected) < 100


@pytest.mark.parametrize("merge", [False, True])
def test_arrays_are_read_only(points, merge):
    vor = flaunay.Voronoi(points, merge=merge)
    for other in vor, pickle.loads(pickle.dumps(vor)), copy.deepcopy(vor):
        for name in (
            "points vertices cells cell_offsets unbounded ridge_points ridge_vertices point_region"
        ).split():
            assert np.array_equal(getattr(other, name), getattr(vor, name))
            with pytest.raises(ValueError, match="read-only"):
                getattr(other, name)[...] = 0
