#include "app/files/point_text.hpp"

#include <algorithm>
#include <cstring>

#include "app/files/node_vertices.hpp"
#include "app/files/text.hpp"

namespace flaunay::io {
namespace {

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

/// Triangle's format.
class NodeText : public PointText {
 public:
  NodeText(const std::string& path, std::vector<std::int32_t>* indices, std::vector<std::int32_t>* markers)
      : path_(path), vertices_(indices, markers) {}

  void parse(std::string_view text, std::vector<double>& coordinates) override {
    Lines lines(path_, text, Lines::Separator::blanks, lines_);
    if (!vertices_.has_header() && lines.next()) vertices_.read_header(lines);
    if (vertices_.has_header()) {
      coordinates.reserve(coordinates.size() + 2 * std::min(vertices_.left(), lines.lines_left()));
      while (lines.next()) vertices_.read_vertex(lines, coordinates);
    }
    lines_ = lines.number();
  }

  void finish() override { vertices_.check_complete(path_); }

  long long base() const { return vertices_.base(); }

 private:
  std::string path_;
  NodeVertices vertices_;
  std::size_t lines_ = 0;  // read before
};

}  // namespace

std::unique_ptr<PointText> pair_text(const std::string& path) { return std::make_unique<PairText>(path); }

std::unique_ptr<PointText> node_text(const std::string& path) {
  return std::make_unique<NodeText>(path, nullptr, nullptr);
}

NodeFile read_node(const std::string& path, bool with_indices) {
  const std::string text = read_file(path, "Triangle's .node format");
  NodeFile file;
  NodeText parser(path, with_indices ? &file.indices : nullptr, &file.points.markers);
  parser.parse(text, file.points.coordinates);
  parser.finish();
  file.base = parser.base();
  return file;
}

LinePieces::LinePieces(const std::string& path, std::string_view expected)
    : path_(shown_path(path)), expected_(expected), file_(path, expected) {}

bool LinePieces::next(std::string_view& lines) {
  constexpr std::size_t kPiece = std::size_t{1} << 22, kLongestLine = std::size_t{1} << 26;
  used_ -= given_;
  std::memmove(buffer_.data(), buffer_.data() + given_, used_);
  given_ = 0;
  while (!ended_ && given_ == 0) {
    if (used_ > kLongestLine) {
      fail(path_, "has a line of more than {} bytes; expected {}", kLongestLine, expected_);
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
