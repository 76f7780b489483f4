// The public calls for rasters and contours of points in chunks.
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include "call/frame.hpp"
#include "derived/contours/contours.hpp"
#include "derived/raster/raster.hpp"
#include "large/chunks/breaklines.hpp"
#include "large/chunks/chunk_calls.hpp"

namespace flaunay {
namespace {

// Takes no arrays: only pixels and lines are wanted.
class NoArrays : public MeshSink {
 public:
  bool wants(MeshArray) const override { return false; }
  void write(MeshArray, std::uint64_t, const std::int64_t*, std::size_t) override {}
};

// Scans chunks into the pixels and traces lines, natively, while the next ones are triangulated.
class Scanner {
 public:
  Scanner(const RasterGrid& grid, const RasterOptions& options, double* pixels,
          const std::vector<double>& heights, const Breaklines& breaklines)
      : grid_(grid),
        options_(options),
        pixels_(pixels),
        lines_(heights, options.max_edge),
        crossed_(breaklines) {
    std::fill_n(pixels_, count(), std::numeric_limits<double>::quiet_NaN());
  }

  void take(chunks::ChunkSurface&& surface) {
    const std::lock_guard lock(mutex_);
    call::Frame call(TriangulatorAccess::implementation(host_).native());
    crossed_.take_from(call.runtime, surface);
    scan(call, surface);
    call.end();
  }

  // To be called at the end.
  void finish() {
    const chunks::ChunkSurface surface =
        crossed_.triangulated([&](const std::vector<double>& points, const Constraints& constraints) {
          return host_.constrained(points.data(), points.size() / 2, constraints);
        });
    call::Frame call(TriangulatorAccess::implementation(host_).native());
    scan(call, surface);
    call.end();
    // A pixel on an open side that no other triangle has written has its own one's value.
    for (const raster::SidePixel& each : on_sides_) {
      if (std::isnan(pixels_[each.pixel])) pixels_[each.pixel] = each.value;
    }
    if (std::isnan(options_.fill)) return;
    std::replace_if(
        pixels_, pixels_ + count(), [](double pixel) { return std::isnan(pixel); }, options_.fill);
  }

  Contours contours() { return lines_.finish(TriangulatorAccess::implementation(host_).native().runtime); }

 private:
  std::size_t count() const { return grid_.rows * grid_.columns; }

  void scan(call::Frame& call, const chunks::ChunkSurface& surface) {
    lines_.add(call.runtime,
               {surface.coordinates.data(), surface.values.size(), surface.triangles.data(),
                surface.neighbors.data(), surface.triangles.size() / 3},
               surface.values.data());
    if (count() == 0) return;
    const raster::Surface scanned{call.in(surface.coordinates), call.in(surface.triangles),
                                  call.in(surface.neighbors),   call.in(surface.values),
                                  surface.values.size(),        surface.triangles.size() / 3};
    raster::scan(call.runtime, scanned, grid_, options_, call.in(pixels_, count()));
    raster::append_side_pixels(call.runtime, scanned, call.in(surface.open), surface.open.size(), grid_,
                               options_, on_sides_);
  }

  const RasterGrid& grid_;
  const RasterOptions& options_;
  double* pixels_;
  contours::Lines lines_;
  chunks::CrossedTriangles crossed_;
  Triangulator host_{"host"};
  std::vector<raster::SidePixel> on_sides_;
  std::mutex mutex_;
};

}  // namespace

ValuedPoints::~ValuedPoints() = default;

ChunkStatistics rasterize_chunks(ValuedPoints& points, Duplicates duplicates, const RasterGrid& grid,
                                 const RasterOptions& options, double* pixels,
                                 const std::vector<double>& heights, Contours& contours,
                                 const Breaklines& breaklines, const ChunkOptions& chunks) {
  return with_errors([&] {
    const std::size_t count = raster::checked_pixels(grid, options);
    check_enumerator(duplicates);
    expect(chunks.space.kind == SpaceKind::plane && chunks.space.weights == nullptr,
           "rasters in chunks are of points without weights in the plane");
    check_array(pixels, count, "pixels", kMostCountable);
    contours::check(heights, options.max_edge);
    Scanner scanner(grid, options, pixels, heights, breaklines);
    chunks::PointsWithLines all(breaklines, points);
    const chunks::Values values{all, duplicates, breaklines.points,
                                [&](chunks::ChunkSurface&& surface) { scanner.take(std::move(surface)); }};
    NoArrays no_arrays;
    const ChunkStatistics statistics = call::triangulate_chunks(all, &values, no_arrays, chunks);
    scanner.finish();
    contours = scanner.contours();
    return statistics;
  });
}

ChunkStatistics rasterize_chunks(ValuedPoints& points, Duplicates duplicates, const RasterGrid& grid,
                                 const RasterOptions& options, double* pixels, const ChunkOptions& chunks) {
  Contours none;
  return rasterize_chunks(points, duplicates, grid, options, pixels, {}, none, {}, chunks);
}

}  // namespace flaunay
