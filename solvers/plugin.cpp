// The integrators of the library, one row each.
#include "freeplay/plugin.h"

namespace freeplay {
Component bathe();
Component newmark();
Component hht();
Component generalized_alpha();
Component dopri5();
Component verner6();
Component verner7();
Component sundials_arkode();  // absent where SUNDIALS is not
}  // namespace freeplay

FREEPLAY_PLUGIN(solvers) {
  using namespace freeplay;
  static const Component components[] = {bathe(),  newmark(), hht(),     generalized_alpha(),
                                         dopri5(), verner6(), verner7(), sundials_arkode()};
  return publish(*host, *manifest, "solvers", "0.1.0", components);
}
