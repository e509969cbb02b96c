#include "system/profile.h"

#include <thread>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

constexpr double pause = 2e-3;  // [s]

void spend() { std::this_thread::sleep_for(std::chrono::duration<double>(pause)); }

TEST(Profile, TimeBelongsToTheInnermostTimer) {
  Profile profile;
  profile.start();
  {
    const Profile::Timer outer(&profile, Phase::assembly);
    spend();
    {
      const Profile::Timer inner(&profile, Phase::joints);
      spend();
      spend();
    }
    spend();
  }
  spend();
  profile.stop();
  EXPECT_GE(profile.seconds(Phase::assembly), 2.0 * pause);
  EXPECT_GE(profile.seconds(Phase::joints), 2.0 * pause);
  EXPECT_GE(profile.seconds(Phase::rest), pause);
  const double sum = profile.seconds(Phase::assembly) + profile.seconds(Phase::joints) + profile.seconds(Phase::rest);
  EXPECT_NEAR(profile.total(), sum, 1e-12);
  EXPECT_EQ(profile.count(Phase::assembly), 1);
  EXPECT_EQ(profile.count(Phase::joints), 1);
}

TEST(Profile, TimeInsideStartOutputAndEventsCountsForThem) {
  for (const Phase whole : {Phase::start, Phase::output, Phase::events}) {
    Profile profile;
    profile.start();
    {
      const Profile::Timer outer(&profile, whole);
      const Profile::Timer inner(&profile, Phase::factorization);
      spend();
    }
    {
      const Profile::Timer after(&profile, Phase::solution);
      spend();
    }
    profile.stop();
    EXPECT_GE(profile.seconds(whole), pause);
    EXPECT_EQ(profile.seconds(Phase::factorization), 0.0);
    EXPECT_EQ(profile.count(Phase::factorization), 1);
    EXPECT_GE(profile.seconds(Phase::solution), pause);
  }
}

}  // namespace
}  // namespace freeplay
