#include "app/files/npy.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "app/files/formats.hpp"
#include "files/file.hpp"
#include "host/system/pages.hpp"

namespace flaunay::io {
namespace {

struct Header {
  std::string descr;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::size_t data_begin = 0;
};

/// Reads the header's text, a Python dictionary with the keys descr, fortran_order and shape.
class HeaderParser {
 public:
  HeaderParser(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  Header parse() {
    Header header;
    bool descr_seen = false, order_seen = false, shape_seen = false;
    expect('{');
    while (!accept('}')) {
      const std::string key = parse_string();
      expect(':');
      if (key == "descr") {
        if (peek() == '[') fail(path_, "has a structured dtype; expected plain numbers");
        header.descr = parse_string();
        descr_seen = true;
      } else if (key == "fortran_order") {
        header.fortran_order = parse_bool();
        order_seen = true;
      } else if (key == "shape") {
        header.shape = parse_shape();
        shape_seen = true;
      } else {
        malformed("unknown key '" + key + "'");
      }
      if (!accept(',') && peek() != '}') malformed("expected ',' or '}'");
    }
    peek();
    if (at_ != text_.size()) malformed("expected blanks alone after '}'");
    if (!descr_seen) malformed("no key 'descr'");
    if (!order_seen) malformed("no key 'fortran_order'");
    if (!shape_seen) malformed("no key 'shape'");
    return header;
  }

 private:
  [[noreturn]] void malformed(const std::string& what) const {
    fail(path_, "the .npy header is malformed at its byte {}: {}", at_, what);
  }
  char peek() {
    while (at_ < text_.size() && std::strchr(" \t\r\n", text_[at_]) && text_[at_] != '\0') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) malformed(std::string("expected '") + c + "'");
  }
  std::string parse_string() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') malformed("expected a quoted string");
    const std::size_t begin = at_ + 1;
    const std::size_t end = text_.find(quote, begin);
    if (end == std::string_view::npos) malformed("string without end");
    at_ = end + 1;
    return std::string(text_.substr(begin, end - begin));
  }
  bool parse_bool() {
    peek();
    for (const std::string_view word : {"True", "False"}) {
      if (text_.substr(at_, word.size()) == word) {
        at_ += word.size();
        return word == "True";
      }
    }
    malformed("expected True or False");
  }
  std::vector<std::uint64_t> parse_shape() {
    std::vector<std::uint64_t> shape;
    expect('(');
    while (!accept(')')) {
      if (peek() < '0' || peek() > '9') malformed("expected a length of the shape");
      std::uint64_t length = 0;
      for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
        const auto digit = static_cast<std::uint64_t>(text_[at_] - '0');
        if (length > (std::numeric_limits<std::uint64_t>::max() - digit) / 10) malformed("length too large");
        length = 10 * length + digit;
      }
      accept('L');  // the suffix of long integers in Python 2
      shape.push_back(length);
      if (!accept(',') && peek() != ')') malformed("expected ',' or ')'");
    }
    return shape;
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
};

/// Reads the file up to the end of its header.
Header read_header(const std::string& path, InputFile& file) {
  constexpr std::size_t kPrefix = 8, kMostHeader = 1 << 16;
  const std::string prefix(file.first(kPrefix));
  if (prefix.compare(0, kNpyMagic.size(), kNpyMagic) != 0) {
    fail(path, "is no .npy file; expected it to begin with \\x93NUMPY");
  }
  if (prefix.size() < kPrefix) fail(path, "is truncated in the .npy header: {} bytes", prefix.size());
  const int version = static_cast<unsigned char>(prefix[6]);
  if (version < 1 || version > 3) fail(path, "has .npy format version {}; expected 1, 2 or 3", version);
  const std::size_t text_begin = kPrefix + (version == 1 ? 2 : 4);
  const std::string_view before_text = file.first(text_begin);
  std::uint32_t length = 0;
  std::memcpy(&length, before_text.data() + kPrefix, before_text.size() - kPrefix);
  if (before_text.size() == text_begin && length > kMostHeader) {
    fail(path, "has an .npy header of {} bytes; expected at most {}, for an array of plain numbers", length,
         kMostHeader);
  }
  const std::string_view bytes = file.first(text_begin + length);
  if (bytes.size() < text_begin + length) {
    fail(path, "is truncated in the .npy header: expected {} bytes of it, the file has {}",
         text_begin + length, bytes.size());
  }
  Header header = HeaderParser(path, bytes.substr(text_begin)).parse();
  header.data_begin = text_begin + length;
  return header;
}

/// The arrays that a reader accepts: shape (rows, columns) with one of these dtypes.
struct Layout {
  const char* rows_name;
  std::size_t columns;  ///< 0: any number
  std::vector<std::string> dtypes;
};

constexpr std::string_view kThreeColumns = "a NumPy array of shape (m, 3)";
const Layout kRows = {"m", 3, {"<i4", "<i8"}};

std::string dtypes_text(const Layout& layout) {
  std::string text;
  for (std::size_t i = 0; i < layout.dtypes.size(); ++i) {
    text += i == 0 ? "'" : i + 1 < layout.dtypes.size() ? ", '" : " or '";
    text += layout.dtypes[i] + "'";
  }
  return text;
}

/// Checks the header. Returns the number of bytes of all values.
std::size_t check_header(const std::string& path, const Header& header, const Layout& layout) {
  if (!header.descr.empty() && header.descr[0] == '>') {
    fail(path, "has big-endian dtype '{}'; expected {} (numpy converts: array.astype('{}'))", header.descr,
         dtypes_text(layout), layout.dtypes.front());
  }
  if (std::find(layout.dtypes.begin(), layout.dtypes.end(), header.descr) == layout.dtypes.end()) {
    fail(path, "has dtype '{}'; expected {}", header.descr, dtypes_text(layout));
  }
  if (header.shape.size() != 2 || (layout.columns != 0 && header.shape[1] != layout.columns)) {
    fail(path, "has shape {}; expected ({}, {})", shape_text(header.shape), layout.rows_name, layout.columns);
  }
  if (header.fortran_order) {
    fail(path, "is in Fortran order; expected C order (numpy converts: numpy.ascontiguousarray(array))");
  }
  const std::size_t row_bytes = header.shape[1] * static_cast<std::size_t>(header.descr[2] - '0');
  if (row_bytes > 0 && header.shape[0] > std::numeric_limits<std::size_t>::max() / row_bytes) {
    fail(path, "has shape {}, more than any memory holds", shape_text(header.shape));
  }
  return header.shape[0] * row_bytes;
}

/// An array whose header was checked. The values are read once.
class Array {
 public:
  Array(const std::string& path, InputFile& file, const Layout& layout)
      : path_(path), file_(file), header_(read_header(path, file)) {
    promised_ = check_header(path, header_, layout);
  }

  const std::string& dtype() const { return header_.descr; }
  std::size_t rows() const { return header_.shape[0]; }
  std::size_t columns() const { return header_.shape[1]; }
  std::size_t data_begin() const { return header_.data_begin; }

  /// Checks the size of the file.
  void check_size() const {
    file_.load_pipe();
    const std::size_t found = static_cast<std::size_t>(file_.size()) - header_.data_begin;
    if (found == promised_) return;
    fail(path_, "{}: shape {} of '{}' needs {} bytes after the header, found {}",
         found < promised_ ? "is truncated" : fmt::format("has {} bytes too many", found - promised_),
         shape_text(header_.shape), header_.descr, promised_, found);
  }

  template <typename Value>
  std::vector<Value> values() {
    // Before memory for the header's shape is allocated.
    check_size();
    std::vector<Value> all;
    all.reserve(promised_ / sizeof(Value));
    system::prefer_huge_pages(all.data(), promised_);
    all.resize(promised_ / sizeof(Value));
    file_.read_at(header_.data_begin, promised_, all.data());
    return all;
  }

 private:
  const std::string& path_;
  InputFile& file_;
  Header header_;
  std::size_t promised_ = 0;
};

/// The values as indices, after check(value, its place) for each of them.
template <typename Value, typename Check>
std::vector<std::int32_t> indices_of(Array& array, const Check& check) {
  std::vector<Value> values = array.values<Value>();
  for (std::size_t i = 0; i < values.size(); ++i) check(values[i], i);
  if constexpr (std::is_same_v<Value, std::int32_t>) {
    return values;
  } else {
    return {values.begin(), values.end()};
  }
}

/// An m x 3 array of indices, none below `lowest`; `member` names an element for the message.
std::vector<std::int32_t> read_npy_rows(const std::string& path, std::int32_t lowest, const char* member) {
  InputFile file(path, kThreeColumns);
  Array array(path, file, kRows);
  const auto check = [&](auto value, std::size_t i) {
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    if (value >= lowest && value <= kMost) return;
    fail(path, "triangle {} has {} {}; expected {} to {}", i / 3, member, value, lowest, kMost);
  };
  return array.dtype() == "<i4" ? indices_of<std::int32_t>(array, check)
                                : indices_of<std::int64_t>(array, check);
}

class NpyRows : public RowSource {
 public:
  explicit NpyRows(const std::string& path) : path_(path), file_(path, kThreeColumns) {
    file_.first(1);  // throws if the file cannot be read
    if (file_.size() < 0)
      fail(path, "is no regular file; expected one, because its rows are not read in order");
    const Array array(path_, file_, kRows);
    array.check_size();
    is_wide_ = array.dtype() == "<i8";
    size_ = array.rows();
    begin_ = array.data_begin();
  }

  std::uint64_t size() const override { return size_; }

  void read(std::uint64_t first, std::size_t count, std::int64_t* values) override {
    const std::uint64_t value_bytes = is_wide_ ? sizeof(std::int64_t) : sizeof(std::int32_t);
    const std::size_t bytes = static_cast<std::size_t>(3 * count * value_bytes);
    // Narrow values are read into the upper half, and then moved down one by one.
    char* const to = reinterpret_cast<char*>(values + 3 * count) - bytes;
    file_.read_at(begin_ + 3 * first * value_bytes, bytes, to);
    for (std::size_t i = 0; !is_wide_ && i < 3 * count; ++i) {
      std::int32_t value = 0;
      std::memcpy(&value, to + i * sizeof value, sizeof value);
      values[i] = value;
    }
  }

 private:
  std::string path_;
  InputFile file_;
  bool is_wide_ = false;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // of the first row, in bytes
};

/// Copies these columns of rows of `all` columns.
template <typename Value>
PointRecords::Decode decode_columns(const std::vector<std::size_t>& columns, std::size_t all) {
  return [columns, all](const char* from, std::size_t count, double* to) {
    for (std::size_t i = 0; i < count; ++i, from += all * sizeof(Value)) {
      for (const std::size_t column : columns) {
        Value value;
        std::memcpy(&value, from + column * sizeof value, sizeof value);
        *to++ = value;
      }
    }
  };
}

/// Points of which the user has said in which columns they are. least: how many must be named.
PointRecords npy_columns(const std::string& path, InputFile& file, const Columns& chosen, std::size_t least) {
  const Array array(path, file, {"n", 0, {"<f8", "<f4"}});
  array.check_size();
  std::vector<std::size_t> columns;
  for (const std::string& name : chosen.names) {
    const char* const end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, columns.emplace_back());
    if (error != std::errc() || stop != end || columns.back() >= array.columns())
      fail(path, "has no column '{}', but {}, numbered from 0", name, array.columns());
  }
  if (columns.size() < least) fail(path, "needs {} columns, but --columns has {}", least, columns.size());
  const bool is_wide = array.dtype() == "<f8";
  const auto decode = [&](std::size_t first, std::size_t last) {
    const std::vector<std::size_t> some(columns.begin() + static_cast<std::ptrdiff_t>(first),
                                        columns.begin() + static_cast<std::ptrdiff_t>(last));
    return is_wide ? decode_columns<double>(some, array.columns())
                   : decode_columns<float>(some, array.columns());
  };
  PointRecords records{array.rows(), array.data_begin(),
                       array.columns() * (is_wide ? sizeof(double) : sizeof(float))};
  records.decode = decode(0, least);
  if (columns.size() > least) records.decode_heights = decode(least, columns.size());
  return records;
}

template <std::size_t columns>
PointRecords npy_points(const std::string& path, InputFile& file, const Columns& chosen) {
  if (!chosen.names.empty()) return npy_columns(path, file, chosen, columns);
  const Layout layout = {"n", columns, {"<f8", "<f4"}};
  const Array array(path, file, layout);
  array.check_size();
  PointRecords records{array.rows(), array.data_begin(), columns * sizeof(double)};
  if (array.dtype() == "<f4") {
    records.bytes = columns * sizeof(float);
    records.decode = [](const char* from, std::size_t count, double* coordinates) {
      for (std::size_t i = 0; i < columns * count; ++i, from += sizeof(float)) {
        float value;
        std::memcpy(&value, from, sizeof value);
        coordinates[i] = value;
      }
    };
  }
  return records;
}

void begin_npy(OutputFile& file, const char* descr, std::uint64_t rows, std::size_t columns) {
  const std::string header = npy_header(descr, rows, columns);
  file.write(header.data(), header.size());
}

/// The file of an array, after its header.
OutputFile& begin_array(Outputs& outputs, const std::string& path, const char* descr, std::size_t values,
                        std::size_t columns) {
  const std::size_t row = std::max<std::size_t>(columns, 1);
  if (values % row != 0) {
    throw Error(ErrorKind::internal, fmt::format("{}: {} values make no rows of {}", path, values, columns));
  }
  OutputFile& file = outputs.open(path);
  begin_npy(file, descr, values / row, columns > 1 ? columns : 0);
  return file;
}

void begin_npy_points(OutputFile& file, std::uint64_t n, bool) { begin_npy(file, "<f8", n, 2); }

void write_npy_mesh(OutputFile& file, const MeshContents& contents) {
  begin_npy(file, "<i4", contents.triangle_count(), 3);
  file.write(contents.mesh.triangles.data(), contents.mesh.triangles.size() * sizeof(std::int32_t));
}

}  // namespace

PointRecords npy_triples(const std::string& path, InputFile& file, const Columns& columns) {
  return npy_points<3>(path, file, columns);
}

std::unique_ptr<RowSource> open_npy_rows(const std::string& path) { return std::make_unique<NpyRows>(path); }

std::vector<std::int32_t> read_npy_triangles(const std::string& path) {
  return read_npy_rows(path, 0, "vertex");
}

std::vector<std::int32_t> read_neighbors(const std::string& path) {
  check_ending(path, ".npy");
  return read_npy_rows(path, -1, "neighbour");
}

std::vector<std::int8_t> read_corner_offsets(const std::string& path) {
  check_ending(path, ".npy");
  InputFile file(path, "a NumPy array of shape (m, 6)");
  const Layout layout = {"m", 6, {"<i4", "<i8", "|i1"}};
  Array array(path, file, layout);
  const auto check = [&](auto value, std::size_t i) {
    if (value == static_cast<std::int8_t>(value)) return;
    fail(path, "row {} has offset {}, but offsets are from -128 to 127", i / 6, +value);
  };
  const std::string& dtype = array.dtype();
  const std::vector<std::int32_t> values = dtype == "<i4"   ? indices_of<std::int32_t>(array, check)
                                           : dtype == "<i8" ? indices_of<std::int64_t>(array, check)
                                                            : indices_of<std::int8_t>(array, check);
  return {values.begin(), values.end()};
}

std::vector<std::int32_t> read_npy_segments(const std::string& path, std::size_t points) {
  InputFile file(path, "a NumPy array of shape (s, 2)");
  const Layout layout = {"s", 2, {"<i4", "<i8", "<u4", "<u8", "<i2", "<u2", "|i1", "|u1"}};
  Array array(path, file, layout);
  const auto check = [&](auto value, std::size_t i) {
    // A negative value is large without its sign.
    if (static_cast<std::uint64_t>(value) < points) return;
    fail(path, "segment {} has index {}, but there are {} points, with indices from 0", i / 2, +value,
         points);
  };
  const std::string& dtype = array.dtype();
  if (dtype == "<i4") return indices_of<std::int32_t>(array, check);
  if (dtype == "<i8") return indices_of<std::int64_t>(array, check);
  if (dtype == "<u4") return indices_of<std::uint32_t>(array, check);
  if (dtype == "<u8") return indices_of<std::uint64_t>(array, check);
  if (dtype == "<i2") return indices_of<std::int16_t>(array, check);
  if (dtype == "<u2") return indices_of<std::uint16_t>(array, check);
  if (dtype == "|i1") return indices_of<std::int8_t>(array, check);
  return indices_of<std::uint8_t>(array, check);
}

const Format kNpy = {.ending = ".npy",
                     .content = "a NumPy array of shape (n, 2)",
                     .records = npy_points<2>,
                     .segments = read_npy_segments,
                     .triangles = read_npy_triangles,
                     .begin_points = begin_npy_points,
                     .write_points = write_pairs,
                     .least_bytes = 2 * sizeof(double),
                     .write_mesh = write_npy_mesh};

void write_npy(Outputs& outputs, const std::string& path, const std::vector<std::int32_t>& values,
               std::size_t columns, IndexType type) {
  OutputFile& file = begin_array(outputs, path, descr_of(type), values.size(), columns);
  if (type == IndexType::int32) {
    file.write(values.data(), values.size() * sizeof(std::int32_t));
  } else {
    for (const std::int64_t value : values) file.write_value(value);
  }
}

void write_npy(Outputs& outputs, const std::string& path, const std::vector<double>& values,
               std::size_t columns, IndexType) {
  begin_array(outputs, path, "<f8", values.size(), columns)
      .write(values.data(), values.size() * sizeof(double));
}

}  // namespace flaunay::io
