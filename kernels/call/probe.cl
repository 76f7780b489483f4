// Measures how long a device takes for the smallest tasks of kernels, for predictions of times (flaunay-bench
// device): to begin a launch, to wait for a load that needs the one before, and to compute with a result that
// was just computed. One pass each.

#include "arithmetic/language.h"

kernel void do_nothing(int n, global int* restrict ends) {
  const int i = get_global_id(0);
  if (i < n) ends[i] = i;
}

// Follows the places of a chain, from one to the next.
kernel void follow_chain(int n, int steps, global const int* restrict next, global int* restrict ends) {
  const int i = get_global_id(0);
  if (i < n) {
    int place = i;
    for (int k = 0; k < steps; ++k) place = next[place];
    ends[i] = place;
  }
}

// A multiplication and an addition in each step. They are rounded one by one, as all of flaunay's.
kernel void compute_chain(int n, int steps, double factor, global double* restrict results) {
  const int i = get_global_id(0);
  if (i < n) {
    double x = i;
    for (int k = 0; k < steps; ++k) x = x * factor + 1.0;
    results[i] = x;
  }
}
