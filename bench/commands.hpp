// The subcommands: each adds itself to the parser and leaves what to do if it is chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "cli/exit_codes.hpp"

namespace flaunay::bench {

/// The chosen subcommand's work, given the command line as the record shows it; returns the exit code.
using Action = std::function<int(const std::string& command)>;

using cli::kFailure;
using cli::kSuccess;
using cli::kUsage;

void add_peers(CLI::App& app, Action& action);
void add_primitives(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_paper(CLI::App& app, Action& action);
void add_targets(CLI::App& app, Action& action);
void add_scaling(CLI::App& app, Action& action);
void add_cliffs(CLI::App& app, Action& action);
void add_small(CLI::App& app, Action& action);
void add_batches(CLI::App& app, Action& action);
void add_embedding(CLI::App& app, Action& action);
void add_threads(CLI::App& app, Action& action);

}  // namespace flaunay::bench
