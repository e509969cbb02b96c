// A force element or a joint with play in space: its answers at two markers, and what holds for all of them.
#pragma once

#include "spatial_joint.h"

namespace freeplay::test {

/// A joint in space with its share of h.
class SpatialForce {
 public:
  SpatialForce(const Component& row, const ParameterStub& stub)
      : contact_(stub.contact), friction_(stub.friction), joint_(row, stub) {
    layout.space = Space::spatial;
    joint_.call(&abi::JointTable::declare, &layout);
    h.resize(static_cast<std::size_t>(layout.history));
  }
  JointInput in(double t = 0.0) const { return input(t, a, b, {}, {h.data(), h.size()}); }

  Wrenches apply(std::vector<double>* derivatives = nullptr) const {
    JointForces f{};
    if (derivatives) {
      derivatives->assign(12 * 24, 0.0);
      f.derivatives = {derivatives->data(), derivatives->size()};
    }
    JointInput i = in();
    if (layout.coordinate != Coordinate::none) i.coordinate = coordinate_row(joint_, a, b).value;
    joint_.call(&abi::JointTable::apply, &i, &f);
    potential = f.potential;
    potential_rate = f.potential_rate;
    Wrenches w;
    for (int k = 0; k < 6; ++k) {
      w[k] = f.wrench_a[k];
      w[6 + k] = f.wrench_b[k];
    }
    return w;
  }
  std::vector<double> observe() const {
    std::vector<double> channels(layout.channels.size);
    const JointInput i = in();
    joint_.call(&abi::JointTable::observe, &i, Span<const double>(), Span<double>(channels.data(), channels.size()));
    return channels;
  }
  std::array<double, 8> on_event(int index, double t = 0.0) {
    std::array<double, 8> fields{};
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::on_event, index, &i, Span<double>(), Span<double>(h.data(), h.size()),
                Span<double>(fields.data(), 8));
    return fields;
  }
  void begin_step(double dt, const MarkerAccelerations& acc) {
    const JointInput i = in();
    joint_.call(&abi::JointTable::begin_step, &i, &acc, dt, Span<double>(h.data(), h.size()));
  }
  std::pair<std::vector<double>, std::vector<double>> events() const {
    std::vector<double> g(layout.events.size), rate(layout.events.size);
    const JointInput i = in();
    joint_.call(&abi::JointTable::events, &i, Span<double>(g.data(), g.size()), Span<double>(rate.data(), rate.size()));
    return {g, rate};
  }
  InitialOffset offset(const Vector3d& load, const RowMajor3& axes) const {
    InitialOffset out{};
    out.rotation = axes.data();
    joint_.call(&abi::JointTable::initial_offset, Span<const double>(load.data(), 3), &out);
    return out;
  }
  /// Of force and moment, where a stands.
  InitialOffset offset(const Eigen::Matrix<double, 6, 1>& load) const {
    InitialOffset out{};
    out.rotation = a.rotation;
    out.a = &a;
    out.b = &b;
    joint_.call(&abi::JointTable::initial_offset, Span<const double>(load.data(), 6), &out);
    return out;
  }
  double power() const { return apply().dot(twists(a, b)); }

  JointLayout layout;
  MarkerKinematics a = marker({0, 0, 0}, Matrix3d::Identity()), b = a;
  std::vector<double> h;
  mutable double potential = 0.0, potential_rate = 0.0;

 private:
  std::shared_ptr<ContactLaw> contact_;
  std::shared_ptr<FrictionLaw> friction_;
  JointInstance joint_;
};

/// No resultant force, and no moment about any point.
inline void expect_balance(const SpatialForce& f) {
  const Wrenches w = f.apply();
  const Vector3d force_a = w.segment<3>(0), moment_a = w.segment<3>(3), force_b = w.segment<3>(6),
                 moment_b = w.segment<3>(9), point(0.7, -0.4, 0.2);
  EXPECT_EQ((force_a + force_b).norm(), 0.0);
  const Vector3d rest = moment_a + (vector3(f.a.position) - point).cross(force_a) + moment_b +
                        (vector3(f.b.position) - point).cross(force_b);
  EXPECT_NEAR(rest.norm(), 0.0, 1e-13 * (1.0 + force_a.norm() + moment_a.norm()));
}

/// Another observer sees the same wrenches, turned.
inline void expect_same_for_another_observer(SpatialForce& f, double tolerance) {
  const Observer observer;
  const Wrenches w = f.apply();
  const MarkerKinematics a = f.a, b = f.b;
  f.a = observer.sees(a);
  f.b = observer.sees(b);
  const Wrenches seen = f.apply();
  f.a = a;
  f.b = b;
  for (int k = 0; k < 4; ++k) {
    const Vector3d expected = observer.turned * w.segment<3>(3 * k), found = seen.segment<3>(3 * k);
    EXPECT_NEAR((found - expected).norm(), 0.0, tolerance * (1.0 + expected.norm()));
  }
}

/// All 24 columns against differences of fourth order. `shift`: step of positions [m].
inline void expect_derivatives(SpatialForce& f, double shift, double relative) {
  std::vector<double> given;
  f.apply(&given);
  const MarkerKinematics a = f.a, b = f.b;
  for (std::size_t column = 0; column < 24; ++column) {
    const double step = column >= 12 ? 1e-6 : column % 6 < 3 ? shift : 1e-6;
    const auto at = [&](double by) {
      MarkerKinematics& m = column / 6 % 2 == 0 ? f.a : f.b;
      const std::size_t axis = column % 6;
      if (column >= 12) {
        (axis < 3 ? m.velocity[axis] : m.angular_velocity[axis - 3]) += by;
      } else if (axis < 3) {
        m.position[axis] += by;
      } else {
        const Matrix3d turned = turn(by * Vector3d::Unit(static_cast<int>(axis) - 3)) * rotation(m);
        Eigen::Map<RowMajor3>(m.rotation) = turned;
      }
      const Wrenches w = f.apply();
      f.a = a;
      f.b = b;
      return w;
    };
    const Wrenches slope = (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
    for (std::size_t r = 0; r < 12; ++r) {
      double largest = 0.0;  // of forces or moments in this block of columns
      for (std::size_t i = 3 * (r / 3); i < 3 * (r / 3) + 3; ++i)
        for (std::size_t k = 3 * (column / 3); k < 3 * (column / 3) + 3; ++k)
          largest = std::max(largest, std::abs(given[24 * i + k]));
      // The floor: what a stiff contact makes of the rounding of its penetration, over the step.
      EXPECT_NEAR(given[24 * r + column], slope[static_cast<int>(r)], relative * largest + 1e-5)
          << "row " << r << " column " << column;
    }
  }
}

}  // namespace freeplay::test
