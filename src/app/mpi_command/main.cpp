// The program flaunay-mpi: flaunay triangulate over the ranks of MPI, each with its share of the file.
#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "app/command/chunks.hpp"
#include "app/command/errors.hpp"
#include "app/command/json.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/results.hpp"
#include "app/files/formats.hpp"
#include "app/files/point_stream.hpp"
#include "files/mesh_stream.hpp"
#include "files/temporary.hpp"
#include "flaunay/mpi.hpp"
#include "large/mpi/ranks.hpp"

namespace flaunay::mpi {
namespace {

constexpr const char* kProgram = "flaunay-mpi";

struct Request {
  std::string input;
  cli::ResultPaths results;
  std::string index = "auto";
  Options options;
  bool quiet = false;
};

// The resources that a rank used.
struct Use {
  std::uint64_t triangles, bytes_sent, peak_bytes;
  double cpu_seconds;  // of the triangulation
};

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// Ranks that may use the same cores share them. What the user chose stays.
void share_cores(const Ranks& ranks) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return;
  // Each core is divided among the ranks that may use it.
  std::vector<double> users(CPU_SETSIZE);
  for (int core = 0; core < CPU_SETSIZE; ++core) users[core] = CPU_ISSET(core, &cores) != 0 ? 1 : 0;
  ranks.sum_here(users);
  double share = 0;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &cores) != 0) share += 1 / users[core];
  }
  const std::string threads = std::to_string(std::max(1, static_cast<int>(share + 0.5)));
  for (const char* const variable : {"FLAUNAY_THREADS", "POCL_MAX_PTHREAD_COUNT"})
    setenv(variable, threads.c_str(), 0);
}

std::string statistics_json(const Request& request, const Statistics& statistics,
                            const std::vector<Use>& uses, double reading, double writing) {
  cli::Json json;
  json["flaunay"] = version();
  json["input"] = request.input;
  cli::add_counts(json, statistics);
  json["seconds"] = {{"reading", reading}, {"triangulating", statistics.seconds}, {"writing", writing}};
  json["points_per_second"] = static_cast<double>(statistics.points) / statistics.seconds;
  json["undecided_predicates"] = statistics.undecided;
  json["device"] = statistics.device;
  json["host_points"] = statistics.host_points;
  json["phases"] = cli::phases_json(statistics.phases);
  json["rounds"] = cli::list_json(statistics.rounds, [](const Round& round) -> cli::Json {
    return {{"points", round.points},
            {"ranks", round.ranks},
            {"most_points_of_a_rank", round.most},
            {"triangles", round.triangles},
            {"handed_on", round.handed_on}};
  });
  json["ranks"] = cli::list_json(uses, [](const Use& use) -> cli::Json {
    return {{"triangles", use.triangles},
            {"bytes_sent", use.bytes_sent},
            {"cpu_seconds", use.cpu_seconds},
            {"peak_bytes", use.peak_bytes}};
  });
  return cli::text_of(json);
}

std::string host_note(const Statistics& statistics) {
  if (statistics.host_points == 0) return "";
  return fmt::format(
      "note: {} points were triangulated on the hosts, whose devices have no double precision (fp64) for "
      "coordinates that span so many binary places\n",
      statistics.host_points);
}

std::string summary(const Statistics& statistics, int ranks) {
  return host_note(statistics) +
         fmt::format(
             "{} points, {} duplicates, {} triangles, {} hull vertices; on {} ranks in {} rounds in {:.3f} "
             "s, "
             "{:.0f} points "
             "per second\n",
             statistics.points, statistics.duplicates, statistics.triangles, statistics.hull_vertices, ranks,
             statistics.rounds.size(), statistics.seconds,
             static_cast<double>(statistics.points) / std::max(statistics.seconds, 1e-9));
}

// Writes this rank's share of the arrays that have a file.
void write_share(const Triangulation& mesh, io::MeshFiles& files) {
  // values: those from first_row on, of so many rows of all ranks.
  const auto write = [&](MeshArray array, const auto& values, std::int64_t first_row, std::uint64_t rows) {
    if (!files.wants(array)) return;
    const std::size_t columns = std::max<std::size_t>(1, io::columns_of(array));
    const std::uint64_t first = static_cast<std::uint64_t>(first_row) * columns;
    if constexpr (std::is_same_v<decltype(values), const std::vector<double>&>) {
      files.write_doubles(array, first, values.data(), values.size());
    } else {
      files.write(array, first, values.data(), values.size());
    }
    files.extend(array, rows * columns);
  };
  const std::uint64_t triangles = mesh.statistics.triangles;
  write(MeshArray::triangles, mesh.triangles, mesh.first_row, triangles);
  write(MeshArray::neighbors, mesh.neighbors, mesh.first_row, triangles);
  write(MeshArray::hull, mesh.hull, 0, mesh.statistics.hull_vertices);
  write(MeshArray::representatives, mesh.representatives, mesh.first_point, mesh.statistics.points);
  write(MeshArray::areas, mesh.areas, mesh.first_row, triangles);
}

// Points of a binary file, which all ranks read.
std::unique_ptr<PointSource> open_points(Ranks& ranks, const std::string& path) {
  std::unique_ptr<PointSource> points;
  ranks.together([&] {
    if (io::find_format(path, io::Use::read_records) == nullptr) {
      throw Error(ErrorKind::usage,
                  fmt::format("{}: ranks read {} at the same time, and no other files; convert it, or take "
                              "flaunay triangulate",
                              path, io::endings_for(io::Use::read_records)));
    }
    points = io::open_point_stream(path, "");
  });
  return points;
}

// This rank's share of the points, as even as possible, without products that may overflow.
std::vector<double> read_share(Ranks& ranks, PointSource& points) {
  const auto count = static_cast<std::uint64_t>(ranks.size()), size = points.size();
  const auto begin_of = [&](std::uint64_t rank) {
    return size / count * rank + std::min(rank, size % count);
  };
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  std::vector<double> share(2 * (begin_of(rank + 1) - begin_of(rank)));
  ranks.together([&] { points.read(begin_of(rank), share.size() / 2, share.data()); });
  return share;
}

using Paths = io::MeshFiles::Paths;

// Rank 0 creates the files and commits them, and the others write to them, too. If it is killed, they remove
// them.
io::MeshFiles open_files(Ranks& ranks, io::Outputs& outputs, const Paths& paths, io::IndexType type) {
  std::optional<io::MeshFiles> files;
  Paths partials;
  ranks.together([&] {
    if (ranks.rank() == 0) partials = files.emplace(outputs, paths, type).partial_paths();
  });
  for (std::string& partial : partials) {
    std::vector<char> name(partial.begin(), partial.end());
    ranks.broadcast(name);
    partial.assign(name.begin(), name.end());
  }
  ranks.together([&] {
    if (ranks.rank() != 0) files.emplace(outputs, paths, type, partials);
  });
  return *std::move(files);
}

int triangulate(Ranks& ranks, const Request& request) {
  ranks.together([&] {
    if (ranks.rank() != 0) return;
    // Not kept, because other ranks do not know the files yet, which they remove if this one is killed.
    cli::OutputFiles announced({request.input});
    cli::announce(announced, request.results);
    for (const std::string& path : request.results.arrays) io::check_stream_output(path);
  });
  cli::Progress progress(!request.quiet && ranks.rank() == 0);
  cli::Stopwatch stopwatch;
  progress.update("reading");
  const std::unique_ptr<PointSource> file = open_points(ranks, request.input);
  const Paths paths = cli::mesh_paths(request.results);
  io::IndexType type = io::IndexType::int64;
  ranks.together([&] {
    type = cli::index_type(request.index, file->size(), request.results);
    if (ranks.rank() == 0) io::check_room(paths, file->size(), type, std::nullopt);
  });
  std::vector<double> points = read_share(ranks, *file);
  const double reading = stopwatch.restart();

  progress.update("triangulating");
  const double cpu_before = cpu_seconds();
  Options options = request.options;
  options.neighbors = !request.results.arrays[array_index("neighbors")].empty();
  options.areas = !request.results.arrays[array_index("areas")].empty();
  const Triangulation mesh =
      mpi::triangulate(ranks.communicator(), points.data(), points.size() / 2, options);
  points = {};
  const std::vector<Use> uses = ranks.gather(std::vector<Use>{
      {mesh.triangles.size() / 3, mesh.statistics.bytes_sent, peak_bytes(), cpu_seconds() - cpu_before}});

  progress.update("writing");
  stopwatch.restart();
  io::Outputs outputs;
  io::MeshFiles files = open_files(ranks, outputs, paths, type);
  ranks.together([&] {
    write_share(mesh, files);
    outputs.write_out();
  });
  ranks.together([&] {
    if (ranks.rank() != 0) return;
    files.finish();
    if (!request.results.stats.empty()) {
      outputs.open(request.results.stats)
          .print("{}", statistics_json(request, mesh.statistics, uses, reading, stopwatch.seconds()));
    }
    outputs.commit();
  });
  progress.finish();
  if (!request.quiet && ranks.rank() == 0) cli::print(summary(mesh.statistics, ranks.size()));
  return cli::kSuccess;
}

void add_triangulate(CLI::App& app, Request& request) {
  CLI::App* command = app.add_subcommand("triangulate", "Triangulate the points of a file");
  command->add_option("input", request.input, "Points: " + io::endings_for(io::Use::read_records))
      ->required();
  cli::add_result_arrays(command, request.results, true);
  command->add_option(
      "--device", request.options.device,
      "The device of each rank: a part of its name, #k for the k-th that flaunay devices lists, or "
      "host; several with commas between them: the ranks of a machine take them in turn");
  command
      ->add_option("--round-points", request.options.round_points,
                   "Points of a rank in later rounds, which have as few ranks as that permits; default: a "
                   "sixteenth of the mean of the first round, but at least 65,536")
      ->check(CLI::PositiveNumber);
  cli::add_index(command, request.index);
  cli::add_quiet(command, request.quiet);
}

// Reports on rank 0 what all ranks know.
int report(const Ranks& ranks, int code, const std::string& message) {
  return ranks.rank() == 0 ? cli::report_error(kProgram, code, message) : code;
}

int run(Ranks& ranks, int argc, char** argv) {
  CLI::App app("Exact Delaunay triangulations over the ranks of MPI: mpirun -n 8 flaunay-mpi ...", kProgram);
  app.set_version_flag("--version", fmt::format("{} {}", kProgram, version()));
  app.require_subcommand(0, 1);
  Request request;
  add_triangulate(app, request);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return ranks.rank() == 0 ? app.exit(error) : 0;  // --help, --version
    return report(ranks, cli::kUsage, fmt::format("{} (see {} --help)", error.what(), kProgram));
  }
  if (app.get_subcommands().empty())
    return report(ranks, cli::kUsage, "a subcommand is required: triangulate");
  share_cores(ranks);
  try {
    return triangulate(ranks, request);
  } catch (const Error& error) {
    return report(ranks, cli::exit_code(error.kind()), error.what());
  }
}

}  // namespace
}  // namespace flaunay::mpi

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  flaunay::io::clean_up_when_interrupted();
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  int code = flaunay::cli::kFailure;
  try {
    flaunay::mpi::Ranks ranks(MPI_COMM_WORLD);
    code = flaunay::mpi::run(ranks, argc, argv);
  } catch (const std::exception& error) {
    // The error is that of this rank alone; others may wait for it.
    flaunay::cli::report_error("flaunay-mpi", code, fmt::format("internal error: {}", error.what()));
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  MPI_Finalize();
  return code;
}
