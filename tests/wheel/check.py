"""Run by scripts/wheel-test.sh where nothing but the wheel is installed: everything works at once.

With an argument, a device of that name triangulates, too.
"""

import multiprocessing
import os
import sys
import tempfile

import numpy as np

import flaunay


def triangles_of(points):
    return flaunay.triangulate(points).triangles


def main():
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
    for method in multiprocessing.get_all_start_methods():
        with multiprocessing.get_context(method).Pool(1) as pool:
            assert np.array_equal(pool.apply(triangles_of, (points,)), tri.simplices)
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
