// The public call for points on a torus or a cylinder in device memory.
#include <algorithm>
#include <numeric>

#include "blocks/memory.hpp"
#include "blocks/run.hpp"
#include "call/frame.hpp"
#include "call/periodic.hpp"
#include "derived/periodic/on_device.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace {

// Triangulates sets again, with wider margins, until all are done.
class DeviceRounds {
 public:
  DeviceRounds(call::Frame& call, const Buffer<cl_double>& places, DevicePeriodicTriangulation& result)
      : call_(call),
        engine_(call.engine),
        places_(places),
        result_(result),
        offsets_(result.point_offsets),
        boxes_(periodic::find_boxes(call.runtime, places, offsets_, {result.period.x, result.period.y})) {}

  // The other arrays of the result.
  void run(const call::Output<cl_int>& triangles, const call::Output<cl_char>& periods,
           const call::Output<cl_int>& neighbors, const Buffer<cl_int>& representatives) {
    std::vector<std::size_t> waiting;
    for (std::size_t s = 0; s < boxes_.size(); ++s) {
      if (offsets_[s] == offsets_[s + 1]) continue;
      boxes_[s].margin = periodic::first_margin(boxes_[s], offsets_[s + 1] - offsets_[s]);
      waiting.push_back(s);
    }
    for (bool is_first = true; !waiting.empty(); is_first = false) {
      Arena::Scope scope(engine_.even), scratch_scope(call_.runtime.arena());
      const periodic::UnrolledSets plane = unroll(waiting);
      engine_.check_size(plane.offsets().back());
      const points::DeviceMesh mesh = triangulate(plane);
      const periodic::FoldedSets folded(call_.runtime, engine_.even, plane, mesh, representatives);
      if (is_first) {
        count_triangles(waiting, folded);
        const std::size_t count = result_.triangle_offsets.back();
        triangles_ = triangles.buffer(3 * count);
        periods_ = periods.buffer(6 * count);
        neighbors_ = neighbors.buffer(3 * count);
      }
      std::vector<std::size_t> first_rows;
      for (const std::size_t s : waiting) first_rows.push_back(result_.triangle_offsets[s]);
      folded.write(first_rows, triangles_, periods_, neighbors_);
      waiting = widened(waiting, plane, folded);
    }
  }

 private:
  periodic::UnrolledSets unroll(const std::vector<std::size_t>& sets) const {
    std::vector<std::size_t> first, last;
    std::vector<periodic::Box> boxes;
    for (const std::size_t s : sets) {
      first.push_back(offsets_[s]);
      last.push_back(offsets_[s + 1]);
      boxes.push_back(boxes_[s]);
    }
    return {call_.runtime, engine_.even, places_, first, last, std::move(boxes)};
  }

  points::DeviceMesh triangulate(const periodic::UnrolledSets& plane) const {
    const std::size_t count = plane.offsets().back();
    engine_.persistent.reserve(blocks::workspace_bytes(call_.runtime, count, plane.sets()).persistent);
    Arena::Scope scope(engine_.persistent), scratch_scope(call_.runtime.arena());
    return blocks::run(call_.runtime, engine_.persistent, plane.offsets(), plane.coordinates(), engine_.even);
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

  call::Frame& call_;
  call::Engine& engine_;
  Buffer<cl_double> places_;
  DevicePeriodicTriangulation& result_;
  const std::vector<std::size_t>& offsets_;
  std::vector<periodic::Box> boxes_;
  Buffer<cl_int> triangles_{}, neighbors_{};
  Buffer<cl_char> periods_{};
};

void compute(call::Frame& call, const DevicePoints& points, DevicePeriodicTriangulation& result) {
  const std::size_t n = points.count, most = blocks::kMostTrianglesPerPoint * n;
  const auto places = call.out<cl_double>(result.places, 2 * n, "places");
  const auto triangles = call.output<cl_int>(result.triangles, 3 * most, "triangles");
  const auto periods = call.output<cl_char>(result.offsets, 6 * most, "offsets");
  const auto neighbors = call.output<cl_int>(result.neighbors, 3 * most, "neighbors");
  const auto representatives = call.out<cl_int>(result.representatives, n, "representatives");
  call.check_distinct();
  if (n == 0) return;
  call.check_size(n);
  {
    Arena::Scope scope(call.runtime.arena());
    periodic::find_places(call.runtime, call.points(points), n, {result.period.x, result.period.y}, places);
  }
  DeviceRounds(call, places, result).run(triangles, periods, neighbors, representatives);
}

}  // namespace

void triangulate_periodic(Triangulator& triangulator, const DevicePoints& points, const Period& period,
                          DevicePeriodicTriangulation& result, const Enqueue& enqueue) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  call::take_turn(self, enqueue, [&] {
    call::check(period);
    const call::Place place = call::with_doubles(self, self.on_device());
    call::Frame call(self, place, enqueue);
    call.check(points, "points");
    place.device->check_size(points.count);
    call.begin();
    const double begin = place.device->runtime.working_clock();
    const periodic::Pair<double> lengths = periodic::rounded(period);
    result.period = {lengths[0], lengths[1]};
    result.point_offsets = call.offsets(points);
    result.triangle_offsets.assign(result.point_offsets.size(), 0);
    result.images = 0;
    result.statistics = {};
    compute(call, points, result);
    call.end();
    Statistics& statistics = result.statistics;
    statistics.device = call.runtime.name();
    statistics.points = points.count;
    statistics.triangles = result.triangle_offsets.back();
    statistics.seconds = place.device->runtime.working_clock() - begin;
    place.device->write_accounts(statistics);
    call::add_note(*place.device, call.engine, "a torus", "triangulated", statistics);
  });
}

}  // namespace flaunay
