#include "run/peak_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double first_credit = 8.0, credit_per_step = 1.0 / 24.0;
constexpr double least_gain = 1e-6;   // of the largest value
constexpr double large_gain = 1e-2;   // is pursued without credit
constexpr double fair_gain = 1e-3;    // has a credit of its own, which small gains do not use up
constexpr double steep = 0.1;         // rise over a step, as a part of its end
constexpr double far_below = 0.5;     // of the end: where the step before began
constexpr double beside_end = 0.9;    // of a step
constexpr double same_place = 0.02;   // of a step
constexpr double nearest_end = 0.05;  // of a step

/// The parabola y1 + (x - x1) (slope + bend (x - x0)).
struct Parabola {
  using Node = std::pair<double, double>;
  Parabola(const Node& a, const Node& b, const Node& c)
      : x0(a.first), x1(b.first), y1(b.second), slope((y1 - a.second) / (x1 - x0)) {
    bend = ((c.second - y1) / (c.first - x1) - slope) / (c.first - x0);
  }
  double vertex() const { return 0.5 * (x0 + x1 - slope / bend); }
  double at(double x) const { return y1 + (x - x1) * (slope + bend * (x - x0)); }
  double x0, x1, y1, slope, bend = 0.0;
};

double part_of(double gain, double largest) { return gain / std::max(std::abs(largest), 1e-300); }
}  // namespace

PeakSearch::PeakSearch(std::size_t values) : credit_(first_credit), fair_credit_(first_credit) {
  for (Point* point : {&before_, &start_, &end_}) point->values.resize(values);
  for (Point& point : inner_) point.values.resize(values);
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
  looks_ = extras_ = 0;
  order_ = {0, 1};
  credit_ = std::min(credit_ + credit_per_step, first_credit);
  fair_credit_ = std::min(fair_credit_ + credit_per_step, first_credit);
}

std::pair<double, double> PeakSearch::node(int place, std::size_t value) const {
  const int known = order_[at(place)];
  if (known < 2) return {static_cast<double>(known), (known == 0 ? start_ : end_).values[value]};
  const Point& look = inner_[at(known - 2)];
  return {look.x, look.values[value]};
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
  return {s, part_of(height - 0.125 * curve.bend - largest, largest), part_of(height - largest, largest)};
}

// The parabola through the highest place that is known and those beside it.
PeakSearch::Candidate PeakSearch::by_looks(std::size_t value, double largest) const {
  const int last = looks_ + extras_ + 1;
  int highest = 0;
  double height = start_.values[value];
  for (int i = 1; i <= last; ++i) {
    const double y = node(i, value).second;
    if (y > height) highest = i, height = y;
  }
  const int middle = std::clamp(highest, 1, last - 1);
  const Parabola curve(node(middle - 1, value), node(middle, value), node(middle + 1, value));
  if (!(curve.bend < 0.0)) return {};
  const double top = curve.vertex();
  if (!(top > 0.0 && top < 1.0)) return {};
  const double gain = part_of(curve.at(top) - largest, largest);
  if (!(gain > least_gain)) return {};
  for (int i = 1; i < last; ++i) {
    if (std::abs(top - node(i, value).first) < same_place) return {};
  }
  return {top, gain, gain};
}

// A sharp peak rises so from far below that the ends do not show whether the step has gone over its top.
PeakSearch::Candidate PeakSearch::by_steepness(std::size_t value, double largest) const {
  const double start = start_.values[value], end = end_.values[value], rise = end - start;
  if (ends_ < 3 || !(rise > steep * end && before_.values[value] < far_below * end)) return {};
  const double gain = part_of(end + (1.0 - beside_end) * rise - largest, largest);
  return {beside_end, gain, gain};
}

double PeakSearch::next(std::span<const double> largest) {
  if (ends_ < 2) return 0.0;
  const bool looked = looks_ + extras_ > 0;
  Candidate best, likely;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const Candidate one = looked ? by_looks(i, largest[i]) : by_ends(i, largest[i]);
    if (one.gain > best.gain) best = one;
    if (one.likely > likely.likely) likely = one;
  }
  const bool usual = extras_ == 0 && looks_ < most_looks && best.gain > least_gain;
  if (usual && (credit_ >= 1.0 || best.gain >= large_gain)) {
    credit_ = std::max(credit_ - 1.0, 0.0);
    ++looks_;
    return best.s;
  }
  return next_extra(likely, largest);
}

// What the usual looks leave is worth more of them where it is much.
double PeakSearch::next_extra(Candidate best, std::span<const double> largest) {
  for (std::size_t i = 0; i < largest.size() && extras_ == 0; ++i) {
    const Candidate one = by_steepness(i, largest[i]);
    if (one.likely > best.likely) best = one;
  }
  if (extras_ == most_extras || !(best.likely > fair_gain)) return 0.0;
  if (fair_credit_ < 1.0 && best.likely < large_gain) return 0.0;
  fair_credit_ = std::max(fair_credit_ - 1.0, 0.0);
  ++extras_;
  return best.s;
}

void PeakSearch::seen(double s, std::span<const double> values) {
  Point& point = inner_[at(looks_ + extras_ - 1)];
  point.x = s;
  std::ranges::copy(values, point.values.begin());
  int place = looks_ + extras_;  // that of the end of the step until now
  order_[at(place + 1)] = 1;
  for (; place > 1 && inner_[at(order_[at(place - 1)] - 2)].x > s; --place) order_[at(place)] = order_[at(place - 1)];
  order_[at(place)] = looks_ + extras_ + 1;
}

}  // namespace freeplay
