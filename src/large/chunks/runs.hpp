// Writes single entries of an array, those that follow each other together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/chunks.hpp"

namespace flaunay::chunks {

class RunWriter {
 public:
  RunWriter(MeshSink& sink, MeshArray array) : sink_(sink), array_(array), is_wanted_(sink.wants(array)) {}

  void add(std::uint64_t place, std::int64_t value) {
    if (!is_wanted_) return;
    if (place != first_ + values_.size() || values_.size() == kMostValues) flush();
    if (values_.empty()) first_ = place;
    values_.push_back(value);
  }
  /// To be called at the end.
  void flush() {
    if (!values_.empty()) sink_.write(array_, first_, values_.data(), values_.size());
    values_.clear();
  }

 private:
  static constexpr std::size_t kMostValues = 1 << 16;

  MeshSink& sink_;
  MeshArray array_;
  bool is_wanted_;
  std::uint64_t first_ = 0;
  std::vector<std::int64_t> values_;
};

}  // namespace flaunay::chunks
