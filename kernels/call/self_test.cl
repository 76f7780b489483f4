// The arithmetic that exactness rests on, on known bit patterns: one work-item, one pass. Bit k of failed[0] is set if
// check k fails. operands keep the compiler from folding anything.

#include "arithmetic/exact_arithmetic.h"
#include "call/turns.h"

// Forms that a compiler may contract: in vectors, and where a product and a sum meet only after inlining.
static inline double2 products_in_vectors(double2 a, double2 b) { return a * b; }
static inline double2 sums_in_vectors(double2 a, double2 b) { return a + b; }
static inline double product_of(double a, double b) { return a * b; }
static inline double sum_of(double a, double b) { return a + b; }
static inline double difference_of(double a, double b) { return a - b; }

kernel void self_test(global const double* restrict operands, global const uint64* restrict expected,
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
#ifndef SPLIT_PRODUCTS
    if (as_ulong(fma(a, b, c)) != expected[1]) bits |= 2;
#endif
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
    // An fma that first rounds to a longer format is right for the factors above, and wrong for these.
    if (as_ulong(two_product(operands[6], operands[7]).y) != expected[9]) bits |= 64;
    // Vectors as scalars, and sums in the order written.
    const double2 lanes = VECTOR(double2, a, third) * VECTOR(double2, b, third);
    if (as_ulong(lanes.x) != as_ulong(a * b) || as_ulong(lanes.y) != expected[4]) bits |= 128;
    if (as_ulong((large + third) - large) != expected[7]) bits |= 256;
    // Contraction of vectors: of sums and of differences of products.
    const double2 ab = VECTOR(double2, a, b), ba = VECTOR(double2, b, a), cc = VECTOR(double2, c, c);
    const double2 sums = ab * ba + cc;
    const double2 called = sums_in_vectors(products_in_vectors(ab, ba), cc);
    const double2 differences = ab * ba - products_in_vectors(ba, ab);
    if ((as_ulong(sums.x) | as_ulong(sums.y)) != expected[0]) bits |= 512;
    if ((as_ulong(called.x) | as_ulong(called.y)) != expected[0]) bits |= 512;
    if ((as_ulong(differences.x) | as_ulong(differences.y)) != expected[0]) bits |= 512;
    // Contraction after inlining: of sums, and of differences of products, whose rounding errors must cancel.
    if (as_ulong(sum_of(product_of(a, b), c)) != expected[0]) bits |= 1024;
    if (as_ulong(difference_of(product_of(a, b), product_of(b, a))) != expected[0]) bits |= 1024;
    if (as_ulong(difference_of(-c, product_of(b, a))) != expected[0]) bits |= 1024;
    if (loops_end_early((uint)expected[8])) bits |= 2048;
    failed[0] = bits;
  }
}
