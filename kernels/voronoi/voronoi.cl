// The dual of a triangulation: circumcentres, and for each vertex its triangles in their order around it.
//
// circumcentres is one pass over the triangles. count_corners, another one, counts the corners at each vertex and finds
// where the walk around it begins. The host scans the counts. walk_cells, with one work-item per vertex, then writes
// each cell to its place. mark_hull marks the cells that are unbounded. Indices that are out of range are skipped.

#include "shared/bounds.h"
#include "shared/codes.h"
#include "shared/coordinates.h"
#include "shared/planar.h"

// ---------------------------------------------------------------------------------------------------------------------
// Circumcentres

// Brings the coordinates to the range in which predicates are exact, as the host does for the triangulation; here the
// host need not wait for it. accounts: as inspect (points/inspect.cl) leaves them.
static inline int shift_of(global const int* accounts) {
  const int largest = accounts[INSPECT_LARGEST], lowest = accounts[INSPECT_LOWEST];
  if (lowest > largest) return 0;
  return lowest < LOWEST_EXPONENT ? LOWEST_EXPONENT - lowest : min(0, LARGEST_EXPONENT - largest);
}

static inline double power_of_two(int exponent) { return as_double((ulong)(1023 + exponent) << 52); }

// The scale 2^shift, by factors that are doubles.
static inline scaling scale_of(int shift) {
  const int first = shift / 3, second = (shift - first) / 2;
  const scaling scale = {power_of_two(first), power_of_two(second), power_of_two(shift - first - second)};
  return scale;
}

static inline double shifted(double x, int shift) { return scaled(x, scale_of(shift)); }

static inline double2 shifted_point(int i, global const double* input, int shift) {
  const double2 p = vload2(i, input);
  return VECTOR(double2, shifted(p.x, shift), shifted(p.y, shift));
}

// sum += sign * f * (gx^2 + gy^2), differences as two_sum gives them.
static inline void add_lifted(expansion* sum, double sign, double2 f, double2 gx, double2 gy) {
  for (int k = 0; k < 2; ++k) {
    const double2 g = k == 0 ? gx : gy;
    const double factor[2] = {g.y, g.x};
    expansion product;
    product.size = 0;
    expansion_add(&product, sign * f.y);
    expansion_add(&product, sign * f.x);
    expansion_multiply(&product, factor, 2);
    expansion_multiply(&product, factor, 2);
    for (int i = 0; i < product.size; ++i) expansion_add(sum, product.part[i]);
    expansion_compress(sum);
  }
}

static inline double rounded(const expansion* e) {
  double sum = 0.0;
  for (int i = 0; i < e->size; ++i) sum += e->part[i];
  return sum;
}

// The centre relative to a, by determinants that are exact until they are rounded.
static inline double2 centre_exact(double2 a, double2 b, double2 c) {
  const double2 bx = two_sum(b.x, -a.x), by = two_sum(b.y, -a.y);
  const double2 cx = two_sum(c.x, -a.x), cy = two_sum(c.y, -a.y);
  expansion sum;
  sum.size = 0;
  for (int k = 0; k < 8; ++k) {
    const double2 f = k < 4 ? bx : -by, g = k < 4 ? cy : cx;
    const double2 p = two_product(k & 1 ? f.x : f.y, k & 2 ? g.x : g.y);
    expansion_add(&sum, p.y);
    expansion_add(&sum, p.x);
  }
  expansion_compress(&sum);
  const double whole = 2.0 * rounded(&sum);
  sum.size = 0;
  add_lifted(&sum, 1.0, cy, bx, by);
  add_lifted(&sum, -1.0, by, cx, cy);
  const double x = rounded(&sum);
  sum.size = 0;
  add_lifted(&sum, 1.0, bx, cx, cy);
  add_lifted(&sum, -1.0, cx, bx, by);
  return VECTOR(double2, x / whole, rounded(&sum) / whole);
}

// Where a determinant is smaller than its terms by more than this factor, as in slender triangles, all are computed
// exactly: so centres are wrong by less than 2^-36 of the radius, whatever the triangle.
#define CANCELLED 4096.0

static inline double2 centre(double2 a, double2 b, double2 c) {
  const double2 ab = b - a, ac = c - a;
  const double left = ab.x * ac.y, right = ab.y * ac.x;
  const double b_lift = ab.x * ab.x + ab.y * ab.y;
  const double c_lift = ac.x * ac.x + ac.y * ac.y;
  const double2 plus = VECTOR(double2, ac.y * b_lift, ab.x * c_lift);
  const double2 minus = VECTOR(double2, ab.y * c_lift, ac.x * b_lift);
  const double area = left - right;
  const double2 lever = plus - minus;
  const double terms = fabs(plus.x) + fabs(plus.y) + fabs(minus.x) + fabs(minus.y);
  if (fabs(left) + fabs(right) > CANCELLED * area || terms > CANCELLED * (fabs(lever.x) + fabs(lever.y)))
    return a + centre_exact(a, b, c);
  return a + lever / (2.0 * area);
}

// Relative to the lexicographically first corner: that is the same one for all triangles of a cocircular fan.
kernel void circumcentres(int n, int points, global const double* restrict input, global const int* restrict accounts,
                          global const int* restrict triangles, global double* restrict centres) {
  const int t = get_global_id(0);
  if (t < n) {
    const int i = triangles[3 * t], j = triangles[3 * t + 1], k = triangles[3 * t + 2];
    double2 at = VECTOR(double2, as_double(0x7ff8000000000000UL), as_double(0x7ff8000000000000UL));
    if (min(i, min(j, k)) >= 0 && max(i, max(j, k)) < points) {
      const int shift = shift_of(accounts);
      const double2 a = shifted_point(i, input, shift);
      const double2 b = shifted_point(j, input, shift);
      const double2 c = shifted_point(k, input, shift);
      const int b_first = comes_before(b, a) && comes_before(b, c);
      const int c_first = comes_before(c, a) && !b_first && comes_before(c, b);
      at = centre(b_first ? b : c_first ? c : a, b_first ? c : c_first ? a : b, b_first ? a : c_first ? b : c);
      at = VECTOR(double2, shifted(at.x, -shift), shifted(at.y, -shift));
    }
    vstore2(at, t, centres);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Cells

// counts: 0 throughout; gets each vertex' number of triangles. firsts: INT_MAX throughout; gets the smallest triangle
// of a vertex inside, and of one on the hull the triangle of the hull edge that leaves it, with the sign bit.
kernel void count_corners(int n, int points, global const int* restrict triangles, global const int* restrict neighbors,
                          global volatile uint* restrict counts, global volatile int* restrict firsts) {
  const int c = get_global_id(0);
  if (c < n) {
    const int t = c / 3, k = c % 3;
    const int vertex = triangles[c];
    if (vertex >= 0 && vertex < points) {
      const int leaves_along_hull = neighbors[3 * t + (k + 2) % 3] == -1;
      atomic_inc(&counts[vertex]);
      atomic_min(&firsts[vertex], leaves_along_hull ? t | INT_MIN : t);
    }
  }
}

// n vertices.
kernel void walk_cells(int n, int triangle_count, global const int* restrict triangles,
                       global const int* restrict neighbors, global const int* restrict firsts,
                       global const uint* restrict offsets, global int* restrict cells) {
  const int v = get_global_id(0);
  if (v < n) {
    int t = firsts[v] & INT_MAX;
    for (int to = (int)offsets[v]; to < (int)offsets[v + 1]; ++to) {
      const int is_there = t >= 0 && t < triangle_count;
      cells[to] = is_there ? t : -1;
      if (is_there) {
        const int k = triangles[3 * t] == v ? 0 : triangles[3 * t + 1] == v ? 1 : 2;
        t = neighbors[3 * t + (k + 1) % 3];
      }
    }
  }
}

// unbounded: 0 throughout. n: the number of hull vertices; of points on one line, all are.
kernel void mark_hull(int n, int points, global const int* restrict hull, global uchar* restrict unbounded) {
  const int i = get_global_id(0);
  if (i < n && hull[i] >= 0 && hull[i] < points) unbounded[hull[i]] = 1;
}
