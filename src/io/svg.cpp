#include "io/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string_view>
#include <vector>

#include "io/file.hpp"

namespace flaunay::io {
namespace {

constexpr double kCanvas = 1000;    // pixels of the picture's longer side
constexpr double kLeastSide = 560;  // room for the caption
constexpr double kMargin = 24;
constexpr double kCaption = 40;
constexpr int kShades = 24;
constexpr std::size_t kDotsUpTo = 1000;  // points of a larger set are where the edges meet

struct Position {
  double x, y;
};

/// The value below which `share` of the values lie. Reorders them.
double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

/// The part of the plane that is shown, in the points' coordinates. Long double, because the extent of
/// doubles may be beyond the largest double.
struct View {
  long double left = 0, right = 1, bottom = 0, top = 1;
  bool central = false;      // only the central part of the points
  double magnification = 1;  // how much larger the whole extent is
  std::size_t shown = 0;     // points inside

  bool contains(double x, double y) const { return left <= x && x <= right && bottom <= y && y <= top; }
};

/// The whole extent, unless a few far points would shrink the rest to a speck: then the square around the
/// medians that holds most of the points.
View choose_view(const Points& points) {
  constexpr double kShare = 0.8, kRoom = 1.1, kOutliersFrom = 3.5;
  View view;
  const std::size_t n = points.size();
  view.shown = n;
  if (n == 0) return view;
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = points.coordinates[2 * i];
    y[i] = points.coordinates[2 * i + 1];
  }
  const auto [left, right] = std::minmax_element(x.begin(), x.end());
  const auto [bottom, top] = std::minmax_element(y.begin(), y.end());
  view.left = *left, view.right = *right, view.bottom = *bottom, view.top = *top;

  const double middle_x = quantile(x, 0.5), middle_y = quantile(y, 0.5);
  std::vector<double> distance(n);
  for (std::size_t i = 0; i < n; ++i) {
    distance[i] = std::max(std::fabs(points.coordinates[2 * i] - middle_x),
                           std::fabs(points.coordinates[2 * i + 1] - middle_y));
  }
  const long double reach = static_cast<long double>(kRoom) * quantile(distance, kShare);
  const long double extent = std::max(view.right - view.left, view.top - view.bottom);
  if (n >= 10 && reach > 0 && extent > kOutliersFrom * 2 * reach) {
    view.left = std::max(view.left, middle_x - reach);
    view.right = std::min(view.right, middle_x + reach);
    view.bottom = std::max(view.bottom, middle_y - reach);
    view.top = std::min(view.top, middle_y + reach);
    view.central = true;
    view.magnification =
        static_cast<double>(extent / std::max(view.right - view.left, view.top - view.bottom));
    view.shown = 0;
    for (std::size_t i = 0; i < n; ++i) {
      view.shown += view.contains(points.coordinates[2 * i], points.coordinates[2 * i + 1]);
    }
  }
  return view;
}

/// Soft blue by way of sand to coral, shade 0 to kShades - 1.
std::string shade_color(int shade) {
  constexpr std::array<std::array<double, 3>, 6> kRamp = {{{0x6f, 0x9f, 0xc4},
                                                           {0x93, 0xc4, 0xcb},
                                                           {0xcb, 0xe2, 0xc9},
                                                           {0xf7, 0xec, 0xc2},
                                                           {0xf6, 0xc8, 0x9c},
                                                           {0xe3, 0x93, 0x8a}}};
  const double at = static_cast<double>(shade) / (kShades - 1) * (kRamp.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double value =
        kRamp[low][c] + (at - static_cast<double>(low)) * (kRamp[low + 1][c] - kRamp[low][c]);
    rgb[c] = static_cast<int>(std::lround(value));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

std::string with_thousands(std::size_t number) {
  std::string digits = std::to_string(number);
  for (auto i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3) {
    digits.insert(static_cast<std::size_t>(i), 1, ',');
  }
  return digits;
}

/// "1 point", "2,000 points".
std::string counted(std::size_t number, const std::string& what) {
  return with_thousands(number) + " " + what + (number == 1 ? "" : "s");
}

/// Path data of whole numbers, each relative to where the pen is.
class PathData {
 public:
  explicit PathData(OutputFile& file) : file_(file) {}

  void move_to(std::int64_t x, std::int64_t y) {
    file_.print("m");
    first_ = true;
    step(x, y);
    start_x_ = x, start_y_ = y;
  }
  /// Follows a move_to or another line_to: SVG needs no letter then.
  void line_to(std::int64_t x, std::int64_t y) { step(x, y); }
  void close() {
    file_.print("z");
    x_ = start_x_, y_ = start_y_;
  }
  /// The next path element starts from (0, 0) again.
  void restart() { x_ = y_ = 0; }

 private:
  void step(std::int64_t x, std::int64_t y) {
    number(x - x_);
    number(y - y_);
    x_ = x, y_ = y;
  }
  void number(std::int64_t value) {
    file_.print("{}{}", value < 0 || first_ ? "" : " ", value);
    first_ = false;
  }

  OutputFile& file_;
  std::int64_t x_ = 0, y_ = 0, start_x_ = 0, start_y_ = 0;
  bool first_ = true;
};

class Picture {
 public:
  Picture(const std::string& path, const Points& points, const Triangulation& mesh)
      : file_(path), path_(file_), points_(points), mesh_(mesh), view_(choose_view(points)) {
    place();
    choose_units();
  }

  void write() {
    write_head();
    write_triangles();
    write_edges();
    write_hull();
    write_dots();
    file_.print("</g>\n");
    write_caption();
    file_.print("</svg>\n");
    file_.commit();
  }

 private:
  std::size_t triangle_count() const { return mesh_.triangles.size() / 3; }
  std::size_t point_count() const { return points_.size(); }

  /// Where the points lie, in pixels from the view's upper left corner; y down.
  void place() {
    const long double width = view_.right - view_.left, height = view_.top - view_.bottom;
    const long double extent = std::max(width, height);
    const long double scale = extent > 0 ? kCanvas / extent : 1;
    width_ = static_cast<double>(width * scale);
    height_ = static_cast<double>(height * scale);
    positions_.resize(point_count());
    for (std::size_t i = 0; i < point_count(); ++i) {
      positions_[i] = {static_cast<double>((points_.coordinates[2 * i] - view_.left) * scale),
                       static_cast<double>((view_.top - points_.coordinates[2 * i + 1]) * scale)};
    }
  }

  bool inside(const Position& p) const { return p.x >= 0 && p.x <= width_ && p.y >= 0 && p.y <= height_; }
  bool inside(std::int32_t v) const { return inside(positions_[static_cast<std::size_t>(v)]); }
  const Position& position(std::int32_t v) const { return positions_[static_cast<std::size_t>(v)]; }

  /// The typical visible edge decides line widths and how fine the whole-number coordinates are.
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

  void write_head() {
    const double page_width = std::max(width_, kLeastSide) + 2 * kMargin;
    const double page_height = std::max(height_, 40.0) + 2 * kMargin + kCaption;
    const double shift_x = (page_width - width_) / 2;
    const double shift_y = (page_height - kCaption - height_) / 2;
    caption_y_ = page_height - kMargin;
    file_.print(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
        "{0:.0f} "
        "{1:.0f}\">\n<title>Delaunay triangulation of {2}</title>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#fdfcf9\"/>\n",
        page_width, page_height, counted(point_count(), "point"));
    file_.print(
        "<g transform=\"translate({:.2f} {:.2f}) scale({:.6g})\" fill=\"none\" stroke-linejoin=\"round\" "
        "stroke-linecap=\"round\">\n",
        shift_x, shift_y, 1 / units_);
  }

  /// One path element for each shade of the triangles' colours.
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
      const int shade = choose_shade(center, area(t), areas);
      const auto row = static_cast<std::uint64_t>(center.y / tile);
      auto column = static_cast<std::uint64_t>(center.x / tile);
      if (row % 2) column = 0xffff - column;  // there and back again
      shaded.push_back({(static_cast<std::uint64_t>(shade) << 32) | (row << 16) | column, t});
    }
    std::sort(shaded.begin(), shaded.end(), [](const Shaded& a, const Shaded& b) {
      return a.order != b.order ? a.order < b.order : a.triangle < b.triangle;
    });
    for (std::size_t begin = 0; begin < shaded.size();) {
      const std::uint64_t shade = shaded[begin].order >> 32;
      file_.print("<path fill=\"{}\" d=\"", shade_color(static_cast<int>(shade)));
      path_.restart();
      for (; begin < shaded.size() && shaded[begin].order >> 32 == shade; ++begin) {
        write_triangle(shaded[begin].triangle);
      }
      file_.print("\"/>\n");
    }
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
  /// By place, so that even a grid has a gradient, and by size, so that neighbours differ.
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

  /// The triangle as far as it is inside the view; nothing if it has no area at the picture's resolution.
  void write_triangle(std::size_t t) {
    std::vector<Position>& polygon = polygon_;
    polygon.clear();
    bool clipped = false;
    for (std::size_t k = 0; k < 3; ++k) {
      polygon.push_back(position(mesh_.triangles[3 * t + k]));
      clipped = clipped || !inside(polygon.back());
    }
    if (clipped) {
      clip_polygon([](const Position& p) { return p.x; });
      clip_polygon([this](const Position& p) { return width_ - p.x; });
      clip_polygon([](const Position& p) { return p.y; });
      clip_polygon([this](const Position& p) { return height_ - p.y; });
    }
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

  /// Cuts polygon_ off where `distance` is negative (Sutherland and Hodgman).
  template <typename Distance>
  void clip_polygon(Distance distance) {
    clipped_.clear();
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      const Position &p = polygon_[k], &q = polygon_[(k + 1) % polygon_.size()];
      const double from = distance(p), to = distance(q);
      if (from >= 0) clipped_.push_back(p);
      if ((from < 0) != (to < 0)) {
        const double share = from / (from - to);
        clipped_.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
      }
    }
    polygon_.swap(clipped_);
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

  /// Every edge once: of the two triangles at an inner edge, one has it from its smaller index to its larger.
  /// The hull's other edges are in the hull's own path. Edges inside the view are joined to long trails,
  /// which takes half the characters of single segments.
  void write_edges() {
    if (mesh_.triangles.empty()) return;
    struct Neighbor {
      std::int32_t vertex;
      std::uint32_t edge;
    };
    std::vector<std::size_t> begin(point_count() + 1, 0);
    std::size_t joined = 0;
    const auto for_each_edge = [&](auto&& visit) {
      for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const std::int32_t v = mesh_.triangles[i], w = mesh_.triangles[i % 3 == 2 ? i - 2 : i + 1];
        if (v < w) visit(v, w);
      }
    };
    const auto shown_whole = [&](std::int32_t v, std::int32_t w) {
      const Position &p = position(v), &q = position(w);
      return inside(v) && inside(w) && (unit(p.x) != unit(q.x) || unit(p.y) != unit(q.y));
    };
    open_stroke("edges", "#4a5d73", line_width_);
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
          open_stroke(fmt::format("edges-{}", trails_ / kTrailsPerPath).c_str(), "#4a5d73", line_width_);
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
      // The hull of collinear points is closed too: the way back is on the way there.
      for (std::size_t i = begin; i < end; ++i)
        write_segment(mesh_.hull[i], mesh_.hull[i + 1 < end ? i + 1 : begin]);
    }
    file_.print("\"/>\n");
  }

  void write_dots() {
    if (point_count() > kDotsUpTo) return;
    // A line of no length with round ends is a dot.
    open_stroke("points", "#24405f", std::clamp(0.14 * typical_edge_, 2.0, 7.0));
    for (std::size_t i = 0; i < point_count(); ++i) {
      if (!inside(positions_[i])) continue;
      path_.move_to(unit(positions_[i].x), unit(positions_[i].y));
      file_.print("h0");
    }
    file_.print("\"/>\n");
  }

  void write_caption() {
    std::string text = counted(point_count(), "point") + " · " + counted(triangle_count(), "triangle") +
                       " · " + with_thousands(mesh_.hull.size()) + " on the hull";
    std::size_t duplicates = 0;
    for (std::size_t i = 0; i < mesh_.representatives.size(); ++i) {
      duplicates += mesh_.representatives[i] != static_cast<std::int32_t>(i);
    }
    if (duplicates > 0) text += " · " + counted(duplicates, "duplicate");
    file_.print(
        "<g font-family=\"Helvetica, Arial, sans-serif\" font-size=\"15\" fill=\"#3a4654\">\n"
        "<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n",
        kMargin, caption_y_ - (view_.central ? 9 : 0), text);
    if (view_.central) {
      const std::string magnification = view_.magnification < 1e15
                                            ? with_thousands(static_cast<std::size_t>(view_.magnification))
                                            : fmt::format("{:.0e}", view_.magnification);
      // Rounded down: "100 %" would deny the points that are missing.
      const auto percent =
          static_cast<int>(100 * static_cast<double>(view_.shown) / static_cast<double>(point_count()));
      file_.print(
          "<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"12\" fill=\"#6b7683\">only the centre is shown, with "
          "{} % of the points; the whole is {} times as wide</text>\n",
          kMargin, caption_y_ + 9, percent, magnification);
    }
    file_.print("</g>\n");
  }

  /// Viewers stroke several shorter paths faster than one endless one.
  static constexpr std::size_t kTrailsPerPath = 500;

  OutputFile file_;
  PathData path_;
  const Points& points_;
  const Triangulation& mesh_;
  View view_;
  double width_ = 0, height_ = 0;  // of the view, in pixels
  std::vector<Position> positions_;
  double typical_edge_ = 0;  // pixels
  double units_ = 1;         // whole-number coordinates per pixel
  double line_width_ = 1;    // pixels
  double caption_y_ = 0;
  std::size_t trails_ = 0;
  std::vector<Position> polygon_, clipped_;  // of write_triangle, kept for their memory
};

}  // namespace

void write_svg(const std::string& path, const Points& points, const Triangulation& mesh) {
  Picture(path, points, mesh).write();
}

}  // namespace flaunay::io
