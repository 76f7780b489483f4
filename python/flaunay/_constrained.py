"""Triangulations of points with segments that are edges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _triangulators
from flaunay._arrays import (
    ArrayLike,
    as_floats,
    as_int32,
    as_integers,
    as_offsets,
    as_points,
    geometries_of,
    number_of,
    summary,
)
from flaunay._border import Border, LineBorder, ends_opposite
from flaunay._declarations import CROSSINGS, FILL_RULE, OUTSIDE
from flaunay._errors import UsageError
from flaunay._export import ExportMethods
from flaunay._optional import optional
from flaunay._plot import ConstrainedArtists, draw_constrained
from flaunay._queries import KeptLocator, Queries
from flaunay._raster import MapMethods
from flaunay._refinement import RefinementReport, Refining, as_refinement, provable
from flaunay._triangulation import Triangulation

if TYPE_CHECKING:
    import matplotlib.axes
    import meshio

Indices = npt.NDArray[np.int32]
Doubles = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class ConstrainedTriangulation(Queries, ExportMethods, MapMethods, Triangulation):
    """Triangulations with segments as edges: `triangulate` makes them if there are segments.

    Every edge that is no constraint is locally Delaunay, and of cocircular points the triangles are
    always the same ones. Where triangles are left out, neighbors and halfedges are -1. The hull remains
    that of the points.

    Attributes
    ----------
    triangles, neighbors, halfedges, hull, representatives, triangle_offsets, hull_offsets, statistics
        As of `Triangulation`, for all of `points`.
    areas : ndarray of float64, shape (m,)
        The area of each triangle, the float64 next to the exact one.
    points : ndarray of float64, shape (n + a, 2)
        A copy of the points, and after them those that splitting and refinement added.
    added_offsets : ndarray of int64, shape (sets + 1,)
        Of the points that were added, set s has those from ``added_offsets[s]`` to ``added_offsets[s + 1]``.
    constraint_edges : ndarray of int32, shape (e, 2)
        The edges that segments are made of, each once, the lexicographically smaller point first. Edges
        that follow each other on a segment follow each other here.
    edge_segments : ndarray of int32, shape (e,)
        For each of these the smallest index of a segment that has it.
    piece_offsets : ndarray of int32, shape (k + 1,)
        Segment i has the pieces ``piece_offsets[i]`` to ``piece_offsets[i + 1]``, from its
        lexicographically smaller end to the other one. Without splitting, each segment is one piece.
    piece_edges : ndarray of int32, shape (pieces, 2)
        Each piece has the constraint edges from the first to the second number, the latter excluded. Both
        are 0 if its ends have equal coordinates.
    constrained : ndarray of bool, shape (m, 3)
        Whether the edge opposite to a corner is a constraint.
    depths : ndarray of int32, shape (m,), or None
        By `fill_rule`; None without ``labels=True``.
    regions : ndarray of int32, shape (m,), or None
        The region of each triangle: what is connected without crossing a constraint. They are numbered
        from 0 by their first triangles. None without ``labels=True``.
    edge_markers : ndarray of int32, shape (e,), or None
        The marker of each constraint edge: that of its segment in ``edge_segments``. None without
        `segment_markers`.
    vertex_markers : ndarray of int32, shape (n + a,), or None
        Those that were given, and for each point that was added that of the segment with the smallest index
        that has it, 0 if there is none. None without `point_markers`.
    triangle_attributes : ndarray of float64, shape (m,), or None
        The attribute of each triangle's region: of the last seed in it, and 0 where there is none. None
        without `seeds`.
    refinement : RefinementReport, or None
        How refinement went. None if nothing was asked for.

    Notes
    -----
    `find_simplex` finds the triangle of a point, which has its ``regions`` and its ``polygon_of``; -1 where there is
    no triangle, as in holes. `nearest` finds the nearest of all `points`, whatever is between. The interpolators take
    the triangulation in place of points, with a value for each of `points`, those that were added too. Linear
    interpolation is that in the triangles, and `CloughTocherInterpolator` is smooth across segments. The natural
    neighbours of a place are the points that it sees: weights are those in Seidel's extended Voronoi diagram (1988),
    so segments are creases, on which the result is linear between the ends of an edge. All of these need one set,
    such as a map of polygons. `Voronoi` needs a Delaunay triangulation.
    """

    areas: Doubles
    points: Doubles
    added_offsets: npt.NDArray[np.int64]
    constraint_edges: Indices
    edge_segments: Indices
    piece_offsets: Indices
    piece_edges: Indices
    constrained: npt.NDArray[np.bool_]
    depths: Optional[Indices]
    regions: Optional[Indices]
    edge_markers: Optional[Indices]
    vertex_markers: Optional[Indices]
    triangle_attributes: Optional[Doubles]
    refinement: Optional[RefinementReport]

    why_no_array = (
        "are needed, or a Delaunay triangulation of them, not one with constraints: "
        "its attribute `points` has them"
    )

    def __repr__(self) -> str:
        return summary(
            self,
            points=len(self.points),
            triangles=len(self.triangles),
            constraint_edges=len(self.constraint_edges),
            sets=len(self.hull_offsets) - 1,
        )

    def to_meshio(
        self,
        point_data: Optional[Mapping[str, npt.ArrayLike]] = None,
        cell_data: Optional[Mapping[str, npt.ArrayLike]] = None,
        z: Optional[npt.ArrayLike] = None,
    ) -> meshio.Mesh:
        """The triangulation as a mesh of meshio, with the constraint edges of triangles as lines.

        Their data are those of Gmsh: ``gmsh:physical`` is the marker of a line, and of a triangle its attribute, if
        all are whole numbers, or else its polygon or region, from 1 on; ``gmsh:geometrical`` are regions if there
        are labels. So ``write("mesh.msh", file_format="gmsh22")`` makes physical groups. ``"marker"`` has the
        markers of points, if there are any.

        Parameters
        ----------
        point_data, cell_data : mapping of str to array_like, optional
            What points and triangles have, one row for each. Lines have zeros, or NaN.
        z : array_like, shape (npoints,), optional
            Heights of the points, which then are three-dimensional.

        Returns
        -------
        meshio.Mesh
            With copies of the arrays, points in two dimensions, and a block of triangles and one of lines.

        Raises
        ------
        UsageError
            For data of another length.
        ImportError
            Without meshio.

        Examples
        --------
        >>> import flaunay
        >>> border = [[0, 1], [1, 2], [2, 0]]
        >>> mesh = flaunay.refine([[0, 0], [4, 0], [0, 4]], border, max_area=1, segment_markers=[7, 7, 8])
        >>> mesh.to_meshio().write("mesh.msh", file_format="gmsh22")  # doctest: +SKIP
        """
        own = {} if self.vertex_markers is None else {"marker": self.vertex_markers}
        surface = super().to_meshio({**own, **(point_data or {})}, cell_data, z)
        # Edges that were left out with their triangles are no lines.
        place = np.array([max(len(self.points), 1), 1])
        kept = self._edges_where(self.constrained) @ place
        is_line = np.isin(np.sort(self.constraint_edges, axis=1) @ place, kept)
        ones = np.ones(len(is_line), np.int32)
        markers = (ones if self.edge_markers is None else self.edge_markers)[is_line]
        groups = self._groups()

        def with_lines(values: npt.NDArray[Any]) -> list[npt.NDArray[Any]]:
            nothing = np.nan if np.issubdtype(values.dtype, np.inexact) else 0
            return [values, np.full((len(markers), *values.shape[1:]), nothing, values.dtype)]

        regions = groups if self.regions is None else self.regions
        data = {
            "gmsh:physical": [groups, markers],
            "gmsh:geometrical": [
                np.unique(numbers, return_inverse=True)[1].astype(np.int32) + 1
                for numbers in (regions, markers)
            ],
        }
        data.update((name, with_lines(given)) for name, (given,) in surface.cell_data.items())
        names = {f"marker {number}": np.array([number, 1]) for number in np.unique(markers)}
        names.update({f"part {number}": np.array([number, 2]) for number in np.unique(groups)})
        # Some writers take no empty blocks.
        blocks = [*surface.cells, ("line", self.constraint_edges[is_line])][: 1 + is_line.any()]
        mesh: meshio.Mesh = type(surface)(
            surface.points,
            blocks,
            point_data=surface.point_data,
            cell_data={name: of_blocks[: len(blocks)] for name, of_blocks in data.items()},
            field_data=names,
        )
        return mesh

    def _groups(self) -> Indices:
        """A number for what each triangle is a part of: an attribute, or a region from 1 on."""
        attributes = self.triangle_attributes
        if attributes is not None:
            limit = np.iinfo(np.int32).max
            if (np.rint(attributes).clip(-limit, limit) == attributes).all():
                return attributes.astype(np.int32)
        regions = np.zeros(len(self.triangles), np.int32) if self.regions is None else self.regions
        return regions + np.int32(1)

    def verify(self) -> None:
        """Checks exactly that this is what was asked for: the canonical triangulation with these constraints.

        Segments are edges or chains of edges, other edges are Delaunay, and just those triangles are there which were
        to be kept. Refined ones have no smaller angles and no larger areas than asked for, but those that
        `refinement` lists; areas by seeds, triangles and functions are not checked, nor is it which of several
        polygons a triangle of a map is given to.

        The check shares no predicate with what makes triangulations. O(n log n), on one thread.

        Raises
        ------
        InternalError
            If it is not; the message says what is wrong.
        """
        report = self.refinement
        _calls.verify_constrained(
            self.points,
            self._contiguous_arrays(),
            None
            if report is None
            else (report.added_points, np.ascontiguousarray(report.bad_triangles)),
            self.__dict__["_asked"],
        )

    @property
    def simplices(self) -> Indices:
        """The same as `triangles`, by the name that `Delaunay` has."""
        return self.triangles

    @property
    def added_points(self) -> Doubles:
        """The points that were added, float64, shape (a, 2): the last ones of `points`."""
        added: Doubles = self.points[len(self.points) - int(self.added_offsets[-1]) :]
        return added

    @cached_property
    def edges(self) -> Indices:
        """The edges of the triangles, each once, int32, shape (e, 2).

        In each row the smaller index first; the rows in increasing order. O(m log m) work.
        """
        return rows_of_edges(sorted_edges(self.triangles, self.neighbors))

    def _edges_where(self, chosen: npt.NDArray[np.bool_]) -> Indices:
        """The edges opposite to such corners, each once, sorted, in each the smaller index first."""
        return rows_of_edges(sorted_edges(self.triangles, self.neighbors, chosen))

    def edges_of(self, segment: int) -> Indices:
        """The edges of a segment, int32, shape (k, 2), from its lexicographically smaller end to the other one.

        Raises
        ------
        IndexError
            If there is no such segment.

        Examples
        --------
        >>> import flaunay
        >>> points = [[0, 0], [2, 0], [1, 0], [1, 1]]
        >>> flaunay.triangulate(points, segments=[[1, 0]]).edges_of(0)
        array([[0, 2],
               [2, 1]], dtype=int32)
        """
        segments = len(self.piece_offsets) - 1
        if not -segments <= segment < segments:
            raise IndexError(f"segment {segment} is none of the {segments} segments")
        first, last = self.piece_offsets[segment % segments + np.arange(2)]
        ranges = [np.arange(*piece) for piece in self.piece_edges[first:last]]
        places = np.concatenate([np.empty(0, np.intp), *ranges])
        edges: Indices = self.constraint_edges[places]
        return edges

    def plot(self, ax: Optional[matplotlib.axes.Axes] = None, **style: Any) -> ConstrainedArtists:
        """Draws the edges of the triangles, and constraints strongly.

        What was left out is not drawn, nor are constraints in it.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw. Without it, on the current axes, whose aspect becomes equal.
        **style
            Of the other edges, as `matplotlib.collections.LineCollection` takes it, such as ``color``.
            ``constraint_color`` and ``constraint_linewidth`` are those of the constraints.

        Returns
        -------
        edges, constraints : matplotlib.collections.LineCollection

        Raises
        ------
        ImportError
            Without Matplotlib.

        Examples
        --------
        >>> import flaunay, matplotlib
        >>> matplotlib.use("Agg")
        >>> square = flaunay.triangulate([[0, 0], [1, 0], [1, 1], [0, 1]], segments=[[1, 3]])
        >>> edges, constraints = square.plot(constraint_color="black")
        >>> len(edges.get_segments()), len(constraints.get_segments())
        (4, 1)
        """
        purpose = f"{type(self).__name__}.plot"
        edges, constraints = (self._edges_where(self.constrained == k) for k in (False, True))
        return draw_constrained(self.points, edges, constraints, ax, style, purpose)

    def to_shapely(self) -> npt.NDArray[Any]:
        """The triangles as geometries of Shapely, one collection for each set.

        Returns
        -------
        ndarray of shapely.GeometryCollection, shape (sets,)
            Of the triangles as polygons, as `shapely.constrained_delaunay_triangles` returns them.

        Raises
        ------
        ImportError
            Without Shapely 2.
        """
        sizes = np.diff(self.triangle_offsets)
        owners = np.repeat(np.arange(len(sizes)), sizes)
        return self._collections(self.triangles, owners, len(sizes))

    def _collections(
        self, triangles: Indices, owners: npt.NDArray[Any], count: int
    ) -> npt.NDArray[Any]:
        """Collections of triangles as polygons of Shapely. owners: that of each triangle, in increasing order."""
        shapely = optional("shapely", f"{type(self).__name__}.to_shapely")
        shapes = shapely.polygons(self.points[triangles[:, [0, 1, 2, 0]]])
        collections: npt.NDArray[Any] = np.full(count, shapely.GeometryCollection(), object)
        shapely.geometrycollections(shapes, indices=owners.astype(np.intp), out=collections)
        return collections

    @property
    def npoints(self) -> int:
        """The number of points, with those that were added."""
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        """The number of triangles."""
        return len(self.triangles)

    @cached_property
    def _kept_locator(self) -> KeptLocator:
        return KeptLocator()

    @property
    def _locator(self) -> _calls.Locator:
        return self._kept_locator.get(self._make_locator)

    def _check_sets(self) -> None:
        if len(self.hull_offsets) != 2:
            raise UsageError(
                "queries in a triangulation with constraints need one set; polygons are one with map=True"
            )

    def _make_tree(self) -> _calls.PointTree:
        self._check_sets()
        return super()._make_tree()

    def _make_locator(self) -> _calls.Locator:
        self._check_sets()
        return _calls.Locator(
            _triangulators.of_device(self.__dict__.get("_device")),
            _Searched(self.points, self.triangles, self._neighbors, self.hull, self.representatives),
            self.constrained,
        )

    @property
    def _neighbors(self) -> Indices:
        return neighbors_of(self.triangles) if self.neighbors is None else self.neighbors

    @cached_property
    def _border(self) -> Border:
        if self.nsimplex == 0 and self._is_flat:
            return LineBorder(self.points, self.hull)
        return Border(self.points, self.triangles, self._neighbors)

    @property
    def _is_flat(self) -> bool:
        """Whether all points are on one line, exactly."""
        inner = self.hull[1:-1, None]
        ends = np.broadcast_to(self.hull[[0, -1]] if len(self.hull) else inner, (len(inner), 2))
        return not _calls.turns(self.points, np.concatenate([ends, inner], axis=1)).any()

    def _near_hull(self, outside: Doubles, tol: float) -> Indices:
        raise UsageError("with constraints, find_simplex is exact: it takes no tol")


@dataclass(frozen=True)
class _Searched:
    """What a locator is made from."""

    points: Doubles
    simplices: Indices
    neighbors: Indices
    hull: Indices
    representatives: Indices

    @property
    def _stand_ins(self) -> tuple[Doubles, Indices]:
        return self.points, self.representatives


def edge_keys(first: Indices, second: Indices) -> npt.NDArray[np.int64]:
    """A number for each edge by its ends, whatever its direction; they sort as rows with the smaller end first."""
    keys: npt.NDArray[np.int64] = np.minimum(first, second).astype(np.int64) << 32
    keys |= np.maximum(first, second)
    return keys


def rows_of_edges(keys: npt.NDArray[np.int64]) -> Indices:
    """The ends of edges, the smaller one first."""
    rows = np.empty((len(keys), 2), np.int32)
    rows[:, 0], rows[:, 1] = keys >> 32, keys & 0xFFFFFFFF
    return rows


def sorted_edges(
    triangles: Indices,
    neighbors: Optional[Indices],
    chosen: Optional[npt.NDArray[np.bool_]] = None,
) -> npt.NDArray[np.int64]:
    """The keys of the edges opposite to all corners, or to chosen ones, each once, in increasing order."""
    if neighbors is None:
        corners = np.arange(triangles.size) if chosen is None else chosen.reshape(-1).nonzero()[0]
        return np.unique(edge_keys(*ends_opposite(triangles, corners)))
    # The second of an edge's two triangles has it.
    is_second = neighbors < np.arange(len(triangles), dtype=np.int32)[:, None]
    corners = (is_second if chosen is None else chosen & is_second).reshape(-1).nonzero()[0]
    keys = edge_keys(*ends_opposite(triangles, corners))
    keys.sort()
    return keys


def neighbors_of(triangles: Indices) -> Indices:
    """The triangle opposite to each corner, or -1."""
    corners = triangles.astype(np.int64)
    here, back = (np.roll(corners, -k, axis=1).ravel() for k in (1, 2))
    n = corners.max(initial=0) + 1
    keys, wanted = here * n + back, back * n + here
    order = np.argsort(keys)
    places = np.searchsorted(keys[order], wanted).clip(max=max(0, len(keys) - 1))
    found = order[places] if len(keys) else places
    beyond = np.where(keys[found] == wanted, found // 3, -1) if len(keys) else found
    return beyond.astype(np.int32).reshape(-1, 3)


def rules_of(crossings: str, outside: str, fill_rule: str, labels: bool) -> dict[str, int]:
    """The members of flaunay_constraints that are no arrays; UsageError for unknown names."""
    return {
        "crossings": number_of(CROSSINGS, crossings, "crossings"),
        "outside": number_of(OUTSIDE, outside, "outside"),
        "fill_rule": number_of(FILL_RULE, fill_rule, "fill_rule"),
        "labels": int(bool(labels)),
    }


def with_lines(points: ArrayLike, segments: npt.ArrayLike) -> tuple[ArrayLike, npt.ArrayLike]:
    """Lines and polygons of Shapely as segments between their corners, which become points after the others."""
    geometries = geometries_of(segments, "segments")
    if geometries is None:
        return points, segments
    shapely = optional("shapely", "segments")
    types = shapely.get_type_id(geometries)
    # 1: LineString; 2: LinearRing; 3: Polygon; 5: MultiLineString; 6: MultiPolygon
    wrong = np.flatnonzero(~np.isin(types, (-1, 1, 2, 3, 5, 6)))
    if len(wrong):
        kind = geometries[int(wrong[0])].geom_type
        raise UsageError(f"segments[{wrong[0]}] is a {kind}: lines and polygons have segments")
    parts = shapely.get_parts(geometries[types >= 0])
    is_polygon = shapely.get_type_id(parts) == 3
    lines = np.concatenate([parts[~is_polygon], shapely.get_rings(parts[is_polygon])])
    corners, line = shapely.get_coordinates(lines, return_index=True)
    given = np.asarray(as_points(points), np.float64)
    firsts = np.flatnonzero(line[:-1] == line[1:]) + len(given)
    return np.concatenate([given, corners]), np.stack([firsts, firsts + 1], axis=1)


def as_segments(given: npt.ArrayLike, n: int) -> Indices:
    """Pairs of indices of n points; UsageError for what is none."""
    segments = as_integers(given, "segments")
    if segments.size == 0:
        return np.empty((0, 2), np.int32)
    if segments.ndim != 2 or segments.shape[1] != 2:
        hint = "; offsets of sets are given as offsets" if segments.ndim == 1 else ""
        raise UsageError(f"segments must have the shape (k, 2), not {segments.shape}{hint}")
    # As unsigned numbers, negative ones are the largest.
    if int(segments.astype(np.uint64).max()) >= n:
        row, column = np.argwhere((segments < 0) | (segments >= n))[0].tolist()
        index = segments[row, column]
        raise UsageError(f"segments[{row}, {column}] = {index} is none of the {n} points")
    return np.ascontiguousarray(segments, np.int32)


_NOWHERE = np.empty((0, 3))


def _as_places(given: Optional[npt.ArrayLike], name: str, columns: int) -> Doubles:
    """Rows of x, y and perhaps more."""
    places = _NOWHERE if given is None else np.asarray(as_floats(given, name), float)
    if places.size == 0:
        return _NOWHERE[:, :columns]
    if places.ndim != 2 or places.shape[1] != columns:
        raise UsageError(f"{name} must have the shape ({name[0]}, {columns}), not {places.shape}")
    return places


def _as_markers(given: npt.ArrayLike, name: str, count: int) -> Indices:
    """One int32 each of so many things."""
    markers = as_integers(given, name)
    if markers.shape != (count,):
        raise UsageError(f"{name} must have the shape ({count},), not {markers.shape}")
    return as_int32(markers, name)


def with_points(made: _calls.Made, given: Doubles) -> _calls.Made:
    """What the library has made, with all points: a copy, which does not change with those that were given."""
    added = made["added_points"]
    made["points"] = np.concatenate([given, added]) if len(added) else given.copy()
    return made


def arrays_of_constrained(
    points: ArrayLike,
    segments: npt.ArrayLike,
    offsets: Optional[npt.NDArray[np.int64]],
    given: dict[str, Any],
    rules: dict[str, int],
    refining: Refining,
    wanted: set[str],
    device: Optional[str],
) -> tuple[_calls.Made, dict[str, Any]]:
    """What a `ConstrainedTriangulation` consists of, by its names, and what is asked for, for `verify`.

    given: the arguments of `triangulate` that are holes, markers and seeds. wanted: the optional arrays to compute.
    """
    points, segments = with_lines(points, segments)
    coordinates = np.asarray(as_points(points), np.float64)
    pairs = as_segments(segments, len(coordinates))
    seeds = _as_places(given.get("seeds"), "seeds", 3)
    places: dict[str, tuple[Doubles, Optional[npt.NDArray[np.int64]]]] = {}
    for name, rows in ("hole", _as_places(given.get("holes"), "holes", 2)), ("seed", seeds[:, :2]):
        of_sets = given.get(f"{name}_offsets")
        if of_sets is not None:
            places[name] = rows, as_offsets(of_sets, f"{name}_offsets")
        elif len(rows):
            if offsets is not None and len(offsets) != 2:
                raise UsageError(f"{name}s of several sets need {name}_offsets")
            places[name] = rows, None
    carried: dict[str, npt.NDArray[Any]] = {}
    for name, count in ("segment_markers", len(pairs)), ("point_markers", len(coordinates)):
        if given.get(name) is not None:
            carried[name] = _as_markers(given[name], name, count)
    if len(seeds):
        carried["seed_attributes"] = np.ascontiguousarray(seeds[:, 2])
    refinement = as_refinement(refining, len(pairs), len(seeds))
    triangulator = _triangulators.of_device(device, "areas_at" in refinement)
    made = _calls.triangulate_constrained(
        *(triangulator, coordinates, offsets, pairs, places, carried),
        *(rules, refinement, wanted),
    )
    holes, hole_offsets = places.get("hole", (None, None))
    asked: dict[str, Any] = {
        **rules,
        "points": len(coordinates),
        "offsets": None if offsets is None else offsets.copy(),
        "segments": pairs.copy(),
        "segment_count": len(pairs),
        "refinement": provable(refinement),
    }
    if holes is not None:
        asked |= {"holes": holes.copy(), "hole_count": len(holes)}
    if hole_offsets is not None:
        asked["hole_offsets"] = hole_offsets.copy()
    return with_points(made, coordinates), asked
