// Natural-neighbour interpolation, and the natural neighbours of queries with their weights.
#pragma once

#include <cstddef>
#include <functional>
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

/// Where lists of neighbours go.
struct NaturalLists {
  Buffer<cl_int> points{};      ///< the neighbours of the queries, one query after the other
  Buffer<cl_double> weights{};  ///< of each of them; those of a query have the sum 1
};

/// Lists the natural neighbours of each query, counter-clockwise; there are none outside of the hull.
/// offsets: m
/// + 1, where the neighbours of each query begin. allocate(total) makes the lists once their length is known.
/// Waits once more for that.
void natural_neighbors(host::Runtime& runtime, const Locator& locator, NaturalWeights method,
                       const Buffer<cl_double>& queries, std::size_t m,
                       const std::vector<std::size_t>& query_offsets, const Buffer<cl_uint>& offsets,
                       const std::function<NaturalLists(std::size_t total)>& allocate);

}  // namespace flaunay::interpolate
