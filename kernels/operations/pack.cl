// The positions at which an array of flags holds a given value, in order.
//
// Three passes over chunks, with one work-item per chunk: pack_count counts, the counts are scanned (scan.cl), and
// pack_write reads the flags again and writes. The number of positions is the scan's total.

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

// counts[i]: 1 where a flag has the wanted value, else 0; for a scan. One pass.
kernel void flag_counts(int n, int wanted, global const uchar* restrict flags, global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = flags[i] == wanted;
}

// sum[0] += count[0]; one work-item.
kernel void add_count(global const uint* restrict count, global uint* restrict sum) {
  if (get_global_id(0) == 0) sum[0] += count[0];
}
