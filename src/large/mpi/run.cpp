#include "large/mpi/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "arithmetic/records.h"
#include "geometry/arguments.hpp"
#include "geometry/euler.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "host/native/threads.hpp"
#include "large/chunks/finish.hpp"
#include "large/chunks/point_account.hpp"
#include "large/chunks/tree.hpp"
#include "large/mpi/move.hpp"
#include "large/mpi/sink.hpp"
#include "points/codes.h"

namespace flaunay::mpi {
namespace {

using chunks::ChunkPoints;
using chunks::ChunkTree;
using chunks::Cuts;
using chunks::FinishedChunk;
using geometry::Magnitudes;
using kernel::double2;
using kernel::vertex_box;
using Join = Ranks::Join;

// If a round hands on more than this share of its points, all go to one rank.
constexpr std::int64_t kMostHandedOnPercent = 70;
// While few ranks triangulate the remaining points, the others wait. So in later rounds a rank has this part
// of its points of the first round. With fewer than kLeastRoundPoints, a round costs more than it saves.
constexpr std::size_t kRoundPart = 16;
constexpr std::size_t kLeastRoundPoints = std::size_t{1} << 16;

// Throws Error(input) that names a point whose coordinate is not finite.
void check_finite(const GivenPoints& points, const Magnitudes& magnitudes, int rank) {
  if (magnitudes.bad == kernel::NO_BAD) return;
  const auto bad = static_cast<std::size_t>(magnitudes.bad);
  throw geometry::not_finite(static_cast<std::uint64_t>(points.first(rank)) + bad,
                             points.coordinates[2 * bad], points.coordinates[2 * bad + 1]);
}

// One rank's coordinate, on all ranks.
geometry::NamedCoordinate share_coordinate(Ranks& ranks, const geometry::NamedCoordinate& own, bool is_own) {
  const auto from = static_cast<int>(ranks.least(is_own ? ranks.rank() : ranks.size()));
  std::vector<geometry::NamedCoordinate> named = {own};
  ranks.broadcast(named, from);
  return named.front();
}

// Properties of the points of all ranks.
struct Frame {
  geometry::Scaling scaling;
  vertex_box all;
};

Frame find_frame(Ranks& ranks, host::Threads& threads, const GivenPoints& points) {
  chunks::PointAccount own;
  ranks.together([&] {
    own = chunks::account_of(threads, points.coordinates, points.count);
    check_finite(points, own.magnitudes, ranks.rank());
  });
  std::vector<std::int64_t> magnitudes = {own.magnitudes.largest, -std::int64_t{own.magnitudes.lowest}};
  ranks.join(magnitudes, Join::most);
  std::vector<double> box = {own.box.high.x, own.box.high.y, -own.box.low.x, -own.box.low.y};
  ranks.join(box, Join::most);
  Magnitudes all;
  all.largest = static_cast<int>(magnitudes[0]);
  all.lowest = static_cast<int>(-magnitudes[1]);
  if (geometry::differ_too_much(all)) {
    geometry::RangeEnds ends;
    ranks.together([&] {
      ends = geometry::find_ends(points.coordinates, 0, points.count, all);
      const auto first = static_cast<std::uint64_t>(points.first(ranks.rank()));
      ends.largest.point += first;
      ends.finest.point += first;
    });
    const geometry::NamedCoordinate largest =
        share_coordinate(ranks, ends.largest, own.magnitudes.largest == all.largest);
    const geometry::NamedCoordinate finest =
        share_coordinate(ranks, ends.finest, own.magnitudes.lowest == all.lowest);
    throw geometry::range_error(largest, finest, all);
  }
  return {geometry::scaling_for(all), {{-box[2], -box[3]}, {box[0], box[1]}}};
}

GivenPoints number_points(const Ranks& ranks, const double* coordinates, std::size_t n) {
  GivenPoints points{coordinates, n, {}};
  ranks.together([&] {
    check_array(coordinates, n, "points of one rank");
    if (ranks.size() > kMostRanks)
      throw Error(ErrorKind::usage,
                  fmt::format("{} ranks; at most {} are possible", ranks.size(), kMostRanks));
  });
  const std::vector<std::int64_t> counts = ranks.all(static_cast<std::int64_t>(n));
  points.begins.push_back(0);
  for (const std::int64_t count : counts) points.begins.push_back(points.begins.back() + count);
  return points;
}

// The ranks' places among each other, a round at a time.
class Run {
 public:
  Run(Ranks& ranks, const Solver& solver, const GivenPoints& points, const Options& options)
      : ranks_(ranks), solver_(solver), points_(points), sink_(ranks.rank(), options.neighbors) {
    round_points_ = options.round_points;
    if (round_points_ == 0) {
      const auto mean = static_cast<std::size_t>(points.total() / ranks.size());
      round_points_ = std::max(mean / kRoundPart, kLeastRoundPoints);
    }
    result_.statistics.device = solver.name;
    result_.statistics.points = static_cast<std::uint64_t>(points.total());
    result_.first_point = points.first(ranks.rank());
    last_time_ = host::now();
  }

  Triangulation run() {
    if (points_.total() == 0) return finish();
    frame_ = find_frame(ranks_, threads_, points_);
    end_phase("inspect");
    ChunkPoints own = place_given();
    end_phase("move");
    while (true) {
      ChunkPoints open = triangulate(std::move(own));
      end_phase(fmt::format("round {}", result_.statistics.rounds.size() - 1));
      if (workers_.count == 1) break;
      own = place_open(std::move(open));
      end_phase("hand on");
    }
    geometry::check_euler(result_.statistics.triangles, result_.statistics.hull_vertices,
                          result_.statistics.points - result_.statistics.duplicates);
    return finish();
  }

 private:
  void end_phase(const std::string& name) {
    const double now = host::now();
    result_.statistics.phases.push_back({name, now - last_time_});
    last_time_ = now;
  }

  // Throws Error(input) on all ranks if a rank cannot take its points.
  void check_capacity(std::size_t points) const {
    ranks_.together([&] {
      if (points <= solver_.capacity) return;
      throw Error(
          ErrorKind::input,
          fmt::format("{} points of {}{} are for this rank, but its device, {}, can take {} at once; take "
                      "more ranks, or devices with more memory",
                      points, points_.total(), reason_, solver_.name, solver_.capacity));
    });
    std::vector<double> used = {0};
    if (solver_.shares_memory) {
      used[0] = static_cast<double>(points) / static_cast<double>(std::max<std::size_t>(1, solver_.capacity));
    }
    ranks_.sum_here(used);
    ranks_.together([&] {
      if (used[0] <= 1) return;
      throw Error(
          ErrorKind::input,
          fmt::format("the ranks of this machine would need {:.1f} times the memory that is free; take more "
                      "machines, or fewer ranks of each",
                      used[0]));
    });
  }

  ChunkPoints place_given() {
    workers_ = {ranks_.size(), ranks_.size()};
    tree_ = make_tree(ranks_, points_.coordinates, points_.count, points_.first(ranks_.rank()),
                      points_.total(), workers_.count, Cuts::at_medians);
    return move_given(ranks_, threads_, points_, tree_, [&](std::size_t count) { check_capacity(count); });
  }

  ChunkPoints place_open(ChunkPoints open) {
    const std::vector<std::int64_t> counts = ranks_.all(static_cast<std::int64_t>(open.size()));
    const auto total = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
    const auto first = std::accumulate(counts.begin(), counts.begin() + ranks_.rank(), std::int64_t{0});
    const auto before = static_cast<std::int64_t>(result_.statistics.rounds.back().points);
    const auto wanted = (static_cast<std::size_t>(total) + round_points_ - 1) / round_points_;
    const bool stalls = 100 * total > kMostHandedOnPercent * before;
    if (stalls) reason_ = ", because too little is final on several ranks (as of points on one circle),";
    workers_.count = stalls ? 1 : static_cast<int>(std::min<std::size_t>(wanted, ranks_.size()));
    tree_ =
        make_tree(ranks_, open.coordinates.data(), open.size(), first, total, workers_.count, Cuts::in_gaps);
    return move_open(ranks_, std::move(open), tree_, workers_,
                     [&](std::size_t count) { check_capacity(count); });
  }

  // The rectangle of this rank, if it has points.
  vertex_box rectangle() const {
    std::size_t leaf = 0;
    while (workers_.rank_of(leaf) != ranks_.rank()) ++leaf;
    return tree_.rectangle(leaf, chunks::whole_plane());
  }

  // Returns the points that are handed on.
  ChunkPoints triangulate(ChunkPoints own) {
    const bool is_first = result_.statistics.rounds.empty(), is_last = workers_.count == 1;
    ChunkPoints open;
    enum { kPoints, kWorkers, kTriangles, kOpen, kDuplicates, kHull, kUndecided, kOnHost, kSums };
    std::vector<std::int64_t> sums(kSums, 0);
    const auto points = static_cast<std::int64_t>(own.size());
    ranks_.together([&] {
      if (own.size() == 0) return;
      flaunay::Triangulation mesh = solver_.triangulate(own.coordinates.data(), own.size());
      sums[kPoints] = points;
      sums[kWorkers] = 1;
      sums[kDuplicates] = static_cast<std::int64_t>(mesh.statistics.duplicates);
      sums[kUndecided] = static_cast<std::int64_t>(mesh.statistics.undecided);
      sums[kOnHost] = static_cast<std::int64_t>(mesh.statistics.host_points);
      const FinishedChunk finished(threads_, std::move(own), std::move(mesh), {rectangle(), frame_.all},
                                   frame_.scaling);
      sums[kTriangles] = static_cast<std::int64_t>(finished.triangles());
      if (!is_last) open = finished.handed_on(sink_.next_row());
      sums[kOpen] = static_cast<std::int64_t>(open.size());
      sink_.reserve(finished.triangles());
      finished.write(sink_, sink_.next_row());
      if (is_first) finished.write_duplicates(sink_);
      if (is_last) {
        finished.write_hull(sink_);
        sums[kHull] = static_cast<std::int64_t>(sink_.hull().size());
      }
    });
    ranks_.join(sums, Join::sum);
    Statistics& statistics = result_.statistics;
    const auto at = [&](int k) { return static_cast<std::uint64_t>(sums[static_cast<std::size_t>(k)]); };
    statistics.rounds.push_back({at(kPoints), at(kWorkers), static_cast<std::uint64_t>(ranks_.most(points)),
                                 at(kTriangles), at(kOpen)});
    statistics.duplicates += at(kDuplicates);
    statistics.undecided += at(kUndecided);
    statistics.triangles += at(kTriangles);
    statistics.hull_vertices += at(kHull);
    statistics.host_points += at(kOnHost);
    return open;
  }

  Triangulation finish() {
    const std::vector<std::int64_t> rows =
        ranks_.all(static_cast<std::int64_t>(sink_.triangles().size() / 3));
    std::vector<std::int64_t> begins(rows.size());
    std::exclusive_scan(rows.begin(), rows.end(), begins.begin(), std::int64_t{0});
    sink_.link_rows(ranks_, threads_, begins);
    result_.representatives = sink_.representatives(ranks_, points_);
    result_.first_row = begins[static_cast<std::size_t>(ranks_.rank())];
    result_.triangles = std::move(sink_.triangles());
    result_.neighbors = std::move(sink_.neighbors());
    result_.hull = std::move(sink_.hull());
    result_.areas = std::move(sink_.areas());
    result_.statistics.bytes_sent = ranks_.bytes_sent();
    end_phase("link");
    return std::move(result_);
  }

  Ranks& ranks_;
  const Solver& solver_;
  const GivenPoints& points_;
  RankSink sink_;
  host::Threads threads_;
  Frame frame_{};
  Workers workers_{1, 1};
  ChunkTree tree_;
  std::size_t round_points_ = 0;
  std::string reason_;  // why one rank has that many points, for messages
  Triangulation result_;
  double last_time_ = 0;
};

}  // namespace

Triangulation run(Ranks& ranks, const Solver& solver, const double* coordinates, std::size_t n,
                  const Options& options) {
  const double begin = host::now();
  const GivenPoints points = number_points(ranks, coordinates, n);
  Triangulation result = Run(ranks, solver, points, options).run();
  result.statistics.seconds = host::now() - begin;
  return result;
}

}  // namespace flaunay::mpi
