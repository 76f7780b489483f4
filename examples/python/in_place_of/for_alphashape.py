"""In place of alphashape.alphashape in the plane, which calls SciPy and looks at one triangle after the other."""

import numpy as np
import shapely

import flaunay


def alphashape(points, alpha):
    """alphashape.alphashape(points, alpha) of an array: its alpha is one over the radius, and its triangles are smaller.

    Of fewer than four points, or if alpha is 0, it is the convex hull, which can be a point or a line.
    """
    if len(points) < 4 or alpha <= 0:
        return shapely.MultiPoint(points).convex_hull
    radius = np.nextafter(1 / alpha, 0)
    shape = flaunay.alpha_shape(points, radius).to_shapely()
    return shape.geoms[0] if len(shape.geoms) == 1 else shape
