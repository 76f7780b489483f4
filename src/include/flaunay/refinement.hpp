// Types for meshes whose triangles have a smallest angle and a largest area. docs/refinement.md defines the
// results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace flaunay {

/// Which constraints may be split by points that are added.
enum class KeptEdges {
  none,    ///< all may be split
  border,  ///< those with triangles of the mesh on one side only are kept as they are
  all,     ///< all are kept as they are
};

/// Gives the areas that triangles may have: one per place, 0 or infinity for any. places: x and y of the
/// centroids of `count` triangles. It is called once a round, for each set; what it throws ends the call.
using AreasAt = std::function<void(const double* places, std::size_t count, double* areas)>;

/// The triangles of a mesh that is refined further. All points are triangulated anew, with the border of
/// these triangles, and edges between two of different attributes, as further segments, which come after
/// those of Constraints in the order of triangles. What no triangle covers is left out.
struct GivenTriangles {
  const std::int32_t* triangles = nullptr;  ///< 3 points of the same set per triangle, in any direction
  std::size_t count = 0;                    ///< number of triangles; 0: no such mesh
  /// One per triangle, or null: the area that triangles of the result with their centroid in it may have, 0
  /// for any.
  const double* areas = nullptr;
  /// One per triangle, or null: become ConstrainedTriangulation::triangle_attributes, in the place of those
  /// of seeds.
  const double* attributes = nullptr;
};

/// In the place of a smallest edge: the default.
constexpr double kDefaultMinEdge = -1;

/// The goals of a refinement. By default, nothing is added.
struct Refinement {
  /// In degrees, from 0 to 34: no angle of a triangle is smaller, except where docs/refinement.md says that
  /// it cannot be helped. Up to 30 the number of points is near the least known; above 33, many inputs do not
  /// end before the limits.
  double min_angle = 0;
  double max_area = 0;  ///< no triangle is larger; 0 for any
  /// One per seed of Constraints, or null: the largest area of a triangle in its region, 0 for any.
  const double* seed_areas = nullptr;
  GivenTriangles mesh;  ///< a mesh that is refined further, instead of points
  AreasAt areas_at;     ///< the areas that triangles may have by their places, or nothing
  /// Splits constraints, and the border, until no angle opposite to them is obtuse: then all triangles are
  /// Delaunay without constraints, too, as far as there are triangles.
  bool conforming = false;
  KeptEdges kept = KeptEdges::none;             ///< which constraints must not be split
  const std::uint8_t* kept_segments = nullptr;  ///< one per segment: 1 if it must not be split, or null
  /// No two points are put nearer to each other than that, from 0 on. The default is 2^-40 times the larger
  /// side of the bounding box, or 2^-48 times the largest coordinate if that is more.
  double min_edge = kDefaultMinEdge;
  std::size_t most_points = static_cast<std::size_t>(-1);  ///< no more points are added to a set; 0: none
  std::size_t most_rounds = 10000;                         ///< no more rounds are made; 0: none
  /// So often, added points that are not on constraints move to where triangles are more regular, as far as
  /// these stay as good as is asked for. It ends at a limit of points or rounds.
  std::size_t smoothing_steps = 0;
  bool measured = false;  ///< whether angles are reported even if nothing is asked for

  /// Whether anything is asked for.
  bool is_wanted() const {
    return min_angle > 0 || max_area > 0 || seed_areas != nullptr || mesh.areas != nullptr || areas_at ||
           conforming;
  }
};

/// Why a triangle is worse than it should be.
enum class Excuse : std::uint8_t {
  input_angle = 1,  ///< its smallest angle is one between two segments
  /// Its shortest edge, which is no segment, joins points on two segments, equally far from where these meet
  /// at less than 60 degrees, with triangles all the way between them.
  near_apex,
  min_edge,     ///< what would mend it is nearer to a point than Refinement::min_edge
  kept,         ///< a constraint is in the way that must not be split
  frozen,       ///< a constraint is in the way that rounding does not allow to split
  most_points,  ///< Refinement::most_points were added
  most_rounds,  ///< Refinement::most_rounds were made
};

/// How a refinement went.
struct RefinementReport {
  std::size_t rounds = 0;        ///< in which points were added; of several sets the most
  std::size_t added_points = 0;  ///< on constraints or not
  std::size_t split_points = 0;  ///< those of them that are on constraints
  /// The smallest angle of all triangles, in degrees, rounded; 0 if there are none, or if nothing was asked
  /// for.
  double smallest_angle = 0;
  double largest_angle = 0;  ///< as smallest_angle
  double mean_angle = 0;     ///< of the smallest angle of each triangle, in degrees, if there was smoothing
  double smallest_angle_before = 0;         ///< as smallest_angle, before smoothing; 0 without
  double mean_angle_before = 0;             ///< as mean_angle, before smoothing; 0 without
  std::vector<std::int32_t> bad_triangles;  ///< triangles that are worse than asked for, ascending
  std::vector<Excuse> excuses;              ///< why, for each of them
};

}  // namespace flaunay

/// The members of flaunay::Refinement that are numbers, flags or words, as options of the command: X(member,
/// option, whether it asks for points, a word for its value, a line for users).
#define FLAUNAY_REFINEMENT_OPTIONS(X)                                                                \
  X(min_angle, "--min-angle", true, "DEGREES",                                                       \
    "Add points until no triangle has a smaller angle, in degrees, from 0 to 34")                    \
  X(max_area, "--max-area", true, "AREA", "Add points until no triangle is larger")                  \
  X(conforming, "--conforming", true, "",                                                            \
    "Split constraints until all triangles are Delaunay without them, too")                          \
  X(kept, "--keep-edges", false, "",                                                                 \
    "Which edges points must not be put on: none, those at the border, or all constraints")          \
  X(min_edge, "--min-edge", false, "LENGTH",                                                         \
    "Put no two points nearer to each other; default: 2^-40 of the extent, or 2^-48 of the largest " \
    "coordinate if "                                                                                 \
    "that is more")                                                                                  \
  X(most_points, "--most-points", false, "N", "Add no more points")                                  \
  X(smoothing_steps, "--smooth", false, "N",                                                         \
    "So often, move added points to where triangles are more regular")
