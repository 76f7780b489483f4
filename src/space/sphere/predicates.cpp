#include "space/sphere/predicates.hpp"

#include "arithmetic/exact_arithmetic.h"

namespace flaunay::sphere {
namespace {

using kernel::double2;
using kernel::expansion;

double2 exactly(double x) { return {x, 0}; }

void add_square(expansion& to, double2 x) { kernel::expansion_add_product(&to, x, x); }

void multiply(expansion& by, const expansion& factor) {
  kernel::expansion_compress(&by);
  kernel::expansion_multiply(&by, factor.part, factor.size);
}

void subtract(expansion& from, const expansion& other) {
  for (int i = 0; i < other.size; ++i) kernel::expansion_add(&from, -other.part[i]);
}

// The determinant of (x, y, 1 - x^2 - y^2) of three places, and of (0, 0, -1) of the pole, has three terms.
struct Term {
  double value, magnitude;
};

Term term(Point a, Point b, Point c) {
  if (is_pole(b) || is_pole(c)) return {0, 0};
  const double left = b.x * c.y, right = b.y * c.x, square = a.x * a.x + a.y * a.y;
  const double magnitude = std::fabs(left) + std::fabs(right);
  if (is_pole(a)) return {right - left, magnitude};
  return {(1 - square) * (left - right), (1 + square) * magnitude};
}

expansion exact_term(Point a, Point b, Point c) {
  expansion result{};
  if (is_pole(b) || is_pole(c)) return result;
  kernel::expansion_cross(exactly(b.x), exactly(b.y), exactly(c.x), exactly(c.y), &result);
  expansion height{};
  if (is_pole(a)) {
    kernel::expansion_add(&height, -1);
  } else {
    kernel::expansion_add(&height, 1);
    kernel::expansion_add_product(&height, exactly(-a.x), exactly(a.x));
    kernel::expansion_add_product(&height, exactly(-a.y), exactly(a.y));
  }
  multiply(result, height);
  return result;
}

// The square of the distance of two points on the sphere is that of their places, divided by 1 + |a|^2 and by
// 1 + |q|^2, where the pole's place and what is divided by are infinite: as if 1 were each of them. The
// second factor is left out, so that what remains of several points can be compared.
struct Distance {
  double square, divisor;
};

Distance distance(Point q, Point a) {
  if (is_pole(a)) return {is_pole(q) ? 0.0 : 1.0, 1};
  const double divisor = 1 + (a.x * a.x + a.y * a.y), x = a.x - q.x, y = a.y - q.y;
  return {is_pole(q) ? 1 : x * x + y * y, divisor};
}

void put_distance(Point q, Point a, expansion& square, expansion& divisor) {
  square.size = divisor.size = 0;
  kernel::expansion_add(&divisor, 1);
  if (is_pole(a) || is_pole(q)) {
    kernel::expansion_add(&square, is_pole(a) && is_pole(q) ? 0 : 1);
  } else {
    add_square(square, kernel::two_sum(a.x, -q.x));
    add_square(square, kernel::two_sum(a.y, -q.y));
  }
  if (!is_pole(a)) {
    add_square(divisor, exactly(a.x));
    add_square(divisor, exactly(a.y));
  }
}

}  // namespace

double determinant(Point a, Point b, Point c) {
  expansion sum = exact_term(a, b, c);
  for (const expansion& other : {exact_term(b, c, a), exact_term(c, a, b)}) {
    for (int i = 0; i < other.size; ++i) kernel::expansion_add(&sum, other.part[i]);
  }
  kernel::expansion_compress(&sum);
  return kernel::expansion_value(&sum);
}

int turn(Point a, Point b, Point c) {
  // A term has at most seven roundings, and two are added.
  constexpr double kBound = 0x1p-49;
  const Term terms[] = {term(a, b, c), term(b, c, a), term(c, a, b)};
  const double det = terms[0].value + terms[1].value + terms[2].value;
  const double magnitude = terms[0].magnitude + terms[1].magnitude + terms[2].magnitude;
  if (std::fabs(det) > kBound * magnitude) return det > 0 ? 1 : -1;
  const double exact = determinant(a, b, c);
  return (exact > 0) - (exact < 0);
}

int in_cap(Point a, Point b, Point c, Point q) {
  // Through the pole the circle is a line. Elsewhere the cap with the pole is the outside of the circle in
  // the plane, where a, b and c turn right: the determinant has the sign for both.
  if (is_pole(q)) return -kernel::orient_sign(a, b, c, ORIENT_BOUND);
  if (is_pole(a)) return kernel::orient_sign(b, c, q, ORIENT_BOUND);
  if (is_pole(b)) return kernel::orient_sign(c, a, q, ORIENT_BOUND);
  if (is_pole(c)) return kernel::orient_sign(a, b, q, ORIENT_BOUND);
  return kernel::circle_sign(a, b, c, q, CIRCLE_BOUND);
}

int nearer(Point q, Point a, Point b) {
  // Both products have at most nine roundings.
  constexpr double kBound = 0x1p-49;
  const Distance to_a = distance(q, a), to_b = distance(q, b);
  const double left = to_b.square * to_a.divisor, right = to_a.square * to_b.divisor;
  if (std::fabs(left - right) > kBound * (left + right)) return left > right ? 1 : -1;
  expansion square_a, square_b, divisor_a, divisor_b;
  put_distance(q, a, square_a, divisor_a);
  put_distance(q, b, square_b, divisor_b);
  multiply(square_b, divisor_a);
  multiply(square_a, divisor_b);
  subtract(square_b, square_a);
  return kernel::expansion_sign(&square_b);
}

}  // namespace flaunay::sphere
