#include "app/command/surfaces.hpp"

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
#include "flaunay/periodic.hpp"
#include "flaunay/sphere.hpp"

namespace flaunay::cli {
namespace {

// On the sphere, and with a period also the others.
const std::vector<std::string> kCommon = {"--output", "--triangles", "--neighbors", "--duplicates", "--stats",
                                          "--device", "--index",     "--columns",   "--quiet"};
const std::vector<std::string> kPeriodic = {"--period", "--offsets",      "--points",
                                            "--memory", "--chunk-points", "--scratch"};

// What both surfaces have.
research::Triangulation completed(Triangulation mesh, std::size_t n) {
  research::Triangulation result;
  static_cast<Triangulation&>(result) = std::move(mesh);
  result.statistics.points = n;
  result.statistics.duplicates = 0;
  for (std::size_t i = 0; i < n; ++i)
    result.statistics.duplicates += static_cast<std::size_t>(result.representatives[i]) != i;
  result.statistics.triangles = result.triangles.size() / 3;
  result.statistics.hull_vertices = 0;
  return result;
}

/// The triangles in the plane, each once: corners in another period are points behind the others. Mesh files
/// have no neighbours.
void unfold(const Period& period, const std::vector<std::int32_t>& offsets, io::Points& points,
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

}  // namespace

void add_period(CLI::App* command, std::vector<double>& period, const std::string& description) {
  command->add_option("--period", period, description)
      ->delimiter(',')
      ->expected(2, 3)
      ->allow_extra_args(false)
      ->type_name("LX,LY[,SHEAR]");
}

Period period_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0};
}

void add_surface_options(CLI::App* command, SurfaceRequest& request) {
  add_period(
      command, request.period,
      "The plane repeats itself after LX in x and LY in y, there moved by SHEAR in x; inf: not in that "
      "direction");
  add_path(
      command, "--offsets", request.offsets,
      "With --period: in which period corners are, x and y for each, if the first one is at its place: .npy");
  command->add_flag("--sphere", request.is_sphere,
                    "The points are longitudes and latitudes in degrees, and are triangulated on the sphere");
}

bool asks_for_surface(const CLI::App& command, const SurfaceRequest& request) {
  const bool is_periodic = !request.period.empty();
  if (!is_periodic) refuse(command, "--offsets", "needs --period");
  if (!is_periodic && !request.is_sphere) return false;
  refuse_all_but(command, is_periodic ? kPeriodic : std::vector<std::string>{"--sphere"}, kCommon);
  const bool in_chunks = asks_for_chunks(command, command.get_option("--device")->as<std::string>());
  const std::string output = command.get_option("--output")->as<std::string>();
  const std::vector<std::string> in_space = {".npy", ".obj", ".off", ".ply", ".vtu", ".msh", ".geojson"};
  if (request.is_sphere && !output.empty() &&
      std::find(in_space.begin(), in_space.end(), io::ending_of(output)) == in_space.end()) {
    throw Error(
        ErrorKind::usage,
        fmt::format(
            "{}: triangles on the sphere are written to .obj, .off, .ply, .vtu, .msh, .geojson and .npy",
            output));
  }
  if (in_chunks) refuse(command, "--output", "a triangulation in chunks writes arrays alone");
  if (in_chunks && request.is_sphere) refuse(command, "--device", "the sphere needs one device");
  if (in_chunks) refuse(command, "--points", "a triangulation in chunks does not write places");
  return true;
}

int triangulate_surface(const Task& task, const SurfaceRequest& request, const std::string& places) {
  OutputFiles outputs({task.input});
  announce(outputs, task.results);
  outputs.add(request.offsets, ".npy");
  if (!places.empty()) outputs.add_points(places);

  RunFacts facts;
  facts.input = task.input;
  facts.mode = "blocks";
  Progress progress(!task.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  io::Points points = io::read_points(task.input, task.columns);
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
  research::Triangulation mesh;
  std::vector<std::int32_t> offsets;
  std::vector<double> on_sphere;  // places
  Period period;
  const auto named = [&](const auto& work) { return naming_files({{"point ", task.input}}, work); };
  if (request.is_sphere) {
    Triangulation found = named(
        [&] { return triangulator.triangulate(coordinates, n, Space::sphere(SphereCoordinates::degrees)); });
    on_sphere = std::move(found.places);
    mesh = completed(std::move(found), n);
  } else {
    Triangulation found = named(
        [&] { return triangulator.triangulate(coordinates, n, Space::torus(period_of(request.period))); });
    offsets.assign(found.corner_offsets.begin(), found.corner_offsets.end());
    period = found.space.period;
    points.coordinates = std::move(found.places);
    mesh = completed(std::move(found), n);
  }

  const auto write = [&] {
    write_arrays(kTriangulationArrays, task.results.arrays, mesh, outputs, index);
    constexpr std::size_t kColumns = 6;
    if (!request.offsets.empty()) io::write_npy(outputs, request.offsets, offsets, kColumns);
    if (!places.empty()) io::write_points(outputs, places, points);
    const std::string& output = task.results.mesh;
    if (output.empty()) return;
    if (request.is_sphere && io::ending_of(output) == ".geojson") {
      io::MeshContents contents{points, mesh};
      contents.is_on_globe = true;
      io::write_mesh(outputs, output, contents);
    } else if (request.is_sphere) {
      io::write_mesh(outputs, output, {in_space(on_sphere), mesh});
    } else {
      io::Points images = points;
      research::Triangulation planar;
      planar.triangles = mesh.triangles;
      unfold(period, offsets, images, planar);
      io::write_mesh(outputs, output, {images, planar});
    }
  };
  write_files(task.results, facts, progress, outputs, write, [&] { return statistics_json(mesh, facts); });
  if (!task.quiet)
    print(host_note(facts.compiling_note) + host_note(mesh.statistics.note) +
          summary(mesh.statistics, facts));
  return kSuccess;
}

}  // namespace flaunay::cli
