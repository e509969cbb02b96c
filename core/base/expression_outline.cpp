// The course of a formula before it is used: where abs, min, max and smooth() change sides, and how fast it may change
// in between.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "base/expression.h"

namespace freeplay {
namespace {

constexpr int fewest_looks = 4096, fewest_in_a_piece = 16, most_looks = 1 << 18;
constexpr long most_work = 30'000'000;  // instructions, some tenths of a second
constexpr int highest_degree = 10;      // of a polynomial that counts as smooth
constexpr double unknown = std::numeric_limits<double>::infinity();

/// What a value is on a piece where nothing changes sides: a polynomial times what changes at a rate [1/s].
struct Form {
  int degree = 0;
  double rate = 0.0;

  bool constant() const { return degree == 0 && rate == 0.0; }
  bool polynomial(int most) const { return degree <= most && rate == 0.0; }
};
constexpr Form no_form{0, unknown};

Form bounded(const Form& form) { return form.degree > highest_degree ? no_form : form; }
Form sum(const Form& a, const Form& b) { return {std::max(a.degree, b.degree), std::max(a.rate, b.rate)}; }
Form product(const Form& a, const Form& b) { return bounded({a.degree + b.degree, a.rate + b.rate}); }

/// What decides at an abs, min, max or at an end of smooth(): above or below zero.
struct Side {
  Jet value;
  Form form;
  bool smooth = false;
};

bool above(const Side& side) { return side.value.value >= 0.0; }

}  // namespace

class ExpressionOutline {
 public:
  ExpressionOutline(const Expression& expression, double from, double to)
      : expression_(expression), from_(from), to_(to) {}

  Outline find() {
    if (expression_.depends_on_time() && from_ < to_) find_corners();
    Outline& o = outline_;
    std::ranges::sort(o.corners, {}, &Corner::time);
    // Of several at one time the sharp one counts.
    std::vector<Corner> each;
    for (const Corner& corner : o.corners) {
      if (each.empty() || each.back().time < corner.time) {
        each.push_back(corner);
      } else {
        each.back().smooth = each.back().smooth && corner.smooth;
      }
    }
    o.corners = std::move(each);
    for (std::size_t i = 0; i <= o.corners.size(); ++i) {
      const double low = i == 0 ? from_ : o.corners[i - 1].time, high = i < o.corners.size() ? o.corners[i].time : to_;
      const bool known = !expression_.depends_on_time() || (work_ < most_work && look_between(low, high));
      o.rates.push_back(known ? (expression_.depends_on_time() ? result_.rate : 0.0) : unknown);
    }
    return std::move(outline_);
  }

 private:
  using Operation = Expression::Operation;

  /// What is left to be looked at: sides from `side` on; those before do not change in it.
  struct Piece {
    double low, high;
    std::size_t side;
  };

  // Sides stand in the order of the program: what a side depends on comes before it. So each is looked at where all
  // that it depends on keeps its form.
  void find_corners() {
    std::vector<Piece> pieces{{from_, to_, 0}};
    std::vector<double> roots;
    while (!pieces.empty() && work_ < most_work) {
      const Piece piece = pieces.back();
      pieces.pop_back();
      if (!look_between(piece.low, piece.high)) continue;
      const std::vector<Side> sides = sides_;
      for (std::size_t s = piece.side; s < sides.size(); ++s) {
        roots.clear();
        find_roots(s, sides[s], piece.low, piece.high, roots);
        if (roots.empty()) continue;
        std::ranges::sort(roots);
        double low = piece.low;
        for (const double root : roots) {
          outline_.corners.push_back({root, sides[s].smooth});
          pieces.push_back({low, root, s + 1});
          low = root;
        }
        pieces.push_back({low, piece.high, s + 1});
        break;
      }
    }
  }

  /// Looks at an instant inside, another one where the formula has no value at the first.
  bool look_between(double low, double high) {
    middle_ = 0.5 * (low + high);
    if (look(middle_)) return true;
    middle_ = low + 0.381966 * (high - low);
    return look(middle_);
  }

  /// Fills sides_ and result_; false where there is no value.
  bool look(double t) {
    stack_.clear(), forms_.clear(), sides_.clear();
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
    result_ = forms_.front();
    return true;
  }

  /// The form of what an operation makes of its operands; what decides in it goes to sides_.
  Form note(const Expression::Instruction& instruction, const Jet* x, const Form* form, std::size_t count) {
    const bool constant = std::all_of(form, form + count, [](const Form& f) { return f.constant(); });
    switch (instruction.operation) {
      case Operation::absolute:
        sides_.push_back({x[0], form[0]});
        return form[0];
      case Operation::minimum:
      case Operation::maximum: {
        sides_.push_back({x[0] - x[1], sum(form[0], form[1])});
        const bool second_is_less = less_from_right(x[1], x[0]);
        return form[second_is_less == (instruction.operation == Operation::minimum) ? 1 : 0];
      }
      case Operation::smooth:
        sides_.push_back({x[0] - x[1], sum(form[0], form[1]), true});
        sides_.push_back({x[0] - x[2], sum(form[0], form[2]), true});
        if (x[0].value <= x[1].value || x[0].value >= x[2].value) return {};
        if (!form[1].constant() || !form[2].constant()) return no_form;
        return bounded({5 * form[0].degree, 5.0 * form[0].rate});
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

  /// Where side `s` passes zero between low and high. `at_middle`: the side at middle_.
  void find_roots(std::size_t s, const Side& at_middle, double low, double high, std::vector<double>& roots) {
    const auto [value, rate, acceleration] = at_middle.value;
    if (at_middle.form.constant()) return;
    if (!at_middle.form.polynomial(2)) return scan(s, low, high, roots);
    if (at_middle.form.polynomial(1) || acceleration == 0.0) {
      if (rate != 0.0) refine(s, low, high, middle_ - value / rate, roots);
      return;
    }
    const double inside = rate * rate - 2.0 * acceleration * value;
    if (!(inside > 0.0)) return;
    // Without cancellation: the farther root, and the nearer by the product of both.
    const double sum = -(rate + std::copysign(std::sqrt(inside), rate));
    const double far = middle_ + sum / acceleration, near = middle_ + 2.0 * value / sum;
    const double vertex = middle_ - rate / acceleration;
    for (const double root : {far, near}) {
      root < vertex ? refine(s, low, std::min(vertex, high), root, roots)
                    : refine(s, std::max(vertex, low), high, root, roots);
    }
  }

  std::optional<Side> side(std::size_t s, double t) {
    if (!look(t) && s >= sides_.size()) return std::nullopt;
    return sides_[s];
  }

  /// The first time after low at which the side is what it is at high, between neighbouring numbers, if it changes
  /// once; it is expected about `guess`.
  void refine(std::size_t s, double low, double high, double guess, std::vector<double>& roots) {
    if (!(guess > low && guess < high)) return;
    const double width = 64.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(guess), high - low);
    double a = std::max(low, guess - width), b = std::min(high, guess + width);
    std::optional<Side> at_a = side(s, a), at_b = side(s, b);
    if (!at_a || !at_b || above(*at_a) == above(*at_b)) {
      a = low, b = high;
      at_a = side(s, a), at_b = side(s, b);
    }
    if (!at_a || !at_b || above(*at_a) == above(*at_b)) return;
    bisect(s, a, b, above(*at_b), low, high, roots);
  }

  void bisect(std::size_t s, double a, double b, bool at_b, double low, double high, std::vector<double>& roots) {
    for (double middle = 0.5 * (a + b); a < middle && middle < b; middle = 0.5 * (a + b)) {
      const std::optional<Side> here = side(s, middle);
      (!here || above(*here) == at_b ? b : a) = middle;
    }
    if (b > low && b < high) roots.push_back(b);
  }

  // Where a side is no parabola it is looked at, the closer the more often it changes.
  void scan(std::size_t s, double low, double high, std::vector<double>& roots) {
    const double part = (high - low) / (to_ - from_);
    int looks = std::max(fewest_in_a_piece, static_cast<int>(std::ceil(fewest_looks * part)));
    for (;; looks *= 4) {
      roots.clear();
      std::optional<Side> before = side(s, low);
      double before_t = low;
      for (int i = 1; i <= looks && work_ < most_work; ++i) {
        const double t = i == looks ? high : low + (high - low) * i / looks;
        const std::optional<Side> now = side(s, t);
        if (before && now) between_looks(s, before_t, *before, t, *now, low, high, roots);
        before = now;
        before_t = t;
      }
      if (roots.size() < static_cast<std::size_t>(looks / 8) || looks >= most_looks || work_ >= most_work) return;
    }
  }

  void between_looks(std::size_t s, double t0, const Side& before, double t1, const Side& now, double low, double high,
                     std::vector<double>& roots) {
    if (above(before) != above(now)) return bisect(s, t0, t1, above(now), low, high, roots);
    const Jet &a = before.value, &b = now.value;
    if ((a.rate < 0.0) != above(before) || (b.rate > 0.0) != above(now) || !(a.rate * b.rate < 0.0)) return;
    // Towards zero at both ends: it may pass and come back where the straight lines of (value, rate) meet, as at a
    // kink, or where the rate vanishes.
    const double h = t1 - t0, at_kink = (b.value - a.value - h * b.rate) / (a.rate - b.rate);
    for (const double from_t0 : {at_kink, h * a.rate / (a.rate - b.rate)}) {
      const double meet = t0 + std::clamp(from_t0, 0.0, h);
      const std::optional<Side> inside = side(s, meet);
      if (!inside || above(*inside) == above(before)) continue;
      bisect(s, t0, meet, !above(before), low, high, roots);
      bisect(s, meet, t1, above(now), low, high, roots);
      return;
    }
  }

  const Expression& expression_;
  double from_, to_;
  double middle_ = 0.0;
  long work_ = 0;
  Outline outline_;
  std::vector<Jet> stack_;
  std::vector<Form> forms_;
  std::vector<Side> sides_;
  Form result_;
};

Outline Expression::outline(double from, double to) const { return ExpressionOutline(*this, from, to).find(); }

}  // namespace freeplay
