"""Relaxation: points spread evenly, in the plane, on a torus and on the sphere."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any, Callable, Optional, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import ArrayLike, as_count, as_floats, as_points
from flaunay._cells import ClippedVoronoi, clip, corners_of, ring_of, with_corner
from flaunay._delaunay import Delaunay
from flaunay._errors import InputError, UsageError
from flaunay._periodic import as_lengths
from flaunay._pieces import VoronoiPieces, mesh_of, pieces
from flaunay._polygons import PolygonTriangulation
from flaunay._sphere import as_rows
from flaunay._surfaces import Doubles, as_weights

# The longest time of a call that relaxes points: Ctrl-C takes effect between such calls.
_SECONDS = 0.1

# What takes polygons that are not convex.
_REGION = "region= takes any polygons"


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


# Seven places in a triangle, as shares of its corners, and their weights: exact for polynomials of degree 5 (Radon, 1948).
_ROOT = 15.0**0.5
_NEAR, _FAR = (6 - _ROOT) / 21, (6 + _ROOT) / 21
_SHARES = np.array(
    [[1 / 3] * 3, *(np.roll([1 - 2 * s, s, s], k) for s in (_NEAR, _FAR) for k in range(3))]
)
_WEIGHTS = np.repeat([9 / 40, (155 - _ROOT) / 1200, (155 + _ROOT) / 1200], [1, 3, 3])


def _mass_of(given: Any, shape: tuple[int, ...]) -> Doubles:
    """Densities, checked."""
    mass = np.asarray(as_floats(given, "density"), np.float64)
    if mass.shape != shape:
        raise UsageError(f"density must return one number per place, of the shape {shape}, not {mass.shape}")
    if not ((mass >= 0) & (mass < np.inf)).all():
        raise UsageError("densities must be finite and not negative")
    return mass


def _of_function(density: Callable[[Doubles], Any], cells: Union[ClippedVoronoi, VoronoiPieces], n: int) -> Doubles:
    """The centroids of cells by a density that is a function, NaN for those without mass."""
    owners = cells.owners if isinstance(cells, VoronoiPieces) else np.arange(n)
    sizes = np.maximum(np.diff(cells.offsets) - 2, 0)
    # Triangles from the first corner of each piece.
    first = np.repeat(cells.offsets[:-1], sizes)
    second = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes) + first + 1
    corners = cells.vertices[np.stack([first, second, second + 1], axis=1)]
    (ax, ay), (bx, by) = (corners[:, 1:] - corners[:, :1]).transpose(1, 2, 0)
    places = (_SHARES @ corners).reshape(-1, 2)
    mass = _mass_of(density(places.copy()), (len(places),)) * np.repeat((ax * by - ay * bx) / 2, 7)
    mass *= np.tile(_WEIGHTS, len(corners))
    return _centroids(np.repeat(np.repeat(owners, sizes), 7), mass, places, n)


def _centroids(owners: npt.NDArray[Any], mass: Doubles, places: Doubles, n: int) -> Doubles:
    total, x, y = (np.bincount(owners, mass * by, minlength=n) for by in (1.0, places[:, 0], places[:, 1]))
    with np.errstate(invalid="ignore"):
        return np.stack([x, y], axis=1) / total[:, None]


class _Pixels:
    """A raster over a box, of which those pixels count whose centres are in polygons."""

    def __init__(self, given: ArrayLike, mesh: PolygonTriangulation) -> None:
        density = as_floats(given, "density")
        if density.ndim != 2 or density.size == 0:
            raise UsageError(f"density must be a function or a raster of rows and columns, not of shape {density.shape}")
        mass = _mass_of(density, density.shape)
        corners = mesh.points[mesh.triangles]
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        (rows, columns), (dx, dy) = density.shape, (high - low) / density.shape[::-1]
        x, y = low[0] + dx * (np.arange(columns) + 0.5), high[1] - dy * (np.arange(rows) + 0.5)
        self.places: Doubles = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        counts = mass.ravel() > 0
        counts[counts] = _are_inside(self.places[counts], mesh)
        self.places, self.mass = self.places[counts], mass.ravel()[counts]

    def centroids(self, tri: Delaunay) -> Doubles:
        return _centroids(tri.nearest(self.places), self.mass, self.places, tri.npoints)


def _are_inside(places: Doubles, mesh: PolygonTriangulation) -> npt.NDArray[np.bool_]:
    triangles = mesh.find_simplex(places)
    inside: npt.NDArray[np.bool_] = (triangles >= 0) & (mesh.polygon_of[triangles] >= 0)
    return inside


def _nearest_in(cells: VoronoiPieces, wanted: npt.NDArray[Any], places: Doubles) -> tuple[npt.NDArray[Any], Doubles]:
    """Those of the wanted cells that have pieces, and where the border of their pieces is nearest to their places."""
    begins, ends = cells.offsets[:-1], cells.offsets[1:]
    owners = np.repeat(cells.owners, ends - begins)
    following = np.arange(1, len(owners) + 1)
    following[ends - 1] = begins
    at = np.flatnonzero(np.isin(owners, wanted))
    owners, begin = owners[at], cells.vertices[at]
    along, place = cells.vertices[following[at]] - begin, places[owners]
    share = ((place - begin) * along).sum(axis=1) / (along * along).sum(axis=1)
    on = begin + along * np.clip(share, 0, 1)[:, None]
    order = np.lexsort((((on - place) ** 2).sum(axis=1), owners))
    found, first = np.unique(owners[order], return_index=True)
    return found, on[order[first]]


def _relax_in_polygons(
    points: Doubles,
    region: Any,
    bounds: Any,
    density: Any,
    iterations: int,
    device: Optional[str],
) -> Doubles:
    """Lloyd's method with a density or in any polygons."""
    if bounds is not None:
        # Errors are those without a density. With a function, each iteration clips the cells of the points.
        clip(Delaunay(points[:0] if callable(density) else points, device=device), bounds, _REGION)
        region = [[corners_of(bounds)]]
    mesh = mesh_of(region)
    pixels = None if density is None or callable(density) else _Pixels(density, mesh)
    count = as_count(iterations, "iterations")
    for _ in range(count if len(points) else 0):
        tri, cells = Delaunay(points, device=device), None
        if pixels is not None:
            moved = pixels.centroids(tri)
        else:
            cells = pieces(tri, mesh) if bounds is None else clip(tri, bounds)
            moved = cells.centroids if density is None else _of_function(density, cells, len(points))
        stays = np.isnan(moved).any(axis=1)
        moved = np.where(stays[:, None], points, moved)
        if bounds is None:
            # A centroid may lie in a hole, or beyond a bay.
            outside = np.flatnonzero(~stays)
            outside = outside[~_are_inside(moved[outside], mesh)]
            if len(outside):
                parts = cells if isinstance(cells, VoronoiPieces) else pieces(tri, mesh)
                found, ends = _nearest_in(parts, outside, moved)
                moved[outside] = points[outside]
                moved[found] = ends
        points = moved
    return points


def relax(
    points: npt.ArrayLike,
    bounds: Any = None,
    iterations: int = 1,
    device: Optional[str] = None,
    *,
    period: Optional[Sequence[Optional[float]]] = None,
    weights: Optional[ArrayLike] = None,
    sphere: bool = False,
    region: Any = None,
    density: Union[None, Callable[[Doubles], npt.ArrayLike], npt.ArrayLike] = None,
) -> Doubles:
    """Points spread evenly, or by a density, by Lloyd's method: each moves to the centroid of its Voronoi cell.

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
    region : shapely.Polygon or MultiPolygon, GeoSeries, GeoJSON, or list of polygons, optional
        In place of bounds, any polygons, with holes, as `Voronoi.pieces` takes them. A point whose centroid is not in
        them moves to the nearest place of its cell.
    density : callable or array_like, shape (rows, columns), optional
        Within bounds or a region: how many points there shall be, not negative. A function of places, float64, shape
        (m, 2), which returns m numbers, integrated by seven places in each triangle of a cell; or a raster over the
        box of the bounds or the region, the first row with the largest y, whose pixels' centres are counted by their
        nearest points (Secord, 2002), so that cells should have several. The density of points approaches its
        square root.

    Returns
    -------
    ndarray of float64, of the points' shape
        On a torus in the period; on the sphere degrees, or unit vectors. A point that has no cell stays where it is,
        on the sphere as it was given: one that equals an earlier point, one without a power cell, or one outside
        of the bounds whose cell does not meet them.

    Raises
    ------
    UsageError
        Unless one of bounds, region, period and sphere is given; for a cylinder, where cells have no end; for a
        density with other spaces, weights with it or with a region, densities that are negative or not finite; and as
        of `periodic`, `spherical`, `weighted` and `polygons`.
    InputError, DeviceError
        As of these.

    Notes
    -----
    O(n log n) work per iteration, and for a region a call for each of its triangles.

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
    >>> frame = [[[0, 0], [4, 0], [4, 4], [0, 4]], [[1, 1], [3, 1], [3, 3], [1, 3]]]
    >>> flaunay.relax([[0.5, 2], [3, 2]], region=[frame], iterations=20).round(2)
    array([[0.83, 2.  ],
           [3.17, 2.  ]])
    >>> flaunay.relax([[1, 1], [3, 1]], (0, 0, 4, 2), 20, density=lambda at: at[:, 0]).round(2)
    array([[1.65, 1.  ],
           [3.3 , 1.  ]])
    """
    if (bounds is not None) + (region is not None) + (period is not None) + bool(sphere) != 1:
        raise UsageError("give one of bounds, region, period and sphere: the plane, a torus or the sphere")
    if region is not None or density is not None:
        if weights is not None or period is not None or sphere:
            raise UsageError("regions and densities are for points in the plane without weights")
        given = np.array(as_points(points), np.float64)
        return _relax_in_polygons(given, region, bounds, density, iterations, device)
    relaxed = as_rows(points) if sphere else np.asarray(as_points(points), np.float64)
    own = None if weights is None else as_weights(weights, len(relaxed))
    if sphere:
        kind: dict[str, Any] = {"kind": "sphere", "coordinates": _calls.sphere_coordinates(relaxed.shape[1])}
    else:
        kind = {"kind": "plane"} if period is None else {"kind": "torus", "period": as_lengths(period)}
    space = _calls.space_of(**kind, weights=own)
    corners, is_turned = (None, False) if bounds is None else ring_of(bounds, _REGION)
    triangulator = _triangulators.of_device(device)
    for part in parts_of(iterations):
        try:
            relaxed = _calls.relax(triangulator, relaxed, space, corners, part)
        except InputError as error:
            if corners is None:
                raise
            raise with_corner(error, len(corners), is_turned, _REGION) from None
    return relaxed
