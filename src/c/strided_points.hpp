// Points in memory with any strides, such as the fields of records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/chunks.hpp"

namespace flaunay::c {

/// float64 or float32, which need not be aligned.
class StridedNumbers {
 public:
  /// precision: a flaunay_precision. stride: bytes from one number to the next.
  StridedNumbers(const void* first, int precision, std::ptrdiff_t stride)
      : data_(static_cast<const char*>(first)), precision_(to_enum<Precision>(precision)), stride_(stride) {}

  /// Writes the numbers [first, first + count) to every step-th place.
  void read(std::uint64_t first, std::size_t count, double* to, std::size_t step) const {
    const char* const from = data_ + static_cast<std::ptrdiff_t>(first) * stride_;
    if (precision_ == Precision::float64) {
      copy<double>(from, count, to, step);
    } else {
      copy<float>(from, count, to, step);
    }
  }

 private:
  template <typename Number>
  void copy(const char* from, std::size_t count, double* to, std::size_t step) const {
    for (std::size_t k = 0; k < count; ++k, from += stride_, to += step) {
      Number number;
      std::memcpy(&number, from, sizeof number);
      *to = number;
    }
  }

  const char* data_;
  Precision precision_;
  std::ptrdiff_t stride_;
};

class StridedPoints : public PointSource {
 public:
  explicit StridedPoints(const flaunay_strided_points& given)
      : n_(given.count),
        x_(given.coordinates, given.precision, given.point_stride),
        y_(given.coordinates == nullptr
               ? nullptr
               : static_cast<const char*>(given.coordinates) + (n_ > 0 ? given.coordinate_stride : 0),
           given.precision, given.point_stride) {
    check_reserved(given);
    check_array(given.coordinates, n_, "points", kMostPointsInChunks);
  }

  std::uint64_t size() const override { return n_; }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    x_.read(first, count, coordinates, 2);
    y_.read(first, count, coordinates + 1, 2);
  }

 private:
  std::uint64_t n_;
  StridedNumbers x_, y_;
};

}  // namespace flaunay::c
