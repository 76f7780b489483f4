"""Triangulations, Voronoi diagrams and alpha shapes on Matplotlib's axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay._arrays import FloatArray
from flaunay._errors import UsageError
from flaunay._graphs import TriangleGraphs
from flaunay._optional import optional

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.collections
    import matplotlib.lines
    import matplotlib.patches

    from flaunay._alpha_shape import AlphaShape

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
    points: FloatArray, edges: Indices, style: dict[str, Any]
) -> matplotlib.collections.LineCollection:
    collections = optional("matplotlib.collections", "plot")
    lines: matplotlib.collections.LineCollection = collections.LineCollection(
        points[edges], **style
    )
    return lines


class TrianglePlots(TriangleGraphs):
    """`Delaunay` on Matplotlib's axes."""

    def plot(
        self, ax: Optional[matplotlib.axes.Axes] = None, **style: Any
    ) -> matplotlib.collections.LineCollection:
        """Draws the edges, each once.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw. Without it, on the current axes, whose aspect becomes equal.
        **style
            As `matplotlib.collections.LineCollection` takes it, such as ``color`` and ``linewidth``.

        Returns
        -------
        matplotlib.collections.LineCollection
            One line for each of `edges`, in their order, so ``array=tri.edge_lengths`` colours them.

        Raises
        ------
        ImportError
            Without Matplotlib.

        Examples
        --------
        >>> import flaunay, matplotlib
        >>> matplotlib.use("Agg")
        >>> lines = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]]).plot(color="tab:red")
        >>> len(lines.get_segments())
        3
        """
        axes = _axes(ax, "Delaunay.plot")
        look = _with_defaults(style, {_WIDTH: 0.7, _COLOR: "tab:blue"})
        lines = _segments(self.points, self.edges, look)
        axes.add_collection(lines)
        axes.autoscale_view()
        return lines


AlphaShapeArtists = tuple[
    "matplotlib.patches.PathPatch",
    "matplotlib.collections.LineCollection",
    "matplotlib.lines.Line2D",
]


def draw_alpha_shape(
    shape: AlphaShape, ax: Optional[matplotlib.axes.Axes], style: dict[str, Any]
) -> AlphaShapeArtists:
    """As `AlphaShape.plot` says."""
    axes = _axes(ax, "AlphaShape.plot")
    paths = optional("matplotlib.path", "AlphaShape.plot")
    patches = optional("matplotlib.patches", "AlphaShape.plot")
    points = shape.delaunay.points
    look = {
        "facecolor": "tab:blue",
        "alpha": 0.6,
        "edgecolor": "tab:blue",
        "linewidth": 1.0,
        **style,
    }
    # One path of all rings: holes turn the other way, so they stay empty.
    rings = shape.rings()
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
    lines = _segments(points, shape.singular_edges, plain)
    axes.add_collection(lines)
    (dots,) = axes.plot(*points[shape.isolated].T, ".", color=look["edgecolor"], markersize=3)
    axes.autoscale_view()
    return patch, lines, dots
