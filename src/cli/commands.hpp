// The subcommands: each adds itself to the parser and leaves what to do if it is chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace flaunay::cli {

/// The chosen subcommand's work; returns the exit code, throws Error.
using Action = std::function<int()>;

enum ExitCode : int { kSuccess = 0, kFailure = 1, kUsage = 2, kBadInput = 3, kDevice = 4 };

void add_triangulate(CLI::App& app, Action& action);
void add_partition(CLI::App& app, Action& action);
void add_assemble(CLI::App& app, Action& action);
void add_generate(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);

}  // namespace flaunay::cli
