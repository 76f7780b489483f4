// Programs of one OpenCL device: compiled from kernel files, or loaded from the cache on disk.
#pragma once

#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <boost/compute/program.hpp>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace flaunay::host {

/// The text of kernels/<file>.cl with all included files inserted. It is read from the folder
/// FLAUNAY_KERNEL_PATH if that is set; otherwise it is the text that was embedded when the library was built.
/// Throws DeviceError if there is no such file.
std::string kernel_source(const std::string& file);

/// Options of the compiler without the macros that the text of a program does not name: if others have other
/// values, it is the same program, which is compiled and kept once.
std::string used_options(const std::string& options, const std::string& source);

class Programs {
 public:
  Programs(boost::compute::context context, boost::compute::device device, std::string identity)
      : context_(std::move(context)), device_(std::move(device)), identity_(std::move(identity)) {}

  /// The program of a file, compiled with these options; null if it is not compiled yet.
  const boost::compute::program* find(const std::string& file, const std::string& options) const;
  /// Makes it; macros that its text does not name are left out of the options. before_compiling: called
  /// before it is compiled from its source, if set. Throws DeviceError with the compiler's messages if that
  /// fails.
  const boost::compute::program* make(const std::string& file, const std::string& options,
                                      const std::function<void()>& before_compiling);
  bool empty() const { return programs_.empty(); }
  void clear() { programs_.clear(); }

 private:
  boost::compute::program made_of(const std::string& binary, const std::string& options) const;
  boost::compute::program compiled(const std::string& file, const std::string& source,
                                   const std::string& options) const;
  std::string binary_of(const boost::compute::program& program) const;

  boost::compute::context context_;
  boost::compute::device device_;
  std::string identity_;
  std::map<std::pair<std::string, std::string>, boost::compute::program> programs_;  // by file and options
};

}  // namespace flaunay::host
