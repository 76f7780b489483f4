#include "derived/voronoi/clip.hpp"

#include <algorithm>
#include <vector>

#include "arithmetic/records.h"
#include "derived/voronoi/mend.hpp"
#include "derived/voronoi/voronoi.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/voronoi/clip.cl.hpp"
#include "launchers/voronoi/mend.cl.hpp"
#include "points/download.hpp"
#include "points/inspect.hpp"
#include "predicates/bounds.h"
#include "voronoi/codes.h"

namespace flaunay::voronoi {
using namespace points;

namespace {

// A polygon as kernels read it, and how coordinates are scaled.
struct DeviceClip {
  std::size_t size = 0;
  Buffer<cl_double> corners{};
  kernel::vertex_box box{};
  kernel::scaling scale{}, unscale{};
  float circle_bound = 0, side_bound = 0, nearness_bound = 0;
};

DeviceClip upload(host::Runtime& runtime, const ClipPolygon& polygon, const geometry::Scaling& scaling,
                  int bits) {
  DeviceClip clip;
  clip.size = polygon.size();
  clip.scale = scaling.powers();
  clip.unscale = kernel::scale_of(-scaling.shift);
  clip.circle_bound = scaling.bounds.circle;
  clip.side_bound = scaling.bounds.circle == 0 ? 0 : CENTRE_SIDE_BOUND;
  clip.nearness_bound = bits <= kernel::COARSE_QUERY_BITS ? 0 : NEARNESS_BOUND;
  std::vector<double> corners;
  for (const double c : polygon.corners) corners.push_back(kernel::scaled(c, clip.scale));
  clip.box.low = clip.box.high = {corners[0], corners[1]};
  for (std::size_t i = 0; i < corners.size(); i += 2) {
    clip.box.low = {std::min(clip.box.low.x, corners[i]), std::min(clip.box.low.y, corners[i + 1])};
    clip.box.high = {std::max(clip.box.high.x, corners[i]), std::max(clip.box.high.y, corners[i + 1])};
  }
  clip.corners = runtime.upload(runtime.arena(), std::move(corners));
  return clip;
}

// The Voronoi edges around all points.
struct Slots {
  std::size_t most = 0;       ///< no fewer than there are
  Buffer<cl_uint> offsets{};  ///< n + 1
  Buffer<cl_int> slots{};
  Buffer<cl_uint> codes{};  ///< the part inside of the polygon, if write_slots decided it, otherwise 0
  Buffer<cl_int> ahead{};

  operator kernels::slots() const { return {.offsets = offsets, .slots = slots, .codes = codes}; }
};

Slots make_slots(host::Runtime& runtime, const DeviceMesh& mesh, const Buffer<cl_uchar>& flats,
                 const Buffer<cl_int>& witnesses) {
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count(), hull = mesh.hull_offsets.back();
  Slots made;
  // A vertex on a line has two.
  made.most = 3 * triangles + 2 * hull;
  made.offsets = runtime.arena().allocate<cl_uint>(n + 1);
  made.slots = runtime.arena().allocate<cl_int>(made.most);
  made.codes = runtime.arena().allocate<cl_uint>(made.most);
  const Walks walks = measure_cells(runtime, mesh, made.offsets);
  made.ahead = walks.ahead;
  const auto hull_offsets = runtime.upload(runtime.arena(), integers(mesh.hull_offsets));
  const auto triangle_offsets = runtime.upload(runtime.arena(), integers(mesh.triangle_offsets));
  runtime.map(hull, kernels::add_open_slots{.points = n,
                                            .sets = mesh.sets(),
                                            .hull_offsets = hull_offsets,
                                            .triangle_offsets = triangle_offsets,
                                            .hull = mesh.hull,
                                            .sizes = made.offsets});
  host::exclusive_scan(runtime, made.offsets, n, made.offsets);
  runtime.fill(made.slots, made.most, cl_int{kernel::NO_SLOT});
  runtime.fill(made.codes, made.most, cl_uint{0});
  runtime.chunks(triangles, runtime.sizes().chunk(triangles),
                 kernels::write_slots{.triangles = mesh.triangles,
                                      .neighbors = mesh.neighbors,
                                      .ahead = walks.ahead,
                                      .firsts = walks.firsts,
                                      .flats = flats,
                                      .witnesses = witnesses,
                                      .offsets = made.offsets,
                                      .slots = made.slots,
                                      .codes = made.codes});
  runtime.map(hull, kernels::write_line_slots{.points = n,
                                              .sets = mesh.sets(),
                                              .triangle_count = triangles,
                                              .hull_offsets = hull_offsets,
                                              .triangle_offsets = triangle_offsets,
                                              .hull = mesh.hull,
                                              .offsets = made.offsets,
                                              .slots = made.slots});
  return made;
}

}  // namespace

void compute_clipped(host::Runtime& runtime, const DeviceMesh& input, const ClipPolygon& polygon,
                     const ClippedBuffers& result, const ProvideVertices& provide) {
  Arena::Scope scope(runtime.arena());
  const std::size_t n = input.points(), triangles = input.triangle_count(), hull = input.hull_offsets.back();
  if (n == 0) {
    runtime.fill(result.offsets, 1, cl_int{0});
    provide(0);
    return;
  }
  const geometry::Magnitudes magnitudes = points::inspect(runtime, input.coordinates, n);
  const geometry::Scaling scaling = scaling_with(polygon, magnitudes);
  const DeviceClip clip =
      upload(runtime, polygon, scaling, geometry::bits_of(geometry::joined(magnitudes, polygon.magnitudes)));
  DeviceMesh mesh = input;
  mesh.coordinates = points::scaled(runtime, input.coordinates, n, scaling.shift);

  const auto centres = runtime.arena().allocate<cl_double>(2 * triangles);
  const auto witnesses = runtime.arena().allocate<cl_int>(triangles);
  const auto flats = runtime.arena().allocate<cl_uchar>(triangles);
  write_circumcentres(runtime, mesh, centres);
  runtime.map_in_small_groups(triangles, kernels::locate_centres{.points = n,
                                                                 .clip = clip.size,
                                                                 .bound = clip.side_bound,
                                                                 .corners = clip.corners,
                                                                 .input = mesh.coordinates,
                                                                 .triangles = mesh.triangles,
                                                                 .centres = centres,
                                                                 .witnesses = witnesses});
  runtime.map_in_small_groups(triangles, kernels::mark_flat{.points = n,
                                                            .bound = clip.circle_bound,
                                                            .input = mesh.coordinates,
                                                            .triangles = mesh.triangles,
                                                            .neighbors = mesh.neighbors,
                                                            .centres = centres,
                                                            .flats = flats});
  const Slots slots = make_slots(runtime, mesh, flats, witnesses);
  const auto places = runtime.arena().allocate<cl_uint>(slots.most + 1);
  const kernels::clipped_diagram diagram{.points = n,
                                         .triangle_count = triangles,
                                         .hull_count = hull,
                                         .clip = clip.size,
                                         .corners = clip.corners,
                                         .input = mesh.coordinates,
                                         .triangles = mesh.triangles,
                                         .ahead = slots.ahead,
                                         .hull = mesh.hull};
  runtime.map_in_small_groups(slots.most, kernels::clip_slots{.clipped_diagram = diagram,
                                                              .side_bound = clip.side_bound,
                                                              .nearness_bound = clip.nearness_bound,
                                                              .witnesses = witnesses,
                                                              .slots = slots.slots,
                                                              .codes = slots.codes});
  runtime.map(n, kernels::join_centres{.input = mesh.coordinates,
                                       .triangles = mesh.triangles,
                                       .ahead = slots.ahead,
                                       .slots = slots,
                                       .centres = centres});
  runtime.map(slots.most,
              kernels::count_corners{.clipped_diagram = diagram, .slots = slots, .counts = places});
  runtime.map_in_small_groups(n, kernels::count_whole{.clipped_diagram = diagram,
                                                      .nearness_bound = clip.nearness_bound,
                                                      .slots = slots,
                                                      .counts = places});
  host::exclusive_scan(runtime, places, slots.most, places);
  runtime.map(n, kernels::find_cells{.offsets = slots.offsets, .places = places, .cells = result.offsets});
  const Buffer<cl_double> vertices = provide(runtime.read_one(places, slots.most));
  runtime.map_in_small_groups(slots.most, kernels::write_corners{.clipped_diagram = diagram,
                                                                 .nearness_bound = clip.nearness_bound,
                                                                 .box = clip.box,
                                                                 .unscale = clip.unscale,
                                                                 .centres = centres,
                                                                 .slots = slots,
                                                                 .places = places,
                                                                 .vertices = vertices});
  runtime.map(n, kernels::measure_clipped{.scale = clip.scale,
                                          .unscale = clip.unscale,
                                          .cells = result.offsets,
                                          .vertices = vertices,
                                          .areas = result.areas,
                                          .centroids = result.centroids});
}

std::size_t mend_clipped(host::Runtime& runtime, const DeviceMesh& mesh, const ClipPolygon& polygon,
                         const Buffer<cl_int>& offsets, const Buffer<cl_double>& vertices,
                         std::size_t count) {
  const std::size_t n = mesh.points();
  const auto mark = [&](const Buffer<cl_uint>& doubtful) {
    runtime.map(
        n, kernels::mark_doubtful{
               .input = mesh.coordinates, .offsets = offsets, .vertices = vertices, .doubtful = doubtful});
  };
  if (n == 0 || doubts_of(runtime, n, mark).empty()) return count;
  Cells cells{download(runtime, offsets, n + 1), download(runtime, vertices, 2 * count)};
  const std::vector<double> sites = download(runtime, mesh.coordinates, 2 * n);
  mend(runtime, mesh.point_offsets, sites.data(), polygon.corners, kNoPeriod, cells);
  runtime.write(offsets, 0, n + 1, cells.offsets.data());
  runtime.write(vertices, 0, cells.vertices.size(), cells.vertices.data());
  return cells.vertices.size() / 2;
}

void move_to_centroids(host::Runtime& runtime, std::size_t n, const ClippedBuffers& cells,
                       const Buffer<cl_double>& points) {
  runtime.map(
      n, kernels::move_to_centroids{.cells = cells.offsets, .centroids = cells.centroids, .points = points});
}

}  // namespace flaunay::voronoi
