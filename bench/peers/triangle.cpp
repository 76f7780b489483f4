// Triangle 1.6, which is not free software: CMake looks for triangle.h and a library of its own (Debian's
// libtriangle-dev, in non-free), and nothing of flaunay needs it.
#include <fmt/format.h>

#include <cstdlib>

#include "bench/peers/peer.hpp"

// The header needs these macros.
#define REAL double
#define VOID void
#define ANSI_DECLARATORS
extern "C" {
#include <triangle.h>
}

namespace flaunay::bench {
namespace {

Refined refine(const ConstrainedInput& input, const Wanted& wanted) {
  // Indices from 0, quietly; a hull's edges are segments if there are no others.
  std::string switches = input.segments.empty() ? "zQ" : "pzQ";
  if (wanted.min_angle > 0) switches += fmt::format("q{}", wanted.min_angle);
  if (wanted.max_area > 0) switches += fmt::format("a{:.17f}", wanted.max_area);
  Refined refined;
  std::vector<std::vector<double>> holes = places_in_holes(input);
  for (std::size_t set = 0; set < input.points.sets(); ++set) {
    const std::size_t first = input.points.offsets[set], last = input.points.offsets[set + 1];
    std::vector<double> points(input.points.coordinates.begin() + static_cast<std::ptrdiff_t>(2 * first),
                               input.points.coordinates.begin() + static_cast<std::ptrdiff_t>(2 * last));
    std::vector<int> segments;
    for (std::size_t s = input.segment_offsets[set]; s < input.segment_offsets[set + 1]; ++s) {
      for (std::size_t end = 2 * s; end < 2 * s + 2; ++end) {
        segments.push_back(input.segments[end] - static_cast<std::int32_t>(first));
      }
    }
    triangulateio in{}, out{};
    in.pointlist = points.data();
    in.numberofpoints = static_cast<int>(points.size() / 2);
    in.segmentlist = segments.data();
    in.numberofsegments = static_cast<int>(segments.size() / 2);
    in.holelist = holes[set].data();
    in.numberofholes = static_cast<int>(holes[set].size() / 2);
    const double processors = processor_seconds();
    const Stopwatch watch;
    triangulate(switches.data(), &in, &out, nullptr);
    refined.seconds += watch.seconds();
    refined.processor_seconds += processor_seconds() - processors;
    const auto before = static_cast<std::int32_t>(refined.coordinates.size() / 2);
    refined.coordinates.insert(refined.coordinates.end(), out.pointlist,
                               out.pointlist + 2 * out.numberofpoints);
    for (int k = 0; k < 3 * out.numberoftriangles; ++k)
      refined.triangles.push_back(before + out.trianglelist[k]);
    for (void* const array : {static_cast<void*>(out.pointlist), static_cast<void*>(out.pointmarkerlist),
                              static_cast<void*>(out.trianglelist), static_cast<void*>(out.segmentlist),
                              static_cast<void*>(out.segmentmarkerlist)}) {
      std::free(array);
    }
  }
  return refined;
}

const bool kBuilt = (refine_by_triangle = refine, true);

}  // namespace
}  // namespace flaunay::bench
