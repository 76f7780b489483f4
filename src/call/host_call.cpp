#include "call/host_call.hpp"

#include <cstdint>
#include <utility>

#include "blocks/run.hpp"
#include "blocks/small.hpp"
#include "call/modes.hpp"
#include "call/on_host.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "host/opencl/device.hpp"
#include "points/inspect.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {

using host::Arena;
using host::Buffer;

namespace {

// An array of results with three entries per triangle.
class Rows {
 public:
  Rows(host::Runtime& runtime, std::vector<std::int32_t>& values, bool is_wanted)
      : runtime_(runtime), values_(values), is_wanted_(is_wanted) {}

  // Touches the memory while the device computes; otherwise page faults would take longer than writing the
  // results.
  void reserve(std::size_t triangles) {
    if (is_wanted_) runtime_.resize(values_, 3 * triangles);
  }
  // The buffer to which kernels write this many triangles. If more than half of the memory is unused, it is
  // released.
  Buffer<cl_int> buffer(std::size_t triangles) {
    if (!is_wanted_) return {};
    values_.resize(3 * triangles);
    if (values_.capacity() / 2 > values_.size()) values_.shrink_to_fit();
    buffer_ = runtime_.output(values_);
    return buffer_;
  }
  void fetch_later() { runtime_.fetch_later(buffer_, values_); }

 private:
  host::Runtime& runtime_;
  std::vector<std::int32_t>& values_;
  bool is_wanted_;
  Buffer<cl_int> buffer_;
};

// Points and results in host memory. A device that works in host memory uses them in place.
class HostExchange : public blocks::Exchange {
 public:
  HostExchange(host::Runtime& runtime, const HostPoints& points, std::size_t n, const Options& options,
               Triangulation& result)
      : runtime_(runtime),
        points_(points),
        n_(n),
        result_(result),
        rows_{{runtime, result.triangles, true},
              {runtime, result.neighbors, options.neighbors},
              {runtime, result.halfedges, options.halfedges}},
        wants_links_(options.neighbors || options.halfedges) {}

  Buffer<cl_double> points() override {
    if (points_.wide != nullptr) return runtime_.view_later(points_.wide, 2 * n_);
    const auto wide = runtime_.arena().allocate<cl_double>(2 * n_);
    Arena::Scope scope(runtime_.arena());
    points::widen(runtime_, runtime_.view_later(points_.narrow, 2 * n_), 0, n_, wide);
    return wide;
  }

  Buffer<cl_int> representatives() override {
    runtime_.resize(result_.representatives, n_);
    representatives_ = runtime_.output(result_.representatives);
    return representatives_;
  }

  void while_device_computes() override {
    for (Rows& rows : rows_) rows.reserve(blocks::kMostTrianglesPerPoint * n_);
  }

  bool wants_links() const override { return wants_links_; }

  blocks::MeshBuffers mesh(const blocks::MeshSizes& sizes) override {
    result_.hull.resize(sizes.hull_vertices());
    hull_ = runtime_.output(result_.hull);
    return {rows_[0].buffer(sizes.triangles()), rows_[1].buffer(sizes.triangles()),
            rows_[2].buffer(sizes.triangles()), hull_};
  }

  void fetch() {
    runtime_.fetch_later(representatives_, result_.representatives);
    for (Rows& rows : rows_) rows.fetch_later();
    runtime_.fetch_later(hull_, result_.hull);
    runtime_.finish();
  }

 private:
  host::Runtime& runtime_;
  const HostPoints& points_;
  std::size_t n_;
  Triangulation& result_;
  Rows rows_[3];
  bool wants_links_;
  Buffer<cl_int> representatives_{}, hull_{};
};

// Whether the sets are triangulated on the calling thread.
bool are_small(const Tuning& tuning, const std::vector<std::size_t>& offsets) {
  if (offsets.back() > tuning.host_points) return false;
  for (std::size_t s = 1; s < offsets.size(); ++s) {
    if (offsets[s] - offsets[s - 1] > tuning.block_points) return false;
  }
  return true;
}

Triangulation triangulate_small(const HostPoints& points, const std::vector<std::size_t>& offsets,
                                const Options& options) {
  Triangulation result;
  const statistics::Phases phases(options);
  phases.progress("triangulate", 0);
  const double begin = host::now();
  const std::vector<double> doubles = widened(points, offsets.back());
  blocks::run_small(points.wide != nullptr ? points.wide : doubles.data(), offsets, options, result);
  result.statistics.device = host::kHostName;
  result.statistics.seconds = host::now() - begin;
  result.statistics.phases.push_back({"triangulate", result.statistics.seconds});
  phases.progress("output", 1);
  return result;
}

}  // namespace

std::vector<double> widened(const HostPoints& points, std::size_t n) {
  return points.narrow == nullptr ? std::vector<double>()
                                  : std::vector<double>(points.narrow, points.narrow + 2 * n);
}

Triangulation empty_result(Engine& self, std::size_t sets) {
  Triangulation result;
  result.statistics.device = self.runtime.name();
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);
  return result;
}

Triangulation triangulate_on(Engine& self, const HostPoints& points, const std::vector<std::size_t>& offsets,
                             const Options& options) {
  const std::size_t n = offsets.back();
  const std::size_t sets = offsets.size() - 1;
  Triangulation result = empty_result(self, sets);
  if (n == 0) return result;
  statistics::Phases phases(options, [&self] { return self.runtime.working_clock(); });
  const host::Runtime::BeforeCompiling announce(self.runtime, [&] { phases.interrupt("compiling kernels"); });
  self.begin_call(options.profile);
  if (self.workspace != nullptr) self.provide_memory(n, sets);
  Arena::Scope scope(self.persistent), scratch_scope(self.runtime.arena());
  self.persistent.reserve(n * blocks::kPersistentBytesPerPoint);
  const host::Runtime::Settled settled(self.runtime);
  HostExchange exchange(self.runtime, points, n, options, result);
  blocks::Outcome outcome = blocks::run(self.runtime, self.persistent, offsets, exchange, phases);
  exchange.fetch();
  phases.end("output");

  outcome.write(n, result.statistics);
  result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
  result.hull_offsets = std::move(outcome.sizes.hull_offsets);
  self.write_accounts(result.statistics);
  phases.write(result.statistics);
  phases.progress("output", 1);
  return result;
}

namespace {

// What fixed point cannot represent is computed by an engine with doubles.
Triangulation triangulate_on_either(Implementation& self, Engine& engine, const HostPoints& points,
                                    const std::vector<std::size_t>& offsets, const Options& options) {
  if (engine.has_doubles()) return triangulate_on(engine, points, offsets, options);
  const double begin = engine.runtime.working_clock();
  try {
    return triangulate_on(engine, points, offsets, options);
  } catch (const geometry::TooWideForFixedPoint& error) {
    const double seconds = engine.runtime.working_clock() - begin;
    Engine& other = self.with_doubles(self.for_host_memory());
    other.check_size(offsets.back());
    Triangulation result = triangulate_on(other, points, offsets, options);
    result.statistics.seconds += seconds;
    result.statistics.phases.insert(result.statistics.phases.begin(), {"inspect", seconds});
    add_note(engine, other, error.reason(), "triangulated", result.statistics);
    return result;
  }
}

}  // namespace

Triangulation triangulate(TriangulatorAccess::Implementation& self, const HostPoints& points,
                          const std::vector<std::size_t>& offsets, const Options& options) {
  const bool may_be_small = !self.is_named() && !options.profile;
  if (may_be_small && are_small(self.host_tuning(), offsets)) {
    return triangulate_small(points, offsets, options);
  }
  Engine& engine = self.for_host_memory();
  engine.check_size(offsets.back());
  if (may_be_small && are_small(tuning_of(engine.runtime), offsets)) {
    return triangulate_small(points, offsets, options);
  }
  return triangulate_on_either(self, engine, points, offsets, options);
}

}  // namespace flaunay::call
