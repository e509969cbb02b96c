#include "explicit_runge_kutta.h"

namespace freeplay {
namespace {

/// Verner 2010, the pair IIa of orders 7 and 6 with the least error for its work: ten stages, of which the last serves
/// the error alone. His table of 40 digits (RKV76.IIa.Efficient, www.sfu.ca/~jverner), here as far as doubles go.
struct Verner7 {
  static constexpr int stages = 10, order = 7, error_order = 7;
  static constexpr double node[] = {0.0,   0.005, 0.98 / 9.0, 0.49 / 3.0, 0.4555, 0.60950944899783813171,
                                    0.884, 0.925, 1.0,        1.0};
  static constexpr double weight[][10] = {
      {},
      {0.005},
      {-1.0767901234567901235, 1.1856790123456790123},
      {0.040833333333333333333, 0.0, 0.1225},
      {0.63891392362557267805, 0.0, -2.4556726382236568097, 2.2722587145980841316},
      {-2.6615773750187571311, 0.0, 10.804513886456137696, -8.3539146573961994120, 0.82048759495665697914},
      {6.0677414346967709927, 0.0, -24.711273635911085797, 20.427517930788893940, -1.9061579788166471506,
       1.0061722492420680148},
      {12.054670076253202995, 0.0, -49.754784950468989328, 41.142888638604676633, -4.4617601499740041856,
       2.0423348222391749598, -0.098348436654061073795},
      {10.138146522881807876, 0.0, -42.641136031717502146, 35.763840039922570071, -4.3480228403929076533,
       2.0098622683770358954, 0.34874904603382724060, -0.27143900510483128424},
      {-45.030072034298677124, 0.0, 187.32724376545888408, -154.02882369350186906, 18.564653063475362339,
       -7.1418096792950788549, 1.3088085781613786251, 0.0, 0.0},
      {0.047155618486272221704, 0.0, 0.0, 0.25750564298434151896, 0.26216653977412620477, 0.15216092656738557403,
       0.49399691700324842469, -0.29430311714032504416, 0.081317472324951099997, 0.0}};
  static constexpr double error_weight[] = {0.047155618486272221704 - 0.044608606606341176287,
                                            0.0,
                                            0.0,
                                            0.25750564298434151896 - 0.26716403785713726805,
                                            0.26216653977412620477 - 0.22010183001772930200,
                                            0.15216092656738557403 - 0.21884317031431568310,
                                            0.49399691700324842469 - 0.22898717054112028834,
                                            -0.29430311714032504416,
                                            0.081317472324951099997,
                                            -0.020295184663356282228,
                                            0.0};
};

}  // namespace

Component verner7() {
  return integrator<ExplicitRungeKutta<Verner7>>(
      {.name = "verner7",
       .summary = "Explicit Runge-Kutta pair of orders 7 and 6 with projection, always adaptive.",
       .formula =
           "d' = v, v' = a, z' = g with M a + Phi_q^T lambda = f, Phi_q a = gamma; ten stages; then q on Phi = 0 and v "
           "on Phi_q v = nu; error: difference of the orders.",
       .validity = "Motions that are not stiff against the accuracy asked for: impacts are not, stiff dampers are. "
                   "Takes the fewest steps of all; cheapest where forces are smooth, as of impacts without friction.",
       .references = "Verner 2010, Numer Algorithms 53, 383-396; Hairer, Norsett and Wanner 1993, Solving Ordinary "
                     "Differential Equations I, II.5"});
}

}  // namespace freeplay
