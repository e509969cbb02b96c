#include "base/formula_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {
namespace {

constexpr double spacing = std::numeric_limits<double>::epsilon();  // of numbers near 1
constexpr long cost_of_a_bound = 4;                                 // instructions: one on intervals
constexpr double short_turn = 1.0 / 64.0;                           // of the run
constexpr int false_positions = 12, bisections = 130;

double largest(const Interval& x) { return std::max(std::abs(x.low), std::abs(x.high)); }

}  // namespace

FormulaSides::FormulaSides(const Expression& expression, double from, double to, double rounding)
    : expression_(expression), from_(from), to_(to), rounding_(rounding) {
  const std::size_t depth = static_cast<std::size_t>(expression.stack_depth_) + 1;
  stack_.reserve(depth), middle_.reserve(depth), ranges_.reserve(depth), hangs_.reserve(depth);
  if (expression.depends_on_time() && from < to) list_sides();
  decisions_.resize(sides_.size());
  roots_.reserve(2 * sides_.size());
  touched_at_begin_.reserve(sides_.size());
}

void FormulaSides::list_sides() {
  const auto& program = expression_.program_;
  std::vector<int> begins;  // of the values on the stack
  for (int i = 0; i < static_cast<int>(program.size()); ++i) {
    const auto& instruction = program[static_cast<std::size_t>(i)];
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    const std::size_t first_operand = begins.size() - count;
    const int first = count == 0 ? i : begins[first_operand];
    first_side_of_.push_back(static_cast<int>(sides_.size()));
    switch (instruction.operation) {
      case Operation::absolute:
      case Operation::sign:
      case Operation::minimum:
      case Operation::maximum:
      case Operation::choose:
        sides_.push_back({i, first, 0, false});
        break;
      case Operation::smooth:
        sides_.push_back({i, first, 0, true});
        sides_.push_back({i, first, 1, true});
        break;
      case Operation::arctangent2: {
        // On the half line to the left the angle jumps; where y is zero for a while, it does with the sign of x.
        const auto& y = program[static_cast<std::size_t>(begins[first_operand + 1] - 1)];
        const bool constant = begins[first_operand + 1] - 1 == first && y.operation == Operation::push_constant;
        if (!constant) sides_.push_back({i, first, 0, false});
        if (!constant || y.constant == 0.0) sides_.push_back({i, first, 1, false});
        break;
      }
      case Operation::power_constant:
        if (instruction.constant == std::floor(instruction.constant)) break;
        [[fallthrough]];
      case Operation::root:
        sides_.push_back({i, first, 0, false, true});
        break;
      case Operation::arcsine:
      case Operation::arccosine:
        sides_.push_back({i, first, 0, false, true});
        sides_.push_back({i, first, 1, false, true});
        break;
      default:
        break;
    }
    begins.resize(first_operand);
    begins.push_back(first);
  }
}

void FormulaSides::reopen() { std::ranges::fill(decisions_, Decision{}); }

void FormulaSides::bound(const std::size_t* first, const std::size_t* last, const Span& span, int depth) {
  roots_.clear();
  touched_at_begin_.clear();
  located_ = 0;
  hidden_ = false;
  // What stands within a larger part of the formula is bounded along with it.
  int begin = std::numeric_limits<int>::max();
  while (last != first) {
    const Side& side = sides_[*--last];
    if (side.instruction >= begin) continue;
    begin = side.first;
    bound(side, span, depth);
  }
}

IntervalJet FormulaSides::range(const Span& span) {
  reopen();
  roots_.clear();
  touched_at_begin_.clear();
  bound({static_cast<int>(expression_.program_.size()) - 1, 0, 0, false}, span, 0);
  reopen();
  return ranges_.front();
}

void FormulaSides::locate_between(std::size_t side, const Span& span) {
  Jet low, high;
  if (!value_of(side, span.low, low) || !value_of(side, span.high, high)) return;
  if ((low.value >= 0.0) != (high.value >= 0.0)) refine(side, span.low, span.high, high.value >= 0.0);
}

// Bounds what a side depends on, and decides it and those inside.
void FormulaSides::bound(const Side& side, const Span& span, int depth) {
  ranges_.clear(), middle_.clear(), hangs_.clear();
  const double half = span.half();
  EvaluationFailure ignored;
  for (int i = side.first; i <= side.instruction; ++i) {
    work_ += cost_of_a_bound;
    const Expression::Instruction& instruction = expression_.program_[static_cast<std::size_t>(i)];
    if (instruction.operation == Operation::push_time) {
      ranges_.push_back({{span.low, span.high}, Interval::at(1.0), {}});
      middle_.push_back(Jet::time(span.middle()));
      hangs_.push_back(0);
      continue;
    }
    if (instruction.operation == Operation::push_constant) {
      ranges_.push_back(IntervalJet::constant(Interval::at(instruction.constant)));
      middle_.push_back(Jet::constant(instruction.constant));
      hangs_.push_back(0);
      continue;
    }
    const std::size_t first =
        ranges_.size() - static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    const bool hangs = std::any_of(hangs_.begin() + static_cast<std::ptrdiff_t>(first), hangs_.end(),
                                   [](char open) { return open != 0; });
    const IntervalJet out = bound_operation(i, &ranges_[first], &middle_[first], hangs, span, depth);
    expression_.apply(instruction, &middle_[first], ignored);
    ranges_.resize(first + 1), middle_.resize(first + 1), hangs_.resize(first + 1);
    ranges_[first] = out;
    tighten(ranges_[first], middle_[first], half);
    bool open = hangs;
    const std::size_t more = static_cast<std::size_t>(first_side_of_[static_cast<std::size_t>(i)]);
    for (std::size_t s = more; s < sides_.size() && sides_[s].instruction == i; ++s) {
      open = open || decisions_[s].where == Where::open;
    }
    hangs_[first] = open ? 1 : 0;
  }
}

IntervalJet FormulaSides::bound_operation(int i, const IntervalJet* x, const Jet* middle, bool hangs, const Span& span,
                                          int depth) {
  const Expression::Instruction& instruction = expression_.program_[static_cast<std::size_t>(i)];
  const auto side = static_cast<std::size_t>(first_side_of_[static_cast<std::size_t>(i)]);
  switch (instruction.operation) {
    case Operation::absolute: {
      const Where where = decide(side, x[0], middle[0], hangs, span, depth);
      if (where != Where::open) return where == Where::above ? x[0] : -x[0];
      return {{0.0, largest(x[0].value)}, hull(x[0].rate, -x[0].rate), Interval::whole()};
    }
    case Operation::sign: {
      const Where where = decide(side, x[0], middle[0], hangs, span, depth);
      if (where != Where::open) return IntervalJet::constant(Interval::at(where == Where::above ? 1.0 : -1.0));
      return {{-1.0, 1.0}, Interval::whole(), Interval::whole()};
    }
    case Operation::choose: {
      const Expression::Comparison comparison = instruction.comparison();
      const Where where = decide(side, Expression::margin(comparison, x[0], x[1]),
                                 Expression::margin(comparison, middle[0], middle[1]), hangs, span, depth);
      if (where != Where::open) return x[where == Where::above ? 2 : 3];
      return {hull(x[2].value, x[3].value), Interval::whole(), Interval::whole()};
    }
    case Operation::minimum:
    case Operation::maximum: {
      const bool most = instruction.operation == Operation::maximum;
      const Where where = decide(side, x[0] - x[1], middle[0] - middle[1], hangs, span, depth);
      if (where != Where::open) return (where == Where::above) == most ? x[0] : x[1];
      const Interval &a = x[0].value, &b = x[1].value;
      return {most ? Interval{std::max(a.low, b.low), std::max(a.high, b.high)}
                   : Interval{std::min(a.low, b.low), std::min(a.high, b.high)},
              hull(x[0].rate, x[1].rate), Interval::whole()};
    }
    case Operation::smooth:
      decide(side, x[0] - x[1], middle[0] - middle[1], hangs, span, depth);
      decide(side + 1, x[0] - x[2], middle[0] - middle[2], hangs, span, depth);
      return smooth(x[0], x[1], x[2]);
    case Operation::arctangent2:
      return bound_angle(i, x, middle, hangs, span, depth);
    case Operation::power_constant:
      if (instruction.constant != std::floor(instruction.constant)) decide(side, x[0], middle[0], hangs, span, depth);
      break;
    case Operation::root:
      decide(side, x[0], middle[0], hangs, span, depth);
      break;
    case Operation::arcsine:
    case Operation::arccosine: {
      const IntervalJet end = IntervalJet::constant(Interval::at(1.0));
      decide(side, end - x[0], Jet::constant(1.0) - middle[0], hangs, span, depth);
      decide(side + 1, end + x[0], Jet::constant(1.0) + middle[0], hangs, span, depth);
      break;
    }
    default:
      break;
  }
  return range_of(instruction, x);
}

// Of atan2(y, x). To the right of the origin nothing jumps; nor does the sign of x matter where y is not zero.
IntervalJet FormulaSides::bound_angle(int i, const IntervalJet* x, const Jet* middle, bool hangs, const Span& span,
                                      int depth) {
  IntervalJet y = x[0], along = x[1];
  bool open = false;
  const auto first = static_cast<std::size_t>(first_side_of_[static_cast<std::size_t>(i)]);
  for (std::size_t s = first; s < sides_.size() && sides_[s].instruction == i; ++s) {
    const bool by_x = sides_[s].which == 1;
    const bool matters = by_x ? y.value.contains(0.0) : along.value.low <= 0.0;
    if (!matters && !(decisions_[s].where != Where::open && decisions_[s].depth < depth)) {
      decisions_[s] = {Where::above, depth};
    }
    if (!matters) continue;
    const bool passing = by_x && !(y.value == 0.0);
    const Where where = decide(s, x[by_x ? 1 : 0], middle[by_x ? 1 : 0], hangs || passing, span, depth);
    open = open || where == Where::open;
    Interval& decided = by_x ? along.value : y.value;
    if (where == Where::above) decided.low = std::max(decided.low, 0.0);
    if (where == Where::below) decided.high = std::min(decided.high, -0.0);
  }
  return open ? IntervalJet{{-3.2, 3.2}, Interval::whole(), Interval::whole()} : atan2(y, along);
}

// Of an operation by those of its operands.
IntervalJet FormulaSides::range_of(const Expression::Instruction& instruction, const IntervalJet* x) {
  IntervalJet out;
  if (take_usual(instruction, x, out)) return out;
  switch (instruction.operation) {
    case Operation::power:
      return pow(x[0], x[1]);
    case Operation::tangent:
      return tan(x[0]);
    case Operation::arcsine:
      return asin(x[0]);
    case Operation::arccosine:
      return acos(x[0]);
    case Operation::root:
      return sqrt(x[0]);
    case Operation::logarithm:
      return log(x[0]);
    case Operation::hyperbolic_tangent:
      return tanh(x[0]);
    default:
      return unknown_jet();
  }
}

// Where a side is throughout a span, with its values there. Open: it passes zero, in `roots_` if these are all such
// instants, or it is not known.
FormulaSides::Where FormulaSides::decide(std::size_t side, IntervalJet value, const Jet& middle, bool hangs,
                                         const Span& span, int depth) {
  Decision& decision = decisions_[side];
  if (decision.where != Where::open && decision.depth < depth) return decision.where;
  tighten(value, middle, span.half());
  decision = {Where::open, depth};
  // What is so near to zero that rounding of the time decides the side is left to the values at the ends.
  const double near = value.rate.is_finite() ? rounding_ * largest(value.rate) : 0.0;
  if (value.value.low >= near) {
    decision.where = Where::above;
  } else if (value.value.high < -near) {
    decision.where = Where::below;
  } else if (hangs) {
    hidden_ = true;
  } else {
    decision.where = sides_[side].touches ? sought_touch(side, value, span) : sought(side, value, span);
  }
  return decision.where;
}

// A side that does not turn back, or that bends one way, is known by its ends and, where it comes nearer to zero in
// between, by its turn.
FormulaSides::Where FormulaSides::sought(std::size_t side, const IntervalJet& value, const Span& span) {
  const bool monotone = value.rate.low >= 0.0 || value.rate.high <= 0.0;
  const bool up = value.acceleration.low >= 0.0, down = value.acceleration.high <= 0.0;
  if (!monotone && !up && !down) return Where::open;
  Jet low, high;
  if (!value_of(side, span.low, low) || !value_of(side, span.high, high)) return Where::open;
  const bool above = low.value >= 0.0;
  if (above != (high.value >= 0.0)) {
    refine(side, span.low, span.high, !above);
    ++located_;
    return Where::open;
  }
  double other = 0.0;
  if (monotone || !(above ? up : down) || !passes_within(side, span, above, other)) {
    return above ? Where::above : Where::below;
  }
  refine(side, span.low, other, !above);
  refine(side, other, span.high, above);
  ++located_;
  return Where::open;
}

// It touches zero where it turns back, if it turns there within a time that is short against the run: seen from farther
// off that is a corner. A turn at the very end of a span is found at the begin of the next one.
FormulaSides::Where FormulaSides::sought_touch(std::size_t side, const IntervalJet& value, const Span& span) {
  const double turn = short_turn * (to_ - from_), small = 0.5 * turn * turn * value.acceleration.high;
  const bool down = value.acceleration.high <= 0.0;
  if (value.rate == 0.0 || value.rate.high <= 0.0 || down) return Where::above;
  const bool monotone = value.rate.low >= 0.0;
  if (!monotone && !(value.acceleration.low >= 0.0)) return Where::open;
  Jet low, high, here;
  if (!value_of(side, span.low, low) || !value_of(side, span.high, high)) return Where::open;
  const bool turns_at_low = std::abs(low.rate) <= 4.0 * rounding_ * largest(value.acceleration);
  if (turns_at_low && low.value <= small) touched_at_begin_.push_back({span.low, false});
  if (monotone || turns_at_low || !(low.rate < 0.0 && high.rate > 0.0)) return Where::above;
  double a = span.low, b = span.high;
  for (int i = 0; i < bisections; ++i) {
    double middle = 0.5 * (a + b);
    // Where the rate would vanish if it grew evenly; every other time, as it may not.
    if (i % 2 == 0) middle = std::clamp(a + (b - a) * low.rate / (low.rate - high.rate), a, b);
    if (!(a < middle && middle < b)) middle = 0.5 * (a + b);
    if (!(a < middle && middle < b) || !value_of(side, middle, here)) break;
    (here.rate < 0.0 ? a : b) = middle;
    (here.rate < 0.0 ? low : high) = here;
  }
  if (b >= span.high - rounding_ || !(high.value <= small)) return Where::above;
  roots_.push_back({b, false});
  ++located_;
  return Where::open;
}

// Whether a side that is the same at both ends, and bends towards zero, is another one at some `instant` between.
bool FormulaSides::passes_within(std::size_t side, const Span& span, bool above, double& instant) {
  const double sign = above ? 1.0 : -1.0;
  double a = span.low, b = span.high;
  Jet at_a, at_b;
  if (!value_of(side, a, at_a) || !value_of(side, b, at_b)) return false;
  if (!(sign * at_a.rate < 0.0 && sign * at_b.rate > 0.0)) return false;
  for (int i = 0; i < bisections; ++i) {
    // The tangents at both ends meet farther out than it goes.
    const double cut = (at_b.value - at_a.value + at_a.rate * a - at_b.rate * b) / (at_a.rate - at_b.rate);
    const double nearest = sign * (at_a.value + at_a.rate * (cut - a));
    if (nearest > 0.0) return false;
    double middle = 0.5 * (a + b);
    // Where the rate would vanish if it grew evenly.
    if (i % 2 == 0) middle = a + (b - a) * at_a.rate / (at_a.rate - at_b.rate);
    if (!(a < middle && middle < b)) return false;
    Jet here;
    if (!value_of(side, middle, here)) return false;
    if (above ? here.value < 0.0 : here.value > 0.0) {  // zero itself is only touched
      instant = middle;
      return true;
    }
    if (here.rate == 0.0) return false;
    (sign * here.rate < 0.0 ? a : b) = middle;
    (sign * here.rate < 0.0 ? at_a : at_b) = here;
  }
  return false;
}

// The first instant at which the side is what it is at b, between neighbouring numbers, if it changes once.
void FormulaSides::refine(std::size_t side, double a, double b, bool at_b) {
  Jet at, value_a, value_b;
  const auto narrow = [&](double t) {
    if (!(a < t && t < b)) return;
    const bool good = value_of(side, t, at);
    const bool right = !good || (at.value >= 0.0) == at_b;
    (right ? b : a) = t;
    if (good) (right ? value_b : value_a) = at;
  };
  if (value_of(side, a, value_a) && value_of(side, b, value_b)) {
    for (int i = 0; i < false_positions && b - a > 256.0 * spacing * std::max(std::abs(a), std::abs(b)); ++i) {
      const double secant = a - value_a.value * (b - a) / (value_b.value - value_a.value);
      const double by = 64.0 * spacing * std::max(std::abs(secant), b - a);
      // Where it is a straight line this is the root; else the other end is drawn near by Newton's rule.
      narrow(secant - by);
      narrow(secant + by);
      if (b - a > 4.0 * by) narrow(a - value_a.value / value_a.rate);
      if (b - a > 4.0 * by) narrow(b - value_b.value / value_b.rate);
      if (b - a > 4.0 * by) narrow(0.5 * (a + b));
    }
  }
  for (int i = 0; i < bisections && b > from_ + rounding_; ++i) {
    const double middle = 0.5 * (a + b);
    if (!(a < middle && middle < b)) break;
    narrow(middle);
  }
  roots_.push_back({b, sides_[side].smooth});
}

bool FormulaSides::value_of(std::size_t s, double t, Jet& value) {
  const Side& side = sides_[s];
  work_ += side.instruction - side.first;
  stack_.clear();
  EvaluationFailure failure;
  const Expression::Instruction& decided = expression_.program_[static_cast<std::size_t>(side.instruction)];
  for (int i = side.first; i < side.instruction; ++i) {
    const Expression::Instruction& instruction = expression_.program_[static_cast<std::size_t>(i)];
    if (instruction.operation == Operation::push_time) {
      stack_.push_back(Jet::time(t));
      continue;
    }
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    if (count == 0) stack_.emplace_back();
    const std::size_t first = stack_.size() - std::max<std::size_t>(count, 1);
    if (!expression_.apply(instruction, &stack_[first], failure)) {
      if (!expression_.chooses_) return false;
      stack_[first] = Jet::constant(std::numeric_limits<double>::quiet_NaN());  // a choice may leave it out
    }
    stack_.resize(first + 1);
  }
  switch (decided.operation) {
    case Operation::choose:
      value = Expression::margin(decided.comparison(), stack_[0], stack_[1]);
      break;
    case Operation::absolute:
    case Operation::sign:
    case Operation::root:
    case Operation::power_constant:
      value = stack_[0];
      break;
    case Operation::arcsine:
    case Operation::arccosine:
      value = Jet::constant(1.0) + (side.which == 0 ? -stack_[0] : stack_[0]);
      break;
    case Operation::arctangent2:
      value = stack_[static_cast<std::size_t>(side.which)];
      break;
    default:
      value = stack_[0] - stack_[1 + static_cast<std::size_t>(side.which)];
  }
  return !std::isnan(value.value);
}

}  // namespace freeplay
