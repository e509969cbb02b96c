// ContactLaw: normal force between two surfaces as a function of their penetration.
#pragma once

#include <memory>

#include "freeplay/parameter.h"

namespace freeplay {

struct Material {
  double youngs_modulus;  ///< [Pa]
  double poisson_ratio;   ///< [1]
};

/// What one of two surfaces is like where they touch.
enum class SurfaceShape : std::uint32_t {
  unknown,   ///< a joint that does not say: round where its radius is known
  cylinder,  ///< of its radius: the bore of a bearing, a pin as the journal
  sphere,    ///< of its radius: the socket as the bearing, a ball as the journal
  plane,     ///< flat: it has no radius, which is not one that is not known
  corner     ///< where two faces meet: it has no radius either
};

/// Two surfaces that may touch, as a journal inside a bearing, or before a wall, which then is the bearing. What the
/// model file does not give is NaN.
struct ContactPair {
  double bearing_radius;    ///< of a surface that is hollow [m]
  double journal_radius;    ///< of a surface that bulges [m]
  double radial_clearance;  ///< bearing minus journal radius; before a wall the play to one side [m]
  double length;            ///< axial length of the contact: across the plane of a planar model [m]
  Material bearing, journal;
  // Appended.
  SurfaceShape bearing_shape = SurfaceShape::unknown, journal_shape = SurfaceShape::unknown;
  double face_length = std::numeric_limits<double>::quiet_NaN();  ///< of a flat face along the way it slides [m]

  /// 1/R = 1/R_journal - 1/R_bearing [1/m], where a plane counts as 0: of two round surfaces, or of a round one on a
  /// plane. NaN where a radius is not known, at a corner and between two planes.
  double relative_curvature() const {
    if (!is_round(journal_shape, journal_radius)) return std::numeric_limits<double>::quiet_NaN();
    if (bearing_shape == SurfaceShape::plane) return 1.0 / journal_radius;
    if (!is_round(bearing_shape, bearing_radius)) return std::numeric_limits<double>::quiet_NaN();
    return radial_clearance / (bearing_radius * journal_radius);
  }
  /// Whether one surface follows the other, so that they are near each other over a large part of both: a journal in a
  /// bearing, a face on a wall.
  bool conforming() const {
    if (bearing_shape == SurfaceShape::plane) return journal_shape == SurfaceShape::plane;
    return is_round(bearing_shape, bearing_radius) && is_round(journal_shape, journal_radius);
  }

 private:
  static bool is_round(SurfaceShape shape, double radius) {
    const bool is_known = radius == radius;
    return shape == SurfaceShape::cylinder || shape == SurfaceShape::sphere ||
           (shape == SurfaceShape::unknown && is_known);
  }
};

/// Only evaluated for penetration > 0; the joint decides when contact exists.
struct ContactState {
  double penetration;     ///< delta [m], > 0
  double rate;            ///< time derivative of delta, positive while closing [m/s]
  double approach_speed;  ///< rate at the instant the present contact began [m/s]; 0: elastic part only
};

struct ContactForce {
  double normal;         ///< repulsive, never negative [N]
  double d_penetration;  ///< partial derivative with respect to penetration [N/m]
  double d_rate;         ///< partial derivative with respect to rate [N s/m]
  double potential;      ///< energy stored by the elastic part [J]
  // Appended.
  /// The elastic part itself, d(potential)/d(penetration) [N]; NaN: what evaluate() gives for an approach speed of 0.
  double elastic = std::numeric_limits<double>::quiet_NaN();
};

/// A contact-force law. Immutable after construction: the memory of an impact belongs to the joint, which
/// passes it in ContactState, so that one law serves many states at once.
class ContactLaw {
 public:
  virtual ~ContactLaw() = default;
  virtual ContactForce evaluate(const ContactState& state) const = 0;
  /// A static sentence when `state` lies outside the law's range of validity, else null.
  virtual const char* outside_range(const ContactState& /*state*/) const { return nullptr; }
  /// How many functions decide() fills: those that pass zero where the force has a kink besides the one where it ends.
  virtual std::int32_t switches() const { return 0; }
  /// NaN: none is near. Runs with error control end a step there: beside a kink it errs by more than its estimate
  /// shows.
  virtual void decide(const ContactState& /*state*/, Span<double> /*values*/) const {}
};

namespace abi {
struct ContactLawTable {
  std::uint32_t size;
  void (*destroy)(void* self) noexcept;
  Status (*evaluate)(const void* self, const ContactState*, ContactForce*, Message*) noexcept;
  Status (*outside_range)(const void* self, const ContactState*, const char** why, Message*) noexcept;
  // Appended.
  Status (*switches)(const void* self, std::int32_t* count, Message*) noexcept;
  Status (*decide)(const void* self, const ContactState*, Span<double> values, Message*) noexcept;
};

template <class Law>
inline constexpr ContactLawTable contact_law_table{
    sizeof(ContactLawTable),
    [](void* self) noexcept { delete static_cast<Law*>(self); },
    [](const void* self, const ContactState* in, ContactForce* out, Message* m) noexcept {
      return guarded(m, [&] { *out = static_cast<const Law*>(self)->evaluate(*in); });
    },
    [](const void* self, const ContactState* in, const char** why, Message* m) noexcept {
      return guarded(m, [&] { *why = static_cast<const Law*>(self)->outside_range(*in); });
    },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      return guarded(m, [&] { *count = static_cast<const Law*>(self)->switches(); });
    },
    [](const void* self, const ContactState* in, Span<double> values, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const Law*>(self)->decide(*in, values); });
    }};

template <class Law>
Status create_contact_law(const ParameterTable* table, const ContactPair* pair, void** self, Message* m) noexcept {
  return guarded(m, [&] { *self = std::make_unique<Law>(Parameters(*table), *pair).release(); });
}
}  // namespace abi

/// A joint's handle on a law that may live in another plugin.
class ContactLawRef {
 public:
  ContactLawRef() = default;
  ContactLawRef(const abi::ContactLawTable& table, const void* self) : table_(&table), self_(self) {}

  ContactForce evaluate(const ContactState& state) const {
    ContactForce force{};
    Message message;
    abi::require(table_->evaluate(self_, &state, &force, &message), message);
    return force;
  }
  const char* outside_range(const ContactState& state) const {
    const char* why = nullptr;
    Message message;
    abi::require(table_->outside_range(self_, &state, &why, &message), message);
    return why;
  }
  std::int32_t switches() const {
    std::int32_t count = 0;
    Message message;
    abi::require(table_->switches(self_, &count, &message), message);
    return count;
  }
  void decide(const ContactState& state, Span<double> values) const {
    Message message;
    abi::require(table_->decide(self_, &state, values, &message), message);
  }

 private:
  const abi::ContactLawTable* table_ = nullptr;
  const void* self_ = nullptr;
};

inline ContactLawRef Parameters::contact_law(const char* name, const ContactPair& pair) const {
  ContactLawRef law;
  Message message;
  abi::require(table_->contact_law(table_->self, name, &pair, &law, &message), message);
  return law;
}

}  // namespace freeplay
