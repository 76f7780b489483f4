"""Natural-neighbour interpolation."""

from __future__ import annotations

import numpy as np
import pytest

import flaunay

METHODS = ("sibson", "laplace")
ERROR = 2.0**-36


def weight_by_area(points: np.ndarray, query: np.ndarray, i: int) -> float:
    """What share of the query's Voronoi cell is nearest to point i, by counting."""
    grid = np.stack(np.meshgrid(*2 * [np.linspace(-1, 2, 601)]), axis=-1).reshape(-1, 2)
    distances = ((grid[:, None] - points) ** 2).sum(axis=2)
    taken = ((grid - query) ** 2).sum(axis=1) < distances.min(axis=1)
    return float((distances[taken].argmin(axis=1) == i).mean())


@pytest.mark.parametrize("method", METHODS)
def test_linear_functions_are_exact(method: str) -> None:
    random = np.random.default_rng(1)
    points, queries = random.random((500, 2)), random.random((2000, 2))
    values = np.stack([points @ [3, -2] + 1, points[:, 0]], axis=1)
    result = flaunay.NaturalNeighborInterpolator(points, values, method)(queries)
    is_inside = flaunay.Delaunay(points).find_simplex(queries) >= 0
    assert (np.isnan(result).any(axis=1) == ~is_inside).all()
    expected = np.stack([queries @ [3, -2] + 1, queries[:, 0]], axis=1)
    assert np.abs(result - expected)[is_inside].max() < 5 * ERROR


def test_weights_of_sibson_are_areas() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.1], [0.1, 1.0], [1.0, 1.1], [0.6, 0.4]])
    query = np.array([0.5, 0.55])
    weights = flaunay.NaturalNeighborInterpolator(points, np.eye(5))(query)[0]
    assert abs(weights.sum() - 1) < 1e-12
    for i in range(5):
        assert abs(weights[i] - weight_by_area(points, query, i)) < 0.01


@pytest.mark.parametrize("method", METHODS)
def test_points_and_hull(method: str) -> None:
    points = np.array([[0, 0], [4, 0], [0, 4], [4, 4], [1, 2]])
    values = np.array([1.0, 7.0, -3.0, 0.1, 5.3])
    interpolate = flaunay.NaturalNeighborInterpolator(points, values, method, fill_value=-1)
    assert (interpolate(points) == values).all()
    assert interpolate(1, 0) == 2.5
    assert interpolate([[5, 5], [np.nan, 0]]).tolist() == [-1, -1]


@pytest.mark.parametrize("method", METHODS)
def test_complex_values(method: str) -> None:
    random = np.random.default_rng(2)
    points, queries = random.random((50, 2)), random.random((100, 2))
    values = random.random(50) + 1j * random.random(50)
    result = flaunay.NaturalNeighborInterpolator(points, values, method)(queries)
    real = flaunay.NaturalNeighborInterpolator(points, values.real, method)(queries)
    assert np.array_equal(result.real, real, equal_nan=True)


def test_rescaling_is_to_the_unit_square() -> None:
    random = np.random.default_rng(3)
    points, values = random.random((50, 2)), random.random(50)
    points[0], points[1] = (0, 0), (1, 1)
    stretched = flaunay.NaturalNeighborInterpolator(points * [1, 1024], values, rescale=True)
    plain = flaunay.NaturalNeighborInterpolator(points, values)
    assert stretched(0.5, 512) == pytest.approx(plain(0.5, 0.5), abs=1e-9)


def test_griddata_is_sibson() -> None:
    points, values = [[0, 0], [4, 0], [0, 4], [4, 4]], [0, 8, 4, 0]
    assert flaunay.griddata(points, values, (2, 2), "natural") == 3


def test_errors() -> None:
    with pytest.raises(flaunay.UsageError, match="'sibson' or 'laplace', not 'area'"):
        flaunay.NaturalNeighborInterpolator([[0, 0], [1, 0], [0, 1]], [1, 2, 3], "area")
