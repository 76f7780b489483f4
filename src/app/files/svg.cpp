// A picture of a triangulation.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/files/drawing.hpp"
#include "app/files/formats.hpp"
#include "files/output.hpp"
#include "mesh/corners.hpp"

namespace flaunay::io {
namespace {

constexpr int kShades = 24;
constexpr int kOutsideShade = kShades;
constexpr std::size_t kDotsUpTo = 1000;  // points of larger sets are not drawn, because edges show them
/// The number of triangles and edges that are measured if measuring all would take long.
constexpr std::size_t kSample = 100'000;
/// Trails per path element: viewers draw several short paths faster than a long one.
constexpr std::size_t kTrailsPerPath = 500;

/// From blue over sand to coral.
constexpr std::array<int, 6> kRamp = {0x6f9fc4, 0x93c4cb, 0xcbe2c9, 0xf7ecc2, 0xf6c89c, 0xe3938a};
/// Inside of constraints, which are orange: blues alone, so that everybody can tell them from the lines.
constexpr std::array<int, 3> kInsideRamp = {0x7fb0d8, 0xaed0e6, 0xdceaf3};

/// The colour of a shade from 0 to kShades - 1, in equal steps through the ramp.
std::string ramp_color(std::span<const int> ramp, int shade) {
  const double at = static_cast<double>(shade) / (kShades - 1) * static_cast<double>(ramp.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), ramp.size() - 2);
  std::string color = "#";
  for (const int shift : {16, 8, 0}) {
    const int from = ramp[low] >> shift & 0xff, to = ramp[low + 1] >> shift & 0xff;
    color += fmt::format("{:02x}", std::lround(from + (at - static_cast<double>(low)) * (to - from)));
  }
  return color;
}

class Picture {
 public:
  Picture(OutputFile& file, const MeshContents& contents)
      : contents_(contents), mesh_(contents.mesh), drawing_(file, contents.points) {}

  void write() {
    choose_units();
    const char* kind = is_constrained() ? "Constrained Delaunay" : "Delaunay";
    drawing_.begin(fmt::format("{} triangulation of {}", kind, counted(point_count(), "point")));
    write_triangles();
    if (!mesh_.triangles.empty()) write_edges();
    if (is_constrained()) {
      write_constraints();
    } else {
      write_hull();
    }
    if (point_count() <= kDotsUpTo) write_dots();
    drawing_.end(caption());
  }

 private:
  std::size_t point_count() const { return contents_.points.size(); }
  std::size_t added_count() const { return contents_.constraints().added_points.size() / 2; }
  bool is_constrained() const { return contents_.constrained != nullptr; }
  bool inside(std::int32_t v) const { return drawing_.contains(drawing_.position(v)); }
  std::array<Position, 3> corners(std::size_t t) const {
    const std::int32_t* const v = contents_.corners(t);
    return {drawing_.position(v[0]), drawing_.position(v[1]), drawing_.position(v[2])};
  }
  /// Chooses line widths and the resolution of coordinates by the length of the typical visible edge.
  void choose_units() {
    std::vector<double> lengths;
    for (std::size_t i = 0; i < mesh_.triangles.size(); i += mesh_.triangles.size() / kSample + 1) {
      const std::int32_t v = mesh_.triangles[i], w = mesh_.triangles[mesh::next_corner(i)];
      if (!inside(v) || !inside(w)) continue;
      const Position &p = drawing_.position(v), &q = drawing_.position(w);
      lengths.push_back(std::hypot(p.x - q.x, p.y - q.y));
    }
    typical_edge_ = lengths.empty() ? kCanvas / 10 : quantile(lengths, 0.5);
    units_ = std::clamp(std::ceil(30 / std::max(typical_edge_, 0.1)), 5.0, 40.0);
    drawing_.set_units(units_);
    line_width_ = std::clamp(0.06 * typical_edge_, 0.18, 1.4);
  }

  /// Writes one path element per shade of the triangles' colours.
  void write_triangles() {
    measure_areas();
    const double tile = std::max(8 * typical_edge_, 4.0);
    // Shade, then tile by tile, so that relative coordinates are short; and the triangle.
    std::vector<std::pair<std::uint64_t, std::size_t>> shaded;
    for (std::size_t t = 0; t < contents_.triangle_count(); ++t) {
      if (!visible(t)) continue;
      Position center{0, 0};
      for (const Position& p : corners(t)) {
        center.x += std::clamp(p.x, 0.0, drawing_.width()) / 3;
        center.y += std::clamp(p.y, 0.0, drawing_.height()) / 3;
      }
      const auto shade = static_cast<std::uint64_t>(is_inside(t) ? choose_shade(center, t) : kOutsideShade);
      const auto row = static_cast<std::uint64_t>(center.y / tile);
      auto column = static_cast<std::uint64_t>(center.x / tile);
      if (row % 2) column = 0xffff - column;  // every other row from right to left
      shaded.emplace_back(shade << 32 | row << 16 | column, t);
    }
    std::sort(shaded.begin(), shaded.end());
    std::vector<Position> polygon;
    for (auto at = shaded.begin(); at != shaded.end();) {
      const auto shade = static_cast<int>(at->first >> 32);
      drawing_.begin_path("fill=\"{}\"", color(shade));
      for (; at != shaded.end() && static_cast<int>(at->first >> 32) == shade; ++at) {
        const std::array<Position, 3> triangle = corners(at->second);
        polygon.assign(triangle.begin(), triangle.end());
        drawing_.polygon(polygon, 0, false);
      }
      drawing_.end_path();
    }
  }

  /// Whether a triangle is inside, as far as that is known.
  bool is_inside(std::size_t t) const {
    if (contents_.constraints().depths.empty()) return true;
    const std::int32_t depth = contents_.constraints().depths[t];
    return contents_.fill_rule == FillRule::nesting ? depth % 2 == 1 : depth != 0;
  }
  std::string color(int shade) const {
    if (shade == kOutsideShade) return "#eeece6";
    return is_constrained() ? ramp_color(kInsideRamp, shade) : ramp_color(kRamp, shade);
  }

  /// Whether the bounding box meets the view.
  bool visible(std::size_t t) const {
    const auto [a, b, c] = corners(t);
    return std::max({a.x, b.x, c.x}) >= 0 && std::min({a.x, b.x, c.x}) <= drawing_.width() &&
           std::max({a.y, b.y, c.y}) >= 0 && std::min({a.y, b.y, c.y}) <= drawing_.height();
  }
  double log_area(std::size_t t) const {
    const auto [a, b, c] = corners(t);
    const double area = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    return std::log2(std::clamp(area, 1e-9, 1e12));
  }
  void measure_areas() {
    std::vector<double> logs;
    for (std::size_t t = 0; t < contents_.triangle_count(); t += contents_.triangle_count() / kSample + 1) {
      if (visible(t)) logs.push_back(log_area(t));
    }
    if (logs.empty()) return;
    middle_area_ = quantile(logs, 0.5);
    const double low = quantile(logs, 0.1), high = quantile(logs, 0.9);
    spread_of_areas_ = std::max(1.0, high - low);
  }
  /// The shade depends on the place, so that even a grid has a gradient, and on the size, so that neighbours
  /// differ.
  int choose_shade(const Position& center, std::size_t t) const {
    const double size = std::clamp((log_area(t) - middle_area_) / spread_of_areas_, -0.7, 0.7);
    const double x = center.x / std::max(drawing_.width(), 1.0),
                 y = center.y / std::max(drawing_.height(), 1.0);
    const double value = 0.5 + 0.75 * ((x + 1 - y) / 2 - 0.5) + 0.5 * size;
    return static_cast<int>(std::clamp(value, 0.0, 1.0) * (kShades - 1) + 0.5);
  }

  /// width: in pixels
  void begin_stroke(const std::string& name, const char* color, double width) {
    drawing_.begin_path("id=\"{}\" stroke=\"{}\" stroke-width=\"{:.3g}\"", name, color, width * units_);
  }
  void begin_edges(const std::string& name) {
    begin_stroke(name, is_constrained() ? "#6d8299" : "#4a5d73", line_width_);
  }

  /// Whether the edge from corner i to the next one is to be drawn here: of the two triangles at an inner
  /// edge, one has it from its smaller index to its larger. Others are at the border, which has a path of its
  /// own without constraints: the hull.
  bool is_drawn(std::size_t i) const {
    const bool is_border =
        is_constrained() && !mesh_.neighbors.empty() && mesh_.neighbors[i % 3 == 0 ? i + 2 : i - 1] < 0;
    return is_border || mesh_.triangles[i] < mesh_.triangles[mesh::next_corner(i)];
  }

  /// Every edge once. Edges inside the view are joined to long trails, which takes half the characters of
  /// single segments.
  void write_edges() {
    std::vector<std::array<std::int32_t, 2>> edges;
    std::vector<std::size_t> begin(point_count() + 1, 0);  // of each point's edges in `around`
    begin_edges("edges");
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const std::int32_t v = mesh_.triangles[i], w = mesh_.triangles[mesh::next_corner(i)];
      if (!is_drawn(i)) continue;
      if (!inside(v) || !inside(w)) {
        drawing_.edge(v, w);
      } else if (!drawing_.is_same(drawing_.position(v), drawing_.position(w))) {
        edges.push_back({v, w});
        ++begin[static_cast<std::size_t>(v) + 1];
        ++begin[static_cast<std::size_t>(w) + 1];
      }
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::size_t> at(begin.begin(), begin.end() - 1), around(2 * edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (const std::int32_t v : edges[e]) around[at[static_cast<std::size_t>(v)]++] = e;
    }
    at.assign(begin.begin(), begin.end() - 1);
    std::vector<bool> drawn(edges.size(), false);
    // The next edge at v that is not drawn yet; none at the end of v's list.
    const auto has_edge = [&](std::size_t v) {
      while (at[v] != begin[v + 1] && drawn[around[at[v]]]) ++at[v];
      return at[v] != begin[v + 1];
    };
    std::size_t trails = 0;
    for (std::size_t v = 0; v < point_count(); ++v) {
      while (has_edge(v)) {
        if (++trails % kTrailsPerPath == 0) {
          drawing_.end_path();
          begin_edges(fmt::format("edges-{}", trails / kTrailsPerPath));
        }
        drawing_.move_to(drawing_.positions()[v]);
        for (std::size_t from = v; has_edge(from);) {
          const std::size_t e = around[at[from]];
          drawn[e] = true;
          from = static_cast<std::size_t>(edges[e][0]) + static_cast<std::size_t>(edges[e][1]) - from;
          drawing_.line_to(drawing_.positions()[from]);
        }
      }
    }
    drawing_.end_path();
  }

  /// The hull of each set. Hulls of collinear points are closed, too: they return along the same line.
  void write_hull() {
    if (mesh_.hull.empty()) return;
    begin_stroke("hull", "#24405f", std::clamp(2.5 * line_width_, 1.0, 2.6));
    std::vector<std::size_t> offsets(mesh_.hull_offsets.begin(), mesh_.hull_offsets.end());
    if (offsets.size() < 2) offsets = {0, mesh_.hull.size()};
    for (std::size_t set = 0; set + 1 < offsets.size(); ++set) {
      for (std::size_t i = offsets[set]; i < offsets[set + 1]; ++i) {
        drawing_.edge(mesh_.hull[i], mesh_.hull[i + 1 < offsets[set + 1] ? i + 1 : offsets[set]]);
      }
    }
    drawing_.end_path();
  }

  void write_constraints() {
    begin_stroke("constraints", "#c84c09", std::clamp(2.8 * line_width_, 1.2, 3.0));
    const std::vector<std::int32_t>& edges = contents_.constraints().constraint_edges;
    for (std::size_t e = 0; e < edges.size(); e += 2) drawing_.edge(edges[e], edges[e + 1]);
    drawing_.end_path();
  }

  void write_dots() {
    const double size = std::clamp(0.14 * typical_edge_, 2.0, 7.0);
    const auto write = [&](const char* name, const char* color, double width, std::size_t begin) {
      begin_stroke(name, color, width);
      for (std::size_t i = begin; i < point_count(); ++i) drawing_.dot(drawing_.positions()[i]);
      drawing_.end_path();
    };
    write("points", "#24405f", size, 0);
    if (added_count() > 0) write("added", "#ffffff", 0.6 * size, point_count() - added_count());
  }

  std::string caption() const {
    std::string text =
        counted(point_count(), "point") + " · " + counted(contents_.triangle_count(), "triangle");
    if (!is_constrained()) {
      text += " · " + with_thousands(mesh_.hull.size()) + " on the hull";
    } else {
      text += " · " + counted(contents_.constraints().constraint_edges.size() / 2, "constraint edge");
      if (added_count() > 0) text += " · " + counted(added_count(), "point") + " added";
    }
    std::size_t duplicates = 0;
    for (std::size_t i = 0; i < mesh_.representatives.size(); ++i) {
      duplicates += mesh_.representatives[i] != static_cast<std::int32_t>(i);
    }
    return duplicates > 0 ? text + " · " + counted(duplicates, "duplicate") : text;
  }

  const MeshContents& contents_;
  const Triangulation& mesh_;
  Drawing drawing_;
  double typical_edge_ = 0, line_width_ = 1;      // pixels
  double units_ = 1;                              // whole-number coordinates per pixel
  double middle_area_ = 0, spread_of_areas_ = 1;  // of their logarithms
};

void write_svg(OutputFile& file, const MeshContents& contents) { Picture(file, contents).write(); }

}  // namespace

const Format kSvg = {.ending = ".svg", .write_mesh = write_svg, .has_labels = true};

}  // namespace flaunay::io
