#include "run/dense_step.h"

#include <algorithm>

#include "run/event_finder.h"

namespace freeplay {

void DenseStep::at(double s, State& out) const {
  const double dt = end_.t() - start_.t(), s2 = s * s, s3 = s2 * s;
  out.t() = start_.t() + s * dt;
  for (std::size_t i = 0; i < out.q().size(); ++i) {
    // q = q0 + v0 x + a0 x^2/2 + s^3 (c3 + c4 s + c5 s^2) with x = s dt, from what is missing at the end.
    const double v0 = dt * start_.v()[i], a0 = dt * dt * start_.a()[i];
    const double q = end_.q()[i] - start_.q()[i] - v0 - 0.5 * a0;
    const double v = dt * end_.v()[i] - v0 - a0, a = dt * dt * end_.a()[i] - a0;
    const double c3 = 10.0 * q - 4.0 * v + 0.5 * a, c4 = -15.0 * q + 7.0 * v - a, c5 = 6.0 * q - 3.0 * v + 0.5 * a;
    out.q()[i] = start_.q()[i] + s * v0 + 0.5 * s2 * a0 + s3 * (c3 + s * (c4 + s * c5));
    out.v()[i] = (v0 + s * a0 + s2 * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5))) / dt;
    out.a()[i] = (a0 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (dt * dt);
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
