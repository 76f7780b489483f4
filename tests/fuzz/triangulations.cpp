// Triangulates degenerate point sets in all modes, and compares the results with each other, with the exact
// check and, for small sets, with the reference in GMP. Stops at the first wrong result, shrinks its points
// and prints them.
//
//   fuzz_triangulations [--tunings] [--seconds N] [--seed S] [--first CASE]
//
// With --tunings, mode blocks alone, with sizes of GPUs and in both arithmetics: batches, and single sets of
// 5,000 to 100,000 points.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "flaunay/verify.hpp"
#include "tests/fuzz/degenerate.hpp"
#include "tests/fuzz/minimise.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::fuzz {
namespace {

using research::Mode;

// -----------------------------------------------------------------------------------------------------------
// One mode's result

/// What must be the same in every mode.
struct Outcome {
  std::string error;
  testing::TriangleSet triangles;
  std::vector<std::int32_t> hull, representatives;
  std::vector<std::size_t> triangle_offsets, hull_offsets;
};

/// In what they differ; empty if they do not.
std::string difference(const Outcome& a, const Outcome& b) {
  if (a.error != b.error) return fmt::format("their errors, '{}' and '{}'", a.error, b.error);
  if (a.triangles != b.triangles || a.triangle_offsets != b.triangle_offsets) return "their triangles";
  if (a.hull != b.hull || a.hull_offsets != b.hull_offsets) return "their hulls";
  if (a.representatives != b.representatives) return "their representatives";
  return "";
}

struct Execution {
  std::string name;
  Triangulator* triangulator = nullptr;  // null: on the host
  research::Options options;
};

struct Flat {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
};

Flat flat(const Batch& batch) {
  Flat all;
  for (const Coordinates& set : batch) {
    all.points.insert(all.points.end(), set.begin(), set.end());
    all.offsets.push_back(all.points.size() / 2);
  }
  return all;
}

research::Triangulation triangulate(const Execution& execution, const Flat& points) {
  if (execution.triangulator == nullptr) {
    return research::triangulate_on_host(points.points.data(), points.offsets, execution.options);
  }
  return research::triangulate(*execution.triangulator, points.points.data(), points.offsets,
                               execution.options);
}

/// What is wrong with a result beside the points alone; empty if nothing is.
std::string problem_of(const Batch& batch, const Flat& points, const research::Triangulation& mesh) {
  constexpr std::size_t kMostForReference = 40;
  if (mesh.triangle_offsets.size() != batch.size() + 1) return "wrong number of sets";
  const std::string problem = verify(points.points.data(), points.offsets, mesh);
  if (!problem.empty()) return problem;
  if (mesh.halfedges != testing::reference_halfedges(mesh.triangles)) return "the halfedges are wrong";
  if (batch.size() == 1 && batch[0].size() / 2 <= kMostForReference &&
      testing::sorted_triangles(mesh.triangles) != testing::reference_delaunay(batch[0])) {
    return "not the canonical triangulation";
  }
  return "";
}

// -----------------------------------------------------------------------------------------------------------
// All modes

/// The triangulators that all cases share: as users have them, and with sizes by which few points are many
/// blocks, chunks and groups.
class Triangulators {
 public:
  Triangulators() {
    for (const char* const tuning : {"", "cpu,block_points=6", "gpu:32", "small-blocks"}) {
      const testing::ScopedEnvironment environment("FLAUNAY_TUNING", tuning);
      all_.push_back(
          {*tuning == '\0' ? "" : fmt::format(" tuned {}", tuning), std::make_unique<Triangulator>()});
    }
  }

  /// What to run for so many points. Variants are drawn, since all of them would take too long.
  std::vector<Execution> executions(testing::FixtureRandom& random, std::size_t points) {
    // The kernels of recursive-device take milliseconds per region, and small chunks are slow in any mode.
    constexpr std::size_t kMostOneByOne = 30, kMostInSmallChunks = 300;
    const bool in_small_chunks = points <= kMostInSmallChunks;
    constexpr research::Hull kHulls[] = {research::Hull::prune, research::Hull::quickhull,
                                         research::Hull::balanced};
    research::Options options;
    options.halfedges = true;
    options.cut = random.integer(0, 1) == 0 ? research::Cut::interquartile : research::Cut::alternate;
    options.hull = kHulls[random.integer(0, std::ssize(kHulls) - 1)];
    options.partition_levels = static_cast<int>(random.integer(1, 6));
    options.threads = 2;
    const Tuned &own = all_.front(), &small = all_.back();
    const Tuned& any = in_small_chunks && random.integer(0, 1) == 0 ? small : own;

    std::vector<Execution> chosen{
        execution(Mode::dwyer, options, nullptr), execution(Mode::recursive, options, nullptr),
        execution(Mode::flattened, options, &any), execution(Mode::partition, options, &own)};
    for (const Tuned& tuned : all_) {
      if (&tuned != &small || in_small_chunks) chosen.push_back(execution(Mode::blocks, options, &tuned));
    }
    if (points <= kMostOneByOne) chosen.push_back(execution(Mode::recursive_device, options, &own));
    return chosen;
  }

 private:
  struct Tuned {
    std::string name;
    std::unique_ptr<Triangulator> triangulator;
  };

  /// Without `tuned`, on the host.
  static Execution execution(Mode mode, research::Options options, const Tuned* tuned) {
    options.mode = mode;
    const std::string name = fmt::format("{}{} (cut {}, hull {})", to_string(mode), tuned ? tuned->name : "",
                                         to_string(options.cut), to_string(options.hull));
    return {name, tuned ? tuned->triangulator.get() : nullptr, options};
  }

  std::vector<Tuned> all_;
};

struct Verdict {
  std::string problem;   // empty if nothing is wrong
  bool refused = false;  // all modes say that the batch is out of the range of magnitudes
};

Verdict judge(const Batch& batch, const std::vector<Execution>& executions) {
  const Flat points = flat(batch);
  std::optional<Outcome> expected;
  for (const Execution& execution : executions) {
    Outcome outcome;
    try {
      research::Triangulation mesh = triangulate(execution, points);
      const std::string problem = problem_of(batch, points, mesh);
      if (!problem.empty()) return {execution.name + ": " + problem};
      outcome = {"",
                 testing::sorted_triangles(mesh.triangles),
                 std::move(mesh.hull),
                 std::move(mesh.representatives),
                 std::move(mesh.triangle_offsets),
                 std::move(mesh.hull_offsets)};
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) return {fmt::format("{}: {}", execution.name, error.what())};
      outcome.error = error.what();
    }
    if (!expected) expected = outcome;
    const std::string differ = difference(*expected, outcome);
    if (!differ.empty()) {
      return {fmt::format("{} and {} differ in {}", executions[0].name, execution.name, differ)};
    }
  }
  return {"", !expected->error.empty()};
}

/// Mode blocks with many sizes: natively, so that no compiler of a driver is between, and on the first
/// device.
class ManyTunings {
 public:
  ManyTunings() {
    for (const char* const tuning : {"", "gpu", "gpu:32", "small", "small-blocks", "gpu,round_points=64"})
      add(native_, "host", tuning);
    for (const char* const tuning :
         {"gpu", "gpu:32", "gpu,fixed_point=1", "gpu:32,round_points=64,fixed_point=1"})
      add(on_device_, "#0", tuning);
  }

  std::vector<Execution> executions(testing::FixtureRandom& random, std::size_t points) {
    // With the sizes of GPUs, a CPU's devices are slow, and with small ones everything is.
    constexpr std::size_t kMostOnDevice = 20000, kMostInSmallChunks = 20000;
    std::vector<Execution> chosen(1);
    chosen[0].name = "dwyer";
    chosen[0].options.mode = Mode::dwyer;
    chosen[0].options.halfedges = true;
    for (const Tuned& tuned : native_) {
      if (points <= kMostInSmallChunks || tuned.name.find("small") == std::string::npos)
        chosen.push_back(of(tuned));
    }
    if (points <= kMostOnDevice)
      chosen.push_back(of(on_device_[random.integer(0, std::ssize(on_device_) - 1)]));
    return chosen;
  }

 private:
  struct Tuned {
    std::string name;
    std::unique_ptr<Triangulator> triangulator;
  };

  static void add(std::vector<Tuned>& to, const char* device, const char* tuning) {
    const testing::ScopedEnvironment environment("FLAUNAY_TUNING", tuning);
    to.push_back(
        {fmt::format("blocks on {} tuned '{}'", device, tuning), std::make_unique<Triangulator>(device)});
  }
  static Execution of(const Tuned& tuned) {
    Execution execution{tuned.name, tuned.triangulator.get(), {}};
    execution.options.halfedges = true;
    return execution;
  }

  std::vector<Tuned> native_, on_device_;
};

Batch batch_or_large_set(testing::FixtureRandom& random) {
  return random.integer(0, 1) == 0 ? degenerate_batch(random) : large_set(random);
}

template <typename Triangulators, Batch (*MakeBatch)(testing::FixtureRandom&)>
class Triangulations : public Fuzzer {
 public:
  bool run(testing::FixtureRandom& random) override {
    const Batch batch = MakeBatch(random);
    const std::vector<Execution> executions = triangulators_.executions(random, points_of(batch));
    const Verdict verdict = judge(batch, executions);
    if (!verdict.problem.empty()) {
      report(batch, executions);
      return false;
    }
    refused_ += verdict.refused;
    sets_ += batch.size();
    points_ += points_of(batch);
    return true;
  }

  std::string summary() const override {
    return fmt::format("{} sets and {} points are right in all modes, {} of them refused by all", sets_,
                       points_, refused_);
  }

 private:
  static void report(const Batch& batch, const std::vector<Execution>& executions) {
    const auto problem_of = [&](const Batch& smaller) {
      start_check();
      return judge(smaller, executions).problem;
    };
    const auto fails = [&](const Batch& smaller) { return !problem_of(smaller).empty(); };
    fmt::print("{}\n{}\n{} points in {} sets; shrinking them\n", case_name(), problem_of(batch),
               points_of(batch), batch.size());
    std::fflush(stdout);
    const Batch smallest = minimise(batch, fails);
    fmt::print("A fixture for tests/data:\n{}",
               fixture_text(smallest, fmt::format("{}\n{}", case_name(), problem_of(smallest))));
  }

  Triangulators triangulators_;
  std::size_t sets_ = 0, points_ = 0, refused_ = 0;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  using namespace flaunay::fuzz;
  constexpr const char* kDescription =
      "Triangulates degenerate point sets in all modes until a result is wrong or the time is over.";
  if (argc < 2 || std::string(argv[1]) != "--tunings") {
    using AllModes = Triangulations<Triangulators, degenerate_batch>;
    return run_fuzzer<AllModes>(argc, argv, "fuzz_triangulations", kDescription);
  }
  std::swap(argv[0], argv[1]);
  using Tuned = Triangulations<ManyTunings, batch_or_large_set>;
  return run_fuzzer<Tuned>(argc - 1, argv + 1, "fuzz_triangulations --tunings", kDescription);
}
