// The public class DynamicTriangulation: what is asked for is checked here, and points are accounted for.
#include "flaunay/dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "call/areas.hpp"
#include "call/constrained.hpp"
#include "call/frame.hpp"
#include "call/triangulate.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "updates/points.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

// What a triangulation with constraints may not have, if points are to be inserted.
void check_supported(const Constraints& constraints, const ConstrainedOptions& options) {
  call::expect(options.outside == Outside::keep && constraints.hole_count == 0,
               "nothing can be left out of a triangulation that changes");
  call::expect(!options.labels && constraints.seed_count == 0 && constraints.rings.segment_offsets.empty(),
               "a triangulation that changes has no labels, seeds and rings");
  call::expect(!options.refinement.is_wanted(), "a triangulation that changes cannot be refined");
  call::expect(constraints.segment_markers == nullptr && constraints.point_markers == nullptr,
               "a triangulation that changes has no markers");
}

Error bad_number(std::size_t at, std::int64_t number, const char* why) {
  return Error(ErrorKind::input, fmt::format("entry {} of the batch is point {}, which {}", at, number, why));
}

// Throws unless n further points can be counted.
void check_count(std::size_t numbers, std::size_t n) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max() / 6;
  if (n > kMost || numbers + n > kMost) {
    throw Error(ErrorKind::input, fmt::format("{} points are inserted to {}: more than {} are not supported",
                                              n, numbers, kMost));
  }
}

void check_finite(const double* coordinates, std::size_t n) {
  geometry::check_coordinates(coordinates, n);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = coordinates[2 * i], y = coordinates[2 * i + 1];
    if (!std::isfinite(x) || !std::isfinite(y)) throw geometry::not_finite(i, x, y);
  }
}

}  // namespace

struct DynamicTriangulation::Implementation {
  Implementation(Triangulator& triangulator, const Options& wanted)
      : owner(TriangulatorAccess::shared(triangulator)), options(wanted) {}

  template <typename Work>
  auto take_turn(const Work& work) {
    return call::take_turn(*owner, work);
  }

  void make(const double* coordinates, std::size_t n) {
    check_count(0, n);
    check_finite(coordinates, n);
    points.append(coordinates, n);
    triangulate_anew();
  }

  void make(const double* coordinates, std::size_t n, const Constraints& constraints,
            const ConstrainedOptions& wanted) {
    check_supported(constraints, wanted);
    check_count(0, n);
    check_finite(coordinates, n);
    ConstrainedOptions all = wanted;
    all.neighbors = true;
    const ConstrainedTriangulation made = call::constrain_and_leave(*owner, coordinates, {0, n}, constraints,
                                                                    all, call::request_of(all, false));
    points.append(coordinates, n);
    points.append(made.added_points.data(), made.added_points.size() / 2);
    constrained.edges = made.constraint_edges;
    constrained.segments = made.edge_segments;
    triangulate_anew();
  }

  // Triangulates all living points.
  void triangulate_anew() {
    const updates::Living living = points.living();
    const std::size_t n = living.numbers.size();
    Options plain = options;
    plain.neighbors = true;
    plain.halfedges = plain.areas = plain.profile = false;
    Triangulation made;
    std::vector<std::uint8_t> has_edge;
    if (constrained.edges.empty()) {
      made = call::triangulate(*owner, {living.coordinates.data(), nullptr, n}, {0, n}, plain);
    } else {
      Ids segments(constrained.edges.size());
      for (std::size_t i = 0; i < segments.size(); ++i) segments[i] = living.places[constrained.edges[i]];
      Constraints constraints;
      constraints.segments = segments.data();
      constraints.segment_count = segments.size() / 2;
      ConstrainedOptions all;
      static_cast<Options&>(all) = plain;
      ConstrainedTriangulation result = call::constrain_and_leave(
          *owner, living.coordinates.data(), {0, n}, constraints, all, call::request_of(all, false));
      for (std::int32_t& v : result.constraint_edges) v = living.numbers[v];
      for (std::int32_t& edge : result.edge_segments) edge = constrained.segments[edge];
      constrained.edges = std::move(result.constraint_edges);
      constrained.segments = std::move(result.edge_segments);
      made = std::move(result);
    }
    for (std::int32_t& v : made.triangles) v = living.numbers[v];
    points.set_representatives(living, made.representatives);
    triangles = std::move(made.triangles);
    neighbors = std::move(made.neighbors);
    hull.resize(made.hull.size());
    for (std::size_t i = 0; i < hull.size(); ++i) hull[i] = living.numbers[made.hull[i]];
  }

  // Ends a batch that leaves these points.
  void update(Changes& changes) {
    changes.removed.resize(triangles.size() / 3);
    std::iota(changes.removed.begin(), changes.removed.end(), 0);
    triangulate_anew();
    changes.made.resize(triangles.size() / 3);
    std::iota(changes.made.begin(), changes.made.end(), 0);
    changes.made_corners = triangles;
    changes.is_anew = true;
  }

  Changes insert(const double* coordinates, std::size_t m) {
    check_count(points.numbers(), m);
    check_finite(coordinates, m);
    const double begin = host::now();
    Changes changes;
    changes.first_point = points.numbers();
    if (m == 0) return changes;
    points.check_range(coordinates, nullptr, m);
    points.append(coordinates, m);
    update(changes);
    for (std::size_t i = 0; i < m; ++i) {
      changes.representatives.push_back(points.representative(changes.first_point + i));
    }
    changes.seconds = host::now() - begin;
    return changes;
  }

  Changes remove(const std::int32_t* numbers, std::size_t m) {
    check_numbers(numbers, m, "removed");
    const double begin = host::now();
    Changes changes;
    changes.first_point = points.numbers();
    if (m == 0) return changes;
    for (std::size_t i = 0; i < m; ++i) points.remove(numbers[i]);
    update(changes);
    changes.seconds = host::now() - begin;
    return changes;
  }

  Changes move(const std::int32_t* numbers, const double* coordinates, std::size_t m) {
    check_numbers(numbers, m, "moved");
    check_finite(coordinates, m);
    const double begin = host::now();
    Changes changes;
    changes.first_point = points.numbers();
    if (m == 0) return changes;
    points.check_range(coordinates, numbers, m);
    for (std::size_t i = 0; i < m; ++i) points.move(numbers[i], coordinates + 2 * i);
    update(changes);
    for (std::size_t i = 0; i < m; ++i) {
      changes.representatives.push_back(points.representative(numbers[i]));
    }
    changes.seconds = host::now() - begin;
    return changes;
  }

  // Throws unless these are living points, each once, that may leave their places.
  void check_numbers(const std::int32_t* numbers, std::size_t m, const char* what) {
    call::expect(m == 0 || numbers != nullptr, "points, but no numbers: the pointer is null");
    const auto throw_bad = [&](std::size_t i) {
      const std::int32_t v = numbers[i];
      const bool is_known = v >= 0 && static_cast<std::size_t>(v) < points.numbers();
      throw bad_number(i, v,
                       !is_known            ? "does not exist"
                       : points.is_alive(v) ? "is there twice"
                                            : "was removed before");
    };
    const std::size_t bad = points.mark(numbers, m);
    if (bad < m) throw_bad(bad);
    for (std::size_t i = 0; i < constrained.edges.size(); ++i) {
      const std::int32_t v = constrained.edges[i];
      if (!points.is_marked(v)) continue;
      throw Error(ErrorKind::input,
                  fmt::format("point {} cannot be {}: it is on segment {} ({} to {})", v, what,
                              constrained.segments[i / 2], constrained.edges[i & ~std::size_t{1}],
                              constrained.edges[i | 1]));
    }
  }

  std::shared_ptr<call::Implementation> owner;
  Options options;
  updates::Points points;
  LivingConstraints constrained;
  Ids triangles, neighbors, hull;
};

DynamicTriangulation::DynamicTriangulation(Triangulator& triangulator, const double* coordinates,
                                           std::size_t n, const Options& options)
    : implementation_(std::make_unique<Implementation>(triangulator, options)) {
  implementation_->take_turn([&] { implementation_->make(coordinates, n); });
}

DynamicTriangulation::DynamicTriangulation(Triangulator& triangulator, const DevicePoints& points,
                                           const Options& options)
    : implementation_(std::make_unique<Implementation>(triangulator, options)) {
  implementation_->take_turn([&] {
    const std::vector<double> coordinates = call::read_points(*implementation_->owner, points);
    implementation_->make(coordinates.data(), coordinates.size() / 2);
  });
}

DynamicTriangulation::DynamicTriangulation(Triangulator& triangulator, const double* coordinates,
                                           std::size_t n, const Constraints& constraints,
                                           const ConstrainedOptions& options)
    : implementation_(std::make_unique<Implementation>(triangulator, options)) {
  implementation_->take_turn([&] { implementation_->make(coordinates, n, constraints, options); });
}

DynamicTriangulation::~DynamicTriangulation() = default;
DynamicTriangulation::DynamicTriangulation(DynamicTriangulation&&) noexcept = default;
DynamicTriangulation& DynamicTriangulation::operator=(DynamicTriangulation&&) noexcept = default;

Changes DynamicTriangulation::insert(const double* coordinates, std::size_t m) {
  return implementation_->take_turn([&] { return implementation_->insert(coordinates, m); });
}

Changes DynamicTriangulation::insert(const DevicePoints& points) {
  return implementation_->take_turn([&] {
    const std::vector<double> coordinates = call::read_points(*implementation_->owner, points);
    return implementation_->insert(coordinates.data(), coordinates.size() / 2);
  });
}

Changes DynamicTriangulation::remove(const std::int32_t* points, std::size_t m) {
  return implementation_->take_turn([&] { return implementation_->remove(points, m); });
}

Changes DynamicTriangulation::move(const std::int32_t* points, const double* coordinates, std::size_t m) {
  return implementation_->take_turn([&] { return implementation_->move(points, coordinates, m); });
}

std::size_t DynamicTriangulation::numbers() const noexcept { return implementation_->points.numbers(); }
std::size_t DynamicTriangulation::point_count() const noexcept { return implementation_->points.count(); }
std::size_t DynamicTriangulation::triangle_count() const noexcept {
  return implementation_->triangles.size() / 3;
}
std::size_t DynamicTriangulation::row_count() const noexcept { return implementation_->triangles.size() / 3; }
bool DynamicTriangulation::has_point(std::size_t number) const noexcept {
  return number < numbers() && implementation_->points.is_alive(static_cast<std::int32_t>(number));
}

std::vector<double> DynamicTriangulation::coordinates() const {
  return implementation_->points.coordinates();
}

TriangleRows DynamicTriangulation::rows() { return {implementation_->triangles, implementation_->neighbors}; }

Triangulation DynamicTriangulation::triangulation() {
  Implementation& self = *implementation_;
  return self.take_turn([&] {
    Triangulation result;
    result.triangles = self.triangles;
    result.neighbors = self.neighbors;
    result.hull = self.hull;
    for (std::size_t t = 0; t < result.triangles.size(); t += 3) {
      const auto row = result.triangles.begin() + static_cast<std::ptrdiff_t>(t);
      const std::ptrdiff_t smallest = std::min_element(row, row + 3) - row;
      std::rotate(row, row + smallest, row + 3);
      const auto own = result.neighbors.begin() + static_cast<std::ptrdiff_t>(t);
      std::rotate(own, own + smallest, own + 3);
    }
    result.representatives = self.points.representatives();
    result.triangle_offsets = {0, result.triangles.size() / 3};
    result.hull_offsets = {0, result.hull.size()};
    result.statistics.points = self.points.count();
    result.statistics.triangles = result.triangles.size() / 3;
    result.statistics.hull_vertices = result.hull.size();
    for (std::size_t i = 0; i < result.representatives.size(); ++i) {
      const std::int32_t v = result.representatives[i];
      result.statistics.duplicates += v >= 0 && static_cast<std::size_t>(v) != i;
    }
    if (self.options.halfedges) geometry::write_halfedges(self.options, result);
    if (!self.options.neighbors) result.neighbors.clear();
    if (self.options.areas) {
      const std::vector<double> all = self.points.coordinates();
      call::write_areas(self.owner->for_host_memory(), {all.data(), nullptr, all.size() / 2}, result);
    }
    return result;
  });
}

LivingConstraints DynamicTriangulation::constraints() { return implementation_->constrained; }

}  // namespace flaunay
