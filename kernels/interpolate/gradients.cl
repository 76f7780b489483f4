// Gradients at the vertices, estimated from values: those for which the Clough-Tocher interpolant bends least along the
// edges (Nielson, "A method for interpolating scattered data based upon a minimum norm network", 1983; Renka and Cline,
// "A triangle-based C1 interpolation method", 1984).
//
// On an edge of length L from v to u, e = u - v, the interpolant is the cubic with the values and slopes of both ends.
// The integral of its squared second derivative is least, over all edges, where at each vertex
//   4 sum e (e.g_v) / L^3 + 2 sum e (e.g_u) / L^3 = 6 sum e (f_u - f_v) / L^3.
// With D the 2 by 2 blocks of the first sums, all eigenvalues of the system preconditioned by D lie in [1/2, 3/2], as
// each edge's eigenvalues do. So Chebyshev's semi-iteration (Golub and Varga, 1961) needs no products of whole
// vectors: each step is one pass, each step's share of the error is known before, and no result depends on the
// device.
//
// 1. count_edges counts the edges of each vertex, by a walk around it. The host scans the numbers.
// 2. write_edges writes each vertex' neighbours, the weights of the edges, and the inverse of its block.
// 3. start_gradients computes the first approximation from the values, improve_gradients the next one, as often as the
//    host says. Columns share all but the approximations.
//    On a torus share_gradients follows each of these: images of points at the rim lack neighbours, and have the
//    gradients of the points in their places.
// 4. take_gradients brings them to the points, in the caller's units.
// Passes have one work-item per vertex, which walks through its edges.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "interpolate/arguments.h"
#include "interpolate/blocks.h"
#include "mesh/halfedges.h"
#include "mesh/records.h"
#include "mesh/stars.h"
#include "operations/prefetch.h"
#include "operations/search.h"

// How many edges ahead of its use memory is fetched that is read by vertex.
#define EDGES_AHEAD 192

// Fetches the data with which a walk around a vertex begins: of vertex v, and at twice the distance its first
// triangle. last: the last vertex.
#define VERTICES_AHEAD 24
FETCHING void fetch_star(int v, int last, global const double2* points, global const face* faces,
                         global const int* first_triangle) {
#if FETCH_AHEAD
  fetch(&faces[first_triangle[min(v + VERTICES_AHEAD, last)]]);
  global const face* at = &faces[first_triangle[min(v, last)]];
  for (int k = 0; k < 3; ++k) {
    fetch(&faces[max(0, at->neighbor[k])]);
    fetch(&points[at->corner[k]]);
  }
#endif
}

// As star_next, over the edges of the first `kept` triangles.
static inline int next_kept(star_walk* walk, int kept, global const face* faces) {
  for (;;) {
    const int from = walk->triangle, was_back = walk->is_back;
    if (!star_next(walk, faces)) return 0;
    if (from < kept) return 1;
    const face f = faces[from];
    const int at = corner_of(f, walk->vertex);
    const int beyond = f.neighbor[was_back ? corner_before(at) : next_corner(at)];
    if (beyond >= 0 && beyond < kept) return 1;
  }
}

// n: points. The first vertices[0] of them are vertices; the others have no edges. kept: the triangles that
// have edges; others fill the mesh.
kernel void count_edges(int n, int kept, global const int* restrict vertices, global const double2* restrict points,
                        global const face* restrict faces, global const int* restrict first_triangle,
                        global uint* restrict counts) {
  const int v = get_global_id(0);
  if (v < n) {
    uint count = 0;
    if (v < *vertices) {
      fetch_star(v + VERTICES_AHEAD, *vertices - 1, points, faces, first_triangle);
      star_walk walk = star_begin(v, first_triangle[v]);
      while (next_kept(&walk, kept, faces)) ++count;
    }
    counts[v] = count;
  }
}

// room: no edge is written there or behind; there are more edges only if the mesh is not valid. weights: 1 /
// L^3, relative to 1 / L of the vertex' shortest edge, which keeps them in range.
kernel void write_edges(int n, int kept, int room, global const int* restrict vertices,
                        global const uint* restrict firsts, global const double2* restrict points,
                        global const face* restrict faces, global const int* restrict first_triangle,
                        global int* restrict neighbors, global double* restrict weights,
                        global double* restrict inverses) {
  const int v = get_global_id(0);
  if (v < n && v < *vertices) {
    fetch_star(v + VERTICES_AHEAD, *vertices - 1, points, faces, first_triangle);
    const double2 at = points[v];
    const int first = min((int)firsts[v], room), last = min((int)firsts[v + 1], room);
    star_walk walk = star_begin(v, first_triangle[v]);
    double least = 0.0;
    for (int i = first; i < last && next_kept(&walk, kept, faces); ++i) {
      const double2 edge = points[walk.neighbor] - at;
      const double squared = edge.x * edge.x + edge.y * edge.y;
      neighbors[i] = walk.neighbor;
      weights[i] = squared;
      if (i == first || squared < least) least = squared;
    }
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (int i = first; i < last; ++i) {
      const double2 edge = points[neighbors[i]] - at;
      const double weight = sqrt(least / weights[i]) / weights[i];
      weights[i] = weight;
      xx += 4.0 * (weight * edge.x) * edge.x;
      xy += 4.0 * (weight * edge.x) * edge.y;
      yy += 4.0 * (weight * edge.y) * edge.y;
    }
    invert_block(xx, xy, yy, inverses + 3 * (size_t)v);
  }
}

// values: rows of `columns` numbers by point, as are all arrays of gradients by vertex.
kernel void start_gradients(int n, int columns, EDGES(), global const double2* restrict points,
                            global const int* restrict source, global const double* restrict values,
                            global double2* restrict start, global double2* restrict gradients) {
  const int v = get_global_id(0);
  if (v < n && v < *vertices) {
    const double2 at = points[v];
    const int last = min((int)firsts[v + 1], room), edges = min((int)firsts[n], room);
    for (int c = 0; c < columns; ++c) {
      const double value = values[(size_t)source[v] * columns + c];
      double x = 0.0, y = 0.0;
      for (int i = min((int)firsts[v], room); i < last; ++i) {
#if FETCH_AHEAD
        fetch(&source[neighbors[min(i + 2 * EDGES_AHEAD, edges - 1)]]);
        const int ahead = neighbors[min(i + EDGES_AHEAD, edges - 1)];
        fetch(&points[ahead]);
        fetch(&values[(size_t)source[ahead] * columns + c]);
#endif
        const int u = neighbors[i];
        const double2 edge = points[u] - at;
        const double rise = 6.0 * (values[(size_t)source[u] * columns + c] - value);
        x += weights[i] * edge.x * rise;
        y += weights[i] * edge.y * rise;
      }
      const size_t to = (size_t)v * columns + c;
      start[to] = solved(inverses + 3 * (size_t)v, x, y);
      gradients[to] = start[to];
    }
  }
}

// before: the approximation before `gradients`, which the next one replaces; if this is the second one, it is not read
// but 0. start: the first one.
kernel void improve_gradients(int n, int columns, EDGES(), int is_second, double factor,
                              global const double2* restrict points, global const double2* restrict start,
                              global const double2* restrict gradients, global double2* restrict before) {
  const int v = get_global_id(0);
  if (v < n && v < *vertices) {
    const double2 at = points[v];
    const int last = min((int)firsts[v + 1], room), edges = min((int)firsts[n], room);
    for (int c = 0; c < columns; ++c) {
      double x = 0.0, y = 0.0;
      for (int i = min((int)firsts[v], room); i < last; ++i) {
#if FETCH_AHEAD
        const int ahead = neighbors[min(i + EDGES_AHEAD, edges - 1)];
        fetch(&points[ahead]);
        fetch(&gradients[(size_t)ahead * columns + c]);
#endif
        const int u = neighbors[i];
        const double2 edge = points[u] - at, gradient = gradients[(size_t)u * columns + c];
        const double slope = weights[i] * (edge.x * gradient.x + edge.y * gradient.y);
        x += slope * edge.x;
        y += slope * edge.y;
      }
      const size_t to = (size_t)v * columns + c;
      const double2 local_best = start[to] - solved(inverses + 3 * (size_t)v, 2.0 * x, 2.0 * y);
      const double2 old = is_second ? VECTOR(double2, 0.0, 0.0) : before[to];
      before[to] = factor * (local_best - old) + old;
    }
  }
}

// in_place: by vertex, the one of the same point in its place.
kernel void share_gradients(int n, int columns, global const int* restrict in_place,
                            global double2* restrict gradients) {
  const int v = get_global_id(0);
  if (v < n && in_place[v] != v) {
    for (int c = 0; c < columns; ++c) gradients[(size_t)v * columns + c] = gradients[(size_t)in_place[v] * columns + c];
  }
}

// scales: by set, the factors that bring slopes in the units of `points` to the caller's units. results: n rows
// of `columns` gradients by point, NaN throughout. in_place: as above, if there are images.
kernel void take_gradients(int n, int columns, int sets, int has_images, global const int* restrict first_vertices,
                           global const scaling* restrict scales, global const int* restrict source,
                           global const int* restrict in_place, global const double2* restrict gradients,
                           global double* restrict results) {
  const int v = get_global_id(0);
  if (v < n && v < first_vertices[sets] && (!has_images || in_place[v] == v)) {
    const scaling scale = scales[segment_of(v, sets, first_vertices)];
    for (int c = 0; c < columns; ++c) {
      const double2 gradient = gradients[(size_t)v * columns + c];
      global double* to = results + 2 * ((size_t)source[v] * columns + c);
      to[0] = scaled(gradient.x, scale);
      to[1] = scaled(gradient.y, scale);
    }
  }
}
