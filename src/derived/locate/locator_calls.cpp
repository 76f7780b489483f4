// The public class Locator.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "blocks/run.hpp"
#include "call/mesh_of.hpp"
#include "constrained/stages.hpp"
#include "constrained/whole_mesh.hpp"
#include "derived/interpolate/gradients.hpp"
#include "derived/interpolate/interpolate.hpp"
#include "derived/interpolate/natural.hpp"
#include "derived/locate/locator.hpp"
#include "derived/locate/read_back.hpp"
#include "space/periodic/torus_plane.hpp"
#include "space/sphere/triangulate_on_sphere.hpp"
#include "space/triangulate.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace call {

/// A locator, and where it answers queries. Those in host memory need no device.
struct Answerer {
  explicit Answerer(const Place& used) : place(used), own(used.engine.runtime.memory()) {}

  /// Makes the locator in a call, and ends it.
  geometry::Fitted<geometry::Done> make(Frame& call, const points::DeviceMesh& mesh) {
    auto made = locate::make_locator(call.runtime, own, mesh, blocks::run);
    if (!made) return made.too_wide();
    locator = *std::move(made);
    if (constrained) locate::constrain(call.runtime, own, *constrained, locator);
    if (on_torus != nullptr) on_torus->number_points(call.runtime, own, locator);
    call.end();
    return geometry::Done();
  }
  /// mesh: without coordinates.
  template <typename Points>
  geometry::Fitted<geometry::Done> make(Frame& call, const Points& points, points::DeviceMesh mesh) {
    mesh.coordinates = call.points(points);
    return make(call, mesh);
  }

  Place place;
  Arena own;
  locate::Locator locator;
  /// WholeMesh::constrained of a mesh with constraints; null without these.
  std::shared_ptr<const std::vector<std::uint8_t>> constrained;
  const TorusPlane* on_torus = nullptr;  ///< for the locator of that plane
};

}  // namespace call

struct Locator::Implementation {
  Implementation(std::shared_ptr<Triangulator::Implementation> used, call::Engine& asked)
      : owner(std::move(used)), asked_(asked) {}

  template <typename... Work>
  auto take_turn(const Work&... work) {
    return call::take_turn(*owner, work...);
  }

  // The following members are called in a turn of the owner's.

  /// Makes the locator, in fixed point if that is what the engine computes in and the points fit.
  /// make(answerer).
  template <typename Make>
  void make_with(const Make& make) {
    const auto with_doubles = [&](const std::string&) {
      fixed.reset();
      doubles_ = std::make_unique<call::Answerer>(call::with_doubles(*owner, asked_));
      doubles_->constrained = constrained;
      doubles_->on_torus = on_torus ? &*on_torus : nullptr;
      return make(*doubles_);
    };
    // On a torus triangles are made with doubles, too.
    if (asked_.has_doubles() || on_torus) {
      *with_doubles("");
      return;
    }
    fixed = std::make_unique<call::Answerer>(call::Place{asked_, &asked_});
    fixed->constrained = constrained;
    call::in_fixed_point_or([&] { return make(*fixed); }, with_doubles);
  }

  /// Makes the locator of a mesh in host memory.
  void make_from(const double* coordinates, const std::vector<std::size_t>& offsets,
                 const Triangulation& mesh) {
    const call::HostPoints points{coordinates, nullptr, offsets.empty() ? 0 : offsets.back()};
    make_with([&](call::Answerer& by) {
      call::Frame call(by.place.engine);
      call.check_size(points.count);
      return by.make(call, points, call::mesh_of(call, points, offsets, mesh));
    });
    point_count = points.count;
  }

  /// The locator for nearest points. Constraints do not change which point is nearest, so for a mesh with
  /// constraints it is the locator of a triangulation without them, made when it is first needed.
  Implementation& for_nearest() {
    expect_no_weights();
    if (all_points.empty()) return *this;
    if (!without_constraints_) {
      const std::vector<std::size_t> offsets = {0, all_points.size() / 2};
      Options options;
      options.neighbors = true;
      const Triangulation mesh =
          call::triangulate(*owner, {all_points.data(), nullptr, offsets.back()}, offsets, options);
      auto made = std::make_unique<Implementation>(owner, asked_);
      made->make_from(all_points.data(), offsets, mesh);
      without_constraints_ = std::move(made);
    }
    return *without_constraints_;
  }

  Implementation& for_method(Interpolation method) {
    if (is_natural(method)) expect_no_weights();
    return method == Interpolation::nearest ? for_nearest() : *this;
  }

  static bool is_natural(Interpolation method) {
    return method == Interpolation::sibson || method == Interpolation::laplace;
  }

  /// The locator with doubles; made of the other one when it is first needed.
  call::Answerer& doubles() {
    if (!doubles_) {
      auto made = std::make_unique<call::Answerer>(call::with_doubles(*owner, asked_));
      made->constrained = constrained;
      const call::Frame from(asked_);
      call::Frame call(made->place.engine);
      call.check_size(point_count);
      *made->make(call, locate::read_back(from.runtime, fixed->locator, call.runtime));
      doubles_ = std::move(made);
    }
    return *doubles_;
  }

  /// Answers by the locator in fixed point if there is one and the queries fit it, or else by the one with
  /// doubles.
  template <typename Answer>
  auto answer_with(const Answer& answer) {
    return call::in_fixed_point_or([&] { return answer(fixed ? *fixed : doubles()); },
                                   [&](const std::string&) { return answer(doubles()); });
  }

  /// The places of queries on a torus, which replace these. Elsewhere nothing changes.
  std::vector<double> placed(const double*& queries, std::size_t m) const {
    if (!on_torus) return {};
    std::vector<double> places = on_torus->places(owner->native().runtime, queries, m);
    queries = places.data();
    return places;
  }

  /// Answers queries in host memory. columns: the length of each result. work(call, locator, queries, m,
  /// offsets, results) enqueues the kernels that write the results.
  template <typename Result, typename Work>
  geometry::Fitted<std::vector<Result>> answer(call::Answerer& by, const double* queries,
                                               const std::vector<std::size_t>& offsets, std::size_t columns,
                                               const Work& work) {
    check_offsets(offsets);
    const std::size_t m = offsets.back();
    check_queries(queries, m);
    const std::size_t numbers = check_columns(columns, m);
    const std::vector<double> places = placed(queries, m);
    std::vector<Result> results;
    call::Frame call(by.place.engine);
    const auto output = call.out<Result>(results, numbers);
    const geometry::Fitted<geometry::Done> done =
        work(call, by.locator, call.points(call::HostPoints{queries, nullptr, m}), m, offsets, output);
    if (!done) return done.too_wide();
    call.end();
    return results;
  }

  /// Runs a call on device memory. work(call) enqueues it, and ends the call if its input fits.
  template <typename Work>
  auto on_device(call::Answerer& by, const Enqueue& enqueue, const Work& work) {
    call::expect(by.place.device != nullptr,
                 "the locator was made in host memory without OpenCL, so it has no queries in device memory; "
                 "make it from device memory, or name a device");
    call::Frame call(*owner, by.place, enqueue);
    call.begin();
    return work(call);
  }

  /// Answers queries in device memory. columns and work: as above. read: further buffers that are read, or
  /// null.
  template <typename Result, typename Work>
  geometry::Fitted<geometry::Done> answer(call::Answerer& by, const DevicePoints& queries,
                                          const std::vector<cl_mem>& read, DeviceBuffer& result,
                                          std::size_t columns, const char* what, const Enqueue& enqueue,
                                          const Work& work) {
    return on_device(by, enqueue, [&](call::Frame& call) {
      call.check(queries, "queries");
      check_count(queries.count, "queries", kMostIndexed / 2);
      const std::size_t numbers = check_columns(columns, queries.count);
      const std::vector<std::size_t> offsets = call.offsets(queries);
      const auto output = call.out<Result>(result, numbers, what);
      call.check_distinct(read);
      const geometry::Fitted<geometry::Done> done =
          work(call, by.locator, call.points(queries), queries.count, offsets, output);
      if (done) call.end();
      return done;
    });
  }

  /// Answers queries by one number each.
  template <typename Work>
  std::vector<std::int32_t> answer_all(const double* queries, const std::vector<std::size_t>& offsets,
                                       const Work& work) {
    return answer_with(
        [&](call::Answerer& by) { return answer<std::int32_t>(by, queries, offsets, 1, work); });
  }
  template <typename Work>
  void answer_all(const DevicePoints& queries, DeviceBuffer& result, const char* what, const Enqueue& enqueue,
                  const Work& work) {
    answer_with(
        [&](call::Answerer& by) { return answer<cl_int>(by, queries, {}, result, 1, what, enqueue, work); });
  }

  /// The length of the array of values.
  std::size_t numbers(std::size_t columns) const { return check_columns(columns, point_count); }

  static flaunay::interpolate::NaturalWeights natural_weights(Interpolation method) {
    call::expect(is_natural(method), "natural neighbours have the weights of Sibson or of Laplace");
    return method == Interpolation::sibson ? flaunay::interpolate::NaturalWeights::sibson
                                           : flaunay::interpolate::NaturalWeights::laplace;
  }

  /// Estimated, unless there are some. given: the caller's, in host or device memory.
  static flaunay::interpolate::Gradients gradients_by(const GradientOptions& options, bool are_given,
                                                      Buffer<cl_double> given) {
    flaunay::interpolate::check(options);
    return {are_given, std::move(given), options.tolerance, options.iterations};
  }

  /// Returns the work that interpolates at queries. Values and gradients are in host or device memory; null
  /// gradients are estimated.
  template <typename Values>
  auto interpolation(const InterpolationOptions& options, Values values, Values gradients) {
    return [this, &options, values, gradients](call::Frame& call, auto& locator, const auto&... queries) {
      const std::size_t count = numbers(options.columns);
      const bool are_given = gradients != nullptr;
      const auto known = gradients_by(options.estimation, are_given,
                                      call.in<cl_double>(gradients, are_given ? 2 * count : 0, "gradients"));
      const flaunay::interpolate::Table table{call.in<cl_double>(values, count, "values"), options.columns,
                                              options.fill};
      namespace by = flaunay::interpolate;
      switch (options.method) {
        case Interpolation::linear:
          by::linear(call.runtime, locator, table, queries...);
          break;
        case Interpolation::nearest:
          by::nearest(call.runtime, locator, table, queries...);
          break;
        case Interpolation::clough_tocher:
          by::clough_tocher(call.runtime, locator, table, known, queries...);
          break;
        case Interpolation::sibson:
        case Interpolation::laplace:
          by::natural(call.runtime, locator, natural_weights(options.method), table, queries...);
          break;
        default:
          throw Error(ErrorKind::usage, "no such method of interpolation");
      }
      return geometry::Done();
    };
  }

  /// Estimates gradients in a call. The number of values is that of numbers().
  template <typename Values, typename Results>
  void estimate_gradients(call::Frame& call, const locate::Locator& locator, Values values,
                          std::size_t columns, const GradientOptions& options, Results& results) {
    const std::size_t count = numbers(columns);
    const auto output = call.out<cl_double>(results, 2 * count, "gradients");
    const flaunay::interpolate::Table table{call.in<cl_double>(values, count, "values"), columns,
                                            std::numeric_limits<double>::quiet_NaN()};
    call.check_distinct();
    flaunay::interpolate::estimate_gradients(call.runtime, locator, table, gradients_by(options, false, {}),
                                             output);
  }

  /// Throws Error(usage) for what a regular triangulation does not tell.
  void expect_no_weights() const {
    call::expect(
        !has_weights,
        "among points with weights a locator finds neither nearest points, as a tree of points does, nor "
        "natural neighbours");
  }

  /// Throws Error(usage) for what there is in the plane alone.
  void expect_plane(const char* what) const {
    call::expect(!on_torus && !on_sphere,
                 [&] { return fmt::format("{}: for triangulations in the plane alone", what); });
  }

  std::shared_ptr<Triangulator::Implementation> owner;
  std::optional<call::TorusPlane> on_torus;
  std::unique_ptr<call::SphereLocator> on_sphere;  ///< answers all queries there
  std::unique_ptr<call::Answerer> fixed;  ///< null if the engine has doubles, and for points that do not fit
  std::size_t point_count = 0;
  bool has_weights = false;
  // All points of a mesh with constraints, and WholeMesh::constrained; empty without constraints.
  std::vector<double> all_points{};
  std::shared_ptr<const std::vector<std::uint8_t>> constrained{};

 private:
  call::Engine& asked_;  ///< one of the owner's
  std::unique_ptr<Implementation> without_constraints_;
  std::unique_ptr<call::Answerer> doubles_;
};

namespace {

constexpr auto kLocate = [](call::Frame& call, auto&&... all) {
  return locate::locate(call.runtime, all...);
};
constexpr auto kNearest = [](call::Frame& call, auto&&... all) {
  return locate::nearest(call.runtime, all...);
};

}  // namespace

std::unique_ptr<Locator::Implementation> Locator::make(Triangulator& triangulator, bool on_device) {
  const auto& owner = triangulator.implementation_;
  return with_errors([&] {
    call::Engine& asked = on_device ? owner->on_device() : owner->for_host_memory();
    return std::make_unique<Implementation>(owner, asked);
  });
}

Locator::Locator(Triangulator& triangulator, const double* coordinates, std::size_t n,
                 const Triangulation& triangulation)
    : Locator(triangulator, coordinates, std::vector<std::size_t>{0, n}, triangulation) {}

Locator::Locator(Triangulator& triangulator, const double* coordinates,
                 const std::vector<std::size_t>& offsets, const Triangulation& triangulation)
    : implementation_(make(triangulator, false)) {
  Implementation& self = *implementation_;
  self.has_weights = call::has_weights(triangulation);
  call::take_turn(*self.owner, [&] { self.make_from(coordinates, offsets, triangulation); });
}

Locator::Locator(Triangulator& triangulator, const double* coordinates, std::size_t n,
                 const ConstrainedTriangulation& triangulation)
    : implementation_(make(triangulator, false)) {
  Implementation& self = *implementation_;
  call::take_turn(*self.owner, [&] {
    constrained::WholeMesh whole = constrained::fill(
        coordinates, n, triangulation,
        [&](const std::vector<double>& points, const Constraints& constraints) {
          ConstrainedOptions options;
          options.neighbors = options.labels = true;
          options.fill_rule = FillRule::even_odd;
          return call::constrain_and_leave(*self.owner, points.data(), {0, points.size() / 2}, constraints,
                                           options, call::request_of(options, false));
        });
    self.all_points = std::move(whole.coordinates);
    self.constrained = std::make_shared<const std::vector<std::uint8_t>>(std::move(whole.constrained));
    self.make_from(self.all_points.data(), {0, self.all_points.size() / 2}, whole.mesh);
  });
}

Locator::Locator(Triangulator& triangulator, const DevicePoints& points,
                 const DeviceTriangulation& triangulation, const Enqueue& enqueue)
    : implementation_(make(triangulator, true)) {
  Implementation& self = *implementation_;
  self.take_turn(enqueue, [&] {
    self.make_with([&](call::Answerer& by) {
      return self.on_device(by, enqueue, [&](call::Frame& call) {
        call.check(points, "points");
        call.check_size(points.count);
        return by.make(call, points, call::mesh_of(call, points, triangulation));
      });
    });
  });
  self.point_count = points.count;
  self.has_weights = call::has_weights(triangulation);
}

Locator::Locator(Triangulator& triangulator, const Triangulation& triangulation, const double* weights)
    : implementation_(make(triangulator, false)) {
  Implementation& self = *implementation_;
  self.take_turn([&] {
    call::expect(triangulation.space.kind != SpaceKind::plane,
                 "queries in the plane need the coordinates of the points, too");
    if (triangulation.space.kind == SpaceKind::sphere) {
      const call::WithinTurn within(*self.owner);
      self.on_sphere = std::make_unique<call::SphereLocator>(triangulator, triangulation);
      return;
    }
    call::TorusPlane& plane = self.on_torus.emplace(*self.owner, triangulation, weights);
    self.has_weights = weights != nullptr;
    self.make_from(plane.coordinates().data(), plane.offsets(), plane.planar());
    self.point_count = triangulation.representatives.size();
    plane.release();
  });
}

Locator::~Locator() = default;
Locator::Locator(Locator&&) noexcept = default;
Locator& Locator::operator=(Locator&&) noexcept = default;

void Locator::set_coordinates(SphereCoordinates coordinates) {
  with_errors([&] {
    call::expect(implementation_->on_sphere != nullptr,
                 "only queries on the sphere have coordinates of the sphere");
    implementation_->on_sphere->set_coordinates(coordinates);
  });
}

std::vector<std::int32_t> Locator::locate(const double* queries, std::size_t m) {
  return locate(queries, std::vector<std::size_t>{0, m});
}

std::vector<std::int32_t> Locator::locate(const double* queries, const std::vector<std::size_t>& offsets) {
  Implementation& self = *implementation_;
  if (self.on_sphere) return self.on_sphere->locate(queries, offsets);
  return self.take_turn([&] {
    std::vector<std::int32_t> found = self.answer_all(queries, offsets, kLocate);
    if (self.on_torus) self.on_torus->number_triangles(found);
    return found;
  });
}

void Locator::locate(const DevicePoints& queries, DeviceBuffer& triangles, const Enqueue& enqueue) {
  implementation_->expect_plane("queries in device memory");
  implementation_->take_turn(enqueue, [&] {
    implementation_->answer_all(queries, triangles, "located triangles", enqueue, kLocate);
  });
}

std::vector<std::int32_t> Locator::nearest(const double* queries, std::size_t m) {
  return nearest(queries, std::vector<std::size_t>{0, m});
}

std::vector<std::int32_t> Locator::nearest(const double* queries, const std::vector<std::size_t>& offsets) {
  Implementation& self = *implementation_;
  if (self.on_sphere) return self.on_sphere->nearest(queries, offsets);
  return self.take_turn([&] { return self.for_nearest().answer_all(queries, offsets, kNearest); });
}

void Locator::nearest(const DevicePoints& queries, DeviceBuffer& points, const Enqueue& enqueue) {
  implementation_->expect_plane("queries in device memory");
  implementation_->take_turn(enqueue, [&] {
    implementation_->for_nearest().answer_all(queries, points, "nearest points", enqueue, kNearest);
  });
}

std::vector<double> Locator::interpolate(const double* values, const double* queries, std::size_t m) {
  return interpolate(values, queries, m, InterpolationOptions{});
}

std::vector<double> Locator::interpolate(const double* values, const double* queries,
                                         const std::vector<std::size_t>& offsets) {
  return interpolate(values, queries, offsets, InterpolationOptions{});
}

void Locator::interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                          const Enqueue& enqueue) {
  interpolate(values, queries, results, InterpolationOptions{}, enqueue);
}

std::vector<double> Locator::interpolate(const double* values, const double* queries, std::size_t m,
                                         const InterpolationOptions& options) {
  return interpolate(values, queries, std::vector<std::size_t>{0, m}, options);
}

std::vector<double> Locator::interpolate(const double* values, const double* queries,
                                         const std::vector<std::size_t>& offsets,
                                         const InterpolationOptions& options) {
  if (!implementation_->on_sphere)
    check_array(values, implementation_->numbers(options.columns), "values", kMostCountable);
  check_enumerator(options.method);
  call::expect(options.device_gradients == nullptr, "gradients in device memory of values in host memory");
  if (implementation_->on_sphere)
    return implementation_->on_sphere->interpolate(values, queries, offsets, options);
  return implementation_->take_turn([&] {
    Implementation& self = implementation_->for_method(options.method);
    if (self.on_torus && Implementation::is_natural(options.method)) self.on_torus->check_gaps(offsets);
    return *self.answer<double>(self.doubles(), queries, offsets, options.columns,
                                self.interpolation(options, values, options.gradients));
  });
}

void Locator::interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                          const InterpolationOptions& options, const Enqueue& enqueue) {
  implementation_->expect_plane("queries in device memory");
  check_enumerator(options.method);
  implementation_->take_turn(enqueue, [&] {
    Implementation& self = implementation_->for_method(options.method);
    const auto work = self.interpolation(options, values, options.device_gradients);
    *self.answer<cl_double>(self.doubles(), queries, {values, options.device_gradients}, results,
                            options.columns, "interpolated values", enqueue, [&](auto&&... all) {
                              call::expect(options.gradients == nullptr,
                                           "gradients in host memory of values in device memory");
                              return work(all...);
                            });
  });
}

NaturalWeights Locator::natural_weights(const double* queries, std::size_t m, Interpolation method) {
  Implementation& self = *implementation_;
  check_queries(queries, m);
  check_enumerator(method);
  const auto weighed = Implementation::natural_weights(method);
  if (self.on_sphere) return self.on_sphere->natural_weights(queries, m, method);
  return self.take_turn([&] {
    self.expect_no_weights();
    call::Answerer& by = self.doubles();
    const std::vector<double> places = self.placed(queries, m);
    if (self.on_torus) self.on_torus->check_gaps({0, m});
    NaturalWeights result;
    call::Frame call(by.place.engine);
    const flaunay::interpolate::NaturalLists lists(
        call.runtime, by.locator, weighed, call.points(call::HostPoints{queries, nullptr, m}), m, {0, m});
    result.offsets = lists.offsets();
    const auto points = call.out<cl_int>(result.points, result.offsets.back());
    lists.write(points, call.out<cl_double>(result.weights, result.offsets.back()));
    call.end();
    return result;
  });
}

std::vector<double> Locator::gradients(const double* values, std::size_t columns,
                                       const GradientOptions& options) {
  Implementation& self = *implementation_;
  if (self.on_sphere) return self.on_sphere->gradients(values, columns, options);
  return self.take_turn([&] {
    call::Answerer& by = self.doubles();
    check_array(values, self.numbers(columns), "values", kMostCountable);
    std::vector<double> results;
    call::Frame call(by.place.engine);
    self.estimate_gradients(call, by.locator, values, columns, options, results);
    call.end();
    return results;
  });
}

void Locator::gradients(cl_mem values, DeviceBuffer& gradients, std::size_t columns,
                        const GradientOptions& options, const Enqueue& enqueue) {
  Implementation& self = *implementation_;
  self.expect_plane("gradients in device memory");
  self.take_turn(enqueue, [&] {
    call::Answerer& by = self.doubles();
    self.on_device(by, enqueue, [&](call::Frame& call) {
      self.estimate_gradients(call, by.locator, values, columns, options, gradients);
      call.end();
    });
  });
}

}  // namespace flaunay
