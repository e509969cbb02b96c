#include "slipping_coupling.h"

namespace freeplay {
namespace {

/// Nothing one way; the other way all, or as much as a function of time or of the motion says.
class ClutchBounds {
 public:
  explicit ClutchBounds(const Parameters& p) : upwards_(p.word("locks") == 0), limited_(p.given("limit")) {
    if (limited_) limit_ = p.function("limit");
  }

  double time_scale() const { return limited_ ? 0.0 : unbounded; }  // 0: that of the function
  double upper(const JointInput& in) const { return upwards_ ? limit(in) : 0.0; }
  double lower(const JointInput& in) const { return upwards_ ? 0.0 : -limit(in); }
  Span<const space::BoundEvent> events() const {
    static constexpr space::BoundEvent up[] = {{"lock", 0, Crossing::rising},
                                               {"release", 0, Crossing::falling},
                                               {"slip", 1, Crossing::rising},
                                               {"stick", 1, Crossing::falling}};
    static constexpr space::BoundEvent down[] = {{"lock", 1, Crossing::falling},
                                                 {"release", 1, Crossing::rising},
                                                 {"slip", 0, Crossing::falling},
                                                 {"stick", 0, Crossing::rising}};
    return {upwards_ ? up : down, limited_ ? 4u : 2u};
  }
  const char* doubt(const JointInput& in) const {
    return limited_ && given(in) < below_zero ? "The limit is negative here; the clutch is open." : nullptr;
  }

 private:
  double limit(const JointInput& in) const { return limited_ ? std::max(0.0, given(in)) : unbounded; }
  double given(const JointInput& in) const { return in.functions.empty() ? limit_.at(in.t).value : in.functions[0]; }

  bool upwards_, limited_;
  TimeFunction limit_;
};

constexpr Parameter clutch_parameters[] = {
    space::coupling_kind_parameter,
    {.name = "locks",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "positive|negative",
     .summary = "Sense in which the second body may not go ahead of the first; it runs free in the other."},
    space::coupling_stiffness_parameter,
    space::coupling_relaxation_parameter,
    {.name = "limit",
     .kind = ParameterKind::function,
     .unit = "kind: N | N*m",
     .default_value = optional,
     .summary = "Largest force or torque, a function of time or, under `forces`, of the motion, beyond which it slips; "
                "without it none.",
     .variables = "motion"}};

}  // namespace

Component one_way_clutch() {
  return joint<space::SlippingCoupling<ClutchBounds>>(
      {.name = "one-way-clutch",
       .space = Space::both,
       .summary = "Force element: a freewheel, which holds in one sense and runs free in the other.",
       .formula =
           "effort on the second body -E, E = stiffness (z + relaxation speed), from 0 to limit where it locks the "
           "positive sense, from -limit to 0 otherwise; strain z' = (E/stiffness - z)/relaxation; along x of the "
           "first frame or about its z.",
       .validity = "Locks wherever it stands, without the steps of a ratchet.",
       .references = "Prandtl 1928, ZAMM 8, 85-106 (elastic element in series with a slider)",
       .parameters = clutch_parameters});
}

}  // namespace freeplay
