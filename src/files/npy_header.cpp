#include "files/npy_header.hpp"

#include <fmt/format.h>

#include "flaunay/flaunay.hpp"

namespace flaunay::io {

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) text += (i ? ", " : "") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string npy_header(const std::string& descr, std::uint64_t rows, std::size_t columns) {
  std::vector<std::uint64_t> shape = {rows};
  if (columns > 0) shape.push_back(columns);
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", descr, shape_text(shape));
  constexpr std::size_t kPrefix = 10, kAlignment = 64;  // NumPy aligns the data, and counts a final newline
  text.append(kAlignment - (kPrefix + text.size() + 1) % kAlignment, ' ');
  text += '\n';
  const auto length = static_cast<std::uint16_t>(text.size());
  std::string header = std::string(kNpyMagic) + std::string("\x01\x00", 2);
  header.append(reinterpret_cast<const char*>(&length), sizeof length);
  header += text;
  if (header.size() != kNpyHeaderBytes) throw Error(ErrorKind::internal, "an .npy header of another size");
  return header;
}

}  // namespace flaunay::io
