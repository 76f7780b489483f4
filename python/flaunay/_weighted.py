"""Weighted points: regular triangulations and power diagrams."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import ArrayLike, as_offsets, as_points, frozen, summary
from flaunay._cells import ClippedVoronoi, corners_of
from flaunay._errors import UsageError
from flaunay._export import ExportMethods
from flaunay._surfaces import Doubles, Indices, OfPoints, as_weights


class WeightedDelaunay(ExportMethods, OfPoints):
    """Regular triangulations of weighted points, the duals of power diagrams. `weighted` makes them.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, 2)
    weights : ndarray of float64, shape (npoints,)
    simplices : ndarray of int32, shape (nsimplex, 3)
        The corners of triangles, counter-clockwise.
    neighbors : ndarray of int32, shape (nsimplex, 3)
        The triangle opposite to each corner, -1 beyond the hull.
    hull : ndarray of int32, shape (nhull,)
        The hull's vertices, counter-clockwise; of a set on one line its vertices in their order.
    hidden : ndarray of int32, shape (nhidden,)
        The points without a power cell, ascending, but those that another one represents.
    representatives : ndarray of int32, shape (npoints,)
        The smallest index of a point of the set with the same coordinates and weight.
    simplex_offsets : ndarray of int64, shape (nsets + 1,)
        Set s has the triangles ``simplices[simplex_offsets[s]:simplex_offsets[s + 1]]``.
    hull_offsets : ndarray of int64, shape (nsets + 1,)
    """

    hull: Indices
    hidden: Indices
    hull_offsets: npt.NDArray[np.int64]
    _names = OfPoints._names | {name: name for name in ("hull", "hidden", "hull_offsets")}

    def __init__(
        self,
        points: Doubles,
        weights: Doubles,
        offsets: Optional[npt.NDArray[np.int64]],
        device: Optional[str],
    ) -> None:
        space = _calls.space_of("plane", weights=weights)
        super().__init__((points, weights, offsets, device), space, offsets)
        self.weights = weights

    def __repr__(self) -> str:
        return summary(self, points=self.npoints, triangles=self.nsimplex, hidden=len(self.hidden))

    @cached_property
    def hidden_by(self) -> Indices:
        """The triangle that hides each of the hidden points, exactly, shape (nhidden,).

        It has the point inside or on its border; of several it is the first. -1 in a set without triangles.
        """
        return frozen(self._handle.hiding_triangles(self._triangulator))

    def cells(self, bounds: Any) -> ClippedVoronoi:
        """The power cells of one set, clipped to a box or a convex polygon, with areas and centroids.

        Each cell is rounded by itself.

        Parameters
        ----------
        bounds : array_like or shapely.Polygon
            As of `Voronoi.clipped`.

        Raises
        ------
        UsageError
            For bounds that are none, and for several sets.
        InputError
            For a polygon that is not convex.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.weighted([[0, 0], [4, 0]], [0, 8])
        >>> tri.cells((-1, -1, 5, 1)).areas.tolist()
        [4.0, 8.0]
        """
        if len(self.simplex_offsets) != 2:
            raise UsageError("power cells are of one set; triangulate the sets one by one")
        corners = corners_of(bounds)
        arrays = self._handle.clipped_cells(self._triangulator, self.weights, corners)
        return ClippedVoronoi(**arrays, bounds=corners)


def weighted(
    points: ArrayLike,
    weights: ArrayLike,
    offsets: Optional[npt.ArrayLike] = None,
    *,
    device: Optional[str] = None,
) -> WeightedDelaunay:
    """Computes the regular triangulation of weighted points, the dual of their power diagram.

    Parameters
    ----------
    points : array_like, shape (n, 2)
    weights : array_like, shape (n,)
        Squared lengths of any sign; of circles, their squared radii.
    offsets : array_like of int, optional
        Where sets begin: set s has the points ``offsets[s]`` to ``offsets[s + 1]``. By default all points
        are one set.
    device : str, optional
        As of `triangulate`.

    Returns
    -------
    WeightedDelaunay

    Raises
    ------
    UsageError
        For a wrong shape, and offsets that decrease or do not go from 0 to n.
    InputError
        As of `triangulate`; also for a weight that is not finite, or too large or too fine beside the squares
        of coordinates.
    DeviceError
        As of `triangulate`.

    Notes
    -----
    Exact: the lower hull of the points at height x^2 + y^2 - weight. A point that only lies on what others span
    is hidden. With equal weights it is the Delaunay triangulation. O(n log n).

    Examples
    --------
    >>> import flaunay
    >>> tri = flaunay.weighted([[0, 0], [4, 0], [0, 4], [1, 1]], [0, 0, 0, -9])
    >>> tri
    <flaunay.WeightedDelaunay: 4 points, 1 triangle, 1 hidden>
    >>> tri.hidden.tolist(), tri.hidden_by.tolist()
    ([3], [0])
    """
    given = np.asarray(as_points(points), np.float64)
    sets = None if offsets is None else as_offsets(offsets)
    return WeightedDelaunay(frozen(given.copy()), as_weights(weights, len(given)), sets, device)
