#include "updates/points.hpp"

#include <algorithm>
#include <limits>

#include "points/codes.h"

namespace flaunay::updates {

void Points::begin_batch() {
  before_.clear();
  numbers_before_ = numbers();
  count_before_ = count_;
}

void Points::keep(std::int32_t v) {
  const auto i = static_cast<std::size_t>(v);
  before_.push_back({coordinates_[2 * i], coordinates_[2 * i + 1], v, representatives_[i]});
}

void Points::roll_back() noexcept {
  for (auto before = before_.rbegin(); before != before_.rend(); ++before) {
    const auto i = static_cast<std::size_t>(before->number);
    coordinates_[2 * i] = before->x;
    coordinates_[2 * i + 1] = before->y;
    representatives_[i] = before->representative;
  }
  coordinates_.resize(2 * numbers_before_);
  representatives_.resize(numbers_before_);
  marks_.resize(numbers_before_);
  count_ = count_before_;
  others_.clear();
}

void Points::append(const double* coordinates, std::size_t n) {
  marks_.resize(representatives_.size() + n, 0);
  coordinates_.insert(coordinates_.end(), coordinates, coordinates + 2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    representatives_.push_back(static_cast<std::int32_t>(representatives_.size()));
  }
  count_ += n;
}

std::int32_t Points::leave(std::int32_t v) {
  const std::int32_t representative = this->representative(v);
  const auto group = others_.find(representative);
  keep(v);
  representatives_[static_cast<std::size_t>(v)] = v;
  if (group == others_.end()) return -1;
  std::set<std::int32_t> others = std::move(group->second);
  others_.erase(group);
  if (representative != v) {
    others.erase(v);
    if (!others.empty()) others_[representative] = std::move(others);
    return -1;
  }
  const std::int32_t next = *others.begin();
  for (const std::int32_t other : others) {
    keep(other);
    representatives_[static_cast<std::size_t>(other)] = next;
  }
  others.erase(others.begin());
  if (!others.empty()) others_[next] = std::move(others);
  return next;
}

void Points::remove(std::int32_t v) {
  const auto i = static_cast<std::size_t>(v);
  keep(v);
  representatives_[i] = -1;
  coordinates_[2 * i] = coordinates_[2 * i + 1] = std::numeric_limits<double>::quiet_NaN();
  --count_;
}

void Points::move(std::int32_t v, const double* coordinates) {
  keep(v);
  std::copy(coordinates, coordinates + 2, &coordinates_[2 * static_cast<std::size_t>(v)]);
}

void Points::join(std::int32_t v, std::int32_t representative) {
  std::set<std::int32_t> joining;
  if (const auto own = others_.find(v); own != others_.end()) {
    joining = std::move(own->second);
    others_.erase(own);
  }
  joining.insert(v);
  for (const std::int32_t other : joining) {
    keep(other);
    representatives_[static_cast<std::size_t>(other)] = representative;
  }
  others_[representative].merge(joining);
}

std::vector<std::int32_t> Points::sample(std::size_t n) const {
  std::vector<std::int32_t> chosen;
  const std::size_t step = std::max<std::size_t>(1, count_ / std::max<std::size_t>(1, n));
  std::size_t skip = 0;
  for (std::size_t v = 0; v < representatives_.size(); ++v) {
    if (static_cast<std::size_t>(representatives_[v]) != v || skip++ % step != 0) continue;
    chosen.push_back(static_cast<std::int32_t>(v));
  }
  return chosen;
}

void Points::check_coordinates(const double* coordinates, const std::int32_t* numbers, std::size_t m) {
  const geometry::Magnitudes given = geometry::inspect(coordinates, 0, m);
  if (given.bad != kernel::NO_BAD) {
    const auto bad = static_cast<std::size_t>(given.bad);
    throw geometry::not_finite(bad, coordinates[2 * bad], coordinates[2 * bad + 1]);
  }
  geometry::Magnitudes all = geometry::joined(magnitudes_, given);
  if (geometry::differ_too_much(all)) {
    // Points that are gone may have made the range larger.
    std::vector<double> others;
    std::vector<std::size_t> number_of;
    for (std::size_t i = 0; i < representatives_.size(); ++i) {
      if (representatives_[i] < 0 || (numbers != nullptr && marks_[i] == batch_)) continue;
      others.insert(others.end(), {coordinates_[2 * i], coordinates_[2 * i + 1]});
      number_of.push_back(i);
    }
    others.insert(others.end(), coordinates, coordinates + 2 * m);
    for (std::size_t i = 0; i < m; ++i) {
      number_of.push_back(numbers != nullptr ? static_cast<std::size_t>(numbers[i])
                                             : representatives_.size() + i);
    }
    all = geometry::inspect(others.data(), 0, number_of.size());
    if (geometry::differ_too_much(all)) {
      geometry::RangeEnds ends = geometry::find_ends(others.data(), 0, number_of.size(), all);
      for (geometry::NamedCoordinate* named : {&ends.largest, &ends.finest}) {
        named->point = number_of[named->point];
      }
      throw geometry::range_error(ends.largest, ends.finest, all);
    }
  }
  magnitudes_ = all;
}

std::size_t Points::mark(const std::int32_t* numbers, std::size_t m) {
  ++batch_;
  for (std::size_t i = 0; i < m; ++i) {
    const std::int32_t v = numbers[i];
    if (v < 0 || static_cast<std::size_t>(v) >= representatives_.size() || !is_alive(v) || is_marked(v)) {
      return i;
    }
    marks_[static_cast<std::size_t>(v)] = batch_;
  }
  return m;
}

Living Points::living() const {
  Living living;
  living.are_all = count_ == representatives_.size();
  if (living.are_all) return living;
  living.places.assign(representatives_.size(), -1);
  living.numbers.reserve(count_);
  living.coordinates.reserve(2 * count_);
  for (std::size_t i = 0; i < representatives_.size(); ++i) {
    if (representatives_[i] < 0) continue;
    living.places[i] = static_cast<std::int32_t>(living.numbers.size());
    living.numbers.push_back(static_cast<std::int32_t>(i));
    living.coordinates.insert(living.coordinates.end(), {coordinates_[2 * i], coordinates_[2 * i + 1]});
  }
  return living;
}

void Points::set_representatives(const Living& living, const std::vector<std::int32_t>& representatives) {
  const auto number = [&](std::size_t i) {
    return living.are_all ? static_cast<std::int32_t>(i) : living.numbers[i];
  };
  std::unordered_map<std::int32_t, std::set<std::int32_t>> others;
  for (std::size_t i = 0; i < representatives.size(); ++i) {
    const auto by = static_cast<std::size_t>(representatives[i]);
    if (by != i) others[number(by)].insert(number(i));
  }
  others_.swap(others);
  for (std::size_t i = 0; i < representatives.size(); ++i) {
    representatives_[static_cast<std::size_t>(number(i))] =
        number(static_cast<std::size_t>(representatives[i]));
  }
}

std::size_t Points::places() const noexcept {
  std::size_t count = 0;
  for (std::size_t v = 0; v < representatives_.size(); ++v) {
    count += static_cast<std::size_t>(representatives_[v]) == v;
  }
  return count;
}

}  // namespace flaunay::updates
