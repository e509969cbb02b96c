#include "base/processor_quota.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr double none = std::numeric_limits<double>::infinity();

double share(double quota, double period) { return quota > 0.0 && period > 0.0 ? quota / period : none; }

// A group without a quota has "max" or -1 there.
double quota_of(const fs::path& group) {
  double quota = 0.0, period = 0.0;
  if (std::ifstream file(group / "cpu.max"); file >> quota >> period) return share(quota, period);
  std::ifstream old_quota(group / "cpu.cfs_quota_us"), old_period(group / "cpu.cfs_period_us");
  if (old_quota >> quota && old_period >> period) return share(quota, period);
  return none;
}

}  // namespace

// Lines are NUMBER:CONTROLLERS:GROUP; version 2 has no controllers there, version 1 a folder for each list of them.
double processor_quota(const fs::path& groups, const fs::path& mount) {
  double smallest = quota_of(mount);  // of a container that sees its own group alone
  std::ifstream file(groups);
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && ("," + controllers + ",").find(",cpu,") == std::string::npos) continue;
    const fs::path top = mount / controllers;
    for (fs::path group = fs::path(line.substr(second + 1)).relative_path();; group = group.parent_path()) {
      smallest = std::min(smallest, quota_of(top / group));
      if (group.empty()) break;
    }
  }
  return smallest;
}

}  // namespace freeplay
