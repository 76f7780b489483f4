// flaunay-bench constrained: triangulations with segments and of polygons beside CGAL's, and beside plain
// ones.
#include "flaunay/constrained.hpp"

#include <algorithm>
#include <optional>

#include "bench/measuring/command.hpp"
#include "bench/measuring/constraints.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench::constrained {
namespace {

struct ConstrainedRequest : Request {
  std::size_t points = 1000000, polygon_points = 100;
};

constexpr const char *kPlain = "flaunay-triangulate", *kConstrained = "flaunay-constrained",
                     *kOfCgal = "cgal-range";

/// All that is not inside of polygons is left out.
ConstrainedTriangulation constrain(Triangulator& triangulator, const ConstrainedInput& input) {
  const double* const coordinates = input.points.coordinates.data();
  if (input.has_polygons()) {
    return triangulator.polygons({coordinates, input.ring_offsets, input.polygon_offsets});
  }
  Constraints constraints;
  constraints.segments = input.segments.data();
  constraints.segment_count = input.segment_count();
  return triangulator.constrained(coordinates, input.points.offsets, constraints);
}

void add_jobs(Jobs& jobs, Triangulator& triangulator, const ConstrainedInput& input) {
  const Input& points = input.points;
  const auto add = [&](const char* name, const std::function<Outcome()>& run) {
    Json row{{"implementation", name}, {"input", points.distribution}};
    row.update({{"sets", points.sets()}, {"n", points.n}, {"segments", input.segment_count()}});
    jobs.push_back({row, run, "", (std::string(name) == kPlain ? "plain " : "") + points.distribution});
  };
  const auto timed = [](const auto& work) {
    return [work]() -> Outcome {
      const Stopwatch watch;
      const auto mesh = work();
      return {watch.seconds(), mesh.triangles.size() / 3};
    };
  };
  add(kPlain, timed([&] { return triangulator.triangulate(points.coordinates.data(), points.offsets); }));
  add(kConstrained, timed([&] { return constrain(triangulator, input); }));
  if (run_cgal_constrained == nullptr) return;
  add(kOfCgal, [&] { return run_cgal_constrained(input); });
}

Result measure_constrained(const ConstrainedRequest& request) {
  constexpr std::size_t kQuickPoints = 3000;
  const std::size_t n = request.quick ? std::min(request.points, kQuickPoints) : request.points;
  const std::size_t polygons = std::max<std::size_t>(1, n / request.polygon_points);
  const ConstrainedInput inputs[] = {short_segments(n),
                                     map_of_cells(n, false),
                                     map_of_cells(n, true),
                                     islands(n),
                                     polygons_with_holes(polygons, request.polygon_points),
                                     polygons_with_holes(1, n)};
  Triangulator triangulator(request.device);
  Jobs jobs;
  for (const ConstrainedInput& input : inputs) add_jobs(jobs, triangulator, input);
  measure(jobs, request.runs);
  Result result(triangulator.device());
  const auto over_own = [&](const char* implementation, const std::string& input) {
    return ratio(median_of(jobs, {{"implementation", implementation}, {"input", input}}),
                 median_of(jobs, {{"implementation", kConstrained}, {"input", input}}));
  };
  for (const ConstrainedInput& input : inputs) {
    const std::string& name = input.points.distribution;
    for (Job& job : jobs) {
      if (job.row["input"] != name) continue;
      job.details["of_constrained"] =
          json_of(over_own(job.row["implementation"].get<std::string>().c_str(), name));
    }
    const bool is_many = input.has_polygons() && input.points.sets() > 1;
    result.tables["targets"].push_back(target("CGAL / flaunay, " + name, kConstrained, is_many ? 3 : 2,
                                              is_many ? 6 : 4, over_own(kOfCgal, name)));
    if (&input != inputs) continue;
    result.tables["targets"].push_back(
        target("constrained / plain, " + name, kConstrained, 2, 1.4, ratio(1, over_own(kPlain, name))));
  }
  add_rows(result, jobs);
  return result;
}

const Subcommand kSubcommand(
    "constrained", "triangulations with segments and of polygons, beside CGAL",
    R"(Inputs of about as many points: uniform ones with a fifth as many short segments; maps whose points are all on
borders, which polygons share, with any coordinates and on a grid of integers; islands with lakes; many polygons with
holes, each a set of its own; one such polygon of all points. Times are from points and segments in memory to
triangles, neighbours and marks of constraints in memory; of polygons only the triangles inside:
  flaunay-triangulate: the same points without segments
  flaunay-constrained: one call
  cgal-range: Constrained_Delaunay_triangulation_2 on one thread, by its insertion of points and pairs of indices, a
    loop over sets (to insert sorted segments one by one took 0.91 of its time on short segments, else more)
Segments that cross are an error in all of them.)",
    measure_constrained, [](Options& options, ConstrainedRequest& request) {
      options.add("--points", request.points, "points of each input")
          .add("--polygon-points", request.polygon_points, "points of each of many polygons")
          .quick()
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::constrained
