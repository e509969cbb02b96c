// A pulse of force that a plugin makes of the time, in a registry with everything built in.
#pragma once

#include <cmath>

#include "component/registry.h"
#include "freeplay/plugin.h"

namespace freeplay::test {

/// Force along world x on the second body while it lasts, else none. With s = (t - begin)/duration and by `shape` it is
/// 0: height sin^2(pi s), 1: height, 2: height s. `told`: what the joint says of its time: 0 nothing, 1 its time scale,
/// 2 its corners.
class PulseJoint final : public Joint {
 public:
  explicit PulseJoint(const Parameters& p)
      : height_(p.number("height")),
        begin_(p.number("begin")),
        duration_(p.number("duration")),
        told_(p.integer("told")),
        shape_(p.integer("shape")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.analytic_derivatives = 1;  // it depends on nothing else
    if (told_ == 1) layout.time_scale = duration_;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const double s = (in.t - begin_) / duration_;
    if (s < 0.0 || s > 1.0) return;
    const double wave = std::sin(M_PI * s), force = height_ * (shape_ == 0 ? wave * wave : shape_ == 1 ? 1.0 : s);
    out.wrench_b[0] = force;
    out.wrench_a[0] = -force;
  }
  double next_corner(double t) const override {
    if (told_ != 2) return unbounded;
    return t < begin_ ? begin_ : t < begin_ + duration_ ? begin_ + duration_ : unbounded;
  }

 private:
  double height_, begin_, duration_;
  int told_, shape_;
};

/// Force load(t) along world x on the second body.
class WrittenLoad final : public Joint {
 public:
  explicit WrittenLoad(const Parameters& p) : load_(p.function("load")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.analytic_derivatives = 1;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    out.wrench_b[0] = load_.at(in.t).value;
    out.wrench_a[0] = -out.wrench_b[0];
  }

 private:
  TimeFunction load_;
};

inline Status publish_pulses(const Host* host, Manifest* manifest) noexcept {
  static constexpr Parameter pulse[] = {{.name = "height", .unit = "N"},
                                        {.name = "begin", .unit = "s"},
                                        {.name = "duration", .unit = "s"},
                                        {.name = "told", .kind = ParameterKind::integer, .default_value = 0.0},
                                        {.name = "shape", .kind = ParameterKind::integer, .default_value = 0.0}};
  static constexpr Parameter load[] = {{.name = "load", .kind = ParameterKind::function, .unit = "N"}};
  static const Component components[] = {
      joint<PulseJoint>({.name = "pulse", .space = Space::planar, .parameters = pulse}),
      joint<WrittenLoad>({.name = "written-load", .space = Space::planar, .parameters = load})};
  return publish(*host, *manifest, "pulses", "1", components);
}

/// Built-in types, `pulse` and `written-load`.
inline const Registry& types_with_pulses() {
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add(&publish_pulses, "pulses");
    return all;
  }();
  return registry;
}

}  // namespace freeplay::test
