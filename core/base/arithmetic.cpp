#include "base/arithmetic.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "base/byte_numbers.h"
#include "base/sha256.h"

namespace freeplay {
namespace {

/// Numbers as one word. Every step takes different words to different words: one bit that differs in one number shows.
class BitMix {
 public:
  void add(double number) {
    word_ = (word_ ^ std::bit_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15u;
    word_ ^= word_ >> 32;
  }
  std::uint64_t word() const { return word_; }

 private:
  std::uint64_t word_ = 0;
};

struct Function {
  double (*value)(double);
  double from, until;
};

struct FunctionOfTwo {
  double (*value)(double, double);
  double from, until, second_from, second_until;
};

// Where models use them, and both signs where there are.
constexpr Function functions[] = {
    {std::sin, -20.0, 20.0},   {std::cos, -20.0, 20.0},  {std::tan, -20.0, 20.0},   {std::asin, -1.0, 1.0},
    {std::acos, -1.0, 1.0},    {std::atan, -20.0, 20.0}, {std::sinh, -20.0, 20.0},  {std::cosh, -20.0, 20.0},
    {std::tanh, -10.0, 10.0},  {std::asinh, -20., 20.0}, {std::acosh, 1.0, 20.0},   {std::atanh, -1.0, 1.0},
    {std::exp, -745.0, 700.0}, {std::exp2, -50.0, 50.0}, {std::expm1, -10.0, 10.0}, {std::log, 0.0, 1000.0},
    {std::log2, 0.0, 1000.0},  {std::log10, 0.0, 1000.}, {std::log1p, -1.0, 10.0},  {std::cbrt, -50.0, 50.0},
    {std::erf, -5.0, 5.0},     {std::erfc, -5.0, 10.0},  {std::tgamma, 0.0, 20.0},  {std::lgamma, 0.0, 20.0},
    {std::sqrt, 0.0, 1000.0}};
constexpr FunctionOfTwo functions_of_two[] = {{std::pow, 0.0, 20.0, -5.0, 5.0},
                                              {std::atan2, -3.0, 3.0, 2.0, -2.0},
                                              {std::hypot, -3.0, 3.0, 0.0, 50.0},
                                              {std::fmod, -50.0, 50.0, 0.5, 8.0}};
constexpr int values = 4096;

/// One after the other through the range: the processor then guesses branches right, which halves the time.
double between(double from, double until, int number) { return from + (until - from) * ((number + 0.5) / values); }

std::uint64_t mixed(const Function& function) {
  BitMix mix;
  for (int i = 0; i < values; ++i) mix.add(function.value(between(function.from, function.until, i)));
  return mix.word();
}

std::uint64_t mixed(const FunctionOfTwo& function) {
  BitMix mix;
  for (int i = 0; i < values; ++i) {
    mix.add(function.value(between(function.from, function.until, i),
                           between(function.second_from, function.second_until, i)));
  }
  return mix.word();
}

/// A driven pendulum that meets a stop, by the classical Runge-Kutta method: chaotic, so that whatever else rounds
/// differently (contracted products, another precision of what is between) shows.
std::uint64_t mixed_run() {
  const auto acceleration = [](double t, double angle, double speed) {
    const double depth = angle > 1.0 ? angle - 1.0 : 0.0;
    return 1.5 * std::cos(2.0 / 3.0 * t) - std::sin(angle) - 0.5 * speed - 1000.0 * depth * std::sqrt(depth);
  };
  BitMix mix;
  double angle = 0.2, speed = 0.0;
  const double h = 1.0 / 128.0;
  for (int step = 0; step < 1024; ++step) {
    const double t = step * h;
    const double a1 = acceleration(t, angle, speed);
    const double v2 = speed + h / 2.0 * a1, a2 = acceleration(t + h / 2.0, angle + h / 2.0 * speed, v2);
    const double v3 = speed + h / 2.0 * a2, a3 = acceleration(t + h / 2.0, angle + h / 2.0 * v2, v3);
    const double v4 = speed + h * a3, a4 = acceleration(t + h, angle + h * v3, v4);
    angle += h / 6.0 * (speed + 2.0 * v2 + 2.0 * v3 + v4);
    speed += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    mix.add(angle);
    mix.add(speed);
  }
  return mix.word();
}

std::string fingerprint() {
  std::string bytes;
  for (const Function& function : functions) append_bytes(bytes, mixed(function));
  for (const FunctionOfTwo& function : functions_of_two) append_bytes(bytes, mixed(function));
  append_bytes(bytes, mixed_run());
  return sha256(bytes).substr(0, 16);
}

}  // namespace

const std::string& arithmetic_fingerprint() {
  static const std::string digits = fingerprint();
  return digits;
}

}  // namespace freeplay
