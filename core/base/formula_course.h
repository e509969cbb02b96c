// FormulaCourse: where a formula changes its form, found window by window as time goes on.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "base/expression.h"
#include "base/interval_jet.h"

namespace freeplay {

/// The forms that a formula takes over a run: an abs, min or max takes the other side, a ramp of smooth() begins or
/// ends, atan2 goes through its jump, what stands under a root or a broken power touches zero, or what asin and acos
/// are of touches 1 or -1, as in sqrt(x^2) and asin(sin(x)). What decides is bounded over spans of time, with its
/// derivatives, by interval arithmetic (Moore, Kearfott and Cloud 2009): a span in which it cannot be zero, or in which
/// it is monotone or bends one way, is known; any other is halved. So no change is missed, however short its form lasts
/// and however often it comes again, but for those that rounding of the run's times cannot separate. The work in a
/// window is bounded; where it does not suffice the rest of the window is unknown.
///
/// A window is looked at once, when it is first asked for; times that are asked for grow. Allocates when it is made,
/// and once more only where spans are nested deeper than ever before.
class FormulaCourse {
 public:
  /// `expression` must live as long as this. Of (from, to] [s], the run.
  FormulaCourse(const Expression& expression, double from, double to);

  /// The first corner after t that is `until` or earlier, or a later one that is known already; infinite: none. What is
  /// before t is forgotten, but for corners a few roundings away and the last one.
  double next_corner(double t, double until);
  /// Whether a corner in [from, to], close to what next_corner() gave last, is sharp, or there is one at all.
  struct Near {
    bool any, sharp;
  };
  Near near(double from, double to) const;
  /// How fast it may change anywhere in [from, to] [1/s]: see Outline::rates. Infinite where it is unknown, or was not
  /// asked for.
  double rate_within(double from, double to) const;
  /// The time from the corner before t to that after it, where the formula is no polynomial of `degree` there; infinite
  /// where it is one, where one of both corners is not known, or the rate is not.
  double length_of_form(double t, int degree) const;
  /// The time between the corners (or the ends of the run) around t, where the formula is no polynomial of `degree`
  /// between them; infinite where it is one, or where they are farther than `longest` apart or not known. Looks as far
  /// ahead.
  double length_of_change(double t, int degree, double longest);
  /// The time from t to the corner (or end of the run) before and after it if the second derivative grows without bound
  /// towards that, as beside the end of a root or of a power below two; infinite if not.
  struct Beside {
    double before, after;
  };
  Beside singular(double t) const;
  /// Whether it can have corners at all.
  bool has_sides() const { return !sides_.empty(); }
  /// Instructions that were executed so far.
  long work() const { return work_; }

  class PeriodFinder;  ///< formula_period.cpp

  /// A span without corners, as far as it is known.
  struct Piece {
    double from, to;
    double rate;  ///< [1/s]
    int degree;   ///< of a polynomial in it
    bool singular_at_begin = false, singular_at_end = false;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.from, self.to, self.rate, self.degree, self.singular_at_begin, self.singular_at_end);
    }
  };
  /// Of the windows that are known.
  const std::vector<Corner>& corners() const { return corners_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  double known_until() const { return known_to_; }

  /// What is known so far: all else follows from the formula, or is of one window.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.known_to_, self.work_);
    archive.list(self.corners_);
    archive.list(self.pieces_);
  }

 private:
  using Operation = Expression::Operation;

  /// What a value is on a piece where nothing changes sides: a polynomial times what changes at a rate [1/s].
  struct Form {
    int degree = 0;
    double rate = 0.0;
    bool constant() const { return degree == 0 && rate == 0.0; }
    bool polynomial(int most) const { return degree <= most && rate == 0.0; }
  };
  static Form bounded(const Form& form);
  static Form sum(const Form& a, const Form& b);
  static Form product(const Form& a, const Form& b);
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  static constexpr Form no_form{0, unknown};

  /// What decides in an instruction: above or below zero. It depends on the instructions from `first` on alone.
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
  struct Span {
    double low, high;
    double half() const { return 0.5 * (high - low); }
    double middle() const { return 0.5 * (low + high); }
  };
  struct Root {
    double time;
    bool smooth;
  };

  void list_sides();
  void forget_before(double t);
  void look_further(double until);
  bool look_over(const Span& span, int depth, std::size_t first_open, std::size_t last_open);
  bool look_at_both(const Span& left, const Span& right, const Root* between, int depth, std::size_t first_open);
  void bound(const Side& side, const Span& span, int depth);
  IntervalJet bound_operation(int i, const IntervalJet* x, const Jet* middle, bool hangs, const Span& span, int depth);
  Where decide(std::size_t side, IntervalJet value, const Jet& middle, bool hangs, const Span& span, int depth);
  Where sought(std::size_t side, const IntervalJet& value, const Span& span);
  Where sought_touch(std::size_t side, const IntervalJet& value, const Span& span);
  bool bends_without_bound(double corner, double by);
  bool passes_within(std::size_t side, const Span& span, bool above, double& instant);
  void refine(std::size_t side, double a, double b, bool at_b);
  bool value_of(std::size_t side, double t, Jet& value);
  void note_corners();
  void note_corner(const Root& root);
  void note_pieces(double from, double to, std::size_t first_corner);
  bool look(double t, Form& form);
  Form form_between(double low, double high);
  Form note(const Expression::Instruction& instruction, const Jet* x, const Form* form, std::size_t count) const;

  const Expression& expression_;
  double from_, to_;
  double rounding_;  ///< times that are closer are one
  double known_to_;
  std::vector<Side> sides_;
  std::vector<int> first_of_;       ///< by instruction: where what it depends on begins
  std::vector<int> first_side_of_;  ///< by instruction: its first side, or -1
  std::vector<Decision> decisions_;
  std::vector<std::size_t> open_;  ///< sides that are not decided, by nested spans
  std::vector<Root> roots_;        ///< of the span that is looked over
  std::size_t located_ = 0;        ///< sides of it that pass zero in these and nowhere else
  bool hidden_ = false;            ///< a side of it hangs on another one that is not decided
  std::vector<Corner> corners_;
  std::vector<Piece> pieces_;
  long work_ = 0, allowed_ = 0;
  double stopped_at_ = 0.0;
  std::size_t most_corners_ = 0;  ///< of the present window
  std::vector<Jet> stack_, middle_;
  std::vector<IntervalJet> ranges_;
  std::vector<char> hangs_;  ///< along with ranges_: on a side that is not decided
  std::vector<Form> forms_;
};

}  // namespace freeplay
