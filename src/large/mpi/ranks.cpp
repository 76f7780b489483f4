#include "large/mpi/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <string>
#include <thread>

#include "flaunay/flaunay.hpp"

namespace flaunay::mpi {
namespace {

// How often a rank asks without a pause whether others are ready, and how long its pauses become.
constexpr int kEagerTests = 100;
constexpr std::chrono::microseconds kFirstPause{20}, kLongestPause{1000};

void await(MPI_Request request) {
  std::chrono::microseconds pause = kFirstPause;
  for (int tests = 0;; ++tests) {
    int done = 0;
    check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done != 0) return;
    if (tests < kEagerTests) continue;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, kLongestPause);
  }
}

MPI_Op operation(Ranks::Join how) {
  if (how == Ranks::Join::sum) return MPI_SUM;
  return how == Ranks::Join::least ? MPI_MIN : MPI_MAX;
}

template <typename Value>
void join_values(std::vector<Value>& values, MPI_Datatype type, Ranks::Join how, MPI_Comm communicator) {
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), type, operation(how),
                       communicator, &request),
        "MPI_Iallreduce");
  await(request);
}

// Records of `bytes` bytes. Counts of records fit MPI's int where counts of bytes would not.
class RecordType {
 public:
  explicit RecordType(std::size_t bytes) {
    check(MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_), "MPI_Type_contiguous");
    check(MPI_Type_commit(&type_), "MPI_Type_commit");
  }
  RecordType(const RecordType&) = delete;
  RecordType& operator=(const RecordType&) = delete;
  ~RecordType() { MPI_Type_free(&type_); }
  operator MPI_Datatype() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

// Where each rank's records begin. Throws Error(input) if MPI cannot count them.
std::vector<int> begins_of(const std::vector<int>& counts) {
  std::vector<int> begins(counts.size());
  std::int64_t begin = 0;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    begins[r] = static_cast<int>(begin);
    begin += counts[r];
    if (begin > std::numeric_limits<int>::max()) {
      throw Error(ErrorKind::input, "more than 2^31 - 1 points or results for one message; use more ranks");
    }
  }
  return begins;
}

int checked_count(std::size_t count) {
  if (count <= static_cast<std::size_t>(std::numeric_limits<int>::max())) return static_cast<int>(count);
  throw Error(ErrorKind::input, fmt::format("{} records for one message; use more ranks", count));
}

// Communicators of the library's own for one of the caller's, which keeps them until it is freed: making them
// takes many messages.
struct Communicators {
  MPI_Comm all = MPI_COMM_NULL, here = MPI_COMM_NULL;
};

int free_communicators(MPI_Comm, int, void* made, void*) {
  const std::unique_ptr<Communicators> own(static_cast<Communicators*>(made));
  MPI_Comm_free(&own->here);
  return MPI_Comm_free(&own->all);
}

int key_of_communicators() {
  static const int key = [] {
    int made = MPI_KEYVAL_INVALID;
    check(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, free_communicators, &made, nullptr),
          "MPI_Comm_create_keyval");
    return made;
  }();
  return key;
}

Communicators* make_communicators(MPI_Comm communicator) {
  auto made = std::make_unique<Communicators>();
  int rank = 0;
  check(MPI_Comm_rank(communicator, &rank), "MPI_Comm_rank");
  check(MPI_Comm_dup(communicator, &made->all), "MPI_Comm_dup");
  check(MPI_Comm_split_type(made->all, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &made->here),
        "MPI_Comm_split_type");
  check(MPI_Comm_set_attr(communicator, key_of_communicators(), made.get()), "MPI_Comm_set_attr");
  return made.release();
}

// The description of a rank's error for the other ranks.
struct Failure {
  int kind = 0, code = 0;
  std::string message;
};

}  // namespace

void check(int code, const char* call) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw Error(ErrorKind::internal, fmt::format("{} failed: {}", call, text), code, call);
}

Ranks::Ranks(MPI_Comm communicator) {
  void* made = nullptr;
  int is_made = 0;
  check(MPI_Comm_get_attr(communicator, key_of_communicators(), &made, &is_made), "MPI_Comm_get_attr");
  if (is_made == 0) made = make_communicators(communicator);
  const auto& own = *static_cast<const Communicators*>(made);
  communicator_ = own.all;
  here_ = own.here;
  check(MPI_Comm_size(communicator_, &size_), "MPI_Comm_size");
  check(MPI_Comm_rank(communicator_, &rank_), "MPI_Comm_rank");
  check(MPI_Comm_rank(here_, &rank_here_), "MPI_Comm_rank");
}

void Ranks::together(const std::function<void()>& work) const {
  Failure own;
  bool failed = true;
  try {
    work();
    failed = false;
  } catch (const Error& error) {
    own = {static_cast<int>(error.kind()), error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    own = {static_cast<int>(ErrorKind::input), 0, "not enough memory on the host for so many points"};
  } catch (const std::exception& error) {
    own = {static_cast<int>(ErrorKind::internal), 0, error.what()};
  }
  const auto first = static_cast<int>(least(failed ? rank_ : size_));
  if (first == size_) return;
  if (first == rank_ && size_ > 1) own.message = fmt::format("rank {}: {}", rank_, own.message);
  int head[3] = {own.kind, own.code, static_cast<int>(own.message.size())};
  check(MPI_Bcast(head, 3, MPI_INT, first, communicator_), "MPI_Bcast");
  own.message.resize(static_cast<std::size_t>(head[2]));
  check(MPI_Bcast(own.message.data(), head[2], MPI_CHAR, first, communicator_), "MPI_Bcast");
  throw Error(static_cast<ErrorKind>(head[0]), own.message, head[1]);
}

void Ranks::join(std::vector<std::int64_t>& values, Join how) const {
  join_values(values, MPI_INT64_T, how, communicator_);
}

void Ranks::join(std::vector<double>& values, Join how) const {
  join_values(values, MPI_DOUBLE, how, communicator_);
}

std::int64_t Ranks::joined(std::int64_t value, Join how) const {
  std::vector<std::int64_t> values = {value};
  join(values, how);
  return values.front();
}

void Ranks::sum_here(std::vector<double>& values) const { join_values(values, MPI_DOUBLE, Join::sum, here_); }

std::vector<std::int64_t> Ranks::all(std::int64_t value) const {
  std::vector<std::int64_t> values(static_cast<std::size_t>(size_));
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallgather(&value, 1, MPI_INT64_T, values.data(), 1, MPI_INT64_T, communicator_, &request),
        "MPI_Iallgather");
  await(request);
  return values;
}

std::vector<int> Ranks::exchange_counts(const std::vector<int>& counts) const {
  std::vector<int> received(counts.size());
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ialltoall(counts.data(), 1, MPI_INT, received.data(), 1, MPI_INT, communicator_, &request),
        "MPI_Ialltoall");
  await(request);
  return received;
}

void Ranks::gather_bytes(const void* records, std::size_t count, std::size_t bytes, const Room& room) {
  std::vector<int> counts(static_cast<std::size_t>(size_)), begins;
  const std::vector<std::int64_t> all_counts = all(static_cast<std::int64_t>(count));
  void* to = nullptr;
  together([&] {
    std::transform(all_counts.begin(), all_counts.end(), counts.begin(),
                   [](std::int64_t each) { return checked_count(static_cast<std::size_t>(each)); });
    begins = begins_of(counts);
    if (rank_ == 0) to = room(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
  });
  const RecordType type(bytes);
  check(MPI_Gatherv(records, static_cast<int>(count), type, to, counts.data(), begins.data(), type, 0,
                    communicator_),
        "MPI_Gatherv");
  if (rank_ != 0) bytes_sent_ += count * bytes;
}

void Ranks::broadcast_bytes(std::size_t count, std::size_t bytes, int from, const Room& room) {
  const auto total = static_cast<std::size_t>(most(rank_ == from ? static_cast<std::int64_t>(count) : 0));
  void* records = nullptr;
  int size = 0;
  together([&] {
    size = checked_count(total);
    records = room(total);
  });
  const RecordType type(bytes);
  check(MPI_Bcast(records, size, type, from, communicator_), "MPI_Bcast");
  // Records travel along a tree of ranks: each but the last sends them on.
  if (rank_ != (from + size_ - 1) % size_) bytes_sent_ += total * bytes;
}

void Ranks::exchange_bytes(const void* records, const std::vector<int>& counts, std::size_t bytes,
                           std::vector<int>& received, const Room& room) {
  received = exchange_counts(counts);
  std::vector<int> from, to;
  void* place = nullptr;
  together([&] {
    from = begins_of(counts);
    to = begins_of(received);
    place = room(std::accumulate(received.begin(), received.end(), std::size_t{0}));
  });
  const RecordType type(bytes);
  check(MPI_Alltoallv(records, counts.data(), from.data(), type, place, received.data(), to.data(), type,
                      communicator_),
        "MPI_Alltoallv");
  for (int r = 0; r < size_; ++r) {
    if (r != rank_) bytes_sent_ += static_cast<std::uint64_t>(counts[static_cast<std::size_t>(r)]) * bytes;
  }
}

}  // namespace flaunay::mpi
