"""Edges of triangulations on a torus, a cylinder and the sphere, and the Voronoi edges that cross them."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from flaunay._arrays import frozen
from flaunay._surfaces import Doubles, Indices, WithLocator


class WithEdges(WithLocator):
    """One whose edges have two triangles each, or one at the ends of a cylinder."""

    def _lengths_of_edges(self) -> Doubles:
        raise NotImplementedError

    def _lengths_of_ridges(self) -> Doubles:
        raise NotImplementedError

    def _areas(self) -> Doubles:
        raise NotImplementedError

    @cached_property
    def _sides(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """A triangle that has each edge, and the corner opposite to it; the next corner has the smaller index."""
        triangle, corner = np.nonzero(self.neighbors < np.arange(self.nsimplex)[:, None])
        first, second = (self.simplices[triangle, (corner + k) % 3] for k in (1, 2))
        order = np.lexsort((np.maximum(first, second), np.minimum(first, second)))
        return triangle[order], corner[order]

    @cached_property
    def _ends(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """The corners at the first and the second end of each edge."""
        triangle, corner = self._sides
        ends = (corner + 1) % 3, (corner + 2) % 3
        turned = self.simplices[triangle, ends[0]] > self.simplices[triangle, ends[1]]
        return np.where(turned, ends[1], ends[0]), np.where(turned, ends[0], ends[1])

    @cached_property
    def edges(self) -> Indices:
        """Each edge once, int32, shape (e, 2): the smaller index first, in increasing order.

        On a torus with few points, two points may have several edges, and a point edges to itself.

        Examples
        --------
        >>> import flaunay
        >>> flaunay.spherical([[0, 0], [120, 0], [240, 0], [0, 90]]).edges.tolist()
        [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
        >>> flaunay.periodic([[0, 0]], (1, 1)).edges.tolist()
        [[0, 0], [0, 0], [0, 0]]
        """
        triangle = self._sides[0]
        return frozen(np.stack([self.simplices[triangle, corner] for corner in self._ends], axis=1))

    @cached_property
    def edge_simplices(self) -> Indices:
        """The two triangles at each of `edges`, int32, shape (e, 2); the first is -1 at an end of a cylinder."""
        triangle, corner = self._sides
        sides = self.neighbors[triangle, corner], triangle.astype(np.int32)
        return frozen(np.stack(sides, axis=1))

    @cached_property
    def edge_lengths(self) -> Doubles:
        """The length of each of `edges`, shape (e,): on the sphere the angle in radians."""
        return frozen(self._lengths_of_edges())

    @cached_property
    def ridge_lengths(self) -> Doubles:
        """The length of the Voronoi edge that crosses each of `edges`, shape (e,): on the sphere the angle in radians.

        Rounded by some 1e-15 of the distance between a corner and its points; so where more than three points are
        cocircular, it may be a little more than 0. Infinite at an end of a cylinder. With weights, of power cells.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.periodic([[0.25, 0.5], [0.75, 0.5]], (1, 1))
        >>> [(*edge, length) for edge, length in zip(tri.edges.tolist(), tri.ridge_lengths.tolist()) if length > 0]
        [(0, 0, 0.5), (0, 1, 1.0), (0, 1, 1.0), (1, 1, 0.5)]
        """
        return frozen(self._lengths_of_ridges())

    @cached_property
    def areas(self) -> Doubles:
        """The area of each triangle, shape (nsimplex,): on a torus they sum to the box's.

        On the unit sphere, the area between great circles. Areas sum to 4 pi, or to 0 if the centre lies outside of
        the points' hull: then triangles close the hull from behind, and have negative areas. If the centre lies on the
        hull but for rounding, it counts as inside: a triangle that contains it has the area of a hemisphere, and an
        edge between antipodal points is the half circle in the middle between its two triangles. The error relative
        to a triangle's area is some 1e-15 over the length of its sides, on a torus relative to the period.

        Examples
        --------
        >>> import flaunay
        >>> octahedron = [[0, 0], [90, 0], [180, 0], [270, 0], [0, 90], [0, -90]]
        >>> (flaunay.spherical(octahedron).areas / 3.141592653589793).round(9).tolist()
        [0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5]
        >>> flaunay.periodic([[0, 0], [0.5, 0.5]], (1, 1)).areas.tolist()
        [0.25, 0.25, 0.25, 0.25]
        """
        return frozen(self._areas())


def angles_between(a: Doubles, b: Doubles) -> Doubles:
    """Of unit vectors, in radians, small ones and those near pi with a small error, too."""
    halves: Doubles = np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return 2.0 * halves
