#include "updates/points.hpp"

#include <algorithm>
#include <limits>

namespace flaunay::updates {

void Points::append(const double* coordinates, std::size_t n) {
  magnitudes_ = geometry::joined(magnitudes_, geometry::inspect(coordinates, 0, n));
  coordinates_.insert(coordinates_.end(), coordinates, coordinates + 2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    representatives_.push_back(static_cast<std::int32_t>(representatives_.size()));
  }
  marks_.resize(representatives_.size(), 0);
  count_ += n;
}

void Points::remove(std::int32_t v) {
  const auto i = static_cast<std::size_t>(v);
  representatives_[i] = -1;
  coordinates_[2 * i] = coordinates_[2 * i + 1] = std::numeric_limits<double>::quiet_NaN();
  --count_;
}

void Points::move(std::int32_t v, const double* coordinates) {
  std::copy(coordinates, coordinates + 2, &coordinates_[2 * static_cast<std::size_t>(v)]);
}

void Points::check_range(const double* coordinates, const std::int32_t* numbers, std::size_t m) {
  geometry::Magnitudes all = geometry::joined(magnitudes_, geometry::inspect(coordinates, 0, m));
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
  for (std::size_t i = 0; i < representatives.size(); ++i) {
    representatives_[static_cast<std::size_t>(living.numbers[i])] =
        living.numbers[static_cast<std::size_t>(representatives[i])];
  }
}

}  // namespace flaunay::updates
