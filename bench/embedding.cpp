// flaunay-bench embedding: what a program with an OpenCL context of its own asks of flaunay. Everything stays
// in device memory: calls, and what is derived of their results, beside the host's interface and CGAL.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "command.hpp"
#include "inputs.hpp"
#include "peer.hpp"
#include "tests/support/embedder.hpp"

namespace flaunay::bench::embedding {
namespace {

struct Request : Measurement {
  std::vector<std::size_t> sizes{10000, 100000, 1000000};
  std::size_t far_walks = 10000;
  bool quick = false;
};

constexpr const char* kHelp =
    "Uniform points whose coordinates are float32 values, so that both precisions are the same points, and "
    "as many uniform queries.\n\n"
    "triangulate:\n"
    "  host: Statistics::seconds of the host's interface, which the command uses: from points in host "
    "memory to results in host memory\n"
    "  host, kernels: the sum of its kernels' times, by Options::profile\n"
    "  device: from the call to the completion of its event, in the caller's context and queue, from points "
    "in a buffer to results in buffers, which are kept from call to call\n"
    "  device, kernels: the sum of its kernels' times, by Enqueue::profile on a profiling queue\n"
    "The host's results always have the hull and the representatives.\n\n"
    "The rest, device: from the call to the completion of its event, queries and results in buffers. "
    "locator: making a Locator, its memory included; nearest in a fan: points on a circle, one of them "
    "joined to all others, and queries inside; interpolate: values of float64; voronoi: circumcentres and "
    "cells.\n"
    "cgal: one thread, from queries in memory to indices in memory, its triangulation made before. Walks "
    "begin at the face where the last one ended, with queries as they come ('last face', of which "
    "--far-walks are measured and the time scaled) or spatially sorted, which is included; 'hierarchy': "
    "Triangulation_hierarchy_2, with queries as they come.\n\n"
    "All take turns; the first run of each is not counted; what is over soon is repeated within a run. The "
    "exit code is 1 if numbers of triangles differ, if a query is in another triangle than CGAL says "
    "(unless on an edge), its nearest point is not as near, or a cell has another number of corners; a "
    "missed target does not change it.";

/// Parts that are measured together, with a name for tables.
struct NamedParts {
  std::string name;
  Parts parts;
};
const std::vector<NamedParts> kMeasuredParts = {{"triangles", {true, false, false, false, false}},
                                                {"triangles, neighbors", {true, true, false, false, false}},
                                                {"all", {true, true, true, true, true}}};

struct NamedPrecision {
  const char* name;
  Precision precision;
};
constexpr NamedPrecision kPrecisions[] = {{"float64", Precision::float64}, {"float32", Precision::float32}};

struct NamedStart {
  const char* name;
  Start start;
};
constexpr NamedStart kStarts[] = {{"cgal: last face", Start::last_face},
                                  {"cgal: sorted, last face", Start::last_face_sorted},
                                  {"cgal: hierarchy", Start::hierarchy}};

/// One thing that is timed again and again.
struct Timed {
  Json row;  ///< operation, implementation, parts, precision, n and others: all but the times
  std::function<double()> run;
  double median = 0;
};
using AllTimed = std::vector<Timed>;

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

/// A program that has a context, queues and buffers of its own, and beside it a triangulator with its own.
struct Caller {
  explicit Caller(const std::string& device)
      : host(device),
        embedder(host.device_id()),
        profiling(embedder.make_queue(CL_QUEUE_PROFILING_ENABLE)),
        embedded(embedder.context(), embedder.device()) {}

  std::vector<std::int32_t> download(const DeviceBuffer& buffer) const {
    return embedder.download<std::int32_t>(buffer.memory(), buffer.bytes() / sizeof(std::int32_t));
  }

  /// Enqueues work on the caller's queue; seconds to the completion of its event.
  double seconds_to_completion(const std::function<void(const Enqueue&)>& work) const {
    cl_event event = nullptr;
    Enqueue enqueue;
    enqueue.queue = embedder.queue();
    enqueue.event = &event;
    const Stopwatch watch;
    work(enqueue);
    testing::check(clWaitForEvents(1, &event), "clWaitForEvents");
    const double seconds = watch.seconds();
    testing::check(clReleaseEvent(event), "clReleaseEvent");
    return seconds;
  }

  Triangulator host;  // first: it chooses the device
  testing::Embedder embedder;
  testing::Queue profiling;
  Triangulator embedded;
};

/// Triangulating the same points, from the host and from device memory. To stay where it is.
class TriangulationRuns {
 public:
  TriangulationRuns(Caller& caller, const std::vector<double>& coordinates)
      : caller_(caller),
        coordinates_(coordinates),
        wide_(caller.embedder.upload(coordinates)),
        narrow_(caller.embedder.upload(std::vector<float>(coordinates.begin(), coordinates.end()))) {}
  TriangulationRuns(const TriangulationRuns&) = delete;
  TriangulationRuns& operator=(const TriangulationRuns&) = delete;

  AllTimed rows();
  /// What the first and the second call of a new triangulator do.
  void add_calls(Json& calls) const;
  /// Whether all runs had as many triangles; says so if not.
  bool agree() const { return agree_; }

 private:
  std::size_t n() const { return coordinates_.size() / 2; }
  DevicePoints points(Precision precision) const {
    return points_in(precision == Precision::float32 ? narrow_ : wide_, n(), precision);
  }
  Statistics run_host(const Parts& parts, bool profile);
  void check(std::size_t triangles, const char* what);

  Caller& caller_;
  const std::vector<double>& coordinates_;
  testing::Memory wide_, narrow_;
  DeviceTriangulation result_;
  std::size_t triangles_ = 0;
  bool agree_ = true;
};

Statistics TriangulationRuns::run_host(const Parts& parts, bool profile) {
  Options options;
  options.neighbors = parts.neighbors;
  options.halfedges = parts.halfedges;
  options.profile = profile;
  const Statistics statistics = caller_.host.triangulate(coordinates_.data(), n(), options).statistics;
  check(statistics.triangles, "the host's call");
  return statistics;
}

void TriangulationRuns::check(std::size_t triangles, const char* what) {
  if (triangles_ == 0) triangles_ = triangles;
  if (triangles == triangles_) return;
  fmt::print(stderr, "WARNING: {} points: {} has {} triangles, the first had {}\n", n(), what, triangles,
             triangles_);
  agree_ = false;
}

AllTimed TriangulationRuns::rows() {
  AllTimed rows;
  for (const auto& [parts_name, some_parts] : kMeasuredParts) {
    const Parts parts = some_parts;
    const auto add = [&, &name = parts_name](const char* implementation, const char* precision,
                                             std::function<double()> run) {
      rows.push_back({{{"operation", "triangulate"},
                       {"implementation", implementation},
                       {"parts", name},
                       {"precision", precision},
                       {"n", n()},
                       {"count", n()},
                       {"measured", n()}},
                      std::move(run)});
    };
    add("host", "float64", [this, parts] { return run_host(parts, false).seconds; });
    add("host, kernels", "float64", [this, parts] { return kernel_seconds(run_host(parts, true)); });
    for (const auto& [precision_name, some_precision] : kPrecisions) {
      const Precision precision = some_precision;
      add("device", precision_name, [this, parts, precision] {
        const double seconds = caller_.seconds_to_completion([&](const Enqueue& enqueue) {
          caller_.embedded.triangulate(points(precision), result_, parts, enqueue);
        });
        check(result_.statistics.triangles, "the device's call");
        return seconds;
      });
      add("device, kernels", precision_name, [this, parts, precision] {
        Enqueue enqueue;
        enqueue.queue = caller_.profiling.get();
        enqueue.profile = true;
        caller_.embedded.triangulate(points(precision), result_, parts, enqueue);
        return kernel_seconds(result_.statistics);
      });
    }
  }
  return rows;
}

void TriangulationRuns::add_calls(Json& calls) const {
  for (const auto& [parts_name, parts] : kMeasuredParts) {
    for (const auto& [precision_name, precision] : kPrecisions) {
      Triangulator triangulator(caller_.embedder.context(), caller_.embedder.device());
      DeviceTriangulation result;
      for (const char* which : {"first", "second"}) {
        caller_.seconds_to_completion([&, &parts = parts, &precision = precision](const Enqueue& enqueue) {
          triangulator.triangulate(points(precision), result, parts, enqueue);
        });
        const Statistics& s = result.statistics;
        calls.push_back({{"call", which},
                         {"parts", parts_name},
                         {"precision", precision_name},
                         {"n", n()},
                         {"host_waits", s.host_waits},
                         {"kernel_launches", s.kernel_launches},
                         {"bytes_to_host", s.bytes_to_host},
                         {"bytes_to_device", s.bytes_to_device},
                         {"device_allocations", s.device_allocations}});
      }
    }
  }
}

/// What is derived from the triangulation of points, on as many queries, beside CGAL. To stay where it is.
class QueryRuns {
 public:
  /// Queries of CGAL's that walk far each: no more than so many.
  QueryRuns(Caller& caller, const std::vector<double>& coordinates, const std::vector<double>& queries,
            std::size_t most_far_walks);
  QueryRuns(const QueryRuns&) = delete;
  QueryRuns& operator=(const QueryRuns&) = delete;

  AllTimed rows();
  /// Whether all answers are CGAL's; says so if not. After the rows were run.
  bool agree() const;

 private:
  Json row(const char* operation, const char* implementation, std::size_t measured) const {
    return {{"operation", operation}, {"implementation", implementation}, {"precision", "float64"},
            {"n", points_.count},     {"count", query_points_.count},     {"measured", measured}};
  }
  void add_own_rows(AllTimed& rows);
  void add_cgal_rows(AllTimed& rows, const NamedStart& way, std::size_t k);

  Caller& caller_;
  std::vector<double> queries_, far_queries_;
  testing::Memory coordinates_memory_, queries_memory_, values_memory_;
  DevicePoints points_, query_points_;
  DeviceTriangulation mesh_;
  DeviceVoronoi voronoi_;
  std::unique_ptr<Locator> locator_;
  DeviceBuffer located_, nearest_, interpolated_;
  std::unique_ptr<CgalQueries> cgal_;
  // The last answers of each of CGAL's ways.
  std::vector<Corners> cgal_located_[std::size(kStarts)];
  std::vector<std::int32_t> cgal_nearest_[std::size(kStarts)], cgal_cell_sizes_;
};

QueryRuns::QueryRuns(Caller& caller, const std::vector<double>& coordinates,
                     const std::vector<double>& queries, std::size_t most_far_walks)
    : caller_(caller),
      queries_(queries),
      far_queries_(queries.begin(), queries.begin() + static_cast<std::ptrdiff_t>(
                                                          2 * std::min(queries.size() / 2, most_far_walks))),
      coordinates_memory_(caller.embedder.upload(coordinates)),
      queries_memory_(caller.embedder.upload(queries)),
      // The first half of the coordinates will do as values.
      values_memory_(caller.embedder.upload(coordinates)),
      points_(points_in(coordinates_memory_, coordinates.size() / 2, Precision::float64)),
      query_points_(points_in(queries_memory_, queries.size() / 2, Precision::float64)),
      cgal_(make_cgal_queries(coordinates)) {
  caller.seconds_to_completion([&](const Enqueue& enqueue) {
    caller_.embedded.triangulate(points_, mesh_, {true, true, false, true, true}, enqueue);
  });
  if (!cgal_) fmt::print(stderr, "not measured: cgal: this build is without it\n");
}

void QueryRuns::add_own_rows(AllTimed& rows) {
  const auto add = [&](const char* operation, const std::function<void(const Enqueue&)>& work) {
    rows.push_back({row(operation, "device", query_points_.count),
                    [this, work] { return caller_.seconds_to_completion(work); }});
  };
  // The locator before is released outside of the time that is taken.
  rows.push_back({row("locator", "device", points_.count), [this] {
                    locator_.reset();
                    return caller_.seconds_to_completion([&](const Enqueue& enqueue) {
                      locator_ = std::make_unique<Locator>(caller_.embedded, points_, mesh_, enqueue);
                    });
                  }});
  add("locate", [this](const Enqueue& enqueue) { locator_->locate(query_points_, located_, enqueue); });
  add("nearest", [this](const Enqueue& enqueue) { locator_->nearest(query_points_, nearest_, enqueue); });
  add("interpolate", [this](const Enqueue& enqueue) {
    locator_->interpolate(values_memory_.get(), query_points_, interpolated_, enqueue);
  });
  add("voronoi",
      [this](const Enqueue& enqueue) { caller_.embedded.voronoi(points_, mesh_, voronoi_, enqueue); });
}

void QueryRuns::add_cgal_rows(AllTimed& rows, const NamedStart& way, std::size_t k) {
  const Start start = way.start;
  const std::vector<double>& queries = start == Start::last_face ? far_queries_ : queries_;
  const double scale = static_cast<double>(queries_.size()) / static_cast<double>(queries.size());
  rows.push_back({row("locate", way.name, queries.size() / 2), [this, start, &queries, k, scale] {
                    return scale * cgal_->locate(start, queries, cgal_located_[k]);
                  }});
  rows.push_back({row("nearest", way.name, queries.size() / 2), [this, start, &queries, k, scale] {
                    return scale * cgal_->nearest(start, queries, cgal_nearest_[k]);
                  }});
}

AllTimed QueryRuns::rows() {
  AllTimed rows;
  add_own_rows(rows);
  if (!cgal_) return rows;
  for (std::size_t k = 0; k < std::size(kStarts); ++k) add_cgal_rows(rows, kStarts[k], k);
  rows.push_back(
      {row("voronoi", "cgal", points_.count), [this] { return cgal_->voronoi(cgal_cell_sizes_); }});
  return rows;
}

bool QueryRuns::agree() const {
  if (!cgal_) return true;
  bool all_agree = true;
  /// Counts the k below `count` for which wrong(k).
  const auto expect_none = [&](const char* what, std::size_t count, const auto& wrong) {
    std::size_t all_wrong = 0;
    for (std::size_t k = 0; k < count; ++k) all_wrong += wrong(k);
    if (all_wrong == 0) return;
    fmt::print(stderr, "WARNING: {} points: {} {} are not CGAL's\n", points_.count, all_wrong, what);
    all_agree = false;
  };
  expect_none("numbers of triangles", 1,
              [&](std::size_t) { return mesh_.triangle_offsets.back() != cgal_->triangles(); });
  const auto offsets = caller_.download(voronoi_.cell_offsets);
  expect_none("Voronoi cells", cgal_cell_sizes_.size(), [&](std::size_t i) {
    // CGAL has no cell for a duplicate.
    return cgal_cell_sizes_[i] != 0 && offsets[i + 1] - offsets[i] != cgal_cell_sizes_[i];
  });
  const auto triangles = caller_.download(mesh_.triangles);
  const auto located = caller_.download(located_), nearest = caller_.download(nearest_);
  for (const std::vector<Corners>& expected : cgal_located_) {
    expect_none("located triangles", expected.size(), [&](std::size_t q) {
      const Corners own =
          located[q] < 0 ? kOutside : sorted_corners(&triangles[3 * static_cast<std::size_t>(located[q])]);
      return expected[q] != kOnEdge && own != expected[q];
    });
  }
  for (const std::vector<std::int32_t>& expected : cgal_nearest_) {
    expect_none("nearest points", expected.size(), [&](std::size_t q) {
      return nearest[q] != expected[q] && !cgal_->equally_far(&queries_[2 * q], nearest[q], expected[q]);
    });
  }
  return all_agree;
}

/// Nearest points on a circle, or on as many as there must be, of integers: one point is joined to all others
/// of its circle, and a walk along it would be long. Queries are anywhere inside. To stay where it is.
class FanRuns {
 public:
  FanRuns(Caller& caller, std::size_t n) : caller_(caller) {
    const std::vector<double> coordinates = make_input("integer-circle", n, 1).coordinates;
    double reach = 0;
    std::vector<double> queries = make_input("uniform", n, 2).coordinates;
    for (const double c : coordinates) reach = std::max(reach, std::abs(c));
    for (double& c : queries) c = reach * (2 * c - 1);
    coordinates_memory_ = caller.embedder.upload(coordinates);
    queries_memory_ = caller.embedder.upload(queries);
    points_ = points_in(coordinates_memory_, coordinates.size() / 2, Precision::float64);
    query_points_ = points_in(queries_memory_, n, Precision::float64);
    caller_.seconds_to_completion([&](const Enqueue& enqueue) {
      caller_.embedded.triangulate(points_, mesh_, {true, true, false, true, true}, enqueue);
      locator_ = std::make_unique<Locator>(caller_.embedded, points_, mesh_, enqueue);
    });
  }
  FanRuns(const FanRuns&) = delete;
  FanRuns& operator=(const FanRuns&) = delete;

  AllTimed rows() {
    const Json row = {{"operation", "nearest in a fan"}, {"implementation", "device"},
                      {"precision", "float64"},          {"n", points_.count},
                      {"count", query_points_.count},    {"measured", query_points_.count}};
    return {{row, [this] {
               return caller_.seconds_to_completion(
                   [&](const Enqueue& enqueue) { locator_->nearest(query_points_, nearest_, enqueue); });
             }}};
  }

 private:
  Caller& caller_;
  testing::Memory coordinates_memory_, queries_memory_;
  DevicePoints points_, query_points_;
  DeviceTriangulation mesh_;
  std::unique_ptr<Locator> locator_;
  DeviceBuffer nearest_;
};

std::vector<double> rounded_to_float(std::vector<double> values) {
  for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  return values;
}

/// Everything that is measured at one size.
struct Size {
  Size(Caller& caller, std::size_t n, std::size_t far_walks)
      : coordinates(rounded_to_float(make_input("uniform", n, 1).coordinates)),
        triangulation(caller, coordinates),
        queries(caller, coordinates, make_input("uniform", n, 2).coordinates, far_walks),
        fan(caller, n) {}
  std::vector<double> coordinates;
  TriangulationRuns triangulation;
  QueryRuns queries;
  FanRuns fan;
};

std::string name_of(const Json& row) {
  return fmt::format("{}, {}, {}, {}", row.at("operation").get<std::string>(),
                     row.at("implementation").get<std::string>(), row.value("parts", "-"),
                     row.at("precision").get<std::string>());
}

/// In turns; the times become part of the rows.
void measure_rows(AllTimed& rows, int runs) {
  std::vector<Job> jobs;
  for (const Timed& timed : rows) {
    const std::string name = name_of(timed.row);
    jobs.push_back({fmt::format("{}, {} points", name, timed.row["n"].get<std::size_t>()), timed.run, name});
  }
  run_interleaved(jobs, runs);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    // A part of it that fails leaves nothing to compare.
    if (!jobs[j].skipped.empty()) throw Error(ErrorKind::internal, jobs[j].name + ": " + jobs[j].skipped);
    rows[j].median = summary(jobs[j].seconds).median;
    add_seconds(rows[j].row, jobs[j].seconds);
    rows[j].row["nanoseconds_each"] = 1e9 * rows[j].median / rows[j].row["count"].get<double>();
  }
}

/// Calls from device memory beside the host's, and the targets of the largest size.
void add_ratios(Json& tables, const AllTimed& rows) {
  constexpr double kMost = 1.05;
  for (const char* table : {"ratios", "targets"}) tables[table] = Json::array();
  const std::size_t largest = rows.back().row["n"];
  for (const Timed& timed : rows) {
    const Json& row = timed.row;
    if (row["operation"] != "triangulate" || row["implementation"] != "device") continue;
    const auto median = [&](const char* implementation, const Json& precision) {
      return std::find_if(rows.begin(), rows.end(),
                          [&](const Timed& candidate) {
                            const Json& other = candidate.row;
                            return other["implementation"] == implementation && other["n"] == row["n"] &&
                                   other["precision"] == precision &&
                                   other.value("parts", "") == row["parts"];
                          })
          ->median;
    };
    const double over_host_kernels = timed.median / median("host, kernels", "float64");
    tables["ratios"].push_back(
        {{"parts", row["parts"]},
         {"precision", row["precision"]},
         {"n", row["n"]},
         {"device_over_host_kernels", over_host_kernels},
         {"device_over_own_kernels", timed.median / median("device, kernels", row["precision"])},
         {"device_over_host", timed.median / median("host", "float64")}});
    if (row["n"] != largest || row["precision"] != "float64") continue;
    tables["targets"].push_back(target("device to device / host's kernels, " + thousands(largest),
                                       row["parts"], kMost, kMost, over_host_kernels));
  }
}

Result measure_embedding(const Request& request) {
  Caller caller(request.device);
  std::vector<std::size_t> numbers = request.quick ? std::vector<std::size_t>{500, 3000} : request.sizes;
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::unique_ptr<Size>> sizes;
  for (const std::size_t n : numbers) {
    sizes.push_back(std::make_unique<Size>(caller, n, request.far_walks));
  }
  Json calls = Json::array();
  AllTimed rows;
  for (const auto& size : sizes) {
    size->triangulation.add_calls(calls);
    append(rows, size->triangulation.rows());
    append(rows, size->queries.rows());
    append(rows, size->fan.rows());
  }
  measure_rows(rows, request.runs);

  Result result{caller.host.device()};
  for (const auto& size : sizes) {
    const bool both[] = {size->triangulation.agree(), size->queries.agree()};
    result.agree &= both[0] && both[1];
  }
  for (const Timed& timed : rows) result.tables["results"].push_back(timed.row);
  result.tables["calls"] = calls;
  add_ratios(result.tables, rows);
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      add_command(app, action, "embedding", "from device memory to device memory, and queries, beside CGAL's",
                  kHelp, request, measure_embedding);
  add_sizes_option(command, request->sizes, "numbers of points, and of queries");
  add_option(command, "--far-walks", request->far_walks, "most queries whose walks begin far away");
  command->add_flag("--quick", request->quick, "a few thousand points: shows that it works, and no more");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::embedding
