// flaunay-bench: measures flaunay, its parts, and others that do the same. Subcommands print what they
// measure as tables, and write it as records.
#include <fmt/format.h>

#include <exception>
#include <string>

#include "cli/errors.hpp"
#include "command.hpp"

namespace flaunay::bench {

// Each is defined in the file of its name; scaling and small are in sizes.cpp.
void add_targets(CLI::App& app, Action& action);
void add_peers(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_scaling(CLI::App& app, Action& action);
void add_cliffs(CLI::App& app, Action& action);
void add_small(CLI::App& app, Action& action);
void add_batches(CLI::App& app, Action& action);
void add_embedding(CLI::App& app, Action& action);
void add_threads(CLI::App& app, Action& action);
void add_processes(CLI::App& app, Action& action);
void add_launches(CLI::App& app, Action& action);
void add_device(CLI::App& app, Action& action);
void add_primitives(CLI::App& app, Action& action);
void add_paper(CLI::App& app, Action& action);

namespace {

int fail(int code, const std::string& message) { return cli::report_error("flaunay-bench", code, message); }

int run(int argc, char** argv) {
  CLI::App app("Measures flaunay, its parts, and others that do the same.", "flaunay-bench");
  app.footer(
      "Each subcommand prints tables and, with --json, writes a record; bench/plot.py RECORD.json -o "
      "FILE.svg "
      "draws it.\nFLAUNAY_DEVICE chooses the device where --device does not.");
  // Zero here, so that an unknown subcommand is reported by its name and not as a missing one.
  app.require_subcommand(0, 1);
  Action action;
  for (const auto add :
       {add_targets, add_peers, add_modes, add_scaling, add_cliffs, add_small, add_batches, add_embedding,
        add_threads, add_processes, add_launches, add_device, add_primitives, add_paper}) {
    add(app, action);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return fail(cli::kUsage, fmt::format("{} (see flaunay-bench --help)", error.what()));
  }
  if (!action) return fail(cli::kUsage, "a subcommand is required (see flaunay-bench --help)");
  return action(fmt::format("flaunay-bench {}", fmt::join(argv + 1, argv + argc, " ")));
}

}  // namespace
}  // namespace flaunay::bench

int main(int argc, char** argv) {
  try {
    return flaunay::bench::run(argc, argv);
  } catch (const flaunay::Error& error) {
    return flaunay::bench::fail(flaunay::cli::exit_code(error.kind()), error.what());
  } catch (const std::exception& error) {
    return flaunay::bench::fail(flaunay::cli::kFailure, error.what());
  }
}
