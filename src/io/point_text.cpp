#include "io/point_text.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "io/text.hpp"

namespace flaunay::io {
namespace {

bool is_node(const std::string& path) { return path != "-" && ending_of(path) == ".node"; }

/// Two numbers per line.
class PairText : public PointText {
 public:
  explicit PairText(const std::string& path) : name_(shown_path(path)) {}

  void parse(std::string_view text, std::vector<double>& coordinates) override {
    Lines lines(name_, text, Lines::Separator::blanks_or_comma, lines_);
    bool more = lines.next();
    if (more && is_first_) {
      is_first_ = false;
      hint_ = "; if this line is a header, begin it with '#'";
      if (is_header(lines)) {
        more = lines.next();
        hint_ = "";
      }
    }
    if (more) coordinates.reserve(coordinates.size() + 2 * lines.lines_left());
    for (; more; more = lines.next(), ++point_) {
      std::string_view x, y, extra;
      if (!lines.field(x) || !lines.field(y) || lines.field(extra)) {
        lines.fail_line("expected two numbers (x and y), found {}", lines.count_fields());
      }
      coordinates.push_back(lines.coordinate(x, point_, hint_));
      coordinates.push_back(lines.coordinate(y, point_, hint_));
      hint_ = "";
    }
    lines_ = lines.number();
  }

 private:
  std::string name_;
  std::size_t lines_ = 0;  // read before
  std::size_t point_ = 0;  // the index of the next point
  bool is_first_ = true;   // whether the next line with content is the first one
  std::string_view hint_;  // how messages about the first line of points end
};

/// Reads a vertex's first attribute as an index.
std::int32_t read_index_attribute(Lines& lines) {
  constexpr long long kMostIndices = std::numeric_limits<std::int32_t>::max();
  return checked_index(lines, "index", lines.integer("the index of a point"), 0, kMostIndices);
}

/// Triangle's format.
class NodeText : public PointText {
 public:
  /// indices: where the first attribute of each vertex goes, which must be an index; null for none.
  NodeText(const std::string& path, std::vector<std::int32_t>* indices) : path_(path), indices_(indices) {}

  void parse(std::string_view text, std::vector<double>& coordinates) override {
    Lines lines(path_, text, Lines::Separator::blanks, lines_);
    if (header_line_ == 0) read_header(lines);
    if (header_line_ > 0) {
      const std::size_t left = std::min(static_cast<std::size_t>(vertices_ - read_), lines.lines_left());
      coordinates.reserve(coordinates.size() + 2 * left);
      for (; lines.next(); ++read_) read_vertex(lines, coordinates);
    }
    lines_ = lines.number();
  }

  void finish() override {
    if (header_line_ == 0) fail(path_, "has no header line; expected \"vertices 2 attributes markers\"");
    if (read_ != vertices_) {
      fail(path_, "line {}: the header says {} vertices, but the file ends after {}", header_line_, vertices_,
           read_);
    }
  }

  long long base() const { return base_; }

 private:
  void read_header(Lines& lines) {
    if (!lines.next()) return;
    const std::size_t fields = lines.count_fields();
    if (fields > 4) {
      lines.fail_line("the header has {} fields; expected up to 4: vertices, 2, attributes, markers", fields);
    }
    // As in Triangle, the defaults of a short header are two dimensions, no attributes and no markers.
    vertices_ = lines.integer("the number of vertices");
    const long long dimensions = fields > 1 ? lines.integer("the number of dimensions") : 2;
    attributes_ = fields > 2 ? attribute_count(lines) : 0;
    markers_ = fields > 3 ? lines.integer("the number of boundary markers") : 0;
    if (vertices_ < 0) lines.fail_line("{} vertices; expected 0 or more", vertices_);
    if (dimensions != 2) lines.fail_line("{} dimensions; expected 2", dimensions);
    if (markers_ != 0 && markers_ != 1) lines.fail_line("{} boundary markers; expected 0 or 1", markers_);
    if (indices_ != nullptr && attributes_ == 0) lines.fail_line("no attributes; expected one, an index");
    header_line_ = lines.number();
  }

  void read_vertex(Lines& lines, std::vector<double>& coordinates) {
    if (read_ == vertices_) {
      lines.fail_line("more vertices than the {} of the header (line {})", vertices_, header_line_);
    }
    const long long number = lines.integer("a vertex number");
    if (read_ == 0) {
      if (number != 0 && number != 1)
        lines.fail_line("expected vertex number 0 or 1 first, found {}", number);
      base_ = number;
    }
    if (number != base_ + read_) {
      lines.fail_line("expected vertex number {}, found {}", base_ + read_, number);
    }
    std::string_view x, y, extra;
    const bool complete = lines.field(x) && lines.field(y);
    if (complete && indices_ != nullptr) indices_->push_back(read_index_attribute(lines));
    while (complete && lines.field(extra)) {
    }
    const auto expected_fields = static_cast<std::size_t>(3 + attributes_ + markers_);
    if (!complete || lines.fields_taken() != expected_fields) {
      lines.fail_line("expected {} fields (vertex number, x, y, {} attributes, {} markers), found {}",
                      expected_fields, attributes_, markers_, lines.fields_taken());
    }
    const auto point = static_cast<std::size_t>(read_);
    coordinates.push_back(lines.coordinate(x, point));
    coordinates.push_back(lines.coordinate(y, point));
  }

  std::string path_;
  std::vector<std::int32_t>* indices_;
  std::size_t lines_ = 0;        // read before
  std::size_t header_line_ = 0;  // 0: not read yet
  long long vertices_ = 0, attributes_ = 0, markers_ = 0;
  long long base_ = 0;  // the first vertex's number
  long long read_ = 0;  // vertices
};

}  // namespace

std::unique_ptr<PointText> parse_points(const std::string& path) {
  if (is_node(path)) return std::make_unique<NodeText>(path, nullptr);
  return std::make_unique<PairText>(path);
}

std::string_view expected_text(const std::string& path) {
  return is_node(path) ? "Triangle's .node format" : "two numbers a line";
}

NodeFile read_node(const std::string& path, bool with_indices) {
  const std::string text = read_file(path, expected_text(path));
  NodeFile file;
  NodeText parser(path, with_indices ? &file.indices : nullptr);
  parser.parse(text, file.points.coordinates);
  parser.finish();
  file.base = parser.base();
  return file;
}

LinePieces::LinePieces(const std::string& path) : path_(shown_path(path)), file_(path, expected_text(path)) {}

bool LinePieces::next(std::string_view& lines) {
  constexpr std::size_t kPiece = std::size_t{1} << 22, kLongestLine = std::size_t{1} << 26;
  used_ -= given_;
  std::memmove(buffer_.data(), buffer_.data() + given_, used_);
  given_ = 0;
  while (!ended_ && given_ == 0) {
    if (used_ > kLongestLine) {
      fail(path_, "has a line of more than {} bytes; expected {}", kLongestLine, expected_text(path_));
    }
    buffer_.resize(used_ + kPiece);
    const std::size_t got = file_.read_next(buffer_.data() + used_, kPiece);
    ended_ = got < kPiece;
    const std::size_t line_end = std::string_view(buffer_).substr(used_, got).rfind('\n');
    if (line_end != std::string_view::npos) given_ = used_ + line_end + 1;
    used_ += got;
  }
  if (ended_) given_ = used_;
  lines = std::string_view(buffer_).substr(0, given_);
  return given_ > 0;
}

}  // namespace flaunay::io
