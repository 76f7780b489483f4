"""Triangulations handed to other packages, and back."""

import numpy as np
import pytest

import flaunay


@pytest.fixture
def tri(random):
    return flaunay.Delaunay(random.random((200, 2)))


def test_matplotlib_has_the_triangles_and_neighbours(tri):
    theirs = tri.to_matplotlib()
    assert np.array_equal(theirs.triangles, tri.simplices)
    assert np.array_equal(theirs.x, tri.points[:, 0]) and np.array_equal(theirs.y, tri.points[:, 1])
    # Matplotlib's are opposite to the corner after the next one.
    assert np.array_equal(theirs.neighbors, np.roll(tri.neighbors, 1, axis=1))
    middles = tri.points[tri.simplices].mean(axis=1)
    assert np.array_equal(theirs.get_trifinder()(*middles.T), np.arange(tri.nsimplex))


def test_matplotlib_runs_no_triangulation_of_its_own(tri):
    assert not tri.to_matplotlib().is_delaunay


def test_matplotlib_takes_duplicates(random):
    points = random.integers(0, 5, (60, 2))
    tri = flaunay.Delaunay(points)
    assert np.array_equal(tri.to_matplotlib().triangles, tri.simplices)


def test_without_triangles_there_is_none_for_matplotlib():
    with pytest.raises(flaunay.UsageError, match="without triangles"):
        flaunay.Delaunay([[0, 0], [1, 1]]).to_matplotlib()


def test_meshio_round_trip(tri, tmp_path):
    meshio = pytest.importorskip("meshio")
    heights, numbers = tri.points.sum(axis=1), np.arange(tri.nsimplex)
    mesh = tri.to_meshio(point_data={"height": heights}, cell_data={"number": numbers})
    path = tmp_path / "mesh.vtk"
    mesh.write(path)
    back = meshio.read(path)
    # VTK has three coordinates.
    assert np.array_equal(back.points[:, :2], tri.points) and not back.points[:, 2:].any()
    assert np.array_equal(back.cells_dict["triangle"], tri.simplices)
    assert np.array_equal(back.point_data["height"], heights)
    assert np.array_equal(back.cell_data_dict["number"]["triangle"], numbers)


def test_meshio_has_copies(tri):
    pytest.importorskip("meshio")
    mesh = tri.to_meshio()
    mesh.points[:] = 0
    mesh.cells[0].data[:] = 0
    assert tri.points.any() and tri.simplices.any()


@pytest.mark.parametrize("name", ["point_data", "cell_data"])
def test_data_of_another_length_are_refused(tri, name):
    with pytest.raises(flaunay.UsageError, match=rf"{name}\['height'\] must have the shape"):
        tri.to_meshio(**{name: {"height": [1, 2, 3]}})


def test_pyvista_round_trip(tri, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    heights = tri.points.sum(axis=1)
    path = tmp_path / "surface.vtp"
    tri.to_pyvista(z=heights).save(path)
    back = pyvista.read(path)
    assert back.n_cells == tri.nsimplex
    assert np.array_equal(np.asarray(back.points), np.column_stack([tri.points, heights]))
    assert np.array_equal(back.faces.reshape(-1, 4)[:, 1:], tri.simplices)
    flat = tri.to_pyvista()
    hull = tri.points[tri.hull]
    x, y = hull.T
    assert flat.area == pytest.approx((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def test_other_heights_are_refused(tri):
    with pytest.raises(flaunay.UsageError, match=r"z must have the shape \(200,\), not \(3,\)"):
        tri.to_pyvista(z=[1, 2, 3])
