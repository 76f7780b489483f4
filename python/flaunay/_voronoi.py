"""The Voronoi diagram with the names of SciPy."""

from __future__ import annotations

from functools import cached_property
from typing import Optional

import numpy as np
import numpy.typing as npt

from flaunay import _flaunay, _triangulators
from flaunay._arrays import FloatArray, summary
from flaunay._delaunay import Delaunay
from flaunay._plot import VoronoiPlots

Indices = npt.NDArray[np.int32]


class Voronoi(VoronoiPlots):
    """The Voronoi diagram of points in the plane, with the attributes of SciPy's.

    It has a vertex for each Delaunay triangle. Where more than three points are cocircular, vertices
    coincide, and the ridges between them have no length; SciPy has one vertex there.

    Parameters
    ----------
    points : array_like, shape (npoints, 2)
        As of `Delaunay`.
    device : str, optional
        As of `triangulate`.

    Attributes
    ----------
    delaunay : Delaunay
        The triangulation whose dual it is.
    points : ndarray of float64 or float32, shape (npoints, 2)
        The coordinates.
    vertices : ndarray of float64, shape (nsimplex, 2)
        The circumcentres of the triangles, rounded. What is adjacent does not depend on rounding.
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
    """

    ndim = 2
    furthest_site = False

    def __init__(self, points: npt.ArrayLike, device: Optional[str] = None) -> None:
        self.delaunay = tri = Delaunay(points, device=device)
        self.points: FloatArray = tri.points
        self.vertices, self.cell_offsets, self.cells, unbounded = _flaunay.voronoi(
            _triangulators.of_device(device),
            np.asarray(tri.points, np.float64),
            tri.simplices,
            tri.neighbors,
            tri.hull,
            tri.representatives,
        )
        self.unbounded: npt.NDArray[np.bool_] = unbounded.view(np.bool_)

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
        # Of two triangles the one of the larger index has the edge; -1 is the smallest.
        triangle, corner = np.nonzero(neighbors < np.arange(len(corners))[:, None])
        ends = [corners[triangle, (corner + k) % 3] for k in (1, 2)]
        sides = [neighbors[triangle, corner], triangle.astype(np.int32)]
        return np.stack(ends, axis=1), np.stack(sides, axis=1)

    @property
    def ridge_points(self) -> Indices:
        """The two points that each ridge lies between, int32, shape (nridges, 2)."""
        return self._ridges[0]

    @property
    def ridge_vertices(self) -> Indices:
        """The two vertices of each ridge, int32, shape (nridges, 2); the first is -1 at infinity."""
        return self._ridges[1]

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
        """For each point its place in `regions`, shape (npoints,); -1 if it has no cell."""
        has_cell = np.diff(self.cell_offsets) > 0
        return np.where(has_cell, np.arange(self.npoints), -1)
