// The positions at which an array of flags holds a given value, in order.
//
// Three passes over chunks, one work-item a chunk: pack_count counts, the counts are scanned (scan.cl),
// pack_write walks again and writes. The number of positions is the scan's total.

kernel void pack_count(int n, int chunk, global const uchar* restrict flags, int wanted, global uint* restrict counts) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    uint count = 0;
    for (int i = low; i < high; ++i) count += flags[i] == wanted;
    counts[c] = count;
  }
}

kernel void pack_write(int n, int chunk, global const uchar* restrict flags, int wanted,
                       global const uint* restrict prefix, global int* restrict positions) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    uint place = prefix[c];
    for (int i = low; i < high; ++i) {
      if (flags[i] == wanted) positions[place++] = i;
    }
  }
}

// sum[0] += count[0]; one work-item.
kernel void add_count(global const uint* restrict count, global uint* restrict sum) {
  if (get_global_id(0) == 0) sum[0] += count[0];
}
