"""What is drawn on Matplotlib's axes."""

import numpy as np
import pytest
from conftest import circle, grid, ring

import flaunay

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture
def axes():
    figure, axes = plt.subplots()
    yield axes
    plt.close(figure)


@pytest.fixture
def tri(random):
    return flaunay.Delaunay(random.random((100, 2)))


def pixels(axes):
    """The picture without labels."""
    axes.set_axis_off()
    axes.figure.canvas.draw()
    return np.asarray(axes.figure.canvas.buffer_rgba())


def is_blank(axes):
    picture = pixels(axes)
    return (picture == picture[0, 0]).all()


def test_edges_are_drawn_once_each(tri, axes):
    lines = tri.plot(axes)
    assert lines in axes.collections and lines.axes is axes
    assert np.array_equal(lines.get_segments(), tri.points[tri.edges])
    assert not is_blank(axes)
    # All of it is in sight.
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    assert left <= tri.min_bound[0] and right >= tri.max_bound[0]
    assert bottom <= tri.min_bound[1] and top >= tri.max_bound[1]


def test_style_goes_to_the_lines(tri, axes):
    lines = tri.plot(axes, color="red", linewidth=3, zorder=7)
    assert lines.get_linewidth() == [3] and lines.get_zorder() == 7
    assert np.array_equal(lines.get_color(), [[1, 0, 0, 1]])


def test_edges_can_be_coloured_by_a_value(tri, axes):
    lines = tri.plot(axes, array=tri.edge_lengths, cmap="viridis")
    assert np.array_equal(lines.get_array(), tri.edge_lengths)
    pixels(axes)
    assert len(np.unique(lines.get_color(), axis=0)) > 10


def test_without_axes_the_current_ones_are_taken(tri, axes):
    plt.sca(axes)
    assert tri.plot().axes is axes and axes.get_aspect() in (1.0, "equal")


def test_given_axes_keep_their_aspect(tri, axes):
    axes.set_aspect("auto")
    tri.plot(axes)
    assert axes.get_aspect() == "auto"


@pytest.mark.parametrize("points", [np.empty((0, 2)), [[1, 2]], [[0, 0], [1, 1]]])
def test_points_without_triangles_are_drawn_too(points, axes):
    tri = flaunay.Delaunay(points)
    assert len(tri.plot(axes).get_segments()) == max(len(points) - 1, 0)
    patch, lines, dots = flaunay.alpha_shape(tri, 0.1).plot(axes)
    assert len(dots.get_xdata()) == len(points) and len(lines.get_segments()) == 0
    pixels(axes)


def test_an_alpha_shape_is_an_area_with_holes_lines_and_dots(axes):
    points = np.concatenate([circle(40), circle(40, 1.2), [[2, 0], [2.2, 0], [3, 0]]])
    patch, lines, dots = flaunay.alpha_shape(points, 0.2).plot(axes, facecolor="red", alpha=1)
    assert len(lines.get_segments()) == 1 and dots.get_xydata().tolist() == [[3, 0]]
    assert patch in axes.patches and lines in axes.collections and dots in axes.lines
    assert len(patch.get_path().to_polygons(closed_only=True)) == 2
    picture = pixels(axes)

    def colour_at(x, y):
        column, row = axes.transData.transform((x, y)).astype(int)
        return picture[len(picture) - 1 - row, column, :3].tolist()

    assert colour_at(0, 1.1) == [255, 0, 0]
    assert colour_at(0, 0) == [255, 255, 255]


BOX = (0.2, 0.1, 0.9, 1.3)


def in_box(point, box=BOX):
    return box[0] <= point[0] <= box[2] and box[1] <= point[1] <= box[3]


def test_voronoi_edges_lie_between_two_points_and_end_at_the_box(random, axes):
    vor = flaunay.Voronoi(random.random((60, 2)))
    segments = np.array(vor.plot(axes, bounds=BOX).get_segments())
    middles = segments.mean(axis=1)
    distances = np.sort(np.linalg.norm(middles[:, None] - vor.points, axis=2), axis=1)
    np.testing.assert_allclose(distances[:, 0], distances[:, 1], rtol=1e-9)
    vertices = {tuple(v) for v in np.round(vor.vertices, 9)}
    low, high = np.array(BOX[:2]), np.array(BOX[2:])
    for end in segments.reshape(-1, 2):
        on_border = np.isclose(end, low).any() or np.isclose(end, high).any()
        assert on_border or tuple(np.round(end, 9)) in vertices
        assert (end >= low - 1e-12).all() and (end <= high + 1e-12).all()
    # All of the border that lies between two cells is met.
    around = np.concatenate([np.linspace(low, [low[0], high[1]], 2000)])
    cells = vor.delaunay.nearest(around)
    assert np.isclose(segments[..., 0], low[0]).sum() == np.count_nonzero(np.diff(cells))


def test_endless_edges_reach_a_box_far_away(axes):
    vor = flaunay.Voronoi([[0, 0], [1, 0], [0, 1], [3, 3], [1, 1]])
    segments = np.array(vor.plot(axes, bounds=(-1000, -900, 900, 1000)).get_segments())
    at_border = np.isin(segments[..., 0], (-1000, 900)) | np.isin(segments[..., 1], (-900, 1000))
    assert at_border.sum() == len(vor.delaunay.hull)


def test_without_bounds_all_points_are_in_sight(random, axes):
    vor = flaunay.Voronoi(random.random((50, 2)))
    lines = vor.plot(axes, color="red")
    assert np.array_equal(lines.get_color(), [[1, 0, 0, 1]])
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    assert all(in_box(point, (left, bottom, right, top)) for point in vor.points)
    assert right - left < 2 and top - bottom < 2
    assert not is_blank(axes)


@pytest.mark.parametrize("merge", [False, True])
def test_edges_without_length_are_not_drawn(axes, merge):
    lines = flaunay.Voronoi(grid(5), merge=merge).plot(axes, bounds=(0, 0, 4, 4))
    lengths = [np.abs(end - start).sum() for start, end in lines.get_segments()]
    assert len(lengths) == 40 and sum(lengths) == 32 and min(lengths) == 0.5


def test_points_on_one_line_have_lines_between_them(axes):
    vor = flaunay.Voronoi([[0, 0], [2, 0], [4, 0], [2, 0]])
    segments = [line.tolist() for line in vor.plot(axes, bounds=(-1, -1, 5, 1)).get_segments()]
    assert sorted(sorted(line) for line in segments) == [[[1, -1], [1, 1]], [[3, -1], [3, 1]]]


@pytest.mark.parametrize("points", [np.empty((0, 2)), [[1, 2]]])
def test_one_cell_has_no_edges(points, axes):
    assert flaunay.Voronoi(points).plot(axes).get_segments() == []
    pixels(axes)


@pytest.mark.parametrize("bounds", [(0, 0, 1), (0, 0, 0, 1), (0, 0, 1, np.nan), (0, 0, 1, np.inf)])
def test_bounds_that_are_none_are_refused(axes, bounds):
    with pytest.raises(flaunay.UsageError, match="bounds must be"):
        flaunay.Voronoi([[0, 0], [1, 0], [0, 1]]).plot(axes, bounds=bounds)


def test_endless_ridges_of_points_near_a_line_go_outwards(axes):
    """The centre of the hull cannot tell where that is, since it is rounded."""
    points = [[3, 1 + 3 * 2.0**-52], [7, 1], [8, 1 + 2 * 2.0**-52]]
    lines = flaunay.Voronoi(points).plot(axes, bounds=(0, 0, 10, 2)).get_segments()
    # Not between the first and the last, where a ridge begins far above.
    assert sorted(line[0, 0].round(6) for line in lines) == [5, 7.5]


FRAME = [[0, 0], [6, 0], [6, 6], [0, 6], [2, 2], [4, 2], [4, 4], [2, 4], [9, 3]]
SIDES = ring(4, 4)


def test_constraints_are_drawn_strongly_and_what_is_outside_is_not(axes):
    mesh = flaunay.triangulate(FRAME, SIDES, outside="holes")
    edges, constraints = mesh.plot(axes)
    assert len(edges.get_segments()) == 8 and len(constraints.get_segments()) == 8
    assert constraints.get_linewidth()[0] > 2 * edges.get_linewidth()[0]
    drawn = np.concatenate([*edges.get_segments(), *constraints.get_segments()])
    assert drawn.max() == 6
    assert {tuple(sorted(map(tuple, line))) for line in constraints.get_segments()} == {
        tuple(sorted(tuple(map(float, FRAME[i])) for i in side)) for side in SIDES
    }
    assert not is_blank(axes)


def test_the_style_of_constraints(axes):
    mesh = flaunay.triangulate(FRAME, SIDES)
    edges, constraints = mesh.plot(
        axes, color="blue", lw=2, constraint_color="red", constraint_linewidth=5
    )
    assert np.array_equal(constraints.get_color(), [[1, 0, 0, 1]])
    assert constraints.get_linewidth() == [5] and edges.get_linewidth() == [2]
    assert np.array_equal(edges.get_color(), [[0, 0, 1, 1]])


def test_polygons_are_drawn(axes):
    edges, constraints = flaunay.polygons([[FRAME[:4], FRAME[4:8]], []]).plot(axes)
    assert len(edges.get_segments()) == 8 and len(constraints.get_segments()) == 8
    edges, constraints = flaunay.polygons([]).plot(axes)
    assert len(edges.get_segments()) == len(constraints.get_segments()) == 0


def test_constrained_triangles_for_tripcolor(axes):
    mesh = flaunay.polygons([[FRAME[:4], FRAME[4:8]]])
    collection = axes.tripcolor(mesh.to_matplotlib(), mesh.areas)
    assert len(collection.get_array()) == 8 and not is_blank(axes)
    assert mesh.to_matplotlib().get_trifinder()(3, 3) == -1
