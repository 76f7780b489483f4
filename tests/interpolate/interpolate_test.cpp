// Interpolation by every method, several columns at once, against sequential twins.
//
// Suites named Small... have tiny inputs, for slow simulators: tests/oclgrind.sh.
#include "interpolate/interpolate.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/locate/support.hpp"

namespace flaunay::locate {
namespace {

using interpolate::Table;

const double kOutside = -7.25;

/// A locator on a runtime, with what it needs.
struct Located {
  Located(const std::string& tuning, const Case& given)
      : runtime(Runtimes::get(tuning)), own(runtime.memory()), input(given) {
    if (runtime.sizes().separate_buffers) own.separate_buffers();
    const host::Arena::Scope scope(runtime.arena());
    locator = make_locator(runtime, own, upload_mesh(runtime, input));
  }

  /// method(runtime, locator, table, queries...) is one of interpolate/interpolate.hpp.
  template <typename Method>
  std::vector<double> values_by(const Method& method, const std::vector<double>& values,
                                std::size_t columns) {
    const host::Arena::Scope scope(runtime.arena());
    const std::size_t m = input.query_count();
    const auto results = guarded<cl_double>(runtime, m * columns);
    method(runtime, locator, Table{upload(runtime, values), columns, kOutside},
           upload(runtime, input.queries), m, input.query_offsets, results);
    return download(runtime, results, m * columns);
  }

  std::vector<cl_int> located(void (*answer)(Runtime&, Locator&, const host::Buffer<cl_double>&, std::size_t,
                                             const Offsets&, const host::Buffer<cl_int>&)) {
    const host::Arena::Scope scope(runtime.arena());
    const std::size_t m = input.query_count();
    const auto found = guarded<cl_int>(runtime, m);
    answer(runtime, locator, upload(runtime, input.queries), m, input.query_offsets, found);
    return download(runtime, found, m);
  }
  /// Per query; that these are right is the subject of locate_test.cpp.
  std::vector<cl_int> triangles() {
    return located([](auto& r, auto& l, const auto& q, std::size_t m, const auto& o, const auto& found) {
      locate::locate(r, l, q, m, o, found);
    });
  }
  std::vector<cl_int> nearest() { return located(locate::nearest); }

  Runtime& runtime;
  host::Arena own;
  const Case& input;
  Locator locator;
};

/// Of the locator's arena: one set and more, all fixtures, nothing at all.
std::vector<Case> cases(std::size_t n, std::size_t m) {
  std::vector<Case> all{nested_case(n, m), case_of_trees(3 * n, m)};
  Case nothing;
  nothing.triangulate();
  all.push_back(nothing);
  nothing.add({}, {0, 0, 1, 2});
  nothing.triangulate();
  all.push_back(nothing);
  return all;
}

std::string bytes_of(const std::vector<double>& numbers) {
  return std::string(reinterpret_cast<const char*>(numbers.data()), sizeof(double) * numbers.size());
}

/// The same bytes with every tuning, and of every column as if it were alone. Returns the results.
template <typename Method>
std::vector<double> consistent(const Case& input, const Method& method, const std::vector<double>& values,
                               std::size_t columns) {
  std::vector<double> first;
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE("tuning " + tuning);
    Located located(tuning, input);
    const std::vector<double> results = located.values_by(method, values, columns);
    if (tuning == tunings()[0]) {
      first = results;
      for (std::size_t c = 0; c < columns && columns > 1; ++c) {
        std::vector<double> column, expected;
        for (std::size_t i = c; i < values.size(); i += columns) column.push_back(values[i]);
        for (std::size_t i = c; i < results.size(); i += columns) expected.push_back(results[i]);
        EXPECT_EQ(bytes_of(located.values_by(method, column, 1)), bytes_of(expected)) << "column " << c;
      }
    }
    EXPECT_EQ(bytes_of(results), bytes_of(first));
  }
  return first;
}

using Weights = std::vector<mpq_class>;

Weights weights_at(const Case& input, std::size_t t, const double* q) {
  Weights weights;
  mpq_class whole = 0;
  for (int k = 0; k < 3; ++k) {
    weights.push_back(
        area(input.point(input.corner(t, (k + 1) % 3)), input.point(input.corner(t, (k + 2) % 3)), q));
    whole += weights.back();
  }
  for (mpq_class& weight : weights) weight /= whole;
  return weights;
}

void check_linear(const Case& input, std::size_t columns) {
  const std::vector<double> values = values_for(input.size() * columns);
  const std::vector<double> results = consistent(input, interpolate::linear, values, columns);
  const std::vector<cl_int> triangles = Located("own", input).triangles();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto t = static_cast<std::size_t>(triangles[i]);
    const Weights weights = triangles[i] < 0 ? Weights{} : weights_at(input, t, input.query(i));
    for (std::size_t c = 0; c < columns; ++c) {
      if (triangles[i] < 0) {
        ASSERT_EQ(results[i * columns + c], kOutside);
        continue;
      }
      mpq_class sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(input.corner(t, static_cast<int>(k)));
        sum += weights[k] * mpq_class(values[corner * columns + c]);
      }
      ASSERT_NEAR(results[i * columns + c], sum.get_d(), 0x1p-38) << i << ", " << c;
    }
  }
}

void check_nearest(const Case& input, std::size_t columns) {
  const std::vector<double> values = values_for(input.size() * columns);
  const std::vector<double> results = consistent(input, interpolate::nearest, values, columns);
  const std::vector<cl_int> points = Located("own", input).nearest();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t c = 0; c < columns; ++c) {
      const double expected =
          points[i] < 0 ? kOutside : values[static_cast<std::size_t>(points[i]) * columns + c];
      ASSERT_EQ(results[i * columns + c], expected) << i << ", " << c;
    }
  }
}

TEST(SmallInterpolation, LinearAndNearest) {
  for (const Case& input : cases(12, 2)) {
    for (const std::size_t columns : {1u, 3u}) {
      check_linear(input, columns);
      check_nearest(input, columns);
    }
  }
}

TEST(Interpolation, LinearAndNearest) {
  for (const Case& input : cases(150, 20)) {
    for (const std::size_t columns : {1u, 3u, 7u}) {
      check_linear(input, columns);
      check_nearest(input, columns);
    }
  }
}

TEST(Interpolation, LinearInEveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    check_linear(make_case(fixture.make(330, 11), 12, 13), 2);
  }
}

TEST(InterpolationKernels, AllAreLaunched) {
  std::set<std::string> launched;
  const Case input = nested_case(30, 3);
  Located located("own", input);
  located.runtime.set_profiling(true);
  const std::vector<double> values = values_for(input.size());
  located.values_by(interpolate::linear, values, 1);
  located.values_by(interpolate::nearest, values, 1);
  for (const auto& [name, time] : located.runtime.kernel_times()) launched.insert(name);
  located.runtime.set_profiling(false);
  std::size_t kernels = 0;
  for (const char* const file : {"interpolate/linear"}) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      EXPECT_EQ(launched.count((*it)[1]), 1u) << (*it)[1] << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_EQ(kernels, 2u);
}

}  // namespace
}  // namespace flaunay::locate
