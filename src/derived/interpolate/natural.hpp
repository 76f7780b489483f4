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

/// The natural neighbours of queries and their weights, which are written in a second pass.
class NaturalLists {
 public:
  /// Counts the neighbours. Waits once. The arguments are as in natural(); they must exist until the end of
  /// the call.
  NaturalLists(host::Runtime& runtime, const Locator& locator, NaturalWeights method,
               const Buffer<cl_double>& queries, std::size_t m,
               const std::vector<std::size_t>& query_offsets);
  /// Query i has the rows [offsets()[i], offsets()[i + 1]); those outside have none.
  const std::vector<std::size_t>& offsets() const { return offsets_; }
  /// Enqueues the kernels that write them.
  void write(const Buffer<cl_int>& neighbors, const Buffer<cl_double>& weights) const;

 private:
  void list(const Buffer<cl_int>& firsts, const Buffer<cl_int>& counts, const Buffer<cl_int>& neighbors,
            const Buffer<cl_double>& weights) const;

  host::Runtime& runtime_;
  const Locator& locator_;
  NaturalWeights method_;
  std::size_t m_;
  locate::LocatedQueries located_;
  std::vector<std::size_t> offsets_;
};

}  // namespace flaunay::interpolate
