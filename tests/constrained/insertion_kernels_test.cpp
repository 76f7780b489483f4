// Kernels of the insertion of segments, each beside a plain sequential twin.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "constrained/codes.h"
#include "constrained/insertion/insert.hpp"
#include "constrained/records.h"
#include "launchers/constrained/insert.cl.hpp"
#include "launchers/constrained/order.cl.hpp"
#include "launchers/constrained/segments.cl.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/device.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/same.hpp"
#include "tests/support/scaled_points.hpp"

namespace flaunay::testing {
namespace {

using host::Arena;
using host::Runtime;

// Those of device_test.cpp, which ends them.
struct Runtimes {
  static Runtime& get(const std::string& kind) {
    return SharedRuntimes<make_tuned_engine>::get(kind).runtime;
  }
};

using Ints = std::vector<cl_int>;
using Uints = std::vector<cl_uint>;
using Ulongs = std::vector<cl_ulong>;

std::vector<std::string> kinds() {
  if (std::getenv("FLAUNAY_TUNING") != nullptr) return {"own"};
  std::vector<std::string> all = {"own", "small", "gpu"};
  for (const std::string& tuning : fixed_point_tunings()) all.push_back(tuning);
  return all;
}

constexpr cl_ulong kNoKey = ~cl_ulong{0};

TEST(SmallInsertionKernels, UniqueKeys) {
  FixtureRandom random(1);
  for (const std::string& kind : kinds()) {
    Runtime& runtime = Runtimes::get(kind);
    for (const std::size_t n : {1, 2, 7, 300}) {
      for (const int different : {1, 3, 1000}) {
        SCOPED_TRACE(kind + ", n = " + std::to_string(n) + ", keys " + std::to_string(different));
        Arena::Scope scope(runtime.arena());
        Ulongs keys;
        for (std::size_t i = 0; i < n; ++i) {
          const auto key = static_cast<cl_ulong>(random.integer(0, different));
          keys.push_back(key == 0 ? kNoKey : key << 40);
        }
        std::sort(keys.begin(), keys.end());
        Ints payloads(n), expected_of(n);
        std::iota(payloads.begin(), payloads.end(), 0);
        random.shuffle(payloads);
        Ulongs expected;
        Uints counts, ranks(1, 0);
        for (std::size_t i = 0; i < n; ++i) {
          const bool is_first = keys[i] != kNoKey && (i == 0 || keys[i] != keys[i - 1]);
          if (is_first) expected.push_back(keys[i]);
          counts.push_back(is_first);
          ranks.push_back(static_cast<cl_uint>(expected.size()));
          expected_of[payloads[i]] = keys[i] == kNoKey ? -1 : static_cast<cl_int>(expected.size()) - 1;
        }
        const auto device_keys = upload(runtime, keys);
        const auto found_counts = guarded<cl_uint>(runtime, n);
        runtime.map(n, kernels::find_runs{.keys = device_keys, .counts = found_counts});
        EXPECT_TRUE(same(download(runtime, found_counts, n), counts));
        const auto of = guarded<cl_int>(runtime, n);
        const auto unique = guarded<cl_ulong>(runtime, expected.size());
        runtime.map(n, kernels::write_unique{.keys = device_keys,
                                             .payloads = upload(runtime, payloads),
                                             .ranks = upload(runtime, ranks),
                                             .unique_of = of,
                                             .unique = unique});
        EXPECT_TRUE(same(download(runtime, of, n), expected_of));
        EXPECT_TRUE(same(download(runtime, unique, expected.size()), expected));
      }
    }
  }
}

// Chains of random lengths, whose edges have random numbers.
TEST(SmallInsertionKernels, NumbersAlongChains) {
  FixtureRandom random(2);
  for (const std::string& kind : kinds()) {
    Runtime& runtime = Runtimes::get(kind);
    for (const std::size_t n : {1, 2, 30, 300}) {
      for (const int longest : {1, 4, 1000}) {
        SCOPED_TRACE(kind + ", n = " + std::to_string(n) + ", chains of " + std::to_string(longest));
        Arena::Scope scope(runtime.arena());
        Ints order(n), next(n, -1), previous(n, -1), heads(n), distances(n);
        std::iota(order.begin(), order.end(), 0);
        random.shuffle(order);
        Uints lengths(n, 0);
        // A segment along each chain.
        Uints offsets(1, 0);
        for (std::size_t i = 0; i < n;) {
          const std::size_t end = std::min(n, i + static_cast<std::size_t>(random.integer(1, longest)));
          for (std::size_t k = i; k < end; ++k) {
            if (k > i) previous[order[k]] = order[k - 1];
            if (k + 1 < end) next[order[k]] = order[k + 1];
            heads[order[k]] = order[i];
            distances[order[k]] = static_cast<cl_int>(k - i);
          }
          lengths[order[i]] = static_cast<cl_uint>(end - i);
          i = end;
          offsets.push_back(static_cast<cl_uint>(end));
        }
        const std::size_t segments = offsets.size() - 1;
        const auto found_next = upload(runtime, Ints(n, -1)), found_previous = upload(runtime, Ints(n, -1));
        runtime.map(segments, kernels::link_pieces{.offsets = upload(runtime, offsets),
                                                   .piece_of = upload(runtime, order),
                                                   .next = found_next,
                                                   .previous = found_previous});
        EXPECT_TRUE(same(download(runtime, found_next, n), next));
        EXPECT_TRUE(same(download(runtime, found_previous, n), previous));
        auto a = guarded<cl_int>(runtime, n), b = guarded<cl_int>(runtime, n);
        auto c = guarded<cl_int>(runtime, n), d = guarded<cl_int>(runtime, n);
        runtime.map(n, kernels::start_chains{.previous = found_previous, .heads = a, .distances = b});
        for (std::size_t reach = 1; reach < n; reach *= 2) {
          runtime.map(n, kernels::jump{.heads = a, .distances = b, .next_heads = c, .next_distances = d});
          std::swap(a, c);
          std::swap(b, d);
        }
        EXPECT_TRUE(same(download(runtime, a, n), heads));
        EXPECT_TRUE(same(download(runtime, b, n), distances));
        const auto found_lengths = upload(runtime, Uints(n, 0));
        runtime.map(n, kernels::measure_chains{
                           .next = found_next, .heads = a, .distances = b, .lengths = found_lengths});
        EXPECT_TRUE(same(download(runtime, found_lengths, n), lengths));
      }
    }
  }
}

/// The triangles whose inside a segment crosses.
std::set<cl_int> crossed_rows(Plane& plane, const Triangulation& mesh, const Edge& segment) {
  std::set<cl_int> rows;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    if (plane.cross(segment.first, segment.second, mesh.triangles[c], mesh.triangles[t + (c + 1) % 3])) {
      rows.insert(static_cast<cl_int>(c / 3));
    }
  }
  return rows;
}

// One segment at a time, between any two vertices.
TEST(SmallInsertionKernels, WalksOfSegments) {
  for (const std::string& kind : kinds()) {
    Runtime& runtime = Runtimes::get(kind);
    for (int round = 0; round < 6; ++round) {
      const Coordinates points = random_integer_points(12, 2 + 2 * round, static_cast<std::uint64_t>(round));
      const std::vector<std::size_t> offsets = {0, points.size() / 2};
      const Triangulation mesh = delaunay_of(points, offsets);
      const std::size_t rows = mesh.triangles.size() / 3;
      Plane plane(points);
      std::map<std::int32_t, cl_uint> places;
      for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
        places.emplace(mesh.triangles[c], static_cast<cl_uint>(c));
      }
      for (const auto& [v, at_v] : places) {
        for (const auto& [w, at_w] : places) {
          if (at_v >= at_w) continue;
          SCOPED_TRACE(kind + ", round " + std::to_string(round) + ": " + std::to_string(v) + "-" +
                       std::to_string(w));
          Arena::Scope scope(runtime.arena());
          const auto edges = expected_edges(points, offsets, mesh, {v, w})[0];
          std::set<cl_int> crossed;
          for (const Edge& edge : edges) crossed.merge(crossed_rows(plane, mesh, edge));
          const ScaledPoints scaled = upload_points(runtime, points);
          const auto claims = upload(runtime, Uints(rows, UNCLAIMED));
          const auto flags = upload(runtime, Uints(rows / 4 + 1, 0));
          const auto walks = guarded<kernel::constraint_walk>(runtime, 1);
          const auto ends = guarded<cl_int>(runtime, 2);
          const auto pieces = guarded<cl_uint>(runtime, 1);
          const auto sizes = guarded<cl_uint2>(runtime, 1);
          const auto status = upload(runtime, Uints(kernel::INSERTION_NUMBERS, 0));
          runtime.map_in_small_groups(
              1, kernels::walk_segments{.most_pieces = 1000,
                                        .most_rows = 1000,
                                        .bound = scaled.bounds.orient,
                                        .points = scaled.coordinates,
                                        .triangulation = {.triangles = upload(runtime, mesh.triangles),
                                                          .neighbors = upload(runtime, mesh.neighbors)},
                                        .hull = upload(runtime, mesh.hull),
                                        .keys = upload(runtime, Ulongs{cl_ulong{at_v} << 32 | at_w}),
                                        .claims = claims,
                                        .flags = flags,
                                        .walks = walks,
                                        .ends = ends,
                                        .pieces = pieces,
                                        .sizes = sizes,
                                        .status = status});
          EXPECT_EQ(download(runtime, pieces, 1)[0], edges.size());
          const Uints claimed = download(runtime, claims, rows);
          for (std::size_t t = 0; t < rows; ++t) {
            EXPECT_EQ(claimed[t] != UNCLAIMED, crossed.count(static_cast<cl_int>(t)) == 1) << "row " << t;
          }
          const Uints words = download(runtime, flags, rows / 4 + 1);
          std::size_t flagged = 0, beside = 0;
          for (const Edge& edge : edges) {
            for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
              const std::size_t t = c - c % 3;
              const Edge opposite =
                  unordered(mesh.triangles[t + (c + 1) % 3], mesh.triangles[t + (c + 2) % 3]);
              if (opposite != unordered(edge.first, edge.second)) continue;
              ++beside;
              flagged += words[c / 12] >> (8 * (c / 3 % 4) + c % 3) & 1;
            }
          }
          EXPECT_EQ(flagged, beside);
          if (edges.size() == 1) {
            EXPECT_EQ(download(runtime, ends, 2), (Ints{edges[0].first, edges[0].second}));
            const auto walk = download(runtime, walks, 1)[0];
            EXPECT_EQ(walk.rows, static_cast<int>(crossed.size()));
            const cl_uint entries = crossed.empty() ? 0 : static_cast<cl_uint>(crossed.size()) + 4;
            EXPECT_EQ(download(runtime, sizes, 1)[0].s[0], entries);
            EXPECT_EQ(download(runtime, sizes, 1)[0].s[1], crossed.empty() ? 0u : 1u);
          }
          ASSERT_FALSE(HasFailure());
        }
      }
    }
  }
}

// The rows of a triangulation, of which some are taken out and put back in the order of their contents.
TEST(SmallInsertionKernels, OrderOfRows) {
  FixtureRandom random(4);
  for (const std::string& kind : kinds()) {
    Runtime& runtime = Runtimes::get(kind);
    for (const std::size_t n : {3, 4, 20, 200}) {
      for (const int one_in : {1, 2, 10}) {
        SCOPED_TRACE(kind + ", n = " + std::to_string(n) + ", one in " + std::to_string(one_in));
        Arena::Scope scope(runtime.arena());
        const Coordinates points = make_fixture("uniform", n, 1);
        const Triangulation mesh = delaunay_of(points, {0, n});
        const std::size_t rows = mesh.triangles.size() / 3;
        std::vector<cl_uchar> changed(rows, 0), flags(rows);
        Ints places;
        // Rows that changed begin at any corner.
        Ints triangles = mesh.triangles, neighbors = mesh.neighbors;
        for (std::size_t t = 0; t < rows; ++t) {
          flags[t] = static_cast<cl_uchar>(random.integer(0, 7));
          if (random.integer(1, one_in) > 1) continue;
          changed[t] = 1;
          places.push_back(static_cast<cl_int>(t));
          const auto turn = random.integer(0, 2);
          for (Ints* values : {&triangles, &neighbors}) {
            std::rotate(values->begin() + 3 * t, values->begin() + 3 * t + turn, values->begin() + 3 * t + 3);
          }
        }
        Ints sorted = places;
        std::sort(sorted.begin(), sorted.end(), [&mesh](cl_int a, cl_int b) {
          return std::pair(mesh.triangles[3 * a], mesh.triangles[3 * a + 1]) <
                 std::pair(mesh.triangles[3 * b], mesh.triangles[3 * b + 1]);
        });
        Ints to(rows);
        std::iota(to.begin(), to.end(), 0);
        for (std::size_t i = 0; i < places.size(); ++i) to[sorted[i]] = places[i];
        Ints expected_triangles(3 * rows), expected_neighbors(3 * rows);
        std::vector<cl_uchar> expected_flags(rows);
        for (std::size_t t = 0; t < rows; ++t) {
          for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t at = 3 * t + k;
            const cl_int v = mesh.triangles[at], beyond = mesh.neighbors[at];
            const auto was =
                std::find(triangles.begin() + 3 * t, triangles.begin() + 3 * t + 3, v) - triangles.begin();
            expected_triangles[3 * to[t] + k] = v;
            expected_neighbors[3 * to[t] + k] = beyond < 0 ? -1 : to[beyond];
            if (flags[t] >> (was - 3 * t) & 1) expected_flags[to[t]] |= static_cast<cl_uchar>(1 << k);
          }
        }
        const std::size_t count = places.size();
        const auto device_triangles = upload(runtime, triangles),
                   device_neighbors = upload(runtime, neighbors);
        const auto device_flags = upload(runtime, flags);
        const auto device_places = upload(runtime, places);
        const auto keys = guarded<cl_ulong>(runtime, count);
        const auto payloads = guarded<cl_int>(runtime, count);
        runtime.map(
            count,
            kernels::row_keys{
                .rows = device_places, .triangles = device_triangles, .keys = keys, .payloads = payloads});
        const Ulongs found_keys = download(runtime, keys, count);
        for (std::size_t i = 0; i < count; ++i) {
          const cl_int* const row = &mesh.triangles[3 * places[i]];
          EXPECT_EQ(found_keys[i], static_cast<cl_ulong>(row[0]) << 32 | static_cast<cl_ulong>(row[1]));
        }
        EXPECT_TRUE(same(download(runtime, payloads, count), places));
        const auto copied_triangles = guarded<cl_int>(runtime, 3 * count);
        const auto copied_neighbors = guarded<cl_uint>(runtime, 3 * count);
        const auto copied_flags = guarded<cl_uchar>(runtime, count);
        const auto row_places = guarded<cl_uint>(runtime, rows);
        runtime.map(count, kernels::take_rows{.rows = device_places,
                                              .sorted = upload(runtime, sorted),
                                              .triangles = device_triangles,
                                              .neighbors = device_neighbors,
                                              .flags = device_flags,
                                              .changed = upload(runtime, changed),
                                              .copied_triangles = copied_triangles,
                                              .copied_neighbors = copied_neighbors,
                                              .copied_flags = copied_flags,
                                              .places = row_places});
        runtime.map(count, kernels::put_rows{.rows = device_places,
                                             .copied_triangles = copied_triangles,
                                             .copied_neighbors = copied_neighbors,
                                             .copied_flags = copied_flags,
                                             .places = row_places,
                                             .triangles = device_triangles,
                                             .neighbors = device_neighbors,
                                             .flags = device_flags});
        EXPECT_TRUE(same(download(runtime, device_triangles, 3 * rows), expected_triangles));
        EXPECT_TRUE(same(download(runtime, device_neighbors, 3 * rows), expected_neighbors));
        EXPECT_TRUE(same(download(runtime, device_flags, rows), expected_flags));
      }
    }
  }
}

}  // namespace
}  // namespace flaunay::testing
