"""flaunay.Voronoi beside scipy.spatial.Voronoi."""

import numpy as np
import pytest
import scipy.spatial

import flaunay


def place(voronoi, vertex):
    return None if vertex < 0 else tuple(np.round(voronoi.vertices[vertex], 6))


def ridges(voronoi):
    """For each pair of points the ends of the ridge between them."""
    pairs = np.sort(voronoi.ridge_points, axis=1).tolist()
    ends = np.asarray(voronoi.ridge_vertices).tolist()
    return {tuple(pair): {place(voronoi, v) for v in both} for pair, both in zip(pairs, ends)}


@pytest.fixture
def points(random):
    # Far enough from each other for circumcentres that are the same to six places.
    grid = np.stack(np.meshgrid(np.arange(10.0), np.arange(10.0)), axis=-1).reshape(-1, 2)
    return grid + random.uniform(-0.3, 0.3, grid.shape)


def test_the_ridges_are_those_of_scipy(points):
    mine, theirs = flaunay.Voronoi(points), scipy.spatial.Voronoi(points)
    assert mine.ridge_points.dtype == theirs.ridge_points.dtype
    assert len(mine.vertices) == len(theirs.vertices)
    assert ridges(mine) == ridges(theirs)


def test_the_regions_are_those_of_scipy(points):
    mine, theirs = flaunay.Voronoi(points), scipy.spatial.Voronoi(points)

    def corners(voronoi, point):
        region = voronoi.regions[voronoi.point_region[point]]
        return -1 in region, {place(voronoi, v) for v in region}

    for point in range(len(points)):
        assert corners(mine, point) == corners(theirs, point)


def test_cells_are_counter_clockwise_around_their_points(points):
    vor = flaunay.Voronoi(points)
    for point, region in enumerate(vor.regions):
        assert (-1 in region) == vor.unbounded[point] == (point in vor.delaunay.hull)
        if not vor.unbounded[point]:
            x, y = (vor.vertices[region] - points[point]).T
            assert (x * np.roll(y, -1) - y * np.roll(x, -1) > 0).all()


def test_circumcentres_are_as_far_from_all_corners(points):
    vor = flaunay.Voronoi(points)
    corners = points[vor.delaunay.simplices]
    distances = np.linalg.norm(corners - vor.vertices[:, None], axis=2)
    np.testing.assert_allclose(distances, distances[:, :1].repeat(3, axis=1))


def test_the_cell_of_a_duplicate_is_its_twins():
    vor = flaunay.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2.5], [2, 0]])
    assert vor.point_region.tolist() == [0, 1, 2, 3, 1]
    assert vor.regions[4] == []


@pytest.mark.parametrize(
    "points", [np.empty((0, 2)), [[1.0, 2.0]], [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]]
)
def test_points_without_triangles(points):
    vor = flaunay.Voronoi(points)
    n = len(points)
    assert vor.vertices.shape == (0, 2) and vor.ridge_points.shape == vor.ridge_vertices.shape == (
        0,
        2,
    )
    assert vor.regions == [[]] * n
    assert vor.point_region.tolist() == [-1] * n
    assert vor.unbounded.tolist() == [True] * n and vor.npoints == n


def test_grids_have_ridges_without_length():
    x, y = np.meshgrid(np.arange(4.0), np.arange(4.0))
    vor = flaunay.Voronoi(np.stack([x.ravel(), y.ravel()], axis=1))
    assert len(vor.vertices) == 18
    assert len(np.unique(vor.vertices, axis=0)) == 9


def test_scipy_draws_it(points):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure = scipy.spatial.voronoi_plot_2d(flaunay.Voronoi(points))
    figure.canvas.draw()
    plt.close(figure)


def test_errors():
    with pytest.raises(flaunay.UsageError, match="shape"):
        flaunay.Voronoi([1.0, 2.0])
    with pytest.raises(flaunay.InputError, match="point 0 is not finite"):
        flaunay.Voronoi([[np.nan, 0.0]])
