#include <algorithm>
#include <cmath>
#include <numbers>

#include "curve_check.h"
#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

using namespace planar;
using curves::Curve;
using curves::CurveForm;

/// A pin in a curved groove, or the roller of a follower on a cam: the second origin stays on a curve of marker a, the
/// turn is free. With d = P_b - P_a, V = d', w the angular speed of a, and
///
///   cartesian: h, n the axes of a, x = h.d, y = n.d      Phi = y - f(x)      dPhi/dP_b = n - f' h
///     Phi'' = (n - f' h).d'' - (x + f' y) w' - w (h.V + x' + f' (n.V + y')) - f'' x'^2
///   polar: rho = |d|, u = d/rho, t = u turned by +90 degrees, psi the angle of d in a from 0 to one turn
///     Phi = rho - f(psi)      dPhi/dP_b = u - f' t/rho
///     Phi'' = (u - f' t/rho).d'' + f' w' + rho q^2 + 2 f' rho' q/rho - f'' psi'^2 with q = t.V/rho
class PointOnCurve final : public Joint {
 public:
  explicit PointOnCurve(const Parameters& p)
      : form_(static_cast<CurveForm>(p.word("form"))), curve_(curves::checked_curve(p.formula("curve"), form_)) {}

  void declare(JointLayout& layout) const override {
    static constexpr Channel channels[] = {{"normal_force", "N"}};
    layout.time_scale = unbounded;
    layout.constraint_rows = 1;
    layout.kinks = curve_.switches();
    layout.channels = channels;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Row row = row_of(in);
    rows.phi[0] = row.phi;
    rows.gamma[0] = row.gamma;
    for (std::size_t i = 0; i < 2; ++i) {
      const double along = row.normal[static_cast<Eigen::Index>(i)];
      rows.jacobian[velocity_a + i] = -along;
      rows.jacobian[velocity_b + i] = along;
    }
    rows.jacobian[turn_a] = row.by_turn;
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const Eigen::Vector2d d = position(*in.b) - position(*in.a), h = x_axis(*in.a);
    curve_.decide(form_ == CurveForm::polar ? angle_of(d, h) : h.dot(d), g);
  }
  /// Positive: the curve pushes the point up, or away from the middle of the cam.
  void observe(const JointInput& in, Span<const double> lambda, Span<double> channels) const override {
    channels[0] = -lambda[0] * row_of(in).normal.norm();
  }

 private:
  static constexpr double smallest_distance = 1e-12;  // [m]

  struct Row {
    double phi, gamma, by_turn;
    Eigen::Vector2d normal;
  };
  Row row_of(const JointInput& in) const {
    const Eigen::Vector2d d = position(*in.b) - position(*in.a), rate = velocity(*in.b) - velocity(*in.a);
    return form_ == CurveForm::polar ? around(in, d, rate) : along(in, d, rate);
  }
  static double angle_of(const Eigen::Vector2d& d, const Eigen::Vector2d& h) {
    const double psi = std::atan2(turned(h).dot(d), h.dot(d));
    return psi < 0.0 ? psi + 2.0 * std::numbers::pi : psi;
  }
  Row along(const JointInput& in, const Eigen::Vector2d& d, const Eigen::Vector2d& rate) const {
    const Eigen::Vector2d h = x_axis(*in.a), n = turned(h);
    const double w = angular_velocity(*in.a), x = h.dot(d), y = n.dot(d);
    const double x_rate = h.dot(rate) + w * y, y_rate = n.dot(rate) - w * x;
    const Curve::At f = curve_.at(x);
    return {y - f.value, w * (h.dot(rate) + x_rate + f.slope * (n.dot(rate) + y_rate)) + f.bend * x_rate * x_rate,
            -(x + f.slope * y), n - f.slope * h};
  }
  Row around(const JointInput& in, const Eigen::Vector2d& d, const Eigen::Vector2d& rate) const {
    // In the middle of the curve the x axis stands for u.
    const Eigen::Vector2d h = x_axis(*in.a);
    const double rho = std::max(d.norm(), smallest_distance);
    const Eigen::Vector2d u = d.norm() > 0.0 ? Eigen::Vector2d(d / d.norm()) : h, t = turned(u);
    const Curve::At f = curve_.at(angle_of(d, h));
    const double out = u.dot(rate), q = t.dot(rate) / rho, turning = q - angular_velocity(*in.a);
    return {rho - f.value, f.bend * turning * turning - rho * q * q - 2.0 * f.slope * out * q / rho, f.slope,
            u - f.slope / rho * t};
  }

  CurveForm form_;
  Curve curve_;
};

}  // namespace

Component point_on_curve() {
  return joint<PointOnCurve>(
      {.name = "point-on-curve",
       .space = Space::planar,
       .summary =
           "Pin in a curved groove, or roller on a cam: the second origin stays on a curve of the first frame, the "
           "turn is free.",
       .formula =
           "y = curve(x) in the first frame, or |d| = curve(angle of d in the first frame), d = P_b - P_a; for a "
           "roller the way of its centre.",
       .validity = "The point does not lift off: a negative normal_force pulls. A step with error control ends "
                   "where the curve changes its form, as from an arc to a line.",
       .references = "Norton 2009, Cam Design and Manufacturing Handbook",
       .parameters = curves::curve_rows});
}

}  // namespace freeplay
