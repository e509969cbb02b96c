// Force elements that go wrong at a given time, for tests.
#pragma once

#include <limits>
#include <stdexcept>

#include "component/registry.h"
#include "freeplay/plugin.h"

namespace freeplay {

/// A friction of which what it remembers decays fast, and moves the body from time `at` on alone.
class FadingMemory final : public Joint {
 public:
  explicit FadingMemory(const Parameters& p) : at_(p.number("at")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.internal_variables = 1;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    out.internal_rate[0] = 1.0 - 1e5 * in.internal[0];
    if (in.t >= at_) out.wrench_b[0] = 1e3 * in.internal[0];
  }
  double next_corner(double t) const override { return t < at_ ? at_ : unbounded; }

 private:
  double at_;
};

/// From time `at` on: throws, fills one of the numbers that it is asked for with one that is not finite, or stores
/// energy that nothing has brought.
class FaultyJoint final : public Joint {
 public:
  explicit FaultyJoint(const Parameters& p) : at_(p.number("at")), fault_(static_cast<Fault>(p.word("fault"))) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.history = 2;
    layout.internal_variables = 1;
    layout.channels = channels;
    layout.events = events_;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    if (in.t < at_) return;
    if (fault_ == throws) throw std::runtime_error("out of order");
    if (fault_ == force) out.wrench_b[0] = not_a_number;
    if (fault_ == leap) out.potential = 1e6;
  }
  double step_limit(const JointInput& in) const override {
    return in.t >= at_ && fault_ == limit ? not_a_number : unbounded;
  }
  void begin_step(const JointInput& in, const MarkerAccelerations&, double, Span<double> history) const override {
    if (in.t >= at_ && fault_ == step) history[1] = not_a_number;
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    if (in.t >= at_ && fault_ == committed) history[0] = unbounded;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    g[0] = in.t - at_ - 1e-4;
    rate[0] = in.t >= at_ && fault_ == event_rate ? not_a_number : 1.0;
    if (in.t >= at_ && fault_ == event_value) g[0] = unbounded;
  }
  void on_event(int, const JointInput&, Span<double> z, Span<double>, Span<double> fields) const override {
    if (fault_ == internal) z[0] = not_a_number;
    if (fault_ == field) fields[0] = unbounded;
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    values[0] = 1.0;
    values[1] = in.t >= at_ && fault_ == channel ? not_a_number : 2.0;
  }

 private:
  enum Fault { throws, force, step, committed, event_rate, event_value, internal, field, channel, leap, limit };
  static constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  static constexpr Channel channels[] = {{"wear", "1"}, {"heat", "J"}}, fields_[] = {{"size", "m"}};
  static constexpr Event events_[] = {{"alarm", Crossing::rising, 0, fields_}};
  double at_;
  Fault fault_;
};

inline const Registry& types_with_faulty_joint() {
  static constexpr Parameter parameters[] = {
      {.name = "at", .unit = "s"},
      {.name = "fault",
       .kind = ParameterKind::choice,
       .default_value = 0,
       .choices = "throw|nan|step|commit|event-rate|event-value|internal|field|channel|leap|limit"}};
  static constexpr Parameter time[] = {{.name = "at", .unit = "s"}};
  static const Component components[] = {
      joint<FaultyJoint>({.name = "faulty", .space = Space::planar, .parameters = parameters}),
      joint<FadingMemory>({.name = "fading", .space = Space::planar, .parameters = time})};
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
