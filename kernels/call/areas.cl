// The areas of triangles, correctly rounded, with one work-item per triangle.

#include "predicates/rounded_area.h"

// input and areas: the bits of doubles.
kernel void triangle_areas(int n, global const double_bits* restrict input, global const int* restrict triangles,
                           global double_bits* restrict areas) {
  const int t = get_global_id(0);
  if (t < n) {
    const int corner = 3 * t;
    areas[t] = rounded_area(input, triangles[corner], triangles[corner + 1], triangles[corner + 2]);
  }
}
