// Moves points to the ranks that triangulate them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "host/native/threads.hpp"
#include "large/chunks/points.hpp"
#include "large/chunks/tree.hpp"
#include "large/mpi/ranks.hpp"

namespace flaunay::mpi {

/// Points that each rank gave, and their numbers: consecutive ones in the order of ranks.
struct GivenPoints {
  const double* coordinates;
  std::size_t count;
  std::vector<std::int64_t> begins;  ///< size() + 1: the number of each rank's first point

  std::int64_t first(int rank) const { return begins[static_cast<std::size_t>(rank)]; }
  std::int64_t total() const { return begins.back(); }
};

/// Which ranks triangulate in a round: `count` of `size`, as far apart as possible, since neighbouring ranks
/// may share a machine. Each has a leaf of a tree.
struct Workers {
  int count, size;

  int rank_of(std::size_t leaf) const {
    return static_cast<int>(leaf * static_cast<std::size_t>(size) / static_cast<std::size_t>(count));
  }
};

/// A tree with `leaves` leaves, one per rank, made from a sample of the points. points: this rank's, x0 y0 x1
/// y1 ...; first: the number of points, of `total`, on all ranks before. The tree is the same however points
/// are spread. Called by all ranks.
chunks::ChunkTree make_tree(Ranks& ranks, const double* points, std::size_t count, std::int64_t first,
                            std::int64_t total, int leaves, chunks::Cuts cuts);

/// Called with the number of points that a rank is going to have; throws if they are too many.
using CheckCount = std::function<void(std::size_t points)>;

/// The points of this rank's leaf, in ascending order of their numbers. Called by all ranks. Numbers are sent
/// as differences, which are 1 or 2 bytes each, since 8 would be half as much again as the coordinates.
chunks::ChunkPoints move_given(Ranks& ranks, host::Threads& threads, const GivenPoints& points,
                               const chunks::ChunkTree& tree, const CheckCount& check_count);

/// For later rounds: the points of this rank's leaf, with their open edges.
chunks::ChunkPoints move_open(Ranks& ranks, chunks::ChunkPoints points, const chunks::ChunkTree& tree,
                              const Workers& workers, const CheckCount& check_count);

/// Sorts records by the rank that they go to, sends them, and returns the records received.
template <typename Record, typename RankOf>
std::vector<Record> send_to_owners(Ranks& ranks, std::vector<Record> records, const RankOf& rank_of) {
  std::vector<int> counts;
  std::vector<Record> sorted;
  ranks.together([&] {
    counts.assign(static_cast<std::size_t>(ranks.size()), 0);
    for (const Record& record : records) ++counts[rank_of(record)];
    std::vector<std::size_t> places(counts.size(), 0);
    for (std::size_t r = 1; r < counts.size(); ++r)
      places[r] = places[r - 1] + static_cast<std::size_t>(counts[r - 1]);
    sorted.resize(records.size());
    for (const Record& record : records) sorted[places[rank_of(record)]++] = record;
    records = {};
  });
  return ranks.exchange(sorted, counts).records;
}

}  // namespace flaunay::mpi
