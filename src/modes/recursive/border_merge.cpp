#include "modes/recursive/border_merge.hpp"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

enum Side { kLeft, kRight };

// The place of a direction from a path vertex, counter-clockwise: along the path's next edge, left of the
// path, along its previous edge, or right of the path. At the ends of the path, the missing edge is taken to
// be parallel to the line.
enum class Position { next, left, previous, right };

// The directions about one vertex of a path.
class PathVertex {
 public:
  PathVertex(const Predicates& predicates, const Line& line, const Path& path, std::size_t place,
             Counter& counter)
      : predicates_(predicates),
        line_(line),
        vertex_(path[place]),
        previous_(place > 0 ? &path[place - 1] : nullptr),
        next_(place + 1 < path.size() ? &path[place + 1] : nullptr),
        counter_(counter) {}

  // The position of the border edge to p. A point off the path lies on the same side of the path as of the
  // line, and so does an edge to it, which cannot cross the path. Points with a u between the u of the path's
  // neighbours are off the path, unless they are these neighbours. For other points an orientation must
  // decide.
  Position position_of(const HullPoint& p) {
    if (next_ && p.id == next_->id) return Position::next;
    if (previous_ && p.id == previous_->id) return Position::previous;
    counter_.arithmetic(2);
    if (next_ && next_->u() < p.u()) return turns_left(*next_, p) ? Position::left : Position::right;
    if (previous_ && p.u() < previous_->u()) {
      return turns_left(*previous_, p) ? Position::right : Position::left;
    }
    counter_.arithmetic();
    return p.s() < line_.q ? Position::left : Position::right;
  }

  // Whether f comes before g, counter-clockwise, for two directions on the same side of the path.
  bool comes_first(const HullPoint& f, const HullPoint& g, Position side) {
    const int f_rises = kernel::sign_of(f.u() - vertex_.u());
    const int g_rises = kernel::sign_of(g.u() - vertex_.u());
    counter_.arithmetic(2);
    if (f_rises != g_rises) return (f_rises > g_rises) == (side == Position::left);
    return turns_left(f, g);
  }

  // The id of a neighbour on the path; -1 beyond the ends of the path.
  std::int32_t neighbor(Position position) const {
    const HullPoint* neighbor = position == Position::next ? next_ : previous_;
    return neighbor ? neighbor->id : -1;
  }

 private:
  bool turns_left(const HullPoint& f, const HullPoint& g) {
    counter_.orientation();
    return predicates_.orient(vertex_.place, f.place, g.place) > 0;
  }

  const Predicates& predicates_;
  const Line& line_;
  const HullPoint& vertex_;
  const HullPoint* previous_;
  const HullPoint* next_;
  Counter& counter_;
};

// Cuts the wedge of a corner on the path at the edges of the path inside it. The wedge goes counter-clockwise
// from the edge to `after` to the edge to `before`. The paper's six cases are the possible results.
void split_corner(PathVertex& around, const HullPoint& before, std::int32_t vertex, const HullPoint& after,
                  SplitBorder& sides) {
  const Position from = around.position_of(before);
  const Position to = around.position_of(after);
  const bool on_one_side = from == to && (from == Position::left || from == Position::right);
  // The wedge may contain the whole other side of the path.
  bool passes = on_one_side && !around.comes_first(after, before, from);
  std::int32_t last = before.id;
  for (Position at = from;;) {
    const Side side = at == Position::previous || at == Position::left ? kLeft : kRight;
    const Position begin = side == kLeft ? Position::next : Position::previous;
    if (to == (side == kLeft ? Position::left : Position::right) && !passes) {
      sides[side].push_back({last, vertex, after.id});
      return;
    }
    sides[side].push_back({last, vertex, around.neighbor(begin)});
    if (to == begin) return;
    passes = false;
    at = begin;
    last = around.neighbor(begin);
  }
}

}  // namespace

SplitBorder merge_border(const Predicates& predicates, const std::vector<Point>& points, const Line& line,
                         const Border& border, const LowerHull& hull, const std::vector<char>& is_internal,
                         Counter& counter) {
  const Path& path = hull.path;
  const auto placed = [&](std::int32_t id) { return line.at(id, line.place(points[id])); };
  SplitBorder sides;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Corner& corner = border[i];
    const HullPoint vertex = placed(corner.vertex);
    std::size_t place = 0;
    if (hull.corners[i] != Kept::no) {
      place = search_path(path, vertex.u());
      counter.arithmetic(search_comparisons(path.size()));
    }
    if (path[place].id == vertex.id) {
      PathVertex around(predicates, line, path, place, counter);
      split_corner(around, placed(corner.before), vertex.id, placed(corner.after), sides);
    } else {
      counter.arithmetic();
      sides[vertex.s() < line.q ? kLeft : kRight].push_back(corner);
    }
  }
  for (std::size_t k = 1; k + 1 < path.size(); ++k) {
    if (!is_internal[k]) continue;
    sides[kLeft].push_back({path[k - 1].id, path[k].id, path[k + 1].id});
    sides[kRight].push_back({path[k + 1].id, path[k].id, path[k - 1].id});
  }
  // At most three steps per corner.
  counter.critical_path(search_comparisons(path.size()) + 3 * (2 + kernel::ORIENT_OPERATIONS) +
                        scan_depth(border.size()) + scan_depth(path.size()) + scan_depth(2));
  return sides;
}

}  // namespace flaunay::recursive
