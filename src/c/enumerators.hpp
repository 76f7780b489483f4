// Enumerators of C and of C++, which have the same names and numbers.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/research.hpp"
#include "flaunay/terrain.hpp"
#include "geometry/arguments.hpp"
#include "geometry/enumerators.hpp"

namespace flaunay::c {

/// Whether C's enumerator of this number has this name behind a prefix, in upper case.
template <typename OfC, int kNumber>
constexpr bool is_named(std::string_view name) {
  std::string_view of_c = name_of_enumerator<static_cast<OfC>(kNumber)>();
  if (of_c.size() <= name.size() || of_c[of_c.size() - name.size() - 1] != '_') return false;
  of_c.remove_prefix(of_c.size() - name.size());
  return std::equal(of_c.begin(), of_c.end(), name.begin(), [](char upper, char lower) {
    return upper == (lower >= 'a' && lower <= 'z' ? lower - 'a' + 'A' : lower);
  });
}

/// Whether C has no enumerator of this number. Clang takes none beyond the enumerators for a constant, and is
/// not asked.
template <typename OfC, int kNumber>
constexpr bool is_none() {
#ifdef __clang__
  return true;
#else
  return name_of_enumerator<static_cast<OfC>(kNumber)>().empty();
#endif
}

/// Whether both enumerations have the same enumerators, which count up from `kFirst`.
template <typename OfC, typename Enum, int kFirst = 0>
constexpr bool agree() {
  constexpr std::string_view name = name_of_enumerator<static_cast<Enum>(kFirst)>();
  if constexpr (name.empty()) {
    return is_none<OfC, kFirst>();
  } else {
    return is_named<OfC, kFirst>(name) && agree<OfC, Enum, kFirst + 1>();
  }
}

/// Whether the bits of an enumeration of C are named like the arrays of a table.
template <typename Part, std::size_t kSize>
constexpr bool are_parts(const std::array<std::string_view, kSize>& arrays) {
  return [&]<std::size_t... k>(std::index_sequence<k...>) {
    return (is_named<Part, 1 << k>(arrays[k]) && ...) && is_none<Part, 1 << kSize>();
  }
  (std::make_index_sequence<kSize>());
}

/// C's enumeration for one of C++.
template <typename Enum>
struct OfC;

#define FLAUNAY_ENUMERATION(name, Enum)                                         \
  template <>                                                                   \
  struct OfC<Enum> {                                                            \
    static_assert(agree<flaunay_##name, Enum, std::is_same_v<Enum, Excuse>>()); \
    using type = flaunay_##name;                                                \
  };
FLAUNAY_ENUMERATION(mode, research::Mode)
FLAUNAY_ENUMERATION(cut, research::Cut)
FLAUNAY_ENUMERATION(hull, research::Hull)
FLAUNAY_ENUMERATION(finish, research::Finish)
FLAUNAY_ENUMERATION(precision, Precision)
FLAUNAY_ENUMERATION(space_kind, SpaceKind)
FLAUNAY_ENUMERATION(sphere_coordinates, SphereCoordinates)
FLAUNAY_ENUMERATION(crossings, Crossings)
FLAUNAY_ENUMERATION(outside, Outside)
FLAUNAY_ENUMERATION(fill_rule, FillRule)
FLAUNAY_ENUMERATION(overlaps, Overlaps)
FLAUNAY_ENUMERATION(interpolation, Interpolation)
FLAUNAY_ENUMERATION(duplicates, Duplicates)
FLAUNAY_ENUMERATION(kept_edges, KeptEdges)
FLAUNAY_ENUMERATION(excuse, Excuse)
#undef FLAUNAY_ENUMERATION

/// The enumerator of a number, which count up from 0. Throws Error(usage), which names the type of C.
template <typename Enum>
Enum to_enum(int value) {
  expect(value >= 0 && value < end_of_enumerators<Enum>(), [value] {
    return fmt::format("{} is no {}", value, name_of_enumeration<typename OfC<Enum>::type>());
  });
  return static_cast<Enum>(value);
}

}  // namespace flaunay::c
