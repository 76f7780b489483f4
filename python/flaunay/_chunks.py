"""Triangulations of more points than fit memory."""

from __future__ import annotations

import contextlib
import os
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _declarations, _raster, _triangulators
from flaunay._arrays import (
    FloatArray,
    as_count,
    as_floats,
    as_points,
    check_out,
    check_points_shape,
    is_masked,
    number_of,
    summary,
)
from flaunay._errors import InputError, UsageError
from flaunay._periodic import as_lengths, as_period

Indices = Union[npt.NDArray[np.int32], npt.NDArray[np.int64]]
Result = Union[None, bool, str, "os.PathLike[str]"]

_COORDINATES = (np.dtype(np.float64), np.dtype(np.float32))

# The largest numbers that int32 can count; there may be twice as many triangles as points.
_MOST_32 = 2**31 - 1
_MOST_POINTS_32 = _MOST_32 // 2

_UNITS = {"": 1, "K": 2**10, "M": 2**20, "G": 2**30, "T": 2**40}
_SIZE = re.compile(r"\s*(\d+)\s*([KMGT]?)(?:I?B)?\s*", re.IGNORECASE | re.ASCII)
_MOST_BYTES = 2**64 - 1


@dataclass(frozen=True, eq=False, repr=False)
class ChunkedTriangulation:
    """The triangulation that `triangulate_chunks` made.

    Arrays that were written to files are mapped into memory, and cannot be written to. The indices are
    int32 or int64, of the same type in all arrays that have some.

    Attributes
    ----------
    triangles : ndarray or memmap of int, shape (m, 3), or None
        Three points each, counter-clockwise, the smallest index first; None if not asked for.
    neighbors : ndarray or memmap of int, shape (m, 3), or None
        The triangle opposite to each corner, -1 beyond the hull; None if not asked for.
    hull : ndarray or memmap of int, shape (h,), or None
        The convex hull with the points on its edges, counter-clockwise from the lexicographically
        smallest point. Of collinear points all distinct ones, in lexicographic order. None if not asked
        for.
    representatives : ndarray or memmap of int, shape (n,), or None
        For each point the smallest index of an equal point. Only those are in triangles. None if not
        asked for.
    areas : ndarray or memmap of float64, shape (m,), or None
        The area of each triangle, rounded to the nearest number. None if not asked for.
    corner_offsets : ndarray or memmap of int8, shape (m, 3, 2), or None
        As of `PeriodicDelaunay`. None without a period, and if not asked for.
    period : tuple of float or None
        The period, rounded as that of `PeriodicDelaunay`. `to_places` takes points to their places.
    statistics : dict
        The numbers of ``points``, ``duplicates``, ``triangles`` and ``hull_vertices``; the ``rounds``,
        each with its ``points``, ``chunks``, final ``triangles`` and points ``handed_on``; the
        ``devices``, each with the ``points`` of its chunks; ``phases``, ``seconds`` and others.
        ``images``, with a period, is how many images of points were triangulated, too;
        ``host_points`` and ``note`` say what devices without double precision have left to the host.
    """

    triangles: Optional[Indices]
    neighbors: Optional[Indices]
    hull: Optional[Indices]
    representatives: Optional[Indices]
    areas: Optional[FloatArray]
    corner_offsets: Optional[npt.NDArray[np.int8]]
    period: Optional[tuple[float, ...]]
    statistics: dict[str, Any]

    def __repr__(self) -> str:
        return summary(
            self,
            points=self.statistics["points"],
            triangles=self.statistics["triangles"],
            hull_vertices=self.statistics["hull_vertices"],
        )


def _as_source(points: npt.ArrayLike) -> FloatArray:
    """An array of float64 or float32 as it is, whatever its strides; anything else as `triangulate` takes it."""
    if isinstance(points, np.ndarray) and points.dtype in _COORDINATES and not is_masked(points):
        check_points_shape(points)
        return points
    return as_points(points)


def _as_wanted(results: dict[str, Result], points: object) -> dict[str, Optional[str]]:
    """For each array that is wanted its path, or None if it goes to memory."""
    wanted: dict[str, Optional[str]] = {}
    taken: dict[str, str] = {}
    if isinstance(points, np.memmap) and isinstance(points.filename, (str, os.PathLike)):
        taken[os.path.realpath(points.filename)] = "the points"
    for name, result in results.items():
        if result is None or result is False:
            continue
        if result is True:
            wanted[name] = None
            continue
        if not isinstance(result, (str, os.PathLike)):
            raise UsageError(f"{name} must be a path, True or None, not {type(result).__name__}")
        path = os.fspath(result)
        if not isinstance(path, str) or not path.endswith(".npy"):
            raise UsageError(f"{name}: {path!r} must end in .npy")
        place = os.path.realpath(path)
        if place in taken:
            raise UsageError(f"{name}: {path!r} is the file of {taken[place]}")
        taken[place] = name
        wanted[name] = path
    return wanted


def _as_bytes(memory: Union[None, int, str]) -> int:
    """A number of bytes; 0 if it is left to the library."""
    if memory is None:
        return 0
    if isinstance(memory, str):
        match = _SIZE.fullmatch(memory)
        if match is None:
            raise UsageError(
                f"memory {memory!r} is no size such as 4G; K, M, G and T are powers of 1024"
            )
        size = int(match[1]) * _UNITS[match[2].upper()]
    else:
        size = as_count(memory, "memory")
    if not 0 < size <= _MOST_BYTES:
        raise UsageError(f"memory must be from 1 to {_MOST_BYTES} bytes, not {size}")
    return size


def _is_wide(index: Optional[int], n: int, wanted: dict[str, Optional[str]]) -> bool:
    """Whether the indices are int64."""
    if index is None:
        return n > _MOST_POINTS_32
    if index not in (32, 64):
        raise UsageError(f"index must be 32, 64 or None, not {index!r}")
    most = _MOST_POINTS_32 if "neighbors" in wanted else _MOST_32
    if index == 32 and n > most:
        raise UsageError(f"{n} points are too many for index=32; at most {most} are possible")
    return index == 64


def chunks_of(
    memory: Union[None, int, str],
    scratch: Union[None, str, os.PathLike[str]],
    devices: Union[None, str, Sequence[str]],
    chunk_points: Optional[int],
    progress: _calls.Progress,
) -> _calls.Chunks:
    """What `triangulate_chunks` is told of these names."""
    return _calls.Chunks(
        _as_bytes(memory),
        b"" if scratch is None else os.fsencode(scratch),
        _triangulators.names_for_chunks(devices),
        0 if chunk_points is None else as_count(chunk_points, "chunk_points", 1),
        progress,
    )


def triangulate_chunks(
    points: npt.ArrayLike,
    *,
    triangles: Result = None,
    neighbors: Result = None,
    hull: Result = None,
    representatives: Result = None,
    areas: Result = None,
    corner_offsets: Result = None,
    period: Optional[Sequence[Optional[float]]] = None,
    memory: Union[None, int, str] = None,
    scratch: Union[None, str, os.PathLike[str]] = None,
    devices: Union[None, str, Sequence[str]] = None,
    chunk_points: Optional[int] = None,
    index: Optional[int] = None,
    progress: Optional[Callable[[str, int, float], object]] = None,
) -> ChunkedTriangulation:
    """Triangulates one set of points in chunks, so that neither it nor the result must fit memory.

    What is final in a chunk is written; points around which something is missing, some hundredths of a
    chunk's, go on to chunks that are cut otherwise, until one chunk has them all. The set of triangles
    with their neighbours and areas, the hull and the representatives are those of `triangulate`.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Coordinates. Arrays of float64 and float32 are read in pieces and never copied as a whole,
        whatever their strides: give ``numpy.load(path, mmap_mode="r")`` or a ``numpy.memmap``. Other
        numbers become float64 in memory, and must be one exactly. They must not change during the
        call.
    triangles, neighbors, hull, representatives, areas : path, bool or None
        Where each array goes: to a file whose path ends in ``.npy``, or with True to an array in
        memory. None and False: it is not wanted. Either all files are written, or after an error none:
        what was there before stays. Without any, the call finds the numbers alone.
    corner_offsets : path, bool or None
        As those, with a period alone.
    period : sequence of float or None, optional
        As of `periodic`: triangulates on a torus or a cylinder, with the triangles of that. There is no hull.
        Images of points near the border are in memory, 48 bytes each.
    memory : int or str, optional
        Bytes that the call may use on the host, such as ``"4G"``; K, M, G and T are powers of 1024.
        What the system keeps of files, and arrays in memory, do not count. Without it, half of what is
        free.
    scratch : path, optional
        The folder for the points of chunks, 24 bytes per point, in a file without a name. Without it,
        TMPDIR, or /tmp.
    devices : str or sequence of str, optional
        The devices, each named as for `triangulate`; ``"all"``: every usable one. They take chunks from
        one queue. Without it, flaunay chooses one.
    chunk_points : int, optional
        Points of a chunk. Without it, as many as suit the devices.
    index : 32 or 64, optional
        Bits of the indices. Without it, 64 if there are more than 2^30 - 1 points, since there may be
        twice as many triangles.
    progress : callable, optional
        Called from time to time, on the calling thread, as ``progress(stage, round, done)``, with
        ``"images"`` (with a period alone), ``"sampling"``, ``"distributing"`` or ``"triangulating"``, the
        round of chunks, from 0, and the finished share of the call, 0 to 1. An exception that it raises ends
        the call.

    Returns
    -------
    ChunkedTriangulation

    Raises
    ------
    UsageError
        For a wrong shape, what is no number, a path that does not end in ``.npy``, options that make no
        sense, and too little memory for any work.
    InputError
        For a point that is not finite, magnitudes too different to be exact, or too many points; if a
        disk has no room for the chunks or the results, or a file cannot be written; if the points that
        are left to the last chunk do not fit the memory, as of points that are all on one circle.
    DeviceError
        If there is no such device, or calls of OpenCL failed on all devices.
    KeyboardInterrupt
        After Ctrl-C, when the chunks in work are done. Nothing is left behind.

    Notes
    -----
    O(n log n) work. The interpreter's lock is released meanwhile. The order of the rows is that of rounds,
    then of chunks, so it depends on the options, too.

    Examples
    --------
    >>> import flaunay, numpy as np, os, tempfile
    >>> folder = tempfile.TemporaryDirectory()
    >>> path = os.path.join(folder.name, "points.npy")
    >>> np.save(path, np.random.default_rng(1).random((5000, 2)))
    >>> mesh = flaunay.triangulate_chunks(
    ...     np.load(path, mmap_mode="r"),
    ...     triangles=os.path.join(folder.name, "triangles.npy"),
    ...     hull=True,
    ...     chunk_points=1000,
    ... )
    >>> mesh
    <flaunay.ChunkedTriangulation: 5000 points, 9972 triangles, 26 hull vertices>
    >>> mesh.triangles.shape, mesh.triangles.dtype
    ((9972, 3), dtype('int32'))
    >>> type(mesh.triangles).__name__, type(mesh.hull).__name__, mesh.neighbors
    ('memmap', 'ndarray', None)
    >>> folder.cleanup()
    """
    given = locals()
    source = _as_source(points)
    names = [*_declarations.MESH_ARRAYS, "corner_offsets"]
    wanted = _as_wanted({name: given[name] for name in names}, points)
    lengths = None if period is None else as_lengths(period)
    if lengths is None and "corner_offsets" in wanted:
        raise UsageError("corner_offsets are wanted, but there is no period")
    chunks = chunks_of(memory, scratch, devices, chunk_points, progress)
    if lengths is not None:
        chunks.space = _calls.space_of("torus", lengths)
    in_memory, statistics = _calls.triangulate_chunks(
        source,
        {name: None if path is None else os.fsencode(path) for name, path in wanted.items()},
        _is_wide(index, len(source), wanted),
        chunks,
    )
    arrays: dict[str, Any] = dict.fromkeys(names)
    for name, path in wanted.items():
        stored = in_memory[name] if path is None else np.load(path, mmap_mode="r")
        arrays[name] = stored.reshape(-1, 3, 2) if name == "corner_offsets" else stored
    if lengths is not None:
        lengths = as_period(_calls.take_to_places(lengths, np.empty(0)))
    return ChunkedTriangulation(**arrays, period=lengths, statistics=statistics)


@contextlib.contextmanager
def all_or_none(paths: Sequence[Path]) -> Iterator[list[str]]:
    """Names of temporary files, which take the place of files when all are written.

    Symbolic links are followed, and permissions are kept.
    """
    targets = [Path(os.path.realpath(path)) for path in paths]
    for k, (path, target) in enumerate(zip(paths, targets)):
        if target.exists() and not target.is_file():
            raise UsageError(f"output {path} is no regular file")
        if any(is_one_file(target, other) for other in targets[:k]):
            raise UsageError(f"output {path}: two outputs have the same path")
    try:
        with contextlib.ExitStack() as stack:
            names = []
            for target in targets:
                folder = stack.enter_context(
                    tempfile.TemporaryDirectory(prefix=".flaunay-", dir=target.parent)
                )
                names.append(os.path.join(folder, target.name))
            yield names
            for name, target in zip(names, targets):
                if target.exists():
                    os.chmod(name, target.stat().st_mode & 0o7777)
                os.replace(name, target)
    except OSError as error:
        raise InputError(f"outputs cannot be written: {error}") from error


def is_one_file(path: Path, other: Path) -> bool:
    """Whether two paths lead to one file, which need not be there."""
    if path.exists() and other.exists():
        return path.samefile(other)
    return os.path.realpath(path) == os.path.realpath(other)


def _new_pixels(path: str, shape: tuple[int, int]) -> npt.NDArray[np.float64]:
    """A file that is mapped into memory, with room on the disk: without it, writing would end the process."""
    open_memmap: Callable[..., npt.NDArray[np.float64]] = np.lib.format.open_memmap
    pixels = open_memmap(path, "w+", np.float64, shape)
    if hasattr(os, "posix_fallocate"):
        with open(path, "r+b") as file:
            os.posix_fallocate(file.fileno(), 0, os.path.getsize(path))
    return pixels


def _as_valued(
    points: npt.ArrayLike, values: npt.ArrayLike, duplicates: str
) -> tuple[FloatArray, FloatArray, int]:
    """Points, their values, and the number of what equal points have."""
    source = _as_source(points)
    if isinstance(values, np.ndarray) and values.dtype in _COORDINATES and not is_masked(values):
        numbers: FloatArray = values
    else:
        numbers = as_floats(values, "values")
    if numbers.shape != (len(source),):
        raise UsageError(f"values must have the shape ({len(source)},), not {numbers.shape}")
    return source, numbers, number_of(_declarations.DUPLICATES, duplicates, "duplicates")


def rasterize_chunks(
    points: npt.ArrayLike,
    values: npt.ArrayLike,
    shape: tuple[int, int],
    bounds: Optional[Sequence[float]] = None,
    *,
    duplicates: str = "highest",
    max_edge: Optional[float] = None,
    fill_value: float = np.nan,
    out: Union[None, str, os.PathLike[str], npt.NDArray[np.float64]] = None,
    memory: Union[None, int, str] = None,
    scratch: Union[None, str, os.PathLike[str]] = None,
    devices: Union[None, str, Sequence[str]] = None,
    chunk_points: Optional[int] = None,
    progress: Optional[Callable[[str, int, float], object]] = None,
) -> npt.NDArray[np.float64]:
    """The raster of more points than fit memory: what `Delaunay.raster` makes of all, triangulated in chunks.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        As of `triangulate_chunks`: arrays of float64 and float32 are read in pieces, whatever their strides, such as
        ``scan[:, :2]`` of a ``numpy.load(path, mmap_mode="r")`` with x, y and z.
    values : array_like, shape (n,)
        One number per point, such as ``scan[:, 2]``, read in pieces likewise.
    shape, bounds, max_edge, fill_value
        As of `Delaunay.raster`.
    duplicates : {"highest", "lowest", "mean"}
        The value of a place where several points are equal.
    out : path or ndarray of float64, optional
        A file whose path ends in ``.npy``, which is written as a whole or stays as it was, or an array of this shape.
    memory, scratch, devices, chunk_points, progress
        As of `triangulate_chunks`. Memory does not count the raster; the scratch folder takes 32 bytes per point.

    Returns
    -------
    ndarray or memmap of float64, of the shape
        A file is mapped into memory, and cannot be written to.

    Raises
    ------
    UsageError, InputError, DeviceError
        As `triangulate_chunks` and `Delaunay.raster`.
    OSError
        If the file cannot be made or the disk has no room for it.

    Notes
    -----
    The raster has the same bytes whatever the chunks and the order of points. O(n log n + pixels).

    Examples
    --------
    >>> import flaunay, numpy as np
    >>> scan = np.array([[0, 0, 0], [4, 0, 8], [0, 4, 4.0]])
    >>> flaunay.rasterize_chunks(scan[:, :2], scan[:, 2], shape=(2, 4))
    array([[ 4., nan, nan, nan],
           [ 2.,  4.,  6., nan]])
    """
    source, numbers, kind = _as_valued(points, values, duplicates)
    if bounds is None and not len(source):
        raise UsageError("bounds are needed, as there are no points")
    shape, grid = _raster.grid_of(shape, bounds, source)
    longest = _raster.as_length(max_edge, "max_edge")
    chunks = chunks_of(memory, scratch, devices, chunk_points, progress)

    def rasterize(pixels: npt.NDArray[np.float64]) -> None:
        _calls.rasterize_chunks(
            *(source, numbers, kind, grid, longest, float(fill_value), pixels, np.empty(0)), chunks
        )

    if out is None:
        out = np.empty(shape)
    elif not isinstance(out, np.ndarray):
        path = _as_wanted({"out": out}, points)["out"]
        assert path is not None
        with all_or_none([Path(path)]) as (name,):
            rasterize(_new_pixels(name, shape))
        return np.load(path, mmap_mode="r")  # type: ignore[no-any-return]
    check_out(out, np.float64, shape, "out")
    rasterize(out)
    return out


def contour_chunks(
    points: npt.ArrayLike,
    values: npt.ArrayLike,
    heights: Union[npt.ArrayLike, float],
    *,
    duplicates: str = "highest",
    max_edge: Optional[float] = None,
    memory: Union[None, int, str] = None,
    scratch: Union[None, str, os.PathLike[str]] = None,
    devices: Union[None, str, Sequence[str]] = None,
    chunk_points: Optional[int] = None,
    progress: Optional[Callable[[str, int, float], object]] = None,
) -> _raster.Contours:
    """Contours of more points than fit memory: what `Delaunay.contours` makes of all, triangulated in chunks.

    Parameters
    ----------
    points, values, duplicates, max_edge, memory, scratch, devices, chunk_points, progress
        As of `rasterize_chunks`. Memory does not count the lines.
    heights : array_like
        The heights of lines, or one of them, in any order.

    Returns
    -------
    Contours

    Raises
    ------
    UsageError, InputError, DeviceError
        As `triangulate_chunks` and `Delaunay.contours`.

    Examples
    --------
    >>> import flaunay, numpy as np
    >>> scan = np.array([[0, 0, 0], [4, 0, 4], [0, 4, 4.0]])
    >>> for height, line in flaunay.contour_chunks(scan[:, :2], scan[:, 2], [1, 2]):
    ...     print(height, line.tolist())
    1.0 [[0.0, 1.0], [1.0, 0.0]]
    2.0 [[0.0, 2.0], [2.0, 0.0]]
    """
    source, numbers, kind = _as_valued(points, values, duplicates)
    levels = np.unique(np.asarray(as_floats(heights, "heights"), np.float64))
    longest = _raster.as_length(max_edge, "max_edge")
    chunks = chunks_of(memory, scratch, devices, chunk_points, progress)
    lines, offsets, of = _calls.rasterize_chunks(
        *(source, numbers, kind, (0.0, 0.0, 1.0, 1.0), longest, 0.0, np.empty((0, 0)), levels),
        chunks,
    )
    return _raster.Contours(lines, offsets, levels[of])
