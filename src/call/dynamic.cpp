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
#include "mesh/corners.hpp"
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

// The edges of constraints: per pair of ends the smallest index of a segment that has it.
using Edges = std::unordered_map<std::uint64_t, std::int32_t>;

std::uint64_t edge_between(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}
std::int32_t smaller_end(std::uint64_t edge) { return static_cast<std::int32_t>(edge >> 32); }
std::int32_t larger_end(std::uint64_t edge) { return static_cast<std::int32_t>(edge & 0xffffffff); }

// Sorted by the numbers of their ends.
LivingConstraints listed(const Edges& edges, const std::vector<double>& coordinates) {
  std::vector<std::pair<std::uint64_t, std::int32_t>> sorted(edges.begin(), edges.end());
  std::sort(sorted.begin(), sorted.end());
  const auto place = [&](std::int32_t v) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(v)];
    return std::pair(p[0], p[1]);
  };
  LivingConstraints list;
  for (const auto& [edge, segment] : sorted) {
    std::int32_t a = smaller_end(edge), b = larger_end(edge);
    if (place(b) < place(a)) std::swap(a, b);
    list.edges.insert(list.edges.end(), {a, b});
    list.segments.push_back(segment);
  }
  return list;
}

// Per corner of a triangulation the segment of the edge opposite, or -1.
Ids segments_of_corners(const ConstrainedTriangulation& mesh, const Edges& edges) {
  Ids of_corners(mesh.triangles.size(), -1);
  for (std::size_t c = 0; c < of_corners.size(); ++c) {
    if (mesh.constrained[c] == 0) continue;
    const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
    of_corners[c] = edges.at(edge_between(from, to));
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

  Options plain_options() const {
    Options plain = options;
    plain.neighbors = true;
    plain.halfedges = plain.areas = plain.profile = false;
    return plain;
  }

  void make(const double* coordinates, std::size_t n) {
    choose_engine();
    check_points(coordinates, n);
    points.check_coordinates(coordinates, nullptr, n);
    points.append(coordinates, n);
    triangulate_anew();
  }

  void make(const double* coordinates, std::size_t n, const Constraints& constraints,
            const ConstrainedOptions& wanted) {
    choose_engine();
    check_supported(constraints, wanted);
    check_points(coordinates, n);
    points.check_coordinates(coordinates, nullptr, n);
    ConstrainedOptions all = wanted;
    static_cast<Options&>(all) = plain_options();
    ConstrainedTriangulation fresh = call::constrain_and_leave(*owner, coordinates, {0, n}, constraints, all,
                                                               call::request_of(all, false));
    points.append(coordinates, n);
    const std::size_t added = fresh.added_points.size() / 2;
    points.check_coordinates(fresh.added_points.data(), nullptr, added);
    points.append(fresh.added_points.data(), added);
    is_constrained = true;
    adopt(points.living(), std::move(fresh));
  }

  // Triangulates all points. If it throws, nothing has changed.
  void triangulate_anew() {
    updates::Living living = points.living();
    const std::size_t n = points.count();
    const double* const coordinates =
        living.are_all ? points.coordinates().data() : living.coordinates.data();
    ConstrainedOptions all;
    static_cast<Options&>(all) = plain_options();
    ConstrainedTriangulation fresh;
    if (edges.empty()) {
      static_cast<Triangulation&>(fresh) = call::triangulate(*owner, {coordinates, nullptr, n}, {0, n}, all);
    } else {
      LivingConstraints old = listed(edges, points.coordinates());
      if (!living.are_all) {
        for (std::int32_t& v : old.edges) v = living.places[v];
      }
      Constraints constraints;
      constraints.segments = old.edges.data();
      constraints.segment_count = old.segments.size();
      fresh = call::constrain_and_leave(*owner, coordinates, {0, n}, constraints, all,
                                        call::request_of(all, false));
      for (std::int32_t& edge : fresh.edge_segments) edge = old.segments[edge];
    }
    adopt(living, std::move(fresh));
  }

  // Takes a triangulation of all points as what there is, until a batch changes it. If this throws, nothing
  // has changed.
  void adopt(const updates::Living& living, ConstrainedTriangulation fresh) {
    if (!living.are_all) {
      for (Ids* vertices : {&fresh.triangles, &fresh.hull, &fresh.constraint_edges}) {
        for (std::int32_t& v : *vertices) v = living.numbers[v];
      }
    }
    Edges fresh_edges(fresh.edge_segments.size());
    for (std::size_t e = 0; e < fresh.edge_segments.size(); ++e) {
      fresh_edges.emplace(edge_between(fresh.constraint_edges[2 * e], fresh.constraint_edges[2 * e + 1]),
                          fresh.edge_segments[e]);
    }
    std::vector<std::uint8_t> are_ends(is_constrained ? points.numbers() : 0, 0);
    for (const std::int32_t v : fresh.constraint_edges) are_ends[v] = 1;
    points.set_representatives(living, fresh.representatives);
    // From here on nothing throws.
    edges.swap(fresh_edges);
    on_constraint.swap(are_ends);
    made = std::move(fresh);
    triangle_count = made.triangles.size() / 3;
    row_count = triangle_count == 0 ? 0 : triangle_count + made.hull.size();
    is_loaded = is_lost = false;
  }

  // Brings what was triangulated anew to the memory of the engine, where batches change it.
  void load() {
    mesh->load(points.coordinates(), points.shift(), made,
               edges.empty() ? Ids() : segments_of_corners(made, edges));
    made = {};
    is_loaded = true;
  }

  // After an error in the middle of a batch, points and constraints are as they were before, but rows are
  // not.
  void recover() {
    if (is_lost) triangulate_anew();
  }

  // What a batch is to do with the mesh. Points leave their old places before others come.
  struct Batch {
    Ids removed, moved, inserted;
    bool moves_many = false;
  };

  // Changes the mesh, of points that are where they are to be. Returns whether it could.
  bool change(Batch batch, std::vector<updates::SplitEdge>& splits, Changes& changes) {
    if (!mesh->remove(batch.removed)) return false;
    std::optional<Ids> out = mesh->move(std::move(batch.moved), points.coordinates(), batch.moves_many);
    if (!out) return false;
    batch.inserted.insert(batch.inserted.end(), out->begin(), out->end());
    auto found = mesh->insert(std::move(batch.inserted), points.coordinates(), splits);
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
      mesh->insert(coming, points.coordinates(), splits);
    }
    mesh->end_batch(changes);
    mesh->update_hints(points.coordinates(), [&](std::size_t n) { return points.sample(n); });
    return true;
  }

  // Edges of constraints after these splits, of which some are of parts that others have made.
  void split_edges(const std::vector<updates::SplitEdge>& splits) {
    if (!is_constrained) return;
    std::unordered_map<std::uint64_t, std::int32_t> vertex_on;
    for (const auto& [from, to, vertex] : splits) vertex_on.emplace(edge_between(from, to), vertex);
    Edges parts;
    std::vector<std::uint64_t> gone, waiting;
    for (const auto& [from, to, vertex] : splits) {
      const auto whole = edges.find(edge_between(from, to));
      if (whole == edges.end()) continue;
      gone.push_back(whole->first);
      waiting.push_back(whole->first);
      while (!waiting.empty()) {
        const std::uint64_t edge = waiting.back();
        waiting.pop_back();
        if (const auto at = vertex_on.find(edge); at != vertex_on.end()) {
          for (const std::int32_t end : {smaller_end(edge), larger_end(edge)}) {
            waiting.push_back(edge_between(end, at->second));
          }
        } else {
          parts.emplace(edge, whole->second);
        }
      }
    }
    on_constraint.resize(points.numbers(), 0);
    edges.reserve(edges.size() + parts.size());
    // From here on nothing throws.
    for (const auto& split : splits) on_constraint[split.vertex] = 1;
    for (const std::uint64_t edge : gone) edges.erase(edge);
    edges.merge(parts);
  }

  static std::size_t share(std::size_t percent, std::size_t n) { return n * percent / 100; }

  Ids old_triangles() {
    if (is_loaded) {
      const call::Frame frame(*engine);
      return mesh->old_triangles();
    }
    Ids all(triangle_count);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  // Changes the mesh, or triangulates all points with their constraints anew. prepare() changes the points.
  template <typename Prepare>
  void update(bool is_large, const Prepare& prepare, Changes& changes) {
    const bool may_change = !is_large && !is_lost && triangle_count > 0 &&
                            !(is_loaded && (mesh->must_be_loaded() || mesh->shift() != points.shift()));
    if (may_change) {
      const call::Frame frame(*engine);
      if (!is_loaded) load();
      mesh->begin_batch();
      std::vector<updates::SplitEdge> splits;
      if (change(prepare(), splits, changes)) {
        split_edges(splits);
        triangle_count = mesh->triangles();
        row_count = mesh->rows();
        return;
      }
    } else {
      if (is_loaded && !is_lost) mesh->begin_batch();
      prepare();
    }
    changes.removed = old_triangles();
    triangulate_anew();
    changes.made_corners = made.triangles;
    changes.made.resize(triangle_count);
    std::iota(changes.made.begin(), changes.made.end(), 0);
    changes.is_anew = true;
  }

  // A batch. If it throws, points and constraints are what they were before. located: the points whose
  // representatives are told.
  template <typename Prepare>
  Changes run(bool is_large, Ids located, const Prepare& prepare) {
    const double begin = host::now();
    Changes changes;
    changes.first_point = points.numbers();
    points.begin_batch();
    try {
      update(is_large, prepare, changes);
    } catch (...) {
      points.roll_back();
      is_lost = true;
      row_count = triangle_count == 0 ? 0 : 2 * points.places() - 2;  // by Euler's formula, with ghosts
      throw;
    }
    for (std::int32_t& v : located) v = points.representative(v);
    changes.representatives = std::move(located);
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
    if (m == 0) return nothing();
    points.check_coordinates(coordinates, nullptr, m);
    Ids numbers(m);
    std::iota(numbers.begin(), numbers.end(), static_cast<std::int32_t>(points.numbers()));
    const bool is_large = m > share(tuning_of(engine->runtime).inserted_percent, points.count());
    return run(is_large, numbers, [&] {
      points.append(coordinates, m);
      return Batch{{}, {}, numbers, false};
    });
  }

  Changes remove(const std::int32_t* numbers, std::size_t m) {
    check_numbers(numbers, m, "removed");
    if (m == 0) return nothing();
    const bool is_large = m > share(tuning_of(engine->runtime).removed_percent, points.count());
    return run(is_large, {}, [&] {
      Batch batch;
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
    if (m == 0) return nothing();
    points.check_coordinates(coordinates, numbers, m);
    const bool moves_many = m > 1 && m > share(tuning_of(engine->runtime).moved_percent, points.count());
    const bool is_large = moves_many && unmended_left > 0;
    Changes changes = run(is_large, Ids(numbers, numbers + m), [&] {
      Batch batch;
      batch.moves_many = moves_many;
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
    if (is_large) {
      --unmended_left;
    } else if (moves_many) {
      unmended_left = unmended = changes.is_anew ? std::min(2 * unmended + 1, kMostUnmended) : 0;
    }
    return changes;
  }

  Changes nothing() const {
    Changes changes;
    changes.first_point = points.numbers();
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
      const auto [ends, segments] = listed(edges, points.coordinates());
      const auto at = static_cast<std::size_t>(std::find(ends.begin(), ends.end(), v) - ends.begin());
      throw Error(ErrorKind::input,
                  fmt::format("point {} cannot be {}: it is on segment {} ({} to {})", v, what,
                              segments[at / 2], ends[at & ~std::size_t{1}], ends[at | 1]));
    }
  }

  std::shared_ptr<call::Implementation> owner;
  Options options;
  call::Engine* engine = nullptr;
  updates::Points points;
  bool is_constrained = false;
  Edges edges;
  std::vector<std::uint8_t> on_constraint;  // per number: whether it is a vertex of edges
  // The triangles: until a batch changes them, those that all points were triangulated to, with a row for
  // each edge of the hull behind them; then those of the mesh. None if an error has come in between.
  ConstrainedTriangulation made;
  std::optional<updates::Mesh> mesh;
  bool is_loaded = false, is_lost = false;
  std::size_t triangle_count = 0, row_count = 0;
  // After a batch that moved many points and could not mend the mesh, so many like it do not try: each time
  // twice as many. An attempt takes half as long as triangulating anew.
  static constexpr std::size_t kMostUnmended = 31;
  std::size_t unmended = 0, unmended_left = 0;
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
std::size_t DynamicTriangulation::triangle_count() const noexcept { return implementation_->triangle_count; }
std::size_t DynamicTriangulation::row_count() const noexcept { return implementation_->row_count; }
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
    self.recover();
    if (!self.is_loaded) {
      result = {self.made.triangles, self.made.neighbors};
      result.triangles.resize(3 * self.row_count, -1);
      result.neighbors.resize(3 * self.row_count, -1);
      return result;
    }
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
    self.recover();
    if (!self.is_loaded) {
      result.triangles = self.made.triangles;
      result.neighbors = self.made.neighbors;
      result.hull = self.made.hull;
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
  return implementation_->take_turn(
      [&] { return listed(implementation_->edges, implementation_->points.coordinates()); });
}

}  // namespace flaunay
