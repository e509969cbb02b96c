#include "explicit_runge_kutta.h"

namespace freeplay {
namespace {

/// Verner 1978, table 5 (the pair of DVERK): eight stages, the fourth of order 5 and its companion of order 6.
struct Verner6 {
  static constexpr int stages = 8, order = 6, error_order = 6;
  static constexpr double caution = 32.0;  // measured: both results err alike where motion bends much
  static constexpr double node[] = {0.0, 1.0 / 6.0, 4.0 / 15.0, 2.0 / 3.0, 5.0 / 6.0, 1.0, 1.0 / 15.0, 1.0};
  static constexpr double weight[][8] = {
      {},
      {1.0 / 6.0},
      {4.0 / 75.0, 16.0 / 75.0},
      {5.0 / 6.0, -8.0 / 3.0, 5.0 / 2.0},
      {-165.0 / 64.0, 55.0 / 6.0, -425.0 / 64.0, 85.0 / 96.0},
      {12.0 / 5.0, -8.0, 4015.0 / 612.0, -11.0 / 36.0, 88.0 / 255.0},
      {-8263.0 / 15000.0, 124.0 / 75.0, -643.0 / 680.0, -81.0 / 250.0, 2484.0 / 10625.0, 0.0},
      {3501.0 / 1720.0, -300.0 / 43.0, 297275.0 / 52632.0, -319.0 / 2322.0, 24068.0 / 84065.0, 0.0, 3850.0 / 26703.0},
      {3.0 / 40.0, 0.0, 875.0 / 2244.0, 23.0 / 72.0, 264.0 / 1955.0, 0.0, 125.0 / 11592.0, 43.0 / 616.0}};
  static constexpr double error_weight[] = {3.0 / 40.0 - 13.0 / 160.0,
                                            0.0,
                                            875.0 / 2244.0 - 2375.0 / 5984.0,
                                            23.0 / 72.0 - 5.0 / 16.0,
                                            264.0 / 1955.0 - 12.0 / 85.0,
                                            -3.0 / 44.0,
                                            125.0 / 11592.0,
                                            43.0 / 616.0,
                                            0.0};
};

}  // namespace

Component verner6() {
  return integrator<ExplicitRungeKutta<Verner6>>(
      {.name = "verner6",
       .summary = "Explicit Runge-Kutta pair of orders 6 and 5 with projection, always adaptive.",
       .formula =
           "d' = v, v' = a, z' = g with M a + Phi_q^T lambda = f, Phi_q a = gamma; eight stages; then q on Phi = 0 and "
           "v on Phi_q v = nu; error: difference of the orders.",
       .validity = "Motions that are not stiff against the accuracy asked for: impacts are not, stiff dampers are. "
                   "Cheaper than dopri5 where much accuracy is asked for.",
       .references = "Verner 1978, SIAM J Numer Anal 15, 772-790; Hull, Enright and Jackson 1976, User's guide for "
                     "DVERK, University of Toronto; Hairer, Norsett and Wanner 1993, Solving Ordinary Differential "
                     "Equations I, II.5"});
}

}  // namespace freeplay
