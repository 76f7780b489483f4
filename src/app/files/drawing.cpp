#include "app/files/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace flaunay::io {
namespace {

constexpr double kLeastSide = 560;  // room for the caption
constexpr double kLeastHeight = 40;
constexpr double kMargin = 24;
constexpr double kCaption = 40;

/// Cuts off where `distance` is negative (Sutherland and Hodgman).
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

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
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

/// The part of the plane that is shown. Long double, because the extent of doubles may be beyond the largest
/// double.
struct Drawing::View {
  long double left = 0, right = 1, bottom = 0, top = 1;

  long double extent() const { return std::max(right - left, top - bottom); }
};

/// The whole extent, or the square around the medians that holds most of the points.
Drawing::View Drawing::choose_view(const Points& points) {
  constexpr double kShare = 0.8, kRoom = 1.1, kOutliersFrom = 3.5;
  const std::size_t n = points.size();
  if (n == 0) return {};
  const double* const at = points.coordinates.data();
  std::vector<double> x(n), y(n), distance(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = at[2 * i], y[i] = at[2 * i + 1];
  const auto [left, right] = std::minmax_element(x.begin(), x.end());
  const auto [bottom, top] = std::minmax_element(y.begin(), y.end());
  const View all = {*left, *right, *bottom, *top};
  const double middle_x = quantile(x, 0.5), middle_y = quantile(y, 0.5);
  for (std::size_t i = 0; i < n; ++i) {
    distance[i] = std::max(std::fabs(at[2 * i] - middle_x), std::fabs(at[2 * i + 1] - middle_y));
  }
  const long double reach = static_cast<long double>(kRoom) * quantile(distance, kShare);
  if (n < 10 || reach <= 0 || all.extent() <= kOutliersFrom * 2 * reach) return all;

  const View view = {std::max(all.left, middle_x - reach), std::min(all.right, middle_x + reach),
                     std::max(all.bottom, middle_y - reach), std::min(all.top, middle_y + reach)};
  std::size_t shown = 0;
  for (std::size_t i = 0; i < n; ++i) {
    shown += view.left <= at[2 * i] && at[2 * i] <= view.right && view.bottom <= at[2 * i + 1] &&
             at[2 * i + 1] <= view.top;
  }
  const auto magnification = static_cast<double>(all.extent() / view.extent());
  // Rounded down, so that it never says 100 % while points are missing.
  note_ = fmt::format("only the centre is shown, with {} % of the points; the whole is {} times as wide",
                      static_cast<int>(100 * static_cast<double>(shown) / static_cast<double>(n)),
                      magnification < 1e15 ? with_thousands(static_cast<std::size_t>(magnification))
                                           : fmt::format("{:.0e}", magnification));
  return view;
}

Drawing::Drawing(OutputFile& file, const Points& points) : file_(file), positions_(points.size()) {
  const View view = choose_view(points);
  const long double scale = view.extent() > 0 ? kCanvas / view.extent() : 1;
  width_ = static_cast<double>((view.right - view.left) * scale);
  height_ = static_cast<double>((view.top - view.bottom) * scale);
  for (std::size_t i = 0; i < points.size(); ++i) {
    positions_[i] = {static_cast<double>((points.coordinates[2 * i] - view.left) * scale),
                     static_cast<double>((view.top - points.coordinates[2 * i + 1]) * scale)};
  }
}

void Drawing::begin(const std::string& title) {
  const double width = std::max(width_, kLeastSide), height = std::max(height_, kLeastHeight);
  file_.print(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
      "{0:.0f} {1:.0f}\">\n<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fdfcf9\"/>\n"
      "<g transform=\"translate({3:.2f} {4:.2f}) scale({5:.6g})\" fill=\"none\" stroke-linejoin=\"round\" "
      "stroke-linecap=\"round\">\n",
      width + 2 * kMargin, height + 2 * kMargin + kCaption, title, (width + 2 * kMargin - width_) / 2,
      (height + 2 * kMargin + kCaption - kCaption - height_) / 2, 1 / units_);
}

void Drawing::end(const std::string& caption) {
  const double y = std::max(height_, kLeastHeight) + 2 * kMargin + kCaption - kMargin;
  file_.print(
      "</g>\n<g font-family=\"Helvetica, Arial, sans-serif\" font-size=\"15\" fill=\"#3a4654\">\n"
      "<text x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n",
      kMargin, y - (note_.empty() ? 0 : 9), caption);
  if (!note_.empty()) {
    file_.print("<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"12\" fill=\"#6b7683\">{}</text>\n", kMargin,
                y + 9, note_);
  }
  file_.print("</g>\n</svg>\n");
}

/// Whole numbers relative to the position of the pen. After a move or another line, SVG needs no letter, and
/// before a minus sign no blank.
void Drawing::step(const Rounded& to, bool is_first) {
  const std::int64_t dx = to[0] - pen_[0], dy = to[1] - pen_[1];
  file_.print("{}{}{}{}", is_first ? "m" : dx < 0 ? "" : " ", dx, dy < 0 ? "" : " ", dy);
  pen_ = to;
}

void Drawing::clip(std::vector<Position>& corners, double room) const {
  clip_side(corners, [=](const Position& p) { return p.x + room; });
  clip_side(corners, [=, this](const Position& p) { return width_ + room - p.x; });
  clip_side(corners, [=](const Position& p) { return p.y + room; });
  clip_side(corners, [=, this](const Position& p) { return height_ + room - p.y; });
}

void Drawing::polygon(std::vector<Position>& corners, double room, bool with_flat) {
  if (!std::all_of(corners.begin(), corners.end(), [this](const Position& p) { return contains(p); })) {
    clip(corners, room);
  }
  if (corners.empty()) return;
  rounded_.clear();
  for (const Position& p : corners) rounded_.push_back({unit(p.x), unit(p.y)});
  std::int64_t doubled_area = 0;
  for (std::size_t k = 0; k < rounded_.size(); ++k) {
    const auto &p = rounded_[k], &q = rounded_[k + 1 < rounded_.size() ? k + 1 : 0];
    doubled_area += p[0] * q[1] - p[1] * q[0];
  }
  if (doubled_area == 0 && !with_flat) return;
  for (std::size_t k = 0; k < rounded_.size(); ++k) step(rounded_[k], k == 0);
  file_.print("z");
  pen_ = rounded_[0];
}

void Drawing::edge(std::int32_t v, std::int32_t w) {
  std::vector<Position> ends = {position(v), position(w)};
  if (!contains(ends[0]) || !contains(ends[1])) clip(ends, 0);
  if (ends.empty() || is_same(ends[0], ends[1])) return;
  move_to(ends[0]);
  line_to(ends[1]);
}

void Drawing::dot(const Position& p) {
  if (!contains(p)) return;
  move_to(p);
  file_.print("h0");
}

}  // namespace flaunay::io
