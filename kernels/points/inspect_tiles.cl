// The account of the coordinates as in inspect.cl, for devices with many lanes. One pass: neighbouring work-items read
// neighbouring points, each work-group makes an account in local memory, and adds it to the whole.

#include "arithmetic/bit_account.h"
#include "points/codes.h"

// workers: how many work-items share the points.
kernel void inspect_tiles(int n, int workers, global const double_bits* restrict input,
                          global volatile int* restrict account) {
  local int own[INSPECT_NUMBERS];
  const int is_first = get_local_id(0) == 0;
  if (is_first) {
    own[INSPECT_LARGEST] = NO_LARGEST;
    own[INSPECT_LOWEST] = NO_LOWEST;
    own[INSPECT_BAD] = NO_BAD;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  bit_account bits = no_bits();
  int bad = NO_BAD;
  const int w = get_global_id(0);
  if (w < workers) {
    for (int i = w; i < n; i += workers) account_for_point(i, input, &bits, &bad);
  }
  atomic_max(&own[INSPECT_LARGEST], largest_exponent(bits));
  atomic_min(&own[INSPECT_LOWEST], bits.lowest);
  atomic_min(&own[INSPECT_BAD], bad);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (is_first) {
    atomic_max(&account[INSPECT_LARGEST], own[INSPECT_LARGEST]);
    atomic_min(&account[INSPECT_LOWEST], own[INSPECT_LOWEST]);
    atomic_min(&account[INSPECT_BAD], own[INSPECT_BAD]);
  }
}
