#include "host/system/files.hpp"

#include <fmt/format.h>

#include <functional>
#include <random>

namespace flaunay::system {

std::string temporary_path(const std::string& path, const char* what) {
  static const unsigned process = std::random_device()();
  constexpr std::size_t kLongest = 200;  // of the 255 bytes that a name may have
  const std::size_t begin = last_name(path);
  std::string name = path.substr(begin);
  if (name.size() > kLongest) {
    name = fmt::format("{}-{:x}", name.substr(0, kLongest), std::hash<std::string>()(name));
  }
  return fmt::format("{}{}.{:08x}.{}", path.substr(0, begin), name, process, what);
}

}  // namespace flaunay::system
