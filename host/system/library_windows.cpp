#include <windows.h>

#include "host/system/library.hpp"
#include "host/system/wide.hpp"

namespace flaunay::system {

// Looks neither in the current folder nor in the folders of PATH, to which others may write.
void* open_opencl() { return LoadLibraryExW(L"OpenCL.dll", nullptr, LOAD_LIBRARY_SEARCH_DEFAULT_DIRS); }

void* open_library(const std::string& path) { return LoadLibraryW(wide(path).c_str()); }

AnyFunction* find_function(void* library, const char* name) {
  return reinterpret_cast<AnyFunction*>(GetProcAddress(static_cast<HMODULE>(library), name));
}

// Names belong to libraries there.
AnyFunction* find_among_loaded(const char*) { return nullptr; }

}  // namespace flaunay::system
