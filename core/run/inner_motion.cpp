#include "run/inner_motion.h"

namespace freeplay {

InnerMotion::InnerMotion(std::size_t increments, std::size_t rates) {
  for (Numbers* numbers : {&missing_, &bends_}) {
    for (std::vector<double>& each : *numbers) each.resize(increments);
  }
  for (Numbers* numbers : {&missing_rate_, &rates_}) {
    for (std::vector<double>& each : *numbers) each.resize(rates);
  }
}

InnerMotion::Weights::Weights(double s) {
  const double x = s - 0.5, u = s * (1.0 - s), u2 = u * u, u3 = u2 * u, x2 = x * x;
  position = {u3, x * u3, x2 * u3};
  velocity = {-6.0 * x * u2, u2 * (u - 6.0 * x2), 2.0 * x * u2 * (u - 3.0 * x2)};
  acceleration = {-6.0 * u * (u - 4.0 * x2), -6.0 * x * u * (3.0 * u - 4.0 * x2),
                  2.0 * u * (u2 - 15.0 * u * x2 + 12.0 * x2 * x2)};
  internal = {u2, x * u2, x2 * x * u2};
}

void InnerMotion::fit_middle() {
  for (std::size_t i = 0; i < bends_[0].size(); ++i) {
    bends_[0][i] = -8.0 / 3.0 * missing_[middle][i];
    bends_[1][i] = bends_[2][i] = 0.0;
  }
  for (std::size_t i = 0; i < rates_[0].size(); ++i) {
    rates_[1][i] = 16.0 * missing_rate_[middle][i];
    rates_[0][i] = rates_[2][i] = 0.0;
  }
  known_ = true;
}

// Second derivatives at x = 0 and x = +-offset: of u^3 -3/8 and -9/98, of x u^3 0 and -+9/14 offset, of x^2 u^3 1/32
// and -9/392. First derivatives there: of u^2 0 and -+6/7 offset, of x u^2 1/16 and 3/196, of x^3 u^2 0 and 3/784.
void InnerMotion::fit() {
  for (std::size_t i = 0; i < bends_[0].size(); ++i) {
    const double before = missing_[0][i], half_way = missing_[middle][i], after = missing_[2][i];
    const double even = 0.5 * (after + before), odd = 0.5 * (after - before);
    bends_[0][i] = -2.0 * half_way - 49.0 / 18.0 * even;
    bends_[1][i] = -14.0 / (9.0 * offset) * odd;
    bends_[2][i] = 8.0 * half_way - 98.0 / 3.0 * even;
  }
  for (std::size_t i = 0; i < rates_[0].size(); ++i) {
    const double before = missing_rate_[0][i], half_way = missing_rate_[middle][i], after = missing_rate_[2][i];
    const double even = 0.5 * (after + before), odd = 0.5 * (after - before);
    rates_[0][i] = -7.0 / (6.0 * offset) * odd;
    rates_[1][i] = 16.0 * half_way;
    rates_[2][i] = 784.0 / 3.0 * even - 64.0 * half_way;
  }
  known_ = true;
}

}  // namespace freeplay
