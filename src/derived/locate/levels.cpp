#include "derived/locate/levels.hpp"

#include <algorithm>

#include "derived/locate/locator.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/locate/fixed_point.cl.hpp"
#include "launchers/locate/levels.cl.hpp"
#include "locate/nearest_search.h"
#include "tuning/tuning.hpp"

namespace flaunay::locate {
using namespace points;

namespace {

// The last level has fewer vertices of the largest set than this many times the ratio.
constexpr std::size_t kLeastSample = 4;

Stars make_stars(host::Runtime& runtime, Arena& own, const Locator& of, std::size_t vertices) {
  const std::size_t triangles = of.faces.size();
  Stars stars{own.allocate<cl_int>(vertices), own.allocate<kernel::fan_part>(triangles)};
  runtime.copy(of.first_triangle, 0, stars.starts, 0, vertices);
  runtime.map(triangles, kernels::begin_stars{.faces = of.faces, .starts = stars.starts});
  Arena::Scope scope(runtime.arena());
  auto fans = runtime.arena().allocate<kernel::fan_part>(triangles);
  const auto changed = runtime.arena().allocate<cl_int>(1);
  runtime.map(triangles, kernels::link_fans{.faces = of.faces, .points = of.points, .fans = fans});
  // After these passes links lead past every triangle, even if the mesh is not valid.
  for (std::size_t reach = 1; reach < 2 * std::max<std::size_t>(1, triangles); reach *= 4) {
    runtime.fill(changed, 1, cl_int{0});
    runtime.map(triangles,
                kernels::reach_along_fans{.before = fans, .after = stars.fans, .changed = changed});
    runtime.map(triangles,
                kernels::reach_along_fans{.before = stars.fans, .after = fans, .changed = changed});
    if (triangles > 0 && runtime.read_one(changed, 0) == 0) break;
  }
  runtime.copy(fans, 0, stars.fans, 0, triangles);
  return stars;
}

Buffer<kernel::vertex_box> make_boxes(host::Runtime& runtime, Arena& own, const Buffer<cl_double2>& points,
                                      std::size_t vertices) {
  int counts[kernel::BOX_LEVELS], begins[kernel::BOX_LEVELS];
  const int levels = kernel::box_levels(static_cast<int>(vertices), counts, begins);
  const auto boxes =
      own.allocate<kernel::vertex_box>(levels == 0 ? 0 : static_cast<std::size_t>(begins[levels - 1]) + 1);
  for (int level = 0; level < levels; ++level) {
    const auto count = static_cast<std::size_t>(counts[level]);
    if (level == 0) {
      runtime.map(count, kernels::box_vertices{.vertices = vertices, .points = points, .boxes = boxes});
    } else {
      runtime.map(count, kernels::box_boxes{
                             .first = begins[level], .first_below = begins[level - 1], .boxes = boxes});
    }
  }
  return boxes;
}

}  // namespace

SampleSizes sample_sizes(const std::vector<std::size_t>& vertices, std::size_t ratio) {
  SampleSizes sizes;
  sizes.sets = vertices.size();
  std::vector<std::size_t> counts = vertices;
  for (;;) {
    for (std::size_t& count : counts) count /= ratio;
    const std::size_t largest = counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
    if (largest == 0 || (sizes.levels > 0 && largest < kLeastSample)) return sizes;
    for (const std::size_t count : counts) sizes.offsets.push_back(sizes.offsets.back() + count);
    ++sizes.levels;
  }
}

void make_levels(host::Runtime& runtime, Locator& locator) {
  Arena& scratch = runtime.arena();
  Arena::Scope scope(scratch);
  const Tuning& tuning = tuning_of(runtime);
  std::vector<cl_int> first_vertices(locator.sets + 1);
  std::vector<kernel::mesh_set> records(locator.sets);
  const host::Runtime::Settled settled(runtime);
  runtime.read_later(locator.first_vertices, 0, locator.sets + 1, first_vertices.data());
  runtime.read(locator.records, 0, locator.sets, records.data());

  Levels levels;
  levels.own = std::make_shared<Arena>(runtime.memory());
  Arena& own = *levels.own;
  std::vector<cl_int> long_sets(locator.sets, -1), firsts;
  std::vector<std::size_t> vertices;
  for (std::size_t s = 0; s < locator.sets; ++s) {
    if (static_cast<std::size_t>(records[s].triangles) < tuning.levels_from) continue;
    long_sets[s] = static_cast<cl_int>(vertices.size());
    firsts.push_back(first_vertices[s]);
    vertices.push_back(static_cast<std::size_t>(first_vertices[s + 1] - first_vertices[s]));
  }
  // So that there is a level, whatever the tuning.
  const std::size_t most = vertices.empty() ? 2 : *std::max_element(vertices.begin(), vertices.end());
  const std::size_t ratio = std::min(std::max<std::size_t>(2, tuning.level_ratio), most);
  const SampleSizes sizes = sample_sizes(vertices, ratio);
  const std::size_t samples = sizes.offsets.back();
  levels.count = sizes.levels;
  levels.sets = sizes.sets;
  levels.long_sets = runtime.upload(own, long_sets);
  levels.below = own.allocate<cl_int>(samples);

  Arena results(runtime.memory()), persistent(runtime.memory());
  const auto coordinates = results.allocate<cl_double>(2 * samples);
  runtime.map(samples, kernels::draw_entries{.levels = sizes.levels,
                                             .sets = sizes.sets,
                                             .ratio = ratio,
                                             .offsets = runtime.upload(scratch, integers(sizes.offsets)),
                                             .first_vertices = runtime.upload(scratch, firsts),
                                             .points = locator.points,
                                             .coordinates = coordinates.as<cl_double2>(),
                                             .below = levels.below});
  auto given = coordinates;
  if (runtime.capabilities().fixed_point) {
    given = results.allocate<cl_double>(2 * samples);
    runtime.map(2 * samples,
                kernels::give_coordinates{.coordinates = coordinates, .doubles = given.as<cl_ulong>()});
  }
  DeviceMesh mesh = locator.triangulate(runtime, persistent, sizes.offsets, given, results);
  mesh.coordinates = coordinates;
  const auto samples_locator = std::make_shared<Locator>(make_walk_locator(runtime, own, mesh));
  measure_clearances(runtime, *samples_locator);
  const Locator& sampled = *samples_locator;
  const auto numbers = scratch.allocate<cl_int>(samples);
  runtime.fill(numbers, samples, cl_int{-1});
  runtime.map(sampled.faces.size(), kernels::number_entries{.faces = sampled.faces,
                                                            .first_triangle = sampled.first_triangle,
                                                            .source = sampled.source,
                                                            .numbers = numbers});
  const std::size_t lowest = sizes.offsets[sizes.sets];
  runtime.map(samples - lowest,
              kernels::find_below{.first = lowest, .numbers = numbers, .below = levels.below});
  levels.sample_stars = make_stars(runtime, own, sampled, samples);
  const auto all = static_cast<std::size_t>(first_vertices.back());
  levels.stars = make_stars(runtime, own, locator, all);
  levels.boxes = make_boxes(runtime, own, locator.points, all);
  // The arenas of this call end here.
  runtime.finish();
  locator.levels = std::move(levels);
  locator.samples = samples_locator;
}

}  // namespace flaunay::locate
