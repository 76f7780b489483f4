// The kernel files as they were when the library was built.
#pragma once

#include <cstddef>
#include <vector>

namespace flaunay {

struct EmbeddedFile {
  const char* name;  ///< relative to kernels/, e.g. "flattened/axes.h"
  const char* text;
  std::size_t size;
};

const std::vector<EmbeddedFile>& embedded_kernels();

}  // namespace flaunay
