// Interpolates values between the points of a triangulation.
#pragma once

#include <cstddef>
#include <vector>

#include "derived/locate/locator.hpp"

namespace flaunay::interpolate {

using host::Buffer;
using locate::Locator;

/// The values to interpolate: a row of `columns` numbers per input point.
struct Table {
  Buffer<cl_double> values;
  std::size_t columns;
  double outside;  ///< the result outside of the triangulation
};

/// The gradients of the columns at the points: given, as rows of x and y per column, or estimated.
struct Gradients {
  bool are_given = false;
  Buffer<cl_double> given{};
  double tolerance = 0;
  std::size_t iterations = 0;  ///< at most
};

// Queries are m points in the sets of the locator, and results m rows. derived/locate/locator.hpp says which
// checks are made, how often calls wait, and how much temporary memory they need.

/// Interpolates linearly between the corners of the triangle that the query lies in.
void linear(host::Runtime& runtime, const Locator& locator, const Table& table,
            const Buffer<cl_double>& queries, std::size_t m, const std::vector<std::size_t>& query_offsets,
            const Buffer<cl_double>& results);

/// Copies the values of the nearest point; see locate::nearest.
void nearest(host::Runtime& runtime, Locator& locator, const Table& table, const Buffer<cl_double>& queries,
             std::size_t m, const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results);

/// Interpolates by cubics with a continuous gradient.
void clough_tocher(host::Runtime& runtime, const Locator& locator, const Table& table,
                   const Gradients& gradients, const Buffer<cl_double>& queries, std::size_t m,
                   const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results);

/// Estimates the gradients of the columns, x and y per number of the table; table.outside at points that are
/// no vertices of triangles. Does not wait.
void estimate_gradients(host::Runtime& runtime, const Locator& locator, const Table& table,
                        const Gradients& wanted, const Buffer<cl_double>& results);

}  // namespace flaunay::interpolate
