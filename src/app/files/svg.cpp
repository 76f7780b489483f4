#include "app/files/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string_view>
#include <vector>

#include "app/files/drawing.hpp"
#include "files/output.hpp"

namespace flaunay::io {
namespace {

constexpr int kShades = 24;
constexpr std::size_t kDotsUpTo = 1000;  // points of larger sets are not drawn, because edges show them

/// Colours from shade 0 to shade kShades - 1, in equal steps.
template <std::size_t count>
using Ramp = std::array<std::array<double, 3>, count>;
/// From blue over sand to coral.
constexpr Ramp<6> kRamp = {{{0x6f, 0x9f, 0xc4},
                            {0x93, 0xc4, 0xcb},
                            {0xcb, 0xe2, 0xc9},
                            {0xf7, 0xec, 0xc2},
                            {0xf6, 0xc8, 0x9c},
                            {0xe3, 0x93, 0x8a}}};
/// Inside of constraints, which are orange: blues alone, so that everybody can tell them from the lines.
constexpr Ramp<3> kInsideRamp = {{{0x7f, 0xb0, 0xd8}, {0xae, 0xd0, 0xe6}, {0xdc, 0xea, 0xf3}}};
constexpr const char* kEdgeColor = "#4a5d73";
constexpr const char* kInnerEdgeColor = "#6d8299";
constexpr const char* kConstraintColor = "#c84c09";
constexpr const char* kOutsideColor = "#eeece6";
constexpr int kOutsideShade = kShades;

template <std::size_t count>
std::string ramp_color(const Ramp<count>& ramp, int shade) {
  const double at = static_cast<double>(shade) / (kShades - 1) * (count - 1);
  const auto low = std::min(static_cast<std::size_t>(at), count - 2);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = ramp[low][c] + (at - static_cast<double>(low)) * (ramp[low + 1][c] - ramp[low][c]);
    rgb[c] = static_cast<int>(std::lround(value));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

class Picture {
 public:
  /// constraints: the same mesh if it has some, otherwise null.
  Picture(OutputFile& file, const Points& points, const Triangulation& mesh,
          const ConstrainedTriangulation* constraints = nullptr, FillRule fill_rule = FillRule::nesting)
      : file_(file),
        path_(file_),
        points_(points),
        mesh_(mesh),
        constraints_(constraints),
        fill_rule_(fill_rule),
        page_(points) {
    choose_units();
  }

  void write() {
    const char* kind = constraints_ == nullptr ? "Delaunay" : "Constrained Delaunay";
    page_.open(file_, fmt::format("{} triangulation of {}", kind, counted(point_count(), "point")), units_);
    write_triangles();
    write_edges();
    if (constraints_ == nullptr) {
      write_hull();
    } else {
      write_constraints();
    }
    write_dots();
    page_.close(file_, caption());
  }

 private:
  std::size_t triangle_count() const { return mesh_.triangles.size() / 3; }
  std::size_t point_count() const { return points_.size(); }

  bool inside(std::int32_t v) const { return page_.contains(position(v)); }
  const Position& position(std::int32_t v) const { return positions_[static_cast<std::size_t>(v)]; }

  /// Chooses line widths and the resolution of coordinates by the length of the typical visible edge.
  void choose_units() {
    constexpr std::size_t kSample = 100'000;
    std::vector<double> lengths;
    const std::size_t stride = mesh_.triangles.size() / kSample + 1;
    for (std::size_t i = 0; i < mesh_.triangles.size(); i += stride) {
      const std::int32_t v = mesh_.triangles[i], w = mesh_.triangles[i % 3 == 2 ? i - 2 : i + 1];
      if (inside(v) && inside(w)) {
        lengths.push_back(std::hypot(position(v).x - position(w).x, position(v).y - position(w).y));
      }
    }
    typical_edge_ = lengths.empty() ? kCanvas / 10 : quantile(lengths, 0.5);
    units_ = std::clamp(std::ceil(30 / std::max(typical_edge_, 0.1)), 5.0, 40.0);
    line_width_ = std::clamp(0.06 * typical_edge_, 0.18, 1.4);
  }

  std::int64_t unit(double pixels) const { return std::llround(pixels * units_); }

  /// Writes one path element per shade of the triangles' colours.
  void write_triangles() {
    struct Shaded {
      std::uint64_t order;  // shade, then tile by tile, so that relative coordinates are short
      std::size_t triangle;
    };
    const double tile = std::max(8 * typical_edge_, 4.0);
    std::vector<Shaded> shaded;
    shaded.reserve(triangle_count());
    const Areas areas = measure_areas();
    for (std::size_t t = 0; t < triangle_count(); ++t) {
      if (!visible(t)) continue;
      const Position center = clamped_center(t);
      const int shade = is_inside(t) ? choose_shade(center, area(t), areas) : kOutsideShade;
      const auto row = static_cast<std::uint64_t>(center.y / tile);
      auto column = static_cast<std::uint64_t>(center.x / tile);
      if (row % 2) column = 0xffff - column;  // every other row from right to left
      shaded.push_back({(static_cast<std::uint64_t>(shade) << 32) | (row << 16) | column, t});
    }
    std::sort(shaded.begin(), shaded.end(), [](const Shaded& a, const Shaded& b) {
      return a.order != b.order ? a.order < b.order : a.triangle < b.triangle;
    });
    for (std::size_t begin = 0; begin < shaded.size();) {
      const std::uint64_t shade = shaded[begin].order >> 32;
      file_.print("<path fill=\"{}\" d=\"", color(static_cast<int>(shade)));
      path_.restart();
      for (; begin < shaded.size() && shaded[begin].order >> 32 == shade; ++begin) {
        write_triangle(shaded[begin].triangle);
      }
      file_.print("\"/>\n");
    }
  }

  /// Whether a triangle is inside, as far as that is known.
  bool is_inside(std::size_t t) const {
    if (constraints_ == nullptr || constraints_->depths.empty()) return true;
    const std::int32_t depth = constraints_->depths[t];
    return fill_rule_ == FillRule::nesting ? depth % 2 == 1 : depth != 0;
  }
  std::string color(int shade) const {
    if (shade == kOutsideShade) return kOutsideColor;
    return constraints_ == nullptr ? ramp_color(kRamp, shade) : ramp_color(kInsideRamp, shade);
  }

  struct Areas {
    double middle = 0;  // of the logarithms
    double spread = 1;
  };
  double area(std::size_t t) const {
    const Position &a = position(mesh_.triangles[3 * t]), &b = position(mesh_.triangles[3 * t + 1]),
                   &c = position(mesh_.triangles[3 * t + 2]);
    return std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  static double log_area(double area) { return std::log2(std::clamp(area, 1e-9, 1e12)); }
  Areas measure_areas() const {
    constexpr std::size_t kSample = 100'000;
    std::vector<double> logs;
    for (std::size_t t = 0; t < triangle_count(); t += triangle_count() / kSample + 1) {
      if (visible(t)) logs.push_back(log_area(area(t)));
    }
    if (logs.empty()) return {};
    const double middle = quantile(logs, 0.5);
    const double low = quantile(logs, 0.1), high = quantile(logs, 0.9);
    return {middle, std::max(1.0, high - low)};
  }
  /// The shade depends on the place, so that even a grid has a gradient, and on the size, so that neighbours
  /// differ.
  int choose_shade(const Position& center, double triangle_area, const Areas& areas) const {
    const double size = std::clamp((log_area(triangle_area) - areas.middle) / areas.spread, -0.7, 0.7);
    const double place = (center.x / std::max(width_, 1.0) + 1 - center.y / std::max(height_, 1.0)) / 2;
    const double value = 0.5 + 0.75 * (place - 0.5) + 0.5 * size;
    return static_cast<int>(std::clamp(value, 0.0, 1.0) * (kShades - 1) + 0.5);
  }

  /// Whether the bounding box meets the view.
  bool visible(std::size_t t) const {
    const Position &a = position(mesh_.triangles[3 * t]), &b = position(mesh_.triangles[3 * t + 1]),
                   &c = position(mesh_.triangles[3 * t + 2]);
    return std::max({a.x, b.x, c.x}) >= 0 && std::min({a.x, b.x, c.x}) <= width_ &&
           std::max({a.y, b.y, c.y}) >= 0 && std::min({a.y, b.y, c.y}) <= height_;
  }
  Position clamped_center(std::size_t t) const {
    Position center{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const Position& p = position(mesh_.triangles[3 * t + k]);
      center.x += std::clamp(p.x, 0.0, width_) / 3;
      center.y += std::clamp(p.y, 0.0, height_) / 3;
    }
    return center;
  }

  /// Writes the part of the triangle that is inside the view, unless it has no area at the picture's
  /// resolution.
  void write_triangle(std::size_t t) {
    std::vector<Position>& polygon = polygon_;
    polygon.clear();
    bool clipped = false;
    for (std::size_t k = 0; k < 3; ++k) {
      polygon.push_back(position(mesh_.triangles[3 * t + k]));
      clipped = clipped || !page_.contains(polygon.back());
    }
    if (clipped) clip_polygon(polygon, 0, width_, height_);
    std::int64_t doubled_area = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Position &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      doubled_area += unit(p.x) * unit(q.y) - unit(p.y) * unit(q.x);
    }
    if (doubled_area == 0) return;
    path_.move_to(unit(polygon[0].x), unit(polygon[0].y));
    for (std::size_t k = 1; k < polygon.size(); ++k) path_.line_to(unit(polygon[k].x), unit(polygon[k].y));
    path_.close();
  }

  /// The part of an edge inside the view (Liang and Barsky); false if there is none.
  bool clip_edge(Position& p, Position& q) const {
    double begin = 0, end = 1;
    const double dx = q.x - p.x, dy = q.y - p.y;
    const double steps[4] = {-dx, dx, -dy, dy};
    const double room[4] = {p.x, width_ - p.x, p.y, height_ - p.y};
    for (int side = 0; side < 4; ++side) {
      if (steps[side] == 0) {
        if (room[side] < 0) return false;
      } else if (steps[side] < 0) {
        begin = std::max(begin, room[side] / steps[side]);
      } else {
        end = std::min(end, room[side] / steps[side]);
      }
    }
    if (begin > end) return false;
    const Position start = p;
    p = {start.x + begin * dx, start.y + begin * dy};
    q = {start.x + end * dx, start.y + end * dy};
    return true;
  }

  void write_segment(std::int32_t v, std::int32_t w) {
    Position p = position(v), q = position(w);
    if (!clip_edge(p, q)) return;
    if (unit(p.x) == unit(q.x) && unit(p.y) == unit(q.y)) return;  // too short to show
    path_.move_to(unit(p.x), unit(p.y));
    path_.line_to(unit(q.x), unit(q.y));
  }

  void open_stroke(const char* name, std::string_view color, double pixels) {
    file_.print("<path id=\"{}\" stroke=\"{}\" stroke-width=\"{:.3g}\" d=\"", name, color, pixels * units_);
    path_.restart();
  }

  /// Whether the edge from corner i is at the border of a mesh whose hull is not drawn, and from its larger
  /// index to its smaller.
  bool is_border(std::size_t i) const {
    return constraints_ != nullptr && !mesh_.neighbors.empty() &&
           mesh_.neighbors[i % 3 == 0 ? i + 2 : i - 1] < 0;
  }

  /// Every edge once: of the two triangles at an inner edge, one has it from its smaller index to its larger.
  /// Without constraints, the hull's other edges are in the hull's own path. Edges inside the view are joined
  /// to long trails, which takes half the characters of single segments.
  void write_edges() {
    if (mesh_.triangles.empty()) return;
    const char* color = constraints_ == nullptr ? kEdgeColor : kInnerEdgeColor;
    struct Neighbor {
      std::int32_t vertex;
      std::uint32_t edge;
    };
    std::vector<std::size_t> begin(point_count() + 1, 0);
    std::size_t joined = 0;
    const auto for_each_edge = [&](auto&& visit) {
      for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const std::int32_t v = mesh_.triangles[i], w = mesh_.triangles[i % 3 == 2 ? i - 2 : i + 1];
        if (v < w || is_border(i)) visit(v, w);
      }
    };
    const auto shown_whole = [&](std::int32_t v, std::int32_t w) {
      const Position &p = position(v), &q = position(w);
      return inside(v) && inside(w) && (unit(p.x) != unit(q.x) || unit(p.y) != unit(q.y));
    };
    open_stroke("edges", color, line_width_);
    for_each_edge([&](std::int32_t v, std::int32_t w) {
      if (shown_whole(v, w)) {
        ++begin[static_cast<std::size_t>(v) + 1];
        ++begin[static_cast<std::size_t>(w) + 1];
        ++joined;
      } else if (!inside(v) || !inside(w)) {
        write_segment(v, w);
      }
    });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Neighbor> neighbors(2 * joined);
    std::vector<std::size_t> at(begin.begin(), begin.end() - 1);
    std::uint32_t edge = 0;
    for_each_edge([&](std::int32_t v, std::int32_t w) {
      if (!shown_whole(v, w)) return;
      neighbors[at[static_cast<std::size_t>(v)]++] = {w, edge};
      neighbors[at[static_cast<std::size_t>(w)]++] = {v, edge};
      ++edge;
    });

    at.assign(begin.begin(), begin.end() - 1);
    std::vector<bool> drawn(joined, false);
    // The next edge at v that is not drawn yet; none at the end of v's list.
    const auto next_edge = [&](std::size_t v) {
      while (at[v] != begin[v + 1] && drawn[neighbors[at[v]].edge]) ++at[v];
      return at[v] != begin[v + 1];
    };
    for (std::size_t v = 0; v < point_count(); ++v) {
      while (next_edge(v)) {
        if (++trails_ % kTrailsPerPath == 0) {
          file_.print("\"/>\n");
          open_stroke(fmt::format("edges-{}", trails_ / kTrailsPerPath).c_str(), color, line_width_);
        }
        path_.move_to(unit(positions_[v].x), unit(positions_[v].y));
        for (std::size_t from = v; next_edge(from);) {
          const Neighbor& next = neighbors[at[from]];
          drawn[next.edge] = true;
          path_.line_to(unit(position(next.vertex).x), unit(position(next.vertex).y));
          from = static_cast<std::size_t>(next.vertex);
        }
      }
    }
    file_.print("\"/>\n");
  }

  void write_hull() {
    if (mesh_.hull.empty()) return;
    open_stroke("hull", "#24405f", std::clamp(2.5 * line_width_, 1.0, 2.6));
    for (std::size_t set = 0; set + 1 < mesh_.hull_offsets.size() || set == 0; ++set) {
      const bool whole = mesh_.hull_offsets.size() < 2;
      const std::size_t begin = whole ? 0 : mesh_.hull_offsets[set];
      const std::size_t end = whole ? mesh_.hull.size() : mesh_.hull_offsets[set + 1];
      // The hull of collinear points is closed too: it goes back along the same line.
      for (std::size_t i = begin; i < end; ++i)
        write_segment(mesh_.hull[i], mesh_.hull[i + 1 < end ? i + 1 : begin]);
    }
    file_.print("\"/>\n");
  }

  void write_constraints() {
    open_stroke("constraints", kConstraintColor, std::clamp(2.8 * line_width_, 1.2, 3.0));
    const std::vector<std::int32_t>& edges = constraints_->constraint_edges;
    for (std::size_t e = 0; e < edges.size(); e += 2) write_segment(edges[e], edges[e + 1]);
    file_.print("\"/>\n");
  }

  void write_dots() {
    if (point_count() > kDotsUpTo) return;
    const double size = std::clamp(0.14 * typical_edge_, 2.0, 7.0);
    const std::size_t added = constraints_ == nullptr ? 0 : constraints_->added_points.size() / 2;
    write_dots("points", "#24405f", size, 0, point_count());
    if (added > 0) write_dots("added", "#ffffff", 0.6 * size, point_count() - added, point_count());
  }
  void write_dots(const char* name, std::string_view color, double size, std::size_t begin, std::size_t end) {
    // A line of no length with round ends is a dot.
    open_stroke(name, color, size);
    for (std::size_t i = begin; i < end; ++i) {
      if (!page_.contains(positions_[i])) continue;
      path_.move_to(unit(positions_[i].x), unit(positions_[i].y));
      file_.print("h0");
    }
    file_.print("\"/>\n");
  }

  std::string caption() const {
    std::string text = counted(point_count(), "point") + " · " + counted(triangle_count(), "triangle");
    if (constraints_ == nullptr) {
      text += " · " + with_thousands(mesh_.hull.size()) + " on the hull";
    } else {
      text += " · " + counted(constraints_->constraint_edges.size() / 2, "constraint edge");
      const std::size_t added = constraints_->added_points.size() / 2;
      if (added > 0) text += " · " + counted(added, "point") + " added where segments cross";
    }
    std::size_t duplicates = 0;
    for (std::size_t i = 0; i < mesh_.representatives.size(); ++i) {
      duplicates += mesh_.representatives[i] != static_cast<std::int32_t>(i);
    }
    if (duplicates > 0) text += " · " + counted(duplicates, "duplicate");
    return text;
  }

  /// Trails per path element: viewers draw several short paths faster than a long one.
  static constexpr std::size_t kTrailsPerPath = 500;

  OutputFile& file_;
  PathData path_;
  const Points& points_;
  const Triangulation& mesh_;
  const ConstrainedTriangulation* constraints_;
  const FillRule fill_rule_;
  const Page page_;
  const std::vector<Position>& positions_ = page_.positions();
  const double width_ = page_.width(), height_ = page_.height();
  double typical_edge_ = 0;  // pixels
  double units_ = 1;         // whole-number coordinates per pixel
  double line_width_ = 1;    // pixels
  std::size_t trails_ = 0;
  std::vector<Position> polygon_;  // of write_triangle, kept for its memory
};

}  // namespace

void write_svg(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  Picture(outputs.open(path), contents.points, contents.mesh, contents.constrained, contents.fill_rule)
      .write();
}

}  // namespace flaunay::io
