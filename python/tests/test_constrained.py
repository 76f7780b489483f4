"""Triangulations with segments as edges."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest
from conftest import areas, as_set, check_neighbors, fractions, orient, ring, uncrossed

import flaunay

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])


def pairs(values):
    """Each with the next one; itertools has it since Python 3.10."""
    values = list(values)
    return zip(values, values[1:])


def parts_of(points, segment):
    """The edges that a segment is made of: between the distinct points on it."""
    points = fractions(points)
    a, b = (points[i] for i in segment)
    on = {p for p in points if orient(a, b, p) == 0 and min(a, b) <= p <= max(a, b)}
    return list(pairs(sorted(on)))


def check(points, segments, mesh):
    """What the arrays of constraints say; that triangles are right is proved where the library is tested."""
    points = np.asarray(points, np.float64)
    corners = mesh.triangles
    check_neighbors(corners, mesh.neighbors)
    expected = {part for segment in segments for part in parts_of(points, segment)}
    found = [tuple(fractions(points[edge])) for edge in mesh.constraint_edges]
    assert len(found) == len(set(found)) and set(found) == expected
    of_edges = as_set(mesh.constraint_edges)
    assert len(corners) == 0 or of_edges <= set(map(tuple, mesh.edges.tolist()))
    for k in range(3):
        opposite = np.sort(corners[:, [(k + 1) % 3, (k + 2) % 3]]).tolist()
        assert mesh.constrained[:, k].tolist() == [tuple(edge) in of_edges for edge in opposite]
    # Each segment is mapped to its edges, in order, and each edge to the first segment that has it.
    owners = {}
    for s, segment in enumerate(segments):
        chain = [tuple(fractions(edge)) for edge in points[mesh.edges_of(s)]]
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


@pytest.mark.parametrize("seed", range(4))
def test_random_segments(seed):
    random = np.random.default_rng(seed)
    # On a small grid almost everything is degenerate, and some points are equal.
    points = random.integers(0, 7, (30, 2)).astype(float) if seed % 2 else random.random((40, 2))
    segments = uncrossed(random, points, 15)
    check(points, segments, flaunay.triangulate(points, segments))


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


@pytest.mark.parametrize("call", [flaunay.triangulate, flaunay.refine])
def test_copies_keep_everything_also_what_was_not_read_before(random, call):
    points = random.random((30, 2))
    mesh = call(points, uncrossed(random, points, 5), device="host")
    copies = pickle.loads(pickle.dumps(mesh)), copy.copy(mesh), dataclasses.replace(mesh)
    own = points.copy()
    points[:] = 0
    assert np.array_equal(mesh.points[:30], own)
    for field in dataclasses.fields(mesh):
        value = getattr(mesh, field.name)
        assert value is getattr(mesh, field.name) and field.name in dir(copies[0])
        assert [repr(getattr(one, field.name)) for one in copies] == 3 * [repr(value)]
    assert np.array_equal(copies[0].edges_of(3), mesh.edges_of(3))
    for one in (mesh, *copies):
        with pytest.raises(AttributeError, match="no attribute 'polygons'"):
            one.polygons


# ---- Crossings that are split


def test_a_crossing_becomes_a_point():
    mesh = flaunay.triangulate(SQUARE, [[0, 2], [3, 1]], crossings="split", labels=True)
    assert mesh.added_points.tolist() == [[0.5, 0.5]] and len(mesh.triangles) == 4
    assert mesh.piece_offsets.tolist() == [0, 2, 4] and len(mesh.piece_edges) == 4
    assert [mesh.edges_of(s).tolist() for s in range(2)] == [[[0, 4], [4, 2]], [[3, 4], [4, 1]]]
    assert sorted(mesh.edge_segments.tolist()) == [0, 0, 1, 1]
    assert len(np.unique(mesh.regions)) == 4 and (mesh.depths == 0).all()


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
    return points, np.array(ring(*[4] * len(sizes)))


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
        (np.array([[0, -1]], ">i2"), r"segments\[0, 1\] = -1 is none"),
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
