// Pictures of rasters: shaded hills, in grey or in colours by height.
#include <algorithm>
#include <array>
#include <cmath>

#include "derived/raster/raster.hpp"
#include "geometry/arguments.hpp"

namespace flaunay {
namespace {

// Half the difference of a pixel's neighbours; at the border, that to the only neighbour.
double slope(const double* pixel, std::size_t i, std::size_t count, std::ptrdiff_t step) {
  if (count < 2) return 0;
  if (i == 0) return pixel[step] - pixel[0];
  if (i == count - 1) return pixel[0] - pixel[-step];
  return (pixel[step] - pixel[-step]) / 2;
}

std::array<double, 2> range_of(const double* pixels, std::size_t count) {
  std::array<double, 2> range = {HUGE_VAL, -HUGE_VAL};
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isfinite(pixels[i])) range = {std::min(range[0], pixels[i]), std::max(range[1], pixels[i])};
  }
  return range;
}

// From green valleys over yellow and brown to white peaks. share: of the way from the lowest to the highest.
std::array<double, 3> relief(double share) {
  constexpr std::array<std::array<double, 3>, 5> kColors = {
      {{90, 150, 95}, {170, 195, 120}, {240, 225, 160}, {180, 130, 90}, {250, 248, 245}}};
  const double at = share * (kColors.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), kColors.size() - 2);
  std::array<double, 3> color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = kColors[k][c] + (at - static_cast<double>(k)) * (kColors[k + 1][c] - kColors[k][c]);
  return color;
}

// By which slopes in x and y are multiplied in a row at this y.
std::array<double, 2> factors_at(double y, const ShadingOptions& options) {
  if (!options.is_geographic) return {options.vertical_factor, options.vertical_factor};
  // Of a sphere as large as the Earth.
  constexpr double kMetresPerDegree = 111195, kDegree = 0.017453292519943295, kLeast = 1e-3;
  const double by_y = options.vertical_factor / kMetresPerDegree;
  return {by_y / std::max(std::cos(y * kDegree), kLeast), by_y};
}

}  // namespace

void shade_hills(const RasterGrid& grid, const double* pixels, const ShadingOptions& options,
                 std::uint8_t* picture) {
  constexpr double kWhite = 255, kRoot = 1.4142135623730951;
  const std::size_t rows = grid.rows, columns = grid.columns, count = raster::checked_pixels(grid, {});
  if (!(options.vertical_factor > 0 && std::isfinite(options.vertical_factor))) {
    throw Error(ErrorKind::usage,
                fmt::format("vertical_factor = {} must be positive", options.vertical_factor));
  }
  check_array(pixels, count, "pixels", kMostCountable);
  check_array(picture, count, "bytes of the picture", kMostCountable);
  const std::size_t bands = options.colors ? 4 : 2;
  const auto [low, high] = range_of(pixels, count);
  const double extent = high / 2 - low / 2;  // halves, whose difference is finite
  std::fill_n(picture, bands * count, std::uint8_t{0});
  for (std::size_t row = 0; row < rows; ++row) {
    const auto [by_x, by_y] = factors_at(grid.y + static_cast<double>(row) * grid.dy, options);
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * columns + column;
      const double x = by_x * slope(pixels + i, column, columns, 1) / grid.dx;
      const double y = by_y * slope(pixels + i, row, rows, static_cast<std::ptrdiff_t>(columns)) / grid.dy;
      const double light = (1 + x / kRoot - y / kRoot) / std::sqrt(2 * (1 + x * x + y * y));
      if (!std::isfinite(light) || !std::isfinite(pixels[i])) continue;
      const double grey = std::clamp(light, 0.0, 1.0);
      const std::array<double, 3> color = relief(extent > 0 ? (pixels[i] / 2 - low / 2) / extent : 0);
      for (std::size_t band = 0; band + 1 < bands; ++band) {
        // What is level has its own colour.
        const double value =
            options.colors ? std::min(color[band] * (1 + kRoot * grey) / 2, kWhite) : kWhite * grey;
        picture[band * count + i] = static_cast<std::uint8_t>(value);
      }
      picture[(bands - 1) * count + i] = static_cast<std::uint8_t>(kWhite);
    }
  }
}

}  // namespace flaunay
