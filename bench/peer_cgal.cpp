#include "cgal_mesh.hpp"
#include "peer.hpp"
#include "timing.hpp"

namespace flaunay::bench {

Outcome run_cgal(const Input& input) {
  const Stopwatch watch;
  cgal::Mesh mesh;
  std::vector<cgal::IndexedPoint> points;
  cgal::Delaunay triangulation;
  for (std::size_t s = 0; s + 1 < input.offsets.size(); ++s) {
    cgal::copy_points(input.points.coordinates, input.offsets[s], input.offsets[s + 1], points);
    triangulation.clear();
    cgal::insert(triangulation, points);
    cgal::append(triangulation, mesh);
  }
  return {watch.seconds(), mesh.triangles.size() / 3};
}

}  // namespace flaunay::bench
