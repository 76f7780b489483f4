#include "points/inspect.hpp"

#include <algorithm>
#include <utility>

#include "arithmetic/records.h"
#include "launchers/points/inspect.cl.hpp"
#include "launchers/points/inspect_tiles.cl.hpp"
#include "points/codes.h"
#include "points/device_mesh.hpp"
#include "points/download.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {
using namespace geometry;

namespace {

// The coordinates, which set_scalings and scaling_for read if they throw.
std::vector<double> to_host(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n) {
  return download(runtime, points, 2 * n);
}

// Points, each multiplied by 2^shift: the only one, or its set's.
host::Buffer<cl_double> scaled_copy(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                    const std::vector<std::size_t>& offsets, const std::vector<int>& shifts) {
  const auto scaled = runtime.arena().allocate<cl_double>(2 * offsets.back());
  const std::vector<cl_int> first = shifts.size() == 1 ? std::vector<cl_int>{0} : integers(offsets);
  runtime.map(offsets.back(), kernels::scale_sets{.sets = shifts.size(),
                                                  .offsets = runtime.upload(runtime.arena(), first),
                                                  .shifts = runtime.upload(runtime.arena(), shifts),
                                                  .input = points.as<cl_ulong>(),
                                                  .scaled_input = scaled});
  return scaled;
}

UniformPoints scale_sets(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                         const std::vector<std::size_t>& offsets) {
  const std::size_t n = offsets.back();
  const std::vector<Magnitudes> by_set = inspect_sets(runtime, points, offsets);
  std::vector<double> coordinates;
  if (std::any_of(by_set.begin(), by_set.end(), differ_too_much)) coordinates = to_host(runtime, points, n);
  const SetScalings scalings = set_scalings(coordinates.data(), offsets, by_set);
  return {
      scaled_copy(runtime, points, offsets, scalings.shifts), {0, scalings.bounds}, scalings.shifts, by_set};
}

// all: the magnitudes of all sets.
Fitted<UniformPoints> in_fixed_point(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                     const std::vector<std::size_t>& offsets, const Magnitudes& all) {
  UniformPoints uniform;
  int bits = 0;
  const std::size_t sets = offsets.size() - 1;
  const bool is_by_set = sets > 1 && runtime.at_most(!fits_fixed_point(all), true);
  const std::vector<Magnitudes> parts = is_by_set ? inspect_sets(runtime, points, offsets) : std::vector{all};
  for (const Magnitudes& part : parts) {
    if (!fits_fixed_point(part)) return TooWide{part};
    uniform.shifts.push_back(fixed_point_shift(part));
    bits = std::max(bits, bits_of(part));
  }
  if (parts.size() == sets) uniform.by_set = parts;
  uniform.scaling.bounds = fixed_point_bounds(bits);
  uniform.coordinates = scaled_copy(runtime, points, offsets, uniform.shifts);
  return uniform;
}

}  // namespace

Magnitudes inspect(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n) {
  host::Arena::Scope scope(runtime.arena());
  Magnitudes magnitudes;
  const auto account = runtime.arena().allocate<cl_int>(kernel::INSPECT_NUMBERS);
  runtime.write_kept(account, std::vector<cl_int>{magnitudes.largest, magnitudes.lowest, magnitudes.bad});
  const host::Sizes& sizes = runtime.sizes();
  if (sizes.tile_group != 0) {
    const std::size_t workers = std::min(n, sizes.tile_group * sizes.scan_groups);
    runtime.launch(
        workers, sizes.tile_group, n,
        kernels::inspect_tiles{.workers = workers, .input = points.as<cl_ulong>(), .account = account});
  } else {
    runtime.chunks(n, sizes.chunk(n), kernels::inspect{.input = points.as<cl_ulong>(), .account = account});
  }
  runtime.read(account, 0, kernel::INSPECT_NUMBERS, &magnitudes.largest);
  return magnitudes;
}

std::vector<Magnitudes> inspect_sets(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                     const std::vector<std::size_t>& offsets) {
  host::Arena::Scope scope(runtime.arena());
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  std::vector<Magnitudes> magnitudes(sets);
  if (sets == 0) return magnitudes;
  static_assert(sizeof(Magnitudes) == kernel::INSPECT_NUMBERS * sizeof(cl_int));
  const auto accounts = runtime.arena().allocate<cl_int>(kernel::INSPECT_NUMBERS * sets);
  std::vector<cl_int> none;
  for (const Magnitudes& each : magnitudes) none.insert(none.end(), {each.largest, each.lowest, each.bad});
  runtime.write_kept(accounts, std::move(none));
  runtime.chunks(n, runtime.sizes().chunk(n),
                 kernels::inspect_sets{.sets = sets,
                                       .offsets = runtime.upload(runtime.arena(), integers(offsets)),
                                       .input = points.as<cl_ulong>(),
                                       .accounts = accounts});
  runtime.read(accounts, 0, kernel::INSPECT_NUMBERS * sets, &magnitudes.data()->largest);
  return magnitudes;
}

Fitted<UniformPoints> make_uniform(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                   const std::vector<std::size_t>& offsets, const double* host_points) {
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  // The host reads so many in the time of a launch and a wait.
  constexpr std::size_t kFewPoints = 8192;
  const bool is_on_host = host_points != nullptr && n <= kFewPoints;
  const Magnitudes magnitudes =
      is_on_host ? geometry::inspect(host_points, 0, n) : inspect(runtime, points, n);
  const bool differ = differ_too_much(magnitudes);
  const bool is_fixed = runtime.capabilities().fixed_point;
  if (sets > 1 && !is_fixed && runtime.at_most(differ, true)) return scale_sets(runtime, points, offsets);
  if (is_fixed && magnitudes.bad == kernel::NO_BAD && (!differ || sets > 1)) {
    return in_fixed_point(runtime, points, offsets, magnitudes);
  }
  std::vector<double> coordinates;
  if (differ || magnitudes.bad != kernel::NO_BAD) coordinates = to_host(runtime, points, n);
  const Scaling scaling = scaling_for(coordinates.data(), 0, n, magnitudes);
  return UniformPoints{points,
                       scaling,
                       {scaling.shift},
                       sets == 1 ? std::vector<Magnitudes>{magnitudes} : std::vector<Magnitudes>()};
}

host::Buffer<cl_double> scaled(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n,
                               int shift) {
  return shift == 0 ? points : scaled_copy(runtime, points, {0, n}, {shift});
}

void widen(host::Runtime& runtime, const host::Buffer<cl_float>& narrow, std::size_t first, std::size_t n,
           const host::Buffer<cl_double>& wide) {
  runtime.map(n, kernels::widen_points{
                     .first = first, .narrow = narrow.as<cl_uint>(), .points = wide.as<cl_ulong>()});
}

}  // namespace flaunay::points
