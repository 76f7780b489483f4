#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "peer.hpp"
#include "timing.hpp"

namespace flaunay::bench {

PeerRun run_cgal(const io::Points& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const Stopwatch watch;
  std::vector<Kernel::Point_2> own;
  own.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    own.emplace_back(points.coordinates[2 * i], points.coordinates[2 * i + 1]);
  }
  const CGAL::Delaunay_triangulation_2<Kernel> triangulation(own.begin(), own.end());
  return {watch.seconds(), triangulation.number_of_faces()};
}

}  // namespace flaunay::bench
