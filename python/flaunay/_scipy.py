"""What SciPy's classes have beside the triangles: options of Qhull, planes on the paraboloid, transforms."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay._arrays import Mesh, hint_for, slices
from flaunay._errors import UsageError

if TYPE_CHECKING:
    import scipy.spatial

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]

# Options that are about how Qhull works, what it prints and checks. SciPy sets some of them itself.
_OPTIONS_WITHOUT_EFFECT = re.compile("Qbb|Qc|Qi|Qm|Qr|Qs|Qt|Qv|Qx|Qz|Q[0-9]|Q1[0-5]|Pp|Tc|Tv")

# Joggled input: what it is for is that every point is a vertex.
_JOGGLE = re.compile(r"QJ[0-9.e-]*")

# SciPy's option Qz adds a point above the paraboloid, by this factor of its height.
_HEIGHT_OF_INFINITY = 1.1

# Three digits of a transform should be good: SciPy has NaN for larger condition numbers.
_LARGEST_CONDITION = 1 / (1000 * np.finfo(np.float64).eps)


def check_options(furthest_site: bool, qhull_options: Optional[str]) -> bool:
    """UsageError for what flaunay cannot do. Returns whether every point must be a vertex."""
    if np.ndim(furthest_site):
        hint = hint_for(np.shape(furthest_site), "points")
        raise UsageError(f"furthest_site must be False, and is an array{hint}")
    if furthest_site:
        raise UsageError(
            "furthest_site=True is not possible: the furthest-site diagram is that of the convex hull's "
            "points alone, for which scipy.spatial is fast enough"
        )
    if qhull_options is None:
        return False
    if not isinstance(qhull_options, str):
        raise TypeError(f"qhull_options must be a string, not {type(qhull_options).__name__}")
    joggle = False
    for option in qhull_options.split():
        if _JOGGLE.fullmatch(option):
            joggle = True
        elif option == "Qu":
            raise UsageError("Qhull's option Qu is furthest_site=True, which is not possible")
        elif not _OPTIONS_WITHOUT_EFFECT.fullmatch(option):
            raise UsageError(
                f"Qhull's option {option} is not known: the triangulation is exact, so leave out what is "
                "about precision; for other results of Qhull take scipy.spatial"
            )
    return joggle


def check_all_are_vertices(tri: Mesh) -> None:
    """UsageError where Qhull's option QJ would have joggled points into the triangulation."""
    if len(tri.points) and len(tri.simplices) == 0:
        raise UsageError(
            "Qhull's option QJ asks for every point to be a vertex, but the points have no triangles, "
            "as they are on one line or fewer than three"
        )
    equal = np.flatnonzero(tri.representatives != np.arange(len(tri.points)))
    if len(equal):
        raise UsageError(
            f"Qhull's option QJ asks for every point to be a vertex, but point {equal[0]} equals point "
            f"{tri.representatives[equal[0]]}: leave out one of them, or the option"
        )


def paraboloid(points: Doubles) -> tuple[float, float]:
    """The scale and shift of the paraboloid, as SciPy's default options of Qhull have them."""
    if len(points) == 0:
        return 1.0, 0.0
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        heights = np.einsum("ij,ij->i", points, points)
        low, high = heights.min(), _HEIGHT_OF_INFINITY * heights.max()
        scale = np.abs(points).max() / (high - low) if high > low else np.float64(1)
        return float(scale), float(-low * scale)


def lifted(points: Doubles, scale: float, shift: float) -> Doubles:
    """Points of any leading shape on the paraboloid."""
    heights = np.einsum("...i,...i->...", points, points) * scale + shift
    return np.concatenate([points, heights[..., None]], axis=-1)


def plane_equations(points: Doubles, simplices: Indices, scale: float, shift: float) -> Doubles:
    """The planes of the triangles on the paraboloid, shape (m, 4): unit normals, downwards, and offsets."""
    equations = np.empty((len(simplices), 4))
    # Triangles so thin or large that floating point has no plane for them get NaN.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for rows in slices(len(simplices)):
            equations[rows] = _planes(points[simplices[rows]], scale, shift)
    return equations


def _planes(corners: Doubles, scale: float, shift: float) -> Doubles:
    first, second = corners[:, 0] - corners[:, 2], corners[:, 1] - corners[:, 2]
    # Differences of heights, without the cancellation that their computation from heights has.
    rise = [
        scale * np.einsum("ij,ij->i", side, corners[:, k] + corners[:, 2])
        for k, side in enumerate((first, second))
    ]
    normals = np.stack(
        [
            rise[0] * second[:, 1] - first[:, 1] * rise[1],
            first[:, 0] * rise[1] - rise[0] * second[:, 0],
            first[:, 1] * second[:, 0] - first[:, 0] * second[:, 1],
        ],
        axis=1,
    )
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = -np.einsum("ij,ij->i", normals, lifted(corners[:, 2], scale, shift))
    return np.concatenate([normals, offsets[:, None]], axis=1)


def barycentric_transforms(points: Doubles, simplices: Indices) -> Doubles:
    """For each triangle the gradients of its first two barycentric coordinates and its last corner, shape (m, 3, 2).

    By elimination with pivoting, as LAPACK does it for SciPy, and NaN where that loses most digits.
    """
    transforms = np.empty((len(simplices), 3, 2))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for rows in slices(len(simplices)):
            _write_transforms(points[simplices[rows]], transforms[rows])
    return transforms


def _write_transforms(corners: Doubles, transforms: Doubles) -> None:
    (x0, y0), (x1, y1) = (corners[:, :2] - corners[:, 2:]).transpose(1, 2, 0)
    is_second = np.abs(x1) > np.abs(x0)
    x, y = np.where(is_second, x1, x0), np.where(is_second, y1, y0)
    factor = np.where(is_second, x0, x1) / x
    rest = np.where(is_second, y0, y1) - factor * y
    # The gradients of the pivot's coordinate and of the other.
    pivot_y, other_y = -factor / rest, 1 / rest
    pivot_x, other_x = (1 - y * pivot_y) / x, -y * other_y / x
    transforms[:, 0, 0] = np.where(is_second, other_x, pivot_x)
    transforms[:, 0, 1] = np.where(is_second, other_y, pivot_y)
    transforms[:, 1, 0] = np.where(is_second, pivot_x, other_x)
    transforms[:, 1, 1] = np.where(is_second, pivot_y, other_y)
    transforms[:, 2] = corners[:, 2]
    sides = np.maximum(np.abs(x0) + np.abs(x1), np.abs(y0) + np.abs(y1))
    gradients = np.maximum(np.abs(pivot_x) + np.abs(pivot_y), np.abs(other_x) + np.abs(other_y))
    transforms[~(sides * gradients <= _LARGEST_CONDITION)] = np.nan


def _hull_simplices(tri: Mesh) -> Indices:
    """For each edge of the hull, by its first point, the simplex that has it."""
    simplex, corner = np.nonzero(tri.neighbors < 0)
    by_point = np.empty(len(tri.points), np.int32)
    by_point[tri.simplices[simplex, (corner + 1) % 3]] = simplex
    simplices: Indices = by_point[tri.hull]
    return simplices


def simplices_near_hull(tri: Mesh, outside: Doubles, tolerance: float) -> Indices:
    """For points outside of the hull a simplex at the hull that they are in but for the tolerance, or -1.

    The simplices are those of three edges of the hull: the one that is between a point and the centre,
    and the two beside it.
    """
    points = np.asarray(tri.points, np.float64)
    ring = points[tri.hull]
    centre = ring.mean(axis=0)
    angles = np.arctan2(*(ring - centre).T[::-1])
    first = int(np.argmin(angles))
    places = np.searchsorted(
        np.roll(angles, -first), np.arctan2(*(outside - centre).T[::-1]), "right"
    )
    simplices = _hull_simplices(tri)
    found = np.full(len(outside), -1, np.int32)
    for step in (0, 1, -1):
        candidates = simplices[(places - 1 + first + step) % len(ring)]
        transforms = barycentric_transforms(points, tri.simplices[candidates])
        coordinates = np.einsum("kij,kj->ki", transforms[:, :2], outside - transforms[:, 2])
        coordinates = np.column_stack([coordinates, 1 - coordinates.sum(axis=1)])
        inside = ((coordinates >= -tolerance) & (coordinates <= 1 + tolerance)).all(axis=1)
        found = np.where((found < 0) & inside, candidates, found)
    return found


def to_scipy(tri: Mesh) -> scipy.spatial.Delaunay:
    """A scipy.spatial.Delaunay that Qhull has not made."""
    try:
        import scipy.spatial
    except ImportError as error:
        raise ImportError("to_scipy needs SciPy, which cannot be imported") from error
    if len(tri.simplices) == 0:
        raise UsageError("SciPy has no triangulations without simplices")
    made: Any = object.__new__(scipy.spatial.Delaunay)
    # SciPy's compiled code takes pointers of these arrays, and its users may write to them.
    made._points = np.array(tri.points, np.float64)
    for name in ("simplices", "neighbors", "coplanar"):
        setattr(made, name, np.array(getattr(tri, name), np.intc))
    for name in ("min_bound", "max_bound"):
        setattr(made, name, np.array(getattr(tri, name), np.float64))
    for name in ("equations", "good"):
        setattr(made, name, np.array(getattr(tri, name)))
    for name in ("paraboloid_scale", "paraboloid_shift", "ndim", "npoints", "nsimplex"):
        setattr(made, name, getattr(tri, name))
    made.furthest_site = False
    # As SciPy's, which calls LAPACK for each simplex.
    made._transform = barycentric_transforms(made._points, tri.simplices)
    # SciPy computes these when they are asked for.
    made._vertex_to_simplex = made._vertex_neighbor_vertices = None
    made._qhull = None
    if hasattr(scipy.spatial.Delaunay, "vertices"):
        made._vertices = made.simplices  # SciPy before 1.11 has two names for them
    return made
