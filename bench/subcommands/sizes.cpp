// flaunay-bench scaling and small: time per point by number of points, flaunay's modes beside CGAL.
#include <fmt/format.h>

#include <algorithm>

#include "bench/measuring/contest.hpp"

namespace flaunay::bench::sizes {
namespace {

struct SizesRequest : Request {
  std::size_t sets = 0;                       ///< of small; 0: enough for a run
  int least = 10, most = 24, cgal_most = 22;  ///< of scaling, as powers of two
};

constexpr const char* kHelp =
    "Times are from points in memory to triangles and neighbours in memory, in whole calls with a "
    "triangulator that is kept; all implementations and inputs take turns, the first run of each is not "
    "counted, and what is over soon is repeated within a run. small: each call has another set of points, so "
    "that nothing is remembered from the call before; times are of one call. The exit code is 1 if numbers "
    "of triangles differ from CGAL's.";

Result measure_scaling(const SizesRequest& request) {
  if (request.least > request.most) throw Error(ErrorKind::usage, "--least is greater than --most");
  const std::vector<Input> inputs =
      make_inputs(request.distributions, powers_of_two(request.least, request.most));
  Triangulator triangulator(request.device);
  Entries entries = make_entries(modes_and_cgal(triangulator, request.modes), inputs);
  for (Entry& entry : entries) {
    if (entry.name() == kCgal && entry.input->n > std::size_t{1} << request.cgal_most) {
      entry.skipped = fmt::format("more than 2^{} points", request.cgal_most);
    }
  }
  measure(entries, request.runs, request.limit);
  Result result(triangulator.device());
  add_entries(result, entries);
  return result;
}

// A call per set, where an implementation of its own would take all sets at once.
std::shared_ptr<const Implementation> call_per_set(Triangulator& triangulator, const std::string& mode) {
  const research::Options options = options_of(mode);
  return implementation(
      implementation_name(mode),
      [&triangulator, options](const Input& input) { return call_on_sets(triangulator, input, options); },
      options);
}

Result measure_small(const SizesRequest& request) {
  // So many that no cache and no branch prediction remembers them, and that clocks are fine enough.
  constexpr std::size_t kPointsOfARun = std::size_t{1} << 18;
  std::vector<Input> inputs;
  for (const std::string& distribution : request.distributions) {
    for (const std::size_t size : request.sizes) {
      const std::size_t sets =
          request.sets > 0 ? request.sets : std::max<std::size_t>(1, kPointsOfARun / size);
      inputs.push_back(equal_sets(sets, size, distribution));
      // For the record: it is about calls on so many points.
      inputs.back().distribution = distribution;
      inputs.back().n = size;
    }
  }
  Triangulator triangulator(request.device);
  Implementations implementations;
  for (const std::string& mode : request.modes) implementations.push_back(call_per_set(triangulator, mode));
  append(implementations, peer_implementations({kCgal}));
  Entries entries = make_entries(implementations, inputs);
  measure(entries, request.runs);
  for (Entry& entry : entries) {
    for (double& seconds : entry.seconds) seconds /= static_cast<double>(entry.input->sets());
  }
  Result result(triangulator.device());
  add_entries(result, entries);
  return result;
}

const Subcommand kSmall("small", "calls on few points", kHelp, measure_small,
                        [](Options& options, SizesRequest& request) {
                          options.sizes({32, 100, 1024, 4096})
                              .add("--sets", request.sets,
                                   "number of different sets; 0: 262144 points in all", kAny)
                              .distributions({"uniform"})
                              .modes()
                              .runs();
                        });

const Subcommand kScaling(
    "scaling", "time per point over many sizes, modes beside CGAL", kHelp, measure_scaling,
    [](Options& options, SizesRequest& request) {
      const CLI::Range exponents(1, 30);
      options.add("--least", request.least, "least number of points, as a power of two", exponents)
          .add("--most", request.most, "greatest number of points, as a power of two", exponents)
          .add("--cgal-most", request.cgal_most, "the same for CGAL", exponents)
          .distributions({"uniform", "kuzmin", "line"})
          .modes()
          .limit(60, "what takes more seconds is not run at larger sizes")
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::sizes
