"""In place of trimesh.creation.extrude_polygon, which calls one of three other packages."""

import trimesh

import flaunay


def extrude_polygon(polygon, height, **options):
    """trimesh.creation.extrude_polygon."""
    mesh = flaunay.polygons(polygon)
    return trimesh.creation.extrude_triangulation(mesh.points, mesh.triangles, height, **options)
