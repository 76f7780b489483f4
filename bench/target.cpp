#include "target.hpp"

#include <fmt/format.h>

namespace flaunay::bench {

const char* Target::verdict() const {
  if (!measured) return "not measured";
  if (reached(*measured) >= reached(goal)) return "goal";
  return reached(*measured) >= 1 ? "kept" : "MISSED";
}

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return {};
  return *a / *b;
}

std::string thousands(std::size_t n) {
  if (n % 1000000 == 0) return fmt::format("{}M", n / 1000000);
  return n % 1000 == 0 ? fmt::format("{}k", n / 1000) : fmt::format("{}", n);
}

void print_targets(const std::vector<Target>& targets) {
  fmt::print("\n{:<20} {:<46} {:>9} {:>8} {:>9}\n", "implementation", "what", "at least", "goal", "measured");
  for (const Target& t : targets) {
    const char* sign = t.more_is_better() ? ">=" : "<=";
    fmt::print("{:<20} {:<46} {:>9} {:>8} {:>9}  {}\n", t.implementation, t.what,
               fmt::format("{} {:g}", sign, t.at_least), fmt::format("{} {:g}", sign, t.goal),
               t.measured ? fmt::format("{:.3g}", *t.measured) : "-", t.verdict());
  }
}

nlohmann::json record_of(const std::vector<Target>& targets) {
  nlohmann::json result = nlohmann::json::array();
  for (const Target& t : targets) {
    result.push_back({{"what", t.what},
                      {"implementation", t.implementation},
                      {"more_is_better", t.more_is_better()},
                      {"at_least", t.at_least},
                      {"goal", t.goal},
                      {"measured", t.measured ? nlohmann::json(*t.measured) : nlohmann::json()},
                      {"verdict", t.verdict()}});
  }
  return result;
}

}  // namespace flaunay::bench
