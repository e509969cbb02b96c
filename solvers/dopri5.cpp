#include "explicit_runge_kutta.h"

namespace freeplay {
namespace {

/// Dormand and Prince 1980, RK5(4)7M: the seventh stage is the end of the step.
struct DormandPrince {
  static constexpr int stages = 6, order = 5, error_order = 5;
  static constexpr double node[] = {0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0};
  static constexpr double weight[][6] = {
      {},
      {1.0 / 5.0},
      {3.0 / 40.0, 9.0 / 40.0},
      {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
      {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
      {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
      {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}};
  static constexpr double error_weight[] = {71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
                                            -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
};

}  // namespace

Component dopri5() {
  return integrator<ExplicitRungeKutta<DormandPrince>>(
      {.name = "dopri5",
       .summary = "Explicit Runge-Kutta pair of orders 5 and 4 with projection, always adaptive.",
       .formula =
           "d' = v, v' = a, z' = g with M a + Phi_q^T lambda = f, Phi_q a = gamma; seven stages, the last is the "
           "first of the next step; then q on Phi = 0 and v on Phi_q v = nu; error: difference of the orders.",
       .validity = "Motions that are not stiff against the accuracy asked for: impacts are not, stiff dampers are.",
       .references = "Dormand and Prince 1980, J Comput Appl Math 6, 19-26; Hairer, Norsett and Wanner 1993, Solving "
                     "Ordinary Differential Equations I, II.5",
       .preferred = 2});
}

}  // namespace freeplay
