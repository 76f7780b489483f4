// flaunay-bench primitives: the vector operations beside a plain copy and Boost.Compute's.
#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/algorithm/exclusive_scan.hpp>
#include <boost/compute/algorithm/sort_by_key.hpp>
#include <boost/compute/iterator/buffer_iterator.hpp>
#include <memory>
#include <numeric>
#include <random>

#include "bench/measuring/timing.hpp"
#include "host/error.hpp"
#include "host/launch/vector_operations.hpp"
#include "host/opencl/device.hpp"
#include "launchers/flattened/quickhull.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::bench::primitives {
namespace {

using host::Buffer;
using host::Runtime;

/// Makes an array of n values, one after the other.
template <typename Make>
auto array_of(std::size_t n, Make make) {
  std::vector<decltype(make())> values(n);
  std::generate(values.begin(), values.end(), make);
  return values;
}

template <typename T>
std::vector<T> download(Runtime& runtime, const Buffer<T>& buffer, std::size_t n) {
  std::vector<T> values(n);
  runtime.read(buffer, 0, n, values.data());
  return values;
}

// Boost.Compute's iterators.
template <typename T>
auto begin(const Buffer<T>& buffer) {
  return boost::compute::make_buffer_iterator<T>(boost::compute::buffer(buffer.memory()));
}
template <typename T>
auto end(const Buffer<T>& buffer, std::size_t n) {
  return begin(buffer) + static_cast<std::ptrdiff_t>(n);
}

/// `total` elements in segments of `length`; the last may be shorter.
void append_segments(std::vector<std::size_t>& lengths, std::size_t total, std::size_t length) {
  for (; total > 0; total -= std::min(total, length)) lengths.push_back(std::min(total, length));
}

/// Something to measure. All buffers stay for as long as the runtime.
struct Operation {
  std::function<void()> run;
  std::function<void()> prepare = {};  ///< not timed, before each run
  std::function<bool()> correct = {};  ///< after a run; only for what others wrote
};

/// All operations as jobs.
class Operations {
 public:
  Operations(Runtime& runtime, const Request& request) : runtime_(runtime) {
    for (const std::size_t n : request.sizes) {
      n_ = n;
      random_.seed(1);
      add_copies();
      add_scans();
      add_packs();
      add_sorts();
      add_segmented();
    }
  }
  std::vector<Job> jobs;

 private:
  template <typename T>
  Buffer<T> allocate(std::size_t n) {
    return runtime_.arena().allocate<T>(n);
  }
  template <typename T>
  Buffer<T> upload(const std::vector<T>& values) {
    return runtime_.upload(runtime_.arena(), values);
  }

  double run_once(const Operation& operation) {
    if (operation.prepare) operation.prepare();
    runtime_.finish();
    return seconds_of([&] {
      operation.run();
      runtime_.finish();
    });
  }

  /// Another library's operation may not work on this device.
  std::string failure_of(const Operation& operation) {
    try {
      if (!operation.correct) return "";
      run_once(operation);
      return operation.correct() ? "" : "wrong result";
    } catch (const std::exception& error) {
      return error.what();
    }
  }

  void add(const std::string& name, double bytes, const Operation& operation,
           const std::string& segmentation = "unsegmented", std::size_t segments = 1) {
    const std::string failure = failure_of(operation);
    if (!failure.empty()) {
      fmt::print(stderr, "not measured: {}, {}, {} elements: {}\n", name, segmentation, n_, failure);
      return;
    }
    jobs.push_back({{{"operation", name},
                     {"segmentation", segmentation},
                     {"n", n_},
                     {"segments", segments},
                     {"bytes", bytes}},
                    [this, operation] { return run_once(operation); }});
  }
  /// Without segments; bytes of each element.
  void add_plain(const std::string& name, double bytes, const Operation& operation) {
    add(name, bytes * static_cast<double>(n_), operation);
  }

  std::shared_ptr<_cl_mem> plain_buffer(std::size_t bytes) {
    cl_int code;
    const cl_mem memory = clCreateBuffer(runtime_.context().get(), CL_MEM_READ_WRITE, bytes, nullptr, &code);
    FLAUNAY_CL(code);
    return {memory, clReleaseMemObject};
  }

  void add_copies() {
    const std::size_t bytes = sizeof(cl_ulong) * n_;
    const auto plain_from = plain_buffer(bytes), plain_to = plain_buffer(bytes);
    add_plain("plain copy", 16, {[this, plain_from, plain_to, bytes] {
                FLAUNAY_CL(clEnqueueCopyBuffer(runtime_.queue(), plain_from.get(), plain_to.get(), 0, 0,
                                               bytes, 0, nullptr, nullptr));
              }});
    const auto from = allocate<cl_ulong>(n_), to = allocate<cl_ulong>(n_);
    add_plain("copy", 16, {[this, from, to, n = n_] { runtime_.copy(from, 0, to, 0, n); }});
  }

  /// Zeros, scanned in place, so that they stay zeros.
  template <typename T>
  void add_scan(const std::string& type) {
    const auto values = allocate<T>(n_ + 1);
    runtime_.fill(values, n_ + 1, T{});
    add_plain("exclusive_scan " + type, 2 * sizeof(T),
              {[this, values, n = n_] { host::exclusive_scan(runtime_, values, n, values); }});
  }

  void add_scans() {
    const auto counts = upload(array_of(n_, [&] { return static_cast<cl_uint>(random_() % 4); }));
    const auto sums = allocate<cl_uint>(n_ + 1);
    add_plain("exclusive_scan uint", 8,
              {[this, counts, sums, n = n_] { host::exclusive_scan(runtime_, counts, n, sums); }});
    add_scan<cl_uint2>("uint2");
    add_scan<cl_uint8>("uint8");
    const auto scan = [this, counts, sums, n = n_] {
      boost::compute::command_queue commands(runtime_.queue());
      boost::compute::exclusive_scan(begin(counts), end(counts, n), begin(sums), commands);
    };
    const auto correct = [this, counts, sums, n = n_] {
      std::vector<cl_uint> expected = download(runtime_, counts, n);
      std::exclusive_scan(expected.begin(), expected.end(), expected.begin(), cl_uint{0});
      return download(runtime_, sums, n) == expected;
    };
    add_plain("Boost exclusive_scan uint", 8, {scan, {}, correct});
  }

  void add_packs() {
    const auto flags = upload(array_of(n_, [&] { return static_cast<cl_uchar>(random_() % 2); }));
    const auto counts = allocate<cl_uint>(n_), count = allocate<cl_uint>(1);
    const auto positions = allocate<cl_int>(n_);
    add_plain("count_flags", 5,
              {[this, flags, counts, n = n_] { host::count_flags(runtime_, flags, n, 1, counts); }});
    add_plain("pack_positions", 3, {[this, flags, positions, count, n = n_] {
                host::pack_positions(runtime_, flags, n, 1, positions, count);
              }});
  }

  void add_sorts() {
    const auto unsorted_keys = upload(array_of(n_, [&]() -> cl_ulong { return random_(); }));
    const auto unsorted_payloads = upload(array_of(n_, [k = cl_int{0}]() mutable { return k++; }));
    const auto keys = allocate<cl_ulong>(n_);
    const auto payloads = allocate<cl_int>(n_);
    const auto prepare = [this, unsorted_keys, unsorted_payloads, keys, payloads, n = n_] {
      runtime_.copy(unsorted_keys, 0, keys, 0, n);
      runtime_.copy(unsorted_payloads, 0, payloads, 0, n);
    };
    const auto sort = [this, keys, payloads, n = n_] { host::sort_by_key(runtime_, keys, payloads, n); };
    const auto sort_by_boost = [this, keys, payloads, n = n_] {
      boost::compute::command_queue commands(runtime_.queue());
      boost::compute::sort_by_key(begin(keys), end(keys, n), begin(payloads), commands);
    };
    const auto correct = [this, keys, n = n_] {
      const std::vector<cl_ulong> sorted = download(runtime_, keys, n);
      return std::is_sorted(sorted.begin(), sorted.end());
    };
    add_plain("sort_by_key", 24, {sort, prepare});
    add_plain("Boost sort_by_key", 24, {sort_by_boost, prepare, correct});
  }

  /// Random points, of which quickhull's balanced rounds choose a pair of each segment.
  void add_segmented() {
    std::vector<std::size_t> one, tens, mixture;
    append_segments(one, n_, n_);
    append_segments(tens, n_, 10);
    append_segments(mixture, n_ / 2, n_);
    append_segments(mixture, n_ / 4, 1000);
    append_segments(mixture, n_ - n_ / 2 - n_ / 4, 10);
    std::uniform_real_distribution<double> between;
    const auto points = upload(array_of(n_, [&] {
      return cl_double2{{between(random_), between(random_)}};
    }));
    const auto flags = upload(std::vector<cl_uchar>(n_, 1));
    for (const auto& [name, lengths] :
         {std::pair{"one segment", one}, {"segments of 10", tens}, {"mixture", mixture}}) {
      const std::size_t segments = lengths.size();
      std::vector<cl_int> of_elements, begins;
      for (std::size_t s = 0; s < segments; ++s) {
        begins.push_back(static_cast<cl_int>(of_elements.size()));
        of_elements.insert(of_elements.end(), lengths[s], static_cast<cl_int>(s));
      }
      const auto segment = upload(of_elements), first = upload(begins), found = allocate<cl_int>(segments);
      const auto reduce = [=, this, n = n_] {
        host::segmented_arg_reduce(
            runtime_, n,
            kernels::random_pairs{
                .segment = segment, .result = found, .first = first, .flags = flags, .projections = points});
      };
      const auto prepare = [this, found, segments] { runtime_.fill(found, segments, cl_int{-1}); };
      add("segmented_arg_reduce", 25 * static_cast<double>(n_) + 8 * static_cast<double>(segments),
          {reduce, prepare}, name, segments);
    }
  }

  Runtime& runtime_;
  std::size_t n_ = 0;
  std::mt19937_64 random_;
};

Result measure_primitives(const Request& request) {
  const auto device = host::find_device(request.device);
  Runtime runtime(device, settings_for(device));
  Operations operations(runtime, request);
  measure_rows(operations.jobs, request.runs);
  Result result(Triangulator(request.device).device());
  // Each size begins with its plain copy, beside which all others are set.
  double copy = 0;
  for (Job& job : operations.jobs) {
    Json& row = job.row;
    const double bytes_per_second = row["bytes"].get<double>() / job.median();
    if (row["operation"] == "plain copy") copy = bytes_per_second;
    row["elements_per_second"] = row["n"].get<double>() / job.median();
    row["bytes_per_second"] = bytes_per_second;
    row["of_copy"] = bytes_per_second / copy;
    result.tables["results"].push_back(row);
  }
  return result;
}

const Subcommand kSubcommand(
    "primitives", "the vector operations beside a plain copy and Boost.Compute's",
    "Bytes are the least that an operation must read and write, whatever it does in between: every input and "
    "output once. Per element (s: per segment):\n"
    "  copy                       16: 8 in, 8 out\n"
    "  exclusive_scan             8, 16, 64 for uint, uint2, uint8\n"
    "  count_flags                5: a flag in, a count out\n"
    "  pack_positions             3: a flag in, and a position out for every second one\n"
    "  sort_by_key                24: key and payload in and out\n"
    "  segmented_arg_reduce       32 + 16 s: segment, corner and point in\n"
    "segmented_arg_reduce finds the extreme vertex of each region, as mode flattened does for its cuts. "
    "Segmentations: one segment; segments of 10; a mixture (half of all in one segment, a quarter in "
    "segments of "
    "1000, a quarter in segments of 10). 'plain copy' is clEnqueueCopyBuffer between two buffers of their "
    "own, "
    "'copy' is Runtime::copy within the arena. All operations take turns; the first run of each is not "
    "counted. "
    "Small sizes are repeated within a run.",
    measure_primitives, [](Options& options, Request&) {
      options.sizes({10000, 1000000}, "numbers of elements").runs();
    });

}  // namespace
}  // namespace flaunay::bench::primitives
