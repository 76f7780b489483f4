// Points that fixed point cannot represent.
#pragma once

#include <fmt/format.h>

#include "flaunay/flaunay.hpp"

namespace flaunay::points {

/// Thrown by what computes in fixed point if the coordinates of a set span more binary places than that has.
/// An engine with double precision can do the call instead.
class SpanTooWide : public Error {
 public:
  SpanTooWide(int places, int most)
      : Error(ErrorKind::device,
              fmt::format("coordinates that span {} binary places, more than the {} of fixed point", places,
                          most)) {}
};

}  // namespace flaunay::points
