// fmt::vformat, which fmt::format calls, compiled once for the whole library. The other files include the
// declarations of fmt only; with all of fmt in each of them, the library takes almost twice as long to
// compile. If a file uses more of fmt than fmt::format, the function must be added here.
#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace flaunay::host {

// The target defines FMT_HEADER_ONLY, which makes the function inline. The compiler emits it because its
// address is taken.
using Format = std::string (*)(fmt::string_view text, fmt::format_args values);
extern const Format format;
const Format format = &fmt::vformat;

// Functions that formatting into a buffer calls, which is how files are written.
using IsPrintable = bool (*)(std::uint32_t character);
extern const IsPrintable is_printable;
const IsPrintable is_printable = &fmt::detail::is_printable;
using DecimalPoint = char (*)(fmt::detail::locale_ref locale);
extern const DecimalPoint decimal_point;
const DecimalPoint decimal_point = &fmt::detail::decimal_point_impl<char>;
using ThousandsSeparator = fmt::detail::thousands_sep_result<char> (*)(fmt::detail::locale_ref locale);
extern const ThousandsSeparator thousands_separator;
const ThousandsSeparator thousands_separator = &fmt::detail::thousands_sep_impl<char>;

}  // namespace flaunay::host
