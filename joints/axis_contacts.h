// Contacts at ends of the way of a joint: their kinematics, in the plane and in space.
#pragma once

#include "axis_force.h"
#include "freeplay/kit/contact_memory.h"
#include "freeplay/kit/contacts.h"

namespace freeplay::play {

/// How far along or about the axis of a joint marker b stands, and what a unit effort on it is, in the axes of a.
template <class T>
struct AxisPlace : space::AxisMotion<T> {
  space::Vec<T> d;  ///< P_b - P_a [m]
};

/// One end: penetration = lever (+-(s - end)), its rate = lever (+-s'). A lever of a turn is the distance of what
/// touches from the axis, so that laws work in metres; that of a slide is 1.
template <class T>
struct EndPlace {
  T penetration{};  ///< [m]
  T lever{};        ///< with the sign of the end: 1 or a length [m]
};

template <class T>
struct EndContact : EndPlace<T> {
  EndContact() = default;
  EndContact(const EndPlace<T>& place, const AxisPlace<T>& m)
      : EndPlace<T>(place), at(m), rate(place.lever * m.rate), velocity{rate, T(0.0), T(0.0)} {}
  AxisPlace<T> at;
  T rate{};
  space::Vec<T> velocity;
  double slip = 0.0;
  Approach approach() const { return {space::value_of(this->penetration), space::value_of(rate)}; }
};

struct EndLaws {
  ContactLawRef normal;
  static std::size_t memory() { return 0; }
  static double start_of(std::size_t) { return 0.0; }
  static bool forgets(std::size_t) { return true; }
  std::int32_t count_kinks() const { return normal.switches(); }
  void write_kinks(const Approach& gap, double, const JointInput& in, Span<double> g) const {
    normal.decide({gap.penetration, gap.rate, in.history[approach_speed]}, g);
  }
};

/// An effort -lever F_N along or about the axis, without friction: a force at P_b, or a torque on both bodies.
template <bool slides>
struct AlongAxis {
  static constexpr bool planar = false;
  static constexpr std::size_t most_memory = 1;
  using Laws = EndLaws;
  using Memory = MemoryOf<most_memory>;
  using Dual = space::Dual;
  template <class T>
  using Motion = AxisPlace<T>;
  template <class T>
  using Contact = EndContact<T>;
  using Sideways = double;
  template <class T>
  struct Force : space::RelativeForce<T> {
    void add(const space::Vec<T>& pull, const EndContact<T>& contact) {
      if constexpr (slides) {
        this->force = this->force + pull;
        this->moment_a = this->moment_a - cross(contact.at.d, pull);
      } else {
        this->moment_a = this->moment_a - pull;
        this->moment_b = this->moment_b + pull;
      }
    }
  };
  class Pair : public space::PairInFirstAxes {
   public:
    explicit Pair(const JointInput& in)
        : PairInFirstAxes(slides ? PairInFirstAxes(in, space::Vector3d::Zero(), Eigen::Matrix3d::Zero())
                                 : PairInFirstAxes::with_axis(in, 0)),
          angle_(in.coordinate),
          place_(place(PairInFirstAxes::numbers())) {}
    const AxisPlace<double>& numbers() const { return place_; }
    AxisPlace<Dual> duals() const { return place(PairInFirstAxes::duals()); }

   private:
    template <class T>
    AxisPlace<T> place(const space::RelativeMotion<T>& x) const {
      return {slides ? space::slide_along_x(x) : space::turn_about_z(x, angle_), x.d};
    }
    double angle_;
    AxisPlace<double> place_;
  };

  static double friction(const Laws&, double, const EndContact<double>&, const Memory&, Span<double>) { return 0.0; }
  template <class T>
  static space::Vec<T> force(const EndContact<T>& contact, const T& normal, double) {
    return -(contact.lever * normal * contact.at.u);
  }
  static double signed_size(double x) { return x; }
  static double power(double, double) { return 0.0; }
  static double direction(const Pair&, const EndContact<double>&) { return std::numeric_limits<double>::quiet_NaN(); }
  /// 1/m = w.(W w) of the wrench w on b at its origin for a unit normal force.
  static double inverse_mass(const Pair& pair, const EndContact<double>& contact, const double* mobility) {
    const space::Vec<double> pull = contact.lever * contact.at.u;
    Eigen::Matrix<double, 6, 1> wrench = Eigen::Matrix<double, 6, 1>::Zero();
    wrench.segment<3>(slides ? 0 : 3) = pair.axes() * Eigen::Vector3d(pull.x, pull.y, pull.z);
    return wrench.dot(Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(mobility) * wrench);
  }
  static space::Vec<Dual> differentiate(const LoadedContact<AlongAxis>& one, const Pair&,
                                        const EndContact<Dual>& contact, JointForces&) {
    const ContactForce& law = one.normal;
    return force(contact, space::chained(law.normal, law.d_penetration, contact.penetration, law.d_rate, contact.rate),
                 0.0);
  }
  static void write_derivatives(const Pair& pair, const Force<Dual>& f, std::size_t columns, JointForces& out) {
    pair.write_derivatives(f, static_cast<Eigen::Index>(columns), out);
  }

  template <class Use>
  static Eigen::Matrix<double, 1, 1> each_of(const space::Vec<Dual>& v, const Use& use) {
    return Eigen::Matrix<double, 1, 1>(use(v.x));
  }
};

/// Both ends of a way, the upper one first.
template <bool slides>
struct WayEnds {
  static constexpr std::size_t contacts = 2;

  template <class T>
  EndPlace<T> place(const AxisPlace<T>& m, std::size_t i) const {
    const double signed_lever = i == 0 ? lever : -lever;
    return {T(signed_lever) * (m.value - T(i == 0 ? upper : lower)), T(signed_lever)};
  }
  static std::array<double, 0> stand(const AxisPlace<double>&) { return {}; }
  static constexpr bool between_walls() { return false; }

  double lower, upper, lever;  ///< [m], or [rad] and the distance from the axis [m]
  double play;                 ///< the way [m]
};

}  // namespace freeplay::play
