"""In place of momepy.morphological_tessellation, which calls libpysal's voronoi_frames."""

import shapely
from for_libpysal import voronoi_frames


def morphological_tessellation(
    geometry, clip="bounding_box", shrink=0.4, segment=0.5, simplify=True, **options
):
    """momepy.morphological_tessellation, with its arguments: the space around buildings."""
    if geometry.index.nlevels > 1:
        raise ValueError("MultiIndex is not supported in `momepy.morphological_tessellation`.")
    if hasattr(clip, "union_all"):
        clip = clip.union_all()
    cells = voronoi_frames(geometry, None, clip, shrink, segment, return_input=False, **options)
    if simplify:
        cells.geometry = shapely.coverage_simplify(
            cells.geometry, tolerance=segment / 2, simplify_boundary=False
        )
    return cells
