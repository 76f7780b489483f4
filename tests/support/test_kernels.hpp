// Kernels of the tests' own (tests/kernels), beside those of the product.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "host/runtime.hpp"
#include "tests/support/device.hpp"
#include "tests/support/paths.hpp"

namespace flaunay::testing {

/// For as long as this lives, runtimes find tests/kernels/NAME.cl as kernel file NAME, and the product's
/// files where they always are.
class TestKernels {
 public:
  TestKernels() : environment_("FLAUNAY_KERNEL_PATH", folder_.path().c_str()) {
    namespace fs = std::filesystem;
    const fs::path tests = fs::absolute(fs::path(test_data()).parent_path());
    for (const fs::path& folder : {tests.parent_path() / "kernels", tests / "kernels"}) {
      for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        fs::create_symlink(entry.path(), fs::path(folder_.path()) / entry.path().filename());
      }
    }
  }

 private:
  TemporaryFolder folder_;
  ScopedEnvironment environment_;
};

/// For as long as this lives, runtimes find the product's kernels with another text of one file: what
/// `change` makes of it.
class ChangedKernels {
 public:
  template <typename Change>
  ChangedKernels(const std::string& file, const Change& change)
      : environment_("FLAUNAY_KERNEL_PATH", folder_.path().c_str()) {
    namespace fs = std::filesystem;
    const fs::path kernels = fs::absolute(fs::path(test_data()).parent_path().parent_path() / "kernels");
    fs::copy(kernels, folder_.path(), fs::copy_options::recursive);
    const fs::path path = fs::path(folder_.path()) / file;
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    std::ofstream(path) << change(text.str());
  }

 private:
  TemporaryFolder folder_;
  ScopedEnvironment environment_;
};

/// The name of a kernel that has no launcher; it stays.
inline const host::KernelName& kernel_named(const std::string& program, const std::string& kernel) {
  struct Named {
    std::string program, kernel;
    host::KernelName name{};
  };
  static std::map<std::pair<std::string, std::string>, std::unique_ptr<Named>> names;
  auto& named = names[{program, kernel}];
  if (!named) {
    named = std::make_unique<Named>(Named{program, kernel});
    named->name = {named->program.c_str(), named->kernel.c_str()};
  }
  return named->name;
}

/// Launches a kernel that has no launcher, with one work-item per element.
template <typename... Arguments>
void map_unchecked(host::Runtime& runtime, const char* program, const char* kernel, std::size_t n,
                   const Arguments&... arguments) {
  runtime.launch_unchecked(kernel_named(program, kernel), n, runtime.sizes().map_group,
                           static_cast<cl_int>(n), arguments...);
}

}  // namespace flaunay::testing
