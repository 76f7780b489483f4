#include "modes/dwyer/run.hpp"

#include <utility>

namespace flaunay::dwyer {
using namespace geometry;

namespace {

void append_set(Mesh&& set, std::int32_t first_id, Mesh& all) {
  if (all.triangles.empty() && first_id == 0) {
    all = std::move(set);
    return;
  }
  const auto first_halfedge = static_cast<std::int32_t>(all.triangles.size());
  for (const std::int32_t position : set.triangles) all.triangles.push_back(position + first_id);
  for (const std::int32_t twin : set.twins) all.twins.push_back(twin < 0 ? -1 : twin + first_halfedge);
}

}  // namespace

Mesh run(const PointSets& sets, const research::Options& options, const statistics::Phases& phases,
         research::Triangulation& result) {
  research::Work* const work = options.count ? &result.work : nullptr;
  Mesh all;
  const std::size_t count = sets.set_offsets.size() - 1;
  for (std::size_t s = 0; s < count; ++s) {
    const std::int32_t first = sets.set_offsets[s];
    append_set(
        triangulate(sets.predicates, sets.points.data() + first, sets.set_offsets[s + 1] - first, work),
        first, all);
    phases.progress("triangulate", statistics::kSorted + (statistics::kTriangulated - statistics::kSorted) *
                                                             static_cast<double>(s + 1) /
                                                             static_cast<double>(count));
  }
  return all;
}

}  // namespace flaunay::dwyer
