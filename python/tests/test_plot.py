"""What is drawn on Matplotlib's axes."""

import numpy as np
import pytest

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
    angles = np.linspace(0, 2 * np.pi, 41)[:-1]
    rings = [r * np.stack([np.cos(angles), np.sin(angles)], axis=1) for r in (1, 1.2)]
    points = np.concatenate([*rings, [[2, 0], [2.2, 0], [3, 0]]])
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


def test_many_triangles_are_drawn_fast(random, axes):
    import time

    tri = flaunay.Delaunay(random.random((50_000, 2)))
    started = time.process_time()
    tri.plot(axes, linewidth=0.1)
    assert not is_blank(axes)
    # Measured 1.5 s; one artist for each triangle would take a minute.
    assert time.process_time() - started < 20
