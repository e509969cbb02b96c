// Points of one body before flat walls of another in space, any number of them: their kinematics, and friction there.
#pragma once

#include "freeplay/kit/contacts.h"
#include "rotation_vector.h"
#include "spatial_play.h"

namespace freeplay::play {

using space::PairInFirstAxes;
using space::RelativeMotion;

/// By how much a turn by the rotation vector rho moves a vector s that is fixed in b, without the loss of digits of a
/// difference; axes of marker a, theta = |rho|:
///
///   R s - s = sin(theta)/theta rho x s + (1 - cos(theta))/theta^2 rho x (rho x s)
template <class T>
class Turn {
 public:
  explicit Turn(const Vec<T>& rho) : rho_(rho) {
    const T square = dot(rho, rho);
    const Shares shares(space::value_of(square));
    sine_ = space::chained(shares.sine, shares.sine_slope, square, 0.0, square);
    sag_ = space::chained(shares.sag, shares.sag_slope, square, 0.0, square);
  }
  Vec<T> change(const Vec<double>& s) const {
    const Vec<T> across = cross(rho_, Vec<T>{T(s.x), T(s.y), T(s.z)});
    return sine_ * across + sag_ * cross(rho_, across);
  }

 private:
  /// sin(theta)/theta and (1 - cos(theta))/theta^2 as functions of theta^2, and their slopes.
  struct Shares {
    explicit Shares(double square) {
      if (square < 0.01) {  // the closed forms of the slopes lose their digits
        const auto series = [&](double first, double k) {
          const double x = square;
          return 1.0 / first *
                 (1.0 - x / (k * (k + 1.0)) *
                            (1.0 - x / ((k + 2.0) * (k + 3.0)) *
                                       (1.0 - x / ((k + 4.0) * (k + 5.0)) * (1.0 - x / ((k + 6.0) * (k + 7.0))))));
        };
        sine = series(1.0, 2.0), sag = series(2.0, 3.0);
        // d/dx of the same: -1/3! + 2 x/5! - 3 x^2/7! + ..., -1/4! + 2 x/6! - ...
        sine_slope = -1.0 / 6.0 +
                     square * (1.0 / 60.0 - square * (1.0 / 1680.0 - square * (1.0 / 90720.0 - square / 7983360.0)));
        sag_slope = -1.0 / 24.0 +
                    square * (1.0 / 360.0 - square * (1.0 / 13440.0 - square * (1.0 / 907200.0 - square / 95800320.0)));
        return;
      }
      const double theta = std::sqrt(square), half = std::sin(0.5 * theta);
      sine = std::sin(theta) / theta;
      sag = 2.0 * half * half / square;
      sine_slope = (std::cos(theta) - sine) / (2.0 * square);
      sag_slope = (sine - 2.0 * sag) / (2.0 * square);
    }
    double sine, sag, sine_slope, sag_slope;
  };
  Vec<T> rho_;
  T sine_, sag_;
};

/// How b stands and moves against a, in the axes of a, with its turn.
template <class T>
struct TurnedMotion : RelativeMotion<T> {
  explicit TurnedMotion(const RelativeMotion<T>& m) : RelativeMotion<T>(m), turn(m.r) {}
  Turn<T> turn;
};

/// A point of b before a wall of a, in the axes of a.
template <class T>
struct WallPlace {
  T penetration{};     ///< delta, written so that it keeps its digits near zero [m]
  Vec<double> normal;  ///< unit, fixed in a, along which b pushes a
  Vec<T> arm;          ///< from P_b to the point, where both forces act [m]
};

/// The kinematics that follow, v the velocity of b less that of a at the point: delta' = n.v, v_T = v - delta' n.
template <class T>
struct WallContact : WallPlace<T> {
  WallContact() = default;
  WallContact(const WallPlace<T>& place, const RelativeMotion<T>& m)
      : WallPlace<T>(place),
        n{T(place.normal.x), T(place.normal.y), T(place.normal.z)},
        from_a(m.d + place.arm),
        velocity(m.u + cross(m.w_b, place.arm) - cross(m.w_a, from_a)),
        rate(dot(n, velocity)),
        slip(velocity - rate * n) {}
  Vec<T> n, from_a, velocity;
  T rate{};
  Vec<T> slip;
  Approach approach() const { return {space::value_of(this->penetration), space::value_of(rate)}; }
};

/// How bodies move against each other in space, by the rotation vector of b in a, and what friction is there: a vector
/// in the plane of the wall.
struct BeforeWalls {
  static constexpr bool planar = false;
  static constexpr std::size_t most_memory = std::size_t{3} * most_law_variables;
  using Laws = SpatialLaws;
  using Memory = play::Memory;
  using Dual = space::Dual;
  template <class T>
  using Motion = TurnedMotion<T>;
  template <class T>
  using Contact = WallContact<T>;
  using Sideways = Vec<double>;
  template <class T>
  struct Force : space::RelativeForce<T> {
    void add(const Vec<T>& f, const WallContact<T>& at) {
      this->force = this->force + f;
      this->moment_a = this->moment_a - cross(at.from_a, f);
      this->moment_b = this->moment_b + cross(at.arm, f);
    }
  };
  class Pair : public PairInFirstAxes {
   public:
    explicit Pair(const JointInput& in)
        : PairInFirstAxes(PairInFirstAxes::with_rotation_vector(in)), motion_(PairInFirstAxes::numbers()) {}
    const TurnedMotion<double>& numbers() const { return motion_; }
    TurnedMotion<Dual> duals() const { return TurnedMotion<Dual>(PairInFirstAxes::duals()); }

   private:
    TurnedMotion<double> motion_;
  };

  template <class T>
  static Vec<T> friction(const Laws& laws, const T& normal, const WallContact<T>& at, const Memory& memory,
                         Span<T> rates) {
    if (!laws.slides) return {};
    if (laws.memory() == 0) return laws.friction_force(normal, at.slip);
    const auto z = memory.numbers<T>();
    return laws.friction_force<T>(normal, at.slip, at.n, {}, {z.data(), memory.size}, rates);
  }
  template <class T>
  static Vec<T> force(const WallContact<T>& at, const T& normal, const Vec<T>& friction) {
    return friction - normal * at.n;
  }
  /// Size of a tangential vector with the sign of its part along x of a.
  static double signed_size(const Vec<double>& v) { return std::copysign(std::sqrt(dot(v, v)), v.x); }
  static double power(const Vec<double>& force, const Vec<double>& slip) { return dot(force, slip); }
  static double direction(const Pair&, const WallContact<double>& at) { return std::atan2(at.normal.z, at.normal.y); }
  /// 1/m = w.(W w) of the wrench w on b at its origin for a unit normal force.
  static double inverse_mass(const Pair& pair, const WallContact<double>& at, const double* mobility) {
    const Eigen::Vector3d n(at.normal.x, at.normal.y, at.normal.z), arm(at.arm.x, at.arm.y, at.arm.z);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << pair.axes() * n, pair.axes() * arm.cross(n);
    return wrench.dot(Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(mobility) * wrench);
  }

  /// The force of a contact with its derivatives; writes those of its internal variables and by them.
  static Vec<Dual> differentiate(const LoadedContact<BeforeWalls>& one, const Pair& pair, const WallContact<Dual>& at,
                                 JointForces& out) {
    std::array<Dual, most_memory> rates;
    const ContactForce& law = one.normal;
    const Dual normal = space::chained(law.normal, law.d_penetration, at.penetration, law.d_rate, at.rate);
    const Vec<Dual> sideways = friction<Dual>(one.laws, normal, at, one.memory, {rates.data(), one.memory.size});
    if (one.memory.size > 0 && one.laws.slides) {
      for (std::size_t k = 0; k < one.memory.size; ++k)
        pair.write_rate_derivatives(one.first + k, rates[k], static_cast<Eigen::Index>(one.columns), out);
      differentiate_memory(one, pair, out);
    }
    return Dual(one.share) * force(at, normal, sideways);
  }
  static void write_derivatives(const Pair& pair, const Force<Dual>& f, std::size_t columns, JointForces& out) {
    pair.write_derivatives(f, static_cast<Eigen::Index>(columns), out);
  }

  /// At least the length.
  static double most_of(const Vec<double>& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }
  static double size_of(const Vec<double>& v) { return std::hypot(v.x, v.y, v.z); }
  template <class Use>
  static Eigen::Vector3d each_of(const Vec<Dual>& v, const Use& use) {
    return {use(v.x), use(v.y), use(v.z)};
  }

 private:
  static void differentiate_memory(const LoadedContact<BeforeWalls>& one, const Pair& pair, JointForces& out) {
    differentiate_by_memory(one.laws, one.normal.normal, one.at.slip, one.at.n, {}, one.memory,
                            [&](std::size_t j, const Vec<double>& by, Span<const double> rate_by) {
                              Force<double> part{};
                              part.add(one.share * by, one.at);
                              pair.write_internal_column(one.first + j, part, static_cast<Eigen::Index>(one.columns),
                                                         out);
                              for (std::size_t k = 0; k < one.memory.size; ++k)
                                out.derivatives[(12 + one.first + k) * one.columns + 24 + one.first + j] = rate_by[k];
                            });
  }
};

/// A joint of spatial models whose contacts stand where `Geometry` says: see Contacts, with WallPlace and TurnedMotion.
template <class Geometry>
class WallContacts : public Contacts<Geometry, BeforeWalls> {
 public:
  using Contacts<Geometry, BeforeWalls>::Contacts;
};

}  // namespace freeplay::play
