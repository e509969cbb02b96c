// A force that code of a joint makes of the position, over in less time than a step of an accuracy takes.
#include <cmath>
#include <string>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;

/// A push along x of the second body while it is within `width` of a place.
class ShortPush final : public Joint {
 public:
  explicit ShortPush(const Parameters& p) : force_(p.number("force")), place_(0.303), width_(p.number("width")) {}
  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.forces = 1;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const double off = (in.b->position[0] - place_) / width_;
    const double force = std::abs(off) < 1.0 ? force_ * std::pow(1.0 - off * off, 3) : 0.0;
    out.wrench_b[0] = force;
    out.wrench_a[0] = -force;
    out.wrench_a[5] = -in.b->position[1] * force;
  }

 private:
  double force_, place_, width_;
};

ModelRun slide_past(const std::string& push, const std::string& settings) {
  static constexpr Parameter parameters[] = {{.name = "force", .unit = "N"}, {.name = "width", .unit = "m"}};
  static const Component components[] = {
      joint<ShortPush>({.name = "short-push", .space = Space::planar, .parameters = parameters})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "push", "1", components); },
            "test");
    return all;
  }();
  return ModelRun(
      "freeplay: 1\ngravity: [0, 0]\nbodies: {block: {mass: 1, inertia: 1e-3}}\n"
      "joints:\n  slide: {type: prismatic, between: [ground, block]}\n"
      "  push: {type: short-push, between: [ground, block], " +
          push +
          "}\n"
          "initial: {speeds: {slide: 0.5}}\nsimulation: {end: 2 s, output: {interval: 1 ms}, " +
          settings + "}\n",
      {}, {}, registry);
}

const TrustReason* missed(const ModelRun& run) {
  for (const TrustReason& doubt : run.outcome().doubts) {
    if (doubt.id == "unresolved-input") return &doubt;
  }
  return nullptr;
}

// Its rows show the force, and the motion none: the speed that is left says which of the two holds.
TEST(MissedForces, OfARowInsideAStepAreDoubted) {
  for (const char* push : {"force: 0.5, width: 1e-3", "force: 50, width: 1e-3", "force: 50, width: 5e-3"}) {
    for (const char* integrator : {"dopri5", "verner6", "verner7", "arkode"}) {
      const ModelRun run = slide_past(push, std::string("accuracy: 1e-6, integrator: ") + integrator);
      ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
      const bool moved = run.last("body.block.vx") > 0.5005;
      const TrustReason* doubt = missed(run);
      EXPECT_NE(moved, doubt != nullptr) << push << ' ' << integrator;
      if (doubt == nullptr) continue;
      EXPECT_EQ(doubt->element, "block");
      EXPECT_GT(doubt->value, doubt->limit);
    }
  }
}

TEST(MissedForces, AreNoneWhereStepsResolveThem) {
  EXPECT_EQ(missed(slide_past("force: 50, width: 1e-3", "step: 0.02 ms")), nullptr);
  EXPECT_EQ(missed(slide_past("force: 0.5, width: 0.4", "accuracy: 1e-6")), nullptr);
}

}  // namespace
}  // namespace freeplay
