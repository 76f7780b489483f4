"""Refined meshes."""

import pickle

import conftest
import numpy as np
import pytest
from conftest import circle, ring

import flaunay

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
RING = ring(4)


def angles(mesh):
    return conftest.angles(mesh.points, mesh.triangles)


def test_triangles_are_as_good_as_is_asked_for():
    mesh = flaunay.refine(
        SQUARE,
        RING,
        min_angle=30,
        max_area=0.1,
        segment_markers=[1, 2, 3, 4],
        point_markers=[9] * 4,
    )
    report = mesh.refinement
    assert angles(mesh).min() == pytest.approx(report.smallest_angle)
    assert angles(mesh).max() == pytest.approx(report.largest_angle)
    assert report.smallest_angle >= 30 - 1e-9 and mesh.areas.max() <= 0.1
    assert mesh.areas.sum() == pytest.approx(16)
    assert report.added_points == len(mesh.added_points) > 100 and report.rounds > 0
    assert len(report.bad_triangles) == len(report.excuses) == 0
    edges = mesh.edges_of(2)
    assert len(edges) > 5 and (mesh.points[edges][..., 1] == 4).all()
    inner = edges[1:, 0]
    assert (mesh.vertex_markers[inner] == 3).all() and (mesh.vertex_markers[:4] == 9).all()
    assert report.split_points == sum(len(mesh.edges_of(k)) - 1 for k in range(4))
    assert set(mesh.hull) == set(mesh.constraint_edges.ravel())


def test_all_entries_take_the_same_keywords():
    options = {"min_angle": 25, "max_area": 0.2}
    mesh = flaunay.refine(SQUARE, RING, **options)
    assert np.array_equal(flaunay.triangulate(SQUARE, RING, **options).triangles, mesh.triangles)
    polygon = flaunay.polygons([[SQUARE]], **options)
    assert polygon.areas.max() <= 0.2 and polygon.polygon_areas == pytest.approx([16])
    assert polygon.refinement.smallest_angle >= 25 - 1e-9
    # Points alone: up to their hull.
    hull = flaunay.triangulate(SQUARE, **options)
    assert isinstance(hull, flaunay.ConstrainedTriangulation) and len(hull.constraint_edges) == 0
    assert hull.areas.max() <= 0.2 and hull.areas.sum() == pytest.approx(16)
    assert flaunay.triangulate(SQUARE, RING).refinement is None
    assert flaunay.refine(SQUARE).refinement.added_points == 0


def test_a_function_of_places_for_many_domains():
    points = np.concatenate([np.array(SQUARE) + 10 * k for k in range(3)])
    segments = np.concatenate([np.array(RING) + 4 * k for k in range(3)])
    calls = []

    def areas_at(places):
        calls.append(len(places))
        return np.where(places[:, 0] < 12, 0.1, 1)

    meshes = flaunay.refine(points, segments, offsets=np.arange(0, 13, 4), areas_at=areas_at)
    # Once a round of each domain.
    assert 0 < len(calls) <= 3 * (meshes.refinement.rounds + 2)
    for k, wanted in enumerate([0.1, None, 1]):
        own = meshes.areas[meshes.triangle_offsets[k] : meshes.triangle_offsets[k + 1]]
        assert own.sum() == pytest.approx(16) and (wanted is None or wanted / 4 < own.max() <= wanted)
    with pytest.raises(ZeroDivisionError):
        flaunay.refine(points, segments, offsets=[0, 4, 8, 12], areas_at=lambda places: 1 / 0)


def test_smoothing():
    options = {"min_angle": 25, "max_area": 0.03}
    wheel, rim = circle(50), ring(50)
    plain = flaunay.refine(wheel * 3, rim, **options)
    mesh = flaunay.refine(wheel * 3, rim, smoothing_steps=5, **options)
    report = mesh.refinement
    assert angles(mesh).min(axis=1).mean() == pytest.approx(report.mean_angle)
    assert angles(plain).min(axis=1).mean() == pytest.approx(report.mean_angle_before)
    assert angles(plain).min() == pytest.approx(report.smallest_angle_before)
    assert report.mean_angle > report.mean_angle_before + 2 and plain.refinement.mean_angle == 0
    assert angles(mesh).min() >= 25 - 1e-9 and mesh.areas.max() <= 0.03
    assert mesh.areas.sum() == pytest.approx(plain.areas.sum())


def test_a_function_of_places():
    calls = []

    def areas_at(places):
        calls.append(len(places))
        assert places.shape == (len(places), 2) and places.dtype == np.float64
        return np.where(places[:, 0] < 2, 0.02, 0)

    mesh = flaunay.refine(SQUARE, RING, areas_at=areas_at)
    centroids = mesh.points[mesh.triangles].mean(axis=1)
    left = centroids[:, 0] < 2 - 1e-9
    assert mesh.areas[left].max() <= 0.02 and mesh.areas[~left].max() > 0.02
    assert 0 < len(calls) <= mesh.refinement.rounds + 2

    def fails(places):
        calls.append(len(places))
        if len(calls) == 3:
            raise KeyError("mine")
        return np.full(len(places), 1e-3)

    # It ends the call at once.
    calls.clear()
    with pytest.raises(KeyError, match="mine"):
        flaunay.refine(SQUARE, RING, areas_at=fails)
    assert len(calls) == 3
    calls.clear()
    with pytest.raises(KeyError, match="mine"):
        flaunay.polygons([[SQUARE]], areas_at=fails)
    assert len(calls) == 3
    with pytest.raises(flaunay.UsageError, match=r"shape \(\d+,\)"):
        flaunay.refine(SQUARE, RING, areas_at=lambda places: places)
    with pytest.raises(flaunay.UsageError, match=r"has returned -1.0 at \["):
        flaunay.refine(SQUARE, RING, areas_at=lambda places: -1)
    # New triangles of a round are tested before the function is asked again.
    assert 0.1 < flaunay.refine(SQUARE, RING, areas_at=lambda places: 0.5).areas.max() <= 0.5
    with pytest.raises(flaunay.UsageError, match="has returned nan"):
        flaunay.refine(SQUARE, RING, areas_at=lambda places: np.full(len(places), np.nan))
    # The triangulator is as it was.
    assert len(flaunay.refine(SQUARE, RING, max_area=1).triangles) >= 16


def test_a_mesh_is_refined_further():
    coarse = flaunay.refine(
        [*SQUARE, [2, 0], [2, 4]],
        [*RING, [4, 5]],
        seeds=[[1, 1, 7], [3, 3, 8]],
        segment_markers=[1, 2, 3, 4, 5],
        point_markers=[9] * 6,
    )
    assert flaunay.refine(coarse).triangles.tolist() == coarse.triangles.tolist()
    bounds = np.where(coarse.triangle_attributes == 7, 0.05, 0)
    mesh = flaunay.refine(coarse, triangle_areas=bounds, min_angle=25)
    left = mesh.triangle_attributes == 7
    assert mesh.areas[left].max() <= 0.05 < mesh.areas[~left].max()
    assert mesh.areas[left].sum() == pytest.approx(8)
    assert set(mesh.edge_markers) == {1, 2, 3, 4, 5} and set(mesh.vertex_markers) >= {0, 4, 5, 9}
    assert flaunay.refine(flaunay.Delaunay(SQUARE), triangle_areas=[0.1, 0.2]).areas.max() <= 0.2
    with pytest.raises(flaunay.UsageError, match="needs triangles"):
        flaunay.refine(SQUARE, triangle_areas=[1, 2])
    with pytest.raises(flaunay.UsageError, match="one set"):
        flaunay.refine(flaunay.refine(SQUARE, offsets=[0, 4, 4]))


def test_conforming_meshes_are_delaunay():
    points = [[0, 0], [4, 0], [4, 3], [0, 3], [1, 1], [3, 1.1], [2, 1.2], [2, 0.9]]
    mesh = flaunay.triangulate(points, [[4, 5]], conforming=True)
    assert len(mesh.added_points) > 0
    assert {frozenset(t) for t in mesh.triangles.tolist()} == {
        frozenset(t) for t in flaunay.Delaunay(mesh.points).simplices.tolist()
    }


def test_regions_kept_edges_and_limits():
    wall = [*SQUARE, [2, 0], [2, 4]]
    segments = [*RING, [4, 5]]
    mesh = flaunay.refine(
        wall,
        segments,
        seeds=[[1, 1, 7], [3, 3, 8]],
        seed_areas=[0.05, 0],
        kept_segments=[0, 0, 0, 0, 1],
    )
    good = np.ones(len(mesh.areas), bool)
    good[mesh.refinement.bad_triangles] = False
    assert mesh.areas[good & (mesh.triangle_attributes == 7)].max() <= 0.05 < mesh.areas[good].max()
    assert (
        set(mesh.refinement.excuses) == {"kept"}
        and len(mesh.edges_of(4)) == 1
        and len(mesh.edges_of(3)) > 2
    )
    kept = flaunay.refine(SQUARE, RING, max_area=0.1, keep_edges="all")
    assert kept.refinement.split_points == 0 and len(kept.constraint_edges) == 4
    assert set(kept.refinement.excuses) == {"kept"} and kept.refinement.added_points > 0
    few = flaunay.refine(SQUARE, RING, max_area=0.1, most_points=7)
    assert few.refinement.added_points <= 7
    assert "most_points" in few.refinement.excuses
    bad = few.refinement.bad_triangles
    assert (np.diff(bad) > 0).all() and (few.areas[bad] > 0.1).any()
    again = pickle.loads(pickle.dumps(few))
    assert np.array_equal(again.refinement.bad_triangles, bad)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"min_angle": 40}, "40"),
        ({"min_angle": "steep"}, "min_angle"),
        ({"max_area": -1}, "-1"),
        ({"keep_edges": "some"}, "keep_edges"),
        ({"kept_segments": [1, 0]}, "kept_segments"),
        ({"seed_areas": [1]}, "seed_areas"),
        ({"min_edge": -1}, "min_edge is -1"),
        ({"min_edge": np.inf}, "smallest edge is inf"),
        ({"most_points": -3}, "most_points"),
        ({"most_points": 2.5}, "most_points"),
        ({"smoothing_steps": -1}, "smoothing_steps"),
        ({"areas_at": 3}, "areas_at"),
    ],
)
def test_wrong_requests(options, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.refine(SQUARE, RING, **options)


def test_nothing_is_one_of_many_numbers():
    for limit in ("most_points", "most_rounds"):
        none = flaunay.refine(SQUARE, RING, max_area=0.1, **{limit: 0})
        assert none.refinement.added_points == 0 and set(none.refinement.excuses) == {limit}
    any_angle = flaunay.refine(SQUARE, RING, min_angle=0)
    assert any_angle.refinement.added_points == 0
    assert any_angle.refinement.smallest_angle == pytest.approx(45)
    assert any_angle.refinement.largest_angle == pytest.approx(90)


def test_unknown_keywords():
    with pytest.raises(TypeError, match="min_angel"):
        flaunay.triangulate(SQUARE, RING, min_angel=30)


def test_areas_at_may_query_other_meshes():
    rng = np.random.default_rng(5)
    coarse = flaunay.Delaunay(rng.random((50, 2)) * 1.2 - 0.1)
    interpolate = flaunay.LinearInterpolator(coarse, rng.random(50) / 50, extrapolate="nearest")
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]

    def areas_at(places):
        assert (coarse.find_simplex(places) >= -1).all()
        return interpolate(places)

    meshes = [flaunay.refine(square, areas_at=areas_at, device=device) for device in (None, "host")]
    wanted = interpolate(meshes[0].points[meshes[0].triangles].mean(axis=1))
    assert (meshes[0].areas <= wanted * (1 + 1e-9)).all() and len(wanted) > 50
    assert np.array_equal(meshes[0].triangles, meshes[1].triangles)
