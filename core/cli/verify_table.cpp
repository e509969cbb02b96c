#include "cli/verify_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text_table.h"
#include "job/verification_record.h"

namespace freeplay {
namespace {

using Align = TextTable::Align;

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

}  // namespace

std::string verify_table(const Verification& v) {
  std::string text = fmt::format("  verified by {}, {} steps: {}\n", v.method, v.steps, agreement_text(v));
  const bool any = std::ranges::any_of(v.peaks, [](const PeakPair& peak) { return !std::isnan(peak.run); });
  if (!v.peaks.empty() && !any) text += "  no peaks to compare: the run ended before its statistics began\n";
  TextTable peaks({Align::left, Align::right, Align::right, Align::left});
  peaks.add_row({"peak", "this run", "second run", ""});
  for (const PeakPair& peak : v.peaks) {
    peaks.add_row({peak.name, number(peak.run), number(peak.second), peak.differs ? "differs" : ""});
  }
  if (any) text += peaks.text("  ");
  const bool throughout = v.throughout();
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right});
  if (throughout) {
    table.add_row({"channel", "observed error"});
  } else {
    table.add_row({"channel", "observed error", "rms after", "second run", "largest after", "second run"});
  }
  for (const ChannelError& c : v.channels) {
    std::vector<std::string> row{c.name, fmt::format("{:.2g}", c.error)};
    if (!throughout) {
      for (const double value : {c.rms, c.second_rms, c.largest, c.second_largest}) row.push_back(number(value));
    }
    table.add_row(std::move(row));
  }
  return text + table.text("  ");
}

}  // namespace freeplay
