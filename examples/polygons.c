/* Triangulates two polygons, one with a hole, in one call.
 *
 *   polygons
 */
#include <flaunay/flaunay.h>
#include <stdio.h>

int main(void) {
  /* A square with a hole, and a triangle. Each ring may begin anywhere and turn either way. */
  const double xy[] = {0, 0, 6, 0, 6, 6, 0, 6, 2, 2, 2, 4, 4, 4, 4, 2, 6, 0, 9, 3, 6, 6};
  const size_t rings[] = {0, 4, 8, 11}, polygons[] = {0, 2, 3};
  const flaunay_polygons given = {.coordinates = xy,
                                  .ring_offsets = rings,
                                  .ring_count = 3,
                                  .polygon_offsets = polygons,
                                  .polygon_count = 2};
  flaunay_triangulator* triangulator = NULL;
  flaunay_triangulation* result = NULL;
  if (flaunay_triangulator_create("host", &triangulator) != FLAUNAY_SUCCESS ||
      flaunay_triangulate_polygons(triangulator, &given, NULL, &result) != FLAUNAY_SUCCESS) {
    fprintf(stderr, "%s\n", flaunay_last_error());
    return 1;
  }
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  for (size_t p = 0; p < mesh->set_count; ++p) {
    const size_t first = mesh->triangle_offsets[p], last = mesh->triangle_offsets[p + 1];
    printf("polygon %zu has triangles %zu to %zu\n", p, first, last - 1);
  }
  flaunay_triangulation_destroy(result);
  flaunay_triangulator_destroy(triangulator);
  return 0;
}
