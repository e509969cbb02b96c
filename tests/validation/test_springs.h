// A spring that exists only in tests, in a registry with everything built in.
#pragma once

#include "component/registry.h"
#include "freeplay/plugin.h"

namespace freeplay::test {

/// Linear spring and damper along the x axis h of the first frame: force on the second body -(k s + d s') h with
/// s = h.(P_b - P_a). Its derivatives are left to the host.
class AxialSpring final : public Joint {
 public:
  explicit AxialSpring(const Parameters& p) : stiffness_(p.number("stiffness")), damping_(p.number("damping")) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
  void apply(const JointInput& in, JointForces& out) const override {
    const double h[2] = {in.a->rotation[0], in.a->rotation[3]};
    double s = 0.0, rate = 0.0;
    for (int i = 0; i < 2; ++i) {
      s += h[i] * (in.b->position[i] - in.a->position[i]);
      rate += h[i] * (in.b->velocity[i] - in.a->velocity[i]);
    }
    const double force = -(stiffness_ * s + damping_ * rate);
    for (int i = 0; i < 2; ++i) {
      out.wrench_b[i] = force * h[i];
      out.wrench_a[i] = -force * h[i];
    }
    out.potential = 0.5 * stiffness_ * s * s;
  }

 private:
  double stiffness_, damping_;
};

inline Status publish_test_springs(const Host* host, Manifest* manifest) noexcept {
  static constexpr Parameter parameters[] = {{.name = "stiffness", .unit = "N/m"},
                                             {.name = "damping", .unit = "N*s/m", .default_value = 0.0}};
  static const Component components[] = {
      joint<AxialSpring>({.name = "axial-spring", .space = Space::planar, .parameters = parameters})};
  return publish(*host, *manifest, "test-springs", "1", components);
}

/// Built-in types and `axial-spring`.
inline const Registry& types_with_springs() {
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add(&publish_test_springs, "test-springs");
    return all;
  }();
  return registry;
}

}  // namespace freeplay::test
