"""Calls as type checkers see them. scripts/python-test.sh has mypy check that it refuses those with a comment alone."""

import numpy as np
import numpy.typing as npt

import flaunay

Points = npt.NDArray[np.float64]


def plain(points: Points) -> flaunay.Triangulation:
    return flaunay.triangulate(points, areas=True)


def refined(points: Points) -> list[flaunay.ConstrainedTriangulation]:
    return [
        flaunay.triangulate(points, min_angle=30),
        flaunay.triangulate(points, holes=[[1, 2]], max_area=1, outside="holes"),
        flaunay.triangulate(points, [[0, 1]], seeds=[[0, 0, 1]], labels=True, conforming=True),
        flaunay.refine(points, min_angle=30, holes=[[1, 2]], device="host"),
        flaunay.refine(flaunay.refine(points), max_area=1),
    ]


def maybe(points: Points, segments: "npt.NDArray[np.int32] | None") -> flaunay.Triangulation:
    return flaunay.triangulate(points, segments)


def wrong(points: Points) -> None:
    flaunay.refine(points, mn_angle=3)  # type: ignore[call-arg]
    flaunay.refine(points, min_angle="wide")  # type: ignore[arg-type]
    flaunay.refine(points, outside=True)  # type: ignore[arg-type]
    flaunay.triangulate(points, mn_angle=30)  # type: ignore[call-overload]
    flaunay.triangulate(points, outside="holes", colour=1)  # type: ignore[call-overload]
    flaunay.alpha_shape(points, alhpa=1)  # type: ignore[call-arg]
    flaunay.periodic(points, 10)  # type: ignore[arg-type]
    plain(points).areas.sum()  # type: ignore[union-attr]
