#include "geometry/point_sets.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "geometry/arguments.hpp"
#include "geometry/sort.hpp"

namespace flaunay::geometry {
namespace {

// Adding 0 turns -0 into 0.
double scaled(double x, double factor) { return x * factor + 0.0; }

// Indices of the input's points begin..end-1 in the order of (x, y, index).
class Order {
 public:
  explicit Order(const double* coordinates) : coordinates_(coordinates) {}

  // Their coordinates are multiplied by 2^shift.
  const std::vector<Keyed>& sort(std::size_t begin, std::size_t end, int shift) {
    factor_ = std::ldexp(1.0, shift);
    elements_.resize(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      elements_[i - begin] = {sort_key(x(i)), static_cast<std::int32_t>(i)};
    }
    sort_by_key(elements_);
    for (auto first = elements_.begin(); first != elements_.end();) {
      auto last = first + 1;
      while (last != elements_.end() && last->key == first->key) ++last;
      if (last - first > 1) sort_column(first, last);
      first = last;
    }
    return elements_;
  }

  Point point(std::int32_t i) const { return {x(i), scaled(coordinates_[2 * std::size_t(i) + 1], factor_)}; }

 private:
  using Iterator = std::vector<Keyed>::iterator;

  double x(std::size_t i) const { return scaled(coordinates_[2 * i], factor_); }

  // Sorts points of equal x, which are in the order of their indices already, by y.
  void sort_column(Iterator first, Iterator last) {
    column_.assign(first, last);
    for (Keyed& element : column_) element.key = sort_key(point(element.index).y);
    sort_by_key(column_);
    std::transform(column_.begin(), column_.end(), first, first, [](const Keyed& from, const Keyed& to) {
      return Keyed{to.key, from.index};
    });
  }

  const double* coordinates_;
  double factor_ = 1;
  std::vector<Keyed> elements_, column_;
};

}  // namespace

PointSets ingest(const double* coordinates, const std::vector<std::size_t>& offsets) {
  check_offsets(offsets);
  const std::size_t n = offsets.back();
  check_points(coordinates, n);
  const SetScalings scalings = set_scalings(
      coordinates, offsets,
      [coordinates](std::size_t first, std::size_t last) { return inspect(coordinates, first, last); });
  PointSets sets;
  sets.predicates.bounds = scalings.bounds;
  sets.representatives.resize(n);
  sets.points.reserve(n);
  sets.source.reserve(n);
  sets.set_offsets.push_back(0);
  Order order(coordinates);
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    bool first = true;
    for (const Keyed& element : order.sort(offsets[s], offsets[s + 1], scalings.shift(s))) {
      const Point point = order.point(element.index);
      if (first || !(point == sets.points.back())) {
        sets.points.push_back(point);
        sets.source.push_back(element.index);
      }
      first = false;
      sets.representatives[element.index] = sets.source.back();
    }
    sets.set_offsets.push_back(static_cast<std::int32_t>(sets.points.size()));
  }
  return sets;
}

}  // namespace flaunay::geometry
