// The twin of the stage `neighbors`: the half-edges of a mesh in pairs.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace flaunay::testing {

/// The twin of half-edge 3t + j, which runs from vertex j of triangle t to the next; -1 for none.
inline std::vector<cl_int> twins_twin(const std::vector<cl_int>& triangles) {
  std::map<std::pair<int, int>, cl_int> halfedge_of;
  const auto from = [&](std::size_t h) { return triangles[h]; };
  const auto to = [&](std::size_t h) { return triangles[h / 3 * 3 + (h + 1) % 3]; };
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    if (!halfedge_of.emplace(std::make_pair(from(h), to(h)), static_cast<cl_int>(h)).second) {
      throw std::logic_error("an edge of two triangles on one side");
    }
  }
  std::vector<cl_int> twins;
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    const auto found = halfedge_of.find({to(h), from(h)});
    twins.push_back(found == halfedge_of.end() ? -1 : found->second);
  }
  return twins;
}

}  // namespace flaunay::testing
