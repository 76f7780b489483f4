// For scripts/fingerprint.py: calls the C library in many ways and prints one line for each, "key hash" or
// "key text". It asserts nothing; two builds are compared by what they print. It is compiled against the
// headers of an older version too, so modes are given as numbers.
#include <CL/cl.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flaunay/flaunay.h"

enum { kModes = 6, kRandomPoints = 3000, kManySets = 400, kQueries = 500, kMostPoints = 4096 };

static const unsigned kAllParts = FLAUNAY_PART_TRIANGLES | FLAUNAY_PART_NEIGHBORS | FLAUNAY_PART_HALFEDGES |
                                  FLAUNAY_PART_HULL | FLAUNAY_PART_REPRESENTATIVES;
static const unsigned kAllVoronoiParts[] = {FLAUNAY_VORONOI_CIRCUMCENTRES, FLAUNAY_VORONOI_CELL_OFFSETS,
                                            FLAUNAY_VORONOI_CELLS, FLAUNAY_VORONOI_UNBOUNDED};

static flaunay_triangulator* triangulator;
static cl_context context;
static cl_command_queue queue;

// ---- Hashes and lines

// FNV-1a.
static uint64_t add(uint64_t hash, const void* data, size_t bytes) {
  const unsigned char* byte = data;
  for (size_t k = 0; k < bytes; ++k) hash = (hash ^ byte[k]) * 1099511628211u;
  return hash;
}

static uint64_t hash_of(const void* data, size_t bytes) { return add(14695981039346656037u, data, bytes); }

static void print_hash(const char* key, const char* what, const void* data, size_t bytes) {
  if (data == NULL) {
    printf("%s/%s none\n", key, what);
  } else {
    printf("%s/%s %zu bytes, %016llx\n", key, what, bytes, (unsigned long long)hash_of(data, bytes));
  }
}

// Whether the call succeeded; if not, a line says why.
static int succeeded(const char* key, flaunay_status status) {
  if (status != FLAUNAY_SUCCESS) printf("%s/error %d: %s\n", key, (int)status, flaunay_last_error());
  return status == FLAUNAY_SUCCESS;
}

static void require(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "library.c: %s failed: %s\n", what, flaunay_last_error());
  exit(1);
}

// ---- Points

typedef struct {
  const char* name;
  size_t count, sets;
  double points[2 * kMostPoints];
  size_t offsets[kManySets + 1];  // all sets' points one after the other
} Sets;

static uint64_t state;

static double random_integer(unsigned bits) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> (64 - bits));
}

static void add_point(Sets* sets, double x, double y) {
  sets->points[2 * sets->count] = x;
  sets->points[2 * sets->count + 1] = y;
  ++sets->count;
}

static void end_set(Sets* sets) { sets->offsets[++sets->sets] = sets->count; }

// Coordinates of so few bits are the same as float.
static void add_random(Sets* sets, size_t count, unsigned bits) {
  for (size_t k = 0; k < count; ++k) {
    const double x = random_integer(bits);
    add_point(sets, x, random_integer(bits));
  }
}

static void make_empty(Sets* sets) { end_set(sets); }
static void make_no_sets(Sets* sets) { (void)sets; }
static void make_one(Sets* sets) { add_random(sets, 1, 20), end_set(sets); }
static void make_two(Sets* sets) { add_random(sets, 2, 20), end_set(sets); }
static void make_random(Sets* sets) { add_random(sets, kRandomPoints, 24), end_set(sets); }
static void make_duplicates(Sets* sets) { add_random(sets, 500, 4), end_set(sets); }

static void make_grid(Sets* sets) {
  for (int k = 0; k < 20 * 20; ++k) add_point(sets, k % 20, k / 20);
  end_set(sets);
}

static void make_collinear(Sets* sets) {
  for (int k = 0; k < 100; ++k) add_point(sets, k * 37 % 89, 3 * (k * 37 % 89) + 1);
  end_set(sets);
}

static void make_mixed(Sets* sets) {
  make_grid(sets), make_empty(sets), make_one(sets), make_collinear(sets), make_two(sets);
  make_duplicates(sets), make_empty(sets), make_random(sets), make_empty(sets);
}

static void make_many(Sets* sets) {
  for (size_t s = 0; s < kManySets; ++s) add_random(sets, s % 19, s % 3 == 0 ? 2 : 16), end_set(sets);
}

typedef struct {
  const char* name;
  void (*make)(Sets* sets);
} Fixture;

static const Fixture kFixtures[] = {{"empty", make_empty},      {"no-sets", make_no_sets},
                                    {"one", make_one},          {"two", make_two},
                                    {"random", make_random},    {"duplicates", make_duplicates},
                                    {"grid", make_grid},        {"collinear", make_collinear},
                                    {"mixed-sets", make_mixed}, {"many-sets", make_many}};

static Sets* make_sets(const Fixture* fixture) {
  Sets* sets = calloc(1, sizeof *sets);
  require(sets != NULL, "calloc");
  state = 1;
  sets->name = fixture->name;
  fixture->make(sets);
  return sets;
}

// ---- Host memory

static void print_statistics(const char* key, const flaunay_statistics* of) {
  printf(
      "%s/statistics points %zu, duplicates %zu, triangles %zu, hull %zu, launches %zu, waits %zu, "
      "to device %zu, to host %zu, allocations %zu, peak %zu, undecided %zu, phases",
      key, of->points, of->duplicates, of->triangles, of->hull_vertices, of->kernel_launches, of->host_waits,
      of->bytes_to_device, of->bytes_to_host, of->device_allocations, of->device_bytes_peak, of->undecided);
  for (size_t k = 0; k < of->phase_count; ++k) printf(" %s", of->phases[k].name);
  printf("\n");
}

static void print_triangulation(const char* key, const flaunay_triangulation* mesh) {
  const size_t corners = 3 * flaunay_triangulation_mesh(mesh)->triangle_count * sizeof(int32_t);
  const size_t offsets = (flaunay_triangulation_mesh(mesh)->set_count + 1) * sizeof(size_t);
  const size_t hull = flaunay_triangulation_mesh(mesh)->hull_count * sizeof(int32_t);
  const size_t points = flaunay_triangulation_mesh(mesh)->point_count * sizeof(int32_t);
  print_hash(key, "triangles", flaunay_triangulation_mesh(mesh)->triangles, corners);
  print_hash(key, "neighbors", flaunay_triangulation_mesh(mesh)->neighbors, corners);
  print_hash(key, "halfedges", flaunay_triangulation_mesh(mesh)->halfedges, corners);
  print_hash(key, "hull", flaunay_triangulation_mesh(mesh)->hull, hull);
  print_hash(key, "representatives", flaunay_triangulation_mesh(mesh)->representatives, points);
  print_hash(key, "triangle-offsets", flaunay_triangulation_mesh(mesh)->triangle_offsets, offsets);
  print_hash(key, "hull-offsets", flaunay_triangulation_mesh(mesh)->hull_offsets, offsets);
  print_statistics(key, flaunay_triangulation_mesh(mesh)->statistics);
}

static void print_modes(const Sets* sets) {
  for (int mode = 0; mode < kModes; ++mode) {
    if (mode == 2 && sets->count > 500) continue;  // recursive-device: a thousand launches for each region
    const flaunay_options options = {.mode = mode,
                                     .parts = kAllParts,
                                     .partition_levels = mode == 4 ? 3 : 0,
                                     .threads = mode == 4 ? 2 : 0};
    char key[64];
    snprintf(key, sizeof key, "mode-%d/%s", mode, sets->name);
    flaunay_triangulation* mesh = NULL;
    if (succeeded(key, flaunay_triangulate(triangulator, sets->points, sets->count, sets->offsets, sets->sets,
                                           &options, &mesh))) {
      print_triangulation(key, mesh);
    }
    flaunay_triangulation_destroy(mesh);
  }
}

static void print_float(const Sets* sets) {
  static float narrow[2 * kMostPoints];
  for (size_t k = 0; k < 2 * sets->count; ++k) narrow[k] = (float)sets->points[k];
  char key[64];
  snprintf(key, sizeof key, "float/%s", sets->name);
  flaunay_triangulation* mesh = NULL;
  if (succeeded(key, flaunay_triangulate_float(triangulator, narrow, sets->count, sets->offsets, sets->sets,
                                               NULL, &mesh))) {
    print_triangulation(key, mesh);
  }
  flaunay_triangulation_destroy(mesh);
}

static double queries[2 * kQueries];
static double values[kMostPoints];

// As many queries for each set: points of the set, points between, points far outside.
static size_t make_queries(const Sets* sets, size_t* offsets) {
  state = 2;
  const size_t per_set = sets->sets == 0 ? 0 : kQueries / sets->sets;
  for (size_t s = 0; s <= sets->sets; ++s) offsets[s] = s * per_set;
  for (size_t s = 0; s < sets->sets; ++s) {
    const size_t count = sets->offsets[s + 1] - sets->offsets[s];
    for (size_t k = s * per_set; k < (s + 1) * per_set; ++k) {
      const size_t near = count == 0 ? 0 : sets->offsets[s] + (size_t)random_integer(30) % count;
      const double step = k % 3 == 0 ? 0 : random_integer(3) / 4;
      queries[2 * k] = sets->points[2 * near] + step;
      queries[2 * k + 1] = k % 7 == 6 ? -1e6 : sets->points[2 * near + 1] - step;
    }
  }
  return sets->sets * per_set;
}

static void print_derived(const Sets* sets) {
  static int32_t indices[kQueries];
  static double interpolated[kQueries];
  static size_t offsets[kManySets + 1];
  char key[64];
  snprintf(key, sizeof key, "derived/%s", sets->name);
  flaunay_triangulation* mesh = NULL;
  require(flaunay_triangulate(triangulator, sets->points, sets->count, sets->offsets, sets->sets, NULL,
                              &mesh) == FLAUNAY_SUCCESS,
          "flaunay_triangulate");
  flaunay_voronoi* dual = NULL;
  if (succeeded(key, flaunay_voronoi_compute(triangulator, sets->points, sets->count, mesh, &dual))) {
    print_hash(key, "circumcentres", flaunay_voronoi_circumcentres(dual),
               2 * sizeof(double) * flaunay_voronoi_triangle_count(dual));
    print_hash(key, "cell-offsets", flaunay_voronoi_cell_offsets(dual),
               sizeof(int32_t) * (flaunay_voronoi_point_count(dual) + 1));
    print_hash(key, "cells", flaunay_voronoi_cells(dual),
               sizeof(int32_t) * flaunay_voronoi_corner_count(dual));
    print_hash(key, "unbounded", flaunay_voronoi_unbounded(dual), flaunay_voronoi_point_count(dual));
  }
  flaunay_voronoi_destroy(dual);
  const size_t m = make_queries(sets, offsets);
  flaunay_locator* locator = NULL;
  if (succeeded(key, flaunay_locator_create(triangulator, sets->points, NULL, sets->count, sets->offsets,
                                            sets->sets, mesh, &locator))) {
    if (succeeded(key, flaunay_locator_locate(locator, queries, m, offsets, sets->sets, indices))) {
      print_hash(key, "locate", indices, m * sizeof *indices);
    }
    if (succeeded(key, flaunay_locator_nearest(locator, queries, m, offsets, sets->sets, indices))) {
      print_hash(key, "nearest", indices, m * sizeof *indices);
    }
    if (succeeded(key, flaunay_locator_interpolate(locator, values, queries, m, offsets, sets->sets, NULL,
                                                   interpolated))) {
      // Not-a-numbers have many forms.
      for (size_t k = 0; k < m; ++k) interpolated[k] = isnan(interpolated[k]) ? -1.0 : interpolated[k];
      print_hash(key, "interpolate", interpolated, m * sizeof *interpolated);
    }
  }
  flaunay_locator_destroy(locator);
  flaunay_triangulation_destroy(mesh);
}

// ---- Device memory

static cl_mem make_buffer(size_t bytes, const void* contents) {
  cl_int code = CL_SUCCESS;
  static const double nothing[2] = {0};
  cl_mem buffer = clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes > 0 ? bytes : 1,
                                 (void*)(bytes > 0 ? contents : nothing), &code);
  require(code == CL_SUCCESS, "clCreateBuffer");
  return buffer;
}

static void print_buffer(const char* key, const char* what, cl_mem memory, size_t bytes) {
  void* found = calloc(1, bytes + 1);
  require(found != NULL && clFinish(queue) == CL_SUCCESS, "clFinish");
  if (bytes > 0 && memory != NULL) {
    require(clEnqueueReadBuffer(queue, memory, CL_TRUE, 0, bytes, found, 0, NULL, NULL) == CL_SUCCESS,
            "clEnqueueReadBuffer");
  }
  print_hash(key, what, memory == NULL ? NULL : found, bytes);
  free(found);
}

static void print_device_derived(const char* key, const flaunay_device_points* input,
                                 const flaunay_device_triangulation* mesh, const Sets* sets) {
  const flaunay_enqueue enqueue = {.queue = queue};
  flaunay_device_voronoi* dual = NULL;
  require(flaunay_device_voronoi_create(&dual) == FLAUNAY_SUCCESS, "flaunay_device_voronoi_create");
  if (succeeded(key, flaunay_voronoi_compute_device(triangulator, input, mesh, &enqueue, dual))) {
    const size_t n = sets->count, t = flaunay_device_triangulation_mesh(mesh)->triangle_count;
    size_t bytes[] = {16 * t, 4 * (n + 1), 12 * t, n};
    static const char* const names[] = {"circumcentres", "cell-offsets", "cells", "unbounded"};
    for (int p = 0; p < 4; ++p) {
      print_buffer(key, names[p], flaunay_device_voronoi_buffer(dual, kAllVoronoiParts[p]), bytes[p]);
    }
  }
  flaunay_device_voronoi_destroy(dual);

  static size_t offsets[kManySets + 1];
  const size_t m = make_queries(sets, offsets);
  const flaunay_device_points query_points = {.memory = make_buffer(m * sizeof(double[2]), queries),
                                              .count = m,
                                              .offsets = offsets,
                                              .sets = sets->sets};
  cl_mem given_values = make_buffer(sizeof values, values);
  flaunay_locator* locator = NULL;
  if (succeeded(key, flaunay_locator_create_device(triangulator, input, mesh, &enqueue, &locator))) {
    cl_mem results[3] = {NULL};
    if (succeeded(key, flaunay_locator_locate_device(locator, &query_points, &enqueue, &results[0]))) {
      print_buffer(key, "locate", results[0], m * sizeof(int32_t));
    }
    if (succeeded(key, flaunay_locator_nearest_device(locator, &query_points, &enqueue, &results[1]))) {
      print_buffer(key, "nearest", results[1], m * sizeof(int32_t));
    }
    if (succeeded(key, flaunay_locator_interpolate_device(locator, given_values, &query_points, NULL,
                                                          &enqueue, &results[2]))) {
      print_buffer(key, "interpolate", results[2], m * sizeof(double));
    }
    for (int k = 0; k < 3; ++k) {
      if (results[k] != NULL) clReleaseMemObject(results[k]);
    }
  }
  flaunay_locator_destroy(locator);
  clReleaseMemObject(given_values);
  clReleaseMemObject(query_points.memory);
}

// What calls on device memory return: offsets in host memory or in device memory, points behind others in the
// buffer or at its beginning.
static void print_on_device(const Sets* sets, int offsets_on_device, size_t first) {
  static double shifted[2 * kMostPoints + 2 * 8];
  memcpy(shifted + 2 * first, sets->points, sets->count * sizeof(double[2]));
  int32_t narrow_offsets[kManySets + 1] = {0};
  for (size_t s = 0; s <= sets->sets; ++s) narrow_offsets[s] = (int32_t)sets->offsets[s];
  char key[64];
  snprintf(key, sizeof key, "device%s%s/%s", offsets_on_device ? "-offsets" : "", first > 0 ? "-behind" : "",
           sets->name);
  cl_mem device_offsets = make_buffer((sets->sets + 1) * sizeof(int32_t), narrow_offsets);
  flaunay_device_points input = {.memory = make_buffer((first + sets->count) * sizeof(double[2]), shifted),
                                 .count = sets->count,
                                 .first = first,
                                 .sets = sets->sets};
  if (offsets_on_device) {
    input.device_offsets = device_offsets;
  } else {
    input.offsets = sets->offsets;
  }
  const flaunay_enqueue enqueue = {.queue = queue};
  flaunay_device_triangulation* mesh = NULL;
  require(flaunay_device_triangulation_create(&mesh) == FLAUNAY_SUCCESS,
          "flaunay_device_triangulation_create");
  if (succeeded(key, flaunay_triangulate_device(triangulator, &input, kAllParts, &enqueue, mesh))) {
    static const char* const names[] = {"triangles", "neighbors", "halfedges", "hull", "representatives"};
    const size_t t = flaunay_device_triangulation_mesh(mesh)->triangle_count;
    const size_t counts[] = {3 * t, 3 * t, 3 * t, flaunay_device_triangulation_mesh(mesh)->hull_count,
                             sets->count};
    for (int p = 0; p < 5; ++p) {
      print_buffer(key, names[p], flaunay_device_triangulation_buffer(mesh, 1u << p), counts[p] * 4);
    }
    const size_t bytes = (sets->sets + 1) * sizeof(size_t);
    print_hash(key, "point-offsets", flaunay_device_triangulation_mesh(mesh)->point_offsets, bytes);
    print_hash(key, "triangle-offsets", flaunay_device_triangulation_mesh(mesh)->triangle_offsets, bytes);
    print_hash(key, "hull-offsets", flaunay_device_triangulation_mesh(mesh)->hull_offsets, bytes);
    print_statistics(key, flaunay_device_triangulation_mesh(mesh)->statistics);
    if (first == 0 && !offsets_on_device) print_device_derived(key, &input, mesh, sets);
  }
  flaunay_device_triangulation_destroy(mesh);
  clReleaseMemObject(input.memory);
  clReleaseMemObject(device_offsets);
}

// ---- Wrong requests

static void print_errors(void) {
  static const double kBad[3][6] = {
      {0, 0, 1, NAN, 2, 2}, {0, 0, 1e-300, 1, 1e300, 2}, {INFINITY, 0, 1, 1, 2, 2}};
  static const size_t kDecreasing[] = {0, 2, 1, 3}, kShort[] = {0, 2};
  static const int kWrong = 99;
  const flaunay_options options[] = {
      {.mode = kWrong}, {.cut = kWrong},          {.hull = kWrong},           {.parts = 1024},
      {.hull = 3},      {.partition_levels = -1}, {.mode = 4, .threads = -1}, {.reserved = {1}}};
  flaunay_triangulation* mesh = NULL;
  char key[32];
  for (int k = 0; k < 3; ++k) {
    snprintf(key, sizeof key, "wrong/points-%d", k);
    succeeded(key, flaunay_triangulate(triangulator, kBad[k], 3, NULL, 0, NULL, &mesh));
  }
  for (size_t k = 0; k < sizeof options / sizeof *options; ++k) {
    snprintf(key, sizeof key, "wrong/options-%zu", k);
    succeeded(key, flaunay_triangulate(triangulator, values, 3, NULL, 0, &options[k], &mesh));
    flaunay_triangulation_destroy(mesh);
  }
  succeeded("wrong/decreasing", flaunay_triangulate(triangulator, values, 3, kDecreasing, 3, NULL, &mesh));
  succeeded("wrong/short", flaunay_triangulate(triangulator, values, 3, kShort, 1, NULL, &mesh));
  succeeded("wrong/null", flaunay_triangulate(NULL, values, 3, NULL, 0, NULL, &mesh));
  succeeded("wrong/no-points", flaunay_triangulate(triangulator, NULL, 3, NULL, 0, NULL, &mesh));
  succeeded("wrong/too-many", flaunay_triangulate(triangulator, values, SIZE_MAX / 64, NULL, 0, NULL, &mesh));
  succeeded("wrong/on-host", flaunay_triangulate_on_host(values, 3, NULL, 0, NULL, &mesh));
  flaunay_triangulator* none = NULL;
  succeeded("wrong/device", flaunay_triangulator_create("no such device", &none));
  size_t bytes = 0;
  if (succeeded("workspace", flaunay_triangulator_workspace_bytes(triangulator, 100000, 10, &bytes))) {
    printf("workspace/bytes %zu\n", bytes);
  }
  cl_mem small = make_buffer(sizeof values, values);
  succeeded("workspace", flaunay_triangulator_use_workspace(triangulator, small));
  Sets* sets = make_sets(&kFixtures[4]);
  succeeded("workspace/small",
            flaunay_triangulate(triangulator, sets->points, sets->count, NULL, 0, NULL, &mesh));
  free(sets);
  clReleaseMemObject(small);
}

int main(void) {
  require(flaunay_triangulator_create(NULL, &triangulator) == FLAUNAY_SUCCESS, "flaunay_triangulator_create");
  context = flaunay_triangulator_context(triangulator);
  queue = flaunay_triangulator_queue(triangulator);
  state = 3;
  for (size_t k = 0; k < kMostPoints; ++k) values[k] = random_integer(16);
  for (size_t k = 0; k < sizeof kFixtures / sizeof *kFixtures; ++k) {
    Sets* sets = make_sets(&kFixtures[k]);
    print_modes(sets);
    print_float(sets);
    print_derived(sets);
    print_on_device(sets, 0, 0);
    print_on_device(sets, 1, 0);
    print_on_device(sets, 0, 3);
    free(sets);
  }
  print_errors();
  flaunay_triangulator_destroy(triangulator);
  return 0;
}
