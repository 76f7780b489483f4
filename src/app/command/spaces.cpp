#include "app/command/spaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "app/command/chunks.hpp"
#include "app/command/compiling.hpp"
#include "app/command/errors.hpp"
#include "app/command/progress.hpp"
#include "app/files/formats.hpp"
#include "app/files/layers.hpp"
#include "app/files/scan.hpp"
#include "flaunay/sphere.hpp"

namespace flaunay::cli {
namespace {

// In every space, and besides in some.
const std::vector<std::string> kCommon = {"--output", "--triangles", "--neighbors", "--duplicates",
                                          "--stats",  "--device",    "--index",     "--columns",
                                          "--crs",    "--quiet"};
const std::vector<std::string> kChunks = {"--memory", "--chunk-points", "--scratch"};
const std::vector<std::string> kPlanar = {"--halfedges", "--hull", "--areas"};

/// The triangles in the plane, each once: corners in another period are points behind the others. Mesh files
/// have no neighbours.
void unfold(const Period& period, const std::vector<std::int8_t>& offsets, io::Points& points,
            research::Triangulation& mesh) {
  std::map<std::array<std::int32_t, 3>, std::int32_t> images;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::array<std::int32_t, 3> image = {mesh.triangles[c], offsets[2 * c], offsets[2 * c + 1]};
    if (image[1] == 0 && image[2] == 0) continue;
    const auto [place, is_new] = images.emplace(image, static_cast<std::int32_t>(points.size()));
    if (is_new) {
      // An infinite period has offsets of 0 only.
      const auto moved = [](int times, double length) { return times == 0 ? 0 : times * length; };
      const std::size_t v = 2 * static_cast<std::size_t>(image[0]);
      points.coordinates.insert(
          points.coordinates.end(),
          {points.coordinates[v] + (moved(image[1], period.x) + moved(image[2], period.shear)),
           points.coordinates[v + 1] + moved(image[2], period.y)});
    }
    mesh.triangles[c] = place->second;
  }
}

/// Points of the unit sphere in space, for files of meshes that have heights.
io::Points in_space(const std::vector<double>& places) {
  const std::vector<double> directions = directions_of(places);
  io::Points points;
  for (std::size_t i = 0; i < directions.size(); i += 3) {
    points.coordinates.insert(points.coordinates.end(), {directions[i], directions[i + 1]});
    points.heights.push_back(directions[i + 2]);
  }
  return points;
}

// Writes the file of the mesh. points: in the plane and on a torus as they are there.
void write_mesh_in_space(OutputFiles& outputs, const std::string& path, const io::Points& points,
                         const research::Triangulation& mesh) {
  if (mesh.space.kind == SpaceKind::plane) return io::write_mesh(outputs, path, {points, mesh});
  if (mesh.space.kind == SpaceKind::sphere) {
    if (io::ending_of(path) != ".geojson")
      return io::write_mesh(outputs, path, {in_space(mesh.places), mesh});
    io::MeshContents contents{points, mesh};
    contents.is_on_globe = true;
    return io::write_mesh(outputs, path, contents);
  }
  io::Points images = points;
  research::Triangulation planar;
  planar.triangles = mesh.triangles;
  unfold(mesh.space.period, mesh.corner_offsets, images, planar);
  io::write_mesh(outputs, path, {images, planar});
}

}  // namespace

Space space_of(const SpaceRequest& request) {
  const std::vector<double>& period = request.period;
  if (request.kind == SpaceKind::sphere) return Space::sphere(SphereCoordinates::degrees);
  if (!request.is_periodic()) return Space::plane();
  return Space::torus({period[0], period[1], period.size() > 2 ? period[2] : 0});
}

void add_space_options(CLI::App* command, SpaceRequest& request) {
  command
      ->add_option(
          "--period", request.period,
          "The plane repeats itself after LX in x and LY in y, there moved by SHEAR in x; inf: not in "
          "that direction")
      ->delimiter(',')
      ->expected(2, 3)
      ->allow_extra_args(false)
      ->type_name("LX,LY[,SHEAR]");
  add_path(
      command, "--offsets", request.offsets,
      "With --period: in which period corners are, x and y for each, if the first one is at its place: .npy");
  command->add_flag_callback(
      "--sphere", [&request] { request.kind = SpaceKind::sphere; },
      "The points are longitudes and latitudes in degrees, for a triangulation on the sphere");
  command->add_flag(
      "--weighted", request.is_weighted,
      "Each point has a weight behind x and y: the regular triangulation, of .npy, .txt, .csv and .xyz");
}

void check_space_options(const CLI::App& command, const SpaceRequest& request,
                         const std::vector<std::string>& others) {
  if (!request.is_periodic()) refuse(command, "--offsets", "needs --period");
  if (!request.is_in_space()) return;
  std::vector<std::string> own;
  if (request.is_periodic()) own = {"--period", "--offsets"};
  if (request.is_weighted) own.emplace_back("--weighted");
  if (request.kind == SpaceKind::sphere) own = {"--sphere"};
  refuse_all_but(command, own, others);
}

bool asks_for_space(const CLI::App& command, const SpaceRequest& request) {
  if (!request.is_weighted) refuse(command, "--hidden", "needs --weighted");
  std::vector<std::string> others = kCommon;
  const auto add = [&](const std::vector<std::string>& more) {
    others.insert(others.end(), more.begin(), more.end());
  };
  if (request.is_weighted) others.emplace_back("--hidden");
  if (request.is_periodic()) others.emplace_back("--points");
  if (request.is_periodic() && !request.is_weighted) add(kChunks);
  if (space_of(request).kind == SpaceKind::plane) add(kPlanar);
  check_space_options(command, request, others);
  if (!request.is_in_space()) return false;
  const bool in_chunks = asks_for_chunks(command, command.get_option("--device")->as<std::string>());
  const std::string output = command.get_option("--output")->as<std::string>();
  const std::vector<std::string> in_space = {".npy", ".obj", ".off", ".ply", ".vtu", ".msh", ".geojson"};
  if (request.kind == SpaceKind::sphere && !output.empty() && output != "-" &&
      std::find(in_space.begin(), in_space.end(), io::ending_of(output)) == in_space.end()) {
    throw Error(
        ErrorKind::usage,
        fmt::format(
            "{}: triangles on the sphere are written to .obj, .off, .ply, .vtu, .msh, .geojson and .npy",
            output));
  }
  if (in_chunks && request.is_weighted) refuse(command, "--device", "weighted points need one device");
  if (in_chunks) refuse(command, "--output", "a triangulation in chunks writes arrays alone");
  if (in_chunks && request.kind == SpaceKind::sphere)
    refuse(command, "--device", "the sphere needs one device");
  if (in_chunks) refuse(command, "--points", "a triangulation in chunks does not write places");
  return true;
}

WeightedPoints read_weighted_points(const std::string& path, const io::Columns& columns, bool is_weighted) {
  if (!is_weighted) return {io::read_points(path, columns), {}};
  io::Scan file({path}, {}, "", columns, "weight");
  file.survey([](double) {});
  const auto n = static_cast<std::size_t>(file.size());
  WeightedPoints read;
  read.points.coordinates.resize(2 * n);
  read.weights.resize(n);
  file.read(0, n, read.points.coordinates.data());
  file.read_values(0, n, read.weights.data());
  return read;
}

int triangulate_in_space(const Task& task, const SpaceRequest& request, const std::string& places) {
  OutputFiles outputs({io::without_layer(task.input)});
  announce(outputs, task.results);
  outputs.add(request.offsets, ".npy");
  outputs.add(request.hidden, ".npy");
  if (!places.empty()) outputs.add_points(places);

  RunFacts facts;
  facts.input = task.input;
  Progress progress(!task.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  WeightedPoints read = read_weighted_points(task.input, task.columns, request.is_weighted);
  io::Points& points = read.points;
  io::choose_crs(task.crs, task.input, task.results.mesh, points.crs);
  const std::size_t n = points.size();
  facts.reading_seconds = stopwatch.restart();
  const io::IndexType index = index_type(task.index, n, task.results);

  progress.update_slow("preparing the device", kCompiling);
  Triangulator triangulator(task.device);
  facts.opening_seconds = stopwatch.restart();
  const double* const coordinates = points.coordinates.data();
  facts.compiling_seconds = compile_kernels(n, Mode::blocks, [&](std::size_t some) {
    note_compiling(triangulator.triangulate(coordinates, some), facts);
  });
  progress.update("triangulating");
  Space space = space_of(request);
  if (request.is_weighted) space = space.with_weights(read.weights.data());
  Options options;
  ask_for(task.results, options);
  research::Triangulation mesh;
  static_cast<Triangulation&>(mesh) = naming_files(
      {{"point ", task.input}}, [&] { return triangulator.triangulate(coordinates, n, space, options); });
  if (mesh.space.kind == SpaceKind::torus) points.coordinates = mesh.places;

  const auto write = [&] {
    write_arrays(kTriangulationArrays, task.results.arrays, mesh, outputs, index);
    constexpr std::size_t kColumns = 6;
    if (!request.offsets.empty()) {
      const std::vector<std::int32_t> offsets(mesh.corner_offsets.begin(), mesh.corner_offsets.end());
      io::write_npy(outputs, request.offsets, offsets, kColumns);
    }
    if (!request.hidden.empty()) io::write_npy(outputs, request.hidden, mesh.hidden, 1, index);
    if (!places.empty()) io::write_points(outputs, places, points);
    if (!task.results.mesh.empty()) write_mesh_in_space(outputs, task.results.mesh, points, mesh);
  };
  write_files(task.results, facts, progress, outputs, write, [&] { return statistics_json(mesh, facts); });
  if (task.quiet) return kSuccess;
  const bool is_planar = mesh.space.kind == SpaceKind::plane;
  print(host_note(facts.compiling_note) + host_note(mesh.statistics.note) +
        (request.is_weighted ? fmt::format("hidden points: {}\n", mesh.hidden.size()) : "") +
        (is_planar ? degenerate_note(mesh.statistics) : "") + notes_text(outputs.notes) +
        summary(mesh.statistics, facts));
  return kSuccess;
}

}  // namespace flaunay::cli
