// Results of a triangulation in chunks that are arrays in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "flaunay/chunks.hpp"

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
  Index* place(MeshArray array) const {
    switch (array) {
      case MeshArray::triangles:
        return arrays_.triangles;
      case MeshArray::neighbors:
        return arrays_.neighbors;
      case MeshArray::hull:
        return arrays_.hull;
      case MeshArray::representatives:
        return arrays_.representatives;
    }
    return nullptr;
  }

  MeshArrays<Index> arrays_;
};

}  // namespace flaunay::chunks
