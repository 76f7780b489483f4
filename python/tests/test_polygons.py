"""Triangles of polygons."""

import itertools

import numpy as np
import pytest
from conftest import as_set

import flaunay

shapely = pytest.importorskip("shapely", minversion="2.0")

SQUARE = [[0, 0], [6, 0], [6, 6], [0, 6]]
HOLE = [[2, 2], [2, 4], [4, 4], [4, 2]]
BESIDE = [[6, 0], [9, 3], [6, 6]]


def star(random, corners, radius=1.0, centre=(0, 0)):
    """A polygon around a place, not convex."""
    angles, radii = np.sort(random.random(corners)) * 2 * np.pi, radius * random.uniform(0.3, 1, corners)
    return centre + radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def with_holes(random, corners=30):
    """A star with two holes inside of its kernel."""
    outer = star(random, corners)
    holes = [star(random, 7, 0.05, (x, 0)) for x in (-0.06, 0.06)]
    polygon = shapely.Polygon(outer, holes)
    return polygon if polygon.is_valid else with_holes(random, corners)


def test_polygons_with_holes_beside_shapely(random):
    geometries = [with_holes(random) for _ in range(20)]
    mesh = flaunay.polygons(geometries)
    assert len(mesh.polygon_offsets) == 21
    np.testing.assert_allclose(mesh.polygon_areas, shapely.area(geometries), rtol=1e-12)
    for p, polygon in enumerate(geometries):
        middles = mesh.points[mesh.triangles_of(p)].mean(axis=1)
        assert shapely.covers(polygon, shapely.points(middles)).all()


def arrays_of(mesh):
    return mesh.points[mesh.triangles], mesh.polygon_of


def same(mesh, expected):
    return all(np.array_equal(a, b) for a, b in zip(arrays_of(mesh), arrays_of(expected))) and len(
        mesh.polygon_offsets
    ) == len(expected.polygon_offsets)


POLYGONS = [shapely.Polygon(SQUARE, [HOLE]), shapely.Polygon(BESIDE)]
EXPECTED = [[SQUARE, HOLE], [BESIDE]]


def features():
    geometries = [shapely.geometry.mapping(polygon) for polygon in POLYGONS]
    return [{"type": "Feature", "geometry": g, "properties": {}} for g in geometries]


class Described:
    def __init__(self, polygon):
        self.__geo_interface__ = shapely.geometry.mapping(polygon)


@pytest.mark.parametrize(
    "given",
    [
        POLYGONS,
        tuple(POLYGONS),
        np.array(POLYGONS),
        [Described(polygon) for polygon in POLYGONS],
        features(),
        {"type": "FeatureCollection", "features": features()},
        [features()[0], POLYGONS[1]],
        [POLYGONS[0], [BESIDE]],
        [[np.array(SQUARE), np.array(HOLE)], [np.array(BESIDE, np.float32)]],
        [[SQUARE + SQUARE[:1], HOLE], (BESIDE + BESIDE[:1],)],
        [[HOLE, SQUARE[::-1]], [BESIDE]],
        [[np.column_stack([SQUARE, [7] * 4]), HOLE], [BESIDE]],
    ],
    ids=range(12),
)
def test_polygons_may_be_given_in_many_ways(given):
    mesh = flaunay.polygons(given)
    assert as_set(mesh.points[mesh.triangles].reshape(-1, 6)) == as_set(
        (lambda m: m.points[m.triangles].reshape(-1, 6))(flaunay.polygons(EXPECTED))
    )
    assert mesh.triangle_offsets.tolist() == [0, 8, 9]
    assert mesh.polygon_areas.tolist() == [32, 9]
    assert repr(mesh) == "<flaunay.PolygonTriangulation: 2 polygons, 9 triangles>"


def test_geopandas():
    geopandas = pytest.importorskip("geopandas")
    expected = flaunay.polygons(POLYGONS)
    series = geopandas.GeoSeries(POLYGONS, index=["a", "b"])
    frame = geopandas.GeoDataFrame({"name": ["a", "b"]}, geometry=POLYGONS)
    for given in series, frame, series.array, series.values:
        assert same(flaunay.polygons(given), expected)


def test_offsets_as_in_geoarrow():
    coordinates = np.array(SQUARE + HOLE + BESIDE, float)
    expected = flaunay.polygons(EXPECTED)
    for kind in np.int32, np.int64, list:
        rings, outer = ([0, 4, 8, 11], [0, 2, 3])
        if kind is not list:
            rings, outer = kind(rings), kind(outer)
        assert same(flaunay.polygons(coordinates, rings, outer), expected)
    # Each ring a polygon.
    mesh = flaunay.polygons(coordinates, [0, 4, 8, 11])
    assert mesh.polygon_areas.tolist() == [36, 4, 9]
    assert same(flaunay.polygons(coordinates.astype(np.float32), rings, outer), expected)


def test_what_was_given_stays_the_caller_s():
    coordinates = np.array(SQUARE, float)
    rings, outer = np.array([0, 4]), np.array([0, 1])
    mesh = flaunay.polygons(coordinates, rings, outer)
    coordinates[:] = rings[:] = outer[:] = 7
    assert mesh.points.tolist() == SQUARE and mesh.polygon_areas.tolist() == [36]
    assert mesh.ring_offsets.tolist() == [0, 4] and mesh.polygon_offsets.tolist() == [0, 1]


def test_shapely_s_own_ragged_arrays(random):
    geometries = [with_holes(random) for _ in range(5)]
    _, coordinates, (rings, outer) = shapely.to_ragged_array(geometries)
    assert same(flaunay.polygons(coordinates, rings, outer), flaunay.polygons(geometries))


def test_lists_of_one_shape():
    mesh = flaunay.polygons([[SQUARE, HOLE], [SQUARE, HOLE]])
    assert mesh.polygon_areas.tolist() == [32, 32]
    rings = np.array([[SQUARE, HOLE], [SQUARE, HOLE]])
    assert same(flaunay.polygons(rings), mesh) and same(flaunay.polygons(list(rings)), mesh)


def test_a_single_geometry_and_one_of_several_parts():
    one = flaunay.polygons(POLYGONS[0])
    assert one.triangle_offsets.tolist() == [0, 8] and one.polygon_areas.tolist() == [32]
    multi = shapely.MultiPolygon(
        [POLYGONS[0], shapely.box(2.5, 2.5, 3, 3), shapely.box(9, 9, 10, 10)]
    )
    mesh = flaunay.polygons([multi, POLYGONS[1]])
    assert mesh.polygon_areas.tolist() == [33.25, 9] and mesh.polygon_offsets.tolist() == [0, 4, 5]
    described = flaunay.polygons(shapely.geometry.mapping(multi))
    assert described.polygon_areas.tolist() == [33.25]


@pytest.mark.parametrize(
    "given, areas",
    [
        ([], []),
        ([None], [0]),
        ([[]], [0]),
        ([[[]]], [0]),
        ([shapely.Polygon(), POLYGONS[1], None], [0, 9, 0]),
        (shapely.MultiPolygon(), [0]),
        ([[[[1, 1]]], [[[1, 1], [2, 2]], SQUARE]], [0, 36]),
        (np.empty(0, object), []),
        ({"type": "FeatureCollection", "features": []}, []),
        ({"type": "Feature", "geometry": None, "properties": {}}, [0]),
    ],
)
def test_polygons_without_area(given, areas):
    mesh = flaunay.polygons(given)
    assert mesh.polygon_areas.tolist() == areas
    assert len(mesh.to_shapely()) == len(areas)


def test_back_to_shapely(random):
    geometries = [with_holes(random), None, with_holes(random)]
    collections = flaunay.polygons(geometries).to_shapely()
    assert collections.shape == (3,) and collections[1].is_empty
    for collection, polygon in zip(collections, geometries):
        if polygon is not None:
            assert shapely.area(collection) == pytest.approx(polygon.area, rel=1e-12)
            union = shapely.union_all(shapely.get_parts(collection))
            assert shapely.area(shapely.symmetric_difference(union, polygon)) < 1e-12


def test_what_is_outside_can_be_kept():
    mesh = flaunay.polygons(EXPECTED, outside="keep", labels=True)
    assert mesh.triangle_offsets.tolist() == [0, 10, 11]
    inside = mesh.depths == 1
    assert mesh.areas[inside].sum() == 41 and mesh.areas.sum() == 45
    assert len(np.unique(mesh.regions)) == 3
    rings = [[SQUARE, HOLE]]
    assert flaunay.polygons(rings, outside="hull", fill_rule="nesting").areas.sum() == 36


# As the command's default (cli_test.cpp).
def test_what_polygons_go_around_twice_is_not_in_them():
    twice = [(0, 0), (6, 0), (6, 6), (1, 6), (1, 1), (5, 1), (5, 5), (0, 5)]
    assert flaunay.polygons([[twice]], crossings="split").areas.sum() == 19
    assert flaunay.polygons([[twice]], crossings="split", map=True).areas.sum() == 19


def test_letters_are_filled_by_winding():
    overlapping = [[[0, 0], [4, 0], [4, 2], [0, 2]], [[2, 1], [6, 1], [6, 3], [2, 3]]]
    split = {"crossings": "split"}
    assert flaunay.polygons([overlapping], fill_rule="winding", **split).areas.sum() == 14
    mesh = flaunay.polygons([overlapping], **split)
    assert mesh.areas.sum() == 12 and mesh.added_points.tolist() == [[2, 2], [4, 1]]
    # A hole turns the other way.
    for hole, area in (HOLE, 32), (HOLE[::-1], 36):
        assert flaunay.polygons([[SQUARE, hole]], fill_rule="winding").areas.sum() == area


def in_directions(polygon, directions):
    """The polygon, with its rings in these directions: its border, and then its holes."""
    rings = [polygon.exterior, *polygon.interiors]
    turned = [np.array(r.coords)[:: 1 if r.is_ccw == d else -1] for r, d in zip(rings, directions)]
    return shapely.Polygon(turned[0], turned[1:])


@pytest.mark.parametrize("fill_rule", ["even_odd", "winding"])
@pytest.mark.parametrize("options", [{}, {"map": True}])
def test_rings_may_have_any_direction(random, fill_rule, options):
    polygon = with_holes(random)
    options = {"fill_rule": fill_rule, "labels": True, **options}
    for directions in itertools.product([True, False], repeat=3):
        turned = in_directions(polygon, directions)
        described = shapely.geometry.mapping(turned)
        for given in turned, described, [turned], [described]:
            mesh = flaunay.polygons(given, **options)
            assert mesh.areas.sum() == pytest.approx(polygon.area) and set(mesh.depths) == {1}
        # Parts unite, also in opposite directions.
        inside = shapely.Polygon(np.array(turned.interiors[0].coords)[::-1])
        both = flaunay.polygons(shapely.MultiPolygon([turned, inside]), **options)
        assert both.areas.sum() == pytest.approx(polygon.area + inside.area)
        border = shapely.Polygon(turned.exterior)
        overlapping = flaunay.polygons(shapely.MultiPolygon([border, turned, inside]), **options)
        assert overlapping.areas.sum() == pytest.approx(border.area)


def test_parts_in_the_layout_of_geoarrow():
    multi = shapely.MultiPolygon([shapely.Polygon(SQUARE, [HOLE[::-1]]), shapely.box(1, 1, 2, 2)])
    _, coordinates, (rings, parts, each) = shapely.to_ragged_array([multi, multi])
    options = {"part_offsets": parts, "fill_rule": "winding"}
    mesh = flaunay.polygons(coordinates, rings, parts[each], **options)
    assert mesh.polygon_areas.tolist() == [32, 32]
    assert flaunay.polygons(coordinates, rings, **options).polygon_areas.tolist() == [32, 1, 32, 1]
    with pytest.raises(flaunay.UsageError, match="a polygon does not begin with a part"):
        flaunay.polygons(coordinates, rings, [0, 1, len(rings) - 1], **options)
    with pytest.raises(flaunay.UsageError, match="part_offsets end with 2, but there are 6 rings"):
        flaunay.polygons(coordinates, rings, [0, 6], part_offsets=[0, 2])


def test_a_map_has_common_borders():
    apart = flaunay.polygons(EXPECTED)
    mesh = flaunay.polygons(EXPECTED, map=True, neighbors=True)
    assert mesh.polygons.tolist().count(1) == 1 and len(mesh.triangles) == 9
    assert mesh.polygon_areas.tolist() == [32, 9] == apart.polygon_areas.tolist()
    # Across the common border, triangles know each other.
    beside = int(np.flatnonzero(mesh.polygons == 1)[0])
    assert (mesh.neighbors[beside] >= 0).sum() == 1
    assert as_set(mesh.triangles_of(1)) == as_set(mesh.triangles[[beside]])
    assert [shapely.area(c) for c in mesh.to_shapely()] == [32, 9]
    assert apart.polygons is None


def test_overlaps_of_a_map():
    inside = [[SQUARE], [HOLE]]
    assert flaunay.polygons(inside, map=True).polygon_areas.tolist() == [36, 0]
    assert flaunay.polygons(inside[::-1], map=True).polygon_areas.tolist() == [4, 32]
    with pytest.raises(flaunay.InputError):
        flaunay.polygons(inside, map=True, overlaps="error")


# ---- Errors


def test_a_border_that_crosses_itself_names_the_polygon():
    bow = [[0, 0], [2, 2], [2, 0], [0, 2]]
    with pytest.raises(flaunay.InputError, match="polygon 1"):
        flaunay.polygons([[SQUARE], [bow]])


@pytest.mark.parametrize(
    "given, message",
    [
        (3, "geometries must be polygons.*not int"),
        ("POLYGON", "geometries must be polygons.*not str"),
        (SQUARE, r"geometries\[0\]\[0\] is no ring of points.*a list of rings"),
        ([SQUARE, HOLE], r"geometries\[0\]\[0\] is no ring of points"),
        (np.array([SQUARE, HOLE]), r"geometries\[0\]\[0\] is no ring of points"),
        ([[SQUARE], 5], r"geometries\[1\] is no polygon, but a int"),
        ([["abc"]], r"geometries\[0\]\[0\] are numbers, not text"),
        ([[SQUARE, [[1, 2, 3, 4]]]], r"geometries\[0\]\[1\] must be a ring.*\(1, 4\)"),
        ([[[[0, 0], [1]]]], r"geometries\[0\]\[0\] (are no array of|must be real) numbers"),
        ([POLYGONS[0], shapely.Point(0, 0)], r"geometries\[1\] is a Point"),
        (shapely.LineString([[0, 0], [1, 1]]), r"geometries\[0\] is a LineString"),
        (shapely.GeometryCollection(POLYGONS), r"geometries\[0\] is a GeometryCollection"),
        ({"type": "Point", "coordinates": [0, 0]}, "geometries have a Point"),
        (
            [{"type": "FeatureCollection", "features": features()}],
            r"geometries\[0\] are 2 polygons",
        ),
    ],
)
def test_what_are_no_polygons(given, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.polygons(given)


@pytest.mark.parametrize(
    "rings, outer, message",
    [
        ([0, 3], None, "ring_offsets end with 3, but there are 4 points"),
        ([1, 4], None, "ring_offsets must begin with 0"),
        ([0, 3, 2, 4], None, "ring_offsets must begin with 0 and not decrease"),
        ([0.0, 4.0], None, "ring_offsets must be integers"),
        (np.empty(0, int), None, "ring_offsets must have one number at least"),
        ([0, 4], [0, 2], "polygon_offsets end with 2, but there are 1 rings"),
        ([0, 2, 4], [0, 2, 1, 2], "polygon_offsets must begin with 0 and not decrease"),
        ([0, 4], [[0, 1]], "polygon_offsets must be integers in one dimension"),
        (None, [0, 1], "polygon_offsets and part_offsets are for rings"),
    ],
)
def test_offsets_that_are_none(rings, outer, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.polygons(np.array(SQUARE), rings, outer)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"overlaps": "last"}, "overlaps must be one of 'first', 'error'"),
        ({"outside": "all"}, "outside must be one of"),
        ({"map": True, "fill_rule": "nesting"}, "even-odd or winding"),
    ],
)
def test_options_that_are_none(options, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.polygons(EXPECTED, **options)


def test_collections_that_are_too_deep():
    features, arrays = {"type": "FeatureCollection", "features": []}, []
    for _ in range(100_000):
        features, arrays = {"type": "FeatureCollection", "features": [features]}, [arrays]
    for given in features, [features]:
        with pytest.raises(flaunay.UsageError, match="too deep"):
            flaunay.polygons(given)
    for given in arrays, {"type": "Polygon", "coordinates": arrays}:
        with pytest.raises(flaunay.UsageError, match="no array of numbers"):
            flaunay.polygons(given)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_coordinates_that_are_not_finite(bad):
    with pytest.raises(flaunay.InputError, match="finite"):
        flaunay.polygons([[SQUARE], [[[0, 0], [1, bad], [1, 1]]]])


def test_there_is_no_polygon_of_another_number():
    mesh = flaunay.polygons(EXPECTED)
    assert len(mesh.triangles_of(-1)) == 1
    for p in 2, -3:
        with pytest.raises(IndexError, match=f"polygon {p} is none of the 2 polygons"):
            mesh.triangles_of(p)
