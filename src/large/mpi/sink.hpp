// A rank's results while rounds run. Rows are numbered by (rank, row of the rank), since how many rows each
// rank is going to have is not known yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/chunks.hpp"
#include "host/native/threads.hpp"
#include "large/mpi/move.hpp"
#include "large/mpi/ranks.hpp"

namespace flaunay::mpi {

/// Bits of a row's number that count a rank's own rows. Three entries of every row must have 63-bit numbers.
constexpr int kRowBits = 40;
constexpr int kMostRanks = 1 << 20;

class RankSink : public MeshSink {
 public:
  RankSink(int rank, bool with_neighbors) : rank_(rank), with_neighbors_(with_neighbors) {}

  /// The number that the rank's next row has until rounds are over.
  std::uint64_t next_row() const { return first_row() + triangles_.size() / 3; }
  void reserve(std::uint64_t rows);

  bool wants(MeshArray array) const override { return array != MeshArray::neighbors || with_neighbors_; }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override;
  /// Areas alone are doubles.
  void write_doubles(MeshArray, std::uint64_t, const double* values, std::size_t count) override {
    areas_.insert(areas_.end(), values, values + count);
  }

  /// The results, when all rounds are over. Called by all ranks. begins: the number of each rank's first row.
  void link_rows(Ranks& ranks, host::Threads& threads, const std::vector<std::int64_t>& begins);
  std::vector<std::int64_t> representatives(Ranks& ranks, const GivenPoints& points);
  std::vector<std::int64_t>& triangles() { return triangles_; }
  std::vector<std::int64_t>& neighbors() { return neighbors_; }
  std::vector<std::int64_t>& hull() { return hull_; }
  std::vector<double>& areas() { return areas_; }

 private:
  // An entry of an array of another rank.
  struct Entry {
    std::int64_t place, value;
  };

  std::uint64_t first_row() const { return static_cast<std::uint64_t>(rank_) << kRowBits; }

  int rank_;
  bool with_neighbors_;
  std::vector<std::int64_t> triangles_, neighbors_, hull_;
  std::vector<double> areas_;
  std::vector<Entry> links_, duplicates_;
};

}  // namespace flaunay::mpi
