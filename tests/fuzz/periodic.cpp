// Triangulates degenerate point sets on tori and cylinders whose periods are of any ratio to their extent,
// some of whose points are moved by periods: each result must pass the exact check, be the same again from
// its places, and for each point find that. Stops at the first wrong result and prints its points.
//
//   fuzz_periodic [--seconds N] [--seed S] [--first CASE]
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "flaunay/verify.hpp"
#include "tests/fuzz/degenerate.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::fuzz {
namespace {

using testing::FixtureRandom;

class PeriodicFuzzer : public Fuzzer {
 public:
  bool run(FixtureRandom& random) override {
    Coordinates points;
    std::vector<std::size_t> offsets{0};
    for (const Coordinates& set : degenerate_batch(random)) {
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
    double extent = 0;
    for (const double x : points) extent = std::max(extent, std::fabs(x));
    const Period period = random_period(random, extent);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double length = i % 2 == 0 ? period.x : period.y;
      if (std::isfinite(length)) points[i] += static_cast<double>(random.integer(-2, 2)) * length;
    }
    start_check();
    std::string problem;
    try {
      problem = problem_of(points, offsets, period);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::device) throw;
      if (error.kind() == ErrorKind::internal) {
        problem = error.what();
      } else {
        ++refused_;  // out of the range of magnitudes
      }
    }
    sets_ += offsets.size() - 1;
    points_ += points.size() / 2;
    if (problem.empty()) return true;
    fmt::print("{}: {}; period {:a} x {:a}, {:a}; points of sets {}:\n", case_name(), problem, period.x,
               period.y, period.shear, fmt::join(offsets, ", "));
    for (std::size_t i = 0; i < points.size(); i += 2) fmt::print("{:a} {:a}\n", points[i], points[i + 1]);
    return false;
  }

  std::string summary() const override {
    return fmt::format("{} sets and {} points are right, {} images, {} batches refused", sets_, points_,
                       images_, refused_);
  }

 private:
  static Period random_period(FixtureRandom& random, double extent) {
    const auto length = [&] {
      const double ratio = random.integer(0, 1) == 0 ? 1 : 0.5 + random.unit();
      return (extent > 0 ? extent : 1) * std::ldexp(ratio, static_cast<int>(random.integer(-2, 3)));
    };
    Period period{length(), length()};
    const std::int64_t kind = random.integer(0, 5);
    constexpr double kNone = std::numeric_limits<double>::infinity();
    if (kind == 0) period.x = kNone;
    if (kind == 1) period.y = kNone;
    if (kind > 3) period.shear = period.x * static_cast<double>(random.integer(-8, 8)) / (kind == 4 ? 8 : 7);
    return period;
  }

  std::string problem_of(const Coordinates& points, const std::vector<std::size_t>& offsets,
                         const Period& period) {
    const Triangulation mesh = host_.triangulate(points.data(), offsets, Space::torus(period));
    images_ += mesh.images;
    const std::string problem = verify(mesh.places.data(), mesh.point_offsets, mesh.space, mesh);
    if (!problem.empty()) return problem;
    const Triangulation again =
        host_.triangulate(mesh.places.data(), offsets, Space::torus(mesh.space.period));
    if (again.triangles != mesh.triangles || again.corner_offsets != mesh.corner_offsets ||
        again.places != mesh.places)
      return "its places have another triangulation";
    if (offsets.size() != 2) return "";
    Locator locator(host_, mesh);
    const std::size_t n = points.size() / 2;
    if (locator.nearest(points.data(), n) != mesh.representatives) return "the nearest point is another one";
    const std::vector<std::int32_t> found = locator.locate(points.data(), n);
    for (std::size_t i = 0; i < n; ++i) {
      if (mesh.triangles.empty()) continue;
      const std::int32_t* const corners =
          &mesh.triangles[3 * static_cast<std::size_t>(std::max(found[i], 0))];
      if (found[i] < 0 || std::find(corners, corners + 3, mesh.representatives[i]) == corners + 3)
        return fmt::format("point {} is not at a corner of its triangle", i);
    }
    return "";
  }

  Triangulator& host_ = testing::triangulator_with("cpu");
  std::size_t sets_ = 0, points_ = 0, images_ = 0, refused_ = 0;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  return flaunay::fuzz::run_fuzzer<flaunay::fuzz::PeriodicFuzzer>(
      argc, argv, "fuzz_periodic", "Looks for points on a torus that are triangulated wrongly.");
}
