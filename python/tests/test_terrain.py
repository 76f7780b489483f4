"""Scans to maps; without the packages for files only what needs none."""

from __future__ import annotations

import json
import os
import warnings

import numpy as np
import pytest

import flaunay


def hills(x, y):
    return np.round(100 + 30 * np.sin(x / 9) + 20 * np.cos(y / 7), 2)


@pytest.fixture
def scan(random):
    """Points of a survey, to centimetres."""
    x, y = np.round(random.uniform([500000, 4500000], [500060, 4500040], (3000, 2)), 2).T
    return np.stack([x, y, hills(x - 500000, y - 4500000)], axis=1)


def write_las(path, points, epsg=None, offsets=(500000, 4500000, 0), classes=None, version="1.4"):
    laspy = pytest.importorskip("laspy")
    header = laspy.LasHeader(point_format=6 if version == "1.4" else 1, version=version)
    header.scales, header.offsets = [0.01] * 3, offsets
    if epsg is not None:
        crs = pytest.importorskip("rasterio.crs").CRS.from_epsg(epsg)
        record = laspy.VLR("LASF_Projection", 2112, "", crs.to_wkt().encode() + b"\0")
        header.vlrs.append(record)
    las = laspy.LasData(header)
    las.x, las.y, las.z = np.asarray(points).T
    las.return_number[:] = 1
    las.number_of_returns[:] = np.arange(len(points)) % 2 + 1
    las.classification[:] = 2 if classes is None else classes
    las.write(path)
    return path


def test_raster_is_that_of_the_triangulation(scan):
    made = flaunay.terrain(scan, resolution=2)
    assert made.bounds == (500000, 4500000, 500060, 4500040)
    tri = flaunay.Delaunay(scan[:, :2])
    np.testing.assert_array_equal(made.raster, tri.raster(scan[:, 2], (20, 30), made.bounds))
    point = flaunay.terrain(scan, resolution=2, pixel_is="point")
    assert point.bounds == (499999, 4499999, 500061, 4500041)
    assert repr(made) == "<flaunay.Terrain: 3000 points, 20 rows, 30 columns>"
    small = flaunay.terrain([[0, 0, 5], [1, 0, 9], [0, 1, 5]], resolution=1)
    assert repr(small) == "<flaunay.Terrain: 3 points, 1 row, 1 column>"
    assert set(made.contours(10).heights) == {10 * k for k in range(6, 15)}


@pytest.mark.parametrize("duplicates, expected", [("highest", 9), ("lowest", 1), ("mean", 4)])
def test_places_measured_several_times(duplicates, expected):
    points = [[0, 0, 9], [4, 0, 5], [0, 0, 1], [0, 4, 5], [0, 0, 2]]
    made = flaunay.terrain(points, resolution=4, pixel_is="point", duplicates=duplicates)
    assert made.raster[-1, 0] == expected


def test_files_of_text_and_npy(scan, tmp_path):
    expected = flaunay.terrain(scan, resolution=3)
    np.savetxt(tmp_path / "a.xyz", scan[:1000], fmt="%.2f", header="x y z")
    np.savetxt(tmp_path / "b.csv", scan[1000:1500], fmt="%.2f", delimiter=",")
    np.save(tmp_path / "c.npy", scan[1500:])
    (tmp_path / "notes.md").write_text("none of the points")
    assert flaunay.terrain(tmp_path, resolution=3).raster.tobytes() == expected.raster.tobytes()


def test_max_edge_leaves_gaps(scan):
    left = scan[np.abs(scan[:, 0] - 500030) > 8]
    made = flaunay.terrain(left, resolution=1, max_edge=6)
    columns = np.isnan(made.raster).mean(axis=0)
    assert (columns[25:35] == 1).all() and (columns[3:20] < 0.2).all()
    for _, line in made.contours(5):
        assert (np.abs(line[:, 0] - 500030) > 7).all()


def test_in_chunks_as_in_memory(scan, tmp_path):
    many = np.round(np.concatenate([scan, scan + [0.01, 0.02, 3], scan[:100] + [0, 0, 1]]), 2)
    np.save(tmp_path / "a.npy", many[:3000])
    np.savetxt(tmp_path / "b.xyz", many[3000:], fmt="%.2f")
    options = {"resolution": 0.5, "max_edge": 3, "duplicates": "mean"}
    expected = flaunay.terrain(many, **options)
    for points in (many, tmp_path):
        made = flaunay.terrain(points, memory="128M", scratch=tmp_path, **options)
        assert made.raster.tobytes() == expected.raster.tobytes()
        assert made.bounds == expected.bounds and made.mesh is None and len(made.heights) == 0
    with pytest.raises(flaunay.UsageError, match="memory="):
        made.contours(5)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"memory": "128M", "method": "natural"}, "memory="),
        ({"memory": "much"}, "memory"),
        ({"memory": "1M"}, "at least"),
        ({"resolution": 1e-5}, "pixels"),
        ({"resolution": 0}, "resolution"),
        ({"duplicates": "any"}, "duplicates"),
        ({"returns": "second"}, "returns"),
        ({"pixel_is": "cell"}, "pixel_is"),
        ({"bounds": (1, 2, 3)}, "bounds"),
        ({"classes": [2]}, "classes"),
        ({"output": "dem.jpg"}, "must end with"),
        ({"output": "lines.geojson"}, "contours="),
    ],
)
def test_what_is_wrong_is_said(scan, arguments, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.terrain(scan, **{"resolution": 1, **arguments})


def test_input_that_cannot_be_used(tmp_path):
    with pytest.raises(flaunay.InputError, match="no points"):
        flaunay.terrain(np.empty((0, 3)), resolution=1)
    with pytest.raises(flaunay.InputError, match="does not exist"):
        flaunay.terrain(tmp_path / "none.las", resolution=1)
    with pytest.raises(flaunay.InputError, match="no files"):
        flaunay.terrain(tmp_path, resolution=1)
    (tmp_path / "a.xyz").write_text("1 2 3\n1 2\n")
    with pytest.raises(flaunay.InputError, match="a.xyz"):
        flaunay.terrain(tmp_path, resolution=1)
    with pytest.raises(flaunay.UsageError, match="must end with"):
        (tmp_path / "a.dat").write_text("")
        flaunay.terrain(tmp_path / "a.dat", resolution=1)


def test_text_in_columns(scan, tmp_path):
    expected = flaunay.terrain(scan, resolution=2).raster.tobytes()
    path = tmp_path / "a.csv"
    rows = [f'P {k};{z};"{y}";{x}' for k, (x, y, z) in enumerate(scan.tolist())]
    text = "# survey\nname;h;n;e\n" + "\n".join(rows) + "\n"
    for decimal in ".", ",":
        path.write_text(text.replace(".", decimal))
        for columns in ("e", "n", "h"), (3, "n", 1):
            assert flaunay.terrain(path, resolution=2, columns=columns).raster.tobytes() == expected
    np.savetxt(path, scan, fmt="%.2f", delimiter=", ", header="x, y, z", comments="")
    assert flaunay.terrain(path, resolution=2).raster.tobytes() == expected
    np.savetxt(path, scan[:, ::-1], fmt="%.2f", delimiter=",", header="z,y,x", comments="")
    for columns in ("x", "y", "z"), (2, 1, 0):
        assert flaunay.terrain(path, resolution=2, columns=columns).raster.tobytes() == expected
    for line, message in (
        ("1,4 2,7 1,7\n", "semicolons"),
        ("1,4;2,7;1.5\n", "decimal"),
        ("1 2\n", "three numbers"),
        ("1 2 3\n4 5\n", "a.csv"),
    ):
        path.write_text(line)
        with pytest.raises(flaunay.InputError, match=message):
            flaunay.terrain(path, resolution=2)
    path.write_text("a;b;c\n1;2;3\n")
    with pytest.raises(flaunay.InputError, match="no column 'd'"):
        flaunay.terrain(path, resolution=2, columns=("a", "b", "d"))
    for columns in "abc", ("a", "b"):
        with pytest.raises(flaunay.UsageError, match="columns"):
            flaunay.terrain(path, resolution=2, columns=columns)
    with pytest.raises(flaunay.UsageError, match="columns"):
        flaunay.terrain(scan, resolution=2, columns=(0, 1, 2))
    np.save(tmp_path / "wide.npy", np.column_stack([scan[:, 2], np.zeros(3000), scan[:, :2]]))
    made = flaunay.terrain(tmp_path / "wide.npy", resolution=2, columns=(2, 3, 0))
    assert made.raster.tobytes() == expected
    with pytest.raises(flaunay.InputError, match="no column 4"):
        flaunay.terrain(tmp_path / "wide.npy", resolution=2, columns=(2, 4, 0))
    with pytest.raises(flaunay.InputError, match="no column 0.5"):
        flaunay.terrain(tmp_path / "wide.npy", resolution=2, columns=(2, 0.5, 0))
    np.save(tmp_path / "wide.npy", np.c_[scan, scan[:, 0]])
    again = flaunay.terrain(tmp_path / "wide.npy", resolution=2, columns=(0, 1, 2))
    np.testing.assert_array_equal(again.raster, made.raster)


def test_heights_of_fields(scan, tmp_path):
    geopandas = pytest.importorskip("geopandas")
    pytest.importorskip("pyogrio")
    shapely = pytest.importorskip("shapely")
    expected = flaunay.terrain(scan, resolution=2)
    places = geopandas.GeoSeries(shapely.points(scan[:, :2]), crs="EPSG:32633")
    table = geopandas.GeoDataFrame({"name": "p", "z": scan[:, 2]}, geometry=places)
    for name in "points.gpkg", "points.fgb", "points.geojson":
        table.to_file(tmp_path / name)
    table.iloc[:3].to_file(tmp_path / "points.gpkg", layer="some")
    for points in table, tmp_path / "points.fgb", tmp_path / "points.geojson", f"{tmp_path}/points.gpkg:points":
        made = flaunay.terrain(points, resolution=2, height=("none", "z"))
        assert made.raster.tobytes() == expected.raster.tobytes() and made.crs.to_epsg() == 32633
        with pytest.raises(flaunay.InputError, match="position 0, .* nor is there a field none"):
            flaunay.terrain(points, resolution=2, height="none")
        with pytest.raises(flaunay.InputError, match="'name' is no number"):
            flaunay.terrain(points, resolution=2, height="name")
        with pytest.raises(flaunay.InputError, match="position 0, .* has no height; height="):
            flaunay.terrain(points, resolution=2)
    with pytest.raises(flaunay.InputError, match="has the layers points, some: add the name of one"):
        flaunay.terrain(tmp_path / "points.gpkg", resolution=2, height="z")
    with pytest.raises(flaunay.InputError, match="none"):
        flaunay.terrain(f"{tmp_path}/points.gpkg:none", resolution=2, height="z")
    # Heights of positions, of points and lines.
    half = shapely.linestrings(scan[:1500]), *shapely.points(scan[1500:])
    for points in geopandas.GeoSeries(shapely.points(scan)), half:
        assert flaunay.terrain(points, resolution=2).raster.tobytes() == expected.raster.tobytes()
    with pytest.raises(flaunay.InputError, match="no layer has a field none, of height="):
        flaunay.terrain(scan, resolution=2, height="none")
    with pytest.raises(flaunay.InputError, match="expected points or lines"):
        flaunay.terrain(shapely.box(0, 0, 1, 1), resolution=2)
    with pytest.raises(flaunay.UsageError, match="columns="):
        flaunay.terrain(tmp_path / "points.fgb", resolution=2, columns=(0, 1, 2))
    # Where a point has no height, it is named; where a line has none, it is that of the points around.
    some = geopandas.GeoDataFrame({"z": [1, None, 3]}, geometry=shapely.points(scan[:3, :2]))
    with pytest.raises(flaunay.InputError, match="position 1, .* has no height$"):
        flaunay.terrain(some, resolution=2, height="z")
    some.geometry = [shapely.linestrings([scan[k, :2], scan[k, :2] + 1]) for k in range(3)]
    made = flaunay.terrain(table, resolution=2, height="z", breaklines=some)
    assert np.isfinite(made.raster).sum() == np.isfinite(expected.raster).sum()
    # Those of lines are other ones.
    across = shapely.linestrings([[(500000, y), (500060, y)] for y in (4500010, 4500030)])
    lines = geopandas.GeoDataFrame({"z": [50.0, 60], "level": [70.0, 80]}, geometry=across)
    table = table[(np.abs(scan[:, 1] - 4500020) - 10).round(2) != 0]
    for line_height, level in ((None, 50), ("level", 70)):
        made = flaunay.terrain(
            table, resolution=2, pixel_is="point", height="z", breaklines=lines, line_height=line_height
        )
        np.testing.assert_allclose(made.raster[15, 1:-1], level, atol=1e-12)
    with pytest.raises(flaunay.InputError, match="no field none, of line_height="):
        flaunay.terrain(scan, resolution=2, breaklines=lines, line_height="none")
    with pytest.raises(flaunay.UsageError, match="needs breaklines="):
        flaunay.terrain(scan, resolution=2, line_height="z")


# ---- Outputs


def test_outputs_are_where_the_command_writes_them(scan, tmp_path):
    pytest.importorskip("meshio")
    (tmp_path / "there").mkdir()
    there, link = tmp_path / "there" / "a.obj", tmp_path / "link.obj"
    there.write_text("old")
    there.chmod(0o640)
    link.symlink_to(there)
    flaunay.terrain(scan, link, resolution=2)
    assert link.is_symlink() and there.read_text() != "old" and there.stat().st_mode & 0o777 == 0o640
    for outputs in [link, there], [link, link]:
        with pytest.raises(flaunay.UsageError, match="same path"):
            flaunay.terrain(scan, outputs, resolution=2)
    path = tmp_path / "points.xyz"
    np.savetxt(path, scan, fmt="%.2f")
    (tmp_path / "input.obj").symlink_to(path)
    with pytest.raises(flaunay.UsageError, match="overwrite the input"):
        flaunay.terrain(path, tmp_path / "input.obj", resolution=2)
    with pytest.raises(flaunay.InputError, match="cannot be written"):
        (tmp_path / "nowhere.obj").symlink_to(tmp_path / "nowhere" / "a.obj")
        flaunay.terrain(scan, tmp_path / "nowhere.obj", resolution=2)
    with pytest.raises(flaunay.UsageError, match="no regular file"):
        (tmp_path / "null.obj").symlink_to(os.devnull)
        flaunay.terrain(scan, tmp_path / "null.obj", resolution=2)


@pytest.mark.parametrize("name", ["a.tif", "a.png", "a.gpkg", "a.geojson", "a.ply", "a.vtu"])
def test_full_disks_are_errors_of_input(scan, tmp_path, name):
    resource = pytest.importorskip("resource")
    for package in "rasterio", "pyogrio", "meshio":
        pytest.importorskip(package)
    path = tmp_path / name
    path.write_bytes(b"old")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, limits[1]))
    try:
        with pytest.raises(flaunay.InputError, match="cannot be written"):
            flaunay.terrain(scan, path, resolution=0.2, contours=1)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.read_bytes() == b"old" and [p.name for p in tmp_path.iterdir()] == [name]


# ---- Laser scans


@pytest.mark.parametrize("suffix", ["las", "laz"])
def test_scans_have_the_decimal_numbers(scan, tmp_path, suffix):
    write_las(tmp_path / f"a.{suffix}", scan[:1000])
    write_las(tmp_path / f"b.{suffix}", scan[1000:], offsets=(400000, 4000000, 50), version="1.2")
    made = flaunay.terrain(tmp_path, resolution=2)
    assert {tuple(p) for p in made.mesh.points} == {tuple(p) for p in scan[:, :2]}
    assert made.raster.tobytes() == flaunay.terrain(scan, resolution=2).raster.tobytes()
    # An offset that is no multiple of the scale.
    between = write_las(tmp_path / f"c.{suffix}", scan + 0.005, offsets=(500000.005, 4500000.005, 0.005))
    points = flaunay.terrain(between, resolution=2).mesh.points
    np.testing.assert_allclose(points, scan[:, :2] + 0.005, rtol=0, atol=1e-8)


def test_classes_and_returns(scan, tmp_path):
    classes = np.where(scan[:, 0] < 500030, 2, 5)
    path = write_las(tmp_path / "a.laz", scan, classes=classes)
    ground = flaunay.terrain(path, resolution=2, classes=[2, 9])
    assert len(ground.heights) == (classes == 2).sum() and ground.bounds[2] == 500030
    assert len(flaunay.terrain(path, resolution=2, returns="last").heights) == 1500
    assert len(flaunay.terrain(path, resolution=2, returns="first").heights) == 3000
    with pytest.raises(flaunay.InputError, match=r"classes \[7\]"):
        flaunay.terrain(path, resolution=2, classes=[7])


def test_withheld_points_and_noise_are_left_out(scan, tmp_path):
    laspy = pytest.importorskip("laspy")
    for version in "1.2", "1.4":
        path = write_las(tmp_path / "a.las", scan, classes=np.arange(3000) % 20, version=version)
        las = laspy.read(path)
        las.withheld[:100] = 1
        las.write(path)
        made = flaunay.terrain(path, resolution=2)
        noise = np.isin(np.arange(100, 3000) % 20, [7, 18]).sum()
        assert made.left_out == {"withheld": 100, "noise": noise}
        assert len(made.heights) == 2900 - noise
        only = flaunay.terrain(path, resolution=2, classes=[7])
        assert len(only.heights) == 145 and only.left_out == {"withheld": 100, "noise": 0}


def test_coordinate_systems_are_compared(scan, tmp_path):
    write_las(tmp_path / "a.las", scan, 32633)
    write_las(tmp_path / "b.las", scan, 32634)
    with pytest.raises(flaunay.InputError, match="a.las and .*b.las have different"):
        flaunay.terrain(tmp_path, resolution=2)
    assert flaunay.terrain(tmp_path, resolution=2, crs="EPSG:32634").crs.to_epsg() == 32634
    assert flaunay.terrain(tmp_path / "a.las", resolution=2).crs.to_epsg() == 32633


@pytest.mark.parametrize("suffix", ["las", "laz"])
def test_truncated_scans_leave_no_files(scan, tmp_path, suffix):
    pytest.importorskip("rasterio")
    path = write_las(tmp_path / f"a.{suffix}", scan)
    path.write_bytes(path.read_bytes()[:-2000])
    with pytest.raises(flaunay.InputError, match=str(path)):
        flaunay.terrain(path, tmp_path / "dem.tif", resolution=2)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_geotiff(scan, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    write_las(tmp_path / "a.las", scan, 32633)
    for pixel_is, size in (("area", 30), ("point", 31)):
        output = tmp_path / "dem.tif"
        made = flaunay.terrain(tmp_path / "a.las", output, resolution=2, pixel_is=pixel_is)
        with rasterio.open(output) as file:
            assert file.crs.to_epsg() == 32633 and file.nodata == -9999 and file.width == size
            assert tuple(file.bounds) == made.bounds
            assert file.tags()["AREA_OR_POINT"].lower() == pixel_is
            assert file.tags(ns="IMAGE_STRUCTURE")["LAYOUT"] == "COG"
            pixels = file.read(1, masked=True)
            place = file.xy(7, 11)
        np.testing.assert_array_equal(pixels.filled(np.nan), made.raster.astype(np.float32))
        x, y = np.array(place)
        assert abs(made.raster[7, 11] - hills(x - 500000, y - 4500000)) < 3


def test_contours_and_hillshade(scan, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    pyogrio = pytest.importorskip("pyogrio")
    outputs = [tmp_path / name for name in ("a.geojson", "a.gpkg", "a.png", "a.fgb")]
    made = flaunay.terrain(scan, outputs, resolution=1, contours=10, crs="EPSG:32633")
    lines = made.contours(10)
    for path in outputs[0], outputs[1], outputs[3]:
        meta, _, geometries, fields = pyogrio.raw.read(path)
        assert meta["crs"] == "EPSG:32633" and len(geometries) == len(lines)
        np.testing.assert_array_equal(np.sort(fields[0]), lines.heights)
    first = json.loads(outputs[0].read_text())["features"][0]
    np.testing.assert_allclose(first["geometry"]["coordinates"], lines[0][1], atol=1e-6)
    with rasterio.open(outputs[2]) as file:
        grey, alpha = file.read()
    assert grey.shape == made.raster.shape and np.ptp(grey[alpha > 0]) > 50
    assert ((alpha == 0) == np.isnan(made.raster + sum(np.gradient(made.raster)))).all()
    np.testing.assert_array_equal(made.hillshade(), np.dstack([grey, grey, grey, alpha]))
    made = flaunay.terrain(scan, outputs[2], resolution=1, vertical_factor=2, colors=True)
    with rasterio.open(outputs[2]) as file:
        picture = np.moveaxis(file.read(), 0, -1)
    np.testing.assert_array_equal(made.hillshade(vertical_factor=2, colors=True), picture)


def test_hills_are_shaded(scan):
    made = flaunay.terrain(scan, resolution=2)
    grey = made.hillshade()
    assert grey.shape == (20, 30, 4) and grey.dtype == np.uint8 and (np.ptp(grey[..., :3], axis=2) == 0).all()
    flat = flaunay.terrain(scan * [1, 1, 0.5], resolution=2)
    np.testing.assert_array_equal(flat.hillshade(vertical_factor=2), grey)
    assert (flat.hillshade() != grey).any()
    lowest, highest = np.nanargmin(made.raster), np.nanargmax(made.raster)
    colors = made.hillshade(colors=True).reshape(-1, 4).astype(int)
    assert colors[lowest, 1] > colors[lowest, 0] > 0 and np.ptp(colors[highest, :3]) < 9
    assert flaunay.terrain(scan[:3], resolution=1000).hillshade().shape == (1, 1, 4)
    # With longitudes and latitudes, heights are multiplied so that slopes are those in metres.
    pytest.importorskip("rasterio")
    small = (scan - [500030, 4500020, 0]) / [1e4, 1e4, 1]
    metres = flaunay.terrain(small, resolution=2e-4)
    degrees = flaunay.terrain(small * [1, 1, 11.1195], resolution=2e-4, crs="EPSG:4326")
    pictures = degrees.hillshade().astype(int), metres.hillshade(vertical_factor=1e-4)
    assert np.abs(pictures[0] - pictures[1]).max() <= 1
    for arguments in {"colors": True}, {"vertical_factor": 2}:
        with pytest.raises(flaunay.UsageError, match="need an output .png"):
            flaunay.terrain(scan, resolution=2, **arguments)
    with pytest.raises(flaunay.UsageError, match="vertical_factor must be positive"):
        made.hillshade(vertical_factor=-1)


def test_contours_in_chunks(scan, tmp_path):
    pytest.importorskip("pyogrio")
    shapely = pytest.importorskip("shapely")
    area = shapely.box(500010, 4500010, 500050, 4500030)
    options = {"resolution": 2, "contours": 5, "boundary": area}
    paths = [tmp_path / name for name in ("whole.geojson", "chunks.geojson")]
    expected = flaunay.terrain(scan, paths[0], **options)
    made = flaunay.terrain(scan, paths[1], memory="128M", **options)
    assert made.raster.tobytes() == expected.raster.tobytes()
    assert paths[0].read_text() == paths[1].read_text()
    assert len(json.loads(paths[1].read_text())["features"]) > 10
    with pytest.raises(flaunay.UsageError, match="memory="):
        flaunay.terrain(scan, tmp_path / "tin.ply", memory="128M", **options)


def test_no_coordinate_system_is_no_reason_to_warn(scan, tmp_path):
    pytest.importorskip("pyogrio")
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        flaunay.terrain(scan, tmp_path / "a.geojson", resolution=1, contours=10)


def test_breaklines_are_hard_edges(tmp_path):
    shapely = pytest.importorskip("shapely")
    # A terrace, whose edge no points show.
    x, y = np.meshgrid(np.arange(0, 21, 4.0), np.arange(0, 21, 4.0))
    points = np.stack([x.ravel(), y.ravel(), np.where(x < 9, 0, 10).ravel()], axis=1)
    edges = [[[9, 0, 0], [9, 20, 0]], [[9.5, 0, 10], [9.5, 20, 10]]]
    made = flaunay.terrain(points, resolution=1, breaklines=[np.array(e, float) for e in edges])
    mixed = [shapely.LineString(edges[0]), *(np.array(e, float) for e in edges[1:])]
    again = flaunay.terrain(points, resolution=1, breaklines=mixed, flat=[])
    np.testing.assert_array_equal(again.raster, made.raster)
    np.testing.assert_allclose(
        made.raster, np.where(np.arange(20) < 9, 0.0, 10.0)[None].repeat(20, 0)
    )
    flat = flaunay.terrain(points, resolution=1, breaklines=shapely.LineString([(9, 0), (9, 20)]))
    assert np.allclose(flat.raster[:, 8], flaunay.terrain(points, resolution=1).raster[:, 8])
    with pytest.raises(flaunay.InputError, match="breaklines"):
        flaunay.terrain(points, resolution=1, breaklines=[[[0, 0], [9, 9]], [[9, 0], [0, 9]]])
    with pytest.raises(flaunay.UsageError, match="lines or polygons"):
        flaunay.terrain(points, resolution=1, breaklines=[shapely.Point(1, 1)])
    with pytest.raises(flaunay.UsageError, match="breaklines must be a path, geometries or a list"):
        flaunay.terrain(points, resolution=1, breaklines=np.array([[9, 0], [9, 20]]))
    with pytest.raises(flaunay.InputError, match="none.gpkg"):
        pytest.importorskip("pyogrio")
        flaunay.terrain(points, resolution=1, breaklines=tmp_path / "none.gpkg")


def test_breaklines_that_cross_are_cut():
    pytest.importorskip("shapely")
    points = [[0, 0, 1], [4, 0, 1], [0, 4, 1], [4, 4, 1]]
    lines = [np.array([[0, 2, 0], [4, 2, 8.0]]), np.array([[2, 0, 1], [2, 4, 9.0]])]
    options = {"resolution": 2, "pixel_is": "point", "breaklines": lines, "crossings": "split"}
    for memory in None, "128M":
        made = flaunay.terrain(points, memory=memory, **options)
        assert made.raster.tolist() == [[1, 9, 1], [0, 4, 8], [1, 1, 1]]
    assert flaunay.terrain(points, resolution=1, crossings="split").raster.max() == 1


def test_maps_in_other_places_than_the_points(scan, tmp_path):
    shapely = pytest.importorskip("shapely")
    pytest.importorskip("rasterio")
    munich = shapely.box(11.5, 48.1, 11.6, 48.2)
    for name in "breaklines", "flat", "boundary":
        with pytest.raises(flaunay.InputError, match=f"{name} reaches.*same coordinate system"):
            flaunay.terrain(scan, resolution=2, **{name: munich})
    with pytest.raises(flaunay.InputError, match="2\\^509"):
        flaunay.terrain(scan, resolution=2, boundary=shapely.box(-1e308, -1e308, 1e308, 1e308))
    pytest.importorskip("pyogrio")
    area = tmp_path / "area.geojson"
    area.write_text(shapely.to_geojson(shapely.box(500010, 4500010, 500050, 4500030)))
    made = flaunay.terrain(scan, resolution=1, boundary=area, crs="EPSG:32633")
    assert np.isfinite(made.raster).sum() == 40 * 20


def test_breaklines_in_chunks(scan, tmp_path):
    pytest.importorskip("shapely")
    walls = [
        np.array([[500005 + 20 * k + 3 * (j % 2), 4500001 + 6 * j, 200 + j] for j in range(7)])
        for k in range(3)
    ]
    scan = np.concatenate([scan, walls[1] - [0, 0, 50]])  # of these places, the walls' heights count
    options = {"resolution": 0.5, "breaklines": walls}
    expected = flaunay.terrain(scan, **options)
    made = flaunay.terrain(scan, memory="128M", **options)
    assert made.raster.tobytes() == expected.raster.tobytes()
    assert np.nanmax(made.raster) > 160 > scan[:3000, 2].max()
    with pytest.raises(flaunay.UsageError, match="heights at all"):
        flaunay.terrain(scan, memory="128M", resolution=1, breaklines=[walls[0][:, :2]])
    with pytest.raises(flaunay.InputError, match="breaklines: segments"):
        crossing = [walls[0], walls[0] * [-1, 1, 1] + [1000013, 0, 0]]
        flaunay.terrain(scan, memory="128M", resolution=1, breaklines=crossing)


def test_boundary_cuts_raster_and_contours(scan, tmp_path):
    shapely = pytest.importorskip("shapely")
    pyogrio = pytest.importorskip("pyogrio")
    pytest.importorskip("rasterio")
    area = shapely.box(500010, 4500010, 500050, 4500030).difference(
        shapely.box(500025, 4500015, 500035, 4500025)
    )
    path = tmp_path / "area.gpkg"
    pyogrio.raw.write(
        path,
        np.array([area.wkb], object),
        [],
        np.array([], object),
        geometry_type="Polygon",
        crs="EPSG:32633",
    )
    for boundary in (area, path):
        made = flaunay.terrain(scan, resolution=1, boundary=boundary, crs="EPSG:32633")
        assert np.isfinite(made.raster).sum() == 40 * 20 - 100
        lines = made.contours(5)
        assert len(lines)
        for _, line in lines:
            assert shapely.LineString(line).difference(area.buffer(1e-6)).length < 1e-9
    with pytest.raises(flaunay.InputError, match="coordinate system"):
        flaunay.terrain(scan, resolution=1, boundary=path, crs="EPSG:32634")


def test_lakes_are_flat(scan):
    shapely = pytest.importorskip("shapely")
    shore = np.array([[15, 10], [40, 8], [45, 30], [20, 28]]) + [500000, 4500000]
    island = np.array([[25, 15], [30, 15], [28, 20]]) + [500000, 4500000]
    lake = shapely.Polygon(shore, [island])
    made = flaunay.terrain(scan, resolution=0.5, flat=lake)
    x0, y0, _, y1 = made.bounds
    x, y = np.meshgrid(x0 + 0.25 + np.arange(120) / 2, y1 - 0.25 - np.arange(80) / 2)
    inside = shapely.contains_xy(lake, x, y)
    level = made.raster[inside][0]
    np.testing.assert_allclose(made.raster[inside], level, rtol=1e-14)
    plain = flaunay.terrain(scan, resolution=0.5)
    corners = flaunay.LinearInterpolator(plain.mesh, plain.heights)(np.concatenate([shore, island]))
    assert level == pytest.approx(corners.min(), abs=1e-12)
    # On the island and far from the lake, nothing has changed.
    far = ~shapely.intersects_xy(shapely.Polygon(shore).buffer(6), x, y)
    np.testing.assert_allclose(made.raster[far], plain.raster[far], rtol=0, atol=1e-9)
    at = shapely.Polygon([(*p, 77.5) for p in shore])
    made = flaunay.terrain(scan, resolution=0.5, flat=[at])
    assert made.raster[shapely.contains_xy(at, x, y)] == pytest.approx(77.5, abs=1e-12)
    with pytest.raises(flaunay.UsageError, match="flat must be polygons"):
        flaunay.terrain(scan, resolution=1, flat=shapely.LineString(shore))


@pytest.mark.parametrize("method", ["natural", "clough-tocher"])
def test_other_methods_are_those_of_interpolators(scan, method):
    made = flaunay.terrain(scan, resolution=2, method=method, max_edge=3)
    kinds = {
        "natural": flaunay.NaturalNeighborInterpolator,
        "clough-tocher": flaunay.CloughTocherInterpolator,
    }
    interpolate = kinds[method](made.mesh, made.heights, max_edge=3)
    x, y = np.meshgrid(500001 + 2.0 * np.arange(30), 4500039 - 2.0 * np.arange(20))
    np.testing.assert_array_equal(made.raster, interpolate(x, y))
    linear = flaunay.terrain(scan, resolution=2, max_edge=3)
    np.testing.assert_array_equal(np.isnan(made.raster), np.isnan(linear.raster))
    assert 0 < np.nanmax(np.abs(made.raster - linear.raster)) < 2
    with pytest.raises(flaunay.UsageError, match="'clough-tocher', not 'cubic'"):
        flaunay.terrain(scan, resolution=2, method="cubic")


def test_the_triangles_are_written(scan, tmp_path):
    meshio = pytest.importorskip("meshio")
    outputs = [tmp_path / "tin.vtk", tmp_path / "tin.obj"]
    made = flaunay.terrain(scan, outputs, resolution=2)
    for path in outputs:
        mesh = meshio.read(path)
        np.testing.assert_allclose(mesh.points[:, 2], made.heights, atol=1e-3)
        assert len(mesh.cells_dict["triangle"]) == made.mesh.nsimplex
    flaunay.terrain(scan, outputs[0], resolution=2, max_edge=2)
    assert len(meshio.read(outputs[0]).cells_dict["triangle"]) < made.mesh.nsimplex
