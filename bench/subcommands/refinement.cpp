// flaunay-bench refinement: meshes with a smallest angle or a largest area beside Triangle's and CGAL's.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/measuring/command.hpp"
#include "bench/measuring/constraints.hpp"
#include "bench/measuring/processes.hpp"
#include "bench/peers/peer.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::bench::refinement {
namespace {

struct RefinementRequest : Request {
  std::vector<double> angles = {20.7, 30};
  std::size_t polygon_points = 100000, domains = 1000, square_triangles = 5000000;
};

/// One mesh to be made, or one per set.
struct Task {
  ConstrainedInput input;
  Wanted wanted;

  Json keys() const {
    const Input& points = input.points;
    return {{"input", points.distribution},
            {"sets", points.sets()},
            {"n", points.n},
            {"min_angle", wanted.min_angle},
            {"max_area", wanted.max_area}};
  }
  std::string name() const {
    const std::string of = input.points.distribution;
    return input.has_polygons() ? of : fmt::format("{} {}", thousands(input.points.n), of);
  }
};

constexpr const char *kOwn = "flaunay", *kOneThread = "flaunay, 1 thread", *kOfTriangle = "triangle",
                     *kOfCgal = "cgal";
constexpr std::size_t kAll = static_cast<std::size_t>(-1);
// CGAL is proven to end up to here.
constexpr double kMostOfCgal = 20.7;

ConstrainedTriangulation refined(Triangulator& triangulator, const Task& task,
                                 std::size_t most_rounds = kAll) {
  const ConstrainedInput& input = task.input;
  const double* const coordinates = input.points.coordinates.data();
  PolygonOptions options;
  options.refinement.min_angle = task.wanted.min_angle;
  options.refinement.max_area = task.wanted.max_area;
  options.refinement.most_rounds = std::min(most_rounds, options.refinement.most_rounds);
  if (input.has_polygons()) {
    return triangulator.polygons({coordinates, input.ring_offsets, input.polygon_offsets}, options);
  }
  ConstrainedOptions plain;
  plain.refinement = options.refinement;
  return triangulator.constrained(coordinates, input.points.offsets, Constraints(), plain);
}

Refined refine_by_flaunay(Triangulator& triangulator, const Task& task, std::size_t& rounds) {
  Refined result;
  const double processors = processor_seconds();
  const Stopwatch watch;
  ConstrainedTriangulation mesh = refined(triangulator, task);
  result.seconds = watch.seconds();
  result.processor_seconds = processor_seconds() - processors;
  result.coordinates = task.input.points.coordinates;
  append(result.coordinates, mesh.added_points);
  result.triangles = std::move(mesh.triangles);
  rounds = mesh.refinement.rounds;
  return result;
}

/// The rounds after which there are 99 % of all points that are added. The rounds of a run that is ended are
/// the first ones of the whole run.
std::size_t rounds_of_most(Triangulator& triangulator, const Task& task, std::size_t rounds) {
  constexpr double kMost = 0.99;
  const auto added = [&](std::size_t most) {
    return static_cast<double>(refined(triangulator, task, most).refinement.added_points);
  };
  const double enough = kMost * added(rounds);
  std::size_t first = 1, last = rounds;
  while (first < last) {
    const std::size_t middle = (first + last) / 2;
    if (added(middle) >= enough) {
      last = middle;
    } else {
      first = middle + 1;
    }
  }
  return last;
}

/// Rounded properties of a mesh, to check that each implementation reaches the goals.
Json looked_at(const Refined& mesh, double min_angle) {
  constexpr double kDegrees = 180 / 3.14159265358979323846, kRounding = 1e-6;
  std::size_t below = 0;
  double largest_area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    double smallest = 180, x[3], y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double* const p = &mesh.coordinates[2 * static_cast<std::size_t>(mesh.triangles[t + k])];
      x[k] = p[0];
      y[k] = p[1];
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      const double ux = x[b] - x[a], uy = y[b] - y[a], vx = x[c] - x[a], vy = y[c] - y[a];
      const double cross = ux * vy - uy * vx;
      smallest = std::min(smallest, kDegrees * std::atan2(cross, ux * vx + uy * vy));
      largest_area = std::max(largest_area, cross / 2);
    }
    below += smallest < min_angle - kRounding;
  }
  return {{"points", mesh.coordinates.size() / 2},
          {"triangles", mesh.triangles.size() / 3},
          {"below_angle", below},
          {"largest_area", largest_area}};
}

void add_jobs(Jobs& jobs, Triangulator& triangulator, std::optional<Triangulator>& single, const Task& task) {
  const auto add = [&](const char* name, const std::function<Refined(Json&)>& refine) {
    Json row{{"implementation", name}};
    row.update(task.keys());
    jobs.push_back({row, [&task, refine]() -> Outcome {
                      Json details = Json::object();
                      const Refined mesh = refine(details);
                      details.update(looked_at(mesh, task.wanted.min_angle));
                      Outcome outcome(mesh.seconds, details);
                      outcome.processor_seconds = mesh.processor_seconds;
                      return outcome;
                    }});
  };
  const auto add_own = [&](const char* name, Triangulator& by) {
    add(name, [&](Json& details) {
      std::size_t rounds = 0;
      Refined mesh = refine_by_flaunay(by, task, rounds);
      details["rounds"] = rounds;
      return mesh;
    });
  };
  add_own(kOwn, triangulator);
  if (single) add_own(kOneThread, *single);
  if (refine_by_triangle != nullptr) {
    add(kOfTriangle, [&](Json&) { return refine_by_triangle(task.input, task.wanted); });
  }
  const bool can_cgal = task.wanted.min_angle <= kMostOfCgal && task.wanted.max_area == 0;
  if (refine_by_cgal != nullptr && can_cgal) {
    add(kOfCgal, [&](Json&) { return refine_by_cgal(task.input, task.wanted); });
  }
}

const Job* job_of(const Jobs& jobs, const char* implementation, const Task& task) {
  return find_job(jobs, changed(task.keys(), {{"implementation", implementation}}));
}

void add_targets(Json& targets, const Jobs& jobs, const Task& task) {
  const Job *const own = job_of(jobs, kOwn, task), *const single = job_of(jobs, kOneThread, task);
  if (own == nullptr) return;
  const auto add = [&](const std::string& what, double at_least, double goal, double measured) {
    const std::string asked =
        task.wanted.min_angle > 0 ? fmt::format(", {} degrees", task.wanted.min_angle) : "";
    targets.push_back(
        target(fmt::format("{}, {}{}", what, task.name(), asked), kOwn, at_least, goal, measured));
  };
  struct Bounds {
    double at_least, goal;
  };
  const auto beside = [&](const Job* peer, const char* name, Bounds of_processor, Bounds by_clock) {
    if (peer == nullptr) return;
    if (single != nullptr) {
      add(fmt::format("{}'s processor time / ours on one core", name), of_processor.at_least,
          of_processor.goal,
          summary(peer->processor_seconds).median / summary(single->processor_seconds).median);
    }
    add(fmt::format("{}'s time / ours", name), by_clock.at_least, by_clock.goal,
        peer->median() / own->median());
  };
  const bool is_many = task.input.points.sets() > 1;
  const Job* const of_triangle = job_of(jobs, kOfTriangle, task);
  if (!task.input.has_polygons()) {
    beside(of_triangle, "Triangle", {2.2, 4}, {4, 7});
  } else {
    const Bounds bounds = is_many ? Bounds{2, 5} : Bounds{2.5, 4};
    beside(of_triangle, "Triangle", bounds, bounds);
  }
  beside(job_of(jobs, kOfCgal, task), "CGAL", {8, 12}, {8, 12});
  if (task.wanted.min_angle > 0 && of_triangle != nullptr) {
    add("points / Triangle's", 1.02, 1.00,
        own->details["points"].get<double>() / of_triangle->details["points"].get<double>());
  }
}

Result measure_refinement(const RefinementRequest& request) {
  constexpr std::size_t kQuickPoints = 1000;
  // Triangles that are halved stop between the largest area and its half.
  constexpr double kLargestOverMean = 1.6;
  const auto at_most = [&](std::size_t n) { return request.quick ? std::min(n, kQuickPoints) : n; };
  const double square_triangles = static_cast<double>(at_most(request.square_triangles));
  const std::vector<std::size_t> sizes = request.quick ? std::vector{kQuickPoints} : request.sizes;
  std::vector<Task> tasks;
  for (const double angle : request.angles) {
    for (const std::size_t n : sizes) {
      for (const std::string& distribution : request.distributions) {
        tasks.push_back({{make_input(distribution, n), {}, {0, 0}}, {angle, 0}});
      }
    }
  }
  const double angle = request.angles.back();
  constexpr std::size_t kDomainPoints = 100, kQuickDomains = 10;
  if (request.polygon_points > 0)
    tasks.push_back({wavy_polygon(at_most(request.polygon_points)), {angle, 0}});
  if (request.square_triangles > 0) tasks.push_back({square(), {angle, kLargestOverMean / square_triangles}});
  const std::size_t domains = request.quick ? std::min(request.domains, kQuickDomains) : request.domains;
  if (domains > 0) tasks.push_back({polygons_with_holes(domains, kDomainPoints), {angle, 0}});

  Triangulator triangulator(request.device);
  std::optional<Triangulator> single;
  // Only the host has threads of its own: other devices use the threads of the process.
  if (triangulator.device().name == "host") single = triangulator_with("FLAUNAY_THREADS", "1", "host");
  Jobs jobs;
  for (const Task& task : tasks) add_jobs(jobs, triangulator, single, task);
  measure(jobs, request.runs);
  Result result(triangulator.device());
  for (const Task& task : tasks) {
    add_targets(result.tables["targets"], jobs, task);
    Job& own = *std::find_if(jobs.begin(), jobs.end(), [&](const Job& job) {
      return job.row == changed(Json{{"implementation", kOwn}}, task.keys());
    });
    own.details["rounds_of_99_percent"] =
        rounds_of_most(triangulator, task, own.details["rounds"].get<std::size_t>());
  }
  add_rows(result, jobs);
  return result;
}

const Subcommand kSubcommand(
    "refinement", "meshes with a smallest angle and a largest area, beside Triangle and CGAL",
    R"(Inputs are points, whose hull is meshed, at each of the angles; and at the last angle a polygon with holes, the
unit square with a largest area, and domains of 100 points with a hole, which are one call. Times are from points and
segments in memory to a mesh in memory:
  flaunay, and with one thread: one call
  triangle: Triangle 1.6, on one thread; domains in a loop
  cgal: Delaunay_mesher_2 on Constrained_Delaunay_triangulation_2, on one thread, up to 20.7 degrees, to which it is
    proven to end; domains in a loop
Rows have the numbers of points, triangles, and triangles with an angle that is smaller than asked for, rounds, and
rounds until 99 % of the points that are added are there. 0 leaves an input out.)",
    measure_refinement, [](Options& options, RefinementRequest& request) {
      options.sizes({100000, 1000000})
          .distributions({"uniform", "kuzmin"})
          .add("--angles", request.angles, "degrees")
          .add("--polygon-points", request.polygon_points, "points of the polygon", CLI::NonNegativeNumber)
          .add("--square-triangles", request.square_triangles, "about so many triangles of the square",
               CLI::NonNegativeNumber)
          .add("--domains", request.domains, "domains in one call", CLI::NonNegativeNumber)
          .quick("1,000 points")
          .runs(3);
    });

}  // namespace
}  // namespace flaunay::bench::refinement
