#!/usr/bin/env python3
"""The command and layers of geographic information systems: formats, fields, systems of coordinates, errors.

    layers_command.py FLAUNAY DATA [gdal]     gdal: the command was built with it
"""
import contextlib
import json
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

FLAUNAY, DATA, HAS_GDAL = sys.argv[1], Path(sys.argv[2]), "gdal" in sys.argv[3:]
SAMPLES, CONTOURS = DATA / "garden-samples.fgb", DATA / "garden-contours.shp"
HEIGHT = ("--height", "height")
ON_HOST = ("--device", "host")
POINT, LINE, POLYGON, MULTIPOINT, COLLECTION, CIRCULAR, CURVE_POLYGON, TIN, TRIANGLE = 1, 2, 3, 4, 7, 8, 10, 16, 17


def run(*arguments):
    return subprocess.run([FLAUNAY, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def works(*arguments):
    done = run(*arguments)
    assert done.returncode == 0, (arguments, done.stderr)
    return done.stdout


def fails(code, *parts, arguments):
    done = run(*arguments)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    for part in parts:
        assert str(part) in done.stderr, (part, done.stderr)


def wkb(kind, content, z=False):
    """content: of a point or line the positions, of others the parts as WKB or as rings."""
    head = struct.pack("<BI", 1, kind + (1000 if z else 0))
    if kind in (POLYGON, TRIANGLE):
        rings = b"".join(struct.pack("<I", len(ring)) + np.array(ring, "<f8").tobytes() for ring in content)
        return head + struct.pack("<I", len(content)) + rings
    if kind in (POINT, LINE, CIRCULAR):
        count = b"" if kind == POINT else struct.pack("<I", len(content))
        return head + count + np.array(content, "<f8").tobytes()
    return head + struct.pack("<I", len(content)) + b"".join(content)


def package(path, layers, epsg=25832):
    """A GeoPackage. layers: for each name its fields and rows, geometries first."""
    path.unlink(missing_ok=True)
    with contextlib.closing(sqlite3.connect(path)) as database:
        database.executescript(
            """
            pragma application_id = 0x47504B47; pragma user_version = 10200;
            create table gpkg_spatial_ref_sys(srs_name text, srs_id integer primary key, organization text,
                organization_coordsys_id integer, definition text, description text);
            create table gpkg_contents(table_name text primary key, data_type text, identifier text, description text,
                last_change text, min_x double, min_y double, max_x double, max_y double, srs_id integer);
            create table gpkg_geometry_columns(table_name text, column_name text, geometry_type_name text,
                srs_id integer, z tinyint, m tinyint);
            """
        )
        database.execute("insert into gpkg_spatial_ref_sys values('', ?, 'EPSG', ?, 'undefined', '')", (epsg, epsg))
        for name, (fields, rows) in layers.items():
            database.execute(f"create table {name}(fid integer primary key, geom blob{fields})")
            database.execute(
                "insert into gpkg_contents values(?, 'features', ?, '', '2026-01-01T00:00:00.000Z', 0, 0, 1, 1, ?)",
                (name, name, epsg),
            )
            database.execute(
                "insert into gpkg_geometry_columns values(?, 'geom', 'GEOMETRY', ?, 2, 0)", (name, epsg)
            )
            for geometry, *values in rows:
                blob = geometry and b"GP\0\1" + struct.pack("<i", epsg) + geometry
                marks = ", ?" * (1 + len(values))
                database.execute(f"insert into {name} values(null{marks})", (blob, *values))
        database.commit()
    return path


def rows_of(path, query):
    with contextlib.closing(sqlite3.connect(path)) as database:
        return database.execute(query).fetchall()


def vertices(path):
    return np.array([line.split()[1:] for line in path.read_text().splitlines() if line[:2] == "v "], float)


def read_and_write(folder):
    """Triangles of a layer are those of its points, and have the points, heights and fields."""
    to = {ending: folder / f"t.{ending}" for ending in ("gpkg", "shp", "fgb", "geojson", "obj", "npy")}
    for ending in ("gpkg", "shp", "fgb", "geojson", "obj"):
        fields = ("--fields", "intensity,class") if ending in ("gpkg", "shp", "fgb") else ()
        works("triangulate", SAMPLES, *HEIGHT, *fields, "-o", to[ending], *ON_HOST)
    works("triangulate", SAMPLES, "--triangles", to["npy"], "--points", folder / "p.npy", *ON_HOST)
    works("triangulate", folder / "p.npy", "--triangles", folder / "u.npy", *ON_HOST)
    triangles, points = np.load(to["npy"]), vertices(to["obj"])
    assert np.array_equal(triangles, np.load(folder / "u.npy"))
    assert np.array_equal(points[:, :2], np.load(folder / "p.npy")) and points[:, 2].min() > 1300
    assert works("verify", SAMPLES, to["npy"]).startswith("right")
    rows = rows_of(to["gpkg"], "select point_a, point_b, point_c, z, intensity, class from triangles order by fid")
    assert np.array_equal([row[:3] for row in rows], triangles)
    assert np.allclose([row[3] for row in rows], points[triangles, 2].mean(axis=1), rtol=1e-15)
    assert all(2 <= row[5] <= 6 and row[4] > 1000 for row in rows)
    assert rows_of(to["gpkg"], "select srs_id, data_type from gpkg_contents") == [(32104, "features")]
    assert json.loads(to["geojson"].read_text())["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::32104"
    # All of a shapefile, and nothing of an older one.
    works("triangulate", DATA / "ukraine.xy", "-o", folder / "t.shp", *ON_HOST)
    assert sorted(path.suffix for path in folder.glob("t.sh*")) == [".shp", ".shx"]
    assert (folder / "t.dbf").exists() and not (folder / "t.prj").exists()
    works("triangulate", SAMPLES, *HEIGHT, "-o", folder / "t.shp", *ON_HOST)
    assert b"Nebraska" in (folder / "t.prj").read_bytes()
    # Polygons that are read again have the fields as properties, and ours have other names then.
    for ending in ("shp", "fgb", "gpkg"):
        works("triangulate", to[ending], "-o", folder / "again.geojson", *ON_HOST)
        again = json.loads((folder / "again.geojson").read_text())["features"]
        assert len(again) == len(triangles)
        assert {"triangle", "flaunay_triangle", "point_a", "z"} - again[0]["properties"].keys() == {"flaunay_triangle"}
    works("triangulate", to["gpkg"], "-o", folder / "again.gpkg", *ON_HOST)
    works("triangulate", to["gpkg"], "--fields", "z", "-o", folder / "same.gpkg", *ON_HOST)
    assert len(rows_of(folder / "same.gpkg", "select z, flaunay_point_a from triangles")) == len(triangles)
    row = rows_of(folder / "again.gpkg", "select point_a, flaunay_point_a, polygon from triangles where polygon = 7")
    assert row[0][0] == triangles[7][0]
    # What the file says of coordinates, and what the user says.
    works("triangulate", DATA / "garden.las", "-o", to["gpkg"], *ON_HOST)
    assert rows_of(to["gpkg"], "select srs_id from gpkg_contents") == [(32104,)]
    works("triangulate", DATA / "ukraine.xy", "-o", to["gpkg"], "--crs", "EPSG:2154", *ON_HOST)
    assert rows_of(to["gpkg"], "select srs_id from gpkg_contents") == [(2154,)]
    works("triangulate", DATA / "africa.geojson", "-o", to["gpkg"], *ON_HOST)
    assert rows_of(to["gpkg"], "select srs_id from gpkg_contents") == [(4326,)]
    assert ("Liberia",) in rows_of(to["gpkg"], "select distinct name from triangles")


def kinds_of_geometry(folder):
    square = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]
    mixed = package(
        folder / "mixed.gpkg",
        {
            "points": (", v real", [(wkb(POINT, (0.5, 0.5)), 3.0), (wkb(POINT, (3, 1)), None), (None, 1.0)]),
            "everything": (
                "",
                [
                    (wkb(MULTIPOINT, [wkb(POINT, (1, 1)), wkb(POINT, (2, 3))]),),
                    (wkb(COLLECTION, [wkb(LINE, [(5, 5), (6, 6)]), wkb(POINT, (1, 2))]),),
                    (wkb(POLYGON, [square, [(1, 1), (1, 2), (2, 1), (1, 1)]]),),
                    (wkb(TIN, [wkb(TRIANGLE, [[(9, 0), (9, 1), (8, 0), (9, 0)]])]),),
                ],
            ),
            "round": ("", [(wkb(CURVE_POLYGON, [wkb(CIRCULAR, [(0, 0), (2, 0), (0, 0)])]),)]),
            "spatial": ("", [(wkb(LINE, [(0, 0, 1), (2, 0, 3)], z=True),), (wkb(POINT, (1, 5)),)]),
            "empty": ("", []),
            "endless": ("", [(wkb(POINT, (0, 1)),), (wkb(LINE, [(1, 1), (np.inf, 2)]),)]),
            "ring": ("", [(wkb(POLYGON, [[(0, 0), (1, 1), (0, 0)]]),)]),
        },
    )

    def triangulated(layer, *options):
        return works("triangulate", f"{mixed}:{layer}", "-o", folder / "out.obj", *options, *ON_HOST)

    assert "layer 'points' has 1 features without a geometry" in triangulated("points")
    assert "15 points, 2 duplicates" in triangulated("everything")
    triangulated("round", "--points", folder / "circle.npy")
    circle = np.load(folder / "circle.npy")
    assert len(circle) > 30 and np.allclose(np.hypot(*(circle - (1, 0)).T), 1)
    triangulated("spatial")
    assert vertices(folder / "out.obj")[:2, 2].tolist() == [1, 3]
    to = ("-o", folder / "out.off")
    for layer, code, *parts in (
        ("nowhere", 3, "has no layer 'nowhere'", "points, everything, round"),
        ("empty", 3, "layer 'empty' has no feature"),
        ("endless", 3, "layer 'endless', feature 2", "(inf, 2)", "finite"),
        ("ring", 3, "layer 'ring', feature 1", "ring"),
    ):
        fails(code, "mixed.gpkg", *parts, arguments=("triangulate", f"{mixed}:{layer}", *to))
    fails(3, "has the layers points, everything", f"{mixed}:points", arguments=("triangulate", mixed, *to))
    grid = ("--resolution", 1, "-o", folder / "dem.npy")
    fails(3, "has polygons", "--flat", arguments=("terrain", f"{mixed}:everything", *grid))
    fails(3, "has no height", "--height", arguments=("terrain", f"{mixed}:points", *grid))
    fails(3, "position 1, (3, 1)", "has no height", arguments=("terrain", f"{mixed}:points", *grid, "--height", "v"))
    fails(3, "has no polygon", arguments=("terrain", SAMPLES, *HEIGHT, *grid, "--boundary", CONTOURS))


def breaklines(folder):
    """Lines of another file become edges, and their points come behind the others."""
    to = ("-o", folder / "t.obj", "--points", folder / "p.npy", "--constraint-edges", folder / "e.npy", *ON_HOST)
    lines = ("--constraints", CONTOURS)
    works("triangulate", SAMPLES, *HEIGHT, *lines, *to, "--triangles", folder / "t.npy")
    points, edges = vertices(folder / "t.obj"), np.load(folder / "e.npy")
    assert len(points) == 226 + 890 and not (points[226:, 2] % 4).any() and np.isfinite(points).all()
    assert len(edges) == 850 and len(np.unique(points[edges, 2], axis=0)) < 12
    assert works("verify", SAMPLES, folder / "t.npy", *lines).startswith("right")
    # Without heights, those of the points around.
    flat = {"type": "LineString", "coordinates": [[2445185, 604305], [2445235, 604335]]}
    (folder / "flat.geojson").write_text(json.dumps(flat))
    works("triangulate", SAMPLES, *HEIGHT, "--constraints", folder / "flat.geojson", *to)
    points = vertices(folder / "t.obj")
    assert len(points) == 228 and (points[:226, 2].min() < points[226:, 2]).all()
    # Points of text, and heights of lines alone.
    np.save(folder / "q.npy", points[:, :2])
    works("triangulate", folder / "q.npy", *HEIGHT, *lines, *to)
    far = package(folder / "far.gpkg", {"lines": ("", [(wkb(LINE, [(2445190, 604310), (2445200, 604320)]),)])})
    fails(3, "far.gpkg", "EPSG:25832", "EPSG:32104", arguments=("triangulate", SAMPLES, "--constraints", far, *to))
    indices = folder / "s.npy"
    fails(2, "--constraints", "map", arguments=("triangulate", SAMPLES, "--constraints", indices, *to))


def geojson(path, geometries, crs=None, **properties):
    """properties: for each name the values of the features; ... for one that has it not."""
    document = {"type": "FeatureCollection", "features": []}
    if crs:
        document["crs"] = {"type": "name", "properties": {"name": crs}}
    for k, (kind, coordinates) in enumerate(geometries):
        own = {name: values[k] for name, values in properties.items() if values[k] is not ...}
        geometry = {"type": kind, "coordinates": coordinates}
        document["features"].append({"type": "Feature", "properties": own, "geometry": geometry})
    path.write_text(json.dumps(document))
    return path


CORNERS = [(0, 0), (8, 0), (9, 9), (0, 7)]


def fields_of_geojson(folder):
    """Numbers of properties are read without GDAL."""
    points = [("Point", at) for at in CORNERS]
    path = geojson(folder / "f.geojson", points, h=[1, 2.5, ..., None], area=[3, 4, 5, 6], t=["a", 1, 1, 1])
    out = folder / "f.obj"
    said = works("triangulate", path, "--height", "nowhere,h", "-o", out, *ON_HOST)
    assert "note: " in said and "2 of 4 positions have no height" in said, said
    assert vertices(out)[:2, 2].tolist() == [1, 2.5]
    cells = folder / "f-cells.geojson"
    works("voronoi", path, "--height", "h", "--fields", "area", "-o", cells, *ON_HOST)
    found = sorted((cell["properties"] for cell in cells_of(cells)), key=lambda cell: cell["point"])
    assert [cell["area"] for cell in found] == [3, 4, 5, 6] and [cell["z"] for cell in found] == [1, 2.5, None, None]
    assert all(cell["flaunay_area"] > 0 for cell in found)
    fails(3, "f.geojson", "features[0].properties.t", "number", arguments=("voronoi", path, "--height", "t", "-o", cells))
    works("voronoi", path, "--fields", "t", "-o", cells, *ON_HOST)
    assert [cell["properties"]["t"] for cell in cells_of(cells)] == ["a", 1, 1, 1]
    fails(3, "no field 'no'", "area, h, t", arguments=("voronoi", path, "--fields", "no", "-o", cells))
    for command in ("voronoi", "triangulate"):
        fails(3, "no field no, of --height", "area, h, t", arguments=(command, path, "--height", "no", "-o", cells))
    # Heights of lines have a field of their own.
    line = geojson(folder / "line.geojson", [("LineString", [(1, 1), (7, 1)])], area=[99], e=[50])
    heights = ("--height", "area", "--constraints", line)
    for option, height in (((), 99), (("--line-height", "e"), 50)):
        works("triangulate", path, *heights, *option, "-o", out, *ON_HOST)
        assert vertices(out)[:, 2].tolist() == [3, 4, 5, 6, height, height]
    fails(3, "line.geojson", "no field h, of --line-height", "area, e", arguments=("triangulate", path, *heights, "--line-height", "h", "-o", out))
    lines = ("--height", "no", "--constraints", line, "--line-height", "e")
    fails(3, "f.geojson", "no field no", arguments=("triangulate", path, *lines, "-o", out))
    grid = ("--resolution", 1, "--height", "area", "-o", folder / "f.npy", *ON_HOST)
    works("terrain", path, *grid, "--breaklines", line, "--line-height", "e")
    assert np.nanmax(np.load(folder / "f.npy")) > 40
    for weighted in ("a.gpkg", path):
        done = run("triangulate", weighted, "--weighted", "-o", out)
        assert done.returncode == 2 and "expected .las, .npy, .txt, .xyz, .csv\n" in done.stderr, done.stderr


def fields_of_text(folder):
    """Columns of text are kept as they are: numbers only if all of a column are some."""
    path, cells = folder / "wells.csv", folder / "wells.geojson"
    path.write_text("""name;x;y;ph;depth;dug;house;odd
"Old ""Well""; north";1,5;2;7,5;10;2024-03-01;007;1,5
B2;4;2,25;;12;2023-01-31;12;2
B3;3;7;6,25;;;13;3 m
"No. #4";8;8;7;9223372036854775;x;14;4
second;8;8;1;1;x;15;5
""")
    fields = ("name", "ph", "depth", "dug", "house")
    works("voronoi", path, "--columns", "x,y", "--fields", ",".join(fields), "-o", cells, *ON_HOST)
    right = [("Old \"Well\"; north", 7.5, 10, "2024-03-01", "007"), ("B2", None, 12, "2023-01-31", "12"),
             ("B3", 6.25, None, None, "13"), ("No. #4", 7, 9223372036854775, "x", "14")]
    assert [tuple(cell["properties"][name] for name in fields) for cell in cells_of(cells)] == right
    # Without --columns, the others are x, y and perhaps a height.
    plain = folder / "plain.txt"
    plain.write_text("a 1 2 5\nb 3 4 6\nc 7 8 nan\n")
    works("voronoi", plain, "--fields", "3,0", "-o", cells, *ON_HOST)
    assert [tuple(cell["properties"].values())[2:] for cell in cells_of(cells)] == [(5, "a"), (6, "b"), (None, "c")]
    works("voronoi", plain, "--fields", "0", "--columns", "1,2", "-o", cells, *ON_HOST)
    for text, options, parts in (
        ("x,y,c\n1,2,#ff\n", ("c",), ("line 2", "comment", "quotes")),
        ("x,y,c\n1,2,a b\n3,4\n", ("c",), ("line 3", "has 2 fields, but the header has 3", "empty")),
        ("1,2,a,3\n0,0,old, dry,3\n", ("2,3",), ("line 2", "has 5 fields, but the first line of points has 4", "quotes")),
        ("x y c d\n1 2  3\n", ("c,d",), ("line 2", "has 3 fields, but the header has 4", "empty")),
        ('x,y,c\n0,0,"a, b\n1,2,b"\n', ("c",), ("line 2", "the field '\"a' has no second double quote on its line")),
        ("x,y,# of wells,c\n1,2,3,4\n", ("c",), ("line 1", "comment", "quotes")),
        ("x,y,c\n1,2,a b\n", ("d",), ("no column 'd'", "x, y, c")),
        ("x,y,c\n1,2,a b\n", ("x", "--columns", "x,y"), ("'x' is chosen twice",)),
        ("x,y,z,c\n1,2,,a\n", ("c",), ("line 2", "a height of point 0", "nothing; --columns X,Y")),
        ("i;x;y;c;d\na;1,5;2;3;4\n", ("c",), ("line 2", "found 5;", "--columns")),
    ):
        (folder / "wrong.csv").write_text(text)
        fails(3, "wrong.csv", *parts, arguments=("voronoi", folder / "wrong.csv", "-o", cells, "--fields", *options))
    # Tabs that are the only separators have empty fields between them, and fields with spaces.
    plain.write_text("x\ty\tname\tdepth\n4,5\t0\t\t+49151\n0\t0\told well\t3\n0\t4\t5\" pipe\t\n")
    works("voronoi", plain, "--fields", "name,depth", "-o", cells, *ON_HOST)
    right = [(None, "+49151"), ("old well", "3"), ('5" pipe', None)]
    assert [tuple(cell["properties"].values())[2:] for cell in cells_of(cells)] == right
    # A column has one decimal mark, that of coordinates.
    for coordinate, values, right in (
        ("1,5", ("1.2", "2"), ["1.2", "2"]),
        ("1", ("1.2", "2"), [1.2, 2]),
        ("1,5", ("1,2", "2"), [1.2, 2]),
        ("1", ("1,2", "1.2"), ["1,2", "1.2"]),
    ):
        plain.write_text(f"x;y;section\n{coordinate};2;{values[0]}\n4;4;{values[1]}\n2;9;\n")
        works("voronoi", plain, "--fields", "section", "-o", cells, *ON_HOST)
        assert [cell["properties"]["section"] for cell in cells_of(cells)] == [*right, None]
    # Many commas in quotes take no longer than others, as each one is not compared with all quotes.
    wide = '"' + "1 2," * 100000 + '"'
    plain.write_text("c,x,y\n" + "".join(f"{wide},{k},{k * k}\n" for k in range(3)))
    begin = time.monotonic()
    works("voronoi", plain, "--columns", "x,y", "--fields", "c", "-o", cells, *ON_HOST)
    assert time.monotonic() - begin < 10
    if not HAS_GDAL:
        return
    out = folder / "wells.gpkg"
    arguments = ("triangulate", path, "--columns", "x,y", "-o", out, "--fields")
    works(*arguments, "ph,depth", *ON_HOST)
    assert rows_of(out, "select ph, depth from triangles order by fid")[0] == (6.875, 11)
    fails(3, "wells.csv", "'odd' is no number", "point 2 has '3 m'", arguments=(*arguments, "odd"))
    fails(3, "wells.csv", "'house' is no number", "point 0 has '007'", arguments=(*arguments, "house"))
    for value in ("inf", "007", "1e999", "1234567890123456789", '"1,5"'):
        plain.write_text(f"x,y,q\n0,0,1\n4,0,2\n0,4,{value}\n")
        said = "point 2 has '" + value.strip('"')
        fails(3, said, arguments=("triangulate", plain, "--columns", "x,y", "--fields", "q", "-o", out))
    works("voronoi", path, "--columns", "x,y", "--fields", "name,ph,depth", "-o", out, *ON_HOST)
    types = rows_of(out, "select typeof(name), typeof(ph), typeof(depth) from cells order by fid")
    assert types[:2] == [("text", "real", "integer"), ("text", "null", "integer")]


def systems(folder):
    """Coordinates of two systems are not mixed, and files only name systems."""
    near = [(9, 49), (9.5, 49), (9.2, 49.4)]
    metres = [(500000, 5500000), (500100, 5500000), (500040, 5500090)]
    degrees = geojson(folder / "degrees.geojson", [("LineString", near[:2])])
    crs84 = "urn:ogc:def:crs:OGC:1.3:CRS84"
    qgis = geojson(folder / "qgis.geojson", [("Point", at) for at in near], crs84)
    utm = geojson(folder / "utm.geojson", [("Point", at) for at in metres], "urn:ogc:def:crs:EPSG::25832")
    wgs = geojson(folder / "wgs.geojson", [("LineString", near[:2])], "EPSG:4326")
    to = ("-o", folder / "systems.off", *ON_HOST)
    for lines in (degrees, wgs):
        fails(3, lines, "EPSG:25832", "--crs", arguments=("triangulate", utm, "--constraints", lines, *to))
        works("triangulate", qgis, "--constraints", lines, *to)
        works("triangulate", utm, "--constraints", lines, "--crs", "EPSG:25832", *to)
    if not HAS_GDAL:
        return
    out = folder / "systems.gpkg"
    works("triangulate", qgis, "-o", out, *ON_HOST)
    assert rows_of(out, "select srs_id from gpkg_contents") == [(4326,)]
    local = folder / "local.prj"
    local.write_text('PROJCS["mine",GEOGCS["x",DATUM["d",SPHEROID["s",6378137,298.25]],PRIMEM["Greenwich",0],'
                     'UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],'
                     'PARAMETER["central_meridian",9.1],UNIT["metre",1]]')
    for name in ("EPSG:99999999", "http://127.0.0.1:9/crs", str(local), "+proj=utm +zone=32"):
        odd = geojson(folder / "odd.geojson", [("Point", at) for at in near], name)
        works("triangulate", odd, *to)
        for arguments in (("triangulate", odd, "-o", out), ("voronoi", odd, "-o", out)):
            fails(3, "odd.geojson", name, "--crs", arguments=arguments)
        works("triangulate", odd, "-o", out, "--crs", "EPSG:4326", *ON_HOST)
    said = works("triangulate", utm, "-o", folder / "mine.geojson", "--crs", local, *ON_HOST)
    assert "note: " in said and "mine.geojson has no coordinate system" in said, said
    # Layers without one.
    for number in (-1, 0):
        none = package(folder / "none.gpkg", {"p": ("", [(wkb(POINT, at),) for at in metres])}, number)
        works("triangulate", none, "--constraints", wgs, "-o", folder / "none.geojson", *ON_HOST)
        assert "crs" not in json.loads((folder / "none.geojson").read_text())


def kept(folder):
    """What is written keeps what was read, or notes that it does not."""
    square = [[(0, 0), (9, 0), (9, 9), (0, 0)]]
    names = {"name": ["Ки\u0457в \u0141"], "very_long_name_a": [1], "very_long_name_b": [2]}
    path = geojson(folder / "text.geojson", [("Polygon", square)], **names)
    for ending in ("qix", "sbn", "sbx"):
        (folder / f"text.{ending}").write_bytes(b"old")
    said = works("triangulate", path, "-o", folder / "text.shp", *ON_HOST)
    assert said.count("note: ") == 2 and "very_long_name_b" in said and ".gpkg" in said, said
    assert (folder / "text.cpg").read_text().strip() == "UTF-8"
    assert names["name"][0].encode() in (folder / "text.dbf").read_bytes()
    assert not [ending for ending in ("qix", "sbn", "sbx") if (folder / f"text.{ending}").exists()]
    # A Shapefile that does not say the encoding of its texts.
    table = (folder / "text.dbf").read_bytes().replace(names["name"][0].encode(), b"Stra\xdfe\x96" + bytes(4))
    (folder / "text.dbf").write_bytes(table[:29] + b"\0" + table[30:])
    (folder / "text.cpg").unlink()
    said = works("voronoi", folder / "text.shp", "--fields", "name", "-o", folder / "latin.geojson", *ON_HOST)
    assert "text.cpg" in said and cells_of(folder / "latin.geojson")[0]["properties"]["name"].startswith("Straße–")
    # Columns that a GeoPackage has of its own, and several triangles of a feature.
    path = geojson(folder / "own.geojson", [("Polygon", [[(0, 0), (9, 0), (9, 9), (0, 9), (0, 0)]])], fid=[7], Geom=["a"])
    works("triangulate", path, "-o", folder / "own.gpkg", *ON_HOST)
    assert rows_of(folder / "own.gpkg", "select fid, Geom from triangles") == [(7, "a")] * 2
    # Times are by ISO 8601, truth values 1 and 0 in every format, and no name is there twice in any case.
    times = ("2024-01-02", "2024-01-02T10:00:00Z", "2024-01-02T10:00:00.250+05:30")
    types = ", day date, time datetime, zone datetime, dry boolean, n integer"
    path = package(folder / "times.gpkg", {"p": (types, [(wkb(POINT, at), *times, 1, -(10**17) - 1) for at in CORNERS])})
    fields = ("--fields", "day,time,zone,dry,n", "-o")
    assert "note: " not in works("voronoi", path, *fields, folder / "times.geojson", *ON_HOST)
    found = cells_of(folder / "times.geojson")[0]["properties"]
    assert [*found.values()][2:] == [*times, 1, -(10**17) - 1], found
    assert "18 characters are rounded; .gpkg" in works("voronoi", path, *fields, folder / "times.shp", *ON_HOST)
    path = geojson(folder / "case.geojson", [("Point", at) for at in CORNERS], id=[2] * 4, ID=[True] * 4)
    works("voronoi", path, "--fields", "id,ID", "-o", folder / "case.gpkg", *ON_HOST)
    assert rows_of(folder / "case.gpkg", "select id, flaunay_ID from cells")[0] == (2, 1)
    # A GeoPackage with layers of others is not lost.
    project = package(folder / "project.gpkg", {"wells": ("", [(wkb(POINT, (1, 2)),)])})
    for arguments in (
        ("triangulate", path, "-o", project),
        ("voronoi", path, "-o", project),
        ("terrain", SAMPLES, *HEIGHT, "--resolution", 1, "--contours", 4, "-o", project),
    ):
        fails(3, "project.gpkg", "wells", "lost", arguments=arguments)
    # Nor are features or heights.
    cut = folder / "cut.fgb"
    for size in (35315, 30000):
        cut.write_bytes(SAMPLES.read_bytes()[:size])
        fails(3, "cut.fgb", arguments=("triangulate", cut, "-o", folder / "cut.off"))
    none = package(folder / "null.gpkg", {"p": (", h real", [(wkb(POINT, at), None) for at in CORNERS])})
    for command in ("triangulate", "voronoi"):
        to = ("-o", folder / "null.geojson")
        fails(3, "null.gpkg", "no value in the field h", arguments=(command, none, "--height", "h", *to))


def wrong_files(folder):
    to = ("-o", folder / "out.gpkg")
    text = folder / "text.gpkg"
    text.write_text("no package")
    # Of the ending alone: no other driver of GDAL, which may read files of other names.
    virtual = folder / "virtual.gpkg"
    virtual.write_text('<OGRVRTDataSource><OGRVRTLayer name="a"><SrcDataSource>/</SrcDataSource></OGRVRTLayer>')
    (folder / "some.parquet").write_bytes(b"PAR1")
    for code, parts, arguments in (
        (3, ("no field high", "intensity"), (SAMPLES, "--height", "high", *to)),
        (3, ("'surface' is no number",), (SAMPLES, "--height", "surface", *to)),
        (3, ("layer 'garden'", "no field 'weight'", "class"), (SAMPLES, "--fields", "weight", *to)),
        (3, ("'surface' is no number",), (SAMPLES, "--fields", "surface", *to)),
        (2, ("--fields", ".fgb"), (SAMPLES, "--fields", "class", "-o", folder / "out.obj")),
        (2, ("--crs", ".geojson"), (SAMPLES, "--crs", "EPSG:4326", "-o", folder / "out.obj")),
        (2, ("ukraine.xy has columns", "--columns"), (DATA / "ukraine.xy", *HEIGHT, *to)),
        (2, ("garden.las has no fields",), (DATA / "garden.las", *HEIGHT, *to)),
        (2, ("no columns",), (SAMPLES, "--columns", "0,1", *to)),
        (3, ("--crs", "EPSG:0"), (SAMPLES, "--crs", "EPSG:0", *to)),
        (3, ("--crs", "'2154'", "such as EPSG:"), (SAMPLES, "--crs", "2154", *to)),
        (2, ("--fields", "class twice"), (SAMPLES, "--fields", "class,class", *to)),
        (3, ("text.gpkg", "cannot be read"), (text, *to)),
        (3, ("virtual.gpkg", "cannot be read"), (virtual, *to)),
        (3, ("none.shp", "No such file"), (folder / "none.shp", *to)),
        (2, ("unknown ending '.gpkg:layer'",), (SAMPLES, "-o", folder / "out.gpkg:layer")),
        (2, ("overwrite",), (f"{text}:layer", "-o", text)),
    ):
        fails(code, *parts, arguments=("triangulate", *arguments))
    assert not (folder / "out.gpkg").exists()
    done = run("triangulate", SAMPLES, "-o", folder / "out.parquet")
    assert done.returncode == 0 or "no driver Parquet" in done.stderr, done.stderr


def terrain(folder):
    """Points and breaklines of layers give the raster of the same points and lines in other files."""
    grid = ("--resolution", 1, *ON_HOST)
    works("triangulate", SAMPLES, *HEIGHT, "-o", folder / "s.obj", *ON_HOST)
    works("triangulate", CONTOURS, *HEIGHT, "-o", folder / "c.obj", "--crossings", "split", *ON_HOST)
    np.save(folder / "s.npy", vertices(folder / "s.obj"))
    works("terrain", SAMPLES, *HEIGHT, *grid, "-o", folder / "a.npy", "-o", folder / "a.gpkg", "--contours", 4)
    works("terrain", folder / "s.npy", *grid, "-o", folder / "b.npy")
    assert (folder / "a.npy").read_bytes() == (folder / "b.npy").read_bytes()
    # The test's contours were made in this way.
    assert rows_of(folder / "a.gpkg", "select srs_id from gpkg_contents") == [(32104,)]
    works("terrain", SAMPLES, *HEIGHT, *grid, "-o", folder / "again.shp", "--contours", 4)
    assert (folder / "again.shp").read_bytes() == CONTOURS.read_bytes()
    works("terrain", SAMPLES, *HEIGHT, *grid, "-o", folder / "a.npy", "--breaklines", CONTOURS)
    with_lines = np.load(folder / "a.npy")
    there = np.isfinite(with_lines)
    assert there.any() and np.nanmax(np.abs(with_lines - np.load(folder / "b.npy"))) < 4
    # Contours alone, as points.
    works("terrain", CONTOURS, *HEIGHT, *grid, "-o", folder / "a.npy")
    lines, found = vertices(folder / "c.obj")[:, 2], np.load(folder / "a.npy")
    assert not (lines % 4).any() and lines.min() - 1e-9 <= np.nanmin(found) <= np.nanmax(found) <= lines.max()
    other = package(folder / "other.gpkg", {"lines": ("", [(wkb(LINE, [(2445190, 604310), (2445200, 604320)]),)])})
    to = ("-o", folder / "a.npy")
    both = ("other.gpkg", "EPSG:25832", "EPSG:32104")
    fails(3, *both, arguments=("terrain", SAMPLES, *HEIGHT, *grid, *to, "--breaklines", other))
    spatial = package(folder / "spatial.gpkg", {"p": ("", [(wkb(POINT, (2445190, 604310, 4), z=True),)])})
    fails(3, "spatial.gpkg", "--crs", arguments=("terrain", SAMPLES, spatial, *HEIGHT, *grid, *to))
    works("terrain", SAMPLES, spatial, *HEIGHT, *grid, *to, "--crs", "EPSG:32104")
    fails(3, "garden-samples.fgb", "no field high", "class", arguments=("terrain", SAMPLES, "--height", "high", *grid, *to))
    fails(3, "nowhere/", "no folder", arguments=("terrain", "nowhere/", *grid, *to))
    assert "no point is in --bounds" in works("terrain", SAMPLES, *HEIGHT, *grid, *to, "--bounds", "0,0,9,9")
    fails(3, "no layer has a field high", arguments=("terrain", spatial, "--height", "high", *grid, *to))


def shading(folder):
    random = np.random.default_rng(5)
    points = np.column_stack([random.random((300, 2)) * 0.02 - 0.01, random.random(300)])
    pictures = {}

    def picture(name, heights, *options):
        np.save(folder / "p.npy", points * (1, 1, heights))
        path = folder / f"{name}.png"
        works("terrain", folder / "p.npy", "--resolution", 0.0005, "-o", path, *options, *ON_HOST)
        pictures[name] = path.read_bytes()

    picture("plain", 0.01)
    picture("flat", 0.005)
    picture("factor", 0.005, "--vertical-factor", 2)
    picture("degrees", 0.01 * 111195, "--crs", "EPSG:4326")
    picture("colors", 0.01, "--colors")
    assert pictures["plain"] == pictures["factor"] == pictures["degrees"] != pictures["flat"]
    assert pictures["plain"][25] == 4 and pictures["colors"][25] == 6  # grey, RGB; and alpha
    fails(2, "--colors", arguments=("terrain", folder / "p.npy", "--resolution", 1, "-o", folder / "a.npy", "--colors"))


def columns(folder):
    """Columns of wider arrays."""
    points = np.random.default_rng(6).random((500, 2))
    for kind in np.float64, np.float32:
        wide = np.column_stack([np.arange(500), points[:, 1], np.zeros((500, 2)), points[:, 0]]).astype(kind)
        np.save(folder / "wide.npy", wide)
        np.save(folder / "plain.npy", np.ascontiguousarray(wide[:, [4, 1]]))
        made = []
        for input in (("plain.npy",), ("wide.npy", "--columns", "4,1"), ("wide.npy", "--columns", "4,1", "--memory", "1G")):
            works("triangulate", folder / input[0], *input[1:], "--triangles", folder / "t.npy", *ON_HOST)
            made.append(sorted(map(tuple, np.load(folder / "t.npy"))))
        assert made[0] == made[1] == made[2]
        works("triangulate", folder / "wide.npy", "--columns", "4,1,0", "-o", folder / "w.obj", *ON_HOST)
        assert np.array_equal(vertices(folder / "w.obj").astype(kind), wide[:, [4, 1, 0]])
    grid = ("--resolution", 0.1, *ON_HOST)
    works("terrain", folder / "wide.npy", "--columns", "4,1,0", *grid, "-o", folder / "a.npy")
    np.save(folder / "plain.npy", np.ascontiguousarray(wide[:, [4, 1, 0]]))
    works("terrain", folder / "plain.npy", *grid, "-o", folder / "b.npy")
    assert (folder / "a.npy").read_bytes() == (folder / "b.npy").read_bytes()
    to = (folder / "wide.npy", "-o", folder / "t.off", "--columns")
    fails(3, "wide.npy", "no column", arguments=("triangulate", *to, "0,5"))
    fails(3, "no column 'x'", arguments=("triangulate", *to, "x,1"))
    fails(3, "needs 3 columns", arguments=("terrain", folder / "wide.npy", *grid, "-o", folder / "a.npy", "--columns", "0,1"))


def cells_of(path):
    return json.loads(path.read_text())["features"]


def area(feature):
    (ring,) = feature["geometry"]["coordinates"]
    x, y = np.transpose(ring)
    assert ring[0] == ring[-1]
    return (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2


def voronoi(folder):
    path = folder / "cells.geojson"
    box = ("--bounds", "0,0,400,400")
    assert "cells" in works("voronoi", DATA / "ukraine.xy", "-o", path, *box, "--crs", "EPSG:3857", *ON_HOST)
    cells = cells_of(path)
    assert np.isclose(sum(map(area, cells)), 400 * 400)
    assert all(np.isclose(area(cell), cell["properties"]["area"]) for cell in cells)
    points = np.loadtxt(DATA / "ukraine.xy")
    assert {tuple(points[cell["properties"]["point"]]) for cell in cells} == set(map(tuple, points))
    one = folder / "one.csv"
    one.write_text("x,y,z\n3,4,5\n")
    works("voronoi", one, "-o", path, *ON_HOST)
    assert cells_of(path)[0]["properties"] == {"point": 0, "area": 4, "z": 5}
    fails(2, "--bounds", arguments=("voronoi", one, "-o", path, "--bounds", "1,1,0,2"))
    fails(2, ".geojson", arguments=("voronoi", one, "-o", folder / "cells.obj"))
    one.write_text("x,y\n")
    fails(3, "one.csv", "no points", arguments=("voronoi", one, "-o", path))


def main(folder):
    columns(folder)
    voronoi(folder)
    fields_of_geojson(folder)
    fields_of_text(folder)
    systems(folder)
    if not HAS_GDAL:
        for arguments in (
            (SAMPLES, "-o", folder / "t.off"),
            (DATA / "ukraine.xy", "-o", folder / "t.gpkg"),
        ):
            fails(2, "FLAUNAY_GDAL", arguments=("triangulate", *arguments))
        return
    works("voronoi", SAMPLES, *HEIGHT, "--fields", "class", "-o", folder / "cells.gpkg", *ON_HOST)
    found = rows_of(folder / "cells.gpkg", 'select point, area, z, "class" from cells')
    assert len(found) == 226 and {row[3] for row in found} == {2, 6} and all(row[2] > 1300 for row in found)
    read_and_write(folder)
    kinds_of_geometry(folder)
    breaklines(folder)
    wrong_files(folder)
    kept(folder)
    terrain(folder)
    shading(folder)
    assert not [path.name for path in folder.iterdir() if "partial" in path.name]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        main(Path(name))
