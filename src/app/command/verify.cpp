#include "flaunay/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/constraints.hpp"
#include "app/command/errors.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/spaces.hpp"
#include "app/files/formats.hpp"
#include "app/files/map.hpp"
#include "app/files/mesh.hpp"
#include "app/files/npy.hpp"
#include "app/files/point_stream.hpp"
#include "app/files/points.hpp"
#include "app/verify/chunks.hpp"
#include "constrained/refinement/bounds.hpp"
#include "files/file.hpp"
#include "flaunay/sphere.hpp"
#include "host/memory/system_memory.hpp"
#include "mesh/corners.hpp"
#include "prove/constrained_proof.hpp"
#include "prove/periodic_proof.hpp"
#include "prove/planar_proof.hpp"

namespace flaunay::cli {

namespace {

struct VerifyRequest : SpaceRequest {
  std::string points;
  io::Columns columns;
  std::string triangles;
  std::string neighbors;
  std::uint64_t memory_bytes = 0;  // 0: as much as there is
  std::string scratch;
  bool has_constraints = false;
  double min_angle = 0, max_area = 0;
  bool conforming = false;
  bool quiet = false;
  ConstraintRequest constraints;
  std::string constraint_edges;

  bool is_refined() const { return min_angle > 0 || max_area > 0 || conforming; }
};

/// 0 if it is no regular file.
std::uint64_t size_of_file(const std::string& path) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

/// The memory within which to check in chunks; 0: hold everything. Files that cannot be read in pieces are
/// held if no limit was asked for.
std::uint64_t memory_for_chunks(const VerifyRequest& request) {
  const bool is_asked_for = request.memory_bytes > 0;
  for (const std::string& path : {request.triangles, request.neighbors}) {
    if (path.empty() || io::ending_of(path) == ".npy") continue;
    if (!is_asked_for) return 0;
    throw Error(ErrorKind::usage,
                fmt::format("{}: --memory needs an .npy file, which can be read in pieces", path));
  }
  if (is_asked_for) return request.memory_bytes;
  // The most bytes that the check in memory holds, with the points and int32 rows themselves.
  constexpr std::uint64_t kPointBytes = 64, kRowBytes = 84, kRowBytesOfFile = 3 * sizeof(std::int32_t);
  constexpr std::uint64_t kSmall = std::uint64_t{1} << 20;  // rows that always fit
  const std::uint64_t rows = size_of_file(request.triangles) / kRowBytesOfFile;
  if (rows < kSmall) return 0;
  const std::uint64_t needed =
      kPointBytes * io::estimate_points(request.points, request.columns) + kRowBytes * rows;
  const std::uint64_t left = host::memory_left().bytes;
  return needed > left ? left / 2 : 0;
}

/// The report, and what to add to the final line.
struct Checked {
  VerifyReport report;
  double seconds = 0;
  std::string how;
};

Checked verify_in_memory(const VerifyRequest& request, Progress& progress) {
  const io::Points points = io::read_points(request.points, request.columns);
  const std::vector<std::int32_t> triangles = io::read_triangles(request.triangles);
  std::vector<std::int32_t> neighbors;
  if (!request.neighbors.empty()) neighbors = io::read_neighbors(request.neighbors);
  progress.update("verifying");
  const Stopwatch stopwatch;
  const VerifyReport report =
      request.neighbors.empty()
          ? flaunay::verify(points.coordinates.data(), points.size(), triangles)
          : flaunay::verify(points.coordinates.data(), points.size(), triangles, neighbors);
  return {report, stopwatch.seconds(), ""};
}

Checked verify_in_chunks(const VerifyRequest& request, std::uint64_t memory, Progress& progress) {
  const auto points = io::open_point_stream(request.points, request.scratch, request.columns);
  const auto triangles = io::open_npy_rows(request.triangles);
  const auto neighbors = request.neighbors.empty() ? nullptr : io::open_npy_rows(request.neighbors);
  const VerifySizes sizes = verify_sizes(memory, points->size(), triangles->size(), 0);
  VerifyChunksOptions options;
  options.scratch = request.scratch;
  options.progress = [&](const std::string& stage, double done) { progress.update(stage, -1, done); };
  const Stopwatch stopwatch;
  const VerifyChunksReport report =
      naming_files({{"point ", request.points}, {"triangle ", request.triangles}},
                   [&] { return verify_chunks(*points, *triangles, neighbors.get(), sizes, options); });
  const std::string how = fmt::format(
      "; in chunks within {}: {} windows of rows, {} edges across, {} of scratch", host::mebibytes(memory),
      report.windows, report.edges_across, host::mebibytes(report.scratch_bytes));
  return {report, stopwatch.seconds(), how};
}

Checked verify_with_constraints(const VerifyRequest& request, Progress& progress) {
  ConstraintRequest asked = request.constraints;
  io::Map map;
  if (request.has_constraints) {
    map = read_domain(request.points, request.columns, asked);
  } else {
    map.points = io::read_points(request.points, request.columns);
  }
  const std::vector<std::int32_t> triangles = io::read_triangles(request.triangles);
  const std::vector<std::int32_t> segments = all_segments(map);
  const Rings rings = rings_of(map, asked.fill);
  std::vector<std::int32_t> neighbors, edges;
  if (!request.neighbors.empty()) neighbors = io::read_neighbors(request.neighbors);
  VerifyConstraints constraints;
  constraints.segments = &segments;
  if (!rings.segment_offsets.empty()) constraints.rings = &rings;
  constraints.outside = asked.outside;
  constraints.fill_rule = asked.fill;
  if (!map.holes.empty()) constraints.holes = &map.holes;
  constraints.min_angle = request.min_angle;
  constraints.max_area = request.max_area;
  constraints.conforming = request.conforming;
  if (!request.constraint_edges.empty()) {
    edges = io::read_npy_segments(request.constraint_edges, map.points.size());
    constraints.edges = &edges;
  }
  progress.update("verifying");
  const Stopwatch stopwatch;
  const VerifyReport report =
      verify_constrained(map.points.coordinates.data(), map.points.size(), triangles,
                         request.neighbors.empty() ? nullptr : &neighbors, constraints);
  std::string how = fmt::format("; {} constraint edges", report.constraint_edges);
  if (request.min_angle > 0) {
    how += fmt::format(", {} triangles with smaller angles, which the input has", report.excused_triangles);
  }
  return {report, stopwatch.seconds(), how};
}

/// The arrays that a proof needs, as triangles alone have them.
template <typename Mesh>
void read_rows(const VerifyRequest& request, std::size_t n, Mesh& mesh) {
  mesh.triangles = io::read_triangles(request.triangles);
  for (const std::int32_t v : mesh.triangles) {
    if (static_cast<std::size_t>(v) >= n) {
      throw Error(ErrorKind::input, fmt::format("{}: {} is none of the {} points", request.triangles, v, n));
    }
  }
  mesh.triangle_offsets = {0, mesh.triangles.size() / 3};
  if (!request.neighbors.empty()) mesh.neighbors = io::read_neighbors(request.neighbors);
}

/// For each point the smallest index of one with the same key.
template <typename Key>
std::vector<std::int32_t> representatives_by(std::size_t n, const Key& key) {
  std::vector<std::int32_t> order(n), representatives(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_equal = i > 0 && !(key(order[i - 1]) < key(order[i]));
    representatives[order[i]] = is_equal ? representatives[order[i - 1]] : order[i];
  }
  return representatives;
}

/// Points that no triangle has are hidden, unless they are represented by others.
std::vector<std::int32_t> hidden_points(const Triangulation& mesh) {
  std::vector<char> is_used(mesh.representatives.size(), 0);
  for (const std::int32_t v : mesh.triangles) is_used[v] = 1;
  std::vector<std::int32_t> hidden;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    const auto own = static_cast<std::int32_t>(i);
    if (is_used[i] == 0 && mesh.representatives[i] == own) hidden.push_back(own);
  }
  return hidden;
}

/// The hull of a triangulation in the plane, where triangles have no neighbours.
std::vector<std::int32_t> hull_of(const Triangulation& mesh, const std::vector<std::int32_t>& neighbors) {
  const std::size_t n = mesh.representatives.size();
  std::vector<std::int32_t> next(n, -1), hull;
  const auto place = [&](std::int32_t v) { return std::pair(mesh.places[2 * v], mesh.places[2 * v + 1]); };
  std::int32_t first = -1;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    if (neighbors[c] >= 0) continue;
    const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
    next[from] = to;
    if (first < 0 || place(from) < place(first)) first = from;
  }
  for (std::int32_t v = first; v >= 0 && hull.size() <= n; v = next[v] == first ? -1 : next[v])
    hull.push_back(v);
  return hull;
}

/// Checks weighted points that are said to have no triangles: they must be on one line, or on one circle of a
/// cylinder. Which of them are hidden, triangles do not say.
std::string problem_without_triangles(const Triangulation& mesh) {
  const std::size_t n = mesh.representatives.size();
  if (mesh.space.kind == SpaceKind::plane) return flaunay::verify(mesh.places.data(), n, {}).problem;
  const bool is_upright = !std::isfinite(mesh.space.period.x);
  const bool is_cylinder = is_upright || !std::isfinite(mesh.space.period.y);
  const std::size_t axis = is_upright ? 0 : 1;
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_cylinder || mesh.places[2 * i + axis] != mesh.places[axis])
      return "there are no triangles, but the points are not on one circle of a cylinder";
  }
  return "";
}

std::string problem_in_space(const VerifyRequest& request, std::size_t& n, Progress& progress) {
  const WeightedPoints read = read_weighted_points(request.points, request.columns, request.is_weighted);
  const Space space = space_of(request).with_weights(request.is_weighted ? read.weights.data() : nullptr);
  n = read.points.size();
  // Of no points, but in the space as it is rounded.
  Triangulation mesh = Triangulator().triangulate(nullptr, 0, space_of(request));
  mesh.places = naming_files({{"point ", request.points}},
                             [&] { return places_of(read.points.coordinates.data(), n, space); });
  const bool has_offsets = !request.offsets.empty();
  if (has_offsets) mesh.corner_offsets = io::read_corner_offsets(request.offsets);
  read_rows(request, n, mesh);
  if (has_offsets && mesh.corner_offsets.size() != 2 * mesh.triangles.size()) {
    throw Error(ErrorKind::input, fmt::format("{}: there are {} rows, but {} triangles", request.offsets,
                                              mesh.corner_offsets.size() / 6, mesh.triangles.size() / 3));
  }
  mesh.point_offsets = {0, n};
  progress.update("verifying");
  mesh.representatives = representatives_by(n, [&](std::int32_t i) {
    return std::tuple(mesh.places[2 * i], mesh.places[2 * i + 1], request.is_weighted ? read.weights[i] : 0);
  });
  const bool is_planar = space.kind == SpaceKind::plane;
  std::vector<std::int32_t> made;
  if (is_planar || mesh.neighbors.empty()) {
    made = has_offsets ? prove::neighbors_of(mesh.triangles, mesh.corner_offsets)
                       : prove::neighbors_of(mesh.triangles, n);
  }
  if (is_planar) mesh.hull = hull_of(mesh, made);
  mesh.hull_offsets = {0, mesh.hull.size()};
  if (mesh.neighbors.empty()) mesh.neighbors = std::move(made);
  const auto open = std::find(mesh.neighbors.begin(), mesh.neighbors.end(), -1);
  if (space.kind == SpaceKind::sphere && open != mesh.neighbors.end())
    return fmt::format("triangle {} has no neighbor at an edge", (open - mesh.neighbors.begin()) / 3);
  if (request.is_weighted && mesh.triangles.empty()) return problem_without_triangles(mesh);
  if (request.is_weighted) mesh.hidden = hidden_points(mesh);
  return flaunay::verify(read.points.coordinates.data(), mesh.point_offsets, space, mesh);
}

Checked verify_in_space(const VerifyRequest& request, Progress& progress) {
  const Stopwatch stopwatch;
  Checked checked;
  checked.report.problem = problem_in_space(request, checked.report.points, progress);
  checked.report.ok = checked.report.problem.empty();
  checked.seconds = stopwatch.seconds();
  return checked;
}

Checked check(const VerifyRequest& request, Progress& progress) {
  if (request.is_in_space()) return verify_in_space(request, progress);
  if (request.has_constraints || request.is_refined()) return verify_with_constraints(request, progress);
  const std::uint64_t memory = memory_for_chunks(request);
  return memory > 0 ? verify_in_chunks(request, memory, progress) : verify_in_memory(request, progress);
}

int verify(const VerifyRequest& request) {
  io::format_of(request.points, io::Use::read_points);
  io::check_columns(request.points, request.columns);
  Progress progress(!request.quiet);
  progress.update("reading");
  const auto [report, seconds, how] = check(request, progress);
  progress.finish();

  // The problem goes to standard error first, because standard output may be closed.
  if (!report.ok) {
    report_error("flaunay", kFailure, fmt::format("{}: {}", request.triangles, report.problem));
  }
  if (!request.quiet && request.is_in_space()) {
    print(fmt::format("{}: {} points, {:.3f} s\n", report.ok ? "right" : "wrong", report.points, seconds));
  } else if (!request.quiet) {
    print(
        fmt::format("{}: {} points, {} distinct, {} triangles, {} hull vertices, {} cocircular edges; "
                    "{} exact evaluations, {:.3f} s{}\n",
                    report.ok ? "right" : "wrong", report.points, report.distinct_points, report.triangles,
                    report.hull_vertices, report.cocircular_edges, report.exact_evaluations, seconds, how));
  }
  return report.ok ? kSuccess : kFailure;
}

/// Throws Error(usage) for options that do not go together.
void check_space(const CLI::App& command, const VerifyRequest& request) {
  check_space_options(command, request, {"--neighbors", "--columns", "--quiet"});
  if (request.is_periodic() && request.offsets.empty())
    throw Error(ErrorKind::usage, "--period needs --offsets, as triangulate writes them");
}

void refuse_chunks(const CLI::App& command) {
  refuse_all(command, {"--memory", "--scratch"},
             "constraints, angles and areas are checked in memory, not in chunks");
}

/// Whether segments are given. Throws Error(usage) for options that do not go together.
bool has_constraints(const CLI::App& command, VerifyRequest& request) {
  if (!io::is_map(request.points) && request.constraints.segments.empty()) {
    refuse_all(command, {"--outside", "--fill", "--hole", "--constraint-edges"},
               "needs segments: --constraints, or a map (.poly, .geojson, .gpkg ...) with the points");
    if (request.is_refined()) refuse_chunks(command);
    return false;
  }
  check_domain_options(command, request.points, request.constraints);
  refuse_chunks(command);
  if (!request.constraint_edges.empty() && io::ending_of(request.constraint_edges) != ".npy") {
    throw Error(ErrorKind::usage,
                fmt::format("{}: --constraint-edges needs an .npy file", request.constraint_edges));
  }
  return true;
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto request = std::make_shared<VerifyRequest>();
  CLI::App* command =
      app.add_subcommand("verify",
                         "Check with exact arithmetic that triangles are a Delaunay triangulation, or a "
                         "constrained one");
  command->add_option("points", request->points, "The points, in any format that triangulate reads")
      ->required();
  command
      ->add_option("triangles", request->triangles,
                   "The triangles: " + io::endings_for(io::Use::read_triangles))
      ->required();
  add_columns(command, request->columns, "x and y");
  command->add_option("--neighbors", request->neighbors, "Neighbours to check too: .npy");
  end_group(command, "Input");
  add_space_options(command, *request);
  end_group(command, "Torus, sphere and weights");
  add_domain_options(command, request->constraints);
  add_path(command, "--constraint-edges", request->constraint_edges,
           "Constraint edges to check too, as triangulate writes them: .npy");
  end_group(command, "Segments and polygons");
  command->add_option(
      "--min-angle", request->min_angle,
      "Check that no angle is smaller, in degrees, but where the input has such angles: 0 to 34");
  command->add_option("--max-area", request->max_area, "Check that no triangle is larger");
  command->add_flag("--conforming", request->conforming,
                    "Check that no angle opposite to a constraint, or to the border, is obtuse");
  end_group(command, "Refinement");
  add_memory(command, request->memory_bytes,
             "Check in chunks, within so many bytes: 4G, 500M; K, M, G and T are powers of 1024; needs .npy "
             "triangles. Default: hold everything if it fits");
  add_path(
      command, "--scratch", request->scratch,
      "Chunks: the folder for about 24 bytes per point, in files without names; default: TMPDIR, or /tmp")
      ->check(CLI::ExistingDirectory);
  end_group(command, "More points than memory");
  add_quiet(command, request->quiet);
  command->callback([request, command, &action] {
    constrained::quality_bounds(request->min_angle);
    constrained::check_areas(&request->max_area, 1, "--max-area");
    check_space(*command, *request);
    request->has_constraints = !request->is_in_space() && has_constraints(*command, *request);
    action = [request] { return verify(*request); };
  });
  end_group(command, "Reports");
  command->footer(
      examples({"flaunay verify points.npy t.npy --neighbors n.npy"}) +
      "\nThe exit code is 0 if the triangles are a Delaunay triangulation, 1 if they are not. With segments, "
      "they must be "
      "the canonical constrained Delaunay triangulation.");
}

}  // namespace flaunay::cli
