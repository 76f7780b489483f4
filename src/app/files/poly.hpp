// Triangle's .poly files: vertices, segments, holes and regions.
#pragma once

#include <string>

#include "app/files/map.hpp"
#include "app/files/node.hpp"

namespace flaunay::io {

/// Reads a file. nodes: the vertices that one without its own refers to, which the map then does not have;
/// null to read them from the .node file beside it. Throws Error(input) that names the line.
Map read_poly(const std::string& path, const NodeFile* nodes);

}  // namespace flaunay::io
