// What the bench calls of flaunay beyond its default mode: modes and hulls by name, and what a call counted.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/measuring/inputs.hpp"
#include "flaunay/research.hpp"

namespace flaunay::bench {

inline constexpr research::Mode kDefaultMode = research::Mode::blocks;

/// The names that --modes and --hulls take: every mode, the default first, and every hull.
std::vector<std::string> mode_names();
std::vector<std::string> hull_names();
/// Throws Error(usage) if there is none of this name.
const research::ModeInfo& mode_named(const std::string& name);
research::Hull hull_named(const std::string& name);

/// The device that is meant where kernels must run on OpenCL: the given one or the triangulator's own choice,
/// but instead of the host itself the first that OpenCL offers.
std::string opencl_device(const std::string& given);

research::Options options_of(const std::string& mode, const std::string& hull = "prune");

/// One call on all sets of the input.
research::Triangulation call(Triangulator& triangulator, const Input& input,
                             const research::Options& options);
/// On one set.
research::Triangulation call(Triangulator& triangulator, const double* coordinates, std::size_t n,
                             const research::Options& options);
research::Triangulation call_on_host(const Input& input, const research::Options& options);

const char* component_name(std::size_t component);
/// Over what precedes the first cut and all levels, by component.
research::Work::Components totals(const research::Work& work);
research::OperationCounts total(const research::Work::Components& components);

/// The most device memory that calls hold at once.
class DeviceMemory {
 public:
  explicit DeviceMemory(std::string device) : device_(std::move(device)) {}
  /// Ask in ascending order of size, because a triangulator keeps its memory for the next call. Each mode and
  /// hull has a triangulator of its own.
  std::size_t peak(const Input& input, const research::Options& options);

 private:
  std::string device_;
  std::map<std::pair<research::Mode, research::Hull>, Triangulator> triangulators_;
};

}  // namespace flaunay::bench
