// Expression: a formula of the model file, with units, parameters and exact time derivatives.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/expression_error.h"
#include "base/jet.h"
#include "base/unit.h"

namespace freeplay {

/// How much is known about the dimension of a value. `plain`: numbers and pi only. `free`: contains t or a parameter
/// without a dimension, fits anywhere as SI. `dimensioned`: the exponents are known.
enum class DimensionKind { plain, free, dimensioned };

/// A constant value in SI. `dimension` counts only if `kind` is `dimensioned`.
struct Quantity {
  double value = 0.0;
  DimensionKind kind = DimensionKind::plain;
  Dimension dimension{};
};

/// True if a value of this kind and dimension may stand in a field of dimension `field`.
bool fits(DimensionKind kind, const Dimension& dimension, const Dimension& field);
inline bool fits(const Quantity& quantity, const Dimension& field) {
  return fits(quantity.kind, quantity.dimension, field);
}

/// The parameters that `$name` can refer to.
class Scope {
 public:
  virtual ~Scope() = default;

  /// The parameter of that name, or null. The pointer need only live until the next call.
  virtual const Quantity* find(std::string_view name) const = 0;

  /// All names, for suggestions.
  virtual std::vector<std::string> names() const = 0;
};

/// Of formulas that know no parameters.
class EmptyScope final : public Scope {
 public:
  const Quantity* find(std::string_view) const override { return nullptr; }
  std::vector<std::string> names() const override { return {}; }
};

/// What `[name]` stands for in formulas that have such values: a number that is given with each evaluation.
struct FormulaVariable {
  int index = 0;  ///< into the numbers that are given
  DimensionKind kind = DimensionKind::free;
  Dimension dimension{};
};

/// The values that `[name]` can refer to.
class FormulaVariables {
 public:
  virtual ~FormulaVariables() = default;
  virtual std::optional<FormulaVariable> find(std::string_view name) const = 0;
  /// Whether they also stand without brackets, as plain words.
  virtual bool plain() const { return false; }
  /// What one of them is called in messages, such as "channel".
  virtual std::string word() const = 0;
  /// What there is, for a hint where no name is near; or empty.
  virtual std::string known() const { return {}; }
  /// Of a name that is known but cannot stand in the formula: a message id, what is wrong, and a remedy.
  struct Refusal {
    std::string id, message, remedy;
  };
  virtual std::optional<Refusal> refusal(std::string_view /*name*/) const { return std::nullopt; }
  /// The name that was probably meant, or empty.
  virtual std::string nearest(std::string_view name) const = 0;
};

/// Why and where a formula has no value at some time. The texts are literals; the place counts characters.
struct EvaluationFailure {
  const char* id = "";      ///< "bad-expression" outside of a domain, "bad-number" for a value that is not finite
  const char* reason = "";  ///< such as "division by zero"
  int offset = 0, length = 1;
};

/// A time at which a formula changes its form: an abs, sign, min, max or if changes sides or a ramp of smooth() begins
/// or ends. Just before it the formula is still what it was.
struct Corner {
  double time = 0.0;    ///< [s]
  bool smooth = false;  ///< value, rate and acceleration do not jump there
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.time, self.smooth);
  }
};

/// The course of a formula over a span of time.
struct Outline {
  std::vector<Corner> corners;  ///< in order of time, each once
  /// By piece, corners.size() + 1 of them, how fast it may change there [1/s]: 0 for a polynomial of low degree, w for
  /// sin(w t) and exp(w t), the sum of both for a product; infinite where nothing is known.
  std::vector<double> rates;
};

/// A compiled formula f(t). Parameters are folded in as constants; what depends on `t` becomes a flat postfix program.
/// What `if` leaves out need not have a value.
/// Immutable, cheap to copy for short formulas, safe to evaluate from several threads.
class Expression {
 public:
  /// Reads `text` (at most 10 000 characters, 256 nested parentheses). Throws ExpressionError with any of its ids.
  /// `t` is `time-not-allowed` unless `time_allowed`. Parameters that are themselves in error are the caller's matter:
  /// do not compile a text whose referenced_parameters() contain one.
  static Expression compile(std::string_view text, const Scope& scope, bool time_allowed);
  /// The same where `[name]` is one of `variables`, and so is a name with dots, such as body.ram.vx. What it gives is
  /// for value() and StateFormula alone.
  static Expression compile(std::string_view text, const Scope& scope, bool time_allowed,
                            const FormulaVariables& variables);

  /// Value and exact first and second time derivative at time `t` [s], in SI units per s and s^2. At a kink of abs, min
  /// and max the derivatives from the right. Returns false, and says why, outside of a domain; `out` is then unchanged.
  /// Derivatives beyond what `need` asks for may be infinite or NaN. Does not allocate.
  bool evaluate(double t, Jet& out, EvaluationFailure& failure) const noexcept;

  /// Value at time `t` [s] with these variables; NaN where there is none. Does not allocate.
  double value(double t, std::span<const double> variables) const noexcept;

  /// How many derivatives are used: 0, 1 or, from the start, 2. The others may not exist.
  void need(int derivatives) { derivatives_ = derivatives; }

  /// What the formula alone shows of (from, to] [s], without a run: see FormulaCourse. Of more than 262144 corners the
  /// rest is unknown: then the last rate is infinite. Allocates.
  Outline outline(double from, double to) const;

  /// Variable k becomes number `to[k]` of those that are given.
  void renumber(std::span<const int> to);

  /// On time or on variables.
  bool depends_on_time() const { return depends_on_time_; }
  bool depends_on_variables() const { return depends_on_variables_; }
  /// The largest parts of it that depend on time but on no variable, in order.
  std::vector<Expression> time_parts() const;
  DimensionKind kind() const { return kind_; }
  const Dimension& dimension() const { return dimension_; }

  /// The value of an expression that does not depend on time.
  Quantity constant() const;

  /// Throws ExpressionError `dimension-mismatch` over the whole text unless the value fits a field of this dimension.
  void require(const Dimension& field) const;

 private:
  friend class ExpressionCompiler;
  friend class ExpressionOperands;
  friend class FormulaBounds;
  friend class FormulaCourse;
  friend class FormulaForms;
  friend class FormulaSides;
  friend class StateFormula;

  enum class Operation {
    push_constant,
    push_time,
    push_variable,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power_constant,
    power,
    sine,
    cosine,
    tangent,
    arcsine,
    arccosine,
    root,
    exponential,
    logarithm,
    hyperbolic_tangent,
    absolute,
    sign,
    arctangent2,
    minimum,
    maximum,
    smooth,
    choose  ///< of l, r, a, b: a where l and r compare as Comparison says, else b
  };
  enum class Comparison { greater, at_least, less, at_most };
  struct Instruction {
    Operation operation;
    double constant;     // of push_constant; exponent of power_constant; index of push_variable; Comparison of choose
    int offset, length;  // of the operator or function in the text [characters]
    Comparison comparison() const { return static_cast<Comparison>(static_cast<int>(constant)); }
  };

  template <int depth>
  bool run(double t, std::span<const double> variables, Jet& out, EvaluationFailure& failure) const noexcept;
  static bool apply_quickly(Operation operation, Jet*& top) noexcept;
  static const char* apply_function(const Instruction& instruction, Jet* operands) noexcept;
  bool apply(const Instruction& instruction, Jet* operands, EvaluationFailure& failure) const noexcept;
  bool apply_or_lack(const Instruction& instruction, Jet* operands, EvaluationFailure& failure) const noexcept;
  static int operand_count(Operation operation) noexcept;
  static bool is_strict(Comparison comparison) {
    return comparison == Comparison::greater || comparison == Comparison::less;
  }
  /// What decides a choice: positive where it holds.
  template <class Number>
  static Number margin(Comparison comparison, const Number& l, const Number& r) {
    return comparison == Comparison::greater || comparison == Comparison::at_least ? l - r : r - l;
  }
  Expression part(std::size_t begin, std::size_t end) const;
  std::vector<Instruction> program_;
  int stack_depth_ = 0;
  int characters_ = 0;
  int derivatives_ = 2;
  bool depends_on_time_ = false, depends_on_variables_ = false;
  bool chooses_ = false;  ///< some values may be left out
  DimensionKind kind_ = DimensionKind::plain;
  Dimension dimension_;
};

/// Whether a word of formulas is one of theirs: a function, `t` or `pi`.
bool is_formula_word(std::string_view word);

/// Names of the parameters that `text` refers to, each once, in order. Reads no values and tolerates errors: it serves
/// to order parameters and to find cycles before anything is compiled.
std::vector<std::string> referenced_parameters(std::string_view text);

}  // namespace freeplay
