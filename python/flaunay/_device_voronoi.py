"""Voronoi diagrams, their clipped cells, and relaxation in device memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import summary
from flaunay._cells import ClippedVoronoi, corners_of
from flaunay._device_arrays import DeviceCall, queue_for
from flaunay._relax import parts_of

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array


@dataclass(frozen=True, eq=False, repr=False)
class DeviceVoronoi:
    """The Voronoi diagram of points in device memory. `DeviceTriangulation.voronoi` makes it.

    It has a vertex for each triangle. All sets are in the same arrays, with indices over all sets.

    Attributes
    ----------
    vertices : pyopencl.array.Array of float64, shape (triangles, 2)
        The circumcentres of the triangles, as `Voronoi.vertices`.
    cells : pyopencl.array.Array of int32, shape (3 triangles,)
        Point i has the vertices ``cells[cell_offsets[i]:cell_offsets[i + 1]]``, as `Voronoi.cells`.
    cell_offsets : pyopencl.array.Array of int32, shape (npoints + 1,)
    unbounded : pyopencl.array.Array of uint8, shape (npoints,)
        1 for points that have unbounded cells: those of the hull.
    event : pyopencl.Event
        Complete when the results are there. The arrays know it: what pyopencl does with them waits.
    """

    vertices: pyopencl.array.Array
    cells: pyopencl.array.Array
    cell_offsets: pyopencl.array.Array
    unbounded: pyopencl.array.Array
    event: pyopencl.Event

    def __repr__(self) -> str:
        return summary(self, points=self.unbounded.size, vertices=int(self.vertices.shape[0]))


@dataclass(frozen=True, eq=False, repr=False)
class DeviceClippedVoronoi:
    """Clipped Voronoi cells in device memory. `DeviceTriangulation.clipped_voronoi` makes them.

    Attributes
    ----------
    vertices, offsets, areas, centroids : pyopencl.array.Array
        As those of `ClippedVoronoi`, with its shapes and types.
    bounds : ndarray of float64, shape (m, 2)
        The corners of the box or polygon, counter-clockwise, in host memory.
    event : pyopencl.Event
        Complete when the results are there. The arrays know it: what pyopencl does with them waits.
    """

    vertices: pyopencl.array.Array
    offsets: pyopencl.array.Array
    areas: pyopencl.array.Array
    centroids: pyopencl.array.Array
    bounds: npt.NDArray[np.float64]
    event: pyopencl.Event

    def __repr__(self) -> str:
        return summary(self, points=self.areas.size, vertices=int(self.vertices.shape[0]))

    def get(self) -> ClippedVoronoi:
        """Copies all to host memory, when it is there."""
        return ClippedVoronoi(
            self.vertices.get(),
            self.offsets.get(),
            self.areas.get(),
            self.centroids.get(),
            self.bounds,
        )


def relax_device(
    points: pyopencl.array.Array,
    bounds: Any,
    iterations: int = 1,
    queue: Optional[pyopencl.CommandQueue] = None,
    wait_for: Optional[Sequence[pyopencl.Event]] = None,
) -> pyopencl.array.Array:
    """Points in device memory, spread evenly by Lloyd's method. They stay there in all iterations.

    Parameters
    ----------
    points : pyopencl.array.Array, shape (n, 2)
        As of `triangulate_device`; they are not changed.
    bounds : array_like or shapely.Polygon
        As of `Voronoi.clipped`, in host memory.
    iterations : int, default 1
        How often the points move.
    queue, wait_for : optional
        As of `triangulate_device`.

    Returns
    -------
    pyopencl.array.Array of float64, shape (n, 2)
        As of `relax`. What pyopencl does with it waits for it.

    Raises
    ------
    UsageError, InputError, DeviceError, ImportError
        As of `triangulate_device` and `DeviceTriangulation.clipped_voronoi`.

    Examples
    --------
    >>> import flaunay
    >>> import numpy as np
    >>> import pyopencl as cl
    >>> import pyopencl.array
    >>> queue = cl.CommandQueue(cl.create_some_context(interactive=False))
    >>> points = cl.array.to_device(queue, np.array([[0, 0], [0.5, 0.5]]))
    >>> flaunay.relax_device(points, (0, 0, 4, 4), iterations=50).get().round(2)
    array([[1.33, 1.33],
           [2.67, 2.67]])
    """
    corners, queue = corners_of(bounds), queue_for(points, queue, "points")
    for part in parts_of(iterations):
        call = DeviceCall(queue, wait_for)
        given = call.points(points, None, "points")
        relax = (_calls.relax_device, _triangulators.of_queue(queue), given, corners, part)
        points, wait_for = call.array(points.shape, np.float64, *relax), None
    return points
