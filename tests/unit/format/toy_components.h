// Toy components, so that the model is tested against tables of its own and not against the library's.
#pragma once

#include "freeplay/plugin.h"

namespace freeplay::toy {

class Pin final : public Joint {
 public:
  explicit Pin(const Parameters&) {}
  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::angle;
    layout.constraint_rows = 2;
    layout.pin = 1;
  }
};

class Slide final : public Joint {
 public:
  explicit Slide(const Parameters&) {}
  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::position;
    layout.constraint_rows = 2;
  }
};

/// A constraint without a coordinate; `load` is a function of time.
class Rod final : public Joint {
 public:
  explicit Rod(const Parameters& p) : load_(p.given("load") ? p.function("load").at(2.0).rate : 0.0) {}
  void declare(JointLayout& layout) const override {
    layout.constraint_rows = 1;
    layout.clearance = load_;
  }

 private:
  double load_;
};

class LoosePin final : public Joint {
 public:
  explicit LoosePin(const Parameters& p) : gap_(p.number("play.gap")) {
    if (p.number("play.limit") < gap_) throw BadParameter("play.limit", "out-of-range", "'limit' is below 'gap'");
    const double nan = optional;
    law_ = p.contact_law("play.contact", {nan, nan, gap_, nan, {nan, nan}, {nan, nan}});
    friction_ = p.friction_law("play.friction");
  }
  void declare(JointLayout& layout) const override { layout.clearance = gap_; }

 private:
  double gap_;
  ContactLawRef law_;
  FrictionLawRef friction_;
};

/// A force without rows; the word chooses the unit.
class Spring final : public Joint {
 public:
  explicit Spring(const Parameters&) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
};

class Ball final : public Joint {
 public:
  explicit Ball(const Parameters&) {}
  void declare(JointLayout&) const override {}
};

/// K d^n; a soft one is refused, to show how the fault of a law finds its place.
class Power final : public ContactLaw {
 public:
  Power(const Parameters& p, const ContactPair&) : stiffness_(p.number("K")) {
    if (p.number("soft") > 0.0) throw BadParameter("soft", "conflicting-keys", "'soft' is for nobody");
    if (stiffness_ == 13e9) throw BadParameter("", "missing-key", "the law needs luck");
    if (stiffness_ == 14.0) throw std::runtime_error("broken inside");
  }
  ContactForce evaluate(const ContactState& s) const override { return {stiffness_ * s.penetration, 0, 0, 0}; }

 private:
  double stiffness_;
};

class Slippery final : public FrictionLaw {
 public:
  explicit Slippery(const Parameters&) {}
  FrictionForce evaluate(const FrictionState&, Span<double>) const override { return {}; }
};

class Stepper final : public Integrator {
 public:
  explicit Stepper(const Parameters& p) : order_(p.word("split") == 0 ? 2 : 1) {}
  void declare(IntegratorLayout& layout) const override { layout.order = order_; }
  Attempt attempt(double, StateView&, Span<double>, StageSolver&) const override { return {1, 0.0}; }

 private:
  int order_;
};

inline constexpr Parameter loose_pin_parameters[] = {
    {.name = "play.gap", .unit = "m", .minimum = 0.0, .open = Open::minimum},
    {.name = "play.limit", .unit = "m", .default_value = optional},
    {.name = "play.material.E", .unit = "Pa", .default_value = optional, .minimum = 0.0, .open = Open::minimum},
    {.name = "play.material.nu", .default_value = 0.3, .minimum = 0.0, .maximum = 0.5, .open = Open::maximum},
    {.name = "play.contact", .kind = ParameterKind::contact_law},
    {.name = "play.friction", .kind = ParameterKind::friction_law, .default_value = optional},
    {.name = "play.initial", .kind = ParameterKind::choice, .default_value = 0, .choices = "centered|loaded"},
    {.name = "play.initial.eccentricity", .kind = ParameterKind::vector, .unit = "m", .default_value = optional},
};
inline constexpr Parameter rod_parameters[] = {
    {.name = "length", .unit = "mm", .default_value = 20.0, .minimum = 10.0, .open = Open::minimum},
    {.name = "load", .kind = ParameterKind::function, .unit = "N", .default_value = optional},
};
inline constexpr Parameter spring_parameters[] = {
    {.name = "stiffness", .unit = "kind: N/m | N*m/rad", .default_value = 0.0},
    {.name = "kind", .kind = ParameterKind::choice, .default_value = 0, .choices = "pull|twist"},
};
inline constexpr Parameter power_parameters[] = {
    {.name = "K", .unit = "N/m^exponent", .minimum = 0.0, .open = Open::minimum},
    {.name = "exponent", .default_value = 1.5, .minimum = 1.0, .maximum = 3.0},
    {.name = "soft", .default_value = 0.0},
};
inline constexpr Parameter stepper_parameters[] = {
    {.name = "split", .default_value = 0.5, .minimum = 0.0, .maximum = 1.0, .open = Open::both, .choices = "optimal"},
    newton_iterations_parameter,
    newton_tolerance_parameter,
};

inline Status publish_toys(const Host* host, Manifest* manifest) noexcept {
  static const Component components[] = {
      joint<Pin>({.name = "pin", .space = Space::planar, .first_end = "ring", .second_end = "shaft"}),
      joint<Slide>({.name = "slide", .space = Space::planar}),
      joint<Rod>({.name = "rod", .parameters = rod_parameters}),
      joint<Spring>({.name = "spring", .parameters = spring_parameters}),
      joint<LoosePin>({.name = "loose-pin",
                       .space = Space::planar,
                       .parameters = loose_pin_parameters,
                       .ideal = "pin",
                       .block = "play",
                       .first_end = "ring",
                       .second_end = "shaft"}),
      joint<Ball>({.name = "ball", .space = Space::spatial}),
      contact_law<Power>({.name = "power", .parameters = power_parameters}),
      friction_law<Slippery>({.name = "slippery", .preferred = 1}),
      integrator<Stepper>({.name = "stepper", .parameters = stepper_parameters, .preferred = 1}),
      integrator<Stepper>({.name = "stumbler", .parameters = stepper_parameters}),
  };
  return publish(*host, *manifest, "toys", "1", components);
}

}  // namespace freeplay::toy
