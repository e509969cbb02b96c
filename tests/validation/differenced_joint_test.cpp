// Joints that give no derivatives: the host differences them, in every integrator.
#include <gtest/gtest.h>

#include "run_model.h"

namespace freeplay {
namespace {

/// The built-in pin with play without its derivatives.
const abi::JointTable& built_in() {
  return *static_cast<const abi::JointTable*>(
      test::builtin_types().find(ComponentKind::joint, "revolute-clearance")->table);
}

Status publish_differenced(const Host* host, Manifest* manifest) noexcept {
  static abi::JointTable table = built_in();
  table.declare = [](const void* self, JointLayout* layout, Message* message) noexcept {
    const Status status = built_in().declare(self, layout, message);
    layout->analytic_derivatives = 0;
    return status;
  };
  static Component component = *test::builtin_types().find(ComponentKind::joint, "revolute-clearance");
  component.table = &table;
  component.description.name = "differenced-play";
  component.description.block = "differenced";
  return publish(*host, *manifest, "differenced", "1", {&component, 1});
}

Registry differenced() {
  Registry registry = Registry::with_builtins();
  registry.add(publish_differenced, "differenced");
  return registry;
}

std::string rotor(const std::string& type, const std::string& settings) {
  return "freeplay: 1\ngravity: [0, -9.81]\nbodies: {rod: {mass: 1 kg, inertia: 0.01, com: [0, -0.1], pose: {angle: 30 "
         "deg}}}\njoints:\n"
         "  pin: {type: " +
         type +
         ", between: [ground, rod], clearance: {bearing_radius: 10 mm, radial_clearance: 0.05 mm, contact: {law: "
         "flores, "
         "K: 1e10, restitution: 0.7}, friction: {law: lugre, mu_s: 0.3, mu_k: 0.2, v_stribeck: 0.01, sigma0: 1e5, "
         "sigma1: "
         "10}}}\nsimulation: {end: 50 ms, " +
         settings + "}\n";
}

TEST(DifferencedJoint, WithFrictionThatHasMemoryRunsInEveryIntegratorAsWithDerivatives) {
  const Registry registry = differenced();
  int integrators = 0;
  for (const std::string& name : registry.names(ComponentKind::integrator)) {
    if (name == "arkode") continue;  // not in every build
    for (const std::string step : {"accuracy: 1 um", "step: 5 us"}) {
      SCOPED_TRACE(name + " " + step);
      const std::string settings = "integrator: " + name + ", " + step;
      const test::ModelRun own(rotor("revolute-clearance", settings), {}, {});
      const test::ModelRun run(rotor("differenced-play", settings), {}, {}, registry);
      ASSERT_EQ(run.model().joints[0].layout.analytic_derivatives, 0u);
      EXPECT_EQ(own.outcome().status, RunStatus::completed) << own.outcome().reason;
      EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
      // Derivatives that were wrong would cost iterations.
      EXPECT_LE(static_cast<double>(run.outcome().iterations),
                1.001 * static_cast<double>(own.outcome().iterations) + 2.0);
      EXPECT_EQ(run.outcome().events, own.outcome().events);
      EXPECT_GT(run.outcome().events, 4);
      ++integrators;
    }
  }
  EXPECT_GE(integrators, 14);
}

}  // namespace
}  // namespace freeplay
