// fmt::vformat, which fmt::format calls, compiled once for the whole library. The other files include the
// declarations of fmt only; with all of fmt in each of them, the library takes almost twice as long to
// compile. If a file uses more of fmt than fmt::format, what it needs must be added here.
#include <fmt/format.h>

#include <string>

namespace flaunay::host {

// The target defines FMT_HEADER_ONLY, which makes the function inline. The compiler emits it because its
// address is taken.
using Format = std::string (*)(fmt::string_view text, fmt::format_args values);
extern const Format format;
const Format format = &fmt::vformat;

}  // namespace flaunay::host
