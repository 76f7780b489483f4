// Why the checks together are complete. `Sweep` cuts the segments and the convex hull at all points on them,
// and finds the faces between these pieces, from points and segments alone. Each face is to be covered, or
// not.
//
// 0. Depths of faces follow from the segments between them, by the definitions of `FillRule`.
// 1. Every triangle is counter-clockwise, and every directed edge occurs at most once. Each side of each
//    piece has a triangle if and only if the face there is to be covered. Every edge with one triangle is a
//    piece. So the sum of the triangles' oriented boundaries is the boundary of the covered faces: every
//    point in general position is in one triangle if its face is covered, and in none otherwise.
// 2. Every place in a covered face or on its border is a corner. A triangle around it, or with it on an edge,
//    would overlap the triangles at that corner. So the triangles are a triangulation of the covered faces
//    with all points there, and the segments there are chains of its edges.
// 3. Every edge that is no constraint is locally Delaunay, which is the definition.
// 4. If two triangles on one circle share an edge that is no constraint, it begins at the lexicographically
//    smallest of the four corners: the rule of `circle_canonical`, for which docs/constrained.md proves that
//    every cell is then a fan from its smallest vertex.
#include "prove/constrained_proof.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "constrained/refinement/bounds.hpp"
#include "prove/apexes.hpp"
#include "prove/checker.hpp"
#include "prove/sweep.hpp"

namespace flaunay {
namespace {

using prove::Apexes;
using prove::Checker;
using prove::is_before;
using prove::kHull;
using prove::kNone;
using prove::Piece;
using prove::Place;
using prove::Span;
using prove::Sweep;
using prove::Vertex;
using prove::violate;

constexpr std::int32_t kNoPiece = -1, kNoPoint = -1;

/// How rings go around a place, and how many polygons it is in.
class PolygonsAround {
 public:
  PolygonsAround(const Rings& rings, bool is_even_odd)
      : is_even_odd_(is_even_odd), windings_(rings.segment_offsets.size() - 1, 0) {
    for (std::size_t r = 0, part = 0, polygon = 0; r < windings_.size(); ++r) {
      while (rings.part_offsets[part + 1] <= r) ++part;
      while (rings.polygon_offsets[polygon + 1] <= r) ++polygon;
      bounded_.push_back({part, polygon, rings.part_offsets[part] == r});
    }
    borders_.assign(rings.part_offsets.size(), 0);
    holes_.assign(rings.part_offsets.size(), 0);
    parts_.assign(rings.polygon_offsets.size(), 0);
  }

  void cross(std::size_t ring, int amount) {
    count_here(ring, -1);
    windings_[ring] += amount;
    count_here(ring, 1);
  }
  std::int64_t count() const { return count_; }

 private:
  struct Bounded {
    std::size_t part, polygon;
    bool is_border;
  };

  /// Adds the polygon of a ring to the count, or takes it from there, if it is here.
  void count_here(std::size_t ring, int amount) {
    const auto [part, polygon, is_border] = bounded_[ring];
    const auto add_part = [this, part = part, polygon = polygon](int sign) {
      if (borders_[part] == 0 || holes_[part] != 0) return;
      if (parts_[polygon] > 0) --count_;
      parts_[polygon] += sign;
      if (parts_[polygon] > 0) ++count_;
    };
    const bool is_around = is_even_odd_ ? windings_[ring] % 2 != 0 : windings_[ring] != 0;
    add_part(-1);
    if (is_around) (is_border ? borders_ : holes_)[part] += amount;
    add_part(1);
  }

  bool is_even_odd_;
  std::vector<std::int64_t> windings_;  // by ring
  std::vector<Bounded> bounded_;
  std::vector<std::int64_t> borders_, holes_;  // by part: how many are around
  std::vector<std::int64_t> parts_;            // by polygon
  std::int64_t count_ = 0;
};

class ConstrainedChecker : public Checker {
 public:
  ConstrainedChecker(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles,
                     const std::vector<std::int32_t>* neighbors, const VerifyConstraints& constraints)
      : Checker(coordinates, n, triangles, neighbors),
        constraints_(constraints),
        segments_(*constraints.segments),
        sweep_(places_, predicates_) {}

  VerifyReport run() {
    prove::run_checks(report_, [this] {
      check_form();
      check_coordinates();
      check_indices();
      check_segments();
      check_holes();
      sort_points();
      check_orientations();
      check_representatives();
      match_half_edges();
      cut_segments();
      match_pieces();
      choose_faces();
      check_constraints();
      check_border();
      check_sides();
      check_places();
      if (constraints_.outside == Outside::keep && constraints_.holes == nullptr && covered_.size() > 1) {
        prove::check_count(report_);
      }
      check_circles();
      check_edges();
      check_segment_edges();
      check_labels();
      check_neighbors();
      check_quality();
    });
    report_.exact_evaluations = predicates_.exact_evaluations();
    return report_;
  }

 private:
  std::size_t point_of(std::size_t place) const { return static_cast<std::size_t>(point_of_place_[place]); }
  bool is_constraint(const Piece& piece) const {
    return piece.segment != kHull && static_cast<std::size_t>(piece.segment) < segments_.size() / 2;
  }

  std::string describe_segment(std::size_t s) const {
    const std::size_t count = segments_.size() / 2;
    const std::int32_t* ends = s < count ? &segments_[2 * s] : &border_[2 * (s - count)];
    return fmt::format("{} from {} to {}", s < count ? fmt::format("segment {}", s) : "the border",
                       describe_point(ends[0]), describe_point(ends[1]));
  }
  std::string describe_piece(const Piece& piece) const {
    return fmt::format("the edge from {} to {}",
                       describe_point(point_of(static_cast<std::size_t>(piece.from))),
                       describe_point(point_of(static_cast<std::size_t>(piece.to))));
  }

  void check_segments() {
    if (segments_.size() % 2 != 0) {
      violate("the segments are {} indices, which is not a multiple of 2", segments_.size());
    }
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (segments_[i] < 0 || static_cast<std::size_t>(segments_[i]) >= n_) {
        violate("segment {} has an end {}, which is not the index of one of the {} points", i / 2,
                segments_[i], n_);
      }
    }
  }

  void check_holes() {
    for (std::size_t i = 0; constraints_.holes != nullptr && i < constraints_.holes->size(); ++i) {
      if (!std::isfinite((*constraints_.holes)[i])) violate("hole {} is not finite", i / 2);
    }
  }

  /// Numbers the distinct points in their order, and the places of holes among them. Each stands for the one
  /// that triangles use.
  void number_places() {
    place_of_point_.resize(n_);
    const std::vector<Vertex> holes = sorted_holes();
    place_of_hole_.resize(holes.size());
    auto hole = holes.begin();
    for (std::size_t i = 0; i < n_; ++i) {
      if (starts_group(i)) {
        for (; hole != holes.end() && is_before(*hole, sorted_[i]); ++hole) add_hole(*hole);
        add_place(sorted_[i], true);
        for (; hole != holes.end() && !is_before(sorted_[i], *hole); ++hole)
          place_of_hole_[hole->id] = newest_place();
      }
      const auto index = static_cast<std::int32_t>(sorted_[i].id);
      if (point_of_place_.back() == kNoPoint || used_[index] != 0) point_of_place_.back() = index;
      place_of_point_[index] = newest_place();
    }
    for (; hole != holes.end(); ++hole) add_hole(*hole);
  }
  std::int32_t newest_place() const { return static_cast<std::int32_t>(places_.size()) - 1; }
  void add_place(const Vertex& at, bool is_point) {
    places_.push_back({{at.at[0], at.at[1]}, is_point});
    point_of_place_.push_back(kNoPoint);
  }
  void add_hole(const Vertex& hole) {
    add_place(hole, false);
    place_of_hole_[hole.id] = newest_place();
  }
  std::vector<Vertex> sorted_holes() const {
    std::vector<Vertex> holes;
    for (std::size_t k = 0; constraints_.holes != nullptr && k < constraints_.holes->size() / 2; ++k) {
      holes.push_back({k, {(*constraints_.holes)[2 * k], (*constraints_.holes)[2 * k + 1]}});
    }
    std::stable_sort(holes.begin(), holes.end(), is_before);
    return holes;
  }

  void cut_segments() {
    number_places();
    std::vector<Span> spans;
    for (std::size_t s = 0; s < segments_.size() / 2; ++s) {
      if (first_place(s) == last_place(s)) continue;
      spans.push_back({first_place(s), last_place(s), static_cast<std::int32_t>(s)});
    }
    add_hull(spans, 1);
    add_hull(spans, -1);
    if (is_refined() && constraints_.outside == Outside::keep) add_border(spans);
    const Sweep::Crossing crossing = sweep_.run(spans);
    if (crossing.first >= 0) {
      violate("{} and {} cross at a place that is no point", describe_segment(crossing.first),
              describe_segment(crossing.second));
    }
    for (const Piece& piece : sweep_.pieces()) report_.constraint_edges += is_constraint(piece);
  }

  /// Andrew's chain (1979) below all places, or with turn = -1 above them.
  void add_hull(std::vector<Span>& spans, int turn) {
    std::vector<std::int32_t> chain;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(places_.size()); ++v) {
      if (!places_[v].is_point) continue;
      const auto turns = [&] {
        const double *a = places_[chain[chain.size() - 2]].at, *b = places_[chain.back()].at;
        return predicates_.orient2d(a, b, places_[v].at) == turn;
      };
      while (chain.size() > 1 && !turns()) chain.pop_back();
      chain.push_back(v);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) spans.push_back({chain[i - 1], chain[i], kHull});
  }

  /// Where points on the hull were rounded, the border of a refined mesh is another one.
  void add_border(std::vector<Span>& spans) {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      if (twins_[h] != kNone) continue;
      const std::int32_t a = place_of_point_[origin(h)], b = place_of_point_[target(h)];
      const std::size_t number = segments_.size() / 2 + border_.size() / 2;
      spans.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(number)});
      border_.insert(border_.end(), {origin(h), target(h)});
    }
  }

  /// Finds the piece that each half-edge is, and the triangles beside each piece.
  void match_pieces() {
    first_piece_.assign(places_.size() + 1, 0);
    for (const Piece& piece : sweep_.pieces()) ++first_piece_[piece.from + 1];
    for (std::size_t i = 0; i < places_.size(); ++i) first_piece_[i + 1] += first_piece_[i];
    piece_of_.assign(corners_.size(), kNoPiece);
    above_.assign(sweep_.pieces().size(), kNone);
    below_.assign(sweep_.pieces().size(), kNone);
    for (std::size_t h = 0; h < corners_.size(); ++h) {
      const std::int32_t a = place_of_point_[origin(h)], b = place_of_point_[target(h)];
      piece_of_[h] = find_piece(std::min(a, b), std::max(a, b));
      if (piece_of_[h] == kNoPiece) continue;
      (a < b ? above_ : below_)[piece_of_[h]] = static_cast<std::int64_t>(h / 3);
    }
  }

  /// The piece between two places, or kNoPiece.
  std::int32_t find_piece(std::int32_t from, std::int32_t to) const {
    const auto begin = sweep_.pieces().begin(), end = begin + first_piece_[from + 1];
    const auto found = std::lower_bound(begin + first_piece_[from], end, to,
                                        [](const Piece& piece, std::int32_t v) { return piece.to < v; });
    return found != end && found->to == to ? static_cast<std::int32_t>(found - begin) : kNoPiece;
  }

  /// Decides which faces are to be covered.
  void choose_faces() {
    covered_.assign(sweep_.face_count(), 1);
    covered_[0] = 0;
    const bool by_nesting = constraints_.fill_rule == FillRule::nesting;
    if (constraints_.outside != Outside::keep || constraints_.depths != nullptr) {
      check_closed();
      depths_ = by_nesting                      ? nesting_depths()
                : constraints_.rings != nullptr ? polygon_depths()
                                                : winding_depths();
    }
    if (constraints_.outside != Outside::keep) {
      const bool drops_holes = by_nesting && constraints_.outside == Outside::holes;
      for (std::size_t f = 0; f < covered_.size(); ++f) {
        if (depths_[f] == 0 || (drops_holes && depths_[f] % 2 == 0)) covered_[f] = 0;
      }
    }
    if (is_refined() && constraints_.outside == Outside::keep) drop_slivers();
    drop_seeded();
  }

  /// Points that refinement puts on the hull are rounded, so that there may be slivers between them and it.
  void drop_slivers() {
    std::vector<std::int32_t> hull_piece(covered_.size(), kNoPiece);
    double largest = 0;
    for (std::size_t i = 0; i < sweep_.pieces().size(); ++i) {
      const Piece& piece = sweep_.pieces()[i];
      if (piece.segment == kHull)
        hull_piece[std::max(piece.below, piece.above)] = static_cast<std::int32_t>(i);
      for (const std::int32_t place : {piece.from, piece.to}) {
        for (const double x : places_[place].at) largest = std::max(largest, std::fabs(x));
      }
    }
    const prove::RoundedPlaces rounded(largest);
    std::vector<char> is_wide(covered_.size(), 0);
    for (const Piece& piece : sweep_.pieces()) {
      for (const std::int32_t face : {piece.below, piece.above}) {
        if (hull_piece[face] == kNoPiece) continue;
        const Piece& hull = sweep_.pieces()[hull_piece[face]];
        for (const std::int32_t place : {piece.from, piece.to}) {
          is_wide[face] |=
              !rounded.are_straight(places_[hull.from].at, places_[hull.to].at, places_[place].at);
        }
      }
    }
    for (std::size_t f = 1; f < covered_.size(); ++f) {
      if (hull_piece[f] != kNoPiece && is_wide[f] == 0) covered_[f] = 0;
    }
  }
  bool is_refined() const {
    return constraints_.min_angle > 0 || constraints_.max_area > 0 || constraints_.conforming;
  }

  /// Rules other than nesting need closed curves.
  void check_closed() {
    if (constraints_.fill_rule == FillRule::nesting) return;
    std::vector<std::int32_t> excess(places_.size(), 0);
    const Rings* const rings = constraints_.rings;
    const std::size_t count = rings != nullptr ? rings->segment_offsets.back() : segments_.size() / 2;
    for (std::size_t s = 0; s < count; ++s) {
      for (std::size_t k = 0; k < 2; ++k) {
        std::int32_t& of_place = excess[place_of_point_[segments_[2 * s + k]]];
        of_place += is_even_odd() || k == 1 ? 1 : -1;
      }
    }
    for (std::size_t place = 0; place < places_.size(); ++place) {
      if (is_even_odd() ? excess[place] % 2 == 0 : excess[place] == 0) continue;
      violate("the segments are no closed curves: at {}, {}", describe_point(point_of(place)),
              is_even_odd() ? "an odd number of them ends" : "not as many begin as end");
    }
  }
  bool is_even_odd() const { return constraints_.fill_rule == FillRule::even_odd; }

  /// The faces beyond each piece of a face.
  struct Beyond {
    std::int32_t face, piece;
  };
  std::vector<std::vector<Beyond>> faces_beyond() const {
    std::vector<std::vector<Beyond>> beyond(covered_.size());
    for (std::size_t i = 0; i < sweep_.pieces().size(); ++i) {
      const Piece& piece = sweep_.pieces()[i];
      if (piece.below == piece.above) continue;
      beyond[piece.below].push_back({piece.above, static_cast<std::int32_t>(i)});
      beyond[piece.above].push_back({piece.below, static_cast<std::int32_t>(i)});
    }
    return beyond;
  }

  /// Per face the least number of constraints that a path from the outside crosses.
  std::vector<std::int64_t> nesting_depths() const {
    const std::vector<std::vector<Beyond>> beyond = faces_beyond();
    std::vector<std::int64_t> depths(covered_.size(), -1);
    std::vector<std::int32_t> level = {0}, next;
    for (std::int64_t depth = 0; !level.empty(); ++depth) {
      for (std::size_t i = 0; i < level.size(); ++i) {
        if (depths[level[i]] >= 0) continue;
        depths[level[i]] = depth;
        for (const Beyond& other : beyond[level[i]]) {
          (is_constraint(sweep_.pieces()[other.piece]) ? next : level).push_back(other.face);
        }
      }
      level.swap(next);
      next.clear();
    }
    return depths;
  }

  /// Per face its winding number, or the parity of the number of segments to the outside.
  std::vector<std::int64_t> winding_depths() const {
    const std::vector<std::int64_t> steps = steps_across();
    std::vector<std::int64_t> depths(covered_.size(), 0);
    std::int64_t depth = 0;
    for (const Move& move : tour()) {
      depth += move.sign * steps[move.piece];
      if (move.face != Sweep::kNoFace) depths[move.face] = is_even_odd() ? depth & 1 : depth;
    }
    return depths;
  }

  /// Per piece the number of segments that a step from its right to its left crosses; with winding numbers,
  /// minus the segments that run the other way.
  std::vector<std::int64_t> steps_across() const {
    const PiecesByLine pieces(sweep_);
    // A segment counts from its first piece on, up to the one that begins where it ends.
    std::vector<std::int64_t> changes(pieces.order.size() + 1, 0), steps(pieces.order.size());
    for (std::size_t s = 0; s < segments_.size() / 2; ++s) {
      if (first_place(s) == last_place(s)) continue;
      const std::int64_t step = is_even_odd() || place_of_point_[segments_[2 * s]] == first_place(s) ? 1 : -1;
      changes[pieces.position(s, first_place(s))] += step;
      changes[pieces.position(s, last_place(s))] -= step;
    }
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < pieces.order.size(); ++i) steps[pieces.order[i]] = sum += changes[i];
    return steps;
  }

  /// A step over a piece, from its right to its left or back, into a face that was not reached before, or out
  /// of it again.
  struct Move {
    std::int32_t piece, face;  // kNoFace on the way back
    int sign;
  };
  /// Goes through all faces, from outside and back.
  std::vector<Move> tour() const {
    const std::vector<std::vector<Beyond>> beyond = faces_beyond();
    std::vector<char> reached(covered_.size(), 0);
    std::vector<Move> moves, open;
    const auto look_around = [&](std::int32_t face) {
      reached[face] = 1;
      for (const Beyond& other : beyond[face]) {
        const bool is_upward = sweep_.pieces()[other.piece].below == face;
        open.push_back({other.piece, other.face, is_upward ? 1 : -1});
      }
    };
    look_around(0);
    while (!open.empty()) {
      const Move move = open.back();
      open.pop_back();
      if (move.face != Sweep::kNoFace && reached[move.face] != 0) continue;
      moves.push_back(move);
      if (move.face == Sweep::kNoFace) continue;
      open.push_back({move.piece, Sweep::kNoFace, -move.sign});
      look_around(move.face);
    }
    return moves;
  }

  /// Per face the number of polygons that contain it.
  std::vector<std::int64_t> polygon_depths() const {
    const std::vector<Move> moves = tour();
    // The rings of each piece on the tour, negative if they run back.
    std::vector<std::vector<std::int64_t>> rings_at(sweep_.pieces().size());
    std::vector<char> is_on_way(rings_at.size(), 0);
    for (const Move& move : moves) is_on_way[move.piece] = 1;
    const PiecesByLine pieces(sweep_);
    std::vector<std::size_t> next(pieces.order.size() + 1, pieces.order.size());
    for (std::size_t i = pieces.order.size(); i-- > 0;) {
      next[i] = is_on_way[pieces.order[i]] != 0 ? i : next[i + 1];
    }
    const std::vector<std::size_t>& offsets = constraints_.rings->segment_offsets;
    for (std::size_t r = 0; r + 1 < offsets.size(); ++r) {
      for (std::size_t s = offsets[r]; s < offsets[r + 1]; ++s) {
        if (first_place(s) == last_place(s)) continue;
        const bool is_forward = place_of_point_[segments_[2 * s]] == first_place(s);
        const std::size_t end = pieces.position(s, last_place(s));
        for (std::size_t i = next[pieces.position(s, first_place(s))]; i < end; i = next[i + 1]) {
          const auto number = static_cast<std::int64_t>(r) + 1;
          rings_at[pieces.order[i]].push_back(is_forward ? number : -number);
        }
      }
    }
    std::vector<std::int64_t> depths(covered_.size(), 0);
    PolygonsAround around(*constraints_.rings, is_even_odd());
    for (const Move& move : moves) {
      for (const std::int64_t ring : rings_at[move.piece]) {
        around.cross(static_cast<std::size_t>(std::abs(ring)) - 1, ring < 0 ? -move.sign : move.sign);
      }
      if (move.face != Sweep::kNoFace) depths[move.face] = around.count();
    }
    return depths;
  }

  std::int32_t first_place(std::size_t segment) const {
    return std::min(place_of_point_[segments_[2 * segment]], place_of_point_[segments_[2 * segment + 1]]);
  }
  std::int32_t last_place(std::size_t segment) const {
    return std::max(place_of_point_[segments_[2 * segment]], place_of_point_[segments_[2 * segment + 1]]);
  }

  /// Pieces by line, in their order on it.
  struct PiecesByLine {
    const Sweep& sweep;
    std::vector<std::int32_t> first, order;

    explicit PiecesByLine(const Sweep& of)
        : sweep(of), first(of.line_count() + 1, 0), order(of.pieces().size()) {
      for (const Piece& piece : sweep.pieces()) ++first[piece.line + 1];
      for (std::size_t l = 0; l < sweep.line_count(); ++l) first[l + 1] += first[l];
      std::vector<std::int32_t> next(first.begin(), first.end() - 1);
      for (std::size_t i = 0; i < order.size(); ++i) {
        order[next[sweep.pieces()[i].line]++] = static_cast<std::int32_t>(i);
      }
    }
    /// Where a segment's piece from a place is in `order`; behind its last one if it ends there.
    std::size_t position(std::size_t segment, std::int32_t place) const {
      const std::int32_t line = sweep.line_of_segment()[segment];
      const auto found = std::lower_bound(
          order.begin() + first[line], order.begin() + first[line + 1], place,
          [this](std::int32_t piece, std::int32_t v) { return sweep.pieces()[piece].from < v; });
      return static_cast<std::size_t>(found - order.begin());
    }
  };

  /// Leaves out the faces of holes.
  void drop_seeded() {
    for (std::size_t k = 0; k < place_of_hole_.size(); ++k) {
      const double* at = places_[place_of_hole_[k]].at;
      const std::int32_t face = sweep_.face_of_place()[place_of_hole_[k]];
      if (face == Sweep::kNoFace) violate("hole {} at ({}, {}) is on a segment", k, at[0], at[1]);
      if (face == 0) violate("hole {} at ({}, {}) is outside of the convex hull", k, at[0], at[1]);
      covered_[face] = 0;
    }
  }

  /// Every part of a segment that borders on a covered face must be an edge.
  void check_constraints() {
    const Piece* missing = nullptr;
    for (std::size_t i = 0; i < sweep_.pieces().size(); ++i) {
      const Piece& piece = sweep_.pieces()[i];
      if (!is_constraint(piece) || below_[i] != kNone || above_[i] != kNone) continue;
      if (covered_[piece.below] == 0 && covered_[piece.above] == 0) continue;
      if (missing == nullptr || piece.segment < missing->segment) missing = &piece;
    }
    if (missing == nullptr) return;
    violate("{} is no chain of edges: {} is missing", describe_segment(missing->segment),
            describe_piece(*missing));
  }

  void check_border() {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      if (twins_[h] != kNone) continue;
      ++report_.hull_vertices;
      if (piece_of_[h] != kNoPiece) continue;
      violate(
          "{} has no triangle beyond the edge from point {} to point {}, which is neither on the hull nor a "
          "constraint",
          describe_row(h / 3), origin(h), target(h));
    }
    if (twins_.empty() && covered_.size() == 1) report_.hull_vertices = report_.distinct_points;
  }

  void check_sides() {
    for (std::size_t i = 0; i < sweep_.pieces().size(); ++i) {
      const Piece& piece = sweep_.pieces()[i];
      check_side(piece, "right", piece.below, below_[i]);
      check_side(piece, "left", piece.above, above_[i]);
    }
  }
  void check_side(const Piece& piece, const char* side, std::int32_t face, std::int64_t triangle) {
    if ((triangle != kNone) == (covered_[face] != 0)) return;
    if (triangle == kNone) {
      violate("there is no triangle on the {} of {}, which is inside", side, describe_piece(piece));
    }
    violate("{} is outside, on the {} of {}", describe_row(static_cast<std::size_t>(triangle)), side,
            describe_piece(piece));
  }

  /// Places on the border of a covered face are ends of edges, which were found.
  void check_places() {
    for (std::size_t place = 0; place < places_.size(); ++place) {
      if (!places_[place].is_point) continue;
      const std::int32_t face = sweep_.face_of_place()[place];
      const auto i = static_cast<std::size_t>(point_of_place_[place]);
      if (face == Sweep::kNoFace || covered_[face] == 0 || used_[i] != 0) continue;
      violate("{} is in no triangle", describe_point(i));
    }
  }

  void check_circles() {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      // On the border, or checked from the other side.
      if (twins_[h] < static_cast<std::int64_t>(h)) continue;
      if (piece_of_[h] != kNoPiece && is_constraint(sweep_.pieces()[piece_of_[h]])) continue;
      if (check_circle(h)) check_fan(h);
    }
  }

  void check_fan(std::size_t h) {
    const auto place = [this](std::int32_t v) { return place_of_point_[v]; };
    const std::int32_t a = origin(h), b = target(h), c = corners_[h], d = corners_[twins_[h]];
    const std::int32_t first = place(c) < place(d) ? c : d;
    if (std::min(place(a), place(b)) < place(first)) return;
    violate(
        "{} and triangle {} are on one circle, but their edge from point {} to point {} does not begin at "
        "{}, the lexicographically smallest of their corners",
        describe_row(h / 3), twins_[h] / 3, a, b, describe_point(first));
  }

  /// The given edges must be the parts of the segments, each once, its smaller end first.
  void check_edges() {
    if (constraints_.edges == nullptr) return;
    const std::vector<std::int32_t>& edges = *constraints_.edges;
    if (edges.size() != 2 * report_.constraint_edges) {
      violate("there are {} indices in the constraint edges, but the segments are made of {} edges",
              edges.size(), report_.constraint_edges);
    }
    std::vector<char> listed(sweep_.pieces().size(), 0);
    for (std::size_t e = 0; e < edges.size() / 2; ++e) {
      const std::int32_t piece = piece_between(edges[2 * e], edges[2 * e + 1]);
      if (piece == kNoPiece) {
        violate(
            "constraint edge {} from point {} to point {} is no part of a segment, or is the wrong way round",
            e, edges[2 * e], edges[2 * e + 1]);
      }
      if (listed[piece] != 0) {
        violate("constraint edge {} from point {} to point {} is listed twice", e, edges[2 * e],
                edges[2 * e + 1]);
      }
      listed[piece] = 1;
    }
  }

  /// The constraint from one point to a later one; kNoPiece if no constraint joins them, or if another point
  /// represents one of them.
  std::int32_t piece_between(std::int32_t a, std::int32_t b) const {
    if (!is_representative(a) || !is_representative(b)) return kNoPiece;
    const std::int32_t piece = find_piece(place_of_point_[a], place_of_point_[b]);
    return piece != kNoPiece && is_constraint(sweep_.pieces()[piece]) ? piece : kNoPiece;
  }
  bool is_representative(std::int32_t v) const {
    return v >= 0 && static_cast<std::size_t>(v) < n_ && point_of_place_[place_of_point_[v]] == v;
  }

  /// Each segment's edges must lead straight from its smaller end to the other one.
  void check_segment_edges() {
    if (constraints_.segment_edges == nullptr || constraints_.edges == nullptr) return;
    const std::vector<std::int32_t>& ranges = *constraints_.segment_edges;
    const std::vector<std::int32_t>& edges = *constraints_.edges;
    if (ranges.size() != segments_.size()) {
      violate("there are {} indices of segments' edges, but there should be {}", ranges.size(),
              segments_.size());
    }
    // The number of edges before each edge whose next edge does not continue straight.
    const auto count = static_cast<std::int32_t>(edges.size() / 2);
    std::vector<std::int32_t> bends(edges.size() / 2 + 1, 0);
    for (std::int32_t e = 0; e + 1 < count; ++e) {
      const std::int32_t a = edges[2 * e], b = edges[2 * e + 1], c = edges[2 * e + 3];
      const bool goes_on = edges[2 * e + 2] == b && predicates_.orient2d(point(a), point(b), point(c)) == 0;
      bends[e + 1] = bends[e] + (goes_on ? 0 : 1);
    }
    for (std::size_t s = 0; s < segments_.size() / 2; ++s) {
      const std::int32_t first = ranges[2 * s], last = ranges[2 * s + 1];
      const bool is_right = first_place(s) == last_place(s)
                                ? first == 0 && last == 0
                                : first >= 0 && first < last && last <= count &&
                                      place_of_point_[edges[2 * first]] == first_place(s) &&
                                      place_of_point_[edges[2 * last - 1]] == last_place(s) &&
                                      bends[last - 1] == bends[first];
      if (!is_right) violate("the edges [{}, {}) are not those of {}", first, last, describe_segment(s));
    }
  }

  void check_labels() {
    if (constraints_.depths == nullptr && constraints_.regions == nullptr) return;
    for (const auto* const labels : {constraints_.depths, constraints_.regions}) {
      if (labels != nullptr && labels->size() != report_.triangles) {
        violate("there are {} depths or regions, but {} triangles", labels->size(), report_.triangles);
      }
    }
    const std::vector<std::int32_t> faces = faces_of_triangles();
    std::vector<std::int32_t> regions(covered_.size(), -1);
    std::int32_t count = 0;
    for (std::size_t t = 0; t < report_.triangles; ++t) {
      std::int32_t& region = regions[faces[t]];
      if (region < 0) region = count++;
      if (constraints_.depths != nullptr && (*constraints_.depths)[t] != depths_[faces[t]]) {
        violate("{} has depth {}, but it should be {}", describe_row(t), (*constraints_.depths)[t],
                depths_[faces[t]]);
      }
      if (constraints_.regions != nullptr && (*constraints_.regions)[t] != region) {
        violate("{} has region {}, but it should be {}", describe_row(t), (*constraints_.regions)[t], region);
      }
    }
  }

  /// Every face has triangles beside its pieces, and the others are connected with these.
  std::vector<std::int32_t> faces_of_triangles() const {
    std::vector<std::int32_t> faces(report_.triangles, Sweep::kNoFace);
    std::vector<std::size_t> open;
    const auto enter = [&](std::int64_t triangle, std::int32_t face) {
      if (triangle == kNone || faces[triangle] != Sweep::kNoFace) return;
      faces[triangle] = face;
      open.push_back(static_cast<std::size_t>(triangle));
    };
    for (std::size_t i = 0; i < sweep_.pieces().size(); ++i) {
      enter(below_[i], sweep_.pieces()[i].below);
      enter(above_[i], sweep_.pieces()[i].above);
    }
    while (!open.empty()) {
      const std::size_t t = open.back();
      open.pop_back();
      for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (piece_of_[h] == kNoPiece) enter(twins_[h] / 3, faces[t]);
      }
    }
    return faces;
  }

  void check_quality() {
    if (!is_refined()) return;
    const double area = constraints_.max_area;
    const constrained::QualityBounds bounds = constrained::quality_bounds(constraints_.min_angle);
    const std::vector<std::int32_t>* const worse = constraints_.worse;
    for (std::size_t t = 0; t < report_.triangles; ++t) {
      if (worse != nullptr && std::binary_search(worse->begin(), worse->end(), static_cast<std::int32_t>(t)))
        continue;
      const double *a = point(corners_[3 * t]), *b = point(corners_[3 * t + 1]),
                   *c = point(corners_[3 * t + 2]);
      if (area > 0 && std::isfinite(area) && predicates_.compare_area(a, b, c, area) > 0) {
        const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        violate("{} has the area {}, which is above {}", describe_row(t), twice / 2, area);
      }
      check_angles(t, bounds.squared_sine);
    }
    for (std::size_t h = 0; worse == nullptr && h < corners_.size(); ++h) {
      if (piece_of_[h] == kNoPiece) continue;
      const double *a = point(origin(h)), *b = point(target(h)), *c = point(corners_[h]);
      const double cosine = constraints_.conforming ? 0 : -bounds.squared_cosine;
      const int sign = predicates_.compare_cosine(c, a, b, cosine);
      if (sign > 0 || (sign == 0 && constraints_.conforming)) continue;
      violate("{} is encroached: {} of triangle {} sees it at {} degrees",
              describe_piece(sweep_.pieces()[piece_of_[h]]), describe_point(corners_[h]), h / 3, angle_at(h));
    }
  }

  /// The smallest angle, or each of several, decides.
  void check_angles(std::size_t t, double squared_sine) {
    bool is_excused = false;
    std::size_t smallest = 3 * t;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t h = 3 * t + k, next = 3 * t + (k + 1) % 3, last = 3 * t + (k + 2) % 3;
      const double *c = point(corners_[h]), *a = point(corners_[next]), *b = point(corners_[last]);
      if (predicates_.compare_lengths(b, a, c) > 0 || predicates_.compare_lengths(a, b, c) > 0) continue;
      if (predicates_.compare_sine(c, a, b, squared_sine) >= 0) return;
      smallest = h;
      is_excused = is_excused || (piece_of_[next] != kNoPiece && piece_of_[last] != kNoPiece) ||
                   (piece_of_[h] == kNoPiece && is_across_apex(corners_[next], corners_[last]));
    }
    if (!is_excused) {
      violate("{} has an angle of {} degrees at point {}, which is below {}", describe_row(t),
              angle_at(smallest), corners_[smallest], constraints_.min_angle);
    }
    ++report_.excused_triangles;
  }

  bool is_across_apex(std::int32_t p, std::int32_t q) {
    return apexes().are_shells(p, q, [this](std::int32_t apex, std::int32_t first, std::int32_t last) {
      const std::int32_t from = place_of_point_[apex], to = place_of_point_[first];
      std::int64_t t = (from < to ? above_ : below_)[find_piece(std::min(from, to), std::max(from, to))];
      while (t != kNone) {
        std::size_t back = 3 * static_cast<std::size_t>(t);  // the half-edge that ends at the apex
        while (target(back) != apex) ++back;
        if (origin(back) == last) return true;
        t = twins_[back] == kNone ? kNone : twins_[back] / 3;
      }
      return false;
    });
  }

  /// At the corner opposite to a half-edge, in degrees.
  double angle_at(std::size_t h) const {
    const double *a = point(origin(h)), *b = point(target(h)), *c = point(corners_[h]);
    double ux = a[0] - c[0], uy = a[1] - c[1], vx = b[0] - c[0], vy = b[1] - c[1];
    // Lengths near 1, whose products are doubles.
    for (double* const x : {&ux, &uy}) *x = std::ldexp(*x, -std::ilogb(std::hypot(a[0] - c[0], a[1] - c[1])));
    for (double* const x : {&vx, &vy}) *x = std::ldexp(*x, -std::ilogb(std::hypot(b[0] - c[0], b[1] - c[1])));
    return std::atan2(ux * vy - uy * vx, ux * vx + uy * vy) * 180 / std::acos(-1.0);
  }

  /// The apexes of edges that are constraints or on the border of the covered faces.
  Apexes& apexes() {
    if (apexes_ == nullptr) {
      std::vector<std::int32_t> edges;
      for (std::size_t i = 0; i < sweep_.pieces().size(); ++i) {
        if (below_[i] == kNone && above_[i] == kNone) continue;
        const Piece& piece = sweep_.pieces()[i];
        edges.push_back(static_cast<std::int32_t>(point_of(static_cast<std::size_t>(piece.from))));
        edges.push_back(static_cast<std::int32_t>(point_of(static_cast<std::size_t>(piece.to))));
      }
      apexes_ = std::make_unique<Apexes>(coordinates_, n_, edges, predicates_);
    }
    return *apexes_;
  }

  const VerifyConstraints& constraints_;
  const std::vector<std::int32_t>& segments_;
  std::unique_ptr<Apexes> apexes_;
  std::vector<Place> places_;
  std::vector<std::int32_t> place_of_point_, point_of_place_, place_of_hole_;
  std::vector<std::int32_t> border_;  // 2 points per edge of a refined mesh that one triangle has
  Sweep sweep_;
  std::vector<std::int32_t> first_piece_;    // by place: of those that begin there, and the number of all
  std::vector<std::int32_t> piece_of_;       // by half-edge
  std::vector<std::int64_t> below_, above_;  // by piece: the triangles on its right and on its left, or kNone
  std::vector<std::int64_t> depths_;         // by face
  std::vector<char> covered_;                // by face
};

}  // namespace

VerifyReport verify_constrained(const double* coordinates, std::size_t n,
                                const std::vector<std::int32_t>& triangles,
                                const std::vector<std::int32_t>* neighbors,
                                const VerifyConstraints& constraints) {
  return ConstrainedChecker(coordinates, n, triangles, neighbors, constraints).run();
}

}  // namespace flaunay
