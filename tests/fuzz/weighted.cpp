// Gives degenerate point sets degenerate weights: the regular triangulation must pass the exact check, and be
// the same with blocks of another size. Stops at the first wrong result and prints its points.
//
//   fuzz_weighted [--seconds N] [--seed S] [--first CASE]
#include "flaunay/weighted.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "flaunay/verify.hpp"
#include "tests/fuzz/degenerate.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::fuzz {
namespace {

using testing::FixtureRandom;

class WeightedFuzzer : public Fuzzer {
 public:
  bool run(FixtureRandom& random) override {
    Coordinates points;
    std::vector<std::size_t> offsets{0};
    std::vector<double> weights;
    for (const Coordinates& set : degenerate_batch(random)) {
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
      add_weights(set, random, weights);
    }
    start_check();
    std::string problem;
    try {
      const Triangulation mesh = triangulated(host_, points, weights, offsets);
      problem = verify(points.data(), offsets, Space::plane().with_weights(weights.data()), mesh);
      const Triangulation other = triangulated(small_blocks_, points, weights, offsets);
      if (problem.empty())
        problem = verify(points.data(), offsets, Space::plane().with_weights(weights.data()), other);
      if (problem.empty() && (mesh.hidden != other.hidden || mesh.hull != other.hull))
        problem = "blocks differ";
      hidden_ += mesh.hidden.size();
      if (problem.empty()) problem = problem_with_period(points, weights, offsets, random);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
      ++refused_;  // out of the range of magnitudes
    }
    sets_ += offsets.size() - 1;
    points_ += weights.size();
    if (problem.empty()) return true;
    fmt::print("{}: {}; x, y and weight of the points of sets {}:\n", case_name(), problem,
               fmt::join(offsets, ", "));
    for (std::size_t i = 0; i < weights.size(); ++i)
      fmt::print("{} {} {}\n", points[2 * i], points[2 * i + 1], weights[i]);
    return false;
  }

  std::string summary() const override {
    return fmt::format("{} sets and {} points are right, {} hidden, {} batches refused", sets_, points_,
                       hidden_, refused_);
  }

 private:
  static Triangulation triangulated(Triangulator& triangulator, const Coordinates& points,
                                    const std::vector<double>& weights,
                                    const std::vector<std::size_t>& offsets) {
    Options options;
    options.neighbors = true;
    return triangulator.triangulate(points.data(), offsets, Space::plane().with_weights(weights.data()),
                                    options);
  }

  /// On a torus or a cylinder that is about as large as the points, or much smaller.
  std::string problem_with_period(const Coordinates& points, const std::vector<double>& weights,
                                  const std::vector<std::size_t>& offsets, FixtureRandom& random) {
    double extent = 0;
    for (const double x : points) extent = std::max(extent, std::fabs(x));
    if (!(extent > 0x1p-300 && extent < 0x1p300)) return "";
    const auto length = [&] { return std::ldexp(extent, static_cast<int>(random.integer(-2, 2))); };
    const std::int64_t ends = random.integer(0, 3);
    const Period period{ends == 0 ? HUGE_VAL : length(), ends == 1 ? HUGE_VAL : length()};
    const Triangulation mesh =
        host_.triangulate(points.data(), offsets, Space::torus(period).with_weights(weights.data()));
    hidden_ += mesh.hidden.size();
    const std::string problem =
        verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(weights.data()), mesh);
    if (!problem.empty()) fmt::print("period {} x {}\n", period.x, period.y);
    return problem;
  }

  /// Of one kind for a set: equal ones, few different ones, those that lift points to a plane or nearly so,
  /// and any, all beside the square of how far points are apart.
  static void add_weights(const Coordinates& set, FixtureRandom& random, std::vector<double>& weights) {
    double extent = 0;
    for (std::size_t i = 0; i < set.size(); ++i) extent = std::max(extent, std::fabs(set[i] - set[i % 2]));
    const double scale = extent * extent / static_cast<double>(random.integer(1, std::ssize(set) + 1));
    const std::int64_t kind = random.integer(0, 5);
    const double slope = std::ldexp(random.unit() - 0.5, static_cast<int>(random.integer(-3, 3))) * extent;
    for (std::size_t i = 0; i < set.size() / 2; ++i) {
      const double x = set[2 * i] - set[0], y = set[2 * i + 1] - set[1];
      const double plane = x * x + y * y - slope * x;
      weights.push_back(kind == 0   ? scale
                        : kind == 1 ? scale * static_cast<double>(random.integer(0, 3))
                        : kind == 2 ? plane
                        : kind == 3 ? plane * (random.integer(0, 3) == 0 ? 1 + 0x1p-52 : 1)
                        : kind == 4 ? random.unit() * scale
                                    : (random.integer(0, 9) == 0 ? 100 : 1) * random.unit() * scale);
    }
  }

  Triangulator& host_ = testing::triangulator_with("cpu");
  Triangulator& small_blocks_ = testing::triangulator_with("gpu:32,block_points=6");
  std::size_t sets_ = 0, points_ = 0, hidden_ = 0, refused_ = 0;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  return flaunay::fuzz::run_fuzzer<flaunay::fuzz::WeightedFuzzer>(
      argc, argv, "fuzz_weighted", "Looks for weighted points that are triangulated wrongly.");
}
