/* The library from C. */
#include <flaunay/flaunay.h>
#include <stdio.h>
#include <string.h>

int main(void) {
#if !FLAUNAY_VERSION_AT_LEAST(0, 1, 0) || \
    FLAUNAY_VERSION_AT_LEAST(FLAUNAY_VERSION_MAJOR, FLAUNAY_VERSION_MINOR + 1, 0)
#error "FLAUNAY_VERSION_AT_LEAST is wrong"
#endif
  if (strcmp(flaunay_version(), FLAUNAY_VERSION) != 0) {
    fprintf(stderr, "consumer: the library is %s, the headers are %s\n", flaunay_version(), FLAUNAY_VERSION);
    return 1;
  }
  printf("flaunay %s\n", flaunay_version());
  return 0;
}
