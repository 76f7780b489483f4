#include "app/command/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "app/command/chunks.hpp"
#include "app/command/compiling.hpp"
#include "app/command/errors.hpp"
#include "app/command/heights.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/files/formats.hpp"
#include "app/files/layers.hpp"
#include "app/files/map.hpp"
#include "app/files/mesh.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::cli {
namespace {

// The options that ask for refinement, or those that say how.
std::vector<std::string> refinement_options(bool asking) {
  std::vector<std::string> options;
  if (asking) options = {"--region-areas", "--mesh-areas"};
#define ADD(member, option, asks, ...) \
  if (asks == asking) options.push_back(option);
  FLAUNAY_REFINEMENT_OPTIONS(ADD)
#undef ADD
  return options;
}

// An option for a member of Refinement. unit: a word for its value.
template <typename Value>
void add_member(CLI::App* command, const char* option, Value& value, const char* unit, const char* text) {
  if constexpr (std::is_enum_v<Value>) {
    add_named_choice(command, option, value, text, all_of<Value>())->default_str(word_of(Value{}));
  } else if constexpr (std::is_same_v<Value, bool>) {
    command->add_flag(option, value, text);
  } else {
    CLI::Option* const added = command->add_option(option, value, text)->type_name(unit);
    if (std::is_same_v<Value, std::size_t>) return;
    constexpr double kLargestAngle = 34;
    if (unit == std::string_view("DEGREES")) {
      added->check(CLI::Range(0.0, kLargestAngle));
    } else {
      added->check(CLI::NonNegativeNumber);
    }
  }
}

const std::vector<std::string> kChoices = {"--crossings", "--outside",  "--fill",
                                           "--hole",      "--separate", "--overlaps"};

// Calls visit(array, k) for each array that has a file.
template <typename Visit>
void for_each_file(const Visit& visit) {
  for_each_array(kConstrainedArrays, [&](const auto& array, std::size_t k) {
    if (*array.text != '\0') visit(array, k);
  });
}

std::vector<std::string> file_options() {
  std::vector<std::string> options = {"--points"};
  for_each_file([&](const auto& array, std::size_t) { options.push_back(option_of(array.name)); });
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

/// Appends the points of another map, and its segments, which bound nothing.
void add_edges(const io::Map& edges, io::Map& map) {
  const auto first = static_cast<std::int32_t>(map.points.size());
  const auto append = [](std::vector<double>& to, const std::vector<double>& more, std::size_t n,
                         std::size_t all) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    to.resize(n, kUnknown);
    to.insert(to.end(), more.begin(), more.end());
    to.resize(all, kUnknown);
  };
  std::vector<double>& coordinates = map.points.coordinates;
  coordinates.insert(coordinates.end(), edges.points.coordinates.begin(), edges.points.coordinates.end());
  const std::size_t n = static_cast<std::size_t>(first), all = map.points.size();
  if (!map.points.heights.empty() || !edges.points.heights.empty())
    append(map.points.heights, edges.points.heights, n, all);
  for (const std::int32_t end : all_segments(edges)) map.lines.push_back(first + end);
  if (!map.points.markers.empty()) map.points.markers.resize(all);
  map.has_others = true;
  map.has_height_field = map.has_height_field || edges.has_height_field;
  std::vector<std::string>& notes = map.points.notes;
  notes.insert(notes.end(), edges.points.notes.begin(), edges.points.notes.end());
}

io::Map read_input(const std::string& input, const io::Columns& columns, const ConstraintRequest& request,
                   bool with_heights, bool checks_crs) {
  io::check_columns(input, columns);
  io::Map map;
  if (io::is_map(input)) {
    map = io::read_map(input, columns);
  } else {
    map.points = io::read_points(input, columns, with_heights);
    map.has_others = true;
  }
  io::check_numbers(map.points, input);
  if (request.segments.empty()) return map;
  if (io::is_map(request.segments)) {
    if (!request.line_heights.empty()) map.check_height_field(input, columns.heights);
    const io::Map edges = io::read_lines(request.segments, columns, request.line_heights);
    if (checks_crs) io::check_same_crs(request.segments, edges.points.crs, input, map.points.crs);
    add_edges(edges, map);
  } else {
    map.segments = io::read_segments(request.segments, map.points.size());
  }
  return map;
}

/// What is outside, unless the user has chosen: of a .poly file what Triangle leaves out, and of polygons
/// what none of them covers.
void choose_for(const io::Map& map, const std::string& input, ConstraintRequest& request) {
  const bool has_polygons = map.polygon_count() > 0;
  if (!request.chose_outside && io::is_map(input) && request.mesh.empty()) {
    request.outside = has_polygons                      ? Outside::holes
                      : io::ending_of(input) == ".poly" ? Outside::hull
                                                        : Outside::keep;
  }
  if (!request.chose_fill) request.fill = has_polygons ? FillRule::even_odd : FillRule::nesting;
}

/// Whether there is a file for an array that is asked for in this way.
bool wants(const ConstraintRequest& request, AskedBy asked) {
  bool wanted = false;
  for_each_file([&](const auto& array, std::size_t k) {
    wanted = wanted || (array.asked == asked && !request.arrays[k].empty());
  });
  return wanted;
}

/// Throws Error(usage) for files of what the map does not have.
void check_carried(const io::Map& map, const std::string& input, const ConstraintRequest& request) {
  for_each_file([&](const auto& array, std::size_t k) {
    const auto check = [&](AskedBy asked, bool is_there, const char* what) {
      if (array.asked != asked || is_there || request.arrays[k].empty()) return;
      throw Error(ErrorKind::usage, fmt::format("{} has no {}, which {} needs", io::printable(input), what,
                                                option_of(array.name)));
    };
    check(AskedBy::segment_markers, !map.segment_markers.empty(), "markers of segments");
    check(AskedBy::point_markers, !map.points.markers.empty(), "markers of points");
    check(AskedBy::seeds, !map.regions.empty() || !request.mesh.empty(), "regions with attributes");
  });
  const auto has_area = [](const io::PolyRegion& region) { return region.area.has_value(); };
  if (request.region_areas && std::none_of(map.regions.begin(), map.regions.end(), has_area)) {
    throw Error(ErrorKind::usage, fmt::format("{} has no regions with areas, which --region-areas needs",
                                              io::printable(input)));
  }
}

/// Whether the map is given to the library as polygons, which knows then which triangle is in which of them.
/// Throws if the request needs that and it is not possible.
bool are_polygons(const io::Map& map, const Task& task, const ConstraintRequest& request) {
  const bool possible = map.polygon_count() > 0 && !map.has_others && map.holes.empty() &&
                        request.fill != FillRule::nesting && request.mesh.empty();
  if (!possible && (request.separate || request.chose_overlaps || wants(request, AskedBy::map))) {
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: --separate, --overlaps and --polygons need a file of polygons alone, without "
                    "lines and points, and neither --hole nor --fill nesting",
                    io::printable(task.input)));
  }
  return possible;
}

ConstrainedOptions options_of(const Task& task, const ConstraintRequest& request, Progress& progress) {
  ConstrainedOptions options;
  ask_for(task.results, options);
  // Pictures draw the border.
  options.neighbors = options.neighbors || !task.results.mesh.empty();
  options.profile = task.profile;
  options.crossings = request.crossings;
  options.outside = request.outside;
  options.fill_rule = request.fill;
  options.refinement = request.refinement;
  options.labels = io::shows_labels(task.results.mesh) || wants(request, AskedBy::labels);
  options.progress = progress.callback();
  return options;
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

ConstrainedTriangulation triangulate_polygons(Triangulator& triangulator, const io::Map& map,
                                              const ConstraintRequest& request, ConstrainedOptions options) {
  Polygons polygons;
  polygons.coordinates = map.points.coordinates.data();
  polygons.ring_offsets = map.ring_offsets;
  polygons.polygon_offsets = map.polygon_offsets;
  polygons.part_offsets = map.part_offsets;
  PolygonOptions polygon_options;
  static_cast<ConstrainedOptions&>(polygon_options) = std::move(options);
  polygon_options.map = !request.separate;
  polygon_options.overlaps = request.overlaps;
  ConstrainedTriangulation mesh = triangulator.polygons(polygons, polygon_options);
  if (request.separate) mesh.polygons = sets_of(mesh);
  return mesh;
}

// The mesh that is refined further, from its files.
struct MeshFiles {
  explicit MeshFiles(const ConstraintRequest& request) {
    if (request.mesh.empty()) return;
    triangles = io::read_triangles(request.mesh);
    attributes = io::read_triangle_attributes(request.mesh);
    if (request.areas.empty()) return;
    areas = io::read_areas(request.areas);
    if (3 * areas.size() == triangles.size()) return;
    throw Error(ErrorKind::input,
                fmt::format("{} has {} areas, but {} has {} triangles", io::printable(request.areas),
                            areas.size(), io::printable(request.mesh), triangles.size() / 3));
  }
  GivenTriangles view() const {
    return {triangles.data(), triangles.size() / 3, areas.empty() ? nullptr : areas.data(),
            attributes.empty() ? nullptr : attributes.data()};
  }
  std::vector<std::int32_t> triangles;
  std::vector<double> areas, attributes;
};

ConstrainedTriangulation triangulate_segments(Triangulator& triangulator, const io::Map& map,
                                              const ConstraintRequest& request, ConstrainedOptions options) {
  const std::vector<std::int32_t> segments = all_segments(map);
  Constraints constraints;
  constraints.rings = rings_of(map, request.fill);
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  constraints.holes = map.holes.data();
  constraints.hole_count = map.holes.size() / 2;
  if (!map.segment_markers.empty()) constraints.segment_markers = map.segment_markers.data();
  if (!map.points.markers.empty()) constraints.point_markers = map.points.markers.data();
  std::vector<double> seeds, attributes, areas;
  for (const io::PolyRegion& region : map.regions) {
    seeds.insert(seeds.end(), {region.place[0], region.place[1]});
    attributes.push_back(region.attribute);
    // As for Triangle, negative areas are none.
    areas.push_back(std::max(region.area.value_or(0), 0.0));
  }
  if (request.region_areas) options.refinement.seed_areas = areas.data();
  const MeshFiles mesh(request);
  options.refinement.mesh = mesh.view();
  // The attributes of a mesh count before those of regions.
  if (mesh.attributes.empty()) constraints.seed_attributes = attributes.data();
  if (mesh.attributes.empty() || request.region_areas) {
    constraints.seeds = seeds.data();
    constraints.seed_count = attributes.size();
  }
  return triangulator.constrained(map.points.coordinates.data(), map.points.size(), constraints, options);
}

void announce_constraints(OutputFiles& outputs, const ConstraintRequest& request) {
  for (const std::string& path : request.arrays) outputs.add(path, ".npy");
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
  facts.crossings = word_of(request.crossings);
  facts.outside = word_of(request.outside);
  facts.fill = word_of(request.fill);
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

/// A line that says why triangles have no properties of polygons; empty if they have them, or there are none.
std::string properties_note(const Task& task, const io::Map& map, const ConstrainedTriangulation& mesh) {
  const auto is_empty = [](const std::string& properties) { return properties.empty(); };
  const bool has_some = !std::all_of(map.properties.begin(), map.properties.end(), is_empty);
  const bool can_have_some = io::find_format(task.results.mesh, io::Use::write_features) != nullptr;
  if (!has_some || !mesh.polygons.empty() || !can_have_some) return "";
  return "note: triangles have no properties of polygons: these are known of files of polygons alone, "
         "without "
         "--hole and --fill nesting\n";
}

/// A line that says which triangles are worse than asked for; empty if there are none.
std::string refinement_note(const ConstrainedTriangulation& mesh, const std::vector<double>& points) {
  const std::vector<std::int32_t>& bad = mesh.refinement.bad_triangles;
  if (bad.empty()) return "";
  double place[2] = {0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(mesh.triangles[3 * static_cast<std::size_t>(bad[0]) + k]);
    for (std::size_t axis = 0; axis < 2; ++axis) place[axis] += points[2 * v + axis] / 3;
  }
  return fmt::format("note: worse than asked for: {}; the first one is triangle {} at ({}, {})\n",
                     excuses_text(mesh.refinement), bad[0], place[0], place[1]);
}

void write_results(const Task& task, const ConstraintRequest& request, const io::Map& map,
                   const ConstrainedTriangulation& mesh, RunFacts& facts, Progress& progress,
                   OutputFiles& outputs) {
  const io::IndexType index = index_type(task.index, map.points.size(), task.results);
  const auto write = [&] {
    if (!task.results.mesh.empty()) {
      io::write_mesh(outputs, task.results.mesh, {map.points, mesh, &mesh, &map, request.fill});
    }
    write_arrays(kTriangulationArrays, task.results.arrays, mesh, outputs, index);
    write_arrays(kConstrainedArrays, request.arrays, mesh, outputs, index);
    if (!request.points.empty()) io::write_points(outputs, request.points, map.points);
  };
  write_files(task.results, facts, progress, outputs, write, [&] {
    research::Triangulation statistics;
    statistics.statistics = mesh.statistics;
    return statistics_json(statistics, facts);
  });
}

}  // namespace

void add_domain_options(CLI::App* command, ConstraintRequest& request) {
  add_path(command, "--constraints", request.segments,
           fmt::format(
               "Segments that become edges: {}, 2 point indices per row; or lines and rings of a map, such "
               "as breaklines, whose points come behind the others",
               io::endings_for(io::Use::read_segments)));
  add_named_choice(command, "--outside", request.outside,
                   "Triangles: keep all, up to the hull; hull: without those outside; holes: nor those in "
                   "holes. Default: keep, for .poly hull, for polygons of maps holes",
                   all_of<Outside>());
  add_named_choice(command, "--fill", request.fill,
                   "How it is decided what is outside and what is a hole. Default: nesting, for polygons of "
                   "maps even-odd",
                   all_of<FillRule>());
  command
      ->add_option("--hole", request.holes,
                   "A place in a hole, which is left out up to the constraints around it; can be repeated")
      ->allow_extra_args(false)
      ->type_name("X,Y");
}

void add_constraint_options(CLI::App* command, ConstraintRequest& request) {
  add_domain_options(command, request);
  add_line_heights(command, request.line_heights, "--constraints");
  add_named_choice(command, "--crossings", request.crossings,
                   "Segments that cross: an error, or split where they do, which adds points",
                   all_of<Crossings>())
      ->default_str("error");
  command->add_flag("--separate", request.separate, "Polygons of a map: triangulate each on its own");
  add_named_choice(command, "--overlaps", request.overlaps,
                   "Polygons of a map: what is in several belongs to the first one, or is an error",
                   all_of<Overlaps>())
      ->default_str("first");
  end_group(command, "Segments and polygons");
#define ADD(member, option, asks, unit, text) \
  add_member(command, option, request.refinement.member, unit, text);
  FLAUNAY_REFINEMENT_OPTIONS(ADD)
#undef ADD
  command->add_flag("--region-areas", request.region_areas,
                    ".poly: add points until no triangle is larger than its region allows");
  add_path(
      command, "--mesh", request.mesh,
      fmt::format("Triangles of the points, such as those of a mesh that is refined further: only what they "
                  "cover is kept. {}",
                  io::endings_for(io::Use::read_triangles)));
  add_path(command, "--mesh-areas", request.areas,
           "With --mesh: the largest area within each of its triangles, in an .area file of Triangle");
  end_group(command, "Refinement");
  for_each_file([&](const auto& array, std::size_t k) { add_array(command, array, request.arrays[k]); });
  add_path(command, "--points", request.points,
           fmt::format("The points of the map and those that were added, to which indices refer: {}",
                       io::endings_for(io::Use::write_points)));
  end_group(command, "Outputs with constraints");
}

void check_domain_options(const CLI::App& command, const std::string& input, ConstraintRequest& request) {
  if (io::is_map(input) && !io::is_map(request.segments)) {
    refuse(command, "--constraints",
           fmt::format("{} has segments of its own, beside which there can be those of a map", input));
  } else if (!io::is_map(input) && !io::is_map(request.segments)) {
    io::check_segments_ending(request.segments);
  }
  holes_of(request);
  request.chose_outside = command.count("--outside") > 0;
  request.chose_fill = command.count("--fill") > 0;
}

io::Map read_domain(const std::string& input, const io::Columns& columns, ConstraintRequest& request,
                    bool with_heights, bool checks_crs) {
  io::Map map = read_input(input, columns, request, with_heights, checks_crs);
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
  const auto was_given = [&command](const std::string& option) { return command.count(option) > 0; };
  const std::vector<std::string> asking = refinement_options(true);
  const bool is_refined = std::any_of(asking.begin(), asking.end(), was_given);
  if (!is_refined)
    refuse_all(command, refinement_options(false), "needs --min-angle, --max-area or --region-areas");
  if (request.mesh.empty()) {
    refuse(command, "--mesh-areas", "needs the triangles: --mesh");
  } else {
    io::format_of(request.mesh, io::Use::read_triangles);
    refuse_all(command, {"--outside", "--separate", "--overlaps", "--polygons"}, "--mesh says what is kept");
  }
  const bool has_segments = is_map || !request.segments.empty() || !request.mesh.empty();
  if (!has_segments) {
    const char* const reason =
        "needs segments: --constraints, or a map (.poly, .geojson, .gpkg ...) as input";
    refuse_all(command, kChoices, reason);
    if (!is_refined) {
      refuse_all(command, file_options(), reason);
      return false;
    }
  }
  if (io::ending_of(input) != ".poly") refuse(command, "--region-areas", "needs regions, from a .poly file");
  if (is_map || !request.segments.empty()) check_domain_options(command, input, request);
  const char* const needing = has_segments ? "constraints need" : "refinement needs";
  if (io::ending_of(input) == ".poly" || !is_map) {
    refuse_all(command, {"--separate", "--overlaps", "--polygons"},
               "needs polygons, from .geojson or a layer");
  }
  if (request.separate) {
    refuse(command, "--hole", "does not say of which polygon, as it needs with --separate");
    refuse(command, "--overlaps", "with --separate, each polygon has triangles of its own");
  }
  refuse_all(command, {"--memory", "--chunk-points", "--scratch"},
             fmt::format("{} all points at once, not in chunks", needing));
  if (command.count("--mode") > 0 && command.get_option("--mode")->as<std::string>() != "blocks") {
    refuse(command, "--mode", fmt::format("{} --mode blocks, the default", needing));
  }
  request.chose_overlaps = command.count("--overlaps") > 0;
  return true;
}

int triangulate_with_constraints(const Task& task, const ConstraintRequest& asked) {
  ConstraintRequest request = asked;
  std::vector<std::string> inputs =
      io::is_map(task.input) ? io::files_of_map(task.input) : std::vector<std::string>{task.input};
  inputs.insert(inputs.end(), {io::without_layer(request.segments), request.mesh, request.areas});
  OutputFiles outputs(std::move(inputs));
  announce(outputs, task.results, true);
  announce_constraints(outputs, request);

  RunFacts facts;
  facts.input = task.input;
  Progress progress(!task.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  io::Map map = read_domain(task.input, task.columns, request, !task.results.mesh.empty(), task.crs.empty());
  check_carried(map, task.input, request);
  map.check_height_field(task.input, task.columns.heights);
  io::choose_crs(task.crs, task.input, task.results.mesh, map.points.crs);
  const auto triangulate = are_polygons(map, task, request) ? triangulate_polygons : triangulate_segments;
  facts.reading_seconds = stopwatch.restart();

  progress.update_slow("preparing the device", kCompiling);
  Triangulator triangulator(task.device);
  facts.opening_seconds = stopwatch.restart();
  const double* const coordinates = map.points.coordinates.data();
  facts.compiling_seconds = compile_kernels(map.points.size(), Mode::blocks, [&](std::size_t n) {
    note_compiling(triangulator.triangulate(coordinates, n), facts);
  });

  ConstrainedTriangulation mesh = naming_files(
      {{"segment", request.segments.empty() ? task.input : request.segments},
       {"point", task.input},
       {"polygon", task.input},
       {"hole", task.input}},
      [&] { return triangulate(triangulator, map, request, options_of(task, request, progress)); });
  facts.constraints = facts_of(map, request, mesh);
  if (request.is_refined()) facts.refinement = mesh.refinement;
  if (task.results.mesh.empty()) map.points.heights.clear();
  add_points(triangulator, all_segments(map), mesh, map.points);
  write_results(task, request, map, mesh, facts, progress, outputs);

  if (!task.quiet) {
    std::string text = task.profile ? kernel_table(mesh.statistics) : "";
    text += notes_text(map.points.notes) + withheld_note(task.input, map.points) +
            heights_note(task.input, task.results.mesh, map.points) + properties_note(task, map, mesh);
    print(text + empty_note(mesh, request) + refinement_note(mesh, map.points.coordinates) +
          host_note(facts.compiling_note) + host_note(mesh.statistics.note) + notes_text(outputs.notes) +
          summary(mesh.statistics, facts));
  }
  return kSuccess;
}

}  // namespace flaunay::cli
