"""Angles, turns and circumradii of triangles beside rational numbers."""

from fractions import Fraction

import numpy as np
import pytest

from conftest import fractions, orient
from flaunay._calls import angles, circumradii, turns


def near_the_middle(a, b, random):
    return (a + b) / 2


def far_off(a, b, random):
    return np.abs(b).max() * random.random(b.shape)


def near_an_end(a, b, random):
    return b + 1e-9 * far_off(a, b, random)


def turned(a, b, random):
    """So that the angle at a is a right one but for rounding."""
    return a + (b - a)[:, ::-1] * [1, -1]


THIRDS = [near_the_middle, near_an_end, far_off, turned]


@pytest.fixture(params=[1, 1e-310, 4e307, 1e15, 3])
def triples(request, random):
    """Points a and b, of a magnitude, and others that are in a special place to them."""
    a, b = request.param * random.uniform(-1, 1, (2, 100, 2))
    if request.param == 3:  # whole numbers, whose products are exact
        a, b = np.round(a), np.round(b)
    with np.errstate(over="ignore"):
        return [(a, b, third(a, b, random)) for third in THIRDS]


def rational(*arrays):
    return zip(*map(fractions, arrays))


def found(measure, *corners):
    """What is found about triangles that have these corners."""
    indices = np.arange(3 * len(corners[0]), dtype=np.int32)
    return measure(np.concatenate(corners), indices.reshape(3, -1).T).tolist()


def dot(a, b, c):
    return (a[0] - c[0]) * (b[0] - c[0]) + (a[1] - c[1]) * (b[1] - c[1])


def sign(number):
    return (number > 0) - (number < 0)


def test_signs_are_those_of_rational_numbers(triples):
    seen = set()
    for corners in triples:
        rows = list(rational(*corners))
        # Of a dot product's three points, the last one is the corner.
        expected = [
            [sign(dot(q, r, p)), sign(dot(r, p, q)), sign(dot(p, q, r))] for p, q, r in rows
        ]
        assert found(angles, *corners) == expected
        seen.update(*expected)
        assert found(turns, *corners) == [sign(orient(*row)) for row in rows]
    assert seen >= {-1, 1}


def test_right_angles_are_zero():
    """Also where the differences are rounded, so that only exact arithmetic can tell."""
    a = np.array([[0.0, 0.0], [0.1, 0.7], [1e-200, 0.0], [1e150, 0.0]])
    b = a + [[3.0, 4.0], [0.0, 1.0], [1e-200, 0.0], [1e150, 0.0]]
    c = a + [[-4.0, 3.0], [1.0, 0.0], [0.0, 1e-200], [0.0, 1e150]]
    third, on_line = np.nextafter(c, np.inf), a + 2 * (b - a)
    # One by one, since all of them together differ too much in magnitude.
    for row in (slice(k, k + 1) for k in range(len(a))):
        assert found(angles, a[row], b[row], c[row])[0][0] == 0
        assert found(turns, a[row], b[row], on_line[row]) == [0]
        assert found(angles, a[row], b[row], third[row])[0][0] > 0


def check_radius(radius, p, q, r):
    """Exact to 45 bits, or beyond all doubles, or subnormal, which have fewer bits."""
    area = orient(p, q, r)
    if area == 0:
        assert radius == np.inf
        return
    squares = [dot(s, s, t) for s, t in ((p, q), (q, r), (r, p))]
    expected = squares[0] * squares[1] * squares[2] / (4 * area * area)
    if radius == np.inf:
        assert expected > Fraction(1.7e308) ** 2
    elif radius > 1e-290:
        # Of squares, the error is twice as large.
        assert abs(Fraction(radius) ** 2 / expected - 1) < Fraction(2, 2**45)


def test_circumradii_are_exact_to_45_bits(triples):
    for a, b, c in triples:
        for radius, corners in zip(found(circumradii, a, b, c), rational(a, b, c)):
            check_radius(radius, *corners)


def test_circumradii_of_triangles_thinner_than_twice_the_precision():
    """On a line but for rounding, at magnitudes so different that also differences are rounded."""
    x = np.array([[6e9, 1.4e-4, 1.6e-11], [1.7e-6, 2.3e20, 0.7], [3e-12, 5e13, 1.1]])
    a, b, c = (np.stack([x[:, k] / 7, x[:, k] * 3 / 7], axis=1) for k in range(3))
    for radius, corners in zip(found(circumradii, a, b, c), rational(a, b, c)):
        assert orient(*corners) != 0 and 1e-290 < radius < np.inf
        check_radius(radius, *corners)
