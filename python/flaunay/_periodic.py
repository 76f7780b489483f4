"""Points on a torus: a plane that repeats itself in x and y."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, as_floats, as_offsets, frozen, summary
from flaunay._errors import UsageError

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


class PeriodicDelaunay:
    """Delaunay triangulations of points on a torus. `periodic` makes them.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, 2)
        The points as they were given.
    period : tuple of float
        Where the plane begins again, in x and in y.
    places : ndarray of float64, shape (npoints, 2)
        The points in [0, period), rounded once to multiples of the period's last bit: this is what they
        are.
    simplices : ndarray of int32, shape (nsimplex, 3)
        The corners of triangles, counter-clockwise; 2 n for each set of n different points.
    corner_offsets : ndarray of int8, shape (nsimplex, 3, 2)
        In which period each corner is, if the first one is at its place: -1, 0 or 1.
    neighbors : ndarray of int32, shape (nsimplex, 3)
        The triangle opposite to each corner. There is always one.
    representatives : ndarray of int32, shape (npoints,)
        The smallest index of a point of the set with the same place.
    simplex_offsets : ndarray of int64, shape (nsets + 1,)
        Set s has the triangles ``simplices[simplex_offsets[s]:simplex_offsets[s + 1]]``.
    """

    def __init__(
        self,
        points: Doubles,
        period: tuple[float, float],
        offsets: Optional[npt.NDArray[np.int64]],
        device: Optional[str],
    ) -> None:
        self._given = points, period, offsets, device
        self._handle = _calls.Periodic(_triangulators.of_device(device), points, period, offsets)
        arrays = {name: frozen(array) for name, array in self._handle.arrays().items()}
        self.points = points
        self.period = period
        self.places: Doubles = arrays["places"]
        self.simplices: Indices = arrays["triangles"]
        self.corner_offsets: npt.NDArray[np.int8] = arrays["offsets"]
        self.neighbors: Indices = arrays["neighbors"]
        self.representatives: Indices = arrays["representatives"]
        self.simplex_offsets: npt.NDArray[np.int64] = arrays["triangle_offsets"]

    def __repr__(self) -> str:
        return summary(self, points=self.npoints, triangles=self.nsimplex)

    def __reduce__(self) -> tuple[Any, ...]:
        # The result is a function of what was given.
        return PeriodicDelaunay, self._given

    @property
    def npoints(self) -> int:
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        return len(self.simplices)

    @cached_property
    def cell_areas(self) -> Doubles:
        """The areas of the points' Voronoi cells, rounded, shape (npoints,).

        Those of a set sum to that of the period. Points that another one represents have 0.
        """
        return frozen(self._handle.cell_areas())

    @cached_property
    def corners(self) -> Doubles:
        """Where the corners of triangles are, shape (nsimplex, 3, 2): the first one in [0, period).

        Examples
        --------
        >>> import flaunay, numpy as np
        >>> points = np.random.default_rng(1).random((200, 2))
        >>> tri = flaunay.periodic(points, (1, 1))
        >>> (a, b), (c, d) = (tri.corners[:, 1:] - tri.corners[:, :1]).transpose(1, 2, 0)
        >>> ((a * d - b * c) / 2).sum().round(12).item()
        1.0
        """
        return frozen(self.places[self.simplices] + self.corner_offsets * np.array(self.period))


def periodic(
    points: ArrayLike,
    period: tuple[float, float],
    offsets: Optional[npt.ArrayLike] = None,
    *,
    device: Optional[str] = None,
) -> PeriodicDelaunay:
    """Triangulates points in a plane that repeats itself, such as particles in a periodic box.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Any points, which are taken into the period.
    period : (float, float)
        Where the plane begins again, in x and in y.
    offsets : array_like of int, optional
        Where sets begin: set s has the points ``offsets[s]`` to ``offsets[s + 1]``. By default all points
        are one set.
    device : str, optional
        As of `triangulate`.

    Returns
    -------
    PeriodicDelaunay

    Raises
    ------
    UsageError
        For a wrong shape, a period that is not positive, and offsets that decrease or do not go from 0 to n.
    InputError
        For a point that is not finite, and if an empty circle is half as wide as the smaller period, or wider:
        there are too few points, or too large a gap. Repeat them, in a period that is a multiple.
    DeviceError
        As of `triangulate`.

    Notes
    -----
    Points are triangulated in the plane, with those images that are as near to the border as an empty circle is
    wide. Images are not rounded, so the result is exact. O(n log n).

    Examples
    --------
    >>> import flaunay, numpy as np
    >>> points = np.random.default_rng(1).random((1000, 2))
    >>> tri = flaunay.periodic(points, (1, 1))
    >>> tri
    <flaunay.PeriodicDelaunay: 1000 points, 2000 triangles>
    >>> tri.cell_areas.sum().round(12).item()
    1.0
    """
    given = np.asarray(as_floats(points, "points"), np.float64)
    if given.ndim != 2 or given.shape[1] != 2:
        raise UsageError(f"points must have the shape (n, 2), not {given.shape}")
    lengths = np.asarray(as_floats(period, "period"), np.float64)
    if lengths.shape != (2,):
        raise UsageError(f"period must be two lengths, not of shape {lengths.shape}")
    sets = None if offsets is None else as_offsets(offsets)
    return PeriodicDelaunay(frozen(given.copy()), (float(lengths[0]), float(lengths[1])), sets, device)
