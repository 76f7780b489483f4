"""Triangles of polygons with holes, of many in one call."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import (
    ArrayLike,
    are_shapely,
    as_floats,
    as_offsets,
    as_points,
    column_of,
    frozen,
    geometries_in,
    names_of,
    number_of,
    summary,
)
from flaunay._constrained import (
    ConstrainedTriangulation,
    rules_of,
    with_points,
)
from flaunay._declarations import OVERLAPS
from flaunay._errors import UsageError
from flaunay._optional import optional
from flaunay._refinement import Refining, as_refinement, provable
from flaunay._triangulation import with_arrays

if TYPE_CHECKING:
    from typing_extensions import Unpack

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
Offsets = npt.NDArray[np.int64]

# Coordinates, offsets of rings and of polygons, and if it is known which rings are holes, of parts.
_Rings = tuple[Doubles, Offsets, Offsets, Optional[Offsets]]


@dataclass(frozen=True, eq=False, repr=False)
class PolygonTriangulation(ConstrainedTriangulation):
    """The triangles of polygons: `polygons` makes them.

    Each polygon is a set of points, so polygon p has the triangles ``triangle_offsets[p]`` to
    ``triangle_offsets[p + 1]``; in a map, all of them are one set.

    Attributes
    ----------
    points : ndarray of float64, shape (n + a, 2)
        The coordinates of the polygons as they were given, with the points that rings repeat at their ends
        if they were there, and after them those that splitting added. Segment i begins at point i.
    ring_offsets : ndarray of int64, shape (rings + 1,)
        Ring r has the points ``ring_offsets[r]`` to ``ring_offsets[r + 1]``.
    polygon_offsets : ndarray of int64, shape (k + 1,)
        Polygon p has the rings ``polygon_offsets[p]`` to ``polygon_offsets[p + 1]``.
    polygons : ndarray of int32, shape (m,), or None
        In a map, the polygon of each triangle, -1 if it is in none. Otherwise None.
    others
        As of `ConstrainedTriangulation`.
    """

    polygons: Optional[Indices]
    ring_offsets: Offsets
    polygon_offsets: Offsets

    def __repr__(self) -> str:
        return summary(self, polygons=len(self.polygon_offsets) - 1, triangles=len(self.triangles))

    @property
    def polygon_of(self) -> Indices:
        """The polygon of each triangle, int32, shape (m,); -1 in a map for one in none."""
        if self.polygons is not None:
            return self.polygons
        sizes = np.diff(self.triangle_offsets)
        return np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)

    def _groups(self) -> Indices:
        """The polygon of each triangle, from 1 on; 0 for none."""
        return self.polygon_of + np.int32(1)

    @property
    def polygon_areas(self) -> Doubles:
        """The sum of the areas of each polygon's triangles, float64, shape (k,).

        Its error is some roundings of the area of the polygon's bounding box.
        """
        of, count = self.polygon_of, len(self.polygon_offsets) - 1
        inside = of >= 0
        sums = np.bincount(of[inside], self.areas[inside], minlength=count)
        return np.asarray(sums, dtype=np.float64)

    def triangles_of(self, polygon: int) -> Indices:
        """The triangles of a polygon, int32, shape (m, 3).

        Raises
        ------
        IndexError
            If there is no such polygon.
        """
        count = len(self.polygon_offsets) - 1
        if not -count <= polygon < count:
            raise IndexError(f"polygon {polygon} is none of the {count} polygons")
        if self.polygons is not None:
            of_map: Indices = self.triangles[self.polygons == polygon % count]
            return of_map
        first, last = self.triangle_offsets[polygon % count + np.arange(2)]
        triangles: Indices = self.triangles[first:last]
        return triangles

    def to_shapely(self) -> npt.NDArray[Any]:
        """The triangles as geometries of Shapely, one collection for each polygon.

        Returns
        -------
        ndarray of shapely.GeometryCollection, shape (k,)
            Of the triangles as polygons, as `shapely.constrained_delaunay_triangles` returns them. Those
            of a map that are in no polygon are in none.

        Raises
        ------
        ImportError
            Without Shapely 2.
        """
        of = self.polygon_of
        inside = np.flatnonzero(of >= 0)
        order = inside[np.argsort(of[inside], kind="stable")]
        count = len(self.polygon_offsets) - 1
        return self._collections(self.triangles[order], of[order], count)


def _offsets_of(owners: npt.NDArray[np.intp], count: int) -> Offsets:
    """The offsets of `count` rows, from the row of each of their members, in order."""
    sizes = np.bincount(owners, minlength=count)
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


# ---- Shapely


def _of_shapely(geometries: npt.NDArray[Any]) -> _Rings:
    """The rings of geometries, in one dimension; missing ones have none."""
    shapely = optional("shapely", "polygons")
    types = shapely.get_type_id(geometries)
    # -1: missing; 3: Polygon; 6: MultiPolygon
    wrong = np.flatnonzero(~np.isin(types, (-1, 3, 6)))
    if wrong.size:
        first = int(wrong[0])
        raise UsageError(
            f"geometries[{first}] is a {geometries[first].geom_type}: "
            "only Polygon and MultiPolygon have triangles"
        )
    parts, geometry_of = shapely.get_parts(geometries, return_index=True)
    rings, part_of = shapely.get_rings(parts, return_index=True)
    coordinates, ring_of = shapely.get_coordinates(rings, return_index=True)
    return (
        coordinates,
        _offsets_of(ring_of, len(rings)),
        _offsets_of(geometry_of[part_of], len(geometries)),
        _offsets_of(part_of, len(parts)),
    )


# ---- GeoJSON, and objects with __geo_interface__


def _geojson_of(given: Any) -> Any:
    """What an object says of itself, if it is a geometry in the way of GeoJSON; otherwise None."""
    described = getattr(given, "__geo_interface__", given)
    return described if isinstance(described, Mapping) and "type" in described else None


def _rows_of_geojson(described: Mapping[str, Any]) -> Iterator[list[Any]]:
    """The parts of each polygon: lists of rings, the border and then its holes."""
    kind = described["type"]
    if kind == "FeatureCollection":
        for feature in described["features"]:
            yield from _rows_of_geojson(feature)
    elif kind == "Feature":
        geometry = described["geometry"]
        if geometry is None:
            yield []
        else:
            yield from _rows_of_geojson(geometry)
    elif kind == "Polygon":
        yield [list(described["coordinates"])]
    elif kind == "MultiPolygon":
        yield list(described["coordinates"])
    else:
        raise UsageError(f"geometries have a {kind}: only Polygon and MultiPolygon have triangles")


# ---- Lists of rings


def _parts_of_row(given: Any, row: int) -> tuple[list[Any], bool]:
    """The parts of one polygon, and whether they are known: of a list of rings, all are one."""
    if given is None:
        return [], True
    described = _geojson_of(given)
    if described is not None:
        rows = list(_rows_of_geojson(described))
        if len(rows) != 1:
            raise UsageError(f"geometries[{row}] are {len(rows)} polygons, not one")
        return rows[0], True
    if not isinstance(given, (Sequence, np.ndarray)) or isinstance(given, (str, bytes)):
        raise UsageError(f"geometries[{row}] is no polygon, but a {type(given).__name__}")
    return [list(given)], False


def _as_ring(given: Any, name: str) -> Doubles:
    """The points of a ring, of which some formats have heights, too."""
    ring = np.asarray(as_floats(given, name), np.float64)
    if ring.size == 0:
        return np.empty((0, 2))
    if ring.ndim < 2:
        raise UsageError(
            f"{name} is no ring of points, but has the shape {ring.shape}: "
            "geometries are a list of polygons, and each polygon a list of rings"
        )
    if ring.ndim > 2 or ring.shape[1] not in (2, 3):
        raise UsageError(f"{name} must be a ring of the shape (n, 2), not {ring.shape}")
    return ring[:, :2]


def _of_lists(rows: Sequence[Any]) -> _Rings:
    """The rings of polygons, each of which is a list of rings, or describes itself."""
    rings: list[Doubles] = []
    counts: list[int] = []
    part_counts: list[int] = []
    are_known = True
    for p, row in enumerate(rows):
        parts, is_known = _parts_of_row(row, p)
        members = [ring for part in parts for ring in part]
        rings += [_as_ring(ring, f"geometries[{p}][{r}]") for r, ring in enumerate(members)]
        counts.append(len(members))
        part_counts += [len(part) for part in parts]
        are_known &= is_known
    sizes = [len(ring) for ring in rings]
    return (
        np.concatenate([np.empty((0, 2)), *rings]),
        _summed(sizes),
        _summed(counts),
        _summed(part_counts) if are_known else None,
    )


def _summed(sizes: Sequence[int]) -> Offsets:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)


def _rows_of(given: Any) -> list[Any]:
    """The polygons of a list, an array or a column of a table."""
    column = column_of(given)
    if isinstance(column, (list, tuple)):
        return list(column)
    if hasattr(column, "__array__") or hasattr(column, "__len__"):
        rows = column if isinstance(column, np.ndarray) else np.asarray(column, object)
        if rows.ndim >= 1:
            return list(rows)
    raise UsageError(
        "geometries must be polygons: of Shapely or geopandas, with __geo_interface__, "
        f"or a list with a list of rings for each; not {type(given).__name__}"
    )


def _rings_of(given: Any) -> _Rings:
    geometries = geometries_in(given)
    if geometries is not None and are_shapely(geometries):
        return _of_shapely(geometries)
    # A table of geopandas describes itself, too, but slowly.
    described = None if hasattr(given, "__array__") else _geojson_of(given)
    if described is not None:
        several = _rows_of_geojson(described)
        return _of_lists([{"type": "MultiPolygon", "coordinates": parts} for parts in several])
    return _of_lists(_rows_of(given))


def _with_offsets(
    coordinates: ArrayLike,
    ring_offsets: npt.ArrayLike,
    polygon_offsets: Optional[npt.ArrayLike],
    part_offsets: Optional[npt.ArrayLike],
) -> _Rings:
    """Rings in GeoArrow's layout. The library checks the offsets."""
    points = np.asarray(as_points(coordinates), np.float64)
    # Copies, which the result keeps.
    rings = as_offsets(ring_offsets, "ring_offsets").copy()
    parts = None if part_offsets is None else as_offsets(part_offsets, "part_offsets")
    if polygon_offsets is not None:
        return points, rings, as_offsets(polygon_offsets, "polygon_offsets").copy(), parts
    each = np.arange(max(len(rings), 1), dtype=np.int64)
    return points, rings, each if parts is None else parts.copy(), parts


def _check_increasing(offsets: Offsets, name: str) -> None:
    # np.diff takes several times as long for few.
    if len(offsets) and (offsets[0] != 0 or (offsets[1:] < offsets[:-1]).any()):
        raise UsageError(f"{name} must begin with 0 and not decrease")


def polygons(
    geometries: Any,
    ring_offsets: Optional[npt.ArrayLike] = None,
    polygon_offsets: Optional[npt.ArrayLike] = None,
    *,
    part_offsets: Optional[npt.ArrayLike] = None,
    map: bool = False,
    overlaps: str = "first",
    outside: str = "holes",
    crossings: str = "error",
    fill_rule: str = "even_odd",
    labels: bool = False,
    neighbors: bool = False,
    halfedges: bool = False,
    device: Optional[str] = None,
    **refining: Unpack[Refining],
) -> PolygonTriangulation:
    """Triangulates polygons with holes, all of them in one call.

    Parameters
    ----------
    geometries : polygons
        One of these:

        - geometries of Shapely: a Polygon or MultiPolygon, or an array or list of them, of which None has no
          triangles;
        - a GeoSeries or GeoDataFrame of geopandas;
        - what has ``__geo_interface__``, or a dict in the way of GeoJSON, and lists of these;
        - a list of polygons, each of them a list of rings of shape (n, 2): ``[[outer, hole], [outer]]``;
        - with `ring_offsets`, coordinates of shape (n, 2).

        A ring may repeat its first point at its end or not, and may turn either way. Geometries, and what
        describes itself in the way of GeoJSON, say which rings are holes: a polygon is what is inside of its
        border and of none of its holes, and a MultiPolygon is one polygon, all of its parts together. In
        lists of rings and with `ring_offsets` alone, `fill_rule` decides that, not the order of rings.
    ring_offsets, polygon_offsets, part_offsets : array_like of int, optional
        The layout of GeoArrow: ring r has the points ``ring_offsets[r]`` to ``ring_offsets[r + 1]``, and
        polygon p the rings ``polygon_offsets[p]`` to ``polygon_offsets[p + 1]``. Without the latter, each
        ring is a polygon, or each part. With `part_offsets`, part q has the rings ``part_offsets[q]`` to
        ``part_offsets[q + 1]``, its border and then its holes; each polygon begins with a part.
    map : bool
        Whether polygons are one map, in which they share the edges of common borders: the triangles of
        all of them fit together. Otherwise each is triangulated on its own.
    overlaps : {"first", "error"}
        In a map, to which polygon a place belongs that is in several: the one of the smallest index; or
        it is an `InputError`.
    outside : {"holes", "hull", "keep"}
        What to keep: the inside, also what is in holes, or everything up to the hull of each polygon.
    crossings : {"error", "split"}
        What becomes of borders that cross where no point is, as in an invalid polygon.
    fill_rule : {"even_odd", "winding", "nesting"}
        What is inside of a polygon; see `triangulate`. Letters of fonts are filled by ``"winding"``. If it
        is known which rings are holes, the rule decides for each ring alone what is inside of it, unless it
        is ``"nesting"``.
    labels, neighbors, halfedges : bool
        What else to compute; see `triangulate`.
    device : str, optional
        As of `triangulate`.
    **refining
        What `refine` takes, such as ``min_angle`` and ``max_area``, to add points.

    Returns
    -------
    PolygonTriangulation
        The triangles of polygon p are ``triangles_of(p)``. Their corners are indices of `points`, which are
        the coordinates of all rings in their order.

    Raises
    ------
    UsageError
        For what are no polygons, rings of another shape, offsets that do not fit each other.
    InputError
        For borders that cross, unless they are to be split; the message names the polygon. For a coordinate
        that is not finite, and as `triangulate` otherwise.
    DeviceError
        As of `triangulate`.

    Notes
    -----
    Each polygon has the constrained Delaunay triangles of its points, and borders are never moved. Expected
    O(n log n) work for n points. The interpreter's lock is released meanwhile.

    Examples
    --------
    >>> import flaunay
    >>> square, hole = [[0, 0], [6, 0], [6, 6], [0, 6]], [[2, 2], [2, 4], [4, 4], [4, 2]]
    >>> mesh = flaunay.polygons([[square, hole], [hole]])
    >>> mesh
    <flaunay.PolygonTriangulation: 2 polygons, 10 triangles>
    >>> mesh.triangle_offsets
    array([ 0,  8, 10])
    >>> mesh.polygon_areas
    array([32.,  4.])

    With Shapely:

    >>> letter = shapely.box(0, 0, 3, 4) - shapely.box(1, 1, 3, 3)  # doctest: +SKIP
    >>> flaunay.polygons(letter).polygon_areas  # doctest: +SKIP
    array([8.])
    """
    rules = rules_of(crossings, outside, fill_rule, labels)
    rules |= {"map": int(bool(map)), "overlaps": number_of(OVERLAPS, overlaps, "overlaps")}
    if ring_offsets is not None:
        points, rings, outer, parts = _with_offsets(
            geometries, ring_offsets, polygon_offsets, part_offsets
        )
        _check_increasing(rings, "ring_offsets")
        _check_increasing(outer, "polygon_offsets")
    elif polygon_offsets is not None or part_offsets is not None:
        raise UsageError("polygon_offsets and part_offsets are for rings: pass ring_offsets, too")
    else:
        try:
            points, rings, outer, parts = _rings_of(geometries)
        except RecursionError:
            raise UsageError(
                "geometries have collections inside of collections, too deep"
            ) from None
    wanted = names_of(neighbors=neighbors, halfedges=halfedges)
    refinement = as_refinement(refining, len(points), 0)
    triangulator = _triangulators.of_device(device, "areas_at" in refinement)
    made = _calls.triangulate_polygons(
        *(triangulator, points, rings, outer, parts, rules, refinement, wanted | {"areas"})
    )
    offsets = {"ring_offsets": frozen(rings), "polygon_offsets": frozen(outer)}
    asked = {
        **rules,
        **offsets,
        "points": len(points),
        "ring_count": len(rings) - 1,
        "polygon_count": len(outer) - 1,
        "has_outside": 1,
        "has_fill_rule": 1,
        "refinement": provable(refinement),
    }
    if parts is not None:
        asked |= {"part_offsets": parts.copy(), "part_count": len(parts) - 1}
    made = with_points(made, points)
    return with_arrays(PolygonTriangulation, made, **offsets, _device=device, _asked=asked)
