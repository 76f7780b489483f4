#include "space/periodic/torus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/for_each.hpp"

namespace flaunay::periodic {
namespace {

using geometry::for_each;
using geometry::for_each_run;
using geometry::Point;

using Ids = std::vector<std::int32_t>;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

// 2^52 units: the smallest power of two that is not less than the period. Numbers from there to twice as much
// are multiples of the unit, and all multiples up to two periods are doubles.
double whole_of(double period) {
  const double power = std::ldexp(1.0, std::ilogb(period));
  return power < period ? 2 * power : power;
}

// The width of the widest circle without a point of the lattice, rounded upwards.
double widest_circle(double across, double shear, double up) {
  constexpr double kSpare = 1 + 0x1p-40;  // for all roundings
  const double scale = std::ldexp(1, -std::ilogb(std::max(across, up)));
  Point a{scale * across, 0}, b{scale * shear, scale * up};
  const double area = a.x * b.y;
  const auto product = [](Point p, Point q) { return p.x * q.x + p.y * q.y; };
  // The two shortest vectors that span it (Gauss).
  for (double times = 1; times != 0;) {
    if (product(b, b) < product(a, a)) std::swap(a, b);
    times = std::nearbyint(product(a, b) / product(a, a));
    b = {b.x - times * a.x, b.y - times * a.y};
  }
  // The circle around a triangle that has no obtuse angle.
  if (product(a, b) < 0) b = -b;
  const Point c = b - a;
  return kSpare * std::sqrt(product(a, a)) * std::sqrt(product(b, b)) * std::sqrt(product(c, c)) / area /
         scale;
}

}  // namespace

Lattice lattice_of(const Period& period) {
  Lattice lattice{};
  // Multiples of its unit up to 2 (length + more) are doubles.
  const auto take = [&](std::size_t axis, double length, double more) {
    lattice.period[axis] = lattice.reach[axis] = length;
    if (!std::isfinite(length)) return;
    const double rounded = kernel::in_units(length, whole_of(length + more));
    lattice.period[axis] = lattice.reach[axis] = rounded;
    lattice.whole[axis] = whole_of(rounded + more);
    lattice.most[axis] = 1;
  };
  take(0, period.x, 0);
  const double across = lattice.period[0];
  double shear = 0;
  if (period.shear != 0) {
    shear = kernel::in_units(std::remainder(period.shear, period.x), lattice.whole[0]);
    if (shear > across / 2) shear -= across;
    if (shear <= -across / 2) shear += across;
  }
  // Images above and below a sheared box are less than x + y away from it.
  take(1, period.y, shear != 0 ? across / 2 : 0);
  if (repeats(lattice, 0)) {
    const double unit = kernel::unit_across(&lattice);
    lattice.across[0] = static_cast<std::int64_t>(across / unit);
    lattice.across[1] = static_cast<std::int64_t>(shear / unit);
  }
  if (shear != 0) {
    const double up = lattice.period[1];
    lattice.reach[1] = widest_circle(across, shear, up);
    lattice.most[1] = 1 + static_cast<int>(lattice.reach[1] / up);
    lattice.most[0] = 2 + lattice.most[1] / 2;
  }
  return lattice;
}

Period period_of(const Lattice& lattice) {
  return {lattice.period[0], lattice.period[1],
          static_cast<double>(lattice.across[1]) * kernel::unit_across(&lattice)};
}

void take_into(const Lattice& lattice, const double* points, std::size_t n, std::uint64_t first,
               const char* what, double* places) {
  for (std::size_t i = 0; i < n; ++i) {
    const Point place = kernel::place_in({points[2 * i], points[2 * i + 1]}, &lattice);
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) {
      throw Error(ErrorKind::input, fmt::format("{} {} is not finite: ({}, {})", what, first + i,
                                                points[2 * i], points[2 * i + 1]));
    }
    places[2 * i] = place.x;
    places[2 * i + 1] = place.y;
  }
}

std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n,
                              const Lattice& lattice, const char* what) {
  std::vector<double> places;
  runtime.resize(places, 2 * n);
  for_each_run(&runtime, n, [&](std::size_t, std::size_t begin, std::size_t end) {
    take_into(lattice, points + 2 * begin, end - begin, begin, what, places.data() + 2 * begin);
  });
  return places;
}

Box box_of(const Lattice& lattice) {
  Box box{{{}, {lattice.period[0], lattice.period[1]}, 0}, lattice};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (repeats(lattice, axis)) continue;
    box.low[axis] = HUGE_VAL;
    box.high[axis] = -HUGE_VAL;
  }
  return box;
}

void extend(Box& box, const double* places, std::size_t n) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (std::size_t i = axis; i < 2 * n && !repeats(box.lattice, axis); i += 2) {
      box.low[axis] = std::min(box.low[axis], places[i]);
      box.high[axis] = std::max(box.high[axis], places[i]);
    }
  }
}

Box box_of(const double* places, std::size_t first, std::size_t last, const Lattice& lattice) {
  Box box = box_of(lattice);
  extend(box, places + 2 * first, last - first);
  return box;
}

double first_margin(const Box& box, std::size_t n) {
  constexpr double kSpare = 3, kPi = 3.14159265358979;
  const double count = static_cast<double>(n) + 2;
  const double share = std::sqrt(std::log(count) / (kPi * count));
  double margin = kSpare * share * std::sqrt(box.high[0] - box.low[0]) * std::sqrt(box.high[1] - box.low[1]);
  // In a narrow box, points are as on a line.
  for (const double period : box.lattice.period) {
    if (std::isfinite(period)) margin = std::max(margin, period * std::log(count) / count);
  }
  return margin;
}

void check_size(std::size_t points_and_images) {
  // Corners of triangles are numbered.
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max() / 6;
  if (points_and_images > kMost) {
    throw Error(ErrorKind::input,
                fmt::format("{} points and their images are too many: at most {} are possible",
                            points_and_images, kMost));
  }
}

bool is_whole(const Box& box) {
  const auto reaches = [&](std::size_t axis) {
    return !repeats(box.lattice, axis) || box.margin >= box.lattice.reach[axis];
  };
  return reaches(0) && reaches(1);
}

void widen(Box& box, std::size_t s) {
  if (is_whole(box))
    throw Error(ErrorKind::internal, fmt::format("the triangles of set {} are not those of a torus", s));
  box.margin *= kWider;
}

namespace {

// The place in units of the box.
Point in_box(const Box& box, Point p) {
  const auto share = [&](double x, std::size_t axis) {
    const double low = box.low[axis], size = box.high[axis] - low;
    return std::isfinite(size) ? (x - low) / size : (x / 2 - low / 2) / (box.high[axis] / 2 - low / 2);
  };
  return {share(p.x, 0), share(p.y, 1)};
}

// Whether an edge is on an end of a direction that has no period.
bool is_at_end(const Box& box, Point a, Point b) {
  return (a.x == b.x && kernel::ends_at(a.x, 0, &box.lattice, &box) > 0) ||
         (a.y == b.y && kernel::ends_at(a.y, 1, &box.lattice, &box) > 0);
}

}  // namespace

void Seams::add(const kernel::seam_record& seam) {
  const Point from{seam.ends[0], seam.ends[1]}, to{seam.ends[2], seam.ends[3]};
  // The triangles that are kept are joined at all edges, so it covers the torus or the cylinder as many times
  // as its area says: once. (The area is rounded, and computed from the border.)
  const Point a = in_box(box_, from), b = in_box(box_, to);
  area_ += (a.x + b.x) / 2 * (b.y - a.y);
  if (seam.beyond == NO_IMAGE && is_at_end(box_, from, to)) {
    ++ends_;
    return;
  }
  is_torn_ |= seam.beyond == NO_IMAGE && !is_whole(box_);
  const bool is_first = kernel::image_beside(seam.from, seam.from) < kernel::image_beside(seam.to, seam.from);
  const std::uint64_t first = is_first ? seam.from : seam.to, second = is_first ? seam.to : seam.from;
  const auto beside = [&](std::uint64_t image) { return kernel::image_beside(image, first); };
  edges_.push_back({beside(first), beside(second), beside(seam.own),
                    seam.beyond == NO_IMAGE ? NO_IMAGE : beside(seam.beyond), seam.at});
}

std::uint64_t Seams::expected(std::uint64_t points) const {
  const bool is_flat = box_.low[0] == box_.high[0] || box_.low[1] == box_.high[1];
  // An end has as many edges as points.
  return is_flat ? 0 : 2 * points - ends_;
}

bool Seams::match(std::uint64_t triangles) {
  if (is_torn_ || edges_.size() % 2 != 0) return false;
  if (triangles > 0 && !(std::fabs(area_ - 1) < 0.5)) return false;
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return std::pair(a.from, a.to) < std::pair(b.from, b.to); });
  for (std::size_t i = 0; i < edges_.size(); i += 2) {
    const Edge &a = edges_[i], &b = edges_[i + 1];
    if (!(a.from == b.from && a.to == b.to)) return false;
    // What is beyond an edge in the plane is an image of what is joined to it. Of a whole plane this is
    // known.
    if (!is_whole(box_) && !(a.own == b.beyond && b.own == a.beyond)) return false;
  }
  return true;
}

namespace {

// Calls work(set, begin, end) for runs of the elements of sets, on the threads of a native runtime.
template <typename Work>
void for_each_run_of_sets(host::Runtime& runtime, const std::vector<std::size_t>& offsets, const Work& work) {
  for_each_run(&runtime, offsets.back(), [&](std::size_t, std::size_t begin, std::size_t end) {
    auto next = std::upper_bound(offsets.begin(), offsets.end(), begin);
    for (; begin < end; ++next) {
      const std::size_t last = std::min(end, *next);
      if (begin < last) work(static_cast<std::size_t>(next - offsets.begin()) - 1, begin, last);
      begin = last;
    }
  });
}

// Writes the width of the circle around each triangle from `begin` to `end`, all of the box's set.
void measure_circles(const Triangulation& mesh, const Box& box, std::size_t begin, std::size_t end,
                     double* widths) {
  // Bounds of all roundings: images and differences of coordinates have one each.
  constexpr double kSpare = 1 + 0x1p-40, kError = 0x1p-50;
  const auto half = [&](std::size_t axis) { return box.high[axis] / 2 - box.low[axis] / 2; };
  // With a box of a size near 1, the squares of lengths are doubles.
  const double scale = std::ldexp(0.5, -std::ilogb(std::max(half(0), half(1))));
  const bool is_upright = !repeats(box.lattice, 0), has_ends = is_upright || !repeats(box.lattice, 1);
  const std::size_t along = is_upright ? 0 : 1;
  // Whether the centre of the circle around a counter-clockwise triangle is surely beyond an end.
  const auto is_beyond = [&](Point a, Point b, Point c) {
    if (is_upright) a = {a.y, -a.x}, b = {b.y, -b.x}, c = {c.y, -c.x};
    const Point p = b - a, q = c - a;
    const double first = p.x * (q.x * q.x + q.y * q.y), second = q.x * (p.x * p.x + p.y * p.y);
    const double height = first - second, error = 16 * kError * (std::fabs(first) + std::fabs(second));
    const double left = p.x * q.y, right = p.y * q.x;
    const double area = 2 * kSpare * (left - right + kError * (std::fabs(left) + std::fabs(right)));
    const double low = scale * box.low[along], high = scale * box.high[along];
    const double below = is_upright ? high + a.y : a.y - low, above = is_upright ? -a.y - low : high - a.y;
    return height + error < -below * area || height - error > above * area;
  };
  for (std::size_t t = begin; t < end; ++t) {
    std::array<Point, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t c = 3 * t + k, v = 2 * index(mesh.triangles[c]);
      p[k] = kernel::moved({mesh.places[v], mesh.places[v + 1]}, mesh.corner_offsets[2 * c],
                           mesh.corner_offsets[2 * c + 1], &box.lattice);
      p[k] = {scale * p[k].x, scale * p[k].y};
    }
    widths[t] = 0;
    if (has_ends && is_beyond(p[0], p[1], p[2])) continue;
    std::array<double, 3> opposite;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = p[(k + 2) % 3].x - p[(k + 1) % 3].x, y = p[(k + 2) % 3].y - p[(k + 1) % 3].y;
      opposite[k] = std::sqrt(x * x + y * y);
    }
    // The cross product of the two shorter sides has the smallest error.
    const auto k =
        static_cast<std::size_t>(std::max_element(opposite.begin(), opposite.end()) - opposite.begin());
    const Point &a = p[k], &b = p[(k + 1) % 3], &c = p[(k + 2) % 3];
    const double sides = opposite[(k + 1) % 3] * opposite[(k + 2) % 3],
                 area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) - kError * sides;
    widths[t] = area > 0 ? kSpare * opposite[k] * (sides / area) / scale : HUGE_VAL;
  }
}

// Whether all that lies in the box lies in the hull, by some distance.
bool is_box_inside(const Plane& plane, const Box& box, const std::int32_t* hull, std::size_t size) {
  constexpr double kDistance = 0x1p-30;
  for (std::size_t i = 0; i < size; ++i) {
    const Point a = in_box(box, plane.place(hull[i])), b = in_box(box, plane.place(hull[(i + 1) % size]));
    for (const Point corner : {Point{0, 0}, Point{1, 0}, Point{1, 1}, Point{0, 1}}) {
      if (!((b.x - a.x) * (corner.y - a.y) - (b.y - a.y) * (corner.x - a.x) > kDistance)) return false;
    }
  }
  return size > 0;
}

}  // namespace

std::vector<double> widest_gaps(host::Runtime& runtime, const Triangulation& mesh,
                                const std::vector<Box>& boxes) {
  std::vector<double> widths(mesh.triangles.size() / 3), gaps;
  for_each_run_of_sets(runtime, mesh.triangle_offsets,
                       [&](std::size_t s, std::size_t begin, std::size_t end) {
                         measure_circles(mesh, boxes[s], begin, end, widths.data());
                       });
  for (std::size_t s = 0; s < boxes.size(); ++s) {
    double widest = 0;
    for (std::size_t t = mesh.triangle_offsets[s]; t < mesh.triangle_offsets[s + 1]; ++t)
      widest = std::max(widest, widths[t]);
    gaps.push_back(widest);
  }
  return gaps;
}

Ids originals(host::Runtime& runtime, const Plane& plane, const Triangulation& planar,
              const Triangulation& mesh, std::vector<std::size_t>& narrow) {
  // Triangles by their first corner.
  std::vector<std::size_t> begins(mesh.representatives.size() + 1, 0);
  for (std::size_t c = 0; c < mesh.triangles.size(); c += 3) ++begins[index(mesh.triangles[c])];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  Ids by_first(mesh.triangles.size() / 3);
  for (std::size_t t = by_first.size(); t-- > 0;)
    by_first[--begins[index(mesh.triangles[3 * t])]] = static_cast<std::int32_t>(t);

  const auto find = [&](const std::array<std::uint64_t, 3>& images) {
    const auto is_same = [&](std::int32_t t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t c = 3 * index(t) + k;
        if (kernel::image_of(mesh.triangles[c], mesh.corner_offsets[2 * c], mesh.corner_offsets[2 * c + 1]) !=
            kernel::image_beside(images[k], images[0]))
          return false;
      }
      return true;
    };
    const auto row = by_first.begin();
    const std::size_t v = index(kernel::point_of(images[0]));
    const auto first = row + static_cast<std::ptrdiff_t>(begins[v]),
               last = row + static_cast<std::ptrdiff_t>(begins[v + 1]);
    const auto found = std::find_if(first, last, is_same);
    return found == last ? -1 : *found;
  };
  const auto touches = [&](const Box& box, const std::array<Point, 3>& p) {
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [below, above] = std::minmax({p[0].y, p[1].y, p[2].y});
    return right >= box.low[0] && left <= box.high[0] && above >= box.low[1] && below <= box.high[1];
  };
  const auto is_small = [&](const Box& box, const std::array<Point, 3>& p) {
    constexpr double kSpare = 1 + 0x1p-40;  // for all roundings
    const auto is_short = [&](Point a, Point b) {
      return kSpare * std::hypot(a.x - b.x, a.y - b.y) <= box.margin;
    };
    return is_short(p[0], p[1]) && is_short(p[1], p[2]) && is_short(p[2], p[0]);
  };
  const std::size_t sets = plane.boxes.size();
  Ids result(planar.triangles.size() / 3, -1);
  std::vector<std::atomic<bool>> is_narrow(sets);
  for_each_run_of_sets(
      runtime, planar.triangle_offsets, [&](std::size_t s, std::size_t begin, std::size_t end) {
        const Box& box = plane.boxes[s];
        const bool may_be_none = is_whole(box);
        for (std::size_t t = begin; t < end; ++t) {
          std::array<Point, 3> places;
          std::array<std::uint64_t, 3> images;
          for (std::size_t k = 0; k < 3; ++k) {
            places[k] = plane.place(planar.triangles[3 * t + k]);
            images[k] = plane.image(planar.triangles[3 * t + k]);
          }
          if (!touches(box, places)) continue;
          std::rotate(images.begin(), std::min_element(images.begin(), images.end()), images.end());
          result[t] = find(images);
          if (!may_be_none && (result[t] < 0 || !is_small(box, places))) is_narrow[s] = true;
        }
      });
  std::vector<bool> is_found(by_first.size(), false);
  for (const std::int32_t t : result) {
    if (t >= 0) is_found[index(t)] = true;
  }
  for (std::size_t s = 0; s < sets; ++s) {
    const auto own = is_found.begin() + static_cast<std::ptrdiff_t>(mesh.triangle_offsets[s]),
               end = is_found.begin() + static_cast<std::ptrdiff_t>(mesh.triangle_offsets[s + 1]);
    const std::size_t first = planar.hull_offsets[s], size = planar.hull_offsets[s + 1] - first;
    const bool is_right = is_whole(plane.boxes[s])
                              ? std::find(own, end, false) == end
                              : is_box_inside(plane, plane.boxes[s], planar.hull.data() + first, size);
    if (plane.offsets[s] < plane.offsets[s + 1] && (is_narrow[s] || !is_right)) narrow.push_back(s);
  }
  return result;
}

}  // namespace flaunay::periodic
