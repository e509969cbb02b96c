// A table of a driver, in a file beside the model.
#include <cmath>

#include <fmt/format.h>

#include "format/csv_text.h"
#include "fuzz/harness.h"

namespace {

/// Every field has a place, and what is a number is finite.
void read_all(const std::string& text) {
  const freeplay::CsvText table("table.csv", text);
  for (std::size_t row = 0; row < std::min<std::size_t>(table.rows(), 100); ++row) {
    for (std::size_t column = 0; column <= std::min<std::size_t>(table.names().size(), 20); ++column) {
      const auto field = table.field(row, column);
      freeplay::fuzz::require(field.location.line > 0 && field.location.column > 0, "a field has a place");
      const auto number = freeplay::csv_number(field.text);
      freeplay::fuzz::require(!number || !std::isnan(*number), "what is no number is reported");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace freeplay::fuzz;
  static const MemoryFile file;
  const std::string text(data, data + size);
  read_all(text);
  file.write(text);
  constexpr const char* ways[] = {"", ", interpolation: linear, outside: repeat", ", ends: periodic, outside: error",
                                  ", ends: clamped, time_unit: ms, unit: deg"};
  check_model(fmt::format("freeplay: 1\n"
                          "bodies: {{crank: {{mass: 1 kg, inertia: 1 kg*m^2}}}}\n"
                          "joints: {{A: {{type: revolute, between: [ground, crank]}}}}\n"
                          "drivers: {{motor: {{joint: A, kind: angle, table: {{file: {}{}}}}}}}\n",
                          file.path(), ways[size % 4]),
              "model.yaml");
  return 0;
}
