// Large arrays.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

#include "host/system/pages.hpp"

namespace flaunay::prove {

/// Memory for values that are written before they are read. Pages that are not used cost nothing.
template <typename Value>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t count) { allocate(count); }
  void allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(Value);
    const std::size_t page = bytes < system::kHugePage ? kCacheLine : system::kHugePage;
    values_.reset();
    values_.reset(static_cast<Value*>(system::allocate_aligned(page, bytes / page * page + page)));
    if (values_ == nullptr) throw std::bad_alloc();
    system::prefer_huge_pages(values_.get(), bytes);
    size_ = count;
  }
  Value* data() const { return values_.get(); }
  std::size_t size() const { return size_; }
  Value& operator[](std::size_t i) const { return values_.get()[i]; }

 private:
  static constexpr std::size_t kCacheLine = 64;
  struct Free {
    void operator()(Value* values) const { system::free_aligned(values); }
  };
  std::unique_ptr<Value, Free> values_;
  std::size_t size_ = 0;
};

}  // namespace flaunay::prove
