/// \file
/// flaunay: exact two-dimensional Delaunay triangulation on any OpenCL device. The interface for C, and for
/// what calls C; flaunay.hpp is the one for C++. C11, C99 and C++.
///
/// Functions that can fail return a flaunay_status; flaunay_last_error says more. A new handle goes to the
/// last argument, which is set to NULL if there is none. Accessors of a handle return NULL or 0 for what is
/// not there, and also if the handle is NULL, which flaunay_last_error tells apart. A NULL where none is
/// allowed is FLAUNAY_ERROR_USAGE. No function ends the process or throws.
///
/// Handles are made by flaunay_..._create or by a computation, and destroyed by their flaunay_..._destroy,
/// which takes NULL too. All arrays, strings and structs that accessors return belong to the handle and stay
/// until it is destroyed or computed anew. A triangulator and the locators it made are used by one thread at
/// a time; results may be read by several. Different triangulators, also of one device and context, may be
/// used at the same time.
///
/// The binary interface stays: enumerators keep their values, and what callers choose of them is given as
/// int. Structs that the caller makes are to be initialised with {0} ({} in C++), which gives every default,
/// and grow into their reserved members, where what is not 0 is an error of a library that does not know it.
/// Structs that flaunay hands out are its own, and grow at their ends.
///
/// Only in C++: partitions for other programs, and counted operations.
#ifndef FLAUNAY_H
#define FLAUNAY_H

#include <stddef.h>
#include <stdint.h>

#include "flaunay/export.h"
#include "flaunay/opencl.h"

#ifdef __cplusplus
extern "C" {
#endif

/// What became of a call; but for the last, the command's exit codes.
typedef enum flaunay_status {
  FLAUNAY_SUCCESS = 0,
  FLAUNAY_ERROR_INTERNAL = 1,  ///< a broken invariant of flaunay itself; please report it
  FLAUNAY_ERROR_USAGE = 2,     ///< a request that makes no sense
  FLAUNAY_ERROR_INPUT = 3,     ///< bad points: not finite, out of range, too many
  FLAUNAY_ERROR_DEVICE = 4,    ///< no device, device too small, an OpenCL call failed
  FLAUNAY_ERROR_MEMORY = 5     ///< the host is out of memory
} flaunay_status;

/// How the divide and conquer is executed. The result is the same set of triangles, whatever the mode.
typedef enum flaunay_mode {
  FLAUNAY_MODE_HYBRID = 0,     ///< on the device, blocks of points solved whole and merged: the fastest
  FLAUNAY_MODE_FLATTENED = 1,  ///< on the device, all regions of a level at once
  FLAUNAY_MODE_RECURSIVE_DEVICE = 2,  ///< by the same kernels, one region at a time, depth first
  FLAUNAY_MODE_RECURSIVE = 3,         ///< plain recursion on the host, one thread
  FLAUNAY_MODE_PARTITION = 4,         ///< some flattened levels on the device, then Dwyer's on host threads
  FLAUNAY_MODE_DWYER = 5              ///< Dwyer's divide and conquer on the host, one thread
} flaunay_mode;

/// Which way each region is cut.
typedef enum flaunay_cut {
  FLAUNAY_CUT_INTERQUARTILE = 0,  ///< across the longer interquartile range of its internal points
  FLAUNAY_CUT_ALTERNATE = 1       ///< x and y in turn
} flaunay_cut;

/// How the dividing paths are computed. The result is the same, whatever the variant.
typedef enum flaunay_hull {
  FLAUNAY_HULL_PRUNE = 0,          ///< prune by candidates from buckets, then quickhull
  FLAUNAY_HULL_QUICKHULL = 1,      ///< quickhull alone
  FLAUNAY_HULL_BALANCED = 2,       ///< a few rounds of quickhull, then balanced splits
  FLAUNAY_HULL_MONOTONE_CHAIN = 3  ///< Andrew's scan; FLAUNAY_MODE_RECURSIVE only
} flaunay_hull;

/// What coordinates in device memory are made of.
typedef enum flaunay_precision { FLAUNAY_FLOAT64 = 0, FLAUNAY_FLOAT32 = 1 } flaunay_precision;

/// Parts of a triangulation, as bits; all int32.
typedef enum flaunay_part {
  /// 3 per triangle, counter-clockwise, smallest index first.
  FLAUNAY_PART_TRIANGLES = 1,
  /// 3 per triangle: the triangle opposite to each vertex, -1 beyond the hull.
  FLAUNAY_PART_NEIGHBORS = 2,
  /// 3 per triangle: halfedge 3t + k goes from vertex k of triangle t to the next one; here is the halfedge
  /// that goes back, in the triangle beyond, or -1 on the hull. The convention of delaunator.
  FLAUNAY_PART_HALFEDGES = 4,
  /// The convex hull with the points on its edges, counter-clockwise from the lexicographically smallest
  /// point. Collinear sets: the distinct points in lexicographic order.
  FLAUNAY_PART_HULL = 8,
  /// One per input point: the smallest index of a point of its set with the same coordinates.
  FLAUNAY_PART_REPRESENTATIVES = 16
} flaunay_part;

/// Parts of a Voronoi diagram in device memory, with their bytes for n points and t triangles.
typedef enum flaunay_voronoi_part {
  FLAUNAY_VORONOI_CIRCUMCENTRES = 1,  ///< double2, 16 t
  FLAUNAY_VORONOI_CELL_OFFSETS = 2,   ///< int32, 4 (n + 1)
  FLAUNAY_VORONOI_CELLS = 4,          ///< int32, 12 t
  FLAUNAY_VORONOI_UNBOUNDED = 8       ///< uchar, n
} flaunay_voronoi_part;

/// A device's programs and memory, and its context and queue or the caller's.
typedef struct flaunay_triangulator flaunay_triangulator;
/// The triangulations of one or more point sets, in host memory.
typedef struct flaunay_triangulation flaunay_triangulation;
/// The same in device memory.
typedef struct flaunay_device_triangulation flaunay_device_triangulation;
/// The dual of a triangulation, in host memory.
typedef struct flaunay_voronoi flaunay_voronoi;
/// The same in device memory.
typedef struct flaunay_device_voronoi flaunay_device_voronoi;
/// Finds where queries lie in a triangulation.
typedef struct flaunay_locator flaunay_locator;
/// What flaunay says of the devices there are.
typedef struct flaunay_device_list flaunay_device_list;

/// What a caller can ask of one triangulation of points in host memory. {0}: the defaults.
typedef struct flaunay_options {
  int mode;  ///< of flaunay_mode
  int cut;   ///< of flaunay_cut
  int hull;  ///< of flaunay_hull
  /// Of flaunay_part. Triangles, hull and representatives are always computed, neighbours and halfedges if
  /// asked for. 0: all but the halfedges.
  unsigned parts;
  int profile;           ///< other than 0: time every kernel by events; costs a little
  int partition_levels;  ///< FLAUNAY_MODE_PARTITION: levels on the device; 0 chooses
  int threads;           ///< FLAUNAY_MODE_PARTITION: host threads; 0 takes one per core
  /// If not NULL, called between levels, on the calling thread, with progress_data: done is the share of the
  /// points' work that is finished, 0 to 1. Must return.
  void (*progress)(const char* stage, int level, double done, void* progress_data);
  void* progress_data;    ///< the caller's, handed on as it is
  uintptr_t reserved[8];  ///< 0
} flaunay_options;

/// Points in device memory, in one or more sets.
typedef struct flaunay_device_points {
  cl_mem memory;  ///< x0 y0 x1 y1 ..., as arrays of double2 or float2 are; NULL for no points
  size_t count;   ///< of points
  int precision;  ///< of flaunay_precision
  size_t first;   ///< points that precede them in the buffer
  /// Set s has points [offsets[s], offsets[s + 1]), counted from `first`; sets + 1, from 0 to count. NULL:
  /// one set, or what device_offsets says.
  const size_t* offsets;
  /// The same in device memory, int32; 4 bytes a set cross to the host.
  cl_mem device_offsets;
  size_t sets;            ///< of offsets or device_offsets
  uintptr_t reserved[4];  ///< 0
} flaunay_device_points;

/// How a call on device memory is enqueued. {0}: on the triangulator's own queue, waiting for nothing.
typedef struct flaunay_enqueue {
  /// Of the triangulator's context and device; in order or not. NULL: the triangulator's own. It is retained
  /// until the triangulator gets another or goes; with one that its owner has released by then, a call works
  /// or is FLAUNAY_ERROR_USAGE, as far as OpenCL lets it be seen.
  cl_command_queue queue;
  const cl_event* wait_for;  ///< what must be done before
  size_t wait_for_count;     ///< how many these are
  /// If not NULL, gets an event that is complete when the results are there, or NULL on failure; the caller
  /// releases it.
  cl_event* event;
  /// Other than 0: time every kernel by events, and wait for the end. The queue must have
  /// CL_QUEUE_PROFILING_ENABLE, if one is given.
  int profile;
  uintptr_t reserved[4];  ///< 0
} flaunay_enqueue;

/// A named part of the work and its wall time.
typedef struct flaunay_phase {
  const char* name;  ///< "blocks", "triangulate", "output" and others, by mode
  double seconds;    ///< wall time on the host, waits included
} flaunay_phase;

/// Where one kernel's time went.
typedef struct flaunay_kernel {
  const char* name;  ///< as in its file in kernels/
  size_t launches;   ///< how often it ran
  double seconds;    ///< on the device, all launches together
} flaunay_kernel;

/// How a result came about.
typedef struct flaunay_statistics {
  const char* device;         ///< its name; "host" in modes of the host
  size_t points;              ///< input points
  size_t duplicates;          ///< input points that are not their own representative
  size_t triangles;           ///< over all sets
  size_t hull_vertices;       ///< over all sets
  double seconds;             ///< from points to results; of points in device memory, until all was enqueued
  double build_seconds;       ///< building programs
  size_t kernel_launches;     ///< enqueued on the device
  size_t host_waits;          ///< times the host waited for the device
  size_t bytes_to_device;     ///< copied by the host; memory that is used in place is not
  size_t bytes_to_host;       ///< likewise
  size_t device_allocations;  ///< OpenCL buffers made, sub-buffers not counted
  size_t device_bytes_peak;   ///< most device memory held at once
  size_t undecided;           ///< predicates that needed exact evaluation
  const flaunay_phase* phases;    ///< in the order of time
  size_t phase_count;             ///< how many these are
  const flaunay_kernel* kernels;  ///< the longest first; none without profile
  size_t kernel_count;            ///< how many these are
} flaunay_statistics;

/// What flaunay says of an OpenCL device.
typedef struct flaunay_device_info {
  const char* name;               ///< as FLAUNAY_DEVICE matches it
  const char* platform;           ///< CL_PLATFORM_NAME
  const char* vendor;             ///< CL_DEVICE_VENDOR
  const char* driver;             ///< CL_DRIVER_VERSION
  const char* version;            ///< CL_DEVICE_VERSION
  const char* type;               ///< "CPU", "GPU", "accelerator"
  unsigned compute_units;         ///< CL_DEVICE_MAX_COMPUTE_UNITS
  unsigned clock_mhz;             ///< CL_DEVICE_MAX_CLOCK_FREQUENCY
  size_t memory_bytes;            ///< CL_DEVICE_GLOBAL_MEM_SIZE
  size_t largest_buffer_bytes;    ///< CL_DEVICE_MAX_MEM_ALLOC_SIZE
  size_t local_memory_bytes;      ///< CL_DEVICE_LOCAL_MEM_SIZE
  size_t work_group_size;         ///< CL_DEVICE_MAX_WORK_GROUP_SIZE
  int fp64;                       ///< 1 if it has double precision, without which it cannot be used
  int self_test_passed;           ///< 1 if the arithmetic self test was run and passed
  const char* self_test_failure;  ///< what failed, or ""
} flaunay_device_info;

// ---- Errors

/// "success", "usage error" and so on; "unknown status" for another number. Static.
FLAUNAY_API const char* flaunay_status_string(int status);
/// The message of the last call of this thread that failed, "" if none did. Stays until the next one fails.
FLAUNAY_API const char* flaunay_last_error(void);
/// What the OpenCL call returned that made it fail, such as -5 for CL_OUT_OF_RESOURCES; 0 if it was none.
FLAUNAY_API int flaunay_last_error_code(void);
/// That OpenCL call, such as "clCreateBuffer"; "" if it was none. Stays as flaunay_last_error.
FLAUNAY_API const char* flaunay_last_error_call(void);
/// "0.1.0". Static.
FLAUNAY_API const char* flaunay_version(void);

// ---- Devices

/// Every device of every platform, in the order that "#k" counts. self_test other than 0: builds and runs the
/// arithmetic self test on each device that has fp64, some seconds each. FLAUNAY_ERROR_DEVICE if there is no
/// OpenCL platform.
FLAUNAY_API flaunay_status flaunay_device_list_create(int self_test, flaunay_device_list** list);
/// Frees it; NULL does nothing, as in all functions of this name.
FLAUNAY_API void flaunay_device_list_destroy(flaunay_device_list* list);
/// The number of devices.
FLAUNAY_API size_t flaunay_device_list_count(const flaunay_device_list* list);
/// The k-th, from 0; NULL beyond the last.
FLAUNAY_API const flaunay_device_info* flaunay_device_list_at(const flaunay_device_list* list, size_t k);

// ---- Triangulators

/// device: NULL or "" (FLAUNAY_DEVICE if set, else the first GPU, else the first device with fp64), "#k" (the
/// k-th of the list, from 0), or a part of a device's or platform's name, whatever its case. Builds programs:
/// keep it for the next call. FLAUNAY_ERROR_DEVICE if there is no such device, if it lacks fp64, or if its
/// arithmetic fails the self test.
FLAUNAY_API flaunay_status flaunay_triangulator_create(const char* device,
                                                       flaunay_triangulator** triangulator);
/// In the caller's context, which is retained. FLAUNAY_ERROR_USAGE if the device is not one of the context,
/// FLAUNAY_ERROR_DEVICE as above.
FLAUNAY_API flaunay_status flaunay_triangulator_create_in_context(cl_context context, cl_device_id device,
                                                                  flaunay_triangulator** triangulator);
/// Waits for what was enqueued. Its locators and results may outlive it.
FLAUNAY_API void flaunay_triangulator_destroy(flaunay_triangulator* triangulator);
/// Its device, which passed the self test.
FLAUNAY_API const flaunay_device_info* flaunay_triangulator_device(const flaunay_triangulator* triangulator);
/// For the caller's own buffers, kernels and queues; owned by the triangulator.
FLAUNAY_API cl_context flaunay_triangulator_context(const flaunay_triangulator* triangulator);
/// The same device for OpenCL; owned by the triangulator.
FLAUNAY_API cl_device_id flaunay_triangulator_device_id(const flaunay_triangulator* triangulator);
/// Its own queue, in order; owned by the triangulator.
FLAUNAY_API cl_command_queue flaunay_triangulator_queue(const flaunay_triangulator* triangulator);
/// The largest number of points that one call can take on this device.
FLAUNAY_API size_t flaunay_triangulator_capacity(const flaunay_triangulator* triangulator);
/// Bytes of device memory that calls in mode hybrid on up to n points in so many sets need besides points and
/// results, at most. FLAUNAY_ERROR_INPUT or FLAUNAY_ERROR_DEVICE for more points than the device takes.
FLAUNAY_API flaunay_status flaunay_triangulator_workspace_bytes(const flaunay_triangulator* triangulator,
                                                                size_t n, size_t sets, size_t* bytes);
/// From now on that memory is the caller's buffer, which is retained; NULL: the triangulator's own again. A
/// call for which it is too small is FLAUNAY_ERROR_USAGE, whose message says how much is needed. Other modes
/// have memory of their own. Waits for what was enqueued.
FLAUNAY_API flaunay_status flaunay_triangulator_use_workspace(flaunay_triangulator* triangulator,
                                                              cl_mem workspace);

// ---- Points and results in host memory

/// Triangulates n points, x0 y0 x1 y1 ...; may be NULL if n is 0. offsets: NULL for one set, whatever `sets`
/// is; else sets + 1 from 0 to n, set s having points [offsets[s], offsets[s + 1]); sets may be empty.
/// options: NULL for the defaults. The caller destroys the result. FLAUNAY_ERROR_INPUT for a coordinate that
/// is not finite, a range of magnitudes beyond what is exact, or too many points; FLAUNAY_ERROR_USAGE for
/// offsets that decrease or do not end with n. O(n log n) work.
FLAUNAY_API flaunay_status flaunay_triangulate(flaunay_triangulator* triangulator, const double* coordinates,
                                               size_t n, const size_t* offsets, size_t sets,
                                               const flaunay_options* options,
                                               flaunay_triangulation** result);
/// The same of float; the result is that of the same numbers as double.
FLAUNAY_API flaunay_status flaunay_triangulate_float(flaunay_triangulator* triangulator,
                                                     const float* coordinates, size_t n,
                                                     const size_t* offsets, size_t sets,
                                                     const flaunay_options* options,
                                                     flaunay_triangulation** result);
/// The same without a device. options->mode must be FLAUNAY_MODE_RECURSIVE or FLAUNAY_MODE_DWYER, anything
/// else is FLAUNAY_ERROR_USAGE.
FLAUNAY_API flaunay_status flaunay_triangulate_on_host(const double* coordinates, size_t n,
                                                       const size_t* offsets, size_t sets,
                                                       const flaunay_options* options,
                                                       flaunay_triangulation** result);
/// Frees the arrays.
FLAUNAY_API void flaunay_triangulation_destroy(flaunay_triangulation* triangulation);

/// n, the number of points over all sets. O(1), as all that follows.
FLAUNAY_API size_t flaunay_triangulation_point_count(const flaunay_triangulation* triangulation);
/// The number of sets, 1 if there were no offsets.
FLAUNAY_API size_t flaunay_triangulation_set_count(const flaunay_triangulation* triangulation);
/// t, the number of triangles over all sets.
FLAUNAY_API size_t flaunay_triangulation_triangle_count(const flaunay_triangulation* triangulation);
/// h, the number of hull vertices over all sets.
FLAUNAY_API size_t flaunay_triangulation_hull_count(const flaunay_triangulation* triangulation);
/// 3 t; as FLAUNAY_PART_TRIANGLES says. All indices are those of the input points, over all sets; triangle
/// indices count over all sets too. NULL if empty, as what follows.
FLAUNAY_API const int32_t* flaunay_triangulation_triangles(const flaunay_triangulation* triangulation);
/// 3 t; as FLAUNAY_PART_NEIGHBORS says. NULL if not asked for.
FLAUNAY_API const int32_t* flaunay_triangulation_neighbors(const flaunay_triangulation* triangulation);
/// 3 t; as FLAUNAY_PART_HALFEDGES says. NULL if not asked for.
FLAUNAY_API const int32_t* flaunay_triangulation_halfedges(const flaunay_triangulation* triangulation);
/// h; as FLAUNAY_PART_HULL says.
FLAUNAY_API const int32_t* flaunay_triangulation_hull(const flaunay_triangulation* triangulation);
/// n; as FLAUNAY_PART_REPRESENTATIVES says.
FLAUNAY_API const int32_t* flaunay_triangulation_representatives(const flaunay_triangulation* triangulation);
/// sets + 1: set s has triangles [offsets[s], offsets[s + 1]).
FLAUNAY_API const size_t* flaunay_triangulation_triangle_offsets(const flaunay_triangulation* triangulation);
/// sets + 1: likewise hull vertices.
FLAUNAY_API const size_t* flaunay_triangulation_hull_offsets(const flaunay_triangulation* triangulation);
/// How it came about.
FLAUNAY_API const flaunay_statistics* flaunay_triangulation_statistics(
    const flaunay_triangulation* triangulation);

// ---- Points and results in device memory

/// Empty, to be computed as often as wanted. Its buffers are flaunay's own, made when they are first needed,
/// kept for the next call, and replaced by larger ones where they are too small.
FLAUNAY_API flaunay_status flaunay_device_triangulation_create(flaunay_device_triangulation** triangulation);
/// Releases its buffers; what is enqueued with them goes on.
FLAUNAY_API void flaunay_device_triangulation_destroy(flaunay_device_triangulation* triangulation);
/// From now on that part, one bit, goes to the caller's buffer, which is retained and never replaced; NULL:
/// to one of flaunay's own again. Bytes for n points: triangles, neighbors, halfedges 24 n each, hull and
/// representatives 4 n each. FLAUNAY_ERROR_USAGE if it is no buffer.
FLAUNAY_API flaunay_status flaunay_device_triangulation_set_buffer(
    flaunay_device_triangulation* triangulation, unsigned part, cl_mem memory);
/// NULL as long as there is none. The handle's: clRetainMemObject makes it stay longer.
FLAUNAY_API cl_mem flaunay_device_triangulation_buffer(const flaunay_device_triangulation* triangulation,
                                                       unsigned part);
/// What the last call computed, bits of flaunay_part; 0 before the first. This and what follows is known when
/// the call returns.
FLAUNAY_API unsigned flaunay_device_triangulation_parts(const flaunay_device_triangulation* triangulation);
/// n, the number of points over all sets.
FLAUNAY_API size_t
flaunay_device_triangulation_point_count(const flaunay_device_triangulation* triangulation);
/// The number of sets.
FLAUNAY_API size_t flaunay_device_triangulation_set_count(const flaunay_device_triangulation* triangulation);
/// t, the number of triangles over all sets, whatever the parts.
FLAUNAY_API size_t
flaunay_device_triangulation_triangle_count(const flaunay_device_triangulation* triangulation);
/// h, the number of hull vertices over all sets, whatever the parts.
FLAUNAY_API size_t flaunay_device_triangulation_hull_count(const flaunay_device_triangulation* triangulation);
/// sets + 1, in host memory: set s has points [offsets[s], offsets[s + 1]).
FLAUNAY_API const size_t* flaunay_device_triangulation_point_offsets(
    const flaunay_device_triangulation* triangulation);
/// sets + 1, in host memory: likewise triangles.
FLAUNAY_API const size_t* flaunay_device_triangulation_triangle_offsets(
    const flaunay_device_triangulation* triangulation);
/// sets + 1, in host memory: likewise hull vertices.
FLAUNAY_API const size_t* flaunay_device_triangulation_hull_offsets(
    const flaunay_device_triangulation* triangulation);
/// How the last call came about.
FLAUNAY_API const flaunay_statistics* flaunay_device_triangulation_statistics(
    const flaunay_device_triangulation* triangulation);

/// Triangulates points in device memory into device memory, in mode hybrid. No points and no results cross to
/// the host: only sizes do, and the host waits 5 or 6 times in between. Returns when all is enqueued; the
/// results are there when the event is complete, or for whatever is enqueued on the same in-order queue
/// later. The points and the results' buffers must not change until then. A second call of the same size
/// allocates no device memory. parts: of flaunay_part, 0 for the triangles alone; neighbours and halfedges
/// need the triangles. enqueue: NULL for the triangulator's own queue. FLAUNAY_ERROR_USAGE for buffers that
/// are too small or of another context, a queue of another context or device, offsets that decrease or do not
/// end with the number of points; FLAUNAY_ERROR_INPUT as for points in host memory. The result is unspecified
/// after an error. O(n log n) work.
FLAUNAY_API flaunay_status flaunay_triangulate_device(flaunay_triangulator* triangulator,
                                                      const flaunay_device_points* points, unsigned parts,
                                                      const flaunay_enqueue* enqueue,
                                                      flaunay_device_triangulation* result);

// ---- Voronoi diagrams

/// The dual of a triangulation with neighbours of these n points. Where more than three points are
/// cocircular, circumcentres coincide. The caller destroys the result. O(n) work; a point of degree d takes
/// one work-item d steps.
FLAUNAY_API flaunay_status flaunay_voronoi_compute(flaunay_triangulator* triangulator,
                                                   const double* coordinates, size_t n,
                                                   const flaunay_triangulation* triangulation,
                                                   flaunay_voronoi** voronoi);
/// Frees the arrays.
FLAUNAY_API void flaunay_voronoi_destroy(flaunay_voronoi* voronoi);
/// n, the number of points.
FLAUNAY_API size_t flaunay_voronoi_point_count(const flaunay_voronoi* voronoi);
/// t, the number of triangles.
FLAUNAY_API size_t flaunay_voronoi_triangle_count(const flaunay_voronoi* voronoi);
/// c, the number of corners of all cells.
FLAUNAY_API size_t flaunay_voronoi_corner_count(const flaunay_voronoi* voronoi);
/// 2 t, rounded: exact predicates decide what is adjacent, not these.
FLAUNAY_API const double* flaunay_voronoi_circumcentres(const flaunay_voronoi* voronoi);
/// n + 1: the cell of point i has corners [offsets[i], offsets[i + 1]) of cells.
FLAUNAY_API const int32_t* flaunay_voronoi_cell_offsets(const flaunay_voronoi* voronoi);
/// c: triangles, whose circumcentres are the cells' corners, counter-clockwise around each point, from the
/// smallest index on. Of an unbounded cell: from the hull edge that leaves the point to the one that arrives
/// at it; a ray perpendicular to these edges goes outwards from the first and from the last corner. None for
/// a point that another represents, and for points on one line.
FLAUNAY_API const int32_t* flaunay_voronoi_cells(const flaunay_voronoi* voronoi);
/// n: 1 for points on the hull, also for all of a set on one line, else 0.
FLAUNAY_API const uint8_t* flaunay_voronoi_unbounded(const flaunay_voronoi* voronoi);

/// Empty, with buffers as a flaunay_device_triangulation has them.
FLAUNAY_API flaunay_status flaunay_device_voronoi_create(flaunay_device_voronoi** voronoi);
/// Releases its buffers; what is enqueued with them goes on.
FLAUNAY_API void flaunay_device_voronoi_destroy(flaunay_device_voronoi* voronoi);
/// As flaunay_device_triangulation_set_buffer; part: of flaunay_voronoi_part.
FLAUNAY_API flaunay_status flaunay_device_voronoi_set_buffer(flaunay_device_voronoi* voronoi, unsigned part,
                                                             cl_mem memory);
/// As flaunay_device_triangulation_buffer.
FLAUNAY_API cl_mem flaunay_device_voronoi_buffer(const flaunay_device_voronoi* voronoi, unsigned part);
/// Needs the parts triangles, neighbors, hull and representatives; enqueued as flaunay_triangulate_device is,
/// with the same errors.
FLAUNAY_API flaunay_status flaunay_voronoi_compute_device(flaunay_triangulator* triangulator,
                                                          const flaunay_device_points* points,
                                                          const flaunay_device_triangulation* triangulation,
                                                          const flaunay_enqueue* enqueue,
                                                          flaunay_device_voronoi* result);

// ---- Queries

/// Of a triangulation with neighbours of these points; offsets and sets as for flaunay_triangulate. Copies
/// what it needs: some 80 bytes of device memory a point. It may outlive the triangulator. O(n log n) work.
FLAUNAY_API flaunay_status flaunay_locator_create(flaunay_triangulator* triangulator,
                                                  const double* coordinates, size_t n, const size_t* offsets,
                                                  size_t sets, const flaunay_triangulation* triangulation,
                                                  flaunay_locator** locator);
/// The same of points and a triangulation in device memory, which needs the parts triangles, neighbors, hull
/// and representatives. Enqueued as flaunay_triangulate_device is, with the same errors.
FLAUNAY_API flaunay_status flaunay_locator_create_device(flaunay_triangulator* triangulator,
                                                         const flaunay_device_points* points,
                                                         const flaunay_device_triangulation* triangulation,
                                                         const flaunay_enqueue* enqueue,
                                                         flaunay_locator** locator);
/// Releases its memory.
FLAUNAY_API void flaunay_locator_destroy(flaunay_locator* locator);

/// For each of m queries, x0 y0 x1 y1 ..., the triangle that it lies in, exactly; on an edge or a vertex the
/// one of the smallest index of those that it lies in; -1 outside of the hull. triangles: the caller's, m. Of
/// nested triangulations the queries come in as many sets, each for its own; offsets: NULL for one set, else
/// sets + 1 from 0 to m. FLAUNAY_ERROR_INPUT for a query that is not finite, or so fine that exactness is
/// beyond doubles. About O(log n) a query.
FLAUNAY_API flaunay_status flaunay_locator_locate(flaunay_locator* locator, const double* queries, size_t m,
                                                  const size_t* offsets, size_t sets, int32_t* triangles);
/// For each query the index of the nearest point, by exact comparisons; of several the first in the order of
/// x, then y. -1 if the set is empty. points: the caller's, m. Else as flaunay_locator_locate.
FLAUNAY_API flaunay_status flaunay_locator_nearest(flaunay_locator* locator, const double* queries, size_t m,
                                                   const size_t* offsets, size_t sets, int32_t* points);
/// For each query the linear interpolation of its triangle's three values, rounded; at a vertex exactly its
/// value; NaN outside of the hull. values: one for each input point, of which those of duplicates'
/// representatives count. results: the caller's, m. Else as flaunay_locator_locate.
FLAUNAY_API flaunay_status flaunay_locator_interpolate(flaunay_locator* locator, const double* values,
                                                       const double* queries, size_t m, const size_t* offsets,
                                                       size_t sets, double* results);

/// flaunay_locator_locate for queries in device memory, enqueued as flaunay_triangulate_device is.
/// *triangles: the caller's buffer, int32, 4 m bytes; or NULL, which gets a new one that the caller releases,
/// unless the call fails or there are no queries.
FLAUNAY_API flaunay_status flaunay_locator_locate_device(flaunay_locator* locator,
                                                         const flaunay_device_points* queries,
                                                         const flaunay_enqueue* enqueue, cl_mem* triangles);
/// flaunay_locator_nearest likewise.
FLAUNAY_API flaunay_status flaunay_locator_nearest_device(flaunay_locator* locator,
                                                          const flaunay_device_points* queries,
                                                          const flaunay_enqueue* enqueue, cl_mem* points);
/// flaunay_locator_interpolate likewise. values: double, 8 n bytes; *results: double, 8 m bytes.
FLAUNAY_API flaunay_status flaunay_locator_interpolate_device(flaunay_locator* locator, cl_mem values,
                                                              const flaunay_device_points* queries,
                                                              const flaunay_enqueue* enqueue,
                                                              cl_mem* results);

#ifdef __cplusplus
}
#endif

#endif  // FLAUNAY_H
