// flaunay-bench constrained: triangulations with segments and of polygons beside CGAL's, and beside plain
// ones.
#include "flaunay/constrained.hpp"

#include <algorithm>
#include <deque>
#include <optional>

#include "bench/measuring/constraints.hpp"
#include "bench/measuring/timing.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench::constrained {
namespace {

struct ConstrainedRequest : Request {
  std::size_t points = 1000000, polygon_points = 100;
};

std::vector<ConstrainedInput> make_inputs(const ConstrainedRequest& request) {
  constexpr std::size_t kQuickPoints = 3000;
  const std::size_t n = request.quick ? std::min(request.points, kQuickPoints) : request.points;
  const std::size_t polygons = std::max<std::size_t>(1, n / request.polygon_points);
  return {short_segments(n),
          map_of_cells(n, false),
          map_of_cells(n, true),
          islands(n),
          polygons_with_holes(polygons, request.polygon_points),
          polygons_with_holes(1, n)};
}

constexpr const char* kConstrained = "flaunay-constrained";

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

/// The ways in which an input is triangulated, in order of their jobs; the last two only with CGAL.
enum Way : std::size_t { plain, own, cgal_range, cgal_sorted };

void add_jobs(std::vector<Job>& jobs, Triangulator& triangulator, const ConstrainedInput& input,
              std::deque<std::size_t>& triangles) {
  const auto add = [&](const char* name, const std::function<Outcome()>& run) {
    std::size_t& count = triangles.emplace_back();
    const Input& points = input.points;
    jobs.push_back({{{"implementation", name},
                     {"input", points.distribution},
                     {"sets", points.sets()},
                     {"n", points.n},
                     {"segments", input.segment_count()}},
                    [run, &count] {
                      const Outcome outcome = run();
                      count = outcome.triangles;
                      return outcome.seconds;
                    }});
  };
  const auto timed = [](const auto& work) {
    return [work] {
      const Stopwatch watch;
      const auto mesh = work();
      return Outcome{watch.seconds(), mesh.triangles.size() / 3};
    };
  };
  add("flaunay-triangulate",
      timed([&] { return triangulator.triangulate(input.points.coordinates.data(), input.points.offsets); }));
  add(kConstrained, timed([&] { return constrain(triangulator, input); }));
  if (run_cgal_constrained == nullptr) return;
  const auto cgal = [&](CgalInsertion insertion) {
    return [&, insertion] { return run_cgal_constrained(input, insertion, input.has_polygons()); };
  };
  add("cgal-range", cgal(CgalInsertion::range));
  add("cgal-sorted", cgal(CgalInsertion::sorted));
}

Result measure_constrained(const ConstrainedRequest& request) {
  Triangulator triangulator(request.device);
  const std::vector<ConstrainedInput> inputs = make_inputs(request);
  std::vector<Job> jobs;
  std::deque<std::size_t> triangles;
  for (const ConstrainedInput& input : inputs) add_jobs(jobs, triangulator, input, triangles);
  measure_rows(jobs, request.runs, true);
  for (std::size_t k = 0; k < jobs.size(); ++k) jobs[k].row["triangles"] = triangles[k];

  Result result(triangulator.device(), {"results", "ratios", "targets"});
  result.tables["results"] = rows_of(jobs);
  const std::size_t ways = jobs.size() / inputs.size();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Job* const of_input = &jobs[i * ways];
    const auto median = [&](Way way, bool of_processor) {
      return of_processor ? of_input[way].processor_median() : of_input[way].median();
    };
    // The faster way of CGAL's over ours.
    const auto over_own = [&](bool of_processor) -> std::optional<double> {
      if (ways <= cgal_sorted) return {};
      return std::min(median(cgal_range, of_processor), median(cgal_sorted, of_processor)) /
             median(own, of_processor);
    };
    const auto over_plain = [&](bool of_processor) {
      return median(own, of_processor) / median(plain, of_processor);
    };
    bool agrees = true;
    for (std::size_t way = own; way < ways; ++way)
      agrees &= triangles[i * ways + way] == triangles[i * ways + own];
    result.agree &= agrees;
    const std::string& name = inputs[i].points.distribution;
    result.tables["ratios"].push_back({{"input", name},
                                       {"cgal_over_flaunay", json_of(over_own(false))},
                                       {"processor_cgal_over_flaunay", json_of(over_own(true))},
                                       {"flaunay_over_triangulate", over_plain(false)},
                                       {"processor_flaunay_over_triangulate", over_plain(true)},
                                       {"agrees", agrees}});
    const bool is_many = inputs[i].has_polygons() && inputs[i].points.sets() > 1;
    result.tables["targets"].push_back(
        target("CGAL / flaunay, " + name, kConstrained, is_many ? 3 : 2, is_many ? 6 : 4, over_own(false)));
    if (i == 0) {
      result.tables["targets"].push_back(
          target("constrained / plain, " + name, kConstrained, 2, 1.4, over_plain(false)));
    }
  }
  return result;
}

const Subcommand kSubcommand(
    "constrained", "triangulations with segments and of polygons, beside CGAL",
    "Inputs of about as many points: uniform ones with a fifth as many short segments; maps whose points are "
    "all "
    "on borders, which polygons share, with any coordinates and on a grid of integers; islands with lakes; "
    "many "
    "polygons with holes, each a set of its own; one such polygon of all points. Times are from points and "
    "segments in memory to triangles, neighbours and marks of constraints in memory; of polygons only the "
    "triangles inside:\n"
    "  flaunay-triangulate: the same points without segments\n"
    "  flaunay-constrained: one call\n"
    "  cgal-range: Constrained_Delaunay_triangulation_2 on one thread, by its insertion of points and pairs "
    "of "
    "indices; a loop over sets\n"
    "  cgal-sorted: the same, with points in spatial order and segments in the order of their first points\n"
    "Segments that cross are an error in all of them. Processor times are those of all threads of the "
    "process. "
    "All take turns; the first run of each is not counted. The exit code is 1 if the numbers of triangles "
    "differ.",
    measure_constrained, [](Options& options, ConstrainedRequest& request) {
      options.add("--points", request.points, "points of each input")
          .add("--polygon-points", request.polygon_points, "points of each of many polygons")
          .quick()
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::constrained
