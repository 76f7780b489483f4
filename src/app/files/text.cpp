#include "app/files/text.hpp"

#include <algorithm>

namespace flaunay::io {
namespace {

constexpr char32_t kLastAscii = 0x7f;

/// Whether the byte is a printable ASCII character, or one of the blanks and line ends from tab to carriage
/// return. Most texts hold nothing else.
constexpr bool is_plain(unsigned char c) { return (c >= 0x20 && c < 0x7f) || (c >= '\t' && c <= '\r'); }

/// Whether all bytes of a block are plain. Without a branch per byte, so that compilers use vector
/// instructions.
constexpr std::ptrdiff_t kBlock = 64;
bool is_plain_block(const char* block) {
  unsigned char others = 0;
  for (std::ptrdiff_t i = 0; i < kBlock; ++i) {
    const auto c = static_cast<unsigned char>(block[i]);
    const auto from_space = static_cast<unsigned char>(c - ' '),
               from_tab = static_cast<unsigned char>(c - '\t');
    others |= static_cast<unsigned char>((from_space >= 0x7f - ' ') & (from_tab > '\r' - '\t'));
  }
  return others == 0;
}

/// The first byte from c on that is not plain, or end.
const char* skip_plain(const char* c, const char* end) {
  while (end - c >= kBlock && is_plain_block(c)) c += kBlock;
  while (c != end && is_plain(static_cast<unsigned char>(*c))) ++c;
  return c;
}

/// Control characters that are not blanks: terminals obey some of them, and a text has none.
bool is_control(char32_t c) {
  return (c <= kLastAscii && !is_plain(static_cast<unsigned char>(c))) || (c >= 0x80 && c < 0xa0);
}

/// Whether the byte is an ASCII letter or begins a letter of another script. Bytes that can begin something
/// like a number do not count: 0xc2 (Latin-1's symbols), 0xe2 (dashes, currencies, the minus sign), 0xef
/// (full width).
bool begins_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (byte >= 0xc3 && byte != 0xe2 && byte != 0xef);
}

/// Whether the field is meant as a number, even if it is not a valid one.
bool looks_like_number(std::string_view field) {
  double ignored;
  if (parse_number(field, ignored) != ParsedNumber::unreadable) return true;
  // "e5" has lost its digits before the exponent, and in "O.5" a letter stands for a zero.
  constexpr std::string_view kOfNumbers = "0123456789+-.eEoO", kDigitsAndLetterO = "0123456789oO";
  if (field.find_first_not_of(kOfNumbers) == std::string_view::npos &&
      field.find_first_of(kDigitsAndLetterO) != std::string_view::npos) {
    return true;
  }
  // "1.2.3", "0x10" and "(1" are numbers with something wrong; "X_1" is a name.
  const auto first = std::find_if(field.begin(), field.end(),
                                  [](char c) { return (c >= '0' && c <= '9') || begins_letter(c); });
  return first != field.end() && !begins_letter(*first);
}

struct CodePoint {
  char32_t value = 0;
  std::size_t bytes = 0;  ///< none if the text is not valid UTF-8
};
/// The first character of a text that is not empty.
CodePoint first_code_point(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead <= kLastAscii) return {lead, 1};
  // The lead byte says how many bytes follow, each with six bits. Values below `least` have a shorter form.
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  const char32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  if (lead < 0xc0 || lead >= 0xf8 || text.size() < bytes) return {};
  char32_t value = lead & (0x7f >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    value = value << 6 | (byte(i) & 0x3f);
  }
  const bool is_surrogate = value >= 0xd800 && value < 0xe000;
  if (value < least || value > 0x10ffff || is_surrogate) return {};
  return {value, bytes};
}

}  // namespace

void check_text(const std::string& name, std::string_view text, std::size_t lines_before) {
  const char* const end = text.data() + text.size();
  const char* c = text.data();
  while ((c = skip_plain(c, end)) != end) {
    const CodePoint next = first_code_point(std::string_view(c, static_cast<std::size_t>(end - c)));
    if (next.bytes > 0 && !is_control(next.value)) {
      c += next.bytes;
      continue;
    }
    const auto line = lines_before + static_cast<std::size_t>(std::count(text.data(), c, '\n')) + 1;
    const char* line_begin = c;
    while (line_begin != text.data() && line_begin[-1] != '\n') --line_begin;
    fail(name, "line {}, column {}: byte 0x{:02x} is {}; expected text in UTF-8", line, c - line_begin + 1,
         static_cast<unsigned char>(*c), next.bytes == 0 ? "not valid UTF-8" : "part of a control character");
  }
}

const char* Lines::find_unquoted(char wanted) const {
  const auto is_odd = [](const char* begin, const char* end) { return std::count(begin, end, '"') % 2 != 0; };
  const char* c = find(line_begin_, line_end_, wanted);
  // A quote without its end is an ordinary character.
  if (c == line_end_ || !has_quotes_ || is_odd(line_begin_, line_end_)) return c;
  bool is_quoted = is_odd(line_begin_, c);
  while (is_quoted && c != line_end_) {
    const char* const from = c;
    c = find(c + 1, line_end_, wanted);
    is_quoted = is_quoted != is_odd(from, c);
  }
  return c;
}

char Lines::find_separator() const {
  for (const char wanted : {';', ','}) {
    if (!(wanted == ';' ? has_semicolons_ : has_commas_)) continue;
    if (find_unquoted(wanted) != line_end_) return wanted;
  }
  return ' ';
}

ParsedNumber Lines::parse_decimal(std::string_view text, double& value) {
  const std::size_t comma = text.find(',');
  const bool has_comma = comma != std::string_view::npos,
             has_point = text.find('.') != std::string_view::npos;
  if (has_comma && has_point) return ParsedNumber::unreadable;
  std::string changed(text);
  if (has_comma) changed[comma] = '.';
  return parse_number(changed, value);
}

void Lines::note_decimal(std::string_view text) {
  const bool has_comma = text.find(',') != std::string_view::npos,
             has_point = text.find('.') != std::string_view::npos;
  has_decimal_commas_ = has_decimal_commas_ || has_comma;
  has_decimal_points_ = has_decimal_points_ || has_point;
  if (has_decimal_commas_ && has_decimal_points_) {
    fail_field(text, "{} has a decimal {}, but a number before it has a decimal {}", quoted(text),
               has_comma ? "comma" : "point", has_comma ? "point" : "comma");
  }
}

std::string_view Lines::hint_about(std::string_view text, std::string_view otherwise) const {
  const bool has_numbers = text.find_first_not_of("0123456789+-.eE \t") == std::string_view::npos;
  if (separator_ == ',' && has_numbers && std::any_of(text.begin(), text.end(), is_blank)) {
    return "; this line has commas and white space: if the commas are decimal ones, separate columns by "
           "semicolons, and otherwise by either commas or white space";
  }
  if (!any_ || text.find(',') == std::string_view::npos) return otherwise;
  return has_decimals() ? "; expected one decimal comma or one decimal point"
                        : "; if the comma is a decimal one, separate columns by semicolons";
}

bool is_header(Lines& lines) {
  bool numbers = false, letters = false;
  std::string_view field;
  while (lines.field(field)) {
    numbers = numbers || looks_like_number(field);
    letters = letters || std::any_of(field.begin(), field.end(), begins_letter);
  }
  lines.rewind();
  return letters && !numbers;
}

}  // namespace flaunay::io
