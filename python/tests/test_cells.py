"""Clipped cells and relaxation; shapely's answers where it is installed."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from conftest import circle, grid, turned

import flaunay

BOX = (0.0, 0.0, 1.0, 1.0)


@pytest.fixture
def points(random):
    return random.uniform(-0.1, 1.1, (200, 2))


def area(polygon):
    x, y = polygon.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def test_cells_tile_the_box(points):
    cells = flaunay.Voronoi(points).clipped(BOX)
    assert cells.areas.sum() == pytest.approx(1, abs=1e-12)
    assert cells.vertices.min() == 0 and cells.vertices.max() == 1
    for i in range(len(points)):
        polygon = cells.polygon(i)
        assert len(polygon) == 0 or len(polygon) >= 3
        if len(polygon):
            assert area(polygon) == pytest.approx(cells.areas[i], abs=1e-14)
            nearest = np.argmin(((points - cells.centroids[i]) ** 2).sum(axis=1))
            assert nearest == i
        else:
            assert np.isnan(cells.centroids[i]).all()


def test_a_polygon_in_either_direction_closed_or_not(points):
    voronoi = flaunay.Voronoi(points)
    corners = np.array([[0, 0], [1, 0.25], [0.75, 1], [0.25, 0.75]])
    expected = voronoi.clipped(corners)
    for same in (corners[::-1], np.vstack([corners, corners[:1]]), corners.tolist()):
        cells = voronoi.clipped(same)
        assert cells.areas == pytest.approx(expected.areas)
    assert expected.areas.sum() == pytest.approx(area(corners))


def test_few_points():
    assert flaunay.voronoi_polygons(np.empty((0, 2)), BOX) == []
    (alone,) = flaunay.voronoi_polygons([[5, 5]], BOX)
    assert area(alone) == 1
    strips = flaunay.voronoi_polygons([[0.25, 0], [0.75, 0], [0.75, 0], [9, 0]], BOX)
    assert [len(strip) for strip in strips] == [4, 4, 0, 0]


def test_polygons_by_number(points):
    cells = flaunay.Voronoi(points).clipped(BOX)
    assert (cells.polygon(-1) == cells.polygon(len(points) - 1)).all()
    assert [len(p) for p in cells.polygons()] == np.diff(cells.offsets).tolist()
    for wrong in (len(points), -len(points) - 1):
        with pytest.raises(IndexError):
            cells.polygon(wrong)


@pytest.mark.parametrize(
    "bounds, error, message",
    [
        ((0, 0, 0, 1), flaunay.UsageError, "xmin < xmax"),
        ([[0, 0, 1]], flaunay.UsageError, "shape"),
        ([[0, 0], [1, 0]], flaunay.InputError, "2 corners"),
        ([[0, 0], [4, 0], [1, 1], [0, 4]], flaunay.InputError, "corner 2"),
        ([[0, 0], [4, 0], [1, np.inf]], flaunay.InputError, "not finite at corner 2"),
    ],
)
def test_bounds_that_are_none(bounds, error, message):
    with pytest.raises(error, match=message):
        flaunay.voronoi_polygons([[0, 0], [1, 1]], bounds)
    with pytest.raises(error, match=message):
        flaunay.relax([[0, 0], [1, 1]], bounds)


def test_relaxation_evens_out_areas(points):
    before = flaunay.Voronoi(points).clipped(BOX).areas
    copy = points.copy()
    relaxed = flaunay.relax(points, BOX, iterations=20)
    assert (points == copy).all()
    has_cell = before > 0
    after = flaunay.Voronoi(relaxed).clipped(BOX).areas[has_cell]
    assert after.std() < 0.5 * before[has_cell].std()
    # Without a cell it stays; in later iterations it may have one.
    once = flaunay.relax(points, BOX)
    assert (once[~has_cell] == points[~has_cell]).all()
    assert (once[has_cell] != points[has_cell]).any()


def test_relaxation_in_all_spaces(points):
    points, weights = points % 1, np.arange(len(points)) % 7 / 1e5
    for given in {"bounds": BOX}, {"period": (1.5, 2)}, {"period": (1.5, 2, 0.25)}:

        def spread(at):
            if "bounds" in given:
                return flaunay.weighted(at, weights).cells(BOX).areas.std()
            return flaunay.periodic(at, **given, weights=weights).cells.areas.std()

        relaxed = flaunay.relax(points, **given, weights=weights, iterations=20)
        assert spread(relaxed) < 0.7 * spread(points)
    degrees = np.random.default_rng(1).uniform([-180, -90], [180, 90], (200, 2))
    xyz = flaunay.spherical(degrees).xyz
    relaxed = flaunay.relax(xyz, sphere=True, iterations=3)
    assert np.abs(np.linalg.norm(relaxed, axis=1) - 1).max() < 1e-15
    other = flaunay.spherical(flaunay.relax(degrees, sphere=True, iterations=3)).xyz
    assert np.abs(relaxed - other).max() < 1e-12
    apart = flaunay.relax(xyz, sphere=True, iterations=30)
    before, after = (flaunay.spherical(each).voronoi.areas.std() for each in (xyz, apart))
    assert after < 0.5 * before


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "one of bounds, region, period and sphere"),
        ({"bounds": BOX, "period": (1, 1)}, "one of bounds, region, period and sphere"),
        ({"period": (1, None)}, "no end"),
        ({"sphere": True, "weights": np.ones(4)}, "no weights"),
        ({"period": (1, 1), "weights": np.ones(3)}, "weights must have"),
    ],
)
def test_spaces_without_relaxation(given, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.relax([[0, 0], [1, 0], [1, 1], [0, 1]], **given)


def test_relaxation_by_a_density(points):
    triangle = [[0, 0], [1, 0], [0.3, 1]]
    for bounds in BOX, triangle:
        even = flaunay.relax(points, bounds, 4)
        for density in (lambda at: np.full(len(at), 3), lambda at: [1] * len(at)):
            assert flaunay.relax(points, bounds, 4, density=density) == pytest.approx(even, abs=1e-12)
    # The centroids where a density of x ^ 3 y has its masses are rational numbers: degree 5 is exact.
    (moved,) = flaunay.relax([[0.5, 0.5]], (0, 0, 1, 2), density=lambda at: at[:, 0] ** 3 * at[:, 1])
    assert moved == pytest.approx([4 / 5, 4 / 3], abs=1e-14)
    (moved,) = flaunay.relax([[9, 9]], (0, 0, 1, 2), density=lambda at: (at[:, 0] < 0.5) * 1.0)
    assert moved[0] < 0.5
    for density in (lambda at: np.zeros(len(at))), np.zeros((3, 4)):
        assert (flaunay.relax(points, BOX, density=density) == points).all()


def test_relaxation_by_a_raster(random):
    rows, columns = np.arange(90), np.arange(120)
    density = (rows[::-1, None] + 1.0) * np.ones(len(columns))
    bounds, points = (0, 0, 12, 9), random.random((40, 2)) * [12, 9]
    by_raster = flaunay.relax(points, bounds, 3, density=density)
    by_function = flaunay.relax(points, bounds, 3, density=lambda at: at[:, 1] + 0.05)
    assert np.abs(by_raster - by_function).max() < 0.1
    # Only pixels within the region.
    frame = [[[0, 0], [12, 0], [12, 9], [0, 9]], [[1, 1], [11, 1], [11, 8], [1, 8]]]
    in_frame = flaunay.relax(points, region=[frame])
    assert np.abs(flaunay.relax(points, region=[frame], density=np.ones((450, 600))) - in_frame).max() < 0.05
    diagonal = np.eye(90, 120)[::-1]
    assert flaunay.relax([[6, 1]], (0, 0, 12, 9), density=diagonal) == pytest.approx(np.array([[4.5, 4.5]]))


def test_relaxation_of_cells_without_a_place(random):
    frame = [[[0, 0], [4, 0], [4, 4], [0, 4]], [[1, 1], [3, 1], [3, 3], [1, 3]]]
    # The cell of the first one is within the hole.
    points = [[2, 2], [0, 2], [4, 2], [2, 0], [2, 4]]
    moved = flaunay.relax(points, region=[frame], density=np.ones((6, 6)))
    assert moved[0].tolist() == [2, 2] and np.isfinite(moved).all()
    for space in dict(bounds=(0, 0, 4, 4)), dict(region=[frame]):
        for density in np.ones((3, 3)), lambda at: np.ones(len(at)):
            assert flaunay.relax(np.empty((0, 2)), density=density, **space).shape == (0, 2)


def test_functions_may_change_their_arguments(points):
    def density(at):
        at -= 0.25
        return np.abs(at).sum(axis=1)

    expected = flaunay.relax(points, BOX, density=lambda at: np.abs(at - 0.25).sum(axis=1))
    assert (flaunay.relax(points, BOX, density=density) == expected).all()

    def areas_at(at):
        at *= 0
        return at[:, 0] + 0.01

    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    mine, other = (flaunay.refine(square, areas_at=areas) for areas in (areas_at, lambda at: 0.01))
    assert (mine.points == other.points).all()


DENSITIES = [None, np.ones((3, 3)), lambda at: np.ones(len(at))]


@pytest.mark.parametrize("density", DENSITIES)
@pytest.mark.parametrize(
    "bounds, message",
    [
        ([[0, 0], [4, 0], [1, 1], [0, 4]], "turns right at corner 2: it must be convex; region= takes"),
        ([[0, 0], [0, 4], [1, 1], [4, 0]], "turns left at corner 2: it must be convex; region= takes"),
        ([[0, 0], [4, 0], [4, 0], [0, 4]], "corner 1 twice"),
        ((-1e200, -1e200, 1e200, 1e200), "polygon is too large"),
        ((0, 0, np.inf, 4), "polygon is not finite"),
    ],
)
def test_wrong_bounds_of_relaxation(density, bounds, message):
    with pytest.raises(flaunay.InputError, match=message):
        flaunay.relax([[1, 1]], bounds, density=density)


def test_relaxation_in_any_polygons(random):
    shapely = pytest.importorskip("shapely", minversion="2.0")
    frame = shapely.box(0, 0, 4, 4) - shapely.box(1, 1, 3, 3)
    region = shapely.MultiPolygon([frame, shapely.Polygon([(5, 0), (9, 0), (9, 4), (8.8, 0.5)])])
    points = random.random((200, 2)) * [9, 4]
    points = points[shapely.covers(region, shapely.points(points))]
    once = flaunay.relax(points, region=region)
    cells = [part & region for part in flaunay.voronoi_polygons(points, region.bounds, as_shapely=True)]
    for place, cell, before in zip(once, cells, points):
        centroid = shapely.Point(before) if cell.is_empty else cell.centroid
        if not cell.is_empty and not shapely.covers(cell, centroid):
            # The nearest place of the cell.
            assert cell.distance(shapely.Point(place)) < 1e-12
            assert centroid.distance(shapely.Point(place)) == pytest.approx(centroid.distance(cell))
        else:
            assert place == pytest.approx([centroid.x, centroid.y])
    relaxed = flaunay.relax(points, region=region, iterations=10)
    assert shapely.distance(region, shapely.points(relaxed)).max() < 1e-12
    areas = flaunay.Voronoi(relaxed).pieces(region).areas
    assert areas.std() < 0.6 * flaunay.Voronoi(points).pieces(region).areas.std()
    # One point in the middle of a frame.
    (moved,) = flaunay.relax([[2, 2]], region=frame)
    assert frame.distance(shapely.Point(moved)) < 1e-12
    alike = flaunay.relax(points, region=region, density=lambda at: np.ones(len(at)))
    assert alike == pytest.approx(once, abs=1e-9)


@pytest.mark.parametrize(
    "given, message",
    [
        (dict(bounds=BOX, region=[[[[0, 0], [1, 0], [0, 1]]]]), "one of bounds"),
        (dict(bounds=BOX, density=[[1]], weights=[0, 0]), "without weights"),
        (dict(period=(1, 1), density=[[1]]), "without weights"),
        (dict(bounds=BOX, density=[1]), "a function or a raster"),
        (dict(bounds=BOX, density=[[-1]]), "not negative"),
        (dict(bounds=BOX, density=lambda at: np.ones((len(at), 2))), "one number per place"),
        (dict(bounds=BOX, density=lambda at: at[:, 0] * np.nan), "finite"),
        (dict(region=[]), "no area"),
    ],
)
def test_densities_and_regions_that_are_none(given, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.relax([[0, 0], [1, 1]], **given)


def interrupted(call, seconds):
    """How long a call takes that Ctrl-C interrupts after so many seconds."""
    timer = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
    begin = time.perf_counter()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call()
    timer.join()
    return time.perf_counter() - begin


def test_control_c_ends_relaxation(points):
    assert interrupted(lambda: flaunay.relax(points, BOX, iterations=100_000, device="host"), 0.2) < 5
    # What was interrupted has left nothing behind.
    parts = flaunay.relax(points, BOX, iterations=300)
    at = points
    for _ in range(30):
        at = flaunay.relax(at, BOX, iterations=10)
    assert (parts == at).all()


def test_control_c_ends_refinement_that_asks_for_areas():
    """A signal comes while the library is at work, so that Python handles it as soon as it calls back."""
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]

    def refine():
        until = time.monotonic() + 60
        while time.monotonic() < until:
            flaunay.refine(square, areas_at=lambda places: 2e-5)

    for _ in range(5):
        assert interrupted(refine, 0.1) < 5


def test_shapely_takes_them(points):
    shapely = pytest.importorskip("shapely", minversion="2.0")
    polygons = flaunay.voronoi_polygons(points, shapely.box(*BOX), as_shapely=True)
    assert len(polygons) == len(points)
    assert shapely.is_valid(polygons).all()
    assert shapely.union_all(polygons).area == pytest.approx(1)
    # Neighbours share their vertices to the last bit.
    assert shapely.coverage_is_valid(polygons[~shapely.is_empty(polygons)])
    cells = flaunay.Voronoi(points).clipped(BOX)
    assert shapely.area(polygons) == pytest.approx(cells.areas, abs=1e-14)
    assert len(flaunay.Voronoi(np.empty((0, 2))).clipped(BOX).to_shapely()) == 0


def test_a_polygon_with_a_hole_is_refused(points):
    shapely = pytest.importorskip("shapely", minversion="2.0")
    outside, hole = shapely.box(*BOX), shapely.box(0.2, 0.2, 0.4, 0.4)
    with pytest.raises(flaunay.UsageError, match="holes"):
        flaunay.Voronoi(points).clipped(outside.difference(hole))


@pytest.mark.parametrize("size", [2.0**-600, 1.0, 2.0**600])
def test_polygons_of_any_size_go_either_way_around(size):
    corners = size * np.array([[0.0, 0], [4, 0], [0, 4]])
    points = size * np.array([[1.0, 1], [2, 1]])
    one, other = (flaunay.Voronoi(points).clipped(c) for c in (corners, corners[::-1]))
    assert len(one.vertices) and len(one.vertices) == len(other.vertices)


def building(angle, width, height):
    t, u = np.arange(0, width, 0.5)[:, None], np.arange(0, height, 0.5)[:, None]
    x, y = np.eye(2)
    walls = [t * x, width * x + u * y, (width - t) * x + height * y, (height - u) * y]
    return turned(np.concatenate(walls), angle)


def degenerate_sets(random):
    """Points whose Voronoi vertices nearly coincide."""
    yield turned(2 * grid(2, 2) - 1, 0.001)
    for _ in range(12):
        shape, angle = random.integers(2, 20, 2), random.uniform(0, 7)
        yield turned(grid(*shape), angle) * random.uniform(0.1, 1e4) + random.uniform(
            -1e4, 1e4, 2
        )
    for n in (5, 100, 500):
        yield np.vstack([circle(n), [[0, 0]]])
        yield 7 * circle(n) + [5e5, 5e6]
        yield 0.01 * circle(n) + [5e5, 5e6]
    houses = [
        building(*random.uniform((0, 5, 5), (3, 20, 20))) + [30 * k, 5.8e6] for k in range(10)
    ]
    yield np.concatenate(houses)
    # Points nearer to each other than corners are rounded.
    yield turned(np.stack([np.zeros(20), np.arange(20) * 1e-18], axis=1), 0.7)


def test_rounded_polygons_are_valid_and_tile(random):
    shapely = pytest.importorskip("shapely", minversion="2.0")
    for points in degenerate_sets(random):
        low, high = points.min(axis=0), points.max(axis=0)
        low, high = low - (high - low).max() / 10, high + (high - low).max() / 10
        voronoi, bounds = flaunay.Voronoi(points), (*low, *high)
        cells, area = voronoi.clipped(bounds), np.prod(high - low)
        polygons = cells.to_shapely()
        assert shapely.is_valid(polygons).all()
        assert shapely.coverage_is_valid(polygons[~shapely.is_empty(polygons)])
        assert shapely.union_all(polygons).area == pytest.approx(area, rel=1e-12)
        assert np.abs(shapely.area(polygons) - cells.areas).max() < 1e-7 * area
        order = random.permutation(len(points))
        other = flaunay.Voronoi(points[order]).clipped(bounds)
        assert {c.tobytes() for c in other.vertices} == {c.tobytes() for c in cells.vertices}
        bounded = np.flatnonzero(~voronoi.unbounded & (np.diff(voronoi.cell_offsets) > 0))
        regions = [shapely.Polygon(voronoi.vertices[voronoi.regions[i]]) for i in bounded]
        # Of a cell thinner than rounding nothing is left.
        assert all(shapely.is_valid(regions) | (shapely.area(regions) == 0))
        power = flaunay.weighted(points, np.zeros(len(points))).cells(bounds).to_shapely()
        assert shapely.is_valid(power).all()
        assert shapely.union_all(power).area == pytest.approx(area, rel=1e-12)


def test_rounded_pieces_and_cells_on_a_torus_are_valid(random):
    shapely = pytest.importorskip("shapely", minversion="2.0")
    notched = np.array([[-0.5, -0.5], [4.5, -0.5], [4.5, 4.5], [2, 2], [-0.5, 4.5]])
    for k in range(20):
        angle = 2 * np.pi * k / 999
        region = shapely.Polygon(turned(notched, angle))
        cells = flaunay.Voronoi(turned(grid(5, 5), angle)).pieces(region).to_shapely()
        assert shapely.is_valid(cells).all()
        assert shapely.union_all(cells).area == pytest.approx(region.area, rel=1e-12)
        torus = flaunay.periodic(turned(grid(6, 6), angle) / 6, (1, 1)).cells
        assert shapely.is_valid(torus.to_shapely()).all()
    # Images of corners are exact: each of 1,000 corners is in three cells.
    torus = flaunay.periodic(random.random((500, 2)), (1, 1)).cells
    _, counts = np.unique(torus.vertices % 1, axis=0, return_counts=True)
    assert (counts == 3).all() and len(counts) == 1000


def rings_of(groups):
    return [ring for parts in groups for rings in parts for ring in rings]


def signed_area(ring):
    x, y = (ring - ring[0]).T
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2


def test_groups_are_the_unions_of_their_cells(random):
    shapely = pytest.importorskip("shapely", minversion="2.0")
    for points in [*degenerate_sets(random), random.random((800, 2))]:
        low, high = points.min(axis=0), points.max(axis=0)
        low, high = low - np.ptp(points) / 10, high + np.ptp(points) / 10
        bounds = (*low, *high)
        for count in 1, 30:
            owners = random.integers(-2, count, len(points)) * 7
            cells = flaunay.voronoi_polygons(points, bounds, as_shapely=True)
            made = flaunay.voronoi_polygons(points, bounds, as_shapely=True, groups=owners)
            names = np.unique(owners)
            assert len(made) == len(names)
            assert shapely.is_valid(made).all()
            scale = np.prod(high - low)
            for name, polygon in zip(names, made):
                own = cells[owners == name]
                union = shapely.coverage_union_all(own)
                if not union.is_valid:
                    union = shapely.union_all(own)
                assert polygon.area == pytest.approx(shapely.area(own).sum(), abs=1e-9 * scale)
                assert shapely.get_num_geometries(polygon) == shapely.get_num_geometries(union)
                holes = [shapely.get_num_interior_rings(shapely.get_parts(g)).sum() for g in (polygon, union)]
                assert holes[0] == holes[1]
                # But for corners on the bounds where two cells of the group meet.
                corners = [set(map(tuple, shapely.get_coordinates(g))) for g in (polygon, union)]
                assert corners[0] <= corners[1]
                left = np.array(list(corners[1] - corners[0])).reshape(-1, 2)
                assert ((left == low) | (left == high)).any(axis=1).all()
            lists = flaunay.voronoi_polygons(points, bounds, groups=owners)
            for polygon, parts in zip(made, lists):
                areas = [[signed_area(ring) for ring in part] for part in parts]
                assert all(outer > 0 and all(hole < 0 for hole in holes) for outer, *holes in areas)
                assert sum(map(sum, areas)) == pytest.approx(polygon.area, abs=1e-9 * scale)


def test_groups_that_touch_themselves():
    """Squares of a board, and a ring whose hole touches its border."""
    board = grid(3, 3)
    bounds = (-0.5, -0.5, 2.5, 2.5)
    black, white = flaunay.voronoi_polygons(board, bounds, groups=[0, 1, 0, 1, 0, 1, 0, 1, 0])
    assert [len(part) for part in black] == [1] * 5 and [len(part) for part in white] == [1] * 4
    assert all(len(ring) == 4 for ring in rings_of([black, white]))
    (whole,) = rings_of(flaunay.voronoi_polygons(board, bounds, groups=[5] * 9))
    assert whole.tolist() == [[-0.5, -0.5], [2.5, -0.5], [2.5, 2.5], [-0.5, 2.5]]
    ring, hole = flaunay.voronoi_polygons(board, bounds, groups=[0, 0, 1, 0, 1, 0, 0, 0, 0])
    (rings,) = ring
    assert [signed_area(one) for one in rings] == [8.0, -1.0]
    assert [signed_area(one) for one in rings_of([hole])] == [1.0, 1.0]


def test_which_groups_there_are(random):
    points = random.random((20, 2))
    points[5] = points[4]
    owners = np.full(20, 3)
    owners[5], owners[0] = -9, 8
    lists = flaunay.voronoi_polygons(points, groups=owners)
    assert lists[0] == [] and len(lists) == 3
    shapely = pytest.importorskip("shapely", minversion="2.0")
    assert flaunay.voronoi_polygons(points, groups=owners, as_shapely=True)[0].is_empty
    for wrong in np.zeros(19, int), np.zeros((20, 1), int), np.zeros(20):
        with pytest.raises(flaunay.UsageError, match="groups"):
            flaunay.voronoi_polygons(points, groups=wrong)
    assert flaunay.voronoi_polygons(np.empty((0, 2)), (0, 0, 1, 1), groups=np.empty(0, int)) == []
    none = flaunay.voronoi_polygons(np.empty((0, 2)), (0, 0, 1, 1), True, groups=np.empty(0, int))
    assert len(none) == 0


@pytest.mark.parametrize("kind", ["box", "array", "geometry", "none"])
def test_what_bounds_are_extended_to(random, kind):
    points = random.random((30, 2))
    expected = np.array([points.min(axis=0), points.max(axis=0)])
    extent = None
    if kind != "none":
        expected = np.array([expected[0], [2, 3]])
        extent = (1, 1, 2, 3) if kind == "box" else np.array([[1, 3], [2, 1]])
    if kind == "geometry":
        extent = pytest.importorskip("shapely", minversion="2.0").LineString([[1, 3], [2, 1]])
    corners = np.concatenate(flaunay.voronoi_polygons(points, extend_to=extent))
    assert (np.array([corners.min(axis=0), corners.max(axis=0)]) == expected).all()


def test_bounds_that_cannot_be_extended():
    for given, words in [
        (dict(extend_to=[1, 2, 3]), "extend_to"),
        (dict(bounds=(0, 0, 1, 1), extend_to=(0, 0, 2, 2)), "extend_to"),
    ]:
        with pytest.raises(flaunay.UsageError, match=words):
            flaunay.voronoi_polygons([[0, 0], [1, 1]], **given)
    for points, words in [
        (np.empty((0, 2)), "no points .* give bounds or extend_to"),
        ([[0, 0]], "on one line: give bounds or extend_to"),
        ([[0, 0], [0, 1]], "on one line: give bounds or extend_to"),
    ]:
        with pytest.raises(flaunay.UsageError, match=words):
            flaunay.voronoi_polygons(points)


def test_what_bounds_cannot_be_extended_to():
    points = [[0, 0], [1, 1]]
    for extent, i in ((0, np.inf, 2, 2), 1), ([[0, 0], [1, 1], [np.nan, 2]], 2):
        with pytest.raises(flaunay.InputError, match=rf"extend_to\[{i}\] is not finite"):
            flaunay.voronoi_polygons(points, extend_to=extent)
    for extent in (2, 0, 1, 3), np.empty((0, 2)), 3:
        with pytest.raises(flaunay.UsageError, match="extend_to must be"):
            flaunay.voronoi_polygons(points, extend_to=extent)
    shapely = pytest.importorskip("shapely", minversion="2.0")
    place = shapely.Point(3, 3)
    for extent, i in (shapely.Polygon(), 0), ([place, None], 1), ([place, shapely.Point()], 1):
        with pytest.raises(flaunay.UsageError, match=rf"extend_to\[{i}\] is missing or empty"):
            flaunay.voronoi_polygons(points, extend_to=extent)
    with pytest.raises(flaunay.InputError, match=r"extend_to\[1\] is not finite"):
        flaunay.voronoi_polygons(points, extend_to=[shapely.LineString([(0, 0), (1, 1)]), shapely.Point(3, np.inf)])
