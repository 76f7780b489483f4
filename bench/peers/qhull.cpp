#include <cstdio>
#include <memory>
#include <type_traits>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

// Qhull reads the coordinates where they are.
static_assert(std::is_same_v<coordT, double>);

/// Triangles are the facets of the lower hull of the lifted points.
std::size_t count_triangles(qhT* qh) {
  std::size_t triangles = 0;
  facetT* facet;
  FORALLfacets {
    if (!facet->upperdelaunay) ++triangles;
  }
  return triangles;
}

void release(qhT* qh) {
  qh_freeqhull(qh, !qh_ALL);
  int blocks, bytes;
  qh_memfreeshort(qh, &blocks, &bytes);
}

Outcome run_qhull(const Input& points) {
  const auto state = std::make_unique<qhT>();
  qhT* qh = state.get();
  // d: Delaunay; Qt: splits merged facets into triangles; Qbb: scales the lifted coordinate; Qc: keeps points
  // on facets; Qz: adds a point at infinity, for cocircular input; Q12: goes on after wide merged facets.
  char options[] = "qhull d Qt Qbb Qc Qz Q12";
  const Stopwatch watch;
  qh_zero(qh, stderr);
  const int code =
      qh_new_qhull(qh, 2, static_cast<int>(points.n), const_cast<coordT*>(points.coordinates.data()), False,
                   options, nullptr, stderr);
  const double seconds = watch.seconds();
  const std::size_t triangles = code == 0 ? count_triangles(qh) : 0;
  release(qh);
  if (code != 0) throw Error(ErrorKind::input, "qhull gave up; its message is above");
  return {seconds, triangles};
}

const BuiltPeer kBuilt(
    {"qhull",
     "libqhull_r with 'd Qt Qbb Qc Qz Q12', not exact (it merges facets that it cannot tell apart), one "
     "thread: lifting the points, their convex hull in three dimensions, splitting merged facets",
     run_qhull});

}  // namespace
}  // namespace flaunay::bench
