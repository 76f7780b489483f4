#include "updates/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "geometry/sort.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/updates/insert.cl.hpp"
#include "launchers/updates/move.cl.hpp"
#include "launchers/updates/remove.cl.hpp"
#include "launchers/updates/rows.cl.hpp"
#include "points/download.hpp"
#include "predicates/planar.h"
#include "refinement/codes.h"
#include "refinement/ranks.h"
#include "updates/codes.h"
#include "updates/limits.h"

namespace flaunay::updates {

using host::Arena;
using kernel::double2;
using kernel::mesh_row;
using kernel::placed_vertex;
using kernel::removed_vertex;
using kernel::row_report;
using kernel::star_side;

namespace {

// Their corners are counted by ints.
constexpr std::size_t kMostRows = std::size_t{1} << 29;
Ids counted(std::size_t n) {
  Ids all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

[[noreturn]] void throw_stuck(const char* what) {
  throw Error(ErrorKind::internal, fmt::format("{} wait for each other; please report the input", what));
}

}  // namespace

// ---------------------------------------------------------------------------------------------------------
// Memory

template <typename T>
void Mesh::grow(Buffer<T>& array, std::size_t used, std::size_t size) {
  const Buffer<T> larger(host::allocate_memory(runtime_.memory(), size * sizeof(T)), size);
  if (used > 0) runtime_.copy(array, 0, larger, 0, used);
  array = larger;
}

void Mesh::reserve_rows(std::size_t rows) {
  if (rows <= row_room_) return;
  if (rows > kMostRows) {
    throw Error(ErrorKind::input, fmt::format("the triangulation takes more than {} rows", kMostRows));
  }
  const std::size_t size = std::min(kMostRows, rows + rows / 2 + 64);
  grow(row_array_, std::min(rows_, row_room_), size);
  grow(claims_, 0, size);
  grow(visits_, 0, size);
  row_room_ = size;
  next_claim_ = 0;
}

void Mesh::reserve_vertices(std::size_t vertices) {
  if (vertices > vertex_room_) {
    const std::size_t size = vertices + vertices / 2 + 64;
    grow(points_, std::min(vertices_, vertex_room_), size);
    grow(rows_of_, std::min(vertices_, vertex_room_), size);
    grow(moved_at_, 0, size);
    runtime_.fill(moved_at_, size, cl_int{-1});
    vertex_room_ = size;
  }
  vertices_ = std::max(vertices_, vertices);
}

void Mesh::reserve_touched(std::size_t more) {
  const std::size_t needed = touched_count_ + more;
  if (needed > touched_.size()) grow(touched_, touched_count_, needed + needed / 2);
}

// Claims of later steps are smaller than those before, so that nobody has to clear them.
cl_uint Mesh::take_claims(std::size_t count) {
  if (count >= next_claim_) {
    runtime_.fill(claims_, row_room_, cl_uint{UNCLAIMED_ROW});
    runtime_.fill(visits_, row_room_, cl_uint{UNCLAIMED_ROW});
    next_claim_ = UNCLAIMED_ROW;
  }
  next_claim_ -= static_cast<cl_uint>(count);
  return next_claim_;
}

std::int32_t Mesh::take_row() {
  if (free_rows_.empty()) return static_cast<std::int32_t>(rows_++);
  const std::int32_t row = free_rows_.back();
  free_rows_.pop_back();
  return row;
}

std::vector<double2> Mesh::scaled(const Ids& vertices, const std::vector<double>& coordinates) const {
  std::vector<double2> points(vertices.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(vertices[i])];
    points[i] = {std::ldexp(p[0], shift_) + 0.0, std::ldexp(p[1], shift_) + 0.0};
  }
  return points;
}

// ---------------------------------------------------------------------------------------------------------
// The whole mesh

void Mesh::load(const std::vector<double>& coordinates, int shift, const Triangulation& triangulation,
                const Ids& edges) {
  const std::size_t triangles = triangulation.triangles.size() / 3;
  shift_ = shift;
  triangles_ = triangles;
  has_edges_ = !edges.empty();
  free_rows_.clear();
  touched_count_ = 0;
  rows_ = 0;
  batch_ = 0;
  hints_ = {};
  const std::size_t hull = triangulation.hull.size();
  vertices_ = 0;
  reserve_vertices(coordinates.size() / 2);
  reserve_rows(triangles + hull);
  rows_ = triangles + hull;
  // Natively without a copy.
  const double* places = coordinates.data();
  std::vector<double> moved;
  if (shift != 0) {
    moved.reserve(coordinates.size());
    for (const double x : coordinates) moved.push_back(std::ldexp(x, shift) + 0.0);
    places = moved.data();
  }
  runtime_.write(points_.as<cl_double>(), 0, coordinates.size(), places);

  Arena& arena = runtime_.arena();
  Arena::Scope scope(arena);
  const auto hull_places = arena.allocate<cl_int>(vertices_), inside = arena.allocate<cl_int>(hull);
  const auto hull_here = runtime_.view(triangulation.hull.data(), hull);
  const auto none = arena.allocate<cl_int>(1);
  const auto edges_here = edges.empty() ? none : runtime_.view(edges.data(), edges.size());
  runtime_.map(hull, kernels::number_hull{.hull = hull_here, .places = hull_places});
  runtime_.map(triangles, kernels::load_triangles{
                              .has_edges = !edges.empty(),
                              .triangles = runtime_.view(triangulation.triangles.data(), 3 * triangles),
                              .neighbors = runtime_.view(triangulation.neighbors.data(), 3 * triangles),
                              .edges = edges_here,
                              .places = hull_places,
                              .rows = row_array_,
                              .rows_of = rows_of_,
                              .inside = inside});
  runtime_.map(hull, kernels::load_ghosts{.first = static_cast<int>(triangles),
                                          .has_edges = !edges.empty(),
                                          .hull = hull_here,
                                          .inside = inside,
                                          .edges = edges_here,
                                          .rows = row_array_});
  // Vertices of some triangles, which are all over the plane.
  Ids sample;
  for (std::size_t c = 0; c < triangulation.triangles.size(); c += 6 * kVerticesPerHint) {
    sample.push_back(triangulation.triangles[c]);
  }
  make_hints(coordinates, sample);
  runtime_.finish();
}

void Mesh::make_hints(const std::vector<double>& coordinates, const Ids& vertices) {
  const auto x_of = [&](std::int32_t v) { return coordinates[2 * static_cast<std::size_t>(v)]; };
  const auto y_of = [&](std::int32_t v) { return coordinates[2 * static_cast<std::size_t>(v) + 1]; };
  Ids sample = vertices;
  const std::size_t slabs =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(sample.size()))));
  sample.resize(slabs * slabs, sample.empty() ? 0 : sample.front());
  const auto sort = [](auto begin, auto end, const auto& key) {
    std::sort(begin, end,
              [&](std::int32_t a, std::int32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
  };
  sort(sample.begin(), sample.end(), x_of);
  std::vector<double> xs, ys;
  for (std::size_t s = 0; s < slabs; ++s) {
    const auto begin = sample.begin() + static_cast<std::ptrdiff_t>(s * slabs),
               end = begin + static_cast<std::ptrdiff_t>(slabs);
    xs.push_back(std::ldexp(x_of(*begin), shift_));
    sort(begin, end, y_of);
    for (auto v = begin; v != end; ++v) ys.push_back(std::ldexp(y_of(*v), shift_));
  }
  const auto keep = [&](auto& array, const auto& values) {
    grow(array, 0, values.size());
    runtime_.write(array, 0, values.size(), values.data());
  };
  keep(hints_.xs, xs);
  keep(hints_.ys, ys);
  keep(hints_.vertices, sample);
  hints_.slabs = slabs;
  hints_.points = triangles_;
}

std::vector<mesh_row> Mesh::read_rows() const { return points::download(runtime_, row_array_, rows_); }

// ---------------------------------------------------------------------------------------------------------
// Batches

void Mesh::begin_batch() {
  ++batch_;
  touched_count_ = 0;
  triangles_at_begin_ = triangles_;
  rows_at_begin_ = rows_;
}

void Mesh::end_batch(Changes& changes) {
  Arena& arena = runtime_.arena();
  Arena::Scope scope(arena);
  const auto flags = arena.allocate<cl_uchar>(touched_count_);
  runtime_.map(touched_count_, kernels::flag_touched{.touched = touched_, .flags = flags});
  const auto [at, count] = host::pack_positions(runtime_, flags, touched_count_, 1);
  const auto reports_there = arena.allocate<row_report>(count);
  runtime_.map(count,
               kernels::report_changes{
                   .positions = at, .touched = touched_, .rows = row_array_, .reports = reports_there});
  std::vector<row_report> reports(count);
  runtime_.read(reports_there, 0, count, reports.data());
  for (const row_report& report : reports) {
    if (report.was_triangle != 0) changes.removed.push_back(report.row);
    if (report.holds == kernel::ROW_TRIANGLE) {
      changes.made.push_back(report.row);
      changes.made_corners.insert(changes.made_corners.end(), report.corner, report.corner + 3);
    }
  }
  triangles_ = triangles_at_begin_ + changes.made.size() - changes.removed.size();
}

Ids Mesh::old_triangles() {
  Arena& arena = runtime_.arena();
  Arena::Scope scope(arena);
  const auto flags = arena.allocate<cl_uchar>(rows_at_begin_);
  runtime_.map(rows_at_begin_,
               kernels::find_old_triangles{.batch = batch_, .rows = row_array_, .flags = flags});
  const auto [at, count] = host::pack_positions(runtime_, flags, rows_at_begin_, 1);
  Ids old(count);
  runtime_.read(at, 0, count, old.data());
  return old;
}

// Sorts vertices so that neighbours in the plane are close in the list. The smallest of equals stays.
Ids Mesh::in_order_of_place(Ids vertices, const std::vector<double>& coordinates,
                            std::vector<Found>& doubled) const {
  if (vertices.size() < 2) return vertices;
  const auto place = [&](std::int32_t v) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(v)];
    return double2{p[0], p[1]};
  };
  std::vector<geometry::Keyed> keys = geometry::sort_by_place(vertices, place);
  vertices.clear();
  for (auto begin = keys.begin(); begin != keys.end();) {
    auto end = begin + 1;
    while (end != keys.end() && end->key == begin->key) ++end;
    if (end - begin > 1) {
      std::sort(begin, end, [&](const auto& a, const auto& b) {
        const double2 p = place(a.index), q = place(b.index);
        return std::tie(p.x, p.y, a.index) < std::tie(q.x, q.y, b.index);
      });
    }
    for (auto at = begin; at != end; ++at) {
      const bool is_doubled = at != begin && !kernel::comes_before(place(vertices.back()), place(at->index));
      if (is_doubled) {
        doubled.push_back({at->index, vertices.back()});
      } else {
        vertices.push_back(at->index);
      }
    }
    begin = end;
  }
  return vertices;
}

std::vector<Mesh::Found> Mesh::insert(Ids vertices, const std::vector<double>& coordinates,
                                      std::vector<SplitEdge>& splits) {
  std::vector<Found> found, doubled;
  vertices = in_order_of_place(std::move(vertices), coordinates, doubled);
  const std::size_t count = vertices.size();
  if (count == 0) return {};
  const cl_uint mask = static_cast<cl_uint>(std::bit_ceil(count) - 1);
  const std::size_t rows_before = rows_;
  std::vector<placed_vertex> placed(count);
  for (std::size_t i = 0; i < count; ++i) {
    placed[i].vertex = vertices[i];
    placed[i].found = placed[i].edge = -1;
    placed[i].rank = kernel::shuffled(static_cast<cl_uint>(i), mask);
    for (std::int32_t& row : placed[i].spare) row = take_row();
  }
  const std::size_t row_count = std::exchange(rows_, rows_before);
  reserve_rows(row_count);
  rows_ = row_count;
  reserve_vertices(static_cast<std::size_t>(*std::max_element(vertices.begin(), vertices.end())) + 1);

  Arena& arena = runtime_.arena();
  Arena::Scope scope(arena);
  runtime_.map(rows_ - rows_before,
               kernels::clear_rows{.first = static_cast<int>(rows_before), .rows = row_array_});
  {
    Arena::Scope inner(arena);
    swap_places(runtime_.upload(arena, vertices),
                runtime_.upload(arena, scaled(vertices, coordinates)).as<cl_double2>(), count);
  }
  const auto placed_there = runtime_.upload(arena, std::move(placed));
  const kernels::living_mesh mesh{.rows = row_array_, .points = points_};
  runtime_.map_in_small_groups(count,
                               kernels::locate_vertices{.living_mesh = mesh,
                                                        .hints = {.slabs = static_cast<int>(hints_.slabs),
                                                                  .xs = hints_.xs,
                                                                  .ys = hints_.ys,
                                                                  .vertices = hints_.vertices,
                                                                  .rows_of = rows_of_},
                                                        .placed = placed_there});
  const auto states = arena.allocate<cl_uchar>(count);
  runtime_.fill(states, count, cl_uchar{kernel::POINT_WAITS});
  auto list = runtime_.upload(arena, counted(count));
  auto next = arena.allocate<cl_int>(count);
  for (std::size_t waiting = count; waiting > 0;) {
    Arena::Scope step(arena);
    const auto sizes = arena.allocate<cl_uint>(waiting + 1);
    const auto waits = arena.allocate<cl_uchar>(waiting);
    const cl_uint first = take_claims(std::size_t{mask} + 1);
    runtime_.map_in_small_groups(waiting, kernels::claim_around{.first = first,
                                                                .list = list,
                                                                .living_mesh = mesh,
                                                                .claims = claims_,
                                                                .placed = placed_there,
                                                                .sizes = sizes,
                                                                .states = states});
    host::exclusive_scan(runtime_, sizes, waiting, sizes);
    const std::size_t all_sides = runtime_.read_one(sizes, waiting);
    const auto sides = arena.allocate<star_side>(all_sides);
    reserve_touched(all_sides);
    runtime_.map(waiting, kernels::gather_around{.first = first,
                                                 .list = list,
                                                 .offsets = sizes,
                                                 .placed = placed_there,
                                                 .living_mesh = mesh,
                                                 .claims = claims_,
                                                 .visits = visits_,
                                                 .sides = sides,
                                                 .states = states});
    runtime_.map(waiting, kernels::insert_around{.batch = batch_,
                                                 .first_touched = static_cast<int>(touched_count_),
                                                 .list = list,
                                                 .offsets = sizes,
                                                 .placed = placed_there,
                                                 .states = states,
                                                 .sides = sides,
                                                 .rows = row_array_,
                                                 .rows_of = rows_of_,
                                                 .touched = touched_,
                                                 .waits = waits});
    touched_count_ += all_sides;
    const auto [at, left] = host::pack_positions(runtime_, waits, waiting, 1);
    if (left == waiting) throw_stuck("points to be inserted");
    runtime_.map(left, kernels::append_rows{.positions = at, .all = 0, .from = list, .list = next});
    std::swap(list, next);
    waiting = left;
  }

  const auto [dropped_at, dropped] = host::pack_positions(runtime_, states, count, kernel::POINT_DROPPED);
  if (dropped > 0 || has_edges_) {
    std::vector<placed_vertex> ends(count);
    runtime_.read(placed_there, 0, count, ends.data());
    for (const placed_vertex& of : ends) {
      if (of.found >= 0) {
        found.push_back({of.vertex, of.found});
        free_rows_.insert(free_rows_.end(), of.spare, of.spare + 2);
      } else if (of.edge >= 0) {
        splits.push_back({of.from, of.to, of.vertex});
      }
    }
  }
  found.insert(found.end(), doubled.begin(), doubled.end());
  return found;
}

bool Mesh::remove(const Ids& vertices) {
  const std::size_t count = vertices.size();
  if (count == 0) return true;
  const cl_uint mask = static_cast<cl_uint>(std::bit_ceil(count) - 1);
  std::vector<removed_vertex> removed(count);
  for (std::size_t i = 0; i < count; ++i) {
    removed[i].vertex = vertices[i];
    removed[i].rank = kernel::shuffled(static_cast<cl_uint>(i), mask);
  }
  Arena& arena = runtime_.arena();
  Arena::Scope scope(arena);
  const auto removed_there = runtime_.upload(arena, std::move(removed));
  const auto states = arena.allocate<cl_uchar>(count);
  runtime_.fill(states, count, cl_uchar{kernel::UPDATE_WAITS});
  const auto triangles = runtime_.upload(arena, std::vector<cl_uint>{static_cast<cl_uint>(triangles_)});
  auto list = runtime_.upload(arena, counted(count));
  auto next = arena.allocate<cl_int>(count);
  const kernels::living_mesh mesh{.rows = row_array_, .points = points_};
  for (std::size_t waiting = count; waiting > 0;) {
    Arena::Scope step(arena);
    const auto sizes = arena.allocate<cl_uint>(waiting + 1);
    const auto waits = arena.allocate<cl_uchar>(waiting);
    const cl_uint first = take_claims(std::size_t{mask} + 1);
    runtime_.map(waiting, kernels::claim_stars{.first = first,
                                               .list = list,
                                               .living_mesh = mesh,
                                               .rows_of = rows_of_,
                                               .claims = claims_,
                                               .removed = removed_there,
                                               .sizes = sizes,
                                               .states = states});
    host::exclusive_scan(runtime_, sizes, waiting, sizes);
    const std::size_t all_rows = runtime_.read_one(sizes, waiting);
    reserve_touched(all_rows);
    runtime_.map(waiting, kernels::find_holders{.first = first,
                                                .list = list,
                                                .living_mesh = mesh,
                                                .claims = claims_,
                                                .removed = removed_there,
                                                .states = states});
    runtime_.map_in_small_groups(waiting,
                                 kernels::fill_stars{.batch = batch_,
                                                     .first_touched = static_cast<int>(touched_count_),
                                                     .list = list,
                                                     .offsets = sizes,
                                                     .rows = row_array_,
                                                     .points = points_,
                                                     .rows_of = rows_of_,
                                                     .removed = removed_there,
                                                     .states = states,
                                                     .touched = touched_,
                                                     .waits = waits,
                                                     .triangles = triangles});
    touched_count_ += all_rows;
    const auto [at, left] = host::pack_positions(runtime_, waits, waiting, 1);
    triangles_ = runtime_.read_one(triangles, 0);
    if (triangles_ == 0) return false;
    runtime_.map(left, kernels::append_rows{.positions = at, .all = 0, .from = list, .list = next});
    std::swap(list, next);
    // Vertices with too many triangles have left the list, too.
    if (left == waiting) throw_stuck("points to be removed");
    waiting = left;
  }
  const auto [large_at, large] = host::pack_positions(runtime_, states, count, kernel::UPDATE_TOO_LARGE);
  if (large > 0) return false;
  std::vector<removed_vertex> ends(count);
  runtime_.read(removed_there, 0, count, ends.data());
  for (const removed_vertex& of : ends) free_rows_.insert(free_rows_.end(), of.freed, of.freed + 2);
  return true;
}

// ---------------------------------------------------------------------------------------------------------
// Moving

void Mesh::swap_places(const Buffer<cl_int>& vertices, const Buffer<cl_double2>& others, std::size_t count) {
  runtime_.map(count, kernels::swap_points{.vertices = vertices, .others = others, .points = points_});
}

Mesh::RowList Mesh::rows_around(const Buffer<cl_int>& vertices, std::size_t count) {
  Arena& arena = runtime_.arena();
  const kernels::living_mesh mesh{.rows = row_array_, .points = points_};
  const auto counts = arena.allocate<cl_uint>(count + 1);
  runtime_.map(count, kernels::count_around{
                          .vertices = vertices, .living_mesh = mesh, .rows_of = rows_of_, .counts = counts});
  host::exclusive_scan(runtime_, counts, count, counts);
  RowList rows;
  rows.count = runtime_.read_one(counts, count);
  rows.list = arena.allocate<cl_int>(rows.count);
  runtime_.map(count, kernels::list_around_vertices{.vertices = vertices,
                                                    .living_mesh = mesh,
                                                    .rows_of = rows_of_,
                                                    .offsets = counts,
                                                    .list = rows.list});
  return rows;
}

std::optional<Ids> Mesh::move(Ids vertices, const std::vector<double>& coordinates, bool are_many) {
  Arena& arena = runtime_.arena();
  // Flips take longer than triangulating anew if one row in kRowsPerFlip is wrong, unless there are few rows.
  constexpr std::size_t kRowsPerFlip = 100, kFewRows = 5000;
  Ids out;
  while (!vertices.empty()) {
    Arena::Scope scope(arena);
    const std::size_t count = vertices.size();
    const auto moved = runtime_.upload(arena, vertices);
    const auto turned = arena.allocate<cl_uint>(count);
    runtime_.fill(turned, count, cl_uint{0});
    const kernels::living_mesh mesh{.rows = row_array_, .points = points_};
    const auto others = runtime_.upload(arena, scaled(vertices, coordinates)).as<cl_double2>();
    bool is_turned = false;
    if (!are_many) {
      // The hull stays unchanged, so that triangles that have not turned over do not overlap.
      runtime_.map(count,
                   kernels::find_hull_vertices{
                       .vertices = moved, .living_mesh = mesh, .rows_of = rows_of_, .on_hull = turned});
    }
    swap_places(moved, others, count);
    const RowList rows = are_many ? RowList{true, moved, rows_} : rows_around(moved, count);
    const auto found = arena.allocate<cl_uchar>(rows.count);
    const auto minima = runtime_.upload(arena, std::vector<cl_int>{0});
    runtime_.map_in_small_groups(
        rows.count,
        kernels::check_rows{
            .all = rows.all, .list = rows.list, .living_mesh = mesh, .found = found, .minima = minima});
    runtime_.map(count, kernels::mark_moved{.is_over = 0, .vertices = moved, .moved_at = moved_at_});
    runtime_.map(rows.count, kernels::mark_turned{.all = rows.all,
                                                  .list = rows.list,
                                                  .found = found,
                                                  .rows = row_array_,
                                                  .moved_at = moved_at_,
                                                  .turned = turned});
    runtime_.map(count, kernels::mark_moved{.is_over = 1, .vertices = moved, .moved_at = moved_at_});
    std::vector<cl_uint> are_turned(count);
    runtime_.read(turned, 0, count, are_turned.data());
    const auto [at, wrong] = host::pack_positions(runtime_, found, rows.count, kernel::ROW_WRONG);
    if (are_many && kRowsPerFlip * wrong > rows_ && rows_ > kFewRows) return {};
    Ids left, leave;
    for (std::size_t i = 0; i < count; ++i) (are_turned[i] != 0 ? leave : left).push_back(vertices[i]);
    is_turned = !leave.empty();
    if (!is_turned) {
      if (are_many && runtime_.read_one(minima, 0) != 1) return {};
      const auto list = arena.allocate<cl_int>(wrong);
      runtime_.map(wrong,
                   kernels::append_rows{.positions = at, .all = rows.all, .from = rows.list, .list = list});
      flip({false, list, wrong});
      return out;
    }
    if (are_many) return {};
    swap_places(moved, others, count);
    if (!remove(leave)) return {};
    out.insert(out.end(), leave.begin(), leave.end());
    vertices = std::move(left);
  }
  return out;
}

void Mesh::flip(RowList wrong) {
  Arena& arena = runtime_.arena();
  const kernels::living_mesh mesh{.rows = row_array_, .points = points_};
  while (wrong.count > 0) {
    Arena::Scope scope(arena);
    const std::size_t count = wrong.count;
    const cl_uint mask = static_cast<cl_uint>(std::bit_ceil(count) - 1),
                  first = take_claims(std::size_t{mask} + 1);
    const auto corners = arena.allocate<cl_int>(count), next = arena.allocate<cl_int>(2 * count);
    const auto states = arena.allocate<cl_uchar>(count), is_next = arena.allocate<cl_uchar>(2 * count);
    reserve_touched(2 * count);
    runtime_.map_in_small_groups(count, kernels::claim_wrong_edges{.first = first,
                                                                   .mask = mask,
                                                                   .list = wrong.list,
                                                                   .living_mesh = mesh,
                                                                   .claims = claims_,
                                                                   .corners = corners,
                                                                   .states = states});
    runtime_.map(count, kernels::find_holding_rows{.first = first,
                                                   .mask = mask,
                                                   .living_mesh = mesh,
                                                   .corners = corners,
                                                   .claims = claims_,
                                                   .states = states});
    runtime_.map(count, kernels::flip_edges_of_rows{.batch = batch_,
                                                    .first_touched = static_cast<int>(touched_count_),
                                                    .list = wrong.list,
                                                    .corners = corners,
                                                    .states = states,
                                                    .rows = row_array_,
                                                    .rows_of = rows_of_,
                                                    .touched = touched_,
                                                    .next = next,
                                                    .is_next = is_next});
    touched_count_ += 2 * count;
    const auto [at, left] = host::pack_positions(runtime_, is_next, 2 * count, 1);
    if (left > next_flips_.size()) grow(next_flips_, 0, left);
    runtime_.map(left, kernels::append_rows{.positions = at, .all = 0, .from = next, .list = next_flips_});
    std::swap(flips_, next_flips_);
    wrong = {false, flips_, left};
  }
}

}  // namespace flaunay::updates
