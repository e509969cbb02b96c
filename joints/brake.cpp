#include "slipping_coupling.h"

namespace freeplay {
namespace {

/// The same bound both ways, a function of time or of the motion.
class BrakeBounds {
 public:
  explicit BrakeBounds(const Parameters& p) : limit_(p.function("limit")) {}

  double time_scale() const { return 0.0; }  // that of the function
  double upper(const JointInput& in) const { return std::max(0.0, limit(in)); }
  double lower(const JointInput& in) const { return -upper(in); }
  Span<const space::BoundEvent> events() const {
    static constexpr space::BoundEvent both[] = {{"slip", 1, Crossing::rising},
                                                 {"stick", 1, Crossing::falling},
                                                 {"slip_back", 0, Crossing::falling},
                                                 {"stick_back", 0, Crossing::rising}};
    return both;
  }
  const char* doubt(const JointInput& in) const {
    return limit(in) < below_zero ? "The limit is negative here; the brake is open." : nullptr;
  }

 private:
  double limit(const JointInput& in) const { return in.functions.empty() ? limit_.at(in.t).value : in.functions[0]; }

  TimeFunction limit_;
};

constexpr Parameter brake_parameters[] = {
    space::coupling_kind_parameter,
    {.name = "limit",
     .kind = ParameterKind::function,
     .unit = "kind: N | N*m",
     .summary = "Largest force or torque, a function of time or, under `forces`, of the motion; it slips against that.",
     .variables = "motion"},
    space::coupling_stiffness_parameter,
    space::coupling_relaxation_parameter};

}  // namespace

Component brake() {
  return joint<space::SlippingCoupling<BrakeBounds>>(
      {.name = "brake",
       .space = Space::both,
       .summary = "Force element: a brake or a friction clutch that holds at rest up to a limit and slips beyond.",
       .formula = "effort on the second body -E, E = stiffness (z + relaxation speed) within +-limit, the strain z' = "
                  "(E/stiffness - z)/relaxation; along x of the first frame or about its z.",
       .validity = "Sliding and static friction are equal.",
       .references = "Prandtl 1928, ZAMM 8, 85-106 (elastic element in series with a slider)",
       .parameters = brake_parameters});
}

}  // namespace freeplay
