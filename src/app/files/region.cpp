#include "app/files/region.hpp"

#include <utility>
#include <vector>

#include "app/files/node.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

void write_region_node(OutputFile& file, const Points& points, const research::Region& region) {
  std::vector<char> on_border(region.points.size(), 0);
  for (const std::int32_t position : region.border) on_border[static_cast<std::size_t>(position)] = 1;
  file.print("{} 2 1 1\n", region.points.size());
  for (std::size_t k = 0; k < region.points.size(); ++k) {
    const auto index = static_cast<std::size_t>(region.points[k]);
    file.print("{} {} {} {} {}\n", k, points.coordinates[2 * index], points.coordinates[2 * index + 1], index,
               static_cast<int>(on_border[k]));
  }
}

void write_region_poly(OutputFile& file, const research::Region& region) {
  // The vertices are in the .node file.
  file.print("0 2 1 1\n{} 0\n", region.border.size() / 2);
  for (std::size_t k = 0; k + 1 < region.border.size(); k += 2) {
    file.print("{} {} {}\n", k / 2, region.border[k], region.border[k + 1]);
  }
  file.print("0\n");
}

void check_count(const std::string& path, const char* what, std::size_t found, std::size_t expected) {
  if (found != expected) fail(path, "has {} {}; expected {}", found, what, expected);
}

}  // namespace

void write_region(Outputs& outputs, const std::string& stem, const Points& points,
                  const research::Region& region) {
  write_region_node(outputs.open(stem + ".node"), points, region);
  write_region_poly(outputs.open(stem + ".poly"), region);
}

StoredRegion read_region(const std::string& stem, std::size_t points, std::size_t border_edges) {
  NodeFile nodes = read_node(stem + ".node", true);
  check_count(stem + ".node", "vertices", nodes.points.size(), points);
  StoredRegion stored;
  stored.region.border = read_poly(stem + ".poly", &nodes).segments;
  check_count(stem + ".poly", "segments", stored.region.border.size() / 2, border_edges);
  stored.region.points = std::move(nodes.indices);
  stored.points = std::move(nodes.points);
  return stored;
}

}  // namespace flaunay::io
