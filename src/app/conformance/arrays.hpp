// The arrays of a result, for comparing two results byte by byte.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace flaunay::conformance {

/// Arrays by name, in the order in which they were added.
class Arrays {
 public:
  template <typename T>
  void add(const std::string& name, std::vector<T> values) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
    Array array{name, values.size(), {bytes, bytes + values.size() * sizeof(T)}, {}};
    array.text = [values = std::move(values)](std::size_t k) {
      if constexpr (std::is_enum_v<T>) return fmt::format("{}", static_cast<int>(values[k]));
      if constexpr (!std::is_enum_v<T>) return fmt::format("{}", values[k]);
    };
    arrays_.push_back(std::move(array));
  }

  /// "": the same bytes. Otherwise the first difference: array, index, both values.
  std::string difference_from(const Arrays& expected) const;
  /// The number of bytes.
  std::size_t bytes() const;

 private:
  struct Array {
    std::string name;
    std::size_t size;
    std::vector<unsigned char> bytes;
    std::function<std::string(std::size_t)> text;
  };
  std::vector<Array> arrays_;
};

}  // namespace flaunay::conformance
