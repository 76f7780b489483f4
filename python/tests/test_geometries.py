"""Geometries of Shapely and GeoPandas in, triangles as geometries out, and cells clipped to any polygons."""

import json
import pickle

import flaunay
import numpy as np
import pytest

shapely = pytest.importorskip("shapely", minversion="2")

COUNTRY = shapely.Polygon(
    [(0, 0), (10, 0), (10, 8), (6, 3), (4, 9), (0, 7)], [[(1, 1), (3, 1), (2, 3)], [(7, 1), (8, 1), (8, 2)]]
)


def test_points_are_geometries():
    points = np.random.default_rng(0).random((20, 2))
    want = flaunay.Delaunay(points).simplices
    given = [shapely.MultiPoint(points), list(shapely.points(points)), shapely.points(points)]
    given += [Collection([Described(point) for point in given[1]]), [Described(one) for one in given[1]]]
    if _has_geopandas():
        geopandas, pandas = pytest.importorskip("geopandas"), pytest.importorskip("pandas")
        series = geopandas.GeoSeries(shapely.points(points))
        given += [series, series.to_frame("place").set_geometry("place"), series.values]
        given += [geopandas.points_from_xy(*points.T), pandas.Series(list(series))]
    for geometries in given:
        assert np.array_equal(flaunay.Delaunay(geometries).simplices, want)
        assert np.array_equal(flaunay.triangulate(geometries).triangles, want)
        found = flaunay.griddata(geometries, points[:, 0], geometries)
        assert found == pytest.approx(points[:, 0])
    high = shapely.points(np.column_stack([points, np.arange(20)]))
    assert np.array_equal(flaunay.Delaunay(high).points, points)


class Described:
    """A geometry of another library, which says what it is."""

    def __init__(self, geometry):
        self.__geo_interface__ = geometry.__geo_interface__


class Collection:
    """A collection of another library."""

    def __init__(self, geometries):
        features = [{"type": "Feature", "geometry": one.__geo_interface__} for one in geometries]
        self.__geo_interface__ = {"type": "FeatureCollection", "features": features}


def test_columns_of_geopandas():
    if not _has_geopandas():
        pytest.skip("needs geopandas")
    geopandas, pandas = pytest.importorskip("geopandas"), pytest.importorskip("pandas")
    boxes = geopandas.GeoSeries([shapely.box(0, 0, 2, 2), shapely.box(2, 0, 4, 2)])
    points, voronoi = [[0, 0], [4, 2], [1, 1]], flaunay.Voronoi([[1, 1], [3, 1]])
    for column in boxes, boxes.values, boxes.to_frame("place").set_geometry("place"), pandas.Series(list(boxes)):
        assert voronoi.pieces(column).areas.tolist() == [4, 4]
        assert flaunay.polygons(column).polygon_areas.tolist() == [4, 4]
        assert len(flaunay.triangulate(points, column, outside="holes").constraint_edges) == 7
        assert voronoi.clipped(column[:1]).areas.tolist() == [4, 0]
    with_gaps = [*boxes, None]
    for column in geopandas.GeoSeries(with_gaps), pandas.Series(with_gaps), pandas.Series([*boxes, np.nan]):
        assert flaunay.polygons(column).polygon_areas.tolist() == [4, 4, 0]
    assert len(flaunay.triangulate(geopandas.GeoSeries([]).values).triangles) == 0
    for missing in None, np.nan:
        with pytest.raises(flaunay.UsageError, match=r"points\[1\] is missing"):
            flaunay.Delaunay(pandas.Series([shapely.Point(0, 0), missing]))


def _has_geopandas():
    try:
        import geopandas  # noqa: F401
    except ImportError:
        return False
    return True


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ([shapely.Point(0, 0), shapely.LineString([(0, 0), (1, 1)])], r"points\[1\] is a LineString"),
        ([shapely.Point(0, 0), shapely.Point()], r"points\[1\] is an empty Point"),
        ([shapely.Point(0, 0), None], r"points\[1\] is missing"),
        (COUNTRY, r"points\[0\] is a Polygon"),
        ([shapely.Point(0, 0), 7], r"points\[1\] is no geometry, but 7"),
    ],
)
def test_geometries_that_are_no_points(given, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.Delaunay(given)


def test_lines_and_polygons_are_segments():
    points = [[0, 0], [10, 0], [10, 10], [0, 10]]
    lines = [
        shapely.LineString([(1, 1), (4, 5), (8, 6)]),
        shapely.MultiLineString([[(2, 8), (3, 9)], [(5, 1), (9, 2)]]),
        shapely.box(6, 7, 9, 9),
    ]
    mesh = flaunay.triangulate(points, segments=lines)
    edges = {frozenset(map(tuple, mesh.points[edge].tolist())) for edge in mesh.constraint_edges}
    corners = [(6, 7), (6, 9), (9, 9), (9, 7)]
    want = [((1, 1), (4, 5)), ((4, 5), (8, 6)), ((2, 8), (3, 9)), ((5, 1), (9, 2))]
    want += [(corners[k - 1], corners[k]) for k in range(4)]
    assert edges == {frozenset(edge) for edge in want}
    ring = flaunay.triangulate(points, segments=shapely.LinearRing([(2, 2), (8, 2), (5, 8)]), outside="holes")
    assert ring.areas.sum() == 18
    with pytest.raises(flaunay.UsageError, match=r"segments\[1\] is a Point"):
        flaunay.triangulate(points, segments=[lines[0], shapely.Point(1, 2)])


def test_triangles_are_geometries():
    tri = flaunay.Delaunay(np.random.default_rng(1).random((30, 2)))
    triangles = tri.to_shapely()
    assert len(triangles) == tri.nsimplex
    assert shapely.area(triangles) == pytest.approx(tri.areas)
    heights = np.arange(tri.nsimplex)
    collection = json.loads(json.dumps(tri.to_geojson({"height": heights})))
    assert [feature["properties"]["height"] for feature in collection["features"]] == heights.tolist()
    back = shapely.from_geojson([json.dumps(f["geometry"]) for f in collection["features"]])
    assert shapely.equals(back, triangles).all()
    assert tri.to_geojson()["features"][0]["properties"] == {}
    with pytest.raises(flaunay.UsageError, match="height"):
        tri.to_geojson({"height": [1]})
    mesh = flaunay.triangulate([[0, 0], [4, 0], [0, 4]], segments=[[0, 1]])
    assert mesh.to_geojson()["features"][0]["geometry"]["coordinates"] == [[[0, 0], [4, 0], [0, 4], [0, 0]]]


def area_of_cell(points, i, region):
    """By half-planes, with Shapely."""
    cell = shapely.box(-1e3, -1e3, 1e3, 1e3)
    for other in np.delete(points, i, axis=0):
        middle, along = (points[i] + other) / 2, other - points[i]
        across = np.array([-along[1], along[0]])
        half = [middle + 1e4 * across, middle - 1e4 * across]
        half += [half[1] - 1e4 * along, half[0] - 1e4 * along]
        cell = shapely.intersection(cell, shapely.Polygon(half))
    return shapely.intersection(cell, region).area


@pytest.mark.parametrize(
    "region",
    [COUNTRY, shapely.MultiPolygon([COUNTRY, shapely.box(12, 0, 14, 3)]), shapely.box(1, 2, 3, 4)],
    ids=["holes", "parts", "box"],
)
def test_pieces_are_cells_in_the_polygons(region):
    points = np.random.default_rng(2).uniform(-2, 13, (25, 2))
    cells = flaunay.Voronoi(points).pieces(region)
    assert cells.areas.sum() == pytest.approx(region.area)
    assert cells.areas == pytest.approx([area_of_cell(points, i, region) for i in range(25)], abs=1e-7)
    geometries = cells.to_shapely()
    assert shapely.area(geometries) == pytest.approx(cells.areas, abs=1e-9)
    has_area = cells.areas > 0
    assert np.isnan(cells.centroids[~has_area]).all()
    for i in np.flatnonzero(has_area):
        parts = [shapely.Polygon(part) for part in cells.polygons(i)]
        assert sum(part.area for part in parts) == pytest.approx(cells.areas[i])
        moments = sum(part.area * shapely.get_coordinates(part.centroid)[0] for part in parts)
        assert cells.centroids[i] == pytest.approx(moments / cells.areas[i])
    assert cells.polygons(int(np.flatnonzero(~has_area)[0])) == []
    assert np.array_equal(pickle.loads(pickle.dumps(cells)).owners, cells.owners)


def test_pieces_of_few_and_equal_points():
    voronoi = flaunay.Voronoi([[1, 1], [1, 1], [9, 1]])
    cells = voronoi.pieces(COUNTRY)
    assert cells.areas[1] == 0 and cells.areas.sum() == pytest.approx(COUNTRY.area)
    alone = flaunay.Voronoi([[50, 50]]).pieces([COUNTRY])
    assert alone.areas == pytest.approx([COUNTRY.area])
    overlap = flaunay.Voronoi([[50, 50]]).pieces([shapely.box(0, 0, 2, 2), shapely.box(1, 0, 3, 2)])
    assert overlap.areas == pytest.approx([6])
    with pytest.raises(flaunay.UsageError, match="no area"):
        voronoi.pieces([[[[0, 0], [1, 1]]]])
    with pytest.raises(IndexError):
        cells.polygons(3)
    assert repr(alone).startswith("<flaunay.VoronoiPieces: 1 point,")


def test_what_clips_says_what_it_is():
    voronoi = flaunay.Voronoi(np.random.default_rng(3).random((9, 2)))
    box = shapely.box(0, 0, 1, 1)
    want = voronoi.clipped((0, 0, 1, 1)).areas
    for bounds in (box, [box], shapely.MultiPolygon([box])):
        assert voronoi.clipped(bounds).areas == pytest.approx(want)
    for bounds, message in [
        ([box, box], "2 of them"),
        (COUNTRY, "holes"),
        (shapely.Point(0, 0), "Point"),
    ]:
        with pytest.raises(flaunay.UsageError, match=f"{message}.*Voronoi.pieces"):
            voronoi.clipped(bounds)
    # Clockwise: the corner is that of the ring that was given.
    with pytest.raises(flaunay.InputError, match="turns left at corner 3: .*Voronoi.pieces"):
        voronoi.clipped([(0, 0), (0, 1), (1, 1), (0.25, 0.5), (1, 0)])
    with pytest.raises(flaunay.InputError, match="turns right at corner 3"):
        voronoi.clipped([(0, 0), (1, 0), (1, 1), (0.75, 0.5), (0, 1)])


def test_heights_and_centres():
    tri = flaunay.Delaunay(np.random.default_rng(4).random((20, 2)))
    corners = tri.points[tri.simplices]
    assert tri.centroids == pytest.approx(corners.mean(axis=1))
    away = np.hypot(*np.moveaxis(corners - tri.circumcenters[:, None], -1, 0))
    assert away == pytest.approx(np.repeat(tri.circumradii[:, None], 3, axis=1))
    meshio = pytest.importorskip("meshio")
    heights = np.arange(20.0)
    mesh = tri.to_meshio(z=heights)
    assert isinstance(mesh, meshio.Mesh) and np.array_equal(mesh.points[:, 2], heights)
    constrained = flaunay.triangulate(tri.points, segments=[[0, 1]], crossings="split")
    high = np.arange(float(len(constrained.points)))
    assert np.array_equal(constrained.to_meshio(z=high).points[:, 2], high)
    with pytest.raises(flaunay.UsageError, match="z must have"):
        tri.to_meshio(z=[1])


def test_arguments_of_refinement_are_named():
    for name in ("min_angle", "max_area"):
        with pytest.raises(TypeError, match=f"{name}.*flaunay.refine"):
            flaunay.Delaunay([[0, 0], [1, 0], [0, 1]], **{name: 1})
    with pytest.raises(TypeError, match="'colour'$"):
        flaunay.Delaunay([[0, 0], [1, 0], [0, 1]], colour=1)


def test_interpolators_say_what_they_are():
    points = [[0, 0], [1, 0], [0, 1]]
    assert repr(flaunay.LinearInterpolator(points, [1, 2, 3])) == (
        "<flaunay.LinearInterpolator: 3 points, 1 value per point>"
    )
    assert "4 values per point" in repr(flaunay.NearestInterpolator(points, np.zeros((3, 2, 2))))
