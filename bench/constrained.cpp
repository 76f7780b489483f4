// flaunay-bench constrained: triangulations with segments and of polygons beside CGAL's, and beside plain
// ones.
#include "flaunay/constrained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <deque>
#include <map>
#include <optional>
#include <set>

#include "command.hpp"
#include "constraints.hpp"

namespace flaunay::bench::constrained {
namespace {

struct Request : Measurement {
  std::size_t points = 1000000, polygon_points = 100;
  bool quick = false;
};

std::deque<ConstrainedInput> make_inputs(const Request& request) {
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

/// A call on one input; the seconds of its last run, and what they were spent on.
struct Call {
  const ConstrainedInput* input;
  std::string implementation;
  std::function<Outcome()> run;
  Outcome outcome = {};
  std::vector<double> processor_seconds = {};  ///< of all threads
  std::vector<double> seconds = {};

  double wall() const { return summary(seconds).median; }
  double processor() const { return summary(processor_seconds).median; }
};

constexpr const char* kPlain = "flaunay-triangulate";
constexpr const char* kConstrained = "flaunay-constrained";
constexpr const char* kCgalRange = "cgal-range";
constexpr const char* kCgalSorted = "cgal-sorted";

Outcome triangulate(Triangulator& triangulator, const ConstrainedInput& input) {
  const Stopwatch watch;
  const Triangulation mesh = triangulator.triangulate(input.points.coordinates.data(), input.points.offsets);
  return {watch.seconds(), mesh.triangles.size() / 3};
}

/// All that is not inside of polygons is left out.
Outcome constrain(Triangulator& triangulator, const ConstrainedInput& input) {
  const double* const coordinates = input.points.coordinates.data();
  const Stopwatch watch;
  ConstrainedTriangulation mesh;
  if (input.has_polygons()) {
    mesh = triangulator.polygons({coordinates, input.ring_offsets, input.polygon_offsets});
  } else {
    Constraints constraints;
    constraints.segments = input.segments.data();
    constraints.segment_count = input.segment_count();
    mesh = triangulator.constrained(coordinates, input.points.offsets, constraints);
  }
  return {watch.seconds(), mesh.triangles.size() / 3};
}

std::deque<Call> make_calls(Triangulator& triangulator, const std::deque<ConstrainedInput>& inputs) {
  std::deque<Call> calls;
  for (const ConstrainedInput& input : inputs) {
    calls.push_back({&input, kPlain, [&] { return triangulate(triangulator, input); }});
    calls.push_back({&input, kConstrained, [&] { return constrain(triangulator, input); }});
#ifdef FLAUNAY_BENCH_CGAL
    const auto cgal = [&input](CgalInsertion insertion) {
      return [&input, insertion] { return run_cgal_constrained(input, insertion, input.has_polygons()); };
    };
    calls.push_back({&input, kCgalRange, cgal(CgalInsertion::range)});
    calls.push_back({&input, kCgalSorted, cgal(CgalInsertion::sorted)});
#endif
  }
  return calls;
}

void measure(std::deque<Call>& calls, int runs) {
  std::vector<Job> jobs;
  for (Call& call : calls) {
    jobs.push_back({fmt::format("{} of {}", call.implementation, call.input->points.distribution), [&call] {
                      const std::clock_t begin = std::clock();
                      call.outcome = call.run();
                      call.processor_seconds.push_back(static_cast<double>(std::clock() - begin) /
                                                       CLOCKS_PER_SEC);
                      return call.outcome.seconds;
                    }});
  }
  run_interleaved(jobs, runs);
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (!jobs[k].skipped.empty()) throw Error(ErrorKind::internal, jobs[k].name + ": " + jobs[k].skipped);
    calls[k].seconds = jobs[k].seconds;
  }
}

/// The calls of one input by their names.
using Calls = std::map<std::string, const Call*>;

/// A median: of wall-clock times, or of processor times.
using Median = double (Call::*)() const;

std::optional<double> median_of(const Calls& calls, const std::string& name, Median median) {
  const auto found = calls.find(name);
  return found == calls.end() ? std::nullopt : std::optional((found->second->*median)());
}

/// The faster way of CGAL's over ours.
std::optional<double> cgal_over_own(const Calls& calls, Median median) {
  const auto range = median_of(calls, kCgalRange, median), sorted = median_of(calls, kCgalSorted, median);
  if (!range || !sorted) return {};
  return ratio(std::min(*range, *sorted), median_of(calls, kConstrained, median));
}

std::optional<double> own_over_plain(const Calls& calls, Median median) {
  return ratio(median_of(calls, kConstrained, median), median_of(calls, kPlain, median));
}

Json row_of(const Call& call) {
  const Input& points = call.input->points;
  Json row{{"implementation", call.implementation},
           {"input", points.distribution},
           {"sets", points.sets()},
           {"n", points.n},
           {"segments", call.input->segment_count()}};
  add_seconds(row, call.seconds);
  row["processor_seconds_median"] = call.processor();
  row["triangles"] = call.outcome.triangles;
  return row;
}

/// Whether those with constraints have equally many triangles.
bool counts_agree(const Calls& calls) {
  std::set<std::size_t> counts;
  for (const auto& [name, call] : calls) {
    if (name != kPlain) counts.insert(call->outcome.triangles);
  }
  return counts.size() == 1;
}

Result measure_constrained(const Request& request) {
  Triangulator triangulator(request.device);
  const std::deque<ConstrainedInput> inputs = make_inputs(request);
  std::deque<Call> calls = make_calls(triangulator, inputs);
  measure(calls, request.runs);

  Result result{triangulator.device()};
  for (const char* table : {"results", "ratios", "targets"}) result.tables[table] = Json::array();
  std::map<const ConstrainedInput*, Calls> by_input;
  for (const Call& call : calls) {
    result.tables["results"].push_back(row_of(call));
    by_input[call.input][call.implementation] = &call;
  }
  for (const ConstrainedInput& input : inputs) {
    const Calls& of_input = by_input[&input];
    const auto over_own = cgal_over_own(of_input, &Call::wall),
               over_plain = own_over_plain(of_input, &Call::wall);
    const std::string& name = input.points.distribution;
    const bool agrees = counts_agree(of_input);
    result.agree &= agrees;
    result.tables["ratios"].push_back(
        {{"input", name},
         {"cgal_over_flaunay", json_of(over_own)},
         {"processor_cgal_over_flaunay", json_of(cgal_over_own(of_input, &Call::processor))},
         {"flaunay_over_triangulate", json_of(over_plain)},
         {"processor_flaunay_over_triangulate", json_of(own_over_plain(of_input, &Call::processor))},
         {"agrees", agrees}});
    const bool is_many = input.has_polygons() && input.points.sets() > 1;
    result.tables["targets"].push_back(
        target("CGAL / flaunay, " + name, kConstrained, is_many ? 3 : 2, is_many ? 6 : 4, over_own));
    if (&input == &inputs.front()) {
      result.tables["targets"].push_back(
          target("constrained / plain, " + name, kConstrained, 2, 1.4, over_plain));
    }
  }
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(
      app, action, "constrained", "triangulations with segments and of polygons, beside CGAL",
      "Inputs of about as many points: uniform ones with a fifth as many short segments; maps whose points "
      "are all on borders, which polygons share, with any coordinates and on a grid of integers; islands "
      "with lakes; many polygons with holes, each a set of its own; one such polygon of all points. Times "
      "are from points and segments in memory to triangles, neighbours and marks of constraints in memory; "
      "of polygons only the triangles inside:\n"
      "  flaunay-triangulate: the same points without segments\n"
      "  flaunay-constrained: one call\n"
      "  cgal-range: Constrained_Delaunay_triangulation_2 on one thread, by its insertion of points and "
      "pairs "
      "of indices; a loop over sets\n"
      "  cgal-sorted: the same, with points in spatial order and segments in the order of their first "
      "points\n"
      "Segments that cross are an error in all of them. Processor times are those of all threads of the "
      "process. All take turns; the first run of each is not counted. The exit code is 1 if the numbers of "
      "triangles differ.",
      request, measure_constrained);
  add_option(command, "--points", request->points, "points of each input");
  add_option(command, "--polygon-points", request->polygon_points, "points of each of many polygons");
  command->add_flag("--quick", request->quick, "3,000 points: shows that it works, and no more");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::constrained
