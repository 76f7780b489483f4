"""What meshes are refined to, and how that went."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay._arrays import as_count, as_floats, as_int32, as_integers, as_number, frozen
from flaunay._declarations import EXCUSE, FLAGS, KEPT_EDGES, Refinement, RefinementOptions
from flaunay._errors import UsageError

# Members of flaunay_refinement: those that need not be there, numbers and counts.
_OPTIONAL = [name[len("has_") :] for name, *_ in Refinement._fields_ if name.startswith("has_")]
_NUMBERS = {name for name, kind, *_ in Refinement._fields_ if kind is ctypes.c_double}
_COUNTS = {name for name, kind, *_ in Refinement._fields_ if kind is ctypes.c_size_t}
Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


# The names of excuses by their numbers.
_EXCUSES = np.array([""] + sorted(EXCUSE, key=EXCUSE.__getitem__))


class Refining(RefinementOptions, total=False):
    """The keywords of `refine` that say what a mesh is refined to."""

    seed_areas: Optional[npt.ArrayLike]
    areas_at: Optional[Callable[[Doubles], npt.ArrayLike]]
    triangles: Optional[npt.ArrayLike]
    triangle_areas: Optional[npt.ArrayLike]
    triangle_attributes: Optional[npt.ArrayLike]
    keep_edges: str
    kept_segments: Optional[npt.ArrayLike]


@dataclass(frozen=True, eq=False)
class RefinementReport:
    """How a refinement went: `ConstrainedTriangulation.refinement`.

    Attributes
    ----------
    rounds : int
        In which points were added.
    added_points, split_points : int
        How many points were added, and how many of them on segments or on the border.
    smallest_angle, largest_angle : float
        Of all triangles, in degrees; 0 if there are none.
    mean_angle : float
        Of the smallest angle of each triangle, if there was smoothing; otherwise 0.
    smallest_angle_before, mean_angle_before : float
        What these were before smoothing; 0 without.
    bad_triangles : ndarray of int32, shape (b,)
        The triangles that are worse than asked for, ascending.
    excuses : ndarray of str, shape (b,)
        Why, for each of them: ``"input_angle"``, ``"near_apex"``, ``"min_edge"``, ``"kept"``, ``"frozen"``,
        ``"most_points"`` or ``"most_rounds"``.
    """

    rounds: int
    added_points: int
    split_points: int
    smallest_angle: float
    largest_angle: float
    mean_angle: float
    smallest_angle_before: float
    mean_angle_before: float
    bad_triangles: Indices
    excuses: npt.NDArray[np.str_]

    @staticmethod
    def of(excuses: npt.NDArray[np.uint8], **others: Any) -> RefinementReport:
        """Of what the library says, in which excuses are numbers."""
        return RefinementReport(excuses=frozen(_EXCUSES[excuses]), **others)


def _row(given: Any, name: str, size: int, dtype: npt.DTypeLike) -> npt.NDArray[Any]:
    array = np.asarray(as_floats(given, name))
    if array.shape != (size,):
        raise UsageError(f"{name} must have the shape ({size},), not {array.shape}")
    return np.ascontiguousarray(array, dtype)


def _mesh(wanted: dict[str, Any]) -> dict[str, Any]:
    """The members of flaunay_given_triangles, taken from all members; nothing if there are none."""
    values = {name: wanted.pop(f"triangle_{name}", None) for name in ("areas", "attributes")}
    if "triangles" not in wanted:
        for name, value in values.items():
            if value is not None:
                raise UsageError(f"triangle_{name} needs triangles")
        return {}
    rows = as_integers(wanted.pop("triangles"), "triangles")
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise UsageError(f"triangles must have the shape (m, 3), not {rows.shape}")
    mesh: dict[str, Any] = {
        "triangles": as_int32(rows, "triangles"),
        "count": len(rows),
    }
    for name, value in values.items():
        if value is not None:
            mesh[name] = _row(value, f"triangle_{name}", len(rows), np.float64)
    return mesh


def provable(refinement: dict[str, Any]) -> dict[str, Any]:
    """Those members that a proof is about, with copies of arrays."""
    kept: dict[str, Any] = {
        name: refinement[name]
        for name in ("min_angle", "max_area", "conforming")
        if name in refinement
    }
    if refinement.get("mesh"):
        rows = refinement["mesh"]["triangles"]
        kept["mesh"] = {"triangles": rows.copy(), "count": len(rows)}
    return kept


def as_refinement(given: Refining, segments: int, seeds: int) -> dict[str, Any]:
    """The members of flaunay_refinement, arrays and a function among them. Nothing if nothing is asked for.

    The member `mesh` has those of flaunay_given_triangles.
    """
    if not given:
        return {}
    names = Refining.__annotations__
    for name in given:
        if name not in names:
            raise TypeError(f"unexpected keyword argument {name!r}")
    wanted: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    kept = wanted.pop("keep_edges", "none")
    if kept not in KEPT_EDGES:
        raise UsageError(
            f"keep_edges must be one of {', '.join(map(repr, KEPT_EDGES))}, not {kept!r}"
        )
    wanted["kept"] = KEPT_EDGES[kept]
    wanted["mesh"] = _mesh(wanted)
    for name in _OPTIONAL:
        wanted[f"has_{name}"] = int(name in wanted)
    for name in FLAGS["Refinement"]:
        wanted[name] = int(bool(wanted.get(name, False)))
    for name in _NUMBERS.intersection(wanted):
        wanted[name] = as_number(wanted[name], name)
    for name in _COUNTS.intersection(wanted):
        wanted[name] = as_count(wanted[name], name)
    if "seed_areas" in wanted:
        wanted["seed_areas"] = _row(wanted["seed_areas"], "seed_areas", seeds, np.float64)
    if "kept_segments" in wanted:
        are_kept = _row(wanted["kept_segments"], "kept_segments", segments, np.bool_)
        wanted["kept_segments"] = are_kept.view(np.uint8)
    if "areas_at" in wanted and not callable(wanted["areas_at"]):
        raise UsageError(f"areas_at must be a function, not {type(wanted['areas_at']).__name__}")
    return wanted
