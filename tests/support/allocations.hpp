// Makes allocations of the test program and of the library in it fail.
#pragma once

#include <cstddef>

namespace flaunay::testing {

/// Which allocations fail while a FailingAllocations lives: of memory, and of threads.
enum class Failing {
  one,  ///< one of them
  all,  ///< that one and all later ones
};

/// As long as it lives, allocations on all threads are counted, and those from `first` on, counted from 0,
/// fail. There must be one at a time.
class FailingAllocations {
 public:
  FailingAllocations(std::size_t first, Failing failing);
  ~FailingAllocations();
  FailingAllocations(const FailingAllocations&) = delete;
  FailingAllocations& operator=(const FailingAllocations&) = delete;

  /// Whether any failed.
  bool reached() const;
};

/// The number of blocks of memory that the operators new have made and delete has not freed.
long live_allocations();

}  // namespace flaunay::testing
