#include "app/command/chunks.hpp"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <sstream>
#include <utility>

#include "app/command/errors.hpp"
#include "app/command/options.hpp"
#include "app/files/point_stream.hpp"
#include "files/file.hpp"
#include "files/mesh_stream.hpp"
#include "flaunay/chunks.hpp"
#include "host/memory/system_memory.hpp"

namespace flaunay::cli {

namespace {

// The largest numbers of points and triangles that int32 can count.
constexpr std::uint64_t kMostPoints32 = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kMostPointsWithRows32 = kMostPoints32 / 2;

// The names in a list that is separated by commas.
std::vector<std::string> devices_of(const std::string& list) {
  if (list.empty()) return {};
  std::vector<std::string> devices;
  std::istringstream names(list + ",");
  for (std::string name; std::getline(names, name, ',');) {
    if (name.empty()) throw Error(ErrorKind::usage, fmt::format("--device: '{}' has an empty name", list));
    devices.push_back(name);
  }
  return devices;
}

ChunkStatistics triangulate_file(const Task& task, const ChunkRequest& request, PointSource& points,
                                 MeshSink& files, Progress& progress) {
  ChunkOptions options;
  options.memory_bytes = request.memory_bytes;
  options.scratch = request.scratch;
  options.devices = devices_of(task.device);
  options.chunk_points = request.chunk_points;
  options.progress = [&progress](const std::string& stage, int round, double done) {
    progress.update(round > 0 ? fmt::format("{}, round {}", stage, round + 1) : stage, -1, done);
  };
  options.space = request.space;
  return naming_files({{"point", task.input}}, [&] { return triangulate_chunks(points, files, options); });
}

}  // namespace

void add_chunk_options(CLI::App* command, ChunkRequest& request) {
  constexpr std::uint64_t kLeast = 1;
  add_memory(command, request.memory_bytes,
             "Triangulate in chunks, within so many bytes: 4G, 500M; K, M, G and T are powers of 1024");
  command
      ->add_option("--chunk-points", request.chunk_points,
                   "Triangulate in chunks of about so many points; default: as many as suit the device")
      ->check(CLI::Range(kLeast, kMostPoints32));
  add_path(command, "--scratch", request.scratch,
           "Chunks: the folder for 24 bytes per point, in a file without a name; default: TMPDIR, or /tmp")
      ->check(CLI::ExistingDirectory);
}

void add_index(CLI::App* command, std::string& index) {
  command
      ->add_option("--index", index,
                   "Bits of the indices in .npy files; auto: 64 if there are more than 2^30 points")
      ->check(CLI::IsMember({"auto", "32", "64"}))
      ->capture_default_str();
}

bool asks_for_chunks(const CLI::App& command, const std::string& device_list) {
  return command.count("--memory") > 0 || command.count("--chunk-points") > 0 || device_list == "all" ||
         devices_of(device_list).size() > 1;
}

void check_chunk_options(const CLI::App& command, const std::string& mode) {
  if (mode != "blocks") {
    refuse(
        command, "--mode",
        fmt::format("triangulations in chunks (--memory, --chunk-points, several devices) need mode blocks, "
                    "not {}",
                    mode));
  }
  refuse(command, "--output",
         "a triangulation in chunks is not held in memory; take --triangles and --neighbors");
  refuse(command, "--profile", "a triangulation in chunks does not measure kernels");
}

bool are_too_many(std::uint64_t points, const Triangulator& triangulator) {
  if (points > kMostPoints32) return true;
  // Points, triangles, neighbours and representatives.
  constexpr double kHostBytes = 16 + 24 + 24 + 4;
  const double of_host =
      kHostBytes * static_cast<double>(points) / static_cast<double>(host::memory_left().bytes);
  const std::size_t capacity = triangulator.capacity();
  const double of_device = static_cast<double>(points) / static_cast<double>(capacity > 0 ? capacity : 1);
  // Devices that are no GPUs work in the host's memory.
  if (triangulator.device().type == "GPU") return of_host > 1 || of_device > 1;
  return of_host + of_device > 1;
}

std::string what_would_fit(const Triangulator& triangulator) {
  const DeviceInfo device = triangulator.device();
  host::MemoryLeft memory = host::memory_left();
  // The host itself, as a device, has no numbers of its own.
  if (device.available_bytes > 0 && device.available_bytes < memory.bytes) {
    memory = {device.available_bytes, "the memory of the device"};
  }
  return fmt::format("{} would fit on {} ({} of memory by {})", triangulator.capacity(), device.name,
                     host::mebibytes(memory.bytes), memory.limit);
}

io::IndexType index_type(const std::string& choice, std::uint64_t points, const ResultPaths& results) {
  if (choice == "64") return io::IndexType::int64;
  const bool has_rows = !results.arrays[array_index("neighbors")].empty();
  if (choice == "auto") return points > kMostPointsWithRows32 ? io::IndexType::int64 : io::IndexType::int32;
  if (points > (has_rows ? kMostPointsWithRows32 : kMostPoints32)) {
    throw Error(ErrorKind::usage,
                fmt::format("--index 32: {} points are too many{}; take --index 64", points,
                            has_rows ? " for neighbours, since there may be twice as many triangles" : ""));
  }
  return io::IndexType::int32;
}

int triangulate_in_chunks(const Task& task, const ChunkRequest& request, const std::string& note) {
  OutputFiles outputs({task.input});
  announce(outputs, task.results);
  const auto paths = mesh_paths(task.results);
  outputs.add(request.offsets, ".npy");
  for (const std::string& path : paths) io::check_stream_output(path);
  io::check_stream_output(request.offsets);

  RunFacts facts;
  facts.input = task.input;
  Progress progress(!task.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  const std::unique_ptr<PointSource> points =
      io::open_point_stream(task.input, request.scratch, task.columns);
  facts.reading_seconds = stopwatch.restart();

  const io::IndexType type = index_type(task.index, points->size(), task.results);
  io::check_room(paths, points->size(), type, request.scratch, request.offsets);
  io::MeshFiles files(outputs, paths, type, {}, request.offsets);
  const ChunkStatistics statistics = triangulate_file(task, request, *points, files, progress);

  write_files(
      task.results, facts, progress, outputs,
      [&] {
        files.keep_triangles(statistics.triangles);
        files.finish();
      },
      [&] { return chunk_statistics_json(statistics, facts); });
  if (!task.quiet) print(note + host_note(statistics.note) + chunk_summary(statistics, facts));
  return kSuccess;
}

}  // namespace flaunay::cli
