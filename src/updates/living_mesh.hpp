// A triangulation that changes: its points, its triangles, and its edges of constraints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "flaunay/dynamic.hpp"
#include "host/runtime.hpp"
#include "updates/edges.hpp"
#include "updates/mesh.hpp"
#include "updates/points.hpp"

namespace flaunay::updates {

/// Triangulations of all points, and calls on the runtime where batches change the mesh.
struct Anew {
  /// Triangulates n points with segments, of which there may be none.
  std::function<ConstrainedTriangulation(const double* coordinates, std::size_t n, const Constraints&)>
      triangulate;
  /// Begins a call on the runtime, which lasts as long as the result.
  std::function<std::shared_ptr<void>()> begin_call;
};

class LivingMesh {
 public:
  LivingMesh(host::Runtime& runtime, Anew anew) : runtime_(runtime), anew_(std::move(anew)), mesh_(runtime) {}

  /// Triangulates n points. Throws Error(input) for those that cannot be triangulated.
  void make(const double* coordinates, std::size_t n);
  /// Triangulates them with constraints. triangulate: does so, with the options of the caller.
  void make_constrained(const double* coordinates, std::size_t n,
                        const std::function<ConstrainedTriangulation()>& triangulate);

  // Batches. If one throws, points and constraints are what they were before.
  Changes insert(const double* coordinates, std::size_t m);
  Changes remove(const std::int32_t* numbers, std::size_t m);
  Changes move(const std::int32_t* numbers, const double* coordinates, std::size_t m);

  const Points& points() const { return points_; }
  std::size_t triangle_count() const { return triangle_count_; }
  std::size_t row_count() const { return row_count_; }
  TriangleRows rows();
  /// Triangles, neighbours, the hull and representatives.
  Triangulation triangulation();
  LivingConstraints constraints() const { return edges_.listed(points_.coordinates()); }

 private:
  using Ids = std::vector<std::int32_t>;

  // The changes that a batch makes to the mesh. Points leave their old places before others come.
  struct Batch {
    Ids removed, moved, inserted;
    bool moves_many = false;
  };

  void triangulate_anew();
  void adopt(const Living& living, ConstrainedTriangulation fresh);
  void load();
  void recover();
  bool change(Batch batch, std::vector<SplitEdge>& splits, Changes& changes);
  Ids old_triangles();
  bool may_change(bool is_large) const;
  template <typename Prepare>
  void update(std::shared_ptr<void> call, const Prepare& prepare, Changes& changes);
  template <typename Prepare>
  Changes run(bool is_large, Ids located, const Prepare& prepare);
  std::vector<std::size_t> order_of_leaving(const std::int32_t* numbers, std::size_t m) const;
  void leave(std::int32_t v, Batch& batch);
  Changes nothing() const;
  void check_numbers(const std::int32_t* numbers, std::size_t m, const char* what);

  host::Runtime& runtime_;
  Anew anew_;
  Points points_;
  bool is_constrained_ = false;
  ConstraintEdges edges_;
  // The triangles: until a batch changes them, those that all points were triangulated to, with a row for
  // each edge of the hull behind them; then those of the mesh. None if an error has come in between.
  ConstrainedTriangulation made_;
  Mesh mesh_;
  bool is_loaded_ = false, is_lost_ = false;
  std::size_t triangle_count_ = 0, row_count_ = 0;
  // After a batch that moved many points and could not mend the mesh, so many like it do not try: each time
  // twice as many. An attempt takes half as long as triangulating anew.
  static constexpr std::size_t kMostUnmended = 31;
  std::size_t unmended_ = 0, unmended_left_ = 0;
};

}  // namespace flaunay::updates
