// flaunay-bench batches: many sets in one call, beside loops of small calls over the same sets.
#include <algorithm>

#include "bench/measuring/command.hpp"
#include "bench/measuring/triangulators.hpp"

namespace flaunay::bench::batches {
namespace {

struct BatchesRequest : Request {
  std::size_t points = 1000000;
  std::vector<std::size_t> set_sizes{100, 1000};
};

std::string loop_name(const std::string& mode) { return implementation_name(mode) + "-loop"; }

Result measure_batches(const BatchesRequest& request) {
  const std::size_t points = request.quick ? std::min<std::size_t>(request.points, 3000) : request.points;
  std::vector<Input> batches;
  for (const std::size_t size : request.set_sizes) {
    batches.push_back(equal_sets(std::max<std::size_t>(1, points / size), size));
  }
  batches.push_back(heavy_tailed_sets(points));
  const std::vector<Input> one_set{make_input("uniform", points)};
  Triangulator triangulator(request.device);
  Implementations implementations = modes_and_cgal(triangulator, request.modes);
  const Jobs of_one_set = make_jobs(implementations, one_set);
  for (const std::string& mode : request.modes) {
    const auto run = [&triangulator, options = options_of(mode)](const Input& batch) {
      return call_on_sets(triangulator, batch, options);
    };
    implementations.push_back({loop_name(mode), run});
  }
  Jobs jobs = make_jobs(implementations, batches);
  append(jobs, of_one_set);
  measure(jobs, request.runs, 0);

  Result result(triangulator.device());
  add_rows(result, jobs);
  const auto seconds = [&](const std::string& name, const Input& input) {
    return median_of(jobs, {{"implementation", name}, {"distribution", input.distribution}, {"n", input.n}});
  };
  for (const Input& batch : batches) {
    const auto cgal = seconds(kCgal, batch);
    for (const std::string& mode : request.modes) {
      const std::string name = implementation_name(mode);
      const auto one_call = seconds(name, batch);
      result.tables["ratios"].push_back(
          {{"implementation", name},
           {"batch", batch.distribution},
           {"sets", batch.sets()},
           {"n", batch.n},
           {"cgal_loop_over_one_call", json_of(ratio(cgal, one_call))},
           {"own_loop_over_one_call", json_of(ratio(seconds(loop_name(mode), batch), one_call))},
           {"one_call_over_one_set", json_of(ratio(one_call, seconds(name, one_set.front())))},
           {"cgal_loop_over_its_one_set", json_of(ratio(cgal, seconds(kCgal, one_set.front())))}});
      if (&batch != &batches.front()) continue;
      result.tables["targets"].push_back(
          target("CGAL's loop / one call, " + batch.distribution, name, 1.5, 3, ratio(cgal, one_call)));
    }
  }
  return result;
}

const Subcommand kSubcommand(
    "batches", "many sets in one call, beside loops of small calls",
    R"(Batches of about the same number of points: sets of equal sizes, and sets of all sizes, with a heavy tail and
with empty, collinear, gridded and all equal ones among them. Times are from points in memory to triangles and
neighbours in memory:
  flaunay-MODE: one call for all sets
  flaunay-MODE-loop: a call for each set, one after the other, with a triangulator that is kept; releasing each result
    is included
  cgal: a loop over the sets on one core; the triangulation object and all arrays are used again
One set of as many points is beside them.)",
    measure_batches, [](Options& options, BatchesRequest& request) {
      options.add("--points", request.points, "of all sets of a batch together")
          .add("--set-sizes", request.set_sizes, "points of each set of a batch")
          .modes()
          .quick()
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::batches
