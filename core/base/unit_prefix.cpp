#include "base/unit_prefix.h"

#include <cmath>
#include <utility>

namespace freeplay {

PrefixedUnit prefixed_unit(double value, std::string_view unit) {
  constexpr std::pair<double, const char*> prefixes[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1.0, ""},
                                                         {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}};
  for (const auto& [factor, prefix] : prefixes) {
    if (std::abs(value) >= factor) return {factor, std::string(prefix).append(unit)};
  }
  return {1.0, std::string(unit)};
}

}  // namespace freeplay
