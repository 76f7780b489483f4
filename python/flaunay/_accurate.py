"""Dot products of differences of coordinates: their exact signs, and values of high relative precision."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Signs = npt.NDArray[np.int8]

_EPSILON = np.finfo(np.float64).eps
# Of a dot product in plain double, relative to the sum of its two terms' magnitudes; with room to spare.
_PLAIN_ERROR = 4 * _EPSILON
# Of one in twice the precision.
_TWOFOLD_ERROR = 64 * _EPSILON**2
# No underflow of a product makes a larger error.
_UNDERFLOW = 1e-300
# From here on differences may overflow.
_OVERFLOWING = 2.0**1000
# Splits a double into two halves of 26 bits.
_SPLITTER = 2.0**27 + 1
# Between these, no product of two differences and no error of one overflows or underflows.
_SMALLEST, _LARGEST = 1e-120, 1e120


def _difference(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """a - b as a rounded value and the exact rest (Knuth)."""
    value = a - b
    b_virtual = a - value
    return value, (a - (value + b_virtual)) + (b_virtual - b)


def _halves(a: Doubles) -> tuple[Doubles, Doubles]:
    high = a * _SPLITTER
    high = high - (high - a)
    return high, a - high


def _product(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """a b as a rounded value and the exact rest (Dekker)."""
    value = a * b
    (a_high, a_low), (b_high, b_low) = _halves(a), _halves(b)
    rest = a_low * b_low - (((value - a_high * b_high) - a_low * b_high) - a_high * b_low)
    return value, rest


def _sum(a: Doubles, b: Doubles) -> tuple[Doubles, Doubles]:
    """a + b as a rounded value and the exact rest."""
    return _difference(a, -b)


class Differences:
    """The vectors a - b, each coordinate as a double and what rounding has cut off."""

    def __init__(self, a: Doubles, b: Doubles) -> None:
        self.value, self.rest = _difference(a, b)

    def __getitem__(self, rows: npt.NDArray[np.intp]) -> Differences:
        some = object.__new__(Differences)
        some.value, some.rest = self.value[rows], self.rest[rows]
        return some

    def scaled(self, exponents: npt.NDArray[np.int32]) -> Differences:
        """Times two to the power of the exponents, one for each vector."""
        other = object.__new__(Differences)
        other.value = np.ldexp(self.value, exponents[:, None])
        other.rest = np.ldexp(self.rest, exponents[:, None])
        return other

    def turned(self) -> Differences:
        """By a right angle to the right, so that `u.dot(v.turned())` is the cross product of u and v."""
        other = object.__new__(Differences)
        sign = np.array([1.0, -1.0])
        other.value, other.rest = self.value[:, ::-1] * sign, self.rest[:, ::-1] * sign
        return other

    def plain_dot(self, other: Differences) -> tuple[Doubles, Doubles]:
        """Dot products in double, and the sums of their terms' magnitudes."""
        products = self.value * other.value
        return products.sum(axis=1), np.abs(products).sum(axis=1)

    def twofold_dot(self, other: Differences) -> tuple[Doubles, Doubles]:
        """Dot products rounded from twice the precision: their leading parts, and corrections to add."""
        products, rests = _product(self.value, other.value)
        total, rest = _sum(products[:, 0], products[:, 1])
        crossed = self.value * other.rest + self.rest * other.value
        return total, rest + (rests.sum(axis=1) + crossed.sum(axis=1))

    def is_exact(self) -> npt.NDArray[np.bool_]:
        """Where rounding has cut off nothing."""
        exact: npt.NDArray[np.bool_] = (self.rest == 0).all(axis=1)
        return exact

    def is_ordinary(self) -> npt.NDArray[np.bool_]:
        """Where products neither overflow nor underflow."""
        size = np.abs(self.value)
        ordinary: npt.NDArray[np.bool_] = (
            ((size > _SMALLEST) & (size < _LARGEST)) | (size == 0)
        ).all(axis=1)
        return ordinary


def _exact_dot(u: Differences, v: Differences, row: int) -> Fraction:
    """In rational numbers."""
    dot = Fraction(0)
    for axis in range(2):
        first, second = (
            Fraction(float(side.value[row, axis])) + Fraction(float(side.rest[row, axis]))
            for side in (u, v)
        )
        dot += first * second
    return dot


def _twofold_signs(u: Differences, v: Differences) -> tuple[Signs, npt.NDArray[np.bool_]]:
    """Signs of dot products, and which of them are certain."""
    total, rest = u.twofold_dot(v)
    value = total + rest
    _, magnitude = u.plain_dot(v)
    # With exact differences only products and their sum round. If the rounded products cancel, what is
    # left is a sum of two doubles; else it is too small to change the sign.
    products, rests = _product(u.value, v.value)
    opposite = products[:, 0] == -products[:, 1]
    exact = np.where(opposite, rests.sum(axis=1), total)
    is_exact = u.is_exact() & v.is_exact()
    signs = np.sign(np.where(is_exact, exact, value)).astype(np.int8)
    certain = is_exact | (np.abs(value) > _TWOFOLD_ERROR * magnitude)
    return signs, certain & u.is_ordinary() & v.is_ordinary()


def _signs(u: Differences, v: Differences) -> Signs:
    """The exact signs of the dot products u . v."""
    plain, magnitude = u.plain_dot(v)
    signs = np.sign(plain).astype(np.int8)
    unsure = np.flatnonzero(~(np.abs(plain) > _PLAIN_ERROR * magnitude + _UNDERFLOW))
    if unsure.size:
        signs[unsure], certain = _twofold_signs(u[unsure], v[unsure])
        unsure = unsure[~certain]
    for row in unsure.tolist():
        dot = _exact_dot(u, v, row)
        signs[row] = (dot > 0) - (dot < 0)
    return signs


def _moderate(*points: Doubles) -> tuple[list[Doubles], int]:
    """Points whose differences do not overflow, and the exponent of the power of two that they were divided by.

    Flaunay triangulates no points of which some are so large and others so small that this rounds them.
    """
    largest = max((float(np.abs(p).max()) for p in points if p.size), default=0.0)
    exponent = 4 if largest > _OVERFLOWING else 0
    return [np.ldexp(p, -exponent) if exponent else p for p in points], exponent


def signs_of_dots(a: Doubles, b: Doubles, c: Doubles) -> Signs:
    """The exact signs of (a - c) . (b - c) for points a, b, c of shape (n, 2): -1, 0 or 1 for each row.

    Positive where the angle at c is acute, negative where it is obtuse.
    """
    (a, b, c), _ = _moderate(a, b, c)
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        return _signs(Differences(a, c), Differences(b, c))


def signs_of_turns(a: Doubles, b: Doubles, c: Doubles) -> Signs:
    """The exact signs of the turns at b on the way from a to c: 1 to the left, -1 to the right, 0 for none."""
    (a, b, c), _ = _moderate(a, b, c)
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        return _signs(Differences(b, a), Differences(c, a).turned())


# Where terms cancel to less than this part of their magnitude, plain doubles lose too much, and twice the precision.
_CANCELLED = 1 / 16
_CANCELLED_TWOFOLD = 2.0**48 * _TWOFOLD_ERROR


def circumradii_of(a: Doubles, b: Doubles, c: Doubles) -> Doubles:
    """The circumradii of triangles with corners of shape (n, 2), with a relative error below 2**-45.

    Infinite where they exceed the largest double, or the area vanishes.
    """
    (a, b, c), exponent = _moderate(a, b, c)
    with np.errstate(over="ignore", invalid="ignore", under="ignore", divide="ignore"):
        u, v = Differences(b, a), Differences(c, a)
        # Sides between about 1/2 and 2 neither overflow nor underflow.
        size = np.maximum(np.abs(u.value).max(axis=1), np.abs(v.value).max(axis=1))
        _, exponents = np.frexp(size)
        u, v, w = (side.scaled(-exponents) for side in (u, v, Differences(c, b)))
        turned = v.turned()
        cross, magnitude = u.plain_dot(turned)
        few = np.flatnonzero(np.abs(cross) < _CANCELLED * magnitude)
        if few.size:
            total, rest = u[few].twofold_dot(turned[few])
            cross[few] = total + rest
            limit = _CANCELLED_TWOFOLD * magnitude[few] + _UNDERFLOW
            for row in few[np.abs(cross[few]) < limit].tolist():
                cross[row] = float(_exact_dot(u, turned, row))
        # Squares, which are exact for coordinates of few bits.
        squares = [(side.value**2).sum(axis=1) for side in (u, v, w)]
        product = np.sqrt(squares[0] * squares[1] * squares[2])
        radii: Doubles = np.ldexp(product / (2 * np.abs(cross)), exponents + exponent)
    # No length over no area.
    radii[np.isnan(radii)] = np.inf
    return radii
