// A joint whose torque goes through elementary functions of every kind: they are those of the program, not of the
// library.
#include <cmath>
#include <complex>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter parameters[] = {{.name = "stiffness", .unit = "N*m", .minimum = 0.0, .summary = "Of all terms."},
                                    {.name = "more",
                                     .kind = ParameterKind::formula,
                                     .unit = "N*m",
                                     .default_value = optional,
                                     .summary = "A further torque against the turn.",
                                     .variables = "turn: rad"}};
constexpr Channel channels[] = {{"spring_torque", "N*m"}};

class WavySpring final : public Joint {
 public:
  explicit WavySpring(const Parameters& p) : stiffness_(p.number("stiffness")), more_(p.formula("more")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.forces = 1;
    layout.channels = channels;
  }

  void coordinate(const JointInput& in, CoordinateRow& out) const override {
    const double *a = in.a->rotation, *b = in.b->rotation;
    out.value = std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
    out.jacobian[5] = -1.0;
    out.jacobian[11] = 1.0;
  }

  void apply(const JointInput& in, JointForces& out) const override {
    out.wrench_b[5] = torque(in.coordinate);
    out.wrench_a[5] = -torque(in.coordinate);
  }

  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    values[0] = torque(in.coordinate);
  }

 private:
  double torque(double s) const {
    const double real = std::sin(s) + std::cos(s) - 1.0 + std::tan(s / 4.0) + std::atan(s) + std::tanh(s) +
                        std::expm1(s / 4.0) + std::cbrt(s) + std::sinh(s / 4.0);
    const double even = std::exp(-s * s) * std::pow(1.0 + s * s, 0.3) + std::log(2.0 + s * s) + std::erf(s * s);
    const std::complex<double> turned = std::exp(std::complex<double>(0.0, s));
    const double more = more_ ? more_.at({&s, 1}) : 0.0;
    return -stiffness_ *
               (real + 0.1 * even * s + turned.imag() + 0.1 * static_cast<double>(std::sin(static_cast<float>(s)))) -
           more;
  }
  double stiffness_;
  Formula more_;
};

}  // namespace

FREEPLAY_PLUGIN(wavy_spring) {
  static const Component components[] = {joint<WavySpring>({.name = "wavy-spring",
                                                            .space = Space::planar,
                                                            .summary = "Torque that is not linear.",
                                                            .formula = "torque = -stiffness f(s)",
                                                            .parameters = parameters})};
  return publish(*host, *manifest, "wavy_spring", "1.0.0", components);
}
