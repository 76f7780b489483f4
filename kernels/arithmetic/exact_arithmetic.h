// Error-free transformations and expansions (Dekker 1971; Shewchuk, "Adaptive precision floating-point arithmetic
// and fast robust geometric predicates", 1997). All need IEEE double arithmetic without contraction: every file
// that includes this has FP_CONTRACT off, and call/self_test.cl checks the device. With SPLIT_PRODUCTS, fma is not
// used.
#ifndef FLAUNAY_EXACT_ARITHMETIC_H
#define FLAUNAY_EXACT_ARITHMETIC_H

#include "arithmetic/language.h"

#ifndef FIXED_POINT

// Where C++'s fma is a call, or no instruction at all.
#if defined(__cplusplus) && !defined(__FP_FAST_FMA) && !defined(SPLIT_PRODUCTS)
#define SPLIT_PRODUCTS
#endif

BEGIN_SHARED

// x + y = a + b exactly, x = fl(a + b).
static inline double2 two_sum(double a, double b) {
  const double x = a + b;
  const double b_virtual = x - a;
  const double a_virtual = x - b_virtual;
  return VECTOR(double2, x, (a - a_virtual) + (b - b_virtual));
}

// A sum as of two_sum, for |a| >= |b| or a = 0.
static inline double2 fast_two_sum(double a, double b) {
  const double x = a + b;
  return VECTOR(double2, x, b - (x - a));
}

#ifdef SPLIT_PRODUCTS
// a = x + y, two halves of at most 26 bits each (Veltkamp 1968).
static inline double2 split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double x = c - (c - a);
  return VECTOR(double2, x, a - x);
}

// a * b - x for x = fl(a * b), exactly: no product of halves is rounded (Dekker 1971).
static inline double error_of_product(double a, double b, double x) {
  const double2 p = split(a), q = split(b);
  return p.y * q.y - (((x - p.x * q.x) - p.y * q.x) - p.x * q.y);
}
#else
static inline double error_of_product(double a, double b, double x) { return fma(a, b, -x); }
#endif

// x + y = a * b exactly, x = fl(a * b).
static inline double2 two_product(double a, double b) {
  const double x = a * b;
  return VECTOR(double2, x, error_of_product(a, b, x));
}

static inline int sign_of(double x) { return (x > 0.0) - (x < 0.0); }

// The exact sign of a + b + c.
static inline int sign_of_sum(double a, double b, double c) {
  const double2 ab = two_sum(a, b);
  const double2 low = two_sum(c, ab.y);
  const double2 high = two_sum(low.x, ab.x);
  return high.x != 0.0 ? sign_of(high.x) : high.y != 0.0 ? sign_of(high.y) : sign_of(low.y);
}

// A sum of doubles that do not overlap, smallest first, without zeros; none at all for zero. Compressed, so
// that each component is below half an ulp of the next: with all magnitudes between 2^-1022 and 2^1023 that
// makes 39 components at most (see docs/exactness.md).
#define EXPANSION_CAPACITY 128
#define EXPANSION_COMPRESSED 40
typedef struct {
  int size;
  double part[EXPANSION_CAPACITY];
} expansion;

static inline int expansion_sign(const expansion* e) { return e->size == 0 ? 0 : sign_of(e->part[e->size - 1]); }

// e += b. Grow-expansion with zero elimination.
static inline void expansion_add(expansion* e, double b) {
  double q = b;
  int kept = 0;
  for (int i = 0; i < e->size; ++i) {
    const double2 s = two_sum(q, e->part[i]);
    if (s.y != 0.0) e->part[kept++] = s.y;
    q = s.x;
  }
  if (q != 0.0) e->part[kept++] = q;
  e->size = kept;
}

// Shewchuk's compress: the same value in few components.
static inline void expansion_compress(expansion* e) {
  if (e->size == 0) return;
  int bottom = e->size - 1;
  double q = e->part[bottom];
  for (int i = e->size - 2; i >= 0; --i) {
    const double2 s = fast_two_sum(q, e->part[i]);
    q = s.x;
    if (s.y != 0.0) {
      e->part[bottom--] = s.x;
      q = s.y;
    }
  }
  int top = 0;
  e->part[bottom] = q;
  for (int i = bottom + 1; i < e->size; ++i) {
    const double2 s = fast_two_sum(e->part[i], q);
    q = s.x;
    if (s.y != 0.0) e->part[top++] = s.y;
  }
  e->part[top++] = q;
  e->size = top;
}

// e *= b for every b of a factor of `count` doubles whose sum is meant: e becomes e * (sum of factor).
static inline void expansion_multiply(expansion* e, const double* factor, int count) {
  expansion result;
  result.size = 0;
  for (int f = 0; f < count; ++f) {
    if (factor[f] == 0.0) continue;
    for (int i = 0; i < e->size; ++i) {
      const double2 p = two_product(e->part[i], factor[f]);
      if (p.y != 0.0) expansion_add(&result, p.y);
      if (p.x != 0.0) expansion_add(&result, p.x);
      if (result.size > EXPANSION_COMPRESSED) expansion_compress(&result);
    }
  }
  expansion_compress(&result);
  e->size = result.size;
  for (int i = 0; i < result.size; ++i) e->part[i] = result.part[i];
}

// e += f * g, of pairs as two_sum gives them.
static inline void expansion_add_product(expansion* e, double2 f, double2 g) {
  for (int k = 0; k < 4; ++k) {
    const double2 p = two_product(k & 1 ? f.x : f.y, k & 2 ? g.x : g.y);
    if (p.y != 0.0) expansion_add(e, p.y);
    if (p.x != 0.0) expansion_add(e, p.x);
  }
}

// e += f * g[0] * g[1] ..., compressed, of pairs as two_sum gives them.
static inline void expansion_add_products(expansion* e, double2 f, const double2* g, int count) {
  expansion product;
  product.size = 0;
  expansion_add(&product, f.y);
  expansion_add(&product, f.x);
  for (int k = 0; k < count; ++k) {
    const double factor[2] = {g[k].x, g[k].y};
    expansion_multiply(&product, factor, 2);
  }
  for (int i = 0; i < product.size; ++i) expansion_add(e, product.part[i]);
  expansion_compress(e);
}

// e = the cross product of two vectors, whose coordinates are pairs as two_sum gives them.
static inline void expansion_cross(double2 ax, double2 ay, double2 bx, double2 by, expansion* e) {
  e->size = 0;
  expansion_add_product(e, ax, by);
  expansion_add_product(e, -ay, bx);
}

// The value of a compressed expansion, with all bits right except the last.
static inline double expansion_value(const expansion* e) {
  double value = 0.0;
  for (int k = 0; k < e->size; ++k) value = value + e->part[k];
  return value;
}

END_SHARED

#endif

#endif
