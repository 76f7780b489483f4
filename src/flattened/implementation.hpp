// What a Triangulator is made of.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <string>
#include <vector>

#include "flattened/executions.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "hybrid/stages.hpp"

namespace flaunay {

/// Coordinates in host memory, x0 y0 x1 y1..., of either precision.
struct HostPoints {
  const double* wide = nullptr;
  const float* narrow = nullptr;
};

struct Triangulator::Implementation {
  /// Throws Error(device) if there is no such device or if its arithmetic fails the self test.
  explicit Implementation(const std::string& wanted);
  Implementation(const boost::compute::context& context, const boost::compute::device& device);

  std::size_t capacity() const;
  /// Of all arenas.
  std::size_t held_bytes();
  std::size_t allocations();

  struct Call;
  void begin_accounts(bool profile);
  void reset_accounts();
  /// What the device did since.
  void write_accounts(Statistics& statistics);
  /// Throws Error if there are too many points for this device.
  void check_size(std::size_t n) const;
  /// Throws Error for what this device cannot do.
  void check_request(std::size_t n, const Options& options) const;

  Triangulation triangulate(const HostPoints& points, const std::vector<std::size_t>& offsets,
                            const Options& options);
  Partition partition(const double* coordinates, std::size_t n, int levels, const Options& options);
  /// Canonical form, neighbours, and everything to the host.
  void write_result(Call& call, const host::Buffer<cl_int>& triangles, const flattened::Borders& borders,
                    Triangulation& result);
  void hybrid(const HostPoints& points, const std::vector<std::size_t>& offsets, const Options& options,
              Triangulation& result);
  void level_by_level(const double* coordinates, const std::vector<std::size_t>& offsets,
                      const Options& options, Triangulation& result);
  void finish_partition(Call& call, flattened::Recursion& recursion, const flattened::Borders& borders,
                        Triangulation& result);
  /// Points for kernels; from the scratch arena, or in place.
  host::Buffer<cl_double> on_device(const HostPoints& points, std::size_t n);

  /// src/embedding
  void triangulate(const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
                   const Enqueue& enqueue);
  /// For what is not to take memory from the workspace.
  host::Runtime& own_memory();
  /// Sees that the arenas hold what a call needs: in the caller's workspace, if there is one, else of their
  /// own. Throws Error(usage) if the workspace is too small.
  void provide_workspace(std::size_t n, std::size_t sets);

  host::Runtime runtime;
  host::Arena persistent, even, odd;
  std::shared_ptr<_cl_mem> workspace;  ///< the caller's, or null
  std::size_t buffer_allocations = 0;  ///< DeviceBuffers made
  std::size_t allocations_before = 0;
};

}  // namespace flaunay
