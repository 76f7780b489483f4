#include "prove/sweep.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace flaunay::prove {

Sweep::Crossing Sweep::run(const std::vector<Span>& spans) {
  begin(spans);
  for (std::size_t place = 0; place < places_.size() && crossing_.first < 0; ++place) {
    pass(static_cast<std::int32_t>(place));
  }
  if (crossing_.first < 0) {
    number_faces();
    sort_pieces();
  }
  return crossing_;
}

/// Sorts the spans by their first place.
void Sweep::begin(const std::vector<Span>& spans) {
  face_of_place_.assign(places_.size(), kNoFace);
  first_span_.assign(places_.size() + 1, 0);
  std::int32_t segments = 0;
  for (const Span& span : spans) {
    ++first_span_[span.from + 1];
    segments = std::max(segments, span.segment + 1);
  }
  line_of_segment_.assign(static_cast<std::size_t>(segments), kNoLine);
  for (std::size_t i = 0; i < places_.size(); ++i) first_span_[i + 1] += first_span_[i];
  sorted_.resize(spans.size());
  std::vector<std::int32_t> next(first_span_.begin(), first_span_.end() - 1);
  for (const Span& span : spans) sorted_[next[span.from]++] = span;
}

/// At the later one of the places where they begin. A span that begins on another one cuts that, so it is
/// strictly beside it, unless both begin there.
bool Sweep::is_below(const Active& a, const Active& b) const {
  if (a.from == b.from) return orient(a.from, a.to(), b.to()) > 0;
  if (a.from < b.from) return orient(a.from, a.to(), b.from) > 0;
  return orient(b.from, b.to(), a.from) < 0;
}

void Sweep::pass(std::int32_t place) {
  const auto first = active_.lower_bound(place);
  const bool is_lowest = first == active_.begin();
  const std::int32_t bottom = is_lowest ? 0 : std::prev(first)->above;
  top_ = bottom;
  meets_segment_ = false;
  leaving_.clear();
  if (!places_[place].is_point) {
    if (first == active_.end() || side(*first, place) != 0) {
      face_of_place_[place] = bottom;
    } else if (first->segment_to == 0) {
      on_hull_.push_back({place, first->below, first->above});
    }
    return;
  }
  const auto next = end_pieces(place, first);
  const bool ends_any = !pieces_.empty() && pieces_.back().to == place;
  for (std::int32_t i = first_span_[place]; i < first_span_[place + 1]; ++i) {
    const bool is_hull = sorted_[i].segment == kHull;
    meets_segment_ = meets_segment_ || !is_hull;
    leaving_.push_back({place, sorted_[i].segment, is_hull ? 0 : sorted_[i].to, is_hull ? sorted_[i].to : 0});
  }
  if (ends_any && !meets_segment_) on_hull_.push_back({place, pieces_.back().below, pieces_.back().above});
  if (leaving_.empty()) {
    unite(bottom, top_);
    if (!ends_any) face_of_place_[place] = bottom;
    if (ends_any && !is_lowest && next != active_.end()) check_crossing(*std::prev(next), *next);
    return;
  }
  merge_leaving(place);
  std::int32_t below = bottom;
  for (std::size_t i = 0; i < leaving_.size(); ++i) {
    leaving_[i].below = below;
    below = leaving_[i].above = i + 1 < leaving_.size() ? new_face() : top_;
    const auto inserted = active_.insert(next, leaving_[i]);
    if (i == 0 && !is_lowest) check_crossing(*std::prev(inserted), *inserted);
  }
  if (!ends_any && !meets_segment_) on_hull_.push_back({place, leaving_[0].below, leaving_[0].above});
  if (next != active_.end()) check_crossing(leaving_.back(), *next);
}

/// Ends the pieces of all active spans through the place, and moves spans that continue to leaving_. Returns
/// the span above.
Sweep::Status::iterator Sweep::end_pieces(std::int32_t place, Status::iterator first) {
  while (first != active_.end() && side(*first, place) == 0) {
    Active rest = *first;
    pieces_.push_back(
        {rest.from, place, rest.segment_to > 0 ? rest.segment : kHull, rest.below, rest.above, rest.line});
    top_ = rest.above;
    meets_segment_ = meets_segment_ || rest.segment_to > 0;
    if (rest.to() > place) {
      rest.from = place;
      if (rest.segment_to <= place) rest.segment_to = 0;
      if (rest.hull_to <= place) rest.hull_to = 0;
      leaving_.push_back(rest);
    }
    first = active_.erase(first);
  }
  return first;
}

/// Sorts the spans that leave a place by direction, and merges spans with the same direction.
void Sweep::merge_leaving(std::int32_t place) {
  std::sort(leaving_.begin(), leaving_.end(),
            [this, place](const Active& a, const Active& b) { return orient(place, a.to(), b.to()) > 0; });
  std::size_t count = 0;
  for (std::size_t first = 0, last = 0; first < leaving_.size(); first = last) {
    while (last < leaving_.size() && orient(place, leaving_[first].to(), leaving_[last].to()) == 0) ++last;
    leaving_[count++] = merged(first, last);
  }
  leaving_.resize(count);
}

/// Merges spans with one direction. The result extends to their furthest ends and keeps the line of a span
/// that came through the place, otherwise it gets a new line. The smallest segment that ends there counts.
Sweep::Active Sweep::merged(std::size_t first, std::size_t last) {
  Active all = leaving_[first];
  for (std::size_t i = first; i < last; ++i) {
    const Active& other = leaving_[i];
    if (std::pair(other.segment_to, all.segment) > std::pair(all.segment_to, other.segment)) {
      all.segment_to = other.segment_to;
      all.segment = other.segment;
    }
    all.hull_to = std::max(all.hull_to, other.hull_to);
    all.line = std::max(all.line, other.line);
  }
  if (all.line == kNoLine) all.line = static_cast<std::int32_t>(line_count_++);
  for (std::size_t i = first; i < last; ++i) {
    const Active& other = leaving_[i];
    if (other.line == kNoLine && other.segment != kHull) line_of_segment_[other.segment] = all.line;
  }
  return all;
}

/// Checks two spans that have just become neighbours.
void Sweep::check_crossing(const Active& lower, const Active& upper) {
  const bool crosses = lower.to() < upper.to()   ? orient(upper.from, upper.to(), lower.to()) > 0
                       : upper.to() < lower.to() ? orient(lower.from, lower.to(), upper.to()) < 0
                                                 : false;
  if (crosses && !crosses_at_place(lower, upper)) crossing_ = {lower.segment, upper.segment};
}

bool Sweep::crosses_at_place(const Active& a, const Active& b) const {
  std::int32_t low = std::max(a.from, b.from), high = std::min(a.to(), b.to());
  while (high - low > 1) {
    const std::int32_t middle = low + (high - low) / 2;
    const int side =
        predicates_.compare_with_crossing(at(a.from), at(a.to()), at(b.from), at(b.to()), at(middle));
    if (side == 0) return true;
    (side < 0 ? low : high) = middle;
  }
  return false;
}

std::int32_t Sweep::new_face() {
  faces_.push_back(static_cast<std::int32_t>(faces_.size()));
  return faces_.back();
}
std::int32_t Sweep::find(std::int32_t face) {
  while (faces_[face] != face) face = faces_[face] = faces_[faces_[face]];
  return face;
}
/// The smaller number remains, so that of the outer face does.
void Sweep::unite(std::int32_t a, std::int32_t b) {
  a = find(a);
  b = find(b);
  faces_[std::max(a, b)] = std::min(a, b);
}

void Sweep::number_faces() {
  std::vector<std::int32_t> number(faces_.size());
  std::int32_t count = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const std::int32_t root = find(static_cast<std::int32_t>(f));
    number[f] = root == static_cast<std::int32_t>(f) ? count++ : number[root];
  }
  for (Piece& piece : pieces_) {
    piece.below = number[piece.below];
    piece.above = number[piece.above];
  }
  for (std::int32_t& face : face_of_place_) {
    if (face != kNoFace) face = number[face];
  }
  // Beyond the hull is face 0.
  for (const OnHull& at : on_hull_) face_of_place_[at.place] = std::max(number[at.below], number[at.above]);
  face_count_ = static_cast<std::size_t>(count);
}

void Sweep::sort_pieces() {
  std::sort(pieces_.begin(), pieces_.end(),
            [](const Piece& a, const Piece& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
}

}  // namespace flaunay::prove
