#include "geometry/arguments.hpp"

#include <fmt/format.h>

namespace flaunay {

void check_count(std::uint64_t count, const char* name, std::uint64_t most) {
  if (count <= most) return;
  throw Error(ErrorKind::input,
              fmt::format("{} {} are too many: at most {} are possible", count, name, most));
}

void check_array(const void* array, std::uint64_t count, const char* name, std::uint64_t most) {
  check_count(count, name, most);
  if (count > 0 && array == nullptr) {
    throw Error(ErrorKind::usage, fmt::format("{} {}, but the pointer to them is NULL", count, name));
  }
}

void check_points(const void* coordinates, std::uint64_t count) {
  check_array(coordinates, count, "points", kMostPointsAtOnce);
}

void check_queries(const void* coordinates, std::uint64_t count) {
  check_array(coordinates, count, "queries", kMostIndexed / 2);
}

std::size_t check_columns(std::size_t columns, std::size_t rows) {
  expect(columns > 0, "columns: at least one number per point is needed");
  check_count(columns, "columns", std::min(kMostIndexed, kMostCountable / std::max<std::size_t>(rows, 1)));
  return columns * rows;
}

void check_enumerator(int value, int end, std::string_view type) {
  expect(value >= 0 && value < end, [&] { return fmt::format("{} is no {}", value, type); });
}

void check_offsets(const std::vector<std::size_t>& offsets) {
  expect(!offsets.empty() && offsets.front() == 0 && std::is_sorted(offsets.begin(), offsets.end()),
         "offsets of point sets must begin with 0 and not decrease");
}

void check_offsets(const std::vector<std::size_t>& offsets, std::size_t n) {
  check_offsets(offsets);
  expect(offsets.back() == n, [&] {
    return fmt::format("offsets of point sets end with {}, but there are {} points", offsets.back(), n);
  });
}

}  // namespace flaunay
