// The command `flaunay`: parses the arguments, runs one subcommand, and turns an error into a message and an
// exit code.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <new>
#include <string>

#include "app/command/commands.hpp"
#include "files/temporary.hpp"
#include "flaunay/flaunay.hpp"

namespace {

using namespace flaunay::cli;

int fail(int code, const std::string& message) { return report_error("flaunay", code, message); }

// The system gives a file the lowest free descriptor. If a standard stream is closed, that would be the
// stream's, and what is meant for the stream would go into the file.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // In the other direction, so that using the stream is still an error.
    ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
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
  occupy_closed_streams();
  // A closed pipe and a file that becomes too large are handled where the output is written.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  flaunay::io::clean_up_when_interrupted();
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
