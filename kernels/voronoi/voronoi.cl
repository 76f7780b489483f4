// The dual of a triangulation: circumcentres, and for each vertex its triangles in their order around it.
//
// circumcentres is one pass over the triangles. link_corners, another one, finds the way around each vertex.
// measure_cells finds the triangle in which each cell begins and the size of the cell, by walks around vertices. The
// host scans the sizes. write_cells writes the cells that begin in each triangle to their places. These two are passes
// over chunks of triangles, with one work-item per chunk. Triangles that follow each other mostly are near each other,
// whatever the order of the points is, so walks read from the cache. mark_hull marks the cells that are
// unbounded. Indices that are out of range are skipped.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "predicates/bounds.h"
#include "predicates/planar.h"

// How many triangles ahead a pass fetches the points or cells that it will need.
#define TRIANGLES_AHEAD 32
// And the triangles themselves: walks leave the order of memory, but mostly stay within a block of blocks/divide.cl,
// whose edges are FETCH_AHEAD pairs, three for two triangles.
#define WALKS_AHEAD (FETCH_AHEAD / 3 * 2)

// ---------------------------------------------------------------------------------------------------------------------
// Circumcentres

// Whether a coordinate is in the range in which predicates are exact, whatever its bits are: as nearly all are.
#define LEAST_IN_RANGE power_of_two(LOWEST_EXPONENT + DOUBLE_BITS - 1)
#define END_OF_RANGE power_of_two(LARGEST_EXPONENT + 1)
static inline int is_in_range(double x) {
  return (x == 0.0) | ((fabs(x) >= LEAST_IN_RANGE) & (fabs(x) < END_OF_RANGE));
}

static inline double2 magnitudes_of(double2 p) { return VECTOR(double2, fabs(p.x), fabs(p.y)); }

// The shift that brings a triangle to that range. The triangulation is known to be exact, so the bits of the
// coordinates span at most MOST_BITS.
OUT_OF_LINE static inline int shift_for(double2 a, double2 b, double2 c, double most) {
  if (is_in_range(a.x) & is_in_range(a.y) & is_in_range(b.x) & is_in_range(b.y) & is_in_range(c.x) & is_in_range(c.y))
    return 0;
  // Others are no points of a triangulation.
  return isfinite(most) ? LARGEST_EXPONENT - ilogb(most) : 0;
}

static inline int shift_of(double2 a, double2 b, double2 c) {
  const double2 p = magnitudes_of(a), q = magnitudes_of(b), r = magnitudes_of(c);
  const double least = min(min(min(p.x, p.y), min(q.x, q.y)), min(r.x, r.y));
  const double most = max(max(max(p.x, p.y), max(q.x, q.y)), max(r.x, r.y));
  // So it is mostly; but a coordinate may be 0.
  if (least >= LEAST_IN_RANGE && most < END_OF_RANGE) return 0;
  return shift_for(a, b, c, most);
}

static inline double2 shifted(double2 p, int shift) {
  const scaling scale = scale_of(shift);
  return VECTOR(double2, scaled(p.x, scale), scaled(p.y, scale));
}

// sum += f * (gx^2 + gy^2), differences as two_sum gives them.
static inline void add_lifted(expansion* sum, double2 f, double2 gx, double2 gy) {
  for (int k = 0; k < 2; ++k) {
    const double2 g = k == 0 ? gx : gy;
    const double2 factors[2] = {g, g};
    expansion_add_products(sum, f, factors, 2);
  }
}

// The centre relative to a, by determinants that are exact until they are rounded.
OUT_OF_LINE static inline double2 centre_exact(double2 a, double2 b, double2 c) {
  const double2 bx = two_sum(b.x, -a.x), by = two_sum(b.y, -a.y);
  const double2 cx = two_sum(c.x, -a.x), cy = two_sum(c.y, -a.y);
  expansion sum;
  expansion_cross(bx, by, cx, cy, &sum);
  expansion_compress(&sum);
  const double whole = 2.0 * expansion_value(&sum);
  sum.size = 0;
  add_lifted(&sum, cy, bx, by);
  add_lifted(&sum, -by, cx, cy);
  const double x = expansion_value(&sum);
  sum.size = 0;
  add_lifted(&sum, bx, cx, cy);
  add_lifted(&sum, -cx, bx, by);
  return VECTOR(double2, x / whole, expansion_value(&sum) / whole);
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
  if (corner < end) {
    for (int c = corner; c < corner + 3; ++c) fetch(&input[2 * triangles[c]]);
  }
#endif
}

// Relative to the lexicographically first corner: that is the same one for all triangles of a cocircular fan. Without
// branches, since they could not be predicted.
static inline double2 centre_from_first(double2 a, double2 b, double2 c) {
  const double2 corners[5] = {a, b, c, a, b};
  const int b_first = comes_before(b, a) & comes_before(b, c);
  const int c_first = comes_before(c, a) & comes_before(c, b);
  const int first = b_first + 2 * c_first;
  return centre(corners[first], corners[first + 1], corners[first + 2]);
}

kernel void circumcentres(int n, int points, global const double* restrict input, global const int* restrict triangles,
                          global double* restrict centres) {
  const int t = get_global_id(0);
  if (t < n) {
    fetch_points(3 * (t + TRIANGLES_AHEAD), 3 * n, triangles, input);
    const int i = triangles[3 * t], j = triangles[3 * t + 1], k = triangles[3 * t + 2];
    double2 at = VECTOR(double2, as_double(0x7ff8000000000000UL), as_double(0x7ff8000000000000UL));
    if (((uint)i < (uint)points) & ((uint)j < (uint)points) & ((uint)k < (uint)points)) {
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

// Corners are numbered 3 t + k. n triangles. ahead: the same vertex in the next triangle around it, counter-clockwise.
// None, -1, behind the hull, and where neighbours are not mutual or one is there twice: so no two corners have the same
// next one, and walks end whatever the arrays contain.
kernel void link_corners(int n, global const int* restrict neighbors, global int* restrict ahead) {
  const int t = get_global_id(0);
  if (t < n) {
    fetch(&neighbors[3 * min(n - 1, t + WALKS_AHEAD)]);
    global const int* const here = neighbors + 3 * t;
    for (int k = 0; k < 3; ++k) {
      const int u = here[next_corner(k)];
      int next = -1;
      if (u >= 0 && u < n) {
        global const int* const there = neighbors + 3 * u;
        const int back = corner_towards(t, there);
        const int is_mutual = (there[back] == t) & (u != here[k]) & (u != here[corner_before(k)]);
        if (is_mutual) next = 3 * u + next_corner(back);
      }
      ahead[3 * t + k] = next;
    }
  }
}

// The corner that has this one ahead, or -1.
static inline int corner_behind(int corner, int triangle_count, global const int* neighbors, global const int* ahead) {
  const int t = corner / 3, u = neighbors[3 * t + corner_before(corner - 3 * t)];
  if (u < 0 || u >= triangle_count) return -1;
  const int behind = 3 * u + corner_before(corner_towards(t, neighbors + 3 * u));
  return ahead[behind] == corner ? behind : -1;
}

// The cell of a vertex on the hull begins at the hull edge that leaves the vertex.
static inline uint unbounded_cell_size(int first, global const int* ahead) {
  uint size = 0;
  for (int at = first; at >= 0; at = ahead[at]) ++size;
  return size;
}

// The cell of any other vertex begins with the smallest triangle. 0 if there is a smaller one, or if the vertex is on
// the hull. The first steps are made without branches, which could not be predicted. Around vertices with more
// triangles, walks in both directions take turns: then all corners of a vertex with d triangles take O(d log d) steps,
// in whatever order the triangles are.
#define FEW_TRIANGLES 8
static inline uint bounded_cell_size(int first, int triangle_count, global const int* neighbors,
                                     global const int* ahead) {
  uint size = 1;
  int front = ahead[first], back = first;
  for (int step = 1; step < FEW_TRIANGLES; ++step) {
    const int goes_on = front > first;
    const int next = ahead[max(front, 0)];
    size += goes_on;
    front = goes_on ? next : front;
  }
  if (front <= first) return front < first ? 0 : size;
  while (front != back) {
    if (front < first) return 0;
    ++size;
    back = corner_behind(back, triangle_count, neighbors, ahead);
    if (back == front) break;
    if (back < first) return 0;
    ++size;
    front = ahead[front];
  }
  return size;
}

// Triangles whose corners are looked at before the cells that may begin there are.
#define TRIANGLES_AT_ONCE 64

// n triangles. sizes: 0 throughout; gets the size of each vertex' cell. firsts: gets for each triangle the set of its
// corners at which cells begin.
kernel void measure_cells(int n, int chunk, int points, global const int* restrict triangles,
                          global const int* restrict neighbors, global const int* restrict ahead,
                          global uint* restrict sizes, global uchar* restrict firsts) {
  const int c = get_global_id(0);
  if ((int64)c * chunk < n) {
    const int last = (int)min((int64)n, ((int64)c + 1) * chunk);
    for (int begin = c * chunk; begin < last; begin += TRIANGLES_AT_ONCE) {
      const int end = min(last, begin + TRIANGLES_AT_ONCE);
      int corners[3 * TRIANGLES_AT_ONCE + 1];
      int count = 0;
      for (int t = begin; t < end; ++t) {
        fetch(&ahead[3 * min(n - 1, t + WALKS_AHEAD)]);
        firsts[t] = 0;
        for (int k = 0; k < 3; ++k) {
          const int left = neighbors[3 * t + next_corner(k)], right = neighbors[3 * t + corner_before(k)];
          corners[count] = 3 * t + k;
          // Most corners have a smaller triangle beside them.
          count += (right == -1) | (min(left, right) >= t);
        }
      }
      for (int i = 0; i < count; ++i) {
        const int first = corners[i], t = first / 3, k = first - 3 * t;
        const int vertex = triangles[first];
        if (vertex < 0 || vertex >= points) continue;
        const uint size = neighbors[3 * t + corner_before(k)] == -1 ? unbounded_cell_size(first, ahead)
                                                                    : bounded_cell_size(first, n, neighbors, ahead);
        if (size > 0) {
          sizes[vertex] = size;
          firsts[t] |= 1u << k;
        }
      }
    }
  }
}

// n triangles. offsets: where cells begin; the last one is the end.
kernel void write_cells(int n, int chunk, global const int* restrict triangles, global const int* restrict ahead,
                        global const uchar* restrict firsts, global const uint* restrict offsets,
                        global int* restrict cells) {
  const int c = get_global_id(0);
  if ((int64)c * chunk < n) {
    const int last = (int)min((int64)n, ((int64)c + 1) * chunk);
    for (int begin = c * chunk; begin < last; begin += TRIANGLES_AT_ONCE) {
      const int end = min(last, begin + TRIANGLES_AT_ONCE);
      int corners[3 * TRIANGLES_AT_ONCE + 1];
      int count = 0;
      for (int t = begin; t < end; ++t) {
        fetch(&ahead[3 * min(n - 1, t + WALKS_AHEAD)]);
        for (int k = 0; k < 3; ++k) {
          corners[count] = 3 * t + k;
          count += firsts[t] >> k & 1;
        }
      }
      for (int i = 0; i < count; ++i) fetch(&offsets[triangles[corners[i]]]);
      for (int i = 0; i < count; ++i) fetch(&cells[offsets[triangles[corners[i]]]]);
      for (int i = 0; i < count; ++i) {
        const int vertex = triangles[corners[i]];
        const uint end_of_cell = offsets[vertex + 1];
        int at = corners[i];
        for (uint to = offsets[vertex]; to < end_of_cell && at >= 0; ++to) {
          cells[to] = at / 3;
          at = ahead[at];
        }
      }
    }
  }
}

// unbounded: 0 throughout. n: the number of hull vertices; of points on one line, all are.
kernel void mark_hull(int n, int points, global const int* restrict hull, global uchar* restrict unbounded) {
  const int i = get_global_id(0);
  if (i < n && hull[i] >= 0 && hull[i] < points) unbounded[hull[i]] = 1;
}
