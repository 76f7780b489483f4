"""What users hand over, as arrays that the library takes as they are."""

from __future__ import annotations

import contextlib
import operator
import os
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

_IN_TWO_ARRAYS = "; if x and y are two arrays, take numpy.column_stack([x, y])"

_INTERPOLATE = "call triangulate_device(...).locator().interpolate, or "
# The functions that take arrays of pyopencl as they are.
_DEVICE_CALLS = {
    "points": "call triangulate_device, or ",
    "xi": _INTERPOLATE,
    "values": _INTERPOLATE,
    "gradients": _INTERPOLATE,
}

# Rows of a part; a few arrays of so many doubles fit a processor's cache.
_ROWS = 1 << 14

# Words whose singular is not the word without the s at its end.
_SINGULAR = {
    "values per point": "value per point",
    "hull vertices": "hull vertex",
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
    """The numbers of pyarrow: tables, and columns of lists of one size, of which points have two each."""
    if hasattr(given, "itercolumns"):
        return np.stack([np.asarray(column) for column in given.itercolumns()], axis=1)
    if hasattr(given, "combine_chunks"):
        given = given.combine_chunks()
    # Also the null rows of a column have numbers.
    if given.null_count or given.flatten().null_count:
        raise UsageError(f"{name} have nulls: drop them before")
    return np.asarray(given.flatten()).reshape(len(given), given.type.list_size)


def _is_arrow(given: Any) -> bool:
    """Whether it is a table of pyarrow, or a column of lists of one size: other columns are arrays of NumPy."""
    return hasattr(given, "itercolumns") or hasattr(getattr(given, "type", None), "list_size")


def _of_dlpack(given: Any) -> npt.NDArray[Any]:
    # NumPy 1.22 has it under another name.
    from_dlpack = getattr(np, "from_dlpack", None) or getattr(np, "_from_dlpack")
    array: npt.NDArray[Any] = from_dlpack(given)
    return array


def is_on_device(given: object) -> bool:
    """Whether it is in the memory of an OpenCL device: an array or a buffer of pyopencl, or of what extends it."""
    return hasattr(given, "base_data") or hasattr(given, "int_ptr")


def check_memory(given: Any, name: str) -> None:
    """UsageError for an array that is in a device's memory."""
    if is_on_device(given):
        hint = _DEVICE_CALLS.get(name, "")
        raise UsageError(f"{name} are in the memory of an OpenCL device: {hint}take {name}.get()")
    kind = 1
    # Some columns of pyarrow are no arrays for DLPack, but are for NumPy.
    with contextlib.suppress(AttributeError, TypeError, ValueError):
        kind = int(given.__dlpack_device__()[0])
    if kind not in _HOST_MEMORY:
        memory = _DEVICE_MEMORY.get(kind, "a device")
        raise UsageError(f"{name} are in the memory of {memory}: copy them to the host before")


def is_plain(given: object) -> TypeGuard[npt.NDArray[Any]]:
    """Whether it is an array of NumPy without objects, which needs no conversion."""
    return type(given) is np.ndarray and given.dtype.kind != "O"


def column_of(given: Any) -> Any:
    """The column of geometries, if it is a table that has one, as those of GeoPandas; everything else as it is."""
    return getattr(given, "geometry", given) if hasattr(given, "columns") else given


def geometries_in(given: Any) -> Optional[npt.NDArray[np.object_]]:
    """What describes itself by ``__geo_interface__``: a geometry, or those of a list, an array, a column or a table.

    None if there are none. Where one is missing, there is None.
    """
    if is_plain(given):
        return None
    column = column_of(given)
    members: Any
    if isinstance(column, (list, tuple)):
        members = column
    elif getattr(getattr(column, "dtype", None), "kind", "") == "O":
        # The type of columns of geometries, too, which also describe themselves as one, but slowly.
        members = np.array(column, object)
    elif hasattr(column, "__geo_interface__"):
        members = [column]
    else:
        return None
    first = next((one for one in members if not _is_missing(one)), None)
    # Columns of geometries have types, also if they are empty.
    if not (hasattr(first, "__geo_interface__") or hasattr(column, "geom_type")):
        return None
    if not isinstance(members, np.ndarray):
        objects = np.empty(len(members), object)
        for i, one in enumerate(members):
            objects[i] = one
        members = objects
    if members.ndim != 1:
        return None
    members[[_is_missing(one) for one in members]] = None
    geometries: npt.NDArray[np.object_] = members
    return geometries


def _is_missing(one: object) -> bool:
    """Whether there is no geometry: tables have None or NaN then."""
    return one is None or (isinstance(one, float) and one != one)


def are_shapely(geometries: npt.NDArray[np.object_]) -> bool:
    """Whether all are geometries of Shapely, or missing. There are none before somebody has imported it."""
    shapely = sys.modules.get("shapely")
    return shapely is not None and bool(shapely.is_valid_input(geometries).all())


def geometries_of(given: Any, name: str) -> Optional[npt.NDArray[np.object_]]:
    """The same as `geometries_in`, as geometries of Shapely; those of other libraries are converted."""
    geometries = geometries_in(given)
    if geometries is None or are_shapely(geometries):
        return geometries
    shapely = optional("shapely", name)
    for i in np.flatnonzero(~shapely.is_valid_input(geometries)):
        if not hasattr(geometries[i], "__geo_interface__"):
            raise UsageError(f"{name}[{i}] is no geometry, but {geometries[i]!r}")
        described = geometries[i].__geo_interface__
        parts = [part["geometry"] for part in described.get("features", ())]
        if described["type"] == "FeatureCollection":
            described = {"type": "GeometryCollection", "geometries": [part for part in parts if part]}
        geometries[i] = shapely.geometry.shape(described)
    return geometries


def _of_geometries(geometries: npt.NDArray[np.object_], name: str) -> npt.NDArray[Any]:
    """The coordinates of points, and of the members of a MultiPoint or of another collection."""
    shapely = optional("shapely", name)
    # 4: MultiPoint; 7: GeometryCollection. One that stands alone is its members, and so are indices.
    if len(geometries) == 1 and shapely.get_type_id(geometries[0]) in (4, 7):
        geometries = shapely.get_parts(geometries)
    # 0: Point
    wrong = np.flatnonzero((shapely.get_type_id(geometries) != 0) | shapely.is_empty(geometries))
    if len(wrong):
        first = geometries[int(wrong[0])]
        kind = "missing" if first is None else f"an empty {first.geom_type}"
        kind = kind if first is None or first.is_empty else f"a {first.geom_type}"
        raise UsageError(f"{name}[{wrong[0]}] is {kind}, not a Point")
    coordinates: npt.NDArray[Any] = shapely.get_coordinates(geometries)
    return coordinates


def _as_array(given: ArrayLike, name: str) -> npt.NDArray[Any]:
    """What numpy makes of it; UsageError, with numpy's words, if it cannot, as of a list of unequal rows."""
    if is_plain(given):
        return given
    if is_masked(given):
        return _of_masked(given, name)
    if isinstance(given, (str, bytes, os.PathLike)):
        raise UsageError(
            f"{name} are numbers, not text or a path: {given!r}. "
            "Read a file before, such as by numpy.loadtxt or numpy.load"
        )
    if hasattr(given, "why_no_array"):
        raise UsageError(f"{name} {given.why_no_array}")
    geometries = geometries_of(given, name)
    if geometries is not None:
        return _of_geometries(geometries, name)
    try:
        if isinstance(given, (list, tuple)):
            array = np.asarray(given)
        elif _is_arrow(given):
            array = _of_arrow(given, name)
        else:
            check_memory(given, name)
            if hasattr(given, "__dlpack__") and not hasattr(given, "__array__"):
                return _of_dlpack(given)
            array = np.asarray(given)
            if array.dtype.kind == "O" and hasattr(given, "to_numpy"):
                # Columns that may have missing values; those become NaN, which is an error where it matters. Others
                # than those of pandas do not take these arguments.
                with contextlib.suppress(TypeError):
                    array = np.asarray(given.to_numpy(dtype=np.float64, na_value=np.nan))
    except UsageError:
        raise
    except (ValueError, TypeError, RuntimeError, BufferError) as error:
        _check_columns(given, name)
        raise UsageError(f"{name} are no array of numbers: {error}") from error
    if array.dtype.kind not in "biuf":
        _check_columns(given, name)
    if array.ndim == 0 and array.dtype.kind == "O":
        hint = f": take list({name})" if hasattr(given, "__next__") else ""
        # Triangulations have points.
        hint = f": take its {name}" if hasattr(given, name) else hint
        raise UsageError(f"{name} must be real numbers, not an object of {type(given).__name__}{hint}")
    return array


def _check_columns(given: Any, name: str) -> None:
    """UsageError that names a column of a table that has no numbers, if it is a table with such a column."""
    if not hasattr(given, "columns"):
        return
    columns = given.schema.names if _is_arrow(given) else list(given.columns)
    for column in columns if len(set(columns)) == len(columns) else ():
        try:
            is_number = _as_array(given[column], name).dtype.kind in "biuf"
        except UsageError:
            is_number = False
        if not is_number:
            raise UsageError(
                f"{name} have the column {column!r}, which has no numbers: "
                "take the columns of numbers alone, such as table[['x', 'y']]"
            )


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


def hint_for(shape: tuple[int, ...], name: str) -> str:
    """What to take in place of coordinates of a wrong shape, if one can guess what they are."""
    if len(shape) == 1:
        return _IN_TWO_ARRAYS
    return f"; if its rows are x and y, take {name}.T" if len(shape) == 2 and shape[0] == 2 else ""


def check_points_shape(points: FloatArray) -> None:
    """UsageError unless the shape is (n, 2)."""
    shape = points.shape
    if points.ndim == 2 and shape[1] == 2:
        return
    wrong = f"must have two dimensions, of the shape (n, 2), not {shape}"
    if points.ndim == 2:
        wrong = f"must be two-dimensional, but have {shape[1]} coordinates"
    raise UsageError(f"points {wrong}{hint_for(shape, 'points')}")


def as_points(given: ArrayLike) -> FloatArray:
    """Points of shape (n, 2); UsageError for any other shape."""
    if are_rows(given):
        return given
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


def as_iterations(maxiter: Any, tol: float) -> int:
    """How many there may be to estimate gradients by a tolerance, checked."""
    if not tol > 0:
        raise UsageError(f"tol must be greater than 0, not {tol}")
    return as_count(maxiter, "maxiter", 1)


def as_count(given: Any, name: str, least: int = 0) -> int:
    """A number of things that a size_t can be; UsageError for anything else."""
    try:
        count = operator.index(given)
    except TypeError:
        count = -1
    if isinstance(given, bool) or not least <= count <= sys.maxsize:
        raise UsageError(f"{name} must be an integer from {least} to {sys.maxsize}, not {given!r}")
    return count


def as_number(given: Any, name: str) -> float:
    """A real number; UsageError for anything else."""
    try:
        if not isinstance(given, (str, bytes)):
            return float(given)
    except (TypeError, ValueError, OverflowError):
        pass
    raise UsageError(f"{name} must be a number, not {given!r}")


def as_distance(given: Any, name: str) -> float:
    """A real number of 0 or more; UsageError for anything else."""
    distance = as_number(given, name)
    if not distance >= 0:
        raise UsageError(f"{name} must be a number of 0 or more, not {given!r}")
    return distance


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
    parts = []
    for name, count in counts.items():
        several = name.replace("_", " ")
        one = _SINGULAR.get(several, several[:-1] if several.endswith("s") else several)
        parts.append(f"{count} {one if count == 1 else several}")
    if sets != 1:
        parts.append(f"{sets} sets")
    return f"<flaunay.{type(result).__name__}: {', '.join(parts)}>"
