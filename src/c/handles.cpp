#include "c/handles.hpp"

#include <CL/cl.h>
#include <fmt/format.h>

#include <cstdint>

#include "geometry/arguments.hpp"

namespace flaunay::c {
namespace {

[[noreturn]] void throw_usage(const std::string& message) { throw Error(ErrorKind::usage, message); }

// Bit k of flaunay_part stands for the k-th array.
constexpr unsigned bit_of(std::size_t k) { return 1u << k; }

void check_parts(unsigned parts) {
  // Arrays of spaces are computed whatever is asked for.
  constexpr unsigned kAll = bit_of(kTriangulationArrayCount) - 1;
  if (parts & ~kAll) throw_usage(fmt::format("there are no parts {:#x}", parts & ~kAll));
}

}  // namespace

void StatisticsView::show(const Statistics& statistics) {
  clear();
  for (const PhaseStatistics& phase : statistics.phases) {
    phases_.push_back({phase.name.c_str(), phase.seconds});
  }
  for (const KernelStatistics& kernel : statistics.kernels) {
    kernels_.push_back({kernel.name.c_str(), kernel.launches, kernel.seconds});
  }
  c::show<"phases", "phase_count", "kernels", "kernel_count">(statistics, view_);
  view_.phases = elements(phases_);
  view_.phase_count = phases_.size();
  view_.kernels = elements(kernels_);
  view_.kernel_count = kernels_.size();
}

void StatisticsView::clear() {
  view_ = {};
  view_.device = view_.note = "";
  phases_.clear();
  kernels_.clear();
}

flaunay_device_info view_of(const DeviceInfo& info) {
  flaunay_device_info view{};
  show(info, view);
  return view;
}

InterpolationOptions to_interpolation(const flaunay_interpolation_options* options) {
  InterpolationOptions result;
  if (options == nullptr) return result;
  take<"columns", "gradient_tolerance", "gradient_iterations">(*options, result);
  if (options->columns != 0) result.columns = options->columns;
  if (options->gradient_tolerance != 0) result.estimation.tolerance = options->gradient_tolerance;
  if (options->gradient_iterations != 0) result.estimation.iterations = options->gradient_iterations;
  return result;
}

namespace {

// The members that triangulations in host and in device memory have alike.
template <typename Mesh>
flaunay_mesh view_of_arrays(const Mesh& triangulation, const StatisticsView& statistics) {
  flaunay_mesh view{};
  show<"point_count", "set_count", "triangle_count", "hull_count", "hidden_count", "image_count",
       "statistics", "space">(triangulation, view);
  view.image_count = triangulation.images;
  view.statistics = statistics.get();
  return view;
}

}  // namespace

flaunay_mesh view_of(const Triangulation& triangulation, const StatisticsView& statistics) {
  flaunay_mesh view = view_of_arrays(triangulation, statistics);
  view.point_count = triangulation.representatives.size();
  view.set_count = set_count(triangulation.triangle_offsets);
  view.triangle_count = triangulation.triangles.size() / 3;
  view.hull_count = triangulation.hull.size();
  view.hidden_count = triangulation.hidden.size();
  return view;
}

flaunay_mesh view_of(const DeviceTriangulation& triangulation, const StatisticsView& statistics) {
  flaunay_mesh view = view_of_arrays(triangulation, statistics);
  view.point_count = triangulation.points;
  view.set_count = set_count(triangulation.point_offsets);
  view.triangle_count = total(triangulation.triangle_offsets);
  view.hull_count = total(triangulation.hull_offsets);
  view.hidden_count = triangulation.hidden_count;
  return view;
}

flaunay_space view_of(const Space& space) {
  flaunay_space view{};
  view.kind = static_cast<int>(space.kind);
  if (space.kind == SpaceKind::sphere) view.coordinates = static_cast<int>(space.coordinates);
  if (space.kind == SpaceKind::torus) {
    view.period_x = space.period.x;
    view.period_y = space.period.y;
    view.shear = space.period.shear;
  }
  return view;
}

Space to_space(const flaunay_space* given) {
  if (given == nullptr) return Space::plane();
  Space space = Space::plane();
  take<"period_x", "period_y", "shear">(*given, space);
  space.period = {given->period_x, given->period_y, given->shear};
  return space;
}

research::Options to_options(const flaunay_options* options, bool has_space) {
  research::Options result;
  if (options == nullptr) return result;
  take<"parts", "progress", "progress_data", "space">(*options, result);
  expect(has_space || options->space == nullptr, "this call has points in the plane: flaunay_options.space");
  check_parts(options->parts);
  request(options->parts, result);
  if (options->progress != nullptr) {
    result.progress = [call = options->progress, data = options->progress_data](const std::string& stage,
                                                                                int level, double done) {
      call(stage.c_str(), level, done, data);
    };
  }
  return result;
}

void request(unsigned parts, Options& options) {
  if (parts == 0) return;
  for_each_array([&](const auto& array, std::size_t k) {
    if (array.option != nullptr) options.*array.option = (parts & bit_of(k)) != 0;
  });
}

Parts to_parts(unsigned parts) {
  check_parts(parts);
  Parts result;
  if (parts == 0) return result;
  for_each_array([&](const auto& array, std::size_t k) { result.*array.part = (parts & bit_of(k)) != 0; });
  return result;
}

unsigned to_bits(const Parts& parts) {
  unsigned bits = 0;
  for_each_array([&](const auto& array, std::size_t k) {
    if (parts.*array.part) bits |= bit_of(k);
  });
  return bits;
}

std::vector<std::size_t> to_offsets(const std::size_t* offsets, std::size_t sets, std::size_t n) {
  if (offsets == nullptr) return {0, n};
  check_count(sets, "sets");
  std::vector<std::size_t> result(offsets, offsets + sets + 1);
  check_offsets(result, n);
  return result;
}

void give(const DeviceBuffer& made, cl_mem& place) {
  if (place != nullptr || made.memory() == nullptr) return;
  clRetainMemObject(made.memory());
  place = made.memory();
}

DevicePoints to_points(const flaunay_device_points* points, const char* what) {
  const flaunay_device_points& given = required(points, what);
  DevicePoints result;
  take<"offsets", "space">(given, result);
  if (given.offsets != nullptr) result.offsets = to_offsets(given.offsets, given.sets, given.count);
  result.space = to_space(given.space);
  return result;
}

Enqueue to_enqueue(const flaunay_enqueue* enqueue) {
  Enqueue result;
  if (enqueue == nullptr) return result;
  if (enqueue->event != nullptr) *enqueue->event = nullptr;
  take<"wait_for", "wait_for_count">(*enqueue, result);
  check_array(enqueue->wait_for, enqueue->wait_for_count, "events to wait for");
  result.wait_for.assign(enqueue->wait_for, enqueue->wait_for + enqueue->wait_for_count);
  return result;
}

}  // namespace flaunay::c
