// The part of OpenCL C that kernel files use beyond the text that kernels and host share
// (kernels/arithmetic/language.h), for kernel files that are compiled as C++.
#pragma once

#include <climits>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include "host/native/function.hpp"
// Kernels do not count operations, see operations/counters.h.
#define FLAUNAY_NATIVE_KERNELS
#include "arithmetic/language.h"

namespace flaunay::kernel {

struct uint8 {
  uint s0, s1, s2, s3, s4, s5, s6, s7;
};

inline double2 operator+(double2 a, double2 b) { return {a.x + b.x, a.y + b.y}; }
inline double2 operator*(double2 a, double2 b) { return {a.x * b.x, a.y * b.y}; }
inline double2 operator*(double a, double2 b) { return {a * b.x, a * b.y}; }
inline double2 operator*(double2 a, double b) { return {a.x * b, a.y * b}; }
inline double2 operator/(double2 a, double b) { return {a.x / b, a.y / b}; }
inline uint2& operator+=(uint2& a, uint2 b) {
  a.x += b.x;
  a.y += b.y;
  return a;
}
inline uint2& operator+=(uint2& a, uint b) { return a += uint2{b, b}; }
inline uint2 operator-(uint2 a, uint2 b) { return {a.x - b.x, a.y - b.y}; }
inline uint8& operator+=(uint8& a, uint8 b) {
  a = {a.s0 + b.s0, a.s1 + b.s1, a.s2 + b.s2, a.s3 + b.s3,
       a.s4 + b.s4, a.s5 + b.s5, a.s6 + b.s6, a.s7 + b.s7};
  return a;
}

inline void vstore2(double2 value, std::size_t i, double* to) {
  to[2 * i] = value.x;
  to[2 * i + 1] = value.y;
}
inline double min(double a, double b) { return b < a ? b : a; }
inline double max(double a, double b) { return a < b ? b : a; }
using std::ilogb;
using std::sqrt;
inline bool isfinite(double x) { return std::isfinite(x); }

// Whether this thread runs all work-items of the launch: then nobody else changes memory meanwhile.
inline thread_local bool is_alone [[gnu::tls_model("initial-exec")]] = false;

// Atomic operations; as in OpenCL C 1.2, they order nothing else. A thread that is alone uses plain
// operations, which take a fraction of the time.
template <typename T, typename Change, typename Atomically>
T atomic_change(volatile T* at, const Change& change, Atomically atomically) {
  if (!is_alone) return atomically();
  const T old = *at;
  *at = change(old);
  return old;
}
inline int atomic_inc(volatile int* at) {
  return atomic_change(
      at, [](int old) { return old + 1; }, [at] { return __atomic_fetch_add(at, 1, __ATOMIC_RELAXED); });
}
inline uint atomic_add(volatile uint* at, uint value) {
  return atomic_change(
      at, [value](uint old) { return old + value; },
      [at, value] { return __atomic_fetch_add(at, value, __ATOMIC_RELAXED); });
}
inline uint atomic_inc(volatile uint* at) { return atomic_add(at, 1u); }
template <typename T>
T atomic_or(volatile T* at, T value) {
  return atomic_change(
      at, [value](T old) { return old | value; },
      [at, value] { return __atomic_fetch_or(at, value, __ATOMIC_RELAXED); });
}
inline int atomic_cmpxchg(volatile int* at, int expected, int value) {
  return atomic_change(
      at, [expected, value](int old) { return old == expected ? value : old; },
      [at, expected, value]() mutable {
        __atomic_compare_exchange_n(at, &expected, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
        return expected;
      });
}
// Reads and writes of memory that other work-items change meanwhile; see constrained/meanwhile.h.
inline int read_shared(const volatile int* at) { return __atomic_load_n(at, __ATOMIC_RELAXED); }
inline uint read_shared(const volatile uint* at) { return __atomic_load_n(at, __ATOMIC_RELAXED); }
inline void write_shared(volatile int* at, int value) { __atomic_store_n(at, value, __ATOMIC_RELAXED); }
inline void write_shared(volatile uint* at, uint value) { __atomic_store_n(at, value, __ATOMIC_RELAXED); }
// Replaces the value by another one while that is better.
template <typename T, typename IsBetter>
T atomic_improve(volatile T* at, T value, const IsBetter& is_better) {
  T old = __atomic_load_n(at, __ATOMIC_RELAXED);
  if (is_alone) {
    // Without a branch, which could often not be predicted.
    *at = is_better(value, old) ? value : old;
    return old;
  }
  while (is_better(value, old) &&
         !__atomic_compare_exchange_n(at, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return old;
}
inline int atomic_min(volatile int* at, int value) {
  return atomic_improve(at, value, [](int a, int b) { return a < b; });
}
inline uint atomic_min(volatile uint* at, uint value) {
  return atomic_improve(at, value, [](uint a, uint b) { return a < b; });
}
inline int atomic_max(volatile int* at, int value) {
  return atomic_improve(at, value, [](int a, int b) { return a > b; });
}
inline uint atomic_max(volatile uint* at, uint value) {
  return atomic_improve(at, value, [](uint a, uint b) { return a > b; });
}

/// The work-item that this thread runs, and how many there are.
struct WorkItem {
  std::size_t number = 0, total = 0;
};
inline thread_local WorkItem work_item [[gnu::tls_model("initial-exec")]];
inline std::size_t get_global_id(int) { return work_item.number; }
inline std::size_t get_global_size(int) { return work_item.total; }
// Every work-group has one work-item.
inline std::size_t get_local_id(int) { return 0; }
inline std::size_t get_local_size(int) { return 1; }
inline std::size_t get_group_id(int) { return work_item.number; }
inline std::size_t get_num_groups(int) { return work_item.total; }

/// Runs work-items of a kernel; see host::NativeFunction.
template <auto Kernel>
void run_work_items(host::WorkItems items, void* const* arguments) {
  const auto run = [&]<typename... Parameters, std::size_t... I>(void (*)(Parameters...),
                                                                 std::index_sequence<I...>) {
    std::tuple<std::remove_const_t<Parameters>...> values;
    (std::memcpy(&std::get<I>(values), arguments[I], sizeof(Parameters)), ...);
    is_alone = items.begin == 0 && items.end == items.total;
    for (std::size_t item = items.begin; item < items.end; ++item) {
      work_item = {item, items.total};
      Kernel(std::get<I>(values)...);
    }
  };
  const auto with_indices = [&]<typename... Parameters>(void (*function)(Parameters...)) {
    run(function, std::index_sequence_for<Parameters...>());
  };
  with_indices(Kernel);
}

}  // namespace flaunay::kernel
