// Triangulations on a torus or a cylinder in chunks against those in memory: the same triangles with the same
// offsets and neighbours, and the same representatives.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/verify.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::periodic {
namespace {

using Numbers = std::vector<double>;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Arrays that grow.
class GrowingSink : public MeshSink {
 public:
  bool wants(MeshArray array) const override { return array != MeshArray::hull; }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    store(array == MeshArray::triangles   ? triangles
          : array == MeshArray::neighbors ? neighbors
                                          : representatives,
          first, values, count);
  }
  void write_doubles(MeshArray, std::uint64_t first, const double* values, std::size_t count) override {
    store(areas, first, values, count);
  }
  void write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count) override {
    store(offsets, first, values, count);
  }
  std::vector<std::int64_t> triangles, neighbors, representatives;
  std::vector<std::int8_t> offsets;
  std::vector<double> areas;

 private:
  template <typename T>
  static void store(std::vector<T>& to, std::uint64_t first, const T* values, std::size_t count) {
    to.resize(std::max<std::size_t>(to.size(), first + count), T{-7});
    std::copy_n(values, count, to.begin() + static_cast<std::ptrdiff_t>(first));
  }
};

using Row = std::array<std::int64_t, 9>;

/// Each triangle with its offsets, and its neighbours as such, sorted.
template <typename Index>
std::vector<std::array<Row, 4>> sorted_rows(const std::vector<Index>& triangles,
                                            const std::vector<std::int8_t>& offsets,
                                            const std::vector<Index>& neighbors) {
  const auto row = [&](std::int64_t t) {
    Row one;
    one.fill(-1);
    if (t < 0) return one;
    const auto at = static_cast<std::size_t>(t);
    std::copy_n(triangles.begin() + 3 * t, 3, one.begin());
    for (std::size_t k = 0; k < 6; ++k) one[3 + k] = offsets[6 * at + k];
    return one;
  };
  std::vector<std::array<Row, 4>> rows;
  for (std::size_t t = 0; 3 * t < triangles.size(); ++t) {
    rows.push_back({row(static_cast<std::int64_t>(t)), row(neighbors[3 * t]), row(neighbors[3 * t + 1]),
                    row(neighbors[3 * t + 2])});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

ChunkOptions in_chunks_of(std::size_t points, const Period& period = {}) {
  ChunkOptions options;
  options.space = Space::torus(period);
  options.chunk_points = points;
  options.memory_bytes = std::uint64_t{512} << 20;
  options.triangulators = {&testing::triangulator()};
  return options;
}

ChunkStatistics compare(const Numbers& points, const Period& period, std::size_t chunk) {
  const std::size_t n = points.size() / 2;
  const Triangulation expected = testing::triangulator().triangulate(points.data(), n, Space::torus(period));
  ArrayPoints source(points.data(), n);
  GrowingSink sink;
  const ChunkStatistics statistics = triangulate_chunks(source, sink, in_chunks_of(chunk, period));
  EXPECT_EQ(expected.triangles.size() / 3, statistics.triangles);
  // With too small a margin there may have been more rows.
  EXPECT_LE(expected.triangles.size(), sink.triangles.size());
  EXPECT_LE(sink.triangles.size(), 6 * n);
  EXPECT_LE(sink.neighbors.size(), 6 * n);
  EXPECT_LE(sink.areas.size(), 2 * n);
  if (::testing::Test::HasFailure()) return statistics;
  sink.triangles.resize(expected.triangles.size());
  sink.neighbors.resize(expected.neighbors.size());
  sink.offsets.resize(expected.corner_offsets.size());
  sink.areas.resize(expected.triangles.size() / 3);
  EXPECT_TRUE(sorted_rows(expected.triangles, expected.corner_offsets, expected.neighbors) ==
              sorted_rows(sink.triangles, sink.offsets, sink.neighbors));
  EXPECT_TRUE(std::equal(expected.representatives.begin(), expected.representatives.end(),
                         sink.representatives.begin(), sink.representatives.end(),
                         [](std::int32_t a, std::int64_t b) { return a == b; }));
  std::size_t duplicates = 0;
  for (std::size_t i = 0; i < n; ++i)
    duplicates += static_cast<std::size_t>(expected.representatives[i]) != i;
  EXPECT_EQ(duplicates, statistics.duplicates);
  EXPECT_EQ(n, statistics.points);
  EXPECT_LE(statistics.images, expected.images);  // which has those of smaller margins, too
  if (std::isfinite(period.x) && std::isfinite(period.y)) {
    double area = 0;
    for (const double one : sink.areas) area += one;
    EXPECT_NEAR(1, area / (expected.space.period.x * expected.space.period.y), 1e-12);
  }
  return statistics;
}

Numbers uniform(std::size_t n, const Period& period, std::uint64_t seed) {
  testing::FixtureRandom random(seed);
  Numbers points;
  for (std::size_t i = 0; i < n; ++i) {
    points.insert(points.end(), {random.unit() * (std::isfinite(period.x) ? period.x : 1),
                                 random.unit() * (std::isfinite(period.y) ? period.y : 1)});
  }
  return points;
}

const std::vector<Period>& periods() {
  static const std::vector<Period> all{{1, 1}, {0.1, 0.3}, {1, 16}, {1, kNone}, {kNone, 0.7}, {1, 0.7, 0.4}};
  return all;
}

TEST(SmallPeriodicChunks, OfUniformPoints) {
  const ChunkStatistics statistics = compare(uniform(1500, {}, 1), {}, 60);
  EXPECT_GE(statistics.rounds.size(), 3u);
  EXPECT_GE(statistics.rounds[0].chunks, 25u);
}

TEST(PeriodicChunks, OfManySizes) {
  for (const Period& period : periods()) {
    for (const std::size_t n : {1, 2, 3, 4, 5, 7, 20, 150, 1000, 4000}) {
      for (const std::size_t chunk : {12, 50, 400}) {
        if (n > (testing::is_sanitized() ? 10 : 30) * chunk) continue;
        SCOPED_TRACE(std::to_string(n) + " points in chunks of " + std::to_string(chunk));
        compare(uniform(n, period, n + chunk), period, chunk);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(PeriodicChunks, OfTies) {
  for (const int size : {2, 5, 12, 40}) {
    Numbers points;
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) points.insert(points.end(), {x * 0.5, y * 1.0});
    }
    const Numbers once = points;
    for (std::size_t i = 0; i < once.size(); i += 6)
      points.insert(points.end(), {once[i] - size * 0.5, once[i + 1] + 2.0 * size});
    for (const Period& period : {Period{size * 0.5, size * 1.0},
                                 {size * 0.5, kNone},
                                 {kNone, size * 1.0},
                                 {size * 0.25, size * 2.0},
                                 {size * 0.5, size * 1.0, 1.5}}) {
      SCOPED_TRACE(size);
      compare(points, period, 30);
      compare(once, period, 500);
      if (HasFailure()) return;
    }
  }
}

TEST(PeriodicChunks, OfClustersAtTheBorder) {
  testing::FixtureRandom random(7);
  for (const double width : {1e-9, 0.2}) {
    for (const double x : {0.0, 0.3}) {
      SCOPED_TRACE(width);
      Numbers around, corner;
      for (int i = 0; i < (testing::is_sanitized() ? 150 : 700); ++i) {
        const double a = random.unit(), b = random.unit();
        around.insert(around.end(), {x + width * (a * a - 0.5), width * (b * b - 0.5)});
        corner.insert(corner.end(), {x + width * a, width * b * a});
      }
      for (const Period& period : periods()) {
        compare(around, period, 100);
        compare(corner, period, 100);
        if (HasFailure()) return;
      }
    }
  }
  // A gap makes the first margin too small.
  Numbers gap;
  const Numbers many = uniform(6000, {}, 5);
  for (std::size_t i = 0; i < many.size(); i += 2) {
    if (std::hypot(many[i] - 0.5, many[i + 1] - 0.02) > 0.4) gap.insert(gap.end(), {many[i], many[i + 1]});
  }
  compare(gap, {}, 200);
}

TEST(PeriodicChunks, OfEqualPoints) {
  Numbers points = uniform(500, {}, 3);
  for (int k = 0; k < 700; ++k) points.insert(points.begin(), {points[points.size() - 2], 0.0});
  for (int k = 0; k < 300; ++k) points.insert(points.end(), {3.0, -0.0});
  for (const Period& period : periods()) {
    compare(points, period, 50);
    compare(Numbers(2 * 1000, 0.25), period, 50);
  }
  Numbers level = uniform(400, {}, 9);
  for (std::size_t i = 0; i < level.size(); i += 2) level[i + 1] = 0.125;
  for (const Period& period : periods()) compare(level, period, 50);
}

TEST(PeriodicChunks, GoToArrays) {
  Numbers points = uniform(5000, {}, 11);
  const std::size_t n = points.size() / 2;
  for (double& x : points) x = 3 * x - 1;
  const Period period{0.7, 1.3};
  std::vector<std::int32_t> triangles(6 * n), neighbors(6 * n), representatives(n);
  std::vector<std::int8_t> offsets(12 * n);
  const ChunkOptions options = in_chunks_of(700, period);
  const ChunkStatistics statistics =
      triangulate_chunks(points.data(), n,
                         MeshArrays<std::int32_t>{triangles.data(), neighbors.data(), nullptr,
                                                  representatives.data(), nullptr, offsets.data()},
                         options);
  Triangulation mesh;
  mesh.space = Space::torus(take_to_places(period, points.data(), n));
  mesh.places = points;
  triangles.resize(3 * statistics.triangles);
  neighbors.resize(triangles.size());
  offsets.resize(2 * triangles.size());
  mesh.triangles = triangles;
  mesh.neighbors = neighbors;
  mesh.corner_offsets = offsets;
  mesh.representatives = representatives;
  mesh.point_offsets = {0, n};
  mesh.triangle_offsets = {0, statistics.triangles};
  EXPECT_EQ("", verify(mesh.places.data(), mesh.point_offsets, mesh.space, mesh));
  std::vector<std::int64_t> wide(6 * n);
  triangulate_chunks(points.data(), n, MeshArrays<std::int64_t>{wide.data()}, options);
  EXPECT_TRUE(std::equal(triangles.begin(), triangles.end(), wide.begin()));
  const ChunkStatistics none = triangulate_chunks(nullptr, 0, MeshArrays<std::int32_t>{}, options);
  EXPECT_EQ(0u, none.triangles);
}

TEST(PeriodicChunks, RefuseWrongInput) {
  Numbers points = uniform(100, {}, 2);
  const auto triangulate = [&](const ChunkOptions& options) {
    ArrayPoints source(points.data(), points.size() / 2);
    GrowingSink sink;
    triangulate_chunks(source, sink, options);
  };
  testing::expect_error(ErrorKind::usage, "period", [&] { triangulate(in_chunks_of(50, {1, -1})); });
  testing::expect_error(ErrorKind::usage, "period", [&] { triangulate(in_chunks_of(50, {kNone, kNone})); });
  testing::expect_error(ErrorKind::usage, "2^30", [&] { triangulate(in_chunks_of(50, {1, 1e10})); });
  testing::expect_error(ErrorKind::usage, "hull", [&] {
    std::vector<std::int32_t> hull(100);
    triangulate_chunks(points.data(), 100, MeshArrays<std::int32_t>{nullptr, nullptr, hull.data()},
                       in_chunks_of(50));
  });
  testing::expect_error(ErrorKind::usage, "no period", [&] {
    std::vector<std::int8_t> offsets(1200);
    MeshArrays<std::int32_t> results;
    results.corner_offsets = offsets.data();
    triangulate_chunks(points.data(), 100, results);
  });
  for (const Space& space : {Space::sphere(SphereCoordinates::directions),
                             Space::plane().with_weights(&kNone), Space::torus({}).with_weights(&kNone)}) {
    ChunkOptions options = in_chunks_of(50);
    options.space = space;
    testing::expect_error(ErrorKind::usage, "without weights", [&] { triangulate(options); });
  }
  ChunkOptions options = in_chunks_of(50);
  options.memory_bytes = 1000;
  testing::expect_error(ErrorKind::usage, "memory", [&] { triangulate(options); });
  options.memory_bytes = (128 << 20) + 480;
  testing::expect_error(ErrorKind::input, "more than 10 images", [&] { triangulate(options); });
  options = in_chunks_of(50);
  options.progress = [](const std::string& stage, int, double) {
    if (stage == "images") throw Error(ErrorKind::usage, "enough");
  };
  testing::expect_error(ErrorKind::usage, "enough", [&] { triangulate(options); });
  points[150] = std::nan("");
  testing::expect_error(ErrorKind::input, "point 75 is not finite", [&] { triangulate(in_chunks_of(50)); });
  testing::expect_error(ErrorKind::usage, "pointer to them is NULL", [&] {
    triangulate_chunks(nullptr, 5, MeshArrays<std::int32_t>{}, in_chunks_of(50));
  });
}

}  // namespace
}  // namespace flaunay::periodic
