// A force along the slide of its second marker, as a formula of the model file may give it: what a formula costs is
// measured beside it.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter parameters[] = {
    {.name = "linear", .unit = "N/m", .summary = "By the place x."},
    {.name = "quadratic", .unit = "N/m^2", .default_value = 0.0, .summary = "By x |x|."},
    {.name = "cubic", .unit = "N/m^3", .default_value = 0.0, .summary = "By x^3."},
    {.name = "damping", .unit = "N*s/m", .default_value = 0.0, .summary = "By the speed along x."}};

/// Force -(linear + quadratic |x| + cubic x^2) x - damping x' on b along the world's x axis, with x the place of b from
/// a there, and the opposite on a, which must stand on ground.
class SlideLoad final : public Joint {
 public:
  explicit SlideLoad(const Parameters& p)
      : linear_(p.number("linear")),
        quadratic_(p.number("quadratic")),
        cubic_(p.number("cubic")),
        damping_(p.number("damping")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    layout.kinks = quadratic_ != 0.0 ? 1 : 0;
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    if (g.size > 0) g[0] = along(in);
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const double x = along(in), size = std::abs(x);
    const double force =
        -(linear_ + quadratic_ * size + cubic_ * x * x) * x - damping_ * (in.b->velocity[0] - in.a->velocity[0]);
    out.wrench_b[0] = force;
    out.wrench_a[0] = -force;
    if (out.derivatives.empty()) return;
    const double slope = -(linear_ + 2.0 * quadratic_ * size + 3.0 * cubic_ * x * x);
    constexpr std::size_t columns = 24, b = 6, rates = 12;  // of the motion of a and b, then of their twists
    for (const auto& [column, value] : {std::pair{b, slope}, {rates + b, -damping_}}) {
      out.derivatives[b * columns + column] = value;
      out.derivatives[column] = -value;
      out.derivatives[b * columns + column - 6] = -value;
      out.derivatives[column - 6] = value;
    }
  }

 private:
  static double along(const JointInput& in) { return in.b->position[0] - in.a->position[0]; }
  double linear_, quadratic_, cubic_, damping_;
};

}  // namespace

FREEPLAY_PLUGIN(slide_load) {
  static const Component components[] = {
      joint<SlideLoad>({.name = "slide-load",
                        .space = Space::planar,
                        .summary = "Load along x by place and speed.",
                        .formula = "force = -(linear + quadratic |x| + cubic x^2) x - damping x'",
                        .parameters = parameters})};
  return publish(*host, *manifest, "slide_load", "1.0.0", components);
}
