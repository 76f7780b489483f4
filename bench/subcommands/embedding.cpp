// flaunay-bench embedding: what a program with an OpenCL context of its own asks of flaunay. Everything stays
// in device memory: calls, and what is derived of their results, beside the host's interface and CGAL.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/measuring/inputs.hpp"
#include "bench/measuring/timing.hpp"
#include "bench/peers/peer.hpp"
#include "tests/support/embedder.hpp"

namespace flaunay::bench::embedding {
namespace {

struct EmbeddingRequest : Request {
  std::size_t far_walks = 10000;
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
const std::pair<const char*, Parts> kMeasuredParts[] = {
    {"triangles", {true, false, false, false, false}},
    {"triangles, neighbors", {true, true, false, false, false}},
    {"all", {true, true, true, true, true}}};
constexpr std::pair<const char*, Precision> kPrecisions[] = {{"float64", Precision::float64},
                                                             {"float32", Precision::float32}};
constexpr std::pair<const char*, Start> kStarts[] = {{"cgal: last face", Start::last_face},
                                                     {"cgal: sorted, last face", Start::last_face_sorted},
                                                     {"cgal: hierarchy", Start::hierarchy}};

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
  template <typename Work>
  double seconds_to_completion(const Work& work) const {
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

/// Points, queries, and what is made of them. Jobs refer to it.
class Subject {
 public:
  Subject(Caller& caller, const std::vector<double>& coordinates, const std::vector<double>& queries)
      : caller_(caller),
        coordinates_memory_(caller.embedder.upload(coordinates)),
        queries_memory_(caller.embedder.upload(queries)),
        points_(points_in(coordinates_memory_, coordinates.size() / 2, Precision::float64)),
        query_points_(points_in(queries_memory_, queries.size() / 2, Precision::float64)) {
    caller_.seconds_to_completion([&](const Enqueue& enqueue) {
      caller_.embedded.triangulate(points_, mesh_, {true, true, false, true, true}, enqueue);
      make_locator(enqueue);
    });
  }
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  void add_nearest(std::vector<Job>& jobs, const char* operation) {
    add(jobs, operation, query_points_.count,
        [this](const Enqueue& enqueue) { locator_->nearest(query_points_, nearest_, enqueue); });
  }

  void add_all(std::vector<Job>& jobs) {
    // The locator before is released outside of the time that is taken.
    jobs.push_back({row("locator", "device", points_.count, points_.count), [this] {
                      locator_.reset();
                      return caller_.seconds_to_completion(
                          [this](const Enqueue& enqueue) { make_locator(enqueue); });
                    }});
    add(jobs, "locate", query_points_.count,
        [this](const Enqueue& enqueue) { locator_->locate(query_points_, located_, enqueue); });
    add_nearest(jobs, "nearest");
    // The first half of the coordinates will do as values.
    add(jobs, "interpolate", query_points_.count, [this](const Enqueue& enqueue) {
      locator_->interpolate(coordinates_memory_.get(), query_points_, interpolated_, enqueue);
    });
    add(jobs, "voronoi", points_.count,
        [this](const Enqueue& enqueue) { caller_.embedded.voronoi(points_, mesh_, voronoi_, enqueue); });
  }

 protected:
  Json row(const char* operation, const char* implementation, std::size_t count, std::size_t measured) const {
    return {{"operation", operation}, {"implementation", implementation},
            {"precision", "float64"}, {"n", points_.count},
            {"count", count},         {"measured", measured}};
  }

  Caller& caller_;
  testing::Memory coordinates_memory_, queries_memory_;
  DevicePoints points_, query_points_;
  DeviceTriangulation mesh_;
  std::unique_ptr<Locator> locator_;
  DeviceVoronoi voronoi_;
  DeviceBuffer located_, nearest_, interpolated_;

 private:
  void make_locator(const Enqueue& enqueue) {
    locator_ = std::make_unique<Locator>(caller_.embedded, points_, mesh_, enqueue);
  }
  template <typename Work>
  void add(std::vector<Job>& jobs, const char* operation, std::size_t count, const Work& work) {
    jobs.push_back({row(operation, "device", count, count),
                    [this, work] { return caller_.seconds_to_completion(work); }});
  }
};

/// All that is measured at one size, beside the host's interface and CGAL.
class Size : public Subject {
 public:
  Size(Caller& caller, const std::vector<double>& coordinates, const std::vector<double>& queries,
       std::size_t most_far_walks)
      : Subject(caller, coordinates, queries),
        coordinates_(coordinates),
        narrow_memory_(caller.embedder.upload(std::vector<float>(coordinates.begin(), coordinates.end()))),
        queries_(queries),
        far_queries_(queries.begin(), queries.begin() + static_cast<std::ptrdiff_t>(
                                                            std::min(queries.size(), 2 * most_far_walks))),
        cgal_(make_cgal_queries == nullptr ? nullptr : make_cgal_queries(coordinates)) {
    if (!cgal_) fmt::print(stderr, "not measured: cgal: this build is without it\n");
  }

  void add_jobs(std::vector<Job>& jobs) {
    for (const auto& [name, parts] : kMeasuredParts) add_triangulations(jobs, name, parts);
    add_all(jobs);
    if (!cgal_) return;
    for (std::size_t k = 0; k < std::size(kStarts); ++k)
      add_cgal(jobs, kStarts[k].first, kStarts[k].second, k);
    jobs.push_back({row("voronoi", "cgal", points_.count, points_.count),
                    [this] { return cgal_->voronoi(cgal_cell_sizes_); }});
  }

  /// What the first and the second call of a new triangulator do.
  void add_calls(Json& calls) const;

  /// Whether all runs had as many triangles, and all answers are CGAL's; says so if not. After the jobs.
  bool agree() const;

 private:
  DevicePoints points(Precision precision) const {
    return points_in(precision == Precision::float32 ? narrow_memory_ : coordinates_memory_, points_.count,
                     precision);
  }
  void check(std::size_t triangles, const char* what) {
    if (triangles == mesh_.triangle_offsets.back()) return;
    fmt::print(stderr, "WARNING: {} points: {} has {} triangles, the first had {}\n", points_.count, what,
               triangles, mesh_.triangle_offsets.back());
    triangles_agree_ = false;
  }
  Statistics call_host(const Parts& parts, bool profile) {
    flaunay::Options options;
    options.neighbors = parts.neighbors;
    options.halfedges = parts.halfedges;
    options.profile = profile;
    const auto mesh = caller_.host.triangulate(coordinates_.data(), points_.count, options);
    check(mesh.statistics.triangles, "the host's call");
    return mesh.statistics;
  }
  void add_triangulations(std::vector<Job>& jobs, const char* parts_name, const Parts& parts);
  void add_cgal(std::vector<Job>& jobs, const char* name, Start start, std::size_t k);

  std::vector<double> coordinates_;
  testing::Memory narrow_memory_;
  DeviceTriangulation result_;
  bool triangles_agree_ = true;
  std::vector<double> queries_, far_queries_;
  std::unique_ptr<CgalQueries> cgal_;
  // The last answers of each of CGAL's ways.
  std::vector<Corners> cgal_located_[std::size(kStarts)];
  std::vector<std::int32_t> cgal_nearest_[std::size(kStarts)], cgal_cell_sizes_;
};

void Size::add_triangulations(std::vector<Job>& jobs, const char* parts_name, const Parts& parts) {
  const auto add = [&](const char* implementation, const char* precision, std::function<double()> run) {
    const std::size_t n = points_.count;
    jobs.push_back({{{"operation", "triangulate"},
                     {"implementation", implementation},
                     {"parts", parts_name},
                     {"precision", precision},
                     {"n", n},
                     {"count", n},
                     {"measured", n}},
                    std::move(run)});
  };
  add("host", "float64", [this, parts] { return call_host(parts, false).seconds; });
  add("host, kernels", "float64", [this, parts] { return kernel_seconds(call_host(parts, true)); });
  for (const auto& [precision_name, some_precision] : kPrecisions) {
    const auto call = [this, parts, precision = some_precision](const Enqueue& enqueue) {
      caller_.embedded.triangulate(points(precision), result_, parts, enqueue);
    };
    add("device", precision_name, [this, call] {
      const double seconds = caller_.seconds_to_completion(call);
      check(result_.statistics.triangles, "the device's call");
      return seconds;
    });
    add("device, kernels", precision_name, [this, call] {
      Enqueue enqueue;
      enqueue.queue = caller_.profiling.get();
      enqueue.profile = true;
      call(enqueue);
      return kernel_seconds(result_.statistics);
    });
  }
}

void Size::add_cgal(std::vector<Job>& jobs, const char* name, Start start, std::size_t k) {
  const std::vector<double>& queries = start == Start::last_face ? far_queries_ : queries_;
  const double scale = static_cast<double>(queries_.size()) / static_cast<double>(queries.size());
  const auto add = [&](const char* operation, std::function<double()> run) {
    jobs.push_back({row(operation, name, query_points_.count, queries.size() / 2), std::move(run)});
  };
  add("locate", [=, this, &queries] { return scale * cgal_->locate(start, queries, cgal_located_[k]); });
  add("nearest", [=, this, &queries] { return scale * cgal_->nearest(start, queries, cgal_nearest_[k]); });
}

void Size::add_calls(Json& calls) const {
  for (const auto& [parts_name, some_parts] : kMeasuredParts) {
    for (const auto& [precision_name, some_precision] : kPrecisions) {
      Triangulator triangulator(caller_.embedder.context(), caller_.embedder.device());
      DeviceTriangulation result;
      for (const char* which : {"first", "second"}) {
        caller_.seconds_to_completion(
            [&, parts = some_parts, precision = some_precision](const Enqueue& enqueue) {
              triangulator.triangulate(points(precision), result, parts, enqueue);
            });
        const Statistics& s = result.statistics;
        calls.push_back({{"call", which},
                         {"parts", parts_name},
                         {"precision", precision_name},
                         {"n", points_.count},
                         {"host_waits", s.host_waits},
                         {"kernel_launches", s.kernel_launches},
                         {"bytes_to_host", s.bytes_to_host},
                         {"bytes_to_device", s.bytes_to_device},
                         {"device_allocations", s.device_allocations}});
      }
    }
  }
}

bool Size::agree() const {
  if (!cgal_) return triangles_agree_;
  bool all_agree = triangles_agree_;
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

/// Points on a circle, or on as many as there must be, of integers: one point is joined to all others of its
/// circle, and a walk along it would be long. Queries are anywhere inside.
std::unique_ptr<Subject> make_fan(Caller& caller, std::size_t n) {
  const std::vector<double> coordinates = make_input("integer-circle", n, 1).coordinates;
  double reach = 0;
  for (const double c : coordinates) reach = std::max(reach, std::abs(c));
  std::vector<double> queries = make_input("uniform", n, 2).coordinates;
  for (double& c : queries) c = reach * (2 * c - 1);
  return std::make_unique<Subject>(caller, coordinates, queries);
}

/// Points whose coordinates are float32 values, so that both precisions are the same points.
std::unique_ptr<Size> make_size(Caller& caller, std::size_t n, std::size_t far_walks) {
  std::vector<double> coordinates = make_input("uniform", n, 1).coordinates;
  for (double& c : coordinates) c = static_cast<double>(static_cast<float>(c));
  return std::make_unique<Size>(caller, coordinates, make_input("uniform", n, 2).coordinates, far_walks);
}

/// Calls from device memory beside the host's, and the targets of the largest size.
void add_ratios(Json& tables, const std::vector<Job>& jobs) {
  constexpr double kMost = 1.05;
  const Json largest = jobs.back().row["n"];
  for (const Job& job : jobs) {
    const Json& row = job.row;
    if (row["operation"] != "triangulate" || row["implementation"] != "device") continue;
    const auto over = [&](const char* implementation, const Json& precision) {
      const auto is_it = [&](const Job& other) {
        return other.row["implementation"] == implementation && other.row["n"] == row["n"] &&
               other.row["precision"] == precision && other.row.value("parts", "") == row["parts"];
      };
      return job.median() / std::find_if(jobs.begin(), jobs.end(), is_it)->median();
    };
    const double over_host_kernels = over("host, kernels", "float64");
    tables["ratios"].push_back({{"parts", row["parts"]},
                                {"precision", row["precision"]},
                                {"n", row["n"]},
                                {"device_over_host_kernels", over_host_kernels},
                                {"device_over_own_kernels", over("device, kernels", row["precision"])},
                                {"device_over_host", over("host", "float64")}});
    if (row["n"] != largest || row["precision"] != "float64") continue;
    tables["targets"].push_back(target("device to device / host's kernels, " + thousands(largest),
                                       row["parts"], kMost, kMost, over_host_kernels));
  }
}

Result measure_embedding(const EmbeddingRequest& request) {
  Caller caller(request.device);
  std::vector<std::size_t> numbers = request.quick ? std::vector<std::size_t>{500, 3000} : request.sizes;
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::unique_ptr<Size>> sizes;
  std::vector<std::unique_ptr<Subject>> fans;
  std::vector<Job> jobs;
  Result result(caller.host.device(), {"results", "calls", "ratios", "targets"});
  for (const std::size_t n : numbers) {
    sizes.push_back(make_size(caller, n, request.far_walks));
    fans.push_back(make_fan(caller, n));
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    sizes[k]->add_calls(result.tables["calls"]);
    sizes[k]->add_jobs(jobs);
    fans[k]->add_nearest(jobs, "nearest in a fan");
  }
  measure_rows(jobs, request.runs);
  for (Job& job : jobs) job.row["nanoseconds_each"] = 1e9 * job.median() / job.row["count"].get<double>();
  for (const auto& size : sizes) result.agree &= size->agree();
  result.tables["results"] = rows_of(jobs);
  add_ratios(result.tables, jobs);
  return result;
}

const Subcommand kSubcommand("embedding", "from device memory to device memory, and queries, beside CGAL's",
                             kHelp, measure_embedding, [](Options& options, EmbeddingRequest& request) {
                               options.sizes({10000, 100000, 1000000}, "numbers of points, and of queries")
                                   .add("--far-walks", request.far_walks,
                                        "most queries whose walks begin far away")
                                   .quick("a few thousand points")
                                   .runs();
                             });

}  // namespace
}  // namespace flaunay::bench::embedding
