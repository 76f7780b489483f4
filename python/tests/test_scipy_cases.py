"""SciPy's own tests of its Delaunay and Voronoi, run with flaunay's in their place.

They are read from the SciPy that is installed. NOT_APPLICABLE lists those that ask for what flaunay does
not have, DIFFERENT those where it answers otherwise; docs/python.md says both. The latter must fail, so that
neither list can grow old.
"""

from __future__ import annotations

import fnmatch
import importlib.util
import os
import sys
import types
import warnings

import numpy as np
import pytest
import scipy.interpolate
import scipy.spatial
from scipy.spatial import _qhull

import flaunay

IN_SPACE = "more than two dimensions"
OF_QHULL = "tests Qhull itself, convex hulls or halfspaces, which flaunay does not have"

# Patterns of the names of tests, and why they do not apply.
NOT_APPLICABLE = {
    "*-[3-8]d*": IN_SPACE,
    "*test_point_region_structure[[]3-*": IN_SPACE,
    "*test_nd_simplex": f"{IN_SPACE}; its case in the plane is below",
    "*test_more_barycentric_transforms": f"{IN_SPACE}; its case in the plane is below",
    "*test_furthest_site*": "furthest_site=True",
    "*test_joggle": "Qhull's option QJ, which makes vertices of duplicates",
    "Test_Qhull::test_swapping": OF_QHULL,
    "TestUtilities::test_*volume_area*": OF_QHULL,
    "TestConvexHull::test_[!h]*": OF_QHULL,
    "*test_vertices_deprecation": "an attribute that SciPy has removed since",
    "*NDInterpolation::test_threading": "slow, and hands over points",
    "Test_HalfspaceIntersection::*": OF_QHULL,
}

# Those where flaunay answers otherwise.
DIFFERENT = {
    "TestUtilities::test_find_simplex": "the order of the simplices",
    "TestUtilities::test_convex_hull": "the order of the edges, which here is counter-clockwise",
    "TestUtilities::test_degenerate_barycentric_transforms": "there are more thin triangles, as Qhull has lost some",
    "TestDelaunay::test_2d_square": "the other diagonal of the square",
    "TestVoronoi::test_point_region_structure[[]2-*-Qbb Qc Qz-1]": "no empty region of a point at infinity",
    "TestVoronoi::test_simple": "no empty region of a point at infinity; the order of vertices",
    "TestVoronoi::test_ridges[[]pathological-2]": "exact: has ridges as short as 1e-16, which Qhull merges",
    "TestVoronoi::test_incremental[[]pathological-2-*": "exact: the same, which the test takes for spurious",
    "test_gh_21286": "a wrong shape is a UsageError, not an IndexError",
}


def merged(*args, **keywords):
    """As SciPy has them: one vertex of points on one circle."""
    return flaunay.Voronoi(*args, merge=True, **keywords)


def in_scipys_form(*args, **keywords):
    return flaunay.Delaunay(*args, **keywords).to_scipy()


def qhull_with(**replaced):
    return types.SimpleNamespace(**{**vars(_qhull), **replaced})


def cases_of(package, name, qhull):
    """A module of SciPy's tests, with other classes than SciPy's own."""
    path = os.path.join(os.path.dirname(package.__file__), "tests", f"{name}.py")
    if not os.path.exists(path):
        pytest.skip("the installed SciPy has no tests", allow_module_level=True)
    spec = importlib.util.spec_from_file_location(f"scipys_{name}", path)
    module = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        # SciPy has marks of its own.
        warnings.simplefilter("ignore", pytest.PytestUnknownMarkWarning)
        patch.setattr(scipy.spatial, "_qhull", qhull)
        patch.setitem(sys.modules, "scipy.spatial._qhull", qhull)
        patch.setattr(scipy.spatial, "Delaunay", qhull.Delaunay)
        patch.setattr(scipy.spatial, "Voronoi", qhull.Voronoi)
        spec.loader.exec_module(module)
    return module


QHULL = cases_of(scipy.spatial, "test_qhull", qhull_with(Delaunay=flaunay.Delaunay, Voronoi=merged))
INTERPOLATION = cases_of(scipy.interpolate, "test_interpnd", qhull_with(Delaunay=in_scipys_form))

for module in QHULL, INTERPOLATION:
    for name, value in vars(module).items():
        if name.startswith(("Test", "test_")):
            globals()[name] = value


def reason_in(table, name):
    return next(
        (reason for pattern, reason in table.items() if fnmatch.fnmatch(name, pattern)), None
    )


@pytest.fixture(autouse=True)
def as_listed(request):
    name = request.node.nodeid.partition("::")[2]
    if reason := reason_in(NOT_APPLICABLE, name):
        pytest.skip(reason)
    if reason := reason_in(DIFFERENT, name):
        request.applymarker(pytest.mark.xfail(reason=reason, strict=True))


def test_in_the_plane_scipys_case_of_a_simplex():
    tri = flaunay.Delaunay([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    assert sorted(tri.simplices[0]) == [0, 1, 2] and tri.neighbors.tolist() == [[-1, -1, -1]]


def check_transforms(points, **options):
    QHULL.TestUtilities()._check_barycentric_transforms(flaunay.Delaunay(points), **options)


def test_in_the_plane_scipys_cases_of_barycentric_transforms(random):
    eps = np.finfo(float).eps
    side = np.linspace(0, 1, 70)
    grid = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    check_transforms(grid, unit_cube=True)
    moved = random.random(len(grid)) < 0.2
    grid[moved] += 2 * eps * (random.random((moved.sum(), 2)) - 0.5)
    check_transforms(grid, unit_cube=True, unit_cube_tol=2 * eps)
    check_transforms(np.concatenate([grid, grid]), unit_cube=True, unit_cube_tol=2 * eps)


def test_scipys_degenerate_points():
    path = os.path.join(os.path.dirname(QHULL.__file__), "data", "degenerate_pointset.npz")
    with np.load(path) as data:
        tri = flaunay.Delaunay(data["c"])
    check_transforms(tri.points)
    thin = np.isnan(tri.transform[:, 0, 0])
    assert 0 < thin.sum() < 40
    # SciPy's own, of those and of as many others.
    some = np.concatenate([np.flatnonzero(thin), np.flatnonzero(~thin)[:300]])
    simplices = np.array(tri.simplices[some])
    theirs = _qhull._get_barycentric_transforms(
        np.array(tri.points), simplices, np.finfo(float).eps
    )
    np.testing.assert_allclose(tri.transform[some], theirs, rtol=1e-12, atol=1e-9)


def test_the_simple_diagram_of_scipy_but_for_order():
    points = np.array([(x, y) for x in range(3) for y in range(3)], float)
    mine, theirs = merged(points), scipy.spatial.Voronoi(points)
    assert sorted(mine.vertices.tolist()) == sorted(theirs.vertices.tolist())

    def ridges(voronoi):
        return {
            tuple(sorted(pair)): sorted(
                voronoi.vertices[v].tolist() if v >= 0 else [] for v in ends
            )
            for pair, ends in voronoi.ridge_dict.items()
        }

    def regions(voronoi):
        return [
            sorted(voronoi.vertices[v].tolist() if v >= 0 else [] for v in voronoi.regions[k])
            for k in voronoi.point_region
        ]

    assert ridges(mine) == ridges(theirs)
    assert regions(mine) == regions(theirs)
