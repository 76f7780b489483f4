#include "host/opencl/launch_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <regex>
#include <vector>

#include "host/error.hpp"
#include "host/opencl/programs.hpp"

namespace flaunay::host {
namespace {

thread_local LaunchCheck* check_of_thread = nullptr;

using Bytes = std::vector<unsigned char>;

Bytes read(Backend& backend, cl_mem array) {
  std::size_t size = 0;
  FLAUNAY_CL(clGetMemObjectInfo(array, CL_MEM_SIZE, sizeof size, &size, nullptr));
  Bytes bytes(size);
  backend.read(array, 0, size, bytes.data(), true);
  return bytes;
}

// Walks begin elsewhere where points are fetched ahead, and so do not end at the same step.
const char* const kOfManyResults[] = {"find_triangles"};

// The constants that determine the contents of arrays after a kernel. A device's kernels are compiled with
// other values than native ones, which have the defaults of their files.
const char* const kDecidingConstants[] = {"SORT_BITS", "SORT_GROUP", "SMALL_REGION"};

// The largest groups whose launches must leave the same bytes as native ones, whose groups have one
// work-item; 0: none.
std::size_t largest_comparable(const KernelName& name, const std::string& options) {
  if (name.native == nullptr) return 0;
  for (const char* const kernel : kOfManyResults) {
    if (std::strcmp(kernel, name.name) == 0) return 0;
  }
  const std::string source = kernel_source(name.program);
  const std::size_t begin = source.find(fmt::format("kernel void {}(", name.name));
  const std::string text = source.substr(begin, source.find("\nkernel void ", begin) - begin);
  for (const char* const constant : kDecidingConstants) {
    std::smatch by_default, number, given;
    if (!std::regex_search(source, by_default,
                           std::regex(fmt::format("#ifndef {0}\n#define {0} (\\w+)", constant)))) {
      continue;
    }
    std::string value = by_default.str(1);
    if (std::regex_search(source, number,
                          std::regex(fmt::format(R"(INTEGER_CONSTANT\({}, (\d+)\))", value)))) {
      value = number.str(1);
    }
    if (std::regex_search(options, given, std::regex(fmt::format(R"(-D{}=(\d+))", constant))) &&
        given.str(1) != value) {
      return 0;
    }
  }
  return text.find("get_group_id(") != text.npos ? 1 : std::numeric_limits<std::size_t>::max();
}

// "argument 5 (global const int* restrict triangles)". Lists of arguments (arguments.h) are macros.
std::string declaration(const KernelName& name, std::size_t index, std::size_t count) {
  std::string source = kernel_source(name.program);
  source = std::regex_replace(source, std::regex("//[^\n]*|\\\\\n"), "");
  std::smatch found;
  if (!std::regex_search(source, found,
                         std::regex(fmt::format(R"(kernel void {}\(([^{{]*)\) *\{{)", name.name)))) {
    return fmt::format("argument {}", index);
  }
  std::string all = found.str(1);
  const std::regex list(R"(([A-Z_]+)\(([a-z_]*)\))");
  while (std::regex_search(all, found, list)) {
    std::smatch defined;
    std::string text;
    if (std::regex_search(source, defined,
                          std::regex(fmt::format(R"(#define {}\(PREFIX\)([^\n]*))", found.str(1))))) {
      text = std::regex_replace(defined.str(1), std::regex("PREFIX##"), found.str(2));
    }
    all = found.prefix().str() + text + found.suffix().str();
  }
  std::vector<std::string> declarations;
  const std::regex comma(" *, *| COUNTERS");
  all = std::regex_replace(all, std::regex(R"(\s+)"), " ");
  declarations.assign(std::sregex_token_iterator(all.begin(), all.end(), comma, -1), {});
  if (declarations.size() != count) return fmt::format("argument {}", index);
  return fmt::format("argument {} ({})", index, declarations[index]);
}

// As the argument is declared: numbers of its type, or words of 32 bits.
std::string value_at(const std::string& declaration, const Bytes& bytes, std::size_t at) {
  const auto as = [&](auto value) {
    const std::size_t first = at / sizeof value * sizeof value;
    std::memcpy(&value, &bytes[first], std::min(sizeof value, bytes.size() - first));
    return value;
  };
  if (declaration.find(" double") != std::string::npos) return fmt::format("{}", as(double{}));
  if (declaration.find("64* ") != std::string::npos) return fmt::format("{:#x}", as(cl_ulong{}));
  return fmt::format("{}", as(cl_int{}));
}

}  // namespace

LaunchCheck::LaunchCheck(bool compares) : compares_(compares), outer_(check_of_thread) {
  check_of_thread = this;
}

LaunchCheck::~LaunchCheck() { check_of_thread = outer_; }

LaunchCheck* LaunchCheck::of_thread() { return check_of_thread; }

void LaunchCheck::launch(const KernelName& name, const ArgumentList& arguments, std::size_t work_items,
                         std::size_t group, const std::string& options, Backend& backend,
                         const std::function<void()>& on_device) {
  const auto [entry, is_new] = kernels_.try_emplace(fmt::format("{}: {}", name.program, name.name));
  Tested& kernel = entry->second;
  if (is_new && compares_) kernel.largest_comparable = largest_comparable(name, options);
  ++kernel.launches;
  if (group > kernel.largest_comparable) return on_device();
  kernel.was_compared = true;

  // An array may be several arguments.
  std::map<cl_mem, Bytes> natively;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const cl_mem array = arguments.array(k);
    if (array != nullptr && natively.count(array) == 0) natively.emplace(array, read(backend, array));
  }
  on_device();
  std::vector<void*> values(arguments.values(), arguments.values() + arguments.size());
  std::vector<void*> addresses(arguments.size());
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments.array(k) == nullptr) continue;
    addresses[k] = natively.at(arguments.array(k)).data();
    values[k] = &addresses[k];
  }
  name.native({0, work_items, work_items}, values.data());

  for (std::size_t k = 0; k < arguments.size() && kernel.difference.empty(); ++k) {
    if (arguments.array(k) == nullptr) continue;
    const Bytes& expected = natively.at(arguments.array(k));
    const Bytes found = read(backend, arguments.array(k));
    const auto at = static_cast<std::size_t>(
        std::mismatch(found.begin(), found.end(), expected.begin()).first - found.begin());
    if (at == found.size()) continue;
    const std::string argument = declaration(name, k, arguments.size());
    // The final contents of scratch memory mean nothing. Memory that several work-items change may depend on
    // their order; later kernels compute results from it that do not.
    if (argument.find(" scratch") != argument.npos || argument.find(" volatile ") != argument.npos) continue;
    kernel.difference =
        fmt::format("launch {}, {} work-items: {}, byte {} of {}: {} on the device, {} on the host",
                    kernel.launches, work_items, argument, at, found.size(), value_at(argument, found, at),
                    value_at(argument, expected, at));
  }
}

}  // namespace flaunay::host
