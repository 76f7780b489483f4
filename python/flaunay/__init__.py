"""Exact two-dimensional Delaunay triangulation on OpenCL devices.

``Delaunay`` and ``Voronoi`` have the attributes of SciPy's classes of these names. ``LinearInterpolator``,
``NearestInterpolator``, ``CloughTocherInterpolator`` and ``griddata`` interpolate scattered values, with
SciPy's calls, and ``NaturalNeighborInterpolator`` does likewise. ``Voronoi.clipped`` and
``voronoi_polygons`` clip cells to a box or a convex polygon, ``relax`` spreads points evenly, and
``alpha_shape`` finds the outline of points. ``triangulate`` is the plain call,
for one set of points or many at once, also with segments that are to be edges, and ``polygons`` fills any
number of polygons with triangles. ``triangulate_device`` takes and leaves everything in device
memory, as ``pyopencl.array.Array``, and so do the queries, interpolation and Voronoi diagrams of its
result, ``relax_device``, ``periodic_device`` and ``spherical_device``. ``triangulate_chunks`` is for more points than fit memory: it reads
arrays that are mapped from files, and writes files; ``rasterize_chunks`` and ``contour_chunks`` make maps of them.
``Delaunay(points, incremental=True)`` and ``DynamicTriangulation`` have points that are added, removed and moved. The module ``triangle`` has the calls of the package of
that name.

Without a GPU, calls on NumPy arrays run on the host's cores and need no OpenCL. On a device, the first
call builds its kernels, which takes some seconds; they are kept on disk for later processes, and
everything else for later calls.

Threads may call at the same time: the interpreter's lock is released while a device works, and one
device does one call after the other. OpenCL does not survive a fork: in a child of a process that
used it, calls run on the host, and calls that name or need a device raise ``DeviceError``.
"""

from flaunay import triangle
from flaunay._alpha_shape import AlphaShape, alpha_shape
from flaunay._cells import ClippedVoronoi, relax, voronoi_polygons
from flaunay._chunks import (
    ChunkedTriangulation,
    contour_chunks,
    rasterize_chunks,
    triangulate_chunks,
)
from flaunay._constrained import ConstrainedTriangulation
from flaunay._delaunay import Delaunay
from flaunay._device_queries import DeviceLocator
from flaunay._device_sphere import DeviceSpherical, spherical_device
from flaunay._device_voronoi import DeviceClippedVoronoi, DeviceVoronoi, relax_device
from flaunay._dynamic import (
    Changes,
    DeviceRows,
    DynamicTriangulation,
    LivingConstraints,
    TriangleRows,
)
from flaunay._errors import DeviceError, Error, InputError, InternalError, UsageError
from flaunay._calls import __version__
from flaunay._interpolate import (
    CloughTocherInterpolator,
    LinearInterpolator,
    NaturalNeighborInterpolator,
    NearestInterpolator,
    griddata,
)
from flaunay._on_device import DeviceTriangulation, triangulate_device
from flaunay._periodic import (
    DevicePeriodic,
    PeriodicDelaunay,
    periodic,
    periodic_device,
    to_places,
)
from flaunay._pieces import VoronoiPieces
from flaunay._polygons import PolygonTriangulation, polygons
from flaunay._raster import Contours
from flaunay._refinement import RefinementReport
from flaunay._sphere import SphericalDelaunay, SphericalVoronoi, spherical
from flaunay._terrain import Terrain, terrain
from flaunay._triangulate import refine, triangulate
from flaunay._triangulation import Triangulation, modes, verify
from flaunay._triangulators import devices
from flaunay._voronoi import Voronoi
from flaunay._weighted import WeightedDelaunay, weighted

__all__ = [
    "AlphaShape",
    "Changes",
    "ChunkedTriangulation",
    "ClippedVoronoi",
    "CloughTocherInterpolator",
    "ConstrainedTriangulation",
    "Contours",
    "Delaunay",
    "DeviceClippedVoronoi",
    "DeviceError",
    "DeviceLocator",
    "DevicePeriodic",
    "DeviceRows",
    "DeviceSpherical",
    "DeviceTriangulation",
    "DeviceVoronoi",
    "DynamicTriangulation",
    "Error",
    "InputError",
    "InternalError",
    "LinearInterpolator",
    "LivingConstraints",
    "NaturalNeighborInterpolator",
    "NearestInterpolator",
    "PeriodicDelaunay",
    "PolygonTriangulation",
    "RefinementReport",
    "SphericalDelaunay",
    "SphericalVoronoi",
    "Terrain",
    "TriangleRows",
    "Triangulation",
    "UsageError",
    "Voronoi",
    "VoronoiPieces",
    "WeightedDelaunay",
    "__version__",
    "alpha_shape",
    "contour_chunks",
    "devices",
    "griddata",
    "modes",
    "periodic",
    "periodic_device",
    "polygons",
    "rasterize_chunks",
    "refine",
    "relax",
    "relax_device",
    "spherical",
    "spherical_device",
    "terrain",
    "to_places",
    "triangle",
    "triangulate",
    "triangulate_chunks",
    "triangulate_device",
    "verify",
    "voronoi_polygons",
    "weighted",
]
