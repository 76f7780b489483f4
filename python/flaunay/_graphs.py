"""Edges of triangulations, as arrays and as graphs of SciPy and NetworkX."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import FloatArray, Mesh, frozen
from flaunay._errors import UsageError
from flaunay._optional import optional

if TYPE_CHECKING:
    import networkx
    import scipy.sparse

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]


def _lengths(points: FloatArray, edges: Indices) -> Doubles:
    ends = np.asarray(points, np.float64)[edges]
    lengths: Doubles = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    return lengths


def _check_weights(weights: Optional[str]) -> None:
    if weights not in (None, "length"):
        raise UsageError(f"weights must be 'length' or None, not {weights!r}")


def _ones_or_lengths(lengths: Optional[Doubles], n: int) -> npt.NDArray[Any]:
    return np.ones(n, np.int32) if lengths is None else lengths


def vertex_neighbor_vertices(tri: Mesh) -> tuple[Indices, Indices]:
    """The points to which each point has edges: `indptr` and `indices`, int32.

    Those of point k are ``indices[indptr[k]:indptr[k + 1]]``, in increasing order. A point that
    another represents has none.
    """
    starts, indices = _calls.vertex_neighbors(tri.simplices, tri.hull, len(tri.points))
    return frozen(starts), frozen(indices)


def edges(tri: Mesh) -> Indices:
    """Each edge once, int32, shape (e, 2).

    In each row the smaller index first; the rows in increasing order. Points on one line are joined
    to the next on it. A point that another represents has no edges.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [4, 0], [4, 3], [0, 4]]).edges
    array([[0, 1],
           [0, 2],
           [0, 3],
           [1, 2],
           [2, 3]], dtype=int32)
    """
    first, second = _directed_edges(tri)
    once = first < second
    return frozen(np.stack([first[once], second[once]], axis=1))


def _neighbors_of_points(tri: Mesh) -> tuple[Indices, Indices]:
    """As `vertex_neighbor_vertices`, but points on one line have those next to them."""
    if len(tri.simplices):
        return tri.vertex_neighbor_vertices
    before, after = tri.hull[:-1], tri.hull[1:]
    first, second = np.concatenate([before, after]), np.concatenate([after, before])
    starts = np.zeros(len(tri.points) + 1, np.int32)
    np.cumsum(np.bincount(first, minlength=len(tri.points)), out=starts[1:])
    return starts, second[np.lexsort((second, first))]


def _directed_edges(tri: Mesh) -> tuple[Indices, Indices]:
    """Each edge in both directions, in increasing order."""
    starts, ends = _neighbors_of_points(tri)
    return np.repeat(np.arange(len(tri.points), dtype=np.int32), np.diff(starts)), ends


def edge_lengths(tri: Mesh) -> Doubles:
    """The length of each of `edges`, float64, shape (e,), with a relative error below 2**-51.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [4, 0], [0, 3]]).edge_lengths
    array([4., 3., 5.])
    """
    return frozen(_lengths(tri.points, tri.edges))


def edge_order(tri: Mesh) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """A triangle that has each of the edges, and its corner opposite to the edge."""
    # The triangle with the larger index; -1 is the smallest.
    triangle, corner = np.nonzero(tri.neighbors < np.arange(len(tri.simplices))[:, None])
    ends = [tri.simplices[triangle, (corner + k) % 3].astype(np.int64) for k in (1, 2)]
    order = np.argsort(np.minimum(*ends) * len(tri.points) + np.maximum(*ends))
    return triangle[order], corner[order]


def edge_simplices(tri: Mesh) -> Indices:
    """The two simplices at each of `edges`, int32, shape (e, 2); the first is -1 on the hull.

    Both are -1 if there are no simplices, as of points on one line.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [4, 0], [4, 3], [0, 4]]).edge_simplices.tolist()
    [[-1, 1], [0, 1], [-1, 0], [-1, 1], [-1, 0]]
    """
    if len(tri.simplices) == 0:
        return frozen(np.full(tri.edges.shape, -1, np.int32))
    triangle, corner = tri._edge_order
    sides = [tri.neighbors[triangle, corner], triangle.astype(np.int32)]
    return frozen(np.stack(sides, axis=1))








def is_gabriel(tri: Mesh) -> Mask:
    """Which of `edges` are in the Gabriel graph, exactly; bool, shape (e,).

    Those whose closed disc, with the edge as diameter, has no other point in it. All edges of the
    Gabriel graph are edges of the Delaunay triangulation, so ``edges[is_gabriel]`` is that graph.

    Examples
    --------
    >>> import flaunay
    >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [2, 1]])
    >>> tri.edges[tri.is_gabriel].tolist()
    [[0, 2], [1, 2]]
    """
    if len(tri.simplices) == 0:
        return frozen(np.ones(len(tri.edges), np.bool_))
    # If any point is in an edge's disc, a corner opposite to the edge is.
    acute = _calls.angles(tri._stand_ins[0], tri.simplices) > 0
    triangle, corner = tri._edge_order
    beyond = tri.neighbors[triangle, corner]
    is_back = tri.neighbors[beyond] == triangle[:, None]
    return frozen(acute[triangle, corner] & ((beyond < 0) | (acute[beyond] & is_back).any(axis=1)))


def spanning_tree(tri: Mesh) -> Indices:
    """The edges of a Euclidean minimum spanning tree, int32, shape (k, 2), as rows of `edges`.

    It joins all distinct points. Lengths are compared as in `edge_lengths`, so the tree's can exceed
    the smallest possible by a factor of 1 + 2**-50. Of edges of one length, the first in `edges`
    is taken. Needs SciPy.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [4, 0], [2, 1]]).spanning_tree.tolist()
    [[0, 2], [1, 2]]
    """
    rows = minimum_spanning_forest(tri.edges, tri.edge_lengths, len(tri.points))
    return frozen(tri.edges[rows])


def areas(tri: Mesh) -> Doubles:
    """The area of each simplex, the float64 next to the exact one, shape (nsimplex,).

    It is positive, unless it is below 2**-1075.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [4, 0], [0, 3]]).areas
    array([6.])
    """
    return frozen(_calls.areas(tri._stand_ins[0], tri.simplices))


def centroids(tri: Mesh) -> Doubles:
    """The centroid of each simplex, float64, shape (nsimplex, 2).

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [6, 0], [0, 3]]).centroids
    array([[2., 1.]])
    """
    # Divided before they are added, which does not overflow.
    thirds = np.asarray(tri.points, np.float64)[tri.simplices] / 3
    return frozen(thirds.sum(axis=1))


def circumradii(tri: Mesh) -> Doubles:
    """The radius of each simplex's circumcircle, float64, shape (nsimplex,).

    With a relative error below 2**-45, however thin the triangle is.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.Delaunay([[0, 0], [4, 0], [0, 3]]).circumradii
    array([2.5])
    """
    return frozen(_calls.circumradii(tri._stand_ins[0], tri.simplices))


def minimum_spanning_forest(
    edges: npt.NDArray[Any], weights: npt.NDArray[Any], n: int
) -> npt.NDArray[np.intp]:
    """The rows, in increasing order, of a minimum spanning forest of a graph of n vertices.

    Of edges of one weight those in the first rows. Each edge must be given once.
    """
    sparse = optional("scipy.sparse", "A minimum spanning tree")
    csgraph = optional("scipy.sparse.csgraph", "A minimum spanning tree")
    # SciPy takes edges of weight zero for missing ones, and equal weights in any order. Ranks are neither.
    order = np.argsort(weights, kind="stable")
    ranks = np.empty(len(order))
    ranks[order] = np.arange(1, len(order) + 1)
    graph = sparse.coo_array((ranks, (edges[:, 0], edges[:, 1])), shape=(n, n)).tocsr()
    kept = csgraph.minimum_spanning_tree(graph).data.astype(np.intp) - 1
    return np.sort(order[kept])


class GraphMethods:
    """Those of a triangulation that is a graph."""

    def adjacency(self: Mesh, weights: Optional[str] = "length") -> scipy.sparse.csr_array:
        """The graph of points and edges as a sparse matrix, for `scipy.sparse.csgraph` and others.

        Parameters
        ----------
        weights : "length" or None
            What the matrix has for an edge: its length, float64, or 1, int32.

        Returns
        -------
        scipy.sparse.csr_array, shape (npoints, npoints)
            Symmetric, with sorted indices. Needs SciPy.

        Raises
        ------
        UsageError
            For other weights.
        ImportError
            Without SciPy.

        Examples
        --------
        The shortest way along edges:

        >>> import flaunay
        >>> from scipy.sparse.csgraph import dijkstra
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [8, 3], [0, 3]])
        >>> float(dijkstra(tri.adjacency(), indices=0)[2])
        9.0
        """
        _check_weights(weights)
        sparse = optional("scipy.sparse", "Delaunay.adjacency")
        starts, ends = _neighbors_of_points(self)
        lengths = None
        if weights is not None:
            lengths = _lengths(self.points, np.stack(_directed_edges(self), axis=1))
        n = len(self.points)
        # Copies, since the matrix is the caller's.
        values = _ones_or_lengths(lengths, len(ends))
        matrix: scipy.sparse.csr_array = sparse.csr_array(
            (values, ends.copy(), starts.copy()), shape=(n, n)
        )
        return matrix

    def simplex_adjacency(self: Mesh, weights: Optional[str] = None) -> scipy.sparse.csr_array:
        """The graph of simplices that have a common edge, as a sparse matrix.

        Parameters
        ----------
        weights : "length" or None
            What the matrix has for two neighbours: the length of their common edge, float64, or 1, int32.

        Returns
        -------
        scipy.sparse.csr_array, shape (nsimplex, nsimplex)
            Symmetric, with sorted indices. Needs SciPy.

        Raises
        ------
        UsageError
            For other weights.
        ImportError
            Without SciPy.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [4, 3], [0, 4]])
        >>> tri.simplex_adjacency("length").toarray()
        array([[0., 5.],
               [5., 0.]])
        """
        _check_weights(weights)
        sparse = optional("scipy.sparse", "Delaunay.simplex_adjacency")
        n = len(self.simplices)
        # In each row the neighbours in increasing order; the -1 beyond the hull come first.
        order = np.argsort(self.neighbors, axis=1)
        ends = np.take_along_axis(self.neighbors, order, axis=1)
        row, place = np.nonzero(ends >= 0)
        starts = np.zeros(n + 1, np.int32)
        np.cumsum((ends >= 0).sum(axis=1), out=starts[1:])
        lengths = None
        if weights is not None:
            corner = order[row, place]
            sides = [self.simplices[row, (corner + k) % 3] for k in (1, 2)]
            lengths = _lengths(self.points, np.stack(sides, axis=1))
        values = _ones_or_lengths(lengths, len(row))
        matrix: scipy.sparse.csr_array = sparse.csr_array(
            (values, ends[row, place], starts), shape=(n, n)
        )
        return matrix

    def to_networkx(self: Mesh) -> networkx.Graph[Any]:
        """The graph of points and edges for NetworkX.

        Returns
        -------
        networkx.Graph
            The nodes are the indices of points, with their coordinates as ``pos``; edges have their
            ``length``. Needs NetworkX, and much more memory and time than `edges` and `adjacency`.

        Raises
        ------
        ImportError
            Without NetworkX.

        Examples
        --------
        >>> import flaunay
        >>> graph = flaunay.Delaunay([[0, 0], [4, 0], [0, 3]]).to_networkx()  # doctest: +SKIP
        >>> graph.edges[1, 2]["length"]  # doctest: +SKIP
        5.0
        """
        graph: networkx.Graph = optional("networkx", "Delaunay.to_networkx").Graph()
        graph.add_nodes_from((i, {"pos": tuple(p)}) for i, p in enumerate(self.points.tolist()))
        graph.add_weighted_edges_from(
            ((i, j, length) for (i, j), length in zip(self.edges.tolist(), self.edge_lengths.tolist())),
            weight="length",
        )
        return graph
