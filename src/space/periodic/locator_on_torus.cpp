// Queries on a torus or a cylinder.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "space/periodic/fold.hpp"
#include "space/periodic/triangulate_on_torus.hpp"
#include "space/spaces.hpp"
#include "space/triangulate.hpp"

namespace flaunay {

namespace {

class TorusLocator : public call::SpaceLocator {
 public:
  TorusLocator(Triangulator& used, const Triangulation& mesh)
      : owner(TriangulatorAccess::shared(used)), lattice(periodic::lattice_of(mesh.space.period)) {
    call::take_turn(*owner, [&] { make(used, mesh); });
  }

  std::vector<std::int32_t> locate(const double* queries, std::size_t m) override {
    return answer(queries, m, 1, std::int32_t{-1}, [&](const double* places) {
      std::vector<std::int32_t> found = locator->locate(places, m);
      for (std::int32_t& t : found) {
        if (t >= 0) t = numbers[static_cast<std::size_t>(t)];
      }
      return found;
    });
  }

  std::vector<std::int32_t> nearest(const double* queries, std::size_t m) override {
    return answer(queries, m, 1, std::int32_t{-1}, [&](const double* places) {
      std::vector<std::int32_t> found = locator->nearest(places, m);
      for (std::int32_t& v : found) v = static_cast<std::int32_t>(kernel::point_of(plane->image(v)));
      return found;
    });
  }

  std::vector<double> interpolate(const double* values, const double* queries, std::size_t m,
                                  const InterpolationOptions& options) override {
    check(options);
    return answer(queries, m, options.columns, options.fill, [&](const double* places) {
      check_array(values, check_columns(options.columns, plane->points()), "values", kMostCountable);
      return locator->interpolate(with_images(values, options.columns).data(), places, m, options);
    });
  }

 private:
  void make(Triangulator& used, const Triangulation& mesh) {
    call::check_with_places(mesh);
    call::expect(mesh.point_offsets.size() == 2, "periodic queries need one set of points");
    const std::size_t n = mesh.places.size() / 2;
    if (n == 0) return;
    periodic::Box box = periodic::box_of(mesh.places.data(), 0, n, lattice);
    constexpr double kWhole = std::numeric_limits<double>::infinity();
    // Wherever a query is on a cylinder or beyond, its nearest point is at most half a period away in the
    // direction that has one.
    const bool is_torus = periodic::repeats(lattice, 0) && periodic::repeats(lattice, 1);
    gap = periodic::widest_gap(owner->native().runtime, mesh, box);
    box.margin = is_torus ? std::max(periodic::first_margin(box, n), gap) : kWhole;
    for (; !make_within(box, used, mesh); box.margin *= periodic::kWider) {
      if (periodic::is_whole(plane->box))
        throw Error(ErrorKind::usage,
                    "the triangles are not those of a triangulation on a torus or a cylinder");
    }
  }

  /// Returns whether the margin is large enough: so that triangles that touch the box are images of those of
  /// the mesh, and the nearest points of places in the box are near enough.
  bool make_within(const periodic::Box& box, Triangulator& used, const Triangulation& mesh) {
    host::Runtime& runtime = owner->native().runtime;
    plane = periodic::plane_of(runtime, mesh.places, box);
    const double* const places = plane->coordinates.data();
    const std::size_t n = plane->coordinates.size() / 2;
    const Triangulation planar = call::triangulate(*owner, {places, nullptr, n}, {0, n}, {});
    if (!periodic::is_whole(plane->box) && !periodic::is_box_inside(*plane, planar.hull)) return false;
    numbers = periodic::originals(runtime, *plane, planar.triangles, mesh);
    if (numbers.empty() && !planar.triangles.empty()) return false;
    const call::WithinTurn within(*owner);
    locator.emplace(used, places, n, planar);
    return true;
  }

  /// Returns the result of work(places), or if there are no points, `columns` numbers of this value per
  /// query.
  template <typename T, typename Work>
  std::vector<T> answer(const double* queries, std::size_t m, std::size_t columns, T none, const Work& work) {
    return call::take_turn(*owner, [&] {
      check_queries(queries, m);
      const std::size_t results = check_columns(columns, m);
      const std::vector<double> places =
          periodic::to_places(owner->native().runtime, queries, m, lattice, "query");
      if (!locator) return std::vector<T>(results, none);
      const call::WithinTurn within(*owner);
      return work(places.data());
    });
  }

  /// Rows of numbers per point, and then those of images.
  std::vector<double> with_images(const double* values, std::size_t columns) const {
    std::vector<double> all(values, values + columns * plane->points());
    all.reserve(columns * (plane->points() + plane->images.size()));
    for (const std::uint64_t image : plane->images) {
      const double* const row = values + columns * static_cast<std::size_t>(kernel::point_of(image));
      all.insert(all.end(), row, row + columns);
    }
    return all;
  }

  /// Throws unless a method of interpolation is possible. The natural neighbors of a place in the box are
  /// corners of triangles whose circles contain it, and no circle without points is wider than the gap. So if
  /// the margin, or the period, is as wide, these circles are the same in the plane as on the torus. On a
  /// cylinder, circles can be wider whose centre is beyond an end. But at the end they are at most a period
  /// wide, since images of its point are that far apart, and between the ends less than there: so all these
  /// corners are at most a period away from the place.
  void check(const InterpolationOptions& options) const {
    check_enumerator(options.method);
    call::expect(options.method != Interpolation::clough_tocher && options.gradients == nullptr &&
                     options.device_gradients == nullptr,
                 "values on a torus or a cylinder are interpolated without gradients");
    if (options.method != Interpolation::sibson && options.method != Interpolation::laplace) return;
    if (locator && gap > std::min(lattice.period[0], lattice.period[1]))
      throw Error(
          ErrorKind::input,
          "these points have no natural neighbors on their torus or cylinder: a circle without points is "
          "wider than the shorter period");
  }

  std::shared_ptr<call::Implementation> owner;
  periodic::Lattice lattice;
  double gap = 0;  // the width of the widest circle without points, or more
  std::optional<periodic::Plane> plane;
  std::vector<std::int32_t> numbers;  // per triangle in the plane, that of the mesh
  std::optional<Locator> locator;     // in the plane; none without points
};

}  // namespace

std::unique_ptr<call::SpaceLocator> call::make_locator_on_torus(Triangulator& triangulator,
                                                                const Triangulation& triangulation) {
  return std::make_unique<TorusLocator>(triangulator, triangulation);
}

}  // namespace flaunay
