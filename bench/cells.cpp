// flaunay-bench cells: clipped Voronoi cells and relaxation, beside a triangulation and the dual.
#include <cmath>

#include "calls.hpp"
#include "command.hpp"
#include "inputs.hpp"

namespace flaunay::bench::cells {
namespace {

struct Request : Measurement {
  std::vector<std::size_t> sizes{100000, 1000000};
  int iterations = 4;
};

const std::vector<double> kBox = {0, 0, 1, 0, 1, 1, 0, 1};
constexpr double kAreaTolerance = 1e-9;

/// One size: its points, and what is made of them.
class Subject {
 public:
  Subject(Triangulator& triangulator, std::size_t n, int iterations)
      : triangulator_(triangulator), n_(n), iterations_(iterations) {
    points_ = make_input("uniform", n).coordinates;
    mesh_ = triangulator_.triangulate(points_.data(), n_);
  }

  void add_jobs(std::vector<Job>& jobs) const {
    add(jobs, "triangulate", [this] { triangulator_.triangulate(points_.data(), n_); });
    add(jobs, "voronoi", [this] { triangulator_.voronoi(points_.data(), n_, mesh_); });
    add(jobs, "clipped voronoi", [this] { clipped(); });
    const auto relax = [this] {
      triangulator_.relax(points_.data(), n_, kBox.data(), kBox.size() / 2,
                          static_cast<std::size_t>(iterations_));
    };
    jobs.push_back({"relax, per iteration", [this, relax] { return time_of(relax) / iterations_; }});
  }

  /// Whether the cells have the box's area.
  bool is_tiled() const {
    double area = 0;
    for (const double each : clipped().areas) area += each;
    return std::abs(area - 1) < kAreaTolerance;
  }

 private:
  ClippedVoronoi clipped() const {
    return triangulator_.clipped_voronoi(points_.data(), n_, mesh_, kBox.data(), kBox.size() / 2);
  }
  static double time_of(const std::function<void()>& work) {
    const Stopwatch watch;
    work();
    return watch.seconds();
  }
  static void add(std::vector<Job>& jobs, const std::string& name, const std::function<void()>& work) {
    jobs.push_back({name, [work] { return time_of(work); }});
  }

  Triangulator& triangulator_;
  std::size_t n_;
  int iterations_;
  std::vector<double> points_;
  Triangulation mesh_;
};

Result measure_cells(const Request& request) {
  Triangulator triangulator(request.device);
  Result result{triangulator.device()};
  for (const std::size_t n : request.sizes) {
    const Subject subject(triangulator, n, request.iterations);
    std::vector<Job> jobs;
    subject.add_jobs(jobs);
    run_interleaved(jobs, request.runs);
    const double triangulation = summary(jobs.front().seconds).median;
    for (const Job& job : jobs) {
      Json row{{"points", n}, {"call", job.name}};
      add_seconds(row, job.seconds);
      row["of_triangulate"] = summary(job.seconds).median / triangulation;
      result.tables["results"].push_back(row);
    }
    result.agree &= subject.is_tiled();
  }
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(
      app, action, "cells", "Voronoi cells clipped to a box, and Lloyd's relaxation",
      "Uniform points and the unit square, from host memory to host memory. triangulate: the call that the "
      "others begin with, but for relax, which has it in each iteration. relax: seconds per iteration of one "
      "call. All take turns; the first run of each is not counted. The exit code is 1 if the areas of the "
      "cells do not add up to that of the square.",
      request, measure_cells);
  add_sizes_option(command, request->sizes);
  add_option(command, "--iterations", request->iterations, "iterations of each call of relax");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::cells
