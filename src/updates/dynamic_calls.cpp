// The public class DynamicTriangulation, whose batches are those of updates::LivingMesh.
#include <memory>
#include <optional>
#include <utility>

#include "call/frame.hpp"
#include "constrained/stages.hpp"
#include "flaunay/dynamic.hpp"
#include "geometry/halfedges.hpp"
#include "space/triangulate.hpp"
#include "updates/living_mesh.hpp"

namespace flaunay {
namespace {

// Throws for options that a triangulation that changes does not support.
void check_supported(const Constraints& constraints, const ConstrainedOptions& options) {
  call::expect(options.outside == Outside::keep && constraints.hole_count == 0,
               "nothing can be left out of a triangulation that changes");
  call::expect(!options.labels && constraints.seed_count == 0 && constraints.rings.segment_offsets.empty(),
               "a triangulation that changes has no labels, seeds and rings");
  call::expect(!options.refinement.is_wanted(), "a triangulation that changes cannot be refined");
  call::expect(constraints.segment_markers == nullptr && constraints.point_markers == nullptr,
               "a triangulation that changes has no markers");
}

}  // namespace

struct DynamicTriangulation::Implementation {
  Implementation(Triangulator& triangulator, const Options& wanted)
      : owner(TriangulatorAccess::shared(triangulator)), options(wanted) {}

  template <typename... Work>
  auto take_turn(const Work&... work) {
    return call::take_turn(*owner, work...);
  }

  // The options of triangulations from which the mesh is made.
  ConstrainedOptions plain(const ConstrainedOptions& wanted) const {
    ConstrainedOptions all = wanted;
    static_cast<Options&>(all) = options;
    all.neighbors = true;
    all.halfedges = all.areas = all.profile = false;
    return all;
  }

  ConstrainedTriangulation constrain(const double* coordinates, std::size_t n, const Constraints& constraints,
                                     const ConstrainedOptions& wanted) {
    const ConstrainedOptions all = plain(wanted);
    return call::constrain_and_leave(*owner, coordinates, {0, n}, constraints, all,
                                     call::request_of(all, false));
  }

  // Where batches change the mesh is chosen now.
  updates::LivingMesh& begin() {
    call::Engine& engine = owner->with_doubles(owner->for_host_memory());
    const auto triangulate = [this](const double* coordinates, std::size_t n, const Constraints& segments) {
      if (segments.segment_count > 0) return constrain(coordinates, n, segments, {});
      ConstrainedTriangulation fresh;
      static_cast<Triangulation&>(fresh) =
          call::triangulate(*owner, {coordinates, nullptr, n}, {0, n}, plain({}));
      return fresh;
    };
    return mesh.emplace(engine.runtime, updates::Anew{triangulate, [&engine]() -> std::shared_ptr<void> {
                                                        return std::make_shared<call::Frame>(engine);
                                                      }});
  }

  std::shared_ptr<call::Implementation> owner;
  Options options;
  std::optional<updates::LivingMesh> mesh;
};

DynamicTriangulation::DynamicTriangulation(Triangulator& triangulator, const double* coordinates,
                                           std::size_t n, const Options& options)
    : implementation_(std::make_unique<Implementation>(triangulator, options)) {
  implementation_->take_turn([&] { implementation_->begin().make(coordinates, n); });
}

DynamicTriangulation::DynamicTriangulation(Triangulator& triangulator, const DevicePoints& points,
                                           const Options& options)
    : implementation_(std::make_unique<Implementation>(triangulator, options)) {
  implementation_->take_turn([&] {
    const std::vector<double> coordinates = call::read_points(*implementation_->owner, points);
    implementation_->begin().make(coordinates.data(), coordinates.size() / 2);
  });
}

DynamicTriangulation::DynamicTriangulation(Triangulator& triangulator, const double* coordinates,
                                           std::size_t n, const Constraints& constraints,
                                           const ConstrainedOptions& options)
    : implementation_(std::make_unique<Implementation>(triangulator, options)) {
  implementation_->take_turn([&] {
    updates::LivingMesh& mesh = implementation_->begin();
    check_supported(constraints, options);
    mesh.make_constrained(coordinates, n,
                          [&] { return implementation_->constrain(coordinates, n, constraints, options); });
  });
}

DynamicTriangulation::~DynamicTriangulation() = default;
DynamicTriangulation::DynamicTriangulation(DynamicTriangulation&&) noexcept = default;
DynamicTriangulation& DynamicTriangulation::operator=(DynamicTriangulation&&) noexcept = default;

Changes DynamicTriangulation::insert(const double* coordinates, std::size_t m) {
  return implementation_->take_turn([&] { return implementation_->mesh->insert(coordinates, m); });
}

Changes DynamicTriangulation::insert(const DevicePoints& points) {
  return implementation_->take_turn([&] {
    const std::vector<double> coordinates = call::read_points(*implementation_->owner, points);
    return implementation_->mesh->insert(coordinates.data(), coordinates.size() / 2);
  });
}

Changes DynamicTriangulation::remove(const std::int32_t* points, std::size_t m) {
  return implementation_->take_turn([&] { return implementation_->mesh->remove(points, m); });
}

Changes DynamicTriangulation::move(const std::int32_t* points, const double* coordinates, std::size_t m) {
  return implementation_->take_turn([&] { return implementation_->mesh->move(points, coordinates, m); });
}

std::size_t DynamicTriangulation::numbers() const noexcept {
  return implementation_->mesh->points().numbers();
}
std::size_t DynamicTriangulation::point_count() const noexcept {
  return implementation_->mesh->points().count();
}
std::size_t DynamicTriangulation::triangle_count() const noexcept {
  return implementation_->mesh->triangle_count();
}
std::size_t DynamicTriangulation::row_count() const noexcept { return implementation_->mesh->row_count(); }
bool DynamicTriangulation::has_point(std::size_t number) const noexcept {
  return number < numbers() && implementation_->mesh->points().is_alive(static_cast<std::int32_t>(number));
}

std::vector<double> DynamicTriangulation::coordinates() const {
  return implementation_->mesh->points().coordinates();
}

TriangleRows DynamicTriangulation::rows() {
  return implementation_->take_turn([&] { return implementation_->mesh->rows(); });
}

void DynamicTriangulation::rows(DeviceTriangulation& result, const Enqueue& enqueue) {
  Implementation& self = *implementation_;
  call::take_turn(*self.owner, enqueue, [&] {
    TriangleRows all = self.mesh->rows();
    std::vector<cl_double> places = self.mesh->points().coordinates();
    call::Engine& device = self.owner->on_device();
    call::Frame frame(*self.owner, {device, &device}, enqueue);
    const auto triangles = frame.out<cl_int>(result.triangles, all.triangles.size(), "triangles");
    const auto neighbors = frame.out<cl_int>(result.neighbors, all.neighbors.size(), "neighbors");
    const auto coordinates = frame.out<cl_double>(result.coordinates, places.size(), "coordinates");
    frame.check_distinct();
    frame.begin();
    result.parts = {true, true, false, false, false, false};
    call::reset(Space::plane(), result);
    result.points = places.size() / 2;
    result.point_offsets = {0, result.points};
    result.triangle_offsets = {0, all.triangles.size() / 3};
    result.hull_offsets = {0, 0};
    result.statistics = {};
    call::write_result(frame.runtime, triangles, std::move(all.triangles));
    call::write_result(frame.runtime, neighbors, std::move(all.neighbors));
    call::write_result(frame.runtime, coordinates, std::move(places));
    frame.end();
  });
}

Triangulation DynamicTriangulation::triangulation() {
  Implementation& self = *implementation_;
  return self.take_turn([&] {
    Triangulation result = self.mesh->triangulation();
    result.triangle_offsets = {0, result.triangles.size() / 3};
    result.hull_offsets = {0, result.hull.size()};
    result.statistics.points = self.mesh->points().count();
    result.statistics.triangles = result.triangles.size() / 3;
    result.statistics.hull_vertices = result.hull.size();
    for (std::size_t i = 0; i < result.representatives.size(); ++i) {
      const std::int32_t v = result.representatives[i];
      result.statistics.duplicates += v >= 0 && static_cast<std::size_t>(v) != i;
    }
    if (self.options.halfedges) geometry::write_halfedges(self.options, result);
    if (!self.options.neighbors) result.neighbors.clear();
    if (self.options.areas) {
      const std::vector<double> all = self.mesh->points().coordinates();
      call::write_areas(self.owner->for_host_memory(), {all.data(), nullptr, all.size() / 2}, result);
    }
    return result;
  });
}

LivingConstraints DynamicTriangulation::constraints() {
  return implementation_->take_turn([&] { return implementation_->mesh->constraints(); });
}

}  // namespace flaunay
