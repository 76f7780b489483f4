// The common parts of pictures: the visible part of the plane, the positions of points in it, paths,
// captions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/files/points.hpp"
#include "files/output.hpp"

namespace flaunay::io {

constexpr double kCanvas = 1000;  // pixels of the view's longer side

struct Position {
  double x, y;
};

/// The value below which `share` of the values lie. Reorders them.
double quantile(std::vector<double>& values, double share);

/// "2,000", and "1 point", "2,000 points".
std::string with_thousands(std::size_t number);
std::string counted(std::size_t number, const std::string& what);

/// An SVG document with a view of points: of all, or of the centre if a few far ones would shrink the rest to
/// a speck. Positions are in pixels from the upper left corner of the view, y downwards.
class Drawing {
 public:
  Drawing(OutputFile& file, const Points& points);

  double width() const { return width_; }
  double height() const { return height_; }
  const std::vector<Position>& positions() const { return positions_; }
  const Position& position(std::int32_t point) const { return positions_[static_cast<std::size_t>(point)]; }
  bool contains(const Position& p) const { return p.x >= 0 && p.x <= width_ && p.y >= 0 && p.y <= height_; }

  /// Paths have integer coordinates: `units` per pixel. Call it before the document begins.
  void set_units(double units) { units_ = units; }
  std::int64_t unit(double pixels) const { return std::llround(pixels * units_); }
  /// Whether both are one position in paths.
  bool is_same(const Position& p, const Position& q) const {
    return unit(p.x) == unit(q.x) && unit(p.y) == unit(q.y);
  }

  /// The document up to the first element of the view, and its end.
  void begin(const std::string& title);
  void end(const std::string& caption);

  /// Begins an element that ends with end_path.
  template <typename... Arguments>
  void begin_path(fmt::format_string<Arguments...> attributes, Arguments&&... arguments) {
    file_.print("<path {} d=\"", fmt::format(attributes, std::forward<Arguments>(arguments)...));
    pen_ = {0, 0};
  }
  void end_path() { file_.print("\"/>\n"); }
  void move_to(const Position& p) { step({unit(p.x), unit(p.y)}, true); }
  void line_to(const Position& p) { step({unit(p.x), unit(p.y)}, false); }
  /// The part of a polygon in the view, enlarged by `room` on each side. Parts without area only if
  /// `with_flat`.
  void polygon(std::vector<Position>& corners, double room, bool with_flat);
  /// The part of an edge in the view, unless it is too short to show.
  void edge(std::int32_t v, std::int32_t w);
  /// A line of no length, which is a dot if its ends are round. None outside of the view.
  void dot(const Position& p);

 private:
  struct View;
  View choose_view(const Points& points);
  void clip(std::vector<Position>& corners, double room) const;
  using Rounded = std::array<std::int64_t, 2>;
  void step(const Rounded& to, bool is_first);

  OutputFile& file_;
  std::vector<Position> positions_;
  double width_ = 0, height_ = 0, units_ = 10;
  Rounded pen_ = {0, 0};
  std::vector<Rounded> rounded_;  // of polygon, kept for its memory
  std::string note_;              // a second line of the caption
};

}  // namespace flaunay::io
