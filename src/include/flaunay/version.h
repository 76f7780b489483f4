/* The version of these headers, for the preprocessor. The library that a program has loaded says its own:
   flaunay_version() in C, flaunay::version() in C++. */
#ifndef FLAUNAY_VERSION_H
#define FLAUNAY_VERSION_H

#define FLAUNAY_VERSION_MAJOR 0
#define FLAUNAY_VERSION_MINOR 1
#define FLAUNAY_VERSION_PATCH 0
#define FLAUNAY_VERSION "0.1.0"

/* Whether the headers are those of this version or of a later one: #if FLAUNAY_VERSION_AT_LEAST(0, 1, 0) */
#define FLAUNAY_VERSION_AT_LEAST(major, minor, patch) \
  (FLAUNAY_VERSION_MAJOR > (major) ||                 \
   (FLAUNAY_VERSION_MAJOR == (major) &&               \
    (FLAUNAY_VERSION_MINOR > (minor) ||               \
     (FLAUNAY_VERSION_MINOR == (minor) && FLAUNAY_VERSION_PATCH >= (patch)))))

#endif
