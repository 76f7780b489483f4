// The objects behind the handles of the C interface, and conversions between its structs and those of C++.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "c/enumerators.hpp"
#include "c/errors.hpp"
#include "c/members.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/neighbors.hpp"
#include "flaunay/research.hpp"
#include "flaunay/result_arrays.hpp"
#include "geometry/arguments.hpp"

namespace flaunay::c {

/// Statistics as a C struct. It refers to the statistics that were shown, which must outlive it.
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

/// A device as a C struct. It refers to info, which must outlive it.
flaunay_device_info view_of(const DeviceInfo& info);

/// A triangulation as a C struct. It refers to both, which must outlive it.
flaunay_mesh view_of(const Triangulation& triangulation, const StatisticsView& statistics);
flaunay_mesh view_of(const DeviceTriangulation& triangulation, const StatisticsView& statistics);
flaunay_constrained_arrays view_of(const ConstrainedTriangulation& triangulation);

flaunay_space view_of(const Space& space);
/// Null: the plane. Throws Error(usage) for unknown enumerators and for reserved members that are not 0.
Space to_space(const flaunay_space* space);

/// Copies of the caller's arrays. Throw Error(usage) for one that is null but has elements.
void copy_to(Triangulation& triangulation, const flaunay_mesh& mesh);
void copy_to(ConstrainedTriangulation& triangulation, const flaunay_mesh& mesh,
             const flaunay_constrained_arrays& arrays);
/// Copies rows of points, and their distances unless these are null.
inline void copy_to(const Neighbors& found, std::int32_t* points, double* distances) {
  std::copy(found.points.begin(), found.points.end(), points);
  if (distances != nullptr) std::copy(found.distances.begin(), found.distances.end(), distances);
}
/// `count` values; none for null, if that is allowed.
template <typename T>
std::vector<T> copied(const T* values, std::size_t count, const char* name, bool may_be_null = false) {
  if (values == nullptr && may_be_null) return {};
  check_array(values, count, name, kMostCountable);
  return {values, values + count};
}
/// `count` parts of `size` things; null if there is but one.
std::vector<std::size_t> copied_offsets(const std::size_t* offsets, std::size_t count, std::size_t size);

/// Null: the defaults. Throws Error(usage) for unknown enumerators, for reserved members that are not 0, and
/// for a space, which calls that have spaces read by to_space.
research::Options to_options(const flaunay_options* options, bool has_space = false);

/// The constraints of flaunay_constraints with their options.
struct AskedConstraints : Constraints, ConstrainedOptions {};
/// Throws Error(usage) for unknown enumerators, and for another mode than blocks.
AskedConstraints to_constraints(const flaunay_constraints& given, std::size_t sets,
                                const flaunay_options* options);

/// Null: the defaults. Throws Error(usage) for an unknown method and for reserved members that are not 0.
InterpolationOptions to_interpolation(const flaunay_interpolation_options* options);

/// Asks for the arrays of these bits of flaunay_part, which are known. 0: the defaults.
void request(unsigned parts, Options& options);
/// Bits of flaunay_part. Throws Error(usage) for an unknown bit. 0: the defaults.
Parts to_parts(unsigned parts);
unsigned to_bits(const Parts& parts);

/// The buffer of one part, where bit k stands for the k-th of these members. Throws Error(usage), which names
/// the result, for anything else.
template <typename Result, typename Buffers>
auto& buffer_of(Result& result, const Buffers& buffers, unsigned part, const char* name) {
  for (std::size_t k = 0; k < buffers.size(); ++k) {
    if (part == 1u << k) return result.*buffers[k];
  }
  throw Error(ErrorKind::usage, fmt::format("{} is not one part of {}", part, name));
}

/// Defines flaunay_NAME_destroy.
#define FLAUNAY_DESTROY(name) \
  void flaunay_##name##_destroy(flaunay_##name* handle) { delete handle; }

/// Defines a handle that holds a value of C++, and its flaunay_NAME_destroy.
#define FLAUNAY_HANDLE(name, Value) \
  struct flaunay_##name {           \
    Value cpp;                      \
  };                                \
  FLAUNAY_DESTROY(name)

/// Defines flaunay_NAME_MEMBER, which returns a value of what `handle` is.
#define FLAUNAY_ACCESSOR(type, name, member, value)                                    \
  type flaunay_##name##_##member(const flaunay_##name* result) {                       \
    return flaunay::c::read(result, [](const auto& handle) -> type { return value; }); \
  }

#define FLAUNAY_BUFFER(type, name, ...) &Result::name,
#define FLAUNAY_ARRAY_NAME(type, name, ...) #name,
/// Defines flaunay_device_NAME_create, _set_buffer and _buffer, with the arrays of a table, for which the
/// bits of Part stand. what, whole: the result's name in messages.
#define FLAUNAY_DEVICE_RESULT(name, Part, ARRAYS, what, whole)                                        \
  static auto& buffer_of_##name(auto& result, unsigned part) {                                        \
    using Result = decltype(flaunay_device_##name::cpp);                                              \
    static constexpr std::array kBuffers = {ARRAYS(FLAUNAY_BUFFER)};                                  \
    static_assert(                                                                                    \
        flaunay::c::are_parts<Part>(std::to_array<std::string_view>({ARRAYS(FLAUNAY_ARRAY_NAME)})));  \
    return flaunay::c::buffer_of(result, kBuffers, part, whole);                                      \
  }                                                                                                   \
  flaunay_status flaunay_device_##name##_create(flaunay_device_##name** result) {                     \
    return flaunay::c::create(result, [] { return std::make_unique<flaunay_device_##name>(); });      \
  }                                                                                                   \
  flaunay_status flaunay_device_##name##_set_buffer(flaunay_device_##name* result, unsigned part,     \
                                                    cl_mem memory) {                                  \
    return flaunay::c::guarded([&] {                                                                  \
      buffer_of_##name(flaunay::c::required(result, what).cpp, part) = flaunay::c::to_buffer(memory); \
    });                                                                                               \
  }                                                                                                   \
  cl_mem flaunay_device_##name##_buffer(const flaunay_device_##name* result, unsigned part) {         \
    return flaunay::c::read(                                                                          \
        result, [&](const auto& handle) { return buffer_of_##name(handle.cpp, part).memory(); });     \
  }

/// Null: one set. Throws Error(usage) unless the offsets go from 0 to n without decreasing.
std::vector<std::size_t> to_offsets(const std::size_t* offsets, std::size_t sets, std::size_t n);

DevicePoints to_points(const flaunay_device_points* points, const char* what = "the points");

/// Null: the defaults. Sets *enqueue->event to null.
Enqueue to_enqueue(const flaunay_enqueue* enqueue);

/// The caller's buffer; if memory is null, a buffer that flaunay will make.
inline DeviceBuffer to_buffer(cl_mem memory) {
  return memory != nullptr ? DeviceBuffer(memory) : DeviceBuffer();
}

/// Hands a buffer over that was made because the caller had none at this place.
void give(const DeviceBuffer& made, cl_mem& place);

/// A vector's elements; null if there are none.
template <typename T>
const T* elements(const std::vector<T>& values) {
  return values.empty() ? nullptr : values.data();
}

/// The number of sets; 0 before the first call, when there are no offsets.
inline std::size_t set_count(const std::vector<std::size_t>& offsets) {
  return std::max<std::size_t>(offsets.size(), 1) - 1;
}

/// The last offset; 0 before the first call, when there are no offsets.
inline std::size_t total(const std::vector<std::size_t>& offsets) {
  return offsets.empty() ? 0 : offsets.back();
}

}  // namespace flaunay::c

struct flaunay_triangulator {
  explicit flaunay_triangulator(flaunay::Triangulator made) : cpp(std::move(made)) {}
  /// The device, which is looked for when it is first asked for.
  const flaunay_device_info* device() const {
    if (!info_) {
      info_ = cpp.device();
      view_ = flaunay::c::view_of(*info_);
    }
    return &view_;
  }
  flaunay::Triangulator cpp;

 private:
  mutable std::optional<flaunay::DeviceInfo> info_;
  mutable flaunay_device_info view_{};
};

/// A triangulation, with constraints or without.
struct flaunay_triangulation {
  explicit flaunay_triangulation(flaunay::Triangulation computed) : held_(std::move(computed)) {
    show(plain());
  }
  explicit flaunay_triangulation(flaunay::ConstrainedTriangulation computed) : held_(std::move(computed)) {
    show(*constrained());
    constraints = flaunay::c::view_of(*constrained());
    flaunay::c::show<"bad_count">(constrained()->refinement, refinement);
    refinement.bad_count = constrained()->refinement.bad_triangles.size();
  }
  // The views refer to the other members.
  flaunay_triangulation(const flaunay_triangulation&) = delete;
  flaunay_triangulation& operator=(const flaunay_triangulation&) = delete;

  /// Null without constraints.
  const flaunay::ConstrainedTriangulation* constrained() const {
    return std::get_if<flaunay::ConstrainedTriangulation>(&held_);
  }
  /// Throws Error(usage) if it has constraints.
  const flaunay::Triangulation& plain() const {
    flaunay::expect(constrained() == nullptr,
                    "a constrained triangulation is not the dual of a Voronoi diagram");
    return std::get<flaunay::Triangulation>(held_);
  }

  flaunay_mesh view{};
  flaunay_constrained_arrays constraints{};
  flaunay_refinement_report refinement{};

 private:
  void show(const flaunay::Triangulation& mesh) {
    statistics_.show(mesh.statistics);
    view = flaunay::c::view_of(mesh, statistics_);
    space_ = flaunay::c::view_of(mesh.space);
    view.space = &space_;
  }

  flaunay_space space_{};
  std::variant<flaunay::Triangulation, flaunay::ConstrainedTriangulation> held_;
  flaunay::c::StatisticsView statistics_;
};

struct flaunay_device_triangulation {
  flaunay_device_triangulation() { clear(); }
  /// Before a call: views refer to what it replaces.
  void clear() {
    statistics_.clear();
    view = {};
    view.statistics = statistics_.get();
  }
  /// After a call.
  void show() {
    statistics_.show(cpp.statistics);
    view = flaunay::c::view_of(cpp, statistics_);
    space_ = flaunay::c::view_of(cpp.space);
    view.space = &space_;
  }
  flaunay::DeviceTriangulation cpp;
  flaunay_mesh view{};

 private:
  flaunay_space space_{};
  flaunay::c::StatisticsView statistics_;
};

struct flaunay_point_tree {
  flaunay::PointTree cpp;
};

struct flaunay_locator {
  flaunay::Locator cpp;
};

struct flaunay_voronoi {
  flaunay::Voronoi cpp;
};

struct flaunay_clipped_voronoi {
  flaunay::ClippedVoronoi cpp;
};

namespace flaunay::c {

/// Calls work(triangulator).
template <typename Work>
flaunay_status with(flaunay_triangulator* triangulator, const Work& work) {
  return guarded([&] { work(required(triangulator, "the triangulator").cpp); });
}

/// Calls work(triangulator, enqueue).
template <typename Work>
flaunay_status with(flaunay_triangulator* triangulator, const flaunay_enqueue* enqueue, const Work& work) {
  return guarded([&] {
    const Enqueue queued = to_enqueue(enqueue);
    work(required(triangulator, "the triangulator").cpp, queued);
  });
}

/// Makes a handle of what compute(triangulator) returns.
template <typename Handle, typename Compute>
flaunay_status make(flaunay_triangulator* triangulator, Handle** place, const Compute& compute) {
  return create(place, [&] {
    return std::unique_ptr<Handle>(new Handle{compute(required(triangulator, "the triangulator").cpp)});
  });
}

/// Copies what answer(locator) returns for m queries to the caller's array.
template <typename Handle, typename Value, typename Answer>
flaunay_status answer(Handle* locator, const double* queries, std::size_t m, Value* place,
                      const Answer& answer) {
  return guarded([&] {
    auto& cpp = required(locator, "the locator").cpp;
    check_queries(queries, m);
    check_array(place, m, "results");
    copy_to(place, answer(cpp), "results");
  });
}

}  // namespace flaunay::c
