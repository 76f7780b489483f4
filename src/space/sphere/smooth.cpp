#include "space/sphere/smooth.hpp"

#include <algorithm>
#include <limits>

#include "derived/interpolate/gradients.hpp"
#include "interpolate/blocks.h"

namespace flaunay::sphere {
namespace {

// The arcs that begin at vertices, each at the corner opposite to it in the triangle to its left: its
// direction and length there, in the vertex' frame, and its weight; 0 for one that is not seen.
struct Arcs {
  std::vector<Point> edges;
  std::vector<double> weights, inverses;
};

// Calls visit(c, u) for each arc from v to another vertex u.
template <typename Visit>
void for_each_arc(const Walker& walker, std::int32_t v, const Visit& visit) {
  const std::int32_t first = walker.triangle_at(v);
  std::int32_t t = first;
  do {
    const int k = walker.corner_of(t, v);
    const int opposite = (k + 2) % 3;
    if (walker.is_seen(t) || walker.is_seen(walker.beyond(t, opposite)))
      visit(3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(opposite), walker.corner(t, k + 1));
    t = walker.beyond(t, k + 1);
  } while (t != first);
}

// The same arc in the other direction.
std::size_t turned(const Walker& walker, std::size_t c) {
  const auto t = static_cast<std::int32_t>(c / 3);
  const auto k = static_cast<int>(c % 3);
  const std::int32_t other = walker.beyond(t, k);
  return 3 * static_cast<std::size_t>(other) +
         static_cast<std::size_t>((walker.corner_of(other, walker.corner(t, k + 1)) + 1) % 3);
}

void weigh_arcs(const Walker& walker, std::int32_t v, Arcs& arcs) {
  const Frame frame(direction_of(walker.place(v)));
  double least = HUGE_VAL;
  for_each_arc(walker, v, [&](std::size_t c, std::int32_t u) {
    const Direction chord = whole_chord(walker.place(v), walker.place(u)), seen = frame.seen(chord, 0);
    const double length = angle_of_chord(chord), across = std::sqrt(square_of(seen.x, seen.y));
    arcs.edges[c] = {length / across * seen.x, length / across * seen.y};
    arcs.weights[c] = length * length;
    least = std::min(least, length * length);
  });
  double xx = 0, xy = 0, yy = 0;
  for_each_arc(walker, v, [&](std::size_t c, std::int32_t) {
    const Point edge = arcs.edges[c];
    const double weight = std::sqrt(least / arcs.weights[c]) / arcs.weights[c];
    arcs.weights[c] = weight;
    xx += 4 * weight * edge.x * edge.x;
    xy += 4 * weight * edge.x * edge.y;
    yy += 4 * weight * edge.y * edge.y;
  });
  kernel::invert_block(xx, xy, yy, &arcs.inverses[3 * static_cast<std::size_t>(v)]);
}

struct Hermite {
  double value, slope;
};
// The cubic on [0, 1] with these values and slopes at its ends.
Hermite cubic(double from, double to, double begin, double end, double s) {
  const double rise = to - from, bend = begin + end - 2 * rise;
  return {from + s * (begin + s * (3 * rise - 2 * begin - end + s * bend)),
          begin + s * (2 * (3 * rise - 2 * begin - end) + 3 * s * bend)};
}

}  // namespace

std::vector<double> estimate_gradients(host::Runtime& runtime, const Walker& walker,
                                       const Triangulation& mesh, const double* values, std::size_t columns,
                                       std::size_t iterations) {
  const std::size_t n = mesh.representatives.size(), corners = mesh.triangles.size();
  Arcs arcs{std::vector<Point>(corners), std::vector<double>(corners), std::vector<double>(3 * n)};
  const auto for_each_vertex = [&](const auto& work) {
    for_each(runtime, n, [&](std::size_t i) {
      const auto v = static_cast<std::int32_t>(i);
      if (walker.triangle_at(v) >= 0) work(v, i);
    });
  };
  for_each_vertex([&](std::int32_t v, std::size_t) { weigh_arcs(walker, v, arcs); });
  std::vector<Point> start(n * columns), now(n * columns), before(n * columns);
  for_each_vertex([&](std::int32_t v, std::size_t i) {
    for (std::size_t c = 0; c < columns && iterations > 0; ++c) {
      double x = 0, y = 0;
      for_each_arc(walker, v, [&](std::size_t arc, std::int32_t u) {
        const double rise = 6 * (values[static_cast<std::size_t>(u) * columns + c] - values[i * columns + c]);
        x += arcs.weights[arc] * arcs.edges[arc].x * rise;
        y += arcs.weights[arc] * arcs.edges[arc].y * rise;
      });
      now[i * columns + c] = start[i * columns + c] = kernel::solved(&arcs.inverses[3 * i], x, y);
    }
  });
  interpolate::improve(iterations, [&](bool, double factor) {
    for_each_vertex([&](std::int32_t v, std::size_t i) {
      for (std::size_t c = 0; c < columns; ++c) {
        double x = 0, y = 0;
        for_each_arc(walker, v, [&](std::size_t arc, std::int32_t u) {
          const Point back = arcs.edges[turned(walker, arc)],
                      gradient = now[static_cast<std::size_t>(u) * columns + c];
          const double slope = -arcs.weights[arc] * (back.x * gradient.x + back.y * gradient.y);
          x += slope * arcs.edges[arc].x;
          y += slope * arcs.edges[arc].y;
        });
        const std::size_t at = i * columns + c;
        const Point best = start[at] - kernel::solved(&arcs.inverses[3 * i], 2 * x, 2 * y);
        before[at] = {factor * (best.x - before[at].x) + before[at].x,
                      factor * (best.y - before[at].y) + before[at].y};
      }
    });
    now.swap(before);
  });
  std::vector<double> result(3 * n * columns, std::numeric_limits<double>::quiet_NaN());
  for_each_vertex([&](std::int32_t v, std::size_t i) {
    if (!walker.is_seen(walker.triangle_at(v))) return;
    const Frame frame(direction_of(walker.place(v)));
    for (std::size_t at = i * columns; at < (i + 1) * columns; ++at) {
      const Direction gradient = now[at].x * frame.across + now[at].y * frame.along;
      std::copy_n(std::begin({gradient.x, gradient.y, gradient.z}), 3, &result[3 * at]);
    }
  });
  return result;
}

SmoothPlace::Arc SmoothPlace::arc(const Direction& from, const Direction& to, const Direction& chord,
                                  const Direction& place) {
  const double half = dot(chord, chord) / 2, length = angle_of_chord(chord);
  return {length, std::min(angle_between(from, place) / length, 1.0), normalized(chord + half * from),
          normalized(chord - half * to)};
}

SmoothPlace::SmoothPlace(const Walker& walker, const Found& found, Point query) : corner_(found.corner()) {
  if (corner_ >= 0) return;
  const std::array<double, 3> shares = walker.weights(found, query);
  const Direction at = direction_of(query);
  std::array<Point, 3> places{};
  std::array<Direction, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    places[k] = walker.place(walker.corner(found.triangle, static_cast<int>(k)));
    corners[k] = direction_of(places[k]);
  }
  double whole = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3;
    weights_[i] = shares[a] * shares[b];
    whole += weights_[i];
    if (weights_[i] == 0) continue;
    const Direction chord = whole_chord(places[a], places[b]),
                    met = normalized(shares[a] * corners[a] + shares[b] * corners[b]);
    normal_[i] = normalized(cross(corners[a], chord));
    tangent_[i] = cross(normal_[i], met);
    opposite_[i] = arc(corners[a], corners[b], chord, met);
    along_[i] = arc(corners[i], met, met - corners[i], at);
    // Rounded, both ends may be one, with the place between them.
    if (!(along_[i].length > 0)) {
      corner_ = static_cast<std::ptrdiff_t>(i);
      return;
    }
  }
  for (double& weight : weights_) weight /= whole;
  // Rounded, it may be at a corner.
  if (!(whole > 0)) corner_ = std::max_element(shares.begin(), shares.end()) - shares.begin();
}

double SmoothPlace::value(const std::array<double, 3>& values,
                          const std::array<Direction, 3>& gradients) const {
  if (corner_ >= 0) return values[static_cast<std::size_t>(corner_)];
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (weights_[i] == 0) continue;
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3;
    const Arc &side = opposite_[i], &inner = along_[i];
    const Hermite met = cubic(values[a], values[b], side.length * dot(gradients[a], side.begin),
                              side.length * dot(gradients[b], side.end), side.share);
    const double across =
        (1 - side.share) * dot(gradients[a], normal_[i]) + side.share * dot(gradients[b], normal_[i]);
    const Direction gradient = met.slope / side.length * tangent_[i] + across * normal_[i];
    sum += weights_[i] * cubic(values[i], met.value, inner.length * dot(gradients[i], inner.begin),
                               inner.length * dot(gradient, inner.end), inner.share)
                             .value;
  }
  return sum;
}

}  // namespace flaunay::sphere
