"""Queries in triangulations with constraints, against plain sequential twins with integers and fractions."""

import pickle
from fractions import Fraction

import flaunay
import numpy as np
import pytest
from conftest import fractions, grid, orient, ring, uncrossed


def located(mesh, points, q):
    """The first triangle that has q, or -1."""
    for t, corners in enumerate(mesh.triangles.tolist()):
        p = [points[v] for v in corners]
        if all(orient(p[k], p[(k + 1) % 3], q) >= 0 for k in range(3)):
            return t
    return -1


def circumcentre(a, b, c):
    area = 2 * orient(a, b, c)
    lifts = [p[0] * p[0] + p[1] * p[1] for p in (a, b, c)]
    x = lifts[0] * (b[1] - c[1]) + lifts[1] * (c[1] - a[1]) + lifts[2] * (a[1] - b[1])
    y = lifts[0] * (c[0] - b[0]) + lifts[1] * (a[0] - c[0]) + lifts[2] * (b[0] - a[0])
    return x / area, y / area


def is_inside_circle(a, b, c, q):
    centre = circumcentre(a, b, c)
    return sum((q[k] - centre[k]) ** 2 - (a[k] - centre[k]) ** 2 for k in (0, 1)) < 0


def shoelace(ring):
    return sum(
        ring[i - 1][0] * ring[i][1] - ring[i][0] * ring[i - 1][1] for i in range(len(ring))
    )


def sibson_weights(mesh, points, q):
    """The weight of each natural neighbour that q sees; None outside.

    The cavity is flooded over edges that are no constraints. The piece that q takes from a corner of the cavity is
    the polygon of the circumcentres of the cavity's triangles there, and of q with the edges beside it.
    """
    start = located(mesh, points, q)
    if start < 0:
        return None
    triangles, neighbors = mesh.triangles.tolist(), mesh.neighbors.tolist()
    corners = triangles[start]
    for k in range(3):
        if points[corners[k]] == q:
            return {corners[k]: Fraction(1)}
    for k in range(3):
        if neighbors[start][k] >= 0 and not mesh.constrained[start, k]:
            continue
        v, u = corners[(k + 1) % 3], corners[(k + 2) % 3]
        a, b = points[v], points[u]
        if orient(a, b, q) == 0:
            axis = 0 if a[0] != b[0] else 1
            part = (q[axis] - a[axis]) / (b[axis] - a[axis])
            return {v: 1 - part, u: part}
    cavity, waiting = {start}, [start]
    while waiting:
        t = waiting.pop()
        for k in range(3):
            u = neighbors[t][k]
            if u < 0 or u in cavity or mesh.constrained[t, k]:
                continue
            if is_inside_circle(*(points[v] for v in triangles[u]), q):
                cavity.add(u)
                waiting.append(u)
    # The border by its first points: the next point and the triangle.
    border = {}
    for t in cavity:
        for k in range(3):
            if neighbors[t][k] not in cavity or mesh.constrained[t, k]:
                border[triangles[t][(k + 1) % 3]] = triangles[t][(k + 2) % 3], t
    weights = {}
    for before, (v, first) in border.items():
        after, _ = border[v]
        ring = [circumcentre(q, points[before], points[v])]
        t = first
        while True:
            ring.append(circumcentre(*(points[c] for c in triangles[t])))
            k = triangles[t].index(v)
            # Clockwise around v to the triangle that has the edge from v to `after`.
            if triangles[t][(k + 1) % 3] == after:
                break
            t = neighbors[t][(k + 2) % 3]
        ring.append(circumcentre(q, points[v], points[after]))
        weights[v] = abs(shoelace(ring))
    total = sum(weights.values())
    return {v: weight / total for v, weight in weights.items()}


def star(rng, centre, count, large):
    """A ring about a centre with integer corners, in order of their angles."""
    angles = np.sort(rng.choice(360, count, replace=False)) * np.pi / 180
    radii = rng.integers(large // 3, large, count)
    return np.rint(np.column_stack([np.cos(angles), np.sin(angles)]) * radii[:, None]) + centre


def mesh_of(kind, rng):
    """A triangulation with constraints of points with small integer coordinates."""
    if kind == "segments":
        points = rng.integers(0, 400, (60, 2))
        return flaunay.triangulate(points, segments=uncrossed(rng, points, 25))
    if kind == "grid":
        points = grid(8) * 4
        return flaunay.triangulate(points, segments=uncrossed(rng, points, 12))
    if kind == "holes":
        outer, inner = star(rng, 500, 30, 500), star(rng, 500, 9, 60)
        others = rng.integers(300, 700, (20, 2))
        points = np.concatenate([outer, inner, others])
        return flaunay.triangulate(points, segments=ring(30, 9), outside="holes")
    if kind == "seeded holes":
        points = grid(6) * 10
        hole = [[7, 10], [10, 28], [28, 25], [25, 7]]
        return flaunay.triangulate(points, segments=hole, holes=[[25, 25]])
    if kind == "map":
        squares = [
            [[[x, y], [x + 8, y], [x + 8, y + 8], [x, y + 8]], [[x + 2, y + 2], [x + 2, y + 5], [x + 5, y + 2]]]
            for x, y in [(0, 0), (8, 0), (16, 8)]
        ]
        return flaunay.polygons(squares, map=True, neighbors=True)
    assert kind == "refined"
    corners = star(rng, 500, 12, 500)
    return flaunay.refine(corners, ring(12), outside="holes", min_angle=25)


KINDS = ["segments", "grid", "holes", "seeded holes", "map", "refined"]


def queries_for(rng, mesh):
    """On vertices, on edges, at the border, inside of triangles, anywhere and far away."""
    points = mesh.points
    corners = points[mesh.triangles]
    middles = np.concatenate([(corners[:, k] + corners[:, k - 1]) / 2 for k in range(3)])
    low, high = points.min(axis=0), points.max(axis=0)
    anywhere = rng.uniform(low - 20, high + 20, (40, 2))
    whole = rng.integers(low - 2, high + 3, (40, 2)).astype(float)
    everything = [points, middles, corners.mean(axis=1), anywhere, whole, [[1e6, -1e6], [0, 1e6]]]
    all_queries = np.concatenate(everything)
    return all_queries[rng.permutation(len(all_queries))[:150]]


@pytest.mark.parametrize("kind", KINDS)
def test_triangles_are_those_of_the_twin(kind):
    rng = np.random.default_rng(0)
    mesh = mesh_of(kind, rng)
    points, queries = fractions(mesh.points), queries_for(rng, mesh)
    want = [located(mesh, points, (Fraction(x), Fraction(y))) for x, y in queries.tolist()]
    assert len(set(want)) > 5
    assert (-1 in want) and max(want) >= 0
    assert mesh.find_simplex(queries).tolist() == want
    # One at a time, and in another order, nothing differs.
    assert [int(mesh.find_simplex(q)) for q in queries[:20]] == want[:20]
    order = rng.permutation(len(queries))
    many = np.tile(queries[order], (20, 1))
    assert mesh.find_simplex(many).tolist() == np.tile(np.array(want)[order], 20).tolist()


@pytest.mark.parametrize("kind", KINDS)
def test_natural_neighbours_are_those_of_the_twin(kind):
    rng = np.random.default_rng(7)
    mesh = mesh_of(kind, rng)
    points, queries = fractions(mesh.points), queries_for(rng, mesh)[:60]
    values = rng.uniform(-1, 1, len(points))
    found = flaunay.NaturalNeighborInterpolator(mesh, values)(queries)
    laplace = flaunay.NaturalNeighborInterpolator(mesh, mesh.points[:, 0], method="laplace")(queries)
    linear = flaunay.NaturalNeighborInterpolator(mesh, mesh.points @ [2.0, -3.0] + 1)(queries)
    inside = 0
    for k, (x, y) in enumerate(queries.tolist()):
        weights = sibson_weights(mesh, points, (Fraction(x), Fraction(y)))
        if weights is None:
            assert np.isnan([found[k], laplace[k], linear[k]]).all()
            continue
        inside += 1
        want = sum(float(weight) * values[v] for v, weight in weights.items())
        assert found[k] == pytest.approx(want, abs=1e-9)
        # Linear functions are reproduced.
        assert linear[k] == pytest.approx(2 * x - 3 * y + 1, abs=1e-7)
        assert laplace[k] == pytest.approx(x, abs=1e-7)
    assert inside > 10


@pytest.mark.parametrize("kind", KINDS)
def test_interpolation_has_values_and_linear_functions(kind):
    rng = np.random.default_rng(9)
    mesh = mesh_of(kind, rng)
    queries = queries_for(rng, mesh)
    plane = flaunay.CloughTocherInterpolator(mesh, mesh.points @ [2.0, -3.0] + 1)(queries)
    at = mesh.find_simplex(queries)
    assert (np.isnan(plane) == (at < 0)).all()
    inside = at >= 0
    assert plane[inside] == pytest.approx(queries[inside] @ [2.0, -3.0] + 1, abs=1e-3)
    values = rng.uniform(-1, 1, len(mesh.points))
    linear = flaunay.LinearInterpolator(mesh, values)(queries)
    assert np.array_equal(linear, mesh.interpolate(values, queries), equal_nan=True)
    assert (np.isnan(linear) == (at < 0)).all()
    vertices = np.unique(mesh.triangles)
    there = flaunay.CloughTocherInterpolator(mesh, values)(mesh.points[vertices])
    assert there == pytest.approx(values[vertices], abs=1e-12)


def test_gradients_are_of_edges_that_are_kept():
    # Two squares that share a corner only, with different slopes.
    points = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1], [4, 2], [4, 4], [2, 4], [3, 3]]
    segments = ring(4) + [[2, 5], [5, 6], [6, 7], [7, 2]]
    mesh = flaunay.triangulate(points, segments=segments, outside="holes")
    steep = np.where(np.arange(9) < 5, 1.0, 5.0) * (np.array(points)[:, 0] - 2)
    steep[2] = 0
    smooth = flaunay.CloughTocherInterpolator(mesh, steep)
    assert np.isfinite(smooth.grad).all()
    # The common corner has edges on both sides.
    assert 1.2 < smooth.grad[2, 0] < 4.8
    lone = flaunay.triangulate([[0, 0], [4, 0], [0, 4], [9, 9], [9, 0]], segments=ring(3), outside="holes")
    assert np.isnan(flaunay.CloughTocherInterpolator(lone, np.arange(5.0)).grad[3:]).all()


def test_nearest_points_are_those_of_all_points():
    rng = np.random.default_rng(3)
    mesh = mesh_of("holes", rng)
    queries = queries_for(rng, mesh)
    free = flaunay.Delaunay(mesh.points)
    assert np.array_equal(mesh.nearest(queries), free.nearest(queries))
    assert np.array_equal(mesh.nearest(queries, k=4), free.nearest(queries, k=4))
    values = rng.uniform(size=len(mesh.points))
    nearest = flaunay.NearestInterpolator(mesh, values)(queries)
    assert np.array_equal(nearest, values[mesh.nearest(queries)])


def test_a_breakline_is_a_crease():
    # A roof: the ridge from (0, 5) to (10, 5) is a segment.
    rng = np.random.default_rng(4)
    points = np.concatenate([[[0, 5], [10, 5], [0, 0], [10, 0], [0, 10], [10, 10]], rng.uniform(0, 10, (200, 2))])
    mesh = flaunay.triangulate(points, segments=[[0, 1]])
    roof = flaunay.NaturalNeighborInterpolator(mesh, 5 - abs(points[:, 1] - 5))
    queries = rng.uniform(0, 10, (500, 2))
    assert roof(queries) == pytest.approx(5 - abs(queries[:, 1] - 5), abs=1e-9)


def test_region_and_polygon_come_with_the_triangle():
    squares = [[[[x, 0], [x + 2, 0], [x + 2, 2], [x, 2]]] for x in (0, 2, 4)]
    mesh = flaunay.polygons(squares, map=True)
    found = mesh.find_simplex([[1, 1], [2.5, 1.5], [5, 0.25]])
    assert mesh.polygon_of[found].tolist() == [0, 1, 2]


def test_points_that_were_added_have_values():
    mesh = flaunay.triangulate(
        [[0, 0], [4, 4], [0, 4], [4, 0]], segments=[[0, 1], [2, 3]], crossings="split"
    )
    assert mesh.npoints == 5
    assert mesh.interpolate([0, 0, 0, 0, 1], [[2, 2], [1, 1]]).tolist() == [1.0, 0.5]
    with pytest.raises(flaunay.UsageError, match="5"):
        flaunay.LinearInterpolator(mesh, [0, 0, 0, 0])


def test_without_triangles_all_is_outside():
    line = flaunay.triangulate([[0, 0], [1, 1], [3, 3]], segments=[[0, 1]])
    assert line.find_simplex([[1, 1]]).tolist() == [-1]
    assert line.nearest([[2, 1.5]]).tolist() == [1]
    nothing = flaunay.triangulate([[0, 0], [4, 0], [0, 4]], segments=ring(3), holes=[[1, 1]])
    assert len(nothing.triangles) == 0
    assert nothing.find_simplex([[1, 1]]).tolist() == [-1]
    assert np.isnan(nothing.interpolate([1, 2, 3], [[1, 1]])).all()


def test_copies_and_threads_answer_alike():
    from concurrent.futures import ThreadPoolExecutor

    rng = np.random.default_rng(5)
    mesh = mesh_of("holes", rng)
    queries = np.tile(queries_for(rng, mesh), (30, 1))
    want = mesh.find_simplex(queries)
    assert np.array_equal(pickle.loads(pickle.dumps(mesh)).find_simplex(queries), want)
    fresh = mesh_of("holes", np.random.default_rng(5))
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(lambda _: fresh.find_simplex(queries), range(8)):
            assert np.array_equal(found, want)


def test_what_has_no_answer_says_why():
    sets = flaunay.triangulate(
        [[0, 0], [1, 0], [0, 1], [5, 5], [6, 5], [5, 6]], offsets=[0, 3, 6], segments=[[0, 1], [3, 4]]
    )
    with pytest.raises(flaunay.UsageError, match="one set"):
        sets.find_simplex([[0.1, 0.1]])
    mesh = flaunay.triangulate([[0, 0], [4, 0], [0, 4]], segments=[[0, 1]])
    with pytest.raises(flaunay.UsageError, match="tol"):
        mesh.find_simplex([[9, 9]], tol=1e-3)
    with pytest.raises(flaunay.UsageError, match="shape"):
        mesh.find_simplex([1, 2, 3])
    assert mesh.find_simplex([[np.nan, 1], [1, 1]]).tolist() == [-1, 0]
