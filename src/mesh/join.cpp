#include "mesh/join.hpp"

#include <algorithm>
#include <utility>

namespace flaunay::mesh {
namespace {

// Adds arrays of parts, all threads one part each.
template <typename Result>
class Joining {
 public:
  Joining(host::Runtime& runtime, const std::vector<Group>& groups, std::vector<Result>& parts,
          Joined<Result>& joined)
      : result(joined.result),
        runtime_(runtime),
        group_(&groups[joined.groups]),
        parts_(parts),
        is_first_(joined.groups == 0),
        times_as_many_(static_cast<double>(groups.size()) /
                       static_cast<double>(joined.groups + parts.size())) {
    joined.groups += parts.size();
  }

  // The number of rows before the rows of each part. first: the number of rows that exist already.
  template <typename Count>
  std::vector<std::size_t> before(std::size_t first, const Count& count) const {
    std::vector<std::size_t> sums(parts_.size() + 1, first);
    for (std::size_t k = 0; k < parts_.size(); ++k) sums[k + 1] = sums[k] + count(parts_[k]);
    return sums;
  }
  template <typename T, typename Base>
  std::vector<std::size_t> before(std::vector<T> Base::*array, std::size_t columns) const {
    return before((result.*array).size() / columns,
                  [&](const Result& part) { return (part.*array).size() / columns; });
  }

  // change(values, i, k): the new value for value i of part k.
  template <typename T, typename Base, typename Change>
  void array(std::vector<T> Base::*array, const Change& change) {
    const std::vector<std::size_t> first = before(array, 1);
    std::vector<T>& all = result.*array;
    if (first.back() == all.size()) return;
    // A little more than all parts will have, if they are like these.
    if (first.back() > all.capacity())
      runtime_.reserve(all,
                       static_cast<std::size_t>(1.02 * times_as_many_ * static_cast<double>(first.back())));
    all.resize(first.back());
    runtime_.share(parts_.size(), [&](std::size_t k) {
      std::vector<T> from = std::move(parts_[k].*array);
      T* const to = all.data() + first[k];
      for (std::size_t i = 0; i < from.size(); ++i) to[i] = change(from, i, k);
    });
  }
  template <typename T, typename Base>
  void array(std::vector<T> Base::*values) {
    array(values, [](const std::vector<T>& from, std::size_t i, std::size_t) { return from[i]; });
  }
  // Numbers of rows of other arrays, or -1. base: how many rows the parts before have.
  template <typename Base>
  void indices(std::vector<std::int32_t> Base::*values, const std::vector<std::size_t>& base) {
    array(values, [&](const std::vector<std::int32_t>& from, std::size_t i, std::size_t k) {
      return from[i] < 0 ? from[i] : from[i] + static_cast<std::int32_t>(base[k]);
    });
  }
  // Offsets of rows: each part has one more than sets.
  template <typename T, typename Base>
  void offsets(std::vector<T> Base::*values) {
    std::vector<T>& all = result.*values;
    if (is_first_) all.assign(1, 0);
    for (const Result& part : parts_) {
      const std::vector<T>& own = part.*values;
      const T base = all.back();
      for (std::size_t i = 1; i < own.size(); ++i) all.push_back(base + own[i]);
    }
  }

  // Joins the arrays of triangulations. Returns how many triangles precede each part.
  std::vector<std::size_t> triangulation() {
    const std::vector<std::size_t> triangles = before(&Triangulation::triangles, 3);
    std::vector<std::size_t> points, corners;
    for (std::size_t k = 0; k < parts_.size(); ++k) points.push_back(group_[k].first_point);
    for (const std::size_t t : triangles) corners.push_back(3 * t);
    indices(&Triangulation::triangles, points);
    indices(&Triangulation::neighbors, triangles);
    indices(&Triangulation::halfedges, corners);
    indices(&Triangulation::hull, points);
    indices(&Triangulation::representatives, points);
    array(&Triangulation::areas);
    offsets(&Triangulation::triangle_offsets);
    offsets(&Triangulation::hull_offsets);
    statistics();
    return triangles;
  }

  Result& result;

 private:
  void statistics() {
    Statistics& all = result.statistics;
    all.device = parts_[0].statistics.device;
    const std::size_t workers = std::min(runtime_.threads(), parts_.size());
    for (const Result& part : parts_) {
      const Statistics& own = part.statistics;
      all.points += own.points;
      all.duplicates += own.duplicates;
      all.triangles += own.triangles;
      all.hull_vertices += own.hull_vertices;
      all.undecided += own.undecided;
      all.device_bytes_peak = std::max(all.device_bytes_peak, workers * own.device_bytes_peak);
    }
  }

  host::Runtime& runtime_;
  const Group* group_;  // of the first part
  std::vector<Result>& parts_;
  bool is_first_;
  double times_as_many_;  // rows of all groups as of those that are joined with these parts
};

}  // namespace

void join(host::Runtime& runtime, const std::vector<Group>& groups, std::vector<Triangulation>& parts,
          Joined<Triangulation>& joined) {
  Joining<Triangulation>(runtime, groups, parts, joined).triangulation();
}

void join(host::Runtime& runtime, const std::vector<Group>& groups,
          std::vector<ConstrainedTriangulation>& parts, Joined<ConstrainedTriangulation>& joined) {
  using Part = ConstrainedTriangulation;
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < parts.size(); ++k) points.push_back(groups[joined.groups + k].first_point);
  Joining<Part> joining(runtime, groups, parts, joined);
  const std::vector<std::size_t> segments = joining.before(&Part::piece_edges, 2),
                                 edges = joining.before(&Part::constraint_edges, 2);
  const auto regions = joining.before(joined.regions, [](const Part& part) {
    return part.regions.empty() ? 0 : *std::max_element(part.regions.begin(), part.regions.end()) + 1;
  });
  joined.regions = regions.back();
  joining.triangulation();
  joining.indices(&Part::constraint_edges, points);
  joining.indices(&Part::edge_segments, segments);
  joining.array(&Part::constrained);
  joining.array(&Part::depths);
  joining.indices(&Part::regions, regions);
  joining.array(&Part::edge_markers);
  joining.array(&Part::vertex_markers);
  // Pieces without edges have the range from 0 to 0.
  joining.array(&Part::piece_edges, [&](const std::vector<std::int32_t>& from, std::size_t i, std::size_t k) {
    return from[i | 1] == 0 ? 0 : from[i] + static_cast<std::int32_t>(edges[k]);
  });
  joining.offsets(&Part::piece_offsets);
  joining.offsets(&Part::added_offsets);
}

}  // namespace flaunay::mesh
