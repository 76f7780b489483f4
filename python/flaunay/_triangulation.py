"""Triangulations of points in host memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from flaunay import _flaunay, _triangulators
from flaunay._arrays import (
    ArrayLike,
    FloatArray,
    as_points,
    as_offsets,
    check_out,
    names_of,
    summary,
)
from flaunay._errors import UsageError

Indices = npt.NDArray[np.int32]

# The shapes of the arrays that `out` can have; None is the number of rows.
_SHAPES: dict[str, tuple[Optional[int], ...]] = {
    "triangles": (None, 3),
    "neighbors": (None, 3),
    "halfedges": (None,),
    "hull": (None,),
    "representatives": (None,),
}

_MODES_ON_HOST = {mode["name"] for mode in _flaunay.modes() if mode["on_host"]}


# Without __eq__ and __repr__ of all fields: arrays have no single truth value, and can be long.
@dataclass(frozen=True, eq=False, repr=False)
class Triangulation:
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
    triangle_offsets, hull_offsets : ndarray of int64, shape (sets + 1,)
        Set s has the triangles ``triangle_offsets[s]`` to ``triangle_offsets[s + 1]``, and likewise
        hull vertices.
    statistics : dict
        How it came about: ``device``, ``seconds``, ``device_bytes_peak`` and others.
    """

    triangles: npt.NDArray[np.int32]
    neighbors: Optional[npt.NDArray[np.int32]]
    halfedges: Optional[npt.NDArray[np.int32]]
    hull: npt.NDArray[np.int32]
    representatives: npt.NDArray[np.int32]
    triangle_offsets: npt.NDArray[np.int64]
    hull_offsets: npt.NDArray[np.int64]
    statistics: dict[str, Any]

    def __repr__(self) -> str:
        return summary(
            self,
            points=len(self.representatives),
            triangles=len(self.triangles),
            hull_vertices=len(self.hull),
            sets=len(self.hull_offsets) - 1,
        )


def _attributes(out: object) -> dict[str, Any]:
    return {name: getattr(out, name, None) for name in _SHAPES}


def _arrays_of(
    out: Union[Mapping[str, Indices], Triangulation], wanted: set[str]
) -> dict[str, Indices]:
    """The arrays to write to; UsageError for one that nothing can be written to, or that nothing is written to."""
    given: Mapping[str, Any] = out if isinstance(out, Mapping) else _attributes(out)
    arrays = {name: array for name, array in given.items() if array is not None}
    for name, array in arrays.items():
        if name not in _SHAPES:
            raise UsageError(f"out has {name!r}; there are {', '.join(_SHAPES)}")
        if name in ("neighbors", "halfedges") and name not in wanted:
            raise UsageError(f"out has {name}, but {name}=False")
        check_out(array, np.int32, _SHAPES[name], f"out[{name!r}]")
    return arrays


def _write(result: dict[str, Any], arrays: dict[str, Indices]) -> None:
    """Copies results to the caller's arrays and has their first rows in place of them."""
    for name, array in arrays.items():
        rows = len(result[name])
        if len(array) < rows:
            raise UsageError(f"out[{name!r}] has {len(array)} rows, but there are {rows}")
    for name, array in arrays.items():
        view = array[: len(result[name])]
        view[...] = result[name]
        result[name] = view


def arrays_of_mesh(
    coordinates: FloatArray,
    offsets: Optional[npt.NDArray[np.int64]],
    wanted: set[str],
    device: Optional[str],
    mode: str,
) -> dict[str, Any]:
    """What a `Triangulation` consists of, by its names. wanted: the optional arrays to compute."""
    if not isinstance(mode, str):
        names = ", ".join(row["name"] for row in _flaunay.modes())
        raise UsageError(f"there is no mode {mode!r}; there are {names}")
    if mode in _MODES_ON_HOST:
        if device is not None:
            raise UsageError(f"mode {mode} runs on the host and takes no device")
        doubles = np.asarray(coordinates, dtype=np.float64)
        return _flaunay.triangulate_without_device(doubles, offsets, mode, wanted)
    triangulator = _triangulators.of_device(device)
    return triangulator.triangulate(coordinates, offsets, mode, wanted)


def triangulate(
    points: ArrayLike,
    offsets: Optional[npt.ArrayLike] = None,
    device: Optional[str] = None,
    neighbors: bool = True,
    halfedges: bool = False,
    mode: str = "blocks",
    out: Union[Mapping[str, Indices], Triangulation, None] = None,
) -> Triangulation:
    """Triangulates one set of points, or many sets in one call.

    Every triangle is exact, whatever the points: grids, duplicates, points on one line. Fewer than
    three distinct points, and points on one line, have no triangles; that is no error.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Coordinates. C-contiguous arrays of float64 and float32 are taken as they are; other numbers
        become float64, and must be one exactly.
    offsets : array_like of int, shape (sets + 1,), optional
        Set s has the points ``offsets[s]`` to ``offsets[s + 1]``. Begins with 0, does not decrease
        and ends with n. Without it, there is one set.
    device : str, optional
        A part of a device's or platform's name, ``"#k"``, the k-th of `devices`, or ``"host"`` for the
        host's cores without OpenCL. Without it, the one that the environment variable FLAUNAY_DEVICE
        names, else the first GPU with fp64, else the host. The results are the same.
    neighbors, halfedges : bool
        Which of these to compute.
    mode : str
        How to divide and conquer, by a name in `modes`. The triangles are the same in each mode; the
        order of the rows differs. Some modes run on the host and need no device.
    out : mapping of str to ndarray of int32, or an object with such attributes, optional
        Arrays for ``triangles``, ``neighbors``, ``halfedges``, ``hull`` and ``representatives``, or some of
        them, with as many rows as there are results or more. n points have fewer than 2 n triangles. The
        result has views of their first rows; it costs one copy.

    Returns
    -------
    Triangulation

    Raises
    ------
    UsageError
        For a wrong shape, what is no number, offsets that are none, an unknown mode, arrays in `out`
        that results cannot be written to.
    InputError
        For a point that is not finite, magnitudes too different to be exact, or too many points.
    DeviceError
        If there is no such device, or a call of OpenCL failed.

    Notes
    -----
    O(n log n) work. The interpreter's lock is released meanwhile.

    Examples
    --------
    >>> import flaunay
    >>> mesh = flaunay.triangulate([[0, 0], [4, 0], [4, 3], [0, 4]])
    >>> mesh
    <flaunay.Triangulation: 4 points, 2 triangles, 4 hull vertices>
    >>> mesh.triangles
    array([[0, 2, 3],
           [0, 1, 2]], dtype=int32)
    >>> mesh.neighbors
    array([[-1, -1,  1],
           [-1,  0, -1]], dtype=int32)

    Two sets at once, the second of them without triangles:

    >>> meshes = flaunay.triangulate([[0, 0], [1, 0], [0, 1], [5, 5], [6, 6]], offsets=[0, 3, 5])
    >>> meshes.triangle_offsets
    array([0, 1, 1])
    """
    coordinates = as_points(points)
    offsets = None if offsets is None else as_offsets(offsets)
    wanted = names_of(neighbors=neighbors, halfedges=halfedges)
    places = None if out is None else _arrays_of(out, wanted)
    result = arrays_of_mesh(coordinates, offsets, wanted, device, mode)
    if places:
        _write(result, places)
    return Triangulation(**result)


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
    return _flaunay.modes()
