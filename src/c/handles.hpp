// What the C interface's handles hold, and its structs as those of C++ and back.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "c/errors.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/flaunay.hpp"

namespace flaunay::c {

/// Statistics as C sees them; refers to what was shown, which must stay.
class StatisticsView {
 public:
  void show(const Statistics& statistics);
  void clear();
  const flaunay_statistics* get() const { return &view_; }

 private:
  flaunay_statistics view_{};
  std::vector<flaunay_phase> phases_;
  std::vector<flaunay_kernel> kernels_;
};

/// Refers to info, which must stay.
flaunay_device_info view_of(const DeviceInfo& info);

/// Throws Error(usage) for enumerators and reserved members that are not known. Null: the defaults.
Options to_options(const flaunay_options* options);

/// Throws Error(usage) for a bit that is none.
Parts to_parts(unsigned parts);
unsigned to_bits(const Parts& parts);

/// One set if offsets is null. Throws Error(usage) if they do not increase from 0 to n.
std::vector<std::size_t> to_offsets(const std::size_t* offsets, std::size_t sets, std::size_t n);

DevicePoints to_points(const flaunay_device_points* points);

/// Null: the defaults. Sets the event to null.
Enqueue to_enqueue(const flaunay_enqueue* enqueue);

/// The caller's buffer, or none of its own yet if memory is null.
inline DeviceBuffer to_buffer(cl_mem memory) {
  return memory != nullptr ? DeviceBuffer(memory) : DeviceBuffer();
}

/// A vector's elements; null if there are none.
template <typename T>
const T* elements(const std::vector<T>& values) {
  return values.empty() ? nullptr : values.data();
}

/// The number of sets that have these offsets, which are empty before the first call.
inline std::size_t set_count(const std::vector<std::size_t>& offsets) {
  return std::max<std::size_t>(offsets.size(), 1) - 1;
}

/// The last offset, 0 before the first call.
inline std::size_t total(const std::vector<std::size_t>& offsets) {
  return offsets.empty() ? 0 : offsets.back();
}

}  // namespace flaunay::c

struct flaunay_triangulator {
  explicit flaunay_triangulator(flaunay::Triangulator made)
      : cpp(std::move(made)), info(cpp.device()), info_view(flaunay::c::view_of(info)) {}
  flaunay::Triangulator cpp;
  flaunay::DeviceInfo info;
  flaunay_device_info info_view;
};

struct flaunay_triangulation {
  explicit flaunay_triangulation(flaunay::Triangulation computed) : cpp(std::move(computed)) {
    statistics.show(cpp.statistics);
  }
  flaunay::Triangulation cpp;
  flaunay::c::StatisticsView statistics;
};

struct flaunay_device_triangulation {
  flaunay_device_triangulation() { statistics.clear(); }
  flaunay::DeviceTriangulation cpp;
  flaunay::c::StatisticsView statistics;
};
