// flaunay-bench: measures flaunay, its parts, and other programs for the same tasks. Subcommands print
// measurements as tables, and write them as records.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>
#include <string>

#include "app/command/errors.hpp"
#include "bench/measuring/command.hpp"
#include "host/error.hpp"

namespace flaunay::bench {
namespace {

int fail(int code, const std::string& message) { return cli::report_error("flaunay-bench", code, message); }

int run(int argc, char** argv) {
  CLI::App app("Measures flaunay, its parts, and others that do the same.", "flaunay-bench");
  app.footer(
      R"(Each subcommand prints tables and, with --json, writes a record; bench/plot.py RECORD.json -o FILE.svg draws
it. FLAUNAY_DEVICE chooses the device where --device does not. Whatever is timed takes turns, and the first run of
each is not counted; what is over in less than 0.05 s is repeated within a run. Processor times are those of all
threads of the process and of its children; on a GPU, only of the host's. The exit code is 1 if implementations'
numbers of triangles or answers differ; a missed target does not change it.)");
  // Zero here, so that an unknown subcommand is reported by its name and not as a missing one.
  app.require_subcommand(0, 1);
  Action action;
  for (const auto& [name, add] : all_subcommands()) add(app, action);
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
  using namespace flaunay;
  try {
    return bench::run(argc, argv);
  } catch (const Error& error) {
    return bench::fail(cli::exit_code(error.kind()), error.what());
  } catch (const host::DeviceError& error) {
    return bench::fail(cli::kDevice, error.what());
  } catch (const std::exception& error) {
    return bench::fail(cli::kFailure, error.what());
  }
}
