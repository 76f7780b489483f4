// Modes of flaunay and other implementations on the same inputs: running them in turns, whether they agree,
// and how the outcome is shown.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "inputs.hpp"
#include "peer.hpp"
#include "plot.hpp"
#include "timing.hpp"

namespace flaunay::bench {

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

struct Implementation {
  std::string name;
  std::function<Outcome(const Input&)> run;
};

/// "flaunay-partition"
std::string implementation_name(const std::string& mode);

/// The mode in such a name.
std::string mode_of(const std::string& implementation);

/// flaunay's modes by their names, prepared. threads: of the host, where the mode uses some; 0: one per core.
std::vector<Implementation> mode_implementations(Triangulator& triangulator,
                                                 const std::vector<std::string>& modes, int threads = 0);

constexpr const char* kCgal = "cgal";

/// Those of these names that this build has; standard error is told of the others.
std::vector<Peer> chosen_peers(const std::vector<std::string>& names);

std::vector<Implementation> implementations_of(const std::vector<Peer>& peers);

/// Both, CGAL last.
std::vector<Implementation> modes_and_cgal(Triangulator& triangulator, const std::vector<std::string>& modes);

/// One implementation on one input.
struct Entry {
  std::string implementation;
  const Input* input;
  std::size_t triangles = 0;
  std::size_t bytes_peak = 0;        ///< 0 if it was not measured
  std::string skipped = {};          ///< why there are no times; else empty
  std::vector<double> seconds = {};  ///< of the counted runs
  bool agrees = true;                ///< as many triangles as there should be; see check_counts

  bool of_flaunay() const;
  /// Measured with a right result: time for a wrong one says nothing.
  bool valid() const { return skipped.empty() && agrees; }
};

/// All implementations on all inputs; those of an input stand together, so that they run side by side.
std::vector<Entry> make_entries(const std::vector<Implementation>& implementations,
                                const std::vector<Input>& inputs);

/// Runs each peer once in a process of its own, see ask_child. The entries of those that are too slow or fail
/// are marked as skipped; larger inputs of the same distribution are not tried then.
std::vector<Entry> try_peers(const std::vector<Peer>& peers, const std::vector<Input>& inputs, double limit);

/// All of both by input, so that those of an input run side by side.
std::vector<Entry> by_input(std::vector<Entry> entries, const std::vector<Entry>& more);

/// Measures all entries that are not skipped, in turns. What is over soon is repeated within a run. An
/// implementation whose first run on a distribution took longer than `limit` seconds (0: none) is not run
/// on its larger inputs, which must come later.
void measure(std::vector<Entry>& entries, const std::vector<Implementation>& implementations, int runs,
             double limit = 0);

/// Whether two implementations have as many triangles on an input; says loudly if not.
bool same_count(const Input& input, const std::string& first, std::size_t expected, const std::string& other,
                std::size_t triangles);

/// Marks the entries that have not as many triangles as CGAL's of the same input, or as the first if CGAL was
/// not run; whether there are none.
bool check_counts(std::vector<Entry>& entries);

/// Median seconds, if the entry is there and valid.
std::optional<double> median_of(const std::vector<Entry>& entries, const std::string& implementation,
                                const std::string& distribution, std::size_t n);

std::vector<const Entry*> valid_entries(const std::vector<Entry>& entries, const Input& input);

// ---- What is shown of it

void print_entries(const std::vector<Entry>& entries);

/// Adds `results` and `skipped` to a record.
void add_entries(nlohmann::json& record, const std::vector<Entry>& entries);

/// Adds a point to the series of this name, which is made if there is none: time per point by size.
void add_time_per_point(plot::Lines& panel, const std::string& series, std::size_t n, const Summary& seconds);

/// A line for each implementation.
plot::Lines time_per_point_panel(const std::vector<Entry>& entries, const std::vector<std::size_t>& sizes,
                                 const std::string& distribution);

/// The times of one input as bars.
plot::BarGroup time_bars(const std::vector<Entry>& entries, const Input& input, const std::string& name);

}  // namespace flaunay::bench
