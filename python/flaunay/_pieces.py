"""Voronoi cells clipped to any polygons, in convex pieces."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
import numpy.typing as npt

from flaunay._arrays import Frozen, frozen, summary
from flaunay._cells import clip
from flaunay._delaunay import Delaunay
from flaunay._dissolve import linear_rings
from flaunay._errors import UsageError
from flaunay._optional import optional
from flaunay._polygons import PolygonTriangulation, polygons

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


class VoronoiPieces(Frozen):
    """The Voronoi cells of points, clipped to polygons with holes. `Voronoi.pieces` makes it.

    Attributes
    ----------
    vertices : ndarray of float64, shape (nvertices, 2)
        Piece k has ``vertices[offsets[k]:offsets[k + 1]]``, counter-clockwise, and is convex.
    offsets : ndarray of int32, shape (npieces + 1,)
    owners : ndarray of int32, shape (npieces,)
        The point whose cell each piece is of, in increasing order.
    areas : ndarray of float64, shape (npoints,)
        Of each cell together; 0 for those without pieces.
    centroids : ndarray of float64, shape (npoints, 2)
        NaN for cells without pieces.
    """

    def __init__(
        self,
        vertices: Doubles,
        offsets: Indices,
        owners: Indices,
        areas: Doubles,
        centroids: Doubles,
    ) -> None:
        self.vertices: Doubles = frozen(vertices)
        self.offsets: Indices = frozen(offsets)
        self.owners: Indices = frozen(owners)
        self.areas: Doubles = frozen(areas)
        self.centroids: Doubles = frozen(centroids)

    def __repr__(self) -> str:
        return summary(self, points=len(self.areas), pieces=len(self.owners))

    def polygons(self, i: int) -> list[Doubles]:
        """The pieces of cell i. IndexError for a cell that does not exist; negative numbers count from the end."""
        n, i = len(self.areas), operator.index(i)
        if not -n <= i < n:
            raise IndexError(f"cell {i} of {n}")
        first, last = np.searchsorted(self.owners, [i % n, i % n + 1])
        return [self.vertices[self.offsets[k] : self.offsets[k + 1]] for k in range(first, last)]

    def to_shapely(self) -> npt.NDArray[np.object_]:
        """An array of one geometry of Shapely per point: the union of its pieces, empty if it has none.

        Raises
        ------
        ImportError
            Without Shapely 2.
        """
        shapely = optional("shapely", "VoronoiPieces.to_shapely")
        pieces = shapely.polygons(linear_rings(shapely, self.vertices, self.offsets))
        result = np.full(len(self.areas), shapely.Polygon(), dtype=object)
        owners, numbers = np.unique(self.owners, return_inverse=True)
        result[owners] = shapely.union_all(shapely.geometrycollections(pieces, indices=numbers)[:, None], axis=1)
        return result


def _boxes_that_meet(triangles: Doubles, least: Doubles, most: Doubles) -> list[npt.NDArray[np.intp]]:
    """For each triangle the boxes that meet its own: of ever smaller groups of triangles, those that meet the group's."""
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    result = [np.empty(0, np.intp)] * len(triangles)
    groups = [(np.arange(len(triangles)), np.arange(len(least)))]
    while groups:
        group, boxes = groups.pop()
        meets = (least[boxes] <= high[group].max(axis=0)).all(axis=1)
        meets &= (most[boxes] >= low[group].min(axis=0)).all(axis=1)
        boxes = boxes[meets]
        if len(group) == 1:
            result[group[0]] = boxes
            continue
        centres = low[group] + high[group]
        group = group[np.argsort(centres[:, np.ptp(centres, axis=0).argmax()], kind="stable")]
        half = len(group) // 2
        groups += [(group[:half], boxes), (group[half:], boxes)]
    return result


def mesh_of(region: Any) -> PolygonTriangulation:
    """The triangles of polygons, of which there must be some."""
    mesh = polygons(region, map=True)
    if not (mesh.polygon_of >= 0).any():
        raise UsageError("the polygons have no area")
    return mesh


def pieces(tri: Delaunay, mesh: PolygonTriangulation) -> VoronoiPieces:
    """As `Voronoi.pieces` says, of the cells of a triangulation's points, in the polygons of a mesh."""
    triangles = mesh.triangles[mesh.polygon_of >= 0]
    n = tri.npoints
    if n == 0:
        nothing = np.empty((0, 2))
        return VoronoiPieces(
            nothing, np.zeros(1, np.int32), np.empty(0, np.int32), np.empty(0), nothing
        )
    corners = mesh.points[triangles]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    # Only points whose cells meet a triangle count in it; which those are, boxes around the cells say.
    cells = clip(tri, (*low, *high))
    there = np.flatnonzero(np.diff(cells.offsets))
    margin = 1e-9 * (np.abs([low, high]).max() + (high - low).max())
    begins = cells.offsets[there]
    least = np.minimum.reduceat(cells.vertices, begins) - margin
    most = np.maximum.reduceat(cells.vertices, begins) + margin
    points = np.asarray(tri.points, np.float64)
    vertices, sizes, owners, areas, moments = [], [], [], np.zeros(n), np.zeros((n, 2))
    for triangle, near in zip(corners, _boxes_that_meet(corners, least, most)):
        candidates = there[near]
        part = clip(Delaunay(points[candidates], device=tri._device), triangle)
        kept = np.flatnonzero(np.diff(part.offsets))
        vertices.append(part.vertices)
        sizes.append(np.diff(part.offsets)[kept])
        owners.append(candidates[kept])
        areas[candidates] += part.areas
        moments[candidates[kept]] += part.areas[kept, None] * part.centroids[kept]
    owner, size = np.concatenate(owners), np.concatenate(sizes)
    order = np.argsort(owner, kind="stable")
    ends = np.cumsum(size)
    lengths = size[order]
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    at = np.repeat((ends - size)[order] - offsets[:-1], lengths) + np.arange(offsets[-1])
    with np.errstate(divide="ignore", invalid="ignore"):
        centroids = moments / areas[:, None]
    return VoronoiPieces(
        np.concatenate(vertices)[at],
        offsets.astype(np.int32),
        owner[order].astype(np.int32),
        areas,
        centroids,
    )
