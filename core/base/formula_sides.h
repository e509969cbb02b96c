// FormulaSides: what decides which form a formula has, bounded over spans of time and located where it passes zero.
#pragma once

#include <cstddef>
#include <vector>

#include "base/expression.h"
#include "base/interval_jet.h"

namespace freeplay {

/// A side is a value in a formula whose sign decides its form: the argument of an abs, the difference of those of min
/// and max, the distance from either end of a ramp, y and x of atan2, what stands under a root, what is left to 1 in
/// asin and acos. Sides stand in the order of the program: what a side depends on comes before it. Allocates when it is
/// made, and once more only where more instants are found in a span than ever before.
class FormulaSides {
 public:
  struct Span {
    double low, high;
    double half() const { return 0.5 * (high - low); }
    double middle() const { return 0.5 * (low + high); }
  };
  /// An instant at which a side passes or touches zero.
  struct Root {
    double time;
    bool smooth;  ///< nothing jumps there: an end of a ramp
  };

  /// `expression` must live as long as this. Of (from, to] [s], the run; times closer than `rounding` are one.
  FormulaSides(const Expression& expression, double from, double to, double rounding);

  std::size_t size() const { return sides_.size(); }
  bool is_open(std::size_t side) const { return decisions_[side].where == Where::open; }

  /// Nothing is decided: a new window begins.
  void reopen();
  /// Bounds these sides and all that they depend on over a span, nested `depth` times, and decides those that it can:
  /// above or below zero throughout. Fills what follows.
  void bound(const std::size_t* first, const std::size_t* last, const Span& span, int depth);
  /// Where open sides pass zero, and how many of them do so there and nowhere else in the span.
  std::vector<Root>& roots() { return roots_; }
  std::size_t located() const { return located_; }
  /// Instants at the very begin of the span where sides touch zero.
  const std::vector<Root>& touched_at_begin() const { return touched_at_begin_; }
  /// Whether one of them depends on another that is not decided.
  bool hidden() const { return hidden_; }
  /// Adds a root of a side that is above at one end of a span and below at the other.
  void locate_between(std::size_t side, const Span& span);

  /// What the whole formula can come to over a span. Nothing is decided before nor after.
  IntervalJet range(const Span& span);

  /// Instructions that were executed so far, here and by others who say so.
  long work() const { return work_; }
  void count_work(long instructions) { work_ += instructions; }

  /// All else is of one window.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.work_);
  }

 private:
  friend class FormulaBounds;
  using Operation = Expression::Operation;

  /// It depends on the instructions from `first` on alone.
  struct Side {
    int instruction, first;
    int which;  ///< of smooth(): 0 for the begin of the ramp, 1 for its end
    bool smooth;
    bool touches = false;  ///< zero is where it ends: it comes there and turns back
  };
  enum class Where : unsigned char { open, below, above };
  struct Decision {
    Where where = Where::open;
    int depth = 0;  ///< of the span that it was made for; those of spans beside it do not count
  };

  void list_sides();
  void bound(const Side& side, const Span& span, int depth);
  IntervalJet bound_operation(int i, const IntervalJet* x, const Jet* middle, bool hangs, const Span& span, int depth);
  IntervalJet bound_angle(int i, const IntervalJet* x, const Jet* middle, bool hangs, const Span& span, int depth);
  static IntervalJet range_of(const Expression::Instruction& instruction, const IntervalJet* x);
  /// Of operations that ranges of values know as those of their courses do; false for others.
  template <class Range>
  static bool take_usual(const Expression::Instruction& instruction, const Range* x, Range& out);
  Where decide(std::size_t side, IntervalJet value, const Jet& middle, bool hangs, const Span& span, int depth);
  Where sought(std::size_t side, const IntervalJet& value, const Span& span);
  Where sought_touch(std::size_t side, const IntervalJet& value, const Span& span);
  bool passes_within(std::size_t side, const Span& span, bool above, double& instant);
  void refine(std::size_t side, double a, double b, bool at_b);
  bool value_of(std::size_t side, double t, Jet& value);

  const Expression& expression_;
  double from_, to_, rounding_;
  long work_ = 0;
  std::vector<Side> sides_;
  std::vector<int> first_side_of_;  ///< by instruction: its first side
  std::vector<Decision> decisions_;
  std::vector<Root> roots_, touched_at_begin_;
  std::size_t located_ = 0;
  bool hidden_ = false;
  std::vector<Jet> stack_, middle_;
  std::vector<IntervalJet> ranges_;
  std::vector<char> hangs_;  ///< along with ranges_: on a side that is not decided
};

template <class Range>
bool FormulaSides::take_usual(const Expression::Instruction& instruction, const Range* x, Range& out) {
  switch (instruction.operation) {
    case Operation::negate:
      out = -x[0];
      return true;
    case Operation::add:
      out = x[0] + x[1];
      return true;
    case Operation::subtract:
      out = x[0] - x[1];
      return true;
    case Operation::multiply:
      out = x[0] * x[1];
      return true;
    case Operation::divide:
      out = x[0] / x[1];
      return true;
    case Operation::power_constant:
      out = pow(x[0], instruction.constant);
      return true;
    case Operation::sine:
      out = sin(x[0]);
      return true;
    case Operation::cosine:
      out = cos(x[0]);
      return true;
    case Operation::exponential:
      out = exp(x[0]);
      return true;
    default:
      return false;
  }
}

}  // namespace freeplay
