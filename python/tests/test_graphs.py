"""Edges, graphs and what is derived from them, beside SciPy and brute force."""

import sys

import numpy as np
import pytest
import scipy.sparse.csgraph
import scipy.spatial
from conftest import grid

import flaunay


SETS = {
    "random": lambda random: random.random((150, 2)),
    "grid": lambda random: grid(12),
    "turned grid": lambda random: grid(12) @ np.array([[0.6, 0.8], [-0.8, 0.6]]),
    "duplicates": lambda random: random.integers(0, 6, (100, 2)),
    "float32": lambda random: random.random((150, 2)).astype(np.float32),
    "triangle": lambda random: np.array([[0, 0], [4, 0], [0, 3]]),
    "line": lambda random: np.array([[3, 3], [1, 1], [2, 2], [0, 0], [1, 1]]),
    "point": lambda random: np.array([[3, 3]]),
    "nothing": lambda random: np.empty((0, 2)),
}


@pytest.fixture(params=SETS)
def tri(request, random):
    return flaunay.Delaunay(SETS[request.param](random))


def sides(tri):
    """Each edge of triangles, smaller index first, with the triangles that have it."""
    found = {}
    for t, row in enumerate(tri.simplices.tolist()):
        for k in range(3):
            found.setdefault(tuple(sorted((row[k], row[k - 1]))), set()).add(t)
    return found


def test_edges_are_the_sides_of_triangles_once_and_sorted(tri):
    expected = sorted(sides(tri))
    if tri.nsimplex == 0:
        expected = sorted(tuple(sorted(pair)) for pair in zip(tri.hull[:-1], tri.hull[1:]))
    assert list(map(tuple, tri.edges.tolist())) == expected
    assert tri.edges.dtype == np.int32 and tri.edges.shape == (len(expected), 2)


def test_edges_have_their_triangles(tri):
    expected = sides(tri)
    for edge, both in zip(tri.edges.tolist(), tri.edge_simplices.tolist()):
        assert set(both) - {-1} == expected.get(tuple(edge), set())
        assert both[1] >= 0 or tri.nsimplex == 0
    assert tri.edge_simplices.shape == tri.edges.shape


def test_edges_of_many_points_have_their_triangles(random):
    tri = flaunay.Delaunay(random.random((50000, 2)))
    ends = tri.edges[:, None, :] == tri.simplices[tri.edge_simplices[:, 1], :, None]
    assert ends.any(axis=1).all()


def test_lengths_are_distances(tri):
    points = tri.points.astype(np.float64)
    expected = [np.linalg.norm(points[i] - points[j]) for i, j in tri.edges]
    np.testing.assert_allclose(tri.edge_lengths, expected, rtol=1e-15)


def test_what_is_kept_cannot_be_changed(tri):
    for name in "edges", "edge_lengths", "edge_simplices", "is_gabriel", "circumradii":
        assert getattr(tri, name) is getattr(tri, name)
        with pytest.raises(ValueError):
            getattr(tri, name)[...] = 0


def test_adjacency_has_each_edge_in_both_directions(tri):
    lengths, ones = tri.adjacency(), tri.adjacency(None)
    n = tri.npoints
    assert lengths.shape == ones.shape == (n, n) and ones.dtype == np.int32
    expected = np.zeros((n, n))
    for (i, j), length in zip(tri.edges, tri.edge_lengths):
        expected[i, j] = expected[j, i] = length
    assert np.array_equal(lengths.toarray(), expected)
    assert np.array_equal(ones.toarray(), expected != 0)
    assert lengths.has_sorted_indices
    # It is the caller's.
    lengths.indices[:] = 0
    assert np.array_equal(tri.adjacency().toarray(), expected)


def test_simplex_adjacency_has_neighbours_and_common_edges(tri):
    lengths, ones = tri.simplex_adjacency("length"), tri.simplex_adjacency()
    expected = np.zeros((tri.nsimplex, tri.nsimplex))
    for (s, t), length in zip(tri.edge_simplices, tri.edge_lengths):
        if s >= 0:
            expected[s, t] = expected[t, s] = length
    assert np.array_equal(lengths.toarray(), expected)
    assert np.array_equal(ones.toarray(), expected != 0)
    assert lengths.has_sorted_indices


@pytest.mark.parametrize("name", ["adjacency", "simplex_adjacency"])
def test_other_weights_are_refused(name):
    with pytest.raises(flaunay.UsageError, match="'length' or None, not 'area'"):
        getattr(flaunay.Delaunay([[0, 0], [1, 0], [0, 1]]), name)("area")


def test_the_gabriel_graph_is_that_of_all_pairs_of_points(tri):
    points = tri.points.astype(np.float64)
    distinct = np.flatnonzero(tri.representatives == np.arange(tri.npoints))
    u = points[distinct][:, None] - points[distinct]
    # dots[r, p, q] = (p - r) . (q - r), positive for points outside of the closed disc.
    dots = np.einsum("prk,qrk->rpq", u, u)
    # Whole numbers are exact; of others, what is this close to a circle is not compared.
    unsure = 0 if np.array_equal(points, np.round(points)) else 1e-9
    expected, compared = set(), set()
    for p in range(len(distinct)):
        for q in range(p):
            closest = np.delete(dots[:, p, q], [p, q]).min(initial=np.inf)
            edge = (int(distinct[q]), int(distinct[p]))
            if abs(closest) >= unsure:
                compared.add(edge)
            if closest > 0:
                expected.add(edge)
    found = set(map(tuple, tri.edges[tri.is_gabriel].tolist()))
    assert found & compared == expected & compared
    assert len(compared) >= len(tri.edges) // 3


def test_right_angles_are_not_in_the_gabriel_graph():
    tri = flaunay.Delaunay(grid(20))
    # No diagonal of a square.
    assert np.array_equal(tri.is_gabriel, tri.edge_lengths == 1)


def test_the_spanning_tree_is_minimal(tri):
    tree = tri.spanning_tree
    distinct = np.flatnonzero(tri.representatives == np.arange(tri.npoints))
    assert tree.shape == (max(len(distinct) - 1, 0), 2)
    if len(distinct) < 2:
        return
    points = tri.points.astype(np.float64)
    graph = np.linalg.norm(points[distinct][:, None] - points[distinct], axis=2)
    shortest = scipy.sparse.csgraph.minimum_spanning_tree(graph).sum()
    ends = points[tree]
    assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum() == pytest.approx(shortest)
    joined = scipy.sparse.coo_array((np.ones(len(tree)), tree.T), shape=(tri.npoints,) * 2)
    labels = scipy.sparse.csgraph.connected_components(joined, directed=False)[1]
    assert len(set(labels[distinct].tolist())) == 1
    assert set(map(tuple, tree.tolist())) <= set(map(tuple, tri.edges.tolist()))


def test_circumradii_are_distances_to_circumcentres(random):
    points = random.random((300, 2))
    vor = flaunay.Voronoi(points)
    tri = vor.delaunay
    distances = np.linalg.norm(vor.vertices - points[tri.simplices[:, 0]], axis=1)
    np.testing.assert_allclose(tri.circumradii, distances, rtol=1e-9)


def test_networkx_has_nodes_places_and_lengths(tri):
    networkx = pytest.importorskip("networkx")
    graph = tri.to_networkx()
    assert graph.number_of_nodes() == tri.npoints
    assert sorted(tuple(sorted(e)) for e in graph.edges) == list(map(tuple, tri.edges.tolist()))
    assert [graph.nodes[i]["pos"] for i in range(tri.npoints)] == list(
        map(tuple, tri.points.tolist())
    )
    for (i, j), length in zip(tri.edges.tolist(), tri.edge_lengths.tolist()):
        assert graph.edges[i, j]["length"] == length
    for i, j in networkx.minimum_spanning_edges(graph, weight="length", data=False):
        assert graph.has_edge(i, j)


@pytest.mark.parametrize(
    "package, call",
    [
        ("scipy.sparse", lambda tri: tri.adjacency()),
        ("scipy.sparse", lambda tri: tri.simplex_adjacency()),
        ("scipy.sparse", lambda tri: tri.spanning_tree),
        ("networkx", lambda tri: tri.to_networkx()),
        ("matplotlib.tri", lambda tri: tri.to_matplotlib()),
        ("matplotlib.pyplot", lambda tri: tri.plot()),
        ("meshio", lambda tri: tri.to_meshio()),
        ("pyvista", lambda tri: tri.to_pyvista()),
        ("shapely", lambda tri: flaunay.alpha_shape(tri, 1).to_shapely()),
        (
            "shapely",
            lambda tri: flaunay.voronoi_polygons(tri.points, (0, 0, 1, 1), as_shapely=True),
        ),
    ],
)
def test_a_missing_package_is_named(monkeypatch, package, call):
    tri = flaunay.Delaunay([[0, 0], [1, 0], [0, 1]])
    monkeypatch.setitem(sys.modules, package, None)
    name = package.split(".")[0]
    with pytest.raises(ImportError, match=f"needs the package {name},.* pip install {name}"):
        call(tri)
