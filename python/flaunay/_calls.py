"""The calls of the C interface, with arrays of NumPy and exceptions.

Arrays are handed over and come back without a copy: a result's array keeps what the library made alive. Threads take
turns on a triangulator; while one works, the others wait without the interpreter's lock.
"""

from __future__ import annotations

import _thread
import ctypes
import functools
import operator
import queue
import sys
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, ClassVar, Optional, TypeVar, Union, cast

import numpy as np
import numpy.typing as npt

from flaunay import _declarations, _library
from flaunay._arrays import FloatArray, Mesh, Searched, names_of
from flaunay._declarations import INDEX_TYPE, PART, PRECISION
from flaunay._errors import UsageError
from flaunay._library import DeviceHandle, Handle, check, library, text_of
from flaunay._refinement import RefinementReport

_Doubles = npt.NDArray[np.float64]
_Indices = npt.NDArray[np.int32]
_Offsets = npt.NDArray[np.int64]
_Array = TypeVar("_Array", bound=npt.NDArray[Any])
# For each array in device memory the handle of its buffer, 0 if it is empty, its shape and its type.
_Places = dict[str, tuple[int, tuple[int, ...], np.dtype[Any]]]

__version__: str = text_of(library.version())

_ARRAY = np.ndarray
_addressof, _from_buffer = ctypes.addressof, ctypes.c_char.from_buffer
_INT32, _INT64 = np.dtype(np.int32), np.dtype(np.int64)
_FLOAT64, _FLOAT32 = np.dtype(np.float64), np.dtype(np.float32)
_BOOL, _UINT8 = np.dtype(np.bool_), np.dtype(np.uint8)

# The arrays of results: the type, of what there is one row per thing, the elements of a row, and what asks for them.
_Arrays = dict[str, tuple[np.dtype[Any], str, int, str]]


def _arrays(table: dict[str, tuple[str, str, int, str]]) -> _Arrays:
    return {name: (np.dtype(kind), *others) for name, (kind, *others) in table.items()}  # type: ignore[misc]


# Tables of arrays by the names of results.
_TABLES = {
    name[: -len("_ARRAYS")].lower(): _arrays(table)
    for name, table in vars(_declarations).items()
    if name.endswith("_ARRAYS") and isinstance(table, dict)
}
TRIANGULATION, _CONSTRAINED, _SPACE = (_TABLES[name] for name in ("triangulation", "constrained", "space"))
_ON_DEVICE = TRIANGULATION | _SPACE | _TABLES["device"]
_OFFSETS = (_INT64, "set_offset", 1, "always")
# Arrays of triangulations are asked for by their own names.
_MADE: _Arrays = {
    name: (dtype, row, columns, name if asked == "on_request" else asked)
    for name, (dtype, row, columns, asked) in {**TRIANGULATION, **_CONSTRAINED}.items()
}
_MADE |= _SPACE | dict.fromkeys(["triangle_offsets", "hull_offsets"], _OFFSETS)


def _counter(row: str) -> Callable[[Any, Any], int]:
    """What counts rows of something in a flaunay_mesh and flaunay_constrained_arrays."""
    if row == "halfedge":
        return lambda mesh, _: 3 * cast(int, mesh.triangle_count)
    of, offset, _ = row.partition("_offset")
    count, more = operator.attrgetter(f"{of}_count"), int(bool(offset))
    if hasattr(_declarations.Mesh, f"{of}_count"):
        return lambda mesh, _: count(mesh) + more
    return lambda _, arrays: count(arrays) + more


_ROWS = {row: _counter(row) for _, row, *_ in _MADE.values()}


# ---- Arrays


class _Memory(ctypes.c_uint8 * sys.maxsize):  # type: ignore[misc]
    """What an array of the library's memory refers to. The arrays have the sizes; this one has none."""

    __slots__ = ("owner",)


def _view(
    owner: Handle, address: Optional[int], shape: tuple[int, ...], dtype: np.dtype[Any]
) -> npt.NDArray[Any]:
    """An array over memory that is valid as long as its owner. address: None if it is empty."""
    if address is None:
        return np.empty(shape, dtype)
    memory = _Memory.from_address(address)
    memory.owner = owner
    return np.ndarray(shape, dtype, memory)


def _shape(rows: int, columns: int) -> tuple[int, ...]:
    """Rows of one element are an array of one dimension."""
    return (rows,) if columns == 1 else (rows, columns)


class _Result(Handle):
    """What the library has made. The names of the functions that are about it begin with its own."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self._name, self._destroy = name, getattr(library, f"{name}_destroy")

    def read(self, member: str) -> Any:
        return getattr(library, f"{self._name}_{member}")(self.pointer)

    def views(self, *offsets: str, **counts: int) -> dict[str, Any]:
        """The arrays of its table, and offsets of sets.

        counts: how many there are of what has rows, unless a function says so.
        """
        arrays, pointer = {}, self.pointer
        for name, function, of, count_of, more, columns, dtype in _readers(self._name, offsets):
            if of not in counts:
                counts[of] = count_of(pointer)
            rows = counts[of] + more
            shape = (rows,) if columns == 1 else (rows, columns)
            arrays[name] = _view(self, function(pointer), shape, dtype)
        return arrays


@functools.cache
def _readers(result: str, offsets: tuple[str, ...]) -> list[tuple[Any, ...]]:
    """For each array what reads it, of what it has rows, what counts these, how many more, and a row's shape."""
    readers, table = [], _TABLES[result] | dict.fromkeys(offsets, _OFFSETS)
    for name, (dtype, row, columns, _) in table.items():
        of, offset, _ = row.partition("_offset")
        function, count_of = (
            getattr(library, f"{result}_{member}", None) for member in (name, f"{of}_count")
        )
        readers.append((name, function, of, count_of, int(bool(offset)), columns, dtype))
    return readers


def _address_of(array: Any) -> Optional[int]:
    try:
        # Quicker than NumPy's own way.
        return _addressof(_from_buffer(array))
    except (TypeError, ValueError):
        if not array.size:
            return None
        if array.flags.writeable:
            raise
    return cast(Optional[int], array.ctypes.data)


def _as_indices(array: npt.NDArray[Any], name: str, shape: tuple[int, ...]) -> _Indices:
    """Contiguous indices; -1 stands for any number of rows. Users can replace arrays at any time."""
    given = array.shape
    if not given or given[1:] != shape[1:] or shape[0] not in (-1, given[0]):
        raise UsageError(f"{name} were changed: their shape is {given}, not {shape}")
    if array.dtype != _INT32:
        raise UsageError(f"{name} were changed: they are {array.dtype}, not int32")
    return np.ascontiguousarray(array)


def _as_corners(triangles: _Indices) -> _Indices:
    if triangles.ndim != 2 or triangles.shape[1] != 3:
        raise UsageError("simplices must have the shape (nsimplex, 3)")
    return _as_indices(triangles, "simplices", (-1, 3))


def _count_points(points: npt.NDArray[Any]) -> int:
    if points.ndim != 2 or points.shape[1] != 2:
        raise UsageError("points must be an array of shape (n, 2)")
    return len(points)


def _as_doubles(values: npt.NDArray[Any]) -> _Doubles:
    if values.dtype != _FLOAT64:
        raise TypeError(f"expected an array of float64, not of {values.dtype}")
    return np.ascontiguousarray(values)


def _as_offsets(
    given: Optional[_Offsets], n: int, name: str = "offsets", what: str = "points"
) -> tuple[Optional[_Offsets], int]:
    """The sets' offsets for n points, and the number of sets; None means one set.

    Where they decrease, the library says so.
    """
    if given is None:
        return None, 0
    if len(given) == 0:
        raise UsageError(f"{name} must have one number at least, 0")
    offsets = np.array(given, _INT64)  # a copy, which does not change any more
    if offsets.min() < 0:
        raise UsageError(f"{name} must begin with 0 and not decrease")
    if offsets[-1] != n:
        raise UsageError(f"{name} end with {offsets[-1]}, but there are {n} {what}")
    return offsets, len(offsets) - 1


def _address_or_none(array: Optional[npt.NDArray[Any]]) -> Optional[int]:
    # Finding those of empty arrays takes ten times as long, and nobody reads them.
    return None if array is None or not array.size else _address_of(array)


def _as_arguments(given: tuple[Any, ...]) -> list[Any]:
    """Arrays by their addresses, everything else as ctypes takes it."""
    return [_address_of(one) if type(one) is _ARRAY else one for one in given]


def _call_with_mesh(function: Any, *arguments: Any) -> None:
    """Calls a function, with errors about indices of a mesh that the user has changed in the user's words."""
    try:
        check(function(*_as_arguments(arguments)))
    except UsageError as error:
        name, separator, what = str(error).partition(": ")
        if not separator:
            raise
        name = "simplices" if name == "triangles" else name
        raise UsageError(f"{name} were changed: {what}") from None


# ---- Structs


def _struct(of: Callable[..., Any], /, **members: Any) -> Any:
    """A struct of C with the addresses of arrays and of other structs, which it keeps."""
    kept = []
    for name, value in members.items():
        if value is None or type(value) is int:
            continue
        kept.append(value)
        if isinstance(value, _ARRAY):
            members[name] = _address_or_none(value)
        elif isinstance(value, ctypes.Structure):
            members[name] = ctypes.pointer(value)
    made = of(**members)
    made._refers_to = kept
    return made


def _members(struct: type[ctypes.Structure], *without: str) -> Callable[[Any], dict[str, Any]]:
    """What reads all members of a struct but these: numbers, texts and flags."""
    names = [field[0] for field in struct._fields_ if field[0] not in without]
    read, flags = operator.attrgetter(*names), _declarations.FLAGS[struct.__name__]
    return lambda given: {
        name: text_of(value) if isinstance(value, bytes) else bool(value) if name in flags else value
        for name, value in zip(names, read(given))
    }


_STATISTICS = _members(_declarations.Statistics, "phases", "phase_count", "kernels", "kernel_count")
_ROUND = _members(_declarations.ChunkRound)
_REFINEMENT = _members(_declarations.RefinementReport, "bad_count", "bad_triangles", "excuses")
_CHUNK_STATISTICS = _members(
    _declarations.ChunkStatistics,
    *("rounds", "round_count", "devices", "device_count", "phases", "phase_count", "seconds"),
    "note",
)
_DEVICE = _members(_declarations.DeviceInfo, "self_test_passed", "self_test_failure")
_MODE = _members(_declarations.ModeInfo, "mode")


def _phases_of(statistics: Any) -> dict[str, float]:
    """The seconds of each phase by its name."""
    phases = statistics.phases
    rows = [phases[k] for k in range(statistics.phase_count)]
    return {text_of(phase.name): phase.seconds for phase in rows}


def _statistics_of(statistics: Any) -> dict[str, Any]:
    return {**_STATISTICS(statistics), "phases": _phases_of(statistics)}


def _chunk_statistics_of(statistics: Any) -> dict[str, Any]:
    devices = (statistics.devices[k] for k in range(statistics.device_count))
    return {
        **_CHUNK_STATISTICS(statistics),
        "rounds": [_ROUND(statistics.rounds[k]) for k in range(statistics.round_count)],
        "devices": [{"device": text_of(row.name), "points": row.points} for row in devices],
        "phases": _phases_of(statistics),
        "seconds": statistics.seconds,
        "note": text_of(statistics.note),
    }


# ---- Devices and modes


def devices() -> list[dict[str, Any]]:
    """Every OpenCL device, in the order in which ``"#k"`` names them."""
    found = _Result("device_list")
    check(library.device_list_create(0, found.place))
    return [_DEVICE(library.device_list_at(found, k)[0]) for k in range(found.read("count"))]


_MODES = [library.mode_at(k)[0] for k in range(library.mode_count())]
_MODE_NUMBERS: dict[str, int] = {text_of(info.name): info.mode for info in _MODES}
_MODE_INFOS = [_MODE(info) for info in _MODES]


def modes() -> list[dict[str, Any]]:
    """Every mode, the default first."""
    return [dict(mode) for mode in _MODE_INFOS]


_options: dict[tuple[str, int], _declarations.Options] = {}


def _options_for(mode: str, parts: int) -> _declarations.Options:
    """Options, which calls only read: one struct for all calls with the same ones."""
    found = _options.get((mode, parts))
    if found is None:
        if mode not in _MODE_NUMBERS:
            raise UsageError(f"there is no mode '{mode}'; there are {', '.join(_MODE_NUMBERS)}")
        found = _declarations.Options(mode=_MODE_NUMBERS[mode], parts=parts)
        _options[mode, parts] = found
    return found


SPACE_KINDS = _declarations.SPACE_KIND


def space_of(
    kind: str,
    period: tuple[float, ...] = (0, 0),
    coordinates: int = 0,
    weights: Optional[_Doubles] = None,
) -> _declarations.Space:
    """A flaunay_space. kind: a word of SPACE_KINDS. period: in x and y, and perhaps the shear."""
    if weights is None:
        return _space_without_weights(kind, period, coordinates)
    space: _declarations.Space = _struct(_declarations.Space, **_members_of(kind, period, coordinates), weights=weights)
    return space


def _members_of(kind: str, period: tuple[float, ...], coordinates: int) -> dict[str, Any]:
    lengths = dict(zip(("period_x", "period_y", "shear"), period))
    return {"kind": SPACE_KINDS[kind], "coordinates": coordinates, **lengths}


@functools.lru_cache(maxsize=64)
def _space_without_weights(kind: str, period: tuple[float, ...], coordinates: int) -> _declarations.Space:
    """One struct for all calls in a space, which only read it."""
    return _declarations.Space(**_members_of(kind, period, coordinates))


def _period_of(space: Any) -> tuple[float, float, float]:
    return space[0].period_x, space[0].period_y, space[0].shear


def _parts_of(wanted: set[str]) -> int:
    parts = 0
    for name in wanted:
        parts |= PART[name]
    return parts


# ---- Points and results in host memory


class Made(dict[str, Any]):
    """What the library has made, by its names. None: it was not asked for.

    Each is read when it is first asked for: to read all takes longer than to triangulate a small set.
    """

    def __init__(self, owner: Any, wanted: set[str], mesh: Any, arrays: Any = None) -> None:
        super().__init__()
        self._owner, self._mesh, self._arrays = owner, mesh[0], arrays and arrays[0]
        self._wanted = {"always", *wanted}

    def __missing__(self, name: str) -> Any:
        # Another thread may have asked, too.
        return self.setdefault(name, self._read(name))

    def _read(self, name: str) -> Any:
        if name == "statistics":
            return _statistics_of(self._mesh.statistics[0])
        if name == "refinement":
            return self._owner.report() if name in self._wanted else None
        dtype, row, columns, asked = _MADE[name]
        if asked not in self._wanted:
            return None
        shape = _shape(_ROWS[row](self._mesh, self._arrays), columns)
        address = getattr(self._arrays if name in _CONSTRAINED else self._mesh, name)
        return _view(self._owner, address, shape, dtype)


class _Triangulation(Handle):
    """A triangulation, with constraints or without."""

    _destroy = library.triangulation_destroy

    def report(self) -> RefinementReport:
        """How refinement went."""
        given = library.triangulation_refinement(self.pointer)[0]
        shape = (given.bad_count,)
        return RefinementReport.of(
            bad_triangles=_view(self, given.bad_triangles, shape, _INT32),
            excuses=_view(self, given.excuses, shape, _UINT8),
            **_REFINEMENT(given),
        )

    def made(self, wanted: set[str]) -> Made:
        """wanted: the optional arrays, and what asks for some."""
        pointer = self.pointer
        return Made(self, wanted, library.triangulation_mesh(pointer), library.triangulation_constraints(pointer))


class _Aside:
    """A call of the library on a thread of its own, which asks this one: `run` makes it, and answers.

    So an exception of an answer, and one that a signal raises, as Ctrl-C does, is never in the library's way: Python
    runs handlers of signals on the main thread anywhere, and what one raised as the library calls back would be lost.
    """

    def __init__(self) -> None:
        self._is_begun = threading.Lock()
        self._is_over = False
        self._error: Optional[Exception] = None
        # None: the call is over.
        self._questions: queue.SimpleQueue[Optional[tuple[Any, ...]]] = queue.SimpleQueue()
        self._answers: queue.SimpleQueue[bool] = queue.SimpleQueue()

    def ask(self, *question: Any) -> bool:
        """For the call: whether there was an answer. Without one, it is to end."""
        self._questions.put(question)
        return self._answers.get()

    def _begins(self) -> bool:
        """True for the first who asks."""
        return self._is_begun.acquire(blocking=False)

    def _work(self, call: Callable[[], int]) -> None:
        if not self._begins():
            return
        try:
            check(call())
        except Exception as error:
            self._error = error
        finally:
            self._is_over = True
            self._questions.put(None)

    def run(self, call: Callable[[], int], answer: Callable[..., object]) -> None:
        """Makes a call that returns a status. Raises what an answer has raised, or else the call's error."""
        raised: Optional[BaseException] = None
        is_started = False
        while not self._is_over:
            # A signal can interrupt this anywhere.
            try:
                if not is_started:
                    is_started = True
                    _thread.start_new_thread(self._work, (call,))
                while not self._is_over:
                    question = self._questions.get()
                    if question is not None:
                        if raised is None:
                            answer(*question)
                        self._answers.put(raised is None)
            except BaseException as error:
                if self._begins():
                    raise  # the thread has not, and will find that it need not
                raised = error
                self._answers.put(False)
        if raised is not None:
            raise raised
        if self._error is not None:
            raise self._error


class _Refinement:
    """A refinement for one call. given: members of flaunay_refinement; there may be none."""

    def __init__(self, given: dict[str, Any]) -> None:
        self.struct, self._function = None, given.get("areas_at")
        if not given:
            return
        members = dict(given)
        if "mesh" in given:
            mesh = given["mesh"]
            members["mesh"] = _struct(_declarations.GivenTriangles, **mesh) if mesh else None
        if self._function is not None:
            self._aside = _Aside()
            members["areas_at"] = _declarations.RefinementAreasAt(self._ask_for_areas)
        self.struct = _struct(_declarations.Refinement, **members)

    def _ask_for_areas(self, places: int, count: int, areas: int, _: Any) -> None:
        """Areas that are no numbers end the call."""
        # Without places there is no memory either.
        if count and not self._aside.ask(places, count, areas):
            np.ndarray((count,), _FLOAT64, _Memory.from_address(areas))[...] = np.nan

    def _write_areas(self, places: int, count: int, areas: int) -> None:
        assert self._function is not None
        there: _Doubles = np.ndarray((count, 2), _FLOAT64, _Memory.from_address(places))
        found = np.asarray(self._function(there.copy()), _FLOAT64)
        if found.shape not in ((count,), ()):
            raise UsageError(
                f"areas_at must return areas of the shape ({count},), not {found.shape}"
            )
        if not (found >= 0).all():
            first = int(np.flatnonzero(~(found >= 0))[0])
            raise UsageError(
                f"areas_at has returned {found.ravel()[first]} at {there[first].tolist()}; "
                "areas are positive, or 0 for any"
            )
        np.ndarray((count,), _FLOAT64, _Memory.from_address(areas))[...] = found

    def call(self, triangulator: Triangulator, function: Any, *arguments: Any) -> None:
        """Calls a function of the library when it is this thread's turn; aside, if it asks for areas."""
        if self._function is None:
            triangulator.call(function, *arguments)
            return
        given = _as_arguments(arguments)
        with triangulator.turn:
            self._aside.run(lambda: int(function(*given)), self._write_areas)


class Triangulator(DeviceHandle):
    """What computes on one device, or on the host."""

    _destroy = library.triangulator_destroy

    def __init__(self, create: Any, *arguments: Any) -> None:
        super().__init__()
        # One thread can come here twice: if the garbage collector destroys a locator while the thread has the turn.
        self.turn: AbstractContextManager[Any] = threading.RLock()
        check(create(*arguments, self.place))

    @staticmethod
    def of_name(device: str) -> Triangulator:
        return Triangulator(library.triangulator_create, _encoded(device))

    @staticmethod
    def of_handles(context: int, device: int) -> Triangulator:
        """A triangulator in a context of the caller's, which is retained."""
        return Triangulator(library.triangulator_create_in_context, context, device)

    @property
    def device(self) -> int:
        # It never changes, and so needs no turn.
        found: Optional[int] = library.triangulator_device_id(self.pointer)
        if found is None:
            raise _library.error_of(library.last_error_status())
        return found

    def call(self, function: Any, *arguments: Any) -> None:
        """Calls a function of the library when it is this thread's turn."""
        with self.turn:
            check(function(*_as_arguments(arguments)))

    def make(self, handle: Handle, function: Any, *arguments: Any) -> None:
        """Calls a function that takes the triangulator first, and at last where it writes a handle."""
        self.call(function, self.pointer, *arguments, handle.place)


class _InTurns(DeviceHandle):
    """A handle that takes the turns of its triangulator."""

    _on_sphere = False
    _coordinates = -1  # of the last queries on the sphere

    def __init__(self, triangulator: Triangulator) -> None:
        super().__init__()
        self._triangulator = triangulator

    def _call(self, function: Any, *arguments: Any) -> None:
        """Calls a function that takes the handle first."""
        self._triangulator.call(function, self.pointer, *arguments)

    def _expect(self, queries: _Doubles, set_coordinates: Any) -> None:
        """Says how queries on the sphere are given, unless the last ones were given so. In a turn."""
        coordinates = sphere_coordinates(queries.shape[1])
        if coordinates != self._coordinates:
            self._call(set_coordinates, coordinates)
            self._coordinates = coordinates

    def _release(self) -> None:
        with self._triangulator.turn:
            super()._release()


def triangulate(
    triangulator: Optional[Triangulator],
    points: FloatArray,
    given_offsets: Optional[_Offsets],
    mode: str,
    wanted: set[str],
) -> Made:
    """Triangulates points in host memory. wanted: names of the optional arrays.

    triangulator: None in modes that run on the host, for points that are float64.
    """
    n = _count_points(points)
    # The triangles' bit keeps the number from being 0, which means the default.
    parts = _parts_of(wanted) | PART["triangles"]
    options = _options_for(mode, parts)
    function: Any
    coordinates: FloatArray
    if points.dtype == _FLOAT32 and triangulator is not None:
        function = library.triangulate_float
        coordinates = cast(FloatArray, np.ascontiguousarray(points))
    else:
        function, coordinates = library.triangulate, _as_doubles(points)
    offsets, sets = _as_offsets(given_offsets, n)
    result = _Triangulation()
    # Written out, since for small sets every call counts.
    first, sizes = _address_of(coordinates), _address_or_none(offsets)
    if triangulator is None:
        check(library.triangulate_on_host(first, n, sizes, sets, options, result.place))
    else:
        with triangulator.turn:
            check(function(triangulator.pointer, first, n, sizes, sets, options, result.place))
    return Made(result, wanted, library.triangulation_mesh(result.pointer))


def triangulate_constrained(
    triangulator: Triangulator,
    points: _Doubles,
    given_offsets: Optional[_Offsets],
    segments: _Indices,
    places: dict[str, tuple[_Doubles, Optional[_Offsets]]],
    carried: dict[str, npt.NDArray[Any]],
    rules: dict[str, int],
    refinement: dict[str, Any],
    wanted: set[str],
) -> Made:
    """Triangulates points with segments.

    places: the holes and the seeds, with their offsets. carried, rules: other members of flaunay_constraints, which
    are arrays, and numbers. refinement: members of flaunay_refinement; the result has a report if there are some.
    """
    n = _count_points(points)
    offsets, sets = _as_offsets(given_offsets, n)
    members = {"segments": segments, "segment_count": len(segments), **carried, **rules}
    for name, (rows, given) in places.items():
        of_sets, count = _as_offsets(given, len(rows), f"{name}_offsets", f"{name}s")
        if of_sets is not None and count != max(sets, 1):
            raise UsageError(f"{name}_offsets are of {count} sets, but there are {max(sets, 1)}")
        members |= {f"{name}s": _as_doubles(rows), f"{name}_count": len(rows), f"{name}_offsets": of_sets}
    has_attributes = "seed_attributes" in carried or "attributes" in refinement.get("mesh", {})
    asked = {*names_of(seeds=has_attributes), *carried}
    constraints, function = (_declarations.Constraints, members), library.triangulate_constrained
    before = (_as_doubles(points), n, offsets, sets)
    return _make_constrained(triangulator, function, before, constraints, refinement, wanted, asked)


def _make_constrained(
    triangulator: Triangulator,
    function: Any,
    given: tuple[Any, ...],
    asked_for: tuple[Any, dict[str, Any]],
    refinement: dict[str, Any],
    wanted: set[str],
    asked: set[str],
) -> Made:
    """given: what a function takes before a struct, asked_for: that, with its members but `refinement`."""
    (kind, members), result = asked_for, _Triangulation()
    options = _options_for("blocks", _parts_of(wanted) | PART["triangles"])
    refining = _Refinement(refinement)
    struct = _struct(kind, **members, refinement=refining.struct)
    refining.call(triangulator, function, triangulator.pointer, *given, struct, options, result.place)
    reports = names_of(labels=bool(members["labels"]), refinement=bool(refinement))
    return result.made(wanted | asked | reports)


def triangulate_polygons(
    triangulator: Triangulator,
    points: _Doubles,
    ring_offsets: _Offsets,
    polygon_offsets: _Offsets,
    part_offsets: Optional[_Offsets],
    rules: dict[str, int],
    refinement: dict[str, Any],
    wanted: set[str],
) -> Made:
    """Triangulates polygons. rules: members of flaunay_polygons that are no arrays.

    refinement: as of `triangulate_constrained`.
    """
    rings, ring_count = _as_offsets(ring_offsets, _count_points(points), "ring_offsets")
    outer, count = _as_offsets(polygon_offsets, ring_count, "polygon_offsets", "rings")
    inner, part_count = _as_offsets(part_offsets, ring_count, "part_offsets", "rings")
    members = {
        **{"coordinates": _as_doubles(points), "ring_offsets": rings, "ring_count": ring_count},
        **{"polygon_offsets": outer, "polygon_count": count},
        **{"part_offsets": inner, "part_count": part_count},
        **{"has_outside": 1, "has_fill_rule": 1, **rules},
    }
    polygons, asked = (_declarations.Polygons, members), names_of(map=bool(rules["map"]))
    function = library.triangulate_polygons
    return _make_constrained(triangulator, function, (), polygons, refinement, wanted, asked)


def _counted(struct: type[ctypes.Structure], arrays: dict[str, Any], **others: Any) -> Any:
    """A struct of arrays, which are contiguous and must outlive it, with the counts of their rows."""
    members: dict[str, Any] = dict(others)
    for name, (_, row, *_) in _MADE.items():
        if name in arrays:
            of, offset, _ = row.partition("_offset")
            members[name] = arrays[name]
            members.setdefault(f"{of}_count", len(arrays[name]) - bool(offset))
    return _struct(struct, **{name: members[name] for name in members if hasattr(struct, name)})


def verify(points: _Doubles, offsets: Optional[_Offsets], arrays: dict[str, Any]) -> None:
    """Checks a triangulation. arrays: by their names, contiguous; there are all but links."""
    points, n = _as_doubles(points), len(points)
    sizes, sets = _as_offsets(offsets, n)
    mesh = _counted(_declarations.Mesh, arrays, point_count=n)
    if mesh.set_count != max(sets, 1):
        raise UsageError(f"the triangulation has {mesh.set_count} sets, but there are {max(sets, 1)}")
    if len(arrays["representatives"]) != n:
        raise UsageError(f"the triangulation has {len(arrays['representatives'])} points, but there are {n}")
    check(library.mesh_verify(mesh, _address_of(points), _address_or_none(sizes), None))


def verify_constrained(
    points: _Doubles,
    arrays: dict[str, Any],
    refined: Optional[tuple[int, _Indices]],
    asked: dict[str, Any],
) -> None:
    """Checks a triangulation with constraints. points: with those that were added. arrays: as of `verify`.

    refined: how many points refinement added, and the triangles that are worse. asked: members of
    flaunay_constraints or flaunay_polygons, of flaunay_refinement in its member `refinement`, the number of `points`
    that were given, and their `offsets`.
    """
    given, n = _as_doubles(points), asked["points"]
    more = _counted(_declarations.ConstrainedArrays, {**arrays, "added_points": given[n:]})
    report = None
    if refined is not None:
        kind, (count, bad) = _declarations.RefinementReport, refined
        report = _struct(kind, added_points=count, bad_count=len(bad), bad_triangles=bad)
    wanted = {name: value for name, value in asked.items() if name not in ("offsets", "points")}
    wanted["refinement"] = _Refinement(asked["refinement"]).struct
    result = (_counted(_declarations.Mesh, arrays, point_count=len(points)), more, report)
    if "ring_offsets" in wanted:
        polygons = _struct(_declarations.Polygons, **wanted, coordinates=given)
        check(library.mesh_verify_polygons(*result, polygons))
    else:
        given_points = _as_arguments((given, _as_offsets(asked["offsets"], n)[0]))
        constraints = _struct(_declarations.Constraints, **wanted)
        check(library.mesh_verify_constrained(*result, *given_points, constraints))


class Dynamic(_InTurns):
    """A triangulation that changes."""

    _destroy = library.dynamic_destroy
    _PARTS = PART["triangles"] | PART["neighbors"]

    def __init__(
        self,
        triangulator: Triangulator,
        points: Union[_Doubles, DevicePoints],
        segments: Optional[_Indices],
        crossings: int,
    ) -> None:
        super().__init__(triangulator)
        options = _options_for("blocks", self._PARTS)
        if isinstance(points, DevicePoints):
            triangulator.make(self, library.dynamic_create_device, points, options)
            return
        constraints = None
        if segments is not None:
            asked = {"segments": segments, "segment_count": len(segments), "crossings": crossings}
            constraints = _struct(_declarations.Constraints, **asked)
        given = (_as_doubles(points), len(points), constraints, options)
        triangulator.make(self, library.dynamic_create, *given)

    @property
    def turn(self) -> AbstractContextManager[Any]:
        return self._triangulator.turn

    def call(self, function: Any, *arguments: Any) -> None:
        if self._process != self._process_id():
            raise UsageError(
                "the triangulation is that of the process that was forked: make one of its points here"
            )
        self._triangulator.call(function, *arguments)

    def _call(self, function: Any, *arguments: Any) -> None:
        self.call(function, self.pointer, *arguments)

    def _change(self, function: Any, *arguments: Any) -> dict[str, Any]:
        """What a batch has changed: the members of `Changes`."""
        with self._triangulator.turn:
            self._call(function, *arguments)
            changes = library.dynamic_changes(self.pointer)[0]
            return {
                "first_point": changes.first_point,
                "representatives": self._copy(
                    changes.representatives, changes.representative_count
                ),
                "removed": self._copy(changes.removed, changes.removed_count),
                "made": self._copy(changes.made, changes.made_count),
                "made_corners": self._copy(changes.made_corners, changes.made_count, 3),
                "is_anew": bool(changes.is_anew),
                "seconds": changes.seconds,
            }

    def _copy(self, address: Optional[int], *shape: int) -> _Indices:
        """Of an array that is valid until the next call."""
        return _view(self, address, shape, _INT32).copy()

    def insert(self, points: _Doubles) -> dict[str, Any]:
        return self._change(library.dynamic_insert, _as_doubles(points), len(points))

    def insert_device(self, points: DevicePoints) -> dict[str, Any]:
        return self._change(library.dynamic_insert_device, points)

    def remove(self, numbers: _Indices) -> dict[str, Any]:
        return self._change(library.dynamic_remove, numbers, len(numbers))

    def move(self, numbers: _Indices, points: _Doubles) -> dict[str, Any]:
        return self._change(library.dynamic_move, numbers, _as_doubles(points), len(numbers))

    def count(self, name: str) -> int:
        """A number by the name of the function that has it."""
        return cast(int, getattr(library, f"dynamic_{name}")(self.pointer))

    def coordinates(self) -> _Doubles:
        """The places of points by their numbers; NaN for those that were removed."""
        with self._triangulator.turn:
            places = np.empty((self.count("numbers"), 2))
            self._call(library.dynamic_coordinates, places)
        return places

    def rows(self) -> tuple[_Indices, _Indices]:
        """The corners and the neighbours in each row."""
        with self._triangulator.turn:
            triangles, neighbors = (np.empty((self.count("row_count"), 3), _INT32) for _ in "12")
            self._call(library.dynamic_rows, triangles, neighbors)
        return triangles, neighbors

    def arrays(self) -> Made:
        """The result of a call on all points."""
        result = _Triangulation()
        self._call(library.dynamic_triangulation, result.place)
        return Made(result, {"neighbors"}, library.triangulation_mesh(result.pointer))

    def constraints(self) -> tuple[_Indices, _Indices]:
        """The edges that segments are made of, and a segment of each."""
        with self._triangulator.turn:
            found = library.dynamic_constraints(self.pointer)
            if not found:
                raise _library.error_of(library.last_error_status())
            count = found[0].edge_count
            return self._copy(found[0].edges, count, 2), self._copy(found[0].segments, count)


def _encoded(text: str) -> bytes:
    if "\0" in text:
        raise UsageError(f"{text!r} has a character that no name can have")
    return text.encode("utf-8", "surrogateescape")


def first_triangles(triangles: _Indices, n: int) -> _Indices:
    """For each point the first triangle that has it, -1 where there is none."""
    corners = _as_corners(triangles)
    first = np.empty(n, _INT32)
    _call_with_mesh(library.first_triangles, corners, len(corners), n, first)
    return first


def vertex_neighbors(triangles: _Indices, hull: _Indices, n: int) -> tuple[_Indices, _Indices]:
    """For each point its neighbours in the mesh, in increasing order.

    Those of point i are the second array's from the first's entry i to its entry i + 1.
    """
    corners, ring = _as_corners(triangles), _as_indices(hull, "hull", (-1,))
    starts = np.empty(n + 1, _INT32)
    neighbors = np.empty(corners.size + ring.size if len(corners) else 0, _INT32)
    _call_with_mesh(
        library.vertex_neighbors, corners, len(corners), ring, len(ring), n, starts, neighbors
    )
    return starts, neighbors


def _of_triangles(
    function: Any, points: FloatArray, triangles: _Indices, results: _Array, *others: Any
) -> _Array:
    """What a function of the library finds out about triangles of points, in the array of results."""
    corners = _as_corners(triangles)
    given = (np.ascontiguousarray(points, _FLOAT64), _count_points(points), corners, len(corners))
    _call_with_mesh(function, *given, *others, results)
    return results


def turns(points: FloatArray, triangles: _Indices) -> npt.NDArray[np.int8]:
    """Whether the corners of each triangle turn left, 1, or right, -1, or are on one line, 0: exactly."""
    results = np.empty(len(triangles), np.int8)
    return _of_triangles(library.triangle_turns, points, triangles, results)


def areas(points: FloatArray, triangles: _Indices) -> _Doubles:
    """The areas of triangles, rounded; negative if their corners turn right."""
    return _of_triangles(library.triangle_areas, points, triangles, np.empty(len(triangles)))


def angles(points: FloatArray, triangles: _Indices) -> npt.NDArray[np.int8]:
    """Whether the angle at each corner is acute, 1, right, 0, or obtuse, -1: exactly."""
    results = np.empty((len(triangles), 3), np.int8)
    return _of_triangles(library.triangle_angles, points, triangles, results)


def circumradii(points: FloatArray, triangles: _Indices) -> _Doubles:
    """The circumradii of triangles, with a relative error below 2**-45; infinite if there is none."""
    return _of_triangles(library.circumradii, points, triangles, np.empty(len(triangles)))


def same_circles(points: FloatArray, triangles: _Indices, neighbors: _Indices) -> _Indices:
    """For each triangle of a triangulation the first one that has the same circumcircle, exactly."""
    beyond = _as_indices(neighbors, "neighbors", (len(triangles), 3))
    results = np.empty(len(triangles), np.int32)
    return _of_triangles(library.same_circles, points, triangles, results, beyond)


# ---- Points and results in device memory; handles of OpenCL are integers, as pyopencl has them


class DevicePoints:
    """Points in device memory, whose buffers must be alive during a call."""

    def __init__(
        self,
        memory: int,
        count: int,
        single: bool,
        first: int,
        given_offsets: Optional[_Offsets] = None,
        device_offsets: int = 0,
        sets: int = 0,
    ) -> None:
        offsets, host_sets = _as_offsets(given_offsets, count)
        self.struct: _declarations.DevicePoints = _struct(
            _declarations.DevicePoints,
            memory=memory or None,
            count=count,
            precision=PRECISION["float32" if single else "float64"],
            first=first,
            offsets=offsets,
            device_offsets=device_offsets or None,
            sets=sets or host_sets,
        )
        self.sets: int = self.struct.sets if offsets is not None or device_offsets else 1
        self._as_parameter_ = ctypes.pointer(self.struct)

    def lie_in(self, space: _declarations.Space) -> DevicePoints:
        self._space, self.struct.space = space, ctypes.pointer(space)
        return self


class Enqueue:
    """How a call on device memory is enqueued. The queue and the events must be alive during the call."""

    def __init__(self, queue: int, wait_for: list[int]) -> None:
        self._wait_for = (ctypes.c_void_p * len(wait_for))(*wait_for)
        self._event = ctypes.c_void_p()
        self._as_parameter_ = ctypes.pointer(
            _declarations.Enqueue(
                queue=queue or None,
                wait_for=ctypes.addressof(self._wait_for) if wait_for else None,
                wait_for_count=len(wait_for),
                event=ctypes.addressof(self._event),
            )
        )

    @property
    def event(self) -> int:
        """The event of the call that was made, which is the caller's to release."""
        return self._event.value or 0


class _DeviceArrays(DeviceHandle):
    """What a call computes in buffers of its own; these are alive as long as it, or retained."""

    def __init__(
        self, name: str, compute: Any, owner: Union[Triangulator, Dynamic], *given: Any
    ) -> None:
        """Computes by what takes turns, from what is given: at first points, and at last an `Enqueue`."""
        super().__init__()
        self._name, self._owner = name, owner
        self._destroy = getattr(library, f"device_{name}_destroy")
        self._sets = given[0].sets if isinstance(given[0], DevicePoints) else 1
        check(getattr(library, f"device_{name}_create")(self.place))
        owner.call(compute, owner, *given, self)

    def read(self, member: str, *given: Any) -> Any:
        return getattr(library, f"device_{self._name}_{member}")(self.pointer, *given)

    def copied(self, member: str, count: int, dtype: np.dtype[Any] = _FLOAT64) -> npt.NDArray[Any]:
        """A copy of what is in host memory, for longer than the buffers."""
        return _view(self, self.read(member), (count,), dtype).copy()

    @property
    def triangle_offsets(self) -> _Offsets:
        return self.copied("triangle_offsets", self._sets + 1, _INT64)

    def arrays(self, **counts: int) -> _Places:
        """counts: how many there are of what has rows, unless a function says so. Flags are numbers."""
        parts = getattr(_declarations, f"{self._name.upper()}_PART", PART)
        return self._places(_TABLES[self._name], parts, **counts)

    def _places(self, table: _Arrays, parts: dict[str, int], **counts: int) -> _Places:
        return {
            name: (
                self.read("buffer", parts[name]) or 0,
                _shape(counts[row] if row in counts else self.read(f"{row}_count"), columns),
                _UINT8 if dtype == _BOOL else dtype,
            )
            for name, (dtype, row, columns, _) in table.items()
        }


class DeviceTriangulation(_DeviceArrays):
    """A triangulation in device memory, with the triangulator that made it."""

    _MEMBERS = {name for name, *_ in _declarations.Mesh._fields_} - set(TRIANGULATION)
    _IN_SPACE = ("triangles", "neighbors", "representatives", "places")

    def __init__(
        self, triangulator: Triangulator, points: DevicePoints, wanted: set[str], enqueue: Enqueue
    ) -> None:
        given = (triangulator, points, _parts_of(wanted), enqueue)
        super().__init__("triangulation", library.triangulate_device, *given)

    @classmethod
    def of_rows(cls, dynamic: Dynamic, enqueue: Enqueue) -> DeviceTriangulation:
        """The rows and coordinates of a triangulation that changes."""
        made = cls.__new__(cls)
        _DeviceArrays.__init__(made, "triangulation", library.dynamic_rows_device, dynamic, enqueue)
        return made

    def read(self, member: str, *given: Any) -> Any:
        """A member of its flaunay_mesh, or what a function says."""
        if member in self._MEMBERS:
            return getattr(library.device_triangulation_mesh(self.pointer)[0], member)
        return super().read(member, *given)

    @property
    def hull_offsets(self) -> _Offsets:
        return self.copied("hull_offsets", self._sets + 1, _INT64)

    @property
    def period(self) -> tuple[float, float, float]:
        return _period_of(self.read("space"))

    def arrays_of(self, *names: str) -> _Places:
        """These arrays, none of halfedges or of the hull."""
        return self._places({name: _ON_DEVICE[name] for name in names}, PART)

    def arrays_in_space(self, *names: str) -> _Places:
        """The arrays that there are in another space than the plane, and these."""
        return self.arrays_of(*self._IN_SPACE, *names)

    def computed(self) -> _Places:
        """The arrays that were computed."""
        halfedges, hull = 3 * self.read("triangle_count"), self.read("hull_count")
        places, parts = self.arrays(halfedge=halfedges, hull=hull), self.read("parts")
        return {name: place for name, place in places.items() if parts & PART[name]}

    @property
    def statistics(self) -> dict[str, Any]:
        return _statistics_of(self.read("statistics")[0])


# The functions that make results take a `Triangulator` and points.
DeviceVoronoi = functools.partial(_DeviceArrays, "voronoi", library.voronoi_compute_device)
DeviceClippedVoronoi = functools.partial(_DeviceArrays, "clipped_voronoi", library.voronoi_clip_device)


def relax_device(
    triangulator: Triangulator,
    points: DevicePoints,
    corners: _Doubles,
    iterations: int,
    enqueue: Enqueue,
) -> int:
    """The buffer of relaxed points, which is the caller's to release; 0 if there are no points."""
    given = (points, _as_doubles(corners), len(corners), iterations)
    return _buffer_of(triangulator, library.relax_device, triangulator, *given, enqueue)


def _buffer_of(triangulator: Triangulator, function: Any, *given: Any) -> int:
    """The buffer that a function makes, 0 if it is empty."""
    buffer = ctypes.c_void_p()
    triangulator.call(function, *given, ctypes.byref(buffer))
    return buffer.value or 0


# ---- Chunks


def _lines_of(made: _Result) -> tuple[_Doubles, _Offsets, _Indices]:
    """Points, where lines begin among them, and the number of each line's height."""
    lines = made.read("line_count")
    offsets = _view(made, made.read("offsets"), (lines + 1,), _INT64)
    points = _view(made, made.read("coordinates"), (int(offsets[-1]), 2), _FLOAT64)
    return points, offsets, _view(made, made.read("heights"), (lines,), _INT32)


Progress = Optional[Callable[[str, int, float], object]]


@dataclass
class Chunks:
    """How points are triangulated in chunks."""

    memory: int
    scratch: bytes
    devices: list[str]
    chunk_points: int
    progress: Progress
    space: Optional[_declarations.Space] = None

    def run(self, function: Callable[[_declarations.ChunkOptions, Any], int]) -> dict[str, Any]:
        """Makes a call of the library. Returns its statistics."""
        aside, report, progress = _Aside(), _Result("chunk_report"), self.progress
        names = [_encoded(name) for name in self.devices]
        devices = (ctypes.c_char_p * len(names))(*names)

        def go_on(stage: bytes, round: int, done: float, _: Any) -> int:
            return 0 if aside.ask(text_of(stage), round, done) else 1

        def follow(stage: str, round: int, done: float) -> None:
            if progress is not None:
                progress(stage, round, done)

        options = _declarations.ChunkOptions(
            memory_bytes=self.memory,
            scratch=self.scratch,
            chunk_points=self.chunk_points,
            devices=ctypes.addressof(devices) if names else None,
            device_count=len(names),
            progress=_declarations.ChunkOptionsProgress(go_on),
            space=None if self.space is None else ctypes.pointer(self.space),
        )
        aside.run(lambda: function(options, report.place), follow)
        return _chunk_statistics_of(report.read("statistics")[0])


def _precision_of(numbers: FloatArray, name: str) -> int:
    if numbers.dtype not in (_FLOAT64, _FLOAT32):
        raise UsageError(f"{name} must be float64 or float32")
    return int(PRECISION["float64" if numbers.dtype == _FLOAT64 else "float32"])


def _first_of(numbers: FloatArray) -> Optional[int]:
    return numbers.__array_interface__["data"][0] if len(numbers) else None


def _strided_points(points: FloatArray) -> _declarations.StridedPoints:
    return _declarations.StridedPoints(
        coordinates=_first_of(points),
        count=_count_points(points),
        precision=_precision_of(points, "points"),
        point_stride=points.strides[0],
        coordinate_stride=points.strides[1],
    )


def take_to_places(period: tuple[float, ...], places: _Doubles) -> tuple[float, ...]:
    """Takes points, which are contiguous, into the period. Returns that as it is rounded."""
    lengths = np.array(period)
    check(library.take_to_places(lengths.ctypes.data, places.ctypes.data, places.size // 2))
    return tuple(lengths.tolist())


def triangulate_chunks(
    points: FloatArray,
    wanted: dict[str, Optional[bytes]],
    wide: bool,
    chunks: Chunks,
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Triangulates in chunks. wanted: for each array the path of its file, or None for one in memory.

    Returns the arrays in memory, and the statistics. Arrays are those of triangulations, and `corner_offsets`.
    """
    given, n = _strided_points(points), len(points)
    places = _declarations.MeshArrays(index_type=INDEX_TYPE["int64" if wide else "int32"])
    files = _declarations.MeshFiles()
    arrays: dict[str, npt.NDArray[Any]] = {}
    for name, path in wanted.items():
        if path is not None:
            setattr(files, name, path)
            continue
        # Room for as many rows as there may be. What is never written is never in memory.
        if name == "corner_offsets":
            arrays[name] = np.empty((2 * n, 6), np.int8)
        else:
            dtype, row, columns, _ = TRIANGULATION[name]
            shape = _shape(2 * n if row == "triangle" else n, columns)
            arrays[name] = np.empty(shape, _INT64 if wide and dtype == _INT32 else dtype)
        setattr(places, name, arrays[name].ctypes.data if n else None)

    def call(options: _declarations.ChunkOptions, report: Any) -> int:
        return int(library.triangulate_chunks_to_files(given, places, files, options, report))

    statistics = chunks.run(call)
    counts = {
        "triangle": statistics["triangles"],
        "hull": statistics["hull_vertices"],
        "point": statistics["points"],
    }
    rows = {name: row for name, (_, row, _, _) in TRIANGULATION.items()} | {"corner_offsets": "triangle"}
    arrays = {name: array[: counts[rows[name]]] for name, array in arrays.items()}
    if "hull" in arrays:
        # It had room for all points.
        arrays["hull"] = arrays["hull"].copy()
    return arrays, statistics


def rasterize_chunks(
    points: FloatArray,
    values: FloatArray,
    duplicates: int,
    grid: tuple[float, float, float, float],
    max_edge: float,
    fill: float,
    pixels: _Doubles,
    heights: _Doubles,
    chunks: Chunks,
    breaklines: Optional[tuple[_Doubles, _Doubles, _Indices]] = None,
) -> tuple[_Doubles, _Offsets, _Indices]:
    """`rasterize` and `contours` for points with values, in chunks.

    duplicates: a number of DUPLICATES. breaklines: points, values and segments, contiguous.
    """
    given = _strided_points(points)
    numbers = _declarations.StridedValues(
        values=_first_of(values), precision=_precision_of(values, "values"), stride=values.strides[0]
    )
    raster = _raster_of(grid, max_edge, fill, pixels)
    # The address of the pixels: what a call refers to is freed late, and a mapped file would be open until then.
    place, made = _address_of(pixels), _Result("contours")
    edges = None
    if breaklines is not None:
        names = ("coordinates", "values", "segments")
        counts = {"count": len(breaklines[1]), "segment_count": len(breaklines[2])}
        edges = _struct(_declarations.Breaklines, **dict(zip(names, breaklines)), **counts)
    levels = (heights.ctypes.data, len(heights), made.place, edges)

    def call(options: _declarations.ChunkOptions, report: Any) -> int:
        function = library.rasterize_chunks
        return int(function(given, numbers, duplicates, raster, place, *levels, options, report))

    chunks.run(call)
    return _lines_of(made)


# ---- Voronoi diagrams and queries


def _triangulation_of(
    mesh: Searched, constrained: Optional[npt.NDArray[np.bool_]] = None
) -> tuple[_Doubles, int, _Triangulation]:
    """The points of a mesh, how many there are, and what the library knows of it.

    constrained: of a mesh with constraints, for each corner whether the edge opposite to it is one.
    """
    given, representatives = mesh._stand_ins
    points = np.ascontiguousarray(given, _FLOAT64)
    n, corners = _count_points(points), _as_corners(mesh.simplices)
    beyond = _as_indices(mesh.neighbors, "neighbors", (len(corners), 3))
    ring = _as_indices(mesh.hull, "hull", (-1,))
    equal = _as_indices(representatives, "representatives", (n,))
    arrays = {"triangles": corners, "neighbors": beyond, "hull": ring, "representatives": equal}
    counts = {"point_count": n, "set_count": 1, "triangle_count": len(corners), "hull_count": len(ring)}
    kept = None
    if constrained is not None:
        marks = np.ascontiguousarray(constrained, np.bool_)
        kept = _struct(_declarations.ConstrainedArrays, constrained=marks)
    result = _Triangulation()
    whole = _struct(_declarations.Mesh, **arrays, **counts)
    _call_with_mesh(library.triangulation_create, whole, kept, result.place)
    return points, n, result


def voronoi(triangulator: Triangulator, mesh: Mesh) -> dict[str, Any]:
    """The circumcentres of triangles, the cell_offsets, the corners of cells, and which are unbounded."""
    points, n, primal = _triangulation_of(mesh)
    result = _Result("voronoi")
    triangulator.make(result, library.voronoi_compute, points, n, primal)
    return result.views()


def _clipped_cells(triangulator: Triangulator, *given: Any) -> dict[str, Any]:
    """The vertices of clipped cells, their offsets, the cells' areas and centroids."""
    result = _Result("clipped_voronoi")
    triangulator.make(result, library.voronoi_clip, *given)
    return result.views()


def clipped_voronoi(triangulator: Triangulator, mesh: Mesh, corners: _Doubles) -> dict[str, Any]:
    points, n, primal = _triangulation_of(mesh)
    return _clipped_cells(triangulator, points, None, n, primal, _as_doubles(corners), len(corners))


def join_cells(
    vertices: _Doubles, offsets: _Indices, groups: _Indices, count: int, bounds: _Doubles
) -> list[_Indices]:
    """The corners of polygons of groups of cells, and where rings, parts of polygons and groups begin."""
    v = len(vertices)
    made = [np.empty(size, _INT32) for size in (v, v // 3 + 1, v // 3 + 1, count + 1)]
    given = (_as_doubles(vertices), v, np.ascontiguousarray(offsets), len(groups), groups, count)
    check(library.join_cells(*_as_arguments((*given, _as_doubles(bounds), len(bounds), *made))))
    for k in (2, 1, 0):
        made[k] = made[k][: made[k + 1][-1] + (k > 0)]
    return made


def relax(
    triangulator: Triangulator,
    points: _Doubles,
    space: _declarations.Space,
    corners: Optional[_Doubles],
    iterations: int,
) -> _Doubles:
    """Points after so many iterations of Lloyd's method."""
    relaxed = np.empty(points.shape)
    polygon = (None, 0) if corners is None else (_as_doubles(corners), len(corners))
    given = (_as_doubles(points), len(points), space, *polygon, iterations)
    triangulator.call(library.relax, triangulator, *given, relaxed)
    return relaxed


def _mesh_arguments(
    points: FloatArray, triangles: _Indices, neighbors: _Indices, values: _Doubles
) -> tuple[Any, ...]:
    """What functions take that read a surface: points, triangles, their neighbours and values."""
    n, corners = _count_points(points), _as_corners(triangles)
    if values.shape != (n,):
        raise UsageError(f"values must have the shape ({n},), not {values.shape}")
    beyond = _as_indices(neighbors, "neighbors", (len(corners), 3))
    coordinates = np.ascontiguousarray(points, _FLOAT64)
    return coordinates, n, corners, beyond, len(corners), _as_doubles(values)


def _raster_of(
    grid: tuple[float, float, float, float], max_edge: float, fill: float, pixels: _Doubles
) -> _declarations.Raster:
    rows, columns = pixels.shape
    return _declarations.Raster(
        **dict(zip(("x", "y", "dx", "dy"), grid)),
        **{"rows": rows, "columns": columns, "max_edge": max_edge, "fill": fill},
    )


def rasterize(
    triangulator: Triangulator,
    *surface: Any,
    grid: tuple[float, float, float, float],
    max_edge: float,
    fill: float,
    pixels: _Doubles,
) -> None:
    """Writes values at pixels. grid: the first pixel's x and y, and the steps to the next ones."""
    raster = _raster_of(grid, max_edge, fill, pixels)
    given = (triangulator, *_mesh_arguments(*surface), ctypes.byref(raster), pixels)
    with triangulator.turn:
        _call_with_mesh(library.rasterize, *given)


def shade_hills(
    grid: tuple[float, float, float, float], pixels: _Doubles, **shading: float
) -> npt.NDArray[np.uint8]:
    """Bands of a picture: grey, or with ``colors=True`` red, green and blue; and alpha."""
    raster = _raster_of(grid, 0, 0, pixels)
    picture = np.empty((4 if shading["colors"] else 2, *pixels.shape), np.uint8)
    given = (raster, _as_doubles(pixels), _declarations.Shading(**shading), picture)
    check(library.shade_hills(*_as_arguments(given)))
    return picture


def contours(
    triangulator: Triangulator, *surface: Any, heights: _Doubles, max_edge: float
) -> tuple[_Doubles, _Offsets, _Indices]:
    """Points, where lines begin among them, and the number of each line's height."""
    made = _Result("contours")
    given = (triangulator, *_mesh_arguments(*surface), heights, len(heights), max_edge)
    with triangulator.turn:
        _call_with_mesh(library.contours_compute, *given, made.place)
    return _lines_of(made)


class Interpolation:
    """What is interpolated and how, for any number of calls.

    values: a row of some for each point. gradients: x and y for each of them, where the method needs some; on the
    sphere, which has 3 axes, z too.
    """

    def __init__(
        self, values: _Doubles, method: str, fill: float, gradients: Optional[_Doubles] = None, axes: int = 2
    ) -> None:
        self._made_of = values, method, fill, gradients, axes
        self.values = _as_doubles(values)
        self.address, self.columns = _address_of(self.values), values.shape[1]
        if gradients is not None:
            if gradients.shape != (*values.shape, axes):
                raise UsageError(
                    f"gradients must have the shape {(*values.shape, axes)}, not {gradients.shape}"
                )
            gradients = _as_doubles(gradients)
        self.gradients = gradients
        self.options = _struct(
            _declarations.InterpolationOptions,
            method=_declarations.INTERPOLATION[method],
            columns=self.columns,
            has_fill=1,
            fill=fill,
            gradients=gradients,
        )

    def with_fill(self, fill: float) -> Interpolation:
        values, method, _, gradients, axes = self._made_of
        return Interpolation(values, method, fill, gradients, axes)

    def of(self, locator: Locator) -> Callable[[_Doubles], _Doubles]:
        """What interpolates at queries."""
        return functools.partial(locator.interpolate, self)

    def __reduce__(self) -> tuple[Any, ...]:
        return Interpolation, self._made_of


class _Locator(_InTurns):
    _destroy = library.locator_destroy
    axes = 2  # of gradients

    def _estimated(self, values: _Doubles, tolerance: float, iterations: int) -> _Doubles:
        """The estimated gradients, x and y for each of the values: a row of some for each point."""
        values = _as_doubles(values)
        options = _declarations.InterpolationOptions(
            columns=values.shape[1], gradient_tolerance=tolerance, gradient_iterations=iterations
        )
        results = np.empty((*values.shape, self.axes))
        self._call(library.locator_gradients, values, options, results)
        return results


class Locator(_Locator):
    """Answers queries on a triangulation. Queries are contiguous doubles of shape (m, 2): see `are_rows`."""

    def __init__(
        self,
        triangulator: Triangulator,
        mesh: Searched,
        constrained: Optional[npt.NDArray[np.bool_]] = None,
    ) -> None:
        """constrained: of a mesh with constraints, for each corner whether the edge opposite to it is one."""
        super().__init__(triangulator)
        points, self._point_count, primal = _triangulation_of(mesh, constrained)
        triangulator.make(self, library.locator_create, points, None, self._point_count, None, 0, primal)

    def _find(self, function: Any, queries: _Doubles) -> _Indices:
        """What a function answers to each query."""
        # Written out, since for few queries every call counts.
        m = len(queries)
        answers = np.empty(m, _INT32)
        at, out = _address_of(queries), _address_of(answers)
        with self._triangulator.turn:
            status = function(self.pointer, at, m, None, 0, out)
        if status:
            check(status)
        return answers

    def locate(self, queries: _Doubles) -> _Indices:
        """The triangle of each query; -1 outside of the hull."""
        return self._find(library.locator_locate, queries)

    def nearest(self, queries: _Doubles) -> _Indices:
        """The point that is nearest to each query; -1 if there is none."""
        return self._find(library.locator_nearest, queries)

    def natural_weights(
        self, queries: _Doubles, method: str
    ) -> tuple[_Offsets, _Indices, _Doubles]:
        """Where the rows of queries begin, points, and their weights."""
        made, by = _Result("natural_weights"), _declarations.INTERPOLATION[method]
        self._call(library.natural_weights_compute, queries, len(queries), by, made.place)
        offsets = _view(made, made.read("offsets"), (len(queries) + 1,), _INT64)
        shape = (int(offsets[-1]),)
        points = _view(made, made.read("points"), shape, _INT32)
        return offsets, points, _view(made, made.read("weights"), shape, _FLOAT64)

    def _check_rows(self, values: _Doubles) -> None:
        if len(values) != self._point_count:
            raise UsageError(
                f"points were changed: there are {len(values)} values for the {self._point_count} of the "
                "triangulation"
            )

    def interpolate(self, table: Interpolation, queries: _Doubles) -> _Doubles:
        """A row of interpolated values at each query."""
        self._check_rows(table.values)
        m = len(queries)
        results = np.empty((m, table.columns))
        at, out = _address_of(queries), _address_of(results)
        interpolate = library.locator_interpolate
        with self._triangulator.turn:
            status = interpolate(self.pointer, table.address, at, m, None, 0, table.options, out)
        if status:
            check(status)
        return results

    def gradients(self, values: _Doubles, tolerance: float, iterations: int) -> _Doubles:
        """The estimated gradients, x and y for each of the values: a row of some for each point."""
        self._check_rows(values)
        return self._estimated(values, tolerance, iterations)


class PointTree(_InTurns):
    """Points arranged for queries for the nearest ones of them."""

    _destroy = library.point_tree_destroy

    def __init__(self, triangulator: Triangulator, points: _Doubles) -> None:
        super().__init__(triangulator)
        self.count = _count_points(points)
        triangulator.make(self, library.point_tree_create, _as_doubles(points), self.count)

    @classmethod
    def in_space(cls, triangulator: Triangulator, mesh: InSpace) -> PointTree:
        """A tree of one set on a torus, where each point counts once, as it lies nearest, or on the sphere.

        There, queries are longitudes and latitudes, or x, y and z, and distances are angles.
        """
        tree = cls.__new__(cls)
        _InTurns.__init__(tree, triangulator)
        tree._on_sphere = mesh.on_sphere
        triangulator.make(tree, library.point_tree_create_in_space, mesh)
        return tree

    def nearest(
        self, queries: _Doubles, count: int, max_distance: float
    ) -> tuple[_Indices, _Doubles]:
        """A row of so many points for each query, and their distances; -1 and infinity where there are no more.

        queries: as of `Locator`.
        """
        m = len(queries)
        points, distances = np.empty((m, count), _INT32), np.empty((m, count))
        given = _address_of(queries), m, count, max_distance
        results = _address_of(points), _address_of(distances)
        with self._triangulator.turn:
            if self._on_sphere:
                self._expect(queries, library.point_tree_set_coordinates)
            status = library.point_tree_nearest(self.pointer, *given, *results)
        if status:
            check(status)
        return points, distances


class DeviceLocator(_Locator):
    """Answers queries in device memory. Buffers of results are the caller's to release, 0 if they are empty."""

    def __init__(
        self,
        triangulator: Triangulator,
        points: DevicePoints,
        mesh: DeviceTriangulation,
        enqueue: Enqueue,
    ) -> None:
        super().__init__(triangulator)
        triangulator.make(self, library.locator_create_device, points, mesh, enqueue)

    def _answer(self, function: Any, *given: Any) -> int:
        return _buffer_of(self._triangulator, function, self, *given)

    def locate(self, queries: DevicePoints, enqueue: Enqueue) -> int:
        """The triangle of each query."""
        return self._answer(library.locator_locate_device, queries, enqueue)

    def nearest(self, queries: DevicePoints, enqueue: Enqueue) -> int:
        """The point that is nearest to each query."""
        return self._answer(library.locator_nearest_device, queries, enqueue)

    def interpolate(
        self,
        values: int,
        columns: int,
        queries: DevicePoints,
        method: str,
        fill: float,
        gradients: int,
        enqueue: Enqueue,
    ) -> int:
        """A row of interpolated values at each query. gradients: 0 if they are to be estimated."""
        options = _declarations.InterpolationOptions(
            method=_declarations.INTERPOLATION[method],
            columns=columns,
            has_fill=1,
            fill=fill,
            device_gradients=gradients or None,
        )
        given = (values or None, queries, options, enqueue)
        return self._answer(library.locator_interpolate_device, *given)

    def gradients(
        self, values: int, columns: int, tolerance: float, iterations: int, enqueue: Enqueue
    ) -> int:
        """The estimated gradients, x and y for each of the values."""
        options = _declarations.InterpolationOptions(
            columns=columns, gradient_tolerance=tolerance, gradient_iterations=iterations
        )
        return self._answer(library.locator_gradients_device, values or None, options, enqueue)


# ---- Points on a sphere, on a torus or with weights


def sphere_coordinates(width: int) -> int:
    return int(_declarations.SPHERE_COORDINATES["degrees" if width == 2 else "directions"])


def sphere(width: int) -> _declarations.Space:
    """The sphere, of points that have two or three numbers."""
    return space_of("sphere", coordinates=sphere_coordinates(width))


class InSpace(_Triangulation):
    """Triangulations of sets of points in a space."""

    def __init__(
        self,
        triangulator: Triangulator,
        points: _Doubles,
        offsets: Optional[_Offsets],
        space: _declarations.Space,
    ) -> None:
        super().__init__()
        self._given = _as_doubles(points), *_as_offsets(offsets, len(points)), space
        self.on_sphere = bool(space.kind == SPACE_KINDS["sphere"])
        coordinates, starts, sets, _ = self._given
        options = _struct(_declarations.Options, parts=PART["neighbors"], space=space)
        given = (coordinates, len(points), starts, sets, options, self.place)
        triangulator.call(library.triangulate, triangulator, *given)

    @property
    def _mesh(self) -> Any:
        return library.triangulation_mesh(self.pointer)

    def arrays(self) -> Made:
        return Made(self, {"neighbors"}, self._mesh)

    def period(self) -> tuple[float, float, float]:
        return _period_of(self._mesh[0].space)

    def verify(self) -> None:
        points, starts, _, space = self._given
        check(library.mesh_verify(self._mesh, _address_of(points), _address_or_none(starts), space))

    def hiding_triangles(self, triangulator: Triangulator) -> _Indices:
        points, starts, sets, _ = self._given
        triangles = np.empty(self._mesh[0].hidden_count, np.int32)
        triangulator.call(library.hiding_triangles, triangulator, points, starts, sets, self, triangles)
        return triangles

    def clipped_cells(
        self, triangulator: Triangulator, weights: Optional[_Doubles] = None, corners: Optional[_Doubles] = None
    ) -> dict[str, Any]:
        """The cells of a torus, or with weights of one set in the plane, clipped to a polygon."""
        points, count = self._given[0], 0 if corners is None else len(corners)
        given = (points, weights, len(points), self, None if corners is None else _as_doubles(corners), count)
        return _clipped_cells(triangulator, *given)

    def voronoi(self, triangulator: Triangulator) -> dict[str, npt.NDArray[Any]]:
        """The Voronoi cells on the sphere."""
        made, n = _Result("voronoi"), len(self._given[0])
        triangulator.make(made, library.voronoi_compute, None, 0, self)
        triangles = made.read("triangle_count")
        shapes = {"circumcentres": (triangles, 3), "areas": (n,)}
        arrays = {name: _view(made, made.read(name), shape, _FLOAT64) for name, shape in shapes.items()}
        shapes = {"cell_offsets": (n + 1,), "cells": (made.read("corner_count"),)}
        arrays |= {name: _view(made, made.read(name), shape, _INT32) for name, shape in shapes.items()}
        return {"vertices": arrays.pop("circumcentres"), **arrays}


def directions_of(places: _Doubles) -> _Doubles:
    """Unit vectors of places on the sphere."""
    directions = np.empty((len(places), 3))
    check(library.directions(*_as_arguments((_as_doubles(places), len(places), directions))))
    return directions


class SpaceLocator(_Locator):
    """Answers queries on a sphere, a torus or a cylinder."""

    def __init__(self, triangulator: Triangulator, mesh: InSpace, weights: Optional[_Doubles] = None) -> None:
        super().__init__(triangulator)
        self._on_sphere = mesh.on_sphere
        if mesh.on_sphere:
            self.axes = 3
        triangulator.make(self, library.locator_create, None, weights, 0, None, 0, mesh)

    gradients = _Locator._estimated

    def _ask(
        self, function: Any, queries: _Doubles, offsets: Optional[_Offsets], *after: Any, before: tuple[Any, ...] = ()
    ) -> None:
        """Calls a function of queries. before, after: what it takes before these, and behind their sets."""
        queries = _as_doubles(queries)
        sets = _as_offsets(offsets, len(queries), what="queries")
        with self._triangulator.turn:
            if self._on_sphere:
                self._expect(queries, library.locator_set_coordinates)
            self._call(function, *before, queries, len(queries), *sets, *after)

    def _find(self, function: Any, queries: _Doubles, offsets: Optional[_Offsets]) -> _Indices:
        found = np.empty(len(queries), np.int32)
        self._ask(function, queries, offsets, found)
        return found

    def locate(self, queries: _Doubles, offsets: Optional[_Offsets]) -> _Indices:
        return self._find(library.locator_locate, queries, offsets)

    def nearest(self, queries: _Doubles, offsets: Optional[_Offsets]) -> _Indices:
        return self._find(library.locator_nearest, queries, offsets)

    def interpolate(
        self,
        values: _Doubles,
        queries: _Doubles,
        offsets: Optional[_Offsets],
        method: str,
        gradients: Optional[_Doubles],
    ) -> _Doubles:
        """A row of values at each query. values, gradients: one for each point."""
        table = Interpolation(values, method, np.nan, gradients, self.axes)
        results = np.empty((len(queries), table.columns))
        self._ask(library.locator_interpolate, queries, offsets, table.options, results, before=(table.address,))
        return results
