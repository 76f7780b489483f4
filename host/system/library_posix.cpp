#include <dlfcn.h>

#include "host/system/library.hpp"

namespace flaunay::system {

void* open_opencl() {
  void* const versioned = dlopen("libOpenCL.so.1", RTLD_LAZY | RTLD_GLOBAL);
  return versioned != nullptr ? versioned : dlopen("libOpenCL.so", RTLD_LAZY | RTLD_GLOBAL);
}

void* open_library(const std::string& path) { return dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL); }

AnyFunction* find_function(void* library, const char* name) {
  return reinterpret_cast<AnyFunction*>(dlsym(library, name));
}

AnyFunction* find_among_loaded(const char* name) { return find_function(RTLD_DEFAULT, name); }

}  // namespace flaunay::system
