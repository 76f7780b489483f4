// Scans triangles into the pixels of a raster, with linear interpolation. A pixel has its value from the triangle that
// its centre lies in. On an edge between two triangles that have pixels, that is the one that belongs_to_left says; on
// another edge, the only one; at a vertex all of them write the vertex's own value. So the result is the same in
// whatever order triangles come.

#include "mesh/barycentric.h"
#include "operations/prefetch.h"
#include "raster/arguments.h"
#include "raster/pixels.h"
#include "raster/records.h"

// How many triangles ahead corners are fetched.
#define TRIANGLES_AHEAD 12
// A triangle from its lowest_corner on. numbers: 3 t + k of its corners.
typedef struct {
  double2 p[3];
  double value[3];
  int numbers[3];
} scanned_triangle;

// Several triangles may write the same value at once.
static inline void write_pixel(GLOBAL double* at, double value) {
#if defined(__cplusplus) && __GCC_ATOMIC_LLONG_LOCK_FREE == 2
  __atomic_store(at, &value, __ATOMIC_RELAXED);
#else
  *at = value;
#endif
}

// Whether the corners of a triangle are in the range of points. Writes their coordinates into p.
static inline int load_corners(int t, int points, GLOBAL const int* triangles, GLOBAL const double* coordinates,
                               double2* p) {
  for (int k = 0; k < 3; ++k) {
    const int v = triangles[3 * t + k];
    if (v < 0 || v >= points) return 0;
    p[k] = vload2(v, coordinates);
  }
  return 1;
}

FETCHING void fetch_triangle(int t, int n, GLOBAL const int* triangles, GLOBAL const double* coordinates,
                             GLOBAL const double* values) {
#if FETCH_AHEAD
  const int ahead = 3 * min(t + TRIANGLES_AHEAD, n - 1);
  for (int k = 0; k < 3; ++k) {
    const int v = triangles[ahead + k];
    fetch(&coordinates[2 * (size_t)v]);
    fetch(&values[v]);
  }
#endif
}

static inline scanned_triangle scanned(int t, const double2* q, GLOBAL const int* triangles,
                                       GLOBAL const double* values) {
  scanned_triangle result;
  int k = lowest_corner(q);
  for (int i = 0; i < 3; ++i, k = next_corner(k)) {
    result.p[i] = q[k];
    result.numbers[i] = 3 * t + k;
    result.value[i] = values[triangles[3 * t + k]];
  }
  return result;
}

// A pixel on an edge, or so near to one that floating point cannot tell, or in a slender triangle. Returns whether the
// triangle's neighbour is not in the mesh.
OUT_OF_LINE static inline int scan_exactly(const scanned_triangle* t, double2 centre, SCANNED_MESH(), double longest,
                                           GLOBAL double* pixel) {
  int edge = 0;
  const int edges = place_in_triangle(t->p, centre, &edge);
  if (edges == IS_OUTSIDE) return 0;
  if (edges == 2) {
    for (int k = 0; k < 3; ++k) {
      if (t->p[k].x == centre.x && t->p[k].y == centre.y) write_pixel(pixel, t->value[k]);
    }
    return 0;
  }
  if (edges == 1 && !belongs_to_left(t->p[next_corner(edge)], t->p[corner_before(edge)])) {
    const int beyond = neighbors[t->numbers[edge]];
    double2 other[3];
    if (beyond >= 0) {
      if (beyond >= count || !load_corners(beyond, points, triangles, coordinates, other)) return 1;
      if (!has_longer_edge(other, longest)) return 0;
    }
  }
  double weight[3];
  barycentric(t->p, centre, ORIENT_BOUND, weight);
  write_pixel(pixel, weighted(weight, t->value));
  return 0;
}

// The pixels [first, last] of a row. Most are decided by all three edges at once; the weights then equal the
// results of barycentric().
static inline int scan_row(const scanned_triangle* t, int first, int last, double y, pixel_grid grid, SCANNED_MESH(),
                           GLOBAL double* row) {
  int is_wrong = 0;
  double dy[3];
  for (int k = 0; k < 3; ++k) dy[k] = t->p[k].y - y;
  for (int column = first; column <= last; ++column) {
    const double2 centre = VECTOR(double2, grid.x + column * grid.dx, y);
    double dx[3], area[3], magnitude[3];
    for (int k = 0; k < 3; ++k) dx[k] = t->p[k].x - centre.x;
    for (int k = 0; k < 3; ++k) {
      const int a = next_corner(k), b = corner_before(k);
      const double left = dx[a] * dy[b], right = dy[a] * dx[b];
      area[k] = left - right;
      magnitude[k] = fabs(left) + fabs(right);
    }
    int is_outside = 0, is_inside = 1;
    for (int k = 0; k < 3; ++k) {
      const double error = ORIENT_BOUND * magnitude[k];
      is_outside |= area[k] < -error;
      is_inside &= area[k] > error;
    }
    if (is_outside) continue;
    const double whole = area[0] + area[1] + area[2];
    if (is_inside && magnitude[0] + magnitude[1] + magnitude[2] <= SLENDER * whole) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k) sum += area[k] / whole * t->value[k];
      write_pixel(&row[column], sum);
    } else {
      is_wrong |= scan_exactly(t, centre, points, count, coordinates, triangles, neighbors, grid.longest, &row[column]);
    }
  }
  return is_wrong;
}

// Triangles [i * chunk, ...) of n. wrong: gets the first triangle with an invalid corner or neighbour.
kernel void scan_triangles(int n, int chunk, pixel_grid grid, SCANNED_MESH(), global const double* restrict values,
                           global double* restrict pixels, volatile global int* restrict wrong) {
  const int begin = get_global_id(0) * chunk, end = min(n, begin + chunk);
  for (int t = begin; t < end; ++t) {
    fetch_triangle(t, n, triangles, coordinates, values);
    double2 p[3];
    if (!load_corners(t, points, triangles, coordinates, p)) {
      atomic_min(wrong, t);
      continue;
    }
    const pixel_range rows = rows_of(p, grid);
    if (rows.first > rows.last || (grid.longest < INFINITY && has_longer_edge(p, grid.longest))) continue;
    const scanned_triangle triangle = scanned(t, p, triangles, values);
    const sloping_triangle slopes = sloping(triangle.p, grid);
    int is_wrong = 0;
    for (int row = rows.first; row <= rows.last; ++row) {
      const double y = grid.y + row * grid.dy;
      const pixel_range range = columns_in_row(&slopes, y, grid);
      is_wrong |= scan_row(&triangle, range.first, range.last, y, grid, points, count, coordinates, triangles,
                           neighbors, &pixels[(size_t)row * grid.columns]);
    }
    if (is_wrong) atomic_min(wrong, t);
  }
}
