// The arithmetic that exactness rests on, on known bit patterns: one work-item, one pass. Bit k of failed[0] is set if
// check k fails. operands keep the compiler from folding anything.

#include "shared/exact_arithmetic.h"

kernel void self_test(global const double* restrict operands, global const ulong* restrict expected,
                      global uint* restrict failed) {
  if (get_global_id(0) == 0) {
    uint bits = 0;
    const double a = operands[0];      // 1 + 2^-30
    const double b = operands[1];      // 1 - 2^-30
    const double c = operands[2];      // -1
    const double tiny = operands[3];   // 2^-1060, a subnormal number
    const double third = operands[4];  // 1/3, rounded
    const double large = operands[5];  // 2^60 + 2^8
    // Contraction: fl(a * b) is 1, so the sum is 0; a fused one is -2^-60.
    if (as_ulong(a * b + c) != expected[0]) bits |= 1;
    // fma: one rounding, -2^-60.
    if (as_ulong(fma(a, b, c)) != expected[1]) bits |= 2;
    // Subnormal numbers are kept.
    if (as_ulong(tiny * 0.5) != expected[2]) bits |= 4;
    // Rounding to nearest, ties to even, in sums and products.
    if (as_ulong(large + third) != expected[3]) bits |= 8;
    if (as_ulong(third * third) != expected[4]) bits |= 16;
    // Error-free transformations.
    const double2 sum = two_sum(third, large);
    if (as_ulong(sum.x) != expected[3] || as_ulong(sum.y) != expected[5]) bits |= 32;
    const double2 product = two_product(third, third);
    if (as_ulong(product.x) != expected[4] || as_ulong(product.y) != expected[6]) bits |= 64;
    // Vectors as scalars, and sums in the order written.
    const double2 lanes = VECTOR(double2, a, third) * VECTOR(double2, b, third);
    if (as_ulong(lanes.x) != as_ulong(a * b) || as_ulong(lanes.y) != expected[4]) bits |= 128;
    if (as_ulong((large + third) - large) != expected[7]) bits |= 256;
    failed[0] = bits;
  }
}
