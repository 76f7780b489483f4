// Queries in a triangulation: the triangle that a query lies in, and the nearest vertex.
//
// Making the locator: data that walks read is stored in the order of the triangles, which mostly is an order by
// place; the points may be in any order.
// 1. make_faces, one pass over the triangles, finds the first triangle of each vertex. The host scans the numbers of
//    vertices that each triangle is the first of; number_vertices numbers and copies them, and renumber_faces puts the
//    numbers into the triangles. find_first_vertices says where each set's vertices begin.
// 2. place_hull copies the hull, for sets without triangles. measure_clearances, which waits for the first query for a
//    nearest point, computes how near other vertices are.
// 3. start_triangles gives each leaf of the sets' cut trees the triangle where walks begin.
// make_faces, place_hull and check_representatives find indices that are out of range.
//
// Queries: if there are many, find_query_leaves finds the leaf of each query in its set's tree, the host sorts the
// queries by leaf, and place_queries brings them into that order, so that queries that follow each other read the same
// memory. Then each of these is one pass:
// 1. find_triangles, with one work-item per chunk of queries. If the leaves are not known yet, several queries go down
//    the tree at the same time. Then each walks from triangle to triangle, over any edge that has the query strictly
//    beyond it: a visibility walk (Devillers, Pion and Teillaud, "Walking in a triangulation", 2002). In a Delaunay
//    triangulation it ends, whichever edge is tried first: the power of the query with respect to the triangle's circle
//    falls with each step, except within a cocircular polygon, whose triangles form a tree. In a mesh with constraints
//    it may circle: find_in_constrained follows with straight walks for queries that took too many steps.
// 2. nearest_points continues from these triangles, with one work-item per query, as do the kernels that interpolate
//    (interpolate/). Where a walk to the nearest vertex takes long, nearest_points searches through levels
//    (locate/nearest_search.h), which are made when the first query needs them (locate/levels.cl).

#include "arithmetic/records.h"
#include "locate/arguments.h"
#include "locate/nearest_search.h"
#include "locate/records.h"
#include "mesh/halfedges.h"
#include "mesh/records.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "points/cut_tree.h"
#include "points/records.h"

// ---------------------------------------------------------------------------------------------------------------------
// Making

// For each triangle, corners of the triangle this many places ahead are fetched: points may be in any order.
#define TRIANGLES_AHEAD 16

static inline face read_face(int t, global const int* triangles, global const int* neighbors) {
  face f;
  for (int k = 0; k < 3; ++k) {
    f.corner[k] = triangles[3 * t + k];
    f.neighbor[k] = neighbors[3 * t + k];
  }
  return f;
}

// Whether the neighbour opposite to corner k of triangle t, if there is one, is of the same set and has the same edge.
static inline int is_mutual(int t, face f, int k, int first, int last, global const int* triangles,
                            global const int* neighbors) {
  const int u = f.neighbor[k];
  if (u == -1) return 1;
  if (u < first || u >= last || u == t) return 0;
  const face beyond = read_face(u, triangles, neighbors);
  const int back = corner_opposite(beyond, t);
  return (beyond.neighbor[back] == t) & (beyond.corner[next_corner(back)] == f.corner[corner_before(k)]) &
         (beyond.corner[corner_before(back)] == f.corner[next_corner(k)]);
}

// incident: INT_MAX throughout; gets the first triangle of each vertex. bad[0]: the first triangle that cannot be.
kernel void make_faces(int n, int sets, global const int* restrict triangle_offsets,
                       global const int* restrict point_offsets, global const int* restrict triangles,
                       global const int* restrict neighbors, global face* restrict faces,
                       global volatile int* restrict incident, global volatile int* restrict bad) {
  const int t = get_global_id(0);
  if (t < n) {
#if FETCH_AHEAD
    for (int k = 0; k < 3; ++k) {
      fetch((global const int*)&incident[triangles[3 * min(n - 1, t + TRIANGLES_AHEAD) + k]]);
    }
#endif
    const int s = segment_of(t, sets, triangle_offsets);
    face f = read_face(t, triangles, neighbors);
    int good = f.corner[0] != f.corner[1] && f.corner[1] != f.corner[2] && f.corner[2] != f.corner[0];
    for (int k = 0; k < 3; ++k) {
      good &= f.corner[k] >= point_offsets[s] && f.corner[k] < point_offsets[s + 1] &&
              is_mutual(t, f, k, triangle_offsets[s], triangle_offsets[s + 1], triangles, neighbors);
    }
    if (good) {
      for (int k = 0; k < 3; ++k) atomic_min(&incident[f.corner[k]], t);
    } else {
      // Leads nowhere, for kernels that run before the host reads the error.
      for (int k = 0; k < 3; ++k) {
        f.corner[k] = 0;
        f.neighbor[k] = -1;
      }
      atomic_min(&bad[0], t);
    }
    faces[t] = f;
  }
}

kernel void count_vertices(int n, global const face* restrict faces, global const int* restrict incident,
                           global uint* restrict counts) {
  const int t = get_global_id(0);
  if (t < n) {
    uint count = 0;
    for (int k = 0; k < 3; ++k) count += incident[faces[t].corner[k]] == t;
    counts[t] = count;
  }
}

// For each vertex: its number, and by number its coordinates, the index of its point, and its first triangle.
kernel void number_vertices(int n, global const face* restrict faces, global const int* restrict incident,
                            global const uint* restrict firsts, global const coordinate* restrict input, scaling scale,
                            global int* restrict numbers, global coordinate2* restrict points,
                            global int* restrict source, global int* restrict first_triangle) {
  const int t = get_global_id(0);
  if (t < n) {
#if FETCH_AHEAD
    const int ahead = min(n - 1, t + TRIANGLES_AHEAD);
    if (firsts[ahead] != firsts[min(n - 1, ahead + 1)]) {
      for (int k = 0; k < 3; ++k) fetch(&input[2 * faces[ahead].corner[k]]);
    }
#endif
    int to = (int)firsts[t];
    for (int k = 0; k < 3; ++k) {
      const int from = faces[t].corner[k];
      if (incident[from] == t) {
        numbers[from] = to;
        points[to] = scaled_point(from, input, scale);
        source[to] = from;
        first_triangle[to++] = t;
      }
    }
  }
}

// n: sets + 1. The first vertex of each set, and the number of all.
kernel void find_first_vertices(int n, global const int* restrict triangle_offsets, global const uint* restrict firsts,
                                global int* restrict first_vertices) {
  const int s = get_global_id(0);
  if (s < n) first_vertices[s] = (int)firsts[triangle_offsets[s]];
}

kernel void renumber_faces(int n, global const int* restrict numbers, global face* restrict faces) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int k = 0; k < 3; ++k) faces[t].corner[k] = numbers[faces[t].corner[k]];
  }
}

// clearances: INT_MAX throughout; get the clearance of each vertex. Each edge leaves its origin in one triangle; the
// reverse of a hull edge is in none.
kernel void measure_clearances(int n, global const face* restrict faces, global const coordinate2* restrict points,
                               global volatile int* restrict clearances) {
  const int t = get_global_id(0);
  if (t < n) {
    const face f = faces[t];
    for (int k = 0; k < 3; ++k) {
      const int from = f.corner[k], to = f.corner[next_corner(k)];
      const int clearance = clearance_bits(squared_distance(points[to], points[from]));
      atomic_min(&clearances[from], clearance);
      if (f.neighbor[corner_before(k)] < 0) atomic_min(&clearances[to], clearance);
    }
  }
}

// bad[1]: the first index that is not of its set.
kernel void place_hull(int n, int sets, global const int* restrict offsets, global const int* restrict point_offsets,
                       global const int* restrict hull, global const coordinate* restrict input, scaling scale,
                       global coordinate2* restrict points, global int* restrict source,
                       global volatile int* restrict bad) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = segment_of(i, sets, offsets);
    const int from = hull[i];
    if (from < point_offsets[s] || from >= point_offsets[s + 1]) {
      atomic_min(&bad[1], i);
    } else {
      points[i] = scaled_point(from, input, scale);
      source[i] = from;
    }
  }
}

// bad[2]: the first representative that is not of its set.
kernel void check_representatives(int n, int sets, global const int* restrict point_offsets,
                                  global const int* restrict representatives, global volatile int* restrict bad) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = segment_of(i, sets, point_offsets);
    if (representatives[i] < point_offsets[s] || representatives[i] >= point_offsets[s + 1]) atomic_min(&bad[2], i);
  }
}

// by_leaf: each leaf's sample; drawn: the point that a sample is. last: the last triangle. Representatives may be
// wrong, which check_representatives says.
kernel void start_triangles(int n, int points, int last, global const int* restrict by_leaf,
                            global const int* restrict drawn, global const int* restrict representatives,
                            global const int* restrict incident, global int* restrict starts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int vertex = representatives[drawn[by_leaf[i]]];
    starts[i] = vertex < 0 || vertex >= points ? last : min(last, incident[vertex]);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Walking

// The triangle that q lies in, the smallest one of several; outside of the hull the complement of a triangle that has q
// beyond one of its edges, on the hull. GIVEN_UP after `most` steps. start: a triangle. points are scaled by unit more,
// as q is.
#define GIVEN_UP INT_MIN
static inline int walk(coordinate2 q, int start, int most, filter_bound bound, coordinate unit,
                       global const coordinate2* points, global const face* faces, global const int* first_triangle) {
  // Triangle t, the corner k that was reached last, and the edge from a to b opposite to it, which has q on its left,
  // or on it if it is the first one.
  int t = start, k = 2;
  face f = faces[t];
  coordinate2 a = in_frame(points[f.corner[0]], unit), b = in_frame(points[f.corner[1]], unit);
  int ab = orient_sign(a, b, q, bound);
  if (ab < 0) {
    if (f.neighbor[2] < 0) return ~t;
    const int u = f.neighbor[2];
    const coordinate2 swapped = a;
    a = b;
    b = swapped;
    f = faces[u];
    k = corner_opposite(f, t);
    t = u;
    ab = 1;
  }
  for (int step = 0; step < most; ++step) {
    const coordinate2 c = in_frame(points[f.corner[k]], unit);
    const int bc = orient_sign(b, c, q, bound);
    const int ca = bc < 0 ? 1 : orient_sign(c, a, q, bound);
    const int at_a = next_corner(k), at_b = corner_before(k);
    if (bc >= 0 && ca >= 0) {
      const int zeros = (ab == 0) + (bc == 0) + (ca == 0);
      if (zeros == 0) return t;
      if (zeros == 2) return first_triangle[f.corner[ab != 0 ? k : bc != 0 ? at_a : at_b]];
      const int beyond = f.neighbor[ab == 0 ? k : bc == 0 ? at_a : at_b];
      return beyond < 0 ? t : min(t, beyond);
    }
    const int u = f.neighbor[bc < 0 ? at_a : at_b];
    if (u < 0) return ~t;
    if (bc < 0) {
      a = c;
    } else {
      b = c;
    }
    ab = 1;
    f = faces[u];
    k = corner_opposite(f, t);
    t = u;
  }
  return GIVEN_UP;
}

// Where a walk from triangle t goes that has q strictly beyond an edge, as far as the filter can decide; t if it does
// not. Without branches, since they could not be predicted.
static inline int step_towards(coordinate2 q, int t, filter_bound bound, coordinate unit,
                               global const coordinate2* points, global const face* faces) {
  global const face* f = &faces[t];
  const real2 a = difference2(in_frame(points[f->corner[0]], unit), q);
  const real2 b = difference2(in_frame(points[f->corner[1]], unit), q);
  const real2 c = difference2(in_frame(points[f->corner[2]], unit), q);
  const real ab = a.x * b.y, ba = a.y * b.x, bc = b.x * c.y, cb = b.y * c.x, ca = c.x * a.y, ac = c.y * a.x;
  const int beyond_bc = bc - cb < -bound * (fabs(bc) + fabs(cb));
  const int beyond_ca = ca - ac < -bound * (fabs(ca) + fabs(ac));
  const int beyond_ab = ab - ba < -bound * (fabs(ab) + fabs(ba));
  const int u = f->neighbor[beyond_ca + 2 * (beyond_ab & !beyond_ca)];
  const int moves = -((beyond_bc | beyond_ca | beyond_ab) & (u >= 0));
  return t ^ ((t ^ u) & moves);
}

// Brings walks of queries [first, last), DESCENTS at most, nearer to their ends at the same time, as each step waits
// for the one before: until few of them move, and by at most MOST_APPROACH steps.
#define MOST_APPROACH 32
static inline void approach(int first, int last, filter_bound bound, coordinate unit, global const coordinate2* placed,
                            global const coordinate2* points, global const face* faces, int* at) {
  int moved = last - first;
  for (int step = 0; step < MOST_APPROACH && 2 * moved >= last - first; ++step) {
    moved = 0;
    for (int k = 0; k < last - first; ++k) {
      const int next = step_towards(placed[first + k], at[k], bound, unit, points, faces);
      fetch(&faces[next]);
      moved += next != at[k];
      at[k] = next;
    }
  }
}

// The leaves of queries [first, last), DESCENTS at most.
static inline void leaves_of_queries(int first, int last, global const coordinate* queries, query_frame frame,
                                     global const cut_node* tree, int depth, int* leaves) {
  point_keys keys[DESCENTS];
  for (int k = 0; k < DESCENTS; ++k) keys[k] = keys_of(query_in_tree(min(first + k, last - 1), queries, frame));
  descend(keys, tree, depth, leaves);
}

// n queries; of set s [query_offsets[s], query_offsets[s + 1]), which is not looked at if there is one set. keys: each
// query's leaf, counted over all sets, where a set has one leaf more than its tree, or one alone: so in the order of
// keys each set's queries take the places that they had. order: 0, 1, 2...
kernel void find_query_leaves(int n, int chunk, int sets, global const int* restrict query_offsets,
                              global const mesh_set* restrict records, global const query_frame* restrict frames,
                              global const cut_node* restrict nodes, global const coordinate* restrict queries,
                              global uint64* restrict keys, global int* restrict order) {
  const int c = get_global_id(0);
  if ((int64)c * chunk < n) {
    const int last = (int)min((int64)n, ((int64)c + 1) * chunk);
    int s = sets > 1 ? segment_of(c * chunk, sets, query_offsets) : 0;
    int begin = c * chunk;
    while (begin < last) {
      while (sets > 1 && query_offsets[s + 1] <= begin) ++s;
      const int end = min(begin + DESCENTS, sets > 1 ? min(last, query_offsets[s + 1]) : last);
      const mesh_set set = records[s];
      int leaf[DESCENTS];
      leaves_of_queries(begin, end, queries, frames[s], nodes + set.nodes, set.depth, leaf);
      for (int i = begin; i < end; ++i) {
        keys[i] = (uint64)set.nodes + s + leaf[i - begin];
        order[i] = i;
      }
      begin = end;
    }
  }
}

// The set of the query at a place; offsets are not looked at if there is one set. Sorting leaves sets as they are.
static inline int set_of(int place, int sets, global const int* query_offsets) {
  return sets > 1 ? segment_of(place, sets, query_offsets) : 0;
}

// order: the query at a place. frames: by set.
kernel void place_queries(int n, int sets, global const int* restrict query_offsets,
                          global const query_frame* restrict frames, global const int* restrict order,
                          global const coordinate* restrict queries, global coordinate2* restrict placed) {
  const int i = get_global_id(0);
  if (i < n) placed[i] = placed_query(order[i], queries, frames[set_of(i, sets, query_offsets)]);
}

// found: without triangles -1. Walks that end without an answer in sets of fewer than options.long_from triangles,
// after as many steps as a Delaunay triangulation can need, which has no triangle visited twice, are where they began.
kernel void find_triangles(int n, int chunk, int sets, walk_options options, global const int* restrict query_offsets,
                           QUERY_TREES(), global const query_frame* restrict frames,
                           global const coordinate* restrict queries, global const uint64* restrict keys,
                           global int* restrict order, global coordinate2* restrict placed, filter_bound bound,
                           WALKED_MESH(), global int* restrict found) {
  const int c = get_global_id(0);
  if ((int64)c * chunk < n) {
    const int last = (int)min((int64)n, ((int64)c + 1) * chunk);
    int s = sets > 1 ? segment_of(c * chunk, sets, query_offsets) : 0;
    int begin = c * chunk;
    while (begin < last) {
      while (sets > 1 && query_offsets[s + 1] <= begin) ++s;
      const int end = min(begin + DESCENTS, sets > 1 ? min(last, query_offsets[s + 1]) : last);
      const mesh_set set = records[s];
      const query_frame frame = frames[s];
      int start[DESCENTS];
      if (options.are_placed) {
        for (int i = begin; i < end; ++i) start[i - begin] = (int)keys[i] - set.nodes - s;
      } else {
        leaves_of_queries(begin, end, queries, frame, nodes + set.nodes, set.depth, start);
        for (int i = begin; i < end; ++i) {
          order[i] = i;
          placed[i] = placed_query(i, queries, frame);
        }
      }
      for (int j = 0; j < end - begin; ++j) {
        start[j] = set.depth > 0 ? starts[set.starts + start[j]] : set.starts;
        fetch(&faces[start[j]]);
      }
      for (int j = 0; j < end - begin && set.triangles > 0; ++j) fetch(&points[faces[start[j]].corner[0]]);
#if FETCH_AHEAD
      if (set.triangles > 0) approach(begin, end, bound, frame.unit, placed, points, faces, start);
#endif
      for (int i = begin; i < end; ++i) {
        int at = -1;
        if (set.triangles > 0) {
          const int is_long = set.triangles >= options.long_from;
          at = walk(placed[i], start[i - begin], is_long ? options.most_steps : set.triangles, bound, frame.unit,
                    points, faces, first_triangle);
          if (at == GIVEN_UP && !is_long) at = ~start[i - begin];
        }
        found[options.is_answer ? order[i] : i] = options.is_answer ? max(at, -1) : at;
      }
      begin = end;
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Walking straight

// The triangle that q lies in, as of walk, of a mesh that is convex. From a corner of triangle `start` the walk goes
// over the edges that the line to q crosses, and begins anew at each vertex on it, which is nearer to q; so it ends in
// any triangulation.
static inline int walk_straight(coordinate2 q, int start, filter_bound bound, coordinate unit,
                                global const coordinate2* points, global const face* faces,
                                global const int* first_triangle) {
  // The walk is at corner k of triangle t.
  int t = start, k = 0;
  face f = faces[t];
  for (;;) {
    const int vertex = f.corner[k], first = t;
    const coordinate2 v = in_frame(points[vertex], unit);
    if (v.x == q.x && v.y == q.y) return first_triangle[vertex];
    // Around v to the triangle whose angle there has q in it, with a on the right and b on the left.
    coordinate2 a, b;
    int va, bv, is_back = 0;
    for (;;) {
      a = in_frame(points[f.corner[next_corner(k)]], unit);
      b = in_frame(points[f.corner[corner_before(k)]], unit);
      va = orient_sign(v, a, q, bound);
      bv = orient_sign(b, v, q, bound);
      if (va >= 0 && bv >= 0) break;
      int beside = f.neighbor[is_back ? corner_before(k) : next_corner(k)];
      if (beside < 0 && !is_back) {
        is_back = 1;
        f = faces[first];
        beside = f.neighbor[corner_before(corner_at(f, vertex))];
      }
      if (beside < 0 || beside == first) return ~t;
      t = beside;
      f = faces[t];
      k = corner_at(f, vertex);
    }
    const int ab = orient_sign(a, b, q, bound);
    if (ab >= 0) {
      if (va != 0 && bv != 0 && ab != 0) return t;
      if (ab == 0 && va == 0) return first_triangle[f.corner[next_corner(k)]];
      if (ab == 0 && bv == 0) return first_triangle[f.corner[corner_before(k)]];
      const int beyond = f.neighbor[ab == 0 ? k : va == 0 ? corner_before(k) : next_corner(k)];
      return beyond < 0 ? t : min(t, beyond);
    }
    if (va == 0 || bv == 0) {
      k = va == 0 ? next_corner(k) : corner_before(k);
      continue;
    }
    // Over the edge from a to b, opposite to corner k, which has q strictly beyond it.
    for (;;) {
      const int u = f.neighbor[k];
      if (u < 0) return ~t;
      f = faces[u];
      k = corner_opposite(f, t);
      t = u;
      const coordinate2 d = in_frame(points[f.corner[k]], unit);
      const int ad = orient_sign(a, d, q, bound), db = orient_sign(d, b, q, bound);
      if (ad >= 0 && db >= 0) {
        if (ad != 0 && db != 0) return t;
        if (ad == 0 && db == 0) return first_triangle[f.corner[k]];
        const int beyond = f.neighbor[ad == 0 ? next_corner(k) : corner_before(k)];
        return beyond < 0 ? t : min(t, beyond);
      }
      const int side = orient_sign(v, q, d, bound);
      if (side == 0) break;
      if (side > 0) {
        b = d;
        k = next_corner(k);
      } else {
        a = d;
        k = corner_before(k);
      }
    }
  }
}

// In a mesh with constraints, which has one set, ends walks that find_triangles gave up. Triangles from `kept`
// on fill the mesh up to its hull; queries in them are outside. found: by place; answers: by query, if
// is_answer.
kernel void find_in_constrained(int n, PLACED_QUERIES(), int kept, int is_answer, QUERY_TREES(),
                                global const coordinate* restrict queries, filter_bound bound, WALKED_MESH(),
                                global int* restrict found, global int* restrict answers) {
  const int i = get_global_id(0);
  if (i < n) {
    int at = found[i];
    if (at == GIVEN_UP) {
      const mesh_set set = records[0];
      int leaf[DESCENTS];
      leaves_of_queries(order[i], order[i] + 1, queries, frames[0], nodes + set.nodes, set.depth, leaf);
      const int start = set.depth > 0 ? starts[set.starts + leaf[0]] : set.starts;
      at = walk_straight(placed[i], start, bound, frames[0].unit, points, faces, first_triangle);
    }
    at = at < kept ? max(at, -1) : -1;
    found[i] = at;
    if (is_answer) answers[order[i]] = at;
  }
}

// The faces of the first n triangles without the neighbours that a constraint or the border is between. constrained: by
// corner.
kernel void cut_faces(int n, global const uchar* restrict constrained, global const face* restrict faces,
                      global face* restrict visible) {
  const int t = get_global_id(0);
  if (t < n) {
    face f = faces[t];
    for (int k = 0; k < 3; ++k) {
      if (constrained[3 * t + k] || f.neighbor[k] >= n) f.neighbor[k] = -1;
    }
    visible[t] = f;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// The nearest vertex

// The best of a vertex and its neighbours: counter-clockwise around it, and on the hull then the other way. left: how
// many neighbours may be looked at, which is lowered; less than 0 if these are not all.
static inline nearby best_around(nearby vertex, coordinate2 q, filter_bound bound, coordinate unit,
                                 global const coordinate2* points, global const face* faces, int* left) {
  nearby best = vertex;
  const face first = faces[vertex.triangle];
  const int k = corner_at(first, vertex.vertex);
  consider(&best, first.corner[next_corner(k)], vertex.triangle, q, bound, unit, points);
  int last = first.corner[corner_before(k)];
  consider(&best, last, vertex.triangle, q, bound, unit, points);
  int t = first.neighbor[next_corner(k)];
  while (t >= 0 && t != vertex.triangle && --*left >= 0) {
    const face f = faces[t];
    const int at = corner_at(f, vertex.vertex);
    consider(&best, f.corner[corner_before(at)], t, q, bound, unit, points);
    t = f.neighbor[next_corner(at)];
  }
  if (t < 0) {
    t = first.neighbor[corner_before(k)];
    while (t >= 0 && --*left >= 0) {
      const face f = faces[t];
      const int at = corner_at(f, vertex.vertex);
      consider(&best, f.corner[next_corner(at)], t, q, bound, unit, points);
      t = f.neighbor[corner_before(at)];
    }
  }
  return best;
}

// Greedy descent, from a corner of triangle t, over at most `most` neighbours; GIVEN_UP if these do not
// suffice. In a Delaunay triangulation a vertex that is not nearest has a nearer neighbour; several nearest
// vertices lie on one empty circle, whose first vertex is joined to all.
static inline int nearest_vertex(coordinate2 q, int t, int most, filter_bound bound, coordinate unit,
                                 global const coordinate2* points, global const face* faces,
                                 global const int* clearances) {
  nearby best, before;
  best.vertex = faces[t].corner[0];
  best.triangle = t;
  best.at = in_frame(points[best.vertex], unit);
  for (int k = 1; k < 3; ++k) consider(&best, faces[t].corner[k], t, q, bound, unit, points);
  int left = most;
  do {
    before = best;
    if (!is_clear(before, q, unit, clearances)) best = best_around(before, q, bound, unit, points, faces, &left);
    if (left < 0) return GIVEN_UP;
  } while (best.vertex != before.vertex);
  return best.vertex;
}

// found: of find_triangles, by place; the answer is by query. In sets of long_from triangles or more, most_neighbors
// are looked at before the search goes through levels. If there are no levels, `levels` is 0, unanswered[0] is set to
// 1, and the query has no answer. are_vertices: whether answers are numbers of vertices, for nearest_off_grid.
// long_sets: of a set with levels, which of those it is. sample_...: the locator of samples.
kernel void nearest_points(int n, PLACED_QUERIES(), int long_from, int most_neighbors, int are_vertices, LEVELS(),
                           SEARCHED_MESH(), filter_bound bound, SEARCHED_MESH(sample_),
                           global const int* restrict found, global int* restrict nearest,
                           global volatile int* restrict unanswered) {
  const int i = get_global_id(0);
  if (i < n) {
    const coordinate2 q = placed[i];
    const int s = set_of(i, sets, query_offsets);
    const mesh_set set = records[s];
    const coordinate unit = frames[s].unit;
    int answer;
    if (set.triangles == 0) {
      const int at = nearest_on_line(q, set.hull, set.hull_end, bound, unit, hull_points);
      answer = at < 0 ? -1 : hull[at];
    } else {
      const int t = found[i];
      int vertex = GIVEN_UP;
      if (t != GIVEN_UP) {
        const int most = set.triangles >= long_from ? most_neighbors : INT_MAX;
        vertex = nearest_vertex(q, t < 0 ? ~t : t, most, bound, unit, points, faces, clearances);
      }
      if (vertex == GIVEN_UP && levels == 0) {
        atomic_max(unanswered, 1);
      } else if (vertex == GIVEN_UP) {
        const star_mesh mesh = {points, faces, clearances, starts, fans};
        const level_meshes on = {
            levels,         sets_with_levels,
            sample_records, sample_source,
            below,          sample_hull_points,
            sample_hull,    {sample_points, sample_faces, sample_clearances, sample_starts, sample_fans}};
        uint looked = 0;
        vertex = nearest_by_levels(q, long_sets[s], first_vertices[s], first_vertices[s + 1], first_vertices[sets],
                                   bound, unit, mesh, boxes, on, &looked);
      }
      answer = vertex == GIVEN_UP ? -1 : are_vertices ? vertex : source[vertex];
    }
    nearest[order[i]] = answer;
  }
}
