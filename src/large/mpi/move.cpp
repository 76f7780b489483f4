#include "large/mpi/move.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "points/sampled_cuts.h"

namespace flaunay::mpi {
namespace {

using chunks::ChunkPoints;
using chunks::ChunkTree;
using chunks::OpenEdge;
using kernel::cut_node;
using kernel::double2;

// Samples of a rank: with 4,096, its number of points is within some 5 % of the intended one. Samples are
// sent, too, so they are at most this part of the points, unless that is too few for any balance.
constexpr std::int64_t kMostSamplesPerRank = 4096, kLeastSamplesPerRank = 512;
constexpr std::int64_t kPointsPerSample = 128;
constexpr std::int64_t kMostSamples = std::int64_t{1} << 22;

constexpr std::size_t kPart = std::size_t{1} << 14;  // points that a thread takes at once

std::vector<double2> draw_samples(const double* points, std::size_t count, std::int64_t first,
                                  std::int64_t total, std::int64_t samples) {
  std::vector<double2> drawn;
  if (count == 0) return drawn;
  // Sample k is one of the k-th of as many equal parts of the points as there are samples.
  const std::int64_t part = total / samples, rest = total % samples;
  const std::int64_t last = first + static_cast<std::int64_t>(count);
  // The part that has the first point, or one before.
  for (std::int64_t k = std::max<std::int64_t>(0, first / (part + 1) - 1); k < samples; ++k) {
    const std::int64_t begin = k * part + std::min(k, rest);
    if (begin >= last) break;
    const auto size = static_cast<std::uint64_t>(part + (k < rest ? 1 : 0));
    const std::int64_t at =
        begin + static_cast<std::int64_t>(kernel::mixed(static_cast<std::uint64_t>(k)) % size);
    if (at < first || at >= last) continue;
    drawn.push_back({points[2 * (at - first)], points[2 * (at - first) + 1]});
  }
  return drawn;
}

// Two coordinates, or 16 bytes of the numbers' differences.
struct Pair {
  std::array<unsigned char, 16> bytes;
};
static_assert(sizeof(Pair) == 2 * sizeof(double));

// A difference in groups of 7 bits, the lowest first; all but the last have the highest bit set.
std::size_t bytes_of(std::uint64_t difference) {
  std::size_t bytes = 1;
  while (difference >>= 7) ++bytes;
  return bytes;
}

unsigned char* write_difference(unsigned char* to, std::uint64_t difference) {
  for (; difference > 127; difference >>= 7) *to++ = static_cast<unsigned char>(difference | 128);
  *to++ = static_cast<unsigned char>(difference);
  return to;
}

const unsigned char* read_difference(const unsigned char* from, std::uint64_t& difference) {
  difference = *from & 127;
  for (int shift = 7; (*from++ & 128) != 0; shift += 7)
    difference |= static_cast<std::uint64_t>(*from & 127) << shift;
  return from;
}

std::vector<std::int32_t> find_ranks(host::Threads& threads, const GivenPoints& points,
                                     const ChunkTree& tree) {
  std::vector<std::int32_t> found(points.count);
  threads.share(points.count, kPart, [&](std::size_t begin, std::size_t end) {
    // A thread alone gets all at once.
    std::vector<std::size_t> leaves(std::min(kPart, end - begin));
    for (; begin < end; begin += leaves.size()) {
      const std::size_t size = std::min(leaves.size(), end - begin);
      tree.find_leaves(points.coordinates + 2 * begin, size, leaves.data());
      std::copy_n(leaves.begin(), size, found.begin() + static_cast<std::ptrdiff_t>(begin));
    }
  });
  return found;
}

// The data that a rank sends in the first round, in the order of receiving ranks.
struct Outgoing {
  std::vector<double2> points;
  std::vector<int> counts;
  std::vector<Pair> numbers;
  std::vector<int> number_counts;
};

Outgoing sort_given(const GivenPoints& points, const std::vector<std::int32_t>& to, std::size_t ranks) {
  Outgoing out;
  out.counts.assign(ranks, 0);
  out.number_counts.assign(ranks, 0);
  std::vector<std::size_t> bytes(ranks, 0), next(ranks, 0);
  for (std::size_t i = 0; i < points.count; ++i) {
    const auto r = static_cast<std::size_t>(to[i]);
    ++out.counts[r];
    bytes[r] += bytes_of(i - next[r]);
    next[r] = i + 1;
  }
  std::vector<std::size_t> places(ranks, 0), number_places(ranks, 0);
  std::size_t place = 0, number_place = 0;
  for (std::size_t r = 0; r < ranks; ++r) {
    places[r] = place;
    place += static_cast<std::size_t>(out.counts[r]);
    number_places[r] = number_place;
    const std::size_t pairs = (bytes[r] + sizeof(Pair) - 1) / sizeof(Pair);
    out.number_counts[r] = static_cast<int>(pairs);
    number_place += pairs;
  }
  out.points.resize(place);
  out.numbers.resize(number_place, Pair{});
  std::vector<unsigned char*> numbers(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    numbers[r] = reinterpret_cast<unsigned char*>(out.numbers.data() + number_places[r]);
  std::fill(next.begin(), next.end(), 0);
  for (std::size_t i = 0; i < points.count; ++i) {
    const auto r = static_cast<std::size_t>(to[i]);
    out.points[places[r]++] = {points.coordinates[2 * i], points.coordinates[2 * i + 1]};
    numbers[r] = write_difference(numbers[r], i - next[r]);
    next[r] = i + 1;
  }
  return out;
}

std::size_t total_of(const std::vector<int>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

// An open point without its edges.
struct OpenPoint {
  double2 at;
  std::int64_t id, edges;
};

}  // namespace

ChunkTree make_tree(Ranks& ranks, const double* points, std::size_t count, std::int64_t first,
                    std::int64_t total, int leaves, chunks::Cuts cuts) {
  const std::int64_t per_rank =
      std::clamp(total / leaves / kPointsPerSample, kLeastSamplesPerRank, kMostSamplesPerRank);
  const std::int64_t samples = std::min({per_rank * leaves, total, kMostSamples});
  std::vector<double2> drawn;
  ranks.together([&] { drawn = draw_samples(points, count, first, total, samples); });
  drawn = ranks.gather(drawn);
  std::vector<cut_node> nodes;
  ranks.together([&] {
    if (ranks.rank() != 0) return;
    nodes = ChunkTree::of_leaves(std::move(drawn), static_cast<std::size_t>(leaves), cuts).nodes();
  });
  ranks.broadcast(nodes);
  ChunkTree tree;
  ranks.together([&] { tree = ChunkTree(static_cast<std::size_t>(leaves), std::move(nodes)); });
  return tree;
}

ChunkPoints move_given(Ranks& ranks, host::Threads& threads, const GivenPoints& points, const ChunkTree& tree,
                       const CheckCount& check_count) {
  Outgoing out;
  ranks.together([&] {
    const std::vector<std::int32_t> to = find_ranks(threads, points, tree);
    out = sort_given(points, to, static_cast<std::size_t>(ranks.size()));
  });
  const std::size_t count = total_of(ranks.exchange_counts(out.counts));
  check_count(count);
  const Ranks::Received<Pair> numbers = ranks.exchange(out.numbers, out.number_counts);
  const Ranks::Received<double2> moved = ranks.exchange(out.points, out.counts);
  out = {};
  ChunkPoints own;
  ranks.together([&] {
    own.coordinates.reserve(2 * count);
    for (const double2 p : moved.records) own.coordinates.insert(own.coordinates.end(), {p.x, p.y});
    own.ids.reserve(count);
    const Pair* begin = numbers.records.data();
    for (int r = 0; r < ranks.size(); ++r) {
      const auto* from = reinterpret_cast<const unsigned char*>(begin);
      std::int64_t next = points.first(r);
      for (int k = 0; k < moved.counts[static_cast<std::size_t>(r)]; ++k) {
        std::uint64_t difference = 0;
        from = read_difference(from, difference);
        own.ids.push_back(next + static_cast<std::int64_t>(difference));
        next = own.ids.back() + 1;
      }
      begin += numbers.counts[static_cast<std::size_t>(r)];
    }
  });
  return own;
}

ChunkPoints move_open(Ranks& ranks, ChunkPoints points, const ChunkTree& tree, const Workers& workers,
                      const CheckCount& check_count) {
  std::vector<OpenPoint> out;
  std::vector<OpenEdge> edges;
  std::vector<int> counts, edge_counts;
  ranks.together([&] {
    std::vector<std::size_t> leaves(points.size()), order(points.size());
    tree.find_leaves(points.coordinates.data(), points.size(), leaves.data());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return leaves[a] < leaves[b]; });
    counts.assign(static_cast<std::size_t>(ranks.size()), 0);
    edge_counts = counts;
    for (const std::size_t i : order) {
      const auto r = static_cast<std::size_t>(workers.rank_of(leaves[i]));
      const auto count = static_cast<std::int64_t>(points.edge_count(i));
      ++counts[r];
      edge_counts[r] += static_cast<int>(count);
      out.push_back({points.point(i), points.ids[i], count});
      const auto begin = points.edges.begin() + static_cast<std::ptrdiff_t>(points.edge_offsets[i]);
      edges.insert(edges.end(), begin, begin + count);
    }
    points = {};
  });
  check_count(total_of(ranks.exchange_counts(counts)));
  const std::vector<OpenPoint> moved = ranks.exchange(out, counts).records;
  const std::vector<OpenEdge> moved_edges = ranks.exchange(edges, edge_counts).records;
  ChunkPoints own;
  ranks.together([&] {
    own.edge_offsets.push_back(0);
    const OpenEdge* begin = moved_edges.data();
    for (const OpenPoint& point : moved) {
      own.add(point.at, point.id, begin, static_cast<std::size_t>(point.edges));
      begin += point.edges;
    }
    own.sort();
  });
  return own;
}

}  // namespace flaunay::mpi
