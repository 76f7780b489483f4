// Points as integers, by which the twins of the stages decide: sequential, by the shortest way that is
// obviously right. Shares no code with src/ or kernels/.
#pragma once

#include <CL/cl.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace flaunay::testing {

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

}  // namespace flaunay::testing
