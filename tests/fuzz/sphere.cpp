// Triangulates degenerate point sets on the sphere: each result must pass the exact check, have all
// triangles, be the same for points in another order and with blocks of another size, and have cells that
// cover the sphere; queries must find what brute force with the same predicates finds. Stops at the first
// wrong result and prints its points.
//
//   fuzz_sphere [--seconds N] [--seed S] [--first CASE]
#include "flaunay/sphere.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "flaunay/verify.hpp"
#include "space/sphere/predicates.hpp"
#include "tests/fuzz/degenerate.hpp"
#include "tests/fuzz/run.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::fuzz {
namespace {

using sphere::Point;
using testing::FixtureRandom;
using Numbers = std::vector<double>;
using Offsets = std::vector<std::size_t>;

/// Integers of few values, times a step: of degrees on the globe, on one parallel, on one meridian, around a
/// pole, or around a place.
void add_degrees(FixtureRandom& random, std::size_t n, Numbers& points) {
  constexpr double kSteps[] = {1, 15, 22.5, 30, 45, 90};
  const double step = kSteps[random.integer(0, std::ssize(kSteps) - 1)];
  const double fine = std::ldexp(1, static_cast<int>(-random.integer(0, 60)));
  const auto some = [&](std::int64_t most) { return static_cast<double>(random.integer(-most, most)); };
  const double longitude = step * some(12), latitude = std::remainder(step * some(6), 90);
  const std::int64_t kind = random.integer(0, 4);
  for (std::size_t i = 0; i < n; ++i) {
    double x = step * some(12), y = step * some(6);
    if (kind == 1 && random.integer(0, 19) != 0) y = latitude;
    if (kind == 2 && random.integer(0, 19) != 0) x = longitude + 180 * some(1);
    if (kind == 3) y = (some(9) < 9 ? -1 : 1) * (90 - fine * std::fabs(some(3)));
    if (kind == 4) {
      x = longitude + fine * some(3);
      y = latitude + fine * some(3);
    }
    points.insert(points.end(), {x, std::clamp(y, -90.0, 90.0)});
  }
}

/// Small integers, or those of which the plane's set is the places, or the places seen from the other pole.
void add_directions(FixtureRandom& random, const Coordinates& set, Numbers& points) {
  const std::int64_t kind = random.integer(0, 3), most = random.integer(1, 9);
  for (std::size_t i = 0; i < set.size(); i += 2) {
    std::array<double, 3> p{};
    if (kind == 0) {
      for (double& x : p) x = static_cast<double>(random.integer(-most, most));
    } else {
      const double square = set[i] * set[i] + set[i + 1] * set[i + 1];
      if (square < 1e300) p = {2 * set[i], 2 * set[i + 1], kind == 1 ? square - 1 : 1 - square};
    }
    if (p[0] == 0 && p[1] == 0 && p[2] == 0) p[2] = -1;
    points.insert(points.end(), p.begin(), p.end());
  }
}

/// The corners' places of each triangle of a set, the smallest first, in order.
std::vector<std::array<double, 6>> faces_of(const Triangulation& mesh, std::size_t set) {
  std::vector<std::array<double, 6>> faces;
  for (std::size_t t = mesh.triangle_offsets[set]; t < mesh.triangle_offsets[set + 1]; ++t) {
    std::array<std::array<double, 2>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point p = sphere::place_at(mesh.places, static_cast<std::size_t>(mesh.triangles[3 * t + k]));
      corners[k] = {p.x, p.y};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.push_back(
        {corners[0][0], corners[0][1], corners[1][0], corners[1][1], corners[2][0], corners[2][1]});
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

class SphereFuzzer : public Fuzzer {
 public:
  bool run(FixtureRandom& random) override {
    coordinates_ = random.integer(0, 1) == 0 ? SphereCoordinates::degrees : SphereCoordinates::directions;
    const std::size_t width = sphere::width_of(coordinates_);
    Numbers points;
    Offsets offsets{0};
    for (const Coordinates& set : degenerate_batch(random)) {
      if (coordinates_ == SphereCoordinates::degrees)
        add_degrees(random, set.size() / 2, points);
      else
        add_directions(random, set, points);
      offsets.push_back(points.size() / width);
    }
    if (random.integer(0, 2) == 0) {
      for (double& x : points) x = std::nextafter(x, static_cast<double>(random.integer(-1, 1)) * 90);
    }
    start_check();
    std::string problem;
    try {
      problem = problem_of(points, offsets, random);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::device) throw;
      problem = error.what();
    }
    sets_ += offsets.size() - 1;
    points_ += offsets.back();
    if (problem.empty()) return true;
    fmt::print("{}: {}; {} of the points of sets {}:\n", case_name(), problem,
               width == 2 ? "degrees" : "directions", fmt::join(offsets, ", "));
    for (std::size_t i = 0; i < points.size(); i += width)
      fmt::print("{:a}\n", fmt::join(&points[i], &points[i] + width, " "));
    return false;
  }

  std::string summary() const override {
    return fmt::format("{} sets and {} points are right, {} queries", sets_, points_, queries_);
  }

 private:
  std::string problem_of(const Numbers& points, const Offsets& offsets, FixtureRandom& random) {
    const Triangulation mesh = host_.triangulate(points.data(), offsets, Space::sphere(coordinates_));
    std::string problem = verify(points.data(), offsets, Space::sphere(coordinates_), mesh);
    if (problem.empty()) problem = problem_of_order(points, mesh, random);
    const Voronoi dual = host_.voronoi(mesh);
    for (std::size_t s = 0; s + 1 < offsets.size() && problem.empty(); ++s)
      problem = problem_of_set(mesh, dual, s);
    if (problem.empty() && offsets.size() == 2) problem = problem_of_queries(points, mesh, random);
    return problem;
  }

  std::string problem_of_order(const Numbers& points, const Triangulation& mesh, FixtureRandom& random) {
    const std::size_t width = sphere::width_of(coordinates_);
    Numbers shuffled;
    for (std::size_t s = 0; s + 1 < mesh.point_offsets.size(); ++s) {
      Offsets order(mesh.point_offsets[s + 1] - mesh.point_offsets[s]);
      std::iota(order.begin(), order.end(), mesh.point_offsets[s]);
      random.shuffle(order);
      for (const std::size_t i : order)
        shuffled.insert(shuffled.end(), &points[width * i], &points[width * i] + width);
    }
    const Triangulation other =
        small_blocks_.triangulate(shuffled.data(), mesh.point_offsets, Space::sphere(coordinates_));
    for (std::size_t s = 0; s + 1 < mesh.point_offsets.size(); ++s) {
      if (faces_of(mesh, s) != faces_of(other, s))
        return fmt::format("set {} depends on the order of points", s);
    }
    return "";
  }

  static std::size_t index_of(std::int32_t i) { return static_cast<std::size_t>(i); }
  /// The distance between the nearest points of a set, as a chord.
  static double shortest_edge(const Triangulation& mesh, std::size_t s) {
    double shortest = 2;
    for (std::size_t c = 3 * mesh.triangle_offsets[s]; c < 3 * mesh.triangle_offsets[s + 1]; ++c) {
      const sphere::Point a = sphere::place_at(mesh.places, index_of(mesh.triangles[c]));
      const sphere::Point b =
          sphere::place_at(mesh.places, index_of(mesh.triangles[c % 3 == 2 ? c - 2 : c + 1]));
      const double x = 1 + a.x * a.x + a.y * a.y, y = 1 + b.x * b.x + b.y * b.y;
      const double chord = sphere::is_pole(a)   ? 2 / std::sqrt(y)
                           : sphere::is_pole(b) ? 2 / std::sqrt(x)
                                                : 2 * std::hypot(a.x - b.x, a.y - b.y) / std::sqrt(x * y);
      shortest = std::min(shortest, chord);
    }
    return shortest;
  }

  static std::string problem_of_set(const Triangulation& mesh, const Voronoi& dual, std::size_t s) {
    std::size_t n = 0;
    double area = 0, radius = 0;  // of a cap around the first point that has all, as a chord
    const sphere::Point first = mesh.point_offsets[s] < mesh.point_offsets[s + 1]
                                    ? sphere::place_at(mesh.places, mesh.point_offsets[s])
                                    : sphere::pole();
    for (std::size_t i = mesh.point_offsets[s]; i < mesh.point_offsets[s + 1]; ++i) {
      n += mesh.representatives[i] == static_cast<std::int32_t>(i) ? 1 : 0;
      area += dual.areas[i];
      const sphere::Direction across =
          sphere::direction_of(sphere::place_at(mesh.places, i)) - sphere::direction_of(first);
      radius = std::max(radius, std::sqrt(sphere::dot(across, across)));
    }
    if (mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s] != (n > 2 ? 2 * n - 4 : 0))
      return fmt::format("set {} has {} triangles", s,
                         mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s]);
    // As rounding is documented; nothing is left if a cap is too small. Where points are neighbours in
    // doubles, whole spheres can be missing or too many.
    const double error = 4e-15 * static_cast<double>(n) * (1 + 1 / (radius * radius));
    const double wrong = area - 4 * std::numbers::pi;
    const double counted =
        shortest_edge(mesh, s) < 1e-12 ? std::remainder(wrong, 4 * std::numbers::pi) : wrong;
    if (n > 0 && error < 1 && !(std::fabs(counted) <= error))
      return fmt::format("the cells of set {} have the area {} with a radius of {}", s, area, radius);
    return "";
  }

  std::string problem_of_queries(const Numbers& points, const Triangulation& mesh, FixtureRandom& random) {
    Locator locator(host_, mesh);
    const std::size_t n = mesh.places.size() / 2;
    if (locator.nearest(points.data(), n) != mesh.representatives) return "the nearest point is another one";
    Numbers queries;
    for (int k = 0; k < 12; ++k) {
      // Any, points and what is opposite to them, and between two.
      std::array<double, 3> q{0, 0, -1};
      if (k < 3 || n == 0) {
        for (double& x : q) x = random.unit() - 0.5;
      } else {
        const auto any = [&] {
          const auto i = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(n) - 1));
          return sphere::direction_of(sphere::place_at(mesh.places, i));
        };
        const sphere::Direction a = any(), b = k < 6 ? a : any();
        q = {a.x + b.x, a.y + b.y, a.z + b.z};
        if (k % 3 == 0) q = {-q[0], -q[1], -q[2]};
        if (q[0] == 0 && q[1] == 0 && q[2] == 0) q = {a.x, a.y, a.z};
      }
      queries.insert(queries.end(), q.begin(), q.end());
    }
    const std::size_t m = queries.size() / 3;
    queries_ += m;
    const Numbers asked =
        host_.triangulate(queries.data(), m, Space::sphere(SphereCoordinates::directions)).places;
    locator.set_coordinates(SphereCoordinates::directions);
    const auto nearest = locator.nearest(queries.data(), m), located = locator.locate(queries.data(), m);
    for (std::size_t i = 0; i < m; ++i) {
      const Point q = sphere::place_at(asked, i);
      if (nearest[i] != nearest_to(mesh, q))
        return fmt::format("query {:a} {:a} has another nearest point", q.x, q.y);
      if (located[i] != triangle_at(mesh, q))
        return fmt::format("query {:a} {:a} has another triangle", q.x, q.y);
    }
    return "";
  }

  static std::int32_t nearest_to(const Triangulation& mesh, Point q) {
    std::int32_t best = -1;
    for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
      const Point p = sphere::place_at(mesh.places, i);
      const Point other = sphere::place_at(mesh.places, static_cast<std::size_t>(std::max(best, 0)));
      const int sign = best < 0 ? 1 : sphere::nearer(q, p, other);
      if (sign > 0 || (sign == 0 && sphere::comes_first(p, other))) best = static_cast<std::int32_t>(i);
    }
    return best;
  }

  static std::int32_t triangle_at(const Triangulation& mesh, Point q) {
    for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
      const auto at = [&](std::size_t k) {
        return sphere::place_at(mesh.places, static_cast<std::size_t>(mesh.triangles[3 * t + k]));
      };
      const Point a = at(0), b = at(1), c = at(2);
      if (sphere::turn(a, b, c) > 0 && sphere::turn(a, b, q) >= 0 && sphere::turn(b, c, q) >= 0 &&
          sphere::turn(c, a, q) >= 0)
        return static_cast<std::int32_t>(t);
    }
    return -1;
  }

  Triangulator& host_ = testing::triangulator_with("cpu");
  Triangulator& small_blocks_ = testing::triangulator_with("cpu,block_points=6");
  SphereCoordinates coordinates_ = SphereCoordinates::degrees;
  std::size_t sets_ = 0, points_ = 0, queries_ = 0;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  return flaunay::fuzz::run_fuzzer<flaunay::fuzz::SphereFuzzer>(
      argc, argv, "fuzz_sphere", "Looks for points on a sphere that are triangulated wrongly.");
}
