#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <vector>

#include "axis_force.h"
#include "formula_corners.h"
#include "freeplay/kit/integral_from_zero.h"
#include "freeplay/kit/planar_marker.h"

namespace freeplay {
namespace {

using namespace planar;

enum Kind { linear, rotational };

constexpr double smallest_length = 1e-12;  // [m]; below it the direction of the force means nothing

/// Pull at a stretch and its rate.
struct Effort {
  double value, by_stretch, by_rate;
  double restoring;  ///< the part that the stretch alone decides
};

/// What both classes read: stiffness k, damping c, preload p, the length or angle at which the spring is slack, and
/// what formulas add. Those of stiffness, damping and preload that the motion decides are 0 here, and come with
/// JointInput::functions.
struct Spring {
  explicit Spring(const Parameters& parameters)
      : kind(static_cast<Kind>(parameters.word("kind"))),
        stiffness(constant(parameters.number("stiffness"))),
        damping(constant(parameters.number("damping"))),
        free(parameters.number(kind == linear ? "free_length" : "free_angle")),
        preload(constant(parameters.number("preload"))),
        spring(parameters.formula("spring")),
        damper(parameters.formula("damper")) {
    if (spring) store_spring();
    const char* other = kind == linear ? "free_angle" : "free_length";
    if (!parameters.given(other)) return;
    throw BadParameter(
        other, "conflicting-keys",
        std::string("a ") + (kind == linear ? "linear" : "rotational") + " spring has no '" + other + "'");
  }
  static double constant(double number) { return std::isnan(number) ? 0.0 : number; }
  Effort effort(const JointInput& in, double stretch, double rate) const {
    Effort e{0.0, stiffness, damping, stiffness * stretch + preload};
    if (spring) {
      double slope[1];
      e.restoring += spring.at({&stretch, 1}, slope);
      e.by_stretch += slope[0];
    }
    e.value = e.restoring + damping * rate;
    if (!in.functions.empty()) {
      e.value +=
          (in.functions[0] - stiffness) * stretch + (in.functions[1] - damping) * rate + in.functions[2] - preload;
      e.by_stretch += in.functions[0] - stiffness;
      e.by_rate += in.functions[1] - damping;
    }
    if (damper) {
      const double at[] = {rate, stretch};
      double slopes[2];
      e.value += damper.at(at, slopes);
      e.by_rate += slopes[0];
      e.by_stretch += slopes[1];
    }
    return e;
  }
  double stored(double stretch) const {
    const double linear = (0.5 * stiffness * stretch + preload) * stretch;
    if (!spring) return linear;
    double known = 0.0;
    if (spring.integral(0.0, stretch, known)) return linear + known;
    if (repeats) {
      const double turns = std::floor(stretch / whole_turn);
      return linear + turns * pulled.at(whole_turn) + pulled.at(stretch - turns * whole_turn);
    }
    return linear + (stretch < 0.0 ? pressed.at(stretch) : pulled.at(stretch));
  }
  /// A sentence where a function makes a stiffness or a damping negative, or the ends of a linear spring are as good as
  /// at one place; else null.
  const char* doubt(const JointInput& in, double length) const {
    if (!in.functions.empty()) {
      if (in.functions[0] < below_zero)
        return "The stiffness is negative here: the spring drives away from where it is slack.";
      if (in.functions[1] < below_zero) return "The damping is negative here: it drives the motion.";
    }
    if (kind != linear || !(stiffness > 0.0) || !(free > 0.0)) return nullptr;
    if (length > most_pulled * free)
      return "The spring is pulled to more than ten times its free length: check its stiffness, what pulls, and their "
             "units.";
    if (!(length < most_pressed * free)) return nullptr;
    return "The spring is pressed together to less than a tenth of its free length, as none can be; beyond that it "
           "changes sides.";
  }
  /// Where a formula changes its form.
  void write_kinks(double stretch, double rate, Span<double> g) const {
    const std::size_t own = spring ? static_cast<std::size_t>(spring.switches()) : 0;
    if (own > 0) spring.decide({&stretch, 1}, g.part(0, own));
    const double at[] = {rate, stretch};
    if (g.size > own) damper.decide(at, g.part(own, g.size - own));
  }

  void declare(JointLayout& layout) const {
    layout.kinks = (spring ? spring.switches() : 0) + (damper ? damper.switches() : 0);
    layout.time_scale = unbounded;
    static const Channel length[] = {{"length", "m"}};
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    if (kind == linear) {
      layout.channels = Span<const Channel>(length);
    } else {
      layout.coordinate = Coordinate::angle;
    }
  }

  static constexpr double most_pressed = 0.1;  ///< coils lie on each other at a third or more
  static constexpr double most_pulled = 10.0;  ///< soft ones of steel come to three or four times

  Kind kind;
  double stiffness, damping, free, preload;
  Formula spring, damper;

 private:
  void store_spring() {
    double known = 0.0;
    if (spring.integral(0.0, 1.0, known)) return;
    const auto force = [formula = spring](double stretch) { return formula.at({&stretch, 1}); };
    repeats = kind == rotational && repeats_each_turn(force);
    const double most = repeats ? 1.01 * whole_turn : largest_stretch;
    const std::vector<double> corners = FormulaCorners::of(spring, smallest_stretch, most);
    pulled = IntegralFromZero(force, smallest_stretch, most, corners);
    if (repeats) return;
    pressed = IntegralFromZero(force, smallest_stretch, -largest_stretch, corners);
  }
  /// Whether the torque is the same in every turn, as the cogging of a motor: then one turn says all of it.
  template <class Force>
  bool repeats_each_turn(const Force& force) const {
    constexpr int places = 64;
    constexpr double alike = 1e-9, golden = 0.6180339887498949;
    if (spring.switches() > 0) return false;
    double largest = 0.0, off = 0.0;
    try {
      for (int i = 0; i < places; ++i) {
        const double x = whole_turn * (golden * i - std::floor(golden * i)), here = force(x);
        largest = std::max(largest, std::abs(here));
        for (const double turns : {-2.0, -1.0, 1.0, 2.0, 3.0, 11.0}) {
          off = std::max(off, std::abs(force(x + turns * whole_turn) - here));
        }
      }
    } catch (const std::exception&) {
      return false;  // somewhere it has no value
    }
    return largest > 0.0 && off <= alike * largest;  // where nothing is seen a detent may stand between
  }
  static constexpr double whole_turn = 2.0 * std::numbers::pi;
  bool repeats = false;
  static constexpr double smallest_stretch = 0x1p-20, largest_stretch = 0x1p10;  // [m or rad]
  IntegralFromZero pulled, pressed;
};

/// Spring, damper and constant preload side by side, with stiffness k, damping c and preload p, and with a spring s(x)
/// and a damper d(x, x') that formulas give, of the stretch x: L - L_0 or phi - phi_0.
///
/// Linear, with d = P_b - P_a [m], L = |d|, u = d/L, L' = u.d' and free length L_0:
///
///   force on b: -f u,  f = k x + c L' + p + s + d        stored: k x^2/2 + p x + integral of s from 0 to x
///   df/dd = f_x u + f_v (d' - L' u)/L    df/dd' = f_v u      du/dd = (1 - u u^T)/L
///   with f_x = k + s' + d_x and f_v = c + d_x'
///
/// Rotational, with phi the angle of marker b relative to marker a (the coordinate, counted over turns), and free angle
/// phi_0:
///
///   torque on b: -(k x + c phi' + p + s + d), stored as above
class SpringDamper final : public Joint {
 public:
  explicit SpringDamper(const Parameters& parameters) : spring_(parameters) {}

  void declare(JointLayout& layout) const override { spring_.declare(layout); }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if (spring_.kind == linear) return;
    row.value = relative_angle(*in.a, *in.b);
    write_turn(row.jacobian);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    if (spring_.kind == linear) channels[0] = (position(*in.b) - position(*in.a)).norm();
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    if (spring_.kind == rotational) {
      const double rate = angular_velocity(*in.b) - angular_velocity(*in.a);
      return spring_.write_kinks(in.coordinate - spring_.free, rate, g);
    }
    const Eigen::Vector2d d = position(*in.b) - position(*in.a), rate = velocity(*in.b) - velocity(*in.a);
    if (d.norm() >= smallest_length) spring_.write_kinks(d.norm() - spring_.free, d.dot(rate) / d.norm(), g);
  }
  const char* warning(const JointInput& in) const override {
    return spring_.doubt(in, (position(*in.b) - position(*in.a)).norm());
  }
  void apply(const JointInput& in, JointForces& out) const override {
    if (spring_.kind == linear) {
      pull(in, out);
    } else {
      twist(in, out);
    }
  }

 private:
  void pull(const JointInput& in, JointForces& out) const {
    const Eigen::Vector2d d = position(*in.b) - position(*in.a), rate = velocity(*in.b) - velocity(*in.a);
    const double length = d.norm();
    out.potential = spring_.stored(length - spring_.free);
    out.potential_rate = 0.0;
    if (length < smallest_length) return;
    const Eigen::Vector2d u = d / length;
    const Effort effort = spring_.effort(in, length - spring_.free, u.dot(rate));
    const double f = effort.value;
    out.potential_rate = effort.restoring * u.dot(rate);
    for (int i = 0; i < 2; ++i) {
      out.wrench_a[i] = f * u[i];
      out.wrench_b[i] = -f * u[i];
    }
    if (out.derivatives.size == 0) return;
    const Eigen::Vector2d slope = effort.by_stretch * u + effort.by_rate / length * (rate - u.dot(rate) * u);
    const Eigen::Matrix2d by_distance =
        u * slope.transpose() + f / length * (Eigen::Matrix2d::Identity() - u * u.transpose());
    const Eigen::Matrix2d by_rate = effort.by_rate * u * u.transpose();
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) {
        set_pair(out, r, c, by_distance(r, c));
        set_pair(out, r, twists + c, by_rate(r, c));
      }
    }
  }

  void twist(const JointInput& in, JointForces& out) const {
    const double stretch = in.coordinate - spring_.free;
    const double rate = angular_velocity(*in.b) - angular_velocity(*in.a);
    const Effort torque = spring_.effort(in, stretch, rate);
    out.potential = spring_.stored(stretch);
    out.potential_rate = torque.restoring * rate;
    out.wrench_a[5] = torque.value;
    out.wrench_b[5] = -torque.value;
    if (out.derivatives.size == 0) return;
    set_pair(out, 5, 5, torque.by_stretch);
    set_pair(out, 5, twists + 5, torque.by_rate);
  }

  static constexpr int columns = 24, twists = 12;  // of the derivatives; first column of the twists

  /// Derivative of component `row` of the wrench on a by the motion `column` of b relative to a, at all four places.
  static void set_pair(JointForces& out, int row, int column, double value) {
    double* table = out.derivatives.data;
    table[row * columns + column] = -value;
    table[row * columns + column + 6] = value;
    table[(row + 6) * columns + column] = value;
    table[(row + 6) * columns + column + 6] = -value;
  }

  Spring spring_;
};

/// The same in space. Linear: the formulas above with vectors of three components. Rotational: phi is the angle of b
/// about z_a, whose rate is u.(w_b - w_a) with u = z_a where the z axes agree (`spatial_marker.h`); the torque on b is
/// -(k x + c phi' + p + s + d) u, so that work and stored energy agree exactly.
class SpatialSpringDamper final : public Joint {
 public:
  explicit SpatialSpringDamper(const Parameters& parameters) : spring_(parameters) {}

  void declare(JointLayout& layout) const override { spring_.declare(layout); }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if (spring_.kind == rotational) space::AngleAboutZ(in).write(row);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    if (spring_.kind == linear) channels[0] = (space::position(*in.b) - space::position(*in.a)).norm();
  }
  const char* warning(const JointInput& in) const override {
    return spring_.doubt(in, (space::position(*in.b) - space::position(*in.a)).norm());
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Pair pair = pair_of(in);
    const State<double> now = state(pair.numbers(), in.coordinate);
    out.potential = spring_.stored(now.stretch);
    out.potential_rate = 0.0;
    if (has_no_direction(now)) return;
    const Effort effort = spring_.effort(in, now.stretch, now.rate);
    out.potential_rate = effort.restoring * now.rate;
    pair.write(force(now, effort), out);
    if (!out.derivatives.empty()) pair.write_derivatives(force(state(pair.duals(), in.coordinate), effort), 24, out);
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const State<double> now = state(pair_of(in).numbers(), in.coordinate);
    if (!has_no_direction(now)) spring_.write_kinks(now.stretch, now.rate, g);
  }

 private:
  using Pair = space::PairInFirstAxes;
  template <class T>
  using Motion = space::RelativeMotion<T>;
  template <class T>
  using Vec = space::Vec<T>;
  /// Stretch, its rate, and the direction u of the force or torque; axes of marker a.
  template <class T>
  struct State {
    T stretch, rate;
    Vec<T> u;
  };

  Pair pair_of(const JointInput& in) const {
    if (spring_.kind == rotational) return Pair::with_axis(in, 0);
    return Pair(in, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero());
  }
  bool has_no_direction(const State<double>& now) const {
    return spring_.kind == linear && now.stretch + spring_.free < smallest_length;
  }

  template <class T>
  State<T> state(const Motion<T>& x, double angle) const {
    using std::sqrt;
    if (spring_.kind == linear) {
      const T length = sqrt(dot(x.d, x.d));
      const Vec<T> u = (T(1.0) / (space::value_of(length) > 0.0 ? length : T(1.0))) * x.d;
      return {length - T(spring_.free), dot(u, x.u), u};
    }
    const space::AxisMotion<T> turn = space::turn_about_z(x, angle);
    return {turn.value - T(spring_.free), turn.rate, turn.u};
  }

  template <class T>
  space::RelativeForce<T> force(const State<T>& now, const Effort& e) const {
    const T effort = space::chained(e.value, e.by_stretch, now.stretch, e.by_rate, now.rate);
    const Vec<T> pull = -(effort * now.u);
    if (spring_.kind == linear) return {pull, {}, {}};
    return {{}, -pull, pull};
  }

  Spring spring_;
};

constexpr Parameter spring_damper_parameters[] = {
    {.name = "kind",
     .kind = ParameterKind::choice,
     .default_value = linear,
     .choices = "linear|rotational",
     .summary = "Acts along the line between the origins, or on the angle between the frames."},
    {.name = "stiffness",
     .unit = "kind: N/m | N*m/rad",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary =
         "Stiffness of the spring; it, damping and preload may be functions of time or of the motion under `forces`.",
     .variables = "motion"},
    {.name = "damping",
     .unit = "kind: N*s/m | N*m*s/rad",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Damping coefficient.",
     .variables = "motion"},
    {.name = "free_length",
     .unit = "m",
     .default_value = 0.0,
     .summary = "Linear: length at which the spring is slack."},
    {.name = "free_angle",
     .unit = "rad",
     .default_value = 0.0,
     .summary = "Rotational: angle of the second frame relative to the first at which the spring is slack."},
    {.name = "preload",
     .unit = "kind: N | N*m",
     .default_value = 0.0,
     .summary = "Part that pulls the ends together, or turns the second body clockwise.",
     .variables = "motion"},
    {.name = "spring",
     .kind = ParameterKind::formula,
     .unit = "kind: N | N*m",
     .default_value = optional,
     .summary = "Pull of a further spring at the stretch x, length - free_length or angle - free_angle.",
     .variables = "x: kind: m | rad"},
    {.name = "damper",
     .kind = ParameterKind::formula,
     .unit = "kind: N | N*m",
     .default_value = optional,
     .summary = "Pull of a further damper at the stretch x and its rate v.",
     .variables = "v: kind: m/s | rad/s; x: kind: m | rad"}};

}  // namespace

Component spring_damper() {
  return joint<SpringDamper>(
      {.name = "spring-damper",
       .space = Space::both,
       .summary =
           "Force element: spring, damper and preload between two frames, along their line or about their angle.",
       .formula =
           "linear: pull = stiffness (L - free_length) + damping dL/dt + preload + spring + damper, L the distance of "
           "the origins, "
           "no force below 1e-12 m; rotational: torque on the second body = -(stiffness (angle - free_angle) + "
           "damping dangle/dt + preload + spring + damper), in space about z of the first frame, angle counted over "
           "turns; at the start "
           "as by a joint "
           "between the same bodies, else from (-pi, pi].",
       .parameters = spring_damper_parameters,
       .in_space = joint_face<SpatialSpringDamper>()});
}

}  // namespace freeplay
