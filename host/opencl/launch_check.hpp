// Compares a device with the host, launch by launch: each kernel of a call runs on the device and natively,
// on equal arrays, and must leave the same bytes. Whatever calls a test makes thereby test every kernel that
// they launch.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "host/backend.hpp"
#include "host/launch/argument_list.hpp"

namespace flaunay::host {

/// As long as it lives, launches of the thread that made it are compared. It copies all arrays of a launch,
/// so it is for small inputs.
class LaunchCheck {
 public:
  /// The results of comparing one kernel.
  struct Tested {
    std::size_t launches = 0;
    bool was_compared = false;           ///< whether it ran natively, too
    std::size_t largest_comparable = 0;  ///< largest work-group with which it can run natively
    std::string difference;              ///< where its first difference was; empty if there was none
  };

  /// compares: whether kernels run natively, too; otherwise launches are only counted.
  explicit LaunchCheck(bool compares);
  ~LaunchCheck();
  LaunchCheck(const LaunchCheck&) = delete;
  LaunchCheck& operator=(const LaunchCheck&) = delete;

  /// The check of this thread; null if it has none.
  static LaunchCheck* of_thread();

  /// Launches by `on_device`, and compares. work_items: with those that fill up the last group; options:
  /// those that the kernel was compiled with.
  void launch(const KernelName& name, const ArgumentList& arguments, std::size_t work_items,
              std::size_t group, const std::string& options, Backend& backend,
              const std::function<void()>& on_device);

  /// The results per program and kernel, such as "blocks/mesh: emit_triangles".
  const std::map<std::string, Tested>& kernels() const { return kernels_; }

 private:
  bool compares_;
  LaunchCheck* outer_;
  std::map<std::string, Tested> kernels_;
};

}  // namespace flaunay::host
