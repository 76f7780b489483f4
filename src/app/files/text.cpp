#include "app/files/text.hpp"

#include <algorithm>
#include <array>

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

struct Range {
  char32_t first, last;
};
template <std::size_t count>
bool in_any(const std::array<Range, count>& ranges, char32_t c) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [c](const Range& range) { return c >= range.first && c <= range.last; });
}

/// Decimal digits of scripts that keyboards and spreadsheets produce.
constexpr std::array<Range, 7> kDigits{{{'0', '9'},
                                        {0x660, 0x669},      // Arabic
                                        {0x6f0, 0x6f9},      // Persian and Urdu
                                        {0x966, 0x96f},      // Devanagari
                                        {0x9e6, 0x9ef},      // Bengali
                                        {0xe50, 0xe59},      // Thai
                                        {0xff10, 0xff19}}};  // full width

/// Punctuation and symbols that stand where a number begins: signs, brackets, currencies, spaces.
constexpr std::array<Range, 4> kSymbols{{{0x80, 0xbf},        // of Latin-1
                                         {0x2000, 0x2bff},    // the minus sign and the dashes are here
                                         {0x3000, 0x303f},    // of Chinese and Japanese
                                         {0xff00, 0xff20}}};  // full width

bool is_letter(char32_t c) {
  if (c <= kLastAscii) return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return !in_any(kDigits, c) && !in_any(kSymbols, c);
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
  while (!field.empty()) {
    const CodePoint next = first_code_point(field);
    if (in_any(kDigits, next.value)) return true;
    if (is_letter(next.value)) return false;
    field.remove_prefix(next.bytes);
  }
  return false;
}

bool has_letter(std::string_view field) {
  while (!field.empty()) {
    const CodePoint next = first_code_point(field);
    if (is_letter(next.value)) return true;
    field.remove_prefix(next.bytes);
  }
  return false;
}

}  // namespace

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

bool is_header(Lines& lines) {
  bool numbers = false, letters = false;
  std::string_view field;
  while (lines.field(field)) {
    numbers = numbers || looks_like_number(field);
    letters = letters || has_letter(field);
  }
  lines.rewind();
  return letters && !numbers;
}

}  // namespace flaunay::io
