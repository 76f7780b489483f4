// The dual of a triangulation: circumcentres, and for each vertex its triangles in their order around it.
//
// circumcentres is one pass over the triangles. measure_cells, another one, finds the triangle in which each cell
// begins and the size of the cell, by walks around vertices. The host scans the sizes. write_cells, a third pass over
// the triangles, writes the cells that begin in each to their places. Triangles that follow each other mostly are near
// each other, whatever the order of the points is, so walks read what is in the cache. mark_hull marks the cells that
// are unbounded. Indices that are out of range are skipped.

#include "shared/bounds.h"
#include "shared/coordinates.h"
#include "shared/halfedges.h"
#include "shared/planar.h"
#include "shared/prefetch.h"

// How many triangles ahead a pass fetches the points or cells that it will need.
#define TRIANGLES_AHEAD 32
// And the triangles themselves: walks leave the order of memory, but mostly stay within a block of blocks/divide.cl,
// whose edges are FETCH_AHEAD pairs, three for two triangles.
#define WALKS_AHEAD (FETCH_AHEAD / 3 * 2)

// ---------------------------------------------------------------------------------------------------------------------
// Circumcentres

// Whether a coordinate is in the range in which predicates are exact, whatever its bits are: as nearly all are.
static inline int is_in_range(double x) {
  const double magnitude = fabs(x);
  return (magnitude == 0.0) | ((magnitude >= power_of_two(LOWEST_EXPONENT + DOUBLE_BITS - 1)) &
                               (magnitude < power_of_two(LARGEST_EXPONENT + 1)));
}

// The shift that brings a triangle to that range. The triangulation is known to be exact, so the bits of the
// coordinates span at most MOST_BITS.
static inline int shift_of(double2 a, double2 b, double2 c) {
  if (is_in_range(a.x) & is_in_range(a.y) & is_in_range(b.x) & is_in_range(b.y) & is_in_range(c.x) & is_in_range(c.y))
    return 0;
  const double largest_a = fmax(fabs(a.x), fabs(a.y));
  const double largest_b = fmax(fabs(b.x), fabs(b.y));
  const double largest_c = fmax(fabs(c.x), fabs(c.y));
  return LARGEST_EXPONENT - ilogb(fmax(largest_a, fmax(largest_b, largest_c)));
}

static inline double2 shifted(double2 p, int shift) {
  const scaling scale = scale_of(shift);
  return VECTOR(double2, scaled(p.x, scale), scaled(p.y, scale));
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

static inline void fetch_points(int corner, int end, global const int* triangles, global const double* input) {
#if FETCH_AHEAD
  for (int c = corner; c < min(corner + 3, end); ++c) fetch(&input[2 * triangles[c]]);
#endif
}

// Relative to the lexicographically first corner: that is the same one for all triangles of a cocircular fan.
static inline double2 centre_from_first(double2 a, double2 b, double2 c) {
  const int b_first = comes_before(b, a) && comes_before(b, c);
  const int c_first = comes_before(c, a) && !b_first && comes_before(c, b);
  return centre(b_first ? b : c_first ? c : a, b_first ? c : c_first ? a : b, b_first ? a : c_first ? b : c);
}

kernel void circumcentres(int n, int points, global const double* restrict input, global const int* restrict triangles,
                          global double* restrict centres) {
  const int t = get_global_id(0);
  if (t < n) {
    fetch_points(3 * (t + TRIANGLES_AHEAD), 3 * n, triangles, input);
    const int i = triangles[3 * t], j = triangles[3 * t + 1], k = triangles[3 * t + 2];
    double2 at = VECTOR(double2, as_double(0x7ff8000000000000UL), as_double(0x7ff8000000000000UL));
    if (min(i, min(j, k)) >= 0 && max(i, max(j, k)) < points) {
      const double2 a = vload2(i, input), b = vload2(j, input), c = vload2(k, input);
      const int shift = shift_of(a, b, c);
      if (shift == 0) {
        at = centre_from_first(a, b, c);
      } else {
        at = shifted(centre_from_first(shifted(a, shift), shifted(b, shift), shifted(c, shift)), -shift);
      }
    }
    vstore2(at, t, centres);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Cells

// The number of the corner opposite to a neighbour, which is one of three. Without branches, since they could not be
// predicted.
static inline int corner_towards(int neighbor, global const int* three) {
  const int is_one = three[1] == neighbor, is_two = three[2] == neighbor;
  return is_one + 2 * (is_two & !is_one);
}

// A walk around a vertex, counter-clockwise or clockwise: the triangle where it is, or -1; the neighbour where it goes;
// the other two neighbours.
typedef struct {
  int triangle, next, other, last;
} turn;

static inline turn turn_at(int triangle, int corner, int is_clockwise, global const int* neighbors) {
  const int ahead = neighbors[3 * triangle + next_corner(corner)];
  const int behind = neighbors[3 * triangle + corner_before(corner)];
  const turn at = {triangle, is_clockwise ? behind : ahead, neighbors[3 * triangle + corner],
                   is_clockwise ? ahead : behind};
  return at;
}

// The next triangle around the vertex. None, -1, behind the hull, and where neighbours are not mutual or one is there
// twice: so no two corners have the same next one, and walks end whatever the arrays contain. The corner opposite to
// the triangle before is chosen without branches, since they could not be predicted.
static inline turn turned(turn from, int is_clockwise, int triangle_count, global const int* neighbors) {
  turn to = {-1, -1, -1, -1};
  if (from.next < 0 || from.next >= triangle_count) return to;
  global const int* const there = neighbors + 3 * from.next;
  const int zero = there[0], one = there[1], two = there[2];
  const int is_one = one == from.triangle, is_two = (two == from.triangle) & !is_one;
  const int is_mutual =
      ((zero == from.triangle) | is_one | is_two) & (from.next != from.other) & (from.next != from.last);
  const int is_zero = 1 - is_one - is_two;
  const int before = there[2 * is_zero + is_two], after = there[is_zero + 2 * is_one];
  to.triangle = is_mutual ? from.next : -1;
  to.next = is_clockwise ? after : before;
  to.other = is_clockwise ? before : after;
  to.last = from.triangle;
  return to;
}

// The cell of a vertex on the hull begins at the hull edge that leaves the vertex.
static inline uint unbounded_cell_size(int triangle, int corner, int triangle_count, global const int* neighbors) {
  uint size = 0;
  for (turn at = turn_at(triangle, corner, 0, neighbors); at.triangle >= 0;
       at = turned(at, 0, triangle_count, neighbors)) {
    ++size;
  }
  return size;
}

// The cell of any other vertex begins with the smallest triangle. 0 if there is a smaller one, or if the vertex is on
// the hull. Walks in both directions take turns: then all corners of a vertex with d triangles take O(d log d) steps,
// in whatever order the triangles are.
static inline uint bounded_cell_size(int first, int corner, int triangle_count, global const int* neighbors) {
  turn ahead = turned(turn_at(first, corner, 0, neighbors), 0, triangle_count, neighbors);
  turn behind = turn_at(first, corner, 1, neighbors);
  uint size = 1;
  while (ahead.triangle != behind.triangle) {
    if (ahead.triangle < first) return 0;
    ++size;
    behind = turned(behind, 1, triangle_count, neighbors);
    if (behind.triangle == ahead.triangle) break;
    if (behind.triangle < first) return 0;
    ++size;
    ahead = turned(ahead, 0, triangle_count, neighbors);
  }
  return size;
}

// n triangles. sizes: 0 throughout; gets the size of each vertex' cell. firsts: gets for each triangle the set of its
// corners at which cells begin.
kernel void measure_cells(int n, int points, global const int* restrict triangles, global const int* restrict neighbors,
                          global uint* restrict sizes, global uchar* restrict firsts) {
  const int t = get_global_id(0);
  if (t < n) {
    fetch(&neighbors[3 * min(n - 1, t + WALKS_AHEAD)]);
    uint begun = 0;
    for (int k = 0; k < 3; ++k) {
      const int ahead = neighbors[3 * t + next_corner(k)], behind = neighbors[3 * t + corner_before(k)];
      const int vertex = triangles[3 * t + k];
      // Most corners have a smaller triangle beside them.
      if ((behind != -1 && min(ahead, behind) < t) || vertex < 0 || vertex >= points) continue;
      const uint size = behind == -1 ? unbounded_cell_size(t, k, n, neighbors) : bounded_cell_size(t, k, n, neighbors);
      if (size > 0) {
        sizes[vertex] = size;
        begun |= 1u << k;
      }
    }
    firsts[t] = begun;
  }
}

static inline void fetch_offsets(int t, int end, global const int* triangles, global const uchar* firsts,
                                 global const uint* offsets) {
#if FETCH_AHEAD
  for (int k = 0; k < 3 && t < end; ++k) {
    if (firsts[t] >> k & 1) fetch(&offsets[triangles[3 * t + k]]);
  }
#endif
}

// n triangles. offsets: where cells begin; the last one is the end.
kernel void write_cells(int n, global const int* restrict triangles, global const int* restrict neighbors,
                        global const uchar* restrict firsts, global const uint* restrict offsets,
                        global int* restrict cells) {
  const int t = get_global_id(0);
  if (t < n) {
    fetch(&neighbors[3 * min(n - 1, t + WALKS_AHEAD)]);
    fetch_offsets(t + TRIANGLES_AHEAD, n, triangles, firsts, offsets);
    for (int k = 0; k < 3; ++k) {
      if ((firsts[t] >> k & 1) == 0) continue;
      const int vertex = triangles[3 * t + k];
      const uint end = offsets[vertex + 1];
      // As turned(), which has found the way already.
      int at = t, opposite = next_corner(k);
      for (uint to = offsets[vertex]; to < end && at >= 0 && at < n; ++to) {
        cells[to] = at;
        const int next = neighbors[3 * at + opposite];
        opposite = next < 0 || next >= n ? 0 : corner_before(corner_towards(at, neighbors + 3 * next));
        at = next;
      }
    }
  }
}

// unbounded: 0 throughout. n: the number of hull vertices; of points on one line, all are.
kernel void mark_hull(int n, int points, global const int* restrict hull, global uchar* restrict unbounded) {
  const int i = get_global_id(0);
  if (i < n && hull[i] >= 0 && hull[i] < points) unbounded[hull[i]] = 1;
}
