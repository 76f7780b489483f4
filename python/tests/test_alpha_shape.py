"""Alpha shapes beside brute force, and their rings."""

import numpy as np
import pytest
import scipy.sparse.csgraph
from conftest import circle

import flaunay

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def squares(places):
    """Corners and middles of unit squares, which make four triangles of radius 1/2 in each."""
    inside = np.array([*SQUARE, (0.5, 0.5)])
    return np.unique(np.concatenate([np.add(place, inside) for place in places]), axis=0)


def ring_area(points, ring):
    x, y = np.asarray(points, np.float64)[ring].T
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2


def clouds(random):
    for n in 1, 2, 3, 30, 300:
        yield random.random((n, 2)) * n**0.5
        yield random.integers(0, int(n**0.5) + 2, (n, 2)).astype(np.float32)


RADII = [0, 0.3, 0.5, 0.6, 0.8, 1, 1.5, np.inf]


def shapes(random):
    for points in clouds(random):
        tri = flaunay.Delaunay(points)
        for radius in RADII:
            yield flaunay.alpha_shape(tri, radius)


def test_triangles_are_those_of_at_most_this_radius(random):
    for shape in shapes(random):
        tri = shape.delaunay
        assert np.array_equal(shape.inside, tri.circumradii <= shape.alpha)
        assert np.array_equal(shape.simplices, tri.simplices[shape.inside])


def test_edges_are_the_sides_with_one_triangle_directed(random):
    for shape in shapes(random):
        directed = {
            (row[k], row[(k + 1) % 3]) for row in shape.simplices.tolist() for k in range(3)
        }
        boundary = {(i, j) for i, j in directed if (j, i) not in directed}
        assert len(shape.edges) == len(boundary) and shape.edges.dtype == np.int32
        assert set(map(tuple, shape.edges.tolist())) == boundary


def test_rings_are_simple_and_have_each_edge_once(random):
    for shape in shapes(random):
        edges = []
        for ring in shape.rings():
            assert len(ring) >= 3 and len(set(ring.tolist())) == len(ring)
            assert ring[0] == ring.min() and ring.dtype == np.int32
            edges += zip(ring.tolist(), np.roll(ring, -1).tolist())
        assert sorted(edges) == sorted(map(tuple, shape.edges.tolist()))


def test_polygons_are_outer_rings_and_their_holes(random):
    for shape in shapes(random):
        points, polygons = shape.delaunay.points, shape.polygons()
        assert sorted(ring.tolist() for part in polygons for ring in part) == sorted(
            ring.tolist() for ring in shape.rings()
        )
        for outer, *holes in polygons:
            assert ring_area(points, outer) > 0
            assert all(ring_area(points, hole) < 0 for hole in holes)
        total = sum(ring_area(points, ring) for part in polygons for ring in part)
        assert shape.area == pytest.approx(total)
        inner = shape.delaunay.simplex_adjacency()[shape.inside][:, shape.inside]
        components = scipy.sparse.csgraph.connected_components(inner)[0] if inner.shape[0] else 0
        assert len(polygons) == components


def test_polygons_are_valid_for_shapely(random):
    shapely = pytest.importorskip("shapely", "2.0")
    for shape in shapes(random):
        geometry = shape.to_shapely()
        assert geometry.is_valid, shapely.is_valid_reason(geometry)
        assert geometry.area == pytest.approx(shape.area)


def test_all_points_are_somewhere_once(random):
    for shape in shapes(random):
        tri = shape.delaunay
        in_triangles = set(shape.simplices.ravel().tolist())
        on_edges = set(shape.singular_edges.ravel().tolist())
        alone = set(shape.isolated.tolist())
        distinct = np.flatnonzero(tri.representatives == np.arange(tri.npoints))
        assert in_triangles | on_edges | alone == set(distinct.tolist())
        assert not alone & (in_triangles | on_edges)
        sides = {
            tuple(sorted((row[k], row[k - 1])))
            for row in shape.simplices.tolist()
            for k in range(3)
        }
        assert not sides & set(map(tuple, shape.singular_edges.tolist()))


def test_an_infinite_radius_gives_the_convex_hull(random):
    tri = flaunay.Delaunay(random.random((100, 2)))
    shape = flaunay.alpha_shape(tri, np.inf)
    assert shape.inside.all() and len(shape.isolated) == len(shape.singular_edges) == 0
    (ring,) = shape.rings()
    assert set(map(tuple, tri.convex_hull.tolist())) == set(
        zip(ring.tolist(), np.roll(ring, -1).tolist())
    )


def test_a_hole_turns_clockwise():
    places = [(x, y) for x in range(3) for y in range(3) if (x, y) != (1, 1)]
    shape = flaunay.alpha_shape(squares(places), 0.5)
    ((outer, hole),) = shape.polygons()
    points = shape.delaunay.points
    assert ring_area(points, outer) == 9 and ring_area(points, hole) == -1
    assert shape.area == 8 and len(outer) == 12


def test_squares_that_touch_at_a_corner_are_two_rings():
    shape = flaunay.alpha_shape(squares([(0, 0), (1, 1)]), 0.5)
    first, second = shape.rings()
    assert len(first) == len(second) == 4 and len(set(first) & set(second)) == 1
    assert len(shape.polygons()) == 2


def test_a_hole_that_touches_the_boundary_is_a_ring_of_its_own():
    missing = {(0, 1), (1, 2), (2, 2)}
    places = [(x, y) for x in range(4) for y in range(4)]
    # The hole of (1, 2) and (2, 2) touches the notch (0, 1) at a corner.
    shape = flaunay.alpha_shape(squares([at for at in places if at not in missing]), 0.5)
    ((outer, hole),) = shape.polygons()
    points = shape.delaunay.points
    assert ring_area(points, outer) == 15 and ring_area(points, hole) == -2
    assert len(set(outer.tolist()) & set(hole.tolist())) == 1


def test_singular_edges_are_short_and_alone():
    points = [[0, 0], [1, 0], [0.5, 0.5], [3, 0], [4, 0], [9, 9]]
    shape = flaunay.alpha_shape(points, 0.5)
    assert shape.simplices.tolist() == [[0, 1, 2]]
    assert shape.singular_edges.tolist() == [[3, 4]]
    assert shape.isolated.tolist() == [5]


def test_auto_is_the_smallest_radius_that_covers_all_in_one_component(random):
    for points in clouds(random):
        tri = flaunay.Delaunay(points)
        expected = np.inf
        for radius in np.unique(tri.circumradii):
            inside = tri.circumradii <= radius
            covered = np.unique(tri.simplices[inside])
            inner = tri.simplex_adjacency()[inside][:, inside]
            one = scipy.sparse.csgraph.connected_components(inner)[0] == 1
            if one and len(covered) == len(np.unique(tri.representatives)):
                expected = radius
                break
        shape = flaunay.alpha_shape(tri)
        # With a tolerance, within which there is no other radius here.
        assert expected <= shape.alpha <= expected * (1 + 2e-6) + 1e-4
        assert np.array_equal(shape.inside, tri.circumradii <= expected)
        assert len(shape.polygons()) == min(tri.nsimplex, 1)
        assert len(shape.isolated) == 0 or tri.nsimplex == 0


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("x, y, step", [(100.1, 10.7, 0.1), (5.1, 45.3, 0.05), (11.3, 47.1, 0.1)])
def test_grids_of_rounded_coordinates_have_no_holes(x, y, step, dtype):
    along = step * np.arange(40)
    grid = np.stack(np.meshgrid(x + along, y + along), axis=-1).reshape(-1, 2)
    shape = flaunay.alpha_shape(grid.astype(dtype))
    assert shape.inside.all() and len(shape.rings()) == 1
    assert len(np.unique(shape.delaunay.circumradii)) > 1


def test_a_component_can_appear_when_all_points_are_covered():
    """A ring with three spits that point to its middle: their ends make a triangle before anything near it."""
    along = np.arange(1.1, 9.8, 0.1)
    widths = np.minimum(0.05, 0.1 * (along - 1))
    sides = [np.stack([along, y], axis=1) for y in (-widths, widths)]
    spit = np.concatenate([[[1, 0]], *sides])
    spits = [spit @ np.array([[c, s], [-s, c]]) for c, s in circle(3)]
    points = np.concatenate([circle(600, 10), circle(600, 9.9), *spits])
    shape = flaunay.alpha_shape(points)
    assert shape.alpha < 0.4 and len(shape.polygons()) == 1
    assert len(flaunay.alpha_shape(points, 1.2).polygons()) == 2
    assert len(flaunay.alpha_shape(points, 11).polygons()) == 1
    # A point that is covered while there are two.
    shape = flaunay.alpha_shape(np.append(points, [[12.4, 0]], axis=0))
    assert shape.alpha > 1.5 and len(shape.polygons()) == 1


def test_points_or_their_triangulation(random):
    points = random.random((50, 2))
    tri = flaunay.Delaunay(points)
    one, other = flaunay.alpha_shape(points, 0.2), flaunay.alpha_shape(tri, 0.2)
    assert other.delaunay is tri and np.array_equal(one.simplices, other.simplices)
    assert np.array_equal(flaunay.alpha_shape(points, 0.2, device="host").edges, one.edges)
    assert repr(one) == f"<flaunay.AlphaShape: 50 points, {len(one.simplices)} triangles>"


@pytest.mark.parametrize("alpha", [-1, np.nan, -np.inf, "best", None, 1j, [1, 2]])
def test_other_radii_are_refused(alpha):
    with pytest.raises(flaunay.UsageError, match="alpha must"):
        flaunay.alpha_shape(SQUARE, alpha)


def test_options_are_for_points():
    with pytest.raises(flaunay.UsageError, match="device is for points"):
        flaunay.alpha_shape(flaunay.Delaunay(SQUARE), 1, device="host")


def test_another_radius_is_another_shape():
    shape = flaunay.alpha_shape(SQUARE, 1)
    with pytest.raises(AttributeError, match="alpha cannot be replaced"):
        shape.alpha = 2
    assert shape.alpha == 1
