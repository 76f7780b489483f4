// Triangulations with constraints: the options of `flaunay triangulate` for them, and the work.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/command/results.hpp"
#include "app/files/map.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::cli {

struct ConstraintRequest {
  std::string segments;                   ///< a file; empty if the input has the segments
  std::vector<std::string> line_heights;  ///< its fields with heights; empty: those of the input
  Crossings crossings = Crossings::error;
  Outside outside = Outside::keep;
  FillRule fill = FillRule::nesting;
  std::vector<std::string> holes;  ///< "X,Y" each
  bool separate = false;
  Refinement refinement;
  bool region_areas = false;  ///< seed areas are those of the input
  std::string mesh, areas;    ///< files with the triangles that are refined further, and their areas
  Overlaps overlaps = Overlaps::first;
  ArrayPaths<decltype(kConstrainedArrays)> arrays;
  std::string points;  ///< the file for input and added points
  // Whether the user chose these; otherwise the input decides.
  bool chose_outside = false, chose_fill = false, chose_overlaps = false;

  bool is_refined() const { return refinement.is_wanted() || region_areas || !areas.empty(); }
};

void add_constraint_options(CLI::App* command, ConstraintRequest& request);
/// The options among them that say what the segments are and what they bound: --constraints, --outside,
/// --fill, --hole.
void add_domain_options(CLI::App* command, ConstraintRequest& request);
/// Checks the options of add_domain_options for an input with segments. Throws Error(usage).
void check_domain_options(const CLI::App& command, const std::string& input, ConstraintRequest& request);

/// Reads points, segments and holes, and decides what is outside unless the user has. with_heights: as of
/// read_points. checks_crs: whether points and segments must have one system.
io::Map read_domain(const std::string& input, const io::Columns& columns, ConstraintRequest& request,
                    bool with_heights = false, bool checks_crs = false);
/// The map's segments, and after them its lines.
std::vector<std::int32_t> all_segments(const io::Map& map);
/// The rings of the map's polygons, unless it has neither polygons nor lines, or the rule is nesting.
Rings rings_of(const io::Map& map, FillRule fill);

/// Whether the triangulation has constraints. Throws Error(usage) for options that do not go together.
bool has_constraints(const CLI::App& command, const std::string& input, ConstraintRequest& request);

/// Reads, triangulates and writes. Returns the exit code.
int triangulate_with_constraints(const Task& task, const ConstraintRequest& request);

}  // namespace flaunay::cli
