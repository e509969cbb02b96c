#include "base/processor_quota.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

class ProcessorQuota : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) {
    const fs::path path = folder_.path() / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  double quota() const { return processor_quota(folder_.path() / "cgroup", folder_.path() / "mount"); }

  ScratchFolder folder_;
};

TEST_F(ProcessorQuota, IsInfiniteWithoutGroups) {
  EXPECT_TRUE(std::isinf(quota()));
  put("cgroup", "0::/\n");
  put("mount/cpu.max", "max 100000\n");
  EXPECT_TRUE(std::isinf(quota()));
}

TEST_F(ProcessorQuota, IsTheSmallestOfAGroupAndThoseAboveIt) {
  put("cgroup", "0::/job/step\n");
  put("mount/job/cpu.max", "150000 100000\n");
  put("mount/job/step/cpu.max", "max 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 1.5);
  put("mount/job/step/cpu.max", "50000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 0.5);
}

TEST_F(ProcessorQuota, OfVersionOneIsThatOfTheControllerOfProcessors) {
  put("cgroup", "3:cpuset:/job\n2:cpu,cpuacct:/job\n1:name=systemd:/job\n");
  put("mount/cpu,cpuacct/job/cpu.cfs_quota_us", "-1\n");
  put("mount/cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  EXPECT_TRUE(std::isinf(quota()));
  put("mount/cpu,cpuacct/job/cpu.cfs_quota_us", "300000\n");
  EXPECT_DOUBLE_EQ(quota(), 3.0);
}

TEST_F(ProcessorQuota, OfAContainerThatSeesItsOwnGroupAloneIsAtTheTop) {
  put("cgroup", "0::/of/the/host\n");
  put("mount/cpu.max", "200000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2.0);
}

}  // namespace
}  // namespace freeplay
