"""Queries and interpolation in device memory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Optional

import numpy as np

from flaunay import _calls, _triangulators
from flaunay._arrays import as_iterations, summary
from flaunay._device_arrays import DeviceCall, Offsets, queue_for
from flaunay._errors import UsageError

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array

# The methods by their names, and those that the library has for them.
_METHODS = {
    "linear": "linear",
    "nearest": "nearest",
    "clough-tocher": "clough_tocher",
    "sibson": "sibson",
    "laplace": "laplace",
}


class DeviceLocator:
    """Answers queries in device memory on a triangulation. `DeviceTriangulation.locator` makes it.

    `triangulate_device` has an example.

    It has copied what it needs, about 80 bytes per point in device memory, which `close` gives back.
    Queries, values and answers are ``pyopencl.array.Array``; nothing passes through the host. A call
    returns when all is enqueued. Its arrays know the event of its end: what pyopencl does with them
    waits, and until then what it reads must not change.

    What calls have in common:

    queries : pyopencl.array.Array, shape (m, 2)
        As the points of `triangulate_device`, finite.
    offsets : array_like of int or pyopencl.array.Array of int32, shape (sets + 1,), optional
        Needed if the triangulation has several sets: set s of the queries, which are
        ``queries[offsets[s]:offsets[s + 1]]``, is for set s of the points.
    queue : pyopencl.CommandQueue, optional
        Of the locator's context and device, in order or not. Without it, that of the queries (of the
        values, for `gradients`).
    wait_for : sequence of pyopencl.Event, optional
        What must be done before; what the arrays have in their own ``events`` is waited for anyway.

    They raise UsageError for a wrong shape or type, a queue or a buffer of another context, and another
    number of sets; InputError for a query that is not finite, or whose coordinates are too fine for
    exact arithmetic in doubles; TypeError for what is no array of pyopencl.

    Attributes
    ----------
    npoints : int
        The number of points.
    event : pyopencl.Event
        Complete when the points and the triangulation have been read.
    """

    def __init__(self, handle: _calls.DeviceLocator, npoints: int, event: pyopencl.Event) -> None:
        self._handle: Optional[_calls.DeviceLocator] = handle
        self.npoints = npoints
        self.event = event

    def __repr__(self) -> str:
        return summary(self, points=self.npoints)

    def _opened(self) -> _calls.DeviceLocator:
        _triangulators.check_process()
        handle = self._handle
        if handle is None:
            raise UsageError("the locator is closed: make a new one")
        return handle

    def close(self) -> None:
        """Gives back its device memory. What is enqueued goes on; later calls raise UsageError."""
        self._handle = None

    def locate(
        self,
        queries: pyopencl.array.Array,
        offsets: Offsets = None,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> pyopencl.array.Array:
        """The triangle that contains each query, exactly, int32, shape (m,); -1 outside of the hull.

        On an edge or a vertex it is the triangle of the smallest index that contains the query.
        """
        handle = self._opened()
        call = DeviceCall(queue_for(queries, queue, "queries"), wait_for)
        given = call.points(queries, offsets, "queries")
        return call.array(queries.shape[:1], np.int32, handle.locate, given)

    def nearest(
        self,
        queries: pyopencl.array.Array,
        offsets: Offsets = None,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> pyopencl.array.Array:
        """The point that is nearest to each query, int32, shape (m,), by exact comparisons.

        Of several it is the first in the order of x, then y; -1 in a set without points.
        """
        handle = self._opened()
        call = DeviceCall(queue_for(queries, queue, "queries"), wait_for)
        given = call.points(queries, offsets, "queries")
        return call.array(queries.shape[:1], np.int32, handle.nearest, given)

    def interpolate(
        self,
        values: pyopencl.array.Array,
        queries: pyopencl.array.Array,
        method: str = "linear",
        fill_value: float = np.nan,
        gradients: Optional[pyopencl.array.Array] = None,
        offsets: Offsets = None,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> pyopencl.array.Array:
        """The values between the points, at each query.

        Parameters
        ----------
        values : pyopencl.array.Array of float64, shape (npoints,) or (npoints, k)
            Of equal points, those of the smallest index count.
        queries, offsets, queue, wait_for
            As the class says.
        method : str
            ``"linear"``, ``"nearest"`` or ``"clough-tocher"``: as `LinearInterpolator`,
            `NearestInterpolator` and `CloughTocherInterpolator`. ``"sibson"`` or ``"laplace"``: as
            `NaturalNeighborInterpolator` with this method.
        fill_value : float
            The result outside of the hull. The nearest point has none, except in a set without points.
        gradients : pyopencl.array.Array of float64, shape (npoints, 2) or (npoints, k, 2), optional
            For ``"clough-tocher"``, such as `gradients` makes; without them, each call estimates them.

        Returns
        -------
        pyopencl.array.Array of float64, shape (m,) or (m, k)
            At a point, exactly its values.
        """
        handle = self._opened()
        if method not in _METHODS:
            raise UsageError(f"there is no method {method!r}; there are {', '.join(_METHODS)}")
        if gradients is not None and method != "clough-tocher":
            raise UsageError(f"gradients are for the method 'clough-tocher', not {method!r}")
        call = DeviceCall(queue_for(queries, queue, "queries"), wait_for)
        given = call.points(queries, offsets, "queries")
        memory, columns = self._values(call, values)
        slopes = 0
        if gradients is not None:
            slopes = call.numbers(gradients, [(*values.shape, 2)], "gradients")
        shape = (*queries.shape[:1], *values.shape[1:])
        how = (_METHODS[method], float(fill_value), slopes)
        return call.array(shape, np.float64, handle.interpolate, memory, columns, given, *how)

    def gradients(
        self,
        values: pyopencl.array.Array,
        tol: float = 1e-6,
        maxiter: int = 400,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> pyopencl.array.Array:
        """The gradients of values at the points, so that the curvature along all edges is least.

        Parameters
        ----------
        values : pyopencl.array.Array of float64, shape (npoints,) or (npoints, k)
        tol : float
            Their error, relative to all gradients together.
        maxiter : int
            The iterations that may be made for that.
        queue, wait_for
            As the class says.

        Returns
        -------
        pyopencl.array.Array of float64, shape (npoints, 2) or (npoints, k, 2)
            NaN at points that another one represents, and at those of a set on one line.
        """
        handle = self._opened()
        maxiter = as_iterations(maxiter, tol)
        call = DeviceCall(queue_for(values, queue, "values"), wait_for)
        memory, columns = self._values(call, values)
        shape = (*values.shape, 2)
        return call.array(shape, np.float64, handle.gradients, memory, columns, tol, maxiter)

    def _values(self, call: DeviceCall, values: pyopencl.array.Array) -> tuple[int, int]:
        """The buffer of values, and how many a point has."""
        n = self.npoints
        memory = call.numbers(values, [(n,), (n, -1)], "values")
        return memory, int(values.shape[1]) if values.ndim == 2 else 1
