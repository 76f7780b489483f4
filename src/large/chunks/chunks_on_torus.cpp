// More points on a torus or a cylinder than fit memory: chunks of the points and of images of those near the
// border, which are in memory.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/arguments.hpp"
#include "host/clock.hpp"
#include "host/memory/system_memory.hpp"
#include "large/chunks/chunk_calls.hpp"
#include "large/chunks/runs.hpp"
#include "space/periodic/torus.hpp"
#include "space/periodic/triangulate_on_torus.hpp"

namespace flaunay {
namespace {

using geometry::Point;
using periodic::Box;

// Points that are read at once.
constexpr std::size_t kPlacesAtOnce = std::size_t{1} << 18;

// The places of points, piece by piece.
class Places {
 public:
  Places(PointSource& points, const periodic::Lattice& lattice, const ChunkOptions& options)
      : points_(points), lattice_(lattice), options_(options) {}

  std::uint64_t size() const { return points_.size(); }
  void read(std::uint64_t first, std::size_t count, double* places) const {
    points_.read(first, count, places);
    periodic::take_into(lattice_, places, count, first, "point", places);
  }
  // Calls visit(i, place) for each point.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    std::vector<double> places;
    for (std::uint64_t first = 0; first < size(); first += kPlacesAtOnce) {
      if (options_.progress) options_.progress("images", 0, 0);
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kPlacesAtOnce, size() - first));
      places.resize(2 * count);
      read(first, count, places.data());
      for (std::size_t i = 0; i < count; ++i) visit(first + i, Point{places[2 * i], places[2 * i + 1]});
    }
  }

 private:
  PointSource& points_;
  periodic::Lattice lattice_;
  const ChunkOptions& options_;
};

Box box_of(const Places& places, const periodic::Lattice& lattice) {
  Box box = periodic::box_of(lattice);
  if (periodic::repeats(lattice, 0) && periodic::repeats(lattice, 1)) return box;
  places.for_each([&](std::uint64_t, Point p) { periodic::extend(box, &p.x, 1); });
  return box;
}

// Points and, after them, the images within the margin. Takes the edges where triangles that are kept end.
class UnrolledPlane : public PointSource, public chunks::Folding {
 public:
  // Bytes that an image may take: 24 for itself, the rest for edges where triangles are joined.
  static constexpr std::uint64_t kBytesPerImage = 48;

  UnrolledPlane(const Places& places, const Box& box, std::uint64_t memory) : places_(places), seams_(box) {
    const std::uint64_t most = (memory - call::kLeastChunkBytes) / kBytesPerImage;
    places.for_each([&](std::uint64_t i, Point p) {
      periodic::for_each_image(box, static_cast<std::int64_t>(i), p, [&](std::uint64_t image, Point place) {
        if (images_.size() == most) throw too_many(memory);
        images_.push_back({place, image});
      });
    });
  }

  std::uint64_t images() const { return images_.size(); }
  std::uint64_t bytes() const { return kBytesPerImage * images(); }

  std::uint64_t size() const override { return places_.size() + images(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    const std::uint64_t n = places_.size(), end = first + count;
    if (first < n) places_.read(first, static_cast<std::size_t>(std::min(end, n) - first), coordinates);
    for (std::uint64_t v = std::max(first, n); v < end; ++v) {
      const Point& place = images_[v - n].place;
      coordinates[2 * (v - first)] = place.x;
      coordinates[2 * (v - first) + 1] = place.y;
    }
  }

  std::int64_t first_image() const override { return static_cast<std::int64_t>(places_.size()); }
  std::uint64_t image(std::int64_t v) const override {
    return v < first_image() ? kernel::image_of(v, 0, 0)
                             : images_[static_cast<std::uint64_t>(v) - places_.size()].image;
  }
  void add(const std::vector<kernel::seam_record>& seams) override {
    for (const kernel::seam_record& seam : seams) seams_.add(seam);
  }
  bool match(std::uint64_t points, std::uint64_t triangles) {
    return triangles == seams_.expected(points) && seams_.match(triangles);
  }
  // After match.
  void write_neighbors(MeshSink& sink) const {
    std::vector<std::pair<std::uint64_t, std::int64_t>> links;
    seams_.for_each_link([&](std::int64_t entry, std::int64_t t) {
      links.emplace_back(static_cast<std::uint64_t>(entry), t);
    });
    std::sort(links.begin(), links.end());
    chunks::RunWriter writer(sink, MeshArray::neighbors);
    for (const auto& [entry, t] : links) writer.add(entry, t);
    writer.flush();
  }

 private:
  struct Stored {
    Point place;
    std::uint64_t image;
  };

  Error too_many(std::uint64_t memory) const {
    return Error(ErrorKind::input,
                 fmt::format("more than {} images of the {} points lie near the border, which do not fit "
                             "memory_bytes, {}, beside chunks",
                             images(), places_.size(), host::mebibytes(memory)));
  }

  const Places& places_;
  std::deque<Stored> images_;  // it grows without being copied
  periodic::Seams seams_;
};

// Turns images into points and offsets, and counts duplicates.
class FoldedSink : public MeshSink {
 public:
  FoldedSink(MeshSink& sink, const UnrolledPlane& plane, std::uint64_t points)
      : sink_(sink), plane_(plane), points_(points) {}

  std::uint64_t duplicates() const { return duplicates_; }

  bool wants(MeshArray array) const override {
    return is_needed(array) || (array != MeshArray::hull && sink_.wants(array));
  }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    count = possible(first, count, array == MeshArray::representatives ? points_ : 6 * points_);
    if (count == 0) return;
    if (array == MeshArray::triangles) {
      values = without_images(values, count);
      sink_.write_corner_offsets(2 * first, offsets_.data(), offsets_.size());
    } else if (array == MeshArray::representatives) {
      for (std::size_t k = 0; k < count; ++k)
        duplicates_ += static_cast<std::uint64_t>(values[k]) != first + k;
    }
    if (sink_.wants(array)) sink_.write(array, first, values, count);
  }
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override {
    count = possible(first, count, 2 * points_);
    if (count > 0) sink_.write_doubles(array, first, values, count);
  }

 private:
  // Images have no entries. Of a margin that is too small, there may be more triangles than there is room
  // for.
  static std::size_t possible(std::uint64_t first, std::size_t count, std::uint64_t entries) {
    return static_cast<std::size_t>(std::min<std::uint64_t>(count, entries - std::min(first, entries)));
  }
  static bool is_needed(MeshArray array) {
    return array == MeshArray::triangles || array == MeshArray::representatives;
  }

  // Returns the corners' points, and leaves their offsets in offsets_. Mostly no corner is an image.
  const std::int64_t* without_images(const std::int64_t* corners, std::size_t count) {
    offsets_.assign(2 * count, 0);
    if (static_cast<std::uint64_t>(*std::max_element(corners, corners + count)) < points_) return corners;
    corners_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint64_t image = plane_.image(corners[k]);
      corners_[k] = kernel::point_of(image);
      offsets_[2 * k] = static_cast<std::int8_t>(kernel::vectors_across(image));
      offsets_[2 * k + 1] = static_cast<std::int8_t>(kernel::vectors_up(image));
    }
    return corners_.data();
  }

  MeshSink& sink_;
  const UnrolledPlane& plane_;
  std::uint64_t points_, duplicates_ = 0;
  std::vector<std::int64_t> corners_;
  std::vector<std::int8_t> offsets_;
};

// Returns nothing if the margin is too small.
std::optional<ChunkStatistics> triangulate_in(const Places& places, const Box& box, MeshSink& sink,
                                              ChunkOptions options) {
  const std::uint64_t n = places.size(), memory = call::chunk_memory(options);
  const double begin = host::now();
  UnrolledPlane plane(places, box, memory);
  const double end = host::now();
  options.memory_bytes = memory - plane.bytes();
  FoldedSink folded(sink, plane, n);
  ChunkStatistics statistics = call::triangulate_chunks(plane, nullptr, folded, options, &plane);
  if (!plane.match(n - folded.duplicates(), statistics.triangles)) return std::nullopt;
  if (sink.wants(MeshArray::neighbors)) plane.write_neighbors(sink);
  statistics.points = n;
  statistics.duplicates = folded.duplicates();
  statistics.hull_vertices = 0;
  statistics.images = plane.images();
  statistics.phases.insert(statistics.phases.begin(), {"images", end - begin});
  return statistics;
}

}  // namespace

Period take_to_places(const Period& period, double* points, std::size_t n) {
  check_array(points, n, "points", kMostPointsInChunks);
  call::check(period);
  const periodic::Lattice lattice = periodic::lattice_of(period);
  periodic::take_into(lattice, points, n, 0, "point", points);
  return periodic::period_of(lattice);
}

ChunkStatistics call::triangulate_chunks_on_torus(PointSource& points, MeshSink& sink,
                                                  const ChunkOptions& options) {
  check(options.space.period);
  check_count(points.size(), "points", kMostPointsInChunks);
  expect(!sink.wants(MeshArray::hull), "a torus or a cylinder has no hull");
  const double begin = host::now();
  const periodic::Lattice lattice = periodic::lattice_of(options.space.period);
  const Places places(points, lattice, options);
  Box box = box_of(places, lattice);
  box.margin = periodic::first_margin(box, places.size());
  for (;; periodic::widen(box, 0)) {
    if (places.size() == 0) return ChunkStatistics();
    if (std::optional<ChunkStatistics> done = triangulate_in(places, box, sink, options)) {
      done->seconds = host::now() - begin;
      return std::move(*done);
    }
  }
}

}  // namespace flaunay
