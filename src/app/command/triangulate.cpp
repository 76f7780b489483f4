#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/command/chunks.hpp"
#include "app/command/commands.hpp"
#include "app/command/compiling.hpp"
#include "app/command/constraints.hpp"
#include "app/command/heights.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/command/results.hpp"
#include "app/command/spaces.hpp"
#include "app/files/formats.hpp"
#include "app/files/layers.hpp"
#include "app/files/point_stream.hpp"
#include "app/files/points.hpp"
#include "flaunay/research.hpp"

namespace flaunay::cli {

namespace {

struct TriangulateRequest : Task {
  Mode mode = Mode::blocks;
  Cut cut = Cut::interquartile;
  Hull dividing_paths = Hull::prune;
  Finish finish = Finish::blocks;
  int partition_levels = 0;
  int threads = 0;
  bool count = false;
  bool in_chunks = false;  ///< the options ask for it
  ChunkRequest chunks;
  bool has_constraints = false;
  ConstraintRequest constraints;
  bool is_in_space = false;
  SpaceRequest space;
};

const research::ModeInfo& info_of(Mode mode) {
  const std::vector<research::ModeInfo>& modes = research::list_modes();
  return *std::find_if(modes.begin(), modes.end(), [mode](const auto& info) { return info.mode == mode; });
}

// Refuses options that the chosen mode would ignore or cannot honour.
void check_combination(const CLI::App& command, const TriangulateRequest& request) {
  const research::ModeInfo& mode = info_of(request.mode);
  if (mode.on_host) {
    refuse_all(command, {"--device", "--profile"},
               fmt::format("mode {} runs on the host, without a device", mode.name));
  } else if (request.dividing_paths == Hull::monotone_chain) {
    refuse(command, "--hull-variant",
           fmt::format("monotone-chain needs --mode recursive, not {}", mode.name));
  }
  if (!mode.cuts_regions) {
    refuse_all(command, {"--cut", "--hull-variant"},
               fmt::format("mode {} has no such choice; take --mode flattened", mode.name));
  }
  if (!mode.counts) {
    refuse(command, "--count", fmt::format("mode {} does not count; take --mode flattened", mode.name));
  }
  if (request.mode != Mode::flattened) {
    refuse(command, "--finish", fmt::format("needs --mode flattened, not {}", mode.name));
  } else if (request.count && request.finish == Finish::blocks) {
    refuse(command, "--finish", "--count needs --finish levels");
  }
  if (request.mode != Mode::partition) {
    refuse_all(command, {"--partition-levels", "--threads"},
               fmt::format("needs --mode partition, not {}", mode.name));
  }
}

// Opens the device before the points are read if there are so many that they may not fit. Returns whether
// they do not.
bool do_not_fit(const TriangulateRequest& request, std::uint64_t points, Progress& progress,
                std::unique_ptr<Triangulator>& triangulator) {
  if (request.mode != Mode::blocks || points < kMayBeTooMany) return false;
  progress.update_slow("preparing the device", kCompiling);
  triangulator = std::make_unique<Triangulator>(request.device);
  return are_too_many(points, *triangulator);
}

int triangulate_too_many(const TriangulateRequest& request, std::uint64_t points,
                         std::unique_ptr<Triangulator> triangulator) {
  const std::string reason =
      fmt::format("about {} points are too many at once: {}", points, what_would_fit(*triangulator));
  if (!request.results.mesh.empty() || request.profile) {
    throw Error(
        ErrorKind::device,
        fmt::format("{}: {}; without {}, they are triangulated in chunks", request.input, reason,
                    request.profile ? "--profile" : "--output (but with --triangles and --neighbors)"));
  }
  triangulator.reset();
  return triangulate_in_chunks(request, request.chunks, fmt::format("note: {}\n", reason));
}

RunFacts facts_of(const TriangulateRequest& request) {
  RunFacts facts;
  facts.input = request.input;
  facts.mode = to_string(request.mode);
  facts.counted = request.count;
  if (info_of(request.mode).cuts_regions) {
    facts.cut = to_string(request.cut);
    facts.dividing_paths = to_string(request.dividing_paths);
  }
  return facts;
}

research::Options options_of(const TriangulateRequest& request, Progress& progress) {
  research::Options options;
  options.mode = request.mode;
  options.cut = request.cut;
  options.hull = request.dividing_paths;
  options.finish = request.finish;
  ask_for(request.results, options);
  options.profile = request.profile;
  options.count = request.count;
  options.partition_levels = request.partition_levels;
  options.threads = request.threads;
  options.progress = progress.callback();
  return options;
}

int triangulate(const TriangulateRequest& request) {
  // The request is checked before any work begins, and the input before a device is opened.
  io::format_of(request.input, io::Use::read_points);
  io::check_columns(request.input, request.columns);
  if (request.is_in_space && !request.in_chunks)
    return triangulate_in_space(request, request.space, request.constraints.points);
  if (request.in_chunks) return triangulate_in_chunks(request, request.chunks, "");
  if (request.has_constraints) return triangulate_with_constraints(request, request.constraints);
  OutputFiles outputs({request.input});
  announce(outputs, request.results);
  const std::uint64_t about = io::estimate_points(request.input, request.columns);

  RunFacts facts = facts_of(request);
  Progress progress(!request.quiet);
  Stopwatch stopwatch;
  std::unique_ptr<Triangulator> triangulator;
  if (do_not_fit(request, about, progress, triangulator)) {
    progress.finish();
    outputs = OutputFiles();  // Chunks announce theirs.
    return triangulate_too_many(request, about, std::move(triangulator));
  }
  facts.opening_seconds = stopwatch.restart();

  progress.update("reading");
  io::Points points = io::read_points(request.input, request.columns, !request.results.mesh.empty());
  io::check_numbers(points, request.input);
  io::choose_crs(request.crs, request.input, request.results.mesh, points.crs);
  facts.reading_seconds = stopwatch.restart();
  const io::IndexType index = index_type(request.index, points.size(), request.results);

  const research::Options options = options_of(request, progress);
  research::Triangulation mesh;
  if (info_of(request.mode).on_host) {
    mesh = research::triangulate_on_host(points.coordinates.data(), {0, points.size()}, options);
  } else {
    progress.update_slow("preparing the device", kCompiling);
    if (triangulator == nullptr) triangulator = std::make_unique<Triangulator>(request.device);
    facts.opening_seconds += stopwatch.restart();
    const double* const coordinates = points.coordinates.data();
    // The paper's modes have a call of their own.
    const auto compute = [&](std::size_t n, const research::Options& wanted) {
      if (request.mode != Mode::blocks) return research::triangulate(*triangulator, coordinates, n, wanted);
      research::Triangulation plain;
      static_cast<Triangulation&>(plain) =
          triangulator->triangulate(coordinates, n, static_cast<const Options&>(wanted));
      return plain;
    };
    research::Options silent = options;
    silent.progress = nullptr;
    facts.compiling_seconds = compile_kernels(
        points.size(), request.mode, [&](std::size_t n) { note_compiling(compute(n, silent), facts); });
    mesh = compute(points.size(), options);
  }

  write_results(request.results, points, mesh, facts, progress, outputs, index);

  if (!request.quiet) {
    print((request.profile ? kernel_table(mesh.statistics) : "") + (request.count ? work_table(mesh) : "") +
          degenerate_note(mesh.statistics) + withheld_note(request.input, points) +
          heights_note(request.input, request.results.mesh, points) + host_note(facts.compiling_note) +
          host_note(mesh.statistics.note) + notes_text(outputs.notes) + summary(mesh.statistics, facts));
  }
  return kSuccess;
}

// Refuses what no output of the mesh can have.
void check_mesh(const CLI::App& command, const std::string& mesh) {
  if (io::find_format(mesh, io::Use::write_layer) == nullptr) {
    refuse(command, "--fields",
           fmt::format("needs a layer to write: -o {}", io::endings_for(io::Use::write_layer)));
  }
  // With two maps, it says that they have one.
  if (command.count("--constraints") == 0 && io::find_format(mesh, io::Use::write_features) == nullptr) {
    refuse(command, "--crs",
           fmt::format("needs an output that has one: -o {}", io::endings_for(io::Use::write_features)));
  }
}

std::vector<Mode> all_modes() {
  std::vector<Mode> modes;
  for (const research::ModeInfo& info : research::list_modes()) modes.push_back(info.mode);
  return modes;
}

constexpr const char* kOutputs = "Outputs";

// Whether no option names a file to be written.
bool writes_nothing(const CLI::App& command) {
  const auto names_file = [](const CLI::Option* option) {
    return option->count() > 0 && (option->get_group().starts_with(kOutputs) ||
                                   option->check_lname("offsets") || option->check_lname("hidden"));
  };
  return command.get_options(names_file).empty();
}

std::string mode_table() {
  std::vector<std::vector<std::string>> rows;
  for (const research::ModeInfo& info : research::list_modes()) {
    rows.push_back({"  " + std::string(info.name), info.description});
  }
  return "Modes:\n" + aligned(rows);
}

}  // namespace

void add_triangulate(CLI::App& app, Action& action) {
  auto request = std::make_shared<TriangulateRequest>();
  CLI::App* command = app.add_subcommand("triangulate", "Triangulate the points of a file");
  add_input(command, request->input, request->columns);
  add_heights(command, request->columns);
  add_crs(command, request->crs);
  end_group(command, "Input");
  add_results(command, request->results);
  add_fields(command, request->columns,
             "Fields of points, from a layer, GeoJSON or text, whose means triangles have in a layer");
  add_index(command, request->index);
  end_group(command, kOutputs);
  add_choice<Mode>(command, "--mode", request->mode,
                   "How to divide and conquer (see below); the triangles do not depend on it", all_modes());
  add_cut(command, request->cut);
  add_hull_variant(command, request->dividing_paths,
                   {Hull::prune, Hull::quickhull, Hull::balanced, Hull::monotone_chain},
                   "How dividing paths are computed; the triangles do not depend on it. monotone-chain: mode "
                   "recursive only");
  add_choice<Finish>(command, "--finish", request->finish,
                     "Mode flattened: where its levels end, at regions as small as blocks or without points",
                     {Finish::blocks, Finish::levels});
  command
      ->add_option("--partition-levels", request->partition_levels,
                   "Mode partition: number of levels on the device; default: enough for the threads")
      ->check(CLI::Range(1, kMostPartitionLevels));
  add_threads(command, request->threads, "Mode partition: number of host threads; default: one per core");
  end_group(command, "Algorithm");
  add_device(command, request->device)
      ->description(
          "Device: a part of its name, or #k for the k-th that flaunay devices lists; several with commas "
          "between them, or all: triangulates in chunks, on each of them");
  end_group(command, "Device");
  add_constraint_options(command, request->constraints);
  add_space_options(command, request->space);
  add_path(command, "--hidden", request->space.hidden, "With --weighted: points without a power cell: .npy");
  end_group(command, "Torus, sphere and weights");
  add_chunk_options(command, request->chunks);
  end_group(command, "More points than memory");
  command->add_flag("--profile", request->profile, "Time every kernel; the times are printed as a table");
  command->add_flag("--count", request->count, "Count operations, for a table and for the statistics (slow)");
  add_quiet(command, request->quiet);
  end_group(command, "Reports");
  command->footer(examples({"flaunay triangulate points.npy --triangles t.npy --neighbors n.npy",
                            "flaunay triangulate points.npy -o picture.svg",
                            "flaunay triangulate points.npy --min-angle 30 -o refined.obj",
                            "flaunay generate grid 100 -o - | flaunay triangulate - -o - | head"}) +
                  "\n" + mode_table());
  command->callback([request, command, &action] {
    check_combination(*command, *request);
    check_fields(*command, request->input, request->constraints.segments);
    check_mesh(*command, request->results.mesh);
    request->is_in_space = asks_for_space(*command, request->space);
    const bool is_silent = request->quiet || request->profile || request->count;
    const bool needs_note = !is_silent && writes_nothing(*command);
    action = [request, needs_note] {
      const int code = triangulate(*request);
      if (needs_note) print("note: nothing was written, for want of an output such as -o picture.svg\n");
      return code;
    };
    request->in_chunks = asks_for_chunks(*command, request->device);
    if (request->is_in_space && request->in_chunks) {
      request->chunks.space = space_of(request->space);
      request->chunks.offsets = request->space.offsets;
    }
    if (request->is_in_space) return;
    request->has_constraints = has_constraints(*command, request->input, request->constraints);
    if (request->in_chunks && request->has_constraints)
      refuse(*command, "--device", "constraints need one device");
    if (request->in_chunks) check_chunk_options(*command, to_string(request->mode));
  });
}

}  // namespace flaunay::cli
