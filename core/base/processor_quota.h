// Processor quota: how many processors a group of processes may use in all.
#pragma once

#include <filesystem>

namespace freeplay {

/// The smallest quota of the groups that a process is in; infinite without one. `groups`: as /proc/self/cgroup;
/// `mount`: where the groups are files, of version 2 or 1.
double processor_quota(const std::filesystem::path& groups = "/proc/self/cgroup",
                       const std::filesystem::path& mount = "/sys/fs/cgroup");

}  // namespace freeplay
