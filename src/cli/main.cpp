// The command `flaunay`: parses the arguments, runs one subcommand, and turns an error into a message and an
// exit code.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "cli/commands.hpp"
#include "flaunay/flaunay.hpp"

namespace {

using namespace flaunay::cli;

int fail(int code, const std::string& message) {
  const std::string line = fmt::format("flaunay: {}\n", message);
  std::fwrite(line.data(), 1, line.size(), stderr);
  return code;
}

int run(int argc, char** argv) {
  CLI::App app("Exact two-dimensional Delaunay triangulation on any OpenCL device.", "flaunay");
  app.set_version_flag("--version", std::string("flaunay ") + flaunay::version());
  app.footer("The environment variable FLAUNAY_DEVICE chooses the device if --device is not given.");
  // At least 0, so that CLI11 reports an unknown subcommand by its name and not as a missing one.
  app.require_subcommand(0, 1);
  Action action;
  add_triangulate(app, action);
  add_partition(app, action);
  add_assemble(app, action);
  add_generate(app, action);
  add_verify(app, action);
  add_devices(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(kUsage, fmt::format("{} (see flaunay --help)", error.what()));
  }
  if (!action) {
    return fail(kUsage,
                "a subcommand is required: triangulate, partition, assemble, generate, verify or devices");
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  // A closed pipe is handled where the output is written.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const flaunay::Error& error) {
    return fail(exit_code(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(kBadInput, "not enough memory on the host for an input of this size");
  } catch (const std::exception& error) {
    return fail(kFailure, fmt::format("internal error: {}", error.what()));
  }
}
