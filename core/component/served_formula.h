// ServedFormula: what the host knows of a formula beyond the calls by which a component evaluates it.
#pragma once

#include <span>

#include "base/formula_bounds.h"

namespace freeplay {

/// Immutable, safe for several threads; SI.
class ServedFormula {
 public:
  virtual ~ServedFormula() = default;
  /// Whether it may do something in a small part of the way that its variables go, or has kinks.
  virtual bool may_hide() const noexcept = 0;
  /// False where it has no value.
  virtual bool value(std::span<const double> variables, double& out) const noexcept = 0;
  /// What it can come to in a span of time, as its variables go there.
  virtual void bound(const FormulaBounds::Span& span, FormulaBounds::Bounds& out) const noexcept = 0;
};

}  // namespace freeplay
