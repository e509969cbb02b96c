#include "format/range.h"

#include <cmath>

#include <fmt/format.h>

namespace freeplay {
namespace {

bool has(Open open, Open end) { return (static_cast<unsigned>(open) & static_cast<unsigned>(end)) != 0; }

}  // namespace

std::string with_unit(double value, const std::string& unit) {
  return unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

bool Range::contains(double x) const {
  const bool above = has(open, Open::minimum) ? x > minimum : x >= minimum;
  const bool below = has(open, Open::maximum) ? x < maximum : x <= maximum;
  return above && below;
}

std::string Range::text(const std::string& unit) const {
  std::string text;
  if (std::isfinite(minimum)) text = (has(open, Open::minimum) ? "> " : ">= ") + with_unit(minimum, unit);
  if (!std::isfinite(maximum)) return text;
  if (!text.empty()) text += " and ";
  return text + (has(open, Open::maximum) ? "< " : "<= ") + with_unit(maximum, unit);
}

}  // namespace freeplay
