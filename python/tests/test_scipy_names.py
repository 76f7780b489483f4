"""A changed import is enough: the classes by SciPy's names, beside SciPy's."""

import inspect
import pickle
import traceback

import numpy as np
import pytest
import scipy.interpolate
import scipy.spatial
from conftest import circle, grid

import flaunay

INTERPOLATORS = ["LinearNDInterpolator", "CloughTocher2DInterpolator", "NearestNDInterpolator"]


def both(name):
    return [getattr(package, name) for package in (flaunay, scipy.interpolate)]


@pytest.mark.parametrize("name", INTERPOLATORS)
@pytest.mark.parametrize("shape", [(), (2,), (2, 3)])
@pytest.mark.parametrize("rescale", [False, True])
def test_interpolators(random, name, shape, rescale):
    points, queries = random.random((500, 2)), random.random((30, 20, 2)) * 1.2 - 0.1
    values = random.random((500, *shape))
    mine, theirs = (kind(points, values, rescale=rescale)(queries) for kind in both(name))
    assert mine.shape == theirs.shape and mine.dtype == theirs.dtype
    # Gradients are estimated to a tolerance.
    tolerance = 1e-4 if name == "CloughTocher2DInterpolator" else 1e-11
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=tolerance)


@pytest.mark.parametrize("name", INTERPOLATORS[:2])
def test_what_fills_and_triangulations(random, name):
    points, values = random.random((100, 2)), random.random(100)
    mine, theirs = both(name)
    queries = [[0.5, 0.5], [3, 3]]
    expected = theirs(scipy.spatial.Delaunay(points), values, fill_value=-7)(queries)
    np.testing.assert_allclose(
        mine(flaunay.Delaunay(points), values, fill_value=-7)(queries), expected, atol=1e-4
    )
    assert expected[1] == -7


def test_the_nearest_has_the_arguments_of_scipys(random):
    points, values = random.random((100, 2)), np.arange(100)
    interpolators = [
        kind(x=points, y=values, tree_options={}) for kind in both("NearestNDInterpolator")
    ]
    queries = random.random((50, 2))
    mine, theirs = (interpolate(queries) for interpolate in interpolators)
    np.testing.assert_array_equal(mine, theirs)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(interpolators[0]))(queries), mine)
    np.testing.assert_array_equal(interpolators[0](queries, workers=1), mine)
    with pytest.raises(flaunay.UsageError, match="tree_options"):
        flaunay.NearestNDInterpolator(points, values, tree_options={"leafsize": 3})


@pytest.mark.parametrize("dtype", [np.int64, np.uint64, np.int16])
def test_integers_of_the_nearest_are_as_given(dtype):
    values = np.array([1, np.iinfo(dtype).max, 3], dtype)
    interpolate = flaunay.NearestNDInterpolator([[0, 0], [4, 0], [0, 4]], values)
    found = interpolate([[9, 0], [0, 9]])
    assert found.dtype == dtype and found.tolist() == values[1:].tolist()
    found = interpolate([[np.nan, 0], [0, 9]])
    assert np.isnan(found[0]) and found[1] == 3


@pytest.mark.parametrize("method", ["linear", "nearest", "cubic"])
def test_griddata_by_keywords(random, method):
    points, values = random.random((200, 2)), random.random((200, 2))
    xi = tuple(random.random((2, 40)))
    mine, theirs = (
        griddata(points=points, values=values, xi=xi, method=method, fill_value=9, rescale=True)
        for griddata in both("griddata")
    )
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-4)


def around(hull):
    """The corners from the smallest index on."""
    return np.roll(hull.vertices, -int(np.argmin(hull.vertices))).tolist()


@pytest.mark.parametrize("kind", ["random", "circle", "grid", "float32"])
def test_hulls(random, kind):
    points = {
        "random": random.random((1000, 2)) + 1000,
        "circle": circle(50, 1e-3),
        "grid": grid(7),
        "float32": random.random((300, 2)).astype(np.float32),
    }[kind]
    mine, theirs = flaunay.ConvexHull(points), scipy.spatial.ConvexHull(points)
    assert around(mine) == around(theirs)
    assert mine.area == pytest.approx(theirs.area) and mine.volume == pytest.approx(theirs.volume)
    for name in "npoints", "nsimplex", "ndim", "good":
        assert getattr(mine, name) == getattr(theirs, name)
    for name in "points", "min_bound", "max_bound":
        np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name))

    def facets(hull):
        edges = [tuple(sorted(edge)) for edge in hull.simplices.tolist()]
        opposite = [
            {point: edges[neighbor] for point, neighbor in zip(*rows)}
            for rows in zip(hull.simplices.tolist(), hull.neighbors.tolist())
        ]
        return dict(zip(edges, zip(opposite, hull.equations)))

    ours, others = facets(mine), facets(theirs)
    assert ours.keys() == others.keys()
    for edge, (opposite, equation) in ours.items():
        assert opposite == others[edge][0]
        np.testing.assert_allclose(equation, others[edge][1], atol=1e-9)


def test_hulls_are_exact():
    # The second point is in no edge, by less than a rounding error.
    tiny = 2.0**-60
    points = [[0, 0], [0.5, -tiny], [1, 0], [1, 1], [1, 0.5], [0, 1]]
    assert flaunay.ConvexHull(points).vertices.tolist() == [0, 1, 2, 3, 5]
    halves = np.outer([0, 0.5, 1], [0.1, 0.3])
    assert flaunay.ConvexHull([*halves, [9, 0]]).vertices.tolist() == [0, 3, 2]
    single = np.array([[0, 0], [0.1, 0.3], [0.2, 0.6], [9, 0]], np.float32)
    assert flaunay.ConvexHull(single).vertices.tolist() == [0, 3, 2]
    for scale in 1e-200, 1e200:
        hull = flaunay.ConvexHull(grid(3) * scale)
        assert hull.vertices.tolist() == [0, 2, 8, 6]
        assert hull.volume == 4 * scale * scale and hull.area == pytest.approx(8 * scale)


def test_hulls_of_few_points():
    line = flaunay.ConvexHull([[0, 0], [1, 1], [2, 2], [0, 0]])
    assert line.vertices.tolist() == [0, 2] and line.simplices.tolist() == [[0, 2], [2, 0]]
    assert line.volume == 0 and line.area == pytest.approx(4 * 2**0.5)
    for points, vertices in [(np.empty((0, 2)), []), ([[1, 2], [1, 2]], [0])]:
        hull = flaunay.ConvexHull(points)
        assert hull.vertices.tolist() == vertices and hull.nsimplex == 0 and hull.area == 0
        assert hull.equations.shape == (0, 3)


def test_hulls_that_grow(random):
    points = random.random((60, 2))
    mine, theirs = (
        kind(points[:30], incremental=True) for kind in (flaunay.ConvexHull, scipy.spatial.ConvexHull)
    )
    for hull in mine, theirs:
        hull.add_points(points[30:])
        hull.close()
    assert around(mine) == around(theirs)
    assert around(pickle.loads(pickle.dumps(mine))) == around(mine)
    with pytest.raises(flaunay.UsageError, match="not incremental"):
        mine.add_points(points)


@pytest.mark.parametrize("options", ["Qc", "QJ", "QG4"])
def test_options_that_change_hulls(options):
    with pytest.raises(flaunay.UsageError, match=options):
        flaunay.ConvexHull(grid(3), qhull_options=options)
    assert flaunay.ConvexHull(grid(3), qhull_options="Qt Pp").nsimplex == 4


def test_spheres(random):
    directions = random.normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    center = np.array([5.0, -2.0, 1.0])
    points = directions * 3 + center
    mine, theirs = (
        kind(points, radius=3, center=center)
        for kind in (flaunay.SphericalVoronoi, scipy.spatial.SphericalVoronoi)
    )
    theirs.sort_vertices_of_regions()
    mine.sort_vertices_of_regions()
    np.testing.assert_allclose(mine.calculate_areas(), theirs.calculate_areas(), rtol=1e-9)
    np.testing.assert_array_equal(mine.points, theirs.points)
    assert mine.radius == theirs.radius and (mine.center == theirs.center).all()
    distance, number = scipy.spatial.cKDTree(theirs.vertices).query(mine.vertices)
    assert distance.max() < 1e-9
    for i, (region, other) in enumerate(zip(mine.regions, theirs.regions)):
        assert sorted(number[region]) == sorted(other)
        np.testing.assert_allclose(mine.polygon(i), mine.vertices[region], atol=1e-12)


def test_wrong_spheres():
    for options, words in [
        (dict(radius=2), "point 0 is not on the sphere"),
        (dict(center=[0, 0, 2]), "point 1 is not on the sphere"),
        (dict(radius=0), "radius"),
        (dict(center=[0, 0]), "center"),
    ]:
        with pytest.raises(flaunay.UsageError, match=words):
            flaunay.SphericalVoronoi([[0, 0, 1.0], [0, 1, 0]], **options)
    axes = np.eye(3)
    for options, words in [
        (dict(radius="a"), "radius must be a number"),
        (dict(radius=10**400), "radius must be a number"),
        (dict(radius=np.nan), "radius must be a number above 0"),
        (dict(threshold=np.nan), "threshold must be a number of 0 or more"),
        (dict(threshold=None), "threshold must be a number"),
    ]:
        with pytest.raises(flaunay.UsageError, match=words):
            flaunay.SphericalVoronoi(axes, **options)
    with pytest.raises(flaunay.InputError, match="center is not finite"):
        flaunay.SphericalVoronoi(axes, center=[np.nan, 0, 0])
    with pytest.raises(flaunay.InputError, match="point 1 is not finite"):
        flaunay.SphericalVoronoi([[0, 0, 1], [np.nan, 0, 0]])
    for radius in 1, np.array(1.0):
        assert type(flaunay.SphericalVoronoi(axes, radius=radius).radius) is float
    assert type(flaunay.spherical(axes).voronoi.radius) is float
    assert np.isinf(flaunay.SphericalVoronoi(axes * 1e200, radius=1e200).areas).all()
    assert len(flaunay.SphericalVoronoi([[0, 0, 1.1], [0, 1, 0]], threshold=0.2).points) == 2


def test_public_names():
    for name in flaunay.__all__:
        public = getattr(flaunay, name)
        if inspect.isclass(public):
            assert public.__module__ == "flaunay", name
    try:
        flaunay.Delaunay([[np.nan, 0]])
    except flaunay.InputError as error:
        assert traceback.format_exception_only(type(error), error)[0].startswith("flaunay.InputError: ")
