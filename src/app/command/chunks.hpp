// Triangulations in chunks, of points that do not fit memory at once.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/command/results.hpp"
#include "flaunay/chunks.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

/// How to triangulate in chunks.
struct ChunkRequest {
  std::uint64_t memory_bytes = 0;  ///< 0: the library's choice
  std::size_t chunk_points = 0;    ///< 0: the library's choice
  std::string scratch;
  Space space = Space::plane();
  std::string offsets;  ///< with a period, the file for those of corners
};

/// Adds --memory, --chunk-points and --scratch.
void add_chunk_options(CLI::App* command, ChunkRequest& request);
/// Adds --index: a choice for index_type.
void add_index(CLI::App* command, std::string& index);

/// Whether the options ask for chunks, by their size or by more than one device.
bool asks_for_chunks(const CLI::App& command, const std::string& device_list);

/// Throws Error(usage) for options that triangulations in chunks cannot honour.
void check_chunk_options(const CLI::App& command, const std::string& mode);

/// From this many points on, the command finds out whether they fit memory at once.
constexpr std::uint64_t kMayBeTooMany = 1'000'000;
/// Whether so many points with their results are too many for one call.
bool are_too_many(std::uint64_t points, const Triangulator& triangulator);
/// How many points one call can take, where, and what limits it, for messages.
std::string what_would_fit(const Triangulator& triangulator);

/// The type of indices in the files. Throws Error(usage) if the one that was asked for is too narrow.
io::IndexType index_type(const std::string& choice, std::uint64_t points, const ResultPaths& results);

/// Reads, triangulates and writes. note: printed before the final line. Returns the exit code.
int triangulate_in_chunks(const Task& task, const ChunkRequest& request, const std::string& note);

}  // namespace flaunay::cli
