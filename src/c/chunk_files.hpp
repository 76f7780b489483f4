// Triangulations in chunks whose points have any strides, and whose results go to arrays or files.
#pragma once

#include "flaunay/chunks.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/periodic.hpp"
#include "flaunay/result_arrays.hpp"

namespace flaunay::c {

template <typename Index>
MeshArrays<Index> to_arrays(const flaunay_mesh_arrays& given) {
#define ARRAY(name) static_cast<decltype(MeshArrays<Index>::name)>(given.name),
  return {FLAUNAY_MESH_ARRAYS(ARRAY)};
#undef ARRAY
}

/// Does flaunay_triangulate_chunks_to_files, or, with a period, flaunay_triangulate_periodic_chunks.
ChunkStatistics triangulate_to_files(const flaunay_strided_points& points, const Period* period,
                                     const flaunay_mesh_arrays& arrays, const flaunay_mesh_files& files,
                                     const ChunkOptions& options);
/// Throws Error(usage) if offsets are wanted, which there are with a period alone.
void refuse_offsets(const void* offsets);

}  // namespace flaunay::c
