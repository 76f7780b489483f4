// Rows of a mesh's arrays: some are kept, permuted or copied to their parts, and labels are numbered anew.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace flaunay::mesh {

/// Keeps the rows for which is_left is true, in their order.
template <typename Flags, typename T>
void keep(const Flags& is_left, std::size_t columns, std::vector<T>& rows) {
  if (rows.empty()) return;
  std::size_t to = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (is_left[i / columns]) rows[to++] = rows[i];
  }
  rows.resize(to);
}

/// The numbers of rows after keep, or -1.
template <typename Flags>
std::vector<std::int32_t> numbers_of_kept(const Flags& is_left) {
  std::vector<std::int32_t> numbers(is_left.size(), -1);
  std::int32_t count = 0;
  for (std::size_t t = 0; t < numbers.size(); ++t) {
    if (is_left[t]) numbers[t] = count++;
  }
  return numbers;
}

/// Gives each row its new number.
template <typename T>
void permute(const std::vector<std::int32_t>& numbers, std::size_t columns, std::vector<T>& rows) {
  std::vector<T> permuted(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    permuted[columns * static_cast<std::size_t>(numbers[i / columns]) + i % columns] = rows[i];
  }
  rows = std::move(permuted);
}

/// Gives each triangle the value of the one that it is a part of.
template <typename T>
void inherit(const std::vector<std::int32_t>& parents, std::vector<T>& values) {
  if (values.empty()) return;
  std::vector<T> own;
  own.reserve(parents.size());
  for (const std::int32_t parent : parents) own.push_back(values[static_cast<std::size_t>(parent)]);
  values = std::move(own);
}

/// Numbers labels in the order in which they appear first.
inline void renumber_labels(std::vector<std::int32_t>& labels) {
  if (labels.empty()) return;
  std::vector<std::int32_t> numbers(
      static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end())) + 1, -1);
  std::int32_t next = 0;
  for (std::int32_t& label : labels) {
    std::int32_t& number = numbers[static_cast<std::size_t>(label)];
    if (number < 0) number = next++;
    label = number;
  }
}

}  // namespace flaunay::mesh
