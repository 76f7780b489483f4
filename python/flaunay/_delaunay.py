"""The Delaunay triangulation with the names of SciPy."""

from __future__ import annotations

import os
import threading
from functools import cached_property
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _flaunay, _triangulators
from flaunay._arrays import FloatArray, as_floats, as_points, summary
from flaunay._errors import UsageError
from flaunay._export import TriangleExports
from flaunay._plot import TrianglePlots
from flaunay._triangulation import triangulate

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]


def _check_points(indices: Indices, n: int, name: str) -> None:
    """UsageError unless there are n, each the index of one of n points."""
    if indices.shape != (n,):
        raise UsageError(f"{name} must have the shape ({n},), not {indices.shape}")
    wrong = np.flatnonzero((indices < 0) | (indices >= n))
    if wrong.size:
        raise UsageError(f"{name} were changed: {indices[wrong[0]]} is none of the {n} points")


def _as_queries(xi: npt.ArrayLike) -> tuple[Doubles, tuple[int, ...]]:
    """Points one after the other, and the shape in which there were as many."""
    queries = as_floats(xi, "xi")
    if queries.ndim == 0 or queries.shape[-1] != 2:
        raise UsageError(f"xi must have the shape (..., 2), not {queries.shape}")
    return np.asarray(queries, np.float64).reshape(-1, 2), queries.shape[:-1]


class Delaunay(TrianglePlots, TriangleExports):
    """The Delaunay triangulation of points in the plane, with the attributes of SciPy's.

    What `scipy.spatial.Delaunay` has and this has not: more than two dimensions, the options of
    Qhull, `furthest_site`, `incremental` with `add_points`, and the attributes that are about
    Qhull's way to work (`equations`, `paraboloid_scale`, `transform` and others). Where both give an
    answer, this one is exact.

    Parameters
    ----------
    points : array_like, shape (npoints, 2)
        Coordinates, which are copied. float64 and float32 are taken as they are; other numbers become
        float64, and must be one exactly.
    device : str, optional
        As of `triangulate`.

    Attributes
    ----------
    points : ndarray of float64 or float32, shape (npoints, 2)
        The coordinates.
    simplices : ndarray of int32, shape (nsimplex, 3)
        Three points each, counter-clockwise, the smallest index first. Fewer than three distinct
        points, and points on one line, have none; SciPy raises an exception for them.
    neighbors : ndarray of int32, shape (nsimplex, 3)
        ``neighbors[i, k]`` is the simplex opposite to corner k of simplex i, -1 beyond the hull.
    hull : ndarray of int32, shape (nhull,)
        The convex hull with the points on its edges, counter-clockwise from the lexicographically
        smallest point. Of collinear points all distinct ones, in lexicographic order.
    representatives : ndarray of int32, shape (npoints,)
        For each point the smallest index of an equal point. Only those are in `simplices`.
    npoints, nsimplex, ndim : int
        Numbers of points, of simplices and of dimensions, which are 2.

    Raises
    ------
    UsageError
        For a wrong shape, another number of dimensions than two, and what is no number. It is a
        ValueError, as SciPy raises.
    InputError
        For a point that is not finite, magnitudes too different to be exact, or too many points. It
        is a ValueError too.
    DeviceError
        If there is no such device, or a call of OpenCL failed.

    Notes
    -----
    O(n log n) work. What else the class offers is computed when it is first asked for.

    Examples
    --------
    >>> import flaunay
    >>> tri = flaunay.Delaunay([[0, 0], [0, 1.1], [1, 0], [1, 1]])
    >>> tri.simplices
    array([[0, 3, 1],
           [0, 2, 3]], dtype=int32)
    >>> tri.neighbors[0]  # opposite to its corners 0, 3 and 1
    array([-1, -1,  1], dtype=int32)
    """

    def __init__(self, points: npt.ArrayLike, device: Optional[str] = None) -> None:
        self.points: FloatArray = as_points(points).copy()
        self._device = device
        # With the process that made it.
        self._locator_or_none: Optional[tuple[_flaunay.Locator, int]] = None
        # Two threads that ask at the same time should not both make a locator.
        self._locator_lock = threading.Lock()
        mesh = triangulate(self.points, device=device)
        assert mesh.neighbors is not None
        self.simplices: Indices = mesh.triangles
        self.neighbors: Indices = mesh.neighbors
        self.hull: Indices = mesh.hull
        self.representatives: Indices = mesh.representatives

    ndim = 2

    def __repr__(self) -> str:
        return summary(
            self, points=self.npoints, triangles=self.nsimplex, hull_vertices=len(self.hull)
        )

    @property
    def npoints(self) -> int:
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        return len(self.simplices)

    @cached_property
    def min_bound(self) -> FloatArray:
        """The smallest coordinates, shape (2,); NaN if there are no points."""
        return np.min(self.points, axis=0) if self.npoints else np.full(2, np.nan)

    @cached_property
    def max_bound(self) -> FloatArray:
        """The largest coordinates, shape (2,); NaN if there are no points."""
        return np.max(self.points, axis=0) if self.npoints else np.full(2, np.nan)

    @cached_property
    def convex_hull(self) -> Indices:
        """The edges of the hull, int32, shape (nhull, 2).

        Counter-clockwise, as `hull` has their first points. Those of points on one line are none.
        """
        if self.nsimplex == 0:
            return np.empty((0, 2), np.int32)
        edges: Indices = np.stack([self.hull, np.roll(self.hull, -1)], axis=1)
        return edges

    @cached_property
    def coplanar(self) -> Indices:
        """Points that are not in the triangulation, as another has the same place; int32, shape (k, 3).

        In each row the point, a simplex that has the equal point (-1 if none has), and the equal
        point. SciPy lists these points likewise, and can list further ones, which it lost.
        """
        _check_points(self.representatives, self.npoints, "representatives")
        points = np.flatnonzero(self.representatives != np.arange(self.npoints))
        equal = self.representatives[points]
        simplices = _flaunay.first_triangles(self.simplices, self.npoints)[equal]
        rows: Indices = np.stack([points, simplices, equal], axis=1).astype(np.int32)
        return rows

    @cached_property
    def vertex_to_simplex(self) -> Indices:
        """For each point a simplex that has it, int32, shape (npoints,).

        Of several the one of the smallest index. For a point that another represents, the other's; -1
        if there are no simplices.
        """
        _check_points(self.representatives, self.npoints, "representatives")
        return _flaunay.first_triangles(self.simplices, self.npoints)[self.representatives]

    @cached_property
    def vertex_neighbor_vertices(self) -> tuple[Indices, Indices]:
        """The points to which each point has edges: `indptr` and `indices`, int32.

        Those of point k are ``indices[indptr[k]:indptr[k + 1]]``, in increasing order. A point that
        another represents has none.
        """
        return _flaunay.vertex_neighbors(self.simplices, self.hull, self.npoints)

    @property
    def _locator(self) -> _flaunay.Locator:
        found, process = self._locator_or_none or (None, 0)
        if process == os.getpid():
            return found
        with self._locator_lock:
            if self._locator_or_none is None or self._locator_or_none[1] != os.getpid():
                # A forked child must not use its parent's device, not even to release memory.
                _triangulators.keep(self._locator_or_none)
                locator = _flaunay.Locator(
                    _triangulators.of_device(self._device),
                    np.asarray(self.points, np.float64),
                    self.simplices,
                    self.neighbors,
                    self.hull,
                    self.representatives,
                )
                self._locator_or_none = locator, os.getpid()
            return self._locator_or_none[0]

    def __getstate__(self) -> dict[str, Any]:
        # What is in device memory is made again where it is needed; a lock is the object's own.
        state = {**self.__dict__, "_locator_or_none": None}
        del state["_locator_lock"]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._locator_lock = threading.Lock()

    def find_simplex(self, xi: npt.ArrayLike) -> Indices:
        """The simplices that points lie in, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Any points.

        Returns
        -------
        ndarray of int32, shape (...)
            For each the simplex that it lies in, of several the one of the smallest index; -1 outside
            of the hull.

        Raises
        ------
        UsageError
            For a wrong shape, and what is no number.
        InputError
            For a point that is not finite, which SciPy puts outside, or of a magnitude too different
            from the triangulation's.

        Notes
        -----
        About O(log n) work for each. The first query of any kind makes a tree, in O(n log n).

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.find_simplex([[1, 1], [3, 3]])
        array([ 0, -1], dtype=int32)
        """
        queries, shape = _as_queries(xi)
        return self._locator.locate(queries).reshape(shape)

    def nearest(self, xi: npt.ArrayLike) -> Indices:
        """The points of the triangulation that are nearest to others, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Any points.

        Returns
        -------
        ndarray of int32, shape (...)
            For each the index of the nearest point, of several the first in the order of x, then y;
            -1 if the triangulation has no points.

        Raises
        ------
        UsageError, InputError
            As of `find_simplex`.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.nearest([[3, 0], [100, 3]])
        array([1, 1], dtype=int32)
        """
        queries, shape = _as_queries(xi)
        return self._locator.nearest(queries).reshape(shape)

    def interpolate(self, values: npt.ArrayLike, xi: npt.ArrayLike) -> Doubles:
        """Linear interpolation in the simplices, as `scipy.interpolate.LinearNDInterpolator`.

        Parameters
        ----------
        values : array_like, shape (npoints, ...)
            What the points have. Of equal points, the one of the smallest index counts.
        xi : array_like, shape (..., 2)
            Where to interpolate.

        Returns
        -------
        ndarray of float64, shape xi.shape[:-1] + values.shape[1:]
            NaN outside of the hull; at a point exactly its value.

        Raises
        ------
        UsageError, InputError
            As of `find_simplex`, and for another number of values than of points.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.interpolate([0, 8, 4], [[1, 1], [9, 9]])
        array([ 3., nan])
        """
        queries, shape = _as_queries(xi)
        given = np.asarray(as_floats(values, "values"), np.float64)
        if given.ndim == 0 or len(given) != self.npoints:
            raise UsageError(
                f"values must have the shape ({self.npoints}, ...), not {given.shape}: one for each point"
            )
        # One call for each number that a point has.
        columns = np.ascontiguousarray(given.reshape(self.npoints, -1).T) if given.size else None
        trailing = given.shape[1:]
        result = np.empty((len(queries), int(np.prod(trailing))))
        for k in range(result.shape[1]):
            column = np.empty(0) if columns is None else columns[k]
            result[:, k] = self._locator.interpolate(column, queries)
        return result.reshape(shape + trailing)
