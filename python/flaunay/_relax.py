"""Relaxation: points spread evenly, in the plane, on a torus and on the sphere."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, as_count, as_points
from flaunay._cells import corners_of
from flaunay._errors import UsageError
from flaunay._periodic import as_lengths
from flaunay._sphere import as_rows
from flaunay._surfaces import Doubles, as_weights

# The longest time of a call that relaxes points: Ctrl-C takes effect between such calls.
_SECONDS = 0.1


def parts_of(given: Any) -> Iterator[int]:
    """Iterations in numbers for calls that take about a tenth of a second each: Ctrl-C takes effect between calls."""
    iterations = as_count(given, "iterations")
    part = min(1, iterations)
    while True:
        begin = time.perf_counter()
        yield part
        iterations -= part
        if iterations == 0:
            return
        is_quick = time.perf_counter() - begin < _SECONDS / 2
        part = min(2 * part if is_quick else part, iterations)


def relax(
    points: npt.ArrayLike,
    bounds: Any = None,
    iterations: int = 1,
    device: Optional[str] = None,
    *,
    period: Optional[Sequence[Optional[float]]] = None,
    weights: Optional[ArrayLike] = None,
    sphere: bool = False,
) -> Doubles:
    """Points spread evenly by Lloyd's method: each moves to the centroid of its Voronoi cell.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or (npoints, 3) on the sphere
        As of `Delaunay`, `periodic` or `spherical`; they are not changed.
    bounds : array_like or shapely.Polygon, optional
        As of `Voronoi.clipped`: the points lie in the plane, and cells are clipped.
    iterations : int, default 1
        How often the points move. In the plane without weights, they stay on a device in between.
    device : str, optional
        As of `triangulate`.
    period : sequence of float or None, optional
        As of `periodic`, of both directions: the points lie on a torus.
    weights : array_like, shape (npoints,), optional
        As of `weighted`, except on the sphere: cells are power cells.
    sphere : bool, default False
        Whether the points lie on the sphere. They move to the direction of their cell's centroid in space (Du,
        Gunzburger and Ju, 2003), computed exactly but for rounding.

    Returns
    -------
    ndarray of float64, of the points' shape
        On a torus in the period; on the sphere degrees, or unit vectors. A point that has no cell stays where it is,
        on the sphere as it was given: one that equals an earlier point, one without a power cell, or one outside
        of the bounds whose cell does not meet them.

    Raises
    ------
    UsageError
        Unless one of bounds, period and sphere is given; for a cylinder, where cells have no end; and as of
        `periodic`, `spherical` and `weighted`.
    InputError, DeviceError
        As of these.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.relax([[0, 0], [0.5, 0.5]], (0, 0, 4, 4), iterations=50).round(2)
    array([[1.33, 1.33],
           [2.67, 2.67]])
    >>> flaunay.relax([[0, 0], [1, 0]], period=(4, 2), iterations=50).round(2)
    array([[3.5, 0. ],
           [1.5, 0. ]])
    >>> flaunay.relax([[0, 0], [90, 0], [180, 0]], sphere=True).round(2)
    array([[ -22.5,    0. ],
           [  90. ,    0. ],
           [-157.5,    0. ]])
    """
    if (bounds is not None) + (period is not None) + bool(sphere) != 1:
        raise UsageError("give one of bounds, period and sphere: the plane, a torus or the sphere")
    relaxed = as_rows(points) if sphere else np.asarray(as_points(points), np.float64)
    own = None if weights is None else as_weights(weights, len(relaxed))
    if sphere:
        kind: dict[str, Any] = {"kind": "sphere", "coordinates": _calls.sphere_coordinates(relaxed.shape[1])}
    else:
        kind = {"kind": "plane"} if period is None else {"kind": "torus", "period": as_lengths(period)}
    space = _calls.space_of(**kind, weights=own)
    corners = None if bounds is None else corners_of(bounds)
    triangulator = _triangulators.of_device(device)
    for part in parts_of(iterations):
        relaxed = _calls.relax(triangulator, relaxed, space, corners, part)
    return relaxed
