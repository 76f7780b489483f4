#include "space/sphere/walk.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace flaunay::sphere {

Walker::Walker(const Triangulation& mesh)
    : mesh_(mesh),
      is_seen_(mesh.triangles.size() / 3),
      next_equal_(mesh.places.size() / 2, -1),
      triangle_at_(mesh.places.size() / 2, -1) {
  for (std::size_t i = mesh.representatives.size(); i-- > 0;) {
    const auto own = static_cast<std::int32_t>(i);
    if (mesh.representatives[i] == own) continue;
    next_equal_[i] = std::exchange(next_equal_[static_cast<std::size_t>(mesh.representatives[i])], own);
  }
  const auto triangles = static_cast<std::int32_t>(is_seen_.size());
  for (std::int32_t t = triangles - 1; t >= 0; --t) {
    const bool is_seen = turn(place(corner(t, 0)), place(corner(t, 1)), place(corner(t, 2))) > 0;
    is_seen_[static_cast<std::size_t>(t)] = is_seen;
    for (int k = 0; k < 3; ++k) {
      std::int32_t& at = triangle_at_[static_cast<std::size_t>(corner(t, k))];
      if (at < 0 || is_seen) at = t;
    }
  }
}

std::int32_t Walker::other_of(std::int32_t v) const {
  const std::vector<std::size_t>& offsets = mesh_.point_offsets;
  const auto end = std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(v));
  for (std::size_t i = *(end - 1); i < *end; ++i) {
    if (mesh_.representatives[i] != v) return mesh_.representatives[i];
  }
  return -1;
}

int Walker::corner_of(std::int32_t t, std::int32_t v) const {
  int k = 0;
  while (corner(t, k) != v) ++k;
  return k;
}

std::int32_t Walker::nearest(Point query, std::int32_t v) const {
  const auto is_better_than = [&](std::int32_t other, std::int32_t best) {
    const int sign = nearer(query, place(other), place(best));
    return sign > 0 || (sign == 0 && comes_first(place(other), place(best)));
  };
  if (triangle_at_[static_cast<std::size_t>(v)] < 0) {
    const std::int32_t other = other_of(v);
    return other >= 0 && is_better_than(other, v) ? other : v;
  }
  std::int32_t best = v;
  for (bool is_better = true; is_better;) {
    is_better = false;
    v = best;
    const std::int32_t first = triangle_at_[static_cast<std::size_t>(v)];
    std::int32_t t = first;
    do {
      const int k = corner_of(t, v);
      const std::int32_t other = corner(t, k + 1);
      if (is_better_than(other, best)) {
        best = other;
        is_better = true;
      }
      t = beyond(t, k + 1);
    } while (t != first);
  }
  return best;
}

std::vector<std::int32_t> Walker::nearest_points(Point query, std::int32_t v, std::size_t count) const {
  const auto comes_later = [&](std::int32_t a, std::int32_t b) {
    const int sign = nearer(query, place(a), place(b));
    return sign != 0 ? sign < 0 : comes_first(place(b), place(a));
  };
  std::vector<std::int32_t> result, waiting;  // a heap
  std::unordered_set<std::int32_t> known;
  const auto add = [&](std::int32_t other) {
    if (!known.insert(other).second) return;
    waiting.push_back(other);
    std::push_heap(waiting.begin(), waiting.end(), comes_later);
  };
  add(v);
  if (triangle_at_[static_cast<std::size_t>(v)] < 0 && other_of(v) >= 0) add(other_of(v));
  while (!waiting.empty() && result.size() < count) {
    std::pop_heap(waiting.begin(), waiting.end(), comes_later);
    const std::int32_t best = waiting.back();
    waiting.pop_back();
    for (std::int32_t i = best; i >= 0 && result.size() < count; i = next_equal_[static_cast<std::size_t>(i)])
      result.push_back(i);
    const std::int32_t first = triangle_at_[static_cast<std::size_t>(best)];
    for (std::int32_t t = first; t >= 0;) {
      const int k = corner_of(t, best);
      add(corner(t, k + 1));
      t = beyond(t, k + 1);
      if (t == first) break;
    }
  }
  return result;
}

Found Walker::found(std::int32_t t, Point query) const {
  Found result{t, {}};
  for (int k = 0; k < 3; ++k) {
    result.sides[static_cast<std::size_t>(k)] = turn(place(corner(t, k + 1)), place(corner(t, k + 2)), query);
  }
  return result;
}

// The triangle with the smallest number of all that have the query on an arc or at a corner.
Found Walker::smallest(Found here, Point query) const {
  const std::int32_t t = here.triangle;
  std::int32_t least = t;
  const auto take = [&](std::int32_t other) {
    if (is_seen_[static_cast<std::size_t>(other)] != 0 && other < least) least = other;
  };
  const auto& sides = here.sides;
  if (const int k = here.corner(); k < 0) {
    const auto side = std::find(sides.begin(), sides.end(), 0);
    if (side != sides.end()) take(beyond(t, static_cast<int>(side - sides.begin())));
  } else {
    const std::int32_t v = corner(t, k);
    for (std::int32_t other = beyond(t, corner_of(t, v) + 1); other != t;
         other = beyond(other, corner_of(other, v) + 1)) {
      take(other);
    }
  }
  return least == t ? here : found(least, query);
}

Found Walker::find(Point query, std::int32_t v) const {
  std::int32_t t = triangle_at_[static_cast<std::size_t>(nearest(query, v))];
  while (t >= 0 && is_seen_[static_cast<std::size_t>(t)] != 0) {
    const Found here = found(t, query);
    int k = 0;
    while (k < 3 && here.sides[static_cast<std::size_t>(k)] >= 0) ++k;
    if (k == 3) return smallest(here, query);
    t = beyond(t, k);
  }
  return {};
}

std::array<double, 3> Walker::weights(const Found& found, Point query) const {
  std::array<double, 3> weights{};
  Direction corners[3];
  for (int k = 0; k < 3; ++k) corners[k] = direction_of(place(corner(found.triangle, k)));
  const Direction to = direction_of(query);
  double whole = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    // The volume from small differences, for small triangles.
    const double volume = dot(to, cross(corners[(k + 1) % 3] - to, corners[(k + 2) % 3] - to));
    weights[k] = found.sides[k] == 0 ? 0 : std::fmax(volume, 0);
    whole += weights[k];
  }
  if (!(whole > 0)) {
    // Rounding has left nothing of these weights.
    whole = 0;
    for (int k = 0; k < 3; ++k) {
      const Point p = place(corner(found.triangle, k));
      const double volume =
          determinant(place(corner(found.triangle, k + 1)), place(corner(found.triangle, k + 2)), query);
      weights[static_cast<std::size_t>(k)] = volume * (is_pole(p) ? 1 : 1 + p.x * p.x + p.y * p.y);
      whole += weights[static_cast<std::size_t>(k)];
    }
  }
  for (double& weight : weights) weight /= whole;
  return weights;
}

}  // namespace flaunay::sphere
