#include "app/conformance/calls.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "app/files/generate.hpp"
#include "flaunay/chunks.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/dynamic.hpp"
#include "flaunay/neighbors.hpp"
#include "flaunay/research.hpp"
#include "flaunay/sphere.hpp"
#include "flaunay/terrain.hpp"
#include "flaunay/weighted.hpp"

namespace flaunay::conformance {
namespace {

/// x0 y0 x1 y1 ...
using Coordinates = std::vector<double>;
using Offsets = std::vector<std::size_t>;

// The points of io::generate, or "all-magnitudes": together these do not fit fixed point.
Coordinates points_of(const std::string& input, std::size_t n) {
  if (input != "all-magnitudes") return io::generate(input, n, 1).coordinates;
  Coordinates points = points_of("uniform", n);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k] = std::ldexp(points[k], static_cast<int>(k * 37 % 241) - 120);
  }
  return points;
}

// Among them are points that are cocircular, collinear or equal, exactly or but for rounding.
const std::vector<std::string> kInputs = {"uniform",        "kuzmin",         "grid",
                                          "rotated-grid",   "small-integers", "collinear",
                                          "integer-circle", "one-ulp",        "all-magnitudes"};
// For calls whose places are not to be far apart.
const std::vector<std::string> kTameInputs = {"uniform", "grid", "half-duplicates"};

// A box that is half as wide and high as the points, in their middle; a triangle if all have one x.
Coordinates box_in(const Coordinates& points) {
  double low[2] = {points[0], points[1]}, high[2] = {points[0], points[1]};
  for (std::size_t k = 2; k < points.size(); ++k) {
    low[k % 2] = std::min(low[k % 2], points[k]);
    high[k % 2] = std::max(high[k % 2], points[k]);
  }
  const double left = 0.75 * low[0] + 0.25 * high[0], right = 0.25 * low[0] + 0.75 * high[0],
               bottom = 0.75 * low[1] + 0.25 * high[1];
  if (!(left < right)) return {left - 1, bottom - 1, left + 1, bottom - 1, left, bottom + 1};
  const double top = std::max(0.25 * low[1] + 0.75 * high[1], bottom + (right - left));
  return {left, bottom, right, bottom, right, top, left, top};
}

// Sets of 0, 1, 2, ... points of all inputs.
std::pair<Coordinates, Offsets> sets(std::size_t n) {
  Coordinates all;
  Offsets offsets{0};
  for (const std::string& input : kInputs) {
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3}, n / 20, n / 6}) {
      const Coordinates set = points_of(input, std::max<std::size_t>(8, size));
      all.insert(all.end(), set.begin(), set.begin() + static_cast<std::ptrdiff_t>(2 * size));
      offsets.push_back(all.size() / 2);
    }
  }
  return {all, offsets};
}

void add(Arrays& results, const std::string& name, const Triangulation& mesh) {
  results.add(name + " triangles", mesh.triangles);
  results.add(name + " neighbors", mesh.neighbors);
  results.add(name + " halfedges", mesh.halfedges);
  results.add(name + " hull", mesh.hull);
  results.add(name + " representatives", mesh.representatives);
  results.add(name + " areas", mesh.areas);
  results.add(name + " triangle offsets", mesh.triangle_offsets);
  results.add(name + " hull offsets", mesh.hull_offsets);
}

void add(Arrays& results, const std::string& name, const ConstrainedTriangulation& mesh) {
  add(results, name, static_cast<const Triangulation&>(mesh));
  results.add(name + " added points", mesh.added_points);
  results.add(name + " constraint edges", mesh.constraint_edges);
  results.add(name + " edge segments", mesh.edge_segments);
  results.add(name + " piece edges", mesh.piece_edges);
  results.add(name + " constrained", mesh.constrained);
  results.add(name + " depths", mesh.depths);
  results.add(name + " regions", mesh.regions);
  results.add(name + " polygons", mesh.polygons);
  results.add(name + " bad triangles", mesh.refinement.bad_triangles);
  results.add(name + " excuses", mesh.refinement.excuses);
}

void add(Arrays& results, const std::string& name, const ClippedVoronoi& cells) {
  results.add(name + " vertices", cells.vertices);
  results.add(name + " offsets", cells.offsets);
  results.add(name + " areas", cells.areas);
  results.add(name + " centroids", cells.centroids);
}

// Adds a mesh on a torus or a sphere.
template <typename Mesh>
void add_unfolded(Arrays& results, const std::string& name, const Mesh& mesh) {
  results.add(name + " places", mesh.places);
  results.add(name + " triangles", mesh.triangles);
  results.add(name + " neighbors", mesh.neighbors);
  results.add(name + " representatives", mesh.representatives);
}

template <typename AnyOptions = Options>
AnyOptions all_arrays() {
  AnyOptions options;
  options.neighbors = options.halfedges = options.areas = true;
  return options;
}

void triangulate(Triangulator& triangulator, std::size_t n, Arrays& results) {
  for (const std::string& input : kInputs) {
    const Coordinates points = points_of(input, n);
    add(results, input, triangulator.triangulate(points.data(), points.size() / 2, all_arrays()));
    const std::vector<float> rounded(points.begin(), points.end());
    add(results, input + " in floats", triangulator.triangulate(rounded.data(), rounded.size() / 2));
  }
  // Enough for several rounds of blocks.
  const Coordinates many = points_of("kuzmin", 8 * n);
  add(results, "many", triangulator.triangulate(many.data(), many.size() / 2, all_arrays()));
}

void triangulate_sets(Triangulator& triangulator, std::size_t n, Arrays& results) {
  const auto [points, offsets] = sets(n);
  add(results, "sets", triangulator.triangulate(points.data(), offsets, all_arrays()));
}

// The paper's algorithm and its variants.
void modes(Triangulator& triangulator, std::size_t n, Arrays& results) {
  auto options = all_arrays<research::Options>();
  options.mode = research::Mode::flattened;
  const auto run = [&](const std::string& name, const Coordinates& points) {
    add(results, name, research::triangulate(triangulator, points.data(), points.size() / 2, options));
  };
  for (const std::string& input : kInputs) {
    options.finish = research::Finish::blocks;
    options.hull = research::Hull::prune;
    run(input + " to blocks", points_of(input, n));
    options.finish = research::Finish::levels;
    options.hull = research::Hull::balanced;
    run(input + " to the bottom, balanced", points_of(input, n / 2));
  }
  const Coordinates few = points_of("small-integers", n / 4);
  options.hull = research::Hull::quickhull;
  options.cut = research::Cut::alternate;
  run("by quickhull, alternating", few);
  options.hull = research::Hull::prune;
  run("pruned", few);
  options.mode = research::Mode::recursive_device;
  run("recursive", few);
  options.mode = research::Mode::partition;
  options.partition_levels = 2;
  run("partition", few);
}

// A star with a hole, and segments across all.
struct Scene {
  Coordinates points;
  std::vector<std::int32_t> rings, crossing;
};
Scene scene(std::size_t n) {
  Scene made;
  const auto ring = [&](std::size_t corners, double outer, double inner) {
    const auto first = static_cast<std::int32_t>(made.points.size() / 2);
    for (std::size_t k = 0; k < corners; ++k) {
      // Exactly given on every system: no sines.
      const double turn = 8 * static_cast<double>(k) / static_cast<double>(corners);
      const double x = turn < 2 ? 1 : turn < 4 ? 3 - turn : turn < 6 ? -1 : turn - 7;
      const double y = turn < 2 ? turn - 1 : turn < 4 ? 1 : turn < 6 ? 5 - turn : -1;
      const double r = k % 2 == 0 ? outer : inner;
      made.points.insert(made.points.end(), {r * x, r * y});
      const auto here = first + static_cast<std::int32_t>(k);
      made.rings.insert(made.rings.end(), {here, k + 1 < corners ? here + 1 : first});
    }
  };
  ring(std::max<std::size_t>(8, n / 4 * 2), 1, 0.75);
  ring(std::max<std::size_t>(4, n / 16 * 2), 0.375, 0.25);
  const Coordinates inside = points_of("uniform", n / 4);
  made.points.insert(made.points.end(), inside.begin(), inside.end());
  const auto count = static_cast<std::int32_t>(made.points.size() / 2);
  for (std::int32_t k = 0; k < 24; ++k) {
    made.crossing.insert(made.crossing.end(), {k * 7 % count, (k * 13 + count / 2) % count});
  }
  return made;
}

Constraints constraints_of(const std::vector<std::int32_t>& segments) {
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  return constraints;
}

void constrained(Triangulator& triangulator, std::size_t n, Arrays& results) {
  const Scene given = scene(n);
  const std::size_t count = given.points.size() / 2;
  auto options = all_arrays<ConstrainedOptions>();
  options.labels = true;
  for (const auto outside : {Outside::keep, Outside::hull, Outside::holes}) {
    options.outside = outside;
    add(results, "rings",
        triangulator.constrained(given.points.data(), count, constraints_of(given.rings), options));
  }
  options.outside = Outside::keep;
  options.crossings = Crossings::split;
  add(results, "crossing",
      triangulator.constrained(given.points.data(), count, constraints_of(given.crossing), options));
  // A segment past all vertices of a grid.
  const Coordinates grid = points_of("grid", n);
  const std::vector<std::int32_t> across = {0, static_cast<std::int32_t>(n - 1), 1,
                                            static_cast<std::int32_t>(n / 2)};
  add(results, "across a grid", triangulator.constrained(grid.data(), n, constraints_of(across), options));
}

// Many polygons in one call, and a map of them.
void polygons(Triangulator& triangulator, std::size_t n, Arrays& results) {
  Coordinates points;
  Polygons given;
  given.ring_offsets = {0};
  given.polygon_offsets = {0};
  for (std::size_t k = 0; k < std::max<std::size_t>(2, n / 40); ++k) {
    const auto x = static_cast<double>(k % 5), y = static_cast<double>(k / 5);
    const auto add_ring = [&](double radius) {
      points.insert(points.end(), {x - radius, y - radius, x + radius, y - radius, x + radius / 2, y,
                                   x + radius, y + radius, x - radius, y + radius});
      given.ring_offsets.push_back(points.size() / 2);
    };
    add_ring(0.5);
    if (k % 3 == 0) add_ring(0.125);
    given.polygon_offsets.push_back(given.ring_offsets.size() - 1);
  }
  given.coordinates = points.data();
  PolygonOptions options;
  options.neighbors = options.labels = true;
  add(results, "one by one", triangulator.polygons(given, options));
  options.map = true;
  add(results, "map", triangulator.polygons(given, options));
}

void refine(Triangulator& triangulator, std::size_t n, Arrays& results) {
  const Scene given = scene(n / 4);
  const std::size_t count = given.points.size() / 2;
  const Constraints constraints = constraints_of(given.rings);
  const auto run = [&](const std::string& name, const Refinement& refinement, Outside outside) {
    auto options = all_arrays<ConstrainedOptions>();
    options.outside = outside;
    options.refinement = refinement;
    add(results, name, triangulator.constrained(given.points.data(), count, constraints, options));
  };
  Refinement wanted;
  wanted.min_angle = 25;
  run("angles", wanted, Outside::holes);
  wanted.max_area = 0.01;
  wanted.smoothing_steps = 2;
  run("areas, smoothed", wanted, Outside::hull);
  wanted = {};
  wanted.conforming = true;
  run("conforming", wanted, Outside::holes);
  wanted.kept = KeptEdges::border;
  wanted.min_angle = 20;
  wanted.min_edge = 0.05;
  run("kept border, smallest edge", wanted, Outside::holes);
}

void updates(Triangulator& triangulator, std::size_t n, Arrays& results) {
  const Coordinates points = points_of("uniform", n), more = points_of("kuzmin", n / 8);
  DynamicTriangulation mesh(triangulator, points.data(), n);
  const auto add_state = [&](const std::string& name, const Changes& changes) {
    results.add(name + " removed", changes.removed);
    results.add(name + " made", changes.made);
    results.add(name + " corners", changes.made_corners);
    const TriangleRows rows = mesh.rows();
    results.add(name + " triangles", rows.triangles);
    results.add(name + " neighbors", rows.neighbors);
  };
  // Few are mended, many are triangulated anew.
  add_state("few inserted", mesh.insert(more.data(), std::max<std::size_t>(1, n / 64)));
  add_state("many inserted", mesh.insert(more.data(), more.size() / 2));
  std::vector<std::int32_t> numbers;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, n / 64); ++k)
    numbers.push_back(static_cast<std::int32_t>(3 * k));
  Coordinates moved;
  for (const std::int32_t number : numbers) {
    const auto at = 2 * static_cast<std::size_t>(number);
    moved.insert(moved.end(), {points[at] + 0x1p-12, points[at + 1] - 0x1p-12});
  }
  add_state("moved", mesh.move(numbers.data(), moved.data(), numbers.size()));
  add_state("removed", mesh.remove(numbers.data(), numbers.size()));
  add(results, "result", mesh.triangulation());

  // The inner points of a grid move a little: many edges flip, side by side.
  const auto side = static_cast<std::int32_t>(std::sqrt(static_cast<double>(n)));
  Coordinates grid;
  numbers.clear();
  moved.clear();
  for (std::int32_t k = 0; k < side * side; ++k) {
    const std::int32_t x = k % side, y = k / side;
    grid.insert(grid.end(), {static_cast<double>(x), static_cast<double>(y)});
    if (x == 0 || y == 0 || x == side - 1 || y == side - 1) continue;
    numbers.push_back(k);
    moved.insert(moved.end(), {x + (k * 7 % 5 - 2) / 64.0, y + (k * 11 % 7 - 3) / 64.0});
  }
  DynamicTriangulation shaken(triangulator, grid.data(), grid.size() / 2);
  results.add("flipped", shaken.move(numbers.data(), moved.data(), numbers.size()).made_corners);
  add(results, "shaken", shaken.triangulation());

  const Scene given = scene(n / 2);
  DynamicTriangulation with_segments(triangulator, given.points.data(), given.points.size() / 2,
                                     constraints_of(given.rings));
  with_segments.insert(more.data(), 2);
  results.add("living edges", with_segments.constraints().edges);
  add(results, "with segments", with_segments.triangulation());
}

void voronoi(Triangulator& triangulator, std::size_t n, Arrays& results) {
  for (const std::string& input : kInputs) {
    const Coordinates points = points_of(input, n);
    const std::size_t count = points.size() / 2;
    const Triangulation mesh = triangulator.triangulate(points.data(), count);
    const Voronoi diagram = triangulator.voronoi(points.data(), count, mesh);
    results.add(input + " circumcentres", diagram.circumcentres);
    results.add(input + " cell offsets", diagram.cell_offsets);
    results.add(input + " cells", diagram.cells);
    results.add(input + " unbounded", diagram.unbounded);
    const Coordinates box = box_in(points);
    add(results, input + " clipped",
        triangulator.clipped_voronoi(points.data(), count, mesh, box.data(), box.size() / 2));
  }
  const Coordinates points = points_of("uniform", n), box = box_in(points);
  results.add("relaxed", triangulator.relax(points.data(), n, box.data(), box.size() / 2, 2));
}

// At the points, between them, and outside.
Coordinates queries_of(const Coordinates& points) {
  Coordinates queries = points;
  for (std::size_t k = 2; k < points.size(); ++k) queries.push_back(points[k] / 2 + points[k - 2] / 2);
  queries.insert(queries.end(), {-3, 0.125, 1e18, -1e18});
  return queries;
}

std::vector<double> values_of(const Coordinates& points) {
  std::vector<double> values;
  for (std::size_t k = 0; k < points.size(); k += 2) {
    values.insert(values.end(), {points[k] * points[k + 1] + points[k], points[k] - 2});
  }
  return values;
}

void queries(Triangulator& triangulator, std::size_t n, Arrays& results) {
  for (const std::string& input : kInputs) {
    const Coordinates points = points_of(input, n), places = queries_of(points);
    const std::size_t count = points.size() / 2, asked = places.size() / 2;
    Locator locator(triangulator, points.data(), count, triangulator.triangulate(points.data(), count));
    results.add(input + " located", locator.locate(places.data(), asked));
    results.add(input + " nearest", locator.nearest(places.data(), asked));
    PointTree tree(triangulator, points.data(), count);
    NeighborOptions wanted;
    wanted.count = 5;
    const Neighbors neighbors = tree.nearest(places.data(), asked, wanted);
    results.add(input + " 5 nearest", neighbors.points);
    results.add(input + " distances", neighbors.distances);
  }
  const Scene given = scene(n);
  const std::size_t count = given.points.size() / 2;
  Locator locator(triangulator, given.points.data(), count,
                  triangulator.constrained(given.points.data(), count, constraints_of(given.rings)));
  const Coordinates places = queries_of(given.points);
  results.add("located among segments", locator.locate(places.data(), places.size() / 2));
  results.add("nearest among segments", locator.nearest(places.data(), places.size() / 2));
}

void interpolate(Triangulator& triangulator, std::size_t n, Arrays& results) {
  for (const std::string& input : kTameInputs) {
    const Coordinates points = points_of(input, n), places = queries_of(points);
    const std::size_t count = points.size() / 2, asked = places.size() / 2;
    const std::vector<double> values = values_of(points);
    Locator locator(triangulator, points.data(), count, triangulator.triangulate(points.data(), count));
    InterpolationOptions options;
    options.columns = 2;
    for (const auto& [name, method] :
         {std::pair(" linear", Interpolation::linear), std::pair(" nearest", Interpolation::nearest),
          std::pair(" Clough-Tocher", Interpolation::clough_tocher),
          std::pair(" Sibson", Interpolation::sibson), std::pair(" Laplace", Interpolation::laplace)}) {
      options.method = method;
      results.add(input + name, locator.interpolate(values.data(), places.data(), asked, options));
    }
    const NaturalWeights weights = locator.natural_weights(places.data(), asked);
    results.add(input + " weight offsets", weights.offsets);
    results.add(input + " weights", weights.weights);
    results.add(input + " gradients", locator.gradients(values.data(), 2));
  }
}

void terrain(Triangulator& triangulator, std::size_t n, Arrays& results) {
  const Coordinates points = points_of("uniform", n);
  const Triangulation mesh = triangulator.triangulate(points.data(), n, all_arrays());
  std::vector<double> heights;
  for (std::size_t k = 0; k < points.size(); k += 2) heights.push_back(points[k] + points[k + 1] * points[k]);
  MeshView view;
  view.coordinates = points.data();
  view.points = n;
  view.triangles = mesh.triangles.data();
  view.neighbors = mesh.neighbors.data();
  view.count = mesh.triangles.size() / 3;
  RasterGrid grid;
  grid.x = grid.y = 1.0 / 128;
  grid.dx = grid.dy = 1.0 / 64;
  grid.rows = grid.columns = 64;
  RasterOptions options;
  options.max_edge = 0.25;
  std::vector<double> pixels(grid.rows * grid.columns);
  rasterize(triangulator, view, heights.data(), grid, options, pixels.data());
  results.add("pixels", pixels);
  const Contours contours = trace_contours(triangulator, view, heights.data(), {0.25, 0.5, 1});
  results.add("contours", contours.coordinates);
  results.add("contour offsets", contours.offsets);
}

void torus(Triangulator& triangulator, std::size_t n, Arrays& results) {
  for (const std::string& input : kTameInputs) {
    const Coordinates points = points_of(input, n), places = queries_of(points);
    const Triangulation mesh =
        triangulator.triangulate(points.data(), points.size() / 2, Space::torus({2.5, 1.25}));
    add_unfolded(results, input, mesh);
    results.add(input + " offsets", mesh.corner_offsets);
    add_unfolded(results, input + " sheared",
                 triangulator.triangulate(points.data(), points.size() / 2, Space::torus({2.5, 1.25, 0.75})));
    add(results, input + " cells", triangulator.clipped_voronoi(mesh));
    Locator locator(triangulator, mesh);
    results.add(input + " located", locator.locate(places.data(), places.size() / 2));
    results.add(input + " nearest", locator.nearest(places.data(), places.size() / 2));
    const std::vector<double> values = values_of(points);
    InterpolationOptions options;
    options.columns = 2;
    options.method = Interpolation::clough_tocher;
    results.add(input + " Clough-Tocher",
                locator.interpolate(values.data(), places.data(), places.size() / 2, options));
    results.add(input + " gradients", locator.gradients(values.data(), 2));
  }
}

void sphere(Triangulator& triangulator, std::size_t n, Arrays& results) {
  for (const std::string& input : kTameInputs) {
    // Directions on all sides.
    const Coordinates flat = points_of(input, n);
    Coordinates points;
    for (std::size_t k = 0; k < flat.size(); k += 2) {
      const double side = k % 4 == 0 ? 0.25 : -0.5;
      points.insert(points.end(), {flat[k] - 0.5, flat[k + 1] - 0.5, side});
    }
    const std::size_t count = points.size() / 3;
    const Triangulation mesh =
        triangulator.triangulate(points.data(), count, Space::sphere(SphereCoordinates::directions));
    add_unfolded(results, input, mesh);
    Locator locator(triangulator, mesh);
    results.add(input + " nearest", locator.nearest(points.data(), count));
  }
}

std::vector<double> weights_of(const Coordinates& points) {
  std::vector<double> weights;
  for (std::size_t k = 0; k < points.size() / 2; ++k) weights.push_back(static_cast<double>(k % 5) / 64);
  return weights;
}

void weighted(Triangulator& triangulator, std::size_t n, Arrays& results) {
  // Enough for merges of blocks.
  const Coordinates many = points_of("uniform", 8 * n);
  const std::vector<double> weights_of_many = weights_of(many);
  const Triangulation merged = triangulator.triangulate(
      many.data(), many.size() / 2, Space::plane().with_weights(weights_of_many.data()), all_arrays());
  add(results, "many", merged);
  results.add("many hidden", merged.hidden);
  for (const std::string& input : kTameInputs) {
    const Coordinates points = points_of(input, n);
    const std::vector<double> weights = weights_of(points);
    const Triangulation mesh = triangulator.triangulate(
        points.data(), weights.size(), Space::plane().with_weights(weights.data()), all_arrays());
    add(results, input, mesh);
    results.add(input + " hidden", mesh.hidden);
    const Triangulation torus = triangulator.triangulate(
        points.data(), weights.size(), Space::torus({2.5, 1.25}).with_weights(weights.data()));
    add_unfolded(results, input + " on a torus", torus);
    results.add(input + " hidden on a torus", torus.hidden);
    add(results, input + " cells on a torus", triangulator.clipped_voronoi(torus, weights.data()));
    const Coordinates box = box_in(points);
    add(results, input + " cells",
        triangulator.clipped_voronoi(points.data(), weights.data(), weights.size(), mesh, box.data(),
                                     box.size() / 2));
  }
}

void chunks(Triangulator& triangulator, std::size_t n, Arrays& results) {
  const Coordinates points = points_of("normal", 4 * n);
  std::vector<std::int32_t> triangles(6 * points.size()), neighbors(triangles.size()), representatives(4 * n);
  MeshArrays<std::int32_t> wanted;
  wanted.triangles = triangles.data();
  wanted.neighbors = neighbors.data();
  wanted.representatives = representatives.data();
  ChunkOptions options;
  options.chunk_points = n;
  options.triangulators = {&triangulator};
  const ChunkStatistics made = triangulate_chunks(points.data(), 4 * n, wanted, options);
  triangles.resize(3 * made.triangles);
  neighbors.resize(3 * made.triangles);
  results.add("triangles", triangles);
  results.add("neighbors", neighbors);
  results.add("representatives", representatives);
}

}  // namespace

const std::vector<Call>& calls() {
  static const std::vector<Call> all = {
      {"triangulate", triangulate}, {"sets", triangulate_sets}, {"modes", modes},
      {"constrained", constrained}, {"polygons", polygons},     {"refine", refine},
      {"updates", updates},         {"voronoi", voronoi},       {"queries", queries},
      {"interpolate", interpolate}, {"terrain", terrain},       {"torus", torus},
      {"sphere", sphere},           {"weighted", weighted},     {"chunks", chunks},
  };
  return all;
}

}  // namespace flaunay::conformance
