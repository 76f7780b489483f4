#include "c/handles.hpp"

#include <CL/cl.h>
#include <fmt/format.h>

#include <cstdint>

#include "geometry/arguments.hpp"

namespace flaunay::c {
namespace {

using research::Cut;
using research::Finish;
using research::Hull;
using research::Mode;

[[noreturn]] void throw_usage(const std::string& message) { throw Error(ErrorKind::usage, message); }

// Bit k of flaunay_part stands for the k-th array.
constexpr unsigned bit_of(std::size_t k) { return 1u << k; }

void check_parts(unsigned parts) {
  // Those of spaces are computed whatever is asked for.
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
  view_.device = statistics.device.c_str();
  view_.points = statistics.points;
  view_.duplicates = statistics.duplicates;
  view_.triangles = statistics.triangles;
  view_.hull_vertices = statistics.hull_vertices;
  view_.seconds = statistics.seconds;
  view_.build_seconds = statistics.build_seconds;
  view_.kernel_launches = statistics.kernel_launches;
  view_.host_waits = statistics.host_waits;
  view_.bytes_to_device = statistics.bytes_to_device;
  view_.bytes_to_host = statistics.bytes_to_host;
  view_.device_allocations = statistics.device_allocations;
  view_.device_bytes_peak = statistics.device_bytes_peak;
  view_.undecided = statistics.undecided;
  view_.rounds = statistics.rounds;
  view_.round_points = statistics.round_points;
  view_.merged_points = statistics.merged_points;
  view_.phases = elements(phases_);
  view_.phase_count = phases_.size();
  view_.kernels = elements(kernels_);
  view_.kernel_count = kernels_.size();
  view_.note = statistics.note.c_str();
}

void StatisticsView::clear() {
  view_ = {};
  view_.device = view_.note = "";
  phases_.clear();
  kernels_.clear();
}

flaunay_device_info view_of(const DeviceInfo& info) {
  flaunay_device_info view{};
  view.name = info.name.c_str();
  view.platform = info.platform.c_str();
  view.vendor = info.vendor.c_str();
  view.driver = info.driver.c_str();
  view.version = info.version.c_str();
  view.type = info.type.c_str();
  view.compute_units = info.compute_units;
  view.clock_mhz = info.clock_mhz;
  view.memory_bytes = info.memory_bytes;
  view.available_bytes = info.available_bytes;
  view.largest_buffer_bytes = info.largest_buffer_bytes;
  view.local_memory_bytes = info.local_memory_bytes;
  view.work_group_size = info.work_group_size;
  view.fp64 = info.fp64;
  view.fixed_point = info.fixed_point;
  view.self_test_passed = info.self_test_passed;
  view.self_test_failure = info.self_test_failure.c_str();
  return view;
}

InterpolationOptions to_interpolation(const flaunay_interpolation_options* options) {
  InterpolationOptions result;
  if (options == nullptr) return result;
  check_reserved(*options, "flaunay_interpolation_options");
  result.method = to_enum<flaunay_interpolation, Interpolation>(options->method);
  if (options->columns != 0) result.columns = options->columns;
  if (options->has_fill != 0) result.fill = options->fill;
  result.gradients = options->gradients;
  result.device_gradients = options->device_gradients;
  if (options->gradient_tolerance != 0) result.estimation.tolerance = options->gradient_tolerance;
  if (options->gradient_iterations != 0) result.estimation.iterations = options->gradient_iterations;
  return result;
}

namespace {

// What triangulations in host and in device memory have alike.
template <typename Mesh>
flaunay_mesh view_of_sets(const Mesh& triangulation, const StatisticsView& statistics) {
  flaunay_mesh view{};
  view.image_count = triangulation.images;
  view.triangle_offsets = elements(triangulation.triangle_offsets);
  view.hull_offsets = elements(triangulation.hull_offsets);
  view.point_offsets = elements(triangulation.point_offsets);
  view.statistics = statistics.get();
  return view;
}

}  // namespace

flaunay_mesh view_of(const Triangulation& triangulation, const StatisticsView& statistics) {
  flaunay_mesh view = view_of_sets(triangulation, statistics);
  view.point_count = triangulation.representatives.size();
  view.set_count = set_count(triangulation.triangle_offsets);
  view.triangle_count = triangulation.triangles.size() / 3;
  view.hull_count = triangulation.hull.size();
#define VIEW(type, name, ...) view.name = elements(triangulation.name);
  FLAUNAY_TRIANGULATION_ARRAYS(VIEW)
  FLAUNAY_SPACE_ARRAYS(VIEW)
#undef VIEW
  view.hidden_count = triangulation.hidden.size();
  return view;
}

flaunay_mesh view_of(const DeviceTriangulation& triangulation, const StatisticsView& statistics) {
  flaunay_mesh view = view_of_sets(triangulation, statistics);
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
  check_reserved(*given, "flaunay_space");
  Space space = Space::plane().with_weights(given->weights);
  space.kind = to_enum<flaunay_space_kind, SpaceKind>(given->kind);
  space.coordinates = to_enum<flaunay_sphere_coordinates, SphereCoordinates>(given->coordinates);
  space.period = {given->period_x, given->period_y, given->shear};
  return space;
}

research::Options to_options(const flaunay_options* options, bool has_space) {
  research::Options result;
  if (options == nullptr) return result;
  check_reserved(*options, "flaunay_options");
  expect(has_space || options->space == nullptr, "this call has points in the plane: flaunay_options.space");
  check_parts(options->parts);
  request(options->parts, result);
  result.mode = to_enum<flaunay_mode, Mode>(options->mode);
  result.cut = to_enum<flaunay_cut, Cut>(options->cut);
  result.hull = to_enum<flaunay_hull, Hull>(options->hull);
  result.finish = to_enum<flaunay_finish, Finish>(options->finish);
  result.profile = options->profile != 0;
  result.partition_levels = options->partition_levels;
  result.threads = options->threads;
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

Precision to_precision(int precision) { return to_enum<flaunay_precision, Precision>(precision); }

void give(const DeviceBuffer& made, cl_mem& place) {
  if (place != nullptr || made.memory() == nullptr) return;
  clRetainMemObject(made.memory());
  place = made.memory();
}

DevicePoints to_points(const flaunay_device_points* points, const char* what) {
  const flaunay_device_points& given = required(points, what);
  check_reserved(given, "flaunay_device_points");
  DevicePoints result;
  result.memory = given.memory;
  result.count = given.count;
  result.precision = to_precision(given.precision);
  result.first = given.first;
  if (given.offsets != nullptr) result.offsets = to_offsets(given.offsets, given.sets, given.count);
  result.device_offsets = given.device_offsets;
  result.sets = given.sets;
  result.space = to_space(given.space);
  result.weights = given.weights;
  return result;
}

Enqueue to_enqueue(const flaunay_enqueue* enqueue) {
  Enqueue result;
  if (enqueue == nullptr) return result;
  if (enqueue->event != nullptr) *enqueue->event = nullptr;
  check_reserved(*enqueue, "flaunay_enqueue");
  result.queue = enqueue->queue;
  check_array(enqueue->wait_for, enqueue->wait_for_count, "events to wait for");
  result.wait_for.assign(enqueue->wait_for, enqueue->wait_for + enqueue->wait_for_count);
  result.event = enqueue->event;
  result.profile = enqueue->profile != 0;
  return result;
}

}  // namespace flaunay::c
