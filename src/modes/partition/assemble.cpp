// Combines a partition and the triangulations of its regions, which any program may have made, into the
// triangulation of all points.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/mesh.hpp"
#include "geometry/point_sets.hpp"
#include "modes/partition/check.hpp"
#include "modes/partition/regions.hpp"
#include "statistics/phases.hpp"

namespace flaunay::research {
using namespace geometry;
using namespace partition;

namespace {

using Ids = std::vector<std::int32_t>;

// The share of the time that is over when a phase ends, for progress.
constexpr double kSorted = 0.1;
constexpr double kRegions = 0.6;

[[noreturn]] void fail(const std::string& reason) { throw Error(ErrorKind::input, reason); }

// The id of each input point.
Ids ids_of_input(const PointSets& sets) {
  Ids ids(sets.representatives.size());
  for (std::size_t id = 0; id < sets.source.size(); ++id) {
    ids[sets.source[id]] = static_cast<std::int32_t>(id);
  }
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = ids[sets.representatives[i]];
  return ids;
}

std::int32_t id_of(const Ids& ids, std::int32_t index) {
  if (index < 0 || static_cast<std::size_t>(index) >= ids.size()) {
    fail(fmt::format("there is no point {} among {}", index, ids.size()));
  }
  return ids[index];
}

// The points of a region in the order of (x, y).
struct OrderedRegion {
  Ids ids;
  Ids names;  // indices of input points
  std::vector<Point> points;
  Ids rank;  // per position in Region::points, the rank of the point
};

OrderedRegion in_order(const PointSets& sets, const Ids& ids_of_input, const Region& region) {
  const std::size_t n = region.points.size();
  Ids ids, order(n);
  for (const std::int32_t index : region.points) ids.push_back(id_of(ids_of_input, index));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&ids](std::int32_t a, std::int32_t b) { return ids[a] < ids[b]; });
  OrderedRegion ordered;
  ordered.rank.resize(n);
  for (const std::int32_t position : order) {
    const std::int32_t id = ids[position];
    if (!ordered.ids.empty() && ordered.ids.back() == id) {
      fail(fmt::format("it has point {} twice", region.points[position]));
    }
    ordered.rank[position] = static_cast<std::int32_t>(ordered.ids.size());
    ordered.ids.push_back(id);
    ordered.names.push_back(region.points[position]);
    ordered.points.push_back(sets.points[id]);
  }
  return ordered;
}

// Positions that are out of range are not changed: checked_mesh reports them.
Ids ranks_of(const OrderedRegion& region, Ids positions) {
  for (std::int32_t& position : positions) {
    if (position >= 0 && position < static_cast<std::int32_t>(region.rank.size())) {
      position = region.rank[position];
    }
  }
  return positions;
}

std::vector<BorderEdge> border_of(const OrderedRegion& region, const Ids& positions) {
  if (positions.size() % 2 != 0) fail("its border has half an edge");
  const auto rank = [&region](std::int32_t position) {
    if (position < 0 || position >= static_cast<std::int32_t>(region.rank.size())) {
      fail(fmt::format("its border has position {} of {} points", position, region.rank.size()));
    }
    return region.rank[position];
  };
  std::vector<BorderEdge> border;
  for (std::size_t k = 0; k < positions.size(); k += 2) {
    border.emplace_back(rank(positions[k]), rank(positions[k + 1]));
  }
  return border;
}

void append_region(const PointSets& sets, const Ids& ids_of_input, const Region& region, const Ids& solution,
                   Ids& triangles) {
  const OrderedRegion ordered = in_order(sets, ids_of_input, region);
  const std::size_t n = ordered.points.size();
  Mesh mesh = checked_mesh(sets.predicates, ordered.points.data(), n, ordered.names.data(),
                           ranks_of(ordered, solution));
  const Ids inside = region_triangles(sets.predicates, ordered.points.data(), n,
                                      border_of(ordered, region.border), std::move(mesh));
  for (const std::int32_t rank : inside) triangles.push_back(ordered.ids[rank]);
}

// Calls part() and adds to its errors where they happened.
template <typename Part>
void named(const std::string& name, const Part& part) {
  try {
    part();
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace

flaunay::Triangulation assemble(const double* coordinates, std::size_t n, const Partition& partition,
                                const std::vector<std::vector<std::int32_t>>& solutions,
                                const flaunay::Options& options) {
  const std::size_t regions = partition.regions.size();
  if (solutions.size() != regions)
    fail(fmt::format("{} solutions for {} regions", solutions.size(), regions));
  statistics::Phases phases(options);
  phases.progress("sort", 0);
  const PointSets sets = ingest(coordinates, {0, n});
  phases.end("sort");

  const Ids ids = ids_of_input(sets);
  Ids triangles;
  for (std::size_t r = 0; r < regions; ++r) {
    phases.progress("regions",
                    kSorted + (kRegions - kSorted) * static_cast<double>(r) / static_cast<double>(regions));
    named(fmt::format("region {}", r),
          [&] { append_region(sets, ids, partition.regions[r], solutions[r], triangles); });
  }
  Mesh mesh;
  named("the parts do not make a whole", [&] {
    for (const std::int32_t index : partition.triangles) triangles.push_back(id_of(ids, index));
    mesh = checked_mesh(sets.predicates, sets.points.data(), sets.points.size(), sets.source.data(),
                        std::move(triangles));
  });
  phases.end("regions");

  phases.progress("canonical form", kRegions);
  flaunay::Triangulation result = finish(sets, std::move(mesh.triangles), std::move(mesh.twins), options);
  phases.end("canonical form");
  phases.write(result.statistics);
  phases.progress("canonical form", 1);
  return result;
}

}  // namespace flaunay::research
