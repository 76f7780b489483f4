// flaunay-bench arithmetic: double precision beside fixed point, on one device.
#include <algorithm>
#include <cmath>

#include "bench/measuring/contest.hpp"
#include "bench/measuring/processes.hpp"

namespace flaunay::bench::arithmetic {
namespace {

// Multiples of 2^-kPlaces of the power of two above the largest coordinate.
constexpr int kPlaces = 61;

void round_to_places(Input& input) {
  double largest = 0;
  for (const double x : input.coordinates) largest = std::max(largest, std::fabs(x));
  const int shift = kPlaces - 1 - (largest == 0 ? 0 : std::ilogb(largest));
  for (double& x : input.coordinates) x = std::ldexp(std::nearbyint(std::ldexp(x, shift)), -shift);
}

// Its kernels compute so whatever the device's tuning says. What else FLAUNAY_TUNING says holds for both.
Triangulator triangulator_with(const Request& request, const std::string& arithmetic) {
  const std::string other = variable("FLAUNAY_TUNING");
  const WithVariable tuning("FLAUNAY_TUNING", other.empty() ? arithmetic : other + "," + arithmetic);
  return Triangulator(request.device.empty() ? "#0" : request.device);
}

/// Fixed point over double precision, by input.
Json ratios_of(const Entries& entries) {
  Json ratios = Json::array();
  for (std::size_t e = 0; e + 1 < entries.size(); e += 2) {
    const Entry &doubles = entries[e], &fixed = entries[e + 1];
    if (!doubles.valid() || !fixed.valid()) continue;
    ratios.push_back({{"distribution", fixed.input->distribution},
                      {"n", fixed.input->n},
                      {"fixed_point_over_doubles", fixed.median() / doubles.median()}});
  }
  return ratios;
}

Result measure_both(const Request& request) {
  std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  for (Input& input : inputs) round_to_places(input);
  Triangulator doubles = triangulator_with(request, "fixed_point=0"),
               fixed = triangulator_with(request, "fixed_point=1");
  const research::Options options = options_of("blocks");
  Entries entries = make_entries({mode_implementation(doubles, "double-precision", options),
                                  mode_implementation(fixed, "fixed-point", options)},
                                 inputs);
  measure(entries, request.runs);
  Result result(fixed.device());
  add_entries(result, entries);
  result.tables["ratios"] = ratios_of(entries);
  return result;
}

const Subcommand kSubcommand(
    "arithmetic", "double precision beside fixed point",
    "Calls on points in host memory, by two triangulators that take turns: one whose kernels compute in "
    "double "
    "precision, and one whose kernels compute in fixed point. Coordinates are rounded to multiples of 2^-61 "
    "of "
    "the power of two above the largest, so that fixed point takes them. The exit code is 1 if numbers of "
    "triangles differ.",
    measure_both,
    [](Options& options, Request&) { options.sizes({1000000}).distributions({"uniform"}).runs(); });

}  // namespace
}  // namespace flaunay::bench::arithmetic
