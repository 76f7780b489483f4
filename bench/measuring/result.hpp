// Measurements of subcommands, which are printed as tables and written as records. They are separate from
// options, since peers need no parser of command lines, whose header takes as long to compile as they do.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::bench {

/// Objects keep the order in which their keys were added.
using Json = nlohmann::ordered_json;

/// The measurements of a subcommand.
struct Result {
  explicit Result(DeviceInfo of_device = {}) : device(std::move(of_device)) {}
  DeviceInfo device;
  /// Tables: each key has a list of rows, and each row is an object. Numbers are rounded when it is written.
  Json tables = Json::object();
  std::set<std::string> not_printed = {};  ///< tables that only the record has
  Json facts = Json::object();             ///< more about all of the record
  bool agree = true;                       ///< whether all implementations agree; if not, the exit code is 1
};

// ---- Rows

/// Adds seconds_median, seconds_min and seconds_max.
void add_seconds(Json& row, const std::vector<double>& seconds);

/// The value, or null.
Json json_of(const std::optional<double>& value);

/// a / b, if both are there.
std::optional<double> ratio(std::optional<double> a, std::optional<double> b);

/// A row of the table "targets". Where less is better, the goal is less than `at_least`, which then is the
/// most that is allowed.
Json target(const std::string& what, const std::string& implementation, double at_least, double goal,
            const std::optional<double>& measured);

}  // namespace flaunay::bench
