"""Rasters and contours, beside SciPy."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.interpolate

import flaunay


def hills(points):
    x, y = np.asarray(points).T
    return 30 * np.sin(x / 9) + 20 * np.cos(y / 7)


def centres(shape, bounds):
    (rows, columns), (x0, y0, x1, y1) = shape, bounds
    x = x0 + (np.arange(columns) + 0.5) * (x1 - x0) / columns
    y = y1 - (np.arange(rows) + 0.5) * (y1 - y0) / rows
    return np.stack(np.meshgrid(x, y), axis=-1)


def test_raster_is_scipys_linear_interpolation(random):
    points = random.uniform(0, 100, (2000, 2))
    shape, bounds = (70, 90), (-5, 3, 99, 101)
    found = flaunay.Delaunay(points).raster(hills(points), shape, bounds)
    expected = scipy.interpolate.LinearNDInterpolator(points, hills(points))(centres(shape, bounds))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9)
    assert 0.8 < np.isfinite(found).mean() < 1


def test_raster_in_the_callers_array_and_by_a_device(random):
    points = random.integers(0, 30, (700, 2)) / 4
    z, tri = hills(points), flaunay.Delaunay(points)
    found = tri.raster(z, (40, 50))
    assert tri.raster(z, (40, 50), device="#0").tobytes() == found.tobytes()
    out = np.empty((40, 50))
    assert tri.raster(z, (40, 50), out=out) is out and out.tobytes() == found.tobytes()


def test_raster_of_constrained_triangles_and_long_edges():
    square = [[0, 0], [9, 0], [9, 9], [0, 9]]
    mesh = flaunay.triangulate(square, segments=[[0, 2]], neighbors=True)
    found = mesh.raster([0, 0, 0, 9], (9, 9))
    # The diagonal is a hard edge: the lower half is flat.
    assert (np.triu(found[::-1], 1) == 0).all() and found[0, 0] == 8
    assert np.isnan(mesh.raster([0, 0, 0, 9], (3, 3), max_edge=10)).all()
    assert (mesh.raster([0, 0, 0, 9], (3, 3), max_edge=10, fill_value=-1) == -1).all()


def test_points_removed_do_not_count(random):
    points = random.uniform(0, 10, (50, 2))
    tri = flaunay.Delaunay(points, incremental=True)
    tri.remove_points([3, 4])
    left = np.delete(points, [3, 4], axis=0)
    bounds = (2, 2, 8, 8)
    found = tri.raster(hills(points), (20, 20), bounds)
    assert found.tobytes() == flaunay.Delaunay(left).raster(hills(left), (20, 20), bounds).tobytes()


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"shape": (0, 4)}, "shape"),
        ({"shape": (4, 4), "bounds": (1, 0, 0, 1)}, "xmin < xmax"),
        ({"shape": (4, 4), "max_edge": -1}, "max_edge"),
        ({"shape": (4, 4), "out": np.empty((4, 5))}, "out"),
        ({"shape": (4, 4), "values": [1, 2]}, "values"),
    ],
)
def test_raster_says_what_is_wrong(arguments, message):
    tri = flaunay.Delaunay([[0, 0], [1, 0], [0, 1]])
    with pytest.raises(flaunay.UsageError, match=message):
        tri.raster(**{"values": [1, 2, 3], **arguments})


def test_several_sets_have_no_raster():
    points = [[0, 0], [1, 0], [0, 1]]
    sets = flaunay.triangulate(points * 2, offsets=[0, 3, 6], segments=[[0, 1]], neighbors=True)
    with pytest.raises(flaunay.UsageError, match="one set"):
        sets.raster([1] * 6, (2, 2))
    with pytest.raises(flaunay.UsageError, match="neighbors"):
        flaunay.triangulate(points, segments=[[0, 1]], neighbors=False).raster([1, 2, 3], (2, 2))
    with pytest.raises(flaunay.UsageError, match="bounds"):
        flaunay.Delaunay(np.empty((0, 2))).raster([], (2, 2))


def test_contours_lie_at_their_heights(random):
    points = random.uniform(0, 100, (3000, 2))
    z = hills(points)
    tri = flaunay.Delaunay(points)
    lines = tri.contours(z, [10, -20, 0, 10])
    assert set(lines.heights) == {-20, 0, 10} and (np.diff(lines.heights) >= 0).all()
    interpolate = flaunay.LinearInterpolator(tri, z)
    for height, line in lines:
        np.testing.assert_allclose(interpolate((line[1:] + line[:-1]) / 2), height, atol=1e-6)
    assert lines.closed.any() and not lines.closed.all()
    assert repr(lines) == f"<flaunay.Contours: {len(lines)} lines, {len(lines.points)} points>"
    one = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]]).contours([0, 4, 4], [1])
    assert repr(one) == "<flaunay.Contours: 1 line, 2 points>"
    assert len(lines.to_geojson()["features"]) == len(lines)
    assert lines[-1][0] == 10
    with pytest.raises(IndexError):
        lines[len(lines)]


def test_contours_say_what_is_wrong():
    tri = flaunay.Delaunay([[0, 0], [1, 0], [0, 1]])
    with pytest.raises(flaunay.UsageError, match="finite"):
        tri.contours([1, 2, 3], [np.nan])
    assert len(tri.contours([1, 2, np.nan], [1.5])) == 0
    assert len(tri.contours([1, 2, 3], [])) == 0
