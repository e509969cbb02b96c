// FrictionLaw: tangential force between two surfaces in contact.
#pragma once

#include <memory>

#include "freeplay/parameter.h"

namespace freeplay {

struct FrictionState {
  double normal_force;          ///< >= 0 [N]
  double slip_speed;            ///< signed tangential speed [m/s]
  Span<const double> internal;  ///< the law's share of z, e.g. a bristle deflection [m]
};

struct FrictionForce {
  double tangential;  ///< force along the positive slip direction [N]; opposes slip_speed
  double d_normal;    ///< partial derivative with respect to normal_force [1]
  double d_slip;      ///< partial derivative with respect to slip_speed [N s/m]
};

/// When an internal variable goes back to the value that it starts with.
enum class MemoryReset : std::uint32_t {
  each_contact,  ///< when its contact ends, so that each one begins with it: as the deflection of bristles
  never          ///< it stays what it is while nothing touches, and the next contact goes on from there: as wear
};

/// A friction law. Laws with memory declare internal variables and give their rates; the owning joint keeps
/// them in its own z, so that they roll back with the state. Immutable after construction.
class FrictionLaw {
 public:
  virtual ~FrictionLaw() = default;
  virtual int internal_variables() const { return 0; }
  /// `internal_rate` has internal_variables() entries [unit of z per second].
  virtual FrictionForce evaluate(const FrictionState& state, Span<double> internal_rate) const = 0;
  /// Slip speeds >= 0 [m/s] at which the force or a rate has a kink, in both directions of slip. Runs with error
  /// control end a step there: beside a kink a step errs by more than its estimate shows.
  virtual Span<const double> kinks() const { return {}; }
  /// The same where kinks do not stand at fixed speeds: how many functions decide() fills, which pass zero there.
  virtual std::int32_t switches() const { return 0; }
  virtual void decide(const FrictionState& /*state*/, Span<double> /*values*/) const {}
  /// Laws with memory: the values that the internal variables start with, zero as they come, and when they go back to
  /// them, `each_contact` as they come; internal_variables() entries each. In space such a variable is a vector along
  /// the surface, one with other values a number without direction.
  virtual void memory(Span<double> /*start*/, Span<MemoryReset> /*resets*/) const {}
  /// Laws with memory: the energy that it stores and gives back [J], and in `slopes`, internal_variables() entries, its
  /// partial derivatives. Then what is lost at an instant is minus the power of the force and the rate of that. Zero,
  /// as it is here: what the force takes is lost at once.
  virtual double stored(Span<const double> /*internal*/, Span<double> slopes) const {
    for (double& slope : slopes) slope = 0.0;
    return 0.0;
  }
};

namespace abi {
struct FrictionLawTable {
  std::uint32_t size;
  void (*destroy)(void* self) noexcept;
  Status (*internal_variables)(const void* self, std::int32_t* count, Message*) noexcept;
  Status (*evaluate)(const void* self, const FrictionState*, Span<double>, FrictionForce*, Message*) noexcept;
  Status (*kinks)(const void* self, Span<const double>* speeds, Message*) noexcept;
  Status (*switches)(const void* self, std::int32_t* count, Message*) noexcept;
  Status (*decide)(const void* self, const FrictionState*, Span<double> values, Message*) noexcept;
  Status (*memory)(const void* self, Span<double> start, Span<MemoryReset> resets, Message*) noexcept;
  Status (*stored)(const void* self, Span<const double> internal, double* energy, Span<double> slopes,
                   Message*) noexcept;
};

template <class Law>
inline constexpr FrictionLawTable friction_law_table{
    sizeof(FrictionLawTable),
    [](void* self) noexcept { delete static_cast<Law*>(self); },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      return guarded(m, [&] { *count = static_cast<const Law*>(self)->internal_variables(); });
    },
    [](const void* self, const FrictionState* in, Span<double> rate, FrictionForce* out, Message* m) noexcept {
      return guarded(m, [&] { *out = static_cast<const Law*>(self)->evaluate(*in, rate); });
    },
    [](const void* self, Span<const double>* speeds, Message* m) noexcept {
      return guarded(m, [&] { *speeds = static_cast<const Law*>(self)->kinks(); });
    },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      return guarded(m, [&] { *count = static_cast<const Law*>(self)->switches(); });
    },
    [](const void* self, const FrictionState* in, Span<double> values, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const Law*>(self)->decide(*in, values); });
    },
    [](const void* self, Span<double> start, Span<MemoryReset> resets, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const Law*>(self)->memory(start, resets); });
    },
    [](const void* self, Span<const double> internal, double* energy, Span<double> slopes, Message* m) noexcept {
      return guarded(m, [&] { *energy = static_cast<const Law*>(self)->stored(internal, slopes); });
    }};

template <class Law>
Status create_friction_law(const ParameterTable* table, void** self, Message* m) noexcept {
  return guarded(m, [&] { *self = std::make_unique<Law>(Parameters(*table)).release(); });
}
}  // namespace abi

/// A joint's handle on a law that may live in another plugin.
class FrictionLawRef {
 public:
  FrictionLawRef() = default;
  FrictionLawRef(const abi::FrictionLawTable& table, const void* self) : table_(&table), self_(self) {}

  int internal_variables() const {
    std::int32_t count = 0;
    Message message;
    abi::require(table_->internal_variables(self_, &count, &message), message);
    return count;
  }
  FrictionForce evaluate(const FrictionState& state, Span<double> internal_rate) const {
    FrictionForce force{};
    Message message;
    abi::require(table_->evaluate(self_, &state, internal_rate, &force, &message), message);
    return force;
  }
  /// Valid as long as the law lives.
  Span<const double> kinks() const {
    Span<const double> speeds;
    Message message;
    abi::require(table_->kinks(self_, &speeds, &message), message);
    return speeds;
  }
  std::int32_t switches() const {
    std::int32_t count = 0;
    Message message;
    abi::require(table_->switches(self_, &count, &message), message);
    return count;
  }
  void decide(const FrictionState& state, Span<double> values) const {
    Message message;
    abi::require(table_->decide(self_, &state, values, &message), message);
  }
  void memory(Span<double> start, Span<MemoryReset> resets) const {
    Message message;
    abi::require(table_->memory(self_, start, resets, &message), message);
  }
  double stored(Span<const double> internal, Span<double> slopes) const {
    double energy = 0.0;
    Message message;
    abi::require(table_->stored(self_, internal, &energy, slopes, &message), message);
    return energy;
  }

 private:
  const abi::FrictionLawTable* table_ = nullptr;
  const void* self_ = nullptr;
};

inline FrictionLawRef Parameters::friction_law(const char* name) const {
  FrictionLawRef law;
  Message message;
  abi::require(table_->friction_law(table_->self, name, &law, &message), message);
  return law;
}

}  // namespace freeplay
