#include "host/launch/launch_log.hpp"

#include <utility>

namespace flaunay::host {

LaunchLog::LaunchLog(MemorySource memory, const CountedWords& words)
    : words_(words), arena_(std::move(memory)) {
  if (words_.length > 0) counters_ = arena_.allocate<cl_uint>(words_.length);
}

cl_uint* LaunchLog::counted_of_last() {
  launches_.back().counted.resize(words_.count);
  return launches_.back().counted.data();
}

std::vector<Launch> LaunchLog::launches() const { return {launches_.begin(), launches_.end()}; }

void LaunchLog::clear() { launches_.clear(); }

}  // namespace flaunay::host
