#include "large/mpi/sink.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace flaunay::mpi {
namespace {

constexpr std::size_t kPart = std::size_t{1} << 16;
constexpr std::int64_t kRowMask = (std::int64_t{1} << kRowBits) - 1;

int rank_of_row(std::int64_t row) { return static_cast<int>(row >> kRowBits); }

}  // namespace

void RankSink::reserve(std::uint64_t rows) {
  triangles_.reserve(triangles_.size() + 3 * rows);
  if (with_neighbors_) neighbors_.reserve(neighbors_.size() + 3 * rows);
}

void RankSink::write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) {
  switch (array) {
    case MeshArray::triangles:
      triangles_.insert(triangles_.end(), values, values + count);
      break;
    case MeshArray::neighbors:
      if (rank_of_row(static_cast<std::int64_t>(first / 3)) != rank_) {
        // Only neighbours that are found later than their row are of other ranks.
        for (std::size_t k = 0; k < count; ++k) {
          links_.push_back({static_cast<std::int64_t>(first + k), values[k]});
        }
      } else {
        const std::size_t place = first - 3 * first_row();
        if (place == neighbors_.size()) {
          neighbors_.insert(neighbors_.end(), values, values + count);
        } else {
          std::copy_n(values, count, neighbors_.begin() + static_cast<std::ptrdiff_t>(place));
        }
      }
      break;
    case MeshArray::hull:
      hull_.assign(values, values + count);
      break;
    case MeshArray::representatives:
      for (std::size_t k = 0; k < count; ++k)
        duplicates_.push_back({static_cast<std::int64_t>(first + k), values[k]});
      break;
    case MeshArray::areas:
      break;  // see write_doubles
  }
}

void RankSink::link_rows(Ranks& ranks, host::Threads& threads, const std::vector<std::int64_t>& begins) {
  if (!with_neighbors_) return;
  const std::vector<Entry> links = send_to_owners(ranks, std::move(links_), [](const Entry& entry) {
    return static_cast<std::size_t>(rank_of_row(entry.place / 3));
  });
  ranks.together([&] {
    for (const Entry& link : links)
      neighbors_[static_cast<std::size_t>(link.place) - 3 * first_row()] = link.value;
    threads.share(neighbors_.size(), kPart, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::int64_t& row = neighbors_[i];
        if (row >= 0) row = begins[static_cast<std::size_t>(rank_of_row(row))] + (row & kRowMask);
      }
    });
  });
}

std::vector<std::int64_t> RankSink::representatives(Ranks& ranks, const GivenPoints& points) {
  const std::vector<Entry> found = send_to_owners(ranks, std::move(duplicates_), [&](const Entry& entry) {
    const auto after = std::upper_bound(points.begins.begin(), points.begins.end(), entry.place);
    return static_cast<std::size_t>(after - points.begins.begin() - 1);
  });
  std::vector<std::int64_t> all;
  ranks.together([&] {
    const std::int64_t first = points.first(ranks.rank());
    all.resize(points.count);
    std::iota(all.begin(), all.end(), first);
    for (const Entry& entry : found) all[static_cast<std::size_t>(entry.place - first)] = entry.value;
  });
  return all;
}

}  // namespace flaunay::mpi
