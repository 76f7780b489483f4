"""Exact two-dimensional Delaunay triangulation on OpenCL devices.

``Delaunay`` and ``Voronoi`` have the attributes of SciPy's classes of these names. ``triangulate`` is the plain call,
for one set of points or many at once; ``triangulate_device`` takes and leaves everything in device
memory, as ``pyopencl.array.Array``.

The first call on a device builds its kernels, which takes some seconds; they are kept for later
processes by the OpenCL implementation, and everything else for later calls.

Threads may call at the same time: the interpreter's lock is released while a device works, and one
device does one call after the other. After a fork, no call can be made in the child if one was made
in the parent, as OpenCL does not survive it: start processes by ``multiprocessing``'s ``spawn``.
"""

from flaunay._delaunay import Delaunay
from flaunay._errors import DeviceError, Error, InputError, InternalError, UsageError
from flaunay._flaunay import __version__
from flaunay._on_device import DeviceTriangulation, triangulate_device
from flaunay._triangulation import Triangulation, modes, triangulate
from flaunay._triangulators import devices
from flaunay._voronoi import Voronoi

__all__ = [
    "Delaunay",
    "DeviceError",
    "DeviceTriangulation",
    "Error",
    "InputError",
    "InternalError",
    "Triangulation",
    "UsageError",
    "Voronoi",
    "__version__",
    "devices",
    "modes",
    "triangulate",
    "triangulate_device",
]
