// The arithmetic that exactness rests on in fixed point, on known bit patterns: one work-item, one pass. Bit k of
// failed[0] is set if check k fails. operands keep the compiler from folding anything. Filters rest on errors of one
// unit in the last place, whichever way a device rounds.

#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/numbers.h"
#include "call/turns.h"

// Whether two positive floats differ by at most `units` units in the last place.
static inline int is_near(float x, uint expected, int units) {
  const int apart = as_int(x) - (int)expected;
  return -units <= apart && apart <= units;
}

kernel void self_test_fixed(global const int64* restrict operands, global const float* restrict reals,
                            global const uint64* restrict expected, global const uint* restrict floats,
                            global uint* restrict failed) {
  if (get_global_id(0) == 0) {
    uint bits = 0;
    const int64 a = operands[0];  // 2^62 - 1
    const int64 b = operands[1];  // about -2^63 / 3
    const int64 c = operands[2];  // some positive number
    // Products of 128 bits, signed and unsigned.
    const integer128 ab = product_128(a, b), cc = unsigned_product(as_ulong(c), as_ulong(c));
    if (ab.low != expected[0] || ab.high != expected[1]) bits |= 1;
    if (cc.low != expected[2] || cc.high != expected[3]) bits |= 1;
    // Shifts, and leading zeros.
    if (as_ulong(b >> 7) != expected[4] || as_ulong(b) >> 7 != expected[5]) bits |= 2;
    if (clz(as_ulong(c)) != 3 || clz(as_ulong(operands[3])) != 64 || clz(as_ulong(b)) != 0) bits |= 2;
    // Products and signs of 256 bits.
    const integer256 product = product_256(ab, product_128(c, b));
    if (product.low.low != expected[6] || product.low.high != expected[7]) bits |= 4;
    if (product.high.low != expected[8] || product.high.high != expected[9]) bits |= 4;
    if (sign_of_256(product) != 1 || sign_of_256(difference_256(product, product)) != 0 || sign_of_128(ab) != -1)
      bits |= 4;
    // Differences as floats.
    for (int k = 0; k < 3; ++k) {
      if (!is_near(fabs(real_of(operands[k])), floats[k], 1)) bits |= 8;
    }
    if (real_of(b) > 0 || real_of(operands[3]) != 0) bits |= 8;
    // Sums, differences and products of floats, alone and in vectors.
    const float third = reals[0];  // 1/3, rounded
    const float large = reals[1];  // 2^20 + 2^3
    const real2 both = VECTOR(real2, large, third), thirds = VECTOR(real2, third, third);
    const real2 sums = both + thirds, products = both * thirds;
    if (!is_near(large + third, floats[3], 1) || !is_near(large - third, floats[4], 1)) bits |= 16;
    if (!is_near(third * third, floats[5], 1)) bits |= 16;
    if (!is_near(sums.x, floats[3], 1) || !is_near(products.y, floats[5], 1)) bits |= 16;
    // Quotients, to which OpenCL grants 2.5 units.
    if (!is_near(third / large, floats[6], 3)) bits |= 32;
    // The smallest float that counts is not flushed to zero.
    const float small = reals[2];  // 2^-55
    if (small * small != UNDERFLOW_ERROR || small * small + UNDERFLOW_ERROR != 2 * UNDERFLOW_ERROR) bits |= 64;
    if (loops_end_early((uint)operands[4])) bits |= 128;
    failed[0] = bits;
  }
}
