"""Alpha shapes: the outline of a cloud of points."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, TypedDict, Union

import numpy as np
import numpy.typing as npt

from flaunay._arrays import ArrayLike, Fixed, frozen, summary
from flaunay._delaunay import Delaunay
from flaunay._errors import UsageError
from flaunay._graphs import minimum_spanning_forest
from flaunay._optional import optional
from flaunay._plot import AlphaShapeArtists, draw_alpha_shape
from flaunay._rings import are_outer, order_of_parts, rings_of

if TYPE_CHECKING:
    import matplotlib.axes
    import shapely
    from typing_extensions import Unpack

# The tolerance of the default alpha: relative, and in units in the last place of the largest coordinate.
_TOLERANCE, _ROUNDINGS = 1e-6, 8

Indices = npt.NDArray[np.int32]
Mask = npt.NDArray[np.bool_]


class _OfDelaunay(TypedDict, total=False):
    """The keywords of `Delaunay`."""

    furthest_site: bool
    incremental: bool
    qhull_options: Optional[str]
    mode: str
    device: Optional[str]


class AlphaShape(Fixed):
    """An alpha shape of points in the plane. `alpha_shape` makes it.

    Attributes
    ----------
    delaunay : Delaunay
        The triangulation that it is a part of.
    alpha : float
        The radius.
    inside : ndarray of bool, shape (nsimplex,)
        Which of ``delaunay.simplices`` are in the shape: those whose circumradius is at most alpha.
    """

    def __init__(self, delaunay: Delaunay, alpha: float) -> None:
        self.delaunay = delaunay
        self.alpha = alpha
        self.inside: Mask = frozen(delaunay.circumradii <= alpha)

    def __repr__(self) -> str:
        return summary(self, points=self.delaunay.npoints, triangles=len(self.simplices))

    @property
    def simplices(self) -> Indices:
        """The triangles of the shape, int32, shape (m, 3)."""
        triangles: Indices = self.delaunay.simplices[self.inside]
        return triangles

    @cached_property
    def area(self) -> float:
        """The area of the triangles."""
        return float(self.delaunay.areas[self.inside].sum())

    @cached_property
    def _boundary(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """The triangles at the boundary, and their corners opposite to it."""
        beyond = self.delaunay.neighbors
        is_boundary = self.inside[:, None] & ~((beyond >= 0) & self.inside[beyond])
        triangle, corner = np.nonzero(is_boundary)
        return triangle, corner

    @cached_property
    def edges(self) -> Indices:
        """The boundary of the triangles, int32, shape (k, 2).

        Each edge is directed: the triangles are to its left.
        """
        triangle, corner = self._boundary
        ends = [self.delaunay.simplices[triangle, (corner + k) % 3] for k in (1, 2)]
        edges: Indices = np.stack(ends, axis=1)
        return edges

    @cached_property
    def singular_edges(self) -> Indices:
        """Edges of the general alpha shape that have no triangles, int32, shape (k, 2).

        They are at most 2 alpha long, no other point is in the disc that has them as diameter, and
        neither of their triangles is in the shape.
        """
        tri = self.delaunay
        sides = tri.edge_simplices
        taken = tri.is_gabriel & (tri.edge_lengths / 2 <= self.alpha)
        if tri.nsimplex:
            taken &= ~((sides >= 0) & self.inside[sides]).any(axis=1)
        edges: Indices = tri.edges[taken]
        return edges

    @cached_property
    def isolated(self) -> Indices:
        """Points in no triangle and no singular edge, int32, increasing.

        Points that equal an earlier one are not listed.
        """
        alone = self.delaunay.representatives == np.arange(self.delaunay.npoints)
        alone[self.simplices] = False
        alone[self.singular_edges] = False
        return np.flatnonzero(alone).astype(np.int32)

    def _following(self) -> npt.NDArray[np.intp]:
        """For each boundary edge the next one around the same triangles.

        Found by turning around the edge's end, through triangles, until one has no neighbour inside. So
        at a point where parts of the shape touch, each part goes on with its own edges.
        """
        corners, neighbors = self.delaunay.simplices, self.delaunay.neighbors
        edge_of = np.full(corners.shape, -1, np.int64)
        edge_of[self._boundary] = np.arange(len(self.edges))
        following = np.empty(len(self.edges), np.intp)
        turning = np.arange(len(self.edges))
        end = self.edges[:, 1]
        triangle, corner = self._boundary
        # The side that leaves the end is opposite to the next corner.
        corner = (corner + 1) % 3
        while turning.size:
            found = edge_of[triangle, corner]
            is_found = found >= 0
            following[turning[is_found]] = found[is_found]
            turning = turning[~is_found]
            triangle = neighbors[triangle[~is_found], corner[~is_found]].astype(np.intp)
            at_end = np.argmax(corners[triangle] == end[turning, None], axis=1)
            # From corner k the next side, counter-clockwise, is opposite to corner k - 1.
            corner = (at_end + 2) % 3
        return following

    @cached_property
    def _cycles(self) -> tuple[list[Indices], npt.NDArray[np.intp], Mask]:
        """The rings, a triangle of each, and which are outer ones."""
        starts = self.edges[:, 0]
        numbers = np.unique(starts, return_inverse=True)[1]
        members, offsets = rings_of(self._following(), numbers)
        corners = starts[members]
        outer = are_outer(self.delaunay.points, corners, offsets)
        rings = [np.roll(ring, -int(np.argmin(ring))) for ring in np.split(corners, offsets[1:-1])[: len(outer)]]
        order = sorted(range(len(rings)), key=lambda k: int(rings[k][0]))
        return [rings[k] for k in order], self._boundary[0][members[offsets[order]]], outer[order]

    def rings(self) -> list[Indices]:
        """The boundary as closed rings of points.

        Returns
        -------
        list of ndarray of int32
            Indices of points. Outer rings are counter-clockwise, holes clockwise. Each begins with its
            smallest index, which is not repeated at the end, and the rings are in the order of these. No
            ring meets a point twice: where the boundary touches itself, there are several rings.

        Notes
        -----
        O(k) work for k boundary edges.

        Examples
        --------
        >>> import flaunay
        >>> points = [[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]]
        >>> [ring.tolist() for ring in flaunay.alpha_shape(points, 3).rings()]
        [[0, 1, 2, 3]]
        """
        return list(self._cycles[0])

    @cached_property
    def _components(self) -> npt.NDArray[np.int32]:
        """For each triangle of the triangulation its component of the shape; others have one each."""
        csgraph = optional("scipy.sparse.csgraph", "AlphaShape.polygons")
        sparse = optional("scipy.sparse", "AlphaShape.polygons")
        first, second = _inner_sides(self.delaunay).T
        both = self.inside[first] & self.inside[second]
        n = self.delaunay.nsimplex
        graph = sparse.coo_array(
            (np.ones(int(both.sum()), np.int8), (first[both], second[both])), shape=(n, n)
        )
        labels: npt.NDArray[np.int32] = csgraph.connected_components(graph, directed=False)[1]
        return labels

    def polygons(self) -> list[list[Indices]]:
        """The components of the shape, each with its outer ring first and then its holes.

        Triangles are in one component if one can go from one to the other across common edges.

        Returns
        -------
        list of list of ndarray of int32
            Rings as `rings` has them, valid as polygons of the Simple Features standard. Needs SciPy.

        Raises
        ------
        ImportError
            Without SciPy.

        Examples
        --------
        >>> import flaunay
        >>> points = [[0, 0], [1, 0], [0, 1], [9, 9], [9, 8], [8, 9]]
        >>> [[ring.tolist() for ring in part] for part in flaunay.alpha_shape(points, 1).polygons()]
        [[[0, 1, 2]], [[3, 5, 4]]]
        """
        rings, triangles, outer = self._cycles
        if not rings:
            return []
        order = order_of_parts(outer, self._components[triangles])
        parts = np.split(order, np.flatnonzero(outer[order])[1:])
        return [[rings[k] for k in part.tolist()] for part in parts]

    def to_shapely(self) -> shapely.MultiPolygon:
        """The triangles of the shape as one geometry of Shapely.

        Returns
        -------
        shapely.MultiPolygon
            With a polygon for each component. Needs SciPy and Shapely 2.

        Raises
        ------
        ImportError
            Without these.
        """
        geometry = optional("shapely", "AlphaShape.to_shapely")
        points = self.delaunay.points
        polygons: shapely.MultiPolygon = geometry.MultiPolygon(
            [
                geometry.Polygon(points[outer], [points[hole] for hole in holes])
                for outer, *holes in self.polygons()
            ]
        )
        return polygons

    def plot(self, ax: Optional[matplotlib.axes.Axes] = None, **style: Any) -> AlphaShapeArtists:
        """Draws the triangles as one area with its boundary, and what has no triangles as lines and dots.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw. Without it, on the current axes, whose aspect becomes equal.
        **style
            As `matplotlib.patches.PathPatch` takes it, such as ``facecolor``. Lines and dots have the
            colour of ``edgecolor``.

        Returns
        -------
        patch : matplotlib.patches.PathPatch
            The rings.
        lines : matplotlib.collections.LineCollection
            The singular edges.
        dots : matplotlib.lines.Line2D
            The isolated points.

        Raises
        ------
        ImportError
            Without Matplotlib.
        """
        return draw_alpha_shape(
            self.delaunay.points, self.rings(), self.singular_edges, self.isolated, ax, style
        )


def _inner_sides(tri: Delaunay) -> Indices:
    """The two simplices at each edge that has two."""
    sides = tri.edge_simplices
    inner: Indices = sides[sides[:, 0] >= 0]
    return inner


def _covering_alpha(tri: Delaunay) -> float:
    """The smallest alpha, with a tolerance, whose triangles have all points and are one component; else infinite."""
    if tri.nsimplex == 0:
        return np.inf
    radii = tri.circumradii
    # A point is covered as soon as the smallest of its triangles is there, which is written last.
    order = np.argsort(radii)[::-1]
    smallest = np.zeros(tri.npoints)
    smallest[tri.simplices[order]] = radii[order, None]
    covered = smallest.max()
    # With growing alpha each triangle is a new component, and each edge of a minimum spanning tree joins two, when
    # the larger of its triangles is there.
    sides = _inner_sides(tri)
    joins = radii[sides].max(axis=1)
    joins = np.sort(joins[minimum_spanning_forest(sides, joins, tri.nsimplex)])
    candidates = np.unique(radii)
    parts = np.searchsorted(radii[order[::-1]], candidates, "right")
    components = parts - np.searchsorted(joins, candidates, "right")
    fits = (candidates >= covered) & (components == 1)
    alpha = float(candidates[np.argmax(fits)])
    # Radii that are equal but for the rounding of coordinates, as in grids of degrees, are all taken.
    largest = np.maximum(np.abs(tri.min_bound), np.abs(tri.max_bound)).max()
    return alpha * (1 + _TOLERANCE) + _ROUNDINGS * float(np.spacing(largest))


def alpha_shape(
    points: Union[ArrayLike, Delaunay],
    alpha: Union[float, str] = "auto",
    **options: Unpack[_OfDelaunay],
) -> AlphaShape:
    """The alpha shape of points in the plane: their outline, as a disc of radius alpha sees it.

    Everything that a disc of this radius can reach without touching a point is cut away. With a large alpha
    the convex hull is left, with a small one only the points.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay
        The points, or their triangulation.
    alpha : float or "auto"
        The radius, not negative; ``inf`` gives the convex hull. ``"auto"`` takes the smallest radius
        for which every point is in a triangle, and the triangles are one component: one can go from
        each to each across common edges. It is taken with a tolerance of a millionth and of 8 units in the last
        place of the largest coordinate (which float32 has larger ones of), so that a grid of rounded
        coordinates has no holes.
    **options
        As `Delaunay` takes them, such as ``device``. Not with a triangulation.

    Returns
    -------
    AlphaShape

    Raises
    ------
    UsageError
        For an alpha that is negative, NaN or no number.
    UsageError, InputError, DeviceError
        As of `Delaunay`.
    ImportError
        For ``"auto"`` without SciPy.

    Notes
    -----
    alpha is the radius, as in Edelsbrunner and Mücke (1994) and in MATLAB. In Edelsbrunner, Kirkpatrick and
    Seidel (1983) it is minus one over the radius, in the package alphashape one over the radius, and in
    CGAL the radius squared.

    `AlphaShape.simplices`, `edges`, `rings`, `polygons` and `area` describe the triangles, which CGAL
    calls the regularised alpha shape. The general one also has `singular_edges` and `isolated` points.

    The triangulation is exact. Radii are computed with a relative error below 2**-45, and half lengths
    with one below 2**-51, so a triangle or an edge whose radius is closer to alpha than that may be
    in the shape or not.

    O(n log n) work.

    Examples
    --------
    >>> import flaunay
    >>> points = [[0, 0], [1, 0], [0, 1], [9, 9]]
    >>> shape = flaunay.alpha_shape(points, alpha=1)
    >>> shape.simplices
    array([[0, 1, 2]], dtype=int32)
    >>> shape.isolated
    array([3], dtype=int32)
    """
    if isinstance(points, Delaunay):
        if options:
            raise UsageError(f"{next(iter(options))} is for points, not for a triangulation")
        tri = points
    else:
        tri = Delaunay(points, **options)
    if isinstance(alpha, str):
        if alpha != "auto":
            raise UsageError(f"alpha must be a number or 'auto', not {alpha!r}")
        return AlphaShape(tri, _covering_alpha(tri))
    try:
        radius = float(alpha)
    except TypeError as error:
        raise UsageError(f"alpha must be a number or 'auto', not {alpha!r}") from error
    if not radius >= 0:
        raise UsageError(f"alpha must not be negative, nor NaN: {radius}")
    return AlphaShape(tri, radius)
