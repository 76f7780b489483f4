// Lets the headers of kernels be read as OpenCL C and as C++, so that kernels and the host decide by the same
// text. A header includes this one and has its own text between BEGIN_SHARED and END_SHARED. For C++ they open and
// close a namespace, which has the types and built-in functions of OpenCL C that the headers use; in OpenCL C they are
// nothing.
//
// What the two languages spell differently is spelled by a macro here: GLOBAL for the address space `global`, RESTRICT,
// VECTOR(type, components...) for a vector, INTEGER_CONSTANT(NAME, value) for a constant of type int, OUT_OF_LINE for a
// function that is called rarely and is long (in OpenCL C nothing, unless a program chooses), and ASSERT_SIZE(type,
// bytes), which does not compile unless the type has that size.
#ifndef FLAUNAY_LANGUAGE_H
#define FLAUNAY_LANGUAGE_H

#ifdef __cplusplus

#include <cmath>
#include <cstring>
#include <limits>

// A program that reads a header a second time, with types of its own, may choose another namespace before.
#ifndef SHARED_NAMESPACE
#define SHARED_NAMESPACE flaunay::kernel
#endif
#define BEGIN_SHARED namespace SHARED_NAMESPACE {
#define END_SHARED }
#define GLOBAL
#define RESTRICT __restrict
#define VECTOR(type, ...) (type{__VA_ARGS__})
#define INTEGER_CONSTANT(NAME, VALUE) constexpr int NAME = VALUE
#define ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "kernels and host see the same bytes")
#define OUT_OF_LINE [[gnu::noinline]]

BEGIN_SHARED

using uchar = unsigned char;
using uint = unsigned int;
using ulong = unsigned long;
static_assert(sizeof(uint) == 4 && sizeof(long) == 8 && sizeof(ulong) == 8, "as in OpenCL C");

struct uchar2 {
  uchar x, y;
};
struct int2 {
  int x, y;
};
struct int3 {
  int x, y, z;
};
struct int4 {
  int x, y, z, w;
};
struct uint2 {
  uint x, y;
};
struct double2 {
  double x, y;
};
inline double2 operator-(double2 a, double2 b) { return {a.x - b.x, a.y - b.y}; }
inline double2 operator-(double2 a) { return {-a.x, -a.y}; }

struct long2 {
  long x, y;
};
struct float2 {
  float x, y;
};

inline double2 vload2(std::size_t i, const double* from) { return {from[2 * i], from[2 * i + 1]}; }
inline long2 vload2(std::size_t i, const long* from) { return {from[2 * i], from[2 * i + 1]}; }

using std::fabs;
using std::fma;
inline int min(int a, int b) { return b < a ? b : a; }
inline int max(int a, int b) { return a < b ? b : a; }
inline long min(long a, long b) { return b < a ? b : a; }
inline long max(long a, long b) { return a < b ? b : a; }
inline ulong min(ulong a, ulong b) { return b < a ? b : a; }
inline ulong max(ulong a, ulong b) { return a < b ? b : a; }
// Of 0 the number of bits.
inline int clz(int x) { return x == 0 ? 32 : __builtin_clz(static_cast<uint>(x)); }
inline ulong clz(ulong x) { return x == 0 ? 64 : static_cast<ulong>(__builtin_clzl(x)); }

inline ulong as_ulong(double x) {
  ulong bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline double as_double(ulong bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
inline ulong as_ulong(long x) { return static_cast<ulong>(x); }
inline long as_long(ulong x) { return static_cast<long>(x); }
inline long convert_long(double x) { return static_cast<long>(x); }
inline float convert_float(long x) { return static_cast<float>(x); }
inline float convert_float(uint x) { return static_cast<float>(x); }
inline double convert_double(long x) { return static_cast<double>(x); }
__extension__ using WideLong = __int128;
__extension__ using WideUlong = unsigned __int128;
inline long high_product(long x, long y) { return static_cast<long>(WideLong{x} * y >> 64); }
inline ulong high_product(ulong x, ulong y) { return static_cast<ulong>(WideUlong{x} * y >> 64); }
// Compares pairs by the first number, then by the second.
inline int is_at_least(ulong a, ulong b, ulong x, ulong y) {
  return (WideUlong{a} << 64 | b) >= (WideUlong{x} << 64 | y);
}

END_SHARED

#else

#ifndef FIXED_POINT
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
#pragma OPENCL FP_CONTRACT OFF

#define BEGIN_SHARED
#define END_SHARED
#define GLOBAL global
#define RESTRICT restrict
#define VECTOR(type, ...) ((type)(__VA_ARGS__))
#define INTEGER_CONSTANT(NAME, VALUE) enum { NAME = VALUE }
#define ASSERT_SIZE(type, bytes) typedef char type##_has_its_size[sizeof(type) == (bytes) ? 1 : -1]
#ifndef OUT_OF_LINE
#define OUT_OF_LINE
#endif

// The upper half of a product. Compilers for CPUs have a type for it, which is several times as fast as their mul_hi.
#if defined(__SIZEOF_INT128__) && (defined(__x86_64__) || defined(__aarch64__))
static inline long __attribute__((overloadable)) high_product(long x, long y) { return (long)((__int128)x * y >> 64); }
static inline ulong __attribute__((overloadable)) high_product(ulong x, ulong y) {
  return (ulong)((unsigned __int128)x * y >> 64);
}
#else
#define high_product mul_hi
#endif

static inline int is_at_least(ulong a, ulong b, ulong x, ulong y) { return (a > x) | ((a == x) & (b >= y)); }

#endif

#endif
