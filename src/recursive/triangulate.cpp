// The modes that need no device.
#include <algorithm>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "recursive/dwyer.hpp"
#include "recursive/mesh.hpp"
#include "recursive/phases.hpp"
#include "recursive/points.hpp"
#include "recursive/recursive.hpp"
#include "recursive/sort.hpp"

namespace flaunay {
namespace recursive {
namespace {

// Shares of the time, for progress.
constexpr double kSorted = 0.2;
constexpr double kTriangulated = 0.8;

void append_set(Mesh&& set, std::int32_t first_id, Mesh& all) {
  if (all.triangles.empty() && first_id == 0) {
    all = std::move(set);
    return;
  }
  const auto first_halfedge = static_cast<std::int32_t>(all.triangles.size());
  for (const std::int32_t position : set.triangles) all.triangles.push_back(position + first_id);
  for (const std::int32_t twin : set.twins) all.twins.push_back(twin < 0 ? -1 : twin + first_halfedge);
}

Mesh dwyer_of_sets(const PointSets& sets, Work* work, const Phases& phases) {
  Mesh all;
  const std::size_t count = sets.set_offsets.size() - 1;
  for (std::size_t s = 0; s < count; ++s) {
    const std::int32_t first = sets.set_offsets[s];
    append_set(dwyer(sets.predicates, sets.points.data() + first, sets.set_offsets[s + 1] - first, work),
               first, all);
    phases.progress("triangulate", kSorted + (kTriangulated - kSorted) * static_cast<double>(s + 1) /
                                                 static_cast<double>(count));
  }
  return all;
}

void count_sorting(const PointSets& sets, const std::vector<std::size_t>& offsets, Work& work) {
  std::uint64_t path = 0;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    path = std::max(path, depth_of_sort(offsets[s + 1] - offsets[s]));
  }
  OperationCounts& start = work.start[static_cast<std::size_t>(Component::cut)];
  start.arithmetic += sets.comparisons;
  start.critical_path += path;
}

}  // namespace
}  // namespace recursive

Triangulation triangulate_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                                  const Options& options) {
  using namespace recursive;
  if (options.mode != Mode::dwyer && options.mode != Mode::recursive) {
    throw Error(ErrorKind::usage, "only the modes recursive and dwyer run without a device");
  }
  Phases phases(options);
  phases.progress("sort", 0);
  const PointSets sets = ingest(coordinates, offsets);
  phases.end("sort");

  phases.progress("triangulate", kSorted);
  Statistics statistics;
  Mesh mesh;
  if (options.mode == Mode::recursive) {
    mesh.triangles = recursive_triangles(sets, options, statistics);
  } else {
    mesh = dwyer_of_sets(sets, options.count ? &statistics.work : nullptr, phases);
  }
  if (options.count) count_sorting(sets, offsets, statistics.work);
  phases.end("triangulate");

  phases.progress("canonical form", kTriangulated);
  Triangulation result = finish(sets, std::move(mesh.triangles), std::move(mesh.twins), options);
  phases.end("canonical form");
  phases.write(result.statistics);
  result.statistics.levels = std::move(statistics.levels);
  result.statistics.work = std::move(statistics.work);
  phases.progress("canonical form", 1);
  return result;
}

}  // namespace flaunay
