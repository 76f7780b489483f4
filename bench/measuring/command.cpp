#include "bench/measuring/command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <thread>

#include "app/command/errors.hpp"
#include "bench/measuring/jobs.hpp"
#include "files/output.hpp"

namespace flaunay::bench {

const char* commit();  // in commit.cpp

namespace {

// ---- Tables

/// A list of a median, a minimum and a maximum.
bool is_spread(const Json& value) { return value.is_array() && value.size() == 3 && value[0].is_number(); }

std::string text_of(const Json& row, const std::string& column) {
  const auto value = row.find(column);
  if (value == row.end()) return "";
  if (value->is_null()) return "-";
  if (value->is_string()) return value->get<std::string>();
  if (is_spread(*value)) {
    return fmt::format("{:.4g} ({:.4g} to {:.4g})", value->at(0).get<double>(), value->at(1).get<double>(),
                       value->at(2).get<double>());
  }
  return value->is_number_float() ? fmt::format("{:.4g}", value->get<double>()) : value->dump();
}

/// The keys of all values that fit into a cell, in order of their first use.
std::vector<std::string> columns_of(const Json& rows) {
  std::vector<std::string> columns;
  for (const Json& row : rows) {
    for (const auto& [key, value] : row.items()) {
      const bool fits = value.is_primitive() || is_spread(value);
      if (fits && std::find(columns.begin(), columns.end(), key) == columns.end()) {
        columns.push_back(key);
      }
    }
  }
  return columns;
}

void print_table(const std::string& title, const Json& rows) {
  std::vector<std::string> lines(rows.size() + 1);
  for (const std::string& column : columns_of(rows)) {
    std::vector<std::string> cells{column};
    for (const Json& row : rows) cells.push_back(text_of(row, column));
    std::size_t width = 0;
    for (const std::string& cell : cells) width = std::max(width, cell.size());
    const bool left = std::any_of(rows.begin(), rows.end(), [&](const Json& row) {
      return row.contains(column) && row.at(column).is_string();
    });
    for (std::size_t l = 0; l < lines.size(); ++l) {
      lines[l] += left ? fmt::format("{:<{}}  ", cells[l], width) : fmt::format("{:>{}}  ", cells[l], width);
    }
  }
  fmt::print("\n{}\n{}\n", title, fmt::join(lines, "\n"));
}

// ---- Records

/// The name of the host's processor, and the number of threads that it runs at once.
std::string host_description() {
  std::ifstream information("/proc/cpuinfo");
  std::string line;
  while (std::getline(information, line) && line.rfind("model name", 0) != 0) continue;
  const std::size_t colon = line.find(": ");
  return fmt::format("{}, {} hardware threads",
                     information && colon != line.npos ? line.substr(colon + 2) : "unknown processor",
                     std::thread::hardware_concurrency());
}

/// Times are not repeatable to more digits than these.
void round_numbers(Json& value) {
  if (value.is_number_float()) {
    value = std::stod(fmt::format("{:.4g}", value.get<double>()));
  } else {
    for (Json& part : value) {
      if (!part.is_primitive() || part.is_number_float()) round_numbers(part);
    }
  }
}

/// JSON with a line for each row.
std::string text_of(const Json& record) {
  std::string text;
  for (const auto& [key, value] : record.items()) {
    text += fmt::format("{}  {}: ", text.empty() ? "{\n" : ",\n", Json(key).dump());
    if (!value.is_array() || value.empty()) {
      text += value.dump();
      continue;
    }
    std::vector<std::string> rows;
    for (const Json& row : value) rows.push_back("    " + row.dump());
    text += fmt::format("[\n{}\n  ]", fmt::join(rows, ",\n"));
  }
  return text + "\n}\n";
}

}  // namespace

Options::Options(CLI::App& app, Request& request) : app_(app), request_(request) {
  app.add_option("--json", request.json_path,
                 "write the record here; bench/plot.py RECORD.json -o FILE.svg draws it");
  app.add_option("--device", request.device, "device, as for flaunay triangulate");
}

Subcommands& all_subcommands() {
  static Subcommands all;
  return all;
}

int measure_and_record(const std::string& subcommand, const std::string& command_line, const Request& request,
                       const std::function<Result()>& measure) {
  // Before hours of measuring.
  if (!request.json_path.empty()) io::Outputs().announce(request.json_path);
  Result result = measure();
  round_numbers(result.tables);
  for (const auto& [title, rows] : result.tables.items()) {
    if (!rows.empty() && result.not_printed.count(title) == 0) print_table(title, rows);
  }
  if (!request.json_path.empty()) {
    Json record{{"subcommand", subcommand},
                {"device", result.device.name},
                {"driver", result.device.driver},
                {"platform", result.device.platform},
                {"host", host_description()},
                {"commit", commit()},
                {"command", command_line},
                {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
                {"runs", request.runs},
                {"agree", result.agree}};
    record.update(result.facts);
    record.update(result.tables);
    io::Outputs outputs;
    outputs.open(request.json_path).print("{}", text_of(record));
    outputs.commit();
  }
  return result.agree ? cli::kSuccess : cli::kFailure;
}

void add_seconds(Json& row, const std::vector<double>& seconds) {
  const Summary of_all = summary(seconds);
  row["seconds_median"] = of_all.median;
  row["seconds_min"] = of_all.low;
  row["seconds_max"] = of_all.high;
}

Json json_of(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return {};
  return *a / *b;
}

Json target(const std::string& what, const std::string& implementation, double at_least, double goal,
            const std::optional<double>& measured) {
  const bool more_is_better = goal > at_least;
  const auto reaches = [&](double limit) { return more_is_better ? *measured >= limit : *measured <= limit; };
  return {{"what", what},
          {"implementation", implementation},
          {"more_is_better", more_is_better},
          {"at_least", at_least},
          {"goal", goal},
          {"measured", json_of(measured)},
          {"verdict", !measured           ? "not measured"
                      : reaches(goal)     ? "goal"
                      : reaches(at_least) ? "kept"
                                          : "MISSED"}};
}

}  // namespace flaunay::bench
