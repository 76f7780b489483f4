#include "constrained/refinement/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "arithmetic/coordinates.h"
#include "constrained/refinement/angles.hpp"
#include "constrained/refinement/bounds.hpp"
#include "constrained/refinement/cuts.hpp"
#include "constrained/refinement/smooth.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/predicates.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/refinement/blocks.cl.hpp"
#include "launchers/refinement/tests.cl.hpp"
#include "points/download.hpp"
#include "predicates/quality.h"
#include "refinement/codes.h"
#include "refinement/limits.h"
#include "refinement/records.h"

namespace flaunay::constrained {

static_assert(static_cast<int>(Excuse::input_angle) == kernel::EXCUSED_INPUT_ANGLE);
static_assert(static_cast<int>(Excuse::near_apex) == kernel::EXCUSED_NEAR_APEX);
static_assert(static_cast<int>(Excuse::min_edge) == kernel::EXCUSED_MIN_EDGE);
static_assert(static_cast<int>(Excuse::kept) == kernel::EXCUSED_KEPT);
static_assert(static_cast<int>(Excuse::frozen) == kernel::EXCUSED_FROZEN);
static_assert(static_cast<int>(Excuse::most_points) == kernel::EXCUSED_LIMIT);

namespace {

using host::Arena;
using host::Buffer;
using kernel::double2;
using kernel::edge_place;
using kernel::mesh_row;

// A block inserts at most this many points per bad triangle in a phase. The result depends on this.
constexpr std::size_t kMostPerTriangle = 16;
// A phase that adds fewer points than this part of its bad triangles makes the blocks of the next one larger.
constexpr double kLeastProgress = 0.1;
// Without areas, a mesh with bad triangles for at most this many blocks is a single block: that makes fewer
// points, and takes one thread less time.
constexpr std::size_t kBlocksAlone = 8;
// One bad triangle in this many is a sample for cutting the plane: in the first phase, which cuts at medians,
// and later.
constexpr std::size_t kFirstSample = 8, kLaterSample = 4;
// Areas decrease in levels. Each level's area is smaller by the factor kLevelStep; the next level begins when
// the share kLevelRest of a level is left.
constexpr int kLevelPlaces = 4;
constexpr double kLevelStep = 1 << kLevelPlaces, kLevelRest = 0.1;
// Triangles with a circumradius above this part of the size of their block are cut before.
constexpr double kScaffold = 0.5;
// Blocks at once, on devices; natively, as many as threads. A block's lists have kLeastRoom places at first.
constexpr std::size_t kBlocksAtOnce = 256, kLeastRoom = 2048;
// A launch has room for this many chunks of rows and of vertices, or for one per block.
constexpr std::size_t kLeastChunks = 4;
// From this many rows on, less spare room is reserved.
constexpr std::size_t kManyRows = std::size_t{1} << 20;
// A thread takes at least this many rows.
constexpr std::size_t kFewRows = std::size_t{1} << 14;
// 2 to the power of this many vertices, and the rows around them, fit a core's cache.
constexpr int kBucketBits = 13;
// If loops of a work-item must be short, a launch takes this many steps of each block.
constexpr int kFewSteps = 500;
// Smoothing makes no smaller angles, whatever is asked for.
constexpr double kSmoothedAngle = 20;
// The smallest edge unless the caller has one: 2^-40 of the larger side of the bounding box, or 2^-48 of the
// largest coordinate if that is more, which is at least 16 units in the last place of any coordinate. With
// 2^-45 of the largest coordinate, rounding moves points by less than 2 % of the smallest edge.
constexpr int kMinEdgeOfExtent = -40, kMinEdgeOfLargest = -48, kFineOfLargest = -45;
// Added points have multiples of 2^(e - kBinaryPlaces), with 2^e the largest coordinate's power of two.
constexpr int kBinaryPlaces = 200;
// Their corners are counted by ints.
constexpr std::size_t kMostTriangles = std::size_t{1} << 29;

// The mesh. Arrays have room for more.
struct Arrays {
  Buffer<mesh_row> rows{};
  Buffer<cl_uchar> states{};
  Buffer<cl_double> areas{};
  Buffer<cl_double2> points{};
  Buffer<edge_place> places{};
  Buffer<cl_int2> births{};  // the blocks that made vertices, and their numbers there
};

// The lists of work-items.
struct Lists {
  Buffer<cl_int> heads{}, tails{}, cavities{};
  Buffer<kernel::block_task> tasks{};
  Buffer<kernel::dug_side> stacks{};
  Buffer<kernel::star_side> sides{};
  Buffer<kernel::first_task> firsts{};
};

// The bounding box of places.
struct Box {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};

  void add(const double* place) {
    for (int k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], place[k]);
      high[k] = std::max(high[k], place[k]);
    }
  }
  double extent() const { return std::max(high[0] - low[0], high[1] - low[1]); }
};

// Where an array is, if kernels run natively.
template <typename T>
T* address_in(const Buffer<T>& array) {
  return reinterpret_cast<T*>(host::address_of(array.memory()));
}

// The elements of an array: in place if kernels run natively, otherwise a copy.
template <typename T>
class Here {
 public:
  Here(host::Runtime& runtime, const Buffer<T>& array, std::size_t count) {
    if (!runtime.is_native()) copy_ = points::download(runtime, array, count);
    values_ = runtime.is_native() ? address_in(array) : copy_.data();
  }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::vector<T> copy_;
  const T* values_;
};

class Refining {
 public:
  Refining(host::Runtime& runtime, const MeshToRefine& mesh, const Refinement& wanted, std::size_t block)
      : runtime_(runtime), arena_(runtime.arena()), mesh_(mesh), wanted_(wanted), block_(block) {
    scale();
    set_rules();
  }

  RefinedMesh run() {
    upload();
    if (!wanted_.is_wanted() && mesh_.largest_areas.empty()) return result();
    mend(false);
    if (wanted_.smoothing_steps > 0) put_in_order();
    if (wanted_.smoothing_steps > 0) measure_before_smoothing();
    for (std::size_t step = 0; step < wanted_.smoothing_steps && !is_at_limit(); ++step) {
      smooth_once();
      mend(true);
      put_in_order();
    }
    return result();
  }

 private:
  bool is_at_limit() const { return report_.rounds >= wanted_.most_rounds || added_ >= wanted_.most_points; }

  // Makes phases as long as they help. has_moved: whether constraints may have thawed before.
  void mend(bool has_moved) {
    bool may_thaw = has_moved;
    do {
      const std::size_t before = added_;
      find_areas();
      test(true);
      make_phases(true);
      test(false);
      make_phases(false);
      may_thaw |= added_ > before;
    } while (!is_at_limit() && std::exchange(may_thaw, false) && retry_frozen());
  }

  // Constraints that could not be split beside flat triangles may be since these changed. Tries triangles
  // that were refused for such a constraint again; returns whether there are some.
  bool retry_frozen() {
    Arena::Scope scope(arena_);
    const auto is_tried = arena_.allocate<cl_uchar>(rows_);
    runtime_.map(rows_, kernels::retry_frozen{.states = arrays_.states, .is_tried = is_tried});
    return host::pack_positions(runtime_, is_tried, rows_, 1).second > 0;
  }

  // -------------------------------------------------------------------------------------------------------
  // Before and after

  // The largest coordinate is brought to just below 1, whatever it is, so that results for the same points in
  // other units that are a power of two apart are the same; only the lowest bit of points that span more
  // binary places than there are below 1 decides first.
  void scale() {
    const geometry::Magnitudes magnitudes = geometry::inspect(mesh_.coordinates, 0, mesh_.points);
    geometry::scaling_for(mesh_.coordinates, 0, mesh_.points, magnitudes);  // throws if no scaling fits
    if (geometry::bits_of(magnitudes) > 0)
      shift_ = std::max(-1 - magnitudes.largest, kernel::LOWEST_EXPONENT - magnitudes.lowest);
    // The last binary place that new coordinates have, scaled: exact in predicates, and a double when scaled
    // back.
    const int lowest = std::max({magnitudes.largest + shift_ - kBinaryPlaces, int{kernel::LOWEST_EXPONENT},
                                 shift_ + std::numeric_limits<double>::min_exponent - kernel::DOUBLE_BITS});
    rules_.coarse = std::ldexp(1.0, lowest + kernel::DOUBLE_BITS - 1);
    order_vertices();
    points_.resize(mesh_.points);
    scale_ = kernel::scale_of(shift_);
    if (mesh_.points == 0) return;
    std::vector<Box> boxes((mesh_.points - 1) / host::Runtime::kPart + 1);
    runtime_.share_parts(mesh_.points, [&](std::size_t begin, std::size_t end) {
      Box box;
      for (std::size_t i = begin; i < end; ++i) {
        double at[2];
        for (int k = 0; k < 2; ++k) at[k] = kernel::scaled(mesh_.coordinates[2 * i + k], scale_) + 0.0;
        box.add(at);
        points_[place_of_[i]] = {at[0], at[1]};
      }
      boxes[begin / host::Runtime::kPart] = box;
    });
    for (const Box& box : boxes) {
      boxes[0].add(box.low);
      boxes[0].add(box.high);
    }
    extent_ = boxes[0].extent();
    for (int k = 0; k < 2; ++k)
      largest_ = std::max({largest_, std::fabs(boxes[0].low[k]), std::fabs(boxes[0].high[k])});
  }

  // An area that is too small to be scaled is still one: no triangle is as small.
  double scaled_area(double area) const {
    const double scaled = std::ldexp(area, 2 * shift_);
    return area > 0 ? std::max(scaled, std::numeric_limits<double>::min()) : scaled;
  }

  // Numbers vertices in the order of triangles, which follow their places in the plane more or less: vertices
  // used together are close in memory.
  void order_vertices() {
    place_of_.assign(mesh_.points, -1);
    std::int32_t next = 0;
    const auto number = [&](std::int32_t& place) {
      if (place < 0) place = next++;
    };
    for (const std::int32_t v : mesh_.triangles) number(place_of_[v]);
    for (std::int32_t& place : place_of_) number(place);
  }
  std::vector<std::int32_t> places_of(const std::vector<std::int32_t>& vertices) const {
    std::vector<std::int32_t> places(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) places[i] = place_of_[vertices[i]];
    return places;
  }

  void set_rules() {
    const QualityBounds bounds = quality_bounds(wanted_.min_angle);
    check_areas(&wanted_.max_area, 1, "max_area");
    check_areas(mesh_.largest_areas.data(), mesh_.largest_areas.size(), "largest areas");
    rules_.squared_sine = bounds.squared_sine;
    rules_.off_centre = bounds.off_centre;
    rules_.squared_cosine = wanted_.conforming ? 0 : bounds.squared_cosine;
    rules_.area = scaled_area(wanted_.max_area);
    const double min_edge = wanted_.min_edge >= 0 ? std::ldexp(wanted_.min_edge, shift_)
                                                  : std::max(std::ldexp(extent_, kMinEdgeOfExtent),
                                                             std::ldexp(largest_, kMinEdgeOfLargest));
    rules_.min_edge = min_edge * min_edge;
    rules_.long_edge = min_edge >= std::ldexp(largest_, kFineOfLargest) ? 36 * rules_.min_edge : HUGE_VAL;
    rules_.area_kind = wanted_.areas_at               ? kernel::AREAS_BY_ROW
                       : !mesh_.largest_areas.empty() ? kernel::AREAS_BY_PARENT
                                                      : kernel::AREAS_NONE;
    // Squares of lengths are below 2 extent^2. The classes distinguish shortest sides down to 2^-100 of that.
    rules_.least_class =
        8 * (2 * (extent_ > 0 ? std::ilogb(extent_) : 0) + 1023 + 3) - kernel::TASK_CLASSES / 2;
    rules_.vertices = static_cast<int>(mesh_.points);
  }

  // The ends of edges, 2 per edge, the lexicographically smaller one first.
  std::vector<std::int32_t> ordered_ends() const {
    std::vector<std::int32_t> ends = places_of(mesh_.edge_ends);
    for (std::size_t e = 0; 2 * e < ends.size(); ++e) {
      if (kernel::comes_before(points_[ends[2 * e + 1]], points_[ends[2 * e]])) {
        std::swap(ends[2 * e], ends[2 * e + 1]);
      }
    }
    return ends;
  }

  // The other ends of edges at apexes. If a vertex has several apexes, the lexicographically first one
  // counts. ends: 2 per edge.
  void add_far_ends(const std::vector<std::int32_t>& ends, std::vector<edge_place>& places) const {
    const auto is_apex = [&](std::int32_t v) { return places[v].apex == v; };
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const std::int32_t v = ends[i], apex = ends[i ^ 1];
      edge_place& place = places[v];
      if (is_apex(v) || !is_apex(apex)) continue;
      if (place.apex >= 0 && !kernel::comes_before(points_[apex], points_[place.apex])) continue;
      place.apex = apex;
      place.edge = static_cast<int>(i / 2);
      place.distance = std::sqrt(kernel::squared_length(points_[v] - points_[apex]));
    }
  }

  // For each end of an edge the next edge counter-clockwise around it, or -1 if no triangles are between.
  // Vertices at which two edges meet so at a sharp angle are apexes.
  std::vector<std::int32_t> wedges_at(const std::vector<std::int32_t>& ends,
                                      std::vector<std::int32_t>& apexes) const {
    std::vector<std::int32_t> wedges(ends.size(), -1);
    const std::int32_t* const triangles = mesh_.triangles.data();
    for (int before = 0; before < static_cast<int>(mesh_.triangles.size()); ++before) {
      const int edge = mesh_.edges[before];
      if (edge < 0) continue;
      const int corner = geometry::next_halfedge(before);
      int last = geometry::next_halfedge(corner);  // opposite to the side that comes next
      while (mesh_.edges[last] < 0) {
        const std::int32_t* const beyond = triangles + 3 * mesh_.neighbors[last];
        const int k = beyond[1] == triangles[corner] ? 1 : 0, at = beyond[2] == triangles[corner] ? 2 : k;
        last = 3 * mesh_.neighbors[last] + kernel::next_corner(at);
      }
      const std::int32_t v = place_of_[triangles[corner]];
      wedges[ends[2 * edge] == v ? 2 * edge : 2 * edge + 1] = mesh_.edges[last];
      const auto beside = [&](int c) { return points_[place_of_[triangles[geometry::next_halfedge(c)]]]; };
      const double2 at = points_[v], from = beside(corner), to = beside(last);
      const bool is_convex = kernel::orient_sign(at, from, to, ORIENT_BOUND) > 0;
      if (is_convex && kernel::is_sharp(at, from, to) != 0) apexes.push_back(v);
    }
    return wedges;
  }

  void upload() {
    rows_ = mesh_.triangles.size() / 3;
    vertices_ = mesh_.points;
    std::vector<std::int32_t> ends = ordered_ends(), apexes, wedges = wedges_at(ends, apexes);
    rules_.has_apexes = apexes.empty() ? 0 : 1;
    std::vector<edge_place> places;
    if (!apexes.empty()) {
      places.assign(mesh_.points, edge_place{0, 0, -1, -1});
      for (const std::int32_t v : apexes) places[v].apex = v;
      add_far_ends(ends, places);
    }
    ends_ = runtime_.upload(arena_, std::move(ends));
    wedges_ = runtime_.upload(arena_, std::move(wedges));
    names_ = arena_.allocate<cl_int>(mesh_.points);
    // With lists of the first phase's size.
    is_starting_ = runtime_.is_native();
    if (is_starting_ && rows_ <= kFewRows) reserve_lists(1, kLeastRoom, false);
    reserve(rows_ + kLeastChunks * kernel::ROWS_PER_CHUNK,
            vertices_ + kLeastChunks * kernel::VERTICES_PER_CHUNK);
    is_starting_ = false;
    known_ = vertices_;
    start_blocks();
    {
      Arena::Scope scope(arena_);
      const bool has_kept = !mesh_.kept_edges.empty();
      const auto view = [&](const auto& values) { return runtime_.view(values.data(), values.size()); };
      const bool is_there = mesh_.triangles_there.size() > 0;
      const auto numbers = view(place_of_);
      const auto coordinates =
          is_there ? mesh_.coordinates_there : runtime_.view(mesh_.coordinates, 2 * mesh_.points);
      runtime_.map(rows_,
                   kernels::load_rows{.has_kept = has_kept ? 1 : 0,
                                      .triangles = is_there ? mesh_.triangles_there : view(mesh_.triangles),
                                      .neighbors = is_there ? mesh_.neighbors_there : view(mesh_.neighbors),
                                      .edges = upload_edges(),
                                      .kept = has_kept ? view(mesh_.kept_edges) : arrays_.states,
                                      .numbers = numbers,
                                      .rows = arrays_.rows,
                                      .states = arrays_.states});
      runtime_.map(vertices_, kernels::load_vertices{.scale = scale_,
                                                     .coordinates = coordinates,
                                                     .numbers = numbers,
                                                     .points = arrays_.points,
                                                     .names = names_,
                                                     .births = arrays_.births,
                                                     .places = arrays_.places});
      std::vector<cl_int> vertices;
      std::vector<edge_place> at_apexes;
      for (std::size_t v = 0; v < places.size(); ++v) {
        if (places[v].apex < 0) continue;
        vertices.push_back(static_cast<cl_int>(v));
        at_apexes.push_back(places[v]);
      }
      const std::size_t count = vertices.size();
      if (count > 0) {
        runtime_.map(count, kernels::place_apexes{.vertices = runtime_.upload(arena_, std::move(vertices)),
                                                  .at_apexes = runtime_.upload(arena_, std::move(at_apexes)),
                                                  .places = arrays_.places});
      }
      runtime_.finish();
    }
    if (!mesh_.largest_areas.empty()) {
      std::vector<double> areas = mesh_.largest_areas;
      for (double& area : areas) area = scaled_area(area);
      parent_areas_ = runtime_.upload(arena_, std::move(areas));
      if (areas_differ_within_regions()) {
        given_ = arena_.allocate<mesh_row>(rows_);
        runtime_.copy(arrays_.rows, 0, given_, 0, rows_);
        rules_.has_given = 1;
      }
    } else {
      parent_areas_ = arena_.allocate<cl_double>(1);  // nobody reads it
    }
  }

  // The edge opposite to each corner. Few have one, so that only these are sent to a device.
  Buffer<cl_int> upload_edges() {
    if (runtime_.sizes().in_host_memory) return runtime_.view(mesh_.edges.data(), mesh_.edges.size());
    std::vector<cl_int2> corners;
    for (std::size_t c = 0; c < mesh_.edges.size(); ++c) {
      if (mesh_.edges[c] >= 0) corners.push_back({{static_cast<cl_int>(c), mesh_.edges[c]}});
    }
    const std::size_t count = corners.size();
    const auto edges = arena_.allocate<cl_int>(mesh_.edges.size());
    runtime_.fill(edges, mesh_.edges.size(), cl_int{-1});
    runtime_.map(
        count, kernels::place_edges{.corners = runtime_.upload(arena_, std::move(corners)), .edges = edges});
    return edges;
  }

  bool areas_differ_within_regions() const {
    for (std::size_t c = 0; c < mesh_.edges.size(); ++c) {
      if (mesh_.edges[c] < 0 && mesh_.largest_areas[c / 3] != mesh_.largest_areas[mesh_.neighbors[c]])
        return true;
    }
    return false;
  }

  // A new array. First arrays of a small mesh come from the arena, which takes less time.
  template <typename T>
  Buffer<T> make(std::size_t size) {
    if (is_starting_) return arena_.allocate<T>(size);
    return {host::allocate_memory(runtime_.memory(), size * sizeof(T)), size};
  }
  template <typename T>
  void grow(Buffer<T>& array, std::size_t used, std::size_t size) {
    const Buffer<T> larger = make<T>(size);
    runtime_.copy(array, 0, larger, 0, std::min(used, array.size()));
    array = larger;
  }
  // Adds room that is likely to be needed later. Natively, unused memory costs nothing, but must be
  // available; most polygons take less than six times as many rows as at first.
  std::size_t with_spare(std::size_t count) const {
    if (!runtime_.is_native()) return count + count / 2;
    return (is_starting_ && count < kManyRows ? 6 : 3) * count;
  }

  void reserve(std::size_t rows, std::size_t vertices) {
    if (rows > row_room_) {
      if (rows > kMostTriangles) {
        throw Error(ErrorKind::input,
                    fmt::format("refining takes more than {} triangles: ask for larger angles or areas, "
                                "or set a limit of points",
                                kMostTriangles));
      }
      const std::size_t size = std::min(kMostTriangles, with_spare(rows));
      grow(arrays_.rows, rows_, size);
      grow(arrays_.states, rows_, size);
      if (rules_.area_kind == kernel::AREAS_BY_ROW) grow(arrays_.areas, rows_, size);
      row_room_ = size;
    }
    if (vertices > vertex_room_) {
      const std::size_t size = with_spare(vertices);
      grow(arrays_.points, vertices_, size);
      grow(arrays_.places, vertices_, size);
      grow(arrays_.births, vertices_, size);
      vertex_room_ = size;
    }
  }

  kernels::refined_mesh refined_mesh() const {
    return {.rows = arrays_.rows,
            .points = arrays_.points,
            .places = arrays_.places,
            .ends = ends_,
            .wedges = wedges_,
            .areas = rules_.area_kind == kernel::AREAS_BY_ROW ? arrays_.areas : parent_areas_};
  }

  // -------------------------------------------------------------------------------------------------------
  // Tests

  // Tests all rows for encroached constraints, or also for bad triangles.
  void test(bool segments_only) {
    runtime_.map_in_small_groups(rows_, kernels::test_rows{.segments_only = segments_only ? 1 : 0,
                                                           .rules = rules_,
                                                           .refined_mesh = refined_mesh(),
                                                           .states = arrays_.states});
  }

  // The number of parts in which threads share rows natively.
  std::size_t parts_of_rows() const { return 1 + std::min(4 * (runtime_.threads() - 1), rows_ / kFewRows); }

  // Rows whose states have a bit of a mask.
  std::pair<Buffer<cl_int>, std::size_t> rows_with(int mask) {
    if (!runtime_.is_native()) {
      const auto flags = arena_.allocate<cl_uchar>(rows_);
      runtime_.map(rows_, kernels::mark_pending{.mask = mask, .states = arrays_.states, .flags = flags});
      return host::pack_positions(runtime_, flags, rows_, 1);
    }
    const cl_uchar* const states = address_in(arrays_.states);
    const std::size_t parts = parts_of_rows();
    std::vector<std::size_t> to(parts + 1, 0);
    const auto first_of = [&](std::size_t part) { return rows_ * part / parts; };
    runtime_.share(parts, [&](std::size_t part) {
      to[part + 1] =
          static_cast<std::size_t>(std::count_if(states + first_of(part), states + first_of(part + 1),
                                                 [mask](cl_uchar state) { return (state & mask) != 0; }));
    });
    std::partial_sum(to.begin(), to.end(), to.begin());
    const auto list = arena_.allocate<cl_int>(to[parts] + 1);
    runtime_.share(parts, [&](std::size_t part) {
      cl_int* at = address_in(list) + to[part];
      for (std::size_t row = first_of(part); at < address_in(list) + to[part + 1]; ++row) {
        *at = static_cast<cl_int>(row);
        at += (states[row] & mask) != 0 ? 1 : 0;
      }
    });
    return {list, to[parts]};
  }

  // Finds the largest areas of new rows: their parents' areas, and the results of the caller's function.
  void find_areas() {
    if (given_.size() == 0 && !wanted_.areas_at) return;
    Arena::Scope scope(arena_);
    const auto [list, count] = rows_with(kernel::ROW_NEW);
    if (count == 0) return;
    if (given_.size() > 0) {
      runtime_.map_in_small_groups(count, kernels::find_parents{.rules = rules_,
                                                                .list = list,
                                                                .given = given_,
                                                                .points = arrays_.points,
                                                                .rows = arrays_.rows});
    }
    if (!wanted_.areas_at) return;
    const auto centroids = arena_.allocate<cl_double2>(count);
    runtime_.map_in_small_groups(
        count,
        kernels::write_centroids{.list = list, .refined_mesh = refined_mesh(), .centroids = centroids});
    std::vector<double> places = points::download(runtime_, centroids.as<cl_double>(), 2 * count),
                        areas(count);
    for (double& x : places) x = std::ldexp(x, -shift_);
    wanted_.areas_at(places.data(), count, areas.data());
    check_areas(areas.data(), areas.size(), "areas");
    for (double& area : areas) area = scaled_area(area);
    runtime_.map_in_small_groups(count, kernels::set_areas{.has_parents = mesh_.largest_areas.empty() ? 0 : 1,
                                                           .rules = rules_,
                                                           .list = list,
                                                           .rows = arrays_.rows,
                                                           .points = arrays_.points,
                                                           .given = runtime_.upload(arena_, std::move(areas)),
                                                           .parent_areas = parent_areas_,
                                                           .areas = arrays_.areas,
                                                           .states = arrays_.states});
    runtime_.finish();
  }

  // -------------------------------------------------------------------------------------------------------
  // Phases

  // Rows with pending work, and their properties.
  struct Pending {
    std::size_t count = 0;
    Buffer<cl_int> list{};
    Buffer<cl_double2> middles{};
    Buffer<cl_double> radii{};
    Buffer<cl_uchar> is_sampled{};
  };

  // sample: one row in this many is sampled; a power of two.
  Pending describe(const Buffer<cl_int>& list, std::size_t count, std::size_t sample) {
    Pending all{count, list, arena_.allocate<cl_double2>(count), arena_.allocate<cl_double>(count),
                arena_.allocate<cl_uchar>(count)};
    runtime_.map_in_small_groups(count, kernels::describe_rows{.mask = static_cast<cl_uint>(sample - 1),
                                                               .list = list,
                                                               .refined_mesh = refined_mesh(),
                                                               .middles = all.middles,
                                                               .radii = all.radii,
                                                               .is_sampled = all.is_sampled});
    runtime_.finish();
    return all;
  }

  bool has_areas() const { return rules_.area_kind != kernel::AREAS_NONE || rules_.area > 0; }

  // The levels of area of a series of phases: a triangle acts if it exceeds the current one.
  struct Levels {
    int current = -1;
    std::size_t at_first = 0;
  };

  // Goes down to the next level if this one is done. Returns the rows that act.
  std::pair<Buffer<cl_int>, std::size_t> rows_at_level(const Buffer<cl_int>& list, std::size_t count,
                                                       Levels& levels) {
    // New triangles of a phase have no areas by places, so that there each level is a factor of two.
    if (rules_.area_kind == kernel::AREAS_BY_ROW || !has_areas()) levels.current = 0;
    if (levels.current == 0) return {list, count};
    const auto found = arena_.allocate<cl_uchar>(count);
    runtime_.map_in_small_groups(count, kernels::find_levels{.rules = rules_,
                                                             .step = kLevelStep,
                                                             .list = list,
                                                             .refined_mesh = refined_mesh(),
                                                             .levels = found});
    runtime_.finish();
    const Here<cl_uchar> of(runtime_, found, count);
    std::array<std::size_t, 257> counts{};
    for (std::size_t i = 0; i < count; ++i) ++counts[of[i]];
    const auto acting = [&] {
      std::size_t sum = counts[0];
      for (std::size_t k = static_cast<std::size_t>(levels.current) + 1; k < counts.size(); ++k)
        sum += counts[k];
      return sum;
    };
    if (levels.current < 0) {
      levels.current = 255;
      while (levels.current > 0 && counts[static_cast<std::size_t>(levels.current)] == 0) --levels.current;
    }
    while (levels.current > 0 &&
           static_cast<double>(acting()) <= kLevelRest * static_cast<double>(levels.at_first)) {
      --levels.current;
      levels.at_first = acting();
    }
    if (levels.current == 0) return {list, count};
    const Here<cl_int> rows(runtime_, list, count);
    std::vector<cl_int> chosen;
    for (std::size_t i = 0; i < count; ++i) {
      if (of[i] == 0 || of[i] > levels.current) chosen.push_back(rows[i]);
    }
    const std::size_t size = chosen.size();
    const auto at_level = runtime_.upload(arena_, std::move(chosen));
    runtime_.finish();
    return {at_level, size};
  }

  struct Cut {
    Pending all;
    std::vector<kernel::block_cut> cuts{};
    Buffer<kernel::block_cut> cuts_there{};
    Buffer<cl_ulong> leaves{};  // per row
    Buffer<cl_int> rows{};      // a copy of the list
  };

  // Cuts the plane so that leaves have about `block` of these rows, by the places of a sample.
  Cut cut(const Buffer<cl_int>& list, std::size_t count, std::size_t block, Cuts how) {
    const std::size_t sample = sample_of(count, block, how == Cuts::medians ? kFirstSample : kLaterSample);
    Cut made{describe(list, count, sample)};
    const auto [at, sampled] = host::pack_positions(runtime_, made.all.is_sampled, count, 1);
    const Here<cl_int> positions(runtime_, at, sampled);
    const Here<double> middles(runtime_, made.all.middles.as<cl_double>(), 2 * count);
    std::vector<double2> places(sampled);
    for (std::size_t i = 0; i < sampled; ++i) {
      const auto k = 2 * static_cast<std::size_t>(positions[i]);
      places[i] = {middles[k], middles[k + 1]};
    }
    made.cuts = cut_plane(runtime_, std::move(places), std::max<std::size_t>(1, block / sample), how);
    made.cuts_there = runtime_.upload(arena_, made.cuts);
    made.leaves = arena_.allocate<cl_ulong>(count);
    made.rows = arena_.allocate<cl_int>(count);
    runtime_.map(count, kernels::find_leaves{.list = list,
                                             .middles = made.all.middles,
                                             .cuts = made.cuts_there,
                                             .keys = made.leaves,
                                             .payloads = made.rows});
    return made;
  }

  static std::size_t sample_of(std::size_t count, std::size_t block, std::size_t sample) {
    while (sample > 1 && count < 4 * block) sample /= 2;
    return sample;
  }

  // Blocks, and the rows that each begins with.
  struct Blocks {
    std::size_t count = 1, largest = 0;
    Buffer<kernel::block_cut> cuts{};
    Buffer<cl_int> list{}, starts{};
  };

  Blocks whole_plane(const Buffer<cl_int>& list, std::size_t count) {
    Blocks blocks;
    blocks.largest = count;
    blocks.cuts = runtime_.upload(arena_, std::vector<kernel::block_cut>{{0, -1, 0}});
    blocks.list = list;
    blocks.starts = runtime_.upload(arena_, std::vector<cl_int>{0, static_cast<cl_int>(count)});
    runtime_.finish();
    return blocks;
  }

  Blocks make_blocks(const Cut& made) {
    const std::size_t count = made.all.count;
    Blocks blocks;
    blocks.count = leaves_of(made.cuts);
    blocks.cuts = made.cuts_there;
    blocks.list = made.rows;
    blocks.starts = arena_.allocate<cl_int>(blocks.count + 1);
    host::sort_by_key(runtime_, made.leaves, blocks.list, count);
    runtime_.map(count,
                 kernels::find_starts{
                     .leaves = static_cast<int>(blocks.count), .keys = made.leaves, .starts = blocks.starts});
    const Here<cl_int> starts(runtime_, blocks.starts, blocks.count + 1);
    for (std::size_t b = 0; b < blocks.count; ++b)
      blocks.largest = std::max(blocks.largest, static_cast<std::size_t>(starts[b + 1] - starts[b]));
    return blocks;
  }

  // Makes phases until nothing is left that can be done, or a limit is reached.
  void make_phases(bool segments_only) {
    const int mask = segments_only ? kernel::ROW_ALL_SPLITS : kernel::ROW_ALL_SPLITS | kernel::ROW_BAD;
    std::size_t block = block_;
    Levels levels;
    bool is_first = true, needs_scaffold = !segments_only;
    while (!is_at_limit()) {
      Arena::Scope scope(arena_);
      const auto [all, all_count] = rows_with(mask);
      if (all_count == 0) return;
      std::optional<Cut> made;
      if (std::exchange(needs_scaffold, false)) {
        if (!has_areas() && all_count <= kBlocksAlone * block) block *= kBlocksAlone;
        if (all_count > block) {
          made = cut(all, all_count, block, Cuts::medians);
          if (make_scaffold(*made)) continue;
        }
      }
      const auto [list, count] = rows_at_level(all, all_count, levels);
      const std::size_t left = wanted_.most_points - added_;
      bool is_whole = count <= block;
      if (!is_whole && (!made || count != all_count))
        made = cut(list, count, block, is_first ? Cuts::medians : Cuts::gaps);
      Blocks blocks = is_whole ? whole_plane(list, count) : make_blocks(*made);
      // Each block may insert a part of the remaining points.
      if (!is_whole && (blocks.count == 1 || left < blocks.count)) {
        is_whole = true;
        blocks = whole_plane(list, count);
      }
      kernel::refinement_phase phase{};
      phase.level = std::ldexp(1.0, kLevelPlaces * levels.current);
      phase.is_whole = is_whole;
      phase.segments_only = segments_only;
      phase.most =
          static_cast<int>(std::min({kMostPerTriangle * block, left / blocks.count, kMostTriangles}));
      const std::size_t inserted = run_blocks(phase, blocks, blocks.cuts.as<cl_double>());
      if (is_whole && inserted == 0) {
        if (levels.current == 0) return;
        levels.at_first = std::numeric_limits<std::size_t>::max();  // on to the next level
      }
      if (static_cast<double>(inserted) < kLeastProgress * static_cast<double>(count))
        block = std::min(2 * block, kMostTriangles);
      is_first = false;
    }
  }

  // Cuts triangles that are long for their blocks, such as those across an empty polygon, so that blocks are
  // independent of each other: circumcentres, the largest circle first, one after the other. Returns whether
  // there were some.
  bool make_scaffold(const Cut& made) {
    const Pending& all = made.all;
    const std::size_t count = all.count;
    const Here<cl_ulong> leaves(runtime_, made.leaves, count);
    const Here<double> middles(runtime_, all.middles.as<cl_double>(), 2 * count),
        radii(runtime_, all.radii, count);
    std::vector<Box> boxes(leaves_of(made.cuts));
    for (std::size_t i = 0; i < count; ++i) boxes[leaves[i]].add(&middles[2 * i]);
    std::vector<double> reaches;
    for (const Box& box : boxes) {
      const double reach = kScaffold * box.extent();
      reaches.push_back(reach * reach);
    }
    const Here<cl_int> rows(runtime_, all.list, count);
    std::vector<cl_int> chosen;
    for (std::size_t i = 0; i < count; ++i) {
      if (radii[i] > reaches[leaves[i]]) chosen.push_back(rows[i]);
    }
    if (chosen.empty()) return false;
    const std::size_t size = chosen.size();
    Blocks blocks = whole_plane(runtime_.upload(arena_, std::move(chosen)), size);
    blocks.cuts = made.cuts_there;
    kernel::refinement_phase phase{};
    phase.is_whole = phase.is_scaffold = 1;
    phase.level = 1;
    phase.most = static_cast<int>(std::min(wanted_.most_points - added_, kMostTriangles));
    run_blocks(phase, blocks, runtime_.upload(arena_, std::move(reaches)));
    return true;
  }

  // Resets the states of work-items.
  void start_blocks() {
    kernel::block_state none{};
    none.block = none.retry = -1;
    workers_ = runtime_.is_native() ? runtime_.threads() : kBlocksAtOnce;
    if (block_states_.size() == 0) {
      block_states_ = arena_.allocate<kernel::block_state>(workers_);
      lists_.heads = arena_.allocate<cl_int>(workers_ * kernel::TASK_CLASSES);
      lists_.tails = arena_.allocate<cl_int>(workers_ * kernel::TASK_CLASSES);
      runtime_.fill(lists_.heads, lists_.heads.size(), cl_int{0});
    }
    const std::vector<kernel::block_state> all(workers_, none);
    runtime_.write(block_states_, 0, workers_, all.data());
    block_count_ = 0;
    inserted_by_.clear();
  }

  // Makes lists with at least `room` places for each work-item. keeps_tasks: whether their tasks are kept.
  void reserve_lists(std::size_t at_once, std::size_t room, bool keeps_tasks) {
    const std::size_t before = room_ + kernel::SPARE_ROOM, size = room + kernel::SPARE_ROOM;
    if (at_once * size > lists_.tasks.size()) {
      const auto renew = [&]<typename T>(Buffer<T>& array) { array = make<T>(at_once * size); };
      const Buffer<kernel::block_task> tasks = lists_.tasks;
      renew(lists_.tasks);
      for (std::size_t w = 0; w < at_once && keeps_tasks; ++w)
        runtime_.copy(tasks, w * before, lists_.tasks, w * size, before);
      renew(lists_.stacks);
      renew(lists_.cavities);
      renew(lists_.sides);
      renew(lists_.firsts);
      runtime_.finish();
    }
    room_ = lists_.tasks.size() / at_once - kernel::SPARE_ROOM;
  }

  // Runs all blocks of a phase, and returns how many points they inserted.
  std::size_t run_blocks(kernel::refinement_phase phase, const Blocks& blocks,
                         const Buffer<cl_double>& reaches) {
    const std::size_t at_once = std::min(workers_, blocks.count);
    reserve_lists(at_once, std::max(kLeastRoom, 4 * blocks.largest + kernel::SPARE_ROOM), false);
    phase.blocks = static_cast<int>(blocks.count);
    phase.first_block = static_cast<int>(block_count_);
    phase.steps = runtime_.capabilities().loops_end_early ? kFewSteps : std::numeric_limits<int>::max();
    const auto counters = arena_.allocate<cl_int>(kernel::COUNTERS_OF_PHASE);
    const auto inserted = arena_.allocate<cl_int>(blocks.count);
    cl_int counts[kernel::COUNTERS_OF_PHASE] = {0, static_cast<cl_int>(rows_), static_cast<cl_int>(vertices_),
                                                0};
    const std::size_t rows_per_chunk = kernel::ROWS_PER_CHUNK,
                      vertices_per_chunk = kernel::VERTICES_PER_CHUNK;
    const std::size_t spare = std::max(kLeastChunks, at_once);
    for (;;) {
      const std::size_t first_row = rows_, first_vertex = vertices_;
      reserve(rows_ + spare * rows_per_chunk, vertices_ + spare * vertices_per_chunk);
      phase.room = static_cast<int>(room_);
      phase.row_room = static_cast<int>(row_room_);
      phase.vertex_room = static_cast<int>(vertex_room_);
      counts[kernel::COUNT_NEEDS] = 0;
      runtime_.write(counters, 0, kernel::COUNTERS_OF_PHASE, counts);
      runtime_.launch(at_once, 1,
                      kernels::refine_blocks{.rules = rules_,
                                             .phase = phase,
                                             .rows = arrays_.rows,
                                             .points = arrays_.points,
                                             .places = arrays_.places,
                                             .ends = ends_,
                                             .wedges = wedges_,
                                             .areas = refined_mesh().areas,
                                             .given = given_.size() > 0 ? given_ : arrays_.rows,
                                             .states = arrays_.states,
                                             .births = arrays_.births,
                                             .cuts = blocks.cuts,
                                             .reaches = reaches,
                                             .list = blocks.list,
                                             .starts = blocks.starts,
                                             .counters = counters,
                                             .inserted = inserted,
                                             .block_states = block_states_,
                                             .heads = lists_.heads,
                                             .tails = lists_.tails,
                                             .tasks = lists_.tasks,
                                             .stacks = lists_.stacks,
                                             .cavities = lists_.cavities,
                                             .sides = lists_.sides,
                                             .firsts = lists_.firsts});
      runtime_.read(counters, 0, kernel::COUNTERS_OF_PHASE, counts);
      // Chunks beyond the room were not taken.
      const auto used = [](cl_int count, std::size_t first, std::size_t room, std::size_t chunk) {
        return std::min(static_cast<std::size_t>(count), first + (room - first) / chunk * chunk);
      };
      rows_ = used(counts[kernel::COUNT_ROWS], first_row, row_room_, rows_per_chunk);
      vertices_ = used(counts[kernel::COUNT_VERTICES], first_vertex, vertex_room_, vertices_per_chunk);
      counts[kernel::COUNT_ROWS] = static_cast<cl_int>(rows_);
      counts[kernel::COUNT_VERTICES] = static_cast<cl_int>(vertices_);
      const cl_int needs = counts[kernel::COUNT_NEEDS];
      if (needs == 0) break;
      if ((needs & kernel::NEEDS_ROOM) != 0) reserve_lists(at_once, 2 * room_, true);
    }
    const std::vector<cl_int> by = points::download(runtime_, inserted, blocks.count);
    inserted_by_.insert(inserted_by_.end(), by.begin(), by.end());
    block_count_ += blocks.count;
    const auto sum = static_cast<std::size_t>(std::accumulate(by.begin(), by.end(), std::int64_t{0}));
    added_ += sum;
    if (sum > 0) ++report_.rounds;
    find_areas();
    return sum;
  }

  // -------------------------------------------------------------------------------------------------------
  // Order

  // The order of vertices and rows by the blocks that made them, independent of threads.
  struct Order {
    std::size_t rows, made;  // numbers of all rows, and of vertices that were made
    Buffer<cl_ulong> order{};
    Buffer<cl_int> row_numbers{}, numbers{};
  };

  // by_input: whether vertices of the input have the numbers that they have there.
  Order find_order(bool by_input) {
    std::vector<cl_int> firsts(inserted_by_.size());
    std::exclusive_scan(inserted_by_.begin(), inserted_by_.end(), firsts.begin(), cl_int{0});
    Order found{0, added_ - known_ + mesh_.points};
    const int known = static_cast<int>(known_);
    found.numbers = arena_.allocate<cl_int>(vertices_);
    found.row_numbers = arena_.allocate<cl_int>(rows_);
    runtime_.map(vertices_, kernels::number_added{.known = known,
                                                  .inputs = by_input ? static_cast<int>(mesh_.points) : 0,
                                                  .births = arrays_.births,
                                                  .firsts = runtime_.upload(arena_, std::move(firsts)),
                                                  .names = names_,
                                                  .numbers = found.numbers});
    runtime_.finish();
    if (runtime_.is_native()) {
      order_here(found);
      return found;
    }
    const auto flags = arena_.allocate<cl_uchar>(rows_);
    runtime_.map(rows_, kernels::flag_made_rows{.rows = arrays_.rows, .flags = flags});
    const auto [kept_at, kept] = host::pack_positions(runtime_, flags, rows_, kernel::ROW_KEPT);
    const auto [made_at, made] = host::pack_positions(runtime_, flags, rows_, kernel::ROW_MADE);
    const auto keys = arena_.allocate<cl_ulong>(made);
    const auto list = arena_.allocate<cl_int>(made);
    runtime_.map(made, kernels::key_made_rows{.positions = made_at,
                                              .numbers = found.numbers,
                                              .rows = arrays_.rows,
                                              .keys = keys,
                                              .payloads = list});
    if (made > 0) host::sort_by_key(runtime_, keys, list, made);
    found.rows = kept + made;
    found.order = arena_.allocate<cl_ulong>(found.rows);
    const auto place = [&](const Buffer<cl_int>& some, std::size_t count, std::size_t to) {
      runtime_.map(count, kernels::place_rows_in_order{.first = static_cast<int>(to),
                                                       .list = some,
                                                       .numbers = found.numbers,
                                                       .rows = arrays_.rows,
                                                       .order = found.order});
    };
    place(kept_at, kept, 0);
    place(list, made, kept);
    runtime_.map(
        made, kernels::sort_made_rows{.first = static_cast<int>(kept), .keys = keys, .order = found.order});
    runtime_.map(found.rows, kernels::invert_order{.order = found.order, .row_numbers = found.row_numbers});
    return found;
  }

  // The native version of the passes above over rows: threads put new rows into buckets of vertices, and sort
  // each bucket by counting.
  void order_here(Order& found) {
    const mesh_row* const rows = address_in(arrays_.rows);
    const cl_int* const numbers = address_in(found.numbers);
    cl_int* const row_numbers = address_in(found.row_numbers);
    const std::size_t parts = parts_of_rows(), vertices = known_ + found.made,
                      buckets = (vertices >> kBucketBits) + 1;
    // Per part where its rows go: first those that are as they were, then by buckets.
    std::vector<std::vector<std::size_t>> to(parts, std::vector<std::size_t>(buckets + 1, 0));
    const auto visit = [&](std::size_t part, const auto& each) {
      const std::size_t end = rows_ * (part + 1) / parts;
      for (std::size_t r = rows_ * part / parts; r < end; ++r) {
        if (rows[r].corner[0] < 0) continue;
        const auto v = static_cast<std::size_t>(numbers[rows[r].corner[0]]);
        each(r, rows[r].changed == 0 ? 0 : 1 + (v >> kBucketBits));
      }
    };
    runtime_.share(parts, [&](std::size_t part) {
      visit(part, [&own = to[part]](std::size_t, std::size_t bucket) { ++own[bucket]; });
    });
    std::vector<std::size_t> firsts;
    for (std::size_t bucket = 0; bucket <= buckets; ++bucket) {
      firsts.push_back(found.rows);
      for (std::vector<std::size_t>& own : to) found.rows += std::exchange(own[bucket], found.rows);
    }
    firsts.push_back(found.rows);
    found.order = arena_.allocate<cl_ulong>(found.rows);
    cl_ulong* const order = address_in(found.order);
    struct Made {
      std::int32_t row, first, second;  // and its first two corners
    };
    const auto list = arena_.allocate<Made>(found.rows - firsts[1]);
    Made* const of_buckets = address_in(list);
    runtime_.share(parts, [&](std::size_t part) {
      visit(part, [&, &own = to[part]](std::size_t r, std::size_t bucket) {
        const std::size_t at = own[bucket]++;
        if (bucket == 0) {
          row_numbers[r] = static_cast<cl_int>(at);
          order[at] = r;
        } else {
          of_buckets[at - firsts[1]] = {static_cast<std::int32_t>(r), numbers[rows[r].corner[0]],
                                        numbers[rows[r].corner[1]]};
        }
      });
    });
    runtime_.share(buckets, [&](std::size_t bucket) {
      const std::size_t begin = firsts[bucket + 1], count = firsts[bucket + 2] - begin,
                        first_vertex = bucket << kBucketBits,
                        size = std::min(std::size_t{1} << kBucketBits, vertices - first_vertex);
      const Made* const own = of_buckets + (begin - firsts[1]);
      cl_ulong* const placed = order + begin;
      // Where the rows of each vertex begin, and then where they end.
      std::vector<std::uint32_t> places(size + 2, 0);
      const auto ends = [&](const Made& made) {
        return &places[static_cast<std::size_t>(made.first) - first_vertex + 1];
      };
      for (std::size_t k = 0; k < count; ++k) ++ends(own[k])[1];
      std::partial_sum(places.begin(), places.end(), places.begin());
      for (std::size_t k = 0; k < count; ++k)
        placed[(*ends(own[k]))++] =
            static_cast<cl_ulong>(own[k].second) << 32 | static_cast<cl_uint>(own[k].row);
      for (std::size_t v = 0; v < size; ++v) {
        for (std::uint32_t i = places[v]; i < places[v + 1]; ++i) {
          const cl_ulong moved = placed[i];
          std::uint32_t at = i;
          for (; at > places[v] && placed[at - 1] > moved; --at) placed[at] = placed[at - 1];
          placed[at] = moved;
        }
      }
      for (std::size_t i = 0; i < count; ++i)
        row_numbers[static_cast<cl_uint>(placed[i])] = static_cast<cl_int>(begin + i);
    });
  }

  // Gives vertices and rows their numbers.
  void put_in_order() {
    Arena::Scope scope(arena_);
    const Order found = find_order(false);
    const Arrays before = std::exchange(arrays_, {});
    const std::size_t vertices = std::exchange(vertices_, 0);
    rows_ = row_room_ = vertex_room_ = 0;
    reserve(found.rows, known_ + found.made);
    rows_ = found.rows;
    vertices_ = known_ = known_ + found.made;
    const bool by_row = rules_.area_kind == kernel::AREAS_BY_ROW;
    runtime_.map(rows_, kernels::move_rows{.by_row = by_row ? 1 : 0,
                                           .order = found.order,
                                           .row_numbers = found.row_numbers,
                                           .numbers = found.numbers,
                                           .rows = before.rows,
                                           .states = before.states,
                                           .areas = by_row ? before.areas : parent_areas_,
                                           .moved_rows = arrays_.rows,
                                           .moved_states = arrays_.states,
                                           .moved_areas = by_row ? arrays_.areas : parent_areas_});
    runtime_.map(vertices, kernels::move_added{.numbers = found.numbers,
                                               .points = before.points,
                                               .places = before.places,
                                               .moved_points = arrays_.points,
                                               .moved_places = arrays_.places});
    runtime_.fill(arrays_.births, vertices_, cl_int2{{-1, 0}});
    runtime_.finish();
    start_blocks();
  }

  // -------------------------------------------------------------------------------------------------------
  // Smoothing

  void smooth_once() {
    Arena::Scope scope(arena_);
    // With angles of 20 degrees no constraint is encroached.
    kernel::refinement_rules rules = rules_;
    rules.squared_sine = quality_bounds(std::max(wanted_.min_angle, kSmoothedAngle)).squared_sine;
    smooth(runtime_, {.rows = rows_,
                      .vertices = vertices_,
                      .rules = rules,
                      .mesh = refined_mesh(),
                      .triangles = arrays_.rows,
                      .points = arrays_.points,
                      .states = arrays_.states});
  }

  void measure_before_smoothing() {
    const Here<mesh_row> rows(runtime_, arrays_.rows, rows_);
    const Here<double> coordinates(runtime_, arrays_.points.as<cl_double>(), 2 * vertices_);
    for (std::size_t t = 0; t < rows_; ++t) before_smoothing_.add(&coordinates[0], rows[t].corner);
  }

  // -------------------------------------------------------------------------------------------------------
  // The result

  RefinedMesh result() {
    RefinedMesh refined;
    Arena::Scope scope(arena_);
    const Order found = find_order(true);
    for (auto* const array : {&refined.triangles, &refined.neighbors, &refined.edges}) {
      runtime_.resize(*array, 3 * found.rows);
    }
    runtime_.resize(refined.parents, found.rows);
    std::vector<cl_uchar> excuses(found.rows);
    {
      const host::Runtime::Settled settled(runtime_);
      const auto triangles = runtime_.output(refined.triangles),
                 neighbors = runtime_.output(refined.neighbors), edges = runtime_.output(refined.edges),
                 parents = runtime_.output(refined.parents);
      const auto excuses_there = runtime_.output(excuses);
      runtime_.map_in_small_groups(found.rows, kernels::write_refined_rows{.rules = rules_,
                                                                           .order = found.order,
                                                                           .row_numbers = found.row_numbers,
                                                                           .numbers = found.numbers,
                                                                           .refined_mesh = refined_mesh(),
                                                                           .states = arrays_.states,
                                                                           .triangles = triangles,
                                                                           .neighbors = neighbors,
                                                                           .edges = edges,
                                                                           .parents = parents,
                                                                           .excuses = excuses_there});
      runtime_.fetch_later(triangles, refined.triangles);
      runtime_.fetch_later(neighbors, refined.neighbors);
      runtime_.fetch_later(edges, refined.edges);
      runtime_.fetch_later(parents, refined.parents);
      runtime_.fetch_later(excuses_there, excuses);
      runtime_.finish();
    }
    const Here<double> coordinates(runtime_, arrays_.points.as<cl_double>(), 2 * vertices_);
    const Here<edge_place> places(runtime_, arrays_.places, vertices_);
    const Here<cl_int> numbers(runtime_, found.numbers, vertices_);
    const std::size_t added = known_ + found.made - mesh_.points;
    runtime_.resize(refined.added, 2 * added);
    runtime_.resize(refined.added_edges, added);
    runtime_.resize(refined.added_places, added);
    const kernel::scaling back = kernel::scale_of(-shift_);
    std::atomic<std::size_t> split_points = 0;
    runtime_.share_parts(vertices_ - mesh_.points, [&](std::size_t begin, std::size_t end) {
      std::size_t splits = 0;
      for (std::size_t v = mesh_.points + begin; v < mesh_.points + end; ++v) {
        if (numbers[v] < 0) continue;
        const std::size_t to = static_cast<std::size_t>(numbers[v]) - mesh_.points;
        for (std::size_t k = 0; k < 2; ++k)
          refined.added[2 * to + k] = kernel::scaled(coordinates[2 * v + k], back);
        refined.added_edges[to] = places[v].edge;
        refined.added_places[to] = places[v].part;
        splits += places[v].edge >= 0 ? 1 : 0;
      }
      split_points += splits;
    });
    report_.split_points = split_points;
    const Excuse at_limit = report_.rounds >= wanted_.most_rounds ? Excuse::most_rounds : Excuse::most_points;
    for (std::size_t t = 0; t < found.rows; ++t) {
      if (excuses[t] == kernel::EXCUSED_NOT) continue;
      report_.bad_triangles.push_back(static_cast<std::int32_t>(t));
      // Without the limit, those at frozen constraints would be tried again.
      const bool is_limited =
          excuses[t] == kernel::EXCUSED_LIMIT || (excuses[t] == kernel::EXCUSED_FROZEN && is_at_limit());
      report_.excuses.push_back(is_limited ? at_limit : static_cast<Excuse>(excuses[t]));
    }
    report_.added_points = refined.added_edges.size();
    refined.report = std::move(report_);
    refined.before_smoothing = before_smoothing_;
    return refined;
  }

  host::Runtime& runtime_;
  Arena& arena_;
  const MeshToRefine& mesh_;
  const Refinement& wanted_;
  const std::size_t block_;
  int shift_ = 0;
  kernel::scaling scale_{};
  double extent_ = 0, largest_ = 0;  // scaled: the larger side of the bounding box, the largest coordinate
  kernel::refinement_rules rules_{};
  std::vector<std::int32_t> place_of_;  // per point of the mesh the number of its vertex here
  std::vector<double2> points_;         // scaled, by these numbers
  Arrays arrays_;
  Buffer<cl_int> ends_{}, wedges_{}, names_{};  // names: the points of vertices
  Buffer<cl_double> parent_areas_{};
  Buffer<mesh_row> given_{};  // the rows at first, if triangles of one region have different areas
  std::size_t rows_ = 0, vertices_ = 0, row_room_ = 0, vertex_room_ = 0, added_ = 0;
  std::size_t known_ = 0;  // vertices that have their numbers
  Buffer<kernel::block_state> block_states_{};
  Lists lists_;
  bool is_starting_ = false;
  std::size_t workers_ = 0, room_ = 0;  // room: places in the lists of each work-item
  std::size_t block_count_ = 0;
  std::vector<cl_int> inserted_by_;  // points of each block of all phases
  RefinementReport report_;
  Angles before_smoothing_{true};
};

}  // namespace

RefinedMesh refine(host::Runtime& runtime, const MeshToRefine& mesh, const Refinement& wanted,
                   std::size_t block) {
  Arena::Scope scope(runtime.arena());
  return Refining(runtime, mesh, wanted, block).run();
}

}  // namespace flaunay::constrained
