#include "job/verification_record.h"

#include <cmath>

#include <fmt/format.h>

namespace freeplay {
namespace {

std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4g}", value); }

const char* word(Agreement agreement) {
  constexpr const char* words[] = {"agree", "err", "part", "disagree"};
  return words[static_cast<int>(agreement)];
}

}  // namespace

std::string agreement_text(const Verification& v) {
  const std::string limit = fmt::format("{:g} m", v.limit);
  std::string peaks;
  for (const PeakPair& peak : v.peaks) {
    if (peak.differs)
      peaks +=
          fmt::format("{}{}: {} and {}", peaks.empty() ? "" : ", ", peak.name, number(peak.run), number(peak.second));
  }
  const std::string throughout =
      v.whole ? fmt::format("positions agree to {} throughout", limit)
              : fmt::format("positions agree to {} until {:.6g} s, where the second run ended", limit, v.until);
  const std::string difference =
      v.largest > v.limit
          ? fmt::format("positions agree to {} until {:.6g} s and differ by up to {:.2g} m, at {:.6g} s", limit,
                        v.agree_until, v.largest, v.at)
          : throughout;
  switch (v.agreement) {
    case Agreement::agree:
      return throughout;
    case Agreement::err:
      return (peaks.empty() ? difference : difference + "; peaks differ (" + peaks + ")") +
             ": one of both methods errs by more than that; ask for more accuracy, or for shorter steps, if it is too "
             "much";
    case Agreement::part:
      return fmt::format(
          "positions agree to {} until {:.6g} s; after that runs go their own ways, as those of a chaotic "
          "motion do: compare statistics, not points",
          limit, v.agree_until);
    case Agreement::disagree:
      break;
  }
  return "THE RUNS DISAGREE: " + (peaks.empty() ? difference : difference + "; peaks differ (" + peaks + ")") +
         "; this is not chaos: do not use these results, and ask for more accuracy or shorter steps";
}

Json verification_json(const Verification& v) {
  Json peaks = Json::array();
  for (const PeakPair& peak : v.peaks) {
    peaks.push_back({{"name", peak.name},
                     {"run", json_number(peak.run)},
                     {"second", json_number(peak.second)},
                     {"differs", peak.differs}});
  }
  return {{"method", v.method}, {"steps", v.steps},
          {"until", v.until},   {"agreement", word(v.agreement)},
          {"limit", v.limit},   {"largest", json_number(v.largest)},
          {"at", v.at},         {"peaks", std::move(peaks)}};
}

}  // namespace freeplay
