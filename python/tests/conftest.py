"""What the tests share."""

from __future__ import annotations

import numpy as np
import pytest


def as_set(triangles):
    """Triangles without the order of rows, and each without that of its corners."""
    return {tuple(sorted(row)) for row in np.asarray(triangles).tolist()}


def areas(points, triangles):
    """Twice the triangles' areas, positive if counter-clockwise."""
    a, b, c = (np.asarray(points, np.float64)[triangles[:, k]] for k in range(3))
    return (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])


def check_neighbors(triangles, neighbors):
    """neighbors[i, k] has the edge opposite to corner k of triangle i, the other way round."""
    assert neighbors.shape == triangles.shape
    edges = {}
    for t, row in enumerate(triangles.tolist()):
        for k in range(3):
            edges[row[(k + 1) % 3], row[(k + 2) % 3]] = (t, k)
    for (a, b), (t, k) in edges.items():
        assert neighbors[t, k] == edges.get((b, a), (-1, 0))[0]


def triangulates_all(points, triangles, hull, representatives):
    """Whether the number of triangles is Euler's for the distinct points."""
    vertices = np.count_nonzero(representatives == np.arange(len(points)))
    return len(triangles) == 2 * vertices - 2 - len(hull)


@pytest.fixture
def random():
    return np.random.default_rng(1)
