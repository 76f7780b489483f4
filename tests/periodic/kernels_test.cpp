// Kernels for a torus and a cylinder against plain loops.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "launchers/periodic/fold.cl.hpp"
#include "periodic/torus.h"
#include "space/periodic/fold.hpp"
#include "tests/locate/support.hpp"

namespace flaunay::locate {
namespace {

// The place of x, by the C library's remainder.
double place_of_twin(double x, double period, double whole) {
  if (!std::isfinite(period)) return x + 0.0;
  const double unit = whole * 0x1p-52;
  const double rest = std::remainder(x, period), near = rest < period / 2 ? rest : rest - period;
  const double place = std::nearbyint(near / unit) * unit;
  return place < 0 ? place + period : place + 0.0;
}

mpq_class floor_of(const mpq_class& x) {
  mpz_class result;
  mpz_fdiv_q(result.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
  return result;
}

// Numbers of all magnitudes, and what lies close to multiples of half a period.
Coordinates numbers(double period, std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates all = {0.0, -0.0, 5e-324, -5e-324, 1e308, -1e308};
  while (all.size() < n) {
    const double x = random.unit() - 0.5;
    all.push_back(4 * period * x);
    all.push_back(std::ldexp(x, static_cast<int>(random.integer(-1000, 1000))));
    const double half = static_cast<double>(random.integer(-9, 9)) * (std::isfinite(period) ? period : 1) / 2;
    all.insert(all.end(), {half, std::nextafter(half, 1e300), std::nextafter(half, -1e300)});
  }
  all.resize(n);
  for (double& x : all) x = std::isfinite(x) ? x : 0;
  return all;
}

TEST(SmallPeriodicKernels, Places) {
  for (const std::string& tuning : tunings()) {
    Runtime& runtime = Runtimes::get(tuning);
    for (const Period& given : {Period{},
                                {0.7, 1e-3},
                                {3e8, HUGE_VAL},
                                {0x1p-900, 0x1.8p-890},
                                {1e200, 3e200},
                                {1, 1, 0.5},
                                {0.7, 0.9, -0.3},
                                {3, 0.125, 7e100},
                                {1e-200, 1e-195, 1e-201}}) {
      host::Arena::Scope scope(runtime.arena());
      const periodic::Lattice lattice = periodic::lattice_of(given);
      const Period period = periodic::period_of(lattice);
      Coordinates points;
      const Coordinates x = numbers(period.x, 120, 3), y = numbers(period.y, 120, 4);
      for (std::size_t i = 0; i < x.size(); ++i) points.insert(points.end(), {x[i], y[i]});
      const auto places = guarded<cl_double>(runtime, points.size());
      periodic::find_places(runtime, upload(runtime, points), x.size(), lattice, places);
      Coordinates expected;
      for (std::size_t c = 0; c < points.size(); c += 2) {
        expected.push_back(place_of_twin(points[c], period.x, lattice.whole[0]));
        expected.push_back(place_of_twin(points[c + 1], period.y, lattice.whole[1]));
        if (period.shear == 0) continue;
        // Both are rounded, so this is the nearest number of periods.
        const mpq_class periods = mpq_class(points[c + 1] - mpq_class(expected[c + 1])) / period.y;
        const mpq_class along = expected[c] - floor_of(periods + mpq_class(1, 2)) * mpq_class(period.shear);
        expected[c] = mpq_class(along - floor_of(along / period.x) * mpq_class(period.x)).get_d();
      }
      const Coordinates found = download(runtime, places, points.size());
      EXPECT_TRUE(same(found, expected)) << given.x;
      EXPECT_TRUE(
          std::none_of(found.begin(), found.end(), [](double p) { return std::signbit(p) && p == 0; }));
      // The first one that is not finite.
      points[2 * 77] = -std::numeric_limits<double>::infinity();
      points[2 * 78] = std::nan("");
      try {
        periodic::find_places(runtime, upload(runtime, points), x.size(), lattice, places);
        ADD_FAILURE() << "no error";
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("point 77 is not finite: (-inf, "), 0u) << error.what();
      }
    }
  }
}

TEST(SmallPeriodicKernels, ImagesHaveTheOrderOfPointAndPeriods) {
  std::vector<std::uint64_t> all;
  for (const std::int64_t point : {std::int64_t{0}, std::int64_t{1}, (std::int64_t{1} << 44) - 1}) {
    for (int across = -512; across <= 511; across += 341) {
      for (int up = -512; up <= 511; up += 250) {
        all.push_back(kernel::image_of(point, across, up));
        EXPECT_EQ(kernel::point_of(all.back()), point);
        EXPECT_EQ(kernel::vectors_across(all.back()), across);
        EXPECT_EQ(kernel::vectors_up(all.back()), up);
        EXPECT_EQ(kernel::is_in_place(all.back()), 0);
      }
    }
  }
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_TRUE(kernel::is_in_place(kernel::image_of(5, 0, 0)));
}

// Sets with gaps between them that belong to none, some on a lattice.
struct Sets {
  Coordinates places;
  Offsets first, last, all{0};

  Sets(const Period& period, const std::vector<std::size_t>& sizes) {
    FixtureRandom random(sizes.size());
    for (const std::size_t n : sizes) {
      const bool is_lattice = first.size() % 2 == 1;
      if (first.size() == 1) places.insert(places.end(), {7, 7});
      first.push_back(places.size() / 2);
      for (std::size_t c = 0; c < 2 * n; ++c) {
        const double x = is_lattice ? std::floor(4 * random.unit()) / 4 : random.unit();
        const double length = c % 2 == 0 ? period.x : period.y;
        places.push_back(x * (std::isfinite(length) ? length : 1));
      }
      last.push_back(places.size() / 2);
      all.push_back(all.back() + n);
    }
  }
  Coordinates of(std::size_t k) const {
    return {places.begin() + static_cast<std::ptrdiff_t>(2 * first[k]),
            places.begin() + static_cast<std::ptrdiff_t>(2 * last[k])};
  }
};

TEST(SmallPeriodicKernels, BoxesOfSets) {
  for (const std::string& tuning : tunings()) {
    Runtime& runtime = Runtimes::get(tuning);
    const Coordinates places = make_fixture("uniform", 50, 2);
    const Offsets offsets{0, 0, 1, 20, 50, 50};
    for (const Period& period : {Period{2, HUGE_VAL}, {HUGE_VAL, 2}, {2, 2}, {2, 2, 0.5}}) {
      host::Arena::Scope scope(runtime.arena());
      const periodic::Lattice lattice = periodic::lattice_of(period);
      const std::vector<periodic::Box> found =
          periodic::find_boxes(runtime, upload(runtime, places), offsets, lattice);
      for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
        const periodic::Box expected = periodic::box_of(places.data(), offsets[s], offsets[s + 1], lattice);
        for (int axis = 0; axis < 2; ++axis) {
          EXPECT_EQ(found[s].lattice.period[axis], lattice.period[axis]);
          EXPECT_EQ(found[s].low[axis], expected.low[axis]) << s;
          EXPECT_EQ(found[s].high[axis], expected.high[axis]) << s;
        }
      }
    }
  }
}

// One set by plain loops: its points with their images, and triangles of these.
struct Twin {
  Twin(const Coordinates& places, const periodic::Box& box)
      : plane{{box}, {}, places, places.size() / 2, {}} {
    for (std::size_t i = 0; i < places.size() / 2; ++i) {
      periodic::for_each_image(box, static_cast<std::int64_t>(i), {places[2 * i], places[2 * i + 1]},
                               [&](std::uint64_t image, Point p) {
                                 plane.coordinates.insert(plane.coordinates.end(), {p.x, p.y});
                                 plane.images.push_back(image);
                               });
    }
  }

  // Folds the triangles of the plane. Returns whether the margin was large enough.
  bool fold(const std::vector<std::int32_t>& representatives) {
    const std::vector<std::int32_t> planar = std::exchange(corners, {}),
                                    beyond = std::exchange(neighbors, {});
    const auto image = [&](std::size_t c) { return plane.image(planar[c]); };
    std::vector<std::int32_t> rows;
    std::int32_t kept = 0;
    for (std::size_t c = 0; c < planar.size(); c += 3)
      rows.push_back(kernel::is_kept(image(c), image(c + 1), image(c + 2)) != 0 ? kept++ : -1);
    std::vector<std::int32_t> linked = beyond;
    periodic::Seams seams(plane.boxes[0]);
    for (std::size_t c = 0; c < planar.size(); ++c) {
      const auto other = static_cast<std::size_t>(std::max(beyond[c], 0));
      if (rows[c / 3] < 0 || (beyond[c] >= 0 && rows[other] >= 0)) continue;
      std::uint64_t outside = NO_IMAGE;
      for (std::size_t k = 3 * other; k < 3 * other + 3 && beyond[c] >= 0; ++k) {
        if (beyond[k] == static_cast<std::int32_t>(c / 3)) outside = image(k);
      }
      const std::size_t from = c / 3 * 3 + (c + 1) % 3, to = c / 3 * 3 + (c + 2) % 3;
      const Point a = plane.place(planar[from]), b = plane.place(planar[to]);
      seams.add(
          {{a.x, a.y, b.x, b.y}, image(from), image(to), image(c), outside, static_cast<std::int64_t>(c)});
    }
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < representatives.size(); ++i)
      different += representatives[i] == static_cast<std::int32_t>(i);
    const auto count = static_cast<std::uint64_t>(kept);
    if (count != seams.expected(different) || !seams.match(count)) return false;
    seams.for_each_link([&](std::int64_t at, std::int64_t t) {
      linked[static_cast<std::size_t>(at)] = static_cast<std::int32_t>(t);
    });
    for (std::size_t c = 0; c < planar.size(); ++c) {
      if (rows[c / 3] < 0) continue;
      corners.push_back(static_cast<std::int32_t>(kernel::point_of(image(c))));
      neighbors.push_back(linked[c] < 0 ? -1 : rows[static_cast<std::size_t>(linked[c])]);
      offsets.insert(offsets.end(), {kernel::vectors_across(image(c)), kernel::vectors_up(image(c))});
    }
    return true;
  }

  periodic::Plane plane;
  std::vector<std::int32_t> corners, neighbors, offsets;
};

// What the kernels make of all sets, as plain loops make it of each: images, and then triangles, or that the
// margin was too small.
void expect_sets_of_the_twin(Runtime& runtime, const Period& period, const Sets& sets, double margin) {
  host::Arena::Scope scope(runtime.arena());
  host::Arena arena(runtime.memory());
  std::vector<periodic::Box> boxes;
  std::vector<Twin> twins;
  Coordinates coordinates;
  for (std::size_t k = 0; k < sets.first.size(); ++k) {
    boxes.push_back(
        periodic::box_of(sets.places.data(), sets.first[k], sets.last[k], periodic::lattice_of(period)));
    boxes[k].margin = k % 2 == 0 ? margin : margin / 2;
    twins.emplace_back(sets.of(k), boxes[k]);
    const Coordinates& of_set = twins[k].plane.coordinates;
    coordinates.insert(coordinates.end(), of_set.begin(), of_set.end());
  }
  const auto places = upload(runtime, sets.places);
  const periodic::UnrolledSets plane(runtime, arena, places, sets.first, sets.last, boxes);
  EXPECT_TRUE(same(points::download(runtime, plane.coordinates(), 2 * plane.offsets().back()), coordinates));

  const Triangulation planar = testing::triangulator().triangulate(coordinates.data(), plane.offsets());
  points::DeviceMesh mesh;
  mesh.point_offsets = plane.offsets();
  mesh.triangle_offsets = planar.triangle_offsets;
  mesh.triangles = upload(runtime, planar.triangles);
  mesh.neighbors = upload(runtime, planar.neighbors);
  mesh.representatives = upload(runtime, planar.representatives);
  const std::size_t points = sets.places.size() / 2;
  const auto representatives = guarded<cl_int>(runtime, points);
  const periodic::FoldedSets folded(runtime, arena, plane, mesh, representatives, nullptr);
  const std::vector<cl_int> same_points = download(runtime, representatives, points);

  Offsets first_rows;
  std::size_t rows = 0;
  for (std::size_t k = 0; k < twins.size(); ++k) {
    first_rows.push_back(rows);
    rows += folded.expected(k) + 1;  // with a row between that nobody writes
  }
  const auto triangles = guarded<cl_int>(runtime, 3 * rows), neighbors = guarded<cl_int>(runtime, 3 * rows);
  const auto offsets = guarded<cl_char>(runtime, 6 * rows);
  folded.write(first_rows, triangles, offsets, neighbors);
  const std::vector<cl_int> found = download(runtime, triangles, 3 * rows),
                            beyond = download(runtime, neighbors, 3 * rows);
  const std::vector<cl_char> periods = download(runtime, offsets, 6 * rows);
  for (std::size_t k = 0; k < twins.size(); ++k) {
    Twin& expected = twins[k];
    EXPECT_EQ(plane.images(k), expected.plane.images.size());
    const auto part = [](const auto& all, std::size_t from, std::size_t to, std::size_t less) {
      std::vector<std::int32_t> some(all.begin() + static_cast<std::ptrdiff_t>(from),
                                     all.begin() + static_cast<std::ptrdiff_t>(to));
      for (std::int32_t& i : some) i -= i < 0 ? 0 : static_cast<std::int32_t>(less);
      return some;
    };
    const std::size_t t = planar.triangle_offsets[k], end = planar.triangle_offsets[k + 1];
    expected.corners = part(planar.triangles, 3 * t, 3 * end, plane.offsets()[k]);
    expected.neighbors = part(planar.neighbors, 3 * t, 3 * end, t);
    const std::size_t at = plane.offsets()[k];
    const auto same_of = part(planar.representatives, at, at + expected.plane.own, at);
    EXPECT_TRUE(same(part(same_points, sets.first[k], sets.last[k], sets.first[k]), same_of));
    const bool is_done = expected.fold(same_of);
    ASSERT_EQ(folded.is_done(k), is_done) << k << " " << margin;
    const std::size_t row = first_rows[k], last = row + folded.expected(k);
    EXPECT_EQ(beyond[3 * last], static_cast<cl_int>(0xa5a5a5a5u));
    if (!is_done) {
      EXPECT_EQ(beyond[3 * row], static_cast<cl_int>(0xa5a5a5a5u));
      continue;
    }
    EXPECT_TRUE(same(part(found, 3 * row, 3 * last, sets.first[k]), expected.corners)) << k;
    EXPECT_TRUE(same(part(beyond, 3 * row, 3 * last, row), expected.neighbors)) << k;
    EXPECT_TRUE(same(std::vector<std::int32_t>(periods.begin() + static_cast<std::ptrdiff_t>(6 * row),
                                               periods.begin() + static_cast<std::ptrdiff_t>(6 * last)),
                     expected.offsets));
  }
}

TEST(SmallPeriodicKernels, SetsAreThoseOfTheTwin) {
  for (const std::string& tuning : tunings()) {
    for (const Period& period :
         {Period{1, 1}, {2, 0.75}, {1, HUGE_VAL}, {HUGE_VAL, 1}, {1, 1, 0.375}, {2, 0.75, 0.625}}) {
      for (const double margin : {0.0, 0.5, 2.0}) {
        expect_sets_of_the_twin(Runtimes::get(tuning), period, {period, {1, 2, 3, 12, 9}}, margin);
        expect_sets_of_the_twin(Runtimes::get(tuning), period, {period, {20}}, margin);
      }
    }
  }
}

TEST(PeriodicKernels, LargerSetsAreThoseOfTheTwin) {
  for (const std::string& tuning : tunings()) {
    for (const double margin : {0.02, 0.06, 0.2}) {
      expect_sets_of_the_twin(Runtimes::get(tuning), {1, 1}, {{1, 1}, {3000, 500, 1, 4000}}, margin);
      expect_sets_of_the_twin(Runtimes::get(tuning), {1, HUGE_VAL}, {{1, HUGE_VAL}, {8000}}, margin);
      expect_sets_of_the_twin(Runtimes::get(tuning), {1, 1, 0.25}, {{1, 1}, {2000, 300, 1}}, margin);
    }
  }
}

}  // namespace
}  // namespace flaunay::locate
