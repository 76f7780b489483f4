"""The calls of the package ``triangle``, which is Shewchuk's Triangle for Python, answered by flaunay.

Programs change ``import triangle as tr`` to ``import flaunay.triangle as tr``. Dictionaries and switches are
those of that package; which points are added, and the order of rows, differ.
"""

from __future__ import annotations

import functools
import re
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, Optional, cast

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulate, _triangulators
from flaunay._arrays import ArrayLike
from flaunay._border import Border, ends_opposite
from flaunay._constrained import (
    arrays_of_constrained,
    edge_keys,
    rows_of_edges,
    rules_of,
    sorted_edges,
)
from flaunay._delaunay import Delaunay
from flaunay._errors import InputError, UsageError
from flaunay._interpolate import LinearInterpolator
from flaunay._refinement import Refining
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


@functools.lru_cache(maxsize=256)
def _parsed(opts: str) -> tuple[Counter[str], dict[str, float]]:
    """How often there is each switch, and the numbers of those that have one; `a` without one is "areas".

    Programs repeat the same few switches. Nobody changes the result.
    """
    letters: Counter[str] = Counter()
    numbers: dict[str, float] = {}
    for letter, number in re.findall(r"([^\s-])((?:(?<=[qaSo])[\d.]+)?)", opts):
        switch = letter + number
        # The second string has those that change no result here.
        if letter not in "pqarAcDenuYSOj" "XiFlsCQVIzgvNEPB" and switch not in ("o1", "o2"):
            raise UsageError(f"switch {switch!r} of {opts!r} is not supported")
        letters["areas" if switch == "a" else switch if letter == "o" else letter] += 1
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


def _of_drawing(given: Members, letters: Counter[str]) -> Options:
    """Options for points and segments. Without segments, the hull is the border."""
    options: Options = {"outside": "hull" if letters["p"] or letters["c"] else "keep"}
    if letters["p"]:
        options["holes"] = None if letters["O"] else given.get("holes")
        if "regions" in given:
            options["seeds"] = given["regions"][:, :3]
            if letters["areas"]:
                options["seed_areas"] = np.maximum(given["regions"][:, 3], 0)
    return options


def _of_mesh(given: Members, letters: Counter[str]) -> tuple[Options, Optional[Array]]:
    """Options for triangles, whose border is kept, and the different rows of their attributes, if they have any."""
    triangles = given.get("triangles", np.empty((0, 3), np.intc))
    if not len(triangles) or triangles.min() < 0 or triangles.max() >= len(given["vertices"]):
        raise UsageError("switch 'r' needs triangles, and these must be of the vertices")
    options: Options = {"outside": "keep", "triangles": triangles}
    if letters["areas"] and "triangle_max_area" in given:
        options["triangle_areas"] = np.maximum(given["triangle_max_area"].ravel(), 0)
    if "triangle_attributes" not in given:
        return options, None
    kinds, kind = np.unique(given["triangle_attributes"], axis=0, return_inverse=True)
    options["triangle_attributes"] = kind.ravel()
    return options, kinds


def _triangulated(given: Members, letters: Counter[str], options: Options) -> Members:
    """The arrays of the triangulation. Those of segments are there if there is more to do than to join points."""
    points = given["vertices"]
    if options == {"outside": "keep"}:
        triangulator = _triangulators.of_device(None)
        made = _calls.triangulate(triangulator, points, None, "blocks", {"neighbors"})
        pairs = np.empty((0, 2), np.intc)
        made.update(constraint_edges=pairs, edge_markers=pairs[:, 0], triangle_attributes=None)
        made["points"] = points
        return made
    read = given if letters["p"] else {}
    segments = read.get("segments", np.empty((0, 2), np.intc))
    markers = read.get("segment_markers", np.zeros(len(segments), np.intc)).ravel()
    if letters["c"] and not letters["r"]:
        hull = convex_hull(points)
        segments = np.concatenate([segments, hull])
        markers = np.concatenate([markers, np.zeros(len(hull), np.intc)])
    rules = rules_of("split", options.pop("outside"), "nesting", False)
    others = {name: options.pop(name, None) for name in ("holes", "seeds")}
    others["segment_markers"] = markers
    refining = cast(Refining, options)

    def arrays() -> Members:
        made, _ = arrays_of_constrained(
            *(points, segments, None, others, rules, refining, {"neighbors"}, None)
        )
        return made

    try:
        mesh = arrays()
    except InputError:
        seeds = others["seeds"]
        if seeds is None or not np.isfinite(seeds).all():
            raise
        # For Triangle, those outside count for nothing. Where they are is only asked for if it matters.
        is_inside = Delaunay(points).find_simplex(seeds[:, :2]) >= 0
        if is_inside.all():
            raise
        others["seeds"] = seeds[is_inside]
        if "seed_areas" in options:
            options["seed_areas"] = options["seed_areas"][is_inside]
        mesh = arrays()
        if not is_inside.any():
            mesh["triangle_attributes"] = np.zeros(len(mesh["triangles"]))
    mesh["segments"] = segments
    return mesh


def _ends(mesh: Members, count: int) -> tuple[Array, Array, Array]:
    """The points behind the first ones that are on edges between these, and both ends of each such edge."""
    n, segments = len(mesh["points"]), mesh["segments"]
    edges, segments_of_edges = mesh["constraint_edges"], mesh["edge_segments"]
    owners = np.full(n, -1)
    # From the last segment to the first, which counts.
    order = np.argsort(-segments_of_edges, kind="stable")
    owners[edges[order]] = segments_of_edges[order, None]
    split = np.flatnonzero(owners[count:] >= 0) + count
    if len(edges):
        # Behind the given segments are those of a mesh's border.
        pieces = mesh["piece_edges"][mesh["piece_offsets"][len(segments) : -1]]
        last = mesh["piece_edges"][mesh["piece_offsets"][len(segments) + 1 :] - 1]
        border = np.stack([edges[pieces[:, 0], 0], edges[last[:, 1] - 1, 1]], axis=1)
        return split, *np.concatenate([segments, border])[owners[split]].T
    # Without segments, the hull, which begins with a given point.
    hull = mesh["hull"]
    is_given = hull < count
    before = np.cumsum(is_given) - 1
    corners = hull[is_given]
    split = hull[~is_given]
    return split, corners[before[~is_given]], np.roll(corners, -1)[before[~is_given]]


def _attributes(mesh: Members, values: Array) -> Array:
    """Those of all points, from those of the first ones."""
    count, points = len(values), mesh["points"]
    if len(points) == count:
        return values
    all_values: Array = np.concatenate([values, LinearInterpolator(points[:count], values)(points[count:])])
    split, a, b = _ends(mesh, count)
    from_a, from_b = (np.hypot(*(points[split] - points[ends]).T)[:, None] for ends in (a, b))
    all_values[split] = (from_b * values[a] + from_a * values[b]) / (from_a + from_b)
    return all_values


def _border(mesh: Members) -> tuple[Array, Array]:
    """The ends of the edges that one triangle has. Without segments, the hull is the border."""
    triangles, hull = mesh["triangles"], mesh["hull"]
    if len(mesh["constraint_edges"]):
        border = Border(mesh["points"], triangles, mesh["neighbors"])
        return border.firsts, border.seconds
    hull = hull if len(triangles) else hull[:0]
    return hull, np.concatenate([hull[1:], hull[:1]])


def _are_in_mesh(mesh: Members, border: tuple[Array, Array]) -> tuple[Array, Array]:
    """For each constraint edge whether triangles have it, and whether it is on the border."""
    first, second = mesh["constraint_edges"].T
    ahead = np.full(len(mesh["points"]), -1, np.intc)
    ahead[border[0]] = border[1]
    if (ahead[border[0]] == border[1]).all():
        is_border = (ahead[first] == second) | (ahead[second] == first)
    else:
        # A vertex with several parts of the border.
        is_border = np.isin(edge_keys(first, second), edge_keys(*border))
    # Edges inside are in two triangles.
    inside = mesh["constrained"] & (mesh["neighbors"] >= 0)
    if 2 * np.count_nonzero(is_border) + np.count_nonzero(inside) == 2 * len(first):
        return np.full(len(first), True), is_border
    keys = edge_keys(*ends_opposite(mesh["triangles"], inside.reshape(-1).nonzero()[0]))
    return is_border | np.isin(edge_keys(first, second), keys), is_border


def _result(mesh: Members, given: Members, letters: Counter[str]) -> Members:
    """The members for the arrays of a triangulation."""
    points, triangles, neighbors = mesh["points"], mesh["triangles"], mesh["neighbors"]
    border = _border(mesh)
    pairs, markers = mesh["constraint_edges"], mesh["edge_markers"]
    # As in Triangle, the border and its vertices have the marker 1 unless they are given others.
    vertex_markers = np.zeros(len(points), np.intc)
    vertex_markers[border[0]] = 1
    marked = np.flatnonzero(markers)
    if len(marked):
        # From the last segment to the first, which counts.
        order = marked[np.argsort(-mesh["edge_segments"][marked], kind="stable")]
        vertex_markers[pairs[order]] = markers[order, None]
    own = given.get("vertex_markers")
    if own is not None:
        first = vertex_markers[: len(own)]
        np.copyto(first, own.ravel(), where=own.ravel() != 0)
    result: Members = {
        "vertices": points,
        "vertex_markers": vertex_markers[:, None],
        "triangles": triangles,
    }
    if "vertex_attributes" in given:
        result["vertex_attributes"] = _attributes(mesh, given["vertex_attributes"])
    has_segments = letters["p"] or letters["c"]
    if has_segments or (letters["e"] and len(marked)):
        kept, on_border = _are_in_mesh(mesh, border)
        pairs, markers = pairs[kept], markers[kept]
        markers = np.where(on_border[kept] & (markers == 0), 1, markers)
    if has_segments:
        result["segments"], result["segment_markers"] = pairs, markers[:, None]
    if letters["p"]:
        result.update({name: given[name] for name in ("holes", "regions") if name in given})
    if letters["n"]:
        result["neighbors"] = neighbors
    if letters["e"] or letters["o2"]:
        keys = sorted_edges(triangles, neighbors)
        edge_markers = np.zeros((len(keys), 1), np.intc)
        edge_markers[np.searchsorted(keys, edge_keys(*border))] = 1
        if len(marked):
            edge_markers[np.searchsorted(keys, edge_keys(*pairs.T))] = markers[:, None]
        result["edges"], result["edge_markers"] = rows_of_edges(keys), edge_markers
    return result


def _jettison(result: Members) -> None:
    """Leaves out vertices of no triangle."""
    used = np.unique(result["triangles"])
    for name in result.keys() & {"vertices", "vertex_markers", "vertex_attributes"}:
        result[name] = result[name][used]
    for name in result.keys() & {"triangles", "segments", "edges"}:
        result[name] = np.searchsorted(used, result[name]).astype(np.intc)


def _add_midpoints(result: Members) -> None:
    """Six nodes per triangle: the fourth to the sixth are the midpoints of the edges opposite to its corners."""
    a, b = result["edges"].T
    for name in result.keys() & {"vertices", "vertex_attributes"}:
        values = result[name]
        result[name] = np.concatenate([values, values[a] / 2 + values[b] / 2])
    first, keys = len(result["vertex_markers"]), edge_keys(a, b)
    result["vertex_markers"] = np.concatenate([result["vertex_markers"], result["edge_markers"]])
    x, y, z = result["triangles"].T
    nodes = [np.searchsorted(keys, edge_keys(*ends)) for ends in ((y, z), (z, x), (x, y))]
    middles = np.stack(nodes, axis=1).astype(np.intc) + np.intc(first)
    result["triangles"] = np.hstack([result["triangles"], middles])


def triangulate(
    tri: Mapping[str, npt.ArrayLike],
    opts: str = "",
    *,
    areas_at: Optional[Callable[[Array], npt.ArrayLike]] = None,
) -> Members:
    """Triangulates what a dictionary has, as ``triangle.triangulate`` does.

    Parameters
    ----------
    tri : dict
        ``vertices``, and perhaps ``vertex_attributes``, ``vertex_markers``, ``segments``,
        ``segment_markers``, ``holes`` and ``regions`` (x, y, attribute, largest area); for the switch r
        also ``triangles``, ``triangle_attributes`` and ``triangle_max_area``.
    opts : str
        Switches of Triangle: p, q (20 degrees, or a number up to 34), a (a number, or the areas of regions or
        triangles), r, A, c, D, e, n, u, Y, YY, S, O, j, o2. Those about how Triangle works and what it writes,
        X, i, F, l, s, C, Q, V, I, z, g, v, N, E, P and B, change nothing.
    areas_at : callable
        For the switch u, what ``triunsuitable`` is in C: takes the centroids of triangles, an array of shape
        (k, 2), and returns the areas that they may have, of shape (k,), or one for all; 0 for any. It is called
        once a round, for all triangles that are new.

    Returns
    -------
    dict
        The members that ``triangle`` returns, the given vertices first. Those without rows are there, too.

    Raises
    ------
    UsageError
        A ValueError. For other switches, such as w, for members of other names or shapes, and for u without
        `areas_at`, or the other way round.
    InputError, DeviceError
        As `flaunay.triangulate`. What `areas_at` raises is raised.

    Notes
    -----
    With o2, triangles have six nodes: after the corners the midpoints of the edges opposite to the first, the second
    and the third corner, which are the last ``vertices``. Their markers are those of the edges.

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
    if (areas_at is not None) != (letters["u"] > 0):
        raise UsageError("switch 'u' asks for the function areas_at, and only that switch does")
    given = _members(tri)
    kinds = None
    if letters["r"]:
        options, kinds = _of_mesh(given, letters)
    else:
        options = _of_drawing(given, letters)
    if letters["q"] and numbers.get("q") != 0:
        options["min_angle"] = numbers.get("q", 20)
    if "a" in numbers:
        options["max_area"] = numbers["a"]
    if areas_at is not None:
        options["areas_at"] = areas_at
    if letters["D"]:
        options["conforming"] = True
    if letters["Y"]:
        options["keep_edges"] = "border" if letters["Y"] == 1 else "all"
    if letters["S"]:
        options["most_points"] = int(numbers.get("S", 0))
    mesh = _triangulated(given, letters, options)
    result = _result(mesh, given, letters)
    attributes = mesh["triangle_attributes"]
    if attributes is not None and kinds is not None:
        result["triangle_attributes"] = kinds[attributes.astype(np.intp)]
    elif attributes is not None and letters["A"]:
        result["triangle_attributes"] = attributes[:, None]
    if letters["j"]:
        _jettison(result)
    if letters["o2"]:
        _add_midpoints(result)
        if not letters["e"]:
            del result["edges"], result["edge_markers"]
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
