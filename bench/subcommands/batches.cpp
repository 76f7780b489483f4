// flaunay-bench batches: many sets in one call, beside loops over the same sets.
#include <algorithm>

#include "bench/measuring/contest.hpp"

namespace flaunay::bench::batches {
namespace {

struct BatchesRequest : Request {
  std::size_t points = 1000000;
  std::size_t loop_sets = 20000;
};

/// The target is for the first of them.
std::vector<Input> make_batches(std::size_t points) {
  std::vector<Input> batches;
  for (const std::size_t size : {100, 1000}) {
    batches.push_back(equal_sets(std::max<std::size_t>(1, points / size), size));
  }
  batches.push_back(heavy_tailed_sets(points));
  return batches;
}

// ---- A loop of calls

std::string loop_name(const std::string& mode) { return implementation_name(mode) + "-loop"; }

/// Sets s with s % stride == 0 are measured.
std::size_t loop_stride(const Input& batch, std::size_t most) { return (batch.sets() + most - 1) / most; }

std::size_t sets_in_loop(const Input& batch, std::size_t most) {
  const std::size_t stride = loop_stride(batch, most);
  return (batch.sets() + stride - 1) / stride;
}

/// A loop over evenly chosen sets, no more than `most`; the time is scaled by their number. The triangles of
/// the other sets come from one call, so that the numbers of all can be compared.
Outcome run_loop(Triangulator& triangulator, const Input& batch, const research::Options& options,
                 std::size_t most) {
  const std::size_t stride = loop_stride(batch, most);
  Outcome outcome = call_on_sets(triangulator, batch, options, stride);
  if (stride == 1) return outcome;
  const auto offsets = call(triangulator, batch, options).triangle_offsets;
  for (std::size_t s = 0; s < batch.sets(); ++s) {
    if (s % stride != 0) outcome.triangles += offsets[s + 1] - offsets[s];
  }
  outcome.seconds *= static_cast<double>(batch.sets()) / static_cast<double>(sets_in_loop(batch, most));
  return outcome;
}

Implementations loops(Triangulator& triangulator, const BatchesRequest& request) {
  Implementations implementations;
  for (const std::string& mode : request.modes) {
    implementations.push_back(implementation(
        loop_name(mode), [&triangulator, options = options_of(mode), &request](const Input& batch) {
          return run_loop(triangulator, batch, options, request.loop_sets);
        }));
  }
  return implementations;
}

// ---- One call beside all else

void add_comparisons(Json& tables, const Entries& entries, const std::vector<Input>& batches,
                     const Input& one_set, const BatchesRequest& request) {
  for (const char* table : {"ratios", "targets"}) tables[table] = Json::array();
  const auto seconds = [&](const std::string& name, const Input& input) {
    return median_of(entries, name, input.distribution, input.n);
  };
  for (const Input& batch : batches) {
    const auto cgal = seconds(kCgal, batch);
    for (const std::string& mode : request.modes) {
      const std::string name = implementation_name(mode);
      const auto one_call = seconds(name, batch);
      tables["ratios"].push_back(
          {{"implementation", name},
           {"batch", batch.distribution},
           {"sets", batch.sets()},
           {"n", batch.n},
           {"loop_sets_measured", sets_in_loop(batch, request.loop_sets)},
           {"cgal_loop_over_one_call", json_of(ratio(cgal, one_call))},
           {"own_loop_over_one_call", json_of(ratio(seconds(loop_name(mode), batch), one_call))},
           {"one_call_over_one_set", json_of(ratio(one_call, seconds(name, one_set)))},
           {"cgal_loop_over_its_one_set", json_of(ratio(cgal, seconds(kCgal, one_set)))}});
      if (&batch == &batches.front()) {
        tables["targets"].push_back(
            target("CGAL's loop / one call, " + batch.distribution, name, 1.5, 3, ratio(cgal, one_call)));
      }
    }
  }
}

Result measure_batches(const BatchesRequest& request) {
  const std::size_t points = request.quick ? std::min<std::size_t>(request.points, 3000) : request.points;
  const std::vector<Input> batches = make_batches(points);
  const std::vector<Input> one_set{make_input("uniform", points)};
  Triangulator triangulator(request.device);
  Implementations implementations = modes_and_cgal(triangulator, request.modes);
  const Entries of_one_set = make_entries(implementations, one_set);
  append(implementations, loops(triangulator, request));
  Entries entries = make_entries(implementations, batches);
  append(entries, of_one_set);
  measure(entries, request.runs);

  Result result(triangulator.device());
  add_entries(result, entries);
  add_comparisons(result.tables, entries, batches, one_set.front(), request);
  return result;
}

const Subcommand kSubcommand(
    "batches", "many sets in one call, beside loops over the same sets",
    "Batches of the same number of points: sets of 100, sets of 1,000, and sets of all sizes, with a heavy "
    "tail "
    "and with empty, collinear, gridded and all equal ones among them. Times are from points in memory to "
    "triangles and neighbours in memory:\n"
    "  flaunay-MODE: one call for all sets\n"
    "  flaunay-MODE-loop: a call for each set, one after the other, with a triangulator that is kept; "
    "releasing "
    "each result is included\n"
    "  cgal: a loop over the sets on one core; the triangulation object and all arrays are used again\n"
    "One set of as many points is beside them. A loop of flaunay's calls over more than --loop-sets sets "
    "takes "
    "evenly chosen ones, and its time is scaled by their number; the record says how many it was. All take "
    "turns; the first run of each is not counted; what is over soon is repeated within a run. The exit code "
    "is 1 "
    "if numbers of triangles differ from CGAL's; a missed target does not change it.",
    measure_batches, [](Options& options, BatchesRequest& request) {
      options.add("--points", request.points, "of all sets of a batch together")
          .add("--loop-sets", request.loop_sets, "most sets that a loop of flaunay's calls takes")
          .modes()
          .quick()
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::batches
