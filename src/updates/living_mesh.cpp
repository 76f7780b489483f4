#include "updates/living_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "geometry/arguments.hpp"
#include "host/clock.hpp"
#include "tuning/tuning.hpp"
#include "updates/rows.hpp"

namespace flaunay::updates {
namespace {

std::size_t share(std::size_t percent, std::size_t n) { return n * percent / 100; }

}  // namespace

void LivingMesh::make(const double* coordinates, std::size_t n) {
  check_points(coordinates, n);
  points_.check_coordinates(coordinates, nullptr, n);
  points_.append(coordinates, n);
  triangulate_anew();
}

void LivingMesh::make_constrained(const double* coordinates, std::size_t n,
                                  const std::function<ConstrainedTriangulation()>& triangulate) {
  check_points(coordinates, n);
  points_.check_coordinates(coordinates, nullptr, n);
  ConstrainedTriangulation fresh = triangulate();
  points_.append(coordinates, n);
  const std::size_t added = fresh.added_points.size() / 2;
  points_.check_coordinates(fresh.added_points.data(), nullptr, added);
  points_.append(fresh.added_points.data(), added);
  is_constrained_ = true;
  adopt(points_.living(), std::move(fresh));
}

// Triangulates all points. If it throws, nothing has changed.
void LivingMesh::triangulate_anew() {
  const Living living = points_.living();
  LivingConstraints old = edges_.listed(points_.coordinates());
  if (!living.are_all) {
    for (std::int32_t& v : old.edges) v = living.places[v];
  }
  Constraints constraints;
  constraints.segments = old.edges.data();
  constraints.segment_count = old.segments.size();
  ConstrainedTriangulation fresh =
      anew_.triangulate(living.are_all ? points_.coordinates().data() : living.coordinates.data(),
                        points_.count(), constraints);
  for (std::int32_t& edge : fresh.edge_segments) edge = old.segments[edge];
  adopt(living, std::move(fresh));
}

// Takes a triangulation of all points as what there is, until a batch changes it. If this throws, nothing
// has changed.
void LivingMesh::adopt(const Living& living, ConstrainedTriangulation fresh) {
  if (!living.are_all) {
    for (Ids* vertices : {&fresh.triangles, &fresh.hull, &fresh.constraint_edges}) {
      for (std::int32_t& v : *vertices) v = living.numbers[v];
    }
  }
  ConstraintEdges fresh_edges;
  if (is_constrained_) fresh_edges = ConstraintEdges(fresh, points_.numbers());
  points_.set_representatives(living, fresh.representatives);
  // From here on nothing throws.
  std::swap(edges_, fresh_edges);
  made_ = std::move(fresh);
  triangle_count_ = made_.triangles.size() / 3;
  row_count_ = triangle_count_ == 0 ? 0 : triangle_count_ + made_.hull.size();
  is_loaded_ = is_lost_ = false;
}

// Brings what was triangulated anew to the memory of the engine, where batches change it.
void LivingMesh::load() {
  mesh_.load(points_.coordinates(), points_.shift(), made_, edges_.segments_of_corners(made_));
  made_ = {};
  is_loaded_ = true;
}

// After an error in the middle of a batch, points and constraints are as they were before, but rows are
// not.
void LivingMesh::recover() {
  if (is_lost_) triangulate_anew();
}

// Changes the mesh, of points that are where they are to be. Returns whether it could.
bool LivingMesh::change(Batch batch, std::vector<SplitEdge>& splits, Changes& changes) {
  if (!mesh_.remove(batch.removed)) return false;
  std::optional<Ids> out = mesh_.move(std::move(batch.moved), points_.coordinates(), batch.moves_many);
  if (!out) return false;
  batch.inserted.insert(batch.inserted.end(), out->begin(), out->end());
  auto found = mesh_.insert(std::move(batch.inserted), points_.coordinates(), splits);
  // Points with smaller numbers take the places of others.
  Ids leaving, coming;
  for (const auto& [v, other] : found) {
    const std::int32_t representative = points_.representative(other);
    if (v > representative) {
      points_.join(v, representative);
    } else {
      leaving.push_back(representative);
      coming.push_back(v);
      points_.join(representative, v);
    }
  }
  if (!leaving.empty()) {
    Changes so_far;
    mesh_.end_batch(so_far);  // counts the triangles, of which some must be left
    if (is_constrained_ || !mesh_.remove(leaving)) return false;
    mesh_.insert(coming, points_.coordinates(), splits);
  }
  mesh_.end_batch(changes);
  mesh_.update_hints(points_.coordinates(), [&](std::size_t n) { return points_.sample(n); });
  return true;
}

Ids LivingMesh::old_triangles() {
  if (is_loaded_) {
    const auto call = anew_.begin_call();
    return mesh_.old_triangles();
  }
  Ids all(triangle_count_);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// Whether a batch changes the mesh; otherwise all points are triangulated anew.
bool LivingMesh::may_change(bool is_large) const {
  return !is_large && !is_lost_ && triangle_count_ > 0 &&
         !(is_loaded_ && (mesh_.must_be_loaded() || mesh_.shift() != points_.shift()));
}

// Changes the mesh in a call, or without one triangulates all points with their constraints anew. prepare()
// changes the points.
template <typename Prepare>
void LivingMesh::update(std::shared_ptr<void> call, const Prepare& prepare, Changes& changes) {
  if (call) {
    if (!is_loaded_) load();
    mesh_.begin_batch();
    std::vector<SplitEdge> splits;
    if (change(prepare(), splits, changes)) {
      if (is_constrained_) edges_.split(splits, points_.numbers());
      triangle_count_ = mesh_.triangles();
      row_count_ = mesh_.rows();
      return;
    }
    call.reset();
  } else {
    if (is_loaded_ && !is_lost_) mesh_.begin_batch();
    prepare();
  }
  changes.removed = old_triangles();
  triangulate_anew();
  changes.made_corners = made_.triangles;
  changes.made.resize(triangle_count_);
  std::iota(changes.made.begin(), changes.made.end(), 0);
  changes.is_anew = true;
}

// A batch. If it throws, points and constraints are what they were before. located: the points whose
// representatives are returned.
template <typename Prepare>
Changes LivingMesh::run(bool is_large, Ids located, const Prepare& prepare) {
  const double begin = host::now();
  Changes changes;
  changes.first_point = points_.numbers();
  // A call that cannot begin has changed nothing.
  std::shared_ptr<void> call = may_change(is_large) ? anew_.begin_call() : nullptr;
  points_.begin_batch();
  try {
    update(std::move(call), prepare, changes);
  } catch (...) {
    points_.roll_back();
    is_lost_ = true;
    row_count_ = triangle_count_ == 0 ? 0 : 2 * points_.places() - 2;  // by Euler's formula, with ghosts
    throw;
  }
  for (std::int32_t& v : located) v = points_.representative(v);
  changes.representatives = std::move(located);
  changes.seconds = host::now() - begin;
  return changes;
}

// Points in one place leave in descending order of their numbers. Otherwise a point that leaves, too, would
// represent the others for a while.
std::vector<std::size_t> LivingMesh::order_of_leaving(const std::int32_t* numbers, std::size_t m) const {
  std::vector<std::size_t> order(m);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (points_.share_places()) {
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return numbers[a] > numbers[b]; });
  }
  return order;
}

// Takes a point from its place, for good or for another place.
void LivingMesh::leave(std::int32_t v, Batch& batch) {
  const bool is_vertex = points_.representative(v) == v;
  const std::int32_t next = points_.leave(v);
  if (!is_vertex) return;
  batch.removed.push_back(v);
  if (next >= 0) batch.inserted.push_back(next);
}

Changes LivingMesh::insert(const double* coordinates, std::size_t m) {
  check_points(coordinates, m);
  check_count(points_.numbers() + m, "points_ that have been inserted", kMostPointsAtOnce);
  if (m == 0) return nothing();
  points_.check_coordinates(coordinates, nullptr, m);
  Ids numbers(m);
  std::iota(numbers.begin(), numbers.end(), static_cast<std::int32_t>(points_.numbers()));
  const bool is_large = m > share(tuning_of(runtime_).inserted_percent, points_.count());
  return run(is_large, numbers, [&] {
    points_.append(coordinates, m);
    return Batch{{}, {}, numbers, false};
  });
}

Changes LivingMesh::remove(const std::int32_t* numbers, std::size_t m) {
  check_numbers(numbers, m, "removed");
  if (m == 0) return nothing();
  const bool is_large = m > share(tuning_of(runtime_).removed_percent, points_.count());
  return run(is_large, {}, [&] {
    Batch batch;
    for (const std::size_t i : order_of_leaving(numbers, m)) {
      leave(numbers[i], batch);
      points_.remove(numbers[i]);
    }
    return batch;
  });
}

Changes LivingMesh::move(const std::int32_t* numbers, const double* coordinates, std::size_t m) {
  check_numbers(numbers, m, "moved");
  check_points(coordinates, m);
  if (m == 0) return nothing();
  points_.check_coordinates(coordinates, numbers, m);
  const bool moves_many = m > 1 && m > share(tuning_of(runtime_).moved_percent, points_.count());
  const bool is_large = moves_many && unmended_left_ > 0;
  Changes changes = run(is_large, Ids(numbers, numbers + m), [&] {
    Batch batch;
    batch.moves_many = moves_many;
    Ids coming;
    for (const std::size_t i : order_of_leaving(numbers, m)) {
      const std::int32_t v = numbers[i];
      if (points_.is_alone(v)) {
        batch.moved.push_back(v);
      } else {
        leave(v, batch);
        coming.push_back(v);
      }
      points_.move(v, coordinates + 2 * i);
    }
    batch.inserted.insert(batch.inserted.end(), coming.begin(), coming.end());
    return batch;
  });
  if (is_large) {
    --unmended_left_;
  } else if (moves_many) {
    unmended_left_ = unmended_ = changes.is_anew ? std::min(2 * unmended_ + 1, kMostUnmended) : 0;
  }
  return changes;
}

TriangleRows LivingMesh::rows() {
  recover();
  if (!is_loaded_) {
    TriangleRows result = {made_.triangles, made_.neighbors};
    result.triangles.resize(3 * row_count_, -1);
    result.neighbors.resize(3 * row_count_, -1);
    return result;
  }
  const auto call = anew_.begin_call();
  return rows_of(mesh_.read_rows());
}

Changes LivingMesh::nothing() const {
  Changes changes;
  changes.first_point = points_.numbers();
  return changes;
}

// Throws unless these are living points, each once, that may leave their places.
void LivingMesh::check_numbers(const std::int32_t* numbers, std::size_t m, const char* what) {
  check_array(numbers, m, "numbers of points_");
  const std::size_t bad = points_.mark(numbers, m);
  if (bad < m) {
    const std::int32_t v = numbers[bad];
    const bool is_known = v >= 0 && static_cast<std::size_t>(v) < points_.numbers();
    throw Error(ErrorKind::input, fmt::format("entry {} of the batch is point {}, which {}", bad, v,
                                              !is_known             ? "does not exist"
                                              : points_.is_alive(v) ? "is there twice"
                                                                    : "was removed before"));
  }
  if (!is_constrained_) return;
  for (std::size_t i = 0; i < m; ++i) {
    const std::int32_t v = numbers[i];
    if (!edges_.has_end(v)) continue;
    const auto [ends, segments] = edges_.listed(points_.coordinates());
    const auto at = static_cast<std::size_t>(std::find(ends.begin(), ends.end(), v) - ends.begin());
    throw Error(ErrorKind::input,
                fmt::format("point {} cannot be {}: it is on segment {} ({} to {})", v, what,
                            segments[at / 2], ends[at & ~std::size_t{1}], ends[at | 1]));
  }
}

Triangulation LivingMesh::triangulation() {
  Triangulation result;
  recover();
  if (is_loaded_) {
    const auto call = anew_.begin_call();
    result = triangles_of(mesh_.read_rows(), points_.coordinates());
  } else {
    result.triangles = made_.triangles;
    result.neighbors = made_.neighbors;
    result.hull = made_.hull;
  }
  result.representatives = points_.representatives();
  return result;
}

}  // namespace flaunay::updates
