// Statistics as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

using Json = nlohmann::ordered_json;

/// JSON must be UTF-8, but names of files need not be.
inline std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A list of what `describe` makes of each value.
template <typename Value, typename Describe>
Json list_json(const std::vector<Value>& values, const Describe& describe) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(describe(value));
  return list;
}

inline Json phases_json(const std::vector<PhaseStatistics>& phases) {
  return list_json(phases, [](const PhaseStatistics& phase) -> Json {
    return {{"name", phase.name}, {"seconds", phase.seconds}};
  });
}

template <typename AnyStatistics>
void add_counts(Json& json, const AnyStatistics& statistics) {
  json["points"] = statistics.points;
  json["duplicates"] = statistics.duplicates;
  json["triangles"] = statistics.triangles;
  json["hull_vertices"] = statistics.hull_vertices;
}

}  // namespace flaunay::cli
