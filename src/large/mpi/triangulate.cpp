// The public calls: communicators and devices.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "flaunay/mpi.hpp"
#include "large/mpi/ranks.hpp"
#include "large/mpi/run.hpp"

namespace flaunay::mpi {
namespace {

void require_mpi() {
  int is_initialized = 0, is_finalized = 0;
  MPI_Initialized(&is_initialized);
  MPI_Finalized(&is_finalized);
  if (is_initialized == 0 || is_finalized != 0)
    throw Error(ErrorKind::usage, "MPI is not initialised; call MPI_Init_thread first");
}

// Ranks of a machine take the names in turn.
std::string own_device(const std::string& names, int rank_here) {
  std::vector<std::string> all;
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    all.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return all[static_cast<std::size_t>(rank_here) % all.size()];
}

Triangulation triangulate(Ranks& ranks, Triangulator* given, const double* coordinates, std::size_t n,
                          const Options& options) {
  std::unique_ptr<Triangulator> own;
  Triangulator* triangulator = given;
  Solver solver;
  ranks.together([&] {
    if (triangulator == nullptr) {
      own = std::make_unique<Triangulator>(own_device(options.device, ranks.rank_here()));
      triangulator = own.get();
    }
    const DeviceInfo device = triangulator->device();
    solver.name = device.name;
    solver.capacity = triangulator->capacity();
    solver.shares_memory = device.type != "GPU";
    flaunay::Options with_areas;
    with_areas.areas = options.areas;
    solver.triangulate = [triangulator, with_areas](const double* points, std::size_t count) {
      return triangulator->triangulate(points, count, with_areas);
    };
  });
  return run(ranks, solver, coordinates, n, options);
}

}  // namespace

Triangulation triangulate(MPI_Comm communicator, const double* coordinates, std::size_t n,
                          const Options& options) {
  require_mpi();
  Ranks ranks(communicator);
  return triangulate(ranks, nullptr, coordinates, n, options);
}

Triangulation triangulate(MPI_Comm communicator, Triangulator& triangulator, const double* coordinates,
                          std::size_t n, const Options& options) {
  require_mpi();
  Ranks ranks(communicator);
  return triangulate(ranks, &triangulator, coordinates, n, options);
}

}  // namespace flaunay::mpi
