"""The border of a mesh, and the places on it that are nearest to what is outside."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Optional

import numpy as np
import numpy.typing as npt

from flaunay._arrays import FloatArray

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

# From a corner of a triangle to its next one, and to its previous one.
_NEXT, _PREVIOUS = np.array([1, 1, -2]), np.array([2, -1, -1])

# The most distances that are computed at a time.
_MOST_PAIRS = 1 << 22


def ends_opposite(
    triangles: npt.NDArray[np.int32], corners: Indices
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """The first and the second ends of the edges opposite to corners, with their triangles on the left.

    Corner k of triangle t has the number 3 t + k. In one dimension NumPy is quickest, above all for few triangles.
    """
    flat, columns = triangles.reshape(-1), corners % 3
    return flat[corners + _NEXT[columns]], flat[corners + _PREVIOUS[columns]]


class Border:
    """The edges that one triangle has, directed so that it is on their left."""

    def __init__(
        self,
        points: FloatArray,
        triangles: npt.NDArray[np.int32],
        neighbors: npt.NDArray[np.int32],
    ) -> None:
        corners = (neighbors.reshape(-1) < 0).nonzero()[0]
        self.triangles = corners // 3
        self.firsts, self.seconds = ends_opposite(triangles, corners)
        self._points = points

    @property
    def edges(self) -> npt.NDArray[np.int32]:
        return np.stack([self.firsts, self.seconds], axis=1)

    def nearest(
        self, queries: Doubles, near: Optional[npt.NDArray[np.int32]] = None
    ) -> tuple[Indices, Doubles, Doubles]:
        """For each query the nearest edge, the part of it before the nearest place, and the distance.

        near: the nearest point of each query, which are needed on one line.
        """
        edges = np.empty(len(queries), np.intp)
        parts, distances = np.empty(len(queries)), np.empty(len(queries))
        for rows, candidates in self._candidates(queries):
            at_row = queries[rows, None]
            begin = np.asarray(self._points[self.firsts[candidates]], np.float64)
            along = self._points[self.seconds[candidates]] - begin
            lengths = (along * along).sum(axis=-1)
            part = ((at_row - begin) * along).sum(axis=-1) / lengths
            part = part.clip(0, 1)
            away = np.hypot(*np.moveaxis(begin + part[..., None] * along - at_row, -1, 0))
            best = away.argmin(axis=1)
            picked = np.arange(len(best)), best
            edges[rows] = np.broadcast_to(candidates, away.shape)[picked]
            parts[rows], distances[rows] = part[picked], away[picked]
        return edges, parts, distances

    def _candidates(self, queries: Doubles) -> Iterator[tuple[slice, Indices]]:
        """Some queries at a time, with edges among which the nearest ones are."""
        step = max(1, _MOST_PAIRS // max(1, len(self.firsts)))
        for begin in range(0, len(queries), step):
            yield slice(begin, begin + step), np.arange(len(self.firsts))[None]


class LineBorder(Border):
    """Points on one line, which have no triangles: the edges between those that follow each other."""

    def __init__(self, points: FloatArray, hull: npt.NDArray[np.int32]) -> None:
        """hull: the points in their order."""
        # A point alone is an edge from itself to itself.
        self.firsts, self.seconds = (hull, hull) if len(hull) == 1 else (hull[:-1], hull[1:])
        self.triangles = np.arange(len(self.firsts))
        self._points, self._hull = points, hull

    def nearest(
        self, queries: Doubles, near: Optional[npt.NDArray[np.int32]] = None
    ) -> tuple[Indices, Doubles, Doubles]:
        place = np.empty(len(self._points), np.intp)
        place[self._hull] = np.arange(len(self._hull))
        at: Indices = place[near]
        line = np.asarray(self._points[self._hull], np.float64)
        away = queries - line[at]
        # From the nearest point on to the next one on the side of the query, if there is one.
        is_ahead = away @ (line[-1] - line[0]) > 0
        edges = (at - ~is_ahead).clip(0, len(self.firsts) - 1)
        is_first = self.firsts[edges] == near
        along = line[(at + np.where(is_first, 1, -1)).clip(0, len(line) - 1)] - line[at]
        with np.errstate(invalid="ignore"):
            part = np.nan_to_num((away * along).sum(axis=1) / (along * along).sum(axis=1)).clip(
                0, 1
            )
        distances = np.hypot(*(part[:, None] * along - away).T)
        return edges, np.where(is_first, part, 1 - part), distances


class ConvexBorder(Border):
    """That of a convex mesh, whose nearest places to queries outside take a logarithmic number of steps."""

    def __init__(
        self,
        points: FloatArray,
        triangles: npt.NDArray[np.int32],
        neighbors: npt.NDArray[np.int32],
        hull: npt.NDArray[np.int32],
    ) -> None:
        super().__init__(points, triangles, neighbors)
        by_first = np.empty(len(points), np.intp)
        by_first[self.firsts] = np.arange(len(self.firsts))
        # Counter-clockwise.
        self._ring = by_first[hull]
        self._at = np.asarray(points[hull], np.float64)
        self._along = np.roll(self._at, -1, axis=0) - self._at
        turns = np.unwrap(np.arctan2(self._along[:, 1], self._along[:, 0]))
        turns = np.maximum.accumulate(turns)
        self._turns = np.concatenate([turns - 2 * np.pi, turns, turns + 2 * np.pi])

    def _candidates(self, queries: Doubles) -> Iterator[tuple[slice, Indices]]:
        """Along the edges that a query sees, distances first fall and then rise.

        So from one that it sees, a binary search finds the last one along which distances fall. The edges beside it
        are candidates, too, since signs here are rounded.
        """
        count = len(self._ring)
        centre = self._at.mean(axis=0)
        angles = np.arctan2(*(self._at - centre).T[::-1])
        first = int(np.argmin(angles))
        places = np.searchsorted(
            np.roll(angles, -first), np.arctan2(*(queries - centre).T[::-1]), "right"
        )
        seen = (places - 1 + first) % count
        turns = self._turns[seen + count]
        ahead = np.searchsorted(self._turns, turns + np.pi) - seen - count
        behind = seen + count - np.searchsorted(self._turns, turns - np.pi, "right")
        steps = self._steps(queries, seen, ahead, 1)
        back = self._steps(queries, seen, behind, -1)
        last = seen + np.where(steps > 0, steps, -back)
        yield slice(None), self._ring[(last[:, None] + np.arange(-1, 2)) % count]

    def _steps(self, queries: Doubles, seen: Indices, most: Indices, way: int) -> Indices:
        """How many edges follow each other from those seen on along which distances fall."""
        low, high = np.zeros(len(seen), np.intp), most.copy()
        while (low < high).any():
            middle = (low + high) // 2
            edge = (seen + way * middle) % len(self._ring)
            along, away = self._along[edge], queries - self._at[edge]
            end = away - along if way > 0 else away
            falls = way * (end * along).sum(axis=1) > 0
            falls &= along[:, 0] * away[:, 1] < along[:, 1] * away[:, 0]
            low = np.where(falls & (low < high), middle + 1, low)
            high = np.where(falls, high, np.minimum(high, middle))
        return low
