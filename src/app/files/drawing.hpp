// The common parts of pictures: the visible part of the plane, the positions of points in it, path data,
// captions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/files/points.hpp"
#include "files/output.hpp"

namespace flaunay::io {

constexpr double kCanvas = 1000;    // pixels of the picture's longer side
constexpr double kLeastSide = 560;  // room for the caption
constexpr double kLeastHeight = 40;
constexpr double kMargin = 24;
constexpr double kCaption = 40;

struct Position {
  double x, y;
};

/// The value below which `share` of the values lie. Reorders them.
inline double quantile(std::vector<double>& values, double share) {
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

/// The positions of points in a picture, and the picture's frame.
class Page {
 public:
  explicit Page(const Points& points);

  /// The size of the view in pixels.
  double width() const { return width_; }
  double height() const { return height_; }
  /// The positions of the points in pixels from the upper left corner of the view, y downwards.
  const std::vector<Position>& positions() const { return positions_; }
  bool contains(const Position& p) const { return p.x >= 0 && p.x <= width_ && p.y >= 0 && p.y <= height_; }

  /// The beginning of the document, up to the view: a group with `units` coordinate units per pixel.
  void open(OutputFile& file, const std::string& title, double units) const;
  /// The end of the document: a caption, and the share of the points that the view shows if it does not show
  /// all.
  void close(OutputFile& file, const std::string& caption) const;

 private:
  double page_width() const { return std::max(width_, kLeastSide) + 2 * kMargin; }
  double page_height() const { return std::max(height_, kLeastHeight) + 2 * kMargin + kCaption; }

  View view_;
  double width_ = 0, height_ = 0;
  std::vector<Position> positions_;
};

std::string with_thousands(std::size_t number);
/// "1 point", "2,000 points".
std::string counted(std::size_t number, const std::string& what);

/// Path data of whole numbers, each relative to the position of the pen.
class PathData {
 public:
  explicit PathData(OutputFile& file) : file_(file) {}

  void move_to(std::int64_t x, std::int64_t y) {
    file_.print("m");
    first_ = true;
    step(x, y);
    start_x_ = x, start_y_ = y;
  }
  /// To be called after a move_to or another line_to; SVG then needs no letter.
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

/// Clips a polygon to the box from (0, 0) to (width, height), enlarged by `room` on each side.
void clip_polygon(std::vector<Position>& polygon, double room, double width, double height);

}  // namespace flaunay::io
