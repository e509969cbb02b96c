// FormulaBounds: what a formula of the motion can come to in a span of time.
#pragma once

#include <span>
#include <vector>

#include "base/interval_jet.h"
#include "base/state_formula.h"

namespace freeplay {

/// Immutable, safe for several threads; nothing here allocates once it is made.
class FormulaBounds {
 public:
  /// `formula` must live as long as this.
  explicit FormulaBounds(const StateFormula& formula);
  const StateFormula& formula() const { return formula_; }

  /// Whether it may do something in a small part of the way that its variables go, where no switch shows it that passes
  /// zero as evenly as these do: any but products of up to four variables, and switches whose arguments are sums of
  /// them.
  bool may_hide() const { return may_hide_; }
  /// Whether what decides a switch passes zero as evenly as the variables go.
  bool is_even(int index) const { return even_[static_cast<std::size_t>(index)] != 0; }

  /// A short span of time.
  struct Span {
    double middle = 0.0, half = 0.0;      ///< [s]
    std::span<const IntervalJet> ranges;  ///< of the variables in it, with their time derivatives
    std::span<const Jet> at_middle;
    const double* sides = nullptr;  ///< StateFormula::Input::sides
  };
  /// In the span and in its middle.
  struct Bounds {
    IntervalJet range;
    Jet at_middle;
  };
  /// Of the formula and of what decides its switches. Where no side is given, and the values leave it open, both forms
  /// count.
  void bound(const Span& span, Bounds& out, std::span<Bounds> switches) const noexcept;
  /// The values that it can come to where variables and time stay in these ranges: wider than bound(), and sooner done.
  Interval values(std::span<const Interval> ranges, const Interval& time) const noexcept;

 private:
  using Operation = Expression::Operation;
  template <int depth>
  void bound_in(const Span& span, Bounds& out, std::span<Bounds> switches) const noexcept;
  template <int depth>
  Interval values_in(std::span<const Interval> ranges, const Interval& time) const noexcept;
  static Interval value_of(const Expression::Instruction& instruction, const Interval* x) noexcept;
  static Interval chosen(const Expression::Instruction& instruction, const Interval* x) noexcept;
  static IntervalJet range_of(const Expression::Instruction& instruction, const IntervalJet* x) noexcept;
  static Bounds decides_by(const Expression::Instruction& instruction, const Span& span, const IntervalJet* x,
                           const Jet* m) noexcept;
  static void take_form(const Expression::Instruction& instruction, double side, const Bounds& decides, IntervalJet* x,
                        Jet* m) noexcept;
  static std::size_t form_above(Operation operation) noexcept;
  static bool has_forms(Operation operation) noexcept;
  static double degree(const Expression::Instruction& instruction, const double* x, std::size_t count);

  const StateFormula& formula_;
  bool may_hide_ = false;
  std::vector<char> even_;  ///< by switch
};

}  // namespace freeplay
