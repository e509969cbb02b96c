// StateFormula: a formula of time and of values of the motion, with exact derivatives and the places where its form
// changes.
#pragma once

#include <span>
#include <vector>

#include "base/expression.h"

namespace freeplay {

/// An abs, sign, min, max or if whose argument depends on a variable is a switch. Which side it is on may be given with
/// an evaluation, so that the formula stays smooth while an integrator looks beyond a kink; else the values decide.
/// Immutable, safe for several threads; nothing here allocates once it is made.
class StateFormula {
 public:
  explicit StateFormula(const Expression& expression);

  struct Input {
    double t = 0.0;                     ///< [s]
    std::span<const double> variables;  ///< by FormulaVariable::index, SI
    /// By switch: 1 above zero, -1 below, 0 where the values decide. Null: they decide for all.
    const double* sides = nullptr;
  };

  /// What `if` leaves out need not have a value. False, with why, where the formula has none.
  bool value(const Input& in, double& out, EvaluationFailure& failure) const noexcept;
  /// Its rate where variables change at `rates` and time at `time_rate`; 0 where it has none.
  double rate(const Input& in, std::span<const double> rates, double time_rate) const noexcept;

  static constexpr std::size_t most_slopes = 4;
  /// The value and the partial derivatives by the first variables, as many as `slopes` has, at most most_slopes; 0
  /// where one has no number.
  bool slopes(const Input& in, double& out, std::span<double> slopes, EvaluationFailure& failure) const noexcept;

  int switches() const { return switches_; }
  /// What decides each switch, and its rate as above; NaN where it has none.
  void decide(const Input& in, std::span<const double> rates, double time_rate, std::span<double> values,
              std::span<double> rate) const noexcept;
  /// What decides each switch alone.
  void decide(const Input& in, std::span<double> values) const noexcept;
  /// The side on which a switch is where what decides it is zero and changes at `rate`.
  double side_at_zero(int index, double rate) const;

 private:
  friend class FormulaBounds;
  using Operation = Expression::Operation;
  struct Decided {
    double* values = nullptr;
    double* rates = nullptr;
  };
  /// How variables and time change: of numbers without derivatives nothing.
  struct Change {
    std::span<const double> rates;
    double time_rate = 0.0;
  };

  template <class Number>
  bool run(const Input& in, const Change& change, const Decided& decided, Number& out,
           EvaluationFailure& failure) const noexcept;
  template <class Number, int depth>
  bool run_in(const Input& in, const Change& change, const Decided& decided, Number& out,
              EvaluationFailure& failure) const noexcept;
  template <class Number>
  void apply(const Expression::Instruction& instruction, Number* operands, EvaluationFailure& failure) const noexcept;
  static double usual_value(const Expression::Instruction& instruction, const double* operands) noexcept;
  template <class Number>
  void differentiate(const Expression::Instruction& instruction, Number* operands,
                     EvaluationFailure& failure) const noexcept;
  template <class Number>
  void apply_switch(std::size_t instruction, const Input& in, const Decided& decided, Number* operands) const noexcept;

  Expression expression_;
  std::vector<int> switch_of_;  ///< by instruction; -1: none
  std::vector<int> switch_at_;  ///< by switch: its instruction
  int switches_ = 0;
};

}  // namespace freeplay
