// Progress while the device works: points in the enqueued work that are reported when the device has reached
// them.
#pragma once

#include <CL/cl.h>

#include <memory>
#include <vector>

#include "host/runtime.hpp"
#include "statistics/phases.hpp"

namespace flaunay::blocks {

/// Does nothing, and costs nothing, unless the caller wants progress.
class Milestones {
 public:
  Milestones(host::Runtime& runtime, const statistics::Phases& phases) : runtime_(runtime), phases_(phases) {}

  bool are_wanted() const { return phases_.are_heard(); }
  /// When the commands enqueued so far are complete, this share of the call is done. stage: a literal.
  void set(const char* stage, double done);
  /// Waits for one milestone after the other, and reports it.
  void report();

 private:
  struct Milestone {
    const char* stage;
    double done;
    std::shared_ptr<_cl_event> reached;
  };
  host::Runtime& runtime_;
  const statistics::Phases& phases_;
  std::vector<Milestone> milestones_;
};

}  // namespace flaunay::blocks
