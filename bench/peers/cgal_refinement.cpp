// CGAL's refinement of meshes.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <utility>

#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using RefinedVertex =
    CGAL::Delaunay_mesh_vertex_base_2<Kernel,
                                      CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>>;
using Refinable = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<RefinedVertex, CGAL::Delaunay_mesh_face_base_2<Kernel>>>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Refinable>;
using Point = Kernel::Point_2;

/// Squared sine of an angle. That of 20.7 degrees is the one with which CGAL is proven to end.
double bound_of(double min_angle) {
  constexpr double kProven = 20.7, kPi = 3.14159265358979323846;
  const double sine = std::sin(min_angle * kPi / 180);
  return min_angle == kProven ? 0.125 : sine * sine;
}

void insert(Refinable& triangulation, const ConstrainedInput& input, std::size_t set) {
  const std::size_t first = input.points.offsets[set], last = input.points.offsets[set + 1];
  const std::vector<double>& xy = input.points.coordinates;
  std::vector<Point> points;
  points.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) points.emplace_back(xy[2 * i], xy[2 * i + 1]);
  if (input.segments.empty()) {
    triangulation.insert(points.begin(), points.end());
    std::vector<std::pair<Refinable::Vertex_handle, Refinable::Vertex_handle>> hull;
    const auto begin = triangulation.incident_vertices(triangulation.infinite_vertex());
    auto at = begin;
    do {
      const auto before = at++;
      hull.emplace_back(before, at);
    } while (at != begin);
    for (const auto& [a, b] : hull) triangulation.insert_constraint(a, b);
    return;
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto end = [&](std::size_t k) { return static_cast<std::size_t>(input.segments[k]) - first; };
  for (std::size_t s = input.segment_offsets[set]; s < input.segment_offsets[set + 1]; ++s) {
    pairs.emplace_back(end(2 * s), end(2 * s + 1));
  }
  triangulation.insert_constraints(points.begin(), points.end(), pairs.begin(), pairs.end());
}

/// Appends the mesh to the meshes of the sets before.
void append_mesh(const Refinable& triangulation, Refined& refined) {
  auto index = static_cast<std::int32_t>(refined.coordinates.size() / 2);
  for (const auto vertex : triangulation.finite_vertex_handles()) {
    vertex->info() = index++;
    append(refined.coordinates, {vertex->point().x(), vertex->point().y()});
  }
  for (const auto face : triangulation.finite_face_handles()) {
    for (int k = 0; face->is_in_domain() && k < 3; ++k) {
      refined.triangles.push_back(face->vertex(k)->info());
    }
  }
}

Refined refine(const ConstrainedInput& input, const Wanted& wanted) {
  Refined refined;
  const std::vector<std::vector<double>> holes = places_in_holes(input);
  for (std::size_t set = 0; set < input.points.sets(); ++set) {
    std::vector<Point> seeds;
    for (std::size_t k = 0; k < holes[set].size(); k += 2)
      seeds.emplace_back(holes[set][k], holes[set][k + 1]);
    Refinable triangulation;
    const double processors = processor_seconds();
    const Stopwatch watch;
    insert(triangulation, input, set);
    CGAL::Delaunay_mesher_2<Refinable, Criteria> mesher(triangulation);
    mesher.set_seeds(seeds.begin(), seeds.end());
    mesher.set_criteria(Criteria(bound_of(wanted.min_angle)));
    mesher.refine_mesh();
    refined.seconds += watch.seconds();
    refined.processor_seconds += processor_seconds() - processors;
    append_mesh(triangulation, refined);
  }
  return refined;
}

const bool kBuiltRefinement = (refine_by_cgal = refine, true);

}  // namespace
}  // namespace flaunay::bench
