#include "run/peak_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace freeplay {
namespace {
constexpr double first_credit = 8.0, credit_per_step = 1.0 / 24.0;
constexpr int most_looks = 3;         // at one step
constexpr double least_gain = 1e-6;   // of the largest value
constexpr double large_gain = 1e-2;   // is pursued without credit
constexpr double same_place = 0.02;   // of a step
constexpr double nearest_end = 0.05;  // of a step

struct Node {
  double x, y;
};
/// The parabola y1 + (x - x1) (slope + bend (x - x0)).
struct Parabola {
  Parabola(const Node& a, const Node& b, const Node& c) : x0(a.x), x1(b.x), y1(b.y), slope((b.y - a.y) / (b.x - a.x)) {
    bend = ((c.y - b.y) / (c.x - b.x) - slope) / (c.x - a.x);
  }
  double vertex() const { return 0.5 * (x0 + x1 - slope / bend); }
  double at(double x) const { return y1 + (x - x1) * (slope + bend * (x - x0)); }
  double x0, x1, y1, slope, bend = 0.0;
};

double part_of(double gain, double largest) { return gain / std::max(std::abs(largest), 1e-300); }
}  // namespace

PeakSearch::PeakSearch(std::size_t values) : credit_(first_credit) {
  for (Point* point : {&before_, &start_, &end_, &inner_}) point->values.resize(values);
}

void PeakSearch::restart(double t, std::span<const double> values) {
  end_.x = t;
  std::ranges::copy(values, end_.values.begin());
  ends_ = 1;
}

void PeakSearch::end_step(double t, std::span<const double> values) {
  std::swap(before_, start_);
  std::swap(start_, end_);
  end_.x = t;
  std::ranges::copy(values, end_.values.begin());
  ends_ = std::min(ends_ + 1, 3);
  looks_ = 0;
  credit_ = std::min(credit_ + credit_per_step, first_credit);
}

// What the parabola says at its top, and half as much as it bulges over a step more, since it may bulge otherwise.
PeakSearch::Candidate PeakSearch::by_ends(std::size_t value, double largest) const {
  const double before = before_.values[value], start = start_.values[value], end = end_.values[value];
  const double higher = std::max(start, end), change = std::abs(end - start);
  if (ends_ < 3) {
    // The first step of a new course: as much as it changes it may bulge.
    return change > 1e-3 * higher ? Candidate{0.5, part_of(higher + 0.5 * change - largest, largest)} : Candidate{};
  }
  if (higher + change + std::abs(start - before) <= largest) return {};
  const Parabola curve({(before_.x - start_.x) / (end_.x - start_.x), before}, {0.0, start}, {1.0, end});
  if (!(curve.bend < 0.0)) return {};
  const double top = curve.vertex();
  if (!(top > -0.25 && top < 1.25)) return {};
  const double s = std::clamp(top, nearest_end, 1.0 - nearest_end);
  const double height = top > 0.0 && top < 1.0 ? curve.at(top) : higher;
  return {s, part_of(height - 0.125 * curve.bend - largest, largest)};
}

PeakSearch::Candidate PeakSearch::by_look(std::size_t value, double largest) const {
  const Parabola curve({0.0, start_.values[value]}, {inner_.x, inner_.values[value]}, {1.0, end_.values[value]});
  if (!(curve.bend < 0.0)) return {};
  const double top = curve.vertex();
  if (!(top > 0.0 && top < 1.0) || std::abs(top - inner_.x) < same_place) return {};
  return {top, part_of(curve.at(top) - largest, largest)};
}

double PeakSearch::next(std::span<const double> largest) {
  if (ends_ < 2 || looks_ == most_looks) return 0.0;
  Candidate best;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const Candidate one = looks_ == 0 ? by_ends(i, largest[i]) : by_look(i, largest[i]);
    if (one.gain > best.gain) best = one;
  }
  if (!(best.gain > least_gain) || (credit_ < 1.0 && best.gain < large_gain)) return 0.0;
  credit_ = std::max(credit_ - 1.0, 0.0);
  ++looks_;
  return best.s;
}

void PeakSearch::seen(double s, std::span<const double> values) {
  inner_.x = s;
  std::ranges::copy(values, inner_.values.begin());
}

}  // namespace freeplay
