#include "stage/rounding_floor.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {

RoundingFloor::RoundingFloor(StageEquations& equations, const ConvergenceParameters& parameters)
    : equations_(equations), system_(equations.system()), parameters_(parameters) {
  const Layout& layout = system_.layout();
  phi_.resize(at(layout.nc()));
  coordinate_.resize(at(layout.nv()));
  const Model& model = system_.model();
  for (const Gear& gear : model.gears) {
    if (layout.rows(gear.joint).size == 0) continue;  // its teeth have play
    const std::size_t row = at(layout.rows(gear.joint).offset);
    coordinate_terms_.push_back({row, at(gear.first), std::abs(gear.ratio)});
    coordinate_terms_.push_back({row, at(gear.second), 1.0});
  }
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const int row = layout.driver_row(static_cast<int>(d));
    if (row >= 0 && row < layout.nc()) coordinate_terms_.push_back({at(row), at(model.drivers[d].joint), 1.0});
  }
}

// The rounding of an equation is that of its coordinates, each taken as one unit large or more.
void RoundingFloor::measure() {
  const Evaluation& e = equations_.evaluation();
  const std::span<const double> unit = equations_.units();
  const std::size_t width = at(system_.layout().body_velocities());
  coordinate_size_ = 1.0;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::size_t body = i / width, c = i % width;
    const bool counts = width == 3 || c < 3;  // else part of a quaternion
    const double size =
        counts ? std::abs(e.q[(width == 3 ? 3 : 7) * body + c]) / (parameters_.coordinate_units * unit[i]) : 0.0;
    coordinate_[i] = unit[i] * std::max(1.0, size);
    coordinate_size_ = std::max(coordinate_size_, size);
  }
  for (std::size_t r = 0; r < phi_.size(); ++r) {
    double largest_term = 0.0;
    for (const ConstraintJacobian::RowPiece& piece : system_.jacobian().row_pieces(r)) {
      for (std::size_t c = 0; c < width; ++c) {
        largest_term =
            std::max(largest_term, std::abs(e.jacobian[at(piece.offset) + c]) * coordinate_[at(piece.velocity) + c]);
      }
    }
    phi_[r] = parameters_.phi_roundings * ConvergenceParameters::rounding * largest_term;
  }
  follow_turns();
}

void RoundingFloor::follow_turns() {
  const Evaluation& e = equations_.evaluation();
  for (const CoordinateTerm& term : coordinate_terms_) {
    const double size = std::abs(e.coordinate[term.joint]);
    phi_[term.row] =
        std::max(phi_[term.row], parameters_.phi_roundings * ConvergenceParameters::rounding * term.factor * size);
    coordinate_size_ = std::max(coordinate_size_, size / parameters_.coordinate_units);
  }
}

bool RoundingFloor::all_phi_is_rounding() const {
  const Evaluation& e = equations_.evaluation();
  const double anywhere = parameters_.singular_roundings * ConvergenceParameters::rounding * system_.size();
  for (std::size_t r = 0; r < phi_.size(); ++r) {
    if (!(std::abs(e.phi[r]) <= std::max(anywhere, phi_[r]))) return false;
  }
  return true;
}

}  // namespace freeplay
