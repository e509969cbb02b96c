// A stop whose second event has the wrong direction: it happens at once, and makes the first possible again.
#include <cmath>
#include <limits>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double close_by = 1e-4;  // where it asks for short steps [m]

constexpr Parameter parameters[] = {
    {.name = "gap", .unit = "m", .summary = "Free way."},
    {.name = "step", .unit = "s", .default_value = 1.0, .summary = "Longest sensible one at the stop."}};
constexpr Event events_of_stop[] = {{"stop_begin", Crossing::rising, 1, {}}, {"stop_end", Crossing::rising, 1, {}}};

/// At x = gap of the ground; history[0] says whether it is touched.
class EndlessStop : public Joint {
 public:
  explicit EndlessStop(const Parameters& p) : gap_(p.number("gap")), step_(p.number("step")) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.history = 1;
    layout.events = events_of_stop;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const double depth = in.b->position[0] - gap_, force = in.history[0] != 0.0 ? 1e5 * depth : 0.0;
    out.wrench_a[0] = force, out.wrench_b[0] = -force;
    out.wrench_a[5] = -in.b->position[1] * force;
    out.potential = 0.5 * force * depth;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const bool touched = in.history[0] != 0.0;
    const double depth = in.b->position[0] - gap_;
    g[0] = touched ? not_a_number : depth;
    g[1] = touched ? depth : not_a_number;
    rate[0] = rate[1] = in.b->velocity[0];
  }
  void on_event(int index, const JointInput&, Span<double>, Span<double> history, Span<double>) const override {
    history[0] = index == 0 ? 1.0 : 0.0;
  }
  double step_limit(const JointInput& in) const override {
    return std::abs(in.b->position[0] - gap_) < close_by ? step_ : unbounded;
  }

 private:
  double gap_, step_;
};

constexpr Event backward_events[] = {{"contact_begin", Crossing::falling, 1, {}},
                                     {"contact_end", Crossing::falling, 1, {}}};

/// The same with a first event of the wrong direction.
class BackwardStop final : public EndlessStop {
 public:
  using EndlessStop::EndlessStop;
  void declare(JointLayout& layout) const override {
    EndlessStop::declare(layout);
    layout.events = backward_events;
  }
};

}  // namespace

FREEPLAY_PLUGIN(endless_events) {
  static const Component components[] = {joint<EndlessStop>({.name = "endless-stop",
                                                             .space = Space::planar,
                                                             .summary = "Stop whose events do not end.",
                                                             .parameters = parameters}),
                                         joint<BackwardStop>({.name = "backward-stop",
                                                              .space = Space::planar,
                                                              .summary = "Stop whose contact begins backwards.",
                                                              .parameters = parameters})};
  return publish(*host, *manifest, "endless_events", "1", components);
}
