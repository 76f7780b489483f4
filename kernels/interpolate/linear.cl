// Interpolation from the corners of the triangle that a query lies in, and from the nearest point. One pass each, with
// one work-item per query, which computes all columns: values and results are rows of `columns` numbers.

#include "interpolate/arguments.h"
#include "interpolate/queries_ahead.h"
#include "locate/arguments.h"
#include "mesh/barycentric.h"
#include "mesh/records.h"
#include "operations/search.h"
#include "points/records.h"

// n queries in order of places; found: their triangles, less than 0 outside of the hull. A corner without weight does
// not count, not even if its value is NaN.
kernel void interpolate_linear(int n, PLACED_QUERIES(), int columns, double outside, filter_bound bound, FACES(),
                               global const int* restrict found, global const double* restrict values,
                               global double* restrict results) {
  const int i = get_global_id(0);
  if (i < n) {
    global double* result = results + (size_t)order[i] * columns;
    if (found[i] >= 0) {
      fetch_rows(i, n, columns, found, faces, points, source, values);
      const face f = faces[found[i]];
      const double unit = frames[sets > 1 ? segment_of(i, sets, query_offsets) : 0].unit;
      double2 p[3];
      double weight[3];
      for (int k = 0; k < 3; ++k) p[k] = unit * points[f.corner[k]];
      barycentric(p, placed[i], bound, weight);
      global const double* row[3];
      for (int k = 0; k < 3; ++k) row[k] = values + (size_t)source[f.corner[k]] * columns;
      for (int c = 0; c < columns; ++c) {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) {
          if (weight[k] != 0.0) sum += weight[k] * row[k][c];
        }
        result[c] = sum;
      }
    } else {
      for (int c = 0; c < columns; ++c) result[c] = outside;
    }
  }
}

// nearest: per query the point whose values it takes, -1 without one.
kernel void take_nearest(int n, int columns, double outside, global const int* restrict nearest,
                         global const double* restrict values, global double* restrict results) {
  const int i = get_global_id(0);
  if (i < n) {
    const int from = nearest[i];
    for (int c = 0; c < columns; ++c) {
      results[(size_t)i * columns + c] = from < 0 ? outside : values[(size_t)from * columns + c];
    }
  }
}
