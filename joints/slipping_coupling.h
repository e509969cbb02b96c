// An elastic coupling along or about the axis of a joint that slips at a bound: clutches and brakes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "axis_force.h"

namespace freeplay::space {

/// The effort passes one of its bounds: 0 is the lower, 1 the upper.
struct BoundEvent {
  const char* name;
  std::size_t bound;
  Crossing crossing;
};

/// Spring and damper side by side, in series with a surface that slips. With the speed s' of b against a along x_a or
/// about z_a, the strain z of the spring (internal), stiffness k and the relaxation time T:
///
///   E = k (z + T s'), but not below `lower` and not above `upper`      z' = (E/k - z)/T
///
/// and the effort on b is -E, the opposite on a. Between the bounds z' = s': it holds, and at rest it does so without
/// any creep. At a bound it slips by s' - z'. Stored: k z^2/2; dissipated: k T z'^2 + E (s' - z'), neither below 0
/// where lower <= 0 <= upper. E and z' are continuous, so that the state alone says what holds and nothing is switched.
/// No potential_rate: where nothing passes steps may be long against T, so that the loss is taken from differences.
/// Bounds has
///   lower(in), upper(in)  [N or N m], infinite: none
///   time_scale()        JointLayout::time_scale
///   events()            at most `most_events`
///   doubt(in)           a sentence where the bounds make no sense, else null
template <class Bounds>
class SlippingCoupling final : public Joint {
 public:
  explicit SlippingCoupling(const Parameters& p)
      : slides_(p.word("kind") == 0),
        stiffness_(p.number("stiffness")),
        relaxation_(p.number("relaxation")),
        bounds_(p) {
    for (const BoundEvent& event : bounds_.events()) events_[count_++] = {event.name, event.crossing, 0, {}};
  }

  void declare(JointLayout& layout) const override {
    static constexpr Channel of_slide[] = {{"strain", "m"}, {"slipping", "1"}},
                             of_turn[] = {{"strain", "rad"}, {"slipping", "1"}};
    layout.time_scale = bounds_.time_scale();
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    layout.internal_variables = 1;
    layout.history = 1;
    layout.kinks = 2;
    layout.coordinate = slides_ ? Coordinate::position : Coordinate::angle;
    layout.channels = slides_ ? Span<const Channel>(of_slide) : Span<const Channel>(of_turn);
    layout.events = {events_.data(), count_};
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { write_axis_coordinate(in, slides_, row); }
  void apply(const JointInput& in, JointForces& out) const override {
    const PairInFirstAxes pair = pair_of(in);
    const RelativeMotion<double> x = pair.numbers();
    const AxisMotion<double> now = motion(x, in.coordinate);
    const Effort<double> e = effort(in, now.rate);
    out.potential = 0.5 * stiffness_ * in.internal[0] * in.internal[0];
    out.internal_rate[0] = e.strain_rate;
    pair.write(force(x, now, e.value), out);
    if (out.derivatives.empty()) return;
    const RelativeMotion<Dual> slopes = pair.duals();
    const AxisMotion<Dual> moving = motion(slopes, in.coordinate);
    const Effort<Dual> by_motion = effort(in, moving.rate);
    pair.write_derivatives(force(slopes, moving, by_motion.value), columns, out);
    pair.write_rate_derivatives(0, by_motion.strain_rate, columns, out);
    if (!e.slips) pair.write_internal_column(0, force(x, now, stiffness_), columns, out);
    out.derivatives[by_strain] = e.slips ? -1.0 / relaxation_ : 0.0;
  }
  /// The acceleration of s along the step, by which events know how fast E goes.
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double, Span<double> history) const override {
    CoordinateRow row{};
    coordinate(in, row);
    double acceleration = row.bias;
    for (std::size_t i = 0; i < 6; ++i) acceleration += row.jacobian[i] * acc.a[i] + row.jacobian[6 + i] * acc.b[i];
    history[0] = acceleration;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const Effort<double> e = effort(in, motion(pair_of(in).numbers(), in.coordinate).rate);
    const double slope = stiffness_ * (e.strain_rate + relaxation_ * in.history[0]);
    const std::array<double, 2> at{bounds_.lower(in), bounds_.upper(in)};
    for (std::size_t i = 0; i < g.size; ++i) {
      const double bound = at[bounds_.events()[i].bound];
      g[i] = std::isfinite(bound) ? e.trial - bound : std::numeric_limits<double>::quiet_NaN();
      rate[i] = slope;
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const double trial = effort(in, motion(pair_of(in).numbers(), in.coordinate).rate).trial;
    g[0] = trial - bounds_.lower(in);
    g[1] = trial - bounds_.upper(in);
    for (std::size_t i = 0; i < 2; ++i) {
      if (!std::isfinite(g[i])) g[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    channels[0] = in.internal[0];
    channels[1] = effort(in, motion(pair_of(in).numbers(), in.coordinate).rate).slips ? 1.0 : 0.0;
  }
  const char* warning(const JointInput& in) const override { return bounds_.doubt(in); }

 private:
  static constexpr Eigen::Index columns = 25;             // of the derivatives
  static constexpr std::size_t by_strain = 12 * 25 + 24;  // of the rate of the strain, by the strain

  template <class T>
  struct Effort {
    double trial;  ///< E were there no bounds
    bool slips;
    T value, strain_rate;
  };
  template <class T>
  Effort<T> effort(const JointInput& in, const T& rate) const {
    const double z = in.internal[0], trial = stiffness_ * (z + relaxation_ * value_of(rate));
    const double lower = bounds_.lower(in), upper = bounds_.upper(in);
    if (trial >= lower && trial <= upper) {
      return {trial, false, stiffness_ * (T(z) + relaxation_ * rate), rate};
    }
    const double bound = trial < lower ? lower : upper;
    return {trial, true, T(bound), T((bound / stiffness_ - z) / relaxation_)};
  }

  PairInFirstAxes pair_of(const JointInput& in) const {
    return slides_ ? PairInFirstAxes(in, Vector3d::Zero(), Eigen::Matrix3d::Zero()) : PairInFirstAxes::with_axis(in, 0);
  }
  template <class T>
  AxisMotion<T> motion(const RelativeMotion<T>& x, double coordinate) const {
    return slides_ ? slide_along_x(x) : turn_about_z(x, coordinate);
  }
  template <class T>
  RelativeForce<T> force(const RelativeMotion<T>& x, const AxisMotion<T>& now, const T& effort) const {
    const Vec<T> pull = -(effort * now.u);
    if (slides_) return {pull, -cross(x.d, pull), {}};
    return {{}, -pull, pull};
  }

  static constexpr std::size_t most_events = 4;

  bool slides_;
  double stiffness_, relaxation_;
  Bounds bounds_;
  std::array<Event, most_events> events_{};
  std::size_t count_ = 0;
};

/// The first parameter of a clutch or brake: most of them turn.
inline constexpr Parameter coupling_kind_parameter{.name = "kind",
                                                   .kind = ParameterKind::choice,
                                                   .default_value = 1,
                                                   .choices = "linear|rotational",
                                                   .summary =
                                                       "Acts along the x axis of the first frame, or about its z "
                                                       "axis."};
inline constexpr Parameter coupling_stiffness_parameter{.name = "stiffness",
                                                        .unit = "kind: N/m | N*m/rad",
                                                        .minimum = 0.0,
                                                        .open = Open::minimum,
                                                        .summary = "How stiffly it holds."};
inline constexpr Parameter coupling_relaxation_parameter{
    .name = "relaxation",
    .unit = "s",
    .default_value = 1e-3,
    .minimum = 0.0,
    .open = Open::minimum,
    .summary = "Damping over stiffness: while it holds, stiffness relaxation is its damping."};

}  // namespace freeplay::space
