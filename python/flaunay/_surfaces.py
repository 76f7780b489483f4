"""What triangulations on a sphere, on a torus and of weighted points have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, ClassVar, Literal, Optional, Union, overload

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, as_floats, as_iterations, as_offsets, frozen, number_of, summary
from flaunay._declarations import INTERPOLATION
from flaunay._device_arrays import DeviceCall, view
from flaunay._errors import UsageError
from flaunay._queries import Kept, count_and_bound

if TYPE_CHECKING:
    import pyopencl
    import pyopencl.array

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


def as_weights(given: ArrayLike, n: int) -> Doubles:
    """A copy of the weights of n points."""
    weights = np.array(as_floats(given, "weights"), np.float64)
    if weights.shape != (n,):
        raise UsageError(f"weights must have the shape ({n},), one per point, not {weights.shape}")
    return frozen(weights)


class OfPoints:
    """A result that is a function of what was given: the arguments of its class, the device last.

    Its arrays are those that the library has made, each read when it is first asked for.
    """

    points: Doubles
    simplices: Indices
    neighbors: Indices
    representatives: Indices
    simplex_offsets: npt.NDArray[np.int64]
    _given: tuple[Any, ...]
    _handle: _calls.InSpace
    _made: _calls.Made
    # The library's name of each array.
    _names: ClassVar[dict[str, str]] = {
        "simplices": "triangles",
        "neighbors": "neighbors",
        "representatives": "representatives",
        "simplex_offsets": "triangle_offsets",
    }

    def __init__(self, given: tuple[Any, ...], space: Any, offsets: Optional[npt.NDArray[np.int64]]) -> None:
        self._given, self.points = given, given[0]
        self._handle = _calls.InSpace(self._triangulator, self.points, offsets, space)
        self._made = self._handle.arrays()

    if not TYPE_CHECKING:

        def __getattr__(self, name):
            if name not in self._names:
                return object.__getattribute__(self, name)  # its error
            return self.__dict__.setdefault(name, frozen(self._made[self._names[name]]))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._names]

    def __repr__(self) -> str:
        return summary(self, points=self.npoints, triangles=self.nsimplex)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._given

    @property
    def _triangulator(self) -> _calls.Triangulator:
        return _triangulators.of_device(self._given[-1])

    @property
    def npoints(self) -> int:
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        return len(self.simplices)

    def verify(self) -> None:
        """Checks exactly that this is the canonical triangulation of its points in their space, with their weights.

        Raises
        ------
        InternalError
            If it is not; the message says what is wrong.
        """
        self._handle.verify()


class WithLocator(OfPoints):
    """One that answers queries, by a locator and a tree that are made when they are first needed."""

    places: Doubles
    _names = OfPoints._names | {"places": "places"}
    weights: Optional[Doubles] = None

    def __init__(self, given: tuple[Any, ...], space: Any, offsets: Optional[npt.NDArray[np.int64]]) -> None:
        super().__init__(given, space, offsets)
        self._kept_locator: Kept[_calls.SpaceLocator] = Kept()
        self._kept_tree: Kept[_calls.PointTree] = Kept()

    @property
    def _locator(self) -> _calls.SpaceLocator:
        return self._kept_locator.get(lambda: _calls.SpaceLocator(self._triangulator, self._handle, self.weights))

    @property
    def _tree(self) -> _calls.PointTree:
        return self._kept_tree.get(lambda: _calls.PointTree.in_space(self._triangulator, self._handle))

    def _find(
        self,
        queries: Doubles,
        offsets: Optional[npt.ArrayLike],
        search: Callable[[_calls.SpaceLocator, Doubles, Optional[npt.NDArray[np.int64]]], Indices],
    ) -> Indices:
        """What a method of the locator finds. Queries are checked before there is one."""
        sets = None if offsets is None else as_offsets(offsets)
        found = search(self._locator, queries.reshape(-1, queries.shape[-1]), sets)
        return found.reshape(queries.shape[:-1])

    @staticmethod
    def _as_queries(given: ArrayLike) -> Doubles:
        """Queries as they are taken, checked."""
        raise NotImplementedError

    def find_simplex(self, xi: ArrayLike, *, offsets: Optional[npt.ArrayLike] = None) -> Indices:
        """Triangles that contain points, exactly; on the sphere their sides are arcs of great circles.

        Parameters
        ----------
        xi : array_like, shape (..., 2), or on the sphere also (..., 3)
            Any places of the plane, or longitudes and latitudes in degrees, or x, y and z.
        offsets : array_like of int, optional
            Needed for several sets: set s has the queries ``offsets[s]`` to ``offsets[s + 1]``.

        Returns
        -------
        ndarray of int32, shape (...)
            On an edge or at a corner always the same triangle, on the sphere that of the smallest index; -1 beyond the
            ends of a cylinder, and beyond points that lie within a hemisphere.

        Raises
        ------
        UsageError, InputError
            As of `periodic` or `spherical`; UsageError for another number of sets, too.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.periodic([[0, 0], [1, 2], [3, 1]], (4, 4))
        >>> tri.find_simplex([[0.5, 0.5], [4.5, -7.5]])
        array([5, 5], dtype=int32)
        >>> globe = flaunay.spherical([[0, 0], [90, 0], [0, 90]])
        >>> globe.find_simplex([[10, 20], [190, -20]])
        array([ 0, -1], dtype=int32)
        """
        return self._find(self._as_queries(xi), offsets, _calls.SpaceLocator.locate)

    @overload
    def nearest(
        self,
        xi: ArrayLike,
        *,
        k: Optional[int] = None,
        distance_upper_bound: Optional[float] = None,
        return_distances: Literal[False] = False,
        offsets: Optional[npt.ArrayLike] = None,
    ) -> Indices: ...
    @overload
    def nearest(
        self,
        xi: ArrayLike,
        *,
        k: Optional[int] = None,
        distance_upper_bound: Optional[float] = None,
        return_distances: Literal[True],
        offsets: Optional[npt.ArrayLike] = None,
    ) -> tuple[Doubles, Indices]: ...
    def nearest(
        self,
        xi: ArrayLike,
        *,
        k: Optional[int] = None,
        distance_upper_bound: Optional[float] = None,
        return_distances: bool = False,
        offsets: Optional[npt.ArrayLike] = None,
    ) -> Union[Indices, tuple[Doubles, Indices]]:
        """The points that are nearest to others, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., 2), or on the sphere also (..., 3)
            Any places of the plane, or longitudes and latitudes in degrees, or x, y and z.
        k, distance_upper_bound, return_distances
            As of `Delaunay.nearest`. On a torus each point counts once, as it lies nearest; on the sphere distances
            are angles in radians.
        offsets
            As of `find_simplex`. Several points and distances are found in one set alone.

        Returns
        -------
        ndarray of int32, shape (...) or (..., k), or distances and these
            Of several equally near the first one in the order of x, then y: as they lie around the query's place, or
            on the sphere the south pole and then by places. -1 if there are no more points.

        Raises
        ------
        UsageError, InputError
            As of `find_simplex`.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.periodic([[0, 0], [1, 2], [3, 1]], (4, 4))
        >>> tri.nearest([[3.75, 3.75], [9, 10]])
        array([0, 1], dtype=int32)
        >>> tri.nearest([3.75, 3.75], k=2, return_distances=True)[1]
        array([0, 2], dtype=int32)
        >>> globe = flaunay.spherical([[179, 0], [-150, 0], [0, 90], [0, -90]])
        >>> globe.nearest([[-175, 10], [60, 80]])
        array([0, 2], dtype=int32)
        >>> globe.nearest([-175, 10], k=2)
        array([0, 1], dtype=int32)
        """
        queries = self._as_queries(xi)
        is_plain = k is None and distance_upper_bound is None and not return_distances
        if is_plain and self.weights is None:
            return self._find(queries, offsets, _calls.SpaceLocator.nearest)
        if offsets is not None and not is_plain:
            raise UsageError("offsets: several points and distances are found in one set alone")
        count, most = count_and_bound(k, distance_upper_bound)
        shape = queries.shape[:-1] if k is None else (*queries.shape[:-1], count)
        rows = queries.reshape(-1, queries.shape[-1])
        found, distances = self._tree.nearest(rows, count, most)
        found = found.reshape(shape)
        return (distances.reshape(shape), found) if return_distances else found

    def _rows(self, values: ArrayLike) -> tuple[Doubles, tuple[int, ...]]:
        """Values as a row for each point, and their shape."""
        numbers = np.asarray(as_floats(values, "values"), np.float64)
        if numbers.ndim == 0 or len(numbers) != self.npoints:
            raise UsageError(
                f"values must have one row per point, {self.npoints}, not the shape {numbers.shape}"
            )
        return numbers.reshape(self.npoints, math.prod(numbers.shape[1:])), numbers.shape

    def interpolate(
        self,
        values: ArrayLike,
        xi: ArrayLike,
        method: Literal["linear", "nearest", "clough-tocher", "sibson", "laplace"] = "linear",
        *,
        gradients: Optional[ArrayLike] = None,
        offsets: Optional[npt.ArrayLike] = None,
    ) -> Doubles:
        """Values between points.

        Parameters
        ----------
        values : array_like, shape (npoints, ...)
            Real numbers. Of equal points, those of the representative count.
        xi : array_like, shape (..., 2), or on the sphere also (..., 3)
            As of `find_simplex`.
        method : {"linear", "nearest", "clough-tocher", "sibson", "laplace"}
            Linear in triangles, the value of the nearest point, by cubics with a continuous gradient, as
            `CloughTocherInterpolator`, or between natural neighbors, as `NaturalNeighborInterpolator`. On the sphere
            linear where the direction of a query meets its triangle in space, by cubics along great circles (Renka,
            1984), or between natural neighbors (Brown, 1994): by the areas that a query's cell would take from others,
            or by the lengths of its edges over distances.
        gradients : array_like, shape (npoints, ..., 2), or on the sphere (npoints, ..., 3), optional
            Those of the values, tangent to the sphere, for "clough-tocher"; None: as `gradients` estimates them.
        offsets
            As of `find_simplex`.

        Returns
        -------
        ndarray of float64, shape ``xi.shape[:-1] + values.shape[1:]``
            Continuous, also across the border, unless of the nearest points, and at a point that point's value. NaN
            where `find_simplex` says -1, but on the sphere of nearest points only in a set without points.

        Raises
        ------
        UsageError, InputError
            As of `find_simplex`; UsageError for another number of values than of points, and an unknown method;
            InputError for natural neighbors of so few points that a circle without points is wider than the shorter
            period.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.periodic([[0, 0], [1, 2], [3, 1]], (4, 4))
        >>> tri.interpolate([1, 2, 3], [[4, 0], [0.5, 1]])
        array([1. , 1.5])
        >>> globe = flaunay.spherical([[0, 0], [90, 0], [0, 90]])
        >>> globe.interpolate([1, 2, 3], [[45, 0], [0, 90]]).round(12)
        array([1.5, 3. ])
        >>> globe.interpolate([1, 2, 3], [45, 45], "laplace").round(3).item()
        2.154
        """
        queries = self._as_queries(xi)
        number_of({name.replace("_", "-"): k for name, k in INTERPOLATION.items()}, method, "method")
        sets = None if offsets is None else as_offsets(offsets)
        rows, shape = self._rows(values)
        slopes = None
        if gradients is not None:
            if method != "clough-tocher":
                raise UsageError(f"gradients are for the method 'clough-tocher', not {method!r}")
            slopes = np.asarray(as_floats(gradients, "gradients"), np.float64)
            if slopes.shape[:-1] != shape:
                raise UsageError(f"gradients must have one vector per value, not the shape {slopes.shape}")
            slopes = slopes.reshape(*rows.shape, slopes.shape[-1])
        asked = queries.reshape(-1, queries.shape[-1])
        found = self._locator.interpolate(rows, asked, sets, method.replace("-", "_"), slopes)
        return found.reshape(queries.shape[:-1] + shape[1:])

    def gradients(self, values: ArrayLike, tol: float = 1e-6, maxiter: int = 400) -> Doubles:
        """The gradients of values at the points that "clough-tocher" has if none are given.

        Parameters
        ----------
        values : array_like, shape (npoints, ...)
            As of `interpolate`.
        tol, maxiter
            As of `CloughTocherInterpolator`.

        Returns
        -------
        ndarray of float64, shape (npoints, ..., 2), or on the sphere (npoints, ..., 3)
            x and y, or a vector that is tangent to the sphere. NaN at points that another one represents, and in sets
            without triangles.

        Raises
        ------
        UsageError
            For another number of values than of points, and a tolerance of 0 or less.

        Examples
        --------
        >>> import flaunay, numpy as np
        >>> points = np.random.default_rng(1).random((1000, 2))
        >>> tri = flaunay.periodic(points, (1, 1))
        >>> slopes = tri.gradients(np.sin(2 * np.pi * points[:, 0]))
        >>> bool(np.allclose(slopes[:, 0], 2 * np.pi * np.cos(2 * np.pi * points[:, 0]), atol=0.5))
        True
        """
        iterations = as_iterations(maxiter, tol)
        rows, shape = self._rows(values)
        return self._locator.gradients(rows, tol, iterations).reshape(*shape, self._locator.axes)


@dataclass(frozen=True, eq=False, repr=False)
class DeviceSurface:
    """What triangulations in device memory have in all spaces but the plane."""

    points: pyopencl.array.Array
    places: pyopencl.array.Array
    simplices: pyopencl.array.Array
    neighbors: pyopencl.array.Array
    representatives: pyopencl.array.Array
    simplex_offsets: npt.NDArray[np.int64]
    event: pyopencl.Event

    def __repr__(self) -> str:
        triangles = int(self.simplex_offsets[-1])
        return summary(self, points=int(self.points.shape[0]), triangles=triangles)


def made_on_device(
    call: DeviceCall, points: _calls.DevicePoints, *names: str
) -> tuple[_calls.DeviceTriangulation, dict[str, Any]]:
    """Triangulates points in their space. Returns the members of a DeviceSurface, too, and arrays of these names."""
    triangulator = _triangulators.of_queue(call.queue)
    made, event = call.run(_calls.DeviceTriangulation, triangulator, points, set())
    members: dict[str, Any] = {
        name: view(*place, call.queue, event) for name, place in made.arrays_in_space(*names).items()
    }
    members["simplices"] = members.pop("triangles")
    return made, {**members, "simplex_offsets": made.triangle_offsets, "event": event}
