// Figures for benchmarks, written as SVG without any library. A figure is a grid of panels under one title
// and one legend; a panel has lines, bars, or a cloud of points. Everything is data: fill the structs, call
// write.
//
//   plot::Lines panel;
//   panel.title = "uniform";
//   panel.x = {"points", plot::Scale::log2};
//   panel.y = {"time per point", plot::Scale::log10, plot::Unit::seconds};
//   panel.series = {{"flattened", sizes, medians, minima, maxima}};
//   plot::Figure figure;
//   figure.title = "Time by mode";
//   figure.panels = {panel};
//   plot::write("modes.svg", figure);
//
// Series, bars and parts of the same name have the same colour and marker in all panels of a figure, and one
// entry in its legend, which stands between title and panels. All texts may contain ^{superscripts} and
// _{subscripts}.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace flaunay::bench::plot {

enum class Scale { linear, log2, log10 };

/// What ticks are labelled with. Prefixes are chosen for each tick: 1 ms, 20 MB, 300k.
enum class Unit { none, seconds, bytes, percent };

struct Axis {
  std::string title;  ///< with its unit in brackets, unless Unit puts it on the ticks
  Scale scale = Scale::linear;
  Unit unit = Unit::none;
  /// The range; what is not set comes from the data. A linear axis of bars, and one whose data come near to
  /// 0, begins at 0. Unset ranges are common to all panels of a figure whose axes have the same title.
  std::optional<double> low = {}, high = {};
};

enum class Stroke { solid, dashed, none };

/// For what all colours are held against.
constexpr int kInkColor = 8;

/// How low..high is drawn.
enum class Spread { band, bars };

/// A value of y for each x, in order of x. NaN interrupts the line; so does what a log scale cannot show.
struct Series {
  std::string name;  ///< empty: not in the legend
  std::vector<double> x, y;
  std::vector<double> low = {}, high = {};  ///< empty, or one per x, such as minimum and maximum
  Spread spread = Spread::band;
  Stroke stroke = Stroke::solid;
  bool markers = true;
  /// Index into the palette, whose entry kInkColor is nearly black; series of one colour differ by stroke or
  /// marker. Unset: by order of names.
  std::optional<int> color = {};
};

/// A line across the panel, with a label at its end: a crossover, a limit, a published value.
struct Reference {
  std::string label;
  double at = 0;
  bool vertical = true;
};

struct Lines {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Reference> references;
};

/// One bar: its parts are stacked from below. Several parts need a linear axis.
struct Bar {
  std::string name;
  std::vector<double> parts;
  std::optional<double> low = {}, high = {};  ///< spread of the whole bar
  std::optional<double> comparison = {};      ///< drawn as a diamond, such as a published value
  std::optional<int> color = {};              ///< of a bar with one part, as Series::color
};

struct BarGroup {
  std::string name;
  std::vector<Bar> bars;
};

/// Groups of bars. With one part a bar is coloured by its own name; with several each part by its own, and
/// the bars' names stand below them.
struct Bars {
  std::string title;
  Axis y;
  std::vector<std::string> parts;  ///< names, from below; empty if each bar has one
  std::vector<BarGroup> groups;
  std::string comparison_name;  ///< of Bar::comparison, for the legend
  bool values = false;          ///< writes each bar's height above it
};

/// Points as small dots, the same scale for x and y, without ticks; lines over them.
struct Scatter {
  std::string title;
  std::string caption;  ///< below the panel
  std::vector<double> x, y;
  /// The share of points that must be visible: the view is the square around the medians that holds so many.
  double visible = 1;
  int color = 0;  ///< index into the palette
  /// Drawn as lines without markers, unless a series asks for markers; may be closed or turn back in x.
  std::vector<Series> lines;
};

using Panel = std::variant<Lines, Bars, Scatter>;

struct Figure {
  std::string title;
  std::string subtitle;  ///< what was measured and on what; may be empty
  std::vector<Panel> panels;
  std::size_t columns = 0;  ///< of panels; 0: all side by side up to three, else two or three
  double panel_width = 0;   ///< pixels with its labels; 0 chooses by number and kind of panels
  double panel_height = 0;  ///< as above
};

/// The figure as the text of an SVG file.
std::string render(const Figure& figure);

/// Throws Error(input) if path cannot be written.
void write(const std::string& path, const Figure& figure);

}  // namespace flaunay::bench::plot
