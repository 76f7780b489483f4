#include "points/inspect.hpp"

#include "launchers/points/inspect.cl.hpp"
#include "shared/codes.h"

namespace flaunay::points {

namespace {

// The initial values of inspect. Static, because the device reads them after the call has returned.
const Magnitudes kNothingInspected;

}  // namespace

host::Buffer<cl_int> inspect_later(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                   std::size_t n) {
  const auto accounts = runtime.arena().allocate<cl_int>(kernel::INSPECT_NUMBERS);
  runtime.write_later(accounts, 0, kernel::INSPECT_NUMBERS, &kNothingInspected.largest);
  runtime.chunks(n, runtime.sizes().chunk(n), kernels::inspect{.input = points, .accounts = accounts});
  return accounts;
}

Magnitudes inspect(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n) {
  host::Arena::Scope scope(runtime.arena());
  Magnitudes magnitudes;
  const auto accounts = runtime.arena().allocate<cl_int>(kernel::INSPECT_NUMBERS);
  runtime.write(accounts, 0, kernel::INSPECT_NUMBERS, &magnitudes.largest);
  runtime.chunks(n, runtime.sizes().chunk(n), kernels::inspect{.input = points, .accounts = accounts});
  runtime.read(accounts, 0, kernel::INSPECT_NUMBERS, &magnitudes.largest);
  return magnitudes;
}

Scaling scaling_for(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n,
                    const Magnitudes& magnitudes) {
  std::vector<double> coordinates;
  if (!can_be_exact(magnitudes, n)) {
    coordinates.resize(2 * n);
    // Copied first, because the caller's buffer may not permit the host to read it.
    const host::Buffer<cl_double> copy(host::allocate_memory(runtime.memory(), 2 * n * sizeof(double)),
                                       2 * n);
    runtime.copy(points, 0, copy, 0, 2 * n);
    runtime.read(copy, 0, 2 * n, coordinates.data());
  }
  return scaling_for(coordinates.data(), n, magnitudes);
}

void widen(host::Runtime& runtime, const host::Buffer<cl_float>& narrow, std::size_t first, std::size_t n,
           const host::Buffer<cl_double>& wide) {
  runtime.map(n, kernels::widen_points{.first = first, .narrow = narrow, .points = wide});
}

}  // namespace flaunay::points
