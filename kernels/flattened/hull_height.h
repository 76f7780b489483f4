// How far a point's projection lies below a chord: the one predicate of prune, quickhull and clean-up.
#ifndef FLAUNAY_HULL_HEIGHT_H
#define FLAUNAY_HULL_HEIGHT_H

#include "arithmetic/language.h"
#include "flattened/axes.h"
#include "operations/counters.h"
#include "predicates/planar.h"

BEGIN_SHARED

// With h(p) the height of p's projection, and A, B the chord's ends, u_A < u_B: positive iff p lies strictly below
// the chord, in a floating-point value that is also good to rank points by. For the cut at q,
//   depth = (A_s - q)^2 (B_u - u) + (B_s - q)^2 (u - A_u) + (B_u - A_u) ((u - A_u)(B_u - u) - (s - q)^2):
// the term in u^2 of the projection is replaced by its difference from the chord's own, which cancels nothing. For a
// planar hull the squares are plain values and the quadratic term in u is absent. For one chord and one u, depth never
// grows with the height of p, rounding included: of points with equal u, none lower has a smaller depth.
//
// Each of the four terms is a product of at most five rounded factors and sums; with unit roundoff e = 2^-53 its
// relative error is below 6e(1 + 5e), the three additions add 3e of the sum of magnitudes. So
// |depth - exact| <= 10 e * magnitude with room for rounding the bound itself, where magnitude is the computed sum
// of the terms' magnitudes: HULL_DEPTH_BOUND. Nothing underflows: see docs/exactness.md.

// A point (s, u) as it is projected: (h, u), h = (s - q)^2 being the height but for what depends on u alone; for a
// planar hull s - q, q being any height near by. Rounded.
static inline double2 project(double2 p, double q, int planar) {
  const double across = p.x - q;
  return VECTOR(double2, planar ? across : across * across, p.y);
}

// (depth, magnitude). a, b, p projected.
static inline double2 hull_depth(double2 a, double2 b, double2 p, int planar) {
  const double to_b = b.y - p.y;
  const double from_a = p.y - a.y;
  const double length = b.y - a.y;
  const double ta = a.x * to_b;
  const double tb = b.x * from_a;
  const double tu = planar ? 0.0 : length * (from_a * to_b);
  const double tp = length * p.x;
  return VECTOR(double2, ((ta + tb) + tu) - tp, ((fabs(ta) + fabs(tb)) + fabs(tu)) + fabs(tp));
}

// The exact sign of depth for the cut at q: bu * pu * (bu - pu) + pu * (bs^2 - as^2) - bu * (ps^2 - as^2), where u is
// relative to a and s to q. a, b, p in the frame (s, u).
OUT_OF_LINE static inline int depth_by_expansions(double2 a, double2 b, double2 p, double q) {
  const double2 bu = two_sum(b.y, -a.y);
  const double2 pu = two_sum(p.y, -a.y);
  expansion sum;
  sum.size = 0;
  for (int term = 0; term < 3; ++term) {
    expansion product;
    double factor[3];
    const double2 u = term == 0 ? pu : bu;
    const double sign = term == 1 ? -1.0 : 1.0;
    product.size = 0;
    expansion_add(&product, sign * u.y);
    expansion_add(&product, sign * u.x);
    const double2 c = term == 0 ? b : p;
    for (int f = 0; f < 2; ++f) {
      double2 difference;
      factor[2] = 0.0;
      if (term == 2) {
        difference = f == 0 ? pu : two_sum(b.y, -p.y);
      } else if (f == 0) {
        difference = two_sum(c.x, -a.x);
      } else {
        // c_s - a_s + 2 (a_s - q) = c_s + a_s - 2q
        difference = two_sum(c.x, a.x);
        factor[2] = -2.0 * q;
      }
      factor[0] = difference.x;
      factor[1] = difference.y;
      expansion_multiply(&product, factor, 3);
    }
    for (int i = 0; i < product.size; ++i) {
      expansion_add(&sum, product.part[i]);
    }
    expansion_compress(&sum);
  }
  return expansion_sign(&sum);
}

// The sign in integers below 2^NARROW_BITS or 2^WIDE_BITS, of pu * (bs^2 - as^2 + bu^2) - bu * (ps^2 - as^2 + pu^2):
// the sums of squares are below 2^63, or 2^125.
static inline int depth_narrow(int64 as, int64 bs, int64 bu, int64 ps, int64 pu) {
  return sign_of_128(
      difference_128(product_128(pu, bs * bs - as * as + bu * bu), product_128(bu, ps * ps - as * as + pu * pu)));
}

static inline integer256 depth_term(int64 u, int64 as, int64 ps, int64 pu) {
  return product_256(widened(u),
                     sum_128(difference_128(product_128(ps, ps), product_128(as, as)), product_128(pu, pu)));
}

static inline int depth_wide(int64 as, int64 bs, int64 bu, int64 ps, int64 pu) {
  return sign_of_256(sum_256(depth_term(pu, as, bs, bu), depth_term(-bu, as, ps, pu)));
}

OUT_OF_LINE static inline int depth_exact(double2 a, double2 b, double2 p, double q) {
  const double2 as = two_sum(a.x, -q);
  const double2 bs = two_sum(b.x, -q);
  const double2 ps = two_sum(p.x, -q);
  const double2 bu = two_sum(b.y, -a.y);
  const double2 pu = two_sum(p.y, -a.y);
  const double largest =
      larger_magnitude(larger_magnitude(as.x, larger_magnitude(bs.x, ps.x)), larger_magnitude(bu.x, pu.x));
  if (largest == 0.0) return 0;
  for (int bits = NARROW_BITS; bits <= WIDE_BITS; bits += WIDE_BITS - NARROW_BITS) {
    const double factor = unit_factor(largest, bits);
    int64 asi, bsi, bui, psi, pui;
    if (is_integer(as, factor, &asi) & is_integer(bs, factor, &bsi) & is_integer(ps, factor, &psi) &
        is_integer(bu, factor, &bui) & is_integer(pu, factor, &pui))
      return bits == NARROW_BITS ? depth_narrow(asi, bsi, bui, psi, pui) : depth_wide(asi, bsi, bui, psi, pui);
  }
  return depth_by_expansions(a, b, p, q);
}

// The exact sign of depth, a, b, p in the frame (s, u).
static inline int hull_depth_sign(double2 a, double2 b, double2 p, double q, int planar) {
  return planar ? orient_exact(a, b, p) : depth_exact(a, b, p, q);
}

// Whether, of two points with equal u, p projects strictly lower than v; equal projections (mirror images in
// the cut line) count as lower if p has the smaller s. Exact.
static inline int is_lower(double2 p, double2 v, double q, int planar) {
  if (planar) return p.x < v.x;
  const int ps = sign_of(p.x - q);
  const int vs = sign_of(v.x - q);
  if (ps * vs >= 0) return ps + vs < 0 ? p.x > v.x : p.x < v.x;
  // On different sides: the nearer one, by the sign of p_s + v_s - 2q.
  const int side = sign_of_sum(p.x, v.x, -2.0 * q);
  return ps < 0 ? side >= 0 : side < 0;
}

// A height above which nothing can be below the chord from a to b: a chord of length l between heights h and k stays
// below max(h, k) + l^2 / 4. Rounded up, and by more than depth's error. a, b projected.
#define BAND_SLACK (1.0 + 0x1p-20)
static inline double chord_band(double2 a, double2 b, int planar) {
  const double height = a.x > b.x ? a.x : b.x;
  const double along = b.y - a.y;
  return planar ? height : BAND_SLACK * (height + 0.25 * along * along);
}

#ifdef FLAUNAY_COUNT
// From here on each call counts. Callers have COUNTERS.
#define project(p, q, planar) (COUNT(HULL, ARITHMETIC, PROJECT_OPERATIONS), project(p, q, planar))
#define hull_depth(a, b, p, planar) (COUNT(HULL, DEPTH, 1), hull_depth(a, b, p, planar))
#endif

END_SHARED

#endif
