#include "flaunay/chunks.hpp"

#include <cstring>

namespace flaunay {

PointSource::~PointSource() = default;
MeshSink::~MeshSink() = default;

void ArrayPoints::read(std::uint64_t first, std::size_t count, double* coordinates) {
  std::memcpy(coordinates, coordinates_ + 2 * first, 2 * count * sizeof(double));
}

}  // namespace flaunay
