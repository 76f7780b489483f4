// Triangulates thousands of small point sets in one call, such as the cells of a map.
//
//   batch [SETS]

#include <cstdio>
#include <cstdlib>
#include <flaunay/flaunay.hpp>
#include <random>
#include <vector>

int main(int argc, char** argv) {
  const std::size_t sets = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10000;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<std::size_t> size(0, 200);

  std::vector<double> xy;
  std::vector<std::size_t> offsets{0};
  for (std::size_t s = 0; s < sets; ++s) {
    const std::size_t n = size(random);  // none at all is fine too
    for (std::size_t i = 0; i < 2 * n; ++i) xy.push_back(unit(random));
    offsets.push_back(xy.size() / 2);
  }

  try {
    flaunay::Triangulator triangulator;
    const flaunay::Triangulation meshes = triangulator.triangulate(xy.data(), offsets);
    std::size_t largest = 0, least = offsets.back();
    for (std::size_t s = 0; s < sets; ++s) {
      // The triangles of set s, as indices of points over all sets.
      const std::size_t triangles = meshes.triangle_offsets[s + 1] - meshes.triangle_offsets[s];
      largest = triangles > largest ? triangles : largest;
      least = triangles < least ? triangles : least;
    }
    std::printf("%zu sets, %zu points, %zu triangles: %zu to %zu a set, in %.3f s\n", sets, offsets.back(),
                meshes.triangles.size() / 3, least, largest, meshes.statistics.seconds);
  } catch (const flaunay::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
