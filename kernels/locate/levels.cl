// Makes the data for the search for nearest vertices through levels: locate/nearest_search.h has the search.
//
// 1. draw_entries, with one work-item per entry of all levels' samples, draws a vertex of each group of the level
//    below. In fixed point give_coordinates (fixed_point.cl) makes doubles of them. The host triangulates the samples
//    of all levels at once, each as a set, and makes a locator of them.
// 2. number_entries and find_below connect each entry with its vertex on the level below.
// 3. begin_stars gives each vertex the triangle from which all others about it are reached counter-clockwise.
// 4. link_fans finds, per triangle, whether the next one counter-clockwise about its first vertex belongs to the same
//    cocircular polygon. reach_along_fans doubles how far links lead, until all lead to their fan's last triangle.
// 5. box_vertices and box_boxes make the tree of boxes from below, with one work-item per box.

#include "arithmetic/records.h"
#include "locate/nearest_search.h"
#include "locate/records.h"
#include "mesh/records.h"
#include "operations/search.h"

// A number below ratio that looks like a random one (the finaliser of MurmurHash3, Appleby 2011).
static inline int pick(int i, int level, int ratio) {
  uint x = (uint)i * 31u + (uint)level + 1u;
  x = (x ^ (x >> 16)) * 0x85ebca6bu;
  x = (x ^ (x >> 13)) * 0xc2b2ae35u;
  return (int)((x ^ (x >> 16)) % (uint)ratio);
}

// n entries: set s has the entries from offsets[l * sets + s] on at level l. Set s has the vertices from
// first_vertices[s] on. below: the entry's vertex on level 0, otherwise its entry one level below.
kernel void draw_entries(int n, int levels, int sets, int ratio, global const int* restrict offsets,
                         global const int* restrict first_vertices, global const coordinate2* restrict points,
                         global coordinate2* restrict coordinates, global int* restrict below) {
  const int i = get_global_id(0);
  if (i < n) {
    const int segment = segment_of(i, levels * sets, offsets);
    const int level = segment / sets, set = segment - level * sets;
    int at = i - offsets[segment];
    for (int l = level; l >= 0; --l) {
      at = ratio * at + pick(at, l, ratio);
      if (l == level) below[i] = l > 0 ? offsets[segment - sets] + at : first_vertices[set] + at;
    }
    coordinates[i] = points[first_vertices[set] + at];
  }
}

// n triangles of samples. numbers: per entry, its vertex.
kernel void number_entries(int n, global const face* restrict faces, global const int* restrict first_triangle,
                           global const int* restrict source, global int* restrict numbers) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = faces[t].corner[k];
      if (first_triangle[vertex] == t) numbers[source[vertex]] = vertex;
    }
  }
}

// n entries of the levels above level 0, from entry `first` on.
kernel void find_below(int n, int first, global const int* restrict numbers, global int* restrict below) {
  const int i = get_global_id(0);
  if (i < n) below[first + i] = numbers[below[first + i]];
}

// starts: the first triangle of each vertex. A vertex on the hull begins one hull edge.
kernel void begin_stars(int n, global const face* restrict faces, global int* restrict starts) {
  const int t = get_global_id(0);
  if (t < n) {
    const face f = faces[t];
    for (int k = 0; k < 3; ++k) {
      if (f.neighbor[k] < 0) starts[f.corner[next_corner(k)]] = t;
    }
  }
}

kernel void link_fans(int n, global const face* restrict faces, global const coordinate2* restrict points,
                      global fan_part* restrict fans) {
  const int t = get_global_id(0);
  if (t < n) {
    const face f = faces[t];
    coordinate2 p[3];
    for (int k = 0; k < 3; ++k) p[k] = points[f.corner[k]];
    int k = comes_before(p[1], p[0]) ? 1 : 0;
    if (k == 0 ? comes_before(p[2], p[0]) : comes_before(p[2], p[1])) k = 2;
    const int next = f.neighbor[next_corner(k)];
    fan_part part;
    part.vertex = -1;
    part.last = t;
    if (next >= 0) {
      const face g = faces[next];
      const coordinate2 apex = points[g.corner[corner_before(corner_at(g, f.corner[k]))]];
      if (comes_before(points[f.corner[k]], apex) && circle_sign(p[0], p[1], p[2], apex, CIRCLE_BOUND) == 0) {
        part.vertex = f.corner[k];
        part.last = next;
      }
    }
    fans[t] = part;
  }
}

// changed: set to 1 if a link leads on.
kernel void reach_along_fans(int n, global const fan_part* restrict before, global fan_part* restrict after,
                             global volatile int* restrict changed) {
  const int t = get_global_id(0);
  if (t < n) {
    fan_part part = before[t];
    if (part.vertex >= 0 && before[part.last].vertex == part.vertex) {
      part.last = before[part.last].last;
      atomic_max(changed, 1);
    }
    after[t] = part;
  }
}

// n boxes around `vertices` vertices.
kernel void box_vertices(int n, int vertices, global const coordinate2* restrict points,
                         global vertex_box* restrict boxes) {
  const int i = get_global_id(0);
  if (i < n) {
    vertex_box box;
    box.low = box.high = points[BOX_FAN * i];
    for (int v = BOX_FAN * i + 1; v < min(vertices, BOX_FAN * (i + 1)); ++v) {
      box.low = VECTOR(coordinate2, min(box.low.x, points[v].x), min(box.low.y, points[v].y));
      box.high = VECTOR(coordinate2, max(box.high.x, points[v].x), max(box.high.y, points[v].y));
    }
    boxes[i] = box;
  }
}

// n boxes, from `first` on, around the boxes of the level below, from first_below on.
kernel void box_boxes(int n, int first, int first_below, global vertex_box* boxes) {
  const int i = get_global_id(0);
  if (i < n) {
    vertex_box box = boxes[first_below + BOX_FAN * i];
    for (int b = first_below + BOX_FAN * i + 1; b < min(first, first_below + BOX_FAN * (i + 1)); ++b) {
      box.low = VECTOR(coordinate2, min(box.low.x, boxes[b].low.x), min(box.low.y, boxes[b].low.y));
      box.high = VECTOR(coordinate2, max(box.high.x, boxes[b].high.x), max(box.high.y, boxes[b].high.y));
    }
    boxes[first + i] = box;
  }
}
