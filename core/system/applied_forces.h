// AppliedForces: what drivers by an effort and the forces of the model (Model::forces) exert.
#pragma once

#include <vector>

#include "system/joints.h"

namespace freeplay {

class AppliedForces {
 public:
  AppliedForces(const Model& model, const Markers& markers, const Joints& joints);

  bool empty() const { return effort_drivers_.empty() && model_.forces.empty(); }
  /// Adds them to ForceValues::force and fills ForceValues::applied. False with Evaluation::fault where an expression
  /// has no value.
  bool add(const Point& point, Evaluation& e) const;

 private:
  void take_inputs(const Point& point, Evaluation& e) const;
  void add_effort(int driver, Evaluation& e) const;
  bool add_force(std::size_t index, double t, Evaluation& e) const;

  const Model& model_;
  const Markers& markers_;
  const Joints& joints_;
  std::vector<int> effort_drivers_;
};

}  // namespace freeplay
