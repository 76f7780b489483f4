"""In place of Geometry.create_mesh of sectionproperties, which calls Triangle by cytriangle."""

from flaunay import triangle


def create_mesh(geometry, mesh_sizes, min_angle=30.0, coarse=False):
    """geometry.create_mesh(mesh_sizes, min_angle, coarse): fills `mesh`, which Section reads."""
    places = geometry.control_points
    sizes = list(mesh_sizes) if isinstance(mesh_sizes, (list, tuple)) else [mesh_sizes]
    sizes = sizes * len(places) if len(sizes) == 1 else sizes
    if len(sizes) != len(places):
        raise ValueError(f"mesh_sizes for a Geometry must be either a number or {len(places)} numbers")
    given = {
        "vertices": geometry.points,
        "segments": geometry.facets,
        "regions": [[x, y, k, size] for k, ((x, y), size) in enumerate(zip(places, sizes))],
    }
    if geometry.holes:
        given["holes"] = geometry.holes
    geometry.mesh = triangle.triangulate(given, "pAo2" if coarse else f"pq{min_angle:.1f}Aao2")
    return geometry
