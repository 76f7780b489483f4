// Drawing each kind of panel into its place in a figure.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "plot.hpp"
#include "ticks.hpp"

namespace flaunay::bench::plot {

/// The base line of a panel's title, below the panel's upper edge.
constexpr double kTitleBase = 14;
constexpr double kPanelTitleSize = 13, kLabelSize = 12, kTickSize = 11;
constexpr const char* kInk = "#222222";
constexpr const char* kFaintInk = "#555555";

/// Colour and marker of a name.
struct Look {
  std::string color;
  int marker;
};

/// Gives each name its own look, in order of first use.
class Looks {
 public:
  Look of(const std::string& name, std::optional<int> color = {});

 private:
  std::map<std::string, int> numbers_;
};

/// The ranges of all axes of a figure: axes of the same title share theirs.
class Ranges {
 public:
  explicit Ranges(const std::vector<Panel>& panels);
  Range of_x(const Axis& axis) const { return of(horizontal_, axis); }
  Range of_y(const Axis& axis) const { return of(vertical_, axis); }

 private:
  struct Extent {
    Range data;
    bool from_zero;
  };
  using Extents = std::map<std::string, Extent>;
  static Range of(const Extents& extents, const Axis& axis);
  static void include(Extents& extents, const Axis& axis, double value, bool from_zero);
  void include(const Lines& panel);
  void include(const Bars& panel);
  void include(const Scatter&) {}

  Extents horizontal_, vertical_;
};

/// Room around the area in which data are drawn, for titles and labels.
struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;
};

/// The area in which data are drawn.
struct Area {
  Position corner;
  double width, height;
};

/// width: of the whole panel. with_y_title: whether the title of the vertical axis is shown.
Margins margins_of(const Panel& panel, const Ranges& ranges, double width, bool with_y_title);

/// title_y: base line of the panel's title, the same for all panels of a row.
void draw(Canvas& canvas, const Panel& panel, const Area& area, double title_y, const Ranges& ranges,
          Looks& looks, bool with_y_title);

}  // namespace flaunay::bench::plot
