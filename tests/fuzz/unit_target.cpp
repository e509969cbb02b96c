// A unit such as "N/m^1.5", alone and inside of a longer text.
#include <cmath>

#include "base/expression_error.h"
#include "base/text.h"
#include "base/unit.h"
#include "fuzz/harness.h"

namespace {

using namespace freeplay;

void check_place(const ExpressionError& error, std::string_view text) {
  const int width = character_count(text);
  fuzz::require(error.offset >= 0 && error.offset <= width && error.length >= 1, "an error points into the unit");
}

void check_unit(const Unit& unit) {
  fuzz::require(std::isfinite(unit.factor) && unit.factor > 0.0, "a unit has a factor");
  fuzz::require(!dimension_name(unit.dimension).empty() && !si_unit(unit.dimension).empty(), "a dimension has a name");
  const Dimension& d = unit.dimension;
  fuzz::require(std::isfinite(d.kg) && std::isfinite(d.m) && std::isfinite(d.s), "exponents are finite");
}

template <class Read>
void attempt(std::string_view text, Read&& read) {
  try {
    check_unit(read());
  } catch (const ExpressionError& error) {
    check_place(error, text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  attempt(text, [&] { return parse_unit(text); });
  attempt(text, [&] {
    return parse_unit(text, [](std::string_view name) {
      return name == "exponent" ? std::optional<double>(1.5)
             : name == "kind"   ? std::optional<double>(1.0)
                                : std::nullopt;
    });
  });
  attempt(text, [&] {
    std::size_t position = 0;
    const Unit unit = parse_unit_at(text, position);
    fuzz::require(position <= text.size(), "a unit ends in its text");
    return unit;
  });
  return 0;
}
