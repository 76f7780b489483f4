"""Interpolation beside SciPy's, on the same triangulations."""

import pickle

import numpy as np
import pytest
from scipy import interpolate as scipy_interpolate
from scipy.spatial import Delaunay as ScipyDelaunay

import flaunay

CLASSES = {
    "linear": (flaunay.LinearInterpolator, scipy_interpolate.LinearNDInterpolator),
    "cubic": (flaunay.CloughTocherInterpolator, scipy_interpolate.CloughTocher2DInterpolator),
    "nearest": (flaunay.NearestInterpolator, scipy_interpolate.NearestNDInterpolator),
}


@pytest.fixture
def scattered():
    rng = np.random.default_rng(3)
    points = rng.random((2000, 2))
    values = np.sin(7 * points[:, 0]) * np.cos(5 * points[:, 1])
    return points, values, rng.random((3000, 2)) * 1.2 - 0.1


@pytest.mark.parametrize("method", CLASSES)
@pytest.mark.parametrize("shape", [(), (3,), (2, 2)])
@pytest.mark.parametrize("is_complex", [False, True])
def test_as_scipy(scattered, method, shape, is_complex):
    points, values, queries = scattered
    factors = np.arange(1.0, 1 + np.prod(shape, dtype=int)).reshape(shape)
    values = np.multiply.outer(values, factors)
    if is_complex:
        values = values * (2 - 1j) + 3j
    ours, scipys = CLASSES[method]
    expected = scipys(points, values)(queries)
    result = ours(points, values)(queries)
    assert result.shape == expected.shape
    assert result.dtype == expected.dtype
    np.testing.assert_allclose(result, expected, rtol=0, atol=2e-6 if method == "cubic" else 1e-11)
    assert 0 < np.isnan(result).sum() < result.size or method == "nearest"


def test_the_same_element_with_the_same_gradients(scattered):
    points, values, queries = scattered
    scipys = scipy_interpolate.CloughTocher2DInterpolator(points, values)
    ours = flaunay.CloughTocherInterpolator(points, values, gradients=scipys.grad.reshape(-1, 2))
    np.testing.assert_allclose(ours(queries), scipys(queries), rtol=0, atol=1e-10)
    np.testing.assert_array_equal(ours.grad, scipys.grad.reshape(-1, 2))
    exact = scipy_interpolate.CloughTocher2DInterpolator(points, values, tol=1e-13)
    estimated = flaunay.CloughTocherInterpolator(points, values)
    np.testing.assert_allclose(estimated.grad, exact.grad.reshape(-1, 2), rtol=0, atol=1e-6 * 20)


@pytest.mark.parametrize("method", CLASSES)
def test_forms_of_queries(scattered, method):
    points, values, _ = scattered
    ours, scipys = CLASSES[method]
    mine, theirs = ours(points, values), scipys(points, values)
    x, y = np.linspace(0.2, 0.8, 5), np.linspace(0.3, 0.7, 4)
    forms = [
        (x[:, None], y),
        ((x[:, None], y),),
        (0.25, 0.5),
        ([0.25, 0.5],),
        (np.stack(np.meshgrid(x, y), -1),),
        (np.empty((0, 2)),),
    ]
    for form in forms:
        result, expected = mine(*form), theirs(*form)
        assert result.shape == expected.shape
        np.testing.assert_allclose(result, expected, rtol=0, atol=1e-5)
    # SciPy refuses these where the nearest point is wanted.
    queries = [[0.2, 0.3], [0.1, np.inf], [np.nan, 0.5]]
    np.testing.assert_array_equal(np.isnan(mine(queries)), [False, True, True])
    if method != "nearest":
        np.testing.assert_array_equal(np.isnan(theirs(queries)), [False, True, True])


@pytest.mark.parametrize("method", CLASSES)
def test_rescaled(scattered, method):
    points, values, queries = scattered
    ours, scipys = CLASSES[method]
    wide = np.array([1.0, 1e6])
    result = ours(points * wide, values, rescale=True)(queries * wide)
    expected = scipys(points * wide, values, rescale=True)(queries * wide)
    np.testing.assert_allclose(result, expected, rtol=0, atol=1e-5)


@pytest.mark.parametrize("method", CLASSES)
def test_griddata(scattered, method):
    points, values, queries = scattered
    result = flaunay.griddata(points, values, tuple(queries.T), method=method, fill_value=-3)
    expected = scipy_interpolate.griddata(points, values, tuple(queries.T), method, fill_value=-3)
    np.testing.assert_allclose(result, expected, rtol=0, atol=1e-5)
    by_coordinates = flaunay.griddata(tuple(points.T), values, queries, method, fill_value=-3)
    np.testing.assert_array_equal(by_coordinates, result)


@pytest.mark.parametrize("method", ["linear", "cubic"])
def test_of_a_triangulation(scattered, method):
    points, values, queries = scattered
    tri = flaunay.Delaunay(points)
    ours, _ = CLASSES[method]
    interpolator = ours(tri, values)
    assert interpolator.tri is tri
    np.testing.assert_array_equal(interpolator(queries), ours(points, values)(queries))
    again = pickle.loads(pickle.dumps(interpolator))
    np.testing.assert_array_equal(again(queries), interpolator(queries))
    with pytest.raises(flaunay.UsageError, match="rescale"):
        ours(tri, values, rescale=True)
    with pytest.raises(flaunay.UsageError, match="another triangulation"):
        ours(ScipyDelaunay(points), values)


@pytest.mark.parametrize("points", [[], [[1, 2]], [[0, 0], [1, 1]], [[0, 0], [1, 1], [3, 3]]])
def test_without_triangles(points):
    points = np.asarray(points, float).reshape(-1, 2)
    values = np.arange(1.0, 1 + len(points))
    for method in ["linear", "cubic"]:
        result = flaunay.griddata(points, values, [[0, 0], [9, 9]], method, fill_value=-1)
        np.testing.assert_array_equal(result, [-1, -1])
    if len(points) == 0:
        with pytest.raises(flaunay.UsageError, match="no points"):
            flaunay.NearestInterpolator(points, values)
    else:
        nearest = flaunay.NearestInterpolator(points, values)
        np.testing.assert_array_equal(nearest([[0, 0], [9, 9]]), [1, len(points)])


def test_complex_fill():
    points = [[0, 0], [4, 0], [0, 4]]
    values = [1j, complex(np.nan, 1), 2]
    interpolator = flaunay.LinearInterpolator(points, values, fill_value=3 + 4j)
    result = interpolator([[0, 0], [9, 9], [1, 1], [np.inf, 0]])
    np.testing.assert_array_equal(result[[0, 1, 3]], [1j, 3 + 4j, 3 + 4j])
    assert np.isnan(result[2])


def test_no_values_per_point():
    for method in ["linear", "cubic"]:
        result = flaunay.griddata([[0, 0], [4, 0], [0, 4]], np.empty((3, 0)), [[1, 1]], method)
        assert result.shape == (1, 0)


def test_values_of_any_type_are_nearest():
    names = flaunay.NearestInterpolator([[0, 0], [4, 0]], ["a", "b"])
    np.testing.assert_array_equal(names([[1, 0], [3, 5]]), ["a", "b"])
    with pytest.raises(flaunay.UsageError, match="not finite"):
        names([[np.nan, 0]])


def test_errors():
    points = [[0, 0], [4, 0], [0, 4]]
    for wrong, words in [
        (dict(values=[1, 2]), r"\(3, \.\.\.\)"),
        (dict(values=[1, 2, 3], fill_value=2j), "complex"),
        (dict(values=[1, 2, 3], tol=0), "tol"),
        (dict(values=[1, 2, 3], maxiter=0), "maxiter"),
        (dict(values=[1, 2, 3], gradients=[1, 2, 3]), r"\(3, 2\)"),
        (dict(values=[1, 2, 3], gradients=np.ones((3, 2)) * 1j), "complex"),
    ]:
        with pytest.raises(flaunay.UsageError, match=words):
            flaunay.CloughTocherInterpolator(points, **wrong)
    with pytest.raises(flaunay.UsageError, match="method"):
        flaunay.griddata(points, [1, 2, 3], [[1, 1]], "quadratic")
    interpolate = flaunay.LinearInterpolator(points, [1, 2, 3])
    for queries in [(), ([1, 2, 3],), (1, 2, 3), ([[1, 2, 3]],), ([1, 2], [1, 2, 3])]:
        with pytest.raises(flaunay.UsageError):
            interpolate(*queries)
    with pytest.warns(UserWarning, match="3 iterations"):
        flaunay.CloughTocherInterpolator(points, [1, 2, 3], maxiter=3)


INTERPOLATORS = [
    flaunay.LinearInterpolator,
    flaunay.CloughTocherInterpolator,
    flaunay.NaturalNeighborInterpolator,
    flaunay.NearestInterpolator,
]
CORNERS = [[0, 0], [4, 0], [0, 4]]


@pytest.mark.parametrize("kind", INTERPOLATORS)
@pytest.mark.parametrize("dtype", [float, complex])
def test_masked_values_are_refused(kind, dtype):
    values = np.ma.masked_array([1, 2, 3], mask=[False, True, False], dtype=dtype)
    with pytest.raises(flaunay.UsageError, match=r"values\[1\] is masked"):
        kind(CORNERS, values)
    values.mask = False
    assert kind(CORNERS, values)([[4, 0]]) == [2]


@pytest.mark.parametrize("kind", INTERPOLATORS)
def test_points_of_one_dimension_are_refused(kind):
    with pytest.raises(flaunay.UsageError, match=r"points must have the shape .*, not \(6,\)"):
        kind([0, 0, 4, 0, 0, 4], [1, 2, 3])


@pytest.mark.parametrize("kind", INTERPOLATORS[:3])
@pytest.mark.parametrize("fill", [None, "none", [1, 2], np.ma.masked])
def test_what_fills_is_a_number(kind, fill):
    for values in ([1, 2, 3], [1j, 2, 3]):
        with pytest.raises(flaunay.UsageError, match="fill_value must be a number"):
            kind(CORNERS, values, fill_value=fill)
    with pytest.raises(flaunay.UsageError, match="fill_value is complex"):
        kind(CORNERS, [1, 2, 3], fill_value=np.complex64(1j))
    assert kind(CORNERS, [1, 2, 3], fill_value=np.float32(2))([[9, 9]]) == [2]


@pytest.mark.parametrize("kind", INTERPOLATORS)
def test_points_that_cannot_be_rescaled_are_refused(kind):
    with pytest.raises(flaunay.InputError, match="point 2 is not finite"):
        kind([[0, 0], [4, 0], [0, np.nan]], [1, 2, 3], rescale=True)
    # Their extent overflows, and all would get the same x.
    with pytest.raises(flaunay.InputError, match="too large to be rescaled"):
        kind([[-1e308, 0], [1e308, 0], [0, 1]], [1, 2, 3], rescale=True)


@pytest.mark.parametrize("kind", INTERPOLATORS)
@pytest.mark.parametrize("first, second", [((), (2,)), ((2,), ())])
def test_values_can_be_assigned(scattered, kind, first, second):
    points, values, queries = scattered
    before = np.multiply.outer(values, np.ones(first))
    for factor in [3.0, 2 - 1j, 1.0]:
        after = np.multiply.outer(values**2, np.full(second, factor))
        interpolator = kind(points, before)
        interpolator(queries)
        interpolator.values = after
        expected = kind(points, after)
        for changed in interpolator, pickle.loads(pickle.dumps(interpolator)):
            assert changed(queries).tobytes() == expected(queries).tobytes()
            np.testing.assert_array_equal(changed.values, after)
            with pytest.raises(ValueError, match="read-only"):
                changed.values[0] = 1
        if kind is flaunay.CloughTocherInterpolator:
            assert interpolator.grad.tobytes() == expected.grad.tobytes()
        before = after
        first, second = second, first


@pytest.mark.parametrize("kind", INTERPOLATORS)
def test_arrays_may_change_after_they_were_given(scattered, kind):
    points, values, queries = (array.copy() for array in scattered)
    gradients = np.ones((len(points), 2))
    given = [{}, {"gradients": gradients}] if kind is flaunay.CloughTocherInterpolator else [{}]
    interpolators = [kind(points, values, **options) for options in given]
    before = [interpolator(queries).tobytes() for interpolator in interpolators]
    for array in points, values, gradients:
        array[:] = 1e300
    assert [interpolator(queries).tobytes() for interpolator in interpolators] == before


@pytest.mark.parametrize("kind", INTERPOLATORS)
def test_what_cannot_be_assigned_is_refused(kind):
    interpolator = kind(CORNERS, [1, 2, 3])
    for wrong in [1, 2], 1, np.ma.masked_array([1, 2, 3], mask=[0, 1, 0]):
        with pytest.raises(flaunay.UsageError, match="values"):
            interpolator.values = wrong
    for name in "points", "tri":
        with pytest.raises(AttributeError, match=f"{name} cannot be replaced"):
            setattr(interpolator, name, getattr(interpolator, name))
    assert interpolator([[4, 0]]) == [2]


@pytest.mark.parametrize("kind", INTERPOLATORS[:3])
def test_what_fills_can_be_assigned(kind):
    interpolator = kind(CORNERS, [1, 2, 3])
    interpolator.fill_value = 7
    assert interpolator([[9, 9]]) == [7]
    with pytest.raises(flaunay.UsageError, match="fill_value is complex"):
        interpolator.fill_value = 2j
    interpolator.values = [1j, 2, 3]
    interpolator.fill_value = 2j
    assert interpolator([[9, 9]]) == [2j]
    with pytest.raises(flaunay.UsageError, match="fill_value is complex"):
        interpolator.values = [1, 2, 3]
    assert interpolator([[0, 0]]) == [1j] and interpolator([[np.inf, 0]]) == [2j]


def test_given_gradients_are_for_the_values_they_came_with():
    interpolator = flaunay.CloughTocherInterpolator(CORNERS, [1, 2, 3], gradients=np.ones((3, 2)))
    with pytest.raises(flaunay.UsageError, match="gradients were given for other values"):
        interpolator.values = [1, 2, 4]
    assert interpolator([[0, 4]]) == [3] and (interpolator.grad == 1).all()
