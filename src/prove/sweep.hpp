// Segments between points, cut at all points on them, and the faces of the plane between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "prove/exact.hpp"

namespace flaunay::prove {

/// Distinct places in lexicographic order.
struct Place {
  double at[2];
  bool is_point = true;  ///< whether it cuts spans; otherwise only its face is asked for
};

/// A segment or hull edge to be cut, from a place to a later one.
struct Span {
  std::int32_t from, to;
  std::int32_t segment;  ///< its number, or kHull
};
constexpr std::int32_t kHull = -1;

/// Between places that follow each other on a span.
struct Piece {
  std::int32_t from, to;
  std::int32_t segment;       ///< a segment of which it is a part; kHull if no segment covers it
  std::int32_t below, above;  ///< the faces on its right and on its left
  std::int32_t line;          ///< pieces of one span are on one line
};

/// A plane sweep over all places (Shamos and Hoey 1976), in lexicographic order. Spans that overlap on a line
/// are held as one, up to the furthest of their ends: so time is O((n + s + k) log (n + s)) for n places, s
/// spans and k pieces, however often spans overlap.
class Sweep {
 public:
  Sweep(const std::vector<Place>& places, ExactPredicates& predicates)
      : places_(places), predicates_(predicates), active_(Below{this}), faces_(1, 0) {}

  /// Two segments that cross at a place that is not among the given ones; -1 if none do.
  struct Crossing {
    std::int32_t first = -1, second = -1;
  };
  /// Ends at the first crossing that it finds.
  Crossing run(const std::vector<Span>& spans);

  /// Sorted by `from`, then by `to`.
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// The line of each segment's pieces; kNoLine if no span had this segment.
  const std::vector<std::int32_t>& line_of_segment() const { return line_of_segment_; }
  static constexpr std::int32_t kNoLine = -1;
  std::size_t line_count() const { return line_count_; }
  /// The face of each place: the face that contains it, or for a place on the hull the face next to it;
  /// kNoFace if the place is on a segment.
  const std::vector<std::int32_t>& face_of_place() const { return face_of_place_; }
  static constexpr std::int32_t kNoFace = -1;
  /// Faces are numbered from 0, which is outside of everything.
  std::size_t face_count() const { return face_count_; }

 private:
  // Overlapping spans on one line, from a common place to the furthest end of segments, and of hull edges; 0
  // if the line has none.
  struct Active {
    std::int32_t from;
    std::int32_t segment, segment_to, hull_to;
    std::int32_t below = 0, above = 0;
    std::int32_t line = kNoLine;
    std::int32_t to() const { return segment_to > hull_to ? segment_to : hull_to; }
  };
  // From below to above, at the place of the sweep.
  struct Below {
    using is_transparent = void;
    const Sweep* sweep;
    bool operator()(const Active& a, const Active& b) const { return sweep->is_below(a, b); }
    bool operator()(const Active& a, std::int32_t place) const { return sweep->side(a, place) > 0; }
    bool operator()(std::int32_t place, const Active& a) const { return sweep->side(a, place) < 0; }
  };
  using Status = std::set<Active, Below>;

  const double* at(std::int32_t place) const { return places_[place].at; }
  int orient(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return predicates_.orient2d(at(a), at(b), at(c));
  }
  int side(const Active& a, std::int32_t place) const {
    return a.to() == place ? 0 : orient(a.from, a.to(), place);
  }
  bool is_below(const Active& a, const Active& b) const;

  void begin(const std::vector<Span>& spans);
  void pass(std::int32_t place);
  Status::iterator end_pieces(std::int32_t place, Status::iterator first);
  void merge_leaving(std::int32_t place);
  Active merged(std::size_t first, std::size_t last);
  void check_crossing(const Active& lower, const Active& upper);
  bool crosses_at_place(const Active& a, const Active& b) const;
  std::int32_t new_face();
  std::int32_t find(std::int32_t face);
  void unite(std::int32_t a, std::int32_t b);
  void number_faces();
  void sort_pieces();

  const std::vector<Place>& places_;
  ExactPredicates& predicates_;
  std::vector<std::int32_t> first_span_;  // by place: of those that begin there in sorted_, and the number
  std::vector<Span> sorted_;
  Status active_;
  std::vector<Active> leaving_;  // those that leave the place of the sweep
  std::int32_t top_ = 0;         // the face above the pieces that end there
  bool meets_segment_ = false;   // whether a segment goes through it
  Crossing crossing_;
  std::vector<std::int32_t> line_of_segment_;
  std::size_t line_count_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::int32_t> faces_;  // union and find
  std::vector<std::int32_t> face_of_place_;
  struct OnHull {
    std::int32_t place, below, above;
  };
  std::vector<OnHull> on_hull_;  // places on no segment, and the faces beside the hull edge that they are on
  std::size_t face_count_ = 1;
};

}  // namespace flaunay::prove
