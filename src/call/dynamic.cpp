// The public class DynamicTriangulation: what is asked for is checked here, and points are accounted for.
#include "flaunay/dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "call/areas.hpp"
#include "call/constrained.hpp"
#include "call/frame.hpp"
#include "call/triangulate.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "refinement/codes.h"
#include "tuning/tuning.hpp"
#include "updates/codes.h"
#include "updates/mesh.hpp"
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

bool is_triangle(const kernel::mesh_row& row) {
  return row.corner[0] >= 0 && row.corner[1] >= 0 && row.corner[2] >= 0;
}

// The hull from its lexicographically smallest vertex on. A ghost has its edge between its other corners.
Ids hull_of(const std::vector<kernel::mesh_row>& rows, const std::vector<double>& coordinates) {
  const auto end_of = [](const kernel::mesh_row& row) {
    return static_cast<std::size_t>(std::find(row.corner, row.corner + 3, kernel::INFINITE_VERTEX) -
                                    row.corner);
  };
  const auto place = [&](std::int32_t v) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(v)];
    return std::pair(p[0], p[1]);
  };
  std::size_t first = rows.size();
  const auto from = [&](std::size_t t) { return rows[t].corner[(end_of(rows[t]) + 2) % 3]; };
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (rows[t].corner[0] == kernel::NO_TRIANGLE || is_triangle(rows[t])) continue;
    if (first == rows.size() || place(from(t)) < place(from(first))) first = t;
  }
  Ids hull;
  std::size_t at = first;
  do {
    hull.push_back(from(at));
    at = static_cast<std::size_t>(rows[at].neighbor[(end_of(rows[at]) + 2) % 3]);
  } while (at != first);
  return hull;
}

// The edges of constraints in the rows of a mesh, each once.
LivingConstraints constraints_in(const std::vector<kernel::mesh_row>& rows,
                                 const std::vector<double>& coordinates) {
  LivingConstraints found;
  const auto place = [&](std::int32_t v) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(v)];
    return std::pair(p[0], p[1]);
  };
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (!is_triangle(rows[t])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto beyond = static_cast<std::size_t>(rows[t].neighbor[k]);
      if (rows[t].edge[k] < 0 || (beyond < t && is_triangle(rows[beyond]))) continue;
      std::int32_t a = rows[t].corner[(k + 1) % 3], b = rows[t].corner[(k + 2) % 3];
      if (place(b) < place(a)) std::swap(a, b);
      found.edges.insert(found.edges.end(), {a, b});
      found.segments.push_back(rows[t].edge[k]);
    }
  }
  return found;
}

// Per corner of a triangulation the segment of the edge opposite, or -1.
Ids segments_of_corners(const ConstrainedTriangulation& mesh) {
  const auto key = [](std::int32_t a, std::int32_t b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
  };
  std::unordered_map<std::uint64_t, std::int32_t> segments(mesh.edge_segments.size());
  for (std::size_t e = 0; e < mesh.edge_segments.size(); ++e) {
    segments.emplace(key(mesh.constraint_edges[2 * e], mesh.constraint_edges[2 * e + 1]),
                     mesh.edge_segments[e]);
  }
  Ids of_corners(mesh.triangles.size(), -1);
  for (std::size_t c = 0; c < of_corners.size(); ++c) {
    if (mesh.constrained[c] == 0) continue;
    const std::size_t first = c - c % 3;
    of_corners[c] =
        segments.at(key(mesh.triangles[first + (c + 1) % 3], mesh.triangles[first + (c + 2) % 3]));
  }
  return of_corners;
}

}  // namespace

struct DynamicTriangulation::Implementation {
  Implementation(Triangulator& triangulator, const Options& wanted)
      : owner(TriangulatorAccess::shared(triangulator)), options(wanted) {}

  template <typename Work>
  auto take_turn(const Work& work) {
    return call::take_turn(*owner, work);
  }

  // Where the mesh is.
  void choose_engine() {
    engine = &owner->with_doubles(owner->for_host_memory());
    mesh.emplace(engine->runtime);
  }

  void make(const double* coordinates, std::size_t n) {
    choose_engine();
    check_points(coordinates, n);
    points.check_coordinates(coordinates, nullptr, n);
    points.append(coordinates, n);
    triangulate_anew({});
  }

  void make(const double* coordinates, std::size_t n, const Constraints& constraints,
            const ConstrainedOptions& wanted) {
    choose_engine();
    check_supported(constraints, wanted);
    check_points(coordinates, n);
    points.check_coordinates(coordinates, nullptr, n);
    ConstrainedOptions all = wanted;
    all.neighbors = true;
    const ConstrainedTriangulation made = call::constrain_and_leave(*owner, coordinates, {0, n}, constraints,
                                                                    all, call::request_of(all, false));
    points.append(coordinates, n);
    const std::size_t added = made.added_points.size() / 2;
    points.check_coordinates(made.added_points.data(), nullptr, added);
    points.append(made.added_points.data(), added);
    is_constrained = true;
    triangulate_anew({made.constraint_edges, made.edge_segments});
  }

  // Triangulates all points, with these edges. Returns the corners of rows, all of which have triangles.
  Ids triangulate_anew(const LivingConstraints& edges) {
    const updates::Living living = points.living();
    const std::size_t n = points.count();
    const double* const coordinates = living.coordinates.data();
    Options plain = options;
    plain.neighbors = true;
    plain.halfedges = plain.areas = plain.profile = false;
    ConstrainedTriangulation made;
    Ids of_corners;
    if (edges.segments.empty()) {
      static_cast<Triangulation&>(made) = call::triangulate(
          *owner, {living.are_all ? points.coordinates().data() : coordinates, nullptr, n}, {0, n}, plain);
    } else {
      Ids segments = edges.edges;
      if (!living.are_all) {
        for (std::int32_t& v : segments) v = living.places[v];
      }
      Constraints constraints;
      constraints.segments = segments.data();
      constraints.segment_count = segments.size() / 2;
      ConstrainedOptions all;
      static_cast<Options&>(all) = plain;
      made = call::constrain_and_leave(*owner, living.are_all ? points.coordinates().data() : coordinates,
                                       {0, n}, constraints, all, call::request_of(all, false));
      for (std::int32_t& edge : made.edge_segments) edge = edges.segments[edge];
      of_corners = segments_of_corners(made);
    }
    if (!living.are_all) {
      for (Ids* vertices : {&made.triangles, &made.hull, &made.constraint_edges}) {
        for (std::int32_t& v : *vertices) v = living.numbers[v];
      }
    }
    points.set_representatives(living, made.representatives);
    on_constraint.assign(points.numbers(), 0);
    for (const std::int32_t v : made.constraint_edges) on_constraint[v] = 1;
    flat_hull = made.triangles.empty() ? made.hull : Ids();
    flat_edges = {};
    if (made.triangles.empty()) flat_edges = {made.constraint_edges, made.edge_segments};
    const call::Frame frame(*engine);
    mesh->load(points.coordinates(), points.shift(), made, of_corners);
    return std::move(made.triangles);
  }

  LivingConstraints edges_now() {
    if (!is_constrained) return {};
    if (mesh->triangles() == 0) return flat_edges;
    const call::Frame frame(*engine);
    return constraints_in(mesh->read_rows(), points.coordinates());
  }

  // What a batch is to do with the mesh. Points leave their old places before others come.
  struct Batch {
    Ids removed, moved, inserted;
    bool is_large = false;
  };

  // Changes the mesh, of points that are where they are to be. Returns whether it could.
  bool change(Batch batch, Changes& changes) {
    if (!mesh->remove(batch.removed)) return false;
    const std::size_t most = share(tuning_of(engine->runtime).removed_percent, mesh->triangles() / 2);
    std::optional<Ids> out = mesh->move(std::move(batch.moved), points.coordinates(), most);
    if (!out) return false;
    batch.inserted.insert(batch.inserted.end(), out->begin(), out->end());
    Ids split;
    auto found = mesh->insert(std::move(batch.inserted), points.coordinates(), split);
    // Points with smaller numbers take the places of others.
    Ids leaving, coming;
    for (const auto& [v, other] : found) {
      const std::int32_t representative = points.representative(other);
      if (v > representative) {
        points.join(v, representative);
      } else {
        leaving.push_back(representative);
        coming.push_back(v);
        points.join(representative, v);
      }
    }
    if (!leaving.empty()) {
      Changes so_far;
      mesh->end_batch(so_far);  // counts the triangles, of which some must be left
      if (is_constrained || !mesh->remove(leaving)) return false;
      mesh->insert(coming, points.coordinates(), split);
    }
    if (is_constrained) {
      on_constraint.resize(points.numbers(), 0);
      for (const std::int32_t v : split) on_constraint[v] = 1;
    }
    mesh->end_batch(changes);
    mesh->update_hints(points.coordinates(), [&](std::size_t n) { return points.sample(n); });
    return true;
  }

  static std::size_t share(std::size_t percent, std::size_t n) { return n * percent / 100; }

  void update(Batch batch, Changes& changes) {
    bool is_done = false;
    {
      const call::Frame frame(*engine);
      mesh->begin_batch();
      if (!mesh->must_be_loaded() && mesh->shift() == points.shift() && !batch.is_large) {
        is_done = change(std::move(batch), changes);
      }
      if (!is_done) changes.removed = mesh->old_triangles();
    }
    if (is_done) return;
    changes.made_corners = triangulate_anew(edges_now());
    changes.made.resize(mesh->triangles());
    std::iota(changes.made.begin(), changes.made.end(), 0);
    changes.is_anew = true;
  }

  // A batch of m points.
  template <typename Prepare>
  Changes run(std::size_t m, const Prepare& prepare) {
    const double begin = host::now();
    Changes changes;
    changes.first_point = points.numbers();
    if (m == 0) return changes;
    update(prepare(), changes);
    changes.seconds = host::now() - begin;
    return changes;
  }

  // Of points in one place, those with larger numbers leave first: then nobody takes it over who leaves, too.
  std::vector<std::size_t> order_of_leaving(const std::int32_t* numbers, std::size_t m) const {
    std::vector<std::size_t> order(m);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (points.share_places()) {
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return numbers[a] > numbers[b]; });
    }
    return order;
  }

  // Takes a point from its place, for good or for another place.
  void leave(std::int32_t v, Batch& batch) {
    const bool is_vertex = points.representative(v) == v;
    const std::int32_t next = points.leave(v);
    if (!is_vertex) return;
    batch.removed.push_back(v);
    if (next >= 0) batch.inserted.push_back(next);
  }

  Changes insert(const double* coordinates, std::size_t m) {
    check_points(coordinates, m);
    check_count(points.numbers() + m, "points that have been inserted", kMostPointsAtOnce);
    Changes changes = run(m, [&] {
      points.check_coordinates(coordinates, nullptr, m);
      Batch batch;
      batch.is_large = m > share(tuning_of(engine->runtime).inserted_percent, points.count());
      const std::size_t first = points.numbers();
      points.append(coordinates, m);
      batch.inserted.resize(m);
      std::iota(batch.inserted.begin(), batch.inserted.end(), static_cast<std::int32_t>(first));
      return batch;
    });
    changes.representatives.reserve(m);
    for (std::size_t i = 0; i < m; ++i) {
      changes.representatives.push_back(
          points.representative(static_cast<std::int32_t>(changes.first_point + i)));
    }
    return changes;
  }

  Changes remove(const std::int32_t* numbers, std::size_t m) {
    check_numbers(numbers, m, "removed");
    return run(m, [&] {
      Batch batch;
      batch.is_large = m > share(tuning_of(engine->runtime).removed_percent, points.count());
      for (const std::size_t i : order_of_leaving(numbers, m)) {
        leave(numbers[i], batch);
        points.remove(numbers[i]);
      }
      return batch;
    });
  }

  Changes move(const std::int32_t* numbers, const double* coordinates, std::size_t m) {
    check_numbers(numbers, m, "moved");
    check_points(coordinates, m);
    Changes changes = run(m, [&] {
      points.check_coordinates(coordinates, numbers, m);
      Batch batch;
      Ids coming;
      for (const std::size_t i : order_of_leaving(numbers, m)) {
        const std::int32_t v = numbers[i];
        if (points.is_alone(v)) {
          batch.moved.push_back(v);
        } else {
          leave(v, batch);
          coming.push_back(v);
        }
        points.move(v, coordinates + 2 * i);
      }
      batch.inserted.insert(batch.inserted.end(), coming.begin(), coming.end());
      return batch;
    });
    changes.representatives.reserve(m);
    for (std::size_t i = 0; i < m; ++i) changes.representatives.push_back(points.representative(numbers[i]));
    return changes;
  }

  // Throws unless these are living points, each once, that may leave their places.
  void check_numbers(const std::int32_t* numbers, std::size_t m, const char* what) {
    check_array(numbers, m, "numbers of points");
    const std::size_t bad = points.mark(numbers, m);
    if (bad < m) {
      const std::int32_t v = numbers[bad];
      const bool is_known = v >= 0 && static_cast<std::size_t>(v) < points.numbers();
      throw Error(ErrorKind::input, fmt::format("entry {} of the batch is point {}, which {}", bad, v,
                                                !is_known            ? "does not exist"
                                                : points.is_alive(v) ? "is there twice"
                                                                     : "was removed before"));
    }
    if (!is_constrained) return;
    for (std::size_t i = 0; i < m; ++i) {
      const std::int32_t v = numbers[i];
      if (on_constraint[v] == 0) continue;
      const LivingConstraints edges = edges_now();
      const auto at = static_cast<std::size_t>(std::find(edges.edges.begin(), edges.edges.end(), v) -
                                               edges.edges.begin());
      throw Error(ErrorKind::input, fmt::format("point {} cannot be {}: it is on segment {} ({} to {})", v,
                                                what, edges.segments[at / 2],
                                                edges.edges[at & ~std::size_t{1}], edges.edges[at | 1]));
    }
  }

  std::shared_ptr<call::Implementation> owner;
  Options options;
  call::Engine* engine = nullptr;
  updates::Points points;
  std::optional<updates::Mesh> mesh;
  bool is_constrained = false;
  std::vector<std::uint8_t> on_constraint;  // per number, if there are constraints
  // If all points are on one line: as in Triangulation::hull, and the edges of constraints.
  Ids flat_hull;
  LivingConstraints flat_edges;
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
  return implementation_->mesh->triangles();
}
std::size_t DynamicTriangulation::row_count() const noexcept { return implementation_->mesh->rows(); }
bool DynamicTriangulation::has_point(std::size_t number) const noexcept {
  return number < numbers() && implementation_->points.is_alive(static_cast<std::int32_t>(number));
}

std::vector<double> DynamicTriangulation::coordinates() const {
  return implementation_->points.coordinates();
}

TriangleRows DynamicTriangulation::rows() {
  Implementation& self = *implementation_;
  return self.take_turn([&] {
    TriangleRows result;
    if (self.mesh->rows() == 0) return result;
    const call::Frame frame(*self.engine);
    const std::vector<kernel::mesh_row> rows = self.mesh->read_rows();
    result.triangles.assign(3 * rows.size(), -1);
    result.neighbors.assign(3 * rows.size(), -1);
    for (std::size_t t = 0; t < rows.size(); ++t) {
      if (!is_triangle(rows[t])) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t beyond = rows[t].neighbor[k];
        result.triangles[3 * t + k] = rows[t].corner[k];
        if (is_triangle(rows[static_cast<std::size_t>(beyond)])) result.neighbors[3 * t + k] = beyond;
      }
    }
    return result;
  });
}

void DynamicTriangulation::rows(DeviceRows& result, const Enqueue& enqueue) {
  Implementation& self = *implementation_;
  TriangleRows all = rows();
  call::take_turn(*self.owner, enqueue, [&] {
    std::vector<cl_double> places = self.points.coordinates();
    call::Engine& device = self.owner->on_device();
    call::Frame frame(*self.owner, {device, &device}, enqueue);
    const auto triangles = frame.out<cl_int>(result.triangles, all.triangles.size(), "triangles");
    const auto neighbors = frame.out<cl_int>(result.neighbors, all.neighbors.size(), "neighbors");
    const auto coordinates = frame.out<cl_double>(result.coordinates, places.size(), "coordinates");
    frame.check_distinct();
    frame.begin();
    result.row_count = all.triangles.size() / 3;
    result.numbers = places.size() / 2;
    call::write_result(frame.runtime, triangles, std::move(all.triangles));
    call::write_result(frame.runtime, neighbors, std::move(all.neighbors));
    call::write_result(frame.runtime, coordinates, std::move(places));
    frame.end();
  });
}

Triangulation DynamicTriangulation::triangulation() {
  Implementation& self = *implementation_;
  return self.take_turn([&] {
    Triangulation result;
    if (self.mesh->triangles() == 0) {
      result.hull = self.flat_hull;
    } else {
      const call::Frame frame(*self.engine);
      const std::vector<kernel::mesh_row> rows = self.mesh->read_rows();
      result.hull = hull_of(rows, self.points.coordinates());
      Ids triangle_of(rows.size(), -1);
      std::int32_t count = 0;
      for (std::size_t t = 0; t < rows.size(); ++t) {
        if (is_triangle(rows[t])) triangle_of[t] = count++;
      }
      result.triangles.resize(3 * static_cast<std::size_t>(count));
      result.neighbors.resize(result.triangles.size());
      for (std::size_t t = 0; t < rows.size(); ++t) {
        if (triangle_of[t] < 0) continue;
        const std::int32_t* const corner = rows[t].corner;
        const auto smallest = static_cast<std::size_t>(std::min_element(corner, corner + 3) - corner);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t to = 3 * static_cast<std::size_t>(triangle_of[t]) + k, at = (smallest + k) % 3;
          result.triangles[to] = corner[at];
          result.neighbors[to] = triangle_of[static_cast<std::size_t>(rows[t].neighbor[at])];
        }
      }
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

LivingConstraints DynamicTriangulation::constraints() {
  return implementation_->take_turn([&] { return implementation_->edges_now(); });
}

}  // namespace flaunay
