/// \file
/// Exact Delaunay triangulations, meshes and maps, on any CPU at once and on any OpenCL GPU. This is the
/// interface for C and for languages that call C; it compiles as C99, C11 and C++. The interface for C++ is
/// flaunay.hpp.
///
/// Functions that can fail return a flaunay_status; flaunay_last_error has the message. A function that makes
/// a handle writes it to its last argument, or NULL if it fails. An accessor returns NULL or 0 if the handle
/// does not have the value; it also does so if the handle is NULL, but then flaunay_last_error has a message.
/// Passing NULL where it is not allowed is FLAUNAY_ERROR_USAGE, and a count that is larger than any array is
/// FLAUNAY_ERROR_INPUT; both are checked before an array is read. No function ends the process or throws.
///
/// Handles are made by flaunay_..._create or by a computation, and destroyed by their flaunay_..._destroy,
/// which also accepts NULL. The arrays, strings and structs that accessors return belong to the handle; they
/// are valid until the handle is destroyed or computed again. A triangulator and the locators that it made
/// do one call at a time: a call during another one, on another thread or from a progress callback, is
/// FLAUNAY_ERROR_USAGE. Several threads may read a result, and different triangulators may be used at the
/// same time, even if they share a device and a context.
///
/// OpenCL handles that the caller passes (contexts, queues, events, buffers) must be alive when the call is
/// made; the behaviour with a released handle is undefined.
///
/// The binary interface is stable for as long as the name that a program loads the library by, such as
/// libflaunay.so.0.1, which changes with every minor version before 1.0.0 and with every major version from
/// then on. flaunay/version.h has the version for the preprocessor. Enumerators keep their values; struct
/// members that hold one are int. Initialise structs that you pass with {0} ({} in C++), which sets every
/// default. Later versions may use their reserved members; a library that does not know such a member reports
/// an error if it is not 0. Structs that flaunay returns may become longer in later versions.
///
/// Two things are available in C++ only: partitions for other programs, and counted operations.
#ifndef FLAUNAY_H
#define FLAUNAY_H

#include <stddef.h>
#include <stdint.h>

#include "flaunay/export.h"
#include "flaunay/opencl.h"
#include "flaunay/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The result of a call. Those before FLAUNAY_ERROR_MEMORY are also the exit codes of the command.
typedef enum flaunay_status {
  FLAUNAY_SUCCESS = 0,
  FLAUNAY_ERROR_INTERNAL = 1,  ///< a broken invariant of flaunay itself: please report it (CONTRIBUTING.md)
  FLAUNAY_ERROR_USAGE = 2,     ///< the request makes no sense
  FLAUNAY_ERROR_INPUT = 3,     ///< bad points: not finite, out of range, too many
  FLAUNAY_ERROR_DEVICE = 4,    ///< no device, device too small, an OpenCL call failed
  FLAUNAY_ERROR_MEMORY = 5,    ///< the host is out of memory
  FLAUNAY_ERROR_STOPPED = 6    ///< a function that the caller passed ended the call
} flaunay_status;

/// The algorithm that computes the triangulation. All modes give the same set of triangles.
typedef enum flaunay_mode {
  FLAUNAY_MODE_BLOCKS =
      0,  ///< the default: each work-item triangulates a block of points, then blocks are merged
  FLAUNAY_MODE_FLATTENED = 1,         ///< the paper's algorithm on the device, all regions of a level at once
  FLAUNAY_MODE_RECURSIVE_DEVICE = 2,  ///< the kernels of flattened, one region at a time, depth first
  FLAUNAY_MODE_RECURSIVE = 3,         ///< the paper's algorithm as a plain recursion on the host, one thread
  FLAUNAY_MODE_PARTITION = 4,         ///< some levels of flattened, then Dwyer's algorithm on host threads
  FLAUNAY_MODE_DWYER = 5              ///< Dwyer's divide and conquer on the host, one thread
} flaunay_mode;

/// Which way each region is cut.
typedef enum flaunay_cut {
  FLAUNAY_CUT_INTERQUARTILE = 0,  ///< across the longer interquartile range of its internal points
  FLAUNAY_CUT_ALTERNATE = 1       ///< x and y in turn
} flaunay_cut;

/// How the dividing paths are computed. All variants give the same paths.
typedef enum flaunay_hull {
  FLAUNAY_HULL_PRUNE = 0,          ///< discard most points by candidates from buckets, then quickhull
  FLAUNAY_HULL_QUICKHULL = 1,      ///< quickhull alone
  FLAUNAY_HULL_BALANCED = 2,       ///< a few rounds of quickhull, then balanced splits
  FLAUNAY_HULL_MONOTONE_CHAIN = 3  ///< Andrew's scan; FLAUNAY_MODE_RECURSIVE only
} flaunay_hull;

/// Where the levels of FLAUNAY_MODE_FLATTENED end. The triangles are the same, in another order.
typedef enum flaunay_finish {
  FLAUNAY_FINISH_BLOCKS = 0,  ///< when regions are as small as a block, which is then solved on its own
  FLAUNAY_FINISH_LEVELS = 1   ///< when no region has internal points left
} flaunay_finish;

/// The type of coordinates in device memory: double or float.
typedef enum flaunay_precision { FLAUNAY_FLOAT64 = 0, FLAUNAY_FLOAT32 = 1 } flaunay_precision;

/// The type of the indices in arrays that the caller passes: int32_t or int64_t.
typedef enum flaunay_index_type { FLAUNAY_INT32 = 0, FLAUNAY_INT64 = 1 } flaunay_index_type;

/// The arrays of a triangulation, as bits. Areas and places are double, others int32 if nothing else is said;
/// triangulations in chunks have int64, too.
typedef enum flaunay_part {
  /// 3 per triangle, counter-clockwise, on the sphere as seen from outside, smallest index first. n different
  /// points on a torus have 2 n, on a cylinder 2 n - h, if h of them are on its lowest and its highest
  /// circle,
  /// and on the sphere 2 n - 4 for n > 2.
  FLAUNAY_PART_TRIANGLES = 1,
  /// 3 per triangle: the triangle opposite to each vertex, -1 beyond the hull or the end of a cylinder.
  FLAUNAY_PART_NEIGHBORS = 2,
  /// 3 per triangle. Halfedge 3t + k goes from vertex k of triangle t to its next vertex. Entry 3t + k is the
  /// opposite halfedge, in the adjacent triangle, or -1 on the hull. This is the convention of delaunator.
  FLAUNAY_PART_HALFEDGES = 4,
  /// The convex hull with the points on its edges, counter-clockwise from the lexicographically smallest
  /// point. Collinear sets: the distinct points in lexicographic order. In the plane alone.
  FLAUNAY_PART_HULL = 8,
  /// One per input point: the smallest index of a point of its set with the same coordinates, or the same
  /// place, and the same weight.
  FLAUNAY_PART_REPRESENTATIVES = 16,
  /// One per triangle: its area, rounded to the nearest double, ties to even, whatever the coordinates: 0 up
  /// to 2^-1075, infinite from about 2^1024. Otherwise it is positive, since triangles are counter-clockwise.
  FLAUNAY_PART_AREAS = 32,
  /// x and y per point on a torus, a cylinder and the sphere, always computed there. A point's place is
  /// rounded once, and is then what the point is. On a torus it is the point in [0, period), a multiple of
  /// the period's last bit but one; what has no period is not rounded. On the sphere it is where the line
  /// from the south pole through the point meets the plane of the equator; infinite for the south pole.
  FLAUNAY_PART_PLACES = 64,
  /// int8, 6 per triangle on a torus and a cylinder, always computed there: i and j per corner. If the first
  /// corner is in its place, the corner is i (x, 0) + j (shear, y) away from its place. The first corner has
  /// 0, 0; the others -1, 0 or 1. With a shear they are from -2 to 2 if x is at most y, and otherwise |j| < 2
  /// + x / y and |i| < 2 + |j| / 2.
  FLAUNAY_PART_CORNER_OFFSETS = 128,
  /// Of points with weights those without a power cell, in ascending order, but those that another point
  /// represents. Always computed with weights.
  FLAUNAY_PART_HIDDEN = 256,
  /// As in flaunay_constrained_arrays, and so are the following two; flaunay_triangulate_constrained_device
  /// always computes them: uchar, 3 per triangle.
  FLAUNAY_PART_CONSTRAINED = 512,
  FLAUNAY_PART_PIECE_EDGES = 1024,       ///< 2 per segment
  FLAUNAY_PART_CONSTRAINT_EDGES = 2048,  ///< 2 per constraint edge
  FLAUNAY_PART_COORDINATES = 4096        ///< x and y per point, of flaunay_dynamic_rows_device
} flaunay_part;

/// The kinds of spaces that points lie in.
typedef enum flaunay_space_kind {
  FLAUNAY_SPACE_PLANE = 0,  ///< the Euclidean plane
  FLAUNAY_SPACE_TORUS = 1,  ///< a plane that repeats itself in x and y, or in one of them: a cylinder
  FLAUNAY_SPACE_SPHERE = 2  ///< the unit sphere
} flaunay_space_kind;

/// How points of the unit sphere are given.
typedef enum flaunay_sphere_coordinates {
  FLAUNAY_SPHERE_DIRECTIONS = 0,  ///< x y z: any finite vector but 0; its length does not count
  FLAUNAY_SPHERE_DEGREES = 1      ///< longitude to the east, any number, and latitude, -90 to 90
} flaunay_sphere_coordinates;

/// The space that points lie in, and their weights. {0}: the plane, without weights.
typedef struct flaunay_space {
  int kind;         ///< a flaunay_space_kind
  int coordinates;  ///< on the sphere, a flaunay_sphere_coordinates
  /// On a torus, where the plane begins again in x: from 2^-900 to 2^900 (about 1.2e-271 to 8.4e270), and at
  /// most 2^30 times the other period. If one is INFINITY, it is a cylinder.
  double period_x;
  double period_y;  ///< see period_x
  /// On a torus, how far the period in y moves places along x: any finite number, which is reduced by
  /// multiples of period_x. On a cylinder it must be 0. If it is not a multiple of period_x, then period_x
  /// may be at most 64 times period_y.
  double shear;
  /// Except on the sphere, one per point: squared lengths of any sign; of circles, the squared radii. NULL:
  /// none.
  const double* weights;
  uintptr_t reserved[4];  ///< 0
} flaunay_space;

/// The arrays of a Voronoi diagram in device memory, as bits, with their types and their sizes in bytes for n
/// points and t triangles.
typedef enum flaunay_voronoi_part {
  FLAUNAY_VORONOI_CIRCUMCENTRES = 1,  ///< double2, 16 t
  FLAUNAY_VORONOI_CELL_OFFSETS = 2,   ///< int32, 4 (n + 1)
  FLAUNAY_VORONOI_CELLS = 4,          ///< int32, 12 t
  FLAUNAY_VORONOI_UNBOUNDED = 8       ///< uchar, n
} flaunay_voronoi_part;

/// The arrays of clipped Voronoi cells in device memory, as bits, with their types and their sizes in bytes
/// for n points and v vertices.
typedef enum flaunay_clipped_voronoi_part {
  FLAUNAY_CLIPPED_VORONOI_VERTICES = 1,  ///< double2, 16 v
  FLAUNAY_CLIPPED_VORONOI_OFFSETS = 2,   ///< int32, 4 (n + 1)
  FLAUNAY_CLIPPED_VORONOI_AREAS = 4,     ///< double, 8 n
  FLAUNAY_CLIPPED_VORONOI_CENTROIDS = 8  ///< double2, 16 n
} flaunay_clipped_voronoi_part;

/// What becomes of two segments that cross where no point is.
typedef enum flaunay_crossings {
  FLAUNAY_CROSSINGS_ERROR = 0,  ///< FLAUNAY_ERROR_INPUT, whose message names both segments and the place
  FLAUNAY_CROSSINGS_SPLIT = 1   ///< both are split there; the place is rounded and becomes a point of its own
} flaunay_crossings;

/// Which triangles a constrained triangulation has.
typedef enum flaunay_outside {
  FLAUNAY_OUTSIDE_KEEP = 0,  ///< all, up to the convex hull
  FLAUNAY_OUTSIDE_HULL = 1,  ///< without those outside: of depth 0
  FLAUNAY_OUTSIDE_HOLES = 2  ///< without those outside and those in holes
} flaunay_outside;

/// How it is decided what is outside and what is a hole. A path from beyond the hull to a triangle, through
/// no point, crosses segments. Where segments lie on each other, each counts.
typedef enum flaunay_fill_rule {
  /// The depth of a triangle is the least number of constraint edges that such a path crosses. Holes have an
  /// even depth. This is defined for any segments; those that end without closing a curve do not count.
  FLAUNAY_FILL_RULE_NESTING = 0,
  /// The depth is 1 if the path crosses an odd number of segments, otherwise 0. Segments must form closed
  /// curves: an even number ends at each point.
  FLAUNAY_FILL_RULE_EVEN_ODD = 1,
  /// The depth is the winding number of the directed segments: those that the path crosses from their right
  /// to their left, less those from left to right. Only a depth of 0 is outside, and there are no other
  /// holes. Segments must form closed curves: as many begin as end at each point.
  FLAUNAY_FILL_RULE_WINDING = 2
} flaunay_fill_rule;

/// What becomes of places that are in several polygons of a map.
typedef enum flaunay_overlaps {
  FLAUNAY_OVERLAPS_FIRST = 0,  ///< they belong to the polygon with the smallest index
  FLAUNAY_OVERLAPS_ERROR = 1  ///< FLAUNAY_ERROR_INPUT, whose message names a triangle and two of its polygons
} flaunay_overlaps;

/// How values are computed between points.
typedef enum flaunay_interpolation {
  FLAUNAY_INTERPOLATION_LINEAR = 0,   ///< linearly in each triangle; continuous
  FLAUNAY_INTERPOLATION_NEAREST = 1,  ///< the values of the nearest point
  /// By cubics, with a continuous gradient: the reduced element of Hsieh, Clough and Tocher, as SciPy's
  /// CloughTocher2DInterpolator; on the sphere Renka's interpolant.
  FLAUNAY_INTERPOLATION_CLOUGH_TOCHER = 2,
  /// By Sibson's natural-neighbour weights: the areas that a query's Voronoi cell would take from the cells
  /// of the points around it. Smooth except at the points. Exact for linear functions, up to rounding.
  FLAUNAY_INTERPOLATION_SIBSON = 3,
  /// By Laplace's natural-neighbour weights: the lengths of that cell's edges over the distances of the
  /// points. Continuous, and exact for linear functions, up to rounding.
  FLAUNAY_INTERPOLATION_LAPLACE = 4
} flaunay_interpolation;

/// Which value a place has where several points are equal. The mean is that of doubles, summed in ascending
/// order.
typedef enum flaunay_duplicates {
  FLAUNAY_DUPLICATES_HIGHEST = 0,
  FLAUNAY_DUPLICATES_LOWEST = 1,
  FLAUNAY_DUPLICATES_MEAN = 2
} flaunay_duplicates;

/// Owns the programs and memory of a device. The context is the triangulator's own or the caller's.
typedef struct flaunay_triangulator flaunay_triangulator;
/// The triangulations of one or more point sets, in host memory.
typedef struct flaunay_triangulation flaunay_triangulation;
/// Which constraints may be split by points that are added.
typedef enum flaunay_kept_edges {
  FLAUNAY_KEPT_EDGES_NONE = 0,    ///< all may be split
  FLAUNAY_KEPT_EDGES_BORDER = 1,  ///< those with triangles on one side only are kept as they are
  FLAUNAY_KEPT_EDGES_ALL = 2      ///< all are kept as they are
} flaunay_kept_edges;

/// Why a triangle is worse than it should be; docs/refinement.md says more.
typedef enum flaunay_excuse {
  FLAUNAY_EXCUSE_INPUT_ANGLE = 1,  ///< its smallest angle is one between two segments
  FLAUNAY_EXCUSE_NEAR_APEX = 2,    ///< its shortest edge joins two segments near where they meet
  FLAUNAY_EXCUSE_MIN_EDGE = 3,     ///< what would mend it is nearer to a point than min_edge
  FLAUNAY_EXCUSE_KEPT = 4,         ///< a constraint is in the way that must not be split
  FLAUNAY_EXCUSE_FROZEN = 5,       ///< a constraint is in the way that rounding does not allow to split
  FLAUNAY_EXCUSE_MOST_POINTS = 6,  ///< most_points were added
  FLAUNAY_EXCUSE_MOST_ROUNDS = 7   ///< most_rounds were made
} flaunay_excuse;

/// A triangulation to which batches of points are inserted, removed and moved.
typedef struct flaunay_dynamic flaunay_dynamic;
/// The triangulations of one or more point sets, in device memory.
typedef struct flaunay_device_triangulation flaunay_device_triangulation;
/// The dual of a triangulation, in host memory.
typedef struct flaunay_voronoi flaunay_voronoi;
/// The dual of a triangulation, in device memory.
typedef struct flaunay_device_voronoi flaunay_device_voronoi;
/// The cells of the dual, clipped to a convex polygon, in host memory.
typedef struct flaunay_clipped_voronoi flaunay_clipped_voronoi;
/// The cells of the dual, clipped to a convex polygon, in device memory.
typedef struct flaunay_device_clipped_voronoi flaunay_device_clipped_voronoi;
/// Answers queries on a triangulation: containing triangle, nearest point, interpolated value.
typedef struct flaunay_locator flaunay_locator;
/// The OpenCL devices of the machine.
typedef struct flaunay_device_list flaunay_device_list;
/// The statistics of a triangulation in chunks.
typedef struct flaunay_chunk_report flaunay_chunk_report;

/// The facts about a mode that programs need to offer a choice of modes.
typedef struct flaunay_mode_info {
  int mode;                 ///< a flaunay_mode
  const char* name;         ///< "blocks", "recursive-device" and so on, as on the command line
  const char* description;  ///< one line for users
  int on_host;              ///< 1 if it needs no device and works with flaunay_triangulate_on_host
} flaunay_mode_info;

/// Options for triangulating points in host memory. {0} sets the defaults.
typedef struct flaunay_options {
  int mode;  ///< a flaunay_mode
  int cut;   ///< a flaunay_cut
  int hull;  ///< a flaunay_hull
  /// Bits of flaunay_part. Triangles, hull and representatives are always computed; neighbours, halfedges and
  /// areas are computed if their bits are set. 0: everything but the halfedges and the areas.
  unsigned parts;
  int profile;           ///< other than 0: measure the time of every kernel; this costs a little time
  int partition_levels;  ///< FLAUNAY_MODE_PARTITION: number of levels on the device; 0: chosen by size
  int threads;           ///< FLAUNAY_MODE_PARTITION: number of host threads; 0: one per core
  int finish;            ///< a flaunay_finish, for FLAUNAY_MODE_FLATTENED
  /// If not NULL, called from time to time on the calling thread. stage: the name of the stage that begins;
  /// level: the level of the recursion, or -1 if there is none; done: the finished share of the work, 0 to 1.
  /// It must return normally.
  void (*progress)(const char* stage, int level, double done, void* progress_data);
  void* progress_data;         ///< passed to progress unchanged
  const flaunay_space* space;  ///< where points of flaunay_triangulate lie; NULL: in the plane
  uintptr_t reserved[7];       ///< 0
} flaunay_options;

/// Points in device memory, in one or more sets.
typedef struct flaunay_device_points {
  cl_mem memory;  ///< x0 y0 x1 y1 ..., an array of double2 or float2; NULL for no points
  size_t count;   ///< number of points
  int precision;  ///< a flaunay_precision
  size_t first;   ///< number of points in the buffer before the first one to use
  /// Set s has points [offsets[s], offsets[s + 1]), counted from `first`. There are sets + 1 offsets, from 0
  /// to count. NULL: there is one set, unless device_offsets is given.
  const size_t* offsets;
  /// The offsets in device memory, int32. They are copied to the host, 4 bytes per set.
  cl_mem device_offsets;
  size_t sets;  ///< number of sets in offsets or device_offsets
  /// Where points of flaunay_triangulate_device lie; NULL: in the plane. On the sphere, the buffer has per
  /// point the numbers of the coordinates: x y z, or longitude and latitude.
  const flaunay_space* space;
  cl_mem weights;  ///< NULL, or except on the sphere one double per point to use; those of space are NULL
  uintptr_t reserved[2];  ///< 0
} flaunay_device_points;

/// How a call on device memory is enqueued. {0}: on the triangulator's own queue, without waiting for events.
typedef struct flaunay_enqueue {
  /// A queue of the triangulator's context and device, in order or not. NULL: the triangulator's own queue.
  /// The triangulator retains it until a call uses another queue, so its owner may release it after the call.
  cl_command_queue queue;
  const cl_event* wait_for;  ///< events that must complete before the work begins
  size_t wait_for_count;     ///< number of events in wait_for
  /// If not NULL, receives an event that completes when the results are written, or NULL on failure. The
  /// caller releases the event.
  cl_event* event;
  /// Other than 0: measure the time of every kernel with events, and wait until all work is done. A queue
  /// given above must have CL_QUEUE_PROFILING_ENABLE.
  int profile;
  uintptr_t reserved[4];  ///< 0
} flaunay_enqueue;

/// How values are interpolated. {0} sets the defaults.
typedef struct flaunay_interpolation_options {
  int method;      ///< a flaunay_interpolation
  size_t columns;  ///< numbers per point: values are rows of so many, and so are results; 0: one
  int has_fill;    ///< other than 0: the result outside of the hull is `fill`; 0: it is NaN
  double fill;     ///< the nearest point has none, except in a set without points
  /// For FLAUNAY_INTERPOLATION_CLOUGH_TOCHER: x and y per number of the values, on the sphere x, y and z,
  /// such as those of flaunay_locator_gradients. NULL: they are estimated in each call.
  const double* gradients;
  cl_mem device_gradients;  ///< the gradients for values in device memory
  /// The error of estimated gradients, relative to all gradients together; 0: 1e-6.
  double gradient_tolerance;
  size_t gradient_iterations;  ///< no more than these are made; 0: 400
  uintptr_t reserved[8];       ///< 0
} flaunay_interpolation_options;

/// Options for triangulating points in chunks. {0} sets the defaults.
typedef struct flaunay_chunk_options {
  /// Bytes that the call may use on the host, devices that share its memory included, but not what the system
  /// keeps of files. 0: half of what is free.
  uint64_t memory_bytes;
  /// The folder for the points of chunks, 24 bytes per point, in a file without a name. NULL or "": TMPDIR,
  /// or /tmp.
  const char* scratch;
  /// The devices, each named as for flaunay_triangulator_create; "all": every usable device. They take chunks
  /// from one queue.
  const char* const* devices;
  size_t device_count;  ///< number of names in devices; 0: flaunay's own choice of one device
  /// Instead of devices: triangulators of the caller's, such as those of sub-devices. They take chunks from
  /// one queue and must not be used meanwhile.
  flaunay_triangulator* const* triangulators;
  size_t triangulator_count;  ///< number of triangulators; 0: the devices above
  size_t chunk_points;        ///< points of a chunk; 0: as many as suit the devices
  /// If not NULL, called from time to time on the calling thread. stage: "sampling", "distributing",
  /// "triangulating", and on a torus "images"; round: the round of chunks, from 0; done: the finished
  /// share of the call, 0 to 1. If it returns anything but 0, the call ends with FLAUNAY_ERROR_STOPPED.
  int (*progress)(const char* stage, int round, double done, void* progress_data);
  void* progress_data;         ///< passed to progress unchanged
  const flaunay_space* space;  ///< a plane, a torus or a cylinder, without weights; NULL: the plane
  uintptr_t reserved[7];       ///< 0
} flaunay_chunk_options;

/// Arrays of the caller's for the results of n points, such as memory-mapped files. There are at most 2 n
/// triangles and n hull vertices. What is beyond the results is not written. {0}: no array is wanted.
typedef struct flaunay_mesh_arrays {
  int index_type;          ///< a flaunay_index_type, of all arrays of indices
  void* triangles;         ///< room for 6 n indices; NULL: not wanted
  void* neighbors;         ///< room for 6 n indices; NULL: not wanted
  void* hull;              ///< room for n indices; NULL: not wanted
  void* representatives;   ///< room for n indices; NULL: not wanted
  double* areas;           ///< room for 2 n numbers; NULL: not wanted
  int8_t* corner_offsets;  ///< on a torus or a cylinder: room for 12 n numbers; NULL: not wanted
  uintptr_t reserved[2];   ///< 0
} flaunay_mesh_arrays;

/// Points in memory, such as a part of a larger table. {0}: no points.
typedef struct flaunay_strided_points {
  const void* coordinates;  ///< x of the first point; it need not be aligned
  uint64_t count;           ///< number of points
  int precision;            ///< a flaunay_precision: coordinates are double or float
  ptrdiff_t point_stride;   ///< bytes from one point to the next; may be 0 or negative, as the next one, too
  ptrdiff_t coordinate_stride;  ///< bytes from x to y
  uintptr_t reserved[4];        ///< 0
} flaunay_strided_points;

/// Files for the results, .npy arrays of the types that flaunay_mesh_arrays has. The paths are those of
/// regular files and end in ".npy"; NULL: no file is wanted.
typedef struct flaunay_mesh_files {
  const char* triangles;        ///< the path for an array of three columns
  const char* neighbors;        ///< the path for an array of three columns
  const char* hull;             ///< the path for an array of one dimension
  const char* representatives;  ///< the path for an array of one dimension
  const char* areas;            ///< the path for an array of one dimension
  const char* corner_offsets;   ///< on a torus or a cylinder: the path for six columns of int8
  uintptr_t reserved[2];        ///< 0
} flaunay_mesh_files;

/// Points that a function of the caller's reads in pieces. {0}: no points.
typedef struct flaunay_point_source {
  uint64_t count;  ///< number of points
  /// Reads the points [first, first + count): 2 count coordinates, x0 y0 x1 y1 ... Returns 0; if it returns
  /// anything else, the call ends with FLAUNAY_ERROR_STOPPED. Every point is read twice, and some more often;
  /// they must be the same each time. It may be called on any thread, once at a time. NULL: no points.
  int (*read)(uint64_t first, size_t count, double* coordinates, void* data);
  void* data;             ///< passed to read unchanged
  uintptr_t reserved[4];  ///< 0
} flaunay_point_source;

/// Values in memory, one for each of some points.
typedef struct flaunay_strided_values {
  const void* values;     ///< the first one; it need not be aligned
  int precision;          ///< a flaunay_precision: values are double or float
  ptrdiff_t stride;       ///< bytes from one value to the next; may be 0 or negative
  uintptr_t reserved[4];  ///< 0
} flaunay_strided_values;

/// Values that a function of the caller's reads in pieces, one for each of some points.
typedef struct flaunay_value_source {
  /// Reads the values of the points [first, first + count), as flaunay_point_source reads these.
  int (*read)(uint64_t first, size_t count, double* values, void* data);
  void* data;             ///< passed to read unchanged
  uintptr_t reserved[4];  ///< 0
} flaunay_value_source;

/// Lines with values at their points. {0}: none.
typedef struct flaunay_breaklines {
  const double* coordinates;  ///< x0 y0 x1 y1 ...
  const double* values;       ///< one per point: that of its place, whatever other points have there
  size_t count;               ///< number of points; in messages, they are numbered before the others
  const int32_t* segments;    ///< 2 indices of these points per segment
  size_t segment_count;       ///< number of segments
  uintptr_t reserved[4];      ///< 0
} flaunay_breaklines;

/// Where a function of the caller's writes a triangulation in pieces.
typedef struct flaunay_mesh_sink {
  /// Bits of flaunay_part, without FLAUNAY_PART_HALFEDGES, FLAUNAY_PART_PLACES and FLAUNAY_PART_HIDDEN. Other
  /// arrays are not computed. 0: the triangles alone.
  unsigned parts;
  /// Stores `count` values as the entries [first, first + count) of one part, where a triangle has three
  /// entries. Returns 0; if it returns anything else, the call ends with FLAUNAY_ERROR_STOPPED. Entries may
  /// be written in any order. Some neighbours are written twice, and the later value counts. It may be called
  /// on any thread, once at a time.
  int (*write)(unsigned part, uint64_t first, const int64_t* values, size_t count, void* data);
  void* data;  ///< passed to all functions unchanged
  /// As write, for FLAUNAY_PART_AREAS. NULL: it is not wanted.
  int (*write_doubles)(unsigned part, uint64_t first, const double* values, size_t count, void* data);
  /// As write, for FLAUNAY_PART_CORNER_OFFSETS, where a triangle has six entries. NULL: it is not wanted.
  int (*write_corner_offsets)(uint64_t first, const int8_t* values, size_t count, void* data);
  uintptr_t reserved[2];  ///< 0
} flaunay_mesh_sink;

/// A phase of a call and its wall time.
typedef struct flaunay_phase {
  const char* name;  ///< "blocks", "triangulate", "output" and others, by mode
  double seconds;    ///< wall time on the host, waits included
} flaunay_phase;

/// The launches of one kernel and their time.
typedef struct flaunay_kernel {
  const char* name;  ///< the kernel's name in its file in kernels/
  size_t launches;   ///< number of launches
  double seconds;    ///< time on the device, sum over all launches
} flaunay_kernel;

/// The work of a call and its time.
typedef struct flaunay_statistics {
  const char* device;         ///< name of the device; "host" in the modes that run on the host
  size_t points;              ///< input points
  size_t duplicates;          ///< input points that are not their own representative
  size_t triangles;           ///< number of triangles over all sets
  size_t hull_vertices;       ///< number of hull vertices over all sets
  double seconds;             ///< from points to results; for device memory, until everything was enqueued
  double build_seconds;       ///< compiling kernels; part of no other time
  size_t kernel_launches;     ///< kernels enqueued on the device
  size_t host_waits;          ///< times the host waited for the device
  size_t bytes_to_device;     ///< copied to the device; memory that is used in place does not count
  size_t bytes_to_host;       ///< copied to the host; memory that is used in place does not count
  size_t device_allocations;  ///< OpenCL buffers created, without sub-buffers
  size_t device_bytes_peak;   ///< most device memory held at the same time
  size_t undecided;           ///< predicates that needed exact evaluation
  size_t rounds;              ///< rounds of blocks; 0 if blocks were merged up the trees of cuts instead
  size_t round_points;        ///< points of all rounds together
  size_t merged_points;       ///< points of a last round whose blocks were merged, because too many were left
  const flaunay_phase* phases;    ///< in the order in which they ran
  size_t phase_count;             ///< number of phases
  const flaunay_kernel* kernels;  ///< the slowest first; none without profile
  size_t kernel_count;            ///< number of kernels
  /// For people: what a device without double precision has left to the host, and why; and once per process,
  /// why the folder of compiled kernels is not used. "" otherwise.
  const char* note;
} flaunay_statistics;

/// A triangulation's sizes, arrays and statistics; flaunay_part says what the arrays have. Points and
/// triangles are numbered over all sets.
typedef struct flaunay_mesh {
  size_t point_count;                    ///< n, the number of points over all sets
  size_t set_count;                      ///< the number of sets
  size_t triangle_count;                 ///< t, the number of triangles over all sets
  size_t hull_count;                     ///< h, the number of hull vertices over all sets
  const int32_t* triangles;              ///< 3 t values; this and the following arrays: NULL if empty
  const int32_t* neighbors;              ///< 3 t values; NULL if not asked for
  const int32_t* halfedges;              ///< 3 t values; NULL if not asked for
  const int32_t* hull;                   ///< h values
  const int32_t* representatives;        ///< n values
  const size_t* triangle_offsets;        ///< sets + 1 values
  const size_t* hull_offsets;            ///< sets + 1 values
  const flaunay_statistics* statistics;  ///< what the call did and how long it took
  const double* areas;                   ///< t values; NULL if not asked for
  /// Where the points lie, without their weights; NULL: in the plane. The period is as given, but for the
  /// last bit of a double, which is 0 unless the period is a power of two, and with the shear in (-x / 2, x /
  /// 2].
  const flaunay_space* space;
  const double* places;          ///< 2 n values on a torus, a cylinder and the sphere; NULL in the plane
  const int8_t* corner_offsets;  ///< 6 t values on a torus and a cylinder
  size_t hidden_count;           ///< the number of hidden points
  const int32_t* hidden;         ///< hidden_count values
  const size_t* point_offsets;   ///< sets + 1 values; NULL in the plane, but for results in device memory
  /// On a torus and a cylinder, images that were triangulated besides the points, because empty circles reach
  /// across the border.
  size_t image_count;
  int is_weighted;  ///< 1 if the points have weights, so that triangles are regular, which need not be
                    ///< Delaunay
} flaunay_mesh;

/// The triangles of a mesh that is refined further. All points are triangulated anew, with the border of
/// these triangles, and edges between two of different attributes, as further segments, which come after
/// those of flaunay_constraints in the order of triangles. What no triangle covers is left out.
typedef struct flaunay_given_triangles {
  const int32_t* triangles;  ///< 3 points of the same set per triangle, in any direction
  size_t count;              ///< number of triangles
  /// NULL, or one per triangle: the area that triangles of the result with their centroid in it may have, 0
  /// for any.
  const double* areas;
  /// NULL, or one per triangle: become triangle_attributes, in the place of those of seeds.
  const double* attributes;
  uintptr_t reserved[4];  ///< 0
} flaunay_given_triangles;

/// The goals of a refinement. {0}: nothing is added, but the report has angles.
typedef struct flaunay_refinement {
  double min_angle;  ///< in degrees, from 0 to 34: no angle of a triangle is smaller; 0 for any
  double max_area;   ///< no triangle is larger; 0 for any
  /// NULL, or one per seed of flaunay_constraints: the largest area of a triangle in its region, 0 for any.
  const double* seed_areas;
  /// If not NULL, called once a round on the calling thread: gives the areas that triangles may have, 0 or
  /// infinity for any. places: x and y of the centroids of `count` triangles. It must return normally; with a
  /// negative area or none (NaN), the call ends with an error.
  void (*areas_at)(const double* places, size_t count, double* areas, void* areas_data);
  void* areas_data;              ///< passed to areas_at unchanged
  int kept;                      ///< a flaunay_kept_edges
  const uint8_t* kept_segments;  ///< NULL, or one per segment: 1 if it must not be split
  /// Other than 0: `min_edge` counts. 0: 2^-40 of the larger side of the bounding box, or 2^-48 of the
  /// largest coordinate if that is more.
  int has_min_edge;
  double min_edge;      ///< no two points are put nearer to each other; from 0 on
  int has_most_points;  ///< other than 0: `most_points` counts; 0: there is no limit
  size_t most_points;   ///< no more points are added to a set; 0: none
  size_t most_rounds;   ///< no more rounds are made; 0: none
  /// Other than 0: constraints and the border are split until no angle opposite to them is obtuse; then all
  /// triangles are Delaunay without constraints, too.
  int conforming;
  int has_most_rounds;                  ///< other than 0: `most_rounds` counts; 0: 10,000
  const flaunay_given_triangles* mesh;  ///< NULL, or a mesh that is refined further
  size_t smoothing_steps;               ///< so often, added points move to where triangles are more regular
  uintptr_t reserved[1];                ///< 0
} flaunay_refinement;

/// How a refinement went.
typedef struct flaunay_refinement_report {
  size_t rounds;                 ///< in which points were added; of several sets the most
  size_t added_points;           ///< on constraints or not
  size_t split_points;           ///< those of them that are on constraints
  double smallest_angle;         ///< of all triangles, in degrees, rounded
  double largest_angle;          ///< of all triangles, in degrees, rounded
  size_t bad_count;              ///< number of triangles that are worse than asked for
  const int32_t* bad_triangles;  ///< these, ascending; NULL if there are none
  const uint8_t* excuses;        ///< a flaunay_excuse for each of them
  double mean_angle;             ///< of the smallest angle of each triangle; these are 0 without smoothing
  double smallest_angle_before;  ///< as smallest_angle, before smoothing
  double mean_angle_before;      ///< as mean_angle, before smoothing
} flaunay_refinement_report;

/// Segments that are to be edges, what is to be left out, and what is known of segments, points and regions.
/// {0}: no segments.
typedef struct flaunay_constraints {
  const int32_t* segments;  ///< 2 indices of points of the same set per segment
  size_t segment_count;     ///< number of segments
  /// x and y per hole: what is connected to this place without crossing a constraint is left out, whatever
  /// `outside` says.
  const double* holes;
  size_t hole_count;  ///< number of holes
  /// Set s has holes [hole_offsets[s], hole_offsets[s + 1]): sets + 1 offsets from 0 to hole_count. May be
  /// NULL if there is one set, or if there are no holes.
  const size_t* hole_offsets;
  int crossings;                   ///< a flaunay_crossings
  int outside;                     ///< a flaunay_outside
  int fill_rule;                   ///< a flaunay_fill_rule
  int labels;                      ///< other than 0: depths and regions are computed
  const int32_t* segment_markers;  ///< NULL, or one per segment: edge_markers are computed
  const int32_t* point_markers;    ///< NULL, or one per point: vertex_markers are computed
  /// x and y per seed: the region that this place is in has an attribute. If there are some,
  /// triangle_attributes are computed. As for holes, it is an error if a place is on a constraint, or in no
  /// triangle of the convex hull.
  const double* seeds;
  const double* seed_attributes;         ///< one per seed; may be NULL if there are seed_areas
  size_t seed_count;                     ///< number of seeds
  const size_t* seed_offsets;            ///< as hole_offsets
  const flaunay_refinement* refinement;  ///< NULL for none
  uintptr_t reserved[1];                 ///< 0
} flaunay_constraints;

/// Polygons with holes, as rings with offsets, in the layout of GeoArrow. {0}: no polygons. A ring may repeat
/// its first point at its end, and may have any orientation. Rings without area, such as those of fewer than
/// 3 points, have no triangles. A polygon may have several outer rings, or several parts.
typedef struct flaunay_polygons {
  const double* coordinates;  ///< x and y per point
  /// ring_count + 1 values from 0: ring r has points [ring_offsets[r], ring_offsets[r + 1]). It has a segment
  /// from each of its points to the next one, and from the last one to the first. Segment i begins at point
  /// i. NULL if there are no rings.
  const size_t* ring_offsets;
  size_t ring_count;  ///< number of rings
  /// polygon_count + 1 values from 0 to ring_count: polygon p has rings
  /// [polygon_offsets[p], polygon_offsets[p + 1]). NULL: each ring is a polygon, and polygon_count is
  /// ignored.
  const size_t* polygon_offsets;
  size_t polygon_count;  ///< number of polygons
  int crossings;         ///< a flaunay_crossings
  int has_outside;       ///< other than 0: `outside` counts; 0: FLAUNAY_OUTSIDE_HOLES, what is inside is kept
  int outside;           ///< a flaunay_outside
  int has_fill_rule;     ///< other than 0: `fill_rule` counts; 0: FLAUNAY_FILL_RULE_EVEN_ODD
  int fill_rule;         ///< a flaunay_fill_rule
  int labels;            ///< other than 0: depths and regions are computed
  /// Other than 0: all polygons are one map: a single set, in which polygons share the edges of common
  /// borders. The result says which triangle is in which polygon. The fill rule decides for each polygon what
  /// is inside of it, and must not be nesting. Depths are numbers of polygons.
  int map;
  int overlaps;  ///< a flaunay_overlaps
  /// If it is known which rings are holes: part_count + 1 values from 0 to ring_count. Part q has rings
  /// [part_offsets[q], part_offsets[q + 1]), the first one its border, the others its holes; each polygon
  /// begins with a part. Then the fill rule decides for each ring alone what is inside of it: a part is what
  /// is inside of its border and of none of its holes, and a polygon is all of its parts. Depths are numbers
  /// of polygons. Ignored by nesting. NULL: the fill rule counts all rings of a polygon alike, and part_count
  /// is ignored.
  const size_t* part_offsets;
  size_t part_count;                     ///< number of parts
  const flaunay_refinement* refinement;  ///< NULL for none
  uintptr_t reserved[5];                 ///< 0
} flaunay_polygons;

/// The arrays of a constrained triangulation besides its triangles. Arrays are NULL if they are empty.
typedef struct flaunay_constrained_arrays {
  size_t added_count;           ///< a, the number of points that were added
  size_t constraint_count;      ///< e, the number of constraint edges
  size_t segment_count;         ///< s, the number of segments
  size_t piece_count;           ///< p, the number of pieces of segments
  const double* added_points;   ///< 2 a values. The k-th added point has the index n + k.
  const size_t* added_offsets;  ///< sets + 1 values: set s has added points [offsets[s], offsets[s + 1])
  /// 2 e values: the edges that segments are made of, each once, the lexicographically smaller point first.
  /// Edges that follow each other on a segment follow each other here.
  const int32_t* constraint_edges;
  const int32_t* edge_segments;  ///< e values: the smallest index of a segment that has the edge
  /// s + 1 values: segment i has pieces [piece_offsets[i], piece_offsets[i + 1]), which lie on it from its
  /// lexicographically smaller end to the other one. Without splitting, each segment is one piece.
  const int32_t* piece_offsets;
  /// 2 p values: a piece has edges [first, second) of constraint_edges. 0, 0 if its ends have the same
  /// coordinates.
  const int32_t* piece_edges;
  const uint8_t* constrained;  ///< 3 t values: 1 if the edge opposite to this corner is a constraint
  const int32_t* depths;       ///< t values: depths by fill_rule; NULL without labels
  /// t values: a region is what is connected without crossing a constraint. Regions are numbered from 0 by
  /// their first triangles. NULL without labels.
  const int32_t* regions;
  const int32_t* polygons;  ///< t values: the polygon of a map, -1 if it is in none; NULL if there is no map
  const int32_t*
      edge_markers;  ///< e values: the marker of its segment in edge_segments; NULL without markers
  /// A value per point, added ones too: those of the input as they were given, and for each added point the
  /// marker of the segment with the smallest index that has it, 0 if there is none. NULL without.
  const int32_t* vertex_markers;
  /// t values: the attribute of its region; of several seeds in one region the last one counts, and where
  /// there is none it is 0. Seeds on a constraint, and those in no triangle, count for nothing. NULL without.
  const double* triangle_attributes;
} flaunay_constrained_arrays;

/// The changes that a batch has made in a flaunay_dynamic. Arrays are NULL if they are empty.
typedef struct flaunay_changes {
  size_t first_point;           ///< the number of the first point that was inserted; the others follow it
  size_t representative_count;  ///< number of points that were inserted or moved
  size_t removed_count;         ///< number of rows in `removed`
  size_t made_count;            ///< number of rows in `made`
  /// For each point that was inserted or moved the smallest number of a point in its place.
  const int32_t* representatives;
  const int32_t* removed;       ///< the rows whose triangles are gone, each once
  const int32_t* made;          ///< the rows that have new triangles, each once; some may be in both lists
  const int32_t* made_corners;  ///< 3 per row of `made`: the corners, counter-clockwise
  int is_anew;                  ///< 1 if all points were triangulated anew: all rows are listed
  double seconds;               ///< how long the call took
} flaunay_changes;

/// The edges that segments of a flaunay_dynamic are made of, in ascending order of the smaller numbers of
/// their points, and of the larger ones. Arrays are NULL if they are empty.
typedef struct flaunay_living_constraints {
  size_t edge_count;        ///< number of edges
  const int32_t* edges;     ///< 2 points per edge, the lexicographically smaller one first
  const int32_t* segments;  ///< one per edge: the smallest index of a segment that has it
} flaunay_living_constraints;

/// A round of chunks.
typedef struct flaunay_chunk_round {
  uint64_t points;     ///< distinct points of the round; of the first one, with duplicates
  uint64_t chunks;     ///< chunks into which they were cut
  uint64_t triangles;  ///< triangles that became final
  uint64_t handed_on;  ///< points that went on to the next round
} flaunay_chunk_round;

/// A device that triangulated chunks.
typedef struct flaunay_chunk_device {
  const char* name;  ///< as in flaunay_device_info; "host" for the host without OpenCL
  uint64_t points;   ///< points of the chunks that it triangulated
} flaunay_chunk_device;

/// The work of a triangulation in chunks and its time.
typedef struct flaunay_chunk_statistics {
  uint64_t points;                      ///< input points
  uint64_t duplicates;                  ///< input points that are not their own representative
  uint64_t triangles;                   ///< number of triangles
  uint64_t hull_vertices;               ///< number of hull vertices
  uint64_t undecided;                   ///< predicates that needed exact evaluation
  uint64_t scratch_bytes;               ///< the largest size of the scratch file
  size_t chunk_points;                  ///< points of a chunk, at most about
  double seconds;                       ///< wall time
  const flaunay_chunk_round* rounds;    ///< in the order in which they ran
  size_t round_count;                   ///< number of rounds
  const flaunay_chunk_device* devices;  ///< in the order in which they were named
  size_t device_count;                  ///< number of devices
  const flaunay_phase* phases;          ///< in the order in which they ran
  size_t phase_count;                   ///< number of phases
  uint64_t host_points;                 ///< points of the chunks that devices without fp64 left to the host
  const char* note;                     ///< as in flaunay_statistics; of such chunks, that of the first
  uint64_t images;                      ///< with a period: images of points that were triangulated, too
} flaunay_chunk_statistics;

/// An OpenCL device.
typedef struct flaunay_device_info {
  const char* name;               ///< CL_DEVICE_NAME; FLAUNAY_DEVICE may name a part of it
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
  int fp64;                       ///< 1 if it has double precision
  int self_test_passed;           ///< 1 if the arithmetic self test was run and passed
  const char* self_test_failure;  ///< what failed, or ""
  /// The part of memory_bytes that can be used now. A device that shares the host's memory has at most what
  /// is free there, and what the limits of the process and of its control group leave.
  size_t available_bytes;
  /// 1 if it computes in fixed point: it lacks fp64 or, as far as the self test was run, its doubles are not
  /// exact or slower. What fixed point cannot do is done with its doubles or, if there are none, natively on
  /// the host. Results are the same.
  int fixed_point;
} flaunay_device_info;

// ---- Errors

/// The name of a status: "success", "usage error" and so on; "unknown status" for another number. The text is
/// static.
FLAUNAY_API const char* flaunay_status_string(int status);
/// The message of the last call that failed on this thread, "" if none did. Valid until the next failure on
/// this thread.
FLAUNAY_API const char* flaunay_last_error(void);
/// The flaunay_status of the last failure on this thread, for accessors, which return none. FLAUNAY_SUCCESS
/// if nothing failed.
FLAUNAY_API int flaunay_last_error_status(void);
/// The error code of the OpenCL call that failed, such as -5 for CL_OUT_OF_RESOURCES; 0 if the failure was
/// not in OpenCL.
FLAUNAY_API int flaunay_last_error_code(void);
/// The OpenCL call that failed, such as "clCreateBuffer"; "" if the failure was not in OpenCL. Valid until
/// the next failure on this thread.
FLAUNAY_API const char* flaunay_last_error_call(void);
/// The version of the library that is linked, such as "0.1.0". The text is static.
FLAUNAY_API const char* flaunay_version(void);

// ---- Devices

/// Lists every device of every platform, in the order in which "#k" counts them. self_test other than 0:
/// builds and runs the arithmetic self test on each device, which takes some seconds per device.
/// FLAUNAY_ERROR_DEVICE if there is no OpenCL platform.
FLAUNAY_API flaunay_status flaunay_device_list_create(int self_test, flaunay_device_list** list);
/// Adds an OpenCL driver that comes with a program to those of the system: the shared library at `path`. If
/// the system has a platform of the name `platform`, the driver is not used. To be called before devices are
/// listed or used; a driver that cannot be loaded has no devices.
FLAUNAY_API flaunay_status flaunay_add_driver(const char* platform, const char* path);
/// Frees the list. Like every destroy function, it accepts NULL.
FLAUNAY_API void flaunay_device_list_destroy(flaunay_device_list* list);
/// The number of devices.
FLAUNAY_API size_t flaunay_device_list_count(const flaunay_device_list* list);
/// The k-th device, counted from 0; NULL beyond the last.
FLAUNAY_API const flaunay_device_info* flaunay_device_list_at(const flaunay_device_list* list, size_t k);

// ---- Triangulators

/// Makes a triangulator. device: NULL or "" (what FLAUNAY_DEVICE names if it is set; otherwise calls on
/// points in host memory use the first GPU with fp64, or the first GPU, or if there is none, the host's cores
/// without OpenCL), "host" (the host without OpenCL), "#k" (the k-th device of the list, from 0), or a part
/// of a device's or platform's name in upper or lower case.
/// A named device does all the work that it can do without fp64, if it has none; otherwise small sets are
/// triangulated on the calling thread, and OpenCL is loaded when it is first needed. Using a device for the
/// first time compiles kernels, so keep the triangulator for the next call. FLAUNAY_DEVICE and FLAUNAY_TUNING
/// are read here, once. FLAUNAY_ERROR_DEVICE if there is no such device, if its arithmetic fails the self
/// test, or if FLAUNAY_TUNING is not valid.
FLAUNAY_API flaunay_status flaunay_triangulator_create(const char* device,
                                                       flaunay_triangulator** triangulator);
/// Makes a triangulator in the caller's context, which is retained. FLAUNAY_ERROR_USAGE if the device does
/// not belong to the context, FLAUNAY_ERROR_DEVICE as above.
FLAUNAY_API flaunay_status flaunay_triangulator_create_in_context(cl_context context, cl_device_id device,
                                                                  flaunay_triangulator** triangulator);
/// Waits for the work that was enqueued. Locators and results of the triangulator stay valid.
FLAUNAY_API void flaunay_triangulator_destroy(flaunay_triangulator* triangulator);
/// The device that calls on host memory use, which passed the self test; NULL if it cannot be used. The
/// host's name is "host".
FLAUNAY_API const flaunay_device_info* flaunay_triangulator_device(const flaunay_triangulator* triangulator);
/// The context, for the caller's own buffers, kernels and queues. Owned by the triangulator. This and other
/// functions for device memory use the device that was named, or else the first GPU with fp64, the first GPU,
/// the first device with fp64, or the first device; NULL if there is none or if "host" was named.
FLAUNAY_API cl_context flaunay_triangulator_context(const flaunay_triangulator* triangulator);
/// The OpenCL handle of the device; see flaunay_triangulator_context. Owned by the triangulator.
FLAUNAY_API cl_device_id flaunay_triangulator_device_id(const flaunay_triangulator* triangulator);
/// The triangulator's own queue, which is in order; see flaunay_triangulator_context. Owned by the
/// triangulator.
FLAUNAY_API cl_command_queue flaunay_triangulator_queue(const flaunay_triangulator* triangulator);
/// The largest number of points that one call can take on this device.
FLAUNAY_API size_t flaunay_triangulator_capacity(const flaunay_triangulator* triangulator);
/// An upper bound of the device memory, in bytes, that a call in mode blocks on n points in `sets` sets needs
/// besides points and results. FLAUNAY_ERROR_INPUT or FLAUNAY_ERROR_DEVICE if n is above the capacity.
FLAUNAY_API flaunay_status flaunay_triangulator_workspace_bytes(const flaunay_triangulator* triangulator,
                                                                size_t n, size_t sets, size_t* bytes);
/// Makes later calls in mode blocks use the caller's buffer as their working memory; the buffer is retained.
/// NULL: the triangulator uses its own memory again. A call that needs more is FLAUNAY_ERROR_USAGE, and the
/// message says how much it needs. The other modes always use their own memory. Waits for the work that was
/// enqueued.
FLAUNAY_API flaunay_status flaunay_triangulator_use_workspace(flaunay_triangulator* triangulator,
                                                              cl_mem workspace);

// ---- Points and results in host memory

/// The number of modes.
FLAUNAY_API size_t flaunay_mode_count(void);
/// The k-th mode, counted from 0, the default first; NULL beyond the last. The struct is static.
FLAUNAY_API const flaunay_mode_info* flaunay_mode_at(size_t k);

/// Triangulates n points. coordinates: x0 y0 x1 y1 ...; may be NULL if n is 0. offsets: NULL for one set, and
/// then `sets` is ignored; otherwise sets + 1 offsets from 0 to n, and set s has points
/// [offsets[s], offsets[s + 1]), which may be none. options: NULL for the defaults. The caller destroys the
/// result. FLAUNAY_ERROR_INPUT for a coordinate that is not finite, a range of magnitudes too large for exact
/// arithmetic, or too many points; FLAUNAY_ERROR_USAGE for offsets that decrease or do not end with n.
///
/// In other spaces than the plane, and with weights, results are exact functions of places and weights, too.
/// With weights it is the regular triangulation: the lower hull of the points at height x^2 + y^2 - weight.
/// On a torus or a cylinder, points are any finite numbers, which are taken into the period, and the result
/// has each triangle of all images of all points once, however few points there are. On the sphere it is
/// their convex hull in space. FLAUNAY_ERROR_USAGE also for a period that is none, for weights on the sphere,
/// and for half-edges and areas on a torus or the sphere, which have neighbours always;
/// FLAUNAY_ERROR_INPUT also for a weight that is not finite or beyond the squares of what coordinates may be,
/// for the direction 0, and for a latitude beyond a pole. O(n log n) work.
FLAUNAY_API flaunay_status flaunay_triangulate(flaunay_triangulator* triangulator, const double* coordinates,
                                               size_t n, const size_t* offsets, size_t sets,
                                               const flaunay_options* options,
                                               flaunay_triangulation** result);
/// flaunay_triangulate for float. The result is the same as for the coordinates converted to double.
FLAUNAY_API flaunay_status flaunay_triangulate_float(flaunay_triangulator* triangulator,
                                                     const float* coordinates, size_t n,
                                                     const size_t* offsets, size_t sets,
                                                     const flaunay_options* options,
                                                     flaunay_triangulation** result);
/// flaunay_triangulate without a device. options->mode must be FLAUNAY_MODE_RECURSIVE or FLAUNAY_MODE_DWYER;
/// any other mode is FLAUNAY_ERROR_USAGE.
FLAUNAY_API flaunay_status flaunay_triangulate_on_host(const double* coordinates, size_t n,
                                                       const size_t* offsets, size_t sets,
                                                       const flaunay_options* options,
                                                       flaunay_triangulation** result);
/// Makes a triangulation from arrays that were kept elsewhere, such as in files, for Voronoi diagrams, cells,
/// locators and trees. mesh: its arrays are copied; those that were not asked for may be NULL. constraints:
/// NULL without constraints; for locators, its member `constrained` is enough. FLAUNAY_ERROR_USAGE if an
/// index is out of range; whether they are a triangulation is not checked. O(n) work.
FLAUNAY_API flaunay_status flaunay_triangulation_create(const flaunay_mesh* mesh,
                                                        const flaunay_constrained_arrays* constraints,
                                                        flaunay_triangulation** triangulation);
/// Frees the arrays.
FLAUNAY_API void flaunay_triangulation_destroy(flaunay_triangulation* triangulation);

/// Its sizes, arrays and statistics. O(1).
FLAUNAY_API const flaunay_mesh* flaunay_triangulation_mesh(const flaunay_triangulation* triangulation);

/// Finds for each of n points the first of t triangles that has it, -1 if none has. first: n values of the
/// caller's. FLAUNAY_ERROR_USAGE if an index is out of range. O(n) work.
FLAUNAY_API flaunay_status flaunay_first_triangles(const int32_t* triangles, size_t t, size_t n,
                                                   int32_t* first);
/// Finds for each of n points its neighbours in a mesh of t triangles with h hull vertices, in increasing
/// order. starts: n + 1 values of the caller's; neighbors: 3 t + h values of the caller's, none if t is 0.
/// The neighbours of point i are [starts[i], starts[i + 1]) of neighbors. FLAUNAY_ERROR_USAGE if an index is
/// out of range, FLAUNAY_ERROR_INPUT if there are more values than an int32_t can count. O(n log n) work.
FLAUNAY_API flaunay_status flaunay_vertex_neighbors(const int32_t* triangles, size_t t, const int32_t* hull,
                                                    size_t h, size_t n, int32_t* starts, int32_t* neighbors);

/// Finds for each of t triangles whether its corners turn left (1) or right (-1) or are collinear (0),
/// exactly. turns: t values of the caller's. This and the next functions return FLAUNAY_ERROR_USAGE if an
/// index is out of range, and the errors of flaunay_triangulate for points. O(n + t) work.
FLAUNAY_API flaunay_status flaunay_triangle_turns(const double* coordinates, size_t n,
                                                  const int32_t* triangles, size_t t, int8_t* turns);
/// Computes the areas of t triangles, rounded as FLAUNAY_PART_AREAS says; negative if the corners turn right.
/// areas: t values of the caller's.
FLAUNAY_API flaunay_status flaunay_triangle_areas(const double* coordinates, size_t n,
                                                  const int32_t* triangles, size_t t, double* areas);
/// Finds for each corner of t triangles whether its angle is acute (1), right (0) or obtuse (-1), exactly.
/// angles: 3 t values of the caller's.
FLAUNAY_API flaunay_status flaunay_triangle_angles(const double* coordinates, size_t n,
                                                   const int32_t* triangles, size_t t, int8_t* angles);
/// Computes the radii of the circumcircles of t triangles, with a relative error below 2^-45: infinite if
/// they exceed all doubles, or if the corners are collinear. radii: t values of the caller's.
FLAUNAY_API flaunay_status flaunay_circumradii(const double* coordinates, size_t n, const int32_t* triangles,
                                               size_t t, double* radii);
/// Finds for each halfedge of t triangles whether the vertex beyond it lies inside the circumcircle of its
/// triangle (1), on it (0) or outside (-1), exactly: of a Delaunay triangulation none is inside. The
/// triangles may have any direction; where the corners are collinear it is 1, and where nothing is beyond it
/// is -1. halfedges: as FLAUNAY_PART_HALFEDGES has them; sides: 3 t values of the caller's.
FLAUNAY_API flaunay_status flaunay_edge_circles(const double* coordinates, size_t n, const int32_t* triangles,
                                                size_t t, const int32_t* halfedges, int8_t* sides);
/// Finds for each of t triangles of a Delaunay triangulation the first one that has the same circumcircle,
/// exactly. neighbors: as FLAUNAY_PART_NEIGHBORS has them; first: t values of the caller's.
FLAUNAY_API flaunay_status flaunay_same_circles(const double* coordinates, size_t n, const int32_t* triangles,
                                                size_t t, const int32_t* neighbors, int32_t* first);

/// Checks exactly that a mesh is the canonical Delaunay triangulation of each of its sets, and that all of
/// its arrays fit; if not, it is FLAUNAY_ERROR_INTERNAL, whose message says what is wrong. The check has
/// arithmetic and predicates of its own. mesh: of any call, or the caller's arrays; its statistics are not
/// read. coordinates: of its points. offsets: its set_count sets, as for flaunay_triangulate; NULL: one set.
/// space: that of the call, with weights; NULL: the plane. In other spaces it checks, too, that places are
/// those of the points, and of weighted points which are hidden. FLAUNAY_ERROR_USAGE for arrays whose indices
/// are out of range. O(n log n).
FLAUNAY_API flaunay_status flaunay_mesh_verify(const flaunay_mesh* mesh, const double* coordinates,
                                               const size_t* offsets, const flaunay_space* space);
/// Finds for each hidden point of a triangulation with weights the triangle that hides it: the one of the
/// smallest index that has it inside or on its border; -1 in a set without triangles. points, offsets, sets:
/// those of the call. triangles: room for one value per hidden point.
FLAUNAY_API flaunay_status flaunay_hiding_triangles(flaunay_triangulator* triangulator, const double* points,
                                                    const size_t* offsets, size_t sets,
                                                    const flaunay_triangulation* triangulation,
                                                    int32_t* triangles);
/// Computes the unit vectors x y z of n places on the sphere, rounded. directions: room for 3 n values.
FLAUNAY_API flaunay_status flaunay_directions(const double* places, size_t n, double* directions);

// ---- Constrained triangulations

/// Triangulates points with segments as edges: the canonical constrained Delaunay triangulation, a function
/// of the sets of points and of segments. coordinates, n, offsets, sets: as for flaunay_triangulate.
/// constraints: NULL for none. options: NULL for the defaults; the mode must be FLAUNAY_MODE_BLOCKS. The
/// caller destroys the result. The errors are those of flaunay_triangulate, and: FLAUNAY_ERROR_USAGE for an
/// index that is no point and for a segment between sets; FLAUNAY_ERROR_INPUT for segments that cross where
/// no point is, unless they are to be split, for a hole that is in no triangle or on a constraint, and for
/// segments that are no closed curves if the fill rule needs such.
FLAUNAY_API flaunay_status flaunay_triangulate_constrained(flaunay_triangulator* triangulator,
                                                           const double* coordinates, size_t n,
                                                           const size_t* offsets, size_t sets,
                                                           const flaunay_constraints* constraints,
                                                           const flaunay_options* options,
                                                           flaunay_triangulation** result);
/// Triangulates the insides of polygons, all at once. Each polygon is a set of its own, or all are one map.
/// options: as for flaunay_triangulate_constrained. FLAUNAY_ERROR_USAGE if the offsets do not fit each other;
/// the other errors are those of flaunay_triangulate_constrained. If segments cross, the message names the
/// polygon, too.
FLAUNAY_API flaunay_status flaunay_triangulate_polygons(flaunay_triangulator* triangulator,
                                                        const flaunay_polygons* polygons,
                                                        const flaunay_options* options,
                                                        flaunay_triangulation** result);
/// The arrays of a triangulation with constraints besides its flaunay_mesh; NULL without constraints. In the
/// mesh, point_count, hull and representatives include points that were added. Where triangles are left out,
/// neighbours and halfedges are -1; the hull remains that of the points.
FLAUNAY_API const flaunay_constrained_arrays* flaunay_triangulation_constraints(
    const flaunay_triangulation* triangulation);
/// How its refinement went; NULL without constraints.
FLAUNAY_API const flaunay_refinement_report* flaunay_triangulation_refinement(
    const flaunay_triangulation* triangulation);
/// As flaunay_mesh_verify, for what flaunay_triangulate_constrained made of these coordinates, offsets and
/// constraints: segments are edges, the others are Delaunay, and just those triangles are there which were to
/// be kept. Of a refined mesh: no triangle has a smaller angle or a larger area than asked for, but those
/// that the report lists. report: NULL if nothing was refined. O((n + s) log (n + s)) for s segments.
FLAUNAY_API flaunay_status flaunay_mesh_verify_constrained(const flaunay_mesh* mesh,
                                                           const flaunay_constrained_arrays* arrays,
                                                           const flaunay_refinement_report* report,
                                                           const double* coordinates, const size_t* offsets,
                                                           const flaunay_constraints* constraints);
/// As flaunay_mesh_verify_constrained, for what flaunay_triangulate_polygons made. Of a map, it is not
/// checked which of several polygons a triangle is given to.
FLAUNAY_API flaunay_status flaunay_mesh_verify_polygons(const flaunay_mesh* mesh,
                                                        const flaunay_constrained_arrays* arrays,
                                                        const flaunay_refinement_report* report,
                                                        const flaunay_polygons* polygons);

// ---- Triangulations that change

/// Makes a triangulation to which points are inserted, removed and moved. After every call its triangles are
/// those of flaunay_triangulate, or flaunay_triangulate_constrained, for all points that it has; so are the
/// errors. coordinates, n: as there, for one set. constraints: NULL for none; nothing can be left out,
/// labelled or refined. If crossing segments are split, the points that this adds come after the n. options:
/// NULL for the defaults, of which `parts` holds for flaunay_dynamic_triangulation; the mode must be
/// FLAUNAY_MODE_BLOCKS. It may outlive its triangulator, whose turns it takes.
///
/// Points have numbers: those it is made from come first, then those inserted, in their order. A number stays
/// the same as long as the point is there, and is not used again. Of points in one place, the one with the
/// smallest number is in triangles. Triangles are in rows of an array, some of which have none. A triangle
/// stays in its row as long as nothing changes it. Rows are the same on every device, for the same calls.
FLAUNAY_API flaunay_status flaunay_dynamic_create(flaunay_triangulator* triangulator,
                                                  const double* coordinates, size_t n,
                                                  const flaunay_constraints* constraints,
                                                  const flaunay_options* options, flaunay_dynamic** dynamic);
/// flaunay_dynamic_create for points of one set in device memory, which are copied. They must be there when
/// the call is made.
FLAUNAY_API flaunay_status flaunay_dynamic_create_device(flaunay_triangulator* triangulator,
                                                         const flaunay_device_points* points,
                                                         const flaunay_options* options,
                                                         flaunay_dynamic** dynamic);
/// Releases its memory.
FLAUNAY_API void flaunay_dynamic_destroy(flaunay_dynamic* dynamic);
/// Inserts m points, x0 y0 x1 y1 ... One that lies on a constraint splits it. The errors of this and the next
/// functions are those of flaunay_triangulate, and: FLAUNAY_ERROR_INPUT for a number that no point has, one
/// that is there twice, and a vertex of a constraint that is to be removed or moved; the message names it.
/// Such an error changes nothing. After another one, such as FLAUNAY_ERROR_MEMORY, points, triangles and
/// constraints are what they were before, but triangles may be in other rows, which flaunay_dynamic_rows
/// tells.
FLAUNAY_API flaunay_status flaunay_dynamic_insert(flaunay_dynamic* dynamic, const double* coordinates,
                                                  size_t m);
/// flaunay_dynamic_insert for points of one set in device memory.
FLAUNAY_API flaunay_status flaunay_dynamic_insert_device(flaunay_dynamic* dynamic,
                                                         const flaunay_device_points* points);
/// Removes the points of these m numbers.
FLAUNAY_API flaunay_status flaunay_dynamic_remove(flaunay_dynamic* dynamic, const int32_t* points, size_t m);
/// Moves the points of these m numbers to these places, all at once.
FLAUNAY_API flaunay_status flaunay_dynamic_move(flaunay_dynamic* dynamic, const int32_t* points,
                                                const double* coordinates, size_t m);
/// The changes of the last of these calls that did not fail. Valid until the next one.
FLAUNAY_API const flaunay_changes* flaunay_dynamic_changes(const flaunay_dynamic* dynamic);
/// One more than the largest number that a point has had. This and the next three functions take O(1).
FLAUNAY_API size_t flaunay_dynamic_numbers(const flaunay_dynamic* dynamic);
/// The number of points that there are, with duplicates.
FLAUNAY_API size_t flaunay_dynamic_point_count(const flaunay_dynamic* dynamic);
/// The number of triangles.
FLAUNAY_API size_t flaunay_dynamic_triangle_count(const flaunay_dynamic* dynamic);
/// The number of rows, with those that have no triangle.
FLAUNAY_API size_t flaunay_dynamic_row_count(const flaunay_dynamic* dynamic);
/// 1 if there is a point of this number, otherwise 0. O(1).
FLAUNAY_API int flaunay_dynamic_has_point(const flaunay_dynamic* dynamic, size_t number);
/// Copies x and y per number; NaN for points that were removed. coordinates: room for 2 values per number.
FLAUNAY_API flaunay_status flaunay_dynamic_coordinates(const flaunay_dynamic* dynamic, double* coordinates);
/// Copies the corners of the triangle in each row, counter-clockwise from any of them on, and the rows of the
/// triangles opposite to them; -1 in rows without a triangle and beyond the hull. Each has room for 3 values
/// per row, or is NULL.
FLAUNAY_API flaunay_status flaunay_dynamic_rows(flaunay_dynamic* dynamic, int32_t* triangles,
                                                int32_t* neighbors);
/// Makes the result of a call on all points, with their numbers: triangles in the order of their rows, which
/// have the smallest number first. Representatives of points that were removed are -1. O(rows).
FLAUNAY_API flaunay_status flaunay_dynamic_triangulation(flaunay_dynamic* dynamic,
                                                         flaunay_triangulation** result);
/// The edges that segments are made of now; NULL after an error. Valid until this is called again.
FLAUNAY_API const flaunay_living_constraints* flaunay_dynamic_constraints(flaunay_dynamic* dynamic);

/// flaunay_dynamic_rows and flaunay_dynamic_coordinates in device memory: the parts triangles, neighbors and
/// coordinates of a mesh whose points are all numbers, and whose triangles are all rows. The work is enqueued
/// like that of flaunay_triangulate_device, with the same errors. O(rows).
FLAUNAY_API flaunay_status flaunay_dynamic_rows_device(flaunay_dynamic* dynamic,
                                                       const flaunay_enqueue* enqueue,
                                                       flaunay_device_triangulation* result);

// ---- Points and results in device memory

/// Makes an empty result, which can be computed any number of times. Its buffers are made by flaunay when
/// they are first needed, kept for the next call, and replaced if they are too small.
FLAUNAY_API flaunay_status flaunay_device_triangulation_create(flaunay_device_triangulation** triangulation);
/// Releases its buffers; what is enqueued with them goes on.
FLAUNAY_API void flaunay_device_triangulation_destroy(flaunay_device_triangulation* triangulation);
/// Makes later calls write one part (one bit) to the caller's buffer, which is retained and never replaced.
/// NULL: flaunay makes its own buffer again. The buffer must have, for n points, 24 n bytes for triangles,
/// neighbors or halfedges, 4 n bytes for hull, representatives or hidden points, 16 n bytes for areas,
/// places or coordinates, and 12 n bytes for corner offsets; 6 n bytes for constrained, 8 bytes per segment
/// for piece edges and 8 per edge for constraint edges; and for r rows of a flaunay_dynamic 12 r bytes for
/// triangles and neighbors each.
/// FLAUNAY_ERROR_USAGE if memory is not a buffer.
FLAUNAY_API flaunay_status flaunay_device_triangulation_set_buffer(
    flaunay_device_triangulation* triangulation, unsigned part, cl_mem memory);
/// The buffer of one part, NULL if there is none yet. It is valid as long as the handle; to keep it longer,
/// call clRetainMemObject.
FLAUNAY_API cl_mem flaunay_device_triangulation_buffer(const flaunay_device_triangulation* triangulation,
                                                       unsigned part);
/// Which of the arrays up to the areas the last call computed, as bits of flaunay_part; 0 before the first
/// call. Arrays of spaces, weights, constraints and coordinates are always there where a call has them. This
/// and the following values are known when the call returns.
FLAUNAY_API unsigned flaunay_device_triangulation_parts(const flaunay_device_triangulation* triangulation);
/// Its sizes, offsets, space and statistics, which are in host memory; the pointers to other arrays are NULL.
FLAUNAY_API const flaunay_mesh* flaunay_device_triangulation_mesh(
    const flaunay_device_triangulation* triangulation);
/// The number of its constraint edges, known when the call returns.
FLAUNAY_API size_t
flaunay_device_triangulation_constraint_count(const flaunay_device_triangulation* triangulation);

/// Triangulates points in device memory into device memory, in mode blocks. Points and results are not copied
/// to the host, only sizes are; the host waits 5 or 6 times for them, on GPUs once or twice per round. The
/// call returns when everything is enqueued. The results are complete when the event is complete, and for all
/// commands that are enqueued later on the same in-order queue; until then the points and the buffers of the
/// results must not be changed. A second call of the same size allocates no device memory. parts: bits of
/// flaunay_part, 0 for the triangles alone; neighbours, halfedges and areas need the triangles. enqueue: NULL
/// for the triangulator's own queue. FLAUNAY_ERROR_USAGE for buffers that are too small or of another
/// context, a queue of another context or device, offsets that decrease or do not end with the number of
/// points; FLAUNAY_ERROR_INPUT as for points in host memory. The result is unspecified after an error. O(n
/// log n) work.
///
/// On a torus, a cylinder or the sphere, triangles, neighbours, representatives and places are computed,
/// whatever the parts. On a torus, the host joins what meets at the border, about the square root of n
/// triangles, and waits about 5 times more; devices without fp64 leave it to the host. On the sphere, the
/// host makes the triangles around the south pole, for which it reads the hull in the plane, and computes all
/// if a point is there.
FLAUNAY_API flaunay_status flaunay_triangulate_device(flaunay_triangulator* triangulator,
                                                      const flaunay_device_points* points, unsigned parts,
                                                      const flaunay_enqueue* enqueue,
                                                      flaunay_device_triangulation* result);

/// flaunay_triangulate_constrained for points and segments in device memory, into device memory. segments: 2
/// int32 per segment. FLAUNAY_ERROR_INPUT if segments cross where no point is; no triangles are left out. The
/// mesh has the parts of constraints, and of the others all but halfedges and areas; Voronoi diagrams and
/// locators refuse it. The work is enqueued like that of flaunay_triangulate_device, with the same errors;
/// the host waits once more per round of segments.
FLAUNAY_API flaunay_status flaunay_triangulate_constrained_device(flaunay_triangulator* triangulator,
                                                                  const flaunay_device_points* points,
                                                                  cl_mem segments, size_t segment_count,
                                                                  const flaunay_enqueue* enqueue,
                                                                  flaunay_device_triangulation* mesh);

// ---- More points than fit memory

/// Triangulates n points in chunks. What is final in a chunk is written; points around which something is
/// missing, some hundredths of a chunk's, go on to chunks that are cut otherwise, until one chunk has them
/// all. The points and the results may be files that are mapped into memory. coordinates: x0 y0 x1 y1 ...;
/// may be NULL if n is 0. results: where to write; the report has their numbers. options: NULL for the
/// defaults. The caller destroys the report. The set of triangles with their neighbours, the hull and the
/// representatives are those of flaunay_triangulate; the order of rows depends on the options, too.
///
/// The errors are those of flaunay_triangulate, and: FLAUNAY_ERROR_INPUT if there are more than 2^30 - 1
/// points for 32-bit indices, if the scratch folder has too little room or writing there fails, or if the
/// points that are left to the last chunk do not fit memory_bytes, as of points that are all on one circle;
/// FLAUNAY_ERROR_USAGE if memory_bytes is too small for any work; FLAUNAY_ERROR_STOPPED. After an error the
/// results are unspecified. A device that fails in the middle of the call leaves its chunk to the others; the
/// call fails if none is left. O(n log n) work.
///
/// On a torus or a cylinder there is no hull. Points are read at least three times; the images of those near
/// the border are in memory, 48 bytes for each. Further errors: FLAUNAY_ERROR_USAGE for a period that is none
/// or another space, FLAUNAY_ERROR_INPUT if the images do not fit memory_bytes.
FLAUNAY_API flaunay_status flaunay_triangulate_chunks(const double* coordinates, uint64_t n,
                                                      const flaunay_mesh_arrays* results,
                                                      const flaunay_chunk_options* options,
                                                      flaunay_chunk_report** report);
/// flaunay_triangulate_chunks for points and results that are nowhere in memory as a whole.
FLAUNAY_API flaunay_status flaunay_triangulate_streams(const flaunay_point_source* points,
                                                       const flaunay_mesh_sink* results,
                                                       const flaunay_chunk_options* options,
                                                       flaunay_chunk_report** report);
/// flaunay_triangulate_chunks for points with any strides, and for results each of which goes to an array, to
/// a file, or nowhere. All files get their names in the end, or after an error none: what was there before
/// stays. arrays: may be NULL for files of 32-bit indices alone; files: may be NULL. 32 bits suffice for 2^31
/// - 1 points, or with neighbours for 2^30 - 1. Further errors: FLAUNAY_ERROR_INPUT if a disk has no room for
/// the files or one cannot be written, FLAUNAY_ERROR_USAGE if a file is no regular one or if a part is wanted
/// both in an array and in a file.
FLAUNAY_API flaunay_status flaunay_triangulate_chunks_to_files(const flaunay_strided_points* points,
                                                               const flaunay_mesh_arrays* arrays,
                                                               const flaunay_mesh_files* files,
                                                               const flaunay_chunk_options* options,
                                                               flaunay_chunk_report** report);
/// Takes n points, x0 y0 x1 y1 ..., to their places in the period, as calls on a torus or a cylinder do.
/// period: x, y and the shear, which become the rounded ones. Errors are FLAUNAY_ERROR_USAGE for a period
/// that is none, FLAUNAY_ERROR_INPUT for points that are not finite. O(n).
FLAUNAY_API flaunay_status flaunay_take_to_places(double* period, double* points, size_t n);
/// Frees the report.
FLAUNAY_API void flaunay_chunk_report_destroy(flaunay_chunk_report* report);
/// The work of the call and its time.
FLAUNAY_API const flaunay_chunk_statistics* flaunay_chunk_report_statistics(
    const flaunay_chunk_report* report);

// ---- Voronoi diagrams

/// Computes the dual of a triangulation of these n points, which must have neighbours. Where more than three
/// points are cocircular, circumcentres coincide. The caller destroys the result. O(n) work; one work-item
/// per point takes as many steps as the point has triangles. On the sphere, coordinates and n are not read.
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
/// 2 t values. They are rounded; which cells are adjacent was decided by exact predicates. On the sphere 3 t
/// values, x y z: the centre of the empty cap whose rim passes through a triangle's corners.
FLAUNAY_API const double* flaunay_voronoi_circumcentres(const flaunay_voronoi* voronoi);
/// n + 1 values: the cell of point i has corners [offsets[i], offsets[i + 1]) of cells.
FLAUNAY_API const int32_t* flaunay_voronoi_cell_offsets(const flaunay_voronoi* voronoi);
/// c values: the triangles whose circumcentres are the corners of the cells. They go counter-clockwise around
/// each point and begin with the smallest index. In an unbounded cell they begin at the hull edge that leaves
/// the point and end at the hull edge that arrives at it; from the first and the last corner, a ray
/// perpendicular to that edge goes outwards. Points that another point represents, and points on one line,
/// have no corners. On the sphere, cells are counter-clockwise as seen from outside, and a set of one or two
/// points has no corners: the cells of two points are hemispheres. If all points are on one great circle,
/// cells are lunes with two corners (and some that coincide), opposite to each other, so that a side needs
/// its middle to be drawn: of the cell of p that is the direction of a x (q - p), for the side that begins at
/// the centre a of a triangle and is shared with q, the corner before p in that triangle.
FLAUNAY_API const int32_t* flaunay_voronoi_cells(const flaunay_voronoi* voronoi);
/// n values: 1 for points on the hull and for all points of a set on one line, otherwise 0.
FLAUNAY_API const uint8_t* flaunay_voronoi_unbounded(const flaunay_voronoi* voronoi);
/// n values on the sphere: the areas of cells, rounded by some 1e-15, and if all points are within an angle
/// r, by that divided by r^2. Those of a set sum to 4 pi.
FLAUNAY_API const double* flaunay_voronoi_areas(const flaunay_voronoi* voronoi);

/// Makes an empty result, whose buffers work like those of a flaunay_device_triangulation.
FLAUNAY_API flaunay_status flaunay_device_voronoi_create(flaunay_device_voronoi** voronoi);
/// Releases its buffers; what is enqueued with them goes on.
FLAUNAY_API void flaunay_device_voronoi_destroy(flaunay_device_voronoi* voronoi);
/// Makes later calls write one part, one bit of flaunay_voronoi_part, to the caller's buffer. Its size must
/// be that given there. Otherwise see flaunay_device_triangulation_set_buffer.
FLAUNAY_API flaunay_status flaunay_device_voronoi_set_buffer(flaunay_device_voronoi* voronoi, unsigned part,
                                                             cl_mem memory);
/// The buffer of one part; see flaunay_device_triangulation_buffer.
FLAUNAY_API cl_mem flaunay_device_voronoi_buffer(const flaunay_device_voronoi* voronoi, unsigned part);
/// Computes the dual in device memory. The triangulation must have the parts triangles, neighbors, hull and
/// representatives. The work is enqueued like that of flaunay_triangulate_device, with the same errors. The
/// host waits once, or until cells are mended that would cross themselves but for that.
FLAUNAY_API flaunay_status flaunay_voronoi_compute_device(flaunay_triangulator* triangulator,
                                                          const flaunay_device_points* points,
                                                          const flaunay_device_triangulation* triangulation,
                                                          const flaunay_enqueue* enqueue,
                                                          flaunay_device_voronoi* result);

// ---- Clipped Voronoi cells and relaxation

/// Computes the Voronoi cells of these n points, clipped to a convex polygon: x0 y0 x1 y1 ... for 3 to 16,383
/// corners, counter-clockwise. A corner may lie on the line through its neighbours; cells do not have it
/// then. What vertices cells have is decided exactly; their coordinates are rounded, and those that coincide
/// but for that are one vertex, so that polygons are simple, and tile. The triangulation must have
/// neighbours. A polygon that is not finite, convex and counter-clockwise is FLAUNAY_ERROR_INPUT, with a
/// message that names a corner. The caller destroys the result.
///
/// weights: NULL, or of points with weights: the cells are power cells, of each point the places whose
/// squared distance less the weight is least for it; in the plane the triangulation is of one set then. On a
/// torus, coordinates and n are not read, and corners are NULL: cells are around their points' places, so
/// that some reach beyond the period, and the areas of a set's cells sum to that of the period. A cylinder,
/// where cells have no end, and the sphere are FLAUNAY_ERROR_USAGE.
FLAUNAY_API flaunay_status flaunay_voronoi_clip(flaunay_triangulator* triangulator, const double* coordinates,
                                                const double* weights, size_t n,
                                                const flaunay_triangulation* triangulation,
                                                const double* corners, size_t corner_count,
                                                flaunay_clipped_voronoi** cells);
/// Frees the arrays.
FLAUNAY_API void flaunay_clipped_voronoi_destroy(flaunay_clipped_voronoi* cells);
/// n, the number of points.
FLAUNAY_API size_t flaunay_clipped_voronoi_point_count(const flaunay_clipped_voronoi* cells);
/// v, the number of vertices of all cells.
FLAUNAY_API size_t flaunay_clipped_voronoi_vertex_count(const flaunay_clipped_voronoi* cells);
/// 2 v values, the vertices of each cell counter-clockwise. Those that cells share are the same to the last
/// bit.
FLAUNAY_API const double* flaunay_clipped_voronoi_vertices(const flaunay_clipped_voronoi* cells);
/// n + 1 values: the cell of point i has vertices [offsets[i], offsets[i + 1]). Points that another point
/// represents have none, nor have points whose cells have no area in the polygon, or none but for rounding.
FLAUNAY_API const int32_t* flaunay_clipped_voronoi_offsets(const flaunay_clipped_voronoi* cells);
/// n values; 0 for points whose cells have no area.
FLAUNAY_API const double* flaunay_clipped_voronoi_areas(const flaunay_clipped_voronoi* cells);
/// 2 n values; NaN for these.
FLAUNAY_API const double* flaunay_clipped_voronoi_centroids(const flaunay_clipped_voronoi* cells);
/// Joins the cells of each group to polygons with holes: edges that two cells of a group share cancel,
/// exactly. vertices, v, offsets, n: of n cells, or of other polygons that tile, as above. groups: n values
/// from 0 to group_count - 1. bounds: the bound_count corners of the polygon to which cells are clipped,
/// and which they cover; on its edges, corners at which cells of one group alone meet are left out. Without
/// bounds, all corners stay.
///
/// Arrays of the caller's: corners: v values, which are indices of vertices; ring_offsets, part_offsets:
/// v / 3 + 1 values; group_offsets: group_count + 1 values. Ring r has corners
/// [ring_offsets[r], ring_offsets[r + 1]), and meets no place twice. A part has rings
/// [part_offsets[q], part_offsets[q + 1]): an outer one, counter-clockwise, and then its holes, clockwise.
/// Group g has parts [group_offsets[g], group_offsets[g + 1]). FLAUNAY_ERROR_USAGE for arrays that do not fit
/// each other, FLAUNAY_ERROR_INPUT for vertices that are not finite or differ too much in magnitude. O(n)
/// expected.
FLAUNAY_API flaunay_status flaunay_join_cells(const double* vertices, size_t v, const int32_t* offsets,
                                              size_t n, const int32_t* groups, size_t group_count,
                                              const double* bounds, size_t bound_count, int32_t* corners,
                                              int32_t* ring_offsets, int32_t* part_offsets,
                                              int32_t* group_offsets);

/// Makes an empty result, whose buffers work like those of a flaunay_device_triangulation.
FLAUNAY_API flaunay_status flaunay_device_clipped_voronoi_create(flaunay_device_clipped_voronoi** cells);
/// Releases its buffers; what is enqueued with them goes on.
FLAUNAY_API void flaunay_device_clipped_voronoi_destroy(flaunay_device_clipped_voronoi* cells);
/// Makes later calls write one part, one bit of flaunay_clipped_voronoi_part, to the caller's buffer. Its
/// size must be that given there: there are about 6 vertices per point, as a rule. Otherwise see
/// flaunay_device_triangulation_set_buffer.
FLAUNAY_API flaunay_status flaunay_device_clipped_voronoi_set_buffer(flaunay_device_clipped_voronoi* cells,
                                                                     unsigned part, cl_mem memory);
/// The buffer of one part; see flaunay_device_triangulation_buffer.
FLAUNAY_API cl_mem flaunay_device_clipped_voronoi_buffer(const flaunay_device_clipped_voronoi* cells,
                                                         unsigned part);
/// v, the number of vertices of all cells. It is known when the call returns.
FLAUNAY_API size_t flaunay_device_clipped_voronoi_vertex_count(const flaunay_device_clipped_voronoi* cells);
/// flaunay_voronoi_clip in device memory. The triangulation must have the parts triangles, neighbors, hull
/// and representatives; of several sets, each has cells of its own. The work is enqueued like that of
/// flaunay_triangulate_device, with the same errors. The host waits three times, or until polygons are
/// mended.
FLAUNAY_API flaunay_status flaunay_voronoi_clip_device(flaunay_triangulator* triangulator,
                                                       const flaunay_device_points* points,
                                                       const flaunay_device_triangulation* triangulation,
                                                       const double* corners, size_t corner_count,
                                                       const flaunay_enqueue* enqueue,
                                                       flaunay_device_clipped_voronoi* result);

/// Relaxes n points by Lloyd's method: each moves to the centroid of its Voronoi cell, `iterations` times. A
/// point without a cell stays where it is in that iteration. space: NULL: the plane, where cells are clipped
/// to the polygon, as in flaunay_voronoi_clip; with weights they are power cells. On a torus and the sphere
/// corners is NULL, points move on these and are given back as in the space: places in the period, unit
/// vectors, or degrees. On the sphere they move to the direction of the cell's centroid in space, the sum
/// over its sides of their angles times the normals of their planes; those that stay are given back as they
/// were given. relaxed: room for as many values as points, which may be points itself. Errors are those of
/// flaunay_triangulate and flaunay_voronoi_clip, and FLAUNAY_ERROR_USAGE for a cylinder, where cells have no
/// end.
FLAUNAY_API flaunay_status flaunay_relax(flaunay_triangulator* triangulator, const double* points, size_t n,
                                         const flaunay_space* space, const double* corners,
                                         size_t corner_count, size_t iterations, double* relaxed);
/// Relaxes points of the plane in device memory. *relaxed: the caller's buffer, double2, 16 n bytes, another
/// one than that of the points; if it is NULL, it receives a new one, as in flaunay_locator_locate_device.
/// The work is enqueued like that of flaunay_triangulate_device, with the same errors; points stay on the
/// device.
FLAUNAY_API flaunay_status flaunay_relax_device(flaunay_triangulator* triangulator,
                                                const flaunay_device_points* points, const double* corners,
                                                size_t corner_count, size_t iterations,
                                                const flaunay_enqueue* enqueue, cl_mem* relaxed);

// ---- Rasters and contours

/// The pixels of a raster. The centre of the pixel in row r and column c is (x + c dx, y + r dy), each
/// product and each sum rounded to double precision.
typedef struct flaunay_raster {
  double x;               ///< the centre of the pixel in row 0 and column 0
  double y;               ///< its other coordinate
  double dx;              ///< from a column to the next one; positive
  double dy;              ///< from a row to the next one; negative if north is up
  size_t rows;            ///< less than 2^31
  size_t columns;         ///< less than 2^31
  double max_edge;        ///< pixels in triangles with a longer edge have no value; 0: no edge is too long
  double fill;            ///< of pixels without a value
  uintptr_t reserved[4];  ///< 0
} flaunay_raster;

/// Computes a raster of values at n points by linear interpolation in t counter-clockwise triangles of one
/// set: pixels has room for rows x columns numbers, row by row. neighbors: as FLAUNAY_PART_NEIGHBORS has
/// them. A pixel has the value at its centre; which triangle that lies in is decided exactly. The border
/// belongs to the triangles, and a centre on an edge between two of them to one: to that which it would lie
/// in if it were moved to the right, by less than anything. The raster does not depend on the order of
/// triangles, on the device or on the number of threads. FLAUNAY_ERROR_USAGE for a raster that makes no sense
/// and for triangles of other points; FLAUNAY_ERROR_INPUT for coordinates that are not finite, too large or
/// too fine, and for pixels that are too small for doubles.
FLAUNAY_API flaunay_status flaunay_rasterize(flaunay_triangulator* triangulator, const double* coordinates,
                                             size_t n, const int32_t* triangles, const int32_t* neighbors,
                                             size_t t, const double* values, const flaunay_raster* raster,
                                             double* pixels);

/// How hills are shaded.
typedef struct flaunay_shading {
  double vertical_factor;  ///< by which heights are multiplied; 0: 1
  int is_geographic;       ///< not 0: x and y are longitudes and latitudes in degrees, and heights metres
  int colors;              ///< not 0: by height, from green over yellow and brown to white
  uintptr_t reserved[4];   ///< 0
} flaunay_shading;
/// Draws a raster of heights as hills that are lit from the north-west, 45 degrees high. picture: room for
/// rows x columns bytes of grey, or with colours of red, of green and of blue, and then for as many of alpha,
/// which is 0 where a pixel or one that its slope is taken from is not finite. FLAUNAY_ERROR_USAGE for a
/// factor and a raster that make no sense, FLAUNAY_ERROR_INPUT as of flaunay_rasterize.
FLAUNAY_API flaunay_status flaunay_shade_hills(const flaunay_raster* raster, const double* pixels,
                                               const flaunay_shading* shading, uint8_t* picture);

/// Contour lines.
typedef struct flaunay_contours flaunay_contours;
/// Computes contour lines at so many heights, which must increase, of values at n points that are linear in t
/// counter-clockwise triangles. Higher values are on the left of a line. It is closed, with its first point
/// again at the end, or begins and ends at the border. A value that equals a height counts as above it, so
/// that no two lines cross, but by rounding. No line goes through a point twice or crosses itself: what it
/// does between two visits of a point is a closed line of its own. Triangles with an edge longer than
/// max_edge (0: no edge is too long), or with a value that is not finite, are left out. Results do not depend
/// on the order of triangles. Errors as of flaunay_rasterize. The caller destroys the result.
FLAUNAY_API flaunay_status flaunay_contours_compute(flaunay_triangulator* triangulator,
                                                    const double* coordinates, size_t n,
                                                    const int32_t* triangles, const int32_t* neighbors,
                                                    size_t t, const double* values, const double* heights,
                                                    size_t height_count, double max_edge,
                                                    flaunay_contours** contours);
/// Raster and contours of points that need not fit memory: triangulates them in chunks, as
/// flaunay_triangulate_chunks_to_files does, scans triangles into pixels and traces lines as they become
/// final. Both are those of all triangles, whatever the chunks. duplicates: a flaunay_duplicates. raster: may
/// have no pixels. pixels: as of flaunay_rasterize, such as a file that is mapped into memory. contours: NULL
/// for none; their max_edge is that of the raster. breaklines: become edges of the triangles; NULL for none.
/// Memory of the options does not count pixels, contours and the triangles that breaklines cross. Values take
/// 8 bytes per point in the scratch folder. Errors are those of the functions named and of
/// flaunay_triangulate_constrained, and FLAUNAY_ERROR_INPUT for a value that is not finite. The caller
/// destroys the report and the contours.
FLAUNAY_API flaunay_status flaunay_rasterize_chunks(
    const flaunay_strided_points* points, const flaunay_strided_values* values, int duplicates,
    const flaunay_raster* raster, double* pixels, const double* heights, size_t height_count,
    flaunay_contours** contours, const flaunay_breaklines* breaklines, const flaunay_chunk_options* options,
    flaunay_chunk_report** report);
/// flaunay_rasterize_chunks for points and values that are nowhere in memory as a whole.
FLAUNAY_API flaunay_status flaunay_rasterize_streams(
    const flaunay_point_source* points, const flaunay_value_source* values, int duplicates,
    const flaunay_raster* raster, double* pixels, const double* heights, size_t height_count,
    flaunay_contours** contours, const flaunay_breaklines* breaklines, const flaunay_chunk_options* options,
    flaunay_chunk_report** report);
/// Destroys contours. O(1).
FLAUNAY_API void flaunay_contours_destroy(flaunay_contours* contours);
/// Number of lines.
FLAUNAY_API size_t flaunay_contours_line_count(const flaunay_contours* contours);
/// Lines + 1 values: line i has the points from the i-th to the (i + 1)-th.
FLAUNAY_API const size_t* flaunay_contours_offsets(const flaunay_contours* contours);
/// x and y per point.
FLAUNAY_API const double* flaunay_contours_coordinates(const flaunay_contours* contours);
/// Per line the number of its height. Lines of one height follow each other, in the order of their points.
FLAUNAY_API const int32_t* flaunay_contours_heights(const flaunay_contours* contours);

// ---- Queries

/// Makes a locator for a triangulation of these points, which must have neighbours. offsets and sets: as for
/// flaunay_triangulate. The locator copies what it needs, about 80 bytes of device memory per point. It may
/// outlive the triangulator. O(n log n) work.
///
/// On a torus, a cylinder and the sphere, coordinates, n, offsets and sets are not read. weights: of points
/// with weights on a torus or a cylinder, elsewhere not read. Queries are any places of the plane, and on the
/// sphere given as the points were; they are in host memory.
///
/// Among points with weights it locates, and interpolates within triangles; nearest points (see
/// flaunay_point_tree) and natural neighbours are FLAUNAY_ERROR_USAGE.
///
/// A triangulation with constraints must be of one set. coordinates: of its points and after them those
/// that were added, n together. Queries in no triangle, such as those in holes, are outside; nearest points
/// are those of all points. Natural neighbours are those that can be seen without crossing a constraint
/// (docs/constrained.md).
FLAUNAY_API flaunay_status flaunay_locator_create(flaunay_triangulator* triangulator,
                                                  const double* coordinates, const double* weights, size_t n,
                                                  const size_t* offsets, size_t sets,
                                                  const flaunay_triangulation* triangulation,
                                                  flaunay_locator** locator);
/// Makes a locator for points and a triangulation in device memory, which must have the parts triangles,
/// neighbors, hull and representatives. The work is enqueued like that of flaunay_triangulate_device, with
/// the same errors.
FLAUNAY_API flaunay_status flaunay_locator_create_device(flaunay_triangulator* triangulator,
                                                         const flaunay_device_points* points,
                                                         const flaunay_device_triangulation* triangulation,
                                                         const flaunay_enqueue* enqueue,
                                                         flaunay_locator** locator);
/// Releases its memory.
FLAUNAY_API void flaunay_locator_destroy(flaunay_locator* locator);
/// Makes later queries on the sphere be given so: coordinates: a flaunay_sphere_coordinates.
/// FLAUNAY_ERROR_USAGE in other spaces.
FLAUNAY_API flaunay_status flaunay_locator_set_coordinates(flaunay_locator* locator, int coordinates);

/// Finds for each of m queries, x0 y0 x1 y1 ..., the triangle that contains it, exactly. On an edge or a
/// vertex it is the triangle of the smallest index that contains the query, on a torus always the same one;
/// outside of the hull, beyond the ends of a cylinder, and beyond a set that lies within a hemisphere it is
/// -1. triangles: m values of the caller's. If the triangulation has several sets, there must be as many sets
/// of queries, each for the set of the same number. offsets: NULL for one set, otherwise sets + 1 offsets
/// from 0 to m. FLAUNAY_ERROR_INPUT for a query that is not finite, or whose coordinates are too fine for
/// exact arithmetic in doubles. About O(log n) per query.
FLAUNAY_API flaunay_status flaunay_locator_locate(flaunay_locator* locator, const double* queries, size_t m,
                                                  const size_t* offsets, size_t sets, int32_t* triangles);
/// Finds for each query the index of the nearest point, by exact comparisons. If several points are nearest,
/// it is the first of them in the order of x, then y, on a torus as they lie around the query's place, and on
/// the sphere the south pole, or else the smallest place. It is -1 if the set is empty. About O(log n) per
/// query is expected, except at a vertex with very many neighbours that are all about as near and not
/// cocircular. points: m values of the caller's. The other arguments and the errors are those of
/// flaunay_locator_locate.
FLAUNAY_API flaunay_status flaunay_locator_nearest(flaunay_locator* locator, const double* queries, size_t m,
                                                   const size_t* offsets, size_t sets, int32_t* points);
/// flaunay_locator_locate for queries in device memory, enqueued like flaunay_triangulate_device. *triangles:
/// the caller's buffer, int32, 4 m bytes. If *triangles is NULL, it receives a new buffer, which the caller
/// releases; it stays NULL if the call fails or if there are no queries.
FLAUNAY_API flaunay_status flaunay_locator_locate_device(flaunay_locator* locator,
                                                         const flaunay_device_points* queries,
                                                         const flaunay_enqueue* enqueue, cl_mem* triangles);
/// flaunay_locator_nearest for queries in device memory; see flaunay_locator_locate_device.
FLAUNAY_API flaunay_status flaunay_locator_nearest_device(flaunay_locator* locator,
                                                          const flaunay_device_points* queries,
                                                          const flaunay_enqueue* enqueue, cl_mem* points);
/// Points arranged for queries for the nearest ones of them.
typedef struct flaunay_point_tree flaunay_point_tree;
/// Makes a tree of n points in host memory, x0 y0 x1 y1 ..., which needs no triangulation. It shares threads
/// with the triangulator, and may outlive it. FLAUNAY_ERROR_INPUT as of flaunay_triangulate. O(n log n) work.
FLAUNAY_API flaunay_status flaunay_point_tree_create(flaunay_triangulator* triangulator,
                                                     const double* coordinates, size_t n,
                                                     flaunay_point_tree** tree);
/// Makes a tree of one set of points on a torus, a cylinder or the sphere. On a torus and a cylinder, queries
/// are any places of the plane, and each point counts once, as it lies nearest. On the sphere, queries are
/// given as the points were, distances, also the largest one, are angles in radians, and of points that are
/// as near the south pole is first, or else the one with the smallest place. FLAUNAY_ERROR_USAGE for several
/// sets and for the plane. O(n log n).
FLAUNAY_API flaunay_status flaunay_point_tree_create_in_space(flaunay_triangulator* triangulator,
                                                              const flaunay_triangulation* triangulation,
                                                              flaunay_point_tree** tree);
/// As flaunay_locator_set_coordinates.
FLAUNAY_API flaunay_status flaunay_point_tree_set_coordinates(flaunay_point_tree* tree, int coordinates);
/// Destroys a tree. O(1).
FLAUNAY_API void flaunay_point_tree_destroy(flaunay_point_tree* tree);
/// Finds for each of m queries the `count` nearest points, the nearest first, by exact comparisons. Of points
/// that are as near, the first in the order of x, then y, then index is first. Those whose distance, rounded,
/// is larger than max_distance (INFINITY for none) are left out. points, distances: room for m count values,
/// -1 and INFINITY where there are no more points; distances may be NULL. FLAUNAY_ERROR_INPUT as of
/// flaunay_locator_nearest. About O(log n + count log count) per query is expected.
FLAUNAY_API flaunay_status flaunay_point_tree_nearest(flaunay_point_tree* tree, const double* queries,
                                                      size_t m, size_t count, double max_distance,
                                                      int32_t* points, double* distances);
// ---- Interpolation

/// Interpolates by any method, several numbers per point at once. values: one row of options->columns numbers
/// per input point; results: one row per query, the caller's. options: NULL for the defaults. At a point,
/// every method gives exactly that point's values; for duplicates, those of their representative are used. On
/// the sphere, linear interpolation is the value where the direction of the query meets the triangle in
/// space; Clough-Tocher stands for Renka's interpolant (1984), of cubics along great circles with a
/// continuous gradient; and natural neighbours (Brown, 1994) have areas of cells on the sphere, and lengths
/// of arcs. Natural neighbours of so few points on a torus that a circle without points is wider than the
/// shorter period, on a cylinder one with its centre between the ends, are FLAUNAY_ERROR_INPUT. The other
/// arguments and the errors are those of flaunay_locator_locate.
FLAUNAY_API flaunay_status flaunay_locator_interpolate(flaunay_locator* locator, const double* values,
                                                       const double* queries, size_t m, const size_t* offsets,
                                                       size_t sets,
                                                       const flaunay_interpolation_options* options,
                                                       double* results);
/// flaunay_locator_interpolate for values and queries in device memory; see
/// flaunay_locator_locate_device. values and *results: double, 8 bytes per number.
FLAUNAY_API flaunay_status flaunay_locator_interpolate_device(flaunay_locator* locator, cl_mem values,
                                                              const flaunay_device_points* queries,
                                                              const flaunay_interpolation_options* options,
                                                              const flaunay_enqueue* enqueue,
                                                              cl_mem* results);
/// The natural neighbours of queries and their weights.
typedef struct flaunay_natural_weights flaunay_natural_weights;
/// Computes the weights by which FLAUNAY_INTERPOLATION_SIBSON or _LAPLACE interpolates any values at m
/// queries in host memory, in a triangulation of one set; queries outside have none. The caller destroys the
/// result. Errors are those of flaunay_locator_locate.
FLAUNAY_API flaunay_status flaunay_natural_weights_compute(flaunay_locator* locator, const double* queries,
                                                           size_t m, int method,
                                                           flaunay_natural_weights** weights);
/// Destroys weights. O(1).
FLAUNAY_API void flaunay_natural_weights_destroy(flaunay_natural_weights* weights);
/// m + 1 values: query i has the points and weights from the i-th to the (i + 1)-th.
FLAUNAY_API const size_t* flaunay_natural_weights_offsets(const flaunay_natural_weights* weights);
/// Points, without an order; of duplicates the representative. On a torus or a cylinder a point can be there
/// several times.
FLAUNAY_API const int32_t* flaunay_natural_weights_points(const flaunay_natural_weights* weights);
/// The weight of each, 0 or more, with the sum 1 per query.
FLAUNAY_API const double* flaunay_natural_weights_weights(const flaunay_natural_weights* weights);
/// Estimates the gradients of values at the points, so that the curvature along all edges is least (Nielson,
/// 1983; Renka and Cline, 1984). values: one row of options->columns numbers per input point. gradients: x
/// and y per number, on the sphere x, y and z of a vector that is tangent there, the caller's array. They are
/// NaN at points that another one represents, at hidden ones, and at those of a set without triangles. Of the
/// options, columns and those of gradients count. NULL: the defaults.
FLAUNAY_API flaunay_status flaunay_locator_gradients(flaunay_locator* locator, const double* values,
                                                     const flaunay_interpolation_options* options,
                                                     double* gradients);
/// flaunay_locator_gradients for values in device memory, enqueued like flaunay_triangulate_device.
/// *gradients: double, 16 bytes per number; see flaunay_locator_locate_device.
FLAUNAY_API flaunay_status flaunay_locator_gradients_device(flaunay_locator* locator, cl_mem values,
                                                            const flaunay_interpolation_options* options,
                                                            const flaunay_enqueue* enqueue,
                                                            cl_mem* gradients);

#ifdef __cplusplus
}
#endif

#endif  // FLAUNAY_H
