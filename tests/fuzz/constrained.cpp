// Makes segments edges of degenerate point sets, and compares the result with the definition: by the
// verifier, for small sets also by brute force; with that of the same segments in another order; and with
// those of devices. Segments that cross are split, and so are their reverses. Stops at the first wrong
// result, shrinks it and prints it as a test.
//
//   fuzz_constrained [--seconds N] [--seed S] [--first CASE]

#include "flaunay/constrained.hpp"

#include <fmt/format.h>
#include <gtest/gtest-spi.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "constrained/crossings/split.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/verify.hpp"
#include "prove/constrained_proof.hpp"
#include "tests/constrained/check.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/constrained/native.hpp"
#include "tests/fuzz/minimise.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/fuzz/segments.hpp"
#include "tests/support/environment.hpp"

namespace flaunay::fuzz {
namespace {

using testing::Edge;
using testing::Segments;
using Ids = std::vector<std::int32_t>;

struct Flat {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  Segments segments;
  std::vector<std::size_t> segment_offsets{0};
};

Flat flat(const SegmentBatch& batch) {
  Flat all;
  for (const SegmentSet& set : batch) {
    for (const std::int32_t v : set.segments)
      all.segments.push_back(static_cast<std::int32_t>(all.offsets.back()) + v);
    all.points.insert(all.points.end(), set.points.begin(), set.points.end());
    all.offsets.push_back(all.points.size() / 2);
    all.segment_offsets.push_back(all.segments.size() / 2);
  }
  return all;
}

Constraints constraints_of(const Flat& all) {
  Constraints constraints;
  constraints.segments = all.segments.data();
  constraints.segment_count = all.segments.size() / 2;
  return constraints;
}

Ids minus(const Ids& ids, std::size_t begin, std::size_t end, std::size_t base) {
  Ids result(ids.begin() + static_cast<std::ptrdiff_t>(begin),
             ids.begin() + static_cast<std::ptrdiff_t>(end));
  for (std::int32_t& id : result) id = id < 0 ? id : id - static_cast<std::int32_t>(base);
  return result;
}

/// Which domain is asked for.
struct Domain {
  bool is_asked_for = false;
  Outside outside = Outside::keep;
  FillRule fill_rule = FillRule::nesting;
  /// Each set has a hole at the place between two of its points with these numbers, if it has so many.
  std::int32_t points_of_hole[2] = {-1, -1};

  std::vector<double> hole_of(const SegmentSet& set) const {
    const auto n = static_cast<std::int32_t>(set.points.size() / 2);
    const std::int32_t a = points_of_hole[0], b = points_of_hole[1];
    if (a < 0 || a >= n || b >= n) return {};
    return {set.points[2 * a] / 2 + set.points[2 * b] / 2,
            set.points[2 * a + 1] / 2 + set.points[2 * b + 1] / 2};
  }
};

/// Whether the verifier says what is wrong with the input of a set, before it looks for triangles.
bool verifier_refuses(const SegmentBatch& batch, const Domain& domain) {
  for (const SegmentSet& set : batch) {
    const std::vector<double> hole = domain.hole_of(set);
    VerifyConstraints constraints;
    constraints.segments = &set.segments;
    constraints.outside =
        domain.is_asked_for && domain.outside == Outside::keep ? Outside::hull : domain.outside;
    constraints.fill_rule = domain.fill_rule;
    if (!hole.empty()) constraints.holes = &hole;
    const VerifyReport report =
        verify_constrained(set.points.data(), set.points.size() / 2, {}, nullptr, constraints);
    for (const char* const problem : {" cross at a place that is no point", "hole 0", " no closed curves"}) {
      if (report.problem.find(problem) != std::string::npos) return true;
    }
  }
  return false;
}

/// By brute force: what is wrong with a result, or with the message if there is none.
std::string compare_with_definition(const Flat& all, const Triangulation& delaunay,
                                    const std::optional<ConstrainedTriangulation>& result,
                                    const std::string& error) {
  testing::Plane plane(all.points);
  const auto edges = testing::expected_edges(all.points, all.offsets, delaunay, all.segments);
  const Edge crossing = testing::expected_crossing(all.offsets, edges, plane);
  if ((crossing.first >= 0) != !result.has_value()) {
    return result ? "segments cross, without an error" : "segments do not cross: " + error;
  }
  if (!result) {
    const auto names = [&](const std::string& begin, std::int32_t s) {
      return error.find(begin + std::to_string(s) + " (points ") != std::string::npos;
    };
    if (names("segments ", crossing.first) && names(" and ", crossing.second)) return "";
    return fmt::format("segments {} and {} should be named: {}", crossing.first, crossing.second, error);
  }
  ::testing::TestPartResultArray failures;
  {
    const ::testing::ScopedFakeTestPartResultReporter reporter(&failures);
    testing::expect_edges(edges, *result);
    testing::expect_canonical(all.points, delaunay, *result);
  }
  return failures.size() == 0 ? "" : failures.GetTestPartResult(0).message();
}

struct Outcome {
  std::string error;  // empty if there is a result
  std::optional<ConstrainedTriangulation> result;
};

Outcome constrain(const Flat& all, const Triangulation& delaunay, const Segments& segments) {
  try {
    return {"", testing::insert(all.points, all.offsets, delaunay, segments)};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    return {error.what(), std::nullopt};
  }
}

/// Inserts from the last segment to the first, each the other way round: what differs, or "".
std::string compare_with_reversed(const Flat& all, const Triangulation& delaunay,
                                  const ConstrainedTriangulation& result) {
  const Segments reversed(all.segments.rbegin(), all.segments.rend());
  const Outcome other = constrain(all, delaunay, reversed);
  if (!other.result) return "other segments cross if they are reversed: " + other.error;
  const auto arrays = [](const ConstrainedTriangulation& r) {
    return std::tie(r.triangles, r.neighbors, r.constraint_edges);
  };
  return arrays(result) == arrays(*other.result) ? "" : "reversed segments have another result";
}

/// The places along each segment where its pieces begin and end, from its lexicographically smaller end on;
/// none if its pieces are no such chain.
std::vector<Coordinates> chains(const Flat& all, const constrained::Split& split,
                                const constrained::AllPoints& joined) {
  std::vector<Coordinates> chains;
  for (std::size_t s = 0; 2 * s < all.segments.size(); ++s) {
    const auto place = [&](std::int32_t piece, bool at_second) {
      const auto p = static_cast<std::size_t>(joined.place[split.pieces[2 * piece + at_second]]);
      return std::pair(joined.coordinates[2 * p], joined.coordinates[2 * p + 1]);
    };
    const auto end = [&](bool second) {
      const auto p = static_cast<std::size_t>(all.segments[2 * s + second]);
      return std::pair(all.points[2 * p], all.points[2 * p + 1]);
    };
    const bool is_descending = end(true) < end(false);
    auto last = end(is_descending);
    Coordinates chain = {last.first, last.second};
    for (std::int32_t k = split.piece_offsets[s]; k < split.piece_offsets[s + 1]; ++k) {
      if (place(k, is_descending) != last) chain.clear();
      last = place(k, !is_descending);
      chain.insert(chain.end(), {last.first, last.second});
    }
    if (last != end(!is_descending)) chain.clear();
    chains.push_back(chain);
  }
  return chains;
}

/// Whether the pieces of segments that cross are chains from end to end, do not cross, and do not depend on
/// the order and direction of segments; and whether the triangulation with them is right.
std::string check_split(const Flat& all) {
  constexpr std::size_t kMostSegments = 400;
  if (all.segments.size() / 2 > kMostSegments) return "";
  const constrained::Split split = constrained::split(all.points.data(), all.offsets, all.segments);
  const constrained::AllPoints joined = constrained::join_added(all.points.data(), all.offsets, split);
  const std::vector<Coordinates> found = chains(all, split, joined);
  if (std::any_of(found.begin(), found.end(), [](const Coordinates& chain) { return chain.empty(); }))
    return "the pieces of a segment do not follow each other";

  Flat reversed = all;
  std::reverse(reversed.segments.begin(), reversed.segments.end());
  const constrained::Split again = constrained::split(all.points.data(), all.offsets, reversed.segments);
  std::vector<Coordinates> others =
      chains(reversed, again, constrained::join_added(all.points.data(), all.offsets, again));
  std::reverse(others.begin(), others.end());
  if (others != found) return "reversed segments have other pieces";

  Flat pieces{joined.coordinates, joined.offsets, {}, {}};
  for (const std::int32_t index : split.pieces) pieces.segments.push_back(joined.place[index]);
  SegmentBatch batch;
  for (std::size_t s = 0; s + 1 < all.offsets.size(); ++s) {
    const auto first = static_cast<std::size_t>(split.piece_offsets[all.segment_offsets[s]]),
               last = static_cast<std::size_t>(split.piece_offsets[all.segment_offsets[s + 1]]);
    batch.push_back({{joined.coordinates.begin() + static_cast<std::ptrdiff_t>(2 * joined.offsets[s]),
                      joined.coordinates.begin() + static_cast<std::ptrdiff_t>(2 * joined.offsets[s + 1])},
                     minus(pieces.segments, 2 * first, 2 * last, joined.offsets[s])});
  }
  pieces = flat(batch);
  const Triangulation delaunay = testing::delaunay_of(pieces.points, pieces.offsets);
  const Outcome outcome = constrain(pieces, delaunay, pieces.segments);
  if (!outcome.result) return "pieces cross: " + outcome.error;
  return verify(pieces.points.data(), pieces.offsets, constraints_of(pieces), {}, *outcome.result);
}

struct Verdict {
  std::string problem;   // empty if nothing is wrong
  bool refused = false;  // out of the range of magnitudes
  bool crosses = false;
};

class Devices {
 public:
  Devices() {
    add("host", "");
    add("host", "small");
    add("", "");                               // small sets on the calling thread, segment by segment
    add("#0", "gpu:32,chain_wrapped_most=5");  // takes some milliseconds per case
    add("#0", "gpu:32,chain_wrapped_most=5,fixed_point=1");
    // Kernels are compiled now, since that takes longer than a case may.
    const testing::SegmentInput any = testing::nasty_detail::spirals(200, 1);
    const Flat flat_any{any.points, {0, any.points.size() / 2}, any.segments, {}};
    ConstrainedOptions options;
    options.labels = true;
    options.outside = Outside::hull;
    const Flat square{{0, 0, 4, 0, 4, 4, 0, 4, 1, 2}, {0, 5}, {0, 1, 1, 2, 2, 3, 3, 0}, {}};
    const double hole[] = {2, 1};
    Constraints with_hole = constraints_of(square);
    with_hole.holes = hole;
    with_hole.hole_count = 1;
    for (const Tuned& tuned : all_) {
      compare(flat_any, *tuned.triangulator);
      options.fill_rule = FillRule::nesting;
      tuned.triangulator->constrained(flat_any.points.data(), flat_any.offsets, constraints_of(flat_any),
                                      options);
      for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
        options.fill_rule = rule;
        tuned.triangulator->constrained(square.points.data(), square.offsets, with_hole, options);
      }
    }
  }

  /// Whether the public call has the result of the insertion alone: natively, and if asked for also by
  /// OpenCL, with sizes by which few segments are many groups and rounds.
  std::string compare(const Flat& all, bool with_opencl) {
    for (const Tuned& tuned : all_) {
      if (tuned.is_opencl && !with_opencl) continue;
      start_check();
      const std::string problem = compare(all, *tuned.triangulator);
      if (!problem.empty()) return fmt::format("{}: {}", tuned.name, problem);
    }
    return "";
  }

  /// Whether the triangles and labels of a domain are right.
  std::string check_domain(const SegmentBatch& batch, const Flat& all, const Domain& domain,
                           bool with_opencl) {
    std::vector<double> holes;
    std::vector<std::size_t> hole_offsets{0};
    for (const SegmentSet& set : batch) {
      const std::vector<double> hole = domain.hole_of(set);
      holes.insert(holes.end(), hole.begin(), hole.end());
      hole_offsets.push_back(holes.size() / 2);
    }
    Constraints constraints = constraints_of(all);
    constraints.holes = holes.data();
    constraints.hole_count = holes.size() / 2;
    constraints.hole_offsets = hole_offsets;
    ConstrainedOptions options;
    options.neighbors = true;
    options.labels = true;
    options.outside = domain.outside;
    options.fill_rule = domain.fill_rule;
    for (const Tuned& tuned : all_) {
      if (tuned.is_opencl && !with_opencl) continue;
      start_check();
      std::string problem;
      try {
        const ConstrainedTriangulation result =
            tuned.triangulator->constrained(all.points.data(), all.offsets, constraints, options);
        problem = verify(all.points.data(), all.offsets, constraints, options, result);
      } catch (const Error& error) {
        const bool is_fine = error.kind() == ErrorKind::input && verifier_refuses(batch, domain);
        if (!is_fine) problem = error.what();
      }
      if (!problem.empty()) return fmt::format("{}, domain: {}", tuned.name, problem);
    }
    return "";
  }

 private:
  struct Tuned {
    std::string name;
    bool is_opencl;
    std::unique_ptr<Triangulator> triangulator;
  };

  void add(const std::string& device, const std::string& tuning) {
    const testing::ScopedEnvironment environment("FLAUNAY_TUNING", tuning.c_str());
    all_.push_back({fmt::format("device {} tuned '{}'", device, tuning), device == "#0",
                    std::make_unique<Triangulator>(device)});
  }

  static std::string compare(const Flat& all, Triangulator& triangulator) {
    Options options;
    options.neighbors = true;
    const Triangulation delaunay = triangulator.triangulate(all.points.data(), all.offsets, options);
    const Outcome expected = constrain(all, delaunay, all.segments);
    const Constraints constraints = constraints_of(all);
    ConstrainedOptions constrained_options;
    constrained_options.neighbors = true;
    try {
      const ConstrainedTriangulation result =
          triangulator.constrained(all.points.data(), all.offsets, constraints, constrained_options);
      if (!expected.result) return "has a result instead of the error: " + expected.error;
      if (result.constrained != expected.result->constrained) return "its marks of constraints differ";
      if (result.triangles != expected.result->triangles) return "its triangles differ";
      if (result.neighbors != expected.result->neighbors) return "its neighbours differ";
      if (result.constraint_edges != expected.result->constraint_edges) return "its edges differ";
      if (result.piece_edges != expected.result->piece_edges) return "its pieces differ";
      return "";
    } catch (const Error& error) {
      if (error.what() == expected.error) return "";
      return fmt::format("its error is '{}' instead of '{}'", error.what(), expected.error);
    }
  }

  std::vector<Tuned> all_;
};

std::string problem_of(const SegmentBatch& batch, const Flat& all, const Triangulation& delaunay,
                       const Outcome& outcome) {
  // The number of comparisons that brute force may take.
  constexpr std::size_t kMostSteps = 100'000;
  std::string problem;
  if (all.points.size() * (all.segments.size() + 1) <= kMostSteps) {
    problem = compare_with_definition(all, delaunay, outcome.result, outcome.error);
  }
  if (!problem.empty()) return problem;
  if (!outcome.result) {
    return verifier_refuses(batch, {}) ? "" : "the verifier finds no crossing, but: " + outcome.error;
  }
  problem = verify(all.points.data(), all.offsets, constraints_of(all), {}, *outcome.result);
  return problem.empty() ? compare_with_reversed(all, delaunay, *outcome.result) : problem;
}

class Constrained : public Fuzzer {
 public:
  bool run(testing::FixtureRandom& random) override {
    const Domain domain = any_domain(random);
    const bool has_curves = domain.fill_rule != FillRule::nesting || random.integer(1, 10) == 1;
    const SegmentBatch batch = has_curves ? closed_curves(random) : degenerate_segments(random);
    const bool with_opencl = random.integer(1, 8) == 1;
    const Verdict verdict = judge(batch, domain, with_opencl);
    if (!verdict.problem.empty()) {
      report(batch, domain, with_opencl);
      return false;
    }
    refused_ += verdict.refused;
    crossing_ += verdict.crosses;
    for (const SegmentSet& set : batch) {
      points_ += set.points.size() / 2;
      segments_ += set.segments.size() / 2;
    }
    return true;
  }

  std::string summary() const override {
    return fmt::format("{} points and {} segments are right; segments of {} cross, {} were refused", points_,
                       segments_, crossing_, refused_);
  }

 private:
  static Domain any_domain(testing::FixtureRandom& random) {
    Domain domain;
    domain.is_asked_for = random.integer(0, 1) == 0;
    if (!domain.is_asked_for) return domain;
    domain.outside = static_cast<Outside>(random.integer(0, 2));
    domain.fill_rule = static_cast<FillRule>(random.integer(0, 2));
    if (random.integer(0, 2) == 0) {
      for (std::int32_t& v : domain.points_of_hole) v = static_cast<std::int32_t>(random.integer(0, 12));
    }
    return domain;
  }

  Verdict judge(const SegmentBatch& batch, const Domain& domain, bool with_opencl) {
    const Flat all = flat(batch);
    Triangulation delaunay;
    try {
      delaunay = testing::delaunay_of(all.points, all.offsets);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) return {error.what()};
      return {"", true};
    }
    try {
      const Outcome outcome = constrain(all, delaunay, all.segments);
      std::string problem = problem_of(batch, all, delaunay, outcome);
      if (problem.empty() && !outcome.result) problem = check_split(all);
      if (problem.empty()) problem = devices_.compare(all, with_opencl);
      if (problem.empty() && domain.is_asked_for)
        problem = devices_.check_domain(batch, all, domain, with_opencl);
      return {problem, false, !outcome.result};
    } catch (const Error& error) {
      return {error.what()};
    }
  }

  void report(const SegmentBatch& batch, const Domain& domain, bool with_opencl) {
    const auto problem_of = [=, this](const SegmentBatch& smaller) {
      start_check();
      return judge(smaller, domain, with_opencl).problem;
    };
    fmt::print("{}\n{}\n{} sets; shrinking them\n", case_name(), problem_of(batch), batch.size());
    std::fflush(stdout);
    const SegmentsFail fails = [&](const SegmentBatch& smaller) { return !problem_of(smaller).empty(); };
    const SegmentBatch smallest = minimise(batch, fails);
    fmt::print("{}", test_text(smallest, fmt::format("{}\n{}", case_name(), problem_of(smallest))));
  }

  Devices devices_;
  std::size_t points_ = 0, segments_ = 0, crossing_ = 0, refused_ = 0;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  return flaunay::fuzz::run_fuzzer<flaunay::fuzz::Constrained>(
      argc, argv, "fuzz_constrained",
      "Makes segments edges of degenerate point sets until a result is wrong or the time is over.");
}
