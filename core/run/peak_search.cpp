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

PeakSearch::PeakSearch(std::size_t values, bool all_is_prescribed)
    : credit_(first_credit), fair_credit_(first_credit), all_is_prescribed_(all_is_prescribed) {
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
  credit_ = std::min(credit_ + credit_per_step, first_credit);
  fair_credit_ = std::min(fair_credit_ + credit_per_step, first_credit);
}

PeakSearch::Places PeakSearch::places() const {
  Places known{1, {0.0}, {start_.values.data()}};
  for (const Point& look : std::span(inner_).first(at(looks_ + extras_))) {
    std::size_t place = at(known.count++);
    for (; look.x < known.x[place - 1]; --place) {
      known.x[place] = known.x[place - 1];
      known.values[place] = known.values[place - 1];
    }
    known.x[place] = look.x;
    known.values[place] = look.values.data();
  }
  known.x[at(known.count)] = 1.0;
  known.values[at(known.count++)] = end_.values.data();
  return known;
}

// The largest value of the parabola, and half of its rise above the chord of a step as a margin for its error.
PeakSearch::Candidate PeakSearch::by_ends(std::size_t value, double largest) const {
  const double before = before_.values[value], start = start_.values[value], end = end_.values[value];
  const double higher = std::max(start, end), change = std::abs(end - start);
  if (ends_ < 3) {
    // The first step of a new course: it may rise above its chord by as much as it changes.
    return change > 1e-3 * higher ? Candidate{0.5, part_of(higher + 0.5 * change - largest, largest)} : Candidate{};
  }
  const Parabola curve({(before_.x - start_.x) / (end_.x - start_.x), before}, {0.0, start}, {1.0, end});
  if (!(curve.bend < 0.0)) return {};
  const double top = curve.vertex();
  if (!(top > -0.25 && top < 1.25)) return {};
  const double s = std::clamp(top, nearest_end, 1.0 - nearest_end);
  const double height = top > 0.0 && top < 1.0 ? curve.at(top) : higher;
  return {s, part_of(height - 0.125 * curve.bend - largest, largest), part_of(height - largest, largest)};
}

// Whether the parabola could rise above the largest value: most values of most steps could not.
bool PeakSearch::could_exceed(std::size_t value, double largest) const {
  const double before = before_.values[value], start = start_.values[value], end = end_.values[value];
  return ends_ < 3 || std::max(start, end) + std::abs(end - start) + std::abs(start - before) > largest;
}

// The parabola through the highest place that is known and those beside it.
PeakSearch::Candidate PeakSearch::by_looks(const Places& places, std::size_t value, double largest) {
  std::size_t highest = 0;
  const std::size_t last = at(places.count) - 1;
  for (std::size_t i = 1; i <= last; ++i) {
    if (places.values[i][value] > places.values[highest][value]) highest = i;
  }
  const std::size_t middle = std::clamp(highest, std::size_t{1}, last - 1);
  const auto node = [&](std::size_t i) { return Node{places.x[i], places.values[i][value]}; };
  const Parabola curve(node(middle - 1), node(middle), node(middle + 1));
  if (!(curve.bend < 0.0)) return {};
  const double top = curve.vertex();
  if (!(top > 0.0 && top < 1.0)) return {};
  for (std::size_t i = 1; i < last; ++i) {
    if (std::abs(top - places.x[i]) < same_place) return {};
  }
  const double gain = part_of(curve.at(top) - largest, largest);
  return {top, gain, gain};
}

// A sharp peak rises so from far below that the ends do not show whether the step has gone over its top.
PeakSearch::Candidate PeakSearch::by_steepness(std::size_t value, double largest) const {
  const double start = start_.values[value], end = end_.values[value], rise = end - start;
  if (!(rise > steep * end && before_.values[value] < far_below * end)) return {};
  const double gain = part_of(end + (1.0 - beside_end) * rise - largest, largest);
  return {beside_end, gain, gain};
}

double PeakSearch::next(std::span<const double> largest) {
  if (ends_ < 2) return 0.0;
  const bool looked = looks_ + extras_ > 0;
  if (all_is_prescribed_ && !looked) {
    ++looks_;
    return 0.5;
  }
  const Places known = looked ? places() : Places{};
  Candidate best, likely;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    if (!looked && !could_exceed(i, largest[i])) continue;
    const Candidate one = looked ? by_looks(known, i, largest[i]) : by_ends(i, largest[i]);
    if (one.gain > best.gain && (one.likely > 0.0 || one.gain > fair_gain)) best = one;
    if (one.likely > likely.likely) likely = one;
  }
  const int allowed = all_is_prescribed_ ? 1 + most_looks : most_looks;
  const bool usual = extras_ == 0 && looks_ < allowed && best.gain > least_gain;
  if (usual && (all_is_prescribed_ || credit_ >= 1.0 || best.gain >= large_gain)) {
    credit_ = std::max(credit_ - 1.0, 0.0);
    ++looks_;
    return best.s;
  }
  return next_extra(likely, largest);
}

// What the usual looks leave is worth more of them where it is much.
double PeakSearch::next_extra(Candidate best, std::span<const double> largest) {
  const bool shortens = ends_ == 3 && end_.x - start_.x < start_.x - before_.x;  // towards a sharp peak
  for (std::size_t i = 0; i < largest.size() && shortens && extras_ == 0; ++i) {
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
}

}  // namespace freeplay
