// flaunay-bench: measures flaunay, its parts, and others that do the same. Subcommands print what they
// measure as tables, and write it as records.
#include <fmt/format.h>

#include <exception>
#include <string>

#include "app/command/errors.hpp"
#include "command.hpp"

namespace flaunay::bench {

// Each is defined in the file of its namespace's name.
namespace targets {
void add(CLI::App& app, Action& action);
}
namespace peers {
void add(CLI::App& app, Action& action);
}
namespace modes {
void add(CLI::App& app, Action& action);
}
namespace sizes {
void add_scaling(CLI::App& app, Action& action);
void add_small(CLI::App& app, Action& action);
}  // namespace sizes
namespace cliffs {
void add(CLI::App& app, Action& action);
}
namespace batches {
void add(CLI::App& app, Action& action);
}
namespace chunks {
void add(CLI::App& app, Action& action);
}
namespace embedding {
void add(CLI::App& app, Action& action);
}
namespace interpolation {
void add(CLI::App& app, Action& action);
}
namespace cells {
void add(CLI::App& app, Action& action);
}
namespace constrained {
void add(CLI::App& app, Action& action);
}
namespace threads {
void add(CLI::App& app, Action& action);
}
namespace arithmetic {
void add(CLI::App& app, Action& action);
}
namespace processes {
void add(CLI::App& app, Action& action);
}
namespace ranks {
void add(CLI::App& app, Action& action);
}
namespace launches {
void add(CLI::App& app, Action& action);
}
namespace device {
void add(CLI::App& app, Action& action);
}
namespace primitives {
void add(CLI::App& app, Action& action);
}
namespace natural {
void add(CLI::App& app, Action& action);
}
namespace paper {
void add(CLI::App& app, Action& action);
}

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
       {targets::add,     peers::add,   modes::add,     sizes::add_scaling, cliffs::add,   sizes::add_small,
        batches::add,     chunks::add,  embedding::add, interpolation::add, natural::add,  cells::add,
        constrained::add, threads::add, processes::add, ranks::add,         launches::add, device::add,
        primitives::add,  paper::add,   arithmetic::add}) {
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
