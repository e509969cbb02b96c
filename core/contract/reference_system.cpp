#include "contract/reference_system.h"

#include <cmath>

#include "freeplay/plugin.h"

namespace freeplay {
namespace {

constexpr double mass = 1.3, inertia = 0.02, gravity = 9.81, arm = 0.4;
// Frequencies of 6 to 9 rad/s, so that a second holds about one period and a step of 1/160 s about 1/160 of it.
constexpr double stiffness = 60.0, turning_stiffness = 1.6, relaxing = 20.0, relaxation_time = 0.15;
constexpr double drive = 8.0, drive_frequency = 5.0;

/// Force on b, with a on ground at the origin, s = P_b, one internal variable z:
///   F_x = -k x - k_r (x - z) + f sin(w t), z' = (x - z)/tau,   F_y = -k y,   M = -k_t theta
class Holder final : public Joint {
 public:
  void declare(JointLayout& layout) const override {
    layout.internal_variables = 1;
    layout.forces = 1;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const double x = in.b->position[0], y = in.b->position[1], z = in.internal[0];
    const double angle = std::atan2(in.b->rotation[3], in.b->rotation[0]);
    out.wrench_b[0] = -stiffness * x - relaxing * (x - z) + drive * std::sin(drive_frequency * in.t);
    out.wrench_b[1] = -stiffness * y;
    out.wrench_b[5] = -turning_stiffness * angle;
    out.internal_rate[0] = (x - z) / relaxation_time;
  }
};

/// P_b - P_a = 0 in the plane.
class Hinge final : public Joint {
 public:
  void declare(JointLayout& layout) const override { layout.constraint_rows = 2; }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    for (std::size_t i = 0; i < 2; ++i) {
      rows.phi[i] = in.b->position[i] - in.a->position[i];
      rows.jacobian[12 * i + i] = -1.0;
      rows.jacobian[12 * i + 6 + i] = 1.0;
    }
  }
};

template <class J>
JointElement element(const J& joint) {
  JointElement element;
  element.name = "held";
  element.joint = JointRef(abi::joint_table<J>, &joint);
  joint.declare(element.layout);
  element.marker_a = 0;
  element.marker_b = 1;
  return element;
}

}  // namespace

struct ReferenceSystem::Parts {
  Holder holder;
  Hinge hinge;
};

ReferenceSystem::ReferenceSystem(Kind kind)
    : kind_(kind), parts_(std::make_unique<Parts>()), model_(std::make_unique<Model>()) {
  Body body;
  body.name = "body";
  body.mass = mass;
  body.inertia[8] = inertia;
  model_->bodies.push_back(body);
  model_->markers.resize(2);
  model_->markers[0].name = "ground/origin";
  model_->markers[1].name = "body/end";
  model_->markers[1].body = 0;
  if (kind == Kind::oscillator) {
    build_oscillator();
  } else {
    build_pendulum();
  }
  system_ = std::make_unique<System>(*model_);
}

ReferenceSystem::~ReferenceSystem() = default;

void ReferenceSystem::build_oscillator() {
  name_ = "oscillator";
  model_->joints.push_back(element(parts_->holder));
  first_ = {0.3, -0.2, 0.4, 0.5, 0.7, -1.1, 0.1};  // x, y, theta, their rates, z
}

void ReferenceSystem::build_pendulum() {
  name_ = kind_ == Kind::pendulum ? "pendulum" : "hanging pendulum";
  model_->bodies[0].gravity = {0.0, -gravity, 0.0};
  model_->markers[1].position = {0.0, arm, 0.0};
  model_->joints.push_back(element(parts_->hinge));
  first_ = kind_ == Kind::pendulum ? std::vector<double>{1.2, 0.6} : std::vector<double>{0.0, 0.0};  // angle, rate
}

// y' of the reference equations: for the pendulum (I + m L^2) theta'' = -m g L sin(theta).
std::vector<double> ReferenceSystem::rate(const std::vector<double>& y, double t) const {
  if (kind_ != Kind::oscillator) {
    return {y[1], -mass * gravity * arm * std::sin(y[0]) / (inertia + mass * arm * arm)};
  }
  const double force = -stiffness * y[0] - relaxing * (y[0] - y[6]) + drive * std::sin(drive_frequency * t);
  return {y[3],
          y[4],
          y[5],
          force / mass,
          -stiffness * y[1] / mass,
          -turning_stiffness * y[2] / inertia,
          (y[0] - y[6]) / relaxation_time};
}

KnownState ReferenceSystem::known(const std::vector<double>& y, double t) const {
  if (kind_ == Kind::oscillator) return {{y[0], y[1], y[2]}, {y[3], y[4], y[5]}, {}, {y[6]}};
  // The centre of mass hangs at distance L below the hinge; the force on the body is -lambda = m (a - g).
  const double s = std::sin(y[0]), c = std::cos(y[0]), w = y[1], acceleration = rate(y, t)[1];
  const double ax = arm * (c * acceleration - s * w * w), ay = arm * (s * acceleration + c * w * w);
  return {{arm * s, -arm * c, y[0]}, {arm * c * w, arm * s * w, w}, {-mass * ax, -mass * (ay + gravity)}, {}};
}

std::vector<KnownState> ReferenceSystem::motion(double dt, int steps) const {
  // The rule's error is (w h)^4/100: rounding at h = 1e-4 s.
  const int parts = static_cast<int>(std::ceil(dt / 1e-4));
  const double h = dt / parts;
  const auto moved = [](const std::vector<double>& y, const std::vector<double>& k, double by) {
    std::vector<double> result = y;
    for (std::size_t i = 0; i < y.size(); ++i) result[i] += by * k[i];
    return result;
  };
  std::vector<double> y = first_;
  std::vector<KnownState> states{start()};
  for (int n = 0; n < steps; ++n) {
    for (int p = 0; p < parts; ++p) {
      const double t = n * dt + p * h;
      const std::vector<double> k1 = rate(y, t), k2 = rate(moved(y, k1, 0.5 * h), t + 0.5 * h);
      const std::vector<double> k3 = rate(moved(y, k2, 0.5 * h), t + 0.5 * h), k4 = rate(moved(y, k3, h), t + h);
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
    states.push_back(known(y, (n + 1) * dt));
  }
  return states;
}

double ReferenceSystem::energy(std::span<const double> q, std::span<const double> v) const {
  return system_->inertia().kinetic_energy(v) + system_->inertia().gravity_potential(q);
}

}  // namespace freeplay
