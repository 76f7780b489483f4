// Triangulations in chunks whose points have any strides, and whose results go to arrays or files.
#pragma once

#include "flaunay/chunks.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/result_arrays.hpp"

namespace flaunay::c {

template <typename Index>
MeshArrays<Index> to_arrays(const flaunay_mesh_arrays& given) {
#define ARRAY(name) static_cast<decltype(MeshArrays<Index>::name)>(given.name),
  return {FLAUNAY_MESH_ARRAYS(ARRAY) given.corner_offsets};
#undef ARRAY
}

/// Does flaunay_triangulate_chunks_to_files.
ChunkStatistics triangulate_to_files(const flaunay_strided_points& points, const flaunay_mesh_arrays& arrays,
                                     const flaunay_mesh_files& files, const ChunkOptions& options);

}  // namespace flaunay::c
