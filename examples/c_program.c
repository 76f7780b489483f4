/* The C interface: triangulates points, and says where some others lie in the triangulation.
 *
 *   c_program
 */
#include <flaunay/flaunay.h>
#include <stdio.h>
#include <stdlib.h>

#define SIDE 20
#define QUERIES 3

static void check(flaunay_status status) {
  if (status == FLAUNAY_SUCCESS) return;
  fprintf(stderr, "%s: %s\n", flaunay_status_string(status), flaunay_last_error());
  exit(EXIT_FAILURE);
}

int main(void) {
  /* A grid: every square is a tie, which is broken the same way on every device. */
  double xy[2 * SIDE * SIDE];
  for (int i = 0; i < SIDE * SIDE; ++i) {
    xy[2 * i] = i % SIDE;
    xy[2 * i + 1] = i / SIDE;
  }
  flaunay_triangulator* triangulator = NULL;
  flaunay_triangulation* mesh = NULL;
  check(flaunay_triangulator_create(NULL, &triangulator));
  check(flaunay_triangulate(triangulator, xy, SIDE * SIDE, NULL, 1, NULL, &mesh));
  printf("flaunay %s: %d points, %zu triangles, %zu on the hull\n", flaunay_version(), SIDE * SIDE,
         flaunay_triangulation_mesh(mesh)->triangle_count, flaunay_triangulation_mesh(mesh)->hull_count);

  const double queries[2 * QUERIES] = {0.25, 0.125, 7, 7, -1, 3};
  int32_t triangles[QUERIES], nearest[QUERIES];
  flaunay_locator* locator = NULL;
  check(flaunay_locator_create(triangulator, xy, NULL, SIDE * SIDE, NULL, 1, mesh, &locator));
  check(flaunay_locator_locate(locator, queries, QUERIES, NULL, 1, triangles));
  check(flaunay_locator_nearest(locator, queries, QUERIES, NULL, 1, nearest));
  for (int q = 0; q < QUERIES; ++q) {
    printf("(%g, %g): triangle %d, nearest point %d\n", queries[2 * q], queries[2 * q + 1], (int)triangles[q],
           (int)nearest[q]);
  }
  flaunay_locator_destroy(locator);
  flaunay_triangulation_destroy(mesh);
  flaunay_triangulator_destroy(triangulator);
  return EXIT_SUCCESS;
}
