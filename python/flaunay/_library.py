"""The C interface of flaunay, as flaunay.h declares it.

What is here has the names of the header, without their prefix. A test compares both.
"""

from __future__ import annotations

import ctypes
import os
from ctypes import (
    POINTER,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_ssize_t,
    c_uint,
    c_uint64,
    c_void_p,
)
from typing import Any, Optional

from flaunay._errors import DeviceError, Error, InputError, InternalError, UsageError

SUCCESS, _ERROR_INTERNAL, _ERROR_USAGE, _ERROR_INPUT, _ERROR_DEVICE, _ERROR_MEMORY = range(6)
ERROR_STOPPED = 6

_CLASSES: dict[int, type[Error]] = {
    _ERROR_INTERNAL: InternalError,
    _ERROR_USAGE: UsageError,
    _ERROR_INPUT: InputError,
    _ERROR_DEVICE: DeviceError,
}

FLOAT64, FLOAT32 = 0, 1
INT32, INT64 = 0, 1

# The values of flaunay_interpolation.
INTERPOLATIONS = {"linear": 0, "nearest": 1, "clough_tocher": 2, "sibson": 3, "laplace": 4}

# The bits of flaunay_part.
PARTS = {"triangles": 1, "neighbors": 2, "halfedges": 4, "hull": 8, "representatives": 16}

# The values of flaunay_crossings, flaunay_outside, flaunay_fill_rule and flaunay_overlaps.
CROSSINGS = {"error": 0, "split": 1}
OUTSIDE = {"keep": 0, "hull": 1, "holes": 2}
FILL_RULES = {"nesting": 0, "even_odd": 1, "winding": 2}
OVERLAPS = {"first": 0, "error": 1}

# The bits of flaunay_voronoi_part, and of flaunay_clipped_voronoi_part.
VORONOI_PARTS = {"circumcentres": 1, "cell_offsets": 2, "cells": 4, "unbounded": 8}
CLIPPED_VORONOI_PARTS = {"vertices": 1, "offsets": 2, "areas": 4, "centroids": 8}

# OpenCL's handles and those of flaunay are pointers to what Python does not look into.
_Progress = ctypes.CFUNCTYPE(None, c_char_p, c_int, c_double, c_void_p)
ChunkProgress = ctypes.CFUNCTYPE(c_int, c_char_p, c_int, c_double, c_void_p)


class ModeInfo(ctypes.Structure):
    _fields_ = [
        ("mode", c_int),
        ("name", c_char_p),
        ("description", c_char_p),
        ("on_host", c_int),
    ]


class Options(ctypes.Structure):
    _fields_ = [
        ("mode", c_int),
        ("cut", c_int),
        ("hull", c_int),
        ("parts", c_uint),
        ("profile", c_int),
        ("partition_levels", c_int),
        ("threads", c_int),
        ("finish", c_int),
        ("progress", _Progress),
        ("progress_data", c_void_p),
        ("reserved", c_size_t * 8),
    ]


class DevicePoints(ctypes.Structure):
    _fields_ = [
        ("memory", c_void_p),
        ("count", c_size_t),
        ("precision", c_int),
        ("first", c_size_t),
        ("offsets", c_void_p),
        ("device_offsets", c_void_p),
        ("sets", c_size_t),
        ("reserved", c_size_t * 4),
    ]


class Enqueue(ctypes.Structure):
    _fields_ = [
        ("queue", c_void_p),
        ("wait_for", c_void_p),
        ("wait_for_count", c_size_t),
        ("event", c_void_p),
        ("profile", c_int),
        ("reserved", c_size_t * 4),
    ]


class InterpolationOptions(ctypes.Structure):
    _fields_ = [
        ("method", c_int),
        ("columns", c_size_t),
        ("has_fill", c_int),
        ("fill", c_double),
        ("gradients", c_void_p),
        ("device_gradients", c_void_p),
        ("gradient_tolerance", c_double),
        ("gradient_iterations", c_size_t),
        ("reserved", c_size_t * 8),
    ]


class ChunkOptions(ctypes.Structure):
    _fields_ = [
        ("memory_bytes", c_uint64),
        ("scratch", c_char_p),
        ("devices", c_void_p),
        ("device_count", c_size_t),
        ("triangulators", c_void_p),
        ("triangulator_count", c_size_t),
        ("chunk_points", c_size_t),
        ("progress", ChunkProgress),
        ("progress_data", c_void_p),
        ("reserved", c_size_t * 8),
    ]


class MeshArrays(ctypes.Structure):
    _fields_ = [
        ("index_type", c_int),
        ("triangles", c_void_p),
        ("neighbors", c_void_p),
        ("hull", c_void_p),
        ("representatives", c_void_p),
        ("reserved", c_size_t * 4),
    ]


class StridedPoints(ctypes.Structure):
    _fields_ = [
        ("coordinates", c_void_p),
        ("count", c_uint64),
        ("precision", c_int),
        ("point_stride", c_ssize_t),
        ("coordinate_stride", c_ssize_t),
        ("reserved", c_size_t * 4),
    ]


class MeshFiles(ctypes.Structure):
    _fields_ = [
        ("triangles", c_char_p),
        ("neighbors", c_char_p),
        ("hull", c_char_p),
        ("representatives", c_char_p),
        ("reserved", c_size_t * 4),
    ]


class Phase(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("seconds", c_double)]


class Kernel(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("launches", c_size_t), ("seconds", c_double)]


class Statistics(ctypes.Structure):
    _fields_ = [
        ("device", c_char_p),
        ("points", c_size_t),
        ("duplicates", c_size_t),
        ("triangles", c_size_t),
        ("hull_vertices", c_size_t),
        ("seconds", c_double),
        ("build_seconds", c_double),
        ("kernel_launches", c_size_t),
        ("host_waits", c_size_t),
        ("bytes_to_device", c_size_t),
        ("bytes_to_host", c_size_t),
        ("device_allocations", c_size_t),
        ("device_bytes_peak", c_size_t),
        ("undecided", c_size_t),
        ("rounds", c_size_t),
        ("round_points", c_size_t),
        ("merged_points", c_size_t),
        ("phases", POINTER(Phase)),
        ("phase_count", c_size_t),
        ("kernels", POINTER(Kernel)),
        ("kernel_count", c_size_t),
        ("note", c_char_p),
    ]


class Mesh(ctypes.Structure):
    _fields_ = [
        ("point_count", c_size_t),
        ("set_count", c_size_t),
        ("triangle_count", c_size_t),
        ("hull_count", c_size_t),
        ("triangles", c_void_p),
        ("neighbors", c_void_p),
        ("halfedges", c_void_p),
        ("hull", c_void_p),
        ("representatives", c_void_p),
        ("triangle_offsets", c_void_p),
        ("hull_offsets", c_void_p),
        ("statistics", POINTER(Statistics)),
    ]


class Constraints(ctypes.Structure):
    _fields_ = [
        ("segments", c_void_p),
        ("segment_count", c_size_t),
        ("holes", c_void_p),
        ("hole_count", c_size_t),
        ("hole_offsets", c_void_p),
        ("crossings", c_int),
        ("outside", c_int),
        ("fill_rule", c_int),
        ("labels", c_int),
        ("reserved", c_size_t * 8),
    ]


class Polygons(ctypes.Structure):
    _fields_ = [
        ("coordinates", c_void_p),
        ("ring_offsets", c_void_p),
        ("ring_count", c_size_t),
        ("polygon_offsets", c_void_p),
        ("polygon_count", c_size_t),
        ("crossings", c_int),
        ("has_outside", c_int),
        ("outside", c_int),
        ("has_fill_rule", c_int),
        ("fill_rule", c_int),
        ("labels", c_int),
        ("map", c_int),
        ("overlaps", c_int),
        ("part_offsets", c_void_p),
        ("part_count", c_size_t),
        ("reserved", c_size_t * 6),
    ]


class ConstrainedArrays(ctypes.Structure):
    _fields_ = [
        ("added_count", c_size_t),
        ("constraint_count", c_size_t),
        ("segment_count", c_size_t),
        ("piece_count", c_size_t),
        ("added_points", c_void_p),
        ("added_offsets", c_void_p),
        ("constraint_edges", c_void_p),
        ("edge_segments", c_void_p),
        ("piece_offsets", c_void_p),
        ("piece_edges", c_void_p),
        ("constrained", c_void_p),
        ("depths", c_void_p),
        ("regions", c_void_p),
        ("polygons", c_void_p),
    ]


class ChunkRound(ctypes.Structure):
    _fields_ = [
        ("points", c_uint64),
        ("chunks", c_uint64),
        ("triangles", c_uint64),
        ("handed_on", c_uint64),
    ]


class ChunkDevice(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("points", c_uint64)]


class ChunkStatistics(ctypes.Structure):
    _fields_ = [
        ("points", c_uint64),
        ("duplicates", c_uint64),
        ("triangles", c_uint64),
        ("hull_vertices", c_uint64),
        ("undecided", c_uint64),
        ("scratch_bytes", c_uint64),
        ("chunk_points", c_size_t),
        ("seconds", c_double),
        ("rounds", POINTER(ChunkRound)),
        ("round_count", c_size_t),
        ("devices", POINTER(ChunkDevice)),
        ("device_count", c_size_t),
        ("phases", POINTER(Phase)),
        ("phase_count", c_size_t),
        ("host_points", c_uint64),
        ("note", c_char_p),
    ]


class DeviceInfo(ctypes.Structure):
    _fields_ = [
        ("name", c_char_p),
        ("platform", c_char_p),
        ("vendor", c_char_p),
        ("driver", c_char_p),
        ("version", c_char_p),
        ("type", c_char_p),
        ("compute_units", c_uint),
        ("clock_mhz", c_uint),
        ("memory_bytes", c_size_t),
        ("largest_buffer_bytes", c_size_t),
        ("local_memory_bytes", c_size_t),
        ("work_group_size", c_size_t),
        ("fp64", c_int),
        ("self_test_passed", c_int),
        ("self_test_failure", c_char_p),
        ("available_bytes", c_size_t),
        ("fixed_point", c_int),
    ]


# The type of the result, and those of the arguments. Arrays and handles are addresses.
_TRIANGULATE = [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(Options), c_void_p]
_OF_TRIANGLES = [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p]
_ANSWER = [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_void_p]
_DEVICE_ANSWER = [c_void_p, POINTER(DevicePoints), POINTER(Enqueue), c_void_p]

FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "last_error": (c_char_p, []),
    "last_error_status": (c_int, []),
    "last_error_code": (c_int, []),
    "last_error_call": (c_char_p, []),
    "version": (c_char_p, []),
    "add_driver": (c_int, [c_char_p, c_char_p]),
    "device_list_create": (c_int, [c_int, c_void_p]),
    "device_list_destroy": (None, [c_void_p]),
    "device_list_count": (c_size_t, [c_void_p]),
    "device_list_at": (POINTER(DeviceInfo), [c_void_p, c_size_t]),
    "triangulator_create": (c_int, [c_char_p, c_void_p]),
    "triangulator_create_in_context": (c_int, [c_void_p, c_void_p, c_void_p]),
    "triangulator_destroy": (None, [c_void_p]),
    "triangulator_context": (c_void_p, [c_void_p]),
    "triangulator_device_id": (c_void_p, [c_void_p]),
    "triangulator_queue": (c_void_p, [c_void_p]),
    "triangulator_capacity": (c_size_t, [c_void_p]),
    "mode_count": (c_size_t, []),
    "mode_at": (POINTER(ModeInfo), [c_size_t]),
    "triangulate": (c_int, _TRIANGULATE),
    "triangulate_float": (c_int, _TRIANGULATE),
    "triangulate_on_host": (c_int, _TRIANGULATE[1:]),
    "triangulation_create": (
        c_int,
        [c_size_t, c_void_p, c_size_t, c_void_p, c_void_p, c_size_t, c_void_p, c_void_p],
    ),
    "triangulation_destroy": (None, [c_void_p]),
    "triangulation_mesh": (POINTER(Mesh), [c_void_p]),
    "triangulate_constrained": (
        c_int,
        [
            c_void_p,
            c_void_p,
            c_size_t,
            c_void_p,
            c_size_t,
            POINTER(Constraints),
            POINTER(Options),
            c_void_p,
        ],
    ),
    "triangulate_polygons": (c_int, [c_void_p, POINTER(Polygons), POINTER(Options), c_void_p]),
    "constrained_destroy": (None, [c_void_p]),
    "constrained_mesh": (POINTER(Mesh), [c_void_p]),
    "constrained_get_arrays": (POINTER(ConstrainedArrays), [c_void_p]),
    "first_triangles": (c_int, [c_void_p, c_size_t, c_size_t, c_void_p]),
    "vertex_neighbors": (
        c_int,
        [c_void_p, c_size_t, c_void_p, c_size_t, c_size_t, c_void_p, c_void_p],
    ),
    "triangle_turns": (c_int, _OF_TRIANGLES),
    "triangle_angles": (c_int, _OF_TRIANGLES),
    "circumradii": (c_int, _OF_TRIANGLES),
    "same_circles": (c_int, [*_OF_TRIANGLES, c_void_p]),
    "device_triangulation_create": (c_int, [c_void_p]),
    "device_triangulation_destroy": (None, [c_void_p]),
    "device_triangulation_buffer": (c_void_p, [c_void_p, c_uint]),
    "device_triangulation_parts": (c_uint, [c_void_p]),
    "device_triangulation_point_count": (c_size_t, [c_void_p]),
    "device_triangulation_set_count": (c_size_t, [c_void_p]),
    "device_triangulation_triangle_count": (c_size_t, [c_void_p]),
    "device_triangulation_hull_count": (c_size_t, [c_void_p]),
    "device_triangulation_triangle_offsets": (c_void_p, [c_void_p]),
    "device_triangulation_hull_offsets": (c_void_p, [c_void_p]),
    "device_triangulation_statistics": (POINTER(Statistics), [c_void_p]),
    "triangulate_device": (
        c_int,
        [c_void_p, POINTER(DevicePoints), c_uint, POINTER(Enqueue), c_void_p],
    ),
    "triangulate_chunks_to_files": (
        c_int,
        [
            POINTER(StridedPoints),
            POINTER(MeshArrays),
            POINTER(MeshFiles),
            POINTER(ChunkOptions),
            c_void_p,
        ],
    ),
    "chunk_report_destroy": (None, [c_void_p]),
    "chunk_report_statistics": (POINTER(ChunkStatistics), [c_void_p]),
    "voronoi_compute": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p, c_void_p]),
    "voronoi_destroy": (None, [c_void_p]),
    "voronoi_triangle_count": (c_size_t, [c_void_p]),
    "voronoi_corner_count": (c_size_t, [c_void_p]),
    "voronoi_circumcentres": (c_void_p, [c_void_p]),
    "voronoi_cell_offsets": (c_void_p, [c_void_p]),
    "voronoi_cells": (c_void_p, [c_void_p]),
    "voronoi_unbounded": (c_void_p, [c_void_p]),
    "voronoi_clip": (
        c_int,
        [c_void_p, c_void_p, c_size_t, c_void_p, c_void_p, c_size_t, c_void_p],
    ),
    "clipped_voronoi_destroy": (None, [c_void_p]),
    "clipped_voronoi_vertex_count": (c_size_t, [c_void_p]),
    "clipped_voronoi_vertices": (c_void_p, [c_void_p]),
    "clipped_voronoi_offsets": (c_void_p, [c_void_p]),
    "clipped_voronoi_areas": (c_void_p, [c_void_p]),
    "clipped_voronoi_centroids": (c_void_p, [c_void_p]),
    "device_voronoi_create": (c_int, [c_void_p]),
    "device_voronoi_destroy": (None, [c_void_p]),
    "device_voronoi_buffer": (c_void_p, [c_void_p, c_uint]),
    "voronoi_compute_device": (
        c_int,
        [c_void_p, POINTER(DevicePoints), c_void_p, POINTER(Enqueue), c_void_p],
    ),
    "device_clipped_voronoi_create": (c_int, [c_void_p]),
    "device_clipped_voronoi_destroy": (None, [c_void_p]),
    "device_clipped_voronoi_buffer": (c_void_p, [c_void_p, c_uint]),
    "device_clipped_voronoi_vertex_count": (c_size_t, [c_void_p]),
    "voronoi_clip_device": (
        c_int,
        [
            c_void_p,
            POINTER(DevicePoints),
            c_void_p,
            c_void_p,
            c_size_t,
            POINTER(Enqueue),
            c_void_p,
        ],
    ),
    "relax_device": (
        c_int,
        [
            c_void_p,
            POINTER(DevicePoints),
            c_void_p,
            c_size_t,
            c_size_t,
            POINTER(Enqueue),
            c_void_p,
        ],
    ),
    "relax": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_size_t, c_void_p]),
    "locator_create": (
        c_int,
        [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_void_p],
    ),
    "locator_destroy": (None, [c_void_p]),
    "locator_locate": (c_int, _ANSWER),
    "locator_nearest": (c_int, _ANSWER),
    "locator_interpolate_with": (
        c_int,
        [
            c_void_p,
            c_void_p,
            c_void_p,
            c_size_t,
            c_void_p,
            c_size_t,
            POINTER(InterpolationOptions),
            c_void_p,
        ],
    ),
    "locator_create_device": (
        c_int,
        [c_void_p, POINTER(DevicePoints), c_void_p, POINTER(Enqueue), c_void_p],
    ),
    "locator_locate_device": (c_int, _DEVICE_ANSWER),
    "locator_nearest_device": (c_int, _DEVICE_ANSWER),
    "locator_interpolate_with_device": (
        c_int,
        [
            c_void_p,
            c_void_p,
            POINTER(DevicePoints),
            POINTER(InterpolationOptions),
            POINTER(Enqueue),
            c_void_p,
        ],
    ),
    "locator_gradients_device": (
        c_int,
        [c_void_p, c_void_p, POINTER(InterpolationOptions), POINTER(Enqueue), c_void_p],
    ),
    "locator_gradients": (c_int, [c_void_p, c_void_p, POINTER(InterpolationOptions), c_void_p]),
}


def _load() -> ctypes.CDLL:
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "libflaunay.so")
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(
            f"flaunay's library cannot be loaded: {error}; install the package with pip", path=path
        ) from error
    for name, (result, arguments) in FUNCTIONS.items():
        function = library[f"flaunay_{name}"]
        function.restype, function.argtypes = result, arguments
        setattr(library, name, function)
    return library


# Its functions have the names above. The interpreter's lock is released while one is at work.
library = _load()


def text_of(value: Optional[bytes]) -> str:
    return "" if value is None else value.decode("utf-8", "replace")


def error_of(status: int) -> Exception:
    """The exception for a call that failed, with the message of this thread's last error."""
    message = text_of(library.last_error())
    if status == _ERROR_MEMORY:
        return MemoryError(message)
    kind = _CLASSES.get(status, InternalError)
    return kind(message, library.last_error_code(), text_of(library.last_error_call()))


def check(status: int) -> None:
    """Raises the exception of a status that is not success."""
    if status != SUCCESS:
        raise error_of(status)


class Handle:
    """A handle of the library, destroyed when nothing refers to it any more."""

    # Kept here because modules are emptied before the last handles are destroyed.
    _destroy: Any

    def __init__(self) -> None:
        self.pointer = ctypes.c_void_p()

    @property
    def place(self) -> Any:
        """Where a function writes the new handle."""
        return ctypes.byref(self.pointer)

    def _release(self) -> None:
        self._destroy(self.pointer)

    def __del__(self) -> None:
        if self.pointer:
            self._release()


class DeviceHandle(Handle):
    """A handle that may hold what is on a device, which a forked child must not release."""

    _process_id = staticmethod(os.getpid)

    def __init__(self) -> None:
        super().__init__()
        self._process = os.getpid()

    def __del__(self) -> None:
        if self.pointer and self._process == self._process_id():
            self._release()
