// The public class Locator.
#include "derived/locate/locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "call/device_mesh.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "call/on_host.hpp"
#include "derived/interpolate/interpolate.hpp"
#include "derived/interpolate/natural.hpp"
#include "derived/locate/read_back.hpp"
#include "geometry/magnitudes.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace call {

/// An engine of a triangulator, and the locator that it made.
struct Answerer {
  Answerer(call::Engine& used_engine, call::Engine* used_device)
      : engine(used_engine), device(used_device), own(engine.runtime.memory()) {
    if (engine.runtime.sizes().separate_buffers) own.separate_buffers();
  }

  /// Whether the host computes, and the caller's arrays are in device memory.
  bool is_on_host() const { return device != &engine; }

  /// Makes the locator of a triangulation in host memory.
  void make_from(const double* coordinates, const std::vector<std::size_t>& offsets,
                 const Triangulation& triangulation) {
    engine.check_size(offsets.empty() ? 0 : offsets.back());
    const call::OwnCall own_call(engine);
    const host::Runtime::Settled settled(own_call.runtime);
    const points::DeviceMesh mesh = call::mesh_of(own_call.runtime, coordinates, offsets, triangulation);
    locator = locate::make_locator(own_call.runtime, own, mesh);
    own_call.runtime.finish();
  }

  /// Computes so many results in host memory. work(runtime, results) enqueues the kernels that write them.
  template <typename Result, typename Work>
  std::vector<Result> compute(std::size_t count, const Work& work) {
    const call::OwnCall own_call(engine);
    host::Runtime& runtime = own_call.runtime;
    std::vector<Result> result;
    runtime.resize(result, count);
    const host::Runtime::Settled settled(runtime);
    const Buffer<Result> output = runtime.output(result);
    work(runtime, output);
    runtime.fetch_later(output, result);
    runtime.finish();
    return result;
  }

  /// The caller's numbers in device memory, where the engine has them. To be called in a call of its runtime.
  Buffer<cl_double> given(cl_mem memory, std::size_t count, const char* what) {
    const auto there = call::given_buffer<cl_double>(device->runtime, memory, count, what);
    if (!is_on_host()) return there;
    return engine.runtime.upload(engine.runtime.arena(), points::download(device->runtime, there, count));
  }

  call::Engine& engine;
  call::Engine*
      device;  ///< has the caller's device memory: the engine, or if that is native, another or none
  Arena own;
  locate::Locator locator;
};

}  // namespace call

struct Locator::Implementation {
  Implementation(std::shared_ptr<Triangulator::Implementation> used, call::Engine& asked)
      : owner(std::move(used)), asked_(asked) {}

  /// Makes the locator, in fixed point if that is what the engine computes in and the points fit.
  /// make(answerer).
  template <typename Make>
  void make_with(const Make& make) {
    if (!asked_.has_doubles()) {
      fixed = std::make_unique<call::Answerer>(asked_, &asked_);
      try {
        return make(*fixed);
      } catch (const geometry::TooWideForFixedPoint&) {
        fixed.reset();
      }
    }
    doubles_ = new_with_doubles();
    make(*doubles_);
  }

  /// The locator with doubles; made of the other one when it is first needed.
  call::Answerer& doubles() {
    if (!doubles_) {
      call::take_turn(*owner, [&] {
        auto made = new_with_doubles();
        const call::OwnCall own_call(asked_);
        const locate::ReadMesh mesh = locate::read_back(own_call.runtime, fixed->locator);
        made->make_from(mesh.coordinates.data(), mesh.point_offsets, mesh.triangulation);
        doubles_ = std::move(made);
      });
    }
    return *doubles_;
  }

  /// Answers by the locator in fixed point, if there is one, or else, and if what is asked does not fit that,
  /// by the one with doubles.
  template <typename Answer>
  auto by_either(const Answer& answer) {
    if (fixed) {
      try {
        return answer(*fixed);
      } catch (const geometry::TooWideForFixedPoint&) {
        // Answered below.
      }
    }
    return answer(doubles());
  }

  // Kernels use 32-bit indices for the coordinates of queries, and for columns.
  static void check_queries(std::size_t m, std::size_t columns) {
    call::expect(m <= std::numeric_limits<std::int32_t>::max() / 2,
                 "more queries than 32-bit indices can count");
    check_numbers(m, columns);
  }

  static void check_numbers(std::size_t rows, std::size_t columns) {
    constexpr std::size_t kMostColumns = std::numeric_limits<std::int32_t>::max();
    call::expect(columns <= std::min(kMostColumns, call::kMostCountable / std::max<std::size_t>(rows, 1)),
                 "more numbers than memory can hold");
  }

  /// Answers queries in host memory. columns: the length of each result. work(runtime, locator, queries, m,
  /// offsets, results) enqueues the kernels that write the results.
  template <typename Result, typename Work>
  std::vector<Result> answer(call::Answerer& by, const double* queries,
                             const std::vector<std::size_t>& offsets, std::size_t columns, const Work& work) {
    return call::take_turn(*owner, [&] {
      geometry::check_offsets(offsets);
      const std::size_t m = offsets.back();
      check_queries(m, columns);
      call::expect(m == 0 || queries != nullptr, "queries, but no coordinates: the pointer is null");
      return by.compute<Result>(m * columns, [&](host::Runtime& runtime, const Buffer<Result>& results) {
        work(runtime, by.locator, runtime.view(queries, 2 * m), m, offsets, results);
      });
    });
  }

  /// Runs a call on device memory. work(runtime) enqueues it.
  template <typename Work>
  void on_device(call::Answerer& by, const Enqueue& enqueue, const Work& work) {
    call::take_turn(*owner, enqueue, [&] {
      call::Engine* const device = by.device;
      call::expect(
          device != nullptr,
          "the locator was made in host memory without OpenCL, so it has no queries in device memory; "
          "make it from device memory, or name a device");
      call::Engine& first = owner->on_device();
      const Enqueue own_enqueue = device == &first ? enqueue : call::on_queue_of(first, enqueue);
      device->use_own_memory();
      call::check_enqueue(device->runtime, own_enqueue);
      call::QueuedCall queued(device->runtime, own_enqueue);
      Arena::Scope scope(device->runtime.arena());
      work(device->runtime);
      queued.end();
    });
  }

  /// Answers queries in device memory. columns and work: as above. read: further buffers that are read, or
  /// null.
  template <typename Result, typename Work>
  void answer(call::Answerer& by, const DevicePoints& queries, const std::vector<cl_mem>& read,
              DeviceBuffer& result, std::size_t columns, const char* what, const Enqueue& enqueue,
              const Work& work) {
    on_device(by, enqueue, [&](host::Runtime& runtime) {
      call::check_points(runtime, queries, "queries");
      check_queries(queries.count, columns);
      const std::vector<std::size_t> offsets = call::checked_offsets(runtime, queries);
      const auto output = call::result_buffer<Result>(runtime, result, queries.count * columns, what,
                                                      by.device->buffer_allocations);
      std::vector<cl_mem> buffers{queries.memory, queries.device_offsets, result.memory()};
      buffers.insert(buffers.end(), read.begin(), read.end());
      call::check_distinct(buffers);
      if (!by.is_on_host()) {
        work(runtime, by.locator, call::wide_points(runtime, runtime.arena(), queries), queries.count,
             offsets, output);
        return;
      }
      const std::vector<double> points = call::read_wide_points(runtime, queries);
      call::write_result(runtime, output,
                         by.compute<Result>(queries.count * columns, [&](host::Runtime& native,
                                                                         const Buffer<Result>& results) {
                           work(native, by.locator, native.view(points.data(), points.size()), queries.count,
                                offsets, results);
                         }));
    });
  }

  /// The length of the array of values.
  std::size_t numbers(std::size_t columns) const {
    call::expect(columns > 0, "values have no columns: a point needs at least one number");
    check_numbers(point_count, columns);
    return point_count * columns;
  }

  static flaunay::interpolate::NaturalWeights natural_weights(Interpolation method) {
    call::expect(method == Interpolation::sibson || method == Interpolation::laplace,
                 "natural neighbours have the weights of Sibson or of Laplace");
    return method == Interpolation::sibson ? flaunay::interpolate::NaturalWeights::sibson
                                           : flaunay::interpolate::NaturalWeights::laplace;
  }

  /// Estimated, unless there are some. given: the caller's, in host or device memory.
  static flaunay::interpolate::Gradients gradients_by(const GradientOptions& options, bool are_given,
                                                      Buffer<cl_double> given) {
    call::expect(!std::isnan(options.tolerance), "the tolerance of gradients is not a number");
    return {are_given, std::move(given), options.tolerance, options.iterations};
  }

  /// queries: as the functions in derived/interpolate/interpolate.hpp take them.
  template <typename... Queries>
  void interpolate(host::Runtime& runtime, locate::Locator& locator, const InterpolationOptions& options,
                   const Buffer<cl_double>& values, const flaunay::interpolate::Gradients& gradients,
                   const Queries&... queries) {
    const flaunay::interpolate::Table table{values, options.columns, options.fill};
    switch (options.method) {
      case Interpolation::linear:
        return flaunay::interpolate::linear(runtime, locator, table, queries...);
      case Interpolation::nearest:
        return flaunay::interpolate::nearest(runtime, locator, table, queries...);
      case Interpolation::clough_tocher:
        return flaunay::interpolate::clough_tocher(runtime, locator, table, gradients, queries...);
      case Interpolation::sibson:
      case Interpolation::laplace:
        return flaunay::interpolate::natural(runtime, locator, natural_weights(options.method), table,
                                             queries...);
    }
    throw Error(ErrorKind::usage, "no such method of interpolation");
  }

  void estimate_gradients(host::Runtime& runtime, const locate::Locator& locator,
                          const Buffer<cl_double>& values, std::size_t columns,
                          const GradientOptions& options, const Buffer<cl_double>& results) {
    const flaunay::interpolate::Table table{values, columns, std::numeric_limits<double>::quiet_NaN()};
    flaunay::interpolate::estimate_gradients(runtime, locator, table, gradients_by(options, false, {}),
                                             results);
  }

  std::shared_ptr<Triangulator::Implementation> owner;
  std::unique_ptr<call::Answerer> fixed;  ///< null if the engine has doubles, and for points that do not fit
  std::size_t point_count = 0;

 private:
  std::unique_ptr<call::Answerer> new_with_doubles() const {
    call::Engine& engine = owner->with_doubles(asked_);
    call::Engine* const device = !engine.runtime.is_native()   ? &engine
                                 : !asked_.runtime.is_native() ? &asked_
                                                               : nullptr;
    return std::make_unique<call::Answerer>(engine, device);
  }

  call::Engine& asked_;  ///< one of the owner's
  std::unique_ptr<call::Answerer> doubles_;
};

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
  call::take_turn(*self.owner, [&] {
    self.make_with([&](call::Answerer& by) { by.make_from(coordinates, offsets, triangulation); });
    self.point_count = offsets.back();
  });
}

Locator::Locator(Triangulator& triangulator, const DevicePoints& points,
                 const DeviceTriangulation& triangulation, const Enqueue& enqueue)
    : implementation_(make(triangulator, true)) {
  Implementation& self = *implementation_;
  self.make_with([&](call::Answerer& by) {
    self.on_device(by, enqueue, [&](host::Runtime& runtime) {
      call::check_points(runtime, points, "points");
      points::DeviceMesh mesh = call::mesh_without_points(runtime, points, triangulation);
      if (by.is_on_host()) {
        const call::MeshOnHost read = call::read_mesh(runtime, points, mesh);
        by.make_from(read.coordinates.data(), mesh.point_offsets, read.triangulation);
      } else {
        mesh.coordinates = call::wide_points(runtime, runtime.arena(), points);
        by.locator = locate::make_locator(runtime, by.own, mesh);
      }
    });
  });
  self.point_count = points.count;
}

Locator::~Locator() = default;
Locator::Locator(Locator&&) noexcept = default;
Locator& Locator::operator=(Locator&&) noexcept = default;

std::vector<std::int32_t> Locator::locate(const double* queries, std::size_t m) {
  return locate(queries, std::vector<std::size_t>{0, m});
}

std::vector<std::int32_t> Locator::locate(const double* queries, const std::vector<std::size_t>& offsets) {
  return implementation_->by_either([&](call::Answerer& by) {
    return implementation_->answer<std::int32_t>(by, queries, offsets, 1,
                                                 [](auto&&... all) { locate::locate(all...); });
  });
}

void Locator::locate(const DevicePoints& queries, DeviceBuffer& triangles, const Enqueue& enqueue) {
  implementation_->by_either([&](call::Answerer& by) {
    implementation_->answer<cl_int>(by, queries, {}, triangles, 1, "located triangles", enqueue,
                                    [](auto&&... all) { locate::locate(all...); });
  });
}

std::vector<std::int32_t> Locator::nearest(const double* queries, std::size_t m) {
  return nearest(queries, std::vector<std::size_t>{0, m});
}

std::vector<std::int32_t> Locator::nearest(const double* queries, const std::vector<std::size_t>& offsets) {
  return implementation_->by_either([&](call::Answerer& by) {
    return implementation_->answer<std::int32_t>(by, queries, offsets, 1,
                                                 [](auto&&... all) { locate::nearest(all...); });
  });
}

void Locator::nearest(const DevicePoints& queries, DeviceBuffer& points, const Enqueue& enqueue) {
  implementation_->by_either([&](call::Answerer& by) {
    implementation_->answer<cl_int>(by, queries, {}, points, 1, "nearest points", enqueue,
                                    [](auto&&... all) { locate::nearest(all...); });
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
  const std::size_t numbers = implementation_->numbers(options.columns);
  if (numbers > 0) call::expect(values != nullptr, "points have no values: the pointer is null");
  call::expect(options.device_gradients == nullptr, "gradients in device memory of values in host memory");
  return implementation_->answer<double>(
      implementation_->doubles(), queries, offsets, options.columns,
      [&](auto& runtime, auto& locator, const auto&... all) {
        const bool are_given = options.gradients != nullptr;
        const auto gradients = Implementation::gradients_by(
            options.estimation, are_given, runtime.view(options.gradients, are_given ? 2 * numbers : 0));
        implementation_->interpolate(runtime, locator, options, runtime.view(values, numbers), gradients,
                                     all...);
      });
}

void Locator::interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                          const InterpolationOptions& options, const Enqueue& enqueue) {
  call::Answerer& by = implementation_->doubles();
  implementation_->answer<cl_double>(
      by, queries, {values, options.device_gradients}, results, options.columns, "interpolated values",
      enqueue, [&](auto& runtime, auto& locator, const auto&... all) {
        call::expect(options.gradients == nullptr, "gradients in host memory of values in device memory");
        const std::size_t numbers = implementation_->numbers(options.columns);
        const bool are_given = options.device_gradients != nullptr;
        const auto gradients = Implementation::gradients_by(
            options.estimation, are_given,
            by.given(options.device_gradients, are_given ? 2 * numbers : 0, "gradients"));
        implementation_->interpolate(runtime, locator, options, by.given(values, numbers, "values"),
                                     gradients, all...);
      });
}

std::vector<double> Locator::gradients(const double* values, std::size_t columns,
                                       const GradientOptions& options) {
  call::Answerer& by = implementation_->doubles();
  return call::take_turn(*implementation_->owner, [&] {
    const std::size_t numbers = implementation_->numbers(columns);
    if (numbers > 0) call::expect(values != nullptr, "points have no values: the pointer is null");
    return by.compute<double>(2 * numbers, [&](host::Runtime& runtime, const Buffer<double>& results) {
      implementation_->estimate_gradients(runtime, by.locator, runtime.view(values, numbers), columns,
                                          options, results);
    });
  });
}

void Locator::gradients(cl_mem values, DeviceBuffer& gradients, std::size_t columns,
                        const GradientOptions& options, const Enqueue& enqueue) {
  Implementation& self = *implementation_;
  call::Answerer& by = self.doubles();
  self.on_device(by, enqueue, [&](host::Runtime& runtime) {
    const std::size_t numbers = self.numbers(columns);
    const auto output = call::result_buffer<cl_double>(runtime, gradients, 2 * numbers, "gradients",
                                                       by.device->buffer_allocations);
    call::check_distinct({values, gradients.memory()});
    const auto estimate = [&](host::Runtime& used, const Buffer<cl_double>& results) {
      self.estimate_gradients(used, by.locator, by.given(values, numbers, "values"), columns, options,
                              results);
    };
    if (by.is_on_host()) {
      call::write_result(runtime, output, by.compute<cl_double>(2 * numbers, estimate));
    } else {
      estimate(runtime, output);
    }
  });
}

}  // namespace flaunay
