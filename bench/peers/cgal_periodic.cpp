// CGAL's triangulation of points on a torus.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Periodic_2_Delaunay_triangulation_2.h>
#include <CGAL/Periodic_2_Delaunay_triangulation_traits_2.h>

#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

Outcome run_periodic(const std::vector<double>& coordinates) {
  using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Traits = CGAL::Periodic_2_Delaunay_triangulation_traits_2<Predicates>;
  using Triangulation = CGAL::Periodic_2_Delaunay_triangulation_2<Traits>;
  std::vector<Predicates::Point_2> points;
  points.reserve(coordinates.size() / 2);
  for (std::size_t i = 0; i < coordinates.size(); i += 2)
    points.emplace_back(coordinates[i], coordinates[i + 1]);
  const Stopwatch watch;
  Triangulation triangulation(Triangulation::Iso_rectangle(0, 0, 1, 1));
  constexpr bool kHasManyPoints = true;
  triangulation.insert(points.begin(), points.end(), kHasManyPoints);
  return {watch.seconds(), triangulation.number_of_faces()};
}

const bool kBuiltPeriodic = (run_cgal_periodic = run_periodic, true);

}  // namespace
}  // namespace flaunay::bench
