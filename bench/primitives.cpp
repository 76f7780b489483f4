// flaunay-bench primitives: the vector operations beside a plain copy and Boost.Compute's.
#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/algorithm/exclusive_scan.hpp>
#include <boost/compute/algorithm/reduce_by_key.hpp>
#include <boost/compute/algorithm/sort_by_key.hpp>
#include <boost/compute/iterator/buffer_iterator.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "commands.hpp"
#include "flattened/device_info.hpp"
#include "host/device.hpp"
#include "host/vector_operations.hpp"
#include "options.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "timing.hpp"

namespace flaunay::bench {
namespace {

using host::Buffer;
using host::Runtime;

struct Request {
  std::vector<std::size_t> sizes{10000, 1000000};
  Measurement measurement;
};

std::string help() {
  return "Bytes are the least that an operation must read and write, whatever it does in between: every "
         "input and "
         "output once. Per element (s: per segment):\n"
         "  copy                       16: 8 in, 8 out\n"
         "  exclusive_scan             8, 16, 64 for uint, uint2, uint8\n"
         "  pack_positions             3: a flag in, and a position out for every second one\n"
         "  sort_by_key                24: key and payload in and out\n"
         "  segmented_arg_min, _max    12 + 4 s: value and segment in\n"
         "  segmented_sum              20 + 8 s: value and segment in, prefix sum out\n"
         "  segmented_split            9 + 4 s: side and segment in, place out\n"
         "  permute                    12: place and value in, value out\n"
         "  segmented_select           12 + 16 s: key and segment in\n"
         "  Boost reduce_by_key        12 + 12 s: value and segment in\n"
         "Segmentations: one segment; segments of 10; a mixture (half of all in one segment, a quarter in "
         "segments "
         "of 1000, a quarter in segments of 10). permute follows a split, or with 'random' no order. 'plain "
         "copy' "
         "is clEnqueueCopyBuffer between two buffers of their own, 'copy' is Runtime::copy within the arena. "
         "All "
         "operations take turns; the first run of each is not counted. Small sizes are repeated within a "
         "run.";
}

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

/// Random values, and room for results; all operations of a size work on them.
struct Arrays {
  Arrays(Runtime& runtime, std::size_t size);

  std::size_t n;
  Buffer<cl_ulong> keys, sorted_keys;
  Buffer<cl_int> payloads, sorted_payloads, positions, random_places, moved;
  Buffer<cl_double> values;
  Buffer<cl_long> numbers, sums;
  Buffer<cl_uchar> flags;
  Buffer<cl_uint> counts, scanned, count;
  Buffer<cl_uint2> pairs;
  Buffer<cl_uint8> octets;
  std::shared_ptr<_cl_mem> plain_from, plain_to;
};

std::shared_ptr<_cl_mem> plain_buffer(Runtime& runtime, std::size_t bytes) {
  cl_int code;
  const cl_mem memory = clCreateBuffer(runtime.context().get(), CL_MEM_READ_WRITE, bytes, nullptr, &code);
  FLAUNAY_CL(code);
  return {memory, clReleaseMemObject};
}

Arrays::Arrays(Runtime& runtime, std::size_t size) : n(size) {
  std::mt19937_64 random(1);
  std::vector<cl_ulong> host_keys(n);
  std::vector<cl_double> host_values(n);
  std::vector<cl_long> host_numbers(n);
  std::vector<cl_uchar> host_flags(n);
  std::vector<cl_uint> host_counts(n);
  for (std::size_t i = 0; i < n; ++i) {
    host_keys[i] = random();
    host_values[i] = static_cast<double>(random());
    host_numbers[i] = static_cast<cl_long>(random() % 1000);
    host_flags[i] = static_cast<cl_uchar>(random() % 2);
    host_counts[i] = static_cast<cl_uint>(random() % 4);
  }
  std::vector<cl_int> order(n);
  std::iota(order.begin(), order.end(), 0);
  keys = upload(runtime, host_keys);
  payloads = upload(runtime, order);
  values = upload(runtime, host_values);
  numbers = upload(runtime, host_numbers);
  flags = upload(runtime, host_flags);
  counts = upload(runtime, host_counts);
  std::shuffle(order.begin(), order.end(), random);
  random_places = upload(runtime, order);
  host::Arena& arena = runtime.arena();
  sorted_keys = arena.allocate<cl_ulong>(n);
  sorted_payloads = arena.allocate<cl_int>(n);
  positions = arena.allocate<cl_int>(n);
  moved = arena.allocate<cl_int>(n);
  sums = arena.allocate<cl_long>(n);
  scanned = arena.allocate<cl_uint>(n + 1);
  count = arena.allocate<cl_uint>(1);
  pairs = arena.allocate<cl_uint2>(n + 1);
  octets = arena.allocate<cl_uint8>(n + 1);
  // Scanned in place, so that zeros stay zeros.
  runtime.fill(pairs, n + 1, cl_uint2{});
  runtime.fill(octets, n + 1, cl_uint8{});
  plain_from = plain_buffer(runtime, sizeof(cl_double) * n);
  plain_to = plain_buffer(runtime, sizeof(cl_double) * n);
}

/// A way to cut n elements into segments, with room for what segments give.
struct Segmentation {
  Segmentation(Runtime& runtime, std::string segmentation_name, const std::vector<std::size_t>& lengths,
               const Arrays& arrays);

  std::string name;
  std::size_t segments;
  std::vector<cl_long> medians;  // ranks
  Buffer<cl_int> segment, offsets, found_index, split_places, segment_out;
  Buffer<cl_long> totals, ranks;
  Buffer<cl_ulong> found_key;
};

Segmentation::Segmentation(Runtime& runtime, std::string segmentation_name,
                           const std::vector<std::size_t>& lengths, const Arrays& arrays)
    : name(std::move(segmentation_name)), segments(lengths.size()) {
  std::vector<cl_int> host_segment, host_offsets{0};
  for (std::size_t s = 0; s < segments; ++s) {
    host_segment.insert(host_segment.end(), lengths[s], static_cast<cl_int>(s));
    host_offsets.push_back(static_cast<cl_int>(host_segment.size()));
    medians.push_back(static_cast<cl_long>(lengths[s] / 2));
  }
  segment = upload(runtime, host_segment);
  offsets = upload(runtime, host_offsets);
  ranks = upload(runtime, medians);
  host::Arena& arena = runtime.arena();
  found_index = arena.allocate<cl_int>(segments);
  found_key = arena.allocate<cl_ulong>(segments);
  totals = arena.allocate<cl_long>(segments);
  segment_out = arena.allocate<cl_int>(segments);
  split_places = arena.allocate<cl_int>(arrays.n);
  host::segmented_split(runtime, arrays.flags, segment, offsets, arrays.n, split_places);
}

/// `total` elements in segments of `length`; the last may be shorter.
void append_segments(std::vector<std::size_t>& lengths, std::size_t total, std::size_t length) {
  for (; total > 0; total -= std::min(total, length)) lengths.push_back(std::min(total, length));
}

std::vector<std::unique_ptr<Segmentation>> make_segmentations(Runtime& runtime, const Arrays& arrays) {
  const std::size_t n = arrays.n;
  std::vector<std::size_t> one, tens, mixture;
  append_segments(one, n, n);
  append_segments(tens, n, 10);
  append_segments(mixture, n / 2, n);
  append_segments(mixture, n / 4, 1000);
  append_segments(mixture, n - n / 2 - n / 4, 10);
  std::vector<std::unique_ptr<Segmentation>> all;
  all.push_back(std::make_unique<Segmentation>(runtime, "one segment", one, arrays));
  all.push_back(std::make_unique<Segmentation>(runtime, "segments of 10", tens, arrays));
  all.push_back(std::make_unique<Segmentation>(runtime, "mixture", mixture, arrays));
  return all;
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

constexpr const char* kUnsegmented = "unsegmented";

class Operations {
 public:
  Operations(Runtime& runtime, const Arrays& arrays) : runtime_(runtime), a_(arrays) {}

  void add_copies(std::vector<Operation>& all) const;
  void add_unsegmented(std::vector<Operation>& all) const;
  void add_segmented(std::vector<Operation>& all, const Segmentation& s) const;
  void add_boost_unsegmented(std::vector<Operation>& all) const;
  void add_boost_segmented(std::vector<Operation>& all, const Segmentation& s) const;

 private:
  Operation unsegmented(const std::string& name, double bytes_per_element, std::function<void()> run) const {
    return {name, kUnsegmented, a_.n, 1, bytes_per_element * static_cast<double>(a_.n), std::move(run)};
  }
  Operation segmented(const std::string& name, const Segmentation& s, double per_element, double per_segment,
                      std::function<void()> run) const {
    const double bytes =
        per_element * static_cast<double>(a_.n) + per_segment * static_cast<double>(s.segments);
    return {name, s.name, a_.n, s.segments, bytes, std::move(run)};
  }
  void unsort() const {
    runtime_.copy(a_.keys, 0, a_.sorted_keys, 0, a_.n);
    runtime_.copy(a_.payloads, 0, a_.sorted_payloads, 0, a_.n);
  }
  /// An iterator of Boost.Compute at the begin of a buffer.
  template <typename T>
  static boost::compute::buffer_iterator<T> begin(const Buffer<T>& buffer) {
    return boost::compute::make_buffer_iterator<T>(boost::compute::buffer(buffer.memory()));
  }
  boost::compute::command_queue queue() const { return boost::compute::command_queue(runtime_.queue()); }

  Runtime& runtime_;
  const Arrays& a_;
};

void Operations::add_copies(std::vector<Operation>& all) const {
  const Arrays& a = a_;
  Runtime& runtime = runtime_;
  all.push_back(unsegmented("plain copy", 16, [&runtime, &a] {
    FLAUNAY_CL(clEnqueueCopyBuffer(runtime.queue(), a.plain_from.get(), a.plain_to.get(), 0, 0,
                                   sizeof(cl_double) * a.n, 0, nullptr, nullptr));
  }));
  all.push_back(unsegmented("copy", 16, [&runtime, &a] { runtime.copy(a.keys, 0, a.sorted_keys, 0, a.n); }));
}

void Operations::add_unsegmented(std::vector<Operation>& all) const {
  const Arrays& a = a_;
  Runtime& runtime = runtime_;
  all.push_back(unsegmented("exclusive_scan uint", 8,
                            [&runtime, &a] { host::exclusive_scan(runtime, a.counts, a.n, a.scanned); }));
  all.push_back(unsegmented("exclusive_scan uint2", 16,
                            [&runtime, &a] { host::exclusive_scan(runtime, a.pairs, a.n, a.pairs); }));
  all.push_back(unsegmented("exclusive_scan uint8", 64,
                            [&runtime, &a] { host::exclusive_scan(runtime, a.octets, a.n, a.octets); }));
  all.push_back(unsegmented("pack_positions", 3, [&runtime, &a] {
    host::pack_positions(runtime, a.flags, a.n, 1, a.positions, a.count);
  }));
  all.push_back(unsegmented("sort_by_key", 24, [&runtime, &a] {
    host::sort_by_key(runtime, a.sorted_keys, a.sorted_payloads, a.n);
  }));
  all.back().prepare = [this] { unsort(); };
  all.push_back(unsegmented("permute random", 12, [&runtime, &a] {
    host::permute(runtime, a.random_places, a.payloads, a.n, a.moved);
  }));
}

void Operations::add_segmented(std::vector<Operation>& all, const Segmentation& s) const {
  const Arrays& a = a_;
  Runtime& runtime = runtime_;
  all.push_back(segmented("segmented_arg_min", s, 12, 4, [&runtime, &a, &s] {
    host::segmented_arg_min(runtime, a.values, s.segment, a.n, s.segments, s.found_index);
  }));
  all.push_back(segmented("segmented_arg_max", s, 12, 4, [&runtime, &a, &s] {
    host::segmented_arg_max(runtime, a.values, s.segment, a.n, s.segments, s.found_index);
  }));
  all.push_back(segmented("segmented_sum", s, 20, 8, [&runtime, &a, &s] {
    host::segmented_sum(runtime, a.numbers, s.segment, a.n, s.segments, a.sums, s.totals);
  }));
  all.push_back(segmented("segmented_split", s, 9, 4, [&runtime, &a, &s] {
    host::segmented_split(runtime, a.flags, s.segment, s.offsets, a.n, s.split_places);
  }));
  all.push_back(segmented("permute", s, 12, 0, [&runtime, &a, &s] {
    host::permute(runtime, s.split_places, a.payloads, a.n, a.moved);
  }));
  all.push_back(segmented("segmented_select", s, 12, 16, [&runtime, &a, &s] {
    host::segmented_select(runtime, a.keys, s.segment, a.n, s.segments, s.ranks, s.found_key);
  }));
  all.back().prepare = [&runtime, &s] { runtime.write(s.ranks, 0, s.segments, s.medians.data()); };
}

void Operations::add_boost_unsegmented(std::vector<Operation>& all) const {
  const Arrays& a = a_;
  const auto n = static_cast<std::ptrdiff_t>(a.n);
  all.push_back(unsegmented("Boost exclusive_scan uint", 8, [this, &a, n] {
    auto commands = queue();
    boost::compute::exclusive_scan(begin(a.counts), begin(a.counts) + n, begin(a.scanned), commands);
  }));
  all.back().correct = [this, &a] {
    std::vector<cl_uint> expected = download(runtime_, a.counts, a.n);
    std::exclusive_scan(expected.begin(), expected.end(), expected.begin(), cl_uint{0});
    return download(runtime_, a.scanned, a.n) == expected;
  };
  all.push_back(unsegmented("Boost sort_by_key", 24, [this, &a, n] {
    auto commands = queue();
    boost::compute::sort_by_key(begin(a.sorted_keys), begin(a.sorted_keys) + n, begin(a.sorted_payloads),
                                commands);
  }));
  all.back().prepare = [this] { unsort(); };
  all.back().correct = [this, &a] {
    const std::vector<cl_ulong> sorted = download(runtime_, a.sorted_keys, a.n);
    return std::is_sorted(sorted.begin(), sorted.end());
  };
}

void Operations::add_boost_segmented(std::vector<Operation>& all, const Segmentation& s) const {
  const Arrays& a = a_;
  const auto n = static_cast<std::ptrdiff_t>(a.n);
  all.push_back(segmented("Boost reduce_by_key", s, 12, 12, [this, &a, &s, n] {
    auto commands = queue();
    boost::compute::reduce_by_key(begin(s.segment), begin(s.segment) + n, begin(a.numbers),
                                  begin(s.segment_out), begin(s.totals), commands);
  }));
  all.back().correct = [this, &a, &s] {
    const std::vector<cl_long> totals = download(runtime_, s.totals, s.segments);
    host::segmented_sum(runtime_, a.numbers, s.segment, a.n, s.segments, a.sums, s.totals);
    return totals == download(runtime_, s.totals, s.segments);
  };
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

/// Small sizes are over too soon for the clock and the scheduler.
std::size_t repetitions(std::size_t n) {
  constexpr std::size_t kElements = 200000, kMost = 100;
  return std::max<std::size_t>(1, std::min(kMost, kElements / std::max<std::size_t>(n, 1)));
}

Job job_of(Runtime& runtime, const Operation& operation) {
  const std::string name =
      fmt::format("{}, {}, {} elements", operation.name, operation.segmentation, operation.n);
  return {name,
          [&runtime, &operation] {
            const std::size_t times = repetitions(operation.n);
            double seconds = 0;
            for (std::size_t k = 0; k < times; ++k) seconds += run_once(runtime, operation);
            return seconds / static_cast<double>(times);
          },
          name};
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

struct Measured {
  const Operation* operation;
  Summary seconds;

  double elements_per_second() const { return static_cast<double>(operation->n) / seconds.median; }
  double bytes_per_second() const { return operation->bytes / seconds.median; }
};

std::vector<Measured> measure(Runtime& runtime, const std::vector<Operation>& operations, int runs) {
  std::vector<Job> jobs;
  for (const Operation& operation : operations) jobs.push_back(job_of(runtime, operation));
  run_interleaved(jobs, runs);
  std::vector<Measured> measured;
  for (std::size_t j = 0; j < jobs.size(); ++j)
    measured.push_back({&operations[j], summary(jobs[j].seconds)});
  return measured;
}

void print_table(const std::vector<Measured>& all) {
  fmt::print("{:<26} {:<15} {:>9} {:>9} {:>11} {:>11} {:>11} {:>9} {:>8} {:>8}\n", "operation",
             "segmentation", "n", "segments", "median s", "min s", "max s", "Melem/s", "GB/s", "of copy");
  double copy = 0;
  for (const Measured& m : all) {
    // The plain copy of each size comes before all else of that size.
    if (m.operation->name == "plain copy") copy = m.bytes_per_second();
    fmt::print("{:<26} {:<15} {:>9} {:>9} {:>11.7f} {:>11.7f} {:>11.7f} {:>9.1f} {:>8.3f} {:>7.1f}%\n",
               m.operation->name, m.operation->segmentation, m.operation->n, m.operation->segments,
               m.seconds.median, m.seconds.low, m.seconds.high, 1e-6 * m.elements_per_second(),
               1e-9 * m.bytes_per_second(), 100 * m.bytes_per_second() / copy);
  }
}

nlohmann::json results(const std::vector<Measured>& all) {
  nlohmann::json results = nlohmann::json::array();
  for (const Measured& m : all) {
    results.push_back({{"operation", m.operation->name},
                       {"segmentation", m.operation->segmentation},
                       {"n", m.operation->n},
                       {"segments", m.operation->segments},
                       {"bytes", m.operation->bytes},
                       {"elements_per_second", m.elements_per_second()},
                       {"bytes_per_second", m.bytes_per_second()}});
    add_seconds(results.back(), m.seconds);
  }
  return results;
}

plot::Bars panel_of(const std::vector<Measured>& all, std::size_t n) {
  plot::Bars panel;
  panel.title = fmt::format("{} elements", n);
  panel.y = {"bytes per second", plot::Scale::log10, plot::Unit::bytes};
  for (const Measured& m : all) {
    const Operation& operation = *m.operation;
    if (operation.n != n) continue;
    auto group = std::find_if(panel.groups.begin(), panel.groups.end(), [&](const plot::BarGroup& candidate) {
      return candidate.name == operation.name;
    });
    if (group == panel.groups.end()) group = panel.groups.insert(group, {operation.name, {}});
    group->bars.push_back({operation.segmentation,
                           {m.bytes_per_second()},
                           operation.bytes / m.seconds.high,
                           operation.bytes / m.seconds.low});
  }
  return panel;
}

plot::Figure figure_of(const std::vector<Measured>& all, const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = "Vector operations: bytes that must be read and written, by time";
  figure.subtitle = measured_on(device, request.measurement.runs);
  figure.columns = 1;
  figure.panel_width = 1000;
  for (const std::size_t n : request.sizes) figure.panels.push_back(panel_of(all, n));
  return figure;
}

int measure_all(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  Runtime runtime(host::find_device(measurement.device));
  std::vector<std::unique_ptr<Arrays>> arrays;
  std::vector<std::unique_ptr<Operations>> makers;
  std::vector<std::unique_ptr<Segmentation>> segmentations;
  std::vector<Operation> candidates;
  for (const std::size_t n : request.sizes) {
    arrays.push_back(std::make_unique<Arrays>(runtime, n));
    makers.push_back(std::make_unique<Operations>(runtime, *arrays.back()));
    const Operations& make = *makers.back();
    make.add_copies(candidates);
    make.add_unsegmented(candidates);
    make.add_boost_unsegmented(candidates);
    for (auto& segmentation : make_segmentations(runtime, *arrays.back())) {
      make.add_segmented(candidates, *segmentation);
      make.add_boost_segmented(candidates, *segmentation);
      segmentations.push_back(std::move(segmentation));
    }
  }
  std::vector<Operation> operations;
  for (Operation& candidate : candidates) {
    if (works(runtime, candidate)) operations.push_back(std::move(candidate));
  }
  const std::vector<Measured> measured = measure(runtime, operations, measurement.runs);

  print_table(measured);
  const DeviceInfo device = flattened::describe(runtime.device());
  nlohmann::json file = record(device, command, measurement.runs);
  file["results"] = results(measured);
  write_files(measurement, file, [&] { return figure_of(measured, request, device); });
  return kSuccess;
}

int run(const Request& request, const std::string& command) {
  try {
    return measure_all(request, command);
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what());
  }
}

}  // namespace

void add_primitives(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      app.add_subcommand("primitives", "the vector operations beside a plain copy and Boost.Compute's");
  command->footer(help());
  add_sizes_option(command, request->sizes, "numbers of elements");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
