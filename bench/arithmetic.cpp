// flaunay-bench arithmetic: double precision beside fixed point, on one device.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "contest.hpp"

namespace flaunay::bench::arithmetic {
namespace {

struct Request : Measurement {
  std::vector<std::size_t> sizes{1000000};
  std::vector<std::string> distributions{"uniform"};
};

constexpr const char* kHelp =
    "Calls on points in host memory, by two triangulators that take turns: one whose kernels compute in "
    "double "
    "precision, and one whose kernels compute in fixed point. Coordinates are rounded to multiples of 2^-61 "
    "of "
    "the power of two above the largest, so that fixed point takes them. The exit code is 1 if numbers of "
    "triangles differ.";

// Multiples of 2^-kPlaces of the power of two above the largest coordinate.
constexpr int kPlaces = 61;

void round_to_places(Input& input) {
  double largest = 0;
  for (const double x : input.coordinates) largest = std::max(largest, std::fabs(x));
  const int shift = kPlaces - 1 - (largest == 0 ? 0 : std::ilogb(largest));
  for (double& x : input.coordinates) x = std::ldexp(std::nearbyint(std::ldexp(x, shift)), -shift);
}

// Its kernels compute so whatever the device's tuning says. What else FLAUNAY_TUNING says holds for both.
Triangulator triangulator_with(const Request& request, bool in_fixed_point) {
  constexpr const char* kTuning = "FLAUNAY_TUNING";
  const char* const given = std::getenv(kTuning);
  const std::string kept = given == nullptr ? "" : given;
  const std::string own = in_fixed_point ? "fixed_point=1" : "fixed_point=0";
  setenv(kTuning, kept.empty() ? own.c_str() : (kept + "," + own).c_str(), 1);
  Triangulator triangulator(request.device.empty() ? "#0" : request.device);
  if (kept.empty()) {
    unsetenv(kTuning);
  } else {
    setenv(kTuning, kept.c_str(), 1);
  }
  return triangulator;
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
  Triangulator doubles = triangulator_with(request, false), fixed = triangulator_with(request, true);
  const research::Options options = options_of(to_string(kDefaultMode));
  Entries entries = make_entries({mode_implementation(doubles, "double-precision", options),
                                  mode_implementation(fixed, "fixed-point", options)},
                                 inputs);
  measure(entries, request.runs);
  Result result{fixed.device()};
  result.agree = check_counts(entries);
  add_entries(result.tables, entries);
  result.tables["ratios"] = ratios_of(entries);
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(app, action, "arithmetic", "double precision beside fixed point", kHelp,
                                  request, measure_both);
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::arithmetic
