#include "host/launch/launch_log.hpp"

#include <utility>

#include "operations/counting.h"

namespace flaunay::host {

static_assert(kernel::STEP_COUNTERS == 3);

LaunchLog::LaunchLog(MemorySource memory, bool counts_steps)
    : counts_steps_(counts_steps), arena_(std::move(memory)) {
  if (counts_steps_) counters_ = arena_.allocate<cl_uint>(kernel::COUNTERS_LENGTH);
}

cl_uint* LaunchLog::steps_of_last() {
  steps_.push_back({last(), {}});
  return steps_.back().counters;
}

std::vector<Launch> LaunchLog::launches() const {
  std::vector<Launch> result = launches_;
  for (const Steps& of : steps_) {
    result[of.launch].longest_chain = of.counters[0];
    result[of.launch].steps = of.counters[1] + (static_cast<std::uint64_t>(of.counters[2]) << 32);
  }
  return result;
}

void LaunchLog::clear() {
  launches_.clear();
  steps_.clear();
}

}  // namespace flaunay::host
