"""The Voronoi diagram with the names of SciPy."""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, FloatArray, Frozen, frozen, summary
from flaunay._cells import ClippedVoronoi, clip
from flaunay._delaunay import Delaunay
from flaunay._errors import UsageError
from flaunay._pieces import VoronoiPieces, mesh_of, pieces
from flaunay._plot import Bounds, draw_voronoi

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.collections

Indices = npt.NDArray[np.int32]


class Voronoi(Frozen):
    """The Voronoi diagram of points in the plane, with the attributes of SciPy's.

    It has a vertex for each Delaunay triangle. Where more than three points are cocircular, vertices
    coincide, and the ridges between them have no length; with ``merge=True`` they are one vertex, as in
    SciPy, and there are no such ridges. All arrays are read-only.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay
        As of `Delaunay`; or the triangulation whose dual it is, without the options of one.
    furthest_site, incremental, qhull_options
        As of `Delaunay`.
    merge : bool
        Whether the vertices of triangles with the same circumcircle are one, which is decided exactly.
    mode, device : str, optional
        As of `triangulate`.

    Attributes
    ----------
    delaunay : Delaunay
        The triangulation whose dual it is.
    points : ndarray of float64 or float32, shape (npoints, 2)
        The coordinates.
    vertices : ndarray of float64, shape (nvertices, 2)
        The circumcentres of the triangles, rounded: those of all in their order, or with `merge` of the
        first of each circumcircle. What is adjacent does not depend on rounding. Vertices that coincide
        but for that are equal, so that bounded cells do not cross themselves.
    cells : ndarray of int32
        Point i has the vertices ``cells[cell_offsets[i]:cell_offsets[i + 1]]``, counter-clockwise;
        of an unbounded cell from the hull edge that leaves the point to the one that arrives. None
        for a point that equals an earlier one, and for points on one line.
    cell_offsets : ndarray of int32, shape (npoints + 1,)
    unbounded : ndarray of bool, shape (npoints,)
        Which points have unbounded cells: those of the hull.
    npoints, ndim : int
        Numbers of points and of dimensions, which are 2.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`.

    Notes
    -----
    O(n log n) work.

    Examples
    --------
    >>> import flaunay
    >>> vor = flaunay.Voronoi([[0, 0], [2, 0], [0, 2]])
    >>> vor.vertices
    array([[1., 1.]])
    >>> vor.ridge_vertices
    array([[-1,  0],
           [-1,  0],
           [-1,  0]], dtype=int32)

    A square has two triangles, and one circumcircle:

    >>> square = [[0, 0], [2, 0], [0, 2], [2, 2]]
    >>> len(flaunay.Voronoi(square).vertices)
    2
    >>> len(flaunay.Voronoi(square, merge=True).vertices)
    1
    """

    ndim = 2
    furthest_site = False

    def __init__(
        self,
        points: Union[ArrayLike, Delaunay],
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: Optional[str] = None,
        *,
        merge: bool = False,
        mode: str = "blocks",
        device: Optional[str] = None,
    ) -> None:
        options = (furthest_site, incremental, qhull_options)
        self.delaunay: Delaunay
        if isinstance(points, Delaunay):
            if options != (False, False, None) or mode != "blocks":
                raise UsageError("options of the triangulation are for points, not for a triangulation")
            self.delaunay = points if points._living is None else copy(points)
        else:
            self.delaunay = Delaunay(points, *options, mode=mode, device=device)
        self._merge, self._device = merge, device
        self._compute()

    def _compute(self) -> None:
        """Computes the dual of `delaunay`, as it is now."""
        tri = self.delaunay
        for name in ("_ridges", "ridge_dict", "regions", "point_region"):
            self.__dict__.pop(name, None)
        self.points: FloatArray = tri.points
        arrays = _calls.voronoi(_triangulators.of_device(self._device), tri)
        vertices, cells = arrays["circumcentres"], arrays["cells"]
        offsets = arrays["cell_offsets"]
        self.unbounded: npt.NDArray[np.bool_] = frozen(arrays["unbounded"])
        # The vertex of each triangle; None if it has its triangle's index.
        self._vertex_of: Optional[Indices] = None
        if self._merge:
            first = _calls.same_circles(tri.points, tri.simplices, tri.neighbors)
            distinct, numbers = np.unique(first, return_inverse=True)
            vertices = vertices[distinct]
            offsets, cells = _merge_cells(numbers, offsets, cells, self.unbounded)
            self._vertex_of = frozen(numbers.astype(np.int32))
        self.vertices: npt.NDArray[np.float64] = frozen(vertices)
        self.cell_offsets: Indices = frozen(offsets)
        self.cells: Indices = frozen(cells)

    def __repr__(self) -> str:
        return summary(self, points=self.npoints, vertices=len(self.vertices))

    @property
    def npoints(self) -> int:
        return len(self.points)

    @property
    def min_bound(self) -> FloatArray:
        """The smallest coordinates, shape (2,); NaN if there are no points."""
        return self.delaunay.min_bound

    @property
    def max_bound(self) -> FloatArray:
        """The largest coordinates, shape (2,); NaN if there are no points."""
        return self.delaunay.max_bound

    @cached_property
    def _ridges(self) -> tuple[Indices, Indices]:
        """Each Delaunay edge once, and the triangles on its sides."""
        corners, neighbors = self.delaunay.simplices, self.delaunay.neighbors
        # The triangle with the larger index has the edge; -1 is the smallest.
        triangle, corner = np.nonzero(neighbors < np.arange(len(corners))[:, None])
        ends = [corners[triangle, (corner + k) % 3] for k in (1, 2)]
        sides = [neighbors[triangle, corner], triangle.astype(np.int32)]
        points, vertices = np.stack(ends, axis=1), np.stack(sides, axis=1)
        if self._vertex_of is not None:
            vertices = np.where(vertices < 0, -1, self._vertex_of[vertices]).astype(np.int32)
            has_length = vertices[:, 0] != vertices[:, 1]
            points, vertices = points[has_length], vertices[has_length]
        return frozen(points), frozen(vertices)

    @property
    def ridge_points(self) -> Indices:
        """The two points that each ridge lies between, int32, shape (nridges, 2)."""
        return self._ridges[0]

    @property
    def ridge_vertices(self) -> Indices:
        """The two vertices of each ridge, int32, shape (nridges, 2); the first is -1 at infinity."""
        return self._ridges[1]

    @cached_property
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """For the two points of each ridge its vertices, as `ridge_points` and `ridge_vertices` have them.

        Examples
        --------
        >>> import flaunay
        >>> flaunay.Voronoi([[0, 0], [2, 0], [0, 2]]).ridge_dict[1, 2]
        [-1, 0]
        """
        first, second = self.ridge_points.T.tolist()
        return dict(zip(zip(first, second), self.ridge_vertices.tolist()))

    @cached_property
    def regions(self) -> list[list[int]]:
        """For each point the vertices of its cell, counter-clockwise, with -1 last if unbounded.

        Lists, as SciPy has them; `cells` and `cell_offsets` say the same in arrays.
        """
        regions: list[list[int]] = [
            cell.tolist() for cell in np.split(self.cells, self.cell_offsets[1:-1])
        ][: self.npoints]
        for point in np.flatnonzero(self.unbounded).tolist():
            if regions[point]:
                regions[point].append(-1)
        return regions

    @cached_property
    def point_region(self) -> npt.NDArray[np.intp]:
        """For each point the place of its cell in `regions`, shape (npoints,); -1 if there is none.

        For a point that equals an earlier one, that of the other.
        """
        representatives = self.delaunay.representatives
        has_cell = np.diff(self.cell_offsets)[representatives] > 0
        return frozen(np.where(has_cell, representatives, -1).astype(np.intp))

    def clipped(self, bounds: Any) -> ClippedVoronoi:
        """The cells, clipped to a box or a convex polygon.

        Parameters
        ----------
        bounds : array_like or shapely.Polygon
            ``(xmin, ymin, xmax, ymax)``, or the corners of a convex polygon, shape (m, 2), in either
            direction; a last corner that repeats the first does not count.

        Returns
        -------
        ClippedVoronoi

        Raises
        ------
        UsageError
            If the bounds are neither.
        InputError
            If the polygon is not convex, or not finite; the message names a corner.

        Notes
        -----
        Points may lie outside, on one line, or be few: one point has the whole polygon.

        Examples
        --------
        >>> import flaunay
        >>> vor = flaunay.Voronoi([[1, 1], [3, 1], [2, 4]])
        >>> cells = vor.clipped((0, 0, 4, 4))
        >>> float(cells.areas.sum())
        16.0
        >>> len(cells.polygon(0))
        4
        """
        return clip(self.delaunay, bounds)

    def pieces(self, region: Any) -> VoronoiPieces:
        """The cells clipped to polygons of any shape, with holes, such as a country.

        A constrained triangulation of the polygons is exact, and so is the clipping of the cells to each of its
        triangles; so a cell is in convex pieces.

        Parameters
        ----------
        region : shapely.Polygon or MultiPolygon, GeoSeries, GeoJSON, or list of polygons
            As `polygons` takes them. What is in several polygons counts once.

        Returns
        -------
        VoronoiPieces

        Raises
        ------
        UsageError, InputError
            As of `polygons`, and for polygons without area.

        Examples
        --------
        >>> import flaunay
        >>> frame = [[[0, 0], [4, 0], [4, 4], [0, 4]], [[1, 1], [1, 3], [3, 3], [3, 1]]]
        >>> cells = flaunay.Voronoi([[1, 2], [3, 2]]).pieces([frame])
        >>> cells.areas
        array([6., 6.])
        """
        return pieces(self.delaunay, mesh_of(region))

    def plot(
        self,
        ax: Optional[matplotlib.axes.Axes] = None,
        bounds: Optional[Bounds] = None,
        **style: Any,
    ) -> matplotlib.collections.LineCollection:
        """Draws the edges of the cells, each once, clipped to a box.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw. Without it, on the current axes, whose aspect becomes equal.
        bounds : (xmin, ymin, xmax, ymax), optional
            The box. Without it, that of the points with a margin of a tenth.
        **style
            As `matplotlib.collections.LineCollection` takes it, such as ``color`` and ``linewidth``.

        Returns
        -------
        matplotlib.collections.LineCollection
            The parts of the edges that lie in the box.

        Raises
        ------
        UsageError
            For bounds that are none.
        ImportError
            Without Matplotlib.

        Examples
        --------
        >>> import flaunay, matplotlib
        >>> matplotlib.use("Agg")
        >>> vor = flaunay.Voronoi([[0, 0], [2, 0], [0, 2]])
        >>> lines = vor.plot(bounds=(0, 0, 2, 2))
        >>> [line.tolist() for line in lines.get_segments()]
        [[[1.0, 1.0], [2.0, 2.0]], [[1.0, 1.0], [0.0, 1.0]], [[1.0, 1.0], [1.0, 0.0]]]
        """
        ridges = (self.vertices, self.ridge_points, self.ridge_vertices)
        return draw_voronoi(self.points, self.delaunay.hull, *ridges, ax, bounds, style)

    def close(self) -> None:
        """Ends an incremental diagram: its arrays stay. Gives back what queries hold in device memory."""
        self.delaunay.close()

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Adds points to an incremental diagram, as `Delaunay.add_points` does.

        The triangulation is mended; the diagram is computed anew, in O(n) work.
        """
        self.delaunay.add_points(points, restart)
        self._compute()


def _merge_cells(
    vertices: npt.NDArray[np.intp],
    offsets: Indices,
    cells: Indices,
    unbounded: npt.NDArray[np.bool_],
) -> tuple[Indices, Indices]:
    """Offsets and cells, with their vertices replaced by others, without those that follow themselves."""
    merged = vertices[cells]
    sizes = np.diff(offsets)
    cell = np.repeat(np.arange(len(sizes)), sizes)
    previous = np.arange(len(cells)) - 1
    first = offsets[:-1][sizes > 0]
    previous[first] = offsets[1:][sizes > 0] - 1
    is_first = np.zeros(len(cells), bool)
    is_first[first] = True
    # The first vertex of an unbounded cell follows none.
    kept = (merged != merged[previous]) | (is_first & unbounded[cell])
    counts = np.bincount(cell[kept], minlength=len(sizes))
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32), merged[kept].astype(np.int32)
