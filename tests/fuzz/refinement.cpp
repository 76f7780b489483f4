// Refines nasty domains, with random demands, and checks the results by their definition; compares them with
// those of the same domain in another order, and with those of other runtimes. Stops at the first wrong
// result, shrinks and prints it.
//
//   fuzz_refinement [--seconds N] [--seed S] [--first CASE]

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "constrained/refinement/refine.hpp"
#include "prove/constrained_proof.hpp"
#include "tests/constrained/nasty_domains.hpp"
#include "tests/constrained/refined.hpp"
#include "tests/fuzz/minimise.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/support/runtimes.hpp"

namespace flaunay::fuzz {
namespace {

using constrained::MeshToRefine;
using constrained::RefinedMesh;
using testing::DomainToRefine;
using testing::FixtureRandom;

bool once_in(FixtureRandom& random, std::int64_t times) { return random.integer(1, times) == 1; }

/// What is asked for. Of edges and regions it depends on coordinates alone, so that domains can be shrunk.
struct Demands {
  Refinement wanted;
  std::uint64_t kept_salt = 0;                        ///< decides which edges are kept; 0: none
  double region_area = 0;                             ///< regions have areas around this; 0: any
  std::size_t block = constrained::kRefinementBlock;  ///< bad triangles per block

  std::string text() const {
    return fmt::format(
        "min_angle {}, max_area {}, areas_at {}, min_edge {}, most_points {}, most_rounds {}, "
        "conforming {}, smoothing_steps {}, kept_salt {}, region_area {}, block {}",
        wanted.min_angle, wanted.max_area, static_cast<bool>(wanted.areas_at), wanted.min_edge,
        wanted.most_points, wanted.most_rounds, wanted.conforming, wanted.smoothing_steps, kept_salt,
        region_area, block);
  }
};

double extent_of(const Coordinates& points) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (std::size_t i = 0; i < points.size(); ++i) {
    low[i % 2] = std::min(low[i % 2], points[i]);
    high[i % 2] = std::max(high[i % 2], points[i]);
  }
  return std::max(high[0] - low[0], high[1] - low[1]);
}

Demands any_demands(FixtureRandom& random, const DomainToRefine& domain) {
  static constexpr double kAngles[] = {0, 1, 10, 20.7, 25, 28.6, 30, 30, 30, 31, 33, 34};
  Demands demands;
  Refinement& wanted = demands.wanted;
  wanted.min_angle = kAngles[random.integer(0, 11)];
  const double extent = extent_of(domain.points), square = extent * extent;
  const double area = square * std::pow(10.0, -1 - 2 * random.unit());
  if (wanted.min_angle == 0 || once_in(random, 5)) wanted.max_area = area;
  if (once_in(random, 10) && std::isfinite(4 * area)) demands.region_area = area;
  if (once_in(random, 10)) {
    const double x = domain.points[0], y = domain.points[1];
    wanted.areas_at = [=](const double* places, std::size_t count, double* areas) {
      for (std::size_t i = 0; i < count; ++i) {
        const double distance = std::hypot(places[2 * i] - x, places[2 * i + 1] - y) / extent;
        areas[i] = square * (0.001 + 0.1 * distance);
      }
    };
  }
  if (once_in(random, 3)) wanted.min_edge = extent * std::pow(10.0, -6 * random.unit());
  wanted.most_points = static_cast<std::size_t>(once_in(random, 8) ? random.integer(0, 300) : 3000);
  wanted.most_rounds = once_in(random, 10) ? static_cast<std::size_t>(random.integer(0, 30)) : 2000;
  wanted.conforming = once_in(random, 8);
  if (once_in(random, 4)) wanted.smoothing_steps = static_cast<std::size_t>(random.integer(1, 4));
  if (once_in(random, 6)) demands.kept_salt = static_cast<std::uint64_t>(random.integer(1, 1 << 30));
  if (once_in(random, 2)) demands.block = std::size_t{1} << random.integer(0, 7);
  return demands;
}

std::uint64_t hash_of(const double* p, std::uint64_t salt) {
  std::uint64_t hash = salt;
  for (int k = 0; k < 2; ++k)
    hash = (hash ^ std::bit_cast<std::uint64_t>(p[k] + 0.0)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
  return hash;
}

MeshToRefine mesh_of(const DomainToRefine& domain, const Demands& demands) {
  MeshToRefine mesh = testing::mesh_to_refine(domain);
  if (demands.kept_salt != 0) {
    for (std::size_t e = 0; e < mesh.edge_ends.size(); e += 2) {
      const std::uint64_t hash = hash_of(mesh.coordinates + 2 * mesh.edge_ends[e], demands.kept_salt) ^
                                 hash_of(mesh.coordinates + 2 * mesh.edge_ends[e + 1], demands.kept_salt);
      mesh.kept_edges.push_back(hash % 3 == 0);
    }
  }
  if (demands.region_area > 0) {
    // By a vertex of each region.
    const std::vector<std::int32_t> regions = testing::regions_of(mesh.neighbors, mesh.edges);
    std::map<std::int32_t, std::pair<double, double>> smallest;
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
      const double* const p = mesh.coordinates + 2 * mesh.triangles[c];
      const auto place = std::pair(p[0], p[1]);
      const auto found = smallest.emplace(regions[c / 3], place).first;
      found->second = std::min(found->second, place);
    }
    for (const std::int32_t region : regions) {
      const double p[2] = {smallest[region].first, smallest[region].second};
      mesh.largest_areas.push_back(demands.region_area * static_cast<double>(hash_of(p, 1) % 4));
    }
  }
  return mesh;
}

/// Times 2^power, which may round.
DomainToRefine scaled(DomainToRefine domain, int power) {
  for (Coordinates* const places : {&domain.points, &domain.holes}) {
    for (double& x : *places) x = std::ldexp(x, power);
  }
  return domain;
}

int exponent_of(const DomainToRefine& domain) {
  double largest = 0;
  for (const double x : domain.points) largest = std::max(largest, std::fabs(x));
  return largest > 0 ? std::ilogb(largest) : 0;
}

/// The whole call, which also measures angles.
ConstrainedTriangulation call(const DomainToRefine& domain, const Refinement& wanted) {
  static Triangulator triangulator("host");
  const std::size_t count = domain.points.size() / 2;
  Constraints constraints;
  constraints.segments = domain.segments.data();
  constraints.segment_count = domain.segments.size() / 2;
  constraints.holes = domain.holes.data();
  constraints.hole_count = domain.holes.size() / 2;
  ConstrainedOptions options;
  options.outside = domain.outside;
  options.refinement = wanted;
  return triangulator.constrained(domain.points.data(), {0, count}, constraints, options);
}

/// Below this exponent of the largest coordinate, doubles may lack binary places that new ones would have.
constexpr int kLeastExponent = -874;

/// The result in units in which coordinates are near 1 has the same triangles and angles.
std::string differs_in_other_units(const DomainToRefine& domain, const Refinement& wanted) {
  const int power = -exponent_of(domain);
  if (-power < kLeastExponent) return "";
  Refinement other = wanted;
  other.max_area = std::ldexp(wanted.max_area, 2 * power);
  if (wanted.min_edge > 0) other.min_edge = std::ldexp(wanted.min_edge, power);
  if (wanted.max_area > 0 && !(other.max_area > 0)) return "";
  if (wanted.areas_at) {
    other.areas_at = [&](const double* places, std::size_t count, double* areas) {
      std::vector<double> own(places, places + 2 * count);
      for (double& x : own) x = std::ldexp(x, -power);
      wanted.areas_at(own.data(), count, areas);
      for (std::size_t i = 0; i < count; ++i) areas[i] = std::ldexp(areas[i], 2 * power);
    };
  }
  ConstrainedTriangulation found = call(domain, wanted), expected = call(scaled(domain, power), other);
  for (double& x : found.added_points) x = std::ldexp(x, power);
  const RefinementReport &a = found.refinement, &b = expected.refinement;
  return found.triangles == expected.triangles && found.added_points == expected.added_points &&
                 a.smallest_angle == b.smallest_angle && a.largest_angle == b.largest_angle &&
                 a.mean_angle == b.mean_angle && a.excuses == b.excuses && a.rounds == b.rounds
             ? ""
             : "differs in other units";
}

/// What the verifier says of a mesh in which only angles of the input make triangles bad.
std::string verified(const DomainToRefine& domain, const RefinedMesh& refined, const Demands& demands) {
  const auto is_of_input = [](Excuse e) { return e == Excuse::input_angle || e == Excuse::near_apex; };
  const std::vector<Excuse>& excuses = refined.report.excuses;
  if (!std::all_of(excuses.begin(), excuses.end(), is_of_input)) return "";
  // It tells by places alone what is on one segment, for which coordinates may be too coarse.
  double largest = 0;
  for (const double x : domain.points) largest = std::max(largest, std::fabs(x));
  if (extent_of(domain.points) < 1e-6 * largest) return "";
  Coordinates points = domain.points;
  points.insert(points.end(), refined.added.begin(), refined.added.end());
  // The hull is no constraint.
  const bool has_border = domain.outside != Outside::keep || !domain.holes.empty();
  std::vector<std::int32_t> segments;
  for (std::size_t c = 0; c < refined.edges.size(); ++c) {
    const std::int32_t beyond = refined.neighbors[c];
    if (refined.edges[c] < 0 || (beyond < 0 ? !has_border : beyond < static_cast<std::int32_t>(c / 3)))
      continue;
    for (std::size_t k = 1; k < 3; ++k) segments.push_back(refined.triangles[c - c % 3 + (c + k) % 3]);
  }
  VerifyConstraints constraints;
  constraints.segments = &segments;
  constraints.outside = domain.outside;
  if (!domain.holes.empty()) constraints.holes = &domain.holes;
  constraints.min_angle = demands.wanted.min_angle;
  // Infinite if only other areas are asked for, so that it is known to be refined.
  constraints.max_area = demands.wanted.max_area > 0 ? demands.wanted.max_area : HUGE_VAL;
  constraints.conforming = demands.wanted.conforming;
  const std::string problem =
      verify_constrained(points.data(), points.size() / 2, refined.triangles, &refined.neighbors, constraints)
          .problem;
  // Edges that are kept or too short may be.
  return problem.find("is encroached") == std::string::npos ? problem : "";
}

/// Which runtimes are to have the same results.
enum class Runtimes { one, native, all };

/// What is wrong, without numbers and places.
std::string kind_of(const std::string& problem) {
  std::string kind;
  for (const char c : problem) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) kind.push_back(c);
  }
  return kind;
}

class RefinementFuzzer : public Fuzzer {
 public:
  RefinementFuzzer() {
    for (const char* const threads : {"1", "2"}) {
      const testing::ScopedEnvironment environment("FLAUNAY_THREADS", threads);
      native_.push_back(std::make_unique<host::Runtime>(native_tuning("")));
    }
    native_.push_back(std::make_unique<host::Runtime>(native_tuning("small")));
    const auto device = testing::tests_native() ? boost::compute::device() : host::find_device("#0");
    for (const char* const tuning : {"own", "gpu:32"}) {
      if (testing::tests_native()) continue;
      const testing::ScopedEnvironment environment("FLAUNAY_TUNING",
                                                   tuning == std::string("own") ? nullptr : tuning);
      devices_.push_back(std::make_unique<host::Runtime>(device, settings_for(device)));
    }
    // Kernels are compiled now, since that takes longer than a case may.
    const DomainToRefine domain = testing::nasty_detail::polygon(60, 1);
    Demands demands;
    demands.wanted.min_angle = 25;
    problem_of(domain, demands, Runtimes::all);
  }

  bool run(FixtureRandom& random) override {
    const auto& all = testing::nasty_domains();
    const auto& nasty = all[static_cast<std::size_t>(random.integer(0, std::ssize(all) - 1))];
    const int n = static_cast<int>(random.integer(3, once_in(random, 15) ? 600 : 60));
    DomainToRefine domain = nasty.make(n, static_cast<std::uint64_t>(random.integer(0, 1'000'000)));
    if (domain.points.empty()) return true;
    testing::move_and_scale(random, domain);
    if (once_in(random, 3))
      domain = scaled(domain, static_cast<int>(random.integer(-1074, 970)) - exponent_of(domain));
    const Demands demands = any_demands(random, domain);
    const Runtimes with = once_in(random, 20)  ? Runtimes::all
                          : once_in(random, 5) ? Runtimes::native
                                               : Runtimes::one;
    ++tried_;
    const std::string problem = problem_of(domain, demands, with);
    if (problem.empty()) return true;
    fmt::print("{}: {}: {}\n{}\n", case_name(), nasty.name, problem, demands.text());
    std::fflush(stdout);
    SegmentBatch batch = {{domain.points, domain.segments}};
    const auto domain_of = [&](const SegmentBatch& smaller) {
      DomainToRefine other = domain;
      other.points = smaller.empty() ? Coordinates() : smaller[0].points;
      other.segments = smaller.empty() ? testing::Segments() : smaller[0].segments;
      return other;
    };
    batch = minimise(
        batch,
        [&](const SegmentBatch& smaller) {
          return kind_of(problem_of(domain_of(smaller), demands, with)) == kind_of(problem);
        },
        500);
    const DomainToRefine least = domain_of(batch);
    fmt::print("{}\noutside {}, holes {{{}}}\npoints {{{}}}\nsegments {{{}}}\n",
               problem_of(least, demands, with), static_cast<int>(least.outside),
               fmt::join(least.holes, ", "), fmt::join(least.points, ", "), fmt::join(least.segments, ", "));
    return false;
  }

  std::string summary() const override {
    std::string text = fmt::format("{} refined, {} points added, at most {} rounds; triangles excused for",
                                   tried_ - refused_, points_, rounds_);
    for (const auto& [excuse, count] : excuses_) text += fmt::format(" reason {}: {}", excuse, count);
    return text;
  }

 private:
  std::string problem_of(const DomainToRefine& domain, const Demands& demands, Runtimes with) {
    start_check();
    MeshToRefine mesh;
    if (domain.points.size() < 6) return "";
    try {
      mesh = mesh_of(domain, demands);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) return std::string("no mesh: ") + error.what();
      ++refused_;  // rounding made segments cross, or a hole touch one
      return "";
    }
    try {
      const RefinedMesh refined = constrained::refine(*native_[0], mesh, demands.wanted, demands.block);
      count(refined);
      std::string problem = testing::what_is_wrong(mesh, refined, demands.wanted);
      if (problem.empty()) problem = verified(domain, refined, demands);
      if (!problem.empty()) return problem;
      for (std::size_t i = 1; with != Runtimes::one && i < native_.size(); ++i) {
        if (!are_same(constrained::refine(*native_[i], mesh, demands.wanted, demands.block), refined))
          return fmt::format("differs on native runtime {}", i);
      }
      for (std::size_t i = 0; with == Runtimes::all && i < devices_.size(); ++i) {
        start_check();
        if (!are_same(constrained::refine(*devices_[i], mesh, demands.wanted, demands.block), refined))
          return fmt::format("differs on device runtime {}", i);
      }
      const testing::OwnedMesh other = testing::shuffled(mesh, 1);
      const RefinedMesh from_other =
          constrained::refine(*native_[0], other.mesh, demands.wanted, demands.block);
      if (!(testing::ByCoordinates(other.mesh, from_other) == testing::ByCoordinates(mesh, refined)))
        return "differs for shuffled input";
      if (mesh.largest_areas.empty() && mesh.kept_edges.empty())
        return differs_in_other_units(domain, demands.wanted);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  static bool are_same(const RefinedMesh& a, const RefinedMesh& b) {
    return a.added == b.added && a.added_edges == b.added_edges && a.added_places == b.added_places &&
           a.triangles == b.triangles && a.neighbors == b.neighbors && a.edges == b.edges &&
           a.parents == b.parents && a.report.rounds == b.report.rounds &&
           a.report.bad_triangles == b.report.bad_triangles && a.report.excuses == b.report.excuses;
  }

  void count(const RefinedMesh& refined) {
    points_ += refined.report.added_points;
    rounds_ = std::max(rounds_, refined.report.rounds);
    for (const Excuse excuse : refined.report.excuses) ++excuses_[static_cast<int>(excuse)];
  }

  std::vector<std::unique_ptr<host::Runtime>> native_, devices_;
  std::size_t tried_ = 0, refused_ = 0, points_ = 0, rounds_ = 0;
  std::map<int, std::size_t> excuses_;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  return flaunay::fuzz::run_fuzzer<flaunay::fuzz::RefinementFuzzer>(
      argc, argv, "fuzz_refinement", "Refines random nasty domains, and checks the results exactly");
}
