// The C interface: what it returns, and what it says of bad use. c_test no-fp64, small-buffers and
// big-endian: with support/poor_device.c preloaded, which has limits of that name.
#include <CL/cl.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <threads.h>
#include <unistd.h>

#include "flaunay/flaunay.h"

static int failures = 0;

static int check(int holds, const char* what, int line) {
  if (!holds) {
    fprintf(stderr, "c_test.c:%d: %s; last error: %s\n", line, what, flaunay_last_error());
    ++failures;
  }
  return holds;
}

// Goes on after a failure; where that would crash, REQUIRE does not.
#define CHECK(condition) check((condition), #condition, __LINE__)
#define REQUIRE(condition) \
  if (!CHECK(condition)) exit(1)
#define OK(call) REQUIRE((call) == FLAUNAY_SUCCESS)
#define REFUSED(call, text) CHECK(fails(call, FLAUNAY_ERROR_USAGE, text))
#define WRONG_INPUT(call, text) CHECK(fails(call, FLAUNAY_ERROR_INPUT, text))

// The call failed so, and its message has the text.
static int fails(flaunay_status got, flaunay_status expected, const char* text) {
  return got == expected && strstr(flaunay_last_error(), text) != NULL;
}

enum { kPoints = 5000 };

// A device of the caller's, and a triangulator on it, which all tests share: programs take seconds to build.
static cl_context context;
static cl_device_id device;
static cl_command_queue queue;
static flaunay_triangulator* triangulator;
static double points[2 * kPoints];

static const unsigned kAllParts = FLAUNAY_PART_TRIANGLES | FLAUNAY_PART_NEIGHBORS | FLAUNAY_PART_HALFEDGES |
                                  FLAUNAY_PART_HULL | FLAUNAY_PART_REPRESENTATIVES | FLAUNAY_PART_AREAS;

static const double kSquare[] = {0, 0, 4, 0, 4, 3, 0, 4};

static cl_context make_context(void) {
  cl_int code = CL_SUCCESS;
  cl_context result = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
  REQUIRE(code == CL_SUCCESS);
  return result;
}

static cl_command_queue make_queue(cl_context owner, cl_command_queue_properties properties) {
  cl_int code = CL_SUCCESS;
  cl_command_queue result = clCreateCommandQueue(owner, device, properties, &code);
  REQUIRE(code == CL_SUCCESS);
  return result;
}

// What functions here make for a test is released after it.
static cl_mem buffers[32];
static void* blocks[32];
static size_t buffer_count, block_count;
static flaunay_triangulation* meshes[16];
static flaunay_triangulation* constrained_meshes[16];
static flaunay_device_triangulation* device_meshes[16];
static size_t mesh_count, constrained_count, device_mesh_count;

static void* allocate(size_t bytes) {
  REQUIRE(block_count < sizeof blocks / sizeof *blocks);
  void* block = calloc(bytes + 1, 1);
  REQUIRE(block != NULL);
  return blocks[block_count++] = block;
}

static void release_all(void) {
  while (mesh_count > 0) flaunay_triangulation_destroy(meshes[--mesh_count]);
  while (constrained_count > 0) flaunay_triangulation_destroy(constrained_meshes[--constrained_count]);
  while (device_mesh_count > 0) flaunay_device_triangulation_destroy(device_meshes[--device_mesh_count]);
  while (buffer_count > 0) clReleaseMemObject(buffers[--buffer_count]);
  while (block_count > 0) free(blocks[--block_count]);
}

static cl_mem make_buffer(cl_context owner, size_t bytes, const void* contents) {
  REQUIRE(buffer_count < sizeof buffers / sizeof *buffers);
  cl_int code = CL_SUCCESS;
  const cl_mem_flags copies = contents != NULL ? CL_MEM_COPY_HOST_PTR : 0;
  cl_mem result = clCreateBuffer(owner, CL_MEM_READ_WRITE | copies, bytes, (void*)contents, &code);
  REQUIRE(code == CL_SUCCESS);
  return buffers[buffer_count++] = result;
}

static void make_points(void) {
  uint64_t state = 1;
  for (size_t k = 0; k < 2 * kPoints; ++k) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    points[k] = (double)(state >> 40);  // of 24 bits: the same as float
  }
}

static void set_up(void) {
  make_points();
  flaunay_triangulator* chosen = NULL;
  OK(flaunay_triangulator_create(NULL, &chosen));
  device = flaunay_triangulator_device_id(chosen);
  CHECK(flaunay_triangulator_context(chosen) != NULL);
  CHECK(flaunay_triangulator_queue(chosen) != NULL);
  flaunay_triangulator_destroy(chosen);
  context = make_context();
  queue = make_queue(context, 0);
  OK(flaunay_triangulator_create_in_context(context, device, &triangulator));
}

static void tear_down(void) {
  flaunay_triangulator_destroy(triangulator);
  clReleaseCommandQueue(queue);
  clReleaseContext(context);
}

static flaunay_triangulation* on_host(const double* coordinates, size_t n, const size_t* offsets, size_t sets,
                                      unsigned parts) {
  REQUIRE(mesh_count < sizeof meshes / sizeof *meshes);
  flaunay_options options = {0};
  options.parts = parts;
  flaunay_triangulation* result = NULL;
  OK(flaunay_triangulate(triangulator, coordinates, n, offsets, sets, &options, &result));
  return meshes[mesh_count++] = result;
}

static int same(const int32_t* a, const int32_t* b, size_t count) {
  return count == 0 || (a != NULL && b != NULL && memcmp(a, b, count * sizeof *a) == 0);
}

static int same_sizes(const size_t* a, const size_t* b, size_t count) {
  return a != NULL && b != NULL && memcmp(a, b, count * sizeof *a) == 0;
}

// ---- What needs no points

static void test_statuses(void) {
  CHECK(strcmp(flaunay_status_string(FLAUNAY_SUCCESS), "success") == 0);
  CHECK(strcmp(flaunay_status_string(FLAUNAY_ERROR_MEMORY), "out of host memory") == 0);
  CHECK(strcmp(flaunay_status_string(-1), "unknown status") == 0);
  CHECK(strchr(flaunay_version(), '.') != NULL);
  CHECK(strcmp(flaunay_last_error(), "") == 0);
  CHECK(strcmp(flaunay_last_error_call(), "") == 0);
  CHECK(flaunay_last_error_code() == 0 && flaunay_last_error_status() == FLAUNAY_SUCCESS);
}

static int has_no_error(void* unused) {
  (void)unused;
  return strcmp(flaunay_last_error(), "") == 0;
}

static void test_errors_are_of_threads(void) {
  flaunay_triangulator_capacity(NULL);
  CHECK(strstr(flaunay_last_error(), "NULL") != NULL);
  thrd_t thread;
  int result = 0;
  REQUIRE(thrd_create(&thread, has_no_error, NULL) == thrd_success);
  CHECK(thrd_join(thread, &result) == thrd_success && result == 1);
}

static void test_devices(void) {
  flaunay_device_list* list = NULL;
  OK(flaunay_device_list_create(0, &list));
  CHECK(flaunay_device_list_count(list) >= 1);
  CHECK(flaunay_device_list_at(list, flaunay_device_list_count(list)) == NULL);
  const flaunay_device_info* own = flaunay_triangulator_device(triangulator);
  int is_listed = 0;
  for (size_t k = 0; k < flaunay_device_list_count(list); ++k) {
    const flaunay_device_info* info = flaunay_device_list_at(list, k);
    CHECK(info->name[0] != '\0' && info->self_test_passed == 0 && info->self_test_failure[0] == '\0');
    is_listed |= strcmp(info->name, own->name) == 0;
  }
  CHECK(is_listed);
  CHECK(own->fp64 == 1 && own->self_test_passed == 1 && own->memory_bytes > 0);
  CHECK(flaunay_triangulator_capacity(triangulator) > kPoints);
  flaunay_device_list_destroy(list);
}

static void test_added_drivers(void) {
  flaunay_device_list *before = NULL, *after = NULL;
  OK(flaunay_device_list_create(0, &before));
  OK(flaunay_add_driver("Nobody's platform", "/nowhere/libdriver.so"));
  OK(flaunay_add_driver("Nobody's platform", "libm.so.6"));
  OK(flaunay_device_list_create(0, &after));
  CHECK(flaunay_device_list_count(after) == flaunay_device_list_count(before));
  flaunay_device_list_destroy(before);
  flaunay_device_list_destroy(after);
}

static void test_devices_that_are_none(void) {
  flaunay_triangulator* none = triangulator;
  CHECK(fails(flaunay_triangulator_create("no such device", &none), FLAUNAY_ERROR_DEVICE, "no such device"));
  CHECK(none == NULL);
  CHECK(fails(flaunay_triangulator_create("#1000", &none), FLAUNAY_ERROR_DEVICE, "#1000"));
  REFUSED(flaunay_triangulator_create_in_context(NULL, device, &none), "context");
  REFUSED(flaunay_triangulator_create_in_context(context, NULL, &none), "device");
}

// ---- Host memory

static void test_square(void) {
  flaunay_triangulation* mesh = on_host(kSquare, 4, NULL, 0, 0);
  CHECK(flaunay_triangulation_mesh(mesh)->point_count == 4);
  CHECK(flaunay_triangulation_mesh(mesh)->set_count == 1);
  CHECK(flaunay_triangulation_mesh(mesh)->triangle_count == 2);
  CHECK(flaunay_triangulation_mesh(mesh)->hull_count == 4);
  CHECK(same(flaunay_triangulation_mesh(mesh)->hull, (const int32_t[]){0, 1, 2, 3}, 4));
  CHECK(same(flaunay_triangulation_mesh(mesh)->representatives, (const int32_t[]){0, 1, 2, 3}, 4));
  CHECK(same_sizes(flaunay_triangulation_mesh(mesh)->triangle_offsets, (const size_t[]){0, 2}, 2));
  CHECK(same_sizes(flaunay_triangulation_mesh(mesh)->hull_offsets, (const size_t[]){0, 4}, 2));
  CHECK(flaunay_triangulation_mesh(mesh)->neighbors != NULL);
  CHECK(flaunay_triangulation_mesh(mesh)->halfedges == NULL);
  const flaunay_statistics* statistics = flaunay_triangulation_mesh(mesh)->statistics;
  CHECK(statistics->points == 4 && statistics->triangles == 2 && statistics->hull_vertices == 4);
  CHECK(statistics->kernel_launches > 0 && statistics->host_waits > 0 && statistics->seconds > 0);
  CHECK(statistics->phase_count > 0 && statistics->phases[0].name[0] != '\0');
  CHECK(statistics->kernel_count == 0 && statistics->kernels == NULL);
}

static void test_float(void) {
  float* narrow = allocate(2 * kPoints * sizeof *narrow);
  for (size_t k = 0; k < 2 * kPoints; ++k) narrow[k] = (float)points[k];
  flaunay_triangulation *wide = on_host(points, kPoints, NULL, 0, 0), *result = NULL;
  OK(flaunay_triangulate_float(triangulator, narrow, kPoints, NULL, 0, NULL, &result));
  const size_t triangles = flaunay_triangulation_mesh(wide)->triangle_count;
  CHECK(flaunay_triangulation_mesh(result)->triangle_count == triangles);
  CHECK(same(flaunay_triangulation_mesh(result)->triangles, flaunay_triangulation_mesh(wide)->triangles,
             3 * triangles));
  CHECK(same(flaunay_triangulation_mesh(result)->neighbors, flaunay_triangulation_mesh(wide)->neighbors,
             3 * triangles));
  flaunay_triangulation_destroy(result);
}

// Sets of a square, of none, of collinear points with a duplicate, and of a triangle.
static const double kSets[] = {0, 0, 4, 0, 4, 3, 0, 4, 2, 2, 1, 1, 2, 2, 0, 0, 1, 0, 0, 1};
static const size_t kSetOffsets[] = {0, 4, 4, 7, 10};

static void test_batches(void) {
  flaunay_triangulation* mesh = on_host(kSets, 10, kSetOffsets, 4, 0);
  CHECK(flaunay_triangulation_mesh(mesh)->set_count == 4);
  CHECK(same_sizes(flaunay_triangulation_mesh(mesh)->triangle_offsets, (const size_t[]){0, 2, 2, 2, 3}, 5));
  CHECK(same_sizes(flaunay_triangulation_mesh(mesh)->hull_offsets, (const size_t[]){0, 4, 4, 6, 9}, 5));
  CHECK(same(flaunay_triangulation_mesh(mesh)->hull, (const int32_t[]){0, 1, 2, 3, 5, 4, 7, 8, 9}, 9));
  CHECK(same(flaunay_triangulation_mesh(mesh)->representatives,
             (const int32_t[]){0, 1, 2, 3, 4, 5, 4, 7, 8, 9}, 10));
  CHECK(same(flaunay_triangulation_mesh(mesh)->triangles + 6, (const int32_t[]){7, 8, 9}, 3));
  CHECK(flaunay_triangulation_mesh(mesh)->statistics->duplicates == 1);
}

static void test_modes(void) {
  for (int mode = FLAUNAY_MODE_BLOCKS; mode <= FLAUNAY_MODE_DWYER; ++mode) {
    flaunay_options options = {.mode = mode, .cut = FLAUNAY_CUT_ALTERNATE};
    flaunay_triangulation* mesh = NULL;
    OK(flaunay_triangulate(triangulator, kSets, 10, kSetOffsets, 4, &options, &mesh));
    CHECK(same_sizes(flaunay_triangulation_mesh(mesh)->triangle_offsets, (const size_t[]){0, 2, 2, 2, 3}, 5));
    CHECK(flaunay_triangulation_mesh(mesh)->point_count == 10 &&
          flaunay_triangulation_mesh(mesh)->set_count == 4);
    flaunay_triangulation_destroy(mesh);
  }
}

static void test_names_of_modes(void) {
  REQUIRE(flaunay_mode_count() == FLAUNAY_MODE_DWYER + 1);
  CHECK(flaunay_mode_at(0)->mode == FLAUNAY_MODE_BLOCKS && strcmp(flaunay_mode_at(0)->name, "blocks") == 0);
  unsigned seen = 0;
  for (size_t k = 0; k < flaunay_mode_count(); ++k) {
    const flaunay_mode_info* info = flaunay_mode_at(k);
    CHECK(strlen(info->description) > 10 && flaunay_mode_at(k) == info);
    seen |= 1u << info->mode;
    const flaunay_options options = {.mode = info->mode};
    flaunay_triangulation* mesh = NULL;
    CHECK((flaunay_triangulate_on_host(kSquare, 4, NULL, 0, &options, &mesh) == FLAUNAY_SUCCESS) ==
          (info->on_host == 1));
    flaunay_triangulation_destroy(mesh);
  }
  CHECK(seen == (1u << flaunay_mode_count()) - 1);
  CHECK(flaunay_mode_at(flaunay_mode_count()) == NULL);
}

static void test_mesh_in_one_struct(void) {
  flaunay_triangulation* result = on_host(kSets, 10, kSetOffsets, 4, kAllParts);
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  REQUIRE(mesh != NULL);
  CHECK(mesh->point_count == 10 && mesh->set_count == 4 && mesh->triangle_count == 3);
  CHECK(mesh->hull_count == flaunay_triangulation_mesh(result)->hull_count);
  CHECK(mesh->triangles == flaunay_triangulation_mesh(result)->triangles && mesh->triangles != NULL);
  CHECK(mesh->neighbors == flaunay_triangulation_mesh(result)->neighbors && mesh->neighbors != NULL);
  CHECK(mesh->halfedges == flaunay_triangulation_mesh(result)->halfedges && mesh->halfedges != NULL);
  CHECK(mesh->areas == flaunay_triangulation_mesh(result)->areas && mesh->areas[0] + mesh->areas[1] == 14);
  CHECK(mesh->hull == flaunay_triangulation_mesh(result)->hull && mesh->hull != NULL);
  CHECK(mesh->representatives == flaunay_triangulation_mesh(result)->representatives);
  CHECK(mesh->triangle_offsets == flaunay_triangulation_mesh(result)->triangle_offsets);
  CHECK(mesh->hull_offsets == flaunay_triangulation_mesh(result)->hull_offsets);
  CHECK(mesh->statistics == flaunay_triangulation_mesh(result)->statistics && mesh->statistics->points == 10);
}

// Triangulations that were kept as arrays.

typedef struct {
  size_t n, t, h;
  const int32_t *triangles, *neighbors, *hull, *representatives;
} kept_mesh;

static flaunay_status create_from(kept_mesh kept, flaunay_triangulation** result) {
  const flaunay_mesh mesh = {.point_count = kept.n,
                             .set_count = 1,
                             .triangle_count = kept.t,
                             .hull_count = kept.h,
                             .triangles = kept.triangles,
                             .neighbors = kept.neighbors,
                             .hull = kept.hull,
                             .representatives = kept.representatives};
  return flaunay_triangulation_create(&mesh, NULL, result);
}

static void test_kept_triangulations(void) {
  flaunay_triangulation *original = on_host(points, kPoints, NULL, 0, 0), *result = NULL;
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(original);
  const kept_mesh kept = {kPoints,         mesh->triangle_count, mesh->hull_count,     mesh->triangles,
                          mesh->neighbors, mesh->hull,           mesh->representatives};
  OK(create_from(kept, &result));
  const flaunay_mesh* copy = flaunay_triangulation_mesh(result);
  CHECK(copy->point_count == kPoints && copy->set_count == 1 && copy->triangle_count == kept.t);
  CHECK(copy->triangles != kept.triangles && same(copy->triangles, kept.triangles, 3 * kept.t));
  CHECK(same(copy->neighbors, kept.neighbors, 3 * kept.t) && same(copy->hull, kept.hull, kept.h));
  CHECK(same(copy->representatives, kept.representatives, kPoints) && copy->halfedges == NULL);
  CHECK(copy->statistics->points == kPoints && copy->statistics->triangles == kept.t);

  // It serves as the original does.
  flaunay_locator* locator = NULL;
  OK(flaunay_locator_create(triangulator, points, NULL, kPoints, NULL, 0, result, &locator));
  int32_t* found = allocate(kPoints * sizeof *found);
  OK(flaunay_locator_nearest(locator, points, kPoints, NULL, 0, found));
  CHECK(same(found, kept.representatives, kPoints));
  flaunay_locator_destroy(locator);
  flaunay_triangulation_destroy(result);

  const kept_mesh none = {0};
  OK(create_from(none, &result));
  CHECK(flaunay_triangulation_mesh(result)->point_count == 0 &&
        flaunay_triangulation_mesh(result)->set_count == 1);
  flaunay_triangulation_destroy(result);
}

static const int32_t kTriangle[] = {0, 1, 2}, kNoNeighbors[] = {-1, -1, -1};

static void test_bad_kept_triangulations(void) {
  const kept_mesh good = {3, 1, 3, kTriangle, kNoNeighbors, kTriangle, kTriangle};
  flaunay_triangulation* result = NULL;
  const flaunay_status usage = FLAUNAY_ERROR_USAGE;
  OK(create_from(good, &result));
  flaunay_triangulation_destroy(result);
  const int32_t bad[][3] = {{0, 1, 3}, {-2, -1, -1}, {INT32_MIN, 1, 2}, {0, INT32_MAX, 1}};
  for (int k = 0; k < 4; ++k) {
    kept_mesh changed = good;
    changed.triangles = bad[k];
    CHECK(fails(create_from(changed, &result), usage, "triangles: ") && result == NULL);
    changed = good, changed.neighbors = bad[k];
    REFUSED(create_from(changed, &result), "neighbors: ");
    changed = good, changed.hull = bad[k];
    REFUSED(create_from(changed, &result), "hull vertices: ");
    changed = good, changed.representatives = bad[k];
    REFUSED(create_from(changed, &result), "representatives: ");
  }
  kept_mesh changed = good;
  changed.neighbors = kTriangle;  // triangle 1 of one
  REFUSED(create_from(changed, &result), "neighbors: 1 is none of the 1 triangles");
  changed = good, changed.t = SIZE_MAX / 3 + 1;
  WRONG_INPUT(create_from(changed, &result), "triangles are too many");
  changed = good, changed.hull = NULL;
  REFUSED(create_from(changed, &result), "3 values of hull, but the pointer to them is NULL");
  REFUSED(create_from(good, NULL), "handle");
  CHECK(flaunay_last_error_status() == usage);
}

static void test_tables_of_triangles(void) {
  flaunay_triangulation* result = on_host(kSquare, 4, NULL, 0, 0);
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  REQUIRE(mesh->triangle_count == 2 && mesh->hull_count == 4);
  // Point 4 is in no triangle.
  int32_t first[5], starts[6], neighbors[10];
  CHECK(flaunay_first_triangles(mesh->triangles, 2, 5, first) == FLAUNAY_SUCCESS && first[4] == -1);
  OK(flaunay_vertex_neighbors(mesh->triangles, 2, mesh->hull, 4, 5, starts, neighbors));
  CHECK(starts[0] == 0 && starts[4] == 10 && starts[5] == 10);
  for (int32_t i = 0; i < 4; ++i) {
    const int32_t expected = mesh->triangles[0] == i || mesh->triangles[1] == i || mesh->triangles[2] == i;
    CHECK(first[i] == !expected);
    for (int32_t k = starts[i]; k < starts[i + 1]; ++k) {
      CHECK(neighbors[k] != i && (k == starts[i] || neighbors[k - 1] < neighbors[k]));
    }
    // Beside it on the square; two opposite corners have an edge, too.
    CHECK(starts[i + 1] - starts[i] == 2 + (starts[i + 1] - starts[i] > 2));
  }

  // Points on one line have a hull, but no edges.
  OK(flaunay_vertex_neighbors(NULL, 0, kTriangle, 3, 3, starts, NULL));
  CHECK(starts[0] == 0 && starts[3] == 0);
  OK(flaunay_first_triangles(NULL, 0, 0, NULL));
  REFUSED(flaunay_first_triangles(kTriangle, 1, 2, first), "triangles: 2 is none of the 2 points");
  REFUSED(flaunay_vertex_neighbors(kTriangle, 1, kNoNeighbors, 3, 3, starts, neighbors), "hull vertices: -1");
}

// python/tests/test_triangles.py compares them with rational numbers.
static void test_measures_of_triangles(void) {
  // A square with its diagonal, and a point far off.
  const double places[] = {0, 0, 6, 0, 6, 6, 0, 6, 100, 90};
  const int32_t corners[] = {0, 1, 2, 0, 2, 3, 1, 4, 2}, beyond[] = {2, 1, -1, -1, -1, 0, -1, 0, -1};
  const int32_t halfedges[] = {-1, 8, 3, 2, -1, -1, -1, -1, 1}, others[] = {0, 2, 1, 0, 1, 1};
  int8_t turns[3], angles[9], sides[9];
  double radii[3];
  int32_t first[3];
  OK(flaunay_triangle_turns(places, 5, others, 2, turns));
  CHECK(turns[0] == -1 && turns[1] == 0);
  OK(flaunay_triangle_angles(places, 5, corners, 3, angles));
  CHECK(angles[0] == 1 && angles[1] == 0 && angles[8] == -1);
  OK(flaunay_circumradii(places, 5, corners, 3, radii));
  CHECK(fabs(radii[0] - sqrt(18)) < 1e-14 && radii[1] == radii[0] && radii[2] > radii[0]);
  OK(flaunay_triangle_areas(places, 5, others, 2, radii));
  CHECK(radii[0] == -18 && radii[1] == 0);
  OK(flaunay_same_circles(places, 5, corners, 3, beyond, first));
  CHECK(first[0] == 0 && first[1] == 0 && first[2] == 2);
  OK(flaunay_edge_circles(places, 5, corners, 3, halfedges, sides));
  const int8_t expected_sides[] = {-1, -1, 0, 0, -1, -1, -1, -1, -1};
  CHECK(memcmp(sides, expected_sides, sizeof sides) == 0);
  // Clockwise triangles with the wrong diagonal of a kite, and one without area.
  const double kite[] = {0, 0, 4, 1, 8, 0, 4, -1, 4, 0};
  const int32_t wrong_corners[] = {0, 1, 2, 0, 2, 3}, flat[] = {0, 1, 2, 0, 2, 4};
  const int32_t wrong_halfedges[] = {-1, -1, 3, 2, -1, -1};
  const int8_t wrong_sides[] = {-1, -1, 1, 1, -1, -1};
  OK(flaunay_edge_circles(kite, 5, wrong_corners, 2, wrong_halfedges, sides));
  CHECK(memcmp(sides, wrong_sides, sizeof wrong_sides) == 0);
  OK(flaunay_edge_circles(kite, 5, flat, 2, wrong_halfedges, sides));
  CHECK(sides[3] == 1);

  OK(flaunay_circumradii(NULL, 0, NULL, 0, NULL));
  REFUSED(flaunay_circumradii(places, 4, corners, 3, radii), "triangles: 4 is none");
  REFUSED(flaunay_same_circles(places, 5, corners, 2, beyond, first), "neighbors: 2 is none");
  const double wrong[] = {0, 0, NAN, 0, 6, 6};
  WRONG_INPUT(flaunay_triangle_angles(wrong, 3, corners, 1, angles), "not finite");
}

static void test_on_host(void) {
  flaunay_options options = {.mode = FLAUNAY_MODE_DWYER};
  flaunay_triangulation* mesh = NULL;
  OK(flaunay_triangulate_on_host(kSquare, 4, NULL, 0, &options, &mesh));
  CHECK(flaunay_triangulation_mesh(mesh)->triangle_count == 2);
  flaunay_triangulation_destroy(mesh);
  REFUSED(flaunay_triangulate_on_host(NULL, 4, NULL, 0, &options, &mesh), "4 points");
  REFUSED(flaunay_triangulate_on_host(kSquare, 4, NULL, 0, NULL, &mesh), "modes");
}

static void count_calls(const char* stage, int level, double done, void* calls) {
  CHECK(stage != NULL && level >= -1 && done >= 0 && done <= 1);
  ++*(int*)calls;
}

static void test_progress_and_profile(void) {
  int calls = 0;
  flaunay_options options = {.progress = count_calls, .progress_data = &calls, .profile = 1};
  flaunay_triangulation* mesh = NULL;
  OK(flaunay_triangulate(triangulator, points, kPoints, NULL, 0, &options, &mesh));
  CHECK(calls > 0);
  const flaunay_statistics* statistics = flaunay_triangulation_mesh(mesh)->statistics;
  REQUIRE(statistics->kernel_count > 0);
  CHECK(statistics->kernels[0].name[0] != '\0' && statistics->kernels[0].launches > 0);
  CHECK(statistics->kernels[0].seconds >= statistics->kernels[statistics->kernel_count - 1].seconds);
  flaunay_triangulation_destroy(mesh);
}

static int triangulate_once(void* unused) {
  (void)unused;
  flaunay_triangulation* mesh = NULL;
  const int refused = fails(flaunay_triangulate(triangulator, kSquare, 4, NULL, 0, NULL, &mesh),
                            FLAUNAY_ERROR_USAGE, "in use") &&
                      mesh == NULL;
  flaunay_triangulation_destroy(mesh);
  return refused;
}

static void use_from_another_thread(const char* stage, int level, double done, void* refused) {
  (void)stage, (void)level, (void)done;
  thrd_t thread;
  int result = 0;
  REQUIRE(thrd_create(&thread, triangulate_once, NULL) == thrd_success);
  REQUIRE(thrd_join(thread, &result) == thrd_success);
  *(int*)refused += result;
}

static void test_a_triangulator_in_use(void) {
  int refused = 0;
  flaunay_options options = {.progress = use_from_another_thread, .progress_data = &refused};
  flaunay_triangulation* mesh = NULL;
  OK(flaunay_triangulate(triangulator, points, kPoints, NULL, 0, &options, &mesh));
  CHECK(refused >= 4);
  flaunay_triangulation_destroy(mesh);
  CHECK(!triangulate_once(NULL));
}

static void test_no_points(void) {
  const size_t zeros[3] = {0};
  for (size_t sets = 0; sets < 4; ++sets) {
    const flaunay_mesh* mesh =
        flaunay_triangulation_mesh(on_host(NULL, 0, sets < 3 ? zeros : NULL, sets % 3, 0));
    CHECK(mesh->point_count == 0 && mesh->triangle_count == 0 && mesh->triangles == NULL);
    REQUIRE(mesh->set_count == (sets < 3 ? sets : 1));
    CHECK(mesh->triangle_offsets[mesh->set_count] == 0 && mesh->hull_offsets[mesh->set_count] == 0);
  }
}

// ---- Device memory

static void read_buffer(cl_mem memory, size_t bytes, void* place) {
  if (bytes == 0) return;
  REQUIRE(memory != NULL &&
          clEnqueueReadBuffer(queue, memory, CL_TRUE, 0, bytes, place, 0, NULL, NULL) == CL_SUCCESS);
}

static int has_bytes(cl_mem memory, const void* expected, size_t bytes) {
  void* const found = allocate(bytes);
  read_buffer(memory, bytes, found);
  return bytes == 0 || (expected != NULL && memcmp(found, expected, bytes) == 0);
}

// The result of a call that is complete on the test's queue, with all parts.
static void check_same(const flaunay_device_triangulation* mesh, flaunay_triangulation* expected) {
  const size_t n = flaunay_triangulation_mesh(expected)->point_count;
  const size_t sets = flaunay_triangulation_mesh(expected)->set_count;
  const size_t triangles = flaunay_triangulation_mesh(expected)->triangle_count;
  const size_t hull = flaunay_triangulation_mesh(expected)->hull_count;
  CHECK(flaunay_device_triangulation_parts(mesh) == kAllParts);
  CHECK(flaunay_device_triangulation_mesh(mesh)->point_count == n);
  CHECK(flaunay_device_triangulation_mesh(mesh)->set_count == sets);
  CHECK(flaunay_device_triangulation_mesh(mesh)->hull_count == hull);
  REQUIRE(flaunay_device_triangulation_mesh(mesh)->triangle_count == triangles);
  CHECK(flaunay_device_triangulation_mesh(mesh)->point_offsets[sets] == n);
  CHECK(same_sizes(flaunay_device_triangulation_mesh(mesh)->triangle_offsets,
                   flaunay_triangulation_mesh(expected)->triangle_offsets, sets + 1));
  CHECK(same_sizes(flaunay_device_triangulation_mesh(mesh)->hull_offsets,
                   flaunay_triangulation_mesh(expected)->hull_offsets, sets + 1));
  const flaunay_mesh* arrays = flaunay_triangulation_mesh(expected);
  const struct {
    flaunay_part part;
    const void* entries;
    size_t bytes;
  } parts[] = {{FLAUNAY_PART_TRIANGLES, arrays->triangles, 12 * triangles},
               {FLAUNAY_PART_NEIGHBORS, arrays->neighbors, 12 * triangles},
               {FLAUNAY_PART_HALFEDGES, arrays->halfedges, 12 * triangles},
               {FLAUNAY_PART_HULL, arrays->hull, 4 * hull},
               {FLAUNAY_PART_REPRESENTATIVES, arrays->representatives, 4 * n},
               {FLAUNAY_PART_AREAS, arrays->areas, 8 * triangles}};
  for (size_t p = 0; p < sizeof parts / sizeof *parts; ++p) {
    CHECK(has_bytes(flaunay_device_triangulation_buffer(mesh, parts[p].part), parts[p].entries,
                    parts[p].bytes));
  }
}

static flaunay_device_triangulation* make_device_triangulation(void) {
  REQUIRE(device_mesh_count < sizeof device_meshes / sizeof *device_meshes);
  flaunay_device_triangulation* result = NULL;
  OK(flaunay_device_triangulation_create(&result));
  CHECK(flaunay_device_triangulation_parts(result) == 0);
  CHECK(flaunay_device_triangulation_mesh(result)->set_count == 0);
  CHECK(flaunay_device_triangulation_mesh(result)->triangle_count == 0);
  CHECK(strcmp(flaunay_device_triangulation_mesh(result)->statistics->device, "") == 0);
  return device_meshes[device_mesh_count++] = result;
}

// The caller's context, queue and buffers, an upload to wait for, and an event to wait for.
static void test_device_to_device(void) {
  const struct {
    flaunay_part part;
    size_t bytes;
  } parts[] = {{FLAUNAY_PART_TRIANGLES, 24}, {FLAUNAY_PART_NEIGHBORS, 24},      {FLAUNAY_PART_HALFEDGES, 24},
               {FLAUNAY_PART_HULL, 4},       {FLAUNAY_PART_REPRESENTATIVES, 4}, {FLAUNAY_PART_AREAS, 16}};
  flaunay_device_triangulation* mesh = make_device_triangulation();
  for (size_t p = 0; p < sizeof parts / sizeof parts[0]; ++p) {
    cl_mem memory = make_buffer(context, parts[p].bytes * kPoints, NULL);
    OK(flaunay_device_triangulation_set_buffer(mesh, parts[p].part, memory));
    CHECK(flaunay_device_triangulation_buffer(mesh, parts[p].part) == memory);
  }
  while (buffer_count > 0) clReleaseMemObject(buffers[--buffer_count]);  // the handle retains them
  const flaunay_device_points input = {.memory = make_buffer(context, sizeof points, NULL), .count = kPoints};
  cl_event uploaded = NULL, done = NULL;
  CHECK(clEnqueueWriteBuffer(queue, input.memory, CL_FALSE, 0, sizeof points, points, 0, NULL, &uploaded) ==
        CL_SUCCESS);
  cl_command_queue other = make_queue(context, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  const flaunay_enqueue enqueue = {
      .queue = other, .wait_for = &uploaded, .wait_for_count = 1, .event = &done};
  OK(flaunay_triangulate_device(triangulator, &input, kAllParts, &enqueue, mesh));
  REQUIRE(done != NULL);
  CHECK(clWaitForEvents(1, &done) == CL_SUCCESS);
  flaunay_triangulation* expected = on_host(points, kPoints, NULL, 0, kAllParts);
  check_same(mesh, expected);
  const flaunay_statistics* statistics = flaunay_device_triangulation_mesh(mesh)->statistics;
  CHECK(statistics->points == kPoints && statistics->host_waits > 0 && statistics->host_waits < 20);
  CHECK(statistics->bytes_to_host < 4096 && statistics->bytes_to_device < 4096);
  clReleaseEvent(uploaded);
  clReleaseEvent(done);
  clReleaseCommandQueue(other);
}

// Buffers of flaunay's own grow and stay.
static void test_own_buffers(void) {
  flaunay_device_triangulation* mesh = make_device_triangulation();
  flaunay_device_points input = {.memory = make_buffer(context, sizeof points, points), .count = 100};
  const flaunay_enqueue enqueue = {.queue = queue};
  CHECK(flaunay_device_triangulation_buffer(mesh, FLAUNAY_PART_TRIANGLES) == NULL);
  OK(flaunay_triangulate_device(triangulator, &input, 0, &enqueue, mesh));
  CHECK(flaunay_device_triangulation_parts(mesh) == FLAUNAY_PART_TRIANGLES);
  CHECK(flaunay_device_triangulation_buffer(mesh, FLAUNAY_PART_TRIANGLES) != NULL);
  CHECK(flaunay_device_triangulation_buffer(mesh, FLAUNAY_PART_HULL) == NULL);
  input.count = kPoints;
  for (int k = 0; k < 2; ++k) {
    OK(flaunay_triangulate_device(triangulator, &input, kAllParts, &enqueue, mesh));
    CHECK(clFinish(queue) == CL_SUCCESS);
  }
  CHECK(flaunay_device_triangulation_mesh(mesh)->statistics->device_allocations == 0);
  flaunay_triangulation* expected = on_host(points, kPoints, NULL, 0, kAllParts);
  check_same(mesh, expected);
}

// Sets, float, points that precede: offsets in host memory and on the device.
static void test_device_sets(void) {
  float narrow[6 + 20] = {9, 9, 9, 9, 9, 9};
  int32_t device_offsets[5];
  for (int k = 0; k < 20; ++k) narrow[6 + k] = (float)kSets[k];
  for (int s = 0; s < 5; ++s) device_offsets[s] = (int32_t)kSetOffsets[s];
  flaunay_device_points input = {.memory = make_buffer(context, sizeof narrow, narrow),
                                 .count = 10,
                                 .precision = FLAUNAY_FLOAT32,
                                 .first = 3,
                                 .offsets = kSetOffsets,
                                 .sets = 4};
  flaunay_triangulation* expected = on_host(kSets, 10, kSetOffsets, 4, kAllParts);
  flaunay_device_triangulation* mesh = make_device_triangulation();
  const flaunay_enqueue enqueue = {.queue = queue};
  OK(flaunay_triangulate_device(triangulator, &input, kAllParts, &enqueue, mesh));
  check_same(mesh, expected);
  input.offsets = NULL;
  input.device_offsets = make_buffer(context, sizeof device_offsets, device_offsets);
  OK(flaunay_triangulate_device(triangulator, &input, kAllParts, &enqueue, mesh));
  check_same(mesh, expected);
}

static void test_device_profile(void) {
  cl_command_queue timed = make_queue(context, CL_QUEUE_PROFILING_ENABLE);
  flaunay_device_points input = {.memory = make_buffer(context, sizeof kSquare, kSquare), .count = 4};
  flaunay_enqueue enqueue = {.queue = timed, .profile = 1};
  flaunay_device_triangulation* mesh = make_device_triangulation();
  OK(flaunay_triangulate_device(triangulator, &input, 0, &enqueue, mesh));
  CHECK(flaunay_device_triangulation_mesh(mesh)->statistics->kernel_count > 0);
  enqueue.queue = queue;
  REFUSED(flaunay_triangulate_device(triangulator, &input, 0, &enqueue, mesh), "CL_QUEUE_PROFILING_ENABLE");
  clReleaseCommandQueue(timed);
}

static void test_workspace(void) {
  size_t bytes = 0;
  char text[64];
  OK(flaunay_triangulator_workspace_bytes(triangulator, kPoints, 1, &bytes));
  cl_mem small = make_buffer(context, bytes - 1, NULL), enough = make_buffer(context, bytes, NULL);
  const flaunay_device_points input = {.memory = make_buffer(context, sizeof points, points),
                                       .count = kPoints};
  flaunay_device_triangulation* mesh = make_device_triangulation();
  OK(flaunay_triangulator_use_workspace(triangulator, small));
  snprintf(text, sizeof text, "has %zu bytes", bytes - 1);
  REFUSED(flaunay_triangulate_device(triangulator, &input, 0, NULL, mesh), text);
  snprintf(text, sizeof text, "need %zu", bytes);
  CHECK(strstr(flaunay_last_error(), text) != NULL);
  OK(flaunay_triangulator_use_workspace(triangulator, enough));
  OK(flaunay_triangulate_device(triangulator, &input, 0, NULL, mesh));
  // What needs more memory takes it from elsewhere, also after the workspace was in use.
  const flaunay_options flattened = {.mode = FLAUNAY_MODE_FLATTENED};
  flaunay_triangulation* result = NULL;
  OK(flaunay_triangulate(triangulator, points, kPoints, NULL, 0, &flattened, &result));
  flaunay_triangulation_destroy(result);
  OK(flaunay_device_triangulation_set_buffer(mesh, FLAUNAY_PART_HULL, enough));
  REFUSED(flaunay_triangulate_device(triangulator, &input, kAllParts, NULL, mesh), "two things");
  OK(flaunay_triangulator_use_workspace(triangulator, NULL));
  OK(flaunay_triangulate_device(triangulator, &input, kAllParts, NULL, mesh));
}

// ---- Bad use

static void test_bad_options(void) {
  const struct {
    flaunay_options options;
    const char* text;
  } bad[] = {{{.mode = 17}, "17"},
             {{.cut = 17}, "17"},
             {{.hull = 17}, "17"},
             {{.parts = 64}, "0x40"},
             {{.reserved = {0, 1}}, "flaunay_options"},
             {{.hull = FLAUNAY_HULL_MONOTONE_CHAIN}, "monotone-chain"},
             {{.finish = 2}, "2 is no flaunay_finish"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
    flaunay_triangulation* mesh = NULL;
    REFUSED(flaunay_triangulate(triangulator, kSquare, 4, NULL, 0, &bad[k].options, &mesh), bad[k].text);
    CHECK(mesh == NULL && strcmp(flaunay_last_error_call(), "") == 0 && flaunay_last_error_code() == 0);
  }
  const double wrong[] = {0, 0, 1, 0, 1, 1, 0, NAN, 5, 5};
  flaunay_triangulation* mesh = NULL;
  WRONG_INPUT(flaunay_triangulate(triangulator, wrong, 5, NULL, 0, NULL, &mesh), "point 3");
}

static flaunay_status triangulate_sets(const size_t* offsets, size_t sets) {
  flaunay_triangulation* mesh = NULL;
  const flaunay_status status = flaunay_triangulate(triangulator, kSquare, 4, offsets, sets, NULL, &mesh);
  flaunay_triangulation_destroy(mesh);
  return status;
}

static void test_bad_offsets(void) {
  REFUSED(triangulate_sets((const size_t[]){0, 3, 2, 4}, 3), "not decrease");
  REFUSED(triangulate_sets((const size_t[]){1, 4}, 1), "begin with 0");
  REFUSED(triangulate_sets((const size_t[]){0, 3}, 1), "end with 3, but there are 4");
  WRONG_INPUT(triangulate_sets((const size_t[]){0}, SIZE_MAX), "sets are too many");
}

// Points are not read before their number is checked.
static void test_too_many_points(void) {
  flaunay_triangulation* mesh = NULL;
  const size_t counts[] = {(size_t)1 << 31, SIZE_MAX / 2, SIZE_MAX};
  for (int k = 0; k < 3; ++k) {
    WRONG_INPUT(flaunay_triangulate(triangulator, points, counts[k], NULL, 0, NULL, &mesh), "too many");
    size_t bytes = 1;
    WRONG_INPUT(flaunay_triangulator_workspace_bytes(triangulator, counts[k], 1, &bytes), "too many");
    CHECK(bytes == 0);
  }
  size_t bytes = 0;
  WRONG_INPUT(flaunay_triangulator_workspace_bytes(triangulator, 1, SIZE_MAX, &bytes), "sets are too many");
}

// A call on the square with one thing wrong.
static flaunay_status triangulate_square(flaunay_device_points input, unsigned parts,
                                         const flaunay_enqueue* enqueue) {
  flaunay_device_triangulation* mesh = make_device_triangulation();
  const flaunay_status status = flaunay_triangulate_device(triangulator, &input, parts, enqueue, mesh);
  return status;
}

static void test_bad_device_points(void) {
  cl_mem memory = make_buffer(context, sizeof kSquare, kSquare);
  const flaunay_device_points square = {.memory = memory, .count = 4};
  const size_t offsets[] = {0, 2, 4};
  const struct {
    flaunay_device_points input;
    const char* text;
  } bad[] = {
      {{.memory = memory, .count = 5}, "it has 64 bytes, 80 are needed"},
      {{.count = 4}, "no buffer of points"},
      {{.memory = memory, .count = 4, .precision = 17}, "17"},
      {{.memory = memory, .count = 4, .reserved = {[1] = 1}}, "flaunay_device_points"},
      {{.memory = memory, .count = 4, .offsets = offsets, .device_offsets = memory, .sets = 2}, "twice"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
    REFUSED(triangulate_square(bad[k].input, 0, NULL), bad[k].text);
  }
  flaunay_device_points input = {.memory = memory, .count = 4, .first = SIZE_MAX};
  WRONG_INPUT(triangulate_square(input, 0, NULL), "points before the first one are too many");
  input = (flaunay_device_points){.memory = memory, .count = 4, .device_offsets = memory, .sets = SIZE_MAX};
  WRONG_INPUT(triangulate_square(input, 0, NULL), "sets are too many");
  OK(triangulate_square(square, 0, NULL));
  REFUSED(triangulate_square(square, FLAUNAY_PART_NEIGHBORS, NULL), "with triangles only");
  REFUSED(triangulate_square(square, 64, NULL), "0x40");
  const flaunay_enqueue unknown = {.reserved = {1}};
  REFUSED(triangulate_square(square, 0, &unknown), "flaunay_enqueue");
}

static void test_bad_result_buffers(void) {
  cl_mem small = make_buffer(context, 24 * 4 - 1, NULL);
  const flaunay_device_points square = {.memory = make_buffer(context, sizeof kSquare, kSquare), .count = 4};
  flaunay_device_triangulation* mesh = make_device_triangulation();
  OK(flaunay_device_triangulation_set_buffer(mesh, FLAUNAY_PART_TRIANGLES, small));
  REFUSED(flaunay_triangulate_device(triangulator, &square, 0, NULL, mesh),
          "triangles is too small: it has 95 bytes, 96 are needed");
  REFUSED(flaunay_device_triangulation_set_buffer(mesh, 3, small), "3 is not one part");
  CHECK(flaunay_device_triangulation_buffer(mesh, 3) == NULL);
  OK(flaunay_device_triangulation_set_buffer(mesh, FLAUNAY_PART_TRIANGLES, NULL));
  OK(flaunay_triangulate_device(triangulator, &square, 0, NULL, mesh));
}

// Under the address sanitizer, whose own memory the limit would not leave, there is no such test.
static void test_out_of_memory(void) {
#ifndef __SANITIZE_ADDRESS__
  struct rlimit before;
  REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
  struct rlimit limited = before;
  limited.rlim_cur = (rlim_t)1 << 33;
  REQUIRE(setrlimit(RLIMIT_AS, &limited) == 0);
  CHECK(fails(triangulate_sets((const size_t[]){0, 4}, (size_t)1 << 30), FLAUNAY_ERROR_MEMORY, "memory"));
  REQUIRE(setrlimit(RLIMIT_AS, &before) == 0);
#endif
}

// ---- Voronoi diagrams and queries

// Inside of the lower triangle of the square, on a point, outside.
static const double kQueries[] = {3, 1, 4, 3, -1, -1};
enum { kQueryCount = 3 };
static const double kValues[] = {0, 4, 7, 4};  // x + y

// As of points 0 to 3 of the square.
static void check_answers(const flaunay_triangulation* mesh, const int32_t* triangles, const int32_t* nearest,
                          const double* values) {
  const int32_t* all = flaunay_triangulation_mesh(mesh)->triangles;
  for (int k = 0; k < 2; ++k) {
    const int32_t t = triangles[k];
    if (!CHECK(t == 0 || t == 1)) return;
    const int32_t* corners = all + 3 * (size_t)t;
    CHECK(corners[0] == 1 || corners[1] == 1 || corners[2] == 1 || k == 1);
  }
  CHECK(triangles[2] == -1);
  CHECK(nearest[0] == 1 && nearest[1] == 2 && nearest[2] == 0);
  CHECK(fabs(values[0] - 4) < 1e-12 && values[1] == 7 && isnan(values[2]));
}

static void test_voronoi(void) {
  flaunay_voronoi* dual = NULL;
  flaunay_triangulation* mesh = on_host(kSquare, 4, NULL, 0, 0);
  OK(flaunay_voronoi_compute(triangulator, kSquare, 4, mesh, &dual));
  CHECK(flaunay_voronoi_point_count(dual) == 4 && flaunay_voronoi_triangle_count(dual) == 2);
  CHECK(flaunay_voronoi_corner_count(dual) == 6);
  const int32_t* offsets = flaunay_voronoi_cell_offsets(dual);
  CHECK(offsets[0] == 0 && offsets[4] == 6);
  for (size_t i = 0; i < 4; ++i) {
    CHECK(flaunay_voronoi_unbounded(dual)[i] == 1);
    for (int32_t k = offsets[i]; k < offsets[i + 1]; ++k) {
      const int32_t t = flaunay_voronoi_cells(dual)[k];
      const double* centre = flaunay_voronoi_circumcentres(dual) + 2 * (size_t)t;
      const int32_t other = flaunay_triangulation_mesh(mesh)->triangles[3 * t];
      CHECK(fabs(hypot(kSquare[2 * i] - centre[0], kSquare[2 * i + 1] - centre[1]) -
                 hypot(kSquare[2 * other] - centre[0], kSquare[2 * other + 1] - centre[1])) < 1e-12);
    }
  }
  flaunay_voronoi_destroy(dual);
  REFUSED(flaunay_voronoi_compute(triangulator, kSquare, 3, mesh, &dual), "points");
  CHECK(dual == NULL);
}

static double total(const double* values, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += values[i];
  return sum;
}

// ---- Constrained triangulations

// Two squares, one beside the other, as two sets; the diagonals of a square have equal circles.
static const double kTwoSquares[] = {0, 0, 2, 0, 2, 2, 0, 2, 5, 0, 7, 0, 7, 2, 5, 2};
static const size_t kTwoSets[] = {0, 4, 8};
static const int32_t kDiagonals[] = {1, 3, 4, 6, 6, 4, 5, 5};

static flaunay_triangulation* constrain_two_squares(const flaunay_constraints* constraints,
                                                    const flaunay_options* options) {
  REQUIRE(constrained_count < sizeof constrained_meshes / sizeof *constrained_meshes);
  flaunay_triangulation* result = NULL;
  OK(flaunay_triangulate_constrained(triangulator, kTwoSquares, 8, kTwoSets, 2, constraints, options,
                                     &result));
  return constrained_meshes[constrained_count++] = result;
}

static flaunay_triangulation* polygons_of(const flaunay_polygons* polygons) {
  REQUIRE(constrained_count < sizeof constrained_meshes / sizeof *constrained_meshes);
  flaunay_triangulation* result = NULL;
  OK(flaunay_triangulate_polygons(triangulator, polygons, NULL, &result));
  return constrained_meshes[constrained_count++] = result;
}

static void test_constrained(void) {
  const flaunay_constraints diagonals = {.segments = kDiagonals, .segment_count = 4};
  const flaunay_options options = {.parts = FLAUNAY_PART_HALFEDGES | FLAUNAY_PART_NEIGHBORS};
  flaunay_triangulation* result = constrain_two_squares(&diagonals, &options);
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  CHECK(mesh->point_count == 8 && mesh->set_count == 2 && mesh->triangle_count == 4);
  CHECK(mesh->hull_count == 8 && mesh->statistics->points == 8);
  CHECK(mesh->triangle_offsets[1] == 2 && mesh->hull_offsets[1] == 4);
  const flaunay_constrained_arrays* arrays = flaunay_triangulation_constraints(result);
  CHECK(arrays->added_count == 0 && arrays->added_points == NULL && arrays->added_offsets[2] == 0);
  CHECK(arrays->constraint_count == 2 && arrays->segment_count == 4 && arrays->piece_count == 4);
  const int32_t edges[] = {3, 1, 4, 6}, segments[] = {0, 1}, offsets[] = {0, 1, 2, 3, 4};
  const int32_t pieces[] = {0, 1, 1, 2, 1, 2, 0, 0};
  CHECK(same(arrays->constraint_edges, edges, 4) && same(arrays->edge_segments, segments, 2));
  CHECK(same(arrays->piece_offsets, offsets, 5) && same(arrays->piece_edges, pieces, 8));
  CHECK(arrays->depths == NULL && arrays->regions == NULL);
  for (size_t k = 0; k < 12; ++k) {
    // In each square, the constraint is what its two triangles have in common.
    CHECK(arrays->constrained[k] == (mesh->neighbors[k] >= 0));
    const size_t next = k - k % 3 + (k + 1) % 3;
    CHECK((mesh->halfedges[next] >= 0) == (mesh->neighbors[k] >= 0));
  }
  // Without constraints.
  result = constrain_two_squares(NULL, NULL);
  mesh = flaunay_triangulation_mesh(result);
  CHECK(mesh->triangle_count == 4 && mesh->halfedges == NULL);
  CHECK(flaunay_triangulation_constraints(result)->constraint_edges == NULL);
  CHECK(flaunay_triangulation_constraints(result)->piece_offsets[0] == 0);
}

static void test_carried(void) {
  const int32_t segment_markers[] = {-1, 4, 5, 6}, point_markers[] = {8, 7, 6, 5, 4, 3, 2, 1};
  const double seeds[] = {0.25, 1, 5.5, 0.75, 5.5, 1.5}, attributes[] = {0.5, 1.5, 2.5};
  const size_t seed_offsets[] = {0, 1, 3};
  const flaunay_constraints constraints = {.segments = kDiagonals,
                                           .segment_count = 4,
                                           .segment_markers = segment_markers,
                                           .point_markers = point_markers,
                                           .seeds = seeds,
                                           .seed_attributes = attributes,
                                           .seed_count = 3,
                                           .seed_offsets = seed_offsets};
  flaunay_triangulation* result = constrain_two_squares(&constraints, NULL);
  const flaunay_constrained_arrays* arrays = flaunay_triangulation_constraints(result);
  const int32_t* triangles = flaunay_triangulation_mesh(result)->triangles;
  CHECK(same(arrays->edge_markers, segment_markers, 2) && same(arrays->vertex_markers, point_markers, 8));
  for (size_t t = 0; t < 4; ++t) {
    // Triangles of the first square with its point 0, and of the second with the point at the upper left.
    const int32_t wanted = t < 2 ? 0 : 7;
    int has = 0;
    for (int k = 0; k < 3; ++k) has |= triangles[3 * t + k] == wanted;
    CHECK(arrays->triangle_attributes[t] == (has ? (t < 2 ? 0.5 : 2.5) : 0));
  }
}

// A square with a hole, whose ring repeats its first point, and a triangle.
static const double kRings[] = {0, 0, 6, 0, 6, 6, 0, 6, 2, 2, 2, 4, 4, 4, 4, 2, 2, 2, 6, 0, 9, 3, 6, 6};
static const size_t kRingOffsets[] = {0, 4, 9, 12}, kPolygonOffsets[] = {0, 2, 3};
static const flaunay_polygons kPolygons = {.coordinates = kRings,
                                           .ring_offsets = kRingOffsets,
                                           .ring_count = 3,
                                           .polygon_offsets = kPolygonOffsets,
                                           .polygon_count = 2};

// 0 on the left of x = 1, and on the right a quarter of the largest one.
static void areas_at(const double* places, size_t count, double* areas, void* data) {
  ++*(int*)data;
  for (size_t k = 0; k < count; ++k) areas[k] = places[2 * k] < 1 ? 0 : 0.0125;
}

static void no_areas_at(const double* places, size_t count, double* areas, void* data) {
  (void)places, (void)data;
  for (size_t k = 0; k < count; ++k) areas[k] = NAN;
}

static void test_refined(void) {
  int calls = 0;
  const uint8_t kept_segments[] = {1, 0, 0, 0};
  flaunay_refinement refinement = {
      .min_angle = 25, .max_area = 0.05, .areas_at = areas_at, .areas_data = &calls, .smoothing_steps = 2};
  flaunay_constraints constraints = {.segments = kDiagonals, .segment_count = 4, .refinement = &refinement};
  const flaunay_options options = {.parts = FLAUNAY_PART_AREAS};
  flaunay_triangulation* result = constrain_two_squares(&constraints, &options);
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  const flaunay_constrained_arrays* arrays = flaunay_triangulation_constraints(result);
  const flaunay_refinement_report* report = flaunay_triangulation_refinement(result);
  CHECK(arrays->added_count > 0 && report->added_points == arrays->added_count && report->rounds > 0);
  CHECK(mesh->point_count == 8 + arrays->added_count && mesh->set_count == 2 && calls > 0);
  CHECK(report->split_points > 0 && report->smallest_angle >= 25 - 1e-9 &&
        report->largest_angle <= 130 + 1e-9);
  CHECK(report->bad_count == 0 && report->bad_triangles == NULL && report->excuses == NULL);
  CHECK(report->mean_angle > report->mean_angle_before && report->mean_angle_before > 25);
  for (size_t t = 0; t < mesh->triangle_count; ++t) CHECK(mesh->areas[t] <= 0.05);
  CHECK(arrays->piece_edges[1] > 1);

  refinement.kept_segments = kept_segments;
  refinement.has_most_points = 1;
  refinement.most_points = 3;
  result = constrain_two_squares(&constraints, &options);
  report = flaunay_triangulation_refinement(result);
  CHECK(report->added_points <= 6 && report->bad_count > 0);
  for (size_t k = 0; k < report->bad_count; ++k) {
    CHECK(report->excuses[k] == FLAUNAY_EXCUSE_MOST_POINTS || report->excuses[k] == FLAUNAY_EXCUSE_KEPT);
  }
  CHECK(flaunay_triangulation_constraints(result)->piece_edges[1] == 1);

  // No rounds are none.
  refinement = (flaunay_refinement){.max_area = 0.05, .has_most_rounds = 1};
  report = flaunay_triangulation_refinement(constrain_two_squares(&constraints, NULL));
  CHECK(report->added_points == 0 && report->excuses[0] == FLAUNAY_EXCUSE_MOST_ROUNDS);
  flaunay_polygons polygons = kPolygons;
  polygons.refinement = &refinement;
  refinement = (flaunay_refinement){.min_angle = 20, .kept = FLAUNAY_KEPT_EDGES_NONE};
  CHECK(flaunay_triangulation_refinement(polygons_of(&polygons))->smallest_angle >= 20 - 1e-9);

  // A mesh that is refined further, and is Delaunay.
  const int32_t triangles[] = {0, 1, 2, 0, 3, 2};
  const double areas[] = {0, 0.01}, attributes[] = {3, 5};
  flaunay_given_triangles given = {
      .triangles = triangles, .count = 2, .areas = areas, .attributes = attributes};
  refinement = (flaunay_refinement){.mesh = &given, .conforming = 1};
  constraints = (flaunay_constraints){.refinement = &refinement};
  result = constrain_two_squares(&constraints, &options);
  mesh = flaunay_triangulation_mesh(result);
  arrays = flaunay_triangulation_constraints(result);
  CHECK(mesh->triangle_offsets[1] == mesh->triangle_count && arrays->segment_count == 5);
  size_t small = 0;
  for (size_t t = 0; t < mesh->triangle_count; ++t) {
    const int is_small = arrays->triangle_attributes[t] == 5;
    CHECK(is_small ? mesh->areas[t] <= 0.01 : arrays->triangle_attributes[t] == 3);
    small += (size_t)is_small;
  }
  CHECK(small > 20 && small < mesh->triangle_count);

  given.reserved[0] = 1;
  const struct {
    flaunay_refinement refinement;
    const char* text;
  } bad[] = {{{.min_angle = 35}, "35"},
             {{.max_area = -1}, "-1"},
             {{.min_angle = 20, .kept = 3}, "flaunay_kept_edges"},
             {{.areas_at = no_areas_at}, "nan"},
             {{.min_angle = 20, .reserved = {1}}, "flaunay_refinement"},
             {{.mesh = &given}, "flaunay_given_triangles"},
             {{.most_rounds = 3}, ""},
             {{.most_points = 3}, ""},
             {{.min_edge = 0.5}, ""},
             {{.has_min_edge = 1, .min_edge = -1}, ""},
             {{.has_min_edge = 1, .min_edge = NAN}, ""}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
    constraints.refinement = &bad[k].refinement;
    REFUSED(flaunay_triangulate_constrained(triangulator, kTwoSquares, 8, kTwoSets, 2, &constraints, NULL,
                                            &result),
            bad[k].text);
  }
}

static flaunay_status constrain_square(flaunay_constraints constraints, const flaunay_options* options) {
  flaunay_triangulation* result = NULL;
  const flaunay_status status =
      flaunay_triangulate_constrained(triangulator, kSquare, 4, NULL, 0, &constraints, options, &result);
  CHECK((status == FLAUNAY_SUCCESS) == (result != NULL));
  flaunay_triangulation_destroy(result);
  return status;
}

static void test_bad_constraints(void) {
  const int32_t both[] = {0, 2, 1, 3}, none[] = {0, 4}, across[] = {3, 4};
  const flaunay_status usage = FLAUNAY_ERROR_USAGE;
  const flaunay_options flattened = {.mode = FLAUNAY_MODE_FLATTENED}, unknown = {.mode = 17};
  const flaunay_constraints crossing = {.segments = both, .segment_count = 2};
  WRONG_INPUT(constrain_square(crossing, NULL), "cross");
  const flaunay_constraints one = {.segments = both, .segment_count = 1};
  OK(constrain_square(one, NULL));
  REFUSED(constrain_square(one, &flattened), "flattened");
  REFUSED(constrain_square(one, &unknown), "17");
  const flaunay_constraints bad[] = {{.segments = none, .segment_count = 1},
                                     {.segment_count = 1},
                                     {.hole_count = 1},
                                     {.seed_count = 1},
                                     {.crossings = 99},
                                     {.outside = 99},
                                     {.fill_rule = -1},
                                     {.reserved = {1}}};
  const char* const texts[] = {"4",
                               "NULL",
                               "NULL",
                               "NULL",
                               "flaunay_crossings",
                               "flaunay_outside",
                               "_fill_rule",
                               "flaunay_constraints"};
  for (int k = 0; k < 8; ++k) REFUSED(constrain_square(bad[k], NULL), texts[k]);
  flaunay_triangulation* result = NULL;
  const flaunay_constraints between = {.segments = across, .segment_count = 1};
  CHECK(flaunay_triangulate_constrained(triangulator, kTwoSquares, 8, kTwoSets, 2, &between, NULL, &result) ==
        usage);
}

static void test_polygons(void) {
  flaunay_triangulation* result = polygons_of(&kPolygons);
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  CHECK(mesh->point_count == 12 && mesh->set_count == 2 && mesh->triangle_count == 9);
  CHECK(mesh->triangle_offsets[1] == 8 && mesh->triangle_offsets[2] == 9);
  const flaunay_constrained_arrays* arrays = flaunay_triangulation_constraints(result);
  CHECK(arrays->segment_count == 12 && arrays->constraint_count == 11 && arrays->polygons == NULL);

  flaunay_polygons input = kPolygons;
  input.map = input.labels = 1;
  result = polygons_of(&input);
  arrays = flaunay_triangulation_constraints(result);
  CHECK(flaunay_triangulation_mesh(result)->set_count == 1 && arrays->constraint_count == 10);
  int of_second = 0;
  for (size_t t = 0; t < 9; ++t) of_second += arrays->polygons[t] == 1;
  CHECK(of_second == 1 && arrays->depths[0] == 1 && arrays->regions[0] == 0);

  // Rings alone: the hole is a polygon of its own. What is outside and in holes may be kept.
  input = kPolygons;
  input.polygon_offsets = NULL;
  mesh = flaunay_triangulation_mesh(polygons_of(&input));
  CHECK(mesh->set_count == 3 && mesh->triangle_count == 5);
  input = kPolygons;
  input.has_outside = input.has_fill_rule = 1;
  CHECK(flaunay_triangulation_mesh(polygons_of(&input))->triangle_count == 11);

  // Borders and holes of any direction, if the parts are known: winding alone would fill this hole, and leave
  // out what is in both parts.
  static const double kParts[] = {0, 0, 6, 0, 6, 6, 0, 6, 2, 2, 4, 2, 4, 4, 2, 4, 5, 5, 5, 6, 6, 6, 6, 5};
  static const size_t kPartRings[] = {0, 4, 8, 12}, kOnePolygon[] = {0, 3}, kPartOffsets[] = {0, 2, 3};
  input = (flaunay_polygons){.coordinates = kParts,
                             .ring_offsets = kPartRings,
                             .ring_count = 3,
                             .polygon_offsets = kOnePolygon,
                             .polygon_count = 1,
                             .labels = 1,
                             .has_fill_rule = 1,
                             .fill_rule = FLAUNAY_FILL_RULE_WINDING,
                             .part_offsets = kPartOffsets,
                             .part_count = 2};
  result = polygons_of(&input);
  mesh = flaunay_triangulation_mesh(result);
  double area = 0;
  for (size_t t = 0; t < mesh->triangle_count; ++t) {
    double measured = 0;
    OK(flaunay_triangle_areas(kParts, 12, mesh->triangles + 3 * t, 1, &measured));
    area += measured;
    CHECK(flaunay_triangulation_constraints(result)->depths[t] == 1);
  }
  CHECK(area == 36 - 4);
}

static flaunay_status polygons_with(flaunay_polygons input) {
  flaunay_triangulation* result = NULL;
  const flaunay_status status = flaunay_triangulate_polygons(triangulator, &input, NULL, &result);
  flaunay_triangulation_destroy(result);
  return status;
}

static void test_bad_polygons(void) {
  flaunay_polygons bad[9];
  const char* const texts[] = {"rings",
                               "NULL",
                               "rings",
                               "flaunay_overlaps",
                               "flaunay_crossings",
                               "flaunay_polygons",
                               "flaunay_outside",
                               "flaunay_fill_rule"};
  for (int k = 0; k < 9; ++k) bad[k] = kPolygons;
  bad[0].ring_offsets = NULL;
  bad[1].coordinates = NULL;
  bad[2].polygon_count = 1;
  bad[3].overlaps = 99;
  bad[4].crossings = 99;
  bad[5].reserved[1] = 1;
  bad[6].has_outside = 1, bad[6].outside = 99;
  bad[7].has_fill_rule = 1, bad[7].fill_rule = 99;
  for (int k = 0; k < 8; ++k) REFUSED(polygons_with(bad[k]), texts[k]);
  bad[8].outside = bad[8].fill_rule = 99;  // neither counts
  OK(polygons_with(bad[8]));
  OK(polygons_with((flaunay_polygons){0}));
  const double bow[] = {0, 0, 2, 2, 2, 0, 0, 2};
  const flaunay_polygons crossing = {.coordinates = bow, .ring_offsets = kRingOffsets, .ring_count = 1};
  WRONG_INPUT(polygons_with(crossing), "cross");
}

static void test_clipped_voronoi(void) {
  const double box[] = {0, 0, 3, 0, 3, 3, 0, 3}, bow[] = {0, 0, 3, 3, 3, 0, 0, 3};
  flaunay_clipped_voronoi* cells = NULL;
  flaunay_triangulation* mesh = on_host(kSquare, 4, NULL, 0, 0);
  OK(flaunay_voronoi_clip(triangulator, kSquare, NULL, 4, mesh, box, 4, &cells));
  CHECK(flaunay_clipped_voronoi_point_count(cells) == 4);
  const int32_t* offsets = flaunay_clipped_voronoi_offsets(cells);
  CHECK(offsets[0] == 0 && (size_t)offsets[4] == flaunay_clipped_voronoi_vertex_count(cells));
  CHECK(fabs(total(flaunay_clipped_voronoi_areas(cells), 4) - 9) < 1e-12);
  for (size_t i = 0; i < 4; ++i) {
    CHECK(offsets[i + 1] - offsets[i] >= 3);
    CHECK(flaunay_clipped_voronoi_centroids(cells)[2 * i] > 0);
  }
  const double* vertices = flaunay_clipped_voronoi_vertices(cells);
  for (int32_t v = 0; v < 2 * offsets[4]; ++v) CHECK(vertices[v] >= 0 && vertices[v] <= 3);
  int32_t groups[] = {0, 0, 0, 0}, corners[32], rings[12], parts[12], ends[3];
  const size_t v = (size_t)offsets[4];
  REQUIRE(v < 32);
  OK(flaunay_join_cells(vertices, v, offsets, 4, groups, 2, box, 4, corners, rings, parts, ends));
  CHECK(ends[0] == 0 && ends[1] == 1 && ends[2] == 1 && parts[1] == 1 && rings[1] == 4);
  OK(flaunay_join_cells(vertices, v, offsets, 4, groups, 2, NULL, 0, corners, rings, parts, ends));
  CHECK(ends[2] == 1 && parts[1] == 1 && rings[1] > 4);
  REFUSED(flaunay_join_cells(vertices, v - 1, offsets, 4, groups, 2, box, 4, corners, rings, parts, ends),
          "offsets");
  const double endless[] = {0, 0, HUGE_VAL, 0, 0, 1};
  REFUSED(flaunay_join_cells(vertices, v, offsets, 4, groups, 2, endless, 3, corners, rings, parts, ends),
          "finite");
  groups[2] = 2;
  REFUSED(flaunay_join_cells(vertices, v, offsets, 4, groups, 2, box, 4, corners, rings, parts, ends),
          "groups");
  // A polygon without area is neither a part nor a hole of one.
  const double triangle_and_line[] = {0, 0, 1, 0, 0, 1, 10, 0, 11, 0, 12, 0};
  const int32_t two[] = {0, 3, 6};
  OK(flaunay_join_cells(triangle_and_line, 6, two, 2, groups, 1, NULL, 0, corners, rings, parts, ends));
  CHECK(ends[1] == 1 && parts[1] == 1 && rings[1] == 3);
  flaunay_clipped_voronoi_destroy(cells);
  WRONG_INPUT(flaunay_voronoi_clip(triangulator, kSquare, NULL, 4, mesh, bow, 4, &cells), "corner 1");
  CHECK(cells == NULL);
  REFUSED(flaunay_voronoi_clip(triangulator, kSquare, NULL, 3, mesh, box, 4, &cells), "points");
}

static void check_same_cells(const flaunay_device_clipped_voronoi* cells,
                             const flaunay_clipped_voronoi* expected) {
  const size_t n = flaunay_clipped_voronoi_point_count(expected);
  const size_t vertices = flaunay_clipped_voronoi_vertex_count(expected);
  REQUIRE(flaunay_device_clipped_voronoi_vertex_count(cells) == vertices && vertices > 0);
  const struct {
    flaunay_clipped_voronoi_part part;
    const void* entries;
    size_t bytes;
  } parts[] = {{FLAUNAY_CLIPPED_VORONOI_VERTICES, flaunay_clipped_voronoi_vertices(expected), 16 * vertices},
               {FLAUNAY_CLIPPED_VORONOI_OFFSETS, flaunay_clipped_voronoi_offsets(expected), 4 * (n + 1)},
               {FLAUNAY_CLIPPED_VORONOI_AREAS, flaunay_clipped_voronoi_areas(expected), 8 * n},
               {FLAUNAY_CLIPPED_VORONOI_CENTROIDS, flaunay_clipped_voronoi_centroids(expected), 16 * n}};
  for (size_t p = 0; p < sizeof parts / sizeof *parts; ++p) {
    CHECK(has_bytes(flaunay_device_clipped_voronoi_buffer(cells, parts[p].part), parts[p].entries,
                    parts[p].bytes));
  }
}

// All cells have area in the box, so that no centroid is NaN, of which there are many.
static void test_clipped_voronoi_on_device(void) {
  const double box[] = {-9, -9, 9, -9, 9, 9, -9, 9}, bow[] = {0, 0, 3, 3, 3, 0, 0, 3};
  flaunay_clipped_voronoi* expected = NULL;
  flaunay_triangulation* mesh = on_host(kSquare, 4, NULL, 0, 0);
  OK(flaunay_voronoi_clip(triangulator, kSquare, NULL, 4, mesh, box, 4, &expected));

  const flaunay_device_points square = {.memory = make_buffer(context, sizeof kSquare, kSquare), .count = 4};
  flaunay_device_triangulation* device_mesh = make_device_triangulation();
  flaunay_device_clipped_voronoi* cells = NULL;
  OK(flaunay_device_clipped_voronoi_create(&cells));
  CHECK(flaunay_device_clipped_voronoi_vertex_count(cells) == 0);
  CHECK(flaunay_device_clipped_voronoi_buffer(cells, FLAUNAY_CLIPPED_VORONOI_AREAS) == NULL);
  cl_event done = NULL;
  const flaunay_enqueue enqueue = {.queue = queue, .event = &done};
  REFUSED(flaunay_voronoi_clip_device(triangulator, &square, device_mesh, box, 4, NULL, cells), "parts");
  OK(flaunay_triangulate_device(triangulator, &square, kAllParts, NULL, device_mesh));
  OK(flaunay_voronoi_clip_device(triangulator, &square, device_mesh, box, 4, &enqueue, cells));
  REQUIRE(done != NULL);
  CHECK(clWaitForEvents(1, &done) == CL_SUCCESS);
  clReleaseEvent(done);
  check_same_cells(cells, expected);

  // The caller's buffer, and one that is too small.
  const size_t bytes = 16 * flaunay_clipped_voronoi_vertex_count(expected);
  cl_mem enough = make_buffer(context, bytes, NULL), small = make_buffer(context, bytes - 1, NULL);
  const flaunay_clipped_voronoi_part vertices = FLAUNAY_CLIPPED_VORONOI_VERTICES;
  const flaunay_enqueue plain = {.queue = queue};
  OK(flaunay_device_clipped_voronoi_set_buffer(cells, vertices, enough));
  CHECK(flaunay_device_clipped_voronoi_buffer(cells, vertices) == enough);
  OK(flaunay_voronoi_clip_device(triangulator, &square, device_mesh, box, 4, &plain, cells));
  check_same_cells(cells, expected);
  OK(flaunay_device_clipped_voronoi_set_buffer(cells, vertices, small));
  REFUSED(flaunay_voronoi_clip_device(triangulator, &square, device_mesh, box, 4, &plain, cells), "vertices");

  OK(flaunay_device_clipped_voronoi_set_buffer(cells, vertices, NULL));
  REFUSED(flaunay_device_clipped_voronoi_set_buffer(cells, 3, NULL), "not one part");
  WRONG_INPUT(flaunay_voronoi_clip_device(triangulator, &square, device_mesh, bow, 4, &plain, cells),
              "corner 1");
  flaunay_device_clipped_voronoi_destroy(cells);
  flaunay_clipped_voronoi_destroy(expected);
}

// A square whose diagonal is the constraint.
static void test_constrained_on_device(void) {
  const int32_t diagonal[] = {3, 1};
  const flaunay_device_points square = {.memory = make_buffer(context, sizeof kSquare, kSquare), .count = 4};
  cl_mem segments = make_buffer(context, sizeof diagonal, diagonal);
  flaunay_device_triangulation* mesh = make_device_triangulation();
  CHECK(flaunay_device_triangulation_constraint_count(mesh) == 0);
  const flaunay_enqueue plain = {.queue = queue};
  OK(flaunay_triangulate_constrained_device(triangulator, &square, segments, 1, &plain, mesh));
  CHECK(flaunay_device_triangulation_mesh(mesh)->triangle_count == 2);
  REQUIRE(flaunay_device_triangulation_constraint_count(mesh) == 1);
  int32_t ends[2] = {0, 0}, range[2] = {9, 9};
  read_buffer(flaunay_device_triangulation_buffer(mesh, FLAUNAY_PART_CONSTRAINT_EDGES), sizeof ends, ends);
  CHECK((ends[0] == 1 && ends[1] == 3) || (ends[0] == 3 && ends[1] == 1));
  read_buffer(flaunay_device_triangulation_buffer(mesh, FLAUNAY_PART_PIECE_EDGES), sizeof range, range);
  CHECK(range[0] == 0 && range[1] == 1);
  unsigned char constrained[6] = {0};
  read_buffer(flaunay_device_triangulation_buffer(mesh, FLAUNAY_PART_CONSTRAINED), sizeof constrained,
              constrained);
  int sum = 0;
  for (int k = 0; k < 6; ++k) sum += constrained[k];
  CHECK(sum == 2);

  cl_mem small = make_buffer(context, 1, NULL);
  OK(flaunay_device_triangulation_set_buffer(mesh, FLAUNAY_PART_CONSTRAINT_EDGES, small));
  REFUSED(flaunay_triangulate_constrained_device(triangulator, &square, segments, 1, &plain, mesh),
          "constraint edges");
  OK(flaunay_device_triangulation_set_buffer(mesh, FLAUNAY_PART_CONSTRAINT_EDGES, NULL));
  REFUSED(flaunay_device_triangulation_set_buffer(mesh, 3, NULL), "not one part");
  REFUSED(flaunay_triangulate_constrained_device(triangulator, &square, segments, 2, &plain, mesh),
          "segments");
}

static void test_relax(void) {
  const double box[] = {0, 0, 4, 0, 4, 4, 0, 4};
  double places[] = {1, 1, 1, 3, 9, 9}, expected[] = {2, 1, 2, 3, 9, 9};
  // The third point's cell does not meet the box.
  OK(flaunay_relax(triangulator, places, 3, NULL, box, 4, 1, places));
  for (size_t c = 0; c < 6; ++c) CHECK(fabs(places[c] - expected[c]) < 1e-12);
  WRONG_INPUT(flaunay_relax(triangulator, places, 3, NULL, box, 2, 1, places), "2 corners");
  OK(flaunay_relax(triangulator, NULL, 0, NULL, box, 4, 1, NULL));
  // Three points on the equator move apart.
  const flaunay_space sphere = {.kind = FLAUNAY_SPACE_SPHERE, .coordinates = FLAUNAY_SPHERE_DEGREES};
  double degrees[] = {0, 0, 90, 0, 180, 0}, apart[] = {-22.5, 0, 90, 0, -157.5, 0};
  OK(flaunay_relax(triangulator, degrees, 3, &sphere, NULL, 0, 1, degrees));
  for (size_t c = 0; c < 6; ++c) CHECK(fabs(degrees[c] - apart[c]) < 1e-12);
  REFUSED(flaunay_relax(triangulator, degrees, 3, &sphere, box, 4, 1, degrees), "not clipped");
}

static void test_raster(void) {
  const double places[] = {0, 0, 2, 0, 0, 2, 2, 2}, values[] = {0, 2, 4, 6}, heights[] = {1, 3};
  const int32_t triangles[] = {0, 1, 2, 1, 3, 2}, neighbors[] = {1, -1, -1, -1, 0, -1},
                wrong[] = {0, 1, 4, 1, 3, 2};
  double pixels[6] = {0};
  flaunay_raster raster = {.y = 2, .dx = 1, .dy = -1, .rows = 2, .columns = 3, .fill = -1};
  OK(flaunay_rasterize(triangulator, places, 4, triangles, neighbors, 2, values, &raster, pixels));
  for (size_t i = 0; i < 6; ++i) CHECK(pixels[i] == (double)(i % 3) + (i < 3 ? 4 : 2));
  const flaunay_shading plain = {0}, steep = {.vertical_factor = 2}, below = {.vertical_factor = -1},
                        coloured = {.colors = 1};
  uint8_t picture[24];
  OK(flaunay_shade_hills(&raster, pixels, &plain, picture));
  CHECK(picture[0] == 21 && picture[6] == 255);
  OK(flaunay_shade_hills(&raster, pixels, &steep, picture));
  CHECK(picture[0] == 0 && picture[11] == 255);
  OK(flaunay_shade_hills(&raster, pixels, &coloured, picture));
  CHECK(picture[0] > picture[12] && picture[23] == 255);
  REFUSED(flaunay_shade_hills(&raster, pixels, &below, picture), "vertical_factor");
  raster.max_edge = 1;
  OK(flaunay_rasterize(triangulator, places, 4, triangles, neighbors, 2, values, &raster, pixels));
  CHECK(pixels[0] == -1);
  REFUSED(flaunay_rasterize(triangulator, places, 4, wrong, neighbors, 2, values, &raster, pixels),
          "triangle 0");
  raster.reserved[1] = 1;
  REFUSED(flaunay_rasterize(triangulator, places, 4, triangles, neighbors, 2, values, &raster, pixels),
          "flaunay_raster");

  flaunay_contours* lines = NULL;
  OK(flaunay_contours_compute(triangulator, places, 4, triangles, neighbors, 2, values, heights, 2, 0,
                              &lines));
  REQUIRE(flaunay_contours_line_count(lines) == 2);
  CHECK(flaunay_contours_heights(lines)[1] == 1);
  CHECK(flaunay_contours_offsets(lines)[1] == 2);
  const double* const first = flaunay_contours_coordinates(lines);
  CHECK(first[0] == 0 && first[1] == 0.5 && first[2] == 1 && first[3] == 0);
  flaunay_contours_destroy(lines);
}

static flaunay_space on_torus(double period_x, double period_y) {
  return (flaunay_space){.kind = FLAUNAY_SPACE_TORUS, .period_x = period_x, .period_y = period_y};
}

static flaunay_status triangulate_in(flaunay_space space, const double* places, size_t n,
                                     const size_t* offsets, size_t sets, flaunay_triangulation** result) {
  const flaunay_options options = {.parts = FLAUNAY_PART_NEIGHBORS, .space = &space};
  return flaunay_triangulate(triangulator, places, n, offsets, sets, &options, result);
}

static void test_sphere(void) {
  const double places[] = {0, 0, 90, 0, 0, 90, 0, -90, 0, 90}, values[] = {1, 2, 3, 4, 5};
  const double queries[] = {10, 20, -100, -80}, other[] = {1, 0, 90, 0, 0, 90, 0, -90, 0, 90};
  const flaunay_space space = {.kind = FLAUNAY_SPACE_SPHERE, .coordinates = FLAUNAY_SPHERE_DEGREES};
  flaunay_triangulation *sphere = NULL, *none = NULL;
  OK(triangulate_in(space, places, 5, NULL, 0, &sphere));
  const flaunay_mesh* const mesh = flaunay_triangulation_mesh(sphere);
  REQUIRE(mesh->point_count == 5 && mesh->triangle_count == 4 && mesh->hull == NULL);
  for (size_t c = 0; c < 12; ++c) CHECK(mesh->triangles[c] < 4 && mesh->neighbors[c] >= 0);
  CHECK(mesh->representatives[4] == 2 && mesh->triangle_offsets[1] == 4 && mesh->point_offsets[1] == 5);
  CHECK(mesh->places[0] == 1 && isinf(mesh->places[6]) && mesh->space->kind == FLAUNAY_SPACE_SPHERE);
  double directions[15] = {0};
  OK(flaunay_directions(mesh->places, 5, directions));
  CHECK(directions[0] == 1 && directions[4] == 1 && directions[8] == 1 && directions[11] == -1);
  OK(flaunay_mesh_verify(mesh, places, NULL, &space));
  CHECK(fails(flaunay_mesh_verify(mesh, other, NULL, &space), FLAUNAY_ERROR_INTERNAL,
              "point 0 has a wrong place"));
  REFUSED(flaunay_mesh_verify(mesh, places, NULL, NULL), "another space");

  flaunay_voronoi* voronoi = NULL;
  OK(flaunay_voronoi_compute(triangulator, NULL, 0, sphere, &voronoi));
  CHECK(fabs(total(flaunay_voronoi_areas(voronoi), 5) - 4 * acos(-1)) < 1e-12);
  CHECK(flaunay_voronoi_cell_offsets(voronoi)[5] == 12 && flaunay_voronoi_triangle_count(voronoi) == 4);
  CHECK(flaunay_voronoi_cells(voronoi)[0] >= 0 && flaunay_voronoi_unbounded(voronoi) == NULL);
  CHECK(fabs(flaunay_voronoi_circumcentres(voronoi)[0]) <= 1);

  // A copy serves as the original does.
  flaunay_triangulation* copy = NULL;
  OK(flaunay_triangulation_create(mesh, NULL, &copy));
  flaunay_triangulation_destroy(sphere);
  flaunay_locator* locator = NULL;
  OK(flaunay_locator_create(triangulator, NULL, NULL, 0, NULL, 0, copy, &locator));
  int32_t found[2] = {0}, nearest[2] = {0};
  double between[2] = {0};
  OK(flaunay_locator_locate(locator, queries, 2, NULL, 0, found));
  OK(flaunay_locator_nearest(locator, queries, 2, NULL, 0, nearest));
  OK(flaunay_locator_interpolate(locator, values, places, 2, NULL, 0, NULL, between));
  CHECK(found[0] >= 0 && found[1] == -1 && nearest[0] == 0 && nearest[1] == 3);
  CHECK(between[0] == 1 && between[1] == 2);
  OK(flaunay_locator_set_coordinates(locator, FLAUNAY_SPHERE_DIRECTIONS));
  OK(flaunay_locator_nearest(locator, directions, 2, NULL, 0, nearest));
  CHECK(nearest[0] == 0 && nearest[1] == 1);
  REFUSED(flaunay_locator_set_coordinates(locator, 2), "2 is no flaunay_sphere_coordinates");
  flaunay_locator_destroy(locator);
  flaunay_point_tree* tree = NULL;
  OK(flaunay_point_tree_create_in_space(triangulator, copy, &tree));
  int32_t rows[4] = {0};
  double angles[4] = {0};
  OK(flaunay_point_tree_nearest(tree, queries, 2, 2, INFINITY, rows, angles));
  CHECK(rows[0] == 0 && rows[2] == 3 && rows[1] != 0 && angles[0] <= angles[1]);
  REFUSED(flaunay_point_tree_nearest(tree, queries, 2, 0, INFINITY, rows, NULL), "must be 1 or more");
  OK(flaunay_point_tree_set_coordinates(tree, FLAUNAY_SPHERE_DIRECTIONS));
  OK(flaunay_point_tree_nearest(tree, directions, 2, 1, INFINITY, rows, angles));
  CHECK(rows[0] == 0 && rows[1] == 1 && angles[1] == 0);
  flaunay_point_tree_destroy(tree);
  WRONG_INPUT(triangulate_in(space, (const double[]){0, 99}, 1, NULL, 0, &none), "latitude 99");
  flaunay_voronoi_destroy(voronoi);
  flaunay_triangulation_destroy(copy);
}

static void test_weighted(void) {
  const double places[] = {0, 0, 4, 0, 4, 4, 0, 4, 1, 2, 1, 2}, weights[] = {0, 0, 0, 0, -8, 3};
  const double corners[] = {0, 0, 4, 0, 4, 4, 0, 4};
  const flaunay_space space = {.weights = weights};
  flaunay_triangulation* weighted = NULL;
  OK(triangulate_in(space, places, 6, NULL, 0, &weighted));
  const flaunay_mesh* const mesh = flaunay_triangulation_mesh(weighted);
  CHECK(mesh->point_count == 6 && mesh->triangle_count == 4 && mesh->hull_count == 4 && mesh->hull[2] == 2);
  REQUIRE(mesh->hidden_count == 1);
  CHECK(mesh->hidden[0] == 4 && mesh->representatives[5] == 5 && mesh->space->weights == NULL);
  CHECK(mesh->triangles[0] == 0 && mesh->neighbors[1] >= -1);
  CHECK(mesh->triangle_offsets[1] == 4 && mesh->hull_offsets[1] == 4);
  OK(flaunay_mesh_verify(mesh, places, NULL, &space));
  const double others[] = {0, 0, 0, 0, 8, 3};
  const flaunay_space heavier = {.weights = others};
  CHECK(fails(flaunay_mesh_verify(mesh, places, NULL, &heavier), FLAUNAY_ERROR_INTERNAL, "point 4"));
  int32_t hiding = -1;
  OK(flaunay_hiding_triangles(triangulator, places, NULL, 0, weighted, &hiding));
  CHECK(hiding == 0);
  flaunay_clipped_voronoi* cells = NULL;
  OK(flaunay_voronoi_clip(triangulator, places, weights, 6, weighted, corners, 4, &cells));
  const double* areas = flaunay_clipped_voronoi_areas(cells);
  CHECK(areas[4] == 0 && areas[5] > 4);
  CHECK(fabs(areas[0] + areas[1] + areas[2] + areas[3] + areas[5] - 16) < 1e-12);
  flaunay_clipped_voronoi_destroy(cells);
  flaunay_triangulation_destroy(weighted);
  // Nor are triangles taken for Delaunay ones if no point is hidden, also in a copy.
  flaunay_locator* locator = NULL;
  flaunay_voronoi* dual = NULL;
  flaunay_triangulation* copy = NULL;
  int32_t found = -1;
  OK(triangulate_in(space, places, 4, NULL, 0, &weighted));
  CHECK(flaunay_triangulation_mesh(weighted)->hidden_count == 0);
  OK(flaunay_triangulation_create(flaunay_triangulation_mesh(weighted), NULL, &copy));
  CHECK(flaunay_triangulation_mesh(copy)->is_weighted == 1);
  REFUSED(flaunay_voronoi_compute(triangulator, places, 4, copy, &dual), "weights");
  REFUSED(flaunay_voronoi_clip(triangulator, places, NULL, 4, copy, corners, 4, &cells), "weights");
  OK(flaunay_locator_create(triangulator, places, NULL, 4, NULL, 0, copy, &locator));
  REFUSED(flaunay_locator_nearest(locator, places, 1, NULL, 0, &found), "a tree of points");
  flaunay_locator_destroy(locator);
  flaunay_triangulation_destroy(copy);
  flaunay_triangulation_destroy(weighted);
  // On a torus.
  flaunay_triangulation *with_period = NULL, *none = NULL;
  flaunay_space torus = on_torus(8, 8);
  torus.weights = weights;
  OK(triangulate_in(torus, places, 6, NULL, 0, &with_period));
  const flaunay_mesh* const on_torus_mesh = flaunay_triangulation_mesh(with_period);
  CHECK(on_torus_mesh->hidden_count == 1 && on_torus_mesh->triangle_count == 10);
  OK(flaunay_mesh_verify(on_torus_mesh, places, NULL, &torus));
  REFUSED(flaunay_voronoi_clip(triangulator, NULL, NULL, 0, with_period, NULL, 0, &cells), "weights");
  REFUSED(flaunay_locator_create(triangulator, NULL, NULL, 0, NULL, 0, with_period, &locator), "weights");
  OK(flaunay_locator_create(triangulator, NULL, weights, 0, NULL, 0, with_period, &locator));
  OK(flaunay_locator_locate(locator, places, 1, NULL, 0, &found));
  CHECK(found >= 0);
  REFUSED(flaunay_locator_nearest(locator, places, 1, NULL, 0, &found), "a tree of points");
  flaunay_locator_destroy(locator);
  OK(flaunay_voronoi_clip(triangulator, NULL, weights, 0, with_period, NULL, 0, &cells));
  CHECK(fabs(total(flaunay_clipped_voronoi_areas(cells), 6) - 64) < 1e-12);
  flaunay_clipped_voronoi_destroy(cells);
  flaunay_triangulation_destroy(with_period);
  // What has no weights.
  flaunay_space sphere = {.kind = FLAUNAY_SPACE_SPHERE, .weights = weights};
  REFUSED(triangulate_in(sphere, places, 2, NULL, 0, &none), "weights");
  const flaunay_options dwyer = {.mode = FLAUNAY_MODE_DWYER, .space = &space};
  REFUSED(flaunay_triangulate(triangulator, places, 6, NULL, 0, &dwyer, &none), "mode");
  const flaunay_options with_space = {.space = &space};
  REFUSED(flaunay_triangulate_constrained(triangulator, places, 6, NULL, 0, NULL, &with_space, &none),
          "space");
  const float narrow[] = {0, 0, 1, 0, 0, 1};
  REFUSED(flaunay_triangulate_float(triangulator, narrow, 3, NULL, 0, &with_space, &none), "space");
  torus = (flaunay_space){.kind = 99};
  REFUSED(triangulate_in(torus, places, 6, NULL, 0, &none), "99 is no flaunay_space_kind");
  torus = (flaunay_space){.reserved = {1}};
  REFUSED(triangulate_in(torus, places, 6, NULL, 0, &none), "flaunay_space has members");
}

static void test_periodic(void) {
  enum { SIDE = 6, COUNT = SIDE * SIDE };
  double places[2 * COUNT];
  for (size_t i = 0; i < COUNT; ++i) {
    places[2 * i] = (double)(i % SIDE);
    places[2 * i + 1] = (double)(i / SIDE) * 2 - 40;
  }
  const flaunay_space space = on_torus(SIDE, 2 * SIDE);
  flaunay_triangulation *torus = NULL, *none = NULL;
  OK(triangulate_in(space, places, COUNT, NULL, 0, &torus));
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(torus);
  const size_t triangles = mesh->triangle_count;
  REQUIRE(mesh->point_count == COUNT && triangles == 2 * COUNT && mesh->image_count > 0);
  for (size_t c = 0; c < 3 * triangles; ++c) {
    CHECK(mesh->triangles[c] < COUNT && mesh->neighbors[c] >= 0);
    CHECK(abs(mesh->corner_offsets[2 * c]) <= 1);
  }
  CHECK(mesh->places[1] == 8 && mesh->representatives[7] == 7 && mesh->triangle_offsets[1] == triangles);
  CHECK(mesh->space->kind == FLAUNAY_SPACE_TORUS && mesh->space->period_y == 2 * SIDE);
  OK(flaunay_mesh_verify(mesh, places, NULL, &space));
  const flaunay_space other = on_torus(SIDE, SIDE);
  CHECK(fails(flaunay_mesh_verify(mesh, places, NULL, &other), FLAUNAY_ERROR_INTERNAL, "period"));
  flaunay_point_tree* tree = NULL;
  OK(flaunay_point_tree_create_in_space(triangulator, torus, &tree));
  REFUSED(flaunay_point_tree_set_coordinates(tree, FLAUNAY_SPHERE_DEGREES), "coordinates");
  flaunay_point_tree_destroy(tree);
  flaunay_clipped_voronoi* cells = NULL;
  OK(flaunay_voronoi_clip(triangulator, NULL, NULL, 0, torus, NULL, 0, &cells));
  const double* const areas = flaunay_clipped_voronoi_areas(cells);
  CHECK(flaunay_clipped_voronoi_vertex_count(cells) == 4 * COUNT && fabs(areas[7] - 2) < 1e-12);
  flaunay_locator* locator = NULL;
  OK(flaunay_locator_create(triangulator, NULL, NULL, 0, NULL, 0, torus, &locator));
  const double query[] = {SIDE - 0.25, -0.5};
  int32_t found[] = {-2, -2};
  double value = 0;
  OK(flaunay_locator_locate(locator, query, 1, NULL, 0, found));
  CHECK(found[0] >= 0);
  OK(flaunay_locator_nearest(locator, query, 1, NULL, 0, found));
  CHECK(mesh->places[2 * found[0]] == 0 && found[1] == -2);
  OK(flaunay_locator_interpolate(locator, areas, query, 1, NULL, 0, NULL, &value));
  CHECK(fabs(value - 2) < 1e-12);
  flaunay_interpolation_options how = {0};
  how.method = FLAUNAY_INTERPOLATION_SIBSON;
  how.columns = 1;
  OK(flaunay_locator_interpolate(locator, areas, query, 1, NULL, 0, &how, &value));
  CHECK(fabs(value - 2) < 1e-12);
  how.method = FLAUNAY_INTERPOLATION_CLOUGH_TOCHER;
  OK(flaunay_locator_interpolate(locator, areas, query, 1, NULL, 0, &how, &value));
  CHECK(fabs(value - 2) < 1e-12);
  const size_t two_sets[] = {0, 1, 1};
  REFUSED(flaunay_locator_locate(locator, query, 1, two_sets, 2, found), "2 sets");
  double gradients[2 * COUNT];
  OK(flaunay_locator_gradients(locator, areas, NULL, gradients));
  CHECK(fabs(gradients[0]) < 1e-12 && fabs(gradients[2 * COUNT - 1]) < 1e-12);
  flaunay_clipped_voronoi_destroy(cells);
  flaunay_locator_destroy(locator);
  flaunay_voronoi* voronoi = NULL;
  REFUSED(flaunay_voronoi_compute(triangulator, places, COUNT, torus, &voronoi), "clipped_voronoi");
  flaunay_triangulation_destroy(torus);
  OK(triangulate_in(on_torus(INFINITY, 2 * SIDE), places, COUNT, NULL, 0, &torus));
  CHECK(flaunay_triangulation_mesh(torus)->triangle_count == 2 * COUNT - 2 * SIDE);
  REFUSED(flaunay_voronoi_clip(triangulator, NULL, NULL, 0, torus, NULL, 0, &cells), "cylinder");
  REFUSED(triangulate_in(on_torus(0, 1), places, 3, NULL, 0, &none), "period");
  flaunay_space sheared = on_torus(1, INFINITY);
  sheared.shear = 0.5;
  REFUSED(triangulate_in(sheared, places, 3, NULL, 0, &none), "shear");
  const flaunay_options with_areas = {.parts = FLAUNAY_PART_AREAS, .space = &space};
  REFUSED(flaunay_triangulate(triangulator, places, COUNT, NULL, 0, &with_areas, &none), "areas");
  flaunay_triangulation_destroy(torus);
}

static void test_relax_on_device(void) {
  const double box[] = {0, 0, 4, 0, 4, 4, 0, 4}, places[] = {1, 1, 1, 3};
  const flaunay_device_points input = {.memory = make_buffer(context, sizeof places, places), .count = 2};
  const flaunay_enqueue enqueue = {.queue = queue};
  cl_mem relaxed = NULL;
  OK(flaunay_relax_device(triangulator, &input, box, 4, 2, &enqueue, &relaxed));
  double found[4] = {0};
  read_buffer(relaxed, sizeof found, found);
  CHECK(fabs(found[0] - 2) < 1e-12 && fabs(found[1] - 1) < 1e-12 && fabs(found[3] - 3) < 1e-12);
  cl_mem same = input.memory;
  REFUSED(flaunay_relax_device(triangulator, &input, box, 4, 2, &enqueue, &same), "two things");
  clReleaseMemObject(relaxed);
}

static void test_point_tree(void) {
  flaunay_point_tree* tree = NULL;
  OK(flaunay_point_tree_create(triangulator, kSquare, 4, &tree));
  const double query[] = {kSquare[2], kSquare[3]};
  int32_t found[5];
  double distances[5];
  OK(flaunay_point_tree_nearest(tree, query, 1, 5, INFINITY, found, distances));
  CHECK(found[0] == 1 && distances[0] == 0 && found[3] >= 0 && distances[3] > distances[1]);
  CHECK(found[4] == -1 && isinf(distances[4]));
  OK(flaunay_point_tree_nearest(tree, query, 1, 2, 0, found, NULL));
  CHECK(found[0] == 1 && found[1] == -1);
  REFUSED(flaunay_point_tree_nearest(tree, query, 1, 0, 1, found, NULL), "1 or more");
  flaunay_point_tree_destroy(tree);
}

static void test_locator(void) {
  flaunay_locator* locator = NULL;
  flaunay_triangulation* mesh = on_host(kSquare, 4, NULL, 0, 0);
  OK(flaunay_locator_create(triangulator, kSquare, NULL, 4, NULL, 1, mesh, &locator));
  int32_t triangles[kQueryCount], nearest[kQueryCount];
  double values[kQueryCount];
  OK(flaunay_locator_locate(locator, kQueries, kQueryCount, NULL, 1, triangles));
  OK(flaunay_locator_nearest(locator, kQueries, kQueryCount, NULL, 1, nearest));
  OK(flaunay_locator_interpolate(locator, kValues, kQueries, kQueryCount, NULL, 1, NULL, values));
  check_answers(mesh, triangles, nearest, values);

  const double rows[] = {1, -1, 4, -4, 7, -7, 2, -2};
  flaunay_interpolation_options options = {.columns = 2, .has_fill = 1, .fill = 5};
  double pairs[2 * kQueryCount], gradients[16];
  for (int method = 0; method <= FLAUNAY_INTERPOLATION_CLOUGH_TOCHER; ++method) {
    options.method = method;
    OK(flaunay_locator_interpolate(locator, rows, kQueries, kQueryCount, NULL, 1, &options, pairs));
    for (int k = 0; k < kQueryCount; ++k) CHECK(pairs[2 * k + 1] == -pairs[2 * k] || pairs[2 * k] == 5);
    CHECK(pairs[2] == 7 && pairs[4] == (method == FLAUNAY_INTERPOLATION_NEAREST ? 1 : 5));
  }
  OK(flaunay_locator_gradients(locator, rows, &options, gradients));
  for (int k = 0; k < 4; ++k) CHECK(gradients[4 * k] == -gradients[4 * k + 2] && gradients[4 * k] > 0);
  double again[2 * kQueryCount];
  options.gradients = gradients;
  OK(flaunay_locator_interpolate(locator, rows, kQueries, kQueryCount, NULL, 1, &options, again));
  CHECK(memcmp(pairs, again, sizeof pairs) == 0);
  OK(flaunay_locator_interpolate(locator, kValues, kQueries, kQueryCount, NULL, 1, NULL, values));
  check_answers(mesh, triangles, nearest, values);
  options.method = 77;
  REFUSED(flaunay_locator_interpolate(locator, rows, kQueries, 2, NULL, 1, &options, pairs),
          "77 is no flaunay_interpolation");
  options.method = 0;
  options.reserved[7] = 1;
  REFUSED(flaunay_locator_gradients(locator, rows, &options, gradients), "does not know");

  const double bad[] = {0, 0, NAN, 1};
  WRONG_INPUT(flaunay_locator_locate(locator, bad, 2, NULL, 1, triangles), "query 1");
  REFUSED(flaunay_locator_nearest(locator, kQueries, 3, (const size_t[]){0, 1, 3}, 2, nearest), "sets");
  REFUSED(flaunay_locator_nearest(locator, kQueries, 3, (const size_t[]){0, 2}, 1, nearest), "offsets");
  OK(flaunay_locator_locate(locator, NULL, 0, NULL, 1, NULL));
  flaunay_natural_weights* weights = NULL;
  OK(flaunay_natural_weights_compute(locator, kQueries, kQueryCount, FLAUNAY_INTERPOLATION_SIBSON, &weights));
  const size_t* const rows_of_weights = flaunay_natural_weights_offsets(weights);
  double sum = 0;
  for (size_t k = rows_of_weights[0]; k < rows_of_weights[1]; ++k) {
    CHECK(flaunay_natural_weights_points(weights)[k] < 4);
    sum += flaunay_natural_weights_weights(weights)[k];
  }
  CHECK(fabs(sum - 1) < 1e-12 || rows_of_weights[0] == rows_of_weights[1]);
  CHECK(rows_of_weights[kQueryCount] > 0);
  flaunay_natural_weights_destroy(weights);
  REFUSED(flaunay_natural_weights_compute(locator, kQueries, 1, FLAUNAY_INTERPOLATION_LINEAR, &weights),
          "Sibson");
  REFUSED(flaunay_natural_weights_compute(locator, kQueries, 1, 17, &weights), "flaunay_interpolation");
  flaunay_locator_destroy(locator);
  REFUSED(flaunay_locator_create(triangulator, kSquare, NULL, 3, NULL, 1, mesh, &locator), "points");
  CHECK(locator == NULL);
}

// A square with a square hole, its corners four points more.
static void test_queries_with_constraints(void) {
  const double corners[] = {0, 0, 9, 0, 9, 9, 0, 9, 3, 3, 6, 3, 6, 6, 3, 6};
  const int32_t rings[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
  const flaunay_constraints constraints = {
      .segments = rings, .segment_count = 8, .outside = FLAUNAY_OUTSIDE_HOLES};
  const flaunay_options options = {.parts = FLAUNAY_PART_NEIGHBORS};
  flaunay_triangulation* result = NULL;
  OK(flaunay_triangulate_constrained(triangulator, corners, 8, NULL, 1, &constraints, &options, &result));
  const flaunay_mesh* mesh = flaunay_triangulation_mesh(result);
  // Of kept arrays, as the original.
  flaunay_triangulation* copy = NULL;
  const flaunay_constrained_arrays kept = {.constrained =
                                               flaunay_triangulation_constraints(result)->constrained};
  OK(flaunay_triangulation_create(mesh, &kept, &copy));
  flaunay_locator* locator = NULL;
  OK(flaunay_locator_create(triangulator, corners, NULL, 8, NULL, 0, result, &locator));
  flaunay_locator_destroy(locator);
  OK(flaunay_locator_create(triangulator, corners, NULL, 8, NULL, 0, copy, &locator));
  flaunay_voronoi* dual = NULL;
  REFUSED(flaunay_voronoi_compute(triangulator, corners, 8, copy, &dual), "dual");
  const double queries[] = {4.5, 4.5, 1, 1, 6, 4, 12, 1};
  int32_t triangles[4], nearest[4];
  double heights[4], values[8];
  for (int i = 0; i < 8; ++i) values[i] = 2 * corners[2 * i] + corners[2 * i + 1];
  OK(flaunay_locator_locate(locator, queries, 4, NULL, 1, triangles));
  CHECK(triangles[0] == -1 && triangles[1] >= 0 && triangles[2] >= 0 && triangles[3] == -1);
  OK(flaunay_locator_nearest(locator, queries, 4, NULL, 1, nearest));
  CHECK(nearest[0] == 4 && nearest[1] == 0 && nearest[2] == 5 && nearest[3] == 1);
  const flaunay_interpolation_options sibson = {.method = FLAUNAY_INTERPOLATION_SIBSON};
  OK(flaunay_locator_interpolate(locator, values, queries, 4, NULL, 1, &sibson, heights));
  CHECK(isnan(heights[0]) && fabs(heights[1] - 3) < 1e-9 && fabs(heights[2] - 16) < 1e-9 &&
        isnan(heights[3]));
  flaunay_locator_destroy(locator);
  REFUSED(flaunay_locator_create(triangulator, corners, NULL, 7, NULL, 0, copy, &locator), "points");
  flaunay_triangulation_destroy(copy);
  flaunay_triangulation_destroy(result);
}

static void test_sphere_on_device(void) {
  // Two sets, of which the second has a point at the south pole if they begin with the second point.
  const double places[] = {0, 0, 120, 0, 240, 0, 0, 90, 10, -40, 50, -90};
  const size_t sets[] = {0, 3, 5};
  flaunay_device_points given = {
      .memory = make_buffer(context, sizeof places, places), .count = 5, .offsets = sets, .sets = 2};
  const flaunay_enqueue enqueue = {.queue = queue};
  flaunay_space space = {.kind = FLAUNAY_SPACE_SPHERE, .coordinates = FLAUNAY_SPHERE_DEGREES};
  given.space = &space;
  flaunay_triangulation* host = NULL;
  flaunay_device_triangulation* sphere = NULL;
  OK(flaunay_device_triangulation_create(&sphere));
  CHECK(flaunay_device_triangulation_mesh(sphere)->triangle_count == 0);
  cl_mem own = make_buffer(context, 24 * 5, NULL);
  OK(flaunay_device_triangulation_set_buffer(sphere, FLAUNAY_PART_TRIANGLES, own));
  for (size_t first = 0; first < 2; ++first) {
    given.first = first;
    OK(triangulate_in(space, places + 2 * first, 5, sets, 2, &host));
    OK(flaunay_triangulate_device(triangulator, &given, 0, &enqueue, sphere));
    const flaunay_mesh *expected = flaunay_triangulation_mesh(host),
                       *mesh = flaunay_device_triangulation_mesh(sphere);
    const size_t triangles = expected->triangle_count;
    REQUIRE(mesh->triangle_count == triangles && triangles == 2 && mesh->point_count == 5);
    CHECK(mesh->triangle_offsets[2] == triangles && mesh->space->kind == FLAUNAY_SPACE_SPHERE);
    CHECK(flaunay_device_triangulation_buffer(sphere, FLAUNAY_PART_TRIANGLES) == own);
    cl_mem neighbors = flaunay_device_triangulation_buffer(sphere, FLAUNAY_PART_NEIGHBORS);
    CHECK(has_bytes(own, expected->triangles, 12 * triangles));
    CHECK(has_bytes(neighbors, expected->neighbors, 12 * triangles));
    flaunay_triangulation_destroy(host);
  }
  // No call in the plane takes these.
  flaunay_locator* locator = NULL;
  REFUSED(flaunay_locator_create_device(triangulator, &given, sphere, &enqueue, &locator), "space");
  space.coordinates = FLAUNAY_SPHERE_DIRECTIONS;
  REFUSED(flaunay_triangulate_device(triangulator, &given, 0, &enqueue, sphere), "too small");
  REFUSED(flaunay_device_triangulation_set_buffer(sphere, 1 << 20, own), "1048576");
  flaunay_device_triangulation_destroy(sphere);
}

static void test_derived_on_device(void) {
  flaunay_triangulation* mesh = on_host(kSquare, 4, NULL, 0, 0);
  const flaunay_device_points square = {.memory = make_buffer(context, sizeof kSquare, kSquare), .count = 4};
  const flaunay_device_points queries = {.memory = make_buffer(context, sizeof kQueries, kQueries),
                                         .count = kQueryCount};
  cl_mem values = make_buffer(context, sizeof kValues, kValues);
  cl_mem results = make_buffer(context, kQueryCount * sizeof(double), NULL);
  cl_mem found = make_buffer(context, kQueryCount * sizeof(int32_t), NULL);
  cl_mem near = make_buffer(context, kQueryCount * sizeof(int32_t), NULL);
  const flaunay_enqueue enqueue = {.queue = queue};
  flaunay_device_triangulation* device_mesh = NULL;
  flaunay_device_voronoi* dual = NULL;
  flaunay_locator* locator = NULL;
  const unsigned parts =
      FLAUNAY_PART_TRIANGLES | FLAUNAY_PART_NEIGHBORS | FLAUNAY_PART_HULL | FLAUNAY_PART_REPRESENTATIVES;
  OK(flaunay_device_triangulation_create(&device_mesh));
  OK(flaunay_device_voronoi_create(&dual));
  OK(flaunay_triangulate_device(triangulator, &square, parts, &enqueue, device_mesh));
  OK(flaunay_voronoi_compute_device(triangulator, &square, device_mesh, &enqueue, dual));
  double centres[4] = {0};
  cl_mem centre_memory = flaunay_device_voronoi_buffer(dual, FLAUNAY_VORONOI_CIRCUMCENTRES);
  read_buffer(centre_memory, sizeof centres, centres);
  CHECK(centres[0] > 0 && centres[0] < 4 && centres[2] > 0 && centres[2] < 4);

  OK(flaunay_locator_create_device(triangulator, &square, device_mesh, &enqueue, &locator));
  OK(flaunay_locator_locate_device(locator, &queries, &enqueue, &found));
  OK(flaunay_locator_nearest_device(locator, &queries, &enqueue, &near));
  OK(flaunay_locator_interpolate_device(locator, values, &queries, NULL, &enqueue, &results));
  int32_t triangles[kQueryCount], nearest[kQueryCount];
  double interpolated[kQueryCount];
  read_buffer(found, sizeof triangles, triangles);
  read_buffer(near, sizeof nearest, nearest);
  read_buffer(results, sizeof interpolated, interpolated);
  check_answers(mesh, triangles, nearest, interpolated);
  REFUSED(flaunay_locator_interpolate_device(locator, values, &queries, NULL, &enqueue, &found), "too small");
  flaunay_interpolation_options options = {.method = FLAUNAY_INTERPOLATION_CLOUGH_TOCHER};
  double slopes[8];
  OK(flaunay_locator_gradients_device(locator, values, NULL, &enqueue, &options.device_gradients));
  read_buffer(options.device_gradients, sizeof slopes, slopes);
  for (int k = 0; k < 8; ++k) CHECK(isfinite(slopes[k]));
  OK(flaunay_locator_interpolate_device(locator, values, &queries, &options, &enqueue, &results));
  read_buffer(results, sizeof interpolated, interpolated);
  CHECK(interpolated[1] == 7 && isnan(interpolated[2]));
  options.gradients = slopes;
  REFUSED(flaunay_locator_interpolate_device(locator, values, &queries, &options, &enqueue, &results),
          "host memory");
  clReleaseMemObject(options.device_gradients);
  flaunay_locator_destroy(locator);
  flaunay_device_voronoi_destroy(dual);
  flaunay_device_triangulation_destroy(device_mesh);
}

static void test_periodic_on_device(void) {
  enum { COUNT = 50 };
  double places[2 * COUNT];
  for (size_t i = 0; i < 2 * COUNT; ++i) places[i] = fmod(0.618034 * (double)(i * i), 1);
  flaunay_space space = on_torus(1, 0.75);
  space.shear = 1.25;
  flaunay_triangulation* host = NULL;
  const size_t offsets[] = {0, 10, COUNT};
  OK(triangulate_in(space, places, COUNT, offsets, 2, &host));
  flaunay_device_points given = {.memory = make_buffer(context, sizeof places, places),
                                 .count = COUNT,
                                 .offsets = offsets,
                                 .sets = 2,
                                 .space = &space};
  const flaunay_enqueue enqueue = {.queue = queue};
  flaunay_device_triangulation* torus = NULL;
  OK(flaunay_device_triangulation_create(&torus));
  cl_mem own = make_buffer(context, 12 * COUNT, NULL), small = make_buffer(context, 12 * COUNT - 1, NULL);
  OK(flaunay_device_triangulation_set_buffer(torus, FLAUNAY_PART_CORNER_OFFSETS, own));
  OK(flaunay_triangulate_device(triangulator, &given, 0, &enqueue, torus));
  const flaunay_mesh *expected = flaunay_triangulation_mesh(host),
                     *mesh = flaunay_device_triangulation_mesh(torus);
  const size_t triangles = expected->triangle_count;
  CHECK(mesh->triangle_count == triangles && mesh->triangle_offsets[1] == expected->triangle_offsets[1]);
  CHECK(mesh->image_count == expected->image_count && mesh->space->period_y == 0.75);
  CHECK(mesh->space->shear == 0.25);
  const struct {
    unsigned part;
    const void* values;
    size_t bytes;
  } parts[] = {{FLAUNAY_PART_PLACES, expected->places, 16 * COUNT},
               {FLAUNAY_PART_TRIANGLES, expected->triangles, 12 * triangles},
               {FLAUNAY_PART_CORNER_OFFSETS, expected->corner_offsets, 6 * triangles},
               {FLAUNAY_PART_NEIGHBORS, expected->neighbors, 12 * triangles},
               {FLAUNAY_PART_REPRESENTATIVES, expected->representatives, 4 * COUNT}};
  for (size_t p = 0; p < sizeof parts / sizeof *parts; ++p) {
    cl_mem memory = flaunay_device_triangulation_buffer(torus, parts[p].part);
    CHECK(has_bytes(memory, parts[p].values, parts[p].bytes));
  }
  CHECK(flaunay_device_triangulation_buffer(torus, FLAUNAY_PART_CORNER_OFFSETS) == own);
  CHECK(flaunay_device_triangulation_buffer(torus, 3) == NULL);
  space = on_torus(0, 1);
  REFUSED(flaunay_triangulate_device(triangulator, &given, 0, &enqueue, torus), "period");
  space = on_torus(1, 1);
  OK(flaunay_device_triangulation_set_buffer(torus, FLAUNAY_PART_CORNER_OFFSETS, small));
  REFUSED(flaunay_triangulate_device(triangulator, &given, 0, &enqueue, torus), "too small");
  flaunay_device_triangulation_destroy(torus);
  flaunay_triangulation_destroy(host);
}

// ---- Chunks

// So few that there are several rounds.
enum { kChunkPoints = 400 };

static int32_t* make_indices(size_t count) {
  int32_t* result = allocate(count * sizeof *result);
  return result;
}

static double* make_doubles(size_t count) {
  double* made = allocate(count * sizeof *made);
  return made;
}

// Cheap and independent of the order of rows; equal triangles with equal sides to their neighbours have equal
// sums.
static uint64_t row_sum(const int32_t* triangles, const int32_t* neighbors, size_t count) {
  uint64_t sum = 0;
  for (size_t t = 0; t < count; ++t) {
    uint64_t hash = 0;
    for (size_t k = 0; k < 3; ++k) {
      const int32_t other = neighbors[3 * t + k];
      hash = hash * 1000003 + (uint64_t)triangles[3 * t + k];
      for (size_t c = 0; c < 3; ++c) {
        hash = hash * 1000003 + (other < 0 ? 77 : (uint64_t)triangles[3 * (size_t)other + c]);
      }
    }
    sum += hash * hash;
  }
  return sum;
}

static void check_chunk_statistics(const flaunay_chunk_statistics* statistics,
                                   const flaunay_triangulation* expected) {
  CHECK(statistics->points == kPoints && statistics->chunk_points == kChunkPoints);
  CHECK(statistics->triangles == flaunay_triangulation_mesh(expected)->triangle_count);
  CHECK(statistics->hull_vertices == flaunay_triangulation_mesh(expected)->hull_count);
  CHECK(statistics->duplicates == flaunay_triangulation_mesh(expected)->statistics->duplicates);
  CHECK(statistics->seconds > 0 && statistics->scratch_bytes >= 24 * kPoints);
  REQUIRE(statistics->round_count >= 2 && statistics->device_count == 1 && statistics->phase_count >= 3);
  CHECK(statistics->rounds[0].points == kPoints && statistics->rounds[0].chunks >= kPoints / kChunkPoints);
  CHECK(statistics->rounds[0].handed_on == statistics->rounds[1].points);
  CHECK(statistics->rounds[statistics->round_count - 1].handed_on == 0);
  CHECK(statistics->rounds[0].triangles < statistics->triangles);
  CHECK(strcmp(statistics->devices[0].name, "host") == 0 && statistics->devices[0].points >= kPoints);
  CHECK(strcmp(statistics->phases[0].name, "distribute") == 0 && statistics->phases[0].seconds >= 0);
}

static const char* const kHostAlone[] = {"host"};
static const flaunay_chunk_options kSmallChunks = {
    .devices = kHostAlone, .device_count = 1, .chunk_points = kChunkPoints};

static void check_same_mesh(const int32_t* triangles, const int32_t* neighbors, const int32_t* hull,
                            const int32_t* representatives, const double* areas,
                            const flaunay_triangulation* expected) {
  const size_t count = flaunay_triangulation_mesh(expected)->triangle_count;
  CHECK(row_sum(triangles, neighbors, count) == row_sum(flaunay_triangulation_mesh(expected)->triangles,
                                                        flaunay_triangulation_mesh(expected)->neighbors,
                                                        count));
  CHECK(same(hull, flaunay_triangulation_mesh(expected)->hull,
             flaunay_triangulation_mesh(expected)->hull_count));
  CHECK(same(representatives, flaunay_triangulation_mesh(expected)->representatives, kPoints));
  double* own = make_doubles(count);
  OK(flaunay_triangle_areas(points, kPoints, triangles, count, own));
  CHECK(memcmp(areas, own, count * sizeof *own) == 0);
}

static void test_chunks_in_arrays(void) {
  flaunay_triangulation* expected = on_host(points, kPoints, NULL, 0, 0);
  flaunay_mesh_arrays arrays = {.triangles = make_indices(6 * kPoints),
                                .neighbors = make_indices(6 * kPoints),
                                .hull = make_indices(kPoints),
                                .representatives = make_indices(kPoints),
                                .areas = make_doubles(2 * kPoints)};
  flaunay_chunk_report* report = NULL;
  OK(flaunay_triangulate_chunks(points, kPoints, &arrays, &kSmallChunks, &report));
  check_chunk_statistics(flaunay_chunk_report_statistics(report), expected);
  check_same_mesh(arrays.triangles, arrays.neighbors, arrays.hull, arrays.representatives, arrays.areas,
                  expected);
  flaunay_chunk_report_destroy(report);

  // The hull alone in 64 bits, on a device that is in use by this program.
  int64_t* wide = allocate(kPoints * sizeof *wide);
  const flaunay_mesh_arrays hull_alone = {.index_type = FLAUNAY_INT64, .hull = wide};
  flaunay_chunk_options own = {.triangulators = &triangulator, .triangulator_count = 1};
  OK(flaunay_triangulate_chunks(points, kPoints, &hull_alone, &own, &report));
  CHECK(strcmp(flaunay_chunk_report_statistics(report)->devices[0].name,
               flaunay_triangulator_device(triangulator)->name) == 0);
  const size_t hull_count = flaunay_chunk_report_statistics(report)->hull_vertices;
  CHECK(flaunay_chunk_report_statistics(report)->round_count == 1);
  REQUIRE(hull_count == flaunay_triangulation_mesh(expected)->hull_count);
  for (size_t k = 0; k < hull_count; ++k) CHECK(wide[k] == flaunay_triangulation_mesh(expected)->hull[k]);
  flaunay_chunk_report_destroy(report);
}

static const char* path_of(const char* name) {
  const char* const folder = getenv("TMPDIR") != NULL ? getenv("TMPDIR") : "/tmp";
  char* const path = allocate(4096);
  snprintf(path, 4096, "%s/flaunay-%d-%s", folder, (int)getpid(), name);
  return path;
}

// A .npy file's entries; its header has 128 bytes.
static void* read_entries(const char* path, size_t bytes) {
  FILE* file = fopen(path, "rb");
  REQUIRE(file != NULL);
  char header[128];
  void* entries = allocate(bytes + 1);
  REQUIRE(fread(header, sizeof header, 1, file) == 1);
  CHECK(memcmp(header + 1, "NUMPY", 5) == 0 && fread(entries, 1, bytes, file) == bytes);
  CHECK(fgetc(file) == EOF);
  fclose(file);
  return entries;
}

// Expects an error of a call that writes files.
static void check_refused(const flaunay_strided_points* source, const flaunay_mesh_arrays* arrays,
                          const flaunay_mesh_files* files, flaunay_status status, const char* text) {
  flaunay_chunk_report* report = NULL;
  CHECK(fails(flaunay_triangulate_chunks_to_files(source, arrays, files, NULL, &report), status, text));
  CHECK(report == NULL);
}

static void test_chunks_to_files(void) {
  const char *triangles_path = path_of("triangles.npy"), *neighbors_path = path_of("neighbors.npy"),
             *areas_path = path_of("areas.npy");
  // Points as float, each after a number that is not its own, from the last one to the first.
  float* rows = allocate(3 * kPoints * sizeof *rows);
  for (size_t i = 0; i < kPoints; ++i) {
    rows[3 * (kPoints - 1 - i)] = NAN;
    rows[3 * (kPoints - 1 - i) + 1] = (float)points[2 * i + 1];
    rows[3 * (kPoints - 1 - i) + 2] = (float)points[2 * i];
  }
  const flaunay_strided_points source = {.coordinates = rows + 3 * kPoints - 1,
                                         .count = kPoints,
                                         .precision = FLAUNAY_FLOAT32,
                                         .point_stride = -3 * (ptrdiff_t)sizeof *rows,
                                         .coordinate_stride = -(ptrdiff_t)sizeof *rows};
  const flaunay_mesh_files files = {
      .triangles = triangles_path, .neighbors = neighbors_path, .areas = areas_path};
  const flaunay_mesh_arrays arrays = {.hull = make_indices(kPoints),
                                      .representatives = make_indices(kPoints)};
  flaunay_chunk_report* report = NULL;
  OK(flaunay_triangulate_chunks_to_files(&source, &arrays, &files, &kSmallChunks, &report));
  flaunay_triangulation* expected = on_host(points, kPoints, NULL, 0, 0);
  check_chunk_statistics(flaunay_chunk_report_statistics(report), expected);
  const size_t bytes = 3 * flaunay_triangulation_mesh(expected)->triangle_count * sizeof(int32_t);
  int32_t *triangles = read_entries(triangles_path, bytes), *neighbors = read_entries(neighbors_path, bytes);
  double* areas =
      read_entries(areas_path, flaunay_triangulation_mesh(expected)->triangle_count * sizeof(double));
  check_same_mesh(triangles, neighbors, arrays.hull, arrays.representatives, areas, expected);
  flaunay_chunk_report_destroy(report);

  // Without arrays, and in 64 bits.
  const flaunay_mesh_arrays wide = {.index_type = FLAUNAY_INT64};
  const flaunay_mesh_files one = {.triangles = triangles_path};
  OK(flaunay_triangulate_chunks_to_files(&source, &wide, &one, &kSmallChunks, &report));
  int64_t* wide_triangles = read_entries(triangles_path, 2 * bytes);
  for (size_t k = 0; k < bytes / sizeof(int32_t); ++k) CHECK(wide_triangles[k] == triangles[k]);
  flaunay_chunk_report_destroy(report);
  const flaunay_strided_points none = {0};
  OK(flaunay_triangulate_chunks_to_files(&none, NULL, &one, NULL, &report));
  flaunay_chunk_report_destroy(report);
  read_entries(triangles_path, 0);

  // After an error the files are what they were.
  const flaunay_status usage = FLAUNAY_ERROR_USAGE, input = FLAUNAY_ERROR_INPUT;
  flaunay_mesh_files bad = files;
  bad.hull = "/tmp/hull.npy";
  check_refused(&source, &arrays, &bad, usage, "hull are");
  bad.hull = "/tmp/hull.txt";
  check_refused(&source, NULL, &bad, usage, ".npy");
  bad.hull = path_of("missing/t.npy");
  check_refused(&source, NULL, &bad, input, "missing");
  bad = files, bad.reserved[0] = 1;
  check_refused(&source, NULL, &bad, usage, "flaunay_mesh_files");
  flaunay_strided_points strange = source;
  strange.precision = 2;
  check_refused(&strange, NULL, &files, usage, "2 is no flaunay_precision");
  strange = source, strange.reserved[3] = 1;
  check_refused(&strange, NULL, &files, usage, "flaunay_strided_points");
  strange = source, strange.count = (uint64_t)1 << 31;
  const flaunay_mesh_arrays no_arrays = {0}, many = {.neighbors = arrays.hull}, of_bytes = {.index_type = 2};
  check_refused(&strange, &no_arrays, NULL, input, "32 bits");
  strange.count = (uint64_t)1 << 30;
  check_refused(&strange, &many, NULL, input, "32 bits");
  check_refused(&source, &of_bytes, NULL, usage, "indices 2");
  rows[4] = INFINITY;
  check_refused(&source, NULL, &files, input, "point 4998");
  read_entries(triangles_path, 0);
  int32_t* kept = read_entries(neighbors_path, bytes);
  CHECK(same(kept, neighbors, bytes / sizeof *kept));
  CHECK(remove(triangles_path) == 0 && remove(neighbors_path) == 0 && remove(areas_path) == 0);
}

static int read_file(uint64_t first, size_t count, double* coordinates, void* file) {
  const size_t bytes = 2 * sizeof *coordinates;
  if (fseek(file, (long)(first * bytes), SEEK_SET) != 0) return 1;
  return fread(coordinates, bytes, count, file) == count ? 0 : 2;
}

static int read_points(uint64_t first, size_t count, double* coordinates, void* all) {
  memcpy(coordinates, (const double*)all + 2 * first, 2 * count * sizeof *coordinates);
  return 0;
}

static int read_nothing(uint64_t first, size_t count, double* coordinates, void* calls) {
  (void)first, (void)count, (void)coordinates;
  ++*(int*)calls;
  return 7;
}

static int read_values(uint64_t first, size_t count, double* values, void* all) {
  memcpy(values, (const double*)all + first, count * sizeof *values);
  return 0;
}

static int read_no_values(uint64_t first, size_t count, double* values, void* data) {
  (void)first, (void)count, (void)values, (void)data;
  return -4;
}

// What a sink has got: triangles in a file, the other parts in arrays.
typedef struct {
  FILE* triangles;
  int32_t *neighbors, *hull, *representatives;
  double* areas;
  unsigned parts, fails_at;
} stored_mesh;

static int write_part(unsigned part, uint64_t first, const int64_t* values, size_t count, void* data) {
  stored_mesh* mesh = data;
  mesh->parts |= part;
  if (part == mesh->fails_at) return -3;
  int32_t* to = part == FLAUNAY_PART_NEIGHBORS ? mesh->neighbors
                : part == FLAUNAY_PART_HULL    ? mesh->hull
                                               : mesh->representatives;
  for (size_t k = 0; k < count; ++k) {
    const int32_t narrow = (int32_t)values[k];
    if (part != FLAUNAY_PART_TRIANGLES) {
      to[first + k] = narrow;
    } else if (fseek(mesh->triangles, (long)((first + k) * sizeof narrow), SEEK_SET) != 0 ||
               fwrite(&narrow, sizeof narrow, 1, mesh->triangles) != 1) {
      return 1;
    }
  }
  return 0;
}

static int write_areas(unsigned part, uint64_t first, const double* values, size_t count, void* data) {
  stored_mesh* mesh = data;
  mesh->parts |= part;
  if (part == mesh->fails_at) return -3;
  memcpy(mesh->areas + first, values, count * sizeof *values);
  return 0;
}

static int write_corner_offsets(uint64_t first, const int8_t* values, size_t count, void* data) {
  memcpy((int8_t*)data + first, values, count);
  return 0;
}

static void test_chunks_with_a_period(void) {
  const char *neighbors_path = path_of("neighbors.npy"), *offsets_path = path_of("offsets.npy");
  const flaunay_strided_points source = {.coordinates = points,
                                         .count = kPoints,
                                         .point_stride = 2 * sizeof *points,
                                         .coordinate_stride = sizeof *points};
  const flaunay_mesh_arrays arrays = {.triangles = make_indices(6 * kPoints),
                                      .representatives = make_indices(kPoints)};
  flaunay_mesh_files files = {.neighbors = neighbors_path, .corner_offsets = offsets_path};
  const flaunay_space space = on_torus(0.7, INFINITY);
  flaunay_chunk_options options = kSmallChunks;
  options.space = &space;
  flaunay_chunk_report* report = NULL;
  OK(flaunay_triangulate_chunks_to_files(&source, &arrays, &files, &options, &report));
  flaunay_triangulation* cylinder = NULL;
  OK(triangulate_in(space, points, kPoints, NULL, 0, &cylinder));
  const flaunay_mesh* const expected = flaunay_triangulation_mesh(cylinder);
  const size_t count = expected->triangle_count;
  const flaunay_chunk_statistics* const statistics = flaunay_chunk_report_statistics(report);
  CHECK(statistics->triangles == count && statistics->points == kPoints && statistics->hull_vertices == 0);
  CHECK(statistics->images > 0 && statistics->rounds[0].points == kPoints + statistics->images);
  int32_t* const neighbors = read_entries(neighbors_path, 3 * count * sizeof *neighbors);
  int8_t* const offsets = read_entries(offsets_path, 6 * count);
  CHECK(row_sum(arrays.triangles, neighbors, count) ==
        row_sum(expected->triangles, expected->neighbors, count));
  CHECK(same(arrays.representatives, expected->representatives, kPoints));
  int sums[2] = {0, 0};
  for (size_t k = 0; k < 6 * count; ++k) {
    sums[0] += offsets[k] * (k % 2 == 0 ? 1 : 1000);
    sums[1] += expected->corner_offsets[k] * (k % 2 == 0 ? 1 : 1000);
  }
  CHECK(sums[0] == sums[1]);
  double period[] = {0.7, INFINITY, 0};
  double* const places = make_doubles(2 * kPoints);
  memcpy(places, points, 2 * kPoints * sizeof *places);
  OK(flaunay_take_to_places(period, places, kPoints));
  CHECK(period[0] == expected->space->period_x && period[1] == INFINITY);
  CHECK(memcmp(places, expected->places, 2 * kPoints * sizeof *places) == 0);
  flaunay_chunk_report_destroy(report);

  int8_t* const streamed = calloc(12 * kPoints, 1);
  const flaunay_point_source stream = {.count = kPoints, .read = read_points, .data = points};
  flaunay_mesh_sink sink = {
      .parts = FLAUNAY_PART_CORNER_OFFSETS, .write_corner_offsets = write_corner_offsets, .data = streamed};
  OK(flaunay_triangulate_streams(&stream, &sink, &options, &report));
  CHECK(memcmp(streamed, offsets, 6 * count) == 0);
  flaunay_chunk_report_destroy(report);

  report = NULL;
  REFUSED(flaunay_triangulate_streams(&stream, &sink, NULL, &report), "no period");
  sink.write_corner_offsets = NULL;
  REFUSED(flaunay_triangulate_streams(&stream, &sink, &options, &report), "corner offsets");
  const flaunay_mesh_arrays hull = {.hull = arrays.representatives}, own = {.corner_offsets = offsets};
  REFUSED(flaunay_triangulate_chunks_to_files(&source, &hull, NULL, &options, &report), "hull");
  REFUSED(flaunay_triangulate_chunks_to_files(&source, &own, &files, &options, &report),
          "corner_offsets are wanted");
  const flaunay_space none = on_torus(0, 1);
  options.space = &none;
  REFUSED(flaunay_triangulate_chunks_to_files(&source, NULL, NULL, &options, &report), "period");
  REFUSED(flaunay_triangulate_chunks(points, 4, &own, NULL, &report), "no period");
  REFUSED(flaunay_triangulate_chunks_to_files(&source, NULL, &files, NULL, &report), "no period");
  CHECK(report == NULL);
  free(streamed);
  CHECK(remove(neighbors_path) == 0 && remove(offsets_path) == 0);
  flaunay_triangulation_destroy(cylinder);
}

static void test_chunks_in_files(void) {
  FILE* file = tmpfile();
  stored_mesh mesh = {.triangles = tmpfile(),
                      .neighbors = make_indices(6 * kPoints),
                      .hull = make_indices(kPoints),
                      .representatives = make_indices(kPoints),
                      .areas = make_doubles(2 * kPoints)};
  REQUIRE(file != NULL && mesh.triangles != NULL);
  REQUIRE(fwrite(points, sizeof points, 1, file) == 1);
  const flaunay_point_source source = {.count = kPoints, .read = read_file, .data = file};
  flaunay_mesh_sink sink = {.write = write_part, .data = &mesh, .write_doubles = write_areas};
  flaunay_chunk_report* report = NULL;
  OK(flaunay_triangulate_streams(&source, &sink, &kSmallChunks, &report));
  CHECK(mesh.parts == FLAUNAY_PART_TRIANGLES);  // the default
  flaunay_chunk_report_destroy(report);

  sink.parts = FLAUNAY_PART_TRIANGLES | FLAUNAY_PART_NEIGHBORS | FLAUNAY_PART_HULL |
               FLAUNAY_PART_REPRESENTATIVES | FLAUNAY_PART_AREAS;
  OK(flaunay_triangulate_streams(&source, &sink, &kSmallChunks, &report));
  CHECK(mesh.parts == sink.parts);
  flaunay_triangulation* expected = on_host(points, kPoints, NULL, 0, 0);
  check_chunk_statistics(flaunay_chunk_report_statistics(report), expected);
  const size_t entries = 3 * flaunay_triangulation_mesh(expected)->triangle_count;
  int32_t* triangles = make_indices(entries);
  rewind(mesh.triangles);
  REQUIRE(fread(triangles, sizeof *triangles, entries, mesh.triangles) == entries);
  check_same_mesh(triangles, mesh.neighbors, mesh.hull, mesh.representatives, mesh.areas, expected);
  flaunay_chunk_report_destroy(report);

  // A function of the caller's ends the call.
  const flaunay_status stopped = FLAUNAY_ERROR_STOPPED;
  CHECK(strcmp(flaunay_status_string(stopped), "stopped by the caller") == 0);
  for (unsigned part = FLAUNAY_PART_TRIANGLES; part <= FLAUNAY_PART_AREAS; part *= 2) {
    if (part == FLAUNAY_PART_HALFEDGES) continue;
    mesh.fails_at = part;
    CHECK(fails(flaunay_triangulate_streams(&source, &sink, &kSmallChunks, &report), stopped,
                part == FLAUNAY_PART_AREAS ? "write_doubles returned -3" : "write returned -3"));
    CHECK(report == NULL);
  }
  mesh.fails_at = 0;
  int calls = 0;
  const flaunay_point_source broken = {.count = kPoints, .read = read_nothing, .data = &calls};
  CHECK(fails(flaunay_triangulate_streams(&broken, &sink, NULL, &report), stopped, "read returned 7"));
  CHECK(calls == 1 && report == NULL);
  fclose(file);
  fclose(mesh.triangles);
}

typedef struct {
  const char* stops_at;
  double last;
  int rounds;
} chunk_progress;

static int follow(const char* stage, int round, double done, void* data) {
  chunk_progress* progress = data;
  CHECK(done >= progress->last && done <= 1 && round >= 0);
  progress->last = done;
  if (round >= progress->rounds) progress->rounds = round + 1;
  return strcmp(stage, progress->stops_at) == 0;
}

static void test_progress_of_chunks(void) {
  const flaunay_mesh_arrays nothing = {0};
  chunk_progress progress = {.stops_at = "never"};
  flaunay_chunk_options options = kSmallChunks;
  options.progress = follow;
  options.progress_data = &progress;
  flaunay_chunk_report* report = NULL;
  OK(flaunay_triangulate_chunks(points, kPoints, &nothing, &options, &report));
  CHECK(progress.last == 1);
  CHECK(progress.rounds == (int)flaunay_chunk_report_statistics(report)->round_count);
  flaunay_chunk_report_destroy(report);
  const char* const stages[] = {"sampling", "distributing", "triangulating"};
  for (int k = 0; k < 3; ++k) {
    progress = (chunk_progress){.stops_at = stages[k]};
    CHECK(fails(flaunay_triangulate_chunks(points, kPoints, &nothing, &options, &report),
                FLAUNAY_ERROR_STOPPED, "progress returned 1"));
    CHECK(report == NULL && progress.last < 1);
  }
}

static void test_chunks_of_no_points(void) {
  const flaunay_mesh_arrays nothing = {0};
  const flaunay_point_source none = {0};
  stored_mesh mesh = {0};
  const flaunay_mesh_sink sink = {.write = write_part, .data = &mesh};
  flaunay_chunk_report* report = NULL;
  OK(flaunay_triangulate_chunks(NULL, 0, &nothing, NULL, &report));
  const flaunay_chunk_statistics* statistics = flaunay_chunk_report_statistics(report);
  CHECK(statistics->points == 0 && statistics->triangles == 0 && statistics->hull_vertices == 0);
  CHECK(statistics->rounds == NULL && statistics->round_count == 0 && statistics->devices == NULL);
  flaunay_chunk_report_destroy(report);
  OK(flaunay_triangulate_streams(&none, &sink, NULL, &report));
  CHECK(flaunay_chunk_report_statistics(report)->triangles == 0 && mesh.parts == 0);
  flaunay_chunk_report_destroy(report);
}

static flaunay_status chunks_with(flaunay_chunk_options options) {
  const flaunay_mesh_arrays nothing = {0};
  flaunay_chunk_report* report = NULL;
  const flaunay_status status = flaunay_triangulate_chunks(kSquare, 4, &nothing, &options, &report);
  CHECK((report != NULL) == (status == FLAUNAY_SUCCESS));
  flaunay_chunk_report_destroy(report);
  return status;
}

static void test_bad_chunk_options(void) {
  const char* const names[] = {NULL, "no such device"};
  OK(chunks_with((flaunay_chunk_options){0}));
  // A name that is NULL stands for flaunay's own choice, as when a triangulator is made.
  OK(chunks_with((flaunay_chunk_options){.devices = names, .device_count = 1}));
  CHECK(fails(chunks_with((flaunay_chunk_options){.devices = names, .device_count = 2}), FLAUNAY_ERROR_DEVICE,
              "no such device"));
  REFUSED(chunks_with((flaunay_chunk_options){.device_count = 1}), "1 devices");
  flaunay_triangulator* const own[] = {triangulator, NULL};
  OK(chunks_with((flaunay_chunk_options){.triangulators = own, .triangulator_count = 1}));
  REFUSED(chunks_with((flaunay_chunk_options){.triangulators = own, .triangulator_count = 2}),
          "a triangulator for chunks");
  REFUSED(chunks_with((flaunay_chunk_options){.triangulator_count = 1}), "1 triangulators");
  REFUSED(chunks_with((flaunay_chunk_options){.memory_bytes = 1000}), "too little");
  REFUSED(chunks_with((flaunay_chunk_options){.reserved = {[6] = 1}}), "flaunay_chunk_options");
  WRONG_INPUT(chunks_with((flaunay_chunk_options){.scratch = "/nowhere/at/all"}), "/nowhere/at/all");
}

static void test_bad_chunks(void) {
  const flaunay_mesh_arrays nothing = {0}, of_bytes = {.index_type = 2}, unknown = {.reserved = {1}};
  flaunay_chunk_report* report = NULL;
  REFUSED(flaunay_triangulate_chunks(kSquare, 4, &of_bytes, NULL, &report), "indices 2");
  REFUSED(flaunay_triangulate_chunks(kSquare, 4, &unknown, NULL, &report), "flaunay_mesh_arrays");
  const double bad[] = {0, 0, 1, 0, 1, INFINITY};
  WRONG_INPUT(flaunay_triangulate_chunks(bad, 3, &nothing, NULL, &report), "point 2");
  CHECK(report == NULL);
  // Points are not read before their number is checked.
  const uint64_t counts[] = {(uint64_t)1 << 30, (uint64_t)1 << 63, UINT64_MAX};
  const flaunay_mesh_arrays wide = {.index_type = FLAUNAY_INT64};
  for (int k = 0; k < 3; ++k) {
    WRONG_INPUT(flaunay_triangulate_chunks(kSquare, counts[k], &nothing, NULL, &report), "too many");
    if (k == 0) continue;
    WRONG_INPUT(flaunay_triangulate_chunks(kSquare, counts[k], &wide, NULL, &report), "too many");
  }
}

// From records with fields and by functions, as of all triangles at once.
static void test_raster_in_chunks(void) {
  typedef struct scanned {
    float z, x, y;
  } scanned;
  enum { kRows = 50, kColumns = 40 };
  const double step = 300000;
  scanned* const scan = allocate(kPoints * sizeof *scan);
  double* const values = make_doubles(kPoints);
  double* const pixels = make_doubles(2 * (size_t)kRows * kColumns);
  double* const expected = pixels + (size_t)kRows * kColumns;
  for (size_t i = 0; i < kPoints; ++i) {
    values[i] = (double)(i % 100);
    scan[i] = (scanned){(float)values[i], (float)points[2 * i], (float)points[2 * i + 1]};
  }
  const flaunay_raster raster = {
      .x = step, .y = step, .dx = step, .dy = step, .rows = kRows, .columns = kColumns};
  flaunay_triangulation* mesh = on_host(points, kPoints, NULL, 0, FLAUNAY_PART_NEIGHBORS);
  OK(flaunay_rasterize(triangulator, points, kPoints, flaunay_triangulation_mesh(mesh)->triangles,
                       flaunay_triangulation_mesh(mesh)->neighbors,
                       flaunay_triangulation_mesh(mesh)->triangle_count, values, &raster, expected));
  const double levels[] = {20.5, 70.5};
  flaunay_contours *lines = NULL, *expected_lines = NULL;
  OK(flaunay_contours_compute(triangulator, points, kPoints, flaunay_triangulation_mesh(mesh)->triangles,
                              flaunay_triangulation_mesh(mesh)->neighbors,
                              flaunay_triangulation_mesh(mesh)->triangle_count, values, levels, 2, 0,
                              &expected_lines));

  const flaunay_strided_points of_records = {.coordinates = &scan->x,
                                             .count = kPoints,
                                             .precision = FLAUNAY_FLOAT32,
                                             .point_stride = sizeof *scan,
                                             .coordinate_stride = sizeof scan->x};
  const flaunay_strided_values heights = {
      .values = &scan->z, .precision = FLAUNAY_FLOAT32, .stride = sizeof *scan};
  flaunay_chunk_report* report = NULL;
  OK(flaunay_rasterize_chunks(&of_records, &heights, 0, &raster, pixels, levels, 2, &lines, NULL,
                              &kSmallChunks, &report));
  const size_t line_count = flaunay_contours_line_count(lines);
  REQUIRE(line_count > 0 && line_count == flaunay_contours_line_count(expected_lines));
  const size_t corners = flaunay_contours_offsets(lines)[line_count];
  CHECK(
      same_sizes(flaunay_contours_offsets(lines), flaunay_contours_offsets(expected_lines), line_count + 1));
  CHECK(memcmp(flaunay_contours_coordinates(lines), flaunay_contours_coordinates(expected_lines),
               2 * corners * sizeof(double)) == 0);
  flaunay_contours_destroy(lines);
  flaunay_contours_destroy(expected_lines);
  CHECK(memcmp(pixels, expected, kRows * kColumns * sizeof *pixels) == 0);
  CHECK(flaunay_chunk_report_statistics(report)->points == kPoints);
  CHECK(flaunay_chunk_report_statistics(report)->rounds[0].chunks > 1);
  flaunay_chunk_report_destroy(report);

  FILE* file = tmpfile();
  REQUIRE(file != NULL && fwrite(points, sizeof points, 1, file) == 1);
  const flaunay_point_source source = {.count = kPoints, .read = read_file, .data = file};
  const flaunay_value_source read = {.read = read_values, .data = values};
  memset(pixels, 0, kRows * kColumns * sizeof *pixels);
  OK(flaunay_rasterize_streams(&source, &read, 0, &raster, pixels, NULL, 0, NULL, NULL, &kSmallChunks,
                               &report));
  CHECK(memcmp(pixels, expected, kRows * kColumns * sizeof *pixels) == 0);
  flaunay_chunk_report_destroy(report);

  // A wall through the centres of pixels.
  const double wall[] = {3 * step, 3 * step, 3 * step, 40 * step}, tops[] = {500, 500};
  const int32_t between[] = {0, 1};
  flaunay_breaklines walls = {
      .coordinates = wall, .values = tops, .count = 2, .segments = between, .segment_count = 1};
  OK(flaunay_rasterize_chunks(&of_records, &heights, 0, &raster, pixels, NULL, 0, NULL, &walls, &kSmallChunks,
                              &report));
  for (size_t row = 2; row < 40; ++row) CHECK(pixels[row * kColumns + 2] == 500);
  flaunay_chunk_report_destroy(report);

  const flaunay_value_source broken = {.read = read_no_values}, unread = {.read = NULL};
  const flaunay_strided_values strange = {.values = scan, .reserved = {1}};
  CHECK(fails(
      flaunay_rasterize_streams(&source, &broken, 0, &raster, pixels, NULL, 0, NULL, NULL, NULL, &report),
      FLAUNAY_ERROR_STOPPED, "read of values returned -4"));
  CHECK(report == NULL);
  walls.reserved[0] = 1;
  REFUSED(flaunay_rasterize_streams(&source, &read, 0, &raster, pixels, NULL, 0, NULL, &walls, NULL, &report),
          "flaunay_breaklines");
  REFUSED(flaunay_rasterize_streams(&source, &unread, 0, &raster, pixels, NULL, 0, NULL, NULL, NULL, &report),
          "values");
  REFUSED(
      flaunay_rasterize_chunks(&of_records, &strange, 0, &raster, pixels, NULL, 0, NULL, NULL, NULL, &report),
      "flaunay_strided_values");
  REFUSED(
      flaunay_rasterize_chunks(&of_records, &heights, 3, &raster, pixels, NULL, 0, NULL, NULL, NULL, &report),
      "flaunay_duplicates");
  fclose(file);
}

static void test_bad_streams(void) {
  int calls = 0;
  const flaunay_point_source source = {.count = 1, .read = read_nothing, .data = &calls};
  const flaunay_mesh_sink sink = {.write = write_part};
  flaunay_chunk_report* report = NULL;
  const flaunay_point_source unread = {.count = 1}, unknown = {.reserved = {1}};
  REFUSED(flaunay_triangulate_streams(&unread, &sink, NULL, &report), "reads points");
  REFUSED(flaunay_triangulate_streams(&unknown, &sink, NULL, &report), "flaunay_point_source");
  const flaunay_mesh_sink unwritten = {0}, strange = {.write = write_part, .reserved = {1}},
                          halfedges = {.write = write_part, .parts = FLAUNAY_PART_HALFEDGES},
                          areas = {.write = write_part, .parts = FLAUNAY_PART_AREAS};
  REFUSED(flaunay_triangulate_streams(&source, &unwritten, NULL, &report), "writes results");
  REFUSED(flaunay_triangulate_streams(&source, &strange, NULL, &report), "flaunay_mesh_sink");
  REFUSED(flaunay_triangulate_streams(&source, &halfedges, NULL, &report), "0x4");
  REFUSED(flaunay_triangulate_streams(&source, &areas, NULL, &report), "in doubles");
  const flaunay_point_source many = {.count = UINT64_MAX, .read = read_nothing, .data = &calls};
  WRONG_INPUT(flaunay_triangulate_streams(&many, &sink, NULL, &report), "too many");
  CHECK(calls == 0 && report == NULL);
}

// ---- Without double precision

// ---- Triangulations that change

static flaunay_dynamic* make_dynamic(const double* coordinates, size_t n,
                                     const flaunay_constraints* constraints, const flaunay_options* options) {
  flaunay_dynamic* result = NULL;
  OK(flaunay_dynamic_create(triangulator, coordinates, n, constraints, options, &result));
  return result;
}

static void test_dynamic(void) {
  const flaunay_options options = {.parts = FLAUNAY_PART_HALFEDGES};
  flaunay_dynamic* dynamic = make_dynamic(kSquare, 4, NULL, &options);
  CHECK(flaunay_dynamic_changes(dynamic)->made_count == 0);
  const double inserted[] = {1, 2, 4, 3}, moved[] = {2, 1};
  OK(flaunay_dynamic_insert(dynamic, inserted, 2));
  const flaunay_changes* changes = flaunay_dynamic_changes(dynamic);
  const int32_t representatives[] = {4, 2};
  CHECK(changes->first_point == 4 && changes->representative_count == 2);
  CHECK(same(changes->representatives, representatives, 2) && changes->removed_count >= 2);
  CHECK(changes->made_count >= 4 && changes->seconds >= 0);
  const int32_t fourth = 4, first = 0;
  OK(flaunay_dynamic_move(dynamic, &fourth, moved, 1));
  CHECK(changes->representative_count == 1 && changes->representatives[0] == 4);
  OK(flaunay_dynamic_remove(dynamic, &first, 1));
  CHECK(flaunay_dynamic_numbers(dynamic) == 6 && flaunay_dynamic_point_count(dynamic) == 5);
  CHECK(flaunay_dynamic_has_point(dynamic, 5) == 1 && flaunay_dynamic_has_point(dynamic, 0) == 0);
  CHECK(flaunay_dynamic_has_point(dynamic, 6) == 0);

  double all[12];
  OK(flaunay_dynamic_coordinates(dynamic, all));
  CHECK(isnan(all[0]) && isnan(all[1]) && all[8] == 2 && all[9] == 1 && all[10] == 4);
  // What is left is triangle 1, 2, 3, with point 4 on the edge from 1 to 3, or beside it.
  flaunay_triangulation* mesh = NULL;
  OK(flaunay_dynamic_triangulation(dynamic, &mesh));
  const size_t triangles = flaunay_triangulation_mesh(mesh)->triangle_count;
  CHECK(triangles == 2 && flaunay_dynamic_triangle_count(dynamic) == 2);
  CHECK(flaunay_triangulation_mesh(mesh)->halfedges != NULL &&
        flaunay_triangulation_mesh(mesh)->neighbors == NULL);
  const int32_t expected[] = {-1, 1, 2, 3, 4, 2};
  CHECK(same(flaunay_triangulation_mesh(mesh)->representatives, expected, 6));
  flaunay_triangulation_destroy(mesh);

  const size_t rows = flaunay_dynamic_row_count(dynamic);
  REQUIRE(rows >= 2);
  int32_t* const corners = allocate(6 * rows * sizeof *corners);
  OK(flaunay_dynamic_rows(dynamic, corners, corners + 3 * rows));
  OK(flaunay_dynamic_rows(dynamic, NULL, NULL));
  for (size_t k = 0; k < changes->made_count; ++k) {
    CHECK(same(corners + 3 * changes->made[k], changes->made_corners + 3 * k, 3));
  }
  size_t used = 0, hull = 0;
  for (size_t k = 0; k < rows; ++k) {
    if (corners[3 * k] < 0) continue;
    ++used;
    for (size_t side = 3 * k; side < 3 * k + 3; ++side) hull += corners[3 * rows + side] < 0;
  }
  CHECK(used == 2 && hull == 4);
  CHECK(flaunay_dynamic_constraints(dynamic)->edge_count == 0);
  flaunay_dynamic_destroy(dynamic);
}

static void test_dynamic_constraints(void) {
  const int32_t diagonal[] = {1, 3};
  const flaunay_constraints constraints = {.segments = diagonal, .segment_count = 1};
  flaunay_dynamic* dynamic = make_dynamic(kSquare, 4, &constraints, NULL);
  const double on_it[] = {2, 2}, beside[] = {3, 2};
  OK(flaunay_dynamic_insert(dynamic, on_it, 1));
  const flaunay_living_constraints* edges = flaunay_dynamic_constraints(dynamic);
  REQUIRE(edges != NULL && edges->edge_count == 2);
  CHECK(edges->segments[0] == 0 && edges->segments[1] == 0);
  int32_t sum = 0;
  for (int k = 0; k < 4; ++k) sum += edges->edges[k];
  CHECK(sum == 1 + 3 + 4 + 4);
  const int32_t first = 1;
  WRONG_INPUT(flaunay_dynamic_remove(dynamic, &first, 1), "point 1 cannot be removed");
  WRONG_INPUT(flaunay_dynamic_move(dynamic, &first, beside, 1), "point 1 cannot be moved");
  CHECK(flaunay_dynamic_changes(dynamic)->first_point == 4);
  flaunay_dynamic_destroy(dynamic);
}

static void test_dynamic_from_device(void) {
  flaunay_device_points input = {.memory = make_buffer(context, sizeof points, points), .count = 1000};
  flaunay_dynamic* dynamic = NULL;
  OK(flaunay_dynamic_create_device(triangulator, &input, NULL, &dynamic));
  input.first = 1000;
  OK(flaunay_dynamic_insert_device(dynamic, &input));
  flaunay_triangulation* expected = on_host(points, 2000, NULL, 0, 0);
  flaunay_triangulation* mesh = NULL;
  OK(flaunay_dynamic_triangulation(dynamic, &mesh));
  const size_t count = flaunay_triangulation_mesh(expected)->triangle_count;
  REQUIRE(flaunay_triangulation_mesh(mesh)->triangle_count == count);
  CHECK(row_sum(flaunay_triangulation_mesh(mesh)->triangles, flaunay_triangulation_mesh(mesh)->neighbors,
                count) == row_sum(flaunay_triangulation_mesh(expected)->triangles,
                                  flaunay_triangulation_mesh(expected)->neighbors, count));
  flaunay_triangulation_destroy(mesh);
  flaunay_dynamic_destroy(dynamic);
}

static void test_dynamic_rows_on_device(void) {
  flaunay_dynamic* dynamic = make_dynamic(kSquare, 4, NULL, NULL);
  const int32_t first = 0;
  const double inserted[] = {1, 2};
  OK(flaunay_dynamic_insert(dynamic, inserted, 1));
  OK(flaunay_dynamic_remove(dynamic, &first, 1));
  const size_t count = flaunay_dynamic_row_count(dynamic);
  int32_t* const expected = allocate(12 * count * sizeof *expected);
  OK(flaunay_dynamic_rows(dynamic, expected, expected + 3 * count));

  flaunay_device_triangulation* rows = make_device_triangulation();
  CHECK(flaunay_device_triangulation_buffer(rows, FLAUNAY_PART_TRIANGLES) == NULL);
  cl_mem own = make_buffer(context, 12 * count, NULL), small = make_buffer(context, 1, NULL);
  OK(flaunay_device_triangulation_set_buffer(rows, FLAUNAY_PART_NEIGHBORS, own));
  const flaunay_enqueue plain = {.queue = queue};
  OK(flaunay_dynamic_rows_device(dynamic, &plain, rows));
  CHECK(flaunay_device_triangulation_mesh(rows)->triangle_count == count &&
        flaunay_device_triangulation_mesh(rows)->point_count == 5);
  int32_t* const found = expected + 6 * count;
  read_buffer(flaunay_device_triangulation_buffer(rows, FLAUNAY_PART_TRIANGLES), 12 * count, found);
  read_buffer(own, 12 * count, found + 3 * count);
  CHECK(same(found, expected, 6 * count));
  double places[10];
  read_buffer(flaunay_device_triangulation_buffer(rows, FLAUNAY_PART_COORDINATES), sizeof places, places);
  CHECK(isnan(places[0]) && isnan(places[1]) && memcmp(places + 2, kSquare + 2, 6 * sizeof *places) == 0);
  CHECK(places[8] == 1 && places[9] == 2);

  OK(flaunay_device_triangulation_set_buffer(rows, FLAUNAY_PART_TRIANGLES, small));
  REFUSED(flaunay_dynamic_rows_device(dynamic, &plain, rows), "triangles");
  OK(flaunay_device_triangulation_set_buffer(rows, FLAUNAY_PART_TRIANGLES, own));
  REFUSED(flaunay_dynamic_rows_device(dynamic, &plain, rows), "two things");
  REFUSED(flaunay_device_triangulation_set_buffer(rows, 3, NULL), "not one part");
  flaunay_dynamic_destroy(dynamic);
}

static void test_bad_dynamic(void) {
  flaunay_dynamic* none = NULL;
  const flaunay_options other = {.mode = FLAUNAY_MODE_DWYER};
  REFUSED(flaunay_dynamic_create(triangulator, kSquare, 4, NULL, &other, &none), "mode dwyer");
  const flaunay_constraints inside = {.outside = FLAUNAY_OUTSIDE_HOLES}, later = {.reserved = {1}};
  REFUSED(flaunay_dynamic_create(triangulator, kSquare, 4, &inside, NULL, &none), "left out");
  REFUSED(flaunay_dynamic_create(triangulator, kSquare, 4, &later, NULL, &none), "later version");
  CHECK(none == NULL);

  flaunay_dynamic* dynamic = make_dynamic(kSquare, 4, NULL, NULL);
  const double wrong[] = {0, 1, NAN, 0};
  const int32_t twice[] = {1, 1}, far = 4;
  WRONG_INPUT(flaunay_dynamic_insert(dynamic, wrong, 2), "point 1");
  WRONG_INPUT(flaunay_dynamic_remove(dynamic, twice, 2), "is there twice");
  WRONG_INPUT(flaunay_dynamic_move(dynamic, &far, kSquare, 1), "point 4, which does not exist");
  CHECK(flaunay_dynamic_numbers(dynamic) == 4 && flaunay_dynamic_triangle_count(dynamic) == 2);
  flaunay_dynamic_destroy(dynamic);
}

static void test_no_fp64(void) {
  flaunay_device_list* list = NULL;
  OK(flaunay_device_list_create(1, &list));
  const flaunay_device_info* info = flaunay_device_list_at(list, 0);
  CHECK(info->fp64 == 0 && info->fixed_point == 1);
  CHECK(info->self_test_passed == 1 && info->self_test_failure[0] == '\0');
  flaunay_device_list_destroy(list);
  // Unless there is a GPU or a device is named, the host computes.
  flaunay_triangulator* on_host = NULL;
  OK(flaunay_triangulator_create("", &on_host));
  CHECK(strcmp(flaunay_triangulator_device(on_host)->name, "host") == 0);
  CHECK(flaunay_triangulator_device(on_host)->fixed_point == 0);
  flaunay_triangulator_destroy(on_host);

  cl_platform_id platform = NULL;
  REQUIRE(clGetPlatformIDs(1, &platform, NULL) == CL_SUCCESS);
  REQUIRE(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL) == CL_SUCCESS);
  context = make_context();
  flaunay_triangulator* used = NULL;
  OK(flaunay_triangulator_create_in_context(context, device, &used));
  const char* name = flaunay_triangulator_device(used)->name;
  // The device takes coordinates whose bits span 62 binary places; the host takes more.
  double corners[] = {0, 0, 1, 0, 1, 0x1p61, 0, 1};
  for (int is_wide = 0; is_wide < 2; ++is_wide) {
    if (is_wide) corners[7] = 0.5;
    flaunay_triangulation* mesh = NULL;
    OK(flaunay_triangulate(used, corners, 4, NULL, 1, NULL, &mesh));
    CHECK(flaunay_triangulation_mesh(mesh)->triangle_count == 2);
    const flaunay_statistics* statistics = flaunay_triangulation_mesh(mesh)->statistics;
    CHECK(strcmp(statistics->device, is_wide ? "host" : name) == 0);
    CHECK(is_wide ? strstr(statistics->note, "fp64") != NULL : statistics->note[0] == '\0');
    flaunay_triangulation_destroy(mesh);
  }
  flaunay_options options = {.mode = FLAUNAY_MODE_FLATTENED};
  flaunay_triangulation* by_host = NULL;
  OK(flaunay_triangulate(used, corners, 4, NULL, 1, &options, &by_host));
  const char* note = flaunay_triangulation_mesh(by_host)->statistics->note;
  CHECK(strstr(note, name) != NULL && strstr(note, "flattened") != NULL);
  flaunay_triangulation_destroy(by_host);
  flaunay_triangulator_destroy(used);
  clReleaseContext(context);
}

static void (*const kTests[])(void) = {
    test_errors_are_of_threads,
    test_devices,
    test_added_drivers,
    test_devices_that_are_none,
    test_square,
    test_float,
    test_batches,
    test_modes,
    test_names_of_modes,
    test_mesh_in_one_struct,
    test_kept_triangulations,
    test_bad_kept_triangulations,
    test_tables_of_triangles,
    test_measures_of_triangles,
    test_on_host,
    test_progress_and_profile,
    test_a_triangulator_in_use,
    test_no_points,
    test_device_to_device,
    test_own_buffers,
    test_device_sets,
    test_device_profile,
    test_workspace,
    test_bad_options,
    test_bad_offsets,
    test_too_many_points,
    test_bad_device_points,
    test_bad_result_buffers,
    test_out_of_memory,
    test_voronoi,
    test_constrained,
    test_carried,
    test_refined,
    test_bad_constraints,
    test_polygons,
    test_bad_polygons,
    test_clipped_voronoi,
    test_clipped_voronoi_on_device,
    test_constrained_on_device,
    test_dynamic,
    test_dynamic_constraints,
    test_dynamic_from_device,
    test_dynamic_rows_on_device,
    test_bad_dynamic,
    test_relax,
    test_raster,
    test_sphere,
    test_periodic,
    test_weighted,
    test_locator,
    test_point_tree,
    test_queries_with_constraints,
    test_derived_on_device,
    test_sphere_on_device,
    test_periodic_on_device,
    test_relax_on_device,
    test_chunks_in_arrays,
    test_chunks_to_files,
    test_chunks_with_a_period,
    test_chunks_in_files,
    test_progress_of_chunks,
    test_chunks_of_no_points,
    test_bad_chunk_options,
    test_bad_chunks,
    test_raster_in_chunks,
    test_bad_streams,
};

static void test_all(void) {
  test_statuses();
  set_up();
  for (size_t k = 0; k < sizeof kTests / sizeof *kTests; ++k) {
    kTests[k]();
    release_all();
  }
  tear_down();
}

// The largest buffer, which support/poor_device.c gets as well, and how many points the longest array has
// room for.
enum { kLargestBuffer = 4 << 20, kMostInBuffers = kLargestBuffer / 72 };

static double* random_points(size_t n) {
  double* result = allocate(2 * n * sizeof *result);
  uint64_t state = 1;
  for (size_t k = 0; k < 2 * n; ++k) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    result[k] = (double)(state >> 32);
  }
  return result;
}

static flaunay_triangulation* triangulation_on(const char* name, const double* input, size_t n,
                                               flaunay_triangulator** used) {
  OK(flaunay_triangulator_create(name, used));
  flaunay_triangulation* mesh = NULL;
  OK(flaunay_triangulate(*used, input, n, NULL, 0, NULL, &mesh));
  return mesh;
}

// Clipped cells have more corners than a mesh has edges, and there may be more queries than points.
static int works_or_is_too_large(flaunay_status got) {
  return got == FLAUNAY_SUCCESS || fails(got, FLAUNAY_ERROR_DEVICE, "in one piece");
}

// As many points as fit work in every call; one more is an error that says how many fit.
static void test_small_buffers(void) {
  const size_t n = kMostInBuffers;
  double* const input = random_points(n + 1);
  flaunay_triangulator *small = NULL, *on_host = NULL;
  flaunay_triangulation* mesh = triangulation_on("#0", input, n, &small);
  flaunay_triangulation* expected = triangulation_on("host", input, n, &on_host);
  CHECK(flaunay_triangulator_capacity(small) == n);
  const flaunay_mesh *arrays = flaunay_triangulation_mesh(mesh),
                     *right = flaunay_triangulation_mesh(expected);
  REQUIRE(arrays->triangle_count == right->triangle_count);
  CHECK(same(arrays->triangles, right->triangles, 3 * right->triangle_count));
  CHECK(same(arrays->neighbors, right->neighbors, 3 * right->triangle_count));

  char fits[64];
  snprintf(fits, sizeof fits, "%zu points are too many: %zu would fit", n + 1, n);
  const flaunay_status device_error = FLAUNAY_ERROR_DEVICE;
  flaunay_triangulation* none = NULL;
  CHECK(fails(flaunay_triangulate(small, input, n + 1, NULL, 0, NULL, &none), device_error, fits));
  CHECK(strstr(flaunay_last_error(), "in one piece") != NULL);
  const int32_t segment[] = {0, arrays->triangles[0]};
  const flaunay_constraints constraints = {.segments = segment, .segment_count = 1};
  flaunay_triangulation* constrained = NULL;
  OK(flaunay_triangulate_constrained(small, input, n, NULL, 0, &constraints, NULL, &constrained));
  flaunay_triangulation_destroy(constrained);
  CHECK(fails(flaunay_triangulate_constrained(small, input, n + 1, NULL, 0, &constraints, NULL, &constrained),
              device_error, fits));

  flaunay_voronoi* voronoi = NULL;
  OK(flaunay_voronoi_compute(small, input, n, mesh, &voronoi));
  flaunay_voronoi_destroy(voronoi);
  const double box[] = {0, 0, 0x1p32, 0, 0x1p32, 0x1p32, 0, 0x1p32};
  flaunay_clipped_voronoi* cells = NULL;
  CHECK(works_or_is_too_large(flaunay_voronoi_clip(small, input, NULL, n, mesh, box, 4, &cells)));
  flaunay_clipped_voronoi_destroy(cells);

  // Queries at the points, and many more queries than points.
  flaunay_locator* locator = NULL;
  OK(flaunay_locator_create(small, input, NULL, n, NULL, 0, mesh, &locator));
  int32_t* const found = allocate(n * sizeof *found);
  double* const values = allocate(n * sizeof *values);
  OK(flaunay_locator_nearest(locator, input, n, NULL, 0, found));
  CHECK(same(found, right->representatives, n));
  OK(flaunay_locator_locate(locator, input, n, NULL, 0, found));
  OK(flaunay_locator_interpolate(locator, input, input, n, NULL, 0, NULL, values));
  const size_t many = kLargestBuffer / 16 + 1;
  double* const queries = random_points(many);
  int32_t* const of_many = allocate(many * sizeof *of_many);
  CHECK(works_or_is_too_large(flaunay_locator_locate(locator, queries, many, NULL, 0, of_many)));
  flaunay_locator_destroy(locator);
  flaunay_triangulation_destroy(expected);
  flaunay_triangulation_destroy(mesh);
  flaunay_triangulator_destroy(on_host);
  flaunay_triangulator_destroy(small);
}

static void test_big_endian(void) {
  flaunay_device_list* list = NULL;
  OK(flaunay_device_list_create(1, &list));
  const flaunay_device_info* info = flaunay_device_list_at(list, 0);
  CHECK(info->self_test_passed == 0 && strstr(info->self_test_failure, "big-endian") != NULL);
  flaunay_device_list_destroy(list);
  flaunay_triangulator* none = NULL;
  CHECK(fails(flaunay_triangulator_create("#0", &none), FLAUNAY_ERROR_DEVICE, "big-endian"));
  CHECK(none == NULL);
}

int main(int argc, char** argv) {
  if (argc == 2 && strcmp(argv[1], "no-fp64") == 0) {
    test_no_fp64();
  } else if (argc == 2 && strcmp(argv[1], "small-buffers") == 0) {
    test_small_buffers();
  } else if (argc == 2 && strcmp(argv[1], "big-endian") == 0) {
    test_big_endian();
  } else {
    test_all();
  }
  release_all();
  if (failures > 0) fprintf(stderr, "%d checks failed\n", failures);
  return failures > 0;
}
