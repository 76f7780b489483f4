// Shapes and texts as SVG elements, with estimates of how wide a text is.
#pragma once

#include <string>
#include <vector>

namespace flaunay::bench::plot {

struct Position {
  double x, y;
};

/// How an outline or a filled shape looks; colours as SVG writes them.
struct Paint {
  std::string fill = "none";
  std::string stroke = "none";
  double width = 1;
  std::string dash = {};  ///< lengths of dashes and gaps; empty: solid
  double opacity = 1;
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 12;
  Anchor anchor = Anchor::start;
  std::string color = "#222222";
  bool bold = false;
  double turn = 0;  ///< degrees, clockwise, about the position
};

/// Width in pixels of a text with ^{superscripts} and _{subscripts}; an upper estimate, by the metrics of a
/// wide font, so that what fits by it fits with any common sans-serif font.
double text_width(const std::string& text, double size);

/// Number of marker shapes; shapes are taken modulo it.
constexpr int kMarkers = 7;

/// Collects elements; y grows downwards.
class Canvas {
 public:
  Canvas(double width, double height);

  void line(Position from, Position to, const Paint& paint);
  void polyline(const std::vector<Position>& positions, const Paint& paint);
  void polygon(const std::vector<Position>& positions, const Paint& paint);
  void rectangle(Position corner, double width, double height, const Paint& paint);
  /// Many round dots of one colour.
  void dots(const std::vector<Position>& positions, double radius, const std::string& color, double opacity);
  void marker(int shape, Position center, double radius, const std::string& color);
  void diamond(Position center, double radius, const Paint& paint);
  void text(Position at, const std::string& text, const TextStyle& style);

  /// What is drawn until end_clip shows inside the rectangle only.
  void begin_clip(Position corner, double width, double height);
  void end_clip();

  std::string finish() const;

 private:
  double width_, height_;
  int clips_ = 0;
  std::string body_;
};

}  // namespace flaunay::bench::plot
