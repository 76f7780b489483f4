"""Triangulations of points in device memory, by pyopencl."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import summary
from flaunay._cells import corners_of
from flaunay._declarations import DeviceTriangulationArrays
from flaunay._device_arrays import DeviceCall, Offsets, import_pyopencl, queue_for, view
from flaunay._device_queries import DeviceLocator
from flaunay._device_voronoi import DeviceClippedVoronoi, DeviceVoronoi
from flaunay._errors import UsageError
from flaunay._triangulation import Triangulation

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array
    from typing_extensions import Unpack

    from flaunay._declarations import DeviceTriangulationOptions

_Result = TypeVar("_Result")


@dataclass(frozen=True, eq=False, repr=False)
class DeviceTriangulation(DeviceTriangulationArrays):
    """A triangulation in device memory, of one or more sets of points.

    The arrays are views of buffers that flaunay made for this result: nothing is copied to make
    them, and a buffer lives as long as an array of it. Its methods read the points and the arrays
    again, so neither may be changed before them.

    Attributes
    ----------
    points : pyopencl.array.Array
        The points that were given.
    triangles, neighbors and so on : pyopencl.array.Array or None
        The arrays of `Triangulation`, with its shapes and types; None if not asked for, but triangles.
    triangle_offsets, hull_offsets : ndarray of int64, shape (sets + 1,)
        As those of `Triangulation`, in host memory. Without `hull`, the latter are known all the same.
    statistics : dict
        How it came about.
    event : pyopencl.Event
        Complete when the results are there. The arrays know it: what pyopencl does with them waits.
    """

    points: pyopencl.array.Array
    triangle_offsets: npt.NDArray[np.int64]
    hull_offsets: npt.NDArray[np.int64]
    statistics: dict[str, Any]
    event: pyopencl.Event
    _mesh: _calls.DeviceTriangulation = field(repr=False)
    _queue: pyopencl.CommandQueue = field(repr=False)

    def __repr__(self) -> str:
        # Counts from the sizes alone, since the arrays are in device memory.
        return summary(
            self,
            points=self.statistics["points"],
            triangles=int(self.triangle_offsets[-1]),
            hull_vertices=int(self.hull_offsets[-1]),
            sets=len(self.hull_offsets) - 1,
        )

    def get(self) -> Triangulation:
        """Copies all to host memory, when it is there.

        Raises
        ------
        UsageError
            If hull or representatives were not asked for, which a `Triangulation` always has.
        """
        if self.hull is None or self.representatives is None:
            raise UsageError("a Triangulation needs hull and representatives: ask for them")
        cl = import_pyopencl()
        mine = {name.name: getattr(self, name.name) for name in fields(Triangulation)}
        return Triangulation(
            **{
                name: value.get() if isinstance(value, cl.array.Array) else value
                for name, value in mine.items()
            }
        )

    def locator(
        self,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> DeviceLocator:
        """What answers queries on the triangulation, in device memory.

        Parameters
        ----------
        queue : pyopencl.CommandQueue, optional
            As of `triangulate_device`. Without it, the one that the triangulation was made on.
        wait_for : sequence of pyopencl.Event, optional
            As of `triangulate_device`.

        Returns
        -------
        DeviceLocator
            It may outlive the triangulation and the points, and these may change after its ``event``.

        Raises
        ------
        UsageError
            If neighbors, hull or representatives were not asked for, or for a queue of another context.
        """
        handle, _, event = self._run(_calls.DeviceLocator, "a locator", queue, wait_for)
        return DeviceLocator(handle, int(self.points.shape[0]), event)

    def voronoi(
        self,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> DeviceVoronoi:
        """The dual of the triangulation, in device memory.

        Parameters
        ----------
        queue, wait_for : optional
            As of `locator`.

        Returns
        -------
        DeviceVoronoi

        Raises
        ------
        UsageError
            As of `locator`.
        """
        made, own, event = self._run(_calls.DeviceVoronoi, "a Voronoi diagram", queue, wait_for)
        n, m = int(self.points.shape[0]), int(self.triangle_offsets[-1])
        places = made.arrays(triangle=m, corner=3 * m, point=n, point_offset=n + 1)
        views = {name: view(*place, own, event) for name, place in places.items()}
        return DeviceVoronoi(vertices=views.pop("circumcentres"), **views, event=event)

    def clipped_voronoi(
        self,
        bounds: Any,
        queue: Optional[pyopencl.CommandQueue] = None,
        wait_for: Optional[Sequence[pyopencl.Event]] = None,
    ) -> DeviceClippedVoronoi:
        """The Voronoi cells, clipped to a box or a convex polygon, with their areas and centroids.

        Of several sets, each has cells of its own, that cover the polygon.

        Parameters
        ----------
        bounds : array_like or shapely.Polygon
            As of `Voronoi.clipped`, in host memory.
        queue, wait_for : optional
            As of `locator`.

        Returns
        -------
        DeviceClippedVoronoi

        Raises
        ------
        UsageError
            As of `locator`, and if the bounds are neither.
        InputError
            If the polygon is not convex, or not finite; the message names a corner.
        """
        corners = corners_of(bounds)
        work, what = _calls.DeviceClippedVoronoi, "a Voronoi diagram"
        given = (np.ascontiguousarray(corners), len(corners))
        made, own, event = self._run(work, what, queue, wait_for, *given)
        n = int(self.points.shape[0])
        places = made.arrays(point=n, point_offset=n + 1)
        views = {name: view(*place, own, event) for name, place in places.items()}
        return DeviceClippedVoronoi(**views, bounds=corners, event=event)

    def _run(
        self,
        work: Callable[..., _Result],
        what: str,
        queue: Optional[pyopencl.CommandQueue],
        wait_for: Optional[Sequence[pyopencl.Event]],
        *given: Any,
    ) -> tuple[_Result, pyopencl.CommandQueue, pyopencl.Event]:
        """What a call makes of the points, the triangulation and what is given, its queue and its event.

        what: what it makes, for errors.
        """
        arrays = {name: getattr(self, name) for name in ("neighbors", "hull", "representatives")}
        missing = [name for name, array in arrays.items() if array is None]
        if missing:
            raise UsageError(
                f"{what} needs neighbors, hull and representatives, but the triangulation has no "
                f"{' and no '.join(missing)}: ask triangulate_device for them"
            )
        own = self._queue if queue is None else queue
        call = DeviceCall(queue_for(self.points, own, "points"), wait_for)
        call.reads(self.triangles, *arrays.values())
        points = call.points(self.points, None, "points")
        triangulator = _triangulators.of_queue(call.queue)
        result, event = call.run(work, triangulator, points, self._mesh, *given)
        return result, call.queue, event


def triangulate_device(
    points: pyopencl.array.Array,
    queue: Optional[pyopencl.CommandQueue] = None,
    offsets: Offsets = None,
    wait_for: Optional[Sequence[pyopencl.Event]] = None,
    **parts: Unpack[DeviceTriangulationOptions],
) -> DeviceTriangulation:
    """Triangulates points in device memory into device memory.

    No points and no results cross to the host, only sizes do. Returns when all is enqueued and the
    numbers of triangles are known; the points must not change before the result's `event` is
    complete.

    Parameters
    ----------
    points : pyopencl.array.Array, shape (n, 2)
        Coordinates, C-contiguous float64 or float32. A view's offset must be a multiple of a point's
        bytes. Of a ``pyopencl.Buffer``, take ``Array(queue, (n, 2), numpy.float64, data=buffer)``.
    queue : pyopencl.CommandQueue, optional
        Of the points' context, in order or not. Without it, the points' own.
    offsets : array_like of int or pyopencl.array.Array of int32, shape (sets + 1,), optional
        As of `triangulate`. From device memory, they cross to the host.
    wait_for : sequence of pyopencl.Event, optional
        What must be done before; what the arrays have in their own ``events`` is waited for anyway.
    **parts : bool
        Which arrays of `Triangulation` to compute beside the triangles, such as ``neighbors=True``.

    Returns
    -------
    DeviceTriangulation

    Raises
    ------
    UsageError
        For a wrong shape or type, a queue of another context, offsets that are none.
    InputError
        For a point that is not finite, magnitudes too different to be exact, or too many points.
    DeviceError
        If a call of OpenCL failed.
    ImportError
        If there is no pyopencl.

    Notes
    -----
    O(n log n) work; the mode is ``"blocks"``. One triangulator for each context and device is kept,
    with the memory that it works in.

    Examples
    --------
    >>> import flaunay
    >>> import numpy as np
    >>> import pyopencl as cl
    >>> import pyopencl.array
    >>> queue = cl.CommandQueue(cl.create_some_context(interactive=False))
    >>> points = cl.array.to_device(queue, np.array([[0, 0], [4, 0], [4, 3], [0, 4.0]]))
    >>> tri = flaunay.triangulate_device(points, neighbors=True, hull=True, representatives=True)
    >>> tri.triangles
    cl.Array([[0, 2, 3],
           [0, 1, 2]], dtype=int32)
    >>> tri.voronoi().vertices
    cl.Array([[1.625, 2.   ],
           [2.   , 1.5  ]])
    >>> cells = tri.clipped_voronoi((0, 0, 4, 4))
    >>> float(cl.array.sum(cells.areas).get())
    16.0
    >>> locator = tri.locator()
    >>> queries = cl.array.to_device(queue, np.array([[1, 2], [3, 1], [9, 9.0]]))
    >>> locator.locate(queries)
    cl.Array([ 0,  1, -1], dtype=int32)
    >>> locator.nearest(queries)
    cl.Array([0, 1, 2], dtype=int32)
    >>> values = cl.array.to_device(queue, np.array([0, 8, 11, 4.0]))
    >>> locator.interpolate(values, queries, fill_value=-1)
    cl.Array([ 4.,  7., -1.])
    """
    for name in parts:
        if name not in _calls.TRIANGULATION or name == "triangles":
            raise TypeError(f"unexpected keyword argument {name!r}")
    wanted = {"triangles", *(name for name, is_wanted in parts.items() if is_wanted)}
    call = DeviceCall(queue_for(points, queue, "points"), wait_for)
    device_points = call.points(points, offsets, "points")
    triangulator = _triangulators.of_queue(call.queue)
    result, event = call.run(_calls.DeviceTriangulation, triangulator, device_points, wanted)
    views = {name: view(*place, call.queue, event) for name, place in result.computed().items()}
    return DeviceTriangulation(
        **dict.fromkeys(_calls.TRIANGULATION) | views,
        points=points,
        triangle_offsets=result.triangle_offsets,
        hull_offsets=result.hull_offsets,
        statistics=result.statistics,
        event=event,
        _mesh=result,
        _queue=call.queue,
    )
