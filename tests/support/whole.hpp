// Integers of 64 bits for GMP, which takes them as long, which has 32 bits on some platforms.
#pragma once

#include <gmpxx.h>

#include <cstdint>

namespace flaunay::testing {

inline mpz_class whole(std::int64_t x) {
  return (mpz_class(static_cast<std::int32_t>(x >> 32)) << 32) + static_cast<std::uint32_t>(x);
}
inline mpz_class whole_unsigned(std::uint64_t x) {
  return (mpz_class(static_cast<std::uint32_t>(x >> 32)) << 32) + static_cast<std::uint32_t>(x);
}

}  // namespace flaunay::testing
