#include "panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flaunay::bench::plot {
namespace {

// Okabe and Ito's palette, which people with any colour vision can tell apart; its yellow is left out, being
// invisible on white.
constexpr std::array<const char*, 9> kPalette = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                                 "#56b4e9", "#4d4d4d", "#8c6d46", kInk};

constexpr const char* kGrid = "#e4e4e4";
constexpr const char* kFrame = "#8c8c8c";
constexpr double kMarkerRadius = 3.6, kLineWidth = 1.8, kBandOpacity = 0.16;
constexpr double kRow = 15;  // height of a row of labels
constexpr double kAxisTitle = 20, kTickGap = 6;

/// Positions of values in the area of a panel.
struct Mapping {
  Area area;
  Scale x_scale, y_scale;
  Range x_range, y_range;

  double x(double value) const { return area.corner.x + area.width * share(x_scale, x_range, value); }
  double y(double value) const { return area.corner.y + area.height * (1 - share(y_scale, y_range, value)); }
  bool shows(double px, double py) const { return showable(x_scale, px) && showable(y_scale, py); }
};

double right_of(const Area& area) { return area.corner.x + area.width; }
double bottom_of(const Area& area) { return area.corner.y + area.height; }

int wanted_y_ticks(double height) { return std::max(3, static_cast<int>(height / 40)); }
constexpr int kYTicksForMargins = 7;  // before the height is known; labels hardly differ

/// As many as fit side by side.
std::vector<Tick> x_ticks(const Axis& axis, Range range, double width) {
  for (int wanted = 12; wanted > 2; --wanted) {
    std::vector<Tick> candidates = ticks(axis, range, wanted);
    double widest = 0;
    for (const Tick& tick : candidates) widest = std::max(widest, text_width(tick.label, kTickSize));
    bool fits = true;
    for (std::size_t k = 1; k < candidates.size(); ++k) {
      const double gap = width * (share(axis.scale, range, candidates[k].value) -
                                  share(axis.scale, range, candidates[k - 1].value));
      fits = fits && gap > widest + 10;
    }
    if (fits) return candidates;
  }
  return ticks(axis, range, 2);
}

double widest_y_label(const Axis& axis, Range range) {
  double widest = 0;
  for (const Tick& tick : ticks(axis, range, kYTicksForMargins)) {
    widest = std::max(widest, text_width(tick.label, kTickSize));
  }
  return widest;
}

void draw_y_axis(Canvas& canvas, const Axis& axis, const Mapping& map, bool with_title) {
  const Area& area = map.area;
  double widest = 0;
  for (const Tick& tick : ticks(axis, map.y_range, wanted_y_ticks(area.height))) {
    const double y = map.y(tick.value);
    canvas.line({area.corner.x, y}, {right_of(area), y}, {"none", kGrid, 1, "", 1});
    canvas.text({area.corner.x - kTickGap, y + 0.35 * kTickSize}, tick.label,
                {kTickSize, Anchor::end, kFaintInk});
    widest = std::max(widest, text_width(tick.label, kTickSize));
  }
  if (!with_title) return;
  canvas.text(
      {area.corner.x - kTickGap - widest_y_label(axis, map.y_range) - 9, area.corner.y + area.height / 2},
      axis.title, {kLabelSize, Anchor::middle, kInk, false, -90});
}

void draw_x_axis(Canvas& canvas, const Axis& axis, const Mapping& map) {
  const Area& area = map.area;
  for (const Tick& tick : x_ticks(axis, map.x_range, area.width)) {
    const double x = map.x(tick.value);
    canvas.line({x, area.corner.y}, {x, bottom_of(area)}, {"none", kGrid, 1, "", 1});
    canvas.text({x, bottom_of(area) + kTickGap + 0.9 * kTickSize}, tick.label,
                {kTickSize, Anchor::middle, kFaintInk});
  }
  canvas.text({area.corner.x + area.width / 2, bottom_of(area) + kTickGap + kRow + kLabelSize + 4},
              axis.title, {kLabelSize, Anchor::middle});
}

void draw_frame(Canvas& canvas, const Area& area) {
  canvas.line({area.corner.x, area.corner.y}, {area.corner.x, bottom_of(area)}, {"none", kFrame, 1, "", 1});
  canvas.line({area.corner.x, bottom_of(area)}, {right_of(area), bottom_of(area)},
              {"none", kFrame, 1, "", 1});
}

void draw_title(Canvas& canvas, const std::string& title, const Area& area, double title_y) {
  if (title.empty()) return;
  canvas.text({area.corner.x + area.width / 2, title_y}, title,
              {kPanelTitleSize, Anchor::middle, kInk, true});
}

double title_height(const std::string& title) { return title.empty() ? 8 : kPanelTitleSize + 12; }

// ---- Lines

std::size_t points_of(const Series& series) { return std::min(series.x.size(), series.y.size()); }

bool has_spread(const Series& series) {
  return series.low.size() >= points_of(series) && series.high.size() >= points_of(series);
}

/// The maximal runs of points that can be shown, as [first, last).
std::vector<std::pair<std::size_t, std::size_t>> shown_runs(const Series& series, const Mapping& map) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t i = 0; i < points_of(series); ++i) {
    if (!map.shows(series.x[i], series.y[i])) continue;
    if (runs.empty() || runs.back().second != i) runs.push_back({i, i});
    runs.back().second = i + 1;
  }
  return runs;
}

void draw_band(Canvas& canvas, const Series& series, const Mapping& map, const Look& look) {
  for (const auto& [first, last] : shown_runs(series, map)) {
    std::vector<Position> outline;
    for (std::size_t i = first; i < last; ++i) {
      if (map.shows(series.x[i], series.high[i]))
        outline.push_back({map.x(series.x[i]), map.y(series.high[i])});
    }
    for (std::size_t i = last; i-- > first;) {
      if (map.shows(series.x[i], series.low[i]))
        outline.push_back({map.x(series.x[i]), map.y(series.low[i])});
    }
    canvas.polygon(outline, {look.color, "none", 1, "", kBandOpacity});
  }
}

void draw_error_bar(Canvas& canvas, double x, double top, double bottom, const std::string& color) {
  constexpr double kCap = 3.5;
  const Paint paint{"none", color, 1.2, "", 1};
  canvas.line({x, top}, {x, bottom}, paint);
  canvas.line({x - kCap, top}, {x + kCap, top}, paint);
  canvas.line({x - kCap, bottom}, {x + kCap, bottom}, paint);
}

void draw_error_bars(Canvas& canvas, const Series& series, const Mapping& map, const Look& look) {
  for (std::size_t i = 0; i < points_of(series); ++i) {
    if (!map.shows(series.x[i], series.low[i]) || !map.shows(series.x[i], series.high[i])) continue;
    draw_error_bar(canvas, map.x(series.x[i]), map.y(series.high[i]), map.y(series.low[i]), look.color);
  }
}

void draw_spread(Canvas& canvas, const Series& series, const Mapping& map, const Look& look) {
  if (!has_spread(series)) return;
  if (series.spread == Spread::band) {
    draw_band(canvas, series, map, look);
  } else {
    draw_error_bars(canvas, series, map, look);
  }
}

void draw_series(Canvas& canvas, const Series& series, const Mapping& map, const Look& look) {
  for (const auto& [first, last] : shown_runs(series, map)) {
    std::vector<Position> positions;
    for (std::size_t i = first; i < last; ++i) positions.push_back({map.x(series.x[i]), map.y(series.y[i])});
    if (series.stroke != Stroke::none) {
      const std::string dash = series.stroke == Stroke::dashed ? "6 4" : "";
      canvas.polyline(positions, {"none", look.color, kLineWidth, dash, 1});
    }
    if (!series.markers) continue;
    for (const Position& p : positions) canvas.marker(look.marker, p, kMarkerRadius, look.color);
  }
}

/// Labels of vertical references stand above the area, in as many rows as they need not to meet.
struct ReferenceLabel {
  const Reference* reference;
  double center;
  int row;
};

std::vector<ReferenceLabel> reference_labels(const Lines& panel, Range range, double left, double width) {
  std::vector<ReferenceLabel> labels;
  for (const Reference& reference : panel.references) {
    if (!reference.vertical || !showable(panel.x.scale, reference.at)) continue;
    if (reference.at < range.low || reference.at > range.high) continue;
    labels.push_back({&reference, left + width * share(panel.x.scale, range, reference.at), 0});
  }
  std::sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.center < b.center; });
  std::vector<double> row_ends;
  for (ReferenceLabel& label : labels) {
    const double half = text_width(label.reference->label, kTickSize) / 2;
    // A label near an end of the axis moves inwards, so that no panel's labels reach into the next one.
    label.center = std::max(left + half, std::min(left + width - half, label.center));
    while (label.row < static_cast<int>(row_ends.size()) &&
           row_ends[static_cast<std::size_t>(label.row)] > label.center - half) {
      ++label.row;
    }
    if (label.row == static_cast<int>(row_ends.size())) row_ends.push_back(0);
    row_ends[static_cast<std::size_t>(label.row)] = label.center + half + 8;
  }
  return labels;
}

double reference_rows_height(const std::vector<ReferenceLabel>& labels) {
  int rows = 0;
  for (const ReferenceLabel& label : labels) rows = std::max(rows, label.row + 1);
  return rows * kRow;
}

void draw_references(Canvas& canvas, const Lines& panel, const Mapping& map) {
  const Area& area = map.area;
  const Paint paint{"none", kFaintInk, 1, "3 3", 1};
  const auto labels = reference_labels(panel, map.x_range, area.corner.x, area.width);
  const auto base_of = [&](const ReferenceLabel& label) { return area.corner.y - 4 - label.row * kRow; };
  for (const ReferenceLabel& label : labels) {
    const double x = map.x(label.reference->at);
    canvas.line({x, base_of(label) + 2}, {x, bottom_of(area)}, paint);
  }
  // Labels last and on white: the lines of upper rows pass lower ones.
  for (const ReferenceLabel& label : labels) {
    const double width = text_width(label.reference->label, kTickSize);
    canvas.rectangle({label.center - width / 2, base_of(label) - 0.85 * kTickSize}, width, 1.1 * kTickSize,
                     {"#ffffff", "none", 1, "", 1});
    canvas.text({label.center, base_of(label)}, label.reference->label,
                {kTickSize, Anchor::middle, kFaintInk});
  }
  std::vector<std::pair<double, std::string>> beside;
  for (const Reference& reference : panel.references) {
    if (reference.vertical || !showable(panel.y.scale, reference.at)) continue;
    const double y = map.y(reference.at);
    if (y < area.corner.y || y > bottom_of(area)) continue;
    canvas.line({area.corner.x, y}, {right_of(area), y}, paint);
    beside.push_back({y, reference.label});
  }
  std::sort(beside.begin(), beside.end());
  double free_from = 0;
  for (const auto& [y, label] : beside) {
    const double base = std::max(free_from, y + 0.35 * kTickSize);
    canvas.text({right_of(area) + 4, base}, label, {kTickSize, Anchor::start, kFaintInk});
    free_from = base + kRow;
  }
}

Margins margins(const Lines& panel, const Ranges& ranges, double width, bool with_y_title) {
  const Range x_range = ranges.of_x(panel.x);
  Margins result;
  result.left =
      kTickGap + widest_y_label(panel.y, ranges.of_y(panel.y)) + (with_y_title ? kAxisTitle + 4 : 6);
  result.right = 18;  // half a label of the last tick
  for (const Reference& reference : panel.references) {
    if (!reference.vertical)
      result.right = std::max(result.right, text_width(reference.label, kTickSize) + 10);
  }
  const double inner = width - result.left - result.right;
  result.top = title_height(panel.title) + reference_rows_height(reference_labels(panel, x_range, 0, inner));
  result.bottom = kTickGap + kRow + kAxisTitle;
  return result;
}

void draw_panel(Canvas& canvas, const Lines& panel, const Area& area, double title_y, const Ranges& ranges,
                Looks& looks, bool with_y_title) {
  const Mapping map{area, panel.x.scale, panel.y.scale, ranges.of_x(panel.x), ranges.of_y(panel.y)};
  draw_x_axis(canvas, panel.x, map);
  draw_y_axis(canvas, panel.y, map, with_y_title);
  draw_frame(canvas, area);
  draw_references(canvas, panel, map);
  draw_title(canvas, panel.title, area, title_y);
  // Markers at the edge may reach a little beyond it.
  constexpr double kBeyond = 6;
  canvas.begin_clip({area.corner.x - kBeyond, area.corner.y - kBeyond}, area.width + 2 * kBeyond,
                    area.height + 2 * kBeyond);
  for (const Series& series : panel.series) {
    draw_spread(canvas, series, map, looks.of(series.name, series.color));
  }
  for (const Series& series : panel.series) {
    draw_series(canvas, series, map, looks.of(series.name, series.color));
  }
  canvas.end_clip();
}

// ---- Bars

double total(const Bar& bar) {
  double sum = 0;
  for (const double part : bar.parts) sum += part;
  return sum;
}

constexpr double kValueSize = kTickSize - 1;

double widest_value(const Bars& panel) {
  double widest = 0;
  for (const BarGroup& group : panel.groups) {
    for (const Bar& bar : group.bars) {
      widest = std::max(widest, text_width(value_label(panel.y.unit, total(bar)), kValueSize));
    }
  }
  return widest;
}

/// Heights written above bars that are too narrow for them are turned.
bool values_turned(const Bars& panel, double slot) { return widest_value(panel) + 2 > slot; }

bool names_below(const Bars& panel) { return panel.parts.size() > 1; }

/// Where the groups and bars of a panel stand.
struct BarPlaces {
  double slot;  // from bar to bar
  double bar_width;
  std::vector<std::vector<double>> centers;  // by group and bar
};

BarPlaces bar_places(const Bars& panel, double left, double width) {
  constexpr double kGroupGap = 0.7, kWidest = 54, kFilled = 0.84;
  std::size_t bars = 0;
  for (const BarGroup& group : panel.groups) bars += group.bars.size();
  const double slots = static_cast<double>(bars) + kGroupGap * static_cast<double>(panel.groups.size());
  const double slot = std::min(kWidest, width / std::max(1.0, slots));
  // Few bars do not get fatter but stand further apart, each group in the middle of its share.
  const double spare = (width - slot * slots) / std::max<double>(1, static_cast<double>(panel.groups.size()));
  BarPlaces places{slot, kFilled * slot, {}};
  double at = left;
  for (const BarGroup& group : panel.groups) {
    at += (spare + kGroupGap * slot) / 2;
    places.centers.emplace_back();
    for (std::size_t b = 0; b < group.bars.size(); ++b, at += slot)
      places.centers.back().push_back(at + slot / 2);
    at += (spare + kGroupGap * slot) / 2;
  }
  return places;
}

/// A row of labels below bars: level if they fit, else turned.
struct LabelRow {
  std::vector<std::string> texts;
  std::vector<double> centers;
  bool turned = false;
  double height = 0;
};

constexpr double kTurn = -38;  // degrees

LabelRow label_row(std::vector<std::string> texts, std::vector<double> centers) {
  LabelRow row{std::move(texts), std::move(centers)};
  double widest = 0;
  for (std::size_t i = 0; i < row.texts.size(); ++i) {
    const double width = text_width(row.texts[i], kTickSize);
    widest = std::max(widest, width);
    if (i == 0) continue;
    const double before = text_width(row.texts[i - 1], kTickSize);
    row.turned = row.turned || row.centers[i] - row.centers[i - 1] < (width + before) / 2 + 6;
  }
  constexpr double kSine = 0.616;
  row.height = widest == 0 ? 0 : row.turned ? kSine * widest + kRow : kRow;
  return row;
}

LabelRow bar_name_row(const Bars& panel, const BarPlaces& places) {
  std::vector<std::string> texts;
  std::vector<double> centers;
  if (names_below(panel)) {
    for (std::size_t g = 0; g < panel.groups.size(); ++g) {
      for (std::size_t b = 0; b < panel.groups[g].bars.size(); ++b) {
        texts.push_back(panel.groups[g].bars[b].name);
        centers.push_back(places.centers[g][b]);
      }
    }
  }
  return label_row(std::move(texts), std::move(centers));
}

LabelRow group_name_row(const Bars& panel, const BarPlaces& places) {
  std::vector<std::string> texts;
  std::vector<double> centers;
  for (std::size_t g = 0; g < panel.groups.size(); ++g) {
    if (places.centers[g].empty()) continue;
    texts.push_back(panel.groups[g].name);
    centers.push_back((places.centers[g].front() + places.centers[g].back()) / 2);
  }
  return label_row(std::move(texts), std::move(centers));
}

void draw_label_row(Canvas& canvas, const LabelRow& row, double top, const TextStyle& style) {
  for (std::size_t i = 0; i < row.texts.size(); ++i) {
    TextStyle turned = style;
    turned.anchor = row.turned ? Anchor::end : Anchor::middle;
    turned.turn = row.turned ? kTurn : 0;
    canvas.text({row.centers[i] + (row.turned ? 4 : 0), top + 0.9 * style.size}, row.texts[i], turned);
  }
}

void draw_value(Canvas& canvas, const std::string& label, Position at, bool turned) {
  if (turned) {
    canvas.text({at.x + 0.35 * kValueSize, at.y}, label, {kValueSize, Anchor::start, kFaintInk, false, -90});
  } else {
    canvas.text(at, label, {kValueSize, Anchor::middle, kFaintInk});
  }
}

void draw_bar(Canvas& canvas, const Bars& panel, const Bar& bar, double center, const BarPlaces& places,
              const Mapping& map, Looks& looks) {
  const double width = places.bar_width;
  const bool stacked = panel.parts.size() > 1;
  double base = panel.y.scale == Scale::linear ? 0 : map.y_range.low;
  double height = 0;
  for (std::size_t p = 0; p < bar.parts.size(); ++p) {
    height += bar.parts[p];
    if (!showable(panel.y.scale, height) || bar.parts[p] <= 0) continue;
    const std::string color = (stacked ? looks.of(panel.parts[p]) : looks.of(bar.name, bar.color)).color;
    // The white edge tells neighbours of similar brightness apart.
    canvas.rectangle({center - width / 2, map.y(height)}, width, map.y(base) - map.y(height),
                     {color, "#ffffff", stacked ? 0.6 : 0.0, "", 1});
    base = height;
  }
  double top = showable(panel.y.scale, height) ? map.y(height) : bottom_of(map.area);
  if (bar.low && bar.high && showable(panel.y.scale, *bar.low)) {
    draw_error_bar(canvas, center, map.y(*bar.high), map.y(*bar.low), kInk);
    top = std::min(top, map.y(*bar.high));
  }
  if (bar.comparison && showable(panel.y.scale, *bar.comparison)) {
    const double y = map.y(*bar.comparison);
    canvas.diamond({center, y}, 5, {"#ffffff", kInk, 1.4, "", 1});
    top = std::min(top, y - 5);
  }
  if (panel.values)
    draw_value(canvas, value_label(panel.y.unit, height), {center, top - 4},
               values_turned(panel, places.slot));
}

/// How far a row's labels reach beyond the left edge of the area, from where their centers count.
double overhang(const LabelRow& row) {
  constexpr double kCosine = 0.788;
  double most = 0;
  for (std::size_t i = 0; row.turned && i < row.texts.size(); ++i) {
    most = std::max(most, kCosine * text_width(row.texts[i], kTickSize) - row.centers[i]);
  }
  return most;
}

Margins margins(const Bars& panel, const Ranges& ranges, double width, bool with_y_title) {
  Margins result;
  result.left =
      kTickGap + widest_y_label(panel.y, ranges.of_y(panel.y)) + (with_y_title ? kAxisTitle + 4 : 6);
  result.right = 8;
  const BarPlaces places = bar_places(panel, 0, width - result.left - result.right);
  result.top = title_height(panel.title);
  if (panel.values) result.top += values_turned(panel, places.slot) ? widest_value(panel) + 4 : kRow;
  const LabelRow bar_names = bar_name_row(panel, places), group_names = group_name_row(panel, places);
  result.left = std::max({result.left, overhang(bar_names), overhang(group_names)});
  result.bottom = kTickGap + bar_names.height + group_names.height + 4;
  return result;
}

void draw_panel(Canvas& canvas, const Bars& panel, const Area& area, double title_y, const Ranges& ranges,
                Looks& looks, bool with_y_title) {
  const Mapping map{area, Scale::linear, panel.y.scale, {0, 1}, ranges.of_y(panel.y)};
  draw_y_axis(canvas, panel.y, map, with_y_title);
  draw_title(canvas, panel.title, area, title_y);
  const BarPlaces places = bar_places(panel, area.corner.x, area.width);
  for (std::size_t g = 0; g < panel.groups.size(); ++g) {
    for (std::size_t b = 0; b < panel.groups[g].bars.size(); ++b) {
      draw_bar(canvas, panel, panel.groups[g].bars[b], places.centers[g][b], places, map, looks);
    }
  }
  draw_frame(canvas, area);
  const LabelRow names = bar_name_row(panel, places);
  const double below = bottom_of(area) + kTickGap;
  draw_label_row(canvas, names, below, {kTickSize, Anchor::middle, kFaintInk});
  draw_label_row(canvas, group_name_row(panel, places), below + names.height,
                 {kTickSize, Anchor::middle, kInk});
}

// ---- Scatter

double quantile(std::vector<double> values, double where) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(where * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The square that is shown.
struct View {
  double x, y, half;
};

View view_of(const Scatter& panel) {
  const std::size_t n = std::min(panel.x.size(), panel.y.size());
  if (n == 0) return {0, 0, 1};
  constexpr double kRoom = 1.03;
  if (panel.visible >= 1) {
    const auto [left, right] = std::minmax_element(panel.x.begin(), panel.x.end());
    const auto [bottom, top] = std::minmax_element(panel.y.begin(), panel.y.end());
    const double half = std::max(*right - *left, *top - *bottom) / 2;
    return {(*left + *right) / 2, (*bottom + *top) / 2, half > 0 ? kRoom * half : 1};
  }
  View view{quantile(panel.x, 0.5), quantile(panel.y, 0.5), 1};
  std::vector<double> distances(n);
  for (std::size_t i = 0; i < n; ++i) {
    distances[i] = std::max(std::abs(panel.x[i] - view.x), std::abs(panel.y[i] - view.y));
  }
  const double half = quantile(distances, panel.visible);
  if (half > 0) view.half = kRoom * half;
  return view;
}

Margins margins(const Scatter& panel, const Ranges&, double, bool) {
  return {6, 6, title_height(panel.title), panel.caption.empty() ? 6.0 : kRow + 8};
}

void draw_panel(Canvas& canvas, const Scatter& panel, const Area& whole, double title_y, const Ranges&,
                Looks& looks, bool) {
  const double side = std::min(whole.width, whole.height);
  const Area area{
      {whole.corner.x + (whole.width - side) / 2, whole.corner.y + (whole.height - side) / 2}, side, side};
  const View view = view_of(panel);
  const Mapping map{area,
                    Scale::linear,
                    Scale::linear,
                    {view.x - view.half, view.x + view.half},
                    {view.y - view.half, view.y + view.half}};
  draw_title(canvas, panel.title, area, title_y);
  canvas.begin_clip(area.corner, side, side);
  std::vector<Position> dots;
  for (std::size_t i = 0; i < std::min(panel.x.size(), panel.y.size()); ++i) {
    if (std::max(std::abs(panel.x[i] - view.x), std::abs(panel.y[i] - view.y)) > view.half) continue;
    dots.push_back({map.x(panel.x[i]), map.y(panel.y[i])});
  }
  const double radius =
      std::max(0.5, std::min(2.2, 0.16 * side / std::sqrt(static_cast<double>(dots.size()) + 1)));
  canvas.dots(dots, radius, kPalette[static_cast<std::size_t>(panel.color) % kPalette.size()], 0.75);
  for (const Series& series : panel.lines)
    draw_series(canvas, series, map, looks.of(series.name, series.color));
  canvas.end_clip();
  canvas.rectangle(area.corner, side, side, {"none", kFrame, 1, "", 1});
  canvas.text({area.corner.x + side / 2, bottom_of(area) + kRow + 2}, panel.caption,
              {kTickSize, Anchor::middle, kFaintInk});
}

}  // namespace

Look Looks::of(const std::string& name, std::optional<int> color) {
  const int next = static_cast<int>(numbers_.size());
  const int number = numbers_.emplace(name, next).first->second;
  const auto index = static_cast<std::size_t>(color.value_or(number));
  return {kPalette[index % kPalette.size()], number};
}

Ranges::Ranges(const std::vector<Panel>& panels) {
  for (const Panel& panel : panels) {
    std::visit([this](const auto& kind) { include(kind); }, panel);
  }
}

void Ranges::include(Extents& extents, const Axis& axis, double value, bool from_zero) {
  if (!showable(axis.scale, value)) return;
  Extent& extent = extents.emplace(axis.title, Extent{{value, value}, from_zero}).first->second;
  extent.data.low = std::min(extent.data.low, value);
  extent.data.high = std::max(extent.data.high, value);
}

void Ranges::include(const Lines& panel) {
  for (const Series& series : panel.series) {
    for (const double x : series.x) include(horizontal_, panel.x, x, false);
    for (const auto* values : {&series.y, &series.low, &series.high}) {
      for (const double y : *values) include(vertical_, panel.y, y, false);
    }
  }
  for (const Reference& reference : panel.references) {
    if (!reference.vertical) include(vertical_, panel.y, reference.at, false);
  }
}

void Ranges::include(const Bars& panel) {
  for (const BarGroup& group : panel.groups) {
    for (const Bar& bar : group.bars) {
      include(vertical_, panel.y, total(bar), true);
      for (const std::optional<double>& value : {bar.low, bar.high, bar.comparison}) {
        if (value) include(vertical_, panel.y, *value, true);
      }
    }
  }
}

Range Ranges::of(const Extents& extents, const Axis& axis) {
  const auto found = extents.find(axis.title);
  const Extent extent = found != extents.end() ? found->second : Extent{{1, 1}, false};
  Range range = range_around(axis.scale, extent.data, extent.from_zero);
  // A bar of the least value must be seen too.
  if (axis.scale != Scale::linear && extent.from_zero) range.low = extent.data.low / 3;
  if (axis.low) range.low = *axis.low;
  if (axis.high) range.high = *axis.high;
  return range;
}

Margins margins_of(const Panel& panel, const Ranges& ranges, double width, bool with_y_title) {
  return std::visit([&](const auto& kind) { return margins(kind, ranges, width, with_y_title); }, panel);
}

void draw(Canvas& canvas, const Panel& panel, const Area& area, double title_y, const Ranges& ranges,
          Looks& looks, bool with_y_title) {
  std::visit([&](const auto& kind) { draw_panel(canvas, kind, area, title_y, ranges, looks, with_y_title); },
             panel);
}

}  // namespace flaunay::bench::plot
