// The points of a triangulation that changes, by their numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <unordered_map>
#include <vector>

#include "geometry/magnitudes.hpp"

namespace flaunay::updates {

/// The points that there are, without gaps.
struct Living {
  bool are_all = false;  ///< whether these are all numbers; the other members are empty then
  std::vector<double> coordinates;
  std::vector<std::int32_t> numbers;  ///< per point
  std::vector<std::int32_t> places;   ///< per number: the point, or -1
};

class Points {
 public:
  /// Begins a batch of changes: append() and what follows it, and set_representatives() at the end.
  void begin_batch();
  /// Undoes the batch. Until representatives are set again, it is not known which points share places.
  void roll_back() noexcept;
  /// Adds n points, which are checked already. They represent themselves until it is known whether others do.
  void append(const double* coordinates, std::size_t n);
  /// Whether a point represents itself and no other.
  bool is_alone(std::int32_t v) const { return representative(v) == v && others_.count(v) == 0; }
  /// Whether there are points in one place.
  bool share_places() const { return !others_.empty(); }
  /// Takes a point from its place. Returns the one that represents those that are left there, if that was
  /// this one; otherwise -1.
  std::int32_t leave(std::int32_t v);
  /// Takes a point away that has left its place.
  void remove(std::int32_t v);
  /// Puts a point that has left its place, or is alone there, to another one.
  void move(std::int32_t v, const double* coordinates);
  /// Makes a point, with those that it represents, represented by one in its place.
  void join(std::int32_t v, std::int32_t representative);

  /// Throws Error(input) if one of m further points, or of these ones in new places, is not finite, or if
  /// they differ too much in magnitude from all others. numbers: of the points, which must be marked; null
  /// for further ones.
  void check_coordinates(const double* coordinates, const std::int32_t* numbers, std::size_t m);
  /// Returns the first of m entries that is no living point or repeats an earlier one; m if all are valid.
  std::size_t mark(const std::int32_t* numbers, std::size_t m);
  /// Whether the last batch marked has this point.
  bool is_marked(std::int32_t v) const { return marks_[static_cast<std::size_t>(v)] == batch_; }

  Living living() const;
  /// representatives: per living point, which living point represents it. If it throws, nothing has changed.
  void set_representatives(const Living& living, const std::vector<std::int32_t>& representatives);

  std::size_t numbers() const { return representatives_.size(); }
  std::size_t count() const { return count_; }
  /// The number of points that represent themselves. O(numbers).
  std::size_t places() const noexcept;
  int shift() const { return geometry::scaling_for(magnitudes_).shift; }
  bool is_alive(std::int32_t v) const { return representatives_[static_cast<std::size_t>(v)] >= 0; }
  std::int32_t representative(std::int32_t v) const { return representatives_[static_cast<std::size_t>(v)]; }
  /// About n points that represent themselves, evenly from the first number to the last one.
  std::vector<std::int32_t> sample(std::size_t n) const;
  /// Per number; -1 if there is no such point any more.
  const std::vector<std::int32_t>& representatives() const { return representatives_; }
  const std::vector<double>& coordinates() const { return coordinates_; }

 private:
  // A point before a batch has changed it.
  struct Before {
    double x, y;
    std::int32_t number, representative;
  };
  void keep(std::int32_t v);

  std::vector<Before> before_;
  std::size_t numbers_before_ = 0, count_before_ = 0;
  std::vector<double> coordinates_;
  geometry::Magnitudes magnitudes_;  // of all points that there are, and maybe of others
  std::vector<std::int32_t> representatives_;
  std::unordered_map<std::int32_t, std::set<std::int32_t>> others_;  // that a point represents, if any
  std::vector<std::uint32_t> marks_;                                 // per number: the last batch that had it
  std::uint32_t batch_ = 0;
  std::size_t count_ = 0;
};

}  // namespace flaunay::updates
