// Results of a triangulation in chunks that are arrays in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "flaunay/chunks.hpp"
#include "flaunay/result_arrays.hpp"
#include "geometry/arguments.hpp"

namespace flaunay::chunks {

/// Throws Error(usage) if corner offsets are wanted in the plane, where there are none.
inline void check_corner_offsets(const Space& space, bool are_wanted) {
  expect(!are_wanted || space.kind != SpaceKind::plane, "corner offsets are wanted, but there is no period");
}

/// Writes to arrays in memory, which it does not own.
template <typename Index>
class ArraySink : public MeshSink {
 public:
  explicit ArraySink(const MeshArrays<Index>& arrays) : arrays_(arrays) {}
  bool wants(MeshArray array) const override {
    bool is_wanted = false;
    visit(array, [&](const auto* values) { is_wanted = values != nullptr; });
    return is_wanted;
  }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    store(array, first, values, count);
  }
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override {
    store(array, first, values, count);
  }
  void write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count) override {
    if (arrays_.corner_offsets != nullptr) std::copy_n(values, count, arrays_.corner_offsets + first);
  }

 private:
  // Calls with the pointer to an array's first element.
  template <typename Visit>
  void visit(MeshArray array, const Visit& call) const {
    std::size_t number = 0;
#define ARRAY(name) \
  if (number++ == static_cast<std::size_t>(array)) call(arrays_.name);
    FLAUNAY_MESH_ARRAYS(ARRAY)
#undef ARRAY
  }
  template <typename T>
  void store(MeshArray array, std::uint64_t first, const T* values, std::size_t count) {
    visit(array, [&](auto* to) {
      using Element = std::remove_pointer_t<decltype(to)>;
      for (std::size_t k = 0; k < count; ++k) to[first + k] = static_cast<Element>(values[k]);
    });
  }

  MeshArrays<Index> arrays_;
};

}  // namespace flaunay::chunks
