#include "constrained/refinement/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "constrained/refinement/angles.hpp"
#include "constrained/refinement/bounds.hpp"
#include "constrained/refinement/smooth.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/predicates.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/refinement/insert.cl.hpp"
#include "launchers/refinement/propose.cl.hpp"
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
using kernel::insertion;
using kernel::mesh_row;
using kernel::proposal;
using kernel::star_side;

// Up to this angle, bad triangles wait for better neighbours; above the second one, a point must hold all
// rows around its cavity. Measured: docs/refinement.md.
constexpr double kWaitsUpTo = 30, kRingAbove = 32;
constexpr std::size_t kMostWithoutWaiting = 4000;
// Smoothing makes no smaller angles, whatever is asked for.
constexpr double kSmoothedAngle = 20;
// The smallest edge unless the caller has one: 2^-40 of the larger side of the bounding box, or 2^-48 of the
// largest coordinate if that is more, which is at least 16 units in the last place of any coordinate. With
// 2^-45 of the largest coordinate, rounding moves points by less than 2 % of the smallest edge.
constexpr int kMinEdgeOfExtent = -40, kMinEdgeOfLargest = -48, kFineOfLargest = -45;
// New coordinates have no binary places below that of the largest coordinate by so many.
constexpr int kBinaryPlaces = 200;
// The rows of cavities with at most so many are kept in lists. On average there are four, but in empty
// polygons many more: lists get longer if more than a part of all cavities does not fit.
constexpr int kFewestListed = 12, kMostListed = 96;
constexpr std::size_t kPartUnlisted = 16;
// Rows that a thread writes to the result at once.
constexpr std::size_t kPartOfRows = std::size_t{1} << 14;
// Their corners are counted by ints.
constexpr std::size_t kMostTriangles = std::size_t{1} << 29;

// The mesh. Arrays have room for more.
struct Arrays {
  Buffer<mesh_row> rows{};
  Buffer<cl_ulong> keys{};
  Buffer<cl_uint> claims{}, visits{};
  Buffer<cl_uchar> refused{};
  Buffer<cl_double> areas{};
  Buffer<cl_double2> points{};
  Buffer<edge_place> places{};
  Buffer<cl_int> bad{}, next_bad{};  // rows
};

// What an array holds: where it is, if kernels run natively, or else a copy.
template <typename T>
class Here {
 public:
  Here(host::Runtime& runtime, const Buffer<T>& array, std::size_t count) {
    if (!runtime.is_native()) copy_ = points::download(runtime, array, count);
    values_ =
        runtime.is_native() ? reinterpret_cast<const T*>(host::address_of(array.memory())) : copy_.data();
  }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::vector<T> copy_;
  const T* values_;
};

class Rounds {
 public:
  Rounds(host::Runtime& runtime, const MeshToRefine& mesh, const Refinement& wanted)
      : runtime_(runtime), arena_(runtime.arena()), mesh_(mesh), wanted_(wanted) {
    scale();
    set_rules();
  }

  RefinedMesh run() {
    upload();
    if (!wanted_.is_wanted() && mesh_.largest_areas.empty()) return result();
    mend(false);
    if (wanted_.smoothing_steps > 0) measure_before_smoothing();
    for (std::size_t step = 0; step < wanted_.smoothing_steps && !is_at_limit(); ++step) {
      smooth_once();
      mend(true);
    }
    if (is_at_limit()) find_areas();
    return result();
  }

 private:
  bool is_at_limit() const { return report_.rounds >= wanted_.most_rounds || added_ >= wanted_.most_points; }

  // Makes rounds as long as they help. has_moved: whether constraints may have thawed before.
  void mend(bool has_moved) {
    bool may_thaw = has_moved;
    do {
      const std::size_t before = added_;
      make_rounds();
      may_thaw |= added_ > before;
    } while (!is_at_limit() && std::exchange(may_thaw, false) && retry_frozen());
  }

  void make_rounds() {
    while (made_count_ + bad_count_ > 0 && !is_at_limit()) {
      const std::size_t before = tried_;
      Arena::Scope scope(arena_);
      if (!make_round()) break;
      if (tried_ > before) ++report_.rounds;
    }
  }

  // Constraints that could not be split beside flat triangles may be since these changed. Tests
  // triangles that were refused for such a constraint again; returns whether there are some.
  bool retry_frozen() {
    Arena::Scope scope(arena_);
    const auto [at, count] = host::pack_positions(runtime_, arrays_.refused, rows_, kernel::EXCUSED_FROZEN);
    reserve_made(count);
    runtime_.map(count,
                 kernels::make_again{
                     .positions = at, .rows = arrays_.rows, .refused = arrays_.refused, .made = made_});
    runtime_.finish();
    made_count_ = count;
    return count > 0;
  }

  // -------------------------------------------------------------------------------------------------------
  // Before and after

  // The largest coordinate is brought to just below 1, whatever it is, so that results for the same points in
  // other units that are a power of two apart are the same; only the lowest bit of points that span more
  // binary places than there are below 1 decides first.
  void scale() {
    const geometry::Magnitudes magnitudes = geometry::inspect(mesh_.coordinates, 0, mesh_.points);
    geometry::scaling_for(mesh_.coordinates, 0, mesh_.points, magnitudes);  // throws if there is none
    if (geometry::bits_of(magnitudes) > 0)
      shift_ = std::max(-1 - magnitudes.largest, kernel::LOWEST_EXPONENT - magnitudes.lowest);
    // The last binary place that new coordinates have, scaled: exact in predicates, and a double when scaled
    // back.
    const int lowest = std::max({magnitudes.largest + shift_ - kBinaryPlaces, int{kernel::LOWEST_EXPONENT},
                                 shift_ + std::numeric_limits<double>::min_exponent - kernel::DOUBLE_BITS});
    rules_.coarse = std::ldexp(1.0, lowest + kernel::DOUBLE_BITS - 1);
    order_vertices();
    points_.resize(mesh_.points);
    double low[2] = {0, 0}, high[2] = {0, 0};
    for (std::size_t i = 0; i < mesh_.points; ++i) {
      double at[2];
      for (int k = 0; k < 2; ++k) {
        at[k] = std::ldexp(mesh_.coordinates[2 * i + k], shift_) + 0.0;
        low[k] = i == 0 ? at[k] : std::min(low[k], at[k]);
        high[k] = i == 0 ? at[k] : std::max(high[k], at[k]);
        largest_ = std::max(largest_, std::fabs(at[k]));
      }
      points_[place_of_[i]] = {at[0], at[1]};
    }
    extent_ = std::max(high[0] - low[0], high[1] - low[1]);
  }

  // An area that is too small to be scaled is still one: no triangle is as small.
  double scaled_area(double area) const {
    const double scaled = std::ldexp(area, 2 * shift_);
    return area > 0 ? std::max(scaled, std::numeric_limits<double>::min()) : scaled;
  }

  // Vertices are numbered as triangles need them, which are in the order of places in the plane, more or
  // less: then what is used together is together in memory.
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
    rules_.rule = wanted_.min_angle > kRingAbove ? kernel::RULE_RING : kernel::RULE_NEIGHBORS;
    // Of few triangles, most are near the border, where those that wait cost points.
    rules_.waits = wanted_.min_angle <= kWaitsUpTo && mesh_.triangles.size() / 3 > kMostWithoutWaiting;
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

  // The other ends of edges at apexes. Of several apexes that a vertex has, the first one counts, by
  // coordinates. ends: 2 per edge.
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
  std::vector<std::int32_t> wedges_at(const std::vector<std::int32_t>& ends) const {
    std::vector<std::int32_t> wedges(ends.size(), -1);
    const auto vertex = [&](int corner) { return place_of_[mesh_.triangles[corner]]; };
    for (int c = 0; c < static_cast<int>(mesh_.triangles.size()); ++c) {
      const int edge = mesh_.edges[geometry::previous_halfedge(c)], v = vertex(c);
      if (edge < 0) continue;
      int last = geometry::next_halfedge(c);  // opposite to the side that comes next
      while (mesh_.edges[last] < 0) {
        int at = 3 * mesh_.neighbors[last];
        while (vertex(at) != v) ++at;
        last = geometry::next_halfedge(at);
      }
      wedges[ends[2 * edge] == v ? 2 * edge : 2 * edge + 1] = mesh_.edges[last];
    }
    return wedges;
  }

  // Where input vertices are: those at which two edges meet at a sharp angle, with triangles between, are
  // apexes.
  std::vector<edge_place> input_places(const std::vector<std::int32_t>& ends,
                                       const std::vector<std::int32_t>& wedges) const {
    std::vector<edge_place> places(mesh_.points, edge_place{0, 0, -1, -1});
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (wedges[i] < 0) continue;
      const std::int32_t v = ends[i], next = 2 * wedges[i];
      const double2 at = points_[v], first = points_[ends[i ^ 1]],
                    last = points_[ends[ends[next] == v ? next + 1 : next]];
      const bool is_convex = kernel::orient_sign(at, first, last, ORIENT_BOUND) > 0;
      if (is_convex && kernel::is_sharp(at, first, last) != 0) places[v].apex = v;
    }
    add_far_ends(ends, places);
    return places;
  }

  void upload() {
    rows_ = mesh_.triangles.size() / 3;
    vertices_ = mesh_.points;
    std::vector<std::int32_t> edges = mesh_.edges;
    for (std::int32_t& e : edges) {
      if (e >= 0 && !mesh_.kept_edges.empty() && mesh_.kept_edges[e] != 0) e |= kernel::EDGE_KEPT;
    }
    std::vector<std::int32_t> ends = ordered_ends(), wedges = wedges_at(ends);
    const std::vector<edge_place> places = input_places(ends, wedges);
    ends_ = runtime_.upload(arena_, std::move(ends));
    wedges_ = runtime_.upload(arena_, std::move(wedges));
    reserve(rows_, vertices_);
    clear_claims();
    reserve_made(rows_);
    made_count_ = rows_;
    runtime_.fill(arrays_.refused, rows_, cl_uchar{kernel::EXCUSED_NOT});
    {
      Arena::Scope scope(arena_);
      runtime_.map(rows_, kernels::load_rows{.triangles = runtime_.upload(arena_, places_of(mesh_.triangles)),
                                             .neighbors = runtime_.upload(arena_, mesh_.neighbors),
                                             .edges = runtime_.upload(arena_, std::move(edges)),
                                             .rows = arrays_.rows,
                                             .made = made_});
      runtime_.finish();
    }
    runtime_.write(arrays_.points.as<double2>(), 0, points_.size(), points_.data());
    runtime_.write(arrays_.places, 0, places.size(), places.data());
    if (!mesh_.largest_areas.empty()) {
      std::vector<double> areas = mesh_.largest_areas;
      for (double& area : areas) area = scaled_area(area);
      parent_areas_ = runtime_.upload(arena_, std::move(areas));
      if (areas_differ_within_regions()) {
        given_ = arena_.allocate<mesh_row>(rows_);
        runtime_.copy(arrays_.rows, 0, given_, 0, rows_);
      }
    } else {
      parent_areas_ = arena_.allocate<cl_double>(1);  // nobody reads it
    }
  }

  bool areas_differ_within_regions() const {
    for (std::size_t c = 0; c < mesh_.edges.size(); ++c) {
      if (mesh_.edges[c] < 0 && mesh_.largest_areas[c / 3] != mesh_.largest_areas[mesh_.neighbors[c]])
        return true;
    }
    return false;
  }

  template <typename T>
  void grow(Buffer<T>& array, std::size_t used, std::size_t size) {
    const Buffer<T> larger(host::allocate_memory(runtime_.memory(), size * sizeof(T)), size);
    runtime_.copy(array, 0, larger, 0, std::min(used, array.size()));
    array = larger;
  }
  void reserve_made(std::size_t count) {
    if (count > made_.size()) grow(made_, made_count_, with_spare(count));
  }

  // With what is likely to be needed later. Natively, memory that is not used costs nothing.
  std::size_t with_spare(std::size_t count) const {
    return runtime_.is_native() ? 3 * count : count + count / 2;
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
      grow(arrays_.keys, rows_, size);
      grow(arrays_.claims, rows_, size);
      grow(arrays_.visits, rows_, size);
      grow(arrays_.refused, rows_, size);
      if (rules_.area_kind == kernel::AREAS_BY_ROW) grow(arrays_.areas, rows_, size);
      grow(arrays_.bad, bad_count_, size);
      grow(arrays_.next_bad, 0, size);
      row_room_ = size;
    }
    if (vertices > vertex_room_) {
      const std::size_t size = with_spare(vertices);
      grow(arrays_.points, vertices_, size);
      grow(arrays_.places, vertices_, size);
      vertex_room_ = size;
    }
  }

  // Claims of later steps are smaller than those before, so that nobody has to clear them.
  void clear_claims() {
    runtime_.fill(arrays_.claims, rows_, cl_uint{UNCLAIMED_ROW});
    runtime_.fill(arrays_.visits, rows_, cl_uint{UNCLAIMED_ROW});
    next_claim_ = UNCLAIMED_ROW;
  }
  // The first of so many claims.
  cl_uint take_claims(std::size_t count) {
    if (count >= next_claim_) clear_claims();
    next_claim_ -= static_cast<cl_uint>(count);
    return next_claim_;
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

  // What is to be split in any case.
  struct Encroached {
    Buffer<cl_int> corners{};  // opposite; those less than 0 are none
    std::size_t count = 0;
  };

  // Tests what the last round has made, and makes the list of bad rows.
  Encroached test() {
    const std::size_t count = made_count_;
    const auto bad = arena_.allocate<cl_uchar>(count), encroached = arena_.allocate<cl_uchar>(count),
               split_bits = arena_.allocate<cl_uchar>(count),
               unchanged = arena_.allocate<cl_uchar>(bad_count_);
    // Before the test, which gives rows that were made keys again.
    runtime_.map(bad_count_,
                 kernels::find_unchanged{.list = arrays_.bad, .keys = arrays_.keys, .unchanged = unchanged});
    runtime_.map_in_small_groups(count, kernels::test_rows{.rules = rules_,
                                                           .made = made_,
                                                           .refined_mesh = refined_mesh(),
                                                           .keys = arrays_.keys,
                                                           .bad = bad,
                                                           .encroached = encroached,
                                                           .split_bits = split_bits});
    const auto [kept_at, kept_count] = host::pack_positions(runtime_, unchanged, bad_count_, 1);
    const auto [bad_at, bad_count] = host::pack_positions(runtime_, bad, count, 1);
    const auto [encroached_at, encroached_count] = host::pack_positions(runtime_, encroached, count, 1);
    runtime_.map(kept_count, kernels::gather_elements{
                                 .positions = kept_at, .from = arrays_.bad, .list = arrays_.next_bad});
    runtime_.map(bad_count, kernels::append_made{.first = static_cast<int>(kept_count),
                                                 .positions = bad_at,
                                                 .made = made_,
                                                 .list = arrays_.next_bad});
    std::swap(arrays_.bad, arrays_.next_bad);
    bad_count_ = kept_count + bad_count;
    const Encroached found{arena_.allocate<cl_int>(kernel::SLOTS_PER_ROW * encroached_count),
                           kernel::SLOTS_PER_ROW * encroached_count};
    runtime_.map(
        encroached_count,
        kernels::list_encroached{
            .positions = encroached_at, .made = made_, .split_bits = split_bits, .corners = found.corners});
    return found;
  }

  // Finds the areas of rows that were made: those of parents, and what the caller's function says.
  void find_areas() {
    if (given_.size() > 0) {
      runtime_.map_in_small_groups(made_count_, kernels::find_parents{.rules = rules_,
                                                                      .made = made_,
                                                                      .given = given_,
                                                                      .points = arrays_.points,
                                                                      .rows = arrays_.rows});
    }
    if (!wanted_.areas_at) return;
    Arena::Scope scope(arena_);
    const auto centroids = arena_.allocate<cl_double2>(made_count_);
    runtime_.map_in_small_groups(
        made_count_,
        kernels::write_centroids{.made = made_, .refined_mesh = refined_mesh(), .centroids = centroids});
    const std::vector<double> all = points::download(runtime_, centroids.as<cl_double>(), 2 * made_count_);
    std::vector<double> places, areas;
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < made_count_; ++i) {
      if (std::isnan(all[2 * i])) continue;
      of.push_back(i);
      for (int k = 0; k < 2; ++k) places.push_back(std::ldexp(all[2 * i + k], -shift_));
    }
    areas.resize(of.size());
    wanted_.areas_at(places.data(), of.size(), areas.data());
    check_areas(areas.data(), areas.size(), "areas");
    std::vector<double> given(made_count_);
    for (std::size_t i = 0; i < of.size(); ++i) given[of[i]] = scaled_area(areas[i]);
    runtime_.map(made_count_, kernels::set_areas{.has_parents = mesh_.largest_areas.empty() ? 0 : 1,
                                                 .made = made_,
                                                 .rows = arrays_.rows,
                                                 .given = runtime_.upload(arena_, std::move(given)),
                                                 .parent_areas = parent_areas_,
                                                 .areas = arrays_.areas});
    runtime_.finish();
  }

  // -------------------------------------------------------------------------------------------------------
  // Rounds

  struct Proposals {
    std::size_t count = 0, winners = 0;
    Buffer<proposal> all{};
    int listed = 0;             // the rows of cavities with at most so many are in a list
    Buffer<cl_int> cavities{};  // that many rows each
    Buffer<cl_int> order{};     // by ranks
    Buffer<cl_uchar> outcomes{};
    Buffer<cl_int> winners_at{};  // places in the order
    Buffer<cl_uint> wanted{};     // scanned: the constraints that are split for each
    std::size_t wanted_count = 0;
  };

  // Returns false if there is nothing left to do.
  bool make_round() {
    find_areas();
    const Encroached encroached = test();
    may_propose_ |= encroached.count == 0;
    Proposals proposals;
    if (may_propose_) proposals = propose(encroached);
    if (encroached.count + proposals.count == 0) return false;
    insert(encroached, proposals);
    return true;
  }

  Proposals propose(const Encroached& encroached) {
    const auto active = arena_.allocate<cl_uchar>(bad_count_);
    runtime_.map(bad_count_, kernels::find_active{.waits = rules_.waits,
                                                  .list = arrays_.bad,
                                                  .rows = arrays_.rows,
                                                  .keys = arrays_.keys,
                                                  .active = active});
    const auto [active_at, count] = host::pack_positions(runtime_, active, bad_count_, 1);
    Proposals made;
    made.count = count;
    if (count == 0) return made;
    const auto list = arena_.allocate<cl_int>(count);
    runtime_.map(count, kernels::gather_elements{.positions = active_at, .from = arrays_.bad, .list = list});
    made.all = arena_.allocate<proposal>(count);
    made.listed = std::min(listed_, std::numeric_limits<int>::max() / static_cast<int>(count));
    made.cavities = arena_.allocate<cl_int>(static_cast<std::size_t>(made.listed) * count);
    made.order = arena_.allocate<cl_int>(count);
    made.outcomes = arena_.allocate<cl_uchar>(count);
    const auto keys = arena_.allocate<cl_ulong>(count);
    const auto unlisted = arena_.allocate<cl_uint>(1);
    runtime_.fill(unlisted, 1, cl_uint{0});
    runtime_.map_in_small_groups(count, kernels::propose{.rules = rules_,
                                                         .listed = made.listed,
                                                         .list = list,
                                                         .refined_mesh = refined_mesh(),
                                                         .row_keys = arrays_.keys,
                                                         .proposals = made.all,
                                                         .cavities = made.cavities,
                                                         .keys = keys,
                                                         .payloads = made.order,
                                                         .outcomes = made.outcomes,
                                                         .unlisted = unlisted});
    if (kPartUnlisted * runtime_.read_one(unlisted, 0) > count) listed_ = std::min(2 * listed_, kMostListed);
    host::sort_by_key(runtime_, keys, made.order, count);
    runtime_.map(
        count, kernels::order_equal{
                   .keys = keys, .proposals = made.all, .refined_mesh = refined_mesh(), .order = made.order});
    const auto ranks = arena_.allocate<cl_uint>(count);
    runtime_.map(count, kernels::list_ranks{.order = made.order, .ranks = ranks});
    const cl_uint splits_claim = take_claims(count + 1), first = splits_claim + 1;
    if (encroached.count > 0) {
      runtime_.map_in_small_groups(encroached.count, kernels::claim_splits{.rules = rules_,
                                                                           .claim = splits_claim,
                                                                           .corners = encroached.corners,
                                                                           .refined_mesh = refined_mesh(),
                                                                           .claims = arrays_.claims});
      runtime_.map_in_small_groups(count, kernels::find_blocked{.claim = splits_claim,
                                                                .listed = made.listed,
                                                                .proposals = made.all,
                                                                .cavities = made.cavities,
                                                                .refined_mesh = refined_mesh(),
                                                                .claims = arrays_.claims,
                                                                .outcomes = made.outcomes});
    }
    runtime_.map_in_small_groups(count, kernels::claim_cavities{.rules = rules_,
                                                                .first = first,
                                                                .listed = made.listed,
                                                                .proposals = made.all,
                                                                .cavities = made.cavities,
                                                                .ranks = ranks,
                                                                .outcomes = made.outcomes,
                                                                .refined_mesh = refined_mesh(),
                                                                .claims = arrays_.claims});
    runtime_.map_in_small_groups(count, kernels::decide{.rules = rules_,
                                                        .first = first,
                                                        .proposals = made.all,
                                                        .ranks = ranks,
                                                        .refined_mesh = refined_mesh(),
                                                        .row_keys = arrays_.keys,
                                                        .claims = arrays_.claims,
                                                        .outcomes = made.outcomes});
    const auto inserts = arena_.allocate<cl_uchar>(count);
    runtime_.map(count,
                 kernels::mark_winners{.order = made.order, .outcomes = made.outcomes, .inserts = inserts});
    std::tie(made.winners_at, made.winners) = host::pack_positions(runtime_, inserts, count, 1);
    runtime_.map(count, kernels::refuse{.proposals = made.all,
                                        .outcomes = made.outcomes,
                                        .row_keys = arrays_.keys,
                                        .refused = arrays_.refused});
    made.wanted = arena_.allocate<cl_uint>(count + 1);
    runtime_.map(count, kernels::count_wanted{
                            .proposals = made.all, .outcomes = made.outcomes, .counts = made.wanted});
    host::exclusive_scan(runtime_, made.wanted, count, made.wanted);
    made.wanted_count = runtime_.read_one(made.wanted, count);
    return made;
  }

  // The constraints that are split in this round, each once, in an order of their own.
  struct Splits {
    Buffer<cl_int> corners{}, at{};  // opposite corners, and those of them that count
    std::size_t count = 0;
  };

  Splits find_splits(const Encroached& encroached, const Proposals& proposals) {
    const std::size_t count = encroached.count + proposals.wanted_count;
    Splits splits;
    if (count == 0) return splits;
    splits.corners = arena_.allocate<cl_int>(count);
    runtime_.copy(encroached.corners, 0, splits.corners, 0, encroached.count);
    if (proposals.wanted_count > 0) {
      runtime_.map_in_small_groups(proposals.count,
                                   kernels::list_wanted{.rules = rules_,
                                                        .first = static_cast<int>(encroached.count),
                                                        .proposals = proposals.all,
                                                        .outcomes = proposals.outcomes,
                                                        .offsets = proposals.wanted,
                                                        .refined_mesh = refined_mesh(),
                                                        .corners = splits.corners});
    }
    const auto keys = arena_.allocate<cl_ulong>(count);
    const auto is_new = arena_.allocate<cl_uchar>(count);
    runtime_.map(count, kernels::constraint_keys{
                            .corners = splits.corners, .refined_mesh = refined_mesh(), .keys = keys});
    host::sort_by_key(runtime_, keys, splits.corners, count);
    runtime_.map(count, kernels::find_new{
                            .keys = keys, .corners = splits.corners, .rows = arrays_.rows, .is_new = is_new});
    std::tie(splits.at, splits.count) = host::pack_positions(runtime_, is_new, count, 1);
    return splits;
  }

  void insert(const Encroached& encroached, const Proposals& proposals) {
    const Splits splits = find_splits(encroached, proposals);
    const std::size_t most = wanted_.most_points - added_;
    const std::size_t split_count = std::min(splits.count, most);
    const std::size_t point_count = std::min(proposals.winners, most - split_count);
    const std::size_t count = split_count + proposals.winners;
    made_count_ = 0;
    if (count == 0) return;
    reserve(rows_ + 2 * count, vertices_ + count);
    const auto insertions = arena_.allocate<insertion>(count);
    const auto states = arena_.allocate<cl_uchar>(count);
    const int first_vertex = static_cast<int>(vertices_), first_row = static_cast<int>(rows_);
    runtime_.map(split_count, kernels::start_splits{.rules = rules_,
                                                    .first_vertex = first_vertex,
                                                    .first_row = first_row,
                                                    .positions = splits.at,
                                                    .corners = splits.corners,
                                                    .ends = ends_,
                                                    .rows = arrays_.rows,
                                                    .points = arrays_.points,
                                                    .places = arrays_.places,
                                                    .row_keys = arrays_.keys,
                                                    .claims = arrays_.claims,
                                                    .visits = arrays_.visits,
                                                    .insertions = insertions,
                                                    .states = states});
    const cl_uint mask = std::bit_ceil(proposals.winners) - 1;
    if (proposals.winners > 0) {
      const auto places_of = arena_.allocate<cl_int>(proposals.count);
      runtime_.map(proposals.winners,
                   kernels::list_places{
                       .positions = proposals.winners_at, .order = proposals.order, .places_of = places_of});
      const auto [list, winners] =
          host::pack_positions(runtime_, proposals.outcomes, proposals.count, kernel::PROPOSAL_INSERTS);
      runtime_.map(winners,
                   kernels::start_points{.step = step_,
                                         .first = static_cast<int>(split_count),
                                         .mask = mask,
                                         .most = static_cast<int>(point_count),
                                         .first_vertex = first_vertex + static_cast<int>(split_count),
                                         .first_row = first_row + 2 * static_cast<int>(split_count),
                                         .list = list,
                                         .places_of = places_of,
                                         .proposals = proposals.all,
                                         .rows = arrays_.rows,
                                         .points = arrays_.points,
                                         .places = arrays_.places,
                                         .row_keys = arrays_.keys,
                                         .claims = arrays_.claims,
                                         .visits = arrays_.visits,
                                         .insertions = insertions,
                                         .states = states});
    }
    rows_ += 2 * count;
    vertices_ += count;
    tried_ += split_count + point_count;
    insert_in_steps(insertions, states, split_count, proposals, split_count + mask + 1);
    // Those that were dropped do not count.
    added_ += host::pack_positions(runtime_, states, count, kernel::POINT_INSERTED).second;
  }

  // Ranks of points are below `ranks`.
  void insert_in_steps(const Buffer<insertion>& insertions, const Buffer<cl_uchar>& states,
                       std::size_t split_count, const Proposals& proposals, std::size_t ranks) {
    const std::size_t count = split_count + proposals.winners;
    std::vector<std::int32_t> all(count);
    std::iota(all.begin(), all.end(), 0);
    auto list = runtime_.upload(arena_, std::move(all));
    auto next = arena_.allocate<cl_int>(count);
    const Buffer<cl_int> known =
        proposals.winners > 0 ? proposals.cavities : arena_.allocate<cl_int>(1);  // nobody reads it
    for (std::size_t waiting = count; waiting > 0;) {
      Arena::Scope scope(arena_);
      const auto sizes = arena_.allocate<cl_uint>(waiting + 1);
      const auto waits = arena_.allocate<cl_uchar>(waiting);
      const cl_uint first = take_claims(ranks);
      runtime_.map_in_small_groups(waiting, kernels::claim_points{.rules = rules_,
                                                                  .step = step_,
                                                                  .is_first = waiting == count,
                                                                  .first = first,
                                                                  .listed = proposals.listed,
                                                                  .list = list,
                                                                  .cavities = known,
                                                                  .refined_mesh = refined_mesh(),
                                                                  .claims = arrays_.claims,
                                                                  .insertions = insertions,
                                                                  .sizes = sizes,
                                                                  .states = states});
      host::exclusive_scan(runtime_, sizes, waiting, sizes);
      const std::size_t all_sides = runtime_.read_one(sizes, waiting);
      const auto sides = arena_.allocate<star_side>(all_sides);
      const auto made_at = arena_.allocate<cl_uint>(waiting + 1);
      runtime_.map(waiting, kernels::gather_stars{.first = first,
                                                  .list = list,
                                                  .offsets = sizes,
                                                  .insertions = insertions,
                                                  .refined_mesh = refined_mesh(),
                                                  .claims = arrays_.claims,
                                                  .visits = arrays_.visits,
                                                  .sides = sides,
                                                  .states = states,
                                                  .made_sizes = made_at});
      host::exclusive_scan(runtime_, made_at, waiting, made_at);
      const std::size_t made_count = runtime_.read_one(made_at, waiting);
      reserve_made(made_count_ + made_count);
      runtime_.map(waiting, kernels::insert_stars{.step = step_,
                                                  .first_made = static_cast<int>(made_count_),
                                                  .list = list,
                                                  .offsets = sizes,
                                                  .made_at = made_at,
                                                  .insertions = insertions,
                                                  .states = states,
                                                  .sides = sides,
                                                  .places = arrays_.places,
                                                  .rows = arrays_.rows,
                                                  .row_keys = arrays_.keys,
                                                  .refused = arrays_.refused,
                                                  .made = made_,
                                                  .waits = waits});
      if (split_count > 0) {
        runtime_.map(waiting, kernels::freeze_constraints{.list = list,
                                                          .insertions = insertions,
                                                          .states = states,
                                                          .points = arrays_.points,
                                                          .rows = arrays_.rows});
      }
      made_count_ += made_count;
      ++step_;
      const auto [at, left] = host::pack_positions(runtime_, waits, waiting, 1);
      runtime_.map(left, kernels::gather_elements{.positions = at, .from = list, .list = next});
      std::swap(list, next);
      if (left == waiting) {
        throw Error(ErrorKind::internal,
                    "points to be inserted wait for each other; please report the input");
      }
      waiting = left;
    }
  }

  // -------------------------------------------------------------------------------------------------------
  // Smoothing

  void smooth_once() {
    Arena::Scope scope(arena_);
    // With angles of 20 degrees no constraint is encroached.
    kernel::refinement_rules rules = rules_;
    rules.squared_sine = quality_bounds(std::max(wanted_.min_angle, kSmoothedAngle)).squared_sine;
    const auto [changed, count] = smooth(runtime_, {.rows = rows_,
                                                    .vertices = vertices_,
                                                    .rules = rules,
                                                    .mesh = refined_mesh(),
                                                    .triangles = arrays_.rows,
                                                    .points = arrays_.points,
                                                    .keys = arrays_.keys,
                                                    .refused = arrays_.refused});
    made_count_ = 0;
    reserve_made(count);
    runtime_.map(count, kernels::list_changed{.positions = changed, .rows = arrays_.rows, .made = made_});
    made_count_ = count;
  }

  void measure_before_smoothing() {
    const Here<mesh_row> rows(runtime_, arrays_.rows, rows_);
    const Here<double> coordinates(runtime_, arrays_.points.as<cl_double>(), 2 * vertices_);
    for (std::size_t t = 0; t < rows_; ++t) {
      if (rows[t].corner[0] != kernel::NO_TRIANGLE) before_smoothing_.add(&coordinates[0], rows[t].corner);
    }
  }

  // -------------------------------------------------------------------------------------------------------
  // The result

  RefinedMesh result() {
    RefinedMesh refined;
    Arena::Scope scope(arena_);
    const auto excuses_there = arena_.allocate<cl_uchar>(rows_);
    runtime_.map_in_small_groups(rows_, kernels::report_rows{.rules = rules_,
                                                             .refined_mesh = refined_mesh(),
                                                             .refused = arrays_.refused,
                                                             .excuses = excuses_there});
    const Here<cl_uchar> excuses(runtime_, excuses_there, rows_);
    const Here<mesh_row> rows(runtime_, arrays_.rows, rows_);
    const Here<double> coordinates(runtime_, arrays_.points.as<cl_double>(), 2 * vertices_);
    const Here<edge_place> places(runtime_, arrays_.places, vertices_);

    // Rows and vertices of points that were dropped are left out.
    std::vector<std::int32_t> row_of(rows_, -1), vertex_of(vertices_, -1);
    std::int32_t row_count = 0;
    for (std::size_t t = 0; t < rows_; ++t) {
      if (rows[t].corner[0] == kernel::NO_TRIANGLE) continue;
      row_of[t] = row_count++;
      for (const int v : rows[t].corner) vertex_of[v] = 0;
    }
    std::int32_t vertex_count = static_cast<std::int32_t>(mesh_.points);
    for (std::size_t v = 0; v < mesh_.points; ++v) vertex_of[place_of_[v]] = static_cast<std::int32_t>(v);
    for (std::size_t v = mesh_.points; v < vertices_; ++v) {
      if (vertex_of[v] == 0) {
        vertex_of[v] = vertex_count++;
        for (int k = 0; k < 2; ++k) refined.added.push_back(std::ldexp(coordinates[2 * v + k], -shift_));
        refined.added_edges.push_back(places[v].edge);
        refined.added_places.push_back(places[v].part);
        if (places[v].edge >= 0) ++report_.split_points;
      }
    }
    const Excuse at_limit = report_.rounds >= wanted_.most_rounds ? Excuse::most_rounds : Excuse::most_points;
    const std::size_t all = static_cast<std::size_t>(row_count);
    for (auto* const array : {&refined.triangles, &refined.neighbors, &refined.edges}) {
      runtime_.resize(*array, 3 * all);
    }
    runtime_.resize(refined.parents, all);
    const auto write_row = [&](std::size_t t) {
      const mesh_row& row = rows[t];
      int first = 0;
      for (int k = 1; k < 3; ++k) {
        if (vertex_of[row.corner[k]] < vertex_of[row.corner[first]]) first = k;
      }
      const std::size_t to = 3 * static_cast<std::size_t>(row_of[t]);
      for (int k = 0; k < 3; ++k) {
        const int from = (first + k) % 3;
        refined.triangles[to + k] = vertex_of[row.corner[from]];
        refined.neighbors[to + k] = row.neighbor[from] < 0 ? -1 : row_of[row.neighbor[from]];
        refined.edges[to + k] = row.edge[from] < 0 ? -1 : row.edge[from] & kernel::EDGE_NUMBER;
      }
      refined.parents[to / 3] = row.parent;
    };
    const auto write_part = [&](std::size_t part) {
      for (std::size_t t = part * kPartOfRows; t < std::min(rows_, (part + 1) * kPartOfRows); ++t) {
        if (row_of[t] >= 0) write_row(t);
      }
    };
    const std::size_t parts = (rows_ + kPartOfRows - 1) / kPartOfRows;
    if (runtime_.is_native()) {
      runtime_.share(parts, write_part);
    } else {
      for (std::size_t part = 0; part < parts; ++part) write_part(part);
    }
    for (std::size_t t = 0; t < rows_; ++t) {
      if (row_of[t] >= 0 && excuses[t] != kernel::EXCUSED_NOT) {
        report_.bad_triangles.push_back(row_of[t]);
        // Without the limit, those at frozen constraints would be tried again.
        const bool is_limited =
            excuses[t] == kernel::EXCUSED_LIMIT || (excuses[t] == kernel::EXCUSED_FROZEN && is_at_limit());
        report_.excuses.push_back(is_limited ? at_limit : static_cast<Excuse>(excuses[t]));
      }
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
  int shift_ = 0;
  double extent_ = 0, largest_ = 0;  // scaled: the larger side of the bounding box, the largest coordinate
  kernel::refinement_rules rules_{};
  std::vector<std::int32_t> place_of_;  // per point of the mesh the number of its vertex here
  std::vector<double2> points_;         // scaled, by these numbers
  Arrays arrays_;
  Buffer<cl_int> ends_{}, wedges_{};
  Buffer<cl_double> parent_areas_{};
  Buffer<mesh_row> given_{};  // the rows at first, if triangles of one region have different areas
  Buffer<cl_int2> made_{};    // what the last round has made: rows and their first vertices
  std::size_t rows_ = 0, vertices_ = 0, row_room_ = 0, vertex_room_ = 0, made_count_ = 0, bad_count_ = 0,
              added_ = 0, tried_ = 0;
  cl_uint next_claim_ = 0;
  int step_ = 1;  // of all that insert points, counted from the beginning
  bool may_propose_ = false;
  int listed_ = kFewestListed;
  RefinementReport report_;
  Angles before_smoothing_{true};
};

}  // namespace

RefinedMesh refine(host::Runtime& runtime, const MeshToRefine& mesh, const Refinement& wanted) {
  Arena::Scope scope(runtime.arena());
  return Rounds(runtime, mesh, wanted).run();
}

}  // namespace flaunay::constrained
