#include "app/verify/open_edges.hpp"

#include <optional>

namespace flaunay::prove {
namespace {

std::string describe_triangle_of(const OpenEdge& edge) {
  const Vertex* corners[] = {&edge.apex, &edge.origin, &edge.target};
  const std::uint64_t k = edge.half_edge % 3;
  return describe_triangle(edge.row(), *corners[(3 - k) % 3], *corners[(4 - k) % 3], *corners[(5 - k) % 3]);
}

void check_neighbor(const OpenEdge& edge, std::int64_t expected) {
  if (edge.neighbor == expected) return;
  violate("{} has neighbor {} opposite to point {}, but it should be {}", describe_triangle_of(edge),
          edge.neighbor, edge.apex.id, expected);
}

/// Matches edges that come sorted by their ends.
class Matcher {
 public:
  Matcher(bool has_neighbors, Boundary& boundary, ExactPredicates& predicates)
      : has_neighbors_(has_neighbors), boundary_(boundary), predicates_(predicates) {}

  void add(const OpenEdge& edge) {
    if (!first_) {
      first_ = edge;
    } else if (first_->smaller() != edge.smaller() || first_->larger() != edge.larger()) {
      close();
      first_ = edge;
    } else if (!second_ && first_->origin.id == edge.target.id) {
      second_ = edge;
    } else {
      explain_repeated(edge);
    }
  }

  /// All half-edges between the same ends are known.
  void close() {
    if (first_ && second_) check_pair(*first_, *second_);
    if (first_ && !second_) {
      if (has_neighbors_) check_neighbor(*first_, -1);
      boundary_.add(&*first_, 1);
      ++counts_.boundary;
    }
    first_.reset();
    second_.reset();
  }

  const AcrossCounts& counts() const { return counts_; }

 private:
  void check_pair(const OpenEdge& edge, const OpenEdge& twin) {
    const int side = predicates_.incircle(edge.apex.at, edge.origin.at, edge.target.at, twin.apex.at);
    if (side > 0) {
      violate("{} is not Delaunay: its circle contains {}, a corner of triangle {}",
              describe_triangle_of(edge), describe(twin.apex), twin.row());
    }
    counts_.cocircular += side == 0;
    ++counts_.matched;
    if (!has_neighbors_) return;
    check_neighbor(edge, static_cast<std::int64_t>(twin.row()));
    check_neighbor(twin, static_cast<std::int64_t>(edge.row()));
  }

  [[noreturn]] void explain_repeated(const OpenEdge& edge) const {
    const OpenEdge& earlier = first_->origin.id == edge.origin.id ? *first_ : *second_;
    violate("{} has the edge from point {} to point {}, which {} has too", describe_triangle_of(edge),
            edge.origin.id, edge.target.id, describe_triangle_of(earlier));
  }

  bool has_neighbors_;
  Boundary& boundary_;
  ExactPredicates& predicates_;
  AcrossCounts counts_;
  std::optional<OpenEdge> first_, second_;
};

/// Says why `after` does not begin where `before`, the one before it in the order of the boundary, ends.
[[noreturn]] void explain_gap(const OpenEdge& before, const OpenEdge& after) {
  if (is_same_place(before.target, after.origin)) {
    violate("{} uses point {}, but {} uses its duplicate, point {}", describe_triangle_of(after),
            after.origin.id, describe_triangle_of(before), before.target.id);
  }
  if (before.origin.id == after.origin.id) {
    violate("the boundary touches itself at {}, a corner of {} and of triangle {}", describe(after.origin),
            describe_triangle_of(after), before.row());
  }
  violate(
      "the boundary is not one convex cycle: after the edge from point {} to point {} of {} comes that from "
      "point {} to point {} of {}; a hole, a notch, or a separate piece",
      before.origin.id, before.target.id, describe_triangle_of(before), after.origin.id, after.target.id,
      describe_triangle_of(after));
}

}  // namespace

AcrossCounts check_across(OpenEdges& edges, bool has_neighbors, Boundary& boundary,
                          ExactPredicates& predicates) {
  Matcher matcher(has_neighbors, boundary, predicates);
  edges.for_each([&](const OpenEdge& edge) { matcher.add(edge); });
  matcher.close();
  return matcher.counts();
}

void check_boundary(Boundary& boundary, ExactPredicates& predicates) {
  std::optional<OpenEdge> first, before;
  const auto check_corner = [&](const OpenEdge& edge, const OpenEdge& following) {
    if (edge.target.id != following.origin.id) explain_gap(edge, following);
    if (predicates.orient2d(edge.origin.at, edge.target.at, following.target.at) < 0) {
      violate("the boundary is not convex at {}, between {} and {}", describe(edge.target),
              describe(edge.origin), describe(following.target));
    }
  };
  boundary.for_each([&](const OpenEdge& edge) {
    if (before) check_corner(*before, edge);
    if (!first) first = edge;
    before = edge;
  });
  if (!first) violate("the triangles have no boundary");
  check_corner(*before, *first);
}

}  // namespace flaunay::prove
