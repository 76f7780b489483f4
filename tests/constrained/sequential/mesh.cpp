#include "tests/constrained/sequential/mesh.hpp"

#include "geometry/halfedges.hpp"

namespace flaunay::sequential {
using namespace geometry;

namespace {

[[noreturn]] void throw_broken() {
  throw Error(ErrorKind::internal, "a segment leaves the triangulation; please report the input");
}

}  // namespace

// Goes around a vertex, triangle by triangle, to the edge or triangle by which the segment to another vertex
// of its set leaves it: counter-clockwise, and if it meets the hull, clockwise from where it began.
class ConstrainedMesh::StarSearch {
 public:
  StarSearch(const ConstrainedMesh& mesh, std::int32_t origin, std::int32_t goal)
      : mesh_(mesh), origin_(origin), goal_(goal), start_(mesh.out_[origin]), h_(start_) {}

  /// Looks at one triangle. Returns whether it found the departure.
  bool step(Departure& departure) {
    const std::int32_t before = previous_halfedge(h_);
    const std::int32_t p = mesh_.triangles_[next_halfedge(h_)], q = mesh_.triangles_[before];
    const int side_p = side(p), side_q = side(q);
    if (side_p == 0 && is_ahead(p)) {
      departure = {h_, p};
    } else if (side_q == 0 && is_ahead(q)) {
      departure = {before, q};
    } else if (side_p < 0 && side_q > 0) {
      departure = {next_halfedge(h_), -1};
    } else {
      advance(before);
      return false;
    }
    return true;
  }

 private:
  int side(std::int32_t v) const {
    return mesh_.predicates_.orient(mesh_.points_[origin_], mesh_.points_[goal_], mesh_.points_[v]);
  }
  // Of a vertex on the line.
  bool is_ahead(std::int32_t v) const {
    const Point origin = mesh_.points_[origin_];
    return kernel::comes_before(origin, mesh_.points_[v]) ==
           kernel::comes_before(origin, mesh_.points_[goal_]);
  }
  void advance(std::int32_t before) {
    if (!clockwise_) {
      h_ = mesh_.twins_[before];
      if (h_ == start_) throw_broken();
      if (h_ >= 0) return;
      clockwise_ = true;
      h_ = start_;
    }
    const std::int32_t twin = mesh_.twins_[h_];
    if (twin < 0) throw_broken();
    h_ = next_halfedge(twin);
  }

  const ConstrainedMesh& mesh_;
  std::int32_t origin_, goal_, start_, h_;
  bool clockwise_ = false;
};

ConstrainedMesh::ConstrainedMesh(const Predicates& predicates, const Point* points, std::size_t point_count,
                                 const Triangulation& delaunay)
    : predicates_(predicates),
      points_(points),
      triangles_(delaunay.triangles),
      twins_(delaunay.triangles.size(), -1),
      constraints_(delaunay.triangles.size(), -1),
      out_(point_count, -1),
      polygons_(predicates, points),
      side_of_(delaunay.triangles.size(), -1) {
  Options options;
  options.halfedges = true;
  Triangulation adjacency;
  adjacency.neighbors = delaunay.neighbors;
  geometry::write_halfedges(options, adjacency);
  twins_.swap(adjacency.halfedges);
  for (std::size_t h = 0; h < triangles_.size(); ++h) out_[triangles_[h]] = static_cast<std::int32_t>(h);
}

Departure ConstrainedMesh::depart_from(std::int32_t from, std::int32_t to) const {
  Departure departure;
  StarSearch search(*this, from, to);
  while (!search.step(departure)) {
  }
  return departure;
}

std::int32_t ConstrainedMesh::follow(std::int32_t from, std::int32_t to, std::int32_t halfedge,
                                     Cavity& cavity, std::vector<std::int32_t>& crossed) const {
  const std::int32_t right = triangles_[halfedge], left = triangles_[next_halfedge(halfedge)];
  cavity.rows.assign(1, halfedge / 3);
  cavity.left.vertices.assign({from, left});
  cavity.right.vertices.assign({from, right});
  cavity.left.sides.assign(1, next_halfedge(halfedge));
  cavity.right.sides.assign(1, previous_halfedge(halfedge));
  while (true) {
    if (constraints_[halfedge] >= 0) crossed.push_back(constraints_[halfedge]);
    const std::int32_t twin = twins_[halfedge];
    if (twin < 0) throw_broken();
    cavity.rows.push_back(twin / 3);
    // The edges to the vertex across, from the right and to the left.
    const std::int32_t from_right = next_halfedge(twin), to_left = previous_halfedge(twin);
    const std::int32_t v = triangles_[to_left];
    const int side = v == to ? 0 : predicates_.orient(points_[from], points_[to], points_[v]);
    if (side >= 0) {
      cavity.left.vertices.push_back(v);
      cavity.left.sides.push_back(to_left);
    }
    if (side <= 0) {
      cavity.right.vertices.push_back(v);
      cavity.right.sides.push_back(from_right);
    }
    if (side == 0) return v;
    halfedge = side > 0 ? from_right : to_left;
  }
}

void ConstrainedMesh::retriangulate(const Cavity& cavity, std::int32_t constraint) {
  sides_.clear();
  read_sides(cavity.left);
  read_sides(cavity.right);
  // An edge that ends inside of the cavity is two sides of it: their twins are each other.
  for (Side& side : sides_) {
    if (side.twin >= 0 && side_of_[side.twin] >= 0) side.twin = -2 - side_of_[side.twin];
  }
  for (const Cavity::Border* border : {&cavity.left, &cavity.right}) {
    for (const std::int32_t h : border->sides) side_of_[h] = -1;
  }

  const std::int32_t* row = cavity.rows.data();
  chain_ = cavity.left.vertices;
  const std::int32_t left = fill(chain_, 0, 1, row);
  chain_.assign(cavity.right.vertices.rbegin(), cavity.right.vertices.rend());
  const std::int32_t right = fill(chain_, static_cast<std::int32_t>(sides_.size()) - 1, -1, row);
  join(left, right);
  for (const std::int32_t h : {left, right}) constraints_[h] = constraint;
  for (const Side& side : sides_) {
    join(side.halfedge, side.twin < -1 ? sides_[-2 - side.twin].halfedge : side.twin);
    constraints_[side.halfedge] = side.constraint;
  }
}

void ConstrainedMesh::read_sides(const Cavity::Border& border) {
  for (const std::int32_t h : border.sides) {
    side_of_[h] = static_cast<std::int32_t>(sides_.size());
    sides_.push_back({twins_[h], constraints_[h]});
  }
}

// Triangulates a chain into the next rows; its side k is sides_[first_side + k * step]. Returns the half-edge
// along the base.
std::int32_t ConstrainedMesh::fill(const std::vector<std::int32_t>& chain, std::int32_t first_side, int step,
                                   const std::int32_t*& row) {
  std::int32_t base = -1;
  open_.assign(1, {0, static_cast<std::int32_t>(chain.size()) - 1, -1});
  const auto open = [&](std::int32_t from, std::int32_t to, std::int32_t h) {
    if (to - from > 1) {
      open_.push_back({from, to, h});
    } else {
      sides_[first_side + from * step].halfedge = h;
    }
  };
  for (const auto& [i, j, k] : polygons_.triangulate(chain)) {
    const std::int32_t beyond = open_.back().beyond;
    open_.pop_back();
    const std::int32_t h = put(*row++, chain[i], chain[k], chain[j]);
    if (beyond < 0) {
      base = h;
    } else {
      join(h, beyond);
    }
    open(j, k, h + 1);
    open(i, j, h + 2);
  }
  return base;
}

std::int32_t ConstrainedMesh::put(std::int32_t row, std::int32_t a, std::int32_t b, std::int32_t c) {
  std::int32_t h = 3 * row;
  for (const std::int32_t v : {a, b, c}) {
    triangles_[h] = v;
    constraints_[h] = -1;
    out_[v] = h++;
  }
  return 3 * row;
}

void ConstrainedMesh::join(std::int32_t a, std::int32_t b) {
  twins_[a] = b;
  if (b >= 0) twins_[b] = a;
}

}  // namespace flaunay::sequential
