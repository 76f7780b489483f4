#include "space/periodic/torus_plane.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "points/download.hpp"
#include "space/periodic/fold.hpp"
#include "space/periodic/triangulate_on_torus.hpp"
#include "space/triangulate.hpp"

namespace flaunay::call {

TorusPlane::TorusPlane(Implementation& self, const Triangulation& mesh) {
  check_with_places(mesh);
  lattice_ = periodic::lattice_of(mesh.space.period);
  host::Runtime& runtime = self.native().runtime;
  const std::vector<std::size_t>& offsets = point_offsets_ = mesh.point_offsets;
  // Wherever a query is on a cylinder or beyond, its nearest point is at most half a period away in the
  // direction that has one.
  const bool is_torus = periodic::repeats(lattice_, 0) && periodic::repeats(lattice_, 1);
  std::vector<periodic::Box> boxes;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
    boxes.push_back(periodic::box_of(mesh.places.data(), offsets[s], offsets[s + 1], lattice_));
  gaps_ = periodic::widest_gaps(runtime, mesh, boxes);
  for (std::size_t s = 0; s < boxes.size(); ++s)
    boxes[s].margin = is_torus
                          ? std::max(periodic::first_margin(boxes[s], offsets[s + 1] - offsets[s]), gaps_[s])
                          : std::numeric_limits<double>::infinity();
  // Margins are large enough if triangles that touch the box are images of those of the mesh, and the nearest
  // points of places in the box are near enough.
  for (std::vector<std::size_t> narrow;;) {
    plane_ = periodic::plane_of(runtime, mesh.places, offsets, boxes);
    planar_ = triangulate(self, {plane_.coordinates.data(), nullptr, plane_.places()}, plane_.offsets, {});
    narrow.clear();
    triangles_ = periodic::originals(runtime, plane_, planar_, mesh, narrow);
    if (narrow.empty()) break;
    for (const std::size_t s : narrow) {
      expect(!periodic::is_whole(boxes[s]),
             "the triangles are not those of a triangulation on a torus or a cylinder");
      boxes[s].margin *= periodic::kWider;
    }
  }
}

void TorusPlane::release() {
  planar_ = {};
  plane_ = {};
}

std::vector<double> TorusPlane::places(host::Runtime& runtime, const double* queries, std::size_t m) const {
  return periodic::to_places(runtime, queries, m, lattice_, "query");
}

void TorusPlane::number_points(host::Runtime& runtime, host::Arena& own, locate::Locator& locator) const {
  const auto vertices = static_cast<std::size_t>(runtime.read_one(locator.first_vertices, locator.sets));
  std::vector<cl_int> ids = points::download(runtime, locator.source, vertices),
                      in_place(point_offsets_.back());
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::uint64_t image = plane_.image(ids[v]);
    ids[v] = static_cast<cl_int>(kernel::point_of(image));
    if (kernel::is_in_place(image)) in_place[static_cast<std::size_t>(ids[v])] = static_cast<cl_int>(v);
  }
  runtime.write(locator.source, 0, vertices, ids.data());
  for (cl_int& v : ids) v = in_place[static_cast<std::size_t>(v)];
  locator.in_place = runtime.upload(own, std::move(ids));
  std::vector<cl_int> hull = points::download(runtime, locator.hull, locator.hull.size());
  for (cl_int& v : hull) v = static_cast<cl_int>(kernel::point_of(plane_.image(v)));
  runtime.write(locator.hull, 0, hull.size(), hull.data());
  locator.point_offsets = point_offsets_;
}

void TorusPlane::number_triangles(std::vector<std::int32_t>& found) const {
  for (std::int32_t& t : found) {
    if (t >= 0) t = triangles_[static_cast<std::size_t>(t)];
  }
}

void TorusPlane::check_gaps(const std::vector<std::size_t>& offsets) const {
  for (std::size_t s = 0; s + 1 < std::min(offsets.size(), gaps_.size() + 1); ++s) {
    if (offsets[s] == offsets[s + 1] || gaps_[s] <= std::min(lattice_.period[0], lattice_.period[1]))
      continue;
    throw Error(
        ErrorKind::input,
        "these points have no natural neighbors on their torus or cylinder: a circle without points is "
        "wider than the shorter period");
  }
}

}  // namespace flaunay::call
