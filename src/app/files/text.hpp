// Reads text by lines and fields, and knows the place for error messages.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#ifndef __cpp_lib_to_chars
// The standard library of some platforms cannot read doubles.
#include <fast_float/fast_float.h>
#endif

#include "files/file.hpp"

namespace flaunay::io {

/// A field for messages: quoted and shortened.
inline std::string quoted(std::string_view field) {
  constexpr std::size_t kLongest = 32;
  return fmt::format("'{}{}'", field.substr(0, kLongest), field.size() > kLongest ? "..." : "");
}

/// For messages, a field that is no number. Characters beyond ASCII can look like digits or a minus sign.
inline std::string quoted_number(std::string_view field) {
  if (field.empty()) return "nothing";
  const auto other = std::find_if(field.begin(), field.end(), [](unsigned char c) { return c >= 0x80; });
  if (other == field.end()) return quoted(field);
  return fmt::format("{}; byte 0x{:02X} is not part of a number", quoted(field),
                     static_cast<unsigned char>(*other));
}

enum class ParsedNumber { fine, unreadable, infinite };

/// Reads all of field as a double; a leading '+' is fine. Numbers too small for a double become zero; those
/// too large are `infinite`, while the words "inf" and "nan" are `fine` and come out as such.
inline ParsedNumber parse_number(std::string_view field, double& value) {
  const char* begin = field.data();
  const char* end = begin + field.size();
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') ++begin;
#ifdef __cpp_lib_to_chars
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument || stop != end) return ParsedNumber::unreadable;
  if (error != std::errc::result_out_of_range) return ParsedNumber::fine;

  // Too large or too small: this function says which.
  value = std::strtod(std::string(begin, end).c_str(), nullptr);
  return std::isinf(value) ? ParsedNumber::infinite : ParsedNumber::fine;
#else
  const auto [stop, error] = fast_float::from_chars(begin, end, value);
  if (error != std::errc() || stop != end) return ParsedNumber::unreadable;
  // It reads numbers that are too large as the word "inf".
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return std::isinf(value) && std::any_of(begin, end, is_digit) ? ParsedNumber::infinite : ParsedNumber::fine;
#endif
}

/// Throws Error(input) that names the place if the text is not UTF-8 or has control characters besides blanks
/// and line ends. lines_before: of the file, before the text. Defined in text.cpp.
void check_text(const std::string& name, std::string_view text, std::size_t lines_before = 0);

/// Steps through the lines of a text that hold something besides blanks and '#' comments, and through their
/// fields. With Separator::any, semicolons separate the fields of a line that has some, or else commas if it
/// has some, or else white space; fields may be in double quotes; and where semicolons or tabs separate
/// fields, numbers may have decimal commas.
class Lines {
 public:
  enum class Separator { blanks, any };

  /// name: the beginning of messages. The text must outlive this object. Throws what check_text throws.
  Lines(std::string name, std::string_view text, Separator separator) : Lines(std::move(name), separator) {
    go_on(text);
  }
  /// For a text that comes in pieces of whole lines.
  Lines(std::string name, Separator separator) : name_(std::move(name)), any_(separator == Separator::any) {}
  /// The next piece. Throws what check_text throws.
  void go_on(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    const bool is_marked = number_ == 0 && text.substr(0, kByteOrderMark.size()) == kByteOrderMark;
    if (is_marked) text.remove_prefix(kByteOrderMark.size());
    check_text(name_, text, number_);
    next_line_ = text.data();
    text_end_ = text.data() + text.size();
    const auto has = [&](char c) { return any_ && find(next_line_, text_end_, c) != text_end_; };
    has_semicolons_ = has(';');
    has_commas_ = has(',');
    has_quotes_ = has('"');
  }

  /// Goes to the next line with content; false at the end.
  bool next() {
    while (next_line_ != text_end_) {
      ++number_;
      line_begin_ = next_line_;
      line_end_ = find(line_begin_, text_end_, '\n');
      next_line_ = line_end_ == text_end_ ? text_end_ : line_end_ + 1;
      const char* const mark = has_quotes_ ? find_unquoted('#') : find(line_begin_, line_end_, '#');
      has_comment_ = mark != line_end_;
      line_end_ = mark;
      while (line_end_ != line_begin_ && is_padding(line_end_[-1])) --line_end_;
      separator_ = has_tabs_ ? '\t' : has_semicolons_ || has_commas_ ? find_separator() : ' ';
      rewind();
      if (cursor_ != line_end_) return true;
    }
    return false;
  }
  /// From the line at hand on, tabs separate fields and nothing else does, if it has tabs but no other
  /// separators than white space.
  void prefer_tabs() {
    has_tabs_ = separator_ == ' ' && find_unquoted('\t') != line_end_;
    if (!has_tabs_) return;
    next_line_ = line_begin_;
    --number_;
    next();
  }
  /// Goes back to the first field of the line.
  void rewind() {
    cursor_ = line_begin_;
    skip_blanks();
    fields_taken_ = 0;
  }

  /// The next field of the line; false at its end. Two commas in a row have an empty field between them.
  bool field(std::string_view& result) {
    const bool is_after_separator = separator_ != ' ' && fields_taken_ > 0 && cursor_ != line_end_;
    if (is_after_separator) ++cursor_;
    skip_blanks();
    if (cursor_ == line_end_ && !is_after_separator) return false;
    ++fields_taken_;
    if ((is_in_quotes_ = quoted_field(result))) return true;
    const char* const begin = cursor_;
    if (separator_ == ' ') {
      while (cursor_ != line_end_ && !is_blank(*cursor_)) ++cursor_;
    } else {
      cursor_ = find(begin, line_end_, separator_);
    }
    result = trimmed(begin, cursor_);
    return true;
  }
  /// Whether the last field that was taken is in double quotes.
  bool is_in_quotes() const { return is_in_quotes_; }
  /// Whether a comment ends this line.
  bool has_comment() const { return has_comment_; }
  /// The separator of this line's fields: ' ' for white space, '\t', ',' or ';'.
  char separator() const { return separator_; }
  std::size_t fields_taken() const { return fields_taken_; }
  /// The number of fields of the whole line. Goes back to the first one.
  std::size_t count_fields() {
    rewind();
    std::string_view ignored;
    while (field(ignored)) {
    }
    const std::size_t count = fields_taken_;
    rewind();
    return count;
  }

  /// The next field as a whole number; `what` names it for the message.
  long long integer(std::string_view what) {
    std::string_view text;
    if (!field(text)) fail_line("expected {}, found the end of the line", what);
    return whole_number(text, what);
  }
  /// A field of this line as a whole number.
  long long whole_number(std::string_view text, std::string_view what) const {
    long long value = 0;
    const std::size_t skip = text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0;
    const auto [stop, error] = std::from_chars(text.data() + skip, text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size()) {
      fail_field(text, "expected {} (a whole number), found {}", what, quoted_number(text));
    }
    return value;
  }

  /// Reads a field of this line as a double.
  ParsedNumber number(std::string_view text, double& value) const {
    return has_decimals() ? parse_decimal(text, value) : parse_number(text, value);
  }
  /// Whether a coordinate has a decimal comma, or point; known where numbers may have commas.
  bool has_decimal(char mark) const { return mark == ',' ? has_decimal_commas_ : has_decimal_points_; }

  /// Converts `text`, a field of this line, to a coordinate of the point with this index, which must be
  /// finite. hint: the end of the message if the field is no number. what: in place of "coordinate".
  double coordinate(std::string_view text, std::size_t point, std::string_view hint = "",
                    std::string_view what = "coordinate") {
    double value = 0;
    const ParsedNumber parsed = number(text, value);
    if (has_decimals() && parsed != ParsedNumber::unreadable) note_decimal(text);
    if (parsed == ParsedNumber::unreadable) {
      fail_field(text, "expected a number (a {} of point {}), found {}{}", what, point, quoted_number(text),
                 hint_about(text, hint));
    }
    if (parsed == ParsedNumber::infinite) {
      fail_field(text, "point {} has {} {}, beyond the largest double: infinity; expected finite numbers",
                 point, what, quoted(text));
    }
    if (!std::isfinite(value)) {
      fail_field(text, "point {} has {} {}; expected finite numbers", point, what, quoted(text));
    }
    return value;
  }

  /// The end of a message about a field that is no number, if its commas may be decimal ones.
  std::string_view hint_about(std::string_view text, std::string_view otherwise) const;

  const std::string& name() const { return name_; }
  /// The number of the line, in the file; after the last one, how many lines there are.
  std::size_t number() const { return number_; }
  /// An upper bound of the number of lines left, for reserving memory.
  std::size_t lines_left() const {
    std::size_t lines = 1;
    for (const char* c = next_line_; (c = find(c, text_end_, '\n')) != text_end_; ++c) ++lines;
    return lines;
  }

  template <typename... Arguments>
  [[noreturn]] void fail_line(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    fail(name_, "line {}: {}", number_, fmt::format(format, std::forward<Arguments>(arguments)...));
  }
  template <typename... Arguments>
  [[noreturn]] void fail_field(std::string_view field, fmt::format_string<Arguments...> format,
                               Arguments&&... arguments) const {
    fail(name_, "line {}, column {}: {}", number_, field.data() - line_begin_ + 1,
         fmt::format(format, std::forward<Arguments>(arguments)...));
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
  static const char* find(const char* begin, const char* end, char wanted) {
    const void* found =
        begin == end ? nullptr : std::memchr(begin, wanted, static_cast<std::size_t>(end - begin));
    return found ? static_cast<const char*>(found) : end;
  }
  /// White space that separates no fields.
  bool is_padding(char c) const { return is_blank(c) && !(has_tabs_ && c == '\t'); }
  /// Whether numbers of this line may have decimal commas.
  bool has_decimals() const { return separator_ == ';' || separator_ == '\t'; }
  /// The first such character of the line outside of quotes, or the line's end. Defined in text.cpp, as are
  /// the next ones.
  const char* find_unquoted(char wanted) const;
  /// The separator of the line at hand.
  char find_separator() const;
  /// A number with a decimal comma or a decimal point.
  static ParsedNumber parse_decimal(std::string_view text, double& value);
  /// Coordinates of a text use only one of the two.
  void note_decimal(std::string_view text);

  static std::string_view trimmed(const char* begin, const char* end) {
    while (begin != end && is_blank(*begin)) ++begin;
    while (begin != end && is_blank(end[-1])) --end;
    return std::string_view(begin, static_cast<std::size_t>(end - begin));
  }
  /// Takes a field in double quotes, in which "" stands for a quote, as in CSV. False if the field has no
  /// quotes; a quote without its end is an ordinary character.
  bool quoted_field(std::string_view& result) {
    if (!any_ || cursor_ == line_end_ || *cursor_ != '"') return false;
    const char* const begin = cursor_ + 1;
    const char* end = find(begin, line_end_, '"');
    while (line_end_ - end > 1 && end[1] == '"') end = find(end + 2, line_end_, '"');
    if (end == line_end_) return false;
    const char* after = end + 1;
    while (separator_ != ' ' && after != line_end_ && is_padding(*after)) ++after;
    if (after != line_end_ && !(separator_ == ' ' ? is_blank(*after) : *after == separator_)) return false;
    cursor_ = after;
    result = trimmed(begin, end);
    return true;
  }
  void skip_blanks() {
    while (cursor_ != line_end_ && is_padding(*cursor_)) ++cursor_;
  }

  std::string name_;
  bool any_;              // whether there may be other separators than white space
  char separator_ = ' ';  // of the line
  bool has_semicolons_ = false, has_commas_ = false, has_quotes_ = false;  // the text
  bool has_tabs_ = false;                                         // between fields, and nothing else there
  bool has_decimal_points_ = false, has_decimal_commas_ = false;  // coordinates, where they may have both
  bool has_comment_ = false;                                      // the line
  bool is_in_quotes_ = false;                                     // the last field
  std::size_t number_ = 0;
  const char* next_line_ = nullptr;
  const char* text_end_ = nullptr;
  const char* line_begin_ = nullptr;
  const char* line_end_ = nullptr;
  const char* cursor_ = nullptr;
  std::size_t fields_taken_ = 0;
};

/// Whether the line at hand is a header, which names columns: it has letters, and no field that is a number
/// or a mistyped one. A line with such a field is data, and must not be skipped. Goes back to the first
/// field. Defined in text.cpp.
bool is_header(Lines& lines);

/// A vertex or triangle number as an index from 0: `number` - `base`, checked to be below `count`.
inline std::int32_t checked_index(const Lines& lines, std::string_view what, long long number, long long base,
                                  long long count) {
  count = std::min<long long>(count, std::numeric_limits<std::int32_t>::max());
  if (number < base || number - base >= count) {
    lines.fail_line("{} {} is out of range; expected {} to {}", what, number, base, base + count - 1);
  }
  return static_cast<std::int32_t>(number - base);
}

}  // namespace flaunay::io
