#include "input/inspect.hpp"

namespace flaunay {

Magnitudes inspect(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n) {
  host::Arena::Scope scope(runtime.arena());
  Magnitudes magnitudes;
  const auto accounts = runtime.arena().allocate<cl_int>(3);
  runtime.write(accounts, 0, 3, &magnitudes.largest);
  runtime.chunks("ingest", "inspect", n, runtime.tuning().chunk(n), points, accounts);
  runtime.read(accounts, 0, 3, &magnitudes.largest);
  return magnitudes;
}

Scaling scaling_for(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n,
                    const Magnitudes& magnitudes) {
  std::vector<double> coordinates;
  if (!can_be_exact(magnitudes, n)) {
    coordinates.resize(2 * n);
    // The caller's buffer may not be for the host to read.
    const bool in_host_memory = runtime.device().type() & CL_DEVICE_TYPE_CPU;
    const host::Buffer<cl_double> copy(
        host::allocate_device_memory(runtime.context().get(), in_host_memory, 2 * n * sizeof(double)), 2 * n);
    runtime.copy(points, 0, copy, 0, 2 * n);
    runtime.read(copy, 0, 2 * n, coordinates.data());
  }
  return scaling_for(coordinates.data(), n, magnitudes);
}

}  // namespace flaunay
