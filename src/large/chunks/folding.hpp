// Points on a torus or a cylinder, some of which are images of others: only one of a triangle's images gets a
// row.
#pragma once

#include <cstdint>
#include <vector>

#include "periodic/records.h"

namespace flaunay::chunks {

/// Says which points are images, and takes the edges where triangles end that get rows: the triangle beyond,
/// if there is one, is final and gets none.
class Folding {
 public:
  virtual ~Folding() = default;
  /// Points with numbers from here on are images. Triangles without images get rows.
  virtual std::int64_t first_image() const = 0;
  /// The image that a number stands for, as kernels/periodic/torus.h has it. Several threads may call it.
  virtual std::uint64_t image(std::int64_t v) const = 0;
  /// No two calls are made at a time.
  virtual void add(const std::vector<kernel::seam_record>& seams) = 0;
};

}  // namespace flaunay::chunks
