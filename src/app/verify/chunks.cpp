#include "app/verify/chunks.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "app/verify/buffer.hpp"
#include "app/verify/open_edges.hpp"
#include "app/verify/vertex_index.hpp"
#include "app/verify/window.hpp"
#include "files/scratch.hpp"
#include "host/native/threads.hpp"
#include "prove/describe.hpp"

namespace flaunay {
namespace prove {
namespace {

/// A point, and whether a row uses it.
struct Candidate {
  Vertex vertex;
  std::uint64_t unused;  // 1 or 0
};

/// Orders by coordinates; among equal points, used ones come first.
struct ByPlace {
  bool operator()(const Candidate& a, const Candidate& b) const {
    if (!is_same_place(a.vertex, b.vertex)) return is_before(a.vertex, b.vertex);
    return a.unused != b.unused ? a.unused < b.unused : a.vertex.id < b.vertex.id;
  }
};

/// Marks places in a bitmap by a hash of the coordinates.
class PlaceFilter {
 public:
  explicit PlaceFilter(std::uint64_t bits) : words_(bits / 64 + 1) {}
  void insert(const double* at) {
    if (!cleared_) std::fill_n(words_.data(), words_.size(), 0);
    cleared_ = true;
    const std::uint64_t place = place_of(at);
    words_[place / 64] |= std::uint64_t{1} << place % 64;
  }
  bool may_contain(const double* at) const {
    const std::uint64_t place = place_of(at);
    return (words_[place / 64] >> place % 64 & 1) != 0;
  }

 private:
  static std::uint64_t mixed(std::uint64_t value) {  // the finalizer of MurmurHash3
    value = (value ^ value >> 33) * 0xff51afd7ed558ccdu;
    value = (value ^ value >> 33) * 0xc4ceb9fe1a85ec53u;
    return value ^ value >> 33;
  }
  std::uint64_t place_of(const double* at) const {
    std::uint64_t bits[2];
    for (int axis = 0; axis < 2; ++axis) {
      const double value = at[axis] + 0.0;  // -0 becomes 0
      std::memcpy(&bits[axis], &value, sizeof value);
    }
    return mixed(mixed(bits[0]) + 0x9e3779b97f4a7c15u * bits[1]) % (64 * words_.size());
  }

  Buffer<std::uint64_t> words_;
  bool cleared_ = false;
};

/// Objects that threads take in turns.
template <typename Object>
class Pool {
 public:
  explicit Pool(std::function<std::unique_ptr<Object>()> make) : make_(std::move(make)) {}

  /// Goes back to the pool when it is dropped.
  auto take() {
    const auto give_back = [this](Object* object) {
      const std::lock_guard<std::mutex> lock(mutex_);
      free_.emplace_back(object);
    };
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.empty()) free_.push_back(make_());
    std::unique_ptr<Object, decltype(give_back)> taken(free_.back().release(), give_back);
    free_.pop_back();
    return taken;
  }
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (const auto& object : free_) visit(*object);
  }

 private:
  std::function<std::unique_ptr<Object>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Object>> free_;
};

class ChunkChecker {
 public:
  ChunkChecker(PointSource& points, io::RowSource& triangles, io::RowSource* neighbors,
               const VerifySizes& sizes, const VerifyChunksOptions& options)
      : points_(points),
        triangles_(triangles),
        neighbors_(neighbors),
        sizes_(sizes),
        options_(options),
        n_(points.size()),
        rows_(triangles.size()) {
    report_.points = n_;
    report_.triangles = rows_;
  }

  VerifyChunksReport run() {
    run_checks(report_, [this] {
      check_form();
      rows_ == 0 ? check_collinear() : check_mesh();
    });
    report_.exact_evaluations += predicates_.exact_evaluations();
    return report_;
  }

 private:
  /// Vertices of a window that are of one range, ascending: `count` entries of vertex_file_ from `begin` on.
  struct Segment {
    std::uint64_t range, begin, count;
  };
  struct WindowPlan {
    std::vector<Segment> segments;  // ascending
    std::uint64_t vertices = 0;
    std::uint64_t coordinates_begin = 0;  // in points of coordinate_file_
  };

  void tell(const std::string& stage, double done) {
    const std::lock_guard<std::mutex> lock(progress_mutex_);
    if (options_.progress) options_.progress(stage, done);
  }

  void check_form() const {
    if (neighbors_ != nullptr && neighbors_->size() != rows_) {
      violate("there are {} neighbors, but there should be 3 for each of the {} triangles",
              3 * neighbors_->size(), rows_);
    }
  }

  void check_mesh() {
    const std::uint64_t most = std::max<std::uint64_t>(1, sizes_.window_rows);
    windows_.resize((rows_ + most - 1) / most);
    window_rows_ = (rows_ + windows_.size() - 1) / windows_.size();
    report_.windows = windows_.size();
    collect_vertices();
    place_vertices();
    if (used_ < n_) check_unused();
    filter_.reset();
    check_windows();
    check_count(report_);
  }

  // ------------------------------------------------------------------------------------ points, in ranges

  /// Reads the points [first, first + count).
  void read_points(std::uint64_t first, std::uint64_t count, double* coordinates) {
    for (std::uint64_t done = 0; done < count;) {
      const std::size_t part = std::min<std::uint64_t>(sizes_.piece_rows, count - done);
      double* const to = coordinates + 2 * done;
      points_.read(first + done, part, to);
      for (std::size_t i = 0; i < part; ++i) {
        if (std::isfinite(to[2 * i]) && std::isfinite(to[2 * i + 1])) continue;
        const Vertex bad = {first + done + i, {to[2 * i], to[2 * i + 1]}};
        throw Error(ErrorKind::input, fmt::format("{} is not finite", describe(bad)));
      }
      done += part;
    }
  }

  /// Calls visit(vertex) for all points.
  template <typename Visit>
  void for_each_point(const std::string& stage, const Visit& visit) {
    Buffer<double> piece(2 * sizes_.piece_rows);
    for (std::uint64_t first = 0; first < n_; first += sizes_.piece_rows) {
      tell(stage, static_cast<double>(first) / static_cast<double>(n_));
      const std::uint64_t count = std::min<std::uint64_t>(sizes_.piece_rows, n_ - first);
      read_points(first, count, piece.data());
      for (std::uint64_t i = 0; i < count; ++i) visit(Vertex{first + i, {piece[2 * i], piece[2 * i + 1]}});
    }
  }

  /// No triangles: right if and only if all points are collinear.
  void check_collinear() {
    ExternalSorter<Candidate, ByPlace> places(options_.scratch, sizes_.sort_bytes);
    std::optional<Vertex> first, other;
    for_each_point("checking that points are collinear", [&](const Vertex& vertex) {
      const Candidate candidate{vertex, 0};
      places.add(&candidate, 1);
      if (!first) {
        first = vertex;
      } else if (!other && !is_same_place(*first, vertex)) {
        other = vertex;
      } else if (other && predicates_.orient2d(first->at, other->at, vertex.at) != 0) {
        violate("there are no triangles, but the points are not all collinear: {}, {}, {}", describe(*first),
                describe(*other), describe(vertex));
      }
    });
    std::optional<Vertex> before;
    places.for_each([&](const Candidate& candidate) {
      report_.distinct_points += !before || !is_same_place(*before, candidate.vertex);
      before = candidate.vertex;
    });
    report_.hull_vertices = report_.distinct_points;
    report_.scratch_bytes += places.scratch_bytes();
  }

  // ----------------------------------------------------------------------------------- windows, their rows

  std::uint64_t first_row(std::size_t window) const { return window * window_rows_; }
  std::uint64_t rows_of(std::size_t window) const {
    const std::uint64_t first = std::min(rows_, first_row(window));
    return std::min(window_rows_, rows_ - first);
  }

  /// Calls visit(corner, id) for all corners of a window's rows.
  template <typename Visit>
  void for_each_corner(std::size_t window, const Visit& visit) {
    Buffer<std::int64_t> piece(3 * sizes_.piece_rows);
    for (std::uint64_t done = 0; done < rows_of(window);) {
      const std::size_t part = std::min<std::uint64_t>(sizes_.piece_rows, rows_of(window) - done);
      triangles_.read(first_row(window) + done, part, piece.data());
      for (std::size_t i = 0; i < 3 * part; ++i) visit(3 * done + i, piece[i]);
      done += part;
    }
  }

  std::uint64_t index_ids() const { return std::clamp<std::uint64_t>(sizes_.index_ids, 1, n_ + 1); }

  /// Writes the distinct vertices of each window to vertex_file_, in ascending order.
  void collect_vertices() {
    vertex_file_.emplace(options_.scratch);
    Pool<VertexIndex> indices([this] { return std::make_unique<VertexIndex>(index_ids()); });
    std::atomic<std::size_t> done{0};
    threads_.share_each(windows_.size(), [&](std::size_t window) {
      const auto index = indices.take();
      for (std::uint64_t first = 0; first == 0 || first < n_; first += index_ids()) {
        const std::uint64_t count = std::min(index_ids(), n_ - first);
        index->clear(first, count);
        for_each_corner(window, [&](std::uint64_t corner, std::int64_t signed_id) {
          const auto id = static_cast<std::uint64_t>(signed_id);
          if (id >= n_) {
            violate("triangle {} has a corner {}, which is not the index of one of the {} points",
                    first_row(window) + corner / 3, signed_id, n_);
          }
          if (id - first < count) index->insert(id);
        });
        write_vertices(*index, windows_[window]);
      }
      tell("collecting vertices", static_cast<double>(++done) / static_cast<double>(windows_.size()));
    });
    std::uint64_t vertices = 0;
    for (WindowPlan& plan : windows_) {
      plan.coordinates_begin = vertices;
      vertices += plan.vertices;
    }
    report_.scratch_bytes += vertices * (sizeof(std::uint32_t) + 2 * sizeof(double));
    coordinate_file_.emplace(options_.scratch);
    coordinate_file_->require_room(vertices * 2 * sizeof(double), "the coordinates of vertices");
  }

  /// A range's vertices are written as differences from its first, which fit 32 bits.
  void write_vertices(const VertexIndex& index, WindowPlan& plan) {
    std::uint64_t range = 0, begin_of_range = 0, end_of_range = 0;
    std::vector<std::uint32_t> batch;
    const auto write = [&] {
      if (batch.empty()) return;
      const std::uint64_t begin = vertex_entries_.fetch_add(batch.size());
      vertex_file_->write_at(begin * sizeof(std::uint32_t), batch.data(),
                             batch.size() * sizeof(std::uint32_t));
      plan.segments.push_back({range, begin, batch.size()});
      plan.vertices += batch.size();
      batch.clear();
    };
    index.for_each([&](std::uint64_t id) {
      if (batch.size() == kBatch || id >= end_of_range) write();
      if (id >= end_of_range) {
        range = id / range_points();
        begin_of_range = range * range_points();
        end_of_range = begin_of_range + range_points();
      }
      batch.push_back(static_cast<std::uint32_t>(id - begin_of_range));
    });
    write();
  }

  std::uint64_t range_points() const { return std::max<std::uint64_t>(1, sizes_.range_points); }

  // -------------------------------------------------------------------------- windows, their coordinates

  /// Reads the points, range after range, and writes the coordinates of each window's vertices. Finds out
  /// which points no row uses.
  void place_vertices() {
    const std::uint64_t most = std::min(range_points(), n_);
    Buffer<double> coordinates(2 * most);
    Buffer<unsigned char> used(most);
    filter_.emplace(sizes_.filter_bits);
    use_file_.emplace(options_.scratch);
    for (std::uint64_t range = 0; range * range_points() < n_; ++range) {
      const std::uint64_t first = range * range_points(), count = std::min(range_points(), n_ - first);
      tell("placing vertices", static_cast<double>(first) / static_cast<double>(n_));
      read_points(first, count, coordinates.data());
      std::fill_n(used.data(), count, 0);
      threads_.share_each(windows_.size(), [&](std::size_t window) {
        place_window(windows_[window], range, coordinates.data(), used.data());
      });
      for (std::uint64_t i = 0; i < count; ++i) {
        used_ += used[i];
        if (used[i] == 0) filter_->insert(&coordinates[2 * i]);
      }
      use_file_->write_at(first, used.data(), count);
    }
    report_.distinct_points = used_;
  }

  void place_window(const WindowPlan& plan, std::uint64_t range, const double* coordinates,
                    unsigned char* used) {
    std::vector<std::uint32_t> vertices;
    std::vector<double> places;
    std::uint64_t before = 0;  // vertices of the window
    for (const Segment& segment : plan.segments) {
      if (segment.range == range) {
        read_segment(segment, vertices);
        places.resize(2 * segment.count);
        for (std::size_t i = 0; i < segment.count; ++i) {
          places[2 * i] = coordinates[2 * std::size_t{vertices[i]}];
          places[2 * i + 1] = coordinates[2 * std::size_t{vertices[i]} + 1];
          __atomic_store_n(&used[vertices[i]], 1, __ATOMIC_RELAXED);
        }
        coordinate_file_->write_at((plan.coordinates_begin + before) * 2 * sizeof(double), places.data(),
                                   places.size() * sizeof(double));
      }
      before += segment.count;
    }
  }

  void read_segment(const Segment& segment, std::vector<std::uint32_t>& vertices) const {
    vertices.resize(segment.count);
    vertex_file_->read_at(segment.begin * sizeof(std::uint32_t), segment.count * sizeof(std::uint32_t),
                          vertices.data());
  }

  /// Every point that no row uses must be equal to a used one.
  void check_unused() {
    ExternalSorter<Candidate, ByPlace> candidates(options_.scratch, sizes_.sort_bytes);
    std::vector<unsigned char> used;
    for_each_point("comparing duplicates", [&](const Vertex& vertex) {
      const std::size_t in_piece = vertex.id % sizes_.piece_rows;
      if (in_piece == 0) {
        used.resize(std::min<std::uint64_t>(sizes_.piece_rows, n_ - vertex.id));
        use_file_->read_at(vertex.id, used.size(), used.data());
      }
      if (!filter_->may_contain(vertex.at)) return;
      const Candidate candidate{vertex, used[in_piece] != 0 ? std::uint64_t{0} : std::uint64_t{1}};
      candidates.add(&candidate, 1);
    });
    std::optional<Vertex> representative, unused;
    candidates.for_each([&](const Candidate& candidate) {
      const Vertex& vertex = candidate.vertex;
      const bool is_known = representative && is_same_place(*representative, vertex);
      if (candidate.unused == 0 && is_known) {
        violate("{} and its duplicate, point {}, are both corners of triangles", describe(vertex),
                representative->id);
      }
      if (candidate.unused == 0) representative = vertex;
      if (candidate.unused == 1 && !is_known && (!unused || vertex.id < unused->id)) unused = vertex;
    });
    report_.scratch_bytes += candidates.scratch_bytes();
    if (unused) violate("{} is in no triangle", describe(*unused));
  }

  // ---------------------------------------------------------------------------------- windows, their check

  void check_windows() {
    OpenEdges edges(options_.scratch, sizes_.sort_bytes);
    std::uint64_t matched = 0;
    {
      Pool<Window> pool([this] { return std::make_unique<Window>(window_rows_, sizes_.piece_rows); });
      Pool<VertexIndex> indices([this] { return std::make_unique<VertexIndex>(index_ids()); });
      std::atomic<std::size_t> done{0};
      threads_.share_each(windows_.size(), [&](std::size_t i) {
        if (rows_of(i) == 0) return;
        const auto window = pool.take();
        fill_window(i, *indices.take(), *window);
        window->check(neighbors_, edges);
        tell("checking triangles", static_cast<double>(++done) / static_cast<double>(windows_.size()));
      });
      pool.for_each([&](const Window& window) {
        report_.cocircular_edges += window.cocircular_edges();
        report_.exact_evaluations += window.exact_evaluations();
        matched += window.matched_edges();
      });
    }
    vertex_file_.reset();
    coordinate_file_.reset();
    tell("checking edges across", 0);
    Boundary boundary(options_.scratch, sizes_.sort_bytes);
    const AcrossCounts counts = check_across(edges, neighbors_ != nullptr, boundary, predicates_);
    report_.cocircular_edges += counts.cocircular;
    report_.edges_across = counts.matched;
    report_.hull_vertices = counts.boundary;
    report_.scratch_bytes += edges.scratch_bytes();
    check_boundary(boundary, predicates_);
    report_.scratch_bytes += boundary.scratch_bytes();
    if (2 * (matched + counts.matched) + counts.boundary != 3 * rows_) {
      violate("{} edges with two triangles and {} with one are not the sides of {} triangles",
              matched + counts.matched, counts.boundary, rows_);
    }
  }

  /// Fills a window with its vertices and corners.
  void fill_window(std::size_t i, VertexIndex& index, Window& window) {
    const WindowPlan& plan = windows_[i];
    window.first_row = first_row(i);
    window.rows = rows_of(i);
    window.vertices = 0;
    std::vector<std::uint32_t> vertices;
    for (const Segment& segment : plan.segments) {
      read_segment(segment, vertices);
      for (const std::uint32_t vertex : vertices) {
        window.ids[window.vertices++] = segment.range * range_points() + vertex;
      }
    }
    coordinate_file_->read_at(plan.coordinates_begin * 2 * sizeof(double), plan.vertices * 2 * sizeof(double),
                              window.coordinates.data());
    std::uint64_t entered = 0;
    std::uint32_t number = 0;
    for (std::uint64_t first = 0; first < n_; first += index_ids()) {
      const std::uint64_t count = std::min(index_ids(), n_ - first);
      index.clear(first, count);
      for (; entered < window.vertices && window.ids[entered] < first + count; ++entered) {
        index.insert(window.ids[entered]);
      }
      number = index.enumerate(number);
      for_each_corner(i, [&](std::uint64_t corner, std::int64_t signed_id) {
        const auto id = static_cast<std::uint64_t>(signed_id);
        if (id >= n_ || (id - first < count && !index.contains(id))) {
          throw Error(ErrorKind::input, fmt::format("triangle {} changed while the file was read",
                                                    window.first_row + corner / 3));
        }
        if (id - first < count) window.corners[corner] = index.number(id);
      });
    }
  }

  static constexpr std::size_t kBatch = std::size_t{1} << 18;  // vertices that are written together

  PointSource& points_;
  io::RowSource& triangles_;
  io::RowSource* neighbors_;
  const VerifySizes sizes_;
  host::Threads threads_{static_cast<std::size_t>(sizes_.threads)};
  const VerifyChunksOptions& options_;
  const std::uint64_t n_, rows_;
  std::uint64_t window_rows_ = 0;
  std::vector<WindowPlan> windows_;
  std::optional<io::ScratchFile> vertex_file_, coordinate_file_, use_file_;
  std::atomic<std::uint64_t> vertex_entries_{0};
  std::optional<PlaceFilter> filter_;
  std::uint64_t used_ = 0;
  ExactPredicates predicates_;
  std::mutex progress_mutex_;
  VerifyChunksReport report_;
};

}  // namespace
}  // namespace prove

VerifySizes verify_sizes(std::uint64_t memory_bytes, std::uint64_t points, std::uint64_t rows, int threads) {
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 20, kFixed = std::uint64_t{24} << 20;
  constexpr std::uint64_t kLeastWindow = std::uint64_t{1} << 18;  // rows; shorter ones have many edges across
  constexpr std::uint64_t kMostWindow = std::uint64_t{1}
                                        << 22;  // longer ones are slower, as caches are small
  constexpr std::uint64_t kMostRange = std::uint64_t{1} << 31;
  if (memory_bytes < kLeast) {
    throw Error(ErrorKind::usage, fmt::format("a check needs {} MiB of memory at least", kLeast >> 20));
  }
  using prove::Window;
  const std::uint64_t memory = memory_bytes - kFixed;
  const std::uint64_t for_windows = memory / 8 * 5;
  VerifySizes sizes;
  sizes.threads =
      static_cast<int>(std::clamp<std::uint64_t>(for_windows / (kLeastWindow * Window::kRowBytes), 1,
                                                 host::Threads(static_cast<std::size_t>(threads)).count()));
  const auto share = static_cast<std::uint64_t>(sizes.threads);
  // As many windows as keep all threads busy to the end.
  const std::uint64_t most_rows = std::min(for_windows / share / Window::kRowBytes, kMostWindow);
  const std::uint64_t windows = (rows / most_rows / share + 1) * share;
  sizes.window_rows = rows / windows + 1;
  sizes.index_ids = memory / 8 / share * 6;  // a byte holds six ids
  sizes.range_points = std::min({memory / 2 / 17, kMostRange, std::max<std::uint64_t>(points, 1)});
  sizes.filter_bits = std::min(memory / 4 * 8, 16 * points);
  sizes.sort_bytes = memory / 8;
  sizes.piece_rows = std::size_t{1} << 16;
  return sizes;
}

VerifyChunksReport verify_chunks(PointSource& points, io::RowSource& triangles, io::RowSource* neighbors,
                                 const VerifySizes& sizes, const VerifyChunksOptions& options) {
  return prove::ChunkChecker(points, triangles, neighbors, sizes, options).run();
}

}  // namespace flaunay
