// The error for two segments that cross.
#pragma once

#include <cstdint>
#include <string>

#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {

/// Says which segments these are, so that a caller can name what they are a part of.
class CrossingError : public Error {
 public:
  CrossingError(const std::string& message, std::int32_t first, std::int32_t second)
      : Error(ErrorKind::input, message), crossed(first), segment(second) {}
  std::int32_t crossed;  ///< the one with the smaller index
  std::int32_t segment;  ///< the one that crosses it
};

}  // namespace flaunay::constrained
