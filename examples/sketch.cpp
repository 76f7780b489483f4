// Adds points one by one, such as clicks in a drawing program, drags one of them and takes it away again.
// What each call tells keeps a copy of the triangles up to date, such as that in the memory of a screen.
//
//   sketch [POINTS] [CLICKS]

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <flaunay/dynamic.hpp>
#include <random>
#include <vector>

namespace {

using Triangle = std::array<std::int32_t, 3>;

constexpr Triangle kNone = {-1, -1, -1};

// Triangles by their rows.
struct Screen {
  explicit Screen(flaunay::DynamicTriangulation& mesh) : rows(mesh.row_count()) {
    const flaunay::TriangleRows all = mesh.rows();
    for (std::size_t r = 0; r < rows.size(); ++r) std::copy_n(&all.triangles[3 * r], 3, rows[r].begin());
  }
  void follow(const flaunay::Changes& changes) {
    for (const std::int32_t row : changes.removed) rows[row] = kNone;
    for (std::size_t k = 0; k < changes.made.size(); ++k) {
      const std::size_t row = changes.made[k];
      if (row >= rows.size()) rows.resize(row + 1, kNone);
      std::copy_n(&changes.made_corners[3 * k], 3, rows[row].begin());
    }
    drawn += changes.made.size();
    seconds += changes.seconds;
  }
  std::size_t triangles() const { return rows.size() - std::count(rows.begin(), rows.end(), kNone); }

  std::vector<Triangle> rows;
  std::size_t drawn = 0;
  double seconds = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const std::size_t n = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100000;
  const std::size_t clicks = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> xy(2 * n);
  for (double& x : xy) x = unit(random);

  try {
    flaunay::Triangulator triangulator;
    flaunay::DynamicTriangulation mesh(triangulator, xy.data(), n);
    Screen screen(mesh);
    for (std::size_t click = 0; click < clicks; ++click) {
      std::array<double, 2> place = {unit(random), unit(random)};
      const flaunay::Changes clicked = mesh.insert(place.data(), 1);
      screen.follow(clicked);
      if (click % 2 == 0) continue;
      // Every second point is dragged a little, and taken away.
      const auto point = static_cast<std::int32_t>(clicked.first_point);
      place[0] += 1e-4;
      screen.follow(mesh.move(&point, place.data(), 1));
      screen.follow(mesh.remove(&point, 1));
    }
    const std::size_t calls = clicks + clicks / 2 * 2;
    std::printf("%zu points, %zu triangles, %zu on the screen\n", mesh.point_count(), mesh.triangle_count(),
                screen.triangles());
    std::printf("%zu calls, %.1f us and %.1f new triangles each\n", calls, 1e6 * screen.seconds / calls,
                static_cast<double>(screen.drawn) / calls);
  } catch (const flaunay::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
