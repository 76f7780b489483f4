"""Run by scripts/wheel-test.sh where nothing but the wheel is installed: everything works at once.

With an argument, a device of that name triangulates, too.
"""

import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile

import numpy as np

import flaunay


def triangles_of(points):
    return flaunay.triangulate(points).triangles


def ended(command, *arguments, given=b""):
    """The exit code of a command, and what it wrote."""
    done = subprocess.run([*command, *arguments], input=given, capture_output=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def ended_by(command, number):
    """The exit code of a command that waits for its input when it gets a signal, or whose reader ends."""
    if number == signal.SIGPIPE:
        arguments = ["generate", "uniform", "100000", "-o", "-"]
    else:
        arguments = ["triangulate", "-", "-o", "-"]
    process = subprocess.Popen([*command, *arguments], stdin=-1, stdout=-1, stderr=-1)
    if number == signal.SIGPIPE:
        process.stdout.readline()
        process.stdout.close()
    else:
        # It reads, in the place of Python.
        process.stdin.write(b"0 0\n" * 100000)
        process.stdin.flush()
        process.send_signal(number)
    try:
        code = process.wait(300)
    finally:
        process.kill()
    for stream in process.stdin, process.stdout, process.stderr:
        stream.close()
    return code


def check_command(folder):
    """pip has installed the command, and ``python -m flaunay`` is the same one."""
    beside = os.path.join(os.path.dirname(os.path.dirname(flaunay.__file__)), "bin")
    path = shutil.which("flaunay", path=os.pathsep.join([sysconfig.get_path("scripts"), beside]))
    assert path, "the wheel has no command"
    direct, module = [path], [sys.executable, "-m", "flaunay"]
    code, version, _ = ended(direct, "--version")
    assert code == 0 and version.split() == [b"flaunay", flaunay.__version__.encode()], version
    corners = b"0 0 1\n4 0 2\n0 4 3\n"
    given = os.path.join(folder, "h \u25b3.xyz")
    with open(given, "wb") as file:
        file.write(corners)
    for expected, *arguments in [
        (0, "--version"),
        (0, "--help"),
        (0, "generate", "uniform", "20", "-o", "-"),
        (2, "generate", "uniform"),
        (3, "triangulate", os.path.join(folder, "missing \u25b3.txt")),
    ]:
        result = ended(direct, *arguments)
        assert result[0] == expected, result
        assert ended(module, *arguments) == result
    # The standard input, too.
    for command in direct, module:
        code, report, _ = ended(command, "triangulate", "-", given=b"0 0\n4 0\n0 4\n")
        assert code == 0 and b"1 triangle" in report, report
        # What needs GDAL works, or says how Python does it.
        code, _, message = ended(
            command, "terrain", given, "--resolution", "1", "-o", os.path.join(folder, "h.tif")
        )
        assert code == 0 or code == 2 and b"flaunay.terrain in Python" in message, message
    if os.name == "posix":
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGPIPE:
            assert ended_by(module, number) == ended_by(direct, number) == -number, number


def main():
    # If a shell starts this in the background, it ignores Ctrl-C, and so does all that it starts.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    points = np.random.default_rng(1).random((20000, 2))
    tri = flaunay.Delaunay(points)
    assert len(tri.simplices) == 2 * len(points) - 2 - len(tri.hull)
    assert (tri.find_simplex(points) >= 0).all()
    assert np.array_equal(tri.nearest(points), np.arange(len(points)))
    assert np.array_equal(tri.interpolate(points[:, 0], points), points[:, 0])
    assert len(flaunay.Voronoi(points).vertices) == len(tri.simplices)
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "Dreiecke \u25b3 \u4e09\u89d2\u5f62.npy")
        mesh = flaunay.triangulate_chunks(points, triangles=name, chunk_points=5000)
        assert len(mesh.triangles) == len(tri.simplices)
        assert np.load(name).shape == tri.simplices.shape
        # On Windows, files that are mapped cannot be removed.
        del mesh
        check_command(folder)
    for method in multiprocessing.get_all_start_methods():
        with multiprocessing.get_context(method).Pool(1) as pool:
            assert np.array_equal(pool.apply_async(triangles_of, (points,)).get(300), tri.simplices)
    try:
        devices = [device["name"] for device in flaunay.devices()]
    except flaunay.DeviceError as error:
        assert "no OpenCL platform" in str(error), error
        devices = []
    for name in sys.argv[1:]:
        assert devices
        try:
            result = flaunay.triangulate(points, device=name)
        except flaunay.DeviceError as error:
            # PoCL 3.0, the last on PyPI, cannot compile for processors that are newer than itself.
            assert "unknown target CPU" in str(error), error
            print(f"{name}: it does not know this processor")
            continue
        assert np.array_equal(result.triangles, tri.simplices)
        assert result.statistics["device"] != "host", result.statistics
    print(f"Python {sys.version.split()[0]}, NumPy {np.__version__}, devices: {devices or 'none'}")


if __name__ == "__main__":
    main()
