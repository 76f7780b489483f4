// A triangulation that changes, and what is known of it from outside: the points that it should have, and the
// rows that its changes tell of. After each batch, both are held against a call on all points.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/dynamic.hpp"

namespace flaunay::testing {

using Corners = std::array<std::int32_t, 3>;

/// From the smallest number on.
inline Corners rotated(const std::int32_t* corners) {
  Corners row{corners[0], corners[1], corners[2]};
  std::rotate(row.begin(), std::min_element(row.begin(), row.end()), row.end());
  return row;
}

inline std::set<Corners> set_of(const std::vector<std::int32_t>& triangles) {
  std::set<Corners> all;
  for (std::size_t t = 0; t < triangles.size(); t += 3) all.insert(rotated(&triangles[t]));
  return all;
}

/// The rows that have triangles.
inline std::map<std::int32_t, Corners> rows_of(const TriangleRows& rows) {
  std::map<std::int32_t, Corners> living;
  for (std::size_t t = 0; t < rows.triangles.size(); t += 3) {
    if (rows.triangles[t] >= 0) living[static_cast<std::int32_t>(t / 3)] = rotated(&rows.triangles[t]);
  }
  return living;
}

/// What a progress callback throws to end a batch, which a Mirror then repeats.
struct Interrupted {};

class Mirror {
 public:
  using Point = std::array<double, 2>;

  Mirror(Triangulator& by, Triangulator& reference, const std::vector<double>& coordinates)
      : reference_(reference), mesh(by, coordinates.data(), coordinates.size() / 2) {
    begin(coordinates);
  }
  /// Segments that cross are split if the options say so; the pieces are then known from the first result.
  Mirror(Triangulator& by, Triangulator& reference, const std::vector<double>& coordinates,
         const std::vector<std::int32_t>& segments, const ConstrainedOptions& options = {})
      : reference_(reference),
        mesh(by, coordinates.data(), coordinates.size() / 2, constraints_of(segments), options) {
    const ConstrainedTriangulation first =
        reference.constrained(coordinates.data(), coordinates.size() / 2, constraints_of(segments), options);
    std::vector<double> all = coordinates;
    all.insert(all.end(), first.added_points.begin(), first.added_points.end());
    begin(all);
    for (const std::int32_t v : first.constraint_edges) ends_.push_back(points.at(v));
    segments_ = first.edge_segments;
  }

  Changes insert(const std::vector<double>& coordinates) {
    const std::size_t first = mesh.numbers();
    Changes changes;
    repeat([&] { changes = mesh.insert(coordinates.data(), coordinates.size() / 2); });
    EXPECT_EQ(changes.first_point, first);
    EXPECT_EQ(changes.representatives.size(), coordinates.size() / 2);
    for (std::size_t i = 0; i < coordinates.size(); i += 2) {
      points[static_cast<std::int32_t>(first + i / 2)] = {coordinates[i] + 0.0, coordinates[i + 1] + 0.0};
    }
    for (std::size_t i = 0; i < changes.representatives.size(); ++i) {
      EXPECT_EQ(changes.representatives[i], first_at(static_cast<std::int32_t>(first + i)));
    }
    apply(changes);
    return changes;
  }
  Changes remove(const std::vector<std::int32_t>& numbers) {
    Changes changes;
    repeat([&] { changes = mesh.remove(numbers.data(), numbers.size()); });
    for (const std::int32_t v : numbers) points.erase(v);
    apply(changes);
    return changes;
  }
  Changes move(const std::vector<std::int32_t>& numbers, const std::vector<double>& coordinates) {
    Changes changes;
    repeat([&] { changes = mesh.move(numbers.data(), coordinates.data(), numbers.size()); });
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      points[numbers[i]] = {coordinates[2 * i] + 0.0, coordinates[2 * i + 1] + 0.0};
    }
    EXPECT_EQ(changes.representatives.size(), numbers.size());
    for (std::size_t i = 0; i < changes.representatives.size(); ++i) {
      EXPECT_EQ(changes.representatives[i], first_at(numbers[i]));
    }
    apply(changes);
    return changes;
  }

  /// Of these points, those that can be removed and moved.
  std::vector<std::int32_t> without_ends(const std::vector<std::int32_t>& numbers) {
    const LivingConstraints edges = mesh.constraints();
    const std::set<std::int32_t> ends(edges.edges.begin(), edges.edges.end());
    std::vector<std::int32_t> free;
    for (const std::int32_t v : numbers) {
      if (ends.count(v) == 0) free.push_back(v);
    }
    return free;
  }

  /// Whether all is as it should be. Only meant for small inputs.
  void check() {
    EXPECT_EQ(mesh.point_count(), points.size());
    // A call on all points, by their numbers.
    std::vector<std::int32_t> numbers, places(mesh.numbers(), -1);
    std::vector<double> coordinates;
    for (const auto& [v, p] : points) {
      EXPECT_TRUE(mesh.has_point(static_cast<std::size_t>(v)));
      places[v] = static_cast<std::int32_t>(numbers.size());
      numbers.push_back(v);
      coordinates.insert(coordinates.end(), p.begin(), p.end());
    }
    const std::vector<double> known = mesh.coordinates();
    ASSERT_EQ(known.size(), 2 * mesh.numbers());
    for (std::size_t i = 0; i < known.size(); i += 2) {
      const auto at = points.find(static_cast<std::int32_t>(i / 2));
      if (at == points.end()) {
        EXPECT_TRUE(std::isnan(known[i]) && std::isnan(known[i + 1]));
        EXPECT_FALSE(mesh.has_point(i / 2));
      } else {
        EXPECT_EQ((Point{known[i], known[i + 1]}), at->second);
      }
    }
    // Constraints are where they were at first, whoever is there now.
    std::map<Point, std::int32_t> first_there;
    for (const auto& [v, p] : points) first_there.emplace(p, places[v]);
    std::vector<std::int32_t> segments;
    for (const Point& end : ends_) {
      ASSERT_EQ(first_there.count(end), 1);
      segments.push_back(first_there.at(end));
    }
    ConstrainedTriangulation expected;
    if (segments.empty()) {
      static_cast<Triangulation&>(expected) = reference_.triangulate(coordinates.data(), numbers.size());
    } else {
      expected = reference_.constrained(coordinates.data(), numbers.size(), constraints_of(segments));
    }
    for (std::int32_t& edge : expected.edge_segments) edge = segments_[edge];
    const auto renumber = [&](std::vector<std::int32_t>& all) {
      for (std::int32_t& v : all) v = numbers[v];
    };
    renumber(expected.triangles);
    renumber(expected.hull);
    renumber(expected.constraint_edges);

    const Triangulation found = mesh.triangulation();
    EXPECT_EQ(set_of(found.triangles), set_of(expected.triangles));
    EXPECT_EQ(found.triangles.size(), expected.triangles.size());
    EXPECT_EQ(mesh.triangle_count(), expected.triangles.size() / 3);
    EXPECT_EQ(found.hull, expected.hull);
    ASSERT_EQ(found.representatives.size(), mesh.numbers());
    for (std::size_t v = 0; v < found.representatives.size(); ++v) {
      const std::int32_t here = places[v];
      EXPECT_EQ(found.representatives[v], here < 0 ? -1 : numbers[expected.representatives[here]]);
    }
    for (std::size_t t = 0; t < found.triangles.size(); t += 3) {
      EXPECT_EQ(rotated(&found.triangles[t]),
                (Corners{found.triangles[t], found.triangles[t + 1], found.triangles[t + 2]}));
    }
    check_neighbors(found.triangles, found.neighbors);

    const TriangleRows rows = mesh.rows();
    EXPECT_EQ(rows.triangles.size(), 3 * mesh.row_count());
    check_neighbors(rows.triangles, rows.neighbors);
    EXPECT_EQ(rows_of(rows), rows_);

    const LivingConstraints edges = mesh.constraints();
    std::map<std::array<std::int32_t, 2>, std::int32_t> found_edges, expected_edges;
    for (std::size_t e = 0; e < edges.segments.size(); ++e) {
      found_edges[{edges.edges[2 * e], edges.edges[2 * e + 1]}] = edges.segments[e];
    }
    EXPECT_EQ(found_edges.size(), edges.segments.size());
    for (std::size_t e = 0; e < expected.edge_segments.size(); ++e) {
      expected_edges[{expected.constraint_edges[2 * e], expected.constraint_edges[2 * e + 1]}] =
          expected.edge_segments[e];
    }
    EXPECT_EQ(found_edges, expected_edges);
    if (!expected_edges.empty()) {
      const std::int32_t end = expected_edges.begin()->first[0];
      EXPECT_THROW(mesh.remove(&end, 1), Error);
    }
  }

 private:
  Triangulator& reference_;

 public:
  DynamicTriangulation mesh;
  std::map<std::int32_t, Point> points;  ///< by number
  /// Whether everything is checked after a batch that was interrupted, which changes nothing but rows.
  bool checks_between = true;

 private:
  static Constraints constraints_of(const std::vector<std::int32_t>& segments) {
    Constraints constraints;
    constraints.segments = segments.data();
    constraints.segment_count = segments.size() / 2;
    return constraints;
  }

  void begin(const std::vector<double>& coordinates) {
    for (std::size_t i = 0; i < coordinates.size(); i += 2) {
      points[static_cast<std::int32_t>(i / 2)] = {coordinates[i] + 0.0, coordinates[i + 1] + 0.0};
    }
    rows_ = rows_of(mesh.rows());
  }

  template <typename Work>
  void repeat(const Work& work) {
    try {
      work();
    } catch (const Interrupted&) {
      if (checks_between) {
        // Known before the rows are there.
        const std::size_t rows = mesh.row_count();
        rows_ = rows_of(mesh.rows());
        EXPECT_EQ(rows, mesh.row_count());
        check();
      }
      EXPECT_NO_THROW(work());
    }
  }

  std::int32_t first_at(std::int32_t v) const {
    for (const auto& [other, p] : points) {
      if (p == points.at(v)) return other;
    }
    return -1;
  }

  void apply(const Changes& changes) {
    ASSERT_EQ(changes.made_corners.size(), 3 * changes.made.size());
    EXPECT_EQ((std::set<std::int32_t>{changes.removed.begin(), changes.removed.end()}).size(),
              changes.removed.size());
    for (const std::int32_t row : changes.removed) EXPECT_EQ(rows_.erase(row), 1) << "row " << row;
    for (std::size_t i = 0; i < changes.made.size(); ++i) {
      EXPECT_TRUE(rows_.emplace(changes.made[i], rotated(&changes.made_corners[3 * i])).second);
    }
  }

  static void check_neighbors(const std::vector<std::int32_t>& triangles,
                              const std::vector<std::int32_t>& neighbors) {
    ASSERT_EQ(triangles.size(), neighbors.size());
    std::map<std::array<std::int32_t, 2>, std::int32_t> row_at;
    for (std::size_t c = 0; c < triangles.size(); ++c) {
      const std::size_t first = c - c % 3;
      if (triangles[c] < 0) continue;
      row_at[{triangles[first + (c + 1) % 3], triangles[first + (c + 2) % 3]}] =
          static_cast<std::int32_t>(c / 3);
    }
    for (std::size_t c = 0; c < triangles.size(); ++c) {
      const std::size_t first = c - c % 3;
      std::int32_t expected = -1;
      if (triangles[c] >= 0) {
        const auto beyond = row_at.find({triangles[first + (c + 2) % 3], triangles[first + (c + 1) % 3]});
        if (beyond != row_at.end()) expected = beyond->second;
      }
      EXPECT_EQ(neighbors[c], expected) << "corner " << c;
    }
  }

  // Per edge of a constraint that there was at first, its ends and its segment.
  std::vector<Point> ends_;
  std::vector<std::int32_t> segments_;
  std::map<std::int32_t, Corners> rows_;
};

}  // namespace flaunay::testing
