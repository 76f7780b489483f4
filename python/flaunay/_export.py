"""Triangulations for other packages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional

import numpy as np
import numpy.typing as npt

from flaunay._arrays import Triangles
from flaunay._errors import UsageError
from flaunay._optional import optional

if TYPE_CHECKING:
    import matplotlib.tri
    import meshio
    import pyvista

Data = Mapping[str, npt.ArrayLike]


def _checked(data: Optional[Data], n: int, name: str) -> dict[str, npt.NDArray[Any]]:
    """Arrays of one row for each of n; UsageError for others."""
    arrays = {key: np.asarray(value) for key, value in (data or {}).items()}
    for key, array in arrays.items():
        if array.ndim == 0 or len(array) != n:
            raise UsageError(f"{name}[{key!r}] must have the shape ({n}, ...), not {array.shape}")
    return arrays


def _heights(tri: Triangles, z: npt.ArrayLike) -> npt.NDArray[Any]:
    heights, n = np.asarray(z), len(tri.points)
    if heights.shape != (n,):
        raise UsageError(f"z must have the shape ({n},), not {heights.shape}")
    return heights


class ExportMethods:
    """Triangles for other packages."""

    def to_matplotlib(self: Triangles) -> matplotlib.tri.Triangulation:
        """The triangulation for Matplotlib's ``triplot``, ``tripcolor``, ``tricontourf`` and others.

        Returns
        -------
        matplotlib.tri.Triangulation
            Made of these triangles, so Matplotlib runs no triangulation of its own. It has none if
            there are no simplices, which Matplotlib refuses.

        Raises
        ------
        UsageError
            If there are no simplices.
        ImportError
            Without Matplotlib.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.to_matplotlib().triangles
        array([[0, 1, 2]], dtype=int32)
        """
        if len(self.simplices) == 0:
            raise UsageError("Matplotlib takes no triangulation without triangles")
        triangulations = optional("matplotlib.tri", f"{type(self).__name__}.to_matplotlib")
        x, y = self.points.T
        result: matplotlib.tri.Triangulation = triangulations.Triangulation(x, y, self.simplices)
        return result

    def to_meshio(
        self: Triangles,
        point_data: Optional[Data] = None,
        cell_data: Optional[Data] = None,
        z: Optional[npt.ArrayLike] = None,
    ) -> meshio.Mesh:
        """The triangulation as a mesh of meshio, which writes VTK, XDMF, Gmsh, STL and other files.

        Parameters
        ----------
        point_data, cell_data : mapping of str to array_like, optional
            What points and simplices have, one row for each.
        z : array_like, shape (npoints,), optional
            Heights of the points, which otherwise are two-dimensional.

        Returns
        -------
        meshio.Mesh
            With copies of the arrays, and one block of triangles.

        Raises
        ------
        UsageError
            For data of another length.
        ImportError
            Without meshio.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.to_meshio(point_data={"height": [1, 2, 3]}).write("hills.vtk")  # doctest: +SKIP
        """
        of_points = _checked(point_data, len(self.points), "point_data")
        of_cells = _checked(cell_data, len(self.simplices), "cell_data")
        mesh: meshio.Mesh = optional("meshio", f"{type(self).__name__}.to_meshio").Mesh(
            self.points.copy() if z is None else np.column_stack([self.points, _heights(self, z)]),
            [("triangle", self.simplices.copy())],
            point_data=of_points,
            cell_data={name: [array] for name, array in of_cells.items()},
        )
        return mesh

    def to_pyvista(self: Triangles, z: Optional[npt.ArrayLike] = None) -> pyvista.PolyData:
        """The triangulation as a surface of PyVista.

        Parameters
        ----------
        z : array_like, shape (npoints,), optional
            Heights of the points; zero without.

        Returns
        -------
        pyvista.PolyData
            With copies of the arrays.

        Raises
        ------
        UsageError
            For another number of heights than of points.
        ImportError
            Without PyVista.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.to_pyvista(z=[0, 1, 2]).plot()  # doctest: +SKIP
        """
        heights = np.zeros(len(self.points)) if z is None else _heights(self, z)
        sizes = np.full((len(self.simplices), 1), 3, np.int32)
        surface: pyvista.PolyData = optional("pyvista", f"{type(self).__name__}.to_pyvista").PolyData(
            np.column_stack([self.points, heights]),
            faces=np.hstack([sizes, self.simplices]).ravel(),
        )
        return surface

    def to_shapely(self: Triangles) -> npt.NDArray[np.object_]:
        """The simplices as polygons of Shapely, which ``geopandas.GeoSeries`` takes as they are.

        Returns
        -------
        ndarray of shapely.Polygon, shape (nsimplex,)

        Raises
        ------
        ImportError
            Without Shapely 2.
        """
        shapely = optional("shapely", f"{type(self).__name__}.to_shapely")
        polygons: npt.NDArray[np.object_] = shapely.polygons(self.points[self.simplices[:, [0, 1, 2, 0]]])
        return polygons

    def to_geojson(self: Triangles, properties: Optional[Data] = None) -> dict[str, Any]:
        """The triangles as a FeatureCollection of GeoJSON, which ``json.dump`` writes.

        Coordinates are those of the points: GeoJSON (RFC 7946) means longitude and latitude.

        Parameters
        ----------
        properties : mapping of str to array_like, optional
            What triangles have, one row for each.

        Returns
        -------
        dict
            With one Feature, a Polygon, for each triangle.

        Raises
        ------
        UsageError
            For properties of another length.

        Examples
        --------
        >>> import flaunay
        >>> tri = flaunay.Delaunay([[0, 0], [4, 0], [0, 4]])
        >>> tri.to_geojson({"height": [7]})["features"][0]["properties"]
        {'height': 7}
        """
        data = _checked(properties, len(self.simplices), "properties")
        rings = self.points[self.simplices[:, [0, 1, 2, 0]]].tolist()
        rows = zip(*(array.tolist() for array in data.values())) if data else ([] for _ in rings)
        features = [
            {
                "type": "Feature",
                "geometry": {"type": "Polygon", "coordinates": [ring]},
                "properties": dict(zip(data, row)),
            }
            for ring, row in zip(rings, rows)
        ]
        return {"type": "FeatureCollection", "features": features}
