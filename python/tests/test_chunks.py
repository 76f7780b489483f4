"""Triangulations in chunks: from and to files that are mapped into memory."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import flaunay
from conftest import check_neighbors

SMALL = {"chunk_points": 500, "devices": "host"}


def rows_with_neighbors(triangles, neighbors):
    """Each triangle with the triangles beyond its sides, whatever the order of rows."""
    rows = [tuple(row) for row in triangles.tolist()]
    return {
        row: tuple(rows[t] if t >= 0 else None for t in beyond)
        for row, beyond in zip(rows, neighbors.tolist())
    }


def check_same(mesh, points):
    """The result is that of one call."""
    expected = flaunay.triangulate(points, areas=True)
    assert mesh.triangles.shape == expected.triangles.shape
    assert rows_with_neighbors(mesh.triangles, mesh.neighbors) == rows_with_neighbors(
        expected.triangles, expected.neighbors
    )
    assert mesh.areas.dtype == np.float64 and mesh.areas.shape == expected.areas.shape
    assert dict(zip(map(tuple, mesh.triangles.tolist()), mesh.areas)) == dict(
        zip(map(tuple, expected.triangles.tolist()), expected.areas)
    )
    assert np.array_equal(mesh.hull, expected.hull)
    assert np.array_equal(mesh.representatives, expected.representatives)
    assert mesh.statistics["triangles"] == len(expected.triangles)
    assert mesh.statistics["hull_vertices"] == len(expected.hull)


NAMES = ("triangles", "neighbors", "hull", "representatives", "areas")
IN_MEMORY = dict.fromkeys(NAMES, True)


def paths_in(folder):
    return {name: folder / f"{name}.npy" for name in NAMES}


@pytest.fixture
def points(random):
    given = random.random((6000, 2))
    given[100:200] = given[:100]
    return given


@pytest.fixture
def file(points, tmp_path):
    path = tmp_path / "points.npy"
    np.save(path, points)
    return path


def test_from_a_file_to_files(file, points, tmp_path):
    paths = paths_in(tmp_path)
    mesh = flaunay.triangulate_chunks(np.load(file, mmap_mode="r"), **paths, **SMALL)
    check_same(mesh, points)
    for name, path in paths.items():
        array = getattr(mesh, name)
        assert isinstance(array, np.memmap) and not array.flags.writeable
        stored = np.load(path)
        assert stored.dtype == (np.float64 if name == "areas" else np.int32)
        assert np.array_equal(stored, array)
        assert os.path.getsize(path) == 128 + stored.nbytes
    assert sorted(os.listdir(tmp_path)) == sorted(
        [file.name, *(path.name for path in paths.values())]
    )


def test_to_memory(points):
    mesh = flaunay.triangulate_chunks(points, **IN_MEMORY, **SMALL)
    check_same(mesh, points)
    check_neighbors(mesh.triangles, mesh.neighbors)
    assert mesh.triangles.dtype == np.int32
    # It was written to an array for all points, which is not kept.
    assert mesh.hull.base is None
    assert repr(mesh) == (
        f"<flaunay.ChunkedTriangulation: 6000 points, {len(mesh.triangles)} triangles, "
        f"{len(mesh.hull)} hull vertices>"
    )


def test_statistics(points):
    two = {**SMALL, "devices": ["host", "host"]}
    statistics = flaunay.triangulate_chunks(points, **two).statistics
    assert statistics["points"] == 6000 and statistics["duplicates"] == 100
    assert statistics["chunk_points"] == 500 and statistics["scratch_bytes"] >= 24 * 6000
    rounds = statistics["rounds"]
    assert len(rounds) >= 2 and rounds[0]["chunks"] >= 12
    assert sum(one["triangles"] for one in rounds) == statistics["triangles"]
    assert [one["points"] for one in rounds[1:]] == [one["handed_on"] for one in rounds[:-1]]
    assert [one["device"] for one in statistics["devices"]] == ["host", "host"]
    assert statistics["seconds"] > 0 and "distribute" in statistics["phases"]


def test_64_bits(points, tmp_path):
    paths = paths_in(tmp_path)
    del paths["hull"]
    mesh = flaunay.triangulate_chunks(points, hull=True, index=64, **paths, **SMALL)
    check_same(mesh, points)
    for name in IN_MEMORY:
        assert getattr(mesh, name).dtype == (np.float64 if name == "areas" else np.int64)
    narrow = flaunay.triangulate_chunks(points, hull=True, index=32, neighbors=False, **SMALL)
    assert narrow.hull.dtype == np.int32 and narrow.triangles is None and narrow.neighbors is None


def test_float32(points, tmp_path):
    path = tmp_path / "points.raw"
    points.astype(np.float32).tofile(path)
    mapped = np.memmap(path, np.float32, "r", shape=(6000, 2))
    mesh = flaunay.triangulate_chunks(mapped, **IN_MEMORY, **SMALL)
    check_same(mesh, points.astype(np.float32))


def test_any_strides(points, random):
    wide = random.random((6000, 5))
    wide[:, 3:0:-2] = points
    records = np.zeros(6000, np.dtype([("id", "u1"), ("xy", "f8", 2)]))  # not aligned
    records["xy"] = points
    for view in (
        wide[:, 3:0:-2],
        records["xy"],
        np.asfortranarray(points),
        np.broadcast_to(points[7], (50, 2)),
        points[::-3],
    ):
        assert not view.flags.c_contiguous or not view.flags.aligned
        check_same(flaunay.triangulate_chunks(view, **IN_MEMORY, **SMALL), view)
    for given in [[0, 0], [4, 0], [0, 4]], np.array([[0, 0], [4, 0], [0, 4]], ">f8"):
        assert flaunay.triangulate_chunks(given, triangles=True).triangles.tolist() == [[0, 1, 2]]


def private_bytes():
    """The memory of the process without mapped files."""
    with open("/proc/self/status") as status:
        return 1024 * next(int(line.split()[1]) for line in status if line.startswith("RssAnon"))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_points_are_not_copied(tmp_path, dtype):
    path = tmp_path / "zeros.npy"
    np.lib.format.open_memmap(path, "w+", dtype, (5 * 10**7, 2))  # a file with a hole
    points = np.load(path, mmap_mode="r")
    used = []

    def stop(stage, round, done):
        used.append(private_bytes())
        raise ZeroDivisionError

    before = private_bytes()
    with pytest.raises(ZeroDivisionError):
        flaunay.triangulate_chunks(points, memory="128M", progress=stop)
    assert used[0] - before < points.nbytes / 2


@pytest.mark.parametrize(
    "given", [np.empty((0, 2)), np.ones((1, 2)), np.ones((9, 2)), [[0, 0], [1, 1]]]
)
def test_few_points_and_equal_ones(given, tmp_path):
    for results in (IN_MEMORY, paths_in(tmp_path)):
        mesh = flaunay.triangulate_chunks(given, **results)
        assert mesh.triangles.shape == (0, 3) and mesh.neighbors.shape == (0, 3)
        expected = flaunay.triangulate(given)
        assert np.array_equal(mesh.hull, expected.hull)
        assert np.array_equal(mesh.representatives, expected.representatives)


@pytest.mark.parametrize("memory", ["256M", "256 mb", 256 * 2**20, np.int64(2**28), "268435456"])
def test_memory(points, memory):
    sizes = flaunay.triangulate_chunks(points, memory=memory).statistics["chunk_points"]
    assert sizes == flaunay.triangulate_chunks(points, memory="262144K").statistics["chunk_points"]


def test_progress(points):
    calls = []
    flaunay.triangulate_chunks(points, progress=lambda *call: calls.append(call), **SMALL)
    assert {stage for stage, _, _ in calls} == {"sampling", "distributing", "triangulating"}
    shares = [done for _, _, done in calls]
    assert shares == sorted(shares) and shares[-1] == 1
    assert calls[-1][1] >= 1


@pytest.mark.parametrize("at", ["sampling", "distributing", "triangulating"])
def test_an_exception_of_progress_ends_the_call(points, tmp_path, at):
    def stop(stage, round, done):
        if stage == at:
            raise KeyError("enough")

    old = tmp_path / "triangles.npy"
    old.write_bytes(b"old")
    with pytest.raises(KeyError, match="enough"):
        flaunay.triangulate_chunks(points, **paths_in(tmp_path), progress=stop, **SMALL)
    assert os.listdir(tmp_path) == ["triangles.npy"] and old.read_bytes() == b"old"


def test_control_c_ends_the_call(points, tmp_path):
    def interrupt(stage, round, done):
        if stage == "triangulating":
            signal.raise_signal(signal.SIGINT)
            time.sleep(0)  # where Python handles it

    with pytest.raises(KeyboardInterrupt):
        flaunay.triangulate_chunks(points, **paths_in(tmp_path), progress=interrupt, **SMALL)
    assert os.listdir(tmp_path) == []


def test_control_c_without_progress(tmp_path):
    np.save(tmp_path / "points.npy", np.random.default_rng(1).random((400000, 2)))
    program = """
import flaunay, numpy, sys
points = numpy.load("points.npy", mmap_mode="r")
print("begins", flush=True)
try:
    while True:
        flaunay.triangulate_chunks(points, triangles="t.npy", chunk_points=2000, devices="host")
except KeyboardInterrupt:
    print("ended")
"""
    process = subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout.readline() == "begins\n"
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=60)
    finally:
        process.kill()
    assert output == "ended\n" and process.returncode == 0
    assert set(os.listdir(tmp_path)) <= {"points.npy", "t.npy"}


WRONG = flaunay.UsageError


@pytest.mark.parametrize(
    "options, kind, text",
    [
        ({"triangles": "t.bin"}, WRONG, "triangles: 't.bin' must end in .npy"),
        ({"triangles": b"t.npy"}, WRONG, "triangles must be a path, True or None, not bytes"),
        ({"hull": 3}, WRONG, "hull must be a path, True or None, not int"),
        ({"triangles": "t.npy", "hull": "./t.npy"}, WRONG, "hull: './t.npy' is the file of triangles"),
        ({"memory": "much"}, WRONG, "no size such as 4G"),
        ({"memory": "-1G"}, WRONG, "no size such as 4G"),
        ({"memory": "0.25G"}, WRONG, "no size such as 4G"),
        ({"memory": 0}, WRONG, "memory must be from 1"),
        ({"memory": "99999999999T"}, WRONG, "memory must be from 1"),
        ({"memory": 1.5}, WRONG, "memory must be an integer"),
        ({"memory": 1000}, WRONG, "too little for chunks"),
        ({"chunk_points": 0}, WRONG, "chunk_points must be an integer from 1"),
        ({"chunk_points": "9"}, WRONG, "chunk_points must be an integer"),
        ({"index": 16}, WRONG, "index must be 32, 64 or None, not 16"),
        ({"devices": "no such device"}, flaunay.DeviceError, "no such device"),
        ({"devices": 3}, TypeError, ""),
        ({"devices": [3]}, TypeError, "device must be a string"),
        ({"progress": 3}, TypeError, "callable"),
        ({"scratch": "nowhere/at/all"}, flaunay.InputError, "nowhere/at/all"),
        ({"triangles": "nowhere/t.npy"}, flaunay.InputError, "nowhere/t.npy"),
    ],
)
def test_what_cannot_be_used(points, options, kind, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kind) as raised:
        flaunay.triangulate_chunks(points, **options)
    assert text in str(raised.value)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    "given",
    [np.zeros(4), np.zeros((3, 3)), [["a", "b"]], np.ma.masked_all((3, 2)), [[2**60 + 1, 0]]],
)
def test_bad_points(given):
    with pytest.raises(flaunay.UsageError):
        flaunay.triangulate_chunks(given)


def test_a_point_that_is_not_finite(points, tmp_path):
    points[5999, 1] = np.nan
    for given in (points, points.astype(np.float32)):
        with pytest.raises(flaunay.InputError, match="point 5999 is not finite"):
            flaunay.triangulate_chunks(given, **paths_in(tmp_path), **SMALL)
        assert os.listdir(tmp_path) == []


def test_the_points_are_not_overwritten(file, points):
    mapped = np.load(file, mmap_mode="r")
    with pytest.raises(flaunay.UsageError, match="is the file of the points"):
        flaunay.triangulate_chunks(mapped[:100], triangles=file)
    assert np.array_equal(np.load(file), points)


def test_too_many_for_32_bits(tmp_path):
    def of(n):
        return np.broadcast_to(np.zeros(2), (n, 2))

    def stop(stage, round, done):
        raise ZeroDivisionError

    for n, results in ((2**30, {"neighbors": True}), (2**31, {"hull": True})):
        with pytest.raises(flaunay.UsageError, match="too many for index=32"):
            flaunay.triangulate_chunks(of(n), index=32, **results)
    with pytest.raises(ZeroDivisionError):
        flaunay.triangulate_chunks(of(2**30), index=32, hull=tmp_path / "h.npy", progress=stop)


def test_a_pipe_is_no_place_for_results(points, tmp_path):
    os.mkfifo(tmp_path / "t.npy")
    with pytest.raises(flaunay.UsageError, match="no regular file"):
        flaunay.triangulate_chunks(points, triangles=tmp_path / "t.npy")


def test_a_full_disk(tmp_path):
    free = os.statvfs(tmp_path).f_bavail * os.statvfs(tmp_path).f_frsize
    many = np.broadcast_to(np.zeros(2), (free // 24, 2))
    with pytest.raises(flaunay.InputError, match="has room for"):
        flaunay.triangulate_chunks(many, triangles=tmp_path / "t.npy", neighbors=tmp_path / "n.npy")
    assert os.listdir(tmp_path) == []


# ---- Rasters


@pytest.fixture
def scan(random):
    """x, y and z, with places that were measured twice."""
    given = np.round(random.random((6000, 3)) * [40, 30, 100], 1)
    given[100:200, :2] = given[:100, :2]
    return given


def highest_of(scan):
    """The triangles of a scan, and the highest value of each place."""
    tri = flaunay.Delaunay(scan[:, :2])
    highest = np.full(len(scan), -np.inf)
    np.maximum.at(highest, tri.representatives, scan[:, 2])
    return tri, highest


def whole_raster(scan, *shape, **options):
    """Of all triangles at once."""
    tri, highest = highest_of(scan)
    return tri.raster(highest, *shape, **options)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_raster_of_a_file_to_a_file(scan, tmp_path, dtype):
    scan = scan.astype(dtype)
    np.save(tmp_path / "scan.npy", scan)
    mapped = np.load(tmp_path / "scan.npy", mmap_mode="r")
    path = tmp_path / "dem.npy"
    shape, bounds = (60, 80), (-1, 0, 41, 30)
    made = flaunay.rasterize_chunks(
        mapped[:, :2], mapped[:, 2], shape, bounds, out=path, memory="200M", **SMALL
    )
    expected = whole_raster(scan.astype(np.float64), shape, bounds)
    assert isinstance(made, np.memmap) and not made.flags.writeable
    assert np.load(path).tobytes() == made.tobytes() == expected.tobytes()
    assert sorted(os.listdir(tmp_path)) == ["dem.npy", "scan.npy"]


def test_raster_to_memory(scan):
    options = {"max_edge": 1.5, "fill_value": -9}
    expected = whole_raster(scan, (20, 30), **options)
    assert (expected == -9).any() and (expected >= 0).any()
    stages = set()
    made = flaunay.rasterize_chunks(
        *(scan[:, :2], scan[:, 2].tolist(), (20, 30)),
        progress=lambda stage, round, done: stages.add(stage),
        **options,
        **SMALL,
    )
    assert made.tobytes() == expected.tobytes() and "triangulating" in stages
    out = np.zeros((20, 30))
    given = scan[::-1]
    same = flaunay.rasterize_chunks(given[:, :2], given[:, 2], (20, 30), out=out, **options)
    assert same is out and out.tobytes() == expected.tobytes()


@pytest.mark.parametrize("duplicates, expected", [("highest", 9), ("lowest", 1), ("mean", 4)])
def test_raster_of_equal_points(duplicates, expected):
    points, values = [[0, 0], [4, 0], [0, 0], [0, 4], [0, 0]], [9, 5, 1, 5, 2]
    made = flaunay.rasterize_chunks(points, values, (2, 2), (-2, -2, 6, 6), duplicates=duplicates)
    assert made[1, 0] == expected


@pytest.mark.parametrize(
    "changed, message",
    [
        ({"values": [1, 2]}, r"values must have the shape \(3,\)"),
        ({"shape": (0, 4)}, "shape"),
        ({"bounds": (0, 0, 0, 1)}, "bounds"),
        ({"duplicates": "any"}, "duplicates"),
        ({"max_edge": -1}, "max_edge"),
        ({"out": "dem.tif"}, ".npy"),
        ({"out": np.zeros((2, 3))}, "out"),
        ({"memory": "much"}, "memory"),
        ({"chunk_points": 0}, "chunk_points"),
        ({"points": np.empty((0, 2)), "values": []}, "bounds"),
    ],
)
def test_raster_with_wrong_arguments(changed, message):
    given = {"points": [[0, 0], [4, 0], [0, 4]], "values": [0, 1, 2], "shape": (2, 2), **changed}
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.rasterize_chunks(**given)


def test_a_raster_that_fails_leaves_what_was_there(tmp_path):
    path = tmp_path / "dem.npy"
    path.write_bytes(b"old")
    with pytest.raises(flaunay.InputError, match="finite"):
        flaunay.rasterize_chunks([[0, 0], [4, 0], [0, 4]], [0, np.nan, 2], (2, 2), out=path)
    assert os.listdir(tmp_path) == ["dem.npy"] and path.read_bytes() == b"old"


def test_contours(scan):
    tri, highest = highest_of(scan)
    for options in ({}, {"max_edge": 1.5}):
        expected = tri.contours(highest, [60, 20], **options)
        made = flaunay.contour_chunks(scan[:, :2], scan[:, 2], [60, 20], **options, **SMALL)
        assert len(made) > 10 and set(made.heights) == {20, 60}
        for name in ("points", "offsets", "heights"):
            assert getattr(made, name).tobytes() == getattr(expected, name).tobytes()
    with pytest.raises(flaunay.UsageError, match="finite"):
        flaunay.contour_chunks(scan[:, :2], scan[:, 2], np.inf)
    assert len(flaunay.contour_chunks(np.empty((0, 2)), [], 1)) == 0


def places_of_rows(triangles, corner_offsets, neighbors):
    """Each triangle with its offsets, and those beyond its sides."""
    rows = [
        (*corners, *steps)
        for corners, steps in zip(triangles.tolist(), corner_offsets.reshape(-1, 6).tolist())
    ]
    return {
        row: tuple(rows[t] if t >= 0 else None for t in beyond)
        for row, beyond in zip(rows, neighbors.tolist())
    }


@pytest.mark.parametrize("period", [(1, 0.7), (0.5, None)])
@pytest.mark.parametrize("in_files", [False, True])
def test_with_a_period(points, tmp_path, period, in_files):
    names = ("triangles", "neighbors", "representatives", "areas", "corner_offsets")
    results = {name: tmp_path / f"{name}.npy" if in_files else True for name in names}
    mesh = flaunay.triangulate_chunks(points, **results, period=period, **SMALL)
    expected = flaunay.periodic(points, period)
    assert places_of_rows(mesh.triangles, mesh.corner_offsets, mesh.neighbors) == places_of_rows(
        expected.simplices, expected.corner_offsets, expected.neighbors
    )
    assert np.array_equal(mesh.representatives, expected.representatives)
    assert mesh.corner_offsets.shape == (expected.nsimplex, 3, 2)
    assert mesh.corner_offsets.dtype == np.int8
    assert mesh.areas.shape == (expected.nsimplex,)
    assert mesh.period == expected.period
    assert mesh.statistics["hull_vertices"] == 0 and mesh.statistics["images"] > 0
    assert len(mesh.statistics["rounds"]) > 1
    assert np.array_equal(flaunay.to_places(points, period), expected.places)


def test_of_a_margin_that_was_too_small_the_files_end_in_time(random, tmp_path):
    points = random.random((4000, 2)) * [0.3, 1]
    results = {name: tmp_path / f"{name}.npy" for name in ("triangles", "corner_offsets")}
    mesh = flaunay.triangulate_chunks(points, **results, period=(1, None), **SMALL)
    assert mesh.statistics["triangles"] == 7998
    assert os.path.getsize(results["triangles"]) == 128 + 7998 * 12
    assert os.path.getsize(results["corner_offsets"]) == 128 + 7998 * 6


@pytest.mark.parametrize(
    "options, message",
    [
        ({"period": (1, 0)}, "period"),
        ({"period": (1, 2, 3, 4)}, "two lengths"),
        ({"corner_offsets": True}, "no period"),
        ({"hull": "hull.npy", "period": (1, 1)}, "hull"),
    ],
)
def test_wrong_periods(points, options, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.triangulate_chunks(points, **options)
    with pytest.raises(flaunay.UsageError, match="shape"):
        flaunay.to_places([1, 2, 3], (1, 1))
    assert os.listdir(tmp_path) == []
