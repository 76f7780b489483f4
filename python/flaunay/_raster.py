"""Rasters and contours of values at the points of a triangulation."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Sequence
from typing import Any, Optional, Protocol, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, FloatArray, Triangles, as_floats, check_out, summary
from flaunay._errors import UsageError

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
# The centre of the first pixel, and the steps to the next ones.
Grid = tuple[float, float, float, float]


class Surface(Triangles, Protocol):
    """Triangles with neighbours, as functions below the classes see them."""

    @property
    def neighbors(self) -> Optional[Indices]: ...


def _arrays_of(tri: Surface, values: ArrayLike) -> tuple[Any, ...]:
    if len(getattr(tri, "triangle_offsets", (0, 0))) != 2:
        raise UsageError("a raster or contours need the triangulation of one set of points")
    if tri.neighbors is None:
        raise UsageError("the triangulation has no neighbors: ask for them by neighbors=True")
    numbers = np.asarray(as_floats(values, "values"), np.float64)
    points = getattr(tri, "_stand_ins", (tri.points,))[0]
    return points, tri.simplices, tri.neighbors, numbers


def as_length(given: Optional[float], name: str) -> float:
    """A positive length, or 0 for None."""
    if given is None:
        return 0.0
    if not given > 0:
        raise UsageError(f"{name} must be positive or None, not {given}")
    return float(given)


def grid_of(
    shape: tuple[int, int], bounds: Optional[Sequence[float]], points: FloatArray
) -> tuple[tuple[int, int], Grid]:
    """Numbers of rows and columns, and the first pixel with the steps to the next ones.

    Without bounds, those of the points, of which there are some.
    """
    try:
        rows, columns = (operator.index(number) for number in shape)
    except (TypeError, ValueError):
        rows = columns = 0
    if min(rows, columns) < 1:
        raise UsageError(
            f"shape must be numbers of rows and columns, such as (200, 300), not {shape!r}"
        )
    if bounds is None:
        low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
        box = np.array([*low, *high], np.float64)
    else:
        box = np.asarray(as_floats(bounds, "bounds"), np.float64)
    if box.shape != (4,) or not (box[0] < box[2] and box[1] < box[3]):
        raise UsageError(f"bounds must be xmin < xmax and ymin < ymax, not {box.tolist()}")
    dx, dy = (box[2] - box[0]) / columns, (box[3] - box[1]) / rows
    return (rows, columns), (box[0] + dx / 2, box[3] - dy / 2, dx, -dy)


def rasterize(
    tri: Surface,
    values: ArrayLike,
    grid: Grid,
    pixels: Doubles,
    max_edge: Optional[float],
    fill_value: float,
    device: Optional[str],
) -> None:
    """Writes a raster whose first pixel has its centre at `grid`'s x and y, and the next ones at steps."""
    longest = as_length(max_edge, "max_edge")
    _calls.rasterize(
        _triangulators.of_device(device),
        *_arrays_of(tri, values),
        grid=grid,
        max_edge=longest,
        fill=float(fill_value),
        pixels=pixels,
    )




class Contours:
    """Contour lines. `Delaunay.contours` makes them.

    As a sequence, it has one pair for each line: the height, and the points, float64, shape (k, 2).

    Attributes
    ----------
    points : ndarray of float64, shape (m, 2)
        The points of all lines.
    offsets : ndarray of int64, shape (lines + 1,)
        Line i has the points ``offsets[i]`` to ``offsets[i + 1]``.
    heights : ndarray of float64, shape (lines,)
        The height of each line.
    """

    def __init__(self, points: Doubles, offsets: npt.NDArray[np.int64], heights: Doubles) -> None:
        self.points = points
        self.offsets = offsets
        self.heights = heights

    def __repr__(self) -> str:
        return summary(self, lines=len(self), points=len(self.points))

    def __len__(self) -> int:
        return len(self.heights)

    def __getitem__(self, i: int) -> tuple[float, Doubles]:
        line = range(len(self))[i]
        return float(self.heights[line]), self.points[self.offsets[line] : self.offsets[line + 1]]

    def __iter__(self) -> Iterator[tuple[float, Doubles]]:
        return (self[i] for i in range(len(self)))

    @property
    def closed(self) -> npt.NDArray[np.bool_]:
        """Whether each line ends where it begins, shape (lines,)."""
        first, last = self.points[self.offsets[:-1]], self.points[self.offsets[1:] - 1]
        same: npt.NDArray[np.bool_] = (first == last).all(axis=1)
        return same

    def to_geojson(self) -> dict[str, Any]:
        """The lines as a GeoJSON FeatureCollection of LineStrings, with the property ``height``.

        GeoJSON takes longitudes and latitudes for granted (RFC 7946); other programs read any coordinates.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> lines = tri.contours([0, 4, 4], [1]).to_geojson()
        >>> lines["features"][0]["geometry"]["coordinates"]
        [[0.0, 1.0], [1.0, 0.0]]
        """
        features = [
            {
                "type": "Feature",
                "properties": {"height": height},
                "geometry": {"type": "LineString", "coordinates": line.tolist()},
            }
            for height, line in self
        ]
        return {"type": "FeatureCollection", "features": features}


class MapMethods:
    """Maps of values at the points of a triangulation."""

    def raster(
        self: Surface,
        values: ArrayLike,
        shape: tuple[int, int],
        bounds: Optional[Sequence[float]] = None,
        *,
        max_edge: Optional[float] = None,
        fill_value: float = np.nan,
        out: Optional[Doubles] = None,
        device: Optional[str] = None,
    ) -> Doubles:
        """A raster of values at the points, by linear interpolation in the triangles.

        Parameters
        ----------
        values : array_like, shape (npoints,)
            One number per point, such as its height. Of equal points, that of the representative counts.
        shape : tuple of int
            Numbers of rows and columns.
        bounds : (xmin, ymin, xmax, ymax), optional
            What the pixels cover together, from edge to edge; the box of the points by default. The first
            row is the one with the largest y, as in pictures and maps.
        max_edge : float, optional
            Pixels in triangles with a longer edge have no value, so that bays and gaps are not bridged.
        fill_value : float, optional
            The value of pixels that are in no triangle.
        out : ndarray of float64, optional
            An array of this shape for the result.
        device : str, optional
            As of `triangulate`.

        Returns
        -------
        ndarray of float64, of the shape
            The values at the centres of pixels, ``x = xmin + dx / 2 + column * dx`` and
            ``y = ymax - dy / 2 - row * dy``.

        Raises
        ------
        UsageError
            For another number of values than of points, a shape or bounds that make no sense, and a
            triangulation of several sets.
        InputError
            For pixels that are too small for doubles.
        DeviceError
            As of `triangulate`.

        Notes
        -----
        Which triangle a pixel's centre lies in is decided exactly. The border belongs to the triangles, and a
        centre on an edge between two of them to one of both, always to the same one: the result depends
        on the points and values alone. O(triangles + pixels).

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.raster([0, 8, 4], shape=(2, 4))
        array([[ 4., nan, nan, nan],
               [ 2.,  4.,  6., nan]])
        """
        if bounds is None and len(self.simplices) == 0:
            raise UsageError("bounds are needed, as there are no triangles")
        shape, grid = grid_of(shape, bounds, self.points)
        if out is None:
            out = np.empty(shape)
        else:
            check_out(out, np.float64, shape, "out")
        rasterize(self, values, grid, out, max_edge, fill_value, device)
        return out

    def contours(
        self: Surface,
        values: ArrayLike,
        heights: Union[ArrayLike, float],
        *,
        max_edge: Optional[float] = None,
        device: Optional[str] = None,
    ) -> Contours:
        """Contour lines of values at the points, which are linear in the triangles.

        Parameters
        ----------
        values : array_like, shape (npoints,)
            One number per point. Triangles with one that is not finite have no lines.
        heights : array_like
            The heights of lines, or one of them, in any order.
        max_edge : float, optional
            Triangles with a longer edge have no lines.
        device : str, optional
            As of `triangulate`; lines are traced on the host.

        Returns
        -------
        Contours
            Sorted by height. Higher values are on the left of a line. It is closed, or begins and ends at
            the border of the triangles; lines do not cross, but by rounding. A value that equals a height
            counts as above it. Lines are simple, as Shapely and GIS want them: where one would go through a
            point twice or cross itself, it becomes several.

        Raises
        ------
        UsageError
            For another number of values than of points, heights that are not finite, and a
            triangulation of several sets.

        Notes
        -----
        The result depends on points and values alone, not on their order. O(triangles + points of lines).

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> for height, line in tri.contours([0, 4, 4], [1, 2]):
        ...     print(height, line.tolist())
        1.0 [[0.0, 1.0], [1.0, 0.0]]
        2.0 [[0.0, 2.0], [2.0, 0.0]]
        """
        levels = np.unique(np.asarray(as_floats(heights, "heights"), np.float64))
        points, offsets, numbers = _calls.contours(
            _triangulators.of_device(device),
            *_arrays_of(self, values),
            heights=levels,
            max_edge=as_length(max_edge, "max_edge"),
        )
        return Contours(points, offsets, levels[numbers])
