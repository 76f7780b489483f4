#include "files/temporary.hpp"

#include <algorithm>
#include <set>

#include "host/system/files.hpp"
#include "host/system/process.hpp"

namespace flaunay::io {
namespace {

struct Registry {
  std::recursive_mutex mutex;
  std::set<std::string> paths;
};

// Never destroyed, because the thread that waits for signals may use it until the process ends.
Registry& registry() {
  static Registry& all = *new Registry;
  return all;
}

void remove_all() {
  Registry& all = registry();
  // Locked until the end of the process, so that no more are made.
  all.mutex.lock();
  // Backwards, so that a folder comes after its contents.
  std::for_each(all.paths.rbegin(), all.paths.rend(), system::remove_file);
}

}  // namespace

void clean_up_when_interrupted() { system::clean_up_when_interrupted(remove_all); }

Uninterrupted::Uninterrupted() : lock_(registry().mutex) {}

Temporary::Temporary(std::string path) : path_(std::move(path)) {
  const Uninterrupted registered;
  registry().paths.insert(path_);
}

Temporary::~Temporary() {
  if (path_.empty()) return;
  const Uninterrupted removed;
  system::remove_file(path_);
  registry().paths.erase(path_);
}

}  // namespace flaunay::io
