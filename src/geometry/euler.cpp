#include "geometry/euler.hpp"

#include <fmt/format.h>

#include "flaunay/flaunay.hpp"

namespace flaunay::geometry {

void check_euler(std::uint64_t triangles, std::uint64_t hull, std::uint64_t vertices,
                 const std::string& where) {
  if (triangles == 0 ? hull == vertices : triangles + hull + 2 == 2 * vertices) return;
  throw Error(ErrorKind::internal,
              fmt::format("{} triangles and {} hull vertices of {} vertices{}; please report the input",
                          triangles, hull, vertices, where));
}

}  // namespace flaunay::geometry
