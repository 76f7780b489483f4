#include "files/mesh_stream.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "files/disk_space.hpp"
#include "files/file.hpp"
#include "files/npy_header.hpp"
#include "files/scratch.hpp"

namespace flaunay::io {
namespace {

constexpr std::size_t kOffsetsPerTriangle = 6;

std::size_t bytes_of(IndexType type) { return type == IndexType::int32 ? 4 : 8; }

// How an array's elements are stored, if its indices have this type.
struct Stored {
  const char* descr;
  std::size_t bytes;
};
Stored stored_as(std::size_t array, IndexType type) {
  Stored stored{descr_of(type), bytes_of(type)};
  visit_mesh_array(array, [&](const auto& row) {
    using Element = typename std::decay_t<decltype(row)>::Element;
    if (std::is_floating_point_v<Element>) stored = {"<f8", sizeof(double)};
  });
  return stored;
}

}  // namespace

std::size_t columns_of(MeshArray array) {
  std::size_t columns = 0;
  visit_mesh_array(static_cast<std::size_t>(array), [&](const auto& row) {
    if (row.columns > 1) columns = row.columns;
  });
  return columns;
}

void check_stream_output(const std::string& path) {
  if (!path.empty() && find_target(path).is_direct) {
    throw Error(ErrorKind::usage,
                fmt::format("{}: is no regular file; expected one, because triangulations in chunks are not "
                            "written in order",
                            path));
  }
}

void check_room(const MeshFiles::Paths& paths, std::uint64_t n, IndexType type,
                const std::optional<std::string>& scratch, const std::string& corner_offsets) {
  std::vector<SizedOutput> files;
  for (std::size_t k = 0; k < kMeshArrays; ++k) {
    visit_mesh_array(k, [&](const auto& row) {
      if (row.row == RowOf::hull) return;
      files.push_back({paths[k], most_rows(row.row, n) * row.columns * stored_as(k, type).bytes});
    });
  }
  files.push_back({corner_offsets, most_rows(RowOf::triangle, n) * kOffsetsPerTriangle});
  // It may be on the same disk as an output.
  if (scratch) files.push_back({scratch_folder(*scratch), n * kScratchBytesPerPoint, true});
  check_disk_space(files);
}

SizedOutput scratch_output(std::uint64_t n, const std::string& scratch) {
  return {scratch_folder(scratch), n * kScratchBytesPerPoint, true};
}

MeshFiles::MeshFiles(Outputs& outputs, const Paths& paths, IndexType type, const Paths& partials,
                     const std::string& corner_offsets)
    : type_(type) {
  for (std::size_t k = 0; k < kMeshArrays; ++k) {
    check_stream_output(paths[k]);
    if (paths[k].empty()) continue;
    files_[k].output = partials[k].empty() ? &outputs.open(paths[k]) : &outputs.join(paths[k], partials[k]);
  }
  check_stream_output(corner_offsets);
  if (!corner_offsets.empty()) corner_offsets_.output = &outputs.open(corner_offsets);
}

MeshFiles::Paths MeshFiles::partial_paths() const {
  Paths partials;
  for (std::size_t k = 0; k < kMeshArrays; ++k) {
    if (files_[k].output != nullptr) partials[k] = files_[k].output->partial_path();
  }
  return partials;
}

bool MeshFiles::wants(MeshArray array) const { return file_of(array).output != nullptr; }

void MeshFiles::write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) {
  extend(array, first + count);
  file_of(array).output->write_at(kNpyHeaderBytes + first * sizeof *values, values, count * sizeof *values);
}

void MeshFiles::write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) {
  const File& file = file_of(array);
  const std::uint64_t place = kNpyHeaderBytes + first * bytes_of(type_);
  extend(array, first + count);
  if (type_ == IndexType::int64) {
    file.output->write_at(place, values, count * sizeof *values);
    return;
  }
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  for (std::size_t done = 0; done < count; done += narrow_.size()) {
    narrow_.resize(std::min(kPiece, count - done));
    for (std::size_t i = 0; i < narrow_.size(); ++i) {
      if (values[done + i] > std::numeric_limits<std::int32_t>::max()) {
        throw Error(ErrorKind::internal, fmt::format("index {} in a file of int32", values[done + i]));
      }
      narrow_[i] = static_cast<std::int32_t>(values[done + i]);
    }
    file.output->write_at(place + done * sizeof narrow_[0], narrow_.data(),
                          narrow_.size() * sizeof narrow_[0]);
  }
}

void MeshFiles::write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count) {
  if (corner_offsets_.output == nullptr) return;
  corner_offsets_.entries = std::max(corner_offsets_.entries, first + count);
  corner_offsets_.output->write_at(kNpyHeaderBytes + first, values, count);
}

void MeshFiles::keep_triangles(std::uint64_t triangles) {
  for (std::size_t k = 0; k < kMeshArrays; ++k) {
    visit_mesh_array(k, [&](const auto& row) {
      if (row.row == RowOf::triangle) keep(files_[k], triangles * row.columns, stored_as(k, type_).bytes);
    });
  }
  keep(corner_offsets_, triangles * kOffsetsPerTriangle, 1);
}

void MeshFiles::keep(File& file, std::uint64_t entries, std::size_t bytes) {
  if (file.entries <= entries) return;
  file.entries = entries;
  file.output->cut(kNpyHeaderBytes + entries * bytes);
}

void MeshFiles::extend(MeshArray array, std::uint64_t entries) {
  std::uint64_t& known = files_[static_cast<std::size_t>(array)].entries;
  known = std::max(known, entries);
}

void MeshFiles::finish() {
  for (std::size_t k = 0; k < kMeshArrays; ++k)
    finish(files_[k], stored_as(k, type_).descr, columns_of(static_cast<MeshArray>(k)));
  finish(corner_offsets_, "|i1", kOffsetsPerTriangle);
}

void MeshFiles::finish(const File& file, const char* descr, std::size_t columns) {
  if (file.output == nullptr) return;
  const std::string header = npy_header(descr, columns == 0 ? file.entries : file.entries / columns, columns);
  file.output->write_at(0, header.data(), header.size());
}

}  // namespace flaunay::io
