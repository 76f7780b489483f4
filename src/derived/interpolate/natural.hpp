// Natural-neighbour interpolation.
#pragma once

#include <cstddef>
#include <vector>

#include "derived/interpolate/interpolate.hpp"
#include "interpolate/weights.h"

namespace flaunay::interpolate {

/// How neighbours are weighed, as kernels know it (interpolate/weights.h).
enum class NaturalWeights : cl_int { sibson = kernel::SIBSON, laplace = kernel::LAPLACE };

/// Interpolates between the natural neighbours of each query. Points and queries of a set together may span
/// only as many bits as points that are triangulated. The cost of a query is linear in the number of its
/// neighbours.
void natural(host::Runtime& runtime, const Locator& locator, NaturalWeights method, const Table& table,
             const Buffer<cl_double>& queries, std::size_t m, const std::vector<std::size_t>& query_offsets,
             const Buffer<cl_double>& results);

}  // namespace flaunay::interpolate
