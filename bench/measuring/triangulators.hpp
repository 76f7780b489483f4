// Triangulators that are set beside each other: flaunay's modes, by name, and peers.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/measuring/inputs.hpp"
#include "bench/measuring/jobs.hpp"
#include "flaunay/research.hpp"

namespace flaunay::bench {

/// The names that --hulls takes.
std::vector<std::string> hull_names();
/// Throws Error(usage) if no mode has this name.
const research::ModeInfo& mode_named(const std::string& name);
research::Options options_of(const std::string& mode, const std::string& hull = "prune");

/// The device that is meant where kernels must run on OpenCL: the given one or the triangulator's own choice,
/// but instead of the host itself the first that OpenCL offers.
std::string opencl_device(const std::string& given);

/// One call on all sets of the input.
research::Triangulation call(Triangulator& triangulator, const Input& input,
                             const research::Options& options);

struct Implementation {
  std::string name;
  std::function<Outcome(const Input&)> run;
  std::optional<research::Options> options = {};  ///< only of flaunay's modes
};
using Implementations = std::vector<Implementation>;

/// "flaunay-partition"
std::string implementation_name(const std::string& mode);

/// A mode of flaunay, prepared: one-time work, such as compiling kernels, is in no measured run.
Implementation mode_implementation(Triangulator& triangulator, const std::string& name,
                                   const research::Options& options);
/// threads: of the host, where the mode uses some; 0: one per core.
Implementations mode_implementations(Triangulator& triangulator, const std::vector<std::string>& modes,
                                     int threads = 0);

/// A call for each set, one after the other.
Outcome call_on_sets(Triangulator& triangulator, const Input& input, const research::Options& options);

constexpr const char* kCgal = "cgal";

/// The peers of these names that this build has. Names of missing peers go to standard error.
Implementations peer_implementations(const std::vector<std::string>& names);

/// Both, CGAL last.
Implementations modes_and_cgal(Triangulator& triangulator, const std::vector<std::string>& modes);

/// All implementations on all inputs. Jobs of an input are consecutive, so that they run side by side.
Jobs make_jobs(const Implementations& implementations, const std::vector<Input>& inputs);

/// Runs each of these peers once in a process of its own, see ask_child: before there is a device. Jobs of
/// peers that are too slow or fail are skipped, as are inputs of more points than `most`; larger inputs of
/// the same distribution are not tried then.
Jobs try_peers(const std::vector<std::string>& names, const std::vector<Input>& inputs, double limit,
               std::size_t most);

/// The jobs of peers and of flaunay, ordered by input.
Jobs beside(Jobs peers, const Implementations& own, const std::vector<Input>& inputs);

/// Adds the device memory to the rows of flaunay's jobs: the most that a new triangulator holds at once.
void measure_device_memory(Jobs& jobs, const std::string& device);

}  // namespace flaunay::bench
