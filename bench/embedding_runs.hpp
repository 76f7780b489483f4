// What a program with an OpenCL context of its own asks of flaunay: everything stays in device memory.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "peer_queries.hpp"
#include "tests/support/embedder.hpp"
#include "timing.hpp"

namespace flaunay::bench {

/// Parts that are measured together, with a name for tables.
struct NamedParts {
  std::string name;
  Parts parts;
};
const std::vector<NamedParts>& measured_parts();

/// One thing that is timed again and again.
struct Timed {
  std::string operation;       ///< "triangulate", "locate"...
  std::string implementation;  ///< and in what way
  std::string parts;           ///< of triangulate
  std::string precision;       ///< of points and queries
  std::size_t n;               ///< points
  std::size_t count;           ///< points or queries that the seconds are for
  std::size_t measured;        ///< of these; the seconds are scaled
  std::function<double()> run;
  std::vector<double> seconds = {};

  double median() const { return summary(seconds).median; }
};

/// What the first and the second call of a new triangulator did.
struct Calls {
  std::string parts, precision;
  std::size_t n;
  Statistics first, second;
};

/// A program that has a context, queues and buffers of its own, and beside it a triangulator with its own.
class Caller {
 public:
  explicit Caller(const std::string& device);

  testing::Memory upload(const std::vector<double>& values, Precision precision) const;
  template <typename T>
  std::vector<T> download(const DeviceBuffer& buffer) const {
    return embedder_.download<T>(buffer.memory(), buffer.bytes() / sizeof(T));
  }
  /// Enqueues work on the caller's queue; seconds to the completion of its event.
  double seconds_to_completion(const std::function<void(const Enqueue&)>& work) const;
  /// On a queue that profiles.
  Enqueue profiled() const;
  /// A new one in the caller's context, without memory.
  Triangulator new_triangulator() const { return {embedder_.context(), embedder_.device()}; }

  Triangulator& host() { return host_; }
  Triangulator& embedded() { return embedded_; }

 private:
  Triangulator host_;  // first: it chooses the device
  testing::Embedder embedder_;
  testing::Queue profiling_;
  Triangulator embedded_;
};

/// Triangulating the same points, from the host and from device memory. To stay where it is.
class TriangulationRuns {
 public:
  TriangulationRuns(Caller& caller, const std::vector<double>& coordinates);
  TriangulationRuns(const TriangulationRuns&) = delete;
  TriangulationRuns& operator=(const TriangulationRuns&) = delete;

  std::vector<Timed> rows();
  std::vector<Calls> first_calls() const;
  /// Whether all runs had as many triangles; says so if not.
  bool agree() const { return agree_; }

 private:
  DevicePoints points(Precision precision) const;
  Triangulation run_host(const Parts& parts, bool profile);
  void run_device(Precision precision, const Parts& parts, const Enqueue& enqueue);
  void check(std::size_t triangles, const std::string& what);
  Timed row(const std::string& implementation, const std::string& parts, Precision precision,
            std::function<double()> run) const;
  void add_host_rows(std::vector<Timed>& rows, const NamedParts& parts);
  void add_device_rows(std::vector<Timed>& rows, const NamedParts& parts, Precision precision);

  Caller& caller_;
  const std::vector<double>& coordinates_;
  testing::Memory wide_, narrow_;
  DeviceTriangulation result_;
  std::size_t triangles_ = 0;
  bool agree_ = true;
};

/// What is derived from the triangulation of points, on as many queries, beside CGAL. To stay where it is.
class QueryRuns {
 public:
  /// Queries of CGAL's that walk far each: no more than so many.
  QueryRuns(Caller& caller, const std::vector<double>& coordinates, const std::vector<double>& queries,
            std::size_t most_far_walks);
  QueryRuns(const QueryRuns&) = delete;
  QueryRuns& operator=(const QueryRuns&) = delete;

  std::vector<Timed> rows();
  /// Whether all answers are CGAL's; says so if not. After the rows were run.
  bool agree() const;

 private:
  std::size_t n() const { return points_.count; }
  Timed row(const std::string& operation, const std::string& implementation, std::size_t measured,
            std::function<double()> run) const;
  void add_own_rows(std::vector<Timed>& rows);
  void add_cgal_rows(std::vector<Timed>& rows, Start start);
  /// Points whose cells have not as many corners as CGAL's.
  std::size_t wrong_cells() const;
  std::size_t wrong_triangles(const std::vector<std::int32_t>& located,
                              const std::vector<Corners>& expected) const;
  std::size_t wrong_points(const std::vector<std::int32_t>& nearest,
                           const std::vector<std::int32_t>& expected) const;

  Caller& caller_;
  std::vector<double> queries_, far_queries_;
  testing::Memory coordinates_memory_, queries_memory_, values_memory_;
  DevicePoints points_, query_points_;
  DeviceTriangulation mesh_;
  DeviceVoronoi voronoi_;
  std::unique_ptr<Locator> locator_;
  DeviceBuffer located_, nearest_, interpolated_;
  std::unique_ptr<CgalQueries> cgal_;
  // The last answers of each of CGAL's ways.
  std::vector<std::vector<Corners>> cgal_located_;
  std::vector<std::vector<std::int32_t>> cgal_nearest_;
  CgalVoronoi cgal_voronoi_;
};

}  // namespace flaunay::bench
