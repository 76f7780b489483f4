#include "app/command/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "app/command/chunks.hpp"
#include "app/command/compiling.hpp"
#include "app/command/errors.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/files/formats.hpp"
#include "app/files/map.hpp"
#include "app/files/mesh.hpp"
#include "app/files/text.hpp"
#include "app/verify/exact.hpp"

namespace flaunay::cli {
namespace {

const NamedChoices<Crossings> kCrossings = {{"error", Crossings::error}, {"split", Crossings::split}};
const NamedChoices<Outside> kOutside = {
    {"keep", Outside::keep}, {"hull", Outside::hull}, {"holes", Outside::holes}};
const NamedChoices<FillRule> kFillRules = {
    {"nesting", FillRule::nesting}, {"even-odd", FillRule::even_odd}, {"winding", FillRule::winding}};

const NamedChoices<Overlaps> kOverlaps = {{"first", Overlaps::first}, {"error", Overlaps::error}};

const std::vector<const char*> kChoices = {"--crossings", "--outside",  "--fill",
                                           "--hole",      "--separate", "--overlaps"};

std::vector<const char*> file_options() {
  std::vector<const char*> options = {"--points", "--polygons"};
  for (const ConstraintArrayFile& file : kConstraintArrayFiles) options.push_back(file.option);
  return options;
}

/// A place X,Y from the command line.
void append_hole(const std::string& text, std::vector<double>& holes) {
  const std::size_t comma = text.find(',');
  for (const std::string& field :
       {text.substr(0, comma), comma == std::string::npos ? std::string() : text.substr(comma + 1)}) {
    double value = 0;
    if (io::parse_number(field, value) != io::ParsedNumber::fine || !std::isfinite(value)) {
      throw Error(ErrorKind::usage,
                  fmt::format("--hole: '{}' is no place; expected X,Y with finite numbers", text));
    }
    holes.push_back(value);
  }
}

std::vector<double> holes_of(const ConstraintRequest& request) {
  std::vector<double> holes;
  for (const std::string& text : request.holes) append_hole(text, holes);
  return holes;
}

io::Map read_input(const std::string& input, const ConstraintRequest& request) {
  if (io::is_map(input)) return io::read_map(input);
  io::Map map;
  map.points = io::read_points(input);
  map.has_others = true;
  map.segments = io::read_segments(request.segments, map.points.size());
  return map;
}

/// What is outside, unless the user has chosen: of a .poly file what Triangle leaves out, and of polygons
/// what none of them covers.
void choose_for(const io::Map& map, const std::string& input, ConstraintRequest& request) {
  const bool has_polygons = map.polygon_count() > 0;
  if (!request.chose_outside && io::is_map(input)) {
    request.outside = has_polygons                      ? Outside::holes
                      : io::ending_of(input) == ".poly" ? Outside::hull
                                                        : Outside::keep;
  }
  if (!request.chose_fill) request.fill = has_polygons ? FillRule::winding : FillRule::nesting;
}

/// Whether the map is given to the library as polygons, which knows then which triangle is in which of them.
/// Throws if the request needs that and it is not possible.
bool are_polygons(const io::Map& map, const ConstrainedWork& work, const ConstraintRequest& request) {
  const bool possible =
      map.polygon_count() > 0 && !map.has_others && map.holes.empty() && request.fill != FillRule::nesting;
  if (!possible && (request.separate || request.chose_overlaps || !request.polygons.empty())) {
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: --separate, --overlaps and --polygons need a file of polygons alone, without "
                    "lines and points, and neither --hole nor --fill nesting",
                    io::printable(work.input)));
  }
  return possible;
}

bool wants_labels(const ConstrainedWork& work, const ConstraintRequest& request) {
  bool wanted = io::shows_labels(work.results.mesh);
  for (std::size_t k = 0; k < kConstraintArrayFiles.size(); ++k) {
    wanted = wanted || (kConstraintArrayFiles[k].needs_labels && !request.arrays[k].empty());
  }
  return wanted;
}

ConstrainedOptions options_of(const ConstrainedWork& work, const ConstraintRequest& request,
                              Progress& progress) {
  ConstrainedOptions options;
  ask_for(work.results, options);
  // Pictures draw the border.
  options.neighbors = options.neighbors || !work.results.mesh.empty();
  options.profile = work.profile;
  options.crossings = request.crossings;
  options.outside = request.outside;
  options.fill_rule = request.fill;
  options.labels = wants_labels(work, request);
  options.progress = progress.callback();
  return options;
}

ConstrainedTriangulation triangulate_polygons(Triangulator& triangulator, const io::Map& map,
                                              const ConstraintRequest& request,
                                              const ConstrainedOptions& options) {
  Polygons polygons;
  polygons.coordinates = map.points.coordinates.data();
  polygons.ring_offsets = map.ring_offsets;
  polygons.polygon_offsets = map.polygon_offsets;
  polygons.part_offsets = map.part_offsets;
  PolygonOptions polygon_options;
  static_cast<ConstrainedOptions&>(polygon_options) = options;
  polygon_options.map = !request.separate;
  polygon_options.overlaps = request.overlaps;
  return triangulator.polygons(polygons, polygon_options);
}

ConstrainedTriangulation triangulate_segments(Triangulator& triangulator, const io::Map& map,
                                              const ConstraintRequest& request,
                                              const ConstrainedOptions& options) {
  const std::vector<std::int32_t> segments = all_segments(map);
  Constraints constraints;
  constraints.rings = rings_of(map, request.fill);
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  constraints.holes = map.holes.data();
  constraints.hole_count = map.holes.size() / 2;
  return triangulator.constrained(map.points.coordinates.data(), map.points.size(), constraints, options);
}

/// For each triangle the number of its set.
std::vector<std::int32_t> sets_of(const Triangulation& mesh) {
  std::vector<std::int32_t> sets(mesh.triangles.size() / 3);
  for (std::size_t s = 0; s + 1 < mesh.triangle_offsets.size(); ++s) {
    std::fill(sets.begin() + static_cast<std::ptrdiff_t>(mesh.triangle_offsets[s]),
              sets.begin() + static_cast<std::ptrdiff_t>(mesh.triangle_offsets[s + 1]),
              static_cast<std::int32_t>(s));
  }
  return sets;
}

/// The markers of points that splitting added are those of the first segments that have them.
void add_markers(const ConstrainedTriangulation& mesh, io::Map& map) {
  const auto given = static_cast<std::int32_t>(map.points.markers.size());
  if (given == 0) return;
  std::vector<std::int32_t> segments(mesh.added_points.size() / 2, -1);
  for (std::size_t i = 0; i < mesh.constraint_edges.size(); ++i) {
    const std::int32_t point = mesh.constraint_edges[i] - given, segment = mesh.edge_segments[i / 2];
    if (point < 0) continue;
    if (segments[point] < 0 || segment < segments[point]) segments[point] = segment;
  }
  for (const std::int32_t segment : segments) {
    const bool has_marker = segment >= 0 && !map.segment_markers.empty();
    map.points.markers.push_back(has_marker ? map.segment_markers[segment] : 0);
  }
}

/// By triangle the attribute of its region in a .poly file, as Triangle gives it: 0 where there is none, and
/// of several the last one. A place on a constraint is in no region.
std::vector<double> attributes_of(const io::Map& map, const ConstrainedTriangulation& mesh) {
  std::vector<double> attributes;
  if (map.regions.empty() || mesh.regions.empty()) return attributes;
  // By x.
  std::vector<std::size_t> order(map.regions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto x_of = [&map](std::size_t k) { return map.regions[k].place[0]; };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x_of(a) < x_of(b); });
  std::vector<std::int32_t> found(order.size(), -1);
  std::vector<char> barred(order.size(), 0);
  ExactPredicates predicates;
  for (std::size_t t = 0; t < mesh.regions.size(); ++t) {
    const double* p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = &map.points.coordinates[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])];
    }
    const auto [least, most] = std::minmax({p[0][0], p[1][0], p[2][0]});
    auto next = std::lower_bound(order.begin(), order.end(), least,
                                 [&](std::size_t k, double x) { return x_of(k) < x; });
    for (; next != order.end() && x_of(*next) <= most; ++next) {
      const double* const place = map.regions[*next].place;
      int sides[3];
      for (std::size_t k = 0; k < 3; ++k) {
        sides[k] = predicates.orient2d(p[(k + 1) % 3], p[(k + 2) % 3], place);
      }
      if (std::min({sides[0], sides[1], sides[2]}) < 0) continue;
      found[*next] = mesh.regions[t];
      for (std::size_t k = 0; k < 3; ++k) {
        if (sides[k] == 0 && mesh.constrained[3 * t + k] != 0) barred[*next] = 1;
      }
    }
  }
  std::vector<double> by_region(1 + static_cast<std::size_t>(std::ranges::max(mesh.regions)), 0);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] >= 0 && barred[k] == 0) by_region[found[k]] = map.regions[k].attribute;
  }
  for (const std::int32_t region : mesh.regions) attributes.push_back(by_region[region]);
  return attributes;
}

void announce_constraints(OutputFiles& outputs, const ConstraintRequest& request) {
  for (const std::string& path : request.arrays) outputs.add(path, ".npy");
  outputs.add(request.polygons, ".npy");
  if (!request.points.empty()) outputs.add_points(request.points);
}

ConstraintFacts facts_of(const io::Map& map, const ConstraintRequest& request,
                         const ConstrainedTriangulation& mesh) {
  ConstraintFacts facts;
  facts.sets = request.separate ? map.polygon_count() : 1;
  facts.segments = (map.segments.size() + map.lines.size()) / 2;
  facts.pieces = static_cast<std::size_t>(mesh.piece_offsets.at(facts.segments));
  facts.edges = mesh.constraint_edges.size() / 2;
  facts.added_points = mesh.added_points.size() / 2;
  facts.holes = map.holes.size() / 2;
  facts.crossings = name_of(kCrossings, request.crossings);
  facts.outside = name_of(kOutside, request.outside);
  facts.fill = name_of(kFillRules, request.fill);
  return facts;
}

std::string empty_note(const ConstrainedTriangulation& mesh, const ConstraintRequest& request) {
  const Statistics& statistics = mesh.statistics;
  if (statistics.triangles > 0 || request.outside == Outside::keep ||
      statistics.points - statistics.duplicates < 3) {
    return degenerate_note(statistics);
  }
  return "note: no triangles: no part of the plane is inside; --outside keep keeps what is outside\n";
}

void write_results(const ConstrainedWork& work, const ConstraintRequest& request, const io::Map& map,
                   const ConstrainedTriangulation& mesh, RunFacts& facts, Progress& progress,
                   OutputFiles& outputs) {
  Stopwatch stopwatch;
  progress.update("writing");
  const io::IndexType index = index_type(work.index, map.points.size(), work.results);
  io::Outputs& files = outputs;
  if (!work.results.mesh.empty()) {
    const std::vector<double> attributes = attributes_of(map, mesh);
    io::write_mesh(files, work.results.mesh, {map.points, mesh, &mesh, &map, request.fill, attributes});
  }
  write_arrays(work.results, mesh, outputs, index);
  for (std::size_t k = 0; k < kConstraintArrayFiles.size(); ++k) {
    const ConstraintArrayFile& file = kConstraintArrayFiles[k];
    if (request.arrays[k].empty()) continue;
    io::write_npy(files, request.arrays[k], mesh.*file.values, file.columns, index);
  }
  if (!request.points.empty()) io::write_points(files, request.points, map.points);
  if (!request.polygons.empty()) {
    io::write_npy(files, request.polygons, request.separate ? sets_of(mesh) : mesh.polygons, 0, index);
  }
  files.write_out();
  facts.writing_seconds = stopwatch.seconds();
  research::Triangulation statistics;
  statistics.statistics = mesh.statistics;
  commit_with_statistics(work.results, statistics, facts, outputs);
  progress.finish();
}

}  // namespace

void add_domain_options(CLI::App* command, ConstraintRequest& request) {
  add_path(command, "--constraints", request.segments,
           fmt::format("Segments that become edges: {}, 2 point indices per row; maps have their own",
                       io::endings_for(io::Use::read_segments)));
  add_named_choice(command, "--outside", request.outside,
                   "Triangles: keep all, up to the hull; hull: without those outside; holes: nor those in "
                   "holes. Default: keep, for .poly hull, for polygons in GeoJSON holes",
                   kOutside);
  add_named_choice(command, "--fill", request.fill,
                   "How it is decided what is outside and what is a hole. Default: nesting, for polygons in "
                   "GeoJSON winding",
                   kFillRules);
  command
      ->add_option("--hole", request.holes,
                   "A place in a hole, which is left out up to the constraints around it; can be repeated")
      ->allow_extra_args(false)
      ->type_name("X,Y");
}

void add_constraint_options(CLI::App* command, ConstraintRequest& request) {
  add_domain_options(command, request);
  add_named_choice(command, "--crossings", request.crossings,
                   "Segments that cross: an error, or split where they do, which adds points", kCrossings)
      ->default_str("error");
  command->add_flag("--separate", request.separate, "GeoJSON: triangulate each polygon on its own");
  add_named_choice(command, "--overlaps", request.overlaps,
                   "GeoJSON: what is in several polygons belongs to the first one, or is an error", kOverlaps)
      ->default_str("first");
  for (std::size_t k = 0; k < kConstraintArrayFiles.size(); ++k) {
    add_path(command, kConstraintArrayFiles[k].option, request.arrays[k],
             kConstraintArrayFiles[k].description);
  }
  add_path(command, "--points", request.points,
           fmt::format("The points of the map and those that were added, to which indices refer: {}",
                       io::endings_for(io::Use::write_points)));
  add_path(command, "--polygons", request.polygons,
           "GeoJSON: for each triangle the number of its polygon, -1 for none: .npy");
}

void check_domain_options(const CLI::App& command, const std::string& input, ConstraintRequest& request) {
  if (io::is_map(input)) {
    refuse(command, "--constraints", fmt::format("{} has segments of its own", input));
  } else {
    io::check_segments_ending(request.segments);
  }
  holes_of(request);
  request.chose_outside = command.count("--outside") > 0;
  request.chose_fill = command.count("--fill") > 0;
}

io::Map read_domain(const std::string& input, ConstraintRequest& request) {
  io::Map map = read_input(input, request);
  choose_for(map, input, request);
  const std::vector<double> further_holes = holes_of(request);
  map.holes.insert(map.holes.end(), further_holes.begin(), further_holes.end());
  return map;
}

std::vector<std::int32_t> all_segments(const io::Map& map) {
  std::vector<std::int32_t> segments = map.segments;
  segments.insert(segments.end(), map.lines.begin(), map.lines.end());
  return segments;
}

Rings rings_of(const io::Map& map, FillRule fill) {
  if (fill == FillRule::nesting || (map.polygon_count() == 0 && map.lines.empty())) return {};
  return {map.ring_offsets, map.part_offsets, map.polygon_offsets};
}

bool has_constraints(const CLI::App& command, const std::string& input, ConstraintRequest& request) {
  const bool is_map = io::is_map(input);
  const bool has_any = is_map || !request.segments.empty();
  if (!has_any) {
    for (const auto& options : {kChoices, file_options()}) {
      for (const char* option : options) {
        refuse(command, option, "needs segments: --constraints, or a .poly or .geojson file as input");
      }
    }
    return false;
  }
  check_domain_options(command, input, request);
  if (io::ending_of(input) == ".poly" || !is_map) {
    for (const char* option : {"--separate", "--overlaps", "--polygons"}) {
      refuse(command, option, "needs polygons, from a .geojson file");
    }
  }
  if (request.separate) {
    refuse(command, "--hole", "does not say of which polygon, as it needs with --separate");
    refuse(command, "--overlaps", "with --separate, each polygon has triangles of its own");
  }
  for (const char* option : {"--memory", "--chunk-points", "--scratch"}) {
    refuse(command, option, "constraints need all points at once, not in chunks");
  }
  if (command.count("--mode") > 0 && command.get_option("--mode")->as<std::string>() != "blocks") {
    refuse(command, "--mode", "constraints need --mode blocks, the default");
  }
  request.chose_overlaps = command.count("--overlaps") > 0;
  return true;
}

int triangulate_with_constraints(const ConstrainedWork& work, const ConstraintRequest& asked) {
  ConstraintRequest request = asked;
  OutputFiles outputs(io::is_map(work.input) ? io::files_of_map(work.input)
                                             : std::vector<std::string>{work.input, request.segments});
  announce(outputs, work.results, true);
  announce_constraints(outputs, request);

  RunFacts facts;
  facts.input = work.input;
  facts.mode = "blocks";
  Progress progress(!work.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  io::Map map = read_domain(work.input, request);
  const auto triangulate = are_polygons(map, work, request) ? triangulate_polygons : triangulate_segments;
  facts.reading_seconds = stopwatch.restart();

  progress.update_slow("preparing the device", kCompiling);
  Triangulator triangulator(work.device);
  facts.opening_seconds = stopwatch.restart();
  const double* const coordinates = map.points.coordinates.data();
  facts.compiling_seconds = compile_kernels(map.points.size(), Mode::blocks, [&](std::size_t n) {
    note_compiling(triangulator.triangulate(coordinates, n), facts);
  });

  ConstrainedTriangulation mesh = naming_files(
      {{"segment", request.segments.empty() ? work.input : request.segments},
       {"point", work.input},
       {"polygon", work.input},
       {"hole", work.input}},
      [&] { return triangulate(triangulator, map, request, options_of(work, request, progress)); });
  facts.constraints = facts_of(map, request, mesh);
  map.points.coordinates.insert(map.points.coordinates.end(), mesh.added_points.begin(),
                                mesh.added_points.end());
  add_markers(mesh, map);
  write_results(work, request, map, mesh, facts, progress, outputs);

  if (!work.quiet) {
    std::string text = work.profile ? kernel_table(mesh.statistics) : "";
    for (const std::string& note : map.notes) text += "note: " + note + "\n";
    print(text + empty_note(mesh, request) + host_note(facts.compiling_note) +
          host_note(mesh.statistics.note) + summary(mesh.statistics, facts));
  }
  return kSuccess;
}

}  // namespace flaunay::cli
