#include "run/dense_step.h"

#include <algorithm>

#include "run/event_finder.h"

namespace freeplay {
namespace {

struct Moved {
  double q, v, a;
};

// The quintic of an increment at s, from its derivatives at both ends and its value `q` at the end.
Moved quintic(double s, double dt, double start_v, double start_a, double q, double end_v, double end_a) {
  const double s2 = s * s, s3 = s2 * s;
  // v0 x + a0 x^2/2 + s^3 (c3 + c4 s + c5 s^2) with x = s dt, from what is missing at the end.
  const double v0 = dt * start_v, a0 = dt * dt * start_a;
  q = q - v0 - 0.5 * a0;
  const double v = dt * end_v - v0 - a0, a = dt * dt * end_a - a0;
  const double c3 = 10.0 * q - 4.0 * v + 0.5 * a, c4 = -15.0 * q + 7.0 * v - a, c5 = 6.0 * q - 3.0 * v + 0.5 * a;
  return {s * v0 + 0.5 * s2 * a0 + s3 * (c3 + s * (c4 + s * c5)),
          (v0 + s * a0 + s2 * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5))) / dt,
          (a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (dt * dt)};
}

}  // namespace

void DenseStep::bodies_in_space(double s, State& out) const {
  using spatial::Vector;
  const double dt = end_.t() - start_.t();
  for (std::size_t b = 0; 6 * b < out.v().size(); ++b) {
    const double *v0 = &start_.v()[6 * b], *a0 = &start_.a()[6 * b];
    double end[6], end_v[6], end_a[6], moved[6], rate[6];
    spatial::difference_body(&start_.q()[7 * b], &end_.q()[7 * b], end);
    std::copy_n(&end_.v()[6 * b], 6, end_v);
    std::copy_n(&end_.a()[6 * b], 6, end_a);
    const Vector turned = spatial::vector(end + 3), w = spatial::vector(end_v + 3), alpha = spatial::vector(end_a + 3);
    const Vector turned_rate = spatial::rotation_rate(turned, w);
    spatial::target(end_v + 3) = turned_rate;
    spatial::target(end_a + 3) = spatial::rotation_acceleration(turned, turned_rate, w, alpha);
    for (std::size_t i = 0; i < 6; ++i) {
      const Moved at = quintic(s, dt, v0[i], a0[i], end[i], end_v[i], end_a[i]);
      moved[i] = at.q;
      rate[i] = at.v;
      out.a()[6 * b + i] = (1.0 - s) * a0[i] + s * end_.a()[6 * b + i];
    }
    spatial::retract_body(&start_.q()[7 * b], moved, &out.q()[7 * b]);
    spatial::target(rate + 3) =
        spatial::angular_velocity(spatial::vector(moved + 3), Vector(spatial::vector(rate + 3)));
    std::copy_n(rate, 6, &out.v()[6 * b]);
  }
}

void DenseStep::at(double s, State& out) const {
  const double dt = end_.t() - start_.t();
  out.t() = start_.t() + s * dt;
  if (system_.model().space == Space::planar) {
    for (std::size_t i = 0; i < out.q().size(); ++i) {
      const Moved at =
          quintic(s, dt, start_.v()[i], start_.a()[i], end_.q()[i] - start_.q()[i], end_.v()[i], end_.a()[i]);
      out.q()[i] = start_.q()[i] + at.q;
      out.v()[i] = at.v;
      out.a()[i] = at.a;
    }
  } else {
    bodies_in_space(s, out);
  }
  for (std::size_t i = 0; i < out.lambda().size(); ++i) {
    out.lambda()[i] = (1.0 - s) * start_.lambda()[i] + s * end_.lambda()[i];
  }
  for (std::size_t i = 0; i < start_rate_.size(); ++i) {
    out.z()[i] = Hermite{start_.z()[i], dt * start_rate_[i], end_.z()[i], dt * end_rate_[i]}.at(s);
  }
  std::ranges::copy(start_.h(), out.h().begin());
}

}  // namespace freeplay
