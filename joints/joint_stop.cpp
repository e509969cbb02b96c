#include <numbers>

#include "axis_force.h"

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
  const char* doubt(double s, bool slides) const {
    const double d = depth(s), way = upper_ - lower_;
    const bool far = (way > 0.0 && d > most_ways * way) || (!slides && d > most_turn);
    return far ? "The joint is far beyond the end of its way: a driver moves it through its stop, or the stop is too "
                 "soft."
               : nullptr;
  }

 private:
  // How far beyond an end no stop yields: by the way between the two ends, and of turns.
  static constexpr double most_ways = 2.0;
  static constexpr double most_turn = std::numbers::pi / 2.0;  // [rad]

  /// 1 beyond the upper end, -1 beyond the lower.
  double beyond(double s) const { return s > upper_ ? 1.0 : -1.0; }
  double depth(double s) const { return s > upper_ ? s - upper_ : s < lower_ ? lower_ - s : 0.0; }

  double lower_, upper_, stiffness_, damping_;
};

constexpr Parameter joint_stop_parameters[] = {
    space::axis_kind_parameter,
    {.name = "lower", .unit = "kind: m | rad", .summary = "Lower end of the way."},
    {.name = "upper", .unit = "kind: m | rad", .summary = "Upper end of the way; not below the lower."},
    {.name = "stiffness",
     .unit = "kind: N/m | N*m/rad",
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Stiffness of the stops."},
    {.name = "damping",
     .unit = "kind: s/m | s/rad",
     .default_value = 1.0,
     .minimum = 0.0,
     .summary = "By what part the effort grows with the speed into the stop."}};

}  // namespace

Component joint_stop() {
  return joint<space::AxisForce<Stops>>(
      {.name = "joint-stop",
       .space = Space::both,
       .summary = "Force element: stops at both ends of the way of a joint.",
       .formula =
           "beyond an end by d: effort back stiffness d (1 + damping d'), not below 0; along x of the first frame "
           "or about its z.",
       .references = "Hunt and Crossley 1975, J Appl Mech 42, 440-445",
       .parameters = joint_stop_parameters});
}

}  // namespace freeplay
