// The public calls for points on a torus or a cylinder.
#include "space/periodic/triangulate_on_torus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

#include "blocks/memory.hpp"
#include "blocks/run.hpp"
#include "blocks/weighted.hpp"
#include "flaunay/sphere.hpp"
#include "geometry/arguments.hpp"
#include "host/launch/vector_operations.hpp"
#include "prove/periodic_proof.hpp"
#include "space/periodic/fold.hpp"
#include "space/spaces.hpp"
#include "space/triangulate.hpp"

namespace flaunay {

void call::check(const Period& period) {
  const auto is_length = [](double x) { return (x >= 0x1p-900 && x <= 0x1p900) || x == HUGE_VAL; };
  const auto check_lengths = [&](bool are_possible, const char* why) {
    expect(are_possible,
           [&] { return fmt::format("the period {} x {} is not possible{}", period.x, period.y, why); });
  };
  check_lengths(is_length(period.x) && is_length(period.y) && std::min(period.x, period.y) < HUGE_VAL,
                ": both must be from 2^-900 to 2^900 (about 1.2e-271 to 8.4e270), or one of them infinite; "
                "scale points and period");
  expect(std::isfinite(period.shear),
         [&] { return fmt::format("the shear {} is not finite", period.shear); });
  const bool is_sheared = period.shear != 0 && std::remainder(period.shear, period.x) != 0;
  expect(period.shear == 0 || std::isfinite(period.x + period.y),
         [&] { return fmt::format("a cylinder has no shear, but {} is given", period.shear); });
  constexpr double kMostSheared = 64;
  check_lengths(!is_sheared || period.x <= kMostSheared * period.y,
                " with a shear: x is more than 64 times as long as y");
  constexpr double kMostUnequal = 1 << 30;
  check_lengths(std::max(period.x, period.y) <= kMostUnequal * std::min(period.x, period.y) ||
                    std::isinf(period.x) || std::isinf(period.y),
                ": one is more than 2^30 times as long as the other one");
}

void call::check_on_torus(const Triangulation& mesh) {
  expect(mesh.space.kind == SpaceKind::torus, "the triangulation is not one on a torus or a cylinder");
  check(mesh.space.period);
  expect(do_arrays_fit(mesh, -1) && mesh.corner_offsets.size() == 2 * mesh.triangles.size() &&
             are_indices(mesh.hidden, mesh.representatives.size()) &&
             std::is_sorted(mesh.hidden.begin(), mesh.hidden.end()),
         "the arrays are not those of a triangulation on a torus or a cylinder");
}

void call::check_with_places(const Triangulation& mesh) {
  check_on_torus(mesh);
  const periodic::Lattice lattice = periodic::lattice_of(mesh.space.period);
  for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
    const double x = mesh.places[2 * i], y = mesh.places[2 * i + 1];
    const geometry::Point place = kernel::place_in({x, y}, &lattice);
    if (std::isfinite(x) && std::isfinite(y) && place.x == x && place.y == y) continue;
    throw Error(
        ErrorKind::usage,
        fmt::format("place {} of the triangulation on a torus or a cylinder is none: ({}, {})", i, x, y));
  }
}

namespace {

using host::Arena;
using host::Buffer;

// Triangulates sets again, with wider margins, until all are done.
template <typename Result>
class Rounds {
 public:
  // weights: null if points have none.
  Rounds(call::Implementation& self, call::Frame& call, const Buffer<cl_double>& places,
         const periodic::Lattice& lattice, const points::Weights* weights, Result& result)
      : self_(self),
        call_(call),
        engine_(call.engine),
        weights_(weights),
        places_(places),
        result_(result),
        offsets_(result.point_offsets),
        boxes_(periodic::find_boxes(call.runtime, places, offsets_, lattice)) {}

  // The other arrays of the result.
  void run(const call::Output<cl_int>& triangles, const call::Output<cl_char>& periods,
           const call::Output<cl_int>& neighbors, const Buffer<cl_int>& representatives) {
    std::vector<std::size_t> waiting;
    for (std::size_t s = 0; s < boxes_.size(); ++s) {
      if (offsets_[s] == offsets_[s + 1]) continue;
      boxes_[s].margin = periodic::first_margin(boxes_[s], offsets_[s + 1] - offsets_[s]);
      waiting.push_back(s);
    }
    const Arena::Scope hidden_scope(engine_.odd);
    if (weights_ != nullptr) {
      hidden_.by_point = engine_.odd.allocate<cl_uchar>(offsets_.back());
      call_.runtime.fill<cl_uchar>(hidden_.by_point, offsets_.back(), 0);
    }
    for (bool is_first = true; !waiting.empty(); is_first = false) {
      Arena::Scope scope(engine_.even), scratch_scope(call_.runtime.arena());
      const periodic::UnrolledSets plane = unroll(waiting);
      const points::DeviceMesh mesh = triangulate(plane, result_);
      const periodic::FoldedSets folded(call_.runtime, engine_.even, plane, mesh, representatives,
                                        weights_ != nullptr ? &hidden_ : nullptr);
      if (is_first) duplicates_ = folded.duplicates();
      if (weights_ != nullptr && !are_done(folded, waiting.size())) {
        // How many triangles there are is known when all sets are done.
        widened(waiting, plane, folded);
        continue;
      }
      if (is_first || weights_ != nullptr) {
        count_triangles(waiting, folded);
        const std::size_t count = result_.triangle_offsets.back();
        periods_ = periods.buffer(6 * count);
        if (!is_in_place()) {
          triangles_ = triangles.buffer(3 * count);
          neighbors_ = neighbors.buffer(3 * count);
        }
      }
      std::vector<std::size_t> first_rows;
      for (const std::size_t s : waiting) first_rows.push_back(result_.triangle_offsets[s]);
      if (is_in_place()) {
        if (folded.is_done(0)) {
          folded.write(first_rows, mesh.triangles, periods_, mesh.neighbors);
          take_rows(result_);
        }
      } else {
        folded.write(first_rows, triangles_, periods_, neighbors_);
      }
      waiting = widened(waiting, plane, folded);
    }
    if (weights_ != nullptr) write_hidden();
    call::write_counts(duplicates_, result_);
  }

 private:
  // Whether the rows of a set in host memory stay in the arrays that they have in the plane.
  bool is_in_place() const { return std::is_same_v<Result, Triangulation> && boxes_.size() == 1; }

  // The images of a set in host memory go behind the places.
  periodic::UnrolledSets::MakeRoom make_room(Triangulation& result) {
    if (!is_in_place()) return nullptr;
    return [&](std::size_t count) {
      call_.runtime.resize(result.places, 2 * count);
      return places_ = call_.in(result.places);
    };
  }
  static periodic::UnrolledSets::MakeRoom make_room(DeviceTriangulation&) { return nullptr; }

  periodic::UnrolledSets unroll(const std::vector<std::size_t>& sets) {
    std::vector<std::size_t> first, last;
    std::vector<periodic::Box> boxes;
    for (const std::size_t s : sets) {
      first.push_back(offsets_[s]);
      last.push_back(offsets_[s + 1]);
      boxes.push_back(boxes_[s]);
    }
    return {call_.runtime, engine_.even, places_, first, last, std::move(boxes), make_room(result_)};
  }

  static bool are_done(const periodic::FoldedSets& folded, std::size_t sets) {
    for (std::size_t k = 0; k < sets; ++k) {
      if (!folded.is_done(k)) return false;
    }
    return true;
  }
  void write_hidden() {
    Arena::Scope scope(call_.runtime.arena());
    const auto [hidden, count] = host::pack_positions(call_.runtime, hidden_.by_point, offsets_.back(), 1);
    call_.runtime.copy(hidden, 0, weights_->hidden(count), 0, count);
  }

  points::DeviceMesh triangulate(const periodic::UnrolledSets& plane, DeviceTriangulation&) {
    const std::size_t count = plane.offsets().back();
    engine_.check_size(count);
    engine_.persistent.reserve(blocks::workspace_bytes(call_.runtime, count, plane.sets()).persistent);
    points::Weights weights;
    if (weights_ != nullptr) {
      weights = {plane.weights(call_.runtime, engine_.even, weights_->by_point), weights_->solver,
                 [&](std::size_t hidden) {
                   hidden_.count = hidden;
                   return hidden_.in_plane = engine_.even.allocate<cl_int>(hidden);
                 },
                 numbers_in(plane)};
    }
    Arena::Scope scope(engine_.persistent), scratch_scope(call_.runtime.arena());
    return blocks::run(call_.runtime, engine_.persistent, plane.offsets(), plane.coordinates(), engine_.even,
                       weights_ != nullptr ? &weights : nullptr);
  }
  points::DeviceMesh triangulate(const periodic::UnrolledSets& plane, Triangulation& result) {
    const auto* const coordinates =
        reinterpret_cast<const double*>(host::address_of(plane.coordinates().memory()));
    const call::HostPoints points{coordinates, nullptr, plane.offsets().back()};
    if (weights_ != nullptr) {
      const auto weights = plane.weights(call_.runtime, engine_.even, weights_->by_point);
      const auto* const values = reinterpret_cast<const double*>(host::address_of(weights.memory()));
      planar_ = call::triangulate(
          self_, points,
          call::HostWeights{values, weights_->solver, planar_hidden_, nullptr, numbers_in(plane)},
          plane.offsets(), {});
      hidden_.in_plane = call_.in(planar_hidden_);
      hidden_.count = planar_hidden_.size();
    } else {
      planar_ = call::triangulate(self_, points, plane.offsets(), {});
    }
    result.statistics = std::move(planar_.statistics);
    points::DeviceMesh mesh;
    mesh.triangle_offsets = planar_.triangle_offsets;
    mesh.triangles = call_.in(planar_.triangles);
    mesh.neighbors = call_.in(planar_.neighbors);
    mesh.representatives = call_.in(planar_.representatives);
    return mesh;
  }
  // The numbers of points by their places in the plane.
  static std::function<std::size_t(std::size_t)> numbers_in(const periodic::UnrolledSets& plane) {
    return [&plane](std::size_t v) { return plane.number(v); };
  }
  void take_rows(DeviceTriangulation&) {}
  void take_rows(Triangulation& result) {
    result.triangles = std::move(planar_.triangles);
    result.neighbors = std::move(planar_.neighbors);
    result.places.resize(2 * offsets_.back());
    for (auto* const rows : {&result.triangles, &result.neighbors})
      rows->resize(3 * result.triangle_offsets.back());
  }

  void count_triangles(const std::vector<std::size_t>& sets, const periodic::FoldedSets& folded) {
    std::vector<std::size_t>& all = result_.triangle_offsets;
    for (std::size_t k = 0; k < sets.size(); ++k) all[sets[k] + 1] = folded.expected(k);
    std::partial_sum(all.begin(), all.end(), all.begin());
  }

  // The sets that are not done.
  std::vector<std::size_t> widened(const std::vector<std::size_t>& sets, const periodic::UnrolledSets& plane,
                                   const periodic::FoldedSets& folded) {
    std::vector<std::size_t> waiting;
    for (std::size_t k = 0; k < sets.size(); ++k) {
      result_.images += plane.images(k);
      if (folded.is_done(k)) continue;
      periodic::widen(boxes_[sets[k]], sets[k]);
      waiting.push_back(sets[k]);
    }
    return waiting;
  }

  call::Implementation& self_;
  call::Frame& call_;
  call::Engine& engine_;
  const points::Weights* weights_;
  Buffer<cl_double> places_;
  Result& result_;
  const std::vector<std::size_t>& offsets_;
  std::vector<periodic::Box> boxes_;
  std::size_t duplicates_ = 0;
  Triangulation planar_;  // in host memory
  std::vector<cl_int> planar_hidden_;
  periodic::HiddenPoints hidden_;  // if points have weights
  Buffer<cl_int> triangles_{}, neighbors_{};
  Buffer<cl_char> periods_{};
};

// weights: null if points have none.
template <typename Points, typename Result, typename Weights>
void compute(call::Implementation& self, call::Frame& call, const Points& points,
             const std::vector<std::size_t>& offsets, const Period& period, Result& result,
             const Weights* weights) {
  const std::size_t n = points.count, most = blocks::kMostTrianglesPerPoint * n;
  const periodic::Lattice lattice = periodic::lattice_of(period);
  result.space = Space::torus(periodic::period_of(lattice));
  result.point_offsets = offsets;
  result.triangle_offsets.assign(offsets.size(), 0);
  result.images = 0;
  result.statistics = {};
  const std::size_t room = std::is_same_v<Result, Triangulation> ? n / 4 : 0;  // for images
  const auto places = call.template output<cl_double>(result.places, 2 * (n + room), "places").buffer(2 * n);
  const auto triangles = call.template output<cl_int>(result.triangles, 3 * most, "triangles");
  const auto periods = call.template output<cl_char>(result.corner_offsets, 6 * most, "offsets");
  const auto neighbors = call.template output<cl_int>(result.neighbors, 3 * most, "neighbors");
  const auto representatives = call.template out<cl_int>(result.representatives, n, "representatives");
  const std::optional<points::Weights> by_point = call::weights_in(call, n, weights);
  call.check_distinct();
  if (n > 0) {
    {
      Arena::Scope scope(call.runtime.arena());
      periodic::find_places(call.runtime, call.points(points), n, lattice, places);
    }
    Rounds<Result>(self, call, places, lattice, by_point ? &*by_point : nullptr, result)
        .run(triangles, periods, neighbors, representatives);
  }
  call.end();
}

}  // namespace

namespace call {
namespace {

Triangulation triangulate_on_torus(Implementation& self, const HostPoints& points,
                                   const std::vector<std::size_t>& offsets, const Space& space,
                                   const Options& /*options*/) {
  check(space.period);
  check_points(points.wide, points.count);
  Triangulation result;
  const HostWeights with{space.weights, &blocks::kWeightedSolver, result.hidden};
  Frame call(self.native_for(points.count));
  compute(self, call, points, offsets, space.period, result, space.weights != nullptr ? &with : nullptr);
  return result;
}

void triangulate_on_torus(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                          const Parts& /*parts*/, const Enqueue& enqueue) {
  check(points.space.period);
  const Place place = with_doubles(self, self.on_device());
  Frame call(self, place, enqueue);
  call.check(points, "points", SpaceKind::torus, true);
  place.device->check_size(points.count);
  call.check_size(points.count);
  call.begin();
  const double begin = place.device->runtime.working_clock();
  const DeviceWeights with{points.weights, &blocks::kWeightedSolver, result.hidden, &result.hidden_count};
  compute(self, call, points, call.offsets(points), points.space.period, result,
          points.weights != nullptr ? &with : nullptr);
  result.points = points.count;
  result.parts = kPartsInSpace;
  result.hull_offsets.clear();
  Statistics& statistics = result.statistics;
  statistics.device = call.runtime.name();
  statistics.seconds = place.device->runtime.working_clock() - begin;
  place.device->write_accounts(statistics);
  add_note(*place.device, call.engine, "a torus", "triangulated", statistics);
}

std::string find_problem_on_torus(const double* points, const std::vector<std::size_t>& offsets,
                                  const Space& space, const Triangulation& mesh) {
  check(space.period);
  check_on_torus(mesh);
  if (offsets != mesh.point_offsets) return "the sets have other points";
  const periodic::Lattice lattice = periodic::lattice_of(space.period);
  check_points(points, offsets.back());
  std::string problem = prove::find_problem(mesh, space.weights);
  if (!problem.empty()) return problem;
  const Period rounded = periodic::period_of(lattice), made = mesh.space.period;
  if (made.x != rounded.x || made.y != rounded.y || made.shear != rounded.shear)
    return "the period is another one";
  const std::vector<double> places = places_of(points, offsets.back(), space);
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k] != mesh.places[k]) return fmt::format("point {} has another place", k / 2);
  }
  return problem;
}

std::unique_ptr<nearest::Tree> tree_on_torus(Triangulator& triangulator, const Triangulation& mesh) {
  check_with_places(mesh);
  const periodic::Lattice lattice = periodic::lattice_of(mesh.space.period);
  periodic::Box box = periodic::box_of(mesh.places.data(), 0, mesh.places.size() / 2, lattice);
  for (const double length : lattice.reach) {
    if (std::isfinite(length)) box.margin = std::max(box.margin, length / 2);
  }
  const periodic::Plane plane =
      periodic::plane_of(Engine::of_thread().runtime, mesh.places, mesh.point_offsets, {box});
  std::vector<std::int32_t> originals;
  for (const std::uint64_t image : plane.images)
    originals.push_back(static_cast<std::int32_t>(kernel::point_of(image)));
  return nearest::tree_of_images(triangulator, plane.coordinates, std::move(originals), mesh.space);
}

}  // namespace

const SpaceCalls kOnTorus{.refusal_of_polygons = "cells on a torus are not clipped to a polygon",
                          .triangulate = triangulate_on_torus,
                          .triangulate_on_device = triangulate_on_torus,
                          .find_problem = find_problem_on_torus,
                          .places =
                              [](host::Runtime& runtime, const double* points, std::size_t n,
                                 const Space& space, const char* what) {
                                check(space.period);
                                return periodic::to_places(runtime, points, n,
                                                           periodic::lattice_of(space.period), what);
                              },
                          .returns_places = true,
                          .check_cells = periodic::check_cells,
                          .cells = periodic::make_cells,
                          .tree = tree_on_torus};

}  // namespace call

}  // namespace flaunay
