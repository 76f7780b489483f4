// flaunay-bench: measures flaunay, its parts, and others that do the same. Each subcommand has a file.
#include <fmt/format.h>

#include <exception>
#include <string>

#include "commands.hpp"
#include "flaunay/flaunay.hpp"

namespace {

using namespace flaunay::bench;

int fail(int code, const std::string& message) {
  fmt::print(stderr, "flaunay-bench: {}\n", message);
  return code;
}

std::string command_line(int argc, char** argv) {
  std::string command = "flaunay-bench";
  for (int i = 1; i < argc; ++i) command += fmt::format(" {}", argv[i]);
  return command;
}

int run(int argc, char** argv) {
  CLI::App app("Measures flaunay, its parts, and others that do the same.", "flaunay-bench");
  app.footer("FLAUNAY_DEVICE chooses the device where --device does not.");
  // Zero here, so that an unknown subcommand is reported by its name and not as a missing one.
  app.require_subcommand(0, 1);
  Action action;
  for (const auto add : {add_targets, add_peers, add_modes, add_scaling, add_cliffs, add_small, add_batches,
                         add_embedding, add_threads, add_primitives, add_paper}) {
    add(app, action);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return fail(kUsage, fmt::format("{} (see flaunay-bench --help)", error.what()));
  }
  if (!action) return fail(kUsage, "a subcommand is required (see flaunay-bench --help)");
  return action(command_line(argc, argv));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const flaunay::Error& error) {
    return fail(flaunay::cli::exit_code(error.kind()), error.what());
  } catch (const std::exception& error) {
    return fail(kFailure, error.what());
  }
}
