"""From measured heights to maps: laser scans and other points to rasters, contours and pictures."""

from __future__ import annotations

import contextlib
import csv
import math
import os
import re
import struct
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from flaunay import _calls, _declarations, _raster
from flaunay._arrays import as_floats, geometries_of, summary
from flaunay._chunks import all_or_none, chunks_of, is_one_file
from flaunay._delaunay import Delaunay
from flaunay._errors import Error, InputError, UsageError
from flaunay._interpolate import (
    CloughTocherInterpolator,
    LinearInterpolator,
    NaturalNeighborInterpolator,
    NearestInterpolator,
)
from flaunay._optional import optional
from flaunay._raster import Contours
from flaunay._triangulate import triangulate

Doubles = npt.NDArray[np.float64]
_Paths = Union[str, "os.PathLike[str]"]

_PURPOSE = "flaunay.terrain"
_LAS = {".las", ".laz"}
_TEXT = {".txt", ".xyz", ".csv"}
_SUFFIXES = sorted(_LAS | _TEXT | {".npy"})
_LAYERS = {".gpkg", ".shp", ".fgb", ".parquet", ".geojson", ".json"}
_RASTERS = {".tif": "COG", ".tiff": "COG", ".png": "PNG"}
_LINES = {".geojson": "GeoJSON", ".gpkg": "GPKG", ".fgb": "FlatGeobuf"}
_MESHES = (".ply", ".obj", ".stl", ".vtk", ".vtu")
_METHODS: dict[str, Any] = {
    "linear": None,
    "natural": NaturalNeighborInterpolator,
    "clough-tocher": CloughTocherInterpolator,
}
# Pixels that are interpolated at a time, by other methods than the linear one.
_PIXELS_AT_ONCE = 1 << 20
# Points that are read at a time.
_POINTS_AT_ONCE = 1 << 20
# Classes of noise in .las files, which are left out unless they are asked for.
_NOISE = (7, 18)
# 32 GiB as float64.
_MOST_PIXELS = 1 << 32
# GeoTIFF in .las files: the keys that have the numbers of EPSG, of projected and of other systems.
_EPSG_KEYS = (3072, 2048)


def _check_one_of(given: Optional[str], known: Sequence[Optional[str]], name: str) -> None:
    if given not in known:
        raise UsageError(f"{name} must be one of {', '.join(map(repr, known))}, not {given!r}")


# ---- Points


class _Las:
    """A .las or .laz file. What its header says is checked before points are read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.left_out: Counter[str] = Counter()
        laspy = optional("laspy", _PURPOSE)
        try:
            with laspy.open(path) as file:
                self.header = file.header
        except Exception as error:
            raise InputError(f"{path}: {error}") from error
        header = self.header
        needed = header.offset_to_point_data + header.point_count * header.point_format.size
        if path.suffix.lower() == ".las" and path.stat().st_size < needed:
            raise InputError(
                f"{path} is truncated: its {header.point_count} points end at byte {needed}, "
                f"but the file has {path.stat().st_size}"
            )
        self.box: Optional[Doubles] = None
        if header.point_count:
            self.box = np.array([*header.mins[:2], *header.maxs[:2]], np.float64)

    @property
    def crs(self) -> Any:
        """That of rasterio, or None."""
        crs = optional("rasterio.crs", _PURPOSE).CRS
        records = {record.record_id: record for record in self.header.vlrs}
        if 2112 in records:
            text = records[2112].record_data_bytes().decode("utf-8", "replace").rstrip("\0")
            return crs.from_wkt(text) if text else None
        if 34735 in records:
            keys = np.frombuffer(records[34735].record_data_bytes(), np.uint16)[4:].reshape(-1, 4)
            for wanted in _EPSG_KEYS:
                found = keys[(keys[:, 0] == wanted) & (keys[:, 1] == 0), 3]
                if found.size and 0 < found[0] < 32767:
                    return crs.from_epsg(int(found[0]))
        return None

    def pieces(
        self, classes: Optional[frozenset[int]], returns: Optional[str]
    ) -> Iterator[Doubles]:
        laspy = optional("laspy", _PURPOSE)
        count = 0
        try:
            with laspy.open(self.path) as file:
                for points in file.chunk_iterator(_POINTS_AT_ONCE):
                    count += len(points)
                    yield self._chosen(points, classes, returns)
        except Exception as error:
            raise InputError(f"{self.path}: {error}") from error
        if count != self.header.point_count:
            raise InputError(
                f"{self.path} is truncated: it has {count} of {self.header.point_count} points"
            )

    def _chosen(
        self, points: Any, classes: Optional[frozenset[int]], returns: Optional[str]
    ) -> Doubles:
        chosen = ~np.asarray(points.withheld, bool)
        self.left_out["withheld"] += len(points) - int(chosen.sum())
        of = np.asarray(points.classification)
        if classes is None:
            noise = chosen & np.isin(of, _NOISE)
            self.left_out["noise"] += int(noise.sum())
            chosen &= ~noise
        else:
            chosen &= np.isin(of, list(classes))
        if returns == "first":
            chosen &= np.asarray(points.return_number) == 1
        elif returns == "last":
            chosen &= np.asarray(points.return_number) == np.asarray(points.number_of_returns)
        columns = [
            _decimal(np.asarray(points.array[name][chosen]), scale, offset)
            for name, scale, offset in zip("XYZ", self.header.scales, self.header.offsets)
        ]
        return np.stack(columns, axis=1)


def _decimal(integers: npt.NDArray[Any], scale: float, offset: float) -> Doubles:
    """Scaled integers, the next double to each decimal number where scale and offset are decimal.

    Then equal places are equal in files of other offsets, too.
    """
    whole = round(1 / scale) if scale > 0 else 0
    first = round(offset * whole)
    if whole and 1 / whole == scale and first / whole == offset and abs(first) < 1 << 62:
        numbers = integers.astype(np.int64) + first
        if not numbers.size or np.abs(numbers).max() < 1 << 53:
            return np.asarray(numbers / whole, np.float64)
    return np.asarray(integers * scale + offset, np.float64)


def _is_header(fields: list[str]) -> bool:
    """Whether fields are names: some have letters, and none looks like a number, even a mistyped one."""

    def is_number(field: str) -> bool:
        try:
            float(field)
        except ValueError:
            mistyped = re.fullmatch(r"[-+.0-9eEoO]*[0-9oO][-+.0-9eEoO]*", field)
            return bool(mistyped or re.match(r"[\W_]*[0-9]", field))
        return True

    letters = any(re.search(r"[^\W\d_]", field) for field in fields)
    return letters and not any(map(is_number, fields))


def _text_rows(path: Path, columns: Optional[Sequence[Union[str, int]]]) -> Any:
    """Three numbers of each line, separated by semicolons, commas or white space, as the command reads them."""

    def fields_of(line: str) -> tuple[Optional[str], list[str]]:
        bare = re.sub('"[^"]*"', "", line)
        separator = ";" if ";" in bare else "," if "," in bare else None
        split = next(csv.reader([line], delimiter=separator)) if separator else line.split()
        return separator, [field.strip(' "') for field in split]

    with open(path, encoding="utf-8-sig") as file:
        contents = ((k, text.split("#")[0].strip()) for k, text in enumerate(file))
        rows = ((k, text) for k, text in contents if text)
        first, line = next(rows, (0, ""))
        separator, fields = fields_of(line)
        names = fields if _is_header(fields) else []
        if names:
            first, line = next(rows, (first + 1, ""))
            separator, fields = fields_of(line)
        if not line:
            return np.empty((0, 3))
        places = _places_of(columns, names, len(fields))
        if separator == ";":
            file.seek(0)
            body = (text.split("#")[0] for _, text in zip(range(1 << 62), file))
            found = [
                [row[place] for place in places]
                for k, row in enumerate(csv.reader(body, delimiter=";"))
                if k >= first and any(map(str.strip, row))
            ]
            marks = "".join(map("".join, found))
            if "," in marks and "." in marks:
                raise ValueError("has numbers with decimal commas and others with decimal points")
            return np.array([[float(text.replace(",", ".")) for text in row] for row in found])
    try:
        return np.loadtxt(
            path,
            delimiter=separator,
            skiprows=first,
            usecols=places,
            ndmin=2,
            encoding="utf-8-sig",
            quotechar='"',
        )
    except ValueError as error:
        if separator == "," and re.search(r"[^\s,]\s+[^\s,]", line):
            hint = "; lines have commas and white space: if the commas are decimal ones, separate columns by semicolons"
            raise ValueError(f"{error}{hint}") from error
        raise


def _places_of(
    columns: Optional[Sequence[Union[str, int]]], names: list[str], count: int
) -> list[int]:
    """Which columns have x, y and z."""
    if columns is None:
        if count < 3:
            raise ValueError(f"expected three numbers per line (x, y and z), found {count}")
        return [0, 1, 2]
    if isinstance(columns, str) or len(columns) != 3:
        raise UsageError(f"columns must be three names or numbers, not {columns!r}")
    places = []
    for column in columns:
        place = names.index(column) if isinstance(column, str) and column in names else column
        if isinstance(place, (str, bool, float)) or not 0 <= place < count:
            raise ValueError(f"there is no column {column!r} among {names or count}")
        places.append(place)
    return places


class _Table:
    """Points as text, .npy or an array."""

    crs = None

    def __init__(
        self, given: Any, name: str, columns: Optional[Sequence[Union[str, int]]] = None
    ) -> None:
        self.path = given if isinstance(given, Path) else None
        self.left_out: Counter[str] = Counter()
        self._places = [0, 1, 2]
        if columns is not None and self.path is None:
            raise UsageError(f"{name}: columns= are those of files")
        if self.path is not None:
            given = self._of_file(self.path, columns)
        self._points = as_floats(given, name)
        if self._points.ndim != 2 or (columns is None and self._points.shape[1] != 3):
            raise UsageError(f"{name} must be x, y and z of points, not {self._points.shape}")
        self.box: Optional[Doubles] = None
        if len(self._points):
            x, y = (self._points[:, place] for place in self._places[:2])
            self.box = np.array([x.min(), y.min(), x.max(), y.max()], np.float64)

    def _of_file(self, path: Path, columns: Optional[Sequence[Union[str, int]]]) -> Any:
        try:
            if path.suffix.lower() != ".npy":
                return _text_rows(path, columns)
            array = np.load(path, mmap_mode="r")
            if columns is not None:
                self._places = _places_of(columns, [], array.shape[-1])
            return array
        except UsageError:
            raise
        except (OSError, ValueError, IndexError) as error:
            raise InputError(f"{path}: {error}") from error

    def pieces(
        self, classes: Optional[frozenset[int]], returns: Optional[str]
    ) -> Iterator[Doubles]:
        if classes is not None or returns is not None:
            raise UsageError("classes and returns are those of .las and .laz files alone")
        for first in range(0, len(self._points), _POINTS_AT_ONCE):
            some = self._points[first : first + _POINTS_AT_ONCE]
            places = slice(3) if self._places == [0, 1, 2] else self._places
            yield np.asarray(some[:, places], np.float64)


class _Layer(_Table):
    """The positions of points and lines, with their heights or those of a field."""

    def __init__(self, given: Any, fields: Sequence[str]) -> None:
        shapely = optional("shapely", _PURPOSE)
        geometries, crs, self.has_field = _features(given, "points", fields)
        name = given if isinstance(given, (str, os.PathLike)) else "points"
        # Points, lines and rings, alone or several.
        if not np.isin(shapely.get_type_id(shapely.get_parts(geometries)), (0, 1, 2)).all():
            raise InputError(
                f"{name}: expected points or lines with heights; flat= and boundary= are for polygons"
            )
        points = shapely.get_coordinates(geometries, include_z=True)
        for i in np.flatnonzero(np.isnan(points[:, 2]))[:1]:
            x, y, _ = points[i]
            hint = "; height= says which field has it"
            if fields:
                hint = "" if self.has_field else f", nor is there a field {' or '.join(fields)}"
            raise InputError(f"{name}: position {i}, ({x}, {y}), has no height{hint}")
        super().__init__(points, "points")
        if crs is not None:
            self.crs = optional("rasterio.crs", _PURPOSE).CRS.from_user_input(crs)
        if name is given:
            self.path = _layer_in(given)[0]


def _layer_in(path: _Paths) -> tuple[Path, Optional[str]]:
    """The file, and which of its layers is meant: project.gpkg:lakes."""
    found = re.fullmatch(r"(.*\.\w+):([^/\\]+)", os.fspath(path))
    is_layer = found and Path(found[1]).suffix.lower() in _LAYERS
    return (Path(found[1]), found[2]) if found and is_layer else (Path(path), None)


def _sources(
    given: Any, columns: Optional[Sequence[Union[str, int]]], fields: Sequence[str]
) -> list[Any]:
    if not isinstance(given, (str, os.PathLike)):
        if isinstance(given, (list, tuple)) and all(
            isinstance(p, (str, os.PathLike)) for p in given
        ):
            return [one for path in given for one in _sources(path, columns, fields)]
        if columns is None and geometries_of(given, "points") is not None:
            return [_Layer(given, fields)]
        return [_Table(given, "points", columns)]
    path, _ = _layer_in(given)
    if path.is_dir():
        files = sorted(p for p in path.iterdir() if p.suffix.lower() in _SUFFIXES)
        if not files:
            raise InputError(f"{path} has no files that end with {', '.join(_SUFFIXES)}")
        return [one for file in files for one in _sources(file, columns, fields)]
    if not path.exists():
        raise InputError(f"{path} does not exist")
    suffix = path.suffix.lower()
    if suffix in _LAS | _LAYERS and columns is not None:
        known = ", ".join(sorted(_TEXT | {".npy"}))
        raise UsageError(f"{path}: columns= are those of {known}")
    if suffix in _LAYERS:
        return [_Layer(given, fields)]
    if suffix in _LAS:
        return [_Las(path)]
    if suffix in _TEXT or suffix == ".npy":
        return [_Table(path, str(path), columns)]
    raise UsageError(f"{path} must end with {', '.join([*_SUFFIXES, *sorted(_LAYERS)])}")


def _common_crs(sources: Iterable[Any], given: Any) -> Any:
    """The system of the sources' coordinates, or the one that is given in its place."""
    if given is not None:
        return optional("rasterio.crs", _PURPOSE).CRS.from_user_input(given)
    found: Any = None
    first: Any = None
    for source in sources:
        crs = source.crs
        if crs is None:
            continue
        if found is not None and crs != found:
            raise InputError(
                f"{first.path} and {source.path} have different coordinate systems, {found} and {crs}: "
                "reproject one of them, or say by crs= what both have"
            )
        found, first = crs, source
    return found


def _names(given: Union[None, str, Sequence[str]]) -> Sequence[str]:
    return [given] if isinstance(given, str) else given or ()


def _merge_heights(
    heights: Doubles, representatives: npt.NDArray[np.int32], fixed: int, duplicates: str
) -> None:
    """Gives the representative of equal points their common height, unless it is one of the first, fixed ones."""
    others = np.flatnonzero(representatives != np.arange(len(heights)))
    others = others[(others >= fixed) & (representatives[others] >= fixed)]
    of = representatives[others]
    if duplicates == "highest":
        np.maximum.at(heights, of, heights[others])
    elif duplicates == "lowest":
        np.minimum.at(heights, of, heights[others])
    else:
        # Summed in the order of heights, so that the order of points does not matter.
        first = np.unique(of)
        all_of, owner = np.concatenate([first, others]), np.concatenate([first, of])
        order = np.lexsort((heights[all_of], owner))
        # Not by add.reduceat, which sums in pairs: as flaunay terrain does, one after the other.
        of_first = np.searchsorted(first, owner[order])
        sums = np.bincount(of_first, weights=heights[all_of][order])
        heights[first] = sums / np.bincount(of_first)


# ---- Breaklines and boundaries


def _features(given: Any, name: str, fields: Sequence[str]) -> tuple[Any, Any, bool]:
    """Shapely's geometries of a layer, a table or a list, their coordinate system, and whether they have a field.

    Of fields, the first one that they have has the heights.
    """
    shapely = optional("shapely", _PURPOSE)
    if isinstance(given, (str, os.PathLike)):
        pyogrio = optional("pyogrio.raw", _PURPOSE)
        file, layer = _layer_in(given)
        files = optional("pyogrio", _PURPOSE)
        try:
            layers = [str(one) for one, kind in files.list_layers(file) if kind is not None]
            if layer is None and len(layers) > 1:
                raise ValueError(
                    f"has the layers {', '.join(layers)}: add the name of one to the path, as in {file}:{layers[0]}"
                )
            layer = layers[0] if layer is None and layers else layer
            info = files.read_info(file, layer=layer)
            found = [field for field in fields if field in info["fields"]][:1]
            meta, _, wkb, columns = pyogrio.read(file, layer=layer, columns=found)
        except Exception as error:
            raise InputError(f"{name}: {given}: {error}") from error
        geometries, crs = shapely.from_wkb(wkb), meta["crs"]
        # GeoJSON that names no system only seems to have longitudes and latitudes.
        is_default = file.suffix.lower() in (".geojson", ".json") and crs == "EPSG:4326"
        if is_default and len(geometries) and (np.abs(shapely.total_bounds(geometries)) > 360).any():
            crs = None
    else:
        crs, of = getattr(given, "crs", None), given
        if isinstance(given, (list, tuple)) or geometries_of(given, name) is None:
            try:
                of = [
                    g if g is None or hasattr(g, "__geo_interface__") else shapely.LineString(g)
                    for g in given
                ]
            except (TypeError, ValueError) as error:
                what = "a path, geometries or a list of arrays of shape (k, 2) or (k, 3)"
                raise UsageError(f"{name} must be {what}: {error}") from error
        geometries = geometries_of(of, name) if not isinstance(of, list) or of else []
        found = [field for field in fields if field in getattr(given, "columns", ())][:1]
        columns = [given[field] for field in found]
    geometries = np.array(geometries, object)
    for field, column in zip(found, columns):
        try:
            heights = np.asarray(as_floats(column, field), np.float64)
        except UsageError as error:
            raise InputError(f"{name}: the field {field!r} is no number") from error
        # Where there is no height, there is no z.
        known = ~np.isnan(heights)
        geometries = shapely.force_2d(geometries)
        geometries[known] = shapely.force_3d(geometries[known], heights[known])
    return geometries[~shapely.is_missing(geometries)], crs, bool(found)


def _geometries(
    given: Any, system: Any, name: str, fields: Sequence[str] = ()
) -> tuple[list[Any], bool]:
    """Those of `_features`, which must have the system of the points."""
    geometries, crs, has_field = _features(given, name, fields)
    if system is not None and crs is not None:
        own = optional("rasterio.crs", _PURPOSE).CRS.from_user_input(crs)
        if own != system:
            which = given if isinstance(given, (str, os.PathLike)) else "the table"
            raise InputError(f"{name}: {which} has the coordinate system {own}, not {system}")
    return list(geometries), has_field


def _check_place(name: str, geometries: Sequence[Any], points: Doubles) -> None:
    """Raises for geometries that lie where no points are, or so far away that no terrain reaches them."""
    shapely = optional("shapely", _PURPOSE)
    box = shapely.total_bounds(geometries) if len(geometries) else np.array([np.nan])
    if np.isnan(box).any():
        return
    if not (np.abs(box) < 2.0**509).all():
        raise InputError(f"{name} reaches to {box.tolist()}; expected coordinates below 2^509")
    low, high = points.min(axis=0), points.max(axis=0)
    if (box[:2] > high).any() or (box[2:] < low).any():
        raise InputError(
            f"{name} reaches from {tuple(box[:2].tolist())} to {tuple(box[2:].tolist())}, but the points from "
            f"{tuple(low.tolist())} to {tuple(high.tolist())}: both must have the same coordinate system"
        )


def _lines_of(geometries: Iterable[Any]) -> Iterator[Doubles]:
    """The lines and rings of geometries, shape (k, 3); z is NaN where they have none."""
    shapely = optional("shapely", _PURPOSE)
    for geometry in geometries:
        for part in shapely.get_parts(geometry):
            rings = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
            for line in rings:
                if line.geom_type not in ("LineString", "LinearRing"):
                    raise UsageError(f"breaklines must be lines or polygons, not {line.geom_type}")
                yield shapely.get_coordinates(line, include_z=True)


def _polygons_of(geometries: Iterable[Any]) -> list[Any]:
    shapely = optional("shapely", _PURPOSE)
    parts = [part for geometry in geometries for part in shapely.get_parts(geometry)]
    for part in parts:
        if part.geom_type != "Polygon":
            raise UsageError(f"flat must be polygons, not {part.geom_type}")
    return parts


# ---- Results


def _levels_of(heights: Union[float, npt.ArrayLike], low: float, high: float) -> Doubles:
    """Heights of contours: those given, or all multiples of one number between two heights."""
    levels = np.asarray(as_floats(heights, "heights"), np.float64)
    if levels.ndim > 0:
        return np.unique(levels)
    step = _raster.as_length(float(levels), "the interval of contours")
    if (high - low) / step > 1e6:
        raise UsageError(f"contours every {step} between {low} and {high} are more than a million")
    return np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step


class Terrain:
    """Measured heights, their triangulation and a raster of them. `terrain` makes it.

    Attributes
    ----------
    mesh : Delaunay, ConstrainedTriangulation or None
        The triangulation; with breaklines, these are edges of it. None with ``memory=``.
    heights : ndarray of float64, shape (n,)
        The height of each of ``mesh.points``; of none with ``memory=``.
    raster : ndarray of float64, shape (rows, columns)
        Heights, the north at the top; NaN where there are none.
    bounds : tuple of float
        What the pixels cover: xmin, ymin, xmax, ymax.
    resolution : float
        The size of a pixel.
    crs : rasterio.crs.CRS or None
        The system of the coordinates, if it is known.
    left_out : dict
        How many points of scans were left out: ``withheld`` ones, and those of ``noise``.
    """

    def __init__(self, mesh: Any, heights: Doubles, grid: _Grid, crs: Any, boundary: Any) -> None:
        self.mesh = mesh
        self.heights = heights
        self.crs = crs
        self.resolution: float = grid.resolution
        self.bounds: tuple[float, ...] = grid.bounds
        self._grid = grid
        self._boundary = boundary
        self._max_edge: Optional[float] = None
        self.left_out: dict[str, int] = {"withheld": 0, "noise": 0}
        self.raster: Doubles = np.empty((grid.rows, grid.columns))

    def __repr__(self) -> str:
        rows, columns = self.raster.shape
        return summary(self, points=len(self.heights), rows=rows, columns=columns)

    def contours(self, heights: Union[float, npt.ArrayLike]) -> Contours:
        """Contour lines at heights, or at all multiples of one number; see `Delaunay.contours`."""
        if self.mesh is None:
            raise UsageError("with memory=, contours are those of contours= and output alone")
        finite = self.heights[np.isfinite(self.heights)]
        low, high = (finite.min(), finite.max()) if finite.size else (0.0, -1.0)
        levels = _levels_of(heights, low, high)
        lines = self.mesh.contours(self.heights, levels, max_edge=self._max_edge)
        return lines if self._boundary is None else self._clipped(lines)

    def hillshade(
        self, *, vertical_factor: float = 1, colors: bool = False
    ) -> npt.NDArray[np.uint8]:
        """A picture of the raster, lit from the north-west: red, green, blue and alpha, for ``imshow``.

        Parameters
        ----------
        vertical_factor, colors
            As of `terrain`.

        Returns
        -------
        ndarray of uint8, shape (rows, columns, 4)
            Transparent where, or beside which, there is no height. The ``extent`` of ``imshow`` is (xmin, xmax, ymin,
            ymax) of `bounds`.

        Examples
        --------
        >>> import flaunay
        >>> points = [[0, 0, 0], [4, 0, 4], [0, 4, 0], [4, 4, 4]]
        >>> flaunay.terrain(points, resolution=2).hillshade()[0, 0].tolist()
        [217, 217, 217, 255]
        """
        bands = self._shaded(vertical_factor, colors)
        return np.moveaxis(bands if colors else bands[[0, 0, 0, 1]], 0, -1)

    def _shaded(self, vertical_factor: float, colors: bool) -> npt.NDArray[np.uint8]:
        """The bands of a picture."""
        return _calls.shade_hills(
            self._grid.steps,
            self.raster,
            vertical_factor=_raster.as_length(vertical_factor, "vertical_factor"),
            is_geographic=self.crs is not None and self.crs.is_geographic,
            colors=bool(colors),
        )

    def _clipped(self, lines: Contours) -> Contours:
        shapely = optional("shapely", _PURPOSE)
        if not len(lines):
            return lines
        of_line = np.repeat(np.arange(len(lines)), np.diff(lines.offsets))
        made = shapely.intersection(
            shapely.linestrings(lines.points, indices=of_line), self._boundary
        )
        parts, of = shapely.get_parts(made, return_index=True)
        is_line = shapely.get_type_id(parts) == 1
        parts, of = parts[is_line], of[is_line]
        points, of_part = shapely.get_coordinates(parts, return_index=True)
        offsets = np.searchsorted(of_part, np.arange(len(parts) + 1))
        return Contours(points, offsets.astype(np.int64), lines.heights[of])

    # Files

    def _write_raster(
        self, path: str, driver: str, nodata: float, shading: tuple[float, bool]
    ) -> None:
        rasterio = optional("rasterio", _PURPOSE)
        grid = self._grid
        transform = rasterio.transform.from_origin(
            grid.bounds[0], grid.bounds[3], grid.resolution, grid.resolution
        )
        common = {
            **{"driver": driver, "height": grid.rows, "width": grid.columns},
            **{"transform": transform, "crs": self.crs},
        }
        if driver == "PNG":
            picture = self._shaded(*shading)
            with rasterio.open(path, "w", count=len(picture), dtype="uint8", **common) as file:
                file.write(picture)
            return
        with rasterio.open(
            path,
            "w",
            count=1,
            dtype="float32",
            nodata=nodata,
            compress="DEFLATE",
            predictor="YES",
            **common,
        ) as file:
            file.update_tags(AREA_OR_POINT="Point" if grid.is_point else "Area")
            file.write(np.where(np.isnan(self.raster), nodata, self.raster).astype(np.float32), 1)

    def _write_mesh(self, path: str) -> None:
        corners, points = self.mesh.simplices, self.mesh.points
        if self._max_edge is not None:
            edges = points[np.roll(corners, -1, axis=1)] - points[corners]
            corners = corners[((edges**2).sum(axis=2) <= self._max_edge**2).all(axis=1)]
        surface = np.column_stack([points, self.heights])
        optional("meshio", _PURPOSE).Mesh(surface, [("triangle", corners)]).write(path)

    def _write_lines(self, path: str, driver: str, lines: Contours) -> None:
        pyogrio = optional("pyogrio.raw", _PURPOSE)
        geometries = np.array(
            [
                struct.pack("<BII", 1, 2, len(line)) + line.astype("<f8").tobytes()
                for _, line in lines
            ],
            object,
        )
        with warnings.catch_warnings():
            # Points without a coordinate system give contours without one.
            warnings.filterwarnings("ignore", "'crs' was not provided")
            pyogrio.write(
                path,
                geometries,
                [np.asarray(lines.heights)],
                np.array(["height"], object),
                geometry_type="LineString",
                driver=driver,
                crs=None if self.crs is None else self.crs.to_wkt(),
                layer="contours",
            )


class _Grid:
    """Pixels of one size: their corners, or with is_point their centres, are multiples of it."""

    def __init__(self, box: Doubles, resolution: float, is_point: bool) -> None:
        if not (resolution > 0 and math.isfinite(resolution)):
            raise UsageError(f"resolution must be positive, not {resolution}")
        if not np.isfinite(box).all() or not (box[0] <= box[2] and box[1] <= box[3]):
            raise UsageError(
                f"bounds must be finite, xmin <= xmax and ymin <= ymax, not {box.tolist()}"
            )
        low, high = np.floor(box[:2] / resolution), np.ceil(box[2:] / resolution)
        columns, rows = np.maximum(high - low, 1) + is_point
        if rows * columns > _MOST_PIXELS:
            raise UsageError(
                f"resolution {resolution:g} makes {columns:,.0f} x {rows:,.0f} pixels of "
                f"{box[2] - box[0]:g} x {box[3] - box[1]:g}; at most {_MOST_PIXELS:,} are possible"
            )
        self.resolution: float = resolution
        self.is_point: bool = is_point
        self.rows: int = int(rows)
        self.columns: int = int(columns)
        half = 0.5 * is_point
        x0, y0 = float(low[0]) - half, float(low[1]) - half
        self.bounds: tuple[float, ...] = tuple(
            float(edge) * resolution for edge in (x0, y0, x0 + self.columns, y0 + self.rows)
        )
        # The centre of the first pixel, and the steps to the next ones.
        self.steps: tuple[float, float, float, float] = (
            (x0 + 0.5) * resolution,
            (y0 + self.rows - 0.5) * resolution,
            resolution,
            -resolution,
        )


def _checked_outputs(given: Any, contours: Any) -> list[Path]:
    if given is None:
        return []
    given = [given] if isinstance(given, (str, os.PathLike)) else given
    paths = [Path(path) for path in given]
    known = [*_RASTERS, *_LINES, *_MESHES]
    for path in paths:
        if path.suffix.lower() not in known:
            raise UsageError(f"output {path} must end with {', '.join(known)}")
        if not path.parent.is_dir():
            raise InputError(f"output {path}: there is no folder {path.parent}")
        if path.suffix.lower() in _LINES:
            if contours is None:
                raise UsageError(f"output {path} needs contours=, the interval of their heights")
            optional("pyogrio.raw", _PURPOSE)
        else:
            optional("meshio" if path.suffix.lower() in _MESHES else "rasterio", _PURPOSE)
    return paths


def _joined(lines: list[Doubles]) -> tuple[Doubles, npt.NDArray[np.int32]]:
    """The points of all lines, and the segments between them."""
    firsts = np.concatenate([[0], np.cumsum([len(line) for line in lines])]).astype(np.int64)
    along = np.concatenate([np.empty((0, 3)), *lines])
    numbers = np.arange(len(along) + 1, dtype=np.int32)
    segments = np.stack([numbers[:-1], numbers[1:]], axis=1)
    return along, np.delete(segments, firsts[1:] - 1, axis=0)


@contextlib.contextmanager
def _naming_breaklines() -> Iterator[None]:
    try:
        yield
    except InputError as error:
        if "segment" not in str(error):
            raise
        raise InputError(f"breaklines: {error}") from error


def _split_crossings(
    along: Doubles, segments: npt.NDArray[np.int32], device: Optional[str]
) -> tuple[Doubles, npt.NDArray[np.int32]]:
    """Cuts segments where they cross, at the height of the first one that is there."""
    mesh = triangulate(along[:, :2], segments=segments, crossings="split", device=device)
    first = np.full(len(mesh.points), len(segments))
    np.minimum.at(first, mesh.constraint_edges, mesh.edge_segments[:, None])
    added = np.arange(len(along), len(mesh.points))
    ends = along[segments[first[added]]]
    start, way = ends[:, 0], ends[:, 1] - ends[:, 0]
    to = mesh.points[added] - start[:, :2]
    dots = to[:, 0] * way[:, 0] + to[:, 1] * way[:, 1]
    share = dots / (way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
    heights = start[:, 2] + share * way[:, 2]
    along = np.concatenate([along, np.column_stack([mesh.points[added], heights])])
    return along, mesh.constraint_edges


def _with_lines(
    points: Doubles,
    heights: Doubles,
    lines: list[Doubles],
    shores: list[Doubles],
    crossings: str,
    device: Optional[str],
) -> tuple[Any, Doubles, int]:
    """The mesh with breaklines, whose points come first; heights of all points, and the number of those."""
    along, segments = _joined(lines + shores)
    missing = np.isnan(along[:, 2])
    if missing.any():
        along[missing, 2] = _heights_at(along[missing, :2], points, heights, device)
    if crossings == "split":
        # Lakes come first, since they stay flat.
        segments = np.roll(segments, sum(len(shore) - 1 for shore in shores), axis=0)
        along, segments = _split_crossings(along, segments, device)
    with _naming_breaklines():
        mesh = triangulate(
            np.concatenate([along[:, :2], points]), segments=segments, device=device, neighbors=True
        )
    return mesh, np.concatenate([along[:, 2], heights]), len(along)


def _heights_at(
    places: Doubles, points: Doubles, heights: Doubles, device: Optional[str]
) -> Doubles:
    """Heights between points, and beyond them that of the nearest one."""
    tri = Delaunay(points, device=device)
    found = LinearInterpolator(tri, heights)(places)
    beyond = np.isnan(found)
    found[beyond] = NearestInterpolator(tri, heights)(places[beyond])
    return found


def _shores(
    lakes: list[Any], points: Doubles, heights: Doubles, device: Optional[str]
) -> tuple[list[Doubles], npt.NDArray[np.bool_]]:
    """The rings of lakes, each lake at one height, and which points lie in none of them."""
    shapely = optional("shapely", _PURPOSE)
    shores = []
    for lake in lakes:
        rings = [ring for ring in _lines_of([lake]) if len(ring)]
        if not rings:
            continue
        level = rings[0][0, 2]
        if np.isnan(level):
            # Water lies no higher than the lowest place of its shore.
            level = _heights_at(np.concatenate(rings)[:, :2], points, heights, device).min()
        shores += [np.column_stack([ring[:, :2], np.full(len(ring), level)]) for ring in rings]
    inside = shapely.intersects_xy(shapely.union_all(lakes), points[:, 0], points[:, 1])
    return shores, ~inside


def _interpolate_pixels(result: Terrain, method: str) -> None:
    """Values at the centres of pixels, by another method than the linear one."""
    interpolate = _METHODS[method](result.mesh, result.heights, max_edge=result._max_edge)
    x, y, dx, dy = result._grid.steps
    rows, columns = result.raster.shape
    across, at_once = x + np.arange(columns) * dx, max(1, _PIXELS_AT_ONCE // columns)
    for first in range(0, rows, at_once):
        down = y + np.arange(first, min(rows, first + at_once)) * dy
        result.raster[first : first + at_once] = interpolate(*np.meshgrid(across, down))


def _stored(pieces: Iterable[Doubles], scratch: Optional[_Paths]) -> Doubles:
    """Points in a file without a name, which is mapped into memory."""
    with tempfile.TemporaryFile(dir=scratch) as file:
        for piece in pieces:
            file.write(np.ascontiguousarray(piece).data)
        file.flush()
        if not file.tell():
            return np.empty((0, 3))
        return np.memmap(file, np.float64, "r").reshape(-1, 3)


def _map_in_chunks(
    result: Terrain,
    measured: Doubles,
    duplicates: str,
    max_edge: Optional[float],
    contours: Union[None, float, npt.ArrayLike],
    lines: list[Doubles],
    crossings: str,
    device: Optional[str],
    chunks: Any,
) -> Contours:
    """Writes the raster. Returns the contours, if there are to be some."""
    along, segments = _joined(lines)
    if crossings == "split" and lines:
        along, segments = _split_crossings(along, segments, device)
    levels = np.empty(0)
    if contours is not None:
        ends = [measured[:, 2].min(), measured[:, 2].max(), *along[:, 2]]
        levels = _levels_of(contours, min(ends), max(ends))
    points, offsets, numbers = _calls.rasterize_chunks(
        measured[:, :2],
        measured[:, 2],
        _declarations.DUPLICATES[duplicates],
        result._grid.steps,
        _raster.as_length(max_edge, "max_edge"),
        np.nan,
        result.raster,
        levels,
        chunks,
        (np.ascontiguousarray(along[:, :2]), np.ascontiguousarray(along[:, 2]), segments),
    )
    return Contours(points, offsets, levels[numbers])


def _finished(
    result: Terrain,
    outputs: Sequence[Path],
    contours: Union[None, float, npt.ArrayLike],
    lines: Optional[Contours],
    nodata: float,
    shading: tuple[float, bool],
) -> Terrain:
    """The result within its boundary, with its files. lines: contours, if they are there already."""
    area = result._boundary
    if area is not None:
        rasterio = optional("rasterio", _PURPOSE)
        west, _, _, north = result.bounds
        origin = rasterio.transform.from_origin(west, north, result.resolution, result.resolution)
        outside = optional("rasterio.features", _PURPOSE).geometry_mask(
            [area], result.raster.shape, origin
        )
        result.raster[outside] = np.nan
        lines = None if lines is None else result._clipped(lines)
    if contours is not None and lines is None and any(p.suffix.lower() in _LINES for p in outputs):
        lines = result.contours(contours)
    with all_or_none(outputs) as names:
        for name, path in zip(names, outputs):
            suffix = path.suffix.lower()
            try:
                if suffix in _RASTERS:
                    result._write_raster(name, _RASTERS[suffix], nodata, shading)
                elif suffix in _MESHES:
                    result._write_mesh(name)
                else:
                    assert lines is not None
                    result._write_lines(name, _LINES[suffix], lines)
            except (Error, ImportError):
                raise
            except Exception as error:  # of other packages, such as for a full disk
                raise InputError(f"output {path} cannot be written: {error}") from error
    return result


def terrain(
    points: Any,
    output: Union[None, _Paths, Sequence[_Paths]] = None,
    *,
    resolution: float,
    bounds: Optional[Sequence[float]] = None,
    columns: Optional[Sequence[Union[str, int]]] = None,
    height: Union[None, str, Sequence[str]] = None,
    classes: Optional[Iterable[int]] = None,
    returns: Optional[str] = None,
    duplicates: str = "highest",
    breaklines: Any = None,
    line_height: Union[None, str, Sequence[str]] = None,
    crossings: str = "error",
    boundary: Any = None,
    flat: Any = None,
    method: str = "linear",
    max_edge: Optional[float] = None,
    contours: Union[None, float, npt.ArrayLike] = None,
    crs: Any = None,
    pixel_is: str = "area",
    nodata: float = -9999.0,
    vertical_factor: float = 1,
    colors: bool = False,
    device: Optional[str] = None,
    memory: Union[None, int, str] = None,
    scratch: Optional[_Paths] = None,
) -> Terrain:
    """Makes a map of measured heights: a raster, contours and a shaded picture.

    Parameters
    ----------
    points : path, list of paths, array_like or geometries
        Files ``.las``, ``.laz``, ``.txt``, ``.xyz``, ``.csv`` and ``.npy``, folders of these, an array of x, y and
        z, or points and lines: ``.gpkg``, ``.shp``, ``.fgb``, ``.parquet``, ``.geojson``, a table of geopandas or
        geometries of Shapely. Of files with several layers, one: ``"project.gpkg:samples"``.
    output : path or list of paths, optional
        Files to write: ``.tif`` (a cloud-optimised GeoTIFF of float32), ``.png`` (shaded hills),
        ``.geojson``, ``.gpkg`` or ``.fgb`` (contours), ``.ply``, ``.obj``, ``.stl``, ``.vtk`` or ``.vtu`` (the
        triangles, by meshio). All are written, or none is.
    resolution : float
        The size of a pixel.
    bounds : (xmin, ymin, xmax, ymax), optional
        What the raster covers at least; the box of the points by default.
    columns : sequence of three str or int, optional
        Of text and ``.npy``, the columns with x, y and z: names of the header, or numbers from 0; the first ones
        by default.
    height : str or sequence of str, optional
        Of layers and tables, the field that has the height, in place of that of positions; of several, the first
        one that there is. Also of `breaklines` and `flat`.
    classes : iterable of int, optional
        Of a scan, the classes of points that are used: 2 is ground, 9 water. By default all but noise, 7 and 18.
        Points that are marked as withheld are never used.
    returns : {"first", "last"}, optional
        Of a scan, only these returns of each pulse.
    duplicates : {"highest", "lowest", "mean"}
        The height of a place that was measured several times.
    breaklines : path, table of geopandas, geometries of Shapely or list of arrays, optional
        Lines that become edges of the triangulation, of shape (k, 3), or (k, 2) to take the heights of the
        points around them.
    line_height : str or sequence of str, optional
        Of breaklines, in place of `height`.
    crossings : {"error", "split"}
        Breaklines that cross are an error, or cut where they do, at the height of the first one.
    boundary : path, table of geopandas or geometry of Shapely, optional
        Polygons, outside of which the map is empty.
    flat : path, table of geopandas or geometries of Shapely, optional
        Polygons that are held flat, such as lakes: at the height of the first point of their border, or
        if that has none, at the lowest height along it. Points in them do not count.
    method : {"linear", "natural", "clough-tocher"}
        How heights of pixels are interpolated: linearly in triangles, or smoothly, as
        `NaturalNeighborInterpolator` and `CloughTocherInterpolator` do.
    max_edge : float, optional
        Triangles with a longer edge are left out.
    contours : float or array_like, optional
        The interval of contours' heights, or the heights, for `output`.
    crs : optional
        The system of the coordinates, as rasterio reads it, in place of that of the files.
    pixel_is : {"area", "point"}
        Whether the edges of pixels or their centres are multiples of the resolution.
    nodata : float
        What stands for no height in the GeoTIFF.
    vertical_factor : float
        Of a ``.png``, by what heights are multiplied; longitudes and latitudes count in metres anyhow.
    colors : bool
        Of a ``.png``, colours by height, from green to white.
    device : str, optional
        As of `triangulate`.
    memory : int or str, optional
        Triangulates in chunks, within so many bytes beside the raster and the contours, such as ``"2G"``: for more
        points than fit memory. Without flat lakes, other methods than the linear one and files of triangles;
        breaklines need heights.
    scratch : path, optional
        The folder for files without a name that `memory` needs, up to 56 bytes per point; TMPDIR or /tmp by default.

    Returns
    -------
    Terrain

    Raises
    ------
    UsageError
        For arguments that make no sense, such as a resolution that makes too many pixels.
    InputError
        For files that cannot be read or written, are truncated or have different coordinate systems, if no
        point is left, for breaklines that cross, and for breaklines, lakes and boundaries where no points are.
    ImportError
        Without a package that is needed; ``pip install flaunay[terrain]`` installs all.

    Notes
    -----
    Coordinates of scans are the doubles next to the decimal numbers that the files have. The raster has the
    same bytes whatever the order of files and points. Without `memory`, all points are in memory at once, about
    200 bytes each.

    Examples
    --------
    >>> import flaunay
    >>> flaunay.terrain([[0, 0, 5], [4, 0, 9], [0, 4, 5], [4, 4, 9]], resolution=2).raster
    array([[6., 8.],
           [6., 8.]])
    """
    _check_one_of(returns, (None, "first", "last"), "returns")
    _check_one_of(duplicates, tuple(_declarations.DUPLICATES), "duplicates")
    _check_one_of(pixel_is, ("area", "point"), "pixel_is")
    _check_one_of(method, tuple(_METHODS), "method")
    _check_one_of(crossings, ("error", "split"), "crossings")
    _raster.as_length(max_edge, "max_edge")
    chosen = None if classes is None else frozenset(classes)
    outputs = _checked_outputs(output, contours)
    shading = (_raster.as_length(vertical_factor, "vertical_factor"), bool(colors))
    if shading != (1, False) and not any(path.suffix.lower() == ".png" for path in outputs):
        raise UsageError("vertical_factor= and colors= need an output .png")
    chunks = None
    if memory is not None:
        chunks = chunks_of(memory, scratch, device, None, None)
        if not (flat is None and method == "linear") or any(
            path.suffix.lower() in _MESHES for path in outputs
        ):
            raise UsageError(
                "memory= is for rasters and contours alone: not for flat lakes, other methods than the "
                "linear one and files of triangles"
            )
    fields = _names(height)
    sources = _sources(points, columns, fields)
    has_field = any(getattr(source, "has_field", False) for source in sources)
    inputs = [*(source.path for source in sources), breaklines, boundary, flat]
    for given in inputs:
        for path in outputs:
            if isinstance(given, (str, os.PathLike)) and is_one_file(_layer_in(given)[0], path):
                raise UsageError(f"output {path} would overwrite the input")
    system = _common_crs(sources, crs)
    boxes = np.array([source.box for source in sources if source.box is not None])
    if bounds is not None:
        box = np.asarray(as_floats(bounds, "bounds"), np.float64)
        if box.shape != (4,):
            raise UsageError(f"bounds must be (xmin, ymin, xmax, ymax), not of shape {box.shape}")
    elif len(boxes):
        box = np.concatenate([boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)])
    else:
        raise InputError("there are no points")
    maps: dict[str, Any] = {}
    is_point = pixel_is == "point"
    _Grid(box, resolution, is_point)
    area = None
    if boundary is not None:
        area = optional("shapely", _PURPOSE).union_all(_geometries(boundary, system, "boundary")[0])
        maps["boundary"] = [area]
        optional("rasterio.features", _PURPOSE)

    lakes: list[Any] = []
    if flat is not None:
        found, has_one = _geometries(flat, system, "flat", fields)
        lakes = maps["flat"] = _polygons_of(found)
        has_field |= has_one
    lines_kept: list[Doubles] = []
    own_fields = _names(line_height)
    if own_fields and breaklines is None:
        raise UsageError("line_height= needs breaklines=")
    if breaklines is not None:
        maps["breaklines"], has_one = _geometries(
            breaklines, system, "breaklines", own_fields or fields
        )
        lines_kept = [line for line in _lines_of(maps["breaklines"]) if len(line)]
        if own_fields and not has_one:
            raise InputError(f"breaklines have no field {' or '.join(own_fields)}, of line_height=")
        has_field |= has_one and not own_fields
    if fields and not has_field:
        raise InputError(f"no layer has a field {' or '.join(fields)}, of height=")
    if chunks is not None and any(np.isnan(line[:, 2]).any() for line in lines_kept):
        raise UsageError("memory=: breaklines must have heights at all their points")

    pieces = (piece for source in sources for piece in source.pieces(chosen, returns))
    measured = (
        np.concatenate([*pieces, np.empty((0, 3))]) if chunks is None else _stored(pieces, scratch)
    )
    if not len(measured):
        raise InputError(
            "no point is left" + ("" if chosen is None else f" of the classes {sorted(chosen)}")
        )
    for name, geometries in maps.items():
        _check_place(name, geometries, measured[:, :2])
    left_out = sum((source.left_out for source in sources), Counter(withheld=0, noise=0))
    if bounds is None:
        # The box of the points that are left.
        box = np.concatenate([measured[:, :2].min(axis=0), measured[:, :2].max(axis=0)])
    grid = _Grid(box, resolution, is_point)
    if chunks is not None:
        result = Terrain(None, np.empty(0), grid, system, area)
        with _naming_breaklines():
            lines = _map_in_chunks(
                *(result, measured, duplicates, max_edge, contours),
                *(lines_kept, crossings, device, chunks),
            )
        result.left_out.update(left_out)
        return _finished(result, outputs, contours, lines, nodata, shading)
    places, heights = np.ascontiguousarray(measured[:, :2]), measured[:, 2].copy()
    mesh: Any
    fixed = 0
    shores: list[Doubles] = []
    if lakes:
        shores, is_dry = _shores(lakes, places, heights, device)
        places, heights = places[is_dry], heights[is_dry]
    if lines_kept or shores:
        mesh, heights, fixed = _with_lines(places, heights, lines_kept, shores, crossings, device)
    else:
        mesh = Delaunay(places, device=device)
    _merge_heights(heights, mesh.representatives, fixed, duplicates)
    result = Terrain(mesh, heights, grid, system, area)
    result._max_edge = max_edge
    result.left_out.update(left_out)
    if method == "linear":
        _raster.rasterize(mesh, heights, grid.steps, result.raster, max_edge, np.nan, device)
    else:
        _interpolate_pixels(result, method)
    return _finished(result, outputs, contours, None, nodata, shading)
