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

from flaunay import _calls, _triangulate
from flaunay._arrays import ArrayLike
from flaunay._constrained import ConstrainedTriangulation
from flaunay._delaunay import Delaunay
from flaunay._errors import InputError, UsageError
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
    """The same for triangles, and the different rows of their attributes, which seeds number from 1 on."""
    points, n = given["vertices"], len(given["vertices"])
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
    centroids = points[triangles].mean(axis=1)
    seeds = np.column_stack([centroids, kind + 1])
    # What no seed reaches is no part of the mesh: a hole in the largest triangle of each such region.
    whole = _triangulate.triangulate(points, border, seeds=seeds, labels=True)
    assert whole.regions is not None
    beyond = np.flatnonzero(whole.triangle_attributes == 0)
    beyond = beyond[np.argsort(whole.areas[beyond])]
    largest = dict(zip(whole.regions[beyond].tolist(), beyond.tolist()))
    holes = whole.points[whole.triangles[list(largest.values())]].mean(axis=1)
    options: Options = {"seeds": seeds, "holes": holes}
    if letters["areas"] and "triangle_max_area" in given:
        bounds = np.maximum(given["triangle_max_area"].ravel(), 0)
        # On a triangulator of its own, since that of the call is at work.
        host = _calls.Triangulator.of_name("host")
        nearest = _calls.Locator(host, Delaunay(centroids)).nearest
        options["areas_at"] = lambda places: bounds[nearest(places)]
    if "triangle_attributes" not in given:
        kinds = kinds[:, :0]
    return *_segments_of(given, letters, border), options, kinds


def _split_places(
    mesh: ConstrainedTriangulation, segments: Array, owners: Array
) -> tuple[Array, Array]:
    """The constraint edges with an obtuse angle opposite to them, and a place on each of them.

    A whole segment is split in the middle, and a part of one near the middle, at the roundest binary number
    of the distances from the nearer end: so segments that meet at a small angle have points at equal
    distances from there, and do not split each other again and again.
    """
    points, n = mesh.points, len(mesh.points)
    corners = np.stack([np.roll(mesh.triangles, -k, axis=1)[mesh.constrained] for k in range(3)])
    apex, a, b = points[corners]
    hit = _keys(corners[1:, ((a - apex) * (b - apex)).sum(axis=1) < 0].T, n)
    edges = np.flatnonzero(np.isin(_keys(mesh.constraint_edges, n), hit))
    ends, (a, b) = points[mesh.constraint_edges[edges]], points[segments[owners[edges]].T]
    nearer = np.hypot(*(ends.mean(axis=1) - b).T) < np.hypot(*(ends.mean(axis=1) - a).T)
    a, b = np.where(nearer[:, None], (b, a), (a, b))
    length = np.hypot(*(b - a).T)
    near, far = np.sort([np.hypot(*(end - a).T) for end in (ends[:, 0], ends[:, 1])], axis=0)
    low, high = near + (far - near) / 3, far - (far - near) / 3
    step = np.exp2(np.floor(np.log2(high - low)))
    place = high
    while True:
        rounder = np.floor(high / step) * step
        if not (rounder >= low).any():
            break
        place = np.where(rounder >= low, rounder, place)
        step = 2 * step
    place = np.where((near == 0) & (far >= length), length / 2, place)
    return edges, a + (place / length)[:, None] * (b - a)


def _refined(
    points: Array, segments: Array, markers: Array, options: Options, conforming: bool
) -> tuple[ConstrainedTriangulation, Array, Array]:
    """The mesh, and of its constraint edges the markers and the segments."""
    count, first, owners = len(points), segments, np.arange(len(segments))
    budget = options.get("most_points")
    for _ in range(60):
        if budget is not None:
            options["most_points"] = budget - (len(points) - count)
        # The border is of segments, also where it is the hull, whose parts are rounded.
        options.update(segment_markers=markers, crossings="split", outside="hull")
        mesh = _triangulate.triangulate(points, segments, **options)
        assert mesh.edge_markers is not None
        n, pairs = len(mesh.points), mesh.constraint_edges
        markers, owners = mesh.edge_markers, owners[mesh.edge_segments]
        if not conforming:
            return mesh, markers, owners
        edges, places = _split_places(mesh, first, owners)
        if budget is not None:
            edges, places = (of[: max(budget - (n - count), 0)] for of in (edges, places))
        if not len(edges):
            return mesh, markers, owners
        if mesh.refinement is not None and len(mesh.refinement.bad_triangles):
            # What cannot be better next to small angles is known of segments, not of their pieces.
            options.update(min_angle=0, max_area=0, seed_areas=None, areas_at=None)
        points = np.concatenate([mesh.points, places])
        segments = np.concatenate([pairs, pairs[edges]])
        segments[edges, 1] = segments[len(pairs) :, 0] = n + np.arange(len(edges))
        markers, owners = (np.concatenate([of, of[edges]]) for of in (markers, owners))
    raise InputError("switch 'D': segments are too close together to be split")


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
    mesh: ConstrainedTriangulation,
    segments: Array,
    markers: Array,
    owners: Array,
    given: Members,
    letters: Counter[str],
) -> Members:
    """The members for a mesh. markers, owners: the markers and segments of its constraint edges."""
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
        As `flaunay.triangulate`. InputError if segments are too close together for D.

    Notes
    -----
    Attributes of vertices that are added are linear between the ends of their segment, or else in the
    Delaunay triangles of the given vertices. With r, triangles are made anew of all vertices, of segments (with
    p), of the border, and of edges between triangles of different attributes; the largest area at a place
    is that of the given triangle with the nearest centroid. With D, segments are split until no angle opposite
    to them is obtuse. If some triangles cannot have the angles that q asks for, others next to these splits
    may not have them either.

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
    conforming = letters["D"] > 0
    mesh, markers, owners = _refined(given["vertices"], segments, markers, options, conforming)
    result = _result(mesh, segments, markers, owners, given, letters)
    of_seeds = mesh.triangle_attributes
    if of_seeds is not None and kinds is not None and kinds.size:
        result["triangle_attributes"] = kinds[of_seeds.astype(np.intp) - 1]
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
