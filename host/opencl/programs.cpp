#include "host/opencl/programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "host/error.hpp"
#include "host/memory/system_memory.hpp"
#include "host/opencl/program_cache.hpp"
#include "kernels/embedded.hpp"

namespace flaunay::host {
namespace {

std::string read_kernel_file(const std::string& name) {
  if (const char* directory = std::getenv("FLAUNAY_KERNEL_PATH");
      directory != nullptr && *directory != '\0') {
    const std::string path = std::string(directory) + "/" + name;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw DeviceError(fmt::format("cannot read {} (FLAUNAY_KERNEL_PATH={})", path, directory));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  for (const EmbeddedFile& file : embedded_kernels()) {
    if (name == file.name) return std::string(file.text, file.size);
  }
  throw DeviceError(fmt::format("no kernel file {} in this build", name));
}

// Inserts included files, each once, so that the driver does not have to find files.
void append_with_includes(const std::string& name, std::set<std::string>& seen, std::string& out) {
  if (!seen.insert(name).second) return;
  std::istringstream lines(read_kernel_file(name));
  out += fmt::format("#line 1 \"{}\"\n", name);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string prefix = "#include \"";
    if (line.compare(0, prefix.size(), prefix) == 0) {
      append_with_includes(line.substr(prefix.size(), line.find('"', prefix.size()) - prefix.size()), seen,
                           out);
      out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    } else {
      out += line + "\n";
    }
  }
}

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Whether a name occurs in a text as a whole word.
bool names(const std::string& text, const std::string& name) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !is_of_name(text[at - 1])) && (end == text.size() || !is_of_name(text[end]))) return true;
  }
  return false;
}

}  // namespace

std::string kernel_source(const std::string& file) {
  std::set<std::string> seen;
  std::string source;
  append_with_includes(file + ".cl", seen, source);
  return source;
}

std::string used_options(const std::string& options, const std::string& source) {
  std::istringstream words(options);
  std::string used;
  for (std::string word; words >> word;) {
    if (word.compare(0, 2, "-D") == 0 && !names(source, word.substr(2, word.find('=') - 2))) continue;
    used += (used.empty() ? "" : " ") + word;
  }
  return used;
}

// The most memory that copying a compiled program needs, including the driver's own work.
constexpr std::size_t kSpaceForBinaries = std::size_t{512} << 20;

const boost::compute::program* Programs::find(const std::string& file, const std::string& options) const {
  const auto found = programs_.find({file, options});
  return found != programs_.end() ? &found->second : nullptr;
}

const boost::compute::program* Programs::make(const std::string& file, const std::string& options,
                                              const std::function<void()>& before_compiling) {
  const std::string source = kernel_source(file), used = used_options(options, source);
  // Everything that a compiled program depends on.
  const std::string key = fmt::format("{}\n{}\n{}\n{}", FLAUNAY_VERSION, identity_, used, source);
  const ProgramCache cache(default_cache_folder());
  boost::compute::program program;
  if (const auto binary = cache.load(key)) program = made_of(*binary, used);
  if (program.get() == nullptr) {
    if (before_compiling) before_compiling();
    program = compiled(file, source, used);
    // Some drivers end the process if there is no memory for the copy.
    const bool is_kept = !cache.folder().empty() && address_space_left().bytes >= kSpaceForBinaries;
    if (const std::string binary = is_kept ? binary_of(program) : ""; !binary.empty()) {
      cache.store(key, binary);
    }
  }
  return &programs_.emplace(std::pair(file, options), std::move(program)).first->second;
}

// Makes a program from the result of binary_of; null if the driver does not accept it.
boost::compute::program Programs::made_of(const std::string& binary, const std::string& options) const {
  const auto* bytes = reinterpret_cast<const unsigned char*>(binary.data());
  const std::size_t size = binary.size();
  const cl_device_id id = device_.id();
  cl_int status = CL_SUCCESS, code = CL_SUCCESS;
  cl_program made = clCreateProgramWithBinary(context_.get(), 1, &id, &size, &bytes, &status, &code);
  if (made == nullptr) return {};
  boost::compute::program program(made, false);
  if (code != CL_SUCCESS || status != CL_SUCCESS) return {};
  if (clBuildProgram(made, 1, &id, options.c_str(), nullptr, nullptr) != CL_SUCCESS) return {};
  return program;
}

boost::compute::program Programs::compiled(const std::string& file, const std::string& source,
                                           const std::string& options) const {
  auto program = boost::compute::program::create_with_source(source, context_);
  const cl_device_id id = device_.id();
  const cl_int code = clBuildProgram(program.get(), 1, &id, options.c_str(), nullptr, nullptr);
  if (code != CL_SUCCESS) {
    std::size_t size = 0;
    clGetProgramBuildInfo(program.get(), id, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(program.get(), id, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    throw DeviceError(fmt::format("{} ({}) from clBuildProgram of kernels/{}.cl; {}\n{}", error_name(code),
                                  code, file, error_advice(code), log.c_str()),
                      code, "clBuildProgram");
  }
  return program;
}

// The compiled program as the driver stores it; empty if it does not.
std::string Programs::binary_of(const boost::compute::program& program) const {
  // One entry per device of the context. Only ours has a binary.
  cl_uint devices = 0;
  if (clGetProgramInfo(program.get(), CL_PROGRAM_NUM_DEVICES, sizeof devices, &devices, nullptr) !=
      CL_SUCCESS)
    return "";
  std::vector<cl_device_id> ids(devices);
  std::vector<std::size_t> sizes(devices);
  const std::size_t bytes = devices * sizeof(std::size_t);
  if (clGetProgramInfo(program.get(), CL_PROGRAM_DEVICES, devices * sizeof(cl_device_id), ids.data(),
                       nullptr) != CL_SUCCESS ||
      clGetProgramInfo(program.get(), CL_PROGRAM_BINARY_SIZES, bytes, sizes.data(), nullptr) != CL_SUCCESS) {
    return "";
  }
  std::vector<std::string> binaries;
  std::vector<unsigned char*> places;
  for (const std::size_t size : sizes) binaries.emplace_back(size, '\0');
  for (std::string& binary : binaries) places.push_back(reinterpret_cast<unsigned char*>(binary.data()));
  if (clGetProgramInfo(program.get(), CL_PROGRAM_BINARIES, devices * sizeof(unsigned char*), places.data(),
                       nullptr) != CL_SUCCESS) {
    return "";
  }
  const auto own = std::find(ids.begin(), ids.end(), device_.id());
  return own == ids.end() ? "" : binaries[static_cast<std::size_t>(own - ids.begin())];
}

}  // namespace flaunay::host
