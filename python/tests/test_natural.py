"""Natural-neighbour interpolation."""

from __future__ import annotations

import numpy as np
import pytest

import flaunay

METHODS = ("sibson", "laplace")
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
