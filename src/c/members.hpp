// Conversions between structs of C and of C++, member by member of the same name: what C has and C++ lacks
// does not compile, unless the caller names it. cmake/members.cmake lists the members of the structs of
// flaunay.h.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

#include "c/enumerators.hpp"
#include "c/errors.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/flaunay.hpp"
#include "geometry/arguments.hpp"

namespace flaunay::c {

/// The name of a member, as an argument of templates.
template <std::size_t kSize>
struct MemberName {
  constexpr MemberName(const char (&given)[kSize]) { std::copy_n(given, kSize, text); }
  constexpr bool operator==(std::string_view other) const { return std::string_view(text) == other; }
  char text[kSize]{};
};

template <typename Given, typename Struct>
concept Is = std::same_as<std::remove_const_t<Given>, Struct>;

// copy(member of C, member of C++, whether it counts, its name) for each member but `kOthers` and those that
// say whether another one counts.
#define FLAUNAY_MEMBER(name)                                                                    \
  if constexpr (!((kOthers == #name) || ...) && !std::string_view(#name).starts_with("has_")) { \
    static_assert(                                                                              \
        requires { cpp.name; }, "only C has " #name);                                           \
    if constexpr (requires { of_c.has_##name; }) {                                              \
      copy(of_c.name, cpp.name, of_c.has_##name != 0, #name);                                   \
    } else {                                                                                    \
      copy(of_c.name, cpp.name, true, #name);                                                   \
    }                                                                                           \
  }
#define FLAUNAY_STRUCT(name, members)                                                   \
  template <MemberName... kOthers, Is<flaunay_##name> OfC, typename Cpp, typename Copy> \
  void for_each_member([[maybe_unused]] OfC& of_c, [[maybe_unused]] Cpp& cpp,           \
                       [[maybe_unused]] const Copy& copy) {                             \
    members                                                                             \
  }
#include "members.h"
#undef FLAUNAY_STRUCT
#undef FLAUNAY_MEMBER

/// Throws Error(usage) unless all reserved members of a C struct are 0.
template <typename Struct>
void check_reserved(const Struct& given) {
  const auto is_set = [](std::uintptr_t member) { return member != 0; };
  if (std::any_of(std::begin(given.reserved), std::end(given.reserved), is_set)) {
    throw Error(ErrorKind::usage,
                fmt::format("{} has members that flaunay {} does not know: initialise it with {{0}}, or take "
                            "a later version",
                            name_of_enumeration<Struct>(), version()));
  }
}

/// Takes over the caller's options but `kOthers`; what does not count keeps its default. Throws Error(usage)
/// for reserved members that are not 0 and for unknown enumerators.
template <MemberName... kOthers, typename Given, typename Result>
void take(const Given& given, Result& result) {
  check_reserved(given);
  for_each_member<kOthers...>(given, result, [](auto from, auto& to, bool counts, const char*) {
    using To = std::remove_reference_t<decltype(to)>;
    if (!counts) return;
    if constexpr (std::is_enum_v<To>) {
      to = to_enum<To>(from);
    } else if constexpr (std::is_same_v<To, bool>) {
      to = from != 0;
    } else if constexpr (std::is_same_v<To, std::string>) {
      if (from != nullptr) to = from;
    } else {
      to = from;
    }
  });
}

/// Writes all but `kOthers` of a result to a struct of C, which refers to it. Arrays in device memory stay
/// null.
template <MemberName... kOthers, typename Result, typename View>
void show(const Result& result, View& view) {
  for_each_member<kOthers...>(view, result, [](auto& to, const auto& from, bool, const char*) {
    using To = std::remove_reference_t<decltype(to)>;
    using From = std::remove_cvref_t<decltype(from)>;
    if constexpr (std::is_same_v<From, std::string>) {
      to = from.c_str();
    } else if constexpr (std::is_enum_v<From>) {
      to = static_cast<To>(from);
    } else if constexpr (requires { typename From::allocator_type; }) {
      using Element = typename From::value_type;
      if (from.empty()) {
        to = nullptr;
      } else if constexpr (std::is_enum_v<Element>) {
        to = reinterpret_cast<const std::underlying_type_t<Element>*>(from.data());
      } else {
        to = from.data();
      }
    } else if constexpr (!std::is_same_v<From, DeviceBuffer>) {
      to = from;
    }
  });
}

}  // namespace flaunay::c
