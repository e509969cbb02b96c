// RoundingFloor: how large residuals of constraint equations and changes of coordinates are by rounding alone.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "stage/convergence_parameters.h"
#include "stage/equations.h"

namespace freeplay {

class RoundingFloor {
 public:
  RoundingFloor(StageEquations& equations, const ConvergenceParameters& parameters);

  /// Anew from Phi_q and the coordinates of the present evaluation.
  void measure();
  /// Coordinates of joints are counted over turns: they grow while Jacobians stay.
  void follow_turns();

  /// Of |Phi|, by equation.
  std::span<const double> of_phi() const { return phi_; }
  /// Of the largest coordinate [model sizes].
  double of_coordinates() const { return ConvergenceParameters::rounding * coordinate_size_; }
  /// Whether no kept equation is off by more than so many times its rounding.
  bool phi_is_below(double times) const {
    const std::vector<double>& residual = equations_.evaluation()->phi;
    const std::span<const char> dependent = equations_.dependent();
    int above = 0;  // counted to the end: no comparison waits for the one before
    for (std::size_t r = 0; r < phi_.size(); ++r) {
      above += std::abs(residual[r]) <= times * phi_[r] || dependent[r] ? 0 : 1;
    }
    return above == 0;
  }
  /// Whether all are rounding, those that are not kept as well: of a position close to a singular one, or after many
  /// turns.
  bool all_phi_is_rounding() const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.phi_, self.coordinate_size_, self.coordinate_);
  }

 private:
  struct CoordinateTerm {
    std::size_t row, joint;
    double factor;
  };

  StageEquations& equations_;
  const System& system_;
  ConvergenceParameters parameters_;
  std::vector<double> phi_;
  double coordinate_size_ = 1.0;                  // of the largest coordinate, in those that round as a unit does
  std::vector<double> coordinate_;                // size by velocity, at least a unit
  std::vector<CoordinateTerm> coordinate_terms_;  // of equations of gears and drivers
};

}  // namespace freeplay
