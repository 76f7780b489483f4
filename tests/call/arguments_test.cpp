// What all public functions say of null pointers, of counts that no array has and of unknown enumerators,
// before they read anything: all arrays here are small. Without a device; c_test.c has calls on device
// memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/dynamic.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/flaunay.hpp"
#include "flaunay/neighbors.hpp"
#include "flaunay/research.hpp"
#include "flaunay/sphere.hpp"
#include "flaunay/terrain.hpp"
#include "flaunay/weighted.hpp"
#include "tests/support/errors.hpp"

namespace flaunay {
namespace {

constexpr std::size_t kCount = 3;
constexpr std::size_t power_of_two(int exponent) {
  return exponent < std::numeric_limits<std::size_t>::digits ? std::size_t{1} << exponent
                                                             : std::numeric_limits<std::size_t>::max();
}
constexpr std::size_t kHuge[] = {power_of_two(31), power_of_two(61), power_of_two(62), power_of_two(64)};
constexpr double kPoints[] = {0, 0, 4, 0, 0, 4, 1, 1, 2, 1};
constexpr std::int32_t kTriangles[] = {0, 1, 2, 0, 1, 2, 0, 1, 2};
constexpr std::size_t kOffsets[] = {0, 1, 2, 3};

// ---- All functions of flaunay.h

void make(flaunay_triangulator** made) { flaunay_triangulator_create("host", made); }
flaunay_triangulator* triangulator() {
  static flaunay_triangulator* const one = [] {
    flaunay_triangulator* made = nullptr;
    make(&made);
    return made;
  }();
  return one;
}
void make(flaunay_triangulation** made) {
  flaunay_triangulate(triangulator(), kPoints, kCount, nullptr, 0, nullptr, made);
}
void make(flaunay_dynamic** made) {
  flaunay_dynamic_create(triangulator(), kPoints, kCount, nullptr, nullptr, made);
}
void make(flaunay_locator** made) {
  flaunay_triangulation* mesh = nullptr;
  make(&mesh);
  flaunay_locator_create(triangulator(), kPoints, nullptr, kCount, nullptr, 0, mesh, made);
  flaunay_triangulation_destroy(mesh);
}
void make(flaunay_point_tree** made) { flaunay_point_tree_create(triangulator(), kPoints, kCount, made); }
void make(flaunay_device_triangulation** made) { flaunay_device_triangulation_create(made); }
void make(flaunay_device_voronoi** made) { flaunay_device_voronoi_create(made); }
void make(flaunay_device_clipped_voronoi** made) { flaunay_device_clipped_voronoi_create(made); }

// An argument with which nothing is wrong.
template <typename T>
T good() {
  if constexpr (std::is_same_v<T, std::size_t>) {
    return kCount;
  } else if constexpr (!std::is_pointer_v<T>) {
    return T{1};
  } else {
    using Of = std::remove_const_t<std::remove_pointer_t<T>>;
    if constexpr (requires(Of * *place) { make(place); }) {
      static Of* const handle = [] {
        Of* made = nullptr;
        make(&made);
        return made;
      }();
      EXPECT_NE(handle, nullptr) << flaunay_last_error();
      return handle;
    } else if constexpr (std::is_arithmetic_v<Of>) {
      static std::array<Of, 64> values = [] {
        std::array<Of, 64> made{};
        for (std::size_t i = 0; i < std::size(kTriangles); ++i) {
          made[i] = static_cast<Of>(sizeof(Of) == 4 ? kTriangles[i] : kPoints[i]);
        }
        if constexpr (std::is_same_v<Of, std::size_t>)
          std::copy(std::begin(kOffsets), std::end(kOffsets), made.begin());
        return made;
      }();
      return values.data();
    } else if constexpr (requires { sizeof(Of); }) {
      static Of value{};
      if constexpr (std::is_same_v<Of, flaunay_raster>) {
        value.rows = value.columns = 1;
        value.dx = value.dy = 1;
      }
      return &value;
    } else {
      return nullptr;  // of OpenCL
    }
  }
}

// What a message calls an argument: these words, or the argument's name.
std::vector<std::string> words_for(const std::string& name) {
  static const std::map<std::string, std::vector<std::string>> words = {
      {"coordinates", {"points", "coordinates"}},
      {"dynamic", {"triangulation"}},
      {"voronoi", {"Voronoi"}},
      {"n", {"points"}},
      {"t", {"triangles"}},
      {"h", {"hull"}},
      {"m", {"queries", "points"}},
      {"neighbors", {"neighbors", "neighbours"}},
      {"count", {"neighbours"}},
      {"corner_count", {"corner"}},
      {"group_count", {"groups"}},
      {"bound_count", {"bounds"}},
      {"height_count", {"heights"}},
  };
  const auto found = words.find(name);
  return found != words.end() ? found->second : std::vector<std::string>{name};
}

bool says(const std::string& message, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return message.find(word) != std::string::npos; });
}

constexpr const char* kMayBeNull[] = {"offsets", "options", "enqueue",  "constraints", "distances",
                                      "device",  "context", "contours", "breaklines",  "arrays",
                                      "files",   "space",   "weights"};
// Nothing is wrong with these here, or something else: there is no hidden point, no mode of the host, no
// period, no point in a mesh, and nothing refined.
constexpr const char* kOther[] = {
    "flaunay_dynamic_rows(triangles)",          "flaunay_dynamic_rows(neighbors)",
    "flaunay_hiding_triangles(triangles)",      "flaunay_triangulate_on_host(n)",
    "flaunay_triangulate_on_host(coordinates)", "flaunay_take_to_places(n)",
    "flaunay_mesh_verify(coordinates)",         "flaunay_mesh_verify_constrained(coordinates)",
    "flaunay_mesh_verify_constrained(report)",  "flaunay_mesh_verify_polygons(report)"};

template <std::size_t N>
bool is_one_of(const char* const (&names)[N], const std::string& name) {
  return std::any_of(std::begin(names), std::end(names), [&](const char* one) { return name == one; });
}

enum class Kind { other, handle, results };  // of an argument

// That a function has refused a call in which nothing is wrong but an argument. count: that argument, if it
// is one. status: what the function returned; none if that is nothing, as it should.
void expect_refusal(std::optional<flaunay_status> status, const std::string& name, Kind kind,
                    std::size_t count) {
  const std::string message = flaunay_last_error();
  EXPECT_TRUE(says(message, {count > 0 ? "too many" : "NULL"})) << message;
  if (!status) return;
  EXPECT_EQ(*status, count > 0 ? FLAUNAY_ERROR_INPUT : FLAUNAY_ERROR_USAGE) << message;
  std::vector<std::string> words = words_for(name);
  if (kind == Kind::handle) words = {"handle", "buffer"};
  if (kind == Kind::results) words.emplace_back("results");
  EXPECT_TRUE(says(message, words)) << message;
}

// Calls a function with one wrong argument at a time. parameters: as the header declares them.
template <typename Result, typename... Arguments>
class Sweep {
 public:
  Sweep(const char* function, const char* parameters, Result (*call)(Arguments...))
      : function_(function), call_(call) {
    std::istringstream text(parameters);
    for (std::string one; std::getline(text, one, ',');)
      names_.push_back(one.substr(one.find_last_of(" *") + 1));
    each(std::index_sequence_for<Arguments...>());
  }

 private:
  template <std::size_t... I>
  void each(std::index_sequence<I...>) {
    (try_one<I>(), ...);
  }

  template <std::size_t I>
  void try_one() {
    using T = std::tuple_element_t<I, std::tuple<Arguments...>>;
    const std::string& name = names_.at(I);
    if (is_one_of(kOther, function_ + "(" + name + ")")) return;
    if constexpr (std::is_same_v<T, std::size_t>) {
      // Without a device, that is what is said first.
      const bool needs_device = says(function_, {"_device", "workspace"});
      if (name == "iterations" || needs_device || !std::is_same_v<Result, flaunay_status>) return;
      for (const std::size_t count : kHuge) expect_refused<I>(count, name, count);
    } else if constexpr (std::is_pointer_v<T>) {
      if constexpr (
          requires { sizeof(*T{}); } || requires(T place) { make(&place); } || I == 0) {
        if (!is_one_of(kMayBeNull, name)) expect_refused<I>(nullptr, name, 0);
      }
    }
  }

  template <std::size_t I, typename Wrong>
  void expect_refused(Wrong wrong, const std::string& name, std::size_t count) {
    const auto trace = traced(name, count);
    using T = std::tuple_element_t<I, std::tuple<Arguments...>>;
    std::tuple<Arguments...> all{good_beside<Arguments>(name)...};
    std::get<I>(all) = wrong;
    if constexpr (std::is_void_v<Result>) {
      std::apply(call_, all);
    } else if constexpr (std::is_same_v<Result, flaunay_status>) {
      using Of = std::remove_pointer_t<T>;
      constexpr bool is_results = std::is_pointer_v<T> && std::is_arithmetic_v<Of> && !std::is_const_v<Of>;
      expect_refusal(std::apply(call_, all), name,
                     std::is_pointer_v<Of> ? Kind::handle
                     : is_results          ? Kind::results
                                           : Kind::other,
                     count);
    } else {
      const bool is_nothing = std::apply(call_, all) == Result{};
      EXPECT_TRUE(is_nothing);
      expect_refusal(std::nullopt, name, Kind::other, count);
    }
  }

  // The offsets of sets are wrong with any other number of points.
  template <typename T>
  static T good_beside(const std::string& wrong) {
    if (std::is_same_v<T, const std::size_t*> && wrong != "sets") return T{};
    return good<T>();
  }

  ::testing::ScopedTrace traced(const std::string& name, std::size_t count) const {
    return {__FILE__, __LINE__, function_ + ", " + name + " = " + std::to_string(count)};
  }

  std::string function_;
  Result (*call_)(Arguments...);
  std::vector<std::string> names_;
};

TEST(SmallArguments, OfAllFunctionsOfC) {
#define FUNCTION(name, parameters) Sweep(#name, parameters, name);
#include "flaunay_functions.inc"
#undef FUNCTION
}

// ---- Members of structs of C, and functions of C++

// call(count): with an array of some elements, or with none if count is kNull.
constexpr std::size_t kNull = 0;
struct Case {
  const char* word;  // what messages call the elements
  std::function<void(std::size_t count)> call;
};

template <typename T>
const T* array_for(std::size_t count, const T* array) {
  return count == kNull ? nullptr : array;
}
std::size_t counted(std::size_t count) { return count == kNull ? kCount : count; }

void expect_all_refused(const std::vector<Case>& cases, std::size_t most = 0) {
  for (const Case& one : cases) {
    SCOPED_TRACE(one.word);
    testing::expect_error(ErrorKind::usage, {one.word, "NULL"}, [&] { one.call(kNull); });
    for (const std::size_t count : kHuge) {
      if (count <= most) continue;
      SCOPED_TRACE(count);
      testing::expect_error(ErrorKind::input, {one.word, "too many"}, [&] { one.call(count); });
    }
  }
}

void throw_error_of(flaunay_status status) {
  const std::string message = flaunay_last_error();
  if (status == FLAUNAY_ERROR_INPUT) throw Error(ErrorKind::input, message);
  if (status == FLAUNAY_ERROR_USAGE) throw Error(ErrorKind::usage, message);
  if (status != FLAUNAY_SUCCESS) throw Error(ErrorKind::internal, message);
}

TEST(SmallArguments, InStructsOfC) {
  const auto constrained = [](const flaunay_constraints& given) {
    flaunay_triangulation* result = nullptr;
    throw_error_of(flaunay_triangulate_constrained(triangulator(), kPoints, kCount, nullptr, 0, &given,
                                                   nullptr, &result));
  };
  const auto of_polygons = [](const flaunay_polygons& given) {
    flaunay_triangulation* result = nullptr;
    throw_error_of(flaunay_triangulate_polygons(triangulator(), &given, nullptr, &result));
  };
  const auto chunks = [](const flaunay_chunk_options& given) {
    flaunay_chunk_report* report = nullptr;
    const flaunay_mesh_arrays none{};
    throw_error_of(flaunay_triangulate_chunks(kPoints, kCount, &none, &given, &report));
  };
  const auto lines = [](const flaunay_breaklines& given) {
    flaunay_chunk_report* report = nullptr;
    const flaunay_strided_points no_points{};
    const flaunay_strided_values no_values{};
    flaunay_raster raster{};
    raster.dx = raster.dy = 1;
    throw_error_of(flaunay_rasterize_chunks(&no_points, &no_values, 0, &raster, nullptr, nullptr, 0, nullptr,
                                            &given, nullptr, &report));
  };
  expect_all_refused({
      {"segments",
       [&](std::size_t count) {
         constrained({.segments = array_for(count, kTriangles), .segment_count = counted(count)});
       }},
      {"segments",
       [&](std::size_t count) {
         const flaunay_constraints given = {.segments = array_for(count, kTriangles),
                                            .segment_count = counted(count)};
         flaunay_dynamic* dynamic = nullptr;
         throw_error_of(flaunay_dynamic_create(triangulator(), kPoints, kCount, &given, nullptr, &dynamic));
       }},
      {"holes",
       [&](std::size_t count) {
         constrained({.holes = array_for(count, kPoints), .hole_count = counted(count)});
       }},
      {"seeds",
       [&](std::size_t count) {
         constrained(
             {.seeds = array_for(count, kPoints), .seed_attributes = kPoints, .seed_count = counted(count)});
       }},
      {"triangles of the mesh",
       [&](std::size_t count) {
         const flaunay_given_triangles mesh = {
             .triangles = array_for(count, kTriangles), .count = counted(count), .areas = kPoints};
         const flaunay_refinement refinement = {.mesh = &mesh};
         constrained({.refinement = &refinement});
       }},
      {"rings",
       [&](std::size_t count) {
         of_polygons({.coordinates = kPoints,
                      .ring_offsets = array_for(count, kOffsets),
                      .ring_count = counted(count)});
       }},
      {"devices",
       [&](std::size_t count) {
         const char* const host[] = {"host", "host", "host"};
         chunks({.devices = array_for(count, host), .device_count = counted(count)});
       }},
      {"triangulators",
       [&](std::size_t count) {
         flaunay_triangulator* const own[] = {triangulator(), triangulator(), triangulator()};
         chunks({.triangulators = array_for(count, own), .triangulator_count = counted(count)});
       }},
      {"events",
       [&](std::size_t count) {
         const cl_event none[kCount] = {};
         const flaunay_enqueue given = {.wait_for = array_for(count, none), .wait_for_count = counted(count)};
         throw_error_of(flaunay_dynamic_rows_device(good<flaunay_dynamic*>(), &given,
                                                    good<flaunay_device_triangulation*>()));
       }},
      {"points of breaklines",
       [&](std::size_t count) {
         lines({.coordinates = array_for(count, kPoints), .values = kPoints, .count = counted(count)});
       }},
      {"breaklines",
       [&](std::size_t count) {
         if (count != kNull) return lines({kPoints, kPoints, count, nullptr, 0, {}});
         lines({kPoints, nullptr, kCount, nullptr, 0, {}});
       }},
      {"segments of breaklines",
       [&](std::size_t count) {
         lines({.segments = array_for(count, kTriangles), .segment_count = counted(count)});
       }},
  });
  for (const std::size_t count : kHuge) {
    SCOPED_TRACE(count);
    flaunay_polygons given{};
    given.coordinates = kPoints;
    given.ring_offsets = kOffsets;
    given.ring_count = 1;
    given.polygon_offsets = kOffsets;
    given.polygon_count = count;
    testing::expect_error(ErrorKind::input, {"polygons", "too many"}, [&] { of_polygons(given); });
    given.polygon_count = 1;
    given.part_offsets = kOffsets;
    given.part_count = count;
    testing::expect_error(ErrorKind::input, {"parts", "too many"}, [&] { of_polygons(given); });
    flaunay_interpolation_options columns{};
    columns.columns = count;
    double result = 0;
    testing::expect_error(ErrorKind::input, {"columns", "too many"}, [&] {
      throw_error_of(flaunay_locator_gradients(good<flaunay_locator*>(), kPoints, &columns, &result));
    });
  }
}

TEST(SmallArguments, OfStreamsAndChunks) {
  const auto strided = [](std::size_t count) {
    return flaunay_strided_points{.coordinates = array_for(count, kPoints),
                                  .count = counted(count),
                                  .point_stride = 2 * sizeof(double),
                                  .coordinate_stride = sizeof(double)};
  };
  expect_all_refused(
      {
          {"points",
           [&](std::size_t count) {
             const flaunay_strided_points points = strided(count);
             flaunay_mesh_arrays none{};
             none.index_type = FLAUNAY_INT64;
             flaunay_chunk_report* report = nullptr;
             throw_error_of(flaunay_triangulate_chunks_to_files(&points, &none, nullptr, nullptr, &report));
           }},
          {"points",
           [&](std::size_t count) {
             const flaunay_strided_points points = strided(count);
             flaunay_mesh_arrays none{};
             none.index_type = FLAUNAY_INT64;
             flaunay_chunk_report* report = nullptr;
             flaunay_space space{};
             space.kind = FLAUNAY_SPACE_TORUS;
             space.period_x = space.period_y = 8;
             flaunay_chunk_options options{};
             options.space = &space;
             throw_error_of(flaunay_triangulate_chunks_to_files(&points, &none, nullptr, &options, &report));
           }},
          {"values",
           [&](std::size_t count) {
             const flaunay_strided_points points = strided(counted(count));
             flaunay_strided_values values{};
             values.values = array_for(count, kPoints);
             flaunay_raster raster{};
             raster.dx = raster.dy = 1;
             flaunay_chunk_report* report = nullptr;
             if (count != kNull)
               throw Error(ErrorKind::input, "too many values");  // there are as many as points
             throw_error_of(flaunay_rasterize_chunks(&points, &values, 0, &raster, nullptr, nullptr, 0,
                                                     nullptr, nullptr, nullptr, &report));
           }},
          {"points",
           [&](std::size_t count) {
             take_to_places({8, 8}, const_cast<double*>(array_for(count, kPoints)), counted(count));
           }},
          {"points",
           [&](std::size_t count) {
             triangulate_chunks(array_for(count, kPoints), counted(count), MeshArrays<std::int64_t>());
           }},
          {"points",
           [&](std::size_t count) {
             ChunkOptions options;
             options.space = Space::torus({8, 8});
             triangulate_chunks(array_for(count, kPoints), counted(count), MeshArrays<std::int64_t>(),
                                options);
           }},
      },
      power_of_two(31));
}

TEST(SmallArguments, OfFunctionsOfCxx) {
  Triangulator used("host");
  const Triangulation mesh = used.triangulate(kPoints, kCount);
  const ConstrainedTriangulation constrained = used.constrained(kPoints, kCount, {});
  const Triangulation sphere = used.triangulate(kPoints, kCount, Space::sphere(SphereCoordinates::degrees));
  const Triangulation torus = used.triangulate(kPoints, kCount, Space::torus({8, 8}));
  Locator locator(used, kPoints, kCount, mesh);
  Locator on_sphere(used, sphere);
  Locator on_torus(used, torus);
  PointTree tree(used, kPoints, kCount);
  DynamicTriangulation dynamic(used, kPoints, kCount);
  const auto points = [](std::size_t count) { return array_for(count, kPoints); };
  const auto indices = [](std::size_t count) { return array_for(count, kTriangles); };
  const auto with_segments = [&](std::size_t count) {
    Constraints given;
    given.segments = indices(count);
    given.segment_count = counted(count);
    return given;
  };
  const auto degrees = SphereCoordinates::degrees;
  expect_all_refused({
      {"points", [&](std::size_t n) { used.triangulate(points(n), counted(n)); }},
      {"points", [&](std::size_t n) { used.constrained(points(n), counted(n), {}); }},
      {"points",
       [&](std::size_t n) {
         used.polygons({points(n), {0, counted(n)}, {0, 1}});
       }},
      {"points", [&](std::size_t n) { used.relax(points(n), counted(n), kPoints, 3); }},
      {"points", [&](std::size_t n) { used.relax(points(n), counted(n), Space::sphere(degrees)); }},
      {"points", [&](std::size_t n) { used.voronoi(points(n), counted(n), mesh); }},
      {"points", [&](std::size_t n) { used.clipped_voronoi(points(n), counted(n), mesh, kPoints, 3); }},
      {"points", [&](std::size_t n) { Locator(used, points(n), counted(n), mesh); }},
      {"points", [&](std::size_t n) { Locator(used, points(n), counted(n), constrained); }},
      {"points", [&](std::size_t n) { PointTree(used, points(n), counted(n)); }},
      {"points", [&](std::size_t n) { DynamicTriangulation(used, points(n), counted(n)); }},
      {"points", [&](std::size_t n) { dynamic.insert(points(n), counted(n)); }},
      {"points", [&](std::size_t n) { dynamic.remove(indices(n), counted(n)); }},
      {"points", [&](std::size_t n) { dynamic.move(kTriangles, points(n), counted(n)); }},
      {"points", [&](std::size_t n) { used.triangulate(points(n), counted(n), Space::sphere(degrees)); }},
      {"points",
       [&](std::size_t n) {
         used.triangulate(points(n), counted(n), Space::torus({8, 8}));
       }},
      {"points",
       [&](std::size_t n) { used.triangulate(points(n), counted(n), Space::plane().with_weights(kPoints)); }},
      {"points",
       [&](std::size_t n) {
         research::Options options;
         options.mode = research::Mode::dwyer;
         research::triangulate_on_host(points(n), {0, counted(n)}, options);
       }},
      {"points", [&](std::size_t n) { research::partition(used, points(n), counted(n), 1); }},
      {"points",
       [&](std::size_t n) {
         rasterize(used, {points(n), counted(n), nullptr, nullptr, 0}, kPoints, {}, {}, nullptr);
       }},
      {"triangles",
       [&](std::size_t n) {
         trace_contours(used, {kPoints, 3, indices(n), kTriangles, counted(n)}, kPoints, {});
       }},
      {"segments", [&](std::size_t n) { used.constrained(kPoints, kCount, with_segments(n)); }},
      {"segments",
       [&](std::size_t n) {
         Constraints given = with_segments(n);
         given.rings = {{0, counted(n)}, {0, 1}, {0, 1}};
         ConstrainedOptions options;
         options.fill_rule = FillRule::even_odd;
         used.constrained(kPoints, kCount, given, options);
       }},
      {"segments", [&](std::size_t n) { DynamicTriangulation(used, kPoints, kCount, with_segments(n)); }},
      {"triangles of the mesh",
       [&](std::size_t n) {
         ConstrainedOptions options;
         options.refinement.mesh = {indices(n), counted(n), kPoints, nullptr};
         used.constrained(kPoints, kCount, {}, options);
       }},
      {"queries", [&](std::size_t m) { locator.locate(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { locator.nearest(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { locator.interpolate(kPoints, points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { locator.natural_weights(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { tree.nearest(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { on_sphere.locate(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { on_sphere.nearest(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { on_sphere.interpolate(kPoints, points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { on_torus.locate(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { on_torus.nearest(points(m), counted(m)); }},
      {"queries", [&](std::size_t m) { on_torus.interpolate(kPoints, points(m), counted(m)); }},
  });
  for (const std::size_t count : kHuge) {
    for (const std::size_t queries : {std::size_t{0}, kCount}) {
      const auto refused = [&](const std::function<void()>& call) {
        testing::expect_error(ErrorKind::input, {"columns", "too many"}, call);
      };
      InterpolationOptions options;
      options.columns = count;
      refused([&] { on_sphere.interpolate(kPoints, kPoints, queries, options); });
      refused([&] { on_torus.interpolate(kPoints, kPoints, queries, options); });
      refused([&] { locator.gradients(kPoints, count); });
    }
  }
}

// ---- Enumerators

TEST(SmallArguments, UnknownEnumerators) {
  Triangulator used("host");
  const Triangulation mesh = used.triangulate(kPoints, kCount);
  Locator locator(used, kPoints, kCount, mesh);
  const auto constrained = [&](const auto& change) {
    PolygonOptions options;
    change(options);
    used.polygons({kPoints, {0, 3}, {0, 1}}, options);
    used.constrained(kPoints, kCount, {}, options);
  };
  const auto research = [&](const auto& change) {
    research::Options options;
    change(options);
    research::triangulate(used, kPoints, kCount, options);
  };
  struct {
    const char* name;
    std::function<void(int value)> call;
  } const cases[] = {
      {"Crossings", [&](int v) { constrained([&](auto& o) { o.crossings = static_cast<Crossings>(v); }); }},
      {"Outside", [&](int v) { constrained([&](auto& o) { o.outside = static_cast<Outside>(v); }); }},
      {"FillRule", [&](int v) { constrained([&](auto& o) { o.fill_rule = static_cast<FillRule>(v); }); }},
      {"Overlaps", [&](int v) { constrained([&](auto& o) { o.overlaps = static_cast<Overlaps>(v); }); }},
      {"KeptEdges",
       [&](int v) { constrained([&](auto& o) { o.refinement.kept = static_cast<KeptEdges>(v); }); }},
      {"Interpolation",
       [&](int v) {
         InterpolationOptions options;
         options.method = static_cast<Interpolation>(v);
         locator.interpolate(kPoints, kPoints, kCount, options);
       }},
      {"Interpolation",
       [&](int v) { locator.natural_weights(kPoints, kCount, static_cast<Interpolation>(v)); }},
      {"SphereCoordinates",
       [&](int v) { used.triangulate(kPoints, kCount, Space::sphere(static_cast<SphereCoordinates>(v))); }},
      {"SpaceKind",
       [&](int v) {
         Space space = Space::plane();
         space.kind = static_cast<SpaceKind>(v);
         used.triangulate(kPoints, kCount, space);
       }},
      {"Duplicates",
       [&](int v) {
         struct : ValuedPoints {
           std::uint64_t size() const override { return 0; }
           void read(std::uint64_t, std::size_t, double*) override {}
           void read_values(std::uint64_t, std::size_t, double*) override {}
         } none;
         rasterize_chunks(none, static_cast<Duplicates>(v), {}, {}, nullptr);
       }},
      {"Mode", [&](int v) { research([&](auto& o) { o.mode = static_cast<research::Mode>(v); }); }},
      {"Cut", [&](int v) { research([&](auto& o) { o.cut = static_cast<research::Cut>(v); }); }},
      {"Hull", [&](int v) { research([&](auto& o) { o.hull = static_cast<research::Hull>(v); }); }},
      {"Finish", [&](int v) { research([&](auto& o) { o.finish = static_cast<research::Finish>(v); }); }},
      {"Record", [&](int v) { research([&](auto& o) { o.record = static_cast<research::Record>(v); }); }},
  };
  for (const auto& one : cases) {
    for (const int value : {-1, 77}) {
      SCOPED_TRACE(one.name);
      testing::expect_error(ErrorKind::usage, {std::to_string(value) + " is no " + one.name},
                            [&] { one.call(value); });
    }
  }
}

// ---- Arrays of meshes that are not what a call made

TEST(SmallArguments, PlacesThatAreNone) {
  Triangulator used("host");
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                   kInfinite = std::numeric_limits<double>::infinity();
  const Triangulation sphere = used.triangulate(kPoints, 5, Space::sphere(SphereCoordinates::degrees));
  const Triangulation torus = used.triangulate(kPoints, 5, Space::torus({8, 8}));
  for (const double wrong : {kNone, -kInfinite, 1e300, 0x1p-80}) {
    SCOPED_TRACE(wrong);
    for (std::size_t i = 0; i < 10; ++i) {
      Triangulation changed = sphere;
      changed.places[i] = wrong;
      const std::string place = "place " + std::to_string(i / 2);
      testing::expect_error(ErrorKind::usage, {place}, [&] { Locator(used, changed); });
      testing::expect_error(ErrorKind::usage, {place}, [&] { used.voronoi(changed); });
      Triangulation moved = torus;
      moved.places[i] = wrong;
      testing::expect_error(ErrorKind::usage, {place}, [&] { Locator(used, moved); });
      testing::expect_error(ErrorKind::usage, {place}, [&] { used.clipped_voronoi(moved); });
    }
  }
}

TEST(SmallArguments, PeriodsThatAreNone) {
  Triangulator used("host");
  for (const double wrong : {0.0, -1.0, 1e271, 1e-272, std::numeric_limits<double>::quiet_NaN()}) {
    testing::expect_error(ErrorKind::usage, {"2^900", "1.2e-271", "8.4e270"}, [&] {
      used.triangulate(kPoints, kCount, Space::torus({wrong, 1}));
    });
  }
}

}  // namespace
}  // namespace flaunay
