"""The calls of the package ``triangle``, which is Shewchuk's Triangle for Python, answered by flaunay.

Programs change ``import triangle as tr`` to ``import flaunay.triangle as tr``. Dictionaries and switches are
those of that package; which points are added, and the order of rows, differ.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from flaunay import _triangulate
from flaunay._arrays import ArrayLike
from flaunay._constrained import ConstrainedTriangulation
from flaunay._errors import UsageError
from flaunay._interpolate import LinearInterpolator
from flaunay._voronoi import Voronoi

Array = npt.NDArray[Any]
Members = dict[str, Array]
Options = dict[str, Any]

# The members of dictionaries: how many columns they have (0 for any), and what has as many rows.
_MEMBERS: dict[str, tuple[type, int, str]] = {
    "vertices": (np.float64, 2, ""),
    "vertex_attributes": (np.float64, 0, "vertices"),
    "vertex_markers": (np.intc, 1, "vertices"),
    "triangles": (np.intc, 3, ""),
    "triangle_attributes": (np.float64, 0, "triangles"),
    "triangle_max_area": (np.float64, 1, "triangles"),
    "neighbors": (np.intc, 3, ""),
    "segments": (np.intc, 2, ""),
    "segment_markers": (np.intc, 1, "segments"),
    "holes": (np.float64, 2, ""),
    "regions": (np.float64, 4, ""),
    "edges": (np.intc, 2, ""),
    "edge_markers": (np.intc, 1, "edges"),
}


def _parsed(opts: str) -> tuple[Counter[str], dict[str, float]]:
    """How often there is each switch, and the numbers of those that have one; `a` without one is "areas"."""
    letters: Counter[str] = Counter()
    numbers: dict[str, float] = {}
    for letter, number in re.findall(r"([^\s-])((?:(?<=[qaSo])[\d.]+)?)", opts):
        switch = letter + number
        # The second string has those that change no result here.
        if letter not in "pqarAcDenYSOj" "XiFlsCQVIzgvNEPB" and switch != "o1":
            raise UsageError(f"switch {switch!r} of {opts!r} is not supported")
        letters["areas" if switch == "a" else letter] += 1
        if number:
            try:
                numbers[letter] = float(number)
            except ValueError:
                raise UsageError(f"switch {switch!r} has no number") from None
    if numbers.get("q", 0) > 34:
        raise UsageError(f"switch 'q{numbers['q']:g}': angles above 34 degrees are not supported")
    if numbers.get("a", 1) <= 0:
        raise UsageError("switch 'a0': the largest area must be positive")
    if letters["D"] and letters["Y"]:
        raise UsageError("switch 'D' splits what switch 'Y' keeps")
    return letters, numbers


def _members(tri: Mapping[str, npt.ArrayLike]) -> Members:
    """The members that are not empty, as arrays with rows."""
    given: Members = {}
    for name, value in tri.items():
        if name not in _MEMBERS:
            raise UsageError(f"{name!r} is none of {', '.join(_MEMBERS)}")
        dtype, columns, _ = _MEMBERS[name]
        rows: Array = np.asarray(value, dtype)
        if rows.size:
            given[name] = rows = rows.reshape(-1, 1) if rows.ndim == 1 else rows
            if rows.ndim != 2 or columns not in (0, rows.shape[1]):
                raise UsageError(f"{name} must have {columns or 'some'} columns, not {rows.shape}")
    if len(given.get("vertices", ())) < 3:
        raise UsageError("Input must have at least three vertices.")
    for name, rows in given.items():
        owner = _MEMBERS[name][2]
        if owner and len(rows) != len(given.get(owner, ())):
            raise UsageError(f"{name} must have as many rows as {owner}, not {len(rows)}")
    return given


def _keys(pairs: Array, n: int) -> Array:
    """A number for each edge between n points, whatever its direction."""
    keys: Array = np.sort(pairs, axis=1).astype(np.int64) @ [n, 1]
    return keys


def _segments_of(given: Members, letters: Counter[str], others: Array) -> tuple[Array, Array]:
    """Those that p reads, and others, and their markers."""
    read = given if letters["p"] else {}
    segments = np.concatenate([read.get("segments", others[:0]), others])
    markers = np.zeros(len(segments), np.intc)
    own = read.get("segment_markers", markers[:0]).ravel()
    markers[: len(own)] = own
    return segments, markers


def _of_drawing(given: Members, letters: Counter[str]) -> tuple[Array, Array, Options]:
    """Segments, their markers and options for points and segments."""
    options: Options = {}
    has_hull = letters["c"] or not letters["p"]
    others = convex_hull(given["vertices"]) if has_hull else np.empty((0, 2), np.intc)
    if letters["p"]:
        options["holes"] = None if letters["O"] else given.get("holes")
        if "regions" in given:
            options["seeds"] = given["regions"][:, :3]
            if letters["areas"]:
                options["seed_areas"] = np.maximum(given["regions"][:, 3], 0)
    return *_segments_of(given, letters, others), options


def _of_mesh(given: Members, letters: Counter[str]) -> tuple[Array, Array, Options, Array]:
    """The same for triangles, and the different rows of their attributes, which are numbered."""
    n = len(given["vertices"])
    triangles = given.get("triangles", np.empty((0, 3), np.intc))
    if not len(triangles) or triangles.min() < 0 or triangles.max() >= n:
        raise UsageError("switch 'r' needs triangles, and these must be of the vertices")
    rows = given.get("triangle_attributes", np.zeros((len(triangles), 1)))
    kinds, kind = np.unique(rows, axis=0, return_inverse=True)
    kind = kind.ravel()
    # Edges with one triangle of a kind.
    ends = np.stack([np.roll(triangles, -k, axis=1) for k in (1, 2)], axis=2).reshape(-1, 2)
    sides = np.stack([_keys(ends, n), np.repeat(kind, 3)], axis=1)
    _, first, counts = np.unique(sides, axis=0, return_index=True, return_counts=True)
    border = ends[first[counts == 1]]
    options: Options = {"triangles": triangles, "triangle_attributes": kind}
    if letters["areas"] and "triangle_max_area" in given:
        options["triangle_areas"] = np.maximum(given["triangle_max_area"].ravel(), 0)
    if "triangle_attributes" not in given:
        kinds = kinds[:, :0]
    return *_segments_of(given, letters, border), options, kinds


def _refined(points: Array, segments: Array, markers: Array, options: Options) -> ConstrainedTriangulation:
    # The border is of segments, also where it is the hull, whose parts are rounded.
    outside = "keep" if "triangles" in options else "hull"
    mesh = _triangulate.triangulate(
        points, segments, segment_markers=markers, crossings="split", outside=outside, **options
    )
    return mesh


def _attributes(points: Array, values: Array, segments: Array, owners: Array) -> Array:
    """Those of all points, from those of the first ones. owners: the segment that each is on, or -1."""
    count = len(values)
    rest, start = points[count:], points[:count]
    added = LinearInterpolator(start, values)(rest)
    split = np.flatnonzero(owners[count:] >= 0)
    a, b = segments[owners[count:][split]].T
    from_a, from_b = (np.hypot(*(rest[split] - start[ends]).T)[:, None] for ends in (a, b))
    added[split] = (from_b * values[a] + from_a * values[b]) / (from_a + from_b)
    return np.concatenate([values, added])


def _result(
    mesh: ConstrainedTriangulation, segments: Array, given: Members, letters: Counter[str]
) -> Members:
    """The members for a mesh."""
    assert mesh.edge_markers is not None
    markers, owners = mesh.edge_markers, mesh.edge_segments
    n, count, pairs = len(mesh.points), len(given["vertices"]), mesh.constraint_edges
    all_keys, keys = _keys(mesh.edges, n), _keys(pairs, n)
    # As in Triangle, the border and its vertices have the marker 1 unless they are given others.
    assert mesh.neighbors is not None
    on_border = np.isin(keys, _keys(mesh._edges_where(np.less(mesh.neighbors, 0)), n))
    vertex_markers, vertex_owners = np.zeros(n, np.intc), np.full(n, -1)
    vertex_markers[pairs[on_border]] = 1
    # From the last segment to the first, which counts.
    order = np.argsort(-owners, kind="stable")
    vertex_owners[pairs[order]] = owners[order, None]
    order = order[markers[order] != 0]
    vertex_markers[pairs[order]] = markers[order, None]
    own = given.get("vertex_markers", np.zeros(count, np.intc)).ravel()
    vertex_markers[:count] = np.where(own != 0, own, vertex_markers[:count])
    markers = np.where(on_border & (markers == 0), 1, markers)[:, None]
    result: Members = {
        "vertices": mesh.points,
        "vertex_markers": vertex_markers[:, None],
        "triangles": mesh.triangles,
    }
    if "vertex_attributes" in given:
        values = given["vertex_attributes"]
        result["vertex_attributes"] = _attributes(mesh.points, values, segments, vertex_owners)
    kept = np.isin(keys, all_keys)
    if letters["p"] or letters["c"]:
        result["segments"], result["segment_markers"] = pairs[kept], markers[kept]
    if letters["p"]:
        result.update({name: given[name] for name in ("holes", "regions") if name in given})
    if letters["n"]:
        result["neighbors"] = mesh.neighbors
    if letters["e"]:
        edge_markers = np.zeros((len(mesh.edges), 1), np.intc)
        edge_markers[np.searchsorted(all_keys, keys[kept])] = markers[kept]
        result["edges"], result["edge_markers"] = mesh.edges, edge_markers
    return result


def triangulate(tri: Mapping[str, npt.ArrayLike], opts: str = "") -> Members:
    """Triangulates what a dictionary has, as ``triangle.triangulate`` does.

    Parameters
    ----------
    tri : dict
        ``vertices``, and perhaps ``vertex_attributes``, ``vertex_markers``, ``segments``,
        ``segment_markers``, ``holes`` and ``regions`` (x, y, attribute, largest area); for the switch r
        also ``triangles``, ``triangle_attributes`` and ``triangle_max_area``.
    opts : str
        Switches of Triangle: p, q (20 degrees, or a number up to 34), a (a number, or the areas of regions or
        triangles), r, A, c, D, e, n, Y, YY, S, O, j. Those about how Triangle works and what it writes, X,
        i, F, l, s, C, Q, V, I, z, g, v, N, E, P and B, change nothing.

    Returns
    -------
    dict
        The members that ``triangle`` returns, the given vertices first. Those without rows are there, too.

    Raises
    ------
    UsageError
        A ValueError. For other switches, such as o2, u and w, and for members of other names or shapes.
    InputError, DeviceError
        As `flaunay.triangulate`.

    Notes
    -----
    Attributes of vertices that are added are linear between the ends of their segment, or else in the
    Delaunay triangles of the given vertices. With r, triangles are made anew of all vertices, of segments (with
    p), of the border, and of edges between triangles of different attributes; the largest area of a triangle
    is that of the given one with its centroid, and its parts inherit it. With D, segments are split until no
    angle opposite to them is obtuse.

    Examples
    --------
    >>> import flaunay.triangle as tr
    >>> mesh = tr.triangulate({"vertices": [[0, 0], [0, 1], [1, 1], [1, 0]]}, "qa0.2")
    >>> mesh["vertices"][:4].tolist(), sorted(mesh)
    ([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]], ['triangles', 'vertex_markers', 'vertices'])
    """
    letters, numbers = _parsed(opts)
    given = _members(tri)
    if letters["r"]:
        segments, markers, options, kinds = _of_mesh(given, letters)
    else:
        segments, markers, options = _of_drawing(given, letters)
        kinds = None
    options["min_angle"] = numbers.get("q", 20) if letters["q"] else 0
    options["max_area"] = numbers.get("a", 0)
    options["keep_edges"] = ("none", "border", "all")[min(letters["Y"], 2)]
    if letters["S"]:
        options["most_points"] = int(numbers.get("S", 0))
    options["conforming"] = letters["D"] > 0
    mesh = _refined(given["vertices"], segments, markers, options)
    result = _result(mesh, segments, given, letters)
    of_seeds = mesh.triangle_attributes
    if of_seeds is not None and kinds is not None and kinds.size:
        result["triangle_attributes"] = kinds[of_seeds.astype(np.intp)]
    elif of_seeds is not None and kinds is None and letters["A"]:
        result["triangle_attributes"] = of_seeds[:, None]
    if letters["j"]:
        used = np.unique(mesh.triangles)
        for name in result.keys() & {"vertices", "vertex_markers", "vertex_attributes"}:
            result[name] = result[name][used]
        for name in result.keys() & {"triangles", "segments", "edges"}:
            result[name] = np.searchsorted(used, result[name]).astype(np.intc)
    return {name: np.array(rows) for name, rows in result.items()}


def delaunay(pts: ArrayLike) -> Array:
    """The Delaunay triangles of points, shape (m, 3)."""
    return np.array(_triangulate.triangulate(pts).triangles)


def convex_hull(pts: ArrayLike) -> Array:
    """The edges of the convex hull, counter-clockwise, shape (h, 2)."""
    hull = _triangulate.triangulate(pts).hull
    return np.stack([hull, np.roll(hull, -1)], axis=1)


def voronoi(pts: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """The Voronoi diagram of points: vertices, edges, and the origins and directions of rays."""
    diagram = Voronoi(pts)
    between = diagram.ridge_vertices
    is_ray = between[:, 0] < 0
    # The two points of a ray follow each other counter-clockwise on the hull.
    a, b = diagram.points[diagram.ridge_points[is_ray].T].astype(np.float64)
    directions = (b - a)[:, ::-1] * [1, -1]
    return np.array(diagram.vertices), between[~is_ray], between[is_ray, 1], directions
