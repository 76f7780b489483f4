// The public class PointTree.
#include <algorithm>
#include <limits>
#include <utility>

#include "call/frame.hpp"
#include "derived/nearest/point_tree.hpp"
#include "geometry/arguments.hpp"
#include "space/spaces.hpp"

namespace flaunay {
namespace nearest {
namespace {

// A thread answers this number of queries at a time.
constexpr std::size_t kRun = 512;

class ImageTree : public Tree {
 public:
  ImageTree(Triangulator& triangulator, const double* coordinates, std::size_t n,
            std::vector<std::int32_t> originals, const Space& space)
      : owner_(TriangulatorAccess::shared(triangulator)),
        tree_(coordinates, n),
        space_(space),
        calls_(call::calls_in(space.kind, false)),
        points_(n - originals.size()),
        originals_(std::move(originals)) {
    std::size_t copies = 0;  // of one point
    for (std::size_t i = 0; i < originals_.size(); ++i) {
      copies = i == 0 || originals_[i - 1] != originals_[i] ? 2 : copies + 1;
      most_copies_ = std::max(most_copies_, copies);
    }
  }

  Neighbors nearest(const double* queries, std::size_t m, const NeighborOptions& options) override {
    return call::take_turn(*owner_, [&] {
      check_queries(queries, m);
      if (calls_.places == nullptr) return find(queries, m, options);
      return find_points(calls_.places(owner_->native().runtime, queries, m, space_, "query").data(), m,
                         options);
    });
  }

 private:
  // Points and images, each as one of its own.
  Neighbors find(const double* queries, std::size_t m, const NeighborOptions& options) const {
    check_neighbors(options, m);
    Neighbors result;
    result.points.resize(m * options.count, -1);
    result.distances.resize(m * options.count, std::numeric_limits<double>::infinity());
    call::Frame call(owner_->native());
    const points::QueryScaling scaling =
        *points::query_scaling(call.runtime, tree_.range(), call.in(queries, 2 * m), {0, m});
    call.runtime.share((m + kRun - 1) / kRun, [&](std::size_t run) {
      tree_.find(queries, run * kRun, std::min(m, (run + 1) * kRun), scaling, options, result);
    });
    call.end();
    return result;
  }

  // Each point once. Several images of one are in the tree, but mostly only one of them is near.
  Neighbors find_points(const double* places, std::size_t m, const NeighborOptions& options) const {
    Neighbors result = find(places, m, options);
    if (has_repeated(result, options.count)) {
      NeighborOptions of_images = options;
      of_images.count = most_copies_ * options.count;
      Neighbors images = find(places, m, of_images);
      result.points.assign(m * options.count, -1);
      result.distances.assign(m * options.count, std::numeric_limits<double>::infinity());
      for (std::size_t i = 0; i < m; ++i) {
        const auto row = result.points.begin() + static_cast<std::ptrdiff_t>(i * options.count);
        auto end = row;
        for (std::size_t k = i * of_images.count; k < (i + 1) * of_images.count; ++k) {
          const std::int32_t point = original(images.points[k]);
          if (point < 0 || end == row + static_cast<std::ptrdiff_t>(options.count)) break;
          if (std::find(row, end, point) != end) continue;
          result.distances[static_cast<std::size_t>(end - result.points.begin())] = images.distances[k];
          *end++ = point;
        }
      }
    } else {
      for (std::int32_t& point : result.points) point = original(point);
    }
    return result;
  }
  std::int32_t original(std::int32_t image) const {
    const bool is_point = image < static_cast<std::int32_t>(points_);
    return is_point ? image : originals_[static_cast<std::size_t>(image) - points_];
  }
  bool has_repeated(const Neighbors& found, std::size_t count) const {
    std::vector<std::int32_t> row;
    for (std::size_t i = 0; i < found.points.size(); i += count) {
      row.clear();
      for (std::size_t k = i; k < i + count && found.points[k] >= 0; ++k)
        row.push_back(original(found.points[k]));
      std::sort(row.begin(), row.end());
      if (std::adjacent_find(row.begin(), row.end()) != row.end()) return true;
    }
    return false;
  }

  std::shared_ptr<call::Implementation> owner_;
  PointTree tree_;
  Space space_;
  const call::SpaceCalls& calls_;
  std::size_t points_;  // in front of their images
  std::vector<std::int32_t> originals_;
  std::size_t most_copies_ = 1;  // of one point: itself and its images
};

}  // namespace

void Tree::set_coordinates(SphereCoordinates /*coordinates*/) {
  throw Error(ErrorKind::usage, "only queries on the sphere have coordinates of the sphere");
}

std::unique_ptr<Tree> tree_of_images(Triangulator& triangulator, const std::vector<double>& coordinates,
                                     std::vector<std::int32_t> originals, const Space& space) {
  return std::make_unique<ImageTree>(triangulator, coordinates.data(), coordinates.size() / 2,
                                     std::move(originals), space);
}

}  // namespace nearest

struct PointTree::Implementation {
  std::unique_ptr<nearest::Tree> tree;
};

PointTree::PointTree(Triangulator& triangulator, const double* coordinates, std::size_t n)
    : implementation_(with_errors([&] {
        check_points(coordinates, n);
        return std::make_unique<Implementation>(Implementation{std::make_unique<nearest::ImageTree>(
            triangulator, coordinates, n, std::vector<std::int32_t>(), Space::plane())});
      })) {}

PointTree::PointTree(Triangulator& triangulator, const Triangulation& mesh)
    : implementation_(with_errors([&] {
        const call::SpaceCalls& calls = call::calls_in(mesh.space.kind, false);
        call::expect(calls.tree != nullptr, "a tree of points in the plane needs their coordinates");
        call::expect(mesh.point_offsets.size() == 2, "a tree is of one set of points: make one for each set");
        return std::make_unique<Implementation>(Implementation{calls.tree(triangulator, mesh)});
      })) {}

PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

void PointTree::set_coordinates(SphereCoordinates coordinates) {
  with_errors([&] { implementation_->tree->set_coordinates(coordinates); });
}

Neighbors PointTree::nearest(const double* queries, std::size_t m, const NeighborOptions& options) {
  return implementation_->tree->nearest(queries, m, options);
}

}  // namespace flaunay
