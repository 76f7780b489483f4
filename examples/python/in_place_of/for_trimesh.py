"""In place of trimesh.creation.extrude_polygon, which calls one of three other packages."""

import numpy as np
import trimesh

import flaunay


def extrude_polygon(polygon, height, transform=None, mid_plane=False, **options):
    """trimesh.creation.extrude_polygon."""
    mesh = flaunay.polygons(polygon)
    if mid_plane:
        down = trimesh.transformations.translation_matrix([0, 0, -abs(height) / 2])
        transform = down if transform is None else np.dot(transform, down)
    return trimesh.creation.extrude_triangulation(
        mesh.points, mesh.triangles, height, transform, **options
    )
