#include "report/channel_choice.h"

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/name_pattern.h"
#include "results/channel_choice.h"

namespace freeplay {
namespace {

using Names = std::unordered_set<std::string>;

std::string element_of(const std::string& channel) {
  const std::size_t begin = channel.find('.'), end = channel.rfind('.');
  return begin < end ? channel.substr(begin + 1, end - begin - 1) : std::string();
}

/// Joints with a normal force.
Names loose_joints(const std::vector<RecordColumn>& columns) {
  Names names;
  for (const RecordColumn& column : columns) {
    if (column.name.starts_with("joint.") && column.name.ends_with(".fn")) names.insert(element_of(column.name));
  }
  return names;
}

int rank(const std::string& channel, const Names& loose) {
  const std::string kind = channel.substr(0, channel.find('.'));
  if (kind == "energy") return 0;
  if (kind == "frame") return 1;
  if (kind == "driver") {
    const auto is = [&](const char* error) { return channel.ends_with(error); };
    return is(".ex") || is(".ey") || is(".ez") || is(".eangle") ? 1 : 2;
  }
  if (kind == "joint" && loose.contains(element_of(channel))) return 3;
  return kind == "body" ? 4 : 5;
}

std::vector<std::size_t> usual(const std::vector<RecordColumn>& columns) {
  const Names loose = loose_joints(columns);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 1; i < columns.size(); ++i) chosen.push_back(i);
  std::ranges::stable_sort(chosen, {}, [&](std::size_t i) { return rank(columns[i].name, loose); });
  return chosen;
}

void require_fit(std::span<const ReportedRun> runs, const std::string& pattern) {
  std::vector<std::string> names;
  for (const ReportedRun& run : runs) {
    for (std::size_t i = 1; i < run.columns.size(); ++i) {
      if (matches(pattern, run.columns[i].name)) return;
      names.push_back(run.columns[i].name);
    }
  }
  throw Error(Error::Category::usage, "unknown-channel", fmt::format("--channels: no channel fits '{}'", pattern), {},
              channel_hint(pattern, names));
}

}  // namespace

std::vector<std::vector<std::size_t>> choose_channels(std::span<const ReportedRun> runs,
                                                      std::span<const std::string> patterns) {
  for (const std::string& pattern : patterns) require_fit(runs, pattern);
  std::vector<std::vector<std::size_t>> all;
  for (const ReportedRun& run : runs) {
    if (patterns.empty()) {
      all.push_back(usual(run.columns));
      continue;
    }
    std::vector<std::size_t> chosen;
    for (std::size_t i = 1; i < run.columns.size(); ++i) {
      const auto fits = [&](const std::string& pattern) { return matches(pattern, run.columns[i].name); };
      if (std::ranges::any_of(patterns, fits)) chosen.push_back(i);
    }
    all.push_back(std::move(chosen));
  }
  return all;
}

}  // namespace freeplay
