#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "axis_contacts.h"
#include "freeplay/kit/contact_events.h"

namespace freeplay {
namespace {

/// Stops at both ends of a joint's way. With d how far the coordinate s is beyond an end and d' its rate:
///   E = k d (1 + a d') outwards, not below 0 (no stop pulls)        stored: k d^2/2
/// The damping grows with d, so that the effort is continuous. Hunt and Crossley 1975 with exponent 1.
class Stops {
 public:
  explicit Stops(const Parameters& p)
      : lower_(p.number("lower")),
        upper_(p.number("upper")),
        stiffness_(p.number("stiffness")),
        damping_(p.number("damping")) {
    if (lower_ > upper_) throw BadParameter("lower", "out-of-range", "'lower' must not be above 'upper'");
  }

  template <class T>
  T effort(const T& s, const T& rate) const {
    const double side = beyond(space::value_of(s)), d = depth(space::value_of(s));
    const double growth = 1.0 + damping_ * side * space::value_of(rate);
    if (d == 0.0 || growth <= 0.0) return T(0.0);
    return space::chained(side * stiffness_ * d * growth, stiffness_ * growth, s, stiffness_ * d * damping_, rate);
  }
  double stored(double s) const { return 0.5 * stiffness_ * depth(s) * depth(s); }
  double stored_rate(double s, double rate) const { return stiffness_ * depth(s) * beyond(s) * rate; }
  double lowest() const { return lower_; }
  double highest() const { return upper_; }
  const char* doubt(double s, bool slides) const {
    const double d = depth(s), way = upper_ - lower_;
    const bool far = (way > 0.0 && d > most_ways * way) || (!slides && d > most_turn);
    return far ? "The joint is far beyond the end of its way: something moves it through its stop, it starts there, or "
                 "the stop is too soft."
               : nullptr;
  }

 private:
  // How far beyond an end no stop yields: by the way between the two ends, and of turns.
  static constexpr double most_ways = 0.25;
  static constexpr double most_turn = std::numbers::pi / 2.0;  // [rad]

  /// 1 beyond the upper end, -1 beyond the lower.
  double beyond(double s) const { return s > upper_ ? 1.0 : -1.0; }
  double depth(double s) const { return s > upper_ ? s - upper_ : s < lower_ ? lower_ - s : 0.0; }

  double lower_, upper_, stiffness_, damping_;
};

constexpr const char* end_events[] = {"upper_contact_begin", "upper_contact_end", "lower_contact_begin",
                                      "lower_contact_end"};
constexpr auto all_end_events = play::contact_events(end_events);
constexpr auto all_end_roles = play::contact_event_roles<all_end_events.size()>();

constexpr Channel end_channels[] = {{"delta", "m"},         {"fn", "N"},       {"ft", "N"},
                                    {"contact_power", "W"}, {"contact", "1"},  {"vt", "m/s"},
                                    {"upper_delta", "m"},   {"upper_fn", "N"}, {"upper_ft", "N"},
                                    {"lower_delta", "m"},   {"lower_fn", "N"}, {"lower_ft", "N"}};
constexpr ChannelRole end_roles[] = {ChannelRole::penetration, ChannelRole::normal_force, ChannelRole::friction_force,
                                     ChannelRole::none,        ChannelRole::in_contact,   ChannelRole::slip_speed,
                                     ChannelRole::none,        ChannelRole::none,         ChannelRole::none,
                                     ChannelRole::none,        ChannelRole::none,         ChannelRole::none};

/// Stops by a law of contact: each end by itself, with phase, approach speed and events as in a joint with play. With
/// the lever r, 1 of a slide, and F_N the law's force
///   delta = r (s - upper)  and  r (lower - s),     effort back r F_N(delta, delta')
template <bool slides>
class ContactStops final : public play::Contacts<play::WayEnds<slides>, play::AlongAxis<slides>> {
  using Base = play::Contacts<play::WayEnds<slides>, play::AlongAxis<slides>>;

 public:
  explicit ContactStops(const play::WayEnds<slides>& ends, const ContactLawRef& law) : Base(ends, {law}) {}

  void declare(JointLayout& layout) const override {
    Base::declare_contacts(layout);
    layout.clearance = 0.0;  // it holds nothing together
    layout.coordinate = slides ? Coordinate::position : Coordinate::angle;
    layout.lowest = Base::geometry().lower;
    layout.highest = Base::geometry().upper;
    layout.forces_without_coordinate = slides ? 1 : 0;
    layout.events = {all_end_events.data(), all_end_events.size()};
    layout.event_roles = {all_end_roles.data(), all_end_roles.size()};
    layout.channels = end_channels;
    layout.channel_roles = end_roles;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if constexpr (slides) {
      space::Separation(in).write_coordinate(space::axis(*in.a, 0), row);
    } else {
      space::AngleAboutZ(in).write(row);
    }
  }
};

/// One of the two, as the file says.
class JointStop final : public Joint {
 public:
  explicit JointStop(const Parameters& p) : stop_(made(p)) {}

  void declare(JointLayout& layout) const override { stop_->declare(layout); }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { stop_->coordinate(in, row); }
  void apply(const JointInput& in, JointForces& out) const override { stop_->apply(in, out); }
  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    stop_->initialize(in, internal, history);
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    stop_->begin_step(in, acc, dt, history);
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override { stop_->events(in, g, rate); }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    stop_->on_event(index, in, internal, history, fields);
  }
  void commit(const JointInput& in, Span<const double> lambda, Span<double> history) const override {
    stop_->commit(in, lambda, history);
  }
  void observe(const JointInput& in, Span<const double> lambda, Span<double> channels) const override {
    stop_->observe(in, lambda, channels);
  }
  double step_limit(const JointInput& in) const override { return stop_->step_limit(in); }
  const char* warning(const JointInput& in) const override { return stop_->warning(in); }
  void contacts(const JointInput& in, Span<double> numbers) const override { stop_->contacts(in, numbers); }
  void kinks(const JointInput& in, Span<double> g) const override { stop_->kinks(in, g); }

 private:
  static std::unique_ptr<const Joint> made(const Parameters& p) {
    const bool slides = p.word("kind") == 0;
    if (!p.given("contact")) {
      if (!p.given("stiffness")) throw BadParameter("", "missing-key", "give 'stiffness', or a law by 'contact'");
      if (p.given("radius")) throw BadParameter("radius", "conflicting-keys", "'radius' is of stops with 'contact'");
      return std::make_unique<space::AxisForce<Stops>>(p);
    }
    for (const char* other : {"stiffness", "damping"}) {
      if (p.given(other))
        throw BadParameter(other, "conflicting-keys",
                           "'" + std::string(other) + "' and 'contact' both say how the stop gives way: leave one out");
    }
    return slides ? touching<true>(p) : touching<false>(p);
  }
  template <bool slides>
  static std::unique_ptr<const Joint> touching(const Parameters& p) {
    const double lower = p.number("lower"), upper = p.number("upper"), radius = p.number("radius");
    if (!(lower < upper)) throw BadParameter("lower", "out-of-range", "'lower' must be below 'upper'");
    if (slides && !std::isnan(radius))
      throw BadParameter("radius", "conflicting-keys", "'radius' is of stops that turn: a slide meets its ends itself");
    if (!slides && std::isnan(radius))
      throw BadParameter("", "missing-key",
                         "a stop that turns needs 'radius', the distance from the axis at which it touches: laws of "
                         "contact work in metres");
    const double lever = slides ? 1.0 : radius, way = lever * (upper - lower);
    const ContactPair pair{play::not_a_number,
                           play::not_a_number,
                           way,
                           play::not_a_number,
                           {play::not_a_number, play::not_a_number},
                           {play::not_a_number, play::not_a_number}};
    return std::make_unique<ContactStops<slides>>(play::WayEnds<slides>{lower, upper, lever, way},
                                                  p.contact_law("contact", pair));
  }
  std::unique_ptr<const Joint> stop_;
};

constexpr Parameter joint_stop_parameters[] = {
    space::axis_kind_parameter,
    {.name = "lower", .unit = "kind: m | rad", .summary = "Lower end of the way."},
    {.name = "upper", .unit = "kind: m | rad", .summary = "Upper end of the way; not below the lower."},
    {.name = "stiffness",
     .unit = "kind: N/m | N*m/rad",
     .default_value = optional,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Stiffness of the stops, unless `contact` is given."},
    {.name = "damping",
     .unit = "kind: s/m | s/rad",
     .default_value = 1.0,
     .minimum = 0.0,
     .summary = "By what part the effort grows with the speed into the stop."},
    {.name = "contact",
     .kind = ParameterKind::contact_law,
     .default_value = optional,
     .summary = "In place of `stiffness`: law of the force at an end, with events and statistics of its contacts."},
    {.name = "radius",
     .unit = "m",
     .default_value = optional,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "With `contact`, of stops that turn: distance from the axis at which they touch."}};

}  // namespace

Component joint_stop() {
  return joint<JointStop>(
      {.name = "joint-stop",
       .space = Space::both,
       .summary = "Force element: stops at both ends of the way of a joint.",
       .formula =
           "beyond an end by d: effort back stiffness d (1 + damping d'), not below 0; along x of the first frame "
           "or about its z. With `contact` F_N(d, d') of the law, of a turn r F_N(r d, r d') with r the radius.",
       .references = "Hunt and Crossley 1975, J Appl Mech 42, 440-445",
       .parameters = joint_stop_parameters});
}

}  // namespace freeplay
