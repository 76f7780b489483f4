// What describes the command to other programs, made of its parser: completion for shells, and the manual
// page.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace flaunay::cli {

/// What printed can make, in the order of the help.
const std::vector<std::string>& printable_kinds();

/// The file of this kind.
std::string printed(const CLI::App& app, const std::string& kind);

/// "; did you mean --triangles, not --triangels?" for the first argument that the parser did not know and
/// that is much like an option or a subcommand; otherwise empty.
std::string suggestion(const CLI::App& app);

}  // namespace flaunay::cli
