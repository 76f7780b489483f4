/* Marks the symbols that the shared library exports. For C and C++. */
#ifndef FLAUNAY_EXPORT_H
#define FLAUNAY_EXPORT_H

/* FLAUNAY_STATIC: the library is static; the CMake target and flaunay.pc define it.
   FLAUNAY_BUILDING: the shared library is being built. */
#if defined(FLAUNAY_STATIC)
#define FLAUNAY_API
#define FLAUNAY_LOCAL
#elif defined(_WIN32)
#if defined(FLAUNAY_BUILDING)
#define FLAUNAY_API __declspec(dllexport)
#else
#define FLAUNAY_API __declspec(dllimport)
#endif
#define FLAUNAY_LOCAL
#else
#define FLAUNAY_API __attribute__((visibility("default")))
/* For a class that is not exported inside a class that is. */
#define FLAUNAY_LOCAL __attribute__((visibility("hidden")))
#endif

#endif /* FLAUNAY_EXPORT_H */
