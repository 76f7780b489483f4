// CGAL's regular triangulation.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>

#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

Outcome run_weighted(const std::vector<double>& points, const std::vector<double>& weights) {
  using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Triangulation = CGAL::Regular_triangulation_2<Predicates>;
  const Stopwatch watch;
  std::vector<Triangulation::Weighted_point> all;
  all.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    all.emplace_back(Triangulation::Bare_point(points[2 * i], points[2 * i + 1]), weights[i]);
  }
  Triangulation triangulation;
  triangulation.insert(all.begin(), all.end());
  return {watch.seconds(), triangulation.number_of_faces()};
}

const bool kBuiltWeighted = (run_cgal_weighted = run_weighted, true);

}  // namespace
}  // namespace flaunay::bench
