#include <algorithm>
#include <array>

#include "base/name_pattern.h"
#include "study/point_reducers.h"

namespace freeplay {
namespace {

constexpr std::array<ClearanceNumber, 8> numbers = {{
    {"max_force", "N", [](const JointStatistics& seen) { return seen.max_force; }},
    {"rms_force", "N", [](const JointStatistics& seen) { return seen.rms_force; }},
    {"max_fn", "N", [](const JointStatistics& seen) { return seen.max_normal_force; }},
    {"max_delta", "m", [](const JointStatistics& seen) { return seen.max_penetration; }},
    {"max_eccentricity", "m", [](const JointStatistics& seen) { return seen.max_eccentricity; }},
    {"contacts", "1", [](const JointStatistics& seen) { return static_cast<double>(seen.contacts); }},
    {"contact_fraction", "1", [](const JointStatistics& seen) { return seen.contact_fraction; }},
    {"dissipated", "J", [](const JointStatistics& seen) { return seen.dissipated; }},
}};

/// Names of joints with play that fit, in the order of the models, each once.
std::vector<std::string> joints_with_play(const std::string& pattern, std::span<const Model* const> models) {
  std::vector<std::string> names;
  for (const Model* model : models) {
    for (const JointElement& joint : model->joints) {
      if (!joint.has_play || !matches(pattern, joint.name)) continue;
      if (std::ranges::find(names, joint.name) == names.end()) names.push_back(joint.name);
    }
  }
  return names;
}

}  // namespace

std::span<const ClearanceNumber> clearance_numbers() { return numbers; }

ReducerColumns::ReducerColumns(std::span<const ReducerEntry> entries, std::span<const Model* const> models) {
  for (const ReducerEntry& entry : entries) {
    first_.push_back(all_.size());
    list_.push_back(samples_.size());
    if (entry.source != ReducerEntry::Source::set) {
      if (entry.section) samples_.push_back({entry.name, "1"});
      all_.push_back({entry.name, "1"});
      continue;
    }
    for (const std::string& joint : joints_with_play(entry.text(), models)) {
      for (const ClearanceNumber& number : numbers)
        all_.push_back({entry.name + "." + joint + "." + number.name, number.unit});
    }
    if (first_.back() == all_.size() && !models.empty())
      entry.subject.fail("unknown-name", "no joint with play fits '" + entry.text() + "'");
  }
  for (std::size_t i = 0; i < all_.size(); ++i) by_name_.emplace(all_[i].name, static_cast<int>(i));
}

int ReducerColumns::find(std::string_view name) const {
  const auto found = by_name_.find(std::string(name));
  return found == by_name_.end() ? -1 : found->second;
}

}  // namespace freeplay
