"""The plain call for points in host memory, with or without constraints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Optional, Union, overload

import numpy as np
import numpy.typing as npt

from flaunay._arrays import ArrayLike, as_offsets, as_points, check_out, names_of
from flaunay._calls import TRIANGULATION
from flaunay._constrained import (
    ConstrainedTriangulation,
    arrays_of_constrained,
    rules_of,
)
from flaunay._declarations import ConstraintsOptions, TriangulationOptions
from flaunay._delaunay import Delaunay
from flaunay._errors import UsageError
from flaunay._refinement import Doubles, Refining
from flaunay._triangulation import Triangulation, arrays_of_mesh, with_arrays

if TYPE_CHECKING:
    from typing_extensions import Unpack

Indices = npt.NDArray[np.int32]
Out = Union[Mapping[str, Indices], Triangulation, None]


class _Constraining(ConstraintsOptions, TriangulationOptions, total=False):
    """The keywords of `triangulate` with segments, but for those that refine."""

    offsets: Optional[npt.ArrayLike]
    hole_offsets: Optional[npt.ArrayLike]
    segment_markers: Optional[npt.ArrayLike]
    point_markers: Optional[npt.ArrayLike]
    seeds: Optional[npt.ArrayLike]
    seed_offsets: Optional[npt.ArrayLike]
    device: Optional[str]
    mode: str
    out: Out


class _Meshing(_Constraining, Refining, total=False):
    """All of these."""


class _OfTriangulate(_Constraining, total=False):
    """What `refine` takes as `triangulate` does."""

    holes: Optional[npt.ArrayLike]


def _attributes(out: object) -> dict[str, Any]:
    return {name: getattr(out, name, None) for name in TRIANGULATION}


def _arrays_of(
    out: Union[Mapping[str, Indices], Triangulation], wanted: set[str]
) -> dict[str, Indices]:
    """The arrays to write to; UsageError for one that nothing can be written to, or that nothing is written to."""
    given: Mapping[str, Any] = out if isinstance(out, Mapping) else _attributes(out)
    arrays = {name: array for name, array in given.items() if array is not None}
    for name, array in arrays.items():
        if name not in TRIANGULATION:
            raise UsageError(f"out has {name!r}; there are {', '.join(TRIANGULATION)}")
        dtype, _, columns, asked = TRIANGULATION[name]
        if asked != "always" and name not in wanted:
            raise UsageError(f"out has {name}, but {name}=False")
        check_out(array, dtype, (None,) if columns == 1 else (None, columns), f"out[{name!r}]")
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


@overload
def triangulate(
    points: ArrayLike,
    segments: None = None,
    holes: None = None,
    *,
    offsets: Optional[npt.ArrayLike] = None,
    device: Optional[str] = None,
    neighbors: bool = True,
    halfedges: bool = False,
    areas: bool = False,
    mode: str = "blocks",
    out: Out = None,
) -> Triangulation: ...


@overload
def triangulate(
    points: ArrayLike,
    segments: npt.ArrayLike,
    holes: Optional[npt.ArrayLike] = None,
    **options: Unpack[_Meshing],
) -> ConstrainedTriangulation: ...


@overload
def triangulate(
    points: ArrayLike,
    segments: None = None,
    holes: Optional[npt.ArrayLike] = None,
    **options: Unpack[_Meshing],
) -> ConstrainedTriangulation: ...


def triangulate(
    points: ArrayLike,
    segments: Optional[npt.ArrayLike] = None,
    holes: Optional[npt.ArrayLike] = None,
    *,
    offsets: Optional[npt.ArrayLike] = None,
    hole_offsets: Optional[npt.ArrayLike] = None,
    segment_markers: Optional[npt.ArrayLike] = None,
    point_markers: Optional[npt.ArrayLike] = None,
    seeds: Optional[npt.ArrayLike] = None,
    seed_offsets: Optional[npt.ArrayLike] = None,
    outside: str = "keep",
    crossings: str = "error",
    fill_rule: str = "nesting",
    labels: bool = False,
    device: Optional[str] = None,
    neighbors: bool = True,
    halfedges: bool = False,
    areas: bool = False,
    mode: str = "blocks",
    out: Out = None,
    **refining: Unpack[Refining],
) -> Triangulation:
    """Triangulates one set of points, or many sets in one call, with segments as edges if there are any.

    Every triangle is exact, whatever the points: grids, duplicates, points on one line. Fewer than
    three distinct points, and points on one line, have no triangles; that is no error.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Coordinates. C-contiguous arrays of float64 and float32 are taken as they are; other numbers
        become float64, and must be one exactly.
    segments : array_like of int, shape (k, 2), optional
        Two points each, of the same set, that are to be joined by edges. The result is the constrained
        Delaunay triangulation, which is a function of the sets of points and of segments. A segment through
        other points is a chain of edges; equal segments, overlapping ones and segments between points of
        equal coordinates are allowed. Lines and polygons of Shapely and GeoPandas are taken, too: their corners
        become points after the others.
    holes : array_like, shape (h, 2), optional
        With segments: what is connected to one of these places without crossing a segment is left out.
    offsets : array_like of int, shape (sets + 1,), optional
        Set s has the points ``offsets[s]`` to ``offsets[s + 1]``. Begins with 0, does not decrease
        and ends with n. Without it, there is one set. Segments have indices over all sets.
    hole_offsets : array_like of int, shape (sets + 1,), optional
        Set s has the holes ``hole_offsets[s]`` to ``hole_offsets[s + 1]``. Needed for holes of several sets.
    segment_markers, point_markers : array_like of int, shape (k,), (n,), optional
        With segments: numbers of the caller's, which become `ConstrainedTriangulation.edge_markers` and
        `vertex_markers`.
    seeds : array_like, shape (r, 3), optional
        With segments, x, y and an attribute each, which becomes that of all triangles that are connected to
        this place without crossing a segment: `ConstrainedTriangulation.triangle_attributes`. Of several
        seeds in one region the last counts. As for holes, places on a segment, and in no triangle of the convex
        hull, are errors.
    seed_offsets : array_like of int, shape (sets + 1,), optional
        As `hole_offsets`.
    outside : {"keep", "hull", "holes"}
        With segments, the triangles to keep: all up to the convex hull; those that are not outside, of
        depth 0; or those that are neither outside nor in holes.
    crossings : {"error", "split"}
        What becomes of segments that cross where no point is: an `InputError` that names them and the place,
        or a point more, at the rounded place.
    fill_rule : {"nesting", "even_odd", "winding"}
        What depths are: the least number of constraint edges on a path to the outside, of which
        even ones are holes; whether the number of segments on a path is odd; or the winding number. The
        last two need segments that form closed curves.
    labels : bool
        Whether to compute `ConstrainedTriangulation.depths` and `regions`.
    device : str, optional
        A part of a device's or platform's name, ``"#k"``, the k-th of `devices`, or ``"host"`` for the
        host's cores without OpenCL. Without it, the one that the environment variable FLAUNAY_DEVICE
        names, else the first GPU with fp64, else the first GPU, else the host. The results are the same.
    neighbors, halfedges, areas : bool
        Which of these to compute. With segments, there always are areas.
    mode : str
        How to divide and conquer, by a name in `modes`. The triangles are the same in each mode; the
        order of the rows differs. Some modes run on the host and need no device. With segments,
        ``"blocks"`` alone.
    out : mapping of str to ndarray of int32, or an object with such attributes, optional
        Arrays for ``triangles``, ``neighbors``, ``halfedges``, ``hull``, ``representatives`` and ``areas``
        (float64), or some of them, with as many rows as there are results or more. n points have fewer than
        2 n triangles. The result has views of their first rows; it costs one copy.
    **refining
        What `refine` takes, such as ``min_angle`` and ``max_area``: points are added, with or without
        segments.

    Returns
    -------
    Triangulation
        With segments, or if it is refined, a `ConstrainedTriangulation`.

    Raises
    ------
    UsageError
        For a wrong shape, what is no number, offsets that are none, an unknown mode, arrays in `out`
        that results cannot be written to, and segments of what is no point or of two sets.
    InputError
        For a point that is not finite, magnitudes too different to be exact, or too many points; for segments
        that cross, unless they are to be split, segments that are no closed curves where the fill rule
        needs them, and a hole that is in no triangle or on a segment.
    DeviceError
        If there is no such device, or a call of OpenCL failed.

    Notes
    -----
    O(n log n) work. With s segments, expected O(n log n + s log(s)^2), besides the number of triangles
    that they cross. The interpreter's lock is released meanwhile.

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

    A square, and the diagonal that it would not have otherwise:

    >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    >>> flaunay.triangulate(square, segments=[[1, 3]]).triangles
    array([[0, 1, 3],
           [1, 2, 3]], dtype=int32)

    A frame, of two rings of segments:

    >>> frame = [[0, 0], [6, 0], [6, 6], [0, 6], [2, 2], [4, 2], [4, 4], [2, 4]]
    >>> rings = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]]
    >>> flaunay.triangulate(frame, segments=rings, outside="holes")
    <flaunay.ConstrainedTriangulation: 8 points, 8 triangles, 8 constraint edges>
    """
    wanted = names_of(neighbors=neighbors, halfedges=halfedges, areas=areas)
    places = None if out is None else _arrays_of(out, wanted)
    sets = None if offsets is None else as_offsets(offsets)
    rules = rules_of(crossings, outside, fill_rule, labels)
    given = {
        "holes": holes,
        "hole_offsets": hole_offsets,
        "segment_markers": segment_markers,
        "point_markers": point_markers,
        "seeds": seeds,
        "seed_offsets": seed_offsets,
    }
    asked: Optional[dict[str, Any]] = None
    if segments is None and refining:
        segments = np.empty((0, 2), np.int32)
    if segments is None:
        # The rules of the defaults are 0.
        unused = [name for name in given if given[name] is not None]
        unused += [name for name in rules if rules[name]]
        if unused:
            raise UsageError(f"{unused[0]} is for segments, of which there are none")
        result = arrays_of_mesh(as_points(points), sets, wanted, device, mode)
    else:
        if mode != "blocks":
            raise UsageError(f"mode {mode!r} has no segments; mode 'blocks' has")
        result, asked = arrays_of_constrained(
            points, segments, sets, given, rules, refining, wanted | {"areas"}, device
        )
    if places:
        _write(result, places)
    if asked is None:
        return with_arrays(Triangulation, result)
    return with_arrays(ConstrainedTriangulation, result, _device=device, _asked=asked)


def _given_mesh(mesh: Union[ConstrainedTriangulation, Delaunay]) -> dict[str, Any]:
    """The arguments of `refine` for a mesh that is refined further."""
    if isinstance(mesh, Delaunay):
        return {"points": mesh.points, "triangles": mesh.simplices}
    if len(mesh.triangle_offsets) != 2:
        raise UsageError("a mesh that is refined must be of one set")
    return {
        "points": mesh.points,
        "segments": mesh.constraint_edges,
        "triangles": mesh.triangles,
        "triangle_attributes": mesh.triangle_attributes,
        "segment_markers": mesh.edge_markers,
        "point_markers": mesh.vertex_markers,
    }


def refine(
    points: Union[ArrayLike, ConstrainedTriangulation, Delaunay],
    segments: Optional[npt.ArrayLike] = None,
    *,
    min_angle: float = 20,
    max_area: float = 0,
    seed_areas: Optional[npt.ArrayLike] = None,
    areas_at: Optional[Callable[[Doubles], npt.ArrayLike]] = None,
    triangles: Optional[npt.ArrayLike] = None,
    triangle_areas: Optional[npt.ArrayLike] = None,
    triangle_attributes: Optional[npt.ArrayLike] = None,
    conforming: bool = False,
    keep_edges: str = "none",
    kept_segments: Optional[npt.ArrayLike] = None,
    min_edge: Optional[float] = None,
    most_points: Optional[int] = None,
    most_rounds: Optional[int] = None,
    smoothing_steps: int = 0,
    **others: Unpack[_OfTriangulate],
) -> ConstrainedTriangulation:
    """Triangulates, and adds points until no triangle has a small angle or is too large.

    Parameters
    ----------
    points, segments, **others
        As of `triangulate`. What is left out, such as holes, is not refined. Without segments, the domain is
        the convex hull. A `ConstrainedTriangulation` of one set or a `Delaunay` in the place of points is
        refined further: it has the segments, triangles, markers and attributes, unless they are given.
    min_angle : float
        In degrees, from 0 to 34; 0 for any. Above 30, many more points are needed.
    max_area : float
        The largest area of a triangle; 0 for any.
    seed_areas : array_like, shape (r,), optional
        For each of the `seeds`, the largest area in its region; 0 for any.
    areas_at : callable, optional
        Takes places, an array of shape (k, 2), and returns the areas that triangles may have there, of shape
        (k,), or one for all; 0 for any. It is called once a round of each set.
    triangles : array_like of int, shape (m, 3), optional
        A mesh of the points that is refined further. They are triangulated anew, with its border as segments
        after the given ones, and without what no triangle covers.
    triangle_areas : array_like, shape (m,), optional
        For each of these the area that triangles with their centroid in it, and their parts, may have; 0 for
        any.
    triangle_attributes : array_like, shape (m,), optional
        For each of these an attribute. Edges between different ones are segments, and the result has
        `triangle_attributes`.
    conforming : bool
        Whether to split segments until no angle opposite to them is obtuse: then all triangles are Delaunay.
    keep_edges : {"none", "border", "all"}
        Where no points may be put: on edges with triangles on one side only, or on no segment at all.
    kept_segments : array_like of bool, shape (k,), optional
        For each segment whether no points may be put on it.
    min_edge : float, optional
        No two points are put nearer to each other; from 0 on. Without it, 2^-40 of the extent, or 2^-48 of the
        largest coordinate if that is more.
    most_points, most_rounds : int, optional
        No more points are added to a set, and no more rounds made of it; 0 for none. Without them, there is no
        limit of points, and one of 10,000 rounds.
    smoothing_steps : int
        So often, added points that are not on segments move to where triangles are more regular.

    Returns
    -------
    ConstrainedTriangulation
        Its `refinement` says which triangles are worse than asked for, and why.

    Raises
    ------
    UsageError, InputError, DeviceError
        As `triangulate`; UsageError for what is out of range, too. What `areas_at` raises is raised.

    Examples
    --------
    >>> import flaunay, numpy as np
    >>> mesh = flaunay.refine([[0, 0], [9, 0], [9, 1], [0, 1]], min_angle=30, max_area=0.5)
    >>> mesh.areas.max() <= 0.5, mesh.refinement.smallest_angle >= 30 - 1e-9
    (True, True)
    >>> len(mesh.refinement.bad_triangles)
    0

    The triangles on the left, once more:

    >>> x = mesh.points[mesh.triangles, 0].mean(axis=1)
    >>> finer = flaunay.refine(mesh, triangle_areas=np.where(x < 3, 0.01, 0))
    >>> len(finer.triangles) > 2 * len(mesh.triangles)
    True
    """
    arguments = locals()
    own: dict[str, Any] = {"points": points}
    if isinstance(points, (ConstrainedTriangulation, Delaunay)):
        own = _given_mesh(points)
    given = {name: arguments[name] for name in ("segments", *Refining.__annotations__)} | others
    result: ConstrainedTriangulation = triangulate(
        **own | {name: value for name, value in given.items() if value is not None}
    )
    return result
