#include "input/inspect.hpp"

namespace flaunay {

Scaling inspect(host::Runtime& runtime, const host::Buffer<cl_double>& input, std::size_t n) {
  host::Arena::Scope scope(runtime.arena());
  Magnitudes magnitudes;
  const auto accounts = runtime.arena().allocate<cl_int>(3);
  runtime.write(accounts, 0, 3, &magnitudes.largest);
  runtime.chunks("ingest", "inspect", n, runtime.tuning().chunk(n), input, accounts);
  runtime.read(accounts, 0, 3, &magnitudes.largest);
  if (can_be_exact(magnitudes, n)) return scaling_for(nullptr, n, magnitudes);
  std::vector<double> coordinates(2 * n);
  runtime.read(input, 0, 2 * n, coordinates.data());
  return scaling_for(coordinates.data(), n, magnitudes);
}

}  // namespace flaunay
