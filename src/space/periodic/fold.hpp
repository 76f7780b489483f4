// From points on a torus or a cylinder to points in the plane, and from triangles of these back, where
// kernels run: on a device or natively. Only seams cross to the host.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "points/device_mesh.hpp"
#include "space/periodic/torus.hpp"

namespace flaunay::periodic {

using host::Arena;
using host::Buffer;

/// Takes points into the periods; see take_into. Waits once. O(n).
void find_places(host::Runtime& runtime, const Buffer<cl_double>& points, std::size_t n,
                 const Lattice& lattice, const Buffer<cl_double>& places);

/// The boxes of sets, without margins, which have the places from offsets on. Waits once for a cylinder.
/// O(n).
std::vector<Box> find_boxes(host::Runtime& runtime, const Buffer<cl_double>& places,
                            const std::vector<std::size_t>& offsets, const Lattice& lattice);

/// Some sets of points as they are triangulated in the plane, one after the other: of each first the points,
/// then their images in ascending order.
class UnrolledSets {
 public:
  /// Makes room for this many points and images in the array of places, which has those of the set alone.
  using MakeRoom = std::function<Buffer<cl_double>(std::size_t)>;

  /// first, last: per set its points; there is a set, and all boxes have one lattice. arena: where results
  /// come from; that of the runtime must be another one. make_room: null, or natively for a set that is
  /// alone, whose coordinates are then the places themselves. Waits once. O(n).
  UnrolledSets(host::Runtime& runtime, Arena& arena, const Buffer<cl_double>& places,
               const std::vector<std::size_t>& first, const std::vector<std::size_t>& last,
               std::vector<Box> boxes, const MakeRoom& make_room = nullptr);

  /// Where sets begin among points and images; sets + 1.
  const std::vector<std::size_t>& offsets() const { return offsets_; }
  const Buffer<cl_double>& coordinates() const { return coordinates_; }
  std::size_t sets() const { return boxes_.size(); }
  std::size_t points() const { return points_; }
  std::size_t images(std::size_t k) const { return images_[k]; }
  /// The number of the point at place v of the plane, which is no image.
  std::size_t number(std::size_t v) const;
  /// The weights of the points and images. weights: of all points. Does not wait. O(n).
  Buffer<cl_double> weights(host::Runtime& runtime, Arena& arena, const Buffer<cl_double>& weights) const;

 private:
  friend class FoldedSets;
  friend Plane plane_of(host::Runtime&, const std::vector<double>&, const std::vector<std::size_t>&,
                        std::vector<Box>);
  /// Points in the plane below this number are those of this number.
  std::size_t own() const { return sets() == 1 && first_[0] == 0 ? points_ : 0; }

  std::vector<Box> boxes_;
  std::size_t points_ = 0;
  std::vector<std::size_t> first_, counts_, images_, offsets_;
  Buffer<cl_int> point_offsets_;
  Buffer<kernel::unrolled_set> records_;
  Buffer<cl_uint> image_counts_;  // scanned
  Buffer<cl_double> coordinates_{};
  Buffer<cl_ulong> at_;  // per place in the plane what is there
};

/// Sets of places in host memory, unrolled natively.
Plane plane_of(host::Runtime& runtime, const std::vector<double>& places,
               const std::vector<std::size_t>& offsets, std::vector<Box> boxes);

/// The hidden points, as they are known when planes are folded.
struct HiddenPoints {
  Buffer<cl_int> in_plane{};  ///< the hidden vertices of the plane
  std::size_t count = 0;
  Buffer<cl_uchar> by_point{};  ///< whether a point is hidden, for all points; 0 at first
};

/// The triangles of planes, turned into those of the torus or the cylinder: of all images of a triangle one
/// is kept. If those of a set are not the canonical Delaunay triangulation, its margin was too small.
class FoldedSets {
 public:
  /// mesh: of the plane, with neighbours and representatives; its neighbours are changed. representatives: of
  /// all points; those of the sets are set. hidden: null without weights. Waits twice. O(t).
  FoldedSets(host::Runtime& runtime, Arena& arena, const UnrolledSets& plane, const points::DeviceMesh& mesh,
             const Buffer<cl_int>& representatives, const HiddenPoints* hidden);

  /// How many triangles a set must have.
  std::size_t expected(std::size_t k) const { return expected_[k]; }
  /// The points of all sets that another one represents.
  std::size_t duplicates() const { return duplicates_; }
  bool is_done(std::size_t k) const { return is_done_[k] != 0; }
  /// Writes the triangles of the sets that are done, of each from a row on. Natively, those of a single set
  /// that is done may be written to the arrays of the plane. Does not wait.
  void write(const std::vector<std::size_t>& first_rows, const Buffer<cl_int>& triangles,
             const Buffer<cl_char>& offsets, const Buffer<cl_int>& neighbors) const;

 private:
  void join(Arena& arena, const Buffer<cl_int>& list, std::size_t count);

  host::Runtime& runtime_;
  const UnrolledSets& plane_;
  const points::DeviceMesh& mesh_;
  Buffer<cl_int> triangle_offsets_;
  Buffer<cl_uint> ranks_{};
  std::vector<cl_uint> kept_before_;
  std::vector<std::size_t> expected_;
  std::size_t duplicates_ = 0;
  std::vector<char> is_done_;
};

}  // namespace flaunay::periodic
