"""Values beyond the border of interpolators, and where inside there are none."""

import flaunay
import numpy as np
import pytest
from conftest import grid, ring
from flaunay._border import Border

COLUMNS = [
    flaunay.LinearInterpolator,
    flaunay.CloughTocherInterpolator,
    flaunay.NaturalNeighborInterpolator,
]


def tolerance(interpolator, value):
    name = "border_tol" if interpolator is flaunay.CloughTocherInterpolator else "tol"
    return {name: value}


def survey(count=20):
    """A rotated square of points at coordinates as of UTM, and places on its border."""
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    points = grid(count) * 10 @ turn + [500_000.3, 5_000_000.7]
    rim = np.stack([np.linspace(0, 10 * (count - 1), 333), np.zeros(333)], axis=1)
    return points, np.concatenate([rim, rim[:, ::-1]]) @ turn + [500_000.3, 5_000_000.7]


@pytest.mark.parametrize("interpolator", COLUMNS)
def test_the_rim_of_a_rotated_square_has_values(interpolator):
    points, rim = survey()
    values = points @ [0.5, -0.25]
    assert 100 < np.isnan(interpolator(points, values)(rim)).sum()
    near = interpolator(points, values, **tolerance(interpolator, 1e-6))
    # Clough-Tocher's gradients are estimated.
    assert near(rim) == pytest.approx(rim @ [0.5, -0.25], abs=1e-5, rel=0)
    assert np.isnan(near([500_000.3, 4_999_990.0]))


def shapes(rng):
    angles = np.sort(rng.uniform(0, 2 * np.pi, 200))
    yield flaunay.Delaunay(rng.uniform(0, 1, (150, 2)))
    yield flaunay.Delaunay(np.column_stack([np.cos(angles) / 50, np.sin(angles)]))
    yield flaunay.Delaunay(grid(20, 3))
    top = np.column_stack([np.linspace(0, 100, 50), np.ones(50)])
    yield flaunay.Delaunay(np.concatenate([[[0, 0], [100, 0]], top]))
    yield flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])


def nearest_place(begin, end, q):
    """By the definition: over all edges."""
    along = end - begin
    part = (((q - begin) * along).sum(axis=1) / (along**2).sum(axis=1)).clip(0, 1)
    places = begin + part[:, None] * along
    return np.hypot(*(places - q).T).min()


def test_nearest_places_on_a_convex_border_are_those_of_all_edges():
    rng = np.random.default_rng(1)
    for tri in shapes(rng):
        ends = tri.points[tri.convex_hull]
        size = np.ptp(tri.points, axis=0).max()
        for reach in (0.01, 1, 100):
            queries = rng.uniform(tri.min_bound - reach * size, tri.max_bound + reach * size, (200, 2))
            queries = queries[tri.find_simplex(queries) < 0]
            _, _, distances = tri._border.nearest(queries)
            want = [nearest_place(ends[:, 0], ends[:, 1], q) for q in queries]
            assert distances == pytest.approx(want, rel=1e-9, abs=1e-12)
        # Beside a corner, on lines that are perpendicular to its edges, either of them may be the nearest.
        along = ends[:, 1] - ends[:, 0]
        out = np.column_stack([along[:, 1], -along[:, 0]]) * 1e-9
        queries = np.concatenate([ends[:, 0] + out, ends[:, 1] + out])
        queries = queries[tri.find_simplex(queries) < 0]
        want = [nearest_place(ends[:, 0], ends[:, 1], q) for q in queries]
        assert tri._border.nearest(queries)[2] == pytest.approx(want, rel=1e-9, abs=0)


def test_nearest_places_on_any_border_in_parts(monkeypatch):
    rng = np.random.default_rng(2)
    corners = [[0, 0], [9, 0], [9, 9], [0, 9], [3, 3], [6, 3], [6, 6], [3, 6]]
    mesh = flaunay.triangulate(corners, segments=ring(4, 4), outside="holes")
    queries = rng.uniform(-3, 12, (400, 2))
    queries = queries[mesh.find_simplex(queries) < 0]
    border = mesh._border
    ends = mesh.points[np.stack([border.firsts, border.seconds], axis=1)]
    assert len(ends) == 8
    want = [nearest_place(ends[:, 0], ends[:, 1], q) for q in queries]
    assert border.nearest(queries)[2] == pytest.approx(want)
    monkeypatch.setattr(flaunay._border, "_MOST_PAIRS", 20)
    assert border.nearest(queries)[2] == pytest.approx(want)
    # In the hole, the nearest place on its border.
    linear = flaunay.LinearInterpolator(mesh, mesh.points[:, 0], extrapolate="nearest")
    assert linear([[3.25, 4.5], [-2, 5], [12, 12]]).tolist() == [3, 0, 9]


@pytest.mark.parametrize("interpolator", COLUMNS)
def test_planes_go_on_beyond_the_border(interpolator):
    rng = np.random.default_rng(3)
    points, queries = rng.uniform(0, 1, (100, 2)), rng.uniform(-2, 3, (300, 2))
    plane = interpolator(points, points @ [2.0, -3.0], extrapolate="linear")
    assert plane(queries) == pytest.approx(queries @ [2.0, -3.0], abs=2e-4)
    several = interpolator(points, points * [1, 2j], extrapolate="linear")
    assert several(queries) == pytest.approx(queries * [1, 2j], abs=2e-4)


@pytest.mark.parametrize("interpolator", COLUMNS)
def test_values_are_continuous_at_the_border(interpolator):
    rng = np.random.default_rng(4)
    points, values = rng.uniform(0, 1, (60, 2)), rng.uniform(0, 1, 60)
    tri = flaunay.Delaunay(points)
    ends = points[tri.convex_hull]
    part = rng.uniform(0, 1, (len(ends), 1))
    places = ends[:, 0] + part * (ends[:, 1] - ends[:, 0])
    along = ends[:, 1] - ends[:, 0]
    out = np.column_stack([along[:, 1], -along[:, 0]]) * 1e-7
    for extrapolate in ("nearest", "linear"):
        found = interpolator(tri, values, extrapolate=extrapolate)
        # Nearly as large as the steps: natural neighbours are steep near the border.
        assert found(places + out) == pytest.approx(found(places - out), abs=1e-2)
    far = interpolator(tri, values, extrapolate="nearest")(rng.uniform(-50, 50, (100, 2)))
    assert np.isfinite(far).all()


def test_long_edges_and_distances_leave_voids():
    left = grid(4)
    points = np.concatenate([left, left + [10, 0]])
    queries = [[1.5, 1.5], [6, 1.5], [11.5, 1.5], [3.5, 1], [-0.5, 1]]
    for interpolator in COLUMNS:
        found = interpolator(points, points[:, 1], max_edge=2)(queries)
        assert np.isnan(found).tolist() == [False, True, False, True, True]
        found = interpolator(points, points[:, 1], max_distance=1, extrapolate="nearest")(queries)
        assert np.isnan(found).tolist() == [False, True, False, False, False]
        # What is beyond the void's border is void, too.
        found = interpolator(points, points[:, 1], max_edge=2, extrapolate="nearest", fill_value=-9)
        assert found([[6, -1], [1, -1]]).tolist() == [-9, 0]


def test_nearest_values_end_at_a_distance():
    points, values = [[0, 0], [4, 0], [0, 4]], [1, 2, 3]
    found = flaunay.NearestInterpolator(points, values, max_distance=2)([[0, 2], [0, -2.5], [5, 0]])
    assert found[[0, 2]].tolist() == [1, 2] and np.isnan(found[1])
    usual = flaunay.NearestInterpolator(points, values)
    assert usual([[0, -2.5]]).tolist() == [1]
    assert np.isnan(usual([[0, -2.5]], distance_upper_bound=2)).all()
    names = flaunay.NearestInterpolator(points, ["a", "b", "c"])
    with pytest.raises(flaunay.UsageError, match="too far away"):
        names([[99, 99]], distance_upper_bound=1)


def test_griddata_takes_them():
    points, rim = survey(6)
    values = points[:, 0]
    for method in ("linear", "cubic", "natural"):
        assert np.isfinite(flaunay.griddata(points, values, rim, method=method, tol=1e-6)).all()
        near = flaunay.griddata(points, values, rim - 1000, method=method, extrapolate="nearest")
        assert np.isfinite(near).all()
        assert np.isnan(flaunay.griddata(points, values, rim, method=method, max_edge=1)).all()
    assert np.isnan(
        flaunay.griddata(points, values, rim - 1000, method="nearest", max_distance=5)
    ).all()


ON_A_LINE = [
    lambda *given, **beyond: flaunay.LinearInterpolator(*given, **beyond),
    lambda *given, **beyond: flaunay.NaturalNeighborInterpolator(*given, **beyond),
    lambda points, values, tol=None, **beyond: flaunay.CloughTocherInterpolator(
        points, values, border_tol=tol, **beyond
    ),
    lambda points, *given, **beyond: flaunay.LinearInterpolator(
        flaunay.triangulate(points, segments=[[0, 1]]), *given, **beyond
    ),
]


@pytest.mark.parametrize("interpolator", ON_A_LINE)
def test_values_on_one_line(interpolator):
    # Not in their order, with a duplicate, and not on a line of rounded directions alone.
    points = np.array([[3, 1], [0, 0], [9, 3], [3, 1], [6, 2.0]])
    values = np.array([[1, 5], [4, 7], [2, 2], [99, 99], [0, 3.0]])
    across = np.array([-1, 3]) / 10
    assert np.isnan(interpolator(points, values)(points)).all()
    for beyond in {"tol": 0}, {"extrapolate": "nearest"}, {"extrapolate": "linear"}:
        found = interpolator(points, values, **beyond)(points)
        assert np.array_equal(found, values[[0, 1, 2, 0, 4]])
    queries = np.array([[1.5, 0.5], [7.5, 2.5], [12, 4], [-3, -1]])
    want = [[2.5, 6], [1, 2.5], [2, 2], [4, 7]]
    nearest = interpolator(points, values, extrapolate="nearest")
    assert nearest([*queries, *(queries + across)]) == pytest.approx(np.concatenate([want, want]))
    linear = interpolator(points, values, extrapolate="linear")
    assert linear(queries + across) == pytest.approx(np.array([*want[:2], [4, 1], [7, 9]]))
    near = interpolator(points, values, tol=0.4, max_edge=4)
    assert near(queries[:2] + across) == pytest.approx(np.array(want[:2]))
    assert np.isnan(near(queries + 2 * across)).all() and np.isnan(near([[np.nan, 0]])).all()
    short = interpolator(points, values, extrapolate="nearest", max_edge=3)
    assert np.isnan(short(queries)).all()


@pytest.mark.parametrize("interpolator", ON_A_LINE[:3])
def test_values_at_one_place(interpolator):
    for extrapolate in "nearest", "linear":
        found = interpolator([[2, 3], [2, 3]], [5, 6], extrapolate=extrapolate)([[2, 3], [7, 8]])
        assert found.tolist() == [5, 5]
    assert np.isnan(interpolator(np.empty((0, 2)), [], extrapolate="linear")([[1, 2]])).all()


def test_gradients_that_are_given_count_on_a_line_too():
    points, values, gradients = [[0, 0], [2, 0]], [0, 8], [[0, 1], [12, 2]]
    cubic = flaunay.CloughTocherInterpolator(points, values, gradients=gradients, extrapolate="linear")
    assert cubic([[1, 0], [3, 0], [1, 1], [2, 1]]) == pytest.approx([1, 20, 2.5, 10])
    mesh = flaunay.triangulate([[0, 0], [4, 0], [0, 4]], [[0, 1], [1, 2], [2, 0]], [[1, 1]], outside="holes")
    assert mesh.nsimplex == 0
    assert np.isnan(flaunay.LinearInterpolator(mesh, [1, 2, 3], extrapolate="nearest")([[1, 1]])).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"tol": -1}, "tol"),
        ({"max_edge": np.nan}, "max_edge"),
        ({"max_distance": "far"}, "max_distance"),
        ({"extrapolate": "cubic"}, "extrapolate"),
    ],
)
def test_options_that_are_none(options, message):
    with pytest.raises(flaunay.UsageError, match=message):
        flaunay.LinearInterpolator([[0, 0], [1, 0], [0, 1]], [1, 2, 3], **options)


def test_queries_that_are_not_finite_stay_without_value():
    found = flaunay.LinearInterpolator([[0, 0], [1, 0], [0, 1]], [1, 2, 3], extrapolate="linear")
    assert np.isnan(found([[np.nan, 0], [np.inf, 1]])).all()


def test_borders_are_directed():
    square = flaunay.Delaunay([[0, 0], [1, 0], [1, 1], [0, 1]])
    border = Border(square.points, square.simplices, square.neighbors)
    assert sorted(zip(border.firsts.tolist(), border.seconds.tolist())) == [(0, 1), (1, 2), (2, 3), (3, 0)]
