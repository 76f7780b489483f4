#include "space/periodic/fold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "host/launch/vector_operations.hpp"
#include "launchers/periodic/fold.cl.hpp"
#include "launchers/periodic/unroll.cl.hpp"
#include "launchers/periodic/weights.cl.hpp"
#include "periodic/torus.h"
#include "points/download.hpp"

namespace flaunay::periodic {

using points::integers;

namespace {

// Enqueues the transfer of what a scan has where sets begin, and at their end.
void read_totals_later(host::Runtime& runtime, const Buffer<cl_uint>& sums, const Buffer<cl_int>& offsets,
                       std::vector<cl_uint>& to) {
  to.resize(offsets.size());
  const auto totals = runtime.arena().allocate<cl_uint>(to.size());
  runtime.map(to.size(), kernels::read_totals{.offsets = offsets, .sums = sums, .totals = totals});
  runtime.read_later(totals, 0, to.size(), to.data());
}

}  // namespace

void find_places(host::Runtime& runtime, const Buffer<cl_double>& points, std::size_t n,
                 const Lattice& lattice, const Buffer<cl_double>& places) {
  Arena::Scope scope(runtime.arena());
  constexpr cl_int kNone = std::numeric_limits<cl_int>::max();
  const auto first_bad = runtime.upload(runtime.arena(), std::vector<cl_int>{kNone});
  runtime.map(n,
              kernels::find_places{.lattice = lattice, .input = points, .places = places, .bad = first_bad});
  const cl_int bad = runtime.read_one(first_bad, 0);
  if (bad == kNone) return;
  const auto at = static_cast<std::size_t>(bad);
  const std::vector<double> p = points::download(runtime, points, 2 * at, 2);
  throw Error(ErrorKind::input, fmt::format("point {} is not finite: ({}, {})", at, p[0], p[1]));
}

std::vector<Box> find_boxes(host::Runtime& runtime, const Buffer<cl_double>& places,
                            const std::vector<std::size_t>& offsets, const Lattice& lattice) {
  std::vector<Box> boxes;
  if (repeats(lattice, 0) && repeats(lattice, 1)) {
    boxes.resize(offsets.size() - 1, box_of(nullptr, 0, 0, lattice));
    return boxes;
  }
  if (runtime.threads() == 1) {
    const auto* const all = reinterpret_cast<const double*>(host::address_of(places.memory()));
    for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
      boxes.push_back(box_of(all, offsets[s], offsets[s + 1], lattice));
    return boxes;
  }
  Arena::Scope scope(runtime.arena());
  const std::size_t most = runtime.sizes().chunk(offsets.back());
  std::vector<cl_int2> pieces;
  std::vector<std::size_t> set_pieces{0};
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; i += most)
      pieces.push_back({{static_cast<cl_int>(i), static_cast<cl_int>(std::min(i + most, offsets[s + 1]))}});
    set_pieces.push_back(pieces.size());
  }
  const std::size_t count = pieces.size();
  const auto found = runtime.arena().allocate<cl_double>(4 * count);
  runtime.map(count, kernels::find_box_ends{.pieces = runtime.upload(runtime.arena(), std::move(pieces)),
                                            .places = places,
                                            .ends = found});
  std::vector<double> ends(4 * count);
  runtime.read(found, 0, ends.size(), ends.data());
  // The lowest and the highest place of a piece.
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
    boxes.push_back(box_of(ends.data(), 2 * set_pieces[s], 2 * set_pieces[s + 1], lattice));
  return boxes;
}

UnrolledSets::UnrolledSets(host::Runtime& runtime, Arena& arena, const Buffer<cl_double>& places,
                           const std::vector<std::size_t>& first, const std::vector<std::size_t>& last,
                           std::vector<Box> boxes, const MakeRoom& make_room)
    : boxes_(std::move(boxes)), first_(first) {
  const Lattice& lattice = boxes_.front().lattice;
  std::vector<kernel::unrolled_set> records;
  std::vector<std::size_t> point_offsets{0};
  for (std::size_t k = 0; k < sets(); ++k) {
    counts_.push_back(last[k] - first[k]);
    point_offsets.push_back(point_offsets.back() + counts_[k]);
    const bool has_ends = !repeats(lattice, 0) || !repeats(lattice, 1);
    records.push_back({boxes_[k], static_cast<cl_int>(first[k]), has_ends});
  }
  points_ = point_offsets.back();
  point_offsets_ = runtime.upload(arena, integers(point_offsets));
  records_ = runtime.upload(arena, std::move(records));
  image_counts_ = arena.allocate<cl_uint>(points_ + 1);
  runtime.map(points_, kernels::count_images{.lattice = lattice,
                                             .sets = sets(),
                                             .offsets = point_offsets_,
                                             .all = records_,
                                             .places = places,
                                             .counts = image_counts_});
  host::exclusive_scan(runtime, image_counts_, points_, image_counts_);
  std::vector<cl_uint> images_before;
  {
    const host::Runtime::Settled settled(runtime);
    Arena::Scope scope(runtime.arena());
    read_totals_later(runtime, image_counts_, point_offsets_, images_before);
    runtime.finish();
  }
  for (std::size_t k = 0; k <= sets(); ++k) {
    offsets_.push_back(point_offsets[k] + images_before[k]);
    if (k > 0) images_.push_back(images_before[k] - images_before[k - 1]);
  }
  check_size(offsets_.back());
  const std::size_t count = offsets_.back();
  coordinates_ = make_room ? make_room(count) : arena.allocate<cl_double>(2 * count);
  at_ = arena.allocate<cl_ulong>(offsets_.back());
  runtime.map(points_, kernels::write_images{.lattice = lattice,
                                             .sets = sets(),
                                             .own = own(),
                                             .are_there = static_cast<bool>(make_room),
                                             .offsets = point_offsets_,
                                             .all = records_,
                                             .places = make_room ? coordinates_ : places,
                                             .counts = image_counts_,
                                             .coordinates = coordinates_,
                                             .images = at_});
}

std::size_t UnrolledSets::number(std::size_t v) const {
  const auto k =
      static_cast<std::size_t>(std::upper_bound(offsets_.begin(), offsets_.end(), v) - offsets_.begin()) - 1;
  return first_[k] + v - offsets_[k];
}

Buffer<cl_double> UnrolledSets::weights(host::Runtime& runtime, Arena& arena,
                                        const Buffer<cl_double>& weights) const {
  const auto in_plane = arena.allocate<cl_double>(offsets_.back());
  runtime.map(
      offsets_.back(),
      kernels::weigh_images{.own = own(), .images = at_, .weights = weights, .plane_weights = in_plane});
  return in_plane;
}

Plane plane_of(host::Runtime& runtime, const std::vector<double>& places,
               const std::vector<std::size_t>& offsets, std::vector<Box> boxes) {
  if (boxes.empty()) return {{}, offsets, {}, 0, {}};
  Arena::Scope scope(runtime.arena());
  Arena arena(runtime.memory());
  const UnrolledSets sets(runtime, arena, runtime.view(places.data(), places.size()),
                          {offsets.begin(), offsets.end() - 1}, {offsets.begin() + 1, offsets.end()}, boxes);
  Plane plane{std::move(boxes), sets.offsets(), {}, sets.own(), {}};
  plane.coordinates = points::download(runtime, sets.coordinates(), 0, 2 * plane.offsets.back());
  const std::vector<cl_ulong> images =
      points::download(runtime, sets.at_, plane.own, plane.offsets.back() - plane.own);
  plane.images.assign(images.begin(), images.end());
  return plane;
}

FoldedSets::FoldedSets(host::Runtime& runtime, Arena& arena, const UnrolledSets& plane,
                       const points::DeviceMesh& mesh, const Buffer<cl_int>& representatives,
                       const HiddenPoints* hidden)
    : runtime_(runtime),
      plane_(plane),
      mesh_(mesh),
      triangle_offsets_(runtime.upload(arena, integers(mesh.triangle_offsets))),
      is_done_(plane.sets()) {
  const std::size_t sets = plane.sets(), count = mesh.triangle_count();
  const auto missing = arena.allocate<cl_uint>(2 * sets);
  runtime.fill(missing, 2 * sets, cl_uint{0});
  runtime.map(plane.points_, kernels::fold_representatives{.lattice = plane.boxes_.front().lattice,
                                                           .sets = sets,
                                                           .offsets = plane.point_offsets_,
                                                           .all = plane.records_,
                                                           .counts = plane.image_counts_,
                                                           .coordinates = plane.coordinates_,
                                                           .planar = mesh.representatives,
                                                           .representatives = representatives,
                                                           .missing = missing});
  ranks_ = arena.allocate<cl_uint>(count + 1);
  runtime.map(count,
              kernels::keep_triangles{
                  .own = plane.own(), .triangles = mesh.triangles, .images = plane.at_, .kept = ranks_});
  if (hidden != nullptr) {
    runtime.map(hidden->count,
                kernels::flag_hidden_points{.own = plane.own(),
                                            .lattice = plane.boxes_.front().lattice,
                                            .sets = sets,
                                            .offsets = runtime.upload(arena, integers(plane.offsets_)),
                                            .all = plane.records_,
                                            .hidden = hidden->in_plane,
                                            .images = plane.at_,
                                            .coordinates = plane.coordinates_,
                                            .is_hidden = hidden->by_point,
                                            .missing = missing});
  }
  host::exclusive_scan(runtime, ranks_, count, ranks_);

  std::vector<cl_uint> fewer(2 * sets);
  const host::Runtime::Settled settled(runtime);
  Arena::Scope scope(runtime.arena());
  const auto flags = runtime.arena().allocate<cl_uchar>(count);
  runtime.map(count, kernels::find_seams{.neighbors = mesh.neighbors, .ranks = ranks_, .flags = flags});
  read_totals_later(runtime, ranks_, triangle_offsets_, kept_before_);
  runtime.read_later(missing, 0, 2 * sets, fewer.data());
  const auto list = runtime.arena().allocate<cl_int>(count);
  const auto found = runtime.arena().allocate<cl_uint>(1);
  host::pack_positions(runtime, flags, count, 1, list, found);
  const std::size_t seams = runtime.read_one(found, 0);
  for (std::size_t k = 0; k < sets; ++k) {
    duplicates_ += fewer[2 * k];
    expected_.push_back(2 * (plane.counts_[k] - fewer[2 * k]) - fewer[2 * k + 1]);
  }
  join(arena, list, seams);
}

// list: the triangles that have seams, in ascending order.
void FoldedSets::join(Arena& arena, const Buffer<cl_int>& list, std::size_t count) {
  const auto records = runtime_.arena().allocate<kernel::seam_record>(3 * count);
  runtime_.map(count, kernels::list_seams{.own = plane_.own(),
                                          .list = list,
                                          .triangles = mesh_.triangles,
                                          .neighbors = mesh_.neighbors,
                                          .ranks = ranks_,
                                          .images = plane_.at_,
                                          .coordinates = plane_.coordinates_,
                                          .seams = records});
  std::vector<kernel::seam_record> read(runtime_.is_native() ? 0 : 3 * count);
  runtime_.read(records, 0, read.size(), read.data());
  const auto* const seams = runtime_.is_native()
                                ? reinterpret_cast<kernel::seam_record*>(host::address_of(records.memory()))
                                : read.data();
  std::vector<cl_int2> links(3 * count, {{kernel::NO_SEAM, kernel::NO_SEAM}});
  const auto first_of = [&](std::size_t k) {
    const auto is_before = [](const kernel::seam_record& seam, std::size_t at) {
      return static_cast<std::size_t>(seam.at) < at;
    };
    const auto* const end = seams + 3 * count;
    return static_cast<std::size_t>(std::lower_bound(seams, end, 3 * mesh_.triangle_offsets[k], is_before) -
                                    seams);
  };
  runtime_.share(plane_.sets(), [&](std::size_t k) {
    if (kept_before_[k + 1] - kept_before_[k] != expected_[k]) return;
    const std::size_t first = first_of(k), end = first_of(k + 1);
    Seams joined(plane_.boxes_[k]);
    for (std::size_t i = first; i < end; ++i) {
      if (seams[i].own != NO_IMAGE) joined.add(seams[i]);
    }
    if (!joined.match(expected_[k])) return;
    is_done_[k] = 1;
    auto link = links.begin() + static_cast<std::ptrdiff_t>(first);
    joined.for_each_link([&](std::int64_t at, std::int64_t t) {
      *link++ = {{static_cast<cl_int>(at), static_cast<cl_int>(t)}};
    });
  });
  runtime_.map(3 * count, kernels::link_seams{.links = runtime_.upload(arena, std::move(links)),
                                              .neighbors = mesh_.neighbors});
}

void FoldedSets::write(const std::vector<std::size_t>& first_rows, const Buffer<cl_int>& triangles,
                       const Buffer<cl_char>& offsets, const Buffer<cl_int>& neighbors) const {
  Arena::Scope scope(runtime_.arena());
  std::vector<cl_int> shifts;
  for (std::size_t k = 0; k < plane_.sets(); ++k)
    shifts.push_back(is_done(k) ? static_cast<cl_int>(first_rows[k]) - static_cast<cl_int>(kept_before_[k])
                                : kernel::NOT_WRITTEN);
  const auto shift_buffer = runtime_.upload(runtime_.arena(), std::move(shifts));
  // Writes the rows of n triangles to arrays that begin at row `begin`.
  const auto write_rows = [&](std::size_t first, std::size_t n, std::size_t begin,
                              const Buffer<cl_int>& folded, const Buffer<cl_int>& folded_neighbors) {
    runtime_.map(n, kernels::write_folded{.first = static_cast<cl_int>(first),
                                          .begin = static_cast<cl_int>(begin),
                                          .sets = plane_.sets(),
                                          .offsets = triangle_offsets_,
                                          .shifts = shift_buffer,
                                          .own = plane_.own(),
                                          .triangles = mesh_.triangles,
                                          .neighbors = mesh_.neighbors,
                                          .ranks = ranks_,
                                          .images = plane_.at_,
                                          .folded = folded,
                                          .periods = offsets.as<kernel::uchar2>(),
                                          .folded_neighbors = folded_neighbors});
  };
  const std::size_t count = mesh_.triangle_count();
  if (triangles.memory() != mesh_.triangles.memory() || runtime_.threads() == 1)
    return write_rows(0, count, 0, triangles, neighbors);
  // Several threads write one slice after the other, and not to where others still read: as many triangles as
  // there were rows that are not kept, or else by way of other memory.
  constexpr std::size_t kLeast = std::size_t{1} << 15, kSlice = std::size_t{1} << 17;
  const std::size_t most = 3 * std::min(kSlice, count);
  const auto slice = runtime_.arena().allocate<cl_int>(most),
             beyond = runtime_.arena().allocate<cl_int>(most);
  for (std::size_t first = 0, n = 0; first < count; first += n) {
    const std::size_t begin = runtime_.read_one(ranks_, first), free = first - begin;
    n = std::min(free < kLeast ? kSlice : free, count - first);
    if (free >= kLeast) {
      write_rows(first, n, 0, triangles, neighbors);
      continue;
    }
    write_rows(first, n, begin, slice, beyond);
    const std::size_t rows = runtime_.read_one(ranks_, first + n) - begin;
    runtime_.copy(slice, 0, triangles, 3 * begin, 3 * rows);
    runtime_.copy(beyond, 0, neighbors, 3 * begin, 3 * rows);
  }
}

}  // namespace flaunay::periodic
