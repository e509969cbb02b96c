#include "run/dense_step.h"

#include <algorithm>

#include "run/event_finder.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

struct Moved {
  double q, v, a;
};

// The quintic of an increment at the fraction s of a step dt, from its derivatives at both ends and its value at the
// end: all three are sums of these with weights that depend on s alone.
class Quintic {
 public:
  // v0 x + a0 x^2/2 + s^3 (c3 + c4 s + c5 s^2) with x = s dt; of what is missing at the end, in q, dt v and dt^2 a,
  // c3 = 10 q - 4 v + a/2, c4 = -15 q + 7 v - a, c5 = 6 q - 3 v + a/2.
  Quintic(double s, double dt) {
    const double s2 = s * s, s3 = s2 * s;
    position_ = weights(s3 * (10.0 + s * (-15.0 + s * 6.0)), s3 * (-4.0 + s * (7.0 - s * 3.0)),
                        s3 * (0.5 + s * (-1.0 + s * 0.5)), s, 0.5 * s2, dt, 1.0);
    velocity_ = weights(s2 * (30.0 + s * (-60.0 + s * 30.0)), s2 * (-12.0 + s * (28.0 - s * 15.0)),
                        s2 * (1.5 + s * (-4.0 + s * 2.5)), 1.0, s, dt, dt);
    acceleration_ = weights(s * (60.0 + s * (-180.0 + s * 120.0)), s * (-24.0 + s * (84.0 - s * 60.0)),
                            s * (3.0 + s * (-12.0 + s * 10.0)), 0.0, 1.0, dt, dt * dt);
  }
  Moved operator()(double start_v, double start_a, double q, double end_v, double end_a) const {
    const auto sum = [&](const Weights& w) {
      return (w.q * q + w.start_v * start_v) + (w.start_a * start_a + w.end_v * end_v) + w.end_a * end_a;
    };
    return {sum(position_), sum(velocity_), sum(acceleration_)};
  }

 private:
  struct Weights {
    double q, start_v, start_a, end_v, end_a;
  };
  // Of what is missing, and of v0 and a0 themselves.
  static Weights weights(double q, double v, double a, double of_v0, double of_a0, double dt, double unit) {
    return {q / unit, (of_v0 - q - v) * dt / unit, (of_a0 - 0.5 * q - v - a) * dt * dt / unit, v * dt / unit,
            a * dt * dt / unit};
  }
  Weights position_, velocity_, acceleration_;
};

/// Increment of a body in space since `start` and its first two derivatives, from its coordinates, v and a.
struct SpatialIncrement {
  SpatialIncrement(const double* start, const double* q, const double* v, const double* a) {
    spatial::difference_body(start, q, moved);
    std::copy_n(v, 6, rate);
    std::copy_n(a, 6, acceleration);
    const spatial::Vector turned = spatial::vector(moved + 3), w = spatial::vector(v + 3);
    const spatial::Vector turned_rate = spatial::rotation_rate(turned, w);
    spatial::target(rate + 3) = turned_rate;
    spatial::target(acceleration + 3) =
        spatial::rotation_acceleration(turned, turned_rate, w, spatial::Vector(spatial::vector(a + 3)));
  }
  double moved[6], rate[6], acceleration[6];
};

}  // namespace

void DenseStep::bodies_in_space(double s, State& out) const {
  const double dt = end_.t() - start_.t();
  const Quintic quintic(s, dt);
  const InnerMotion::Weights inside(s);
  for (std::size_t b = 0; 6 * b < out.v().size(); ++b) {
    const double *v0 = &start_.v()[6 * b], *a0 = &start_.a()[6 * b];
    const SpatialIncrement end(&start_.q()[7 * b], &end_.q()[7 * b], &end_.v()[6 * b], &end_.a()[6 * b]);
    double moved[6], rate[6];
    for (std::size_t i = 0; i < 6; ++i) {
      const Moved at = quintic(v0[i], a0[i], end.moved[i], end.rate[i], end.acceleration[i]);
      moved[i] = at.q;
      rate[i] = at.v;
      if (inner_ != nullptr) {
        moved[i] += inner_->increment(inside.position, 6 * b + i);
        rate[i] += inner_->increment(inside.velocity, 6 * b + i) / dt;
      }
      out.a()[6 * b + i] = (1.0 - s) * a0[i] + s * end_.a()[6 * b + i];
    }
    spatial::retract_body(&start_.q()[7 * b], moved, &out.q()[7 * b]);
    spatial::target(rate + 3) =
        spatial::angular_velocity(spatial::vector(moved + 3), spatial::Vector(spatial::vector(rate + 3)));
    std::copy_n(rate, 6, &out.v()[6 * b]);
  }
}

void DenseStep::at(double s, State& out) const {
  const double dt = end_.t() - start_.t();
  out.t() = start_.t() + s * dt;
  const InnerMotion::Weights inside(s);
  if (space_ == Space::planar) {
    const Quintic quintic(s, dt);
    const std::span q = out.q(), v = out.v(), a = out.a();
    const std::span<const double> q0 = start_.q(), v0 = start_.v(), a0 = start_.a();
    const std::span<const double> q1 = end_.q(), v1 = end_.v(), a1 = end_.a();
    for (std::size_t i = 0; i < q.size(); ++i) {
      const Moved at = quintic(v0[i], a0[i], q1[i] - q0[i], v1[i], a1[i]);
      q[i] = q0[i] + at.q;
      v[i] = at.v;
      a[i] = at.a;
    }
    for (std::size_t i = 0; inner_ != nullptr && i < q.size(); ++i) {
      q[i] += inner_->increment(inside.position, i);
      v[i] += inner_->increment(inside.velocity, i) / dt;
      a[i] += inner_->increment(inside.acceleration, i) / (dt * dt);
    }
  } else {
    bodies_in_space(s, out);
  }
  for (std::size_t i = 0; i < out.lambda().size(); ++i) {
    out.lambda()[i] = (1.0 - s) * start_.lambda()[i] + s * end_.lambda()[i];
  }
  for (std::size_t i = 0; i < start_rate_.size(); ++i) {
    out.z()[i] = Hermite{start_.z()[i], dt * start_rate_[i], end_.z()[i], dt * end_rate_[i]}.at(s);
    if (inner_ != nullptr) out.z()[i] += inner_->internal(inside, i);
  }
  std::ranges::copy(start_.h(), out.h().begin());
}

void DenseStep::missing(double s, const State& solved, std::span<const double> rate, std::span<double> bends,
                        std::span<double> rates) const {
  const double dt = end_.t() - start_.t();
  const Quintic quintic(s, dt);
  const std::span<const double> v0 = start_.v(), a0 = start_.a();
  if (space_ == Space::planar) {
    for (std::size_t i = 0; i < bends.size(); ++i) {
      const Moved at = quintic(v0[i], a0[i], end_.q()[i] - start_.q()[i], end_.v()[i], end_.a()[i]);
      bends[i] = dt * dt * (solved.a()[i] - at.a);
    }
  } else {
    for (std::size_t b = 0; 6 * b < bends.size(); ++b) {
      const double* const start = &start_.q()[7 * b];
      const SpatialIncrement end(start, &end_.q()[7 * b], &end_.v()[6 * b], &end_.a()[6 * b]);
      const SpatialIncrement here(start, &solved.q()[7 * b], &solved.v()[6 * b], &solved.a()[6 * b]);
      for (std::size_t i = 0; i < 6; ++i) {
        const Moved at = quintic(v0[6 * b + i], a0[6 * b + i], end.moved[i], end.rate[i], end.acceleration[i]);
        bends[6 * b + i] = dt * dt * (here.acceleration[i] - at.a);
      }
    }
  }
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Hermite cubic{start_.z()[i], dt * start_rate_[i], end_.z()[i], dt * end_rate_[i]};
    rates[i] = dt * rate[i] - cubic.slope(s);
  }
}

}  // namespace freeplay
