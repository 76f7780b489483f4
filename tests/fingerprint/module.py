"""For scripts/fingerprint.py: calls the Python module in many ways and prints one line for each, "key value".

It asserts nothing; two versions are compared by what they print. The script sets FLAUNAY_FINGERPRINT_MODE to the
name of the default mode, which older versions call otherwise.
"""

import hashlib
import inspect
import os

import numpy as np

import flaunay

DEFAULT_MODE = os.environ["FLAUNAY_FINGERPRINT_MODE"]
MODES = [DEFAULT_MODE, "flattened", "recursive-device", "recursive", "partition", "dwyer"]
# Older versions call the offsets of sets segments.
OFFSETS = "offsets" if "offsets" in inspect.signature(flaunay.triangulate).parameters else "segments"
random = np.random.RandomState(1)  # its numbers never change

SETS = {
    "empty": np.empty((0, 2)),
    "one": np.ones((1, 2)),
    "collinear": np.arange(20.0).reshape(10, 2),
    "grid": np.stack(np.meshgrid(np.arange(15.0), np.arange(15.0)), axis=-1).reshape(-1, 2),
    "duplicates": random.randint(0, 10, (300, 2)).astype(float),
    "random": random.random_sample((2000, 2)),
    "integers": random.randint(-50, 50, (200, 2)),
}


def text_of(value):
    if isinstance(value, np.ndarray):
        # Not-a-numbers have many forms.
        value = np.where(np.isnan(value), -1.0, value) if value.dtype.kind == "f" else value
        content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()[:16]
        return f"{value.dtype} {value.shape} {content}"
    text = repr(value)
    return text if len(text) < 100 else hashlib.sha256(text.encode()).hexdigest()[:16]


def show(key, compute):
    try:
        print(key, text_of(compute()))
    except Exception as error:
        print(key, type(error).__name__, " ".join(str(error).split()))


def show_attributes(key, make, names):
    try:
        result = make()
    except Exception as error:
        print(key, type(error).__name__, " ".join(str(error).split()))
        return None
    for name in names.split():
        show(f"{key}/{name}", lambda: getattr(result, name))
    return result


TRIANGULATION = "triangles neighbors halfedges hull representatives triangle_offsets hull_offsets"
DELAUNAY = (
    "simplices neighbors hull representatives npoints nsimplex ndim min_bound max_bound convex_hull coplanar"
    " vertex_to_simplex vertex_neighbor_vertices points"
)
VORONOI = (
    "vertices cells cell_offsets unbounded npoints min_bound max_bound ridge_points ridge_vertices regions"
    " point_region"
)
STATISTICS = "points duplicates triangles hull_vertices kernel_launches host_waits undecided device_bytes_peak"


def show_classes(name, points):
    delaunay = show_attributes(f"delaunay/{name}", lambda: flaunay.Delaunay(points), DELAUNAY)
    show_attributes(f"voronoi/{name}", lambda: flaunay.Voronoi(points), VORONOI)
    queries = np.concatenate([random.random_sample((100, 2)) * 20 - 2, np.asarray(points, float)[:50]])
    values = np.arange(2.0 * len(points)).reshape(-1, 2) % 97
    show(f"delaunay/{name}/find_simplex", lambda: delaunay.find_simplex(queries))
    show(f"delaunay/{name}/nearest", lambda: delaunay.nearest(queries))
    show(f"delaunay/{name}/interpolate", lambda: delaunay.interpolate(values, queries))


def show_triangulations(name, points):
    segments = [0, len(points) // 3, len(points) // 3, len(points)]
    for mode in MODES:
        if mode == "recursive-device" and len(points) > 300:
            continue
        for kind, offsets in ("one-set", None), ("segments", segments):
            key = f"triangulate/{mode}/{kind}/{name}"
            result = show_attributes(
                key,
                lambda: flaunay.triangulate(points, **{OFFSETS: offsets}, halfedges=True, mode=mode),
                TRIANGULATION,
            )
            show(f"{key}/statistics", lambda: [result.statistics.get(name) for name in STATISTICS.split()])
    narrow = np.asarray(points, np.float32)
    show_attributes(f"triangulate/float32/{name}", lambda: flaunay.triangulate(narrow), TRIANGULATION)


def show_on_device(name, points):
    try:
        import pyopencl
        import pyopencl.array
    except ImportError:
        return
    queue = pyopencl.CommandQueue(pyopencl.create_some_context(interactive=False))
    for kind in (np.float64, np.float32):
        array = pyopencl.array.to_device(queue, np.asarray(points, kind))
        show_attributes(
            f"triangulate_device/{kind.__name__}/{name}",
            lambda: flaunay.triangulate_device(
                array,
                **{OFFSETS: [0, len(points) // 2, len(points)]},
                neighbors=True,
                halfedges=True,
                hull=True,
                representatives=True,
            ).get(),
            TRIANGULATION,
        )


SURFACE = "places simplices neighbors representatives npoints nsimplex"


def show_spaces(name, points):
    points = np.asarray(points, float)
    queries = np.concatenate([random.random_sample((100, 2)) * 20 - 2, points[:50]])
    values = np.arange(2.0 * len(points)).reshape(-1, 2) % 97
    weights = np.arange(len(points)) % 5
    bounds = [(-1, -1), (30, -1), (30, 30), (-1, 30)]
    regular = show_attributes(
        f"weighted/{name}", lambda: flaunay.weighted(points, weights), "simplices neighbors hull hidden hidden_by"
    )
    show_attributes(f"weighted/{name}/cells", lambda: regular.cells(bounds), "vertices offsets areas centroids")
    degrees = [points[:, 0] * 20 % 360, points[:, 1] * 10 % 180 - 90]
    for space, make, asked in (
        ("torus", lambda: flaunay.periodic(points, (7, 11)), queries),
        ("cylinder", lambda: flaunay.periodic(points, (7, None)), queries),
        ("sphere", lambda: flaunay.spherical(np.stack(degrees, axis=-1)), queries),
    ):
        result = show_attributes(f"{space}/{name}", make, SURFACE)
        show(f"{space}/{name}/find_simplex", lambda: result.find_simplex(asked))
        show(f"{space}/{name}/nearest", lambda: result.nearest(asked))
        show(f"{space}/{name}/nearest-4", lambda: result.nearest(asked, k=4))
        show(f"{space}/{name}/interpolate", lambda: result.interpolate(values, asked))
        show(f"{space}/{name}/verify", lambda: result.verify())
        if space == "sphere":
            show_attributes(f"{space}/{name}/voronoi", lambda: result.voronoi, "vertices cells cell_offsets areas")
        else:
            show_attributes(f"{space}/{name}/cells", lambda: result.cells, "vertices offsets areas centroids")


for set_name, set_points in SETS.items():
    show_spaces(set_name, set_points)
    show_classes(set_name, set_points)
    show_triangulations(set_name, set_points)
    show_on_device(set_name, set_points)

SQUARE = SETS["grid"]
show("names", lambda: flaunay.__all__)
show("wrong/mode", lambda: flaunay.triangulate(SQUARE, mode="sideways"))
show("wrong/shape", lambda: flaunay.triangulate(np.zeros((4, 3))))
show("wrong/type", lambda: flaunay.Delaunay([["a", "b"]]))
show("wrong/nan", lambda: flaunay.Delaunay([[0, 0], [np.nan, 1]]))
show("wrong/magnitudes", lambda: flaunay.Delaunay([[1e-300, 0], [1e300, 1], [0, 1]]))
show("wrong/segments", lambda: flaunay.triangulate(SQUARE, **{OFFSETS: [0, 5, 3, len(SQUARE)]}))
show("wrong/segments-end", lambda: flaunay.triangulate(SQUARE, **{OFFSETS: [0, 5]}))
show("wrong/device", lambda: flaunay.triangulate(SQUARE, device="no such device"))
show("wrong/host-device", lambda: flaunay.triangulate(SQUARE, mode="dwyer", device="#0"))
show("wrong/queries", lambda: flaunay.Delaunay(SQUARE).find_simplex([[0, 0, 0]]))
show("wrong/query-nan", lambda: flaunay.Delaunay(SQUARE).find_simplex([[0, np.inf]]))
show("wrong/values", lambda: flaunay.Delaunay(SQUARE).interpolate([1, 2], [[0, 0]]))
