/* Triangulates points in chunks. Two functions read the points and write the triangles.
 *
 *   chunks_of_streams
 */
#include <flaunay/flaunay.h>
#include <inttypes.h>
#include <stdio.h>

static int read_points(uint64_t first, size_t count, double* coordinates, void* file) {
  if (fseek(file, (long)(first * 2 * sizeof(double)), SEEK_SET) != 0) return 1;
  return fread(coordinates, 2 * sizeof(double), count, file) == count ? 0 : 1;
}

static int write_part(unsigned part, uint64_t first, const int64_t* values, size_t count, void* file) {
  if (part != FLAUNAY_PART_TRIANGLES) return 1;  // nothing else is wanted
  if (fseek(file, (long)(first * sizeof *values), SEEK_SET) != 0) return 1;
  return fwrite(values, sizeof *values, count, file) == count ? 0 : 1;
}

int main(void) {
  const double xy[] = {0, 0, 4, 0, 4, 3, 0, 4};
  FILE* input = tmpfile();
  FILE* output = tmpfile();
  if (input == NULL || output == NULL || fwrite(xy, sizeof xy, 1, input) != 1) return 1;
  const flaunay_point_source points = {.count = 4, .read = read_points, .data = input};
  const flaunay_mesh_sink mesh = {.parts = FLAUNAY_PART_TRIANGLES, .write = write_part, .data = output};
  flaunay_chunk_options options = {0};
  options.memory_bytes = (uint64_t)1 << 30;
  flaunay_chunk_report* report = NULL;
  if (flaunay_triangulate_streams(&points, &mesh, &options, &report) != FLAUNAY_SUCCESS) {
    fprintf(stderr, "%s\n", flaunay_last_error());
    return 1;
  }
  printf("%" PRIu64 " triangles\n", flaunay_chunk_report_statistics(report)->triangles);
  flaunay_chunk_report_destroy(report);
  return 0;
}
