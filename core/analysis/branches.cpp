#include "analysis/branches.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr int part_starts = 60, whole_starts = 400;
constexpr std::size_t most_postures = 4096;
constexpr double same = 1e-6;  // of positions relative to the model's size, of angles [rad]

/// Numbers in [0, 1) that fill a cube evenly (Kronecker sequence; square roots of primes).
double spread(int index, std::size_t dimension) {
  constexpr int primes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89};
  const double prime = primes[dimension % std::size(primes)];
  const std::size_t times_through = dimension / std::size(primes);
  const double value = (index + 1) * std::sqrt(prime) * (1.0 + 0.1 * static_cast<double>(times_through));
  return value - std::floor(value);
}

bool alike(const Posture& a, const Posture& b, double size) {
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    const double gap = a.q[i] - b.q[i];
    if (std::abs(i % 3 == 2 ? wrapped(gap) : gap / size) > same) return false;
  }
  return true;
}

void add(std::vector<Posture>& found, const Posture& posture, double size) {
  if (std::ranges::none_of(found, [&](const Posture& other) { return alike(posture, other, size); })) {
    found.push_back(posture);
  }
}

/// Bodies turned and moved somewhere within the size of the mechanism.
void scatter(const std::vector<BodyId>& bodies, int index, double size, Posture& posture) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    double* q = &posture.q[3 * at(bodies[b])];
    for (std::size_t c = 0; c < 3; ++c) {
      const double share = 2.0 * spread(index, 3 * b + c) - 1.0;
      q[c] += c == 2 ? M_PI * share : 0.7 * size * share;
    }
  }
}

}  // namespace

std::vector<Posture> all_postures(IdealMechanism& mechanism, const Demand& demand, const Tick& tick) {
  PostureSolver solver(mechanism);
  const double size = mechanism.system().size();
  std::vector<Posture> found;
  if (count(demand.given) < 3 || !demand.inputs.empty()) {
    const Posture start = mechanism.start();
    std::vector<BodyId> bodies;
    for (int b = 0; b < static_cast<int>(mechanism.model().bodies.size()); ++b) bodies.push_back(b);
    for (int i = 0; i < whole_starts; ++i) {
      if (tick) tick(0);
      Posture posture = start;
      if (i > 0) scatter(bodies, i, size, posture);
      if (solver.settle(demand, posture)) add(found, posture, size);
    }
  } else {
    found.push_back(mechanism.closed_form() ? solver.blank() : mechanism.start());
    for (const Limb& part : mechanism.parts()) {
      std::vector<Posture> ways;
      for (const Posture& before : found) {
        if (part.leg) {
          for (const int elbow : {1, -1}) {
            Posture posture = before;
            if (solver.place(part, elbow, demand, posture)) add(ways, posture, size);
          }
          continue;
        }
        for (int i = 0; i < part_starts; ++i) {
          if (tick) tick(0);
          Posture posture = before;
          if (i > 0) scatter(part.bodies, i, size, posture);
          if (solver.settle(part, demand, posture)) add(ways, posture, size);
        }
      }
      if (ways.size() > most_postures) ways.resize(most_postures);
      found = std::move(ways);
    }
    for (Posture& posture : found) solver.place_platform(demand, posture);
    if (mechanism.closed_form()) return found;  // in the order of the modes
  }
  std::ranges::stable_sort(found, [&](const Posture& a, const Posture& b) {
    const FramePose left = solver.frame(a), right = solver.frame(b);
    const auto key = [&](double x) { return std::round(x / (same * size)); };
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = i < 2 ? left[i] : wrapped(left[i]) * size;
      const double y = i < 2 ? right[i] : wrapped(right[i]) * size;
      if (key(x) != key(y)) return x < y;
    }
    for (std::size_t i = 2; i < a.q.size(); i += 3) {
      const double x = wrapped(a.q[i]), y = wrapped(b.q[i]);
      if (std::abs(x - y) > same) return x < y;
    }
    return false;
  });
  return found;
}

}  // namespace freeplay
