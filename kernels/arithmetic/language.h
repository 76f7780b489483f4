// Lets the headers of kernels be read as OpenCL C and as C++, so that kernels and the host decide by the same
// text. A header includes this one and has its own text between BEGIN_SHARED and END_SHARED. For C++ they open and
// close a namespace, which has the types and built-in functions of OpenCL C that the headers use; in OpenCL C they are
// nothing.
//
// Macros cover what the two languages spell differently: GLOBAL for the address space `global`, RESTRICT,
// VECTOR(type, x, y) for a vector, VECTOR3, 4 and 8 likewise, INTEGER_CONSTANT(NAME, value) for a constant of
// type int, OUT_OF_LINE for a function that is called rarely and is long (in OpenCL C nothing, unless a program
// chooses), and ASSERT_SIZE(type, bytes), which does not compile unless the type has that size. OpenCL C has no
// variadic macros, and NVIDIA's compiler refuses them.
#ifndef FLAUNAY_LANGUAGE_H
#define FLAUNAY_LANGUAGE_H

#ifdef __cplusplus

#include <cmath>
#include <cstdint>
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
#define VECTOR(type, x, y) (type{x, y})
#define VECTOR3(type, x, y, z) (type{x, y, z})
#define VECTOR4(type, x, y, z, w) (type{x, y, z, w})
#define VECTOR8(type, a, b, c, d, e, f, g, h) (type{a, b, c, d, e, f, g, h})
#define INTEGER_CONSTANT(NAME, VALUE) constexpr int NAME = VALUE
#define ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "kernels and host see the same bytes")
#define OUT_OF_LINE [[gnu::noinline]]

BEGIN_SHARED

using uchar = unsigned char;
using uint = unsigned int;
// OpenCL's long, which has 32 bits in the C++ of some platforms: kernels write neither it nor literals of it.
using int64 = std::int64_t;
using uint64 = std::uint64_t;
static_assert(sizeof(uint) == 4, "as in OpenCL C");

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
  int64 x, y;
};
struct float2 {
  float x, y;
};

inline double2 vload2(std::size_t i, const double* from) { return {from[2 * i], from[2 * i + 1]}; }
inline long2 vload2(std::size_t i, const int64* from) { return {from[2 * i], from[2 * i + 1]}; }

using std::copysign;
using std::fabs;
using std::fma;
inline int min(int a, int b) { return b < a ? b : a; }
inline int max(int a, int b) { return a < b ? b : a; }
inline int64 min(int64 a, int64 b) { return b < a ? b : a; }
inline int64 max(int64 a, int64 b) { return a < b ? b : a; }
inline uint64 min(uint64 a, uint64 b) { return b < a ? b : a; }
inline uint64 max(uint64 a, uint64 b) { return a < b ? b : a; }
// The number of leading zeros; all bits for 0.
inline int clz(int x) { return x == 0 ? 32 : __builtin_clz(static_cast<uint>(x)); }
inline uint64 clz(uint64 x) { return x == 0 ? 64 : static_cast<uint64>(__builtin_clzll(x)); }

inline uint64 as_ulong(double x) {
  uint64 bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline double as_double(uint64 bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
inline uint64 as_ulong(int64 x) { return static_cast<uint64>(x); }
inline int64 as_long(uint64 x) { return static_cast<int64>(x); }
inline int64 convert_long(double x) { return static_cast<int64>(x); }
inline float convert_float(int64 x) { return static_cast<float>(x); }
inline float convert_float(uint x) { return static_cast<float>(x); }
inline double convert_double(int64 x) { return static_cast<double>(x); }
#ifdef __SIZEOF_INT128__
__extension__ using WideLong = __int128;
__extension__ using WideUlong = unsigned __int128;
#else
// Clang has these for processors of 32 bits, too.
using WideLong = _BitInt(128);
using WideUlong = unsigned _BitInt(128);
#endif
inline int64 high_product(int64 x, int64 y) { return static_cast<int64>(WideLong{x} * y >> 64); }
inline uint64 high_product(uint64 x, uint64 y) { return static_cast<uint64>(WideUlong{x} * y >> 64); }
// Compares pairs by the first number, then by the second.
inline int is_at_least(uint64 a, uint64 b, uint64 x, uint64 y) {
  return (WideUlong{a} << 64 | b) >= (WideUlong{x} << 64 | y);
}

END_SHARED

#else

#ifndef FIXED_POINT
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
#pragma OPENCL FP_CONTRACT OFF

typedef long int64;
typedef ulong uint64;

#define BEGIN_SHARED
#define END_SHARED
#define GLOBAL global
#define RESTRICT restrict
#define VECTOR(type, x, y) ((type)(x, y))
#define VECTOR3(type, x, y, z) ((type)(x, y, z))
#define VECTOR4(type, x, y, z, w) ((type)(x, y, z, w))
#define VECTOR8(type, a, b, c, d, e, f, g, h) ((type)(a, b, c, d, e, f, g, h))
#define INTEGER_CONSTANT(NAME, VALUE) enum { NAME = VALUE }
#define ASSERT_SIZE(type, bytes) typedef char type##_has_its_size[sizeof(type) == (bytes) ? 1 : -1]
#ifndef OUT_OF_LINE
#define OUT_OF_LINE
#endif

// The upper half of a product. Compilers for CPUs have a type for it, which is several times as fast as their mul_hi.
#if defined(__SIZEOF_INT128__) && (defined(__x86_64__) || defined(__aarch64__))
static inline int64 __attribute__((overloadable)) high_product(int64 x, int64 y) {
  return (int64)((__int128)x * y >> 64);
}
static inline uint64 __attribute__((overloadable)) high_product(uint64 x, uint64 y) {
  return (uint64)((unsigned __int128)x * y >> 64);
}
#else
#define high_product mul_hi
#endif

static inline int is_at_least(uint64 a, uint64 b, uint64 x, uint64 y) { return (a > x) | ((a == x) & (b >= y)); }

#endif

#endif
