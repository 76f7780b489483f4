#include "ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace flaunay::bench::plot {
namespace {

struct Prefix {
  double factor;
  const char* text;
};

// Descending, so that the first one not above the value is the one to take.
const std::vector<Prefix>& prefixes(Unit unit, bool binary) {
  static const std::vector<Prefix> kNone = {{1e12, "T"}, {1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}};
  static const std::vector<Prefix> kSeconds = {
      {1, " s"}, {1e-3, " ms"}, {1e-6, " µs"}, {1e-9, " ns"}, {1e-12, " ps"}};
  static const std::vector<Prefix> kBytes = {
      {1e12, " TB"}, {1e9, " GB"}, {1e6, " MB"}, {1e3, " kB"}, {1, " B"}};
  static const std::vector<Prefix> kBinaryBytes = {
      {0x1p40, " TiB"}, {0x1p30, " GiB"}, {0x1p20, " MiB"}, {0x1p10, " KiB"}, {1, " B"}};
  static const std::vector<Prefix> kPercent = {{0.01, " %"}};
  switch (unit) {
    case Unit::seconds:
      return kSeconds;
    case Unit::bytes:
      return binary ? kBinaryBytes : kBytes;
    case Unit::percent:
      return kPercent;
    case Unit::none:
      break;
  }
  return kNone;
}

/// The prefix for a value; a tiny tolerance, since 1000 * 1e-3 must count as 1.
Prefix prefix_for(Unit unit, double value, bool binary) {
  const std::vector<Prefix>& all = prefixes(unit, binary);
  const double size = std::abs(value) * (1 + 1e-9);
  // Numbers below ten thousand are shorter without a prefix, fractions have none.
  if (unit == Unit::none && size < 1e4) return {1, ""};
  for (const Prefix& prefix : all) {
    if (size >= prefix.factor) return prefix;
  }
  return all.back();
}

std::string with_prefix(double value, const Prefix& prefix) {
  // Rounds away what binary fractions add: 0.30000000000000004.
  return fmt::format("{:.6g}{}", value / prefix.factor, prefix.text);
}

std::string logarithmic_label(const Axis& axis, Range range, double value) {
  constexpr double kPlainUpTo = 2000, kPlainFrom = 1e-3;
  const bool binary = axis.scale == Scale::log2;
  if (axis.unit == Unit::none && (range.high > kPlainUpTo || range.low < kPlainFrom)) {
    const double base = binary ? 2 : 10;
    const double exponent = std::floor(std::log(value) / std::log(base) + 1e-9);
    const double factor = value / std::pow(base, exponent);
    const std::string power = fmt::format("{:.0f}^{{{:.0f}}}", base, exponent + 0.0);
    if (std::abs(factor - 1) < 1e-9) return power;
    if (!binary) return fmt::format("{:.3g}·{}", factor, power);
  }
  return with_prefix(value, prefix_for(axis.unit, value, binary));
}

/// 1, 2 or 5 times a power of ten, so that the range has about `wanted` steps.
double round_step(double length, int wanted) {
  const double rough = length / wanted;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<double> linear_values(Range range, int wanted) {
  const double step = round_step(range.high - range.low, wanted);
  std::vector<double> values;
  const double tolerance = 1e-9 * step;
  for (double k = std::ceil((range.low - tolerance) / step); k * step <= range.high + tolerance; ++k) {
    values.push_back(k * step + 0.0);
  }
  return values;
}

/// base^k times each factor, within the range, for each stride-th k.
std::vector<double> power_values(Range range, double base, const std::vector<double>& factors, int stride) {
  std::vector<double> values;
  const int first = static_cast<int>(std::floor(std::log(range.low) / std::log(base))) - 1;
  const int last = static_cast<int>(std::ceil(std::log(range.high) / std::log(base))) + 1;
  for (int k = first; k <= last; ++k) {
    if (k % stride != 0) continue;
    for (const double factor : factors) {
      const double value = factor * std::pow(base, k);
      if (value >= range.low * (1 - 1e-9) && value <= range.high * (1 + 1e-9)) values.push_back(value);
    }
  }
  return values;
}

std::vector<double> logarithmic_values(Scale scale, Range range, int wanted) {
  const double base = scale == Scale::log2 ? 2 : 10;
  const auto enough = [&](const std::vector<double>& values) { return values.size() >= 3; };
  for (int stride = 1;; ++stride) {
    const std::vector<double> values = power_values(range, base, {1}, stride);
    if (static_cast<int>(values.size()) > wanted + 1) continue;
    if (enough(values)) return values;
    break;
  }
  if (scale == Scale::log10) {
    for (const std::vector<double>& factors : {std::vector<double>{1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 5, 7}}) {
      const std::vector<double> values = power_values(range, base, factors, 1);
      if (enough(values)) return values;
    }
  }
  return linear_values(range, wanted);
}

double transformed(Scale scale, double value) { return scale == Scale::linear ? value : std::log(value); }
double restored(Scale scale, double value) { return scale == Scale::linear ? value : std::exp(value); }

}  // namespace

bool showable(Scale scale, double value) {
  return std::isfinite(value) && (scale == Scale::linear || value > 0);
}

double share(Scale scale, Range range, double value) {
  const double low = transformed(scale, range.low), high = transformed(scale, range.high);
  return (transformed(scale, value) - low) / (high - low);
}

Range range_around(Scale scale, Range data, bool from_zero) {
  constexpr double kRoom = 0.05, kNearZero = 0.4;
  if (scale == Scale::linear && data.low >= 0 && (from_zero || data.low < kNearZero * data.high)) {
    return {0, data.high > 0 ? data.high * (1 + kRoom) : 1};
  }
  double low = transformed(scale, data.low), high = transformed(scale, data.high);
  // A single value has no extent; it goes to the middle.
  const double least = scale == Scale::linear ? std::max(1e-9, 0.1 * std::abs(low)) : 0.5;
  if (high - low < 1e-12 * std::max(1.0, std::abs(low))) {
    low -= least;
    high += least;
  }
  const double room = kRoom * (high - low);
  return {restored(scale, low - room), restored(scale, high + room)};
}

std::vector<Tick> ticks(const Axis& axis, Range range, int wanted) {
  std::vector<Tick> result;
  if (axis.scale == Scale::linear) {
    const std::vector<double> values = linear_values(range, wanted);
    const double largest = std::max(std::abs(range.low), std::abs(range.high));
    const Prefix prefix = prefix_for(axis.unit, values.empty() ? largest : values.back(), false);
    for (const double value : values) {
      result.push_back({value, value == 0 ? "0" : with_prefix(value, prefix)});
    }
    return result;
  }
  for (const double value : logarithmic_values(axis.scale, range, wanted)) {
    result.push_back({value, logarithmic_label(axis, range, value)});
  }
  return result;
}

std::string value_label(Unit unit, double value) {
  const Prefix prefix = prefix_for(unit, value, false);
  const double scaled = value / prefix.factor;
  // Three digits would make an exponent of what has four before the point.
  if (std::abs(scaled) >= 999.5) return fmt::format("{:.0f}{}", scaled, prefix.text);
  return fmt::format("{:.3g}{}", scaled, prefix.text);
}

}  // namespace flaunay::bench::plot
