// Flows: powers that are integrated along with the internal variables of a model.
#pragma once

#include <span>

#include "system/system.h"

namespace freeplay {

/// Quantities whose rates follow from an evaluated point and which nothing depends on, such as the work of forces.
class Flows {
 public:
  virtual int flows() const = 0;
  /// Rates at an evaluated point (forces and coordinates) with its multipliers: flows() numbers. Allocates nothing.
  virtual void flow(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const = 0;

 protected:
  ~Flows() = default;
};

}  // namespace freeplay
