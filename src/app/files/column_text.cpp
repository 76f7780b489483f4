// Text with two numbers per line: points, or the ends of segments.
#include <memory>
#include <string_view>

#include "app/files/formats.hpp"
#include "app/files/text.hpp"

namespace flaunay::io {
namespace {

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

std::unique_ptr<PointText> pair_text(const std::string& path) { return std::make_unique<PairText>(path); }

std::vector<std::int32_t> read_text_segments(const std::string& path, std::size_t points) {
  const std::string text = read_file(path, "two indices a line");
  Lines lines(path, text, Lines::Separator::blanks_or_comma);
  bool more = lines.next();
  if (more && is_header(lines)) more = lines.next();
  std::vector<std::int32_t> segments;
  for (; more; more = lines.next()) {
    const std::size_t fields = lines.count_fields();
    if (fields != 2) lines.fail_line("expected two indices (the ends of a segment), found {}", fields);
    for (int end = 0; end < 2; ++end) {
      segments.push_back(checked_index(lines, "index", lines.integer("the index of a point"), 0,
                                       static_cast<long long>(points)));
    }
  }
  return segments;
}

// Every reader skips this line. With it, a file of no points can be read back.
template <char separator>
void begin_text(OutputFile& file, std::uint64_t, bool) {
  file.print("{}", separator == ',' ? "x,y\n" : "# x y\n");
}

template <char separator>
void write_text(OutputFile& file, const double* coordinates, const std::int32_t*, std::uint64_t,
                std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    file.print("{}{}{}\n", coordinates[2 * i], separator, coordinates[2 * i + 1]);
  }
}

template <char separator>
constexpr Format text_format(std::string_view ending, bool has_segments) {
  return {.ending = ending,
          .content = "two numbers a line",
          .text = pair_text,
          .segments = has_segments ? read_text_segments : nullptr,
          .begin_points = begin_text<separator>,
          .write_points = write_text<separator>,
          .least_bytes = 4};
}

}  // namespace

const Format kXy = text_format<' '>(".xy", false);
const Format kTxt = text_format<' '>(".txt", true);
const Format kCsv = text_format<','>(".csv", true);
}  // namespace flaunay::io
