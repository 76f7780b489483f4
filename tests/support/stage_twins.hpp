// Plain sequential twins of the stages of src/flattened: what each should hand on, by the shortest way that
// is obviously right, in exact integer arithmetic. Shares no code with src/ or kernels/. A twin that meets
// what cannot be throws std::logic_error.
#pragma once

#include <CL/cl.h>
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace flaunay::testing {

// -----------------------------------------------------------------------------------------------------------
// Exact points

template <typename Integer>
int sign_of(const Integer& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

template <typename Integer>
struct Place {
  Integer x, y;
};

/// (b - a) x (c - a)
template <typename Integer>
Integer cross(const Place<Integer>& a, const Place<Integer>& b, const Place<Integer>& c) {
  return Integer((b.x - a.x) * (c.y - a.y)) - Integer((b.y - a.y) * (c.x - a.x));
}

/// The cut of a region, or one of the two planar hulls: how s (across) and u (along) come from x and y.
struct Frame {
  int axis = 0;  ///< 0: s = x, u = y. 1: s = y, u = -x. 2: s = y, u = x. 3: s = -y, u = -x
  double q = 0;  ///< the cut line is s = q
  bool planar() const { return axis >= 2; }
  double s(const cl_double2& p) const { return axis == 0 ? p.s[0] : axis == 3 ? -p.s[1] : p.s[1]; }
  double u(const cl_double2& p) const { return axis == 0 ? p.s[1] : axis == 2 ? p.s[0] : -p.s[0]; }
};

/// Where a point's projection lies: the hulls are those of (u, h).
template <typename Integer>
struct Projected {
  int id;
  Integer u, h, s;
  bool operator<(const Projected& other) const {
    return u != other.u ? u < other.u : h != other.h ? h < other.h : s < other.s;
  }
};

/// Points by id, as integers: all multiplied by one power of two, which changes no sign.
class ExactPoints {
  __extension__ using Int128 = __int128;

  /// Coordinates below 2^27: heights are below 2^58, in_circle below 2^118.
  template <typename Function>
  auto visit(const Function& function) const {
    return narrow_ ? function(narrow_places_) : function(wide_);
  }

 public:
  explicit ExactPoints(const std::vector<cl_double2>& points) : doubles_(points) {
    int unit = std::numeric_limits<int>::max();
    for (const cl_double2& p : points) {
      for (const double c : {p.s[0], p.s[1]}) {
        int exponent = 0;
        if (std::frexp(c, &exponent) != 0) unit = std::min(unit, exponent - 53);
      }
    }
    unit_ = unit == std::numeric_limits<int>::max() ? 0 : unit;
    mp_bitcnt_t zeros = std::numeric_limits<mp_bitcnt_t>::max();
    for (const cl_double2& p : points) {
      wide_.push_back({exact(p.s[0]), exact(p.s[1])});
      for (const mpz_class* c : {&wide_.back().x, &wide_.back().y}) {
        if (*c != 0) zeros = std::min(zeros, mpz_scan1(c->get_mpz_t(), 0));
      }
    }
    if (zeros == std::numeric_limits<mp_bitcnt_t>::max()) zeros = 0;
    unit_ += static_cast<int>(zeros);
    narrow_ = true;
    for (Place<mpz_class>& p : wide_) {
      p.x >>= zeros;
      p.y >>= zeros;
      narrow_ &= mpz_sizeinbase(p.x.get_mpz_t(), 2) <= 27 && mpz_sizeinbase(p.y.get_mpz_t(), 2) <= 27;
    }
    if (narrow_) {
      for (const Place<mpz_class>& p : wide_) narrow_places_.push_back({p.x.get_si(), p.y.get_si()});
    }
  }

  std::size_t size() const { return doubles_.size(); }
  const cl_double2& operator[](int id) const { return doubles_[static_cast<std::size_t>(id)]; }

  /// 1: a, b, c turn left.
  int orient(int a, int b, int c) const {
    return visit([&](const auto& p) { return sign_of(cross(p[a], p[b], p[c])); });
  }

  /// 1: d is inside the circle of the counter-clockwise a, b, c.
  int in_circle(int a, int b, int c, int d) const {
    return visit([&](const auto& p) {
      using Integer = std::decay_t<decltype(p[0].x)>;
      const auto lift = [&](int i) {
        return Integer(Integer((p[i].x - p[d].x) * (p[i].x - p[d].x)) +
                       Integer((p[i].y - p[d].y) * (p[i].y - p[d].y)));
      };
      return sign_of(Integer(lift(a) * cross(p[d], p[b], p[c]) + lift(b) * cross(p[d], p[c], p[a]) +
                             lift(c) * cross(p[d], p[a], p[b])));
    });
  }

  /// 1: the projection of p lies strictly below the chord from that of a to that of b.
  int depth_sign(const Frame& frame, int a, int b, int p) const {
    return visit([&](const auto& places) {
      const auto q = exact_q(frame.q, places);
      const auto pa = project(places, frame, q, a);
      const auto pb = project(places, frame, q, b);
      const auto pp = project(places, frame, q, p);
      return -sign_of(turn(pa, pb, pp));
    });
  }

  /// Whether, of two points with equal u, p projects lower than v: nearer to the line; mirror images by
  /// smaller s.
  bool is_lower(const Frame& frame, int p, int v) const {
    return visit([&](const auto& places) {
      const auto q = exact_q(frame.q, places);
      return project(places, frame, q, p) < project(places, frame, q, v);
    });
  }

  /// Of each u the lowest projection (of mirror images the one of smaller s), by u.
  std::vector<int> lowest_by_u(const Frame& frame, const std::vector<int>& ids) const {
    return visit([&](const auto& places) {
      std::vector<int> lowest;
      for (const auto& p : lowest_projections(places, frame, ids)) lowest.push_back(p.id);
      return lowest;
    });
  }

  /// The strict lower hull of the projections, by u: Andrew's monotone chain.
  std::vector<int> lower_hull(const Frame& frame, const std::vector<int>& ids) const {
    return visit([&](const auto& places) {
      using Integer = std::decay_t<decltype(places[0].x)>;
      std::vector<Projected<Integer>> chain;
      for (const auto& p : lowest_projections(places, frame, ids)) {
        while (chain.size() >= 2 && turn(chain[chain.size() - 2], chain.back(), p) <= 0) chain.pop_back();
        chain.push_back(p);
      }
      std::vector<int> hull;
      for (const auto& p : chain) hull.push_back(p.id);
      return hull;
    });
  }

  /// Compares the directions from m to f and to g, none of them null, by their angle counter-clockwise from
  /// the direction from m to `from`: negative, 0, positive. An id of -1 is the direction of -u, one of -2
  /// that of +u.
  int compare_angles(const Frame& frame, int m, int from, int f, int g) const {
    return visit([&](const auto& places) {
      using Integer = std::decay_t<decltype(places[0].x)>;
      const auto direction = [&](int id) {
        Place<Integer> d{0, 0};
        if (id >= 0) {
          d = {places[id].x - places[m].x, places[id].y - places[m].y};
        } else {
          const int along = id == -1 ? -1 : 1;
          (frame.axis == 0 ? d.y : d.x) = frame.axis == 1 ? -along : along;
        }
        return d;
      };
      const Place<Integer> zero{0, 0}, start = direction(from), df = direction(f), dg = direction(g);
      // 0: the same direction, 1: less than half a turn, 2: half a turn, 3: more.
      const auto part = [&](const Place<Integer>& d) {
        const int turned = sign_of(cross(zero, start, d));
        const Integer along = Integer(start.x * d.x) + Integer(start.y * d.y);
        return turned > 0 ? 1 : turned < 0 ? 3 : along > 0 ? 0 : 2;
      };
      if (part(df) != part(dg)) return part(df) - part(dg);
      return -sign_of(cross(zero, df, dg));
    });
  }

  /// The sign of s - q.
  int side(const Frame& frame, int id) const {
    const double s = frame.s(doubles_[static_cast<std::size_t>(id)]);
    return s < frame.q ? -1 : s > frame.q ? 1 : 0;
  }

 private:
  mpz_class exact(double value) const {
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    mpz_class integer = std::ldexp(fraction, 53);
    const int shift = exponent - 53 - unit_;
    if (fraction == 0) return 0;
    if (shift >= 0) {
      integer <<= static_cast<mp_bitcnt_t>(shift);
    } else {
      integer >>= static_cast<mp_bitcnt_t>(-shift);  // exact: a coordinate, so a multiple of the unit
    }
    return integer;
  }
  Int128 exact_q(double q, const std::vector<Place<Int128>>&) const { return exact(q).get_si(); }
  mpz_class exact_q(double q, const std::vector<Place<mpz_class>>&) const { return exact(q); }

  template <typename Integer>
  static Projected<Integer> project(const std::vector<Place<Integer>>& places, const Frame& frame,
                                    const Integer& q, int id) {
    const Place<Integer>& p = places[static_cast<std::size_t>(id)];
    const Integer s = frame.axis == 0 ? p.x : frame.axis == 3 ? Integer(-p.y) : p.y;
    const Integer u = frame.axis == 0 ? p.y : frame.axis == 2 ? p.x : Integer(-p.x);
    const Integer across = s - q;
    const Integer h = frame.planar() ? s : Integer(Integer(across * across) + Integer(u * u));
    return {id, u, h, s};
  }

  template <typename Integer>
  static Integer turn(const Projected<Integer>& a, const Projected<Integer>& b, const Projected<Integer>& c) {
    return cross(Place<Integer>{a.u, a.h}, Place<Integer>{b.u, b.h}, Place<Integer>{c.u, c.h});
  }

  template <typename Integer>
  std::vector<Projected<Integer>> lowest_projections(const std::vector<Place<Integer>>& places,
                                                     const Frame& frame, const std::vector<int>& ids) const {
    const Integer q = exact_q(frame.q, places);
    std::vector<Projected<Integer>> all;
    for (const int id : ids) all.push_back(project(places, frame, q, id));
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.u == b.u; }),
              all.end());
    return all;
  }

  std::vector<cl_double2> doubles_;
  int unit_ = 0;
  bool narrow_ = false;
  std::vector<Place<mpz_class>> wide_;
  std::vector<Place<Int128>> narrow_places_;
};

// -----------------------------------------------------------------------------------------------------------
// Ingest

struct IngestTwin {
  int shift = 0;  ///< all coordinates are multiplied by 2^shift
  int bits = 0;   ///< from the leading bit of the largest coordinate to the lowest bit of any
  std::vector<cl_double2> points;
  std::vector<cl_int> source, set_of_id, set_offsets, y_order, representatives;
};

inline IngestTwin ingest_twin(const std::vector<double>& coordinates,
                              const std::vector<std::size_t>& offsets) {
  IngestTwin twin;
  const std::size_t n = coordinates.size() / 2;
  // Exponents of the leading bit and of the lowest one, over all coordinates.
  int largest = std::numeric_limits<int>::min(), lowest = std::numeric_limits<int>::max();
  for (const double c : coordinates) {
    if (c == 0) continue;
    int exponent = 0;
    const mpz_class mantissa(std::ldexp(std::frexp(c, &exponent), 53));
    largest = std::max(largest, exponent - 1);
    lowest = std::min(lowest, exponent - 53 + static_cast<int>(mpz_scan1(mantissa.get_mpz_t(), 0)));
  }
  if (lowest <= largest) twin.bits = largest - lowest + 1;
  if (lowest <= largest && largest > 249) twin.shift = 249 - largest;
  if (lowest <= largest && lowest < -255) twin.shift = -255 - lowest;

  std::vector<int> set(n), order(n);
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    std::fill(set.begin() + static_cast<std::ptrdiff_t>(offsets[s]),
              set.begin() + static_cast<std::ptrdiff_t>(offsets[s + 1]), static_cast<int>(s));
  }
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](int i) {
    return std::make_tuple(set[static_cast<std::size_t>(i)], coordinates[2 * static_cast<std::size_t>(i)],
                           coordinates[2 * static_cast<std::size_t>(i) + 1]);
  };
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return place(i) != place(j) ? place(i) < place(j) : i < j; });
  twin.representatives.resize(n);
  twin.set_offsets.assign(offsets.size(), 0);
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 0 || place(order[k]) != place(order[k - 1])) {
      const auto [s, x, y] = place(order[k]);
      // Adding 0 makes +0 of -0.
      twin.points.push_back({{std::ldexp(x, twin.shift) + 0.0, std::ldexp(y, twin.shift) + 0.0}});
      twin.source.push_back(order[k]);
      twin.set_of_id.push_back(s);
    }
    twin.representatives[static_cast<std::size_t>(order[k])] = twin.source.back();
  }
  for (std::size_t s = 0; s < offsets.size(); ++s) {
    twin.set_offsets[s] = static_cast<cl_int>(
        std::lower_bound(twin.set_of_id.begin(), twin.set_of_id.end(), static_cast<int>(s)) -
        twin.set_of_id.begin());
  }
  twin.y_order.resize(twin.points.size());
  std::iota(twin.y_order.begin(), twin.y_order.end(), 0);
  std::sort(twin.y_order.begin(), twin.y_order.end(), [&](int i, int j) {
    const auto key = [&](int id) {
      const auto k = static_cast<std::size_t>(id);
      return std::make_tuple(twin.set_of_id[k], twin.points[k].s[1], twin.points[k].s[0]);
    };
    return key(i) < key(j);
  });
  return twin;
}

// -----------------------------------------------------------------------------------------------------------
// Regions

struct Corner {
  int before, vertex, after;
  bool operator==(const Corner& o) const {
    return before == o.before && vertex == o.vertex && after == o.after;
  }
  bool operator<(const Corner& o) const {
    return std::tie(vertex, before, after) < std::tie(o.vertex, o.before, o.after);
  }
};

/// Internal points in the order of x and of y, and corners, as a multiset: sorted.
struct Region {
  std::vector<int> x_list, y_list;
  std::vector<Corner> corners;
  bool operator==(const Region& o) const {
    return x_list == o.x_list && y_list == o.y_list && corners == o.corners;
  }
  /// Internal points and border vertices, each once.
  std::vector<int> points() const {
    std::set<int> all(x_list.begin(), x_list.end());
    for (const Corner& corner : corners) all.insert(corner.vertex);
    return {all.begin(), all.end()};
  }
};

/// The regions of a level and those that retire, in order.
struct Regions {
  std::vector<Region> open, retired;
  void add(Region region) {
    std::sort(region.corners.begin(), region.corners.end());
    if (!region.x_list.empty()) {
      open.push_back(std::move(region));
    } else if (!region.corners.empty()) {
      retired.push_back(std::move(region));
    }
  }
};

/// The convex hull of ascending ids with the points on its edges, counter-clockwise from the smallest id;
/// collinear ids as they are.
inline std::vector<int> border_twin(const ExactPoints& points, const std::vector<int>& ids, bool& collinear) {
  collinear = true;
  for (std::size_t i = 2; i < ids.size(); ++i) collinear &= points.orient(ids[0], ids[1], ids[i]) == 0;
  if (collinear) return ids;
  const auto half = [&](const std::vector<int>& in_order) {
    std::vector<int> chain;
    for (const int id : in_order) {
      while (chain.size() >= 2 && points.orient(chain[chain.size() - 2], chain.back(), id) < 0)
        chain.pop_back();
      chain.push_back(id);
    }
    return chain;
  };
  std::vector<int> border = half(ids);
  const std::vector<int> upper = half({ids.rbegin(), ids.rend()});
  border.insert(border.end(), upper.begin() + 1, upper.end() - 1);
  return border;
}

struct BordersTwin {
  std::vector<int> hull;
  std::vector<std::size_t> hull_offsets{0};
  std::size_t triangles = 0;
  Regions regions;
  std::vector<bool> on_border;  ///< by id; collinear sets have nothing else
};

inline BordersTwin borders_twin(const ExactPoints& points, const std::vector<cl_int>& set_offsets,
                                const std::vector<cl_int>& y_order) {
  BordersTwin twin;
  twin.on_border.assign(points.size(), false);
  for (std::size_t s = 0; s + 1 < set_offsets.size(); ++s) {
    std::vector<int> ids(static_cast<std::size_t>(set_offsets[s + 1] - set_offsets[s]));
    std::iota(ids.begin(), ids.end(), set_offsets[s]);
    bool collinear = false;
    const std::vector<int> hull = border_twin(points, ids, collinear);
    const std::size_t h = hull.size();
    for (const int id : hull) twin.on_border[static_cast<std::size_t>(id)] = true;
    Region region;
    if (!collinear) {
      twin.triangles += 2 * ids.size() - 2 - h;
      for (std::size_t k = 0; k < h; ++k)
        region.corners.push_back({hull[(k + h - 1) % h], hull[k], hull[(k + 1) % h]});
      const auto internal = [&](int id) { return !twin.on_border[static_cast<std::size_t>(id)]; };
      std::copy_if(ids.begin(), ids.end(), std::back_inserter(region.x_list), internal);
      std::copy_if(y_order.begin() + set_offsets[s], y_order.begin() + set_offsets[s + 1],
                   std::back_inserter(region.y_list), internal);
    }
    twin.regions.add(std::move(region));
    twin.hull.insert(twin.hull.end(), hull.begin(), hull.end());
    twin.hull_offsets.push_back(twin.hull.size());
  }
  return twin;
}

/// alternate_axis: 0 or 1, or -1 for the longer interquartile range (as rounded to double).
inline Frame cut_twin(const ExactPoints& points, const Region& region, int alternate_axis) {
  const std::size_t count = region.x_list.size();
  Frame frame;
  frame.axis = alternate_axis;
  if (alternate_axis < 0) {
    const double x_range = points[region.x_list[3 * count / 4]].s[0] - points[region.x_list[count / 4]].s[0];
    const double y_range = points[region.y_list[3 * count / 4]].s[1] - points[region.y_list[count / 4]].s[1];
    frame.axis = y_range > x_range ? 1 : 0;
  }
  frame.q = frame.axis == 0 ? points[region.x_list[count / 2]].s[0] : points[region.y_list[count / 2]].s[1];
  return frame;
}

/// The border vertices of smallest and of largest u, the lowest of each.
inline std::pair<int, int> ends_twin(const ExactPoints& points, const Frame& frame, const Region& region) {
  std::vector<int> vertices;
  for (const Corner& corner : region.corners) vertices.push_back(corner.vertex);
  const std::vector<int> by_u = points.lowest_by_u(frame, vertices);
  return {by_u.front(), by_u.back()};
}

// -----------------------------------------------------------------------------------------------------------
// Border merge and split

/// What the borders that were merged had to offer.
struct MergeCounts {
  std::array<std::size_t, 4> corners_by_parts{};  ///< corners on the path by how many new ones they gave
  std::size_t path_leaves_region = 0;             ///< corners with a path edge outside the wedge
  std::size_t pinch_points = 0;                   ///< vertices with several corners in one region
  std::size_t path_on_border = 0;                 ///< corners with a path edge that is a border edge
};

/// The two children of a region (left, right), which is cut by the line of `frame` and by `path`, the ids by
/// u.
inline std::array<Region, 2> merge_twin(const ExactPoints& points, const Region& region, const Frame& frame,
                                        const std::vector<int>& path, MergeCounts& counts) {
  constexpr int kDown = -1, kUp = -2;  // of compare_angles
  std::array<Region, 2> children;
  std::map<int, std::size_t> place;
  for (std::size_t k = 0; k < path.size(); ++k) place[path[k]] = k;
  const auto side_of = [&](int id) {
    const int side = points.side(frame, id);
    if (side == 0) throw std::logic_error("a point on the line is not on the path");
    return side < 0 ? 0 : 1;
  };

  for (const bool by_y : {false, true}) {
    for (const int id : by_y ? region.y_list : region.x_list) {
      if (place.count(id) != 0) continue;
      Region& child = children[side_of(id)];
      (by_y ? child.y_list : child.x_list).push_back(id);
    }
  }
  const std::set<int> internal(region.x_list.begin(), region.x_list.end());
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (internal.count(path[k]) == 0) continue;
    if (k == 0 || k + 1 == path.size()) throw std::logic_error("an internal point at the path's end");
    children[0].corners.push_back({path[k - 1], path[k], path[k + 1]});
    children[1].corners.push_back({path[k + 1], path[k], path[k - 1]});
  }

  std::map<int, int> corners_of;
  for (const Corner& corner : region.corners) {
    const int m = corner.vertex;
    if (++corners_of[m] == 2) ++counts.pinch_points;
    const auto found = place.find(m);
    if (found == place.end()) {
      children[side_of(m)].corners.push_back(corner);
      continue;
    }
    const std::size_t k = found->second;
    const int previous = k > 0 ? path[k - 1] : kDown;
    const int next = k + 1 < path.size() ? path[k + 1] : kUp;
    const int after = corner.after;
    // The distinct directions among the four, counter-clockwise from `after`, each with its point.
    std::vector<int> around;
    for (const int id : {after, corner.before, previous, next}) {
      const auto same = std::find_if(around.begin(), around.end(), [&](int other) {
        return points.compare_angles(frame, m, after, id, other) == 0;
      });
      if (same == around.end()) {
        around.push_back(id);
      } else if (*same < 0) {
        *same = id;
      } else if (id >= 0 && *same != id) {
        throw std::logic_error("two edges of one direction");
      }
    }
    std::sort(around.begin(), around.end(),
              [&](int f, int g) { return points.compare_angles(frame, m, after, f, g) < 0; });
    const int size = static_cast<int>(around.size());
    const auto index_of = [&](int id) {
      return static_cast<int>(
          std::find_if(around.begin(), around.end(),
                       [&](int other) { return points.compare_angles(frame, m, after, id, other) == 0; }) -
          around.begin());
    };
    const int before_at = index_of(corner.before), previous_at = index_of(previous), next_at = index_of(next);
    if (before_at == 0) throw std::logic_error("an empty wedge");
    counts.path_leaves_region +=
        (previous >= 0 && previous_at > before_at) || (next >= 0 && next_at > before_at);
    counts.path_on_border +=
        previous == corner.before || next == corner.before || previous == after || next == after;
    // Every arc between neighbouring directions is in the wedge or not, and left of the path
    // (counter-clockwise from `next` to `previous`) or right of it.
    for (int arc = 0; arc < before_at; ++arc) {
      const bool left = (arc - next_at + size) % size < (previous_at - next_at + size) % size;
      if (around[arc] < 0 || around[arc + 1] < 0) throw std::logic_error("a line's end in a wedge");
      children[left ? 0 : 1].corners.push_back({around[arc + 1], m, around[arc]});
    }
    ++counts.corners_by_parts[static_cast<std::size_t>(before_at)];
  }
  return children;
}

// -----------------------------------------------------------------------------------------------------------
// Triangles of regions

/// How many triangles a region without internal points has: k - 2 for each closed walk of k corners.
inline std::size_t triangle_count_twin(const std::vector<Corner>& corners) {
  std::map<std::pair<int, int>, std::size_t> corner_after;  // by directed edge (before, vertex)
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (!corner_after.emplace(std::make_pair(corners[c].before, corners[c].vertex), c).second) {
      throw std::logic_error("a border edge of two corners");
    }
  }
  std::size_t walks = 0;
  std::vector<bool> seen(corners.size(), false);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    walks += !seen[c];
    for (std::size_t at = c; !seen[at];) {
      seen[at] = true;
      at = corner_after.at({corners[at].vertex, corners[at].after});
    }
  }
  return corners.size() - 2 * walks;
}

/// Empty if the triangles (3 ids each) are a Delaunay triangulation of the region, else what is wrong with
/// them.
inline std::string region_fault(const ExactPoints& points, const std::vector<Corner>& corners,
                                const std::vector<int>& triangles) {
  if (triangles.size() != 3 * triangle_count_twin(corners)) return "wrong number of triangles";
  std::set<int> vertices;
  std::set<std::pair<int, int>> border;
  for (const Corner& corner : corners) {
    vertices.insert(corner.vertex);
    border.insert({corner.vertex, corner.after});
  }
  std::map<std::pair<int, int>, int> apex_of;  // by directed edge
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const int v[3] = {triangles[t], triangles[t + 1], triangles[t + 2]};
    const std::string name =
        " (" + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + ")";
    for (const int id : v) {
      if (vertices.count(id) == 0) return "a vertex that is none of the region's" + name;
    }
    if (points.orient(v[0], v[1], v[2]) <= 0) return "a triangle that is not counter-clockwise" + name;
    for (int j = 0; j < 3; ++j) {
      if (!apex_of.emplace(std::make_pair(v[j], v[(j + 1) % 3]), v[(j + 2) % 3]).second) {
        return "an edge of two triangles on one side" + name;
      }
    }
    // Beyond this size, edges suffice (below), and all circles cost too much.
    if (vertices.size() <= 200) {
      for (const int id : vertices) {
        if (points.in_circle(v[0], v[1], v[2], id) > 0) return "a circle that is not empty" + name;
      }
    }
  }
  for (const std::pair<int, int>& edge : border) {
    if (apex_of.count(edge) == 0) return "a border edge without a triangle";
  }
  for (const auto& [edge, apex] : apex_of) {
    const auto twin = apex_of.find({edge.second, edge.first});
    const bool is_border = border.count(edge) != 0;
    if (is_border == (twin != apex_of.end())) return is_border ? "a border edge inside" : "a hole";
    if (!is_border && points.in_circle(edge.first, edge.second, apex, twin->second) > 0) {
      return "an edge that is not Delaunay";
    }
  }
  return "";
}

// -----------------------------------------------------------------------------------------------------------
// Meshes

/// The twin of half-edge 3t + j, which is opposite to vertex j of triangle t; -1 for none.
inline std::vector<cl_int> twins_twin(const std::vector<cl_int>& triangles) {
  std::map<std::pair<int, int>, cl_int> halfedge_of;
  const auto from = [&](std::size_t h) { return triangles[h / 3 * 3 + (h + 1) % 3]; };
  const auto to = [&](std::size_t h) { return triangles[h / 3 * 3 + (h + 2) % 3]; };
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    if (!halfedge_of.emplace(std::make_pair(from(h), to(h)), static_cast<cl_int>(h)).second) {
      throw std::logic_error("an edge of two triangles on one side");
    }
  }
  std::vector<cl_int> twins;
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    const auto found = halfedge_of.find({to(h), from(h)});
    twins.push_back(found == halfedge_of.end() ? -1 : found->second);
  }
  return twins;
}

}  // namespace flaunay::testing
