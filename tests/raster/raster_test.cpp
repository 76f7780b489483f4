// Rasters and contours against rational arithmetic, triangle by triangle.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "flaunay/terrain.hpp"
#include "tests/locate/support.hpp"
#include "tests/support/errors.hpp"

namespace flaunay::raster {
namespace {

using testing::Coordinates;
using testing::FixtureRandom;
using testing::make_fixture;

constexpr double kFill = -77.25;

struct Terrain {
  Coordinates points;
  std::vector<double> values;
  Triangulation mesh;

  MeshView view() const {
    return {points.data(), values.size(), mesh.triangles.data(), mesh.neighbors.data(),
            mesh.triangles.size() / 3};
  }
  const double* point(std::int32_t v) const { return &points[2 * static_cast<std::size_t>(v)]; }
  std::array<std::int32_t, 3> corners(std::size_t t) const {
    return {mesh.triangles[3 * t], mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]};
  }
};

Triangulator& on_host() {
  static Triangulator triangulator("host");
  return triangulator;
}

Terrain make_terrain(const Coordinates& points, const std::vector<double>& values) {
  Terrain terrain{points, values, {}};
  terrain.mesh = on_host().triangulate(points.data(), points.size() / 2);
  return terrain;
}

std::vector<double> random_values(std::size_t n, std::uint64_t seed, std::int64_t most) {
  FixtureRandom random(seed);
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(static_cast<double>(random.integer(-most, most)) / 8);
  return values;
}

Terrain terrain_of(const std::string& fixture, std::size_t n, std::int64_t most = 1000) {
  const Coordinates points = make_fixture(fixture, n, 7);
  return make_terrain(points, random_values(points.size() / 2, 3, most));
}

Terrain shuffled(const Terrain& terrain, std::uint64_t seed) {
  std::vector<std::size_t> order(terrain.values.size());
  std::iota(order.begin(), order.end(), 0);
  FixtureRandom(seed).shuffle(order);
  Coordinates points;
  std::vector<double> values;
  for (const std::size_t i : order) {
    points.insert(points.end(), {terrain.points[2 * i], terrain.points[2 * i + 1]});
    values.push_back(terrain.values[i]);
  }
  return make_terrain(points, values);
}

std::vector<double> rasterized(Triangulator& triangulator, const Terrain& terrain, const RasterGrid& grid,
                               double max_edge = std::numeric_limits<double>::infinity()) {
  std::vector<double> pixels(grid.rows * grid.columns, 1e300);
  rasterize(triangulator, terrain.view(), terrain.values.data(), grid, {max_edge, kFill}, pixels.data());
  return pixels;
}

bool same_bytes(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool has_longer_edge(const Terrain& terrain, std::size_t t, double longest) {
  const auto v = terrain.corners(t);
  for (std::size_t k = 0; k < 3; ++k) {
    const double* const a = terrain.point(v[k]);
    const double* const b = terrain.point(v[(k + 1) % 3]);
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    if (dx * dx + dy * dy > longest * longest) return true;
  }
  return false;
}

// The value at q, by the first triangle that has it; nothing if none has.
std::optional<mpq_class> value_at(const Terrain& terrain, const double* q, double max_edge) {
  for (std::size_t t = 0; t < terrain.mesh.triangles.size() / 3; ++t) {
    if (has_longer_edge(terrain, t, max_edge)) continue;
    const auto v = terrain.corners(t);
    mpq_class whole = 0, sum = 0;
    bool is_outside = false;
    for (std::size_t k = 0; k < 3 && !is_outside; ++k) {
      const mpq_class area = locate::area(terrain.point(v[(k + 1) % 3]), terrain.point(v[(k + 2) % 3]), q);
      is_outside = area < 0;
      whole += area;
      if (area != 0) sum += area * mpq_class(terrain.values[static_cast<std::size_t>(v[k])]);
    }
    if (!is_outside) return sum / whole;
  }
  return std::nullopt;
}

void expect_right(const Terrain& terrain, const RasterGrid& grid, const std::vector<double>& pixels,
                  double max_edge = std::numeric_limits<double>::infinity()) {
  double largest = 1;
  for (const double value : terrain.values) largest = std::max(largest, std::fabs(value));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double q[2] = {grid.x + static_cast<double>(i % grid.columns) * grid.dx,
                         grid.y + static_cast<double>(i / grid.columns) * grid.dy};
    const std::optional<mpq_class> expected = value_at(terrain, q, max_edge);
    ASSERT_EQ(expected.has_value(), pixels[i] != kFill) << "pixel " << i << " at " << q[0] << ", " << q[1];
    if (!expected) continue;
    ASSERT_NEAR(expected->get_d(), pixels[i], 1e-12 * largest) << "pixel " << i;
  }
}

// So many pixels, whose outermost centres are corners of the points' box, which is made larger by `beyond`
// times its size.
RasterGrid grid_over(const Terrain& terrain, std::size_t rows, std::size_t columns, double beyond) {
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (std::size_t c = 0; c < terrain.points.size(); ++c) {
    low[c % 2] = std::min(low[c % 2], terrain.points[c]);
    high[c % 2] = std::max(high[c % 2], terrain.points[c]);
  }
  const double width = high[0] - low[0] > 0 ? high[0] - low[0] : 1;
  const double height = high[1] - low[1] > 0 ? high[1] - low[1] : 1;
  return {low[0] - beyond * width,
          high[1] + beyond * height,
          width * (1 + 2 * beyond) / static_cast<double>(columns - 1),
          -height * (1 + 2 * beyond) / static_cast<double>(rows - 1),
          rows,
          columns};
}

void check_terrain(const Terrain& terrain, const RasterGrid& grid) {
  const std::vector<double> pixels = rasterized(testing::triangulator(), terrain, grid);
  expect_right(terrain, grid, pixels);
  EXPECT_TRUE(same_bytes(pixels, rasterized(on_host(), terrain, grid)));
  for (const std::uint64_t seed : {1, 2}) {
    EXPECT_TRUE(same_bytes(pixels, rasterized(on_host(), shuffled(terrain, seed), grid))) << seed;
  }
}

TEST(SmallRaster, HasTheValuesOfTheTrianglesThatPixelsLieIn) {
  for (const char* const fixture : {"uniform", "grid", "star", "kuzmin", "circle", "collinear"}) {
    SCOPED_TRACE(fixture);
    const Terrain terrain = terrain_of(fixture, 40);
    check_terrain(terrain, grid_over(terrain, 13, 17, 0.1));
    check_terrain(terrain, grid_over(terrain, 9, 9, 0));
  }
}

TEST(SmallRaster, AGridOfPointsHasPixelsOnItsPointsEdgesAndBorder) {
  Coordinates points;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) points.insert(points.end(), {500000.0 + j, 4.5e6 + i});
  }
  const Terrain terrain = make_terrain(points, random_values(36, 5, 1000));
  for (const double step : {1.0, 0.5, 0.25}) {
    const auto count = static_cast<std::size_t>(5 / step) + 1;
    const RasterGrid grid{500000.0, 4.5e6, step, step, count, count};
    check_terrain(terrain, grid);
    const std::vector<double> pixels = rasterized(testing::triangulator(), terrain, grid);
    const auto stride = static_cast<std::size_t>(1 / step);
    for (std::size_t i = 0; i < 36; ++i) {
      EXPECT_EQ(terrain.values[i], pixels[i / 6 * stride * count + i % 6 * stride]);
    }
    EXPECT_EQ(0, std::count(pixels.begin(), pixels.end(), kFill));
  }
}

TEST(SmallRaster, SliversAndLevelEdgesAreRight) {
  const double thin = 0x1p-40;
  const Terrain across = make_terrain({0, 0, 8, 8 + thin, 16, 16, 3, 1}, {1, 2, 3, 4});
  check_terrain(across, {0, 0, 1, 1, 17, 17});
  const Terrain level = make_terrain({0, 4, 100, 4 + thin, 200, 4, 7, 4 - thin, 55, 4}, {1, 2, 3, 4, 5});
  check_terrain(level, {0, 4, 1, thin / 2, 3, 201});
  check_terrain(level, {0, 3, 1, 0.5, 5, 201});
  // Much larger than the raster, and not at its scale.
  const Terrain large = make_terrain({-1e9, -3e8, 2e9, 5e8, -7e8, 1e9}, {0, 1000, -3000});
  check_terrain(large, {0.125, 7.5, 1e-3, -1e-3, 11, 11});
}

TEST(SmallRaster, TrianglesWithLongEdgesHaveNoPixels) {
  for (const char* const fixture : {"uniform", "grid"}) {
    const Terrain terrain = terrain_of(fixture, 60);
    const RasterGrid grid = grid_over(terrain, 13, 13, 0);
    for (const double part : {0.0, 0.15, 0.3, 0.6}) {
      const double longest = part * grid.dx * 12;
      const std::vector<double> pixels = rasterized(testing::triangulator(), terrain, grid, longest);
      expect_right(terrain, grid, pixels, longest);
    }
  }
  // Of pixels between a triangle that has none and one that does, whichever side is whose.
  for (const double side : {-1.0, 1.0}) {
    const Terrain kite = make_terrain({0, 0, 0, 4, side, 2, -10 * side, 2}, {0, 4, 2, 2});
    EXPECT_EQ(rasterized(testing::triangulator(), kite, {0, 1, 1, 1, 3, 1}, 5),
              (std::vector<double>{1, 2, 3}));
  }
}

TEST(SmallRaster, ACornerWithoutWeightDoesNotCount) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Terrain terrain = make_terrain({0, 0, 2, 0, 0, 2, 2, 2}, {1, 3, nan, 5});
  const std::vector<double> pixels = rasterized(testing::triangulator(), terrain, {0, 0, 1, 1, 3, 3});
  EXPECT_EQ(2, pixels[1]);
  EXPECT_EQ(4, pixels[5]);
  EXPECT_TRUE(std::isnan(pixels[3]));
}

TEST(SmallRaster, NothingGivesNothing) {
  const Terrain empty = make_terrain({}, {});
  EXPECT_EQ(std::vector<double>(4, kFill), rasterized(testing::triangulator(), empty, {0, 0, 1, 1, 2, 2}));
  EXPECT_TRUE(rasterized(testing::triangulator(), terrain_of("uniform", 9), {0, 0, 1, 1, 0, 5}).empty());
  EXPECT_TRUE(trace_contours(on_host(), empty.view(), nullptr, {1}).heights.empty());
}

TEST(SmallRaster, ErrorsSayWhatIsWrong) {
  Terrain terrain = make_terrain({0, 0, 1, 0, 0, 1}, {1, 2, 3});
  const auto with = [&](const RasterGrid& grid, double max_edge = 9) {
    return [&terrain, grid, max_edge] { rasterized(testing::triangulator(), terrain, grid, max_edge); };
  };
  testing::expect_error(ErrorKind::usage, "dx", with({0, 0, 0, 1, 2, 2}));
  testing::expect_error(ErrorKind::usage, "positive", with({0, 0, -1, 1, 2, 2}));
  testing::expect_error(ErrorKind::usage, "x = nan", with({std::nan(""), 0, 1, 1, 2, 2}));
  testing::expect_error(ErrorKind::usage, "rows", with({0, 0, 1, 1, std::size_t{1} << 31, 0}));
  testing::expect_error(ErrorKind::usage, "max_edge", with({0, 0, 1, 1, 2, 2}, -1));
  testing::expect_error(ErrorKind::input, "too small", with({1e6, 0, 1e-12, 1, 2, 2}));
  testing::expect_error(ErrorKind::input, "too fine", with({0, 0, 0x1p-520, 1, 2, 2}));
  terrain.mesh.triangles[1] = 3;
  testing::expect_error(ErrorKind::usage, "triangle 0", with({0, 0, 1, 1, 2, 2}));
  testing::expect_error(ErrorKind::usage, "triangle 0",
                        [&] { trace_contours(on_host(), terrain.view(), terrain.values.data(), {1.5}); });
  terrain.mesh.triangles[1] = 1;
  terrain.mesh.neighbors[0] = 1;
  testing::expect_error(ErrorKind::usage, "triangle 0", with({0.5, 0.5, 1, 1, 1, 1}));
  terrain.points[0] = std::nan("");
  testing::expect_error(ErrorKind::input, "point 0", with({0, 0, 1, 1, 2, 2}));
  for (const std::vector<double>& heights : {std::vector<double>{1, 1}, {2, 1}, {std::nan("")}}) {
    testing::expect_error(ErrorKind::usage, "heights",
                          [&] { trace_contours(on_host(), terrain.view(), terrain.values.data(), heights); });
  }
}

class ValuedArray : public ValuedPoints {
 public:
  explicit ValuedArray(const Terrain& terrain) : terrain_(terrain) {}
  std::uint64_t size() const override { return terrain_.values.size(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    std::copy_n(&terrain_.points[2 * first], 2 * count, coordinates);
  }
  void read_values(std::uint64_t first, std::size_t count, double* values) override {
    std::copy_n(&terrain_.values[first], count, values);
  }

 private:
  const Terrain& terrain_;
};

std::vector<double> in_chunks(const Terrain& terrain, const RasterGrid& grid, std::size_t chunk_points,
                              double max_edge = std::numeric_limits<double>::infinity(),
                              Duplicates duplicates = Duplicates::highest, std::size_t least_chunks = 1) {
  std::vector<double> pixels(grid.rows * grid.columns, 1e300);
  ValuedArray points(terrain);
  ChunkOptions options;
  options.chunk_points = chunk_points;
  options.memory_bytes = std::uint64_t{256} << 20;
  options.devices = {"host", "host"};
  const ChunkStatistics statistics =
      rasterize_chunks(points, duplicates, grid, {max_edge, kFill}, pixels.data(), options);
  EXPECT_GE(statistics.rounds.at(0).chunks, least_chunks);
  return pixels;
}

TEST(RasterInChunks, HasTheBytesOfAllTrianglesAtOnce) {
  for (const char* const fixture : {"uniform", "grid", "circle", "kuzmin"}) {
    const Terrain terrain = terrain_of(fixture, 4000);
    const auto [low, high] = std::minmax_element(terrain.points.begin(), terrain.points.end());
    const double extent = *high - *low;
    const RasterGrid grid{*low, *high, extent / 128, -extent / 128, 129, 129};
    for (const double max_edge : {std::numeric_limits<double>::infinity(), extent / 40}) {
      const std::vector<double> expected = rasterized(on_host(), terrain, grid, max_edge);
      EXPECT_TRUE(same_bytes(in_chunks(terrain, grid, 0, max_edge), expected)) << fixture;
      EXPECT_TRUE(same_bytes(in_chunks(terrain, grid, 80, max_edge, Duplicates::highest, 50), expected))
          << fixture << " " << max_edge;
    }
  }
}

// With integer coordinates, many pixels lie on sides of triangles, also on those between chunks and on the
// hull.
TEST(RasterInChunks, PixelsOnSidesBetweenChunksAreThoseOfTheWhole) {
  FixtureRandom random(5);
  Coordinates points;
  for (int i = 0; i < 6000; ++i) {
    points.push_back(static_cast<double>(random.integer(0, 200)));
    points.push_back(static_cast<double>(random.integer(0, 200)));
  }
  Terrain terrain = make_terrain(points, random_values(6000, 9, 1000));
  for (std::size_t i = 0; i < terrain.values.size(); ++i) {  // one value per place
    terrain.values[i] = terrain.values[static_cast<std::size_t>(terrain.mesh.representatives[i])];
  }
  const RasterGrid grid{-1, -1, 0.5, 0.5, 405, 405};
  for (const double max_edge : {std::numeric_limits<double>::infinity(), 4.0}) {
    const std::vector<double> expected = rasterized(on_host(), terrain, grid, max_edge);
    EXPECT_TRUE(same_bytes(in_chunks(terrain, grid, 100, max_edge, Duplicates::mean, 50), expected));
  }
}

TEST(RasterInChunks, EqualPointsHaveOneValue) {
  // 40 places, one of which has more points than a chunk; in any order.
  std::vector<std::array<double, 3>> measured;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < (i == 17 ? 3000 : 30); ++k) {
      measured.push_back(
          {static_cast<double>(i * 7 % 40), static_cast<double>(i * i % 13), 0.1 * (k * k % 97) + i});
    }
  }
  std::map<std::array<double, 2>, std::vector<double>> places;
  FixtureRandom(3).shuffle(measured);
  Coordinates points;
  std::vector<double> values;
  for (const auto& [x, y, value] : measured) {
    points.insert(points.end(), {x, y});
    values.push_back(value);
    places[{x, y}].push_back(value);
  }
  for (auto& [place, of_place] : places) std::sort(of_place.begin(), of_place.end());
  Terrain given = make_terrain(points, values);
  const RasterGrid grid{0, 0, 0.5, 0.5, 25, 79};
  for (const Duplicates duplicates : {Duplicates::highest, Duplicates::lowest, Duplicates::mean}) {
    Terrain expected = given;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
      const std::vector<double>& of_place = places[{points[2 * i], points[2 * i + 1]}];
      const auto mean = [&] {
        return std::accumulate(of_place.begin(), of_place.end(), 0.0) / static_cast<double>(of_place.size());
      };
      expected.values[i] = duplicates == Duplicates::highest  ? of_place.back()
                           : duplicates == Duplicates::lowest ? of_place.front()
                                                              : mean();
    }
    const std::vector<double> pixels = rasterized(on_host(), expected, grid);
    for (const std::size_t chunk_points : {0, 100}) {
      EXPECT_TRUE(same_bytes(
          in_chunks(given, grid, chunk_points, std::numeric_limits<double>::infinity(), duplicates), pixels));
    }
  }
}

TEST(RasterInChunks, ErrorsSayWhatIsWrong) {
  Terrain terrain = terrain_of("uniform", 3000);
  terrain.values[2222] = std::numeric_limits<double>::infinity();
  const auto message = [&](const RasterGrid& grid) -> std::string {
    try {
      in_chunks(terrain, grid, 0);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(message({0, 0, 0.1, 0.1, 5, 5}), "the value of point 2222 is not finite: inf");
  EXPECT_EQ(message({0, 0, -0.1, 0.1, 5, 5}), "dx = -0.1 must be positive");
}

TEST(Raster, ManyPointsGiveTheSameOnAnyNumberOfThreads) {
  const Terrain terrain = terrain_of("uniform", 20000);
  const RasterGrid grid = grid_over(terrain, 300, 200, 0.01);
  check_terrain(terrain_of("kuzmin", 150), grid_over(terrain_of("kuzmin", 150), 20, 20, 0.01));
  std::vector<double> first;
  for (const char* const threads : {"1", "2", "5"}) {
    const testing::ScopedEnvironment scoped("FLAUNAY_THREADS", threads);
    Triangulator triangulator("host");
    const std::vector<double> pixels = rasterized(triangulator, terrain, grid);
    if (first.empty()) first = pixels;
    EXPECT_TRUE(same_bytes(first, pixels));
  }
}

// ---- Contours

using Place = std::array<double, 2>;
using Piece = std::array<Place, 2>;

Contours traced(const Terrain& terrain, const std::vector<double>& heights,
                double max_edge = std::numeric_limits<double>::infinity()) {
  return trace_contours(on_host(), terrain.view(), terrain.values.data(), heights, max_edge);
}

std::vector<Place> line_of(const Contours& contours, std::size_t i) {
  std::vector<Place> line;
  for (std::size_t p = contours.offsets[i]; p < contours.offsets[i + 1]; ++p) {
    line.push_back({contours.coordinates[2 * p], contours.coordinates[2 * p + 1]});
  }
  return line;
}

// Where the line of a height crosses an edge, which is followed from its smaller end.
Place crossing(const Terrain& terrain, std::int32_t v, std::int32_t w, double height) {
  Place a = {terrain.point(v)[0], terrain.point(v)[1]}, b = {terrain.point(w)[0], terrain.point(w)[1]};
  double low = terrain.values[static_cast<std::size_t>(v)],
         high = terrain.values[static_cast<std::size_t>(w)];
  if (b < a) {
    std::swap(a, b);
    std::swap(low, high);
  }
  if (low == height) return a;
  if (high == height) return b;
  const double part = (height - low) / (high - low);
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
}

// The piece in each triangle of the lines of a height, with higher values on the left; none of one point.
std::vector<Piece> pieces_of(const Terrain& terrain, double height, double max_edge) {
  std::vector<Piece> pieces;
  for (std::size_t t = 0; t < terrain.mesh.triangles.size() / 3; ++t) {
    if (has_longer_edge(terrain, t, max_edge)) continue;
    const auto v = terrain.corners(t);
    std::optional<Place> from, to;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = v[k], b = v[(k + 1) % 3];
      const bool a_above = terrain.values[static_cast<std::size_t>(a)] >= height,
                 b_above = terrain.values[static_cast<std::size_t>(b)] >= height;
      if (a_above && !b_above) from = crossing(terrain, a, b, height);
      if (!a_above && b_above) to = crossing(terrain, a, b, height);
    }
    if (from && *from != *to) pieces.push_back({*from, *to});
  }
  std::sort(pieces.begin(), pieces.end());
  return pieces;
}

int side(const Piece& piece, const Place& q) {
  return sgn(locate::area(piece[0].data(), piece[1].data(), q.data()));
}

// Whether two pieces have a place in common.
bool meet(const Piece& p, const Piece& q) {
  for (const std::size_t k : {0, 1}) {
    if (std::max(p[0][k], p[1][k]) < std::min(q[0][k], q[1][k]) ||
        std::max(q[0][k], q[1][k]) < std::min(p[0][k], p[1][k]))
      return false;
  }
  return side(p, q[0]) * side(p, q[1]) <= 0 && side(q, p[0]) * side(q, p[1]) <= 0;
}

// A line meets itself where one of its pieces ends and the next one begins, and nowhere else.
void expect_simple(const std::vector<Place>& line) {
  const bool is_closed = line.front() == line.back();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Piece piece = {line[i - 1], line[i]};
    if (i + 1 < line.size()) {
      EXPECT_FALSE(meet(piece, {line[i + 1], line[i + 1]})) << i;
      EXPECT_FALSE(meet({line[i], line[i + 1]}, {line[i - 1], line[i - 1]})) << i;
    }
    for (std::size_t j = i + 2; j < line.size(); ++j) {
      if (is_closed && i == 1 && j + 1 == line.size()) continue;
      EXPECT_FALSE(meet(piece, {line[j - 1], line[j]})) << i << " " << j;
    }
  }
}

void expect_same(const Contours& found, const Contours& expected) {
  EXPECT_TRUE(same_bytes(found.coordinates, expected.coordinates));
  EXPECT_EQ(found.offsets, expected.offsets);
  EXPECT_EQ(found.heights, expected.heights);
}

void check_contours(const Terrain& terrain, const std::vector<double>& heights,
                    double max_edge = std::numeric_limits<double>::infinity()) {
  const Contours contours = traced(terrain, heights, max_edge);
  ASSERT_EQ(contours.heights.size() + 1, contours.offsets.size());
  ASSERT_TRUE(std::is_sorted(contours.heights.begin(), contours.heights.end()));
  std::vector<std::vector<Piece>> found(heights.size());
  for (std::size_t i = 0; i < contours.heights.size(); ++i) {
    const std::vector<Place> line = line_of(contours, i);
    ASSERT_GE(line.size(), line.front() == line.back() ? 4u : 2u);
    for (std::size_t p = 1; p < line.size(); ++p) {
      ASSERT_NE(line[p - 1], line[p]);
      found[static_cast<std::size_t>(contours.heights[i])].push_back({line[p - 1], line[p]});
    }
    expect_simple(line);
    if (line.front() != line.back()) continue;
    EXPECT_EQ(line.front(), *std::min_element(line.begin(), line.end()));
  }
  for (std::size_t level = 0; level < heights.size(); ++level) {
    std::vector<Piece> expected = pieces_of(terrain, heights[level], max_edge);
    std::sort(found[level].begin(), found[level].end());
    // Closed lines there and back between two points are left out.
    std::vector<Piece> missing;
    std::set_difference(expected.begin(), expected.end(), found[level].begin(), found[level].end(),
                        std::back_inserter(missing));
    for (const Piece& piece : missing) {
      EXPECT_EQ(1, std::count(missing.begin(), missing.end(), Piece{piece[1], piece[0]}));
    }
    EXPECT_EQ(expected.size(), found[level].size() + missing.size());
    EXPECT_TRUE(std::includes(expected.begin(), expected.end(), found[level].begin(), found[level].end()));
  }
  for (const std::uint64_t seed : {1, 2}) {
    expect_same(traced(shuffled(terrain, seed), heights, max_edge), contours);
  }
}

TEST(Contours, HaveThePiecesOfAllTriangles) {
  for (const char* const fixture : {"uniform", "grid", "star", "kuzmin", "collinear"}) {
    SCOPED_TRACE(fixture);
    check_contours(terrain_of(fixture, 60), {-50.0625, 0.0625, 3.03125, 77.03125});
    check_contours(terrain_of(fixture, 60), {0.0625, 77.03125}, 0.3);
  }
}

TEST(Contours, ValuesThatEqualAHeightCountAsAbove) {
  // Few different values: summits, ridges and plains at a height.
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Terrain terrain = terrain_of("grid", 49);
    terrain.values = random_values(49, seed, 2);
    check_contours(terrain, {-0.25, -0.125, 0, 0.125, 0.25});
  }
}

TEST(Contours, AHillHasClosedLinesCounterClockwise) {
  Coordinates points;
  std::vector<double> values;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      points.insert(points.end(), {i / 4.0, j / 4.0});
      values.push_back(-i * i - j * j);
    }
  }
  const Terrain terrain = make_terrain(points, values);
  const Contours contours = traced(terrain, {-20.5, -10.5, -3.5});
  EXPECT_EQ((std::vector<std::int32_t>{0, 0, 0, 0, 1, 2}), contours.heights);
  for (std::size_t i = 0; i < contours.heights.size(); ++i) {
    const std::vector<Place> line = line_of(contours, i);
    EXPECT_EQ(i >= 4, line.front() == line.back());
    double area = 0;
    for (std::size_t p = 1; p < line.size(); ++p) {
      area += line[p - 1][0] * line[p][1] - line[p - 1][1] * line[p][0];
    }
    EXPECT_GT(area, 0);
  }
}

// Two hills that meet at the height, with lower land around them.
TEST(Contours, ALineThatTouchesItselfBecomesSeveral) {
  const Terrain terrain = make_terrain({0, 0, -2, 0, 2, 0, 0, 2, 0, -2, -4, -4, 4, -4, 4, 4, -4, 4},
                                       {0, 1, 1, -1, -1, -1, -1, -1, -1});
  const Contours contours = traced(terrain, {0});
  ASSERT_EQ(2u, contours.heights.size());
  for (const std::size_t i : {0, 1}) {
    const std::vector<Place> line = line_of(contours, i);
    EXPECT_EQ(1, std::count(line.begin() + 1, line.end(), Place{0, 0}));
    expect_simple(line);
  }
  EXPECT_EQ((Place{0, 0}), line_of(contours, 1).front());
  check_contours(terrain, {-0.5, 0, 0.5});
}

// A lattice that is turned has triangles at its hull that are thinner than rounding.
Terrain turned_lattice(int n, double angle, double offset) {
  Coordinates points;
  std::vector<double> values;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      points.insert(points.end(), {offset + c * i - s * j, offset + s * i + c * j});
      values.push_back(std::sin(c * i - s * j) + s * i + c * j);
    }
  }
  return make_terrain(points, values);
}

TEST(Contours, OfThinTrianglesAreSimple) {
  const std::vector<double> heights = {0.5, 2.0, 3.5, 5.0, 7.75, 10.0};
  for (const double angle : {0.001, 0.7}) {
    for (const double offset : {0.0, 5.8e6}) {
      SCOPED_TRACE(::testing::Message() << angle << " " << offset);
      Terrain terrain = turned_lattice(12, angle, offset);
      for (const bool has_few_values : {false, true}) {
        if (has_few_values) terrain.values = random_values(terrain.values.size(), 4, 80);
        const Contours contours = traced(terrain, heights);
        for (const std::uint64_t seed : {1, 2})
          expect_same(traced(shuffled(terrain, seed), heights), contours);
        std::vector<std::vector<Piece>> pieces;
        for (const double height : heights) pieces.push_back(pieces_of(terrain, height, 1e300));
        for (std::size_t i = 0; i < contours.heights.size(); ++i) {
          const std::vector<Place> line = line_of(contours, i);
          expect_simple(line);
          // Places move by no more than rounding.
          for (const auto& [x, y] : line) {
            double nearest = 1e300;
            for (const auto& [a, b] : pieces[static_cast<std::size_t>(contours.heights[i])]) {
              const double dx = b[0] - a[0], dy = b[1] - a[1];
              const double part =
                  std::clamp(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
              nearest = std::min(nearest, std::hypot(x - a[0] - part * dx, y - a[1] - part * dy));
            }
            EXPECT_LE(nearest, 0x1p-50 * (offset + 20));
          }
        }
      }
    }
  }
}

// Alone, and in one pass with a raster.
TEST(ContoursInChunks, HaveTheBytesOfAllTrianglesAtOnce) {
  for (const std::string fixture : {"uniform", "grid", "circle", "kuzmin", "turned"}) {
    SCOPED_TRACE(fixture);
    // Few different values: lines through vertices, many of which are on sides between chunks.
    for (const bool has_few_values : {false, true}) {
      Terrain terrain = fixture == "turned" ? turned_lattice(50, 0.01, 5e5) : terrain_of(fixture, 4000);
      if (has_few_values) terrain.values = random_values(terrain.values.size(), 6, 2);
      for (std::size_t i = 0; i < terrain.values.size(); ++i) {  // one value per place
        terrain.values[i] = terrain.values[static_cast<std::size_t>(terrain.mesh.representatives[i])];
      }
      const auto [low, high] = std::minmax_element(terrain.points.begin(), terrain.points.end());
      const double extent = *high - *low;
      const std::vector<double> heights = {-0.25, -0.125, 0, 0.125, 3.0625};
      for (const double max_edge : {std::numeric_limits<double>::infinity(), extent / 40}) {
        const Contours expected = traced(terrain, heights, max_edge);
        const RasterGrid grid{*low, *high, extent / 64, -extent / 64, 65, 65};
        ValuedArray points(terrain);
        for (const std::size_t chunk_points : {0, 80}) {
          ChunkOptions options;
          options.chunk_points = chunk_points;
          options.devices = {"host", "host"};
          std::vector<double> pixels(grid.rows * grid.columns);
          Contours alone, together;
          rasterize_chunks(points, Duplicates::mean, {}, {max_edge}, nullptr, heights, alone, {}, options);
          rasterize_chunks(points, Duplicates::mean, grid, {max_edge, kFill}, pixels.data(), heights,
                           together, {}, options);
          expect_same(alone, expected);
          expect_same(together, expected);
          EXPECT_TRUE(same_bytes(pixels, rasterized(on_host(), terrain, grid, max_edge)));
        }
      }
    }
  }
}

// Lines from below to above that do not meet, some of their points on others of the terrain.
struct Lines {
  Coordinates points;
  std::vector<double> values;
  std::vector<std::int32_t> segments;

  Breaklines view() const {
    return {points.data(), values.data(), values.size(), segments.data(), segments.size() / 2};
  }
};

Lines make_lines(double low, double extent, double unit, std::uint64_t seed) {
  FixtureRandom random(seed);
  Lines lines;
  for (int line = 1; line < 8; ++line) {
    for (int k = 0; k <= 12; ++k) {
      const auto index = static_cast<std::int32_t>(lines.values.size());
      const double x = low + extent * (line / 8.0 + static_cast<double>(random.integer(0, 100)) / 2000);
      lines.points.push_back(unit * std::round(x / unit));
      lines.points.push_back(unit * std::round((low + extent * k / 12.0) / unit));
      lines.values.push_back(static_cast<double>(random.integer(0, 4)) / 8);
      if (k > 0) lines.segments.insert(lines.segments.end(), {index - 1, index});
    }
  }
  return lines;
}

TEST(RasterInChunks, BreaklinesAreEdges) {
  const std::vector<double> heights = {-0.125, 0.125, 3.0625};
  for (const bool is_lattice : {false, true}) {
    FixtureRandom random(12);
    const std::int64_t most = is_lattice ? 60 : 1 << 20;
    Coordinates points;
    for (int i = 0; i < 12000; ++i) points.push_back(static_cast<double>(random.integer(0, most)));
    const double extent = static_cast<double>(most);
    const Lines lines = make_lines(0, extent, 1, 5);
    const std::vector<double> values = random_values(6000, 9, is_lattice ? 4 : 1000);

    Terrain whole{lines.points, lines.values, {}};
    whole.points.insert(whole.points.end(), points.begin(), points.end());
    whole.values.insert(whole.values.end(), values.begin(), values.end());
    Constraints constraints;
    constraints.segments = lines.segments.data();
    constraints.segment_count = lines.segments.size() / 2;
    whole.mesh = on_host().constrained(whole.points.data(), whole.values.size(), constraints);
    for (std::size_t i = 0; i < whole.values.size(); ++i) {
      const auto place = static_cast<std::size_t>(whole.mesh.representatives[i]);
      if (place >= lines.values.size()) whole.values[place] = std::max(whole.values[place], whole.values[i]);
    }

    Terrain others{points, values, {}};
    ValuedArray source(others);
    const RasterGrid grid{-1, extent + 1, extent / 119, -extent / 119, 121, 121};
    for (const double max_edge : {std::numeric_limits<double>::infinity(), extent / 25}) {
      for (const std::size_t chunk_points : {0, 100}) {
        ChunkOptions options;
        options.chunk_points = chunk_points;
        options.devices = {"host", "host"};
        std::vector<double> pixels(grid.rows * grid.columns);
        Contours contours;
        rasterize_chunks(source, Duplicates::highest, grid, {max_edge, kFill}, pixels.data(), heights,
                         contours, lines.view(), options);
        EXPECT_TRUE(same_bytes(pixels, rasterized(on_host(), whole, grid, max_edge)));
        expect_same(contours, traced(whole, heights, max_edge));
      }
    }
    // Without the lines, it is another raster.
    const Terrain plain = make_terrain(whole.points, whole.values);
    EXPECT_FALSE(same_bytes(rasterized(on_host(), plain, grid), rasterized(on_host(), whole, grid)));
  }
}

TEST(RasterInChunks, BreaklinesThatCrossAreNamed) {
  const Terrain terrain = terrain_of("uniform", 500);
  ValuedArray source(terrain);
  const Coordinates corners = {0.1, 0.1, 0.9, 0.9, 0.1, 0.9, 0.9, 0.1};
  const std::vector<double> zeros(4, 0);
  const auto with = [&](const std::vector<std::int32_t>& segments) {
    return [&, segments] {
      Contours contours;
      rasterize_chunks(source, Duplicates::highest, {}, {}, nullptr, {}, contours,
                       {corners.data(), zeros.data(), 4, segments.data(), segments.size() / 2});
    };
  };
  testing::expect_error(ErrorKind::input, "segments 0", with({0, 1, 2, 3}));
  testing::expect_error(ErrorKind::usage, "segment", with({0, 4}));
}

TEST(SmallShading, HillsAreLitFromTheNorthWest) {
  constexpr std::size_t kRows = 3, kColumns = 4, kCount = kRows * kColumns;
  RasterGrid grid;
  grid.y = 60;
  grid.dx = 2;
  grid.dy = -2;
  grid.rows = kRows;
  grid.columns = kColumns;
  const auto shaded = [&](double east, double north, const ShadingOptions& options) {
    std::vector<double> pixels;
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto row = static_cast<double>(i / kColumns), column = static_cast<double>(i % kColumns);
      pixels.push_back(2 * east * column - 2 * north * row);
    }
    std::vector<std::uint8_t> picture((options.colors ? 4 : 2) * kCount, 7);
    shade_hills(grid, pixels.data(), options, picture.data());
    EXPECT_EQ(std::count(picture.end() - kCount, picture.end(), 255), kCount);
    picture.resize(picture.size() - kCount);
    return picture;
  };
  const auto expect_grey = [&](double light, const std::vector<std::uint8_t>& picture) {
    EXPECT_EQ(picture, std::vector<std::uint8_t>(kCount, static_cast<std::uint8_t>(255 * light)));
  };
  const double root = std::sqrt(2.0);
  expect_grey(1 / root, shaded(0, 0, {}));
  // Hillsides of 45 degrees. What rises to the east faces the west, and the light.
  expect_grey((1 + 1 / root) / 2, shaded(1, 0, {}));
  expect_grey((1 - 1 / root) / 2, shaded(-1, 0, {}));
  expect_grey((1 - 1 / root) / 2, shaded(0, 1, {}));
  ShadingOptions options;
  options.vertical_factor = 4;
  expect_grey((1 + 1 / root) / 2, shaded(0.25, 0, options));
  // Of degrees, in metres: those of longitude are about half as long here.
  options = {};
  options.is_geographic = true;
  EXPECT_EQ(shaded(0, 111195, options), shaded(0, 1, {}));
  EXPECT_EQ(shaded(111195, 0, options)[0], shaded(2, 0, {})[0]);
  options = {};
  options.colors = true;
  const std::vector<std::uint8_t> level = shaded(0, 0, options), slope = shaded(1, 0, options);
  EXPECT_NEAR(level[0], 90, 1);
  EXPECT_NEAR(level[kCount], 150, 1);
  EXPECT_NEAR(level[2 * kCount], 95, 1);
  EXPECT_NEAR(slope[kColumns - 1], 250, 5);  // the highest, and lit
  EXPECT_LT(slope[2 * kCount], 120);
}

TEST(SmallShading, LeavesOutWhatIsNotThere) {
  RasterGrid grid;
  grid.rows = 5;
  grid.columns = 5;
  std::vector<double> pixels(25, 1);
  pixels[12] = std::numeric_limits<double>::quiet_NaN();
  ShadingOptions options;
  options.colors = true;
  std::vector<std::uint8_t> picture(100);
  shade_hills(grid, pixels.data(), options, picture.data());
  for (std::size_t i = 0; i < 25; ++i) {
    const bool is_there = i != 7 && i != 11 && i != 12 && i != 13 && i != 17;
    EXPECT_EQ(picture[75 + i], is_there ? 255 : 0) << i;
    EXPECT_EQ(picture[i] > 0, is_there) << i;
  }
  grid.rows = 1;
  // The highest beside others as high, of a range that no double has.
  std::copy_n(std::array<double, 5>{-1.7e308, pixels[12], 1.7e308, 1.7e308, 1.7e308}.begin(), 5,
              pixels.begin());
  shade_hills(grid, pixels.data(), options, picture.data());
  EXPECT_EQ(picture[4], 250);
  EXPECT_EQ(picture[19], 255);
  grid.columns = 1;
  shade_hills(grid, pixels.data(), {}, picture.data());
  EXPECT_EQ(picture[0], 180);
  for (const double factor : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    options.vertical_factor = factor;
    testing::expect_error(ErrorKind::usage, "vertical_factor",
                          [&] { shade_hills(grid, pixels.data(), options, picture.data()); });
  }
}

TEST(Contours, LeaveOutValuesThatAreNotFinite) {
  Terrain terrain = terrain_of("uniform", 50);
  terrain.values[7] = std::numeric_limits<double>::quiet_NaN();
  terrain.values[8] = std::numeric_limits<double>::infinity();
  const Contours contours = traced(terrain, {0.0625});
  EXPECT_FALSE(contours.heights.empty());
  for (const double c : contours.coordinates) EXPECT_TRUE(std::isfinite(c));
}

TEST(Contours, DoNotCross) {
  const Terrain terrain = terrain_of("uniform", 400);
  const Contours contours = traced(terrain, {-60, -20, 0.0625, 30, 90});
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < contours.heights.size(); ++i) {
    const std::vector<Place> line = line_of(contours, i);
    for (std::size_t p = 1; p < line.size(); ++p) pieces.push_back({line[p - 1], line[p]});
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Piece &p = pieces[i], &q = pieces[j];
      if (std::max(p[0][0], p[1][0]) < std::min(q[0][0], q[1][0]) ||
          std::max(q[0][0], q[1][0]) < std::min(p[0][0], p[1][0]))
        continue;
      EXPECT_FALSE(side(p, q[0]) * side(p, q[1]) < 0 && side(q, p[0]) * side(q, p[1]) < 0);
    }
  }
}

}  // namespace
}  // namespace flaunay::raster
