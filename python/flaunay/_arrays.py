"""What users hand over, as arrays that the library takes as they are."""

from __future__ import annotations

import operator
import sys
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, Protocol, TypeVar, Union

import numpy as np
import numpy.typing as npt

from flaunay._errors import UsageError
from flaunay._optional import optional

if TYPE_CHECKING:
    from typing_extensions import TypeGuard

FloatArray = Union[npt.NDArray[np.float32], npt.NDArray[np.float64]]
Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]
_Array = TypeVar("_Array", bound=npt.NDArray[Any])


class SupportsDLPack(Protocol):
    """An array of another library, as the array API standard has them."""

    def __dlpack__(self) -> Any: ...
    def __dlpack_device__(self) -> tuple[int, int]: ...


ArrayLike = Union[npt.ArrayLike, SupportsDLPack]


class Triangles(Protocol):
    """Triangles of points, as functions below the classes see them."""

    @property
    def points(self) -> FloatArray: ...
    @property
    def simplices(self) -> Indices: ...


class Searched(Protocol):
    """What queries need of a mesh."""

    @property
    def simplices(self) -> Indices: ...
    @property
    def neighbors(self) -> Indices: ...
    @property
    def hull(self) -> Indices: ...
    @property
    def _stand_ins(self) -> tuple[FloatArray, Indices]: ...


class Mesh(Searched, Triangles, Protocol):
    """A Delaunay triangulation, as functions below its class see it."""

    @property
    def representatives(self) -> Indices: ...

    edges: Indices
    edge_lengths: Doubles
    edge_simplices: Indices
    _edge_order: tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]
    vertex_neighbor_vertices: tuple[Indices, Indices]


_FLOATS = (np.dtype(np.float64), np.dtype(np.float32))

# From this size on, numbers of another type may have more digits than a double.
_BYTES_OF_DOUBLE = 8

# DLPack's numbers of the kinds of memory that the host can read: its own, pinned by CUDA, by ROCm, managed by CUDA.
_HOST_MEMORY = {1, 3, 11, 13}
_DEVICE_MEMORY = {
    2: "a CUDA device",
    4: "an OpenCL device",
    8: "a Metal device",
    10: "a ROCm device",
}

_INTERPOLATE = "call triangulate_device(...).locator().interpolate, or "
# What takes arrays of pyopencl as they are.
_DEVICE_CALLS = {
    "points": "call triangulate_device, or ",
    "xi": _INTERPOLATE,
    "values": _INTERPOLATE,
    "gradients": _INTERPOLATE,
}

# Rows of a part; a few arrays of so many doubles fit a processor's cache.
_ROWS = 1 << 14

_SINGULAR = {
    "hidden": "hidden",
    "values_per_point": "value per point",
    "pieces": "piece",
    "points": "point",
    "triangles": "triangle",
    "constraint_edges": "constraint edge",
    "polygons": "polygon",
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


def is_masked(given: object) -> TypeGuard[np.ma.MaskedArray[Any, Any]]:
    """Whether it is a masked array. NumPy imports its module, which takes milliseconds, when one is first made."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and isinstance(given, masked.MaskedArray)


def _of_masked(given: np.ma.MaskedArray[Any, Any], name: str) -> npt.NDArray[Any]:
    """The numbers of a masked array; UsageError if one is masked, since leaving points out would renumber the rest."""
    # The annotations of NumPy 1 lack these two functions.
    numpy_ma: Any = np.ma
    masked = np.argwhere(numpy_ma.getmaskarray(given))
    if len(masked):
        hint = ", as points[~points.mask.any(axis=1)]" if name == "points" else ""
        raise UsageError(
            f"{name}{masked[0].tolist()} is masked: leave masked ones out before{hint}"
        )
    numbers: npt.NDArray[Any] = numpy_ma.getdata(given)
    return numbers


def _of_arrow(given: Any, name: str) -> npt.NDArray[Any]:
    """The numbers of pyarrow: tables, columns, and columns of lists of one size, of which points have two each."""
    if hasattr(given, "columns"):
        return np.stack([np.asarray(column) for column in given.columns], axis=1)
    if hasattr(given, "combine_chunks"):
        given = given.combine_chunks()
    size = getattr(given.type, "list_size", None)
    if size is None:
        return np.asarray(given)
    # Also the null rows of a column have numbers.
    if given.null_count or given.flatten().null_count:
        raise UsageError(f"{name} have nulls: drop them before")
    return np.asarray(given.flatten()).reshape(len(given), size)


def _of_dlpack(given: Any) -> npt.NDArray[Any]:
    # NumPy 1.22 has it under another name.
    from_dlpack = getattr(np, "from_dlpack", None) or getattr(np, "_from_dlpack")
    array: npt.NDArray[Any] = from_dlpack(given)
    return array


def check_memory(given: Any, name: str) -> None:
    """UsageError for an array that is in a device's memory."""
    if type(given).__module__.partition(".")[0] == "pyopencl":
        hint = _DEVICE_CALLS.get(name, "")
        raise UsageError(f"{name} are in the memory of an OpenCL device: {hint}take {name}.get()")
    kind = int(given.__dlpack_device__()[0]) if hasattr(given, "__dlpack_device__") else 1
    if kind not in _HOST_MEMORY:
        memory = _DEVICE_MEMORY.get(kind, "a device")
        raise UsageError(f"{name} are in the memory of {memory}: copy them to the host before")


def geometries_of(given: Any) -> Optional[npt.NDArray[np.object_]]:
    """The geometries of Shapely that something consists of, such as a GeoSeries or a list; None if it has none."""
    library = type(given).__module__.partition(".")[0]
    if library == "geopandas":
        return np.asarray(given.geometry.values, dtype=object)
    if library == "shapely" and hasattr(given, "geom_type"):
        alone = np.empty(1, object)
        alone[0] = given
        return alone
    if isinstance(given, (list, tuple)) or (isinstance(given, np.ndarray) and given.dtype == object):
        first = given[0] if len(given) else None
        if type(first).__module__.partition(".")[0] == "shapely":
            geometries = np.empty(len(given), object)
            geometries[:] = given
            return geometries
    return None


def _of_geometries(geometries: npt.NDArray[np.object_], name: str) -> npt.NDArray[Any]:
    """The coordinates of points, and of the members of a MultiPoint."""
    shapely = optional("shapely", name)
    types = shapely.get_type_id(geometries)
    # 0: Point; 4: MultiPoint, which stands alone so that indices are those of its members.
    alone = len(geometries) == 1 and types[0] == 4
    wrong = np.flatnonzero((types != 0) | shapely.is_empty(geometries))
    if len(wrong) and not alone:
        first = geometries[int(wrong[0])]
        kind = "missing" if first is None else f"an empty {first.geom_type}"
        kind = kind if first is None or first.is_empty else f"a {first.geom_type}"
        raise UsageError(f"{name}[{wrong[0]}] is {kind}, not a Point")
    coordinates: npt.NDArray[Any] = shapely.get_coordinates(geometries)
    return coordinates


def _as_array(given: ArrayLike, name: str) -> npt.NDArray[Any]:
    """What numpy makes of it; UsageError, with numpy's words, if it cannot, as of a list of unequal rows."""
    if type(given) is np.ndarray and given.dtype.kind != "O":
        return given
    if is_masked(given):
        return _of_masked(given, name)
    geometries = geometries_of(given)
    if geometries is not None:
        return _of_geometries(geometries, name)
    library = type(given).__module__.partition(".")[0]
    if hasattr(given, "why_no_array"):
        raise UsageError(f"{name} {given.why_no_array}")
    try:
        if library == "pyarrow":
            return _of_arrow(given, name)
        check_memory(given, name)
        if hasattr(given, "__dlpack__") and not hasattr(given, "__array__"):
            return _of_dlpack(given)
        array = np.asarray(given)
        if array.dtype.kind == "O" and library == "pandas":
            # Columns that may have missing values; those become NaN, which is an error where it matters.
            return np.asarray(given.to_numpy(dtype=np.float64, na_value=np.nan))  # type: ignore[union-attr]
        return array
    except UsageError:
        raise
    except (ValueError, TypeError, RuntimeError, BufferError) as error:
        raise UsageError(f"{name} are no array of numbers: {error}") from error


def as_any(given: ArrayLike, name: str) -> npt.NDArray[Any]:
    """An array of whatever type numpy finds; UsageError if something is masked, or in a device's memory."""
    if is_masked(given):
        return _of_masked(given, name)
    check_memory(given, name)
    try:
        return np.asarray(given)
    except ValueError as error:
        raise UsageError(f"{name} are no array: {error}") from error


def as_floats(given: ArrayLike, name: str) -> FloatArray:
    """A C-contiguous, aligned array of float32 or float64, copied only if it is none already.

    Numbers of any other type become float64; those that are not exactly one are an error, and so is
    what is no real number, an array of objects included.
    """
    array = _as_array(given, name)
    if array.size == 0 and array.dtype.kind == "O":
        array = array.astype(np.float64)
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    if array.dtype not in _FLOATS:
        array = _as_doubles(array, name)
    flags = array.flags
    if flags.c_contiguous and flags.aligned:
        return array
    return np.require(array, requirements=["C_CONTIGUOUS", "ALIGNED"])


def are_rows(given: object) -> TypeGuard[Doubles]:
    """Whether it is an array that calls take as it is: contiguous doubles, two in a row."""
    if type(given) is not np.ndarray or given.ndim != 2 or given.dtype is not _FLOATS[0]:
        return False
    flags = given.flags
    return given.shape[1] == 2 and flags.c_contiguous and flags.aligned


def check_points_shape(points: FloatArray) -> None:
    """UsageError unless the shape is (n, 2)."""
    if points.ndim != 2:
        raise UsageError(
            f"points must have two dimensions, of the shape (n, 2), not {points.shape}"
        )
    if points.shape[1] != 2:
        raise UsageError(f"points must be two-dimensional, but have {points.shape[1]} coordinates")


def as_points(given: ArrayLike) -> FloatArray:
    """Points of shape (n, 2); UsageError for any other shape."""
    points = as_floats(given, "points")
    check_points_shape(points)
    return points


def as_integers(given: npt.ArrayLike, name: str) -> npt.NDArray[Any]:
    """An array of integers, or an empty one; UsageError for anything else."""
    array = _as_array(given, name)
    if array.dtype.kind not in "iu" and array.size:
        raise UsageError(f"{name} must be integers, not {array.dtype}")
    return array


def as_int32(given: npt.NDArray[Any], name: str) -> npt.NDArray[np.int32]:
    """The same integers as the library takes them; UsageError for those that would be others."""
    kept = np.ascontiguousarray(given, np.int32)
    if (kept != given).any():
        raise UsageError(f"{name} must be int32: {given[kept != given][0]} is too large")
    return kept


def as_count(given: Any, name: str, least: int = 0) -> int:
    """A number of things that a size_t can be; UsageError for anything else."""
    try:
        count = operator.index(given)
    except TypeError:
        count = -1
    if isinstance(given, bool) or not least <= count <= sys.maxsize:
        raise UsageError(f"{name} must be an integer from {least} to {sys.maxsize}, not {given!r}")
    return count


def as_offsets(given: npt.ArrayLike, name: str = "offsets") -> npt.NDArray[np.int64]:
    """Offsets of sets; UsageError unless they are a list of integers."""
    array = _as_array(given, name)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise UsageError(
            f"{name} must be integers in one dimension, not {array.dtype} of shape {array.shape}"
        )
    return np.ascontiguousarray(array, dtype=np.int64)


def frozen(array: _Array) -> _Array:
    """The array, read-only from now on."""
    array.setflags(write=False)
    return array


class Frozen:
    """An object whose arrays are read-only, which pickling forgets."""

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        for value in state.values():
            for array in value if isinstance(value, tuple) else (value,):
                if isinstance(array, np.ndarray):
                    frozen(array)


class Fixed(Frozen):
    """An object that refuses other attributes in place of those that all the rest was computed from."""

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            is_kept = isinstance(getattr(type(self), name, None), cached_property)
            if is_kept or name in self.__dict__:
                raise AttributeError(
                    f"{name} cannot be replaced: make another {type(self).__name__}"
                )
        object.__setattr__(self, name, value)


def number_of(names: Mapping[str, int], given: object, name: str) -> int:
    """The number of a choice; UsageError for what is none."""
    if not isinstance(given, str) or given not in names:
        choices = ", ".join(repr(key) for key in names)
        raise UsageError(f"{name} must be one of {choices}, not {given!r}")
    return names[given]


def check_out(out: Any, dtype: npt.DTypeLike, shape: tuple[Optional[int], ...], name: str) -> None:
    """UsageError unless results of a type and shape can be written to an array; None is any size."""
    wanted = (
        f"{np.dtype(dtype)} of shape ({', '.join('...' if k is None else str(k) for k in shape)})"
    )
    if not isinstance(out, np.ndarray):
        raise UsageError(f"{name} must be an array of {wanted}, not {type(out).__name__}")
    fits = out.ndim == len(shape) and all(k in (None, size) for k, size in zip(shape, out.shape))
    if out.dtype != np.dtype(dtype) or not fits:
        raise UsageError(f"{name} must be {wanted}, not {out.dtype} of shape {out.shape}")
    if not out.flags.writeable:
        raise UsageError(f"{name} is read-only")


def slices(count: int) -> Iterator[slice]:
    """Parts of so many rows, of which temporary arrays stay in a processor's cache."""
    return (slice(first, first + _ROWS) for first in range(0, count, _ROWS))


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
