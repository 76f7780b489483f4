// Results of a triangulation in chunks that are arrays in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "flaunay/chunks.hpp"
#include "flaunay/result_arrays.hpp"

namespace flaunay::chunks {

/// Writes to arrays in memory, which it does not own.
template <typename Index>
class ArraySink : public MeshSink {
 public:
  explicit ArraySink(const MeshArrays<Index>& arrays) : arrays_(arrays) {}
  bool wants(MeshArray array) const override { return place(array) != nullptr; }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    Index* const to = place(array) + first;
    for (std::size_t k = 0; k < count; ++k) to[k] = static_cast<Index>(values[k]);
  }

 private:
#define PLACE(name) &MeshArrays<Index>::name,
  static constexpr std::array kPlaces = {FLAUNAY_MESH_ARRAYS(PLACE)};
#undef PLACE
  Index* place(MeshArray array) const { return arrays_.*kPlaces[static_cast<std::size_t>(array)]; }

  MeshArrays<Index> arrays_;
};

}  // namespace flaunay::chunks
