"""Points on a sphere: their Delaunay triangulation, Voronoi cells, and queries."""

from __future__ import annotations

import operator
from functools import cached_property
from typing import Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import ArrayLike, as_distance, as_floats, as_number, as_offsets, frozen, hint_for, summary
from flaunay._errors import InputError, UsageError
from flaunay._surface_edges import WithEdges, angles_between
from flaunay._surfaces import Doubles, Indices

# How near to the centre a triangle or an edge counts as having it.
_ROUNDING = 2.0**-49


def _as_points(given: ArrayLike, name: str = "xi") -> Doubles:
    points = np.asarray(as_floats(given, name), np.float64)
    if points.ndim == 0 or points.shape[-1] not in (2, 3):
        raise UsageError(
            f"{name} must be longitudes and latitudes, shape (..., 2), or x, y and z, "
            f"shape (..., 3), not {points.shape}{hint_for(points.shape, name)}"
        )
    return points


def as_rows(given: ArrayLike) -> Doubles:
    """Points in rows."""
    points = _as_points(given, "points")
    if points.ndim != 2:
        raise UsageError(f"points must have the shape (n, 2) or (n, 3), not {points.shape}")
    return points


class SphericalVoronoi:
    """The Voronoi cells of points on a sphere, with the names of SciPy's class.

    `SphericalDelaunay.voronoi` has them for the unit sphere.

    Parameters
    ----------
    points : array_like, shape (npoints, 3)
        Points on the sphere.
    radius : float
        The sphere's radius.
    center : array_like, shape (3,), optional
        The sphere's centre; None: the origin.
    threshold : float
        How far points may be from the sphere, relative to its radius.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, 3)
        The points as they were given, or of `SphericalDelaunay.voronoi` the unit vectors.
    radius, center
        Of the sphere.
    vertices : ndarray of float64, shape (nsimplex, 3)
        For each simplex the centre of the empty cap whose rim passes through its corners, rounded. Where
        more than three points are cocircular, centres coincide.
    cell_offsets : ndarray of int32, shape (npoints + 1,)
        The cell of point i has the corners ``cells[cell_offsets[i]:cell_offsets[i + 1]]``.
    cells : ndarray of int32, shape (3 * nsimplex,)
        The vertices of cells, counter-clockwise as seen from outside. Points that another one represents
        have none, nor has a set of one or two points.
    areas : ndarray of float64, shape (npoints,)
        The areas of cells. Those of a set sum to 4 pi on the unit sphere. Rounded by some 1e-15, and if all
        points are within an angle r, by that divided by the square of r.

    Raises
    ------
    UsageError
        For a wrong shape, a radius that is not a number above 0, a threshold that is not one of 0 or more, and points
        that are not on the sphere.
    InputError
        For a point or a center that is not finite.

    Notes
    -----
    SciPy raises an exception for points that are equal, and points in a plane through the centre; here the first
    of equal ones has the cell. O(n log n) work.

    Examples
    --------
    >>> import flaunay
    >>> octahedron = [[2, 0, 0], [0, 2, 0], [-2, 0, 0], [0, -2, 0], [0, 0, 2], [0, 0, -2]]
    >>> cells = flaunay.SphericalVoronoi(octahedron, radius=2)
    >>> (cells.calculate_areas() * 6 / 3.141592653589793).round(9).tolist()
    [16.0, 16.0, 16.0, 16.0, 16.0, 16.0]
    """

    points: Doubles
    radius: float
    center: Doubles

    def __init__(
        self,
        points: ArrayLike,
        radius: float = 1.0,
        center: Optional[ArrayLike] = None,
        threshold: float = 1e-6,
    ) -> None:
        given = np.array(as_floats(points, "points"), np.float64)
        middle = np.zeros(3)
        if center is not None:
            middle = np.array(as_floats(center, "center"), np.float64)
        if given.ndim != 2 or given.shape[1] != 3 or middle.shape != (3,):
            raise UsageError(
                "points must have the shape (n, 3) and center (3,), "
                f"not {given.shape} and {middle.shape}"
            )
        if not np.isfinite(middle).all():
            raise InputError(f"center is not finite: {middle.tolist()}")
        radius = as_number(radius, "radius")
        if not 0 < radius < np.inf:
            raise UsageError(f"radius must be a number above 0, not {radius!r}")
        threshold = as_distance(threshold, "threshold")
        away = (given - middle) / radius
        off = np.flatnonzero(np.abs(np.linalg.norm(away, axis=1) - 1) >= threshold)
        if len(off):
            raise UsageError(
                f"point {off[0]} is not on the sphere of this radius and center; threshold allows more"
            )
        tri = SphericalDelaunay(frozen(away), None, None)
        self._set(tri, frozen(given), radius, frozen(middle))

    def _set(self, tri: SphericalDelaunay, points: Doubles, radius: float, center: Doubles) -> None:
        arrays = tri._handle.voronoi(tri._triangulator)
        self.points, self.radius, self.center = points, radius, center
        self._tri, self._directions = tri, frozen(arrays["vertices"])
        self.vertices: Doubles = frozen(self._to_sphere(self._directions))
        self.cell_offsets: Indices = frozen(arrays["cell_offsets"])
        self.cells: Indices = frozen(arrays["cells"])
        with np.errstate(over="ignore"):
            self.areas: Doubles = frozen(arrays["areas"] * np.square(radius))

    @classmethod
    def _of(cls, tri: SphericalDelaunay) -> SphericalVoronoi:
        cells = cls.__new__(cls)
        cells._set(tri, tri.xyz, 1.0, frozen(np.zeros(3)))
        return cells

    def _to_sphere(self, directions: Doubles) -> Doubles:
        if self.radius == 1 and not self.center.any():
            return directions
        places: Doubles = directions * self.radius + self.center
        return places

    def calculate_areas(self) -> Doubles:
        """`areas`, as SciPy's method computes them."""
        return self.areas

    def sort_vertices_of_regions(self) -> None:
        """Does nothing: vertices are always in order. SciPy's class has this method."""

    def __repr__(self) -> str:
        return summary(self, points=len(self.areas), vertices=len(self.vertices))

    @cached_property
    def regions(self) -> list[list[int]]:
        """For each point the vertices of its cell, counter-clockwise, as lists."""
        ends = self.cell_offsets.tolist()
        return [self.cells[first:last].tolist() for first, last in zip(ends, ends[1:])]

    def polygon(self, i: int) -> Doubles:
        """The corners of cell i, counter-clockwise as seen from outside, shape (k, 3), to be drawn.

        Corners that coincide are one. A side of more than 120 degrees has a corner in its middle, too: the cells
        of points on one great circle, such as the equator, are lunes from pole to pole, which two corners could
        not say, and of two points each has a hemisphere with four corners. Empty for a point that another one
        represents, and for a point alone, whose cell is the sphere. IndexError for one that does not exist;
        negative numbers count from the end.

        Examples
        --------
        >>> import flaunay
        >>> cells = flaunay.spherical([[0, 0], [90, 0], [180, 0], [270, 0]]).voronoi
        >>> len(cells.polygon(0))
        4
        """
        n, i = len(self.areas), operator.index(i)
        if not -n <= i < n:
            raise IndexError(f"cell {i} of {n}")
        i %= n
        triangles = self.cells[self.cell_offsets[i] : self.cell_offsets[i + 1]]
        if len(triangles) == 0:
            return self._to_sphere(self._hemisphere(i))
        corners, xyz = self._tri.simplices[triangles], self._tri.xyz
        polygon: list[Doubles] = []
        # The side to the next triangle is between the point and the corner before it.
        before = corners[np.arange(len(corners)), (np.argmax(corners == i, axis=1) + 2) % 3]
        for t, following, other in zip(triangles, np.roll(triangles, -1), before):
            begin, end = self._directions[t], self._directions[following]
            if np.abs(end - begin).max() <= 2.0**-50:
                continue
            polygon.append(begin)
            if begin @ end < -0.5:
                low, high, start = (i, other, begin) if i < other else (other, i, end)
                middle = np.cross(start, xyz[high] - xyz[low])
                polygon.append(middle / np.linalg.norm(middle))
        return self._to_sphere(np.array(polygon).reshape(-1, 3))

    def _hemisphere(self, i: int) -> Doubles:
        """The polygon of one of two points; empty for others without corners."""
        tri, offsets = self._tri, self._tri._given[1]
        ends = np.array([0, len(self.areas)]) if offsets is None else offsets
        first, last = ends[np.searchsorted(ends, i, "right") - 1 :][:2]
        others = first + np.flatnonzero(tri.representatives[first:last] != tri.representatives[i])
        if self.areas[i] == 0 or len(others) == 0:
            return np.empty((0, 3))
        low, high = sorted((i, int(others[0])))
        axis = tri.xyz[low] - tri.xyz[high]
        across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        sides = np.array([across, np.cross(axis, across)])
        sides /= np.linalg.norm(sides, axis=1, keepdims=True)
        circle: Doubles = np.concatenate([sides, -sides])
        return circle if i == low else circle[::-1].copy()


class SphericalDelaunay(WithEdges):
    """Delaunay triangulations of points on the unit sphere: their convex hulls. `spherical` makes them.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, 2) or (npoints, 3)
        The points as they were given.
    xyz : ndarray of float64, shape (npoints, 3)
        Their unit vectors, rounded.
    places : ndarray of float64, shape (npoints, 2)
        Where the line from the south pole through a point meets the plane of the equator; infinite for the
        south pole. Rounded once: this is what the point is, and it lies on the sphere exactly.
    simplices : ndarray of int32, shape (nsimplex, 3)
        The corners of triangles, counter-clockwise as seen from outside; 2 n - 4 for each set of n > 2
        different points.
    neighbors : ndarray of int32, shape (nsimplex, 3)
        The triangle opposite to each corner. There is always one.
    representatives : ndarray of int32, shape (npoints,)
        The smallest index of a point of the set with the same place.
    simplex_offsets : ndarray of int64, shape (nsets + 1,)
        Set s has the triangles ``simplices[simplex_offsets[s]:simplex_offsets[s + 1]]``.
    """

    def __init__(
        self,
        points: Doubles,
        offsets: Optional[npt.NDArray[np.int64]],
        device: Optional[str],
    ) -> None:
        super().__init__((points, offsets, device), _calls.sphere(points.shape[1]), offsets)

    @cached_property
    def xyz(self) -> Doubles:
        """The points' unit vectors, rounded."""
        return frozen(_calls.directions_of(self.places))

    @cached_property
    def voronoi(self) -> SphericalVoronoi:
        """The Voronoi cells, computed when they are first asked for.

        Examples
        --------
        >>> import flaunay
        >>> octahedron = [[0, 0], [90, 0], [180, 0], [270, 0], [0, 90], [0, -90]]
        >>> cells = flaunay.spherical(octahedron).voronoi
        >>> (cells.areas * 6 / 3.141592653589793).round(9).tolist()
        [4.0, 4.0, 4.0, 4.0, 4.0, 4.0]
        >>> len(cells.regions[0])
        4
        """
        return SphericalVoronoi._of(self)

    def _lengths_of_edges(self) -> Doubles:
        first, second = self.xyz[self.edges].transpose(1, 0, 2)
        return angles_between(first, second)

    def _lengths_of_ridges(self) -> Doubles:
        first, second = self.voronoi.vertices[self.edge_simplices].transpose(1, 0, 2)
        return angles_between(first, second)

    def _areas(self) -> Doubles:
        a, b, c = self.xyz[self.simplices].transpose(1, 0, 2)
        # Van Oosterom and Strackee (1983). Differences of near points are exact.
        volume = (a * np.cross(b - a, c - a)).sum(axis=1)
        below: Doubles = 1 + sum((p * q).sum(axis=1) for p, q in ((a, b), (b, c), (c, a)))
        # A triangle that has the centre in it is a hemisphere.
        has_centre = (np.abs(volume) <= _ROUNDING) & (below < 0)
        areas: Doubles = 2.0 * np.arctan2(np.where(has_centre, np.abs(volume), volume), below)
        # An edge that has the centre in it is the half circle in the middle between its triangles, outside.
        sides = np.stack([b + c, c + a, a + b], axis=1)
        triangle, corner = np.nonzero(np.linalg.norm(sides, axis=2) <= _ROUNDING)
        start, end, apex = (self.simplices[triangle, (corner + k) % 3] for k in (1, 2, 0))
        other = self.simplices[self.neighbors[triangle, corner]].sum(axis=1) - start - end
        axis = self.xyz[end] - self.xyz[start]
        across = [np.cross(axis, self.xyz[k] - self.xyz[start]) for k in (apex, other)]
        across = [each / np.linalg.norm(each, axis=1)[:, None] for each in across]
        areas[triangle] = 2 * np.pi - angles_between(*across)
        return areas

    _as_queries = staticmethod(_as_points)


def spherical(
    points: ArrayLike, offsets: Optional[npt.ArrayLike] = None, *, device: Optional[str] = None
) -> SphericalDelaunay:
    """Triangulates points on the sphere.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
        Longitudes, any numbers of degrees to the east, and latitudes, -90 to 90; or x, y and z, vectors of
        any length but 0, of which the directions count.
    offsets : array_like of int, optional
        Where sets begin: set s has the points ``offsets[s]`` to ``offsets[s + 1]``. By default all points
        are one set.
    device : str, optional
        As of `triangulate`.

    Returns
    -------
    SphericalDelaunay

    Raises
    ------
    UsageError
        For a wrong shape, and offsets that decrease or do not go from 0 to n.
    InputError
        For a point that is not finite, the vector 0, and a latitude beyond a pole.
    DeviceError
        As of `triangulate`.

    Notes
    -----
    A point is projected from the south pole to the plane of the equator, and rounded there once: so it
    lies on the sphere exactly, and the result is exact and canonical as that in the plane is. What is
    around the south pole is the farthest-point Delaunay triangulation of the hull in the plane (Brown,
    1979). O(n log n).

    Examples
    --------
    >>> import flaunay
    >>> tri = flaunay.spherical([[0, 0], [120, 0], [240, 0], [0, 90]])
    >>> tri
    <flaunay.SphericalDelaunay: 4 points, 4 triangles>
    >>> tri.simplices
    array([[1, 2, 3],
           [0, 3, 2],
           [0, 1, 3],
           [0, 2, 1]], dtype=int32)
    """
    given = frozen(as_rows(points).copy())
    return SphericalDelaunay(given, None if offsets is None else as_offsets(offsets), device)
