#include <algorithm>
#include <cmath>

#include "freeplay/kit/contact_phase.h"
#include "freeplay/kit/integral_from_zero.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// A normal force that the model file gives as a formula F in penetration delta [m], its rate delta' [m/s] and approach
/// speed v_0 [m/s]:
///   F_N = max(0, F(delta, delta', v_0))
/// A contact that is on at the start has rate 0. What is stored is `energy` less its value at 0, or the integral of
/// F(delta, 0, v_0), which must then not depend on v_0.
class ExpressionContact final : public ContactLaw {
 public:
  ExpressionContact(const Parameters& p, const ContactPair&)
      : force_(p.formula("force")), energy_(p.formula("energy")) {
    if (energy_) {
      energy_at_zero_ = value_at_zero();
      require_energy_of_force();
      return;
    }
    require_one_elastic_part();
    stored_ = IntegralFromZero([force = force_](double delta) { return elastic(force, delta); }, 0x1p-50, 1.0);
  }

  ContactForce evaluate(const ContactState& state) const override {
    if (!(state.penetration > 0.0)) return {};
    const bool still = !(state.approach_speed > 0.0);
    double slopes[2];
    ContactForce out{force_.at(variables(state).span(), slopes), slopes[0], still ? 0.0 : slopes[1], 0.0};
    store(state.penetration, out, still || state.rate == 0.0);
    if (out.normal <= 0.0) out.normal = out.d_penetration = out.d_rate = 0.0;
    return out;
  }

  std::int32_t switches() const override { return force_.switches(); }
  void decide(const ContactState& state, Span<double> values) const override {
    force_.decide(variables(state).span(), values);
  }

 private:
  struct Variables {
    double numbers[3];  // delta, rate, v0
    Span<const double> span() const { return numbers; }
  };
  static Variables variables(const ContactState& s) {
    if (s.approach_speed > 0.0) return {{s.penetration, s.rate, s.approach_speed}};
    return {{s.penetration, 0.0, play::smallest_approach_speed}};
  }
  static double elastic(const Formula& force, double delta) {
    const double still[] = {delta, 0.0, play::smallest_approach_speed};
    return std::max(force.at(still), 0.0);
  }
  /// `at_rest`: the force is the elastic part.
  void store(double penetration, ContactForce& out, bool at_rest) const {
    if (energy_) {
      double slope[1];
      out.potential = energy_.at({&penetration, 1}, slope) - energy_at_zero_;
      out.elastic = slope[0];
      return;
    }
    out.potential = stored_.at(penetration);
    out.elastic = at_rest ? std::max(out.normal, 0.0) : elastic(force_, penetration);
  }

  double value_at_zero() const {
    const double zero = 0.0;
    try {
      return energy_.at({&zero, 1});
    } catch (const std::exception&) {
      throw BadParameter("energy", "bad-expression", "'energy' has no value at delta = 0");
    }
  }

  /// Least and largest of the force at these rates, for a slow and a fast approach; nothing where it has no value: the
  /// run says so, with the place.
  struct Spread {
    double low = unbounded, high = -unbounded;
  };
  Spread spread(double delta, double rate) const {
    Spread all;
    try {
      for (const double v0 : {1e-3, 1.0}) {
        for (const double sign : {-1.0, 1.0}) {
          const double at[] = {delta, sign * rate, v0};
          const double force = std::max(force_.at(at), 0.0);
          all = {std::min(all.low, force), std::max(all.high, force)};
        }
      }
    } catch (const std::exception&) {
      return {};
    }
    return all;
  }

  void require_one_elastic_part() const {
    for (const double delta : probes) {
      const Spread still = spread(delta, 0.0);
      if (!(still.high > still.low)) continue;
      throw BadParameter("", "missing-key",
                         "'energy' is required: the force at rate 0 depends on v0, so that it does not say what the "
                         "contact stores");
    }
  }

  /// What is stored while a contact closes without haste is no more than the force does, and no less is given back.
  void require_energy_of_force() const {
    for (const double delta : probes) {
      const Spread slow = spread(delta, 1e-12);
      double slope[1] = {};
      try {
        energy_.at({&delta, 1}, slope);
      } catch (const std::exception&) {
        continue;
      }
      const double rounding = 1e-6 * std::abs(slow.high);
      if (slow.low > slow.high || (slope[0] >= slow.low - rounding && slope[0] <= slow.high + rounding)) continue;
      throw BadParameter("energy", "conflicting-keys",
                         "'energy' is not what 'force' stores: their slope and force at rate 0 differ");
    }
  }

  static constexpr double probes[] = {1e-9, 1e-6, 1e-4};  // [m]

  Formula force_, energy_;
  double energy_at_zero_ = 0.0;  // [J]
  IntegralFromZero stored_;
};

constexpr Parameter expression_contact_parameters[] = {
    {.name = "force",
     .kind = ParameterKind::formula,
     .unit = "N",
     .summary = "Normal force; what is negative counts as zero.",
     .variables = "delta: m; rate: m/s; v0: m/s"},
    {.name = "energy",
     .kind = ParameterKind::formula,
     .unit = "J",
     .default_value = optional,
     .summary = "Energy that the contact stores; the integral of the force at rate 0 unless given.",
     .variables = "delta: m"},
};

}  // namespace

Component expression_contact() {
  return contact_law<ExpressionContact>(
      {.name = "expression",
       .summary = "A law that the model file gives as a formula.",
       .formula = "F_N = max(0, force); delta: penetration, rate: delta', v0: approach speed, at least 1e-6 m/s. A "
                  "contact that is on at the start has rate 0.",
       .validity = "What the formula says. A force that does not begin at 0 jumps where a contact begins: fixed steps "
                   "are then of first order.",
       .parameters = expression_contact_parameters});
}

}  // namespace freeplay
