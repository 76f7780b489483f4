#include "app/files/drawing.hpp"

namespace flaunay::io {
namespace {

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

}  // namespace

Page::Page(const Points& points) : view_(choose_view(points)) {
  const long double width = view_.right - view_.left, height = view_.top - view_.bottom;
  const long double extent = std::max(width, height);
  const long double scale = extent > 0 ? kCanvas / extent : 1;
  width_ = static_cast<double>(width * scale);
  height_ = static_cast<double>(height * scale);
  positions_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    positions_[i] = {static_cast<double>((points.coordinates[2 * i] - view_.left) * scale),
                     static_cast<double>((view_.top - points.coordinates[2 * i + 1]) * scale)};
  }
}

void Page::open(OutputFile& file, const std::string& title, double units) const {
  const double shift_x = (page_width() - width_) / 2;
  const double shift_y = (page_height() - kCaption - height_) / 2;
  file.print(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
      "{0:.0f} "
      "{1:.0f}\">\n<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fdfcf9\"/>\n",
      page_width(), page_height(), title);
  file.print(
      "<g transform=\"translate({:.2f} {:.2f}) scale({:.6g})\" fill=\"none\" stroke-linejoin=\"round\" "
      "stroke-linecap=\"round\">\n",
      shift_x, shift_y, 1 / units);
}

void Page::close(OutputFile& file, const std::string& caption) const {
  const double y = page_height() - kMargin;
  file.print(
      "</g>\n<g font-family=\"Helvetica, Arial, sans-serif\" font-size=\"15\" fill=\"#3a4654\">\n"
      "<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n",
      kMargin, y - (view_.central ? 9 : 0), caption);
  if (view_.central) {
    const std::string magnification = view_.magnification < 1e15
                                          ? with_thousands(static_cast<std::size_t>(view_.magnification))
                                          : fmt::format("{:.0e}", view_.magnification);
    // Rounded down, so that it never says 100 % while points are missing.
    const auto percent =
        static_cast<int>(100 * static_cast<double>(view_.shown) / static_cast<double>(positions_.size()));
    file.print(
        "<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"12\" fill=\"#6b7683\">only the centre is shown, with "
        "{} % of the points; the whole is {} times as wide</text>\n",
        kMargin, y + 9, percent, magnification);
  }
  file.print("</g>\n</svg>\n");
}

std::string with_thousands(std::size_t number) {
  std::string digits = std::to_string(number);
  for (auto i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3) {
    digits.insert(static_cast<std::size_t>(i), 1, ',');
  }
  return digits;
}

std::string counted(std::size_t number, const std::string& what) {
  return with_thousands(number) + " " + what + (number == 1 ? "" : "s");
}

namespace {

/// Clips the polygon to where `distance` is not negative (Sutherland and Hodgman).
template <typename Distance>
void clip_side(std::vector<Position>& polygon, const Distance& distance) {
  std::vector<Position> clipped;
  clipped.reserve(polygon.size() + 2);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Position &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double from = distance(p), to = distance(q);
    if (from >= 0) clipped.push_back(p);
    if ((from < 0) != (to < 0)) {
      const double share = from / (from - to);
      clipped.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
    }
  }
  polygon.swap(clipped);
}

}  // namespace

void clip_polygon(std::vector<Position>& polygon, double room, double width, double height) {
  clip_side(polygon, [=](const Position& p) { return p.x + room; });
  clip_side(polygon, [=](const Position& p) { return width + room - p.x; });
  clip_side(polygon, [=](const Position& p) { return p.y + room; });
  clip_side(polygon, [=](const Position& p) { return height + room - p.y; });
}

}  // namespace flaunay::io
