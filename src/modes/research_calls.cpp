// The functions of flaunay/research.hpp that triangulate.
#include <fmt/format.h>

#include "call/frame.hpp"
#include "call/implementation.hpp"
#include "call/with_errors.hpp"
#include "flaunay/research.hpp"
#include "geometry/arguments.hpp"
#include "modes/flattened/run.hpp"
#include "modes/table.hpp"

namespace flaunay::research {
namespace {

// The table of modes checks the options of modes.
void check_enumerators(const Options& options) {
  check_enumerator(options.cut);
  check_enumerator(options.hull);
  check_enumerator(options.finish);
  check_enumerator(options.record);
}

void check_options(const Options& options) {
  const ModeInfo& mode = call::row_of(options.mode).info;
  if (options.hull == Hull::monotone_chain && options.mode != Mode::recursive && !mode.on_host) {
    throw Error(ErrorKind::usage, "monotone-chain hulls are computed by mode recursive only");
  }
  if (options.count && !mode.counts) {
    throw Error(ErrorKind::usage,
                fmt::format("mode {} does not count operations; take flattened", mode.name));
  }
  if (options.count && options.record != Record::nothing) {
    throw Error(ErrorKind::usage, "launches are recorded without counting operations: take one of both");
  }
}

// One of wide and narrow is null.
Triangulation checked_call(Triangulator& triangulator, const double* wide, const float* narrow,
                           const std::vector<std::size_t>& offsets, const Options& options) {
  return with_errors([&] {
    const call::HostPoints points = call::checked_points(wide, narrow, offsets);
    const call::ModeRow& row = call::row_of(options.mode);
    check_enumerators(options);
    const call::Request request{points, offsets, options};
    if (row.on_host != nullptr) {
      const std::vector<double> doubles = call::widened(points);
      Triangulation result = row.on_host(narrow != nullptr ? doubles.data() : wide, request);
      if (options.areas) call::write_areas(points, result);
      return result;
    }
    check_options(options);
    call::Implementation& self = TriangulatorAccess::implementation(triangulator);
    const call::Turn turn(self);
    Triangulation result = row.with_engine(self, request);
    if (options.areas && options.mode != Mode::blocks) {
      call::write_areas(self.for_host_memory(), points, result);
    }
    return result;
  });
}

}  // namespace

Triangulation triangulate(Triangulator& triangulator, const double* coordinates, std::size_t n,
                          const Options& options) {
  return triangulate(triangulator, coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation triangulate(Triangulator& triangulator, const float* coordinates, std::size_t n,
                          const Options& options) {
  return triangulate(triangulator, coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation triangulate(Triangulator& triangulator, const double* coordinates,
                          const std::vector<std::size_t>& offsets, const Options& options) {
  return checked_call(triangulator, coordinates, nullptr, offsets, options);
}

Triangulation triangulate(Triangulator& triangulator, const float* coordinates,
                          const std::vector<std::size_t>& offsets, const Options& options) {
  return checked_call(triangulator, nullptr, coordinates, offsets, options);
}

Triangulation triangulate_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                                  const Options& options) {
  const call::ModeRow& row = call::row_of(options.mode);
  if (row.on_host == nullptr) {
    std::string names;
    for (const ModeInfo& mode : list_modes()) {
      if (mode.on_host) names += (names.empty() ? "" : " and ") + std::string(mode.name);
    }
    throw Error(ErrorKind::usage, fmt::format("only the modes {} run without a device", names));
  }
  const call::HostPoints points = call::checked_points(coordinates, nullptr, offsets);
  check_enumerators(options);
  Triangulation result = row.on_host(coordinates, {{}, offsets, options});
  if (options.areas) call::write_areas(points, result);
  return result;
}

Partition partition(Triangulator& triangulator, const double* coordinates, std::size_t n, int levels,
                    const Options& options) {
  return with_errors([&] {
    if (levels < 0) throw Error(ErrorKind::usage, "a partition's number of levels cannot be negative");
    Options uncounted = options;
    uncounted.mode = Mode::flattened;
    uncounted.count = false;
    check_enumerators(options);
    check_options(uncounted);
    call::Implementation& owner = TriangulatorAccess::implementation(triangulator);
    const call::Turn turn(owner);
    call::Engine& asked = owner.for_host_memory();
    call::Engine& self = owner.with_doubles(asked);
    self.check_size(n);
    check_points(coordinates, n);
    Partition result;
    result.statistics.device = self.runtime.name();
    if (n == 0) return result;
    self.begin_call(options.profile);
#ifndef FLAUNAY_WITHOUT_RESEARCH  // else this is not reached
    flattened::partition(self.runtime, {self.persistent, self.even, self.odd}, coordinates, n, levels,
                         uncounted, result);
#endif
    self.write_accounts(result.statistics);
    call::add_note(asked, self, "a partition", "computed", result.statistics);
    return result;
  });
}

}  // namespace flaunay::research
