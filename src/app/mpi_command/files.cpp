#include "app/mpi_command/files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/files/formats.hpp"
#include "app/files/npy.hpp"
#include "files/file.hpp"

namespace flaunay::mpi {
namespace {

// Values of one call. The calls are those of one rank alone, because in Open MPI's
// collective ones all ranks wait for ever if one cannot write; each rank has one contiguous part of the file,
// for which collective calls would gain nothing.
constexpr std::size_t kPiece = std::size_t{1} << 22;

constexpr const char* kCutShort =
    "cannot be written to its end: the disk is full, or the file larger than permitted";

void check_file(int code, const std::string& path, const char* what) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  io::fail(path, "cannot be {}: {}", what, text);
}

void check_count(const MPI_Status& status, MPI_Datatype type, std::size_t expected, const std::string& path,
                 const char* what) {
  int count = 0;
  MPI_Get_count(&status, type, &count);
  if (static_cast<std::size_t>(count) != expected) io::fail(path, "{}", what);
}

template <typename Value>
void write_values(MPI_File file, std::uint64_t begin, const std::vector<std::int64_t>& values,
                  const std::string& path) {
  const MPI_Datatype type = sizeof(Value) == sizeof(std::int64_t) ? MPI_INT64_T : MPI_INT32_T;
  std::vector<Value> piece(std::min(values.size(), kPiece));
  for (std::size_t done = 0; done < values.size();) {
    const std::size_t size = std::min(kPiece, values.size() - done);
    std::transform(values.begin() + static_cast<std::ptrdiff_t>(done),
                   values.begin() + static_cast<std::ptrdiff_t>(done + size), piece.begin(),
                   [](std::int64_t value) { return static_cast<Value>(value); });
    MPI_Status status;
    check_file(MPI_File_write_at(file, static_cast<MPI_Offset>(begin + done * sizeof(Value)), piece.data(),
                                 static_cast<int>(size), type, &status),
               path, "written");
    check_count(status, type, size, path, kCutShort);
    done += size;
  }
}

}  // namespace

PointFile::PointFile(Ranks& ranks, const std::string& path) : path_(path) {
  ranks.together([&] {
    const io::Format* const format = io::find_format(path, io::Use::read_records);
    if (format == nullptr) {
      throw Error(ErrorKind::usage,
                  fmt::format("{}: ranks read {} at the same time, and no other files; convert it, or take "
                              "flaunay triangulate",
                              path, io::endings_for(io::Use::read_records)));
    }
    io::InputFile file(path, format->content);
    file.first(1);  // an error if there is none
    if (file.size() < 0) io::fail(path, "is no regular file, which ranks can read at the same time");
    records_ = format->records(path, file);
  });
}

std::vector<double> PointFile::read(Ranks& ranks) const {
  const auto rank = static_cast<std::uint64_t>(ranks.rank()),
             count = static_cast<std::uint64_t>(ranks.size());
  // As even as possible, without products that may overflow.
  const auto begin_of = [&](std::uint64_t r) { return size() / count * r + std::min(r, size() % count); };
  const std::uint64_t first = begin_of(rank);
  MPI_File file = MPI_FILE_NULL;
  const int code = MPI_File_open(ranks.communicator(), path_.c_str(), MPI_MODE_RDONLY, MPI_INFO_NULL, &file);
  ranks.together([&] { check_file(code, path_, "opened"); });
  std::vector<double> points(2 * (begin_of(rank + 1) - first));
  const auto read = [&](std::uint64_t begin, std::size_t bytes, void* to) {
    for (std::size_t done = 0; done < bytes; done += 8 * kPiece) {
      const std::size_t size = std::min(8 * kPiece, bytes - done);
      MPI_Status status;
      check_file(MPI_File_read_at(file, static_cast<MPI_Offset>(begin + done), static_cast<char*>(to) + done,
                                  static_cast<int>(size), MPI_BYTE, &status),
                 path_, "read");
      check_count(status, MPI_BYTE, size, path_, "became shorter while it was read");
    }
  };
  ranks.together([&] { records_.read(read, first, points.size() / 2, points.data()); });
  MPI_File_close(&file);
  return points;
}

IndexFile::IndexFile(Ranks& ranks, io::Outputs& outputs, const std::string& path, std::size_t columns,
                     std::uint64_t rows, io::IndexType type)
    : path_(path), columns_(columns), rows_(rows), type_(type) {
  std::vector<char> name;
  ranks.together([&] {
    if (ranks.rank() != 0) return;
    const std::string& partial = outputs.open(path).partial_path();
    name.assign(partial.begin(), partial.end());
  });
  ranks.broadcast(name);
  const std::string partial(name.begin(), name.end());
  ranks.together([&] {
    if (ranks.rank() != 0) partial_ = io::Temporary(partial);
  });
  const int code =
      MPI_File_open(ranks.communicator(), partial.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file_);
  ranks.together([&] { check_file(code, path_, "opened"); });
}

// Closing is collective; after an error, all ranks are here.
IndexFile::~IndexFile() {
  if (file_ != MPI_FILE_NULL) MPI_File_close(&file_);
}

void IndexFile::write(Ranks& ranks, const std::vector<std::int64_t>& values, std::uint64_t first_row) {
  const std::uint64_t bytes = type_ == io::IndexType::int32 ? 4 : 8;
  const std::uint64_t begin = io::kNpyHeaderBytes + first_row * std::max<std::size_t>(1, columns_) * bytes;
  ranks.together([&] {
    if (ranks.rank() == 0) {
      const std::string header = io::npy_header(io::descr_of(type_), rows_, columns_);
      MPI_Status status;
      check_file(
          MPI_File_write_at(file_, 0, header.data(), static_cast<int>(header.size()), MPI_CHAR, &status),
          path_, "written");
      check_count(status, MPI_CHAR, header.size(), path_, kCutShort);
    }
    if (type_ == io::IndexType::int32) {
      write_values<std::int32_t>(file_, begin, values, path_);
    } else {
      write_values<std::int64_t>(file_, begin, values, path_);
    }
  });
  const int synced = MPI_File_sync(file_), closed = MPI_File_close(&file_);
  ranks.together([&] {
    check_file(synced, path_, "written");
    check_file(closed, path_, "written");
  });
}

}  // namespace flaunay::mpi
