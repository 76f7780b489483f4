// Which triangle a pixel's centre belongs to, and which pixels may lie in a triangle.
#ifndef FLAUNAY_RASTER_PIXELS_H
#define FLAUNAY_RASTER_PIXELS_H

#include "arithmetic/language.h"
#include "mesh/halfedges.h"
#include "predicates/planar.h"
#include "raster/edges.h"
#include "raster/records.h"

BEGIN_SHARED

// Numbers of rows or columns; none if first > last.
typedef struct {
  int first, last;
} pixel_range;

// How a pixel lies to a triangle: -1 if its centre is outside, otherwise the number of edges that it lies on.
INTEGER_CONSTANT(IS_OUTSIDE, -1);

// The pixels whose numbers lie between two computed ones. Each of the two may be wrong by the margin.
static inline pixel_range pixels_between(double a, double b, double margin, int count) {
  const double low = max(min(a, b) - margin, 0.0), high = min(max(a, b) + margin, count - 1.0);
  pixel_range range = {0, -1};
  if (low <= high) {
    range.first = (int)low;
    range.first += range.first < low;
    range.last = (int)high;
  }
  return range;
}

// Rows that may have pixels in a triangle.
static inline pixel_range rows_of(const double2* p, pixel_grid grid) {
  const double low = min(min(p[0].y, p[1].y), p[2].y), high = max(max(p[0].y, p[1].y), p[2].y);
  return pixels_between((low - grid.y) * grid.rows_by, (high - grid.y) * grid.rows_by, grid.row_margin, grid.rows);
}

// How x grows with y between two points, or 0 if they have one y.
static inline double slope_between(double2 a, double2 b) {
  const double2 edge = b - a;
  return edge.y != 0.0 ? edge.x / edge.y : 0.0;
}

// A counter-clockwise triangle that begins with its lowest corner, and the slopes of its edges: those from that corner
// to the second and the third one, and the other edge. So rows enter on the edges to the third corner, and leave on
// those to the second one.
typedef struct {
  double2 p[3];
  double to_second, to_third, other, margin;
} sloping_triangle;

// The relative error of where an edge crosses a row, in units of the edge's extent in x: seven roundings.
#define CROSSING_ERROR 0x1p-50

static inline sloping_triangle sloping(const double2* p, pixel_grid grid) {
  sloping_triangle t;
  for (int k = 0; k < 3; ++k) t.p[k] = p[k];
  t.to_second = slope_between(p[0], p[1]);
  t.to_third = slope_between(p[0], p[2]);
  t.other = slope_between(p[1], p[2]);
  const double extent = fabs(p[1].x - p[0].x) + fabs(p[2].x - p[0].x);
  t.margin = grid.column_margin + CROSSING_ERROR * (extent * grid.columns_by);
  return t;
}

// Columns in which the line of this y may cross the triangle. y is exact, and so each crossing has a small error in
// units of its edge, however flat the edge is.
static inline pixel_range columns_in_row(const sloping_triangle* t, double y, pixel_grid grid) {
  pixel_range none = {0, -1};
  if (y < t->p[0].y || y > max(t->p[1].y, t->p[2].y)) return none;
  const int leaves_late = y >= t->p[1].y, enters_late = y >= t->p[2].y;
  const double2 leaving = t->p[leaves_late ? 1 : 0], entering = t->p[enters_late ? 2 : 0];
  const double right = leaving.x + (leaves_late ? t->other : t->to_second) * (y - leaving.y);
  const double left = entering.x + (enters_late ? t->other : t->to_third) * (y - entering.y);
  return pixels_between((left - grid.x) * grid.columns_by, (right - grid.x) * grid.columns_by, t->margin, grid.columns);
}

// Where q lies in a counter-clockwise triangle. *edge: the last one of those that q lies on, by its opposite corner.
static inline int place_in_triangle(const double2* p, double2 q, int* edge) {
  int edges = 0;
  for (int k = 0; k < 3; ++k) {
    const int side = orient_sign(p[next_corner(k)], p[corner_before(k)], q, ORIENT_BOUND);
    if (side < 0) return IS_OUTSIDE;
    if (side == 0) {
      ++edges;
      *edge = k;
    }
  }
  return edges;
}

// Whether a point of the edge from a to b belongs to the triangle on its left, not to that on its right: as if the
// point were moved to the right by less than anything, and up by still less.
static inline int belongs_to_left(double2 a, double2 b) { return (a.y > b.y) | ((a.y == b.y) & (a.x < b.x)); }

static inline int is_lower(double2 a, double2 b) { return (a.y < b.y) | ((a.y == b.y) & (a.x < b.x)); }

// Triangles are scanned from their lowest corner on, and of two the left one, so that results do not depend on how
// points are numbered.
static inline int lowest_corner(const double2* p) {
  const int second = is_lower(p[1], p[0]), third = is_lower(p[2], p[second]);
  return third ? 2 : second;
}

static inline double weighted(const double* weight, const double* value) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    if (weight[k] != 0.0) sum += weight[k] * value[k];
  }
  return sum;
}

END_SHARED

#endif
