#include "plot.hpp"

#include <algorithm>
#include <set>

#include "io/file.hpp"
#include "panels.hpp"

namespace flaunay::bench::plot {
namespace {

constexpr double kEdge = 20, kPanelGap = 22;
constexpr double kTitleSize = 17, kSubtitleSize = 12;
constexpr double kLegendRow = 20, kEntryGap = 20;

struct Entry {
  enum class Kind { series, bar, comparison } kind;
  std::string name;
  Look look;
  Stroke stroke = Stroke::solid;
  bool marker = false;
};

double swatch_width(const Entry& entry) {
  switch (entry.kind) {
    case Entry::Kind::series:
      return 26;
    case Entry::Kind::bar:
      return 18;
    case Entry::Kind::comparison:
      break;
  }
  return 12;
}

double entry_width(const Entry& entry) {
  return swatch_width(entry) + 6 + text_width(entry.name, kLabelSize) + kEntryGap;
}

/// Every name of the figure once, in order of first use.
class Legend {
 public:
  Legend(const std::vector<Panel>& panels, Looks& looks) : looks_(looks) {
    for (const Panel& panel : panels) {
      std::visit([this](const auto& kind) { add(kind); }, panel);
    }
  }

  double height(double width) const {
    return entries_.empty() ? 0 : kLegendRow * static_cast<double>(rows(width).size()) + 6;
  }

  void draw(Canvas& canvas, double left, double top, double width) const {
    double y = top;
    for (const std::vector<Entry>& row : rows(width)) {
      double x = left;
      for (const Entry& entry : row) {
        draw_swatch(canvas, entry, x, y + kLegendRow / 2);
        canvas.text({x + swatch_width(entry) + 6, y + kLegendRow / 2 + 0.35 * kLabelSize}, entry.name,
                    {kLabelSize});
        x += entry_width(entry);
      }
      y += kLegendRow;
    }
  }

 private:
  void add(Entry entry) {
    if (!entry.name.empty() && names_.insert(entry.name).second) entries_.push_back(std::move(entry));
  }
  void add(const Series& series) {
    add({Entry::Kind::series, series.name, looks_.of(series.name, series.color), series.stroke,
         series.markers});
  }
  void add(const Lines& panel) {
    for (const Series& series : panel.series) add(series);
  }
  void add(const Scatter& panel) {
    for (const Series& series : panel.lines) add(series);
  }
  void add(const Bars& panel) {
    if (panel.parts.size() > 1) {
      for (const std::string& part : panel.parts) add({Entry::Kind::bar, part, looks_.of(part)});
    } else {
      for (const BarGroup& group : panel.groups) {
        for (const Bar& bar : group.bars) add({Entry::Kind::bar, bar.name, looks_.of(bar.name, bar.color)});
      }
    }
    add({Entry::Kind::comparison, panel.comparison_name, {kInk, 0}});
  }

  std::vector<std::vector<Entry>> rows(double width) const {
    std::vector<std::vector<Entry>> result;
    double used = width;
    for (const Entry& entry : entries_) {
      const double wanted = entry_width(entry);
      if (result.empty() || used + wanted - kEntryGap > width) {
        result.emplace_back();
        used = 0;
      }
      result.back().push_back(entry);
      used += wanted;
    }
    return result;
  }

  static void draw_swatch(Canvas& canvas, const Entry& entry, double x, double y) {
    const double width = swatch_width(entry), center = x + width / 2;
    switch (entry.kind) {
      case Entry::Kind::series:
        if (entry.stroke != Stroke::none) {
          canvas.line({x, y}, {x + width, y},
                      {"none", entry.look.color, 1.8, entry.stroke == Stroke::dashed ? "6 4" : "", 1});
        }
        if (entry.marker) canvas.marker(entry.look.marker, {center, y}, 3.6, entry.look.color);
        break;
      case Entry::Kind::bar:
        canvas.rectangle({x, y - 6}, width, 12, {entry.look.color, "none", 1, "", 1});
        break;
      case Entry::Kind::comparison:
        canvas.diamond({center, y}, 5, {"#ffffff", kInk, 1.4, "", 1});
        break;
    }
  }

  Looks& looks_;
  std::set<std::string> names_;
  std::vector<Entry> entries_;
};

const Axis* y_axis(const Panel& panel) {
  if (const auto* lines = std::get_if<Lines>(&panel)) return &lines->y;
  if (const auto* bars = std::get_if<Bars>(&panel)) return &bars->y;
  return nullptr;
}

/// Where the panels of a figure stand, and how much room they have.
struct Grid {
  std::size_t columns = 1, rows = 1;
  double panel_width = 0, panel_height = 0;
  bool one_y_title = false;  // shown in the first column only
  Margins margins;           // the same for all, so that the areas of a row and of a column line up
};

std::size_t choose_columns(const Figure& figure) {
  const std::size_t n = figure.panels.size();
  if (figure.columns > 0) return std::min(figure.columns, std::max<std::size_t>(n, 1));
  const bool pictures = n > 0 && std::holds_alternative<Scatter>(figure.panels.front());
  if (n <= (pictures ? 4u : 3u)) return std::max<std::size_t>(n, 1);
  return n == 4 ? 2 : 3;
}

bool share_y_title(const std::vector<Panel>& panels) {
  for (const Panel& panel : panels) {
    const Axis *first = y_axis(panels.front()), *other = y_axis(panel);
    if (first == nullptr || other == nullptr || first->title != other->title) return false;
  }
  return true;
}

Grid layout(const Figure& figure, const Ranges& ranges) {
  Grid grid;
  grid.columns = choose_columns(figure);
  grid.rows = (figure.panels.size() + grid.columns - 1) / grid.columns;
  const bool pictures = !figure.panels.empty() && std::holds_alternative<Scatter>(figure.panels.front());
  const double widths[] = {740, 440, 350};
  grid.panel_width = figure.panel_width > 0 ? figure.panel_width
                     : pictures             ? 250
                                            : widths[std::min<std::size_t>(grid.columns, 3) - 1];
  grid.one_y_title = share_y_title(figure.panels);
  for (const Panel& panel : figure.panels) {
    const Margins own = margins_of(panel, ranges, grid.panel_width, true);
    grid.margins.left = std::max(grid.margins.left, own.left);
    grid.margins.right = std::max(grid.margins.right, own.right);
    grid.margins.top = std::max(grid.margins.top, own.top);
    grid.margins.bottom = std::max(grid.margins.bottom, own.bottom);
  }
  const double vertical = grid.margins.top + grid.margins.bottom;
  const double square = grid.panel_width - grid.margins.left - grid.margins.right + vertical;
  const double area = grid.columns == 1 ? 340 : grid.columns == 2 ? 250 : 220;
  grid.panel_height = figure.panel_height > 0 ? figure.panel_height : pictures ? square : area + vertical;
  return grid;
}

double height_of(const std::string& text, double size) { return text.empty() ? 0 : size + 9; }

}  // namespace

std::string render(const Figure& figure) {
  const Ranges ranges(figure.panels);
  const Grid grid = layout(figure, ranges);
  Looks looks;
  const Legend legend(figure.panels, looks);
  const auto columns = static_cast<double>(grid.columns), rows = static_cast<double>(grid.rows);
  const double text_needs =
      std::max(text_width(figure.title, 1.07 * kTitleSize), text_width(figure.subtitle, kSubtitleSize));
  const double panels_width = columns * grid.panel_width + (columns - 1) * kPanelGap;
  const double width = std::max(panels_width, text_needs) + 2 * kEdge;
  const double panels_left = (width - panels_width) / 2;
  const double legend_top =
      kEdge + height_of(figure.title, kTitleSize) + height_of(figure.subtitle, kSubtitleSize);
  const double panels_top = legend_top + legend.height(width - 2 * kEdge);
  const double height = panels_top + rows * grid.panel_height + (rows - 1) * kPanelGap + kEdge;

  Canvas canvas(width, height);
  canvas.text({kEdge, kEdge + 0.8 * kTitleSize}, figure.title, {kTitleSize, Anchor::start, kInk, true});
  canvas.text({kEdge, kEdge + height_of(figure.title, kTitleSize) + 0.8 * kSubtitleSize}, figure.subtitle,
              {kSubtitleSize, Anchor::start, kFaintInk});
  legend.draw(canvas, kEdge, legend_top, width - 2 * kEdge);
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const std::size_t column = p % grid.columns, row = p / grid.columns;
    const Margins& margins = grid.margins;
    const Area area{
        {panels_left + static_cast<double>(column) * (grid.panel_width + kPanelGap) + margins.left,
         panels_top + static_cast<double>(row) * (grid.panel_height + kPanelGap) + margins.top},
        grid.panel_width - margins.left - margins.right,
        grid.panel_height - margins.top - margins.bottom};
    draw(canvas, figure.panels[p], area, area.corner.y - margins.top + kTitleBase, ranges, looks,
         column == 0 || !grid.one_y_title);
  }
  return canvas.finish();
}

void write(const std::string& path, const Figure& figure) {
  const std::string text = render(figure);
  io::OutputFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace flaunay::bench::plot
