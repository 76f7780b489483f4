// The subcommands. Each adds itself to the parser; if it is chosen, it stores its work in `action`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "app/command/errors.hpp"

namespace flaunay::cli {

/// The work of the chosen subcommand. Returns the exit code, throws Error.
using Action = std::function<int()>;

void add_triangulate(CLI::App& app, Action& action);
void add_partition(CLI::App& app, Action& action);
void add_assemble(CLI::App& app, Action& action);
void add_generate(CLI::App& app, Action& action);
void add_voronoi(CLI::App& app, Action& action);
void add_terrain(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_devices(CLI::App& app, Action& action);

}  // namespace flaunay::cli
