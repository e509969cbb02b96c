// Force elements that go wrong at a given time, for tests.
#pragma once

#include <limits>
#include <stdexcept>

#include "component/registry.h"
#include "freeplay/plugin.h"

namespace freeplay {

/// From time `at` on: throws, or gives a force that is not a number.
class FaultyJoint final : public Joint {
 public:
  explicit FaultyJoint(const Parameters& p) : at_(p.number("at")), throws_(p.word("fault") == 0) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
  void apply(const JointInput& in, JointForces& out) const override {
    if (in.t < at_) return;
    if (throws_) throw std::runtime_error("out of order");
    out.wrench_b[0] = std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double at_;
  bool throws_;
};

inline const Registry& types_with_faulty_joint() {
  static constexpr Parameter parameters[] = {
      {.name = "at", .unit = "s"},
      {.name = "fault", .kind = ParameterKind::choice, .default_value = 0, .choices = "throw|nan"}};
  static const Component components[] = {
      joint<FaultyJoint>({.name = "faulty", .space = Space::planar, .parameters = parameters})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "faulty", "1", components); },
            "test");
    return all;
  }();
  return registry;
}

}  // namespace freeplay
