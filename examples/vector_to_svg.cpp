// Triangulates points in a vector and draws a picture.
//
//   vector_to_svg [FILE.svg]

#include <cmath>
#include <cstdio>
#include <flaunay/flaunay.hpp>
#include <fstream>
#include <vector>

namespace {

// Vogel's model of a sunflower's head.
std::vector<double> sunflower(std::size_t n) {
  const double golden_angle = 3.14159265358979323846 * (3 - std::sqrt(5.0));
  std::vector<double> xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double radius = std::sqrt((i + 0.5) / n), angle = golden_angle * i;
    xy.push_back(radius * std::cos(angle));
    xy.push_back(radius * std::sin(angle));
  }
  return xy;
}

void write_svg(const char* path, const std::vector<double>& xy, const flaunay::Triangulation& mesh) {
  std::ofstream svg(path);
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='600' height='600' viewBox='-1.05 -1.05 2.1 2.1'>\n"
      << "<path fill='none' stroke='#246' stroke-width='0.003' stroke-linejoin='round' d='";
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(mesh.triangles[t + k]);
      svg << (k == 0 ? "M" : "L") << xy[2 * i] << " " << -xy[2 * i + 1];
    }
    svg << "Z";
  }
  svg << "'/>\n</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  const char* const path = argc > 1 ? argv[1] : "sunflower.svg";
  try {
    const std::vector<double> xy = sunflower(1000);
    flaunay::Triangulator triangulator;  // the default device; keep it for the next call
    const flaunay::Triangulation mesh = triangulator.triangulate(xy.data(), xy.size() / 2);
    write_svg(path, xy, mesh);
    std::printf("%zu points, %zu triangles, %s\n", xy.size() / 2, mesh.triangles.size() / 3, path);
  } catch (const flaunay::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
