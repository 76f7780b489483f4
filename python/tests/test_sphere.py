"""Points on a sphere, beside SciPy's convex hulls and Voronoi cells."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import scipy.spatial
from conftest import as_set, check_neighbors

import flaunay


def on_sphere(random, n):
    points = random.normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def lonlat_of(xyz):
    return np.degrees(np.stack([np.arctan2(xyz[:, 1], xyz[:, 0]), np.arcsin(xyz[:, 2])], axis=1))


def test_triangles_are_scipys_convex_hull(random):
    points = on_sphere(random, 300)
    tri = flaunay.spherical(points)
    assert as_set(tri.simplices) == as_set(scipy.spatial.ConvexHull(points).simplices)
    check_neighbors(tri.simplices, tri.neighbors)
    np.testing.assert_allclose(tri.xyz, points, atol=1e-15)
    tri.verify()


def test_cells_are_scipys(random):
    points = on_sphere(random, 500)
    cells = flaunay.spherical(points).voronoi
    expected = scipy.spatial.SphericalVoronoi(points)
    np.testing.assert_allclose(cells.areas, expected.calculate_areas(), rtol=1e-9)
    assert cells.areas.sum() == pytest.approx(4 * np.pi, abs=1e-12)
    assert [len(region) for region in cells.regions] == [len(region) for region in expected.regions]
    distance, _ = scipy.spatial.cKDTree(expected.vertices).query(cells.vertices)
    assert distance.max() < 1e-9
    assert repr(cells) == "<flaunay.SphericalVoronoi: 500 points, 996 vertices>"


def test_longitudes_and_latitudes_are_directions(random):
    points = on_sphere(random, 400)
    lonlat = lonlat_of(points)
    tri = flaunay.spherical(lonlat)
    np.testing.assert_allclose(tri.xyz, points, atol=1e-15)
    np.testing.assert_array_equal(tri.simplices, flaunay.spherical(points).simplices)
    lonlat[:, 0] += 720
    np.testing.assert_array_equal(flaunay.spherical(lonlat).simplices, tri.simplices)
    # A globe of degrees: both poles are one point each.
    globe = np.stack(np.meshgrid(np.arange(0, 360, 15), np.arange(-90, 91, 15)), axis=-1)
    tri = flaunay.spherical(globe.reshape(-1, 2))
    assert len(np.unique(tri.representatives)) == 24 * 11 + 2
    assert tri.nsimplex == 2 * (24 * 11 + 2) - 4
    tri.verify()


def test_queries(random):
    points, queries = on_sphere(random, 300), on_sphere(random, 1000)
    tri = flaunay.spherical(points)
    np.testing.assert_array_equal(tri.nearest(queries), (queries @ points.T).argmax(axis=1))
    assert tri.nearest(lonlat_of(queries).reshape(10, 100, 2)).shape == (10, 100)
    found = tri.find_simplex(queries)
    weights = np.linalg.solve(points[tri.simplices[found]].transpose(0, 2, 1), queries[:, :, None])
    assert (found >= 0).all() and (weights > 0).all()
    values = random.normal(size=(300, 2))
    np.testing.assert_array_equal(tri.interpolate(values, points), values)
    expected = (values[tri.simplices[found]] * (weights / weights.sum(axis=1)[:, None])).sum(axis=1)
    np.testing.assert_allclose(tri.interpolate(values, queries), expected, atol=1e-12)
    np.testing.assert_array_equal(tri.interpolate(values, queries, "nearest"), values[tri.nearest(queries)])
    for method in ("clough-tocher", "sibson", "laplace"):
        np.testing.assert_array_equal(tri.interpolate(values, points, method), values)
        np.testing.assert_allclose(tri.interpolate(np.ones(300), queries, method), 1, rtol=1e-14)
        assert abs(tri.interpolate(points, queries, method) - queries).max() < 0.1
    # Of linear functions of space, whose gradients are known.
    tangents = np.eye(3) - tri.xyz[:, :, None] * tri.xyz[:, None]
    given = tri.interpolate(tri.xyz, queries, "clough-tocher", gradients=tangents)
    assert abs(given - tri.interpolate(tri.xyz, queries)).max() > 0.01 > 10 * abs(given - queries).max()
    assert abs(tri.gradients(tri.xyz) - tangents).max() < 0.5
    np.testing.assert_array_equal(
        tri.interpolate(tri.xyz, queries, "clough-tocher", gradients=tri.gradients(tri.xyz)),
        tri.interpolate(tri.xyz, queries, "clough-tocher"),
    )
    # Half of the sphere: beyond it is no triangle.
    north = flaunay.spherical(points[points[:, 2] > 0.1])
    assert (north.find_simplex(queries[queries[:, 2] < 0]) == -1).all()
    assert np.isnan(north.interpolate(np.ones(north.npoints), [0, 0, -1]))


def test_sets_are_each_as_alone(random):
    parts = [on_sphere(random, n) for n in (50, 0, 7, 1, 2, 3)]
    offsets = np.cumsum([0] + [len(part) for part in parts])
    tri = flaunay.spherical(np.concatenate(parts), offsets)
    for s, part in enumerate(parts):
        alone = flaunay.spherical(part)
        own = slice(tri.simplex_offsets[s], tri.simplex_offsets[s + 1])
        np.testing.assert_array_equal(tri.simplices[own] - offsets[s], alone.simplices)
        areas = tri.voronoi.areas[offsets[s] : offsets[s + 1]]
        np.testing.assert_array_equal(areas, alone.voronoi.areas)
    tri.verify()
    queries, of_sets = on_sphere(random, 60), [0, 10, 20, 30, 40, 50, 60]
    values = random.normal(size=len(tri.points))
    answers = [tri.find_simplex(queries, offsets=of_sets), tri.nearest(queries, offsets=of_sets)]
    between = tri.interpolate(values, queries, offsets=of_sets)
    for s, part in enumerate(parts):
        alone, asked = flaunay.spherical(part.reshape(-1, 3)), slice(of_sets[s], of_sets[s + 1])
        for answer, own, first in zip(
            answers,
            [alone.find_simplex(queries[asked]), alone.nearest(queries[asked])],
            [tri.simplex_offsets[s], offsets[s]],
        ):
            np.testing.assert_array_equal(answer[asked], np.where(own < 0, -1, own + first))
        own_values = values[offsets[s] : offsets[s + 1]]
        np.testing.assert_array_equal(between[asked], alone.interpolate(own_values, queries[asked]))
    with pytest.raises(flaunay.UsageError, match="1 sets"):
        tri.nearest([0, 0])
    with pytest.raises(flaunay.UsageError, match="one set"):
        tri.nearest([0, 0], k=2)


def test_copies_and_every_device_agree(random):
    points = on_sphere(random, 900)
    tri = flaunay.spherical(points, device="host")
    tri.nearest([0, 0])
    for other in (flaunay.spherical(points, device="#0"), pickle.loads(pickle.dumps(tri))):
        np.testing.assert_array_equal(other.simplices, tri.simplices)
        np.testing.assert_array_equal(other.nearest([[9, 9]]), tri.nearest([[9, 9]]))
        assert other.voronoi.areas.tobytes() == tri.voronoi.areas.tobytes()
    with pytest.raises(ValueError, match="read-only"):
        tri.simplices[0] = 0


def test_no_sets():
    none = np.zeros((0, 2))
    results = (
        flaunay.spherical(none, offsets=[0]),
        flaunay.periodic(none, (1, 1), offsets=[0]),
        flaunay.weighted(none, none[:, 0], offsets=[0]),
    )
    assert [mesh.simplex_offsets.tolist() for mesh in results] == [[0]] * 3


def test_errors_say_what_is_wrong():
    cases = [
        ([[0, 91]], flaunay.InputError, "point 0: the latitude 91"),
        ([[1, 0, 0], [0, 0, 0]], flaunay.InputError, "point 1 is the vector 0"),
        ([[0, np.nan]], flaunay.InputError, "point 0 is not finite"),
        ([[1, 2, 3, 4]], flaunay.UsageError, "longitudes and latitudes"),
        ([1, 2], flaunay.UsageError, r"\(n, 2\) or \(n, 3\)"),
        ([["a", "b"]], flaunay.UsageError, "real numbers"),
    ]
    for points, kind, message in cases:
        with pytest.raises(kind, match=message):
            flaunay.spherical(points)
    tri = flaunay.spherical([[0, 0], [90, 0], [0, 90]])
    with pytest.raises(flaunay.InputError, match="query 1: the latitude"):
        tri.find_simplex([[0, 0], [0, -100]])
    with pytest.raises(flaunay.UsageError, match="one row per point, 3"):
        tri.interpolate([1, 2], [0, 0])
    with pytest.raises(flaunay.UsageError, match="offsets"):
        flaunay.spherical([[0, 0], [1, 1]], [0, 3])


def area_around(site, polygon):
    """The area of a polygon on the sphere that is star-shaped around a site."""
    following = np.roll(polygon, -1, axis=0)
    triple = np.cross(polygon, following) @ site
    return 2 * np.arctan2(triple, 1 + (polygon * following).sum(1) + polygon @ site + following @ site).sum()


@pytest.mark.parametrize("longitudes", [[0, 180], [10, 11], [0, 50, 180], [0, 30, 50], [0, 90, 180, 270]])
@pytest.mark.parametrize("turn", [0.0, 0.5, np.pi / 2])
def test_cells_of_points_on_great_circles_have_their_areas(longitudes, turn):
    angles = np.deg2rad(longitudes)
    x, y = np.cos(angles), np.sin(angles)
    tri = flaunay.spherical(np.column_stack([x, y * np.cos(turn), y * np.sin(turn)]))
    cells = tri.voronoi
    for i, area in enumerate(cells.areas):
        assert area_around(tri.xyz[i], cells.polygon(i)) == pytest.approx(area, abs=1e-13)


def test_cells_of_two_points_are_hemispheres():
    cells = flaunay.spherical([[9, 9], [0, 90], [0, 90], [0, -90], [7, 7]], [0, 1, 4, 5]).voronoi
    assert [len(cells.polygon(i)) for i in range(5)] == [0, 4, 0, 4, 0]
    np.testing.assert_array_equal(cells.polygon(1), cells.polygon(3)[::-1])
    np.testing.assert_allclose(cells.polygon(1)[:, 2], 0, atol=1e-15)


def test_cells_of_a_great_circle_can_be_drawn(random):
    s = 0.5**0.5
    cells = flaunay.spherical([[0, 0], [90, 0], [180, 0], [270, 0]]).voronoi
    lune = [[0, 0, 1], [s, -s, 0], [0, 0, -1], [s, s, 0]]
    np.testing.assert_allclose(cells.polygon(0), lune, atol=1e-15)
    # The corner in the middle of a side is the same for both cells.
    assert cells.polygon(1)[1].tobytes() == cells.polygon(0)[3].tobytes()
    # Within half a circle, the sides between the ends are beyond.
    np.testing.assert_allclose(
        flaunay.spherical([[0, 0], [0, 30], [0, 50]]).voronoi.polygon(0)[3],
        [-np.cos(np.pi * 25 / 180), 0, -np.sin(np.pi * 25 / 180)],
        atol=1e-15,
    )
    points = on_sphere(random, 50)
    cells = flaunay.spherical(points).voronoi
    np.testing.assert_array_equal(cells.polygon(-1), cells.vertices[cells.regions[-1]])
    with pytest.raises(IndexError):
        cells.polygon(50)


@pytest.mark.parametrize("n", [1, 2, 3, 40, 500])
def test_several_nearest_points(n):
    random = np.random.default_rng(n)
    # Many are equal, and many equally far.
    points = random.integers(-2, 3, (n, 3)) * 1.0
    points[~points.any(axis=1)] = 0, 0, -1
    queries = np.concatenate([points[:20], random.normal(size=(30, 3)), [[0, 0, 1], [0, 0, -1]]])
    tri = flaunay.spherical(points)
    angles, found = tri.nearest(queries, k=7, return_distances=True)

    def unit(vectors):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)

    expected = np.arccos((unit(queries) @ unit(points).T).clip(-1, 1))
    wanted = np.full((len(queries), 7), np.inf)
    wanted[:, : min(n, 7)] = np.sort(expected, axis=1)[:, :7]
    assert np.allclose(angles, wanted, atol=1e-7)
    assert np.allclose(np.take_along_axis(expected, found.clip(0), 1), wanted, atol=1e-7) or n < 7
    assert ((found < 0) == np.isinf(wanted)).all()
    assert all(len(set(row[row >= 0])) == min(n, 7) for row in found)
    assert tri.nearest(queries, k=1)[:, 0].tolist() == tri.nearest(queries).tolist()
    near = tri.nearest(queries, k=n, distance_upper_bound=1)
    assert (near >= 0).sum() == (expected <= 1).sum()


def angle(a, b):
    return np.arccos(np.clip((a * b).sum(axis=-1), -1, 1))


@pytest.mark.parametrize("n", [4, 5, 400])
def test_edges_and_areas(random, n):
    tri = flaunay.spherical(random.normal(size=(n, 3)))
    assert len(tri.edges) == 3 * n - 6
    expected = {tuple(sorted(row[[k, k - 1]].tolist())) for row in tri.simplices for k in range(3)}
    assert list(map(tuple, tri.edges.tolist())) == sorted(expected)
    a, b = tri.xyz[tri.edges].transpose(1, 0, 2)
    assert tri.edge_lengths == pytest.approx(angle(a, b), abs=1e-7)
    for (t, u), edge in zip(tri.edge_simplices, tri.edges):
        assert set(edge) == set(tri.simplices[t]) & set(tri.simplices[u])
    # The sides of cells, of which those that coincide have no length.
    sides = np.zeros(n)
    for i, region in enumerate(tri.voronoi.regions):
        at = tri.voronoi.vertices[region]
        sides[i] = angle(at, np.roll(at, 1, axis=0)).sum()
    assert np.bincount(tri.edges.ravel(), np.repeat(tri.ridge_lengths, 2)) == pytest.approx(sides, abs=1e-6)
    # Girard: the sum of the angles is that of a flat triangle, and the area.
    corners = tri.xyz[tri.simplices]
    total = -np.pi
    for k in range(3):
        p, q, r = (corners[:, (k + j) % 3] for j in range(3))
        total = total + angle(*(v / np.linalg.norm(v, axis=1)[:, None] for v in (np.cross(p, q), np.cross(p, r))))
    assert np.abs(tri.areas) == pytest.approx(total, abs=1e-7)
    within = np.abs(tri.areas.sum()) < 1
    assert tri.areas.sum() == pytest.approx(0 if within else 4 * np.pi)


def test_triangles_that_close_the_hull_from_behind(random):
    tri = flaunay.spherical(random.random((30, 2)) * 10)
    assert tri.areas.sum() == pytest.approx(0, abs=1e-15) and (tri.areas < 0).any()
    hull = tri.areas[tri.areas > 0].sum()
    assert 0 < hull < np.radians(10) ** 2
    # A ten-millionth of a degree: small triangles have small errors.
    small = flaunay.spherical([[0, 0], [1e-7, 0], [0, 1e-7]])
    assert np.abs(small.areas) == pytest.approx(np.radians(1e-7) ** 2 / 2, rel=1e-6)
    assert sorted(small.edge_lengths)[:2] == pytest.approx([np.radians(1e-7)] * 2, rel=1e-6)


def test_areas_with_the_centre_on_the_hull():
    longitudes, latitudes = np.meshgrid(np.arange(0, 360, 10.0), np.arange(0, 90, 10.0))
    north = flaunay.spherical(np.column_stack([longitudes.ravel(), latitudes.ravel()]))
    assert north.areas.sum() == pytest.approx(4 * np.pi)
    assert (north.areas > -1e-12).all()
    for equator, expected in [
        ([0, 90, 180, 270], [1, 1, 1, 1]),
        ([0, 72, 144, 216, 288], [0, 0, 0, 0, 2, 2]),
        ([0, 120, 240], [2, 2]),
        ([0, 100, 180], [2, 2]),
        ([0, 60, 100], [0, 0]),
    ]:
        areas = flaunay.spherical([[longitude, 0] for longitude in equator]).areas
        assert sorted(areas / np.pi) == pytest.approx(expected, abs=1e-12)
    # Two edges on a diameter, whose triangles are a right angle apart outside.
    wedge = flaunay.spherical([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert sorted(wedge.areas / np.pi) == pytest.approx([0.5, 0.5, 1.5, 1.5])


def test_areas_of_points_with_small_coordinates(random):
    axis = np.arange(-1, 2)
    cube = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    cube = cube[cube.any(axis=1)]
    directions = np.stack(np.meshgrid(*3 * [np.arange(-5, 6)]), axis=-1).reshape(-1, 3)
    sums = set()
    for _ in range(400):
        points = random.choice(cube, random.integers(3, 9))
        tri = flaunay.spherical(points)
        # The centre is outside if all points lie on one side of a plane through it.
        outside = (points @ directions.T > 0).all(axis=0).any()
        expected = 0 if outside or tri.nsimplex == 0 else 4 * np.pi
        assert tri.areas.sum() == pytest.approx(expected, abs=1e-12)
        sums.add(expected)
    assert len(sums) == 2
