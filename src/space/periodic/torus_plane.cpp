#include "space/periodic/torus_plane.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "blocks/weighted.hpp"
#include "geometry/arguments.hpp"
#include "points/download.hpp"
#include "space/periodic/fold.hpp"
#include "space/periodic/triangulate_on_torus.hpp"
#include "space/triangulate.hpp"
#include "space/weighted/cells.hpp"

namespace flaunay::call {
namespace {

constexpr const char* kOther =
    "the triangles are not those of a triangulation on a torus or a cylinder; points with weights need "
    "these, "
    "as they were triangulated";

}  // namespace

TorusPlane::TorusPlane(Implementation& self, const Triangulation& given, const double* weights)
    : point_offsets_(given.point_offsets) {
  check_with_places(given);
  expect(weights != nullptr || !has_weights(given), "queries among points with weights need these weights");
  weighted::Visible visible;
  if (weights != nullptr) {
    visible = weighted::visible_points(given.places.data(), given.point_offsets, given);
    visible_ = std::move(visible.numbers);
    expect(are_indices(visible.mesh.triangles, visible_.size()), kOther);
  }
  const Triangulation& mesh = weights != nullptr ? visible.mesh : given;
  const std::vector<double>& places = weights != nullptr ? visible.coordinates : given.places;
  const std::vector<std::size_t>& offsets = weights != nullptr ? visible.offsets : given.point_offsets;
  lattice_ = periodic::lattice_of(mesh.space.period);
  host::Runtime& runtime = self.native().runtime;
  // Wherever a query is on a cylinder or beyond, its nearest point is at most half a period away in the
  // direction that has one.
  const bool is_torus = periodic::repeats(lattice_, 0) && periodic::repeats(lattice_, 1);
  std::vector<periodic::Box> boxes;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
    boxes.push_back(periodic::box_of(places.data(), offsets[s], offsets[s + 1], lattice_));
  gaps_ =
      weights != nullptr ? std::vector<double>(boxes.size(), 0) : periodic::widest_gaps(runtime, mesh, boxes);
  for (std::size_t s = 0; s < boxes.size(); ++s)
    boxes[s].margin = is_torus
                          ? std::max(periodic::first_margin(boxes[s], offsets[s + 1] - offsets[s]), gaps_[s])
                          : std::numeric_limits<double>::infinity();
  // Margins are large enough if triangles that touch the box are images of those of the mesh, and the nearest
  // points of places in the box are near enough.
  for (std::vector<std::size_t> narrow;;) {
    plane_ = periodic::plane_of(runtime, places, offsets, boxes);
    const HostPoints points{plane_.coordinates.data(), nullptr, plane_.places()};
    if (weights != nullptr) {
      std::vector<double> of_images;
      for (std::size_t v = 0; v < points.count; ++v)
        of_images.push_back(weights[number(static_cast<std::int32_t>(v))]);
      std::vector<cl_int> none;
      const HostWeights with{
          of_images.data(), &blocks::kWeightedSolver, none, nullptr,
          [this](std::size_t v) { return static_cast<std::size_t>(number(static_cast<std::int32_t>(v))); }};
      planar_ = triangulate(self, points, with, plane_.offsets, {});
    } else {
      planar_ = triangulate(self, points, plane_.offsets, {});
    }
    narrow.clear();
    triangles_ = periodic::originals(runtime, plane_, planar_, mesh, narrow);
    if (narrow.empty()) break;
    for (const std::size_t s : narrow) {
      expect(!periodic::is_whole(boxes[s]), kOther);
      boxes[s].margin *= periodic::kWider;
    }
  }
}

std::int32_t TorusPlane::number(std::int32_t v) const {
  const auto i = static_cast<std::int32_t>(kernel::point_of(plane_.image(v)));
  return visible_.empty() ? i : visible_[static_cast<std::size_t>(i)];
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
    const bool is_in_place = kernel::is_in_place(plane_.image(ids[v])) != 0;
    ids[v] = number(ids[v]);
    if (is_in_place) in_place[static_cast<std::size_t>(ids[v])] = static_cast<cl_int>(v);
  }
  runtime.write(locator.source, 0, vertices, ids.data());
  for (cl_int& v : ids) v = in_place[static_cast<std::size_t>(v)];
  locator.in_place = runtime.upload(own, std::move(ids));
  std::vector<cl_int> hull = points::download(runtime, locator.hull, locator.hull.size());
  for (cl_int& v : hull) v = number(v);
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
