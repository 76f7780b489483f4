#include "tuning/arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>

#include "host/clock.hpp"
#include "launchers/call/rates.cl.hpp"
#include "tuning/tuning.hpp"
#ifndef FLAUNAY_WITHOUT_OPENCL
#include "host/opencl/programs.hpp"
#endif

namespace flaunay::tuning {
namespace {

// Compared to this, the time of the launch itself and the resolution of clocks are small.
constexpr double kLeastSeconds = 2e-4;
// The longest chain of a device that is faster than any, or of a clock that stands still.
constexpr std::size_t kFirstSteps = 64, kMostSteps = kFirstSteps << 16, kMoreSteps = 4;
// Both precisions take turns, since clocks of GPUs rise when there is work.
constexpr int kRuns = 4;
// No device is slower than this.
constexpr double kMostSlowness = 1e6;

constexpr Precision kBoth[] = {Precision::float32, Precision::float64};

// Chains of one precision: their length, and the shortest time that one took, with its launch.
struct Chains {
  std::size_t steps = kFirstSteps;
  double seconds = std::numeric_limits<double>::infinity();
};

// Also warms the device up.
Chains long_enough(const RunSteps& run_steps, Precision precision, double launch) {
  Chains chains;
  while (chains.steps < kMostSteps && run_steps(precision, chains.steps) < launch + kLeastSeconds) {
    chains.steps *= kMoreSteps;
  }
  return chains;
}

double launch_seconds(const RunSteps& run_steps, Precision precision) {
  constexpr std::size_t kOneStep = 1;
  run_steps(precision, kOneStep);  // compiles the kernel
  return std::min(run_steps(precision, kOneStep), run_steps(precision, kOneStep));
}

}  // namespace

double slowness_of_fp64(const RunSteps& run_steps) {
  Chains chains[2];
  double launch[2];
  for (int k = 0; k < 2; ++k) {
    launch[k] = launch_seconds(run_steps, kBoth[k]);
    chains[k] = long_enough(run_steps, kBoth[k], launch[k]);
  }
  for (int run = 0; run < kRuns; ++run) {
    for (int k = 0; k < 2; ++k) {
      chains[k].seconds = std::min(chains[k].seconds, run_steps(kBoth[k], chains[k].steps));
    }
  }
  double per_step[2];
  for (int k = 0; k < 2; ++k) {
    // On a busy device, launches of one step may have taken longer than launches of many steps.
    const double computing = std::max(chains[k].seconds - launch[k], chains[k].seconds / 2);
    per_step[k] = computing / static_cast<double>(chains[k].steps);
  }
  return per_step[1] / per_step[0];
}

double measured_slowness_of_fp64(host::Runtime& runtime) {
  // More than the lanes of any compute unit, so that each has another chain while it waits for one.
  constexpr std::size_t kWorkItemsPerUnit = 2048, kGroup = 256;
  const std::size_t work_items = kWorkItemsPerUnit * runtime.device().compute_units();
  host::Arena::Scope scope(runtime.arena());
  const auto in_single = runtime.arena().allocate<cl_float>(1);
  const auto in_double = runtime.arena().allocate<cl_double>(1);
  return slowness_of_fp64([&](Precision precision, std::size_t steps) {
    const auto length = static_cast<cl_int>(steps);
    const double begin = host::now();
    if (precision == Precision::float32) {
      runtime.launch(work_items, kGroup,
                     kernels::compute_in_single{.steps = length, .factor = 0.5F, .result = in_single});
    } else {
      runtime.launch(work_items, kGroup,
                     kernels::compute_in_double{.steps = length, .factor = 0.5, .result = in_double});
    }
    runtime.finish();
    return host::now() - begin;
  });
}

double remembered_slowness(const host::ProgramCache& cache, const std::string& key,
                           const std::function<double()>& measure) {
  const auto is_possible = [](double slowness) { return slowness > 0 && slowness < kMostSlowness; };
  if (const auto text = cache.load(key)) {
    const double slowness = std::strtod(text->c_str(), nullptr);
    if (is_possible(slowness)) return slowness;
  }
  const double slowness = measure();
  if (is_possible(slowness)) cache.store(key, fmt::format("{}", slowness));
  return slowness;
}

void choose_arithmetic(host::Runtime& runtime, const std::function<double()>& slowness) {
  const Tuning& tuning = tuning_of(runtime);
  if (tuning.fixed_point_from == 0) return;
  double found = 0;
  try {
    found = slowness();
  } catch (const std::exception&) {
    return;  // the self-test reports faults of the device
  }
  if (!(found >= static_cast<double>(tuning.fixed_point_from))) return;
  host::Capabilities capabilities = runtime.capabilities();
  capabilities.fixed_point = true;
  runtime.set_capabilities(capabilities);
}

void choose_arithmetic([[maybe_unused]] host::Runtime& runtime) {
#ifndef FLAUNAY_WITHOUT_OPENCL
  // For CPUs the result is known. A device that claims to be both is a simulator, whose times mean nothing.
  if (runtime.is_native() || (runtime.device().type() & CL_DEVICE_TYPE_CPU) != 0) return;
  choose_arithmetic(runtime, [&] {
    // A changed measurement is another one.
    const std::string key =
        fmt::format("slowness of fp64\n{}\n{}", runtime.identity(), host::kernel_source("call/rates"));
    return remembered_slowness(host::ProgramCache(host::default_cache_folder()), key,
                               [&] { return measured_slowness_of_fp64(runtime); });
  });
#endif
}

}  // namespace flaunay::tuning
