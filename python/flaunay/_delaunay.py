"""The Delaunay triangulation with the names of SciPy."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NoReturn, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _graphs, _scipy, _triangulators
from flaunay._arrays import (
    ArrayLike,
    FloatArray,
    Frozen,
    as_floats,
    as_points,
    check_out,
    frozen,
    summary,
)
from flaunay._border import Border, ConvexBorder, LineBorder
from flaunay._dynamic import Changes, DynamicTriangulation, TriangleRows
from flaunay._errors import InputError, UsageError
from flaunay._export import ExportMethods
from flaunay._graphs import GraphMethods
from flaunay._plot import draw_edges
from flaunay._queries import KeptLocator, Queries, as_queries
from flaunay._raster import MapMethods
from flaunay._refinement import Refining
from flaunay._triangulation import Triangulation, arrays_of_mesh

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.collections
    import scipy.spatial

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]


def _check_points(indices: Indices, n: int, name: str) -> None:
    """UsageError unless there are n, each the index of one of n points."""
    if indices.shape != (n,):
        raise UsageError(f"{name} must have the shape ({n},), not {indices.shape}")
    wrong = np.flatnonzero((indices < 0) | (indices >= n))
    if wrong.size:
        raise UsageError(f"{name} were changed: {indices[wrong[0]]} is none of the {n} points")


class Delaunay(Queries, GraphMethods, ExportMethods, MapMethods, Frozen):
    """The Delaunay triangulation of points in the plane, with the attributes of SciPy's.

    `scipy.spatial.Delaunay` can be replaced by it, in two dimensions; where both give an answer, this one
    is exact. All arrays are read-only, so that no change of them can make later queries wrong; take
    copies to change them.

    Parameters
    ----------
    points : array_like, shape (npoints, 2)
        Coordinates, which are copied. float64 and float32 are taken as they are; other numbers become
        float64, and must be one exactly.
    furthest_site : bool
        As SciPy has it: only False is possible.
    incremental : bool
        Whether points can be added, removed and moved later on, by `add_points`, `remove_points` and
        `move_points`. Arrays are then those after the last change, and float64.
    qhull_options : str, optional
        As SciPy has them. Those that are about precision, output and how Qhull works change nothing;
        QJ is an error unless every point is a vertex, which it asks for of those given here; others are
        an error.
    mode, device : str, optional
        As of `triangulate`.

    Attributes
    ----------
    points : ndarray of float64 or float32, shape (npoints, 2)
        The coordinates; NaN for points that were removed, whose indices are not used again.
    simplices : ndarray of int32, shape (nsimplex, 3)
        Three points each, counter-clockwise, the smallest index first. Fewer than three distinct
        points, and points on one line, have none; SciPy raises an exception for them.
    neighbors : ndarray of int32, shape (nsimplex, 3)
        ``neighbors[i, k]`` is the simplex opposite to corner k of simplex i, -1 beyond the hull.
    hull : ndarray of int32, shape (nhull,)
        The convex hull with the points on its edges, counter-clockwise from the lexicographically
        smallest point. Of collinear points all distinct ones, in lexicographic order.
    representatives : ndarray of int32, shape (npoints,)
        For each point the smallest index of an equal point. Only those are in `simplices`. -1 for points
        that were removed.
    npoints, nsimplex, ndim : int
        Numbers of points, of simplices and of dimensions, which are 2.

    Raises
    ------
    UsageError
        For a wrong shape, another number of dimensions than two, and what is no number. It is a
        ValueError, as SciPy raises.
    InputError
        For a point that is not finite, magnitudes too different to be exact, or too many points. It
        is a ValueError too.
    DeviceError
        If there is no such device, or a call of OpenCL failed.

    Notes
    -----
    O(n log n) work. What else the class offers is computed when it is first asked for.

    Examples
    --------
    >>> import flaunay
    >>> tri = flaunay.Delaunay([[0, 0], [0, 1.1], [1, 0], [1, 1]])
    >>> tri.simplices
    array([[0, 3, 1],
           [0, 2, 3]], dtype=int32)
    >>> tri.neighbors[0]  # opposite to its corners 0, 3 and 1
    array([-1, -1,  1], dtype=int32)
    """

    ndim = 2
    furthest_site = False

    # Its edges, and what is computed of triangles.
    edges: cached_property[Indices] = cached_property(_graphs.edges)
    edge_lengths: cached_property[Doubles] = cached_property(_graphs.edge_lengths)
    edge_simplices: cached_property[Indices] = cached_property(_graphs.edge_simplices)
    _edge_order: cached_property[tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]] = (
        cached_property(_graphs.edge_order)
    )
    is_gabriel: cached_property[npt.NDArray[np.bool_]] = cached_property(_graphs.is_gabriel)
    vertex_neighbor_vertices: cached_property[tuple[Indices, Indices]] = cached_property(
        _graphs.vertex_neighbor_vertices
    )
    spanning_tree: cached_property[Indices] = cached_property(_graphs.spanning_tree)
    areas: cached_property[Doubles] = cached_property(_graphs.areas)
    centroids: cached_property[Doubles] = cached_property(_graphs.centroids)
    circumradii: cached_property[Doubles] = cached_property(_graphs.circumradii)

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: Optional[str] = None,
        *,
        mode: str = "blocks",
        device: Optional[str] = None,
        **others: NoReturn,
    ) -> None:
        for name in others:
            hint = "; flaunay.refine adds points until angles and areas are as asked for"
            raise TypeError(
                f"Delaunay has no argument {name!r}" + hint * (name in Refining.__annotations__)
            )
        all_must_be_vertices = _scipy.check_options(furthest_site, qhull_options)
        self._device = device
        self._living: Optional[DynamicTriangulation] = None
        self._kept_locator = KeptLocator()
        if incremental:
            if mode != "blocks":
                raise UsageError(f"mode {mode!r} cannot be incremental; mode 'blocks' can")
            self._living = DynamicTriangulation(as_points(points), device=device)
        else:
            copy = as_points(points).copy()
            mesh = arrays_of_mesh(copy, None, {"neighbors"}, device, mode)
            self.points = frozen(copy)  # which would take longer to hand over
            self.simplices = frozen(mesh["triangles"])
            self.neighbors = frozen(mesh["neighbors"])
            self.hull = frozen(mesh["hull"])
            self.representatives = frozen(mesh["representatives"])
        if all_must_be_vertices:
            _scipy.check_all_are_vertices(self)

    def __repr__(self) -> str:
        return summary(
            self, points=self.npoints, triangles=self.nsimplex, hull_vertices=len(self.hull)
        )

    # Arrays of a triangulation that changes are read when they are asked for after a change.

    def _dynamic(self) -> DynamicTriangulation:
        if self._living is None:
            raise UsageError(
                "points cannot be added, removed or moved: the triangulation is not incremental, was "
                "closed, or is a copy; make another one with incremental=True"
            )
        return self._living

    @cached_property
    def _arrays(self) -> Triangulation:
        return self._dynamic().triangulation()

    @cached_property
    def points(self) -> FloatArray:
        return frozen(self._dynamic().points)

    @cached_property
    def simplices(self) -> Indices:
        return frozen(self._arrays.triangles)

    @cached_property
    def neighbors(self) -> Indices:
        beyond = self._arrays.neighbors
        assert beyond is not None
        return frozen(beyond)

    @cached_property
    def hull(self) -> Indices:
        return frozen(self._arrays.hull)

    @cached_property
    def representatives(self) -> Indices:
        return frozen(self._arrays.representatives)

    @property
    def npoints(self) -> int:
        return len(self.points) if self._living is None else self._living.numbers

    @property
    def nsimplex(self) -> int:
        return len(self.simplices) if self._living is None else self._living.triangle_count

    @property
    def _removed(self) -> npt.NDArray[np.bool_]:
        removed: npt.NDArray[np.bool_] = np.isnan(self.points[:, 0])
        return removed

    @property
    def _stand_ins(self) -> tuple[FloatArray, Indices]:
        """Points and representatives for what knows no removed points: they are like one that is there."""
        removed = self._removed
        if not removed.any():
            return self.points, self.representatives
        first = int(np.argmin(removed))
        place = 0 if removed[first] else self.points[first]
        points: FloatArray = np.where(removed[:, None], place, self.points)
        return points, np.where(removed, first, self.representatives).astype(np.int32)

    @cached_property
    def min_bound(self) -> FloatArray:
        """The smallest coordinates, shape (2,); NaN if there are no points."""
        return self._bound(np.min)

    @cached_property
    def max_bound(self) -> FloatArray:
        """The largest coordinates, shape (2,); NaN if there are no points."""
        return self._bound(np.max)

    def _bound(self, choose: Callable[..., FloatArray]) -> FloatArray:
        there = self.points[~self._removed]
        bound: FloatArray = choose(there, axis=0) if len(there) else np.full(2, np.nan)
        return frozen(bound)

    @cached_property
    def convex_hull(self) -> Indices:
        """The edges of the hull, int32, shape (nhull, 2).

        Counter-clockwise, as `hull` has their first points. Those of points on one line are none.
        """
        if self.nsimplex == 0:
            return frozen(np.empty((0, 2), np.int32))
        edges: Indices = np.stack([self.hull, np.roll(self.hull, -1)], axis=1)
        return frozen(edges)

    @cached_property
    def coplanar(self) -> Indices:
        """Points that are not in the triangulation, as another has the same place; int32, shape (k, 3).

        In each row the point, a simplex that has the equal point (-1 if none has), and the equal
        point. SciPy lists these points likewise, and can list further ones, which it lost.
        """
        _, equal_points = self._stand_ins
        _check_points(equal_points, self.npoints, "representatives")
        points = np.flatnonzero((equal_points != np.arange(self.npoints)) & ~self._removed)
        equal = equal_points[points]
        simplices = _calls.first_triangles(self.simplices, self.npoints)[equal]
        rows: Indices = np.stack([points, simplices, equal], axis=1).astype(np.int32)
        return frozen(rows)

    @cached_property
    def vertex_to_simplex(self) -> Indices:
        """For each point a simplex that has it, int32, shape (npoints,).

        Of several the one of the smallest index. For a point that another represents, the other's; -1
        if there are no simplices, and for a point that was removed.
        """
        _, equal_points = self._stand_ins
        _check_points(equal_points, self.npoints, "representatives")
        simplices = _calls.first_triangles(self.simplices, self.npoints)[equal_points]
        simplices[self._removed] = -1
        return frozen(simplices)

    def _doubles(self) -> Doubles:
        return np.asarray(self._stand_ins[0], np.float64)

    @cached_property
    def transform(self) -> Doubles:
        """Affine transforms to barycentric coordinates, float64, shape (nsimplex, 3, 2), as SciPy has them.

        The first two coordinates of a point x in simplex i are
        ``transform[i, :2] @ (x - transform[i, 2])``, and the third is what they lack to 1. NaN for a
        simplex that is so thin that floating point cannot say; `find_simplex` and `interpolate` are
        exact for those too.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.transform[0, :2] @ ([1, 1] - tri.transform[0, 2])
        array([0.5 , 0.25])
        """
        return frozen(_scipy.barycentric_transforms(self._doubles(), self.simplices))

    @cached_property
    def _paraboloid(self) -> tuple[float, float]:
        return _scipy.paraboloid(self._doubles())

    @property
    def paraboloid_scale(self) -> float:
        """The scale of the paraboloid to which `lift_points` lifts: SciPy's for its default options."""
        return self._paraboloid[0]

    @property
    def paraboloid_shift(self) -> float:
        """The shift of the paraboloid to which `lift_points` lifts: SciPy's for its default options."""
        return self._paraboloid[1]

    @cached_property
    def equations(self) -> Doubles:
        """The planes of the simplices on the paraboloid, float64, shape (nsimplex, 4).

        Of each its unit normal, which points down, and its offset.
        """
        equations = _scipy.plane_equations(self._doubles(), self.simplices, *self._paraboloid)
        return frozen(equations)

    @cached_property
    def good(self) -> Indices:
        """1 for each simplex, int32, shape (nsimplex,): without options of Qhull, SciPy finds all of them good."""
        return frozen(np.ones(self.nsimplex, np.int32))

    def lift_points(self, x: ArrayLike) -> Doubles:
        """Lifts points of shape (..., 2) to the paraboloid, shape (..., 3), as SciPy does.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [10, 0], [0, 10]])
        >>> tri.lift_points([[0, 11]]).round(12)
        array([[ 0., 11., 11.]])
        """
        points, shape = as_queries(x)
        return _scipy.lifted(points, *self._paraboloid).reshape(*shape, 3)

    def plane_distance(self, xi: ArrayLike) -> Doubles:
        """Distances of lifted points of shape (..., 2) to the planes of all simplices, shape (..., nsimplex).

        Positive for the simplices whose circumcircles have the point inside.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.plane_distance([[1, 1], [5, 5]]) > 0
        array([[ True],
               [False]])
        """
        points, shape = as_queries(xi)
        heights = _scipy.lifted(points, *self._paraboloid) @ self.equations[:, :3].T
        distances: Doubles = heights + self.equations[:, 3]
        return distances.reshape(*shape, self.nsimplex)

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
        return draw_edges(self.points, self.edges, ax, style)

    def verify(self) -> None:
        """Checks exactly that this is the canonical Delaunay triangulation of its points.

        The check shares no predicate with what makes triangulations. O(n log n), on one thread.

        Raises
        ------
        InternalError
            If it is not; the message says what is wrong.
        """
        kept = ~self._removed
        numbers = np.cumsum(kept, dtype=np.int32) - np.int32(1)
        arrays = {
            "triangles": numbers[self.simplices],
            "neighbors": self.neighbors,
            "hull": numbers[self.hull],
            "representatives": numbers[self.representatives[kept]],
            "triangle_offsets": np.array([0, len(self.simplices)]),
            "hull_offsets": np.array([0, len(self.hull)]),
        }
        _calls.verify(np.asarray(self.points[kept], np.float64), None, arrays)

    def close(self) -> None:
        """Ends an incremental triangulation: its arrays stay, but its points cannot change any more.

        Gives back what queries hold in device memory; the next query makes it again.
        """
        self._settle()
        self._living = None
        self._kept_locator.drop()

    def _settle(self) -> None:
        """Reads what would need the living triangulation later on."""
        for name in ("points", "simplices", "neighbors", "hull", "representatives"):
            getattr(self, name)
        self.__dict__.pop("_arrays", None)

    def _forget(self) -> None:
        """Drops what was computed before a change."""
        for name in list(self.__dict__):
            if isinstance(getattr(type(self), name, None), cached_property):
                del self.__dict__[name]
        self._kept_locator.drop()

    def add_points(self, points: ArrayLike, restart: bool = False) -> Optional[Changes]:
        """Adds points to an incremental triangulation, as SciPy does.

        Parameters
        ----------
        points : array_like, shape (m, 2)
            They have the next indices.
        restart : bool
            Whether to triangulate all points anew. The simplices are the same ones, in another order. Points
            that were removed have no indices then.

        Returns
        -------
        Changes, or None with `restart`
            In terms of `rows`.

        Raises
        ------
        UsageError
            Without `incremental`, and after `close`. It is a RuntimeError, as SciPy raises.
        UsageError, InputError
            For points as in a new triangulation. Nothing is changed then.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]], incremental=True)
        >>> changes = tri.add_points([[1, 1], [4, 4]])
        >>> len(tri.points), len(tri.simplices)
        (5, 4)
        >>> changes = tri.remove_points([0])
        >>> changes = tri.move_points([3], [[3, 3]])
        >>> sorted(tri.simplices.tolist())
        [[1, 3, 2], [1, 4, 3], [2, 3, 4]]
        """
        living, given = self._dynamic(), as_points(points)
        if restart:
            there = self.points[~self._removed]
            self._living = DynamicTriangulation(
                np.concatenate([there, given]), device=self._device
            )
            changes = None
        else:
            changes = living.insert(given)
        self._forget()
        return changes

    def remove_points(self, indices: npt.ArrayLike) -> Changes:
        """Removes points of an incremental triangulation, by their indices, shape (m,).

        The indices of others stay the same: `points` has NaN for those that were removed.

        Returns
        -------
        Changes
            In terms of `rows`.

        Raises
        ------
        UsageError
            As of `add_points`.
        InputError
            For an index that no point has, or that is there twice. Nothing is changed then.
        """
        changes = self._dynamic().remove(indices)
        self._forget()
        return changes

    def move_points(self, indices: npt.ArrayLike, points: ArrayLike) -> Changes:
        """Moves points of an incremental triangulation, all at once.

        Parameters
        ----------
        indices : array_like of int, shape (m,)
            Which points.
        points : array_like, shape (m, 2)
            Their new places.

        Returns
        -------
        Changes
            In terms of `rows`.

        Raises
        ------
        UsageError, InputError
            As of `add_points` and `remove_points`.
        """
        changes = self._dynamic().move(indices, points)
        self._forget()
        return changes

    def rows(self) -> TriangleRows:
        """The triangles of an incremental triangulation by their rows, which `Changes` mean.

        `simplices` has those of the rows that have one, in their order.

        Raises
        ------
        UsageError
            As of `add_points`.
        """
        return self._dynamic().rows()

    def to_scipy(self) -> scipy.spatial.Delaunay:
        """The same triangulation as a `scipy.spatial.Delaunay`, without a run of Qhull.

        For what wants one, such as `scipy.interpolate.LinearNDInterpolator`. Its arrays are copies.

        Raises
        ------
        UsageError
            If there are no simplices: SciPy has no such triangulations.
        ImportError
            If there is no SciPy.

        Examples
        --------
        >>> import flaunay
        >>> import scipy.interpolate
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> scipy.interpolate.LinearNDInterpolator(tri.to_scipy(), [0, 8, 4])(1, 1)
        array(3.)
        """
        return _scipy.to_scipy(self)

    @property
    def _locator(self) -> _calls.Locator:
        return self._kept_locator.get(self._make_locator)

    def _make_locator(self) -> _calls.Locator:
        return _calls.Locator(_triangulators.of_device(self._device), self)

    def __getstate__(self) -> dict[str, Any]:
        # The living mesh is the object's own, and what is in device memory is made again where it is needed.
        self._settle()
        return {**self.__dict__, "_living": None, "_kept_locator": KeptLocator()}

    @cached_property
    def circumcenters(self) -> Doubles:
        """The centre of the circle through each simplex's corners, float64, shape (nsimplex, 2).

        As `Voronoi.vertices`: of a slender simplex a rounding error can move it far.

        Examples
        --------
        >>> import flaunay
        >>> flaunay.Delaunay([[0, 0], [4, 0], [0, 2]]).circumcenters
        array([[2., 1.]])
        """
        diagram = _calls.voronoi(_triangulators.of_device(self._device), self)
        return frozen(np.array(diagram["circumcentres"]))

    @cached_property
    def _border(self) -> Border:
        if self.nsimplex == 0:
            return LineBorder(self.points, self.hull)
        return ConvexBorder(self.points, self.simplices, self.neighbors, self.hull)

    def _near_hull(self, outside: Doubles, tol: float) -> Indices:
        return _scipy.simplices_near_hull(self, outside, tol)
