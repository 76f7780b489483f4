"""Triangulations handed to other packages, and back."""

import dataclasses

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


@pytest.fixture
def plate():
    """Two parts with a common border, and a hole with a segment in it."""
    outer = [[0, 0], [4, 0], [8, 0], [8, 4], [4, 4], [0, 4]]
    hole = [[5, 1], [7, 1], [7, 3], [5, 3], [5.5, 2], [6.5, 2]]
    rings = [[k, (k + 1) % 6] for k in range(6)] + [[6 + k, 6 + (k + 1) % 4] for k in range(4)]
    return flaunay.refine(
        outer + hole,
        [*rings, [1, 4], [10, 11]],
        holes=[[6, 1.5]],
        seeds=[[1, 1, 20], [4.5, 0.5, 30]],
        segment_markers=[1] * 6 + [2] * 4 + [3, 4],
        point_markers=[5] * 12,
        labels=True,
        min_angle=30,
    )


def test_meshio_has_constraints_and_their_markers(plate):
    pytest.importorskip("meshio")
    names = np.arange(len(plate.triangles))
    mesh = plate.to_meshio(cell_data={"number": names, "area": plate.areas})
    triangles, lines = (block.data for block in mesh.cells)
    assert np.array_equal(triangles, plate.triangles)
    is_line = plate.edge_markers != 4
    assert np.array_equal(lines, plate.constraint_edges[is_line])
    assert np.array_equal(mesh.point_data["marker"], plate.vertex_markers)
    of_triangles, of_lines = mesh.cell_data["gmsh:physical"]
    assert np.array_equal(of_triangles, plate.triangle_attributes)
    assert np.array_equal(of_lines, plate.edge_markers[is_line])
    assert np.array_equal(mesh.cell_data["gmsh:geometrical"][0], plate.regions + 1)
    assert np.array_equal(mesh.cell_data["number"][0], names)
    assert np.isnan(mesh.cell_data["area"][1]).all()


def test_gmsh_files_have_groups(plate, tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "mesh.msh"
    plate.to_meshio().write(path, file_format="gmsh22")
    back = meshio.read(path)
    physical = back.cell_data_dict["gmsh:physical"]
    assert np.array_equal(physical["triangle"], plate.triangle_attributes)
    assert np.array_equal(np.unique(physical["line"]), [1, 2, 3])
    assert {*back.field_data} == {"marker 1", "marker 2", "marker 3", "part 20", "part 30"}


def test_gmsh_opens_the_files(plate, tmp_path):
    gmsh = pytest.importorskip("gmsh")  # 90 MB, so where it is installed
    path = tmp_path / "mesh.msh"
    plate.to_meshio().write(path, file_format="gmsh22")
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        assert gmsh.model.getPhysicalGroups() == [(1, 1), (1, 2), (1, 3), (2, 20), (2, 30)]
        nodes, _ = gmsh.model.mesh.getNodesForPhysicalGroup(2, 20)
        left = plate.triangles[plate.triangle_attributes == 20]
        assert np.array_equal(np.sort(nodes), np.unique(left) + 1)
        elements, _ = gmsh.model.mesh.getElementsByType(2)
        assert len(elements) == len(plate.triangles)
    finally:
        gmsh.finalize()


def test_groups_are_regions_or_polygons_without_whole_attributes(plate):
    pytest.importorskip("meshio")
    halves = dataclasses.replace(plate, triangle_attributes=plate.triangle_attributes / 40)
    assert np.array_equal(halves.to_meshio().cell_data["gmsh:physical"][0], plate.regions + 1)
    bare = flaunay.triangulate([[0, 0], [1, 0], [0, 1]], segments=[[0, 1]]).to_meshio()
    assert [data.tolist() for data in bare.cell_data["gmsh:physical"]] == [[1], [1]]
    without = flaunay.triangulate([[0, 0], [1, 0], [0, 1]], segments=[[0, 0]]).to_meshio()
    assert [block.type for block in without.cells] == ["triangle"]
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    map_of_two = flaunay.polygons([[square], [[[1, 0], [2, 0], [1, 1]]]], map=True).to_meshio()
    assert sorted(map_of_two.cell_data["gmsh:physical"][0]) == [1, 1, 2]


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
