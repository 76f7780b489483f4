"""The calls of the package triangle. Numbers without an explanation are what that package returns."""

import conftest
import numpy as np
import pytest
from conftest import areas, as_set, check_neighbors, circle, ring

import flaunay
import flaunay.triangle as tr
from flaunay import _calls


BOX = {
    "vertices": [[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]],
    "vertex_markers": [0, 0, 33, 0, 0, 0, 0, 0],
    "segments": ring(4, 4),
    "segment_markers": [0, 5, 0, 0, 10, 0, 0, 0],
    "holes": [[1.5, 1.5]],
}
LETTER = {
    "vertices": [[0, 0], [1, 0], [1.6, 2], [3.4, 2], [4, 0], [5, 0], [3, 7], [2, 7]]
    + [[1.9, 3], [3.1, 3], [2.5, 5]],
    "segments": ring(8, 3),
    "holes": [[2.5, 4]],
}
FACE = {
    "vertices": np.concatenate(
        [circle(24, 10), circle(7, 2, (-4, 3)), circle(7, 2, (4, 3)), [[-5, -4], [0, -6], [5, -4]]]
    ),
    "segments": [*ring(24, 7, 7), [38, 39], [39, 40]],
    "holes": [[-4, 3], [4, 3]],
}
TURNS = np.linspace(0, 4 * np.pi, 30)[:, None]
SPIRAL = {"vertices": np.hstack([np.cos(TURNS), np.sin(TURNS)]) * (1 + TURNS)}


def angles(mesh):
    return conftest.angles(mesh["vertices"], mesh["triangles"])


def sizes(mesh):
    return areas(mesh["vertices"], mesh["triangles"]) / 2


def test_points_alone():
    square = {"vertices": [[0, 0], [0, 1], [1, 1], [1, 0]]}
    mesh = tr.triangulate(square)
    assert sorted(mesh) == ["triangles", "vertex_markers", "vertices"]
    assert mesh["vertex_markers"].tolist() == [[1]] * 4 and len(mesh["triangles"]) == 2
    mesh = tr.triangulate(square, "a0.2")
    assert mesh["vertices"][:4].tolist() == square["vertices"]
    assert sizes(mesh).max() <= 0.2 and sizes(mesh).sum() == pytest.approx(1)
    inside = ((mesh["vertices"] > 0) & (mesh["vertices"] < 1)).all(axis=1)
    assert 0 < inside.sum() and (mesh["vertex_markers"].ravel() == ~inside).all()
    # Parts of the hull are rounded, so that new ones are not on it.
    random = {"vertices": np.random.default_rng(2).random((200, 2))}
    mesh = tr.triangulate(random, "q30cD")
    assert angles(mesh).min() >= 30 - 1e-9 and angles(mesh)[opposite_to_segments(mesh)].max() <= 90
    assert len(mesh["segments"]) > len(tr.convex_hull(random["vertices"]))
    # Segments are for p.
    assert len(tr.triangulate(BOX)["triangles"]) == 8 + 2


def test_a_box_with_a_hole():
    mesh = tr.triangulate(BOX, "pen")
    assert len(mesh["triangles"]) == 8 and sizes(mesh).sum() == 8
    assert mesh["vertex_markers"].ravel().tolist() == [1, 5, 33, 1, 10, 10, 1, 1]
    marks = {
        tuple(sorted(ends)): mark
        for ends, mark in zip(mesh["segments"].tolist(), mesh["segment_markers"].ravel())
    }
    assert len(marks) == len(mesh["segments"]) == 8
    assert sorted(marks.values()) == [1, 1, 1, 1, 1, 1, 5, 10]
    assert marks[1, 2] == 5 and marks[4, 5] == 10
    assert len(mesh["edges"]) == len(mesh["edge_markers"]) == 16
    for ends, mark in zip(mesh["edges"].tolist(), mesh["edge_markers"].ravel()):
        assert mark == marks.get(tuple(ends), 0)
    check_neighbors(mesh["triangles"], mesh["neighbors"])
    assert mesh["holes"].tolist() == BOX["holes"]
    fine = tr.triangulate(BOX, "pqa0.1")
    assert angles(fine).min() >= 20 and sizes(fine).max() <= 0.1
    middle = (fine["vertices"][:, 0] == 3) & (fine["vertices"][:, 1] % 3 > 0)
    assert middle.any() and (fine["vertex_markers"][middle] == 5).all()
    assert sizes(tr.triangulate(BOX, "pO")).sum() == 9


def test_regions():
    wall = {
        "vertices": [[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [0, 2]],
        "segments": [*ring(6), [1, 4]],
        "regions": [[1, 1, 7, 0.05], [3, 1, 8, -1]],
    }
    mesh = tr.triangulate(wall, "paA")
    attributes, x = mesh["triangle_attributes"], mesh["vertices"][mesh["triangles"], 0].mean(axis=1)
    assert attributes.shape == (len(x), 1) and (attributes.ravel() == np.where(x < 2, 7, 8)).all()
    assert sizes(mesh)[x < 2].max() <= 0.05 < sizes(mesh)[x > 2].max()
    assert np.array_equal(mesh["regions"], wall["regions"])
    assert "triangle_attributes" not in tr.triangulate(wall, "pa")
    assert len(tr.triangulate(wall, "pA")["triangles"]) == 4
    # Those outside of all triangles count for nothing, as for Triangle.
    outside = {**wall, "regions": [[9, 9, 5, 0.01], *wall["regions"], [-1, 1, 6, 0.01]]}
    for switches in ("paA", "pA"):
        found, expected = tr.triangulate(outside, switches), tr.triangulate(wall, switches)
        for name in ("vertices", "triangles", "triangle_attributes"):
            assert np.array_equal(found[name], expected[name])
    only = tr.triangulate({**wall, "regions": [[9, 9, 5, 0.01]]}, "pA")
    assert len(only["triangles"]) == 4 and not only["triangle_attributes"].any()
    with pytest.raises(flaunay.InputError, match="seed 0 .* on a constraint"):
        tr.triangulate({**wall, "regions": [[2, 1, 5, 0.01]]}, "pA")
    # Again, with what is known of the triangles.
    again = tr.triangulate(mesh, "ra0.02")
    x = again["vertices"][again["triangles"], 0].mean(axis=1)
    assert (again["triangle_attributes"].ravel() == np.where(x < 2, 7, 8)).all()
    assert sizes(again).max() <= 0.02 and np.array_equal(
        again["vertices"][: len(mesh["vertices"])], mesh["vertices"]
    )


def test_the_letter_a():
    points = np.array(LETTER["vertices"])
    letter = {**LETTER, "vertex_attributes": np.stack([points @ [1, 2], points @ [0, 3]], axis=1)}
    for opts in ("pq30", "pq30a0.1D", "pq30D", "pq0D"):
        mesh = tr.triangulate(letter, opts)
        assert "q0" in opts or angles(mesh).min() >= 30 - 1e-9
        assert sizes(mesh).sum() == pytest.approx(15) and len(mesh["vertices"]) > 11
        # What is linear stays so.
        linear = mesh["vertices"] @ [[1, 0], [2, 3]]
        assert mesh["vertex_attributes"] == pytest.approx(linear, abs=1e-12)
        if "D" in opts:
            assert angles(mesh)[opposite_to_segments(mesh)].max() <= 90 + 1e-9
        else:
            assert angles(mesh)[opposite_to_segments(mesh)].max() > 90.1
    assert sizes(tr.triangulate(letter, "pq30a0.1D")).max() <= 0.1
    hull = tr.triangulate(LETTER, "pc")
    assert sizes(hull).sum() == pytest.approx(19.8) and len(hull["segments"]) == 11 + 1


def opposite_to_segments(mesh):
    segments = as_set(mesh["segments"])
    return np.array(
        [
            [tuple(sorted(np.delete(row, k).tolist())) in segments for k in range(3)]
            for row in mesh["triangles"]
        ]
    )


def test_a_face():
    whole = sizes(tr.triangulate(FACE, "p")).sum()
    for opts in ("pq10", "pq0D", "pq25D"):
        mesh = tr.triangulate(FACE, opts)
        assert sizes(mesh).sum() == pytest.approx(whole)
        # The mouth remains, and its markers are 0: it is no border.
        chain = mesh["segment_markers"].ravel() == 0
        places = mesh["vertices"][mesh["segments"][chain]]
        assert np.hypot(*(places[:, 0] - places[:, 1]).T).sum() == pytest.approx(2 * np.sqrt(29))
    assert angles(mesh).min() >= 25
    assert as_set(tr.delaunay(mesh["vertices"])) >= as_set(mesh["triangles"])


def test_a_spiral():
    for opts, least in (("", 0), ("q", 20), ("q32.5", 32.5), ("a.2", 0)):
        mesh = tr.triangulate(SPIRAL, opts)
        assert angles(mesh).min() >= least and np.array_equal(
            mesh["vertices"][:30], SPIRAL["vertices"]
        )
    assert sizes(mesh).max() <= 0.2


def test_refining_a_mesh():
    coarse = tr.triangulate(BOX, "p")
    fine = tr.triangulate(tr.triangulate(coarse, "rpa0.2"), "rpa0.05")
    assert sizes(fine).max() <= 0.05 and sizes(fine).sum() == pytest.approx(8)
    # The hole, which r does not read, is none of the triangles.
    del coarse["holes"]
    assert tr.triangulate(coarse, "rc")["segments"].shape == (8, 2)
    assert sizes(tr.triangulate(coarse, "rq")).sum() == pytest.approx(8)
    two = {"vertices": [[0, 0], [2, 0], [2, 2], [0, 2]], "triangles": [[0, 1, 2], [0, 2, 3]]}
    mesh = tr.triangulate({**two, "triangle_max_area": [0.1, -1]}, "ra")
    x, y = mesh["vertices"][mesh["triangles"]].mean(axis=1).T
    assert sizes(mesh)[x > y + 0.5].max() <= 0.1 < sizes(mesh)[x < y].max()


def test_limits_and_vertices_of_no_triangle():
    assert len(tr.triangulate(BOX, "pqa0.01S5")["vertices"]) == 8 + 5
    assert len(tr.triangulate(LETTER, "pq0DS3")["vertices"]) == 11 + 3
    assert len(tr.triangulate(BOX, "pa0.01S")["vertices"]) == 8
    whole = {"vertices": BOX["vertices"][:4], "segments": BOX["segments"][:4]}
    kept = tr.triangulate(whole, "pa0.1YY")
    assert len(kept["segments"]) == 4 and len(kept["vertices"]) > 4
    extra = {**BOX, "vertices": [[1.5, 1.4], *BOX["vertices"]]}
    extra["segments"] = np.array(BOX["segments"]) + 1
    del extra["vertex_markers"]
    assert len(tr.triangulate(extra, "p")["vertices"]) == 9
    jettisoned = tr.triangulate(extra, "pje")
    assert jettisoned["vertices"].tolist() == BOX["vertices"]
    assert as_set(jettisoned["segments"]) == as_set(BOX["segments"])
    assert as_set(jettisoned["segments"]) < as_set(jettisoned["edges"])


def test_six_nodes():
    attributes = np.arange(8)[:, None] ** 2
    for opts in ("po2", "pqejo2", "pqa0.1no2"):
        mesh = tr.triangulate({**BOX, "vertex_attributes": attributes}, opts)
        plain = tr.triangulate({**BOX, "vertex_attributes": attributes}, opts.replace("o2", "e"))
        without = set() if "e" in opts else {"edges", "edge_markers"}
        assert mesh.keys() == plain.keys() - without
        assert np.array_equal(mesh["triangles"][:, :3], plain["triangles"])
        n, corners, middles = len(plain["vertices"]), *np.hsplit(mesh["triangles"], 2)
        # Triangle's order: opposite to the first corner, to the second, to the third.
        for name in ("vertices", "vertex_attributes"):
            values = mesh[name]
            ends = [np.roll(values[corners], -k, axis=1) for k in (1, 2)]
            assert np.array_equal(values[middles], ends[0] / 2 + ends[1] / 2)
            assert np.array_equal(values[:n], plain[name])
        # One for each edge, with its marker.
        assert len(mesh["vertices"]) == n + len(plain["edges"])
        assert np.array_equal(mesh["vertex_markers"][n:], plain["edge_markers"])


def test_areas_by_place():
    seen = []

    def areas_at(places):
        seen.append(len(places))
        return np.where(places[:, 0] < 1, 0.01, 0)

    mesh = tr.triangulate(BOX, "pqu", areas_at=areas_at)
    x = mesh["vertices"][mesh["triangles"], 0].mean(axis=1)
    assert sizes(mesh)[x < 1].max() <= 0.01 < sizes(mesh)[x > 1.5].max() and max(seen) > 8
    with pytest.raises(ValueError, match="'u'.*areas_at"):
        tr.triangulate(BOX, "pq", areas_at=areas_at)
    with pytest.raises(ZeroDivisionError):
        tr.triangulate(BOX, "pu", areas_at=lambda places: 1 / 0)


def test_one_call_of_the_library_and_no_array_twice(monkeypatch):
    calls = []
    for name in ("triangulate", "triangulate_constrained"):
        function = getattr(_calls.library, name)
        monkeypatch.setattr(
            _calls.library, name, lambda *given, of=function: calls.append(of) or of(*given)
        )
    random = {"vertices": np.random.default_rng(3).random((50, 2))}
    for opts in ("", "en", "qe", "a0.1"):
        calls.clear()
        mesh = tr.triangulate(random, opts)
        assert len(calls) == 1 and all(rows.base is None for rows in mesh.values())
    calls.clear()
    tr.triangulate(BOX, "pqen")
    tr.triangulate(tr.triangulate(BOX, "p"), "rpa0.1")
    assert len(calls) == 3


def test_parts_of_the_border_that_meet():
    bow = {
        "vertices": [[0, 0], [1, 1], [0, 2], [2, 0], [2, 2], [5, 5], [6, 6]],
        "segments": [[0, 1], [1, 2], [2, 0], [1, 3], [3, 4], [4, 1], [5, 6]],
        "segment_markers": [4, 0, 2, 0, 0, 9, 8],
    }
    mesh = tr.triangulate(bow, "pe")
    # The segment outside is none of the mesh, but marks its vertices.
    marks = dict(zip(map(tuple, mesh["segments"].tolist()), mesh["segment_markers"].ravel()))
    assert marks == {(0, 1): 4, (2, 1): 1, (0, 2): 2, (1, 3): 1, (3, 4): 1, (1, 4): 9}
    assert mesh["vertex_markers"].ravel().tolist() == [4, 4, 2, 1, 9, 8, 8]
    edges = dict(zip(map(tuple, mesh["edges"].tolist()), mesh["edge_markers"].ravel()))
    assert edges == {tuple(sorted(ends)): mark for ends, mark in marks.items()}


def test_switches_that_change_nothing():
    plain = tr.triangulate(BOX, "pq30")
    for opts in ("-p q30.0", "XiFlsCQVVIzgvo1pq30", "pq30NEPB"):
        mesh = tr.triangulate(BOX, opts)
        assert all(np.array_equal(mesh[name], plain[name]) for name in plain)
    twenty = tr.triangulate(BOX, "pq20a0.1")
    assert np.array_equal(tr.triangulate(BOX, "pqa.1")["triangles"], twenty["triangles"])


@pytest.mark.parametrize(
    ("opts", "message"),
    [
        ("po3", "'o3'"),
        ("pu", "'u'.*areas_at"),
        ("pw", "'w'"),
        ("p3", "'3'"),
        ("pq35", "'q35'"),
        ("pa0", "'a0'"),
        ("pq1.2.3", "'q1.2.3'"),
        ("pDY", "'D'.*'Y'"),
        ("rp", "'r'"),
    ],
)
def test_wrong_switches(opts, message):
    with pytest.raises(ValueError, match=message):
        tr.triangulate(BOX, opts)


@pytest.mark.parametrize(
    ("members", "message"),
    [
        ({"vertices": [[0, 0], [1, 1]]}, "at least three vertices"),
        ({"segment": [[0, 1]]}, "'segment'"),
        ({"holes": [[0, 1, 2]]}, "holes must have 2 columns"),
        ({"vertex_markers": [1, 2]}, "vertex_markers must have as many rows"),
        ({"segments": [[0, 8]]}, "segments"),
    ],
)
def test_wrong_members(members, message):
    with pytest.raises(flaunay.UsageError, match=message):
        tr.triangulate({**BOX, "segment_markers": [], **members}, "p")


def test_delaunay_hull_and_voronoi():
    points = [[0, 0], [0, 1], [0.5, 0.5], [1, 1], [1, 0]]
    assert as_set(tr.delaunay(points)) == {(0, 1, 2), (2, 3, 4), (0, 2, 4), (1, 2, 3)}
    assert tr.convex_hull(points).tolist() == [[0, 4], [4, 3], [3, 1], [1, 0]]
    vertices, edges, origins, directions = tr.voronoi(points)
    assert sorted(vertices.tolist()) == [[0, 0.5], [0.5, 0], [0.5, 1], [1, 0.5]]
    assert len(edges) == 4 and sorted(origins) == [0, 1, 2, 3]
    # Rays leave the square.
    assert (directions == 2 * (vertices[origins] - 0.5)).all()
