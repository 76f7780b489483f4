// Inserts, removes and moves random points, many of them degenerate, in batches, with segments that are split
// where they cross: after each, the triangulation and its constraints have to be those of a call on all
// points. Some batches are ended by an error.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/fuzz/run.hpp"
#include "tests/fuzz/segments.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tests/updates/mirror.hpp"

namespace flaunay::fuzz {
namespace {

using testing::FixtureRandom;
using testing::Interrupted;
using testing::Mirror;

class UpdatesFuzzer : public Fuzzer {
 public:
  bool run(FixtureRandom& random) override {
    Coordinates places;
    std::vector<std::int32_t> segments;
    for (const SegmentSet& set : degenerate_segments(random)) {
      if (set.points.size() <= places.size() || set.points.size() > kMostCoordinates) continue;
      places = set.points;
      segments = set.segments;
    }
    if (random.integer(0, 1) == 0) segments.clear();
    ConstrainedOptions options;
    options.crossings = Crossings::split;
    try {
      Coordinates with_next = places;
      for (const double x : places) with_next.push_back(next(x));
      host_.triangulate(with_next.data(), places.size());
      Constraints constraints;
      constraints.segments = segments.data();
      constraints.segment_count = segments.size() / 2;
      const ConstrainedTriangulation split =
          host_.constrained(places.data(), places.size() / 2, constraints, options);
      if (split.added_points.size() > kMostCoordinates) segments.clear();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
      return true;  // coordinates out of the range of magnitudes
    }
    if (places.empty()) return true;
    const auto some_places = [&](std::size_t count) {
      Coordinates some;
      for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(random.integer(0, std::ssize(places) / 2 - 1));
        some.insert(some.end(), {places[2 * at], places[2 * at + 1]});
      }
      return some;
    };
    start_check();
    const std::size_t size = places.size() / 2;
    // Tuned not to triangulate anew, which the other one does.
    Triangulator& by = random.integer(0, 4) == 0 ? host_ : changing_;
    const Coordinates some = some_places(static_cast<std::size_t>(random.integer(0, std::ssize(places))));
    std::int64_t calls_left = -1;  // before a callback throws; never if less than 0
    options.progress = [&](const std::string&, int, double) {
      if (calls_left < 0 || calls_left-- > 0) return;
      ++interrupted_;
      throw Interrupted();
    };
    std::optional<Mirror> made;
    if (segments.empty()) {
      made.emplace(by, host_, some);
    } else {
      made.emplace(by, host_, places, segments, options);
    }
    Mirror& mirror = *made;
    for (std::int64_t batches = random.integer(1, 8); batches > 0 && !has_failed(); --batches) {
      const auto count = static_cast<std::size_t>(random.integer(1, random.integer(1, std::int64_t(size))));
      std::vector<std::int32_t> numbers;
      for (const auto& [v, p] : mirror.points) numbers.push_back(v);
      random.shuffle(numbers);
      numbers = mirror.without_ends(numbers);
      // Sometimes all that can go, so that a dimension is lost.
      if (random.integer(0, 9) > 0) numbers.resize(std::min(numbers.size(), count));
      const std::int64_t kind = random.integer(0, 2);
      const Coordinates given =
          kind == 0 ? some_places(count) : moved(mirror, numbers, some_places(numbers.size()), random);
      calls_left = random.integer(-9, 3);
      mirror.checks_between = random.integer(0, 1) == 0;
      if (kind == 0) mirror.insert(given);
      if (kind == 1) mirror.remove(numbers);
      if (kind == 2) mirror.move(numbers, given);
      calls_left = -1;
      mirror.check();
      ++batches_;
      constrained_ += !segments.empty();
      flat_ += mirror.mesh.triangle_count() == 0;
    }
    if (!has_failed()) return true;
    fmt::print("{}: {} points\n", case_name(), size);
    return false;
  }

  std::string summary() const override {
    return fmt::format("{} batches, {} of them with segments, {} with all points on a line, {} interrupted",
                       batches_, constrained_, flat_, interrupted_);
  }

 private:
  // Small sets: each batch is held against a call on all points.
  static constexpr std::size_t kMostCoordinates = 1000;

  // Expectations are outside of a test.
  static bool has_failed() { return ::testing::UnitTest::GetInstance()->ad_hoc_test_result().Failed(); }

  static double next(double x) { return x * (1 + 0x1p-52); }

  // Some go to other places, the rest to the next double.
  static Coordinates moved(const Mirror& mirror, const std::vector<std::int32_t>& numbers, Coordinates places,
                           FixtureRandom& random) {
    const std::int64_t far = random.integer(0, 4);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (random.integer(0, 3) < far) continue;
      const Mirror::Point at = mirror.points.at(numbers[i]);
      for (std::size_t k = 0; k < 2; ++k) places[2 * i + k] = next(at[k]);
    }
    return places;
  }

  Triangulator host_{"host"};
  Triangulator& changing_ =
      testing::triangulator_with("inserted_percent=1000000,removed_percent=90,moved_percent=90");
  std::size_t batches_ = 0, constrained_ = 0, flat_ = 0, interrupted_ = 0;
};

}  // namespace
}  // namespace flaunay::fuzz

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return flaunay::fuzz::run_fuzzer<flaunay::fuzz::UpdatesFuzzer>(
      argc, argv, "fuzz_updates", "Inserts, removes and moves random points, and checks the results exactly");
}
