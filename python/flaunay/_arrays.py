"""What users hand over, as arrays that the library takes as they are."""

from __future__ import annotations

import sys
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from flaunay._errors import UsageError

FloatArray = Union[npt.NDArray[np.float32], npt.NDArray[np.float64]]

# From this size on, numbers of another type may have more digits than a double.
_BYTES_OF_DOUBLE = 8

_SINGULAR = {
    "points": "point",
    "triangles": "triangle",
    "hull_vertices": "hull vertex",
    "vertices": "vertex",
}


def _as_doubles(given: npt.NDArray[Any], name: str) -> npt.NDArray[np.float64]:
    """Other numbers as doubles; UsageError if they are none, or none of the same value."""
    if given.dtype.kind not in "biuf":
        raise UsageError(f"{name} must be real numbers, not {given.dtype}")
    with np.errstate(over="ignore", invalid="ignore"):
        doubles = given.astype(np.float64)
        if given.dtype.kind == "b" or given.dtype.itemsize < _BYTES_OF_DOUBLE:
            return doubles
        changed = (doubles.astype(given.dtype) != given) & ~np.isnan(doubles)
    if changed.any():
        place = tuple(int(i) for i in np.argwhere(changed)[0])
        raise UsageError(
            f"{name}{list(place)} = {given[place]} is not a float64: it would be rounded"
        )
    return doubles


def _as_array(given: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    """What numpy makes of it; UsageError, with numpy's words, if it cannot, as of a list of unequal rows."""
    try:
        return np.asarray(given)
    except ValueError as error:
        raise UsageError(f"{name} are no array of numbers: {error}") from error


def is_masked(given: object) -> bool:
    """Whether it is a masked array. NumPy imports its module, which takes milliseconds, when one is first made."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and isinstance(given, masked.MaskedArray)


def as_floats(given: npt.ArrayLike, name: str) -> FloatArray:
    """A C-contiguous, aligned array of float32 or float64, copied only if it is none already.

    Numbers of any other type become float64; those that are not exactly one are an error, and so is
    what is no real number, an array of objects included.
    """
    if is_masked(given):
        raise UsageError(f"{name} cannot be a masked array")
    array = _as_array(given, name)
    if array.size == 0 and array.dtype.kind == "O":
        array = array.astype(np.float64)
    if array.dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
        array = _as_doubles(array, name)
    return np.require(array, requirements=["C_CONTIGUOUS", "ALIGNED"])


def check_points_shape(points: FloatArray) -> None:
    """UsageError unless the shape is (n, 2)."""
    if points.ndim != 2:
        raise UsageError(f"points must have the shape (n, 2), not {points.shape}")
    if points.shape[1] != 2:
        raise UsageError(f"points must be two-dimensional, but have {points.shape[1]} coordinates")


def as_points(given: npt.ArrayLike) -> FloatArray:
    """Points of shape (n, 2); UsageError for any other shape."""
    points = as_floats(given, "points")
    check_points_shape(points)
    return points


def as_segments(given: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Offsets of sets; UsageError unless they are a list of integers."""
    array = _as_array(given, "segments")
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise UsageError(
            f"segments must be integers in one dimension, not {array.dtype} of shape {array.shape}"
        )
    return np.ascontiguousarray(array, dtype=np.int64)


def names_of(**wanted: bool) -> set[str]:
    """The names whose values are true."""
    return {name for name, is_wanted in wanted.items() if is_wanted}


def summary(result: object, sets: int = 1, **counts: int) -> str:
    """The repr of a result: its class, and how many it has of what, such as ``<flaunay.Delaunay: 4 points>``."""
    parts = [
        f"{count} {name.replace('_', ' ')}" if count != 1 else f"1 {_SINGULAR[name]}"
        for name, count in counts.items()
    ]
    if sets != 1:
        parts.append(f"{sets} sets")
    return f"<flaunay.{type(result).__name__}: {', '.join(parts)}>"
