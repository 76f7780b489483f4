// Interpolation by the reduced element of Hsieh, Clough and Tocher: cubic in each third of a triangle, with the given
// values and gradients at the vertices, and with a continuous gradient everywhere (Clough and Tocher, "Finite element
// stiffness matrices for analysis of plates in bending", 1965; Farin, "Triangular Bernstein-Bezier patches", 1986).
//
// Along an edge, the slope in one direction across it is linear. That direction leads from the centroid of the triangle
// to that of its neighbour, as in SciPy's CloughTocher2DInterpolator; so the interpolant is invariant under affine
// maps.
//
// One pass, with one work-item per query, for all columns: values and results are rows of `columns` numbers.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "interpolate/arguments.h"
#include "interpolate/queries_ahead.h"
#include "locate/arguments.h"
#include "mesh/barycentric.h"
#include "mesh/records.h"
#include "mesh/stars.h"
#include "operations/search.h"
#include "points/records.h"

// The direction across the edge opposite to corner k of a triangle with the corners p. It leads from the
// centroid to a point a + g (a - b) on the line of that edge, from a to b; returns g. The corner beyond the
// edge is `apex`.
static inline double across_edge(const double2* p, int k, double2 apex) {
  const double2 a = p[next_corner(k)], b = p[corner_before(k)];
  const double2 at_a = area_filtered(b, p[k], apex), at_b = area_filtered(p[k], a, apex);
  double to_a = at_a.x, to_b = at_b.x;
  if (at_a.y + at_b.y > SLENDER * (to_a + to_b)) {
    to_a = area_exact(b, p[k], apex);
    to_b = area_exact(p[k], a, apex);
  }
  return -(2.0 * to_b + to_a) / (3.0 * (to_a + to_b));
}

// The triangle beyond the edge of a triangle from vertex a to b, as it lies beyond the image of that edge from vertex
// `home`; -1 if there is none.
static inline int beyond_image(int a, int b, int home, global const int* first_triangle, global const double2* points,
                               global const face* faces) {
  const double2 along = points[b] - points[a];
  star_walk walk = star_begin(home, first_triangle[home]);
  for (;;) {
    const int from = walk.triangle, was_back = walk.is_back;
    if (!star_next(&walk, faces)) return -1;
    const double2 edge = points[walk.neighbor] - points[home];
    if (edge.x == along.x && edge.y == along.y) return was_back ? walk.triangle : from;
  }
}

// The slope along an edge from `from` to `to`.
static inline double slope(double2 gradient, double2 from, double2 to) {
  return gradient.x * (to.x - from.x) + gradient.y * (to.y - from.y);
}

// The value at barycentric coordinates `weight`. value, gradient: at the corners p. across: see across_edge, by the
// opposite corner. The ordinates of the cubics are those at the corners; near a corner on the edge to the next one, to
// the one before, and on the line to the centroid; across the edges; near the centroid; at the centroid.
static inline double clough_tocher(const double2* p, const double* value, const double2* gradient, const double* across,
                                   const double* weight) {
  double to_next[3], to_before[3], inwards[3], edge[3], near_centre[3];
  for (int k = 0; k < 3; ++k) {
    to_next[k] = value[k] + slope(gradient[k], p[k], p[next_corner(k)]) / 3.0;
    to_before[k] = value[k] + slope(gradient[k], p[k], p[corner_before(k)]) / 3.0;
    inwards[k] = (to_next[k] + to_before[k] + value[k]) / 3.0;
  }
  for (int k = 0; k < 3; ++k) {
    const int a = next_corner(k), b = corner_before(k);
    edge[k] = (across[k] * (-value[a] + 3.0 * to_next[a] - 3.0 * to_before[b] + value[b]) +
               (-value[a] + 2.0 * to_next[a] - to_before[b] + inwards[b] + inwards[a])) /
              2.0;
  }
  for (int k = 0; k < 3; ++k) near_centre[k] = (edge[next_corner(k)] + edge[corner_before(k)] + inwards[k]) / 3.0;
  const double centre = (near_centre[0] + near_centre[1] + near_centre[2]) / 3.0;
  // The third opposite to the corner of the least weight.
  int k = weight[1] < weight[0] ? 1 : 0;
  if (weight[2] < weight[k]) k = 2;
  const int a = next_corner(k), b = corner_before(k);
  const double u = weight[a] - weight[k], v = weight[b] - weight[k], w = 3.0 * weight[k];
  return u * u * (u * value[a] + 3.0 * (v * to_next[a] + w * inwards[a])) +
         v * v * (v * value[b] + 3.0 * (u * to_before[b] + w * inwards[b])) + 6.0 * u * v * w * edge[k] +
         w * w * (3.0 * (u * near_centre[a] + v * near_centre[b]) + w * centre);
}

// n queries in order of places; found: their triangles, less than 0 outside of the hull. Triangles from `kept` on are
// outside, too. in_place: on a torus, where points have images, by vertex the one for the same point within the
// period. All its triangles are there; at the rim, images lack some. gradients: rows by vertex, or else by
// point; scales: factors by set, to the units of `points`.
kernel void interpolate_clough_tocher(int n, PLACED_QUERIES(), int columns, int is_by_vertex, int has_images,
                                      double outside, filter_bound bound, int kept, FACES(),
                                      global const int* restrict first_triangle, global const int* restrict in_place,
                                      global const int* restrict found, global const double* restrict values,
                                      global const double* restrict gradients, global const scaling* restrict scales,
                                      global double* restrict results) {
  const int i = get_global_id(0);
  if (i < n) {
    global double* result = results + (size_t)order[i] * columns;
    if (found[i] >= 0) {
      fetch_rows(i, n, columns, found, faces, points, source, values);
      const face f = faces[found[i]];
      const int set = sets > 1 ? segment_of(i, sets, query_offsets) : 0;
      const double unit = frames[set].unit;
      double2 p[3];
      double weight[3], across[3];
      for (int k = 0; k < 3; ++k) p[k] = unit * points[f.corner[k]];
      barycentric(p, placed[i], bound, weight);
      for (int k = 0; k < 3; ++k) {
        const int a = f.corner[next_corner(k)], home = has_images ? in_place[a] : a;
        const int t = home == a ? f.neighbor[k]
                                : beyond_image(a, f.corner[corner_before(k)], home, first_triangle, points, faces);
        across[k] = -0.5;
        if (t >= 0 && t < kept) {
          const face beyond = faces[t];
          double2 apex = points[beyond.corner[next_corner(corner_of(beyond, home))]];
          if (home != a) apex = apex + (points[a] - points[home]);
          across[k] = across_edge(p, k, unit * apex);
        }
      }
      for (int k = 0; k < 3; ++k) p[k] = points[f.corner[k]];
      const int vertex = weight[1] == 0.0 && weight[2] == 0.0   ? 0
                         : weight[2] == 0.0 && weight[0] == 0.0 ? 1
                         : weight[0] == 0.0 && weight[1] == 0.0 ? 2
                                                                : -1;
      for (int c = 0; c < columns; ++c) {
        double value[3];
        double2 gradient[3];
        for (int k = 0; k < 3; ++k) {
          const int point = source[f.corner[k]];
          value[k] = values[(size_t)point * columns + c];
          global const double* from = gradients + 2 * ((size_t)(is_by_vertex ? f.corner[k] : point) * columns + c);
          gradient[k] = VECTOR(double2, scaled(from[0], scales[set]), scaled(from[1], scales[set]));
        }
        result[c] = vertex >= 0 ? value[vertex] : clough_tocher(p, value, gradient, across, weight);
      }
    } else {
      for (int c = 0; c < columns; ++c) result[c] = outside;
    }
  }
}
