"""Triangulations with segments as edges."""

import pickle
from fractions import Fraction

import numpy as np
import pytest
from conftest import areas, as_set, check_neighbors

import flaunay

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])


def pairs(values):
    """Each with the next one; itertools has it since Python 3.10."""
    values = list(values)
    return zip(values, values[1:])


def turn(a, b, c):
    """The exact sign of a turn."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in p] for p in (a, b, c))
    value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (value > 0) - (value < 0)


def in_circle(a, b, c, d):
    """Whether d is strictly inside of the circle through a counter-clockwise triangle, exactly."""
    rows = [[Fraction(p[k]) - Fraction(d[k]) for k in range(2)] for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    al, bl, cl = (x * x + y * y for x, y in rows)
    determinant = ax * (by * cl - bl * cy) - ay * (bx * cl - bl * cx) + al * (bx * cy - by * cx)
    return determinant > 0


def cross(a, b, c, d):
    """Whether two open segments cross in one point."""
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def uncrossed(random, points, wanted):
    """Random segments of which no two cross."""
    chosen = []
    for _ in range(20 * wanted):
        a, b = random.choice(len(points), 2, replace=False)
        if not any(cross(points[a], points[b], points[c], points[d]) for c, d in chosen):
            chosen.append((a, b))
        if len(chosen) == wanted:
            break
    return np.array(chosen)


def parts_of(points, segment):
    """The edges that a segment is made of: between the distinct points on it."""
    a, b = (points[i] for i in segment)
    on = {
        tuple(p)
        for p in points.tolist()
        if turn(a, b, p) == 0 and min(tuple(a), tuple(b)) <= tuple(p) <= max(tuple(a), tuple(b))
    }
    return list(pairs(sorted(on)))


def check(points, segments, mesh):
    """All that the definition says, but the order of rows."""
    points = np.asarray(points, np.float64)
    corners = mesh.triangles
    assert (areas(points, corners) > 0).all()
    plain = flaunay.triangulate(points)
    assert len(corners) == len(plain.triangles) and np.array_equal(mesh.hull, plain.hull)
    check_neighbors(corners, mesh.neighbors)
    # Exactly the parts of the segments are constraints, and each is an edge.
    expected = {part for segment in segments for part in parts_of(points, segment)}
    found = [tuple(map(tuple, points[edge].tolist())) for edge in mesh.constraint_edges]
    assert len(found) == len(set(found)) and set(found) == expected
    edges = {tuple(edge) for edge in mesh.edges.tolist()}
    assert (
        len(corners) == 0
        or {tuple(sorted(edge)) for edge in mesh.constraint_edges.tolist()} <= edges
    )
    is_constraint = {frozenset(edge) for edge in mesh.constraint_edges.tolist()}
    for t, row in enumerate(corners.tolist()):
        for k in range(3):
            edge = frozenset((row[(k + 1) % 3], row[(k + 2) % 3]))
            assert mesh.constrained[t, k] == (edge in is_constraint)
            beyond = mesh.neighbors[t, k]
            if beyond < 0 or edge in is_constraint:
                continue
            opposite = next(p for p in corners[beyond].tolist() if p not in edge)
            assert not in_circle(*points[row], points[opposite])
    # Each segment is mapped to its edges, in order, and each edge to the first segment that has it.
    owners = {}
    for s, segment in enumerate(segments):
        chain = [tuple(map(tuple, edge.tolist())) for edge in points[mesh.edges_of(s)]]
        assert chain == parts_of(points, segment)
        for part in chain:
            owners.setdefault(part, s)
    assert [owners[edge] for edge in found] == mesh.edge_segments.tolist()


def test_a_square_has_the_diagonal_that_it_is_given():
    for diagonal in [0, 2], [2, 0], [1, 3]:
        mesh = flaunay.triangulate(SQUARE, segments=[diagonal])
        assert sorted(mesh.constraint_edges[0]) == sorted(diagonal)
        check(SQUARE, [diagonal], mesh)
        assert (
            repr(mesh)
            == "<flaunay.ConstrainedTriangulation: 4 points, 2 triangles, 1 constraint edge>"
        )


@pytest.mark.parametrize("seed", range(12))
def test_random_segments(seed):
    random = np.random.default_rng(seed)
    # On a small grid almost everything is degenerate, and some points are equal.
    points = random.integers(0, 7, (30, 2)).astype(float) if seed % 2 else random.random((40, 2))
    segments = uncrossed(random, points, 15)
    check(points, segments, flaunay.triangulate(points, segments))


def test_neither_order_nor_direction_of_segments_matters(random):
    points = random.random((60, 2))
    segments = uncrossed(random, points, 20)
    mesh = flaunay.triangulate(points, segments)
    for other in segments[::-1], segments[:, ::-1], np.repeat(segments, 3, axis=0):
        again = flaunay.triangulate(points, other)
        assert np.array_equal(again.triangles, mesh.triangles)
        assert np.array_equal(again.constraint_edges, mesh.constraint_edges)


def test_without_segments_it_is_the_delaunay_triangulation(random):
    points = random.random((500, 2))
    plain = flaunay.triangulate(points, halfedges=True)
    for segments in [], np.empty((0, 2), int), flaunay.Delaunay(points).edges:
        mesh = flaunay.triangulate(points, segments, halfedges=True)
        for name in "triangles", "neighbors", "halfedges", "hull", "representatives":
            assert np.array_equal(getattr(mesh, name), getattr(plain, name))
    assert mesh.constrained.all() and len(mesh.constraint_edges) == len(mesh.edges)


@pytest.mark.parametrize("kind", [np.int8, np.uint16, np.int32, np.int64, list, tuple])
def test_segments_of_any_integer_type(random, kind):
    points = random.random((50, 2))
    segments = uncrossed(random, points, 10)
    given = kind(segments.tolist()) if kind in (list, tuple) else segments.astype(kind)
    expected = flaunay.triangulate(points, segments)
    assert np.array_equal(flaunay.triangulate(points, given).triangles, expected.triangles)


def test_segments_of_other_libraries(random):
    pandas = pytest.importorskip("pandas")
    points = random.random((50, 2)).astype(np.float32)
    segments = uncrossed(random, points.astype(float), 10)
    expected = flaunay.triangulate(points, segments)
    assert expected.points.dtype == np.float64 and np.array_equal(expected.points, points)
    frame = pandas.DataFrame(segments, columns=["from", "to"])
    mesh = flaunay.triangulate(pandas.DataFrame(points), segments=frame)
    assert np.array_equal(mesh.triangles, expected.triangles)
    strided = flaunay.triangulate(points[::-1][::-1], np.asfortranarray(segments))
    assert np.array_equal(strided.triangles, expected.triangles)


def test_many_sets_are_what_each_is_alone(random):
    sizes = [0, 20, 3, 1, 40, 2]
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    points = random.random((offsets[-1], 2))
    of_sets = [
        uncrossed(random, points[a:b], 6) if b - a > 1 else np.empty((0, 2), int)
        for a, b in pairs(offsets)
    ]
    segments = np.concatenate([some + a for some, a in zip(of_sets, offsets)])
    mesh = flaunay.triangulate(points, segments, offsets=offsets)
    for s, (a, b) in enumerate(pairs(offsets)):
        alone = flaunay.triangulate(points[a:b], of_sets[s])
        first, last = mesh.triangle_offsets[s : s + 2]
        assert as_set(mesh.triangles[first:last] - a) == as_set(alone.triangles)
        mine = (mesh.constraint_edges >= a).all(axis=1) & (mesh.constraint_edges < b).all(axis=1)
        assert as_set(mesh.constraint_edges[mine] - a) == as_set(alone.constraint_edges)


def test_points_on_one_line_have_constraints_but_no_triangles():
    mesh = flaunay.triangulate([[0, 0], [2, 2], [1, 1], [1, 1]], segments=[[1, 0], [2, 3]])
    assert len(mesh.triangles) == 0 and mesh.constraint_edges.tolist() == [[0, 2], [2, 1]]
    assert mesh.edges_of(0).tolist() == [[0, 2], [2, 1]] and len(mesh.edges_of(1)) == 0
    assert mesh.edges.shape == (0, 2) and mesh.areas.shape == (0,)
    with pytest.raises(IndexError, match="2 is none of the 2 segments"):
        mesh.edges_of(2)


def test_points_are_a_copy(random):
    points = random.random((10, 2))
    mesh = flaunay.triangulate(points, segments=[[0, 1]])
    assert mesh.points is not points and not np.shares_memory(mesh.points, points)
    assert len(mesh.added_points) == 0 and mesh.added_offsets.tolist() == [0, 0]


def test_optional_arrays(random):
    points = random.random((10, 2))
    mesh = flaunay.triangulate(points, [[0, 1]], neighbors=False)
    assert mesh.neighbors is None and mesh.halfedges is None
    assert mesh.depths is None and mesh.regions is None
    out = {"triangles": np.empty((20, 3), np.int32)}
    written = flaunay.triangulate(points, [[0, 1]], out=out)
    assert np.shares_memory(written.triangles, out["triangles"])
    assert np.array_equal(written.triangles, mesh.triangles)


def test_pickling_keeps_everything(random):
    points = random.random((30, 2))
    mesh = flaunay.triangulate(points, uncrossed(random, points, 5))
    copy = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(copy.triangles, mesh.triangles)
    assert np.array_equal(copy.constraint_edges, mesh.constraint_edges)
    assert np.array_equal(copy.edges_of(3), mesh.edges_of(3))


# ---- Crossings that are split


def check_split(points, segments, mesh):
    """Segments are chains between their ends, near them; what they are made of decides the triangles."""
    n = len(points)
    assert np.array_equal(mesh.points[:n], points)
    assert np.array_equal(mesh.points[n:], mesh.added_points)
    size = np.abs(points).max()
    for s, (a, b) in enumerate(segments):
        edges = mesh.edges_of(s)
        ends, counts = np.unique(edges, return_counts=True)
        ends_of_chain = {tuple(mesh.points[i]) for i in ends[counts == 1]}
        assert ends_of_chain == ({tuple(points[a]), tuple(points[b])} if len(edges) else set())
        # No point is farther from the segment than the bound of the definition, by a wide margin.
        along = points[b] - points[a]
        length = np.hypot(*along)
        away = mesh.points[ends] - points[a]
        assert (
            np.abs(along[0] * away[:, 1] - along[1] * away[:, 0]) <= 2**-46 * size * length
        ).all()
    edges = mesh.points[mesh.constraint_edges]
    assert not any(cross(*one, *other) for k, one in enumerate(edges) for other in edges[:k])
    again = flaunay.triangulate(mesh.points, mesh.constraint_edges)
    assert as_set(again.triangles) == as_set(mesh.triangles)
    assert (mesh.triangles.min(axis=1) == mesh.triangles[:, 0]).all()
    assert (areas(mesh.points, mesh.triangles) > 0).all()
    assert len(mesh.representatives) == len(mesh.points)


def test_a_crossing_becomes_a_point():
    mesh = flaunay.triangulate(SQUARE, [[0, 2], [3, 1]], crossings="split", labels=True)
    assert mesh.added_points.tolist() == [[0.5, 0.5]] and len(mesh.triangles) == 4
    assert mesh.piece_offsets.tolist() == [0, 2, 4] and len(mesh.piece_edges) == 4
    assert [mesh.edges_of(s).tolist() for s in range(2)] == [[[0, 4], [4, 2]], [[3, 4], [4, 1]]]
    assert sorted(mesh.edge_segments.tolist()) == [0, 0, 1, 1]
    assert len(np.unique(mesh.regions)) == 4 and (mesh.depths == 0).all()
    check_split(SQUARE, [[0, 2], [3, 1]], mesh)


@pytest.mark.parametrize("seed", range(6))
def test_random_segments_that_cross(seed):
    random = np.random.default_rng(seed)
    points = random.integers(0, 9, (25, 2)).astype(float) if seed % 2 else random.random((30, 2))
    segments = np.array([random.choice(len(points), 2, replace=False) for _ in range(15)])
    mesh = flaunay.triangulate(points, segments, crossings="split")
    assert len(mesh.added_points) > 5
    check_split(points, segments, mesh)


def test_crossings_of_several_sets():
    points = np.concatenate([SQUARE, 3 * SQUARE + 7, SQUARE])
    segments = [[0, 2], [4, 6], [1, 3], [5, 7], [8, 9]]
    mesh = flaunay.triangulate(points, segments, offsets=[0, 4, 8, 12], crossings="split")
    assert mesh.added_points.tolist() == [[0.5, 0.5], [8.5, 8.5]]
    assert mesh.added_offsets.tolist() == [0, 1, 2, 2]
    assert mesh.triangle_offsets.tolist() == [0, 4, 8, 10]
    assert (mesh.triangles[:4] == 12).any(axis=1).all()
    assert (mesh.triangles[4:8] == 13).any(axis=1).all()
    assert (mesh.triangles.min(axis=1) == mesh.triangles[:, 0]).all()
    assert (areas(mesh.points, mesh.triangles) > 0).all()


# ---- What is kept


def squares(*sizes):
    """Squares around the origin, and their sides."""
    points = np.concatenate([size * (2 * SQUARE - 1) for size in sizes])
    first = 4 * np.arange(len(sizes))[:, None, None]
    segments = first + np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
    return points, segments.reshape(-1, 2)


def middles(mesh):
    return mesh.points[mesh.triangles].mean(axis=1)


def test_what_is_outside_and_in_holes_is_left_out():
    points, segments = squares(1, 2)
    points = np.concatenate([points, [[9, 0]]])
    keep = flaunay.triangulate(points, segments)
    hull = flaunay.triangulate(points, segments, outside="hull")
    holes = flaunay.triangulate(points, segments, outside="holes", halfedges=True)
    assert keep.areas.sum() == 30 and hull.areas.sum() == 16 and holes.areas.sum() == 12
    assert len(holes.triangles) == 8 and as_set(holes.triangles) < as_set(hull.triangles)
    assert as_set(hull.triangles) < as_set(keep.triangles)
    check_neighbors(holes.triangles, holes.neighbors)
    assert ((holes.neighbors < 0).sum(), (holes.halfedges < 0).sum()) == (8, 8)
    assert np.array_equal(holes.hull, keep.hull)
    # Only what has triangles has edges.
    assert 8 not in holes.edges and 8 in keep.edges


def test_a_hole_is_what_is_around_a_place():
    points, segments = squares(1, 2)
    inner = flaunay.triangulate(points, segments, holes=[[0, 0]])
    assert inner.areas.sum() == 12
    outer = flaunay.triangulate(points, segments, [[1.5, 0]])
    assert outer.areas.sum() == 4
    both = flaunay.triangulate(points, segments, [[1.5, 0], [0, 0.5]])
    assert len(both.triangles) == 0 and both.triangle_offsets.tolist() == [0, 0]
    with pytest.raises(flaunay.InputError, match="hole"):
        flaunay.triangulate(points, segments, [[1, 0.5]])
    with pytest.raises(flaunay.InputError, match="hole"):
        flaunay.triangulate(points, segments, [[5, 5]])


def test_holes_of_several_sets():
    points, segments = squares(1, 2)
    mesh = flaunay.triangulate(
        np.concatenate([points, points]),
        np.concatenate([segments, segments + 8]),
        [[1.5, 0], [0, 0]],
        offsets=[0, 8, 8, 16],
        hole_offsets=[0, 1, 1, 2],
    )
    first = mesh.triangle_offsets
    assert [mesh.areas[a:b].sum() for a, b in pairs(first)] == [4, 0, 12]


@pytest.mark.parametrize("rule", ["nesting", "even_odd", "winding"])
def test_depths_and_regions(rule):
    points, segments = squares(1, 2, 3, 4)
    mesh = flaunay.triangulate(points, segments, fill_rule=rule, labels=True)
    nesting = 4 - (np.abs(middles(mesh)).max(axis=1) // 1).astype(int)
    expected = {"nesting": nesting, "even_odd": nesting % 2, "winding": nesting}[rule]
    assert np.array_equal(mesh.depths, expected)
    # Regions are numbered by their first triangles.
    _, places = np.unique(nesting, return_index=True)
    numbers = {nesting[place]: k for k, place in enumerate(sorted(places))}
    assert mesh.regions.tolist() == [numbers[depth] for depth in nesting.tolist()]
    kept = flaunay.triangulate(points, segments, fill_rule=rule, outside="holes")
    assert kept.areas.sum() == {"nesting": 40, "even_odd": 40, "winding": 64}[rule]


def test_the_direction_of_segments_decides_what_winds():
    points, segments = squares(1, 2)
    segments[:4] = segments[:4, ::-1]
    options = {"fill_rule": "winding", "outside": "holes"}
    assert flaunay.triangulate(points, segments, **options).areas.sum() == 12
    with pytest.raises(flaunay.InputError):
        flaunay.triangulate(points, segments[:7], **options)


def test_markers_are_carried():
    points, segments = squares(1, 2)
    points = np.concatenate([points, [[-2, 0.5], [2, 0.5]]])
    across = np.concatenate([segments, [[8, 9]]])
    options = {"crossings": "split", "segment_markers": np.arange(9) * -5}
    mesh = flaunay.triangulate(points, across, **options, point_markers=range(100, 110))
    assert np.array_equal(mesh.edge_markers, options["segment_markers"][mesh.edge_segments])
    assert mesh.edge_markers.dtype == mesh.vertex_markers.dtype == np.int32
    added = mesh.vertex_markers[10:]
    assert mesh.vertex_markers[:10].tolist() == list(range(100, 110)) and len(added) == 2
    # Of the square, whose segments come first.
    assert set((-added // 5).tolist()) <= set(range(8)) and len(mesh.added_points) == 2
    plain = flaunay.triangulate(points, across, crossings="split")
    assert plain.edge_markers is plain.vertex_markers is plain.triangle_attributes is None


def test_regions_have_the_attributes_of_their_seeds():
    points, segments = squares(1, 2, 3)
    seeds = [[1.5, 0.25, 7.5], [0, 0, 1.0], [1.75, 0, -2.5]]
    mesh = flaunay.triangulate(points, segments, seeds=seeds)
    rings = np.abs(middles(mesh)).max(axis=1) // 1
    assert np.array_equal(mesh.triangle_attributes, np.array([1, -2.5, 0])[rings.astype(int)])
    for place, what in (([1, 0.5, 9], "on a constraint"), ([50, 0, 9], "in no triangle")):
        with pytest.raises(flaunay.InputError, match=f"seed 3 at .* is {what}"):
            flaunay.triangulate(points, segments, seeds=[*seeds, place])
    two = flaunay.triangulate(
        np.concatenate([points, points]),
        np.concatenate([segments, segments + 12]),
        offsets=[0, 12, 24],
        seeds=[[0, 0, 3]],
        seed_offsets=[0, 0, 1],
    )
    assert np.bincount(np.flatnonzero(two.triangle_attributes) >= two.triangle_offsets[1]).tolist() == [0, 2]


# ---- Beside other programs


@pytest.mark.parametrize("seed", range(5))
def test_as_triangle(seed):
    """Of points in general position there is one constrained Delaunay triangulation."""
    triangle = pytest.importorskip("triangle")
    random = np.random.default_rng(seed)
    points = random.random((200, 2))
    segments = uncrossed(random, points, 40)
    theirs = triangle.triangulate({"vertices": points, "segments": segments}, "pc")
    mesh = flaunay.triangulate(points, segments)
    assert as_set(mesh.triangles) == as_set(theirs["triangles"])


# ---- Errors


def test_crossing_segments_are_named():
    with pytest.raises(flaunay.InputError, match=r"segments .*0 .*1 .*cross near \(0\.5, 0\.5\)"):
        flaunay.triangulate(SQUARE, [[0, 2], [1, 3]])


@pytest.mark.parametrize(
    "segments, message",
    [
        ([0, 4], r"segments must have the shape \(k, 2\), not \(2,\); offsets"),
        ([[0, 1, 2]], r"segments must have the shape \(k, 2\), not \(1, 3\)"),
        ([[0.0, 1.0]], "segments must be integers, not float64"),
        ([["0", "1"]], "segments must be integers"),
        ([[0, 1], [2, 4]], r"segments\[1, 1\] = 4 is none of the 4 points"),
        ([[-1, 1]], r"segments\[0, 0\] = -1 is none"),
        ([[0, 2**40]], rf"segments\[0, 1\] = {2**40} is none"),
        ([[0], [1, 2]], "segments (are no array|must be integers)"),
        (np.ma.masked_equal([[0, 1]], 1), r"segments\[0, 1\] is masked"),
    ],
)
def test_segments_that_are_none(segments, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.triangulate(SQUARE, segments)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"crossings": "merge"}, "crossings must be one of 'error', 'split', not 'merge'"),
        ({"outside": None}, "outside must be one of 'keep', 'hull', 'holes', not None"),
        ({"fill_rule": "evenodd"}, "fill_rule must be one of 'nesting', 'even_odd', 'winding'"),
        ({"mode": "dwyer"}, "mode 'dwyer' has no segments"),
        ({"holes": [1, 1]}, r"holes must have the shape \(h, 2\), not \(2,\)"),
        ({"holes": [["a", "b"]]}, "holes must be real numbers"),
        ({"hole_offsets": [0, 1]}, "hole_offsets end with 1, but there are 0 holes"),
        ({"hole_offsets": [0, 0, 0]}, "hole_offsets are of 2 sets, but there are 1"),
        ({"holes": [[0.5, 0.2]], "offsets": [0, 4, 4]}, "holes of several sets need hole_offsets"),
        ({"seeds": [[1, 1]]}, r"seeds must have the shape \(s, 3\), not \(1, 2\)"),
        ({"seed_offsets": [0, 1]}, "seed_offsets end with 1, but there are 0 seeds"),
        ({"seeds": [[1, 1, 1]], "offsets": [0, 4, 4]}, "seeds of several sets need seed_offsets"),
        ({"segment_markers": [1, 2]}, r"segment_markers must have the shape \(1,\), not \(2,\)"),
        ({"point_markers": [1, 2, 3, 2**40]}, f"point_markers must be int32: {2**40} is too large"),
        ({"point_markers": [1.5] * 4}, "point_markers must be integers"),
    ],
)
def test_options_that_are_none(options, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.triangulate(SQUARE, [[0, 2]], **options)


@pytest.mark.parametrize(
    "options",
    [
        {"holes": [[0, 0]]},
        {"hole_offsets": [0, 0]},
        {"outside": "hull"},
        {"crossings": "split"},
        {"fill_rule": "winding"},
        {"labels": True},
        {"segment_markers": []},
        {"seeds": [[0, 0, 1]]},
    ],
)
def test_what_is_for_segments_needs_segments(options):
    with pytest.raises(flaunay.UsageError, match=f"{next(iter(options))} is for segments"):
        flaunay.triangulate(SQUARE, **options)


def test_a_segment_between_sets_is_an_error():
    with pytest.raises(flaunay.UsageError, match="set"):
        flaunay.triangulate(SQUARE, [[1, 2]], offsets=[0, 2, 4])


# ---- What needs a Delaunay triangulation


@pytest.mark.parametrize(
    "call",
    [
        flaunay.Delaunay,
        flaunay.Voronoi,
        flaunay.alpha_shape,
        flaunay.triangulate,
        lambda mesh: flaunay.relax(mesh, (0, 0, 1, 1)),
        lambda mesh: flaunay.voronoi_polygons(mesh, (0, 0, 1, 1)),
    ],
)
def test_calls_for_points_say_that_a_result_has_them(call):
    mesh = flaunay.triangulate(SQUARE, [[1, 3]])
    with pytest.raises(flaunay.UsageError, match="not one with constraints.*`points` has them"):
        call(mesh)
