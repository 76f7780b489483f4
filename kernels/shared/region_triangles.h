// A small region without internal points, triangulated by one work-item.
#ifndef FLAUNAY_REGION_TRIANGLES_H
#define FLAUNAY_REGION_TRIANGLES_H

#include "shared/planar.h"

#ifndef SMALL_REGION
#define SMALL_REGION 48  // corners; what a work-item keeps in private memory
#endif
#define REGION_UNDECIDED -1
#define REGION_BROKEN -2

// Defines int NAME(corners, count, points, orient_bound, circle_bound, triangles): the triangles of the region with
// `count` corners, three ids each, into triangles[] (which may be corners[]: it is read first and holds count
// - 2 triangles at least); returns their number or REGION_UNDECIDED if a predicate was.
//
// Gift wrapping: of an open directed edge (a, b), with untriangulated region on its left, the apex is the vertex left
// of it whose circle holds no other vertex left of it. The triangle closes the edge and closes or opens two others.
// Border edges are Delaunay edges, so no vertex in a circle hides behind one; but of several vertices on one circle some
// may: an open edge between two of them cuts the circle's polygon. So among those the apex is one that no such edge
// separates from (a, b). O(triangles * vertices) predicates.
#define REGION_TRIANGLES(NAME, ORIENT, CIRCLE)                                                                       \
  static inline int NAME(global const int* corners, int count, global const double2* restrict points,                \
                         double orient_bound, double circle_bound, global int* triangles) {                          \
    if (count == 3) {                                                                                                \
      const int3 t = (int3)(corners[0], corners[1], corners[2]);                                                     \
      triangles[0] = t.x;                                                                                            \
      triangles[1] = t.y;                                                                                            \
      triangles[2] = t.z;                                                                                            \
      return 1;                                                                                                      \
    }                                                                                                                \
    int ids[SMALL_REGION];                                                                                           \
    double2 p[SMALL_REGION];                                                                                         \
    uchar of_corner[SMALL_REGION];                                                                                   \
    uchar edge_a[3 * SMALL_REGION], edge_b[3 * SMALL_REGION];                                                        \
    uchar made[3 * SMALL_REGION];                                                                                    \
    int vertices = 0;                                                                                                \
    for (int i = 0; i < count; ++i) {                                                                                \
      const int id = corners[3 * i + 1];                                                                             \
      int v = 0;                                                                                                     \
      while (v < vertices && ids[v] != id) ++v;                                                                      \
      if (v == vertices) {                                                                                           \
        ids[v] = id;                                                                                                 \
        p[v] = points[id];                                                                                           \
        ++vertices;                                                                                                  \
      }                                                                                                              \
      of_corner[i] = v;                                                                                              \
    }                                                                                                                \
    int open = 0;                                                                                                    \
    for (int i = 0; i < count; ++i) {                                                                                \
      const int after = corners[3 * i + 2];                                                                          \
      int v = 0;                                                                                                     \
      while (v < vertices && ids[v] != after) ++v;                                                                   \
      if (v == vertices) return REGION_BROKEN;                                                                       \
      edge_a[open] = of_corner[i];                                                                                   \
      edge_b[open] = v;                                                                                              \
      ++open;                                                                                                        \
    }                                                                                                                \
    int total = 0;                                                                                                   \
    while (open > 0) {                                                                                               \
      --open;                                                                                                        \
      const int a = edge_a[open];                                                                                    \
      const int b = edge_b[open];                                                                                    \
      int apex = -1;                                                                                                 \
      int tied = 0;                                                                                                  \
      for (int v = 0; v < vertices; ++v) {                                                                           \
        if (v == a || v == b) continue;                                                                              \
        const int turn = ORIENT(p[a], p[b], p[v], orient_bound);                                                     \
        if (turn == UNDECIDED) return REGION_UNDECIDED;                                                              \
        if (turn <= 0) continue;                                                                                     \
        if (apex < 0) {                                                                                              \
          apex = v;                                                                                                  \
          continue;                                                                                                  \
        }                                                                                                            \
        const int inside = CIRCLE(p[a], p[b], p[apex], p[v], circle_bound);                                          \
        if (inside == UNDECIDED) return REGION_UNDECIDED;                                                            \
        if (inside > 0) {                                                                                            \
          apex = v;                                                                                                  \
          tied = 0;                                                                                                  \
        } else if (inside == 0) {                                                                                    \
          tied = 1;                                                                                                  \
        }                                                                                                            \
      }                                                                                                              \
      if (apex < 0 || total >= count - 2) return REGION_BROKEN;                                                      \
      if (tied) {                                                                                                    \
        uchar on_circle[SMALL_REGION];                                                                               \
        for (int v = 0; v < vertices; ++v) {                                                                         \
          int on = v == a || v == b || v == apex;                                                                    \
          if (!on && ORIENT(p[a], p[b], p[v], orient_bound) > 0) {                                                   \
            const int inside = CIRCLE(p[a], p[b], p[apex], p[v], circle_bound);                                      \
            if (inside == UNDECIDED) return REGION_UNDECIDED;                                                        \
            on = inside == 0;                                                                                        \
          }                                                                                                          \
          on_circle[v] = on;                                                                                         \
        }                                                                                                            \
        int visible = -1;                                                                                            \
        for (int v = 0; v < vertices && visible < 0; ++v) {                                                          \
          if (!on_circle[v] || v == a || v == b) continue;                                                           \
          int hidden = 0;                                                                                            \
          for (int e = 0; e < open && !hidden; ++e) {                                                                \
            const int c = edge_a[e];                                                                                 \
            const int d = edge_b[e];                                                                                 \
            if (!on_circle[c] || !on_circle[d] || c == v || d == v) continue;                                        \
            const int reference = c != a && d != a ? a : b;                                                          \
            if (reference == c || reference == d) continue;                                                          \
            const int mine = ORIENT(p[c], p[d], p[v], orient_bound);                                                 \
            const int theirs = ORIENT(p[c], p[d], p[reference], orient_bound);                                       \
            if (mine == UNDECIDED || theirs == UNDECIDED) return REGION_UNDECIDED;                                   \
            hidden = mine * theirs < 0;                                                                              \
          }                                                                                                          \
          if (!hidden) visible = v;                                                                                  \
        }                                                                                                            \
        if (visible < 0) return REGION_BROKEN;                                                                       \
        apex = visible;                                                                                              \
      }                                                                                                              \
      made[3 * total] = a;                                                                                           \
      made[3 * total + 1] = b;                                                                                       \
      made[3 * total + 2] = apex;                                                                                    \
      ++total;                                                                                                       \
      for (int side = 0; side < 2; ++side) {                                                                         \
        const int from = side ? apex : b;                                                                            \
        const int to = side ? a : apex;                                                                              \
        int e = 0;                                                                                                   \
        while (e < open && (edge_a[e] != from || edge_b[e] != to)) ++e;                                              \
        if (e < open) {                                                                                              \
          --open;                                                                                                    \
          edge_a[e] = edge_a[open];                                                                                  \
          edge_b[e] = edge_b[open];                                                                                  \
        } else if (open < 3 * SMALL_REGION) {                                                                        \
          edge_a[open] = to;                                                                                         \
          edge_b[open] = from;                                                                                       \
          ++open;                                                                                                    \
        } else {                                                                                                     \
          return REGION_BROKEN;                                                                                      \
        }                                                                                                            \
      }                                                                                                              \
    }                                                                                                                \
    for (int i = 0; i < 3 * total; ++i) triangles[i] = ids[made[i]];                                                 \
    return total;                                                                                                    \
  }

#endif
