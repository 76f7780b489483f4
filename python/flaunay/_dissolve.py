"""Cells with common owners as polygons with holes: edges that two cells of an owner share cancel."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
import numpy.typing as npt

from flaunay._arrays import Doubles
from flaunay._optional import optional
from flaunay._rings import are_outer, order_of_parts, rings_of

Places = npt.NDArray[Any]
_Hashes = npt.NDArray[np.uint64]

_ODD = np.uint64(0x9E3779B97F4A7C15)
# Corners of cells.
_AT_ONCE = 1 << 16


def _mixed(hashes: _Hashes) -> _Hashes:
    mixed: _Hashes = (hashes ^ hashes >> np.uint64(32)) * _ODD
    return mixed


def _pairs(hashes: _Hashes, are_same: Callable[[Places, Places], npt.NDArray[np.bool_]]) -> tuple[Places, Places]:
    """Rows that are the same: each such row but one, and that one.

    hashes: numbers that are equal for rows that are the same. are_same: which of two rows each are, exactly.
    """
    bits = len(hashes).bit_length() + 1
    table = np.empty(1 << bits, np.int32)
    rest = np.arange(len(hashes), dtype=np.int32)
    found: list[tuple[Places, Places]] = [(rest[:0], rest[:0])]
    while len(rest):
        # Rows that are the same stay together until one of them is in the table.
        slots = (hashes >> np.uint64(64 - bits)).view(np.int64)
        table[slots] = rest
        there = table[slots]
        beaten = np.flatnonzero(there != rest)
        rows, others = rest[beaten], there[beaten]
        same = are_same(rows, others)
        found.append((rows[same], others[same]))
        beaten = beaten[~same]
        rest, hashes = rest[beaten], _mixed(hashes[beaten])
    firsts, seconds = zip(*found)
    return np.concatenate(firsts), np.concatenate(seconds)


def _hashes_of(corners: npt.NDArray[np.complex128]) -> _Hashes:
    bits = corners.view(np.uint64).reshape(-1, 2)
    return _mixed(_mixed(bits[:, 0] * _ODD) + bits[:, 1])


def _border_of(
    corners: npt.NDArray[np.complex128], sizes: Places, cell: Places, group: Places
) -> tuple[Places, Places, Places, Places]:
    """The edges at the borders of groups of cells, by the corners at which they begin; the next one of each; and the
    cells on the two sides of every other edge.

    sizes: the numbers of corners of cells with any, in order. cell, group: those of each corner.
    """
    n = len(corners)
    # An edge begins at each corner. Its twin is the same edge the other way round.
    following = np.arange(1, n + 1, dtype=np.int32)
    ends = np.cumsum(sizes)
    following[ends - 1] = ends - sizes
    heads = corners[following]

    def are_twins(a: Places, b: Places) -> npt.NDArray[np.bool_]:
        twins: npt.NDArray[np.bool_] = (group[a] == group[b]) & (corners[a] == heads[b]) & (heads[a] == corners[b])
        return twins

    hashes = _hashes_of(corners)
    hashes += hashes[following]
    a, b = _pairs(_mixed(hashes) ^ _mixed(group.astype(np.uint64) * _ODD), are_twins)
    twin = np.full(n, -1, np.int32)
    twin[a], twin[b] = b, a
    kept = np.flatnonzero(twin < 0)
    # The next edge at the border is found by turning around the edge's end, through cells of the group. So where
    # a group touches itself in a point, each part goes on with its own edges.
    after = following[kept]
    turning = np.flatnonzero(twin[after] >= 0)
    while len(turning):
        after[turning] = following[twin[after[turning]]]
        turning = turning[twin[after[turning]] >= 0]
    rank = np.empty(n, np.int32)
    rank[kept] = np.arange(len(kept))
    return kept, rank[after], cell[a], cell[b]


class Dissolved:
    """The polygons of groups of cells.

    Ring r has ``vertices[ring_offsets[r]:ring_offsets[r + 1]]``; the rings from `part_offsets` on are those of a part,
    the outer one counter-clockwise first, then holes clockwise; the parts from `group_offsets` on those of a group.
    """

    def __init__(
        self, vertices: Doubles, offsets: npt.NDArray[Any], groups: Places, count: int, bounds: Doubles
    ) -> None:
        """Dissolves convex cells, as ClippedVoronoi has them, whose groups have numbers below count."""
        # Cells in the order of their groups.
        order = np.argsort(groups, kind="stable")
        sizes, begins, groups = np.diff(offsets)[order], offsets[:-1][order], groups[order]
        # Without a negative zero.
        all_corners = (vertices + 0.0).view(np.complex128)[:, 0]
        first_cells = np.searchsorted(groups, np.arange(count + 1))
        first_corners = np.concatenate([[0], np.cumsum(sizes)])[first_cells]
        # Some groups at a time, which stay in the processor's cache.
        cuts = np.unique(np.searchsorted(first_corners, np.arange(0, len(vertices), _AT_ONCE)))
        borders: list[tuple[Places, ...]] = []
        edge_count = 0
        for first, last in zip(first_cells[cuts], first_cells[np.append(cuts[1:], count)]):
            some, number = sizes[first:last], np.arange(first, last, dtype=np.int32)
            ends = np.cumsum(some)
            at = np.repeat(begins[first:last] - (ends - some), some) + np.arange(ends[-1] if len(ends) else 0)
            cell = np.repeat(number, some)
            kept, after, left, right = _border_of(all_corners[at], some[some > 0], cell, groups[cell])
            borders.append((at[kept], cell[kept], after + edge_count, left, right))
            edge_count += len(kept)
        kept, cell, after, left, right = (
            np.concatenate(parts) for parts in zip((np.empty(0, np.int32),) * 5, *borders)
        )
        group, tails = groups[cell], all_corners[kept]

        def are_places(a: Places, b: Places) -> npt.NDArray[np.bool_]:
            same: npt.NDArray[np.bool_] = tails[a] == tails[b]
            return same

        places = np.arange(len(kept), dtype=np.int64)
        again, first = _pairs(_hashes_of(tails), are_places)
        places[again] = first
        met = np.bincount(places, minlength=len(kept))[places]
        # A group that touches itself has two edges of three or more. Rings of others need no common numbers.
        crowded = np.flatnonzero(met >= 3)
        _, first, number = np.unique(
            places[crowded] * count + group[crowded], return_index=True, return_inverse=True
        )
        places = np.arange(len(kept))
        places[crowded] = crowded[first][number]
        members, ring_offsets = rings_of(after, places)
        # Where two cells of a group meet at the bounds, there is no corner.
        is_corner = (met > 1) | np.isin(tails, (bounds + 0.0).view(np.complex128))
        ring_offsets = np.concatenate([[0], np.cumsum(is_corner[members])])[ring_offsets]
        members = members[is_corner[members]]
        edges = kept[members]
        outer = are_outer(vertices, edges, ring_offsets)
        begin = members[ring_offsets[:-1]]
        of_ring = group[begin]
        order = order_of_parts(outer, self._components(outer, of_ring, cell[begin], left, right, count))
        order = order[np.argsort(of_ring[order], kind="stable")]
        lengths = np.diff(ring_offsets)[order]
        self.ring_offsets: Places = np.concatenate([[0], np.cumsum(lengths)])
        at = np.repeat(ring_offsets[order] - self.ring_offsets[:-1], lengths) + np.arange(len(edges))
        self.vertices: Doubles = vertices[edges[at]]
        self.part_offsets: Places = np.append(np.flatnonzero(outer[order]), len(order))
        parts = np.bincount(of_ring[outer], minlength=count)
        self.group_offsets: Places = np.concatenate([[0], np.cumsum(parts)])

    @staticmethod
    def _components(
        outer: npt.NDArray[np.bool_], group: Places, cell: Places, a: Places, b: Places, count: int
    ) -> Places:
        """A number for each ring, the same for those around the same connected cells. cell: one within the ring."""
        parts = np.bincount(group[outer], minlength=count)
        holes = np.bincount(group[~outer], minlength=count)
        result = np.where(parts[group] == 1, group, count + np.arange(len(group)))
        unclear = (parts > 1) & (holes > 0)
        if unclear.any():
            csgraph = optional("scipy.sparse.csgraph", "Groups with several parts and holes")
            sparse = optional("scipy.sparse", "Groups with several parts and holes")
            n = int(max(cell.max(), a.max(), b.max())) + 1
            graph = sparse.coo_array((np.ones(len(a), np.int8), (a, b)), shape=(n, n))
            labels: Places = csgraph.connected_components(graph, directed=False)[1]
            of_unclear = unclear[group]
            result[of_unclear] = count + len(group) + labels[cell[of_unclear]]
        return result

    def polygons(self) -> list[list[list[Doubles]]]:
        """For each group its parts, each a list of rings."""
        made: Any = self.vertices
        for offsets in self.ring_offsets, self.part_offsets, self.group_offsets:
            ends = offsets.tolist()
            made = [made[first:last] for first, last in zip(ends, ends[1:])]
        polygons: list[list[list[Doubles]]] = made
        return polygons

    def to_shapely(self) -> npt.NDArray[np.object_]:
        """A Polygon or MultiPolygon for each group, an empty Polygon for one without cells."""
        shapely = optional("shapely", "voronoi_polygons")
        sizes = np.diff(self.ring_offsets) + 1
        ends = np.cumsum(sizes)
        at = np.arange(sizes.sum()) - np.repeat(np.arange(len(sizes)), sizes)
        at[ends - 1] = self.ring_offsets[:-1]
        rings = shapely.linearrings(self.vertices[at], indices=np.repeat(np.arange(len(sizes)), sizes))
        parts = shapely.polygons(
            rings, indices=np.repeat(np.arange(len(self.part_offsets) - 1), np.diff(self.part_offsets))
        )
        counts = np.diff(self.group_offsets)
        result = np.full(len(counts), shapely.Polygon(), dtype=object)
        result[counts == 1] = parts[self.group_offsets[:-1][counts == 1]]
        group = np.repeat(np.arange(len(counts)), counts)
        several = np.flatnonzero(counts > 1)
        among = counts[group] > 1
        result[several] = shapely.multipolygons(
            parts[among], indices=np.searchsorted(several, group[among])
        )
        return result
