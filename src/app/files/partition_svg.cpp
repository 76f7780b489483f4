// A picture of a partition's regions, one colour each.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/files/drawing.hpp"
#include "app/files/svg.hpp"
#include "files/output.hpp"

namespace flaunay::io {
namespace {

constexpr double kUnits = 10;  // whole-number coordinates per pixel
// Borders are drawn this far beyond the view, so that their lines cross its edge without a corner.
constexpr double kRoom = 50;
constexpr std::size_t kMostDots = 100'000;

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

std::string fill_color(std::size_t r) { return region_color(r, 0.55, 0.84); }
std::string dot_color(std::size_t r) { return region_color(r, 0.6, 0.38); }

std::int64_t unit(double pixels) { return std::llround(pixels * kUnits); }

/// A border as closed walks. Where it passes a point several times, any walk on is right: what lies inside is
/// what the edges wind around once, whatever their order.
std::vector<std::vector<std::int32_t>> closed_walks(const std::vector<std::int32_t>& border) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::size_t k = 0; k + 1 < border.size(); k += 2) edges.emplace_back(border[k], border[k + 1]);
  std::sort(edges.begin(), edges.end());
  std::vector<char> walked(edges.size(), 0);
  const auto edge_from = [&](std::int32_t vertex) {
    auto edge = std::lower_bound(edges.begin(), edges.end(), std::make_pair(vertex, std::int32_t{0}));
    while (edge != edges.end() && edge->first == vertex &&
           walked[static_cast<std::size_t>(edge - edges.begin())]) {
      ++edge;
    }
    return edge;
  };
  std::vector<std::vector<std::int32_t>> walks;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (walked[first]) continue;
    walks.emplace_back();
    auto edge = edges.begin() + static_cast<std::ptrdiff_t>(first);
    for (std::int32_t at = edge->first; edge != edges.end() && edge->first == at; edge = edge_from(at)) {
      walked[static_cast<std::size_t>(edge - edges.begin())] = 1;
      walks.back().push_back(at);
      at = edge->second;
    }
  }
  return walks;
}

class PartitionPicture {
 public:
  PartitionPicture(OutputFile& file, const Points& points, const research::Partition& partition)
      : file_(file), path_(file_), page_(points), partition_(partition) {}

  void write() {
    page_.open(file_, "Regions of " + counted(page_.positions().size(), "point"), kUnits);
    file_.print("<clipPath id=\"view\"><rect x=\"{0}\" y=\"{0}\" width=\"{1}\" height=\"{2}\"/></clipPath>\n",
                unit(-kEdge), unit(page_.width() + 2 * kEdge), unit(page_.height() + 2 * kEdge));
    file_.print("<g clip-path=\"url(#view)\">\n");
    write_finished();
    for (std::size_t r = 0; r < partition_.regions.size(); ++r) write_region(r);
    write_dots();
    file_.print("</g>\n");
    page_.close(file_, caption());
  }

 private:
  static constexpr double kEdge = 3;  // room for the width of lines on the view's boundary

  const Position& position(std::int32_t index) const {
    return page_.positions()[static_cast<std::size_t>(index)];
  }

  void write_polygon(std::vector<Position> polygon) {
    clip_polygon(polygon, kRoom, page_.width(), page_.height());
    if (polygon.empty()) return;
    path_.move_to(unit(polygon[0].x), unit(polygon[0].y));
    for (std::size_t k = 1; k < polygon.size(); ++k) path_.line_to(unit(polygon[k].x), unit(polygon[k].y));
    path_.close();
  }

  void write_finished() {
    if (partition_.triangles.empty()) return;
    file_.print("<path id=\"finished\" fill=\"#e6e4df\" stroke=\"#b9b6ae\" stroke-width=\"{}\" d=\"",
                unit(0.4));
    path_.restart();
    for (std::size_t t = 0; t + 2 < partition_.triangles.size(); t += 3) {
      const std::int32_t* corners = &partition_.triangles[t];
      write_polygon({position(corners[0]), position(corners[1]), position(corners[2])});
    }
    file_.print("\"/>\n");
  }

  void write_region(std::size_t r) {
    const research::Region& region = partition_.regions[r];
    file_.print("<path id=\"region-{}\" fill=\"{}\" stroke=\"#24405f\" stroke-width=\"{}\" d=\"", r,
                fill_color(r), unit(0.8));
    path_.restart();
    for (const std::vector<std::int32_t>& walk : closed_walks(region.border)) {
      std::vector<Position> polygon;
      for (const std::int32_t vertex : walk) {
        polygon.push_back(position(region.points[static_cast<std::size_t>(vertex)]));
      }
      write_polygon(std::move(polygon));
    }
    file_.print("\"/>\n");
  }

  /// The points inside of regions, in the colours of the regions. Omitted if there are too many to tell
  /// apart.
  void write_dots() {
    const std::size_t count = page_.positions().size();
    if (count > kMostDots) return;
    const double size = std::clamp(120 / std::sqrt(static_cast<double>(count) + 1), 0.8, 5.0);
    std::vector<char> inside(count, 0);
    for (std::size_t r = 0; r < partition_.regions.size(); ++r) {
      const research::Region& region = partition_.regions[r];
      std::vector<char> on_border(region.points.size(), 0);
      for (const std::int32_t vertex : region.border) on_border[static_cast<std::size_t>(vertex)] = 1;
      open_dots(dot_color(r), size);
      for (std::size_t k = 0; k < region.points.size(); ++k) {
        if (on_border[k]) continue;
        inside[static_cast<std::size_t>(region.points[k])] = 1;
        write_dot(position(region.points[k]));
      }
      file_.print("\"/>\n");
    }
    open_dots("#24405f", size);
    for (std::size_t i = 0; i < count; ++i) {
      if (!inside[i]) write_dot(page_.positions()[i]);
    }
    file_.print("\"/>\n");
  }

  void open_dots(const std::string& color, double size) {
    file_.print("<path stroke=\"{}\" stroke-width=\"{}\" d=\"", color, unit(size));
    path_.restart();
  }
  /// A line of no length with round ends is a dot.
  void write_dot(const Position& p) {
    if (!page_.contains(p)) return;
    path_.move_to(unit(p.x), unit(p.y));
    file_.print("h0");
  }

  std::string caption() const {
    std::string text =
        counted(page_.positions().size(), "point") + " · " + counted(partition_.regions.size(), "region");
    const std::size_t finished = partition_.triangles.size() / 3;
    if (finished > 0) text += " · " + counted(finished, "finished triangle") + " (grey)";
    return text;
  }

  OutputFile& file_;
  PathData path_;
  const Page page_;
  const research::Partition& partition_;
};

}  // namespace

void write_partition_svg(Outputs& outputs, const std::string& path, const Points& points,
                         const research::Partition& partition) {
  PartitionPicture(outputs.open(path), points, partition).write();
}

}  // namespace flaunay::io
