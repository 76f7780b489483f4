// The ranks of a communicator: errors that all of them throw, and messages of records.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <vector>

namespace flaunay::mpi {

/// Throws Error(internal) if a call of MPI failed.
void check(int code, const char* call);

/// All functions but size() and rank() are to be called by all ranks. While a rank waits for others it
/// sleeps, because they may share its cores.
class Ranks {
 public:
  /// Works with a duplicate of the communicator, which that one keeps for the next call.
  explicit Ranks(MPI_Comm communicator);
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int size() const { return size_; }
  int rank() const { return rank_; }
  MPI_Comm communicator() const { return communicator_; }
  /// Bytes of records that this rank has sent to others.
  std::uint64_t bytes_sent() const { return bytes_sent_; }

  /// Calls work, which must not call the ranks itself. If it throws on a rank, all ranks throw the error of
  /// the first rank on which it did.
  void together(const std::function<void()>& work) const;

  enum class Join { sum, least, most };
  void join(std::vector<std::int64_t>& values, Join how) const;
  void join(std::vector<double>& values, Join how) const;
  std::int64_t sum(std::int64_t value) const { return joined(value, Join::sum); }
  std::int64_t least(std::int64_t value) const { return joined(value, Join::least); }
  std::int64_t most(std::int64_t value) const { return joined(value, Join::most); }
  /// One value of each rank.
  std::vector<std::int64_t> all(std::int64_t value) const;

  /// The records of all ranks, in the order of ranks, on rank 0.
  template <typename Record>
  std::vector<Record> gather(const std::vector<Record>& records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    std::vector<Record> gathered;
    gather_bytes(records.data(), records.size(), sizeof(Record), [&](std::size_t count) {
      gathered.resize(count);
      return gathered.data();
    });
    return gathered;
  }
  /// The records of one rank, on all.
  template <typename Record>
  void broadcast(std::vector<Record>& records, int from = 0) {
    static_assert(std::is_trivially_copyable_v<Record>);
    broadcast_bytes(records.size(), sizeof(Record), from, [&](std::size_t count) {
      records.resize(count);
      return records.data();
    });
  }
  /// Records that other ranks sent to this one, in the order of ranks.
  template <typename Record>
  struct Received {
    std::vector<Record> records;
    std::vector<int> counts;
  };
  /// Sends counts[r] records to each rank r. records: for rank 0 first, then for rank 1, and so on.
  template <typename Record>
  Received<Record> exchange(const std::vector<Record>& records, const std::vector<int>& counts) {
    static_assert(std::is_trivially_copyable_v<Record>);
    Received<Record> received;
    received.counts.resize(counts.size());
    exchange_bytes(records.data(), counts, sizeof(Record), received.counts, [&](std::size_t count) {
      received.records.resize(count);
      return received.records.data();
    });
    return received;
  }
  /// counts[r] of each rank, for this rank.
  std::vector<int> exchange_counts(const std::vector<int>& counts) const;

  /// Sums over the ranks on this rank's machine, and how many of them come before this one.
  void sum_here(std::vector<double>& values) const;
  int rank_here() const { return rank_here_; }

 private:
  /// Makes room for this many records, and returns its address.
  using Room = std::function<void*(std::size_t count)>;

  std::int64_t joined(std::int64_t value, Join how) const;
  void gather_bytes(const void* records, std::size_t count, std::size_t bytes, const Room& room);
  void broadcast_bytes(std::size_t count, std::size_t bytes, int from, const Room& room);
  void exchange_bytes(const void* records, const std::vector<int>& counts, std::size_t bytes,
                      std::vector<int>& received, const Room& room);

  MPI_Comm communicator_ = MPI_COMM_NULL, here_ = MPI_COMM_NULL;
  int size_ = 1, rank_ = 0, rank_here_ = 0;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace flaunay::mpi
