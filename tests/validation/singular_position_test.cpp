// Motions through positions in which the rank of the constraints drops: steps of chosen size go over them.
#include "run_model.h"

namespace freeplay::test {
namespace {

/// The chain A02 of the IFToMM library: parallelograms whose links come into line at 0.71 s and again and again.
struct Chain {
  int windows;
  double end, x, y;  // of the first joint above, from the one equation of the motion in 34 digits
};
constexpr Chain chains[] = {{2, 4.0, 0.11761610237681, 0.99305913845133},
                            {5, 6.0, 0.13471143983036, 0.99088487120292},
                            {10, 10.0, 0.20435356098977, 0.9788971458283}};

ModelRun run_chain(const Chain& chain, const std::string& integrator, double accuracy) {
  BuildOptions options;
  options.accuracy = accuracy;
  options.end = chain.end;
  options.integrator = integrator;
  return ModelRun(
      replaced(mechanism("validation/a02-chain"), "windows: 2", "windows: " + std::to_string(chain.windows)), options,
      {"frame.column1.link/top.x", "frame.column1.link/top.y"});
}

double miss(const ModelRun& run, const Chain& chain) {
  return std::hypot(run.last("frame.column1.link/top.x") - chain.x, run.last("frame.column1.link/top.y") - chain.y);
}

TEST(SingularPosition, ExplicitStepsUnderAnAccuracyGoOverIt) {
  for (const Chain& chain : chains) {
    for (const double accuracy : {1e-6, 1e-8, 1e-10}) {
      const ModelRun run = run_chain(chain, "dopri5", accuracy);
      ASSERT_EQ(run.outcome().status, RunStatus::completed)
          << chain.windows << " " << accuracy << " " << run.outcome().reason;
      // An accuracy is kept per second, and the fall from the upright position stretches errors.
      EXPECT_LE(miss(run, chain), accuracy * chain.end) << chain.windows << " " << accuracy;
      EXPECT_LE(run.outcome().steps, 10000) << chain.windows << " " << accuracy;
    }
  }
}

TEST(SingularPosition, ImplicitStepsUnderAnAccuracyGoOverIt) {
  for (const Chain& chain : chains) {
    for (const char* integrator : {"bathe", "newmark", "hht", "generalized-alpha"}) {
      if (chain.windows == 10 && std::string(integrator) != "bathe") continue;  // for time
      const ModelRun run = run_chain(chain, integrator, 1e-6);
      ASSERT_EQ(run.outcome().status, RunStatus::completed)
          << chain.windows << " " << integrator << " " << run.outcome().reason;
      EXPECT_LE(miss(run, chain), 5e-6) << chain.windows << " " << integrator;
    }
  }
}

// There the mechanism could go on as a parallelogram or crossed: a run that says that it is completed took the former.
TEST(SingularPosition, WhatRoundingWouldDecideIsRefused) {
  for (const Chain& chain : {chains[0], chains[1]}) {
    for (const double accuracy : {1e-11, 3e-12, 1e-12}) {
      const ModelRun run = run_chain(chain, "dopri5", accuracy);
      if (run.outcome().status == RunStatus::completed) {
        EXPECT_LE(miss(run, chain), 1e-10) << chain.windows << " " << accuracy;
      } else {
        EXPECT_EQ(run.outcome().exit_code, 4);
        EXPECT_NE(run.outcome().reason.find("singular position"), std::string::npos) << run.outcome().reason;
        EXPECT_NE(run.outcome().reason.find("joint '"), std::string::npos) << run.outcome().reason;
      }
    }
  }
}

}  // namespace
}  // namespace freeplay::test
