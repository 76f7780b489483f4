/* Run by scripts/wheel-test.sh with a wheel's library on the system that it is for, or in an emulator:
   triangulates points of which many are on one circle or equal, and prints a number that depends on every
   index of the result. check [POINTS [RUNS]]    the least time of the runs is printed, too */
#include <flaunay/flaunay.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static uint64_t state = 1;

static double next_random(void) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> 11);
}

int main(int argc, char** argv) {
  const size_t n = argc > 1 ? (size_t)atol(argv[1]) : 20000;
  const int runs = argc > 2 ? atoi(argv[2]) : 0;
  double* const xy = malloc(2 * n * sizeof *xy);
  flaunay_triangulator* triangulator;
  flaunay_triangulation* mesh;
  uint64_t hash = 0;
  double least = 1e9;
  if (xy == NULL || flaunay_triangulator_create("host", &triangulator) != FLAUNAY_SUCCESS) {
    fprintf(stderr, "check: %s\n", flaunay_last_error());
    return 1;
  }
  for (size_t i = 0; i < n; ++i) {
    /* A third are on a coarse grid; of these, many are equal or on one circle. */
    const double unit = i % 3 == 0 ? 70368744177664.0 : 1.0;
    xy[2 * i] = unit * (double)(int64_t)(next_random() / unit);
    xy[2 * i + 1] = unit * (double)(int64_t)(next_random() / unit);
  }
  for (int run = 0; run <= runs; ++run) {
    struct timespec begin, end;
    timespec_get(&begin, TIME_UTC);
    if (flaunay_triangulate(triangulator, xy, n, NULL, 0, NULL, &mesh) != FLAUNAY_SUCCESS) {
      fprintf(stderr, "check: %s\n", flaunay_last_error());
      return 1;
    }
    timespec_get(&end, TIME_UTC);
    const double seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
    if (seconds < least) least = seconds;
    if (run < runs) flaunay_triangulation_destroy(mesh);
  }
  const size_t triangles = flaunay_triangulation_mesh(mesh)->triangle_count;
  const int32_t* const vertices = flaunay_triangulation_mesh(mesh)->triangles;
  for (size_t k = 0; k < 3 * triangles; ++k) hash = hash * 1099511628211u + (uint64_t)vertices[k] + 1;
  printf("flaunay %s: %zu triangles, %016llx\n", flaunay_version(), triangles, (unsigned long long)hash);
  if (runs > 0) fprintf(stderr, "%.4f s\n", least);
  flaunay_triangulation_destroy(mesh);
  flaunay_triangulator_destroy(triangulator);
  free(xy);
  return 0;
}
