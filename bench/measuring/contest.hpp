// Implementations on the same inputs: running them in turns, whether they agree, and the rows of records.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/measuring/calls.hpp"
#include "bench/measuring/command.hpp"
#include "bench/measuring/inputs.hpp"
#include "bench/measuring/timing.hpp"

namespace flaunay::bench {

/// What one run of an implementation gave.
struct Outcome {
  double seconds = 0;  ///< of what the implementation's description says
  std::size_t triangles = 0;
  Json details = Json::object();  ///< more keys for the row of the record
};

struct Implementation {
  std::string name;
  std::function<Outcome(const Input&)> run;
  std::optional<research::Options> options = {};  ///< only of flaunay's modes
};
using Implementations = std::vector<std::shared_ptr<const Implementation>>;

std::shared_ptr<const Implementation> implementation(const std::string& name,
                                                     std::function<Outcome(const Input&)> run,
                                                     std::optional<research::Options> options = {});

/// A call for each set, or for every stride-th one, one after the other.
Outcome call_on_sets(Triangulator& triangulator, const Input& input, const research::Options& options,
                     std::size_t stride = 1);

/// "flaunay-partition"
std::string implementation_name(const std::string& mode);

/// A mode of flaunay, prepared: what is made once, such as compiled kernels, is in no measured run.
std::shared_ptr<const Implementation> mode_implementation(Triangulator& triangulator, const std::string& name,
                                                          const research::Options& options);

/// threads: of the host, where the mode uses some; 0: one per core.
Implementations mode_implementations(Triangulator& triangulator, const std::vector<std::string>& modes,
                                     int threads = 0);

constexpr const char* kCgal = "cgal";

/// The peers of these names that this build has; standard error is told of the others.
Implementations peer_implementations(const std::vector<std::string>& names);

/// Both, CGAL last.
Implementations modes_and_cgal(Triangulator& triangulator, const std::vector<std::string>& modes);

/// One implementation on one input. Its row says which.
struct Entry : Job {
  Entry(std::shared_ptr<const Implementation> one, const Input& on);

  std::shared_ptr<const Implementation> implementation;
  const Input* input;
  Outcome outcome = {};        ///< of the last run
  std::size_t bytes_peak = 0;  ///< 0 if it was not measured
  bool agrees = true;          ///< as many triangles as there should be; see check_counts

  const std::string& name() const { return implementation->name; }
  /// Measured with a right result: time for a wrong one says nothing.
  bool valid() const { return skipped.empty() && agrees; }
};
using Entries = std::vector<Entry>;

/// All implementations on all inputs; those of an input stand together, so that they run side by side.
Entries make_entries(const Implementations& implementations, const std::vector<Input>& inputs);

/// Runs each of these peers once in a process of its own, see ask_child: before there is a device. The
/// entries of those that are too slow or fail are marked as skipped; larger inputs of the same distribution
/// are not tried then.
Entries try_peers(const std::vector<std::string>& names, const std::vector<Input>& inputs, double limit);

/// Flaunay's entries and those of peers by input, so that those of an input run side by side.
Entries beside(Entries peers, const Implementations& own, const std::vector<Input>& inputs);

/// Measures all entries that are not skipped, in turns. An implementation whose first run on a distribution
/// took longer than `limit` seconds (0: no limit) is not run on its larger inputs, which must come later.
void measure(Entries& entries, int runs, double limit = 0);

/// Fills in the device memory of flaunay's entries.
void measure_device_memory(Entries& entries, const std::string& device);

/// Marks the entries that have not as many triangles as CGAL's of the same input, or as the first if CGAL was
/// not run, and says so loudly. Whether there are none, and at least one entry was measured.
bool check_counts(Entries& entries);

/// Median seconds, if the entry is there and valid.
std::optional<double> median_of(const Entries& entries, const std::string& implementation,
                                const std::string& distribution, std::size_t n);

/// Checks the entries' counts, and adds rows to the tables "results" and "skipped"; each ends with these
/// keys.
void add_entries(Result& result, Entries& entries, const Json& keys = Json::object());

}  // namespace flaunay::bench
