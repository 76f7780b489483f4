"""In place of libpysal.cg.voronoi_frames, which calls GEOS, and of Graph.build_triangulation, which calls SciPy."""

import geopandas
import libpysal
import numpy as np
import shapely

import flaunay


def voronoi_frames(
    geometry,
    radius=None,
    clip="bounding_box",
    shrink=0,
    segment=0,
    grid_size=1e-5,
    return_input=True,
    as_gdf=True,
):
    """libpysal.cg.voronoi_frames, with its arguments: cells of points, lines or polygons. radius has no effect.

    flaunay joins the cells of each line or polygon, exactly; Shapely cuts them. A cell outside of clip is empty, where
    libpysal leaves it as it is.
    """
    if hasattr(geometry, "geometry"):
        objects = shapely.set_precision(geometry.geometry.copy(), grid_size)
    else:
        objects = geometry = geopandas.GeoSeries(shapely.points(np.asarray(geometry)))
    if geometry.crs is not None and geometry.crs.is_geographic:
        raise ValueError("Geometry is in a geographic CRS: project it by GeoSeries.to_crs")
    is_line = objects.geom_type.isin(["LineString", "MultiLineString"])
    is_polygon = objects.geom_type.isin(["Polygon", "MultiPolygon"])
    if shrink:
        objects[is_polygon] = objects[is_polygon].buffer(-shrink, cap_style=2, join_style=2)
    if segment:
        objects[is_line | is_polygon] = shapely.segmentize(objects[is_line | is_polygon], segment)
    points, owners = shapely.get_coordinates(objects.values, return_index=True)
    # Ends that lines share belong to none of them.
    _, number, count = np.unique(points, axis=0, return_inverse=True, return_counts=True)
    kept = ~is_line.to_numpy()[owners] | (count[number.ravel()] == 1)
    points, owners = points[kept], owners[kept]
    limit, bounds = _limit_of(objects, points, clip), None
    if limit is None:
        # As GEOS has them.
        margin = np.ptp(points, axis=0).max()
        bounds = (*points.min(axis=0) - margin, *points.max(axis=0) + margin)
    cells = flaunay.voronoi_polygons(
        points, bounds, as_shapely=True, groups=owners, extend_to=limit
    )
    if (objects.geom_type == "Point").all():
        # Equal points have the same cell.
        _, first, number = np.unique(points, axis=0, return_index=True, return_inverse=True)
        cells = cells[first[number.ravel()]]
    if limit is not None:
        shapely.prepare(limit)
        cut = ~shapely.contains_properly(limit, cells)
        cells[cut] = shapely.intersection(cells[cut], limit)
    made = geopandas.GeoSeries(cells, index=objects.index[np.unique(owners)], crs=geometry.crs)
    if (is_line | is_polygon).any():
        made = made.sort_index()
    if as_gdf:
        made, geometry = made.to_frame("geometry"), geometry.geometry.to_frame("geometry")
    return (made, geometry) if return_input else made


def _limit_of(objects, points, clip):
    if clip is None or isinstance(clip, shapely.Geometry):
        return clip
    if clip == "alpha_shape":
        return libpysal.cg.alpha_shape_auto(points)
    if clip == "convex_hull":
        return shapely.MultiPoint(points).convex_hull
    if clip != "bounding_box":
        raise ValueError(f"Clip type '{clip}' not understood.")
    return shapely.box(*objects.total_bounds)


def delaunay_graph(points):
    """libpysal.graph.Graph.build_triangulation(points) of different points."""
    tri = flaunay.Delaunay(points)
    focal, neighbor = np.concatenate([tri.edges, tri.edges[:, ::-1]]).T.astype(np.int64)
    order = np.lexsort((neighbor, focal))
    return libpysal.graph.Graph.from_arrays(focal[order], neighbor[order], np.ones(len(order)))
