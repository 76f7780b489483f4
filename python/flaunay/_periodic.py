"""Points on a torus or a cylinder: a plane that repeats itself in x and y, or in one of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import ArrayLike, as_floats, as_offsets, as_points, frozen, hint_for
from flaunay._cells import ClippedVoronoi
from flaunay._device_arrays import DeviceCall, Offsets, queue_for
from flaunay._errors import UsageError
from flaunay._surface_edges import WithEdges
from flaunay._surfaces import DeviceSurface, Doubles, Indices, as_weights, made_on_device

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array


def _as_queries(given: ArrayLike) -> Doubles:
    queries = np.asarray(as_floats(given, "xi"), np.float64)
    if queries.ndim == 0 or queries.shape[-1] != 2:
        hint = hint_for(queries.shape, "xi")
        raise UsageError(f"xi must have the shape (..., 2), not {queries.shape}{hint}")
    return queries


class PeriodicDelaunay(WithEdges):
    """Delaunay triangulations of points on a torus or a cylinder, or with weights regular ones. `periodic` makes them.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, 2)
        The points as they were given.
    weights : ndarray of float64, shape (npoints,), or None
        Their weights, as of `WeightedDelaunay`. Then `cells` are power cells, and `interpolate` is linear or
        "clough-tocher" among points that are not hidden.
    hidden : ndarray of int32, shape (nhidden,)
        As of `WeightedDelaunay`. Without weights there are none.
    period : tuple of float
        Where the plane begins again, in x and in y; infinite if it does not. As given, but for the last bit
        of a double, which is 0 unless the period is a power of two. The shear is third, if there is one, and
        more than -x / 2 and at most x / 2.
    places : ndarray of float64, shape (npoints, 2)
        The points in [0, period), rounded once to multiples of the period's last bit but one: this is what
        they are. What has no period is not rounded.
    simplices : ndarray of int32, shape (nsimplex, 3)
        The corners of triangles, counter-clockwise. A set of n different points has 2 n, and on a cylinder
        2 n - h, if h of them are on its lowest and its highest circle.
    corner_offsets : ndarray of int8, shape (nsimplex, 3, 2)
        In which period each corner is, if the first one is at its place: -1, 0 or 1, and with a shear from -2
        to 2 unless x is longer than y. They tell apart corners that are the same point, as few points have
        them.
    neighbors : ndarray of int32, shape (nsimplex, 3)
        The triangle opposite to each corner; -1 beyond the ends of a cylinder.
    representatives : ndarray of int32, shape (npoints,)
        The smallest index of a point of the set with the same place.
    simplex_offsets : ndarray of int64, shape (nsets + 1,)
        Set s has the triangles ``simplices[simplex_offsets[s]:simplex_offsets[s + 1]]``.
    """

    hidden: Indices
    _names = WithEdges._names | {"hidden": "hidden"}

    def __init__(
        self,
        points: Doubles,
        period: tuple[float, ...],
        offsets: Optional[npt.NDArray[np.int64]],
        weights: Optional[Doubles],
        device: Optional[str],
    ) -> None:
        space = _calls.space_of("torus", period, weights=weights)
        super().__init__((points, period, offsets, weights, device), space, offsets)
        self.period: tuple[float, ...] = as_period(self._handle.period())
        self.weights = weights

    @cached_property
    def corner_offsets(self) -> npt.NDArray[np.int8]:
        """In which period each corner of a triangle is, shape (nsimplex, 3, 2)."""
        return frozen(self._made["corner_offsets"].reshape(-1, 3, 2))

    @cached_property
    def cells(self) -> ClippedVoronoi:
        """The Voronoi cells on the torus, or with weights the power cells, computed when they are first asked for.

        Each cell is around its point's place, so that some reach beyond the period, whose box is the
        ``bounds``. Vertices are rounded, so that all cells that share one have exact images of it; those
        that coincide but for that are one. The areas of a set's cells sum to that of the period. Points
        that another one represents have no vertices. On a cylinder this is a UsageError: cells there have
        no end.

        Examples
        --------
        >>> import flaunay
        >>> cells = flaunay.periodic([[0.25, 0.5], [0.75, 0.5]], (1, 1)).cells
        >>> cells.areas.tolist()
        [0.5, 0.5]
        >>> sorted(set(map(tuple, cells.polygon(0).tolist())))
        [(0.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.5, 1.0)]
        """
        across, up = self.period[:2]
        box = np.array([[0, 0], [across, 0], [across, up], [0, up]])
        return ClippedVoronoi(**self._handle.clipped_cells(self._triangulator, self.weights), bounds=box)

    @cached_property
    def corners(self) -> Doubles:
        """Where the corners of triangles are, shape (nsimplex, 3, 2): the first one in [0, period).

        Examples
        --------
        >>> import flaunay, numpy as np
        >>> points = np.random.default_rng(1).random((200, 2))
        >>> tri = flaunay.periodic(points, (1, 1))
        >>> (a, b), (c, d) = (tri.corners[:, 1:] - tri.corners[:, :1]).transpose(1, 2, 0)
        >>> ((a * d - b * c) / 2).sum().round(12).item()
        1.0
        """
        return frozen(self.places[self.simplices] + self.corner_offsets @ self._vectors)

    @property
    def _vectors(self) -> Doubles:
        """The vectors by which the plane repeats itself; 0 where it does not."""
        across, up, shear = [*self.period, 0.0][:3]
        vectors: Doubles = np.array([[across, 0.0], [shear, up]])
        vectors[:, ~np.isfinite([across, up])] = 0.0
        return vectors

    def _along(self, triangle: Any, first: Any, second: Any) -> npt.NDArray[np.int64]:
        """From a corner of each triangle to another one: their points, and the periods between them."""
        corners = first, second
        points = [self.simplices[triangle, corner] for corner in corners]
        periods = [self.corner_offsets[triangle, corner].astype(np.int64) for corner in corners]
        return np.column_stack([*points, periods[1] - periods[0]])

    def _between(self, triangle: Any, first: Any, second: Any) -> Doubles:
        """The vectors from corners of triangles to others."""
        along = self._along(triangle, first, second)
        vectors: Doubles = (
            self.places[along[:, 1]] - self.places[along[:, 0]] + along[:, 2:] @ self._vectors
        )
        return vectors

    def _centres_from(self, triangle: Any, corner: Any) -> Doubles:
        """The centres of the circles of triangles, from a corner; with weights, the points of equal power."""
        others = (corner + 1) % 3, (corner + 2) % 3
        b, c = (self._between(triangle, corner, other) for other in others)
        squares = [(side * side).sum(axis=1) for side in (b, c)]
        if self.weights is not None:
            at, *beyond = (self.weights[self.simplices[triangle, k]] for k in (corner, *others))
            squares = [square + at - weight for square, weight in zip(squares, beyond)]
        twice = 2 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
        x = c[:, 1] * squares[0] - b[:, 1] * squares[1]
        y = b[:, 0] * squares[1] - c[:, 0] * squares[0]
        centres: Doubles = np.stack([x, y], axis=1) / twice[:, None]
        return centres

    @cached_property
    def edge_vectors(self) -> Doubles:
        """From the first point of each of `edges` to the image of the second that is at its end, shape (e, 2).

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.periodic([[0.25, 0.5], [0.75, 0.5]], (1, 1))
        >>> tri.edge_vectors[(tri.edges == [0, 1]).all(axis=1) & (tri.ridge_lengths > 0)].tolist()
        [[-0.5, 0.0], [0.5, 0.0]]
        """
        return frozen(self._between(self._sides[0], *self._ends))

    def _lengths_of_edges(self) -> Doubles:
        lengths: Doubles = np.hypot(*self.edge_vectors.T)
        return lengths

    def _lengths_of_ridges(self) -> Doubles:
        triangle, corner = self._sides
        beyond = self.neighbors[triangle, corner]
        first, second = (corner + 1) % 3, (corner + 2) % 3
        along = self._along(triangle, first, second)
        # The end of the same side in the triangle beyond. Few points have triangles with several common sides.
        end = np.zeros_like(corner)
        for k in range(3):
            ends = (k + 2) % 3, (k + 1) % 3
            found = (self._along(beyond, *ends) == along).all(axis=1) & (self.neighbors[beyond, k] == triangle)
            end[found] = ends[0]
        ridges = self._centres_from(beyond, end) - self._centres_from(triangle, first)
        return np.where(beyond < 0, np.inf, np.hypot(*ridges.T))

    def _areas(self) -> Doubles:
        triangle = np.arange(self.nsimplex)
        b, c = (self._between(triangle, 0, k) for k in (1, 2))
        return (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]) / 2

    def neighborhoods(self) -> tuple[Indices, Indices, Doubles, Doubles]:
        """What each point sees around it, as models of foams and vertex models need it.

        Returns
        -------
        indptr : ndarray of int32, shape (npoints + 1,)
            Point i has the rows ``indptr[i]`` to ``indptr[i + 1]`` of the others, counter-clockwise.
        indices : ndarray of int32, shape (2 e,)
            Its neighbors; with few points some several times, and itself.
        vectors : ndarray of float64, shape (2 e, 2)
            From the point to the image of its neighbor, also across the border.
        ridge_lengths : ndarray of float64, shape (2 e,)
            As `ridge_lengths`.

        Examples
        --------
        >>> import flaunay, numpy as np
        >>> tri = flaunay.periodic(np.random.default_rng(1).random((100, 2)), (1, 1))
        >>> indptr, indices, vectors, ridges = tri.neighborhoods()
        >>> float(np.diff(indptr).mean())
        6.0
        >>> areas = np.add.reduceat(ridges * np.hypot(*vectors.T), indptr[:-1]) / 4
        >>> bool(np.allclose(areas, tri.cells.areas))
        True
        """
        ends = np.concatenate([self.edges, self.edges[:, ::-1]])
        vectors = np.concatenate([self.edge_vectors, 0.0 - self.edge_vectors])
        order = np.lexsort((np.arctan2(vectors[:, 1], vectors[:, 0]), ends[:, 0]))
        indptr = np.zeros(self.npoints + 1, np.int32)
        np.cumsum(np.bincount(ends[:, 0], minlength=self.npoints), out=indptr[1:])
        return indptr, ends[order, 1], vectors[order], np.tile(self.ridge_lengths, 2)[order]

    _as_queries = staticmethod(_as_queries)


def as_lengths(period: Sequence[Optional[float]]) -> tuple[float, ...]:
    """Two lengths, of which None is infinite, and a shear."""
    if not isinstance(period, (Sequence, np.ndarray)) or len(period) not in (2, 3):
        raise UsageError(
            "period must be two lengths, in x and y, of which None is for no period, and perhaps a shear; "
            f"not {period!r}"
        )
    given = [np.inf if length is None else length for length in period]
    lengths = np.asarray(as_floats([*given, 0.0][:3], "period"), np.float64)
    return tuple(lengths.tolist())


def as_period(lengths: Sequence[float]) -> tuple[float, ...]:
    """Without a shear that is 0."""
    return tuple(lengths if lengths[2] else lengths[:2])


def to_places(
    points: ArrayLike, period: Sequence[Optional[float]]
) -> npt.NDArray[np.float64]:
    """Takes points into a period, as `periodic` and `triangulate_chunks` do.

    Parameters
    ----------
    points : array_like, shape (..., 2)
        Any points.
    period : sequence of float or None
        As of `periodic`.

    Returns
    -------
    ndarray of float64, shape (..., 2)
        As `PeriodicDelaunay.places`.

    Raises
    ------
    UsageError, InputError
        As of `periodic`.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.to_places([[5, -1], [2.5, 7]], (2, None))
    array([[ 1. , -1. ],
           [ 0.5,  7. ]])
    """
    places = np.array(as_floats(points, "points"), np.float64, order="C")
    if places.ndim == 0 or places.shape[-1] != 2:
        hint = hint_for(places.shape, "points")
        raise UsageError(f"points must have the shape (..., 2), not {places.shape}{hint}")
    _calls.take_to_places(as_lengths(period), places)
    return places


def periodic(
    points: ArrayLike,
    period: Sequence[Optional[float]],
    offsets: Optional[npt.ArrayLike] = None,
    *,
    weights: Optional[ArrayLike] = None,
    device: Optional[str] = None,
) -> PeriodicDelaunay:
    """Triangulates points in a plane that repeats itself, such as particles in a periodic box.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Any points, which are taken into the period.
    period : sequence of float or None
        Where the plane begins again, in x and in y: from 2^-900 to 2^900 (about 1.2e-271 to 8.4e270), and
        neither more than 2^30 times the other. None, or infinity, for one of them: it does not. A third number
        is a shear: the period in y moves places along x by it. Then x is at most 64 times y.
    offsets : array_like of int, optional
        Where sets begin: set s has the points ``offsets[s]`` to ``offsets[s + 1]``. By default all points
        are one set.
    weights : array_like, shape (n,), optional
        As of `weighted`: squared lengths, such as squared radii of particles.
    device : str, optional
        As of `triangulate`.

    Returns
    -------
    PeriodicDelaunay

    Raises
    ------
    UsageError
        For a wrong shape, a period beyond these limits, and offsets that decrease or do not go from 0 to n.
    InputError
        For a point that is not finite, and for weights as of `weighted`.
    DeviceError
        As of `triangulate`.

    Notes
    -----
    Points are triangulated in the plane, with images of those near the border. Images are not rounded, so the
    result is exact. Any points do, however few: it is the Delaunay triangulation of all images of all points,
    of which it has each triangle once. O(n log n).

    Examples
    --------
    >>> import flaunay, numpy as np
    >>> points = np.random.default_rng(1).random((1000, 2))
    >>> tri = flaunay.periodic(points, (1, 1))
    >>> tri
    <flaunay.PeriodicDelaunay: 1000 points, 2000 triangles>
    >>> tri.cells.areas.sum().round(12).item()
    1.0
    >>> flaunay.periodic(points, (1, None)).nsimplex
    1998
    >>> flaunay.periodic([[0, 0], [2, 0]], (4, 4), weights=[0, 2]).cells.areas.tolist()
    [4.0, 12.0]
    """
    given = np.asarray(as_points(points), np.float64)
    lengths, of_points = as_lengths(period), None if weights is None else as_weights(weights, len(given))
    sets = None if offsets is None else as_offsets(offsets)
    return PeriodicDelaunay(frozen(given.copy()), lengths, sets, of_points, device)


@dataclass(frozen=True, eq=False, repr=False)
class DevicePeriodic(DeviceSurface):
    """Triangulations on a torus or a cylinder in device memory. `periodic_device` makes them.

    The arrays are views of buffers that flaunay made for this result.

    Attributes
    ----------
    points : pyopencl.array.Array
        The points that were given.
    places, simplices, corner_offsets, neighbors, representatives : pyopencl.array.Array
        As those of `PeriodicDelaunay`, with its shapes and types.
    period : tuple of float
        As of `PeriodicDelaunay`.
    simplex_offsets : ndarray of int64, shape (nsets + 1,)
        As of `PeriodicDelaunay`, in host memory.
    event : pyopencl.Event
        Complete when the results are there. The arrays know it: what pyopencl does with them waits.
    """

    corner_offsets: pyopencl.array.Array
    period: tuple[float, ...]


def periodic_device(
    points: pyopencl.array.Array,
    period: Sequence[Optional[float]],
    queue: Optional[pyopencl.CommandQueue] = None,
    offsets: Offsets = None,
    wait_for: Optional[Sequence[pyopencl.Event]] = None,
) -> DevicePeriodic:
    """Triangulates points in device memory as `periodic` does, into device memory.

    Parameters
    ----------
    points : pyopencl.array.Array, shape (n, 2)
        As of `triangulate_device`.
    period : sequence of float or None
        As of `periodic`.
    queue, offsets, wait_for : optional
        As of `triangulate_device`.

    Returns
    -------
    DevicePeriodic

    Raises
    ------
    UsageError, InputError, DeviceError, ImportError
        As of `periodic` and `triangulate_device`.

    Examples
    --------
    >>> import flaunay
    >>> import numpy as np
    >>> import pyopencl as cl
    >>> import pyopencl.array
    >>> queue = cl.CommandQueue(cl.create_some_context(interactive=False))
    >>> points = cl.array.to_device(queue, np.random.default_rng(1).random((1000, 2)))
    >>> flaunay.periodic_device(points, (1, 1))
    <flaunay.DevicePeriodic: 1000 points, 2000 triangles>
    """
    call = DeviceCall(queue_for(points, queue, "points"), wait_for)
    device_points, space = call.points(points, offsets, "points"), _calls.space_of("torus", as_lengths(period))
    made, members = made_on_device(call, device_points.lie_in(space), "corner_offsets")
    members["corner_offsets"] = members["corner_offsets"].reshape(-1, 3, 2)
    return DevicePeriodic(points=points, period=as_period(made.period), **members)
