// A kernel to be launched rightly and wrongly: moved[places[i]] = values[i] + more.

kernel void move_int(int n, int more, global const int* restrict places, global const int* restrict values,
                     global int* restrict moved) {
  const int i = get_global_id(0);
  if (i < n) moved[places[i]] = values[i] + more;
}
