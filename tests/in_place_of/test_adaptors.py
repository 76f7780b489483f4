"""The programs in examples/python/in_place_of: results are those of the packages with their own triangulations."""

import importlib
import pathlib
import re
import sys

import geopandas
import momepy
import numpy as np
import pytest
import shapely

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "examples/python/in_place_of"))


@pytest.fixture
def random():
    return np.random.default_rng(1)


@pytest.fixture(scope="module")
def buildings():
    return geopandas.read_file(momepy.datasets.get_path("bubenec"), layer="buildings")


def are_same(mine, theirs, tolerance):
    """Each shape with its counterpart."""
    assert (mine.index == theirs.index).all() and mine.crs == theirs.crs
    assert mine.is_valid.all()
    difference = shapely.area(shapely.symmetric_difference(mine.geometry.values, theirs.geometry.values))
    assert difference.max() <= tolerance


@pytest.mark.parametrize("clip", ["bounding_box", "convex_hull", "alpha_shape", None, "polygon"])
def test_libpysal(random, clip):
    import for_libpysal
    import libpysal

    points = random.random((200, 2))
    points[8] = points[7]
    clip = shapely.Point(0.5, 0.5).buffer(0.7) - shapely.Point(0.5, 0.5).buffer(0.1) if clip == "polygon" else clip
    mine, theirs = (
        package.voronoi_frames(points, clip=clip, return_input=False, as_gdf=False)
        for package in (for_libpysal, libpysal.cg)
    )
    # Equal points have the same cell, too.
    assert mine.geometry[7].equals(mine.geometry[8])
    # libpysal leaves cells outside as they are.
    are_same(mine, theirs.intersection(clip) if isinstance(clip, shapely.Geometry) else theirs, 1e-9)


def test_lines_of_libpysal(buildings):
    import for_libpysal
    import libpysal

    streets = geopandas.read_file(momepy.datasets.get_path("bubenec"), layer="streets")
    mine, theirs = (
        package.voronoi_frames(streets, segment=5, return_input=False, as_gdf=False)
        for package in (for_libpysal, libpysal.cg)
    )
    are_same(mine, theirs, 1e-3)


def test_graphs_of_libpysal(random):
    import for_libpysal
    import libpysal

    points = random.random((200, 2))
    assert for_libpysal.delaunay_graph(points).equals(libpysal.graph.Graph.build_triangulation(points))


@pytest.mark.parametrize("clip", ["bounding_box", "buffers"])
def test_momepy(buildings, clip):
    from for_momepy import morphological_tessellation

    clip = buildings.buffer(50) if clip == "buffers" else clip
    mine, theirs = (
        call(buildings, clip=clip, simplify=False)
        for call in (morphological_tessellation, momepy.morphological_tessellation)
    )
    # Coordinates are rounded to 1e-5 metres, and GEOS rounds the corners of cells.
    are_same(mine, theirs, 1e-3)


@pytest.mark.parametrize("kind", ["Linear", "Cubic"])
def test_verde(random, kind):
    import for_verde
    import verde

    coordinates = tuple(random.random((2, 300)) * 1000)
    values = np.sin(coordinates[0] / 200) + coordinates[1] / 500
    grids = [
        getattr(package, kind)().fit(coordinates, values).grid(spacing=20, data_names="values")
        for package in (for_verde, verde)
    ]
    # Gradients are estimated to a tolerance.
    np.testing.assert_allclose(grids[0]["values"], grids[1]["values"], rtol=0, atol=1e-4)
    chains = [
        verde.Chain([("mean", verde.BlockReduce(np.mean, 50)), ("grid", getattr(package, kind)())])
        for package in (for_verde, verde)
    ]
    mine, theirs = (chain.fit(coordinates, values).predict(coordinates) for chain in chains)
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-4)


@pytest.mark.parametrize("alpha", [3.0, 8.0, 20.0])
def test_alphashape(random, alpha):
    import alphashape
    from for_alphashape import alphashape as mine

    points = random.random((400, 2))
    points = points[np.hypot(*(points - 0.5).T) > 0.2]
    made = mine(points, alpha)
    assert made.is_valid and made.area < shapely.convex_hull(made).area
    # alphashape fills holes.
    filled = shapely.union_all([shapely.Polygon(part.exterior) for part in shapely.get_parts(made)])
    assert filled.symmetric_difference(alphashape.alphashape(points, alpha)).area < 1e-12
    assert mine(points, 0).equals(alphashape.alphashape(points, 0.0))
    for few in points[:1], points[[0, 0]], points[:2], points[[0, 1, 2]]:
        assert mine(few, alpha).equals(alphashape.alphashape(few, alpha))


def test_adaptive():
    import adaptive
    from for_adaptive import Learner2D

    def peak(place):
        x, y = place
        return x + np.exp(-((x * x + y * y - 0.75**2) ** 2) / 0.2**4)

    mine, theirs = (kind(peak, bounds=[(-1, 1), (-1, 1)]) for kind in (Learner2D, adaptive.Learner2D))
    for learner in mine, theirs:
        adaptive.runner.simple(learner, npoints_goal=300)
        assert learner.npoints == 300 and learner.loss() < 0.05
    # First points are on a lattice, whose squares have two triangulations; so both learners choose other points.
    same = adaptive.Learner2D(peak, bounds=[(-1, 1), (-1, 1)])
    for place, value in mine.data.items():
        same.tell(place, value)
    places = np.random.default_rng(2).uniform(-1, 1, (500, 2))
    assert np.abs(mine.interpolator()(places) - same.interpolator()(places)).mean() < 1e-3
    assert mine.interpolator()(places).shape == (500, 1)


@pytest.mark.parametrize("coarse", [False, True])
def test_sectionproperties(coarse):
    from for_sectionproperties import create_mesh
    from sectionproperties.analysis import Section
    from sectionproperties.pre.library import i_section, rectangular_hollow_section

    hollow = rectangular_hollow_section(d=100, b=60, t=6, r_out=15, n_r=8)
    beam = i_section(d=200, b=120, t_f=12, t_w=8, r=10, n_r=8)
    together = hollow + beam.shift_section(200, 0)
    with pytest.raises(ValueError, match="mesh_sizes"):
        create_mesh(hollow, [1, 2])
    for geometry, size in (hollow, 10), (beam, [20]), (together, [10, 20]):
        found = []
        for mesh in create_mesh, type(geometry).create_mesh:
            section = Section(mesh(geometry, size, coarse=coarse))
            section.calculate_geometric_properties()
            found.append([section.get_area(), *section.get_ic()])
            if geometry is not together:
                section.calculate_warping_properties()
                found[-1] += [section.get_j(), section.get_gamma()]
        # Exact but for rounding; and torsion, whose errors are those of the elements.
        assert found[0][:4] == pytest.approx(found[1][:4], rel=1e-9, abs=1e-6)
        assert found[0][4:] == pytest.approx(found[1][4:], rel=0.5 if coarse else 0.02)


def test_trimesh():
    import trimesh
    from for_trimesh import extrude_polygon

    polygon = shapely.Point(0, 0).buffer(3) - shapely.box(-1, -1, 1, 1)
    calls = extrude_polygon, trimesh.creation.extrude_polygon
    middles = [call(polygon, 2.0, mid_plane=True).bounds for call in calls]
    np.testing.assert_allclose(*middles, atol=1e-12)
    mine, theirs = (call(polygon, 2.0) for call in calls)
    assert mine.is_watertight and mine.is_volume and mine.euler_number == theirs.euler_number
    assert mine.volume == pytest.approx(theirs.volume) and mine.area == pytest.approx(theirs.area)
    assert mine.volume == pytest.approx(2 * polygon.area)


# What packages check themselves, with the names in their tests replaced.


@pytest.mark.parametrize(
    "tests, of_class, name, adaptor, chosen",
    [
        (
            *("libpysal.cg.tests.test_voronoi", "TestVoronoi", "voronoi_frames", "for_libpysal"),
            "from_array|from_polygons|clip_.*|union_fallback",
        ),
        (
            *("momepy.functional.tests.test_elements", "TestElements"),
            *("morphological_tessellation", "for_momepy"),
            # Not that of buildings that overlap.
            "morphological_tessellation(_buffer_clip|_simplify)?",
        ),
    ],
)
def test_their_own(monkeypatch, tests, of_class, name, adaptor, chosen):
    module = importlib.import_module(tests)
    mine = getattr(importlib.import_module(adaptor), name)
    for place in module, getattr(module, "mm", None):
        if hasattr(place, name):
            monkeypatch.setattr(place, name, mine)
    run = 0
    for method in dir(getattr(module, of_class)):
        if re.fullmatch(f"test_({chosen})", method):
            case = getattr(module, of_class)()
            case.setup_method()
            getattr(case, method)()
            run += 1
    assert run >= 3
