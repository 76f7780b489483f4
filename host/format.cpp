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

}  // namespace flaunay::host

// As fmt's own library has them. What they take is in another namespace in each version of fmt.
FMT_BEGIN_NAMESPACE
namespace detail {
template auto decimal_point_impl(locale_ref) -> char;
template auto thousands_sep_impl(locale_ref) -> thousands_sep_result<char>;
}  // namespace detail
FMT_END_NAMESPACE
