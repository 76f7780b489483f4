"""Triangulations of points in host memory."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, FloatArray, as_offsets, as_points, summary
from flaunay._declarations import TriangulationArrays
from flaunay._errors import UsageError

_Kind = TypeVar("_Kind", bound="Triangulation")

_MODES_ON_HOST = {mode["name"] for mode in _calls.modes() if mode["on_host"]}


# Without __eq__ and __repr__ of all fields: arrays have no single truth value, and can be long.
@dataclass(frozen=True, eq=False, repr=False)
class Triangulation(TriangulationArrays):
    """The triangulations of one or more sets of points.

    All indices of points are those of the input, over all sets; indices of triangles count over all
    sets too.

    Attributes
    ----------
    triangles : ndarray of int32, shape (m, 3)
        Three points each, counter-clockwise, the smallest index first.
    neighbors : ndarray of int32, shape (m, 3), or None
        The triangle opposite to each corner, -1 beyond the hull; None if not asked for.
    halfedges : ndarray of int32, shape (3 m,), or None
        Halfedge ``3 t + k`` goes from corner k of triangle t to the next one; here is the halfedge
        that goes back, in the triangle beyond, or -1 on the hull. None if not asked for.
    hull : ndarray of int32, shape (h,)
        The convex hull with the points on its edges, counter-clockwise from the lexicographically
        smallest point. Of collinear points all distinct ones, in lexicographic order.
    representatives : ndarray of int32, shape (n,)
        For each point the smallest index of an equal point of its set. Only those are in triangles.
    areas : ndarray of float64, shape (m,), or None
        The area of each triangle, the float64 next to the exact one: positive, unless it is below
        2**-1075. None if not asked for.
    triangle_offsets, hull_offsets : ndarray of int64, shape (sets + 1,)
        Set s has the triangles ``triangle_offsets[s]`` to ``triangle_offsets[s + 1]``, and likewise
        hull vertices.
    statistics : dict
        How it came about: ``device``, ``seconds``, ``device_bytes_peak`` and others. ``note`` says what a
        device without double precision has left to the host, and is empty otherwise.
    """

    triangle_offsets: npt.NDArray[np.int64]
    hull_offsets: npt.NDArray[np.int64]
    statistics: dict[str, Any]

    if not TYPE_CHECKING:

        def __getattr__(self, name):
            """What the library has made, and nobody has asked for before."""
            made = self.__dict__.get("_made")
            if made is None or name not in self.__dataclass_fields__:
                return object.__getattribute__(self, name)  # its error
            return self.__dict__.setdefault(name, made[name])

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.__dataclass_fields__]

    def __getstate__(self) -> dict[str, Any]:
        own = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return {**self.__dict__, **own, "_made": None}

    def __repr__(self) -> str:
        return summary(
            self,
            points=len(self.representatives),
            triangles=len(self.triangles),
            hull_vertices=len(self.hull),
            sets=len(self.hull_offsets) - 1,
        )


    def _contiguous_arrays(self) -> dict[str, Any]:
        """All arrays, by their names, as the library takes them."""
        return {
            field.name: np.ascontiguousarray(array)
            for field in fields(self)
            if isinstance(array := getattr(self, field.name), np.ndarray)
        }


def verify(
    points: ArrayLike, triangulation: Triangulation, offsets: Optional[npt.ArrayLike] = None
) -> None:
    """Checks exactly that this is the canonical Delaunay triangulation of these points, with all of its arrays.

    Triangulations that keep their points have a method of this name, also those with constraints. The check shares
    no predicate with what makes triangulations.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        What was triangulated.
    triangulation : Triangulation
    offsets : array_like of int, optional
        As of `triangulate`.

    Raises
    ------
    InternalError
        If it is not; the message says what is wrong.
    UsageError
        For arrays that are none of these points, and for what is no plain triangulation.

    Notes
    -----
    O(n log n), on one thread.

    Examples
    --------
    >>> import flaunay
    >>> points = [[0, 0], [4, 0], [4, 3], [0, 4]]
    >>> mesh = flaunay.triangulate(points)
    >>> flaunay.verify(points, mesh)
    >>> mesh.triangles[0] = 0, 1, 3
    >>> flaunay.verify(points, mesh)  # doctest: +IGNORE_EXCEPTION_DETAIL
    Traceback (most recent call last):
    InternalError: triangle 0 has no neighbor at an edge inside
    """
    if not isinstance(triangulation, Triangulation) or hasattr(triangulation, "verify"):
        hint = ": take its method verify" if hasattr(triangulation, "verify") else ""
        kind = type(triangulation).__name__
        raise UsageError(f"triangulation must be one that triangulate makes without segments, not {kind}{hint}")
    given = np.asarray(as_points(points), np.float64)
    sets = None if offsets is None else as_offsets(offsets)
    _calls.verify(given, sets, triangulation._contiguous_arrays())


def with_arrays(kind: type[_Kind], made: _calls.Made, **others: Any) -> _Kind:
    """A triangulation that has what the library has made, and other attributes."""
    mesh = object.__new__(kind)
    mesh.__dict__.update(others, _made=made)
    return mesh


def arrays_of_mesh(
    coordinates: FloatArray,
    offsets: Optional[npt.NDArray[np.int64]],
    wanted: set[str],
    device: Optional[str],
    mode: str,
) -> _calls.Made:
    """What a `Triangulation` consists of, by its names. wanted: the optional arrays to compute."""
    if not isinstance(mode, str):
        names = ", ".join(row["name"] for row in _calls.modes())
        raise UsageError(f"there is no mode {mode!r}; there are {names}")
    if mode in _MODES_ON_HOST:
        if device is not None:
            raise UsageError(f"mode {mode} runs on the host and takes no device")
        doubles = np.asarray(coordinates, dtype=np.float64)
        return _calls.triangulate(None, doubles, offsets, mode, wanted)
    triangulator = _triangulators.of_device(device)
    return _calls.triangulate(triangulator, coordinates, offsets, mode, wanted)


def modes() -> list[dict[str, Any]]:
    """Every mode of `triangulate`, the default first.

    Returns
    -------
    list of dict
        For each mode its ``name``, a ``description`` of one line, and ``on_host``: whether it runs on
        the host, without a device.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.modes()[0]["name"]
    'blocks'
    """
    return _calls.modes()
