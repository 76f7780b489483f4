#include "large/chunks/finish.hpp"

#include <algorithm>
#include <mutex>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "arithmetic/coordinates.h"
#include "blocks/certify.h"
#include "blocks/open_sectors.h"
#include "large/chunks/runs.hpp"
#include "periodic/torus.h"

namespace flaunay::chunks {
namespace {

constexpr std::size_t kTrianglesPerPart = 1 << 14;
constexpr std::size_t kRowsPerPiece = 1 << 16;

constexpr int after(int corner) { return corner == 2 ? 0 : corner + 1; }

kernel::double2 scaled(kernel::double2 p, kernel::scaling scale) {
  return {kernel::scaled(p.x, scale) + 0.0, kernel::scaled(p.y, scale) + 0.0};
}

kernel::vertex_box scaled(const kernel::vertex_box& box, kernel::scaling scale) {
  return {scaled(box.low, scale), scaled(box.high, scale)};
}

}  // namespace

FinishedChunk::FinishedChunk(host::Threads& threads, ChunkPoints points, Triangulation mesh,
                             const Place& place, const geometry::Scaling& scaling, const Folding* folding)
    : points_(std::move(points)), mesh_(std::move(mesh)), orient_bound_(scaling.bounds.orient) {
  const kernel::scaling scale = scaling.powers();
  scaled_.resize(points_.size());
  threads.share(points_.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scaled_[i] = scaled(points_.point(i), scale);
  });
  if (!points_.is_first_round()) number_edge_ends(scale);
  kernel::block_frame frame{};
  frame.rectangle = scaled(place.rectangle, scale);
  frame.all = scaled(place.all, scale);
  find_final(threads, frame, folding);
  find_border(threads);
}

// The ends of open edges that are not in the chunk come after its points.
void FinishedChunk::number_edge_ends(kernel::scaling scale) {
  std::unordered_map<std::int64_t, std::int32_t> others;
  edges_.reserve(points_.edges.size());
  for (const OpenEdge& edge : points_.edges) {
    const auto found = std::lower_bound(points_.ids.begin(), points_.ids.end(), edge.to);
    auto to = static_cast<std::int32_t>(found - points_.ids.begin());
    if (found == points_.ids.end() || *found != edge.to) {
      const auto [other, is_new] = others.try_emplace(edge.to, static_cast<std::int32_t>(scaled_.size()));
      if (is_new) scaled_.push_back(scaled(kernel::double2{edge.x, edge.y}, scale));
      to = other->second;
    }
    edges_.push_back({to, 0, static_cast<int>(edge.begins)});
  }
}

// Asked at the corner with the fewest open edges: if it has none, its whole star is missing.
bool FinishedChunk::is_missing(std::size_t t) const {
  if (points_.is_first_round()) return true;
  int k = 0;
  for (int other = 1; other < 3; ++other) {
    if (points_.edge_count(corner(t, other)) < points_.edge_count(corner(t, k))) k = other;
  }
  const std::int32_t from = corner(t, k), to = corner(t, after(k));
  const auto begin = static_cast<int>(points_.edge_offsets[from]);
  const auto end = static_cast<int>(points_.edge_offsets[from + 1]);
  if (begin == end) return true;
  const kernel::direction direction = {scaled_[from], scaled_[to], to, 0};
  constexpr int kExactly = 1;
  return kernel::begins_open(&direction, edges_.data(), begin, end, scaled_.data(), orient_bound_,
                             kExactly) == 1;
}

void FinishedChunk::find_final(host::Threads& threads, const kernel::block_frame& frame,
                               const Folding* folding) {
  const auto first_image = static_cast<std::int32_t>(
      folding == nullptr ? points_.size()
                         : std::lower_bound(points_.ids.begin(), points_.ids.end(), folding->first_image()) -
                               points_.ids.begin());
  const auto is_kept = [&](std::size_t t) {
    const std::int32_t a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    if (std::max({a, b, c}) < first_image) return true;
    const auto image = [&](std::int32_t v) { return folding->image(points_.ids[v]); };
    return kernel::is_kept(image(a), image(b), image(c)) != 0;
  };
  rows_.resize(mesh_.triangles.size() / 3);
  threads.share(rows_.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const bool is_final = kernel::is_circle_inside(&frame, scaled_[corner(t, 0)], scaled_[corner(t, 1)],
                                                     scaled_[corner(t, 2)]) != 0 &&
                            is_missing(t);
      rows_[t] = !is_final ? kNotFinal : is_kept(t) ? 0 : kDropped;
    }
  });
  std::int32_t row = 0;
  for (std::int32_t& each : rows_) {
    if (each == 0) each = row++;
    dropped_ += each == kDropped;
  }
  triangles_ = static_cast<std::uint64_t>(row);
}

// The place of an open edge of a point, or kNone.
std::int64_t FinishedChunk::open_edge(std::int32_t from, std::int32_t to, int begins) const {
  if (points_.is_first_round()) return kNone;
  for (std::size_t e = points_.edge_offsets[from]; e < points_.edge_offsets[from + 1]; ++e) {
    if (edges_[e].to == to && edges_[e].begins == begins) return static_cast<std::int64_t>(e);
  }
  return kNone;
}

void FinishedChunk::find_border(host::Threads& threads) {
  std::mutex mutex;
  threads.share(rows_.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    std::vector<Border> found;
    for (std::size_t t = begin; t < end; ++t) {
      for (int k = 0; k < 3 && rows_[t] != kNotFinal; ++k) {
        const std::int32_t neighbor = mesh_.neighbors[3 * t + k];
        const bool is_beyond_final = neighbor >= 0 && rows_[neighbor] != kNotFinal;
        if (is_beyond_final && (rows_[neighbor] >= 0 || rows_[t] < 0)) continue;
        const std::int32_t from = corner(t, after(k)), to = corner(t, after(after(k)));
        found.push_back({static_cast<std::int32_t>(t), k, is_beyond_final ? kFold : open_edge(from, to, 1)});
      }
    }
    const std::lock_guard lock(mutex);
    border_.insert(border_.end(), found.begin(), found.end());
  });
  std::sort(border_.begin(), border_.end(), [](const Border& a, const Border& b) {
    return std::pair(a.triangle, a.corner) < std::pair(b.triangle, b.corner);
  });
}

// The entry of `neighbors` of a side, or -1.
std::int64_t FinishedChunk::entry(const Border& border, std::uint64_t first_row) const {
  const std::int32_t row = rows_[border.triangle];
  return row < 0 ? -1 : 3 * (static_cast<std::int64_t>(first_row) + row) + border.corner;
}

// The row beyond a side, or -1.
std::int64_t FinishedChunk::row_beyond(const Border& border) const {
  const std::int64_t waiting = border.closed < 0 ? -1 : points_.edges[border.closed].corner;
  return waiting < 0 ? -1 : waiting / 3;
}

// The edges that are open after this chunk, by point: edges of its border, and earlier open edges that it did
// not close.
std::vector<FinishedChunk::OpenAt> FinishedChunk::open_edges(std::uint64_t first_row) const {
  std::vector<OpenAt> open;
  std::vector<char> is_closed(points_.edges.size(), 0);
  const auto add = [&](std::int32_t at, std::int32_t to, const Border& border, std::int64_t begins) {
    const kernel::double2 end = points_.point(to);
    const std::int64_t opposite = points_.ids[corner(border.triangle, border.corner)];
    open.push_back({at, {points_.ids[to], end.x, end.y, entry(border, first_row), begins, opposite}});
  };
  for (const Border& border : border_) {
    const std::int32_t from = corner(border.triangle, after(border.corner));
    const std::int32_t to = corner(border.triangle, after(after(border.corner)));
    if (border.closed >= 0) {
      // One edge, as each of its two ends sees it.
      const std::int64_t there = open_edge(to, from, 0);
      if (there < 0)
        throw Error(ErrorKind::internal, "an edge is open at one of its ends alone; please report the input");
      is_closed[border.closed] = is_closed[there] = 1;
    } else if (border.closed == kNone) {
      add(from, to, border, 0);
      add(to, from, border, 1);
    }
  }
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (points_.edge_count(v) == 0) continue;
    for (std::size_t e = points_.edge_offsets[v]; e < points_.edge_offsets[v + 1]; ++e) {
      if (is_closed[e] == 0) open.push_back({static_cast<std::int32_t>(v), points_.edges[e]});
    }
  }
  std::sort(open.begin(), open.end(), [](const OpenAt& a, const OpenAt& b) {
    return std::tuple(a.at, a.edge.to, a.edge.begins) < std::tuple(b.at, b.edge.to, b.edge.begins);
  });
  return open;
}

// Points that had no open edge before, with a triangle that is not final, or on the hull of the chunk.
std::vector<char> FinishedChunk::unfinished() const {
  std::vector<char> unfinished(points_.size(), 0);
  for (std::size_t t = 0; t < rows_.size(); ++t) {
    for (int k = 0; k < 3 && rows_[t] == kNotFinal; ++k) unfinished[corner(t, k)] = 1;
  }
  for (const std::int32_t v : mesh_.hull) unfinished[v] = 1;
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (points_.edge_count(v) > 0) unfinished[v] = 0;
  }
  return unfinished;
}

// A point goes on if it has an open edge, or if nothing around it is final. If some of its triangles are
// final and others are not, an edge between them is open.
ChunkPoints FinishedChunk::handed_on(std::uint64_t first_row) const {
  const std::vector<OpenAt> open = open_edges(first_row);
  const std::vector<char> goes_on = unfinished();
  ChunkPoints next;
  next.edge_offsets.push_back(0);
  std::vector<OpenEdge> own;
  for (std::size_t v = 0, e = 0; v < points_.size(); ++v) {
    own.clear();
    for (; e < open.size() && open[e].at == static_cast<std::int32_t>(v); ++e) own.push_back(open[e].edge);
    if (goes_on[v] == 0 && own.empty()) continue;
    next.add(points_.point(v), points_.ids[v], own.data(), own.size());
    if (points_.has_values()) next.values.push_back(points_.values[v]);
  }
  return next;
}

void FinishedChunk::merge_values(Duplicates duplicates, std::uint64_t fixed) {
  std::vector<std::pair<std::int32_t, double>> equal;  // representatives, and values of others
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::int32_t representative = mesh_.representatives[i];
    if (representative == static_cast<std::int32_t>(i) ||
        static_cast<std::uint64_t>(points_.ids[static_cast<std::size_t>(representative)]) < fixed)
      continue;
    equal.emplace_back(representative, points_.values[i]);
  }
  std::sort(equal.begin(), equal.end());
  std::vector<double> values;
  for (std::size_t k = 0; k < equal.size();) {
    const std::int32_t representative = equal[k].first;
    values = {points_.values[representative]};
    for (; k < equal.size() && equal[k].first == representative; ++k) values.push_back(equal[k].second);
    points_.values[representative] = common_value(values, duplicates);
  }
}

ChunkSurface FinishedChunk::take_surface() && {
  ChunkSurface surface;
  std::vector<std::int32_t>&triangles = mesh_.triangles, &neighbors = mesh_.neighbors;
  std::size_t row = 0;
  for (std::size_t t = 0; t < rows_.size(); ++t) {
    if (rows_[t] < 0) continue;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t neighbor = neighbors[3 * t + k];
      const bool is_final = neighbor >= 0 && rows_[neighbor] >= 0;
      triangles[3 * row + k] = triangles[3 * t + k];
      neighbors[3 * row + k] = is_final ? rows_[neighbor] : static_cast<std::int32_t>(row);
    }
    ++row;
  }
  triangles.resize(3 * row);
  neighbors.resize(3 * row);
  for (const Border& border : border_) surface.open.push_back(3 * rows_[border.triangle] + border.corner);
  surface.coordinates = std::move(points_.coordinates);
  surface.values = std::move(points_.values);
  surface.triangles = std::move(triangles);
  surface.neighbors = std::move(neighbors);
  return surface;
}

std::vector<kernel::seam_record> FinishedChunk::folds(const Folding& folding, std::uint64_t first_row,
                                                      bool is_last) const {
  std::vector<kernel::seam_record> folds;
  const auto add = [&](std::int32_t from, std::int64_t to, kernel::double2 b, std::int64_t own,
                       std::int64_t beyond, std::int64_t at) {
    const kernel::double2 a = points_.point(from);
    folds.push_back({{a.x, a.y, b.x, b.y},
                     folding.image(points_.ids[from]),
                     folding.image(to),
                     folding.image(own),
                     beyond < 0 ? NO_IMAGE : folding.image(beyond),
                     at});
  };
  for (const Border& border : border_) {
    if (border.closed == kNone) continue;
    const auto t = static_cast<std::size_t>(border.triangle);
    std::int32_t from = corner(t, after(border.corner)), to = corner(t, after(after(border.corner)));
    std::int64_t own = points_.ids[corner(t, border.corner)], beyond = 0, at = entry(border, first_row);
    if (border.closed == kFold) {
      const auto other = static_cast<std::size_t>(mesh_.neighbors[3 * t + border.corner]);
      int k = 0;
      while (corner(other, after(k)) != to) ++k;
      beyond = points_.ids[corner(other, k)];
    } else {
      const OpenEdge& edge = points_.edges[border.closed];
      if ((at < 0) == (edge.corner < 0)) continue;
      beyond = edge.opposite;
      if (at < 0) {
        std::swap(from, to);
        std::swap(own, beyond);
        at = edge.corner;
      }
    }
    add(from, points_.ids[to], points_.point(to), own, beyond, at);
  }
  if (!is_last) return folds;
  for (const auto& [from, edge] : open_edges(first_row)) {
    if (edge.begins != 0 || edge.corner < 0) continue;
    add(from, edge.to, {edge.x, edge.y}, edge.opposite, -1, edge.corner);
  }
  return folds;
}

void FinishedChunk::write(MeshSink& sink, std::uint64_t first_row) const {
  if (!sink.wants(MeshArray::triangles) && !sink.wants(MeshArray::neighbors) && mesh_.areas.empty()) return;
  write_rows(sink, first_row);
  if (sink.wants(MeshArray::neighbors)) write_links(sink, first_row);
}

void FinishedChunk::write_rows(MeshSink& sink, std::uint64_t first_row) const {
  const bool with_triangles = sink.wants(MeshArray::triangles),
             with_neighbors = sink.wants(MeshArray::neighbors);
  std::vector<std::int64_t> corners, neighbors;
  std::vector<double> areas;
  std::uint64_t written = first_row;
  const auto flush = [&] {
    if (with_triangles) sink.write(MeshArray::triangles, 3 * written, corners.data(), corners.size());
    if (with_neighbors) sink.write(MeshArray::neighbors, 3 * written, neighbors.data(), neighbors.size());
    if (!areas.empty()) sink.write_doubles(MeshArray::areas, written, areas.data(), areas.size());
    written += corners.size() / 3;
    corners.clear();
    neighbors.clear();
    areas.clear();
  };
  auto border = border_.begin();
  for (std::size_t t = 0; t < rows_.size(); ++t) {
    if (rows_[t] < 0) continue;
    while (border != border_.end() && border->triangle < static_cast<std::int32_t>(t)) ++border;
    for (int k = 0; k < 3; ++k) {
      corners.push_back(points_.ids[corner(t, k)]);
      if (border == border_.end() || border->triangle != static_cast<std::int32_t>(t) ||
          border->corner != k) {
        neighbors.push_back(static_cast<std::int64_t>(first_row) + rows_[mesh_.neighbors[3 * t + k]]);
      } else {
        neighbors.push_back(row_beyond(*border));
        ++border;
      }
    }
    if (!mesh_.areas.empty()) areas.push_back(mesh_.areas[t]);
    if (corners.size() == 3 * kRowsPerPiece) flush();
  }
  if (!corners.empty()) flush();
}

// Tells triangles of rounds before who their neighbours are.
void FinishedChunk::write_links(MeshSink& sink, std::uint64_t first_row) const {
  std::vector<std::pair<std::int64_t, std::int64_t>> links;
  for (const Border& border : border_) {
    if (row_beyond(border) < 0 || rows_[border.triangle] < 0) continue;
    links.emplace_back(points_.edges[border.closed].corner,
                       static_cast<std::int64_t>(first_row) + rows_[border.triangle]);
  }
  std::sort(links.begin(), links.end());
  RunWriter neighbors(sink, MeshArray::neighbors);
  for (const auto& [waiting, row] : links) neighbors.add(static_cast<std::uint64_t>(waiting), row);
  neighbors.flush();
}

void FinishedChunk::write_duplicates(MeshSink& sink) const {
  RunWriter representatives(sink, MeshArray::representatives);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::int32_t representative = mesh_.representatives[i];
    if (representative == static_cast<std::int32_t>(i)) continue;
    representatives.add(static_cast<std::uint64_t>(points_.ids[i]), points_.ids[representative]);
  }
  representatives.flush();
}

void FinishedChunk::write_hull(MeshSink& sink) const {
  if (!sink.wants(MeshArray::hull)) return;
  std::vector<std::int64_t> hull;
  hull.reserve(mesh_.hull.size());
  for (const std::int32_t v : mesh_.hull) hull.push_back(points_.ids[v]);
  if (!hull.empty()) sink.write(MeshArray::hull, 0, hull.data(), hull.size());
}

}  // namespace flaunay::chunks
