// CGAL's triangulation of points on a sphere.
#include <CGAL/Delaunay_triangulation_on_sphere_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_on_sphere_traits_3.h>

#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

Outcome run_on_sphere(const std::vector<double>& directions) {
  using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Traits = CGAL::Projection_on_sphere_traits_3<Predicates>;
  const Stopwatch watch;
  const Traits traits(Predicates::Point_3(0, 0, 0), 1);
  const auto project = traits.construct_point_on_sphere_2_object();
  std::vector<Traits::Point_on_sphere_2> points;
  points.reserve(directions.size() / 3);
  for (std::size_t i = 0; i < directions.size(); i += 3) {
    points.push_back(project(Predicates::Point_3(directions[i], directions[i + 1], directions[i + 2])));
  }
  CGAL::Delaunay_triangulation_on_sphere_2<Traits> triangulation(traits);
  triangulation.insert(points.begin(), points.end());
  return {watch.seconds(), triangulation.number_of_faces()};
}

const bool kBuiltSphere = (run_cgal_on_sphere = run_on_sphere, true);

}  // namespace
}  // namespace flaunay::bench
