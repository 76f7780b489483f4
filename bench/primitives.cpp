// flaunay-bench primitives: the vector operations beside a plain copy and Boost.Compute's.
#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/algorithm/exclusive_scan.hpp>
#include <boost/compute/algorithm/sort_by_key.hpp>
#include <boost/compute/iterator/buffer_iterator.hpp>
#include <memory>
#include <numeric>
#include <random>

#include "command.hpp"
#include "host/device.hpp"
#include "host/vector_operations.hpp"
#include "launchers/flattened/quickhull.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::bench::primitives {
namespace {

using host::Buffer;
using host::Runtime;

struct Request : Measurement {
  std::vector<std::size_t> sizes{10000, 1000000};
};

constexpr const char* kHelp =
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
    "segments "
    "of 1000, a quarter in segments of 10). 'plain copy' is clEnqueueCopyBuffer between two buffers of their "
    "own, 'copy' is Runtime::copy within the arena. All operations take turns; the first run of each is not "
    "counted. Small sizes are repeated within a run.";

template <typename T>
Buffer<T> upload(Runtime& runtime, const std::vector<T>& values) {
  const Buffer<T> buffer = runtime.arena().allocate<T>(values.size());
  runtime.write(buffer, 0, values.size(), values.data());
  return buffer;
}

template <typename T>
std::vector<T> download(Runtime& runtime, const Buffer<T>& buffer, std::size_t n) {
  std::vector<T> values(n);
  runtime.read(buffer, 0, n, values.data());
  return values;
}

/// Something to measure on given arrays.
struct Operation {
  std::string name;
  std::string segmentation;  // "unsegmented" if it knows no segments
  std::size_t n, segments;
  double bytes;
  std::function<void()> run;
  std::function<void()> prepare = {};  // not timed, before each run
  std::function<bool()> correct = {};  // after a run; only for what others wrote
};
using Operations = std::vector<Operation>;

constexpr const char* kUnsegmented = "unsegmented";
constexpr const char* kPlainCopy = "plain copy";

/// Lists an operation of n elements that knows no segments.
Operation& add(Operations& all, const std::string& name, std::size_t n, double bytes_per_element,
               std::function<void()> run) {
  all.push_back({name, kUnsegmented, n, 1, bytes_per_element * static_cast<double>(n), std::move(run)});
  return all.back();
}

std::shared_ptr<_cl_mem> plain_buffer(Runtime& runtime, std::size_t bytes) {
  cl_int code;
  const cl_mem memory = clCreateBuffer(runtime.context().get(), CL_MEM_READ_WRITE, bytes, nullptr, &code);
  FLAUNAY_CL(code);
  return {memory, clReleaseMemObject};
}

// Operations keep the buffers that they work on. All that add_... allocate stays for as long as the runtime.

void add_copies(Operations& all, Runtime& runtime, std::size_t n) {
  const std::size_t bytes = sizeof(cl_ulong) * n;
  const auto plain_from = plain_buffer(runtime, bytes), plain_to = plain_buffer(runtime, bytes);
  add(all, kPlainCopy, n, 16, [&runtime, plain_from, plain_to, bytes] {
    FLAUNAY_CL(clEnqueueCopyBuffer(runtime.queue(), plain_from.get(), plain_to.get(), 0, 0, bytes, 0, nullptr,
                                   nullptr));
  });
  const auto from = runtime.arena().allocate<cl_ulong>(n), to = runtime.arena().allocate<cl_ulong>(n);
  add(all, "copy", n, 16, [&runtime, from, to, n] { runtime.copy(from, 0, to, 0, n); });
}

/// Zeros, scanned in place, so that they stay zeros.
template <typename T>
void add_scan(Operations& all, const std::string& type, Runtime& runtime, std::size_t n) {
  const auto values = runtime.arena().allocate<T>(n + 1);
  runtime.fill(values, n + 1, T{});
  add(all, "exclusive_scan " + type, n, 2 * sizeof(T),
      [&runtime, values, n] { host::exclusive_scan(runtime, values, n, values); });
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

void add_scans(Operations& all, Runtime& runtime, std::size_t n, std::mt19937_64& random) {
  std::vector<cl_uint> numbers(n);
  for (cl_uint& number : numbers) number = static_cast<cl_uint>(random() % 4);
  const auto counts = upload(runtime, numbers);
  const auto sums = runtime.arena().allocate<cl_uint>(n + 1);
  add(all, "exclusive_scan uint", n, 8,
      [&runtime, counts, sums, n] { host::exclusive_scan(runtime, counts, n, sums); });
  add_scan<cl_uint2>(all, "uint2", runtime, n);
  add_scan<cl_uint8>(all, "uint8", runtime, n);
  add(all, "Boost exclusive_scan uint", n, 8, [&runtime, counts, sums, n] {
    boost::compute::command_queue commands(runtime.queue());
    boost::compute::exclusive_scan(begin(counts), end(counts, n), begin(sums), commands);
  }).correct = [&runtime, counts, sums, n] {
    std::vector<cl_uint> expected = download(runtime, counts, n);
    std::exclusive_scan(expected.begin(), expected.end(), expected.begin(), cl_uint{0});
    return download(runtime, sums, n) == expected;
  };
}

void add_packs(Operations& all, Runtime& runtime, std::size_t n, std::mt19937_64& random) {
  std::vector<cl_uchar> bits(n);
  for (cl_uchar& bit : bits) bit = static_cast<cl_uchar>(random() % 2);
  const auto flags = upload(runtime, bits);
  const auto counts = runtime.arena().allocate<cl_uint>(n), count = runtime.arena().allocate<cl_uint>(1);
  const auto positions = runtime.arena().allocate<cl_int>(n);
  add(all, "count_flags", n, 5,
      [&runtime, flags, counts, n] { host::count_flags(runtime, flags, n, 1, counts); });
  add(all, "pack_positions", n, 3, [&runtime, flags, positions, count, n] {
    host::pack_positions(runtime, flags, n, 1, positions, count);
  });
}

void add_sorts(Operations& all, Runtime& runtime, std::size_t n, std::mt19937_64& random) {
  std::vector<cl_ulong> numbers(n);
  for (cl_ulong& number : numbers) number = random();
  std::vector<cl_int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto unsorted_keys = upload(runtime, numbers), keys = runtime.arena().allocate<cl_ulong>(n);
  const auto unsorted_payloads = upload(runtime, order), payloads = runtime.arena().allocate<cl_int>(n);
  const auto prepare = [&runtime, unsorted_keys, unsorted_payloads, keys, payloads, n] {
    runtime.copy(unsorted_keys, 0, keys, 0, n);
    runtime.copy(unsorted_payloads, 0, payloads, 0, n);
  };
  add(all, "sort_by_key", n, 24, [&runtime, keys, payloads, n] {
    host::sort_by_key(runtime, keys, payloads, n);
  }).prepare = prepare;
  Operation& sort = add(all, "Boost sort_by_key", n, 24, [&runtime, keys, payloads, n] {
    boost::compute::command_queue commands(runtime.queue());
    boost::compute::sort_by_key(begin(keys), end(keys, n), begin(payloads), commands);
  });
  sort.prepare = prepare;
  sort.correct = [&runtime, keys, n] {
    const std::vector<cl_ulong> sorted = download(runtime, keys, n);
    return std::is_sorted(sorted.begin(), sorted.end());
  };
}

/// `total` elements in segments of `length`; the last may be shorter.
void append_segments(std::vector<std::size_t>& lengths, std::size_t total, std::size_t length) {
  for (; total > 0; total -= std::min(total, length)) lengths.push_back(std::min(total, length));
}

/// Random points, of which quickhull's balanced rounds choose a pair of each segment.
void add_segmented(Operations& all, Runtime& runtime, std::size_t n, std::mt19937_64& random) {
  std::vector<std::size_t> one, tens, mixture;
  append_segments(one, n, n);
  append_segments(tens, n, 10);
  append_segments(mixture, n / 2, n);
  append_segments(mixture, n / 4, 1000);
  append_segments(mixture, n - n / 2 - n / 4, 10);

  std::vector<cl_double2> coordinates(n);
  std::uniform_real_distribution<double> between;
  for (std::size_t i = 0; i < n; ++i) {
    coordinates[i] = {{between(random), between(random)}};
  }
  const auto points = upload(runtime, coordinates);
  const auto flags = upload(runtime, std::vector<cl_uchar>(n, 1));
  for (const auto& [name, lengths] :
       {std::pair{"one segment", one}, {"segments of 10", tens}, {"mixture", mixture}}) {
    const std::size_t segments = lengths.size();
    std::vector<cl_int> of_elements, begins;
    for (std::size_t s = 0; s < segments; ++s) {
      begins.push_back(static_cast<cl_int>(of_elements.size()));
      of_elements.insert(of_elements.end(), lengths[s], static_cast<cl_int>(s));
    }
    const auto segment = upload(runtime, of_elements);
    const auto first = upload(runtime, begins);
    const auto found = runtime.arena().allocate<cl_int>(segments);
    all.push_back({"segmented_arg_reduce", name, n, segments,
                   25 * static_cast<double>(n) + 8 * static_cast<double>(segments),
                   [=, &runtime] {
                     host::segmented_arg_reduce(runtime, n,
                                                kernels::random_pairs{.segment = segment,
                                                                      .result = found,
                                                                      .first = first,
                                                                      .flags = flags,
                                                                      .projections = points});
                   },
                   [&runtime, found, segments] { runtime.fill(found, segments, cl_int{-1}); }});
  }
}

/// The operation once, prepared; the seconds without the preparation.
double run_once(Runtime& runtime, const Operation& operation) {
  if (operation.prepare) operation.prepare();
  runtime.finish();
  const Stopwatch watch;
  operation.run();
  runtime.finish();
  return watch.seconds();
}

/// Whether an operation of another library works on this device; says so if not.
bool works(Runtime& runtime, const Operation& operation) {
  if (!operation.correct) return true;
  std::string reason = "wrong result";
  try {
    run_once(runtime, operation);
    if (operation.correct()) return true;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  fmt::print(stderr, "not measured: {}, {}, {} elements: {}\n", operation.name, operation.segmentation,
             operation.n, reason);
  return false;
}

/// Rows in the order of the operations. Each size begins with its plain copy, beside which all others are
/// set.
Json measure_operations(Runtime& runtime, const Operations& operations, int runs) {
  std::vector<Job> jobs;
  for (const Operation& operation : operations) {
    const std::string name =
        fmt::format("{}, {}, {} elements", operation.name, operation.segmentation, operation.n);
    jobs.push_back({name, [&runtime, &operation] { return run_once(runtime, operation); }, name});
  }
  run_interleaved(jobs, runs);
  Json rows = Json::array();
  double copy = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const Operation& operation = operations[j];
    const double seconds = summary(jobs[j].seconds).median, bytes_per_second = operation.bytes / seconds;
    if (operation.name == kPlainCopy) copy = bytes_per_second;
    rows.push_back({{"operation", operation.name},
                    {"segmentation", operation.segmentation},
                    {"n", operation.n},
                    {"segments", operation.segments},
                    {"bytes", operation.bytes}});
    add_seconds(rows.back(), jobs[j].seconds);
    rows.back()["elements_per_second"] = static_cast<double>(operation.n) / seconds;
    rows.back()["bytes_per_second"] = bytes_per_second;
    rows.back()["of_copy"] = bytes_per_second / copy;
  }
  return rows;
}

Result measure_all(const Request& request) {
  const auto device = host::find_device(request.device);
  Runtime runtime(device, tuning_for(device));
  Operations candidates, operations;
  for (const std::size_t n : request.sizes) {
    std::mt19937_64 random(1);
    add_copies(candidates, runtime, n);
    add_scans(candidates, runtime, n, random);
    add_packs(candidates, runtime, n, random);
    add_sorts(candidates, runtime, n, random);
    add_segmented(candidates, runtime, n, random);
  }
  for (Operation& candidate : candidates) {
    if (works(runtime, candidate)) operations.push_back(std::move(candidate));
  }
  Result result{Triangulator(request.device).device()};
  result.tables["results"] = measure_operations(runtime, operations, request.runs);
  return result;
}

Result measure_primitives(const Request& request) {
  try {
    return measure_all(request);
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what());
  }
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      add_command(app, action, "primitives", "the vector operations beside a plain copy and Boost.Compute's",
                  kHelp, request, measure_primitives);
  add_sizes_option(command, request->sizes, "numbers of elements");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::primitives
