// flaunay-bench primitives: the vector operations beside a plain copy and Boost.Compute's.
#include <algorithm>
#include <boost/compute/algorithm/exclusive_scan.hpp>
#include <boost/compute/algorithm/sort_by_key.hpp>
#include <boost/compute/iterator/buffer_iterator.hpp>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>

#include "bench/measuring/command.hpp"
#include "bench/measuring/jobs.hpp"
#include "host/error.hpp"
#include "host/launch/vector_operations.hpp"
#include "host/opencl/device.hpp"
#include "launchers/flattened/quickhull.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::bench::primitives {
namespace {

using host::Buffer;
using host::Runtime;

// Boost.Compute's iterators.
template <typename T>
auto begin(const Buffer<T>& buffer) {
  return boost::compute::make_buffer_iterator<T>(boost::compute::buffer(buffer.memory()));
}
template <typename T>
auto end(const Buffer<T>& buffer, std::size_t n) {
  return begin(buffer) + static_cast<std::ptrdiff_t>(n);
}

void expect_right(bool is_right) {
  if (!is_right) throw std::runtime_error("wrong result");
}

/// `total` elements in segments of `length`; the last may be shorter.
void append_segments(std::vector<std::size_t>& lengths, std::size_t total, std::size_t length) {
  for (; total > 0; total -= std::min(total, length)) lengths.push_back(std::min(total, length));
}

/// All operations on n elements as jobs. Buffers stay for as long as the runtime.
class Operations {
  using Work = std::function<void()>;

 public:
  Operations(Runtime& runtime, std::size_t n, Jobs& jobs) : runtime_(runtime), n_(n), jobs_(jobs) {
    add_copies();
    add_scan<cl_uint>("uint");
    add_scan<cl_uint2>("uint2");
    add_scan<cl_uint8>("uint8");
    add_boost_scan();
    add_packs_and_sorts();
    add_segmented();
  }

 private:
  template <typename T>
  Buffer<T> allocate(std::size_t n) {
    return runtime_.arena().allocate<T>(n);
  }
  /// n values, made one after the other.
  template <typename Make>
  auto upload(Make make) {
    std::vector<decltype(make())> values(n_);
    std::generate(values.begin(), values.end(), make);
    return runtime_.upload(runtime_.arena(), values);
  }
  template <typename T>
  std::vector<T> download(const Buffer<T>& buffer) {
    std::vector<T> values(n_);
    runtime_.read(buffer, 0, n_, values.data());
    return values;
  }

  /// bytes: in all. prepare: not timed, before each run.
  void add(
      const std::string& name, std::size_t bytes, const Work& work, const Work& prepare = [] {},
      const std::string& segmentation = "unsegmented", std::size_t segments = 1) {
    Json row{{"operation", name}, {"segmentation", segmentation}, {"n", n_}};
    row.update({{"segments", segments}, {"bytes", bytes}});
    jobs_.push_back({row, [&runtime = runtime_, work, prepare] {
                       prepare();
                       runtime.finish();
                       return seconds_of([&] {
                         work();
                         runtime.finish();
                       });
                     }});
  }

  /// Checked before it is measured: another library's operation may not work on this device.
  template <typename BoostWork>
  void add_boost(
      const std::string& name, std::size_t bytes, const Work& check, const BoostWork& boost_work,
      const Work& prepare = [] {}) {
    const Work work = [&runtime = runtime_, boost_work] {
      boost::compute::command_queue commands(runtime.queue());
      boost_work(commands);
    };
    add(name, bytes, work, prepare);
    Job& job = jobs_.back();
    try {
      job.run();
      check();
    } catch (const std::exception& error) {
      job.skipped = error.what();
    }
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
    add("plain copy", 16 * n_, [&runtime = runtime_, plain_from, plain_to, bytes] {
      FLAUNAY_CL(clEnqueueCopyBuffer(runtime.queue(), plain_from.get(), plain_to.get(), 0, 0, bytes, 0,
                                     nullptr, nullptr));
    });
    const auto from = allocate<cl_ulong>(n_), to = allocate<cl_ulong>(n_);
    add("copy", 16 * n_, [&runtime = runtime_, from, to, n = n_] { runtime.copy(from, 0, to, 0, n); });
  }

  /// Zeros, scanned in place, so that they stay zeros.
  template <typename T>
  void add_scan(const std::string& type) {
    const auto values = allocate<T>(n_ + 1);
    runtime_.fill(values, n_ + 1, T{});
    add("exclusive_scan " + type, 2 * sizeof(T) * n_,
        [&runtime = runtime_, values, n = n_] { host::exclusive_scan(runtime, values, n, values); });
  }

  void add_boost_scan() {
    const auto counts = upload([&] { return static_cast<cl_uint>(random_() % 4); });
    const auto sums = allocate<cl_uint>(n_);
    const auto check = [this, counts, sums] {
      std::vector<cl_uint> expected = download(counts);
      std::exclusive_scan(expected.begin(), expected.end(), expected.begin(), cl_uint{0});
      expect_right(download(sums) == expected);
    };
    add_boost("Boost exclusive_scan uint", 8 * n_, check, [counts, sums, n = n_](auto& commands) {
      boost::compute::exclusive_scan(begin(counts), end(counts, n), begin(sums), commands);
    });
  }

  void add_packs_and_sorts() {
    const std::size_t n = n_;
    Runtime& runtime = runtime_;
    const auto flags = upload([&] { return static_cast<cl_uchar>(random_() % 2); });
    const auto counts = allocate<cl_uint>(n), count = allocate<cl_uint>(1);
    const auto positions = allocate<cl_int>(n), payloads = allocate<cl_int>(n);
    add("count_flags", 5 * n, [=, &runtime] { host::count_flags(runtime, flags, n, 1, counts); });
    add("pack_positions", 3 * n,
        [=, &runtime] { host::pack_positions(runtime, flags, n, 1, positions, count); });
    const auto unsorted_keys = upload([&]() -> cl_ulong { return random_(); });
    const auto unsorted_payloads = upload([k = cl_int{0}]() mutable { return k++; });
    const auto keys = allocate<cl_ulong>(n);
    const auto unsort = [=, &runtime] {
      runtime.copy(unsorted_keys, 0, keys, 0, n);
      runtime.copy(unsorted_payloads, 0, payloads, 0, n);
    };
    add(
        "sort_by_key", 24 * n, [=, &runtime] { host::sort_by_key(runtime, keys, payloads, n); }, unsort);
    const auto check = [this, keys] {
      const std::vector<cl_ulong> sorted = download(keys);
      expect_right(std::is_sorted(sorted.begin(), sorted.end()));
    };
    add_boost(
        "Boost sort_by_key", 24 * n, check,
        [=](auto& commands) {
          boost::compute::sort_by_key(begin(keys), end(keys, n), begin(payloads), commands);
        },
        unsort);
  }

  /// Random points, from which quickhull's balanced rounds choose a pair per segment.
  void add_segmented() {
    std::vector<std::size_t> one, tens, mixture;
    append_segments(one, n_, n_);
    append_segments(tens, n_, 10);
    append_segments(mixture, n_ / 2, n_);
    append_segments(mixture, n_ / 4, 1000);
    append_segments(mixture, n_ - n_ / 2 - n_ / 4, 10);
    std::uniform_real_distribution<double> between;
    const auto points = upload([&] { return cl_double2{{between(random_), between(random_)}}; });
    const auto flags = upload([] { return cl_uchar{1}; });
    for (const auto& [name, lengths] :
         {std::pair{"one segment", one}, {"segments of 10", tens}, {"mixture", mixture}}) {
      const std::size_t segments = lengths.size();
      std::vector<cl_int> of_elements, begins;
      for (std::size_t s = 0; s < segments; ++s) {
        begins.push_back(static_cast<cl_int>(of_elements.size()));
        of_elements.insert(of_elements.end(), lengths[s], static_cast<cl_int>(s));
      }
      const auto segment = runtime_.upload(runtime_.arena(), of_elements),
                 first = runtime_.upload(runtime_.arena(), begins), found = allocate<cl_int>(segments);
      const auto reduce = [=, &runtime = runtime_, n = n_] {
        host::segmented_arg_reduce(
            runtime, n,
            kernels::random_pairs{
                .segment = segment, .result = found, .first = first, .flags = flags, .projections = points});
      };
      const auto prepare = [&runtime = runtime_, found, segments] {
        runtime.fill(found, segments, cl_int{-1});
      };
      add("segmented_arg_reduce", 25 * n_ + 8 * segments, reduce, prepare, name, segments);
    }
  }

  Runtime& runtime_;
  std::size_t n_;
  Jobs& jobs_;
  std::mt19937_64 random_{1};
};

Result measure_primitives(const Request& request) {
  const auto device = host::find_device(request.device);
  Runtime runtime(device, settings_for(device));
  Jobs jobs;
  for (const std::size_t n : request.sizes) Operations(runtime, n, jobs);
  measure(jobs, request.runs);
  // Each size begins with its plain copy, beside which all others are set.
  double copy = 0;
  for (Job& job : jobs) {
    if (!job.skipped.empty()) continue;
    const double bytes_per_second = job.row["bytes"].get<double>() / job.median();
    if (job.row["operation"] == "plain copy") copy = bytes_per_second;
    job.details = {{"elements_per_second", job.row["n"].get<double>() / job.median()},
                   {"bytes_per_second", bytes_per_second},
                   {"of_copy", bytes_per_second / copy}};
  }
  Result result(Triangulator(request.device).device());
  add_rows(result, jobs);
  return result;
}

const Subcommand kSubcommand(
    "primitives", "the vector operations beside a plain copy and Boost.Compute's",
    R"(Bytes are the least that an operation must read and write, whatever it does in between: every input and output
once. Per element (s: per segment):
  copy                       16: 8 in, 8 out
  exclusive_scan             8, 16, 64 for uint, uint2, uint8
  count_flags                5: a flag in, a count out
  pack_positions             3: a flag in, and a position out for every second one
  sort_by_key                24: key and payload in and out
  segmented_arg_reduce       25 + 8 s: segment, flag and point in
segmented_arg_reduce finds the extreme vertex of each region, as mode flattened does for its cuts. Segmentations: one
segment; segments of 10; a mixture (half of all in one segment, a quarter in segments of 1000, a quarter in segments
of 10). 'plain copy' is clEnqueueCopyBuffer between two buffers of their own, 'copy' is Runtime::copy within the
arena.)",
    measure_primitives, [](Options& options, Request&) {
      options.sizes({10000, 1000000}, "numbers of elements").runs();
    });

}  // namespace
}  // namespace flaunay::bench::primitives
