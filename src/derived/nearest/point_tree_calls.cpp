// The public class PointTree.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "call/frame.hpp"
#include "derived/nearest/point_tree.hpp"
#include "geometry/arguments.hpp"
#include "space/periodic/fold.hpp"
#include "space/periodic/triangulate_on_torus.hpp"
#include "space/sphere/triangulate_on_sphere.hpp"

namespace flaunay {

namespace {

// A thread answers this number of queries at a time.
constexpr std::size_t kRun = 512;

}  // namespace

struct PointTree::Implementation {
  Implementation(std::shared_ptr<call::Implementation> of, const double* coordinates, std::size_t n)
      : owner(std::move(of)), tree(coordinates, n) {}

  Implementation(Triangulator& triangulator, const Triangulation& mesh)
      : Implementation(TriangulatorAccess::shared(triangulator), nullptr, 0) {
    on_sphere.emplace(triangulator, mesh);
  }

  // queries: in the period, if there is one.
  Neighbors find(const double* queries, std::size_t m, const NeighborOptions& options) const {
    check_neighbors(options, m);
    Neighbors result;
    result.points.resize(m * options.count, -1);
    result.distances.resize(m * options.count, std::numeric_limits<double>::infinity());
    call::Frame call(owner->native());
    const points::QueryScaling scaling =
        *points::query_scaling(call.runtime, tree.range(), call.in(queries, 2 * m), {0, m});
    call.runtime.share((m + kRun - 1) / kRun, [&](std::size_t run) {
      tree.find(queries, run * kRun, std::min(m, (run + 1) * kRun), scaling, options, result);
    });
    call.end();
    return result;
  }

  // Each point once. Several images of one are in the tree, but mostly only one of them is near.
  Neighbors find_on_torus(const double* queries, std::size_t m, const NeighborOptions& options) const {
    const std::vector<double> places =
        periodic::to_places(owner->native().runtime, queries, m, *lattice, "query");
    Neighbors result = find(places.data(), m, options);
    if (has_repeated(result, options.count)) {
      NeighborOptions of_images = options;
      of_images.count = most_copies * options.count;
      Neighbors images = find(places.data(), m, of_images);
      result.points.assign(m * options.count, -1);
      result.distances.assign(m * options.count, std::numeric_limits<double>::infinity());
      for (std::size_t i = 0; i < m; ++i) {
        const auto row = result.points.begin() + static_cast<std::ptrdiff_t>(i * options.count);
        auto end = row;
        for (std::size_t k = i * of_images.count; k < (i + 1) * of_images.count; ++k) {
          const std::int32_t point = original(images.points[k]);
          if (point < 0 || end == row + static_cast<std::ptrdiff_t>(options.count)) break;
          if (std::find(row, end, point) != end) continue;
          result.distances[static_cast<std::size_t>(end - result.points.begin())] = images.distances[k];
          *end++ = point;
        }
      }
    } else {
      for (std::int32_t& point : result.points) point = original(point);
    }
    return result;
  }
  std::int32_t original(std::int32_t image) const {
    const bool is_point = image < static_cast<std::int32_t>(points);
    return is_point ? image : originals[static_cast<std::size_t>(image) - points];
  }
  bool has_repeated(const Neighbors& found, std::size_t count) const {
    std::vector<std::int32_t> row;
    for (std::size_t i = 0; i < found.points.size(); i += count) {
      row.clear();
      for (std::size_t k = i; k < i + count && found.points[k] >= 0; ++k)
        row.push_back(original(found.points[k]));
      std::sort(row.begin(), row.end());
      if (std::adjacent_find(row.begin(), row.end()) != row.end()) return true;
    }
    return false;
  }

  std::shared_ptr<call::Implementation> owner;
  nearest::PointTree tree;
  std::optional<call::SphereLocator> on_sphere;  // answers all queries there
  std::optional<periodic::Lattice> lattice;      // none in the plane
  std::size_t points = 0;                        // with a period: in front of their images
  std::vector<std::int32_t> originals;           // of these
  std::size_t most_copies = 1;                   // of one point: itself and its images
};

PointTree::PointTree(Triangulator& triangulator, const double* coordinates, std::size_t n)
    : implementation_(with_errors([&] {
        check_points(coordinates, n);
        return std::make_unique<Implementation>(TriangulatorAccess::shared(triangulator), coordinates, n);
      })) {}

PointTree::PointTree(Triangulator& triangulator, const Triangulation& mesh)
    : implementation_(with_errors([&] {
        const bool is_on_sphere = mesh.space.kind == SpaceKind::sphere;
        if (!is_on_sphere) call::check_with_places(mesh);
        call::expect(mesh.point_offsets.size() == 2, "a tree is of one set of points: make one for each set");
        if (is_on_sphere) return std::make_unique<Implementation>(triangulator, mesh);
        const periodic::Lattice lattice = periodic::lattice_of(mesh.space.period);
        periodic::Box box = periodic::box_of(mesh.places.data(), 0, mesh.places.size() / 2, lattice);
        for (const double length : lattice.reach) {
          if (std::isfinite(length)) box.margin = std::max(box.margin, length / 2);
        }
        const periodic::Plane plane =
            periodic::plane_of(call::Engine::of_thread().runtime, mesh.places, mesh.point_offsets, {box});
        auto self = std::make_unique<Implementation>(TriangulatorAccess::shared(triangulator),
                                                     plane.coordinates.data(), plane.coordinates.size() / 2);
        self->lattice = lattice;
        self->points = plane.own;
        std::size_t copies = 0;  // of one point, whose images follow each other
        for (const std::uint64_t image : plane.images) {
          const auto point = static_cast<std::int32_t>(kernel::point_of(image));
          copies = self->originals.empty() || self->originals.back() != point ? 2 : copies + 1;
          self->most_copies = std::max(self->most_copies, copies);
          self->originals.push_back(point);
        }
        return self;
      })) {}

PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

void PointTree::set_coordinates(SphereCoordinates coordinates) {
  with_errors([&] {
    call::expect(implementation_->on_sphere.has_value(),
                 "only queries on the sphere have coordinates of the sphere");
    implementation_->on_sphere->set_coordinates(coordinates);
  });
}

Neighbors PointTree::nearest(const double* queries, std::size_t m, const NeighborOptions& options) {
  Implementation& self = *implementation_;
  if (self.on_sphere) {
    with_errors([&] { check_neighbors(options, m); });
    return self.on_sphere->nearest(queries, m, options);
  }
  return call::take_turn(*self.owner, [&] {
    check_queries(queries, m);
    return self.lattice ? self.find_on_torus(queries, m, options) : self.find(queries, m, options);
  });
}

}  // namespace flaunay
