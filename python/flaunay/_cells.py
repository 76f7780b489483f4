"""Voronoi cells clipped to a box or a convex polygon."""

from __future__ import annotations

import operator
import re
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import Frozen, as_floats, as_integers, frozen, geometries_of, summary
from flaunay._delaunay import Delaunay
from flaunay._dissolve import Dissolved, linear_rings
from flaunay._errors import InputError, UsageError
from flaunay._optional import optional

_Doubles = npt.NDArray[np.float64]

# What takes polygons that are not convex.
_PIECES = "Voronoi.pieces takes any polygons"


def corners_of(bounds: Any) -> _Doubles:
    """The corners of a box or polygon, counter-clockwise, without a last one that repeats the first."""
    return ring_of(bounds)[0]


def ring_of(bounds: Any, instead: str = _PIECES) -> tuple[_Doubles, bool]:
    """The corners, and whether they came clockwise. instead: what takes any polygons."""
    geometries = geometries_of(bounds, "bounds")
    if geometries is None:
        given = bounds
    else:
        shapely = optional("shapely", "clipped")
        parts = shapely.get_parts(geometries)
        kind = parts[0].geom_type if len(parts) else "no polygon"
        if len(parts) != 1 or kind != "Polygon" or len(parts[0].interiors):
            what = f"{len(parts)} of them" if len(parts) > 1 else "one with holes"
            what = what if kind == "Polygon" else kind
            raise UsageError(f"bounds must be one convex polygon, not {what}; {instead}")
        given = np.asarray(parts[0].exterior.coords)[:, :2]
    corners = np.asarray(as_floats(given, "bounds"), np.float64)
    if corners.shape == (4,):
        x0, y0, x1, y1 = corners
        if not (x0 < x1 and y0 < y1):
            raise UsageError(f"bounds must be xmin < xmax and ymin < ymax, not {corners.tolist()}")
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]), False
    if corners.ndim != 2 or corners.shape[1] != 2:
        raise UsageError(
            "bounds must be (xmin, ymin, xmax, ymax) or the corners of a convex polygon, of shape (m, 2), "
            f"not of shape {corners.shape}"
        )
    if len(corners) > 1 and (corners[0] == corners[-1]).all():
        corners = corners[:-1]
    # The library decides exactly whether it is convex; here only which way around it goes.
    with np.errstate(all="ignore"):
        across = corners - corners[:1]
        # Neither overflows nor underflows.
        across = across / (np.max(np.abs(across), initial=0.0) or 1.0)
        area = np.sum(across[:-1, 0] * across[1:, 1] - across[:-1, 1] * across[1:, 0])
    return (corners[::-1], True) if area < 0 else (corners, False)


class ClippedVoronoi(Frozen):
    """The Voronoi cells of points, clipped to a box or a convex polygon. `Voronoi.clipped` makes it.

    Which vertices a cell has is decided exactly; their coordinates are rounded. Vertices that coincide but
    for that are one, in all cells that share them. So polygons are simple, and tile.

    Attributes
    ----------
    vertices : ndarray of float64, shape (nvertices, 2)
        Cell i has ``vertices[offsets[i]:offsets[i + 1]]``, counter-clockwise. It has none if its point
        equals an earlier one, or if the cell has no area within the bounds, or none but for rounding;
        otherwise three at least.
    offsets : ndarray of int32, shape (npoints + 1,)
    areas : ndarray of float64, shape (npoints,)
        0 for cells without area within the bounds.
    centroids : ndarray of float64, shape (npoints, 2)
        NaN for these.
    bounds : ndarray of float64, shape (m, 2)
        The corners of the box or polygon, counter-clockwise.
    """

    def __init__(
        self,
        vertices: _Doubles,
        offsets: npt.NDArray[np.int32],
        areas: _Doubles,
        centroids: _Doubles,
        bounds: _Doubles,
    ) -> None:
        self.vertices: _Doubles = frozen(vertices)
        self.offsets: npt.NDArray[np.int32] = frozen(offsets)
        self.areas: _Doubles = frozen(areas)
        self.centroids: _Doubles = frozen(centroids)
        self.bounds: _Doubles = frozen(bounds)

    def __repr__(self) -> str:
        return summary(self, points=len(self.areas), vertices=len(self.vertices))

    def polygon(self, i: int) -> _Doubles:
        """The vertices of cell i, counter-clockwise, shape (k, 2); k is 0 if there are none.

        Raises IndexError for a cell that does not exist. Negative numbers count from the end.
        """
        n, i = len(self.areas), operator.index(i)
        if not -n <= i < n:
            raise IndexError(f"cell {i} of {n}")
        i %= n
        return self.vertices[self.offsets[i] : self.offsets[i + 1]]

    def polygons(self) -> list[_Doubles]:
        """The vertices of all cells, one array per point."""
        ends = self.offsets.tolist()
        return [self.vertices[first:last] for first, last in zip(ends, ends[1:])]

    def to_shapely(self) -> npt.NDArray[np.object_]:
        """An array of one shapely.Polygon per point, empty polygons for cells without vertices.

        Needs shapely 2. A geopandas.GeoSeries takes the array as it is. The polygons are valid.

        Raises
        ------
        ImportError
            Without shapely.
        """
        shapely = optional("shapely", "ClippedVoronoi.to_shapely")
        has_cell = np.diff(self.offsets) > 0
        offsets = np.append(self.offsets[:-1][has_cell], len(self.vertices))
        polygons = np.full(len(self.areas), shapely.Polygon(), dtype=object)
        polygons[has_cell] = shapely.polygons(linear_rings(shapely, self.vertices, offsets))
        return polygons


def clip(tri: Delaunay, bounds: Any, instead: str = _PIECES) -> ClippedVoronoi:
    """As `Voronoi.clipped` says, of the cells of a triangulation's points. instead: what takes any polygons."""
    corners, is_turned = ring_of(bounds, instead)
    try:
        arrays = _calls.clipped_voronoi(_triangulators.of_device(tri._device), tri, corners)
    except InputError as error:
        raise with_corner(error, len(corners), is_turned, instead) from None
    return ClippedVoronoi(**arrays, bounds=corners)


def with_corner(error: InputError, count: int, is_turned: bool, instead: str) -> InputError:
    """The error with the corner's number in the ring that was given."""

    def given(match: re.Match[str]) -> str:
        return f"corner {count - 1 - int(match[1]) if is_turned else int(match[1])}"

    text = re.sub(r"corner (\d+)", given, str(error))
    if is_turned:
        text = text.replace("turns right at", "turns left at")
    text = text.replace("convex and counter-clockwise", "convex")
    if "convex" in text:
        text += f"; {instead}"
    return InputError(text, error.code, error.call)


def _box_around(*given: _Doubles) -> _Doubles:
    """The smallest box around places."""
    places = np.concatenate(given)
    if len(places) == 0:
        raise UsageError("there are no points to take the bounds of: give bounds or extend_to")
    low, high = places.min(axis=0), places.max(axis=0)
    if not (low < high).all():
        raise UsageError("the points lie on one line: give bounds or extend_to")
    return np.concatenate([low, high])


def _places_of(extent: Any) -> _Doubles:
    """The corners of a box, or the places of geometries or of an array."""
    geometries = geometries_of(extent, "extend_to")
    if geometries is not None:
        shapely = optional("shapely", "voronoi_polygons")
        given, numbers = shapely.get_coordinates(geometries, return_index=True)
        missing = np.setdiff1d(np.arange(len(geometries)), numbers)
        if len(missing):
            raise UsageError(f"extend_to[{missing[0]}] is missing or empty")
    else:
        given = np.asarray(as_floats(extent, "extend_to"), np.float64)
        numbers = np.arange(len(given)) if given.ndim else given
    wrong = np.argwhere(~np.isfinite(given))
    if len(wrong):
        raise InputError(f"extend_to[{numbers[wrong[0][0]]}] is not finite: {given[wrong[0][0]].tolist()}")
    if given.shape == (4,):
        given = given.reshape(2, 2)
        if not (given[0] <= given[1]).all():
            raise UsageError(f"extend_to must be xmin <= xmax and ymin <= ymax, not {given.ravel().tolist()}")
    if given.ndim != 2 or given.shape[1] != 2 or len(given) == 0:
        raise UsageError(
            "extend_to must be (xmin, ymin, xmax, ymax), places of shape (m, 2) or geometries, "
            f"not of shape {given.shape}"
        )
    return np.asarray(given, np.float64)


def voronoi_polygons(
    points: npt.ArrayLike,
    bounds: Any = None,
    as_shapely: bool = False,
    device: Optional[str] = None,
    *,
    groups: Optional[npt.ArrayLike] = None,
    extend_to: Any = None,
) -> Any:
    """The Voronoi cell of each point, or those of each group of points together, clipped to a box or a convex polygon.

    Parameters
    ----------
    points : array_like, shape (npoints, 2)
        As of `Delaunay`.
    bounds : array_like or shapely.Polygon, optional
        As of `Voronoi.clipped`. By default the smallest box around the points and `extend_to`, without a margin:
        the outermost points lie on their cells' borders.
    as_shapely : bool, default False
        Whether to make polygons of shapely.
    device : str, optional
        As of `triangulate`.
    groups : array_like of int, shape (npoints,), optional
        The group of each point, such as the building that a point is of.
    extend_to : array_like, shapely geometry or GeoSeries, optional
        What the box by default has to contain, too: another box ``(xmin, ymin, xmax, ymax)``, places of shape (m, 2),
        or geometries, such as one that the polygons are to be cut by.

    Returns
    -------
    list of ndarray of float64, shape (k, 2)
        One per point, counter-clockwise. ``shapely.Polygon`` takes each as it is; empty for a point that
        equals an earlier one or whose cell does not meet the bounds. Or, with as_shapely, an array of
        shapely polygons, which ``geopandas.GeoSeries`` takes as it is.

        With `groups`, one per group in increasing order, as ``numpy.unique(groups)`` has them: a list of parts, each a
        list of rings, the outer one counter-clockwise first, then its holes clockwise; with as_shapely a Polygon or
        a MultiPolygon, empty for a group without cells. Edges that cells of a group share have gone, exactly, and
        with them the corners on the bounds.

    Raises
    ------
    UsageError, InputError
        As of `Delaunay` and `Voronoi.clipped`; UsageError for groups that are not integers, or not one per point,
        for both `bounds` and `extend_to`, for an empty `extend_to`, and without both for points whose box has no area.
    ImportError
        With as_shapely without Shapely 2.

    Notes
    -----
    O(n log n) work. Lists for groups take some 1.3 times as long as those for cells where groups are connected, and
    twice where their cells are scattered.

    Examples
    --------
    >>> import flaunay
    >>> for polygon in flaunay.voronoi_polygons([[1, 1], [3, 1]], (0, 0, 4, 2)):
    ...     print(polygon.tolist())
    [[2.0, 2.0], [0.0, 2.0], [0.0, 0.0], [2.0, 0.0]]
    [[2.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0]]
    >>> points = [[1, 1], [3, 1], [1, 3], [3, 3]]
    >>> corner, rest = flaunay.voronoi_polygons(points, (0, 0, 4, 4), groups=[2, 2, -1, 2])
    >>> [ring.tolist() for part in rest for ring in part]
    [[[0.0, 2.0], [0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 4.0], [2.0, 2.0]]]
    """
    if bounds is not None and extend_to is not None:
        raise UsageError("give bounds or extend_to: bounds are not extended")
    tri = Delaunay(points, device=device)
    of_group = None
    if groups is not None:
        given = as_integers(groups, "groups")
        if given.shape != (tri.npoints,):
            raise UsageError(f"groups must have the shape ({tri.npoints},), one per point, not {given.shape}")
        names, of_group = np.unique(given, return_inverse=True)
    if bounds is None:
        others = [] if extend_to is None else [_places_of(extend_to)]
        bounds = _box_around(np.asarray(tri.points, np.float64), *others)
    cells = clip(tri, bounds)
    if of_group is None:
        return cells.to_shapely() if as_shapely else cells.polygons()
    made = Dissolved(cells.vertices, cells.offsets, of_group.astype(np.int32), len(names), cells.bounds)
    return made.to_shapely() if as_shapely else made.polygons()
