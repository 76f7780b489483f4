#include "call/areas.hpp"

#include "call/triangulate.hpp"
#include "launchers/call/areas.cl.hpp"
#include "predicates/rounded_area.h"

namespace flaunay::call {

void write_areas(Engine& engine, const HostPoints& points, Triangulation& result) {
  const std::size_t triangles = result.triangles.size() / 3;
  // Fewer take less time than a call of the engine.
  constexpr std::size_t kFewest = 1 << 14;
  if (triangles < kFewest) return write_areas(points, result);
  Frame call(engine);
  const auto areas = call.out<cl_double>(result.areas, triangles);
  engine.runtime.map(triangles, kernels::triangle_areas{.input = call.points(points).as<cl_ulong>(),
                                                        .triangles = call.in(result.triangles),
                                                        .areas = areas.as<cl_ulong>()});
  call.end();
}

void write_areas(const HostPoints& points, Triangulation& result) {
  const std::vector<double> doubles = widened(points);
  const auto* const input =
      reinterpret_cast<const kernel::double_bits*>(points.wide != nullptr ? points.wide : doubles.data());
  const std::int32_t* corners = result.triangles.data();
  result.areas.resize(result.triangles.size() / 3);
  for (double& area : result.areas) {
    area = kernel::as_double(kernel::rounded_area(input, corners[0], corners[1], corners[2]));
    corners += 3;
  }
}

}  // namespace flaunay::call
