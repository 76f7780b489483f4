"""Exact Delaunay triangulations, meshes and maps, on any CPU at once and on any OpenCL GPU.

Triangulations
    ``Delaunay`` has the attributes of SciPy's class, and with ``incremental=True`` points come and go, as in
    ``DynamicTriangulation`` (``Changes``, ``TriangleRows``, ``LivingConstraints``). ``triangulate`` is the plain call,
    for one set of points or many (``Triangulation``), also with segments as edges (``ConstrainedTriangulation``).
    ``refine`` adds points until angles and areas are as asked for (``RefinementReport``). ``polygons`` fills polygons,
    alone or as one map (``PolygonTriangulation``). ``triangle`` has the calls of the package of that name. ``modes``
    lists the algorithms.

Other spaces
    ``weighted`` points (``WeightedDelaunay``), a torus or a cylinder (``periodic``, ``PeriodicDelaunay``,
    ``to_places``), and the sphere (``spherical``, ``SphericalDelaunay``, ``SphericalVoronoi``).

From points and triangulations
    ``Voronoi`` diagrams as SciPy's, clipped cells (``voronoi_polygons``, ``ClippedVoronoi``, ``VoronoiPieces``),
    evenly spread points (``relax``), outlines (``alpha_shape``, ``AlphaShape``). ``LinearInterpolator``,
    ``NearestInterpolator``, ``CloughTocherInterpolator``, ``NaturalNeighborInterpolator`` and ``griddata`` interpolate
    scattered values. Rasters and ``Contours`` are methods; ``terrain`` makes maps of laser scans (``Terrain``).

Proofs
    ``verify``, and methods of that name, check a result exactly, by predicates of their own.

More points than memory
    ``triangulate_chunks`` (``ChunkedTriangulation``), ``rasterize_chunks`` and ``contour_chunks`` read mapped arrays.

Device memory, as ``pyopencl.array.Array``
    ``triangulate_device`` (``DeviceTriangulation``, ``DeviceLocator``, ``DeviceVoronoi``, ``DeviceClippedVoronoi``),
    ``relax_device``, ``periodic_device`` (``DevicePeriodic``), ``spherical_device`` (``DeviceSpherical``),
    ``DeviceRows``. ``devices`` lists the devices.

SciPy's names
    ``Delaunay``, ``Voronoi``, ``ConvexHull``, ``SphericalVoronoi``, ``LinearNDInterpolator``, ``NearestNDInterpolator``,
    ``CloughTocher2DInterpolator`` and ``griddata`` take the arguments of SciPy's, in the plane and on the sphere.

Errors
    ``UsageError``, ``InputError``, ``DeviceError`` and ``InternalError`` are kinds of ``Error``.

Without a GPU, calls on NumPy arrays run on the host's cores and need no OpenCL. On a device, the first
call builds its kernels, which takes some seconds; they are kept on disk for later processes, and
everything else for later calls.

Threads may call at the same time: the interpreter's lock is released while a device works, and one
device does one call after the other. OpenCL does not survive a fork: in a child of a process that
used it, calls run on the host, and calls that name or need a device raise ``DeviceError``.
"""

from flaunay import triangle
from flaunay._alpha_shape import AlphaShape, alpha_shape
from flaunay._cells import ClippedVoronoi, voronoi_polygons
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
from flaunay._hull import ConvexHull
from flaunay._interpolate import (
    CloughTocher2DInterpolator,
    CloughTocherInterpolator,
    LinearInterpolator,
    LinearNDInterpolator,
    NaturalNeighborInterpolator,
    NearestInterpolator,
    NearestNDInterpolator,
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
from flaunay._relax import relax
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
    "CloughTocher2DInterpolator",
    "CloughTocherInterpolator",
    "ConstrainedTriangulation",
    "Contours",
    "ConvexHull",
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
    "LinearNDInterpolator",
    "LivingConstraints",
    "NaturalNeighborInterpolator",
    "NearestInterpolator",
    "NearestNDInterpolator",
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

# Messages, help and pickles name them as users do, wherever they are defined.
for _name in __all__:
    _public = globals()[_name]
    if callable(_public):
        _public.__module__ = __name__
del _name, _public
