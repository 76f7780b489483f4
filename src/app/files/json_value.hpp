// Values of JSON as those of fields.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "app/files/points.hpp"

namespace flaunay::io {

/// Truth values are 1 and 0, as in a GeoPackage; arrays and objects are text.
template <typename Json>
FieldValue field_value(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_boolean()) return std::int64_t{value.template get<bool>()};
  if (value.is_string()) return value.template get<std::string>();
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const bool is_large = value.is_number_unsigned() && value.template get<std::uint64_t>() > kMost;
  if (value.is_number_integer() && !is_large) return value.template get<std::int64_t>();
  if (value.is_number()) return value.template get<double>();
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace flaunay::io
