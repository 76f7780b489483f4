"""Cells with common owners as polygons with holes: edges that two cells of an owner share cancel."""

from __future__ import annotations

import gc
from typing import Any

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import Doubles
from flaunay._optional import optional

Indices = npt.NDArray[np.int32]


def linear_rings(shapely: Any, vertices: Doubles, offsets: Indices) -> Any:
    """Rings of Shapely, which end where they begin: of the vertices from each offset to the next, none without any."""
    sizes = np.diff(offsets) + 1
    ring = np.repeat(np.arange(len(sizes)), sizes)
    at = np.arange(len(ring)) - ring
    at[np.cumsum(sizes) - 1] = offsets[:-1]
    return shapely.linearrings(vertices[at], indices=ring)


class Dissolved:
    """The polygons of groups of cells. A group has parts; a part has an outer ring, counter-clockwise, and then its
    holes, clockwise.
    """

    def __init__(self, vertices: Doubles, offsets: Indices, groups: Indices, count: int, bounds: Doubles) -> None:
        """Dissolves cells, as ClippedVoronoi has them, whose groups have numbers below count."""
        corners, *self._offsets = _calls.join_cells(vertices, offsets, groups, count, bounds)
        self._vertices: Doubles = vertices[corners]

    def polygons(self) -> list[list[list[Doubles]]]:
        """For each group its parts, each a list of rings."""
        made: Any = self._vertices
        # Among so many new lists, the collector would look for cycles again and again.
        is_collecting = gc.isenabled()
        gc.disable()
        try:
            for offsets in self._offsets:
                ends = offsets.tolist()
                made = [made[first:last] for first, last in zip(ends, ends[1:])]
        finally:
            if is_collecting:
                gc.enable()
        polygons: list[list[list[Doubles]]] = made
        return polygons

    def to_shapely(self) -> npt.NDArray[np.object_]:
        """A Polygon or MultiPolygon for each group, an empty Polygon for one without cells."""
        shapely = optional("shapely", "voronoi_polygons")
        ring_offsets, part_offsets, group_offsets = self._offsets
        rings = linear_rings(shapely, self._vertices, ring_offsets)
        parts = shapely.polygons(
            rings, indices=np.repeat(np.arange(len(part_offsets) - 1), np.diff(part_offsets))
        )
        counts = np.diff(group_offsets)
        result = np.full(len(counts), shapely.Polygon(), dtype=object)
        result[counts == 1] = parts[group_offsets[:-1][counts == 1]]
        group = np.repeat(np.arange(len(counts)), counts)
        several = np.flatnonzero(counts > 1)
        among = counts[group] > 1
        result[several] = shapely.multipolygons(
            parts[among], indices=np.searchsorted(several, group[among])
        )
        return result
