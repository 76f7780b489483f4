// A square and the point in its middle.
#include <cmath>
#include <cstdio>
#include <flaunay/flaunay.hpp>

int main() {
  const double xy[] = {0, 0, 2, 0, 2, 2, 0, 2, 1, 1};
  try {
    flaunay::Triangulator triangulator;
    const flaunay::Triangulation mesh = triangulator.triangulate(xy, 5);
    if (mesh.triangles.size() != 4 * 3 || mesh.hull != std::vector<std::int32_t>{0, 1, 2, 3}) {
      std::fprintf(stderr, "consumer: %zu indices of triangles, %zu points on the hull\n",
                   mesh.triangles.size(), mesh.hull.size());
      return 1;
    }
    for (std::size_t t = 0; t < 4; ++t) {
      int middle = 0;
      for (int k = 0; k < 3; ++k) {
        middle += mesh.triangles[3 * t + k] == 4;
      }
      if (middle != 1) {
        std::fprintf(stderr, "consumer: triangle %zu is without the middle\n", t);
        return 1;
      }
    }

    // The library's exception is caught as what it is.
    const double bad[] = {0, 0, 1, NAN};
    try {
      triangulator.triangulate(bad, 2);
      std::fprintf(stderr, "consumer: a point that is none was accepted\n");
      return 1;
    } catch (const flaunay::Error& error) {
      if (error.kind() != flaunay::ErrorKind::input) {
        throw;
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    return 1;
  }
  std::printf("flaunay %s: 4 triangles\n", flaunay::version());
}
