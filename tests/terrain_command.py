#!/usr/bin/env python3
"""`flaunay terrain`: files of all kinds, choices and chunks give the right raster, and errors say what is wrong.

    terrain_command.py FLAUNAY [gdal]     gdal: the command was built with it
"""
import contextlib
import json
import sqlite3
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

FLAUNAY, HAS_GDAL = sys.argv[1], "gdal" in sys.argv[2:]
GEO_KEYS = 34735


def run(*arguments):
    return subprocess.run(
        [FLAUNAY, "terrain", *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=300,
    )


def notch():
    """A polygon with a notch and a lattice with few heights, turned together."""
    c, s = np.cos(0.001), np.sin(0.001)

    def turned(x, y):
        return 5e5 + np.column_stack([c * x - s * y, s * x + c * y])

    corners = np.array([[3, 3], [25, 3], [25, 25], [14, 9], [3, 25], [3, 3]])
    x, y = np.meshgrid(np.arange(30.0), np.arange(30.0))
    random = np.random.default_rng(2)
    heights = [random.integers(0, 6, 900) for _ in range(2)][1]
    polygon = {"type": "Polygon", "coordinates": [turned(*corners.T).tolist()]}
    return polygon, np.column_stack([turned(x.ravel(), y.ravel()), heights])


def raster(folder, *arguments):
    path = folder / "out.npy"
    done = run(*arguments, "-o", path, "--device", "host")
    assert done.returncode == 0, (arguments, done.stderr)
    return np.load(path)


def las(path, points, classes, returns, epsg=None, scale=0.01, offset=(500000, 5000000, 0), extra=0):
    """LAS 1.2, point format 1. returns: number and how many of each point."""
    keys = b""
    if epsg:
        content = struct.pack("<8H", 1, 1, 0, 1, 3072, 0, 1, epsg)
        keys = struct.pack("<H16sHH32s", 0, b"LASF_Projection", GEO_KEYS, len(content), b"") + content
    head = bytearray(227)
    head[:4] = b"LASF"
    head[24:26] = 1, 2
    struct.pack_into("<HII", head, 94, 227, 227 + len(keys), 1 if epsg else 0)
    struct.pack_into("<BHI", head, 104, 1, 28, len(points) + extra)
    struct.pack_into("<6d", head, 131, scale, scale, scale, *offset)
    for axis in range(3):
        struct.pack_into("<2d", head, 179 + 16 * axis, points[:, axis].max(), points[:, axis].min())
    records = np.zeros(len(points), [("at", "<i4", 3), ("i", "<u2"), ("r", "u1"), ("c", "u1"), ("rest", "V12")])
    records["at"] = np.rint((points - np.array(offset)) / scale)
    records["r"] = returns[:, 0] + 8 * returns[:, 1]
    records["c"] = classes
    path.write_bytes(bytes(head) + keys + records.tobytes())


def fails(code, *parts, arguments):
    done = run(*arguments)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    for part in parts:
        assert part in done.stderr, (part, done.stderr)


def obj(path):
    """Points and triangles of a file."""
    rows = [line.split() for line in path.read_text().splitlines() if line[0] in "vf"]
    corners = np.array([row[1:] for row in rows if row[0] == "v"], float)
    return corners, np.array([row[1:] for row in rows if row[0] == "f"], int) - 1


def check_choices(folder):
    """Points of scans that do not count, text in columns, and maps in other places than the points."""
    square = np.array([[0.0, 0, 1], [4, 0, 1], [0, 4, 1], [4, 4, 1]])
    size, plain = ("--resolution", "1"), np.ones((4, 4))
    # In this format the class has five bits, and then there are flags, of which the last one is withheld.
    odd = np.array([[1.0, 1, 900], [2, 2, 800], [3, 3, -700], [3, 2, 3]])
    scan, places = folder / "odd.las", np.concatenate([square, odd])
    classes = np.array([2, 2, 2, 2, 0x82, 18, 7, 0x22], np.uint8)
    las(scan, places, classes, np.ones((8, 2), int), offset=(0, 0, 0))
    done = run(scan, *size, "-o", folder / "odd.npy")
    assert "5 points, without 1 withheld ones, without 2 of noise, 4 x 4" in done.stdout, done.stdout
    assert np.load(folder / "odd.npy").max() < 3
    assert raster(folder, scan, *size, "--classes", "2,7,18").min() < -100
    assert raster(folder, scan, *size, "--classes", "2").max() < 3
    classes[:] = 0x82
    las(scan, places, classes, np.ones((8, 2), int), offset=(0, 0, 0))
    fails(3, "no points", "8 withheld", arguments=(scan, *size, "-o", folder / "odd.npy"))

    text = folder / "decimal.xyz"
    text.write_text("1,4 2,7 1,7\n1,5 2,5 1\n")
    fails(3, "decimal.xyz", "line 1", "semicolons", arguments=(text, *size, "-o", folder / "odd.npy"))
    text.write_text("nr;h;n;e\n1;1,0;0;0\n2;1,0;0;4\n3;1,0;4;0\n4;1,0;4;4,0\n")
    assert same(raster(folder, text, *size, "--columns", "e,n,h"), plain)
    assert same(raster(folder, text, *size, "--columns", "3,n,1"), plain)
    fails(3, "'name'", "nr, h, n, e", arguments=(text, *size, "-o", folder / "odd.npy", "--columns", "e,n,name"))

    far, huge, lines = folder / "far.geojson", folder / "huge.geojson", folder / "cross.geojson"
    ring = [[11.5, 48.1], [11.6, 48.1], [11.6, 48.2], [11.5, 48.1]]
    far.write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    huge.write_text('{"type": "Polygon", "coordinates": [[[-1e308, -1e308], [1e308, -1e308], [1e308, 1e308]]]}')
    np.save(folder / "square.npy", square)
    square = folder / "square.npy"
    for option in "--breaklines", "--flat", "--boundary":
        arguments = (square, *size, "-o", folder / "odd.npy", option, far)
        fails(3, option, "far.geojson", "same coordinate system", arguments=arguments)
    fails(3, "huge.geojson", "2^509", arguments=(square, *size, "-o", folder / "odd.npy", "--boundary", huge))
    line = {"type": "LineString", "coordinates": [[1, 1, 1], [2, 2, 1]]}
    far.write_text(json.dumps({"crs": {"type": "name", "properties": {"name": "EPSG:25833"}}, **line}))
    assert same(raster(folder, square, *size, "--breaklines", far, "--crs", "EPSG:25832"), plain)
    fails(2, "--max-edge", arguments=(square, *size, "-o", folder / "odd.npy", "--max-edge", "0"))

    # Breaklines that cross are cut at the height of the first one, in chunks, too, and lakes stay flat.
    lines.write_text('{"type": "MultiLineString", "coordinates": [[[0, 2, 0], [4, 2, 8]], [[2, 0, 1], [2, 4, 9]]]}')
    point = ("--resolution", "2", "--pixel-is", "point", "--breaklines", lines)
    fails(3, "cross.geojson", "segments", arguments=(square, *point, "-o", folder / "odd.npy"))
    cut = raster(folder, square, *point, "--crossings", "split")
    assert cut.tolist() == [[1, 9, 1], [0, 4, 8], [1, 1, 1]]
    assert same(raster(folder, square, *point, "--crossings", "split", "-o", folder / "cut.obj"), cut)
    far.write_text('{"type": "Polygon", "coordinates": [[[1, 1, 3], [3, 1, 3], [3, 3, 3], [1, 3, 3], [1, 1, 3]]]}')
    fine = ("--resolution", "0.5", "--crossings", "split", "--breaklines", lines, "--flat", far)
    corners, _ = obj_of(folder, square, *fine)
    on_shore = np.abs(corners[:, :2] - 2).max(axis=1) == 1
    assert on_shore.sum() >= 8 and (corners[on_shore, 2] == 3).all(), corners


def obj_of(folder, *arguments):
    assert run(*arguments, "-o", folder / "of.obj").returncode == 0
    return obj(folder / "of.obj")


def check_garden(folder):
    """A real scan: a garden with two houses and a tree."""
    garden = Path(__file__).parent / "data" / "garden.las"
    size = ("--resolution", "0.5", "--max-edge", "2")
    whole, ground = raster(folder, garden, *size), raster(folder, garden, *size, "--classes", "2")
    assert whole.shape == ground.shape == (80, 120)
    assert 1353 < np.nanmin(ground) < np.nanmax(ground) < 1356 < np.nanmax(whole) < 1405
    # The houses are voids of the ground, and the ground is what it was all around.
    voids = np.isnan(ground)
    assert 0.1 < voids.mean() < 0.3 and np.isnan(whole).mean() < 0.02
    assert np.nanmean(whole[voids]) > 1358 and np.nanmedian(np.abs(whole - ground)) < 0.2
    assert same(raster(folder, garden, *size, "--classes", "2", "--memory", "130M"), ground)


def same(a, b):
    return a.tobytes() == b.tobytes()


def main(folder):
    check_choices(folder)
    check_garden(folder)
    random = np.random.default_rng(4)
    n = 30000
    points = np.round(random.uniform([500000, 5000000, 0], [500100, 5000060, 50], (n, 3)), 2)
    points[:, 2] = np.round(points[:, 0] - 500000 + 2 * (points[:, 1] - 5000000), 2)
    classes = random.choice([2, 9, 31], n).astype(np.uint8)
    numbers = random.integers(1, 4, n)
    returns = np.stack([numbers, np.maximum(numbers, random.integers(1, 4, n))], axis=1)

    def npy(name, rows, dtype=np.float64):
        np.save(folder / name, np.ascontiguousarray(rows, dtype))
        return folder / name

    whole = npy("whole.npy", points)
    size = ("--resolution", "0.5")
    expected = raster(folder, whole, *size)

    # The pixels of a plane. Some have their centres beyond the points.
    assert expected.shape == (120, 200)
    x, y = 0.25 + 0.5 * np.arange(200), 59.75 - 0.5 * np.arange(120)
    plane = x[None, :] + 2 * y[:, None]
    there = ~np.isnan(expected)
    assert there.mean() > 0.99
    np.testing.assert_allclose(expected[there], plane[there], atol=1e-6)

    # Files of all kinds, alone and together, in memory and in chunks.
    scan = folder / "scan.las"
    las(scan, points, classes, returns)
    assert same(raster(folder, scan, *size), expected)
    text = folder / "scan.xyz"
    np.savetxt(text, np.column_stack([points, classes]), fmt="%.2f", header="x y z class")
    assert same(raster(folder, text, *size), expected)
    comma = folder / "scan.csv"
    np.savetxt(comma, points[:9000], fmt="%.2f", delimiter=",", header="x,y,z", comments="")
    tiles = folder / "tiles"
    tiles.mkdir()
    las(tiles / "a.las", points[9000:20000], classes[9000:20000], returns[9000:20000], offset=(499000, 5000000, 7))
    las(tiles / "b.LAS", points[20000:], classes[20000:], returns[20000:], scale=0.001)
    npy("tiles/c.npy", points[:10], np.float64)
    assert same(raster(folder, tiles, comma, *size, "--memory", "130M"), expected)

    # Points of some classes and returns.
    ground = classes != 31
    chosen = raster(folder, npy("ground.npy", points[ground]), *size)
    assert same(raster(folder, scan, *size, "--classes", "9,2"), chosen)
    last = ground & (returns[:, 0] == returns[:, 1])
    chosen = raster(folder, npy("last.npy", points[last]), *size)
    assert same(raster(folder, scan, *size, "--classes", "2,9", "--returns", "last"), chosen)
    chosen = raster(folder, npy("first.npy", points[returns[:, 0] == 1]), *size)
    assert same(raster(folder, scan, *size, "--returns", "first"), chosen)

    # Equal places.
    higher = points + [0, 0, 10]
    twice = npy("twice.npy", np.concatenate([points, higher]))
    for duplicates, lift in ("lowest", 0), ("mean", 5), ("highest", 10):
        made = raster(folder, twice, *size, "--duplicates", duplicates)
        np.testing.assert_allclose(made[there], plane[there] + lift, atol=1e-6)

    # Grids and what is left out.
    centred = raster(folder, whole, "--resolution", "2", "--pixel-is", "point")
    assert centred.shape == (31, 51)
    np.testing.assert_allclose(centred[15, 25], 50 + 2 * 30, atol=1e-6)
    part = raster(folder, whole, *size, "--bounds", "500010,5000010,500020,5000015")
    assert same(part, np.ascontiguousarray(expected[90:100, 20:40]))
    assert np.isnan(raster(folder, whole, *size, "--max-edge", "0.1")).mean() > 0.9
    boundary = folder / "boundary.geojson"
    boundary.write_text(
        '{"type": "MultiPolygon", "coordinates": [[[[500010, 5000010], [500050, 5000010], [500050, 5000050],'
        "[500010, 5000050], [500010, 5000010]], [[500020, 5000020], [500030, 5000020], [500030, 5000030],"
        "[500020, 5000030], [500020, 5000020]]]]}"
    )
    inside = ((x > 10) & (x < 50))[None, :] & ((y > 10) & (y < 50))[:, None]
    inside &= ~(((x > 20) & (x < 30))[None, :] & ((y > 20) & (y < 30))[:, None])
    assert same(raster(folder, whole, *size, "--boundary", boundary), np.where(inside, expected, np.nan))

    # A ridge across a square, and again with one of its heights from the points; it hides a diagonal.
    square = npy("square.npy", np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [4, 4, 8]]))
    ridge = folder / "ridge.geojson"

    def with_ridge(*line):
        ridge.write_text(json.dumps({"type": "LineString", "coordinates": line}))
        return raster(folder, square, "--resolution", 2, "--pixel-is", "point", "--breaklines", ridge)[1, 1]

    assert with_ridge([0, 4, 4], [4, 0, 6]) == 5
    assert with_ridge([0, 4], [4, 0, 6]) == 3

    # Breaklines with heights, in chunks and, with a file of the triangles, in memory.
    walls = folder / "walls.geojson"
    line = [[500000.5 + 9 * k, 5000001 + 57 * (k % 2), 300 + k] for k in range(11)]
    walls.write_text(json.dumps({"type": "MultiLineString", "coordinates": [line, [line[3], line[4]]]}))
    both = raster(folder, scan, *size, "--breaklines", walls, "-o", folder / "walls.obj")
    assert not same(both, expected) and np.nanmax(both) > 305
    assert same(raster(folder, scan, *size, "--breaklines", walls, "--memory", "130M"), both)

    # Contours of the plane.
    lines = folder / "lines.geojson"
    done = run(scan, *size, "-o", lines, "-o", folder / "with.npy", "--contours", 20, "--crs", "EPSG:25832")
    assert done.returncode == 0, done.stderr
    assert same(np.load(folder / "with.npy"), expected)
    collection = json.loads(lines.read_text())
    assert collection["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::25832"
    heights = set()
    for feature in collection["features"]:
        height = feature["properties"]["height"]
        heights.add(height)
        at = np.array(feature["geometry"]["coordinates"]) - [500000, 5000000]
        np.testing.assert_allclose(at[:, 0] + 2 * at[:, 1], height, atol=0.02)
    assert heights == set(range(20, 220, 20))

    # Contours have the same bytes in chunks and in memory, where files of the triangles are made, too.
    tin = folder / "tin.obj"
    assert run(scan, *size, "-o", folder / "whole.geojson", "-o", tin, "--contours", 3.5).returncode == 0
    assert run(scan, *size, "-o", lines, "--contours", 3.5, "--memory", "130M").returncode == 0
    assert lines.read_text() == (folder / "whole.geojson").read_text()
    corners, triangles = obj(tin)
    assert set(map(tuple, corners)) == set(map(tuple, points)) and len(triangles) > n
    assert run(scan, *size, "-o", tin, "--max-edge", "1").returncode == 0
    edges = np.linalg.norm(corners[np.roll(triangles, -1, axis=1), :2] - corners[triangles, :2], axis=2)
    assert len(obj(tin)[1]) == (edges <= 1).all(axis=1).sum() < len(triangles)

    # Contours end at the boundary, whose polygon has a hole.
    arguments = (scan, *size, "-o", lines, "--boundary", boundary, "--contours", "40,75.5,200")
    assert run(*arguments).returncode == 0
    lengths = {}
    for feature in json.loads(lines.read_text())["features"]:
        at = np.array(feature["geometry"]["coordinates"]) - [500000, 5000000]
        height = feature["properties"]["height"]
        lengths[height] = lengths.get(height, 0) + np.abs(np.diff(at[:, 0])).sum()
        assert (at > 10 - 1e-6).all() and (at < 50 + 1e-6).all()
        assert not ((at > 20 + 1e-6) & (at < 30 - 1e-6)).all(axis=1).any()
    # x + 2 y = 40 has y from 10 to 15, without a hole; x + 2 y = 75.5 has x from 10 to 50, and in the hole 20 to 30.
    assert set(lengths) == {40, 75.5}
    np.testing.assert_allclose([lengths[40], lengths[75.5]], [10, 30], atol=0.1)

    # A closed line, which begins at its left end, is cut once; of the other half, too.
    cone = points.copy()
    cone[:, 2] = np.hypot(points[:, 0] - 500050, points[:, 1] - 5000030)
    for left, right in (0, 50), (50, 100):
        box = [[left, 0], [right, 0], [right, 60], [left, 60], [left, 0]]
        half = folder / "half.geojson"
        half.write_text(json.dumps({"type": "Polygon", "coordinates": [[[500000 + x, 5000000 + y] for x, y in box]]}))
        arguments = (npy("cone.npy", cone), *size, "-o", lines, "--boundary", half, "--contours", "20,200")
        assert run(*arguments).returncode == 0
        (feature,) = json.loads(lines.read_text())["features"]
        at = np.array(feature["geometry"]["coordinates"])
        np.testing.assert_allclose(at[[0, -1], 0], 500050, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(np.diff(at, axis=0), axis=1).sum(), 20 * np.pi, rtol=0.01)

    # A piece is inside, even if a corner of the boundary is just as high as its middle.
    slope = npy("slope.npy", [[0, 0, 0], [4, 0, 4], [0, 4, 0], [4, 4, 4]])
    half.write_text('{"type": "Polygon", "coordinates": [[[1, 1], [2.5, -0.5], [4, 1], [2.5, 2.5], [1, 1]]]}')
    assert run(slope, "--resolution", 1, "-o", lines, "--boundary", half, "--contours", 2).returncode == 0
    (feature,) = json.loads(lines.read_text())["features"]
    assert sorted(y for _, y in feature["geometry"]["coordinates"]) == [0, 2]

    # Nothing goes there and back where both ways cross the boundary at the same rounded place.
    map_of_notch, turned_lattice = notch()
    half.write_text(json.dumps(map_of_notch))
    arguments = (npy("turned.npy", turned_lattice), "--resolution", 1, "-o", lines, "--boundary", half)
    assert run(*arguments, "--contours", 0.5).returncode == 0
    for feature in json.loads(lines.read_text())["features"]:
        at = feature["geometry"]["coordinates"]
        assert len(at) > (3 if at[0] == at[-1] else 1) and len(set(map(tuple, at[1:]))) == len(at) - 1

    # A lake at the height of its first point, and one without heights at the lowest one of its shore.
    lakes = folder / "lakes.geojson"
    shore = np.array([[60, 10], [80, 10], [80, 30], [60, 30], [60, 10]])

    def with_lake(ring):
        geometry = {"type": "Polygon", "coordinates": [ring.tolist()]}
        lakes.write_text(json.dumps(geometry))
        return raster(folder, scan, *size, "--flat", lakes)

    wet = ((x > 60) & (x < 80))[None, :] & ((y > 10) & (y < 30))[:, None]
    far = ~(((x > 58) & (x < 82))[None, :] & ((y > 8) & (y < 32))[:, None])
    at_scan = shore + [500000, 5000000]
    for ring, level in (np.column_stack([at_scan, [7, 8, 9, 9, 7]]), 7), (at_scan, 80):
        made = with_lake(ring)
        np.testing.assert_allclose(made[wet], level, atol=0.02)
        np.testing.assert_array_equal(made[far], expected[far])

    # Errors leave what was there.
    out = folder / "out.npy"
    out.write_bytes(b"old")
    to = ("-o", out)
    fails(3, "no points of the classes 5", arguments=(scan, *size, *to, "--classes", "5"))
    fails(2, "--resolution 1e-06: makes", "pixels", arguments=(scan, "--resolution", "1e-6", *to))
    fails(2, "must be positive", arguments=(scan, "--resolution", "-1", *to))
    fails(2, "of .las files alone", arguments=(whole, *size, *to, "--classes", "2"))
    cut = folder / "cut.las"
    las(cut, points, classes, returns, extra=1)
    fails(3, "cut.las", "truncated", arguments=(cut, *size, *to))
    other, third = folder / "other.las", folder / "third.las"
    las(other, points, classes, returns, epsg=25832)
    las(third, points, classes, returns, epsg=25833)
    fails(3, "different coordinate systems", "25833", arguments=(other, third, *size, *to))
    assert run(other, third, *size, "-o", folder / "both.npy", "--crs", "EPSG:25832").returncode == 0
    fails(2, "dem.asc", ".tif", arguments=(scan, *size, "-o", folder / "dem.asc"))
    (folder / "scan.laz").write_bytes(scan.read_bytes())
    fails(3, "LAZ", "flaunay[terrain]", arguments=(folder / "scan.laz", *size, *to))
    (folder / "bad.txt").write_text("1 2 3\n4 5\n")
    fails(3, "bad.txt", "line 2", "x, y and z", arguments=(folder / "bad.txt", *size, *to))
    np.save(folder / "infinite.npy", np.array([[0, 0, 0], [1, 1, np.inf]]))
    fails(3, "infinite.npy", "finite", arguments=(folder / "infinite.npy", *size, *to))
    assert out.read_bytes() == b"old"
    fails(2, "lines.geojson", "--contours", arguments=(scan, *size, "-o", lines))
    ridge.write_text('{"type": "LineString", "coordinates": [[0, 0], [4, 4]]}')
    for in_memory in ("--flat", lakes), ("--breaklines", ridge), ("-o", tin):
        fails(2, "in memory at once", arguments=(scan, *size, *to, *in_memory, "--memory", "1G"))
    fails(2, "--contours", ".gpkg", arguments=(scan, *size, *to, "--contours", "5"))
    fails(3, "ridge.geojson", "polygons", arguments=(scan, *size, *to, "--flat", ridge))
    ridge.write_text('{"type": "MultiLineString", "coordinates": [[[0, 0], [4, 4]], [[0, 3], [3, 0]]]}')
    fails(3, "ridge.geojson", "segment", arguments=(square, *size, *to, "--breaklines", ridge))
    tif = folder / "dem.tif"
    if HAS_GDAL:
        assert run(other, *size, "-o", tif).returncode == 0
        assert b"LAYOUT=IFDS_BEFORE_DATA" in tif.read_bytes()[:1000]
        package, picture = folder / "lines.gpkg", folder / "dem.png"
        done = run(other, *size, "-o", package, "-o", picture, "-o", lines, "--contours", 20, "--memory", "130M")
        assert done.returncode == 0, done.stderr
        with contextlib.closing(sqlite3.connect(package)) as database:
            found = database.execute("select height, count(*) from contours group by height").fetchall()
            assert database.execute("select srs_id from gpkg_contents").fetchone() == (25832,)
        heights = [feature["properties"]["height"] for feature in json.loads(lines.read_text())["features"]]
        assert dict(found) == {height: heights.count(height) for height in heights}
        # Grey and alpha, 8 bits each.
        png = picture.read_bytes()
        assert struct.unpack_from(">IIBB", png, 16) == (200, 120, 8, 4)
        fails(2, "dem.png", "picture", arguments=(scan, "--resolution", "0.004", "-o", picture))
        assert picture.read_bytes() == png
        fails(3, "--crs", arguments=(scan, *size, *to, "--crs", "EPSG:0"))
    else:
        for path in tif, folder / "dem.png", folder / "lines.gpkg":
            fails(2, "FLAUNAY_GDAL", "flaunay[terrain]", arguments=(scan, *size, "-o", path, "--contours", "5"))
    assert not [path.name for path in folder.iterdir() if "partial" in path.name]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        main(Path(name))
