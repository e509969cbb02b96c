// FormulaForms: what a formula is on a piece where nothing changes sides.
#pragma once

#include <cstddef>
#include <vector>

#include "base/expression.h"

namespace freeplay {

class FormulaForms {
 public:
  /// A polynomial times what changes at a rate [1/s].
  struct Form {
    int degree = 0;
    double rate = 0.0;
    bool constant() const { return degree == 0 && rate == 0.0; }
    bool polynomial(int most) const { return degree <= most && rate == 0.0; }
  };

  /// `expression` must live as long as this.
  explicit FormulaForms(const Expression& expression);

  /// Of a span without corners, as two instants inside show it: at one of them a side may be touched. The rate is
  /// infinite where nothing is known.
  Form between(double low, double high);
  /// Whether the second derivative grows towards `corner`, seen from the side of corner + by.
  bool bends_without_bound(double corner, double by) const;
  /// Instructions that either of the two executes.
  long work() const { return 2 * static_cast<long>(expression_.program_.size()); }

 private:
  using Operation = Expression::Operation;

  bool look(double t, Form& form);
  Form of(const Expression::Instruction& instruction, const Jet* x, const Form* form, std::size_t count) const;

  const Expression& expression_;
  std::vector<Jet> stack_;
  std::vector<Form> forms_;
};

}  // namespace freeplay
