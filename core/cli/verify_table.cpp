#include "cli/verify_table.h"

#include <cmath>

#include <fmt/format.h>

#include "cli/text_table.h"

namespace freeplay {
namespace {

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

}  // namespace

std::string verify_table(const Verification& v) {
  std::string text =
      fmt::format("  verified by {} ({} steps): positions agree to {:g} m ", v.finer, v.steps, v.agreement);
  text += v.throughout ? "throughout\n" : fmt::format("until {:.6g} s\n", v.agree_until);
  using Align = TextTable::Align;
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right});
  if (v.throughout) {
    table.add_row({"channel", "observed error"});
  } else {
    text += "  after that the two runs go their own ways: compare statistics, not points\n";
    table.add_row({"channel", "observed error", "rms after", "finer run", "largest after", "finer run"});
  }
  for (const ChannelError& c : v.channels) {
    std::vector<std::string> row{c.name, fmt::format("{:.2g}", c.error)};
    if (!v.throughout) {
      for (const double value : {c.rms, c.finer_rms, c.largest, c.finer_largest}) row.push_back(number(value));
    }
    table.add_row(std::move(row));
  }
  return text + table.text("  ");
}

}  // namespace freeplay
