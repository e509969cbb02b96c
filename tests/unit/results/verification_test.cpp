// What a second and a third run say about the first.
#include "results/verification.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

const double no_value = std::nan("");

/// Rows of 10 s, ten in each second.
ResultTable moving(const std::function<double(double)>& x) {
  ResultTable t{{"time", "body.a.x"}, {{}, {}}};
  for (int i = 0; i <= 100; ++i) {
    t.values[0].push_back(0.1 * i);
    t.values[1].push_back(x(0.1 * i));
  }
  return t;
}

VerificationRules rules(double limit, bool fixed = false) { return {{{"body.a.x"}}, limit, fixed}; }

Agreement judged(const ResultTable& first, const ResultTable& second, const ResultTable& third,
                 const VerificationRules& by) {
  const RunResult a{&first, {}}, b{&second, {}}, c{&third, {}};
  Verification v = compare_runs(a, b, by);
  if (v.agreement != Agreement::agree) judge(v, a, b, c, by);
  return v.agreement;
}

double smooth_motion(double t) { return std::sin(t); }

TEST(Verification, ErrorsAreOfTheTimeOfAgreementAndStatisticsOfTheRest) {
  const ResultTable a{{"time", "body.a.x", "body.a.y"}, {{0, 1, 2, 3}, {0, 0, 3, -4}, {1, 1, 1, 1}}};
  const ResultTable b{{"time", "body.a.x", "body.a.y"}, {{0, 1, 2, 3}, {0, 0.1, -3, 4}, {1, 1.5, 2, 2}}};
  const Verification v = compare_runs({&a, {}}, {&b, {}}, rules(0.2));
  EXPECT_EQ(v.agree_until, 1.0);
  EXPECT_EQ(v.agreement, Agreement::err);
  EXPECT_EQ(v.largest, 8.0);
  EXPECT_EQ(v.at, 3.0);
  ASSERT_EQ(v.channels.size(), 2u);
  EXPECT_EQ(v.channels[0].error, 0.1);
  EXPECT_EQ(v.channels[1].error, 0.5);
  EXPECT_NEAR(v.channels[0].rms, std::sqrt(12.5), 1e-15);
  EXPECT_NEAR(v.channels[0].second_rms, std::sqrt(12.5), 1e-15);
  EXPECT_EQ(v.channels[1].second_largest, 2.0);
}

// An accuracy is promised for each second.
TEST(Verification, RunsThatDriftByLessThanTheLimitInEachSecondAgree) {
  const ResultTable a = moving(smooth_motion), b = moving([](double t) { return smooth_motion(t) + 0.9e-6 * t; });
  EXPECT_EQ(compare_runs({&a, {}}, {&b, {}}, rules(1e-6)).agreement, Agreement::agree);
  EXPECT_EQ(compare_runs({&a, {}}, {&b, {}}, rules(0.5e-6)).agreement, Agreement::err);
}

TEST(Verification, TurnsCountAtTheRadiusOfGyration) {
  ResultTable a = moving(smooth_motion), b = moving([](double t) { return smooth_motion(t) + 4e-6; });
  a.names[1] = b.names[1] = "body.a.angle";
  VerificationRules turning;
  turning.limit = 1e-6;
  turning.positions = {{"body.a.angle", 0.2}};
  EXPECT_EQ(compare_runs({&a, {}}, {&b, {}}, turning).agreement, Agreement::agree);
  turning.positions = {{"body.a.angle", 0.3}};
  const Verification v = compare_runs({&a, {}}, {&b, {}}, turning);
  EXPECT_EQ(v.agreement, Agreement::err);
  EXPECT_NEAR(v.largest, 1.2e-6, 1e-12);
}

TEST(Verification, ARunThatOverlookedALoadDisagrees) {
  const ResultTable blind = moving([](double) { return 0.0; });
  const ResultTable second = moving([](double t) { return std::max(0.0, t - 0.5); });
  const ResultTable third = moving([](double t) { return std::max(0.0, t - 0.5) * (1.0 + 1e-6); });
  EXPECT_EQ(judged(blind, second, third, rules(1e-6)), Agreement::disagree);
  EXPECT_EQ(judged(blind, second, third, rules(1e-6, true)), Agreement::disagree);
}

TEST(Verification, AChaoticMotionPartsAndDoesNotDisagree) {
  const auto parted = [](double error) {
    return moving([=](double t) { return smooth_motion(t) + std::min(error * std::exp(3.0 * t), 0.3); });
  };
  EXPECT_EQ(judged(moving(smooth_motion), parted(1e-7), parted(4e-7), rules(1e-6)), Agreement::part);
  // Fixed steps err more from the first on.
  EXPECT_EQ(judged(parted(1e-5), moving(smooth_motion), parted(1e-7), rules(1e-6, true)), Agreement::part);
}

// A pendulum by a method that keeps less than it should.
TEST(Verification, ASmoothMotionWithALargerErrorErrs) {
  const auto late = [](double by) { return moving([=](double t) { return smooth_motion(t + by * t); }); };
  EXPECT_EQ(judged(late(8e-6), late(0.0), late(1e-6), rules(1e-6)), Agreement::err);
  EXPECT_EQ(judged(late(1e-4), late(0.0), late(1e-8), rules(1e-6, true)), Agreement::err);
  EXPECT_EQ(judged(late(1e-2), late(0.0), late(1e-8), rules(1e-6, true)), Agreement::disagree);
}

TEST(Verification, PeaksDecideWherePositionsDoNot) {
  const ResultTable rows = moving(smooth_motion);
  const auto force = [&](double value, double other) {
    return RunResult{&rows, {{"joint B max |F|", value}, {"joint C max |F|", other}, {"path P max error", no_value}}};
  };
  const auto judged_peaks = [&](double first, double second, double third) {
    const RunResult a = force(first, 1e-9), b = force(second, 2e-9), c = force(third, 1e-9);
    Verification v = compare_runs(a, b, rules(1e-6));
    if (v.agreement != Agreement::agree) judge(v, a, b, c, rules(1e-6));
    return v.agreement;
  };
  EXPECT_EQ(judged_peaks(5017.0, 5010.0, 5000.0), Agreement::agree);
  EXPECT_EQ(judged_peaks(32.9, 5017.0, 5000.0), Agreement::disagree);
  EXPECT_EQ(judged_peaks(32.9, 5017.0, 3000.0), Agreement::err);
}

// Steps that follow a vibration, and a method that damps it, have other peaks of it at positions that agree.
TEST(Verification, ALargestValueThatIsOffByAFifthIsDoubtfulAndAMeanDisagrees) {
  const ResultTable rows = moving(smooth_motion);
  const auto judged_figure = [&](const char* name, double first, double second) {
    const RunResult a{&rows, {{name, first}}}, b{&rows, {{name, second}}};
    Verification v = compare_runs(a, b, rules(1e-6));
    if (v.agreement != Agreement::agree) judge(v, a, b, b, rules(1e-6));
    return v.agreement;
  };
  EXPECT_EQ(judged_figure("joint B max |F|", 8.7, 7.0), Agreement::err);
  EXPECT_EQ(judged_figure("joint B max |F|", 8.7, 4.0), Agreement::disagree);
  EXPECT_EQ(judged_figure("joint B rms |F|", 8.7, 7.0), Agreement::disagree);
}

TEST(Verification, LengthsThatPositionsMayErrByAndForcesOfRoundingAreNone) {
  const ResultTable rows = moving(smooth_motion);
  const auto agree = [&](const char* name, double value) {
    VerificationRules by = rules(1e-6);
    by.size = 0.5, by.energy = 2.0, by.length = 3e-6;
    const RunResult a{&rows, {{name, value}}}, b{&rows, {{name, 1.4 * value}}};
    return compare_runs(a, b, by).agreement == Agreement::agree;
  };
  EXPECT_TRUE(agree("path P max error", 3.5e-15));
  EXPECT_TRUE(agree("path P max error", 2e-6));
  EXPECT_FALSE(agree("path P max error", 2e-5));
  EXPECT_TRUE(agree("joint B max delta", 1e-8));
  EXPECT_FALSE(agree("joint B max delta", 2e-5));
  EXPECT_TRUE(agree("joint B rms |F|", 1e-9));
  EXPECT_FALSE(agree("joint B rms |F|", 1e-7));
  EXPECT_TRUE(agree("driver d max |torque|", 1e-9));
  EXPECT_FALSE(agree("driver d max |torque|", 1e-7));
}

// A parallelogram at constant speed: its driver holds the difference of torques that cancel.
// A load on a driven mechanism moves nothing elsewhere. What comes and goes leaves no work, whatever is left of it.
TEST(Verification, WorkCountsWhereItIsPartOfTheEnergyThatWasMoved) {
  const ResultTable rows = moving(smooth_motion);
  const auto with = [&](double work, double rms) {
    return RunResult{&rows, {{"force press work", work}, {"driver d rms |force|", rms}}};
  };
  VerificationRules by = rules(1e-6);
  by.energy = 1.0;
  const RunResult sees = with(-0.5, 100.0), blind = with(0.0, 100.0), steadier = with(-0.5, 80.0);
  for (const RunResult* other : {&blind, &steadier}) {
    Verification v = compare_runs(*other, sees, by);
    EXPECT_EQ(v.agreement, Agreement::err);
    judge(v, *other, sees, sees, by);
    EXPECT_EQ(v.agreement, Agreement::disagree);
  }
  by.energy = 100.0;
  EXPECT_EQ(compare_runs(blind, sees, by).agreement, Agreement::agree);
}

TEST(Verification, ATorqueThatForcesHaveByNoLeverIsNone) {
  const ResultTable rows = moving(smooth_motion);
  const auto agree = [&](double force, double torque) {
    const auto run = [&](double value) {
      return RunResult{&rows, {{"joint A max |F|", force}, {"driver m max |torque|", value}}};
    };
    VerificationRules of_model = rules(1e-6);
    of_model.size = 0.2;
    return compare_runs(run(0.03 * torque), run(torque), of_model).agreement == Agreement::agree;
  };
  EXPECT_TRUE(agree(0.12, 2.7e-8));
  EXPECT_FALSE(agree(0.12, 2.7e-6));
  EXPECT_FALSE(agree(0.0, 2.7e-8));
}

}  // namespace
}  // namespace freeplay
