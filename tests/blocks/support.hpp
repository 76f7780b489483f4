// What the tests of src/blocks share.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "blocks/pipeline.hpp"
#include "tests/points/support.hpp"

namespace flaunay::blocks {

using namespace geometry;
using namespace points;
using points::Rings;  // not those of polygons
using testing::RingCheck;

/// Sets of up to so many points are held against the reference, too.
constexpr std::size_t kReferencePoints = 130;

/// Rings against what must hold of them; see divide_test.cpp.
void check_rings(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                 const Rings& rings, const std::vector<cl_int>& representatives, HostRings& g, Met& met);
/// Two triangles over a square, by hand, in a block with room for more.
HostRings square_rings();
/// The mesh of rings against its twin; see mesh_test.cpp.
void check_mesh(Call& call, const Blocks& blocks, const Rings& rings, bool neighbors, const HostRings& g,
                Triangulation& result, Met& met);
/// All stages, from points to a mesh; see stages_test.cpp. exact: no filter decides anything.
Triangulation check_stages(Runtime& runtime, const Coordinates& coordinates, const Offsets& offsets, Met& met,
                           bool exact = false);
void check_stages(Runtime& runtime, const Coordinates& coordinates, Met& met, bool exact = false);

/// Rounds that launch all of their kernels, with runtime "rounds"; see rounds_test.cpp.
void run_rounds_of_all_kinds();

/// Blocks of any points, as rounds have them: with places behind the last block.
struct BlockPoints {
  std::vector<cl_int> offsets{0};
  std::vector<cl_double2> vertices;

  void add(const Coordinates& points) {
    for (const cl_double2& p : points_of(points)) vertices.push_back(p);
    offsets.push_back(static_cast<cl_int>(vertices.size()));
  }
  void add_places_behind(std::size_t count) { vertices.resize(vertices.size() + count, {{-7, -7}}); }

  std::size_t count() const { return offsets.size() - 1; }
  std::size_t points() const { return vertices.size(); }
  std::size_t first(std::size_t block) const { return static_cast<std::size_t>(offsets[block]); }
  std::size_t size(std::size_t block) const { return first(block + 1) - first(block); }
  std::size_t largest() const;
  /// The number of a point in the input: any order will do.
  cl_int source(std::size_t place) const { return static_cast<cl_int>(points() - 1 - place); }
  std::vector<cl_int> sources() const;
};

/// Empty blocks, single points, many tiny blocks, equal, collinear and cocircular points, grids; the largest
/// have n points.
std::vector<std::pair<std::string, BlockPoints>> nasty_blocks(std::size_t n, std::uint64_t seed);

/// Such blocks and rings in device memory. largest: what the host knows of them.
struct DeviceBlocks {
  PointBlocks blocks;
  Buffer<cl_int> representatives;
  Rings rings;

  DeviceBlocks(Call& call, const BlockPoints& points);
};

/// Calls check with a runtime that solves blocks by halves, for groups of several sizes, and so that blocks
/// of more than `capacity` points are large.
void with_groups(std::size_t capacity, const std::function<void(Runtime&)>& check);

}  // namespace flaunay::blocks
