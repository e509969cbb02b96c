// FormulaCourse: where a formula changes its form, found window by window as time goes on.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "base/expression.h"
#include "base/formula_forms.h"
#include "base/formula_sides.h"

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
  /// The time between the corners (or the ends of the run) around t, where the formula is no polynomial of `degree`
  /// between them; infinite where it is one, or where the next corner or the rate is not known.
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
  bool has_sides() const { return sides_.size() > 0; }
  /// Instructions that were executed so far.
  long work() const { return sides_.work(); }

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
    archive(self.known_to_, self.sides_);
    archive.list(self.corners_);
    archive.list(self.pieces_);
  }

 private:
  using Span = FormulaSides::Span;
  using Root = FormulaSides::Root;
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  void forget_before(double t);
  void look_further(double until);
  bool look_over(const Span& span, int depth, std::size_t first_open, std::size_t last_open);
  bool look_at_both(const Span& left, const Span& right, const Root* between, int depth, std::size_t first_open);
  void note_corners();
  void note_corner(const Root& root);
  void note_pieces(double from, double to, std::size_t first_corner);
  FormulaForms::Form form_between(double low, double high);
  bool bends_without_bound(double corner, double by);

  const Expression& expression_;
  double from_, to_;
  double rounding_;  ///< times that are closer are one
  double known_to_;
  FormulaSides sides_;
  FormulaForms forms_;
  std::vector<std::size_t> open_;  ///< sides that are not decided, by nested spans
  std::vector<Corner> corners_;
  std::vector<Piece> pieces_;
  long allowed_ = 0;
  double stopped_at_ = 0.0;
  std::size_t most_corners_ = 0;  ///< of the present window
};

}  // namespace freeplay
