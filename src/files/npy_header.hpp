// The beginning of NumPy's array files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/output.hpp"

namespace flaunay::io {

constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// "(3, 2)", "(3,)": as Python writes it.
std::string shape_text(const std::vector<std::uint64_t>& shape);

/// The beginning of a file. descr: the dtype, such as "<f8"; columns 0: an array of one dimension, `rows`
/// long. It is as long as NumPy's own, and NumPy's have this size for any number of rows.
std::string npy_header(const std::string& descr, std::uint64_t rows, std::size_t columns);
constexpr std::size_t kNpyHeaderBytes = 128;

inline const char* descr_of(IndexType type) { return type == IndexType::int32 ? "<i4" : "<i8"; }

}  // namespace flaunay::io
