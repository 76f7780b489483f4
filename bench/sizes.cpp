// flaunay-bench scaling and small: time per point by number of points, flaunay's modes beside CGAL.
#include <fmt/format.h>

#include "contest.hpp"

namespace flaunay::bench {
namespace {

struct Request : Measurement {
  std::vector<std::size_t> sizes{32, 100, 1024, 4096};  ///< of small
  int least = 10, most = 24, cgal_most = 22;            ///< of scaling, as powers of two
  std::vector<std::string> distributions{"uniform"};
  std::vector<std::string> modes{to_string(kDefaultMode)};
  double limit = 60;
};

constexpr const char* kHelp =
    "Times are from points in memory to triangles and neighbours in memory, in whole calls with a "
    "triangulator that is kept; all implementations and inputs take turns, the first run of each is not "
    "counted, and what is over soon is repeated within a run. The exit code is 1 if numbers of triangles "
    "differ from CGAL's.";

Result measure_sizes(const Request& request, const std::vector<std::size_t>& sizes, double limit) {
  const std::vector<Input> inputs = make_inputs(request.distributions, sizes);
  Triangulator triangulator(request.device);
  Entries entries = make_entries(modes_and_cgal(triangulator, request.modes), inputs);
  for (Entry& entry : entries) {
    if (entry.name() == kCgal && entry.input->n > std::size_t{1} << request.cgal_most) {
      entry.skipped = fmt::format("more than 2^{} points", request.cgal_most);
    }
  }
  measure(entries, request.runs, limit);
  Result result{triangulator.device()};
  result.agree = check_counts(entries);
  add_entries(result.tables, entries);
  return result;
}

Result measure_small(const Request& request) { return measure_sizes(request, request.sizes, 0); }

Result measure_scaling(const Request& request) {
  if (request.least > request.most) throw Error(ErrorKind::usage, "--least is greater than --most");
  return measure_sizes(request, powers_of_two(request.least, request.most), request.limit);
}

}  // namespace

void add_small(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(app, action, "small", "calls on few points", kHelp, request, measure_small);
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_runs_option(command, request->runs);
}

void add_scaling(CLI::App& app, Action& action) {
  const CLI::Range exponents(1, 30);
  const auto request = std::make_shared<Request>();
  request->distributions = {"uniform", "kuzmin", "line"};
  CLI::App* command = add_command(app, action, "scaling", "time per point over many sizes, modes beside CGAL",
                                  kHelp, request, measure_scaling);
  add_option(command, "--least", request->least, "least number of points, as a power of two")
      ->check(exponents);
  add_option(command, "--most", request->most, "greatest number of points, as a power of two")
      ->check(exponents);
  add_option(command, "--cgal-most", request->cgal_most, "the same for CGAL")->check(exponents);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_option(command, "--limit", request->limit, "what takes more seconds is not run at larger sizes");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench
