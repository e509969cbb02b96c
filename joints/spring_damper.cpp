#include "freeplay/plugin.h"
#include "planar_marker.h"

namespace freeplay {
namespace {

using namespace planar;

enum Kind { linear, rotational };

constexpr double smallest_length = 1e-12;  // [m]; below it the direction of the force means nothing

/// Spring, damper and constant preload side by side, with stiffness k, damping c and preload p.
///
/// Linear, with d = P_b - P_a [m], L = |d|, u = d/L, L' = u.d' and free length L_0:
///
///   force on b: -f u,  f = k (L - L_0) + c L' + p        stored: k (L - L_0)^2/2 + p (L - L_0)
///   df/dd = k u + c (d' - L' u)/L        df/dd' = c u        du/dd = (1 - u u^T)/L
///
/// Rotational, with phi the angle of marker b relative to marker a (the coordinate, counted over turns), and free angle
/// phi_0:
///
///   torque on b: -(k (phi - phi_0) + c phi' + p)        stored: k (phi - phi_0)^2/2 + p (phi - phi_0)
class SpringDamper final : public Joint {
 public:
  explicit SpringDamper(const Parameters& parameters)
      : kind_(static_cast<Kind>(parameters.word("kind"))),
        stiffness_(parameters.number("stiffness")),
        damping_(parameters.number("damping")),
        free_(parameters.number(kind_ == linear ? "free_length" : "free_angle")),
        preload_(parameters.number("preload")) {
    const char* other = kind_ == linear ? "free_angle" : "free_length";
    if (!parameters.given(other)) return;
    throw BadParameter(
        other, "conflicting-keys",
        std::string("a ") + (kind_ == linear ? "linear" : "rotational") + " spring has no '" + other + "'");
  }

  void declare(JointLayout& layout) const override {
    static const Channel length[] = {{"length", "m"}};
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    if (kind_ == linear) {
      layout.channels = Span<const Channel>(length);
    } else {
      layout.coordinate = Coordinate::angle;
    }
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if (kind_ == linear) return;
    row.value = relative_angle(*in.a, *in.b);
    write_turn(row.jacobian);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    if (kind_ == linear) channels[0] = (position(*in.b) - position(*in.a)).norm();
  }
  void apply(const JointInput& in, JointForces& out) const override {
    if (kind_ == linear) {
      pull(in, out);
    } else {
      twist(in, out);
    }
  }

 private:
  double restoring(double stretch) const { return stiffness_ * stretch + preload_; }
  double effort(double stretch, double rate) const { return restoring(stretch) + damping_ * rate; }
  double stored(double stretch) const { return (0.5 * stiffness_ * stretch + preload_) * stretch; }

  void pull(const JointInput& in, JointForces& out) const {
    const Eigen::Vector2d d = position(*in.b) - position(*in.a), rate = velocity(*in.b) - velocity(*in.a);
    const double length = d.norm();
    out.potential = stored(length - free_);
    out.potential_rate = 0.0;
    if (length < smallest_length) return;
    const Eigen::Vector2d u = d / length;
    const double f = effort(length - free_, u.dot(rate));
    out.potential_rate = restoring(length - free_) * u.dot(rate);
    for (int i = 0; i < 2; ++i) {
      out.wrench_a[i] = f * u[i];
      out.wrench_b[i] = -f * u[i];
    }
    if (out.derivatives.size == 0) return;
    const Eigen::Vector2d slope = stiffness_ * u + damping_ / length * (rate - u.dot(rate) * u);
    const Eigen::Matrix2d by_distance =
        u * slope.transpose() + f / length * (Eigen::Matrix2d::Identity() - u * u.transpose());
    const Eigen::Matrix2d by_rate = damping_ * u * u.transpose();
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) {
        set_pair(out, r, c, by_distance(r, c));
        set_pair(out, r, twists + c, by_rate(r, c));
      }
    }
  }

  void twist(const JointInput& in, JointForces& out) const {
    const double stretch = in.coordinate - free_;
    const double rate = angular_velocity(*in.b) - angular_velocity(*in.a), torque = effort(stretch, rate);
    out.potential = stored(stretch);
    out.potential_rate = restoring(stretch) * rate;
    out.wrench_a[5] = torque;
    out.wrench_b[5] = -torque;
    if (out.derivatives.size == 0) return;
    set_pair(out, 5, 5, stiffness_);
    set_pair(out, 5, twists + 5, damping_);
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

  Kind kind_;
  double stiffness_, damping_, free_, preload_;
};

constexpr Parameter parameters[] = {
    {.name = "kind",
     .kind = ParameterKind::choice,
     .default_value = linear,
     .choices = "linear|rotational",
     .summary = "Acts along the line between the origins, or on the angle between the frames."},
    {.name = "stiffness",
     .unit = "kind: N/m | N*m/rad",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Stiffness of the spring."},
    {.name = "damping",
     .unit = "kind: N*s/m | N*m*s/rad",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Damping coefficient."},
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
     .summary = "Constant part that pulls the ends together, or turns the second body clockwise."}};

}  // namespace

Component spring_damper() {
  return joint<SpringDamper>(
      {.name = "spring-damper",
       .space = Space::planar,
       .summary =
           "Force element: spring, damper and preload between two frames, along their line or about their angle.",
       .formula =
           "linear: pull = stiffness (L - free_length) + damping dL/dt + preload, L the distance of the origins, "
           "no force below 1e-12 m; rotational: torque on the second body = -(stiffness (angle - free_angle) + "
           "damping dangle/dt + preload), angle counted over turns; at the start as by a joint "
           "between the same bodies, else from (-pi, pi].",
       .parameters = parameters});
}

}  // namespace freeplay
