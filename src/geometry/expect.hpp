// Checks of what callers pass.
#pragma once

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Throws Error(usage) with the message `what` unless the condition holds.
template <typename Message>
void expect(bool holds, const Message& what) {
  if (!holds) throw Error(ErrorKind::usage, what);
}

}  // namespace flaunay
