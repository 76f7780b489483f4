// Text with numbers in columns: points, perhaps with heights or weights, or the ends of segments.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/files/formats.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

class ColumnText : public PointText {
 public:
  ColumnText(const std::string& path, const Columns& columns, std::string_view third)
      : lines_(shown_path(path), Lines::Separator::any), columns_(columns.names), third_(third) {
    for (const std::string& name : columns.fields) kept_.push_back({name, {}, {}});
    const auto is_name = [](const std::string& column) {
      return column.find_first_not_of("0123456789") != std::string::npos;
    };
    may_have_tabs_ = !kept_.empty() || std::any_of(columns_.begin(), columns_.end(), is_name);
  }

  void parse(std::string_view text, std::vector<double>& coordinates, std::vector<double>* heights) override {
    lines_.go_on(text);
    bool more = lines_.next();
    if (more && is_first_) {
      is_first_ = false;
      hint_ = "; if this line is a header, begin it with '#'";
      if (may_have_tabs_) lines_.prefer_tabs();
      if (is_header(lines_)) {
        check_comment();
        for (std::string_view name; lines_.field(name); names_.emplace_back(name)) check_quotes(name);
        more = lines_.next();
        hint_ = "";
      }
    }
    if (more && point_ == 0) begin_rows();
    if (more) coordinates.reserve(coordinates.size() + 2 * lines_.lines_left());
    for (; more; more = lines_.next(), ++point_) {
      if ((lines_.separator() == ';') != has_semicolons_) {
        lines_.fail_line("has {}semicolons between columns, but the lines before have {}",
                         has_semicolons_ ? "no " : "", has_semicolons_ ? "some" : "none");
      }
      std::string_view field;
      for (const int axis : axes_) {
        if (!lines_.field(field)) fail_count();
        check_quotes(field);
        const auto at = static_cast<std::size_t>(axis);
        if (axis >= 0 && at < kAxes) found_[at] = field;
        if (axis >= 0 && at >= kAxes) keep(field, kept_[at - kAxes]);
      }
      if (is_whole_line_ && lines_.field(field)) fail_count();
      coordinates.push_back(lines_.coordinate(found_[0], point_, hint_));
      coordinates.push_back(lines_.coordinate(found_[1], point_, hint_));
      if (heights != nullptr && numbers_ == 3) heights->push_back(read_third());
      hint_ = "";
      check_comment();
    }
  }

  std::vector<PointField> fields() override {
    std::vector<PointField> fields;
    for (Kept& kept : kept_) {
      // One decimal mark for the column, which is that of coordinates: "1.234" may be a thousand.
      const std::size_t first_mix = std::max(lines_.has_decimal(',') ? 0 : kept.first_comma,
                                             lines_.has_decimal('.') ? 0 : kept.first_point);
      kept.first_text = std::min(kept.first_text, first_mix);
      fields.push_back({std::move(kept.name), {}, kept.first_text == kNone ? 0 : kept.first_text});
      for (std::size_t i = 0; i < kept.texts.size(); ++i)
        fields.back().values.push_back(value_of(kept, std::move(kept.texts[i]), kept.numbers[i]));
    }
    return fields;
  }

 private:
  static constexpr std::size_t kAxes = 3;
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  double read_third() {
    const bool is_optional = third_.empty() && found_[2].empty();
    return lines_.coordinate(found_[2], point_, is_optional ? "; --columns X,Y reads no heights" : hint_,
                             third_.empty() ? "height" : third_);
  }

  // A column that points keep: numbers only if all of its fields are some, and otherwise text.
  struct Kept {
    std::string name;
    std::vector<std::string> texts;
    std::vector<double> numbers;
    std::size_t first_text = kNone, first_comma = kNone,
                first_point = kNone;  // fields that are text or have it
    bool has_integers = true;
  };

  void check_comment() const {
    if (!kept_.empty() && lines_.has_comment())
      lines_.fail_line("has a comment: put fields with '#' between double quotes, or leave the comment out");
  }
  // Fields are of one line: a text that goes over several would become points.
  void check_quotes(std::string_view field) const {
    const bool is_open = !kept_.empty() && !lines_.is_in_quotes() && !field.empty() && field[0] == '"';
    if (is_open && std::count(field.begin(), field.end(), '"') % 2 != 0)
      lines_.fail_line("the field {} has no second double quote on its line", quoted(field));
  }

  void keep(std::string_view field, Kept& to) {
    std::string text(field);
    for (std::size_t at = 0; lines_.is_in_quotes() && (at = text.find("\"\"", at)) != std::string::npos; ++at)
      text.erase(at, 1);
    double number = std::numeric_limits<double>::quiet_NaN();
    if (!text.empty()) {
      const std::string_view digits = field.substr(field[0] == '-' || field[0] == '+' ? 1 : 0);
      const bool is_whole = digits.find_first_not_of("0123456789") == std::string_view::npos;
      // Leading zeros, a plus and many digits are those of names, such as numbers of houses and telephones.
      const bool is_name =
          (digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9') ||
          (is_whole && (field[0] == '+' || digits.size() > std::numeric_limits<std::int64_t>::digits10));
      const bool is_number =
          !is_name && lines_.number(field, number) == ParsedNumber::fine && !std::isinf(number);
      const auto note = [at = to.texts.size()](std::size_t& first, bool is_it) {
        if (is_it) first = std::min(first, at);
      };
      note(to.first_text, !is_number);
      note(to.first_comma, field.find(',') != std::string_view::npos);
      note(to.first_point, field.find('.') != std::string_view::npos);
      to.has_integers = to.has_integers && is_whole;
    }
    to.texts.push_back(std::move(text));
    to.numbers.push_back(number);
  }

  static FieldValue value_of(const Kept& kept, std::string text, double number) {
    if (text.empty()) return {};
    if (kept.first_text != kNone) return text;
    if (!kept.has_integers) return std::isnan(number) ? FieldValue() : number;
    return std::int64_t{std::stoll(text)};
  }

  // At the first line of numbers: finds which columns are read.
  void begin_rows() {
    has_semicolons_ = lines_.separator() == ';';
    const std::size_t count = lines_.count_fields();
    if (!kept_.empty()) {
      axes_.resize(names_.empty() ? count : names_.size(), -1);
      if (axes_.size() != count) fail_count();
    }
    is_whole_line_ = !kept_.empty();
    for (std::size_t k = 0; k < kept_.size(); ++k) choose_column(kept_[k].name, kAxes + k, count);
    if (!columns_.empty()) {
      numbers_ = columns_.size();
      if (numbers_ < kAxes && !third_.empty())
        lines_.fail_line("expected three columns (x, y and a {}), but --columns has {}", third_, numbers_);
      for (std::size_t axis = 0; axis < numbers_; ++axis) choose_column(columns_[axis], axis, count);
      return;
    }
    const std::size_t others = count - std::min(count, kept_.size());
    numbers_ = third_.empty() && others == 2 ? 2 : kAxes;
    is_whole_line_ = is_whole_line_ || third_.empty();
    if (others < numbers_ || (is_whole_line_ && others > numbers_)) {
      numbers_ = third_.empty() ? 2 : kAxes;
      axes_.clear();
      fail_count();
    }
    axes_.resize(is_whole_line_ ? count : kAxes, -1);
    for (int axis = 0; int& each : axes_) each = each < 0 ? axis++ : each;
    if (names_.size() == count) check_names();
  }

  void choose_column(const std::string& wanted, std::size_t axis, std::size_t count) {
    auto at = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), wanted) - names_.begin());
    if (at == names_.size()) {
      const char* const end = wanted.data() + wanted.size();
      const auto [stop, error] = std::from_chars(wanted.data(), end, at);
      if (error != std::errc() || stop != end || at >= count) {
        lines_.fail_line("there is no column '{}': {}", wanted,
                         names_.empty()
                             ? fmt::format("this line has columns 0 to {}, without names", count - 1)
                             : fmt::format("the columns are {}", fmt::join(names_, ", ")));
      }
    }
    if (at >= axes_.size()) axes_.resize(at + 1, -1);
    if (axes_[at] >= 0) lines_.fail_line("column '{}' is chosen twice by --columns or --fields", wanted);
    axes_[at] = static_cast<int>(axis);
  }

  // A header that has x or y in another column than the first or the second one.
  void check_names() const {
    static const std::vector<std::string> kNames[] = {
        {"x", "lon", "long", "lng", "longitude", "easting", "east", "e"},
        {"y", "lat", "latitude", "northing", "north", "n"}};
    for (std::size_t k = 0; k < names_.size(); ++k) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto& known = kNames[axis];
        const bool is_it = k < axes_.size() && axes_[k] == static_cast<int>(axis);
        if (is_it || std::find(known.begin(), known.end(), lower(names_[k])) == known.end()) continue;
        lines_.fail_line(
            "the columns are {}, but the first two are read as x and y; say by --columns which these are",
            fmt::join(names_, ", "));
      }
    }
  }

  [[noreturn]] void fail_count() {
    const std::size_t found = lines_.count_fields();
    if (!axes_.empty() && !kept_.empty()) {
      for (std::string_view field; lines_.field(field);) check_quotes(field);
      const bool has_blanks = lines_.separator() == ' ';
      lines_.fail_line("has {} fields, but {} has {}{}", found,
                       names_.empty() ? "the first line of points" : "the header", axes_.size(),
                       has_blanks ? "; put fields that are empty or have blanks between double quotes"
                       : found > axes_.size() ? "; put fields that have the separator between double quotes"
                                              : "; put separators around empty fields, too");
    }
    std::string_view hint;
    for (std::string_view field; lines_.separator() != ';' && hint.empty() && lines_.field(field);)
      hint = lines_.hint_about(field, "");
    if (!hint.empty()) lines_.fail_line("found {} columns{}", found, hint);
    if (!axes_.empty() && !columns_.empty())
      lines_.fail_line("expected {} columns, found {}", axes_.size(), found);
    const bool may_choose = found > 3 && third_.empty() && point_ == 0;
    lines_.fail_line("expected {}, found {}{}",
                     numbers_ == 2 ? "two numbers (x and y)" : "three numbers (x, y and z)", found,
                     may_choose ? "; --columns says which of more than three columns they are" : "");
  }

  Lines lines_;
  std::vector<std::string> columns_;
  std::string third_;
  std::vector<std::string> names_;  // of the header
  std::vector<Kept> kept_;
  std::vector<int> axes_;  // of each column up to the last one that is read: 0 to 2, of kept ones more, or -1
  std::array<std::string_view, kAxes> found_;  // fields of a line
  std::size_t numbers_ = 2;                    // that are read, per line
  bool is_whole_line_ = false;                 // whether there must be no further columns
  bool may_have_tabs_ = false;  // whether tabs separate columns where they are the only separators
  bool has_semicolons_ = false;
  std::size_t point_ = 0;  // the index of the next point
  bool is_first_ = true;   // whether the next line with content is the first one
  std::string_view hint_;  // how messages about the first line of points end
};

std::vector<std::int32_t> read_text_segments(const std::string& path, std::size_t points) {
  const std::string text = read_file(path, "two indices a line");
  Lines lines(path, text, Lines::Separator::any);
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
          .content = "numbers in columns",
          .text = column_text_of_points,
          .segments = has_segments ? read_text_segments : nullptr,
          .begin_points = begin_text<separator>,
          .write_points = write_text<separator>,
          .least_bytes = 4};
}

}  // namespace

std::unique_ptr<PointText> column_text(const std::string& path, const Columns& columns,
                                       std::string_view third) {
  return std::make_unique<ColumnText>(path, columns, third);
}
std::unique_ptr<PointText> column_text_of_points(const std::string& path, const Columns& columns) {
  return column_text(path, columns);
}

const Format kXy = text_format<' '>(".xy", false);
const Format kXyz = {.ending = ".xyz", .content = "x, y and height per line", .text = column_text_of_points};
const Format kTxt = text_format<' '>(".txt", true);
const Format kCsv = text_format<','>(".csv", true);
}  // namespace flaunay::io
