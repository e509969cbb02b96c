// Contacts of a joint with play in the plane, any number of them: a joint says where they are, all else is here.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "freeplay/kit/contact_memory.h"
#include "freeplay/kit/contacts.h"
#include "freeplay/kit/friction_slopes.h"
#include "freeplay/kit/planar_pair.h"

namespace freeplay::play {

/// Laws of all contacts of a joint. Throws BadParameter.
struct PlanarLaws {
  PlanarLaws(const Parameters& p, const ContactPair& pair)
      : PlanarLaws(p.contact_law("clearance.contact", pair), p.friction_law("clearance.friction")) {}
  PlanarLaws(const ContactLawRef& contact_law, const FrictionLawRef& friction_law)
      : normal(contact_law), friction(friction_law) {
    if (friction.internal_variables() > static_cast<int>(most_internal_variables))
      throw BadParameter("clearance.friction", "out-of-range",
                         "this law has more internal variables than the joint keeps");
    rules = MemoryRules<most_internal_variables>(friction);
    variables = rules.size;
  }
  /// Internal variables of one contact.
  std::size_t memory() const { return variables; }
  double start_of(std::size_t k) const { return rules.start[k]; }
  bool forgets(std::size_t k) const { return rules.forgets(k); }
  /// Of one contact: where its laws have kinks.
  std::int32_t count_kinks() const { return play::count_kinks(normal, friction); }
  void write_kinks(const Approach& gap, double slip, const JointInput& in, Span<double> g) const {
    play::write_kinks(normal, friction, gap, slip, in, g);
  }
  ContactLawRef normal;
  FrictionLawRef friction;
  std::size_t variables = 0;
  MemoryRules<most_internal_variables> rules;
};

/// How bodies move against each other in the plane, and what friction is there: F_T t along the tangent t.
struct InPlane {
  static constexpr bool planar = true;
  static constexpr std::size_t most_memory = most_internal_variables;
  using Laws = PlanarLaws;
  using Memory = MemoryOf<most_memory>;
  using Pair = PlanarPair;
  using Dual = PlanarPair::Dual;
  template <class T>
  using Motion = PlanarMotion<T>;
  template <class T>
  using Contact = PlanarContact<T>;
  template <class T>
  using Force = PlanarPair::Force<T>;
  using Sideways = double;

  static double friction(const Laws& laws, double normal, const PlanarContact<double>& at, const Memory& memory,
                         Span<double> rates) {
    return laws.friction.evaluate({normal, at.slip, memory}, rates).tangential;
  }
  template <class T>
  static Vec2<T> force(const PlanarContact<T>& at, const T& normal, const T& tangential) {
    return tangential * at.tangent - normal * at.normal;
  }
  /// What the memory of friction stores, and how fast that grows with these rates.
  static Stored stored(const Laws& laws, const Memory& memory, Span<const double> rates) {
    double slopes[most_memory];
    Stored all{laws.friction.stored(memory, {slopes, memory.size}), 0.0};
    for (std::size_t k = 0; k < memory.size; ++k) all.rate += slopes[k] * rates[k];
    return all;
  }
  static double signed_size(double along) { return along; }
  static double power(double force, double slip) { return force * slip; }
  static double direction(const PlanarPair& pair, const PlanarContact<double>& at) {
    const Eigen::Vector2d normal = pair.in_world(at.normal);
    return std::atan2(normal.y(), normal.x());
  }
  /// 1/m = w.(W w) of the wrench w on b at its origin for a unit force at the contact.
  static double inverse_mass(const PlanarPair& pair, const PlanarContact<double>& at, const double* mobility) {
    const Eigen::Vector2d force = pair.in_world(at.normal);
    const double wrench[6] = {force.x(), force.y(), 0.0, 0.0, 0.0, cross(at.arm, at.normal)};
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 6; ++k) sum += wrench[i] * mobility[6 * i + k] * wrench[k];
    return sum;
  }

  /// The force of a contact with its derivatives; writes those of its internal variables and by them.
  static Vec2<Dual> differentiate(const LoadedContact<InPlane>& one, const PlanarPair& pair,
                                  const PlanarContact<Dual>& at, JointForces& out) {
    double unused[most_memory];
    const ContactForce& law = one.normal;
    const FrictionForce f =
        one.laws.friction.evaluate({law.normal, one.at.slip, one.memory}, {unused, one.memory.size});
    const Dual normal = space::chained(law.normal, law.d_penetration, at.penetration, law.d_rate, at.rate);
    const Dual tangential = space::chained(f.tangential, f.d_normal, normal, f.d_slip, at.slip);
    if (one.memory.size > 0) differentiate_memory(one, pair, normal, at.slip, out);
    const Vec2<Dual> whole = force(at, normal, tangential);
    return one.share == 1.0 ? whole : Dual(one.share) * whole;
  }
  static void write_derivatives(const PlanarPair& pair, const Force<Dual>& f, std::size_t columns, JointForces& out) {
    pair.write_derivatives(f, columns, out);
  }

  static double most_of(double x) { return std::abs(x); }
  static double most_of(const Vec2<double>& v) { return std::abs(v.x) + std::abs(v.y); }
  static double size_of(const Vec2<Dual>& v) { return std::hypot(v.x.value, v.y.value); }
  template <class Use>
  static Eigen::Vector2d each_of(const Vec2<Dual>& v, const Use& use) {
    return {use(v.x), use(v.y)};
  }

 private:
  static void differentiate_memory(const LoadedContact<InPlane>& one, const PlanarPair& pair, const Dual& normal,
                                   const Dual& slip, JointForces& out) {
    const std::size_t n = one.memory.size;
    FrictionSlopes slopes(one.laws.friction, normal.value, slip.value, one.memory);
    Dual::Gradient rows[most_memory];
    slopes.by_normal_force();
    for (std::size_t k = 0; k < n; ++k) rows[k] = slopes.rates()[k] * normal.gradient;
    slopes.by_slip();
    for (std::size_t k = 0; k < n; ++k)
      pair.write_rate(one.first + k, rows[k] + slopes.rates()[k] * slip.gradient, one.columns, out);
    for (std::size_t k = 0; k < n; ++k) {
      PlanarPair::Force<double> part;
      part.add(one.share * force(one.at, 0.0, slopes.by_variable(k)), one.at);
      pair.write_column(one.first + k, part, one.columns, out);
      for (std::size_t row = 0; row < n; ++row)
        out.derivatives[(12 + one.first + row) * one.columns + 24 + one.first + k] = slopes.rates()[row];
    }
  }
};

/// A joint of the plane whose contacts stand where `Geometry` says: see Contacts, with ContactPlace and PlanarMotion.
template <class Geometry>
class PlanarContacts : public Contacts<Geometry, InPlane> {
 public:
  using Contacts<Geometry, InPlane>::Contacts;
};

}  // namespace freeplay::play
