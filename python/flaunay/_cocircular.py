"""Which triangles have the same circumcircle, exactly, so that their Voronoi vertices are one."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from flaunay._arrays import slices

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]
Truths = npt.NDArray[np.bool_]

# Shewchuk's bound of the error of the determinant, in units of the sum of its terms' magnitudes.
_ERROR = (10 + 96 * 2.0**-53) * 2.0**-53

# The determinant of differences between these magnitudes, or 0, neither overflows nor underflows.
_SMALLEST, _LARGEST = 2.0**-200, 2.0**200

# Differences of integers that are smaller have a determinant below 2**63 if rounding leaves open whether it is 0, so
# that it is 0 if it is 0 modulo 2**64.
_WRAPPING = 2.0**26

_DIGITS = 53


def _determinant(differences: Any) -> Any:
    """The incircle determinant of differences from the fourth point, in whatever numbers they are."""
    (ax, ay), (bx, by), (cx, cy) = differences
    return (
        (ax * ax + ay * ay) * (bx * cy - cx * by)
        + (bx * bx + by * by) * (cx * ay - ax * cy)
        + (cx * cx + cy * cy) * (ax * by - bx * ay)
    )


def _magnitude(sizes: Doubles) -> Doubles:
    """The sum of the magnitudes of the determinant's terms, of the differences' magnitudes."""
    (ax, ay), (bx, by), (cx, cy) = sizes
    magnitude: Doubles = (
        (ax * ax + ay * ay) * (bx * cy + cx * by)
        + (bx * bx + by * by) * (cx * ay + ax * cy)
        + (cx * cx + cy * cy) * (ax * by + bx * ay)
    )
    return magnitude


def _are_rectangles(quads: Doubles) -> Truths:
    """Quadrilaterals a c b d, with a and b on the diagonal, that are rectangles along the axes, as in all grids."""
    a, b, c, d = quads
    one = (a[0] == c[0]) & (c[1] == b[1]) & (b[0] == d[0]) & (d[1] == a[1])
    other = (a[1] == c[1]) & (c[0] == b[0]) & (b[1] == d[1]) & (d[0] == a[0])
    both: Truths = one | other
    return both


def _are_exact(differences: Doubles, quads: Doubles) -> Truths:
    """Which differences from the fourth point are not rounded."""
    same = (differences + quads[3] == quads[:3]) & (quads[:3] - differences == quads[3])
    exact: Truths = same.all(axis=(0, 1))
    return exact


def _as_integers(values: Doubles) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Mantissas without trailing zeros, and exponents: the values are ``mantissas * 2.0**exponents``."""
    fractions, exponents = np.frexp(values)
    mantissas = np.ldexp(fractions, _DIGITS).astype(np.int64)
    lowest = np.where(mantissas == 0, 1, mantissas & -mantissas)
    zeros = np.frexp(lowest.astype(np.float64))[1] - 1
    # A zero is as coarse as any number.
    places = np.where(mantissas == 0, 2000, exponents - _DIGITS + zeros)
    return np.right_shift(mantissas, zeros), places.astype(np.int64)


def _are_zero_wrapping(differences: Doubles) -> tuple[Truths, Truths]:
    """Determinants that rounding leaves open: which are 0, and which have been decided."""
    _, places = _as_integers(differences)
    unit = places.min(axis=(0, 1))
    scaled = np.ldexp(differences, -unit)
    decided = (np.abs(scaled) < _WRAPPING).all(axis=(0, 1))
    with np.errstate(over="ignore"):
        integers = np.where(decided, scaled, 0).astype(np.int64)
        return _determinant(integers) == 0, decided


def _are_zero_exactly(quads: Doubles) -> Truths:
    """The same by Python's integers, of any size."""
    mantissas, places = _as_integers(quads)
    shifts = places - places.min(axis=(0, 1))
    integers = mantissas.astype(object) << np.where(mantissas == 0, 0, shifts).astype(object)
    zero: Truths = np.asarray(_determinant(integers[:3] - integers[3]) == 0, np.bool_)
    return zero


def are_cocircular(quads: Doubles) -> Truths:
    """Whether four points are on one circle, exactly.

    ``quads[k, 0]`` and ``quads[k, 1]`` are the coordinates of the k-th points; the first two are the ends
    of the diagonal of a convex quadrilateral. Nearly all are decided by rounded arithmetic or because
    they are rectangles, the next by integers that may overflow, and what is left by integers of any size.
    """
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        differences = quads[:3] - quads[3]
        sizes = np.abs(differences)
        ordinary = ((sizes == 0) | ((sizes > _SMALLEST) & (sizes < _LARGEST))).all(axis=(0, 1))
        differ = ordinary & (np.abs(_determinant(differences)) > _ERROR * _magnitude(sizes))
    result: Truths = ~differ & _are_rectangles(quads)
    left = np.flatnonzero(~differ & ~result)
    wrapping = ordinary[left] & _are_exact(differences[..., left], quads[..., left])
    zero, decided = _are_zero_wrapping(differences[..., left[wrapping]])
    result[left[wrapping]] = zero & decided
    wrapping[wrapping] = decided
    left = left[~wrapping]
    result[left] = _are_zero_exactly(quads[..., left])
    return result


def _components(count: int, ends: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """For each of count nodes the smallest that it is connected to by edges with these two ends."""
    smallest = np.arange(count)
    while True:
        first, second = smallest[ends]
        apart = first != second
        if not apart.any():
            return smallest
        ends = ends[:, apart]
        first, second = first[apart], second[apart]
        np.minimum.at(smallest, np.maximum(first, second), np.minimum(first, second))
        while (smallest[smallest] != smallest).any():
            smallest = smallest[smallest]


def _quadrilaterals(
    simplices: Indices,
    simplex: npt.NDArray[np.intp],
    corner: npt.NDArray[np.intp],
    beyond: Indices,
) -> npt.NDArray[np.int64]:
    """The ends of the edges opposite to corners, the corners, and those of the simplices beyond; shape (4, k)."""
    first, second, apex = (simplices[simplex, (corner + k) % 3] for k in (1, 2, 0))
    # The neighbour's corners are those two and one more.
    opposite = simplices[beyond].sum(axis=1, dtype=np.int64) - first - second
    return np.stack([first, second, apex, opposite])


def same_circle(points: Doubles, simplices: Indices, neighbors: Indices) -> npt.NDArray[np.intp]:
    """For each simplex the smallest one that has the same circumcircle.

    Points on one empty circle are the corners of a polygon, whose triangles are connected by their edges.
    """
    # Of two neighbours the one of the larger index has the edge; -1 is no neighbour.
    simplex, corner = np.nonzero(
        (neighbors >= 0) & (neighbors < np.arange(len(simplices))[:, None])
    )
    beyond = neighbors[simplex, corner]
    ends = np.stack([simplex, beyond.astype(np.intp)])
    same = np.empty(len(simplex), bool)
    for rows in slices(len(simplex)):
        quads = _quadrilaterals(simplices, simplex[rows], corner[rows], beyond[rows])
        same[rows] = are_cocircular(points[quads].transpose(0, 2, 1))
    return _components(len(simplices), ends[:, same])


def merge_cells(
    vertices: npt.NDArray[np.intp], offsets: Indices, cells: Indices, unbounded: Truths
) -> tuple[Indices, Indices]:
    """Offsets and cells, with their vertices replaced by others, without those that follow themselves."""
    merged = vertices[cells]
    sizes = np.diff(offsets)
    cell = np.repeat(np.arange(len(sizes)), sizes)
    previous = np.arange(len(cells)) - 1
    first = offsets[:-1][sizes > 0]
    previous[first] = offsets[1:][sizes > 0] - 1
    is_first = np.zeros(len(cells), bool)
    is_first[first] = True
    # The first vertex of an unbounded cell follows none.
    kept = (merged != merged[previous]) | (is_first & unbounded[cell])
    counts = np.bincount(cell[kept], minlength=len(sizes))
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32), merged[kept].astype(np.int32)
