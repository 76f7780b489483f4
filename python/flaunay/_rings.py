"""Closed rings of edges that follow each other, and which of them are holes."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from flaunay import _calls
from flaunay._arrays import FloatArray

Places = npt.NDArray[np.intp]


def _split(ring: Places, places: Places) -> list[Places]:
    """The parts of a ring of edges, each closed where the ring meets a place again."""
    parts: list[Places] = []
    path: list[int] = []
    depth: dict[int, int] = {}
    for edge, place in zip(ring.tolist(), places[ring].tolist()):
        if place in depth:
            start = depth[place]
            parts.append(np.array(path[start:], np.intp))
            for left in path[start:]:
                del depth[int(places[left])]
            del path[start:]
        depth[place] = len(path)
        path.append(edge)
    return [*parts, np.array(path, np.intp)]


def rings_of(following: npt.NDArray[Any], places: npt.NDArray[Any]) -> tuple[Places, Places]:
    """The edges of all rings, ring by ring, and where each ring begins.

    following: the next edge of each one. places: the number of the place where each edge begins, below that of edges.
    No ring meets a place twice: one that does is split there.
    """
    n = len(following)
    # Edges that follow each other in the array are one step.
    is_first = np.ones(n, np.bool_)
    is_first[1:] = following[:-1] != np.arange(1, n)
    first = np.flatnonzero(is_first)
    last = np.append(first[1:], n)[: len(first)] - 1
    step_of = np.cumsum(is_first) - 1
    after = step_of[following[last]].tolist()
    steps: list[int] = []
    add = steps.append
    ends = [0]
    for begin in range(len(after)):
        step = begin
        # A step that was taken has no next one.
        while (following_step := after[step]) >= 0:
            after[step] = -1
            add(step)
            step = following_step
        if len(steps) > ends[-1]:
            ends.append(len(steps))
    order = np.array(steps, np.intp)
    lengths = (last - first + 1)[order]
    begins = np.concatenate([[0], np.cumsum(lengths)])
    members = np.repeat(first[order] - begins[:-1], lengths) + np.arange(n)
    offsets = begins[ends]
    # Edges at places that several have, by their rings: only a ring that has two of one place is split.
    crowded = np.flatnonzero((np.bincount(places, minlength=1) > 1)[places[members]])
    ring = np.searchsorted(offsets, crowded, side="right") - 1
    pairs, counts = np.unique(ring * n + places[members[crowded]], return_counts=True)
    cuts = [offsets]
    for first, last in zip(*(offsets[np.unique(pairs[counts > 1] // max(n, 1)) + k] for k in (0, 1))):
        parts = _split(members[first:last], places)
        members[first:last] = np.concatenate(parts)
        cuts.append(first + np.cumsum([len(part) for part in parts[:-1]]))
    return members, np.sort(np.concatenate(cuts))


def are_outer(points: FloatArray, corners: npt.NDArray[Any], offsets: Places) -> npt.NDArray[np.bool_]:
    """Which rings turn counter-clockwise, exactly: the turns at their lexicographically smallest corners.

    corners: the points of all rings, none twice in a ring. offsets: where each ring begins.
    """
    starts, sizes = offsets[:-1], np.diff(offsets)
    if len(sizes) == 0:
        return np.empty(0, np.bool_)
    x, y = np.asarray(points[corners], np.float64).T
    y = np.where(x == np.repeat(np.minimum.reduceat(x, starts), sizes), y, np.inf)
    smallest = np.flatnonzero(y == np.repeat(np.minimum.reduceat(y, starts), sizes)) - starts
    turns = [corners[starts + (smallest + step) % sizes] for step in (-1, 0, 1)]
    outer: npt.NDArray[np.bool_] = _calls.turns(points, np.stack(turns, axis=1).astype(np.int32)) > 0
    return outer


def order_of_parts(outer: npt.NDArray[np.bool_], component: npt.NDArray[Any]) -> Places:
    """Rings by their components, in the order of the outer rings, each outer ring before its holes."""
    number = np.unique(component, return_inverse=True)[1]
    first = np.empty(len(outer), np.intp)
    first[number[outer]] = np.flatnonzero(outer)
    order: Places = np.lexsort((~outer, first[number]))
    return order
