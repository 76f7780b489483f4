// Segmented selection on unsorted keys: for each segment the key of a given rank, found bit by bit from the top.
//
// 64 rounds of a segmented count (segmented.cl): select_flags marks the elements that agree with their segment's
// key so far and have a 0 in the next bit; select_step takes the bit and the remaining rank.

kernel void select_flags(int n, int bit, global const int* restrict segment, global const ulong* restrict keys,
                         global const ulong* restrict found, global long* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    const ulong key = keys[i];
    const ulong above = bit == 63 ? 0 : ~0UL << (bit + 1);
    flags[i] = ((key ^ found[segment[i]]) & above) == 0 && ((key >> bit) & 1) == 0;
  }
}

// The keys of empty segments mean nothing.
kernel void select_step(int segments, int bit, global const long* restrict zeros, global long* restrict rank,
                        global ulong* restrict found) {
  const int s = get_global_id(0);
  if (s < segments) {
    if (rank[s] >= zeros[s]) {
      rank[s] -= zeros[s];
      found[s] |= 1UL << bit;
    }
  }
}
