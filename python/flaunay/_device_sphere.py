"""Triangulations of points on a sphere in device memory, by pyopencl."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Optional

from flaunay import _calls
from flaunay._device_arrays import DeviceCall, Offsets, queue_for
from flaunay._surfaces import DeviceSurface, made_on_device

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array


class DeviceSpherical(DeviceSurface):
    """Triangulations of points on the unit sphere in device memory. `spherical_device` makes them.

    The arrays are views of buffers that flaunay made for this result.

    Attributes
    ----------
    points : pyopencl.array.Array
        The points that were given.
    places, simplices, neighbors, representatives : pyopencl.array.Array
        As those of `SphericalDelaunay`, with its shapes and types.
    simplex_offsets : ndarray of int64, shape (nsets + 1,)
        As of `SphericalDelaunay`, in host memory.
    event : pyopencl.Event
        Complete when the results are there. The arrays know it: what pyopencl does with them waits.
    """


def spherical_device(
    points: pyopencl.array.Array,
    queue: Optional[pyopencl.CommandQueue] = None,
    offsets: Offsets = None,
    wait_for: Optional[Sequence[pyopencl.Event]] = None,
) -> DeviceSpherical:
    """Triangulates points on the sphere in device memory into device memory.

    The host makes the triangles around the south pole, for which it reads the hull in the plane. If a
    point is at the south pole, it computes all.

    Parameters
    ----------
    points : pyopencl.array.Array, shape (n, 2) or (n, 3)
        Longitudes and latitudes, or x, y and z, as of `spherical`. C-contiguous float64 or float32.
    queue, offsets, wait_for : optional
        As of `triangulate_device`.

    Returns
    -------
    DeviceSpherical

    Raises
    ------
    UsageError, InputError, DeviceError, ImportError
        As of `triangulate_device` and `spherical`.

    Examples
    --------
    >>> import flaunay
    >>> import numpy as np
    >>> import pyopencl as cl
    >>> import pyopencl.array
    >>> queue = cl.CommandQueue(cl.create_some_context(interactive=False))
    >>> points = cl.array.to_device(queue, np.array([[0, 0], [120, 0], [240, 0], [0, 90.0]]))
    >>> flaunay.spherical_device(points).simplices
    cl.Array([[1, 2, 3],
           [0, 3, 2],
           [0, 1, 3],
           [0, 2, 1]], dtype=int32)
    """
    call = DeviceCall(queue_for(points, queue, "points"), wait_for)
    device_points = call.points(points, offsets, "points", widths=(2, 3))
    _, members = made_on_device(call, device_points.lie_in(_calls.sphere(int(points.shape[1]))))
    return DeviceSpherical(points=points, **members)
