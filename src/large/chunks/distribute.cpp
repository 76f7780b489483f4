#include "large/chunks/distribute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <numeric>
#include <optional>
#include <utility>

#include "arithmetic/records.h"
#include "large/chunks/point_account.hpp"
#include "large/chunks/runs.hpp"
#include "points/codes.h"
#include "points/cut_tree.h"
#include "points/sampled_cuts.h"

namespace flaunay::chunks {
namespace {

using kernel::double2;
using kernel::vertex_box;

// Points that are read at once, and that a thread takes at once.
constexpr std::size_t kPiece = std::size_t{1} << 18;
constexpr std::size_t kPart = std::size_t{1} << 14;
constexpr std::uint64_t kSamplesPerChunk = 512;
constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 20;

// Samples are drawn from runs of points. A run is read at once, which takes a disk no longer than a point.
constexpr std::uint64_t kRun = 64;
constexpr std::uint64_t kSamplesPerRun = 8;
constexpr std::uint64_t kRunsPerReport = 1024;

std::vector<double2> draw_samples(PointSource& source, std::uint64_t wanted, const Progress& progress) {
  const std::uint64_t n = source.size(), runs = std::min(wanted, kMostSamples) / kSamplesPerRun;
  std::vector<double2> samples, run(kRun);
  if (n <= runs * kRun) {
    samples.resize(n);
    for (std::uint64_t first = 0; first < n; first += kPiece) {
      source.read(first, std::min<std::uint64_t>(kPiece, n - first), &samples[first].x);
    }
    return samples;
  }
  for (std::uint64_t k = 0; k < runs; ++k) {
    if (k % kRunsPerReport == 0) progress("sampling", static_cast<double>(k) / static_cast<double>(runs));
    // One of as many equal parts as there are runs.
    const std::uint64_t part = n / runs, begin = k * part + std::min(k, n % runs);
    source.read(begin + kernel::mixed(k) % (part - kRun + 1), kRun, &run.front().x);
    for (std::uint64_t i = 0; i < kRun; i += kRun / kSamplesPerRun) samples.push_back(run[i]);
  }
  return samples;
}

// A piece of the points, and where they go.
struct Piece {
  std::uint64_t first = 0;
  std::vector<double> coordinates, values;
  std::vector<std::size_t> leaves;

  std::size_t size() const { return coordinates.size() / 2; }
};

// Properties of all points so far.
class Account {
 public:
  void add(host::Threads& threads, const Piece& piece) {
    const PointAccount found = account_of(threads, piece.coordinates.data(), piece.size());
    const geometry::Magnitudes& magnitudes = found.magnitudes;
    if (magnitudes.bad != kernel::NO_BAD) {
      throw geometry::not_finite(piece.first + static_cast<std::uint64_t>(magnitudes.bad),
                                 piece.coordinates[2 * magnitudes.bad],
                                 piece.coordinates[2 * magnitudes.bad + 1]);
    }
    if (magnitudes.largest > account_.magnitudes.largest) largest_in_ = piece.first;
    if (magnitudes.lowest < account_.magnitudes.lowest) lowest_in_ = piece.first;
    account_ = joined(account_, found);
  }

  // Throws Error(input) if magnitudes differ too much.
  geometry::Scaling scaling(PointSource& source) const {
    if (geometry::differ_too_much(account_.magnitudes)) {
      throw geometry::range_error(ends_in(source, largest_in_).largest, ends_in(source, lowest_in_).finest,
                                  account_.magnitudes);
    }
    return geometry::scaling_for(account_.magnitudes);
  }
  vertex_box box() const { return account_.box; }

 private:
  geometry::RangeEnds ends_in(PointSource& source, std::uint64_t first) const {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, source.size() - first));
    std::vector<double> coordinates(2 * size);
    source.read(first, size, coordinates.data());
    geometry::RangeEnds ends = geometry::find_ends(coordinates.data(), 0, size, account_.magnitudes);
    ends.largest.point += first;
    ends.finest.point += first;
    return ends;
  }

  PointAccount account_;
  std::uint64_t largest_in_ = 0, lowest_in_ = 0;  // the pieces with these coordinates
};

void check_values(const Piece& piece) {
  const auto bad = std::find_if(piece.values.begin(), piece.values.end(),
                                [](double value) { return !std::isfinite(value); });
  if (bad == piece.values.end()) return;
  throw Error(ErrorKind::input,
              fmt::format("the value of point {} is not finite: {}",
                          piece.first + static_cast<std::uint64_t>(bad - piece.values.begin()), *bad));
}

void find_leaves(host::Threads& threads, const ChunkTree& tree, Piece& piece) {
  piece.leaves.resize(piece.size());
  threads.share(piece.size(), kPart, [&](std::size_t begin, std::size_t end) {
    tree.find_leaves(piece.coordinates.data() + 2 * begin, end - begin, piece.leaves.data() + begin);
  });
}

std::vector<Chunk> chunks_of(const ChunkTree& tree, std::vector<StoredChunk> stored, vertex_box whole) {
  std::vector<Chunk> chunks;
  for (std::size_t leaf = 0; leaf < stored.size(); ++leaf) {
    if (stored[leaf].points > 0) chunks.push_back({std::move(stored[leaf]), tree.rectangle(leaf, whole)});
  }
  return chunks;
}

// A part of a chunk of the first round.
StoredChunk part_of(const StoredChunk& chunk, const Extent& extent) {
  return {{extent}, extent.bytes / first_round_bytes(chunk.has_values), chunk.has_values};
}

// Calls visit for the points of the first round in a chunk, piece by piece, and releases them.
template <typename Visit>
void take_pieces(ScratchFile& file, const StoredChunk& chunk, const Visit& visit) {
  for (const Extent& extent : chunk.extents) {
    visit(read_chunk(file, part_of(chunk, extent), true));
    file.release(extent.begin, extent.bytes);
  }
}

// Chunks that are larger than the tree meant them to be, because the sample was unlucky or points are equal.
class Splitter {
 public:
  Splitter(const Values* values, MeshSink& sink, ScratchFile& file, const Plan& plan)
      : values_(values), sink_(sink), file_(file), plan_(plan) {}

  void split(Chunk chunk, std::vector<Chunk>& to) {
    // A sample is not exact.
    if (chunk.stored.points <= plan_.chunk_points + plan_.chunk_points / 2) {
      to.push_back(std::move(chunk));
      return;
    }
    std::vector<double2> samples = draw(chunk.stored);
    const double2 first = samples.front();
    const bool are_equal = std::all_of(samples.begin(), samples.end(),
                                       [&](double2 p) { return p.x == first.x && p.y == first.y; });
    const ChunkTree tree =
        are_equal ? ChunkTree::around(first)
                  : ChunkTree::of_leaves(std::move(samples), chunks_for(chunk.stored.points, plan_),
                                         Cuts::at_medians);
    std::vector<StoredChunk> parts = distribute(tree, chunk.stored);
    if (are_equal) parts[ChunkTree::kEqualLeaf] = keep_first(parts[ChunkTree::kEqualLeaf]);
    for (Chunk& part : chunks_of(tree, std::move(parts), chunk.rectangle)) split(std::move(part), to);
  }

  std::uint64_t equal_points() const { return equal_points_; }

 private:
  std::vector<double2> draw(const StoredChunk& chunk) const {
    const std::uint64_t wanted = kSamplesPerChunk * chunks_for(chunk.points, plan_);
    const std::size_t per_extent =
        static_cast<std::size_t>(std::min(wanted, kMostSamples)) / chunk.extents.size() + 1;
    std::vector<double2> samples;
    for (const Extent& extent : chunk.extents) {
      const ChunkPoints points = read_chunk(file_, part_of(chunk, extent), true);
      const std::size_t stride = std::max<std::size_t>(1, points.size() / per_extent);
      for (std::size_t i = 0; i < points.size(); i += stride) samples.push_back(points.point(i));
    }
    return samples;
  }

  std::vector<StoredChunk> distribute(const ChunkTree& tree, const StoredChunk& chunk) {
    ChunkWriters writers(file_, tree.leaves(), plan_.buffer_bytes, chunk.has_values);
    std::vector<std::size_t> leaves;
    take_pieces(file_, chunk, [&](const ChunkPoints& points) {
      leaves.resize(points.size());
      tree.find_leaves(points.coordinates.data(), points.size(), leaves.data());
      for (std::size_t i = 0; i < points.size(); ++i) {
        writers.add(leaves[i], points.point(i), points.ids[i], chunk.has_values ? points.values[i] : 0);
      }
    });
    return writers.take();
  }

  // Keeps the first of points that are all equal.
  StoredChunk keep_first(const StoredChunk& chunk) {
    ChunkWriters writers(file_, 1, plan_.buffer_bytes, chunk.has_values);
    std::optional<std::int64_t> first;
    double2 place{};
    std::vector<double> values;
    RunWriter representatives(sink_, MeshArray::representatives);
    take_pieces(file_, chunk, [&](const ChunkPoints& points) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (chunk.has_values) values.push_back(points.values[i]);
        if (first) {
          representatives.add(static_cast<std::uint64_t>(points.ids[i]), *first);
          ++equal_points_;
        } else {
          first = points.ids[i];
          place = points.point(i);
        }
      }
    });
    double value = 0;
    if (chunk.has_values) {
      const bool is_fixed = static_cast<std::uint64_t>(*first) < values_->fixed;
      value = is_fixed ? values.front() : common_value(values, values_->duplicates);
    }
    writers.add(0, place, *first, value);
    representatives.flush();
    return std::move(writers.take().front());
  }

  const Values* values_;
  MeshSink& sink_;
  ScratchFile& file_;
  const Plan& plan_;
  std::uint64_t equal_points_ = 0;
};

// Each point is its own representative, until a duplicate is found.
void write_own_numbers(MeshSink& sink, const Piece& piece) {
  if (!sink.wants(MeshArray::representatives)) return;
  std::vector<std::int64_t> own(piece.size());
  std::iota(own.begin(), own.end(), static_cast<std::int64_t>(piece.first));
  sink.write(MeshArray::representatives, piece.first, own.data(), own.size());
}

}  // namespace

std::size_t chunks_for(std::uint64_t points, const Plan& plan) {
  return static_cast<std::size_t>((points + plan.chunk_points - 1) / plan.chunk_points);
}

FirstRound distribute(PointSource& source, const Values* values, MeshSink& sink, ScratchFile& file,
                      const Plan& plan, host::Threads& threads, const Progress& progress) {
  const std::uint64_t n = source.size();
  const std::size_t chunks = chunks_for(n, plan);
  const bool has_values = values != nullptr;
  file.require_room(n * first_round_bytes(has_values), "the points of chunks");
  progress("sampling", 0);
  const ChunkTree tree = chunks == 1
                             ? ChunkTree()
                             : ChunkTree::of_leaves(draw_samples(source, kSamplesPerChunk * chunks, progress),
                                                    chunks, Cuts::at_medians);

  std::optional<ChunkWriters> writers(std::in_place, file, tree.leaves(), plan.buffer_bytes, has_values);
  Account account;
  const auto read = [&](std::uint64_t first) {
    Piece piece;
    piece.first = first;
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, n - first));
    piece.coordinates.resize(2 * size);
    source.read(first, size, piece.coordinates.data());
    if (has_values) {
      piece.values.resize(size);
      values->points.read_values(first, size, piece.values.data());
      check_values(piece);
    }
    return piece;
  };
  // If the system refuses a thread, a piece is read when it is asked for.
  std::future<Piece> next = std::async(read, 0);
  for (std::uint64_t first = 0; first < n; first += kPiece) {
    progress("distributing", static_cast<double>(first) / static_cast<double>(n));
    Piece piece = next.get();
    if (first + kPiece < n) next = std::async(read, first + kPiece);
    account.add(threads, piece);
    find_leaves(threads, tree, piece);
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const double2 p = {piece.coordinates[2 * i], piece.coordinates[2 * i + 1]};
      writers->add(piece.leaves[i], p, static_cast<std::int64_t>(first + i),
                   has_values ? piece.values[i] : 0);
    }
    write_own_numbers(sink, piece);
  }

  FirstRound round;
  round.scaling = account.scaling(source);
  round.all = account.box();
  Splitter splitter(values, sink, file, plan);
  std::vector<StoredChunk> stored = writers->take();
  writers.reset();
  for (Chunk& chunk : chunks_of(tree, std::move(stored), whole_plane()))
    splitter.split(std::move(chunk), round.chunks);
  round.equal_points = splitter.equal_points();
  return round;
}

void HandedOn::add(const ChunkPoints& points) {
  if (points.size() == 0) return;
  ChunkWriters writer(file_, 1, points.size() * first_round_bytes(points.has_values()), points.has_values());
  for (std::size_t i = 0; i < points.size(); ++i) {
    writer.add(0, points, i);
    if (points_++ % stride_ != 0) continue;
    sample_.push_back(points.point(i));
    if (sample_.size() < kMostSamples) continue;
    // Half of a sample that became too large.
    for (std::size_t k = 0; 2 * k < sample_.size(); ++k) sample_[k] = sample_[2 * k];
    sample_.resize(sample_.size() / 2);
    stride_ *= 2;
  }
  batches_.push_back(std::move(writer.take().front()));
}

ChunkPoints HandedOn::read_all() {
  StoredChunk all;
  for (const StoredChunk& batch : batches_) {
    all.extents.insert(all.extents.end(), batch.extents.begin(), batch.extents.end());
    all.points += batch.points;
    all.has_values = batch.has_values;
  }
  ChunkPoints points = read_chunk(file_, all, false);
  for (const Extent& extent : all.extents) file_.release(extent.begin, extent.bytes);
  return points;
}

std::vector<Chunk> HandedOn::distribute(const Plan& plan) {
  const ChunkTree tree = ChunkTree::of_leaves(std::move(sample_), chunks_for(points_, plan), Cuts::in_gaps);
  const bool has_values = !batches_.empty() && batches_.front().has_values;
  ChunkWriters writers(file_, tree.leaves(), plan.buffer_bytes, has_values);
  std::vector<std::size_t> leaves;
  for (const StoredChunk& batch : batches_) {
    const ChunkPoints points = read_chunk(file_, batch, false);
    leaves.resize(points.size());
    tree.find_leaves(points.coordinates.data(), points.size(), leaves.data());
    for (std::size_t i = 0; i < points.size(); ++i) writers.add(leaves[i], points, i);
    for (const Extent& extent : batch.extents) file_.release(extent.begin, extent.bytes);
  }
  return chunks_of(tree, writers.take(), whole_plane());
}

}  // namespace flaunay::chunks
