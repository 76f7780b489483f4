/* The library from C. */
#include <flaunay/flaunay.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  if (strncmp(flaunay_version(), "0.", 2) != 0) {
    fprintf(stderr, "consumer: version %s\n", flaunay_version());
    return 1;
  }
  printf("flaunay %s\n", flaunay_version());
  return 0;
}
