// The subcommands: each adds itself to the parser and leaves what to do if it is chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace flaunay::bench {

/// The chosen subcommand's work, given the command line as the record shows it; returns the exit code.
using Action = std::function<int(const std::string& command)>;

enum ExitCode : int { kSuccess = 0, kFailure = 1, kUsage = 2, kBadInput = 3, kDevice = 4 };

void add_peers(CLI::App& app, Action& action);
void add_primitives(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_paper(CLI::App& app, Action& action);

}  // namespace flaunay::bench
