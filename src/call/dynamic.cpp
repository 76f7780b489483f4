// The public class DynamicTriangulation: checks arguments and keeps account of points.
#include "flaunay/dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "call/constrained.hpp"
#include "call/frame.hpp"
#include "call/triangulate.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "refinement/codes.h"
#include "tuning/tuning.hpp"
#include "updates/codes.h"
#include "updates/edges.hpp"
#include "updates/mesh.hpp"
#include "updates/points.hpp"
#include "updates/rows.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

// Throws for options that a triangulation that changes does not support.
void check_supported(const Constraints& constraints, const ConstrainedOptions& options) {
  call::expect(options.outside == Outside::keep && constraints.hole_count == 0,
               "nothing can be left out of a triangulation that changes");
  call::expect(!options.labels && constraints.seed_count == 0 && constraints.rings.segment_offsets.empty(),
               "a triangulation that changes has no labels, seeds and rings");
  call::expect(!options.refinement.is_wanted(), "a triangulation that changes cannot be refined");
  call::expect(constraints.segment_markers == nullptr && constraints.point_markers == nullptr,
               "a triangulation that changes has no markers");
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
      LivingConstraints old = edges.listed(points.coordinates());
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
    updates::ConstraintEdges fresh_edges;
    if (is_constrained) fresh_edges = updates::ConstraintEdges(fresh, points.numbers());
    points.set_representatives(living, fresh.representatives);
    // From here on nothing throws.
    std::swap(edges, fresh_edges);
    made = std::move(fresh);
    triangle_count = made.triangles.size() / 3;
    row_count = triangle_count == 0 ? 0 : triangle_count + made.hull.size();
    is_loaded = is_lost = false;
  }

  // Brings what was triangulated anew to the memory of the engine, where batches change it.
  void load() {
    mesh->load(points.coordinates(), points.shift(), made, edges.segments_of_corners(made));
    made = {};
    is_loaded = true;
  }

  // After an error in the middle of a batch, points and constraints are as they were before, but rows are
  // not.
  void recover() {
    if (is_lost) triangulate_anew();
  }

  // The changes that a batch makes to the mesh. Points leave their old places before others come.
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
        if (is_constrained) edges.split(splits, points.numbers());
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
  // representatives are returned.
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

  // Points in one place leave in descending order of their numbers. Otherwise a point that leaves, too, would
  // represent the others for a while.
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

  TriangleRows rows() {
    recover();
    if (!is_loaded) {
      TriangleRows result = {made.triangles, made.neighbors};
      result.triangles.resize(3 * row_count, -1);
      result.neighbors.resize(3 * row_count, -1);
      return result;
    }
    const call::Frame frame(*engine);
    return updates::rows_of(mesh->read_rows());
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
      if (!edges.has_end(v)) continue;
      const auto [ends, segments] = edges.listed(points.coordinates());
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
  updates::ConstraintEdges edges;
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
  return implementation_->take_turn([&] { return implementation_->rows(); });
}

void DynamicTriangulation::rows(DeviceRows& result, const Enqueue& enqueue) {
  Implementation& self = *implementation_;
  call::take_turn(*self.owner, enqueue, [&] {
    TriangleRows all = self.rows();
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
      result = updates::triangles_of(self.mesh->read_rows(), self.points.coordinates());
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
      [&] { return implementation_->edges.listed(implementation_->points.coordinates()); });
}

}  // namespace flaunay
