// Example of two friction laws by measured tables: over the speed of slip, and over the distance slid so far.
#include <algorithm>
#include <cmath>
#include <string>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter speed_where_full = {.name = "vs",
                                        .unit = "m/s",
                                        .default_value = 1e-3,
                                        .minimum = 0.0,
                                        .open = Open::minimum,
                                        .summary = "Slip speed at which seven tenths of the friction act."};

constexpr Parameter speed_parameters[] = {
    {.name = "coefficient",
     .kind = ParameterKind::table,
     .minimum = 0.0,
     .summary = "Coefficient of friction over the speed of slip, straight between points, constant outside.",
     .variables = "speed: m/s"},
    speed_where_full,
};
constexpr Parameter distance_parameters[] = {
    {.name = "coefficient",
     .kind = ParameterKind::table,
     .minimum = 0.0,
     .summary = "Coefficient of friction over the distance slid, straight between points, constant outside.",
     .variables = "distance: m"},
    {.name = "slid",
     .unit = "m",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Distance that the surfaces have slid before the run."},
    speed_where_full,
};

struct Value {
  double at, slope;
};
/// Straight between points, constant outside.
Value between(const TablePoints& points, double x) {
  const std::size_t n = points.x.size;
  if (!(x > points.x[0])) return {points.y[0], 0.0};
  if (!(x < points.x[n - 1])) return {points.y[n - 1], 0.0};
  const auto k = static_cast<std::size_t>(std::upper_bound(points.x.begin(), points.x.end(), x) - points.x.begin());
  const double slope = (points.y[k] - points.y[k - 1]) / (points.x[k] - points.x[k - 1]);
  return {points.y[k - 1] + slope * (x - points.x[k - 1]), slope};
}
/// The points of a table whose x are not negative. The host keeps them as long as the law lives.
TablePoints points_of(const Parameters& p, const char* what) {
  const TablePoints points = p.table("coefficient");
  if (points.x[0] < 0.0) throw BadParameter("coefficient", 0, "out-of-range", std::string(what) + " is never negative");
  return points;
}
/// v/sqrt(v^2 + vs^2) and its slope.
Value direction(double slip, double full) {
  const double root = std::hypot(slip, full);
  return {slip / root, full * full / (root * root * root)};
}

/// F_T = -mu(|v|) F_N v/sqrt(v^2 + vs^2).
class FrictionOverSpeed final : public FrictionLaw {
 public:
  explicit FrictionOverSpeed(const Parameters& p)
      : coefficient_(points_of(p, "a speed of slip")), full_(p.number("vs")) {}

  FrictionForce evaluate(const FrictionState& s, Span<double>) const override {
    const Value mu = between(coefficient_, std::abs(s.slip_speed)), way = direction(s.slip_speed, full_);
    const double slope = mu.at * way.slope + std::copysign(mu.slope, s.slip_speed) * way.at;
    return {
        .tangential = -s.normal_force * mu.at * way.at, .d_normal = -mu.at * way.at, .d_slip = -s.normal_force * slope};
  }
  Span<const double> kinks() const override { return coefficient_.x; }

 private:
  TablePoints coefficient_;
  double full_;  // [m/s]
};

/// F_T = -mu(s) F_N v/sqrt(v^2 + vs^2), s' = |v|: surfaces that run in. The distance s outlives each contact.
class FrictionOverDistance final : public FrictionLaw {
 public:
  explicit FrictionOverDistance(const Parameters& p)
      : coefficient_(points_of(p, "a distance slid")), slid_(p.number("slid")), full_(p.number("vs")) {}

  int internal_variables() const override { return 1; }
  void memory(Span<double> start, Span<MemoryReset> resets) const override {
    start[0] = slid_;
    resets[0] = MemoryReset::never;
  }
  FrictionForce evaluate(const FrictionState& s, Span<double> rate) const override {
    rate[0] = std::abs(s.slip_speed);
    const double mu = between(coefficient_, s.internal[0]).at;
    const Value way = direction(s.slip_speed, full_);
    return {.tangential = -s.normal_force * mu * way.at,
            .d_normal = -mu * way.at,
            .d_slip = -s.normal_force * mu * way.slope};
  }
  Span<const double> kinks() const override {
    static constexpr double turning = 0.0;
    return {&turning, 1};
  }

 private:
  TablePoints coefficient_;
  double slid_, full_;  // [m], [m/s]
};

}  // namespace

FREEPLAY_PLUGIN(measured_friction) {
  static const Component components[] = {
      friction_law<FrictionOverSpeed>({.name = "friction-over-speed",
                                       .summary = "Coulomb friction with a measured coefficient over the speed.",
                                       .formula = "F_T = -mu(|v|) F_N v/sqrt(v^2 + vs^2)",
                                       .validity = "Sliding; at rest it creeps.",
                                       .parameters = speed_parameters}),
      friction_law<FrictionOverDistance>({.name = "friction-over-distance",
                                          .summary = "Coulomb friction of surfaces that run in.",
                                          .formula = "F_T = -mu(s) F_N v/sqrt(v^2 + vs^2), s' = |v|",
                                          .validity = "Sliding; at rest it creeps.",
                                          .parameters = distance_parameters}),
  };
  return publish(*host, *manifest, "measured_friction", "1.0.0", components);
}
