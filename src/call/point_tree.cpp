// The public class PointTree.
#include "derived/nearest/point_tree.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "call/frame.hpp"

namespace flaunay {

namespace {

// Queries are shared among threads in runs of so many.
constexpr std::size_t kRun = 512;

}  // namespace

struct PointTree::Implementation {
  std::shared_ptr<call::Implementation> owner;
  nearest::PointTree tree;
};

PointTree::PointTree(Triangulator& triangulator, const double* coordinates, std::size_t n)
    : implementation_(with_errors([&] {
        check_points(coordinates, n);
        return std::make_unique<Implementation>(
            Implementation{TriangulatorAccess::shared(triangulator), nearest::PointTree(coordinates, n)});
      })) {}

PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

Neighbors PointTree::nearest(const double* queries, std::size_t m, const NeighborOptions& options) {
  const Implementation& self = *implementation_;
  return call::take_turn(*self.owner, [&] {
    call::expect(options.count > 0, "the number of nearest points must be 1 or more");
    call::expect(options.max_distance >= 0, "the largest distance must be 0 or more");
    check_queries(queries, m);
    check_count(options.count, "neighbours of each query",
                std::min(kMostIndexed, kMostCountable / std::max<std::size_t>(m, 1)));
    Neighbors result;
    result.points.resize(m * options.count, -1);
    result.distances.resize(m * options.count, std::numeric_limits<double>::infinity());
    call::Frame call(self.owner->native());
    const points::QueryScaling scaling =
        *points::query_scaling(call.runtime, self.tree.range(), call.in(queries, 2 * m), {0, m});
    call.runtime.share((m + kRun - 1) / kRun, [&](std::size_t run) {
      self.tree.find(queries, run * kRun, std::min(m, (run + 1) * kRun), scaling, options, result);
    });
    call.end();
    return result;
  });
}

}  // namespace flaunay
