// Stable segmented split: in each segment, the elements of side 0 first, then those of side 1, either in their
// old order; the others are dropped and the result is dense.
//
// split_flags turns sides into counts for a scan of uint2 (scan.cl); split_places turns the scanned counts into
// each element's new position, or -1.

kernel void split_flags(int n, global const uchar* restrict side, global uint2* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = (uint2)(side[i] == 0, side[i] == 1);
}

kernel void split_places(int n, global const uchar* restrict side, global const int* restrict segment,
                         global const int* restrict offsets, global const uint2* restrict scanned,
                         global int* restrict places) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = segment[i];
    // All kept before the segment, then this side's share of it.
    int place = -1;
    if (side[i] == 0) place = scanned[i].x + scanned[offsets[s]].y;
    if (side[i] == 1) place = scanned[offsets[s + 1]].x + scanned[i].y;
    places[i] = place;
  }
}

// moved[places[i]] = values[i]
kernel void permute_int(int n, global const int* restrict places, global const int* restrict values,
                        global int* restrict moved) {
  const int i = get_global_id(0);
  if (i < n && places[i] >= 0) moved[places[i]] = values[i];
}
