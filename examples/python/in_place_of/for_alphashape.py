"""In place of alphashape.alphashape in the plane, which calls SciPy and looks at one triangle after the other."""

import numpy as np

import flaunay


def alphashape(points, alpha):
    """alphashape.alphashape(points, alpha) of an array: its alpha is one over the radius, and its triangles are smaller."""
    radius = np.nextafter(1 / alpha, 0) if alpha > 0 else np.inf
    shape = flaunay.alpha_shape(points, radius).to_shapely()
    return shape.geoms[0] if len(shape.geoms) == 1 else shape
