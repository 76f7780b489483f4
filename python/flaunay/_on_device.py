"""Triangulations of points in device memory, by pyopencl."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from flaunay import _flaunay, _triangulators
from flaunay._arrays import as_segments, names_of, summary
from flaunay._errors import UsageError
from flaunay._triangulation import Triangulation

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array

_COORDINATES = (np.dtype(np.float64), np.dtype(np.float32))


@dataclass(frozen=True, eq=False, repr=False)
class DeviceTriangulation:
    """A triangulation in device memory, of one or more sets of points.

    The arrays are views of buffers that flaunay made for this result: nothing is copied to make
    them, and a buffer lives as long as an array of it.

    Attributes
    ----------
    triangles, neighbors, halfedges, hull, representatives : pyopencl.array.Array or None
        As those of `Triangulation`, with its shapes, int32; None if not asked for.
    triangle_offsets, hull_offsets : ndarray of int64, shape (sets + 1,)
        As those of `Triangulation`, in host memory. Without `hull`, the latter are known all the same.
    statistics : dict
        How it came about.
    event : pyopencl.Event
        Complete when the results are there. The arrays know it: what pyopencl does with them waits.
    """

    triangles: pyopencl.array.Array
    neighbors: Optional[pyopencl.array.Array]
    halfedges: Optional[pyopencl.array.Array]
    hull: Optional[pyopencl.array.Array]
    representatives: Optional[pyopencl.array.Array]
    triangle_offsets: npt.NDArray[np.int64]
    hull_offsets: npt.NDArray[np.int64]
    statistics: dict[str, Any]
    event: pyopencl.Event

    def __repr__(self) -> str:
        # Of the sizes alone, since the arrays are in device memory.
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
        cl = _import_pyopencl()
        return Triangulation(
            **{
                name: value.get() if isinstance(value, cl.array.Array) else value
                for name, value in vars(self).items()
                if name != "event"
            }
        )


def _import_pyopencl() -> Any:
    try:
        import pyopencl
        import pyopencl.array
    except ImportError as error:
        raise ImportError(
            "points in device memory need pyopencl, which cannot be imported"
        ) from error
    return pyopencl


def _handle(array: pyopencl.array.Array) -> int:
    # An empty array has no buffer.
    return 0 if array.base_data is None else int(array.base_data.int_ptr)


def _check_contiguous(array: pyopencl.array.Array, name: str) -> None:
    if not array.flags.c_contiguous:
        raise UsageError(f"{name} must be C-contiguous in device memory; take {name}.copy()")


def _first_point(points: pyopencl.array.Array) -> int:
    """How many points precede a view's in its buffer."""
    bytes_per_point = 2 * points.dtype.itemsize
    if points.offset % bytes_per_point:
        raise UsageError(
            f"points begin {points.offset} bytes after their buffer's begin, which is no multiple of a "
            f"point's {bytes_per_point} bytes; take points.copy()"
        )
    return int(points.offset // bytes_per_point)


def _as_device_segments(
    segments: pyopencl.array.Array, queue: pyopencl.CommandQueue
) -> pyopencl.array.Array:
    if segments.ndim != 1 or segments.dtype != np.int32 or segments.size == 0:
        raise UsageError(
            "segments in device memory must be int32 in one dimension, one or more, "
            f"not {segments.dtype} of shape {segments.shape}"
        )
    _check_contiguous(segments, "segments")
    # The library reads them from the buffer's begin on.
    return segments.copy(queue=queue) if segments.offset else segments


def _to_points(
    points: pyopencl.array.Array,
    segments: Union[npt.ArrayLike, pyopencl.array.Array, None],
    queue: pyopencl.CommandQueue,
) -> tuple[_flaunay.DevicePoints, list[pyopencl.array.Array]]:
    """Points as the library takes them, and the arrays that they are in."""
    cl = _import_pyopencl()
    if not isinstance(points, cl.array.Array):
        raise TypeError(
            f"points must be a pyopencl.array.Array, not {type(points).__name__}; of a pyopencl.Buffer, "
            "take Array(queue, (n, 2), numpy.float64, data=buffer)"
        )
    if points.ndim != 2 or points.shape[1] != 2:
        raise UsageError(f"points must have the shape (n, 2), not {points.shape}")
    if points.dtype not in _COORDINATES:
        raise UsageError(f"points in device memory must be float64 or float32, not {points.dtype}")
    _check_contiguous(points, "points")
    place = (
        _handle(points),
        int(points.shape[0]),
        bool(points.dtype == np.float32),
        _first_point(points),
    )
    if segments is None:
        return _flaunay.DevicePoints(*place), [points]
    if not isinstance(segments, cl.array.Array):
        return _flaunay.DevicePoints(*place, segments=as_segments(segments)), [points]
    offsets = _as_device_segments(segments, queue)
    device_points = _flaunay.DevicePoints(
        *place, device_segments=_handle(offsets), sets=int(offsets.size) - 1
    )
    return device_points, [points, offsets]


def _queue_for(
    points: pyopencl.array.Array, queue: Optional[pyopencl.CommandQueue]
) -> pyopencl.CommandQueue:
    cl = _import_pyopencl()
    if queue is None:
        queue = getattr(points, "queue", None)
        if queue is None and isinstance(points, cl.array.Array):
            raise UsageError("points have no queue of their own: give one")
    elif not isinstance(queue, cl.CommandQueue):
        raise TypeError(f"queue must be a pyopencl.CommandQueue, not {type(queue).__name__}")
    return queue


def _as_events(wait_for: Optional[Iterable[pyopencl.Event]]) -> list[pyopencl.Event]:
    if wait_for is None:
        return []
    cl = _import_pyopencl()
    events = list(wait_for) if isinstance(wait_for, Iterable) else [None]
    if not all(isinstance(event, cl.Event) for event in events):
        raise TypeError(f"wait_for must be a sequence of pyopencl.Event, not {wait_for!r}")
    return events


def _view(
    handle: int, shape: tuple[int, ...], queue: pyopencl.CommandQueue, event: pyopencl.Event
) -> pyopencl.array.Array:
    """An array over a buffer, which is retained."""
    cl = _import_pyopencl()
    if 0 in shape:
        return cl.array.Array(queue, shape, np.int32)
    data = cl.MemoryObject.from_int_ptr(handle, retain=True)
    array = cl.array.Array(queue, shape, np.int32, data=data)
    array.add_event(event)
    return array


def triangulate_device(
    points: pyopencl.array.Array,
    queue: Optional[pyopencl.CommandQueue] = None,
    segments: Union[npt.ArrayLike, pyopencl.array.Array, None] = None,
    neighbors: bool = False,
    halfedges: bool = False,
    hull: bool = False,
    representatives: bool = False,
    wait_for: Optional[Sequence[pyopencl.Event]] = None,
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
    segments : array_like of int or pyopencl.array.Array of int32, shape (sets + 1,), optional
        As of `triangulate`. From device memory, they cross to the host.
    neighbors, halfedges, hull, representatives : bool
        Which of these to compute beside the triangles.
    wait_for : sequence of pyopencl.Event, optional
        What must be done before; what the arrays have in their own ``events`` is waited for anyway.

    Returns
    -------
    DeviceTriangulation

    Raises
    ------
    UsageError
        For a wrong shape or type, a queue of another context, segments that are none.
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
    >>> flaunay.triangulate_device(points).triangles
    cl.Array([[0, 2, 3],
           [0, 1, 2]], dtype=int32)
    """
    cl = _import_pyopencl()
    queue = _queue_for(points, queue)
    device_points, arrays = _to_points(points, segments, queue)
    events = [event for array in arrays for event in array.events] + _as_events(wait_for)
    triangulator = _triangulators.of_queue(queue)
    wanted = names_of(
        triangles=True,
        neighbors=neighbors,
        halfedges=halfedges,
        hull=hull,
        representatives=representatives,
    )
    result, event_handle = _flaunay.triangulate_device(
        triangulator, device_points, wanted, queue.int_ptr, [event.int_ptr for event in events]
    )
    event = cl.Event.from_int_ptr(event_handle, retain=False)
    for array in arrays:
        array.add_event(event)
    views = {
        name: None if place is None else _view(*place, queue, event)
        for name, place in result.arrays().items()
    }
    return DeviceTriangulation(
        **views,
        triangle_offsets=result.triangle_offsets,
        hull_offsets=result.hull_offsets,
        statistics=result.statistics,
        event=event,
    )
