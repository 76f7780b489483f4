#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/errors.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/files/formats.hpp"
#include "app/files/layers.hpp"
#include "app/files/points.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

namespace {

struct VoronoiRequest {
  std::string input, output, crs, device;
  io::Columns columns;
  std::vector<double> bounds;  // least x and y, largest x and y; empty: around the points
  bool quiet = false;
};

// The box of the points, with a margin of a tenth of its longer side.
std::vector<double> box_around(const io::Points& points) {
  std::array<double, 2> low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
  for (std::size_t i = 0; i < points.coordinates.size(); ++i) {
    low[i % 2] = std::min(low[i % 2], points.coordinates[i]);
    high[i % 2] = std::max(high[i % 2], points.coordinates[i]);
  }
  constexpr double kShare = 0.1;
  const double side = std::max(high[0] - low[0], high[1] - low[1]);
  const double margin = side > 0 ? kShare * side : 1;
  return {low[0] - margin, low[1] - margin, high[0] + margin, high[1] + margin};
}

io::Layer layer_of(const io::Points& points, const ClippedVoronoi& cells,
                   const std::vector<std::size_t>& owners) {
  io::Layer layer;
  layer.name = "cells";
  layer.is_polygons = true;
  layer.crs = points.crs;
  layer.size = owners.size();
  layer.append = [&](std::size_t cell, std::vector<double>& positions) {
    const std::size_t point = owners[cell];
    const auto first = static_cast<std::size_t>(cells.offsets[point]);
    const auto last = static_cast<std::size_t>(cells.offsets[point + 1]);
    for (std::size_t k = first; k <= last; ++k) {
      const std::size_t v = k < last ? k : first;
      positions.insert(positions.end(), {cells.vertices[2 * v], cells.vertices[2 * v + 1], 0.0});
    }
  };
  const auto field_of = [&](const std::string& name, const auto& values, const io::FieldValue& type) {
    return io::Layer::Field{name, type, [&](std::size_t cell) { return values[owners[cell]]; }};
  };
  std::vector<io::Layer::Field> given;
  for (const io::PointField& field : points.fields)
    given.push_back(field_of(field.name, field.values, io::common_type(field.values)));
  layer.fields = {{io::own_name("point", given), std::int64_t{0},
                   [&](std::size_t cell) { return static_cast<std::int64_t>(owners[cell]); }},
                  field_of(io::own_name("area", given), cells.areas, 0.0)};
  if (!points.heights.empty())
    layer.fields.push_back(field_of(io::own_name("z", given), points.heights, 0.0));
  layer.fields.insert(layer.fields.end(), given.begin(), given.end());
  return layer;
}

int voronoi(const VoronoiRequest& request) {
  io::format_of(request.input, io::Use::read_points);
  io::check_columns(request.input, request.columns);
  io::format_of(request.output, io::Use::write_features);
  OutputFiles outputs({io::without_layer(request.input)});
  outputs.add_mesh(request.output);
  Progress progress(!request.quiet);
  const Stopwatch stopwatch;
  progress.update("reading");
  io::Points points = io::read_points(request.input, request.columns, true);
  if (points.size() == 0) throw Error(ErrorKind::input, fmt::format("{}: has no points", request.input));
  io::choose_crs(request.crs, request.input, request.output, points.crs);
  const std::vector<double> box = request.bounds.empty() ? box_around(points) : request.bounds;
  const double corners[] = {box[0], box[1], box[2], box[1], box[2], box[3], box[0], box[3]};
  progress.update_slow("preparing the device", kCompiling);
  Triangulator triangulator(request.device);
  progress.update("triangulating");
  const double* const coordinates = points.coordinates.data();
  const ClippedVoronoi cells = triangulator.clipped_voronoi(
      coordinates, points.size(), triangulator.triangulate(coordinates, points.size()), corners, 4);
  std::vector<std::size_t> owners;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cells.offsets[i] < cells.offsets[i + 1]) owners.push_back(i);
  }
  progress.update("writing");
  io::write_layer(outputs, request.output, layer_of(points, cells, owners));
  outputs.commit();
  progress.finish();
  if (!request.quiet)
    print(notes_text(points.notes) + notes_text(outputs.notes) +
          fmt::format("{} points, {} cells, {:.3g} s\n", points.size(), owners.size(), stopwatch.seconds()));
  return kSuccess;
}

}  // namespace

void add_voronoi(CLI::App& app, Action& action) {
  auto request = std::make_shared<VoronoiRequest>();
  CLI::App* command =
      app.add_subcommand("voronoi", "Write the Voronoi cells of points, as polygons in a box");
  add_input(command, request->input, request->columns);
  add_heights(command, request->columns);
  add_fields(command, request->columns,
             "Fields of points that cells have, too, from a layer, GeoJSON or text");
  add_crs(command, request->crs);
  end_group(command, "Input");
  add_path(command, "-o,--output", request->output,
           fmt::format("Polygons with the number of their point, and their area: {}",
                       io::endings_for(io::Use::write_features)))
      ->required();
  command
      ->add_option(
          "--bounds", request->bounds,
          "XMIN,YMIN,XMAX,YMAX: where cells end; default: the box of the points, and a tenth of it around")
      ->delimiter(',')
      ->expected(4);
  end_group(command, "Outputs");
  add_device(command, request->device);
  add_quiet(command, request->quiet);
  end_group(command, "Work");
  command->footer(examples({"flaunay voronoi points.csv -o cells.geojson",
                            "flaunay voronoi wells.csv --fields name,ph -o cells.gpkg"}));
  command->callback([request, command, &action] {
    check_fields(*command, request->input);
    const std::vector<double>& box = request->bounds;
    if (!box.empty() && !(box[0] < box[2] && box[1] < box[3]))
      fail_usage("--bounds: the lower ones must come first, and be lower");
    action = [request] { return voronoi(*request); };
  });
}

}  // namespace flaunay::cli
