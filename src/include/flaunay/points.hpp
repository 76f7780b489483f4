// Points as C++ programs have them, for calls that take coordinates x0 y0 x1 y1 ... Header only.
#pragma once

#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {
namespace detail {

template <typename T, typename = void>
struct HasMembers : std::false_type {};
template <typename T>
struct HasMembers<T, std::void_t<decltype(double(std::declval<const T&>().x)),
                                 decltype(double(std::declval<const T&>().y))>> : std::true_type {};
template <typename T, typename = void>
struct HasFunctions : std::false_type {};
template <typename T>
struct HasFunctions<T, std::void_t<decltype(double(std::declval<const T&>().x())),
                                   decltype(double(std::declval<const T&>().y()))>> : std::true_type {};
template <typename T, typename = void>
struct HasParts : std::false_type {};  // std::complex
template <typename T>
struct HasParts<T, std::void_t<decltype(double(std::declval<const T&>().real())),
                               decltype(double(std::declval<const T&>().imag()))>> : std::true_type {};
template <typename T, typename = void>
struct HasFirstAndSecond : std::false_type {};  // std::pair
template <typename T>
struct HasFirstAndSecond<T, std::void_t<decltype(double(std::declval<const T&>().first)),
                                        decltype(double(std::declval<const T&>().second))>> : std::true_type {
};
template <typename Range, typename = void>
struct HasData : std::false_type {};
template <typename Range>
struct HasData<Range, std::void_t<decltype(std::data(std::declval<const Range&>()))>> : std::true_type {};

/// The x and y of a point: its members or functions x and y, its parts, its first and second, or its [0] and
/// [1].
template <typename T>
std::pair<double, double> place_of(const T& point) {
  if constexpr (HasMembers<T>::value) {
    return {double(point.x), double(point.y)};
  } else if constexpr (HasFunctions<T>::value) {
    return {double(point.x()), double(point.y())};
  } else if constexpr (HasParts<T>::value) {
    return {double(point.real()), double(point.imag())};
  } else if constexpr (HasFirstAndSecond<T>::value) {
    return {double(point.first), double(point.second)};
  } else {
    return {double(point[0]), double(point[1])};
  }
}

template <typename Range>
using ElementOf =
    std::remove_cv_t<std::remove_reference_t<decltype(*std::begin(std::declval<const Range&>()))>>;

}  // namespace detail

/// The coordinates of points in a range: std::vector, std::array, std::span, std::deque, an array of C, and
/// others with begin and end. Its elements are the numbers x0 y0 x1 y1 ..., or points that have x and y as
/// members or as functions, as real and imag, as first and second, or as [0] and [1]; what else a point has
/// is not looked at. An array of doubles in one piece is referred to, and must outlive this; everything else
/// is copied, in O(n).
class Points {
 public:
  /// Throws Error(usage) for an odd number of numbers.
  template <typename Range, typename Element = detail::ElementOf<Range>>
  Points(const Range& range) {  // NOLINT(google-explicit-constructor): so that calls take ranges
    if constexpr (std::is_arithmetic_v<Element>) {
      const auto numbers = static_cast<std::size_t>(std::distance(std::begin(range), std::end(range)));
      if (numbers % 2 != 0)
        throw Error(ErrorKind::usage, "there is an odd number of coordinates, x and y of points");
      count_ = numbers / 2;
      if constexpr (is_in_one_piece<Range, Element>()) {
        data_ = std::data(range);
        return;
      }
      copy_.assign(std::begin(range), std::end(range));
    } else {
      for (const Element& point : range) {
        const std::pair<double, double> place = detail::place_of(point);
        copy_.push_back(place.first);
        copy_.push_back(place.second);
      }
      count_ = copy_.size() / 2;
    }
    data_ = copy_.data();
  }
  /// Would refer to the other one's copy.
  Points(const Points&) = delete;
  Points& operator=(const Points&) = delete;

  /// x0 y0 x1 y1 ..., 2 size() numbers.
  const double* data() const noexcept { return data_; }
  /// The number of points.
  std::size_t size() const noexcept { return count_; }

 private:
  template <typename Range, typename Element>
  static constexpr bool is_in_one_piece() {
    if constexpr (std::is_same_v<Element, double>) {
      return detail::HasData<Range>::value;
    } else {
      return false;
    }
  }

  std::vector<double> copy_;
  const double* data_ = nullptr;
  std::size_t count_ = 0;
};

/// Triangulates the points of a range; see Triangulator::triangulate.
inline Triangulation triangulate(Triangulator& triangulator, const Points& points,
                                 const Options& options = {}) {
  return triangulator.triangulate(points.data(), points.size(), options);
}

}  // namespace flaunay
