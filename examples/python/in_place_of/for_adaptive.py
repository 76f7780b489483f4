"""In place of the Qhull in adaptive.Learner2D, which triangulates all points again after each new one."""

import adaptive
import flaunay
import scipy.interpolate


class Learner2D(adaptive.Learner2D):
    """adaptive.Learner2D, whose interpolators are SciPy's on flaunay's triangles.

    Overrides `interpolator`, and `_interpolator_combined`, by which the learner chooses points.
    """

    def new(self):
        return type(self)(self.function, self.bounds, self.loss_per_triangle)

    def interpolator(self, *, scaled=False):
        points, values = self._data_in_bounds()
        return _interpolator(self._scale(points) if scaled else points, values)

    def _interpolator_combined(self):
        points, values = self._data_combined()
        return _interpolator(self._scale(points), values)


def _interpolator(points, values):
    triangles = flaunay.Delaunay(points).to_scipy()
    return scipy.interpolate.LinearNDInterpolator(triangles, values)
