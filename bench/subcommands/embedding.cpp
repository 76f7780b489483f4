// flaunay-bench embedding: calls of a program that has its own OpenCL context. Points and results, and arrays
// derived from these, stay in device memory. Compared with the host's interface and CGAL.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "bench/measuring/command.hpp"
#include "bench/peers/peer.hpp"
#include "tests/support/embedder.hpp"

namespace flaunay::bench::embedding {
namespace {

struct EmbeddingRequest : Request {
  std::size_t far_walks = 10000;
};

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

DevicePoints points_in(const testing::Memory& memory, std::size_t count,
                       Precision precision = Precision::float64) {
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

/// One of CGAL's ways, and its last answers.
struct OfCgal {
  std::shared_ptr<CgalQueries> queries;
  std::vector<Corners> located;
  std::vector<std::int32_t> nearest;
  std::size_t cell_corners = 0;
};

/// Points, queries, and their results. Jobs refer to it.
class Subject {
 public:
  Subject(Caller& caller, std::vector<double> coordinates, std::vector<double> queries)
      : caller_(caller),
        coordinates_(std::move(coordinates)),
        queries_(std::move(queries)),
        wide_(caller.embedder.upload(coordinates_)),
        narrow_(caller.embedder.upload(std::vector<float>(coordinates_.begin(), coordinates_.end()))),
        queries_memory_(caller.embedder.upload(queries_)),
        n_(coordinates_.size() / 2),
        points_(points_in(wide_, n_)),
        query_points_(points_in(queries_memory_, n_)) {
    caller_.seconds_to_completion([this](const Enqueue& enqueue) {
      caller_.embedded.triangulate(points_, mesh_, {true, true, false, true, true}, enqueue);
      locator_ = std::make_unique<Locator>(caller_.embedded, points_, mesh_, enqueue);
    });
  }
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  void add_nearest(Jobs& jobs, const char* operation) {
    add_on_device(jobs, operation,
                  [this](const Enqueue& enqueue) { locator_->nearest(query_points_, nearest_, enqueue); });
  }
  void add_triangulations(Jobs& jobs, const char* parts_name, const Parts& parts);
  void add_queries(Jobs& jobs);
  void add_cgal(Jobs& jobs, std::size_t most_far_walks);

  /// Whether all answers are CGAL's; says so if not. After the jobs.
  bool agrees_with_cgal() const;

 private:
  Json row(const char* operation, const char* implementation) const {
    return {{"operation", operation},
            {"implementation", implementation},
            {"precision", "float64"},
            {"n", n_},
            {"measured", n_}};
  }
  template <typename Work>
  void add_on_device(Jobs& jobs, const char* operation, const Work& work) {
    jobs.push_back({row(operation, "device"), [this, work] { return caller_.seconds_to_completion(work); }});
  }
  DevicePoints points(Precision precision) const {
    return points_in(precision == Precision::float32 ? narrow_ : wide_, n_, precision);
  }
  Statistics call_host(const Parts& parts, bool profile) {
    flaunay::Options options;
    options.neighbors = parts.neighbors;
    options.halfedges = parts.halfedges;
    options.profile = profile;
    return caller_.host.triangulate(coordinates_.data(), n_, options).statistics;
  }

  Caller& caller_;
  std::vector<double> coordinates_, queries_, far_queries_;
  testing::Memory wide_, narrow_, queries_memory_;
  std::size_t n_;
  DevicePoints points_, query_points_;
  DeviceTriangulation mesh_, result_;
  std::unique_ptr<Locator> locator_;
  DeviceVoronoi voronoi_;
  DeviceBuffer located_, nearest_, interpolated_;
  OfCgal cgal_[std::size(kStarts)];
};

void Subject::add_triangulations(Jobs& jobs, const char* parts_name, const Parts& parts) {
  const auto add = [&](const char* implementation, const char* precision, std::function<Outcome()> run) {
    const Json keys{{"parts", parts_name}, {"precision", precision}};
    jobs.push_back(
        {changed(row("triangulate", implementation), keys), std::move(run), "", std::to_string(n_)});
  };
  add("host", "float64", [this, parts]() -> Outcome {
    const Statistics statistics = call_host(parts, false);
    return {statistics.seconds, statistics.triangles};
  });
  add("host, kernels", "float64", [this, parts]() -> Outcome {
    const Statistics statistics = call_host(parts, true);
    return {kernel_seconds(statistics), statistics.triangles};
  });
  for (const auto& [precision_name, some_precision] : kPrecisions) {
    const auto call = [this, parts, precision = some_precision](const Enqueue& enqueue) {
      caller_.embedded.triangulate(points(precision), result_, parts, enqueue);
    };
    add("device", precision_name, [this, call]() -> Outcome {
      Outcome outcome(caller_.seconds_to_completion(call));
      const Statistics& statistics = result_.statistics;
      outcome.details = {{"triangles", statistics.triangles},
                         {"host_waits", statistics.host_waits},
                         {"kernel_launches", statistics.kernel_launches},
                         {"bytes_to_host", statistics.bytes_to_host},
                         {"bytes_to_device", statistics.bytes_to_device},
                         {"device_allocations", statistics.device_allocations}};
      return outcome;
    });
    add("device, kernels", precision_name, [this, call]() -> Outcome {
      Enqueue enqueue;
      enqueue.queue = caller_.profiling.get();
      enqueue.profile = true;
      call(enqueue);
      return {kernel_seconds(result_.statistics), result_.statistics.triangles};
    });
  }
}

void Subject::add_queries(Jobs& jobs) {
  const auto make_locator = [this](const Enqueue& enqueue) {
    locator_ = std::make_unique<Locator>(caller_.embedded, points_, mesh_, enqueue);
  };
  // The locator before is released outside of the time that is taken.
  jobs.push_back({row("locator", "device"), [this, make_locator] {
                    locator_.reset();
                    return caller_.seconds_to_completion(make_locator);
                  }});
  add_on_device(jobs, "locate",
                [this](const Enqueue& enqueue) { locator_->locate(query_points_, located_, enqueue); });
  add_nearest(jobs, "nearest");
  // The first half of the coordinates will do as values.
  add_on_device(jobs, "interpolate", [this](const Enqueue& enqueue) {
    locator_->interpolate(wide_.get(), query_points_, interpolated_, enqueue);
  });
  add_on_device(jobs, "voronoi", [this](const Enqueue& enqueue) {
    caller_.embedded.voronoi(points_, mesh_, voronoi_, enqueue);
  });
}

void Subject::add_cgal(Jobs& jobs, std::size_t most_far_walks) {
  if (make_cgal_queries == nullptr) {
    fmt::print(stderr, "not measured: cgal: this build is without it\n");
    return;
  }
  const std::size_t far_walks = std::min(n_, most_far_walks);
  far_queries_.assign(queries_.begin(), queries_.begin() + static_cast<std::ptrdiff_t>(2 * far_walks));
  for (std::size_t k = 0; k < std::size(kStarts); ++k) {
    const auto& [name, start] = kStarts[k];
    OfCgal& own = cgal_[k];
    own.queries = make_cgal_queries(coordinates_, start);
    const std::vector<double>& queries = start == Start::last_face ? far_queries_ : queries_;
    const double scale = static_cast<double>(queries_.size()) / static_cast<double>(queries.size());
    const auto add = [&, name = name](const char* operation, std::function<Outcome()> run) {
      jobs.push_back({changed(row(operation, name), {{"measured", queries.size() / 2}}), std::move(run)});
    };
    add("locate", [=, &own, &queries] { return scale * own.queries->locate(queries, own.located); });
    add("nearest", [=, &own, &queries] { return scale * own.queries->nearest(queries, own.nearest); });
  }
  jobs.push_back(
      {row("voronoi", "cgal"), [this] { return cgal_[0].queries->voronoi(cgal_[0].cell_corners); }});
}

bool Subject::agrees_with_cgal() const {
  constexpr double kRounding = 1e-12;
  if (!cgal_[0].queries) return true;
  bool all_agree = true;
  /// Counts the k below `count` for which wrong(k).
  const auto expect_none = [&](const char* what, std::size_t count, const auto& wrong) {
    std::size_t all_wrong = 0;
    for (std::size_t k = 0; k < count; ++k) all_wrong += wrong(k);
    if (all_wrong == 0) return;
    fmt::print(stderr, "WARNING: {} points: {} {} are not CGAL's\n", n_, all_wrong, what);
    all_agree = false;
  };
  const auto distance = [&](std::size_t q, std::int32_t i) {
    const double* const p = &coordinates_[2 * static_cast<std::size_t>(i)];
    return std::hypot(p[0] - queries_[2 * q], p[1] - queries_[2 * q + 1]);
  };
  const auto offsets = caller_.download(voronoi_.cell_offsets), triangles = caller_.download(mesh_.triangles),
             located = caller_.download(located_), nearest = caller_.download(nearest_);
  expect_none("numbers of triangles", 1, [&](std::size_t) {
    return static_cast<std::size_t>(mesh_.triangle_offsets.back()) != cgal_[0].queries->triangles();
  });
  expect_none("sums of corners of Voronoi cells", 1,
              [&](std::size_t) { return static_cast<std::size_t>(offsets.back()) != cgal_[0].cell_corners; });
  for (const OfCgal& expected : cgal_) {
    expect_none("located triangles", expected.located.size(), [&](std::size_t q) {
      const auto t = static_cast<std::size_t>(std::max(located[q], 0));
      return expected.located[q] != (located[q] < 0 ? kOutside : sorted_corners(&triangles[3 * t]));
    });
    expect_none("nearest points", expected.nearest.size(), [&](std::size_t q) {
      return distance(q, nearest[q]) > (1 + kRounding) * distance(q, expected.nearest[q]);
    });
  }
  return all_agree;
}

/// Points on a circle, or on as many as there must be, of integers: one point is joined to all others of its
/// circle, and a walk along it would be long. Queries are anywhere inside.
std::unique_ptr<Subject> make_fan(Caller& caller, std::size_t n) {
  std::vector<double> coordinates = make_input("integer-circle", n).coordinates;
  double reach = 0;
  for (const double c : coordinates) reach = std::max(reach, std::abs(c));
  std::vector<double> queries = make_input("uniform", n, 2).coordinates;
  for (double& c : queries) c = reach * (2 * c - 1);
  return std::make_unique<Subject>(caller, std::move(coordinates), std::move(queries));
}

/// Points whose coordinates are float32 values, so that both precisions are the same points.
std::unique_ptr<Subject> make_uniform(Caller& caller, std::size_t n) {
  std::vector<double> coordinates = make_input("uniform", n).coordinates;
  for (double& c : coordinates) c = static_cast<double>(static_cast<float>(c));
  return std::make_unique<Subject>(caller, std::move(coordinates), make_input("uniform", n, 2).coordinates);
}

/// Sets calls from device memory beside the host's; the targets of the largest size.
Json add_ratios(Jobs& jobs) {
  constexpr double kMost = 1.05;
  Json targets = Json::array();
  for (Job& job : jobs) {
    const Json& row = job.row;
    if (row["operation"] != "triangulate" || row["implementation"] != "device") continue;
    const auto over = [&](const char* implementation, const Json& precision) {
      return job.median() /
             *median_of(jobs, changed(row, {{"implementation", implementation}, {"precision", precision}}));
    };
    const double over_host_kernels = over("host, kernels", "float64");
    job.details.update({{"over_host_kernels", over_host_kernels},
                        {"over_own_kernels", over("device, kernels", row["precision"])},
                        {"over_host", over("host", "float64")}});
    if (row["n"] != jobs.back().row["n"] || row["precision"] != "float64") continue;
    const std::string what = "device to device / host's kernels, " + thousands(row["n"].get<std::size_t>());
    targets.push_back(target(what, row["parts"], kMost, kMost, over_host_kernels));
  }
  return targets;
}

Result measure_embedding(const EmbeddingRequest& request) {
  Caller caller(request.device);
  std::vector<std::size_t> sizes = request.quick ? std::vector<std::size_t>{500, 3000} : request.sizes;
  std::sort(sizes.begin(), sizes.end());
  std::vector<std::unique_ptr<Subject>> subjects;
  Jobs jobs;
  Result result(caller.host.device());
  for (const std::size_t n : sizes) {
    Subject &uniform = *subjects.emplace_back(make_uniform(caller, n)),
            &fan = *subjects.emplace_back(make_fan(caller, n));
    for (const auto& [name, parts] : kMeasuredParts) uniform.add_triangulations(jobs, name, parts);
    uniform.add_queries(jobs);
    uniform.add_cgal(jobs, request.far_walks);
    fan.add_nearest(jobs, "nearest in a fan");
  }
  measure(jobs, request.runs);
  result.tables["targets"] = add_ratios(jobs);
  add_rows(result, jobs);
  for (const auto& subject : subjects) result.agree &= subject->agrees_with_cgal();
  return result;
}

const Subcommand kSubcommand(
    "embedding", "from device memory to device memory, and queries, beside CGAL's",
    R"(Uniform points whose coordinates are float32 values, so that both precisions are the same points, and as many
uniform queries.

triangulate:
  host: Statistics::seconds of the host's interface, which the command uses: from points in host memory to results in
    host memory
  host, kernels: the sum of its kernels' times, by Options::profile
  device: from the call to the completion of its event, in the caller's context and queue, from points in a buffer to
    results in buffers, which are kept from call to call
  device, kernels: the sum of its kernels' times, by Enqueue::profile on a profiling queue
The host's results always have the hull and the representatives. What a call launches, copies and allocates is said of
the last one, whose memory is kept from the calls before.

The rest, device: from the call to the completion of its event, queries and results in buffers. locator: making a
Locator, its memory included; nearest in a fan: points on a circle, one of them joined to all others, and queries
inside; interpolate: values of float64; voronoi: circumcentres and cells. cgal: one thread, from queries in memory to
indices in memory, its triangulation made before. Walks begin at the face where the last one ended, with queries as
they come ('last face', of which --far-walks are measured and the time scaled) or spatially sorted, which is included;
'hierarchy': Triangulation_hierarchy_2, with queries as they come.

The exit code is also 1 if a query is in another triangle than CGAL says, its nearest point is not as near, or cells
have another sum of corners.)",
    measure_embedding, [](Options& options, EmbeddingRequest& request) {
      options.sizes({10000, 100000, 1000000}, "numbers of points, and of queries")
          .add("--far-walks", request.far_walks, "most queries whose walks begin far away")
          .quick("a few thousand points")
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::embedding
