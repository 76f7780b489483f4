"""Queries in host memory: what `Delaunay` and `ConstrainedTriangulation` have in common."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic, Literal, Optional, TypeVar, Union, overload

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, FloatArray, are_rows, as_count, as_floats, check_out, hint_for
from flaunay._errors import InputError, UsageError

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]
_Answers = TypeVar("_Answers", Indices, Doubles)
_Made = TypeVar("_Made")

# The most values, and results, in a call that interpolates: 512 MiB of each.
_MOST_NUMBERS = 1 << 26


def as_queries(xi: ArrayLike) -> tuple[Doubles, tuple[int, ...]]:
    """Points one after the other, and the shape in which there were as many."""
    if are_rows(xi):
        return xi, xi.shape[:1]
    queries = as_floats(xi, "xi")
    if queries.ndim == 0 or queries.shape[-1] != 2:
        hint = hint_for(queries.shape, "xi")
        raise UsageError(f"xi must have the shape (..., 2), not {queries.shape}{hint}")
    return np.asarray(queries, np.float64).reshape(-1, 2), queries.shape[:-1]


def are_finite(queries: Doubles) -> npt.NDArray[np.bool_]:
    are_finite: npt.NDArray[np.bool_] = np.isfinite(queries[:, 0]) & np.isfinite(queries[:, 1])
    return are_finite


def _answers(ask: Callable[[Doubles], _Answers], queries: Doubles, nowhere: Any) -> _Answers:
    """What is asked about queries, and `nowhere` for those that are not finite.

    Those are looked for only when the library has found one, so that others need not wait for it.
    """
    try:
        return ask(queries)
    except InputError:
        finite = are_finite(queries)
        if finite.all():
            raise
    answers = ask(np.where(finite[:, None], queries, 0))
    answers[~finite] = nowhere
    return answers


def _given(answers: _Answers, shape: tuple[int, ...], out: Optional[_Answers]) -> _Answers:
    """The answers in a shape, in the caller's array if there is one."""
    if len(shape) != answers.ndim:
        answers = answers.reshape(shape)
    if out is None:
        return answers
    out[...] = answers
    return out


def count_and_bound(k: Optional[int], distance_upper_bound: Optional[float]) -> tuple[int, float]:
    """What `nearest` is asked for, checked."""
    most = math.inf if distance_upper_bound is None else distance_upper_bound
    if not most >= 0:
        raise UsageError(f"distance_upper_bound must be 0 or more, not {most}")
    return 1 if k is None else as_count(k, "k", 1), most


class Kept(Generic[_Made]):
    """What answers queries, made when the first one comes. Copies make their own, and so do other processes."""

    def __init__(self) -> None:
        # With the process that made it.
        self._made: Optional[tuple[_Made, int]] = None
        # Two threads that ask at the same time should not both make one.
        self._lock = threading.Lock()

    def get(self, make: Callable[[], _Made]) -> _Made:
        made = self._made
        if made is not None and made[1] == _triangulators.process_id:
            return made[0]
        with self._lock:
            if self._made is None or self._made[1] != _triangulators.process_id:
                # A forked child must not use its parent's device, not even to release memory.
                _triangulators.keep(self._made)
                self._made = make(), _triangulators.process_id
            return self._made[0]

    def drop(self) -> None:
        with self._lock:
            if self._made is not None and self._made[1] != _triangulators.process_id:
                _triangulators.keep(self._made)
            self._made = None

    def __reduce__(self) -> tuple[type[Kept[_Made]], tuple[()]]:
        return Kept, ()


KeptLocator = Kept[_calls.Locator]
KeptTree = Kept[_calls.PointTree]


def tree_of(points: FloatArray) -> _calls.PointTree:
    """Trees are in host memory, whatever the device."""
    return _calls.PointTree(_triangulators.of_device("host"), np.asarray(points, np.float64))


class Queries:
    """The queries of a class with these attributes."""

    if TYPE_CHECKING:

        @property
        def points(self) -> FloatArray: ...
        @property
        def hull(self) -> Indices: ...
        @property
        def npoints(self) -> int: ...
        @property
        def nsimplex(self) -> int: ...
        @property
        def _locator(self) -> _calls.Locator: ...

    def _near_hull(self, outside: Doubles, tol: float) -> Indices:
        """For points outside a simplex that they are in but for a tolerance, or -1."""
        raise NotImplementedError

    def find_simplex(
        self,
        xi: ArrayLike,
        bruteforce: bool = False,
        tol: Optional[float] = None,
        out: Optional[Indices] = None,
    ) -> Indices:
        """The simplices that points lie in, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Any points.
        bruteforce : bool
            Changes nothing: SciPy's other search finds nothing else here.
        tol : float, optional
            By how much the barycentric coordinates of a point outside of the hull may be negative in a
            simplex at the hull. Without it nothing: `find_simplex` is exact, where SciPy has ``100 * eps``.
        out : ndarray of int32, shape (...), optional
            Where to write the result, by a copy.

        Returns
        -------
        ndarray of int32, shape (...)
            For each the simplex that it lies in, of several the one of the smallest index; -1 outside
            of the hull, where NaN and infinite points are too.

        Raises
        ------
        UsageError
            For a wrong shape, what is no number, and a tolerance that is negative or NaN.
        InputError
            For a point of a magnitude too different from the triangulation's.

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
        if tol is None and out is None and are_rows(xi):
            # The usual call. If queries come one by one, each step counts.
            return _answers(self._locator.locate, xi, -1)
        if tol is not None and not tol >= 0:
            raise UsageError(f"tol must be 0 or more, not {tol}")
        queries, shape = as_queries(xi)
        if out is not None:
            check_out(out, np.int32, shape, "out")
        found = _answers(self._locator.locate, queries, -1)
        if tol and self.nsimplex:
            outside = np.flatnonzero((found < 0) & are_finite(queries))
            found[outside] = self._near_hull(queries[outside], tol)
        return _given(found, shape, out)

    @cached_property
    def _kept_tree(self) -> KeptTree:
        return KeptTree()

    @cached_property
    def _there(self) -> npt.NDArray[np.intp]:
        """The points that were not removed."""
        return np.flatnonzero(~np.isnan(self.points[:, 0]))

    def _make_tree(self) -> _calls.PointTree:
        return tree_of(self.points[self._there])

    @overload
    def nearest(
        self,
        xi: ArrayLike,
        out: Optional[Indices] = None,
        *,
        k: Optional[int] = None,
        distance_upper_bound: Optional[float] = None,
        return_distances: Literal[False] = False,
    ) -> Indices: ...
    @overload
    def nearest(
        self,
        xi: ArrayLike,
        out: Optional[Indices] = None,
        *,
        k: Optional[int] = None,
        distance_upper_bound: Optional[float] = None,
        return_distances: Literal[True],
    ) -> tuple[Doubles, Indices]: ...
    def nearest(
        self,
        xi: ArrayLike,
        out: Optional[Indices] = None,
        *,
        k: Optional[int] = None,
        distance_upper_bound: Optional[float] = None,
        return_distances: bool = False,
    ) -> Union[Indices, tuple[Doubles, Indices]]:
        """The points of the triangulation that are nearest to others, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Any points.
        out : ndarray of int32, shape (...) or (..., k), optional
            Where to write the indices, by a copy.
        k : int, optional
            How many points. With it, results have a further dimension, the nearest point first.
        distance_upper_bound : float, optional
            Points that are farther away, by the rounded distance, are left out.
        return_distances : bool
            Return distances and indices, in the order of `scipy.spatial.cKDTree.query`.

        Returns
        -------
        distances : ndarray of float64, shape (...) or (..., k)
            Only with `return_distances`. Infinity where there is no point.
        indices : ndarray of int32, shape (...) or (..., k)
            Of points that are as near, the first in the order of x, then y, then index is first. -1 where
            there are no more points, and for NaN and infinite points, to which none is nearest.

        Raises
        ------
        UsageError, InputError
            As of `find_simplex`, for another k than 1 or more, and a bound that is negative or NaN.

        Notes
        -----
        What is optional is found by a tree of the points, made when it is first asked for. Equal points all
        count there.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.nearest([[3, 0], [100, 3]])
        array([1, 1], dtype=int32)
        >>> tri.nearest([1, 0], k=2, return_distances=True)
        (array([1., 3.]), array([0, 1], dtype=int32))
        """
        queries, shape = as_queries(xi)
        is_alone = k is None
        count, most = count_and_bound(k, distance_upper_bound)
        if not is_alone:
            shape = (*shape, count)
        if out is not None:
            check_out(out, np.int32, shape, "out")
        distances = np.empty(0)
        if is_alone and most == math.inf and not return_distances:
            if len(self.hull):
                found = _answers(self._locator.nearest, queries, -1)
            else:
                found = np.full(len(queries), -1, np.int32)
            return _given(found, shape, out)

        def ask(queries: Doubles) -> Indices:
            nonlocal distances
            tree = self._kept_tree.get(self._make_tree)
            points, distances = tree.nearest(queries, count, most)
            return points

        found = _answers(ask, queries, -1)
        distances[found < 0] = math.inf
        if len(self._there) < len(self.points):
            found[found >= 0] = self._there[found[found >= 0]]
        found = _given(found.reshape(shape), shape, out)
        return (distances.reshape(shape), found) if return_distances else found

    def interpolate(
        self, values: ArrayLike, xi: ArrayLike, out: Optional[Doubles] = None
    ) -> Doubles:
        """Linear interpolation in the simplices, as `scipy.interpolate.LinearNDInterpolator`.

        Parameters
        ----------
        values : array_like, shape (npoints, ...)
            What the points have. Of equal points, the one of the smallest index counts.
        xi : array_like, shape (..., 2)
            Where to interpolate.
        out : ndarray of float64, shape xi.shape[:-1] + values.shape[1:], optional
            Where to write the result, by a copy.

        Returns
        -------
        ndarray of float64, shape xi.shape[:-1] + values.shape[1:]
            NaN outside of the hull and for NaN and infinite points; at a point exactly its value.

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
        queries, shape = as_queries(xi)
        given = np.asarray(as_floats(values, "values"), np.float64)
        if given.ndim == 0 or len(given) != self.npoints:
            raise UsageError(
                f"values must have the shape ({self.npoints}, ...), not {given.shape}: one for each point"
            )
        trailing = given.shape[1:]
        if out is not None:
            check_out(out, np.float64, shape + trailing, "out")
        rows = given.reshape(self.npoints, math.prod(trailing))
        result = np.empty((len(queries), rows.shape[1]))
        # Each call locates the queries, so that it takes all columns for which a device may have memory.
        step = max(1, _MOST_NUMBERS // max(1, len(queries), len(rows)))
        for k in range(0, rows.shape[1], step):
            ask = _calls.Interpolation(rows[:, k : k + step], "linear", np.nan).of(self._locator)
            result[:, k : k + step] = _answers(ask, queries, np.nan)
        return _given(result.reshape(shape + trailing), shape + trailing, out)
