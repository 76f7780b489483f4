"""Triangulations to which batches of points are inserted, removed and moved."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import (
    ArrayLike,
    as_integers,
    as_points,
    is_on_device,
    number_of,
    summary,
)
from flaunay._constrained import as_segments
from flaunay._declarations import CROSSINGS
from flaunay._device_arrays import DeviceCall, queue_for, view
from flaunay._errors import InputError, UsageError
from flaunay._triangulation import Triangulation, with_arrays

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]
Points = Union[ArrayLike, "pyopencl.array.Array"]


class Changes(NamedTuple):
    """What a batch of points has changed.

    Attributes
    ----------
    first_point : int
        The number of the first point that was inserted; the others follow it.
    representatives : ndarray of int32, shape (m,)
        For each point that was inserted or moved the smallest number of a point in its place.
    removed : ndarray of int32, shape (k,)
        The rows whose triangles are gone, each once.
    made : ndarray of int32, shape (t,)
        The rows that have new triangles, each once. Some may be in `removed`, too.
    made_corners : ndarray of int32, shape (t, 3)
        The corners of these, counter-clockwise.
    is_anew : bool
        Whether all points were triangulated anew: all rows are listed then.
    seconds : float
        How long the call took.
    """

    first_point: int
    representatives: Indices
    removed: Indices
    made: Indices
    made_corners: Indices
    is_anew: bool
    seconds: float


class TriangleRows(NamedTuple):
    """Triangles by their rows, which stay where they are as long as nothing changes them.

    Attributes
    ----------
    triangles : ndarray of int32, shape (rows, 3)
        The corners, counter-clockwise from any of them on; -1 in rows without a triangle.
    neighbors : ndarray of int32, shape (rows, 3)
        The row of the triangle opposite to each corner; -1 beyond the hull and in rows without one.
    """

    triangles: Indices
    neighbors: Indices


class DeviceRows(NamedTuple):
    """The rows and points of a `DynamicTriangulation`, in device memory.

    Attributes
    ----------
    triangles, neighbors : pyopencl.array.Array
        As of `TriangleRows`.
    points : pyopencl.array.Array
        As `DynamicTriangulation.points`.
    event : pyopencl.Event
        Complete when the arrays are there, which know it.
    """

    triangles: pyopencl.array.Array
    neighbors: pyopencl.array.Array
    points: pyopencl.array.Array
    event: pyopencl.Event


class LivingConstraints(NamedTuple):
    """The edges that segments are made of now.

    Attributes
    ----------
    edges : ndarray of int32, shape (e, 2)
        Two points each, the lexicographically smaller one first.
    segments : ndarray of int32, shape (e,)
        For each of these the smallest index of a segment that has it.
    """

    edges: Indices
    segments: Indices


def as_numbers(given: npt.ArrayLike) -> Indices:
    """Numbers of points, as the library takes them."""
    numbers = as_integers(given, "indices")
    if numbers.ndim != 1:
        raise UsageError(f"indices must have one dimension, not the shape {numbers.shape}")
    kept = np.ascontiguousarray(numbers, np.int32)
    if (kept != numbers).any():
        raise UsageError(f"indices[{np.flatnonzero(kept != numbers)[0]}] is the number of no point")
    return kept


def _place_beyond(points: Doubles) -> Doubles:
    """A place beyond the box of points, NaN among them, and as near to it as coordinates of their size can be."""
    there = points[~np.isnan(points[:, 0])]
    if not len(there):
        return np.zeros(2)
    low, high = there.min(axis=0), there.max(axis=0)
    step = max(np.abs(there).max() * 2.0**-52, 2.0**-1074) * np.eye(2)
    with np.errstate(over="ignore"):
        beyond = np.concatenate([high + step, low - step])
    beyond = beyond[np.isfinite(beyond).all(axis=1)]
    if not len(beyond):
        raise TypeError(
            "points as large as doubles can be, on all sides, cannot be copied: remove one of them"
        )
    place: Doubles = beyond[0]
    return place


class DynamicTriangulation:
    """A triangulation to which batches of points are inserted, removed and moved, each in one call.

    After every call its triangles are those of a call of `triangulate` on all points that it has.
    `Delaunay` with ``incremental=True`` has the interface of SciPy; this class takes segments and points in
    device memory, too.

    Points have numbers: those it is made from come first, then those inserted, in their order. A number
    stays the same as long as the point is there, and is not used again. Of points in one place, the one
    with the smallest number is in triangles.

    Copies, also by pickling, have the same points, numbers and constraints, and change on their own; their rows
    have other numbers.

    Parameters
    ----------
    points : array_like or pyopencl.array.Array, shape (n, 2)
        As of `triangulate`, or of `triangulate_device`; copied.
    segments : array_like of int, shape (k, 2), optional
        As of `triangulate`. Points on one split it, and its vertices cannot be removed or moved. With points
        in host memory.
    crossings : {"error", "split"}
        As of `triangulate`. Points that splitting adds come after the n.
    device : str, optional
        As of `triangulate`, for points in host memory.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `triangulate`.

    Examples
    --------
    >>> import flaunay
    >>> tri = flaunay.DynamicTriangulation([[0, 0], [4, 0], [4, 3], [0, 4]])
    >>> changes = tri.insert([[1, 2], [2, 2]])
    >>> changes.first_point, tri.triangle_count
    (4, 6)
    >>> changes = tri.remove([0, 4])
    >>> tri
    <flaunay.DynamicTriangulation: 4 points, 2 triangles>
    >>> tri.points[:2]
    array([[nan, nan],
           [ 4.,  0.]])
    """

    def __init__(
        self,
        points: Points,
        segments: Optional[npt.ArrayLike] = None,
        *,
        crossings: str = "error",
        device: Optional[str] = None,
    ) -> None:
        rule = number_of(CROSSINGS, crossings, "crossings")
        pairs: Optional[Indices] = None
        self._queue: Optional[pyopencl.CommandQueue] = None
        self._device = device
        # For a copy, the segment of each edge from which it was made.
        self._segments: Optional[Indices] = None
        if is_on_device(points):
            if segments is not None or device is not None:
                raise UsageError("segments and device are for points in host memory")
            self._queue = queue_for(points, None, "points")
            triangulator = _triangulators.of_queue(self._queue)
            given: Any = self._in_device_memory(points)
        else:
            given = np.asarray(as_points(points), np.float64)
            if segments is not None:
                pairs = as_segments(segments, len(given))
            triangulator = _triangulators.of_device(device)
        self._handle = _calls.Dynamic(triangulator, given, pairs, rule)

    @staticmethod
    def _in_device_memory(points: Any) -> _calls.DevicePoints:
        """Points as the library takes them, when they are there."""
        call = DeviceCall(queue_for(points, None, "points"), None)
        given = call.points(points, None, "points")
        for event in points.events:
            event.wait()
        return given

    def __repr__(self) -> str:
        return summary(self, points=self.point_count, triangles=self.triangle_count)

    def __reduce__(self) -> tuple[Any, ...]:
        if self._queue is not None:
            raise TypeError(
                "a DynamicTriangulation in device memory cannot be copied or pickled: make another one of the "
                "points of rows_on_device()"
            )
        with self._handle.turn:
            state = self.points, *self.constraints(), self._device
        return type(self).__new__, (type(self),), state

    def __setstate__(self, state: tuple[Doubles, Indices, Indices, Optional[str]]) -> None:
        """Makes it of points, NaN for those that were removed, and of edges of segments."""
        points, edges, segments, device = state
        removed = np.flatnonzero(np.isnan(points[:, 0]))
        has_edges = len(edges) > 0
        if len(removed):
            # Places that are left at once must not equal others, nor lie on edges.
            points = np.where(np.isnan(points), _place_beyond(points), points)
        DynamicTriangulation.__init__(self, points, edges if has_edges else None, device=device)
        if has_edges:
            self._segments = segments
        if len(removed):
            self.remove(removed)

    def insert(self, points: Points) -> Changes:
        """Inserts points.

        Parameters
        ----------
        points : array_like or pyopencl.array.Array, shape (m, 2)
            In device memory only if the first ones were, too.

        Returns
        -------
        Changes

        Raises
        ------
        UsageError, InputError
            As of `triangulate`. Nothing is changed then.
        """
        if is_on_device(points):
            return Changes(**self._handle.insert_device(self._in_device_memory(points)))
        return Changes(**self._handle.insert(np.asarray(as_points(points), np.float64)))

    def remove(self, indices: npt.ArrayLike) -> Changes:
        """Removes points.

        Parameters
        ----------
        indices : array_like of int, shape (m,)
            The numbers of the points.

        Returns
        -------
        Changes

        Raises
        ------
        InputError
            For a number that no point has, one that is there twice, and a vertex of a constraint. Nothing
            is changed then.
        """
        with self._naming_segments():
            return Changes(**self._handle.remove(as_numbers(indices)))

    def move(self, indices: npt.ArrayLike, points: ArrayLike) -> Changes:
        """Moves points, all at once.

        Parameters
        ----------
        indices : array_like of int, shape (m,)
            The numbers of the points.
        points : array_like, shape (m, 2)
            Their new places.

        Returns
        -------
        Changes

        Raises
        ------
        UsageError, InputError
            As of `insert` and `remove`.
        """
        numbers, places = as_numbers(indices), np.asarray(as_points(points), np.float64)
        if len(numbers) != len(places):
            raise UsageError(f"{len(numbers)} points cannot be moved to {len(places)} places")
        with self._naming_segments():
            return Changes(**self._handle.move(numbers, places))

    @contextlib.contextmanager
    def _naming_segments(self) -> Iterator[None]:
        """Errors with the numbers of the segments that were given, of which a copy has the edges."""
        try:
            yield
        except InputError as error:
            segments = self._segments
            if segments is None:
                raise
            text = re.sub(
                r"segment (\d+)", lambda match: f"segment {segments[int(match[1])]}", str(error)
            )
            raise InputError(text, error.code, error.call) from None

    @property
    def numbers(self) -> int:
        """One more than the largest number that a point has had."""
        return self._handle.count("numbers")

    @property
    def point_count(self) -> int:
        """The number of points that there are, with duplicates."""
        return self._handle.count("point_count")

    @property
    def triangle_count(self) -> int:
        return self._handle.count("triangle_count")

    @property
    def row_count(self) -> int:
        """The number of rows, with those that have no triangle."""
        return self._handle.count("row_count")

    @property
    def points(self) -> Doubles:
        """A copy of the places of all numbers, shape (numbers, 2): NaN for points that were removed."""
        return self._handle.coordinates()

    def rows(self) -> TriangleRows:
        """A copy of the triangles by their rows, which `Changes` mean."""
        return TriangleRows(*self._handle.rows())

    def rows_on_device(
        self,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> DeviceRows:
        """A copy of the rows and points in device memory, if the first points were given there.

        Parameters
        ----------
        queue : pyopencl.CommandQueue, optional
            Of their context. Without it, the one that they had.
        wait_for : sequence of pyopencl.Event, optional
            As of `triangulate_device`.

        Raises
        ------
        UsageError
            If the points were given in host memory, or for a queue of another context.
        """
        if self._queue is None:
            raise UsageError("the triangulation was made of points in host memory")
        call = DeviceCall(self._queue if queue is None else queue, wait_for)
        made, event = call.run(_calls.DeviceTriangulation.of_rows, self._handle)
        places = made.arrays_of("triangles", "neighbors", "coordinates")
        views = {name: view(*place, call.queue, event) for name, place in places.items()}
        return DeviceRows(points=views.pop("coordinates"), **views, event=event)

    def triangulation(self) -> Triangulation:
        """The result of a call of `triangulate` on all points, with their numbers.

        Triangles are in the order of their rows. Representatives of points that were removed are -1.
        """
        return with_arrays(Triangulation, self._handle.arrays())

    def constraints(self) -> LivingConstraints:
        """The edges that segments are made of now.

        Examples
        --------
        >>> import flaunay
        >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
        >>> tri = flaunay.DynamicTriangulation(square, segments=[[1, 3]])
        >>> changes = tri.insert([[0.5, 0.5]])
        >>> sorted(tri.constraints().edges.tolist())
        [[3, 4], [4, 1]]
        """
        edges, of = self._handle.constraints()
        return LivingConstraints(edges, of if self._segments is None else self._segments[of])
