// The native library's time for one set, as one.js prints it: native POINTS.npy. For one thread, see
// bench.py.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "flaunay/flaunay.h"

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int compare(const void* a, const void* b) {
  return (*(const double*)a > *(const double*)b) - (*(const double*)a < *(const double*)b);
}

static double time_of(flaunay_triangulator* triangulator, const double* coordinates, size_t n, size_t calls) {
  const flaunay_options options = {.parts = FLAUNAY_PART_HALFEDGES};
  const double begin = now();
  for (size_t i = 0; i < calls; ++i) {
    flaunay_triangulation* mesh = NULL;
    if (flaunay_triangulate(triangulator, coordinates, n, NULL, 0, &options, &mesh) != FLAUNAY_SUCCESS)
      exit(1);
    flaunay_triangulation_destroy(mesh);
  }
  return (now() - begin) / (double)calls;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  FILE* const file = fopen(argv[1], "rb");
  uint16_t header = 0;
  if (file == NULL || fseek(file, 8, SEEK_SET) != 0 || fread(&header, 2, 1, file) != 1) return 1;
  if (fseek(file, 0, SEEK_END) != 0) return 1;
  const size_t n = ((size_t)ftell(file) - 10 - header) / 16;
  double* const coordinates = malloc(16 * n);
  if (fseek(file, 10 + header, SEEK_SET) != 0 || fread(coordinates, 16, n, file) != n) return 1;
  flaunay_triangulator* triangulator = NULL;
  if (flaunay_triangulator_create(NULL, &triangulator) != FLAUNAY_SUCCESS) return 1;
  const double first = time_of(triangulator, coordinates, n, 1);
  const double once = time_of(triangulator, coordinates, n, 3);
  const size_t calls = once > 0.01 ? 1 : (size_t)(0.01 / once) + 1;
  double samples[11];
  for (int i = 0; i < 11; ++i) samples[i] = time_of(triangulator, coordinates, n, calls);
  qsort(samples, 11, sizeof *samples, compare);
  printf("{\"first\": %.9f, \"seconds\": %.9f, \"fastest\": %.9f}\n", first, samples[5], samples[0]);
  return 0;
}
