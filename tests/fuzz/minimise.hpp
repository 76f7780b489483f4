// Shrinks a batch of point sets on which something fails.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "tests/fuzz/batch.hpp"

namespace flaunay::fuzz {

using Fails = std::function<bool(const Batch&)>;

/// A batch that still fails, of fewer sets and points with shorter coordinates. Removes sets and points, half
/// of them first and single ones last, and then rounds coordinates, until no such step is left that fails.
/// Calls `fails` at most `most_calls` times. The batch itself must fail.
Batch minimise(Batch batch, const Fails& fails, std::size_t most_calls = 20'000);

using SegmentsFail = std::function<bool(const SegmentBatch&)>;

/// Also removes segments. A point that is removed takes the segments with it that end there.
SegmentBatch minimise(SegmentBatch batch, const SegmentsFail& fails, std::size_t most_calls = 20'000);

/// The batch as an .xy file: one point per line. `comment` may have several lines; the sets of a batch are
/// told apart by comments.
std::string fixture_text(const Batch& batch, const std::string& comment);

/// The batch as a statement of tests/constrained/constrained_test.cpp.
std::string test_text(const SegmentBatch& batch, const std::string& comment);

}  // namespace flaunay::fuzz
