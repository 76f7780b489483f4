// A picture of a partition's regions, one colour each.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "app/files/drawing.hpp"
#include "app/files/region.hpp"
#include "files/output.hpp"

namespace flaunay::io {
namespace {

// Borders are drawn this far beyond the view, so that their lines cross its edge without a corner.
constexpr double kRoom = 50;
constexpr std::size_t kMostDots = 100'000;  // of more, nobody could tell one from another

/// Colours whose hues are far apart for consecutive numbers, by the golden ratio.
std::string region_color(std::size_t r, double saturation, double lightness) {
  constexpr double kGolden = 0.6180339887498949;
  const double hue = 12 * std::fmod(0.58 + static_cast<double>(r) * kGolden, 1.0);
  const double amplitude = saturation * std::min(lightness, 1 - lightness);
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue, 12.0);
    const double value = lightness - amplitude * std::clamp(std::min(k - 3, 9 - k), -1.0, 1.0);
    return static_cast<int>(std::lround(255 * value));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(0), channel(8), channel(4));
}

/// A border as closed walks. Where it passes a point several times, any walk on is right: the edges wind
/// around the inside once, whatever their order.
std::vector<std::vector<std::int32_t>> closed_walks(const std::vector<std::int32_t>& border) {
  std::multiset<std::array<std::int32_t, 2>> edges;
  for (std::size_t k = 0; k + 1 < border.size(); k += 2) edges.insert({border[k], border[k + 1]});
  std::vector<std::vector<std::int32_t>> walks;
  while (!edges.empty()) {
    std::vector<std::int32_t>& walk = walks.emplace_back();
    for (auto edge = edges.begin(); edge != edges.end();) {
      const auto [from, to] = *edge;
      walk.push_back(from);
      edges.erase(edge);
      edge = edges.lower_bound({to, 0});
      if (edge != edges.end() && (*edge)[0] != to) break;
    }
  }
  return walks;
}

class PartitionPicture {
 public:
  PartitionPicture(OutputFile& file, const Points& points, const research::Partition& partition)
      : file_(file), drawing_(file, points), partition_(partition) {}

  void write() {
    constexpr double kEdge = 3;  // room for the width of lines on the view's boundary
    drawing_.begin("Regions of " + counted(points_.size(), "point"));
    file_.print("<clipPath id=\"view\"><rect x=\"{0}\" y=\"{0}\" width=\"{1}\" height=\"{2}\"/></clipPath>\n",
                unit(-kEdge), unit(drawing_.width() + 2 * kEdge), unit(drawing_.height() + 2 * kEdge));
    file_.print("<g clip-path=\"url(#view)\">\n");
    write_finished();
    for (std::size_t r = 0; r < partition_.regions.size(); ++r) write_region(r);
    if (points_.size() <= kMostDots) write_dots();
    file_.print("</g>\n");
    drawing_.end(caption());
  }

 private:
  std::int64_t unit(double pixels) const { return drawing_.unit(pixels); }

  void write_finished() {
    if (partition_.triangles.empty()) return;
    drawing_.begin_path("id=\"finished\" fill=\"#e6e4df\" stroke=\"#b9b6ae\" stroke-width=\"{}\"", unit(0.4));
    for (std::size_t t = 0; t + 2 < partition_.triangles.size(); t += 3) {
      polygon_.clear();
      for (std::size_t k = 0; k < 3; ++k) polygon_.push_back(drawing_.position(partition_.triangles[t + k]));
      drawing_.polygon(polygon_, kRoom, true);
    }
    drawing_.end_path();
  }

  void write_region(std::size_t r) {
    const research::Region& region = partition_.regions[r];
    drawing_.begin_path("id=\"region-{}\" fill=\"{}\" stroke=\"#24405f\" stroke-width=\"{}\"", r,
                        region_color(r, 0.55, 0.84), unit(0.8));
    for (const std::vector<std::int32_t>& walk : closed_walks(region.border)) {
      polygon_.clear();
      for (const std::int32_t vertex : walk) {
        polygon_.push_back(drawing_.position(region.points[static_cast<std::size_t>(vertex)]));
      }
      drawing_.polygon(polygon_, kRoom, true);
    }
    drawing_.end_path();
  }

  /// The points inside of regions, in the colours of the regions, and then all others.
  void write_dots() {
    const double size = std::clamp(120 / std::sqrt(static_cast<double>(points_.size()) + 1), 0.8, 5.0);
    std::vector<char> inside(points_.size(), 0);
    for (std::size_t r = 0; r < partition_.regions.size(); ++r) {
      const research::Region& region = partition_.regions[r];
      std::vector<char> on_border(region.points.size(), 0);
      for (const std::int32_t vertex : region.border) on_border[static_cast<std::size_t>(vertex)] = 1;
      drawing_.begin_path("stroke=\"{}\" stroke-width=\"{}\"", region_color(r, 0.6, 0.38), unit(size));
      for (std::size_t k = 0; k < region.points.size(); ++k) {
        if (on_border[k]) continue;
        inside[static_cast<std::size_t>(region.points[k])] = 1;
        drawing_.dot(drawing_.position(region.points[k]));
      }
      drawing_.end_path();
    }
    drawing_.begin_path("stroke=\"#24405f\" stroke-width=\"{}\"", unit(size));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!inside[i]) drawing_.dot(points_[i]);
    }
    drawing_.end_path();
  }

  std::string caption() const {
    std::string text =
        counted(points_.size(), "point") + " · " + counted(partition_.regions.size(), "region");
    const std::size_t finished = partition_.triangles.size() / 3;
    if (finished > 0) text += " · " + counted(finished, "finished triangle") + " (grey)";
    return text;
  }

  OutputFile& file_;
  Drawing drawing_;
  const std::vector<Position>& points_ = drawing_.positions();
  const research::Partition& partition_;
  std::vector<Position> polygon_;  // kept for its memory
};

}  // namespace

void write_partition_svg(Outputs& outputs, const std::string& path, const Points& points,
                         const research::Partition& partition) {
  PartitionPicture(outputs.open(path), points, partition).write();
}

}  // namespace flaunay::io
