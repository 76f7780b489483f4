// Points on a torus or a cylinder, some of which are images of others: only one of a triangle's images gets a
// row.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "arithmetic/language.h"

namespace flaunay::chunks {

/// An edge of a final triangle that has a row. The triangle beyond, if there is one, is final and has no row.
struct Fold {
  std::int64_t from, to;     ///< the ends, counter-clockwise
  kernel::double2 a, b;      ///< where they lie
  std::int64_t own, beyond;  ///< the opposite corners; -1 if there is no triangle beyond
  std::int64_t entry;        ///< of `neighbors`
};

/// Says which triangles get rows, and takes the edges where they end.
class Folding {
 public:
  virtual ~Folding() = default;
  /// Points with numbers from here on are images. Triangles without images get rows.
  virtual std::int64_t first_image() const = 0;
  /// Whether a triangle with images gets a row, whose first corner has the smallest number. Several threads
  /// may call it.
  virtual bool is_kept(const std::array<std::int64_t, 3>& corners) const = 0;
  /// No two calls are made at a time.
  virtual void add(const std::vector<Fold>& folds) = 0;
};

}  // namespace flaunay::chunks
