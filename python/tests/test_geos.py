"""Lines and polygons for other programs: GEOS takes them, whatever is rounded. Cells are in test_cells.py."""

import numpy as np
import pytest
from conftest import circle, grid, ring, turned

import flaunay

shapely = pytest.importorskip("shapely", minversion="2.0")


def degenerate_sets(random):
    """Points whose triangles at the hull, or everywhere, are thinner than rounding, or have ties."""
    for angle in (0.001, 0.3, 0.7):
        for offset in (0, 5.8e6):
            yield turned(grid(20), angle) + offset
    yield np.round([7, 45] + grid(20) / 10, 10)
    yield circle(200, 7, [5e5, 5e6])
    x = np.sort(random.random(200))
    yield np.stack([x, 0.37 * x + random.integers(-1, 2, 200) * 2.0**-54], axis=1)
    points = random.random((200, 2))
    yield np.concatenate([points, points + random.integers(1, 3, (200, 2)) * 2.0**-53])


def test_contours_are_simple(random):
    for points in degenerate_sets(random):
        x, y = (points - points.min(axis=0)).T * 20 / np.ptp(points)
        n = len(points)
        for values in (np.sin(x) + y, random.integers(0, 6, n).astype(float), random.normal(3, 1, n)):
            heights = np.arange(0, 6, 0.5)
            lines = flaunay.Delaunay(points).contours(values, heights)
            assert shapely.is_simple([shapely.LineString(line) for _, line in lines]).all()
            rings = [line for (_, line), is_closed in zip(lines, lines.closed) if is_closed]
            assert shapely.is_valid([shapely.Polygon(ring) for ring in rings]).all()
            order = random.permutation(n)
            other = flaunay.Delaunay(points[order]).contours(values[order], heights)
            assert other.points.tobytes() == lines.points.tobytes()


def test_contours_do_not_depend_on_the_scale():
    points = turned(grid(12), 0.3)
    values = np.arange(144) * 7 % 10 % 6
    lines = flaunay.Delaunay(points).contours(values, np.arange(0, 6, 0.5)).points
    for factor in (2.0**-900, 2.0**-300, 2.0**900):
        scaled = flaunay.Delaunay(points * factor).contours(values, np.arange(0, 6, 0.5)).points
        np.testing.assert_array_equal(scaled, lines * factor)


def test_alpha_shapes_are_valid(random):
    for points in degenerate_sets(random):
        tri = flaunay.Delaunay(points)
        for alpha in (np.inf, *np.quantile(tri.circumradii, [0.2, 0.5, 0.9])):
            shape = flaunay.alpha_shape(tri, alpha)
            geometry = shape.to_shapely()
            assert geometry.is_valid, shapely.is_valid_reason(geometry)
            assert geometry.area == pytest.approx(shape.area, rel=1e-6, abs=1e-9)


def check_edges(points, edges):
    """No two edges have more than an end in common."""
    lines = shapely.linestrings(points[edges])
    first, second = shapely.STRtree(lines).query(lines, predicate="intersects")
    first, second = first[first < second], second[first < second]
    shared = shapely.intersection(lines[first], lines[second])
    assert (shapely.get_type_id(shared) == 0).all()
    ends = points[edges[first]]
    assert (ends == shapely.get_coordinates(shared)[:, None]).all(axis=2).any(axis=1).all()


def check_triangles(points, triangles, neighbors):
    """Triangles are valid and tile, their union is valid, and their border has no crossings."""
    polygons = shapely.polygons(points[triangles])
    assert shapely.is_valid(polygons).all()
    assert shapely.coverage_is_valid(polygons)
    triangle, corner = np.nonzero(neighbors < 0)
    border = np.stack([triangles[triangle, (corner + k) % 3] for k in (1, 2)], axis=1)
    check_edges(points, border)
    outline = shapely.union_all(polygons)
    assert outline.is_valid
    assert outline.area == pytest.approx(shapely.area(polygons).sum(), rel=1e-9)


@pytest.mark.parametrize("offset", [0, 5.8e6])
@pytest.mark.parametrize("angle", [0.001, 0.7])
def test_refined_and_split_meshes(random, offset, angle):
    # Houses with courtyards, turned, of which some overlap.
    corners = np.array([[0, 0], [9, 0], [9, 7], [0, 7], [2, 2], [6, 2], [6, 4], [2, 4]])
    rings = np.array(ring(4, 4))
    places = 8 * grid(3)
    segments = np.concatenate([rings + 8 * k for k in range(len(places))])
    for apart in (1.4, 1):
        houses = np.concatenate([corners + place for place in places * [apart, 1]])
        options = {"segments": segments, "outside": "holes", "crossings": "split"}
        mesh = flaunay.triangulate(turned(houses, angle) + offset, **options)
        check_edges(mesh.points, mesh.constraint_edges)
        check_triangles(mesh.points, mesh.triangles, mesh.neighbors)
        fine = flaunay.refine(mesh.points, mesh.constraint_edges, outside="holes", min_angle=25)
        check_edges(fine.points, fine.constraint_edges)
        check_triangles(fine.points, fine.triangles, fine.neighbors)


def test_random_segments_that_are_split(random):
    for offset in (0, 5e6):
        points = turned(random.integers(0, 9, (60, 2)).astype(float), 0.001) + offset
        segments = random.integers(0, 60, (50, 2))
        segments = segments[(points[segments[:, 0]] != points[segments[:, 1]]).any(axis=1)]
        mesh = flaunay.triangulate(points, segments=segments, crossings="split")
        check_edges(mesh.points, mesh.constraint_edges)
        check_triangles(mesh.points, mesh.triangles, mesh.neighbors)
