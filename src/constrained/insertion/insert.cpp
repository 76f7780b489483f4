#include "constrained/insertion/insert.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "arithmetic/records.h"
#include "constrained/codes.h"
#include "constrained/crossings/first_crossing.hpp"
#include "constrained/crossings/segment_set.hpp"
#include "constrained/insertion/chains.hpp"
#include "constrained/insertion/joined.hpp"
#include "constrained/limits.h"
#include "constrained/records.h"
#include "geometry/magnitudes.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/constrained/fill_filtered.cl.hpp"
#include "launchers/constrained/insert.cl.hpp"
#include "launchers/constrained/order.cl.hpp"
#include "launchers/constrained/segments.cl.hpp"
#include "points/download.hpp"
#include "points/inspect.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {
using namespace geometry;

namespace {

using host::Arena;
using points::DeviceMesh;
using points::download;

constexpr std::size_t kMostPieces = std::size_t{1} << 30, kMostRows = 0xffffffff;

// If segments are inserted in stages, each has kStageGrowth times as many as all stages before it together.
constexpr std::size_t kStageGrowth = 2, kSmallestStage = 16;

// Points as predicates need them.
struct ScaledPoints {
  Buffer<cl_double> coordinates{};
  geometry::Bounds bounds{};
};

geometry::Fitted<ScaledPoints> scale_points(host::Runtime& runtime, const DeviceMesh& mesh) {
  const auto uniform = points::make_uniform(runtime, mesh.coordinates, mesh.point_offsets);
  if (!uniform) return uniform.too_wide();
  return ScaledPoints{points::scaled(runtime, uniform->coordinates, mesh.points(), uniform->scaling.shift),
                      uniform->scaling.bounds};
}

// Pairs of ends, each pair once, in the order of their places.
struct UniquePairs {
  Buffer<cl_int> of{};  // per pair that was given its number, or -1
  Buffer<cl_ulong> keys{};
  std::size_t count = 0;
};

// The results of walk_segments.
struct Walks {
  Buffer<kernel::constraint_walk> walks{};
  Buffer<cl_int> ends{};
  Buffer<cl_uint> pieces{};
  Buffer<cl_uint2> sizes{};  // scanned
};

class Insertion {
 public:
  Insertion(host::Runtime& runtime, const DeviceMesh& delaunay, const Buffer<cl_int>& segments,
            std::size_t segment_count, const ScaledPoints& points, const ConstrainedBuffers& result)
      : runtime_(runtime),
        arena_(runtime.arena()),
        delaunay_(delaunay),
        segments_(segments),
        segment_count_(segment_count),
        points_(points),
        result_(result),
        n_(delaunay.points()),
        rows_(delaunay.triangle_count()) {
    status_ = arena_.allocate<cl_uint>(kernel::INSERTION_NUMBERS);
    marks_ = arena_.allocate<cl_uint>(n_ / 32 + 1);
    places_ = arena_.allocate<cl_uint>(n_);
    claims_ = arena_.allocate<cl_uint>(rows_);
    // Whole words.
    flags_ = arena_.allocate<cl_uchar>((rows_ + 3) / 4 * 4);
    changed_ = arena_.allocate<cl_uchar>(rows_);
  }

  void run(const ProvideEdges& provide) {
    copy_rows();
    clear_status();
    const Pairs ends{arena_.allocate<cl_int>(2 * segment_count_), segment_count_};
    clear_vertices(false);
    mark_ends(ends.ends);
    place_vertices(true);
    const Tuning& tuning = tuning_of(runtime_);
    insert_all(ends,
               {std::min(kMostPieces, tuning.pieces_most * (n_ + segment_count_)),
                std::min(kMostRows, tuning.walked_most * (rows_ + segment_count_))},
               result_.piece_edges, provide);
    order_rows();
    runtime_.map(rows_, kernels::write_constrained{.flags = flags_, .constrained = result_.constrained});
    write_halfedges();
  }

 private:
  // Vertices, two each.
  struct Pairs {
    Buffer<cl_int> ends{};
    std::size_t count = 0;
  };

  // Limits for all segments together.
  struct Limits {
    std::size_t pieces = kMostPieces, rows = kMostRows;
  };

  // Inserts segments, and numbers their edges. ranges: see ConstrainedTriangulation::piece_edges.
  void insert_all(const Pairs& segments, const Limits& limits, const Buffer<cl_int>& ranges,
                  const ProvideEdges& provide) {
    UniquePairs unique = unique_pairs(segments);
    if (status(kernel::INSERTION_WRONG) != 0) throw_wrong();
    Walks walks = walk(unique, limits);
    bool overlaps = status(kernel::INSERTION_PIECES) > limits.pieces;
    if (!overlaps && status(kernel::INSERTION_STOPPED) != 0) {
      overlaps = !insert_in_stages(segments, limits.pieces);
      if (!overlaps) {
        clear_claims();
        unique = unique_pairs(segments);
        walks = walk(unique, {.pieces = limits.pieces});
        overlaps = status(kernel::INSERTION_PIECES) > limits.pieces;
      }
    }
    if (overlaps) return insert_joined(segments, limits, provide);
    if (status(kernel::INSERTION_PIECES) == 0) {
      insert(walks, unique.count);
      return number_edges(unique, walks.ends, ranges, provide);
    }
    const Pairs all = write_pieces(unique, walks);
    start_again();
    const UniquePairs pieces = unique_pairs(all);
    const Walks of_pieces = walk(pieces, {});
    insert(of_pieces, pieces.count);
    number_chained(unique, walks.pieces, pieces, of_pieces.ends, ranges, provide);
  }

  // Makes segments edges, a random part of them first: then those that come later cross few triangles.
  // Returns false, with some inserted, if they have too many pieces.
  bool insert_in_stages(const Pairs& segments, std::size_t most_pieces) {
    const std::vector<std::int32_t> ends = download(runtime_, segments.ends, 2 * segments.count);
    // The numbers are always the same.
    std::minstd_rand random;
    std::vector<std::vector<std::int32_t>> stages(1);
    for (std::size_t most = kSmallestStage; most < segments.count; most *= kStageGrowth)
      stages.emplace_back();
    for (std::size_t s = 0; s < segments.count; ++s) {
      std::size_t stage = stages.size() - 1;
      while (stage > 0 && random() % kStageGrowth == 0) --stage;
      stages[stage].insert(stages[stage].end(), {ends[2 * s], ends[2 * s + 1]});
    }
    for (std::vector<std::int32_t>& stage : stages) {
      Arena::Scope scope(arena_);
      const std::size_t count = stage.size() / 2;
      if (count == 0) continue;
      clear_claims();
      const UniquePairs unique = unique_pairs({runtime_.upload(arena_, std::move(stage)), count});
      const Walks walks = walk(unique, {.pieces = most_pieces});
      if (status(kernel::INSERTION_PIECES) > most_pieces) return false;
      if (status(kernel::INSERTION_PIECES) == 0) {
        insert(walks, unique.count);
      } else {
        const Pairs all = write_pieces(unique, walks);
        start_again();
        const UniquePairs pieces = unique_pairs(all);
        insert(walk(pieces, {}), pieces.count);
      }
    }
    return true;
  }

  // Inserts segments that have very many edges in common: each line that they cover once.
  void insert_joined(const Pairs& segments, const Limits& limits, const ProvideEdges& provide) {
    const std::vector<double> coordinates = read_coordinates();
    const JoinedSegments joined(coordinates, delaunay_.point_offsets,
                                download(runtime_, segments.ends, 2 * segments.count));
    const std::size_t count = joined.joined().size() / 2;
    const auto ranges = arena_.allocate<cl_int>(2 * count);
    Pairs edges;
    start_again();
    insert_all({runtime_.upload(arena_, joined.joined()), count}, {.rows = limits.rows}, ranges,
               [&](std::size_t edge_count) {
                 edges = {provide(edge_count), edge_count};
                 return edges.ends;
               });
    const std::vector<std::int32_t> found = joined.segment_edges(
        download(runtime_, edges.ends, 2 * edges.count), download(runtime_, ranges, 2 * count));
    runtime_.write(result_.piece_edges, 0, found.size(), found.data());
  }

  Pairs write_pieces(const UniquePairs& segments, const Walks& walks) {
    host::exclusive_scan(runtime_, walks.pieces, segments.count, walks.pieces);
    const std::size_t all = runtime_.read_one(walks.pieces, segments.count);
    const Pairs pieces{arena_.allocate<cl_int>(2 * all), all};
    runtime_.map_in_small_groups(segments.count, kernels::write_pieces{.bound = points_.bounds.orient,
                                                                       .points = points_.coordinates,
                                                                       .triangulation = triangulation(),
                                                                       .hull = delaunay_.hull,
                                                                       .keys = segments.keys,
                                                                       .offsets = walks.pieces,
                                                                       .claims = claims_,
                                                                       .ends = pieces.ends});
    return pieces;
  }

  // For others of the segments. Insertion keeps the places of all ends.
  void clear_claims() {
    clear_status();
    runtime_.fill(claims_, rows_, cl_uint{UNCLAIMED});
  }
  // Starts again for other segments, in the present triangulation.
  void start_again() {
    clear_status();
    clear_vertices(true);
    place_vertices(false);
  }

  void copy_rows() {
    const bool is_in_place = result_.triangles.memory() == delaunay_.triangles.memory();
    before_ = is_in_place ? arena_.allocate<cl_int>(3 * rows_) : delaunay_.triangles;
    runtime_.copy(delaunay_.triangles, 0, is_in_place ? before_ : result_.triangles, 0, 3 * rows_);
    if (result_.neighbors.memory() != delaunay_.neighbors.memory()) {
      runtime_.copy(delaunay_.neighbors, 0, result_.neighbors, 0, 3 * rows_);
    }
  }

  // The numbers as of the last wait.
  cl_uint status(int which) const { return last_status_[which]; }
  void clear_status() {
    runtime_.fill(status_, kernel::INSERTION_NUMBERS, cl_uint{0});
    std::fill_n(last_status_, kernel::INSERTION_NUMBERS, 0);
  }
  void read_status() {
    runtime_.read(status_, 0, kernel::INSERTION_NUMBERS, last_status_);
    if (status(kernel::INSERTION_BROKEN) != 0) throw_broken();
  }

  [[noreturn]] static void throw_broken() {
    throw Error(ErrorKind::internal, "a segment leaves the triangulation; please report the input");
  }
  [[noreturn]] void throw_wrong() {
    check_segments(delaunay_.point_offsets, read_segments());
    throw Error(ErrorKind::internal, "a device finds wrong segments, the host does not");
  }
  [[noreturn]] void throw_crossing() {
    check_crossings(read_coordinates().data(), delaunay_.point_offsets, read_segments());
    throw Error(ErrorKind::internal, "a device finds segments that cross, the host does not");
  }

  std::vector<double> read_coordinates() { return download(runtime_, delaunay_.coordinates, 2 * n_); }
  std::vector<std::int32_t> read_segments() { return download(runtime_, segments_, 2 * segment_count_); }

  void clear_vertices(bool all) {
    runtime_.map(n_, kernels::clear_vertices{.all = all, .marks = marks_, .places = places_});
  }
  void mark_ends(const Buffer<cl_int>& ends) {
    runtime_.map(segment_count_, kernels::mark_ends{.points = n_,
                                                    .sets = delaunay_.sets(),
                                                    .offsets = runtime_.upload(
                                                        arena_, points::integers(delaunay_.point_offsets)),
                                                    .segments = segments_,
                                                    .representatives = delaunay_.representatives,
                                                    .ends = ends,
                                                    .marks = marks_,
                                                    .status = status_});
  }
  void place_vertices(bool is_first) {
    runtime_.chunks(rows_, runtime_.sizes().chunk(rows_),
                    kernels::start_rows{.is_first = is_first,
                                        .triangles = result_.triangles,
                                        .marks = marks_,
                                        .places = places_,
                                        .claims = claims_,
                                        .flags = flags_,
                                        .changed = changed_});
    const auto& triangle_offsets = delaunay_.triangle_offsets;
    if (std::adjacent_find(triangle_offsets.begin(), triangle_offsets.end()) == triangle_offsets.end())
      return;
    runtime_.map(delaunay_.hull_offsets.back(),
                 kernels::line_places{
                     .sets = delaunay_.sets(),
                     .triangle_offsets = runtime_.upload(arena_, points::integers(triangle_offsets)),
                     .hull_offsets = runtime_.upload(arena_, points::integers(delaunay_.hull_offsets)),
                     .hull = delaunay_.hull,
                     .places = places_});
  }

  UniquePairs unique_pairs(const Pairs& pairs) {
    const std::size_t count = pairs.count;
    UniquePairs unique{arena_.allocate<cl_int>(count), arena_.allocate<cl_ulong>(count)};
    Arena::Scope scope(arena_);
    const auto keys = arena_.allocate<cl_ulong>(count);
    const auto payloads = arena_.allocate<cl_int>(count);
    const auto ranks = arena_.allocate<cl_uint>(count + 1);
    runtime_.map(count, kernels::segment_keys{
                            .ends = pairs.ends, .places = places_, .keys = keys, .payloads = payloads});
    host::sort_by_key(runtime_, keys, payloads, count);
    runtime_.map(count, kernels::find_runs{.keys = keys, .counts = ranks});
    host::exclusive_scan(runtime_, ranks, count, ranks);
    runtime_.map(count, kernels::write_unique{.keys = keys,
                                              .payloads = payloads,
                                              .ranks = ranks,
                                              .unique_of = unique.of,
                                              .unique = unique.keys});
    cl_uint total = 0;
    runtime_.read_later(ranks, count, 1, &total);
    read_status();
    unique.count = total;
    return unique;
  }

  // Arguments that several kernels have in common (kernels/constrained/arguments.h).
  kernels::triangulation triangulation() const {
    return {.triangles = result_.triangles, .neighbors = result_.neighbors};
  }
  kernels::rebuilt_rows rebuilt_rows(const Buffer<kernel::chain_entry>& entries) const {
    return {.triangles = result_.triangles,
            .neighbors = result_.neighbors,
            .claims = claims_,
            .flags = flags_,
            .changed = changed_,
            .new_corners = new_corners_,
            .entries = entries};
  }

  Walks walk(const UniquePairs& pairs, const Limits& limits) {
    const std::size_t count = pairs.count;
    const Walks made{arena_.allocate<kernel::constraint_walk>(count), arena_.allocate<cl_int>(2 * count),
                     arena_.allocate<cl_uint>(count + 1), arena_.allocate<cl_uint2>(count + 1)};
    runtime_.map_in_small_groups(count, kernels::walk_segments{.most_pieces = limits.pieces,
                                                               .most_rows = limits.rows,
                                                               .bound = points_.bounds.orient,
                                                               .points = points_.coordinates,
                                                               .triangulation = triangulation(),
                                                               .hull = delaunay_.hull,
                                                               .keys = pairs.keys,
                                                               .claims = claims_,
                                                               .flags = flags_.as<cl_uint>(),
                                                               .walks = made.walks,
                                                               .ends = made.ends,
                                                               .pieces = made.pieces,
                                                               .sizes = made.sizes,
                                                               .status = status_});
    read_status();
    host::exclusive_scan(runtime_, made.sizes, count, made.sizes);
    return made;
  }

  // -------------------------------------------------------------------------------------------------------
  // Rounds

  // The constraints that are left in a round, and their outcomes.
  struct Waiting {
    Buffer<cl_int> list{};
    Buffer<cl_uint> offsets{};
    Buffer<cl_uchar> outcomes{};
    Buffer<cl_int> lefts{};
    std::size_t count = 0;
    cl_uint mark = 0;
  };

  void insert(const Walks& walks, std::size_t constraints) {
    Arena::Scope scope(arena_);
    Waiting waiting{arena_.allocate<cl_int>(constraints), arena_.allocate<cl_uint>(constraints),
                    arena_.allocate<cl_uchar>(constraints), arena_.allocate<cl_int>(constraints)};
    auto next_list = arena_.allocate<cl_int>(constraints);
    new_corners_ = arena_.allocate<cl_int>(3 * rows_);
    cl_uint long_before = 0;
    std::size_t before = constraints;
    for (cl_uint round = 0;; ++round) {
      cl_uint2 total{};
      runtime_.read_later(walks.sizes, before, 1, &total);
      read_status();
      if (status(kernel::INSERTION_CROSSED) != 0) throw_crossing();
      waiting.count = total.s[1];
      if (waiting.count == 0) return;
      // The constraint with the smallest rank always wins.
      if (round > 0 && waiting.count == before) throw_broken();
      runtime_.map(before, kernels::keep_waiting{.is_first = round == 0,
                                                 .list = waiting.list,
                                                 .sizes = walks.sizes,
                                                 .waiting = next_list,
                                                 .offsets = waiting.offsets});
      std::swap(waiting.list, next_list);
      waiting.mark = mark_of(round);
      const bool any_long = status(kernel::INSERTION_LONG) != long_before;
      long_before = status(kernel::INSERTION_LONG);
      insert_winners(walks, waiting, total.s[0], any_long);
      walk_again(walks, waiting);
      before = waiting.count;
    }
  }

  static cl_uint mark_of(cl_uint round) { return RANK_WON | round; }

  void insert_winners(const Walks& walks, const Waiting& waiting, std::size_t entry_count, bool any_long) {
    Arena::Scope scope(arena_);
    const auto entries = arena_.allocate<kernel::chain_entry>(entry_count);
    runtime_.map(waiting.count, kernels::choose_constraints{.bound = points_.bounds.orient,
                                                            .list = waiting.list,
                                                            .offsets = waiting.offsets,
                                                            .points = points_.coordinates,
                                                            .triangulation = triangulation(),
                                                            .claims = claims_,
                                                            .flags = flags_,
                                                            .walks = walks.walks,
                                                            .outcomes = waiting.outcomes,
                                                            .lefts = waiting.lefts,
                                                            .entries = entries,
                                                            .status = status_});
    LongWinners winners;
    if (any_long) winners = gather_long(walks, waiting);
    if (pays_to_filter(waiting)) fill_cavities<kernels::fill_filtered>(walks, waiting, entries);
    fill_cavities<kernels::fill_cavities>(walks, waiting, entries);
    if (winners.count > 0) fill_long(waiting, winners);
    runtime_.map(waiting.count, kernels::join_cavities{.mark = waiting.mark,
                                                       .list = waiting.list,
                                                       .offsets = waiting.offsets,
                                                       .lefts = waiting.lefts,
                                                       .walks = walks.walks,
                                                       .claims = claims_,
                                                       .marks = marks_,
                                                       .new_corners = new_corners_,
                                                       .entries = entries,
                                                       .outcomes = waiting.outcomes,
                                                       .neighbors = result_.neighbors,
                                                       .places = places_});
    if (winners.count > 0) {
      runtime_.map(winners.entry_count, kernels::join_long{.mark = waiting.mark,
                                                           .claims = claims_,
                                                           .marks = marks_,
                                                           .new_corners = new_corners_,
                                                           .entries = winners.entries,
                                                           .neighbors = result_.neighbors,
                                                           .places = places_});
    }
  }

  // Whether a device has more cavities than lanes that have enough registers for exact predicates. Most
  // cavities need no exact predicates.
  bool pays_to_filter(const Waiting& waiting) const {
    return !runtime_.is_native() && waiting.count > tuning_of(runtime_).merge_items &&
           tuning_of(runtime_).merge_items > 0 && points_.bounds.coarse == 0 && points_.bounds.circle != 0;
  }

  // kernels::fill_cavities or kernels::fill_filtered.
  template <typename Kernel>
  void fill_cavities(const Walks& walks, const Waiting& waiting, const Buffer<kernel::chain_entry>& entries) {
    runtime_.map_in_small_groups(waiting.count, Kernel{.mark = waiting.mark,
                                                       .bound = points_.bounds.circle,
                                                       .list = waiting.list,
                                                       .offsets = waiting.offsets,
                                                       .outcomes = waiting.outcomes,
                                                       .lefts = waiting.lefts,
                                                       .walks = walks.walks,
                                                       .points = points_.coordinates,
                                                       .rebuilt_rows = rebuilt_rows(entries)});
  }

  void walk_again(const Walks& walks, const Waiting& waiting) {
    runtime_.map_in_small_groups(waiting.count, kernels::walk_constraints{.bound = points_.bounds.orient,
                                                                          .list = waiting.list,
                                                                          .outcomes = waiting.outcomes,
                                                                          .points = points_.coordinates,
                                                                          .triangulation = triangulation(),
                                                                          .places = places_,
                                                                          .claims = claims_,
                                                                          .walks = walks.walks,
                                                                          .sizes = walks.sizes,
                                                                          .status = status_});
    host::exclusive_scan(runtime_, walks.sizes, waiting.count, walks.sizes);
  }

  // Winners with long walks.
  struct LongWinners {
    std::size_t count = 0, entry_count = 0;
    Buffer<kernel::chain_entry> entries{};
    Buffer<cl_int> chain_offsets{}, triangles{};
  };

  LongWinners gather_long(const Walks& walks, const Waiting& waiting) {
    const auto [list, count] =
        host::pack_positions(runtime_, waiting.outcomes, waiting.count, kernel::CONSTRAINT_FITS_LONG);
    LongWinners winners;
    if (count == 0) return winners;
    winners.count = count;
    const auto offsets = arena_.allocate<cl_uint>(count + 1);
    runtime_.map(count, kernels::measure_long{
                            .winners = list, .list = waiting.list, .walks = walks.walks, .counts = offsets});
    host::exclusive_scan(runtime_, offsets, count, offsets);
    winners.entry_count = runtime_.read_one(offsets, count);
    winners.entries = arena_.allocate<kernel::chain_entry>(winners.entry_count);
    winners.chain_offsets = arena_.allocate<cl_int>(2 * count + 1);
    winners.triangles = arena_.allocate<cl_int>(3 * (winners.entry_count - 4 * count));
    runtime_.map(count, kernels::gather_long{.bound = points_.bounds.orient,
                                             .winners = list,
                                             .list = waiting.list,
                                             .offsets = offsets,
                                             .walks = walks.walks,
                                             .points = points_.coordinates,
                                             .triangulation = triangulation(),
                                             .claims = claims_,
                                             .flags = flags_,
                                             .entries = winners.entries,
                                             .chain_offsets = winners.chain_offsets});
    Arena::Scope scope(arena_);
    const auto chain = arena_.allocate<cl_int>(winners.entry_count);
    runtime_.map(winners.entry_count, kernels::chain_vertices{.entries = winners.entries, .chain = chain});
    triangulate_chains(runtime_,
                       {.count = 2 * count,
                        .vertices = winners.entry_count,
                        .circle_bound = points_.bounds.circle,
                        .points = aligned_points(),
                        .offsets = winners.chain_offsets,
                        .chain = chain},
                       winners.triangles);
    return winners;
  }

  // The caller's points may be aligned to single coordinates only.
  Buffer<cl_double2> aligned_points() {
    if (runtime_.is_native()) return points_.coordinates.as<cl_double2>();
    const auto aligned = arena_.allocate<cl_double>(2 * n_);
    runtime_.copy(points_.coordinates, 0, aligned, 0, 2 * n_);
    return aligned.as<cl_double2>();
  }

  void fill_long(const Waiting& waiting, const LongWinners& winners) {
    runtime_.map(winners.entry_count - 4 * winners.count,
                 kernels::fill_long{.mark = waiting.mark,
                                    .chains = 2 * winners.count,
                                    .chain_offsets = winners.chain_offsets,
                                    .chain_triangles = winners.triangles,
                                    .rebuilt_rows = rebuilt_rows(winners.entries)});
  }

  // -------------------------------------------------------------------------------------------------------
  // Results

  void number_edges(const UniquePairs& edges, const Buffer<cl_int>& ends, const Buffer<cl_int>& ranges,
                    const ProvideEdges& provide) {
    const Buffer<cl_int> made = provide(edges.count);
    Arena::Scope scope(arena_);
    const auto keys = arena_.allocate<cl_ulong>(edges.count);
    const auto payloads = arena_.allocate<cl_int>(edges.count);
    const auto numbers = arena_.allocate<cl_int>(edges.count);
    runtime_.map(
        edges.count,
        kernels::edge_keys{
            .with_chains = false, .ends = ends, .heads = payloads, .keys = keys, .payloads = payloads});
    host::sort_by_key(runtime_, keys, payloads, edges.count);
    runtime_.map(edges.count, kernels::number_edges{
                                  .keys = keys, .payloads = payloads, .numbers = numbers, .edges = made});
    runtime_.map(edges.of.size(), kernels::write_segments{.with_pieces = false,
                                                          .unique_of = edges.of,
                                                          .offsets = Buffer<cl_uint>(),
                                                          .piece_of = edges.of,
                                                          .numbers = numbers,
                                                          .segment_edges = ranges});
  }

  void number_chained(const UniquePairs& segments, const Buffer<cl_uint>& offsets, const UniquePairs& edges,
                      const Buffer<cl_int>& ends, const Buffer<cl_int>& ranges, const ProvideEdges& provide) {
    const Buffer<cl_int> made = provide(edges.count);
    Arena::Scope scope(arena_);
    const std::size_t count = edges.count;
    const auto next = arena_.allocate<cl_int>(count), previous = arena_.allocate<cl_int>(count);
    runtime_.fill(next, count, cl_int{-1});
    runtime_.fill(previous, count, cl_int{-1});
    runtime_.map(
        segments.count,
        kernels::link_pieces{.offsets = offsets, .piece_of = edges.of, .next = next, .previous = previous});
    auto heads = arena_.allocate<cl_int>(count), distances = arena_.allocate<cl_int>(count);
    auto next_heads = arena_.allocate<cl_int>(count), next_distances = arena_.allocate<cl_int>(count);
    runtime_.map(count, kernels::start_chains{.previous = previous, .heads = heads, .distances = distances});
    for (std::size_t reach = 1; reach < count; reach *= 2) {
      runtime_.map(count, kernels::jump{.heads = heads,
                                        .distances = distances,
                                        .next_heads = next_heads,
                                        .next_distances = next_distances});
      std::swap(heads, next_heads);
      std::swap(distances, next_distances);
    }
    const auto keys = arena_.allocate<cl_ulong>(count);
    const auto payloads = arena_.allocate<cl_int>(count), numbers = arena_.allocate<cl_int>(count);
    const auto lengths = arena_.allocate<cl_uint>(count), counts = arena_.allocate<cl_uint>(count + 1);
    runtime_.map(count, kernels::measure_chains{
                            .next = next, .heads = heads, .distances = distances, .lengths = lengths});
    runtime_.map(count,
                 kernels::edge_keys{
                     .with_chains = true, .ends = ends, .heads = heads, .keys = keys, .payloads = payloads});
    host::sort_by_key(runtime_, keys, payloads, count);
    runtime_.map(count, kernels::sorted_lengths{
                            .keys = keys, .payloads = payloads, .lengths = lengths, .counts = counts});
    host::exclusive_scan(runtime_, counts, count, counts);
    runtime_.map(count, kernels::start_numbers{
                            .keys = keys, .payloads = payloads, .counts = counts, .starts = lengths});
    runtime_.map(count, kernels::number_chained{.heads = heads,
                                                .distances = distances,
                                                .starts = lengths,
                                                .ends = ends,
                                                .numbers = numbers,
                                                .edges = made});
    runtime_.map(segments.of.size(), kernels::write_segments{.with_pieces = true,
                                                             .unique_of = segments.of,
                                                             .offsets = offsets,
                                                             .piece_of = edges.of,
                                                             .numbers = numbers,
                                                             .segment_edges = ranges});
  }

  void order_rows() {
    Arena::Scope scope(arena_);
    const auto [changed, count] = host::pack_positions(runtime_, changed_, rows_, 1);
    if (count == 0) return;
    const auto row_at = arena_.allocate<cl_int>(2 * n_);
    runtime_.map(count,
                 kernels::note_rows{
                     .rows = changed, .triangles = before_, .points = points_.coordinates, .row_at = row_at});
    const auto triangles = arena_.allocate<cl_int>(3 * count);
    const auto neighbors = arena_.allocate<cl_uint>(3 * count);
    const auto flags = arena_.allocate<cl_uchar>(count);
    // Claims are not needed any more.
    runtime_.map(count, kernels::take_rows{.rows = changed,
                                           .row_at = row_at,
                                           .points = points_.coordinates,
                                           .triangles = result_.triangles,
                                           .neighbors = result_.neighbors,
                                           .flags = flags_,
                                           .changed = changed_,
                                           .copied_triangles = triangles,
                                           .copied_neighbors = neighbors,
                                           .copied_flags = flags,
                                           .places = claims_});
    runtime_.map(count, kernels::put_rows{.rows = changed,
                                          .copied_triangles = triangles,
                                          .copied_neighbors = neighbors,
                                          .copied_flags = flags,
                                          .places = claims_,
                                          .triangles = result_.triangles,
                                          .neighbors = result_.neighbors,
                                          .flags = flags_});
  }

  void write_halfedges() {
    if (result_.halfedges.memory() == nullptr) return;
    runtime_.map(
        rows_, kernels::write_row_halfedges{.neighbors = result_.neighbors, .halfedges = result_.halfedges});
  }

  host::Runtime& runtime_;
  Arena& arena_;
  const DeviceMesh& delaunay_;
  const Buffer<cl_int>& segments_;
  std::size_t segment_count_;
  const ScaledPoints& points_;
  const ConstrainedBuffers& result_;
  std::size_t n_, rows_;

  Buffer<cl_int> before_{};  // the Delaunay triangles
  Buffer<cl_uint> status_{};
  cl_uint last_status_[kernel::INSERTION_NUMBERS] = {};
  Buffer<cl_uint> marks_{};       // a bit per vertex: whether it is an end of a constraint
  Buffer<cl_uint> places_{};      // per marked vertex: a corner at which it is, or its place on the line
  Buffer<cl_uint> claims_{};      // per row: the smallest rank of the constraints that cross it
  Buffer<cl_uchar> flags_{};      // per row: see edge_flag
  Buffer<cl_uchar> changed_{};    // per row: whether it is new
  Buffer<cl_int> new_corners_{};  // see replaced_rows
};

}  // namespace

geometry::Fitted<geometry::Done> constrain(host::Runtime& runtime, const DeviceMesh& delaunay,
                                           const Buffer<cl_int>& segments, std::size_t segment_count,
                                           const ConstrainedBuffers& result, const ProvideEdges& provide) {
  Arena::Scope scope(runtime.arena());
  const auto points = scale_points(runtime, delaunay);
  if (!points) return points.too_wide();
  Insertion(runtime, delaunay, segments, segment_count, *points, result).run(provide);
  return geometry::Done();
}

}  // namespace flaunay::constrained
