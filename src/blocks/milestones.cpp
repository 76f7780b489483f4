#include "blocks/milestones.hpp"

#include <utility>

namespace flaunay::blocks {

void Milestones::set(const char* stage, double done) {
  if (!are_wanted()) return;
  const cl_event reached = runtime_.mark();
  // Native kernels have run when they are enqueued.
  if (reached == nullptr) return phases_.progress(stage, done);
  milestones_.push_back({stage, done, std::shared_ptr<_cl_event>(reached, clReleaseEvent)});
}

void Milestones::report() {
  if (milestones_.empty()) return;
  runtime_.flush();
  for (const Milestone& milestone : std::exchange(milestones_, {})) {
    runtime_.await(milestone.reached.get());
    phases_.progress(milestone.stage, milestone.done);
  }
}

}  // namespace flaunay::blocks
