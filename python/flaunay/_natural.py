"""Natural-neighbour interpolation."""

from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from flaunay._errors import UsageError
from flaunay._interpolate import Points, _Columns

_METHODS = ("sibson", "laplace")


class NaturalNeighborInterpolator(_Columns):
    """Interpolation between natural neighbours, by the weights of Sibson or of Laplace.

    If a query were a point, its Voronoi cell would take a piece from the cell of each of its natural
    neighbours. By Sibson (1981), the weight of a neighbour is the area of that piece. By Laplace's
    weights (Belikov et al., 1997), it is the length of the edge between both cells over the distance of
    both points.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), or Delaunay
        As of `LinearInterpolator`.
    values : array_like, shape (npoints, ...)
        As of `LinearInterpolator`.
    method : {"sibson", "laplace"}, optional
        The weights. Sibson's are smoother, Laplace's quicker to compute.
    fill_value : float or complex, optional
        The result outside of the hull.
    rescale : bool, optional
        As of `LinearInterpolator`. Natural neighbours depend on the units of x and y.
    device : str, optional
        As of `triangulate`.

    Attributes
    ----------
    tri : Delaunay
        The triangulation, of the rescaled points if they are rescaled.

    Raises
    ------
    UsageError, InputError, DeviceError
        As of `Delaunay`, for another number of values than of points, and for another method.

    Notes
    -----
    The neighbours are found by exact tests. The errors of all weights of a query together are below
    2**-36, whatever the points, if it has fewer than a thousand neighbours. The interpolant is continuous,
    has no overshoots, and is exact for linear functions up to rounding. Its gradient is continuous
    except at the points with Sibson's weights, and except on the circles of triangles with Laplace's.
    Otherwise as `LinearInterpolator`.

    A query takes as many steps as it has neighbours: at the centre of very many cocircular points, all of
    them.

    Examples
    --------
    >>> import flaunay
    >>> points = [[0, 0], [4, 0], [0, 4], [4, 4]]
    >>> interpolate = flaunay.NaturalNeighborInterpolator(points, [0, 8, 4, 0])
    >>> interpolate([[2, 2], [2, 0], [9, 9]])
    array([ 3.,  4., nan])
    """

    def __init__(
        self,
        points: Points,
        values: npt.ArrayLike,
        method: str = "sibson",
        fill_value: complex = np.nan,
        rescale: bool = False,
        *,
        device: Optional[str] = None,
    ) -> None:
        if method not in _METHODS:
            raise UsageError(f"method must be 'sibson' or 'laplace', not {method!r}")
        self._method = method
        super().__init__(points, values, fill_value, rescale, device)
