// flaunay terrain: from measured heights to a map.
#include "flaunay/terrain.hpp"

#include <fmt/format.h>

#include <algorithm>
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
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/terrain_mesh.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/map.hpp"
#include "app/files/scan.hpp"
#include "files/file.hpp"
#include "files/npy_header.hpp"
#include "files/scratch.hpp"
#include "host/memory/system_memory.hpp"
#include "host/system/pages.hpp"

namespace flaunay::cli {
namespace {

using Returns = io::ScanChoice::Returns;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// 32 GiB, or less where sizes have 32 bits.
constexpr double kMostPixels =
    std::min(0x1p32, static_cast<double>(std::numeric_limits<std::size_t>::max() / sizeof(double)));

struct TerrainRequest {
  std::vector<std::string> inputs, outputs;
  double resolution = 0;
  std::vector<double> bounds;
  std::vector<int> classes;
  Returns returns = Returns::all;
  Duplicates duplicates = Duplicates::highest;
  std::string breaklines, boundary, crs;
  std::vector<double> contours;
  RasterOptions raster;
  bool is_point = false;
  double nodata = -9999;
  std::string device, scratch;
  std::uint64_t memory = 0;
  bool quiet = false;

  /// Whether all points are in memory at once.
  bool in_memory() const { return !breaklines.empty() || !contours.empty(); }
};

[[noreturn]] void fail_usage(const std::string& message) {
  throw Error(ErrorKind::usage, io::printable(message));
}

// Pixels of one size: their corners, or with is_point their centres, are multiples of it. As of
// flaunay.terrain in Python, in the same operations.
struct Grid {
  Grid(const io::Box& box, double size, bool is_point_) : resolution(size), is_point(is_point_) {
    for (int k = 0; k < 2; ++k) {
      if (!std::isfinite(box[k]) || !std::isfinite(box[k + 2]) || box[k] > box[k + 2]) {
        fail_usage(
            fmt::format("the map would be from ({}, {}) to ({}, {}): bounds must be finite, the lower ones "
                        "first",
                        box[0], box[1], box[2], box[3]));
      }
    }
    const double low_x = std::floor(box[0] / size), low_y = std::floor(box[1] / size);
    const double wide = std::max(std::ceil(box[2] / size) - low_x, 1.0) + (is_point ? 1 : 0);
    const double high = std::max(std::ceil(box[3] / size) - low_y, 1.0) + (is_point ? 1 : 0);
    if (!(wide * high <= kMostPixels)) {
      fail_usage(
          fmt::format("--resolution {}: makes {:.0f} x {:.0f} pixels of {} x {}; at most {:.0f} are possible",
                      size, wide, high, box[2] - box[0], box[3] - box[1], kMostPixels));
    }
    const double x = low_x - (is_point ? 0.5 : 0.0), y = low_y - (is_point ? 0.5 : 0.0);
    west = x * size;
    north = (y + high) * size;
    pixels = {(x + 0.5) * size,
              (y + high - 0.5) * size,
              size,
              -size,
              static_cast<std::size_t>(high),
              static_cast<std::size_t>(wide)};
  }
  std::size_t count() const { return pixels.rows * pixels.columns; }

  double resolution;
  bool is_point;
  double west = 0, north = 0;
  RasterGrid pixels;
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

// Takes the values of pixels away whose centres no polygon has. What is inside of each follows the even-odd
// rule.
void leave_out(const io::Map& boundary, const RasterGrid& grid, double* pixels) {
  struct Crossing {
    std::size_t row, polygon;
    double x;
    bool operator<(const Crossing& other) const {
      return std::tie(row, polygon, x) < std::tie(other.row, other.polygon, other.x);
    }
  };
  std::vector<Crossing> crossings;
  const auto row_of = [&](double y) {
    return std::clamp((y - grid.y) / grid.dy, -1.0, static_cast<double>(grid.rows));
  };
  for (std::size_t polygon = 0; polygon < boundary.polygon_count(); ++polygon) {
    const std::size_t first = boundary.ring_offsets[boundary.polygon_offsets[polygon]];
    const std::size_t last = boundary.ring_offsets[boundary.polygon_offsets[polygon + 1]];
    for (std::size_t s = first; s < last; ++s) {
      const double* a = &boundary.points.coordinates[2 * static_cast<std::size_t>(boundary.segments[2 * s])];
      const double* b =
          &boundary.points.coordinates[2 * static_cast<std::size_t>(boundary.segments[2 * s + 1])];
      if (a[1] > b[1]) std::swap(a, b);
      // Rows go down. One more on each side, since the quotient is rounded.
      const double top = std::max(std::floor(row_of(b[1])) - 1, 0.0);
      const double bottom = std::min(std::ceil(row_of(a[1])) + 1, static_cast<double>(grid.rows) - 1);
      for (double r = top; r <= bottom; ++r) {
        const double y = grid.y + r * grid.dy;
        if (!(a[1] <= y && y < b[1])) continue;
        crossings.push_back(
            {static_cast<std::size_t>(r), polygon, a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]))});
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<char> is_inside(grid.columns);
  auto next = crossings.begin();
  for (std::size_t row = 0; row < grid.rows; ++row) {
    std::fill(is_inside.begin(), is_inside.end(), 0);
    for (; next != crossings.end() && next->row == row; next += 2) {
      const double columns = static_cast<double>(grid.columns);
      const double begin = std::clamp(std::ceil((next->x - grid.x) / grid.dx), 0.0, columns);
      const double end = std::clamp(std::ceil(((next + 1)->x - grid.x) / grid.dx), 0.0, columns);
      std::fill(is_inside.begin() + static_cast<std::ptrdiff_t>(begin),
                is_inside.begin() + static_cast<std::ptrdiff_t>(end), 1);
    }
    double* const line = pixels + row * grid.columns;
    for (std::size_t column = 0; column < grid.columns; ++column) {
      if (is_inside[column] == 0) line[column] = kNaN;
    }
  }
}

io::ScanChoice choice_of(const TerrainRequest& request) {
  io::ScanChoice choice;
  for (const int number : request.classes) choice.classes.set(static_cast<std::size_t>(number));
  choice.returns = request.returns;
  return choice;
}

// The system of all points: what the user says, or else what the files have.
std::string common_crs(const TerrainRequest& request, const io::Scan& scan) {
  if (!request.crs.empty()) return io::crs_text(request.crs, "--crs");
  const std::vector<io::Scan::System> systems = scan.systems();
  for (const io::Scan::System& system : systems) {
    if (io::is_same_crs(system.crs, systems.front().crs)) continue;
    throw Error(
        ErrorKind::input,
        io::printable(fmt::format("{} and {} have different coordinate systems, {} and {}: reproject one of "
                                  "them, or say by --crs what both have",
                                  systems.front().path, system.path, systems.front().crs, system.crs)));
  }
  return systems.empty() ? "" : systems.front().crs;
}

bool is_tiff(const std::string& path) {
  const std::string ending = io::ending_of(path);
  return ending == ".tif" || ending == ".tiff";
}

bool is_npy(const std::string& path) { return io::ending_of(path) == ".npy"; }
bool is_lines(const std::string& path) { return io::ending_of(path) == ".geojson"; }

void announce(OutputFiles& outputs, const TerrainRequest& request) {
  for (const std::string& path : request.outputs) {
    if (is_tiff(path)) {
      io::require_gdal(path);
    } else if (is_lines(path)) {
      if (request.contours.empty())
        fail_usage(fmt::format("{}: needs --contours, the interval of heights", path));
    } else if (!is_npy(path)) {
      io::fail_ending(path, ".tif, .npy or .geojson");
    }
    outputs.announce(path);
  }
}

void write_npy(OutputFiles& outputs, const std::string& path, const Grid& grid, const double* pixels) {
  io::OutputFile& file = outputs.open(path);
  const std::string header = io::npy_header("<f8", grid.pixels.rows, grid.pixels.columns);
  file.write(header.data(), header.size());
  file.write(pixels, grid.count() * sizeof(double));
}

void write_tiffs(OutputFiles& outputs, const TerrainRequest& request, const Grid& grid,
                 const std::string& crs, double* pixels) {
  if (std::none_of(request.outputs.begin(), request.outputs.end(), is_tiff)) return;
  // In place: each is written where one was read before.
  auto* const narrow = reinterpret_cast<float*>(pixels);
  for (std::size_t i = 0; i < grid.count(); ++i) {
    double wide;
    std::memcpy(&wide, pixels + i, sizeof wide);
    const auto pixel = static_cast<float>(std::isnan(wide) ? request.nodata : wide);
    std::memcpy(narrow + i, &pixel, sizeof pixel);
  }
  for (const std::string& path : request.outputs) {
    if (!is_tiff(path)) continue;
    const std::string partial = outputs.open(path).partial_path();
    if (partial.empty()) fail_usage(fmt::format("{}: is no regular file, which a GeoTIFF must be", path));
    io::write_geotiff(partial, path,
                      {narrow, grid.pixels.rows, grid.pixels.columns, grid.west, grid.north, grid.resolution,
                       grid.is_point, request.nodata, crs});
  }
}

int make_terrain(const TerrainRequest& request) {
  const std::vector<std::string> files = io::scan_files(request.inputs);
  std::vector<std::string> inputs = files;
  for (const std::string& map : {request.boundary, request.breaklines}) {
    if (!map.empty()) inputs.push_back(map);
  }
  OutputFiles outputs(inputs);
  announce(outputs, request);

  Progress progress(!request.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  io::Scan scan(files, choice_of(request), request.scratch);
  const std::string crs = common_crs(request, scan);
  std::optional<io::Box> bounds;
  if (!request.bounds.empty()) {
    bounds.emplace();
    std::copy_n(request.bounds.begin(), bounds->size(), bounds->begin());
  }
  // To find now what would be found after the pass over all points.
  const io::Box announced = bounds ? *bounds : scan.announced_box();
  if (announced[0] <= announced[2]) Grid(announced, request.resolution, request.is_point);
  std::optional<io::Map> boundary;
  if (!request.boundary.empty()) {
    boundary = io::read_map(request.boundary);
    if (boundary->polygon_count() == 0) io::fail(request.boundary, "has no polygon");
  }

  const io::Box box = scan.survey([&](double done) { progress.update("reading", -1, done); });
  if (scan.size() == 0) {
    throw Error(ErrorKind::input,
                request.classes.empty()
                    ? "there are no points"
                    : fmt::format("there are no points of the classes {}", fmt::join(request.classes, ", ")));
  }
  const Grid grid(bounds ? *bounds : box, request.resolution, request.is_point);
  const std::uint64_t memory = request.memory != 0 ? request.memory : host::memory_left().bytes / 2;
  Pixels pixels(grid.count(), memory, request.scratch);
  if (request.in_memory()) {
    progress.update("triangulating");
    Triangulator triangulator(request.device);
    const TerrainMesh terrain = triangulate_scan(triangulator, scan, request.breaklines, request.duplicates);
    rasterize(triangulator, terrain.view(), terrain.heights.data(), grid.pixels, request.raster,
              pixels.data());
    const std::vector<double> heights = contour_heights(request.contours, terrain.heights);
    if (std::any_of(request.outputs.begin(), request.outputs.end(), is_lines)) {
      const Contours contours = trace_contours(triangulator, terrain.view(), terrain.heights.data(), heights,
                                               request.raster.max_edge);
      for (const std::string& path : request.outputs) {
        if (is_lines(path)) write_contours(outputs, path, contours, heights, crs);
      }
    }
  } else {
    ChunkOptions chunks;
    chunks.memory_bytes = memory - pixels.bytes_in_memory();
    chunks.scratch = request.scratch;
    if (!request.device.empty()) chunks.devices = {request.device};
    chunks.progress = [&](const std::string& stage, int, double done) { progress.update(stage, -1, done); };
    rasterize_chunks(scan, request.duplicates, grid.pixels, request.raster, pixels.data(), chunks);
  }
  if (boundary) leave_out(*boundary, grid.pixels, pixels.data());

  progress.update("writing");
  for (const std::string& path : request.outputs) {
    if (is_npy(path)) write_npy(outputs, path, grid, pixels.data());
  }
  write_tiffs(outputs, request, grid, crs, pixels.data());
  outputs.commit();
  progress.finish();
  if (!request.quiet) {
    print(fmt::format("{} points, {} x {} pixels, {:.3g} s\n", scan.size(), grid.pixels.columns,
                      grid.pixels.rows, stopwatch.seconds()));
  }
  return kSuccess;
}

void check(const TerrainRequest& request) {
  if (!(request.resolution > 0 && std::isfinite(request.resolution)))
    fail_usage(fmt::format("--resolution must be positive, not {}", request.resolution));
  if (!std::isfinite(request.nodata)) fail_usage("--nodata must be finite");
  if (request.in_memory() && request.memory != 0) {
    fail_usage(
        "--memory: with --breaklines or --contours all points are in memory at once, about 200 bytes each");
  }
  if (!request.contours.empty() && !request.boundary.empty()) {
    fail_usage("--contours: are not cut at a --boundary; flaunay.terrain in Python does that");
  }
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
      ->add_option(
          "inputs", request->inputs,
          "Points: .las, .npy of shape (n, 3), text with x, y and z (.txt, .xyz, .csv), or folders of these")
      ->required();
  command
      ->add_option("-o,--output", request->outputs,
                   "The raster: .tif (cloud-optimised GeoTIFF of float32) or .npy (float64); contours: "
                   ".geojson; several outputs are all "
                   "written or none")
      ->required();
  command->add_option("--resolution", request->resolution, "The size of a pixel")->required();
  command
      ->add_option("--bounds", request->bounds,
                   "XMIN,YMIN,XMAX,YMAX: what the raster covers at least; default: the box of the points")
      ->delimiter(',')
      ->expected(4);
  constexpr int kMostClass = 255;
  command
      ->add_option("--classes", request->classes,
                   "Of a scan, the classes that are used: 2 is ground, 9 water")
      ->delimiter(',')
      ->check(CLI::Range(0, kMostClass));
  add_named_choice(command, "--returns", request->returns, "Of a scan, only these returns of each pulse",
                   NamedChoices<Returns>{{"first", Returns::first}, {"last", Returns::last}});
  add_named_choice(
      command, "--duplicates", request->duplicates, "The height of a place that was measured several times",
      NamedChoices<Duplicates>{
          {"highest", Duplicates::highest}, {"lowest", Duplicates::lowest}, {"mean", Duplicates::mean}})
      ->default_str("highest");
  add_path(command, "--breaklines", request->breaklines,
           "A map of lines that become edges of the triangulation, with heights or else those of the points "
           "around");
  command
      ->add_option("--contours", request->contours,
                   "The interval of contours' heights, or several heights, for an output .geojson")
      ->delimiter(',');
  add_path(command, "--boundary", request->boundary,
           "A map of polygons, outside of which the raster is empty");
  command->add_option("--max-edge", request->raster.max_edge, "Triangles with a longer edge are left out")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--crs", request->crs,
                      "The system of the coordinates, such as EPSG:25832, in place of that of the files");
  add_named_choice(command, "--pixel-is", request->is_point,
                   "Whether the edges of pixels or their centres are multiples of the resolution",
                   NamedChoices<bool>{{"area", false}, {"point", true}})
      ->default_str("area");
  command->add_option("--nodata", request->nodata, "What stands for no height in the GeoTIFF")
      ->capture_default_str();
  add_device(command, request->device);
  add_memory(command, request->memory,
             "Work within so many bytes: 4G, 500M; default: half of what is free. A raster of more than a "
             "quarter of "
             "it is kept in the scratch folder");
  add_path(command, "--scratch", request->scratch,
           "The folder for 32 bytes per point, in a file without a name; default: TMPDIR, or /tmp")
      ->check(CLI::ExistingDirectory);
  add_quiet(command, request->quiet);
  command->callback([request, &action] {
    check(*request);
    action = [request] { return make_terrain(*request); };
  });
}

}  // namespace flaunay::cli
