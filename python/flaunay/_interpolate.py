"""Interpolation of values between points, with the calls of SciPy's interpolators."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Literal, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

from flaunay._arrays import (
    Fixed,
    FloatArray,
    are_rows,
    as_any,
    as_distance,
    as_floats,
    as_iterations,
    check_memory,
    check_points_shape,
    frozen,
    hint_for,
    is_masked,
    summary,
)
from flaunay._calls import Interpolation
from flaunay._constrained import ConstrainedTriangulation
from flaunay._delaunay import Delaunay
from flaunay._errors import InputError, UsageError
from flaunay._optional import optional
from flaunay._queries import KeptTree, are_finite, tree_of

if TYPE_CHECKING:
    import scipy.sparse

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]
Points = Union[npt.ArrayLike, Delaunay, ConstrainedTriangulation]
_Answers = TypeVar("_Answers", Indices, Doubles)

# Each iteration multiplies the error of gradients by this.
_RATE = 2 - 3**0.5

# The methods of natural neighbours.
_WEIGHTS = ("sibson", "laplace")


def _as_coordinates(given: Any, name: str, may_be_flat: bool = False) -> Doubles:
    """Points of shape (..., 2), from such an array or a tuple of two that broadcast.

    may_be_flat: whether x and y may follow each other in one dimension, as SciPy has it for queries.
    """
    if isinstance(given, tuple):
        if len(given) != 2:
            raise UsageError(f"{name} must be coordinates x and y, not {len(given)} arrays")
        parts = [np.asarray(as_floats(part, name), np.float64) for part in given]
        try:
            return np.stack(np.broadcast_arrays(*parts), axis=-1)
        except ValueError as error:
            raise UsageError(f"{name}: {error}") from error
    points = np.asarray(as_floats(given, name), np.float64)
    if may_be_flat and points.ndim == 1 and points.size % 2 == 0:
        points = points.reshape(-1, 2)
    if points.ndim == 0 or points.shape[-1] != 2:
        hint = hint_for(points.shape, name)
        raise UsageError(f"{name} must have the shape (..., 2), not {points.shape}{hint}")
    return points


def _as_fill(given: Any) -> complex:
    """The number outside of the hull, complex if it is given so."""
    try:
        if is_masked(given):
            raise TypeError("it is masked")
        number = complex(given)
    except (TypeError, ValueError) as error:
        raise UsageError(f"fill_value must be a number, not {given!r}") from error
    return number if np.iscomplexobj(given) else number.real


def _check_fill(fill: complex, values: npt.NDArray[Any]) -> None:
    if isinstance(fill, complex) and values.dtype.kind != "c":
        raise UsageError("fill_value is complex, but values are real")


class _Scale:
    """Brings points to the unit square, where one is asked for."""

    def __init__(self, points: Doubles, is_wanted: bool) -> None:
        self._offset: Any = 0.0
        self._size: Any = 1.0
        # Points that are not finite are left as they are, so that the triangulation names them.
        self.is_wanted = is_wanted and len(points) > 0 and bool(np.isfinite(points).all())
        if self.is_wanted:
            with np.errstate(over="ignore"):
                self._offset = np.mean(points, axis=0)
                size = np.ptp(points, axis=0)
            if not np.isfinite([self._offset, size]).all():
                raise InputError(
                    "points are too large to be rescaled: their extent or sum overflows"
                )
            self._size = np.where(size > 0, size, 1.0)

    def __call__(self, points: Doubles) -> Doubles:
        if not self.is_wanted:
            return points
        scaled: Doubles = (points - self._offset) / self._size
        return scaled


@dataclass(frozen=True)
class _Beyond:
    """Where there are values beyond the border, and where inside there are none."""

    tol: Optional[float] = None
    extrapolate: Optional[str] = None
    max_edge: Optional[float] = None
    max_distance: Optional[float] = None
    is_usual: bool = field(init=False)

    def __post_init__(self) -> None:
        for name in ("tol", "max_edge", "max_distance"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, as_distance(getattr(self, name), name))
        if self.extrapolate not in (None, "nearest", "linear"):
            raise UsageError(
                f"extrapolate must be 'nearest', 'linear' or None, not {self.extrapolate!r}"
            )
        usual = (self.tol, self.extrapolate, self.max_edge, self.max_distance) == (None,) * 4
        object.__setattr__(self, "is_usual", usual)


class _Interpolator(Fixed):
    """Values at points, and a triangulation of these."""

    def __call__(self, *xi: Any) -> npt.NDArray[Any]:
        raise NotImplementedError

    # The values, and what is computed from them. It is replaced as a whole: another thread may be reading it.
    _data: tuple[npt.NDArray[Any], Optional[Interpolation]]

    def __init__(self, points: Points, rescale: bool, device: Optional[str]) -> None:
        self._device = device
        if isinstance(points, (Delaunay, ConstrainedTriangulation)):
            if rescale:
                raise UsageError("rescale needs points, not their triangulation")
            self.__dict__["tri"] = points
            self._scale = _Scale(np.empty((0, 2)), False)
            self.points = points.points
            return
        if hasattr(points, "simplices"):
            raise UsageError(
                "points must be an array or a flaunay.Delaunay, not another triangulation"
            )
        coordinates = (
            _as_coordinates(points, "points")
            if isinstance(points, tuple)
            else np.asarray(as_floats(points, "points"), np.float64)
        )
        if coordinates.ndim == 1 or coordinates.ndim == 2 and coordinates.shape[1] == 1:
            raise UsageError(
                f"points must have the shape (n, 2), not {coordinates.shape}: numpy.interp and SciPy "
                "interpolate on a line; if x and y are two arrays, take the tuple (x, y)"
            )
        check_points_shape(coordinates)
        self._scale = _Scale(coordinates, rescale)
        self.points = self._keep(self._scale(coordinates))

    def _keep(self, points: Doubles) -> FloatArray:
        """Makes what answers queries, and returns what it has for points."""
        self.__dict__["tri"] = tri = Delaunay(points, device=self._device)
        return tri.points

    @cached_property
    def tri(self) -> Union[Delaunay, ConstrainedTriangulation]:
        """The triangulation, of the rescaled points if they are rescaled."""
        return Delaunay(self.points, device=self._device)

    @property
    def _point_count(self) -> int:
        tri = self.__dict__.get("tri")
        return len(self.points) if tri is None else tri.npoints

    def __repr__(self) -> str:
        columns = math.prod(self.values.shape[1:])
        return summary(self, points=self._point_count, values_per_point=columns)

    def _are_far(self, queries: Doubles, nearest: Indices, most: float) -> npt.NDArray[np.bool_]:
        """Which queries are farther than that from their nearest points."""
        away = self.points[nearest] - queries
        far: npt.NDArray[np.bool_] = np.hypot(away[:, 0], away[:, 1]) > most
        return far

    @property
    def values(self) -> npt.NDArray[Any]:
        """What the points have, read-only. Other values of as many points can be assigned."""
        return self._data[0]

    @values.setter
    def values(self, values: npt.ArrayLike) -> None:
        check_memory(values, "values")
        # A copy, as the caller may go on writing to an array of its own.
        array = frozen(np.array(self._as_values(values), order="C"))
        if array.ndim == 0 or len(array) != self._point_count:
            raise UsageError(
                f"values must have the shape ({self._point_count}, ...), not {array.shape}: "
                "one row for each point"
            )
        self._data = array, self._prepared(array)

    def _prepared(self, values: npt.NDArray[Any]) -> Optional[Interpolation]:
        """What is computed from values, once for all calls."""
        return None

    def _as_values(self, values: npt.ArrayLike) -> npt.NDArray[Any]:
        array = as_any(values, "values")
        if array.dtype.kind == "c":
            return array.astype(np.complex128)
        return np.asarray(as_floats(values, "values"), np.float64)

    def _queries(self, given: tuple[Any, ...]) -> tuple[Doubles, tuple[int, ...]]:
        """The queries in rows, in the scale of the points, and the shape in which they came."""
        if not given:
            raise UsageError("xi is missing: where to interpolate")
        if len(given) == 1 and not self._scale.is_wanted and are_rows(given[0]):
            return given[0], given[0].shape[:1]
        queries = _as_coordinates(given[0] if len(given) == 1 else given, "xi", may_be_flat=True)
        return self._scale(queries.reshape(-1, 2)), queries.shape[:-1]

    def _asked(
        self, ask: Callable[[Doubles], _Answers], queries: Doubles
    ) -> tuple[_Answers, Doubles, Optional[npt.NDArray[np.bool_]]]:
        """The answers, to which queries, and which of these stand for others that are not finite.

        Those are looked for only when the library has found one, so that others need not wait for it.
        """
        try:
            return ask(queries), queries, None
        except InputError:
            are_bad = ~are_finite(queries)
            if not are_bad.any():
                raise
        queries = queries.copy()
        queries[are_bad] = self.points[0] if len(self.points) else 0.0
        return ask(queries), queries, are_bad


class _Columns(_Interpolator):
    """Interpolation of numbers, all that a point has in one call."""

    _method: str

    def __init__(
        self,
        points: Points,
        values: npt.ArrayLike,
        fill_value: complex,
        rescale: bool,
        device: Optional[str],
        beyond: _Beyond,
    ) -> None:
        super().__init__(points, rescale, device)
        self._beyond = beyond
        self._fill = _as_fill(fill_value)
        self.values = values

    @property
    def fill_value(self) -> complex:
        """The result outside of the hull. Another one can be assigned."""
        return self._fill

    @fill_value.setter
    def fill_value(self, given: complex) -> None:
        fill = _as_fill(given)
        values, table = self._data
        _check_fill(fill, values)
        assert table is not None
        self._data, self._fill = (values, table.with_fill(self._real_fill(fill, values))), fill

    @staticmethod
    def _real_fill(fill: complex, values: npt.NDArray[Any]) -> float:
        """What rows of numbers have outside; complex ones say that they are outside."""
        return np.nan if values.dtype.kind == "c" else fill.real

    def _prepared(self, values: npt.NDArray[Any]) -> Interpolation:
        """The numbers of each point in a row, and their gradients."""
        _check_fill(self._fill, values)
        n = self.tri.npoints
        rows = values.reshape(n, -1) if values.size else np.empty((n, 0))
        if rows.dtype.kind == "c":
            # A further column is 0, but outside of the hull.
            rows = np.concatenate([rows.real, rows.imag, np.zeros((n, 1))], axis=1)
        rows = np.ascontiguousarray(rows)
        fill = self._real_fill(self._fill, values)
        return Interpolation(rows, self._method, fill, self._gradients(values, rows))

    def _gradients(self, values: npt.NDArray[Any], rows: Doubles) -> Optional[Doubles]:
        return None

    def __call__(self, *xi: Any) -> npt.NDArray[Any]:
        """The values at `xi`: an array of shape (..., 2), or x and y, which broadcast."""
        queries, shape = self._queries(xi)
        (values, table), fill_value = self._data, self._fill
        assert table is not None
        shape += values.shape[1:]
        columns = table.columns
        if columns == 0 or len(queries) == 0:
            return np.full(shape, fill_value, values.dtype)
        rows, queries, are_bad = self._asked(table.of(self.tri._locator), queries)
        if not self._beyond.is_usual:
            self._go_beyond(queries, rows, table)
        if are_bad is not None:
            rows[are_bad] = table.options.fill
        if values.dtype.kind != "c":
            return rows.reshape(shape)
        k = columns // 2
        result = np.empty((len(rows), k), np.complex128)
        result.real, result.imag = rows[:, :k], rows[:, k : 2 * k]
        result[np.isnan(rows[:, -1])] = fill_value
        return result.reshape(shape)


    def _go_beyond(self, queries: Doubles, rows: Doubles, table: Interpolation) -> None:
        """Changes the rows of queries outside, and of those that shall have no value."""
        tri, beyond = self.tri, self._beyond
        numbers, gradients, fill = table.values, table.gradients, table.options.fill
        found = tri._locator.locate(queries)
        outside = np.flatnonzero(found < 0)
        if not tri.nsimplex and getattr(self, "_are_estimated", True):
            gradients = None  # on one line there are none
        is_extended = beyond.tol is not None or beyond.extrapolate is not None
        if len(outside) and is_extended and len(tri._border.firsts):
            border = tri._border
            at = None if tri.nsimplex else tri._locator.nearest(queries[outside])
            edges, parts, distances = border.nearest(queries[outside], at)
            if beyond.extrapolate is None and beyond.tol is not None:
                near = distances <= beyond.tol
                outside, edges, parts = outside[near], edges[near], parts[near]
            ends = border.firsts[edges], border.seconds[edges]
            found[outside] = border.triangles[edges]
            places, values = self._along_border(ends, parts, numbers, gradients)
            if beyond.extrapolate == "linear":
                slopes = self._slopes(ends, parts, found[outside], numbers, gradients)
                steps = queries[outside] - places
                values += (slopes * steps[:, None]).sum(axis=-1)
            rows[outside] = values
        if beyond.max_edge is not None and (tri.nsimplex or len(tri._border.firsts)):
            # On one line, edges are in the place of triangles.
            shapes = tri.simplices if tri.nsimplex else tri._border.edges
            corners = np.asarray(self.points, np.float64)[shapes[found]]
            sides = np.roll(corners, -1, axis=1) - corners
            longest = np.hypot(sides[..., 0], sides[..., 1]).max(axis=1)
            rows[(found >= 0) & (longest > beyond.max_edge)] = fill
        if beyond.max_distance is not None and tri.npoints:
            nearest = tri._locator.nearest(queries)
            rows[self._are_far(queries, nearest, beyond.max_distance)] = fill

    def _along_border(
        self,
        ends: tuple[Any, Any],
        parts: Doubles,
        numbers: Doubles,
        gradients: Optional[Doubles],
    ) -> tuple[Doubles, Doubles]:
        """Places on edges of the border, and the values there."""
        points = np.asarray(self.points, np.float64)
        begin, end = (points[vertices] for vertices in ends)
        along = end - begin
        part = parts[:, None]
        low, high = (numbers[vertices] for vertices in ends)
        values = (1 - part) * low + part * high
        if gradients is not None:
            # The cubic with the slopes at both ends.
            at_low, at_high = ((gradients[v] * along[:, None]).sum(axis=-1) for v in ends)
            rise = high - low
            values += (
                part * (1 - part) * ((1 - part) * (at_low - rise) - part * (at_high - rise))
            )
        return begin + part * along, values

    def _slopes(
        self,
        ends: tuple[Any, Any],
        parts: Doubles,
        triangles: Indices,
        numbers: Doubles,
        gradients: Optional[Doubles],
    ) -> Doubles:
        """Gradients at places on the border: of the planes of triangles, or between those of the ends."""
        if gradients is not None:
            part = parts[:, None, None]
            between: Doubles = (1 - part) * gradients[ends[0]] + part * gradients[ends[1]]
            return between
        if not self.tri.nsimplex:
            begin, end = (np.asarray(self.points, np.float64)[vertices] for vertices in ends)
            along = end - begin
            with np.errstate(invalid="ignore"):
                steps = np.nan_to_num(along / (along * along).sum(axis=1, keepdims=True))
            along_line: Doubles = (numbers[ends[1]] - numbers[ends[0]])[:, :, None] * steps[:, None]
            return along_line
        corners = self.tri.simplices[triangles]
        points = np.asarray(self.points, np.float64)[corners]
        first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
        area = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[:, None]
        rise = numbers[corners[:, 1]] - numbers[corners[:, 0]]
        other = numbers[corners[:, 2]] - numbers[corners[:, 0]]
        x = (rise * second[:, 1:] - other * first[:, 1:]) / area
        y = (other * first[:, :1] - rise * second[:, :1]) / area
        return np.stack([x, y], axis=-1)


def _as_rows(
    sparse: Any, weights: Doubles, points: Indices, starts: npt.NDArray[np.int64], count: int
) -> scipy.sparse.csr_array:
    """A matrix with a column per point, in whose rows points are in order."""
    matrix: scipy.sparse.csr_array = sparse.csr_array(
        (weights, points, starts), shape=(len(starts) - 1, count), copy=True
    )
    matrix.sum_duplicates()
    return matrix


class LinearInterpolator(_Columns):
    """Linear interpolation in the triangles, as `scipy.interpolate.LinearNDInterpolator`.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), Delaunay, or ConstrainedTriangulation
        Where values are known, or the triangulation of these points. A tuple of x and y is taken too. With
        constraints, see the notes of `ConstrainedTriangulation`.
    values : array_like, shape (npoints, ...)
        What the points have, real or complex. Of equal points, the one of the smallest index counts.
    fill_value : float or complex, optional
        The result outside of the hull.
    rescale : bool, optional
        Bring the points to the unit square before. This helps if x and y have different units.
    device : str, optional
        As of `triangulate`.
    tol : float, optional
        Queries outside that are at most so far from the border have the value of the nearest place on it. Points
        whose hull is a rotated rectangle often have half of the queries on its sides outside, by rounding.
    extrapolate : {"nearest", "linear"}, optional
        What all other queries outside have: the value of the nearest place on the border, or from there on along
        the plane of the triangle at it. (`CloughTocherInterpolator` has gradients for that.)
    max_edge : float, optional
        There is no value in triangles with a longer edge, such as those across bays and gaps.
    max_distance : float, optional
        There is no value farther than this from the nearest point. All these lengths are those of the rescaled
        points if they are rescaled.

    Attributes
    ----------
    tri : Delaunay
        The triangulation, of the rescaled points if they are rescaled.
    values : ndarray, shape (npoints, ...)
        What the points have. The array is read-only; others can be assigned, of any shape (npoints, ...).
    fill_value : float or complex
        The result outside of the hull; another one can be assigned.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`, and for another number of values than of points.

    Notes
    -----
    Queries are located exactly, and at a point the result is exactly its value. A query that is not
    finite is outside. Points on one line have no triangles, so that all queries are outside, and the border is
    the line between them: with `tol` or `extrapolate`, its values are linear from each point to the next. SciPy
    raises an exception for them.

    Examples
    --------
    >>> import flaunay
    >>> interpolate = flaunay.LinearInterpolator([[0, 0], [4, 0], [0, 4]], [0, 8, 4])
    >>> interpolate([[1, 1], [9, 9]])
    array([ 3., nan])
    >>> interpolate(1, [0, 2])
    array([2., 4.])
    """

    _method = "linear"

    def __init__(
        self,
        points: Points,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        rescale: bool = False,
        *,
        device: Optional[str] = None,
        tol: Optional[float] = None,
        extrapolate: Optional[Literal["nearest", "linear"]] = None,
        max_edge: Optional[float] = None,
        max_distance: Optional[float] = None,
    ) -> None:
        beyond = _Beyond(tol, extrapolate, max_edge, max_distance)
        super().__init__(points, values, fill_value, rescale, device, beyond)

    def barycentric(self, *xi: Any) -> tuple[Indices, Doubles]:
        """The triangles of queries and their barycentric coordinates there.

        Parameters
        ----------
        *xi
            As of a call.

        Returns
        -------
        triangles : ndarray of int32, shape (...)
            Of `tri`, -1 outside.
        coordinates : ndarray of float64, shape (..., 3)
            Of the triangle's corners in their order: 0 or more, with the sum 1. At a point exactly 1, 0 and 0; NaN
            outside.
        """
        queries, shape = self._queries(xi)
        found, queries, are_bad = self._asked(self.tri._locator.locate, queries)
        if are_bad is not None:
            found[are_bad] = -1
        areas = np.full((len(queries), 3), np.nan)
        inside = np.flatnonzero(found >= 0)
        corners = np.asarray(self.points, np.float64)[self.tri.simplices[found[inside]]]
        # Scaled, so that areas neither overflow nor vanish.
        away = corners - queries[inside, None]
        size = np.abs(away).max(axis=(1, 2), keepdims=True, initial=0.0)
        away /= np.where(size > 0, size, 1.0)
        after, before = np.roll(away, -1, axis=1), np.roll(away, -2, axis=1)
        across = after[..., 0] * before[..., 1] - after[..., 1] * before[..., 0]
        areas[inside] = np.maximum(across, 0.0)
        # All vanish by rounding in very slender triangles only: there, the nearest corner.
        totals = areas.sum(axis=1, keepdims=True)
        flat = np.flatnonzero(totals[:, 0] == 0)
        if len(flat):
            distances = np.hypot(*np.moveaxis(away[np.searchsorted(inside, flat)], -1, 0))
            areas[flat] = np.arange(3) == distances.argmin(axis=1)[:, None]
            totals[flat] = 1.0
        coordinates: Doubles = areas / totals
        return found.reshape(shape), coordinates.reshape(*shape, 3)

    def weights(self, *xi: Any) -> scipy.sparse.csr_array:
        """What each point counts for at each query, so that ``weights(xi) @ values`` interpolates any values.

        Parameters
        ----------
        *xi
            As of a call. Queries are counted in their order.

        Returns
        -------
        scipy.sparse.csr_array, shape (queries, npoints)
            Up to three weights in a row, with the sum 1. Rows of queries outside are empty, and give 0.

        Raises
        ------
        ImportError
            Without SciPy.

        Examples
        --------
        >>> import flaunay
        >>> interpolate = flaunay.LinearInterpolator([[0, 0], [4, 0], [0, 4]], [0, 8, 4])
        >>> interpolate.weights([[1, 1], [9, 9]]).toarray()
        array([[0.5 , 0.25, 0.25],
               [0.  , 0.  , 0.  ]])
        """
        sparse = optional("scipy.sparse", "LinearInterpolator.weights")
        found, coordinates = self.barycentric(*xi)
        triangles, rows = found.ravel(), coordinates.reshape(-1, 3)
        counted = rows > 0
        columns = np.zeros((len(rows), 3), np.int32)
        columns[triangles >= 0] = self.tri.simplices[triangles[triangles >= 0]]
        starts = np.concatenate([[0], np.cumsum(counted.sum(axis=1))])
        return _as_rows(sparse, rows[counted], columns[counted], starts, self.tri.npoints)


class CloughTocherInterpolator(_Columns):
    """Smooth interpolation by cubics, as `scipy.interpolate.CloughTocher2DInterpolator`.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay
        As of `LinearInterpolator`.
    values : array_like, shape (npoints, ...)
        As of `LinearInterpolator`.
    fill_value : float or complex, optional
        The result outside of the hull.
    tol : float, optional
        The error of the gradients that are estimated, relative to all of them.
    maxiter : int, optional
        The iterations that may be made for that; 14 reach the default tolerance.
    rescale : bool, optional
        As of `LinearInterpolator`.
    gradients : array_like, shape (npoints, ..., 2), optional
        The gradients of the values at the points, of the rescaled ones if they are rescaled; None:
        they are estimated, so that the interpolant has the least curvature along the edges.
    device : str, optional
        As of `triangulate`.
    border_tol : float, optional
        The `tol` of `LinearInterpolator`.
    extrapolate, max_edge, max_distance
        As of `LinearInterpolator`.

    Attributes
    ----------
    tri : Delaunay
        The triangulation, of the rescaled points if they are rescaled.
    values, fill_value
        As of `LinearInterpolator`. For values that are assigned, gradients are estimated; if they were
        given, no others can be assigned.
    grad : ndarray, shape (npoints, ..., 2)
        The gradients, NaN at points that another one represents and on one line.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`, and for another number of values or gradients than of points.

    Notes
    -----
    The result has a continuous gradient. It is SciPy's up to rounding for the same triangulation and
    gradients; estimated gradients differ by less than the tolerance. Otherwise as `LinearInterpolator`.

    The tolerance of gradients is relative to the largest of all. If x and y have units so different that
    gradients in one of them are far smaller, `rescale` makes these as good.

    Examples
    --------
    >>> import flaunay
    >>> points = [[0, 0], [4, 0], [0, 4], [4, 5]]
    >>> interpolate = flaunay.CloughTocherInterpolator(points, [0, 8, 4, 13])
    >>> interpolate([[1, 1], [9, 9]]).round(4)
    array([ 3., nan])
    """

    _method = "clough_tocher"

    def __init__(
        self,
        points: Points,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        tol: float = 1e-6,
        maxiter: int = 400,
        rescale: bool = False,
        gradients: Optional[npt.ArrayLike] = None,
        *,
        device: Optional[str] = None,
        border_tol: Optional[float] = None,
        extrapolate: Optional[Literal["nearest", "linear"]] = None,
        max_edge: Optional[float] = None,
        max_distance: Optional[float] = None,
    ) -> None:
        maxiter = as_iterations(maxiter, tol)
        if gradients is None:
            if 2 * _RATE**maxiter > tol:
                warnings.warn(
                    f"{maxiter} iterations do not reach the tolerance of gradients, {tol}",
                    stacklevel=2,
                )
        self._tolerance, self._iterations = tol, maxiter
        self._are_estimated, self._given = gradients is None, gradients
        beyond = _Beyond(border_tol, extrapolate, max_edge, max_distance)
        super().__init__(points, values, fill_value, rescale, device, beyond)
        self._given = None

    def _gradients(self, values: npt.NDArray[Any], rows: Doubles) -> Doubles:
        if not self._are_estimated:
            return self._given_for(values)
        if rows.size == 0:
            return np.empty((*rows.shape, 2))
        return self.tri._locator.gradients(rows, self._tolerance, self._iterations)

    def _given_for(self, values: npt.NDArray[Any]) -> Doubles:
        gradients = self._given
        if gradients is None:
            raise UsageError(
                "gradients were given for other values: make another CloughTocherInterpolator"
            )
        wanted = (*values.shape, 2)
        check_memory(gradients, "gradients")
        given = self._as_values(gradients)
        if given.shape != wanted:
            raise UsageError(f"gradients must have the shape {wanted}, not {given.shape}")
        if given.dtype.kind == "c" and values.dtype.kind != "c":
            raise UsageError("gradients are complex, but values are real")
        n = self.tri.npoints
        rows = given.reshape(n, -1, 2) if given.size else np.empty((n, 0, 2))
        if values.dtype.kind != "c" or values.size == 0:
            return np.array(rows, order="C")
        return np.concatenate([rows.real, rows.imag, np.zeros((n, 1, 2))], axis=1)

    @property
    def grad(self) -> npt.NDArray[Any]:
        values, table = self._data
        assert table is not None and table.gradients is not None
        rows, gradients = table.values, table.gradients
        shape = (*values.shape, 2)
        if values.dtype.kind != "c" or values.size == 0:
            return np.asarray(gradients.reshape(shape).astype(values.dtype))
        k = rows.shape[1] // 2
        slopes: npt.NDArray[Any] = gradients[:, :k] + 1j * gradients[:, k : 2 * k]
        return slopes.reshape(shape)


class NearestInterpolator(_Interpolator):
    """The values of the nearest point, as `scipy.interpolate.NearestNDInterpolator`.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay
        As of `LinearInterpolator`.
    values : array_like, shape (npoints, ...)
        What the points have, of any type.
    rescale : bool, optional
        As of `LinearInterpolator`.
    device : str, optional
        As of `triangulate`.
    max_distance : float, optional
        There is no value farther than this from the nearest point: NaN, as for queries that are not finite.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`; for another number of values than of points, or none; and for a query that
        is not finite, if values are no numbers: otherwise its result is NaN.

    Notes
    -----
    The nearest point is found by exact comparisons; of several, it is the first in the order of x, then
    y. Results are the values as they were given, integers too; but floats and booleans become float64, as in SciPy,
    and so do integers if a result is NaN.

    Examples
    --------
    >>> import flaunay
    >>> interpolate = flaunay.NearestInterpolator([[0, 0], [4, 0], [0, 4]], [0, 8, 4])
    >>> interpolate([[1, 1], [9, 8]])
    array([0, 8])
    """

    # None if the triangulation answers queries.
    _kept_tree: Optional[KeptTree] = None

    def __init__(
        self,
        points: Points,
        values: npt.ArrayLike,
        rescale: bool = False,
        *,
        device: Optional[str] = None,
        max_distance: Optional[float] = None,
    ) -> None:
        self._max_distance = None if max_distance is None else as_distance(max_distance, "max_distance")
        super().__init__(points, rescale, device)
        self.values = values
        if self._point_count == 0:
            raise UsageError("there are no points, so none is nearest")

    def _keep(self, points: Doubles) -> FloatArray:
        if self._device not in (None, "host"):
            return super()._keep(points)
        # Nothing else needs a triangulation.
        self._kept_tree = KeptTree()
        kept = frozen(points.copy())
        self._kept_tree.get(partial(tree_of, kept))
        return kept

    def _nearest(self, queries: Doubles) -> Indices:
        if self._kept_tree is None:
            return self.tri._locator.nearest(queries)
        points, _ = self._kept_tree.get(partial(tree_of, self.points)).nearest(queries, 1, math.inf)
        return points[:, 0]

    def _as_values(self, values: npt.ArrayLike) -> npt.NDArray[Any]:
        array = as_any(values, "values")
        return array.astype(np.float64, copy=False) if array.dtype.kind in "bf" else array

    def __call__(
        self, *xi: Any, distance_upper_bound: Optional[float] = None, workers: Optional[int] = None
    ) -> npt.NDArray[Any]:
        """The values at `xi`: an array of shape (..., 2), or x and y, which broadcast.

        distance_upper_bound: as in SciPy, in place of `max_distance` for this call. workers: SciPy's, and ignored.
        """
        most = self._max_distance
        if distance_upper_bound is not None:
            most = as_distance(distance_upper_bound, "distance_upper_bound")
        queries, shape = self._queries(xi)
        values = self.values
        nearest, queries, are_bad = self._asked(self._nearest, queries)
        result: npt.NDArray[Any] = values[nearest]
        if most is not None:
            far = self._are_far(queries, nearest, most)
            if far.any():
                are_bad = far if are_bad is None else far | are_bad
        if are_bad is not None:
            if result.dtype.kind in "iu":
                result = result.astype(np.float64)
            if result.dtype.kind not in "fc":
                raise UsageError(
                    f"xi are not finite or too far away, and values of {result.dtype} have no NaN"
                )
            result[are_bad] = np.nan
        return result.reshape(shape + values.shape[1:])


class NearestNDInterpolator(NearestInterpolator):
    """`NearestInterpolator` with the arguments of `scipy.interpolate.NearestNDInterpolator`.

    Parameters
    ----------
    x : array_like, shape (npoints, 2), or Delaunay
        The points.
    y : array_like, shape (npoints, ...)
        What the points have, of any type.
    rescale : bool, optional
        As of `LinearInterpolator`.
    tree_options : dict, optional
        Only None and an empty one are possible: SciPy's tree is not used.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `NearestInterpolator`, and for other options.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.NearestNDInterpolator(x=[[0, 0], [4, 0], [0, 4]], y=[0, 8, 4])(3, 1)
    array(8)
    """

    def __init__(
        self,
        x: Points,
        y: npt.ArrayLike,
        rescale: bool = False,
        tree_options: Optional[dict[str, Any]] = None,
    ) -> None:
        if tree_options:
            raise UsageError(
                "tree_options are for SciPy's tree, which flaunay does not use: leave them out"
            )
        super().__init__(x, y, rescale)


# By the names that SciPy has for them, whose arguments they take.
LinearNDInterpolator = LinearInterpolator
CloughTocher2DInterpolator = CloughTocherInterpolator


class NaturalNeighborInterpolator(_Columns):
    """Interpolation between natural neighbours, by the weights of Sibson or of Laplace.

    If a query were a point, its Voronoi cell would take a piece from the cell of each of its natural
    neighbours. By Sibson (1981), the weight of a neighbour is the area of that piece. By Laplace's
    weights (Belikov et al., 1997), it is the length of the edge between both cells over the distance of
    both points.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay
        As of `LinearInterpolator`.
    values : array_like, shape (npoints, ...)
        As of `LinearInterpolator`.
    method : {"sibson", "laplace"}, optional
        The weights. Sibson's are smoother, Laplace's quicker to compute.
    fill_value : float or complex, optional
        The result outside of the hull.
    rescale : bool, optional
        As of `LinearInterpolator`. Natural neighbours depend on the units of x and y.
    device : str, optional
        As of `triangulate`.
    tol, extrapolate, max_edge, max_distance
        As of `LinearInterpolator`.

    Attributes
    ----------
    tri : Delaunay
        The triangulation, of the rescaled points if they are rescaled.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`, for another number of values than of points, and for another method.

    Notes
    -----
    The neighbours are found by exact tests. The errors of all weights of a query together are below
    2**-36, whatever the points, if it has fewer than a thousand neighbours. The interpolant is continuous,
    has no overshoots, and is exact for linear functions up to rounding. Its gradient is continuous
    except at the points with Sibson's weights, and except on the circles of triangles with Laplace's.
    Otherwise as `LinearInterpolator`.

    A query takes as many steps as it has neighbours: at the centre of very many cocircular points, all of
    them.

    Examples
    --------
    >>> import flaunay
    >>> points = [[0, 0], [4, 0], [0, 4], [4, 4]]
    >>> interpolate = flaunay.NaturalNeighborInterpolator(points, [0, 8, 4, 0])
    >>> interpolate([[2, 2], [2, 0], [9, 9]])
    array([ 3.,  4., nan])
    """

    def __init__(
        self,
        points: Points,
        values: npt.ArrayLike,
        method: Literal["sibson", "laplace"] = "sibson",
        fill_value: complex = np.nan,
        rescale: bool = False,
        *,
        device: Optional[str] = None,
        tol: Optional[float] = None,
        extrapolate: Optional[Literal["nearest", "linear"]] = None,
        max_edge: Optional[float] = None,
        max_distance: Optional[float] = None,
    ) -> None:
        if not isinstance(method, str) or method not in _WEIGHTS:
            raise UsageError(f"method must be 'sibson' or 'laplace', not {method!r}")
        self._method = method
        beyond = _Beyond(tol, extrapolate, max_edge, max_distance)
        super().__init__(points, values, fill_value, rescale, device, beyond)

    def weights(self, *xi: Any) -> scipy.sparse.csr_array:
        """What each point counts for at each query, so that ``weights(xi) @ values`` interpolates any values.

        Parameters
        ----------
        *xi
            As of a call. Queries are counted in their order.

        Returns
        -------
        scipy.sparse.csr_array, shape (queries, npoints)
            The weights of the natural neighbours, with the sum 1. Rows of queries outside are empty, and give 0.

        Raises
        ------
        ImportError
            Without SciPy.

        Examples
        --------
        >>> import flaunay
        >>> points = [[0, 0], [4, 0], [0, 4], [4, 4]]
        >>> interpolate = flaunay.NaturalNeighborInterpolator(points, [0, 8, 4, 0])
        >>> interpolate.weights([[2, 2], [9, 9]]).toarray()
        array([[0.25, 0.25, 0.25, 0.25],
               [0.  , 0.  , 0.  , 0.  ]])
        """
        sparse = optional("scipy.sparse", "NaturalNeighborInterpolator.weights")
        queries, _ = self._queries(xi)
        asked = are_finite(queries)
        starts, columns, weights = self.tri._locator.natural_weights(queries[asked], self._method)
        starts = starts[np.concatenate([[0], np.cumsum(asked)])]
        return _as_rows(sparse, weights, columns, starts, self.tri.npoints)


def griddata(
    points: Points,
    values: npt.ArrayLike,
    xi: Any,
    method: Literal["linear", "nearest", "cubic", "natural"] = "linear",
    fill_value: complex = np.nan,
    rescale: bool = False,
    *,
    device: Optional[str] = None,
    tol: Optional[float] = None,
    extrapolate: Optional[Literal["nearest", "linear"]] = None,
    max_edge: Optional[float] = None,
    max_distance: Optional[float] = None,
) -> npt.NDArray[Any]:
    """Interpolates scattered values, as `scipy.interpolate.griddata`.

    Parameters
    ----------
    points, values
        As of `LinearInterpolator`.
    xi : array_like, shape (..., 2), or tuple of x and y
        Where to interpolate.
    method : {"linear", "nearest", "cubic", "natural"}
        `LinearInterpolator`, `NearestInterpolator`, `CloughTocherInterpolator`, or
        `NaturalNeighborInterpolator` with Sibson's weights, which SciPy does not have.
    fill_value : float or complex, optional
        The result outside of the hull; the nearest point has none.
    rescale : bool, optional
        As of `LinearInterpolator`.
    device : str, optional
        As of `triangulate`.
    tol, extrapolate, max_edge, max_distance
        As of `LinearInterpolator`; the nearest point has the last one only.

    Returns
    -------
    ndarray
        The values at `xi`.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of the interpolators, and for another method.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.griddata([[0, 0], [4, 0], [0, 4]], [0, 8, 4], ([1, 3], [1, 0.5]))
    array([3. , 6.5])
    """
    kinds: dict[str, Callable[..., _Interpolator]] = {
        "linear": LinearInterpolator,
        "nearest": NearestInterpolator,
        "cubic": CloughTocherInterpolator,
        "natural": NaturalNeighborInterpolator,
    }
    if not isinstance(method, str) or method not in kinds:
        raise UsageError(
            f"method must be 'linear', 'nearest', 'cubic' or 'natural', not {method!r}"
        )
    options: dict[str, Any] = {"max_distance": max_distance}
    if method != "nearest":
        options.update(fill_value=fill_value, extrapolate=extrapolate, max_edge=max_edge)
        options["border_tol" if method == "cubic" else "tol"] = tol
    return kinds[method](points, values, rescale=rescale, device=device, **options)(xi)
