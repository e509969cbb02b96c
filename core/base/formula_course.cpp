#include "base/formula_course.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double windows = 64.0;              // in a run, unless a step is longer
constexpr long least_work = 150'000;          // instructions in a window
constexpr long work_per_instruction = 150;    // of the formula, more
constexpr std::size_t corners_at_once = 128;  // then the window ends early
constexpr std::size_t many_corners = 8;       // or a part of the window: worth the work that was allowed
constexpr double good_part = 1.0 / 16.0;
constexpr int deepest_halving = 200;           // nested spans
constexpr std::size_t most_corners = 1 << 18;  // in an outline

double before(double t) { return std::nextafter(t, -std::numeric_limits<double>::infinity()); }

}  // namespace

FormulaCourse::FormulaCourse(const Expression& expression, double from, double to)
    : expression_(expression),
      from_(from),
      to_(to),
      rounding_(4.0 * eps * std::max(std::abs(from), std::abs(to))),
      known_to_(from),
      sides_(expression, from, to, rounding_),
      forms_(expression) {
  if (!has_sides()) {
    const FormulaForms::Form form = expression.depends_on_time() ? form_between(from, to) : FormulaForms::Form{};
    pieces_.push_back({from, to, form.rate, form.degree});
    known_to_ = to;
    return;
  }
  open_.reserve(64 * sides_.size());
  corners_.reserve(4 * corners_at_once);
  pieces_.reserve(4 * corners_at_once);
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
  if (after == corners_.end() && known_to_ < to_) return unknown;
  const double begin = after == corners_.begin() ? from_ : std::prev(after)->time;
  const double end = after == corners_.end() ? to_ : after->time;
  double length = unknown;
  for (const Piece& piece : pieces_) {
    const bool there = piece.from <= t && t < piece.to;
    const bool bends = std::isfinite(piece.rate) && (piece.rate > 0.0 || piece.degree > degree);
    if (there && bends) length = end - begin;
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
  sides_.reopen();
  open_.resize(sides_.size());
  for (std::size_t s = 0; s < open_.size(); ++s) open_[s] = s;
  allowed_ = sides_.work() + least_work + work_per_instruction * static_cast<long>(expression_.program_.size());
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
  if (sides_.work() > allowed_ || corners_.size() >= most_corners_) return false;
  sides_.bound(open_.data() + first_open, open_.data() + last_open, span, depth);
  for (const Root& root : sides_.touched_at_begin()) note_corner(root);
  const std::size_t still_open = open_.size();
  for (std::size_t o = first_open; o < last_open; ++o) {
    if (sides_.is_open(open_[o])) open_.push_back(open_[o]);
  }
  const std::size_t count = open_.size() - still_open;
  bool good = true;
  if (count == sides_.located()) {
    note_corners();
  } else if (span.high - span.low <= 16.0 * rounding_ || depth == deepest_halving) {
    sides_.roots().clear();
    for (std::size_t o = still_open; o < open_.size(); ++o) sides_.locate_between(open_[o], span);
    note_corners();
  } else if (std::vector<Root>& roots = sides_.roots(); sides_.hidden() && !roots.empty()) {
    // Beside a corner of what it hangs on, a side may show.
    std::ranges::sort(roots, {}, &Root::time);
    const Root root = roots[roots.size() / 2];
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

void FormulaCourse::note_corners() {
  std::ranges::sort(sides_.roots(), {}, &Root::time);
  for (const Root& root : sides_.roots()) note_corner(root);
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
    const FormulaForms::Form form = form_between(low, high);
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

FormulaForms::Form FormulaCourse::form_between(double low, double high) {
  sides_.count_work(forms_.work());
  return forms_.between(low, high);
}

bool FormulaCourse::bends_without_bound(double corner, double by) {
  sides_.count_work(forms_.work());
  return forms_.bends_without_bound(corner, by);
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
