#include "canvas.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string_view>

namespace flaunay::bench::plot {
namespace {

// Fonts that some system has each; the generic one last.
constexpr const char* kFonts = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";
constexpr double kScriptSize = 0.72;  // of super- and subscripts, relative to the text
constexpr double kSuperscriptRise = 0.36;
constexpr double kSubscriptDrop = 0.18;

enum class Script { normal, super, sub };

struct Piece {
  std::string text;
  Script script;
};

std::vector<Piece> pieces_of(const std::string& text) {
  std::vector<Piece> pieces;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t super = text.find("^{", at), sub = text.find("_{", at);
    const std::size_t open = std::min(super, sub);
    const std::size_t close = open == std::string::npos ? open : text.find('}', open);
    if (close == std::string::npos) {
      pieces.push_back({text.substr(at), Script::normal});
      break;
    }
    if (open > at) pieces.push_back({text.substr(at, open - at), Script::normal});
    pieces.push_back({text.substr(open + 2, close - open - 2), open == super ? Script::super : Script::sub});
    at = close + 1;
  }
  return pieces;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Width of a character relative to the font's size.
double character_width(unsigned char c) {
  constexpr std::string_view kThin = "ijl.,:;'|!I ", kSlim = "ftr()[]/-\"J", kWide = "mwMW%@";
  if (c >= 0x80 && c < 0xc0) return 0;  // a further byte of a character that is counted already
  if (kThin.find(static_cast<char>(c)) != std::string_view::npos) return 0.32;
  if (kSlim.find(static_cast<char>(c)) != std::string_view::npos) return 0.40;
  if (kWide.find(static_cast<char>(c)) != std::string_view::npos) return 0.95;
  if (c >= 'A' && c <= 'Z') return 0.72;
  return 0.62;
}

double plain_width(const std::string& text) {
  double width = 0;
  for (const char c : text) width += character_width(static_cast<unsigned char>(c));
  return width;
}

std::string attributes(const Paint& paint) {
  std::string result = fmt::format(" fill=\"{}\"", paint.fill);
  auto out = std::back_inserter(result);
  if (paint.stroke != "none")
    fmt::format_to(out, " stroke=\"{}\" stroke-width=\"{}\"", paint.stroke, paint.width);
  if (!paint.dash.empty()) fmt::format_to(out, " stroke-dasharray=\"{}\"", paint.dash);
  if (paint.opacity < 1) fmt::format_to(out, " opacity=\"{}\"", paint.opacity);
  return result;
}

std::string corner_list(const std::vector<Position>& positions) {
  std::string list;
  for (const Position& p : positions) {
    fmt::format_to(std::back_inserter(list), "{}{:.2f},{:.2f}", list.empty() ? "" : " ", p.x, p.y);
  }
  return list;
}

/// A regular polygon or, with a second radius, a star.
std::vector<Position> star(Position center, int corners, double first_turn, double outer, double inner) {
  constexpr double kTau = 6.283185307179586;
  std::vector<Position> result;
  for (int k = 0; k < 2 * corners; ++k) {
    const double radius = k % 2 == 0 ? outer : inner;
    const double angle = kTau * (first_turn + k / (2.0 * corners));
    if (radius > 0)
      result.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
  }
  return result;
}

}  // namespace

double text_width(const std::string& text, double size) {
  double width = 0;
  for (const Piece& piece : pieces_of(text)) {
    width += plain_width(piece.text) * (piece.script == Script::normal ? 1 : kScriptSize);
  }
  return width * size;
}

Canvas::Canvas(double width, double height) : width_(width), height_(height) {}

void Canvas::line(Position from, Position to, const Paint& paint) {
  fmt::format_to(std::back_inserter(body_),
                 "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"{}/>\n", from.x, from.y, to.x,
                 to.y, attributes(paint));
}

void Canvas::polyline(const std::vector<Position>& positions, const Paint& paint) {
  fmt::format_to(std::back_inserter(body_), "<polyline points=\"{}\" stroke-linejoin=\"round\"{}/>\n",
                 corner_list(positions), attributes(paint));
}

void Canvas::polygon(const std::vector<Position>& positions, const Paint& paint) {
  fmt::format_to(std::back_inserter(body_), "<polygon points=\"{}\"{}/>\n", corner_list(positions),
                 attributes(paint));
}

void Canvas::rectangle(Position corner, double width, double height, const Paint& paint) {
  fmt::format_to(std::back_inserter(body_),
                 "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"{}/>\n", corner.x,
                 corner.y, width, height, attributes(paint));
}

// One path whose pieces have no length and round ends: far shorter than an element for each dot.
void Canvas::dots(const std::vector<Position>& positions, double radius, const std::string& color,
                  double opacity) {
  body_ += "<path d=\"";
  for (const Position& p : positions) {
    fmt::format_to(std::back_inserter(body_), "M{:.1f} {:.1f}h0", p.x, p.y);
  }
  fmt::format_to(std::back_inserter(body_),
                 "\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" stroke-linecap=\"round\" "
                 "stroke-opacity=\"{}\"/>\n",
                 color, 2 * radius, opacity);
}

// A thin white edge keeps markers apart where they touch.
void Canvas::marker(int shape, Position center, double radius, const std::string& color) {
  const Paint paint{color, "#ffffff", 0.8, "", 1};
  constexpr double kUp = -0.25, kDown = 0.25, kEighth = 0.125;
  switch (shape % kMarkers) {
    case 0:
      fmt::format_to(std::back_inserter(body_), "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\"{}/>\n",
                     center.x, center.y, radius, attributes(paint));
      break;
    case 1:
      polygon(star(center, 4, kEighth, 1.25 * radius, 0), paint);
      break;
    case 2:
      polygon(star(center, 3, kUp, 1.35 * radius, 0), paint);
      break;
    case 3:
      polygon(star(center, 4, kUp, 1.3 * radius, 0), paint);
      break;
    case 4:
      polygon(star(center, 3, kDown, 1.35 * radius, 0), paint);
      break;
    case 5:
      polygon(star(center, 5, kUp, 1.5 * radius, 0.65 * radius), paint);
      break;
    default:
      polygon(star(center, 6, 0, 1.15 * radius, 0), paint);
  }
}

void Canvas::diamond(Position center, double radius, const Paint& paint) {
  polygon(star(center, 4, 0, radius, 0), paint);
}

void Canvas::text(Position at, const std::string& text, const TextStyle& style) {
  static constexpr const char* kAnchors[] = {"start", "middle", "end"};
  auto out = std::back_inserter(body_);
  fmt::format_to(out, "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{}\" fill=\"{}\"", at.x, at.y, style.size,
                 style.color);
  if (style.anchor != Anchor::start) {
    fmt::format_to(out, " text-anchor=\"{}\"", kAnchors[static_cast<int>(style.anchor)]);
  }
  if (style.bold) body_ += " font-weight=\"bold\"";
  if (style.turn != 0)
    fmt::format_to(out, " transform=\"rotate({:.1f} {:.2f} {:.2f})\"", style.turn, at.x, at.y);
  body_ += ">";
  // Shifts of the base line add up, so each piece undoes that of the one before.
  double shift = 0;
  for (const Piece& piece : pieces_of(text)) {
    const double wanted = piece.script == Script::super ? -kSuperscriptRise * style.size
                          : piece.script == Script::sub ? kSubscriptDrop * style.size
                                                        : 0;
    const double size = piece.script == Script::normal ? style.size : kScriptSize * style.size;
    fmt::format_to(out, "<tspan dy=\"{:.2f}\" font-size=\"{:.2f}\">{}</tspan>", wanted - shift, size,
                   escaped(piece.text));
    shift = wanted;
  }
  body_ += "</text>\n";
}

void Canvas::begin_clip(Position corner, double width, double height) {
  ++clips_;
  fmt::format_to(std::back_inserter(body_),
                 "<clipPath id=\"clip{0}\"><rect x=\"{1:.2f}\" y=\"{2:.2f}\" width=\"{3:.2f}\" "
                 "height=\"{4:.2f}\"/></clipPath>\n<g clip-path=\"url(#clip{0})\">\n",
                 clips_, corner.x, corner.y, width, height);
}

void Canvas::end_clip() { body_ += "</g>\n"; }

std::string Canvas::finish() const {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"{2}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      width_, height_, kFonts, body_);
}

}  // namespace flaunay::bench::plot
