"""Triangulations, Voronoi diagrams and alpha shapes on Matplotlib's axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Sequence

import numpy as np
import numpy.typing as npt

from flaunay._arrays import FloatArray
from flaunay._errors import UsageError
from flaunay._optional import optional

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.collections
    import matplotlib.lines
    import matplotlib.patches

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


def _axes(ax: Optional[matplotlib.axes.Axes], purpose: str) -> matplotlib.axes.Axes:
    """The axes given, or else the current ones, with one scale for x and y."""
    pyplot = optional("matplotlib.pyplot", purpose)
    if ax is not None:
        return ax
    current: matplotlib.axes.Axes = pyplot.gca()
    current.set_aspect("equal")
    return current


# Names that Matplotlib has for the same thing.
_WIDTH = ("linewidth", "linewidths", "lw")
_COLOR = ("color", "colors", "edgecolor", "edgecolors", "ec", "array")


def _with_defaults(style: dict[str, Any], defaults: dict[tuple[str, ...], Any]) -> dict[str, Any]:
    """The style, with what it does not say under any of its names."""
    missing = {names[0]: v for names, v in defaults.items() if not set(names) & set(style)}
    return {**missing, **style}


def _segments(
    ends: npt.NDArray[Any], style: dict[str, Any]
) -> matplotlib.collections.LineCollection:
    collections = optional("matplotlib.collections", "plot")
    lines: matplotlib.collections.LineCollection = collections.LineCollection(ends, **style)
    return lines


def draw_edges(
    points: FloatArray, edges: Indices, ax: Optional[matplotlib.axes.Axes], style: dict[str, Any]
) -> matplotlib.collections.LineCollection:
    """As `Delaunay.plot` says."""
    axes = _axes(ax, "Delaunay.plot")
    lines = _segments(points[edges], _with_defaults(style, {_WIDTH: 0.7, _COLOR: "tab:blue"}))
    axes.add_collection(lines)
    axes.autoscale_view()
    return lines


Bounds = Sequence[float]

# The share of the points' extent that a plot without bounds shows around them.
_MARGIN = 0.1


def _checked_bounds(bounds: Bounds) -> tuple[Doubles, Doubles]:
    """The lower left and the upper right corner."""
    box = np.asarray(bounds, np.float64)
    if box.shape != (4,) or not (box[2:] > box[:2]).all() or not np.isfinite(box).all():
        raise UsageError(f"bounds must be (xmin, ymin, xmax, ymax), not {bounds!r}")
    return box[:2], box[2:]


def _box_around(points: Doubles) -> tuple[Doubles, Doubles]:
    """The points' box and a margin on all sides, also if it is a point or a line."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * float((high - low).max()) or 1.0
    return low - margin, high + margin


def _clipped_to_box(
    start: Doubles, step: Doubles, first: Doubles, last: Doubles, box: tuple[Doubles, Doubles]
) -> Doubles:
    """The parts in a box of the lines start + t step for t from `first` to `last`, which may be infinite.

    By the method of Liang and Barsky; those without a part in the box, or without length, are left out.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        enters, leaves = (np.where(step > 0, *pair) for pair in (box, box[::-1]))
        t = np.stack([(enters - start) / step, (leaves - start) / step])
    # A line along an axis is inside for all t, or for none.
    inside = (start >= box[0]) & (start <= box[1])
    still = step == 0
    t[0][still] = np.where(inside[still], -np.inf, np.inf)
    t[1][still] = np.inf
    begin, end = np.maximum(first, t[0].max(axis=1)), np.minimum(last, t[1].min(axis=1))
    kept = (begin < end) & (step != 0).any(axis=1)
    return np.stack([start[kept] + t[kept, None] * step[kept] for t in (begin, end)], axis=1)


def _bisectors(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """Points of the lines between a and b, and directions: to the right on the way from a to b."""
    across = b - a
    return (a + b) / 2, np.stack([across[:, 1], -across[:, 0]], axis=1)


def _ridges_in_box(
    points: Doubles,
    hull: Indices,
    vertices: Doubles,
    ridge_points: Indices,
    ridge_vertices: Indices,
    box: tuple[Doubles, Doubles],
) -> Doubles:
    """The Voronoi edges in a box, shape (k, 2, 2)."""
    if len(vertices) == 0:
        # The edges of points on one line are lines.
        start, step = _bisectors(points[hull[:-1]], points[hull[1:]])
        everywhere = np.full(len(start), np.inf)
        return _clipped_to_box(start, step, -everywhere, everywhere, box)
    endless = ridge_vertices[:, 0] < 0
    # Ridge points are in the order of a counter-clockwise triangle, so that outside is to the right.
    _, outward = _bisectors(*points[ridge_points[endless].T])
    start = vertices[ridge_vertices[:, 1]]
    step = vertices[ridge_vertices[:, 0]] - start
    step[endless] = outward
    last = np.where(endless, np.inf, 1.0)
    return _clipped_to_box(start, step, np.zeros(len(last)), last, box)


def draw_voronoi(
    points: FloatArray,
    hull: Indices,
    vertices: Doubles,
    ridge_points: Indices,
    ridge_vertices: Indices,
    ax: Optional[matplotlib.axes.Axes],
    bounds: Optional[Bounds],
    style: dict[str, Any],
) -> matplotlib.collections.LineCollection:
    """As `Voronoi.plot` says."""
    axes = _axes(ax, "Voronoi.plot")
    places = np.asarray(points, np.float64)
    if bounds is not None:
        box = _checked_bounds(bounds)
    else:
        box = _box_around(places if len(places) else np.zeros((1, 2)))
    ridges = _ridges_in_box(places, hull, vertices, ridge_points, ridge_vertices, box)
    lines = _segments(ridges, _with_defaults(style, {_WIDTH: 0.7, _COLOR: "tab:green"}))
    axes.add_collection(lines)
    axes.update_datalim(np.stack(box))
    axes.autoscale_view()
    return lines


AlphaShapeArtists = tuple[
    "matplotlib.patches.PathPatch",
    "matplotlib.collections.LineCollection",
    "matplotlib.lines.Line2D",
]


def draw_alpha_shape(
    points: FloatArray,
    rings: list[Indices],
    singular_edges: Indices,
    isolated: Indices,
    ax: Optional[matplotlib.axes.Axes],
    style: dict[str, Any],
) -> AlphaShapeArtists:
    """As `AlphaShape.plot` says."""
    axes = _axes(ax, "AlphaShape.plot")
    paths = optional("matplotlib.path", "AlphaShape.plot")
    patches = optional("matplotlib.patches", "AlphaShape.plot")
    look = {
        "facecolor": "tab:blue",
        "alpha": 0.6,
        "edgecolor": "tab:blue",
        "linewidth": 1.0,
        **style,
    }
    # One path of all rings: holes turn the other way, so they stay empty.
    closed = [points[np.append(ring, ring[0])] for ring in rings]
    codes = [
        [paths.Path.MOVETO] + [paths.Path.LINETO] * (len(r) - 1) + [paths.Path.CLOSEPOLY]
        for r in rings
    ]
    path = paths.Path(
        np.concatenate([np.empty((0, 2)), *closed]), np.concatenate([np.empty(0, np.uint8), *codes])
    )
    patch: matplotlib.patches.PathPatch = patches.PathPatch(path, **look)
    axes.add_patch(patch)
    plain = {"color": look["edgecolor"], "linewidth": look["linewidth"]}
    lines = _segments(points[singular_edges], plain)
    axes.add_collection(lines)
    (dots,) = axes.plot(*points[isolated].T, ".", color=look["edgecolor"], markersize=3)
    axes.autoscale_view()
    return patch, lines, dots


ConstrainedArtists = tuple[
    "matplotlib.collections.LineCollection", "matplotlib.collections.LineCollection"
]


def draw_constrained(
    points: Doubles,
    edges: Indices,
    constraint_edges: Indices,
    ax: Optional[matplotlib.axes.Axes],
    style: dict[str, Any],
    purpose: str,
) -> ConstrainedArtists:
    """As `ConstrainedTriangulation.plot` says. edges: those that are no constraints."""
    axes = _axes(ax, purpose)
    look = _with_defaults(style, {_WIDTH: 0.5, _COLOR: "tab:blue"})
    strong = {
        "color": look.pop("constraint_color", "tab:red"),
        "linewidth": look.pop("constraint_linewidth", 1.6),
        "capstyle": "round",
    }
    lines, constraints = _segments(points[edges], look), _segments(points[constraint_edges], strong)
    for collection in (lines, constraints):
        axes.add_collection(collection)
    axes.autoscale_view()
    return lines, constraints
