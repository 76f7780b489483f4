"""The convex hull with the names of SciPy."""

from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import ArrayLike, FloatArray, Frozen, frozen, summary
from flaunay._delaunay import Delaunay
from flaunay._errors import UsageError

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]


def _corners(points: FloatArray, hull: Indices) -> Indices:
    """The points of a hull without those on its edges, exactly; of points on one line the two ends."""
    triples = np.stack([np.roll(hull, 1), hull, np.roll(hull, -1)], axis=1)
    is_corner: npt.NDArray[np.bool_] = _calls.turns(points, triples) != 0
    if not is_corner.any():
        is_corner[[0, -1][: len(hull)]] = True
    return hull[is_corner]


class ConvexHull(Frozen):
    """The convex hull of points in the plane, with the attributes of SciPy's. All arrays are read-only.

    Parameters
    ----------
    points : array_like, shape (npoints, 2)
        As of `Delaunay`.
    incremental : bool
        Whether points can be added, by `add_points`.
    qhull_options : str, optional
        As of `Delaunay`; Qc and QJ are errors, as they change the hull of Qhull.

    Attributes
    ----------
    points : ndarray of float64 or float32, shape (npoints, 2)
        The coordinates.
    vertices : ndarray of int32, shape (nvertices,)
        The corners, counter-clockwise from the lexicographically smallest point: exactly those points that are
        in no edge between others, of equal ones the one with the smallest index. Two for points on one line;
        SciPy raises an exception for them.
    simplices : ndarray of int32, shape (nsimplex, 2)
        The edges, counter-clockwise. Points on one line have two, there and back; equal points have none.
    neighbors : ndarray of int32, shape (nsimplex, 2)
        ``neighbors[i, k]`` is the edge at the other end than point k of edge i.
    equations : ndarray of float64, shape (nsimplex, 3)
        The unit normals of the edges, outwards, and offsets: negative inside.
    area, volume : float
        As SciPy has them: the perimeter and the area.
    good : None
        As in SciPy, without options for it.
    npoints, nsimplex, ndim : int
        Numbers of points, of edges and of dimensions, which are 2.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`.

    Notes
    -----
    It is that of the Delaunay triangulation: O(n log n) work.

    Examples
    --------
    >>> import flaunay
    >>> hull = flaunay.ConvexHull([[0, 0], [4, 0], [2, 0], [4, 3], [3, 1]])
    >>> hull.vertices
    array([0, 1, 3], dtype=int32)
    >>> hull.volume, hull.area
    (6.0, 12.0)
    """

    ndim = 2
    good = None

    def __init__(
        self, points: ArrayLike, incremental: bool = False, qhull_options: Optional[str] = None
    ) -> None:
        if isinstance(qhull_options, str):
            for option in qhull_options.split():
                if option == "Qc" or option.startswith("QJ"):
                    raise UsageError(
                        f"Qhull's option {option} is not possible for a hull, which is exact: "
                        "leave it out"
                    )
        self._tri = Delaunay(points, False, incremental, qhull_options)
        self._compute()

    def _compute(self) -> None:
        self.points: FloatArray = self._tri.points
        points = np.asarray(self.points, np.float64)
        vertices = _corners(self.points, self._tri.hull)
        edges = np.stack([vertices, np.roll(vertices, -1)], axis=1)
        if len(vertices) == 1:
            edges = edges[:0]
        self.vertices: Indices = frozen(vertices)
        self.simplices: Indices = frozen(edges)
        around = np.arange(len(edges), dtype=np.int32)
        self.neighbors: Indices = frozen(
            np.stack([np.roll(around, -1), np.roll(around, 1)], axis=1)
        )
        ends = points[edges]
        along = ends[:, 1] - ends[:, 0]
        lengths = np.hypot(along[:, 0], along[:, 1])
        normals = np.stack([along[:, 1], -along[:, 0]], axis=1) / lengths[:, None]
        offsets = -(normals * ends[:, 0]).sum(axis=1)
        self.equations: Doubles = frozen(np.column_stack([normals, offsets]))
        self.area: float = float(lengths.sum())
        # From a corner, so that little cancels, and scaled, so that products neither overflow nor vanish.
        away = ends - ends[:1, :1]
        size = float(np.abs(away).max(initial=0)) or 1.0
        x, y = (away / size).transpose(2, 0, 1)
        self.volume: float = float((x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]).sum() / 2) * size * size

    def __repr__(self) -> str:
        return summary(self, points=self.npoints, vertices=len(self.vertices))

    @property
    def npoints(self) -> int:
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        return len(self.simplices)

    @property
    def min_bound(self) -> FloatArray:
        """The smallest coordinates, shape (2,); NaN if there are no points."""
        return self._tri.min_bound

    @property
    def max_bound(self) -> FloatArray:
        """The largest coordinates, shape (2,); NaN if there are no points."""
        return self._tri.max_bound

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Adds points to an incremental hull, as `Delaunay.add_points` does, whose errors it has."""
        self._tri.add_points(points, restart)
        self._compute()

    def close(self) -> None:
        """Ends an incremental hull: its arrays stay."""
        self._tri.close()
