// Prints a line per array of results, with its hash, for all fixtures and data files: what
// scripts/platform-test.sh compares between platforms. The lines do not name the device.
//
//   device_outputs [MOST]     without inputs of more than MOST points
//
// The device is FLAUNAY_DEVICE's. What was compiled and how long that took goes to the standard error output.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <type_traits>
#include <vector>

#include "app/files/points.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/paths.hpp"

namespace flaunay::testing {
namespace {

using research::Mode;
using research::Options;
using Offsets = std::vector<std::size_t>;

// Fowler, Noll and Vo's FNV-1a.
template <typename T>
std::uint64_t hash_of(const std::vector<T>& values) {
  // Sizes have fewer bits on some platforms.
  if constexpr (std::is_same_v<T, std::size_t> && sizeof(T) < sizeof(std::uint64_t)) {
    return hash_of(std::vector<std::uint64_t>(values.begin(), values.end()));
  }
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t k = 0; k < values.size() * sizeof(T); ++k) hash = (hash ^ bytes[k]) * 0x100000001b3U;
  return hash;
}

class Outputs {
 public:
  explicit Outputs(std::size_t most) : most_(most) {}

  void print(const std::string& name, const Coordinates& points) {
    print(name, points, {0, points.size() / 2});
  }

  // With all arrays and with the triangles and hulls alone.
  void print(const std::string& name, const Coordinates& points, const Offsets& offsets) {
    if (offsets.back() > most_) return;
    for (const Mode mode : {Mode::blocks, Mode::flattened}) {
      for (const bool neighbors : {true, false}) {
        Options options;
        options.mode = mode;
        options.neighbors = options.halfedges = neighbors;
        const auto mesh = research::triangulate(triangulator_, points.data(), offsets, options);
        build_seconds_ += mesh.statistics.build_seconds;
        const std::string prefix =
            fmt::format("{} {} {} {}", name, offsets.back(), to_string(mode), neighbors ? "all" : "alone");
        print_part(prefix, "triangles", mesh.triangles);
        print_part(prefix, "neighbors", mesh.neighbors);
        print_part(prefix, "halfedges", mesh.halfedges);
        print_part(prefix, "hull", mesh.hull);
        print_part(prefix, "representatives", mesh.representatives);
        print_part(prefix, "triangle_offsets", mesh.triangle_offsets);
        print_part(prefix, "hull_offsets", mesh.hull_offsets);
      }
    }
  }

  // The Voronoi diagram, and queries at the points and between them.
  void print_queries(const std::string& name, const Coordinates& points) {
    const std::size_t n = points.size() / 2;
    if (n > most_) return;
    const Triangulation mesh = triangulator_.triangulate(points.data(), n);
    const Voronoi voronoi = triangulator_.voronoi(points.data(), n, mesh);
    const std::string prefix = fmt::format("{} {} queries", name, n);
    print_part(prefix, "circumcentres", voronoi.circumcentres);
    print_part(prefix, "cells", voronoi.cells);
    print_part(prefix, "unbounded", voronoi.unbounded);
    const Coordinates box = {-0.5, -0.5, 0.75, -0.5, 0.75, 0.5, -0.5, 0.5};
    const ClippedVoronoi cells =
        triangulator_.clipped_voronoi(points.data(), n, mesh, box.data(), box.size() / 2);
    print_part(prefix, "clipped vertices", cells.vertices);
    print_part(prefix, "clipped offsets", cells.offsets);
    print_part(prefix, "clipped areas", cells.areas);
    Coordinates queries = points;
    for (std::size_t k = 2; k < points.size(); ++k) queries.push_back(points[k] / 2 + points[k - 2] / 2);
    Locator locator(triangulator_, points.data(), n, mesh);
    print_part(prefix, "located", locator.locate(queries.data(), queries.size() / 2));
    print_part(prefix, "nearest", locator.nearest(queries.data(), queries.size() / 2));
  }

  const Triangulator& triangulator() const { return triangulator_; }
  double build_seconds() const { return build_seconds_; }

 private:
  template <typename T>
  static void print_part(const std::string& prefix, const char* part, const std::vector<T>& values) {
    fmt::print("{} {} {} {:016x}\n", prefix, part, values.size(), hash_of(values));
  }

  std::size_t most_;
  Triangulator triangulator_;
  double build_seconds_ = 0;
};

void print_all(Outputs& outputs) {
  constexpr std::size_t kQueried = 300;
  Coordinates all;
  Offsets offsets{0};
  const auto add_set = [&](const Coordinates& set) {
    all.insert(all.end(), set.begin(), set.end());
    offsets.push_back(all.size() / 2);
  };
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {1, 2, 3, 7, 60, 400, 3000}) outputs.print(fixture.name, fixture.make(n, n));
    outputs.print(fixture.name + "-perturbed", perturbed(fixture.make(200, 2), 3));
    outputs.print_queries(fixture.name, fixture.make(kQueried, 5));
    for (const std::size_t n : {0, 1, 3, 40}) add_set(fixture.make(n, n + 1));
  }
  outputs.print("sets", all, offsets);
  for (const std::string& file : data_files()) {
    outputs.print(file, io::read_points(test_data() + "/" + file).coordinates);
  }
  // Large enough for several rounds and levels.
  for (const char* const name : {"uniform", "kuzmin", "circle", "grid"}) {
    outputs.print(name, make_fixture(name, 20000, 1));
  }
}

}  // namespace
}  // namespace flaunay::testing

int main(int count, char** arguments) {
  try {
    const std::size_t most = count > 1 ? std::strtoul(arguments[1], nullptr, 10) : SIZE_MAX;
    flaunay::testing::Outputs outputs(most);
    flaunay::testing::print_all(outputs);
    const flaunay::DeviceInfo device = outputs.triangulator().device();
    fmt::print(stderr, "{}, {}, {}; compiled for {:.1f} s\n", device.name, device.platform, device.driver,
               outputs.build_seconds());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
