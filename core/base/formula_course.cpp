#include "base/formula_course.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double windows = 64.0;              // in a run, unless a step is longer
constexpr long least_work = 150'000;          // instructions in a window
constexpr long work_per_instruction = 150;    // of the formula, more
constexpr long cost_of_a_bound = 4;           // instructions: one on intervals
constexpr std::size_t corners_at_once = 128;  // then the window ends early
constexpr std::size_t many_corners = 8;       // or a part of the window: worth the work that was allowed
constexpr double good_part = 1.0 / 16.0;
constexpr int deepest = 200;               // nested spans
constexpr int highest_degree = 10;         // of a polynomial that counts as smooth
constexpr double short_turn = 1.0 / 64.0;  // of the run
constexpr int false_positions = 12, bisections = 130;
constexpr std::size_t most_corners = 1 << 18;  // in an outline

double before(double t) { return std::nextafter(t, -std::numeric_limits<double>::infinity()); }
double largest(const Interval& x) { return std::max(std::abs(x.low), std::abs(x.high)); }

}  // namespace

FormulaCourse::Form FormulaCourse::bounded(const Form& form) { return form.degree > highest_degree ? no_form : form; }
FormulaCourse::Form FormulaCourse::sum(const Form& a, const Form& b) {
  return {std::max(a.degree, b.degree), std::max(a.rate, b.rate)};
}
FormulaCourse::Form FormulaCourse::product(const Form& a, const Form& b) {
  return bounded({a.degree + b.degree, a.rate + b.rate});
}

FormulaCourse::FormulaCourse(const Expression& expression, double from, double to)
    : expression_(expression),
      from_(from),
      to_(to),
      rounding_(4.0 * eps * std::max(std::abs(from), std::abs(to))),
      known_to_(from) {
  const std::size_t depth = static_cast<std::size_t>(expression.stack_depth_) + 1;
  stack_.reserve(depth), middle_.reserve(depth), ranges_.reserve(depth), hangs_.reserve(depth), forms_.reserve(depth);
  if (expression.depends_on_time() && from < to) list_sides();
  if (sides_.empty()) {
    const Form form = expression.depends_on_time() ? form_between(from, to) : Form{};
    pieces_.push_back({from, to, form.rate, form.degree});
    known_to_ = to;
    return;
  }
  decisions_.resize(sides_.size());
  open_.reserve(64 * sides_.size());
  roots_.reserve(2 * sides_.size());
  corners_.reserve(4 * corners_at_once);
  pieces_.reserve(4 * corners_at_once);
}

// Sides stand in the order of the program: what a side depends on comes before it.
void FormulaCourse::list_sides() {
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
      case Operation::minimum:
      case Operation::maximum:
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

double FormulaCourse::next_corner(double t, double until) {
  for (;;) {
    const auto next = std::ranges::upper_bound(corners_, t, {}, &Corner::time);
    if (next != corners_.end()) return next->time;
    if (known_to_ >= std::min(until, to_)) return unknown;
    forget_before(t);
    look_further(until);
  }
}

void FormulaCourse::forget_before(double t) {
  const double early = t - 8.0 * rounding_;
  // The one at which the present form began is kept.
  const auto recent = std::ranges::lower_bound(corners_, early, {}, &Corner::time);
  if (recent != corners_.begin()) corners_.erase(corners_.begin(), std::prev(recent));
  std::erase_if(pieces_, [&](const Piece& piece) { return piece.to < early; });
}

FormulaCourse::Near FormulaCourse::near(double from, double to) const {
  Near out{false, false};
  for (auto c = std::ranges::lower_bound(corners_, from, {}, &Corner::time); c != corners_.end() && c->time <= to;
       ++c) {
    out.any = true;
    out.sharp = out.sharp || !c->smooth;
  }
  return out;
}

double FormulaCourse::rate_within(double from, double to) const {
  if (to > known_to_ && known_to_ < to_) return unknown;
  double rate = 0.0;
  for (auto p = pieces_.rbegin(); p != pieces_.rend() && p->to > from; ++p) {
    if (p->from < to) rate = std::max(rate, p->rate);
  }
  return rate;
}

double FormulaCourse::length_of_form(double t, int degree) const {
  const auto after = std::ranges::upper_bound(corners_, t, {}, &Corner::time);
  if (after == corners_.begin() || after == corners_.end()) return unknown;
  double length = unknown;
  for (const Piece& piece : pieces_) {
    const bool there = piece.from <= t && t < piece.to;
    const bool bends = std::isfinite(piece.rate) && (piece.rate > 0.0 || piece.degree > degree);
    if (there && bends) length = after->time - std::prev(after)->time;
  }
  return length;
}

double FormulaCourse::length_of_change(double t, int degree, double longest) {
  auto after = std::ranges::upper_bound(corners_, t, {}, &Corner::time);
  while (after == corners_.end() && known_to_ < std::min(t + longest, to_)) {
    forget_before(t);
    look_further(known_to_);
    after = std::ranges::upper_bound(corners_, t, {}, &Corner::time);
  }
  const double end = after == corners_.end() ? to_ : after->time;
  const double begin = after == corners_.begin() ? from_ : std::prev(after)->time;
  if (!(end - begin <= longest)) return unknown;
  for (const Piece& piece : pieces_) {
    const bool polynomial = piece.rate == 0.0 && piece.degree <= degree;
    if (piece.from <= t && t < piece.to) return polynomial ? unknown : end - begin;
  }
  return unknown;
}

FormulaCourse::Beside FormulaCourse::singular(double t) const {
  Beside out{unknown, unknown};
  for (const Piece& piece : pieces_) {
    if (!(piece.from <= t && t < piece.to)) continue;
    if (piece.singular_at_begin) out.before = t - piece.from;
    if (piece.singular_at_end) out.after = piece.to - t;
  }
  return out;
}

// Examines the next window. If its budget of work runs out, the window ends early, or its rest is marked unknown.
void FormulaCourse::look_further(double until) {
  const double low = known_to_, high = std::min(to_, std::max(low + (to_ - from_) / windows, until));
  const std::size_t first_corner = corners_.size();
  std::ranges::fill(decisions_, Decision{});
  open_.resize(sides_.size());
  for (std::size_t s = 0; s < open_.size(); ++s) open_[s] = s;
  allowed_ = work_ + least_work + work_per_instruction * static_cast<long>(expression_.program_.size());
  most_corners_ = first_corner + corners_at_once;
  const bool complete = look_over({low, high}, 0, 0, open_.size());
  known_to_ = complete ? high : stopped_at_;
  note_pieces(low, known_to_, first_corner);
  if (complete) return;
  const bool worth_it = corners_.size() >= first_corner + many_corners || known_to_ - low >= good_part * (high - low);
  if (worth_it && known_to_ > low) return;
  pieces_.push_back({known_to_, high, unknown, 0});
  known_to_ = high;
}

// False where it stopped at `stopped_at_`: all before that is known.
bool FormulaCourse::look_over(const Span& span, int depth, std::size_t first_open, std::size_t last_open) {
  stopped_at_ = span.low;
  if (work_ > allowed_ || corners_.size() >= most_corners_) return false;
  roots_.clear();
  located_ = 0;
  hidden_ = false;
  // What stands within a larger part of the formula is bounded along with it.
  int begin = std::numeric_limits<int>::max();
  for (std::size_t o = last_open; o-- > first_open;) {
    const Side& side = sides_[open_[o]];
    if (side.instruction >= begin) continue;
    begin = side.first;
    bound(side, span, depth);
  }
  const std::size_t still_open = open_.size();
  for (std::size_t o = first_open; o < last_open; ++o) {
    if (decisions_[open_[o]].where == Where::open) open_.push_back(open_[o]);
  }
  const std::size_t count = open_.size() - still_open;
  bool good = true;
  if (count == located_) {
    note_corners();
  } else if (span.high - span.low <= 16.0 * rounding_ || depth == deepest) {
    roots_.clear();
    for (std::size_t o = still_open; o < open_.size(); ++o) {
      Jet low, high;
      if (!value_of(open_[o], span.low, low) || !value_of(open_[o], span.high, high)) continue;
      if ((low.value >= 0.0) != (high.value >= 0.0)) refine(open_[o], span.low, span.high, high.value >= 0.0);
    }
    note_corners();
  } else if (hidden_ && !roots_.empty()) {
    // Beside a corner of what it hangs on, a side may show.
    std::ranges::sort(roots_, {}, &Root::time);
    const Root root = roots_[roots_.size() / 2];
    good = look_at_both({span.low, before(root.time)}, {root.time, span.high}, &root, depth, still_open);
  } else {
    const double middle = span.middle();
    good = look_at_both({span.low, middle}, {middle, span.high}, nullptr, depth, still_open);
  }
  open_.resize(still_open);
  return good;
}

bool FormulaCourse::look_at_both(const Span& left, const Span& right, const Root* between, int depth,
                                 std::size_t first_open) {
  const std::size_t last_open = open_.size();
  if (left.low <= left.high && !look_over(left, depth + 1, first_open, last_open)) return false;
  if (between) note_corner(*between);
  return !(right.low < right.high) || look_over(right, depth + 1, first_open, last_open);
}

// Bounds what a side depends on, and decides it and those inside.
void FormulaCourse::bound(const Side& side, const Span& span, int depth) {
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
    ranges_[first].tighten(middle_[first], half);
    bool open = hangs;
    const std::size_t more = static_cast<std::size_t>(first_side_of_[static_cast<std::size_t>(i)]);
    for (std::size_t s = more; s < sides_.size() && sides_[s].instruction == i; ++s) {
      open = open || decisions_[s].where == Where::open;
    }
    hangs_[first] = open ? 1 : 0;
  }
}

IntervalJet FormulaCourse::bound_operation(int i, const IntervalJet* x, const Jet* middle, bool hangs, const Span& span,
                                           int depth) {
  const Expression::Instruction& instruction = expression_.program_[static_cast<std::size_t>(i)];
  const auto side = static_cast<std::size_t>(first_side_of_[static_cast<std::size_t>(i)]);
  switch (instruction.operation) {
    case Operation::absolute: {
      const Where where = decide(side, x[0], middle[0], hangs, span, depth);
      if (where != Where::open) return where == Where::above ? x[0] : -x[0];
      return {{0.0, largest(x[0].value)}, hull(x[0].rate, -x[0].rate), Interval::whole()};
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
    case Operation::arctangent2: {
      IntervalJet y = x[0], along = x[1];
      bool open = false;
      for (std::size_t s = side; s < sides_.size() && sides_[s].instruction == i; ++s) {
        const bool by_x = sides_[s].which == 1;
        // To the right of the origin nothing jumps; nor does the sign of x matter where y is not zero.
        const bool matters = by_x ? y.value.contains(0.0) : along.value.low <= 0.0;
        if (!matters && !(decisions_[s].where != Where::open && decisions_[s].depth < depth)) {
          decisions_[s] = {Where::above, depth};
        }
        if (!matters) continue;
        const bool passing = by_x && !y.value.is(0.0);
        const Where where = decide(s, x[by_x ? 1 : 0], middle[by_x ? 1 : 0], hangs || passing, span, depth);
        open = open || where == Where::open;
        Interval& decided = by_x ? along.value : y.value;
        if (where == Where::above) decided.low = std::max(decided.low, 0.0);
        if (where == Where::below) decided.high = std::min(decided.high, -0.0);
      }
      return open ? IntervalJet{{-3.2, 3.2}, Interval::whole(), Interval::whole()} : atan2(y, along);
    }
    case Operation::negate:
      return -x[0];
    case Operation::add:
      return x[0] + x[1];
    case Operation::subtract:
      return x[0] - x[1];
    case Operation::multiply:
      return x[0] * x[1];
    case Operation::divide:
      return x[0] / x[1];
    case Operation::power_constant:
      if (instruction.constant != std::floor(instruction.constant)) decide(side, x[0], middle[0], hangs, span, depth);
      return pow(x[0], instruction.constant);
    case Operation::power:
      return pow(x[0], x[1]);
    case Operation::sine:
      return sin(x[0]);
    case Operation::cosine:
      return cos(x[0]);
    case Operation::tangent:
      return tan(x[0]);
    case Operation::arcsine:
    case Operation::arccosine: {
      const IntervalJet end = IntervalJet::constant(Interval::at(1.0));
      decide(side, end - x[0], Jet::constant(1.0) - middle[0], hangs, span, depth);
      decide(side + 1, end + x[0], Jet::constant(1.0) + middle[0], hangs, span, depth);
      return instruction.operation == Operation::arcsine ? asin(x[0]) : acos(x[0]);
    }
    case Operation::root:
      decide(side, x[0], middle[0], hangs, span, depth);
      return sqrt(x[0]);
    case Operation::exponential:
      return exp(x[0]);
    case Operation::logarithm:
      return log(x[0]);
    case Operation::push_constant:
    case Operation::push_time:
      break;
  }
  return IntervalJet::unknown();
}

// Where a side is throughout a span, with its values there. Open: it passes zero, in `roots_` if these are all such
// instants, or it is not known.
FormulaCourse::Where FormulaCourse::decide(std::size_t side, IntervalJet value, const Jet& middle, bool hangs,
                                           const Span& span, int depth) {
  Decision& decision = decisions_[side];
  if (decision.where != Where::open && decision.depth < depth) return decision.where;
  value.tighten(middle, span.half());
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
FormulaCourse::Where FormulaCourse::sought(std::size_t side, const IntervalJet& value, const Span& span) {
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
FormulaCourse::Where FormulaCourse::sought_touch(std::size_t side, const IntervalJet& value, const Span& span) {
  const double turn = short_turn * (to_ - from_), small = 0.5 * turn * turn * value.acceleration.high;
  const bool down = value.acceleration.high <= 0.0;
  if (value.rate.is(0.0) || value.rate.high <= 0.0 || down) return Where::above;
  const bool monotone = value.rate.low >= 0.0;
  if (!monotone && !(value.acceleration.low >= 0.0)) return Where::open;
  Jet low, high, here;
  if (!value_of(side, span.low, low) || !value_of(side, span.high, high)) return Where::open;
  const bool turns_at_low = std::abs(low.rate) <= 4.0 * rounding_ * largest(value.acceleration);
  if (turns_at_low && low.value <= small) note_corner({span.low, false});
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
bool FormulaCourse::passes_within(std::size_t side, const Span& span, bool above, double& instant) {
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
void FormulaCourse::refine(std::size_t side, double a, double b, bool at_b) {
  Jet at, value_a, value_b;
  const auto narrow = [&](double t) {
    if (!(a < t && t < b)) return;
    const bool good = value_of(side, t, at);
    const bool right = !good || (at.value >= 0.0) == at_b;
    (right ? b : a) = t;
    if (good) (right ? value_b : value_a) = at;
  };
  if (value_of(side, a, value_a) && value_of(side, b, value_b)) {
    for (int i = 0; i < false_positions && b - a > 256.0 * eps * std::max(std::abs(a), std::abs(b)); ++i) {
      const double secant = a - value_a.value * (b - a) / (value_b.value - value_a.value);
      const double by = 64.0 * eps * std::max(std::abs(secant), b - a);
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

bool FormulaCourse::value_of(std::size_t s, double t, Jet& value) {
  const Side& side = sides_[s];
  work_ += side.instruction - side.first;
  stack_.clear();
  EvaluationFailure failure;
  for (int i = side.first; i < side.instruction; ++i) {
    const Expression::Instruction& instruction = expression_.program_[static_cast<std::size_t>(i)];
    if (instruction.operation == Operation::push_time) {
      stack_.push_back(Jet::time(t));
      continue;
    }
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    if (count == 0) stack_.emplace_back();
    const std::size_t first = stack_.size() - std::max<std::size_t>(count, 1);
    if (!expression_.apply(instruction, &stack_[first], failure)) return false;
    stack_.resize(first + 1);
  }
  switch (expression_.program_[static_cast<std::size_t>(side.instruction)].operation) {
    case Operation::absolute:
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
  return true;
}

void FormulaCourse::note_corners() {
  std::ranges::sort(roots_, {}, &Root::time);
  for (const Root& root : roots_) note_corner(root);
}

// Of several at one time, but for rounding, the sharp one counts; at the start of the run the formula begins.
void FormulaCourse::note_corner(const Root& root) {
  if (!(root.time > from_ + rounding_ && root.time < to_)) return;
  if (!corners_.empty() && root.time - corners_.back().time <= rounding_) {
    corners_.back().smooth = corners_.back().smooth && root.smooth;
    return;
  }
  corners_.push_back({root.time, root.smooth});
}

void FormulaCourse::note_pieces(double from, double to, std::size_t first_corner) {
  double low = from;
  for (std::size_t c = first_corner; c <= corners_.size(); ++c) {
    const double high = c < corners_.size() ? corners_[c].time : to;
    if (!(low < high)) continue;
    const Form form = form_between(low, high);
    const bool goes_on = c == first_corner && !pieces_.empty() && pieces_.back().rate == form.rate &&
                         (corners_.empty() || first_corner == 0 || corners_[first_corner - 1].time < pieces_.back().to);
    if (goes_on && pieces_.back().to == low) {
      pieces_.back().to = high;
    } else {
      pieces_.push_back({low, high, form.rate, form.degree});
      if (!std::isfinite(form.rate)) pieces_.back().singular_at_begin = bends_without_bound(low, high - low);
    }
    if (!std::isfinite(form.rate)) pieces_.back().singular_at_end = bends_without_bound(high, low - high);
    low = high;
  }
}

// Whether the second derivative grows towards `corner`, seen from the side of corner + by.
bool FormulaCourse::bends_without_bound(double corner, double by) {
  Jet far, near;
  EvaluationFailure failure;
  work_ += 2 * static_cast<long>(expression_.program_.size());
  return expression_.evaluate(corner + 1e-3 * by, far, failure) &&
         expression_.evaluate(corner + 1e-6 * by, near, failure) &&
         !(std::abs(near.acceleration) <= 4.0 * std::abs(far.acceleration));
}

// Of a span without corners, as two instants inside show it: at one of them a side may be touched.
FormulaCourse::Form FormulaCourse::form_between(double low, double high) {
  Form first, second;
  const bool one = look(0.5 * (low + high), first), other = look(low + 0.381966 * (high - low), second);
  if (one && other) return sum(first, second);
  return one ? first : other ? second : no_form;
}

bool FormulaCourse::look(double t, Form& form) {
  stack_.clear(), forms_.clear();
  work_ += static_cast<long>(expression_.program_.size());
  EvaluationFailure failure;
  for (const Expression::Instruction& instruction : expression_.program_) {
    if (instruction.operation == Operation::push_time) {
      stack_.push_back(Jet::time(t));
      forms_.push_back({1, 0.0});
      continue;
    }
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    if (count == 0) stack_.emplace_back(), forms_.emplace_back();
    const std::size_t first = stack_.size() - std::max<std::size_t>(count, 1);
    Jet* const operands = stack_.data() + first;
    forms_[first] = note(instruction, operands, forms_.data() + first, std::max<std::size_t>(count, 1));
    if (!expression_.apply(instruction, operands, failure)) return false;
    stack_.resize(first + 1), forms_.resize(first + 1);
  }
  form = forms_.front();
  return true;
}

/// The form of what an operation makes of its operands.
FormulaCourse::Form FormulaCourse::note(const Expression::Instruction& instruction, const Jet* x, const Form* form,
                                        std::size_t count) const {
  const bool constant = std::all_of(form, form + count, [](const Form& f) { return f.constant(); });
  switch (instruction.operation) {
    case Operation::minimum:
    case Operation::maximum: {
      const bool second_is_less = less_from_right(x[1], x[0]);
      return form[second_is_less == (instruction.operation == Operation::minimum) ? 1 : 0];
    }
    case Operation::smooth:
      if (x[0].value <= x[1].value || x[0].value >= x[2].value) return {};
      if (!form[1].constant() || !form[2].constant()) return no_form;
      return bounded({5 * form[0].degree, 5.0 * form[0].rate});
    case Operation::absolute:
    case Operation::negate:
      return form[0];
    case Operation::add:
    case Operation::subtract:
      return sum(form[0], form[1]);
    case Operation::multiply:
      return product(form[0], form[1]);
    case Operation::divide:
      return form[1].constant() ? form[0] : no_form;
    case Operation::power_constant: {
      const double n = instruction.constant;
      if (constant) return {};
      if (!(n >= 0.0 && n <= highest_degree && n == std::floor(n))) return no_form;
      return bounded({form[0].degree * static_cast<int>(n), form[0].rate * n});
    }
    case Operation::sine:
    case Operation::cosine:
    case Operation::exponential:
      return form[0].polynomial(1) ? Form{0, std::abs(x[0].rate)} : no_form;
    default:
      return constant ? Form{} : no_form;
  }
}

Outline Expression::outline(double from, double to) const {
  FormulaCourse course(*this, from, to);
  Outline outline;
  double t = from;
  for (;;) {
    const double corner = course.next_corner(t, to);
    outline.rates.push_back(course.rate_within(t, std::min(corner, to)));
    if (!(corner < to)) break;
    outline.corners.push_back({corner, !course.near(corner, corner).sharp});
    t = corner;
    if (outline.corners.size() < most_corners) continue;
    outline.rates.push_back(std::numeric_limits<double>::infinity());
    break;
  }
  return outline;
}

}  // namespace freeplay
