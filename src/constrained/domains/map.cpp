#include "constrained/domains/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "geometry/arguments.hpp"
#include "mesh/corners.hpp"
#include "predicates/planar.h"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

// How a region is entered from another one, or from outside: over a constraint edge, with the region to the
// left of its direction here.
struct Entry {
  std::int32_t from;        // -1: the outside
  std::int32_t tail, head;  // of the edge; equal if no edge is known
};

// A tree of regions, whose root is the outside: per region how it is entered. order: each region comes after
// the one it is entered from.
struct Tree {
  std::vector<Entry> entries;
  Ids order;
};

Tree make_tree(const ConstrainedTriangulation& mesh, const Ids& regions, std::size_t count) {
  const auto halfedges = static_cast<std::int32_t>(mesh.triangles.size());
  const auto edge_at = [&](std::int32_t c) { return mesh::edge_opposite(mesh.triangles, c); };
  // Corners whose opposite edge is a border, grouped by the region of their triangle.
  Ids offsets(count + 1, 0), corners, seen(count, 0);
  const auto is_border = [&](std::int32_t c) {
    return mesh.constrained[c] != 0 && mesh.neighbors[c] >= 0 && regions[mesh.neighbors[c]] != regions[c / 3];
  };
  for (std::int32_t c = 0; c < halfedges; ++c) offsets[regions[c / 3] + 1] += is_border(c) ? 1 : 0;
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  corners.resize(static_cast<std::size_t>(offsets.back()));
  Ids place(offsets.begin(), offsets.end() - 1);
  for (std::int32_t c = 0; c < halfedges; ++c) {
    if (is_border(c)) corners[place[regions[c / 3]]++] = c;
  }

  Tree tree;
  tree.entries.resize(count);
  const auto enter = [&](std::int32_t region, const Entry& entry) {
    if (std::exchange(seen[region], 1) != 0) return;
    tree.entries[region] = entry;
    tree.order.push_back(region);
  };
  for (std::int32_t c = 0; c < halfedges; ++c) {
    if (mesh.neighbors[c] >= 0) continue;
    const auto [tail, head] = edge_at(c);
    enter(regions[c / 3], mesh.constrained[c] != 0 ? Entry{-1, tail, head} : Entry{-1, 0, 0});
  }
  for (std::size_t next = 0; next < tree.order.size(); ++next) {
    const std::int32_t from = tree.order[next];
    for (std::int32_t i = offsets[from]; i < offsets[from + 1]; ++i) {
      const auto [head, tail] = edge_at(corners[i]);
      enter(regions[mesh.neighbors[corners[i]]], {from, tail, head});
    }
  }
  return tree;
}

class Coverage {
 public:
  Coverage(const double* coordinates, const ConstrainedTriangulation& mesh, const Tree& tree)
      : coordinates_(coordinates),
        mesh_(mesh),
        edges_(mesh.constraint_edges.size() / 2),
        wanted_(edges_, -1) {
    find_edges(tree);
  }

  // Adds the steps into each region.
  void write_steps(const std::int32_t* segments, const Ids& curves, Entrances& into) const {
    std::vector<std::pair<std::int32_t, Step>> all;
    for (std::size_t s = 0; s < curves.size(); ++s) {
      const std::int32_t a = mesh_.representatives[segments[2 * s]],
                         b = mesh_.representatives[segments[2 * s + 1]];
      if (a == b) continue;
      const bool is_turned = comes_before(b, a);
      std::int32_t from = is_turned ? b : a;
      for (std::int32_t p = mesh_.piece_offsets[s]; p < mesh_.piece_offsets[s + 1]; ++p) {
        const std::int32_t first = mesh_.piece_edges[2 * p], end = mesh_.piece_edges[2 * p + 1];
        if (first == end) continue;
        const std::int32_t low = mesh_.constraint_edges[2 * first],
                           high = mesh_.constraint_edges[2 * end - 1];
        const bool is_backward = low != from;
        from = is_backward ? low : high;
        for (std::int32_t e = next_[first]; e < end; e = next_[e + 1]) {
          for (std::int32_t i = wanted_[e]; i >= 0; i = following_[i]) {
            const bool same = (is_backward == is_turned) == is_forward_[i];
            all.push_back({i, {curves[s], same ? 1 : -1}});
          }
        }
      }
    }
    group_steps(all, into);
  }

 private:
  bool comes_before(std::int32_t u, std::int32_t v) const {
    const auto point = [this](std::int32_t i) {
      return kernel::double2{coordinates_[2 * static_cast<std::size_t>(i)],
                             coordinates_[2 * static_cast<std::size_t>(i) + 1]};
    };
    return kernel::comes_before(point(u), point(v)) != 0;
  }

  // Lists per constraint edge the regions that are entered over it.
  void find_edges(const Tree& tree) {
    const std::size_t regions = tree.entries.size();
    following_.assign(regions, -1);
    is_forward_.assign(regions, false);
    struct Wanted {
      std::int32_t from, to, region;
    };
    std::vector<Wanted> all;
    for (std::size_t r = 0; r < regions; ++r) {
      const Entry& entry = tree.entries[r];
      if (entry.tail == entry.head) continue;
      is_forward_[r] = comes_before(entry.tail, entry.head);
      all.push_back({is_forward_[r] ? entry.tail : entry.head, is_forward_[r] ? entry.head : entry.tail,
                     static_cast<std::int32_t>(r)});
    }
    std::sort(all.begin(), all.end(), [](const Wanted& a, const Wanted& b) {
      return std::tie(a.from, a.to, a.region) < std::tie(b.from, b.to, b.region);
    });
    for (std::size_t e = 0; e < edges_; ++e) {
      const std::int32_t from = mesh_.constraint_edges[2 * e], to = mesh_.constraint_edges[2 * e + 1];
      auto found =
          std::lower_bound(all.begin(), all.end(), std::tie(from, to),
                           [](const Wanted& a, const auto& b) { return std::tie(a.from, a.to) < b; });
      for (; found != all.end() && found->from == from && found->to == to; ++found) {
        following_[found->region] = wanted_[e];
        wanted_[e] = found->region;
      }
    }
    next_.assign(edges_ + 2, static_cast<std::int32_t>(edges_));
    for (std::size_t e = edges_; e-- > 0;) {
      next_[e] = wanted_[e] >= 0 ? static_cast<std::int32_t>(e) : next_[e + 1];
    }
  }

  const double* coordinates_;
  const ConstrainedTriangulation& mesh_;
  std::size_t edges_;
  Ids wanted_;     // per edge the first region entered over it, or -1
  Ids following_;  // per region the next one entered over its edge, or -1
  std::vector<bool> is_forward_;
  Ids next_;  // per edge the first one from there on that is wanted
};

// The polygons around the place of a walk.
class Around {
 public:
  Around(const Curves& curves, FillRule rule)
      : curves_(curves), counts_(curves.parts.size(), 0), parts_(curves.polygons.size()), rule_(rule) {}

  void step(const Step& step, int times) {
    std::int32_t& count = counts_[step.curve];
    const bool was_in = is_in(count);
    count += times * step.amount;
    if (is_in(count) == was_in) return;
    Part& part = parts_[curves_.parts[step.curve]];
    const bool was_in_part = part.is_in();
    (curves_.are_holes[step.curve] != 0 ? part.holes : part.borders) += was_in ? -1 : 1;
    if (part.is_in() == was_in_part) return;
    const std::int32_t polygon = curves_.polygons[curves_.parts[step.curve]];
    if (was_in_part) {
      const auto found = in_.find(polygon);
      if (--found->second == 0) in_.erase(found);
    } else {
      ++in_[polygon];
    }
  }
  /// With the number of their parts here.
  const std::map<std::int32_t, std::int32_t>& polygons() const { return in_; }

 private:
  // In how many of its borders and holes the place is.
  struct Part {
    std::int32_t borders = 0, holes = 0;
    bool is_in() const { return borders > 0 && holes == 0; }
  };
  bool is_in(std::int32_t count) const { return rule_ == FillRule::winding ? count != 0 : count % 2 != 0; }

  const Curves& curves_;
  Ids counts_;
  std::vector<Part> parts_;
  std::map<std::int32_t, std::int32_t> in_;
  FillRule rule_;
};

// Row i of offsets has the members [offsets[i], offsets[i + 1]): by member its row.
Ids rows_of(const std::vector<std::size_t>& offsets) {
  Ids rows;
  rows.reserve(offsets.back());
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    rows.resize(offsets[i + 1], static_cast<std::int32_t>(i));
  }
  return rows;
}

[[noreturn]] void throw_overlap(const ConstrainedTriangulation& mesh, const Ids& regions, std::int32_t region,
                                const std::pair<std::int32_t, std::int32_t>& polygons) {
  const auto t =
      static_cast<std::size_t>(std::find(regions.begin(), regions.end(), region) - regions.begin());
  throw Error(ErrorKind::input,
              fmt::format("polygons {} and {} overlap, at the triangle of points {}, {} and {}",
                          polygons.first, polygons.second, mesh.triangles[3 * t], mesh.triangles[3 * t + 1],
                          mesh.triangles[3 * t + 2]));
}

}  // namespace

void check_rings(const Rings& rings, std::size_t segments, FillRule rule) {
  expect(rule != FillRule::nesting, "rings need the fill rule even-odd or winding");
  for (const auto* offsets : {&rings.segment_offsets, &rings.part_offsets, &rings.polygon_offsets}) {
    expect(!offsets->empty() && offsets->front() == 0 && std::is_sorted(offsets->begin(), offsets->end()),
           "the offsets of rings, parts and polygons must begin with 0 and not decrease");
  }
  const std::size_t count = rings.segment_offsets.size() - 1;
  expect(rings.segment_offsets.back() <= segments, "the rings have more segments than there are");
  expect(rings.part_offsets.back() == count && rings.polygon_offsets.back() == count,
         "the offsets of parts and polygons do not end with the number of rings");
  for (const std::size_t first : rings.polygon_offsets) {
    expect(std::binary_search(rings.part_offsets.begin(), rings.part_offsets.end(), first),
           "a polygon does not begin with a part");
  }
}

Curves curves_of(const Rings& rings) {
  Curves curves;
  curves.of_segments = rows_of(rings.segment_offsets);
  curves.parts = rows_of(rings.part_offsets);
  curves.are_holes.assign(curves.parts.size(), 1);
  const Ids polygon_of_ring = rows_of(rings.polygon_offsets);
  for (std::size_t q = 0; q + 1 < rings.part_offsets.size(); ++q) {
    const std::size_t border = rings.part_offsets[q];
    const bool has_border = border < rings.part_offsets[q + 1];
    if (has_border) curves.are_holes[border] = 0;
    curves.polygons.push_back(has_border ? polygon_of_ring[border] : -1);
  }
  return curves;
}

Curves part_of(const Curves& curves, std::size_t first, std::size_t end) {
  Curves part;
  const auto cut = [](const auto& values, std::size_t from, std::size_t to) {
    const auto begin = values.begin();
    return std::remove_cvref_t<decltype(values)>(begin + static_cast<std::ptrdiff_t>(from),
                                                 begin + static_cast<std::ptrdiff_t>(to));
  };
  first = std::min(first, curves.of_segments.size());
  end = std::min(end, curves.of_segments.size());
  if (first == end) return part;
  const auto first_curve = static_cast<std::size_t>(curves.of_segments[first]),
             end_curve = static_cast<std::size_t>(curves.of_segments[end - 1]) + 1;
  const auto first_part = static_cast<std::size_t>(curves.parts[first_curve]),
             end_part = static_cast<std::size_t>(curves.parts[end_curve - 1]) + 1;
  part.of_segments = cut(curves.of_segments, first, end);
  part.parts = cut(curves.parts, first_curve, end_curve);
  part.are_holes = cut(curves.are_holes, first_curve, end_curve);
  part.polygons = cut(curves.polygons, first_part, end_part);
  for (std::int32_t& curve : part.of_segments) curve -= static_cast<std::int32_t>(first_curve);
  for (std::int32_t& of : part.parts) of -= static_cast<std::int32_t>(first_part);
  return part;
}

Curves curves_of_polygons(const std::vector<std::size_t>& offsets) {
  Curves curves;
  curves.of_segments = rows_of(offsets);
  curves.parts.resize(offsets.size() - 1);
  std::iota(curves.parts.begin(), curves.parts.end(), 0);
  curves.are_holes.assign(curves.parts.size(), 0);
  curves.polygons = curves.parts;
  return curves;
}

void group_steps(const std::vector<std::pair<std::int32_t, Step>>& all, Entrances& into) {
  into.offsets.assign(into.from.size() + 1, 0);
  for (const auto& [region, step] : all) ++into.offsets[region + 1];
  std::partial_sum(into.offsets.begin(), into.offsets.end(), into.offsets.begin());
  into.steps.resize(all.size());
  Ids place(into.offsets.begin(), into.offsets.end() - 1);
  for (const auto& [region, step] : all) into.steps[place[region]++] = step;
}

MapLabels label_regions(const Entrances& into, const Curves& curves, FillRule rule, Overlap& overlap) {
  const std::size_t count = into.from.size();
  Ids first_child(count + 1, -1), sibling(count, -1);
  for (auto r = into.order.rbegin(); r != into.order.rend(); ++r) {
    const std::int32_t parent = into.from[*r];
    std::int32_t& first = first_child[parent < 0 ? count : static_cast<std::size_t>(parent)];
    sibling[*r] = std::exchange(first, *r);
  }
  Around around(curves, rule);
  const auto step = [&](std::int32_t region, int times) {
    for (std::int32_t i = into.offsets[region]; i < into.offsets[region + 1]; ++i) {
      around.step(into.steps[i], times);
    }
  };
  MapLabels labels{Ids(count, -1), Ids(count, 0)};
  overlap.region = static_cast<std::int32_t>(count);
  // Depth first: down to the first child, else on to the next sibling, of the region or of one above it.
  for (std::int32_t r = first_child[count]; r >= 0;) {
    step(r, 1);
    const std::map<std::int32_t, std::int32_t>& in = around.polygons();
    labels.depths[r] = static_cast<std::int32_t>(in.size());
    if (!in.empty()) labels.polygons[r] = in.begin()->first;
    if (in.size() > 1 && r < overlap.region) {
      overlap = {r, {in.begin()->first, std::next(in.begin())->first}};
    }
    if (first_child[r] >= 0) {
      r = first_child[r];
      continue;
    }
    while (r >= 0) {
      step(r, -1);
      if (sibling[r] >= 0) break;
      r = into.from[r];
    }
    if (r >= 0) r = sibling[r];
  }
  return labels;
}

MapLabels label_map(const double* coordinates, const ConstrainedTriangulation& mesh, const Ids& regions,
                    std::size_t count, const std::int32_t* segments, const Curves& curves, FillRule rule,
                    Overlaps overlaps) {
  const Tree tree = make_tree(mesh, regions, count);
  Entrances into;
  into.order = tree.order;
  for (const Entry& entry : tree.entries) into.from.push_back(entry.from);
  Coverage(coordinates, mesh, tree).write_steps(segments, curves.of_segments, into);
  Overlap overlap;
  MapLabels labels = label_regions(into, curves, rule, overlap);
  if (overlaps == Overlaps::error && overlap.region < static_cast<std::int32_t>(count)) {
    throw_overlap(mesh, regions, overlap.region, overlap.polygons);
  }
  return labels;
}

}  // namespace flaunay::constrained
