// flaunay terrain: from measured heights to a map.
#include "flaunay/terrain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/errors.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/terrain_boundary.hpp"
#include "app/command/terrain_files.hpp"
#include "app/command/terrain_mesh.hpp"
#include "app/files/formats.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/layers.hpp"
#include "app/files/map.hpp"
#include "app/files/scan.hpp"
#include "files/file.hpp"
#include "files/scratch.hpp"
#include "host/memory/system_memory.hpp"
#include "host/system/pages.hpp"

namespace flaunay::cli {
namespace {

using Returns = io::ScanChoice::Returns;

// The most pixels of a picture, which takes two bytes per pixel of memory.
constexpr std::size_t kMostPicturePixels = std::size_t{1} << 28;

struct TerrainRequest {
  std::vector<std::string> inputs, outputs;
  double resolution = 0;
  std::vector<double> bounds;
  std::vector<int> classes;
  Returns returns = Returns::all;
  Duplicates duplicates = Duplicates::highest;
  std::string breaklines, boundary, flat, crs;
  std::vector<std::string> line_heights;  // fields of breaklines
  Crossings crossings = Crossings::error;
  io::Columns columns;
  std::vector<double> contours;
  RasterOptions raster;
  bool is_point = false;
  double nodata = -9999;
  ShadingOptions shading;
  std::string device, scratch;
  std::uint64_t memory = 0;
  bool quiet = false;
};

// The pixels' memory, or if it would take more than a quarter of the memory, a file.
class Pixels {
 public:
  Pixels(std::size_t count, std::uint64_t memory, const std::string& scratch)
      : bytes_(count * sizeof(double)) {
    if (bytes_ <= memory / 4) {
      in_memory_.reset(new double[count]);
      return;
    }
    const std::string folder = io::scratch_folder(scratch);
    if (io::free_bytes(folder) < bytes_) {
      throw Error(ErrorKind::input,
                  fmt::format("{} pixels need {} in {}, which has {}", count, host::mebibytes(bytes_), folder,
                              host::mebibytes(io::free_bytes(folder))));
    }
    on_disk_ = static_cast<double*>(system::allocate_on_disk(folder, bytes_));
    if (on_disk_ != nullptr) return;
    throw Error(
        ErrorKind::input,
        fmt::format("{} pixels need {}, more than a quarter of the memory, and cannot be kept in {}{}", count,
                    host::mebibytes(bytes_), folder, errno != 0 ? ": " + io::system_reason(errno) : ""));
  }
  Pixels(const Pixels&) = delete;
  Pixels& operator=(const Pixels&) = delete;
  ~Pixels() {
    if (on_disk_ != nullptr) system::free_on_disk(on_disk_, bytes_);
  }

  double* data() { return on_disk_ != nullptr ? on_disk_ : in_memory_.get(); }
  std::uint64_t bytes_in_memory() const { return on_disk_ != nullptr ? 0 : bytes_; }

 private:
  std::size_t bytes_;
  std::unique_ptr<double[]> in_memory_;
  double* on_disk_ = nullptr;
};

io::ScanChoice choice_of(const TerrainRequest& request) {
  io::ScanChoice choice;
  for (const int number : request.classes) choice.classes.set(static_cast<std::size_t>(number));
  choice.returns = request.returns;
  return choice;
}

// The points that were left out, for messages; empty if none were.
std::string left_out_text(const io::LeftOut& left_out) {
  std::string text;
  if (left_out.withheld > 0) text += fmt::format(", without {} withheld ones", left_out.withheld);
  if (left_out.noise > 0) text += fmt::format(", without {} of noise", left_out.noise);
  return text;
}

// The system of all points: what the user says, or else what the files have.
std::string common_crs(const TerrainRequest& request, const io::Scan& scan) {
  if (!request.crs.empty()) return io::crs_text(request.crs);
  const std::vector<io::Scan::System> systems = scan.systems();
  for (const io::Scan::System& system : systems) {
    if (io::is_same_crs(system.crs, systems.front().crs)) continue;
    throw Error(
        ErrorKind::input,
        io::printable(fmt::format("{} and {} have different coordinate systems, {} and {}: reproject one of "
                                  "them, or say by --crs what both have",
                                  systems.front().path, system.path, systems.front().crs, system.crs)));
  }
  if (systems.empty()) return "";
  std::string crs = systems.front().crs;
  for (const std::string& output : request.outputs) io::choose_crs("", systems.front().path, output, crs);
  return crs;
}

// Throws Error(input) if a map lies where no points are, or names another system of coordinates, unless the
// user says which one all have.
void check_place(const char* option, const std::string& path, const io::Map& map, const io::Box& points,
                 const std::string& crs, bool is_asked) {
  if (path.empty() || map.points.size() == 0) return;
  const std::string name = fmt::format("{}: {}", option, path);
  if (!is_asked) io::check_same_crs(name, map.points.crs, "the points", crs);
  io::Box box = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (std::size_t i = 0; i < map.points.coordinates.size(); ++i) {
    const double value = map.points.coordinates[i];
    box[i % 2] = std::min(box[i % 2], value);
    box[i % 2 + 2] = std::max(box[i % 2 + 2], value);
  }
  if (box[0] <= points[2] && points[0] <= box[2] && box[1] <= points[3] && points[1] <= box[3]) return;
  io::fail(name,
           "reaches from ({}, {}) to ({}, {}), but the points from ({}, {}) to ({}, {}): both must have the "
           "same coordinate system",
           box[0], box[1], box[2], box[3], points[0], points[1], points[2], points[3]);
}

using Range = std::array<double, 2>;

Range with_heights(Range range, const std::vector<double>& heights) {
  for (const double height : heights) range = {std::min(range[0], height), std::max(range[1], height)};
  return range;
}

// The heights of contours: those that were given, or if it is one, all multiples of it in the range.
std::vector<double> contour_heights(const std::vector<double>& given, const Range& range) {
  if (given.size() != 1) return given;
  const double step = given.front();
  constexpr double kMost = 1e6;
  if ((range[1] - range[0]) / step > kMost) {
    fail_usage(
        fmt::format("--contours {}: between {} and {} are more than a million", step, range[0], range[1]));
  }
  std::vector<double> heights;
  for (double k = std::ceil(range[0] / step); k <= std::floor(range[1] / step); ++k)
    heights.push_back(k * step);
  return heights;
}

// Errors in the request and in the outputs are found before the points are read.
int make_terrain(TerrainRequest request) {
  const std::vector<std::string> scans = io::scan_files(request.inputs);
  std::vector<std::string> inputs = scans;
  for (const std::string& map : {request.boundary, request.breaklines, request.flat}) {
    if (!map.empty()) inputs.push_back(map);
  }
  for (std::string& input : inputs) input = io::without_layer(input);
  const TerrainFiles files(request.outputs);
  if (!files.lines.empty() && request.contours.empty())
    fail_usage(fmt::format("{}: needs --contours, the interval of heights", files.lines.front()));
  if (files.pictures.empty() && (request.shading.colors || request.shading.vertical_factor != 1))
    fail_usage("--colors and --vertical-factor: need an output .png");
  if (files.lines.empty() && !request.contours.empty())
    fail_usage("--contours: needs an output .geojson, .gpkg, .shp or .fgb");
  OutputFiles outputs(inputs);
  for (const std::string& path : request.outputs) {
    const bool is_mesh = io::find_format(path, io::Use::write_mesh) != nullptr;
    for (const std::string& file : is_mesh ? io::mesh_files(path) : std::vector{path}) outputs.announce(file);
  }
  HardEdges edges(request.breaklines, request.flat, request.columns, request.line_heights, request.crossings);
  const bool in_memory = !edges.has_heights() || !request.flat.empty() || !files.meshes.empty();
  if (in_memory && request.memory != 0) {
    fail_usage(
        "--memory: with --flat, a file of triangles or breaklines without heights, all points are in memory "
        "at once, about 200 bytes each");
  }
  io::Map area;
  std::optional<Boundary> boundary;
  if (!request.boundary.empty()) {
    area = io::read_map(request.boundary);
    boundary.emplace(request.boundary, area);
  }

  Progress progress(!request.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  io::Scan scan(scans, choice_of(request), request.scratch, request.columns);
  if (!request.columns.heights.empty() && !scan.has_height_field() && !edges.has_height_field) {
    throw Error(ErrorKind::input, fmt::format("no layer has a field {}, of --height",
                                              fmt::join(request.columns.heights, " or ")));
  }
  const std::string crs = common_crs(request, scan);
  request.shading.is_geographic = !files.pictures.empty() && !crs.empty() && io::is_geographic(crs);
  std::optional<io::Box> bounds;
  if (!request.bounds.empty()) {
    bounds.emplace();
    std::copy_n(request.bounds.begin(), bounds->size(), bounds->begin());
  }
  const auto grid_over = [&](const io::Box& box) {
    const PixelGrid grid(box, request.resolution, request.is_point);
    if (!files.pictures.empty() && grid.count() > kMostPicturePixels) {
      fail_usage(fmt::format("{}: a picture of {} x {} pixels; at most {} are possible",
                             files.pictures.front(), grid.pixels.columns, grid.pixels.rows,
                             kMostPicturePixels));
    }
    return grid;
  };
  // To find now what would be found after the pass over all points.
  const io::Box announced = bounds ? *bounds : scan.announced_box();
  if (announced[0] <= announced[2]) grid_over(announced);

  const io::Box box = scan.survey([&](double done) { progress.update("reading", -1, done); });
  const std::string left_out = left_out_text(scan.left_out());
  if (scan.size() == 0) {
    throw Error(ErrorKind::input,
                fmt::format("there are no points{}{}",
                            request.classes.empty()
                                ? ""
                                : fmt::format(" of the classes {}", fmt::join(request.classes, ", ")),
                            left_out));
  }
  const bool is_asked = !request.crs.empty();
  check_place("--breaklines", request.breaklines, edges.lines, box, crs, is_asked);
  check_place("--flat", request.flat, edges.lakes, box, crs, is_asked);
  check_place("--boundary", request.boundary, area, box, crs, is_asked);
  const io::Box grid_box = bounds ? *bounds : box;
  const PixelGrid grid = grid_over(grid_box);
  const std::uint64_t memory = request.memory != 0 ? request.memory : host::memory_left().bytes / 2;
  Pixels pixels(grid.count(), memory, request.scratch);
  std::vector<double> heights;
  Contours contours;
  if (in_memory) {
    progress.update("triangulating");
    Triangulator triangulator(request.device);
    const TerrainMesh terrain = triangulate_scan(triangulator, scan, edges, request.duplicates);
    rasterize(triangulator, terrain.view(), terrain.heights.data(), grid.pixels, request.raster,
              pixels.data());
    heights = contour_heights(request.contours, with_heights({HUGE_VAL, -HUGE_VAL}, terrain.heights));
    if (!heights.empty()) {
      contours = trace_contours(triangulator, terrain.view(), terrain.heights.data(), heights,
                                request.raster.max_edge);
    }
    for (const std::string& path : files.meshes) {
      write_surface(outputs, path, terrain, request.raster.max_edge);
    }
  } else {
    ChunkOptions chunks;
    chunks.memory_bytes = memory - pixels.bytes_in_memory();
    chunks.scratch = request.scratch;
    if (!request.device.empty()) chunks.devices = {request.device};
    chunks.progress = [&](const std::string& stage, int, double done) { progress.update(stage, -1, done); };
    heights = contour_heights(request.contours, with_heights(scan.heights(), edges.lines.points.heights));
    naming_files({{"segment", edges.path}}, [&] {
      if (edges.crossings == Crossings::split) {
        Triangulator triangulator(request.device);
        edges.split(triangulator);
      }
      rasterize_chunks(scan, request.duplicates, grid.pixels, request.raster, pixels.data(), heights,
                       contours, edges.view(), chunks);
    });
  }
  if (boundary) {
    boundary->leave_out(grid.pixels, pixels.data());
    contours = boundary->clipped(contours);
  }

  progress.update("writing");
  for (const std::string& path : files.lines) io::write_lines(outputs, path, contours, heights, crs);
  for (const std::string& path : files.arrays) write_array(outputs, path, grid, pixels.data());
  for (const std::string& path : files.pictures)
    write_picture(outputs, path, grid, pixels.data(), request.shading);
  write_rasters(outputs, files.rasters, grid, request.nodata, crs, pixels.data());
  outputs.commit();
  progress.finish();
  if (!request.quiet) {
    std::string notes;
    if (grid_box[0] > box[2] || box[0] > grid_box[2] || grid_box[1] > box[3] || box[1] > grid_box[3]) {
      notes = fmt::format("note: no point is in --bounds: points reach from ({}, {}) to ({}, {})\n", box[0],
                          box[1], box[2], box[3]);
    }
    for (const io::Map* map : {&edges.lines, &edges.lakes, &area}) notes += notes_text(map->points.notes);
    print(notes + notes_text(outputs.notes) +
          fmt::format("{} points{}, {} x {} pixels, {:.3g} s\n", scan.size(), left_out, grid.pixels.columns,
                      grid.pixels.rows, stopwatch.seconds()));
  }
  return kSuccess;
}

void check(const TerrainRequest& request) {
  if (!(request.resolution > 0 && std::isfinite(request.resolution)))
    fail_usage(fmt::format("--resolution must be positive, not {}", request.resolution));
  if (!std::isfinite(request.nodata)) fail_usage("--nodata must be finite");
  const std::vector<double>& heights = request.contours;
  const bool are_finite =
      std::all_of(heights.begin(), heights.end(), [](double h) { return std::isfinite(h); });
  if (!are_finite || (heights.size() == 1 && !(heights.front() > 0)) ||
      std::adjacent_find(heights.begin(), heights.end(), std::greater_equal<>()) != heights.end()) {
    fail_usage("--contours: expected an interval above 0, or heights that increase");
  }
}

}  // namespace

void add_terrain(CLI::App& app, Action& action) {
  auto request = std::make_shared<TerrainRequest>();
  CLI::App* command =
      app.add_subcommand("terrain", "Make a raster of measured heights, such as those of a laser scan");
  command
      ->add_option("inputs", request->inputs,
                   "Points: .las, .npy of shape (n, 3), text with x, y and z (.txt, .xyz, .csv), folders "
                   "of these; points or lines of .gpkg, .shp, .fgb and .geojson")
      ->required();
  command
      ->add_option("-o,--output", request->outputs,
                   "The raster: .tif (cloud-optimised GeoTIFF of float32), .npy (float64) or .png (shaded "
                   "hills); contours: .geojson, .gpkg, .shp or .fgb; the triangles: .obj, .ply, .off, .msh "
                   "or .vtu; several "
                   "outputs are all written or none")
      ->required();
  command->add_option("--resolution", request->resolution, "The size of a pixel")->required();
  command
      ->add_option("--bounds", request->bounds,
                   "XMIN,YMIN,XMAX,YMAX: what the raster covers at least; default: the box of the points")
      ->delimiter(',')
      ->expected(4);
  add_named_choice(command, "--pixel-is", request->is_point,
                   "Whether the edges of pixels or their centres are multiples of the resolution",
                   NamedChoices<bool>{{"area", false}, {"point", true}})
      ->default_str("area");
  command->add_option("--nodata", request->nodata, "What stands for no height in the GeoTIFF")
      ->capture_default_str();
  command
      ->add_option(
          "--vertical-factor", request->shading.vertical_factor,
          "Of a .png, by what heights are multiplied; longitudes and latitudes count in metres anyhow")
      ->check(CLI::PositiveNumber);
  command->add_flag("--colors", request->shading.colors, "Of a .png, colours by height, green to white");
  command
      ->add_option("--contours", request->contours,
                   "The interval of contours' heights, or several heights, for an output of contours")
      ->delimiter(',');
  end_group(command, "Outputs");
  add_columns(command, request->columns, "x, y and height");
  add_heights(command, request->columns);
  add_crs(command, request->crs);
  constexpr int kMostClass = 255;
  command
      ->add_option(
          "--classes", request->classes,
          "Of a scan, the classes that are used: 2 is ground, 9 water; default: all but noise, 7 and 18")
      ->delimiter(',')
      ->check(CLI::Range(0, kMostClass));
  add_named_choice(command, "--returns", request->returns, "Of a scan, only these returns of each pulse",
                   NamedChoices<Returns>{{"first", Returns::first}, {"last", Returns::last}});
  add_named_choice(command, "--duplicates", request->duplicates,
                   "The height of a place that was measured several times", all_of<Duplicates>())
      ->default_str("highest");
  end_group(command, "Points");
  add_path(command, "--breaklines", request->breaklines,
           "A map of lines that become edges of the triangulation, with heights or else those of the points "
           "around");
  add_line_heights(command, request->line_heights, "--breaklines");
  add_path(command, "--boundary", request->boundary,
           "A map of polygons, outside of which the raster is empty and there are no contours");
  add_path(command, "--flat", request->flat,
           "A map of polygons, such as lakes, that are held flat: at the height of the first point of their "
           "border, or else at the lowest height along it");
  command->add_option("--max-edge", request->raster.max_edge, "Triangles with a longer edge are left out")
      ->check(CLI::PositiveNumber);
  add_named_choice(command, "--crossings", request->crossings,
                   "Breaklines that cross: an error, or cut where they do, at the height of the first one",
                   all_of<Crossings>())
      ->default_str("error");
  end_group(command, "Lines and areas");
  add_device(command, request->device);
  add_memory(command, request->memory,
             "Work within so many bytes: 4G, 500M; default: half of what is free. A raster of more than a "
             "quarter of "
             "it is kept in the scratch folder");
  add_path(command, "--scratch", request->scratch,
           "The folder for 32 bytes per point, in a file without a name; default: TMPDIR, or /tmp")
      ->check(CLI::ExistingDirectory);
  add_quiet(command, request->quiet);
  end_group(command, "Work");
  command->footer(
      examples({"flaunay terrain scan.las -o heights.npy --resolution 1 --classes 2",
                "flaunay terrain tiles/ -o dem.tif -o contours.geojson --resolution 1 --contours 5"}));
  command->callback([request, &action] {
    check(*request);
    action = [request] { return make_terrain(*request); };
  });
}

}  // namespace flaunay::cli
