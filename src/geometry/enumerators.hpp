// The names of enumerators, which the compiler knows: no list repeats them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace flaunay {

/// The name of a function's template argument, as the compiler writes it: "flaunay::FillRule::even_odd", or
/// for a number that has no enumerator "(flaunay::FillRule)3".
constexpr std::string_view argument_in(std::string_view function) {
  const std::size_t first = function.find('=') + 2;
  return function.substr(first, function.size() - first - 1);
}

/// The name of an enumerator, such as even_odd; empty for a number that has none.
template <auto kValue>
constexpr auto name_of_enumerator() {
  constexpr std::string_view text = argument_in(__PRETTY_FUNCTION__);
  return text.front() == '(' ? std::string_view() : text.substr(text.rfind(':') + 1);
}

/// The name of an enumeration, without its namespace.
template <typename Enum>
constexpr auto name_of_enumeration() {
  constexpr std::string_view text = argument_in(__PRETTY_FUNCTION__);
  return text.substr(text.rfind(':') + 1);
}

/// One more than the number of the last enumerator. They count up from `kFirst`.
template <typename Enum, int kFirst = 0>
constexpr int end_of_enumerators() {
  if constexpr (name_of_enumerator<static_cast<Enum>(kFirst)>().empty()) {
    return kFirst;
  } else {
    return end_of_enumerators<Enum, kFirst + 1>();
  }
}

/// The names of the enumerators, which count up from 0.
template <typename Enum>
constexpr auto names_of_enumerators() {
  return []<int... k>(std::integer_sequence<int, k...>) {
    return std::array{name_of_enumerator<static_cast<Enum>(k)>()...};
  }
  (std::make_integer_sequence<int, end_of_enumerators<Enum>()>());
}

/// The word of an enumerator on the command line, such as even-odd.
template <typename Enum>
std::string word_of(Enum value) {
  std::string word(names_of_enumerators<Enum>()[static_cast<std::size_t>(value)]);
  std::replace(word.begin(), word.end(), '_', '-');
  return word;
}

}  // namespace flaunay
