"""Arrays of pyopencl, as the library takes them and as it makes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import as_offsets
from flaunay._errors import UsageError

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array

Offsets = Union[npt.ArrayLike, "pyopencl.array.Array", None]

_Result = TypeVar("_Result")

_COORDINATES = (np.dtype(np.float64), np.dtype(np.float32))


def import_pyopencl() -> Any:
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


def _first_point(points: pyopencl.array.Array, name: str) -> int:
    """How many points precede a view's in its buffer."""
    bytes_per_point = int(points.shape[1]) * points.dtype.itemsize
    if points.offset % bytes_per_point:
        raise UsageError(
            f"{name} begin {points.offset} bytes after their buffer's begin, which is no multiple of a "
            f"point's {bytes_per_point} bytes; take {name}.copy()"
        )
    return int(points.offset // bytes_per_point)


def _check_points(points: Any, name: str, widths: Sequence[int]) -> None:
    if not isinstance(points, import_pyopencl().array.Array):
        raise TypeError(
            f"{name} must be a pyopencl.array.Array, not {type(points).__name__}; of a pyopencl.Buffer, "
            "take Array(queue, (n, 2), numpy.float64, data=buffer)"
        )
    if points.ndim != 2 or points.shape[1] not in widths:
        shapes = " or ".join(f"(n, {width})" for width in widths)
        raise UsageError(f"{name} must have the shape {shapes}, not {points.shape}")
    if points.dtype not in _COORDINATES:
        raise UsageError(f"{name} in device memory must be float64 or float32, not {points.dtype}")
    _check_contiguous(points, name)


def _check_offsets(offsets: pyopencl.array.Array) -> None:
    if offsets.ndim != 1 or offsets.dtype != np.int32 or offsets.size == 0:
        raise UsageError(
            "offsets in device memory must be int32 in one dimension, one or more, "
            f"not {offsets.dtype} of shape {offsets.shape}"
        )
    _check_contiguous(offsets, "offsets")


def queue_for(
    array: Any, queue: Optional[pyopencl.CommandQueue], name: str
) -> pyopencl.CommandQueue:
    """The queue that was given, or an array's own."""
    cl = import_pyopencl()
    if queue is None:
        queue = getattr(array, "queue", None)
        if queue is None and isinstance(array, cl.array.Array):
            raise UsageError(f"{name} have no queue of their own: give one")
    elif not isinstance(queue, cl.CommandQueue):
        raise TypeError(f"queue must be a pyopencl.CommandQueue, not {type(queue).__name__}")
    return queue


def _as_events(wait_for: Optional[Iterable[pyopencl.Event]]) -> list[pyopencl.Event]:
    if wait_for is None:
        return []
    cl = import_pyopencl()
    events = list(wait_for) if isinstance(wait_for, Iterable) else [None]
    if not all(isinstance(event, cl.Event) for event in events):
        raise TypeError(f"wait_for must be a sequence of pyopencl.Event, not {wait_for!r}")
    return events


class DeviceCall:
    """A call on device memory in the making: its queue, what it reads, and what it waits for."""

    def __init__(
        self, queue: pyopencl.CommandQueue, wait_for: Optional[Iterable[pyopencl.Event]]
    ) -> None:
        self.queue = queue
        self._wait_for = _as_events(wait_for)
        self._arrays: list[pyopencl.array.Array] = []

    def reads(self, *arrays: Optional[pyopencl.array.Array]) -> None:
        """Makes the call wait for what these arrays wait for, and these know the call's event."""
        self._arrays += [array for array in arrays if array is not None]

    def points(
        self, points: Any, offsets: Offsets, name: str, widths: Sequence[int] = (2,)
    ) -> _calls.DevicePoints:
        """Points as the library takes them. widths: how many coordinates a point may have."""
        _check_points(points, name, widths)
        self.reads(points)
        place = (
            _handle(points),
            int(points.shape[0]),
            bool(points.dtype == np.float32),
            _first_point(points, name),
        )
        if offsets is None:
            return _calls.DevicePoints(*place)
        if not isinstance(offsets, import_pyopencl().array.Array):
            return _calls.DevicePoints(*place, given_offsets=as_offsets(offsets))
        _check_offsets(offsets)
        sets = int(offsets.size) - 1
        return _calls.DevicePoints(*place, device_offsets=self._buffer(offsets), sets=sets)

    def numbers(self, array: Any, shapes: list[tuple[int, ...]], name: str) -> int:
        """The buffer of an array of doubles of one of some shapes, in which -1 is any size but 0."""
        if not isinstance(array, import_pyopencl().array.Array):
            raise TypeError(f"{name} must be a pyopencl.array.Array, not {type(array).__name__}")
        if array.dtype != np.float64:
            raise UsageError(f"{name} in device memory must be float64, not {array.dtype}")

        def fits(shape: tuple[int, ...]) -> bool:
            return len(shape) == array.ndim and all(
                size > 0 if wanted == -1 else size == wanted
                for wanted, size in zip(shape, array.shape)
            )

        if not any(map(fits, shapes)):
            wanted = " or ".join(str(shape).replace("-1", "k") for shape in shapes)
            raise UsageError(f"{name} must have the shape {wanted}, not {array.shape}")
        _check_contiguous(array, name)
        return self._buffer(array)

    def _buffer(self, array: pyopencl.array.Array) -> int:
        """A buffer that has an array at its begin, and nothing else that the call reads."""
        handle = _handle(array)
        if handle == 0 or (array.offset == 0 and all(handle != _handle(a) for a in self._arrays)):
            self.reads(array)
            return handle
        cl = import_pyopencl()
        copy = cl.array.Array(self.queue, array.shape, array.dtype)
        copied = cl.enqueue_copy(
            self.queue,
            copy.base_data,
            array.base_data,
            src_offset=array.offset,
            byte_count=array.nbytes,
            wait_for=self._wait_for + array.events,
        )
        array.add_event(copied)
        copy.add_event(copied)
        self.reads(copy)
        return _handle(copy)

    def run(self, work: Callable[..., _Result], *given: Any) -> tuple[_Result, pyopencl.Event]:
        """What a call of the library makes of what is given, and the call's event.

        To be called when all that is read is known. The arrays that it reads know the event from then on.
        """
        events = self._wait_for + [event for array in self._arrays for event in array.events]
        handles = [int(event.int_ptr) for event in events]
        enqueue = _calls.Enqueue(int(self.queue.int_ptr), handles)
        result = work(*given, enqueue)
        event = import_pyopencl().Event.from_int_ptr(enqueue.event, retain=False)
        for array in self._arrays:
            array.add_event(event)
        return result, event

    def array(
        self, shape: tuple[int, ...], dtype: npt.DTypeLike, work: Callable[..., int], *given: Any
    ) -> pyopencl.array.Array:
        """The array over a buffer that a call of the library makes."""
        buffer, event = self.run(work, *given)
        return view(buffer, shape, dtype, self.queue, event, retain=False)


def view(
    handle: int,
    shape: tuple[int, ...],
    dtype: npt.DTypeLike,
    queue: pyopencl.CommandQueue,
    event: pyopencl.Event,
    retain: bool = True,
) -> pyopencl.array.Array:
    """An array over a buffer, which is retained, or handed over if not."""
    cl = import_pyopencl()
    if 0 in shape:
        return cl.array.Array(queue, shape, dtype)
    data = cl.MemoryObject.from_int_ptr(handle, retain=retain)
    array = cl.array.Array(queue, shape, dtype, data=data)
    array.add_event(event)
    return array
