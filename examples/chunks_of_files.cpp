// Triangulates the points of a mapped file in chunks, into another mapped file: neither is in memory as a
// whole.
//
//   chunks_of_files

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <flaunay/chunks.hpp>

// Maps a file without a name; take one of yours.
template <typename Value>
Value* map_file(std::FILE* file, std::size_t count) {
  if (ftruncate(fileno(file), static_cast<off_t>(count * sizeof(Value))) != 0) return nullptr;
  void* place = mmap(nullptr, count * sizeof(Value), PROT_READ | PROT_WRITE, MAP_SHARED, fileno(file), 0);
  return place == MAP_FAILED ? nullptr : static_cast<Value*>(place);
}

int main() {
  const std::size_t side = 300, n = side * side;
  std::FILE* input = std::tmpfile();
  std::FILE* output = std::tmpfile();
  double* xy = map_file<double>(input, 2 * n);
  flaunay::MeshArrays<std::int64_t> mesh;  // arrays that are null are not wanted
  mesh.triangles = map_file<std::int64_t>(output, 6 * n);
  if (xy == nullptr || mesh.triangles == nullptr) return 1;
  for (std::size_t i = 0; i < n; ++i) {
    xy[2 * i] = static_cast<double>(i % side);
    xy[2 * i + 1] = static_cast<double>(i / side);
  }

  flaunay::ChunkOptions options;
  options.memory_bytes = std::uint64_t{1} << 30;
  options.chunk_points = 10000;  // by default, as many as suit the devices
  try {
    const flaunay::ChunkStatistics done = flaunay::triangulate_chunks(xy, n, mesh, options);
    if (ftruncate(fileno(output), static_cast<off_t>(3 * done.triangles * sizeof(std::int64_t))) != 0)
      return 1;
    std::printf("%ju triangles, %ju hull vertices\n", std::uintmax_t{done.triangles},
                std::uintmax_t{done.hull_vertices});
  } catch (const flaunay::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
