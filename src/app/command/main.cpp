// The command `flaunay`: parses the arguments, runs one subcommand, and turns an error into a message and an
// exit code.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/output.hpp"
#include "app/command/printed.hpp"
#include "files/temporary.hpp"
#include "flaunay/flaunay.hpp"
#include "host/system/process.hpp"

namespace {

using namespace flaunay::cli;

int fail(int code, const std::string& message) { return report_error("flaunay", code, message); }

int run(std::vector<std::string> arguments) {
  CLI::App app(FLAUNAY_DESCRIPTION ".", "flaunay");
  app.set_version_flag("--version", std::string("flaunay ") + flaunay::version());
  std::string kind;
  app.add_option("--print", kind, "Print completion for a shell, or the manual page, and do nothing else")
      ->check(CLI::IsMember(printable_kinds()));
  app.footer("The environment variable FLAUNAY_DEVICE chooses the device if --device is not given.");
  // Paths may begin with a slash on Windows, too.
  app.allow_windows_style_options(false);
  // At least 0, so that CLI11 reports an unknown subcommand by its name and not as a missing one.
  app.require_subcommand(0, 1);
  Action action;
  add_triangulate(app, action);
  add_partition(app, action);
  add_assemble(app, action);
  add_generate(app, action);
  add_voronoi(app, action);
  add_terrain(app, action);
  add_verify(app, action);
  add_devices(app, action);
  try {
    // As CLI11 takes them: backwards, and without the program's name.
    std::reverse(arguments.begin(), arguments.end());
    if (!arguments.empty()) arguments.pop_back();
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    // CLI11's own text has them backwards.
    const std::string what = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)
                                 ? fmt::format("not understood: {}", fmt::join(app.remaining(true), " "))
                                 : error.what();
    return fail(kUsage, fmt::format("{}{} (see flaunay {}--help)", what, suggestion(app),
                                    chosen.empty() ? "" : chosen.front()->get_name() + " "));
  }
  if (!kind.empty()) {
    print(printed(app, kind));
    return kSuccess;
  }
  if (!action) {
    return fail(kUsage,
                "a subcommand is required: triangulate, partition, assemble, generate, voronoi, terrain, "
                "verify or devices");
  }
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  flaunay::system::prepare_streams();
  flaunay::io::clean_up_when_interrupted();
  try {
    return run(flaunay::system::arguments_of_main(argc, argv));
  } catch (const flaunay::Error& error) {
    return fail(exit_code(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(kBadInput, "not enough memory on the host for an input of this size");
  } catch (const std::exception& error) {
    return fail(kFailure, fmt::format("internal error: {}", error.what()));
  }
}
