#include "modes/on_host.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "geometry/sort.hpp"
#include "statistics/counter.hpp"

namespace flaunay::modes {
namespace {

void count_sorting(const std::vector<std::size_t>& offsets, research::Work& work) {
  research::OperationCounts& start = statistics::part_of(work.start, research::Component::cut);
  std::uint64_t path = 0;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    start.arithmetic += geometry::comparisons_to_sort(offsets[s + 1] - offsets[s]);
    path = std::max(path, geometry::depth_of_sort(offsets[s + 1] - offsets[s]));
  }
  start.critical_path += path;
}

}  // namespace

research::Triangulation run_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                                    const research::Options& options, HostMode mode) {
  statistics::Phases phases(options);
  phases.progress("sort", 0);
  const geometry::PointSets sets = geometry::ingest(coordinates, offsets);
  phases.end("sort");

  phases.progress("triangulate", statistics::kSorted);
  research::Triangulation counted;
  geometry::Mesh mesh = mode(sets, options, phases, counted);
  if (options.count) count_sorting(offsets, counted.work);
  phases.end("triangulate");

  phases.progress("canonical form", statistics::kTriangulated);
  static_cast<Triangulation&>(counted) =
      geometry::finish(sets, std::move(mesh.triangles), std::move(mesh.twins), options);
  phases.end("canonical form");
  phases.write(counted.statistics);
  phases.progress("canonical form", 1);
  return counted;
}

}  // namespace flaunay::modes
