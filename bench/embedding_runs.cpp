#include "embedding_runs.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

namespace flaunay::bench {
namespace {

constexpr Start kStarts[] = {Start::last_face, Start::last_face_sorted, Start::hierarchy};

const char* name_of(Precision precision) { return precision == Precision::float32 ? "float32" : "float64"; }

double kernel_seconds(const Statistics& statistics) {
  return std::accumulate(statistics.kernels.begin(), statistics.kernels.end(), 0.0,
                         [](double sum, const KernelStatistics& kernel) { return sum + kernel.seconds; });
}

DevicePoints points_in(const testing::Memory& memory, std::size_t count, Precision precision) {
  DevicePoints points;
  points.memory = memory.get();
  points.count = count;
  points.precision = precision;
  return points;
}

}  // namespace

const std::vector<NamedParts>& measured_parts() {
  static const std::vector<NamedParts> kParts = {{"triangles", {true, false, false, false, false}},
                                                 {"triangles, neighbors", {true, true, false, false, false}},
                                                 {"all", {true, true, true, true, true}}};
  return kParts;
}

// ---- The caller

Caller::Caller(const std::string& device)
    : host_(device),
      embedder_(host_.device_id()),
      profiling_(embedder_.make_queue(CL_QUEUE_PROFILING_ENABLE)),
      embedded_(embedder_.context(), embedder_.device()) {}

testing::Memory Caller::upload(const std::vector<double>& values, Precision precision) const {
  if (precision == Precision::float64) return embedder_.upload(values);
  return embedder_.upload(std::vector<float>(values.begin(), values.end()));
}

double Caller::seconds_to_completion(const std::function<void(const Enqueue&)>& work) const {
  cl_event event = nullptr;
  Enqueue enqueue;
  enqueue.queue = embedder_.queue();
  enqueue.event = &event;
  const Stopwatch watch;
  work(enqueue);
  testing::check(clWaitForEvents(1, &event), "clWaitForEvents");
  const double seconds = watch.seconds();
  testing::check(clReleaseEvent(event), "clReleaseEvent");
  return seconds;
}

Enqueue Caller::profiled() const {
  Enqueue enqueue;
  enqueue.queue = profiling_.get();
  enqueue.profile = true;
  return enqueue;
}

// ---- Triangulating

TriangulationRuns::TriangulationRuns(Caller& caller, const std::vector<double>& coordinates)
    : caller_(caller),
      coordinates_(coordinates),
      wide_(caller.upload(coordinates, Precision::float64)),
      narrow_(caller.upload(coordinates, Precision::float32)) {}

DevicePoints TriangulationRuns::points(Precision precision) const {
  return points_in(precision == Precision::float32 ? narrow_ : wide_, coordinates_.size() / 2, precision);
}

Triangulation TriangulationRuns::run_host(const Parts& parts, bool profile) {
  Options options;
  options.neighbors = parts.neighbors;
  options.halfedges = parts.halfedges;
  options.profile = profile;
  Triangulation mesh = caller_.host().triangulate(coordinates_.data(), coordinates_.size() / 2, options);
  check(mesh.statistics.triangles, "the host's call");
  return mesh;
}

void TriangulationRuns::run_device(Precision precision, const Parts& parts, const Enqueue& enqueue) {
  caller_.embedded().triangulate(points(precision), result_, parts, enqueue);
}

void TriangulationRuns::check(std::size_t triangles, const std::string& what) {
  if (triangles_ == 0) triangles_ = triangles;
  if (triangles == triangles_) return;
  fmt::print(stderr, "WARNING: {} points: {} has {} triangles, the first had {}\n", coordinates_.size() / 2,
             what, triangles, triangles_);
  agree_ = false;
}

Timed TriangulationRuns::row(const std::string& implementation, const std::string& parts, Precision precision,
                             std::function<double()> run) const {
  const std::size_t n = coordinates_.size() / 2;
  return {"triangulate", implementation, parts, name_of(precision), n, n, n, std::move(run)};
}

void TriangulationRuns::add_host_rows(std::vector<Timed>& rows, const NamedParts& named) {
  rows.push_back(row("host", named.name, Precision::float64,
                     [this, &named] { return run_host(named.parts, false).statistics.seconds; }));
  rows.push_back(row("host, kernels", named.name, Precision::float64,
                     [this, &named] { return kernel_seconds(run_host(named.parts, true).statistics); }));
}

void TriangulationRuns::add_device_rows(std::vector<Timed>& rows, const NamedParts& named,
                                        Precision precision) {
  rows.push_back(row("device", named.name, precision, [this, &named, precision] {
    const double seconds = caller_.seconds_to_completion(
        [&](const Enqueue& enqueue) { run_device(precision, named.parts, enqueue); });
    check(result_.statistics.triangles, "the device's call");
    return seconds;
  }));
  rows.push_back(row("device, kernels", named.name, precision, [this, &named, precision] {
    run_device(precision, named.parts, caller_.profiled());
    return kernel_seconds(result_.statistics);
  }));
}

std::vector<Timed> TriangulationRuns::rows() {
  std::vector<Timed> rows;
  for (const NamedParts& named : measured_parts()) {
    add_host_rows(rows, named);
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      add_device_rows(rows, named, precision);
    }
  }
  return rows;
}

std::vector<Calls> TriangulationRuns::first_calls() const {
  std::vector<Calls> all;
  for (const NamedParts& named : measured_parts()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      Triangulator triangulator = caller_.new_triangulator();
      DeviceTriangulation result;
      const auto call = [&] {
        caller_.seconds_to_completion([&](const Enqueue& enqueue) {
          triangulator.triangulate(points(precision), result, named.parts, enqueue);
        });
        return result.statistics;
      };
      Statistics first = call();
      all.push_back({named.name, name_of(precision), coordinates_.size() / 2, std::move(first), call()});
    }
  }
  return all;
}

// ---- Queries

QueryRuns::QueryRuns(Caller& caller, const std::vector<double>& coordinates,
                     const std::vector<double>& queries, std::size_t most_far_walks)
    : caller_(caller),
      queries_(queries),
      far_queries_(queries.begin(), queries.begin() + static_cast<std::ptrdiff_t>(
                                                          2 * std::min(queries.size() / 2, most_far_walks))),
      coordinates_memory_(caller.upload(coordinates, Precision::float64)),
      queries_memory_(caller.upload(queries, Precision::float64)),
      values_memory_(caller.upload(
          {coordinates.begin(), coordinates.begin() + static_cast<std::ptrdiff_t>(coordinates.size() / 2)},
          Precision::float64)),
      points_(points_in(coordinates_memory_, coordinates.size() / 2, Precision::float64)),
      query_points_(points_in(queries_memory_, queries.size() / 2, Precision::float64)) {
  caller.seconds_to_completion([&](const Enqueue& enqueue) {
    caller_.embedded().triangulate(points_, mesh_, {true, true, false, true, true}, enqueue);
  });
  if (CgalQueries::is_there()) {
    cgal_ = std::make_unique<CgalQueries>(coordinates);
  } else {
    fmt::print(stderr, "not measured: cgal: this build is without it\n");
  }
}

Timed QueryRuns::row(const std::string& operation, const std::string& implementation, std::size_t measured,
                     std::function<double()> run) const {
  const bool of_points = operation == "locator" || operation == "voronoi";
  return {operation, implementation, "", "float64", n(), of_points ? n() : query_points_.count,
          measured,  std::move(run)};
}

void QueryRuns::add_own_rows(std::vector<Timed>& rows) {
  const auto add = [&](const std::string& operation, std::size_t count,
                       const std::function<void(const Enqueue&)>& work) {
    rows.push_back(
        row(operation, "device", count, [this, work] { return caller_.seconds_to_completion(work); }));
  };
  const std::size_t m = query_points_.count;
  // The one before goes outside of the time that is taken.
  rows.push_back(row("locator", "device", n(), [this] {
    locator_.reset();
    return caller_.seconds_to_completion([&](const Enqueue& enqueue) {
      locator_ = std::make_unique<Locator>(caller_.embedded(), points_, mesh_, enqueue);
    });
  }));
  add("locate", m, [this](const Enqueue& enqueue) { locator_->locate(query_points_, located_, enqueue); });
  add("nearest", m, [this](const Enqueue& enqueue) { locator_->nearest(query_points_, nearest_, enqueue); });
  add("interpolate", m, [this](const Enqueue& enqueue) {
    locator_->interpolate(values_memory_.get(), query_points_, interpolated_, enqueue);
  });
  add("voronoi", n(),
      [this](const Enqueue& enqueue) { caller_.embedded().voronoi(points_, mesh_, voronoi_, enqueue); });
}

void QueryRuns::add_cgal_rows(std::vector<Timed>& rows, Start start) {
  const std::vector<double>& queries = start == Start::last_face ? far_queries_ : queries_;
  const std::size_t measured = queries.size() / 2;
  const double scale = static_cast<double>(query_points_.count) / static_cast<double>(measured);
  const std::string name = "cgal: " + to_string(start);
  const std::size_t way = cgal_located_.size();
  cgal_located_.emplace_back();
  cgal_nearest_.emplace_back();
  rows.push_back(row("locate", name, measured, [this, start, &queries, way, scale] {
    Located located = cgal_->locate(start, queries);
    cgal_located_[way] = std::move(located.corners);
    return scale * located.seconds;
  }));
  rows.push_back(row("nearest", name, measured, [this, start, &queries, way, scale] {
    NearestPoints nearest = cgal_->nearest(start, queries);
    cgal_nearest_[way] = std::move(nearest.points);
    return scale * nearest.seconds;
  }));
}

std::vector<Timed> QueryRuns::rows() {
  std::vector<Timed> rows;
  add_own_rows(rows);
  if (!cgal_) return rows;
  for (const Start start : kStarts) add_cgal_rows(rows, start);
  rows.push_back(row("voronoi", "cgal", n(), [this] {
    cgal_voronoi_ = cgal_->voronoi();
    return cgal_voronoi_.seconds;
  }));
  return rows;
}

std::size_t QueryRuns::wrong_triangles(const std::vector<std::int32_t>& located,
                                       const std::vector<Corners>& expected) const {
  const auto triangles = caller_.download<std::int32_t>(mesh_.triangles);
  std::size_t wrong = 0;
  for (std::size_t q = 0; q < expected.size(); ++q) {
    if (expected[q] == kOnEdge) continue;
    const Corners own =
        located[q] < 0 ? kOutside : sorted_corners(&triangles[3 * static_cast<std::size_t>(located[q])]);
    wrong += own != expected[q];
  }
  return wrong;
}

std::size_t QueryRuns::wrong_points(const std::vector<std::int32_t>& nearest,
                                    const std::vector<std::int32_t>& expected) const {
  std::size_t wrong = 0;
  for (std::size_t q = 0; q < expected.size(); ++q) {
    wrong += nearest[q] != expected[q] && !cgal_->equally_far(&queries_[2 * q], nearest[q], expected[q]);
  }
  return wrong;
}

std::size_t QueryRuns::wrong_cells() const {
  const auto offsets = caller_.download<std::int32_t>(voronoi_.cell_offsets);
  const CgalVoronoi& expected = cgal_voronoi_;
  std::size_t wrong = 0;
  for (std::size_t v = 0; v < expected.points.size(); ++v) {
    const auto i = static_cast<std::size_t>(expected.points[v]);
    wrong += offsets[i + 1] - offsets[i] != expected.cell_offsets[v + 1] - expected.cell_offsets[v];
  }
  return wrong;
}

bool QueryRuns::agree() const {
  if (!cgal_) return true;
  bool all_agree = true;
  const auto expect_none = [&](std::size_t wrong, const char* what) {
    if (wrong == 0) return;
    fmt::print(stderr, "WARNING: {} points: {} {} are not CGAL's\n", n(), wrong, what);
    all_agree = false;
  };
  const std::size_t triangles = mesh_.triangle_offsets.back();
  expect_none(triangles != cgal_->triangles() ? triangles : 0, "triangles");
  expect_none(wrong_cells(), "Voronoi cells");
  const auto located = caller_.download<std::int32_t>(located_);
  const auto nearest = caller_.download<std::int32_t>(nearest_);
  for (const auto& expected : cgal_located_)
    expect_none(wrong_triangles(located, expected), "located triangles");
  for (const auto& expected : cgal_nearest_) expect_none(wrong_points(nearest, expected), "nearest points");
  return all_agree;
}

}  // namespace flaunay::bench
